/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/control/rope_length.h"

#include <errno.h>

#include "lw/bytes/numbers.h"

/** Far more turns than rope has; what keeps every product below in 64 bit. */
#define TURNS_MAX 1048576

/** Of any drum, 100 m: nothing overflows where the turns are far beyond what there is. */
#define CIRCUMFERENCE_MAX_UM 100000000

/* pi = 355 / 113, 8.5e-8 too much. */
#define PI_NUM  355
#define PI_DEN  113
#define PI2_NUM 126025
#define PI2_DEN 12769

struct lw_rope_geometry lw_rope_geometry(uint32_t core_um, int32_t diameter_um,
					 int32_t packing_permille, int32_t width_um)
{
	/* 126025 / 12769 * d^2 * 1000 / (4 p w) * 65536, in two steps to stay below 2^63. */
	const int64_t num = (int64_t)PI2_NUM * diameter_um * diameter_um * (1000 / 4) * 64;
	const int64_t den = (int64_t)PI2_DEN * packing_permille * width_um;

	return (struct lw_rope_geometry){
		.core_um_q16 = lw_divide_nearest((int64_t)core_um * LW_ROPE_TURN * PI_NUM, PI_DEN),
		.growth_um_q16 = num / den * 1024 + lw_divide_nearest(num % den * 1024, den),
		.diameter_um = diameter_um,
	};
}

int64_t lw_rope_length_um(const struct lw_rope_geometry *geometry, int64_t turns_q16)
{
	const int64_t whole = turns_q16 / LW_ROPE_TURN;
	const int64_t part = turns_q16 % LW_ROPE_TURN;
	/* Circumference half-way: A + B N. */
	int64_t mean_um_q16 = geometry->core_um_q16;

	if (whole >= TURNS_MAX || whole <= -TURNS_MAX) {
		return whole > 0 ? LW_ROPE_LENGTH_MAX_UM : -LW_ROPE_LENGTH_MAX_UM;
	}
	if (turns_q16 > 0) {
		mean_um_q16 += geometry->growth_um_q16 * whole +
			       geometry->growth_um_q16 * part / LW_ROPE_TURN;
	}
	if (mean_um_q16 / LW_ROPE_TURN >=
	    LW_ROPE_LENGTH_MAX_UM / ((whole < 0 ? -whole : whole) + 1)) {
		return whole < 0 ? -LW_ROPE_LENGTH_MAX_UM : LW_ROPE_LENGTH_MAX_UM;
	}
	return lw_divide_nearest(mean_um_q16 * whole + mean_um_q16 / 256 * part / 256,
				 LW_ROPE_TURN);
}

int lw_rope_turns_q16(const struct lw_rope_geometry *geometry, int64_t um, int64_t *turns_q16)
{
	int64_t low = 0;
	int64_t high = (int64_t)TURNS_MAX * LW_ROPE_TURN - 1;

	*turns_q16 = high;
	if (lw_rope_length_um(geometry, high) < um) {
		return -ERANGE;
	}
	while (low < high) {
		const int64_t middle = low + (high - low) / 2;

		if (lw_rope_length_um(geometry, middle) < um) {
			low = middle + 1;
		} else {
			high = middle;
		}
	}
	*turns_q16 = low;
	return 0;
}

/** Circumference of what is wound: A + 2 B N. */
static int64_t circumference_um_q16(const struct lw_rope_geometry *geometry, int64_t turns_q16)
{
	const int64_t most = (int64_t)TURNS_MAX * LW_ROPE_TURN;
	const int64_t turns = turns_q16 < 0 ? 0 : turns_q16 < most ? turns_q16 : most;

	return geometry->core_um_q16 +
	       2 * (geometry->growth_um_q16 * (turns / LW_ROPE_TURN) +
		    geometry->growth_um_q16 * (turns % LW_ROPE_TURN) / LW_ROPE_TURN);
}

