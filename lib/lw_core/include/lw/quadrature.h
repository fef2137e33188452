/**
 * @file
 * Quadrature decoding of the drum encoder, for 1, 2 or 4 edges per pulse.
 */
#ifndef LW_QUADRATURE_H
#define LW_QUADRATURE_H

#include <stdbool.h>
#include <stdint.h>

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
	uint8_t levels; /**< last levels, A in bit 1, B in bit 0 */
	uint32_t
		illegal_transitions; /**< both channels changed at once; written by the interrupt */
};

/** Levels as the decoder sees them: A in bit 1, B in bit 0, inversions applied. */
static inline uint8_t lw_quadrature_levels(const struct lw_quadrature_config *config, bool a,
					   bool b)
{
	return (uint8_t)(((a != config->invert_a) << 1) | (b != config->invert_b));
}

/** Start from the present levels. */
static inline void lw_quadrature_init(struct lw_quadrature *quadrature,
				      const struct lw_quadrature_config *config, bool a, bool b)
{
	quadrature->levels = lw_quadrature_levels(config, a, b);
	quadrature->illegal_transitions = 0;
}

/**
 * Take the levels after a transition of either channel. For the encoder interrupt.
 *
 * A leads B in the forward direction: (A,B) = 00, 10, 11, 01, 00. Every mode counts a transition
 * and its reverse alike, so a dither about one edge nets to zero. A change of both channels at
 * once is illegal: counted, no motion.
 *
 * @return +1 forward edge, -1 backward edge, 0 no edge in this mode
 */
static inline int lw_quadrature_update(struct lw_quadrature *quadrature,
				       const struct lw_quadrature_config *config, bool a, bool b)
{
	const uint8_t levels = lw_quadrature_levels(config, a, b);
	const uint8_t changed = levels ^ quadrature->levels;
	/* Forward: A changes and then differs from B, or B changes and then equals A. */
	const bool equal = (levels >> 1) == (levels & 1);
	int dd;

	quadrature->levels = levels;
	if (changed == 3) {
		quadrature->illegal_transitions++;
		return 0;
	}
	if (changed == 0) {
		return 0;
	}
	if (changed == 2) {
		if (config->edges_per_pulse == 1 && (levels & 1)) {
			return 0;
		}
		dd = equal ? -1 : 1;
	} else {
		if (config->edges_per_pulse != 4) {
			return 0;
		}
		dd = equal ? 1 : -1;
	}
	return config->invert_direction ? -dd : dd;
}

#endif /* LW_QUADRATURE_H */
