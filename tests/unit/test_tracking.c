/* SPDX-License-Identifier: Apache-2.0 */
/* Following the drum: loss of synchronization, re-indexing, trim. */
#include <unity.h>

#include "cases.h"
#include "law_check.h"
#include "rig.h"

/** A drum speed that leaves 0.4 microsteps of carriage for each of 8 edges in a tick. */
#define SPEED 8000

void setUp(void)
{
	rig_prepare(0);
}

void tearDown(void)
{
	cases_end();
}

static bool los1(int side)
{
	return rig.controller->los.los1[side].set;
}

static bool los2(int side)
{
	return rig.controller->los.los2[side].set;
}

static void assert_no_los(void)
{
	FOR_EACH_SIDE(side) {
		TEST_ASSERT_FALSE(los1(side));
		TEST_ASSERT_FALSE(los2(side));
	}
	TEST_ASSERT_EQUAL_UINT16(0, rig.controller->los.recoveries);
}

/** Bring the carriage to the middle, moving toward a side, the drum turning in a direction. */
static void go_to_the_middle(int side, int drum_direction)
{
	const int toward = lw_side_direction(side);

	rig_prepare(0);
	rig.params.park_at = LW_PARK_AT_POSITION;
	rig.params.handover_direction = toward * drum_direction > 0 ? LW_SIDE_PLUS : LW_SIDE_MINUS;
	rig_track();
	rig_follow_to(toward * 1000, toward, drum_direction * SPEED);
	assert_no_los();
}

static int32_t sweep_end_usteps(void)
{
	return lw_law_pos_usteps(rig.controller->motion.window->sweep_end);
}

/** Slip of the carriage by an amount, seen by nobody. */
static void slip(int32_t usteps)
{
	rig_place(rig.carriage_usteps + usteps);
}

static void test_no_los_over_many_periods_in_both_directions(void)
{
	rig_track();
	for (int leg = 0; leg < 8; leg++) {
		rig.drum_edges_per_s = leg % 2 ? -40000 : 40000;
		rig_ticks(5000);
		assert_no_los();
	}
	/* Either direction alone for more than a period. */
	rig.drum_edges_per_s = -40000;
	rig_ticks(10000);
	assert_no_los();
	TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
}

static void test_no_los_when_rocking_anywhere(void)
{
	uint64_t seed = 3;

	rig_track();
	for (int i = 0; i < 4000; i++) {
		rig.drum_edges_per_s = (int32_t)(next_random(&seed) % 100001) - 49000;
		rig_ticks((int)(next_random(&seed) % 100));
		if (i % 1000 == 0) {
			assert_no_los();
		}
	}
	assert_no_los();
	TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
}

/** Noise at the encoder, or at the switch itself, as it triggers: the last step led away from it.
 */
static void test_a_step_back_as_the_switch_triggers_hides_it_not(void)
{
	FOR_EACH_SIDE(side) {
		for (int drum = -1; drum <= 1; drum += 2) {
			const int out = lw_side_direction(side);

			go_to_the_middle(side, drum);
			rig_set_switch(side, RIG_SWITCH_NEVER);
			rig_follow_to(out * 7842, out, drum * SPEED);
			rig_turn(-drum * 4);
			TEST_ASSERT_EQUAL_INT(-out, lw_motion_direction(&rig.controller->motion));

			const int32_t u = rig.controller->motion.law.u;

			rig.controller->motion.law.u = u > 0 ? 1 : -1; /* however flat it is */
			rig_set_switch(side, RIG_SWITCH_WORKS);
			rig.controller->motion.law.u = u;
			rig_turn(drum * 4);
			rig_follow_to(out * 8010, out, drum * SPEED);
			rig_ticks(20);
			assert_no_los();
			TEST_ASSERT_TRUE(rig.controller->los.triggered[side]);
		}
	}
}

/** It closed late, and the drum had turned back: that was not on the way to the reversal. */
static void test_a_switch_that_closes_on_the_way_back_has_not_triggered(void)
{
	FOR_EACH_SIDE(side) {
		for (int drum = -1; drum <= 1; drum += 2) {
			const int out = lw_side_direction(side);

			go_to_the_middle(side, drum);
			rig_set_switch(side, RIG_SWITCH_NEVER);
			rig_follow_to(out * 7990, out, drum * SPEED);
			rig_follow_to(out * 7985, -out, -drum * 500);
			rig_ticks(LW_DRUM_SPEED_LATELY_TICKS);
			rig_set_switch(side, RIG_SWITCH_WORKS);
			rig_ticks(20);
			TEST_ASSERT_FALSE(rig.controller->los.triggered[side]);
			assert_no_los();
		}
	}
}

