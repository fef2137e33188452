/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/motion/motion.h"

#include <stddef.h>
#include <string.h>

#include "lw/bytes/require.h"
#include "lw/bytes/same.h"

/** Apart, for it is long and nothing that is in a hurry. */
static __attribute__((noinline)) struct lw_law law_at(const struct lw_law_window *window, int32_t m,
						      int32_t u)
{
	return lw_law_at(window, m, u);
}

void lw_motion_init(struct lw_motion *motion, const struct lw_law_window *window)
{
	*motion = (struct lw_motion){
		.law = law_at(window, 0, 0),
		.window = window,
		.source = LW_EDGE_SOURCE_NONE,
	};
}

int32_t lw_motion_m(const struct lw_motion *motion)
{
	/* A new window changes two of them, a cam two; the supervisor cannot ask for two while this
	 * reads. */
	const volatile uint32_t *below_from = &motion->law.below_from;
	const volatile uint32_t *rel = &motion->law.rel;
	const volatile int32_t *ahead_usteps = &motion->cam.ahead_usteps;
	struct lw_law law = {0};
	int32_t ahead;

	do {
		law.below_from = *below_from;
		ahead = *ahead_usteps;
		law.rel = *rel;
	} while (law.below_from != *below_from || ahead != *ahead_usteps);
	law.rel += (uint32_t)ahead * LW_USTEP;
	return lw_law_m(&law);
}

/** The words that edges change. */
struct words {
	uint32_t rel;
	uint32_t below_from;
	uint32_t u;
	uint32_t edges;
	uint32_t unfollowed_edges;
	uint32_t steps;
	int32_t ahead_usteps;
};

static struct words read_words(const volatile struct lw_motion *motion)
{
	return (struct words){
		.rel = motion->law.rel,
		.below_from = motion->law.below_from,
		.u = (uint32_t)motion->law.u,
		.edges = motion->edges,
		.unfollowed_edges = motion->unfollowed_edges,
		.steps = motion->steps,
		.ahead_usteps = motion->cam.ahead_usteps,
	};
}

static struct words read_twice(const struct lw_motion *motion)
{
	struct words first;
	struct words second = read_words(motion);

	do {
		first = second;
		second = read_words(motion);
	} while (!lw_same(&first, &second, sizeof(first)));
	return second;
}

/** A 64-bit counter brought up to date with its lower half. */
static int64_t continued(int64_t count, uint32_t low)
{
	return count + (int32_t)(low - (uint32_t)count);
}

struct lw_motion_reading lw_motion_read(const struct lw_motion *motion)
{
	const struct words words = read_twice(motion);
	const int32_t ahead = words.ahead_usteps;
	const struct lw_law law = {
		.rel = words.rel + (uint32_t)ahead * LW_USTEP,
		.below_from = words.below_from,
	};
	const uint32_t followed_edges = words.edges - words.unfollowed_edges;

	return (struct lw_motion_reading){
		.m = lw_law_m(&law),
		.u = (int32_t)words.u,
		.net_edges = continued(motion->net_edges, words.edges),
		.pattern_edges =
			continued(motion->followed_edges, followed_edges) - motion->pattern_begin,
		.steps = words.steps + (uint32_t)(ahead > 0 ? ahead : -ahead),
		.unfollowed_edges = words.unfollowed_edges,
	};
}

void lw_motion_count(struct lw_motion *motion)
{
	const struct words words = read_twice(motion);

	motion->net_edges = continued(motion->net_edges, words.edges);
	motion->followed_edges =
		continued(motion->followed_edges, words.edges - words.unfollowed_edges);
}

void lw_motion_begin_pattern(struct lw_motion *motion)
{
	LW_REQUIRE(motion->source != LW_EDGE_SOURCE_ENCODER);
	lw_motion_count(motion);
	motion->pattern_begin = motion->followed_edges;
}

/** Let every edge go the long way, after what was written before. */
static void close_short_way(struct lw_motion *motion)
{
	atomic_signal_fence(memory_order_seq_cst);
	*(volatile uint32_t *)&motion->law.open_span = 0;
	lw_cam_motion_close(&motion->cam);
}

void lw_motion_set_position(struct lw_motion *motion, const struct lw_law_window *window, int32_t m,
			    int32_t u)
{
	LW_REQUIRE(motion->source == LW_EDGE_SOURCE_NONE &&
		   window->sweep_begin < window->sweep_end);
	motion->window = window;
	motion->law = law_at(window, m, u);
}

/** Of a law with these edges rested and far points passed, what its window says. */
static struct lw_law as_window_says(const struct lw_law *law, const struct lw_law_window *window)
{
	const uint32_t span = (uint32_t)window->sweep_end - (uint32_t)window->sweep_begin;
	int32_t u = law->u;

