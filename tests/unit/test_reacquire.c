/* SPDX-License-Identifier: Apache-2.0 */
/* A restart in a launch: the turning drum is taken up from rest at an unknown place. */
#include <string.h>

#include <unity.h>

#include "cases.h"
#include "device_rig.h"
#include "law_check.h"
#include "lw/motion/move.h"

static struct lw_kept kept;
static struct lw_device_config with_memory = {
	.host = LW_HOST_SIMULATOR, .store = &rig.store, .kept = &kept};

static void restart(void)
{
	const struct lw_inputs inputs = rig_inputs();

	lw_device_init(&rig.device, &with_memory, &inputs, rig.now_us, rig.now_us);
	rig.controller = &rig.device.controller;
	rig.with_device = true;
}

/** A controller that has just been switched on, with these parameters stored. */
static void begin(int32_t by_itself)
{
	kept = (struct lw_kept){0};
	lw_store_init(&rig.store);
	rig.store.params.index_rate_edges_per_s = 20000;
	rig.store.params.reacquire_after_restart = by_itself;
	restart();
	rig_ticks(300);
}

/** Indexed and in a launch, the carriage at a place and going toward a side. */
static void launch(int32_t usteps, int toward, int drum_edges_per_s)
{
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_TRACKING);
	rig_follow_to(usteps, toward, drum_edges_per_s);
}

void setUp(void)
{
	rig_prepare(0);
	begin(0);
}

void tearDown(void)
{
	cases_end();
}

/** Until it follows; no step comes before the ramp has reached its slope. */
static void run_to_tracking(void)
{
	for (int i = 0; i < 60000 && rig.controller->state == LW_STATE_REACQUIRING; i++) {
		const struct lw_law *law = &rig.controller->motion.law;

		TEST_ASSERT_TRUE(law_on_orbit(law, rig.controller->motion.window));
		TEST_ASSERT_FALSE(flag(LW_FLAG_LAUNCH_PERMIT));
		TEST_ASSERT_TRUE(flag(LW_FLAG_LOS));
		TEST_ASSERT_TRUE(flag(LW_FLAG_REACQUIRED));
		rig_tick();
	}
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
}

static void check_reacquired(void)
{
	run_to_tracking();
	rig_ticks(3000);
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
	TEST_ASSERT_INT32_WITHIN(2, 0, rig_error_usteps());
	TEST_ASSERT_TRUE(law_on_orbit(&rig.controller->motion.law, rig.controller->motion.window));
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LAUNCH_PERMIT));
	TEST_ASSERT_TRUE(flag(LW_FLAG_LOS));
	FOR_EACH_SIDE(side) {
		TEST_ASSERT_FALSE(rig.controller->los.los1[side].set);
		TEST_ASSERT_FALSE(rig.controller->los.los2[side].set);
	}
}

static void test_from_anywhere_in_the_direction_that_was(void)
{
	/* In the sweep, a ramp and less before a switch, beyond it, in the reversal. */
	static const int32_t places[] = {0,    -5000, 5000, 7500, 7600,  7700,  7780,  7830,
					 7838, 7845,  7990, 8100, -7500, -7700, -7838, -8100};
	static const int speeds[] = {12000, 40000};

	for (size_t i = 0; i < sizeof(places) / sizeof(places[0]); i++) {
		for (size_t s = 0; s < 2; s++) {
			for (int way = 0; way < 4; way++) {
				const int toward = way & 1 ? 1 : -1;
				const int drum = way & 2 ? 1 : -1;
				int direction;

				rig_prepare(0);
				begin(0);
				launch(places[i], toward, drum * speeds[s]);
				direction = rig.controller->motion.law.u > 0 ? drum : -drum;
				restart();
				rig_ticks(350);
				TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
				command(LW_COMMAND_REACQUIRE);
				assert_command(LW_COMMAND_REACQUIRE, LW_RESULT_IN_PROGRESS,
					       LW_REASON_NONE);
				if (rig.actuated[LW_PLUS] || rig.actuated[LW_MINUS]) {
					direction = rig.actuated[LW_PLUS] ? -1 : 1;
				}
				TEST_ASSERT_EQUAL_INT(direction > 0 ? LW_PLUS : LW_MINUS,
						      rig.controller->reacquire.side);
				check_reacquired();
				assert_command(LW_COMMAND_REACQUIRE, LW_RESULT_DONE,
					       LW_REASON_NONE);
			}
		}
	}
}

