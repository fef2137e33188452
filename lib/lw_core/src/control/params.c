/* SPDX-License-Identifier: Apache-2.0 */
#include "params_check.h"

#include <errno.h>
#include <stddef.h>
#include <string.h>

#include "lw/bytes/big_endian.h"
#include "lw/bytes/crc32.h"
#include "lw/bytes/numbers.h"
#include "lw/motion/move.h"

/** Used encoder edges per drum revolution, as the fraction num / den. */
static void edges_per_drum_rev(const struct lw_params *params, int64_t *num, int64_t *den)
{
	*num = (int64_t)params->encoder_pulses_per_rev * params->encoder_edges_per_pulse *
	       params->encoder_ratio_numerator;
	*den = params->encoder_ratio_denominator;
}

/**
 * The slope that the pitch asks for, Q32.32 / 65536: Q16.16 with 16 more fractional bits.
 * pitch / lead * microsteps / edges_per_drum_rev, all within the limits of their registers:
 * numerator < 4e17, denominator < 5e12.
 */
static int64_t ideal_slope_q32(const struct lw_params *params)
{
	int64_t edges_num;
	int64_t edges_den;

	edges_per_drum_rev(params, &edges_num, &edges_den);

	const int64_t num =
		(int64_t)params->pitch_um * params->microsteps_per_rev * edges_den * LW_USTEP;
	const int64_t den = (int64_t)params->screw_lead_um * edges_num;

	if (num / den > INT32_MAX) {
		return (int64_t)INT32_MAX * LW_USTEP; /* hopelessly steep, do not overflow */
	}
	return num / den * LW_USTEP + num % den * LW_USTEP / den;
}

/** The smallest pitch that asks for a slope of 1, rounded to nearest: ideal slope >= 1/2. */
static int64_t smallest_pitch_um(const struct lw_params *params)
{
	int64_t edges_num;
	int64_t edges_den;

	edges_per_drum_rev(params, &edges_num, &edges_den);

	const int64_t per_um = (int64_t)2 * LW_USTEP * params->microsteps_per_rev * edges_den;

	return ((int64_t)params->screw_lead_um * edges_num + per_um - 1) / per_um;
}

/**
 * The Ka whose product with `nr` is nearest to the ideal slope: ideal / (nr * 65536) to nearest.
 * All halved, so that it stays within 32 bit, which a controller divides in a few cycles: this
 * stands in the innermost loop below.
 */
static int64_t nearest_ka(uint32_t ideal_q32, uint32_t nr)
{
	return (ideal_q32 / 2 + nr * (LW_USTEP / 4)) / (nr * (LW_USTEP / 2));
}

/**
 * Choose Ka and Nr: of all pairs whose Ka * Nr meets the ideal slope within the tolerance, the one
 * whose Nr is nearest to the Nr that the overshoot asks for, 2 dP / Ks + 1.
 */
static int choose_slope(const struct lw_params *params, struct lw_derived *derived,
			struct lw_refusal *why)
{
	const int64_t ideal_q32 = ideal_slope_q32(params);
	const int64_t tolerance_q32 = ideal_q32 / 1000000 * params->slope_tolerance_ppm +
				      ideal_q32 % 1000000 * params->slope_tolerance_ppm / 1000000;
	const int64_t ideal = lw_divide_nearest(ideal_q32, LW_USTEP);

	if (ideal > LW_USTEP - 1) {
		return lw_refuse(why, -EINVAL, LW_REASON_SLOPE_ABOVE_ONE_STEP, LW_ADDRESS_PITCH_UM,
				 params->pitch_um,
				 (int64_t)params->pitch_um * (LW_USTEP - 1) / ideal);
	}
	if (ideal < 1) {
		return lw_refuse(why, -EINVAL, LW_REASON_SLOPE_TOO_SMALL, LW_ADDRESS_PITCH_UM,
				 params->pitch_um, smallest_pitch_um(params));
	}

	const int64_t overshoot_usteps_q16 = (int64_t)params->overshoot_um *
					     params->microsteps_per_rev * LW_USTEP /
					     params->screw_lead_um;
	const int64_t nr_wanted = 2 * overshoot_usteps_q16 / ideal + 1;

	/* With Nr = 1 every slope can be had: if the nearest one will not do, none will. */
	const int64_t rounding_q32 = ideal * LW_USTEP - ideal_q32;

	if ((rounding_q32 < 0 ? -rounding_q32 : rounding_q32) > tolerance_q32) {
		return lw_refuse(why, -EINVAL, LW_REASON_SLOPE_UNREACHABLE,
				 LW_ADDRESS_SLOPE_TOLERANCE_PPM, params->slope_tolerance_ppm,
				 lw_divide_nearest(1000000, 2 * ideal) + 1);
	}

