/* SPDX-License-Identifier: Apache-2.0 */
/* What a device keeps in the storage: parameters by SAVE, the event log and counters by itself. */
#include <errno.h>
#include <string.h>

#include <unity.h>

#include "device_rig.h"

#define S_US 1000000u

static uint8_t written[LW_STORE_SLOT_SIZE];
static unsigned int written_slot;

void setUp(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
}

void tearDown(void)
{
}

/** Let time pass without ticks in between. */
static void wait_us(uint64_t us)
{
	rig.now_us += us - LW_CONTROLLER_TICK_US;
	rig_tick();
}

/** The newest event but `back`. */
static const struct lw_log_record *event(uint32_t back)
{
	const struct lw_log *events = &rig.store.log;

	TEST_ASSERT_TRUE(back < events->newest);
	return &events->records[(events->newest - back) % LW_LOG_RECORDS];
}

/** The newest events, oldest of them first. */
#define ASSERT_EVENTS(...)                                                                         \
	do {                                                                                       \
		const int32_t expected[][2] = {__VA_ARGS__};                                       \
		const uint32_t count = sizeof(expected) / sizeof(expected[0]);                     \
		for (uint32_t i = 0; i < count; i++) {                                             \
			TEST_ASSERT_EQUAL_INT32(expected[i][0], event(count - 1 - i)->event);      \
			TEST_ASSERT_EQUAL_INT32(expected[i][1], event(count - 1 - i)->detail);     \
		}                                                                                  \
	} while (0)

/** Forget the events until now. */
static void forget(void)
{
	rig.store.log = (struct lw_log){0};
}

static void assert_event_count(uint32_t expected)
{
	TEST_ASSERT_EQUAL_UINT32(expected, rig.store.log.newest);
}

static void test_power_up_with_a_record(void)
{
	struct lw_params params = lw_params_default;
	uint8_t record[LW_PARAM_RECORD_SIZE];

	params.unit_id = 17;
	params.overshoot_um = 1000;
	(void)lw_param_record_encode(&params, 1, record);
	power_up(record, sizeof(record));
	TEST_ASSERT_FALSE(flag(LW_FLAG_DEFAULTS_LOADED));
	TEST_ASSERT_EQUAL_MEMORY(&params, &rig.device.active, sizeof(params));
	TEST_ASSERT_EQUAL_MEMORY(&params, &rig.device.staged, sizeof(params));
	TEST_ASSERT_EQUAL_MEMORY(&params, &rig.store.params, sizeof(params));
	TEST_ASSERT_EQUAL_UINT8(17, rig.device.slave_config.unit_id);

	/* Damaged, and in itself contradictory: factory values. */
	record[50] ^= 1;
	power_up(record, sizeof(record));
	TEST_ASSERT_TRUE(flag(LW_FLAG_DEFAULTS_LOADED));
	TEST_ASSERT_EQUAL_MEMORY(&lw_params_default, &rig.device.active, sizeof(params));
	params.flange_plus_um = 0;
	(void)lw_param_record_encode(&params, 1, record);
	power_up(record, sizeof(record));
	TEST_ASSERT_TRUE(flag(LW_FLAG_DEFAULTS_LOADED));
	TEST_ASSERT_EQUAL_MEMORY(&lw_params_default, &rig.device.active, sizeof(params));
	TEST_ASSERT_EQUAL_INT32(23, status()->ka);
}

/** The write that is due begins. @return its bytes */
static size_t begin_write(void)
{
	return lw_device_begin_write(&rig.device, &written_slot, written);
}

