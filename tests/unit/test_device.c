/* SPDX-License-Identifier: Apache-2.0 */
/* The whole controller as one object: parameter sets, commands, storage, registers, coils. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include <unity.h>

#include "lw/modbus/crc16.h"
#include "device_rig.h"

void setUp(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
}

void tearDown(void)
{
}

static void test_power_up_without_a_record(void)
{
	TEST_ASSERT_TRUE(flag(LW_FLAG_DEFAULTS_LOADED));
	TEST_ASSERT_FALSE(flag(LW_FLAG_STAGED));
	TEST_ASSERT_FALSE(flag(LW_FLAG_DIRTY));
	TEST_ASSERT_FALSE(flag(LW_FLAG_RESTART_NEEDED));
	assert_command(LW_COMMAND_NONE, LW_RESULT_NONE, LW_REASON_NONE);
	TEST_ASSERT_EQUAL_INT32(LW_NO_ADDRESS, status()->command_address);
	TEST_ASSERT_EQUAL_HEX32(0x12345678, status()->self_test);
	TEST_ASSERT_EQUAL_INT32(LW_HOST_SIMULATOR, status()->host);
	TEST_ASSERT_EQUAL_INT32(23, status()->ka);
	TEST_ASSERT_EQUAL_INT32(8000, status()->reversal_plus_usteps);
	TEST_ASSERT_EQUAL_INT32(-8000, status()->reversal_minus_usteps);
}

static void test_the_host_can_override_line_settings_and_add_registers(void)
{
	static const struct lw_point point = {.address = 61440, .count = 1, .type = LW_TYPE_U16};
	static uint32_t value = 77;
	const struct lw_bank_section section = {
		.space = LW_SPACE_HOLDING,
		.points = &point,
		.point_count = 1,
		.context = &value,
		.image = rig.device.sections[6].image, /* hands out its context */
	};
	const struct lw_device_config other = {
		.host = LW_HOST_QEMU,
		.store = &rig.store,
		.host_section = &section,
		.silence_us = 16000,
		.unit_id = 9,
	};
	const struct lw_inputs inputs = rig_inputs();

	lw_device_init(&rig.device, &other, &inputs, 0, 0);
	TEST_ASSERT_EQUAL_INT32(77, read_register(LW_SPACE_HOLDING, 61440));
	TEST_ASSERT_EQUAL_UINT8(9, rig.device.slave_config.unit_id);
	TEST_ASSERT_EQUAL_UINT32(16000, rig.device.slave_config.rtu.silence_us);
}

static void test_default_line_settings_do_not_touch_the_stored_ones(void)
{
	const struct lw_device_config other = {
		.host = LW_HOST_SIMULATOR, .store = &rig.store, .default_line = true};
	const struct lw_inputs inputs = rig_inputs();
	struct lw_params saved = lw_params_default;
	uint8_t record[LW_PARAM_RECORD_SIZE];

	saved.unit_id = 7;
	(void)lw_param_record_encode(&saved, 1, record);
	lw_store_load(&rig.store, LW_STORE_PARAMS, record, sizeof(record));
	lw_device_init(&rig.device, &other, &inputs, 0, 0);
	TEST_ASSERT_EQUAL_UINT8(1, rig.device.slave_config.unit_id);
	TEST_ASSERT_EQUAL_INT32(7, rig.device.active.unit_id);
	TEST_ASSERT_EQUAL_INT32(7, rig.store.params.unit_id);
	lw_device_init(&rig.device, &config, &inputs, 0, 0);
	TEST_ASSERT_EQUAL_UINT8(7, rig.device.slave_config.unit_id);
}

static void test_parameters_are_staged_then_applied(void)
{
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_OVERSHOOT_UM, 1000));
	TEST_ASSERT_TRUE(flag(LW_FLAG_STAGED));
	TEST_ASSERT_EQUAL_UINT32(2500, rig.device.active.overshoot_um);
	TEST_ASSERT_EQUAL_INT32(1000, read_register(LW_SPACE_HOLDING, LW_ADDRESS_OVERSHOOT_UM + 1));
	TEST_ASSERT_EQUAL_INT32(2500,
				read_register(LW_SPACE_INPUT, LW_MAP_ACTIVE_ADDRESS_OFFSET +
								      LW_ADDRESS_OVERSHOOT_UM + 1));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);
	TEST_ASSERT_FALSE(flag(LW_FLAG_STAGED));
	TEST_ASSERT_TRUE(flag(LW_FLAG_DIRTY));
	TEST_ASSERT_EQUAL_UINT32(1000, rig.device.active.overshoot_um);
	TEST_ASSERT_INT32_WITHIN(40, 1000, status()->overshoot_actual_um);
	TEST_ASSERT_EQUAL_INT32(2500,
				read_register(LW_SPACE_INPUT, LW_MAP_STORED_ADDRESS_OFFSET +
								      LW_ADDRESS_OVERSHOOT_UM + 1));
}

