/* SPDX-License-Identifier: Apache-2.0 */
#include "params_check.h"

#include <errno.h>
#include <stddef.h>

#include "lw/control/params_units.h"
#include "lw/motion/move.h"

/** Packing below which a value is a mistake: a heap of rope with nine parts of air in ten. */
#define PACKING_MIN_PERMILLE 100

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

int lw_params_check_positions(const struct lw_params *params, struct lw_refusal *why)
{
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
		lw_params_q16_to_um(params, (int64_t)LW_POSITION_MAX_USTEPS * LW_USTEP);

	for (size_t i = 0; i < sizeof(positions) / sizeof(positions[0]); i++) {
		const int32_t um = positions[i].um;

		if (um > position_max_um || um < -position_max_um) {
			return lw_refuse(why, -EINVAL, LW_REASON_POSITION_OVERFLOW,
					 positions[i].address, um,
					 um > 0 ? position_max_um : -position_max_um);
		}
	}
	return 0;
}

/** Blame a reversal point, in the register and the unit that it was given in. */
static int refuse_reversal(const struct lw_params *params, struct lw_refusal *why,
			   enum lw_reason reason, int side, int32_t limit_usteps, int32_t limit_um)
{
	if (params->expert_mode) {
		return side == LW_PLUS ? lw_refuse(why, -EINVAL, reason,
						   LW_ADDRESS_RAW_REVERSAL_PLUS_USTEPS,
						   params->raw_reversal_plus_usteps, limit_usteps)
				       : lw_refuse(why, -EINVAL, reason,
						   LW_ADDRESS_RAW_REVERSAL_MINUS_USTEPS,
						   params->raw_reversal_minus_usteps, limit_usteps);
	}
	return side == LW_PLUS ? lw_refuse(why, -EINVAL, reason, LW_ADDRESS_REVERSAL_PLUS_UM,
					   params->reversal_plus_um, limit_um)
			       : lw_refuse(why, -EINVAL, reason, LW_ADDRESS_REVERSAL_MINUS_UM,
					   params->reversal_minus_um, limit_um);
}

/**
 * A single contact tells late, and a switch with a delay does. Its event must come before the
 * reversal begins, where indexing turns round and where a switch that has not triggered counts as
 * lost synchronization.
 */
static int check_lateness(const struct lw_params *params, const struct lw_derived *derived,
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

	/* So long it may take: shorter than the way to the reversal. */
	const int64_t most_us = (room_q16 * 1000000 - 1) / q16_per_s;

	if (params->switch_delay_us > most_us) {
		return lw_refuse(why, -EINVAL, LW_REASON_SWITCH_DELAY_TOO_LONG,
				 LW_ADDRESS_SWITCH_DELAY_US, params->switch_delay_us, most_us);
	}
	if (params->switch_contacts != LW_SWITCH_CONTACTS_NO_NC_PAIR &&
	    params->switch_debounce_ms * 1000 + params->switch_delay_us > most_us) {
		return lw_refuse(why, -EINVAL, LW_REASON_DEBOUNCE_TOO_LONG,
				 LW_ADDRESS_SWITCH_DEBOUNCE_MS, params->switch_debounce_ms,
				 (most_us - params->switch_delay_us) / 1000);
	}
	return 0;
}