static void test_save_succeeds_fails_and_is_busy(void)
{
	struct lw_params read;
	struct lw_record record;

	TEST_ASSERT_EQUAL_INT(LW_STORE_JOURNAL, rig_write_slot(0)); /* the power-up's */
	TEST_ASSERT_EQUAL_UINT(0, begin_write());
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_JOG_HOLD_MS, 300));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_JOG_HOLD_MS, 350)); /* staged only */
	command(LW_COMMAND_SAVE);
	assert_command(LW_COMMAND_SAVE, LW_RESULT_IN_PROGRESS, LW_REASON_NONE);
	TEST_ASSERT_TRUE(read_bit(LW_SPACE_COIL, LW_ADDRESS_SAVE));
	TEST_ASSERT_EQUAL_UINT(LW_PARAM_RECORD_SIZE, begin_write());
	TEST_ASSERT_EQUAL_UINT(LW_STORE_PARAMS, written_slot);
	TEST_ASSERT_EQUAL_INT(
		0, lw_param_record_decode(written, LW_PARAM_RECORD_SIZE, &read, &record));
	TEST_ASSERT_EQUAL_MEMORY(&rig.device.active, &read, sizeof(read));
	lw_device_end_write(&rig.device, -EIO);
	assert_command(LW_COMMAND_SAVE, LW_RESULT_FAILED, LW_REASON_STORAGE_FAILED);
	TEST_ASSERT_TRUE(flag(LW_FLAG_DIRTY));
	TEST_ASSERT_EQUAL_UINT(0, begin_write());

	command(LW_COMMAND_SAVE);
	assert_command_refused(LW_COMMAND_SAVE, LW_REASON_BUSY_SAVING);
	TEST_ASSERT_NOT_EQUAL(0, begin_write());
	assert_command_refused(LW_COMMAND_SAVE, LW_REASON_BUSY_SAVING);
	lw_device_end_write(&rig.device, 0);
	/* The refusal came after: its account stays. */
	assert_command(LW_COMMAND_SAVE, LW_RESULT_REFUSED, LW_REASON_BUSY_SAVING);
	TEST_ASSERT_FALSE(flag(LW_FLAG_DIRTY));
	TEST_ASSERT_EQUAL_INT32(1, status()->record_sequence);
	TEST_ASSERT_EQUAL_INT32(LW_SLOT_STATE_GOOD, status()->slot_0);

	/* What is applied meanwhile is not what was saved. */
	command(LW_COMMAND_SAVE);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_JOG_HOLD_MS, 400));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_NOT_EQUAL(0, begin_write());
	lw_device_end_write(&rig.device, 0);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);
	TEST_ASSERT_EQUAL_INT32(300, rig.store.params.jog_hold_ms);
	TEST_ASSERT_TRUE(flag(LW_FLAG_DIRTY));
	command(LW_COMMAND_SAVE);
	TEST_ASSERT_NOT_EQUAL(0, begin_write());
	lw_device_end_write(&rig.device, 0);
	assert_command(LW_COMMAND_SAVE, LW_RESULT_DONE, LW_REASON_NONE);
	TEST_ASSERT_FALSE(read_bit(LW_SPACE_COIL, LW_ADDRESS_SAVE));
}

static void test_the_power_up_is_logged(void)
{
	const int32_t version =
		LW_VERSION_MAJOR * 10000 + LW_VERSION_MINOR * 100 + LW_VERSION_PATCH;

	assert_event_count(2);
	ASSERT_EVENTS({LW_EVENT_POWER_UP, version}, {LW_EVENT_DEFAULTS_LOADED, 0});
	TEST_ASSERT_EQUAL_UINT32(1, event(0)->boot);
	TEST_ASSERT_EQUAL_UINT32(5000, event(0)->time_ms);
	TEST_ASSERT_EQUAL_INT32(1, status()->boots);
	TEST_ASSERT_EQUAL_INT32(2, status()->log_sequence);
	TEST_ASSERT_EQUAL_INT32(2, status()->log_count);
	TEST_ASSERT_EQUAL_INT32(2, status()->log_unsaved);
	TEST_ASSERT_EQUAL_INT32(0, status()->watchdog_resets);
}

static void test_a_restart_by_the_watchdog_is_counted(void)
{
	const struct lw_device_config after_watchdog = {
		.host = LW_HOST_SIMULATOR, .store = &rig.store, .watchdog_reset = true};
	const struct lw_inputs inputs = rig_inputs();

	lw_device_init(&rig.device, &after_watchdog, &inputs, rig.now_us, rig.now_us);
	TEST_ASSERT_EQUAL_INT32(1, status()->watchdog_resets);
	TEST_ASSERT_EQUAL_INT32(2, status()->boots);
	TEST_ASSERT_EQUAL_UINT16(LW_EVENT_WATCHDOG_RESET, event(1)->event);
}

