/* SPDX-License-Identifier: Apache-2.0 */
/* Early and late reversal by hand: by the commands, their coils, and two buttons. */
#include <unity.h>

#include "device_rig.h"

static bool pressed[2];

/** Ticks with the buttons as they are. */
static void ticks(int count)
{
	while (count-- > 0) {
		lw_device_trim_buttons(&rig.device, pressed);
		rig_tick();
	}
}

static void press(int later)
{
	pressed[later] = true;
	ticks(25);
	pressed[later] = false;
	ticks(25);
}

static void assert_trims(int32_t plus_um, int32_t minus_um)
{
	TEST_ASSERT_EQUAL_INT32(plus_um,
				(int16_t)read_register(LW_SPACE_HOLDING, LW_ADDRESS_TRIM_PLUS_UM));
	TEST_ASSERT_EQUAL_INT32(minus_um,
				(int16_t)read_register(LW_SPACE_HOLDING, LW_ADDRESS_TRIM_MINUS_UM));
}

static enum lw_event newest_event(void)
{
	return (enum lw_event)rig.store.log.records[rig.store.log.newest % LW_LOG_RECORDS].event;
}

static int32_t newest_detail(void)
{
	return rig.store.log.records[rig.store.log.newest % LW_LOG_RECORDS].detail;
}

static void set_flange_minus(int32_t um)
{
	rig.device.active.flange_minus_um = um;
	lw_set_copy_keep(&rig.device.set_copy, &rig.device.active, &rig.device.derived);
}

void setUp(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
	pressed[0] = false;
	pressed[1] = false;
	rig.device.active.trim_step_um = 200;
	rig.device.active.flange_plus_um = 200000;
	set_flange_minus(-83000);
}

void tearDown(void)
{
}

static void test_a_step_is_for_the_side_that_the_carriage_moves_toward(void)
{
	track();
	rig_follow_to(0, 1, 5000); /* toward plus */
	command(LW_COMMAND_TRIM_LATE);
	assert_command(LW_COMMAND_TRIM_LATE, LW_RESULT_DONE, LW_REASON_NONE);
	assert_trims(200, 0);
	TEST_ASSERT_EQUAL_INT(0, write_coil(LW_ADDRESS_TRIM_EARLY, true));
	assert_trims(0, 0);

	/* The drum pays out: the carriage goes to minus. */
	rig.drum_edges_per_s = -5000;
	rig_ticks(100);
	command(LW_COMMAND_TRIM_EARLY);
	assert_trims(0, 200);
	command(LW_COMMAND_TRIM_LATE);
	assert_trims(0, 0);

	/* In a reversal it is for that one, whichever way. */
	rig_follow_to(8100, 1, 5000);
	command(LW_COMMAND_TRIM_EARLY);
	assert_trims(-200, 0);
	rig_follow_to(-8100, -1, 5000);
	command(LW_COMMAND_TRIM_EARLY);
	assert_trims(-200, 200);
	/* And it is the reversals in force that move. */
	rig_follow_to(0, 1, 5000);
	TEST_ASSERT_EQUAL_INT32(7980, status()->reversal_plus_usteps);
	TEST_ASSERT_EQUAL_INT32(-7980, status()->reversal_minus_usteps);
}

static void test_before_any_step_the_slope_says_the_side(void)
{
	track();
	rig_follow_to(0, 1, 5000);
	rig_rest();
	rig.controller->motion.last_step = 0;
	command(LW_COMMAND_TRIM_EARLY);
	assert_trims(-200, 0);
}

static void test_refused_where_there_is_no_reversal_or_no_room(void)
{
	assert_command_refused(LW_COMMAND_TRIM_EARLY, LW_REASON_TRIM_NOT_FOLLOWING);
	track();
	rig_follow_to(0, -1, 5000); /* toward minus, whose flange is near */
	command(LW_COMMAND_TRIM_LATE);
	command(LW_COMMAND_TRIM_LATE);
	TEST_ASSERT_EQUAL_INT(-EINVAL, write_register(LW_ADDRESS_COMMAND, LW_COMMAND_TRIM_LATE));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_OVERSHOOT_BEYOND_FLANGE_MINUS, why.reason);
	assert_command(LW_COMMAND_TRIM_LATE, LW_RESULT_REFUSED,
		       LW_REASON_OVERSHOOT_BEYOND_FLANGE_MINUS);
	assert_trims(0, -400);

	/* No farther out than the registers can say. */
	rig_follow_to(0, 1, 5000);
	set_flange_minus(-200000);
	lw_controller_set_trim(rig.controller, 19800, -19800);
	command(LW_COMMAND_TRIM_LATE);
	assert_trims(20000, -19800);
	TEST_ASSERT_EQUAL_INT(-EINVAL, write_register(LW_ADDRESS_COMMAND, LW_COMMAND_TRIM_LATE));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_OUT_OF_RANGE, why.reason);
	rig_follow_to(0, -1, 5000);
	command(LW_COMMAND_TRIM_LATE);
	assert_trims(20000, -20000);
	TEST_ASSERT_EQUAL_INT(-EINVAL, write_register(LW_ADDRESS_COMMAND, LW_COMMAND_TRIM_LATE));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_OUT_OF_RANGE, why.reason);
	for (size_t i = 0; i < LW_MAP_SETPOINTS_COUNT; i++) {
		if (lw_map_setpoints[i].address == LW_ADDRESS_TRIM_PLUS_UM) {
			TEST_ASSERT_EQUAL_INT32(20000, lw_map_setpoints[i].max);
		}
	}
}

