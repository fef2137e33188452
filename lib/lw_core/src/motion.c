#include "lw/motion.h"

#include <stddef.h>

void lw_motion_init(struct lw_motion *motion, const struct lw_law_window *window)
{
	*motion = (struct lw_motion){
		.window = window,
		.last_dd = 1,
		.source = LW_EDGE_SOURCE_NONE,
	};
}

struct lw_motion_reading lw_motion_read(const struct lw_motion *motion)
{
	const volatile uint32_t *interrupts = &motion->interrupts;
	struct lw_motion_reading reading;
	uint32_t before;

	do {
		before = *interrupts;
		atomic_signal_fence(memory_order_seq_cst);
		reading = (struct lw_motion_reading){
			.law = motion->law,
			.net_edges = motion->net_edges,
			.pattern_edges = motion->pattern_edges,
			.steps = motion->steps,
		};
		atomic_signal_fence(memory_order_seq_cst);
	} while (before != *interrupts);
	return reading;
}

/**
 * Shift the position by as much of the wanted correction as keeps it in the sweep, and keep the
 * rest for later edges. In whole microsteps, so that the phase of the step pulses stays.
 *
 * At the far end of the sweep this holds the position where the reversal begins on the next edge,
 * which is the best that can be done for a carriage that is further out than the law knew.
 */
static void correct(struct lw_motion *motion)
{
	const int32_t up_max = (motion->window->sweep_end - 1 - motion->law.m) / LW_USTEP;
	const int32_t down_max = (motion->law.m - motion->window->sweep_begin) / LW_USTEP;
	int32_t correction = motion->request_correction_usteps;

	if (correction > up_max) {
		correction = up_max;
	}
	if (correction < -down_max) {
		correction = -down_max;
	}
	motion->law.m += correction * LW_USTEP;
	motion->request_correction_usteps -= correction;
	if (motion->request_correction_usteps == 0) {
		motion->requests &= (uint8_t)~LW_MOTION_REQUEST_CORRECTION;
	}
}

/** Take a new window at once; what lies outside of its sweep is brought to the sweep's border. */
static void rebase(struct lw_motion *motion)
{
	const struct lw_law_window *window = motion->request_window;
	int64_t m = motion->law.m + (int64_t)motion->request_correction_usteps * LW_USTEP;
	int32_t rest_usteps = 0;

	/* The rest is whole microsteps, rounded outward, so that m lands inside. */
	if (m >= window->sweep_end) {
		rest_usteps = (int32_t)((m - window->sweep_end) / LW_USTEP) + 1;
	} else if (m < window->sweep_begin) {
		rest_usteps = -(int32_t)((window->sweep_begin - m + LW_USTEP - 1) / LW_USTEP);
	}
	motion->law.m = (int32_t)(m - (int64_t)rest_usteps * LW_USTEP);
	motion->window = window;
	motion->request_correction_usteps = rest_usteps;
	motion->requests = rest_usteps ? LW_MOTION_REQUEST_CORRECTION : 0;
}

static void serve_requests(struct lw_motion *motion)
{
	if (motion->requests & LW_MOTION_REQUEST_REBASE) {
		rebase(motion);
		return;
	}
	if (motion->requests & LW_MOTION_REQUEST_SWAP) {
		motion->window = motion->request_window;
		motion->requests &= (uint8_t)~LW_MOTION_REQUEST_SWAP;
		return;
	}
	if (!lw_motion_in_sweep(motion)) {
		return;
	}
	if (motion->requests & LW_MOTION_REQUEST_CORRECTION) {
		correct(motion);
	}
	if ((motion->requests & LW_MOTION_REQUEST_WINDOW) &&
	    lw_law_region(motion->request_window, motion->law.m) == 0) {
		motion->window = motion->request_window;
		motion->requests &= (uint8_t)~LW_MOTION_REQUEST_WINDOW;
	}
}

/** The side bit of the reversal that the carriage is in, 0 in the sweep. */
static uint8_t reversal_side(const struct lw_motion *motion)
{
	const int region = lw_law_region(motion->window, motion->law.m);

	return region == 0 ? 0 : region < 0 ? LW_MOTION_PLUS : LW_MOTION_MINUS;
}

static int take_edge(struct lw_motion *motion, int dd)
{
	const int step = lw_law_edge(&motion->law, motion->window, dd);
	uint8_t side;

	motion->last_dd = (int8_t)dd;
	side = reversal_side(motion);
	if (side != 0) {
		motion->reached |= side;
	}
	if (motion->requests) {
		serve_requests(motion);
	}
	if (step == 0 || (motion->blocked & (step > 0 ? LW_MOTION_PLUS : LW_MOTION_MINUS))) {
		return 0;
	}
	motion->steps++;
	return step;
}

int lw_motion_encoder_edge(struct lw_motion *motion, int dd)
{
	motion->interrupts++;
	motion->net_edges += dd;
	if (motion->source != LW_EDGE_SOURCE_ENCODER) {
		return 0;
	}
	motion->pattern_edges += dd;
	return take_edge(motion, dd);
}

int lw_motion_timer_edge(struct lw_motion *motion)
{
	if (motion->source != LW_EDGE_SOURCE_TIMER) {
		return 0;
	}

	motion->interrupts++;

	const int step = take_edge(motion, 1);

	if (motion->law.u == 0 && (motion->stop_at_rest & reversal_side(motion))) {
		motion->source = LW_EDGE_SOURCE_NONE;
	}
	return step;
}