static void test_what_is_wrong_with_a_slot_is_logged(void)
{
	struct lw_params params = lw_params_default;
	uint8_t record[LW_PARAM_RECORD_SIZE];

	(void)lw_param_record_encode(&params, 1, record);
	record[50] ^= 1;
	power_up(record, sizeof(record));
	ASSERT_EVENTS({LW_EVENT_SLOT_DAMAGED, 0}, {LW_EVENT_DEFAULTS_LOADED, 0});
	TEST_ASSERT_EQUAL_INT32(LW_SLOT_STATE_DAMAGED, status()->slot_0);

	(void)lw_record_seal(record, "LWPR", LW_PARAM_RECORD_SCHEMA + 1, 1, 6);
	power_up(record, sizeof(record));
	ASSERT_EVENTS({LW_EVENT_SLOT_NEWER, 0}, {LW_EVENT_DEFAULTS_LOADED, 0});

	params.flange_plus_um = 0;
	(void)lw_param_record_encode(&params, 1, record);
	power_up(record, sizeof(record));
	ASSERT_EVENTS({LW_EVENT_SLOT_REFUSED, 0}, {LW_EVENT_DEFAULTS_LOADED, 0});

	(void)lw_param_record_encode(&lw_params_default, 1, record);
	power_up(record, sizeof(record));
	assert_event_count(1);
}

static void test_a_launch_is_logged(void)
{
	forget();
	track();
	assert_event_count(3);
	ASSERT_EVENTS({LW_EVENT_INDEX_STARTED, 0}, {LW_EVENT_INDEX_DONE, status()->span_error_um},
		      {LW_EVENT_TRACKING_STARTED, 0});
	TEST_ASSERT_EQUAL_UINT16(LW_STATE_TRACKING, event(0)->state);
	TEST_ASSERT_EQUAL_INT32(status()->position_um, event(0)->position_um);
	rig_drive(1000);
	rig_rest();
	command(LW_COMMAND_STOP);
	assert_event_count(5);
	ASSERT_EVENTS({LW_EVENT_STOPPED, 0}, {LW_EVENT_TRACKING_ENDED, LW_STATE_READY});
	TEST_ASSERT_TRUE(event(0)->net_edges == status()->net_edges);
	TEST_ASSERT_TRUE(event(0)->net_edges >= 1000);
	TEST_ASSERT_EQUAL_INT32(status()->position_um, event(0)->position_um);
	TEST_ASSERT_EQUAL_UINT32(rig.now_us / 1000, event(0)->time_ms);
}

static void test_an_indexing_that_fails_is_logged(void)
{
	rig_set_switch(LW_PLUS, RIG_SWITCH_NEVER);
	rig_set_switch(LW_MINUS, RIG_SWITCH_NEVER);
	forget();
	command(LW_COMMAND_INDEX);
	rig_run_to_fault(LW_FAULT_INDEX_NO_SWITCH);
	assert_event_count(3);
	ASSERT_EVENTS({LW_EVENT_INDEX_STARTED, 0}, {LW_EVENT_FAULT_SET, LW_FAULT_INDEX_NO_SWITCH},
		      {LW_EVENT_INDEX_FAILED, LW_FAULT_INDEX_NO_SWITCH});
	command(LW_COMMAND_CLEAR_FAULT);
	assert_event_count(4);
	ASSERT_EVENTS({LW_EVENT_FAULT_CLEARED, LW_FAULT_INDEX_NO_SWITCH});

	/* Stopped is no fault. */
	command(LW_COMMAND_INDEX);
	rig_ticks(100);
	command(LW_COMMAND_STOP);
	rig_run_to(LW_STATE_UNINDEXED);
	ASSERT_EVENTS({LW_EVENT_INDEX_STARTED, 0}, {LW_EVENT_STOPPED, 0},
		      {LW_EVENT_INDEX_FAILED, LW_FAULT_NONE});
}

