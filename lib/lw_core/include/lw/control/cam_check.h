/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Does a cam table fit a parameter set? The table alone is checked by lw/cam/cam_table.h. Not for
 * interrupt context.
 */
#ifndef LW_CAM_CHECK_H
#define LW_CAM_CHECK_H

#include <stdint.h>

#include "lw/cam/cam_banks.h"
#include "lw/map.h"

/** How tables are followed under a parameter set. */
struct lw_cam_scale lw_cam_params_scale(const struct lw_params *params);

/**
 * Check what a bank holds against its CRC and a parameter set.
 *
 * @param statistics receives numbers about the table if it is accepted
 * @retval 0 it may be followed
 * @retval -EINVAL not; `why` says why
 */
int lw_cam_bank_check(const struct lw_cam_bank *bank, const struct lw_params *params,
		      struct lw_cam_statistics *statistics, struct lw_cam_refusal *why);

/**
 * Do all positions of a table, shifted, lie between the flanges?
 *
 * @param statistics of the table
 * @retval 0 yes, or the axis is free
 * @retval -EINVAL not; `why` says why
 */
int lw_cam_bank_check_flanges(const struct lw_cam_bank *bank,
			      const struct lw_cam_statistics *statistics,
			      const struct lw_params *params, int64_t shift_usteps,
			      struct lw_cam_refusal *why);

#endif /* LW_CAM_CHECK_H */
