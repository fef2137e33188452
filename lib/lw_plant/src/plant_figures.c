/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief The figures of a machine by name.
 */
#include "lw/plant_figures.h"

#include <errno.h>
#include <math.h>
#include <string.h>

/** How a member holds its figure. */
enum kind {
	KIND_U32,
	KIND_I32,
	KIND_DOUBLE,
	KIND_BOOL,
	KIND_U8,
};

struct member {
	size_t offset;
	enum kind kind;
	double scale; /* the member is the figure times this */
};

#define PER_THOUSAND 1000.0

static const char *const no_or_yes[] = {"false", "true", NULL};
/* As in modbus_map/registers.yaml, whose names a bench register takes. */
static const char *const switch_words[] = {
	"none", "stuck_released", "stuck_actuated", "no_wire_broken", "nc_wire_broken", "shorted",
	NULL};
static const char *const overtravel_words[] = {"none", "stuck_released", "stuck_actuated", NULL};
static const char *const channel_words[] = {"none", "stuck_low", "stuck_high", "flicker", NULL};

#define FIGURES(X)                                                                                 \
	X("encoder_pulses_per_rev", encoder_pulses_per_rev, KIND_U32, 1, 1, 100000, NULL)          \
	X("encoder_ratio_numerator", encoder_revs_per_drum_rev_num, KIND_U32, 1, 1, 1000, NULL)    \
	X("encoder_ratio_denominator", encoder_revs_per_drum_rev_den, KIND_U32, 1, 1, 1000, NULL)  \
	X("screw_lead_mm", screw_lead_um, KIND_U32, PER_THOUSAND, 0.1, 1000, NULL)                 \
	X("microsteps_per_rev", usteps_per_rev, KIND_U32, 1, 50, 1000000, NULL)                    \
	X("full_steps_per_rev", full_steps_per_rev, KIND_U32, 1, 4, 1000, NULL)                    \
	X("holding_acceleration_mm_per_s2", holding_acceleration_mm_per_s2, KIND_DOUBLE, 1, 1,     \
	  1000000, NULL)                                                                           \
	X("half_torque_speed_mm_per_s", half_torque_speed_mm_per_s, KIND_DOUBLE, 1, 0.1, 100000,   \
	  NULL)                                                                                    \
	X("top_speed_mm_per_s", top_speed_mm_per_s, KIND_DOUBLE, 1, 0, 100000, NULL)               \
	X("damping_ratio", damping_ratio, KIND_DOUBLE, 1, 0, 10, NULL)                             \
	X("friction_mm_per_s2", friction_mm_per_s2, KIND_DOUBLE, 1, 0, 1000000, NULL)              \
	X("start_mm", start_um, KIND_I32, PER_THOUSAND, -10000, 10000, NULL)                       \
	X("end_stop_mm", flange_um, KIND_I32, PER_THOUSAND, 1, 10000, NULL)                        \
	X("overtravel_mm", overtravel_um, KIND_I32, PER_THOUSAND, 1, 10000, NULL)                  \
	X("switch_plus_mm", limit_um[LW_PLANT_PLUS], KIND_I32, PER_THOUSAND, -10000, 10000, NULL)  \
	X("switch_minus_mm", limit_um[LW_PLANT_MINUS], KIND_I32, PER_THOUSAND, -10000, 10000,      \
	  NULL)                                                                                    \
	X("switch_hysteresis_mm", switch_hysteresis_um, KIND_I32, PER_THOUSAND, 0, 100, NULL)      \
	X("switch_late_ms", limit_shift_um_per_mm_per_s, KIND_DOUBLE, 1, 0, 1000, NULL)            \
	X("contact_travel_ms", contact_transit_us, KIND_U32, PER_THOUSAND, 0, 1000, NULL)          \
	X("bounce_ms", bounce_duration_us, KIND_U32, PER_THOUSAND, 0, 1000, NULL)                  \
	X("bounce_interval_ms", bounce_interval_us, KIND_U32, PER_THOUSAND, 0.001, 1000, NULL)     \
	X("backlash_mm", backlash_um, KIND_DOUBLE, PER_THOUSAND, 0, 100, NULL)                     \
	X("coupling_grip_mm_per_s2", coupling_grip_mm_per_s2, KIND_DOUBLE, 1, 0, 1000000, NULL)    \
	X("switch_plus_scatter_mm", limit_scatter_um[LW_PLANT_PLUS], KIND_DOUBLE, PER_THOUSAND, 0, \
	  10, NULL)                                                                                \
	X("switch_minus_scatter_mm", limit_scatter_um[LW_PLANT_MINUS], KIND_DOUBLE, PER_THOUSAND,  \
	  0, 10, NULL)                                                                             \
	X("switch_plus_drift_mm", limit_drift_um[LW_PLANT_PLUS], KIND_DOUBLE, PER_THOUSAND, -10,   \
	  10, NULL)                                                                                \
	X("switch_minus_drift_mm", limit_drift_um[LW_PLANT_MINUS], KIND_DOUBLE, PER_THOUSAND, -10, \
	  10, NULL)                                                                                \
	X("line_errors_ppm", line_errors_ppm, KIND_U32, 1, 0, 1000000, NULL)                       \
	X("line_errors_moving_ppm", line_errors_moving_ppm, KIND_U32, 1, 0, 1000000, NULL)         \
	X("motor_reversed", carriage_reversed, KIND_BOOL, 1, 0, 1, no_or_yes)                      \
	X("encoder_channels_swapped", encoder_swapped, KIND_BOOL, 1, 0, 1, no_or_yes)              \
	X("encoder_a_inverted", encoder_inverted[0], KIND_BOOL, 1, 0, 1, no_or_yes)                \
	X("encoder_b_inverted", encoder_inverted[1], KIND_BOOL, 1, 0, 1, no_or_yes)                \
	X("encoder_a_fault", encoder_fault[0], KIND_U8, 1, 0, 3, channel_words)                    \
	X("encoder_b_fault", encoder_fault[1], KIND_U8, 1, 0, 3, channel_words)                    \
	X("encoder_index_open", encoder_index_open, KIND_BOOL, 1, 0, 1, no_or_yes)                 \
	X("limit_switches_swapped", limit_swapped, KIND_BOOL, 1, 0, 1, no_or_yes)                  \
	X("overtravel_switches_swapped", overtravel_swapped, KIND_BOOL, 1, 0, 1, no_or_yes)        \
	X("switch_plus_contacts_swapped", limit_contacts_swapped[LW_PLANT_PLUS], KIND_BOOL, 1, 0,  \
	  1, no_or_yes)                                                                            \
	X("switch_minus_contacts_swapped", limit_contacts_swapped[LW_PLANT_MINUS], KIND_BOOL, 1,   \
	  0, 1, no_or_yes)                                                                         \
	X("switch_plus_fault", limit_fault[LW_PLANT_PLUS], KIND_U8, 1, 0, 5, switch_words)         \
	X("switch_minus_fault", limit_fault[LW_PLANT_MINUS], KIND_U8, 1, 0, 5, switch_words)       \
	X("overtravel_plus_fault", overtravel_fault[LW_PLANT_PLUS], KIND_U8, 1, 0, 2,              \
	  overtravel_words)                                                                        \
	X("overtravel_minus_fault", overtravel_fault[LW_PLANT_MINUS], KIND_U8, 1, 0, 2,            \
	  overtravel_words)

