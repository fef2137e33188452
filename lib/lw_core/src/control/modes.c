/* SPDX-License-Identifier: Apache-2.0 */
#include "modes.h"

#include "cam_tracking.h"
#include "carriage_acts.h"
#include "moving.h"
#include "resume.h"
#include "tracking.h"

/** Follow the drum, from inside the sweep or from the pattern as it was left. */
static void hand_over(struct lw_controller *controller)
{
	const struct lw_law_window window = lw_carriage_track_window(controller);
	const int32_t m = lw_motion_m(&controller->motion);
	const int region = lw_law_region(&window, m);

	if (controller->params->motion_profile == LW_MOTION_PROFILE_CAM) {
		lw_cam_hand_over(controller);
	} else if (controller->resume.wanted && lw_resume_approach(controller)) {
		return; /* on the way to where the rope goes on */
	} else if (controller->on_orbit || region == 0) {
		lw_tracking_start(controller);
	} else {
		/* The sweep's slope in a reversal would stay wrong for ever: go inside first. */
		lw_moving_to(controller, m,
			     region < 0 ? lw_law_pos_usteps(window.sweep_end) - 2
					: lw_law_pos_usteps(window.sweep_begin) + 2,
			     LW_STATE_CENTRING, LW_STATE_READY);
	}
}

void lw_modes_tick(struct lw_controller *controller)
{
	const enum lw_mode wanted = controller->requested_mode;

	if (wanted == LW_MODE_OFF) {
		if (controller->state != LW_STATE_OFF) {
			lw_carriage_cut(controller);
			controller->state = LW_STATE_OFF;
			controller->indexed = false;
			controller->on_orbit = false;
		}
		controller->mode = wanted;
		return;
	}
	if (controller->state == LW_STATE_OFF) {
		controller->state = controller->fault ? LW_STATE_FAULT : LW_STATE_UNINDEXED;
	}
	if ((controller->indexed || controller->state == LW_STATE_REACQUIRING) &&
	    wanted != controller->mode && !controller->speed.at_rest) {
		return; /* finish what the drum does first */
	}
	controller->mode = wanted;
	if (controller->held) {
		return;
	}
	if (wanted == LW_MODE_TRACK) {
		if (controller->indexed &&
		    (controller->state == LW_STATE_READY ||
		     controller->state == LW_STATE_CENTRED) &&
		    controller->speed.at_rest && !controller->storing) {
			hand_over(controller);
		}
	} else if (controller->state == LW_STATE_REACQUIRING) {
		/* At rest: the launch is over, and the place unknown. */
		lw_carriage_cut(controller);
		controller->state = LW_STATE_UNINDEXED;
	} else if (controller->state == LW_STATE_TRACKING || controller->state == LW_STATE_READY) {
		if (controller->state == LW_STATE_TRACKING) {
			lw_tracking_leave(controller);
		}
		lw_moving_to(controller, lw_motion_m(&controller->motion),
			     controller->derived->centre_usteps, LW_STATE_CENTRING,
			     LW_STATE_CENTRED);
	}
}
