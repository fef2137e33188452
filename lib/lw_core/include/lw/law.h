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
 * What the law works with. Never changed while a motion uses it; lw/motion.h hands over another.
 */
struct lw_law_window {
	int32_t ka;                 /**< slope change per edge in a reversal, Q16.16, >= 1 */
	int32_t ks;                 /**< slope in the sweep, Q16.16, ka * Nr, 1..65535 */
	int32_t sweep_begin;        /**< first position of the sweep, Q16.16: (L- + 1) * 65536;
				     *   above INT32_MIN, below sweep_end */
	int32_t sweep_end;          /**< first position past the sweep, Q16.16: L+ * 65536 */
	uint32_t dwell_plus_edges;  /**< edges to rest at the far point of the plus reversal */
	uint32_t dwell_minus_edges; /**< edges to rest at the far point of the minus reversal */
};

/**
 * The state that an edge changes and what it needs for that, ordered so that few instructions load
 * and store it. Belongs to whoever takes the edges, see lw/motion.h.
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
	uint32_t dwell_edges;       /**< edges rested so far at the far point; 0 elsewhere */
	uint32_t dwell_plus_edges;  /**< of the window */
	uint32_t dwell_minus_edges; /**< of the window */
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

/** Go on in another window, with the position, slope and dwell that are. For the law's owner. */
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

/** Does this edge count a dwell and nothing else? Then it is taken. For lw_law_edge(). */
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
	if ((law->dwell_plus_edges | law->dwell_minus_edges) != 0 && lw_law_rests(law, dd)) {
		return 0;
	}
	return lw_law_short_edge(law, law->span, dd);
}

#endif /* LW_LAW_H */