static void test_apply_refused_says_why_and_changes_nothing(void)
{
	track();
	rig_rest();
	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_SWITCH_PLUS_UM, 81000));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_REFUSED, LW_REASON_SWITCH_PLUS_OUTSIDE);
	TEST_ASSERT_EQUAL_INT32(LW_ADDRESS_SWITCH_PLUS_UM, status()->command_address);
	TEST_ASSERT_EQUAL_INT32(81000, status()->command_value);
	TEST_ASSERT_EQUAL_INT32(80000, status()->command_limit);
	TEST_ASSERT_EQUAL_MEMORY(&lw_params_default, &rig.device.active, sizeof(lw_params_default));
	TEST_ASSERT_TRUE(flag(LW_FLAG_STAGED));
	TEST_ASSERT_TRUE(flag(LW_FLAG_INDEXED));
	command(LW_COMMAND_REVERT);
	assert_command(LW_COMMAND_REVERT, LW_RESULT_DONE, LW_REASON_NONE);
	TEST_ASSERT_EQUAL_INT32(LW_NO_ADDRESS, status()->command_address);
	TEST_ASSERT_FALSE(flag(LW_FLAG_STAGED));
}

static void test_apply_of_the_decoding_waits_for_the_drum_to_rest(void)
{
	static const struct {
		uint16_t address;
		int32_t value;
	} cases[] = {{LW_ADDRESS_ENCODER_EDGES_PER_PULSE, 4},
		     {LW_ADDRESS_ENCODER_INVERT_A, 1},
		     {LW_ADDRESS_ENCODER_INVERT_B, 1},
		     {LW_ADDRESS_DRUM_DIRECTION_INVERT, 1}};

	for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
		setUp();
		rig_drive(4000);
		TEST_ASSERT_FALSE(flag(LW_FLAG_DRUM_AT_REST));
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_JOG_HOLD_MS, 300));
		command(LW_COMMAND_APPLY);
		assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);

		TEST_ASSERT_EQUAL_INT(0, write_register(cases[i].address, cases[i].value));
		TEST_ASSERT_TRUE(write_register(LW_ADDRESS_COMMAND, LW_COMMAND_APPLY) != 0);
		assert_command(LW_COMMAND_APPLY, LW_RESULT_REFUSED, LW_REASON_DRUM_MOVING);
		rig_ticks(1000);
		command(LW_COMMAND_APPLY);
		assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);
	}
}

static const struct lw_log_record *newest_event(void)
{
	return &rig.store.log.records[rig.store.log.newest % LW_LOG_RECORDS];
}

/** Sign the active set, as the laptop tool does. */
static void accept(uint32_t crc)
{
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_ACCEPTED_CRC, (int32_t)crc));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);
}

static void test_a_set_is_accepted_until_it_is_another_one(void)
{
	TEST_ASSERT_TRUE(flag(LW_FLAG_NOT_ACCEPTED));
	track();
	command(LW_COMMAND_STOP);
	accept(status()->active_crc);
	TEST_ASSERT_EQUAL_UINT16(LW_EVENT_ACCEPTED, newest_event()->event);
	TEST_ASSERT_EQUAL_UINT32(status()->active_crc, newest_event()->detail);
	TEST_ASSERT_FALSE(flag(LW_FLAG_NOT_ACCEPTED));
	TEST_ASSERT_TRUE(flag(LW_FLAG_INDEXED));

	/* Another line is the same winch, another jog is not. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_UNIT_ID, 9));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_FALSE(flag(LW_FLAG_NOT_ACCEPTED));
	TEST_ASSERT_EQUAL_UINT16(LW_EVENT_APPLIED, newest_event()->event);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_JOG_HOLD_MS, 300));
	TEST_ASSERT_FALSE(flag(LW_FLAG_NOT_ACCEPTED)); /* only staged */
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_TRUE(flag(LW_FLAG_NOT_ACCEPTED));
	TEST_ASSERT_EQUAL_INT32(1 << LW_LAUNCH_INHIBIT_NOT_TRACKING, status()->launch_inhibit);
	TEST_ASSERT_EQUAL_INT(
		0, write_register(LW_ADDRESS_JOG_HOLD_MS, lw_params_default.jog_hold_ms));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_FALSE(flag(LW_FLAG_NOT_ACCEPTED));

	command(LW_COMMAND_FACTORY_MOTION);
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_TRUE(flag(LW_FLAG_NOT_ACCEPTED));
	TEST_ASSERT_EQUAL_UINT16(LW_EVENT_ACCEPTED, newest_event()->event);
	TEST_ASSERT_EQUAL_INT32(0, newest_event()->detail);
}

