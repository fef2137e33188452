/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The life of the level wind: indexing, hand-over to the drum, tracking, loss of synchronization,
 * faults, modes, launch interlocks (doc/control-law.md section 5).
 *
 * Three interrupts and one supervisor work on a controller. The supervisor functions (all that are
 * not marked as interrupt safe) must not interrupt each other. The core has no clock: `now_us` is
 * any clock that never runs backward.
 */
#ifndef LW_CONTROLLER_H
#define LW_CONTROLLER_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/control/carriage.h"
#include "lw/map/refusal.h"

/** Period at which lw_controller_tick() is called. */
#define LW_CONTROLLER_TICK_US 1000

/** Levels of all input pins. */
struct lw_inputs {
	bool encoder_a;
	bool encoder_b;
	struct {
		bool no_closed;
		bool nc_closed;
	} limit[2];         /**< by side */
	bool overtravel[2]; /**< by side, true: actuated */
	bool stepper_alarm;
};

/** Start: position unknown, nothing moves, launch inhibited. */
void lw_controller_init(struct lw_controller *controller, const struct lw_params *params,
			const struct lw_derived *derived, const struct lw_inputs *inputs,
			uint64_t now_us);

/**
 * Take over another parameter set. Only while lw_controller_busy() says 0.
 *
 * @param need_index the index becomes invalid
 */
void lw_controller_configure(struct lw_controller *controller, const struct lw_params *params,
			     const struct lw_derived *derived, bool need_index);

/** A step of the carriage as the stepper driver's direction input wants it. For interrupts. */
static inline int lw_controller_driver_step(const struct lw_controller *controller, int step)
{
	return step != 0 && controller->params->carriage_direction_invert ? -step : step;
}

/**
 * Take a drum edge that a decoder in hardware has counted in `motion.edges`. For the encoder
 * interrupt.
 *
 * The drum watch compares what lw_quadrature counts. A decoder in hardware does not say which
 * channel has changed: its host adds to `quadrature.turns` and `odd_changes` when the direction
 * changes, or leaves the watch to the index pulses and the master's word.
 *
 * @param dd +1 forward, -1 backward
 * @return the step of the carriage: +1, 0, -1; see lw_controller_driver_step()
 */
LW_EDGE_INLINE int lw_controller_drum_edge(struct lw_controller *controller, int dd)
{
	return lw_motion_edge(&controller->motion, dd);
}

/** Take a transition that is no edge onward. For lw_controller_encoder(). */
int lw_controller_odd_transition(struct lw_controller *controller, unsigned int transition);

/**
 * Take the encoder's levels after a transition. For the encoder interrupt.
 *
 * @return the steps of the carriage: +1, 0, -1, up to LW_CAM_STEPS_PER_EDGE_MAX either way by a
 * cam; see lw_controller_driver_step()
 */
LW_EDGE_INLINE int lw_controller_encoder(struct lw_controller *controller, bool a, bool b)
{
	unsigned int transition;
	const int dd = lw_quadrature_short_update(&controller->quadrature, a, b, &transition);

	return dd == 0 ? lw_controller_odd_transition(controller, transition)
		       : lw_motion_encoder_edge(&controller->motion, dd);
}

/** Take transitions one by one. For lw_controller_encoder_count(). */
int lw_controller_encoder_run(struct lw_controller *controller, int32_t transitions);

/**
 * Take the transitions that a counter in hardware has seen since the last call, as if
 * lw_controller_encoder() had taken each of them. For the encoder interrupt.
 *
 * The counter tells their net number only, so this is the shortest way from the levels before to
 * those now: what went forth and back meanwhile is not seen, and leaves no trace in the motion.
 *
 * @param transitions of both channels, net, positive where A leads B
 * @return the steps of the carriage, net; see lw_controller_driver_step()
 */
LW_EDGE_INLINE int lw_controller_encoder_count(struct lw_controller *controller,
					       int32_t transitions)
{
	struct lw_quadrature *quadrature = &controller->quadrature;
	const unsigned int way = transitions > 0 ? 0 : 1;
	const uint32_t left = way == 0 ? (uint32_t)transitions : 0u - (uint32_t)transitions;
	int32_t steps = 0;

	if (lw_quadrature_goes_on(quadrature, way)) {
		const uint32_t edges = lw_quadrature_edges_of_run(quadrature, way, left);
		const int dd = quadrature->ways[way].dd;
		bool taken = true;

		if (edges > 1) {
			taken = lw_motion_encoder_edges(&controller->motion, (int32_t)edges * dd,
							&steps);
		} else if (edges == 1) {
			steps = lw_motion_encoder_edge(&controller->motion, dd);
		}
		if (taken) {
			lw_quadrature_run(quadrature, way, left, edges);
			return steps;
		}
	}
	return lw_controller_encoder_run(controller, transitions);
}

/**
 * Transitions to the next one that may give a step, while the drum goes on as it did in the last
 * lw_controller_encoder_count(): those before it need no interrupt of their own. For the encoder
 * interrupt of a host that counts in hardware.
 *
 * @param transitions as that was called with
 */
