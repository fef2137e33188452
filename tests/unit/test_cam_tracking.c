/* SPDX-License-Identifier: Apache-2.0 */
/* The carriage follows the drum by a cam: starts, what it does with switches, how it ends. */
#include "cam_rig.h"
#include "cases.h"

static const struct lw_cam_row hill[] = {{0, 40}, {1000, 1540}, {3000, -460}, {4000, 40}};

void setUp(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
}

void tearDown(void)
{
	cases_end();
}

/** Where hill has the slave. Its slopes are whole or halves, halves up. */
static int32_t hill_at(int64_t master)
{
	const int32_t at = (int32_t)((master % 4000 + 4000) % 4000);

	if (at < 1000) {
		return 40 + (3 * at + 1) / 2;
	}
	return at < 3000 ? 1540 - (at - 1000) : -460 + (at - 2999) / 2;
}

static int32_t pos_usteps(void)
{
	return lw_law_pos_usteps(lw_motion_m(&rig.controller->motion));
}

static int64_t net_edges(void)
{
	return lw_motion_read(&rig.controller->motion).net_edges;
}

/** With hill in force, indexed, following the drum. */
static void follow_hill(enum lw_cam_start start)
{
	put_in_force(CAM_TABLE(hill));
	use_cam(start, LW_CAM_AXIS_CARRIAGE);
	track();
}

static void assert_on_hill(int64_t phase)
{
	TEST_ASSERT_EQUAL_INT32(hill_at(net_edges() + phase), pos_usteps());
	TEST_ASSERT_EQUAL_INT32(hill_at(net_edges() + phase), status()->cam_position_usteps);
	TEST_ASSERT_INT32_WITHIN(1, rig_error_usteps(), 0);
}

static void test_absolute_begins_where_the_odometer_is(void)
{
	rig_turn(9234);
	rig_rest();
	follow_hill(LW_CAM_START_ABSOLUTE);
	command(LW_COMMAND_ACKNOWLEDGE_ROPE);
	/* It went there before it followed. */
	TEST_ASSERT_INT32_WITHIN(4, hill_at(9234), pos_usteps());
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_cycles);
	for (int64_t run = 777; run > -9000; run -= 1111) {
		rig_drive(run);
		rig_drive(2);
		assert_on_hill(0);
		TEST_ASSERT_EQUAL_INT64(0, status()->cam_waiting);
	}
	TEST_ASSERT_TRUE(flag(LW_FLAG_LAUNCH_PERMIT));
}

static void test_relative_begins_here(void)
{
	int32_t begin;

	rig_turn(1234);
	rig_rest();
	put_in_force(CAM_TABLE(hill));
	use_cam(LW_CAM_START_RELATIVE, LW_CAM_AXIS_CARRIAGE);
	/* From the middle, so that nothing of it is beyond a flange. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_CENTRED);
	begin = pos_usteps();
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_EQUAL_INT32(begin, pos_usteps());
	for (int32_t run = 777; run > -9000; run -= 1111) {
		rig_drive(run);
		TEST_ASSERT_EQUAL_INT32(
			begin + hill_at(lw_motion_read(&rig.controller->motion).pattern_edges) - 40,
			pos_usteps());
	}
}

static void test_next_cycle_waits_at_the_begin(void)
{
	FOR_BOTH_WAYS(dd) {
		setUp();
		rig_turn(3000);
		rig_rest();
		follow_hill(LW_CAM_START_NEXT_CYCLE);
		TEST_ASSERT_INT32_WITHIN(4, 40, pos_usteps());
		TEST_ASSERT_EQUAL_INT32(1, status()->cam_waiting);
		rig_drive(dd > 0 ? 999 : -3000);
		TEST_ASSERT_EQUAL_INT32(40, pos_usteps());
		TEST_ASSERT_EQUAL_INT32(1, status()->cam_waiting);
		rig_drive(dd);
		TEST_ASSERT_EQUAL_INT32(0, status()->cam_waiting);
		rig_drive(dd * 4321);
		assert_on_hill(0);
	}
}

static void test_the_table_is_shown_while_it_runs(void)
{
	follow_hill(LW_CAM_START_ABSOLUTE);
	TEST_ASSERT_EQUAL_INT32(4, status()->cam_rows);
	TEST_ASSERT_EQUAL_INT32(4000, status()->cam_cycle_edges);
	TEST_ASSERT_EQUAL_INT32(-460, status()->cam_min_usteps);
	TEST_ASSERT_EQUAL_INT32(1540, status()->cam_max_usteps);
	TEST_ASSERT_EQUAL_INT32(1500, status()->cam_slope_max_permille);
	rig_drive(2 * 4000 + 1500 - net_edges());
	TEST_ASSERT_EQUAL_INT32(2, status()->cam_row);
	TEST_ASSERT_EQUAL_INT32(2, status()->cam_cycles);
	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_row);
}

static void test_the_phase_shifts_while_it_runs(void)
{
	follow_hill(LW_CAM_START_ABSOLUTE);
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_CAM_PHASE_EDGES, 500));
	TEST_ASSERT_EQUAL_INT32(500,
				read_register(LW_SPACE_HOLDING, LW_ADDRESS_CAM_PHASE_EDGES + 1));
	rig_drive(200);
	TEST_ASSERT_TRUE(status()->cam_phase_in_force_edges <= 200);
	rig_drive(1000);
	TEST_ASSERT_EQUAL_INT32(500, status()->cam_phase_in_force_edges);
	assert_on_hill(500);
	/* The next hand-over begins with it. */
	rig_rest();
	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	rig_run_to(LW_STATE_CENTRED);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig_run_to(LW_STATE_TRACKING);
	rig_drive(4);
	TEST_ASSERT_EQUAL_INT32(500, status()->cam_phase_in_force_edges);
	assert_on_hill(500);
}