static void test_a_loss_of_synchronization_is_logged(void)
{
	track();
	rig_set_switch(LW_MINUS, RIG_SWITCH_NEVER);
	forget();
	for (int i = 0; i < 100000 && !rig.controller->los.los1[LW_MINUS].set; i++) {
		rig_drive(40);
	}
	/* The carriage was parked on that switch. */
	assert_event_count(2);
	ASSERT_EVENTS({LW_EVENT_SWITCH_IMPLAUSIBLE, LW_MINUS}, {LW_EVENT_LOS1_MINUS, 1});
	TEST_ASSERT_EQUAL_INT32(status()->los1_minus_position_um, event(0)->position_um);
}

static void test_a_switch_elsewhere_is_logged(void)
{
	track();
	rig.switch_at_usteps[LW_MINUS] += 300;
	forget();
	for (int i = 0; i < 100000 && !rig.controller->los.los2[LW_MINUS].set; i++) {
		rig_drive(40);
	}
	ASSERT_EVENTS({LW_EVENT_LOS2_MINUS, 1});
}

static void test_wiring_faults_are_logged(void)
{
	forget();
	rig_set_switch(LW_PLUS, RIG_SWITCH_SHORTED);
	rig_ticks(100);
	TEST_ASSERT_EQUAL_UINT16(LW_EVENT_WIRING_PLUS, rig.store.log.records[1].event);
	rig_ticks(1000);
	forget();
	rig_ticks(1000);
	assert_event_count(0);
}

static void test_overspeed_is_logged_once_until_the_drum_rests(void)
{
	track();
	forget();
	for (int round = 1; round <= 2; round++) {
		rig.drum_edges_per_s = 55000;
		rig_ticks(200);
		rig.drum_edges_per_s = 30000;
		rig_ticks(200);
		rig.drum_edges_per_s = 55000;
		rig_ticks(200);
		rig_rest();
		assert_event_count((uint32_t)round);
		TEST_ASSERT_EQUAL_UINT16(LW_EVENT_OVERSPEED_WARNING, event(0)->event);
		TEST_ASSERT_TRUE(event(0)->detail > 52000);
	}
}

static void test_modes_the_master_and_the_lock_are_logged(void)
{
	forget();
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_OFF));
	rig_tick();
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig_tick();
	ASSERT_EVENTS({LW_EVENT_MODE_CHANGED, LW_MODE_OFF}, {LW_EVENT_MODE_CHANGED, LW_MODE_TRACK});

	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MASTER_TIMEOUT_MS, 100));
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_LOCK_CODE, 1234));
	command(LW_COMMAND_APPLY);
	wait_us(S_US);
	rig.device.slave.last_request_us = rig.now_us;
	rig_tick();
	ASSERT_EVENTS({LW_EVENT_APPLIED, 0}, {LW_EVENT_MASTER_LOST, 0}, {LW_EVENT_MASTER_BACK, 0});

	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_UNLOCK, 1234));
	rig_tick();
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_UNLOCK, 0));
	rig_tick();
	ASSERT_EVENTS({LW_EVENT_LOCK_OPENED, 0}, {LW_EVENT_LOCK_CLOSED, 0});
}

/** Do the write that is due, if any. @return it was the journal's */
static bool write_if_due(void)
{
	unsigned int slot;

	if (lw_device_begin_write(&rig.device, &slot, written) == 0) {
		return false;
	}
	lw_device_end_write(&rig.device, 0);
	return slot / 2 == LW_STORE_JOURNAL / 2;
}

/* The longest period of the journal is an hour: half a day has all there is in it. */
#define HOURS 12

/** Repeat something every second for so long. @return writes of the journal */
static unsigned int writes_while_repeated(void (*repeat)(unsigned int second))
{
	unsigned int writes = 0;

	for (unsigned int second = 0; second < HOURS * 3600; second++) {
		repeat(second);
		wait_us(S_US / 2);
		writes += write_if_due();
		wait_us(S_US / 2);
		writes += write_if_due();
	}
	return writes;
}

static void lose_the_master(unsigned int second)
{
	if (second % 2 == 1) {
		rig.device.slave.last_request_us = rig.now_us;
	}
}

