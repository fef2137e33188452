/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief The drum and its encoder.
 *
 * The speed is constant over a substep, the mean of its values at both ends, so that the position
 * at the ends is exact for linear speeds and a transition costs one addition.
 */
#include <errno.h>
#include <math.h>
#include <stdlib.h>

#include "plant_internal.h"

#define TRANSITIONS_PER_PULSE          4
#define TRANSITIONS_PER_ILLEGAL_CHANGE 2
#define MILLI_RPM_PER_RPM              1000.0
#define MILLI_RPM_S_PER_REV            60000.0
#define FLICKER_MIN_NS                 1000000u
#define FLICKER_RANGE_NS               2000000u
#define PI                             3.14159265358979323846

/**
 * Seen as transitions modulo 4, swapped channels are the position's negative; channel A inverted
 * shows 1 less the position, B inverted 3 less.
 */
static void wire_encoder(struct lw_plant_drum *drum, const struct lw_plant_config *config)
{
	drum->wired_direction = 1;
	if (config->encoder_swapped) {
		drum->wired_direction = -1;
	}
	for (int channel = 0; channel < 2; channel++) {
		if (config->encoder_inverted[channel]) {
			drum->wired_direction = (int8_t)-drum->wired_direction;
			drum->wired_offset =
				(uint8_t)(((channel == 0 ? 1u : 3u) - drum->wired_offset) & 3u);
		}
	}
}

/** What arrives at the pin of a channel. */
static bool through_wire(const struct lw_plant_drum *drum, int channel, bool level)
{
	switch (drum->channel_fault[channel]) {
	case LW_PLANT_CHANNEL_STUCK_LOW:
		return false;
	case LW_PLANT_CHANNEL_STUCK_HIGH:
		return true;
	default:
		return level && !drum->channel_open[channel];
	}
}

/** Note what arrives at the pins. A leads B for rising positions: 00, 10, 11, 01. */
static void note_wires(struct lw_plant_drum *drum)
{
	for (unsigned int shown = 0; shown < 4; shown++) {
		const unsigned int a = through_wire(drum, 0, ((shown ^ shown >> 1) & 1u) != 0);
		const unsigned int b = through_wire(drum, 1, (shown >> 1 & 1u) != 0);

		drum->levels[shown] = (uint8_t)(a << 1 | b);
	}
}

void lw_plant_drum_init(struct lw_plant_drum *drum, const struct lw_plant_config *config)
{
	double transitions_per_rev =
		(double)TRANSITIONS_PER_PULSE * config->encoder_pulses_per_rev *
		config->encoder_revs_per_drum_rev_num / config->encoder_revs_per_drum_rev_den;

	*drum = (struct lw_plant_drum){
		.transition_ns = LW_PLANT_NEVER_NS,
		.dither_ns = LW_PLANT_NEVER_NS,
		.flicker_ns = LW_PLANT_NEVER_NS,
		.transitions_per_milli_rpm_s = transitions_per_rev / MILLI_RPM_S_PER_REV,
		.acceleration_milli_rpm_per_s =
			config->drum_acceleration_rpm_per_s * MILLI_RPM_PER_RPM,
		.transitions_per_encoder_rev =
			TRANSITIONS_PER_PULSE * (int32_t)config->encoder_pulses_per_rev,
		.past_index = (TRANSITIONS_PER_PULSE / 2) * (int32_t)config->encoder_pulses_per_rev,
		/* Half-way between two transitions: a fresh encoder does not sit on an edge. */
		.fraction = 0.5,
		.index_open = config->encoder_index_open,
	};
	wire_encoder(drum, config);
	note_wires(drum);
	for (int channel = 0; channel < 2; channel++) {
		if (config->encoder_fault[channel] != LW_PLANT_CHANNEL_OK) {
			lw_plant_drum_channel(drum, channel, config->encoder_fault[channel], 0);
		}
	}
}

