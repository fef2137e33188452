#include "lw/params.h"

#include <errno.h>
#include <stddef.h>
#include <string.h>

/** Largest position that a motion may reach: leaves a slope's worth of room below int16. */
#define POSITION_MAX_USTEPS 32700

static int refuse(struct lw_refusal *why, enum lw_reason reason, unsigned int address,
		  int64_t value, int64_t limit)
{
	why->reason = (uint16_t)reason;
	why->address = (uint16_t)address;
	why->value = (int32_t)value;
	why->limit = (int32_t)limit;
	return -EINVAL;
}

/** Quotient of two integers, den > 0, rounded to nearest, halves away from zero. */
static int64_t divide_nearest(int64_t num, int64_t den)
{
	return (num >= 0 ? num + den / 2 : num - den / 2) / den;
}

int32_t lw_params_um_to_usteps(const struct lw_params *params, int32_t um)
{
	return (int32_t)divide_nearest((int64_t)um * params->microsteps_per_rev,
				       (int64_t)params->screw_lead_um);
}

int32_t lw_params_q16_to_um(const struct lw_params *params, int64_t q16)
{
	return (int32_t)divide_nearest(q16 * (int64_t)params->screw_lead_um,
				       (int64_t)params->microsteps_per_rev * LW_USTEP);
}

/** A place in micrometres, rounded so that it is at most so many microsteps. */
static int32_t um_at_most(const struct lw_params *params, int32_t usteps)
{
	int32_t um = lw_params_q16_to_um(params, (int64_t)usteps * LW_USTEP);

	while (lw_params_um_to_usteps(params, um) > usteps) {
		um--;
	}
	return um;
}

/** A place in micrometres, rounded so that it is at least so many microsteps. */
static int32_t um_at_least(const struct lw_params *params, int32_t usteps)
{
	return -um_at_most(params, -usteps);
}

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