static void test_a_cam_has_no_reversal_to_trim(void)
{
	track();
	rig.controller->motion.cam.on = true;
	assert_command_refused(LW_COMMAND_TRIM_EARLY, LW_REASON_TRIM_NOT_FOLLOWING);
	rig.controller->motion.cam.on = false;
}

static void test_a_button_is_one_step_however_it_bounces_and_however_long(void)
{
	track();
	rig_follow_to(0, 1, 5000);
	rig.drum_edges_per_s = 100;
	for (int i = 0; i < 30; i++) {
		pressed[1] = i % 2 == 0; /* chatter: never 20 ms alike */
		ticks(i % 5 + 1);
	}
	assert_trims(0, 0);
	pressed[1] = true;
	ticks(19);
	assert_trims(0, 0);
	ticks(2000);
	assert_trims(200, 0);
	TEST_ASSERT_EQUAL_INT(LW_EVENT_TRIMMED, newest_event());
	TEST_ASSERT_EQUAL_INT32(200, newest_detail());
	pressed[1] = false;
	ticks(5);
	pressed[1] = true; /* not long enough */
	ticks(100);
	assert_trims(200, 0);
	pressed[1] = false;
	ticks(25);
	press(1);
	assert_trims(400, 0);
	press(0);
	assert_trims(200, 0);
	/* Both at once cancel. */
	pressed[0] = true;
	pressed[1] = true;
	ticks(25);
	assert_trims(200, 0);
}

static void test_a_button_leaves_the_command_of_a_master_alone(void)
{
	command(LW_COMMAND_INDEX);
	press(0);
	assert_command(LW_COMMAND_INDEX, LW_RESULT_IN_PROGRESS, LW_REASON_NONE);
	TEST_ASSERT_EQUAL_INT(LW_EVENT_TRIM_REFUSED, newest_event());
	TEST_ASSERT_EQUAL_INT32(LW_REASON_TRIM_NOT_FOLLOWING, newest_detail());
	rig_run_to(LW_STATE_TRACKING);
	assert_command(LW_COMMAND_INDEX, LW_RESULT_DONE, LW_REASON_NONE);
	assert_trims(0, 0);
}

static void test_a_button_is_counted_by_twenty_polls_whatever_came_before(void)
{
	static const int released[] = {19, 20};

	for (int i = 0; i < 2; i++) {
		int presses = 0;

		rig_prepare(0);
		power_up(NULL, 0);
		pressed[1] = false;
		for (int poll = 0; poll < 20 + released[i] + 20; poll++) {
			pressed[1] = poll < 20 || poll >= 20 + released[i];
			presses += lw_controller_trim_buttons(rig.controller, pressed) == 2;
		}
		TEST_ASSERT_EQUAL_INT(1 + i, presses);
		pressed[1] = false;
	}
}

static void test_there_are_two_buttons(void)
{
	static const bool and_more[2][4] = {{false, false, false, false},
					    {false, false, true, true}};

	for (int i = 0; i < 100; i++) {
		TEST_ASSERT_EQUAL_UINT(
			0, lw_controller_trim_buttons(rig.controller, and_more[i / 50]));
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_a_step_is_for_the_side_that_the_carriage_moves_toward);
	RUN_TEST(test_before_any_step_the_slope_says_the_side);
	RUN_TEST(test_refused_where_there_is_no_reversal_or_no_room);
	RUN_TEST(test_a_cam_has_no_reversal_to_trim);
	RUN_TEST(test_a_button_is_one_step_however_it_bounces_and_however_long);
	RUN_TEST(test_a_button_leaves_the_command_of_a_master_alone);
	RUN_TEST(test_a_button_is_counted_by_twenty_polls_whatever_came_before);
	RUN_TEST(test_there_are_two_buttons);
	return UNITY_END();
}
