/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/motion/quadrature.h"

#include <stdatomic.h>
#include <string.h>

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

#define TRANSITIONS_PER_PULSE 4u

/** Find the next edge, while A leads B (0) or B leads A (1). */
static void plan_edge(struct lw_quadrature *quadrature, unsigned int way, unsigned int levels)
{
	const unsigned int order = way == 0 ? LW_QUADRATURE_ORDER : ~LW_QUADRATURE_ORDER;
	unsigned int at = levels;
	uint8_t distance = 0;
	unsigned int edge;
	int dd;

	do {
		const unsigned int next = lw_quadrature_next_levels(at, order);

		edge = at << 2 | next;
		dd = quadrature->counts[edge];
		at = next;
		distance++;
	} while (dd == 0);
	quadrature->ways[way].to_edge[levels] = distance;
	quadrature->ways[way].edge = (uint8_t)edge;
	quadrature->ways[way].dd = (int8_t)dd;
}

/**
 * The first edge may be another. One that turns back meanwhile writes the same bytes: again then,
 * or a part of them would go on forward and a part backward.
 */
static void begin_forward(struct lw_quadrature *quadrature)
{
	const volatile uint32_t *turns = &quadrature->turns;
	uint32_t before;

	do {
		before = *turns;
		atomic_signal_fence(memory_order_seq_cst);
		memcpy(quadrature->onward, quadrature->onwards[0], sizeof(quadrature->onward));
		atomic_signal_fence(memory_order_seq_cst);
	} while (before != *turns);
}

void lw_quadrature_configure(struct lw_quadrature *quadrature,
			     const struct lw_quadrature_config *config)
{
	const unsigned int inverted =
		((unsigned int)config->invert_a << 1) | (unsigned int)config->invert_b;

	for (unsigned int i = 0; i < sizeof(quadrature->counts); i++) {
		const int dd = count(config, (i >> 2) ^ inverted, (i & 3) ^ inverted);

		quadrature->counts[i] = (int8_t)dd;
		quadrature->onwards[0][i] = dd > 0 ? 1 : 0;
		quadrature->onwards[1][i] = dd < 0 ? -1 : 0;
	}
	quadrature->edge_spacing_log2 = config->edges_per_pulse == 4   ? 0
					: config->edges_per_pulse == 2 ? 1
								       : 2;
	for (unsigned int way = 0; way < 2; way++) {
		for (unsigned int levels = 0; levels < TRANSITIONS_PER_PULSE; levels++) {
			plan_edge(quadrature, way, levels);
		}
	}
	begin_forward(quadrature);
}

void lw_quadrature_init(struct lw_quadrature *quadrature, const struct lw_quadrature_config *config,
			bool a, bool b)
{
	*quadrature = (struct lw_quadrature){.levels = (uint8_t)(((unsigned int)a << 1) | b)};
	lw_quadrature_configure(quadrature, config);
}

int lw_quadrature_odd_update(struct lw_quadrature *quadrature, unsigned int transition)
{
	const unsigned int changed = (transition >> 2) ^ (transition & 3);
	const int dd = quadrature->counts[transition];

	switch (changed) {
	case 0:
		quadrature->late_interrupts++;
		break;
	case 3:
		quadrature->illegal_transitions++;
		break;
	default:
		quadrature->odd_changes[changed & 1]++;
		break;
	}
	if (dd != 0) {
		quadrature->turns++;
		memcpy(quadrature->onward, quadrature->onwards[dd < 0], sizeof(quadrature->onward));
	}
	return dd;
}
