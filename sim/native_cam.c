/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What Python calls by ctypes for cam tables: the compiled check, and the compiled cam over runs
 * of edges.
 */
#include <stddef.h>
#include <stdint.h>

#include "lw/bytes/layout.h"
#include "lw/cam/cam.h"

/** What a replay of a cam ended with. */
struct lw_native_cam_result {
	int64_t pos;
	int64_t min_pos;
	int64_t max_pos;
	int64_t pulses; /**< all */
	int64_t edges;
	int32_t row;      /**< index of the row that the cam ended in */
	int32_t cycles;   /**< net */
	int32_t step_max; /**< most steps of one edge */
	uint64_t trace_count;
};

/** lw_cam_table_check() with the scale in lowest terms. */
int lw_native_cam_check(const struct lw_cam_table *table, const struct lw_cam_scale *scale,
			const struct lw_cam_limits *limits, struct lw_cam_statistics *statistics,
			struct lw_cam_refusal *why)
{
	const struct lw_cam_scale lowest =
		lw_cam_scale(scale->edges, scale->master_units, scale->usteps, scale->slave_units,
			     scale->ramp_divisor);

	return lw_cam_table_check(table, &lowest, limits, statistics, why);
}

/** Start a cam on a checked table, which must outlive it. */
void lw_native_cam_start(struct lw_cam *cam, const struct lw_cam_table *table,
			 const struct lw_cam_scale *scale, int64_t start_edges)
{
	const struct lw_cam_scale lowest =
		lw_cam_scale(scale->edges, scale->master_units, scale->usteps, scale->slave_units,
			     scale->ramp_divisor);

	lw_cam_start(cam, table, &lowest, start_edges, 0);
}

/**
 * Take runs of edges, as the encoder interrupt does.
 *
 * @param runs edges of each run, positive forward, negative backward
 * @param next table to go on with from the next boundary of a cycle, or NULL
 * @param trace_pos receives the position before every trace_stride-th edge
 */
void lw_native_cam_run(struct lw_cam *cam, const int32_t *runs, size_t run_count,
		       const struct lw_cam_table *next, struct lw_native_cam_result *result,
		       int64_t *trace_pos, size_t trace_stride, size_t trace_capacity)
{
	static const unsigned int EDGES_OF_A_TICK = 7; /* so that prepared pieces run out, too */
	struct lw_cam_ring ring = {0};
	size_t until_trace = 0;

	*result = (struct lw_native_cam_result){.min_pos = lw_cam_pos(cam),
						.max_pos = lw_cam_pos(cam)};
	for (size_t run = 0; run < run_count; run++) {
		const int dd = runs[run] < 0 ? -1 : 1;
		const int64_t edges = runs[run] < 0 ? -(int64_t)runs[run] : runs[run];

		for (int64_t i = 0; i < edges; i++) {
			if (until_trace-- == 0 && result->trace_count < trace_capacity) {
				trace_pos[result->trace_count++] = lw_cam_pos(cam);
				until_trace = trace_stride - 1;
			}

			if (result->edges % EDGES_OF_A_TICK == 0) {
				lw_cam_ring_fill(&ring, cam);
			}

			const int step = lw_cam_edge(cam, dd, next, &ring);
			const int magnitude = step < 0 ? -step : step;

			next = cam->table == next ? NULL : next;
			result->edges++;
			result->pulses += magnitude;
			if (magnitude > result->step_max) {
				result->step_max = magnitude;
			}
			if (lw_cam_pos(cam) < result->min_pos) {
				result->min_pos = lw_cam_pos(cam);
			}
			if (lw_cam_pos(cam) > result->max_pos) {
				result->max_pos = lw_cam_pos(cam);
			}
		}
	}
	result->pos = lw_cam_pos(cam);
	result->row = cam->piece.row;
	result->cycles = cam->piece.cycles;
}