static void test_los1_when_the_switch_does_not_trigger(void)
{
	FOR_EACH_SIDE(side) {
		for (int drum = -1; drum <= 1; drum += 2) {
			go_to_the_middle(side, drum);
			rig_set_switch(side, RIG_SWITCH_NEVER);
			rig_follow_to(lw_side_direction(side) * 7990, lw_side_direction(side),
				      drum * SPEED);
			assert_no_los();

			const uint64_t before_us = rig.now_us;

			rig_ticks(60);
			TEST_ASSERT_TRUE(los1(side));
			TEST_ASSERT_FALSE(los1(!side));
			TEST_ASSERT_FALSE(los2(side));
			TEST_ASSERT_EQUAL_UINT16(1, rig.controller->los.los1[side].count);
			TEST_ASSERT_INT32_WITHIN(10, lw_side_direction(side) * 8000,
						 rig.controller->los.los1[side].position_q16 /
							 LW_USTEP);
			TEST_ASSERT_TRUE(rig.controller->los.los1[side].time_ms >=
					 before_us / 1000);
			TEST_ASSERT_TRUE(rig.controller->los.los1[side].time_ms <=
					 rig.now_us / 1000);
			/* A launch may be in progress: tracking goes on, the next is inhibited. */
			TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
			TEST_ASSERT_EQUAL_UINT16(1 << LW_LAUNCH_INHIBIT_LOS |
							 1 << LW_LAUNCH_INHIBIT_SWITCH_IMPLAUSIBLE,
						 lw_controller_launch_inhibit(rig.controller));
			/* Once for each visit; a working switch does not clear it. */
			rig_set_switch(side, RIG_SWITCH_WORKS);
			rig_ticks(20000);
			TEST_ASSERT_EQUAL_UINT16(1, rig.controller->los.los1[side].count);
			TEST_ASSERT_TRUE(los1(side));
		}
	}
}

static void test_los1_counts_each_visit_and_keeps_the_first(void)
{
	/* The sweep ends beyond where the switch may be, or before. */
	for (int32_t trim_um = -1000; trim_um <= 0; trim_um += 1000) {
		struct lw_los_record first;

		go_to_the_middle(LW_PLUS, 1);
		lw_controller_set_trim(rig.controller, trim_um, 0);
		rig_set_switch(LW_PLUS, RIG_SWITCH_NEVER);
		rig.drum_edges_per_s = 40000;
		for (uint16_t visit = 1; visit <= 3; visit++) {
			rig_follow_to(8050, 1, 40000);
			rig_follow_to(0, -1, 40000);
			TEST_ASSERT_EQUAL_UINT16(visit, rig.controller->los.los1[LW_PLUS].count);
			if (visit == 1) {
				first = rig.controller->los.los1[LW_PLUS];
			}
		}
		TEST_ASSERT_EQUAL_UINT32(first.time_ms, rig.controller->los.los1[LW_PLUS].time_ms);
		TEST_ASSERT_EQUAL_INT32(first.position_q16,
					rig.controller->los.los1[LW_PLUS].position_q16);
	}
}

static void test_a_reversal_between_two_ticks_is_judged(void)
{
	go_to_the_middle(LW_PLUS, 1);
	rig_set_switch(LW_PLUS, RIG_SWITCH_NEVER);
	rig_follow_to(7900, 1, SPEED);
	rig_turn(3000);
	TEST_ASSERT_TRUE(rig.carriage_usteps < 8000);
	rig_tick();
	TEST_ASSERT_TRUE(los1(LW_PLUS));
}

static void test_a_switch_has_its_tolerance_to_trigger_in(void)
{
	/* The reversal begins before that. */
	go_to_the_middle(LW_PLUS, 1);
	lw_controller_set_trim(rig.controller, -1000, 0);
	rig_set_switch(LW_PLUS, RIG_SWITCH_NEVER);
	rig_follow_to(7930, 1, SPEED);
	rig_rest();
	for (int32_t usteps = 7939; usteps <= 7941; usteps++) {
		while (lw_law_pos_usteps(lw_motion_m(&rig.controller->motion)) != usteps) {
			rig_turn(1);
		}
		rig_tick();
		TEST_ASSERT_EQUAL(usteps > 7940, los1(LW_PLUS));
	}
}

