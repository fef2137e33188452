/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/control/controller.h"

#include <errno.h>

#include "carriage_acts.h"
#include "fault.h"
#include "homing.h"
#include "jogging.h"
#include "los_judge.h"
#include "lw/bytes/require.h"
#include "modes.h"
#include "moving.h"
#include "reacquire.h"
#include "resume.h"
#include "switch_check.h"
#include "tracking.h"

/** The stepper driver's alarm counts when so many polls in a row have told it. */
#define STEPPER_ALARM_POLLS 3

/**
 * So long a carriage may coast that was cut from full speed, twice what the simulated one does: a
 * rotor that still turns would not follow the ramp. By then the drum's speed is known, too.
 */
#define COAST_US 300000u

/** Later than this after a restart nobody expects the carriage to begin by itself. */
#define BY_ITSELF_US 2000000u

/** So long, a twentieth of a second, edges of the timer move the carriage without a tick. */
#define TIMER_ALONE_PER_S 20

static void configure_encoder_index(struct lw_controller *controller)
{
	const struct lw_params *params = controller->params;
	const int32_t edges_per_rev =
		params->encoder_pulses_per_rev * params->encoder_edges_per_pulse;
	/* Half as long as at the fastest speed: the time is known to a tick only. */
	const uint64_t rev_min_us =
		(uint64_t)edges_per_rev * 500000 / params->overspeed_trip_edges_per_s;

	lw_encoder_index_configure(&controller->encoder_index, edges_per_rev, (uint32_t)rev_min_us);
}

void lw_controller_init(struct lw_controller *controller, const struct lw_params *params,
			const struct lw_derived *derived, const struct lw_inputs *inputs,
			uint64_t now_us)
{
	const struct lw_quadrature_config quadrature_config = lw_params_quadrature(params);
	const struct lw_rope_geometry rope_geometry = lw_params_rope(params, derived);

	*controller = (struct lw_controller){
		.params = params,
		.derived = derived,
		.limit_config = lw_params_limit_switch(params),
		.state = LW_STATE_UNINDEXED,
		.mode = LW_MODE_TRACK,
		.requested_mode = LW_MODE_TRACK,
		.now_us = now_us,
	};
	lw_drum_speed_init(&controller->speed, now_us);
	controller->windows[0] = lw_carriage_track_window(controller);
	lw_motion_init(&controller->motion, &controller->windows[0]);
	lw_quadrature_init(&controller->quadrature, &quadrature_config, inputs->encoder_a,
			   inputs->encoder_b);
	lw_drum_watch_init(&controller->drum_watch, &controller->quadrature, now_us);
	configure_encoder_index(controller);
	lw_rope_length_configure(&controller->rope_length, &rope_geometry, 0);
	controller->stepper_alarm.on = inputs->stepper_alarm;
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
	LW_REQUIRE(!lw_controller_follows(controller) && !lw_controller_moving(controller));
	const struct lw_quadrature_config quadrature_config = lw_params_quadrature(params);
	const struct lw_rope_geometry rope_geometry = lw_params_rope(params, derived);

	lw_rope_length_configure(&controller->rope_length, &rope_geometry,
				 lw_motion_read(&controller->motion).net_edges);
	controller->params = params;
	controller->derived = derived;
	controller->cam_refusal = (struct lw_cam_refusal){0};
	controller->limit_config = lw_params_limit_switch(params);
	lw_quadrature_configure(&controller->quadrature, &quadrature_config);
	configure_encoder_index(controller);
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
	controller->trim.plus_um = 0;
	controller->trim.minus_um = 0;
	lw_carriage_cut(controller);
	controller->windows[0] = lw_carriage_track_window(controller);
	lw_motion_set_position(&controller->motion, &controller->windows[0],
			       lw_motion_m(&controller->motion), controller->motion.law.u);
	controller->indexed = false;
	controller->on_orbit = false;
	controller->resume.known = false;
	if (controller->state == LW_STATE_READY || controller->state == LW_STATE_CENTRED) {
		controller->state = LW_STATE_UNINDEXED;
	}
}

int lw_controller_odd_transition(struct lw_controller *controller, unsigned int transition)
{
	const int dd = lw_quadrature_odd_update(&controller->quadrature, transition);

	return dd == 0 ? 0 : lw_motion_encoder_edge(&controller->motion, dd);
}