LW_EDGE_INLINE uint32_t lw_controller_encoder_reach(const struct lw_controller *controller,
						    int32_t transitions)
{
	const struct lw_quadrature *quadrature = &controller->quadrature;
	const unsigned int way = transitions > 0 ? 0 : 1;

	return lw_quadrature_transitions(
		quadrature, way,
		lw_motion_edges_to_step(&controller->motion, quadrature->ways[way].dd));
}

/**
 * Where the slope turns: the direction of the next step, while the drum goes on as it did in the
 * last lw_controller_encoder_count(). There is time to prepare it. For the encoder interrupt.
 *
 * @param transitions as that was called with
 * @return +1 or -1; 0 in the sweep, where it is that of the steps before, or where nobody knows
 */
LW_EDGE_INLINE int lw_controller_turns_to(const struct lw_controller *controller,
					  int32_t transitions)
{
	const struct lw_law *law = &controller->motion.law;
	const int dd = controller->quadrature.ways[transitions > 0 ? 0 : 1].dd;

	if (law->rel < law->open_span || law->open_span == 0 || law->u == 0) {
		return 0;
	}
	return law->u > 0 ? dd : -dd;
}

/** Take the beginning of the encoder's index pulse. For its interrupt. */
void lw_controller_encoder_index(struct lw_controller *controller);

/** As that, but the drum has turned on since it began: it is counted, not compared. */
void lw_controller_encoder_index_late(struct lw_controller *controller);

/**
 * Take one edge of the edge timer. For its interrupt.
 *
 * Where no tick has come for 50 ms it moves nothing: who watches the switches may have died.
 *
 * @return the step of the carriage: +1, 0, -1; see lw_controller_driver_step()
 */
int lw_controller_timer_edge(struct lw_controller *controller);

/** Where the carriage is now, for a contact that closes. For the limit-switch interrupt. */
struct lw_limit_switch_trigger lw_controller_position(const struct lw_controller *controller);

/** Take the contacts of a limit switch after a change. For the limit-switch interrupt. */
void lw_controller_limit(struct lw_controller *controller, int side, bool no_closed, bool nc_closed,
			 uint64_t now_us);

/** Take an overtravel switch after a change. For its interrupt. Stops steps that way at once. */
void lw_controller_overtravel(struct lw_controller *controller, int side, bool actuated);

/**
 * Tell whether the stepper driver reports an alarm. Call it before every tick: what three calls in
 * a row tell counts, so that a disturbed sample ends no launch, and the next tick stops for it.
 */
void lw_controller_stepper_alarm(struct lw_controller *controller, bool alarm);

/** Supervise. Call every LW_CONTROLLER_TICK_US. */
void lw_controller_tick(struct lw_controller *controller, uint64_t now_us);

/**
 * Is the law in force that of the parameters? One that a flipped bit has changed follows another
 * screw, and no switch tells of it: it is set right, and told as a loss of synchronization. For the
 * supervisor, between two ticks.
 *
 * @return it was not
 */
bool lw_controller_mend_law(struct lw_controller *controller);

/**
 * Does the carriage rest in a state of rest? By a flipped bit edges may move it there, unasked and
 * watched by nobody: it is stopped, and its index is lost. For the supervisor, before every tick.
 *
 * @return it did not
 */
bool lw_controller_mend_rest(struct lw_controller *controller);

/** Rate of the edge timer that the controller wants, edges per second; 0: off. */
uint32_t lw_controller_timer_rate_edges_per_s(const struct lw_controller *controller);

/** True if the stepper shall have current. */
bool lw_controller_stepper_enabled(const struct lw_controller *controller);

/** True while the carriage moves by itself. */
bool lw_controller_moving(const struct lw_controller *controller);

/** True while the drum moves the carriage. */
bool lw_controller_follows(const struct lw_controller *controller);

/** Bits of enum lw_launch_inhibit_bit, each one a reason why a launch is not permitted. */
uint16_t lw_controller_launch_inhibit(const struct lw_controller *controller);

/**
 * May parameters be changed now?
 *
 * @retval 0 yes
 * @retval -EBUSY tracking, or moving by itself; `why->reason` says which
 */
int lw_controller_busy(const struct lw_controller *controller, struct lw_refusal *why);

/**
 * May something begin that wants the drum at rest, as far as the encoder can be believed?
 *
 * @retval 0 yes
 * @retval -EBUSY the encoder is doubtful: the drum may turn unseen
 */
int lw_controller_allow_doubt(const struct lw_controller *controller, struct lw_refusal *why);

/**
 * May indexing start now?
 *
 * @retval 0 yes
 * @retval -EBUSY mode off, moving, the drum is not at rest, or may turn unseen
 */
int lw_controller_allow_index(const struct lw_controller *controller, struct lw_refusal *why);