static void test_a_trim_that_waits_outlasts_a_re_indexing(void)
{
	go_to_the_middle(LW_PLUS, 1);
	slip(-250);
	rig_follow_to(7770, 1, SPEED);
	lw_controller_set_trim(rig.controller, -500, 0);
	rig_follow_to(7840, 1, SPEED);
	rig_ticks(2);
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_CORRECTION | LW_MOTION_REQUEST_WINDOW,
				rig.controller->motion.requests);
	rig_follow_to(0, -1, SPEED);
	TEST_ASSERT_EQUAL_INT32(7950, sweep_end_usteps());
	TEST_ASSERT_INT32_WITHIN(2, 0, rig_error_usteps());
}

/** The carriage slips, and the switch of the side ahead triggers at a wrong position. */
static void check_los2(int side, int drum, int32_t slip_usteps)
{
	const int toward = lw_side_direction(side);

	go_to_the_middle(side, drum);
	slip(slip_usteps);
	/* Through the reversal and back to the middle: a held correction has its time. */
	rig.drum_edges_per_s = drum * SPEED;
	while (!(rig.carriage_usteps * toward > 6000)) {
		rig_tick();
	}
	while (!(rig.carriage_usteps * toward < 3000)) {
		rig_tick();
		TEST_ASSERT_TRUE_MESSAGE(rig.carriage_usteps * toward < 8249 + 110, "too far out");
	}
	TEST_ASSERT_TRUE(los2(side));
	TEST_ASSERT_FALSE(los2(!side));
	TEST_ASSERT_FALSE(los1(side)); /* it did trigger */
	TEST_ASSERT_EQUAL_UINT16(1, rig.controller->los.recoveries);
	TEST_ASSERT_INT32_WITHIN(2, toward * 7840 - slip_usteps,
				 rig.controller->los.los2[side].position_q16 / LW_USTEP);
	TEST_ASSERT_INT32_WITHIN(2, 0, rig_error_usteps());
	TEST_ASSERT_TRUE(law_on_orbit(&rig.controller->motion.law, rig.controller->motion.window));
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
}

static void test_los2_re_indexes_on_either_side_with_either_drum_direction(void)
{
	FOR_EACH_SIDE(side) {
		for (int drum = -1; drum <= 1; drum += 2) {
			/* Further out than the law knew: before the switch was expected. */
			check_los2(side, drum, lw_side_direction(side) * 500);
			check_los2(side, drum, lw_side_direction(side) * 105);
		}
	}
}

static void test_los2_of_a_carriage_that_lags_is_found_in_the_reversal(void)
{
	/* The law is in its reversal before the switch triggers: type 1 and type 2. */
	go_to_the_middle(LW_PLUS, 1);
	slip(-250);
	rig_follow_to(7840, 1, SPEED);
	rig_ticks(2);
	TEST_ASSERT_TRUE(los1(LW_PLUS));
	TEST_ASSERT_TRUE(los2(LW_PLUS));
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_CORRECTION, rig.controller->motion.requests);
	TEST_ASSERT_EQUAL_UINT16(1 << LW_LAUNCH_INHIBIT_LOS | 1 << LW_LAUNCH_INHIBIT_CORRECTION,
				 lw_controller_launch_inhibit(rig.controller));
	rig_follow_to(0, -1, SPEED);
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
	TEST_ASSERT_INT32_WITHIN(2, 0, rig_error_usteps());
}

static void test_a_second_trigger_before_the_correction_is_corrected_once(void)
{
	for (int made_before_the_tick = 0; made_before_the_tick < 2; made_before_the_tick++) {
		/* It triggers inside the reversal, where the correction has to wait. */
		go_to_the_middle(LW_PLUS, 1);
		slip(-250);
		rig_follow_to(7840, 1, SPEED);
		rig_ticks(2);
		TEST_ASSERT_EQUAL_UINT16(1, rig.controller->los.recoveries);
		/* The drum turns back until the switch releases, and on until it triggers again. */
		rig_follow_to(7780, -1, -SPEED);
		TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_CORRECTION,
					rig.controller->motion.requests);
		while (!rig.actuated[LW_PLUS]) {
			rig_turn(1);
		}
		/* Out of the reversal before, or after, the tick learns of it. */
		if (made_before_the_tick) {
			while (rig.controller->motion.requests) {
				rig_turn(-1);
			}
		}
		rig_follow_to(5000, -1, -SPEED);
		TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
		TEST_ASSERT_INT32_WITHIN(2, 0, rig_error_usteps());
		TEST_ASSERT_EQUAL_UINT16(1, rig.controller->los.recoveries);
	}
}

