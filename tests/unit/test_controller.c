/* SPDX-License-Identifier: Apache-2.0 */
/* The life of the controller: modes, hand-over, stop, jog, overtravel, overspeed, interlocks. */
#include <errno.h>

#include <unity.h>

#include "cases.h"
#include "law_check.h"
#include "rig.h"

static struct lw_refusal why;

void setUp(void)
{
	rig_prepare(0);
}

void tearDown(void)
{
	cases_end();
}

static void assert_refused(enum lw_reason reason, int ret)
{
	TEST_ASSERT_EQUAL_INT(-EBUSY, ret);
	TEST_ASSERT_EQUAL_UINT16(reason, why.reason);
}

static bool inhibited(enum lw_launch_inhibit_bit bit)
{
	return lw_controller_launch_inhibit(rig.controller) >> bit & 1;
}

/** The state is one of the pattern in force, and the carriage is where the law says. */
static void assert_in_pattern(void)
{
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
	TEST_ASSERT_TRUE(law_on_orbit(&rig.controller->motion.law, rig.controller->motion.window));
	TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
}

/** Follow the drum over more than a period; the carriage never comes near the flanges. */
static void assert_pattern_goes_on(void)
{
	for (int i = 0; i < 90; i++) {
		rig_drive(1000);
		assert_in_pattern();
		TEST_ASSERT_TRUE(rig.carriage_usteps <= 8249 && rig.carriage_usteps >= -8249);
	}
}

static void test_power_up_is_unindexed_and_inhibited(void)
{
	rig_power_up();
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	TEST_ASSERT_EQUAL_INT(LW_MODE_TRACK, rig.controller->mode);
	TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_NOT_TRACKING));
	TEST_ASSERT_FALSE(lw_controller_moving(rig.controller));
	TEST_ASSERT_TRUE(lw_controller_stepper_enabled(rig.controller));
	rig_turn(5000);
	TEST_ASSERT_EQUAL_INT32(0, rig.carriage_usteps);
	TEST_ASSERT_EQUAL_INT64(5000, lw_motion_read(&rig.controller->motion).net_edges);
}

static void test_hand_over_from_the_flange_keeps_the_orbit(void)
{
	FOR_EACH_SIDE(side) {
		rig_prepare(0);
		rig.params.index_switch = side;
		rig_track();
		TEST_ASSERT_EQUAL_INT32(0, rig.controller->motion.law.u);
		assert_pattern_goes_on();
	}
}

static void test_paper_row_hand_over_sets_the_slope(void)
{
	FOR_EACH_SIDE(side) {
		rig_prepare(0);
		rig.params.park_at = LW_PARK_AT_POSITION;
		rig.params.handover_direction = side;
		rig_track();
		TEST_ASSERT_EQUAL_INT32(lw_side_direction(side) * rig.derived.ks,
					rig.controller->motion.law.u);
		assert_pattern_goes_on();
	}
}

static void test_hand_over_only_onto_a_resting_drum(void)
{
	rig_power_up();
	rig_index();
	rig.drum_edges_per_s = 2000;
	rig_run_to(LW_STATE_READY);
	rig_ticks(1000);
	TEST_ASSERT_EQUAL_INT(LW_STATE_READY, rig.controller->state);
	rig.drum_edges_per_s = -2000;
	rig_ticks(1000);
	TEST_ASSERT_EQUAL_INT(LW_STATE_READY, rig.controller->state);
	rig.drum_edges_per_s = 0;
	rig_ticks(64 + 200 - 10);
	TEST_ASSERT_EQUAL_INT(LW_STATE_READY, rig.controller->state);
	rig_ticks(20);
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
	TEST_ASSERT_EQUAL_INT64(0, lw_motion_read(&rig.controller->motion).pattern_edges);
}

static void test_a_slow_creep_counts_as_rest(void)
{
	rig_power_up();
	rig.drum_edges_per_s = 30; /* rest_edges_per_s is 50 */
	rig_ticks(1000);
	TEST_ASSERT_TRUE(rig.controller->speed.at_rest);
	rig.drum_edges_per_s = 60;
	rig_ticks(1000);
	TEST_ASSERT_FALSE(rig.controller->speed.at_rest);
}

static void test_the_speed_is_measured_with_its_sign(void)
{
	rig_power_up();
	rig.drum_edges_per_s = 32000;
	rig_ticks(100);
	TEST_ASSERT_EQUAL_INT32(32000, rig.controller->speed.edges_per_s);
	rig.drum_edges_per_s = -8000;
	rig_ticks(100);
	TEST_ASSERT_EQUAL_INT32(-8000, rig.controller->speed.edges_per_s);
}

static void test_stop_while_tracking_a_resting_drum_keeps_the_index(void)
{
	rig_track();
	rig_drive(20000);
	rig_rest();
	lw_controller_stop(rig.controller);
	TEST_ASSERT_EQUAL_INT(LW_STATE_READY, rig.controller->state);
	TEST_ASSERT_TRUE(rig.controller->indexed);
	rig_ticks(1000);
	TEST_ASSERT_EQUAL_INT(LW_STATE_READY, rig.controller->state); /* held */
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	rig_ticks(1);
	assert_pattern_goes_on();
}

static void test_stop_while_tracking_a_turning_drum_loses_the_index(void)
{
	rig_track();
	rig.drum_edges_per_s = 20000;
	rig_ticks(500);
	lw_controller_stop(rig.controller);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	TEST_ASSERT_FALSE(rig.controller->indexed);
}

static void test_stop_inside_a_reversal_and_on_again_stays_in_the_pattern(void)
{
	for (int edges = 100; edges < 2374; edges += 250) {
		rig_prepare(0);
		rig_track();
		rig_drive(1187 + 38408 + edges); /* out of the minus reversal, into the plus one */
		TEST_ASSERT_TRUE(rig.carriage_usteps >= 7999);
		rig_rest();
		lw_controller_stop(rig.controller);
		lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
		rig_run_to(LW_STATE_TRACKING);
		assert_pattern_goes_on();
	}
}

