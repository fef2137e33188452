/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/control/rope_watch.h"

static uint32_t add_saturating(uint32_t a, uint32_t b)
{
	return a > UINT32_MAX - b ? UINT32_MAX : a + b;
}

static uint32_t millirev(int64_t edges, uint32_t edges_per_1000_drum_revs)
{
	const int64_t turns_permille =
		edges / edges_per_1000_drum_revs * 1000000 +
		edges % edges_per_1000_drum_revs * 1000000 / edges_per_1000_drum_revs;

	return turns_permille > UINT32_MAX ? UINT32_MAX : (uint32_t)turns_permille;
}

static void end_stand(struct lw_rope_watch *watch)
{
	watch->on_edges = 0;
	watch->top_edges = 0;
}

void lw_rope_watch_settle(struct lw_rope_watch *watch, uint32_t edges_per_1000_drum_revs)
{
	watch->laid_millirev = lw_rope_watch_millirev(watch, edges_per_1000_drum_revs);
	end_stand(watch);
}

uint32_t lw_rope_watch_millirev(const struct lw_rope_watch *watch,
				uint32_t edges_per_1000_drum_revs)
{
	return add_saturating(watch->laid_millirev,
			      millirev(watch->top_edges, edges_per_1000_drum_revs));
}

void lw_rope_watch_acknowledge(struct lw_rope_watch *watch)
{
	watch->set = false;
	watch->before_power_up = false;
	watch->laid_millirev = 0;
	end_stand(watch);
}

/** More than ever in this stand, and enough to be seen on the drum. */
static void tell(struct lw_rope_watch *watch, const struct lw_rope_watch_inputs *inputs)
{
	watch->top_edges = watch->on_edges;
	watch->indexed_since = false;
	if (!watch->set) {
		watch->set = true;
		watch->place_known = watch->last_known;
		watch->position_q16 = watch->last_q16;
		watch->time_ms = (uint32_t)(inputs->now_us / 1000);
	}
}

void lw_rope_watch_tick(struct lw_rope_watch *watch, const struct lw_rope_watch_inputs *inputs)
{
	const int64_t turned_edges = inputs->net_edges - watch->edges;
	/* What came since the last tick was followed until now. */
	const bool follows = inputs->following || watch->following;

	watch->edges = inputs->net_edges;
	watch->following = inputs->following;
	if (inputs->known) {
		watch->last_known = true;
		watch->last_q16 = inputs->position_q16;
	} else if (inputs->moved) {
		watch->last_known = false;
	}
	if (follows || inputs->intended || inputs->threshold_edges == 0) {
		lw_rope_watch_settle(watch, inputs->edges_per_1000_drum_revs);
		return;
	}
	watch->on_edges += turned_edges;
	if (watch->on_edges < 0) {
		watch->on_edges = 0;
	}
	if (watch->on_edges >= inputs->threshold_edges && watch->on_edges > watch->top_edges) {
		tell(watch, inputs);
	}
}
