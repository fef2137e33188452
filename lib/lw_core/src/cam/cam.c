/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/cam/cam.h"

#include <stddef.h>

/** Ticks of a ramp of the present row. */
static uint32_t ramp_ticks(const struct lw_cam *cam)
{
	const struct lw_cam_row *row = &cam->table->rows[cam->row];

	return (uint32_t)(row[1].master - row[0].master) * (uint32_t)cam->scale.edges;
}

static uint32_t row_ticks(const struct lw_cam *cam)
{
	return ramp_ticks(cam) * (uint32_t)cam->scale.ramp_divisor;
}

/**
 * Evaluate the piece that `row` and `at` lie in, relative to `pos_usteps`, which is near. Formulas:
 * doc/cam.md; lw_cam_table_check() sees to it that everything fits into 64 bits.
 */
static void enter_piece(struct lw_cam *cam)
{
	const struct lw_cam_row *row = &cam->table->rows[cam->row];
	const uint32_t ramp = ramp_ticks(cam);
	const uint32_t row_end = ramp * (uint32_t)cam->scale.ramp_divisor;
	const int64_t at = cam->at;
	const int64_t stride = cam->stride;
	const int64_t usteps = cam->scale.usteps;
	/* The slave's way through the row, and its begin, in 1 / (2 * slave_units) microsteps. */
	const int64_t way = usteps * ((int64_t)row[1].slave - row[0].slave);
	const int64_t begin = 2 * usteps * (row[0].slave + cam->offset) +
			      cam->scale.slave_units * (1 - 2 * cam->pos_usteps);
	int64_t scale;

	cam->piece_begin = 0;
	cam->piece_end = row_end;
	cam->curve = 0;
	if (cam->table->interpolation != LW_CAM_INTERPOLATION_TRAPEZOID) {
		scale = row_end;
		cam->slope = 2 * way * stride;
		cam->remainder = 2 * way * at;
	} else {
		scale = (int64_t)ramp * (row_end - ramp);
		if (cam->at < ramp) {
			cam->piece_end = ramp;
			cam->curve = 2 * way * stride * stride;
			cam->slope = way * stride * (2 * at + stride);
			cam->remainder = way * at * at;
		} else if (cam->at < row_end - ramp) {
			cam->piece_begin = ramp;
			cam->piece_end = row_end - ramp;
			cam->slope = 2 * way * ramp * stride;
			cam->remainder = way * ramp * (2 * at - ramp);
		} else {
			const int64_t left = (int64_t)row_end - at;

			cam->piece_begin = row_end - ramp;
			cam->curve = -2 * way * stride * stride;
			cam->slope = way * stride * (2 * left - stride);
			cam->remainder = way * (2 * scale - left * left);
		}
	}
	cam->remainder += begin * scale;
	cam->den = 2 * cam->scale.slave_units * scale;
}

/** Leave a cycle at its boundary, and go on with another table if there is one. */
static void leave_cycle(struct lw_cam *cam, uint16_t row, const struct lw_cam_table *next, int dd)
{
	cam->offset += cam->table->rows[row].slave;
	cam->cycles += dd;
	if (next != NULL) {
		cam->table = next;
	}
}

static void next_row(struct lw_cam *cam, const struct lw_cam_table *next)
{
	cam->at -= row_ticks(cam);
	cam->row++;
	if (cam->row + 1u == cam->table->row_count) {
		leave_cycle(cam, cam->row, next, 1);
		cam->row = 0;
		cam->offset -= cam->table->rows[0].slave;
	}
}

static void previous_row(struct lw_cam *cam, const struct lw_cam_table *next)
{
	if (cam->row == 0) {
		leave_cycle(cam, 0, next, -1);
		cam->row = (uint16_t)(cam->table->row_count - 1u);
		cam->offset -= cam->table->rows[cam->row].slave;
	}
	cam->row--;
	cam->at += row_ticks(cam);
}

/** Bring the numerator into its range. An edge moves it by few denominators: no division. */
static int whole_steps(struct lw_cam *cam)
{
	int steps = 0;

	while (cam->remainder >= cam->den) {
		cam->remainder -= cam->den;
		steps++;
	}
	while (cam->remainder < 0) {
		cam->remainder += cam->den;
		steps--;
	}
	cam->pos_usteps += steps;
	return steps;
}

int lw_cam_edge(struct lw_cam *cam, int dd, const struct lw_cam_table *next)
{
	if (dd > 0) {
		cam->at += cam->stride;
		if (cam->at < cam->piece_end) {
			cam->remainder += cam->slope;
			cam->slope += cam->curve;
			return whole_steps(cam);
		}
		if (cam->at >= row_ticks(cam)) {
			next_row(cam, next);
		}
	} else {
		if (cam->at - cam->piece_begin >= cam->stride) {
			cam->at -= cam->stride;
			cam->slope -= cam->curve;
			cam->remainder -= cam->slope;
			return whole_steps(cam);
		}
		if (cam->at < cam->stride) {
			previous_row(cam, next);
		}
		cam->at -= cam->stride;
	}
	enter_piece(cam);
	return whole_steps(cam);
}

int lw_cam_begin(struct lw_cam *cam, int dd, int64_t pos_usteps)
{
	cam->cycles = dd > 0 ? 0 : -1;
	cam->offset = dd > 0 ? 0 : -(int64_t)cam->table->advance;
	cam->pos_usteps = pos_usteps;
	enter_piece(cam);
	return whole_steps(cam);
}

/** Quotient rounded toward minus infinity, den > 0. */
static int64_t divide_floor(int64_t num, int64_t den)
{
	return num / den - (num % den < 0);
}

void lw_cam_start(struct lw_cam *cam, const struct lw_cam_table *table,
		  const struct lw_cam_scale *scale, int64_t edges, int64_t offset)
{
	/* In 1 / scale->edges of a master unit, of which an edge is scale->master_units. */
	const int64_t cycle = (int64_t)table->rows[table->row_count - 1].master * scale->edges;
	const int64_t cycles = divide_floor(edges * scale->master_units, cycle);
	int64_t at = (edges * scale->master_units - cycles * cycle) * scale->ramp_divisor;

	*cam = (struct lw_cam){
		.stride = (uint32_t)(scale->master_units * scale->ramp_divisor),
		.offset = offset + cycles * table->advance,
		.cycles = (int32_t)cycles,
		.table = table,
		.scale = *scale,
	};
	while (at >= row_ticks(cam)) {
		at -= row_ticks(cam);
		cam->row++;
	}
	cam->at = (uint32_t)at;

	/* The row's begin is near enough to evaluate the piece; then the rest of the way. */
	cam->pos_usteps = divide_floor(2 * (int64_t)scale->usteps *
						       (table->rows[cam->row].slave + cam->offset) +
					       scale->slave_units,
				       2 * (int64_t)scale->slave_units);
	enter_piece(cam);

	const int64_t usteps = divide_floor(cam->remainder, cam->den);

	cam->remainder -= usteps * cam->den;
	cam->pos_usteps += usteps;
}