void lw_controller_encoder_index(struct lw_controller *controller)
{
	lw_encoder_index_pulse(&controller->encoder_index, controller->motion.edges,
			       &controller->quadrature, (uint32_t)controller->now_us);
}

void lw_controller_encoder_index_late(struct lw_controller *controller)
{
	lw_encoder_index_pulse_late(&controller->encoder_index);
}

int lw_controller_encoder_run(struct lw_controller *controller, int32_t transitions)
{
	const struct lw_quadrature *quadrature = &controller->quadrature;
	const unsigned int order = transitions > 0 ? LW_QUADRATURE_ORDER : ~LW_QUADRATURE_ORDER;
	uint32_t left = transitions > 0 ? (uint32_t)transitions : 0u - (uint32_t)transitions;
	int steps = 0;

	for (; left > 0; left--) {
		const unsigned int next = lw_quadrature_next_levels(quadrature->levels, order);

		steps += lw_controller_encoder(controller, next >> 1, next & 1u);
	}
	return steps;
}

int lw_controller_timer_edge(struct lw_controller *controller)
{
	if (controller->timer_edges_left == 0) {
		return 0;
	}
	controller->timer_edges_left--;
	return lw_motion_timer_edge(&controller->motion);
}

struct lw_limit_switch_trigger lw_controller_position(const struct lw_controller *controller)
{
	const struct lw_motion *motion = &controller->motion;
	const volatile int32_t *corrected_usteps = &motion->corrected_usteps;
	const volatile int32_t *u = &motion->law.u;
	const volatile uint32_t *counted_edges = &motion->edges;
	struct lw_limit_switch_trigger at;
	uint32_t edges;
	int32_t lately_edges;

	do {
		/* First: the members of an initializer are read in any order. */
		edges = *counted_edges;
		at.corrected_usteps = *corrected_usteps;
		at.pos_usteps = lw_law_pos_usteps(lw_motion_m(motion));
		at.u = *u;
		at.direction = (int8_t)lw_motion_direction(motion);
	} while (edges != *counted_edges || at.corrected_usteps != *corrected_usteps);
	lately_edges = lw_drum_speed_lately_edges(&controller->speed, edges);
	at.drum_direction = (int8_t)((lately_edges > 0) - (lately_edges < 0));
	return at;
}

void lw_controller_limit(struct lw_controller *controller, int side, bool no_closed, bool nc_closed,
			 uint64_t now_us)
{
	lw_limit_switch_input(&controller->limit[side], &controller->limit_config, no_closed,
			      nc_closed, lw_controller_position(controller), now_us);
}

void lw_controller_overtravel(struct lw_controller *controller, int side, bool actuated)
{
	controller->overtravel[side] = actuated;
	lw_motion_block(&controller->motion, lw_carriage_side_bit(side), actuated);
}

void lw_controller_stepper_alarm(struct lw_controller *controller, bool alarm)
{
	if (alarm == controller->stepper_alarm.on) {
		controller->stepper_alarm.polls = 0;
	} else if (++controller->stepper_alarm.polls == STEPPER_ALARM_POLLS) {
		controller->stepper_alarm.polls = 0;
		controller->stepper_alarm.on = alarm;
	}
}

bool lw_controller_moving(const struct lw_controller *controller)
{
	return lw_homing_is_under_way(controller) || controller->state == LW_STATE_CENTRING ||
	       controller->state == LW_STATE_JOGGING;
}