/** The rules that bind reversal points, switches and flanges; also for a trim. */
int lw_params_check_geometry(const struct lw_params *params, const struct lw_derived *derived,
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
		return lw_refuse(why, -EINVAL, LW_REASON_SWITCH_PLUS_OUTSIDE,
				 LW_ADDRESS_SWITCH_PLUS_UM, params->switch_plus_um,
				 lw_params_q16_to_um(params, (int64_t)plus * LW_USTEP));
	}
	if (derived->switch_usteps[LW_MINUS] <= minus) {
		return lw_refuse(why, -EINVAL, LW_REASON_SWITCH_MINUS_OUTSIDE,
				 LW_ADDRESS_SWITCH_MINUS_UM, params->switch_minus_um,
				 lw_params_q16_to_um(params, (int64_t)minus * LW_USTEP));
	}

	const int32_t flange_plus = lw_params_um_to_usteps(params, params->flange_plus_um);
	const int32_t flange_minus = lw_params_um_to_usteps(params, params->flange_minus_um);

	if (plus + reach > LW_POSITION_MAX_USTEPS) {
		return refuse_reversal(params, why, LW_REASON_POSITION_OVERFLOW, LW_PLUS,
				       LW_POSITION_MAX_USTEPS - reach,
				       um_at_most(params, LW_POSITION_MAX_USTEPS - reach));
	}
	if (minus - reach < -LW_POSITION_MAX_USTEPS) {
		return refuse_reversal(params, why, LW_REASON_POSITION_OVERFLOW, LW_MINUS,
				       reach - LW_POSITION_MAX_USTEPS,
				       um_at_least(params, reach - LW_POSITION_MAX_USTEPS));
	}
	if (plus + reach > flange_plus) {
		return lw_refuse(why, -EINVAL, LW_REASON_OVERSHOOT_BEYOND_FLANGE_PLUS,
				 LW_ADDRESS_FLANGE_PLUS_UM, params->flange_plus_um,
				 um_at_least(params, plus + reach));
	}
	if (minus - reach < flange_minus) {
		return lw_refuse(why, -EINVAL, LW_REASON_OVERSHOOT_BEYOND_FLANGE_MINUS,
				 LW_ADDRESS_FLANGE_MINUS_UM, params->flange_minus_um,
				 um_at_most(params, minus - reach));
	}
	return check_lateness(params, derived, why);
}

/** The largest Nr whose overshoot fits into so many microsteps. */
static int32_t largest_nr(int32_t ka, int32_t room_usteps)
{
	int32_t nr = 1;

	while (lw_move_overshoot_q16(ka, nr + 1) / LW_USTEP <= room_usteps) {
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
		return lw_refuse(why, -EINVAL, LW_REASON_SWITCHES_CROSSED,
				 LW_ADDRESS_SWITCH_MINUS_UM, params->switch_minus_um,
				 um_at_most(params, plus - clearance - 1));
	}
	if (plus - minus - clearance < 2 * ramp) {
		const int32_t room = (plus - minus - clearance) / 2 - 2;

		return params->expert_mode
			       ? lw_refuse(why, -EINVAL, LW_REASON_RAMP_DOES_NOT_FIT,
					   LW_ADDRESS_RAW_NR, params->raw_nr,
					   largest_nr(derived->ka, room))
			       : lw_refuse(why, -EINVAL, LW_REASON_RAMP_DOES_NOT_FIT,
					   LW_ADDRESS_OVERSHOOT_UM, params->overshoot_um,
					   um_at_most(params, room));
	}
	if (params->switch_plus_um + params->switch_tolerance_um > params->flange_plus_um) {
		return lw_refuse(why, -EINVAL, LW_REASON_TOLERANCE_BEYOND_FLANGE,
				 LW_ADDRESS_SWITCH_TOLERANCE_UM, params->switch_tolerance_um,
				 params->flange_plus_um - params->switch_plus_um);
	}
	if (params->switch_minus_um - params->switch_tolerance_um < params->flange_minus_um) {
		return lw_refuse(why, -EINVAL, LW_REASON_TOLERANCE_BEYOND_FLANGE,
				 LW_ADDRESS_SWITCH_TOLERANCE_UM, params->switch_tolerance_um,
				 params->switch_minus_um - params->flange_minus_um);
	}
	if (params->park_at == LW_PARK_AT_POSITION &&
	    (derived->park_usteps + ramp > plus || derived->park_usteps - ramp < minus)) {
		const bool above = derived->park_usteps + ramp > plus;

		return lw_refuse(why, -EINVAL, LW_REASON_PARK_OUTSIDE, LW_ADDRESS_PARK_POSITION_UM,
				 params->park_position_um,
				 above ? um_at_most(params, plus - ramp)
				       : um_at_least(params, minus + ramp));
	}
	if (derived->centre_usteps <= minus || derived->centre_usteps >= plus) {
		return lw_refuse(why, -EINVAL, LW_REASON_CENTRE_OUTSIDE,
				 LW_ADDRESS_CENTRE_POSITION_UM, params->centre_position_um,
				 derived->centre_usteps <= minus ? params->switch_minus_um
								 : params->switch_plus_um);
	}
	if ((int64_t)params->travel_um <
	    (int64_t)params->flange_plus_um - params->flange_minus_um) {
		return lw_refuse(why, -EINVAL, LW_REASON_TRAVEL_TOO_SHORT, LW_ADDRESS_TRAVEL_UM,
				 params->travel_um,
				 (int64_t)params->flange_plus_um - params->flange_minus_um);
	}
	/* A seek starts at most one ramp before 0 and ends within the travel. */
	if (derived->travel_usteps + 2 * ramp > LW_POSITION_MAX_USTEPS) {
		return lw_refuse(why, -EINVAL, LW_REASON_POSITION_OVERFLOW, LW_ADDRESS_TRAVEL_UM,
				 params->travel_um,
				 um_at_most(params, LW_POSITION_MAX_USTEPS - 2 * ramp));
	}
	if (params->overspeed_warning_edges_per_s > params->overspeed_trip_edges_per_s) {
		return lw_refuse(why, -EINVAL, LW_REASON_OVERSPEED_LIMITS_CROSSED,
				 LW_ADDRESS_OVERSPEED_WARNING_EDGES_PER_S,
				 params->overspeed_warning_edges_per_s,
				 params->overspeed_trip_edges_per_s);
	}
	return 0;
}

