#include "lw/controller.h"

#include <errno.h>
#include <stddef.h>

#include "controller_internal.h"

/** The stepper driver's alarm counts when so many polls in a row have told it. */
#define STEPPER_ALARM_POLLS 3

static int busy(struct lw_refusal *why, enum lw_reason reason)
{
	why->reason = (uint16_t)reason;
	return -EBUSY;
}

void lw_controller_cut(struct lw_controller *controller)
{
	struct lw_motion *motion = &controller->motion;

	lw_motion_set_source(motion, LW_EDGE_SOURCE_NONE);
	if (motion->cam.on && controller->params->cam_axis == LW_CAM_AXIS_FREE) {
		lw_motion_place(motion, motion->window, 0, 0);
	}
	motion->cam.on = false;
	motion->requests = 0;
	motion->request_correction_usteps = 0;
	motion->stop_at_rest = 0;
	controller->halting = false;
	controller->halt_sent = false;
}

void lw_controller_fail(struct lw_controller *controller, enum lw_fault fault)
{
	lw_controller_cut(controller);
	controller->state = LW_STATE_FAULT;
	controller->fault = fault;
	controller->indexed = false;
	controller->on_orbit = false;
}

struct lw_law_window *lw_controller_spare_window(struct lw_controller *controller)
{
	return controller->motion.window == &controller->windows[0] ? &controller->windows[1]
								    : &controller->windows[0];
}

struct lw_law_window lw_controller_track_window(const struct lw_controller *controller)
{
	return lw_params_window(controller->params, controller->derived, controller->trim_plus_um,
				controller->trim_minus_um);
}

void lw_controller_request(struct lw_controller *controller, struct lw_law_window window,
			   enum lw_motion_request request, int32_t correction_usteps)
{
	struct lw_motion *motion = &controller->motion;
	struct lw_law_window *spare;

	/* Withdraw an earlier window first: the interrupt must not read it half changed. */
	motion->requests &= LW_MOTION_REQUEST_CORRECTION;
	spare = lw_controller_spare_window(controller);
	*spare = window;
	motion->request_window = spare;
	if (request == LW_MOTION_REQUEST_REBASE) {
		motion->requests = 0;
		motion->request_correction_usteps = correction_usteps;
	}
	lw_motion_request(motion, (uint8_t)request);
}

bool lw_controller_moves_toward(int direction, int side)
{
	return direction == lw_side_direction(side);
}

static int32_t edges_per_encoder_rev(const struct lw_params *params)
{
	return params->encoder_pulses_per_rev * params->encoder_edges_per_pulse;
}

void lw_controller_init(struct lw_controller *controller, const struct lw_params *params,
			const struct lw_derived *derived, const struct lw_inputs *inputs,
			uint64_t now_us)
{
	const struct lw_quadrature_config quadrature_config = lw_params_quadrature(params);

	*controller = (struct lw_controller){
		.params = params,
		.derived = derived,
		.limit_config = lw_params_limit_switch(params),
		.state = LW_STATE_UNINDEXED,
		.mode = LW_MODE_TRACK,
		.requested_mode = LW_MODE_TRACK,
		.rest_since_us = now_us,
		.now_us = now_us,
	};
	for (size_t i = 0; i < LW_CONTROLLER_SPEED_TICKS; i++) {
		controller->edge_history_us[i] = (uint32_t)now_us;
	}
	controller->windows[0] = lw_controller_track_window(controller);
	lw_motion_init(&controller->motion, &controller->windows[0]);
	lw_quadrature_init(&controller->quadrature, &quadrature_config, inputs->encoder_a,
			   inputs->encoder_b);
	lw_encoder_index_configure(&controller->encoder_index, edges_per_encoder_rev(params));
	controller->stepper_alarm = inputs->stepper_alarm;
	for (int side = 0; side < 2; side++) {
		lw_limit_switch_init(&controller->limit[side], &controller->limit_config,
				     inputs->limit[side].no_closed, inputs->limit[side].nc_closed,
				     now_us);
		lw_controller_overtravel(controller, side, inputs->overtravel[side]);
	}
}