bool lw_controller_follows(const struct lw_controller *controller)
{
	return controller->state == LW_STATE_TRACKING || controller->state == LW_STATE_REACQUIRING;
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

uint16_t lw_controller_launch_inhibit(const struct lw_controller *controller)
{
	unsigned int inhibit = 0;

	inhibit |= (unsigned int)(controller->state != LW_STATE_TRACKING || !controller->indexed)
		   << LW_LAUNCH_INHIBIT_NOT_TRACKING;
	inhibit |= (unsigned int)lw_los_any(&controller->los) << LW_LAUNCH_INHIBIT_LOS;
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
	inhibit |= (unsigned int)controller->stepper_alarm.on << LW_LAUNCH_INHIBIT_STEPPER_ALARM;
	inhibit |= (unsigned int)(controller->drum_watch.doubtful || controller->los.encoder.set)
		   << LW_LAUNCH_INHIBIT_ENCODER;
	inhibit |= (unsigned int)(controller->cam_refusal.reason != LW_REASON_NONE)
		   << LW_LAUNCH_INHIBIT_CAM;
	inhibit |= (unsigned int)controller->rope.set << LW_LAUNCH_INHIBIT_ROPE_LAID_STANDING;
	inhibit |= (unsigned int)(controller->switch_check.implausible[LW_PLUS] ||
				  controller->switch_check.implausible[LW_MINUS])
		   << LW_LAUNCH_INHIBIT_SWITCH_IMPLAUSIBLE;
	return (uint16_t)inhibit;
}

int lw_controller_busy(const struct lw_controller *controller, struct lw_refusal *why)
{
	if (lw_controller_follows(controller)) {
		return lw_carriage_busy(why, LW_REASON_BUSY_TRACKING);
	}
	return lw_controller_moving(controller) ? lw_carriage_busy(why, LW_REASON_BUSY_MOVING) : 0;
}

/** The drum turns, says a master who is heard. */
static bool told_running(const struct lw_controller *controller)
{
	return controller->drum_watch.running && !controller->master_lost;
}

int lw_controller_allow_doubt(const struct lw_controller *controller, struct lw_refusal *why)
{
	return controller->drum_watch.doubtful ? lw_carriage_busy(why, LW_REASON_ENCODER_DOUBTFUL)
					       : 0;
}

int lw_controller_allow_index(const struct lw_controller *controller, struct lw_refusal *why)
{
	if (controller->state == LW_STATE_OFF) {
		return lw_carriage_busy(why, LW_REASON_MODE_OFF);
	}
	if (lw_controller_moving(controller)) {
		return lw_carriage_busy(why, LW_REASON_BUSY_MOVING);
	}
	if (lw_controller_allow_doubt(controller, why)) {
		return -EBUSY;
	}
	if (told_running(controller)) {
		return lw_carriage_busy(why, LW_REASON_DRUM_RUNNING);
	}
	return controller->speed.at_rest ? 0 : lw_carriage_busy(why, LW_REASON_DRUM_MOVING);
}

void lw_controller_index(struct lw_controller *controller)
{
	LW_REQUIRE(lw_controller_allow_index(controller, &(struct lw_refusal){0}) == 0);
	controller->held = false;
	lw_homing_start(controller);
}

int lw_controller_allow_reacquire(const struct lw_controller *controller, struct lw_refusal *why)
{
	const int32_t speed = controller->speed.edges_per_s;
	const int32_t rest = controller->params->rest_edges_per_s;

	if (controller->state == LW_STATE_OFF) {
		return lw_carriage_busy(why, LW_REASON_MODE_OFF);
	}
	if (lw_controller_busy(controller, why) || lw_controller_allow_doubt(controller, why)) {
		return -EBUSY;
	}
	if (controller->indexed) {
		return lw_carriage_busy(why, LW_REASON_POSITION_KNOWN);
	}
	if (controller->state == LW_STATE_FAULT) {
		return lw_carriage_busy(why, LW_REASON_FAULT_STANDS);
	}
	if (controller->requested_mode != LW_MODE_TRACK ||
	    controller->params->motion_profile != LW_MOTION_PROFILE_SCREW) {
		return lw_carriage_busy(why, LW_REASON_NOT_MODE_TRACK);
	}
	if (speed > -rest && speed < rest) {
		return lw_carriage_busy(why, LW_REASON_DRUM_AT_REST);
	}
	return controller->now_us - controller->reacquire.stands_since_us < COAST_US
		       ? lw_carriage_busy(why, LW_REASON_BUSY_MOVING)
		       : 0;
}

void lw_controller_reacquire(struct lw_controller *controller)
{
	LW_REQUIRE(lw_controller_allow_reacquire(controller, &(struct lw_refusal){0}) == 0);
	controller->held = false;
	lw_reacquire_start(controller);
}

void lw_controller_stop(struct lw_controller *controller)
{
	if (controller->state == LW_STATE_REACQUIRING) {
		lw_carriage_cut(controller);
		controller->state = LW_STATE_UNINDEXED;
	} else if (controller->state == LW_STATE_TRACKING) {
		if (controller->speed.at_rest) {
			lw_tracking_leave(controller);
			controller->state = LW_STATE_READY;
		} else {
			/* From full speed the stepper loses steps: the position is lost. */
			lw_carriage_cut(controller);
			controller->indexed = false;
			controller->state = LW_STATE_UNINDEXED;
		}
	} else if (lw_homing_is_under_way(controller)) {
		lw_homing_stop(controller, LW_STATE_UNINDEXED);
	} else if (lw_controller_moving(controller)) {
		lw_moving_halt(controller, controller->indexed ? LW_STATE_READY
					   : controller->fault ? LW_STATE_FAULT
							       : LW_STATE_UNINDEXED);
	}
	controller->held = true;
}

int lw_controller_allow_clear_fault(const struct lw_controller *controller, struct lw_refusal *why)
{
	return lw_fault_cause_present(controller) ? lw_carriage_busy(why, LW_REASON_CAUSE_PRESENT)
						  : 0;
}

void lw_controller_clear_fault(struct lw_controller *controller)
{
	LW_REQUIRE(lw_controller_allow_clear_fault(controller, &(struct lw_refusal){0}) == 0);
	lw_fault_clear(controller);
}

int lw_controller_allow_acknowledge_rope(const struct lw_controller *controller,
					 struct lw_refusal *why)
{
	if (!controller->speed.at_rest) {
		return lw_carriage_busy(why, LW_REASON_DRUM_MOVING); /* nobody can look at it now */
	}
	return controller->rope.set && !(controller->indexed && controller->rope.indexed_since)
		       ? lw_carriage_busy(why, LW_REASON_ROPE_INDEX_FIRST)
		       : 0;
}

void lw_controller_acknowledge_rope(struct lw_controller *controller)
{
	LW_REQUIRE(lw_controller_allow_acknowledge_rope(controller, &(struct lw_refusal){0}) == 0);
	lw_rope_watch_acknowledge(&controller->rope);
}

int lw_controller_allow_set_rope(const struct lw_controller *controller, int32_t mm,
				 struct lw_refusal *why)
{
	if (controller->rope_length.geometry.core_um_q16 == 0) {
		return lw_carriage_busy(why, LW_REASON_ROPE_NOT_DESCRIBED);
	}
	if (mm < 0) {
		return lw_carriage_busy(why, LW_REASON_ROPE_LENGTH_MISSING);
	}
	if (lw_controller_allow_doubt(controller, why)) {
		return -EBUSY;
	}
	return controller->speed.at_rest ? 0 : lw_carriage_busy(why, LW_REASON_DRUM_MOVING);
}

int lw_controller_set_rope(struct lw_controller *controller, int32_t mm)
{
	return lw_rope_length_tell(&controller->rope_length, mm,
				   lw_motion_read(&controller->motion).net_edges);
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
		return lw_carriage_busy(why, LW_REASON_MODE_OFF);
	}
	if (controller->state == LW_STATE_JOGGING) {
		return controller->jogging.direction == direction && !controller->moving.halting
			       ? 0
			       : lw_carriage_busy(why, LW_REASON_BUSY_MOVING);
	}
	if (lw_controller_moving(controller)) {
		return lw_carriage_busy(why, LW_REASON_BUSY_MOVING);
	}
	if (lw_controller_allow_doubt(controller, why)) {
		return -EBUSY;
	}
	if (controller->state == LW_STATE_REACQUIRING ||
	    (controller->state == LW_STATE_TRACKING && !controller->speed.at_rest)) {
		return lw_carriage_busy(why, LW_REASON_BUSY_TRACKING);
	}
	if (controller->overtravel[side]) {
		return lw_carriage_busy(why, LW_REASON_OVERTRAVEL);
	}
	if (!controller->indexed && controller->limit[side].active) {
		return lw_carriage_busy(why, LW_REASON_LIMIT_SWITCH);
	}
	return 0;
}

