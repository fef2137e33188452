#include "lw/cam_banks.h"

#include <errno.h>

/** Largest position in the fraction format of lw/law.h, with room for the screw's moves. */
#define POSITION_MAX_USTEPS 32700

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

static int32_t clamp32(int64_t value)
{
	return value > INT32_MAX ? INT32_MAX : value < INT32_MIN ? INT32_MIN : (int32_t)value;
}

static int refuse(struct lw_cam_refusal *why, enum lw_reason reason, unsigned int row,
		  int64_t value, int64_t limit)
{
	*why = (struct lw_cam_refusal){
		.reason = (uint16_t)reason,
		.row = (uint16_t)row,
		.value = clamp32(value),
		.limit = clamp32(limit),
	};
	return -EINVAL;
}

struct lw_cam_scale lw_cam_params_scale(const struct lw_params *params)
{
	return lw_cam_scale(params->cam_master_edges, params->cam_master_units,
			    params->cam_slave_usteps, params->cam_slave_units,
			    params->cam_ramp_divisor);
}

int lw_cam_bank_check(const struct lw_cam_bank *bank, const struct lw_params *params,
		      struct lw_cam_statistics *statistics, struct lw_cam_refusal *why)
{
	struct lw_cam_statistics found;
	const struct lw_cam_scale scale = lw_cam_params_scale(params);
	const struct lw_cam_limits limits = {
		.top_edges_per_s = params->overspeed_trip_edges_per_s,
		.steps_per_s_max = params->cam_steps_per_s_max,
	};
	const uint32_t crc = lw_cam_bank_crc(bank);

	/* More rows than fit were not uploaded, so there is no CRC of them: refused below. */
	if (bank->table.row_count <= LW_CAM_ROWS_MAX && crc != bank->crc) {
		return refuse(why, LW_REASON_CAM_CRC, 0, (int32_t)bank->crc, (int32_t)crc);
	}
	if (lw_cam_table_check(&bank->table, &scale, &limits, &found, why)) {
		return -EINVAL;
	}
	if (params->cam_axis == LW_CAM_AXIS_CARRIAGE && bank->table.advance != 0) {
		return refuse(why, LW_REASON_CAM_ADVANCES, bank->table.row_count,
			      bank->table.advance, 0);
	}
	/* A relative start is not known before it is made. */
	if (params->cam_start != LW_CAM_START_RELATIVE &&
	    lw_cam_bank_check_flanges(bank, &found, params, 0, why)) {
		return -EINVAL;
	}
	*statistics = found;
	return 0;
}

/** The row that lies at an extreme, from 1. */
static unsigned int row_at(const struct lw_cam_bank *bank, bool highest)
{
	unsigned int found = 0;

	for (unsigned int i = 1; i < bank->table.row_count; i++) {
		const int32_t slave = bank->table.rows[i].slave;
		const int32_t extreme = bank->table.rows[found].slave;

		if (highest ? slave > extreme : slave < extreme) {
			found = i;
		}
	}
	return found + 1;
}

int lw_cam_bank_check_flanges(const struct lw_cam_bank *bank,
			      const struct lw_cam_statistics *statistics,
			      const struct lw_params *params, int64_t shift_usteps,
			      struct lw_cam_refusal *why)
{
	const int32_t plus = lw_params_um_to_usteps(params, params->flange_plus_um);
	const int32_t minus = lw_params_um_to_usteps(params, params->flange_minus_um);
	const int32_t most = plus < POSITION_MAX_USTEPS ? plus : POSITION_MAX_USTEPS;
	const int32_t least = minus > -POSITION_MAX_USTEPS ? minus : -POSITION_MAX_USTEPS;
	const int64_t max = statistics->max_usteps + shift_usteps;
	const int64_t min = statistics->min_usteps + shift_usteps;

	if (params->cam_axis == LW_CAM_AXIS_FREE) {
		return 0;
	}
	/* An extreme of 32 bits may stand for more. */
	if (max > most || statistics->max_usteps == INT32_MAX) {
		return refuse(why, LW_REASON_CAM_BEYOND_FLANGE, row_at(bank, true), max, most);
	}
	if (min < least || statistics->min_usteps == INT32_MIN) {
		return refuse(why, LW_REASON_CAM_BEYOND_FLANGE, row_at(bank, false), min, least);
	}
	return 0;
}

uint32_t lw_cam_bank_crc(const struct lw_cam_bank *bank)
{
	const unsigned int words = lw_cam_bank_words(bank);
	uint32_t crc = 0xFFFFFFFFu;

	for (unsigned int i = 0; i < words; i++) {
		if (i == LW_CAM_CRC_WORD || i == LW_CAM_CRC_WORD + 1) {
			continue;
		}
		crc ^= __builtin_bswap16(lw_cam_bank_get(bank, i));
		for (int bit = 0; bit < 16; bit++) {
			crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
		}
	}
	return ~crc;
}
