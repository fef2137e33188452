/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief Switches: where the pole moves, and how its contacts open, travel, close and bounce.
 */
#include <math.h>

#include "plant_internal.h"

#define SCATTER_MOST 3.0 /* standard deviations */

/** Normally distributed with a standard deviation of 1, by the central limit theorem. */
static double random_normal(struct lw_plant *plant)
{
	double sum = -6.0;

	for (int i = 0; i < 12; i++) {
		sum += lw_plant_random(plant, UINT32_MAX) / (double)UINT32_MAX;
	}
	return sum;
}

/** Choose where the switch triggers next. */
static void scatter(struct lw_plant *plant, struct lw_plant_switch *contact)
{
	contact->trigger_usteps = contact->place_usteps;
	if (contact->scatter_usteps > 0.0) {
		contact->trigger_usteps +=
			contact->scatter_usteps *
			fmin(fmax(random_normal(plant), -SCATTER_MOST), SCATTER_MOST);
	}
}

void lw_plant_switch_init(struct lw_plant *plant, struct lw_plant_switch *contact,
			  double position_usteps)
{
	scatter(plant, contact);
	contact->actuated = contact->fault == LW_PLANT_SWITCH_STUCK_ACTUATED ||
			    (contact->fault != LW_PLANT_SWITCH_STUCK_RELEASED &&
			     contact->outward * position_usteps >= contact->trigger_usteps);
	contact->closed = true;
	contact->pole_ns = LW_PLANT_NEVER_NS;
	contact->contact_ns = LW_PLANT_NEVER_NS;
}

void lw_plant_switch_plan(struct lw_plant_switch *contact, const struct lw_plant *plant,
			  double position_usteps, double remaining_s)
{
	contact->pole_ns = LW_PLANT_NEVER_NS;
	if (contact->fault == LW_PLANT_SWITCH_STUCK_RELEASED ||
	    contact->fault == LW_PLANT_SWITCH_STUCK_ACTUATED) {
		if (contact->actuated != (contact->fault == LW_PLANT_SWITCH_STUCK_ACTUATED)) {
			contact->pole_ns = plant->now_ns;
		}
		return;
	}

	/* Distance and speed towards the point where the pole would change over. */
	double point = lw_plant_switch_point_usteps(contact);
	int towards = contact->actuated ? -contact->outward : contact->outward;
	double distance = towards * (contact->outward * point - position_usteps);
	double speed = towards * plant->carriage.load_path_usteps_per_s;

	if (speed > 0.0) {
		distance += speed * contact->shift_s;
	}
	if (distance <= 0.0) {
		contact->pole_ns = plant->now_ns;
	} else if (distance <= speed * remaining_s) {
		contact->pole_ns = plant->now_ns + (uint64_t)(distance / speed / S_PER_NS);
	}
}

static void plan_bounce(struct lw_plant *plant, struct lw_plant_switch *contact)
{
	uint32_t mean_ns = plant->bounce_interval_ns;
	uint64_t next_ns = plant->now_ns + mean_ns / 2 + lw_plant_random(plant, mean_ns);

	if (next_ns < contact->bounce_end_ns) {
		contact->contact_ns = next_ns;
	} else {
		contact->contact_ns = contact->closed ? LW_PLANT_NEVER_NS : contact->bounce_end_ns;
	}
}

void lw_plant_switch_run(struct lw_plant *plant, struct lw_plant_switch *contact)
{
	if (contact->pole_ns <= plant->now_ns) {
		contact->pole_ns = LW_PLANT_NEVER_NS;
		contact->actuated = !contact->actuated;
		if (!contact->actuated) {
			/* The release itself is where the switch was when it was actuated. */
			contact->place_usteps += contact->drift_usteps;
			contact->release_usteps += contact->drift_usteps;
			scatter(plant, contact);
		}
		contact->closed = false;
		contact->contact_ns = plant->now_ns + contact->transit_ns;
		contact->bounce_end_ns = contact->contact_ns + contact->bounce_ns;
	}
	if (contact->contact_ns <= plant->now_ns) {
		contact->closed = !contact->closed;
		plan_bounce(plant, contact);
	}
}

uint32_t lw_plant_switch_pins(struct lw_plant *plant)
{
	uint32_t changed = 0;

	for (int side = 0; side < LW_PLANT_SIDES; side++) {
		const struct lw_plant_switch *contact = &plant->limit[side];
		bool shorted = contact->fault == LW_PLANT_SWITCH_SHORTED;
		bool no_closed = contact->actuated && contact->closed &&
				 contact->fault != LW_PLANT_SWITCH_NO_BROKEN;
		bool nc_closed = !contact->actuated && contact->closed &&
				 contact->fault != LW_PLANT_SWITCH_NC_BROKEN;

		no_closed = no_closed || shorted;
		nc_closed = nc_closed || shorted;
		if (contact->contacts_swapped) {
			const bool swapped = no_closed;

			no_closed = nc_closed;
			nc_closed = swapped;
		}

		const int limit_pin = side ^ (int)plant->limit_swapped;

		if (no_closed != plant->pins.limit[limit_pin].no_closed ||
		    nc_closed != plant->pins.limit[limit_pin].nc_closed) {
			changed |= (uint32_t)LW_PLANT_LIMIT_PLUS << limit_pin;
		}
		plant->pins.limit[limit_pin].no_closed = no_closed;
		plant->pins.limit[limit_pin].nc_closed = nc_closed;

		const int overtravel_pin = side ^ (int)plant->overtravel_swapped;
		bool overtravel = plant->overtravel[side].actuated ||
				  plant->now_ns < plant->overtravel[side].blip_end_ns;

		if (overtravel != plant->pins.overtravel[overtravel_pin]) {
			changed |= (uint32_t)LW_PLANT_OVERTRAVEL_PLUS << overtravel_pin;
		}
		plant->pins.overtravel[overtravel_pin] = overtravel;
	}
	return changed;
}
