/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The screw's units: micrometres to microsteps and back. Not for interrupt context.
 */
#ifndef LW_PARAMS_UNITS_H
#define LW_PARAMS_UNITS_H

#include <stdint.h>

#include "lw/map.h"

/** Micrometres to whole microsteps, to nearest. */
int32_t lw_params_um_to_usteps(const struct lw_params *params, int32_t um);

/** A Q16.16 position in microsteps to micrometres, to nearest. */
int32_t lw_params_q16_to_um(const struct lw_params *params, int64_t q16);

#endif /* LW_PARAMS_UNITS_H */
