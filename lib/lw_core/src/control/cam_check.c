/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/control/cam_check.h"

#include <errno.h>
#include <stdbool.h>

#include "lw/control/params_units.h"
#include "params_check.h"

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
		return lw_cam_refuse(why, LW_REASON_CAM_CRC, 0, (int32_t)bank->crc, (int32_t)crc);
	}
	if (lw_cam_table_check(&bank->table, &scale, &limits, &found, why)) {
		return -EINVAL;
	}
	if (params->cam_axis == LW_CAM_AXIS_CARRIAGE && bank->table.advance != 0) {
		return lw_cam_refuse(why, LW_REASON_CAM_ADVANCES, bank->table.row_count,
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
	const int32_t most = plus < LW_POSITION_MAX_USTEPS ? plus : LW_POSITION_MAX_USTEPS;
	const int32_t least = minus > -LW_POSITION_MAX_USTEPS ? minus : -LW_POSITION_MAX_USTEPS;
	const int64_t max = statistics->max_usteps + shift_usteps;
	const int64_t min = statistics->min_usteps + shift_usteps;

	if (params->cam_axis == LW_CAM_AXIS_FREE) {
		return 0;
	}
	/* An extreme of 32 bits may stand for more. */
	if (max > most || statistics->max_usteps == INT32_MAX) {
		return lw_cam_refuse(why, LW_REASON_CAM_BEYOND_FLANGE, row_at(bank, true), max,
				     most);
	}
	if (min < least || statistics->min_usteps == INT32_MIN) {
		return lw_cam_refuse(why, LW_REASON_CAM_BEYOND_FLANGE, row_at(bank, false), min,
				     least);
	}
	return 0;
}
