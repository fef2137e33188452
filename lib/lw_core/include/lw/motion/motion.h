/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The motion of the carriage as the edge interrupts see it: which edges move it, the law, and the
 * few changes that the supervisor may ask for while it runs.
 *
 * Ownership: the edge interrupt (encoder or edge timer, never both at once) writes every field
 * unless its comment says else. The supervisor hands work to it through the `request_*` fields,
 * which it fills before lw_motion_request(), and leaves alone until the interrupt has cleared the
 * bit; while `source` is LW_EDGE_SOURCE_NONE the law is idle and the supervisor may set its
 * position with lw_motion_set_position(). The fields of this hand-over are atomic: an access to one
 * of them also keeps the accesses before and after it in order.
 *
 * A drum edge costs little because all that is unusual leaves the short way by one comparison:
 * whoever asks for something writes 0 to `law.open_span`, and then every edge goes the long way,
 * lw_motion_long_forward() or lw_motion_long_backward(), which restore it when nothing is left to
 * do. Nothing that asks may interrupt the edge interrupts. Behind that comparison the edges of a
 * cam have a short way of their own, closed by `cam.open` in the same places (lw/cam/cam_motion.h).
 */
#ifndef LW_MOTION_H
#define LW_MOTION_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "lw/cam/cam_motion.h"
#include "lw/motion/law.h"

/** Which edges move the carriage. */
enum lw_edge_source {
	LW_EDGE_SOURCE_NONE,    /**< none: it stands */
	LW_EDGE_SOURCE_ENCODER, /**< the drum */
	LW_EDGE_SOURCE_TIMER,   /**< simulated forward edges at a fixed rate */
};

/** What the supervisor asks of the interrupt, or-ed. */
enum lw_motion_request {
	/** Take `request_window` as soon as the carriage is in the sweep of both windows. */
	LW_MOTION_REQUEST_WINDOW = 1 << 0,
	/** Shift the position by `request_correction_usteps`, in the sweep only. */
	LW_MOTION_REQUEST_CORRECTION = 1 << 1,
	/** Take `request_window` and shift the position, both on the next edge. */
	LW_MOTION_REQUEST_REBASE = 1 << 2,
	/** Take `request_window` on the next edge and leave the position alone. */
	LW_MOTION_REQUEST_SWAP = 1 << 3,
};

/** A side as a bit, here called side_bit; elsewhere a side is an index (LW_PLUS, LW_MINUS). */
enum lw_motion_side_bit {
	LW_MOTION_PLUS = 1 << 0,
	LW_MOTION_MINUS = 1 << 1,
};

/**
 * State of the motion. Each field's writer and, where that is another context, its reader; all of
 * them run on one processor. The supervisor reads what belongs together by lw_motion_read().
 */
struct lw_motion {
	/** Written by the edge interrupt; `law.turned` is cleared by lw_motion_take_turned(). */
	struct lw_law law;
	/** Step pulses given, `cam.ahead_usteps` not among them; read by the supervisor. */
	uint32_t steps;
	/** Direction of the last of them, +1 or -1; 0: none yet. Read by the supervisor. */
	int32_t last_step;
	/** Odometer, net drum edges modulo 2^32. Written by who decodes, before the edge is taken:
	 *  the encoder interrupt, or a counter in hardware. */
	uint32_t edges;
	/** Those of them that did not move the carriage, net. Read by lw_motion_count(). */
	uint32_t unfollowed_edges;
	/** In force: written by the edge interrupt, by the supervisor while the law is idle. */
	const struct lw_law_window *window;
	uint8_t stop_at_rest; /**< lw_motion_side_bit: timer edges stop where the slope is 0 in
			       *   the reversal at that side; written by the supervisor */
	/** lw_motion_side_bit: no steps that way (overtravel); written by lw_motion_block() in the
	 *  overtravel interrupts, read by the edge interrupt. */
	_Atomic uint8_t blocked;
	/** lw_motion_side_bit: steps that way were not given; the supervisor takes it by
	 *  lw_motion_take_withheld(). The carriage stands where the law does not know. */
	_Atomic uint8_t withheld;
	/** enum lw_edge_source; written by lw_motion_set_source(), and set to NONE by the interrupt
	 *  when stop_at_rest is met. */
	_Atomic uint8_t source;
	/** enum lw_motion_request; set by lw_motion_request(), cleared by the edge interrupt. */
	_Atomic uint8_t requests;
	const struct lw_law_window *request_window; /**< written by the supervisor */
	int32_t request_correction_usteps; /**< written by the supervisor; the interrupt counts it
					    *   down as it applies it; 0 when none waits */
	int32_t corrected_usteps; /**< sum of what it has applied; read by the supervisor */
	/* The supervisor's: counters of the interrupt, continued in 64 bit. */
	int64_t net_edges;      /**< odometer: all drum edges, at the last lw_motion_count() */
	int64_t followed_edges; /**< those that moved the carriage, likewise */
	int64_t pattern_begin;  /**< followed_edges at the last hand-over */