/** The profile's speed at a time; the profile ends with its last point. */
static double profile_milli_rpm(struct lw_plant_drum *drum, uint64_t time_ns)
{
	const struct lw_plant_profile_point *point = &drum->profile[drum->profile_index];
	uint64_t elapsed_ns = time_ns - drum->profile_start_ns;

	while (drum->profile_index + 1 < drum->profile_count &&
	       elapsed_ns >= (uint64_t)point[1].time_ms * NS_PER_MS) {
		drum->profile_index++;
		point++;
	}
	if (drum->profile_index + 1 == drum->profile_count &&
	    elapsed_ns >= (uint64_t)point->time_ms * NS_PER_MS) {
		drum->target_milli_rpm = point->drum_milli_rpm;
		drum->profile = NULL;
		return point->drum_milli_rpm;
	}

	uint64_t begin_ns = (uint64_t)point->time_ms * NS_PER_MS;

	if (elapsed_ns <= begin_ns) {
		return point->drum_milli_rpm;
	}

	double part = (double)(elapsed_ns - begin_ns) /
		      ((double)(point[1].time_ms - point->time_ms) * NS_PER_MS);

	return point->drum_milli_rpm +
	       part * ((double)point[1].drum_milli_rpm - point->drum_milli_rpm);
}

static double next_speed_milli_rpm(struct lw_plant_drum *drum, uint64_t begin_ns)
{
	if (drum->profile != NULL) {
		if (begin_ns == drum->profile_start_ns) {
			drum->speed_milli_rpm = drum->profile[0].drum_milli_rpm;
		}
		return profile_milli_rpm(drum, begin_ns + LW_PLANT_SUBSTEP_NS);
	}

	double most = drum->acceleration_milli_rpm_per_s * SUBSTEP_S;
	double missing = drum->target_milli_rpm - drum->speed_milli_rpm;

	return fabs(missing) <= most ? drum->target_milli_rpm
				     : drum->speed_milli_rpm + copysign(most, missing);
}

void lw_plant_drum_substep(struct lw_plant_drum *drum, uint64_t begin_ns)
{
	double end_milli_rpm = next_speed_milli_rpm(drum, begin_ns);
	double mean_milli_rpm = (drum->speed_milli_rpm + end_milli_rpm) / 2.0;
	double moves = mean_milli_rpm * drum->transitions_per_milli_rpm_s * SUBSTEP_S;

	drum->fraction += drum->moved_transitions - drum->direction * (double)drum->passed;
	drum->passed = 0;
	drum->speed_milli_rpm = end_milli_rpm;
	if (moves == 0.0) {
		drum->moved_transitions = 0.0;
		drum->transition_ns = LW_PLANT_NEVER_NS;
		return;
	}
	if (moves != drum->moved_transitions) {
		drum->moved_transitions = moves;
		drum->direction = moves > 0.0 ? 1 : -1;
		drum->period_ns = LW_PLANT_SUBSTEP_NS / fabs(moves);
		drum->per_ns = fabs(moves) / LW_PLANT_SUBSTEP_NS;
	}

	double missing = moves > 0.0 ? 1.0 - drum->fraction : drum->fraction;

	if (missing < 0.0) {
		missing = 0.0; /* the last substep's have missed its end by a rounding error */
	}
	drum->first_ns = missing * drum->period_ns;
	lw_plant_plan_transition(drum, begin_ns);
}

static inline uint32_t show(struct lw_plant *plant, int64_t transitions)
{
	const struct lw_plant_drum *drum = &plant->drum;
	const uint32_t shown =
		(uint32_t)(drum->wired_direction *
				   (transitions + drum->extra_transitions + drum->dithered) +
			   drum->wired_offset);
	const bool a = drum->levels[shown & 3u] >> 1;
	const bool b = drum->levels[shown & 3u] & 1u;
	const uint32_t changed = (a != plant->pins.encoder_a ? LW_PLANT_ENCODER_A : 0) |
				 (b != plant->pins.encoder_b ? LW_PLANT_ENCODER_B : 0);

	plant->pins.encoder_a = a;
	plant->pins.encoder_b = b;
	return changed;
}

