/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The Modbus map: tables.
 * Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py
 * Do not edit.
 */
#include "lw/map.h"

#include <stddef.h>

static const int32_t allowed_command[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 30, 31, 32};
const struct lw_point lw_map_setpoints[LW_MAP_SETPOINTS_COUNT] = {
	{
		.address = 0, .count = 1, .offset = offsetof(struct lw_setpoints, command),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .min = 0,
		.max = 32, .default_value = 0, .allowed = allowed_command, .allowed_count = 19,
	},
	{
		.address = 1, .count = 1, .offset = offsetof(struct lw_setpoints, mode),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 2,
		.default_value = 1,
	},
	{
		.address = 2, .count = 1, .offset = offsetof(struct lw_setpoints, jog),
		.type = LW_TYPE_I16, .flags = LW_POINT_WRITABLE, .min = -1, .max = 1,
		.default_value = 0,
	},
	{
		.address = 3, .count = 1, .offset = offsetof(struct lw_setpoints, trim_plus_um),
		.type = LW_TYPE_I16, .flags = LW_POINT_WRITABLE, .min = -20000, .max = 20000,
		.default_value = 0,
	},
	{
		.address = 4, .count = 1, .offset = offsetof(struct lw_setpoints, trim_minus_um),
		.type = LW_TYPE_I16, .flags = LW_POINT_WRITABLE, .min = -20000, .max = 20000,
		.default_value = 0,
	},
	{
		.address = 5, .count = 1, .offset = offsetof(struct lw_setpoints, drum_running),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 1,
		.default_value = 0,
	},
	{
		.address = 6, .count = 1, .offset = offsetof(struct lw_setpoints, set_rope_mm),
		.type = LW_TYPE_I32, .flags = LW_POINT_WRITABLE, .min = -1, .max = 10000000,
		.default_value = -1,
	},
	{
		.address = 10, .count = 1, .offset = offsetof(struct lw_setpoints, unlock),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE, .min = 0, .max = 999999,
		.default_value = 0,
	},
	{
		.address = 630, .count = 1,
		.offset = offsetof(struct lw_setpoints, cam_phase_edges), .type = LW_TYPE_I32,
		.flags = LW_POINT_WRITABLE, .min = -100000000, .max = 100000000, .default_value = 0,
	},
};