static void test_the_phase_counts_at_the_start(void)
{
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_CAM_PHASE_EDGES, -700));
	follow_hill(LW_CAM_START_ABSOLUTE);
	TEST_ASSERT_EQUAL_INT32(-700, status()->cam_phase_in_force_edges);
	rig_drive(4);
	assert_on_hill(-700);
}

static void test_pulses_have_room_for_the_rate_that_the_drum_may_reach(void)
{
	const uint32_t top = lw_params_default.overspeed_trip_edges_per_s;
	static const struct {
		uint32_t rate; /* times the top edge rate, in halves */
		int steps_max;
	} cases[] = {{3, 2}, {4, 2}, {6, 3}, {8, 4}, {20, 4}};

	for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
		setUp();
		TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_CAM_STEPS_PER_S_MAX,
						    (int32_t)(top * cases[i].rate / 2)));
		follow_hill(LW_CAM_START_ABSOLUTE);
		TEST_ASSERT_EQUAL_INT(cases[i].steps_max, rig.controller->motion.cam.steps_max);
	}
	/* A flat table, and pulses slower than the edges: one at a time. */
	setUp();
	put_in_force((struct lw_cam_table){.row_count = 2, .rows = {{0, 9}, {1000, 9}}});
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_CAM_STEPS_PER_S_MAX, 1000));
	use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
	track();
	TEST_ASSERT_EQUAL_INT(1, rig.controller->motion.cam.steps_max);
	rig_drive(20);
	TEST_ASSERT_EQUAL_INT32(9, pos_usteps());
}

static void test_without_a_table_there_is_no_permit(void)
{
	/* APPLY would not let it happen; a stored set can meet an empty bank. */
	struct lw_params params = lw_params_default;
	uint8_t record[LW_PARAM_RECORD_SIZE];

	params.motion_profile = LW_MOTION_PROFILE_CAM;
	(void)lw_param_record_encode(&params, 1, record);
	power_up(record, sizeof(record));
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_READY);
	rig_ticks(1000);
	TEST_ASSERT_EQUAL_INT32(LW_STATE_READY, status()->state);
	TEST_ASSERT_EQUAL_INT32(LW_REASON_CAM_NO_TABLE, status()->cam_reason);
	TEST_ASSERT_TRUE(status()->launch_inhibit >> LW_LAUNCH_INHIBIT_CAM & 1);
	/* One that comes is followed. */
	put_in_force(CAM_TABLE(hill));
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_EQUAL_INT32(LW_REASON_NONE, status()->cam_reason);
	TEST_ASSERT_EQUAL_INT32(0, status()->launch_inhibit);
	rig_drive(100);
	assert_on_hill(0);
}