static void give_stop(unsigned int second)
{
	(void)second;
	(void)write_register(LW_ADDRESS_COMMAND, LW_COMMAND_STOP);
}

static void flip_the_mode(unsigned int second)
{
	(void)write_register(LW_ADDRESS_MODE, second % 2 ? LW_MODE_TRACK : LW_MODE_OFF);
}

static void apply_in_vain(unsigned int second)
{
	(void)second;
	(void)write_pair(LW_ADDRESS_FLANGE_PLUS_UM, 0);
	(void)write_register(LW_ADDRESS_COMMAND, LW_COMMAND_APPLY);
}

/*
 * The two sectors of the board's flash take 10,000 erasures each, one for every 58 writes or so.
 * From one cause, two years must be possible several times over.
 */
static void test_what_comes_and_goes_every_second_does_not_wear_out_the_flash(void)
{
	static void (*const causes[])(unsigned int second) = {lose_the_master, give_stop,
							      flip_the_mode, apply_in_vain};

	for (size_t i = 0; i < sizeof(causes) / sizeof(causes[0]); i++) {
		setUp();
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MASTER_TIMEOUT_MS,
							causes[i] == lose_the_master ? 700 : 0));
		command(LW_COMMAND_APPLY);

		const unsigned int writes = writes_while_repeated(causes[i]);

		/* In two years: writes / HOURS * 17520 h / 58 erasures. */
		TEST_ASSERT_LESS_THAN_UINT_MESSAGE(10000 / 4, writes * (17520 / HOURS) / 58,
						   "erasures in two years");
		TEST_ASSERT_GREATER_THAN_UINT(HOURS, writes); /* the hours are kept */
	}
}

/* Nor does it push out of the log what else has happened. */
static void test_what_comes_and_goes_every_second_leaves_the_rest_in_the_log(void)
{
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MASTER_TIMEOUT_MS, 700));
	command(LW_COMMAND_APPLY);
	forget();
	command(LW_COMMAND_FACTORY_LINE);
	for (unsigned int second = 0; second < 3600; second++) {
		lose_the_master(second);
		wait_us(S_US);
	}
	assert_event_count(1 + 2 * (10 + 5));
	TEST_ASSERT_EQUAL_UINT16(LW_EVENT_FACTORY_STAGED, event(2 * (10 + 5))->event);
	for (uint32_t back = 0; back < 2 * (10 + 5); back++) {
		TEST_ASSERT_EQUAL_UINT16(back % 2 ? LW_EVENT_MASTER_LOST : LW_EVENT_MASTER_BACK,
					 event(back)->event);
	}
	TEST_ASSERT_EQUAL_UINT32(1800 - (10 + 5), status()->events_skipped);
	/* Another cause is told at once. */
	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_UINT16(LW_EVENT_STOPPED, event(0)->event);
}

static void test_the_line_is_told_of(void)
{
	struct lw_slave *slave = &rig.device.slave;
	const uint64_t end_us = rig.now_us + 3 * S_US / 2;

	forget();
	TEST_ASSERT_FALSE(flag(LW_FLAG_LINE_BABBLE));
	while (rig.now_us < end_us) {
		lw_slave_receive(slave, (const uint8_t[]){0x55, 0x55}, 2, rig.now_us);
		rig_tick();
	}
	TEST_ASSERT_TRUE(flag(LW_FLAG_LINE_BABBLE));
	TEST_ASSERT_EQUAL_UINT32(1, status()->line_babbles);
	ASSERT_EVENTS({LW_EVENT_LINE_BABBLE, 1});
	rig_ticks(5000);
	TEST_ASSERT_EQUAL_UINT(0, lw_slave_poll(slave, rig.now_us, written));
	TEST_ASSERT_TRUE(flag(LW_FLAG_LINE_BABBLE)); /* now somebody can read it */
	rig_ticks(11000);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LINE_BABBLE));

	uint8_t frame[LW_RTU_FRAME_MAX] = {1, 6, 0, 2, 0, 0};
	uint8_t answer[LW_RTU_FRAME_MAX];

	for (int32_t i = 1; i <= 3; i++) {
		lw_slave_receive(slave, frame, lw_rtu_seal(frame, 6), rig.now_us);
		rig_ticks(10);
		TEST_ASSERT_EQUAL_UINT(8, lw_slave_poll(slave, rig.now_us, answer));
		lw_slave_receive(slave, answer, 8, rig.now_us);
		rig_ticks(100);
		TEST_ASSERT_TRUE(flag(LW_FLAG_LINE_ECHO));
		TEST_ASSERT_EQUAL_INT(i, status()->line_echoes);
	}
	assert_event_count(2);
	ASSERT_EVENTS({LW_EVENT_LINE_ECHO, 1});
	rig_ticks(11000);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LINE_ECHO));
}