void lw_controller_configure(struct lw_controller *controller, const struct lw_params *params,
			     const struct lw_derived *derived, bool need_index)
{
	const struct lw_quadrature_config quadrature_config = lw_params_quadrature(params);

	controller->params = params;
	controller->derived = derived;
	controller->cam_refusal = (struct lw_cam_refusal){0};
	controller->limit_config = lw_params_limit_switch(params);
	lw_quadrature_configure(&controller->quadrature, &quadrature_config);
	lw_encoder_index_configure(&controller->encoder_index, edges_per_encoder_rev(params));
	if (!need_index) {
		return;
	}
	/* The contacts may mean something else now. */
	for (int side = 0; side < 2; side++) {
		struct lw_limit_switch *limit = &controller->limit[side];
		const uint32_t triggers = limit->triggers;

		lw_limit_switch_init(limit, &controller->limit_config, limit->no_closed,
				     limit->nc_closed, controller->now_us);
		limit->triggers = triggers;
	}
	controller->trim_plus_um = 0;
	controller->trim_minus_um = 0;
	lw_controller_cut(controller);
	controller->windows[0] = lw_controller_track_window(controller);
	lw_motion_place(&controller->motion, &controller->windows[0],
			lw_motion_m(&controller->motion), controller->motion.law.u);
	controller->indexed = false;
	controller->on_orbit = false;
	if (controller->state == LW_STATE_READY || controller->state == LW_STATE_CENTRED) {
		controller->state = LW_STATE_UNINDEXED;
	}
}

void lw_controller_encoder_index(struct lw_controller *controller)
{
	lw_encoder_index_pulse(&controller->encoder_index, controller->motion.edges);
}

int lw_controller_timer_edge(struct lw_controller *controller)
{
	return lw_motion_timer_edge(&controller->motion);
}

struct lw_limit_switch_trigger lw_controller_place(const struct lw_controller *controller)
{
	const struct lw_motion *motion = &controller->motion;
	const volatile int32_t *corrected_usteps = &motion->corrected_usteps;
	struct lw_limit_switch_trigger at;

	do {
		at = (struct lw_limit_switch_trigger){
			.corrected_usteps = *corrected_usteps,
			.pos_usteps = lw_law_pos_usteps(lw_motion_m(motion)),
			.direction = (int8_t)lw_motion_direction(motion),
		};
	} while (at.corrected_usteps != *corrected_usteps);
	return at;
}

void lw_controller_limit(struct lw_controller *controller, int side, bool no_closed, bool nc_closed,
			 uint64_t now_us)
{
	lw_limit_switch_input(&controller->limit[side], &controller->limit_config, no_closed,
			      nc_closed, lw_controller_place(controller), now_us);
}

void lw_controller_overtravel(struct lw_controller *controller, int side, bool actuated)
{
	controller->overtravel[side] = actuated;
	lw_motion_block(&controller->motion, side == LW_PLUS ? LW_MOTION_PLUS : LW_MOTION_MINUS,
			actuated);
}

void lw_controller_stepper_alarm(struct lw_controller *controller, bool alarm)
{
	if (alarm == controller->stepper_alarm) {
		controller->stepper_alarm_polls = 0;
	} else if (++controller->stepper_alarm_polls == STEPPER_ALARM_POLLS) {
		controller->stepper_alarm_polls = 0;
		controller->stepper_alarm = alarm;
	}
}

bool lw_controller_moving(const struct lw_controller *controller)
{
	switch (controller->state) {
	case LW_STATE_BACKING_OFF:
	case LW_STATE_SEEKING:
	case LW_STATE_INDEX_REVERSAL:
	case LW_STATE_SPAN_CHECK:
	case LW_STATE_PARKING:
	case LW_STATE_CENTRING:
	case LW_STATE_JOGGING:
		return true;
	default:
		return false;
	}
}

uint32_t lw_controller_timer_rate_edges_per_s(const struct lw_controller *controller)
{
	if (controller->motion.source != LW_EDGE_SOURCE_TIMER || controller->storing) {
		return 0;
	}
	return (uint32_t)(controller->state == LW_STATE_JOGGING
				  ? controller->params->jog_rate_edges_per_s
				  : controller->params->index_rate_edges_per_s);
}

bool lw_controller_stepper_enabled(const struct lw_controller *controller)
{
	if (controller->state == LW_STATE_OFF) {
		return false;
	}
	return !(controller->state == LW_STATE_FAULT &&
		 (controller->overtravel[LW_PLUS] || controller->overtravel[LW_MINUS]));
}