static void test_an_accepted_set_outlasts_a_power_cut(void)
{
	static uint8_t record[LW_PARAM_RECORD_SIZE];
	struct lw_params signed_set = lw_params_default;

	signed_set.pitch_um = 11000;
	signed_set.accepted_crc = lw_params_crc(&signed_set);
	(void)lw_param_record_encode(&signed_set, 1, record);
	power_up(record, sizeof(record));
	TEST_ASSERT_FALSE(flag(LW_FLAG_NOT_ACCEPTED));
	/* A record of older firmware ends before the signature: nobody has signed it. */
	(void)lw_record_seal(record, "LWPR", LW_PARAM_RECORD_SCHEMA, 1, 6);
	power_up(record, LW_RECORD_OVERHEAD + 6);
	TEST_ASSERT_FALSE(flag(LW_FLAG_DEFAULTS_LOADED));
	TEST_ASSERT_TRUE(flag(LW_FLAG_NOT_ACCEPTED));
}

static void test_apply_keeps_the_index_if_no_parameter_needs_it(void)
{
	track();
	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_JOG_HOLD_MS, 300));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_TRUE(flag(LW_FLAG_INDEXED));
	TEST_ASSERT_EQUAL_INT32(LW_STATE_READY, status()->state);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_TRIM_PLUS_UM, -100));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_SPAN_TOLERANCE_UM, 900));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_FALSE(flag(LW_FLAG_INDEXED));
	TEST_ASSERT_EQUAL_INT32(LW_STATE_UNINDEXED, status()->state);
	TEST_ASSERT_EQUAL_INT32(0, read_register(LW_SPACE_HOLDING, LW_ADDRESS_TRIM_PLUS_UM));
	rig_ticks(1000);
	TEST_ASSERT_EQUAL_INT32(LW_STATE_UNINDEXED, status()->state);
}

static void test_apply_turns_the_encoder_without_a_false_edge(void)
{
	for (int bits = 0; bits < 4; bits++) {
		setUp();
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_ENCODER_INVERT_A, bits & 1));
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_ENCODER_INVERT_B, bits >> 1));
		command(LW_COMMAND_APPLY);
		for (int i = 0; i < 40; i++) {
			rig_transition(1);
		}
		TEST_ASSERT_EQUAL_INT64(bits == 0 || bits == 3 ? 20 : -20, status()->net_edges);
		TEST_ASSERT_EQUAL_UINT32(0, status()->illegal_transitions);
	}
}

static void test_apply_of_another_contact_type_sees_a_switch_that_is_held(void)
{
	/* An NC contact alone, opened: read as a pair, both are open. */
	rig_set_switch(LW_PLUS, RIG_SWITCH_NO_OPEN);
	rig.actuated[LW_PLUS] = true;
	rig_tell_switch(LW_PLUS);
	rig_ticks(100);
	TEST_ASSERT_FALSE(flag(LW_FLAG_SWITCH_PLUS));
	rig.controller->limit[LW_PLUS].triggers = 12;
	TEST_ASSERT_EQUAL_INT(
		0, write_register(LW_ADDRESS_SWITCH_CONTACTS, LW_SWITCH_CONTACTS_SINGLE_NC));
	command(LW_COMMAND_APPLY);
	rig_ticks(100);
	TEST_ASSERT_TRUE(flag(LW_FLAG_SWITCH_PLUS));
	TEST_ASSERT_FALSE(flag(LW_FLAG_SWITCH_MINUS));
	TEST_ASSERT_EQUAL_UINT32(12, status()->switch_plus_triggers);
}