static void test_jog_outward_inside_a_reversal_stays_in_the_pattern(void)
{
	rig_track();
	rig_drive(1187 + 38408 + 1000);
	rig_rest();
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_jog(rig.controller, 1, &why));
	lw_controller_jog(rig.controller, 1, rig.now_us);
	rig_ticks(1);
	rig_run_to(LW_STATE_TRACKING);
	assert_pattern_goes_on();
}

static void test_a_trim_that_leaves_the_resting_carriage_outside(void)
{
	FOR_EACH_SIDE(side) {
		const int outward = lw_side_direction(side);
		int32_t inside;
		int32_t past;

		rig_prepare(0);
		rig.params.park_at = LW_PARK_AT_POSITION;
		rig_track();
		lw_controller_jog(rig.controller, outward, rig.now_us);
		while (outward * rig.carriage_usteps < 7900) {
			rig_tick();
			lw_controller_jog(rig.controller, outward, rig.now_us);
		}
		rig.drum_edges_per_s = 1000;
		rig_run_to(LW_STATE_READY);
		lw_controller_set_trim(rig.controller, side == LW_PLUS ? -1500 : 0,
				       side == LW_MINUS ? 1500 : 0);
		rig.drum_edges_per_s = 0;
		/* Two microsteps inside of the sweep. */
		rig_run_to(LW_STATE_CENTRING);
		rig_run_to(LW_STATE_TRACKING);
		inside = side == LW_PLUS ? (7850 - 2) * LW_USTEP : (-7850 + 1 + 2) * LW_USTEP;
		past = outward * (inside - lw_motion_m(&rig.controller->motion));
		TEST_ASSERT_TRUE(0 <= past && past < rig.derived.ks);
		assert_pattern_goes_on();
	}
}

static void test_mode_off_and_back(void)
{
	rig_track();
	lw_controller_set_mode(rig.controller, LW_MODE_OFF);
	rig_ticks(1);
	TEST_ASSERT_EQUAL_INT(LW_STATE_OFF, rig.controller->state);
	TEST_ASSERT_EQUAL_INT(LW_MODE_OFF, rig.controller->mode);
	TEST_ASSERT_FALSE(rig.controller->indexed);
	TEST_ASSERT_FALSE(lw_controller_stepper_enabled(rig.controller));
	assert_refused(LW_REASON_MODE_OFF, lw_controller_allow_index(rig.controller, &why));
	assert_refused(LW_REASON_MODE_OFF, lw_controller_allow_jog(rig.controller, 1, &why));
	rig_drive(1000);
	rig_ticks(300);
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	rig_ticks(1);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	rig_index();
	rig_run_to(LW_STATE_TRACKING);
}

static void test_mode_off_in_motion_and_in_fault(void)
{
	rig_power_up();
	rig_index();
	rig_ticks(200);
	lw_controller_set_mode(rig.controller, LW_MODE_OFF);
	rig_ticks(1);

	const int32_t place = rig.carriage_usteps;

	rig_ticks(100);
	TEST_ASSERT_EQUAL_INT32(place, rig.carriage_usteps);
	rig.controller->fault = LW_FAULT_INDEX_SPAN;
	lw_controller_set_mode(rig.controller, LW_MODE_CENTRE);
	rig_ticks(1);
	TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
}

static void test_mode_centre_and_back(void)
{
	rig.params.centre_position_um = -10000;
	rig_track();
	rig_drive(10000);
	rig.drum_edges_per_s = 5000;
	rig_ticks(100);
	lw_controller_set_mode(rig.controller, LW_MODE_CENTRE);
	rig_ticks(100);
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
	TEST_ASSERT_EQUAL_INT(LW_MODE_TRACK, rig.controller->mode);
	rig.drum_edges_per_s = 0;
	rig_run_to(LW_STATE_CENTRING);
	TEST_ASSERT_EQUAL_INT(LW_MODE_CENTRE, rig.controller->mode);
	TEST_ASSERT_TRUE(lw_controller_moving(rig.controller));
	rig_run_to(LW_STATE_CENTRED);
	TEST_ASSERT_INT32_WITHIN(1, -1000, rig.carriage_usteps);
	rig_drive(10000);
	rig_ticks(300);
	TEST_ASSERT_INT32_WITHIN(1, -1000, rig.carriage_usteps);
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	rig_ticks(300);
	assert_pattern_goes_on();
}

static void test_mode_centre_from_parking_and_from_the_centre(void)
{
	rig_power_up();
	lw_controller_set_mode(rig.controller, LW_MODE_CENTRE);
	rig_ticks(10);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	rig_index();
	rig_run_to(LW_STATE_CENTRED);
	TEST_ASSERT_INT32_WITHIN(1, 0, rig.carriage_usteps);
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	rig_run_to(LW_STATE_TRACKING);
	rig_rest();
	lw_controller_set_mode(rig.controller, LW_MODE_CENTRE);
	rig_ticks(1); /* less than a microstep away: there already */
	TEST_ASSERT_EQUAL_INT(LW_STATE_CENTRED, rig.controller->state);
}

static void test_stop_while_centring_rests_inside_the_sweep(void)
{
	/* From the far point of a reversal, before the first edge, and later. */
	for (int ticks = 1; ticks < 300; ticks += 37) {
		rig_prepare(0);
		rig_track();
		lw_controller_set_mode(rig.controller, LW_MODE_CENTRE);
		rig_ticks(ticks);
		TEST_ASSERT_EQUAL_INT(LW_STATE_CENTRING, rig.controller->state);
		lw_controller_stop(rig.controller);
		rig_run_to(LW_STATE_READY);
		TEST_ASSERT_TRUE(rig.carriage_usteps > -8000);
		lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
		rig_run_to(LW_STATE_TRACKING);
		assert_pattern_goes_on();
	}
}