/**
 * While a fault hides transitions the pins hold a past position, until the drum is a whole number
 * of pulses (nothing to see), or two transitions (both channels change), away from it.
 */
static inline int64_t shown_transitions(struct lw_plant_drum *drum)
{
	if (drum->lose_pulses == 0 && drum->illegal_changes == 0) {
		return drum->transitions;
	}

	int64_t distance = llabs(drum->transitions - drum->held_transitions);

	if (drum->lose_pulses > 0 && distance >= TRANSITIONS_PER_PULSE) {
		drum->lose_pulses--;
		drum->held_transitions = drum->transitions;
	} else if (drum->lose_pulses == 0 && distance >= TRANSITIONS_PER_ILLEGAL_CHANGE) {
		drum->illegal_changes--;
		drum->held_transitions = drum->transitions;
	}
	return drum->held_transitions;
}

static uint32_t show_index(struct lw_plant *plant)
{
	const bool level = plant->drum.past_index == 0 && !plant->drum.index_open;
	const bool changed = level != plant->pins.encoder_index;

	plant->pins.encoder_index = level;
	return changed ? LW_PLANT_ENCODER_INDEX : 0;
}

/** The index is the encoder's truth: no fault of a channel hides it. */
static uint32_t pass_index(struct lw_plant *plant)
{
	struct lw_plant_drum *drum = &plant->drum;

	drum->past_index += drum->direction;
	if (drum->past_index == drum->transitions_per_encoder_rev) {
		drum->past_index = 0;
	} else if (drum->past_index < 0) {
		drum->past_index = drum->transitions_per_encoder_rev - 1;
	}
	return show_index(plant);
}

uint32_t lw_plant_drum_transition(struct lw_plant *plant)
{
	struct lw_plant_drum *drum = &plant->drum;

	drum->transitions += drum->direction;
	drum->passed++;
	lw_plant_plan_transition(drum, substep_begin_ns(plant));
	return show(plant, shown_transitions(drum)) | pass_index(plant);
}

uint32_t lw_plant_drum_dither(struct lw_plant *plant)
{
	struct lw_plant_drum *drum = &plant->drum;

	if (drum->extra_changes > 0) {
		drum->extra_changes--;
		drum->extra_transitions++;
	} else if (drum->dither_changes > 0) {
		drum->dither_changes--;
		drum->dithered = !drum->dithered;
	} else {
		drum->dither_ns = LW_PLANT_NEVER_NS;
		return 0;
	}
	drum->dither_ns = plant->now_ns + DITHER_INTERVAL_NS;
	return show(plant, shown_transitions(drum));
}

void lw_plant_drum_channel(struct lw_plant_drum *drum, int channel, uint8_t fault, uint64_t now_ns)
{
	drum->channel_fault[channel] = fault;
	drum->channel_open[channel] = false;
	drum->flicker_ns = drum->channel_fault[0] == LW_PLANT_CHANNEL_FLICKER ||
					   drum->channel_fault[1] == LW_PLANT_CHANNEL_FLICKER
				   ? now_ns
				   : LW_PLANT_NEVER_NS;
	drum->wires_changed = true;
	note_wires(drum);
}

void lw_plant_drum_show(struct lw_plant *plant)
{
	(void)show(plant, plant->drum.transitions);
}

uint32_t lw_plant_drum_wires(struct lw_plant *plant)
{
	struct lw_plant_drum *drum = &plant->drum;

	if (drum->flicker_ns <= plant->now_ns) {
		drum->flicker_ns =
			plant->now_ns + FLICKER_MIN_NS + lw_plant_random(plant, FLICKER_RANGE_NS);
		for (int channel = 0; channel < 2; channel++) {
			drum->channel_open[channel] =
				drum->channel_fault[channel] == LW_PLANT_CHANNEL_FLICKER &&
				!drum->channel_open[channel];
		}
		note_wires(drum);
	} else if (!drum->wires_changed) {
		return 0;
	}
	drum->wires_changed = false;
	return show(plant, drum->lose_pulses == 0 && drum->illegal_changes == 0
				   ? drum->transitions
				   : drum->held_transitions) |
	       show_index(plant);
}

