/* SPDX-License-Identifier: Apache-2.0 */
#include "homing.h"

#include <stddef.h>

#include "fault.h"
#include "lw/bytes/require.h"
#include "lw/motion/move.h"
#include "moving.h"
#include "resume.h"

/*
 * How an indexing goes on. In each phase `tick` runs every tick while the edge timer drives the
 * carriage, `rest` once when it has come to rest; every way out ends in the state FAULT.
 *
 *   phase       ends when                               next             otherwise
 *   (start)     a switch is actuated                    LEAVING          both, wiring: fault
 *               none is                                 SEEKING
 *   LEAVING     it has released                         LEFT             at rest, half the travel:
 *                                                                        BACK_OFF_NO_RELEASE
 *   LEFT        at rest                                 SEEKING
 *   SEEKING     the switch triggers                     TURNING          travel: INDEX_NO_SWITCH
 *               it does so on the ramp up               TOO_CLOSE
 *   TOO_CLOSE   at rest                                 LEAVING
 *   TURNING     in the sweep, on the way back           SPAN_CHECK
 *   SPAN_CHECK  the other switch triggers in its place  PARKING          INDEX_SPAN
 *   PARKING     at rest                                 state READY
 *   any         STOP                                    STOPPING
 *   STOPPING    at rest                                 state UNINDEXED
 *
 * LEAVING, LEFT and SEEKING also fail when the switch of the other side is actuated.
 */
struct phase {
	enum lw_state state; /**< that the status shows */
	void (*tick)(struct lw_controller *controller, const struct lw_carriage_trigger *triggers);
	void (*rest)(struct lw_controller *controller);
};

static void tick_leaving(struct lw_controller *controller,
			 const struct lw_carriage_trigger *triggers);
static void rest_leaving(struct lw_controller *controller);
static void tick_left(struct lw_controller *controller, const struct lw_carriage_trigger *triggers);
static void start_seeking(struct lw_controller *controller);
static void tick_seeking(struct lw_controller *controller,
			 const struct lw_carriage_trigger *triggers);
static void rest_too_close(struct lw_controller *controller);
static void tick_turning(struct lw_controller *controller,
			 const struct lw_carriage_trigger *triggers);
static void tick_span_check(struct lw_controller *controller,
			    const struct lw_carriage_trigger *triggers);
static void rest_parking(struct lw_controller *controller);
static void rest_stopping(struct lw_controller *controller);
static void rest_unasked(struct lw_controller *controller);

static const struct phase phases[LW_HOMING_PHASES] = {
	[LW_HOMING_LEAVING] = {LW_STATE_BACKING_OFF, tick_leaving, rest_leaving},
	[LW_HOMING_LEFT] = {LW_STATE_BACKING_OFF, tick_left, start_seeking},
	[LW_HOMING_SEEKING] = {LW_STATE_SEEKING, tick_seeking, rest_unasked},
	[LW_HOMING_TOO_CLOSE] = {LW_STATE_SEEKING, NULL, rest_too_close},
	[LW_HOMING_TURNING] = {LW_STATE_INDEX_REVERSAL, tick_turning, rest_unasked},
	[LW_HOMING_SPAN_CHECK] = {LW_STATE_SPAN_CHECK, tick_span_check, rest_unasked},
	[LW_HOMING_PARKING] = {LW_STATE_PARKING, NULL, rest_parking},
	/* The state stays what it was when it was told to end. */
	[LW_HOMING_STOPPING] = {LW_STATE_UNINDEXED, NULL, rest_stopping},
};

static void enter(struct lw_controller *controller, enum lw_homing_phase phase)
{
	controller->homing.phase = phase;
	controller->state = phases[phase].state;
}

/** A ramp, or the way to rest, in whole microsteps rounded up. */
static int32_t ramp_usteps(const struct lw_controller *controller)
{
	return controller->derived->overshoot_q16 / LW_USTEP + 2;
}

static void start_seeking(struct lw_controller *controller)
{
	struct lw_law_window window;
	const int32_t m = lw_move_run(&window, controller->derived->ka, controller->derived->nr,
				      lw_side_direction((int)controller->params->index_switch));

	enter(controller, LW_HOMING_SEEKING);
	lw_moving_start(controller, window, m);
}

static void start_leaving(struct lw_controller *controller, int side)
{
	controller->homing.back_off_side = side;
	enter(controller, LW_HOMING_LEAVING);
	/* Farther than may be needed; cut short where the switch releases. */
	lw_moving_to(controller, 0, -lw_side_direction(side) * controller->derived->travel_usteps,
		     LW_STATE_BACKING_OFF, LW_STATE_BACKING_OFF);
}

/** An overtravel switch is actuated and its limit switch, further inside, is not: a broken wire? */
static bool overtravel_alone(const struct lw_controller *controller, int side)
{
	return controller->overtravel[side] && !controller->limit[side].active;
}

/**
 * The switches say that the carriage is at both ends at once, or never left one. An overtravel
 * switch that stands alone is the one to blame.
 */
