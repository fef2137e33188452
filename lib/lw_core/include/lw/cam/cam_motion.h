/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A cam in motion (lw/cam/cam.h): what the edge interrupt does beside the table, so that the
 * carriage never gets more steps in one edge than it may: starting in step with the master,
 * shifting the master, going over to another table.
 *
 * The edge interrupt writes every field unless its comment says else. While the motion's source is
 * LW_EDGE_SOURCE_NONE the supervisor may write all.
 *
 * An edge costs little because all that is unusual leaves the short way by one comparison, as with
 * the law: whoever asks for something writes LW_CAM_CLOSED to `open`, and then every edge goes
 * through lw_cam_motion_edge(); whoever takes edges opens it again by lw_cam_motion_open(). And
 * because the short way only adds up its steps, in `ahead_usteps`: in a piece and one direction of
 * the master they all go one way. Whoever takes edges accounts for them before anything else is
 * done, and who reads adds them (lw/motion/motion.h).
 */
#ifndef LW_CAM_MOTION_H
#define LW_CAM_MOTION_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "lw/cam/cam.h"

/** State. */
struct lw_cam_motion {
	struct lw_cam cam;
	/** enum lw_cam_kind of the piece, times the direction of the last edge, while an edge has
	 *  nothing to do but to follow the table, else LW_CAM_CLOSED. Writer: see above. */
	int32_t open;
	/** Steps of the short way that neither the table's position nor the motion's has yet. */
	int32_t ahead_usteps;
	bool on;      /**< the cam, not the law, moves the carriage; the supervisor's */
	bool waiting; /**< for the master to pass the begin of a cycle */
	/** Most steps of one edge, not less than the table asks for; the supervisor's. */
	uint8_t steps_max;
	int32_t begin_usteps; /**< slave position that a waiting cam begins at */
	int32_t owed_usteps;  /**< steps that the slave is behind its place; 0 in step */
	/** Edges that did not move the carriage, as counted at the last edge, modulo 2^32. */
	uint32_t unfollowed_edges;
	int32_t phase_edges; /**< shift of the master that is reached */
	/** Shift that is wanted; the supervisor's, by lw_cam_motion_shift(). */
	_Atomic int32_t phase_target_edges;
	/** Table to go on with at the next begin of a cycle, or NULL: set by the supervisor,
	 *  cleared by whoever takes it. */
	_Atomic(const struct lw_cam_table *) next;
	struct lw_cam_ring ring; /**< the supervisor's, by lw_cam_motion_prepare() */
};

/**
 * Let every edge go through lw_cam_motion_edge(), after what was written before. For whoever asks
 * for something.
 */
void lw_cam_motion_close(struct lw_cam_motion *motion);

/**
 * Open the short way if nothing is to be done but to follow the table. For the edge interrupt.
 *
 * @param dd direction of the last edge
 */
static inline void lw_cam_motion_open(struct lw_cam_motion *motion, int dd)
{
	if (!motion->waiting && motion->owed_usteps == 0 &&
	    motion->phase_edges == motion->phase_target_edges) {
		motion->open = motion->cam.piece.kind * dd;
	}
}

/** Shift the master to so many edges. For the supervisor. */
void lw_cam_motion_shift(struct lw_cam_motion *motion, int32_t phase_edges);

/**
 * Prepare the pieces of the table that are near, and have steps accounted for before 32 bit of them
 * have come together. For the supervisor, in every tick.
 */
void lw_cam_motion_prepare(struct lw_cam_motion *motion);

/**
 * Take one edge of the master on the table, and go over to the queued table where a cycle begins.
 * For the edge interrupt.
 *
 * @return steps of the table
 */
int lw_cam_motion_table_edge(struct lw_cam_motion *motion, int dd);

/**
 * Take one edge. For the edge interrupt.
 *
 * @param unfollowed_edges drum edges that did not move the carriage, net, modulo 2^32
 * @param dd +1 forward or -1 backward
 * @return steps to give, -steps_max to +steps_max
 */
int lw_cam_motion_edge(struct lw_cam_motion *motion, uint32_t unfollowed_edges, int dd);

/** What the edge interrupt changes, all of one moment. */
struct lw_cam_reading {
	int32_t pos_usteps; /**< slave position by the table, modulo 2^32 */
	int32_t owed_usteps;
	int32_t phase_edges;
	int32_t cycles;
	uint16_t row;     /**< index */
	uint16_t waiting; /**< 1 or 0, as wide as leaves no padding */
};

/** Read what the edge interrupt changes. Reads until two readings agree. Not for the interrupt. */
struct lw_cam_reading lw_cam_motion_read(const struct lw_cam_motion *motion);

#endif /* LW_CAM_MOTION_H */
