/* SPDX-License-Identifier: Apache-2.0 */
/* What needs a look at the rope: told until it has been looked at, also after a power cut. */
#include <errno.h>

#include <unity.h>

#include "cases.h"
#include "storage_rig.h"

#define S_US 1000000u

static void index_again(void)
{
	rig.drum_edges_per_s = 0;
	run(300);
	command(LW_COMMAND_INDEX);
	run_to(LW_STATE_TRACKING);
}

static bool permitted(void)
{
	return status()->launch_inhibit == 0;
}

static bool event_is_kept(enum lw_event event)
{
	for (size_t i = 0; i < LW_LOG_RECORDS; i++) {
		if (rig.store.log.records[i].event == (uint16_t)event) {
			return true;
		}
	}
	return false;
}

void setUp(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
	index_again();
	TEST_ASSERT_TRUE(permitted());
}

void tearDown(void)
{
	cases_end();
}

/** A launch, a stop in the middle of it, and `turns` thousandths of a drum turn after that. */
static void stop_at_speed(int32_t turns_permille)
{
	rig.drum_edges_per_s = 9600;
	run(2000);
	command(LW_COMMAND_STOP);
	run(turns_permille * 2880 / 9600);
	rig.drum_edges_per_s = 0;
	run(300);
}

static void test_rope_laid_after_a_stop_is_told_until_it_is_acknowledged(void)
{
	const int32_t at_um = status()->position_um;
	int32_t stood_um;

	rig.drum_edges_per_s = 9600;
	run(2000);
	stood_um = status()->position_um;
	TEST_ASSERT_NOT_EQUAL(at_um, stood_um);
	command(LW_COMMAND_STOP);
	run(60); /* 0.2 turns */
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_LAID_STANDING));
	run(940);
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_LAID_STANDING));
	TEST_ASSERT_TRUE(event_is_kept(LW_EVENT_ROPE_LAID_STANDING));
	TEST_ASSERT_INT32_WITHIN(20, 3333, (int32_t)status()->rope_standing_millirev);
	TEST_ASSERT_INT32_WITHIN(60, stood_um, status()->rope_standing_position_um);
	TEST_ASSERT_EQUAL_INT32(1, status()->rope_standing_place_known);

	/* Never by the indexing alone, and never without one. */
	rig.drum_edges_per_s = 0;
	run(300);
	assert_command_refused(LW_COMMAND_ACKNOWLEDGE_ROPE, LW_REASON_ROPE_INDEX_FIRST);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	index_again();
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_LAID_STANDING));
	TEST_ASSERT_EQUAL_INT32(1 << LW_LAUNCH_INHIBIT_ROPE_LAID_STANDING,
				status()->launch_inhibit);
	command(LW_COMMAND_ACKNOWLEDGE_ROPE);
	TEST_ASSERT_TRUE(permitted());
	TEST_ASSERT_EQUAL_INT32(0, (int32_t)status()->rope_standing_millirev);
	run(10);
	TEST_ASSERT_TRUE(event_is_kept(LW_EVENT_ROPE_ACKNOWLEDGED));
	/* Once more: there is nothing, and that is no error. */
	command(LW_COMMAND_ACKNOWLEDGE_ROPE);
	assert_command(LW_COMMAND_ACKNOWLEDGE_ROPE, LW_RESULT_DONE, LW_REASON_NONE);
}

static void test_the_coil_acknowledges_too(void)
{
	stop_at_speed(1000);
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_coil(LW_ADDRESS_ACKNOWLEDGE_ROPE, true));
	index_again();
	TEST_ASSERT_EQUAL_INT(0, write_coil(LW_ADDRESS_ACKNOWLEDGE_ROPE, true));
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_LAID_STANDING));
}

static void test_nobody_can_look_at_a_turning_drum(void)
{
	stop_at_speed(1000);
	index_again();
	rig.drum_edges_per_s = 9600;
	run(100);
	assert_command_refused(LW_COMMAND_ACKNOWLEDGE_ROPE, LW_REASON_DRUM_MOVING);
}

