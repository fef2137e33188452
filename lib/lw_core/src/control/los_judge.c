/* SPDX-License-Identifier: Apache-2.0 */
#include "los_judge.h"

#include "fault.h"
#include "switch_check.h"

static bool in_reversal(const struct lw_controller *controller, int side)
{
	return lw_law_region(controller->motion.window, lw_motion_m(&controller->motion)) ==
	       -lw_side_direction(side);
}

void lw_los_judge_begin(struct lw_controller *controller)
{
	struct lw_los *los = &controller->los;

	los->recoveries = 0;
	for (int side = 0; side < 2; side++) {
		los->triggered[side] = !lw_switch_check_surely_inward(controller, side);
		los->visiting[side] = in_reversal(controller, side);
	}
	controller->motion.law.turned = 0;
}

/**
 * How far the position of a trigger is past its switch, with every correction in it that has been
 * made since and that is still to be made: what neither of them explains.
 */
static int32_t error_usteps(const struct lw_controller *controller, int side,
			    const struct lw_limit_switch_trigger *at)
{
	const struct lw_motion *motion = &controller->motion;
	const volatile int32_t *corrected_usteps = &motion->corrected_usteps;
	const volatile int32_t *waiting_usteps = &motion->request_correction_usteps;
	int32_t corrected;
	int32_t waiting;

	do {
		corrected = *corrected_usteps;
		waiting = *waiting_usteps;
	} while (corrected != *corrected_usteps);
	return at->pos_usteps - at->corrected_usteps + corrected + waiting -
	       controller->derived->switch_usteps[side];
}

/** A switch triggered on the way to its reversal: is it where it was calibrated? */
static void judge_trigger(struct lw_controller *controller, int side,
			  const struct lw_limit_switch_trigger *at)
{
	const int32_t tolerance = controller->derived->switch_tolerance_usteps;
	const int32_t error = error_usteps(controller, side, at);
	const int32_t recoveries_max = controller->params->los_recoveries_max;
	struct lw_motion *motion = &controller->motion;

	controller->los.triggered[side] = true;
	if (error <= tolerance && error >= -tolerance) {
		return;
	}

	lw_los_note(&controller->los.los2[side], controller->now_us, at->pos_usteps * LW_USTEP);
	if (motion->cam.on) {
		return; /* a cam has no sweep to correct it in: it goes on until it is indexed */
	}
	if (controller->los.recoveries < UINT16_MAX) {
		controller->los.recoveries++;
	}
	if (recoveries_max > 0 && controller->los.recoveries > recoveries_max) {
		lw_fault_stop(controller, LW_FAULT_LOS_LIMIT);
		return;
	}
	/* Withdraw what is left of an older correction, to change it. */
	motion->requests &= (uint8_t)~LW_MOTION_REQUEST_CORRECTION;
	motion->request_correction_usteps -= error;
	lw_motion_request(motion, LW_MOTION_REQUEST_CORRECTION);
}

/** May the switch of a reversal that has been entered still trigger in time? */
static bool may_trigger(const struct lw_controller *controller, int side)
{
	const struct lw_derived *derived = controller->derived;
	const int32_t pos_usteps = lw_law_pos_usteps(lw_motion_m(&controller->motion));
	const int32_t past = lw_side_direction(side) * (pos_usteps - derived->switch_usteps[side]);

	return in_reversal(controller, side) && !controller->los.triggered[side] &&
	       (past <= derived->switch_tolerance_usteps + lw_carriage_lag_max_usteps(controller) ||
		controller->limit[side].candidate);
}

/** Has a reversal been entered whose switch did not trigger on the way? */
static void judge_reversal(struct lw_controller *controller, int side)
{
	struct lw_motion *motion = &controller->motion;
	bool turned;

	if (may_trigger(controller, side)) {
		return;
	}
	turned = lw_motion_take_turned(motion, lw_carriage_side_bit(side));

	/* Where it is now, and what came and went since the last tick. */
	if (!turned && !in_reversal(controller, side)) {
		controller->los.visiting[side] = false;
	} else if (!controller->los.visiting[side]) {
		controller->los.visiting[side] = true;
		if (!controller->los.triggered[side]) {
			lw_los_note(&controller->los.los1[side], controller->now_us,
				    lw_motion_m(motion));
		}
	}
	/* Before its correction the position says nothing about where a switch is. */
	if (!(motion->requests & LW_MOTION_REQUEST_CORRECTION) &&
	    lw_switch_check_surely_inward(controller, side)) {
		controller->los.triggered[side] = false;
	}
}

void lw_los_judge_tick(struct lw_controller *controller, const struct lw_carriage_trigger *triggers)
{
	if (controller->motion.cam.on && controller->params->cam_axis == LW_CAM_AXIS_FREE) {
		return; /* its position says nothing about switches */
	}
	for (int side = 0; side < 2; side++) {
		/* A trigger counts only when the carriage moves toward its switch. */
		if (triggers[side].taken &&
		    lw_carriage_triggered_outward(controller, &triggers[side].at, side)) {
			judge_trigger(controller, side, &triggers[side].at);
		}
	}
	for (int side = 0; side < 2 && controller->state == LW_STATE_TRACKING; side++) {
		judge_reversal(controller, side);
	}
}
