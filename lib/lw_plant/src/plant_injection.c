/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief Faults: checked, then injected at once or when the carriage passes a position.
 */
#include <errno.h>
#include <math.h>

#include "plant_internal.h"

#define BOUNCE_MAX_US 1000000
#define LATE_MAX_US   1000000
#define PULSES_MAX    100000000 /* four transitions each still fit a counter */
#define UM_PER_MM     1000.0

static bool within_flanges(const struct lw_plant *plant, int32_t position_um)
{
	return fabs(position_um * plant->carriage.usteps_per_um) <= plant->carriage.flange_usteps;
}

static int check(const struct lw_plant *plant, enum lw_plant_fault fault, int32_t argument)
{
	switch (fault) {
	case LW_PLANT_FAULT_STALL:
	case LW_PLANT_FAULT_SIDE_LOAD:
		return 0;
	case LW_PLANT_FAULT_SLIP:
		return fabs((double)argument) >= plant->carriage.period_usteps / 2.0 ? 0 : -ERANGE;
	case LW_PLANT_FAULT_BOUNCE:
	case LW_PLANT_FAULT_BLIP_PLUS:
	case LW_PLANT_FAULT_BLIP_MINUS:
		return argument >= 0 && argument <= BOUNCE_MAX_US ? 0 : -ERANGE;
	case LW_PLANT_FAULT_LIMIT_PLUS:
	case LW_PLANT_FAULT_LIMIT_MINUS:
		return argument >= 0 && argument < LW_PLANT_SWITCH_FAULT_COUNT ? 0 : -EINVAL;
	case LW_PLANT_FAULT_OVERTRAVEL_PLUS:
	case LW_PLANT_FAULT_OVERTRAVEL_MINUS:
		return argument >= 0 && argument <= LW_PLANT_SWITCH_STUCK_ACTUATED ? 0 : -EINVAL;
	case LW_PLANT_FAULT_ENCODER_LOSE_PULSES:
	case LW_PLANT_FAULT_ENCODER_ILLEGAL:
	case LW_PLANT_FAULT_ENCODER_DITHER:
	case LW_PLANT_FAULT_ENCODER_EXTRA_PULSES:
		return argument >= 0 && argument <= PULSES_MAX ? 0 : -ERANGE;
	case LW_PLANT_FAULT_PLACE_CARRIAGE:
		return within_flanges(plant, argument) ? 0 : -ERANGE;
	case LW_PLANT_FAULT_ENCODER_A:
	case LW_PLANT_FAULT_ENCODER_B:
		return argument >= 0 && argument < LW_PLANT_CHANNEL_FAULT_COUNT ? 0 : -EINVAL;
	case LW_PLANT_FAULT_CARRIAGE_REVERSED:
	case LW_PLANT_FAULT_STEPPER_ALARM:
	case LW_PLANT_FAULT_ENCODER_INDEX:
	case LW_PLANT_FAULT_TRIM_EARLY:
	case LW_PLANT_FAULT_TRIM_LATE:
		return argument == 0 || argument == 1 ? 0 : -EINVAL;
	case LW_PLANT_FAULT_SWITCH_LATE:
		return argument >= 0 && argument <= LATE_MAX_US ? 0 : -ERANGE;
	case LW_PLANT_FAULT_COUNT:
		break;
	}
	return -EINVAL;
}

static void stall(struct lw_plant *plant, int32_t duration_ms)
{
	if (duration_ms == 0) {
		plant->carriage.stall_end_ns = 0;
		return;
	}
	plant->carriage.stall_end_ns = duration_ms < 0
					       ? LW_PLANT_NEVER_NS
					       : plant->now_ns + (uint64_t)duration_ms * NS_PER_MS;
	lw_plant_carriage_halt(plant);
}

static void slip(struct lw_plant *plant, int32_t usteps)
{
	struct lw_plant_carriage *carriage = &plant->carriage;
	double rounded = round(usteps / carriage->period_usteps) * carriage->period_usteps;
	double position = lw_plant_carriage_usteps(plant) + rounded;

	if (fabs(position) > carriage->flange_usteps) {
		lw_plant_carriage_place(plant, copysign(carriage->flange_usteps, position));
	} else {
		carriage->position_usteps += rounded;
		carriage->load_usteps += rounded;
	}
}

/** Hide the next transitions from the pins, which hold their present position meanwhile. */
static void hide_transitions(struct lw_plant_drum *drum, uint32_t *pending, int32_t count)
{
	if (drum->lose_pulses == 0 && drum->illegal_changes == 0) {
		drum->held_transitions = drum->transitions;
	}
	*pending = (uint32_t)count;
}

static void dither(struct lw_plant *plant, int32_t count)
{
	struct lw_plant_drum *drum = &plant->drum;

	/* A dither under way goes back first: at the end the encoder is where it was. */
	drum->dither_changes = 2u * (uint32_t)count + (drum->dithered ? 1u : 0u);
	drum->dither_ns = plant->now_ns;
}

static void extra_pulses(struct lw_plant *plant, int32_t count)
{
	plant->drum.extra_changes = 4u * (uint32_t)count;
	plant->drum.dither_ns = plant->now_ns;
}