	if (law->rel < span) {
		u = u < 0 ? -window->ks : window->ks;
	}

	struct lw_law said = law_at(window, (int32_t)(law->rel + (uint32_t)window->sweep_begin), u);

	said.turned = law->turned;
	said.dwell_edges = law->dwell_edges;
	said.cycle_plus = law->cycle_plus;
	said.cycle_minus = law->cycle_minus;
	return said;
}

bool lw_motion_is_sound(const struct lw_motion *motion)
{
	const struct lw_law_window *window;
	struct lw_law law;
	struct lw_law said;

	/* An edge meanwhile may change all of it: until two readings agree. */
	do {
		window = motion->window;
		law = motion->law;
		atomic_signal_fence(memory_order_seq_cst);
	} while (memcmp(&law, &motion->law, sizeof(law)) != 0 || window != motion->window);
	said = as_window_says(&law, window);
	said.open_span = law.open_span == 0 ? 0 : said.span;
	return memcmp(&law, &said, sizeof(law)) == 0; /* 32-bit members only: no padding */
}

void lw_motion_mend(struct lw_motion *motion, const struct lw_law_window *window)
{
	const enum lw_edge_source source = (enum lw_edge_source)motion->source;

	lw_motion_set_source(motion, LW_EDGE_SOURCE_NONE);
	motion->window = window;
	motion->law = as_window_says(&motion->law, window);
	lw_motion_set_source(motion, source);
}

void lw_motion_request(struct lw_motion *motion, uint8_t requests)
{
	motion->requests |= requests;
	close_short_way(motion);
}

void lw_motion_block(struct lw_motion *motion, enum lw_motion_side_bit side_bit, bool blocked)
{
	if (blocked) {
		motion->blocked |= (uint8_t)side_bit;
	} else {
		motion->blocked &= (uint8_t)~side_bit;
	}
	close_short_way(motion);
}

uint8_t lw_motion_take_withheld(struct lw_motion *motion)
{
	return atomic_exchange(&motion->withheld, 0);
}

bool lw_motion_take_turned(struct lw_motion *motion, enum lw_motion_side_bit side_bit)
{
	volatile int32_t *turned = &motion->law.turned;

	if (side_bit == LW_MOTION_PLUS ? *turned >= 0 : *turned <= 0) {
		return false;
	}
	*turned = 0;
	return true;
}

/**
 * Shift the position by as much of the wanted correction as keeps it in the sweep, and keep the
 * remainder for later edges. In whole microsteps, so that the phase of the step pulses stays.
 *
 * At the far end of the sweep this holds the position where the reversal begins on the next edge,
 * which is the best that can be done for a carriage that is further out than the law knew.
 */
static void correct(struct lw_motion *motion)
{
	const int32_t up_max = (int32_t)((motion->law.span - 1 - motion->law.rel) / LW_USTEP);
	const int32_t down_max = (int32_t)(motion->law.rel / LW_USTEP);
	int32_t correction = motion->request_correction_usteps;

	if (correction > up_max) {
		correction = up_max;
	}
	if (correction < -down_max) {
		correction = -down_max;
	}
	motion->law.rel += (uint32_t)correction * LW_USTEP;
	motion->request_correction_usteps -= correction;
	motion->corrected_usteps += correction;
	if (motion->request_correction_usteps == 0) {
		motion->requests &= (uint8_t)~LW_MOTION_REQUEST_CORRECTION;
	}
}

static void use(struct lw_motion *motion, const struct lw_law_window *window)
{
	motion->window = window;
	lw_law_use(&motion->law, window);
}

/** Take a new window at once; what lies outside of its sweep is brought to the sweep's border. */
static void rebase(struct lw_motion *motion)
{
	const struct lw_law_window *window = motion->request_window;
	const int32_t before = lw_law_m(&motion->law);
	const int64_t m = before + (int64_t)motion->request_correction_usteps * LW_USTEP;
	int32_t left_usteps = 0;

	/* What is left is whole microsteps, rounded outward, so that m lands inside. */
	if (m >= window->sweep_end) {
		left_usteps = (int32_t)((m - window->sweep_end) / LW_USTEP) + 1;
	} else if (m < window->sweep_begin) {
		left_usteps = -(int32_t)((window->sweep_begin - m + LW_USTEP - 1) / LW_USTEP);
	}
	motion->law.rel += (uint32_t)(m - (int64_t)left_usteps * LW_USTEP - before);
	use(motion, window);
	motion->request_correction_usteps = left_usteps;
	motion->requests = left_usteps ? LW_MOTION_REQUEST_CORRECTION : 0;
}

