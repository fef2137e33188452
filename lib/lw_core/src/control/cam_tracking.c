/* SPDX-License-Identifier: Apache-2.0 */
#include "cam_tracking.h"

#include <stddef.h>

#include "lw/control/cam_check.h"
#include "lw/control/controller.h"
#include "moving.h"
#include "tracking.h"

/** Most steps of one edge: what the pulse rate leaves room for, and what the table asks for. */
static uint8_t steps_max(const struct lw_controller *controller, const struct lw_cam_bank *bank)
{
	const struct lw_params *params = controller->params;
	const uint32_t by_rate = params->cam_steps_per_s_max / params->overspeed_trip_edges_per_s;
	const uint32_t by_table = (bank->statistics.slope_max_permille + 999) / 1000;
	const uint32_t steps = by_rate > by_table ? by_rate : by_table;

	return steps > LW_CAM_STEPS_PER_EDGE_MAX ? LW_CAM_STEPS_PER_EDGE_MAX
	       : steps > 0                       ? (uint8_t)steps
						 : 1;
}

/** Prepare the cam at the master's place in the cycle, for a carriage that stands there. */
static void prepare(struct lw_controller *controller, int32_t pos_usteps)
{
	struct lw_cam_motion *cam = &controller->motion.cam;
	const struct lw_cam_table *table = &controller->cam_bank->table;
	const struct lw_cam_scale scale = lw_cam_params_scale(controller->params);
	const struct lw_motion_reading reading = lw_motion_read(&controller->motion);
	const int64_t net_edges = reading.net_edges;
	const bool relative = controller->params->cam_start == LW_CAM_START_RELATIVE;

	cam->next = NULL;
	cam->steps_max = steps_max(controller, controller->cam_bank);
	cam->unfollowed_edges = reading.unfollowed_edges;
	cam->phase_edges = cam->phase_target_edges;
	cam->waiting = controller->params->cam_start == LW_CAM_START_NEXT_CYCLE;
	lw_cam_start(&cam->cam, table, &scale, 0, 0);
	cam->begin_usteps = (int32_t)cam->cam.point.pos_usteps;
	lw_cam_start(&cam->cam, table, &scale, (relative ? 0 : net_edges) + cam->phase_edges, 0);
	lw_cam_count_from_here(&cam->cam);
	cam->ring.count = 0;
	lw_cam_motion_prepare(cam);
	cam->owed_usteps =
		relative ? 0
			 : (cam->waiting ? cam->begin_usteps : (int32_t)cam->cam.point.pos_usteps) -
				   pos_usteps;
}

void lw_cam_hand_over(struct lw_controller *controller)
{
	struct lw_motion *motion = &controller->motion;
	struct lw_cam_motion *cam = &motion->cam;
	struct lw_law_window *spare = lw_carriage_spare_window(controller);
	const int32_t m = lw_motion_m(motion);
	const int32_t pos_usteps = lw_law_pos_usteps(m);
	int64_t shift_usteps = 0;

	if (controller->cam_bank == NULL) {
		if (controller->cam_refusal.reason == LW_REASON_NONE) {
			controller->cam_refusal =
				(struct lw_cam_refusal){.reason = LW_REASON_CAM_NO_TABLE};
		}
		return;
	}
	prepare(controller, pos_usteps);
	if (controller->params->cam_start == LW_CAM_START_RELATIVE) {
		shift_usteps = pos_usteps - lw_cam_pos(&cam->cam);
	}
	if (lw_cam_bank_check_flanges(controller->cam_bank, &controller->cam_bank->statistics,
				      controller->params, shift_usteps, &controller->cam_refusal)) {
		return;
	}
	if (cam->owed_usteps > cam->steps_max || cam->owed_usteps < -cam->steps_max) {
		lw_moving_to(controller, m, pos_usteps + cam->owed_usteps, LW_STATE_CENTRING,
			     LW_STATE_READY);
		return;
	}

	controller->cam_refusal = (struct lw_cam_refusal){0};
	/* The law carries the position. Its slope says no more than that the carriage follows. */
	*spare = lw_carriage_track_window(controller);
	lw_motion_set_position(motion, spare, pos_usteps * LW_USTEP, LW_USTEP);
	motion->requests = 0;
	cam->on = true;
	lw_tracking_begin(controller);
}

int64_t lw_cam_shift_usteps(const struct lw_controller *controller)
{
	const struct lw_cam_motion *cam = &controller->motion.cam;
	struct lw_cam_reading reading;
	int32_t m;

	/* Both of the same edge, or with edges between them that gave no step. */
	do {
		m = lw_motion_m(&controller->motion);
		reading = lw_cam_motion_read(cam);
	} while (m != lw_motion_m(&controller->motion));
	return (int64_t)lw_law_pos_usteps(m) + reading.owed_usteps -
	       (reading.waiting ? cam->begin_usteps : reading.pos_usteps);
}

void lw_cam_queue(struct lw_controller *controller, const struct lw_cam_bank *bank)
{
	struct lw_cam_motion *cam = &controller->motion.cam;
	const uint8_t steps = steps_max(controller, bank);

	if (steps > cam->steps_max) {
		cam->steps_max = steps;
	}
	cam->next = &bank->table;
}