static const int32_t allowed_encoder_edges_per_pulse[] = {1, 2, 4};
static const int32_t allowed_baud_rate[] = {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};
const struct lw_point lw_map_params[LW_MAP_PARAMS_COUNT] = {
	{
		.address = 100, .count = 1,
		.offset = offsetof(struct lw_params, encoder_pulses_per_rev), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 1, .max = 10000,
		.default_value = 360,
	},
	{
		.address = 101, .count = 1,
		.offset = offsetof(struct lw_params, encoder_edges_per_pulse), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 1, .max = 4,
		.default_value = 2, .allowed = allowed_encoder_edges_per_pulse, .allowed_count = 3,
	},
	{
		.address = 102, .count = 1,
		.offset = offsetof(struct lw_params, encoder_ratio_numerator), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 1, .max = 100,
		.default_value = 4,
	},
	{
		.address = 103, .count = 1,
		.offset = offsetof(struct lw_params, encoder_ratio_denominator),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 1,
		.max = 1000, .default_value = 1,
	},
	{
		.address = 104, .count = 1, .offset = offsetof(struct lw_params, encoder_invert_a),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0,
		.max = 1, .default_value = 0,
	},
	{
		.address = 105, .count = 1, .offset = offsetof(struct lw_params, encoder_invert_b),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0,
		.max = 1, .default_value = 0,
	},
	{
		.address = 106, .count = 1,
		.offset = offsetof(struct lw_params, drum_direction_invert), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0, .max = 1,
		.default_value = 0,
	},
	{
		.address = 107, .count = 1,
		.offset = offsetof(struct lw_params, rope_per_drum_rev_um), .type = LW_TYPE_U32,
		.flags = LW_POINT_WRITABLE, .min = 1000, .max = 20000000, .default_value = 2400000,
	},
	{
		.address = 110, .count = 1, .offset = offsetof(struct lw_params, screw_lead_um),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 500,
		.max = 100000, .default_value = 20000,
	},
	{
		.address = 112, .count = 1,
		.offset = offsetof(struct lw_params, microsteps_per_rev), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 200, .max = 51200,
		.default_value = 2000,
	},
	{
		.address = 113, .count = 1,
		.offset = offsetof(struct lw_params, carriage_direction_invert),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0,
		.max = 1, .default_value = 0,
	},
	{
		.address = 114, .count = 1, .offset = offsetof(struct lw_params, pitch_um),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 10,
		.max = 100000, .default_value = 12000,
	},
	{
		.address = 116, .count = 1, .offset = offsetof(struct lw_params, overshoot_um),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 1,
		.max = 50000, .default_value = 2500,
	},
	{
		.address = 118, .count = 1,
		.offset = offsetof(struct lw_params, slope_tolerance_ppm), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 1, .max = 50000,
		.default_value = 500,
	},
	{
		.address = 120, .count = 1, .offset = offsetof(struct lw_params, reversal_plus_um),
		.type = LW_TYPE_I32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = -500000,
		.max = 500000, .default_value = 80000,
	},
	{
		.address = 122, .count = 1, .offset = offsetof(struct lw_params, reversal_minus_um),
		.type = LW_TYPE_I32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = -500000,
		.max = 500000, .default_value = -80000,
	},
	{
		.address = 124, .count = 1, .offset = offsetof(struct lw_params, flange_plus_um),
		.type = LW_TYPE_I32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = -500000,
		.max = 500000, .default_value = 83000,
	},
	{
		.address = 126, .count = 1, .offset = offsetof(struct lw_params, flange_minus_um),
		.type = LW_TYPE_I32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = -500000,
		.max = 500000, .default_value = -83000,
	},
	{
		.address = 128, .count = 1, .offset = offsetof(struct lw_params, switch_plus_um),
		.type = LW_TYPE_I32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = -500000,
		.max = 500000, .default_value = 78400,
	},
	{
		.address = 130, .count = 1, .offset = offsetof(struct lw_params, switch_minus_um),
		.type = LW_TYPE_I32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = -500000,
		.max = 500000, .default_value = -78400,
	},
	{
		.address = 132, .count = 1,
		.offset = offsetof(struct lw_params, switch_tolerance_um), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 10, .max = 20000,
		.default_value = 1000,
	},
	{
		.address = 133, .count = 1,
		.offset = offsetof(struct lw_params, switch_hysteresis_um), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 10, .max = 20000,
		.default_value = 1500,
	},
	{
		.address = 134, .count = 1, .offset = offsetof(struct lw_params, switch_contacts),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0,
		.max = 2, .default_value = 0,
	},
	{
		.address = 135, .count = 1, .offset = offsetof(struct lw_params, switch_transit_ms),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 1, .max = 90,
		.default_value = 20,
	},
	{
		.address = 136, .count = 1,
		.offset = offsetof(struct lw_params, switch_debounce_ms), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 1, .max = 100, .default_value = 5,
	},
	{
		.address = 137, .count = 1, .offset = offsetof(struct lw_params, travel_um),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 1000,
		.max = 600000, .default_value = 180000,
	},
	{
		.address = 139, .count = 1, .offset = offsetof(struct lw_params, switch_delay_us),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0,
		.max = 20000, .default_value = 0,
	},
	{
		.address = 140, .count = 1, .offset = offsetof(struct lw_params, index_switch),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0,
		.max = 1, .default_value = 0,
	},
	{
		.address = 141, .count = 1,
		.offset = offsetof(struct lw_params, index_rate_edges_per_s), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 100, .max = 50000,
		.default_value = 10000,
	},
	{
		.address = 142, .count = 1, .offset = offsetof(struct lw_params, park_at),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0,
		.max = 1, .default_value = 0,
	},
	{
		.address = 143, .count = 1, .offset = offsetof(struct lw_params, park_position_um),
		.type = LW_TYPE_I32, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = -500000,
		.max = 500000, .default_value = 0,
	},
	{
		.address = 145, .count = 1, .offset = offsetof(struct lw_params, span_tolerance_um),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 10,
		.max = 20000, .default_value = 1000,
	},
	{
		.address = 146, .count = 1,
		.offset = offsetof(struct lw_params, handover_direction), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.address = 147, .count = 1, .offset = offsetof(struct lw_params, rest_edges_per_s),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 1, .max = 5000,
		.default_value = 50,
	},
	{
		.address = 148, .count = 1, .offset = offsetof(struct lw_params, rest_time_ms),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 10, .max = 10000,
		.default_value = 200,
	},
	{
		.address = 149, .count = 1,
		.offset = offsetof(struct lw_params, centre_position_um), .type = LW_TYPE_I32,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = -500000, .max = 500000,
		.default_value = 0,
	},
	{
		.address = 151, .count = 1,
		.offset = offsetof(struct lw_params, jog_rate_edges_per_s), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 100, .max = 50000, .default_value = 5000,
	},
	{
		.address = 152, .count = 1, .offset = offsetof(struct lw_params, jog_hold_ms),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 50, .max = 5000,
		.default_value = 500,
	},
	{
		.address = 160, .count = 1,
		.offset = offsetof(struct lw_params, los_recoveries_max), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 1000, .default_value = 3,
	},
	{
		.address = 161, .count = 1,
		.offset = offsetof(struct lw_params, overspeed_warning_edges_per_s),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE, .min = 100, .max = 1000000,
		.default_value = 52000,
	},
	{
		.address = 163, .count = 1,
		.offset = offsetof(struct lw_params, overspeed_trip_edges_per_s),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE, .min = 100, .max = 1000000,
		.default_value = 60000,
	},
	{
		.address = 165, .count = 1, .offset = offsetof(struct lw_params, master_timeout_ms),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 60000,
		.default_value = 0,
	},
	{
		.address = 166, .count = 1,
		.offset = offsetof(struct lw_params, dwell_plus_millirev), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0, .max = 10000,
		.default_value = 0,
	},
	{
		.address = 167, .count = 1,
		.offset = offsetof(struct lw_params, dwell_minus_millirev), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0, .max = 10000,
		.default_value = 0,
	},
	{
		.address = 168, .count = 1, .offset = offsetof(struct lw_params, breaker_millirev),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0,
		.max = 2000, .default_value = 0,
	},
	{
		.address = 169, .count = 1, .offset = offsetof(struct lw_params, breaker_cycles),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0,
		.max = 200, .default_value = 0,
	},
	{
		.address = 170, .count = 1, .offset = offsetof(struct lw_params, expert_mode),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 0,
		.max = 1, .default_value = 0,
	},
	{
		.address = 171, .count = 1, .offset = offsetof(struct lw_params, raw_ka),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 1,
		.max = 65535, .default_value = 23,
	},
	{
		.address = 172, .count = 1, .offset = offsetof(struct lw_params, raw_nr),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = 1,
		.max = 65535, .default_value = 1187,
	},
	{
		.address = 173, .count = 1,
		.offset = offsetof(struct lw_params, raw_reversal_plus_usteps), .type = LW_TYPE_I16,
		.flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = -32000, .max = 32000,
		.default_value = 8000,
	},
	{
		.address = 174, .count = 1,
		.offset = offsetof(struct lw_params, raw_reversal_minus_usteps),
		.type = LW_TYPE_I16, .flags = LW_POINT_WRITABLE | LW_POINT_REINDEX, .min = -32000,
		.max = 32000, .default_value = -8000,
	},
	{
		.address = 180, .count = 1, .offset = offsetof(struct lw_params, unit_id),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_SCOPE_LINE, .min = 1,
		.max = 247, .default_value = 1,
	},
	{
		.address = 181, .count = 1, .offset = offsetof(struct lw_params, baud_rate),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE | LW_POINT_SCOPE_LINE, .min = 1200,
		.max = 115200, .default_value = 19200, .allowed = allowed_baud_rate,
		.allowed_count = 8,
	},
	{
		.address = 183, .count = 1, .offset = offsetof(struct lw_params, line_format),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_SCOPE_LINE, .min = 0,
		.max = 3, .default_value = 0,
	},
	{
		.address = 184, .count = 1, .offset = offsetof(struct lw_params, lock_code),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE | LW_POINT_SECRET, .min = 0,
		.max = 1000000, .default_value = 0,
	},
	{
		.address = 186, .count = 1, .offset = offsetof(struct lw_params, lock_timeout_s),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 10, .max = 3600,
		.default_value = 300,
	},
	{
		.address = 187, .count = 1, .offset = offsetof(struct lw_params, line_confirm_s),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_SCOPE_LINE, .min = 2,
		.max = 120, .default_value = 10,
	},
	{
		.address = 190, .count = 1,
		.offset = offsetof(struct lw_params, encoder_watch_transitions_per_s),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE, .min = 100, .max = 1000000,
		.default_value = 2000,
	},
	{
		.address = 192, .count = 1, .offset = offsetof(struct lw_params, encoder_watch_ms),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 50, .max = 60000,
		.default_value = 500,
	},
	{
		.address = 193, .count = 1,
		.offset = offsetof(struct lw_params, encoder_illegal_permille), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 1, .max = 1000, .default_value = 10,
	},
	{
		.address = 194, .count = 1, .offset = offsetof(struct lw_params, drum_watch_ms),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 60000,
		.default_value = 0,
	},
	{
		.address = 199, .count = 1,
		.offset = offsetof(struct lw_params, standing_turns_permille), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 10000, .default_value = 250,
	},
	{
		.address = 200, .count = 1, .offset = offsetof(struct lw_params, rope_diameter_um),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 50000,
		.default_value = 0,
	},
	{
		.address = 201, .count = 1,
		.offset = offsetof(struct lw_params, drum_core_diameter_um), .type = LW_TYPE_U32,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 5000000, .default_value = 0,
	},
	{
		.address = 203, .count = 1,
		.offset = offsetof(struct lw_params, rope_packing_permille), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 1000, .default_value = 0,
	},
	{
		.address = 204, .count = 1, .offset = offsetof(struct lw_params, trim_step_um),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 1, .max = 5000,
		.default_value = 500,
	},
	{
		.address = 205, .count = 1, .offset = offsetof(struct lw_params, resume),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 1,
		.default_value = 0,
	},
	{
		.address = 206, .count = 1,
		.offset = offsetof(struct lw_params, reacquire_after_restart), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.address = 207, .count = 1, .offset = offsetof(struct lw_params, accepted_crc),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE, .min = 0, .max = 1073741823,
		.default_value = 0,
	},
	{
		.address = 600, .count = 1, .offset = offsetof(struct lw_params, motion_profile),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 1,
		.default_value = 0,
	},
	{
		.address = 601, .count = 1, .offset = offsetof(struct lw_params, cam_start),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 2,
		.default_value = 0,
	},
	{
		.address = 602, .count = 1, .offset = offsetof(struct lw_params, cam_master_edges),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 1, .max = 10000,
		.default_value = 1,
	},
	{
		.address = 603, .count = 1, .offset = offsetof(struct lw_params, cam_master_units),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 1, .max = 10000,
		.default_value = 1,
	},
	{
		.address = 604, .count = 1, .offset = offsetof(struct lw_params, cam_slave_usteps),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 1, .max = 10000,
		.default_value = 1,
	},
	{
		.address = 605, .count = 1, .offset = offsetof(struct lw_params, cam_slave_units),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 1, .max = 10000,
		.default_value = 1,
	},
	{
		.address = 606, .count = 1, .offset = offsetof(struct lw_params, cam_ramp_divisor),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 2, .max = 100,
		.default_value = 10,
	},
	{
		.address = 607, .count = 1, .offset = offsetof(struct lw_params, cam_axis),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 1,
		.default_value = 0,
	},
	{
		.address = 608, .count = 1,
		.offset = offsetof(struct lw_params, cam_steps_per_s_max), .type = LW_TYPE_U32,
		.flags = LW_POINT_WRITABLE, .min = 1000, .max = 4000000, .default_value = 200000,
	},
};

