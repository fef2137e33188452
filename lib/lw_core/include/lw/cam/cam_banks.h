/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The two banks of cam tables: one is in force, the other takes an upload word by word, is checked
 * as a whole and waits until it is put in force. Not for interrupt context.
 *
 * A bank is a row of 16-bit words, the same by file records, by registers and in the storage:
 *
 *     0..7 name   8, 9 version   10 interpolation   11 row count   12, 13 advance   14, 15 CRC-32
 *     16 + 4 * row: master, slave of each row
 *
 * 32-bit values high word first. The CRC is that of zip, over all words but its own that the row
 * count names, high byte first.
 */
#ifndef LW_CAM_BANKS_H
#define LW_CAM_BANKS_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/cam/cam_table.h"

enum {
	LW_CAM_BANKS = 2,
	LW_CAM_HEAD_WORDS = 16,
	LW_CAM_ROW_WORDS = 4,
	LW_CAM_CRC_WORD = 14,
	LW_CAM_WORDS = LW_CAM_HEAD_WORDS + LW_CAM_ROW_WORDS * LW_CAM_ROWS_MAX,
};

/** One bank. `table` is unchanged while the edge interrupt may use it. */
struct lw_cam_bank {
	struct lw_cam_table table;
	uint32_t crc; /**< as uploaded */
	enum lw_cam_bank_state state;
	struct lw_cam_statistics statistics; /**< if ready, queued or active */
};

/** Words of a bank that its row count names. */
static inline uint16_t lw_cam_bank_words(const struct lw_cam_bank *bank)
{
	const unsigned int rows = bank->table.row_count;

	return (uint16_t)(LW_CAM_HEAD_WORDS +
			  LW_CAM_ROW_WORDS * (rows < LW_CAM_ROWS_MAX ? rows : LW_CAM_ROWS_MAX));
}

/** One word, `index` below LW_CAM_WORDS. */
uint16_t lw_cam_bank_get(const struct lw_cam_bank *bank, unsigned int index);

/** Write one word. The bank is loading from then on: it must not be in force or queued. */
void lw_cam_bank_put(struct lw_cam_bank *bank, unsigned int index, uint16_t word);

/** The CRC-32 of what a bank holds. */
uint32_t lw_cam_bank_crc(const struct lw_cam_bank *bank);

#endif /* LW_CAM_BANKS_H */
