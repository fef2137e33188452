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
#define ENCODER_PULSES_MAX  100000u
#define PPM_MAX             1000000u
#define MOVING_UM_PER_S     1000.0
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

static bool at_least_0(double value)
{
	return isfinite(value) && value >= 0.0;
}

static bool positive(double value)
{
	return isfinite(value) && value > 0.0;
}

/** A switch that has just released does not trigger at once. */
static bool scatter_fits(const struct lw_plant_config *config, enum lw_plant_side side)
{
	return config->limit_scatter_um[side] == 0.0 ||
	       (at_least_0(config->limit_scatter_um[side]) &&
		3.0 * config->limit_scatter_um[side] < config->switch_hysteresis_um);
}

int lw_plant_config_check(const struct lw_plant_config *config, struct lw_plant_misfit *why)
{
	const struct {
		bool fits;
		struct lw_plant_misfit misfit;
	} rules[] = {
		{config->encoder_pulses_per_rev > 0 &&
			 config->encoder_pulses_per_rev <= ENCODER_PULSES_MAX,
		 {"encoder_pulses_per_rev", "from", "1 to 100000"}},
		{config->encoder_revs_per_drum_rev_num > 0,
		 {"encoder_ratio_numerator", "more than", "0"}},
		{config->encoder_revs_per_drum_rev_den > 0,
		 {"encoder_ratio_denominator", "more than", "0"}},
		{positive(config->drum_acceleration_rpm_per_s),
		 {"drum_acceleration_rpm_per_s", "more than", "0"}},
		{config->screw_lead_um > 0, {"screw_lead_mm", "more than", "0"}},
		{config->usteps_per_rev > 0, {"microsteps_per_rev", "more than", "0"}},
		{config->full_steps_per_rev > 0, {"full_steps_per_rev", "more than", "0"}},
		{config->full_steps_per_rev == 0 ||
			 4ull * config->usteps_per_rev % config->full_steps_per_rev == 0,
		 {"microsteps_per_rev", "a multiple of a quarter of", "full_steps_per_rev"}},
		{positive(config->holding_acceleration_mm_per_s2),
		 {"holding_acceleration_mm_per_s2", "more than", "0"}},
		{positive(config->half_torque_speed_mm_per_s),
		 {"half_torque_speed_mm_per_s", "more than", "0"}},
		{at_least_0(config->top_speed_mm_per_s), {"top_speed_mm_per_s", "at least", "0"}},
		{at_least_0(config->damping_ratio), {"damping_ratio", "at least", "0"}},
		{at_least_0(config->friction_mm_per_s2), {"friction_mm_per_s2", "at least", "0"}},
		{config->overtravel_um > 0, {"overtravel_mm", "more than", "0"}},
		{config->flange_um > config->overtravel_um,
		 {"end_stop_mm", "more than", "overtravel_mm"}},
		{config->start_um <= config->flange_um && config->start_um >= -config->flange_um,
		 {"start_mm", "between minus and plus", "end_stop_mm"}},
		{config->limit_um[LW_PLANT_PLUS] < config->overtravel_um,
		 {"switch_plus_mm", "less than", "overtravel_mm"}},
		{config->limit_um[LW_PLANT_MINUS] > -config->overtravel_um,
		 {"switch_minus_mm", "more than minus", "overtravel_mm"}},
		{config->limit_um[LW_PLANT_MINUS] < config->limit_um[LW_PLANT_PLUS],
		 {"switch_minus_mm", "less than", "switch_plus_mm"}},
		{config->switch_hysteresis_um >= 0, {"switch_hysteresis_mm", "at least", "0"}},
		{at_least_0(config->limit_shift_um_per_mm_per_s),
		 {"switch_late_ms", "at least", "0"}},
		{at_least_0(config->backlash_um), {"backlash_mm", "at least", "0"}},
		{at_least_0(config->coupling_grip_mm_per_s2),
		 {"coupling_grip_mm_per_s2", "at least", "0"}},
		{scatter_fits(config, LW_PLANT_PLUS),
		 {"switch_plus_scatter_mm", "less than a third of", "switch_hysteresis_mm"}},
		{scatter_fits(config, LW_PLANT_MINUS),
		 {"switch_minus_scatter_mm", "less than a third of", "switch_hysteresis_mm"}},
		{isfinite(config->limit_drift_um[LW_PLANT_PLUS]),
		 {"switch_plus_drift_mm", "a number", ""}},
		{isfinite(config->limit_drift_um[LW_PLANT_MINUS]),
		 {"switch_minus_drift_mm", "a number", ""}},
		{config->line_errors_ppm <= PPM_MAX, {"line_errors_ppm", "at most", "1000000"}},
		{config->line_errors_moving_ppm <= PPM_MAX,
		 {"line_errors_moving_ppm", "at most", "1000000"}},
		{config->contact_transit_us <= DURATION_MAX_US,
		 {"contact_travel_ms", "at most", "1000"}},
		{config->bounce_duration_us <= DURATION_MAX_US, {"bounce_ms", "at most", "1000"}},
		{config->bounce_interval_us > 0 && config->bounce_interval_us <= DURATION_MAX_US,
		 {"bounce_interval_ms", "from", "0.001 to 1000"}},
	};

	for (size_t i = 0; i < sizeof(rules) / sizeof(rules[0]); i++) {
		if (!rules[i].fits) {
			*why = rules[i].misfit;
			return -EINVAL;
		}
	}
	return 0;
}

