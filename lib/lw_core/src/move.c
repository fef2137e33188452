#include "lw/move.h"

/** Below every position: they reach to about 32,700 microsteps either way. */
#define LOWEST (INT32_MIN + LW_USTEP)

/** Largest n with n * n <= value. */
static int32_t integer_sqrt(int64_t value)
{
	int64_t root = 0;

	for (int64_t bit = (int64_t)1 << 31; bit > 0; bit >>= 1) {
		if ((root + bit) * (root + bit) <= value) {
			root += bit;
		}
	}
	return (int32_t)root;
}

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

	if (distance < LW_USTEP) {
		return false;
	}

	/* Ramp up and down over n edges each cover ka * n * n together; ka is below a microstep. */
	int32_t n = integer_sqrt(distance / ka);

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
