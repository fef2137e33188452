/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The control law: a reversing screw in integer arithmetic, one call per encoder edge.
 *
 *     region(m) = -1 where m >= sweep_end, +1 where m < sweep_begin, else 0
 *     forward edge:   u += region(m) * ka;  m += u
 *     backward edge:  m -= u;  u -= region(m) * ka
 *
 * The backward edge does the inverse operations in the inverse order, so it undoes a forward edge
 * bit for bit: the state depends on the net number of edges only, and no sequence of drum motion
 * can make the pattern drift. doc/control-law.md derives it and names its properties P1 to P8.
 *
 * An edge costs a dozen instructions because the position is kept from the begin of the sweep on,
 * modulo 2^32: one unsigned comparison tells the sweep from all else. The begin being a whole
 * microstep, a step is the carry out of the position's fraction.
 */
#ifndef LW_LAW_H
#define LW_LAW_H

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>

/** For what an edge does: the interrupt takes it in even where code is built for size. */
#ifndef LW_EDGE_INLINE
#define LW_EDGE_INLINE static inline __attribute__((always_inline))
#endif

/** One microstep in the Q16.16 format of positions and slopes. */
#define LW_USTEP 65536

/**
 * What the law works with. Never changed while a motion uses it; lw/motion/motion.h hands over
 * another.
 */
struct lw_law_window {
	int32_t ka;          /**< slope change per edge in a reversal, Q16.16, >= 1 */
	int32_t ks;          /**< slope in the sweep, Q16.16, ka * Nr, 1..65535 */
	int32_t sweep_begin; /**< first position of the sweep, Q16.16: (L- + 1) * 65536;
			      *   above INT32_MIN, below sweep_end */
	int32_t sweep_end;   /**< first position past the sweep, Q16.16: L+ * 65536 */
	/** Edges to rest at the far point of the plus reversal, at most LW_LAW_DWELL_EDGES_MAX. */
	uint32_t dwell_plus_edges;
	uint32_t dwell_minus_edges; /**< those at the far point of the minus reversal */
	/** Ribbon breaker: most that it adds to a dwell, edges; 0: off. At most
	 *  LW_LAW_BREAKER_EDGES_MAX. */
	uint32_t breaker_edges;
	/** Ribbon breaker: reversals of a side until it begins anew, up to
	 * LW_LAW_BREAKER_CYCLES_MAX; below 2: off. */
	uint32_t breaker_cycles;
};

/** Ten drum revolutions of the finest encoder. */
#define LW_LAW_DWELL_EDGES_MAX    40000000u
/** Two of them; times half of the cycles it fits into 32 bit. */
#define LW_LAW_BREAKER_EDGES_MAX  8000000u
#define LW_LAW_BREAKER_CYCLES_MAX 200u

/**
 * The state that an edge changes and what it needs for that, ordered so that few instructions load
 * and store it. Belongs to whoever takes the edges, see lw/motion/motion.h.
 */
struct lw_law {
	uint32_t rel; /**< position less sweep_begin, Q16.16 microsteps modulo 2^32 */
	int32_t u;    /**< slope: microsteps that a FORWARD edge moves the carriage, Q16.16 */
	/** Slope change last made, +ka in the minus and -ka in the plus reversal; for its reader
	 *  to clear. */
	int32_t turned;
	/** Length of the sweep while an edge has nothing to do but lw_law_short_edge(), else 0. */
	uint32_t open_span;
	int32_t ka; /**< slope change per edge in a reversal, Q16.16 */
	/** `rel` of the position INT32_MIN: from it on, `rel` lies before the sweep. */
	uint32_t below_from;
	uint32_t span;              /**< length of the sweep, Q16.16, >= 1 */
	uint32_t dwells;            /**< 0: no dwell anywhere, lw_law_rests() has nothing to do */
	uint32_t dwell_edges;       /**< edges rested so far at the far point; 0 elsewhere */
	uint32_t dwell_plus_edges;  /**< of the window */
	uint32_t dwell_minus_edges; /**< of the window */
	uint32_t breaker_edges;     /**< of the window */
	uint32_t breaker_cycles;    /**< of the window */
	/** Far points of the plus side that have been passed, net, modulo breaker_cycles; 0 without
	 *  a breaker. */
	uint32_t cycle_plus;
	uint32_t cycle_minus; /**< those of the minus side */
};