	/* Beyond `ideal` edges Ka would be below 1. */
	const int64_t nr_start = nr_wanted < ideal ? nr_wanted : ideal;

	for (int64_t distance = 0;; distance++) {
		const int64_t candidates[2] = {nr_start - distance, nr_start + distance};

		for (int i = 0; i < 2; i++) {
			const int64_t nr = candidates[i];

			if (nr < 1 || nr > ideal) {
				continue;
			}

			const int64_t ka = nearest_ka((uint32_t)ideal_q32, (uint32_t)nr);
			const int64_t ks = ka * nr;
			const int64_t error_q32 = ks * LW_USTEP - ideal_q32;

			if (ks >= LW_USTEP ||
			    (error_q32 < 0 ? -error_q32 : error_q32) > tolerance_q32) {
				continue;
			}
			derived->ka = (int32_t)ka;
			derived->nr = (int32_t)nr;
			derived->slope_error_ppm =
				(int32_t)lw_divide_nearest(error_q32 * 1000000, ideal_q32);
			return 0;
		}
	}
}

/** L+ and L- of a set that may be trimmed. */
static void reversals(const struct lw_params *params, int32_t trim_plus_um, int32_t trim_minus_um,
		      int32_t *plus_usteps, int32_t *minus_usteps)
{
	if (params->expert_mode) {
		*plus_usteps = params->raw_reversal_plus_usteps +
			       lw_params_um_to_usteps(params, trim_plus_um);
		*minus_usteps = params->raw_reversal_minus_usteps +
				lw_params_um_to_usteps(params, trim_minus_um);
	} else {
		*plus_usteps =
			lw_params_um_to_usteps(params, params->reversal_plus_um + trim_plus_um);
		*minus_usteps =
			lw_params_um_to_usteps(params, params->reversal_minus_um + trim_minus_um);
	}
}

int lw_params_derive(const struct lw_params *params, struct lw_derived *derived,
		     struct lw_refusal *why)
{
	struct lw_derived result = {0};
	int64_t edges_num;
	int64_t edges_den;
	int ret;

	edges_per_drum_rev(params, &edges_num, &edges_den);
	if (edges_num < edges_den) {
		return lw_refuse(why, -EINVAL, LW_REASON_TOO_FEW_EDGES,
				 LW_ADDRESS_ENCODER_RATIO_DENOMINATOR, edges_den, edges_num);
	}
	result.edges_per_1000_drum_revs = (uint32_t)lw_divide_nearest(1000 * edges_num, edges_den);
	result.dwell_plus_edges = (uint32_t)lw_divide_nearest(
		edges_num * params->dwell_plus_millirev, edges_den * 1000);
	result.dwell_minus_edges = (uint32_t)lw_divide_nearest(
		edges_num * params->dwell_minus_millirev, edges_den * 1000);

	if (params->breaker_cycles > 0) {
		result.breaker_edges = (uint32_t)lw_divide_nearest(
			edges_num * params->breaker_millirev, edges_den * 1000);
	}
	result.breaker_cycles = result.breaker_edges > 0 ? (uint32_t)params->breaker_cycles : 0;

	if (params->expert_mode) {
		result.ka = params->raw_ka;
		result.nr = params->raw_nr;
		if ((int64_t)result.ka * result.nr >= LW_USTEP) {
			return lw_refuse(why, -EINVAL, LW_REASON_SLOPE_ABOVE_ONE_STEP,
					 LW_ADDRESS_RAW_NR, result.nr, (LW_USTEP - 1) / result.ka);
		}
	} else {
		ret = choose_slope(params, &result, why);
		if (ret) {
			return ret;
		}
	}
	result.ks = result.ka * result.nr;

	result.overshoot_q16 = (int32_t)lw_move_overshoot_q16(result.ka, result.nr);
	result.overshoot_um = lw_params_q16_to_um(params, result.overshoot_q16);
	result.overshoot_error_um =
		params->expert_mode ? 0 : result.overshoot_um - (int32_t)params->overshoot_um;