/** Rules for the rope and how it is laid. What is not known is 0 and breaks none. */
static int check_rope(const struct lw_params *params, const struct lw_derived *derived,
		      struct lw_refusal *why)
{
	const int32_t width_um = lw_params_far_points_um(params, derived);

	if (params->breaker_cycles == 1) {
		return lw_refuse(why, -EINVAL, LW_REASON_BREAKER_ONE_CYCLE,
				 LW_ADDRESS_BREAKER_CYCLES, params->breaker_cycles, 2);
	}
	if (params->rope_packing_permille > 0 &&
	    params->rope_packing_permille < PACKING_MIN_PERMILLE) {
		return lw_refuse(why, -EINVAL, LW_REASON_PACKING_TOO_SMALL,
				 LW_ADDRESS_ROPE_PACKING_PERMILLE, params->rope_packing_permille,
				 PACKING_MIN_PERMILLE);
	}
	if (params->drum_core_diameter_um > 0 &&
	    params->drum_core_diameter_um < (uint32_t)params->rope_diameter_um) {
		return lw_refuse(why, -EINVAL, LW_REASON_CORE_THINNER_THAN_ROPE,
				 LW_ADDRESS_DRUM_CORE_DIAMETER_UM, params->drum_core_diameter_um,
				 params->rope_diameter_um);
	}
	if (params->rope_diameter_um > width_um) {
		return lw_refuse(why, -EINVAL, LW_REASON_DRUM_NARROWER_THAN_ROPE,
				 LW_ADDRESS_ROPE_DIAMETER_UM, params->rope_diameter_um, width_um);
	}
	return 0;
}

int lw_params_check(const struct lw_params *params, const struct lw_derived *derived,
		    struct lw_refusal *why)
{
	int ret = lw_params_check_geometry(params, derived, why);

	if (ret == 0) {
		ret = check_motion(params, derived, why);
	}
	if (ret == 0) {
		ret = check_rope(params, derived, why);
	}
	if (ret == 0 && params->cam_axis == LW_CAM_AXIS_FREE &&
	    params->cam_start != LW_CAM_START_RELATIVE) {
		return lw_refuse(why, -EINVAL, LW_REASON_CAM_FREE_AXIS, LW_ADDRESS_CAM_START,
				 params->cam_start, LW_CAM_START_RELATIVE);
	}
	return ret;
}
