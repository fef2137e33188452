/* SPDX-License-Identifier: Apache-2.0 */
/* Line settings on trial: everything over the slave's line, as a master sees it. */
#include <string.h>

#include <unity.h>

#include "lw/modbus/rtu.h"
#include "rig.h"

#define OLD_UNIT  1
#define NEW_UNIT  17
#define CONFIRM_S 10 /* default of line_confirm_s */

#define BYTES(...) (const uint8_t[]){__VA_ARGS__}, sizeof((const uint8_t[]){__VA_ARGS__})

static const struct lw_device_config config = {.host = LW_HOST_SIMULATOR, .store = &rig.store};
static uint8_t answer[LW_RTU_FRAME_MAX];

void setUp(void)
{
	const struct lw_inputs inputs = rig_inputs();

	rig_prepare(0);
	lw_device_init(&rig.device, &config, &inputs, rig.now_us, rig.now_us);
	rig.controller = &rig.device.controller;
	rig.with_device = true;
	rig_ticks(300);
}

void tearDown(void)
{
}

/** Send a request to a unit. @return bytes of the answer, in `answer` */
static size_t ask(uint8_t unit, const uint8_t *pdu, size_t length)
{
	uint8_t frame[LW_RTU_FRAME_MAX];

	frame[0] = unit;
	memcpy(&frame[1], pdu, length);
	lw_slave_receive(&rig.device.slave, frame, lw_rtu_seal(frame, 1 + length), rig.now_us);
	rig_ticks(10);
	return lw_slave_poll(&rig.device.slave, rig.now_us, answer);
}

static bool is_answered(uint8_t unit)
{
	return ask(unit, BYTES(4, 0, 0, 0, 1)) > 0;
}

static void write(uint8_t unit, uint16_t address, uint16_t value)
{
	TEST_ASSERT_EQUAL_UINT(8, ask(unit, BYTES(6, (uint8_t)(address >> 8), (uint8_t)address,
						  (uint8_t)(value >> 8), (uint8_t)value)));
	TEST_ASSERT_EQUAL_HEX8(unit, answer[0]);
	TEST_ASSERT_EQUAL_HEX8(6, answer[1]); /* and no exception */
}

static void command(uint8_t unit, enum lw_command code)
{
	write(unit, LW_ADDRESS_COMMAND, (uint16_t)code);
}

static bool flag(enum lw_flag bit)
{
	lw_device_refresh_status(&rig.device);
	return rig.device.status_image.flags >> bit & 1;
}

static void begin_trial(void)
{
	write(OLD_UNIT, LW_ADDRESS_UNIT_ID, NEW_UNIT);
	TEST_ASSERT_EQUAL_UINT(8, ask(OLD_UNIT, BYTES(16, 0, LW_ADDRESS_BAUD_RATE, 0, 3, 6, 0, 0,
						      0x25, 0x80, 0, LW_LINE_FORMAT_8N2)));
	command(OLD_UNIT, LW_COMMAND_APPLY);
	TEST_ASSERT_EQUAL_UINT8(OLD_UNIT, rig.device.line.unit_id); /* not by APPLY */
	command(OLD_UNIT, LW_COMMAND_TRY_LINE);
	TEST_ASSERT_TRUE(flag(LW_FLAG_LINE_TRIAL));
	TEST_ASSERT_EQUAL_UINT8(LW_RESULT_IN_PROGRESS, rig.device.command.result);
}

static void assert_line(uint8_t unit_id, uint32_t baud_rate, enum lw_line_format format)
{
	TEST_ASSERT_EQUAL_UINT8(unit_id, rig.device.line.unit_id);
	TEST_ASSERT_EQUAL_UINT32(baud_rate, rig.device.line.baud_rate);
	TEST_ASSERT_EQUAL_INT(format, rig.device.line.format);
	TEST_ASSERT_EQUAL_UINT32(lw_rtu_silence_us(baud_rate),
				 rig.device.slave.rtu.config.silence_us);
}

static void test_a_request_at_the_new_settings_confirms(void)
{
	begin_trial();
	assert_line(NEW_UNIT, 9600, LW_LINE_FORMAT_8N2);
	TEST_ASSERT_FALSE(flag(LW_FLAG_RESTART_NEEDED));
	TEST_ASSERT_TRUE(is_answered(NEW_UNIT));
	rig_ticks(1);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LINE_TRIAL));
	TEST_ASSERT_EQUAL_UINT8(LW_RESULT_DONE, rig.device.command.result);
	rig_ticks(2 * CONFIRM_S * 1000);
	assert_line(NEW_UNIT, 9600, LW_LINE_FORMAT_8N2);
	command(NEW_UNIT, LW_COMMAND_SAVE);
	rig_write_slot(0);
	TEST_ASSERT_EQUAL_INT32(NEW_UNIT, rig.store.params.unit_id);
	TEST_ASSERT_FALSE(is_answered(OLD_UNIT));
}

