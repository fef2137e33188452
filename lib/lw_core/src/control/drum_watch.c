/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/control/drum_watch.h"

#include <stdlib.h>

#define A LW_QUADRATURE_A
#define B LW_QUADRATURE_B

/** A channel that stands lets the count rock by so many edges, a drum that turns goes on. */
#define ROCKING_EDGES 1

/** Transitions over which the share of illegal ones is taken. */
#define SHARE_TRANSITIONS 1000

/** From rest to overspeed_trip a drum takes more blocks than this, twice: more than 1.2 s. */
#define FULL_SPEED_BLOCKS 30

/** Blocks in which missing edges are looked for, from the first odd changes on. */
#define HIDING_BLOCKS 3

/** Index pulses without the edges between them, in a row, that are no chance any more. */
#define PULSES_ALONE 2

/** What the encoder has told in a tick. */
struct told {
	int32_t moved;    /**< edges that the drum has gone on, rocking left out */
	uint32_t odd[2];  /**< odd changes, by channel */
	int32_t lone[2];  /**< those of them that the motion does not explain */
	uint32_t illegal; /**< transitions */
	uint32_t pulses;  /**< of the index */
	uint32_t all;     /**< transitions */
};

/** How far the drum has gone on, like a nut with some play on a screw that turns by `edges`. */
static int32_t go_on(struct lw_drum_watch *watch, int32_t edges)
{
	const int32_t ahead = watch->rocked + edges;
	int32_t moved = 0;

	if (ahead > ROCKING_EDGES) {
		moved = ahead - ROCKING_EDGES;
	} else if (ahead < -ROCKING_EDGES) {
		moved = ahead + ROCKING_EDGES;
	}
	watch->rocked = ahead - moved;
	return moved;
}

static struct told compare(struct lw_drum_watch *watch, const struct lw_params *params,
			   const struct lw_drum_watch_counts *now)
{
	const struct lw_drum_watch_counts *seen = &watch->seen;
	struct told told = {
		.moved = go_on(watch, (int32_t)(now->edges - seen->edges)),
		.odd = {now->odd_changes[A] - seen->odd_changes[A],
			now->odd_changes[B] - seen->odd_changes[B]},
		.illegal = now->illegal_transitions - seen->illegal_transitions,
		.pulses = now->index_pulses - seen->index_pulses,
	};
	const int32_t edges = abs(told.moved);

	/* Changes that are no edges in this decoding are odd, too, see quadrature.h. */
	told.lone[A] = (int32_t)told.odd[A];
	told.lone[B] = (int32_t)told.odd[B];
	if (params->encoder_edges_per_pulse == 1) {
		told.lone[A] -= edges;
		told.lone[B] -= 2 * edges;
	} else if (params->encoder_edges_per_pulse == 2) {
		told.lone[B] -= edges;
	}
	told.all = (uint32_t)edges + told.odd[A] + told.odd[B] + told.illegal;
	watch->seen = *now;
	return told;
}

static void fail(struct lw_drum_watch *watch, enum lw_encoder_fault fault)
{
	watch->fault_anew = true;
	if (watch->fault == LW_ENCODER_FAULT_NONE) {
		watch->fault = fault;
	}
}

static void begin_block(struct lw_drum_watch *watch, uint64_t now_us)
{
	watch->block_us = now_us;
	watch->moved[1] = watch->moved[0];
	watch->moved[0] = 0;
	for (int channel = 0; channel < 2; channel++) {
		watch->lone[channel] = 0;
		watch->odd[channel] = 0;
	}
	watch->turning = false;
}

static void count(struct lw_drum_watch *watch, const struct told *told)
{
	for (int channel = 0; channel < 2; channel++) {
		watch->lone[channel] += told->lone[channel];
		watch->odd[channel] += told->odd[channel];
		watch->pulse_lone[channel] += told->lone[channel];
	}
	watch->turning |= told->moved != 0;
	watch->moved[0] += abs(told->moved);
	watch->pulse_edges += told->moved;
}

/** So many changes in a block are reason for a doubt. */
static int64_t enough_changes(const struct lw_params *params)
{
	const int64_t enough =
		(int64_t)params->encoder_watch_transitions_per_s * LW_DRUM_WATCH_BLOCK_US / 1000000;

	return enough > 2 ? enough : 2;
}

/** So many edges in a block are a speed that no drum gains or loses within two blocks. */
static int64_t fast_edges(const struct lw_params *params)
{
	const int64_t inert = (int64_t)params->overspeed_trip_edges_per_s / FULL_SPEED_BLOCKS;
	const int64_t edges = inert * LW_DRUM_WATCH_BLOCK_US / 1000000;
	const int64_t enough = enough_changes(params);

	return edges > enough ? edges : enough;
}

