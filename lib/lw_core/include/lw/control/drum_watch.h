/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The drum watch: does what the encoder tells fit a drum?
 *
 * A channel that changes twice while the other one stands has rocked about one edge, or the other
 * one is dead: the signal is the same. So the watch has two steps. More of such changes than
 * encoder_watch_transitions_per_s make the encoder doubtful, which passes. If the doubt goes on for
 * encoder_watch_ms, or the master says that the drum turns, or index pulses come a revolution
 * apart, it is a fault, which stays. So it is at once if the drum was fast just before, or is just
 * after: no drum stops or starts from one block to the next, and what it turned meanwhile is lost.
 * Index pulses that the edges do not explain, and too many
 * transitions of both channels at once, are a fault without a doubt before.
 *
 * Called by the supervisor. No field is written by an interrupt.
 */
#ifndef LW_DRUM_WATCH_H
#define LW_DRUM_WATCH_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/control/params.h"
#include "lw/map.h"
#include "lw/motion/encoder_index.h"
#include "lw/motion/quadrature.h"

/** Changes are counted over so long, and then anew. */
#define LW_DRUM_WATCH_BLOCK_US 20000

/** The doubt passes so long after the last change that gave reason for it. */
#define LW_DRUM_WATCH_HOLD_US 30000

/** What the encoder has told: counters modulo 2^32. */
struct lw_drum_watch_counts {
	uint32_t edges;          /**< odometer, low half */
	uint32_t odd_changes[2]; /**< by enum lw_quadrature_channel */
	uint32_t illegal_transitions;
	uint32_t index_pulses;
};

/** State. Written by lw_drum_watch_tick() unless a comment says else. */
struct lw_drum_watch {
	bool doubtful;   /**< one channel changes without the other */
	uint16_t doubts; /**< how often it became so, since power-up */
	/** Sticky; taken back by lw_drum_watch_indexed(). */
	enum lw_encoder_fault fault;
	bool running;        /**< the master's word; written by the owner */
	bool fault_anew;     /**< met since the last indexing began; taken back when one begins */
	int32_t misfit_base; /**< encoder_index's misfit_edges at the last indexing */

	struct lw_drum_watch_counts seen; /**< at the last tick */
	uint64_t doubt_since_us;
	uint64_t doubt_us; /**< last reason for it */
	uint64_t block_us; /**< begin of the present block */
	int32_t lone[2];   /**< in it: changes of a channel that no motion explains */
	uint32_t odd[2];   /**< in it: odd changes of a channel, explained or not */
	bool turning;      /**< in it: the drum has gone on */
	int32_t moved[2];  /**< edges that it went on, either way: in it and in the one before */
	/** The dead channel or the rocking one that was last seen; NONE: none lately. */
	enum lw_encoder_fault still;
	int32_t before;        /**< edges of the last block without odd changes */
	int32_t hidden;        /**< changes since then that may stand for as many hidden edges */
	int32_t missing;       /**< edges since then, compared with the speed before */
	uint8_t hiding;        /**< blocks since then, the first few */
	int32_t still_lone[2]; /**< `lone`, since the drum last went on */
	uint64_t still_us;     /**< when they last were enough for a doubt */
	int32_t moved_after;   /**< edges that it went on since then */
	int32_t rocked;        /**< edges that the drum is ahead of where it surely went on to */
	uint32_t illegal;      /**< of the present thousand transitions */
	uint32_t transitions;
	int64_t pulse_lone[2]; /**< `lone`, since the last index pulse */
	int64_t pulse_edges;   /**< edges that it went on since then */
	uint8_t pulses_alone;  /**< index pulses in a row that came without the edges between */
	uint64_t stood_since_us;
};

/** Begin with the counters as they are. */
void lw_drum_watch_init(struct lw_drum_watch *watch, const struct lw_quadrature *quadrature,
			uint64_t now_us);

/**
 * Compare what the encoder has told since the last tick.
 *
 * @param edges odometer, low half
 * @param tolerance_edges index pulses may contradict the edges by so many
 * @param running the drum turns, says a master who is heard
 */
void lw_drum_watch_tick(struct lw_drum_watch *watch, const struct lw_params *params,
			const struct lw_quadrature *quadrature,
			const struct lw_encoder_index *index, uint32_t edges,
			int32_t tolerance_edges, bool running, uint64_t now_us);

/** An indexing begins: what is met from here on, it does not take back. */
void lw_drum_watch_index_begins(struct lw_drum_watch *watch);

/** An indexing has succeeded. @return it takes a fault back */
bool lw_drum_watch_indexed(struct lw_drum_watch *watch, const struct lw_encoder_index *index);

#endif /* LW_DRUM_WATCH_H */