static bool any_los(const struct lw_controller *controller)
{
	return controller->los1[LW_PLUS].set || controller->los1[LW_MINUS].set ||
	       controller->los2[LW_PLUS].set || controller->los2[LW_MINUS].set;
}

uint16_t lw_controller_launch_inhibit(const struct lw_controller *controller)
{
	unsigned int inhibit = 0;

	inhibit |= (unsigned int)(controller->state != LW_STATE_TRACKING || !controller->indexed)
		   << LW_LAUNCH_INHIBIT_NOT_TRACKING;
	inhibit |= (unsigned int)any_los(controller) << LW_LAUNCH_INHIBIT_LOS;
	inhibit |= (unsigned int)(controller->fault != LW_FAULT_NONE) << LW_LAUNCH_INHIBIT_FAULT;
	inhibit |= (unsigned int)(controller->wiring[LW_PLUS] || controller->wiring[LW_MINUS])
		   << LW_LAUNCH_INHIBIT_WIRING;
	inhibit |=
		(unsigned int)(controller->overtravel[LW_PLUS] || controller->overtravel[LW_MINUS])
		<< LW_LAUNCH_INHIBIT_OVERTRAVEL;
	inhibit |= (unsigned int)controller->overspeed_trip << LW_LAUNCH_INHIBIT_OVERSPEED;
	inhibit |= (unsigned int)controller->master_lost << LW_LAUNCH_INHIBIT_MASTER_LOST;
	inhibit |= (unsigned int)((controller->motion.requests & LW_MOTION_REQUEST_CORRECTION) != 0)
		   << LW_LAUNCH_INHIBIT_CORRECTION;
	inhibit |= (unsigned int)controller->stepper_alarm << LW_LAUNCH_INHIBIT_STEPPER_ALARM;
	inhibit |= (unsigned int)(controller->cam_refusal.reason != LW_REASON_NONE)
		   << LW_LAUNCH_INHIBIT_CAM;
	return (uint16_t)inhibit;
}

int lw_controller_busy(const struct lw_controller *controller, struct lw_refusal *why)
{
	if (controller->state == LW_STATE_TRACKING) {
		return busy(why, LW_REASON_BUSY_TRACKING);
	}
	return lw_controller_moving(controller) ? busy(why, LW_REASON_BUSY_MOVING) : 0;
}

int lw_controller_allow_index(const struct lw_controller *controller, struct lw_refusal *why)
{
	if (controller->state == LW_STATE_OFF) {
		return busy(why, LW_REASON_MODE_OFF);
	}
	if (lw_controller_moving(controller)) {
		return busy(why, LW_REASON_BUSY_MOVING);
	}
	return controller->drum_at_rest ? 0 : busy(why, LW_REASON_DRUM_MOVING);
}

void lw_controller_index(struct lw_controller *controller)
{
	controller->held = false;
	lw_homing_start(controller);
}

void lw_controller_stop(struct lw_controller *controller)
{
	if (controller->state == LW_STATE_TRACKING) {
		if (controller->drum_at_rest) {
			lw_tracking_leave(controller);
			controller->state = LW_STATE_READY;
		} else {
			/* From full speed the stepper loses steps: the position is lost. */
			lw_controller_cut(controller);
			controller->indexed = false;
			controller->state = LW_STATE_UNINDEXED;
		}
	} else if (lw_controller_moving(controller)) {
		lw_homing_halt(controller, controller->indexed ? LW_STATE_READY
					   : controller->fault ? LW_STATE_FAULT
							       : LW_STATE_UNINDEXED);
	}
	controller->held = true;
}

/** Does the cause of a fault still stand? */
static bool cause_present(const struct lw_controller *controller)
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
		return controller->stepper_alarm;
	default:
		return false;
	}
}

int lw_controller_allow_clear_fault(const struct lw_controller *controller, struct lw_refusal *why)
{
	return cause_present(controller) ? busy(why, LW_REASON_CAUSE_PRESENT) : 0;
}

