/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Metres of rope on a drum that grows with them (doc/control-law.md section 7).
 *
 * With N turns since the drum was bare, L(N) = A N + B N^2: A is the circumference of the bare
 * drum, 2 pi R0, and B = pi^2 d^2 / (4 p w) what a rope of diameter d makes of it that fills the
 * part p of the room on a drum of width w. The wound radius is R = (A + 2 B N) / (2 pi).
 *
 * N follows the odometer as a pure function of its edges, and L is one of N. So winding in and out
 * again comes back to the same micrometre, whatever the drum did between. Against the formula in
 * real numbers L is off by less than L * 2e-7 + N^2 * 1e-5 um + A / 65000: for 2 km on a common
 * winch less than 1 mm.
 *
 * Not for interrupt context: 64-bit division.
 */
#ifndef LW_ROPE_LENGTH_H
#define LW_ROPE_LENGTH_H

#include <stdbool.h>
#include <stdint.h>

/** Most rope that is counted, micrometres: what millimetres in 32 bit can say. */
#define LW_ROPE_LENGTH_MAX_UM (INT32_MAX * INT64_C(1000))

/** One turn of the drum in the format of N. */
#define LW_ROPE_TURN 65536

/** Drum and rope. All zero: not known. */
struct lw_rope_geometry {
	int64_t core_um_q16;   /**< A: circumference of the bare drum, Q16; 0: not known */
	int64_t growth_um_q16; /**< B: half of what a turn adds to it, Q16 */
	int32_t diameter_um;   /**< of the rope */
	int32_t edges;         /**< of the odometer, in `revs` drum revolutions */
	int32_t revs;
};

/**
 * Drum and rope in the numbers of the formula.
 *
 * @param core_um diameter of the bare drum, `diameter_um` to 5,000,000
 * @param diameter_um of the rope, 1 to 50,000
 * @param packing_permille p, 100 to 1000
 * @param width_um w, at least `diameter_um`, up to 700,000
 */
struct lw_rope_geometry lw_rope_geometry(uint32_t core_um, int32_t diameter_um,
					 int32_t packing_permille, int32_t width_um);

/** L(N), micrometres, up to LW_ROPE_LENGTH_MAX_UM either way. Below 0 turns the bare drum counts.
 */
int64_t lw_rope_length_um(const struct lw_rope_geometry *geometry, int64_t turns_q16);

/**
 * The smallest N with L(N) >= um, so that lw_rope_length_um() of it is `um` to half a millimetre.
 *
 * @param um 0 to LW_ROPE_LENGTH_MAX_UM
 * @retval 0 done
 * @retval -ERANGE more than the formula's numbers hold; `turns_q16` is the most
 */
int lw_rope_turns_q16(const struct lw_rope_geometry *geometry, int64_t um, int64_t *turns_q16);

/** Wound radius, micrometres; below 0 turns that of the bare drum. */
int64_t lw_rope_radius_um(const struct lw_rope_geometry *geometry, int64_t turns_q16);

/** Rope that so many edges move at the radius that is, micrometres; |edges| up to 10^7. */
int64_t lw_rope_moved_um(const struct lw_rope_geometry *geometry, int64_t turns_q16, int64_t edges);

/** Layers on the drum, begun ones too; 0: bare. */
int32_t lw_rope_layer(const struct lw_rope_geometry *geometry, int64_t turns_q16);

/**
 * What is known about the rope on the drum. All zero but for the geometry: nothing. Written by
 * rope_length.c.
 */
struct lw_rope_length {
	struct lw_rope_geometry geometry;
	bool told;               /**< somebody has said how much there is */
	bool doubtful;           /**< it may be wrong since; sticky until it is told anew */
	int32_t told_mm;         /**< what was said */
	int64_t told_turns_q16;  /**< N there, by the geometry */
	int64_t since_turns_q16; /**< turns since then at the odometer's 0 */
};

/**
 * So much rope is on the drum now.
 *
 * @retval 0 done
 * @retval -ERANGE more than fits; nothing has changed
 */
int lw_rope_length_tell(struct lw_rope_length *rope, int32_t mm, int64_t net_edges);

/**
 * Go on with what was told before a power-up, which is doubtful: the drum may have turned unseen.
 *
 * @param since_turns_q16 turns since it was told, lw_rope_length_since_q16() of then
 */
void lw_rope_length_restore(struct lw_rope_length *rope, int32_t told_mm, int64_t since_turns_q16);

/** Go on with another drum, rope or encoder: what was told stays true where it was told. */
void lw_rope_length_configure(struct lw_rope_length *rope, const struct lw_rope_geometry *geometry,
			      int64_t net_edges);

/** Are metres by the growing layers known, doubtful or not? */
static inline bool lw_rope_length_known(const struct lw_rope_length *rope)
{
	return rope->told && rope->geometry.core_um_q16 != 0;
}

/** Turns since the rope was told. */
int64_t lw_rope_length_since_q16(const struct lw_rope_length *rope, int64_t net_edges);

/** N: turns since the drum was bare. Where the length is known. */
int64_t lw_rope_length_now_q16(const struct lw_rope_length *rope, int64_t net_edges);

/** Is it described, and may what is said about it be wrong? */
bool lw_rope_length_doubtful(const struct lw_rope_length *rope);

/**
 * Look whether it has become doubtful. Every tick.
 *
 * @param edges_lost the odometer may be wrong, or the encoder
 */
void lw_rope_length_tick(struct lw_rope_length *rope, int64_t net_edges, bool edges_lost);

#endif /* LW_ROPE_LENGTH_H */
