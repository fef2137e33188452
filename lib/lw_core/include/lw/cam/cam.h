/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The electronic cam: slave position as a pure function of net encoder edges, by the rows of a
 * table (lw/cam/cam_table.h), exact and the same in both directions.
 *
 * The position is floor(x + 1/2) of a rational x that is a polynomial of first or second degree
 * within each piece of a row (the whole row if linear; ramp, plateau, ramp if trapezoid). Inside
 * a piece an edge adds the polynomial's difference to an exact numerator. The pieces around the one
 * that the master is in are prepared ahead (struct lw_cam_ring), so that an edge into another piece
 * takes over what stands there. No division, no rounding that is carried on: doc/cam.md.
 */
#ifndef LW_CAM_H
#define LW_CAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lw/cam/cam_table.h"

/** For what an edge does: the interrupt takes it in even where code is built for size. */
#ifndef LW_EDGE_INLINE
#define LW_EDGE_INLINE static inline __attribute__((always_inline))
#endif

/** What an edge inside of a piece adds up, and with which numbers. */
enum lw_cam_kind {
	LW_CAM_CLOSED,   /**< no piece: see struct lw_cam_motion */
	LW_CAM_STRAIGHT, /**< the same at every edge; numerators below LW_CAM_NARROW_MAX */
	LW_CAM_CURVED,   /**< differences that change by `curve`; numerators as above */
	LW_CAM_WIDE,     /**< either; numerators of 64 bit */
};

/** Denominators up to here leave room for a sum in 32 bit. */
#define LW_CAM_NARROW_MAX (INT32_MAX / 2)

/** What an edge adds up. The upper halves are 0 but in a piece of the kind LW_CAM_WIDE. */
struct lw_cam_numbers {
	uint32_t remainder; /**< (x + 1/2 - pos) * den, 0 <= remainder < den: lower half */
	/** The next forward edge in this piece adds whole * den + slope, 0 <= slope < den. */
	uint32_t slope;
	int32_t whole;
	uint32_t remainder_high;
	uint32_t slope_high;
};

/** What an edge changes inside of a piece. A function of the net edges since the start. */
struct lw_cam_point {
	struct lw_cam_numbers numbers;
	uint32_t left;       /**< edges to the last place of the piece */
	uint32_t pos_usteps; /**< lower half: lw_cam_pos() */
};

/**
 * What it does not change. `first_at` counts ticks from the row's begin: one master unit is
 * `scale.edges * scale.ramp_divisor` ticks, so that an edge is a whole number of them, the same
 * for every row, and a ramp ends at a whole one.
 */
struct lw_cam_piece {
	int64_t den;
	/** An edge adds whole_curve * den + curve to the slope, 0 <= curve < den. */
	int64_t curve;
	uint32_t first_at; /**< the first place that an edge leads to */
	uint32_t edges;    /**< edges from there to the last one */
	int32_t cycles;    /**< net cycles since the start */
	uint16_t row;      /**< index of the row that the piece is of */
	int8_t whole_curve;
	uint8_t kind; /**< enum lw_cam_kind */
};

/** State. */
struct lw_cam {
	struct lw_cam_point point;
	struct lw_cam_piece piece;
	int64_t offset;  /**< slave units added to the table in cycle 0: start, other tables */
	int64_t was_pos; /**< the whole position, not half of 32 bit ago */
	uint32_t serial; /**< of the piece: rises by 1 to the next one, and jumps where none is */
	uint32_t stride; /**< ticks of one edge */
	const struct lw_cam_table *table;
	struct lw_cam_scale scale;
};

/** Pieces prepared around the one that the master is in; a power of two. */
#define LW_CAM_RING_SLOTS 16u

/**
 * Pieces `begin` to `begin + count`, by their serials. The supervisor writes, the edge interrupt
 * reads: a slot is never written while it is among them. {0} is empty.
 */