/** Whole microsteps of a Q16.16 position, rounded toward minus infinity. Interrupt safe. */
LW_EDGE_INLINE int32_t lw_law_pos_usteps(int32_t m)
{
	return m >> 16;
}

/**
 * Where in the pattern a position is. Interrupt safe.
 *
 * @retval -1 in the reversal at the plus side: the slope falls
 * @retval 0 in the sweep
 * @retval 1 in the reversal at the minus side: the slope rises
 */
static inline int lw_law_region(const struct lw_law_window *window, int32_t m)
{
	return (m < window->sweep_begin) - (m >= window->sweep_end);
}

/** Position, Q16.16 microsteps. For the law's owner; others use lw_motion_m(). */
static inline int32_t lw_law_m(const struct lw_law *law)
{
	return (int32_t)(law->rel - law->below_from + (uint32_t)INT32_MIN);
}

/** The ribbon breaker begins with its first cycle at the next far points. For the law's owner. */
static inline void lw_law_begin_cycles(struct lw_law *law)
{
	law->cycle_plus = 0;
	law->cycle_minus = 0;
}

/**
 * Go on in another window, with the position, slope and dwell that are, and with the numbers of the
 * cycle unless the ribbon breaker is another. For the law's owner.
 */
static inline void lw_law_use(struct lw_law *law, const struct lw_law_window *window)
{
	const uint32_t m = (uint32_t)lw_law_m(law);

	law->rel = m - (uint32_t)window->sweep_begin;
	law->below_from = (uint32_t)INT32_MIN - (uint32_t)window->sweep_begin;
	law->span = (uint32_t)window->sweep_end - (uint32_t)window->sweep_begin;
	law->open_span = 0;
	law->ka = window->ka;
	law->dwell_plus_edges = window->dwell_plus_edges;
	law->dwell_minus_edges = window->dwell_minus_edges;
	law->breaker_edges = window->breaker_edges;
	law->dwells = window->dwell_plus_edges + window->dwell_minus_edges + window->breaker_edges;
	if (law->breaker_cycles != window->breaker_cycles) {
		law->breaker_cycles = window->breaker_cycles;
		law->cycle_plus = 0;
		law->cycle_minus = 0;
	}
}

/**
 * A law at a position.
 *
 * @param m Q16.16
 * @param u slope, -ks to ks; 0 in a reversal only, in the sweep it would never move
 */
static inline struct lw_law lw_law_at(const struct lw_law_window *window, int32_t m, int32_t u)
{
	/* This below_from is that of a sweep which begins at 0. */
	struct lw_law law = {.rel = (uint32_t)m, .u = u, .below_from = (uint32_t)INT32_MIN};

	lw_law_use(&law, window);
	return law;
}

/** What a forward edge adds to the slope at `at`, a place as `rel`, in a reversal. */
LW_EDGE_INLINE int32_t lw_law_slope_change(const struct lw_law *law, uint32_t at)
{
	return at >= law->below_from ? law->ka : -law->ka;
}

/** Nothing was done: lw_law_short_edge() has no span. */
#define LW_LAW_CLOSED INT_MIN

/**
 * Take one edge by the short way, without dwell. For the edge interrupt.
 *
 * @param span length of the sweep
 * @param dd drum direction of this edge, +1 forward (rope in) or -1 backward
 * @return the step to give: +1, 0 or -1
 * @retval LW_LAW_CLOSED `span` is 0, nothing was done
 */
