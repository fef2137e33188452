/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/cam/cam.h"

#include <stdatomic.h>
#include <stddef.h>

#include "lw/bytes/same.h"

/** How far a serial jumps where the pieces do not go on: out of every ring. */
#define SERIAL_JUMP 0x10000u

/** Ticks of a ramp of the present row. */
static uint32_t ramp_ticks(const struct lw_cam *cam)
{
	const struct lw_cam_row *row = &cam->table->rows[cam->piece.row];

	return (uint32_t)(row[1].master - row[0].master) * (uint32_t)cam->scale.edges;
}

static uint32_t row_ticks(const struct lw_cam *cam)
{
	return ramp_ticks(cam) * (uint32_t)cam->scale.ramp_divisor;
}

int64_t lw_cam_offset(const struct lw_cam *cam)
{
	return cam->offset + (int64_t)cam->piece.cycles * cam->table->advance;
}

/** Bring a numerator into its range. It is few denominators off: no division. */
static int32_t take_whole(int64_t *numerator, int64_t den)
{
	int32_t whole = 0;

	while (*numerator >= den) {
		*numerator -= den;
		whole++;
	}
	while (*numerator < 0) {
		*numerator += den;
		whole--;
	}
	return whole;
}

/** Greatest common divisor, both above 0. */
static uint32_t common_divisor(uint32_t a, uint32_t b)
{
	while (b != 0) {
		const uint32_t rest = a % b;

		a = b;
		b = rest;
	}
	return a;
}

static void put_remainder(struct lw_cam_point *point, int64_t remainder)
{
	point->numbers.remainder = (uint32_t)remainder;
	point->numbers.remainder_high = (uint32_t)((uint64_t)remainder / 0x100000000U);
}

/**
 * Evaluate the piece that the place `at` ticks into the row lies in, but for the remainder.
 * Formulas: doc/cam.md; lw_cam_table_check() sees to it that everything fits into 64 bits.
 *
 * @return (x + 1/2 - pos) * den, by `pos_usteps`, which is near
 */
static int64_t enter_piece(struct lw_cam *cam, uint32_t at_ticks)
{
	const struct lw_cam_row *row = &cam->table->rows[cam->piece.row];
	const uint32_t divisor = (uint32_t)cam->scale.ramp_divisor;
	/* All that counts in ticks here is a multiple of this: it makes the numerators small. */
	const uint32_t unit = common_divisor(ramp_ticks(cam), divisor);
	const uint32_t ramp = ramp_ticks(cam) / unit;
	const uint32_t row_end = ramp * divisor;
	const uint32_t stride_units = cam->stride / unit;
	const uint32_t at_units = at_ticks / unit;
	const int64_t at = at_units;
	const int64_t stride = stride_units;
	const int64_t usteps = cam->scale.usteps;
	/* The slave's way through the row, and its begin, in 1 / (2 * slave_units) microsteps. */
	const int64_t way = usteps * ((int64_t)row[1].slave - row[0].slave);
	const int64_t begin = 2 * usteps * (row[0].slave + lw_cam_offset(cam)) +
			      cam->scale.slave_units * (1 - 2 * lw_cam_pos(cam));
	uint32_t piece_begin = 0;
	uint32_t piece_end = row_end;
	int64_t scale = row_end;
	int64_t slope = 2 * way * stride;
	int64_t curve = 0;
	int64_t remainder = 2 * way * at;

	if (cam->table->interpolation == LW_CAM_INTERPOLATION_TRAPEZOID) {
		scale = (int64_t)ramp * (row_end - ramp);
		if (at_units < ramp) {
			piece_end = ramp;
			curve = 2 * way * stride * stride;
			slope = way * stride * (2 * at + stride);
			remainder = way * at * at;
		} else if (at_units < row_end - ramp) {
			piece_begin = ramp;
			piece_end = row_end - ramp;
			scale = row_end - ramp;
			remainder = way * (2 * at - ramp);
		} else {
			const int64_t left = (int64_t)row_end - at;

			piece_begin = row_end - ramp;
			curve = -2 * way * stride * stride;
			slope = way * stride * (2 * left - stride);
			remainder = way * (2 * scale - left * left);
		}
	}

	const int64_t den = 2 * cam->scale.slave_units * scale;
	const uint32_t done = (at_units - piece_begin) / stride_units;
	const uint32_t left = (piece_end - 1 - at_units) / stride_units;

	if (done + left == 0) { /* no edge stays inside, and a short ramp may be steep */
		slope = 0;
		curve = 0;
	}
	cam->piece.whole_curve = (int8_t)take_whole(&curve, den);
	cam->piece.den = den;
	cam->piece.curve = curve;
	cam->piece.first_at = at_ticks - done * cam->stride;
	cam->piece.edges = done + left;
	cam->piece.kind = den > LW_CAM_NARROW_MAX                     ? LW_CAM_WIDE
			  : curve != 0 || cam->piece.whole_curve != 0 ? LW_CAM_CURVED
								      : LW_CAM_STRAIGHT;
	cam->point.numbers.whole = take_whole(&slope, den);
	cam->point.numbers.slope = (uint32_t)slope;
	cam->point.numbers.slope_high = (uint32_t)((uint64_t)slope / 0x100000000U);
	cam->point.left = left;
	return remainder + begin * scale;
}

