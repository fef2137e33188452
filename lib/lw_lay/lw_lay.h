/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * How rope lies on a drum: a height field, and the law's pattern laid on it.
 *
 * A crude model: a rigid round rope, no settling, the drum unrolled. The rope's centre comes to
 * rest where its underside first touches what lies there; what it covers rises to its upper side.
 * It compares patterns. Its millimetres are not those of a real drum, where rope beds in.
 * doc/rope.md says what it is good for.
 *
 * Host code, for the laptop tool: floating point, nothing for an interrupt.
 */
#ifndef LW_LAY_H
#define LW_LAY_H

#include <stddef.h>
#include <stdint.h>

#include "lw/control/params.h"

/** Drum angles of the grid: every 5 degrees. */
#define LW_LAY_ANGLES         72
/** Columns of the grid per millimetre across the drum. */
#define LW_LAY_COLUMNS_PER_MM 4
/** Thickest rope, micrometres, as of the parameter rope_diameter_um. */
#define LW_LAY_ROPE_UM_MAX    100000
/** Columns that a rope may cover. */
#define LW_LAY_FOOTPRINT_MAX  (LW_LAY_ROPE_UM_MAX / 1000 * LW_LAY_COLUMNS_PER_MM + 1)

/** The drum's surface. Column c lies at (first_column + c) / LW_LAY_COLUMNS_PER_MM millimetres. */
struct lw_lay_field {
	float *height_mm;     /**< above the bare drum, a row of `columns` for each angle */
	int32_t first_column; /**< of the grid whose column 0 is at position 0 */
	int32_t columns;      /**< 1 or more */
	int32_t half;         /**< columns that the rope covers on each side of its centre */
	float rise_mm[LW_LAY_FOOTPRINT_MAX]; /**< of its round side above its centre, by column */
};

/** How even the surface is, millimetres above the bare drum. */
struct lw_lay_evenness {
	double max_mm;
	double mean_mm;
	double std_mm; /**< of all places, not of a sample of them */
	double p5_mm;  /**< a twentieth of the surface lies lower; between two places in proportion
			*/
};

/** A pattern to lay: what lw_lay_prepare() makes of a parameter set. */
struct lw_lay_pattern {
	struct lw_law_window window;
	int32_t m;              /**< where the law starts, Q16.16: in the middle of the sweep */
	int32_t u;              /**< its slope there: toward plus */
	double mm_per_q16;      /**< carriage travel */
	double edges_per_angle; /**< encoder edges from one angle of the grid to the next */
	int32_t first_column;   /**< first column that rope can cover */
	int32_t columns;        /**< how many */
	int32_t first_judged;   /**< column of the minus far point, in the same grid */
	int32_t judged;         /**< from there to the plus far point: where rope is laid whole */
};

/**
 * A bare drum.
 *
 * @param height_mm LW_LAY_ANGLES * columns values, the caller's; set to 0
 * @param rope_um rope diameter
 * @retval 0 done
 * @retval -EINVAL no column, no memory or a diameter out of 1 to LW_LAY_ROPE_UM_MAX
 */
int lw_lay_bare(struct lw_lay_field *field, float *height_mm, int32_t first_column, int32_t columns,
		uint32_t rope_um);

/**
 * Lay rope on one angle of the drum.
 *
 * @param angle 0 to LW_LAY_ANGLES - 1
 * @param position_mm where its centre is across the drum; what is beyond the grid is left out
 * @return height of its centre above the bare drum, millimetres
 */
double lw_lay_rope(struct lw_lay_field *field, int angle, double position_mm);

/**
 * Lay rope along a path.
 *
 * @param position_mm across the drum at every angle of the grid, in order, from angle 0 on
 * @param centre_mm receives the height of the rope's centre at each of them, or NULL
 */
void lw_lay_path(struct lw_lay_field *field, const double *position_mm, size_t count,
		 double *centre_mm);

/**
 * Judge the columns from first on, of all angles.
 *
 * @param scratch as large as the field's heights; changed
 * @retval 0 done
 * @retval -EINVAL no such columns
 */
int lw_lay_judge(const struct lw_lay_field *field, int32_t first_column, int32_t columns,
		 float *scratch, struct lw_lay_evenness *evenness);

/**
 * The pattern of a parameter set.
 *
 * @param why receives reason, register, value and limit where the core refuses the set
 * @retval 0 done
 * @retval -EINVAL the set is refused
 * @retval -ERANGE the rope is thinner than 1 or thicker than LW_LAY_ROPE_UM_MAX micrometres
 */
int lw_lay_prepare(const struct lw_params *params, uint32_t rope_um, struct lw_lay_pattern *pattern,
		   struct lw_refusal *why);

/**
 * Where the compiled law has the carriage, hauling in from the pattern's start on.
 *
 * @param position_mm receives the position at every angle of the grid
 */
void lw_lay_positions(const struct lw_lay_pattern *pattern, double *position_mm, size_t count);

/**
 * How long double traverses are: edges from one far point at plus to the next.
 *
 * @param edges receives the lengths of the first `count`
 */
void lw_lay_double_traverses(const struct lw_lay_pattern *pattern, uint64_t *edges, size_t count);

#endif /* LW_LAY_H */
