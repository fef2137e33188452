/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/cam/cam_motion.h"

#include <stddef.h>
#include <string.h>

/** One edge of the master on the table; over to the queued table where a cycle begins. */
static int table_edge(struct lw_cam_motion *motion, int dd)
{
	const struct lw_cam_table *next = motion->next;
	const int steps = lw_cam_edge(&motion->cam, dd, next);

	if (next != NULL && motion->cam.table == next) {
		motion->next = NULL;
	}
	return steps;
}

int lw_cam_motion_edge(struct lw_cam_motion *motion, uint32_t edges, int dd)
{
	const int32_t cycles = motion->cam.cycles;
	const int32_t phase_target_edges = motion->phase_target_edges;
	int steps = table_edge(motion, dd);

	/* Edges that were counted but not taken, as before the start, leave the master shifted. */
	motion->phase_edges -= (int32_t)(edges - (uint32_t)dd - motion->edges);
	motion->edges = edges;

	if (motion->waiting) {
		steps = 0;
		if (motion->cam.cycles != cycles) {
			motion->waiting = false;
			steps = lw_cam_begin(&motion->cam, dd, motion->begin_usteps);
		}
	} else if (motion->phase_edges != phase_target_edges && motion->owed_usteps == 0) {
		const int shift = phase_target_edges > motion->phase_edges ? 1 : -1;

		motion->phase_edges += shift;
		steps += table_edge(motion, shift);
	}

	motion->owed_usteps += steps;
	steps = motion->owed_usteps;
	if (steps > motion->steps_max) {
		steps = motion->steps_max;
	} else if (steps < -motion->steps_max) {
		steps = -motion->steps_max;
	}
	motion->owed_usteps -= steps;
	return steps;
}

static struct lw_cam_reading read_once(const volatile struct lw_cam_motion *motion)
{
	return (struct lw_cam_reading){
		.pos_usteps = (int32_t)motion->cam.pos_usteps,
		.owed_usteps = motion->owed_usteps,
		.phase_edges = motion->phase_edges,
		.cycles = motion->cam.cycles,
		.row = motion->cam.row,
		.waiting = motion->waiting,
	};
}

struct lw_cam_reading lw_cam_motion_read(const struct lw_cam_motion *motion)
{
	struct lw_cam_reading first;
	struct lw_cam_reading second = read_once(motion);

	do {
		first = second;
		second = read_once(motion);
	} while (memcmp(&first, &second, sizeof(first)) != 0);
	return second;
}
