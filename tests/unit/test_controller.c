/* The life of the controller: modes, hand-over, stop, jog, overtravel, overspeed, interlocks. */
#include <errno.h>

#include <unity.h>

#include "law_check.h"
#include "rig.h"

static struct lw_refusal why;

void setUp(void)
{
	rig_prepare(0);
}

void tearDown(void)
{
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
	for (int side = 0; side < 2; side++) {
		rig_prepare(0);
		rig.params.index_switch = side;
		rig_track();
		TEST_ASSERT_EQUAL_INT32(0, rig.controller->motion.law.u);
		assert_pattern_goes_on();
	}
}

static void test_paper_row_hand_over_sets_the_slope(void)
{
	for (int side = 0; side < 2; side++) {
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
	TEST_ASSERT_TRUE(rig.controller->drum_at_rest);
	rig.drum_edges_per_s = 60;
	rig_ticks(1000);
	TEST_ASSERT_FALSE(rig.controller->drum_at_rest);
}

static void test_the_speed_is_measured_with_its_sign(void)
{
	rig_power_up();
	rig.drum_edges_per_s = 32000;
	rig_ticks(100);
	TEST_ASSERT_EQUAL_INT32(32000, rig.controller->drum_speed_edges_per_s);
	rig.drum_edges_per_s = -8000;
	rig_ticks(100);
	TEST_ASSERT_EQUAL_INT32(-8000, rig.controller->drum_speed_edges_per_s);
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
	rig.params.park_at = LW_PARK_AT_POSITION;
	rig_track();
	lw_controller_jog(rig.controller, 1, rig.now_us);
	while (rig.carriage_usteps < 7900) {
		rig_tick();
		lw_controller_jog(rig.controller, 1, rig.now_us);
	}
	rig.drum_edges_per_s = 1000;
	rig_run_to(LW_STATE_READY);
	lw_controller_set_trim(rig.controller, -1500, 0);
	rig.drum_edges_per_s = 0;
	rig_run_to(LW_STATE_TRACKING);
	assert_pattern_goes_on();
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
	TEST_ASSERT_FALSE(rig.controller->halting);
	rig_ticks(1);
	TEST_ASSERT_TRUE(rig.controller->halting);
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
	for (int direction = -1; direction <= 1; direction += 2) {
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
	for (int side = 0; side < 2; side++) {
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
		rig.drum_edges_per_s = 0;
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

static void test_causes_of_faults_that_still_stand(void)
{
	rig.switches[LW_PLUS] = RIG_SWITCH_ALWAYS;
	rig.switches[LW_MINUS] = RIG_SWITCH_ALWAYS;
	rig_power_up();
	rig_index();
	assert_refused(LW_REASON_CAUSE_PRESENT,
		       lw_controller_allow_clear_fault(rig.controller, &why));
	rig_set_switch(LW_PLUS, RIG_SWITCH_WORKS);
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_clear_fault(rig.controller, &why));

	for (int side = 0; side < 2; side++) {
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
	RUN_TEST(test_overtravel_while_jogging_toward_it);
	RUN_TEST(test_overtravel_in_mode_off_is_a_fault_only_afterwards);
	RUN_TEST(test_overspeed);
	RUN_TEST(test_overspeed_of_a_drum_that_is_not_followed_is_no_fault);
	RUN_TEST(test_a_wiring_fault_is_sticky_until_cleared);
	RUN_TEST(test_causes_of_faults_that_still_stand);
	RUN_TEST(test_the_remaining_launch_inhibit_bits);
	RUN_TEST(test_the_direction_output_can_be_inverted);
	return UNITY_END();
}