const struct lw_point lw_map_status[LW_MAP_STATUS_COUNT] = {
	{
		.address = 0, .count = 1, .offset = offsetof(struct lw_status, self_test),
		.type = LW_TYPE_U32,
	},
	{
		.address = 2, .count = 1, .offset = offsetof(struct lw_status, map_version),
		.type = LW_TYPE_U16,
	},
	{
		.address = 3, .count = 1, .offset = offsetof(struct lw_status, version_major),
		.type = LW_TYPE_U16,
	},
	{
		.address = 4, .count = 1, .offset = offsetof(struct lw_status, version_minor),
		.type = LW_TYPE_U16,
	},
	{
		.address = 5, .count = 1, .offset = offsetof(struct lw_status, version_patch),
		.type = LW_TYPE_U16,
	},
	{.address = 6, .count = 1, .offset = offsetof(struct lw_status, host), .type = LW_TYPE_U16},
	{
		.address = 7, .count = 1, .offset = offsetof(struct lw_status, image_hash_high),
		.type = LW_TYPE_U32,
	},
	{
		.address = 9, .count = 1, .offset = offsetof(struct lw_status, image_hash_low),
		.type = LW_TYPE_U32,
	},
	{
		.address = 100, .count = 1, .offset = offsetof(struct lw_status, state),
		.type = LW_TYPE_U16,
	},
	{
		.address = 101, .count = 1, .offset = offsetof(struct lw_status, active_mode),
		.type = LW_TYPE_U16,
	},
	{
		.address = 102, .count = 1, .offset = offsetof(struct lw_status, fault),
		.type = LW_TYPE_U16,
	},
	{
		.address = 103, .count = 1, .offset = offsetof(struct lw_status, flags),
		.type = LW_TYPE_U32,
	},
	{
		.address = 105, .count = 1, .offset = offsetof(struct lw_status, launch_inhibit),
		.type = LW_TYPE_U16,
	},
	{
		.address = 106, .count = 1, .offset = offsetof(struct lw_status, position_um),
		.type = LW_TYPE_I32,
	},
	{
		.address = 108, .count = 1, .offset = offsetof(struct lw_status, position_usteps),
		.type = LW_TYPE_I16,
	},
	{.address = 109, .count = 1, .offset = offsetof(struct lw_status, m), .type = LW_TYPE_I32},
	{.address = 111, .count = 1, .offset = offsetof(struct lw_status, u), .type = LW_TYPE_I32},
	{
		.address = 113, .count = 1,
		.offset = offsetof(struct lw_status, drum_speed_edges_per_s), .type = LW_TYPE_I32,
	},
	{
		.address = 115, .count = 1,
		.offset = offsetof(struct lw_status, rope_speed_mm_per_s), .type = LW_TYPE_I32,
	},
	{
		.address = 117, .count = 1, .offset = offsetof(struct lw_status, rope_mm),
		.type = LW_TYPE_I32,
	},
	{
		.address = 119, .count = 1, .offset = offsetof(struct lw_status, net_edges),
		.type = LW_TYPE_I64,
	},
	{
		.address = 123, .count = 1, .offset = offsetof(struct lw_status, pattern_edges),
		.type = LW_TYPE_I64,
	},
	{
		.address = 127, .count = 1, .offset = offsetof(struct lw_status, uptime_ms),
		.type = LW_TYPE_U32,
	},
	{
		.address = 129, .count = 1, .offset = offsetof(struct lw_status, los_recoveries),
		.type = LW_TYPE_U16,
	},
	{
		.address = 130, .count = 1, .offset = offsetof(struct lw_status, span_error_um),
		.type = LW_TYPE_I32,
	},
	{
		.address = 132, .count = 1, .offset = offsetof(struct lw_status, flags_2),
		.type = LW_TYPE_U32,
	},
	{
		.address = 134, .count = 1, .offset = offsetof(struct lw_status, rope_on_drum_mm),
		.type = LW_TYPE_I32,
	},
	{
		.address = 136, .count = 1, .offset = offsetof(struct lw_status, rope_out_mm),
		.type = LW_TYPE_I32,
	},
	{
		.address = 138, .count = 1, .offset = offsetof(struct lw_status, rope_layer),
		.type = LW_TYPE_U16,
	},
	{
		.address = 139, .count = 1, .offset = offsetof(struct lw_status, rope_radius_um),
		.type = LW_TYPE_U32,
	},
	{
		.address = 141, .count = 1,
		.offset = offsetof(struct lw_status, resume_position_um), .type = LW_TYPE_I32,
	},
	{
		.address = 143, .count = 1, .offset = offsetof(struct lw_status, resume_direction),
		.type = LW_TYPE_I16,
	},
	{
		.address = 200, .count = 1, .offset = offsetof(struct lw_status, los1_plus_count),
		.type = LW_TYPE_U16,
	},
	{
		.address = 201, .count = 1,
		.offset = offsetof(struct lw_status, los1_plus_position_um), .type = LW_TYPE_I32,
	},
	{
		.address = 203, .count = 1, .offset = offsetof(struct lw_status, los1_plus_time_ms),
		.type = LW_TYPE_U32,
	},
	{
		.address = 210, .count = 1, .offset = offsetof(struct lw_status, los1_minus_count),
		.type = LW_TYPE_U16,
	},
	{
		.address = 211, .count = 1,
		.offset = offsetof(struct lw_status, los1_minus_position_um), .type = LW_TYPE_I32,
	},
	{
		.address = 213, .count = 1,
		.offset = offsetof(struct lw_status, los1_minus_time_ms), .type = LW_TYPE_U32,
	},
	{
		.address = 220, .count = 1, .offset = offsetof(struct lw_status, los2_plus_count),
		.type = LW_TYPE_U16,
	},
	{
		.address = 221, .count = 1,
		.offset = offsetof(struct lw_status, los2_plus_position_um), .type = LW_TYPE_I32,
	},
	{
		.address = 223, .count = 1, .offset = offsetof(struct lw_status, los2_plus_time_ms),
		.type = LW_TYPE_U32,
	},
	{
		.address = 230, .count = 1, .offset = offsetof(struct lw_status, los2_minus_count),
		.type = LW_TYPE_U16,
	},
	{
		.address = 231, .count = 1,
		.offset = offsetof(struct lw_status, los2_minus_position_um), .type = LW_TYPE_I32,
	},
	{
		.address = 233, .count = 1,
		.offset = offsetof(struct lw_status, los2_minus_time_ms), .type = LW_TYPE_U32,
	},
	{
		.address = 300, .count = 1,
		.offset = offsetof(struct lw_status, illegal_transitions), .type = LW_TYPE_U32,
	},
	{
		.address = 302, .count = 1,
		.offset = offsetof(struct lw_status, switch_plus_triggers), .type = LW_TYPE_U32,
	},
	{
		.address = 304, .count = 1,
		.offset = offsetof(struct lw_status, switch_minus_triggers), .type = LW_TYPE_U32,
	},
	{
		.address = 306, .count = 1, .offset = offsetof(struct lw_status, steps),
		.type = LW_TYPE_U32,
	},
	{
		.address = 308, .count = 1, .offset = offsetof(struct lw_status, requests),
		.type = LW_TYPE_U32,
	},
	{
		.address = 310, .count = 1, .offset = offsetof(struct lw_status, crc_errors),
		.type = LW_TYPE_U32,
	},
	{
		.address = 312, .count = 1, .offset = offsetof(struct lw_status, exceptions),
		.type = LW_TYPE_U32,
	},
	{
		.address = 314, .count = 1, .offset = offsetof(struct lw_status, boots),
		.type = LW_TYPE_U32,
	},
	{
		.address = 316, .count = 1, .offset = offsetof(struct lw_status, watchdog_resets),
		.type = LW_TYPE_U32,
	},
	{
		.address = 318, .count = 1, .offset = offsetof(struct lw_status, powered_s),
		.type = LW_TYPE_U32,
	},
	{
		.address = 320, .count = 1, .offset = offsetof(struct lw_status, tracking_s),
		.type = LW_TYPE_U32,
	},
	{
		.address = 322, .count = 1, .offset = offsetof(struct lw_status, log_sequence),
		.type = LW_TYPE_U32,
	},
	{
		.address = 324, .count = 1, .offset = offsetof(struct lw_status, log_count),
		.type = LW_TYPE_U16,
	},
	{
		.address = 325, .count = 1, .offset = offsetof(struct lw_status, log_unsaved),
		.type = LW_TYPE_U16,
	},
	{
		.address = 326, .count = 1, .offset = offsetof(struct lw_status, record_sequence),
		.type = LW_TYPE_U32,
	},
	{
		.address = 328, .count = 1, .offset = offsetof(struct lw_status, record_schema),
		.type = LW_TYPE_U16,
	},
	{
		.address = 329, .count = 1, .offset = offsetof(struct lw_status, slot_0),
		.type = LW_TYPE_U16,
	},
	{
		.address = 330, .count = 1, .offset = offsetof(struct lw_status, slot_1),
		.type = LW_TYPE_U16,
	},
	{
		.address = 331, .count = 1, .offset = offsetof(struct lw_status, slot_2),
		.type = LW_TYPE_U16,
	},
	{
		.address = 332, .count = 1, .offset = offsetof(struct lw_status, slot_3),
		.type = LW_TYPE_U16,
	},
	{
		.address = 333, .count = 1, .offset = offsetof(struct lw_status, active_crc),
		.type = LW_TYPE_U32,
	},
	{
		.address = 340, .count = 1,
		.offset = offsetof(struct lw_status, encoder_interrupt_max_ns), .type = LW_TYPE_U32,
	},
	{
		.address = 342, .count = 1, .offset = offsetof(struct lw_status, late_interrupts),
		.type = LW_TYPE_U32,
	},
	{
		.address = 344, .count = 1,
		.offset = offsetof(struct lw_status, encoder_index_pulses), .type = LW_TYPE_U32,
	},
	{
		.address = 346, .count = 1, .offset = offsetof(struct lw_status, missed_edges),
		.type = LW_TYPE_U32,
	},
	{
		.address = 350, .count = 1,
		.offset = offsetof(struct lw_status, stack_free_supervisor_bytes),
		.type = LW_TYPE_U16,
	},
	{
		.address = 351, .count = 1,
		.offset = offsetof(struct lw_status, stack_free_limits_bytes), .type = LW_TYPE_U16,
	},
	{
		.address = 352, .count = 1,
		.offset = offsetof(struct lw_status, stack_free_modbus_bytes), .type = LW_TYPE_U16,
	},
	{
		.address = 353, .count = 1,
		.offset = offsetof(struct lw_status, stack_free_storage_bytes), .type = LW_TYPE_U16,
	},
	{
		.address = 354, .count = 1,
		.offset = offsetof(struct lw_status, stack_free_interrupts_bytes),
		.type = LW_TYPE_U16,
	},
	{
		.address = 360, .count = 1,
		.offset = offsetof(struct lw_status, encoder_fault_kind), .type = LW_TYPE_U16,
	},
	{
		.address = 361, .count = 1,
		.offset = offsetof(struct lw_status, encoder_fault_count), .type = LW_TYPE_U16,
	},
	{
		.address = 362, .count = 1,
		.offset = offsetof(struct lw_status, encoder_fault_position_um),
		.type = LW_TYPE_I32,
	},
	{
		.address = 364, .count = 1,
		.offset = offsetof(struct lw_status, encoder_fault_time_ms), .type = LW_TYPE_U32,
	},
	{
		.address = 366, .count = 1, .offset = offsetof(struct lw_status, encoder_doubts),
		.type = LW_TYPE_U16,
	},
	{
		.address = 367, .count = 1,
		.offset = offsetof(struct lw_status, encoder_misfit_edges), .type = LW_TYPE_I32,
	},
	{
		.address = 369, .count = 1,
		.offset = offsetof(struct lw_status, memory_corrections), .type = LW_TYPE_U16,
	},
	{
		.address = 380, .count = 1, .offset = offsetof(struct lw_status, line_babbles),
		.type = LW_TYPE_U32,
	},
	{
		.address = 382, .count = 1, .offset = offsetof(struct lw_status, line_echoes),
		.type = LW_TYPE_U32,
	},
	{
		.address = 384, .count = 1, .offset = offsetof(struct lw_status, late_requests),
		.type = LW_TYPE_U32,
	},
	{
		.address = 386, .count = 1, .offset = offsetof(struct lw_status, foreign_answers),
		.type = LW_TYPE_U32,
	},
	{
		.address = 388, .count = 1, .offset = offsetof(struct lw_status, events_skipped),
		.type = LW_TYPE_U32,
	},
	{
		.address = 390, .count = 1,
		.offset = offsetof(struct lw_status, rope_standing_millirev), .type = LW_TYPE_U32,
	},
	{
		.address = 392, .count = 1,
		.offset = offsetof(struct lw_status, rope_standing_position_um),
		.type = LW_TYPE_I32,
	},
	{
		.address = 394, .count = 1,
		.offset = offsetof(struct lw_status, rope_standing_time_ms), .type = LW_TYPE_U32,
	},
	{
		.address = 396, .count = 1,
		.offset = offsetof(struct lw_status, rope_standing_place_known),
		.type = LW_TYPE_U16,
	},
	{
		.address = 397, .count = 1,
		.offset = offsetof(struct lw_status, look_before_power_up), .type = LW_TYPE_U16,
	},
	{
		.address = 400, .count = 1, .offset = offsetof(struct lw_status, command_sequence),
		.type = LW_TYPE_U16,
	},
	{
		.address = 401, .count = 1, .offset = offsetof(struct lw_status, command_code),
		.type = LW_TYPE_U16,
	},
	{
		.address = 402, .count = 1, .offset = offsetof(struct lw_status, command_result),
		.type = LW_TYPE_U16,
	},
	{
		.address = 403, .count = 1, .offset = offsetof(struct lw_status, command_reason),
		.type = LW_TYPE_U16,
	},
	{
		.address = 404, .count = 1, .offset = offsetof(struct lw_status, command_address),
		.type = LW_TYPE_U16,
	},
	{
		.address = 405, .count = 1, .offset = offsetof(struct lw_status, command_value),
		.type = LW_TYPE_I32,
	},
	{
		.address = 407, .count = 1, .offset = offsetof(struct lw_status, command_limit),
		.type = LW_TYPE_I32,
	},
	{
		.address = 410, .count = 1, .offset = offsetof(struct lw_status, last_error_reason),
		.type = LW_TYPE_U16,
	},
	{
		.address = 411, .count = 1,
		.offset = offsetof(struct lw_status, last_error_function), .type = LW_TYPE_U16,
	},
	{
		.address = 412, .count = 1,
		.offset = offsetof(struct lw_status, last_error_exception), .type = LW_TYPE_U16,
	},
	{
		.address = 413, .count = 1,
		.offset = offsetof(struct lw_status, last_error_address), .type = LW_TYPE_U16,
	},
	{
		.address = 414, .count = 1, .offset = offsetof(struct lw_status, last_error_value),
		.type = LW_TYPE_I32,
	},
	{
		.address = 416, .count = 1, .offset = offsetof(struct lw_status, last_error_limit),
		.type = LW_TYPE_I32,
	},
	{.address = 500, .count = 1, .offset = offsetof(struct lw_status, ka), .type = LW_TYPE_I32},
	{.address = 502, .count = 1, .offset = offsetof(struct lw_status, nr), .type = LW_TYPE_I32},
	{.address = 504, .count = 1, .offset = offsetof(struct lw_status, ks), .type = LW_TYPE_I32},
	{
		.address = 506, .count = 1,
		.offset = offsetof(struct lw_status, reversal_plus_usteps), .type = LW_TYPE_I16,
	},
	{
		.address = 507, .count = 1,
		.offset = offsetof(struct lw_status, reversal_minus_usteps), .type = LW_TYPE_I16,
	},
	{
		.address = 508, .count = 1,
		.offset = offsetof(struct lw_status, overshoot_actual_um), .type = LW_TYPE_I32,
	},
	{
		.address = 510, .count = 1, .offset = offsetof(struct lw_status, slope_error_ppm),
		.type = LW_TYPE_I32,
	},
	{
		.address = 512, .count = 1,
		.offset = offsetof(struct lw_status, overshoot_error_um), .type = LW_TYPE_I32,
	},
	{
		.address = 514, .count = 1,
		.offset = offsetof(struct lw_status, edges_per_1000_drum_revs), .type = LW_TYPE_U32,
	},
	{
		.address = 516, .count = 1, .offset = offsetof(struct lw_status, dwell_plus_edges),
		.type = LW_TYPE_U32,
	},
	{
		.address = 518, .count = 1, .offset = offsetof(struct lw_status, dwell_minus_edges),
		.type = LW_TYPE_U32,
	},
	{
		.address = 520, .count = 1, .offset = offsetof(struct lw_status, breaker_edges),
		.type = LW_TYPE_U32,
	},
	{
		.address = 522, .count = 1,
		.offset = offsetof(struct lw_status, breaker_cycle_plus), .type = LW_TYPE_U16,
	},
	{
		.address = 523, .count = 1,
		.offset = offsetof(struct lw_status, breaker_cycle_minus), .type = LW_TYPE_U16,
	},
	{
		.address = 600, .count = 1, .offset = offsetof(struct lw_status, cam_bank_0_state),
		.type = LW_TYPE_U16,
	},
	{
		.address = 601, .count = 1, .offset = offsetof(struct lw_status, cam_bank_1_state),
		.type = LW_TYPE_U16,
	},
	{
		.address = 602, .count = 1, .offset = offsetof(struct lw_status, cam_reason),
		.type = LW_TYPE_U16,
	},
	{
		.address = 603, .count = 1, .offset = offsetof(struct lw_status, cam_reason_row),
		.type = LW_TYPE_U16,
	},
	{
		.address = 604, .count = 1, .offset = offsetof(struct lw_status, cam_reason_value),
		.type = LW_TYPE_I32,
	},
	{
		.address = 606, .count = 1, .offset = offsetof(struct lw_status, cam_reason_limit),
		.type = LW_TYPE_I32,
	},
	{
		.address = 608, .count = 1, .offset = offsetof(struct lw_status, cam_version),
		.type = LW_TYPE_U32,
	},
	{
		.address = 610, .count = 1, .offset = offsetof(struct lw_status, cam_stored),
		.type = LW_TYPE_U16,
	},
	{
		.address = 611, .count = 1, .offset = offsetof(struct lw_status, cam_rows),
		.type = LW_TYPE_U16,
	},
	{
		.address = 612, .count = 1, .offset = offsetof(struct lw_status, cam_cycle_edges),
		.type = LW_TYPE_U32,
	},
	{
		.address = 614, .count = 1, .offset = offsetof(struct lw_status, cam_min_usteps),
		.type = LW_TYPE_I32,
	},
	{
		.address = 616, .count = 1, .offset = offsetof(struct lw_status, cam_max_usteps),
		.type = LW_TYPE_I32,
	},
	{
		.address = 618, .count = 1,
		.offset = offsetof(struct lw_status, cam_slope_max_permille), .type = LW_TYPE_U16,
	},
	{
		.address = 619, .count = 1,
		.offset = offsetof(struct lw_status, cam_position_usteps), .type = LW_TYPE_I32,
	},
	{
		.address = 621, .count = 1, .offset = offsetof(struct lw_status, cam_row),
		.type = LW_TYPE_U16,
	},
	{
		.address = 622, .count = 1, .offset = offsetof(struct lw_status, cam_cycles),
		.type = LW_TYPE_I32,
	},
	{
		.address = 624, .count = 1,
		.offset = offsetof(struct lw_status, cam_phase_in_force_edges), .type = LW_TYPE_I32,
	},
	{
		.address = 626, .count = 1, .offset = offsetof(struct lw_status, cam_waiting),
		.type = LW_TYPE_U16,
	},
	{
		.address = 627, .count = 1, .offset = offsetof(struct lw_status, slot_4),
		.type = LW_TYPE_U16,
	},
	{
		.address = 628, .count = 1, .offset = offsetof(struct lw_status, slot_5),
		.type = LW_TYPE_U16,
	},
	{
		.address = 629, .count = 1, .offset = offsetof(struct lw_status, slot_6),
		.type = LW_TYPE_U16,
	},
	{
		.address = 630, .count = 1, .offset = offsetof(struct lw_status, slot_7),
		.type = LW_TYPE_U16,
	},
};

