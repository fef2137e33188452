/* SPDX-License-Identifier: Apache-2.0 */
#include "carriage_acts.h"

#include <errno.h>

#include "lw/bytes/numbers.h"
#include "lw/bytes/require.h"

int lw_carriage_busy(struct lw_refusal *why, enum lw_reason reason)
{
	why->reason = (uint16_t)reason;
	return -EBUSY;
}

void lw_carriage_cut(struct lw_controller *controller)
{
	struct lw_motion *motion = &controller->motion;

	lw_motion_set_source(motion, LW_EDGE_SOURCE_NONE);
	if (motion->cam.on && controller->params->cam_axis == LW_CAM_AXIS_FREE) {
		lw_motion_set_position(motion, motion->window, 0, 0);
	}
	motion->cam.on = false;
	motion->requests = 0;
	motion->request_correction_usteps = 0;
	motion->stop_at_rest = 0;
	controller->moving.halting = false;
	controller->moving.halt_sent = false;
}

struct lw_law_window *lw_carriage_spare_window(struct lw_controller *controller)
{
	return controller->motion.window == &controller->windows[0] ? &controller->windows[1]
								    : &controller->windows[0];
}

struct lw_law_window lw_carriage_track_window(const struct lw_controller *controller)
{
	return lw_params_window(controller->params, controller->derived, controller->trim.plus_um,
				controller->trim.minus_um);
}

void lw_carriage_request(struct lw_controller *controller, struct lw_law_window window,
			 enum lw_motion_request request, int32_t correction_usteps)
{
	LW_REQUIRE(window.ka > 0 && window.ks > 0 && window.sweep_begin < window.sweep_end);
	struct lw_motion *motion = &controller->motion;
	struct lw_law_window *spare;

	/* Withdraw an earlier window first: the interrupt must not read it half changed. */
	motion->requests &= LW_MOTION_REQUEST_CORRECTION;
	spare = lw_carriage_spare_window(controller);
	*spare = window;
	motion->request_window = spare;
	if (request == LW_MOTION_REQUEST_REBASE) {
		motion->requests = 0;
		motion->request_correction_usteps = correction_usteps;
	}
	lw_motion_request(motion, (uint8_t)request);
}

int32_t lw_carriage_pos_usteps(const struct lw_controller *controller)
{
	return lw_law_pos_usteps(lw_motion_m(&controller->motion));
}

int32_t lw_carriage_lag_usteps(const struct lw_controller *controller, int32_t u)
{
	/* A jog is not judged by switches: then the rate does not matter. */
	const int64_t edges_per_s = controller->motion.source == LW_EDGE_SOURCE_TIMER
					    ? controller->params->index_rate_edges_per_s
					    : controller->speed.edges_per_s;

	if (controller->motion.cam.on) {
		return 0;
	}
	/* Below 2^16 * 2^30 * 2^15 for any drum that a counter of 32 bit can follow. */
	return (int32_t)lw_divide_nearest(edges_per_s * u * controller->params->switch_delay_us,
					  (int64_t)1000000 * LW_USTEP);
}

int32_t lw_carriage_lag_max_usteps(const struct lw_controller *controller)
{
	const int32_t lag_usteps = lw_carriage_lag_usteps(controller, controller->derived->ks);

	return lag_usteps < 0 ? -lag_usteps : lag_usteps;
}

uint32_t lw_carriage_tolerance_edges(const struct lw_controller *controller)
{
	const int64_t q16 = (int64_t)controller->derived->switch_tolerance_usteps * LW_USTEP;

	return (uint32_t)(q16 / (4 * (int64_t)controller->derived->ks)) + 1;
}

bool lw_carriage_moves_toward(int direction, int side)
{
	return direction == lw_side_direction(side);
}

bool lw_carriage_triggered_outward(const struct lw_controller *controller,
				   const struct lw_limit_switch_trigger *at, int side)
{
	/* The slope is what a forward edge moves. Under a cam it moves nothing. */
	const int64_t outward = (int64_t)at->u * at->drum_direction * lw_side_direction(side);

	return lw_carriage_moves_toward(at->direction, side) ||
	       (outward > 0 && !controller->motion.cam.on);
}
