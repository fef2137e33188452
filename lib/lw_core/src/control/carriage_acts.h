/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What every motion of the carriage is made of: acts on the state of lw/control/carriage.h that
 * indexing, moving, tracking and the modes share. They call nothing above them. Not for interrupt
 * context.
 */
#ifndef LW_CARRIAGE_ACTS_H
#define LW_CARRIAGE_ACTS_H

#include "lw/control/carriage.h"
#include "lw/map/refusal.h"

/** A trigger that the supervisor has taken, or none. */
struct lw_carriage_trigger {
	bool taken;
	struct lw_limit_switch_trigger at;
};

/** Refuse for now. @return -EBUSY */
int lw_carriage_busy(struct lw_refusal *why, enum lw_reason reason);

/** Stop all step pulses now. What the interrupt was asked for is dropped. */
void lw_carriage_cut(struct lw_controller *controller);

/** The window that is not in force, to be filled before it is handed over. */
struct lw_law_window *lw_carriage_spare_window(struct lw_controller *controller);

/** The law's window for tracking, trim included. */
struct lw_law_window lw_carriage_track_window(const struct lw_controller *controller);

/** Ask the interrupt to take a window, in the manner of `request`. */
void lw_carriage_request(struct lw_controller *controller, struct lw_law_window window,
			 enum lw_motion_request request, int32_t correction_usteps);

/** Where the carriage is, in whole microsteps. */
int32_t lw_carriage_pos_usteps(const struct lw_controller *controller);

/**
 * How far the carriage goes while a limit switch is late (switch_delay_us), whole microsteps, its
 * sign the direction. A cam has no slope that would say it: 0.
 *
 * @param u slope, Q16.16
 */
int32_t lw_carriage_lag_usteps(const struct lw_controller *controller, int32_t u);

/** How far that is at the most now, in the sweep; not negative. */
int32_t lw_carriage_lag_max_usteps(const struct lw_controller *controller);

/** Edges that lead so far astray that the lay would show it: a quarter of a switch's tolerance. */
uint32_t lw_carriage_tolerance_edges(const struct lw_controller *controller);

/** The bit of a side, as the motion has it. */
static inline enum lw_motion_side_bit lw_carriage_side_bit(int side)
{
	return side == LW_PLUS ? LW_MOTION_PLUS : LW_MOTION_MINUS;
}

/** Direction of the carriage's motion toward `side`: true if it moves that way. */
bool lw_carriage_moves_toward(int direction, int side);

/**
 * Did a switch trigger on the way toward it? By the last step then, or by the drum's motion: a
 * disturbed encoder steps back for a moment.
 */
bool lw_carriage_triggered_outward(const struct lw_controller *controller,
				   const struct lw_limit_switch_trigger *at, int side);

#endif /* LW_CARRIAGE_ACTS_H */