static void test_rope_laid_in_a_fault_is_told(void)
{
	rig.drum_edges_per_s = 9600;
	run(2000);
	lw_controller_overtravel(rig.controller, LW_PLUS, true);
	run(2);
	TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
	/* A panel that writes the mode does not make it intended. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	run(1000);
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_LAID_STANDING));
}

static void test_mode_off_and_centre_mean_it(void)
{
	static const enum lw_mode modes[] = {LW_MODE_CENTRE, LW_MODE_OFF};

	for (size_t i = 0; i < 2; i++) {
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, modes[i]));
		run_to(modes[i] == LW_MODE_OFF ? LW_STATE_OFF : LW_STATE_CENTRED);
		rig.drum_edges_per_s = 9600;
		run(2000);
		rig.drum_edges_per_s = 0;
		run(300);
		TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_LAID_STANDING));
	}
}

static void test_a_hand_over_at_rest_is_no_stand(void)
{
	command(LW_COMMAND_STOP);
	run(1000);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	run_to(LW_STATE_TRACKING);
	rig.drum_edges_per_s = 20000;
	run(4000);
	rig.drum_edges_per_s = 0;
	run(300);
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_LAID_STANDING));
}

static void lose_synchronization(void)
{
	rig_place(rig.carriage_usteps + 400);
	rig.drum_edges_per_s = 20000;
	for (int i = 0; i < 8000 && !flag(LW_FLAG_LOS); i++) {
		run(1);
	}
	TEST_ASSERT_TRUE(flag(LW_FLAG_LOS));
}

static void test_a_loss_of_synchronization_survives_a_power_cut(void)
{
	struct lw_status before;

	lose_synchronization();
	rig.drum_edges_per_s = 0;
	while (!rig.controller->speed.at_rest) {
		rig_tick();
	}
	TEST_ASSERT_EQUAL_INT(LW_STORE_LOOK, rig_write_slot(0) & ~1); /* at once, and first */
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
	before = *status();
	power_cut();
	TEST_ASSERT_EQUAL_INT32(before.flags >> LW_FLAG_LOS & 0x1F,
				status()->flags >> LW_FLAG_LOS & 0x1F);
	TEST_ASSERT_EQUAL_INT32(before.los2_plus_position_um, status()->los2_plus_position_um);
	TEST_ASSERT_EQUAL_INT32(before.los2_plus_time_ms, status()->los2_plus_time_ms);
	TEST_ASSERT_NOT_EQUAL(0, status()->look_before_power_up);
	TEST_ASSERT_TRUE(status()->launch_inhibit & 1 << LW_LAUNCH_INHIBIT_LOS);
	TEST_ASSERT_EQUAL_INT32(0, status()->los2_plus_count); /* since this power-up */
	TEST_ASSERT_TRUE(event_is_kept(LW_EVENT_LOOK_PENDING));

	/* Again and again, until an indexing. */
	run(5000);
	power_cut();
	TEST_ASSERT_TRUE(flag(LW_FLAG_LOS));
	index_again();
	TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
	TEST_ASSERT_EQUAL_INT32(0, status()->look_before_power_up);
	run(2);
	power_cut();
	TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
}

/** Let channel A change alone, ten times in a tick. */
static void rock(int ticks)
{
	while (ticks-- > 0) {
		const uint8_t levels = rig.controller->quadrature.levels;

		for (int i = 0; i < 10; i++) {
			(void)lw_controller_encoder(rig.controller, (levels & 2) == 0, levels & 1);
			(void)lw_controller_encoder(rig.controller, (levels & 2) != 0, levels & 1);
		}
		run(1);
	}
}

/* One channel alone: nothing begins to move in the doubt; the fault is a LOS that outlasts a cut.
 */