/** The pins change in an event, never behind the host's back: make one happen now. */
static void run_now(struct lw_plant *plant)
{
	lw_plant_plan_contacts(plant);
	plant->drum.plain = false;
	plant->rare_ns = plant->now_ns;
	plant->slow_ns = plant->now_ns;
	plant->event_ns = plant->now_ns;
}

int lw_plant_inject(struct lw_plant *plant, enum lw_plant_fault fault, int32_t argument)
{
	int error = check(plant, fault, argument);

	if (error != 0) {
		return error;
	}
	switch (fault) {
	case LW_PLANT_FAULT_STALL:
		stall(plant, argument);
		break;
	case LW_PLANT_FAULT_SLIP:
		slip(plant, argument);
		break;
	case LW_PLANT_FAULT_SIDE_LOAD:
		plant->carriage.side_load_usteps_per_s2 =
			argument * plant->carriage.usteps_per_um * UM_PER_MM;
		break;
	case LW_PLANT_FAULT_BOUNCE:
		plant->limit[LW_PLANT_PLUS].bounce_ns = (uint32_t)argument * NS_PER_US;
		plant->limit[LW_PLANT_MINUS].bounce_ns = (uint32_t)argument * NS_PER_US;
		break;
	case LW_PLANT_FAULT_LIMIT_PLUS:
		plant->limit[LW_PLANT_PLUS].fault = (uint8_t)argument;
		break;
	case LW_PLANT_FAULT_LIMIT_MINUS:
		plant->limit[LW_PLANT_MINUS].fault = (uint8_t)argument;
		break;
	case LW_PLANT_FAULT_OVERTRAVEL_PLUS:
		plant->overtravel[LW_PLANT_PLUS].fault = (uint8_t)argument;
		break;
	case LW_PLANT_FAULT_OVERTRAVEL_MINUS:
		plant->overtravel[LW_PLANT_MINUS].fault = (uint8_t)argument;
		break;
	case LW_PLANT_FAULT_ENCODER_LOSE_PULSES:
		hide_transitions(&plant->drum, &plant->drum.lose_pulses, argument);
		break;
	case LW_PLANT_FAULT_ENCODER_ILLEGAL:
		hide_transitions(&plant->drum, &plant->drum.illegal_changes, argument);
		break;
	case LW_PLANT_FAULT_ENCODER_DITHER:
		dither(plant, argument);
		break;
	case LW_PLANT_FAULT_ENCODER_EXTRA_PULSES:
		extra_pulses(plant, argument);
		break;
	case LW_PLANT_FAULT_PLACE_CARRIAGE:
		lw_plant_carriage_place(plant, argument * plant->carriage.usteps_per_um);
		break;
	case LW_PLANT_FAULT_CARRIAGE_REVERSED:
		plant->carriage.reversed = argument != 0;
		break;
	case LW_PLANT_FAULT_STEPPER_ALARM:
		plant->carriage.alarm = argument != 0;
		break;
	case LW_PLANT_FAULT_ENCODER_A:
	case LW_PLANT_FAULT_ENCODER_B:
		lw_plant_drum_channel(&plant->drum, fault == LW_PLANT_FAULT_ENCODER_B,
				      (uint8_t)argument, plant->now_ns);
		break;
	case LW_PLANT_FAULT_BLIP_PLUS:
	case LW_PLANT_FAULT_BLIP_MINUS:
		plant->overtravel[fault == LW_PLANT_FAULT_BLIP_MINUS].blip_end_ns =
			plant->now_ns + (uint64_t)argument * NS_PER_US;
		break;
	case LW_PLANT_FAULT_ENCODER_INDEX:
		plant->drum.index_open = argument == 0;
		plant->drum.wires_changed = true;
		break;
	case LW_PLANT_FAULT_TRIM_EARLY:
	case LW_PLANT_FAULT_TRIM_LATE:
		plant->trim_pressed[fault == LW_PLANT_FAULT_TRIM_LATE] = argument != 0;
		break;
	case LW_PLANT_FAULT_SWITCH_LATE:
		plant->limit[LW_PLANT_PLUS].shift_s = argument / 1e6;
		plant->limit[LW_PLANT_MINUS].shift_s = argument / 1e6;
		break;
	case LW_PLANT_FAULT_COUNT:
		break;
	}
	run_now(plant);
	return 0;
}

int lw_plant_arm(struct lw_plant *plant, int32_t position_um, int direction,
		 enum lw_plant_fault fault, int32_t argument)
{
	int error = check(plant, fault, argument);

	if (error != 0) {
		return error;
	}
	if (direction < -1 || direction > 1) {
		return -EINVAL;
	}
	if (!within_flanges(plant, position_um)) {
		return -ERANGE;
	}
	plant->trigger = (struct lw_plant_trigger){
		.fire_ns = LW_PLANT_NEVER_NS,
		.position_usteps = position_um * plant->carriage.usteps_per_um,
		.argument = argument,
		.fault = fault,
		.direction = (int8_t)direction,
		.armed = true,
	};
	run_now(plant);
	return 0;
}

bool lw_plant_armed(const struct lw_plant *plant)
{
	return plant->trigger.armed;
}
