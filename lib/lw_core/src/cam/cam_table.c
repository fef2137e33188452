/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/cam/cam_table.h"

#include <errno.h>
#include <stdbool.h>

static void reduce(int32_t *a, int32_t *b)
{
	int32_t divisor = *a;
	int32_t remainder = *b;

	while (remainder != 0) {
		const int32_t next = divisor % remainder;

		divisor = remainder;
		remainder = next;
	}
	*a /= divisor;
	*b /= divisor;
}

struct lw_cam_scale lw_cam_scale(int32_t edges, int32_t master_units, int32_t usteps,
				 int32_t slave_units, int32_t ramp_divisor)
{
	struct lw_cam_scale scale = {
		.edges = edges,
		.master_units = master_units,
		.usteps = usteps,
		.slave_units = slave_units,
		.ramp_divisor = ramp_divisor,
	};

	reduce(&scale.edges, &scale.master_units);
	reduce(&scale.usteps, &scale.slave_units);
	return scale;
}

/** num / den in thousandths, rounded up; both at least 0. */
static int64_t permille(int64_t num, int64_t den)
{
	return num / den * 1000 + (num % den * 1000 + den - 1) / den;
}

/** Position of a row, rounded as the interrupt does. */
static int32_t row_usteps(const struct lw_cam_row *row, const struct lw_cam_scale *scale)
{
	const int64_t num = 2 * (int64_t)scale->usteps * row->slave + scale->slave_units;
	const int64_t den = 2 * (int64_t)scale->slave_units;

	return lw_clamp32(num / den - (num % den < 0));
}

static void note_position(struct lw_cam_statistics *statistics, int32_t usteps)
{
	if (usteps < statistics->min_usteps) {
		statistics->min_usteps = usteps;
	}
	if (usteps > statistics->max_usteps) {
		statistics->max_usteps = usteps;
	}
}

/** The way from a row to the next. `number` counts from 1. */
static int check_row(const struct lw_cam_table *table, unsigned int number,
		     const struct lw_cam_scale *scale, const struct lw_cam_limits *limits,
		     struct lw_cam_statistics *statistics, struct lw_cam_refusal *why)
{
	const struct lw_cam_row *row = &table->rows[number - 1];
	const int64_t length = (int64_t)row[1].master - row[0].master;

	if (length <= 0) {
		return lw_cam_refuse(why, LW_REASON_CAM_MASTER_NOT_ASCENDING, number + 1,
				     row[1].master, (int64_t)row[0].master + 1);
	}

	const int64_t ramp = length * scale->edges;
	const int64_t ticks = ramp * scale->ramp_divisor;
	const int64_t stride = (int64_t)scale->master_units * scale->ramp_divisor;

	if (ticks < stride) {
		return lw_cam_refuse(why, LW_REASON_CAM_ROW_TOO_SHORT, number, length,
				     (scale->master_units + scale->edges - 1) / scale->edges);
	}

	/*
	 * Every numerator of the interrupt is below `bound` times the row's ticks, squared if it is
	 * a trapezoid; a quarter of the range of 64 bits leaves room for their sums.
	 */
	const bool trapezoid = table->interpolation == LW_CAM_INTERPOLATION_TRAPEZOID;
	const int64_t slaves = (int64_t)row[1].slave - row[0].slave;
	const int64_t way = scale->usteps * (slaves < 0 ? -slaves : slaves);
	const int64_t bound = 4 * way + 10 * (int64_t)scale->slave_units;
	const int64_t room = INT64_MAX / 2 / bound;
	const int64_t ticks_max = trapezoid ? lw_integer_sqrt(room) : room;

	if (ticks > ticks_max || ticks > INT32_MAX) {
		return lw_cam_refuse(why, LW_REASON_CAM_ROW_TOO_LARGE, number, length,
				     (ticks_max < INT32_MAX ? ticks_max : INT32_MAX) /
					     (scale->edges * scale->ramp_divisor));
	}

	/* Steps per edge where it is steepest: on the plateau of a trapezoid. */
	const int64_t num = way * stride;
	const int64_t den = scale->slave_units * (trapezoid ? ticks - ramp : ticks);
	const int64_t slope_permille = permille(num, den);
	const int64_t steps_per_s = slope_permille * limits->top_edges_per_s / 1000;

	if (num > LW_CAM_STEPS_PER_EDGE_MAX * den) {
		return lw_cam_refuse(why, LW_REASON_CAM_SLOPE, number, slope_permille,
				     LW_CAM_STEPS_PER_EDGE_MAX * 1000);
	}
	if (steps_per_s > limits->steps_per_s_max) {
		return lw_cam_refuse(why, LW_REASON_CAM_STEP_RATE, number, steps_per_s,
				     limits->steps_per_s_max);
	}
	if (slope_permille > statistics->slope_max_permille) {
		statistics->slope_max_permille = (uint32_t)slope_permille;
		statistics->slope_max_row = (uint16_t)number;
	}
	note_position(statistics, row_usteps(&row[1], scale));
	return 0;
}

int lw_cam_table_check(const struct lw_cam_table *table, const struct lw_cam_scale *scale,
		       const struct lw_cam_limits *limits, struct lw_cam_statistics *statistics,
		       struct lw_cam_refusal *why)
{
	struct lw_cam_statistics found = {.slope_max_row = 1};
	const unsigned int count = table->row_count;

	if (table->interpolation > LW_CAM_INTERPOLATION_TRAPEZOID) {
		return lw_cam_refuse(why, LW_REASON_CAM_INTERPOLATION, 0, table->interpolation,
				     LW_CAM_INTERPOLATION_TRAPEZOID);
	}
	if (count < 2) {
		return lw_cam_refuse(why, LW_REASON_CAM_TOO_FEW_ROWS, count, count, 2);
	}
	if (count > LW_CAM_ROWS_MAX) {
		return lw_cam_refuse(why, LW_REASON_CAM_TOO_MANY_ROWS, LW_CAM_ROWS_MAX + 1, count,
				     LW_CAM_ROWS_MAX);
	}
	if (table->rows[0].master != 0) {
		return lw_cam_refuse(why, LW_REASON_CAM_FIRST_MASTER, 1, table->rows[0].master, 0);
	}
	found.min_usteps = row_usteps(&table->rows[0], scale);
	found.max_usteps = found.min_usteps;
	for (unsigned int number = 1; number < count; number++) {
		const int ret = check_row(table, number, scale, limits, &found, why);

		if (ret) {
			return ret;
		}
	}

	const struct lw_cam_row *last = &table->rows[count - 1];
	const int64_t cycle = (int64_t)last->master * scale->edges;
	const int64_t advance = (int64_t)last->slave - table->rows[0].slave;

	if (cycle > INT32_MAX) {
		return lw_cam_refuse(why, LW_REASON_CAM_CYCLE_TOO_LONG, count, last->master,
				     INT32_MAX / scale->edges);
	}
	if (advance != table->advance) {
		return lw_cam_refuse(why, LW_REASON_CAM_WRAP, count, advance, table->advance);
	}
	found.cycle_edges = (uint32_t)(cycle / scale->master_units);
	*statistics = found;
	return 0;
}