	/** What moves the carriage instead of the law while it is on. The law's position follows
	 *  it, and its short way stays closed. */
	struct lw_cam_motion cam;
};

/** Direction of the carriage: that of the last step, 0 at the far point of a reversal. */
static inline int lw_motion_direction(const struct lw_motion *motion)
{
	const int32_t ahead_usteps = motion->cam.ahead_usteps;

	return ahead_usteps != 0    ? (ahead_usteps > 0 ? 1 : -1)
	       : motion->law.u == 0 ? 0
				    : (int)motion->last_step;
}

/** Position, Q16.16 microsteps. For all that the edge interrupt may interrupt. */
int32_t lw_motion_m(const struct lw_motion *motion);

/** True if the position lies in the sweep of the window in force. Not for the edge interrupt. */
static inline bool lw_motion_in_sweep(const struct lw_motion *motion)
{
	return lw_law_region(motion->window, lw_motion_m(motion)) == 0;
}

/** What the edge interrupt changes, all of one moment. */
struct lw_motion_reading {
	int32_t m;             /**< position, Q16.16 microsteps */
	int32_t u;             /**< slope, Q16.16 */
	int64_t net_edges;     /**< odometer: all drum edges */
	int64_t pattern_edges; /**< drum edges followed since the last hand-over, net */
	uint32_t steps;        /**< step pulses given */
	/** Drum edges that did not move the carriage, net, modulo 2^32. */
	uint32_t unfollowed_edges;
};

/**
 * Read what the edge interrupt changes. For the supervisor and what shares its lock.
 *
 * Reads until two readings agree: no edges can come so fast that both were wrong.
 */
struct lw_motion_reading lw_motion_read(const struct lw_motion *motion);

/** Start with nothing moving at position 0. */
void lw_motion_init(struct lw_motion *motion, const struct lw_law_window *window);

/** Continue the 32-bit edge counters in 64 bit. For the supervisor, at least every 10 hours. */
void lw_motion_count(struct lw_motion *motion);

/** Count `pattern_edges` from here. For the supervisor, while `source` is not the encoder. */
void lw_motion_begin_pattern(struct lw_motion *motion);

/** Choose which edges move the carriage. For the supervisor. */
void lw_motion_set_source(struct lw_motion *motion, enum lw_edge_source source);

/** Set the resting law's window, position and slope, both Q16.16. While `source` is NONE. */
void lw_motion_set_position(struct lw_motion *motion, const struct lw_law_window *window, int32_t m,
			    int32_t u);

/**
 * Is the law what its window says, with the window's slope in the sweep? For the supervisor, where
 * the law follows the drum and no request waits.
 */
bool lw_motion_is_sound(const struct lw_motion *motion);

/**
 * Make the law what a window says, with the place, slope and dwell that it has: its slope in the
 * sweep becomes the window's. An edge meanwhile is not followed. For the supervisor.
 */
void lw_motion_mend(struct lw_motion *motion, const struct lw_law_window *window);

/** Hand over what the `request_*` fields say: enum lw_motion_request, or-ed. For the supervisor. */
void lw_motion_request(struct lw_motion *motion, uint8_t requests);

