/* SPDX-License-Identifier: Apache-2.0 */
/* The stepper driver's alarm: a fault, no launch, and no way on while it stands. */
#include <errno.h>

#include <unity.h>

#include "rig.h"

static struct lw_refusal why;

void setUp(void)
{
	rig_prepare(0);
	rig_power_up();
}

void tearDown(void)
{
}

static bool inhibited(enum lw_launch_inhibit_bit bit)
{
	return (lw_controller_launch_inhibit(rig.controller) >> bit) & 1;
}

/** What the driver's alarm output says, for some ticks. */
static void poll_alarm(bool alarm, int ticks)
{
	for (int i = 0; i < ticks; i++) {
		lw_controller_stepper_alarm(rig.controller, alarm);
		rig_ticks(1);
	}
}

static void test_three_polls_in_a_row_count(void)
{
	for (int i = 0; i < 10; i++) {
		poll_alarm(true, 2);
		poll_alarm(false, 1);
	}
	TEST_ASSERT_FALSE(inhibited(LW_LAUNCH_INHIBIT_STEPPER_ALARM));
	TEST_ASSERT_EQUAL_INT(LW_FAULT_NONE, rig.controller->fault);
	poll_alarm(true, 3);
	TEST_ASSERT_EQUAL_INT(LW_FAULT_STEPPER_ALARM, rig.controller->fault);
	for (int i = 0; i < 10; i++) {
		poll_alarm(false, 2);
		poll_alarm(true, 1);
	}
	TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_STEPPER_ALARM));
	poll_alarm(false, 3);
	TEST_ASSERT_FALSE(inhibited(LW_LAUNCH_INHIBIT_STEPPER_ALARM));
}

static void test_alarm_while_tracking(void)
{
	rig_index();
	rig_run_to(LW_STATE_TRACKING);
	rig_drive(10000);
	TEST_ASSERT_EQUAL_UINT16(0, lw_controller_launch_inhibit(rig.controller));
	poll_alarm(true, 3);
	TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
	TEST_ASSERT_EQUAL_INT(LW_FAULT_STEPPER_ALARM, rig.controller->fault);
	TEST_ASSERT_FALSE(rig.controller->indexed);
	TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_FAULT));
	TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_STEPPER_ALARM));

	const int32_t place = rig.carriage_usteps;

	rig_ticks(100);
	TEST_ASSERT_EQUAL_INT32(place, rig.carriage_usteps);
}

static void test_fault_is_cleared_after_its_cause_only(void)
{
	poll_alarm(true, 3);
	TEST_ASSERT_EQUAL_INT(-EBUSY, lw_controller_allow_clear_fault(rig.controller, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_CAUSE_PRESENT, why.reason);
	poll_alarm(false, 3);
	TEST_ASSERT_EQUAL_INT(LW_FAULT_STEPPER_ALARM, rig.controller->fault);
	TEST_ASSERT_FALSE(inhibited(LW_LAUNCH_INHIBIT_STEPPER_ALARM));
	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_clear_fault(rig.controller, &why));
	lw_controller_clear_fault(rig.controller);
	rig_ticks(1);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
}

static void test_indexing_and_jogging_end_at_once(void)
{
	lw_controller_jog(rig.controller, 1, rig.now_us);
	rig_ticks(10);
	TEST_ASSERT_EQUAL_INT(LW_STATE_JOGGING, rig.controller->state);
	poll_alarm(true, 3);
	TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
	lw_controller_index(rig.controller);
	rig_ticks(1);
	TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
	TEST_ASSERT_EQUAL_INT(LW_FAULT_STEPPER_ALARM, rig.controller->fault);
}

static void test_in_mode_off_it_only_inhibits(void)
{
	lw_controller_set_mode(rig.controller, LW_MODE_OFF);
	rig_ticks(1);
	poll_alarm(true, 3);
	TEST_ASSERT_EQUAL_INT(LW_STATE_OFF, rig.controller->state);
	TEST_ASSERT_EQUAL_INT(LW_FAULT_NONE, rig.controller->fault);
	TEST_ASSERT_TRUE(inhibited(LW_LAUNCH_INHIBIT_STEPPER_ALARM));
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	rig_ticks(2);
	TEST_ASSERT_EQUAL_INT(LW_FAULT_STEPPER_ALARM, rig.controller->fault);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_three_polls_in_a_row_count);
	RUN_TEST(test_alarm_while_tracking);
	RUN_TEST(test_fault_is_cleared_after_its_cause_only);
	RUN_TEST(test_indexing_and_jogging_end_at_once);
	RUN_TEST(test_in_mode_off_it_only_inhibits);
	return UNITY_END();
}