static void test_parameters_are_refused_while_tracking_and_commands_while_moving(void)
{
	static const enum lw_command commands[] = {
		LW_COMMAND_APPLY,          LW_COMMAND_REVERT,       LW_COMMAND_SAVE,
		LW_COMMAND_FACTORY_MOTION, LW_COMMAND_FACTORY_LINE, LW_COMMAND_FACTORY_ALL};

	command(LW_COMMAND_INDEX);
	rig_ticks(10);
	for (int i = 0; i < 6; i++) {
		assert_command_refused(commands[i], LW_REASON_BUSY_MOVING);
	}
	assert_command_refused(LW_COMMAND_INDEX, LW_REASON_BUSY_MOVING);
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_register(LW_ADDRESS_TRIM_PLUS_UM, -100));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_BUSY_MOVING, why.reason);
	/* What is unchanged may be written at any time. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_TRIM_PLUS_UM, 0));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_TRIM_MINUS_UM, 0));
	rig_run_to(LW_STATE_TRACKING);
	for (int i = 0; i < 6; i++) {
		assert_command_refused(commands[i], LW_REASON_BUSY_TRACKING);
	}
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_register(LW_ADDRESS_JOG_HOLD_MS, 300));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_BUSY_TRACKING, why.reason);
	TEST_ASSERT_FALSE(flag(LW_FLAG_STAGED));
}

static void test_factory_by_scope(void)
{
	static const struct {
		enum lw_command code;
		int32_t jog_hold_ms;
		int32_t unit_id;
	} scopes[] = {{LW_COMMAND_FACTORY_MOTION, 500, 5},
		      {LW_COMMAND_FACTORY_LINE, 300, 1},
		      {LW_COMMAND_FACTORY_ALL, 500, 1}};

	for (int i = 0; i < 3; i++) {
		setUp();
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_JOG_HOLD_MS, 300));
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_UNIT_ID, 5));
		command(LW_COMMAND_APPLY);
		TEST_ASSERT_TRUE(flag(LW_FLAG_RESTART_NEEDED));
		command(scopes[i].code);
		TEST_ASSERT_EQUAL_INT32(scopes[i].jog_hold_ms, rig.device.staged.jog_hold_ms);
		TEST_ASSERT_EQUAL_INT32(scopes[i].unit_id, rig.device.staged.unit_id);
		TEST_ASSERT_EQUAL_INT32(300, rig.device.active.jog_hold_ms);
	}
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_BAUD_RATE, 9600));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_UNIT_ID, 1));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_TRUE(flag(LW_FLAG_RESTART_NEEDED));
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_BAUD_RATE, 19200));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_LINE_FORMAT, LW_LINE_FORMAT_8N1));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_TRUE(flag(LW_FLAG_RESTART_NEEDED));
}

static void test_index_command_ends_done_faulted_or_stopped(void)
{
	assert_command(LW_COMMAND_NONE, LW_RESULT_NONE, LW_REASON_NONE);
	command(LW_COMMAND_INDEX);
	assert_command(LW_COMMAND_INDEX, LW_RESULT_IN_PROGRESS, LW_REASON_NONE);
	TEST_ASSERT_TRUE(read_bit(LW_SPACE_COIL, LW_ADDRESS_INDEX));
	rig_run_to(LW_STATE_TRACKING);
	assert_command(LW_COMMAND_INDEX, LW_RESULT_DONE, LW_REASON_NONE);
	TEST_ASSERT_FALSE(read_bit(LW_SPACE_COIL, LW_ADDRESS_INDEX));

	rig_set_switch(LW_PLUS, RIG_SWITCH_NEVER);
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_FAULT);
	assert_command(LW_COMMAND_INDEX, LW_RESULT_FAILED, LW_REASON_FAULTED);

	command(LW_COMMAND_CLEAR_FAULT);
	assert_command(LW_COMMAND_CLEAR_FAULT, LW_RESULT_DONE, LW_REASON_NONE);
	rig_place(0);
	command(LW_COMMAND_INDEX);
	rig_ticks(100);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_OFF));
	rig_ticks(2);
	assert_command(LW_COMMAND_INDEX, LW_RESULT_FAILED, LW_REASON_STOPPED);
	assert_command_refused(LW_COMMAND_INDEX, LW_REASON_MODE_OFF);
}

static void test_index_is_refused_with_a_turning_drum_and_stop_never(void)
{
	rig.drum_edges_per_s = 3000;
	rig_ticks(100);
	assert_command_refused(LW_COMMAND_INDEX, LW_REASON_DRUM_MOVING);
	command(LW_COMMAND_STOP);
	assert_command(LW_COMMAND_STOP, LW_RESULT_DONE, LW_REASON_NONE);
	lw_controller_overtravel(rig.controller, LW_PLUS, true);
	rig_ticks(1);
	assert_command_refused(LW_COMMAND_CLEAR_FAULT, LW_REASON_CAUSE_PRESENT);
	TEST_ASSERT_TRUE(flag(LW_FLAG_FAULTED));
	TEST_ASSERT_TRUE(flag(LW_FLAG_OVERTRAVEL_PLUS));
}

static void test_command_none_does_nothing(void)
{
	const int32_t sequence = status()->command_sequence;

	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_COMMAND, LW_COMMAND_NONE));
	TEST_ASSERT_EQUAL_INT32(sequence, status()->command_sequence);
	TEST_ASSERT_EQUAL_INT(0, write_coil(LW_ADDRESS_INDEX, false));
	TEST_ASSERT_EQUAL_INT32(sequence, status()->command_sequence);
}

static void test_coils_run_commands(void)
{
	static const struct {
		uint16_t address;
		enum lw_command code;
	} coils[] = {{LW_ADDRESS_STOP, LW_COMMAND_STOP},
		     {LW_ADDRESS_CLEAR_FAULT, LW_COMMAND_CLEAR_FAULT},
		     {LW_ADDRESS_APPLY, LW_COMMAND_APPLY},
		     {LW_ADDRESS_REVERT, LW_COMMAND_REVERT},
		     {LW_ADDRESS_SAVE, LW_COMMAND_SAVE},
		     {LW_ADDRESS_INDEX, LW_COMMAND_INDEX}};

	for (size_t i = 0; i < sizeof(coils) / sizeof(coils[0]); i++) {
		TEST_ASSERT_EQUAL_INT(0, write_coil(coils[i].address, true));
		TEST_ASSERT_EQUAL_INT32(coils[i].code, status()->command_code);
	}
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_coil(LW_ADDRESS_APPLY, true));
	assert_command(LW_COMMAND_APPLY, LW_RESULT_REFUSED, LW_REASON_BUSY_MOVING);
}

static void test_jog_by_coil_and_by_register(void)
{
	TEST_ASSERT_EQUAL_INT(0, write_coil(LW_ADDRESS_JOG_PLUS, true));
	rig_ticks(100);
	TEST_ASSERT_TRUE(read_bit(LW_SPACE_COIL, LW_ADDRESS_JOG_PLUS));
	TEST_ASSERT_FALSE(read_bit(LW_SPACE_COIL, LW_ADDRESS_JOG_MINUS));
	TEST_ASSERT_EQUAL_INT32(1, read_register(LW_SPACE_HOLDING, LW_ADDRESS_JOG));
	TEST_ASSERT_TRUE(flag(LW_FLAG_MOVING));
	TEST_ASSERT_EQUAL_INT(0, write_coil(LW_ADDRESS_JOG_MINUS, false));
	TEST_ASSERT_TRUE(read_bit(LW_SPACE_COIL, LW_ADDRESS_JOG_PLUS));
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_coil(LW_ADDRESS_JOG_MINUS, true));
	TEST_ASSERT_EQUAL_INT(0, write_coil(LW_ADDRESS_JOG_PLUS, false));
	TEST_ASSERT_FALSE(read_bit(LW_SPACE_COIL, LW_ADDRESS_JOG_PLUS));
	TEST_ASSERT_EQUAL_INT32(0, read_register(LW_SPACE_HOLDING, LW_ADDRESS_JOG));
	rig_run_to(LW_STATE_UNINDEXED);

	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_JOG, -1));
	rig_ticks(10);
	TEST_ASSERT_EQUAL_INT32(0xFFFF, read_register(LW_SPACE_HOLDING, LW_ADDRESS_JOG));
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_register(LW_ADDRESS_JOG, 1));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_JOG, 0));
	rig_run_to(LW_STATE_UNINDEXED);
}

static void test_mode_by_register(void)
{
	track();
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_CENTRE));
	TEST_ASSERT_EQUAL_INT32(LW_MODE_CENTRE, read_register(LW_SPACE_HOLDING, LW_ADDRESS_MODE));
	TEST_ASSERT_EQUAL_INT32(LW_MODE_TRACK, status()->active_mode);
	rig_run_to(LW_STATE_CENTRED);
	TEST_ASSERT_EQUAL_INT32(LW_MODE_CENTRE, status()->active_mode);
}

static void test_trim_by_register(void)
{
	track();
	rig_drive(5000);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_TRIM_PLUS_UM, -500));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_TRIM_MINUS_UM, 300));
	TEST_ASSERT_TRUE(flag(LW_FLAG_TRIM_PENDING));
	rig_drive(40);
	TEST_ASSERT_FALSE(flag(LW_FLAG_TRIM_PENDING));
	TEST_ASSERT_EQUAL_INT32(7950, status()->reversal_plus_usteps);
	TEST_ASSERT_EQUAL_INT32(-7970, status()->reversal_minus_usteps);
	TEST_ASSERT_EQUAL_INT32(300, read_register(LW_SPACE_HOLDING, LW_ADDRESS_TRIM_MINUS_UM));

	TEST_ASSERT_EQUAL_INT(-EINVAL, write_register(LW_ADDRESS_TRIM_PLUS_UM, 5000));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_OVERSHOOT_BEYOND_FLANGE_PLUS, why.reason);
	TEST_ASSERT_EQUAL_UINT16(LW_ADDRESS_TRIM_PLUS_UM, why.address);
	TEST_ASSERT_EQUAL_INT32(5000, why.value);

	/* The limit is the farthest that passes. */
	const int32_t limit = why.limit;

	TEST_ASSERT_EQUAL_INT(-EINVAL, write_register(LW_ADDRESS_TRIM_PLUS_UM, limit + 1));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_TRIM_PLUS_UM, limit));
	TEST_ASSERT_EQUAL_INT(-EINVAL, write_register(LW_ADDRESS_TRIM_MINUS_UM, 5000));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_SWITCH_MINUS_OUTSIDE, why.reason);
	TEST_ASSERT_EQUAL_INT(-EINVAL, write_register(LW_ADDRESS_TRIM_MINUS_UM, why.limit + 1));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_TRIM_MINUS_UM, why.limit));
}

