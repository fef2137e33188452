#include "controller_internal.h"

#include "lw/move.h"

/** A ramp, or the way to rest, in whole microsteps rounded up. */
static int32_t ramp_usteps(const struct lw_controller *controller)
{
	return controller->derived->overshoot_q16 / LW_USTEP + 2;
}

static int32_t pos_usteps(const struct lw_controller *controller)
{
	return lw_law_pos_usteps(lw_motion_m(&controller->motion));
}

/** Begin at rest at m (Q16.16), in a window, and start the edge timer. */
static void start_timer(struct lw_controller *controller, struct lw_law_window window, int32_t m)
{
	struct lw_motion *motion = &controller->motion;

	struct lw_law_window *spare = lw_controller_spare_window(controller);

	*spare = window;
	lw_motion_place(motion, spare, m, 0);
	motion->requests = 0;
	motion->stop_at_rest = LW_MOTION_PLUS | LW_MOTION_MINUS;
	controller->halting = false;
	controller->halt_sent = false;
	controller->on_orbit = false;
	lw_motion_set_source(motion, LW_EDGE_SOURCE_TIMER);
}

void lw_homing_move_to(struct lw_controller *controller, int32_t m, int32_t target_usteps,
		       enum lw_state moving_state, enum lw_state rest_state)
{
	struct lw_law_window window;

	controller->on_orbit = false;
	controller->rest_state = rest_state;
	if (lw_move_to(m, &window, controller->derived->ka, controller->derived->nr,
		       target_usteps)) {
		controller->state = moving_state;
		start_timer(controller, window, m);
	} else {
		/* Whatever the pattern was doing, the carriage is at rest now. */
		lw_motion_place(&controller->motion, controller->motion.window, m, 0);
		controller->state = rest_state;
	}
}

void lw_homing_halt(struct lw_controller *controller, enum lw_state rest_state)
{
	controller->halting = true;
	controller->rest_state = rest_state;
}

static void start_seeking(struct lw_controller *controller)
{
	struct lw_law_window window;
	const int32_t m = lw_move_run(&window, controller->derived->ka, controller->derived->nr,
				      lw_side_direction((int)controller->params->index_switch));

	controller->state = LW_STATE_SEEKING;
	start_timer(controller, window, m);
}

static void start_backing_off(struct lw_controller *controller, int side)
{
	controller->back_off_side = side;
	controller->releasing = false;
	/* Farther than may be needed; cut short where the switch releases. */
	lw_homing_move_to(controller, 0,
			  -lw_side_direction(side) * controller->derived->travel_usteps,
			  LW_STATE_BACKING_OFF, LW_STATE_SEEKING);
}

void lw_homing_start(struct lw_controller *controller)
{
	const bool plus = controller->limit[LW_PLUS].active || controller->overtravel[LW_PLUS];
	const bool minus = controller->limit[LW_MINUS].active || controller->overtravel[LW_MINUS];

	lw_controller_cut(controller);
	controller->state = LW_STATE_UNINDEXED;
	controller->indexed = false;
	controller->on_orbit = false;
	lw_controller_clear_fault(controller);

	if (controller->wiring[LW_PLUS]) {
		lw_controller_fail(controller, LW_FAULT_WIRING_PLUS);
	} else if (controller->wiring[LW_MINUS]) {
		lw_controller_fail(controller, LW_FAULT_WIRING_MINUS);
	} else if (plus && minus) {
		lw_controller_fail(controller, LW_FAULT_BOTH_SWITCHES_ACTIVE);
	} else if (plus || minus) {
		start_backing_off(controller, plus ? LW_PLUS : LW_MINUS);
	} else {
		start_seeking(controller);
	}
}