void lw_plant_drum_note_plain(struct lw_plant_drum *drum)
{
	drum->plain = drum->lose_pulses == 0 && drum->illegal_changes == 0 &&
		      drum->channel_fault[0] == LW_PLANT_CHANNEL_OK &&
		      drum->channel_fault[1] == LW_PLANT_CHANNEL_OK;
	drum->shown_ahead = drum->extra_transitions + drum->dithered;
}

int lw_plant_set_rope(struct lw_plant *plant, const struct lw_plant_rope *rope)
{
	if (!isfinite(rope->layer_um) || rope->layer_um < 0.0 || !isfinite(rope->turns_per_layer) ||
	    rope->turns_per_layer <= 0.0 || !isfinite(rope->core_um) || rope->core_um < 0.0) {
		return -ERANGE;
	}
	plant->rope = *rope;
	return 0;
}

double lw_plant_rope_um(const struct lw_plant *plant)
{
	const struct lw_plant_rope *rope = &plant->rope;
	double turns_left = (double)plant->drum.transitions /
			    (plant->drum.transitions_per_milli_rpm_s * MILLI_RPM_S_PER_REV);
	/* The rope's middle lies half a layer above what is below it. */
	double diameter_um = rope->core_um + rope->layer_um;
	double um = 0.0;

	if (turns_left < 0.0 || rope->layer_um == 0.0) {
		return PI * rope->core_um * turns_left;
	}
	while (turns_left > 0.0) {
		double turns = fmin(turns_left, rope->turns_per_layer);

		um += PI * diameter_um * turns;
		turns_left -= turns;
		diameter_um += 2.0 * rope->layer_um;
	}
	return um;
}

static bool milli_rpm_in_range(int32_t drum_milli_rpm)
{
	return drum_milli_rpm >= -LW_PLANT_DRUM_MILLI_RPM_MAX &&
	       drum_milli_rpm <= LW_PLANT_DRUM_MILLI_RPM_MAX;
}

int lw_plant_drum_target(struct lw_plant *plant, int32_t drum_milli_rpm)
{
	if (!milli_rpm_in_range(drum_milli_rpm)) {
		return -ERANGE;
	}
	plant->drum.profile = NULL;
	plant->drum.target_milli_rpm = drum_milli_rpm;
	return 0;
}

int lw_plant_drum_acceleration(struct lw_plant *plant, double drum_rpm_per_s)
{
	if (!isfinite(drum_rpm_per_s) || drum_rpm_per_s <= 0.0) {
		return -ERANGE;
	}
	plant->drum.acceleration_milli_rpm_per_s = drum_rpm_per_s * MILLI_RPM_PER_RPM;
	return 0;
}

int lw_plant_drum_play(struct lw_plant *plant, const struct lw_plant_profile_point *points,
		       size_t count)
{
	if (count < 1 || count > LW_PLANT_PROFILE_POINTS_MAX) {
		return -EINVAL;
	}
	for (size_t i = 0; i < count; i++) {
		if (i > 0 && points[i].time_ms <= points[i - 1].time_ms) {
			return -EINVAL;
		}
		if (!milli_rpm_in_range(points[i].drum_milli_rpm)) {
			return -ERANGE;
		}
	}
	plant->drum.profile = points;
	plant->drum.profile_count = count;
	plant->drum.profile_index = 0;
	plant->drum.profile_start_ns = plant->substep_ns;
	return 0;
}

bool lw_plant_drum_playing(const struct lw_plant *plant)
{
	return plant->drum.profile != NULL;
}