static void test_parameter_commands_are_logged(void)
{
	forget();
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_FLANGE_PLUS_UM, 0));
	command(LW_COMMAND_APPLY);
	assert_event_count(1);
	TEST_ASSERT_EQUAL_UINT16(LW_EVENT_APPLY_REFUSED, event(0)->event);
	TEST_ASSERT_EQUAL_INT32(status()->command_reason, event(0)->detail);
	command(LW_COMMAND_FACTORY_MOTION);
	command(LW_COMMAND_APPLY);
	command(LW_COMMAND_SAVE);
	TEST_ASSERT_EQUAL_INT(LW_STORE_PARAMS, rig_write_slot(-EIO));
	command(LW_COMMAND_SAVE);
	TEST_ASSERT_EQUAL_INT(LW_STORE_PARAMS, rig_write_slot(0));
	assert_event_count(5);
	ASSERT_EVENTS({LW_EVENT_FACTORY_STAGED, LW_COMMAND_FACTORY_MOTION}, {LW_EVENT_APPLIED, 0},
		      {LW_EVENT_SAVE_FAILED, -EIO}, {LW_EVENT_SAVED, 1});
}

static void test_events_are_stored_together_soon_after(void)
{
	/* The power-up's at once: another one must not give the same numbers. */
	TEST_ASSERT_EQUAL_INT(LW_STORE_JOURNAL, rig_write_slot(0));
	rig_tick();
	command(LW_COMMAND_STOP);
	wait_us(S_US);
	TEST_ASSERT_EQUAL_INT(-1, rig_write_slot(0));
	command(LW_COMMAND_STOP);
	wait_us(S_US);
	TEST_ASSERT_EQUAL_INT32(2, status()->log_unsaved);
	TEST_ASSERT_EQUAL_INT(LW_STORE_JOURNAL + 1, rig_write_slot(0));
	TEST_ASSERT_EQUAL_INT32(0, status()->log_unsaved);
	rig_tick();
	TEST_ASSERT_EQUAL_INT(-1, rig_write_slot(0));

	wait_us(3 * S_US);
	command(LW_COMMAND_STOP);
	rig_tick();
	TEST_ASSERT_EQUAL_INT(-1, rig_write_slot(0));
	wait_us(2 * S_US);
	TEST_ASSERT_EQUAL_INT(LW_STORE_JOURNAL, rig_write_slot(-EIO));
	TEST_ASSERT_EQUAL_INT32(1, status()->log_unsaved);
	rig_tick();
	TEST_ASSERT_EQUAL_INT(LW_STORE_JOURNAL, rig_write_slot(0));
	TEST_ASSERT_EQUAL_INT32(0, status()->log_unsaved);
}

/** Log an event each 2 s, of a kind that only the machine can cause. @return writes */
static int store_events(int seconds)
{
	int writes = 0;

	for (int i = 0; i < seconds; i += 2) {
		rig.controller->los.los1[LW_PLUS].count++;
		rig_tick();
		wait_us(2 * S_US);
		writes += rig_write_slot(0) >= 0 ? 1 : 0;
	}
	return writes;
}

static void test_many_events_do_not_wear_the_flash_out(void)
{
	const int at_once = store_events(40);

	TEST_ASSERT_EQUAL_INT(10, at_once);
	TEST_ASSERT_INT_WITHIN(1, 60, store_events(3600));
	/* Quiet hours give back what was spent, and no more. */
	wait_us(36000 * S_US);
	(void)rig_write_slot(0);
	wait_us(600 * S_US);
	TEST_ASSERT_EQUAL_INT(10, store_events(40));
}