static void fail_at_end(struct lw_controller *controller, enum lw_fault otherwise)
{
	const bool plus = overtravel_alone(controller, LW_PLUS);
	const bool minus = overtravel_alone(controller, LW_MINUS);

	lw_fault_stop(controller, plus == minus ? otherwise
				  : plus        ? LW_FAULT_OVERTRAVEL_PLUS
						: LW_FAULT_OVERTRAVEL_MINUS);
}

void lw_homing_start(struct lw_controller *controller)
{
	const bool plus = controller->limit[LW_PLUS].active || controller->overtravel[LW_PLUS];
	const bool minus = controller->limit[LW_MINUS].active || controller->overtravel[LW_MINUS];

	lw_carriage_cut(controller);
	controller->state = LW_STATE_UNINDEXED;
	controller->indexed = false;
	controller->on_orbit = false;
	lw_fault_clear(controller);
	lw_drum_watch_index_begins(&controller->drum_watch);

	if (lw_fault_stop_by_wiring(controller)) {
		return;
	}
	if (plus && minus) {
		fail_at_end(controller, LW_FAULT_BOTH_SWITCHES_ACTIVE);
	} else if (plus || minus) {
		start_leaving(controller, plus ? LW_PLUS : LW_MINUS);
	} else {
		start_seeking(controller);
	}
}

/** The other side's switch: the carriage has been driven the wrong way, or is at both ends. */
static bool wrong_switch(struct lw_controller *controller, bool still_active)
{
	if (!controller->limit[!controller->homing.back_off_side].active) {
		return false;
	}
	fail_at_end(controller,
		    still_active ? LW_FAULT_BOTH_SWITCHES_ACTIVE : LW_FAULT_INDEX_WRONG_SWITCH);
	return true;
}

static bool still_active(const struct lw_controller *controller)
{
	const int side = controller->homing.back_off_side;

	return controller->limit[side].active || controller->overtravel[side];
}

static void tick_leaving(struct lw_controller *controller,
			 const struct lw_carriage_trigger *triggers)
{
	const int direction = -lw_side_direction(controller->homing.back_off_side);
	const int32_t pos_usteps = lw_carriage_pos_usteps(controller);

	(void)triggers;
	if (wrong_switch(controller, still_active(controller))) {
		return;
	}
	if (!still_active(controller)) {
		/* Go on by what the seek needs to reach its full slope before the trigger. */
		const int32_t rest_usteps =
			pos_usteps + direction * (controller->derived->switch_hysteresis_usteps +
						  2 * ramp_usteps(controller));
		struct lw_law_window window = *controller->motion.window;
		const int32_t slow_down =
			rest_usteps * LW_USTEP - direction * controller->derived->overshoot_q16;

		if (direction > 0) {
			window.sweep_end = slow_down;
		} else {
			window.sweep_begin = slow_down;
		}
		lw_carriage_request(controller, window, LW_MOTION_REQUEST_SWAP, 0);
		enter(controller, LW_HOMING_LEFT);
	} else if (direction * pos_usteps > controller->derived->travel_usteps / 2) {
		fail_at_end(controller, LW_FAULT_BACK_OFF_NO_RELEASE);
	}
}

static void rest_leaving(struct lw_controller *controller)
{
	fail_at_end(controller, LW_FAULT_BACK_OFF_NO_RELEASE);
}

static void tick_left(struct lw_controller *controller, const struct lw_carriage_trigger *triggers)
{
	(void)triggers;
	(void)wrong_switch(controller, still_active(controller));
}

static void tick_seeking(struct lw_controller *controller,
			 const struct lw_carriage_trigger *triggers)
{
	const struct lw_derived *derived = controller->derived;
	const int side = (int)controller->params->index_switch;
	const int direction = lw_side_direction(side);
	const int32_t trigger_usteps = triggers[side].at.pos_usteps;

	if (controller->limit[!side].active) {
		lw_fault_stop(controller, LW_FAULT_INDEX_WRONG_SWITCH);
	} else if (triggers[side].taken &&
		   (direction > 0 ? trigger_usteps < 0 : trigger_usteps >= 0)) {
		/* Still on the ramp, which ends at 0: come again from further away. */
		enter(controller, LW_HOMING_TOO_CLOSE);
		lw_moving_halt(controller, LW_STATE_BACKING_OFF);
	} else if (triggers[side].taken) {
		lw_carriage_request(controller, lw_carriage_track_window(controller),
				    LW_MOTION_REQUEST_REBASE,
				    derived->switch_usteps[side] - trigger_usteps);
		controller->moving.shift_usteps += derived->switch_usteps[side] - trigger_usteps;
		controller->motion.stop_at_rest = 0;
		enter(controller, LW_HOMING_TURNING);
	} else if (direction * lw_carriage_pos_usteps(controller) >
		   derived->travel_usteps + ramp_usteps(controller)) {
		lw_fault_stop(controller, LW_FAULT_INDEX_NO_SWITCH);
	}
}

static void rest_too_close(struct lw_controller *controller)
{
	start_leaving(controller, (int)controller->params->index_switch);
}