static void test_jog_without_an_index(void)
{
	rig_power_up();
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_jog(rig.controller, 1, &why));
	lw_controller_jog(rig.controller, 1, rig.now_us);
	TEST_ASSERT_EQUAL_INT(LW_STATE_JOGGING, rig.controller->state);
	TEST_ASSERT_EQUAL_UINT32(5000, lw_controller_timer_rate_edges_per_s(rig.controller));
	for (int i = 0; i < 10; i++) {
		rig_ticks(400);
		lw_controller_jog(rig.controller, 1, rig.now_us);
	}
	TEST_ASSERT_TRUE(rig.carriage_usteps > 7000);
	/* The switch is the limit. */
	rig_run_to(LW_STATE_UNINDEXED);
	TEST_ASSERT_INT32_WITHIN(260, 7840 + 250, rig.carriage_usteps);
	assert_refused(LW_REASON_LIMIT_SWITCH, lw_controller_allow_jog(rig.controller, 1, &why));
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_jog(rig.controller, -1, &why));
	lw_controller_jog(rig.controller, -1, rig.now_us);
	rig_ticks(300);
	TEST_ASSERT_TRUE(rig.carriage_usteps < 8000);
}

static void test_jog_ends_by_itself_when_it_is_not_written_again(void)
{
	rig_power_up();
	lw_controller_jog(rig.controller, -1, rig.now_us);
	rig_ticks(500);
	TEST_ASSERT_FALSE(rig.controller->moving.halting);
	rig_ticks(1);
	TEST_ASSERT_TRUE(rig.controller->moving.halting);
	assert_refused(LW_REASON_BUSY_MOVING, lw_controller_allow_jog(rig.controller, -1, &why));
	rig_run_to(LW_STATE_UNINDEXED);
}

static void test_jog_zero_ends_it_and_is_always_allowed(void)
{
	rig_power_up();
	lw_controller_jog(rig.controller, 0, rig.now_us);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	lw_controller_jog(rig.controller, 1, rig.now_us);
	rig_ticks(100);
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_jog(rig.controller, 1, &why));
	assert_refused(LW_REASON_BUSY_MOVING, lw_controller_allow_jog(rig.controller, -1, &why));
	assert_refused(LW_REASON_BUSY_MOVING, lw_controller_allow_index(rig.controller, &why));
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_jog(rig.controller, 0, &why));
	lw_controller_jog(rig.controller, 0, rig.now_us);
	rig_run_to(LW_STATE_UNINDEXED);
	TEST_ASSERT_TRUE(rig.carriage_usteps < 300);
}

static void test_jog_of_an_indexed_carriage_stops_inside_the_reversal_points(void)
{
	FOR_BOTH_WAYS(direction) {
		rig_prepare(0);
		rig.params.park_at = LW_PARK_AT_POSITION;
		rig_track();
		lw_controller_jog(rig.controller, direction, rig.now_us);
		for (int i = 0; i < 20000 && rig.controller->state == LW_STATE_JOGGING; i++) {
			rig_tick();
			if (i % 100 == 0) {
				lw_controller_jog(rig.controller, direction, rig.now_us);
			}
		}
		TEST_ASSERT_INT32_WITHIN(2, direction * 7998, rig.carriage_usteps);
		TEST_ASSERT_TRUE(rig.controller->indexed);
		rig_run_to(LW_STATE_TRACKING);
		assert_pattern_goes_on();
	}
}

static void test_jog_is_refused_while_tracking_a_turning_drum_or_indexing(void)
{
	rig_track();
	rig.drum_edges_per_s = 5000;
	rig_ticks(100);
	assert_refused(LW_REASON_BUSY_TRACKING, lw_controller_allow_jog(rig.controller, 1, &why));
	assert_refused(LW_REASON_DRUM_MOVING, lw_controller_allow_index(rig.controller, &why));
	rig_rest();
	rig_index();
	assert_refused(LW_REASON_BUSY_MOVING, lw_controller_allow_jog(rig.controller, 1, &why));
}

static void test_busy_says_why(void)
{
	rig_power_up();
	TEST_ASSERT_EQUAL_INT(0, lw_controller_busy(rig.controller, &why));
	rig_index();
	assert_refused(LW_REASON_BUSY_MOVING, lw_controller_busy(rig.controller, &why));
	rig_run_to(LW_STATE_TRACKING);
	assert_refused(LW_REASON_BUSY_TRACKING, lw_controller_busy(rig.controller, &why));
}

static void test_overtravel_while_tracking(void)
{
	FOR_EACH_SIDE(side) {
		rig_prepare(0);
		rig_track();
		rig_drive(10000);
		lw_controller_overtravel(rig.controller, side, true);
		rig_ticks(1);
		TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
		TEST_ASSERT_EQUAL_INT(side == LW_PLUS ? LW_FAULT_OVERTRAVEL_PLUS
						      : LW_FAULT_OVERTRAVEL_MINUS,
				      rig.controller->fault);
		TEST_ASSERT_FALSE(lw_controller_stepper_enabled(rig.controller));
		TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_OVERTRAVEL));
		TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_FAULT));
		assert_refused(LW_REASON_CAUSE_PRESENT,
			       lw_controller_allow_clear_fault(rig.controller, &why));

		/* Motion away only. */
		const int outward = lw_side_direction(side);

		assert_refused(LW_REASON_OVERTRAVEL,
			       lw_controller_allow_jog(rig.controller, outward, &why));
		TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_jog(rig.controller, -outward, &why));

		const int32_t place = rig.carriage_usteps;

		lw_controller_jog(rig.controller, -outward, rig.now_us);
		rig_ticks(300);
		TEST_ASSERT_TRUE(lw_controller_stepper_enabled(rig.controller));
		TEST_ASSERT_TRUE(-outward * (rig.carriage_usteps - place) > 100);
		lw_controller_stop(rig.controller);
		rig_run_to(LW_STATE_FAULT);
		lw_controller_overtravel(rig.controller, side, false);
		TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_clear_fault(rig.controller, &why));
		lw_controller_clear_fault(rig.controller);
		TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	}
}

static void test_overtravel_stops_steps_that_way_at_once(void)
{
	rig_track();
	rig_drive(10000);
	lw_controller_overtravel(rig.controller, LW_PLUS, true);

	const int32_t place = rig.carriage_usteps;

	rig_turn(1000);
	TEST_ASSERT_EQUAL_INT32(place, rig.carriage_usteps);
	rig_turn(-1000);
	TEST_ASSERT_TRUE(rig.carriage_usteps < place);
}