static void test_the_hours_are_stored_without_events(void)
{
	wait_us(2 * S_US);
	TEST_ASSERT_EQUAL_INT(LW_STORE_JOURNAL, rig_write_slot(0)); /* the power-up */
	wait_us(899 * S_US);
	TEST_ASSERT_EQUAL_INT(-1, rig_write_slot(0));
	wait_us(2 * S_US);
	TEST_ASSERT_EQUAL_INT(LW_STORE_JOURNAL + 1, rig_write_slot(0));
	TEST_ASSERT_EQUAL_INT32(903, status()->powered_s);
	TEST_ASSERT_EQUAL_INT32(0, status()->tracking_s);
}

static void test_only_tracking_counts_as_tracking(void)
{
	track();
	const uint32_t powered_s = status()->powered_s;

	for (int i = 0; i < 10; i++) {
		wait_us(S_US / 4);
	}
	TEST_ASSERT_UINT32_WITHIN(1, powered_s + 2, status()->powered_s);
	TEST_ASSERT_EQUAL_INT32(2, status()->tracking_s);
	command(LW_COMMAND_STOP);
	wait_us(5 * S_US);
	TEST_ASSERT_EQUAL_INT32(2, status()->tracking_s);
}

static void test_nothing_is_written_while_moving_but_in_tracking_at_rest(void)
{
	command(LW_COMMAND_INDEX);
	while (rig.controller->state != LW_STATE_TRACKING) {
		rig_tick();
		TEST_ASSERT_TRUE(lw_controller_moving(rig.controller) ||
				 rig.controller->state == LW_STATE_READY ||
				 rig.controller->state == LW_STATE_TRACKING);
		if (lw_controller_moving(rig.controller)) {
			TEST_ASSERT_EQUAL_INT(-1, rig_write_slot(0));
		}
	}
	TEST_ASSERT_EQUAL_INT(LW_STORE_JOURNAL, rig_write_slot(0));
	/* A loss of synchronization: it is in the log although the state stays tracking. */
	rig_place(rig.carriage_usteps + 400);
	rig.drum_edges_per_s = 20000;
	for (int i = 0; i < 4000; i++) {
		rig_tick();
		TEST_ASSERT_EQUAL_INT(-1, rig_write_slot(0));
	}
	TEST_ASSERT_TRUE(flag(LW_FLAG_LOS));
	rig_rest();
	TEST_ASSERT_EQUAL_INT(LW_STORE_LOOK, rig_write_slot(0));
	TEST_ASSERT_EQUAL_INT(LW_STORE_JOURNAL + 1, rig_write_slot(0));
	TEST_ASSERT_EQUAL_INT32(0, status()->log_unsaved);
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
}

static void test_nothing_begins_to_move_during_a_write(void)
{
	/* A carriage that is ready and would follow the drum. */
	track();
	command(LW_COMMAND_STOP);
	wait_us(3 * S_US);
	TEST_ASSERT_NOT_EQUAL(0, begin_write());
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig_ticks(300);
	TEST_ASSERT_EQUAL_INT(LW_STATE_READY, rig.controller->state);
	lw_device_end_write(&rig.device, 0);
	rig_tick();
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);

	/* Neither between SAVE and its write. */
	command(LW_COMMAND_STOP);
	command(LW_COMMAND_SAVE);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig_ticks(10);
	TEST_ASSERT_EQUAL_INT(LW_STATE_READY, rig.controller->state);
	TEST_ASSERT_EQUAL_INT(LW_STORE_PARAMS, rig_write_slot(0));
	rig_tick();
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
	command(LW_COMMAND_STOP);

	/* An indexing begins with the end of the write. */
	wait_us(100 * S_US);
	TEST_ASSERT_NOT_EQUAL(0, begin_write());
	const uint32_t steps = status()->steps;

	command(LW_COMMAND_INDEX);
	TEST_ASSERT_EQUAL_UINT32(0, lw_controller_timer_rate_edges_per_s(rig.controller));
	rig_ticks(100);
	TEST_ASSERT_EQUAL_UINT32(steps, status()->steps);
	lw_device_end_write(&rig.device, 0);
	rig_run_to(LW_STATE_TRACKING);
}