/** Start indexing. Only if lw_controller_allow_index() says 0. Ends in READY or FAULT. */
void lw_controller_index(struct lw_controller *controller);

/**
 * May a turning drum be taken up now, from rest at an unknown place?
 *
 * @retval 0 yes
 * @retval -EBUSY mode off or not track, the position is known, moving, a fault stands, the encoder
 * is doubtful, or the drum does not turn
 */
int lw_controller_allow_reacquire(const struct lw_controller *controller, struct lw_refusal *why);

/**
 * Take up the turning drum. Only if lw_controller_allow_reacquire() says 0. Ends in TRACKING, with
 * a loss of synchronization that only an indexing clears, or in FAULT.
 */
void lw_controller_reacquire(struct lw_controller *controller);

/** Stop every motion. Keeps the index where the carriage can be brought to rest in step. */
void lw_controller_stop(struct lw_controller *controller);

/**
 * May the fault be acknowledged now?
 *
 * @retval 0 yes
 * @retval -EBUSY its cause is still there
 */
int lw_controller_allow_clear_fault(const struct lw_controller *controller, struct lw_refusal *why);

/**
 * May rope that was laid while the carriage stood be acknowledged now?
 *
 * @retval 0 yes; also if there is none
 * @retval -EBUSY the drum turns, or no indexing has succeeded since
 */
int lw_controller_allow_acknowledge_rope(const struct lw_controller *controller,
					 struct lw_refusal *why);

/** Somebody has looked at the rope. Only if lw_controller_allow_acknowledge_rope() says 0. */
void lw_controller_acknowledge_rope(struct lw_controller *controller);

/**
 * May it be told now how much rope is on the drum?
 *
 * @param mm negative: nobody has said how much
 * @retval 0 yes
 * @retval -EBUSY the drum turns or may turn unseen, or is not described
 */
int lw_controller_allow_set_rope(const struct lw_controller *controller, int32_t mm,
				 struct lw_refusal *why);

/**
 * So much rope is on the drum now. Only if lw_controller_allow_set_rope() says 0.
 *
 * @retval 0 done
 * @retval -ERANGE so much does not go onto this drum; nothing has changed
 */
int lw_controller_set_rope(struct lw_controller *controller, int32_t mm);

/**
 * May a reversal be made earlier or later by hand now?
 *
 * @param later true: later
 * @retval 0 yes
 * @retval -EBUSY the carriage does not follow the drum by the screw
 * @retval -EINVAL the trim would break a rule
 */
int lw_controller_allow_hand_trim(const struct lw_controller *controller, bool later,
				  struct lw_refusal *why);

/**
 * Make the reversal at the side that the carriage moves toward earlier or later by trim_step_um.
 * Only if lw_controller_allow_hand_trim() says 0.
 *
 * @return the trim of that side, micrometres
 */
int32_t lw_controller_hand_trim(struct lw_controller *controller, bool later);

/**
 * Take the levels of the buttons for early and late reversal. Before every tick: they count once
 * they have been so for 20 ms.
 *
 * @param pressed by `later`: false, true
 * @return by bit, 1 << later: buttons that have just been pressed
 */
unsigned int lw_controller_trim_buttons(struct lw_controller *controller, const bool pressed[2]);

/** Acknowledge a fault. The position is unknown afterwards; LOS flags stay. */
void lw_controller_clear_fault(struct lw_controller *controller);

/** Ask for a mode. Off takes effect at once, the others when the drum is at rest. */
void lw_controller_set_mode(struct lw_controller *controller, enum lw_mode mode);

/**
 * May the carriage be jogged in this direction now? Direction 0 is always allowed.
 *
 * @retval 0 yes
 * @retval -EBUSY mode off, tracking a turning drum, a doubtful encoder, moving otherwise, or toward
 * an actuated switch
 */
int lw_controller_allow_jog(const struct lw_controller *controller, int direction,
			    struct lw_refusal *why);

/** Jog, or hold on jogging; 0 ends it. Ends by itself after jog_hold_ms. */
void lw_controller_jog(struct lw_controller *controller, int direction, uint64_t now_us);

/** Shift the reversal points. Applied in the sweep only. Already checked. */
void lw_controller_set_trim(struct lw_controller *controller, int32_t trim_plus_um,
			    int32_t trim_minus_um);

/** Which pattern the parameters ask for: a checksum of the law's window, trim not included. */
uint32_t lw_controller_pattern(const struct lw_controller *controller);

/**
 * Direction in which the carriage goes on from `resume` while the drum hauls in.
 *
 * @return +1 or -1; 0: it is not known where the rope goes on
 */
int lw_controller_resume_direction(const struct lw_controller *controller);

/** Where the carriage stands by a running cam, less where the table says. */
int64_t lw_cam_shift_usteps(const struct lw_controller *controller);

/** Let the running cam go over to another table, which joins it, at the begin of a cycle. */
void lw_cam_queue(struct lw_controller *controller, const struct lw_cam_bank *bank);

#endif /* LW_CONTROLLER_H */
