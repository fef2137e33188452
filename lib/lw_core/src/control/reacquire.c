/* SPDX-License-Identifier: Apache-2.0 */
#include "reacquire.h"

#include "fault.h"
#include "lw/motion/move.h"
#include "tracking.h"

/*
 * The carriage begins at the far point of a reversal, whose place alone is unknown: the law's own
 * second half of it leads to the sweep, away from the end behind it, whichever way the drum turns.
 * So each edge is one of the orbit, and drum edges that come back lead back.
 *
 *   phase    ends when                             next      otherwise
 *   (start)  a switch is actuated: away from it    SEEKING   both, wiring: fault
 *   SEEKING  the switch ahead triggers, in sweep   TRACKING  travel: REACQUIRE_NO_SWITCH
 *            it does so on the ramp                TURNING   the other one: REACQUIRE_WRONG_SWITCH
 *   TURNING  in the sweep                          TRACKING
 */

/** Away from a switch that is actuated, else as before the restart, else as after an indexing. */
static int direction_to_go(const struct lw_controller *controller)
{
	const int drum = controller->speed.edges_per_s > 0 ? 1 : -1;
	const int kept = controller->reacquire.kept_direction;
	const int side = (int)controller->params->handover_direction;

	if (controller->limit[LW_PLUS].active) {
		return -1;
	}
	if (controller->limit[LW_MINUS].active) {
		return 1;
	}
	return drum * (kept != 0 ? kept : lw_side_direction(side));
}

void lw_reacquire_start(struct lw_controller *controller)
{
	struct lw_reacquire *reacquire = &controller->reacquire;
	struct lw_motion *motion = &controller->motion;
	struct lw_law_window *spare = lw_carriage_spare_window(controller);
	const struct lw_derived *derived = controller->derived;
	int32_t m;

	reacquire->wanted = false;
	lw_carriage_cut(controller);
	if (lw_fault_stop_by_wiring(controller)) {
		return;
	}
	if (controller->limit[LW_PLUS].active && controller->limit[LW_MINUS].active) {
		lw_fault_stop(controller, LW_FAULT_BOTH_SWITCHES_ACTIVE);
		return;
	}
	reacquire->side = direction_to_go(controller) > 0 ? LW_PLUS : LW_MINUS;
	reacquire->began_on_switch = controller->limit[!reacquire->side].active;
	reacquire->turning = false;
	m = lw_move_from_far_point(spare, derived->ka, derived->nr, derived->travel_usteps,
				   lw_side_direction(reacquire->side));
	reacquire->begin_usteps = lw_law_pos_usteps(m);
	lw_motion_set_position(motion, spare, m, 0);
	controller->state = LW_STATE_REACQUIRING;
	reacquire->begun++;
	/* Whatever comes of it, the rope is not where the pattern would have laid it. */
	lw_los_note(&controller->los.reacquired, controller->now_us, 0);
	lw_motion_begin_pattern(motion);
	lw_motion_set_source(motion, LW_EDGE_SOURCE_ENCODER);
}

/**
 * Go over to the pattern: the carriage is in a sweep, and `shift_usteps` leads from where the law
 * counts it to where it is. What would be past the pattern's sweep is brought to its border, where
 * the reversal begins, and made good later.
 */
static void take_up(struct lw_controller *controller)
{
	struct lw_reacquire *reacquire = &controller->reacquire;
	struct lw_motion *motion = &controller->motion;
	struct lw_law_window *spare = lw_carriage_spare_window(controller);
	int32_t rest_usteps = 0;
	int64_t m;

	*spare = lw_carriage_track_window(controller);
	m = lw_motion_m(motion) + (int64_t)reacquire->shift_usteps * LW_USTEP;
	if (m >= spare->sweep_end) {
		rest_usteps = (int32_t)((m - spare->sweep_end) / LW_USTEP) + 1;
	} else if (m < spare->sweep_begin) {
		rest_usteps = -(int32_t)((spare->sweep_begin - m + LW_USTEP - 1) / LW_USTEP);
	}
	m -= (int64_t)rest_usteps * LW_USTEP;
	lw_motion_set_position(motion, spare, (int32_t)m, motion->law.u);
	motion->requests = 0;
	controller->indexed = true;
	controller->moving.shift_usteps = 0;
	reacquire->done++;
	lw_tracking_begin(controller);
	if (rest_usteps != 0) {
		motion->request_correction_usteps = rest_usteps;
		lw_motion_request(motion, LW_MOTION_REQUEST_CORRECTION);
	}
}

/** Begin a reversal at once, from the slope that the ramp has reached. */
static void turn(struct lw_controller *controller)
{
	struct lw_motion *motion = &controller->motion;
	struct lw_law_window *spare = lw_carriage_spare_window(controller);
	const struct lw_derived *derived = controller->derived;
	const int32_t m = lw_move_turn(spare, derived->ka, derived->nr, derived->travel_usteps,
				       lw_side_direction(controller->reacquire.side),
				       lw_motion_m(motion), motion->law.u);

	lw_motion_set_position(motion, spare, m, motion->law.u);
	controller->reacquire.turning = true;
	lw_motion_set_source(motion, LW_EDGE_SOURCE_ENCODER);
}

/**
 * The law is placed anew between two edges. One that comes in between moves nothing: the place
 * becomes known to a microstep only anyway.
 */
static void go_on(struct lw_controller *controller)
{
	struct lw_motion *motion = &controller->motion;

	lw_motion_set_source(motion, LW_EDGE_SOURCE_NONE);
	if (lw_motion_in_sweep(motion)) {
		take_up(controller);
	} else if (!controller->reacquire.turning) {
		turn(controller);
	} else {
		lw_motion_set_source(motion, LW_EDGE_SOURCE_ENCODER);
	}
}

/** The switch behind is actuated, and the carriage cannot be still on its way off it. */
static bool wrong_switch(const struct lw_controller *controller, int32_t way_usteps)
{
	const struct lw_reacquire *reacquire = &controller->reacquire;
	const struct lw_derived *derived = controller->derived;
	const int32_t between = derived->switch_usteps[LW_PLUS] - derived->switch_usteps[LW_MINUS];
	const int32_t beyond_usteps =
		derived->travel_usteps - between + derived->switch_hysteresis_usteps;

	return controller->limit[!reacquire->side].active &&
	       !(reacquire->began_on_switch && way_usteps <= beyond_usteps);
}

void lw_reacquire_tick(struct lw_controller *controller, const struct lw_carriage_trigger *triggers)
{
	struct lw_reacquire *reacquire = &controller->reacquire;
	const struct lw_derived *derived = controller->derived;
	const int side = reacquire->side;
	const int32_t way_usteps = lw_side_direction(side) *
				   (lw_carriage_pos_usteps(controller) - reacquire->begin_usteps);

	if (lw_fault_stop_by_wiring(controller)) {
		return;
	}
	if (reacquire->turning) {
		go_on(controller);
	} else if (triggers[side].taken &&
		   lw_carriage_triggered_outward(controller, &triggers[side].at, side)) {
		reacquire->shift_usteps =
			derived->switch_usteps[side] - triggers[side].at.pos_usteps;
		go_on(controller);
	} else if (wrong_switch(controller, way_usteps)) {
		lw_fault_stop(controller, LW_FAULT_REACQUIRE_WRONG_SWITCH);
	} else if (way_usteps > derived->travel_usteps) {
		lw_fault_stop(controller, LW_FAULT_REACQUIRE_NO_SWITCH);
	}
}
