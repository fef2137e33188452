/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/cam/cam_motion.h"

#include <stddef.h>
#include <string.h>

/** The short way adds up no more steps than these, and those of a tick. */
#define ACCOUNT_USTEPS (INT32_MAX / 2)

void lw_cam_motion_close(struct lw_cam_motion *motion)
{
	atomic_signal_fence(memory_order_seq_cst);
	*(volatile int32_t *)&motion->open = LW_CAM_CLOSED;
	atomic_signal_fence(memory_order_seq_cst);
}

void lw_cam_motion_prepare(struct lw_cam_motion *motion)
{
	const int32_t since_usteps =
		(int32_t)(motion->cam.point.pos_usteps + (uint32_t)motion->ahead_usteps -
			  (uint32_t)motion->cam.was_pos);

	if (since_usteps > ACCOUNT_USTEPS || since_usteps < -ACCOUNT_USTEPS) {
		lw_cam_motion_close(motion);
	}
	lw_cam_ring_fill(&motion->ring, &motion->cam);
}

void lw_cam_motion_shift(struct lw_cam_motion *motion, int32_t phase_edges)
{
	motion->phase_target_edges = phase_edges;
	lw_cam_motion_close(motion);
}

int lw_cam_motion_table_edge(struct lw_cam_motion *motion, int dd)
{
	const struct lw_cam_table *next = motion->next;
	const int steps = lw_cam_edge(&motion->cam, dd, next, &motion->ring);

	if (next != NULL && motion->cam.table == next) {
		motion->next = NULL;
	}
	return steps;
}

int lw_cam_motion_edge(struct lw_cam_motion *motion, uint32_t unfollowed_edges, int dd)
{
	const int32_t cycles = motion->cam.piece.cycles;
	const int32_t phase_target_edges = motion->phase_target_edges;
	int steps = lw_cam_motion_table_edge(motion, dd);

	/* Edges that were counted but not taken, as before the start, leave the master shifted. */
	motion->phase_edges -= (int32_t)(unfollowed_edges - motion->unfollowed_edges);
	motion->unfollowed_edges = unfollowed_edges;

	if (motion->waiting) {
		steps = 0;
		if (motion->cam.piece.cycles != cycles) {
			motion->waiting = false;
			steps = lw_cam_begin(&motion->cam, dd, motion->begin_usteps);
		}
	} else if (motion->phase_edges != phase_target_edges && motion->owed_usteps == 0) {
		const int shift = phase_target_edges > motion->phase_edges ? 1 : -1;

		motion->phase_edges += shift;
		steps += lw_cam_motion_table_edge(motion, shift);
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
		.pos_usteps =
			(int32_t)(motion->cam.point.pos_usteps + (uint32_t)motion->ahead_usteps),
		.owed_usteps = motion->owed_usteps,
		.phase_edges = motion->phase_edges,
		.cycles = motion->cam.piece.cycles,
		.row = motion->cam.piece.row,
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