static void test_without_a_request_the_old_settings_come_back(void)
{
	begin_trial();
	rig_ticks(CONFIRM_S * 1000 - 1);
	assert_line(NEW_UNIT, 9600, LW_LINE_FORMAT_8N2);
	rig_ticks(1);
	assert_line(OLD_UNIT, 19200, LW_LINE_FORMAT_8E1);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LINE_TRIAL));
	TEST_ASSERT_EQUAL_UINT8(LW_RESULT_FAILED, rig.device.command.result);
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_LINE_NOT_CONFIRMED, rig.device.command.why.reason);
	TEST_ASSERT_TRUE(is_answered(OLD_UNIT));
	TEST_ASSERT_FALSE(is_answered(NEW_UNIT));
	/* A SAVE now must not store them; they stand in the staged set for another try. */
	TEST_ASSERT_EQUAL_INT32(OLD_UNIT, rig.device.active.unit_id);
	TEST_ASSERT_EQUAL_UINT32(19200, rig.device.active.baud_rate);
	TEST_ASSERT_EQUAL_INT32(LW_LINE_FORMAT_8E1, rig.device.active.line_format);
	TEST_ASSERT_TRUE(flag(LW_FLAG_STAGED));
	TEST_ASSERT_FALSE(flag(LW_FLAG_RESTART_NEEDED));
	command(OLD_UNIT, LW_COMMAND_APPLY);
	command(OLD_UNIT, LW_COMMAND_TRY_LINE);
	TEST_ASSERT_TRUE(is_answered(NEW_UNIT));
}

static void test_what_does_not_confirm(void)
{
	uint8_t frame[] = {NEW_UNIT, 4, 0, 0, 0, 1, 0, 0}; /* a wrong CRC */

	begin_trial();
	TEST_ASSERT_FALSE(is_answered(OLD_UNIT));
	TEST_ASSERT_FALSE(is_answered(NEW_UNIT + 1));
	TEST_ASSERT_EQUAL_UINT(0, ask(0, BYTES(6, 0, LW_ADDRESS_MODE, 0, LW_MODE_TRACK)));
	lw_slave_receive(&rig.device.slave, frame, sizeof(frame), rig.now_us);
	rig_ticks(10);
	TEST_ASSERT_EQUAL_UINT(0, lw_slave_poll(&rig.device.slave, rig.now_us, answer));
	TEST_ASSERT_TRUE(flag(LW_FLAG_LINE_TRIAL));
	rig_ticks(CONFIRM_S * 1000);
	assert_line(OLD_UNIT, 19200, LW_LINE_FORMAT_8E1);
}

static void test_the_first_request_may_be_the_save(void)
{
	begin_trial();
	command(NEW_UNIT, LW_COMMAND_SAVE);
	rig_write_slot(0);
	TEST_ASSERT_EQUAL_INT32(NEW_UNIT, rig.store.params.unit_id);
	rig_ticks(2 * CONFIRM_S * 1000);
	assert_line(NEW_UNIT, 9600, LW_LINE_FORMAT_8N2);
	TEST_ASSERT_EQUAL_UINT8(LW_COMMAND_SAVE, rig.device.command.code);
	TEST_ASSERT_EQUAL_UINT8(LW_RESULT_DONE, rig.device.command.result);
}

static void test_a_broadcast_begins_a_trial_for_every_unit(void)
{
	write(OLD_UNIT, LW_ADDRESS_LINE_FORMAT, LW_LINE_FORMAT_8N1);
	command(OLD_UNIT, LW_COMMAND_APPLY);
	TEST_ASSERT_EQUAL_UINT(0, ask(0, BYTES(6, 0, LW_ADDRESS_COMMAND, 0, LW_COMMAND_TRY_LINE)));
	TEST_ASSERT_TRUE(flag(LW_FLAG_LINE_TRIAL));
	assert_line(OLD_UNIT, 19200, LW_LINE_FORMAT_8N1);
	TEST_ASSERT_TRUE(is_answered(OLD_UNIT));
	TEST_ASSERT_FALSE(flag(LW_FLAG_LINE_TRIAL));
}

static void test_refused_while_the_carriage_moves(void)
{
	command(OLD_UNIT, LW_COMMAND_INDEX);
	TEST_ASSERT_EQUAL_UINT(
		5, ask(OLD_UNIT, BYTES(6, 0, LW_ADDRESS_COMMAND, 0, LW_COMMAND_TRY_LINE)));
	TEST_ASSERT_EQUAL_HEX8(0x86, answer[1]);
	TEST_ASSERT_EQUAL_HEX8(6, answer[2]);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LINE_TRIAL));
}

static void test_a_power_cut_ends_a_trial(void)
{
	const struct lw_inputs inputs = rig_inputs();

	begin_trial();
	lw_device_init(&rig.device, &config, &inputs, rig.now_us, rig.now_us);
	TEST_ASSERT_FALSE(flag(LW_FLAG_LINE_TRIAL));
	assert_line(OLD_UNIT, 19200, LW_LINE_FORMAT_8E1);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_a_request_at_the_new_settings_confirms);
	RUN_TEST(test_without_a_request_the_old_settings_come_back);
	RUN_TEST(test_what_does_not_confirm);
	RUN_TEST(test_the_first_request_may_be_the_save);
	RUN_TEST(test_a_broadcast_begins_a_trial_for_every_unit);
	RUN_TEST(test_refused_while_the_carriage_moves);
	RUN_TEST(test_a_power_cut_ends_a_trial);
	return UNITY_END();
}