static void serve_requests(struct lw_motion *motion)
{
	if (motion->requests & LW_MOTION_REQUEST_REBASE) {
		rebase(motion);
		return;
	}
	if (motion->requests & LW_MOTION_REQUEST_SWAP) {
		use(motion, motion->request_window);
		motion->requests &= (uint8_t)~LW_MOTION_REQUEST_SWAP;
		return;
	}
	if (motion->law.rel >= motion->law.span) {
		return;
	}
	if (motion->requests & LW_MOTION_REQUEST_CORRECTION) {
		correct(motion);
	}
	if ((motion->requests & LW_MOTION_REQUEST_WINDOW) &&
	    lw_law_region(motion->request_window, lw_law_m(&motion->law)) == 0) {
		use(motion, motion->request_window);
		motion->requests &= (uint8_t)~LW_MOTION_REQUEST_WINDOW;
	}
}

/** Remember that a step was not given. Apart, so that an edge that is given pays nothing for it. */
static __attribute__((noinline)) void withhold(struct lw_motion *motion, uint8_t side_bit)
{
	motion->withheld |= side_bit;
}

/** Is there no step to be given, or none that way? What is not given is remembered. */
static bool is_withheld(struct lw_motion *motion, int steps)
{
	const uint8_t side_bit = steps > 0 ? LW_MOTION_PLUS : LW_MOTION_MINUS;

	if (steps == 0) {
		return true;
	}
	if (!(motion->blocked & side_bit)) {
		return false;
	}
	withhold(motion, side_bit);
	return true;
}

static int take_edge(struct lw_motion *motion, int dd)
{
	const int32_t before_usteps = lw_law_pos_usteps(lw_law_m(&motion->law));
	int step;

	/* The window of a move need not begin at a whole microstep, as the law's step wants it. */
	(void)lw_law_edge(&motion->law, dd);
	step = (int)(lw_law_pos_usteps(lw_law_m(&motion->law)) - before_usteps);
	if (motion->requests) {
		serve_requests(motion);
	}
	if (is_withheld(motion, step)) {
		return 0;
	}
	motion->steps++;
	motion->last_step = step;
	return step;
}

/** Count steps of a cam, not 0, that are given. */
LW_EDGE_INLINE void count_steps(struct lw_motion *motion, int steps)
{
	motion->steps += (uint32_t)(steps > 0 ? steps : -steps);
	/* 1 or -1, in two instructions less than to ask. */
	motion->last_step = -(int32_t)((uint32_t)steps >> 31) | 1;
}

/** Account for the steps that the cam's short way has added up. */
LW_EDGE_INLINE void account(struct lw_motion *motion)
{
	const int steps = motion->cam.ahead_usteps;

	if (steps != 0) {
		motion->cam.ahead_usteps = 0;
		motion->cam.cam.point.pos_usteps += (uint32_t)steps;
		motion->law.rel += (uint32_t)steps * LW_USTEP;
		count_steps(motion, steps);
	}
}

/** What a cam makes of an edge beside following its table. Apart, for it is long. */
static __attribute__((noinline)) int take_cam_edge(struct lw_motion *motion, int dd)
{
	int steps;

	account(motion);
	steps = lw_cam_motion_edge(&motion->cam, motion->unfollowed_edges, dd);
	if (!motion->blocked) {
		lw_cam_motion_open(&motion->cam, dd);
	}
	motion->law.rel += (uint32_t)steps * LW_USTEP;
	if (is_withheld(motion, steps)) {
		return 0;
	}
	count_steps(motion, steps);
	return steps;
}

/** An edge that is neither the short way's nor a cam's alone. */
static __attribute__((noinline)) int take_longest_way(struct lw_motion *motion, int dd)
{
	struct lw_law *law = &motion->law;
	int step;

	if (motion->source != LW_EDGE_SOURCE_ENCODER) {
		motion->unfollowed_edges += (uint32_t)dd;
		return 0;
	}
	if (motion->cam.on) {
		return take_cam_edge(motion, dd);
	}
	step = take_edge(motion, dd);
	if (!motion->requests && !motion->blocked && !law->dwells) {
		law->open_span = law->span;
	}
	return step;
}

/** An edge into a piece that is not prepared, while the cam's short way is open. */
static __attribute__((noinline)) int evaluate(struct lw_motion *motion, int dd)
{
	int steps;

	account(motion);
	steps = lw_cam_motion_table_edge(&motion->cam, dd);
	motion->cam.open = motion->cam.cam.piece.kind * dd;
	motion->law.rel += (uint32_t)steps * LW_USTEP;
	if (steps != 0) {
		count_steps(motion, steps);
	}
	return steps;
}