static void test_an_encoder_fault_survives_a_power_cut(void)
{
	run(300);
	TEST_ASSERT_TRUE(permitted());
	rock(50);
	TEST_ASSERT_TRUE(flag(LW_FLAG_ENCODER_DOUBTFUL));
	TEST_ASSERT_FALSE(flag(LW_FLAG_DRUM_AT_REST));
	TEST_ASSERT_FALSE(permitted());
	assert_command_refused(LW_COMMAND_INDEX, LW_REASON_ENCODER_DOUBTFUL);
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_register(LW_ADDRESS_JOG, 1));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_ENCODER_DOUBTFUL, why.reason);
	run(400);
	TEST_ASSERT_TRUE(permitted());

	rock(600);
	TEST_ASSERT_TRUE(flag(LW_FLAG_ENCODER_FAULT));
	TEST_ASSERT_TRUE(flag(LW_FLAG_LOS));
	run(3000);
	TEST_ASSERT_FALSE(permitted());
	power_cut();
	TEST_ASSERT_TRUE(flag(LW_FLAG_LOS));
	TEST_ASSERT_NOT_EQUAL(0, status()->look_before_power_up);
	index_again();
	TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
	TEST_ASSERT_EQUAL_INT32(0, status()->look_before_power_up);
}

static void test_a_drum_that_is_said_to_turn_does_not_rest(void)
{
	run(300);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_DRUM_RUNNING, 1));
	run(1);
	assert_command_refused(LW_COMMAND_INDEX, LW_REASON_DRUM_RUNNING);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_DRUM_RUNNING, 0));
	run(300);
	index_again();
}

static void lose_by_a_dead_switch(int side)
{
	rig.switches[side] = RIG_SWITCH_NEVER;
	rig_tell_switch(side);
	rig.drum_edges_per_s = 20000;
	for (int i = 0; i < 20000 && !rig.controller->los.los1[side].set; i++) {
		run(1);
	}
	TEST_ASSERT_TRUE(rig.controller->los.los1[side].set);
	rig.switches[side] = RIG_SWITCH_WORKS;
	rig_tell_switch(side);
	rig.drum_edges_per_s = 0;
	run(3000);
}

static void test_each_kind_of_loss_survives_a_power_cut(void)
{
	FOR_EACH_SIDE(side) {
		lose_by_a_dead_switch(side);
		power_cut();
		TEST_ASSERT_TRUE(flag(side == LW_PLUS ? LW_FLAG_LOS1_PLUS : LW_FLAG_LOS1_MINUS));
		TEST_ASSERT_NOT_EQUAL(0, status()->look_before_power_up);
		index_again();
		TEST_ASSERT_FALSE(flag(LW_FLAG_LOS));
	}
}

static void test_the_loss_is_in_the_log_after_the_power_cut(void)
{
	lose_synchronization();
	rig.drum_edges_per_s = 0;
	run(3000);
	power_cut();
	TEST_ASSERT_TRUE(event_is_kept(LW_EVENT_LOS1_PLUS) || event_is_kept(LW_EVENT_LOS1_MINUS) ||
			 event_is_kept(LW_EVENT_LOS2_PLUS) || event_is_kept(LW_EVENT_LOS2_MINUS));
}

static void test_rope_laid_standing_was_counted_by_the_ratio_of_then(void)
{
	uint32_t millirev;

	stop_at_speed(2000);
	millirev = status()->rope_standing_millirev;
	TEST_ASSERT_NOT_EQUAL(0, millirev);
	rig.device.staged.encoder_ratio_numerator = 8;
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_EQUAL_INT32(8, rig.device.active.encoder_ratio_numerator);
	TEST_ASSERT_EQUAL_UINT32(millirev, status()->rope_standing_millirev);
}

static void test_rope_laid_standing_survives_a_power_cut_and_an_indexing(void)
{
	uint32_t millirev;
	int32_t at_um;

	stop_at_speed(2000);
	millirev = status()->rope_standing_millirev;
	at_um = status()->rope_standing_position_um;
	TEST_ASSERT_NOT_EQUAL(0, millirev);
	power_cut();
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_LAID_STANDING));
	TEST_ASSERT_EQUAL_UINT32(millirev, status()->rope_standing_millirev);
	TEST_ASSERT_EQUAL_INT32(at_um, status()->rope_standing_position_um);
	TEST_ASSERT_EQUAL_INT32(1, status()->rope_standing_place_known);
	index_again();
	power_cut(); /* the indexing of before counts no more */
	index_again();
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_LAID_STANDING));
	command(LW_COMMAND_ACKNOWLEDGE_ROPE);
	run(2);
	power_cut();
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_LAID_STANDING));
}