static void tick_turning(struct lw_controller *controller,
			 const struct lw_carriage_trigger *triggers)
{
	const struct lw_motion *motion = &controller->motion;

	(void)triggers;
	if (motion->requests == 0 && lw_motion_in_sweep(motion) &&
	    lw_carriage_moves_toward(lw_motion_direction(motion),
				     !controller->params->index_switch)) {
		enter(controller, LW_HOMING_SPAN_CHECK);
	}
}

/** Ask for the way to rest at the parking place. */
static void start_parking(struct lw_controller *controller)
{
	const int direction = lw_side_direction((int)controller->params->index_switch);

	enter(controller, LW_HOMING_PARKING);
	if (controller->params->park_at == LW_PARK_AT_FLANGE) {
		/* Rest at the far point of the coming reversal: the state stays on the orbit. */
		controller->motion.stop_at_rest = direction > 0 ? LW_MOTION_MINUS : LW_MOTION_PLUS;
		return;
	}

	/* Turn round once more, then begin the last reversal one overshoot before the place. */
	const int32_t slow_down = controller->derived->park_usteps * LW_USTEP -
				  direction * controller->derived->overshoot_q16;
	struct lw_law_window window = lw_carriage_track_window(controller);

	window.dwell_plus_edges = 0;
	window.dwell_minus_edges = 0;
	window.breaker_edges = 0;
	window.breaker_cycles = 0;
	if (direction > 0) {
		window.sweep_end = slow_down;
	} else {
		window.sweep_begin = slow_down;
	}
	controller->motion.stop_at_rest = direction > 0 ? LW_MOTION_PLUS : LW_MOTION_MINUS;
	lw_carriage_request(controller, window, LW_MOTION_REQUEST_WINDOW, 0);
}

static void tick_span_check(struct lw_controller *controller,
			    const struct lw_carriage_trigger *triggers)
{
	const struct lw_derived *derived = controller->derived;
	const int side = !controller->params->index_switch;
	const int direction = lw_side_direction(side);

	if (triggers[side].taken) {
		const int32_t error = triggers[side].at.pos_usteps - derived->switch_usteps[side];

		controller->homing.span_error_usteps = error;
		if (error > derived->span_tolerance_usteps ||
		    error < -derived->span_tolerance_usteps) {
			lw_fault_stop(controller, LW_FAULT_INDEX_SPAN);
		} else {
			start_parking(controller);
		}
	} else if ((direction * (lw_carriage_pos_usteps(controller) -
				 derived->switch_usteps[side]) >
			    derived->span_tolerance_usteps +
				    lw_carriage_lag_max_usteps(controller) &&
		    !controller->limit[side].candidate) || /* closed in time, still bouncing? */
		   lw_carriage_moves_toward(lw_motion_direction(&controller->motion), !side)) {
		/* Too far, or turned round already: the switch did not trigger where it should. */
		controller->homing.span_error_usteps =
			lw_carriage_pos_usteps(controller) - derived->switch_usteps[side];
		lw_fault_stop(controller, LW_FAULT_INDEX_SPAN);
	}
}

/** The far point of the last reversal is reached: the index is complete. */
static void rest_parking(struct lw_controller *controller)
{
	controller->indexed = true;
	controller->on_orbit = controller->params->park_at == LW_PARK_AT_FLANGE;
	lw_law_begin_cycles(&controller->motion.law);
	lw_los_indexed(&controller->los,
		       lw_drum_watch_indexed(&controller->drum_watch, &controller->encoder_index));
	lw_rope_watch_settle(&controller->rope, controller->derived->edges_per_1000_drum_revs);
	controller->rope.indexed_since = true;
	controller->odometer_doubtful = false;
	lw_resume_indexed(controller);
	controller->state = LW_STATE_READY;
}

static void rest_stopping(struct lw_controller *controller)
{
	controller->state = controller->moving.rest_state;
}

/** These phases have no rest in them: if there was one, nothing that came before is sure. */
static void rest_unasked(struct lw_controller *controller)
{
	lw_fault_stop(controller, LW_FAULT_INDEX_NO_SWITCH);
}

bool lw_homing_is_under_way(const struct lw_controller *controller)
{
	switch (controller->state) {
	case LW_STATE_BACKING_OFF:
	case LW_STATE_SEEKING:
	case LW_STATE_INDEX_REVERSAL:
	case LW_STATE_SPAN_CHECK:
	case LW_STATE_PARKING:
		return true;
	default:
		return false;
	}
}

void lw_homing_stop(struct lw_controller *controller, enum lw_state rest_state)
{
	LW_REQUIRE(lw_homing_is_under_way(controller));
	controller->homing.phase = LW_HOMING_STOPPING;
	lw_moving_halt(controller, rest_state);
}

void lw_homing_tick(struct lw_controller *controller, const struct lw_carriage_trigger *triggers)
{
	const struct phase *phase = &phases[controller->homing.phase];

	if (controller->motion.source == LW_EDGE_SOURCE_NONE) {
		lw_carriage_cut(controller);
		phase->rest(controller);
		return;
	}
	if (lw_fault_stop_by_wiring(controller)) {
		return;
	}
	if (phase->tick != NULL) {
		phase->tick(controller, triggers);
	}
	lw_moving_serve_halt(controller);
}
