/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What Python calls by ctypes. Reentrant: a search lays patterns in several threads.
 */
#include <errno.h>
#include <stdlib.h>

#include "lw_lay.h"

#include "lw/bytes/layout.h"

/** The grid that a pattern is laid on, and the part of it that is judged. */
struct lw_native_lay_grid {
	int32_t first_column;
	int32_t columns;
	int32_t first_judged;
	int32_t judged;
};

/** A parameter set is given as its values in the order of the map; all are 32 bit wide. */
static const struct lw_params *as_params(const int32_t *values)
{
	return (const struct lw_params *)values;
}

/** The grid of a parameter set; values returned as by lw_lay_prepare(). */
int lw_native_lay_grid(const int32_t *values, uint32_t rope_um, struct lw_native_lay_grid *grid,
		       struct lw_refusal *why)
{
	struct lw_lay_pattern pattern;
	const int ret = lw_lay_prepare(as_params(values), rope_um, &pattern, why);

	if (ret == 0) {
		*grid = (struct lw_native_lay_grid){
			.first_column = pattern.first_column,
			.columns = pattern.columns,
			.first_judged = pattern.first_judged,
			.judged = pattern.judged,
		};
	}
	return ret;
}

/**
 * Lay the pattern of a parameter set and judge it.
 *
 * @param count angles of the grid that rope is laid on, one after the other
 * @param position_mm receives where, `count` values, or NULL
 * @param centre_mm receives the height of the rope's centre there, or NULL
 * @param height_mm receives the field, LW_LAY_ANGLES * columns values of the grid, or NULL
 * @retval 0 done
 * @retval -ENOMEM no memory
 * @return else as lw_lay_prepare()
 */
int lw_native_lay(const int32_t *values, uint32_t rope_um, size_t count, double *position_mm,
		  double *centre_mm, float *height_mm, struct lw_lay_evenness *evenness,
		  struct lw_refusal *why)
{
	struct lw_lay_pattern pattern;
	struct lw_lay_field field;
	int ret = lw_lay_prepare(as_params(values), rope_um, &pattern, why);

	if (ret) {
		return ret;
	}

	const size_t cells = LW_LAY_ANGLES * (size_t)pattern.columns;
	double *own_path_mm = position_mm != NULL ? NULL : malloc(count * sizeof(*own_path_mm));
	float *own_height_mm = height_mm != NULL ? NULL : malloc(cells * sizeof(*own_height_mm));
	float *scratch = malloc(cells * sizeof(*scratch));
	double *path_mm = position_mm != NULL ? position_mm : own_path_mm;

	if (path_mm == NULL || scratch == NULL || (height_mm == NULL && own_height_mm == NULL)) {
		ret = -ENOMEM;
	} else {
		ret = lw_lay_bare(&field, height_mm != NULL ? height_mm : own_height_mm,
				  pattern.first_column, pattern.columns, rope_um);
	}
	if (ret == 0) {
		lw_lay_positions(&pattern, path_mm, count);
		lw_lay_path(&field, path_mm, count, centre_mm);
		ret = lw_lay_judge(&field, pattern.first_judged, pattern.judged, scratch, evenness);
	}
	free(own_path_mm);
	free(own_height_mm);
	free(scratch);
	return ret;
}

/** Lay rope along any path; parameters and values returned as by lw_lay_bare(), lw_lay_path(). */
int lw_native_lay_path(uint32_t rope_um, int32_t first_column, int32_t columns,
		       const double *position_mm, size_t count, double *centre_mm, float *height_mm)
{
	struct lw_lay_field field;
	const int ret = lw_lay_bare(&field, height_mm, first_column, columns, rope_um);

	if (ret == 0) {
		lw_lay_path(&field, position_mm, count, centre_mm);
	}
	return ret;
}

/** lw_lay_double_traverses() of a parameter set; values returned as by lw_params_derive(). */
int lw_native_double_traverses(const int32_t *values, uint64_t *edges, size_t count,
			       struct lw_refusal *why)
{
	struct lw_lay_pattern pattern;
	const int ret = lw_lay_prepare(as_params(values), 1, &pattern, why);

	if (ret == 0) {
		lw_lay_double_traverses(&pattern, edges, count);
	}
	return ret;
}

/** Layout of what Python copies. */
const struct lw_layout lw_layout_lay[] = {
	LW_LAYOUT_STRUCT(lw_lay_evenness),
	LW_LAYOUT_MEMBER(lw_lay_evenness, max_mm),
	LW_LAYOUT_MEMBER(lw_lay_evenness, mean_mm),
	LW_LAYOUT_MEMBER(lw_lay_evenness, std_mm),
	LW_LAYOUT_MEMBER(lw_lay_evenness, p5_mm),
	LW_LAYOUT_STRUCT(lw_native_lay_grid),
	LW_LAYOUT_MEMBER(lw_native_lay_grid, first_column),
	LW_LAYOUT_MEMBER(lw_native_lay_grid, columns),
	LW_LAYOUT_MEMBER(lw_native_lay_grid, first_judged),
	LW_LAYOUT_MEMBER(lw_native_lay_grid, judged),
	{0},
};
