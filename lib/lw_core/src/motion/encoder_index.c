/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/motion/encoder_index.h"

/**
 * The index may rise together with A or B, and then it is chance which interrupt comes first. What
 * is missed beyond this adds up, pulse by pulse, until it is seen.
 */
#define CHANCE_EDGES 1

void lw_encoder_index_configure(struct lw_encoder_index *index, int32_t edges_per_rev,
				uint32_t rev_min_us)
{
	index->last_known = false;
	index->reference_known[0] = false;
	index->reference_known[1] = false;
	index->edges_per_rev = edges_per_rev;
	index->rev_min_us = rev_min_us;
}

/** Whole revolutions, to the nearest. */
static int32_t revolutions(int32_t edges, int32_t edges_per_rev)
{
	const int32_t half = edges_per_rev / 2;

	return edges >= 0 ? (edges + half) / edges_per_rev : -((half - edges) / edges_per_rev);
}

/**
 * Does nothing say that this pulse is the last one again, met by a drum that turned back, or a
 * contact that chatters? Then a revolution lies between, whatever the edges say.
 */
static bool full_turn(const struct lw_encoder_index *index, int32_t moved, uint32_t turns,
		      uint32_t changes, uint32_t now_us)
{
	if (now_us - index->last_us < index->rev_min_us || turns != index->last_turns) {
		return false;
	}
	/* Nearly where it was: it may have rocked by transitions that are no edges. */
	return changes == index->last_changes || moved > CHANCE_EDGES || moved < -CHANCE_EDGES;
}

void lw_encoder_index_pulse_late(struct lw_encoder_index *index)
{
	index->pulses++;
	index->last_known = false;
}

void lw_encoder_index_pulse(struct lw_encoder_index *index, uint32_t net_edges,
			    const struct lw_quadrature *quadrature, uint32_t now_us)
{
	const int32_t moved = (int32_t)(net_edges - index->last_edges);
	const uint32_t turns = quadrature->turns;
	const uint32_t changes = quadrature->odd_changes[LW_QUADRATURE_A] +
				 quadrature->odd_changes[LW_QUADRATURE_B] +
				 quadrature->illegal_transitions + quadrature->late_interrupts;
	int32_t turned = revolutions(moved, index->edges_per_rev);
	const bool unseen =
		turned == 0 && index->last_known && full_turn(index, moved, turns, changes, now_us);

	if (unseen) {
		turned = moved > 0 || (moved == 0 && index->last_way == 0) ? 1 : -1;
	}

	const int way = turned > 0 ? 0 : 1;

	index->pulses++;
	index->misfit_before_edges = index->misfit_edges;
	index->last_edges = net_edges;
	index->last_us = now_us;
	index->last_turns = turns;
	index->last_changes = changes;
	if (!index->last_known || turned == 0) {
		index->last_known = true;
		return;
	}
	index->last_way = way;
	/* Both keep up with the drum, so that a count that wraps round does not matter. */
	for (int i = 0; i < 2; i++) {
		index->reference[i] += (uint32_t)(turned * index->edges_per_rev);
	}
	if (!index->reference_known[way]) {
		index->reference_known[way] = true;
		index->reference[way] = net_edges;
		return;
	}

	const int32_t since = (int32_t)(net_edges - index->reference[way]);
	const int32_t whole = unseen ? 0 : revolutions(since, index->edges_per_rev);
	const int32_t error = since - whole * index->edges_per_rev;

	if (error > CHANCE_EDGES || error < -CHANCE_EDGES) {
		index->missed_edges += (uint32_t)(error < 0 ? -error : error);
		index->misfit_edges += error;
		index->reference[0] += (uint32_t)error;
		index->reference[1] += (uint32_t)error;
	}
}