/**
 * Leave a cycle at its boundary, and go on with another table if there is one: from where the slave
 * is there.
 */
static void leave_cycle(struct lw_cam *cam, const struct lw_cam_table *next, int dd)
{
	const struct lw_cam_table *table = cam->table;
	const int64_t slave = (dd > 0 ? table->rows[table->row_count - 1u] : table->rows[0]).slave +
			      lw_cam_offset(cam);

	/* What is prepared ahead may lie past the end of the count. */
	cam->piece.cycles = (int32_t)((uint32_t)cam->piece.cycles + (uint32_t)dd);
	if (next != NULL) {
		const unsigned int joint = dd > 0 ? 0 : next->row_count - 1u;

		cam->table = next;
		cam->serial += SERIAL_JUMP;
		cam->offset = 0;
		cam->offset = slave - next->rows[joint].slave - lw_cam_offset(cam);
	}
}

/**
 * Go to the row of the place that an edge leads to from the end of a piece.
 *
 * @return ticks of that place into its row
 */
static uint32_t edge_over(struct lw_cam *cam, int dd, const struct lw_cam_table *next)
{
	struct lw_cam_piece *piece = &cam->piece;
	uint32_t at = piece->first_at;

	cam->serial += (uint32_t)dd;
	if (dd > 0) {
		at += (piece->edges + 1) * cam->stride;
		if (at < row_ticks(cam)) {
			return at;
		}
		at -= row_ticks(cam);
		piece->row++;
		if (piece->row + 1u == cam->table->row_count) {
			leave_cycle(cam, next, 1);
			piece->row = 0;
		}
		return at;
	}
	if (at < cam->stride) {
		if (piece->row == 0) {
			leave_cycle(cam, next, -1);
			piece->row = (uint16_t)(cam->table->row_count - 1u);
		}
		piece->row--;
		at += row_ticks(cam);
	}
	return at - cam->stride;
}

/** Be at a place of the row near `pos_usteps`. @return steps from there */
static int go_to(struct lw_cam *cam, uint32_t at)
{
	int64_t remainder = enter_piece(cam, at);
	const int steps = take_whole(&remainder, cam->piece.den);

	put_remainder(&cam->point, remainder);
	cam->point.pos_usteps += (uint32_t)steps;
	cam->was_pos = lw_cam_pos(cam);
	return steps;
}

int lw_cam_edge(struct lw_cam *cam, int dd, const struct lw_cam_table *next,
		const struct lw_cam_ring *ring)
{
	const uint32_t from_usteps = cam->point.pos_usteps;
	int steps;

	if (lw_cam_stays(cam, dd)) {
		steps = lw_cam_inside(cam, cam->piece.kind, dd);
		cam->point.pos_usteps += (uint32_t)steps;
		cam->was_pos = lw_cam_pos(cam);
		return steps;
	}
	if (lw_cam_cross(cam, dd, next, ring)) {
		cam->was_pos = lw_cam_pos(cam);
		return (int)(cam->point.pos_usteps - from_usteps);
	}
	return go_to(cam, edge_over(cam, dd, next));
}

int lw_cam_begin(struct lw_cam *cam, int dd, int64_t pos_usteps)
{
	cam->piece.cycles = dd > 0 ? 0 : -1;
	cam->offset = 0;
	cam->was_pos = pos_usteps;
	cam->point.pos_usteps = (uint32_t)pos_usteps;
	cam->serial += SERIAL_JUMP;
	return go_to(cam, cam->piece.first_at + (cam->piece.edges - cam->point.left) * cam->stride);
}

/** Quotient rounded toward minus infinity, den > 0. */
static int64_t divide_floor(int64_t num, int64_t den)
{
	return num / den - (num % den < 0);
}

