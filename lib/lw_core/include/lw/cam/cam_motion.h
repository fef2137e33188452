/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A cam in motion (lw/cam/cam.h): what the edge interrupt does beside the table, so that the
 * carriage never gets more steps in one edge than it may: starting in step with the master,
 * shifting the master, going over to another table.
 *
 * The edge interrupt writes every field unless its comment says else. While the motion's source is
 * LW_EDGE_SOURCE_NONE the supervisor may write all.
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
	bool on;              /**< the cam, not the law, moves the carriage; the supervisor's */
	bool waiting;         /**< for the master to pass the begin of a cycle */
	uint8_t steps_max;    /**< most steps of one edge; the supervisor's */
	int32_t begin_usteps; /**< slave position that a waiting cam begins at */
	int32_t owed_usteps;  /**< steps that the slave is behind its place; 0 in step */
	uint32_t edges;       /**< odometer at the last edge, modulo 2^32 */
	int32_t phase_edges;  /**< shift of the master that is reached */
	_Atomic int32_t phase_target_edges; /**< shift that is wanted; the supervisor's */
	/** Table to go on with at the next begin of a cycle, or NULL: set by the supervisor,
	 *  cleared by whoever takes it. */
	_Atomic(const struct lw_cam_table *) next;
};

/**
 * Take one edge. For the edge interrupt.
 *
 * @param edges odometer, this edge included
 * @param dd +1 forward or -1 backward
 * @return steps to give, -steps_max to +steps_max
 */
int lw_cam_motion_edge(struct lw_cam_motion *motion, uint32_t edges, int dd);

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
