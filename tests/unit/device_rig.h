/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A whole device on the rig's pins, and its registers.
 */
#ifndef DEVICE_RIG_H
#define DEVICE_RIG_H

#include <errno.h>

#include "rig.h"

static struct lw_refusal why;
static struct lw_device_config config = {.host = LW_HOST_SIMULATOR, .store = &rig.store};

/** Power up with this record in the first slot of the parameters. */
static inline void power_up(const uint8_t *record, size_t length)
{
	const struct lw_inputs inputs = rig_inputs();

	lw_store_init(&rig.store);
	lw_store_load(&rig.store, LW_STORE_PARAMS, record, length);
	lw_device_init(&rig.device, &config, &inputs, rig.now_us, rig.now_us);
	rig.controller = &rig.device.controller;
	rig.with_device = true;
	rig_ticks(300);
}

static inline const struct lw_status *status(void)
{
	lw_device_refresh_status(&rig.device);
	return &rig.device.status_image;
}

static inline bool flag(enum lw_flag bit)
{
	const struct lw_status *now = status();

	return (bit < 32 ? now->flags >> bit : now->flags_2 >> (bit - 32)) & 1;
}

static inline int write_register(uint16_t address, int32_t value)
{
	const uint8_t in[2] = {(uint8_t)((uint32_t)value >> 8), (uint8_t)value};

	return lw_bank_write_registers(&rig.device.bank, address, 1, in, &why);
}

static inline int write_pair(uint16_t address, int32_t value)
{
	const uint8_t in[4] = {(uint8_t)((uint32_t)value >> 24), (uint8_t)((uint32_t)value >> 16),
			       (uint8_t)((uint32_t)value >> 8), (uint8_t)value};

	return lw_bank_write_registers(&rig.device.bank, address, 2, in, &why);
}

static inline int32_t read_register(enum lw_space space, uint16_t address)
{
	uint8_t out[2];

	TEST_ASSERT_EQUAL_INT(
		0, lw_bank_read_registers(&rig.device.bank, space, address, 1, out, &why));
	return out[0] << 8 | out[1];
}

static inline int write_coil(uint16_t address, bool on)
{
	const uint8_t in = on;

	return lw_bank_write_bits(&rig.device.bank, address, 1, &in, &why);
}

static inline bool read_bit(enum lw_space space, uint16_t address)
{
	uint8_t out;

	TEST_ASSERT_EQUAL_INT(0,
			      lw_bank_read_bits(&rig.device.bank, space, address, 1, &out, &why));
	return out & 1;
}

static inline void assert_command(enum lw_command code, enum lw_result result,
				  enum lw_reason reason)
{
	TEST_ASSERT_EQUAL_INT32(code, status()->command_code);
	TEST_ASSERT_EQUAL_INT32(result, status()->command_result);
	TEST_ASSERT_EQUAL_INT32(reason, status()->command_reason);
}

/** Give a command by its register; it is accepted and counted. */
static inline void command(enum lw_command code)
{
	const int32_t sequence = status()->command_sequence;

	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_COMMAND, (int32_t)code));
	TEST_ASSERT_EQUAL_INT32(sequence + 1, status()->command_sequence);
	TEST_ASSERT_EQUAL_INT32(code, read_register(LW_SPACE_HOLDING, LW_ADDRESS_COMMAND));
}

static inline void assert_command_refused(enum lw_command code, enum lw_reason reason)
{
	const int32_t sequence = status()->command_sequence;

	TEST_ASSERT_EQUAL_INT(-EBUSY, write_register(LW_ADDRESS_COMMAND, (int32_t)code));
	TEST_ASSERT_EQUAL_UINT16(reason, why.reason);
	TEST_ASSERT_EQUAL_INT32(sequence + 1, status()->command_sequence);
	assert_command(code, LW_RESULT_REFUSED, reason);
}

static inline void track(void)
{
	command(LW_COMMAND_INDEX);
	rig_run_to(LW_STATE_TRACKING);
}

#endif /* DEVICE_RIG_H */