/* The contact is open again when the supervisor looks, but a step is missing. */
static void test_overtravel_between_two_ticks_is_a_fault_if_it_withheld_a_step(void)
{
	FOR_EACH_SIDE(side) {
		const int outward = side == LW_PLUS ? 1 : -1;

		for (int toward = 0; toward < 2; toward++) {
			rig_prepare(0);
			rig_track();
			rig_follow_to(0, toward ? outward : -outward, 40000);
			lw_controller_overtravel(rig.controller, side, true);
			rig_turn(48);
			lw_controller_overtravel(rig.controller, side, false);
			rig_ticks(1);
			TEST_ASSERT_EQUAL_INT(toward ? (side == LW_PLUS ? LW_FAULT_OVERTRAVEL_PLUS
									: LW_FAULT_OVERTRAVEL_MINUS)
						     : LW_FAULT_NONE,
					      rig.controller->fault);
			if (!toward) {
				TEST_ASSERT_EQUAL_INT32(0, rig_error_usteps());
				continue;
			}
			TEST_ASSERT_FALSE(rig.controller->indexed);
			TEST_ASSERT_EQUAL_INT(
				0, lw_controller_allow_clear_fault(rig.controller, &why));
		}
	}
}

static void test_overtravel_while_jogging_toward_it(void)
{
	rig_power_up();
	lw_controller_jog(rig.controller, 1, rig.now_us);
	rig_ticks(100);
	lw_controller_overtravel(rig.controller, LW_MINUS, true);
	rig_ticks(1);
	TEST_ASSERT_EQUAL_INT(LW_STATE_JOGGING, rig.controller->state); /* away from it */
	lw_controller_overtravel(rig.controller, LW_PLUS, true);
	rig_ticks(1);
	TEST_ASSERT_EQUAL_INT(LW_FAULT_OVERTRAVEL_PLUS, rig.controller->fault);
}

static void test_overtravel_in_mode_off_is_a_fault_only_afterwards(void)
{
	rig_power_up();
	lw_controller_set_mode(rig.controller, LW_MODE_OFF);
	rig_ticks(1);
	lw_controller_overtravel(rig.controller, LW_MINUS, true);
	rig_ticks(10);
	TEST_ASSERT_EQUAL_INT(LW_STATE_OFF, rig.controller->state);
	TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_OVERTRAVEL));
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	rig_ticks(2);
	TEST_ASSERT_EQUAL_INT(LW_FAULT_OVERTRAVEL_MINUS, rig.controller->fault);
}

static void test_overspeed(void)
{
	for (int sign = -1; sign <= 1; sign += 2) {
		rig_prepare(0);
		rig_track();
		rig.drum_edges_per_s = sign * 60000;
		rig_ticks(200);
		TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
		rig.drum_edges_per_s = sign * 61000;
		rig_ticks(200);
		TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
		TEST_ASSERT_EQUAL_INT(LW_FAULT_OVERSPEED, rig.controller->fault);
		TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_OVERSPEED));
		TEST_ASSERT_EQUAL_INT(-EBUSY,
				      lw_controller_allow_clear_fault(rig.controller, &why));
		TEST_ASSERT_EQUAL_UINT16(LW_REASON_CAUSE_PRESENT, why.reason);
		rig.drum_edges_per_s = sign * 50000;
		rig_ticks(200);
		TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_clear_fault(rig.controller, &why));
		lw_controller_clear_fault(rig.controller);
		TEST_ASSERT_FALSE(inhibited(LW_LAUNCH_INHIBIT_OVERSPEED));
	}
}

static void test_overspeed_of_a_drum_that_is_not_followed_is_no_fault(void)
{
	rig_power_up();
	rig.drum_edges_per_s = 90000;
	rig_ticks(200);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
}

static void test_a_wiring_fault_is_sticky_until_cleared(void)
{
	rig_track();
	rig_drive(10000);
	rig_set_switch(LW_MINUS, RIG_SWITCH_SHORTED);
	rig_ticks(19);
	TEST_ASSERT_FALSE(inhibited(LW_LAUNCH_INHIBIT_WIRING));
	rig_ticks(5);
	TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_WIRING));
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
	rig_set_switch(LW_MINUS, RIG_SWITCH_WORKS);
	rig_ticks(100);
	TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_WIRING));
	lw_controller_clear_fault(rig.controller);
	TEST_ASSERT_FALSE(inhibited(LW_LAUNCH_INHIBIT_WIRING));
	TEST_ASSERT_EQUAL_UINT16(0, lw_controller_launch_inhibit(rig.controller));
}

static void test_a_wiring_fault_that_stands_cannot_be_cleared(void)
{
	FOR_EACH_SIDE(side) {
		rig_prepare(0);
		rig_track();
		rig_set_switch(side, RIG_SWITCH_SHORTED);
		rig_ticks(30);
		TEST_ASSERT_EQUAL_INT(LW_FAULT_NONE, rig.controller->fault);
		assert_refused(LW_REASON_CAUSE_PRESENT,
			       lw_controller_allow_clear_fault(rig.controller, &why));
		rig_set_switch(side, RIG_SWITCH_WORKS);
		rig_ticks(30);
		TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_clear_fault(rig.controller, &why));
	}
}

static void test_another_mode_waits_for_the_drum_in_either_direction(void)
{
	rig_track();
	lw_controller_set_mode(rig.controller, LW_MODE_CENTRE);
	rig_run_to(LW_STATE_CENTRED);
	rig.drum_edges_per_s = 1000;
	rig_ticks(300);
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	rig_ticks(300);
	TEST_ASSERT_EQUAL_INT(LW_MODE_CENTRE, rig.controller->mode);
	TEST_ASSERT_EQUAL_INT(LW_STATE_CENTRED, rig.controller->state);
	rig_rest();
	TEST_ASSERT_EQUAL_INT(LW_MODE_TRACK, rig.controller->mode);
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
}