static void test_a_relative_start_beyond_a_flange_is_not_made(void)
{
	static const struct lw_cam_row rows[] = {{0, 0}, {20000, -900}, {40000, 0}};

	put_in_force(CAM_TABLE(rows)); /* the indexing ends near the minus side */
	use_cam(LW_CAM_START_RELATIVE, LW_CAM_AXIS_CARRIAGE);
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_READY);
	rig_ticks(500);
	TEST_ASSERT_EQUAL_INT32(LW_STATE_READY, status()->state);
	TEST_ASSERT_EQUAL_INT32(LW_REASON_CAM_BEYOND_FLANGE, status()->cam_reason);
	TEST_ASSERT_EQUAL_INT32(2, status()->cam_reason_row);
	TEST_ASSERT_TRUE(status()->launch_inhibit >> LW_LAUNCH_INHIBIT_CAM & 1);
	TEST_ASSERT_EQUAL_INT(0,
			      write_register(LW_ADDRESS_MOTION_PROFILE, LW_MOTION_PROFILE_SCREW));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_FALSE(status()->launch_inhibit >> LW_LAUNCH_INHIBIT_CAM & 1);
	/* From the middle it can be made. */
	use_cam(LW_CAM_START_RELATIVE, LW_CAM_AXIS_CARRIAGE);
	rig_ticks(1);
	TEST_ASSERT_TRUE(status()->launch_inhibit >> LW_LAUNCH_INHIBIT_CAM & 1);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	rig_run_to(LW_STATE_CENTRED);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_EQUAL_INT32(0, status()->launch_inhibit);
}

/** Between the switches, over both of them at the ends. */
static const struct lw_cam_row wide[] = {{0, 0}, {8000, 7900}, {24000, -7900}, {32000, 0}};

static void test_switches_in_their_places_are_no_loss(void)
{
	/* A delay of the switches is not taken out of a cam: it would be 117 microsteps. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_SWITCH_DELAY_US, 7000));
	put_in_force(CAM_TABLE(wide));
	use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
	track();
	rig_drive(70000);
	rig_drive(-70000);
	TEST_ASSERT_TRUE(flag(LW_FLAG_LAUNCH_PERMIT));
	TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
	/* Nor is a turn before the switch. */
	setUp();
	follow_hill(LW_CAM_START_ABSOLUTE);
	rig_drive(70000);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
}

static void test_a_switch_that_never_triggers_is_a_loss(void)
{
	static const struct lw_cam_row widest[] = {
		{0, 0}, {9000, 8200}, {27000, -8200}, {36000, 0}};

	FOR_EACH_SIDE(side) {
		setUp();
		put_in_force(CAM_TABLE(widest));
		use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
		track();
		rig_drive(80000);
		rig_drive(-80000);
		TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
		rig_set_switch(side, RIG_SWITCH_NEVER);
		rig_drive(80000);
		TEST_ASSERT_TRUE(rig.controller->los.los1[side].set);
		TEST_ASSERT_FALSE(rig.controller->los.los1[1 - side].set);
		TEST_ASSERT_FALSE(rig.controller->los.los2[0].set ||
				  rig.controller->los.los2[1].set);
		TEST_ASSERT_FALSE(flag(LW_FLAG_LAUNCH_PERMIT));
	}
}

/** A cam goes back while the drum goes on, and the law's slope is that of before. */
static void test_a_switch_that_closes_on_the_way_back_has_not_triggered(void)
{
	static const int64_t just_behind_the_turn_edges[] = {8030, 24030};

	FOR_EACH_SIDE(side) {
		for (int way = -1; way <= 1; way += 2) {
			setUp();
			put_in_force(CAM_TABLE(wide));
			use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
			track();
			rig.controller->motion.law.u = way * rig.controller->derived->ks;
			rig_set_switch(side, RIG_SWITCH_NEVER);
			rig_drive(just_behind_the_turn_edges[side] - net_edges());
			TEST_ASSERT_EQUAL_INT(-lw_side_direction(side),
					      lw_motion_direction(&rig.controller->motion));
			rig_set_switch(side, RIG_SWITCH_WORKS);
			TEST_ASSERT_TRUE(rig_contact_no(side));
			rig_ticks(20);
			TEST_ASSERT_TRUE(rig.controller->limit[side].active);
			TEST_ASSERT_FALSE(rig.controller->los.triggered[side]);
		}
	}
}

