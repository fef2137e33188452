/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * How fast the drum turns, over the last ticks, and whether it rests. Called by the supervisor; no
 * field is written by an interrupt.
 */
#ifndef LW_DRUM_SPEED_H
#define LW_DRUM_SPEED_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/map.h"

/** Ticks over which the drum speed is measured. */
#define LW_DRUM_SPEED_TICKS 64

/** Ticks that tell which way the drum turns just now. */
#define LW_DRUM_SPEED_LATELY_TICKS 3

/** State. Written by drum_speed.c alone. */
struct lw_drum_speed {
	uint32_t history_edges[LW_DRUM_SPEED_TICKS]; /**< odometer, low half */
	uint32_t history_us[LW_DRUM_SPEED_TICKS];    /**< when, low half: ticks may be late */
	uint8_t next;
	uint64_t rest_since_us; /**< the drum is slow since then */
	int32_t edges_per_s;    /**< read by status and journal */
	bool at_rest;           /**< read by whoever begins a move or a write */
};

/** Begin: nothing is known, so the drum does not rest yet. */
void lw_drum_speed_init(struct lw_drum_speed *speed, uint64_t now_us);

/**
 * Measure. Every tick.
 *
 * @param edges odometer, low half
 * @param may_turn_unseen the encoder is doubtful, or the master says that the drum turns
 */
void lw_drum_speed_tick(struct lw_drum_speed *speed, const struct lw_params *params, uint32_t edges,
			bool may_turn_unseen, uint64_t now_us);

/** Edges of the last ticks, net. @param edges odometer, low half, now. Interrupt safe. */
static inline int32_t lw_drum_speed_lately_edges(const struct lw_drum_speed *speed, uint32_t edges)
{
	const uint32_t then =
		speed->next + (uint32_t)LW_DRUM_SPEED_TICKS - LW_DRUM_SPEED_LATELY_TICKS;

	return (int32_t)(edges - speed->history_edges[then % LW_DRUM_SPEED_TICKS]);
}

/** Is the drum faster than this, either way? */
bool lw_drum_speed_exceeds(const struct lw_drum_speed *speed, uint32_t limit_edges_per_s);

#endif /* LW_DRUM_SPEED_H */