static void test_causes_of_faults_that_still_stand(void)
{
	FOR_EACH_SIDE(side) {
		rig_prepare(0);
		rig.switches[LW_PLUS] = RIG_SWITCH_ALWAYS;
		rig.switches[LW_MINUS] = RIG_SWITCH_ALWAYS;
		rig_power_up();
		rig_index();
		assert_refused(LW_REASON_CAUSE_PRESENT,
			       lw_controller_allow_clear_fault(rig.controller, &why));
		rig_set_switch(side, RIG_SWITCH_WORKS);
		TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_clear_fault(rig.controller, &why));
	}
	FOR_EACH_SIDE(side) {
		rig_prepare(0);
		rig.switches[side] = RIG_SWITCH_SHORTED;
		rig_power_up();
		rig_index();
		assert_refused(LW_REASON_CAUSE_PRESENT,
			       lw_controller_allow_clear_fault(rig.controller, &why));
		rig_set_switch(side, RIG_SWITCH_WORKS);
		rig_ticks(1);
		TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_clear_fault(rig.controller, &why));
	}
}

static void test_the_remaining_launch_inhibit_bits(void)
{
	rig_track();
	TEST_ASSERT_EQUAL_UINT16(0, lw_controller_launch_inhibit(rig.controller));
	rig.controller->master_lost = true;
	TEST_ASSERT_EQUAL_UINT16(1 << LW_LAUNCH_INHIBIT_MASTER_LOST,
				 lw_controller_launch_inhibit(rig.controller));
	rig.controller->master_lost = false;
	rig.controller->motion.requests = LW_MOTION_REQUEST_CORRECTION;
	TEST_ASSERT_EQUAL_UINT16(1 << LW_LAUNCH_INHIBIT_CORRECTION,
				 lw_controller_launch_inhibit(rig.controller));
}

static void test_the_direction_output_can_be_inverted(void)
{
	rig_prepare(0);
	rig.params.carriage_direction_invert = 1;
	rig_power_up();
	rig_index();
	rig_ticks(1000);
	TEST_ASSERT_TRUE(rig.carriage_usteps < -100);
}

static void test_a_stop_of_a_jog_ends_in_the_state_that_there_was(void)
{
	for (int fault = LW_FAULT_NONE; fault <= LW_FAULT_INDEX_SPAN;
	     fault += LW_FAULT_INDEX_SPAN) {
		rig_prepare(0);
		rig_power_up();
		rig.controller->fault = (enum lw_fault)fault;
		lw_controller_jog(rig.controller, 1, rig.now_us);
		rig_ticks(100);
		lw_controller_stop(rig.controller);
		rig_run_to(fault ? LW_STATE_FAULT : LW_STATE_UNINDEXED);
	}
}

static void test_a_fault_that_is_cleared_during_a_jog_is_not_its_end(void)
{
	rig_power_up();
	rig.controller->fault = LW_FAULT_INDEX_SPAN;
	lw_controller_jog(rig.controller, 1, rig.now_us);
	rig_ticks(100);
	lw_controller_clear_fault(rig.controller);
	lw_controller_jog(rig.controller, 0, rig.now_us);
	rig_run_to(LW_STATE_UNINDEXED);
}

static void test_a_place_on_the_orbit_is_none_once_it_is_lost(void)
{
	for (int fault = 0; fault < 2; fault++) {
		rig_prepare(0);
		rig_track();
		lw_controller_stop(rig.controller);
		TEST_ASSERT_TRUE(rig.controller->on_orbit);
		if (fault) {
			lw_controller_overtravel(rig.controller, LW_PLUS, true);
		} else {
			lw_controller_set_mode(rig.controller, LW_MODE_OFF);
		}
		rig_tick();
		TEST_ASSERT_EQUAL_INT(fault ? LW_STATE_FAULT : LW_STATE_OFF, rig.controller->state);
		/* Nothing to be trimmed. */
		lw_controller_set_trim(rig.controller, -500, 0);
		TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
	}
}

static void test_another_mode_ends_reacquiring_at_once(void)
{
	int32_t stands_usteps;

	rig_power_up();
	rig.drum_edges_per_s = 20000;
	rig_ticks(100);
	lw_controller_reacquire(rig.controller);
	lw_controller_set_mode(rig.controller, LW_MODE_CENTRE);
	rig.drum_edges_per_s = 0;
	rig_run_to(LW_STATE_UNINDEXED);
	stands_usteps = rig.carriage_usteps;
	rig_turn(30000);
	TEST_ASSERT_EQUAL_INT32(stands_usteps, rig.carriage_usteps);
}

static void test_another_set_that_needs_an_index_takes_it(void)
{
	for (int centre = 0; centre < 2; centre++) {
		rig_prepare(0);
		rig_track();
		lw_controller_set_mode(rig.controller, LW_MODE_CENTRE);
		rig_run_to(LW_STATE_CENTRED);
		if (!centre) {
			lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
			rig_run_to(LW_STATE_TRACKING);
			rig_rest();
			lw_controller_stop(rig.controller);
			TEST_ASSERT_EQUAL_INT(LW_STATE_READY, rig.controller->state);
		}
		lw_controller_configure(rig.controller, &rig.params, &rig.derived, false);
		TEST_ASSERT_TRUE(rig.controller->indexed);
		lw_controller_set_trim(rig.controller, 5, -5);
		rig.controller->resume.known = true;

		struct lw_params params = rig.params;
		struct lw_derived derived;

		params.reversal_plus_um = 79500;
		params.encoder_pulses_per_rev = 800;
		TEST_ASSERT_EQUAL_INT(0, lw_params_derive(&params, &derived, &why));
		FOR_EACH_SIDE(side) {
			rig.controller->limit[side].active = true; /* the wires say else */
		}
		lw_controller_configure(rig.controller, &params, &derived, true);
		TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
		TEST_ASSERT_FALSE(rig.controller->indexed);
		TEST_ASSERT_FALSE(rig.controller->on_orbit);
		TEST_ASSERT_FALSE(rig.controller->resume.known);
		TEST_ASSERT_EQUAL_PTR(&params, rig.controller->params);
		TEST_ASSERT_EQUAL_PTR(&derived, rig.controller->derived);
		TEST_ASSERT_EQUAL_INT32(1600, rig.controller->encoder_index.edges_per_rev);
		TEST_ASSERT_EQUAL_INT32(0, rig.controller->trim.plus_um);
		TEST_ASSERT_EQUAL_INT32(0, rig.controller->trim.minus_um);
		TEST_ASSERT_EQUAL_INT32(7950 * LW_USTEP, rig.controller->motion.window->sweep_end);
		TEST_ASSERT_EQUAL_INT32(derived.ka, rig.controller->motion.law.ka);
		TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
		FOR_EACH_SIDE(side) {
			TEST_ASSERT_FALSE(rig.controller->limit[side].active);
		}
	}
}

