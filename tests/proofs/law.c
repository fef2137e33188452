/* SPDX-License-Identifier: Apache-2.0 */
#include "orbit.h"

#include "lw/motion/law.h"

/*@
  axiomatic conversions {
    axiom uint32_below: \forall integer x;
      -0x100000000 <= x < 0 ==> (uint32_t)x == x + 0x100000000;
    axiom uint32_above: \forall integer x;
      0x100000000 <= x < 0x200000000 ==> (uint32_t)x == x - 0x100000000;
    axiom int32_above: \forall integer x;
      0x80000000 <= x < 0x180000000 ==> (int32_t)x == x - 0x100000000;
    axiom uint16_of_uint32: \forall integer x;
      0 <= x < 0x100000000 ==> (uint16_t)x == x % 65536;
  }

  // What the law keeps, as plain numbers: begin and end of the sweep, and the position.
  logic integer begin(struct lw_law *law) = 0x80000000 - law->below_from;
  logic integer end(struct lw_law *law) = begin(law) + law->span;
  logic integer m(struct lw_law *law) =
    begin(law) + law->rel - (law->rel >= law->below_from ? 0x100000000 : 0);

  predicate window(struct lw_law *law) =
    0 < law->span < law->below_from && begin(law) % 65536 == 0 && 1 <= law->ka <= 65535;

  // Whole microsteps, rounded down: the sum is never negative.
  logic integer pos(integer m) = (m + 0x80000000) / 65536 - 32768;

  lemma multiple: \forall integer k, r;
    r >= 0 && r + 65536 * k >= 0 ==> (r + 65536 * k) % 65536 == r % 65536;
  lemma fraction: \forall struct lw_law *law;
    window(law) ==> m(law) == 65536 * pos(m(law)) + law->rel % 65536;

  // One edge by doc/control-law.md, section 2.
  logic integer u_then(struct lw_law *law, integer dd) =
    u_next(begin(law), end(law), law->ka, m(law), law->u, dd);
  logic integer m_then(struct lw_law *law, integer dd) =
    m_next(begin(law), end(law), law->ka, m(law), law->u, dd);

  predicate room(struct lw_law *law, integer dd) =
    -65535 <= law->u <= 65535 && -65535 <= u_then(law, dd) <= 65535 &&
    -0x80000000 <= m_then(law, dd) <= 0x7FFFFFFF;

  // Its dwell: the window's, and a triangle over the number of the cycle.
  logic integer adds(integer edges, integer cycles, integer cycle) =
    cycles < 2 ? 0 : edges * (cycle < cycles - cycle ? cycle : cycles - cycle) / (cycles / 2);

  logic integer cycle_next(integer cycles, integer cycle, integer dd) =
    cycles < 2 ? cycle :
    dd > 0 ? (cycle + 1 < cycles ? cycle + 1 : 0) : (cycle > 0 ? cycle - 1 : cycles - 1);

  predicate breaker(struct lw_law *law) =
    law->dwell_plus_edges <= 40000000 && law->dwell_minus_edges <= 40000000 &&
    law->breaker_edges <= 8000000 && law->breaker_cycles <= 200 &&
    (law->breaker_cycles >= 2 ==>
      law->cycle_plus < law->breaker_cycles && law->cycle_minus < law->breaker_cycles) &&
    (law->dwells == 0 ==>
      law->dwell_plus_edges == 0 && law->dwell_minus_edges == 0 && law->breaker_cycles == 0) &&
    // These two follow: adds_a_part().
    0 <= adds(law->breaker_edges, law->breaker_cycles, law->cycle_plus) &&
    0 <= adds(law->breaker_edges, law->breaker_cycles, law->cycle_minus);

  logic integer dwell_plus(struct lw_law *law) =
    law->dwell_plus_edges + adds(law->breaker_edges, law->breaker_cycles, law->cycle_plus);
  logic integer dwell_minus(struct lw_law *law) =
    law->dwell_minus_edges + adds(law->breaker_edges, law->breaker_cycles, law->cycle_minus);

  logic integer dwell_at(struct lw_law *law, integer m) =
    m < begin(law) ? dwell_minus(law) : m >= end(law) ? dwell_plus(law) : 0;

  predicate dwell(struct lw_law *law) =
    breaker(law) && law->dwell_edges <= (law->u == 0 ? dwell_at(law, m(law)) : 0);

  predicate rests(struct lw_law *law, integer dd) =
    law->u == 0 &&
    (dd > 0 ? law->dwell_edges < dwell_at(law, m(law)) : law->dwell_edges > 0);

  // The far point that an edge which does not rest passes: forward it leaves one, back it comes
  // to one.
  logic integer passes_at(struct lw_law *law, integer dd) = dd > 0 ? m(law) : m_then(law, dd);
  predicate passes(struct lw_law *law, integer dd) =
    !rests(law, dd) && (dd > 0 ? law->u : u_then(law, dd)) == 0 &&
    (passes_at(law, dd) < begin(law) || passes_at(law, dd) >= end(law));
  predicate passes_plus(struct lw_law *law, integer dd) =
    passes(law, dd) && passes_at(law, dd) >= end(law);
  predicate passes_minus(struct lw_law *law, integer dd) =
    passes(law, dd) && passes_at(law, dd) < begin(law);
*/

