/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Quadrature decoding of the drum encoder, for 1, 2 or 4 edges per pulse.
 */
#ifndef LW_QUADRATURE_H
#define LW_QUADRATURE_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/motion/law.h"

/** How the encoder is read. */
struct lw_quadrature_config {
	uint8_t edges_per_pulse; /**< 4: every transition; 2: transitions of A; 1: of A while B is
				    low */
	bool invert_a;
	bool invert_b;
	bool invert_direction; /**< swap the sign of the drum */
};

/** Index of a channel. */
enum lw_quadrature_channel {
	LW_QUADRATURE_A,
	LW_QUADRATURE_B,
};

/** What runs of transitions one way come to. */
struct lw_quadrature_way {
	uint8_t to_edge[4]; /**< transitions to the next edge, that one included, by the levels */
	uint8_t edge;       /**< an edge, as an index of `onward` */
	int8_t dd;          /**< what an edge counts */
};

/**
 * Decoder state. Written by the encoder interrupt but for the tables.
 *
 * `onward` has only the edges that go on in the direction of the last one. So an edge that turns
 * back leaves the short way, where there is time to count it: a channel that changes twice without
 * the other one has turned back, or the other one is dead.
 */
struct lw_quadrature {
	_Alignas(4) int8_t onward[16]; /**< as `counts`, 0 but for the present direction's edges */
	uint8_t levels;                /**< last levels of the pins, A in bit 1, B in bit 0 */
	_Alignas(4) int8_t onwards[2][16]; /**< `onward` for forward and backward edges */
	int8_t counts[16]; /**< what a transition counts, by levels before * 4 + levels now */
	struct lw_quadrature_way ways[2]; /**< [0] while A leads B, [1] while B leads A */
	uint8_t edge_spacing_log2;        /**< transitions from edge to edge, as a power of two */
	/** Both channels changed at once. */
	uint32_t illegal_transitions;
	/** Nothing had changed: the levels came back, or were seen by the interrupt before. */
	uint32_t late_interrupts;
	/** Changes of a channel that were no edge, or an edge the other way, by channel. */
	uint32_t odd_changes[2];
	uint32_t turns; /**< edges the other way than the edge before */
};

/** Decode as `config` says from now on. A transition meanwhile counts as before or as after. */
void lw_quadrature_configure(struct lw_quadrature *quadrature,
			     const struct lw_quadrature_config *config);

/** Start from the present levels of the pins. */
void lw_quadrature_init(struct lw_quadrature *quadrature, const struct lw_quadrature_config *config,
			bool a, bool b);

/** Take a transition that is no edge onward: count what it is. For lw_quadrature_update(). */
int lw_quadrature_odd_update(struct lw_quadrature *quadrature, unsigned int transition);

/**
 * Take the levels of the pins after a transition of either channel, by the short way.
 *
 * @param transition receives levels before * 4 + levels now
 * @return +1 or -1: an edge onward; 0: call lw_quadrature_odd_update()
 */
LW_EDGE_INLINE int lw_quadrature_short_update(struct lw_quadrature *quadrature, bool a, bool b,
					      unsigned int *transition)
{
	const unsigned int now = ((unsigned int)a << 1) | b;

	*transition = (unsigned int)quadrature->levels << 2 | now;
	quadrature->levels = (uint8_t)now;
	return quadrature->onward[*transition];
}

/**
 * Take the levels of the pins after a transition of either channel. For the encoder interrupt.
 *
 * A leads B in the forward direction: (A,B) = 00, 10, 11, 01, 00. Every mode counts a transition
 * and its reverse alike, so a dither about one edge nets to zero. A change of both channels at
 * once is illegal: counted, no motion.
 *
 * @return +1 forward edge, -1 backward edge, 0 no edge in this mode
 */
LW_EDGE_INLINE int lw_quadrature_update(struct lw_quadrature *quadrature, bool a, bool b)
{
	unsigned int transition;
	const int dd = lw_quadrature_short_update(quadrature, a, b, &transition);

	return dd != 0 ? dd : lw_quadrature_odd_update(quadrature, transition);
}

/** The levels that follow, two bits for each of the levels before: A leads B in this direction. */
#define LW_QUADRATURE_ORDER 0x72u

/**
 * The levels of the pins after one more transition of a run that goes one way. For who counts in
 * hardware.
 *
 * @param order LW_QUADRATURE_ORDER, or its complement where B leads A
 */
LW_EDGE_INLINE unsigned int lw_quadrature_next_levels(unsigned int levels, unsigned int order)
{
	return order >> (2 * levels) & 3u;
}

/** Does a run of transitions go on in the direction of the last edge? @param way an index of `ways`
 */
LW_EDGE_INLINE bool lw_quadrature_goes_on(const struct lw_quadrature *quadrature, unsigned int way)
{
	return quadrature->onward[quadrature->ways[way].edge] != 0;
}

/** Edges in a run of transitions. @param way an index of `ways` */
LW_EDGE_INLINE uint32_t lw_quadrature_edges_of_run(const struct lw_quadrature *quadrature,
						   unsigned int way, uint32_t transitions)
{
	const uint32_t first = quadrature->ways[way].to_edge[quadrature->levels];

	return transitions < first ? 0
				   : ((transitions - first) >> quadrature->edge_spacing_log2) + 1;
}

/**
 * Take a run of transitions that goes on, as lw_quadrature_update() would one by one.
 *
 * @param way an index of `ways`
 * @param edges those in it
 */
LW_EDGE_INLINE void lw_quadrature_run(struct lw_quadrature *quadrature, unsigned int way,
				      uint32_t transitions, uint32_t edges)
{
	unsigned int levels = quadrature->levels;
	uint32_t b_changes = transitions / 2;

	/* Both channels change in turn: two transitions change both, four are a pulse. */
	if ((transitions & 1u) != 0) {
		const unsigned int next = lw_quadrature_next_levels(
			levels, way == 0 ? LW_QUADRATURE_ORDER : ~LW_QUADRATURE_ORDER);

		b_changes += (levels ^ next) & 1u;
		levels = next;
	}
	quadrature->levels = (uint8_t)((transitions & 2u) != 0 ? levels ^ 3u : levels);
	if (quadrature->edge_spacing_log2 == 0) {
		return; /* all were edges */
	}
	quadrature->odd_changes[LW_QUADRATURE_B] += b_changes;
	if (quadrature->edge_spacing_log2 == 2) {
		quadrature->odd_changes[LW_QUADRATURE_A] += transitions - b_changes - edges;
	}
}

/** Transitions one way to so many edges, that of the last one included. @param way an index of
 * `ways` */
LW_EDGE_INLINE uint32_t lw_quadrature_transitions(const struct lw_quadrature *quadrature,
						  unsigned int way, uint32_t edges)
{
	return quadrature->ways[way].to_edge[quadrature->levels] +
	       ((edges - 1) << quadrature->edge_spacing_log2);
}

#endif /* LW_QUADRATURE_H */
