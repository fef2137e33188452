/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Moves by the edge timer: what jogging, centring and indexing are made of. A move begins at rest,
 * and ends at rest by itself or because it is told to.
 */
#ifndef LW_MOVING_H
#define LW_MOVING_H

#include "lw/control/carriage.h"

/** Begin at rest at m (Q16.16), in a window, and start the edge timer. */
void lw_moving_start(struct lw_controller *controller, struct lw_law_window window, int32_t m);

/** Move the resting carriage, which is at m (Q16.16); on arrival enter `rest_state`. */
void lw_moving_to(struct lw_controller *controller, int32_t m, int32_t target_usteps,
		  enum lw_state moving_state, enum lw_state rest_state);

/** Ramp down; a carriage whose place is known stops inside the sweep. Then enter `rest_state`. */
void lw_moving_halt(struct lw_controller *controller, enum lw_state rest_state);

/** Begin the ramp down that was asked for, once the carriage is where it may come to rest. */
void lw_moving_serve_halt(struct lw_controller *controller);

/** A move that is no indexing goes on, or has come to rest. Every tick. */
void lw_moving_tick(struct lw_controller *controller);

/**
 * Move the resting carriage into a microstep, then enter `rest_state`.
 *
 * @retval true under way, in `moving_state`
 * @retval false it is there already, nothing was done
 */
bool lw_moving_into(struct lw_controller *controller, int32_t target_usteps,
		    enum lw_state moving_state, enum lw_state rest_state);

#endif /* LW_MOVING_H */
