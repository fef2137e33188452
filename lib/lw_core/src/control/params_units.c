/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/control/params_units.h"

#include "lw/bytes/numbers.h"
#include "lw/motion/law.h"

int32_t lw_params_um_to_usteps(const struct lw_params *params, int32_t um)
{
	return (int32_t)lw_divide_nearest((int64_t)um * params->microsteps_per_rev,
					  (int64_t)params->screw_lead_um);
}

int32_t lw_params_q16_to_um(const struct lw_params *params, int64_t q16)
{
	return (int32_t)lw_divide_nearest(q16 * (int64_t)params->screw_lead_um,
					  (int64_t)params->microsteps_per_rev * LW_USTEP);
}