enum {
	SETPOINTS = 5
};

/** Write holding registers 0 to 4 in one request. */
static int write_setpoints(enum lw_command code, int jog, int trim_plus_um)
{
	const int32_t values[SETPOINTS] = {(int32_t)code, LW_MODE_TRACK, jog, trim_plus_um, 0};
	uint8_t in[2 * SETPOINTS];

	for (size_t i = 0; i < SETPOINTS; i++) {
		in[2 * i] = (uint8_t)((uint32_t)values[i] >> 8);
		in[2 * i + 1] = (uint8_t)values[i];
	}
	return lw_bank_write_registers(&rig.device.bank, LW_ADDRESS_COMMAND, SETPOINTS, in, &why);
}

/* Each may be right by itself; together the second would run where it may not. */
static void test_a_request_gives_one_order(void)
{
	const struct {
		enum lw_command code;
		int jog;
		int trim_plus_um;
		int ret;
	} requests[] = {
		{LW_COMMAND_APPLY, 1, 0, -EINVAL},
		{LW_COMMAND_INDEX, -1, 0, -EINVAL},
		{LW_COMMAND_SAVE, 1, 0, -EINVAL},
		{LW_COMMAND_TRIM_EARLY, 0, -300, -EINVAL},
		{LW_COMMAND_TRIM_LATE, 0, -300, -EINVAL},
		{LW_COMMAND_NONE, 1, -300, -EINVAL},
		{LW_COMMAND_CLEAR_FAULT, 0, -300, 0},
		{LW_COMMAND_NONE, 0, -300, 0},
		{LW_COMMAND_STOP, 0, -200, 0},
		{LW_COMMAND_NONE, 1, -200, 0}, /* the trim as it is */
		{LW_COMMAND_STOP, 1, -200, 0},
		{LW_COMMAND_INDEX, 0, -200, 0},
	};

	track();
	for (size_t i = 0; i < sizeof(requests) / sizeof(requests[0]); i++) {
		const struct lw_controller before = *rig.controller;
		const int ret = write_setpoints(requests[i].code, requests[i].jog,
						requests[i].trim_plus_um);

		char row[32];

		(void)snprintf(row, sizeof(row), "request %zu", i);
		TEST_ASSERT_EQUAL_INT_MESSAGE(requests[i].ret, ret, row);
		if (ret != 0) {
			TEST_ASSERT_EQUAL_UINT16(LW_REASON_SEVERAL_COMMANDS, why.reason);
			TEST_ASSERT_EQUAL_MEMORY(&before, rig.controller, sizeof(before));
		} else if (requests[i].code != LW_COMMAND_INDEX) {
			rig_ticks(3000);
		}
	}
	TEST_ASSERT_EQUAL_INT(LW_STATE_SEEKING, rig.controller->state);

	/* Coils: apply and a jog; both jogs; a stop and a jog. */
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_EQUAL_INT(
		-EINVAL, lw_bank_write_bits(&rig.device.bank, 0, 8, (const uint8_t[]){0x88}, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_SEVERAL_COMMANDS, why.reason);
	TEST_ASSERT_EQUAL_UINT16(LW_ADDRESS_APPLY, why.address);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_REFUSED, LW_REASON_SEVERAL_COMMANDS);
	TEST_ASSERT_EQUAL_INT(
		-EINVAL, lw_bank_write_bits(&rig.device.bank, 6, 2, (const uint8_t[]){0x03}, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_ADDRESS_JOG_MINUS, why.address);
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
	TEST_ASSERT_EQUAL_INT(
		0, lw_bank_write_bits(&rig.device.bank, 0, 8, (const uint8_t[]){0x42}, &why));
	rig_ticks(3000);
	TEST_ASSERT_TRUE(rig.controller->held);
}

/** A request of the master: read one input register. Its answer comes when the frame has ended. */
static void ask(uint64_t slave_now_us)
{
	uint8_t frame[8] = {1, 4, 0, 0, 0, 1};
	uint8_t tx[LW_RTU_FRAME_MAX];
	const uint16_t crc = lw_crc16(frame, 6);

	frame[6] = (uint8_t)crc;
	frame[7] = (uint8_t)(crc >> 8);
	lw_slave_receive(&rig.device.slave, frame, sizeof(frame), slave_now_us);
	TEST_ASSERT_EQUAL_UINT(
		7, lw_slave_poll(&rig.device.slave, lw_slave_deadline_us(&rig.device.slave), tx));
}

static void test_master_lost(void)
{
	uint64_t slave_now_us = 100000000;

	rig_ticks(2000);
	TEST_ASSERT_FALSE(flag(LW_FLAG_MASTER_LOST)); /* not watched */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MASTER_TIMEOUT_MS, 1000));
	command(LW_COMMAND_APPLY);
	rig_ticks(1);
	TEST_ASSERT_TRUE(flag(LW_FLAG_MASTER_LOST));
	TEST_ASSERT_EQUAL_INT32(1 << LW_LAUNCH_INHIBIT_MASTER_LOST |
					1 << LW_LAUNCH_INHIBIT_NOT_TRACKING,
				status()->launch_inhibit);
	for (int i = 0; i < 5; i++) {
		ask(slave_now_us);
		slave_now_us += 1000000;
		rig_ticks(1001);
		TEST_ASSERT_FALSE(flag(LW_FLAG_MASTER_LOST));
	}
	rig_ticks(1);
	TEST_ASSERT_TRUE(flag(LW_FLAG_MASTER_LOST));
	TEST_ASSERT_EQUAL_UINT32(5, status()->requests);
}

