/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Cam tables for a device on the rig's pins: uploads by FC21, as a master makes them.
 */
#ifndef CAM_RIG_H
#define CAM_RIG_H

#include <string.h>

#include "device_rig.h"

/** A linear cyclic table of these rows, an array. */
#define CAM_TABLE(rows_) cam_table(rows_, sizeof(rows_) / sizeof((rows_)[0]))

static inline struct lw_cam_table cam_table(const struct lw_cam_row *rows, size_t count)
{
	struct lw_cam_table table = {.row_count = (uint16_t)count};

	memcpy(table.rows, rows, count * sizeof(*rows));
	return table;
}

/** A table that is followed, first above and then below its begin. */
static inline struct lw_cam_table cam_hill(void)
{
	return (struct lw_cam_table){
		.version = 7,
		.row_count = 4,
		.rows = {{0, 0}, {1000, 1500}, {3000, -500}, {4000, 0}},
	};
}

/** Another, of half its length, below its begin. */
static inline struct lw_cam_table cam_pit(void)
{
	return (struct lw_cam_table){.row_count = 3, .rows = {{0, 0}, {500, -900}, {2000, 0}}};
}

/** What a table is as the words of a bank, its CRC with them. */
static inline struct lw_cam_bank cam_bank(struct lw_cam_table table)
{
	struct lw_cam_bank bank = {.table = table};

	bank.crc = lw_cam_bank_crc(&bank);
	return bank;
}

/** Write words of a bank by FC21. @return the answer's exception code, or 0 */
static inline uint8_t write_words(uint16_t file, const struct lw_cam_bank *bank, unsigned int first,
				  unsigned int count)
{
	uint8_t request[LW_PDU_MAX] = {21,
				       (uint8_t)(7 + 2 * count),
				       6,
				       0,
				       (uint8_t)file,
				       (uint8_t)(first >> 8),
				       (uint8_t)first,
				       0,
				       (uint8_t)count};
	uint8_t response[LW_PDU_MAX];
	size_t length = 9;

	for (unsigned int i = first; i < first + count; i++) {
		const uint16_t word = i < LW_CAM_WORDS ? lw_cam_bank_get(bank, i) : 0;

		request[length++] = (uint8_t)(word >> 8);
		request[length++] = (uint8_t)word;
	}
	length = lw_pdu_handle(&rig.device.slave.pdu, request, length, response);
	TEST_ASSERT_GREATER_THAN_UINT(1, length);
	return response[0] & 0x80 ? response[1] : 0;
}

/** Write a whole bank, in requests as long as they may be. */
static inline void upload(uint16_t file, const struct lw_cam_bank *bank)
{
	const unsigned int words = lw_cam_bank_words(bank);

	for (unsigned int at = 0; at < words; at += 120) {
		TEST_ASSERT_EQUAL_UINT8(
			0, write_words(file, bank, at, words - at < 120 ? words - at : 120));
	}
}

/** The file that an upload goes to: the bank that is not in force. */
static inline uint16_t next_file(void)
{
	return LW_DEVICE_CAM_FILE +
	       (status()->cam_bank_0_state == LW_CAM_BANK_STATE_ACTIVE ? 1 : 0);
}

static inline void assert_banks(enum lw_cam_bank_state first, enum lw_cam_bank_state second)
{
	TEST_ASSERT_EQUAL_INT32(first, status()->cam_bank_0_state);
	TEST_ASSERT_EQUAL_INT32(second, status()->cam_bank_1_state);
}

/** Upload a table and have it checked; it is accepted. */
static inline void check_in(struct lw_cam_table table)
{
	const struct lw_cam_bank bank = cam_bank(table);

	upload(next_file(), &bank);
	command(LW_COMMAND_CAM_CHECK);
	assert_command(LW_COMMAND_CAM_CHECK, LW_RESULT_DONE, LW_REASON_NONE);
}

static inline void put_in_force(struct lw_cam_table table)
{
	check_in(table);
	command(LW_COMMAND_CAM_ACTIVATE);
	assert_command(LW_COMMAND_CAM_ACTIVATE, LW_RESULT_DONE, LW_REASON_NONE);
}

/** Choose the profile, and whatever else is staged. */
static inline void use_cam(enum lw_cam_start start, enum lw_cam_axis axis)
{
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MOTION_PROFILE, LW_MOTION_PROFILE_CAM));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_START, (int32_t)start));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_AXIS, (int32_t)axis));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);
}

#endif /* CAM_RIG_H */