LW_EDGE_INLINE int lw_law_short_edge(struct lw_law *law, uint32_t span, int dd)
{
	const uint32_t rel = law->rel;
	const int32_t u = law->u;

	/*
	 * Every place outside of the sweep is at least `span`, modulo 2^32. The step is the carry
	 * out of the fraction, which is that of the position: the sweep begins at a whole
	 * microstep.
	 */
	if (dd > 0) {
		int32_t moved = u;

		if (rel >= span) {
			if (span == 0) {
				return LW_LAW_CLOSED;
			}

			const int32_t change = lw_law_slope_change(law, rel);

			moved += change;
			law->u = moved;
			law->turned = change;
		}
		law->rel = rel + (uint32_t)moved;
		return lw_law_pos_usteps((int32_t)(uint16_t)rel + moved);
	}

	const uint32_t to = rel - (uint32_t)u;

	if (to >= span) {
		if (span == 0) {
			return LW_LAW_CLOSED;
		}

		const int32_t change = lw_law_slope_change(law, to);

		law->u = u - change;
		law->turned = change;
	}
	law->rel = to;
	return lw_law_pos_usteps((int32_t)(uint16_t)rel - u);
}

/**
 * Does this edge count a dwell and nothing else? Then it is taken. For lw_law_edge().
 *
 * With a ribbon breaker a dwell is longer by what the number of the cycle says, which counts the
 * far points of that side that have been passed: up going forward, down going back.
 */
bool lw_law_rests(struct lw_law *law, int dd);

/**
 * Take one edge. For the edge interrupt.
 *
 * No step is lost or doubled: where the sweep begins at a whole microstep, the steps of any run of
 * edges add up to the change of lw_law_pos_usteps(). Does not overflow for any window that
 * lw_params_derive() accepts.
 *
 * @param dd drum direction of this edge, +1 forward (rope in) or -1 backward
 * @return the step to give: +1, 0 or -1 (P6)
 */
static inline int lw_law_edge(struct lw_law *law, int dd)
{
	if (law->dwells != 0 && lw_law_rests(law, dd)) {
		return 0;
	}
	return lw_law_short_edge(law, law->span, dd);
}

/**
 * Take edges one way together, by the short way, where they all lie in the sweep.
 *
 * There an edge does nothing but add the slope, and a step is a carry out of the fraction: so it is
 * exact to the bit, and so is the way back, edge by edge or together. For the edge interrupt.
 *
 * @param edges positive forward, negative backward; not 0
 * @param steps receives the steps to give, net: they all go one way
 * @return false: not all in the sweep, or the short way is closed; nothing was done
 */
LW_EDGE_INLINE bool lw_law_short_edges(struct lw_law *law, int32_t edges, int32_t *steps)
{
	const uint32_t rel = law->rel;
	const int64_t moved = (int64_t)edges * law->u;
	const int64_t to = (int64_t)rel + moved;

	/* An open span is below 2^32, so that what is inside of it is a place as `rel`. */
	if (rel >= law->open_span || to < 0 || to >= (int64_t)law->open_span) {
		return false;
	}
	law->rel = (uint32_t)to;
	*steps = (int32_t)((uint32_t)to / LW_USTEP - rel / LW_USTEP);
	return true;
}

/**
 * Edges one way to the next one that gives a step, that one included. Until then an edge changes
 * nothing but the fraction of the position, so that whoever counts edges elsewhere may take them
 * together then. For the edge interrupt.
 *
 * In the sweep the slope is constant, and up to the step the position stays in one microstep, which
 * is all in the sweep or all outside: so it is exact. Elsewhere, and where the short way is closed,
 * it says 1, which is never too many.
 *
 * @param dd +1 forward, -1 backward
 */
LW_EDGE_INLINE uint32_t lw_law_edges_to_step(const struct lw_law *law, int dd)
{
	const uint32_t fraction = (uint16_t)law->rel;
	const int32_t moved = dd > 0 ? law->u : -law->u;

	if (law->rel >= law->open_span || moved == 0) {
		return 1;
	}
	return moved > 0 ? (LW_USTEP - 1 - fraction) / (uint32_t)moved + 1
			 : fraction / (0u - (uint32_t)moved) + 1;
}

#endif /* LW_LAW_H */
