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

#include "lw/law.h"

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
 * @retval false the carriage is there already (less than one microstep away)
 */
bool lw_move_to(int32_t m, struct lw_law_window *window, int32_t ka, int32_t nr,
		int32_t target_usteps);

/** Plan the ramp down to rest, from any position and from the slope u. */
void lw_move_halt(int32_t u, struct lw_law_window *window, int32_t ka);

#endif /* LW_MOVE_H */