/** What the changes of this block look like, if there are enough of them. */
static enum lw_encoder_fault suspect(const struct lw_drum_watch *watch,
				     const struct lw_params *params)
{
	const int active = watch->lone[A] > watch->lone[B] ? A : B;

	if (watch->lone[active] < enough_changes(params)) {
		return LW_ENCODER_FAULT_NONE;
	}
	if (!watch->turning && watch->odd[!active] == 0) {
		return active == A ? LW_ENCODER_FAULT_B_STILL : LW_ENCODER_FAULT_A_STILL;
	}
	return active == A ? LW_ENCODER_FAULT_B_FLICKERS : LW_ENCODER_FAULT_A_FLICKERS;
}

/**
 * A loose wire on a fast drum hides as many edges as it shows changes of the other channel. Chatter
 * hides none. Compared with the speed before, in the first blocks only: later a drum may brake.
 */
static bool edges_are_missing(struct lw_drum_watch *watch, const struct lw_params *params)
{
	const int64_t enough = enough_changes(params);
	const int64_t braked = fast_edges(params) / 2; /* from block to block, at most */
	const int active = watch->lone[A] > watch->lone[B] ? A : B;

	if (4 * watch->lone[active] < enough) {
		watch->before = watch->moved[0];
		watch->hidden = 0;
		watch->hiding = 0;
		watch->missing = 0;
		return false;
	}
	if (watch->hiding < HIDING_BLOCKS) {
		watch->hiding++;
		watch->hidden += watch->lone[active];
		watch->missing += watch->before - watch->moved[0];
	}
	/* A pulse has two changes of each channel, and as many edges as the decoding uses. */
	const int64_t explained = (int64_t)watch->hidden * params->encoder_edges_per_pulse / 2;

	return watch->hidden >= enough && 4 * watch->missing >= 3 * explained &&
	       4 * watch->missing <= 5 * explained &&
	       watch->missing >= braked * watch->hiding * (watch->hiding + 1) / 2;
}

static void watch_channels(struct lw_drum_watch *watch, const struct lw_params *params,
			   const struct told *told, bool running, uint64_t now_us)
{
	enum lw_encoder_fault fault;

	count(watch, told);
	fault = told->lone[A] > 0 || told->lone[B] > 0 ? suspect(watch, params)
						       : LW_ENCODER_FAULT_NONE;
	if (fault != LW_ENCODER_FAULT_NONE) {
		watch->doubt_us = now_us;
		if (!watch->doubtful) {
			watch->doubtful = true;
			watch->doubt_since_us = watch->block_us;
			if (watch->doubts < UINT16_MAX) {
				watch->doubts++;
			}
		}
		if (running ||
		    now_us - watch->doubt_since_us >= (uint64_t)params->encoder_watch_ms * 1000) {
			fail(watch, fault);
		}
	} else if (now_us - watch->doubt_us > LW_DRUM_WATCH_HOLD_US) {
		watch->doubtful = false;
	}
	if (now_us - watch->block_us >= LW_DRUM_WATCH_BLOCK_US) {
		if (edges_are_missing(watch, params)) {
			fail(watch, watch->lone[A] > watch->lone[B] ? LW_ENCODER_FAULT_B_FLICKERS
								    : LW_ENCODER_FAULT_A_FLICKERS);
		}
		begin_block(watch, now_us);
	}
}

/**
 * A drum that rocks about an edge was slow before and is slow after. One that was fast a block
 * ago and stands, or that stood and is fast, has a dead channel in between.
 */
static void watch_inertia(struct lw_drum_watch *watch, const struct lw_params *params,
			  const struct told *told, uint64_t now_us)
{
	const int64_t fast = fast_edges(params);

	for (int channel = 0; channel < 2; channel++) {
		watch->still_lone[channel] =
			told->moved != 0 ? 0 : watch->still_lone[channel] + told->lone[channel];
	}

	const int active = watch->still_lone[A] > watch->still_lone[B] ? A : B;

	if (watch->still_lone[active] >= enough_changes(params)) {
		watch->still = active == A ? LW_ENCODER_FAULT_B_STILL : LW_ENCODER_FAULT_A_STILL;
		watch->still_us = now_us;
		watch->moved_after = 0;
		if (watch->moved[0] >= fast || watch->moved[1] >= fast) {
			fail(watch, watch->still);
		}
	} else if (watch->still != LW_ENCODER_FAULT_NONE) {
		watch->moved_after += abs(told->moved);
		if (now_us - watch->still_us > LW_DRUM_WATCH_BLOCK_US) {
			watch->still = LW_ENCODER_FAULT_NONE;
		} else if (watch->moved_after >= fast) {
			fail(watch, watch->still);
		}
	}
}

