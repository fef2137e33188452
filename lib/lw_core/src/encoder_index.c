#include "lw/encoder_index.h"

/**
 * The index may rise together with A or B, and then it is chance which interrupt comes first. What
 * is missed beyond this adds up, pulse by pulse, until it is seen.
 */
#define CHANCE_EDGES 1

void lw_encoder_index_configure(struct lw_encoder_index *index, int32_t edges_per_rev)
{
	index->last_known = false;
	index->reference_known[0] = false;
	index->reference_known[1] = false;
	index->edges_per_rev = edges_per_rev;
}

/** Whole revolutions, to the nearest. */
static int32_t revolutions(int32_t edges, int32_t edges_per_rev)
{
	const int32_t half = edges_per_rev / 2;

	return edges >= 0 ? (edges + half) / edges_per_rev : -((half - edges) / edges_per_rev);
}

void lw_encoder_index_pulse(struct lw_encoder_index *index, uint32_t net_edges)
{
	const int32_t moved = (int32_t)(net_edges - index->last_edges);
	const int32_t turned = revolutions(moved, index->edges_per_rev);
	const int way = turned > 0 ? 0 : 1;

	index->pulses++;
	index->last_edges = net_edges;
	if (!index->last_known || turned == 0) {
		index->last_known = true;
		return;
	}
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
	const int32_t error =
		since - revolutions(since, index->edges_per_rev) * index->edges_per_rev;

	if (error > CHANCE_EDGES || error < -CHANCE_EDGES) {
		index->missed_edges += (uint32_t)(error < 0 ? -error : error);
		index->reference[0] += (uint32_t)error;
		index->reference[1] += (uint32_t)error;
	}
}