static void test_no_sequence_number_is_given_anew(void)
{
	uint32_t newest = 0;

	for (int i = 0; i < 5; i++) {
		TEST_ASSERT_GREATER_THAN_UINT32(newest, rig.store.log.newest);
		run(i == 0 ? 30000 : 300);
		rig.drum_edges_per_s = 20000; /* events from here on are not stored */
		for (int k = 0; k < 10; k++) {
			command(LW_COMMAND_STOP);
			run(10);
		}
		newest = rig.store.log.newest;
		power_cut();
	}
	/* The ring goes on where it was: the oldest gives way, and all are in it. */
	for (uint32_t i = 0; i < LW_LOG_RECORDS; i++) {
		const struct lw_log_record *record = &rig.store.log.records[i];

		TEST_ASSERT_TRUE(record->sequence == 0 || record->sequence % LW_LOG_RECORDS == i);
	}
}

static void test_nothing_is_written_while_the_drum_turns_in_any_state(void)
{
	static const enum lw_mode modes[] = {LW_MODE_TRACK, LW_MODE_CENTRE, LW_MODE_OFF};

	for (size_t i = 0; i < 3; i++) {
		setUp();
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, modes[i]));
		run(5000);
		rig.drum_edges_per_s = 100;
		rig_ticks(100);
		command(modes[i] == LW_MODE_TRACK ? LW_COMMAND_STOP : LW_COMMAND_SAVE);
		for (int k = 0; k < 20000; k++) {
			rig_tick();
			TEST_ASSERT_EQUAL_INT(-1, rig_write_slot(0));
		}
		rig.drum_edges_per_s = 0;
		rig_ticks(300);
		TEST_ASSERT_NOT_EQUAL(-1, rig_write_slot(0));
	}
	/* Unindexed, and in a fault. */
	power_up(NULL, 0);
	for (int fault = 0; fault < 2; fault++) {
		lw_controller_overtravel(rig.controller, LW_PLUS, fault);
		rig.drum_edges_per_s = -200;
		for (int k = 0; k < 5000; k++) {
			rig_tick();
			TEST_ASSERT_TRUE(k < 100 || rig_write_slot(0) == -1);
		}
		TEST_ASSERT_EQUAL_INT(fault ? LW_STATE_FAULT : LW_STATE_UNINDEXED,
				      rig.controller->state);
	}
}

static void test_a_save_that_waits_for_the_drum_holds_nothing_up(void)
{
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	run_to(LW_STATE_CENTRED);
	rig.drum_edges_per_s = 200;
	run(100);
	command(LW_COMMAND_SAVE);
	run(1000);
	assert_command(LW_COMMAND_SAVE, LW_RESULT_IN_PROGRESS, LW_REASON_NONE);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_JOG, 1));
	run(100);
	TEST_ASSERT_NOT_EQUAL(0, lw_controller_timer_rate_edges_per_s(rig.controller));
	run(2000);
	TEST_ASSERT_EQUAL_INT32(LW_RESULT_IN_PROGRESS, status()->command_result);
	rig.drum_edges_per_s = 0;
	run(300);
	assert_command(LW_COMMAND_SAVE, LW_RESULT_DONE, LW_REASON_NONE);
}

/** A write during which the drum turns by some edges, and some more after it. */
static void write_while_turning(int during, int after)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;

	rig_rest();
	while (rig_write_slot(0) >= 0) {
	}
	command(LW_COMMAND_STOP);
	rig.now_us += 120 * (uint64_t)S_US;
	rig_tick();
	TEST_ASSERT_NOT_EQUAL(0, lw_device_begin_write(&rig.device, &slot, bytes));
	rig_turn(during);
	lw_device_end_write(&rig.device, 0);
	rig_ticks(5);
	rig_turn(after);
	rig_ticks(200);
}

