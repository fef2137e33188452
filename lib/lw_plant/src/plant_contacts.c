/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief When switches and trigger meet the carriage.
 */
#include <math.h>

#include "plant_internal.h"

static void plan_trigger(struct lw_plant *plant, double begin_usteps, double remaining_s)
{
	struct lw_plant_trigger *trigger = &plant->trigger;
	double speed = plant->carriage.load_path_usteps_per_s;
	/* The next substep begins where this one ends, so each position lies in exactly one. */
	double end_usteps = begin_usteps + speed * remaining_s;
	double at_usteps = trigger->position_usteps;
	bool passed = speed > 0.0 ? begin_usteps <= at_usteps && at_usteps < end_usteps
				  : begin_usteps >= at_usteps && at_usteps > end_usteps;

	trigger->fire_ns = LW_PLANT_NEVER_NS;
	if (trigger->armed && passed && trigger->direction * speed >= 0.0) {
		double wait_s = (at_usteps - begin_usteps) / speed;

		trigger->fire_ns = plant->now_ns + (uint64_t)(wait_s / S_PER_NS);
	}
}

void lw_plant_plan_contacts(struct lw_plant *plant)
{
	double position_usteps = lw_plant_carriage_usteps(plant);
	double remaining_s = (double)(plant->substep_ns - plant->now_ns) * S_PER_NS;

	for (int side = 0; side < LW_PLANT_SIDES; side++) {
		lw_plant_switch_plan(&plant->limit[side], plant, position_usteps, remaining_s);
		lw_plant_switch_plan(&plant->overtravel[side], plant, position_usteps, remaining_s);
	}
	plan_trigger(plant, position_usteps, remaining_s);
}

/** Narrow the clear way to where this switch changes over next. @return whether it is at rest */
static bool clear_of(struct lw_plant *plant, const struct lw_plant_switch *contact)
{
	const int towards = contact->actuated ? -contact->outward : contact->outward;
	const double point = contact->outward * lw_plant_switch_point_usteps(contact);

	if (contact->pole_ns != LW_PLANT_NEVER_NS) {
		return false;
	}
	if (contact->fault == LW_PLANT_SWITCH_STUCK_RELEASED ||
	    contact->fault == LW_PLANT_SWITCH_STUCK_ACTUATED) {
		return true; /* and is as it stays */
	}
	if (towards > 0) {
		plant->clear_usteps[LW_PLANT_PLUS] =
			fmin(plant->clear_usteps[LW_PLANT_PLUS], point);
	} else {
		plant->clear_usteps[LW_PLANT_MINUS] =
			fmax(plant->clear_usteps[LW_PLANT_MINUS], point);
	}
	plant->clear_s = fmax(plant->clear_s, contact->shift_s);
	return true;
}

void lw_plant_note_clear(struct lw_plant *plant)
{
	bool clear = !plant->trigger.armed;

	plant->clear_usteps[LW_PLANT_PLUS] = INFINITY;
	plant->clear_usteps[LW_PLANT_MINUS] = -INFINITY;
	plant->clear_s = 0.0;
	for (int side = 0; side < LW_PLANT_SIDES; side++) {
		clear = clear_of(plant, &plant->limit[side]) && clear;
		clear = clear_of(plant, &plant->overtravel[side]) && clear;
	}
	if (!clear) {
		plant->clear_usteps[LW_PLANT_PLUS] = -INFINITY;
	}
}

bool lw_plant_is_clear(const struct lw_plant *plant)
{
	/* A little more than the way, so that no rounding decides. */
	const double reach_usteps =
		fabs(plant->carriage.load_path_usteps_per_s) * (2.0 * SUBSTEP_S + plant->clear_s) +
		1.0;

	return plant->carriage.load_usteps + reach_usteps < plant->clear_usteps[LW_PLANT_PLUS] &&
	       plant->carriage.load_usteps - reach_usteps > plant->clear_usteps[LW_PLANT_MINUS];
}
