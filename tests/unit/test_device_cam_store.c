/* SPDX-License-Identifier: Apache-2.0 */
/* The cam table in force is stored, and the next power-up begins with it. */
#include "cam_rig.h"
#include "storage_rig.h"

static struct lw_cam_table hill;
static struct lw_cam_table pit;

void setUp(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
	hill = cam_hill();
	pit = cam_pit();
	TEST_ASSERT_EQUAL_INT(LW_STORE_JOURNAL, rig_write_slot(0)); /* the power-up's */
}

void tearDown(void)
{
}

static void restart(void)
{
	power_cut();
	rig_ticks(300);
}

static void test_the_table_in_force_is_stored_and_there_at_power_up(void)
{
	check_in(hill);
	TEST_ASSERT_EQUAL_INT(-1, rig_write_slot(0)); /* in force, not before */
	command(LW_COMMAND_CAM_ACTIVATE);
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_stored);
	TEST_ASSERT_EQUAL_INT(LW_STORE_CAM, rig_write_slot(0));
	TEST_ASSERT_EQUAL_INT32(1, status()->cam_stored);
	use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
	command(LW_COMMAND_SAVE);
	TEST_ASSERT_EQUAL_INT(LW_STORE_PARAMS, rig_write_slot(0));
	restart();
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_EMPTY);
	TEST_ASSERT_EQUAL_MEMORY(&hill, &rig.store.cam_banks[0].table, sizeof(hill));
	TEST_ASSERT_EQUAL_INT32(1, status()->cam_stored);
	track();
	rig_drive(8500 - lw_motion_read(&rig.controller->motion).net_edges);
	TEST_ASSERT_EQUAL_INT32(750, status()->position_usteps);
	/* Another one, while it runs: stored at rest only. */
	put_in_force(pit);
	rig_drive(3500);
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_ACTIVE);
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_stored);
	TEST_ASSERT_EQUAL_INT(-1, rig_write_slot(0));
	rig_rest();
	for (int slot; (slot = rig_write_slot(0)) >= 0;) {
		TEST_ASSERT_LESS_THAN_INT(LW_STORE_CAM, slot); /* the log does not wait */
	}
	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_INT(LW_STORE_CAM + 1, rig_write_slot(0));
	TEST_ASSERT_EQUAL_INT32(1, status()->cam_stored);
	restart();
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_ACTIVE);
	TEST_ASSERT_EQUAL_INT32(3, status()->cam_rows);
}

static void test_a_damaged_table_leaves_the_one_before(void)
{
	put_in_force(hill);
	(void)rig_write_slot(0);
	put_in_force(pit);
	TEST_ASSERT_EQUAL_INT(LW_STORE_CAM + 1, rig_write_slot(0));
	rig.slots[LW_STORE_CAM + 1][50] ^= 8;
	restart();
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_EMPTY);
	TEST_ASSERT_EQUAL_INT64(7, status()->cam_version);
	TEST_ASSERT_EQUAL_INT32(LW_SLOT_STATE_GOOD, status()->slot_4);
	TEST_ASSERT_EQUAL_INT32(LW_SLOT_STATE_DAMAGED, status()->slot_5);
	/* And none at all: there is nothing to follow, and it says so. */
	rig.slots[LW_STORE_CAM][50] ^= 8;
	restart();
	assert_banks(LW_CAM_BANK_STATE_EMPTY, LW_CAM_BANK_STATE_EMPTY);
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_rows);
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_stored);
	TEST_ASSERT_EQUAL_INT32(LW_SLOT_STATE_DAMAGED, status()->slot_4);
	/* The slot's event, and after it the power-up's. */
	const struct lw_log *log = &rig.store.log;
	const struct lw_log_record *damaged = &log->records[(log->newest - 1) % LW_LOG_RECORDS];

	TEST_ASSERT_EQUAL_UINT16(LW_EVENT_SLOT_DAMAGED, damaged->event);
	TEST_ASSERT_EQUAL_INT32(LW_STORE_CAM + 1, damaged->detail);
}

static void test_a_table_that_could_not_be_stored(void)
{
	put_in_force(hill);
	TEST_ASSERT_EQUAL_INT(LW_STORE_CAM, rig_write_slot(-EIO));
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_stored);
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_EMPTY);
	TEST_ASSERT_EQUAL_INT(-1, rig_write_slot(0));
	/* The next one is stored again. */
	put_in_force(pit);
	TEST_ASSERT_EQUAL_INT(LW_STORE_CAM, rig_write_slot(0));
	TEST_ASSERT_EQUAL_INT32(1, status()->cam_stored);
}

static void test_another_table_in_force_during_the_write(void)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;

	put_in_force(hill);
	TEST_ASSERT_NOT_EQUAL(0, lw_device_begin_write(&rig.device, &slot, bytes));
	put_in_force(pit);
	lw_device_end_write(&rig.device, 0);
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_stored);
	TEST_ASSERT_EQUAL_INT(LW_STORE_CAM + 1, rig_write_slot(0));
	TEST_ASSERT_EQUAL_INT32(1, status()->cam_stored);
}

/** Table and parameters are stored apart: a power cut between them may leave what does not fit. */
static void test_a_stored_table_that_the_stored_parameters_do_not_allow(void)
{
	put_in_force(pit);
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_CAM_STEPS_PER_S_MAX, 110000));
	use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
	command(LW_COMMAND_SAVE);
	(void)rig_write_slot(0);
	/* hill needs 90,000 steps/s at the top edge rate of now, and twice that of the stored. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_SLAVE_UNITS, 2));
	command(LW_COMMAND_APPLY);
	hill.rows[1].slave = 2000;
	put_in_force(hill);
	while (rig_write_slot(0) >= 0) {
	}
	restart();
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_EMPTY);
	TEST_ASSERT_TRUE(status()->launch_inhibit >> LW_LAUNCH_INHIBIT_CAM & 1);
	TEST_ASSERT_EQUAL_INT32(LW_REASON_CAM_STEP_RATE, status()->cam_reason);
	TEST_ASSERT_EQUAL_INT32(1, status()->cam_reason_row);
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_READY);
	rig_ticks(1000);
	TEST_ASSERT_EQUAL_INT32(LW_STATE_READY, status()->state);
	TEST_ASSERT_EQUAL_INT32(LW_REASON_CAM_STEP_RATE, status()->cam_reason);
	/* The parameters that it was meant for. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_SLAVE_UNITS, 2));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_EQUAL_INT32(0, status()->launch_inhibit >> LW_LAUNCH_INHIBIT_CAM & 1);
	rig_run_to(LW_STATE_TRACKING);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_the_table_in_force_is_stored_and_there_at_power_up);
	RUN_TEST(test_a_damaged_table_leaves_the_one_before);
	RUN_TEST(test_a_table_that_could_not_be_stored);
	RUN_TEST(test_another_table_in_force_during_the_write);
	RUN_TEST(test_a_stored_table_that_the_stored_parameters_do_not_allow);
	return UNITY_END();
}