static void test_within_the_tolerance_nothing_happens(void)
{
	for (int sign = -1; sign <= 1; sign += 2) {
		go_to_the_middle(LW_PLUS, 1);
		slip(sign * 97);
		rig_follow_to(7000, -1, SPEED);
		assert_no_los();
		TEST_ASSERT_EQUAL_INT32(sign * 97, rig_error_usteps());
	}
}

/** Go to the middle with a switch that tells late, the drum at 40,000 edges/s. */
static void go_late(int side, int drum, int32_t delay_us, int32_t late_usteps)
{
	go_to_the_middle(side, drum);
	rig.params.switch_delay_us = delay_us;
	rig.switch_at_usteps[side] += lw_side_direction(side) * late_usteps;
}

static void test_a_late_switch_is_judged_and_re_indexed_where_it_was_reached(void)
{
	FOR_EACH_SIDE(side) {
		const int toward = lw_side_direction(side);

		for (int drum = -1; drum <= 1; drum += 2) {
			/* 3 ms at 40,000 edges/s are 50 microsteps: too far out without them. */
			go_late(side, drum, 3000, 50);
			slip(toward * -90);
			rig_follow_to(toward * 7000, -toward, drum * 40000);
			assert_no_los();

			/* Within the tolerance without them. */
			go_late(side, drum, 3000, 50);
			slip(toward * 110);
			rig_follow_to(toward * 7000, -toward, drum * 40000);
			TEST_ASSERT_TRUE(los2(side));
			TEST_ASSERT_INT32_WITHIN(2, 0, rig_error_usteps());
		}
	}
}

static void test_a_late_switch_may_tell_in_the_reversal(void)
{
	/* 7 ms: 117 microsteps, past the tolerance when it tells. */
	for (int drum = -1; drum <= 1; drum += 2) {
		go_late(LW_PLUS, drum, 7000, 117);
		slip(-70);
		rig_follow_to(7000, -1, drum * 40000);
		assert_no_los();

		go_late(LW_PLUS, drum, 7000, 117);
		rig_set_switch(LW_PLUS, RIG_SWITCH_NEVER);
		rig_follow_to(7000, -1, drum * 40000);
		TEST_ASSERT_TRUE(los1(LW_PLUS));
	}
}

static void test_a_trigger_counts_only_toward_its_switch(void)
{
	/* It triggers while the carriage moves away: by hand, or a late bounce. */
	go_to_the_middle(LW_MINUS, 1);
	rig_set_switch(LW_PLUS, RIG_SWITCH_ALWAYS);
	rig_ticks(5);
	rig_set_switch(LW_PLUS, RIG_SWITCH_WORKS);
	rig_ticks(5);
	assert_no_los();
	TEST_ASSERT_EQUAL_UINT32(1 + 0,
				 rig.controller->limit[LW_PLUS].triggers - 1 /* of the index */);
}

static void test_only_an_index_clears_los(void)
{
	check_los2(LW_PLUS, 1, 500);
	rig_rest();
	lw_controller_clear_fault(rig.controller);
	lw_controller_stop(rig.controller);
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_TRUE(los2(LW_PLUS));
	TEST_ASSERT_EQUAL_UINT16(0, rig.controller->los.recoveries); /* a new launch */
	rig_index();
	rig_run_to(LW_STATE_TRACKING);
	assert_no_los();
	TEST_ASSERT_EQUAL_UINT16(1, rig.controller->los.los2[LW_PLUS].count);
	TEST_ASSERT_EQUAL_UINT16(0, lw_controller_launch_inhibit(rig.controller));
}