const struct lw_point lw_map_cam_upload[LW_MAP_CAM_UPLOAD_COUNT] = {
	{
		.address = 3000, .count = 8,
		.offset = offsetof(struct lw_cam_upload, cam_upload_name), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 65535, .default_value = 0,
	},
	{
		.address = 3008, .count = 1,
		.offset = offsetof(struct lw_cam_upload, cam_upload_version), .type = LW_TYPE_U32,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 2147483647, .default_value = 0,
	},
	{
		.address = 3010, .count = 1,
		.offset = offsetof(struct lw_cam_upload, cam_upload_interpolation),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 1,
		.default_value = 0,
	},
	{
		.address = 3011, .count = 1,
		.offset = offsetof(struct lw_cam_upload, cam_upload_row_count), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 65535, .default_value = 0,
	},
	{
		.address = 3012, .count = 1,
		.offset = offsetof(struct lw_cam_upload, cam_upload_advance), .type = LW_TYPE_I32,
		.flags = LW_POINT_WRITABLE, .min = -2147483647, .max = 2147483647,
		.default_value = 0,
	},
	{
		.address = 3014, .count = 2,
		.offset = offsetof(struct lw_cam_upload, cam_upload_crc), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 65535, .default_value = 0,
	},
	{
		.address = 3016, .count = 1,
		.offset = offsetof(struct lw_cam_upload, cam_upload_first_row), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 1, .max = 256, .default_value = 1,
	},
	{
		.address = 3018, .count = 60,
		.offset = offsetof(struct lw_cam_upload, cam_upload_rows), .type = LW_TYPE_I32,
		.flags = LW_POINT_WRITABLE, .min = -2147483647, .max = 2147483647,
		.default_value = 0,
	},
};

