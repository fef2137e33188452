#include "lw/move.h"

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

void lw_move_run(struct lw_law *law, struct lw_law_window *window, int32_t ka, int32_t nr,
		 int direction)
{
	*law = (struct lw_law){.m = -direction * (int32_t)lw_move_ramp_q16(ka, nr)};
	*window = (struct lw_law_window){
		.ka = ka,
		.ks = ka * nr,
		.sweep_begin = direction > 0 ? 0 : INT32_MIN,
		.sweep_end = direction > 0 ? INT32_MAX : 1,
	};
}

bool lw_move_to(const struct lw_law *law, struct lw_law_window *window, int32_t ka, int32_t nr,
		int32_t target_usteps)
{
	const int64_t target = (int64_t)target_usteps * LW_USTEP;
	const int direction = target > law->m ? 1 : -1;
	const int64_t distance = direction * (target - law->m);

	if (distance < LW_USTEP) {
		return false;
	}

	/* Ramp up and down over n edges each cover ka * n * n together; ka is below a microstep. */
	int32_t n = integer_sqrt(distance / ka);

	n = n > nr ? nr : n;

	const int32_t ramp_end = (int32_t)(law->m + direction * lw_move_ramp_q16(ka, n));
	const int32_t slow_down = (int32_t)(target - direction * lw_move_overshoot_q16(ka, n));

	*window = (struct lw_law_window){
		.ka = ka,
		.ks = ka * n,
		.sweep_begin = direction > 0 ? ramp_end : slow_down,
		.sweep_end = direction > 0 ? slow_down : ramp_end + 1,
	};
	return true;
}

void lw_move_halt(const struct lw_law *law, struct lw_law_window *window, int32_t ka)
{
	const int32_t everywhere = law->u > 0 ? INT32_MIN : INT32_MAX;

	*window = (struct lw_law_window){
		.ka = ka,
		.ks = law->u > 0 ? law->u : -law->u,
		.sweep_begin = everywhere,
		.sweep_end = everywhere,
	};
}