/** Overshoot past the entry of a reversal, Q16.16 (P5). 2^16 * 2^16 / 2 at the most. */
static int64_t overshoot_q16(int64_t ka, int64_t nr)
{
	return ka * nr * (nr - 1) / 2;
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
	const int64_t ideal = divide_nearest(ideal_q32, LW_USTEP);

	if (ideal > LW_USTEP - 1) {
		return refuse(why, LW_REASON_SLOPE_ABOVE_ONE_STEP, LW_ADDRESS_PITCH_UM,
			      params->pitch_um, (int64_t)params->pitch_um * (LW_USTEP - 1) / ideal);
	}
	if (ideal < 1) {
		return refuse(why, LW_REASON_SLOPE_TOO_SMALL, LW_ADDRESS_PITCH_UM, params->pitch_um,
			      smallest_pitch_um(params));
	}

	const int64_t overshoot_usteps_q16 = (int64_t)params->overshoot_um *
					     params->microsteps_per_rev * LW_USTEP /
					     params->screw_lead_um;
	const int64_t nr_wanted = 2 * overshoot_usteps_q16 / ideal + 1;

	/* With Nr = 1 every slope can be had: if the nearest one will not do, none will. */
	const int64_t rounding_q32 = ideal * LW_USTEP - ideal_q32;

	if ((rounding_q32 < 0 ? -rounding_q32 : rounding_q32) > tolerance_q32) {
		return refuse(why, LW_REASON_SLOPE_UNREACHABLE, LW_ADDRESS_SLOPE_TOLERANCE_PPM,
			      params->slope_tolerance_ppm, divide_nearest(1000000, 2 * ideal) + 1);
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
				(int32_t)divide_nearest(error_q32 * 1000000, ideal_q32);
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

/** Blame a reversal point, in the register and the unit that it was given in. */
static int refuse_reversal(const struct lw_params *params, struct lw_refusal *why,
			   enum lw_reason reason, int side, int32_t limit_usteps, int32_t limit_um)
{
	if (params->expert_mode) {
		return side == LW_PLUS ? refuse(why, reason, LW_ADDRESS_RAW_REVERSAL_PLUS_USTEPS,
						params->raw_reversal_plus_usteps, limit_usteps)
				       : refuse(why, reason, LW_ADDRESS_RAW_REVERSAL_MINUS_USTEPS,
						params->raw_reversal_minus_usteps, limit_usteps);
	}
	return side == LW_PLUS ? refuse(why, reason, LW_ADDRESS_REVERSAL_PLUS_UM,
					params->reversal_plus_um, limit_um)
			       : refuse(why, reason, LW_ADDRESS_REVERSAL_MINUS_UM,
					params->reversal_minus_um, limit_um);
}

/**
 * A single contact tells late. Its event must come before the reversal begins, where indexing turns
 * round and where a switch that has not triggered counts as lost synchronization.
 */
static int check_debounce(const struct lw_params *params, const struct lw_derived *derived,
			  struct lw_refusal *why)
{
	const int64_t index_rate = params->index_rate_edges_per_s;
	const int64_t top_rate = (int64_t)params->overspeed_warning_edges_per_s;
	const int64_t q16_per_s = derived->ks * (top_rate > index_rate ? top_rate : index_rate);
	const int64_t plus_usteps = derived->reversal_plus_usteps - derived->switch_usteps[LW_PLUS];
	const int64_t minus_usteps =
		derived->switch_usteps[LW_MINUS] - derived->reversal_minus_usteps;
	const int64_t room_q16 =
		(plus_usteps < minus_usteps ? plus_usteps : minus_usteps) * LW_USTEP;

	if (params->switch_contacts != LW_SWITCH_CONTACTS_NO_NC_PAIR &&
	    q16_per_s * params->switch_debounce_ms >= room_q16 * 1000) {
		return refuse(why, LW_REASON_DEBOUNCE_TOO_LONG, LW_ADDRESS_SWITCH_DEBOUNCE_MS,
			      params->switch_debounce_ms, (room_q16 * 1000 - 1) / q16_per_s);
	}
	return 0;
}

/** The rules that bind reversal points, switches and flanges; also for a trim. */
static int check_geometry(const struct lw_params *params, const struct lw_derived *derived,
			  struct lw_refusal *why)
{
	const int32_t plus = derived->reversal_plus_usteps;
	const int32_t minus = derived->reversal_minus_usteps;
	/* P5: pos stays within [L- - dP - 1, L+ + dP + 1]. */
	const int32_t reach = derived->overshoot_q16 / LW_USTEP + 2;

	if (plus - minus < 2) {
		return refuse_reversal(params, why, LW_REASON_REVERSALS_CROSSED, LW_MINUS, plus - 2,
				       um_at_most(params, plus - 2));
	}
	if (derived->switch_usteps[LW_PLUS] >= plus) {
		return refuse(why, LW_REASON_SWITCH_PLUS_OUTSIDE, LW_ADDRESS_SWITCH_PLUS_UM,
			      params->switch_plus_um,
			      lw_params_q16_to_um(params, (int64_t)plus * LW_USTEP));
	}
	if (derived->switch_usteps[LW_MINUS] <= minus) {
		return refuse(why, LW_REASON_SWITCH_MINUS_OUTSIDE, LW_ADDRESS_SWITCH_MINUS_UM,
			      params->switch_minus_um,
			      lw_params_q16_to_um(params, (int64_t)minus * LW_USTEP));
	}

	const int32_t flange_plus = lw_params_um_to_usteps(params, params->flange_plus_um);
	const int32_t flange_minus = lw_params_um_to_usteps(params, params->flange_minus_um);

	if (plus + reach > POSITION_MAX_USTEPS) {
		return refuse_reversal(params, why, LW_REASON_POSITION_OVERFLOW, LW_PLUS,
				       POSITION_MAX_USTEPS - reach,
				       um_at_most(params, POSITION_MAX_USTEPS - reach));
	}
	if (minus - reach < -POSITION_MAX_USTEPS) {
		return refuse_reversal(params, why, LW_REASON_POSITION_OVERFLOW, LW_MINUS,
				       reach - POSITION_MAX_USTEPS,
				       um_at_least(params, reach - POSITION_MAX_USTEPS));
	}
	if (plus + reach > flange_plus) {
		return refuse(why, LW_REASON_OVERSHOOT_BEYOND_FLANGE_PLUS,
			      LW_ADDRESS_FLANGE_PLUS_UM, params->flange_plus_um,
			      um_at_least(params, plus + reach));
	}
	if (minus - reach < flange_minus) {
		return refuse(why, LW_REASON_OVERSHOOT_BEYOND_FLANGE_MINUS,
			      LW_ADDRESS_FLANGE_MINUS_UM, params->flange_minus_um,
			      um_at_most(params, minus - reach));
	}
	return check_debounce(params, derived, why);
}

/** The largest Nr whose overshoot fits into so many microsteps. */
static int32_t largest_nr(int32_t ka, int32_t room_usteps)
{
	int32_t nr = 1;

	while (overshoot_q16(ka, nr + 1) / LW_USTEP <= room_usteps) {
		nr++;
	}
	return nr;
}

/** Rules for switches, ramps, parking and travel that a trim cannot break. */
static int check_motion(const struct lw_params *params, const struct lw_derived *derived,
			struct lw_refusal *why)
{
	const int32_t plus = derived->switch_usteps[LW_PLUS];
	const int32_t minus = derived->switch_usteps[LW_MINUS];
	const int32_t clearance =
		2 * (derived->switch_tolerance_usteps + derived->switch_hysteresis_usteps);
	/* A full ramp is Ks * (Nr + 1) / 2: overshoot plus one slope, which is below 1 microstep.
	 */
	const int32_t ramp = derived->overshoot_q16 / LW_USTEP + 2;

	if (plus - minus <= clearance) {
		return refuse(why, LW_REASON_SWITCHES_CROSSED, LW_ADDRESS_SWITCH_MINUS_UM,
			      params->switch_minus_um, um_at_most(params, plus - clearance - 1));
	}
	if (plus - minus - clearance < 2 * ramp) {
		const int32_t room = (plus - minus - clearance) / 2 - 2;

		return params->expert_mode
			       ? refuse(why, LW_REASON_RAMP_DOES_NOT_FIT, LW_ADDRESS_RAW_NR,
					params->raw_nr, largest_nr(derived->ka, room))
			       : refuse(why, LW_REASON_RAMP_DOES_NOT_FIT, LW_ADDRESS_OVERSHOOT_UM,
					params->overshoot_um, um_at_most(params, room));
	}
	if (params->switch_plus_um + params->switch_tolerance_um > params->flange_plus_um) {
		return refuse(why, LW_REASON_TOLERANCE_BEYOND_FLANGE,
			      LW_ADDRESS_SWITCH_TOLERANCE_UM, params->switch_tolerance_um,
			      params->flange_plus_um - params->switch_plus_um);
	}
	if (params->switch_minus_um - params->switch_tolerance_um < params->flange_minus_um) {
		return refuse(why, LW_REASON_TOLERANCE_BEYOND_FLANGE,
			      LW_ADDRESS_SWITCH_TOLERANCE_UM, params->switch_tolerance_um,
			      params->switch_minus_um - params->flange_minus_um);
	}
	if (params->park_at == LW_PARK_AT_POSITION &&
	    (derived->park_usteps + ramp > plus || derived->park_usteps - ramp < minus)) {
		const bool above = derived->park_usteps + ramp > plus;

		return refuse(why, LW_REASON_PARK_OUTSIDE, LW_ADDRESS_PARK_POSITION_UM,
			      params->park_position_um,
			      above ? um_at_most(params, plus - ramp)
				    : um_at_least(params, minus + ramp));
	}
	if (derived->centre_usteps <= minus || derived->centre_usteps >= plus) {
		return refuse(why, LW_REASON_CENTRE_OUTSIDE, LW_ADDRESS_CENTRE_POSITION_UM,
			      params->centre_position_um,
			      derived->centre_usteps <= minus ? params->switch_minus_um
							      : params->switch_plus_um);
	}
	if ((int64_t)params->travel_um <
	    (int64_t)params->flange_plus_um - params->flange_minus_um) {
		return refuse(why, LW_REASON_TRAVEL_TOO_SHORT, LW_ADDRESS_TRAVEL_UM,
			      params->travel_um,
			      (int64_t)params->flange_plus_um - params->flange_minus_um);
	}
	/* A seek starts at most one ramp before 0 and ends within the travel. */
	if (derived->travel_usteps + 2 * ramp > POSITION_MAX_USTEPS) {
		return refuse(why, LW_REASON_POSITION_OVERFLOW, LW_ADDRESS_TRAVEL_UM,
			      params->travel_um,
			      um_at_most(params, POSITION_MAX_USTEPS - 2 * ramp));
	}
	if (params->overspeed_warning_edges_per_s > params->overspeed_trip_edges_per_s) {
		return refuse(why, LW_REASON_OVERSPEED_LIMITS_CROSSED,
			      LW_ADDRESS_OVERSPEED_WARNING_EDGES_PER_S,
			      params->overspeed_warning_edges_per_s,
			      params->overspeed_trip_edges_per_s);
	}
	return 0;
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
		return refuse(why, LW_REASON_TOO_FEW_EDGES, LW_ADDRESS_ENCODER_RATIO_DENOMINATOR,
			      edges_den, edges_num);
	}
	result.edges_per_1000_drum_revs = (uint32_t)divide_nearest(1000 * edges_num, edges_den);
	result.dwell_plus_edges =
		(uint32_t)divide_nearest(edges_num * params->dwell_plus_millirev, edges_den * 1000);
	result.dwell_minus_edges = (uint32_t)divide_nearest(
		edges_num * params->dwell_minus_millirev, edges_den * 1000);

	if (params->expert_mode) {
		result.ka = params->raw_ka;
		result.nr = params->raw_nr;
		if ((int64_t)result.ka * result.nr >= LW_USTEP) {
			return refuse(why, LW_REASON_SLOPE_ABOVE_ONE_STEP, LW_ADDRESS_RAW_NR,
				      result.nr, (LW_USTEP - 1) / result.ka);
		}
	} else {
		ret = choose_slope(params, &result, why);
		if (ret) {
			return ret;
		}
	}
	result.ks = result.ka * result.nr;

	result.overshoot_q16 = (int32_t)overshoot_q16(result.ka, result.nr);
	result.overshoot_um = lw_params_q16_to_um(params, result.overshoot_q16);
	result.overshoot_error_um =
		params->expert_mode ? 0 : result.overshoot_um - (int32_t)params->overshoot_um;

	/* Every position must fit before any is compared in microsteps. */
	const struct {
		unsigned int address;
		int32_t um;
	} positions[] = {
		{LW_ADDRESS_REVERSAL_PLUS_UM, params->reversal_plus_um},
		{LW_ADDRESS_REVERSAL_MINUS_UM, params->reversal_minus_um},
		{LW_ADDRESS_FLANGE_PLUS_UM, params->flange_plus_um},
		{LW_ADDRESS_FLANGE_MINUS_UM, params->flange_minus_um},
		{LW_ADDRESS_SWITCH_PLUS_UM, params->switch_plus_um},
		{LW_ADDRESS_SWITCH_MINUS_UM, params->switch_minus_um},
		{LW_ADDRESS_PARK_POSITION_UM, params->park_position_um},
		{LW_ADDRESS_CENTRE_POSITION_UM, params->centre_position_um},
		{LW_ADDRESS_TRAVEL_UM, (int32_t)params->travel_um},
		{LW_ADDRESS_SWITCH_TOLERANCE_UM, params->switch_tolerance_um},
		{LW_ADDRESS_SWITCH_HYSTERESIS_UM, params->switch_hysteresis_um},
		{LW_ADDRESS_SPAN_TOLERANCE_UM, params->span_tolerance_um},
	};
	const int32_t position_max_um =
		lw_params_q16_to_um(params, (int64_t)POSITION_MAX_USTEPS * LW_USTEP);

	for (size_t i = 0; i < sizeof(positions) / sizeof(positions[0]); i++) {
		const int32_t um = positions[i].um;

		if (um > position_max_um || um < -position_max_um) {
			return refuse(why, LW_REASON_POSITION_OVERFLOW, positions[i].address, um,
				      um > 0 ? position_max_um : -position_max_um);
		}
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

	ret = check_geometry(params, &result, why);
	if (ret == 0) {
		ret = check_motion(params, &result, why);
	}
	if (ret == 0) {
		if (params->cam_axis == LW_CAM_AXIS_FREE &&
		    params->cam_start != LW_CAM_START_RELATIVE) {
			return refuse(why, LW_REASON_CAM_FREE_AXIS, LW_ADDRESS_CAM_START,
				      params->cam_start, LW_CAM_START_RELATIVE);
		}
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
	return check_geometry(params, &trimmed, why);
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
	};
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
