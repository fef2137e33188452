/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The limit switch driver together with the core's debouncing: both contact styles, bounce, the
 * hook in interrupt context.
 */
#include <zephyr/drivers/gpio.h>
#include <zephyr/drivers/gpio/gpio_emul.h>
#include <zephyr/ztest.h>

#include "lw/drivers/limit_switch.h"
#include "lw/control/limit_switch.h"

enum {
	PAIR_NO = 10,
	PAIR_NC = 11,
	SINGLE_NO = 12,
	SINGLE_NC = 13,
};

static const struct device *const pair = DEVICE_DT_GET(DT_NODELABEL(pair));
static const struct device *const single_no = DEVICE_DT_GET(DT_NODELABEL(single_no));
static const struct device *const single_nc = DEVICE_DT_GET(DT_NODELABEL(single_nc));
static const struct device *const pins = DEVICE_DT_GET(DT_NODELABEL(pins));

static const struct lw_limit_switch_config config = {
	.contacts = LW_SWITCH_CONTACTS_NO_NC_PAIR,
	.transit_us = 20000,
};

static struct lw_limit_switch limit_switch;
static struct lw_contacts last;
static int32_t position_usteps; /* "moves" with every contact change */
static int calls;

static void on_change(struct lw_contacts contacts, void *user_data)
{
	const struct lw_limit_switch_trigger at = {.pos_usteps = ++position_usteps, .direction = 1};

	ARG_UNUSED(user_data);
	last = contacts;
	calls++;
	lw_limit_switch_input(&limit_switch, &config, contacts.no_closed, contacts.nc_closed, at,
			      (uint64_t)k_ticks_to_us_floor64(k_uptime_ticks()));
}

/** The contacts are active low: closed is 0. */
static void set_closed(gpio_pin_t pin, bool closed)
{
	zassert_ok(gpio_emul_input_set(pins, pin, closed ? 0 : 1));
}

static void *setup(void)
{
	zassert_ok(lw_contacts_start(pair, on_change, NULL));
	zassert_ok(lw_contacts_start(single_no, on_change, NULL));
	zassert_ok(lw_contacts_start(single_nc, on_change, NULL));
	return NULL;
}

static void before(void *fixture)
{
	ARG_UNUSED(fixture);
	set_closed(PAIR_NO, false);
	set_closed(PAIR_NC, true);
	set_closed(SINGLE_NO, false);
	set_closed(SINGLE_NC, true);
	lw_limit_switch_init(&limit_switch, &config, false, true, 0);
	position_usteps = 0;
	calls = 0;
}

ZTEST(limit_switch, test_pair_reads_and_tells_every_change)
{
	struct lw_contacts contacts;

	zassert_ok(lw_contacts_read(pair, &contacts));
	zassert_true(!contacts.no_closed && contacts.nc_closed);
	zassert_false(lw_contacts_actuated(pair, contacts));
	set_closed(PAIR_NC, false);
	zassert_true(!last.no_closed && !last.nc_closed);
	zassert_true(lw_contacts_actuated(pair, last));
	set_closed(PAIR_NO, true);
	zassert_true(last.no_closed && !last.nc_closed);
	zassert_equal(calls, 2);
}

ZTEST(limit_switch, test_bounce_is_one_event_at_the_first_closure)
{
	struct lw_limit_switch_trigger trigger;

	set_closed(PAIR_NC, false); /* 1 */
	for (int i = 0; i < 20; i++) {
		set_closed(PAIR_NO, true); /* first closure: 2 */
		set_closed(PAIR_NO, false);
	}
	set_closed(PAIR_NO, true);
	zassert_equal(calls, 42);
	zassert_true(limit_switch.active);
	zassert_equal(limit_switch.triggers, 1);
	zassert_true(lw_limit_switch_take(&limit_switch, &trigger));
	zassert_equal(trigger.pos_usteps, 2);
	zassert_false(lw_limit_switch_take(&limit_switch, &trigger));
}

ZTEST(limit_switch, test_single_contacts)
{
	struct lw_contacts contacts;

	zassert_ok(lw_contacts_read(single_no, &contacts));
	zassert_false(lw_contacts_actuated(single_no, contacts));
	set_closed(SINGLE_NO, true);
	zassert_true(last.no_closed && !last.nc_closed);
	zassert_true(lw_contacts_actuated(single_no, last));

	zassert_ok(lw_contacts_read(single_nc, &contacts));
	zassert_false(lw_contacts_actuated(single_nc, contacts));
	set_closed(SINGLE_NC, false);
	zassert_true(!last.no_closed && !last.nc_closed);
	zassert_true(lw_contacts_actuated(single_nc, last));
	zassert_equal(calls, 2);
}

ZTEST_SUITE(limit_switch, NULL, setup, before, NULL, NULL);