static void test_a_drum_that_turns_during_a_write_makes_the_odometer_doubtful(void)
{
	write_while_turning(0, 0);
	TEST_ASSERT_FALSE(flag(LW_FLAG_ODOMETER_DOUBTFUL));
	write_while_turning(0, 50); /* afterwards: every edge was seen */
	TEST_ASSERT_FALSE(flag(LW_FLAG_ODOMETER_DOUBTFUL));
	write_while_turning(1, 0); /* rocks about an edge */
	TEST_ASSERT_FALSE(flag(LW_FLAG_ODOMETER_DOUBTFUL));
	write_while_turning(-1, -3); /* the one that was seen of many */
	TEST_ASSERT_TRUE(flag(LW_FLAG_ODOMETER_DOUBTFUL));
	TEST_ASSERT_TRUE(event_is_kept(LW_EVENT_ODOMETER_DOUBTFUL));
	index_again();
	TEST_ASSERT_FALSE(flag(LW_FLAG_ODOMETER_DOUBTFUL));
	write_while_turning(7, 0);
	TEST_ASSERT_TRUE(flag(LW_FLAG_ODOMETER_DOUBTFUL));
}

static void test_edges_that_the_host_keeps_are_not_doubtful(void)
{
	config.edges_are_kept = true;
	write_while_turning(7, 0);
	config.edges_are_kept = false;
	TEST_ASSERT_FALSE(flag(LW_FLAG_ODOMETER_DOUBTFUL));
}

static void test_looks_do_not_wear_the_flash_out(void)
{
	int writes = 0;

	/* A drum that creeps below its rest: rope is laid, and more with every tick. */
	command(LW_COMMAND_STOP);
	rig.drum_edges_per_s = 40;
	for (int i = 0; i < 240000; i++) {
		rig_tick();
		for (int slot; (slot = rig_write_slot(0)) >= 0;) {
			writes += slot >= LW_STORE_LOOK ? 1 : 0;
		}
	}
	TEST_ASSERT_TRUE(rig.controller->speed.at_rest);
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_LAID_STANDING));
	TEST_ASSERT_INT_WITHIN(1, 13, writes); /* in four minutes */
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_rope_laid_after_a_stop_is_told_until_it_is_acknowledged);
	RUN_TEST(test_the_coil_acknowledges_too);
	RUN_TEST(test_nobody_can_look_at_a_turning_drum);
	RUN_TEST(test_rope_laid_in_a_fault_is_told);
	RUN_TEST(test_mode_off_and_centre_mean_it);
	RUN_TEST(test_a_hand_over_at_rest_is_no_stand);
	RUN_TEST(test_a_loss_of_synchronization_survives_a_power_cut);
	RUN_TEST(test_the_loss_is_in_the_log_after_the_power_cut);
	RUN_TEST(test_rope_laid_standing_was_counted_by_the_ratio_of_then);
	RUN_TEST(test_rope_laid_standing_survives_a_power_cut_and_an_indexing);
	RUN_TEST(test_no_sequence_number_is_given_anew);
	RUN_TEST(test_nothing_is_written_while_the_drum_turns_in_any_state);
	RUN_TEST(test_a_save_that_waits_for_the_drum_holds_nothing_up);
	RUN_TEST(test_a_drum_that_turns_during_a_write_makes_the_odometer_doubtful);
	RUN_TEST(test_edges_that_the_host_keeps_are_not_doubtful);
	RUN_TEST(test_looks_do_not_wear_the_flash_out);
	RUN_TEST(test_an_encoder_fault_survives_a_power_cut);
	RUN_TEST(test_a_drum_that_is_said_to_turn_does_not_rest);
	RUN_TEST(test_each_kind_of_loss_survives_a_power_cut);
	return UNITY_END();
}
