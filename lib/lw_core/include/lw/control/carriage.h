/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The state of the controller, each part with the file that writes it. What may be asked of it and
 * what drives it is in lw/control/controller.h.
 *
 * All contexts run on one processor: an interrupt comes between two instructions of a thread, never
 * beside them. So a fence of the compiler is enough where an interrupt and the supervisor hand over
 * to each other.
 */
#ifndef LW_CARRIAGE_H
#define LW_CARRIAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/cam/cam_banks.h"
#include "lw/control/drum_speed.h"
#include "lw/control/drum_watch.h"
#include "lw/control/limit_switch.h"
#include "lw/control/los_record.h"
#include "lw/control/params.h"
#include "lw/control/rope_length.h"
#include "lw/control/rope_watch.h"
#include "lw/map.h"
#include "lw/motion/encoder_index.h"
#include "lw/motion/motion.h"
#include "lw/motion/quadrature.h"

/** A move by the edge timer. Written by moving.c; `halting` also cleared by a cut (carriage.c). */
struct lw_moving {
	bool halting;             /**< the ramp down has been asked for; read by the jog's coils */
	bool halt_sent;           /**< and handed to the interrupt */
	enum lw_state rest_state; /**< to enter when the move has come to rest */
	/** Without an index each move counts from a place of its own: how far the counting has been
	 *  shifted since the carriage was left where it was known; read by resume.c. An indexing
	 *  adds its own shift; at power-up set by device/look.c. */
	int32_t shift_usteps;
};

/** Moving by hand. Written by jogging.c. */
struct lw_jogging {
	int8_t direction; /**< of the last jog; read by the overtravel check and the jog's coils */
	uint64_t written_us;
};

/** What an indexing is doing; the table at the head of homing.c says how it goes on. */
enum lw_homing_phase {
	LW_HOMING_STOPPING,   /**< told to end: the ramp down */
	LW_HOMING_LEAVING,    /**< off a switch that is actuated */
	LW_HOMING_LEFT,       /**< it has released: on by what the seek needs */
	LW_HOMING_SEEKING,    /**< toward the indexing switch */
	LW_HOMING_TOO_CLOSE,  /**< it triggered on the ramp up: the ramp down, to come again */
	LW_HOMING_TURNING,    /**< rebased at the switch: round the reversal */
	LW_HOMING_SPAN_CHECK, /**< back, to where the other switch must trigger */
	LW_HOMING_PARKING,    /**< to rest at the parking place */
	LW_HOMING_PHASES,
};

/** Indexing. Written by homing.c. */
struct lw_homing {
	enum lw_homing_phase phase; /**< of the indexing under way, or the last one */
	int back_off_side;          /**< LW_PLUS or LW_MINUS; read by the overtravel check */
	int32_t span_error_usteps;  /**< read by status and journal */
};

/** Whether the limit switches can be true. Written by switch_check.c; read by status, journal. */
struct lw_switch_check {
	uint64_t plausible_us[2]; /**< by side: when what it says last fitted the position */
	bool implausible[2];      /**< by side: it has not fitted for longer than a contact takes */
};

/**
 * Where the rope goes on: the law's state when the drum came to rest while the carriage followed.
 * Written by resume.c, and at power-up by device/look.c; read by status, journal and look.c.
 */
struct lw_resume {
	bool known;
	bool followed; /**< it is of the following that goes on */
	bool doubtful; /**< the drum may have turned since: it is not taken up */
	bool wanted;   /**< the next hand-over takes it up */
	int32_t m;     /**< Q16.16 */
	int32_t u;     /**< slope, Q16.16 */
	uint32_t dwell_edges;
	uint32_t cycle_plus;
	uint32_t cycle_minus;
	uint32_t pattern;     /**< lw_controller_pattern() then */
	uint32_t edges;       /**< odometer then, low half */
	int32_t stand_usteps; /**< where the carriage was last left at rest, and known */
	uint16_t taken_up;    /**< how often, since power-up */
};

/**
 * Taking up a turning drum from rest, at an unknown place. Written by reacquire.c; when it may
 * begin by controller.c; what a restart has left of the launch by device/kept.c, at power-up.
 */