static void test_only_an_index_clears_it(void)
{
	launch(0, 1, 20000);
	restart();
	rig_ticks(350);
	command(LW_COMMAND_REACQUIRE);
	check_reacquired();
	rig_rest();
	TEST_ASSERT_TRUE(status()->launch_inhibit & 1 << LW_LAUNCH_INHIBIT_LOS);
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
	TEST_ASSERT_FALSE(flag(LW_FLAG_REACQUIRED));
}

static void test_a_drum_that_comes_back_leads_back(void)
{
	for (int drum = -1; drum <= 1; drum += 2) {
		int32_t from_usteps;

		rig_prepare(0);
		begin(0);
		launch(6000, 1, drum * 20000);
		restart();
		rig_ticks(350);
		from_usteps = rig.carriage_usteps;
		command(LW_COMMAND_REACQUIRE);
		rig_ticks(40);
		/* Back over the far point, and away from it again: never behind it. */
		rig.drum_edges_per_s = -drum * 20000;
		for (int i = 0; i < 60; i++) {
			rig_tick();
			TEST_ASSERT_TRUE(
				(rig.carriage_usteps - from_usteps) *
					lw_side_direction(rig.controller->reacquire.side) >=
				-1);
		}
		check_reacquired();
	}
}

static void test_a_trigger_is_taken_up_where_the_drum_comes_back(void)
{
	/* In the moment of the trigger the drum turns back; on the ramp and in the sweep. */
	static const int32_t places[] = {7000, 7780, 7830};

	for (size_t i = 0; i < sizeof(places) / sizeof(places[0]); i++) {
		rig_prepare(0);
		begin(0);
		launch(places[i], 1, 20000);
		restart();
		rig_ticks(350);
		command(LW_COMMAND_REACQUIRE);
		while (!rig.actuated[LW_PLUS]) {
			rig_turn(1);
		}
		rig_turn(-30);
		rig.drum_edges_per_s = -20000;
		for (int k = 0; k < 20; k++) {
			rig_tick();
			TEST_ASSERT_TRUE(law_on_orbit(&rig.controller->motion.law,
						      rig.controller->motion.window));
		}
		rig.drum_edges_per_s = 20000;
		check_reacquired();
	}
}

/** The switch ahead closes while the drum, and the carriage with it, goes back. */
static void test_a_trigger_on_the_way_back_is_none(void)
{
	FOR_EACH_SIDE(side) {
		const int toward = lw_side_direction(side);

		setUp();
		launch(0, toward, 20000);
		restart();
		rig_ticks(350);
		command(LW_COMMAND_REACQUIRE);
		rig_ticks(150);
		rig.drum_edges_per_s = -20000;
		rig_ticks(20);
		rig_set_switch(side, RIG_SWITCH_ALWAYS);
		rig_ticks(20);
		TEST_ASSERT_TRUE(rig.controller->limit[side].active);
		rig_set_switch(side, RIG_SWITCH_WORKS);
		rig_ticks(20);
		TEST_ASSERT_EQUAL_INT(LW_STATE_REACQUIRING, rig.controller->state);
		rig.drum_edges_per_s = 20000;
		check_reacquired();
	}
}

static void test_a_late_trigger_past_the_reversal_point_is_made_good(void)
{
	/* The tick comes so late that the carriage is past the reversal point: brought to it. */
	FOR_EACH_SIDE(side) {
		const int toward = lw_side_direction(side);

		setUp();
		launch(toward * 3000, toward, 20000);
		restart();
		rig_ticks(350);
		command(LW_COMMAND_REACQUIRE);
		rig_follow_to(toward * 7800, toward, 20000);
		while (!rig.actuated[side]) {
			rig_turn(1);
		}
		rig_turn(600);
		rig_tick();
		TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
		TEST_ASSERT_TRUE(flag(LW_FLAG_CORRECTION_PENDING));
		check_reacquired();
	}
}

static void run_to_fault(enum lw_fault fault)
{
	rig_run_to_fault(fault);
	assert_command(LW_COMMAND_REACQUIRE, LW_RESULT_FAILED, LW_REASON_FAULTED);
	TEST_ASSERT_TRUE(flag(LW_FLAG_LOS));
}

static void restart_and_reacquire(void)
{
	launch(0, 1, 20000);
	restart();
	rig_ticks(350);
	command(LW_COMMAND_REACQUIRE);
}

