/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Rope that is hauled in while the carriage does not follow lies in one heap. How much of it there
 * is on the drum, since somebody has last looked at it.
 *
 * The drum is a stack of turns: hauling in puts one on, paying out takes the topmost off. So what
 * is laid while the carriage stands is counted above the lowest place that the drum has been at
 * since then. A drum that rocks does not count up, rope that is paid out again does not count, and
 * hauling in what was paid out does.
 *
 * Not for interrupt context.
 */
#ifndef LW_ROPE_WATCH_H
#define LW_ROPE_WATCH_H

#include <stdbool.h>
#include <stdint.h>

/** State. All zero: nothing laid. */
struct lw_rope_watch {
	/* What lw_rope_watch_acknowledge() clears. */
	bool set;               /**< sticky: enough was laid */
	bool indexed_since;     /**< an indexing has succeeded since the last of it */
	bool before_power_up;   /**< it was so when the controller powered up */
	bool place_known;       /**< `position_q16` was known, and not only what was left of it */
	int32_t position_q16;   /**< carriage when the first of it was laid, Q16.16 microsteps */
	uint32_t time_ms;       /**< when, since power-up, of that power-up */
	uint32_t laid_millirev; /**< drum turns, without those of the present stand */

	/* The present stand. */
	int64_t edges;     /**< odometer at the last tick */
	bool following;    /**< the carriage followed at the last tick */
	int64_t on_edges;  /**< laid and still on the drum */
	int64_t top_edges; /**< most that it has been; 0 while it is too little to tell */

	/* The carriage's last known place. */
	bool last_known;
	int32_t last_q16;
};

/** What a tick looks at. */
struct lw_rope_watch_inputs {
	bool following; /**< the drum moves the carriage */
	bool intended;  /**< it stands because the mode says so */
	bool known;     /**< the carriage's place is known */
	bool moved;     /**< the carriage moves otherwise, or has no current: its place gets lost */
	int32_t position_q16;
	int64_t net_edges; /**< odometer, hauling in counts up */
	/** Edges from which on it is told; 0: not watched. */
	int64_t threshold_edges;
	uint32_t edges_per_1000_drum_revs;
	uint64_t now_us;
};

/** Look at the drum. Call it every tick. */
void lw_rope_watch_tick(struct lw_rope_watch *watch, const struct lw_rope_watch_inputs *inputs);

/**
 * End the present stand: its turns go to the account. Before another encoder is configured.
 *
 * @param edges_per_1000_drum_revs that its edges are counted by
 */
void lw_rope_watch_settle(struct lw_rope_watch *watch, uint32_t edges_per_1000_drum_revs);

/** Drum turns laid while the carriage stood, in thousandths; 0 while it is not set. */
uint32_t lw_rope_watch_millirev(const struct lw_rope_watch *watch,
				uint32_t edges_per_1000_drum_revs);

/** Somebody has looked at the rope: forget what was laid. */
void lw_rope_watch_acknowledge(struct lw_rope_watch *watch);

#endif /* LW_ROPE_WATCH_H */