int lw_plant_init(struct lw_plant *plant, const struct lw_plant_config *config, uint64_t seed)
{
	struct lw_plant_misfit why;

	if (lw_plant_config_check(config, &why) != 0) {
		return -EINVAL;
	}
	*plant = (struct lw_plant){
		.random = seed != 0 ? seed : RANDOM_SEED_OF_ZERO,
		.line_random = ~seed != 0 ? ~seed : RANDOM_SEED_OF_ZERO,
		.line_errors_ppm = config->line_errors_ppm,
		.line_errors_moving_ppm = config->line_errors_moving_ppm,
		.bounce_interval_ns = config->bounce_interval_us * NS_PER_US,
		.trigger.fire_ns = LW_PLANT_NEVER_NS,
		.limit_swapped = config->limit_swapped,
		.overtravel_swapped = config->overtravel_swapped,
	};
	lw_plant_drum_init(&plant->drum, config);
	lw_plant_carriage_init(&plant->carriage, config);

	double usteps_per_um = plant->carriage.usteps_per_um;
	double hysteresis_usteps = config->switch_hysteresis_um * usteps_per_um;

	for (int side = 0; side < LW_PLANT_SIDES; side++) {
		int8_t outward = side == LW_PLANT_PLUS ? 1 : -1;

		plant->limit[side] = (struct lw_plant_switch){
			.place_usteps = outward * config->limit_um[side] * usteps_per_um,
			.scatter_usteps = config->limit_scatter_um[side] * usteps_per_um,
			.drift_usteps = config->limit_drift_um[side] * usteps_per_um,
			/* um per mm/s is ms: a constant delay, seen from a constant speed. */
			.shift_s = config->limit_shift_um_per_mm_per_s / UM_PER_MM,
			.transit_ns = config->contact_transit_us * NS_PER_US,
			.bounce_ns = config->bounce_duration_us * NS_PER_US,
			.fault = config->limit_fault[side],
			.outward = outward,
			.contacts_swapped = config->limit_contacts_swapped[side],
		};
		plant->overtravel[side] = (struct lw_plant_switch){
			.place_usteps = config->overtravel_um * usteps_per_um,
			.fault = config->overtravel_fault[side],
			.outward = outward,
		};
		plant->limit[side].release_usteps =
			plant->limit[side].place_usteps - hysteresis_usteps;
		plant->overtravel[side].release_usteps =
			plant->overtravel[side].place_usteps - hysteresis_usteps;
		lw_plant_switch_init(plant, &plant->limit[side], plant->carriage.load_usteps);
		lw_plant_switch_init(plant, &plant->overtravel[side], plant->carriage.load_usteps);
	}
	(void)lw_plant_switch_pins(plant);
	lw_plant_drum_show(plant);
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
		 (!plant->drum.plain || plant->drum.transition_ns > plant->event_ns));
	return changed;
}

size_t lw_plant_disturb(struct lw_plant *plant, uint8_t *bytes, size_t count)
{
	const double um_per_s =
		fabs(plant->carriage.path_usteps_per_s) / plant->carriage.usteps_per_um;
	const uint32_t ppm = um_per_s >= MOVING_UM_PER_S &&
					     plant->line_errors_moving_ppm > plant->line_errors_ppm
				     ? plant->line_errors_moving_ppm
				     : plant->line_errors_ppm;
	size_t wrong = 0;

	for (size_t i = 0; ppm != 0 && i < count; i++) {
		if (lw_plant_chance(&plant->line_random, PPM_MAX) < ppm) {
			bytes[i] ^= (uint8_t)(1u << lw_plant_chance(&plant->line_random, 8));
			wrong++;
		}
	}
	return wrong;
}

void lw_plant_read_truth(const struct lw_plant *plant, struct lw_plant_truth *truth)
{
	const struct lw_plant_carriage *carriage = &plant->carriage;
	double position = lw_plant_carriage_usteps(plant);
	double rotor = lw_plant_rotor_usteps(plant);
	int64_t pole = lw_plant_carriage_pole(carriage, rotor);

	*truth = (struct lw_plant_truth){
		.time_ns = plant->now_ns,
		.drum_transitions = plant->drum.transitions,
		.drum_milli_rpm = plant->drum.speed_milli_rpm,
		.carriage_um = position / carriage->usteps_per_um,
		.carriage_usteps = position,
		.carriage_um_per_s = carriage->load_path_usteps_per_s / carriage->usteps_per_um,
		.commanded_usteps = carriage->commanded_usteps,
		.lag_usteps = (double)carriage->commanded_usteps - rotor,
		.step_pulses = carriage->step_pulses,
		.slipped_usteps = pole * (int64_t)carriage->period_usteps,
		.pole_slips = carriage->pole_slips,
		.in_sync = pole == 0,
		.coupling_slip_um = carriage->coupling_slip_usteps / carriage->usteps_per_um,
		.limit_um =
			{
				plant->limit[LW_PLANT_PLUS].trigger_usteps /
					carriage->usteps_per_um,
				-plant->limit[LW_PLANT_MINUS].trigger_usteps /
					carriage->usteps_per_um,
			},
		.rope_um = lw_plant_rope_um(plant),
	};
}
