/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The cam table: rows of master and slave positions, how to go from one to the next, and the check
 * that makes a table fit for the interrupt. doc/cam.md has the formulas. Not for interrupt context.
 */
#ifndef LW_CAM_TABLE_H
#define LW_CAM_TABLE_H

#include <errno.h>
#include <stddef.h>
#include <stdint.h>

#include "lw/bytes/numbers.h"
#include "lw/map.h"

enum {
	LW_CAM_ROWS_MAX = 256,
	LW_CAM_NAME_SIZE = 16,
	/** Most steps that one edge may ask for. */
	LW_CAM_STEPS_PER_EDGE_MAX = 4,
};

/** Where the slave is when the master is there. */
struct lw_cam_row {
	int32_t master; /**< master units, ascending, 0 in the first row */
	int32_t slave;  /**< slave units */
};

/** A table. The last row's master is the length of a cycle. */
struct lw_cam_table {
	char name[LW_CAM_NAME_SIZE]; /**< for people; not terminated if it fills the field */
	uint32_t version;            /**< for people */
	uint16_t interpolation;      /**< enum lw_cam_interpolation */
	uint16_t row_count;
	int32_t advance; /**< slave units that a cycle adds; 0: cyclic */
	struct lw_cam_row rows[LW_CAM_ROWS_MAX];
};

/**
 * How tables are followed, whichever is in force: from table units to the machine's as exact
 * fractions in lowest terms (`edges` encoder edges are `master_units`, `usteps` microsteps are
 * `slave_units`), and the ramps of trapezoid rows. Made by lw_cam_scale().
 */
struct lw_cam_scale {
	int32_t edges;
	int32_t master_units;
	int32_t usteps;
	int32_t slave_units;
	int32_t ramp_divisor; /**< each ramp is 1 / ramp_divisor of its row */
};

/** What the machine can follow. */
struct lw_cam_limits {
	uint32_t top_edges_per_s;
	uint32_t steps_per_s_max;
};

/** What a refused table did wrong. */
struct lw_cam_refusal {
	uint16_t reason; /**< enum lw_reason */
	uint16_t row;    /**< counted from 1; 0: no single row is to blame */
	int32_t value;   /**< offending value, in the unit that the reason's text names */
	int32_t limit;   /**< the limit that it broke */
};

/**
 * Note a refusal. Value and limit are cut to 32 bit.
 *
 * @return -EINVAL
 */
static inline int lw_cam_refuse(struct lw_cam_refusal *why, enum lw_reason reason, unsigned int row,
				int64_t value, int64_t limit)
{
	*why = (struct lw_cam_refusal){
		.reason = (uint16_t)reason,
		.row = (uint16_t)row,
		.value = lw_clamp32(value),
		.limit = lw_clamp32(limit),
	};
	return -EINVAL;
}

/** Numbers about an accepted table. Slopes in microsteps per 1000 edges, rounded up. */
struct lw_cam_statistics {
	uint32_t cycle_edges; /**< edges of a cycle, rounded down */
	int32_t min_usteps;   /**< positions of the rows, rounded as the interrupt does */
	int32_t max_usteps;
	uint32_t slope_max_permille; /**< of any edge, ramps included */
	uint16_t slope_max_row;      /**< row that it begins at, from 1 */
};

/** The scale in lowest terms. Each part of a fraction 1..10000, ramp_divisor 2..100. */
struct lw_cam_scale lw_cam_scale(int32_t edges, int32_t master_units, int32_t usteps,
				 int32_t slave_units, int32_t ramp_divisor);

/**
 * Check a whole table: rows ascending, every row at least one edge long and small enough for the
 * interrupt's 64-bit numerators, at most LW_CAM_STEPS_PER_EDGE_MAX steps per edge and
 * `steps_per_s_max` at `top_edges_per_s`, and last minus first slave equal to `advance`.
 *
 * @param scale as made by lw_cam_scale()
 * @param statistics receives numbers if accepted
 * @param why receives reason, row, value and limit if refused
 * @retval 0 accepted
 * @retval -EINVAL refused
 */
int lw_cam_table_check(const struct lw_cam_table *table, const struct lw_cam_scale *scale,
		       const struct lw_cam_limits *limits, struct lw_cam_statistics *statistics,
		       struct lw_cam_refusal *why);

#endif /* LW_CAM_TABLE_H */