/*@
  assigns \nothing;
  ensures \result == pos(m);
*/
static inline int32_t lw_law_pos_usteps(int32_t m);

/*@
  requires \valid_read(law) && law->below_from > 0;
  assigns \nothing;
  ensures \result == m(law);
*/
static inline int32_t lw_law_m(const struct lw_law *law);

/*@
  requires \valid(law);
  assigns law->cycle_plus, law->cycle_minus;
  ensures law->cycle_plus == 0 && law->cycle_minus == 0;
*/
static inline void lw_law_begin_cycles(struct lw_law *law);

/*@
  requires \valid(law) && \valid_read(window) && \separated(law, window);
  requires law->below_from > 0 && INT32_MIN < window->sweep_begin < window->sweep_end;
  assigns *law;
  ensures m(law) == \old(m(law)) && law->u == \old(law->u);
  ensures begin(law) == window->sweep_begin;
  ensures end(law) == window->sweep_end;
  ensures law->below_from > 0 && law->ka == window->ka;
  ensures law->breaker_cycles == \old(law->breaker_cycles) ?
    law->cycle_plus == \old(law->cycle_plus) && law->cycle_minus == \old(law->cycle_minus) :
    law->cycle_plus == 0 && law->cycle_minus == 0;
*/
static inline void lw_law_use(struct lw_law *law, const struct lw_law_window *window);

/*@
  requires \valid_read(window) && INT32_MIN < window->sweep_begin < window->sweep_end;
  assigns \nothing;
  ensures 0x80000000 - \result.below_from == window->sweep_begin;
  ensures window->sweep_begin + \result.span == window->sweep_end;
  ensures \result.u == u;
  ensures \result.ka == window->ka;
*/
static inline struct lw_law lw_law_at(const struct lw_law_window *window, int32_t m, int32_t u);

/*@
  requires \valid_read(window) && window->sweep_begin < window->sweep_end;
  assigns \nothing;
  ensures \result == region(window->sweep_begin, window->sweep_end, m);
*/
static inline int lw_law_region(const struct lw_law_window *window, int32_t m);

/*@
  requires \valid_read(law) && window(law);
  assigns \nothing;
  ensures \result == (at >= law->below_from ? law->ka : -law->ka);
*/
static inline int32_t lw_law_slope_change(const struct lw_law *law, uint32_t at);

