/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief Configuration, event loop and ground truth.
 */
#include <errno.h>
#include <math.h>

#include "plant_internal.h"

#define UM_PER_MM           1000.0
#define DURATION_MAX_US     1000000u
#define RANDOM_SEED_OF_ZERO 0x9e3779b97f4a7c15u

void lw_plant_config_default(struct lw_plant_config *config)
{
	*config = (struct lw_plant_config){
		.encoder_pulses_per_rev = 360,
		.encoder_revs_per_drum_rev_num = 4,
		.encoder_revs_per_drum_rev_den = 1,
		.drum_acceleration_rpm_per_s = 500.0,
		.screw_lead_um = 20000,
		.usteps_per_rev = 2000,
		.full_steps_per_rev = 200,
		.holding_acceleration_mm_per_s2 = 30000.0,
		.half_torque_speed_mm_per_s = 400.0,
		.damping_ratio = 0.2,
		.friction_mm_per_s2 = 500.0,
		.start_um = 0,
		.flange_um = 90000,
		.overtravel_um = 86000,
		.limit_um = {78400, -78400},
		.switch_hysteresis_um = 800,
		.limit_shift_um_per_mm_per_s = 0.5,
		.contact_transit_us = 1000,
		.bounce_duration_us = 3000,
		.bounce_interval_us = 100,
		.carriage_reversed = false,
	};
}

static bool positive(double value)
{
	return isfinite(value) && value > 0.0;
}

static bool config_is_valid(const struct lw_plant_config *config)
{
	return config->encoder_pulses_per_rev > 0 && config->encoder_revs_per_drum_rev_num > 0 &&
	       config->encoder_revs_per_drum_rev_den > 0 &&
	       positive(config->drum_acceleration_rpm_per_s) && config->screw_lead_um > 0 &&
	       config->usteps_per_rev > 0 && config->full_steps_per_rev > 0 &&
	       4ull * config->usteps_per_rev % config->full_steps_per_rev == 0 &&
	       positive(config->holding_acceleration_mm_per_s2) &&
	       positive(config->half_torque_speed_mm_per_s) && isfinite(config->damping_ratio) &&
	       config->damping_ratio >= 0.0 && isfinite(config->friction_mm_per_s2) &&
	       config->friction_mm_per_s2 >= 0.0 && config->overtravel_um > 0 &&
	       config->flange_um > config->overtravel_um && config->start_um <= config->flange_um &&
	       config->start_um >= -config->flange_um &&
	       config->limit_um[LW_PLANT_PLUS] < config->overtravel_um &&
	       config->limit_um[LW_PLANT_MINUS] > -config->overtravel_um &&
	       config->limit_um[LW_PLANT_MINUS] < config->limit_um[LW_PLANT_PLUS] &&
	       config->switch_hysteresis_um >= 0 && isfinite(config->limit_shift_um_per_mm_per_s) &&
	       config->limit_shift_um_per_mm_per_s >= 0.0 &&
	       config->contact_transit_us <= DURATION_MAX_US &&
	       config->bounce_duration_us <= DURATION_MAX_US && config->bounce_interval_us > 0 &&
	       config->bounce_interval_us <= DURATION_MAX_US;
}

int lw_plant_init(struct lw_plant *plant, const struct lw_plant_config *config, uint64_t seed)
{
	if (!config_is_valid(config)) {
		return -EINVAL;
	}
	*plant = (struct lw_plant){
		.random = seed != 0 ? seed : RANDOM_SEED_OF_ZERO,
		.bounce_interval_ns = config->bounce_interval_us * NS_PER_US,
		.trigger.fire_ns = LW_PLANT_NEVER_NS,
	};
	lw_plant_drum_init(&plant->drum, config);
	lw_plant_carriage_init(&plant->carriage, config);

	double usteps_per_um = plant->carriage.usteps_per_um;

	plant->hysteresis_usteps = config->switch_hysteresis_um * usteps_per_um;
	for (int side = 0; side < LW_PLANT_SIDES; side++) {
		int8_t outward = side == LW_PLANT_PLUS ? 1 : -1;

		plant->limit[side] = (struct lw_plant_switch){
			.trigger_usteps = outward * config->limit_um[side] * usteps_per_um,
			/* um per mm/s is ms: a constant delay, seen from a constant speed. */
			.shift_s = config->limit_shift_um_per_mm_per_s / UM_PER_MM,
			.transit_ns = config->contact_transit_us * NS_PER_US,
			.bounce_ns = config->bounce_duration_us * NS_PER_US,
			.outward = outward,
		};
		plant->overtravel[side] = (struct lw_plant_switch){
			.trigger_usteps = config->overtravel_um * usteps_per_um,
			.outward = outward,
		};
		lw_plant_switch_init(&plant->limit[side], plant->carriage.position_usteps);
		lw_plant_switch_init(&plant->overtravel[side], plant->carriage.position_usteps);
	}
	(void)lw_plant_switch_pins(plant);
	return 0;
}