void lw_controller_jog(struct lw_controller *controller, int direction, uint64_t now_us)
{
	LW_REQUIRE(direction == 0 ||
		   (controller->state != LW_STATE_OFF && !lw_homing_is_under_way(controller)));
	lw_jogging_write(controller, direction, now_us);
}

void lw_controller_set_trim(struct lw_controller *controller, int32_t trim_plus_um,
			    int32_t trim_minus_um)
{
	LW_REQUIRE(lw_params_check_trim(controller->params, controller->derived, trim_plus_um,
					trim_minus_um, &(struct lw_refusal){0}) == 0);
	controller->trim.plus_um = trim_plus_um;
	controller->trim.minus_um = trim_minus_um;
	if ((controller->state == LW_STATE_TRACKING && !controller->motion.cam.on) ||
	    controller->on_orbit) {
		lw_carriage_request(controller, lw_carriage_track_window(controller),
				    LW_MOTION_REQUEST_WINDOW, 0);
	}
}

/** Compare what the encoder has told; what it hides is a loss of synchronization. */
static void watch_drum(struct lw_controller *controller, uint64_t now_us)
{
	struct lw_drum_watch *watch = &controller->drum_watch;

	lw_drum_watch_tick(watch, controller->params, &controller->quadrature,
			   &controller->encoder_index, (uint32_t)controller->motion.net_edges,
			   (int32_t)lw_carriage_tolerance_edges(controller),
			   told_running(controller), now_us);
	if (watch->fault != LW_ENCODER_FAULT_NONE && !controller->los.encoder.set) {
		lw_los_note(&controller->los.encoder, controller->now_us,
			    lw_motion_m(&controller->motion));
	}
}

