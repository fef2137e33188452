/* SPDX-License-Identifier: Apache-2.0 */
#include "moving.h"

#include "carriage_acts.h"
#include "lw/bytes/require.h"
#include "lw/motion/move.h"

void lw_moving_start(struct lw_controller *controller, struct lw_law_window window, int32_t m)
{
	LW_REQUIRE(controller->motion.source == LW_EDGE_SOURCE_NONE);
	struct lw_motion *motion = &controller->motion;

	struct lw_law_window *spare = lw_carriage_spare_window(controller);

	controller->moving.shift_usteps +=
		lw_law_pos_usteps(m) - lw_law_pos_usteps(lw_motion_m(motion));
	*spare = window;
	lw_motion_set_position(motion, spare, m, 0);
	motion->requests = 0;
	motion->stop_at_rest = LW_MOTION_PLUS | LW_MOTION_MINUS;
	controller->moving.halting = false;
	controller->moving.halt_sent = false;
	controller->on_orbit = false;
	lw_motion_set_source(motion, LW_EDGE_SOURCE_TIMER);
}

void lw_moving_to(struct lw_controller *controller, int32_t m, int32_t target_usteps,
		  enum lw_state moving_state, enum lw_state rest_state)
{
	LW_REQUIRE(controller->motion.source == LW_EDGE_SOURCE_NONE);
	struct lw_law_window window;

	controller->on_orbit = false;
	controller->moving.rest_state = rest_state;
	if (lw_move_to(m, &window, controller->derived->ka, controller->derived->nr,
		       target_usteps)) {
		controller->state = moving_state;
		lw_moving_start(controller, window, m);
	} else {
		/* Whatever the pattern was doing, the carriage is at rest now. */
		lw_motion_set_position(&controller->motion, controller->motion.window, m, 0);
		controller->state = rest_state;
	}
}

bool lw_moving_into(struct lw_controller *controller, int32_t target_usteps,
		    enum lw_state moving_state, enum lw_state rest_state)
{
	int32_t m = lw_motion_m(&controller->motion);
	struct lw_law_window window;

	if (!lw_move_into(&m, &window, controller->derived->ka, controller->derived->nr,
			  target_usteps)) {
		return false;
	}
	controller->moving.rest_state = rest_state;
	controller->state = moving_state;
	lw_moving_start(controller, window, m);
	return true;
}

void lw_moving_halt(struct lw_controller *controller, enum lw_state rest_state)
{
	controller->moving.halting = true;
	controller->moving.rest_state = rest_state;
}

void lw_moving_serve_halt(struct lw_controller *controller)
{
	const struct lw_law_window track = lw_carriage_track_window(controller);
	struct lw_motion *motion = &controller->motion;

	if (!controller->moving.halting || controller->moving.halt_sent ||
	    (controller->indexed && lw_law_region(&track, lw_motion_m(motion)) != 0)) {
		return;
	}

	/* Without edges for a moment: the ramp down must fit the slope that it begins with. */
	lw_motion_set_source(motion, LW_EDGE_SOURCE_NONE);
	if (motion->law.u == 0) {
		return; /* before its first edge, or in a dwell: at rest already */
	}

	struct lw_law_window *window = lw_carriage_spare_window(controller);

	lw_move_halt(motion->law.u, window, controller->derived->ka);
	lw_motion_set_position(motion, window, lw_motion_m(motion), motion->law.u);
	motion->requests = 0;
	motion->stop_at_rest = LW_MOTION_PLUS | LW_MOTION_MINUS;
	controller->moving.halt_sent = true;
	lw_motion_set_source(motion, LW_EDGE_SOURCE_TIMER);
}

void lw_moving_tick(struct lw_controller *controller)
{
	if (controller->motion.source == LW_EDGE_SOURCE_NONE) {
		lw_carriage_cut(controller);
		controller->state = controller->moving.rest_state;
		return;
	}
	lw_moving_serve_halt(controller);
}