/** Layout of what Python copies. */
const struct lw_layout lw_layout_cam[] = {
	LW_LAYOUT_STRUCT(lw_cam_row),
	LW_LAYOUT_MEMBER(lw_cam_row, master),
	LW_LAYOUT_MEMBER(lw_cam_row, slave),
	LW_LAYOUT_STRUCT(lw_cam_table),
	LW_LAYOUT_MEMBER(lw_cam_table, name),
	LW_LAYOUT_MEMBER(lw_cam_table, version),
	LW_LAYOUT_MEMBER(lw_cam_table, interpolation),
	LW_LAYOUT_MEMBER(lw_cam_table, row_count),
	LW_LAYOUT_MEMBER(lw_cam_table, advance),
	LW_LAYOUT_MEMBER(lw_cam_table, rows),
	LW_LAYOUT_STRUCT(lw_cam_scale),
	LW_LAYOUT_MEMBER(lw_cam_scale, edges),
	LW_LAYOUT_MEMBER(lw_cam_scale, master_units),
	LW_LAYOUT_MEMBER(lw_cam_scale, usteps),
	LW_LAYOUT_MEMBER(lw_cam_scale, slave_units),
	LW_LAYOUT_MEMBER(lw_cam_scale, ramp_divisor),
	LW_LAYOUT_STRUCT(lw_cam_limits),
	LW_LAYOUT_MEMBER(lw_cam_limits, top_edges_per_s),
	LW_LAYOUT_MEMBER(lw_cam_limits, steps_per_s_max),
	LW_LAYOUT_STRUCT(lw_cam_refusal),
	LW_LAYOUT_MEMBER(lw_cam_refusal, reason),
	LW_LAYOUT_MEMBER(lw_cam_refusal, row),
	LW_LAYOUT_MEMBER(lw_cam_refusal, value),
	LW_LAYOUT_MEMBER(lw_cam_refusal, limit),
	LW_LAYOUT_STRUCT(lw_cam_statistics),
	LW_LAYOUT_MEMBER(lw_cam_statistics, cycle_edges),
	LW_LAYOUT_MEMBER(lw_cam_statistics, min_usteps),
	LW_LAYOUT_MEMBER(lw_cam_statistics, max_usteps),
	LW_LAYOUT_MEMBER(lw_cam_statistics, slope_max_permille),
	LW_LAYOUT_MEMBER(lw_cam_statistics, slope_max_row),
	LW_LAYOUT_STRUCT(lw_cam_numbers),
	LW_LAYOUT_MEMBER(lw_cam_numbers, remainder),
	LW_LAYOUT_MEMBER(lw_cam_numbers, slope),
	LW_LAYOUT_MEMBER(lw_cam_numbers, whole),
	LW_LAYOUT_MEMBER(lw_cam_numbers, remainder_high),
	LW_LAYOUT_MEMBER(lw_cam_numbers, slope_high),
	LW_LAYOUT_STRUCT(lw_cam_point),
	LW_LAYOUT_MEMBER(lw_cam_point, numbers),
	LW_LAYOUT_MEMBER(lw_cam_point, left),
	LW_LAYOUT_MEMBER(lw_cam_point, pos_usteps),
	LW_LAYOUT_STRUCT(lw_cam_piece),
	LW_LAYOUT_MEMBER(lw_cam_piece, den),
	LW_LAYOUT_MEMBER(lw_cam_piece, curve),
	LW_LAYOUT_MEMBER(lw_cam_piece, first_at),
	LW_LAYOUT_MEMBER(lw_cam_piece, edges),
	LW_LAYOUT_MEMBER(lw_cam_piece, cycles),
	LW_LAYOUT_MEMBER(lw_cam_piece, row),
	LW_LAYOUT_MEMBER(lw_cam_piece, whole_curve),
	LW_LAYOUT_MEMBER(lw_cam_piece, kind),
	LW_LAYOUT_STRUCT(lw_cam),
	LW_LAYOUT_MEMBER(lw_cam, point),
	LW_LAYOUT_MEMBER(lw_cam, piece),
	LW_LAYOUT_MEMBER(lw_cam, offset),
	LW_LAYOUT_MEMBER(lw_cam, was_pos),
	LW_LAYOUT_MEMBER(lw_cam, serial),
	LW_LAYOUT_MEMBER(lw_cam, stride),
	LW_LAYOUT_MEMBER(lw_cam, table),
	LW_LAYOUT_MEMBER(lw_cam, scale),
	LW_LAYOUT_STRUCT(lw_native_cam_result),
	LW_LAYOUT_MEMBER(lw_native_cam_result, pos),
	LW_LAYOUT_MEMBER(lw_native_cam_result, min_pos),
	LW_LAYOUT_MEMBER(lw_native_cam_result, max_pos),
	LW_LAYOUT_MEMBER(lw_native_cam_result, pulses),
	LW_LAYOUT_MEMBER(lw_native_cam_result, edges),
	LW_LAYOUT_MEMBER(lw_native_cam_result, row),
	LW_LAYOUT_MEMBER(lw_native_cam_result, cycles),
	LW_LAYOUT_MEMBER(lw_native_cam_result, step_max),
	LW_LAYOUT_MEMBER(lw_native_cam_result, trace_count),
	{0},
};