static void watch_illegal(struct lw_drum_watch *watch, const struct lw_params *params,
			  const struct told *told)
{
	watch->illegal += told->illegal;
	watch->transitions += told->all;
	if (watch->illegal > (uint32_t)params->encoder_illegal_permille &&
	    params->encoder_illegal_permille < SHARE_TRANSITIONS) {
		fail(watch, LW_ENCODER_FAULT_ILLEGAL);
	}
	if (watch->transitions >= SHARE_TRANSITIONS) {
		watch->illegal = 0;
		watch->transitions = 0;
	}
}

/**
 * A revolution has two changes of each channel for every pulse. So many of one channel between two
 * index pulses, and no edges: the other channel is dead, not the drum at rest.
 */
static void watch_pulses(struct lw_drum_watch *watch, const struct lw_params *params,
			 const struct told *told)
{
	const int32_t pulses = params->encoder_pulses_per_rev;
	const int active = watch->pulse_lone[A] > watch->pulse_lone[B] ? A : B;
	const int64_t lone = watch->pulse_lone[active];

	if (told->pulses == 0) {
		return;
	}
	if (2 * lone > 3 * pulses && 2 * lone < 5 * pulses &&
	    4 * llabs(watch->pulse_edges) < pulses) {
		if (++watch->pulses_alone == PULSES_ALONE) {
			watch->pulses_alone = 0;
			fail(watch,
			     active == A ? LW_ENCODER_FAULT_B_STILL : LW_ENCODER_FAULT_A_STILL);
		}
	} else {
		watch->pulses_alone = 0;
	}
	watch->pulse_lone[A] = 0;
	watch->pulse_lone[B] = 0;
	watch->pulse_edges = 0;
}

/** Two pulses in a row say that edges are lost, or too many: one could be noise. */
static void watch_misfit(struct lw_drum_watch *watch, const struct lw_encoder_index *index,
			 const struct told *told, int32_t tolerance_edges)
{
	const int32_t misfit = index->misfit_edges - watch->misfit_base;
	const int32_t before = index->misfit_before_edges - watch->misfit_base;

	if (told->pulses > 0 && ((misfit > tolerance_edges && before > tolerance_edges) ||
				 (misfit < -tolerance_edges && before < -tolerance_edges))) {
		fail(watch, LW_ENCODER_FAULT_INDEX_MISFIT);
	}
}

static void watch_standing(struct lw_drum_watch *watch, const struct lw_params *params,
			   const struct told *told, bool running, uint64_t now_us)
{
	if (!running || params->drum_watch_ms == 0 || told->moved != 0) {
		watch->stood_since_us = now_us;
	} else if (now_us - watch->stood_since_us >= (uint64_t)params->drum_watch_ms * 1000) {
		fail(watch, LW_ENCODER_FAULT_NO_EDGES);
	}
}

static struct lw_drum_watch_counts read_counts(const struct lw_quadrature *quadrature,
					       uint32_t edges, uint32_t index_pulses)
{
	const volatile struct lw_quadrature *now = quadrature;

	return (struct lw_drum_watch_counts){
		.edges = edges,
		.odd_changes = {now->odd_changes[A], now->odd_changes[B]},
		.illegal_transitions = now->illegal_transitions,
		.index_pulses = index_pulses,
	};
}

void lw_drum_watch_init(struct lw_drum_watch *watch, const struct lw_quadrature *quadrature,
			uint64_t now_us)
{
	*watch = (struct lw_drum_watch){
		.seen = read_counts(quadrature, 0, 0),
		.block_us = now_us,
		.stood_since_us = now_us,
	};
}

void lw_drum_watch_tick(struct lw_drum_watch *watch, const struct lw_params *params,
			const struct lw_quadrature *quadrature,
			const struct lw_encoder_index *index, uint32_t edges,
			int32_t tolerance_edges, bool running, uint64_t now_us)
{
	const struct lw_drum_watch_counts now =
		read_counts(quadrature, edges, *(const volatile uint32_t *)&index->pulses);
	const struct told told = compare(watch, params, &now);

	watch_channels(watch, params, &told, running, now_us);
	watch_inertia(watch, params, &told, now_us);
	watch_illegal(watch, params, &told);
	watch_pulses(watch, params, &told);
	watch_misfit(watch, index, &told, tolerance_edges);
	watch_standing(watch, params, &told, running, now_us);
}

void lw_drum_watch_index_begins(struct lw_drum_watch *watch)
{
	watch->fault_anew = false;
}

bool lw_drum_watch_indexed(struct lw_drum_watch *watch, const struct lw_encoder_index *index)
{
	if (watch->fault_anew || watch->doubtful) {
		return false;
	}
	watch->fault = LW_ENCODER_FAULT_NONE;
	watch->misfit_base = index->misfit_edges;
	watch->pulses_alone = 0;
	return true;
}