/** A contact that was closed between two ticks only is a fault all the same if it cost a step. */
static void check_overtravel(struct lw_controller *controller)
{
	const uint8_t withheld = lw_motion_take_withheld(&controller->motion);

	for (int side = 0; side < 2; side++) {
		const bool backing_away = controller->state == LW_STATE_BACKING_OFF &&
					  controller->homing.back_off_side == side;
		const bool jogging_away =
			controller->state == LW_STATE_JOGGING &&
			!lw_carriage_moves_toward(controller->jogging.direction, side);

		const bool out_of_step = (withheld & lw_carriage_side_bit(side)) != 0;
		const bool stands =
			controller->state == LW_STATE_OFF || controller->state == LW_STATE_FAULT;

		if (stands || !(out_of_step ||
				(controller->overtravel[side] && !backing_away && !jogging_away))) {
			continue;
		}
		lw_fault_stop(controller, side == LW_PLUS ? LW_FAULT_OVERTRAVEL_PLUS
							  : LW_FAULT_OVERTRAVEL_MINUS);
	}
}

/** A driver in alarm has let go of its motor: whatever the state, the position is lost. */
static void check_stepper(struct lw_controller *controller)
{
	if (controller->stepper_alarm.on && controller->state != LW_STATE_OFF &&
	    controller->state != LW_STATE_FAULT) {
		lw_fault_stop(controller, LW_FAULT_STEPPER_ALARM);
	}
}

static void check_speed(struct lw_controller *controller)
{
	if (lw_controller_follows(controller) &&
	    lw_drum_speed_exceeds(&controller->speed,
				  controller->params->overspeed_trip_edges_per_s)) {
		controller->overspeed_trip = true;
		lw_fault_stop(controller, LW_FAULT_OVERSPEED);
	}
}

/** Edges from which on rope laid while the carriage stands is told, at least one; 0: never. */
static int64_t standing_edges(const struct lw_controller *controller)
{
	const int64_t permille = controller->params->standing_turns_permille;
	const int64_t edges =
		permille * (int64_t)controller->derived->edges_per_1000_drum_revs / 1000000;

	return permille > 0 && edges == 0 ? 1 : edges;
}

static void watch_rope(struct lw_controller *controller)
{
	const struct lw_rope_watch_inputs inputs = {
		.following = lw_controller_follows(controller),
		/* Whatever the mode, nobody wants the place that a fault stops at. */
		.intended =
			controller->mode == LW_MODE_OFF ||
			(controller->mode == LW_MODE_CENTRE && controller->state != LW_STATE_FAULT),
		.known = controller->indexed,
		.moved = lw_controller_moving(controller) || controller->state == LW_STATE_OFF,
		.position_q16 = lw_motion_m(&controller->motion),
		.net_edges = controller->motion.net_edges,
		.threshold_edges = standing_edges(controller),
		.edges_per_1000_drum_revs = controller->derived->edges_per_1000_drum_revs,
		.now_us = controller->now_us,
	};

	lw_rope_watch_tick(&controller->rope, &inputs);
}