static void test_what_goes_wrong_is_a_named_fault(void)
{
	restart_and_reacquire();
	rig_set_switch(LW_PLUS, RIG_SWITCH_NEVER);
	run_to_fault(LW_FAULT_REACQUIRE_NO_SWITCH);
	TEST_ASSERT_INT32_WITHIN(300, 18000, rig.carriage_usteps);

	setUp();
	restart_and_reacquire();
	rig_set_switch(LW_MINUS, RIG_SWITCH_ALWAYS);
	run_to_fault(LW_FAULT_REACQUIRE_WRONG_SWITCH);

	setUp();
	restart_and_reacquire();
	rig_set_switch(LW_PLUS, RIG_SWITCH_SHORTED);
	run_to_fault(LW_FAULT_WIRING_PLUS);

	setUp();
	restart_and_reacquire();
	rig_set_switch(LW_MINUS, RIG_SWITCH_SHORTED);
	run_to_fault(LW_FAULT_WIRING_MINUS);

	setUp();
	restart_and_reacquire();
	rig_ticks(50);
	lw_controller_overtravel(rig.controller, LW_PLUS, true);
	run_to_fault(LW_FAULT_OVERTRAVEL_PLUS);

	setUp();
	restart_and_reacquire();
	rig.drum_edges_per_s = 61000;
	run_to_fault(LW_FAULT_OVERSPEED);
}

static void test_a_switch_that_sticks_behind_is_the_wrong_one(void)
{
	launch(-7900, -1, 20000);
	restart();
	rig_ticks(350);
	TEST_ASSERT_TRUE(rig.actuated[LW_MINUS]);
	rig_set_switch(LW_MINUS, RIG_SWITCH_ALWAYS);
	command(LW_COMMAND_REACQUIRE);
	run_to_fault(LW_FAULT_REACQUIRE_WRONG_SWITCH);
	TEST_ASSERT_TRUE(rig.carriage_usteps < -5000);
}

static void test_it_does_not_begin_with_contradicting_switches(void)
{
	static const struct {
		int side;
		enum rig_switch what;
		enum lw_fault fault;
	} cases[] = {{LW_PLUS, RIG_SWITCH_SHORTED, LW_FAULT_WIRING_PLUS},
		     {LW_MINUS, RIG_SWITCH_SHORTED, LW_FAULT_WIRING_MINUS},
		     {LW_MINUS, RIG_SWITCH_ALWAYS, LW_FAULT_BOTH_SWITCHES_ACTIVE}};

	for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
		uint32_t steps;

		setUp();
		launch(0, 1, 20000);
		rig_set_switch(cases[i].side, cases[i].what);
		if (cases[i].what == RIG_SWITCH_ALWAYS) {
			rig_set_switch(LW_PLUS, RIG_SWITCH_ALWAYS);
		}
		restart();
		rig_ticks(350);
		steps = rig.controller->motion.steps;
		command(LW_COMMAND_REACQUIRE);
		TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
		rig_ticks(10);
		TEST_ASSERT_EQUAL_INT(cases[i].fault, rig.controller->fault);
		TEST_ASSERT_EQUAL_UINT32(steps, rig.controller->motion.steps);
	}
}

static void test_when_it_is_refused(void)
{
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_DRUM_AT_REST);
	command(LW_COMMAND_INDEX);
	rig_ticks(10);
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_BUSY_MOVING);
	rig_run_to(LW_STATE_TRACKING);
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_BUSY_TRACKING);
	command(LW_COMMAND_STOP);
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_POSITION_KNOWN);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_OFF));
	rig_ticks(2);
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_MODE_OFF);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	rig.drum_edges_per_s = 20000;
	rig_ticks(100);
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_NOT_MODE_TRACK);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig.controller->drum_watch.doubtful = true;
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_ENCODER_DOUBTFUL);
	rig.controller->drum_watch.doubtful = false;
	rig.device.active.motion_profile = LW_MOTION_PROFILE_CAM;
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_NOT_MODE_TRACK);
	rig.device.active.motion_profile = LW_MOTION_PROFILE_SCREW;
	lw_controller_overtravel(rig.controller, LW_PLUS, true);
	rig_ticks(2);
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_FAULT_STANDS);
	/* Just stopped, it may still coast. */
	setUp();
	launch(0, 1, 20000);
	command(LW_COMMAND_STOP);
	rig_ticks(290);
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_BUSY_MOVING);
	rig_ticks(20);
	command(LW_COMMAND_REACQUIRE);
	/* A drum that creeps, either way. */
	setUp();
	rig.drum_edges_per_s = -40;
	rig_ticks(200);
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_DRUM_AT_REST);
	rig.drum_edges_per_s = 40;
	rig_ticks(200);
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_DRUM_AT_REST);
}

