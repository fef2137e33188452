/* SPDX-License-Identifier: Apache-2.0 */
/* Limit switches against the known position: the permit must not wait for the launch to tell. */
#include <unity.h>

#include "cases.h"
#include "device_rig.h"

void setUp(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
}

void tearDown(void)
{
	cases_end();
}

static void assert_implausible(bool expected)
{
	TEST_ASSERT_EQUAL(expected, flag(LW_FLAG_SWITCH_IMPLAUSIBLE));
	TEST_ASSERT_EQUAL(!expected, flag(LW_FLAG_LAUNCH_PERMIT));
	TEST_ASSERT_EQUAL(expected,
			  status()->launch_inhibit >> LW_LAUNCH_INHIBIT_SWITCH_IMPLAUSIBLE & 1);
}

static void test_a_switch_actuated_far_from_its_place_while_the_carriage_rests(void)
{
	track();
	rig_rest(); /* parked on the minus switch */
	rig_set_switch(LW_PLUS, RIG_SWITCH_ALWAYS);
	rig_ticks(20);
	assert_implausible(false); /* a contact may take that long */
	rig_ticks(20);
	assert_implausible(true);
	rig_set_switch(LW_PLUS, RIG_SWITCH_WORKS);
	rig_ticks(1);
	assert_implausible(false);
}

static void test_a_switch_released_where_it_must_be_actuated(void)
{
	track();
	rig_set_switch(LW_MINUS, RIG_SWITCH_NEVER);
	rig_ticks(40);
	assert_implausible(true);
}

static void test_each_is_in_the_log_once(void)
{
	track();

	const uint32_t newest = rig.store.log.newest;

	rig_set_switch(LW_PLUS, RIG_SWITCH_ALWAYS);
	rig_ticks(1000);
	TEST_ASSERT_EQUAL_UINT32(newest + 1, rig.store.log.newest);
}

static void test_centred_is_judged_too(void)
{
	track();
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	rig_run_to(LW_STATE_CENTRED);
	FOR_EACH_SIDE(side) {
		rig_set_switch(side, RIG_SWITCH_ALWAYS);
		rig_ticks(40);
		TEST_ASSERT_TRUE(flag(LW_FLAG_SWITCH_IMPLAUSIBLE));
		rig_set_switch(side, RIG_SWITCH_WORKS);
		rig_ticks(1);
		TEST_ASSERT_FALSE(flag(LW_FLAG_SWITCH_IMPLAUSIBLE));
	}
}

static void test_an_unknown_position_says_nothing_about_switches(void)
{
	rig_set_switch(LW_PLUS, RIG_SWITCH_ALWAYS);
	rig_set_switch(LW_MINUS, RIG_SWITCH_ALWAYS);
	rig_ticks(100);
	TEST_ASSERT_FALSE(flag(LW_FLAG_SWITCH_IMPLAUSIBLE));
}

/* Any speed, both directions, tolerances used up: sound switches are never called implausible. */
static void test_sound_switches_at_any_speed(void)
{
	static const int32_t speeds[] = {300, 4000, 24000, 52000, -300, -4000, -24000, -52000};

	for (size_t i = 0; i < sizeof(speeds) / sizeof(speeds[0]); i++) {
		for (int32_t off = -95; off <= 95; off += 95) {
			rig_prepare(0);
			rig.switch_at_usteps[LW_PLUS] += off;
			rig.switch_at_usteps[LW_MINUS] += off;
			rig.hysteresis_usteps = 150;
			power_up(NULL, 0);
			command(LW_COMMAND_INDEX);
			rig_run_to(LW_STATE_TRACKING);
			rig_rest();
			rig.drum_edges_per_s = speeds[i];
			for (int tick = 0; tick < 4000; tick++) {
				rig_tick();
				TEST_ASSERT_FALSE(flag(LW_FLAG_SWITCH_IMPLAUSIBLE));
			}
		}
	}
}

/** Believed at a place, a switch as it is; ticks until it is implausible, or -1. */
static int ticks_until_implausible(int side, int32_t inward_usteps)
{
	const int32_t usteps = rig.controller->derived->switch_usteps[side] -
			       lw_side_direction(side) * inward_usteps;

	lw_motion_set_position(&rig.controller->motion, rig.controller->motion.window,
			       usteps * LW_USTEP, 0);
	rig.controller->switch_check.plausible_us[side] = rig.now_us;
	for (int ticks = 1; ticks <= 100; ticks++) {
		rig_tick();
		if (rig.controller->switch_check.implausible[side]) {
			return ticks;
		}
	}
	return -1;
}

static void test_the_borders_of_what_is_plausible(void)
{
	track();
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	rig_run_to(LW_STATE_CENTRED);

	const struct lw_limit_switch_config *limits = &rig.controller->limit_config;
	const int contact_ticks =
		(int)((limits->transit_us + limits->debounce_us + 5000) / LW_CONTROLLER_TICK_US);

	FOR_EACH_SIDE(side) {
		/* Tolerance and hysteresis inside, the tolerance outside. */
		rig_set_switch(side, RIG_SWITCH_ALWAYS);
		TEST_ASSERT_EQUAL_INT(-1, ticks_until_implausible(side, 100 + 150));
		TEST_ASSERT_EQUAL_INT(contact_ticks + 1, ticks_until_implausible(side, 100 + 151));
		rig_set_switch(side, RIG_SWITCH_NEVER);
		TEST_ASSERT_EQUAL_INT(-1, ticks_until_implausible(side, 90));
		TEST_ASSERT_EQUAL_INT(-1, ticks_until_implausible(side, -100));
		TEST_ASSERT_EQUAL_INT(contact_ticks + 1, ticks_until_implausible(side, -101));
		rig_set_switch(side, RIG_SWITCH_WORKS);
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_a_switch_actuated_far_from_its_place_while_the_carriage_rests);
	RUN_TEST(test_a_switch_released_where_it_must_be_actuated);
	RUN_TEST(test_each_is_in_the_log_once);
	RUN_TEST(test_centred_is_judged_too);
	RUN_TEST(test_an_unknown_position_says_nothing_about_switches);
	RUN_TEST(test_sound_switches_at_any_speed);
	RUN_TEST(test_the_borders_of_what_is_plausible);
	return UNITY_END();
}
