/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * From millimetres to the numbers that the law works with, and the check of a whole parameter set.
 *
 * The parameters themselves (struct lw_params), their limits and the reasons for refusal are
 * generated from modbus_map/registers.yaml. Not for interrupt context.
 */
#ifndef LW_PARAMS_H
#define LW_PARAMS_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/control/limit_switch.h"
#include "lw/control/rope_length.h"
#include "lw/control/params_units.h"
#include "lw/map.h"
#include "lw/map/refusal.h"
#include "lw/motion/law.h"
#include "lw/motion/quadrature.h"

/** Index of a side of the drum in arrays of two; the values of enum lw_side. */
enum {
	LW_PLUS = LW_SIDE_PLUS,
	LW_MINUS = LW_SIDE_MINUS,
};

/** Carriage direction toward a side: +1 for plus, -1 for minus. */
static inline int lw_side_direction(int side)
{
	return side == LW_PLUS ? 1 : -1;
}

/** What follows from a parameter set. Positions in whole microsteps unless the name says else. */
struct lw_derived {
	int32_t ka;                    /**< Q16.16 */
	int32_t nr;                    /**< edges */
	int32_t ks;                    /**< Q16.16, ka * nr */
	int32_t reversal_plus_usteps;  /**< L+ */
	int32_t reversal_minus_usteps; /**< L- */
	int32_t overshoot_q16; /**< Ks * (Nr - 1) / 2, how far a reversal runs past its entry */
	int32_t overshoot_um;
	int32_t slope_error_ppm;    /**< residual: (Ks - ideal) / ideal */
	int32_t overshoot_error_um; /**< residual: overshoot - asked for */
	uint32_t edges_per_1000_drum_revs;
	uint32_t dwell_plus_edges;
	uint32_t dwell_minus_edges;
	uint32_t breaker_edges;   /**< most that the ribbon breaker adds to a dwell; 0: off */
	uint32_t breaker_cycles;  /**< reversals of a side from 0 to there and back; 0: off */
	int32_t switch_usteps[2]; /**< calibrated trigger positions, plus and minus */
	int32_t switch_tolerance_usteps;
	int32_t switch_hysteresis_usteps;
	int32_t span_tolerance_usteps;
	int32_t travel_usteps;
	int32_t park_usteps;
	int32_t centre_usteps;
};

/**
 * Derive and check a whole parameter set.
 *
 * Ka and Nr are chosen so that Ka * Nr meets the pitch within slope_tolerance_ppm and
 * Ks * (Nr - 1) / 2 comes nearest to the overshoot (doc/control-law.md section 4); in expert mode
 * the raw values are taken instead. An accepted set never overflows the law, never asks for more
 * than one step per edge and never commands the carriage past a flange.
 *
 * @param params every value within the limits of its register
 * @param derived receives the result; unchanged on refusal
 * @param why receives reason, holding register, value and limit on refusal
 * @retval 0 accepted
 * @retval -EINVAL refused
 */
int lw_params_derive(const struct lw_params *params, struct lw_derived *derived,
		     struct lw_refusal *why);

/**
 * Check a live trim of the reversal points against the same rules.
 *
 * @retval 0 accepted
 * @retval -EINVAL refused; `why` as by lw_params_derive()
 */
int lw_params_check_trim(const struct lw_params *params, const struct lw_derived *derived,
			 int32_t trim_plus_um, int32_t trim_minus_um, struct lw_refusal *why);

/** The window for the law, with the reversal points shifted by a trim. */
struct lw_law_window lw_params_window(const struct lw_params *params,
				      const struct lw_derived *derived, int32_t trim_plus_um,
				      int32_t trim_minus_um);

/** From the far point of one reversal to that of the other, without a trim, micrometres. */
static inline int32_t lw_params_far_points_um(const struct lw_params *params,
					      const struct lw_derived *derived)
{
	const int64_t sweep_usteps =
		(int64_t)derived->reversal_plus_usteps - derived->reversal_minus_usteps;

	return lw_params_q16_to_um(params,
				   sweep_usteps * LW_USTEP + 2 * (int64_t)derived->overshoot_q16);
}

/** Drum and rope under this set; `core_um_q16` is 0 where they are not known. */
struct lw_rope_geometry lw_params_rope(const struct lw_params *params,
				       const struct lw_derived *derived);

/** How the encoder is read under this set. */
struct lw_quadrature_config lw_params_quadrature(const struct lw_params *params);

/** How the limit switches are debounced under this set. */
struct lw_limit_switch_config lw_params_limit_switch(const struct lw_params *params);

/** Largest number that names a set: below any limit of a signed register pair. */
#define LW_PARAMS_CRC_MAX 0x3FFFFFFFu

/**
 * A number that names a set by its values: of the CRC-32 over register address (16 bit) and value
 * (32 bit) of each parameter, high byte first, by rising address, the remainder by
 * LW_PARAMS_CRC_MAX, plus 1. Left out are the line's settings, secrets, and accepted_crc itself:
 * none of them changes what the carriage does, and a reader of the registers can work it out.
 *
 * @return 1 to LW_PARAMS_CRC_MAX
 */
uint32_t lw_params_crc(const struct lw_params *params);

/** True if going from one set to the other makes the index invalid. */
bool lw_params_need_index(const struct lw_params *from, const struct lw_params *to);

#endif /* LW_PARAMS_H */