/** Slips once for each side until the controller gives up; the recoveries that it made. */
static int recoveries_until_fault(int32_t los_recoveries_max, int slips)
{
	rig_prepare(0);
	rig.params.park_at = LW_PARK_AT_POSITION;
	rig.params.los_recoveries_max = los_recoveries_max;
	rig_track();
	rig.drum_edges_per_s = 20000;
	for (int i = 0; i < slips; i++) {
		const int toward = i % 2 ? -1 : 1;

		while (!(rig.carriage_usteps * toward > 5000)) {
			rig_tick();
		}
		slip(toward * 300);
		while (!(rig.carriage_usteps * toward < 5000)) {
			rig_tick();
			if (rig.controller->state == LW_STATE_FAULT) {
				TEST_ASSERT_EQUAL_INT(LW_FAULT_LOS_LIMIT, rig.controller->fault);
				TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
				return i;
			}
		}
	}
	return slips;
}

static void test_recoveries_have_a_limit(void)
{
	TEST_ASSERT_EQUAL_INT(3, recoveries_until_fault(3, 10));
	TEST_ASSERT_EQUAL_INT(1, recoveries_until_fault(1, 10));
	TEST_ASSERT_EQUAL_INT(10, recoveries_until_fault(0, 10));
}

static void test_counters_do_not_wrap(void)
{
	rig_track();
	rig.params.los_recoveries_max = 0;
	rig.controller->los.los2[LW_PLUS].count = UINT16_MAX;
	rig.controller->los.recoveries = UINT16_MAX;
	rig_follow_to(5000, 1, SPEED);
	slip(500);
	rig_follow_to(7845, 1, SPEED);
	rig_ticks(2);
	TEST_ASSERT_TRUE(los2(LW_PLUS));
	TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, rig.controller->los.los2[LW_PLUS].count);
	TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, rig.controller->los.recoveries);
}

static void test_a_correction_held_is_made_when_tracking_ends(void)
{
	go_to_the_middle(LW_PLUS, 1);
	slip(-250);
	rig_follow_to(7840, 1, SPEED);
	rig_rest();
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_CORRECTION, rig.controller->motion.requests);
	lw_controller_stop(rig.controller);
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
	TEST_ASSERT_INT32_WITHIN(2, 0, rig_error_usteps());
	lw_controller_set_mode(rig.controller, LW_MODE_CENTRE);
	rig_run_to(LW_STATE_CENTRED);
	TEST_ASSERT_INT32_WITHIN(2, 0, rig.carriage_usteps);
}

static void test_trim_in_the_sweep_comes_at_once(void)
{
	go_to_the_middle(LW_PLUS, 1);
	lw_controller_set_trim(rig.controller, -1000, 500);
	rig_ticks(1);
	TEST_ASSERT_EQUAL_INT32(7900, sweep_end_usteps());
	TEST_ASSERT_EQUAL_INT32(-7950 + 1,
				lw_law_pos_usteps(rig.controller->motion.window->sweep_begin));
	rig_follow_to(7900, 1, SPEED);
	rig_follow_to(7000, -1, SPEED);
	assert_no_los();
}

static void test_trim_waits_for_the_end_of_a_reversal(void)
{
	go_to_the_middle(LW_PLUS, 1);
	rig_follow_to(8100, 1, SPEED);
	lw_controller_set_trim(rig.controller, 400, 0);
	while (lw_law_region(rig.controller->motion.window, lw_motion_m(&rig.controller->motion)) !=
	       0) {
		TEST_ASSERT_EQUAL_INT32(8000, sweep_end_usteps());
		rig_tick();
	}
	rig_tick();
	TEST_ASSERT_EQUAL_INT32(8040, sweep_end_usteps());
	TEST_ASSERT_TRUE(law_on_orbit(&rig.controller->motion.law, rig.controller->motion.window));
}

static void test_trim_while_parked_on_the_orbit_and_elsewhere(void)
{
	rig_power_up();
	lw_controller_set_trim(rig.controller, 0, 700); /* before any index */
	rig_index();
	rig.drum_edges_per_s = 1000;
	rig_run_to(LW_STATE_READY);
	TEST_ASSERT_INT32_WITHIN(2, -7930 - 247, rig.carriage_usteps);
	lw_controller_set_trim(rig.controller, 400, 300);
	rig_rest();
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
	TEST_ASSERT_EQUAL_INT32(8000, sweep_end_usteps());
	rig_follow_to(0, 1, SPEED);
	TEST_ASSERT_EQUAL_INT32(8040, sweep_end_usteps());
	TEST_ASSERT_TRUE(law_on_orbit(&rig.controller->motion.law, rig.controller->motion.window));
	TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
}