static void tick_backing_off(struct lw_controller *controller)
{
	struct lw_motion *motion = &controller->motion;
	const int side = controller->back_off_side;
	const int direction = -lw_side_direction(side);
	const bool active = controller->limit[side].active || controller->overtravel[side];

	if (controller->limit[!side].active) {
		lw_controller_fail(controller, active ? LW_FAULT_BOTH_SWITCHES_ACTIVE
						      : LW_FAULT_INDEX_WRONG_SWITCH);
		return;
	}
	if (!active && !controller->releasing && !controller->halting) {
		/* Go on by what the seek needs to reach its full slope before the trigger. */
		const int32_t rest_usteps =
			pos_usteps(controller) +
			direction * (controller->derived->switch_hysteresis_usteps +
				     2 * ramp_usteps(controller));
		struct lw_law_window window = *motion->window;
		const int32_t slow_down =
			rest_usteps * LW_USTEP - direction * controller->derived->overshoot_q16;

		if (direction > 0) {
			window.sweep_end = slow_down;
		} else {
			window.sweep_begin = slow_down;
		}
		lw_controller_request(controller, window, LW_MOTION_REQUEST_SWAP, 0);
		controller->releasing = true;
	}
	if (direction * pos_usteps(controller) > controller->derived->travel_usteps / 2 &&
	    !controller->releasing) {
		lw_controller_fail(controller, LW_FAULT_BACK_OFF_NO_RELEASE);
	}
}

static void tick_seeking(struct lw_controller *controller,
			 const struct lw_controller_trigger *triggers)
{
	const struct lw_derived *derived = controller->derived;
	const int side = (int)controller->params->index_switch;
	const int direction = lw_side_direction(side);
	const int32_t trigger_usteps = triggers[side].at.pos_usteps;

	if (controller->halting) {
		return;
	}
	if (controller->limit[!side].active) {
		lw_controller_fail(controller, LW_FAULT_INDEX_WRONG_SWITCH);
	} else if (triggers[side].taken &&
		   (direction > 0 ? trigger_usteps < 0 : trigger_usteps >= 0)) {
		/* Still on the ramp, which ends at 0: come again from further away. */
		lw_homing_halt(controller, LW_STATE_BACKING_OFF);
	} else if (triggers[side].taken) {
		lw_controller_request(controller, lw_controller_track_window(controller),
				      LW_MOTION_REQUEST_REBASE,
				      derived->switch_usteps[side] - trigger_usteps);
		controller->motion.stop_at_rest = 0;
		controller->state = LW_STATE_INDEX_REVERSAL;
	} else if (direction * pos_usteps(controller) >
		   derived->travel_usteps + ramp_usteps(controller)) {
		lw_controller_fail(controller, LW_FAULT_INDEX_NO_SWITCH);
	}
}

/** Ask for the way to rest at the parking place. */
static void start_parking(struct lw_controller *controller)
{
	const int direction = lw_side_direction((int)controller->params->index_switch);

	controller->state = LW_STATE_PARKING;
	controller->rest_state = LW_STATE_READY;
	if (controller->params->park_at == LW_PARK_AT_FLANGE) {
		/* Rest at the far point of the coming reversal: the state stays on the orbit. */
		controller->motion.stop_at_rest = direction > 0 ? LW_MOTION_MINUS : LW_MOTION_PLUS;
		return;
	}

	/* Turn round once more, then begin the last reversal one overshoot before the place. */
	const int32_t slow_down = controller->derived->park_usteps * LW_USTEP -
				  direction * controller->derived->overshoot_q16;
	struct lw_law_window window = lw_controller_track_window(controller);

	window.dwell_plus_edges = 0;
	window.dwell_minus_edges = 0;
	if (direction > 0) {
		window.sweep_end = slow_down;
	} else {
		window.sweep_begin = slow_down;
	}
	controller->motion.stop_at_rest = direction > 0 ? LW_MOTION_PLUS : LW_MOTION_MINUS;
	lw_controller_request(controller, window, LW_MOTION_REQUEST_WINDOW, 0);
}

static void tick_span_check(struct lw_controller *controller,
			    const struct lw_controller_trigger *triggers)
{
	const struct lw_derived *derived = controller->derived;
	const int side = !controller->params->index_switch;
	const int direction = lw_side_direction(side);

	if (triggers[side].taken) {
		const int32_t error = triggers[side].at.pos_usteps - derived->switch_usteps[side];

		controller->span_error_usteps = error;
		if (error > derived->span_tolerance_usteps ||
		    error < -derived->span_tolerance_usteps) {
			lw_controller_fail(controller, LW_FAULT_INDEX_SPAN);
		} else {
			start_parking(controller);
		}
	} else if ((direction * (pos_usteps(controller) - derived->switch_usteps[side]) >
			    derived->span_tolerance_usteps &&
		    !controller->limit[side].candidate) || /* closed in time, still bouncing? */
		   lw_controller_moves_toward(lw_motion_direction(&controller->motion), !side)) {
		/* Too far, or turned round already: the switch did not trigger where it should. */
		controller->span_error_usteps =
			pos_usteps(controller) - derived->switch_usteps[side];
		lw_controller_fail(controller, LW_FAULT_INDEX_SPAN);
	}
}