static void test_a_master_that_is_lost_says_nothing_about_the_drum(void)
{
	rig_power_up();
	rig.controller->drum_watch.running = true;
	assert_refused(LW_REASON_DRUM_RUNNING, lw_controller_allow_index(rig.controller, &why));
	rig.controller->master_lost = true;
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_index(rig.controller, &why));
}

static void test_rope_laid_standing_is_acknowledged_after_an_index(void)
{
	rig_track();
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_acknowledge_rope(rig.controller, &why));
	rig.controller->rope.set = true;
	rig.controller->rope.indexed_since = false;
	assert_refused(LW_REASON_ROPE_INDEX_FIRST,
		       lw_controller_allow_acknowledge_rope(rig.controller, &why));
	rig_index();
	rig_run_to(LW_STATE_TRACKING);
	rig_rest();
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_acknowledge_rope(rig.controller, &why));
	rig.controller->indexed = false;
	assert_refused(LW_REASON_ROPE_INDEX_FIRST,
		       lw_controller_allow_acknowledge_rope(rig.controller, &why));
}

static void test_rope_is_laid_standing_from_so_many_edges_on(void)
{
	static const struct {
		int32_t permille;
		uint32_t edges_per_1000_drum_revs;
		int32_t edges;
	} cases[] = {{250, 2880000, 720}, {1, 2880000, 2}, {1, 200000, 1}, {10000, 200000, 2000}};

	for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
		rig_prepare(0);
		rig.params.standing_turns_permille = cases[i].permille;
		rig_power_up();
		rig.derived.edges_per_1000_drum_revs = cases[i].edges_per_1000_drum_revs;
		rig_drive(cases[i].edges - 1);
		rig_ticks(1);
		TEST_ASSERT_FALSE(rig.controller->rope.set);
		rig_drive(1);
		TEST_ASSERT_TRUE(rig.controller->rope.set);
	}
	rig_prepare(0);
	rig.params.standing_turns_permille = 0;
	rig_power_up();
	rig_drive(30000);
	TEST_ASSERT_FALSE(rig.controller->rope.set);
}

static void test_another_set_keeps_a_fault(void)
{
	rig_power_up();
	rig.switches[LW_PLUS] = RIG_SWITCH_NEVER;
	rig_index();
	rig_run_to_fault(LW_FAULT_INDEX_NO_SWITCH);
	lw_controller_configure(rig.controller, &rig.params, &rig.derived, true);
	TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
}

static void test_jog_zero_moves_nothing_and_forgets_no_place(void)
{
	rig_power_up();
	lw_controller_jog(rig.controller, 1, rig.now_us);
	rig_ticks(300);
	lw_controller_jog(rig.controller, 0, rig.now_us);
	rig_run_to(LW_STATE_UNINDEXED);

	const int32_t m = lw_motion_m(&rig.controller->motion);

	TEST_ASSERT_NOT_EQUAL(0, m);
	lw_controller_jog(rig.controller, 0, rig.now_us);
	TEST_ASSERT_EQUAL_INT32(m, lw_motion_m(&rig.controller->motion));
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
}

static void test_jog_of_an_indexed_carriage_ends_two_microsteps_inside_and_goes_no_farther(void)
{
	FOR_BOTH_WAYS(direction) {
		const int32_t target = direction > 0 ? 7998 * LW_USTEP : -7997 * LW_USTEP;
		int32_t past;

		rig_prepare(0);
		rig.params.park_at = LW_PARK_AT_POSITION;
		rig.params.jog_hold_ms = 5000;
		rig_track();
		for (int i = 0; i < 3; i++) {
			lw_controller_jog(rig.controller, direction, rig.now_us);
			rig_ticks(4000);
		}
		TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
		past = direction * (lw_motion_m(&rig.controller->motion) - target);
		TEST_ASSERT_TRUE(0 <= past && past < rig.derived.ks);

		/* There it goes on following, whoever asks for more. */
		rig_ticks(1);
		lw_controller_jog(rig.controller, direction, rig.now_us);
		TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
		TEST_ASSERT_EQUAL_INT32(target + direction * past,
					lw_motion_m(&rig.controller->motion));
	}
}

static void test_a_long_hold_of_a_jog_is_exact(void)
{
	rig.params.jog_hold_ms = 2500;
	rig_power_up();
	lw_controller_jog(rig.controller, -1, rig.now_us);
	rig_ticks(2500);
	TEST_ASSERT_FALSE(rig.controller->moving.halting);
	rig_ticks(1);
	TEST_ASSERT_TRUE(rig.controller->moving.halting);
}

/** Something wrote over the window or the law. It is noted where the carriage was going. */
static void test_a_law_that_was_changed_is_mended_and_told(void)
{
	for (int what = 0; what < 4; what++) {
		FOR_EACH_SIDE(side) {
			struct lw_law_window stray;
			struct lw_law_window *window;

			rig_prepare(0);
			rig_track();
			rig_follow_to(0, lw_side_direction(side), 40000);
			rig_rest();
			TEST_ASSERT_FALSE(lw_controller_mend_law(rig.controller));
			window = rig.controller->motion.window == &rig.controller->windows[0]
					 ? &rig.controller->windows[0]
					 : &rig.controller->windows[1];
			stray = *window;
			switch (what) {
			case 0:
				rig.controller->motion.window = &stray;
				break;
			case 1:
				window->ka++;
				rig.controller->motion.law.ka++;
				break;
			case 2:
				window->ks++;
				rig.controller->motion.law.u += lw_side_direction(side);
				break;
			default:
				rig.controller->motion.law.span++;
				break;
			}
			TEST_ASSERT_TRUE(lw_controller_mend_law(rig.controller));
			TEST_ASSERT_FALSE(lw_controller_mend_law(rig.controller));
			TEST_ASSERT_TRUE(rig.controller->los.los2[side].set);
			TEST_ASSERT_FALSE(rig.controller->los.los2[!side].set);
			assert_pattern_goes_on();
		}
	}
}

