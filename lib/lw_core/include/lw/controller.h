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

#include "lw/bank.h"
#include "lw/cam_banks.h"
#include "lw/encoder_index.h"
#include "lw/limit_switch.h"
#include "lw/map.h"
#include "lw/motion.h"
#include "lw/params.h"
#include "lw/quadrature.h"

/** Period at which lw_controller_tick() is called. */
#define LW_CONTROLLER_TICK_US 1000

/** Ticks over which the drum speed is measured. */
#define LW_CONTROLLER_SPEED_TICKS 64

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

/** One kind of LOS on one side. */
struct lw_los_record {
	bool set;             /**< sticky until an indexing has succeeded */
	uint16_t count;       /**< since power-up */
	int32_t position_q16; /**< of the first since the last indexing */
	uint32_t time_ms;     /**< of the first since the last indexing */
};

/** State. Written by the supervisor unless a comment says else. */
struct lw_controller {
	const struct lw_params *params;   /**< active set */
	const struct lw_derived *derived; /**< what follows from it */

	struct lw_quadrature quadrature;       /**< written by the encoder interrupt */
	struct lw_motion motion;               /**< see lw/motion.h */
	struct lw_law_window windows[2];       /**< one in force, one to prepare the next */
	struct lw_encoder_index encoder_index; /**< see lw/encoder_index.h */
	struct lw_limit_switch limit[2]; /**< written by the limit-switch interrupts and ticks */
	struct lw_limit_switch_config limit_config;
	bool overtravel[2];          /**< written by the overtravel interrupts */
	bool wiring[2];              /**< sticky wiring faults */
	bool stepper_alarm;          /**< told by the owner */
	uint8_t stepper_alarm_polls; /**< that have told the opposite, in a row */

	enum lw_state state;
	enum lw_mode mode;           /**< in force */
	enum lw_mode requested_mode; /**< waits for the drum to rest */
	enum lw_fault fault;
	bool indexed;
	bool on_orbit;    /**< parked in a reversal of the pattern: hand-over keeps the slope */
	bool held;        /**< stopped by command: no hand-over until a mode is written */
	bool master_lost; /**< told by the owner */
	bool storing; /**< told by the owner: the storage is written, nothing may begin to move */
	bool overspeed_trip;

	/* Indexing and other moves. */
	bool halting;             /**< the ramp down has been asked for */
	bool halt_sent;           /**< and handed to the interrupt */
	bool releasing;           /**< backing off: the switch has released */
	int8_t move_direction;    /**< of a jog */
	int back_off_side;        /**< LW_PLUS or LW_MINUS */
	enum lw_state rest_state; /**< state to enter when a move has come to rest */
	uint64_t jog_written_us;
	int32_t span_error_usteps;

	/* Loss of synchronization. */
	struct lw_los_record los1[2];
	struct lw_los_record los2[2];
	uint16_t los_recoveries; /**< in this launch */
	bool seen[2];            /**< the switch has triggered on this way to the reversal */
	bool visiting[2];        /**< inside the reversal, already judged */

	/* Live trim of the reversal points. */
	int32_t trim_plus_um;
	int32_t trim_minus_um;

	/* Electronic cam. */
	const struct lw_cam_bank
		*cam_bank; /**< active table, or NULL; the owner's, with no cam on */
	struct lw_cam_refusal cam_refusal; /**< why it cannot be handed over to the cam */

