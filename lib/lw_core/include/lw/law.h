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
 */
#ifndef LW_LAW_H
#define LW_LAW_H

#include <stdint.h>

/** One microstep in the Q16.16 format of positions and slopes. */
#define LW_USTEP 65536

/**
 * What the law works with. Constant while a motion uses it; replaced by a pointer swap
 * (lw/motion.h), never changed in place.
 */
struct lw_law_window {
	int32_t ka;                 /**< slope change per edge in a reversal, Q16.16, >= 1 */
	int32_t ks;                 /**< slope in the sweep, Q16.16, ka * Nr, 1..65535 */
	int32_t sweep_begin;        /**< first position of the sweep, Q16.16: (L- + 1) * 65536 */
	int32_t sweep_end;          /**< first position past the sweep, Q16.16: L+ * 65536 */
	uint32_t dwell_plus_edges;  /**< edges to rest at the far point of the plus reversal */
	uint32_t dwell_minus_edges; /**< edges to rest at the far point of the minus reversal */
};

/** The state that an edge changes. */
struct lw_law {
	int32_t m; /**< position, Q16.16 microsteps */
	int32_t u; /**< slope: microsteps that a FORWARD edge moves the carriage, Q16.16 */
	uint32_t dwell_edges; /**< edges rested so far at the far point; 0 elsewhere */
};

/** Whole microsteps of a Q16.16 position, rounded toward minus infinity. Interrupt safe. */
static inline int32_t lw_law_pos_usteps(int32_t m)
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

/**
 * Take one edge. For the edge interrupt.
 *
 * No step is lost or doubled: the steps of any run of edges add up to the change of
 * lw_law_pos_usteps(). Does not overflow for any window that lw_params_derive() accepts.
 *
 * @param dd drum direction of this edge, +1 forward (rope in) or -1 backward
 * @return the step to give: +1, 0 or -1 (P6)
 */
static inline int lw_law_edge(struct lw_law *law, const struct lw_law_window *window, int dd)
{
	const int32_t before = law->m;

	if (law->u == 0) {
		/* The far point of a reversal: count the dwell up going forward, down going back.
		 */
		const uint32_t dwell_edges = law->m >= window->sweep_end
						     ? window->dwell_plus_edges
						     : window->dwell_minus_edges;

		if (dd > 0 && law->dwell_edges < dwell_edges) {
			law->dwell_edges++;
			return 0;
		}
		if (dd < 0 && law->dwell_edges > 0) {
			law->dwell_edges--;
			return 0;
		}
		law->dwell_edges = 0;
	}

	if (dd > 0) {
		law->u += lw_law_region(window, law->m) * window->ka;
		law->m += law->u;
	} else {
		law->m -= law->u;
		law->u -= lw_law_region(window, law->m) * window->ka;
		if (law->u == 0) {
			/* Back at a far point: its whole dwell lies between here and the entry. */
			law->dwell_edges = law->m >= window->sweep_end ? window->dwell_plus_edges
								       : window->dwell_minus_edges;
		}
	}

	return (int)(lw_law_pos_usteps(law->m) - lw_law_pos_usteps(before));
}

#endif /* LW_LAW_H */
