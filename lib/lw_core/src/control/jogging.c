/* SPDX-License-Identifier: Apache-2.0 */
#include "jogging.h"

#include "carriage_acts.h"
#include "moving.h"
#include "tracking.h"

void lw_jogging_write(struct lw_controller *controller, int direction, uint64_t now_us)
{
	controller->jogging.written_us = now_us;
	if (controller->state == LW_STATE_JOGGING) {
		if (direction == 0) {
			lw_moving_halt(controller, controller->moving.rest_state);
		}
		return;
	}
	if (direction == 0) {
		return;
	}

	int32_t m = lw_motion_m(&controller->motion);
	int32_t target_usteps = direction * controller->derived->travel_usteps;
	enum lw_state rest_state = controller->fault ? LW_STATE_FAULT : LW_STATE_UNINDEXED;

	if (controller->indexed) {
		const struct lw_law_window window = lw_carriage_track_window(controller);

		/* Come to rest a little inside, so that a hand-over begins in the sweep. */
		target_usteps = direction > 0 ? lw_law_pos_usteps(window.sweep_end) - 2
					      : lw_law_pos_usteps(window.sweep_begin) + 2;
		rest_state = LW_STATE_READY;
		if (direction * (target_usteps - lw_law_pos_usteps(m)) <= 0) {
			return; /* at the limit already */
		}
		if (controller->state == LW_STATE_TRACKING) {
			lw_tracking_leave(controller);
			m = lw_motion_m(&controller->motion);
		}
	} else {
		m = 0;
	}
	controller->jogging.direction = (int8_t)direction;
	lw_moving_to(controller, m, target_usteps, LW_STATE_JOGGING, rest_state);
}

/** Jogging without an index: the limit switches are the limits. */
static bool must_end(const struct lw_controller *controller)
{
	const int side = controller->jogging.direction > 0 ? LW_PLUS : LW_MINUS;

	return controller->now_us - controller->jogging.written_us >
		       (uint64_t)controller->params->jog_hold_ms * 1000 ||
	       (!controller->indexed && controller->limit[side].active);
}

void lw_jogging_tick(struct lw_controller *controller)
{
	if (must_end(controller)) {
		lw_moving_halt(controller, controller->moving.rest_state);
	}
	lw_moving_tick(controller);
}