/** The far point of the last reversal is reached: the index is complete. */
static void finish_index(struct lw_controller *controller)
{
	controller->indexed = true;
	controller->on_orbit = controller->params->park_at == LW_PARK_AT_FLANGE;
	for (int side = 0; side < 2; side++) {
		controller->los1[side].set = false;
		controller->los2[side].set = false;
	}
	controller->los_recoveries = 0;
}

/** Jogging without an index: the limit switches are the limits. */
static bool jog_must_end(const struct lw_controller *controller)
{
	const int side = controller->move_direction > 0 ? LW_PLUS : LW_MINUS;

	return controller->now_us - controller->jog_written_us >
		       (uint64_t)controller->params->jog_hold_ms * 1000 ||
	       (!controller->indexed && controller->limit[side].active);
}

/** Begin the ramp down once the carriage is where it may come to rest. */
static void serve_halt(struct lw_controller *controller)
{
	const struct lw_law_window track = lw_controller_track_window(controller);
	struct lw_motion *motion = &controller->motion;

	if (!controller->halting || controller->halt_sent ||
	    (controller->indexed && lw_law_region(&track, lw_motion_m(motion)) != 0)) {
		return;
	}

	/* Without edges for a moment: the ramp down must fit the slope that it begins with. */
	lw_motion_set_source(motion, LW_EDGE_SOURCE_NONE);
	if (motion->law.u == 0) {
		return; /* before its first edge, or in a dwell: at rest already */
	}

	struct lw_law_window *window = lw_controller_spare_window(controller);

	lw_move_halt(motion->law.u, window, controller->derived->ka);
	lw_motion_place(motion, window, lw_motion_m(motion), motion->law.u);
	motion->requests = 0;
	motion->stop_at_rest = LW_MOTION_PLUS | LW_MOTION_MINUS;
	controller->halt_sent = true;
	lw_motion_set_source(motion, LW_EDGE_SOURCE_TIMER);
}

void lw_homing_tick(struct lw_controller *controller, const struct lw_controller_trigger *triggers)
{
	struct lw_motion *motion = &controller->motion;
	const bool at_rest = motion->source == LW_EDGE_SOURCE_NONE;

	if (at_rest) {
		const enum lw_state rest_state = controller->rest_state;

		if (controller->state == LW_STATE_PARKING && !controller->halting) {
			finish_index(controller);
		}
		lw_controller_cut(controller);
		if (rest_state == LW_STATE_BACKING_OFF) {
			start_backing_off(controller, (int)controller->params->index_switch);
		} else if (rest_state == LW_STATE_SEEKING) {
			if (controller->releasing) {
				start_seeking(controller);
			} else {
				lw_controller_fail(controller, LW_FAULT_BACK_OFF_NO_RELEASE);
			}
		} else {
			controller->state = rest_state;
		}
		return;
	}

	/* Without an index the switches must tell the truth; only a jog does without them. */
	if (!controller->indexed && controller->state != LW_STATE_JOGGING &&
	    (controller->wiring[LW_PLUS] || controller->wiring[LW_MINUS])) {
		lw_controller_fail(controller, controller->wiring[LW_PLUS] ? LW_FAULT_WIRING_PLUS
									   : LW_FAULT_WIRING_MINUS);
		return;
	}

	switch (controller->state) {
	case LW_STATE_BACKING_OFF:
		tick_backing_off(controller);
		break;
	case LW_STATE_SEEKING:
		tick_seeking(controller, triggers);
		break;
	case LW_STATE_INDEX_REVERSAL:
		if (motion->requests == 0 && lw_motion_in_sweep(motion) &&
		    lw_controller_moves_toward(lw_motion_direction(motion),
					       !controller->params->index_switch)) {
			controller->state = LW_STATE_SPAN_CHECK;
		}
		break;
	case LW_STATE_SPAN_CHECK:
		tick_span_check(controller, triggers);
		break;
	case LW_STATE_JOGGING:
		if (!controller->halting && jog_must_end(controller)) {
			lw_homing_halt(controller, controller->rest_state);
		}
		break;
	default:
		break;
	}
	serve_halt(controller);
}