static void test_status_while_tracking(void)
{
	track();
	TEST_ASSERT_TRUE(flag(LW_FLAG_LAUNCH_PERMIT));
	rig.drum_edges_per_s = 53000;
	rig_ticks(100);
	TEST_ASSERT_TRUE(flag(LW_FLAG_OVERSPEED_WARNING));
	TEST_ASSERT_EQUAL_INT32(53000, status()->drum_speed_edges_per_s);
	TEST_ASSERT_INT32_WITHIN(1, 53000 * 2400 / 2880, status()->rope_speed_mm_per_s);
	rig.drum_edges_per_s = -53000;
	rig_ticks(200);
	TEST_ASSERT_TRUE(flag(LW_FLAG_OVERSPEED_WARNING));
	TEST_ASSERT_INT32_WITHIN(1, -53000 * 2400 / 2880, status()->rope_speed_mm_per_s);
	rig.drum_edges_per_s = -20000;
	rig_ticks(100);
	TEST_ASSERT_FALSE(flag(LW_FLAG_OVERSPEED_WARNING));
	TEST_ASSERT_EQUAL_INT32(status()->net_edges * 2400 / 2880, status()->rope_mm);
	TEST_ASSERT_EQUAL_INT64(status()->net_edges, status()->pattern_edges);
	TEST_ASSERT_INT32_WITHIN(5, rig.carriage_usteps * 10, status()->position_um);
	TEST_ASSERT_TRUE(read_bit(LW_SPACE_DISCRETE, LW_FLAG_TRACKING));
	TEST_ASSERT_EQUAL_UINT32(rig.now_us / 1000, status()->uptime_ms);
}

