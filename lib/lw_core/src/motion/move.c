/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/motion/move.h"

#include "lw/bytes/numbers.h"

/** Below every position: they reach to about 32,700 microsteps either way. */
#define LOWEST (INT32_MIN + LW_USTEP)

int32_t lw_move_run(struct lw_law_window *window, int32_t ka, int32_t nr, int direction)
{
	*window = (struct lw_law_window){
		.ka = ka,
		.ks = ka * nr,
		.sweep_begin = direction > 0 ? 0 : LOWEST,
		.sweep_end = direction > 0 ? INT32_MAX : 1,
	};
	return -direction * (int32_t)lw_move_ramp_q16(ka, nr);
}

bool lw_move_to(int32_t m, struct lw_law_window *window, int32_t ka, int32_t nr,
		int32_t target_usteps)
{
	const int64_t target = (int64_t)target_usteps * LW_USTEP;
	const int direction = target > m ? 1 : -1;
	const int64_t distance = direction * (target - m);

	if (distance < LW_USTEP - 1) {
		return false;
	}

	/* Ramp up and down over n edges each cover ka * n * n together; ka is below a microstep. */
	int32_t n = lw_integer_sqrt(distance / ka);

	n = n > nr ? nr : n;

	const int32_t ramp_end = (int32_t)(m + direction * lw_move_ramp_q16(ka, n));
	const int32_t slow_down = (int32_t)(target - direction * lw_move_overshoot_q16(ka, n));

	*window = (struct lw_law_window){
		.ka = ka,
		.ks = ka * n,
		.sweep_begin = direction > 0 ? ramp_end : slow_down,
		.sweep_end = direction > 0 ? slow_down : ramp_end + 1,
	};
	if (window->sweep_begin == window->sweep_end) {
		/* A sweep has a length; the ramp up does not come by this place. */
		window->sweep_begin--;
	}
	return true;
}

bool lw_move_into(int32_t *m, struct lw_law_window *window, int32_t ka, int32_t nr,
		  int32_t target_usteps)
{
	const int32_t pos_usteps = lw_law_pos_usteps(*m);

	if (pos_usteps == target_usteps) {
		return false;
	}
	/* A move ends at its target or up to one slope, less than a microstep, past it. */
	*m = pos_usteps * LW_USTEP + (target_usteps > pos_usteps ? 0 : LW_USTEP - 1);
	return lw_move_to(*m, window, ka, nr, target_usteps + (target_usteps < pos_usteps));
}

int32_t lw_move_from_far_point(struct lw_law_window *window, int32_t ka, int32_t nr,
			       int32_t travel_usteps, int direction)
{
	const int32_t ramp_usteps = (int32_t)(lw_move_overshoot_q16(ka, nr) / LW_USTEP) + 2;
	const int32_t length = (travel_usteps + ramp_usteps) * LW_USTEP;

	*window = (struct lw_law_window){
		.ka = ka,
		.ks = ka * nr,
		.sweep_begin = direction > 0 ? 0 : -length,
		.sweep_end = direction > 0 ? length : 0,
	};
	return (int32_t)(direction > 0 ? -lw_move_ramp_q16(ka, nr) : lw_move_overshoot_q16(ka, nr));
}

/** The way from the entry of the plus reversal to the slope d * ka, Q16.16. */
static int32_t way_q16(int32_t ka, int32_t nr, int32_t d)
{
	return (int32_t)((int64_t)ka * (nr - d) * (nr - 1 + d) / 2);
}

int32_t lw_move_turn(struct lw_law_window *window, int32_t ka, int32_t nr, int32_t travel_usteps,
		     int direction, int32_t m, int32_t u)
{
	const int32_t length = travel_usteps / 2 * LW_USTEP;
	const int32_t floor_m = lw_law_pos_usteps(m) * LW_USTEP;

	*window = (struct lw_law_window){.ka = ka, .ks = ka * nr};
	if (direction > 0) {
		window->sweep_end = m - way_q16(ka, nr, u / ka);
		window->sweep_begin = lw_law_pos_usteps(window->sweep_end) * LW_USTEP - length;
		return m;
	}

	/*
	 * A sweep begins at a whole microstep, and the entry lies up to one slope before it. Where
	 * that does not fit, the position within its microstep gives way.
	 */
	const int32_t way = way_q16(ka, nr, -u / ka);
	int32_t last;

	window->sweep_begin = (lw_law_pos_usteps(floor_m + way) + 1) * LW_USTEP;
	window->sweep_end = window->sweep_begin + length;
	last = window->sweep_begin - way - 1;
	return m > last ? last : m <= last - window->ks ? last - window->ks + 1 : m;
}

void lw_move_halt(int32_t u, struct lw_law_window *window, int32_t ka)
{
	/* A sweep that lies behind every place that the carriage may be at. */
	const int32_t sweep_begin = u > 0 ? LOWEST : INT32_MAX - 1;

	*window = (struct lw_law_window){
		.ka = ka,
		.ks = u > 0 ? u : -u,
		.sweep_begin = sweep_begin,
		.sweep_end = sweep_begin + 1,
	};
}
