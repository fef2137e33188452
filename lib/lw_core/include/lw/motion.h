/**
 * @file
 * The motion of the carriage as the edge interrupts see it: which edges move it, the law, and the
 * few changes that the supervisor may ask for while it runs.
 *
 * Ownership: the edge interrupt (encoder or edge timer, never both at once) writes every field
 * unless its comment says else. The supervisor hands work to it through the `request_*` fields,
 * which it fills before it sets `requests`, and leaves alone until the interrupt has cleared the
 * bit; while `source` is LW_EDGE_SOURCE_NONE the law is idle and the supervisor may write `law` and
 * `window` itself. The three fields of this hand-over are atomic: an access to one of them also
 * keeps the accesses before and after it in order.
 */
#ifndef LW_MOTION_H
#define LW_MOTION_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

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

/** Bits for the two sides, in `blocked`, `reached` and `stop_at_rest`. */
enum lw_motion_side_bit {
	LW_MOTION_PLUS = 1 << 0,
	LW_MOTION_MINUS = 1 << 1,
};

/** State of the motion. */
struct lw_motion {
	struct lw_law law;
	const struct lw_law_window *window;
	uint32_t interrupts;   /**< edges of either source; see lw_motion_read() */
	int64_t net_edges;     /**< odometer: all drum edges */
	int64_t pattern_edges; /**< drum edges followed since the last hand-over */
	uint32_t steps;        /**< step pulses given */
	int8_t last_dd;        /**< direction of the last edge that moved the law */
	/** lw_motion_side_bit: edges taken inside a reversal; the supervisor clears what it has
	 *  seen. */
	_Atomic uint8_t reached;
	uint8_t stop_at_rest; /**< lw_motion_side_bit: timer edges stop where the slope is 0 in
			       *   the reversal at that side; written by the supervisor */
	uint8_t blocked;      /**< lw_motion_side_bit: no steps that way (overtravel); written by
			       *   the overtravel interrupt */
	/** enum lw_edge_source; written by the supervisor, and set to NONE by the interrupt when
	 *  stop_at_rest is met. */
	_Atomic uint8_t source;
	_Atomic uint8_t requests; /**< enum lw_motion_request; set by the supervisor */
	const struct lw_law_window *request_window; /**< written by the supervisor */
	int32_t request_correction_usteps; /**< written by the supervisor; the interrupt counts it
					    *   down as it applies it */
};

/** Direction of the carriage: +1, -1, or 0 at the far point of a reversal. Interrupt safe. */
static inline int lw_motion_direction(const struct lw_motion *motion)
{
	const int slope_sign = (motion->law.u > 0) - (motion->law.u < 0);

	return motion->last_dd < 0 ? -slope_sign : slope_sign;
}

/** True if the position lies in the sweep of the window in force. Interrupt safe. */
static inline bool lw_motion_in_sweep(const struct lw_motion *motion)
{
	return lw_law_region(motion->window, motion->law.m) == 0;
}

/** What the edge interrupt changes, all of one moment. */
struct lw_motion_reading {
	struct lw_law law;
	int64_t net_edges;
	int64_t pattern_edges;
	uint32_t steps;
};

/** Read what the edge interrupt changes. For anything that the interrupt may interrupt. */
struct lw_motion_reading lw_motion_read(const struct lw_motion *motion);

/** Start with nothing moving at position 0. */
void lw_motion_init(struct lw_motion *motion, const struct lw_law_window *window);

/**
 * Take one drum edge. For the encoder interrupt.
 *
 * @param dd +1 or -1
 * @return the step to give: +1, 0 or -1
 */
int lw_motion_encoder_edge(struct lw_motion *motion, int dd);

/**
 * Take one simulated forward edge. For the edge-timer interrupt.
 *
 * @return the step to give: +1, 0 or -1
 */
int lw_motion_timer_edge(struct lw_motion *motion);

#endif /* LW_MOTION_H */