static void test_a_trim_and_a_held_correction_together(void)
{
	go_to_the_middle(LW_PLUS, 1);
	slip(-250);
	rig_follow_to(7840, 1, SPEED);
	rig_ticks(2);
	lw_controller_set_trim(rig.controller, -500, 0);
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_CORRECTION | LW_MOTION_REQUEST_WINDOW,
				rig.controller->motion.requests);
	rig_follow_to(0, -1, SPEED);
	TEST_ASSERT_EQUAL_INT32(7950, sweep_end_usteps());
	TEST_ASSERT_INT32_WITHIN(2, 0, rig_error_usteps());
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
}

static void test_a_hand_over_beyond_the_switch_is_no_los(void)
{
	/* The switch has triggered before the drum was followed. */
	rig.params.park_at = LW_PARK_AT_POSITION;
	rig_track();
	do {
		lw_controller_jog(rig.controller, 1, rig.now_us);
		rig_ticks(100);
	} while (rig.controller->state == LW_STATE_JOGGING && rig.carriage_usteps < 7900);
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_TRUE(rig.carriage_usteps > 7900);
	rig_follow_to(8050, 1, SPEED);
	rig_follow_to(0, -1, SPEED);
	assert_no_los();
}

/* A carriage that was believed at one end and found at the other, far apart on a fine screw. */
static void test_a_correction_beyond_16_bits_is_made_at_rest(void)
{
	rig_track();
	rig_rest();

	struct lw_motion *motion = &rig.controller->motion;
	const int32_t before_usteps = lw_law_pos_usteps(lw_motion_m(motion));

	motion->request_correction_usteps = 40000;
	lw_motion_request(motion, LW_MOTION_REQUEST_CORRECTION);
	lw_controller_stop(rig.controller);
	TEST_ASSERT_EQUAL_INT32(before_usteps + 40000, lw_law_pos_usteps(lw_motion_m(motion)));
}

static void test_a_switch_that_is_still_bouncing_when_the_reversal_begins_is_waited_for(void)
{
	/* It closes 5 microsteps before the reversal: 155 off, told by 5 ms of debouncing later. */
	FOR_EACH_SIDE(side) {
		const int toward = lw_side_direction(side);

		rig_prepare(0);
		rig.params.switch_contacts = LW_SWITCH_CONTACTS_SINGLE_NO;
		rig.params.park_at = LW_PARK_AT_POSITION;
		rig.params.handover_direction = side;
		rig_track();
		rig_follow_to(toward * 1000, toward, SPEED);
		slip(-toward * 155);
		rig_follow_to(toward * 7840, toward, SPEED);
		rig_ticks(10);
		TEST_ASSERT_FALSE(los1(side));
		TEST_ASSERT_TRUE(los2(side));
	}
}

static void test_a_trigger_at_its_tolerance_is_within_it(void)
{
	FOR_EACH_SIDE(side) {
		for (int way = -1; way <= 1; way += 2) {
			for (int32_t off_usteps = 100; off_usteps <= 101; off_usteps++) {
				const int toward = lw_side_direction(side);

				go_to_the_middle(side, 1);
				slip(-rig_error_usteps() - way * off_usteps);
				rig_follow_to(toward * 7840, toward, SPEED);
				rig_ticks(2);
				TEST_ASSERT_EQUAL(off_usteps > 100, los2(side));
				TEST_ASSERT_FALSE(los1(side));
			}
		}
	}
}

static void test_the_pattern_is_counted_from_each_hand_over(void)
{
	rig_track();
	rig_drive(1000);
	rig_rest();
	TEST_ASSERT_EQUAL_INT64(1000, lw_motion_read(&rig.controller->motion).pattern_edges);
	lw_controller_stop(rig.controller);
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_EQUAL_INT64(0, lw_motion_read(&rig.controller->motion).pattern_edges);
}

static void test_centring_a_carriage_that_is_in_the_middle(void)
{
	rig_track();
	rig_follow_to(rig.derived.centre_usteps - 10, 1, SPEED);
	while (lw_law_pos_usteps(lw_motion_m(&rig.controller->motion)) !=
	       rig.derived.centre_usteps) {
		rig_turn(1);
	}
	rig_rest();
	lw_controller_stop(rig.controller);
	lw_controller_set_trim(rig.controller, -500, 0);
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_WINDOW, rig.controller->motion.requests);

	/* At rest at once, and no longer in the pattern. */
	lw_controller_set_mode(rig.controller, LW_MODE_CENTRE);
	rig_tick();
	TEST_ASSERT_EQUAL_INT(LW_STATE_CENTRED, rig.controller->state);
	TEST_ASSERT_EQUAL_INT32(0, rig.controller->motion.law.u);

	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
	TEST_ASSERT_EQUAL_INT32(7950, sweep_end_usteps());
	TEST_ASSERT_TRUE(law_on_orbit(&rig.controller->motion.law, rig.controller->motion.window));
	rig_follow_to(2000, 1, SPEED);
}