/** A state that rests, and edges that go on moving the carriage: one of both is not true. */
static void test_what_moves_in_a_state_of_rest_is_stopped_and_not_known_any_more(void)
{
	static const struct {
		uint32_t state;
		bool indexed;
		uint32_t then;
	} states[] = {
		{LW_STATE_READY, true, LW_STATE_UNINDEXED},
		{LW_STATE_CENTRED, true, LW_STATE_UNINDEXED},
		{LW_STATE_UNINDEXED, false, LW_STATE_UNINDEXED},
		{LW_STATE_OFF, false, LW_STATE_OFF},
		{LW_STATE_FAULT, false, LW_STATE_FAULT},
	};

	for (size_t i = 0; i < sizeof(states) / sizeof(states[0]); i++) {
		for (int source = LW_EDGE_SOURCE_ENCODER; source <= LW_EDGE_SOURCE_TIMER;
		     source++) {
			rig_prepare(0);
			rig_track();
			TEST_ASSERT_FALSE(lw_controller_mend_rest(rig.controller));
			rig.controller->state = states[i].state;
			rig.controller->indexed = states[i].indexed;
			lw_motion_set_source(&rig.controller->motion, (enum lw_edge_source)source);
			TEST_ASSERT_TRUE(lw_controller_mend_rest(rig.controller));
			TEST_ASSERT_FALSE(lw_controller_mend_rest(rig.controller));
			TEST_ASSERT_EQUAL_INT(states[i].then, rig.controller->state);
			TEST_ASSERT_FALSE(rig.controller->indexed);
			TEST_ASSERT_EQUAL_INT(LW_EDGE_SOURCE_NONE, rig.controller->motion.source);
		}
	}
}

static void test_no_motion_is_taken_for_one_in_a_state_of_rest(void)
{
	static const uint32_t states[] = {
		LW_STATE_TRACKING, LW_STATE_REACQUIRING, LW_STATE_SEEKING, LW_STATE_BACKING_OFF,
		LW_STATE_PARKING,  LW_STATE_CENTRING,    LW_STATE_JOGGING};

	for (size_t i = 0; i < sizeof(states) / sizeof(states[0]); i++) {
		rig_prepare(0);
		rig_track();
		rig.controller->state = states[i];
		TEST_ASSERT_FALSE(lw_controller_mend_rest(rig.controller));
		TEST_ASSERT_EQUAL_INT(LW_EDGE_SOURCE_ENCODER, rig.controller->motion.source);
	}
}

static void test_what_has_ended_can_be_acknowledged(void)
{
	static const enum lw_fault ended[] = {LW_FAULT_INDEX_NO_SWITCH,
					      LW_FAULT_INDEX_WRONG_SWITCH,
					      LW_FAULT_INDEX_SPAN,
					      LW_FAULT_BACK_OFF_NO_RELEASE,
					      LW_FAULT_LOS_LIMIT,
					      LW_FAULT_REACQUIRE_NO_SWITCH,
					      LW_FAULT_REACQUIRE_WRONG_SWITCH};

	/* Whatever else is wrong: the cause of another fault keeps none of these. */
	rig_power_up();
	FOR_EACH_SIDE(side) {
		rig_set_switch(side, RIG_SWITCH_SHORTED);
		lw_controller_overtravel(rig.controller, side, true);
	}
	rig_ticks(1000);
	for (size_t i = 0; i < sizeof(ended) / sizeof(ended[0]); i++) {
		rig.controller->state = LW_STATE_FAULT;
		rig.controller->fault = ended[i];
		TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_clear_fault(rig.controller, &why));
		lw_controller_clear_fault(rig.controller);
		TEST_ASSERT_EQUAL_INT(LW_FAULT_NONE, rig.controller->fault);
		TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	}
}

static void test_a_switch_is_told_which_way_the_drum_has_turned_lately(void)
{
	for (int edges = -2; edges <= 2; edges++) {
		rig_prepare(0);
		rig_power_up();
		rig_turn(edges);
		TEST_ASSERT_EQUAL_INT8((edges > 0) - (edges < 0),
				       lw_controller_position(rig.controller).drum_direction);
	}
}

static void test_rope_laid_before_an_index_is_of_another_stand(void)
{
	rig_power_up();
	rig_drive(719);
	rig_rest();
	rig_index();
	rig_run_to(LW_STATE_PARKING);
	rig.controller->drum_watch.running = true; /* no hand-over */
	rig_run_to(LW_STATE_READY);
	rig_drive(719);
	TEST_ASSERT_FALSE(rig.controller->rope.set);
	rig_drive(1);
	TEST_ASSERT_TRUE(rig.controller->rope.set);
}

static void test_no_rope_at_all_may_be_told(void)
{
	rig.params.rope_diameter_um = 5000;
	rig.params.drum_core_diameter_um = 300000;
	rig.params.rope_packing_permille = 900;
	rig_power_up();
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_set_rope(rig.controller, 0, &why));
	assert_refused(LW_REASON_ROPE_LENGTH_MISSING,
		       lw_controller_allow_set_rope(rig.controller, -1, &why));
}

static void test_the_last_microstep_of_a_jog(void)
{
	FOR_BOTH_WAYS(direction) {
		for (int32_t left_usteps = 0; left_usteps <= 1; left_usteps++) {
			struct lw_motion *motion;

			rig_prepare(0);
			rig.params.park_at = LW_PARK_AT_POSITION;
			rig_track();
			motion = &rig.controller->motion;
			lw_motion_set_source(motion, LW_EDGE_SOURCE_NONE);
			lw_motion_set_position(
				motion, motion->window,
				((direction > 0 ? 7998 : -7997) - direction * left_usteps) *
					LW_USTEP,
				motion->law.u);
			lw_motion_set_source(motion, LW_EDGE_SOURCE_ENCODER);
			lw_controller_jog(rig.controller, direction, rig.now_us);
			TEST_ASSERT_EQUAL_INT(left_usteps ? LW_STATE_JOGGING : LW_STATE_TRACKING,
					      rig.controller->state);
		}
	}
}