static void test_a_switch_elsewhere_is_a_loss_that_is_not_corrected(void)
{
	put_in_force(CAM_TABLE(wide));
	use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
	track();
	rig.switch_at_usteps[LW_PLUS] -= 300;
	rig_drive(40000);
	TEST_ASSERT_TRUE(rig.controller->los.los2[LW_PLUS].set);
	TEST_ASSERT_EQUAL_INT32(7540 * LW_USTEP, rig.controller->los.los2[LW_PLUS].position_q16);
	TEST_ASSERT_FALSE(rig.controller->los.los1[LW_PLUS].set ||
			  rig.controller->los.los1[LW_MINUS].set);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LAUNCH_PERMIT));
	TEST_ASSERT_EQUAL_INT32(LW_STATE_TRACKING, status()->state);
	TEST_ASSERT_EQUAL_INT32(0, rig.controller->motion.corrected_usteps);
	TEST_ASSERT_EQUAL_INT32(0, rig.controller->los.recoveries);
	TEST_ASSERT_EQUAL_INT32(0, rig_error_usteps());
}

static void test_overtravel_blocks_and_stops(void)
{
	follow_hill(LW_CAM_START_ABSOLUTE);
	rig_drive(100);
	lw_controller_overtravel(rig.controller, LW_PLUS, true);
	const int32_t place = rig.carriage_usteps;

	rig_turn(500); /* upward, before any tick */
	TEST_ASSERT_EQUAL_INT32(place, rig.carriage_usteps);
	rig_tick();
	TEST_ASSERT_EQUAL_INT(LW_FAULT_OVERTRAVEL_PLUS, rig.controller->fault);
	TEST_ASSERT_FALSE(rig.controller->motion.cam.on);
}

static void test_a_trim_does_not_move_it(void)
{
	follow_hill(LW_CAM_START_ABSOLUTE);
	rig_drive(700);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_TRIM_PLUS_UM, -300));
	rig_drive(5000);
	assert_on_hill(0);
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
}

static void test_back_to_the_screw(void)
{
	follow_hill(LW_CAM_START_ABSOLUTE);
	rig_drive(700);
	rig_rest();
	command(LW_COMMAND_STOP);
	TEST_ASSERT_FALSE(rig.controller->on_orbit);
	TEST_ASSERT_EQUAL_INT(0,
			      write_register(LW_ADDRESS_MOTION_PROFILE, LW_MOTION_PROFILE_SCREW));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_FALSE(rig.controller->motion.cam.on);
	rig_drive(100000);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
	TEST_ASSERT_TRUE(rig.controller->motion.law.open_span != 0); /* the short way */
}

static void test_a_free_axis_is_geared_and_ends_at_0(void)
{
	static const struct lw_cam_row rows[] = {{0, 0}, {7, 3}};
	struct lw_cam_table gear = CAM_TABLE(rows);

	gear.advance = 3;
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_AXIS, LW_CAM_AXIS_FREE));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_START, LW_CAM_START_RELATIVE));
	command(LW_COMMAND_APPLY);
	put_in_force(gear);
	use_cam(LW_CAM_START_RELATIVE, LW_CAM_AXIS_FREE);
	track();
	rig.switch_at_usteps[LW_PLUS] = 100;        /* means nothing */
	rig_set_switch(LW_PLUS, RIG_SWITCH_ALWAYS); /* nor does this, far from its place */
	rig_drive(7000);
	rig_ticks(100);
	TEST_ASSERT_FALSE(flag(LW_FLAG_SWITCH_IMPLAUSIBLE));
	rig_set_switch(LW_PLUS, RIG_SWITCH_WORKS);
	rig_drive(63000);
	TEST_ASSERT_EQUAL_INT32(30000, status()->cam_position_usteps);
	TEST_ASSERT_EQUAL_INT32(10000, status()->cam_cycles);
	rig_drive(-140000);
	TEST_ASSERT_EQUAL_INT32(-30000, status()->cam_position_usteps);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
	rig_rest();
	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_INT32(0, lw_motion_m(&rig.controller->motion));
	TEST_ASSERT_EQUAL_INT32(0, rig.controller->motion.law.u);
}

static void test_an_absolute_start_of_a_free_axis_is_refused(void)
{
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_AXIS, LW_CAM_AXIS_FREE));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_REFUSED, LW_REASON_CAM_FREE_AXIS);
	TEST_ASSERT_EQUAL_INT32(LW_ADDRESS_CAM_START, status()->command_address);
}

