/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Moves from rest to rest with the law's own arithmetic: indexing, centring, jogging.
 *
 * A move is a window for the law, run by simulated forward edges: its sweep begins where the ramp
 * up has reached the wanted slope and ends where the ramp down must begin. The slope walks in
 * whole multiples of Ka, so it comes back to exactly 0. Not for interrupt context.
 */
#ifndef LW_MOVE_H
#define LW_MOVE_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/motion/law.h"

/** Distance of a ramp from slope 0 up to Ka * nr, Q16.16: Ka * nr * (nr + 1) / 2. */
static inline int64_t lw_move_ramp_q16(int32_t ka, int32_t nr)
{
	return (int64_t)ka * nr * (nr + 1) / 2;
}

/** Distance of a ramp from slope Ka * nr down to 0, Q16.16: Ka * nr * (nr - 1) / 2 (P5). */
static inline int64_t lw_move_overshoot_q16(int32_t ka, int32_t nr)
{
	return (int64_t)ka * nr * (nr - 1) / 2;
}

/**
 * Plan an endless run in one direction, from rest: the slope is exactly Ks at position 0 after Nr
 * edges (doc/control-law.md section 3, indexing ramp), and stays there.
 *
 * @param direction +1 or -1
 * @return the position to start at, Q16.16
 */
int32_t lw_move_run(struct lw_law_window *window, int32_t ka, int32_t nr, int direction);

/**
 * Plan a move of the resting carriage to a place. It ends less than one microstep from there; a
 * short way is done at a lower slope.
 *
 * @param m position of the carriage, Q16.16
 * @param target_usteps within the range of a position
 * @retval true `window` is set: take timer edges from u = 0 until u is 0 again
 * @retval false the carriage is there already (less than one microstep away, to 1/65536)
 */
bool lw_move_to(int32_t m, struct lw_law_window *window, int32_t ka, int32_t nr,
		int32_t target_usteps);

/**
 * Plan a move of the resting carriage into a microstep: it ends there, not beside it.
 *
 * @param m position of the carriage, Q16.16; receives where in its microstep the move begins
 * @retval true as lw_move_to()
 * @retval false the carriage is there already
 */
bool lw_move_into(int32_t *m, struct lw_law_window *window, int32_t ka, int32_t nr,
		  int32_t target_usteps);

/**
 * Plan to follow edges of either direction from rest, away from an end: the second half of the
 * law's own reversal there, and then the sweep. So the state is on the orbit of `window`, which
 * lw_params_derive() would accept: it is proved that it stays there.
 *
 * @param travel_usteps length of the sweep, at least; with two ramps at most 32700
 * @param direction +1 or -1
 * @return the position to start at, with slope 0, Q16.16
 */
int32_t lw_move_from_far_point(struct lw_law_window *window, int32_t ka, int32_t nr,
			       int32_t travel_usteps, int direction);

/**
 * Plan to turn round at once, from a slope that a ramp has reached: the window in which the state
 * is on the orbit, in the reversal at the side `direction`.
 *
 * @param direction +1 or -1
 * @param u slope, a multiple of ka below ka * nr, either sign
 * @return the position to go on from: `m`, or another one in the same microstep
 */
int32_t lw_move_turn(struct lw_law_window *window, int32_t ka, int32_t nr, int32_t travel_usteps,
		     int direction, int32_t m, int32_t u);

/** Plan the ramp down to rest, from any position and from the slope u. */
void lw_move_halt(int32_t u, struct lw_law_window *window, int32_t ka);

#endif /* LW_MOVE_H */
