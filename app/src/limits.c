/* SPDX-License-Identifier: Apache-2.0 */
#include "limits.h"

#include "app.h"
#include "lw/drivers/limit_switch.h"
#include "watch.h"

/** A bouncing switch changes its contacts a few dozen times in as many hundred microseconds. */
#define CHANGES_MAX 32

/** A change of the contacts of one switch, and where the carriage was. */
struct change {
	uint64_t now_us;
	struct lw_limit_switch_trigger at;
	struct lw_contacts contacts;
	uint8_t side;
};

K_MSGQ_DEFINE(changes, sizeof(struct change), CHANGES_MAX, 8);

/* A change found no room, or came before the interrupts. Set by them, cleared by the thread. */
static atomic_t changes_lost = ATOMIC_INIT(1);

static K_THREAD_STACK_DEFINE(stack, 384);
static struct k_thread thread;

static const struct device *const switches[] = {
	[LW_PLUS] = DEVICE_DT_GET(DT_PHANDLE(APP_NODE, limit_plus)),
	[LW_MINUS] = DEVICE_DT_GET(DT_PHANDLE(APP_NODE, limit_minus)),
};

static struct change change_now(int side, struct lw_contacts contacts)
{
	return (struct change){
		.now_us = app_now_us(),
		.at = lw_controller_position(&app_device.controller),
		.contacts = contacts,
		.side = (uint8_t)side,
	};
}

static void on_change(struct lw_contacts contacts, void *user_data)
{
	const struct change change = change_now((int)(intptr_t)user_data, contacts);

	if (k_msgq_put(&changes, &change, K_NO_WAIT) != 0) {
		atomic_set(&changes_lost, 1);
	}
}

static void take(const struct change *change)
{
	struct lw_controller *controller = &app_device.controller;

	lw_limit_switch_input(&controller->limit[change->side], &controller->limit_config,
			      change->contacts.no_closed, change->contacts.nc_closed, change->at,
			      change->now_us);
}

/** Read the contacts anew, where not every change could be kept. */
static void catch_up(void)
{
	for (int side = 0; side < 2; side++) {
		struct lw_contacts contacts;

		if (lw_contacts_read(switches[side], &contacts) == 0) {
			const struct change change = change_now(side, contacts);

			take(&change);
		}
	}
}

static void run(void *unused1, void *unused2, void *unused3)
{
	struct change change;

	ARG_UNUSED(unused1);
	ARG_UNUSED(unused2);
	ARG_UNUSED(unused3);
	for (;;) {
		const int ret = k_msgq_get(&changes, &change,
					   atomic_get(&changes_lost) ? K_NO_WAIT : WATCH_PERIOD);

		watch_report(WATCH_LIMITS);
		k_mutex_lock(&app_lock, K_FOREVER);
		/* All of them, before the supervisor judges where the carriage has got to. */
		for (int more = ret; more == 0; more = k_msgq_get(&changes, &change, K_NO_WAIT)) {
			take(&change);
		}
		if (atomic_clear(&changes_lost)) {
			catch_up();
		}
		k_mutex_unlock(&app_lock);
	}
}

int limits_start(void)
{
	int ret = watch_add(WATCH_LIMITS);

	if (ret) {
		return ret;
	}
	for (int side = 0; side < 2; side++) {
		ret = lw_contacts_start(switches[side], on_change, (void *)(intptr_t)side);
		if (ret) {
			return ret;
		}
	}
	k_thread_create(&thread, stack, K_THREAD_STACK_SIZEOF(stack), run, NULL, NULL, NULL,
			APP_PRIORITY_LIMITS, 0, K_NO_WAIT);
	k_thread_name_set(&thread, "limits");
	return 0;
}