	/* Drum speed. */
	uint32_t edge_history[LW_CONTROLLER_SPEED_TICKS];    /**< odometer, low half */
	uint32_t edge_history_us[LW_CONTROLLER_SPEED_TICKS]; /**< when, low half: ticks may be late
							      */
	uint8_t edge_history_next;
	int32_t drum_speed_edges_per_s;
	uint64_t rest_since_us; /**< the drum is slow since then */
	bool drum_at_rest;
	uint64_t now_us; /**< of the last tick */
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
 * @param dd +1 forward, -1 backward
 * @return the step of the carriage: +1, 0, -1; see lw_controller_driver_step()
 */
LW_EDGE_INLINE int lw_controller_drum_edge(struct lw_controller *controller, int dd)
{
	return lw_motion_edge(&controller->motion, dd);
}

/**
 * Take the encoder's levels after a transition. For the encoder interrupt.
 *
 * @return the steps of the carriage: +1, 0, -1, up to LW_CAM_STEPS_PER_EDGE_MAX either way by a
 * cam; see lw_controller_driver_step()
 */
LW_EDGE_INLINE int lw_controller_encoder(struct lw_controller *controller, bool a, bool b)
{
	const int dd = lw_quadrature_update(&controller->quadrature, a, b);

	return dd == 0 ? 0 : lw_motion_encoder_edge(&controller->motion, dd);
}

/** Take the beginning of the encoder's index pulse. For its interrupt. */
void lw_controller_encoder_index(struct lw_controller *controller);

/**
 * Take one edge of the edge timer. For its interrupt.
 *
 * @return the step of the carriage: +1, 0, -1; see lw_controller_driver_step()
 */
int lw_controller_timer_edge(struct lw_controller *controller);

/** Where the carriage is now, for a contact that closes. For the limit-switch interrupt. */
struct lw_limit_switch_trigger lw_controller_place(const struct lw_controller *controller);

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

/** Rate of the edge timer that the controller wants, edges per second; 0: off. */
uint32_t lw_controller_timer_rate_edges_per_s(const struct lw_controller *controller);

/** True if the stepper shall have current. */
bool lw_controller_stepper_enabled(const struct lw_controller *controller);

/** True while the carriage moves by itself. */
bool lw_controller_moving(const struct lw_controller *controller);

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
 * May indexing start now?
 *
 * @retval 0 yes
 * @retval -EBUSY mode off, moving, or the drum is not at rest
 */
int lw_controller_allow_index(const struct lw_controller *controller, struct lw_refusal *why);

/** Start indexing. Only if lw_controller_allow_index() says 0. Ends in READY or FAULT. */
void lw_controller_index(struct lw_controller *controller);

/** Stop every motion. Keeps the index where the carriage can be brought to rest in step. */
void lw_controller_stop(struct lw_controller *controller);

/**
 * May the fault be acknowledged now?
 *
 * @retval 0 yes
 * @retval -EBUSY its cause is still there
 */
int lw_controller_allow_clear_fault(const struct lw_controller *controller, struct lw_refusal *why);

/** Acknowledge a fault. The position is unknown afterwards; LOS flags stay. */
void lw_controller_clear_fault(struct lw_controller *controller);

/** Ask for a mode. Off takes effect at once, the others when the drum is at rest. */
void lw_controller_set_mode(struct lw_controller *controller, enum lw_mode mode);

/**
 * May the carriage be jogged in this direction now? Direction 0 is always allowed.
 *
 * @retval 0 yes
 * @retval -EBUSY mode off, tracking a turning drum, moving otherwise, or toward an actuated switch
 */
int lw_controller_allow_jog(const struct lw_controller *controller, int direction,
			    struct lw_refusal *why);

/** Jog, or hold on jogging; 0 ends it. Ends by itself after jog_hold_ms. */
void lw_controller_jog(struct lw_controller *controller, int direction, uint64_t now_us);

/** Shift the reversal points. Applied in the sweep only. Already checked. */
void lw_controller_set_trim(struct lw_controller *controller, int32_t trim_plus_um,
			    int32_t trim_minus_um);

/** Where the carriage stands by a running cam, less where the table says. */
int64_t lw_cam_shift_usteps(const struct lw_controller *controller);

/** Let the running cam go over to another table, which joins it, at the begin of a cycle. */
void lw_cam_queue(struct lw_controller *controller, const struct lw_cam_bank *bank);

#endif /* LW_CONTROLLER_H */