struct lw_cam_ring {
	volatile uint32_t begin;
	volatile uint32_t count;
	struct lw_cam_slot {
		struct lw_cam_piece piece;
		/** At the first place of the piece. */
		struct lw_cam_end {
			struct lw_cam_numbers numbers;
			uint32_t pos_usteps; /**< lower half */
		} first;
		struct lw_cam_end last; /**< at the last one */
	} slots[LW_CAM_RING_SLOTS];
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

/** Count cycles from the one that the master is in. While no edge is taken. */
static inline void lw_cam_count_from_here(struct lw_cam *cam)
{
	cam->offset += (int64_t)cam->piece.cycles * cam->table->advance;
	cam->piece.cycles = 0;
}

/** Position in microsteps. While no edge is taken. */
static inline int64_t lw_cam_pos(const struct lw_cam *cam)
{
	return cam->was_pos + (int32_t)(cam->point.pos_usteps - (uint32_t)cam->was_pos);
}

/** Slave units added to the table in the present cycle: advance of the cycles, start. */
int64_t lw_cam_offset(const struct lw_cam *cam);

/**
 * Prepare the pieces around the one that a cam is in, as many as there is room for. For the
 * supervisor, which the edge interrupt may interrupt.
 *
 * An edge into a piece that is not prepared evaluates it, which takes longer and gives the same.
 */
void lw_cam_ring_fill(struct lw_cam_ring *ring, const struct lw_cam *cam);

/** The edge leads out of the piece; nothing was done. */
#define LW_CAM_LEAVES INT_MIN

/** A numerator of its halves. */
LW_EDGE_INLINE int64_t lw_cam_numerator(uint32_t high, uint32_t low)
{
	return (int64_t)high * 4294967296 + low;
}

/** Take one edge inside of a piece with numerators of 64 bit. As lw_cam_inside(). */
LW_EDGE_INLINE int lw_cam_inside_wide(struct lw_cam *cam, int dd)
{
	struct lw_cam_point *point = &cam->point;
	const int64_t den = cam->piece.den;
	const int64_t curve = cam->piece.curve;
	int64_t remainder =
		lw_cam_numerator(point->numbers.remainder_high, point->numbers.remainder);
	int64_t slope = lw_cam_numerator(point->numbers.slope_high, point->numbers.slope);
	int32_t whole = point->numbers.whole;
	int steps;

	if (dd > 0) {
		steps = whole;
		remainder += slope;
		if (remainder >= den) {
			remainder -= den;
			steps++;
		}
		whole += cam->piece.whole_curve;
		slope += curve;
		if (slope >= den) {
			slope -= den;
			whole++;
		}
	} else {
		whole -= cam->piece.whole_curve;
		slope -= curve;
		if (slope < 0) {
			slope += den;
			whole--;
		}
		steps = -whole;
		remainder -= slope;
		if (remainder < 0) {
			remainder += den;
			steps--;
		}
	}
	point->numbers.remainder = (uint32_t)remainder;
	point->numbers.remainder_high = (uint32_t)((uint64_t)remainder / 0x100000000U);
	point->numbers.slope = (uint32_t)slope;
	point->numbers.slope_high = (uint32_t)((uint64_t)slope / 0x100000000U);
	point->numbers.whole = whole;
	return steps;
}

/** Take one edge inside of a piece of the kind LW_CAM_STRAIGHT. As lw_cam_inside(). */
LW_EDGE_INLINE int lw_cam_inside_straight(struct lw_cam *cam, int dd)
{
	struct lw_cam_point *point = &cam->point;
	const int32_t den = (int32_t)cam->piece.den;
	const int32_t slope = (int32_t)point->numbers.slope;
	int32_t remainder = (int32_t)point->numbers.remainder;
	int steps;

	if (dd > 0) {
		steps = point->numbers.whole;
		remainder += slope;
		if (remainder >= den) {
			remainder -= den;
			steps++;
		}
	} else {
		steps = -point->numbers.whole;
		remainder -= slope;
		if (remainder < 0) {
			remainder += den;
			steps--;
		}
	}
	point->numbers.remainder = (uint32_t)remainder;
	return steps;
}

/** Take one edge inside of a piece of the kind LW_CAM_CURVED. As lw_cam_inside(). */
LW_EDGE_INLINE int lw_cam_inside_curved(struct lw_cam *cam, int dd)
{
	struct lw_cam_point *point = &cam->point;
	const int32_t den = (int32_t)cam->piece.den;
	const int32_t curve = (int32_t)cam->piece.curve;
	int32_t slope = (int32_t)point->numbers.slope;
	int32_t whole = point->numbers.whole;
	int steps;

	if (dd > 0) {
		steps = lw_cam_inside_straight(cam, dd);
		whole += cam->piece.whole_curve;
		slope += curve;
		if (slope >= den) {
			slope -= den;
			whole++;
		}
		point->numbers.slope = (uint32_t)slope;
		point->numbers.whole = whole;
		return steps;
	}
	whole -= cam->piece.whole_curve;
	slope -= curve;
	if (slope < 0) {
		slope += den;
		whole--;
	}
	point->numbers.slope = (uint32_t)slope;
	point->numbers.whole = whole;
	return lw_cam_inside_straight(cam, dd);
}

/**
 * Count an edge that does not lead out of the piece. For the edge interrupt.
 *
 * @return false: it does, nothing was done
 */
LW_EDGE_INLINE bool lw_cam_stays(struct lw_cam *cam, int dd)
{
	const int32_t left = (int32_t)cam->point.left - dd;

	if (dd > 0 ? left < 0 : left > (int32_t)cam->piece.edges) {
		return false;
	}
	cam->point.left = (uint32_t)left;
	return true;
}

/**
 * Take one edge that lw_cam_stays() has counted. `pos_usteps` is left to the caller. For the edge
 * interrupt.
 *
 * @param kind of the piece, not LW_CAM_CLOSED
 * @param dd +1 forward or -1 backward
 * @return steps to give
 */
LW_EDGE_INLINE int lw_cam_inside(struct lw_cam *cam, int kind, int dd)
{
	if (kind == LW_CAM_STRAIGHT) {
		return lw_cam_inside_straight(cam, dd);
	}
	return kind == LW_CAM_CURVED ? lw_cam_inside_curved(cam, dd) : lw_cam_inside_wide(cam, dd);
}

/**
 * Take one edge that leads out of the piece, if the piece that it leads to is prepared: then
 * `pos_usteps` is where the slave is there. For the edge interrupt.
 *
 * @param next as lw_cam_edge()
 * @param ring pieces that are prepared
 * @return false: it is not, or another table begins there; nothing was done
 */
LW_EDGE_INLINE bool lw_cam_cross(struct lw_cam *cam, int dd, const struct lw_cam_table *next,
				 const struct lw_cam_ring *ring)
{
	const uint32_t serial = cam->serial + (uint32_t)dd;
	const struct lw_cam_slot *slot = &ring->slots[serial % LW_CAM_RING_SLOTS];

	if (serial - ring->begin >= ring->count ||
	    (next != NULL && slot->piece.cycles != cam->piece.cycles)) {
		return false;
	}
	const struct lw_cam_end *end = dd > 0 ? &slot->first : &slot->last;

	cam->serial = serial;
	cam->piece = slot->piece;
	cam->point.numbers = end->numbers;
	cam->point.left = dd > 0 ? slot->piece.edges : 0;
	cam->point.pos_usteps = end->pos_usteps;
	return true;
}

/**
 * Take one edge. For the edge interrupt.
 *
 * @param dd +1 forward or -1 backward
 * @param next table to go on with from the cycle's boundary, or NULL. The slave stands at the
 *        boundary where the old table left it. Must be accepted with the same scale.
 * @param ring pieces that are prepared
 * @return steps to give, -LW_CAM_STEPS_PER_EDGE_MAX to LW_CAM_STEPS_PER_EDGE_MAX
 */
int lw_cam_edge(struct lw_cam *cam, int dd, const struct lw_cam_table *next,
		const struct lw_cam_ring *ring);

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