int64_t lw_rope_radius_um(const struct lw_rope_geometry *geometry, int64_t turns_q16)
{
	return lw_divide_nearest(circumference_um_q16(geometry, turns_q16) / LW_ROPE_TURN * PI_DEN,
				 2 * PI_NUM);
}

int64_t lw_rope_moved_um(const struct lw_rope_geometry *geometry, int64_t turns_q16, int64_t edges)
{
	const int64_t um = circumference_um_q16(geometry, turns_q16) / LW_ROPE_TURN;
	const int64_t sane_um = um < CIRCUMFERENCE_MAX_UM ? um : CIRCUMFERENCE_MAX_UM;

	return lw_divide_nearest(sane_um * geometry->revs * edges, geometry->edges);
}

int32_t lw_rope_layer(const struct lw_rope_geometry *geometry, int64_t turns_q16)
{
	const int64_t wound_um =
		lw_rope_radius_um(geometry, turns_q16) - lw_rope_radius_um(geometry, 0);

	return turns_q16 <= 0 ? 0 : lw_clamp32(wound_um / geometry->diameter_um + 1);
}

/** Turns of so many edges: a pure function of them, so that nothing adds up. */
static int64_t turns_of_q16(const struct lw_rope_geometry *geometry, int64_t edges)
{
	const int64_t num = edges * geometry->revs;

	return num / geometry->edges * LW_ROPE_TURN +
	       num % geometry->edges * LW_ROPE_TURN / geometry->edges;
}

/** N where the rope was told, by the geometry in force. @retval -ERANGE it does not fit */
static int find_told(struct lw_rope_length *rope)
{
	if (!lw_rope_length_known(rope)) {
		return 0;
	}
	return lw_rope_turns_q16(&rope->geometry, (int64_t)rope->told_mm * 1000,
				 &rope->told_turns_q16);
}

int lw_rope_length_tell(struct lw_rope_length *rope, int32_t mm, int64_t net_edges)
{
	struct lw_rope_length told = {
		.geometry = rope->geometry,
		.told = true,
		.told_mm = mm,
		.since_turns_q16 = -turns_of_q16(&rope->geometry, net_edges),
	};
	const int ret = find_told(&told);

	if (ret == 0) {
		*rope = told;
	}
	return ret;
}

void lw_rope_length_restore(struct lw_rope_length *rope, int32_t told_mm, int64_t since_turns_q16)
{
	rope->told = true;
	rope->doubtful = true;
	rope->told_mm = told_mm;
	rope->since_turns_q16 = since_turns_q16;
	(void)find_told(rope);
}

void lw_rope_length_configure(struct lw_rope_length *rope, const struct lw_rope_geometry *geometry,
			      int64_t net_edges)
{
	if (rope->told) {
		rope->since_turns_q16 += turns_of_q16(&rope->geometry, net_edges) -
					 turns_of_q16(geometry, net_edges);
	}
	rope->geometry = *geometry;
	if (find_told(rope)) {
		rope->doubtful = true;
	}
}

int64_t lw_rope_length_since_q16(const struct lw_rope_length *rope, int64_t net_edges)
{
	return rope->since_turns_q16 + turns_of_q16(&rope->geometry, net_edges);
}

int64_t lw_rope_length_now_q16(const struct lw_rope_length *rope, int64_t net_edges)
{
	return rope->told_turns_q16 + lw_rope_length_since_q16(rope, net_edges);
}

bool lw_rope_length_doubtful(const struct lw_rope_length *rope)
{
	return rope->geometry.core_um_q16 != 0 && (!rope->told || rope->doubtful);
}

void lw_rope_length_tick(struct lw_rope_length *rope, int64_t net_edges, bool edges_lost)
{
	/* More than a turn off a bare drum: there was more rope than was told. */
	if (edges_lost || (lw_rope_length_known(rope) &&
			   lw_rope_length_now_q16(rope, net_edges) < -LW_ROPE_TURN)) {
		rope->doubtful = true;
	}
}