void lw_controller_clear_fault(struct lw_controller *controller)
{
	controller->fault = LW_FAULT_NONE;
	controller->overspeed_trip = false;
	for (int side = 0; side < 2; side++) {
		controller->wiring[side] = controller->limit[side].wiring_fault;
	}
	if (controller->state == LW_STATE_FAULT) {
		controller->state = LW_STATE_UNINDEXED;
	}
	if (controller->rest_state == LW_STATE_FAULT) {
		controller->rest_state = LW_STATE_UNINDEXED; /* a jog is under way */
	}
}

void lw_controller_set_mode(struct lw_controller *controller, enum lw_mode mode)
{
	controller->requested_mode = mode;
	controller->held = false;
}

int lw_controller_allow_jog(const struct lw_controller *controller, int direction,
			    struct lw_refusal *why)
{
	if (direction == 0) {
		return 0;
	}

	const int side = direction > 0 ? LW_PLUS : LW_MINUS;

	if (controller->state == LW_STATE_OFF) {
		return busy(why, LW_REASON_MODE_OFF);
	}
	if (controller->state == LW_STATE_JOGGING) {
		return controller->move_direction == direction && !controller->halting
			       ? 0
			       : busy(why, LW_REASON_BUSY_MOVING);
	}
	if (lw_controller_moving(controller)) {
		return busy(why, LW_REASON_BUSY_MOVING);
	}
	if (controller->state == LW_STATE_TRACKING && !controller->drum_at_rest) {
		return busy(why, LW_REASON_BUSY_TRACKING);
	}
	if (controller->overtravel[side]) {
		return busy(why, LW_REASON_OVERTRAVEL);
	}
	if (!controller->indexed && controller->limit[side].active) {
		return busy(why, LW_REASON_LIMIT_SWITCH);
	}
	return 0;
}