	/* Every position must fit before any is compared in microsteps. */
	ret = lw_params_check_positions(params, why);
	if (ret) {
		return ret;
	}
	reversals(params, 0, 0, &result.reversal_plus_usteps, &result.reversal_minus_usteps);
	result.switch_usteps[LW_PLUS] = lw_params_um_to_usteps(params, params->switch_plus_um);
	result.switch_usteps[LW_MINUS] = lw_params_um_to_usteps(params, params->switch_minus_um);
	result.switch_tolerance_usteps =
		lw_params_um_to_usteps(params, params->switch_tolerance_um);
	result.switch_hysteresis_usteps =
		lw_params_um_to_usteps(params, params->switch_hysteresis_um);
	result.span_tolerance_usteps = lw_params_um_to_usteps(params, params->span_tolerance_um);
	result.travel_usteps = lw_params_um_to_usteps(params, (int32_t)params->travel_um);
	result.park_usteps = lw_params_um_to_usteps(params, params->park_position_um);
	result.centre_usteps = lw_params_um_to_usteps(params, params->centre_position_um);

	ret = lw_params_check(params, &result, why);
	if (ret == 0) {
		*derived = result;
	}
	return ret;
}

int lw_params_check_trim(const struct lw_params *params, const struct lw_derived *derived,
			 int32_t trim_plus_um, int32_t trim_minus_um, struct lw_refusal *why)
{
	struct lw_derived trimmed = *derived;

	reversals(params, trim_plus_um, trim_minus_um, &trimmed.reversal_plus_usteps,
		  &trimmed.reversal_minus_usteps);
	return lw_params_check_geometry(params, &trimmed, why);
}

struct lw_law_window lw_params_window(const struct lw_params *params,
				      const struct lw_derived *derived, int32_t trim_plus_um,
				      int32_t trim_minus_um)
{
	int32_t plus_usteps;
	int32_t minus_usteps;

	reversals(params, trim_plus_um, trim_minus_um, &plus_usteps, &minus_usteps);
	return (struct lw_law_window){
		.ka = derived->ka,
		.ks = derived->ks,
		.sweep_begin = (minus_usteps + 1) * LW_USTEP,
		.sweep_end = plus_usteps * LW_USTEP,
		.dwell_plus_edges = derived->dwell_plus_edges,
		.dwell_minus_edges = derived->dwell_minus_edges,
		.breaker_edges = derived->breaker_edges,
		.breaker_cycles = derived->breaker_cycles,
	};
}

struct lw_rope_geometry lw_params_rope(const struct lw_params *params,
				       const struct lw_derived *derived)
{
	struct lw_rope_geometry geometry = {0};
	int64_t edges_num;
	int64_t edges_den;

	if (params->rope_diameter_um > 0 && params->drum_core_diameter_um > 0 &&
	    params->rope_packing_permille > 0) {
		geometry = lw_rope_geometry(params->drum_core_diameter_um, params->rope_diameter_um,
					    params->rope_packing_permille,
					    lw_params_far_points_um(params, derived));
	}
	edges_per_drum_rev(params, &edges_num, &edges_den);
	geometry.edges = (int32_t)edges_num;
	geometry.revs = (int32_t)edges_den;
	return geometry;
}

struct lw_quadrature_config lw_params_quadrature(const struct lw_params *params)
{
	return (struct lw_quadrature_config){
		.edges_per_pulse = (uint8_t)params->encoder_edges_per_pulse,
		.invert_a = params->encoder_invert_a,
		.invert_b = params->encoder_invert_b,
		.invert_direction = params->drum_direction_invert,
	};
}

struct lw_limit_switch_config lw_params_limit_switch(const struct lw_params *params)
{
	return (struct lw_limit_switch_config){
		.contacts = (enum lw_switch_contacts)params->switch_contacts,
		.transit_us = (uint32_t)params->switch_transit_ms * 1000,
		.debounce_us = (uint32_t)params->switch_debounce_ms * 1000,
	};
}

uint32_t lw_params_crc(const struct lw_params *params)
{
	uint32_t crc = 0;

	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		const struct lw_point *point = &lw_map_params[i];
		uint8_t entry[6];
		uint32_t value;

		if (point->flags & (LW_POINT_SCOPE_LINE | LW_POINT_SECRET) ||
		    point->address == LW_ADDRESS_ACCEPTED_CRC) {
			continue;
		}
		memcpy(&value, (const char *)params + point->offset, sizeof(value));
		(void)lw_put32(lw_put16(entry, point->address), value);
		crc = lw_crc32_add(crc, entry, sizeof(entry));
	}
	return crc % LW_PARAMS_CRC_MAX + 1;
}

bool lw_params_need_index(const struct lw_params *from, const struct lw_params *to)
{
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		const struct lw_point *point = &lw_map_params[i];

		if ((point->flags & LW_POINT_REINDEX) &&
		    memcmp((const char *)from + point->offset, (const char *)to + point->offset,
			   sizeof(int32_t)) != 0) {
			return true;
		}
	}
	return false;
}