const struct lw_point lw_map_bench[LW_MAP_BENCH_COUNT] = {
	{
		.address = 61440, .count = 1, .offset = offsetof(struct lw_bench, bench_argument),
		.type = LW_TYPE_I32, .flags = LW_POINT_WRITABLE, .min = -10000000, .max = 10000000,
		.default_value = 0,
	},
	{
		.address = 61442, .count = 1, .offset = offsetof(struct lw_bench, bench_command),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .min = 0,
		.max = 10, .default_value = 0,
	},
	{
		.address = 61443, .count = 1,
		.offset = offsetof(struct lw_bench, bench_drum_speed_millirpm), .type = LW_TYPE_I32,
		.flags = LW_POINT_WRITABLE, .min = -3000000, .max = 3000000, .default_value = 0,
	},
	{
		.address = 61445, .count = 1,
		.offset = offsetof(struct lw_bench, bench_drum_acceleration_millirpm_per_s),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE, .min = 1, .max = 100000000,
		.default_value = 200000,
	},
	{
		.address = 61447, .count = 1,
		.offset = offsetof(struct lw_bench, bench_side_load_mm_per_s2), .type = LW_TYPE_I32,
		.flags = LW_POINT_WRITABLE, .min = -1000000, .max = 1000000, .default_value = 0,
	},
	{
		.address = 61449, .count = 1, .offset = offsetof(struct lw_bench, bench_stall),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 1,
		.default_value = 0,
	},
	{
		.address = 61450, .count = 1, .offset = offsetof(struct lw_bench, bench_bounce_ms),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 100,
		.default_value = 3,
	},
	{
		.address = 61451, .count = 1,
		.offset = offsetof(struct lw_bench, bench_switch_plus_fault), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 5, .default_value = 0,
	},
	{
		.address = 61452, .count = 1,
		.offset = offsetof(struct lw_bench, bench_switch_minus_fault), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 5, .default_value = 0,
	},
	{
		.address = 61453, .count = 1,
		.offset = offsetof(struct lw_bench, bench_overtravel_plus), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.address = 61454, .count = 1,
		.offset = offsetof(struct lw_bench, bench_overtravel_minus), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.address = 61455, .count = 1,
		.offset = offsetof(struct lw_bench, bench_direction_reversed), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.address = 61456, .count = 1,
		.offset = offsetof(struct lw_bench, bench_trigger_position_um), .type = LW_TYPE_I32,
		.flags = LW_POINT_WRITABLE, .min = -500000, .max = 500000, .default_value = 0,
	},
	{
		.address = 61458, .count = 1,
		.offset = offsetof(struct lw_bench, bench_trigger_direction), .type = LW_TYPE_I16,
		.flags = LW_POINT_WRITABLE, .min = -1, .max = 1, .default_value = 0,
	},
	{
		.address = 61459, .count = 1,
		.offset = offsetof(struct lw_bench, bench_trigger_argument), .type = LW_TYPE_I32,
		.flags = LW_POINT_WRITABLE, .min = -10000000, .max = 10000000, .default_value = 0,
	},
	{
		.address = 61461, .count = 1,
		.offset = offsetof(struct lw_bench, bench_trigger_fault), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 3, .default_value = 0,
	},
	{
		.address = 61462, .count = 1,
		.offset = offsetof(struct lw_bench, bench_stepper_alarm), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.address = 61463, .count = 1, .offset = offsetof(struct lw_bench, bench_hang),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 5,
		.default_value = 0,
	},
	{
		.address = 61464, .count = 1, .offset = offsetof(struct lw_bench, bench_restart),
		.type = LW_TYPE_U16,
	},
	{
		.address = 61465, .count = 1, .offset = offsetof(struct lw_bench, bench_trim_early),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 1,
		.default_value = 0,
	},
	{
		.address = 61466, .count = 1, .offset = offsetof(struct lw_bench, bench_trim_late),
		.type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .min = 0, .max = 1,
		.default_value = 0,
	},
	{
		.address = 61469, .count = 1, .offset = offsetof(struct lw_bench, bench_result),
		.type = LW_TYPE_U16,
	},
	{
		.address = 61470, .count = 1,
		.offset = offsetof(struct lw_bench, bench_carriage_um), .type = LW_TYPE_I32,
	},
	{
		.address = 61472, .count = 1,
		.offset = offsetof(struct lw_bench, bench_carriage_mm_per_s), .type = LW_TYPE_I32,
	},
	{
		.address = 61474, .count = 1,
		.offset = offsetof(struct lw_bench, bench_commanded_usteps), .type = LW_TYPE_I32,
	},
	{
		.address = 61476, .count = 1,
		.offset = offsetof(struct lw_bench, bench_slipped_usteps), .type = LW_TYPE_I32,
	},
	{
		.address = 61478, .count = 1,
		.offset = offsetof(struct lw_bench, bench_transitions), .type = LW_TYPE_I64,
	},
	{
		.address = 61482, .count = 1,
		.offset = offsetof(struct lw_bench, bench_drum_actual_millirpm),
		.type = LW_TYPE_I32,
	},
	{
		.address = 61484, .count = 1,
		.offset = offsetof(struct lw_bench, bench_profile_points), .type = LW_TYPE_U16,
	},
	{
		.address = 61485, .count = 1,
		.offset = offsetof(struct lw_bench, bench_profile_running), .type = LW_TYPE_U16,
	},
	{
		.address = 61486, .count = 1, .offset = offsetof(struct lw_bench, bench_time_ms),
		.type = LW_TYPE_U32,
	},
	{
		.address = 61500, .count = 60, .offset = offsetof(struct lw_bench, bench_profile),
		.type = LW_TYPE_I32, .flags = LW_POINT_WRITABLE, .min = -3000000, .max = 100000000,
		.default_value = 0,
	},
	{
		.address = 61620, .count = 1,
		.offset = offsetof(struct lw_bench, bench_encoder_a_fault), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 3, .default_value = 0,
	},
	{
		.address = 61621, .count = 1,
		.offset = offsetof(struct lw_bench, bench_encoder_b_fault), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 3, .default_value = 0,
	},
	{
		.address = 61622, .count = 1,
		.offset = offsetof(struct lw_bench, bench_index_pulses), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 1, .default_value = 1,
	},
	{
		.address = 61623, .count = 1,
		.offset = offsetof(struct lw_bench, bench_rope_layer_um), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 50000, .default_value = 0,
	},
	{
		.address = 61624, .count = 1,
		.offset = offsetof(struct lw_bench, bench_rope_layer_milliturns),
		.type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE, .min = 1, .max = 100000000,
		.default_value = 33000,
	},
	{
		.address = 61626, .count = 1,
		.offset = offsetof(struct lw_bench, bench_rope_core_um), .type = LW_TYPE_U32,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 5000000, .default_value = 0,
	},
	{
		.address = 61628, .count = 1, .offset = offsetof(struct lw_bench, bench_rope_mm),
		.type = LW_TYPE_I32,
	},
	{
		.address = 61630, .count = 1,
		.offset = offsetof(struct lw_bench, bench_switch_late_us), .type = LW_TYPE_U16,
		.flags = LW_POINT_WRITABLE, .min = 0, .max = 20000, .default_value = 500,
	},
};