static void test_a_queued_table_gets_the_steps_that_it_asks_for(void)
{
	static const struct {
		uint32_t slope_permille;
		int steps_max;
	} cases[] = {{0, 1},    {1, 1},    {1000, 1}, {1001, 2}, {2000, 2},
		     {2001, 3}, {3000, 3}, {3001, 4}, {4000, 4}};

	put_in_force((struct lw_cam_table){.row_count = 2, .rows = {{0, 9}, {1000, 9}}});
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_CAM_STEPS_PER_S_MAX, 1000));
	use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
	track();
	for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
		struct lw_cam_bank bank = *rig.controller->cam_bank;

		bank.statistics.slope_max_permille = cases[i].slope_permille;
		rig.controller->motion.cam.steps_max = 0;
		lw_cam_queue(rig.controller, &bank);
		TEST_ASSERT_EQUAL_INT(cases[i].steps_max, rig.controller->motion.cam.steps_max);
		TEST_ASSERT_EQUAL_PTR(&bank.table, rig.controller->motion.cam.next);
		rig.controller->motion.cam.next = NULL;
	}
}

/** Stop, and follow again: what was under way before is of no account. */
static void follow_anew(void)
{
	rig_rest();
	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig_run_to(LW_STATE_TRACKING);
}

static void test_a_start_elsewhere_goes_on_into_the_rows_of_there(void)
{
	const struct lw_cam_motion *cam = &rig.device.controller.motion.cam;

	follow_hill(LW_CAM_START_ABSOLUTE);
	rig_rest();
	command(LW_COMMAND_STOP);
	rig_turn(2500);
	follow_anew();
	/* The first edges come before the next tick does: what they lead into is prepared. */
	TEST_ASSERT_EQUAL_UINT32(LW_CAM_RING_SLOTS, cam->ring.count);
	for (int i = 0; i < 40; i++) {
		rig_drive(100);
		assert_on_hill(0);
	}
	/* And goes on to be. */
	rig_drive(40000);
	TEST_ASSERT_LESS_THAN_UINT32(cam->ring.count, cam->cam.serial + 1 - cam->ring.begin);
}

static void test_a_table_that_waited_for_the_end_of_a_cycle_waits_no_more_after_a_stop(void)
{
	struct lw_cam_bank flat;

	follow_hill(LW_CAM_START_ABSOLUTE);
	flat = cam_bank((struct lw_cam_table){.row_count = 2, .rows = {{0, 40}, {4000, 40}}});
	lw_cam_queue(rig.controller, &flat);
	follow_anew();
	rig_drive(4500);
	assert_on_hill(0);
}

static void test_a_cam_may_reach_the_flanges(void)
{
	/* A relative start begins in the middle, which its first row is. */
	static const enum lw_cam_start starts[] = {LW_CAM_START_ABSOLUTE, LW_CAM_START_RELATIVE};
	const struct lw_params *params = &rig.device.active;
	const int32_t plus = lw_params_um_to_usteps(params, params->flange_plus_um);
	const int32_t minus = lw_params_um_to_usteps(params, params->flange_minus_um);

	for (int i = 0; i < 2; i++) {
		for (int32_t beyond = 0; beyond <= i; beyond++) {
			const int32_t first = i * 40;
			int32_t from;

			setUp();
			TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
			command(LW_COMMAND_INDEX);
			rig_run_to(LW_STATE_CENTRED);
			TEST_ASSERT_EQUAL_INT(
				0, write_register(LW_ADDRESS_CAM_START, (int32_t)starts[i]));
			command(LW_COMMAND_APPLY);
			from = i * (pos_usteps() - first);
			put_in_force((struct lw_cam_table){.row_count = 4,
							   .rows = {{0, first},
								    {20000, plus - from + beyond},
								    {60000, minus - from},
								    {80000, first}}});
			use_cam(starts[i], LW_CAM_AXIS_CARRIAGE);
			TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
			rig_ticks(1000);
			TEST_ASSERT_EQUAL_INT32(beyond ? LW_REASON_CAM_BEYOND_FLANGE
						       : LW_REASON_NONE,
						status()->cam_reason);
			TEST_ASSERT_EQUAL(!beyond, status()->state == LW_STATE_TRACKING);
		}
	}
}