/** Be at a place of the row, wherever the position was. Divides. */
static void place(struct lw_cam *cam, uint32_t at)
{
	const int64_t usteps = cam->scale.usteps;
	const int64_t slave_units = cam->scale.slave_units;
	int64_t remainder;
	int64_t whole;

	/* The row's begin is near enough to evaluate the piece; then the rest of the way. */
	cam->was_pos = divide_floor(
		2 * usteps * (cam->table->rows[cam->piece.row].slave + lw_cam_offset(cam)) +
			slave_units,
		2 * slave_units);
	cam->point.pos_usteps = (uint32_t)cam->was_pos;
	remainder = enter_piece(cam, at);
	whole = divide_floor(remainder, cam->piece.den);
	put_remainder(&cam->point, remainder - whole * cam->piece.den);
	cam->was_pos += whole;
	cam->point.pos_usteps = (uint32_t)cam->was_pos;
}

void lw_cam_start(struct lw_cam *cam, const struct lw_cam_table *table,
		  const struct lw_cam_scale *scale, int64_t edges, int64_t offset)
{
	/* In 1 / scale->edges of a master unit, of which an edge is scale->master_units. */
	const int64_t cycle = (int64_t)table->rows[table->row_count - 1].master * scale->edges;
	const int64_t cycles = divide_floor(edges * scale->master_units, cycle);
	int64_t at = (edges * scale->master_units - cycles * cycle) * scale->ramp_divisor;

	*cam = (struct lw_cam){
		.piece = {.cycles = (int32_t)cycles},
		.offset = offset,
		.stride = (uint32_t)(scale->master_units * scale->ramp_divisor),
		.table = table,
		.scale = *scale,
	};
	while (at >= row_ticks(cam)) {
		at -= row_ticks(cam);
		cam->piece.row++;
	}
	place(cam, (uint32_t)at);
}

/** Both ends of the piece that `cam` is in, at `at`. `cam` is left somewhere in it. */
static void fill_slot(struct lw_cam_slot *slot, struct lw_cam *cam, uint32_t at)
{
	place(cam, at);
	slot->piece = cam->piece;
	place(cam, slot->piece.first_at);
	slot->first = (struct lw_cam_end){
		.numbers = cam->point.numbers,
		.pos_usteps = cam->point.pos_usteps,
	};
	place(cam, slot->piece.first_at + slot->piece.edges * cam->stride);
	slot->last = (struct lw_cam_end){
		.numbers = cam->point.numbers,
		.pos_usteps = cam->point.pos_usteps,
	};
}

/** A copy of a cam that edges may change meanwhile: of its piece, not of the place in it. */
static struct lw_cam read_cam(const struct lw_cam *cam)
{
	struct lw_cam first;
	struct lw_cam second = *cam;

	do {
		first = second;
		atomic_signal_fence(memory_order_seq_cst);
		second = *cam;
	} while (first.serial != second.serial || first.table != second.table ||
		 !lw_same(&first.piece, &second.piece, sizeof(first.piece)));
	return second;
}

/** Prepare one piece more: the one that `cam` is in, or at that end which has fewer. */
static bool add_piece(struct lw_cam_ring *ring, const struct lw_cam *cam)
{
	struct lw_cam at = read_cam(cam);
	const uint32_t behind = at.serial - ring->begin;
	const uint32_t ahead = ring->count - 1 - behind;
	const bool forward = ahead <= behind;
	uint32_t from;

	if (behind >= ring->count) {
		ring->count = 0;
		ring->begin = at.serial;
		fill_slot(&ring->slots[at.serial % LW_CAM_RING_SLOTS], &at, at.piece.first_at);
		atomic_signal_fence(memory_order_seq_cst);
		ring->count = 1;
		return true;
	}
	if (ring->count == LW_CAM_RING_SLOTS) {
		/* One is given up at the end that has more. */
		if (forward ? behind <= ahead + 1 : ahead <= behind + 1) {
			return false;
		}
		ring->count--;
		if (forward) {
			ring->begin++;
		}
		atomic_signal_fence(memory_order_seq_cst);
	}
	from = forward ? ring->begin + ring->count - 1 : ring->begin;
	at.piece = ring->slots[from % LW_CAM_RING_SLOTS].piece;
	at.serial = from;

	const uint32_t ticks = edge_over(&at, forward ? 1 : -1, NULL);

	fill_slot(&ring->slots[at.serial % LW_CAM_RING_SLOTS], &at, ticks);
	atomic_signal_fence(memory_order_seq_cst);
	if (!forward) {
		ring->begin--;
	}
	ring->count++;
	return true;
}

void lw_cam_ring_fill(struct lw_cam_ring *ring, const struct lw_cam *cam)
{
	for (unsigned int i = 0; i < LW_CAM_RING_SLOTS && add_piece(ring, cam); i++) {
	}
}
