/* SPDX-License-Identifier: Apache-2.0 */
#include "fault.h"

void lw_fault_stop(struct lw_controller *controller, enum lw_fault fault)
{
	lw_carriage_cut(controller);
	controller->state = LW_STATE_FAULT;
	controller->fault = fault;
	controller->indexed = false;
	controller->on_orbit = false;
}

bool lw_fault_stop_by_wiring(struct lw_controller *controller)
{
	if (!controller->wiring[LW_PLUS] && !controller->wiring[LW_MINUS]) {
		return false;
	}
	lw_fault_stop(controller,
		      controller->wiring[LW_PLUS] ? LW_FAULT_WIRING_PLUS : LW_FAULT_WIRING_MINUS);
	return true;
}

bool lw_fault_cause_present(const struct lw_controller *controller)
{
	const struct lw_limit_switch *limit = controller->limit;

	switch (controller->fault) {
	case LW_FAULT_WIRING_PLUS:
	case LW_FAULT_WIRING_MINUS:
		return limit[LW_PLUS].wiring_fault || limit[LW_MINUS].wiring_fault;
	case LW_FAULT_OVERTRAVEL_PLUS:
	case LW_FAULT_OVERTRAVEL_MINUS:
		return controller->overtravel[LW_PLUS] || controller->overtravel[LW_MINUS];
	case LW_FAULT_BOTH_SWITCHES_ACTIVE:
		return limit[LW_PLUS].active && limit[LW_MINUS].active;
	case LW_FAULT_STEPPER_ALARM:
		return controller->stepper_alarm.on;
	case LW_FAULT_OVERSPEED:
		return lw_drum_speed_exceeds(&controller->speed,
					     controller->params->overspeed_trip_edges_per_s);
	case LW_FAULT_NONE:
		/* What is left to acknowledge is a wiring fault that is told beside the state. */
		return limit[LW_PLUS].wiring_fault || limit[LW_MINUS].wiring_fault;
	case LW_FAULT_INDEX_NO_SWITCH:
	case LW_FAULT_INDEX_WRONG_SWITCH:
	case LW_FAULT_INDEX_SPAN:
	case LW_FAULT_BACK_OFF_NO_RELEASE:
	case LW_FAULT_LOS_LIMIT:
	case LW_FAULT_REACQUIRE_NO_SWITCH:
	case LW_FAULT_REACQUIRE_WRONG_SWITCH:
		break; /* what a motion found, and it has ended */
	}
	return false;
}

void lw_fault_clear(struct lw_controller *controller)
{
	controller->fault = LW_FAULT_NONE;
	controller->overspeed_trip = false;
	for (int side = 0; side < 2; side++) {
		controller->wiring[side] = controller->limit[side].wiring_fault;
	}
	if (controller->state == LW_STATE_FAULT) {
		controller->state = LW_STATE_UNINDEXED;
	}
	if (controller->moving.rest_state == LW_STATE_FAULT) {
		controller->moving.rest_state = LW_STATE_UNINDEXED; /* a jog is under way */
	}
}