static void test_what_may_be_asked_meanwhile(void)
{
	restart_and_reacquire();
	rig_ticks(20);
	assert_command_refused(LW_COMMAND_REACQUIRE, LW_REASON_BUSY_TRACKING);
	assert_command_refused(LW_COMMAND_APPLY, LW_REASON_BUSY_TRACKING);
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_register(LW_ADDRESS_JOG, 1));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_BUSY_TRACKING, why.reason);
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_register(LW_ADDRESS_SWITCH_DEBOUNCE_MS, 4));
	/* Another mode waits for the drum. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	run_to_tracking();
	rig_ticks(100);
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);

	/* At rest it takes effect: the place is still unknown. */
	setUp();
	restart_and_reacquire();
	rig_ticks(20);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	rig.drum_edges_per_s = 0;
	rig_ticks(400);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	assert_command(LW_COMMAND_REACQUIRE, LW_RESULT_FAILED, LW_REASON_STOPPED);

	const int32_t stands_usteps = rig.carriage_usteps;

	rig.drum_edges_per_s = 20000;
	rig_ticks(300);
	TEST_ASSERT_EQUAL_INT32(stands_usteps, rig.carriage_usteps);

	/* A stop ends it. */
	setUp();
	restart_and_reacquire();
	rig_ticks(20);
	command(LW_COMMAND_STOP);
	rig_ticks(20);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	TEST_ASSERT_EQUAL_UINT8(LW_EDGE_SOURCE_NONE, rig.controller->motion.source);

	/* At rest an indexing may begin. */
	setUp();
	restart_and_reacquire();
	rig_ticks(20);
	rig.drum_edges_per_s = 0;
	rig_ticks(400);
	TEST_ASSERT_EQUAL_INT(LW_STATE_REACQUIRING, rig.controller->state);
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
	TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
}

static void test_by_itself_only_within_a_launch_that_was_kept(void)
{
	/* As told, once a carriage that coasts has come to rest. */
	begin(1);
	launch(0, 1, 20000);
	restart();
	rig_ticks(290);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	rig_ticks(20);
	TEST_ASSERT_EQUAL_INT(LW_STATE_REACQUIRING, rig.controller->state);
	TEST_ASSERT_EQUAL_INT(LW_PLUS, rig.controller->reacquire.side);
	check_reacquired();

	/* Again, in the middle of it: still the same launch. */
	restart();
	rig_ticks(320);
	restart();
	rig_ticks(320);
	TEST_ASSERT_EQUAL_INT(LW_STATE_REACQUIRING, rig.controller->state);
	check_reacquired();

	/* What is disturbed in a launch is set right before long. */
	kept.seal ^= 1;
	rig_ticks(LW_SET_COPY_TICKS);
	restart();
	rig_ticks(320);
	TEST_ASSERT_EQUAL_INT(LW_STATE_REACQUIRING, rig.controller->state);
	check_reacquired();

	/* Not where the memory was lost, was never there, or has been disturbed. */
	for (int how = 0; how < 3; how++) {
		if (how == 0) {
			kept = (struct lw_kept){0};
		} else if (how == 1) {
			memset(&kept, 0xA5, sizeof(kept));
		} else {
			kept.launch = 1;
		}
		restart();
		rig_ticks(3000);
		TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	}
}