bool lw_controller_mend_law(struct lw_controller *controller)
{
	struct lw_motion *motion = &controller->motion;
	struct lw_law_window *const windows = controller->windows;
	const bool known = motion->window == &windows[0] || motion->window == &windows[1];
	struct lw_law_window *spare;
	int side;

	if (controller->state != LW_STATE_TRACKING || motion->cam.on || motion->requests ||
	    (known && motion->window->ka == controller->derived->ka &&
	     motion->window->ks == controller->derived->ks && lw_motion_is_sound(motion))) {
		return false;
	}
	side = motion->last_step < 0 ? LW_MINUS : LW_PLUS;
	spare = lw_carriage_spare_window(controller);
	*spare = lw_carriage_track_window(controller);
	lw_motion_mend(motion, spare);
	lw_los_note(&controller->los.los2[side], controller->now_us, lw_motion_m(motion));
	return true;
}

bool lw_controller_mend_rest(struct lw_controller *controller)
{
	if (controller->motion.source == LW_EDGE_SOURCE_NONE || lw_controller_follows(controller) ||
	    lw_controller_moving(controller)) {
		return false;
	}
	/* As by a stop from full speed, the stepper loses steps. */
	lw_carriage_cut(controller);
	if (controller->indexed) {
		controller->indexed = false;
		controller->state = LW_STATE_UNINDEXED;
	}
	return true;
}

/** Take up the drum by itself after a restart in a launch. */
static void reacquire_by_itself(struct lw_controller *controller)
{
	struct lw_reacquire *reacquire = &controller->reacquire;
	const uint64_t stands_us = controller->now_us - reacquire->stands_since_us;
	struct lw_refusal why;

	if (lw_controller_follows(controller) || lw_controller_moving(controller)) {
		reacquire->stands_since_us = controller->now_us;
	}
	if (!reacquire->wanted) {
		return;
	}
	if (controller->speed.at_rest || controller->state != LW_STATE_UNINDEXED ||
	    controller->held || stands_us > BY_ITSELF_US) {
		reacquire->wanted = false; /* the launch is over, or somebody is at work */
	} else if (lw_controller_allow_reacquire(controller, &why) == 0) {
		lw_reacquire_start(controller);
	}
}

void lw_controller_tick(struct lw_controller *controller, uint64_t now_us)
{
	struct lw_carriage_trigger triggers[2] = {0};

	controller->now_us = now_us;
	for (int side = 0; side < 2; side++) {
		struct lw_limit_switch *limit = &controller->limit[side];

		lw_limit_switch_tick(limit, &controller->limit_config, now_us);
		controller->wiring[side] |= limit->wiring_fault;
		triggers[side].taken = lw_limit_switch_take(limit, &triggers[side].at);
	}

	lw_motion_count(&controller->motion);
	if (controller->motion.cam.on) {
		lw_cam_motion_prepare(&controller->motion.cam);
	}
	watch_drum(controller, now_us);
	lw_drum_speed_tick(&controller->speed, controller->params,
			   (uint32_t)controller->motion.net_edges,
			   controller->drum_watch.doubtful || told_running(controller), now_us);
	for (int side = 0; side < 2; side++) {
		/* Where the switch was reached, before it told. */
		triggers[side].at.pos_usteps -=
			lw_carriage_lag_usteps(controller, triggers[side].at.u);
	}
	check_overtravel(controller);
	check_stepper(controller);
	check_speed(controller);
	lw_switch_check_tick(controller);
	if (controller->state == LW_STATE_TRACKING) {
		lw_los_judge_tick(controller, triggers);
	} else if (controller->state == LW_STATE_REACQUIRING) {
		lw_reacquire_tick(controller, triggers);
	} else if (controller->state == LW_STATE_JOGGING) {
		lw_jogging_tick(controller);
	} else if (controller->state == LW_STATE_CENTRING) {
		lw_moving_tick(controller);
	} else if (lw_homing_is_under_way(controller)) {
		lw_homing_tick(controller, triggers);
	}
	lw_modes_tick(controller);
	reacquire_by_itself(controller);
	controller->timer_edges_left =
		lw_controller_timer_rate_edges_per_s(controller) / TIMER_ALONE_PER_S + 1;
	watch_rope(controller);
	lw_resume_tick(controller);
	lw_rope_length_tick(&controller->rope_length, controller->motion.net_edges,
			    controller->los.encoder.set || controller->odometer_doubtful);
	LW_REQUIRE(controller->indexed ||
		   !(controller->state == LW_STATE_READY || controller->state == LW_STATE_CENTRED ||
		     controller->state == LW_STATE_TRACKING));
	LW_REQUIRE((controller->state == LW_STATE_FAULT) <= (controller->fault != LW_FAULT_NONE));
}
