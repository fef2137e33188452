/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What the tests of the law share: windows, and the orbit of doc/control-law.md section 2.
 */
#ifndef LAW_CHECK_H
#define LAW_CHECK_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/motion/law.h"

/** A window from the quantities of the design: L+ and L- in microsteps. */
static inline struct lw_law_window law_window(int32_t ka, int32_t nr, int32_t plus_usteps,
					      int32_t minus_usteps)
{
	return (struct lw_law_window){
		.ka = ka,
		.ks = ka * nr,
		.sweep_begin = (minus_usteps + 1) * LW_USTEP,
		.sweep_end = plus_usteps * LW_USTEP,
	};
}

/** Way past its entry that a reversal has made after j edges. */
static inline int64_t law_reversal_way(const struct lw_law_window *window, int64_t j)
{
	const int64_t nr = window->ks / window->ka;

	return window->ka * j * (2 * nr - 1 - j) / 2;
}

/** Dwell at a far point, edges: the window's, and a triangle of the cycle's number on top. */
static inline uint32_t law_dwell_edges(const struct lw_law_window *window, bool at_plus,
				       uint32_t cycle)
{
	const uint32_t top = window->breaker_cycles / 2;
	uint32_t steps = 0;

	for (uint32_t k = 1; k <= cycle; k++) {
		steps += k <= top ? 1u : k > window->breaker_cycles - top ? -1u : 0u;
	}
	return (at_plus ? window->dwell_plus_edges : window->dwell_minus_edges) +
	       (top > 0 ? (uint32_t)((uint64_t)window->breaker_edges * steps / top) : 0);
}

/** Is the state one of those that the pattern can reach? The inductive invariant of the law. */
static inline bool law_on_orbit(const struct lw_law *law, const struct lw_law_window *window)
{
	const int64_t m = lw_law_m(law);
	const int64_t end = window->sweep_end;
	const int64_t begin = window->sweep_begin;
	const int64_t ks = window->ks;
	const bool at_plus = m >= end;

	if (law->dwell_edges != 0 &&
	    (law->u != 0 ||
	     law->dwell_edges > law_dwell_edges(window, at_plus,
						at_plus ? law->cycle_plus : law->cycle_minus))) {
		return false;
	}
	if ((law->u == ks || law->u == -ks) && begin <= m && m < end) {
		return true;
	}
	if (law->u > ks || law->u < -ks || (ks - law->u) % window->ka != 0) {
		return false;
	}

	const int64_t plus = m - law_reversal_way(window, (ks - law->u) / window->ka);
	const int64_t minus = m + law_reversal_way(window, (law->u + ks) / window->ka);

	return (end <= plus && plus < end + ks) || (begin - ks <= minus && minus < begin);
}

static inline bool law_same(const struct lw_law *a, const struct lw_law *b)
{
	return lw_law_m(a) == lw_law_m(b) && a->u == b->u && a->dwell_edges == b->dwell_edges &&
	       a->cycle_plus == b->cycle_plus && a->cycle_minus == b->cycle_minus;
}

/** A small generator of numbers that look random, the same on every machine (Knuth's MMIX). */
static inline uint32_t next_random(uint64_t *state)
{
	*state = *state * 6364136223846793005u + 1442695040888963407u;
	return (uint32_t)(*state >> 32);
}

#endif /* LAW_CHECK_H */
