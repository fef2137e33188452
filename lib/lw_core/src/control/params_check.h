/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The rules that a whole parameter set must satisfy, beside the limits of each register: what
 * params.c derives is checked here. Every rule names the register to change and its limit.
 */
#ifndef LW_PARAMS_CHECK_H
#define LW_PARAMS_CHECK_H

#include "lw/control/params.h"

/** Largest position that a motion may reach: leaves a slope's worth of room below int16. */
#define LW_POSITION_MAX_USTEPS 32700

/**
 * Can every position be expressed in the law's numbers at all? Before any is compared in
 * microsteps.
 *
 * @retval 0 yes
 * @retval -EINVAL no; `why` says why
 */
int lw_params_check_positions(const struct lw_params *params, struct lw_refusal *why);

/**
 * The rules that bind reversal points, switches and flanges; also for a trim.
 *
 * @retval 0 accepted
 * @retval -EINVAL refused; `why` says why
 */
int lw_params_check_geometry(const struct lw_params *params, const struct lw_derived *derived,
			     struct lw_refusal *why);

/**
 * All rules, those of the geometry first.
 *
 * @param derived everything that follows from `params`
 * @retval 0 accepted
 * @retval -EINVAL refused; `why` says why
 */
int lw_params_check(const struct lw_params *params, const struct lw_derived *derived,
		    struct lw_refusal *why);

#endif /* LW_PARAMS_CHECK_H */