static void test_by_itself_not_where_the_launch_is_over(void)
{
	/* The drum rested when the controller restarted. */
	begin(1);
	launch(0, 1, 20000);
	rig_rest();
	restart();
	rig_ticks(10);
	rig.drum_edges_per_s = 20000;
	rig_ticks(3000);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);

	/* It comes to rest before; it turns later. */
	begin(1);
	rig.drum_edges_per_s = 0;
	rig_ticks(300);
	launch(0, 1, 20000);
	restart();
	rig.drum_edges_per_s = 0;
	rig_ticks(500);
	rig.drum_edges_per_s = 20000;
	rig_ticks(3000);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);

	/* It creeps for long, and never rests. */
	setUp();
	begin(1);
	launch(0, 1, 20000);
	restart();
	rig.device.active.rest_time_ms = 10000;
	lw_set_copy_keep(&rig.device.set_copy, &rig.device.active, &rig.device.derived);
	rig.drum_edges_per_s = 0;
	rig_ticks(2100);
	rig.drum_edges_per_s = 20000;
	rig_ticks(1000);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);

	/* A stop, another mode, a fault: somebody is at work. */
	for (int what = 0; what < 3; what++) {
		setUp();
		begin(1);
		launch(0, 1, 20000);
		restart();
		rig_ticks(50);
		if (what == 0) {
			command(LW_COMMAND_STOP);
		} else if (what == 1) {
			(void)write_register(LW_ADDRESS_MODE, LW_MODE_OFF);
		} else {
			lw_controller_overtravel(rig.controller, LW_MINUS, true);
		}
		rig_ticks(1000);
		TEST_ASSERT_NOT_EQUAL(LW_STATE_REACQUIRING, rig.controller->state);
		TEST_ASSERT_NOT_EQUAL(LW_STATE_TRACKING, rig.controller->state);
	}

	/* And never without the parameter. */
	setUp();
	launch(0, 1, 20000);
	restart();
	rig_ticks(3000);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
}

static void test_without_a_memory_the_hand_over_s_direction_is_taken(void)
{
	for (int side = 0; side < 2; side++) {
		for (int drum = -1; drum <= 1; drum += 2) {
			setUp();
			with_memory.kept = NULL;
			rig.store.params.handover_direction = side;
			restart();
			rig.drum_edges_per_s = drum * 20000;
			rig_ticks(350);
			command(LW_COMMAND_REACQUIRE);
			TEST_ASSERT_EQUAL_INT(lw_side_direction(side) * drum > 0 ? LW_PLUS
										 : LW_MINUS,
					      rig.controller->reacquire.side);
			with_memory.kept = &kept;
			check_reacquired();
		}
	}
}

static void test_it_is_in_the_log_and_outlasts_a_power_cut(void)
{
	unsigned int started = 0;
	unsigned int done = 0;

	restart_and_reacquire();
	check_reacquired();
	for (size_t i = 0; i < LW_LOG_RECORDS; i++) {
		started += rig.store.log.records[i].event == LW_EVENT_REACQUIRE_STARTED;
		done += rig.store.log.records[i].event == LW_EVENT_REACQUIRE_DONE;
	}
	TEST_ASSERT_EQUAL_UINT(1, started);
	TEST_ASSERT_EQUAL_UINT(1, done);
	rig_rest();
	while (rig_write_slot(0) >= 0) {
	}
	TEST_ASSERT_TRUE(rig.store.look.causes >> LW_LOOK_REACQUIRED & 1);
	kept = (struct lw_kept){0};
	restart();
	rig_ticks(10);
	TEST_ASSERT_TRUE(flag(LW_FLAG_REACQUIRED));
	TEST_ASSERT_TRUE(flag(LW_FLAG_LOS));
	TEST_ASSERT_EQUAL_UINT16(1 << LW_LOOK_REACQUIRED,
				 status()->look_before_power_up & 1 << LW_LOOK_REACQUIRED);
}

/** Both ends, every pattern, either direction of the drum: on the orbit from the first edge. */
static void test_the_way_from_rest_and_the_turn_are_on_the_orbit(void)
{
	static const struct {
		int32_t ka;
		int32_t nr;
	} slopes[] = {{23, 1187}, {1, 1}, {65535, 1}, {1, 3000}, {4000, 16}, {700, 93}};
	uint64_t seed = 5;

	for (size_t i = 0; i < sizeof(slopes) / sizeof(slopes[0]); i++) {
		for (int way = 0; way < 4; way++) {
			const int direction = way & 1 ? 1 : -1;
			const int dd = way & 2 ? 1 : -1;
			const int32_t ka = slopes[i].ka;
			const int32_t nr = slopes[i].nr;
			struct lw_law_window window;
			const int32_t m = lw_move_from_far_point(&window, ka, nr, 18000, direction);
			struct lw_law law = lw_law_at(&window, m, 0);
			int32_t slope = 0;

			TEST_ASSERT_TRUE(law_on_orbit(&law, &window));
			for (int32_t edge = 1; edge <= nr + 5; edge++) {
				(void)lw_law_edge(&law, dd);
				slope += slope < ka * nr ? ka : 0;
				TEST_ASSERT_TRUE(law_on_orbit(&law, &window));
				TEST_ASSERT_EQUAL_INT32(direction * dd * slope, law.u);
				if (lw_law_region(&window, lw_law_m(&law)) == 0 ||
				    next_random(&seed) % 8 != 0) {
					continue;
				}
				/* From here round at once, or back. */
				for (int back = 0; back < 2; back++) {
					struct lw_law_window turned;
					const int32_t from =
						lw_move_turn(&turned, ka, nr, 18000, direction,
							     lw_law_m(&law), law.u);
					struct lw_law round = lw_law_at(&turned, from, law.u);

					TEST_ASSERT_EQUAL_INT32(lw_law_pos_usteps(lw_law_m(&law)),
								lw_law_pos_usteps(from));
					TEST_ASSERT_TRUE(law_on_orbit(&round, &turned));
					for (int32_t k = 0; k < 2 * nr + 5; k++) {
						(void)lw_law_edge(&round, back ? -dd : dd);
						TEST_ASSERT_TRUE(law_on_orbit(&round, &turned));
					}
					TEST_ASSERT_EQUAL_INT(
						0, lw_law_region(&turned, lw_law_m(&round)));
				}
			}
		}
	}
}