/** An edge into another piece while the cam's short way is open. */
LW_EDGE_INLINE int cross(struct lw_motion *motion, int dd)
{
	struct lw_cam_motion *cam = &motion->cam;
	const uint32_t accounted_usteps = cam->cam.point.pos_usteps;
	const struct lw_cam_table *next = atomic_load_explicit(&cam->next, memory_order_relaxed);
	const int ahead = cam->ahead_usteps;
	int steps;

	if (!lw_cam_cross(&cam->cam, dd, next, &cam->ring)) {
		return evaluate(motion, dd);
	}
	/* As account(), which would take the way there and back through `pos_usteps`. */
	steps = (int)(cam->cam.point.pos_usteps - accounted_usteps);
	cam->ahead_usteps = 0;
	cam->open = cam->cam.piece.kind * dd;
	motion->law.rel += (uint32_t)steps * LW_USTEP;
	steps -= ahead;
	if (ahead != 0) {
		count_steps(motion, ahead);
	}
	if (steps != 0) {
		count_steps(motion, steps);
	}
	return steps;
}

static __attribute__((noinline)) int cross_forward(struct lw_motion *motion)
{
	return cross(motion, 1);
}

static __attribute__((noinline)) int cross_backward(struct lw_motion *motion)
{
	return cross(motion, -1);
}

/** An edge of a cam in a wide piece, or where the master turns back; or the longest way. */
static __attribute__((noinline)) int take_wide_edge(struct lw_motion *motion, int dd)
{
	struct lw_cam_motion *cam = &motion->cam;
	int kind = cam->open * dd;
	int steps;

	if (kind == LW_CAM_CLOSED) {
		return take_longest_way(motion, dd);
	}
	if (kind < 0) {
		account(motion); /* from here on the steps go the other way */
		cam->open = -cam->open;
		kind = -kind;
	}
	if (!lw_cam_stays(&cam->cam, dd)) {
		return dd > 0 ? cross_forward(motion) : cross_backward(motion);
	}
	steps = lw_cam_inside(&cam->cam, kind, dd);
	cam->ahead_usteps += steps;
	return steps;
}

/** By the cam's short way, or another. */
LW_EDGE_INLINE int take_long(struct lw_motion *motion, int dd)
{
	struct lw_cam_motion *cam = &motion->cam;
	int steps;

	if (cam->open == dd * (int)LW_CAM_STRAIGHT) {
		if (!lw_cam_stays(&cam->cam, dd)) {
			return dd > 0 ? cross_forward(motion) : cross_backward(motion);
		}
		steps = lw_cam_inside(&cam->cam, LW_CAM_STRAIGHT, dd);
	} else if (cam->open == dd * (int)LW_CAM_CURVED) {
		if (!lw_cam_stays(&cam->cam, dd)) {
			return dd > 0 ? cross_forward(motion) : cross_backward(motion);
		}
		steps = lw_cam_inside(&cam->cam, LW_CAM_CURVED, dd);
	} else {
		return take_wide_edge(motion, dd);
	}
	if (steps != 0) {
		cam->ahead_usteps += steps;
	}
	return steps;
}

int lw_motion_long_forward(struct lw_motion *motion)
{
	return take_long(motion, 1);
}

int lw_motion_long_backward(struct lw_motion *motion)
{
	return take_long(motion, -1);
}

/** Is the carriage in a reversal in which timer edges shall stop? */
static bool stops_here(const struct lw_motion *motion)
{
	const int region = lw_law_region(motion->window, lw_law_m(&motion->law));

	return (region < 0 && (motion->stop_at_rest & LW_MOTION_PLUS)) ||
	       (region > 0 && (motion->stop_at_rest & LW_MOTION_MINUS));
}

void lw_motion_set_source(struct lw_motion *motion, enum lw_edge_source source)
{
	if (motion->cam.ahead_usteps != 0) {
		/* No edge moves the carriage while they are accounted for. */
		motion->source = LW_EDGE_SOURCE_NONE;
		close_short_way(motion);
		account(motion);
	}
	motion->source = (uint8_t)source;
	close_short_way(motion);
}

int lw_motion_timer_edge(struct lw_motion *motion)
{
	if (motion->source != LW_EDGE_SOURCE_TIMER) {
		return 0;
	}

	const int step = take_edge(motion, 1);

	if (motion->law.u == 0 && stops_here(motion)) {
		motion->source = LW_EDGE_SOURCE_NONE;
	}
	return step;
}
