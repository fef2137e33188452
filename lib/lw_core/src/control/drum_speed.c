/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/control/drum_speed.h"

void lw_drum_speed_init(struct lw_drum_speed *speed, uint64_t now_us)
{
	*speed = (struct lw_drum_speed){.rest_since_us = now_us};
	for (int i = 0; i < LW_DRUM_SPEED_TICKS; i++) {
		speed->history_us[i] = (uint32_t)now_us;
	}
}

void lw_drum_speed_tick(struct lw_drum_speed *speed, const struct lw_params *params, uint32_t edges,
			bool may_turn_unseen, uint64_t now_us)
{
	uint32_t *oldest = &speed->history_edges[speed->next];
	uint32_t *oldest_us = &speed->history_us[speed->next];
	const uint32_t duration_us = (uint32_t)now_us - *oldest_us;
	const int64_t moved = (int32_t)(edges - *oldest);
	const int64_t edges_per_s = duration_us == 0 ? 0 : moved * 1000000 / duration_us;
	const int64_t rest_edges_per_s = params->rest_edges_per_s;

	*oldest = edges;
	*oldest_us = (uint32_t)now_us;
	speed->next = (uint8_t)((speed->next + 1) % LW_DRUM_SPEED_TICKS);
	speed->edges_per_s = (int32_t)edges_per_s;
	if (edges_per_s >= rest_edges_per_s || edges_per_s <= -rest_edges_per_s ||
	    may_turn_unseen) {
		speed->rest_since_us = now_us;
	}
	speed->at_rest = now_us - speed->rest_since_us >= (uint64_t)params->rest_time_ms * 1000;
}

bool lw_drum_speed_exceeds(const struct lw_drum_speed *speed, uint32_t limit_edges_per_s)
{
	const int64_t edges_per_s = speed->edges_per_s;

	return (edges_per_s < 0 ? -edges_per_s : edges_per_s) > (int64_t)limit_edges_per_s;
}
