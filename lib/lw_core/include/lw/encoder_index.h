/**
 * @file
 * The encoder's index pulse (Z), once per revolution: a check that no edge was missed.
 *
 * Between two pulses that were met in the same direction lies a whole number of revolutions. What
 * is missing or too many was missed: by a bad cable, or by an interrupt that came too late. Two
 * pulses with no revolution between them tell no direction and are not compared.
 */
#ifndef LW_ENCODER_INDEX_H
#define LW_ENCODER_INDEX_H

#include <stdbool.h>
#include <stdint.h>

/** State. Written by the index interrupt unless a comment says else. */
struct lw_encoder_index {
	int32_t edges_per_rev;   /**< used edges; written by the supervisor */
	uint32_t pulses;         /**< since power-up */
	uint32_t missed_edges;   /**< since power-up */
	uint32_t last_edges;     /**< count at the last pulse */
	uint32_t reference[2];   /**< count at some pulse met forward [0], backward [1] */
	bool last_known;         /**< taken back by the supervisor */
	bool reference_known[2]; /**< taken back by the supervisor */
};

/** Start, or start anew after a change of the encoder's settings: the counters go on. */
void lw_encoder_index_configure(struct lw_encoder_index *index, int32_t edges_per_rev);

/**
 * Take the beginning of an index pulse. For its interrupt.
 *
 * @param net_edges the odometer, its low half
 */
void lw_encoder_index_pulse(struct lw_encoder_index *index, uint32_t net_edges);

#endif /* LW_ENCODER_INDEX_H */