/** Block the steps toward a side, or let them go. For the overtravel interrupt. */
void lw_motion_block(struct lw_motion *motion, enum lw_motion_side_bit side_bit, bool blocked);

/**
 * Take the sides (enum lw_motion_side_bit, or-ed) toward which steps were withheld since the last
 * call: one is enough to put the carriage out of step. For the supervisor.
 */
uint8_t lw_motion_take_withheld(struct lw_motion *motion);

/**
 * Has the slope changed in the reversal at a side since the last call? For the supervisor.
 *
 * Between two calls the carriage is not expected at both sides: then the later one counts.
 */
bool lw_motion_take_turned(struct lw_motion *motion, enum lw_motion_side_bit side_bit);

/** Take a forward drum edge whatever there is to do, as lw_motion_edge(). */
int lw_motion_long_forward(struct lw_motion *motion);

/** Take a backward drum edge, likewise. Two, so that a cam's edge need not ask which it is. */
int lw_motion_long_backward(struct lw_motion *motion);

/**
 * Take one drum edge that `edges` has already counted. For the encoder interrupt.
 *
 * @param dd +1 or -1
 * @return the steps to give: +1, 0 or -1; up to LW_CAM_STEPS_PER_EDGE_MAX either way by a cam
 */
LW_EDGE_INLINE int lw_motion_edge(struct lw_motion *motion, int dd)
{
	const int step = lw_law_short_edge(&motion->law, motion->law.open_span, dd);

	if (step == LW_LAW_CLOSED) {
		return dd > 0 ? lw_motion_long_forward(motion) : lw_motion_long_backward(motion);
	}
	if (step != 0) {
		motion->steps++;
		motion->last_step = step;
	}
	return step;
}

/**
 * Count and take one drum edge. For the encoder interrupt.
 *
 * @param dd +1 or -1
 * @return as lw_motion_edge()
 */
LW_EDGE_INLINE int lw_motion_encoder_edge(struct lw_motion *motion, int dd)
{
	motion->edges += (uint32_t)dd;
	return lw_motion_edge(motion, dd);
}

/**
 * Count and take drum edges one way together, as lw_motion_encoder_edge() would one by one, where
 * that is possible: in the sweep, or where no edge moves the carriage. For the encoder interrupt.
 *
 * @param edges positive forward, negative backward; not 0
 * @param steps receives the steps to give, net
 * @return false: they must be taken one by one; nothing was done
 */
LW_EDGE_INLINE bool lw_motion_encoder_edges(struct lw_motion *motion, int32_t edges, int32_t *steps)
{
	*steps = 0;
	if (lw_law_short_edges(&motion->law, edges, steps)) {
		motion->edges += (uint32_t)edges;
		if (*steps != 0) {
			motion->steps += (uint32_t)(*steps > 0 ? *steps : -*steps);
			motion->last_step = *steps > 0 ? 1 : -1;
		}
		return true;
	}
	if (motion->law.open_span != 0 || motion->source == LW_EDGE_SOURCE_ENCODER) {
		return false;
	}
	motion->edges += (uint32_t)edges;
	motion->unfollowed_edges += (uint32_t)edges;
	return true;
}

/** So many edges at once are taken where none of them moves the carriage. */
#define LW_MOTION_IDLE_EDGES 64

/**
 * As lw_law_edges_to_step(), where it is known whether edges move the carriage. For the encoder
 * interrupt.
 */
LW_EDGE_INLINE uint32_t lw_motion_edges_to_step(const struct lw_motion *motion, int dd)
{
	return motion->law.open_span == 0 && motion->source != LW_EDGE_SOURCE_ENCODER
		       ? LW_MOTION_IDLE_EDGES
		       : lw_law_edges_to_step(&motion->law, dd);
}

/**
 * Take one simulated forward edge. For the edge-timer interrupt.
 *
 * @return the step to give: +1, 0 or -1
 */
int lw_motion_timer_edge(struct lw_motion *motion);

#endif /* LW_MOTION_H */