const struct lw_point lw_map_coils[LW_MAP_COILS_COUNT] = {
	{
		.address = 0, .count = 1, .offset = 0, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
	{
		.address = 1, .count = 1, .offset = 1, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
	{
		.address = 2, .count = 1, .offset = 2, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
	{
		.address = 3, .count = 1, .offset = 3, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
	{
		.address = 4, .count = 1, .offset = 4, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
	{
		.address = 5, .count = 1, .offset = 5, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
	{
		.address = 6, .count = 1, .offset = 6, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE, .max = 1,
	},
	{
		.address = 7, .count = 1, .offset = 7, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE, .max = 1,
	},
	{
		.address = 8, .count = 1, .offset = 8, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
	{
		.address = 9, .count = 1, .offset = 9, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
	{
		.address = 10, .count = 1, .offset = 10, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
	{
		.address = 11, .count = 1, .offset = 11, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
	{
		.address = 12, .count = 1, .offset = 12, .type = LW_TYPE_BIT,
		.flags = LW_POINT_WRITABLE | LW_POINT_COMMAND, .max = 1,
	},
};

const struct lw_point lw_map_discretes[LW_MAP_DISCRETES_COUNT] = {
	{.address = 0, .count = 1, .offset = 0, .type = LW_TYPE_BIT},
	{.address = 1, .count = 1, .offset = 1, .type = LW_TYPE_BIT},
	{.address = 2, .count = 1, .offset = 2, .type = LW_TYPE_BIT},
	{.address = 3, .count = 1, .offset = 3, .type = LW_TYPE_BIT},
	{.address = 4, .count = 1, .offset = 4, .type = LW_TYPE_BIT},
	{.address = 5, .count = 1, .offset = 5, .type = LW_TYPE_BIT},
	{.address = 6, .count = 1, .offset = 6, .type = LW_TYPE_BIT},
	{.address = 7, .count = 1, .offset = 7, .type = LW_TYPE_BIT},
	{.address = 8, .count = 1, .offset = 8, .type = LW_TYPE_BIT},
	{.address = 9, .count = 1, .offset = 9, .type = LW_TYPE_BIT},
	{.address = 10, .count = 1, .offset = 10, .type = LW_TYPE_BIT},
	{.address = 11, .count = 1, .offset = 11, .type = LW_TYPE_BIT},
	{.address = 12, .count = 1, .offset = 12, .type = LW_TYPE_BIT},
	{.address = 13, .count = 1, .offset = 13, .type = LW_TYPE_BIT},
	{.address = 14, .count = 1, .offset = 14, .type = LW_TYPE_BIT},
	{.address = 15, .count = 1, .offset = 15, .type = LW_TYPE_BIT},
	{.address = 16, .count = 1, .offset = 16, .type = LW_TYPE_BIT},
	{.address = 17, .count = 1, .offset = 17, .type = LW_TYPE_BIT},
	{.address = 18, .count = 1, .offset = 18, .type = LW_TYPE_BIT},
	{.address = 19, .count = 1, .offset = 19, .type = LW_TYPE_BIT},
	{.address = 20, .count = 1, .offset = 20, .type = LW_TYPE_BIT},
	{.address = 21, .count = 1, .offset = 21, .type = LW_TYPE_BIT},
	{.address = 22, .count = 1, .offset = 22, .type = LW_TYPE_BIT},
	{.address = 23, .count = 1, .offset = 23, .type = LW_TYPE_BIT},
	{.address = 24, .count = 1, .offset = 24, .type = LW_TYPE_BIT},
	{.address = 25, .count = 1, .offset = 25, .type = LW_TYPE_BIT},
	{.address = 26, .count = 1, .offset = 26, .type = LW_TYPE_BIT},
	{.address = 27, .count = 1, .offset = 27, .type = LW_TYPE_BIT},
	{.address = 28, .count = 1, .offset = 28, .type = LW_TYPE_BIT},
	{.address = 29, .count = 1, .offset = 29, .type = LW_TYPE_BIT},
	{.address = 30, .count = 1, .offset = 30, .type = LW_TYPE_BIT},
	{.address = 31, .count = 1, .offset = 31, .type = LW_TYPE_BIT},
	{.address = 32, .count = 1, .offset = 0, .type = LW_TYPE_BIT},
	{.address = 33, .count = 1, .offset = 1, .type = LW_TYPE_BIT},
	{.address = 34, .count = 1, .offset = 2, .type = LW_TYPE_BIT},
	{.address = 35, .count = 1, .offset = 3, .type = LW_TYPE_BIT},
	{.address = 36, .count = 1, .offset = 4, .type = LW_TYPE_BIT},
	{.address = 37, .count = 1, .offset = 5, .type = LW_TYPE_BIT},
	{.address = 38, .count = 1, .offset = 6, .type = LW_TYPE_BIT},
	{.address = 39, .count = 1, .offset = 7, .type = LW_TYPE_BIT},
	{.address = 40, .count = 1, .offset = 8, .type = LW_TYPE_BIT},
	{.address = 41, .count = 1, .offset = 9, .type = LW_TYPE_BIT},
	{.address = 42, .count = 1, .offset = 10, .type = LW_TYPE_BIT},
	{.address = 43, .count = 1, .offset = 11, .type = LW_TYPE_BIT},
	{.address = 44, .count = 1, .offset = 12, .type = LW_TYPE_BIT},
};

const uint8_t lw_map_coil_command[LW_MAP_COILS_COUNT] = {
	[LW_ADDRESS_INDEX] = LW_COMMAND_INDEX,
	[LW_ADDRESS_STOP] = LW_COMMAND_STOP,
	[LW_ADDRESS_CLEAR_FAULT] = LW_COMMAND_CLEAR_FAULT,
	[LW_ADDRESS_APPLY] = LW_COMMAND_APPLY,
	[LW_ADDRESS_REVERT] = LW_COMMAND_REVERT,
	[LW_ADDRESS_SAVE] = LW_COMMAND_SAVE,
	[LW_ADDRESS_JOG_PLUS] = 0,
	[LW_ADDRESS_JOG_MINUS] = 0,
	[LW_ADDRESS_ACKNOWLEDGE_ROPE] = LW_COMMAND_ACKNOWLEDGE_ROPE,
	[LW_ADDRESS_SET_ROPE] = LW_COMMAND_SET_ROPE,
	[LW_ADDRESS_TRIM_EARLY] = LW_COMMAND_TRIM_EARLY,
	[LW_ADDRESS_TRIM_LATE] = LW_COMMAND_TRIM_LATE,
	[LW_ADDRESS_REACQUIRE] = LW_COMMAND_REACQUIRE,
};

const int8_t lw_map_coil_jog[LW_MAP_COILS_COUNT] = {
	[LW_ADDRESS_JOG_PLUS] = 1,
	[LW_ADDRESS_JOG_MINUS] = -1,
};

const struct lw_params lw_params_default = {
	.encoder_pulses_per_rev = 360,
	.encoder_edges_per_pulse = 2,
	.encoder_ratio_numerator = 4,
	.encoder_ratio_denominator = 1,
	.encoder_invert_a = 0,
	.encoder_invert_b = 0,
	.drum_direction_invert = 0,
	.rope_per_drum_rev_um = 2400000,
	.screw_lead_um = 20000,
	.microsteps_per_rev = 2000,
	.carriage_direction_invert = 0,
	.pitch_um = 12000,
	.overshoot_um = 2500,
	.slope_tolerance_ppm = 500,
	.reversal_plus_um = 80000,
	.reversal_minus_um = -80000,
	.flange_plus_um = 83000,
	.flange_minus_um = -83000,
	.switch_plus_um = 78400,
	.switch_minus_um = -78400,
	.switch_tolerance_um = 1000,
	.switch_hysteresis_um = 1500,
	.switch_contacts = 0,
	.switch_transit_ms = 20,
	.switch_debounce_ms = 5,
	.travel_um = 180000,
	.switch_delay_us = 0,
	.index_switch = 0,
	.index_rate_edges_per_s = 10000,
	.park_at = 0,
	.park_position_um = 0,
	.span_tolerance_um = 1000,
	.handover_direction = 0,
	.rest_edges_per_s = 50,
	.rest_time_ms = 200,
	.centre_position_um = 0,
	.jog_rate_edges_per_s = 5000,
	.jog_hold_ms = 500,
	.los_recoveries_max = 3,
	.overspeed_warning_edges_per_s = 52000,
	.overspeed_trip_edges_per_s = 60000,
	.master_timeout_ms = 0,
	.dwell_plus_millirev = 0,
	.dwell_minus_millirev = 0,
	.breaker_millirev = 0,
	.breaker_cycles = 0,
	.expert_mode = 0,
	.raw_ka = 23,
	.raw_nr = 1187,
	.raw_reversal_plus_usteps = 8000,
	.raw_reversal_minus_usteps = -8000,
	.unit_id = 1,
	.baud_rate = 19200,
	.line_format = 0,
	.lock_code = 0,
	.lock_timeout_s = 300,
	.line_confirm_s = 10,
	.encoder_watch_transitions_per_s = 2000,
	.encoder_watch_ms = 500,
	.encoder_illegal_permille = 10,
	.drum_watch_ms = 0,
	.standing_turns_permille = 250,
	.rope_diameter_um = 0,
	.drum_core_diameter_um = 0,
	.rope_packing_permille = 0,
	.trim_step_um = 500,
	.resume = 0,
	.reacquire_after_restart = 0,
	.accepted_crc = 0,
	.motion_profile = 0,
	.cam_start = 0,
	.cam_master_edges = 1,
	.cam_master_units = 1,
	.cam_slave_usteps = 1,
	.cam_slave_units = 1,
	.cam_ramp_divisor = 10,
	.cam_axis = 0,
	.cam_steps_per_s_max = 200000,
};