static void test_what_one_edge_makes_good_needs_no_move(void)
{
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_CENTRED);
	for (int32_t off_usteps = -LW_CAM_STEPS_PER_EDGE_MAX - 1;
	     off_usteps <= LW_CAM_STEPS_PER_EDGE_MAX + 1; off_usteps++) {
		const int32_t slave = pos_usteps() + off_usteps;
		int steps_max;

		put_in_force(
			(struct lw_cam_table){.row_count = 2, .rows = {{0, slave}, {1000, slave}}});
		use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
		rig_tick();
		steps_max = rig.controller->motion.cam.steps_max;
		TEST_ASSERT_TRUE(0 < steps_max && steps_max < LW_CAM_STEPS_PER_EDGE_MAX + 1);
		TEST_ASSERT_EQUAL_INT(-steps_max <= off_usteps && off_usteps <= steps_max
					      ? LW_STATE_TRACKING
					      : LW_STATE_CENTRING,
				      rig.controller->state);
		rig_run_to(LW_STATE_TRACKING);
		rig_drive(2);
		TEST_ASSERT_EQUAL_INT32(slave, pos_usteps());
		rig_rest();
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
		rig_run_to(LW_STATE_CENTRED);
	}
}

/** The judgement of the switches asks it for reversals. */
static void test_a_cam_has_the_window_of_the_pattern_and_a_slope(void)
{
	struct lw_law_window expected;

	put_in_force(CAM_TABLE(hill));
	use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_CENTRED);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig_run_to(LW_STATE_TRACKING); /* after two moves: no window of before is left */
	expected = lw_params_window(&rig.device.active, rig.controller->derived, 0, 0);
	TEST_ASSERT_EQUAL_MEMORY(&expected, rig.controller->motion.window, sizeof(expected));
	TEST_ASSERT_EQUAL_INT32(LW_USTEP, rig.controller->motion.law.u);
}

static void test_a_trim_that_waits_is_no_request_to_a_cam(void)
{
	put_in_force(CAM_TABLE(hill));
	command(LW_COMMAND_INDEX);
	rig.drum_edges_per_s = 1000;
	rig_run_to(LW_STATE_READY);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_TRIM_MINUS_UM, 300));
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_WINDOW, rig.controller->motion.requests);
	use_cam(LW_CAM_START_RELATIVE, LW_CAM_AXIS_FREE); /* which may begin at the flange */
	rig.drum_edges_per_s = 0;
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_absolute_begins_where_the_odometer_is);
	RUN_TEST(test_relative_begins_here);
	RUN_TEST(test_next_cycle_waits_at_the_begin);
	RUN_TEST(test_the_table_is_shown_while_it_runs);
	RUN_TEST(test_the_phase_shifts_while_it_runs);
	RUN_TEST(test_the_phase_counts_at_the_start);
	RUN_TEST(test_pulses_have_room_for_the_rate_that_the_drum_may_reach);
	RUN_TEST(test_without_a_table_there_is_no_permit);
	RUN_TEST(test_a_relative_start_beyond_a_flange_is_not_made);
	RUN_TEST(test_switches_in_their_places_are_no_loss);
	RUN_TEST(test_a_switch_that_never_triggers_is_a_loss);
	RUN_TEST(test_a_switch_that_closes_on_the_way_back_has_not_triggered);
	RUN_TEST(test_a_switch_elsewhere_is_a_loss_that_is_not_corrected);
	RUN_TEST(test_overtravel_blocks_and_stops);
	RUN_TEST(test_a_trim_does_not_move_it);
	RUN_TEST(test_back_to_the_screw);
	RUN_TEST(test_a_free_axis_is_geared_and_ends_at_0);
	RUN_TEST(test_an_absolute_start_of_a_free_axis_is_refused);
	RUN_TEST(test_a_queued_table_gets_the_steps_that_it_asks_for);
	RUN_TEST(test_a_start_elsewhere_goes_on_into_the_rows_of_there);
	RUN_TEST(test_a_table_that_waited_for_the_end_of_a_cycle_waits_no_more_after_a_stop);
	RUN_TEST(test_a_cam_may_reach_the_flanges);
	RUN_TEST(test_what_one_edge_makes_good_needs_no_move);
	RUN_TEST(test_a_cam_has_the_window_of_the_pattern_and_a_slope);
	RUN_TEST(test_a_trim_that_waits_is_no_request_to_a_cam);
	return UNITY_END();
}