/** As if that many edges had been counted: the upper half and the interrupt's counter. */
static void set_net_edges(int64_t net_edges)
{
	rig.controller->motion.net_edges = net_edges;
	rig.controller->motion.edges = (uint32_t)net_edges;
}

static void test_the_odometer_saturates(void)
{
	set_net_edges(INT64_MAX / 2);
	TEST_ASSERT_EQUAL_INT32(INT32_MAX, status()->rope_mm);
	set_net_edges(-(INT64_MAX / 2));
	TEST_ASSERT_EQUAL_INT32(INT32_MIN, status()->rope_mm);
	set_net_edges(-2880);
	TEST_ASSERT_EQUAL_INT32(-2400, status()->rope_mm);
}

static void test_real_hardware_wants_a_saved_set(void)
{
	struct lw_device_config hardware = *rig.device.config;

	hardware.host = LW_HOST_HARDWARE;
	rig.device.config = &hardware;
	TEST_ASSERT_TRUE(flag(LW_FLAG_SET_UNCONFIRMED));
	TEST_ASSERT_TRUE(status()->launch_inhibit >> LW_LAUNCH_INHIBIT_SET_UNCONFIRMED & 1);
	TEST_ASSERT_TRUE(read_bit(LW_SPACE_DISCRETE, LW_FLAG_SET_UNCONFIRMED));
	command(LW_COMMAND_SAVE);
	TEST_ASSERT_EQUAL_INT(0, rig_write_slot(0));
	TEST_ASSERT_FALSE(flag(LW_FLAG_SET_UNCONFIRMED));
	TEST_ASSERT_FALSE(status()->launch_inhibit >> LW_LAUNCH_INHIBIT_SET_UNCONFIRMED & 1);
	TEST_ASSERT_FALSE(read_bit(LW_SPACE_DISCRETE, LW_FLAG_SET_UNCONFIRMED));
}