static void test_the_limits_of_what_is_allowed_are_within_it(void)
{
	const int32_t rest = lw_params_default.rest_edges_per_s;
	struct lw_controller *controller;

	launch(0, 1, 20000);
	restart();
	rig_ticks(350);
	controller = rig.controller;
	for (int way = -1; way <= 1; way += 2) {
		controller->speed.edges_per_s = way * rest;
		TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_reacquire(controller, &why));
		controller->speed.edges_per_s = way * (rest - 1);
		TEST_ASSERT_EQUAL_INT(-EBUSY, lw_controller_allow_reacquire(controller, &why));
		TEST_ASSERT_EQUAL_UINT16(LW_REASON_DRUM_AT_REST, why.reason);
	}
	controller->speed.edges_per_s = rest;
	controller->reacquire.stands_since_us = controller->now_us - 300000;
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_reacquire(controller, &why));
	controller->reacquire.stands_since_us++;
	TEST_ASSERT_EQUAL_INT(-EBUSY, lw_controller_allow_reacquire(controller, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_BUSY_MOVING, why.reason);
}

static void test_by_itself_until_two_seconds_after_the_restart(void)
{
	for (int late_us = 0; late_us <= 1; late_us++) {
		setUp();
		begin(1);
		launch(0, 1, 20000);
		restart();
		rig_ticks(200);
		rig.controller->reacquire.stands_since_us =
			rig.now_us + LW_CONTROLLER_TICK_US - 2000000 - (uint64_t)late_us;
		rig_tick();
		TEST_ASSERT_EQUAL_INT(late_us ? LW_STATE_UNINDEXED : LW_STATE_REACQUIRING,
				      rig.controller->state);
	}
}

static void test_a_stop_before_holds_nothing_that_comes_after(void)
{
	launch(0, 1, 20000);
	command(LW_COMMAND_STOP);
	rig_ticks(320);
	command(LW_COMMAND_REACQUIRE);
	check_reacquired();
	rig_rest();
	/* Jogged, and let go: it follows on. */
	lw_controller_jog(rig.controller, rig.carriage_usteps > 0 ? -1 : 1, rig.now_us);
	rig_run_to(LW_STATE_TRACKING);
}

static void test_a_stop_lets_no_edge_move_it(void)
{
	int32_t from_usteps;

	restart_and_reacquire();
	rig_ticks(100);
	lw_controller_stop(rig.controller);
	from_usteps = rig.carriage_usteps;
	rig_turn(20000); /* before any tick */
	TEST_ASSERT_EQUAL_INT32(from_usteps, rig.carriage_usteps);
}

/** On the way to a side, past the ramp, the drum standing for a moment. */
static void reacquire_to_the_sweep(int side)
{
	launch(0, lw_side_direction(side), 20000);
	restart();
	rig_ticks(350);
	command(LW_COMMAND_REACQUIRE);
	while (!lw_motion_in_sweep(&rig.controller->motion)) {
		rig_tick();
	}
	rig.drum_edges_per_s = 0;
	rig_tick();
}

