/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The electronic cam: slave position as a pure function of net encoder edges, by the rows of a
 * table (lw/cam/cam_table.h), exact and the same in both directions.
 *
 * The position is floor(x + 1/2) of a rational x that is a polynomial of first or second degree
 * within each piece of a row (the whole row if linear; ramp, plateau, ramp if trapezoid). Inside
 * a piece an edge adds the polynomial's difference to an exact numerator; an edge into another
 * piece evaluates that piece anew. No division, no rounding that is carried on: doc/cam.md.
 */
#ifndef LW_CAM_H
#define LW_CAM_H

#include <stdint.h>

#include "lw/cam/cam_table.h"

/**
 * State. Every field but `table` and `scale` is a function of the net edges since the start.
 *
 * `at` and the bounds of the piece count ticks from the row's begin: one master unit is
 * `scale.edges * scale.ramp_divisor` ticks, so that an edge is a whole number of them, the same
 * for every row, and a ramp ends at a whole one.
 */
struct lw_cam {
	int64_t remainder; /**< (x + 1/2 - pos) * den, 0 <= remainder < den */
	int64_t den;       /**< denominator of this row */
	int64_t slope;     /**< what the next forward edge in this piece adds to the numerator */
	int64_t curve;     /**< what such an edge adds to `slope` */
	uint32_t at;
	uint32_t piece_begin;
	uint32_t piece_end; /**< first `at` past the piece */
	uint32_t stride;    /**< ticks of one edge */
	int64_t pos_usteps;
	int64_t offset; /**< slave units added to the table: advance of the cycles, start */
	uint16_t row;   /**< index of the row that the piece begins at */
	int32_t cycles; /**< net cycles since the start */
	const struct lw_cam_table *table;
	struct lw_cam_scale scale;
};

/**
 * Start somewhere in a cycle. Not for interrupt context: it divides.
 *
 * @param table accepted by lw_cam_table_check() with this scale
 * @param edges net encoder edges since the begin of cycle 0, of either sign, below 2^48; cycles
 *        below 2^31
 * @param offset slave units to add to the table
 */
void lw_cam_start(struct lw_cam *cam, const struct lw_cam_table *table,
		  const struct lw_cam_scale *scale, int64_t edges, int64_t offset);

/**
 * Take one edge. For the edge interrupt.
 *
 * @param dd +1 forward or -1 backward
 * @param next table to go on with from the cycle's boundary, or NULL. The slave stands at the
 *        boundary where the old table left it. Must be accepted with the same scale.
 * @return steps to give, -LW_CAM_STEPS_PER_EDGE_MAX to LW_CAM_STEPS_PER_EDGE_MAX
 */
int lw_cam_edge(struct lw_cam *cam, int dd, const struct lw_cam_table *next);

/**
 * Count cycles, advance and slave position from the begin of a cycle that the last edge has passed.
 * For the edge interrupt.
 *
 * @param dd direction of that edge
 * @param pos_usteps near the first row's slave position
 * @return steps from there to where the slave is now
 */
int lw_cam_begin(struct lw_cam *cam, int dd, int64_t pos_usteps);

#endif /* LW_CAM_H */
