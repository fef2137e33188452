/* SPDX-License-Identifier: Apache-2.0 */
#include "tracking.h"

#include "los_judge.h"
#include "lw/bytes/require.h"

void lw_tracking_begin(struct lw_controller *controller)
{
	LW_REQUIRE(controller->indexed && !controller->storing);
	struct lw_motion *motion = &controller->motion;

	controller->on_orbit = false;
	lw_los_judge_begin(controller);
	motion->stop_at_rest = 0;
	controller->state = LW_STATE_TRACKING;
	lw_motion_begin_pattern(motion);
	lw_motion_set_source(motion, LW_EDGE_SOURCE_ENCODER);
}

void lw_tracking_start(struct lw_controller *controller)
{
	struct lw_motion *motion = &controller->motion;

	if (!controller->on_orbit) {
		struct lw_law_window *spare = lw_carriage_spare_window(controller);
		const int32_t ks = controller->derived->ks;

		*spare = lw_carriage_track_window(controller);
		lw_motion_set_position(
			motion, spare, lw_motion_m(motion),
			controller->params->handover_direction == LW_SIDE_PLUS ? ks : -ks);
		motion->requests = 0;
	}
	lw_tracking_begin(controller);
}

void lw_tracking_leave(struct lw_controller *controller)
{
	LW_REQUIRE(controller->state == LW_STATE_TRACKING && controller->speed.at_rest);
	struct lw_motion *motion = &controller->motion;
	const bool by_cam = motion->cam.on;
	int32_t correction_usteps;
	bool corrected;

	/* First: an edge that made the correction meanwhile would make it twice. */
	lw_motion_set_source(motion, LW_EDGE_SOURCE_NONE);
	corrected = motion->requests & LW_MOTION_REQUEST_CORRECTION;
	correction_usteps = motion->request_correction_usteps;
	lw_carriage_cut(controller);
	controller->on_orbit = !corrected && !by_cam;
	if (corrected) {
		/* Out of the pattern a held correction can be made at once. */
		const uint32_t m = (uint32_t)lw_motion_m(motion);

		/* Modulo 2^32: where it leads to is a position, however long the way there. */
		lw_motion_set_position(motion, motion->window,
				       (int32_t)(m + (uint32_t)correction_usteps * LW_USTEP),
				       motion->law.u);
	}
}