static void test_a_place_is_taken_up_to_the_bit_and_its_rest_is_whole_microsteps(void)
{
	/* Behind a border, Q16.16, and what is left to be made good. */
	static const struct {
		int32_t behind;
		int32_t rest_usteps;
	} cases[] = {{-1, 0}, {0, 1}, {1, 1}, {LW_USTEP, 2}},
	  at_minus[] = {{0, 0}, {1, -1}, {LW_USTEP, -1}, {LW_USTEP + 1, -2}};

	for (size_t i = 0; i < 8; i++) {
		const bool plus = i < 4;
		const int32_t behind = plus ? cases[i].behind : at_minus[i - 4].behind;
		const int32_t rest = plus ? cases[i].rest_usteps : at_minus[i - 4].rest_usteps;
		struct lw_motion *motion;
		struct lw_law_window window;
		int32_t shift_usteps;
		int32_t place;

		setUp();
		reacquire_to_the_sweep(LW_PLUS);
		motion = &rig.controller->motion;
		window = lw_params_window(&rig.device.active, rig.controller->derived, 0, 0);
		place = plus ? window.sweep_end + behind : window.sweep_begin - behind;
		/* The law counts it elsewhere, in its own sweep. */
		shift_usteps = lw_law_pos_usteps(place) - 1000;
		lw_motion_set_source(motion, LW_EDGE_SOURCE_NONE);
		lw_motion_set_position(motion, motion->window, place - shift_usteps * LW_USTEP,
				       motion->law.u);
		lw_motion_set_source(motion, LW_EDGE_SOURCE_ENCODER);
		rig.controller->reacquire.shift_usteps = shift_usteps;
		rig.controller->reacquire.turning = true;
		rig_tick();
		TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
		TEST_ASSERT_EQUAL_INT32(place - rest * LW_USTEP, lw_motion_m(motion));
		TEST_ASSERT_TRUE(lw_motion_in_sweep(motion));
		TEST_ASSERT_EQUAL_INT32(rest, motion->request_correction_usteps);
		TEST_ASSERT_EQUAL_UINT8(rest != 0 ? LW_MOTION_REQUEST_CORRECTION : 0,
					motion->requests);
	}
}

static void test_each_is_counted_and_begins_anew(void)
{
	for (uint16_t times = 1; times <= 2; times++) {
		int32_t turned_usteps = 0;

		if (times == 1) {
			launch(7780, 1, 20000);
			restart();
		} else {
			/* Not from the switch, for the other end is far. */
			rig_follow_to(0, 1, 20000);
			command(LW_COMMAND_STOP);
			rig.controller->moving.shift_usteps = 500; /* jogged, as it were */
		}
		rig_ticks(350);
		command(LW_COMMAND_REACQUIRE);
		TEST_ASSERT_EQUAL_UINT16(times, rig.controller->reacquire.begun);
		TEST_ASSERT_EQUAL_INT64(0, lw_motion_read(&rig.controller->motion).pattern_edges);
		TEST_ASSERT_EQUAL_INT32(lw_law_pos_usteps(lw_motion_m(&rig.controller->motion)),
					rig.controller->reacquire.begin_usteps);
		TEST_ASSERT_EQUAL_INT32(0, rig.controller->los.reacquired.position_q16);
		while (rig.controller->state == LW_STATE_REACQUIRING) {
			rig_tick();
			if (rig.carriage_usteps > turned_usteps) {
				turned_usteps = rig.carriage_usteps;
			}
			TEST_ASSERT_EQUAL_UINT8(LW_EDGE_SOURCE_ENCODER,
						rig.controller->motion.source);
		}
		if (times == 1) {
			/* On the ramp, and down it as far. */
			TEST_ASSERT_TRUE(rig.controller->reacquire.turning);
			TEST_ASSERT_INT32_WITHIN(10, 7840 + (7840 - 7780), turned_usteps);
		}
		TEST_ASSERT_EQUAL_UINT16(times, rig.controller->reacquire.done);
		TEST_ASSERT_EQUAL_INT32(0, rig.controller->moving.shift_usteps);
		check_reacquired();
	}
}

/** A tick of the drum at rest, so many microsteps away from where it began. */
static void tick_at(int32_t way_usteps)
{
	rig.controller->reacquire.begin_usteps =
		lw_law_pos_usteps(lw_motion_m(&rig.controller->motion)) -
		lw_side_direction(rig.controller->reacquire.side) * way_usteps;
	rig_tick();
}

