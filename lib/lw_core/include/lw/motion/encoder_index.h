/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The encoder's index pulse (Z), once per revolution: a check that no edge was missed.
 *
 * Between two pulses that were met in the same direction lies a whole number of revolutions. What
 * is missing or too many was missed: by a bad cable, or by an interrupt that came too late. Two
 * pulses with no revolution between them tell no direction and are not compared, unless nothing
 * says that the drum has turned back: then a whole revolution is missing.
 */
#ifndef LW_ENCODER_INDEX_H
#define LW_ENCODER_INDEX_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/motion/quadrature.h"

/** State. Written by the index interrupt unless a comment says else. */
struct lw_encoder_index {
	int32_t edges_per_rev; /**< used edges; written by the supervisor */
	uint32_t rev_min_us;   /**< no revolution is shorter; written by the supervisor */
	uint32_t pulses;       /**< since power-up */
	uint32_t missed_edges; /**< since power-up */
	/** The same with their sign, net: positive are too many. Since power-up. */
	int32_t misfit_edges;
	int32_t misfit_before_edges; /**< `misfit_edges` at the pulse before the last one */
	uint32_t last_edges;         /**< count at the last pulse */
	uint32_t reference[2];       /**< count at some pulse met forward [0], backward [1] */
	uint32_t last_us;            /**< time of the last pulse, low half */
	uint32_t last_turns;         /**< the decoder's `turns` at the last pulse */
	uint32_t last_changes;       /**< its transitions off the short way then */
	int last_way;                /**< index of the reference last used */
	bool last_known;             /**< taken back by the supervisor, too */
	bool reference_known[2];     /**< taken back by the supervisor */
};

/**
 * Start, or start anew after a change of the encoder's settings: the counters go on.
 *
 * @param rev_min_us no revolution is shorter; pulses that come sooner are chatter
 */
void lw_encoder_index_configure(struct lw_encoder_index *index, int32_t edges_per_rev,
				uint32_t rev_min_us);

/**
 * Take the beginning of an index pulse. For its interrupt.
 *
 * @param net_edges the odometer, its low half
 * @param quadrature the decoder: has the drum turned back since the last pulse?
 * @param now_us low half, to a millisecond or so
 */
void lw_encoder_index_pulse(struct lw_encoder_index *index, uint32_t net_edges,
			    const struct lw_quadrature *quadrature, uint32_t now_us);

/**
 * Take the beginning of an index pulse of which nobody knows any more where it was, as after a time
 * without interrupts: it is counted, and the next one has none before it. For its interrupt.
 */
void lw_encoder_index_pulse_late(struct lw_encoder_index *index);

#endif /* LW_ENCODER_INDEX_H */