/*@
  requires \valid(law) && window(law) && (dd == 1 || dd == -1) && room(law, dd);
  requires span == law->span || span == 0;
  assigns law->rel, law->u, law->turned;
  ensures span != 0 ==> m(law) == \old(m_then(law, dd)) && law->u == \old(u_then(law, dd));
  ensures span != 0 ==> \result == pos(m(law)) - \old(pos(m(law))) && -1 <= \result <= 1;
  ensures span == 0 ==> law->rel == \old(law->rel) && law->u == \old(law->u);
  ensures span == 0 ==> \result == LW_LAW_CLOSED;
*/
static inline int lw_law_short_edge(struct lw_law *law, uint32_t span, int dd);

/*@
  requires edges <= 8000000 && cycles <= 200 && (cycles >= 2 ==> cycle < cycles);
  assigns \nothing;
  ensures 0 <= adds(edges, cycles, cycle) <= edges;
*/
static void adds_a_part(uint32_t edges, uint32_t cycles, uint32_t cycle)
{
	//@ assert cycles >= 2 ==> edges * (cycle < cycles - cycle ? cycle : cycles - cycle) >= 0;
}

/*@
  requires \valid_read(law) && breaker(law);
  requires law->breaker_cycles >= 2 ==> cycle < law->breaker_cycles;
  assigns \nothing;
  ensures triangle: \result == adds(law->breaker_edges, law->breaker_cycles, cycle);
  ensures \result <= 8000000;
*/
static uint32_t breaker_adds(const struct lw_law *law, uint32_t cycle);

/*@
  requires \valid_read(law) && breaker(law);
  assigns \nothing;
  ensures \result == (minus ? dwell_minus(law) : dwell_plus(law)) && \result <= 48000000;
*/
static uint32_t dwell_of(const struct lw_law *law, bool minus);

/*@
  requires \valid_read(law) && breaker(law) && (dd == 1 || dd == -1);
  requires law->breaker_cycles >= 2 ==> cycle < law->breaker_cycles;
  assigns \nothing;
  ensures \result == cycle_next(law->breaker_cycles, cycle, dd);
  ensures law->breaker_cycles >= 2 ==> \result < law->breaker_cycles;
*/
static uint32_t cycle_then(const struct lw_law *law, uint32_t cycle, int dd);

/*@
  requires \valid(law) && breaker(law) && (dd == 1 || dd == -1);
  assigns law->cycle_plus, law->cycle_minus;
  ensures breaker(law);
  ensures law->cycle_plus ==
    (minus ? \old(law->cycle_plus) : \old(cycle_next(law->breaker_cycles, law->cycle_plus, dd)));
  ensures law->cycle_minus ==
    (minus ? \old(cycle_next(law->breaker_cycles, law->cycle_minus, dd)) : \old(law->cycle_minus));
*/
static void pass_far_point(struct lw_law *law, bool minus, int dd);

/*@
  requires \valid(law) && window(law) && (dd == 1 || dd == -1) && room(law, dd) && dwell(law);
  assigns law->dwell_edges, law->cycle_plus, law->cycle_minus;
  ensures m_then(law, dd) == \old(m_then(law, dd)) && u_then(law, dd) == \old(u_then(law, dd));
  ensures breaker(law);
  ensures \result <==> \old(rests(law, dd));
  ensures \old(rests(law, dd)) ==> law->dwell_edges == \old(law->dwell_edges) + dd;
  ensures \old(rests(law, dd)) ==> law->dwell_edges <= dwell_at(law, m(law));
  ensures \old(!rests(law, dd)) ==>
    law->dwell_edges == (dd < 0 && u_then(law, dd) == 0 ? dwell_at(law, m_then(law, dd)) : 0);
  ensures \old(passes_plus(law, dd)) ==>
    law->cycle_plus == \old(cycle_next(law->breaker_cycles, law->cycle_plus, dd));
  ensures \old(!passes_plus(law, dd)) ==> law->cycle_plus == \old(law->cycle_plus);
  ensures \old(passes_minus(law, dd)) ==>
    law->cycle_minus == \old(cycle_next(law->breaker_cycles, law->cycle_minus, dd));
  ensures \old(!passes_minus(law, dd)) ==> law->cycle_minus == \old(law->cycle_minus);
*/
bool lw_law_rests(struct lw_law *law, int dd);

