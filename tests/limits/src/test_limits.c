/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The limits thread and the lock that it shares: what the contacts did while somebody held the lock
 * is known as a whole before the supervisor judges where the carriage has got to meanwhile.
 */
#include <zephyr/drivers/gpio/gpio_emul.h>
#include <zephyr/ztest.h>

#include "../../../app/src/app.h"
#include "../../../app/src/limits.h"
#include "../../../app/src/watch.h"

/** Pins of the switches, NO and NC; a closed contact is 1. */
static const gpio_pin_t no_pin[2] = {[LW_PLUS] = 0, [LW_MINUS] = 2};
static const gpio_pin_t nc_pin[2] = {[LW_PLUS] = 1, [LW_MINUS] = 3};

static const struct device *const pins = DEVICE_DT_GET(DT_NODELABEL(pins));

struct lw_device app_device;
K_MUTEX_DEFINE(app_lock);

static int reports;

int watch_add(enum watch_thread thread)
{
	zassert_equal(thread, WATCH_LIMITS);
	return 0;
}

void watch_report(enum watch_thread thread)
{
	zassert_equal(thread, WATCH_LIMITS);
	reports++;
}

static K_THREAD_STACK_DEFINE(supervisor_stack, 2048);
static struct k_thread supervisor;
static bool seen_active[2];

/** One tick: what it finds once it has the lock. */
static void supervise(void *unused1, void *unused2, void *unused3)
{
	ARG_UNUSED(unused1);
	ARG_UNUSED(unused2);
	ARG_UNUSED(unused3);
	k_mutex_lock(&app_lock, K_FOREVER);
	for (int side = 0; side < 2; side++) {
		seen_active[side] = app_device.controller.limit[side].active;
	}
	k_mutex_unlock(&app_lock);
}

static void set_pair(int side, bool no_closed, bool nc_closed)
{
	zassert_ok(gpio_emul_input_set(pins, nc_pin[side], nc_closed));
	zassert_ok(gpio_emul_input_set(pins, no_pin[side], no_closed));
}

static void *setup(void)
{
	for (int side = 0; side < 2; side++) {
		set_pair(side, false, true);
	}
	zassert_ok(limits_start());
	return NULL;
}

static void before(void *fixture)
{
	ARG_UNUSED(fixture);
	app_device.controller.limit_config = (struct lw_limit_switch_config){
		.contacts = LW_SWITCH_CONTACTS_NO_NC_PAIR, .transit_us = 20000};
	for (int side = 0; side < 2; side++) {
		set_pair(side, false, true);
		k_msleep(1);
		lw_limit_switch_init(&app_device.controller.limit[side],
				     &app_device.controller.limit_config, false, true, 0);
	}
}

/* NC opens, NO closes, while a request is under way: no tick may see the half of it. */
ZTEST(limits, test_changes_that_wait_for_the_lock_are_taken_together)
{
	for (int side = 0; side < 2; side++) {
		const int before_reports = reports;

		k_mutex_lock(&app_lock, K_FOREVER);
		set_pair(side, true, false);
		k_thread_create(&supervisor, supervisor_stack,
				K_THREAD_STACK_SIZEOF(supervisor_stack), supervise, NULL, NULL,
				NULL, APP_PRIORITY_SUPERVISOR, 0, K_NO_WAIT);
		k_msleep(10); /* both wait for the lock now, the limits thread first */
		zassert_false(app_device.controller.limit[side].active);
		k_mutex_unlock(&app_lock);
		zassert_ok(k_thread_join(&supervisor, K_SECONDS(1)));
		zassert_true(seen_active[side], "side %d", side);
		zassert_equal(app_device.controller.limit[side].triggers, 1);
		zassert_true(reports > before_reports);
	}
}

/* More changes than the queue holds: the last ones are read from the contacts. */
ZTEST(limits, test_changes_that_found_no_room_are_made_good)
{
	k_mutex_lock(&app_lock, K_FOREVER);
	for (int i = 0; i < 100; i++) {
		set_pair(LW_MINUS, i % 2 == 1, i % 2 == 0);
	}
	k_msleep(10);
	k_mutex_unlock(&app_lock);
	k_msleep(10);
	zassert_true(app_device.controller.limit[LW_MINUS].active);
	set_pair(LW_MINUS, false, true);
	k_msleep(10);
	zassert_false(app_device.controller.limit[LW_MINUS].active);
}

ZTEST_SUITE(limits, NULL, setup, before, NULL, NULL);