static void test_a_trim_after_a_stop_at_speed_is_asked_of_nobody(void)
{
	rig_track();
	rig_follow_to(0, 1, SPEED);
	lw_controller_stop(rig.controller);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	lw_controller_set_trim(rig.controller, -500, 0);
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
}

static void test_a_hand_over_in_a_reversal_is_a_visit_of_it_alone(void)
{
	static const int32_t places[] = {8100, 0, -8100};

	for (size_t i = 0; i < sizeof(places) / sizeof(places[0]); i++) {
		rig_prepare(0);
		rig_track();
		rig_follow_to(places[i], places[i] < 0 ? -1 : 1, SPEED);
		rig_rest();
		lw_controller_stop(rig.controller);
		rig.controller->los.visiting[LW_PLUS] = places[i] <= 0;
		rig.controller->los.visiting[LW_MINUS] = places[i] >= 0;
		lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
		rig_run_to(LW_STATE_TRACKING);
		TEST_ASSERT_EQUAL(places[i] > 0, rig.controller->los.visiting[LW_PLUS]);
		TEST_ASSERT_EQUAL(places[i] < 0, rig.controller->los.visiting[LW_MINUS]);
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_no_los_over_many_periods_in_both_directions);
	RUN_TEST(test_no_los_when_rocking_anywhere);
	RUN_TEST(test_a_step_back_as_the_switch_triggers_hides_it_not);
	RUN_TEST(test_a_switch_that_closes_on_the_way_back_has_not_triggered);
	RUN_TEST(test_los1_when_the_switch_does_not_trigger);
	RUN_TEST(test_los1_counts_each_visit_and_keeps_the_first);
	RUN_TEST(test_a_reversal_between_two_ticks_is_judged);
	RUN_TEST(test_a_switch_has_its_tolerance_to_trigger_in);
	RUN_TEST(test_a_trim_that_waits_outlasts_a_re_indexing);
	RUN_TEST(test_los2_re_indexes_on_either_side_with_either_drum_direction);
	RUN_TEST(test_los2_of_a_carriage_that_lags_is_found_in_the_reversal);
	RUN_TEST(test_a_second_trigger_before_the_correction_is_corrected_once);
	RUN_TEST(test_within_the_tolerance_nothing_happens);
	RUN_TEST(test_a_late_switch_is_judged_and_re_indexed_where_it_was_reached);
	RUN_TEST(test_a_late_switch_may_tell_in_the_reversal);
	RUN_TEST(test_a_trigger_counts_only_toward_its_switch);
	RUN_TEST(test_only_an_index_clears_los);
	RUN_TEST(test_recoveries_have_a_limit);
	RUN_TEST(test_counters_do_not_wrap);
	RUN_TEST(test_a_correction_held_is_made_when_tracking_ends);
	RUN_TEST(test_trim_in_the_sweep_comes_at_once);
	RUN_TEST(test_trim_waits_for_the_end_of_a_reversal);
	RUN_TEST(test_trim_while_parked_on_the_orbit_and_elsewhere);
	RUN_TEST(test_a_trim_and_a_held_correction_together);
	RUN_TEST(test_a_hand_over_beyond_the_switch_is_no_los);
	RUN_TEST(test_a_correction_beyond_16_bits_is_made_at_rest);
	RUN_TEST(test_a_switch_that_is_still_bouncing_when_the_reversal_begins_is_waited_for);
	RUN_TEST(test_a_trigger_at_its_tolerance_is_within_it);
	RUN_TEST(test_the_pattern_is_counted_from_each_hand_over);
	RUN_TEST(test_centring_a_carriage_that_is_in_the_middle);
	RUN_TEST(test_a_trim_after_a_stop_at_speed_is_asked_of_nobody);
	RUN_TEST(test_a_hand_over_in_a_reversal_is_a_visit_of_it_alone);
	return UNITY_END();
}