struct lw_reacquire {
	bool wanted;           /**< by itself, once the drum is seen to turn */
	int8_t kept_direction; /**< of the carriage before the restart, drum hauling in; 0: unknown
				*/
	uint64_t stands_since_us; /**< the carriage; at first since the power-up */
	bool began_on_switch;     /**< that of the side that it moves away from */
	bool turning;             /**< the switch has triggered on the ramp: round at once */
	int side;                 /**< LW_PLUS or LW_MINUS: the end ahead */
	int32_t begin_usteps;
	int32_t shift_usteps; /**< from where the law counts the carriage to where it is */
	uint16_t begun;       /**< how often, since power-up; read by the journal */
	uint16_t done;        /**< likewise, with success */
};

/** The stepper driver's alarm. Written by lw_controller_stepper_alarm(). */
struct lw_stepper_alarm {
	bool on;
	uint8_t polls; /**< that have told the opposite, in a row */
};

/** Live trim of the reversal points. Written by lw_controller_set_trim(). */
struct lw_trim {
	int32_t plus_um;
	int32_t minus_um;
};

/** A button for early or late reversal. Written by hand_trim.c. */
struct lw_trim_button {
	bool pressed;
	uint8_t polls; /**< that have told the opposite, in a row */
};

/** State. */
struct lw_controller {
	const struct lw_params *params;   /**< active set; the owner's, told by _configure() */
	const struct lw_derived *derived; /**< what follows from it */

	/* Written by interrupts. */
	struct lw_quadrature quadrature; /**< by the encoder's */
	struct lw_motion motion;         /**< see lw/motion/motion.h */
	struct lw_encoder_index
		encoder_index;           /**< by the index pulse's; lw/motion/encoder_index.h */
	struct lw_limit_switch limit[2]; /**< by side: by the switch's, and by every tick */
	bool overtravel[2];              /**< by side: by the switch's */

	/* Each written by its file, in the supervisor, and by nobody else. */
	struct lw_drum_watch drum_watch;     /**< drum_watch.c */
	struct lw_drum_speed speed;          /**< drum_speed.c */
	struct lw_switch_check switch_check; /**< switch_check.c */
	struct lw_homing homing;             /**< homing.c */
	struct lw_moving moving;             /**< moving.c */
	struct lw_jogging jogging;           /**< jogging.c */
	struct lw_resume resume;             /**< resume.c: where the rope goes on */
	struct lw_reacquire reacquire;       /**< reacquire.c */
	struct lw_los los;                   /**< los_record.c, los_judge.c */
	struct lw_rope_watch rope;           /**< rope_watch.c: what was laid while it stood */
	struct lw_rope_length rope_length;   /**< rope_length.c: how much is on the drum */

	/*
	 * The life of the carriage. Written by carriage.c, fault.c, by the file of the motion that
	 * begins or ends (homing.c, moving.c, tracking.c, cam_tracking.c) and by modes.c; read by
	 * all.
	 */
	enum lw_state state;
	enum lw_fault fault;
	bool indexed;
	bool on_orbit;                   /**< parked in a reversal of the pattern: hand-over keeps
					    the slope */
	struct lw_law_window windows[2]; /**< one in force, one to prepare the next */
	const struct lw_cam_bank *cam_bank; /**< table in force or NULL; the owner's, no cam on */
	struct lw_cam_refusal cam_refusal;  /**< why it cannot be handed over to the cam */

	/* Written by controller.c alone; read by modes.c and the device. */
	enum lw_mode requested_mode; /**< waits for the drum to rest */
	bool held;           /**< stopped by command: no hand-over until a mode is written */
	bool wiring[2];      /**< by side: sticky wiring faults; cleared by fault.c */
	bool overspeed_trip; /**< cleared by fault.c */
	struct lw_limit_switch_config limit_config;
	struct lw_stepper_alarm stepper_alarm;
	struct lw_trim trim;
	struct lw_trim_button trim_buttons[2]; /**< early, late */
	uint64_t now_us;                       /**< of the last tick */
	/** Edges that the edge timer may still give before a tick must come: set by every tick,
	 *  counted down by the timer's interrupt. */
	uint32_t timer_edges_left;

	enum lw_mode mode; /**< in force; written by modes.c */

	/* Told by the owner (device/), read by controller.c and modes.c. */
	bool master_lost;
	bool storing;           /**< the storage is written, nothing may begin to move */
	bool odometer_doubtful; /**< edges may be missing; until an indexing (homing.c) */
};

#endif /* LW_CARRIAGE_H */
