/**
 * @file
 * The motion of the carriage as the edge interrupts see it: which edges move it, the law, and the
 * few changes that the supervisor may ask for while it runs.
 *
 * Ownership: the edge interrupt (encoder or edge timer, never both at once) writes every field
 * unless its comment says else. The supervisor hands work to it through the `request_*` fields,
 * which it fills before lw_motion_request(), and leaves alone until the interrupt has cleared the
 * bit; while `source` is LW_EDGE_SOURCE_NONE the law is idle and the supervisor may place it with
 * lw_motion_place(). The fields of this hand-over are atomic: an access to one of them also keeps
 * the accesses before and after it in order.
 *
 * A drum edge costs little because all that is unusual leaves the short way by one comparison:
 * whoever asks for something writes 0 to `law.open_span`, and then every edge goes the long way,
 * lw_motion_long_edge(), which restores it when nothing is left to do. Nothing that asks may
 * interrupt the edge interrupts. Edges that a cam takes go the long way too.
 */
#ifndef LW_MOTION_H
#define LW_MOTION_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "lw/cam_motion.h"
#include "lw/law.h"

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

/** Bits for the two sides, in `blocked` and `stop_at_rest`. */
enum lw_motion_side_bit {
	LW_MOTION_PLUS = 1 << 0,
	LW_MOTION_MINUS = 1 << 1,
};

/** State of the motion. */
struct lw_motion {
	struct lw_law law;
	uint32_t steps;    /**< step pulses given */
	int32_t last_step; /**< direction of the last of them, +1 or -1; 0: none yet */
	/** Odometer, net drum edges modulo 2^32. Written by who decodes, before the edge is taken:
	 *  the encoder interrupt, or a counter in hardware. */
	uint32_t edges;
	uint32_t unfollowed_edges; /**< those of them that did not move the carriage, net */
	const struct lw_law_window *window;
	uint8_t stop_at_rest; /**< lw_motion_side_bit: timer edges stop where the slope is 0 in
			       *   the reversal at that side; written by the supervisor */
	/** lw_motion_side_bit: no steps that way (overtravel); written by lw_motion_block(). */
	_Atomic uint8_t blocked;
	/** enum lw_edge_source; written by lw_motion_set_source(), and set to NONE by the interrupt
	 *  when stop_at_rest is met. */
	_Atomic uint8_t source;
	_Atomic uint8_t requests; /**< enum lw_motion_request; set by lw_motion_request() */
	const struct lw_law_window *request_window; /**< written by the supervisor */
	int32_t request_correction_usteps; /**< written by the supervisor; the interrupt counts it
					    *   down as it applies it; 0 when none waits */
	int32_t corrected_usteps;          /**< sum of what it has applied */
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
	return motion->law.u == 0 ? 0 : (int)motion->last_step;
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
void lw_motion_place(struct lw_motion *motion, const struct lw_law_window *window, int32_t m,
		     int32_t u);

/** Hand over what the `request_*` fields say: enum lw_motion_request, or-ed. For the supervisor. */
void lw_motion_request(struct lw_motion *motion, uint8_t requests);

/** Block the steps toward a side, or let them go. For the overtravel interrupt. */
void lw_motion_block(struct lw_motion *motion, enum lw_motion_side_bit side, bool blocked);

/**
 * Has the slope changed in the reversal at a side since the last call? For the supervisor.
 *
 * Between two calls the carriage is not expected at both sides: then the later one counts.
 */
bool lw_motion_take_turned(struct lw_motion *motion, enum lw_motion_side_bit side);

/** Take a drum edge whatever there is to do, as lw_motion_edge(). */
int lw_motion_long_edge(struct lw_motion *motion, int dd);

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
		return lw_motion_long_edge(motion, dd);
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
 * Take one simulated forward edge. For the edge-timer interrupt.
 *
 * @return the step to give: +1, 0 or -1
 */
int lw_motion_timer_edge(struct lw_motion *motion);

#endif /* LW_MOTION_H */