/*@
  requires \valid(law) && window(law) && (dd == 1 || dd == -1) && room(law, dd) && dwell(law);
  assigns law->rel, law->u, law->turned, law->dwell_edges, law->cycle_plus, law->cycle_minus;
  ensures law->below_from == \old(law->below_from) && law->span == \old(law->span);
  ensures law->ka == \old(law->ka);
  ensures breaker(law);
  ensures law->dwell_edges <= (law->u == 0 ? dwell_at(law, m(law)) : 0);
  ensures begin(law) == \old(begin(law)) && end(law) == \old(end(law));
  ensures \result == pos(m(law)) - \old(pos(m(law))) && -1 <= \result <= 1;
  ensures \old(passes_plus(law, dd)) ==>
    law->cycle_plus == \old(cycle_next(law->breaker_cycles, law->cycle_plus, dd));
  ensures \old(!passes_plus(law, dd)) ==> law->cycle_plus == \old(law->cycle_plus);
  ensures \old(passes_minus(law, dd)) ==>
    law->cycle_minus == \old(cycle_next(law->breaker_cycles, law->cycle_minus, dd));
  ensures \old(!passes_minus(law, dd)) ==> law->cycle_minus == \old(law->cycle_minus);
  behavior resting:
    assumes rests(law, dd);
    ensures m(law) == \old(m(law)) && law->u == \old(law->u);
    ensures law->dwell_edges == \old(law->dwell_edges) + dd;
  behavior moving:
    assumes !rests(law, dd);
    ensures m(law) == \old(m_then(law, dd)) && law->u == \old(u_then(law, dd));
    ensures law->dwell_edges == (dd < 0 && law->u == 0 ? dwell_at(law, m(law)) : 0);
*/
static inline int lw_law_edge(struct lw_law *law, int dd);

/* Its own annotations need what stands above. */
#include "../../lib/lw_core/src/motion/law.c"

/*@
  requires \valid(law) && window(law) && (dd == 1 || dd == -1) && dwell(law);
  requires -65535 <= law->u <= 65535 && -65535 <= law->u - law->ka && law->u + law->ka <= 65535;
  requires -0x7FFC0000 <= m(law) <= 0x7FFBFFFF;
  assigns *law;
  ensures law->rel == \old(law->rel) && law->u == \old(law->u);
  ensures law->dwell_edges == \old(law->dwell_edges);
  ensures law->cycle_plus == \old(law->cycle_plus);
  ensures law->cycle_minus == \old(law->cycle_minus);
  ensures \result == 0;
*/
int there_and_back(struct lw_law *law, int dd)
{
	const int32_t from = lw_law_m(law);
	const int32_t u = law->u;
	const int there = lw_law_edge(law, dd);
	int back;

	//@ assert \at(rests(law, dd), Pre) ==> law->cycle_plus == \at(law->cycle_plus, Pre);
	//@ assert \at(rests(law, dd), Pre) ==> law->cycle_minus == \at(law->cycle_minus, Pre);
	//@ assert \at(rests(law, dd), Pre) ==> rests(law, -dd);
	//@ assert \at(!rests(law, dd), Pre) ==> u_then(law, -dd) == u;
	//@ assert \at(!rests(law, dd), Pre) ==> m_then(law, -dd) == from;
	//@ assert \at(!rests(law, dd), Pre) ==> !rests(law, -dd);
	//@ assert \at(passes_plus(law, dd), Pre) <==> passes_plus(law, -dd);
	//@ assert \at(passes_minus(law, dd), Pre) <==> passes_minus(law, -dd);
	back = lw_law_edge(law, -dd);
	//@ assert law->cycle_plus == \at(law->cycle_plus, Pre);
	//@ assert law->cycle_minus == \at(law->cycle_minus, Pre);
	//@ assert dwell_at(law, m(law)) == \at(dwell_at(law, m(law)), Pre);
	return there + back;
}