static void test_as_far_as_the_travel_and_no_farther(void)
{
	FOR_EACH_SIDE(side) {
		setUp();
		reacquire_to_the_sweep(side);
		tick_at(rig.controller->derived->travel_usteps);
		TEST_ASSERT_EQUAL_INT(LW_STATE_REACQUIRING, rig.controller->state);
		tick_at(rig.controller->derived->travel_usteps + 1);
		TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
		TEST_ASSERT_EQUAL_INT(LW_FAULT_REACQUIRE_NO_SWITCH, rig.controller->fault);
	}
}

static void test_a_switch_may_be_left_as_late_as_it_can_be_reached(void)
{
	/* Between the switches are 15,680 microsteps of 18,000, and a switch releases at most 150
	 * later. */
	const int32_t beyond_usteps = 18000 - 15680 + 150;

	launch(-7900, -1, 20000);
	restart();
	rig_ticks(350);
	command(LW_COMMAND_REACQUIRE);
	rig_ticks(2);
	rig.drum_edges_per_s = 0;
	rig_tick();
	TEST_ASSERT_TRUE(rig.controller->limit[LW_MINUS].active);
	tick_at(beyond_usteps);
	TEST_ASSERT_EQUAL_INT(LW_STATE_REACQUIRING, rig.controller->state);
	tick_at(beyond_usteps + 1);
	TEST_ASSERT_EQUAL_INT(LW_FAULT_REACQUIRE_WRONG_SWITCH, rig.controller->fault);
}

static void test_a_wire_that_breaks_as_it_is_taken_up_is_the_fault(void)
{
	reacquire_to_the_sweep(LW_PLUS);
	rig.controller->reacquire.turning = true;
	rig.controller->wiring[LW_PLUS] = true;
	rig_tick();
	TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
	TEST_ASSERT_EQUAL_INT(LW_FAULT_WIRING_PLUS, rig.controller->fault);
}

static void test_the_slowest_drum_has_a_direction(void)
{
	launch(0, 1, 20000);
	restart();
	rig_ticks(350);
	rig.device.active.rest_edges_per_s = 1;
	for (int32_t edges_per_s = -1; edges_per_s <= 1; edges_per_s += 2) {
		rig.controller->speed.edges_per_s = edges_per_s;
		lw_controller_reacquire(rig.controller);
		TEST_ASSERT_EQUAL_INT(edges_per_s > 0 ? LW_PLUS : LW_MINUS,
				      rig.controller->reacquire.side);
		lw_controller_stop(rig.controller);
		rig.controller->reacquire.stands_since_us = 0;
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_from_anywhere_in_the_direction_that_was);
	RUN_TEST(test_only_an_index_clears_it);
	RUN_TEST(test_a_drum_that_comes_back_leads_back);
	RUN_TEST(test_a_trigger_is_taken_up_where_the_drum_comes_back);
	RUN_TEST(test_a_trigger_on_the_way_back_is_none);
	RUN_TEST(test_a_late_trigger_past_the_reversal_point_is_made_good);
	RUN_TEST(test_what_goes_wrong_is_a_named_fault);
	RUN_TEST(test_a_switch_that_sticks_behind_is_the_wrong_one);
	RUN_TEST(test_it_does_not_begin_with_contradicting_switches);
	RUN_TEST(test_when_it_is_refused);
	RUN_TEST(test_what_may_be_asked_meanwhile);
	RUN_TEST(test_by_itself_only_within_a_launch_that_was_kept);
	RUN_TEST(test_by_itself_not_where_the_launch_is_over);
	RUN_TEST(test_without_a_memory_the_hand_over_s_direction_is_taken);
	RUN_TEST(test_it_is_in_the_log_and_outlasts_a_power_cut);
	RUN_TEST(test_the_way_from_rest_and_the_turn_are_on_the_orbit);
	RUN_TEST(test_the_limits_of_what_is_allowed_are_within_it);
	RUN_TEST(test_by_itself_until_two_seconds_after_the_restart);
	RUN_TEST(test_a_stop_before_holds_nothing_that_comes_after);
	RUN_TEST(test_a_stop_lets_no_edge_move_it);
	RUN_TEST(test_a_place_is_taken_up_to_the_bit_and_its_rest_is_whole_microsteps);
	RUN_TEST(test_each_is_counted_and_begins_anew);
	RUN_TEST(test_as_far_as_the_travel_and_no_farther);
	RUN_TEST(test_a_switch_may_be_left_as_late_as_it_can_be_reached);
	RUN_TEST(test_a_wire_that_breaks_as_it_is_taken_up_is_the_fault);
	RUN_TEST(test_the_slowest_drum_has_a_direction);
	return UNITY_END();
}