static void test_log_and_counters_go_on_after_a_restart(void)
{
	uint8_t journal[LW_STORE_SLOT_SIZE];
	uint32_t newest;

	wait_us(100 * S_US);
	TEST_ASSERT_NOT_EQUAL(0, begin_write());
	memcpy(journal, written, sizeof(journal));
	lw_device_end_write(&rig.device, 0);
	newest = rig.store.log.newest;

	const struct lw_inputs inputs = rig_inputs();

	lw_store_init(&rig.store);
	lw_store_load(&rig.store, LW_STORE_JOURNAL, journal, sizeof(journal));
	lw_device_init(&rig.device, &config, &inputs, rig.now_us, rig.now_us);
	TEST_ASSERT_EQUAL_INT32(2, status()->boots);
	TEST_ASSERT_EQUAL_INT32(100, status()->powered_s);
	/* What was lost has had numbers, too: they are not given again. */
	assert_event_count(newest + LW_LOG_SKIP + 2);
	TEST_ASSERT_EQUAL_UINT32(2, event(0)->boot);
	TEST_ASSERT_EQUAL_UINT32(1, event(2)->boot);
	TEST_ASSERT_EQUAL_INT32(2, status()->log_unsaved);
}

static void test_the_log_is_file_1(void)
{
	/* Ten registers from the fifth of the second event on, into the third. */
	static const uint8_t request[] = {20, 7, 6, 0, 1, 0, 2 * 16 + 4, 0, 20};
	uint8_t expected[2 * LW_LOG_RECORD_SIZE];
	uint8_t response[LW_PDU_MAX];

	command(LW_COMMAND_STOP);
	lw_log_encode(&rig.store.log.records[2], expected);
	lw_log_encode(&rig.store.log.records[3], expected + LW_LOG_RECORD_SIZE);
	TEST_ASSERT_EQUAL_UINT(
		44, lw_pdu_handle(&rig.device.slave.pdu, request, sizeof(request), response));
	TEST_ASSERT_EQUAL_HEX8_ARRAY(expected + 8, response + 4, 40);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_power_up_with_a_record);
	RUN_TEST(test_save_succeeds_fails_and_is_busy);
	RUN_TEST(test_the_power_up_is_logged);
	RUN_TEST(test_a_restart_by_the_watchdog_is_counted);
	RUN_TEST(test_what_is_wrong_with_a_slot_is_logged);
	RUN_TEST(test_a_launch_is_logged);
	RUN_TEST(test_an_indexing_that_fails_is_logged);
	RUN_TEST(test_a_loss_of_synchronization_is_logged);
	RUN_TEST(test_a_switch_elsewhere_is_logged);
	RUN_TEST(test_wiring_faults_are_logged);
	RUN_TEST(test_overspeed_is_logged_once_until_the_drum_rests);
	RUN_TEST(test_modes_the_master_and_the_lock_are_logged);
	RUN_TEST(test_what_comes_and_goes_every_second_does_not_wear_out_the_flash);
	RUN_TEST(test_what_comes_and_goes_every_second_leaves_the_rest_in_the_log);
	RUN_TEST(test_the_line_is_told_of);
	RUN_TEST(test_parameter_commands_are_logged);
	RUN_TEST(test_events_are_stored_together_soon_after);
	RUN_TEST(test_many_events_do_not_wear_the_flash_out);
	RUN_TEST(test_the_hours_are_stored_without_events);
	RUN_TEST(test_only_tracking_counts_as_tracking);
	RUN_TEST(test_nothing_is_written_while_moving_but_in_tracking_at_rest);
	RUN_TEST(test_nothing_begins_to_move_during_a_write);
	RUN_TEST(test_log_and_counters_go_on_after_a_restart);
	RUN_TEST(test_the_log_is_file_1);
	return UNITY_END();
}
