/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/motion/law.h"

/** What the ribbon breaker adds to the dwell of a cycle: 0, up to the whole, and down again. */
static uint32_t breaker_adds(const struct lw_law *law, uint32_t cycle)
{
	const uint32_t down = law->breaker_cycles - cycle;

	if (law->breaker_cycles < 2) {
		return 0;
	}
	return law->breaker_edges * (cycle < down ? cycle : down) / (law->breaker_cycles / 2);
}

/** Edges to rest at the far point of a side, in the cycle that is. */
static uint32_t dwell_of(const struct lw_law *law, bool minus)
{
	return minus ? law->dwell_minus_edges + breaker_adds(law, law->cycle_minus)
		     : law->dwell_plus_edges + breaker_adds(law, law->cycle_plus);
}

/** The number of the cycle after a far point that was passed in direction dd. */
static uint32_t cycle_then(const struct lw_law *law, uint32_t cycle, int dd)
{
	if (law->breaker_cycles < 2) {
		return cycle;
	}
	if (dd > 0) {
		return cycle + 1 < law->breaker_cycles ? cycle + 1 : 0;
	}
	return cycle > 0 ? cycle - 1 : law->breaker_cycles - 1;
}

/** A far point of a side is passed in direction dd. */
static void pass_far_point(struct lw_law *law, bool minus, int dd)
{
	if (minus) {
		law->cycle_minus = cycle_then(law, law->cycle_minus, dd);
	} else {
		law->cycle_plus = cycle_then(law, law->cycle_plus, dd);
	}
}

bool lw_law_rests(struct lw_law *law, int dd)
{
	const uint32_t at = dd > 0 ? law->rel : law->rel - (uint32_t)law->u;
	const bool minus = at >= law->below_from;

	if (at < law->span) {
		return false;
	}
	//@ assert minus ==> passes_at(law, dd) < begin(law);
	//@ assert !minus ==> passes_at(law, dd) >= end(law);
	//@ assert dd < 0 ==> u_then(law, dd) == law->u - (minus ? law->ka : -law->ka);
	if (law->u != 0) {
		/* Going back to a far point: its whole dwell lies between there and the entry. */
		if (dd < 0 && law->u == lw_law_slope_change(law, at)) {
			pass_far_point(law, minus, dd);
			law->dwell_edges = dwell_of(law, minus);
			//@ assert law->dwell_edges == dwell_at(law, m_then(law, dd));
		}
		return false;
	}
	/* At the far point the dwell counts up going forward, down going back. */
	if (dd < 0 && law->dwell_edges > 0) {
		law->dwell_edges--;
		return true;
	}
	if (dd > 0 && law->dwell_edges < dwell_of(law, minus)) {
		law->dwell_edges++;
		return true;
	}
	if (dd > 0) {
		pass_far_point(law, minus, dd);
		law->dwell_edges = 0;
	}
	return false;
}
