/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/cam/cam_banks.h"

#include <stdbool.h>

#include "lw/bytes/big_endian.h"
#include "lw/bytes/crc32.h"
#include "lw/bytes/require.h"

/** Places in the head. */
enum {
	WORD_VERSION = 8,
	WORD_INTERPOLATION = 10,
	WORD_ROW_COUNT = 11,
	WORD_ADVANCE = 12,
};

static uint16_t half(uint32_t value, bool low)
{
	return (uint16_t)(low ? value : value >> 16);
}

static uint32_t with_half(uint32_t value, bool low, uint16_t word)
{
	return low ? (value & 0xFFFF0000u) | word : (value & 0xFFFFu) | (uint32_t)word << 16;
}

uint16_t lw_cam_bank_get(const struct lw_cam_bank *bank, unsigned int index)
{
	LW_REQUIRE(index < LW_CAM_WORDS);
	const struct lw_cam_table *table = &bank->table;
	const bool low = index & 1;

	if (index >= LW_CAM_HEAD_WORDS) {
		const unsigned int at = index - LW_CAM_HEAD_WORDS;
		const struct lw_cam_row *row = &table->rows[at / LW_CAM_ROW_WORDS];

		return half((uint32_t)(at & 2 ? row->slave : row->master), low);
	}
	if (index < WORD_VERSION) {
		return (uint16_t)((uint8_t)table->name[2 * index] << 8 |
				  (uint8_t)table->name[2 * index + 1]);
	}
	switch (index & ~1u) {
	case WORD_VERSION:
		return half(table->version, low);
	case WORD_INTERPOLATION:
		return low ? table->row_count : table->interpolation;
	case WORD_ADVANCE:
		return half((uint32_t)table->advance, low);
	default:
		return half(bank->crc, low);
	}
}

void lw_cam_bank_put(struct lw_cam_bank *bank, unsigned int index, uint16_t word)
{
	LW_REQUIRE(index < LW_CAM_WORDS && bank->state != LW_CAM_BANK_STATE_ACTIVE &&
		   bank->state != LW_CAM_BANK_STATE_QUEUED);
	struct lw_cam_table *table = &bank->table;
	const bool low = index & 1;

	bank->state = LW_CAM_BANK_STATE_LOADING;
	if (index >= LW_CAM_HEAD_WORDS) {
		const unsigned int at = index - LW_CAM_HEAD_WORDS;
		struct lw_cam_row *row = &table->rows[at / LW_CAM_ROW_WORDS];
		int32_t *value = at & 2 ? &row->slave : &row->master;

		*value = (int32_t)with_half((uint32_t)*value, low, word);
		return;
	}
	if (index < WORD_VERSION) {
		table->name[2 * index] = (char)(word >> 8);
		table->name[2 * index + 1] = (char)word;
		return;
	}
	switch (index & ~1u) {
	case WORD_VERSION:
		table->version = with_half(table->version, low, word);
		break;
	case WORD_INTERPOLATION:
		*(low ? &table->row_count : &table->interpolation) = word;
		break;
	case WORD_ADVANCE:
		table->advance = (int32_t)with_half((uint32_t)table->advance, low, word);
		break;
	default:
		bank->crc = with_half(bank->crc, low, word);
		break;
	}
}

uint32_t lw_cam_bank_crc(const struct lw_cam_bank *bank)
{
	const unsigned int words = lw_cam_bank_words(bank);
	uint32_t crc = 0;

	for (unsigned int i = 0; i < words; i++) {
		uint8_t word[2];

		if (i == LW_CAM_CRC_WORD || i == LW_CAM_CRC_WORD + 1) {
			continue;
		}
		(void)lw_put16(word, lw_cam_bank_get(bank, i));
		crc = lw_crc32_add(crc, word, sizeof(word));
	}
	return crc;
}