static void test_each_jog_without_an_index_goes_as_far_as_the_travel(void)
{
	rig_power_up();
	for (int i = 0; i < 2; i++) {
		lw_controller_jog(rig.controller, -1, rig.now_us);
		TEST_ASSERT_EQUAL_INT32(0, lw_law_pos_usteps(lw_motion_m(&rig.controller->motion)));
		rig_ticks(200);
		lw_controller_jog(rig.controller, 0, rig.now_us);
		rig_run_to(LW_STATE_UNINDEXED);
	}
}

static void test_a_jog_begins_where_a_correction_has_led(void)
{
	rig_track();
	rig_follow_to(1000, 1, 20000);
	rig_rest();
	rig.controller->motion.request_correction_usteps = -300;
	rig.controller->motion.requests = LW_MOTION_REQUEST_CORRECTION;
	rig_place(rig.carriage_usteps - 300);
	lw_controller_jog(rig.controller, 1, rig.now_us);
	TEST_ASSERT_EQUAL_INT(LW_STATE_JOGGING, rig.controller->state);
	TEST_ASSERT_INT32_WITHIN(2, 0, rig_error_usteps());
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_power_up_is_unindexed_and_inhibited);
	RUN_TEST(test_hand_over_from_the_flange_keeps_the_orbit);
	RUN_TEST(test_paper_row_hand_over_sets_the_slope);
	RUN_TEST(test_hand_over_only_onto_a_resting_drum);
	RUN_TEST(test_a_slow_creep_counts_as_rest);
	RUN_TEST(test_the_speed_is_measured_with_its_sign);
	RUN_TEST(test_stop_while_tracking_a_resting_drum_keeps_the_index);
	RUN_TEST(test_stop_while_tracking_a_turning_drum_loses_the_index);
	RUN_TEST(test_stop_inside_a_reversal_and_on_again_stays_in_the_pattern);
	RUN_TEST(test_jog_outward_inside_a_reversal_stays_in_the_pattern);
	RUN_TEST(test_a_trim_that_leaves_the_resting_carriage_outside);
	RUN_TEST(test_mode_off_and_back);
	RUN_TEST(test_mode_off_in_motion_and_in_fault);
	RUN_TEST(test_mode_centre_and_back);
	RUN_TEST(test_mode_centre_from_parking_and_from_the_centre);
	RUN_TEST(test_stop_while_centring_rests_inside_the_sweep);
	RUN_TEST(test_jog_without_an_index);
	RUN_TEST(test_jog_ends_by_itself_when_it_is_not_written_again);
	RUN_TEST(test_jog_zero_ends_it_and_is_always_allowed);
	RUN_TEST(test_jog_of_an_indexed_carriage_stops_inside_the_reversal_points);
	RUN_TEST(test_jog_is_refused_while_tracking_a_turning_drum_or_indexing);
	RUN_TEST(test_busy_says_why);
	RUN_TEST(test_overtravel_while_tracking);
	RUN_TEST(test_overtravel_stops_steps_that_way_at_once);
	RUN_TEST(test_overtravel_between_two_ticks_is_a_fault_if_it_withheld_a_step);
	RUN_TEST(test_overtravel_while_jogging_toward_it);
	RUN_TEST(test_overtravel_in_mode_off_is_a_fault_only_afterwards);
	RUN_TEST(test_overspeed);
	RUN_TEST(test_overspeed_of_a_drum_that_is_not_followed_is_no_fault);
	RUN_TEST(test_a_wiring_fault_is_sticky_until_cleared);
	RUN_TEST(test_a_wiring_fault_that_stands_cannot_be_cleared);
	RUN_TEST(test_another_mode_waits_for_the_drum_in_either_direction);
	RUN_TEST(test_causes_of_faults_that_still_stand);
	RUN_TEST(test_the_remaining_launch_inhibit_bits);
	RUN_TEST(test_the_direction_output_can_be_inverted);
	RUN_TEST(test_a_stop_of_a_jog_ends_in_the_state_that_there_was);
	RUN_TEST(test_a_fault_that_is_cleared_during_a_jog_is_not_its_end);
	RUN_TEST(test_a_place_on_the_orbit_is_none_once_it_is_lost);
	RUN_TEST(test_another_mode_ends_reacquiring_at_once);
	RUN_TEST(test_another_set_that_needs_an_index_takes_it);
	RUN_TEST(test_a_master_that_is_lost_says_nothing_about_the_drum);
	RUN_TEST(test_rope_laid_standing_is_acknowledged_after_an_index);
	RUN_TEST(test_rope_is_laid_standing_from_so_many_edges_on);
	RUN_TEST(test_another_set_keeps_a_fault);
	RUN_TEST(test_jog_zero_moves_nothing_and_forgets_no_place);
	RUN_TEST(test_jog_of_an_indexed_carriage_ends_two_microsteps_inside_and_goes_no_farther);
	RUN_TEST(test_a_long_hold_of_a_jog_is_exact);
	RUN_TEST(test_a_law_that_was_changed_is_mended_and_told);
	RUN_TEST(test_what_moves_in_a_state_of_rest_is_stopped_and_not_known_any_more);
	RUN_TEST(test_no_motion_is_taken_for_one_in_a_state_of_rest);
	RUN_TEST(test_what_has_ended_can_be_acknowledged);
	RUN_TEST(test_a_switch_is_told_which_way_the_drum_has_turned_lately);
	RUN_TEST(test_rope_laid_before_an_index_is_of_another_stand);
	RUN_TEST(test_no_rope_at_all_may_be_told);
	RUN_TEST(test_the_last_microstep_of_a_jog);
	RUN_TEST(test_each_jog_without_an_index_goes_as_far_as_the_travel);
	RUN_TEST(test_a_jog_begins_where_a_correction_has_led);
	return UNITY_END();
}
