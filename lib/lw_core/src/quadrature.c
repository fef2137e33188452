#include "lw/quadrature.h"

/** What a transition counts. Levels A in bit 1, B in bit 0, inversions applied. */
static int count(const struct lw_quadrature_config *config, unsigned int before, unsigned int now)
{
	/* Forward: A changes and then differs from B, or B changes and then equals A. */
	const bool equal = now >> 1 == (now & 1);
	int dd;

	switch (before ^ now) {
	case 2: /* A */
		if (config->edges_per_pulse == 1 && (now & 1)) {
			return 0;
		}
		dd = equal ? -1 : 1;
		break;
	case 1: /* B */
		if (config->edges_per_pulse != 4) {
			return 0;
		}
		dd = equal ? 1 : -1;
		break;
	default:
		return 0;
	}
	return config->invert_direction ? -dd : dd;
}

void lw_quadrature_configure(struct lw_quadrature *quadrature,
			     const struct lw_quadrature_config *config)
{
	const unsigned int inverted =
		((unsigned int)config->invert_a << 1) | (unsigned int)config->invert_b;

	for (unsigned int i = 0; i < sizeof(quadrature->counts); i++) {
		quadrature->counts[i] =
			(int8_t)count(config, (i >> 2) ^ inverted, (i & 3) ^ inverted);
	}
}

void lw_quadrature_init(struct lw_quadrature *quadrature, const struct lw_quadrature_config *config,
			bool a, bool b)
{
	quadrature->levels = (uint8_t)(((unsigned int)a << 1) | b);
	quadrature->illegal_transitions = 0;
	quadrature->late_interrupts = 0;
	lw_quadrature_configure(quadrature, config);
}