#define IS_WHOLE(kind, scale) ((kind) != KIND_DOUBLE && (scale) == 1)

#define FIGURE(name, member, kind, scale, min, max, words)                                         \
	{name, min, max, words, IS_WHOLE(kind, scale)},
#define MEMBER(name, member, kind, scale, min, max, words)                                         \
	{offsetof(struct lw_plant_config, member), kind, scale},

const struct lw_plant_figure lw_plant_figures[] = {FIGURES(FIGURE){NULL, 0, 0, NULL, false}};

static const struct member members[] = {FIGURES(MEMBER)};

/** The figure's place in both tables, or -1. */
static int place_of(const char *name)
{
	for (int i = 0; lw_plant_figures[i].name != NULL; i++) {
		if (strcmp(lw_plant_figures[i].name, name) == 0) {
			return i;
		}
	}
	return -1;
}

int lw_plant_config_set(struct lw_plant_config *config, const char *name, double value)
{
	const int place = place_of(name);

	if (place < 0) {
		return -ENOENT;
	}

	const struct lw_plant_figure *figure = &lw_plant_figures[place];
	char *at = (char *)config + members[place].offset;
	const double scaled = value * members[place].scale;

	if (!(value >= figure->min && value <= figure->max) ||
	    (figure->whole && value != floor(value))) {
		return -ERANGE;
	}
	switch (members[place].kind) {
	case KIND_U32:
		*(uint32_t *)(void *)at = (uint32_t)llround(scaled);
		break;
	case KIND_I32:
		*(int32_t *)(void *)at = (int32_t)llround(scaled);
		break;
	case KIND_DOUBLE:
		*(double *)(void *)at = scaled;
		break;
	case KIND_BOOL:
		*(bool *)(void *)at = value != 0.0;
		break;
	case KIND_U8:
		*(uint8_t *)(void *)at = (uint8_t)value;
		break;
	}
	return 0;
}

int lw_plant_config_get(const struct lw_plant_config *config, const char *name, double *value)
{
	const int place = place_of(name);

	if (place < 0) {
		return -ENOENT;
	}

	const char *at = (const char *)config + members[place].offset;

	switch (members[place].kind) {
	case KIND_U32:
		*value = *(const uint32_t *)(const void *)at;
		break;
	case KIND_I32:
		*value = *(const int32_t *)(const void *)at;
		break;
	case KIND_DOUBLE:
		*value = *(const double *)(const void *)at;
		break;
	case KIND_BOOL:
		*value = *(const bool *)(const void *)at;
		break;
	case KIND_U8:
		*value = *(const uint8_t *)(const void *)at;
		break;
	}
	*value /= members[place].scale;
	return 0;
}