static uint64_t next_rare_ns(const struct lw_plant *plant)
{
	uint64_t next_ns = earlier_ns(plant->drum.dither_ns, plant->drum.flicker_ns);

	next_ns = earlier_ns(next_ns, plant->trigger.fire_ns);
	for (int side = 0; side < LW_PLANT_SIDES; side++) {
		next_ns = earlier_ns(next_ns, plant->limit[side].pole_ns);
		next_ns = earlier_ns(next_ns, plant->limit[side].contact_ns);
		next_ns = earlier_ns(next_ns, plant->overtravel[side].pole_ns);
		next_ns = earlier_ns(next_ns, plant->overtravel[side].contact_ns);
		if (plant->overtravel[side].blip_end_ns > plant->now_ns) {
			next_ns = earlier_ns(next_ns, plant->overtravel[side].blip_end_ns);
		}
	}
	return next_ns;
}

static void substep(struct lw_plant *plant)
{
	plant->substep_ns += LW_PLANT_SUBSTEP_NS;
	lw_plant_drum_substep(&plant->drum, plant->now_ns);
	lw_plant_carriage_substep(&plant->carriage, plant->now_ns);
}

/** Whatever is due now. */
static uint32_t run_rare(struct lw_plant *plant)
{
	uint32_t changed = 0;

	if (plant->trigger.fire_ns <= plant->now_ns) {
		plant->trigger.armed = false;
		(void)lw_plant_inject(plant, plant->trigger.fault, plant->trigger.argument);
	}
	for (int side = 0; side < LW_PLANT_SIDES; side++) {
		lw_plant_switch_run(plant, &plant->limit[side]);
		lw_plant_switch_run(plant, &plant->overtravel[side]);
	}
	if (plant->drum.dither_ns <= plant->now_ns) {
		changed |= lw_plant_drum_dither(plant);
	}
	changed |= lw_plant_drum_wires(plant);
	if (plant->substep_ns <= plant->now_ns) {
		substep(plant);
		lw_plant_plan_contacts(plant);
	}
	changed |= lw_plant_switch_pins(plant);
	if (plant->pins.stepper_alarm != plant->carriage.alarm) {
		plant->pins.stepper_alarm = plant->carriage.alarm;
		changed |= LW_PLANT_STEPPER_ALARM;
	}
	for (int later = 0; later < 2; later++) {
		if (plant->pins.trim_buttons[later] != plant->trim_pressed[later]) {
			plant->pins.trim_buttons[later] = plant->trim_pressed[later];
			changed |= LW_PLANT_TRIM_BUTTONS;
		}
	}
	lw_plant_drum_note_plain(&plant->drum);
	lw_plant_note_clear(plant);
	plant->rare_ns = next_rare_ns(plant);
	return changed;
}

/** Everything but the encoder's transitions. */
static uint32_t run_slow(struct lw_plant *plant)
{
	uint32_t changed = 0;

	if (plant->rare_ns <= plant->now_ns) {
		changed = run_rare(plant);
	} else {
		substep(plant);
		if (!lw_plant_is_clear(plant)) {
			lw_plant_plan_contacts(plant);
			plant->rare_ns = next_rare_ns(plant);
		}
	}
	plant->slow_ns = earlier_ns(plant->substep_ns, plant->rare_ns);
	return changed;
}

static inline uint32_t advance(struct lw_plant *plant)
{
	uint32_t changed;

	plant->now_ns = plant->event_ns;
	if (plant->drum.transition_ns <= plant->now_ns) {
		changed = lw_plant_drum_transition(plant);
	} else {
		changed = run_slow(plant);
	}
	plant->event_ns = earlier_ns(plant->drum.transition_ns, plant->slow_ns);
	return changed;
}

uint32_t lw_plant_advance(struct lw_plant *plant)
{
	return advance(plant);
}

uint32_t lw_plant_advance_to(struct lw_plant *plant, uint64_t until_ns)
{
	uint32_t changed;

	do {
		changed = advance(plant);
	} while (changed == 0 && plant->event_ns <= until_ns &&
		 plant->drum.transition_ns > plant->event_ns);
	return changed;
}

void lw_plant_read_truth(const struct lw_plant *plant, struct lw_plant_truth *truth)
{
	const struct lw_plant_carriage *carriage = &plant->carriage;
	double position = lw_plant_carriage_usteps(plant);
	int64_t pole = lw_plant_carriage_pole(carriage, position);

	*truth = (struct lw_plant_truth){
		.time_ns = plant->now_ns,
		.drum_transitions = plant->drum.transitions,
		.drum_milli_rpm = plant->drum.speed_milli_rpm,
		.carriage_um = position / carriage->usteps_per_um,
		.carriage_usteps = position,
		.carriage_um_per_s = carriage->path_usteps_per_s / carriage->usteps_per_um,
		.commanded_usteps = carriage->commanded_usteps,
		.lag_usteps = (double)carriage->commanded_usteps - position,
		.step_pulses = carriage->step_pulses,
		.slipped_usteps = pole * (int64_t)carriage->period_usteps,
		.pole_slips = carriage->pole_slips,
		.in_sync = pole == 0,
		.rope_um = lw_plant_rope_um(plant),
	};
}