/** Any direction that the drum may turn next. */
/*@
  assigns \nothing;
  ensures \result == 1 || \result == -1;
*/
int any_direction(void);

/*@
  predicate parameters(struct lw_law *law, integer nr) =
    window(law) && accepted(begin(law), end(law), law->ka, nr);

  predicate on_orbit(struct lw_law *law, integer nr, integer d) =
    orbit(begin(law), end(law), law->ka, nr, m(law), law->u, d) && dwell(law);

  predicate bounded(struct lw_law *law, integer nr) =
    -(law->ka * nr) <= law->u <= law->ka * nr &&
    (begin(law) <= m(law) < end(law) ==> law->u == law->ka * nr || law->u == -(law->ka * nr)) &&
    2 * (m(law) - end(law)) < run(law->ka, nr, 0) + 2 * (law->ka * nr) &&
    2 * (begin(law) - m(law)) <= run(law->ka, nr, 0) + 2 * (law->ka * nr);
*/

/*@
  requires \valid(law) && \valid(d) && \separated(law, d) && (dd == 1 || dd == -1);
  requires parameters(law, nr) && on_orbit(law, nr, *d);
  assigns law->rel, law->u, law->turned, law->dwell_edges, law->cycle_plus, law->cycle_minus, *d;
  ensures parameters(law, nr);
  ensures on_orbit(law, nr, *d);
  ensures bounded(law, nr);
  ensures -1 <= \result <= 1;
*/
int orbit_edge(struct lw_law *law, int nr, int *d, int dd)
{
	const int first = (int)(0x80000000LL - law->below_from);
	const int last = (int)(0x80000000LL - law->below_from + law->span);
	const int ka = law->ka;
	const int from = lw_law_m(law);
	const int u = law->u;
	int step;

	//@ assert first == begin(law) && last == end(law);
	orbit_is_kept(first, last, ka, nr, from, u, *d, dd);
	step = lw_law_edge(law, dd);
	//@ assert first == begin(law) && last == end(law);
	if (lw_law_m(law) != from || law->u != u) {
		const int from_d = *d;

		*d += (law->u > u) - (law->u < u);
		orbit_is_reached(first, last, ka, nr, from, u, from_d, dd, lw_law_m(law), law->u,
				 *d);
	}
	//@ assert orbit(first, last, ka, nr, m(law), law->u, *d);
	orbit_is_kept(first, last, ka, nr, lw_law_m(law), law->u, *d, dd);
	//@ assert first == begin(law) && last == end(law) && ka == law->ka;
	//@ assert accepted(begin(law), end(law), law->ka, nr);
	return step;
}

/*@
  requires \valid(law) && parameters(law, nr) && on_orbit(law, nr, d);
  assigns *law;
*/
void any_motion(struct lw_law *law, int nr, int d)
{
	int place = d;

	/*@
	  loop invariant parameters(law, nr) && on_orbit(law, nr, place);
	  loop assigns *law, place;
	*/
	for (;;) {
		orbit_edge(law, nr, &place, any_direction());
		//@ assert bounded(law, nr);
	}
}

/*
 * A carriage that takes up a turning drum from rest begins at a far point
 * (lw_move_from_far_point()), and is on the orbit from there on, whatever the drum does.
 */
/*@
  requires \valid(law) && parameters(law, nr) && breaker(law);
  requires law->u == 0 && law->dwell_edges == 0;
  requires 2 * (begin(law) - m(law)) == law->ka * (nr * (nr + 1)) ||
    2 * (m(law) - end(law)) == law->ka * (nr * (nr - 1));
  assigns *law;
*/
void from_far_point(struct lw_law *law, int nr)
{
	const int first = (int)(0x80000000LL - law->below_from);
	const int last = (int)(0x80000000LL - law->below_from + law->span);

	//@ assert first == begin(law) && last == end(law);
	far_point_is_on_orbit(first, last, law->ka, nr, lw_law_m(law));
	//@ assert on_orbit(law, nr, 0);
	any_motion(law, nr, 0);
}