/** Bytes of the memory that a table is about. */
static size_t image_size(const struct lw_point *points)
{
	return points == lw_map_coils || points == lw_map_discretes ||
			       points == &lw_map_discretes[32]
		       ? sizeof(uint32_t)
	       : points == lw_map_setpoints  ? sizeof(struct lw_setpoints)
	       : points == lw_map_params     ? sizeof(struct lw_params)
	       : points == lw_map_status     ? sizeof(struct lw_status)
	       : points == lw_map_cam_upload ? sizeof(struct lw_cam_upload)
	       : points == lw_map_bench      ? sizeof(struct lw_bench)
					     : 0;
}

static void check_point(const struct lw_bank_section *section, const struct lw_point *point)
{
	const size_t size = point->type == LW_TYPE_I64 ? sizeof(int64_t) : sizeof(int32_t);

	TEST_ASSERT_GREATER_THAN_UINT(0, point->count);
	TEST_ASSERT_EQUAL(section->space == LW_SPACE_COIL || section->space == LW_SPACE_DISCRETE,
			  point->type == LW_TYPE_BIT);
	if (point->type == LW_TYPE_BIT) {
		TEST_ASSERT_LESS_OR_EQUAL_UINT(32, point->offset + point->count);
	} else {
		TEST_ASSERT_TRUE(point->offset + size * point->count <=
				 image_size(section->points));
	}
}

/* What the proof of the bank (tests/proofs/bank.c) takes for granted. */
static void test_the_sections_are_as_the_bank_needs_them(void)
{
	static bool taken[LW_SPACE_INPUT + 1][UINT16_MAX + 1];
	struct lw_bank_section sections[LW_DEVICE_SECTIONS + 1];

	memset(taken, 0, sizeof(taken));
	TEST_ASSERT_EQUAL_UINT(LW_DEVICE_SECTIONS, rig.device.bank.section_count);
	memcpy(sections, rig.device.bank.sections, LW_DEVICE_SECTIONS * sizeof(sections[0]));
	sections[LW_DEVICE_SECTIONS] = (struct lw_bank_section){
		.space = LW_SPACE_HOLDING,
		.points = lw_map_bench,
		.point_count = LW_MAP_BENCH_COUNT,
	};
	for (size_t i = 0; i < LW_DEVICE_SECTIONS + 1; i++) {
		const struct lw_bank_section *section = &sections[i];
		uint32_t next = 0;

		TEST_ASSERT_TRUE(image_size(section->points) > 0);
		for (const struct lw_point *point = section->points;
		     point < section->points + section->point_count; point++) {
			const uint32_t first = (uint32_t)point->address + section->address_offset;
			const uint32_t width =
				point->type == LW_TYPE_I64                                 ? 4u
				: point->type == LW_TYPE_U32 || point->type == LW_TYPE_I32 ? 2u
											   : 1u;

			check_point(section, point);
			TEST_ASSERT_TRUE(first >= next);
			next = first + point->count * width;
			TEST_ASSERT_LESS_OR_EQUAL_UINT32(UINT16_MAX + 1u, next);
			for (uint32_t address = first; address < next; address++) {
				TEST_ASSERT_FALSE(taken[section->space][address]);
				taken[section->space][address] = true;
			}
		}
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_power_up_without_a_record);
	RUN_TEST(test_the_host_can_override_line_settings_and_add_registers);
	RUN_TEST(test_default_line_settings_do_not_touch_the_stored_ones);
	RUN_TEST(test_parameters_are_staged_then_applied);
	RUN_TEST(test_apply_refused_says_why_and_changes_nothing);
	RUN_TEST(test_apply_of_the_decoding_waits_for_the_drum_to_rest);
	RUN_TEST(test_a_set_is_accepted_until_it_is_another_one);
	RUN_TEST(test_an_accepted_set_outlasts_a_power_cut);
	RUN_TEST(test_apply_keeps_the_index_if_no_parameter_needs_it);
	RUN_TEST(test_apply_turns_the_encoder_without_a_false_edge);
	RUN_TEST(test_apply_of_another_contact_type_sees_a_switch_that_is_held);
	RUN_TEST(test_parameters_are_refused_while_tracking_and_commands_while_moving);
	RUN_TEST(test_factory_by_scope);
	RUN_TEST(test_index_command_ends_done_faulted_or_stopped);
	RUN_TEST(test_index_is_refused_with_a_turning_drum_and_stop_never);
	RUN_TEST(test_command_none_does_nothing);
	RUN_TEST(test_coils_run_commands);
	RUN_TEST(test_jog_by_coil_and_by_register);
	RUN_TEST(test_mode_by_register);
	RUN_TEST(test_trim_by_register);
	RUN_TEST(test_a_request_gives_one_order);
	RUN_TEST(test_master_lost);
	RUN_TEST(test_status_while_tracking);
	RUN_TEST(test_the_odometer_saturates);
	RUN_TEST(test_real_hardware_wants_a_saved_set);
	RUN_TEST(test_the_sections_are_as_the_bank_needs_them);
	return UNITY_END();
}