void lw_controller_jog(struct lw_controller *controller, int direction, uint64_t now_us)
{
	controller->jog_written_us = now_us;
	if (controller->state == LW_STATE_JOGGING) {
		if (direction == 0) {
			lw_homing_halt(controller, controller->rest_state);
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
		const struct lw_law_window window = lw_controller_track_window(controller);

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
	controller->move_direction = (int8_t)direction;
	lw_homing_move_to(controller, m, target_usteps, LW_STATE_JOGGING, rest_state);
}

void lw_controller_set_trim(struct lw_controller *controller, int32_t trim_plus_um,
			    int32_t trim_minus_um)
{
	controller->trim_plus_um = trim_plus_um;
	controller->trim_minus_um = trim_minus_um;
	if ((controller->state == LW_STATE_TRACKING && !controller->motion.cam.on) ||
	    controller->on_orbit) {
		lw_controller_request(controller, lw_controller_track_window(controller),
				      LW_MOTION_REQUEST_WINDOW, 0);
	}
}

/** Measure the drum speed over the last LW_CONTROLLER_SPEED_TICKS ticks, and whether it rests. */
static void measure_speed(struct lw_controller *controller, uint64_t now_us)
{
	const uint32_t edges = (uint32_t)controller->motion.net_edges;
	uint32_t *oldest = &controller->edge_history[controller->edge_history_next];
	uint32_t *oldest_us = &controller->edge_history_us[controller->edge_history_next];
	const uint32_t duration_us = (uint32_t)now_us - *oldest_us;
	const int64_t moved = (int32_t)(edges - *oldest);
	const int64_t speed = duration_us == 0 ? 0 : moved * 1000000 / duration_us;
	const int64_t rest = controller->params->rest_edges_per_s;

	*oldest = edges;
	*oldest_us = (uint32_t)now_us;
	controller->edge_history_next =
		(uint8_t)((controller->edge_history_next + 1) % LW_CONTROLLER_SPEED_TICKS);
	controller->drum_speed_edges_per_s = (int32_t)speed;
	if (speed >= rest || speed <= -rest) {
		controller->rest_since_us = now_us;
	}
	controller->drum_at_rest = now_us - controller->rest_since_us >=
				   (uint64_t)controller->params->rest_time_ms * 1000;
}

static void check_overtravel(struct lw_controller *controller)
{
	for (int side = 0; side < 2; side++) {
		const bool backing_away = controller->state == LW_STATE_BACKING_OFF &&
					  controller->back_off_side == side;
		const bool jogging_away =
			controller->state == LW_STATE_JOGGING &&
			!lw_controller_moves_toward(controller->move_direction, side);

		if (!controller->overtravel[side] || backing_away || jogging_away ||
		    controller->state == LW_STATE_OFF || controller->state == LW_STATE_FAULT) {
			continue;
		}
		lw_controller_fail(controller, side == LW_PLUS ? LW_FAULT_OVERTRAVEL_PLUS
							       : LW_FAULT_OVERTRAVEL_MINUS);
	}
}

/** A driver in alarm has let go of its motor: whatever the state, the position is lost. */
static void check_stepper(struct lw_controller *controller)
{
	if (controller->stepper_alarm && controller->state != LW_STATE_OFF &&
	    controller->state != LW_STATE_FAULT) {
		lw_controller_fail(controller, LW_FAULT_STEPPER_ALARM);
	}
}

static void check_speed(struct lw_controller *controller)
{
	const int64_t speed = controller->drum_speed_edges_per_s;

	if (controller->state == LW_STATE_TRACKING &&
	    (speed < 0 ? -speed : speed) >
		    (int64_t)controller->params->overspeed_trip_edges_per_s) {
		controller->overspeed_trip = true;
		lw_controller_fail(controller, LW_FAULT_OVERSPEED);
	}
}

/** Follow the drum, from inside the sweep or from the pattern as it was left. */
static void hand_over(struct lw_controller *controller)
{
	const struct lw_law_window window = lw_controller_track_window(controller);
	const int32_t m = lw_motion_m(&controller->motion);
	const int region = lw_law_region(&window, m);

	if (controller->params->motion_profile == LW_MOTION_PROFILE_CAM) {
		lw_cam_hand_over(controller);
	} else if (controller->on_orbit || region == 0) {
		lw_tracking_start(controller);
	} else {
		/* The sweep's slope in a reversal would stay wrong for ever: go inside first. */
		lw_homing_move_to(controller, m,
				  region < 0 ? lw_law_pos_usteps(window.sweep_end) - 2
					     : lw_law_pos_usteps(window.sweep_begin) + 2,
				  LW_STATE_CENTRING, LW_STATE_READY);
	}
}

/** Bring the requested mode into force. */
static void serve_mode(struct lw_controller *controller)
{
	const enum lw_mode wanted = controller->requested_mode;

	if (wanted == LW_MODE_OFF) {
		if (controller->state != LW_STATE_OFF) {
			lw_controller_cut(controller);
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
	if (controller->state == LW_STATE_TRACKING && wanted != LW_MODE_TRACK &&
	    !controller->drum_at_rest) {
		return; /* finish what the drum does first */
	}
	controller->mode = wanted;
	if (controller->held) {
		return;
	}
	if (wanted == LW_MODE_TRACK) {
		if ((controller->state == LW_STATE_READY ||
		     controller->state == LW_STATE_CENTRED) &&
		    controller->drum_at_rest && !controller->storing) {
			hand_over(controller);
		}
	} else if (controller->state == LW_STATE_TRACKING || controller->state == LW_STATE_READY) {
		if (controller->state == LW_STATE_TRACKING) {
			lw_tracking_leave(controller);
		}
		lw_homing_move_to(controller, lw_motion_m(&controller->motion),
				  controller->derived->centre_usteps, LW_STATE_CENTRING,
				  LW_STATE_CENTRED);
	}
}

void lw_controller_tick(struct lw_controller *controller, uint64_t now_us)
{
	struct lw_controller_trigger triggers[2] = {0};

	controller->now_us = now_us;
	for (int side = 0; side < 2; side++) {
		struct lw_limit_switch *limit = &controller->limit[side];

		lw_limit_switch_tick(limit, &controller->limit_config, now_us);
		controller->wiring[side] |= limit->wiring_fault;
		triggers[side].taken = lw_limit_switch_take(limit, &triggers[side].at);
	}

	lw_motion_count(&controller->motion);
	measure_speed(controller, now_us);
	check_overtravel(controller);
	check_stepper(controller);
	check_speed(controller);
	if (controller->state == LW_STATE_TRACKING) {
		lw_tracking_tick(controller, triggers);
	} else if (lw_controller_moving(controller)) {
		lw_homing_tick(controller, triggers);
	}
	serve_mode(controller);
}
