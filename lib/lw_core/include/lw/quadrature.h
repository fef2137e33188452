/**
 * @file
 * Quadrature decoding of the drum encoder, for 1, 2 or 4 edges per pulse.
 */
#ifndef LW_QUADRATURE_H
#define LW_QUADRATURE_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/law.h"

/** How the encoder is read. */
struct lw_quadrature_config {
	uint8_t edges_per_pulse; /**< 4: every transition; 2: transitions of A; 1: of A while B is
				    low */
	bool invert_a;
	bool invert_b;
	bool invert_direction; /**< swap the sign of the drum */
};

/** Decoder state. */
struct lw_quadrature {
	uint8_t levels;    /**< last levels of the pins, A in bit 1, B in bit 0 */
	int8_t counts[16]; /**< what a transition counts, by levels before * 4 + levels now */
	/** Both channels changed at once; written by the interrupt. */
	uint32_t illegal_transitions;
	/** Nothing had changed: the levels came back, or were seen by the interrupt before. */
	uint32_t late_interrupts;
};

/** Decode as `config` says from now on. A transition meanwhile counts as before or as after. */
void lw_quadrature_configure(struct lw_quadrature *quadrature,
			     const struct lw_quadrature_config *config);

/** Start from the present levels of the pins. */
void lw_quadrature_init(struct lw_quadrature *quadrature, const struct lw_quadrature_config *config,
			bool a, bool b);

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
	const unsigned int now = ((unsigned int)a << 1) | b;
	const unsigned int before = quadrature->levels;
	const int dd = quadrature->counts[before << 2 | now];

	quadrature->levels = (uint8_t)now;
	if (dd == 0) {
		/* Nothing of this for an edge. */
		if ((before ^ now) == 3) {
			quadrature->illegal_transitions++;
		} else if (before == now) {
			quadrature->late_interrupts++;
		}
	}
	return dd;
}

#endif /* LW_QUADRATURE_H */
