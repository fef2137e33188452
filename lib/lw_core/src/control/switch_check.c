/* SPDX-License-Identifier: Apache-2.0 */
#include "switch_check.h"

/** Ticks are late now and then, and a contact is seen a tick later than it closes. */
#define LATE_US 5000u

/** How far inward of the calibrated place of a side's switch the carriage is. */
static int32_t inward_usteps(const struct lw_controller *controller, int side)
{
	const int32_t pos_usteps = lw_law_pos_usteps(lw_motion_m(&controller->motion));

	return lw_side_direction(side) * (controller->derived->switch_usteps[side] - pos_usteps);
}

bool lw_switch_check_surely_inward(const struct lw_controller *controller, int side)
{
	return inward_usteps(controller, side) >
	       controller->derived->switch_tolerance_usteps +
		       controller->derived->switch_hysteresis_usteps;
}

/** Does the position say something about the switches? */
static bool position_is_known(const struct lw_controller *controller)
{
	const bool free_axis =
		controller->motion.cam.on && controller->params->cam_axis == LW_CAM_AXIS_FREE;

	return controller->indexed && !free_axis &&
	       !(controller->motion.requests & LW_MOTION_REQUEST_CORRECTION);
}

static bool fits(const struct lw_controller *controller, int side)
{
	return controller->limit[side].active
		       ? !lw_switch_check_surely_inward(controller, side)
		       : inward_usteps(controller, side) >=
				 -controller->derived->switch_tolerance_usteps;
}

void lw_switch_check_tick(struct lw_controller *controller)
{
	struct lw_switch_check *check = &controller->switch_check;
	const struct lw_limit_switch_config *config = &controller->limit_config;
	const uint64_t contact_us = (uint64_t)config->transit_us + config->debounce_us + LATE_US;

	for (int side = 0; side < 2; side++) {
		if (!position_is_known(controller) || fits(controller, side)) {
			check->plausible_us[side] = controller->now_us;
		}
		check->implausible[side] =
			controller->now_us - check->plausible_us[side] > contact_us;
	}
}
