/* SPDX-License-Identifier: Apache-2.0 */
/* The check of cam tables, and what the property tests do not see of the cam itself. */
#include <unity.h>

#include <string.h>

#include "law_check.h"
#include "lw/cam/cam.h"

static struct lw_cam_table table;
static struct lw_cam_scale scale;
static struct lw_cam_limits limits;
static struct lw_cam_statistics statistics;
static struct lw_cam_refusal why;
static struct lw_cam cam;
static struct lw_cam_ring ring;

static void set_rows(const struct lw_cam_row *rows, size_t count)
{
	memcpy(table.rows, rows, count * sizeof(*rows));
	table.row_count = (uint16_t)count;
}

#define SET_ROWS(...)                                                                              \
	do {                                                                                       \
		const struct lw_cam_row rows_[] = {__VA_ARGS__};                                   \
                                                                                                   \
		set_rows(rows_, sizeof(rows_) / sizeof(rows_[0]));                                 \
	} while (0)

void setUp(void)
{
	table = (struct lw_cam_table){.interpolation = LW_CAM_INTERPOLATION_LINEAR};
	scale = lw_cam_scale(1, 1, 1, 1, 10);
	limits = (struct lw_cam_limits){.top_edges_per_s = 20000, .steps_per_s_max = 80000};
	SET_ROWS({0, 0}, {100, 300}, {200, 0});
}

void tearDown(void)
{
}

/** Begin on the table at an edge. */
static void start(int64_t edges)
{
	lw_cam_start(&cam, &table, &scale, edges, 0);
	ring = (struct lw_cam_ring){0};
	lw_cam_ring_fill(&ring, &cam);
}

/** With pieces prepared now and then. */
static int take_edge(int dd)
{
	static unsigned int edges;

	if (edges++ % 50 == 0) {
		lw_cam_ring_fill(&ring, &cam);
	}
	return lw_cam_edge(&cam, dd, NULL, &ring);
}

static void accepted(void)
{
	TEST_ASSERT_EQUAL_INT(0, lw_cam_table_check(&table, &scale, &limits, &statistics, &why));
}

static void refused(enum lw_reason reason, int row, int32_t value, int32_t limit)
{
	const struct lw_cam_statistics before = statistics;

	TEST_ASSERT_LESS_THAN_INT(0,
				  lw_cam_table_check(&table, &scale, &limits, &statistics, &why));
	TEST_ASSERT_EQUAL_INT(reason, why.reason);
	TEST_ASSERT_EQUAL_INT(row, why.row);
	TEST_ASSERT_EQUAL_INT32(value, why.value);
	TEST_ASSERT_EQUAL_INT32(limit, why.limit);
	TEST_ASSERT_EQUAL_MEMORY(&before, &statistics, sizeof(before));
}

static void test_row_counts(void)
{
	accepted();
	table.row_count = 1;
	refused(LW_REASON_CAM_TOO_FEW_ROWS, 1, 1, 2);
	table.row_count = 0;
	refused(LW_REASON_CAM_TOO_FEW_ROWS, 0, 0, 2);
	for (int i = 0; i < LW_CAM_ROWS_MAX; i++) {
		table.rows[i] = (struct lw_cam_row){i * 5, 0};
	}
	table.row_count = LW_CAM_ROWS_MAX;
	accepted();
	TEST_ASSERT_EQUAL_UINT32((LW_CAM_ROWS_MAX - 1) * 5, statistics.cycle_edges);
	table.row_count = LW_CAM_ROWS_MAX + 1;
	refused(LW_REASON_CAM_TOO_MANY_ROWS, LW_CAM_ROWS_MAX + 1, LW_CAM_ROWS_MAX + 1,
		LW_CAM_ROWS_MAX);
}

static void test_masters_ascend_from_zero(void)
{
	SET_ROWS({0, 0}, {100, 0}, {100, 0}, {200, 0});
	refused(LW_REASON_CAM_MASTER_NOT_ASCENDING, 3, 100, 101);
	SET_ROWS({0, 0}, {100, 0}, {99, 0});
	refused(LW_REASON_CAM_MASTER_NOT_ASCENDING, 3, 99, 101);
	SET_ROWS({0, 0}, {INT32_MIN, 0});
	refused(LW_REASON_CAM_MASTER_NOT_ASCENDING, 2, INT32_MIN, 1);
	SET_ROWS({1, 0}, {100, 0});
	refused(LW_REASON_CAM_FIRST_MASTER, 1, 1, 0);
}

static void test_the_wrap_is_as_declared(void)
{
	SET_ROWS({0, 10}, {100, 10}, {200, 60});
	refused(LW_REASON_CAM_WRAP, 3, 50, 0);
	table.advance = 50;
	accepted();
	table.advance = -50;
	refused(LW_REASON_CAM_WRAP, 3, 50, -50);
}

static void test_four_steps_per_edge_and_no_more(void)
{
	SET_ROWS({0, 0}, {100, 400}, {200, 0});
	accepted();
	TEST_ASSERT_EQUAL_UINT32(4000, statistics.slope_max_permille);
	TEST_ASSERT_EQUAL_UINT16(1, statistics.slope_max_row);
	limits.steps_per_s_max = UINT32_MAX;
	SET_ROWS({0, 0}, {100, 400}, {200, -1});
	table.advance = -1;
	refused(LW_REASON_CAM_SLOPE, 2, 4010, 4000);
	/* The plateau of a trapezoid is steeper than its row: 10/9 of it. */
	table.advance = 0;
	table.interpolation = LW_CAM_INTERPOLATION_TRAPEZOID;
	SET_ROWS({0, 0}, {100, 360}, {200, 0});
	accepted();
	TEST_ASSERT_EQUAL_UINT32(4000, statistics.slope_max_permille);
	SET_ROWS({0, 0}, {100, -361}, {200, 0});
	refused(LW_REASON_CAM_SLOPE, 1, 4012, 4000);
}

static void test_steps_per_second(void)
{
	accepted();
	limits.steps_per_s_max = 60000;
	accepted();
	limits.steps_per_s_max = 59999;
	refused(LW_REASON_CAM_STEP_RATE, 1, 60000, 59999);
	limits.top_edges_per_s = 19999;
	accepted();
}

static void test_scales_count_in_the_slope(void)
{
	/* 2 edges are 3 master units; 3 microsteps are 2 slave units: 9/4 of the table's ratio. */
	scale = lw_cam_scale(20, 30, 30, 20, 10);
	TEST_ASSERT_EQUAL_INT32(2, scale.edges);
	TEST_ASSERT_EQUAL_INT32(3, scale.master_units);
	SET_ROWS({0, -3}, {90, 157}, {180, -3});
	accepted();
	TEST_ASSERT_EQUAL_UINT32(4000, statistics.slope_max_permille);
	TEST_ASSERT_EQUAL_UINT32(120, statistics.cycle_edges);
	TEST_ASSERT_EQUAL_INT32(-4, statistics.min_usteps); /* -4.5, halves up */
	TEST_ASSERT_EQUAL_INT32(236, statistics.max_usteps);
	SET_ROWS({0, 0}, {90, 161}, {180, 0});
	refused(LW_REASON_CAM_SLOPE, 1, 4025, 4000);
}

static void test_a_row_is_at_least_an_edge(void)
{
	scale = lw_cam_scale(2, 7, 1, 1, 10);
	SET_ROWS({0, 0}, {4, 4}, {8, 0});
	accepted();
	SET_ROWS({0, 0}, {4, 1}, {7, 0});
	refused(LW_REASON_CAM_ROW_TOO_SHORT, 2, 3, 4);
}

static void test_what_does_not_fit_64_bits(void)
{
	int32_t fits;

	table.interpolation = LW_CAM_INTERPOLATION_TRAPEZOID;
	SET_ROWS({0, 0}, {200000000, 0});
	TEST_ASSERT_LESS_THAN_INT(0,
				  lw_cam_table_check(&table, &scale, &limits, &statistics, &why));
	fits = why.limit;
	refused(LW_REASON_CAM_ROW_TOO_LARGE, 1, 200000000, fits);
	table.rows[1].master = fits;
	accepted();
	table.rows[1].master = fits + 1;
	refused(LW_REASON_CAM_ROW_TOO_LARGE, 1, fits + 1, fits);
	/* A cycle of many such rows is limited too. */
	table.interpolation = LW_CAM_INTERPOLATION_LINEAR;
	scale = lw_cam_scale(20, 1, 1, 1, 10);
	for (int i = 0; i < 12; i++) {
		table.rows[i] = (struct lw_cam_row){i * 10000000, 0};
	}
	table.row_count = 12;
	refused(LW_REASON_CAM_CYCLE_TOO_LONG, 12, 110000000, INT32_MAX / 20);
	table.interpolation = LW_CAM_INTERPOLATION_TRAPEZOID + 1;
	refused(LW_REASON_CAM_INTERPOLATION, 0, 2, 1);
}

/** The longest row that passes, through every piece of it and both ways, under the sanitizer. */
static void check_longest_row(enum lw_cam_interpolation interpolation, int32_t slave, int32_t way)
{
	int64_t from;
	int32_t edges;

	table.interpolation = (uint16_t)interpolation;
	table.advance = way;
	SET_ROWS({0, slave}, {200000000, slave + way});
	while (lw_cam_table_check(&table, &scale, &limits, &statistics, &why)) {
		TEST_ASSERT_EQUAL_INT(LW_REASON_CAM_ROW_TOO_LARGE, why.reason);
		table.rows[1].master = why.limit;
	}
	edges = (int32_t)statistics.cycle_edges;
	start(0);
	from = lw_cam_pos(&cam);
	for (int32_t edge = 0; edge < 2 * edges; edge++) {
		const int steps = take_edge(1);

		TEST_ASSERT_TRUE(-4 <= steps && steps <= 4);
	}
	TEST_ASSERT_EQUAL_INT32(2, cam.piece.cycles);
	TEST_ASSERT_INT64_WITHIN(1, from + 2 * (int64_t)way * scale.usteps / scale.slave_units,
				 lw_cam_pos(&cam));
	for (int32_t edge = 0; edge < 3 * edges; edge++) {
		(void)take_edge(-1);
	}
	TEST_ASSERT_EQUAL_INT32(-1, cam.piece.cycles);
	TEST_ASSERT_INT64_WITHIN(1, from - (int64_t)way * scale.usteps / scale.slave_units,
				 lw_cam_pos(&cam));
}

static void test_the_largest_numerators_do_not_overflow(void)
{
	scale = lw_cam_scale(1, 1, 9967, 7919, 100);
	check_longest_row(LW_CAM_INTERPOLATION_TRAPEZOID, 2147480000, 1000);
	check_longest_row(LW_CAM_INTERPOLATION_TRAPEZOID, -2147480000, -1000);
	check_longest_row(LW_CAM_INTERPOLATION_LINEAR, 2140000000, 1000000);
	check_longest_row(LW_CAM_INTERPOLATION_LINEAR, -2140000000, -1000000);
}

/** Endless gearing does not end at 32 bits of microsteps. */
static void test_gearing_runs_past_32_bits(void)
{
	SET_ROWS({0, 0}, {1, 4});
	table.advance = 4;
	accepted();
	start(INT32_MAX - 5);
	TEST_ASSERT_EQUAL_INT64(4 * ((int64_t)INT32_MAX - 5), lw_cam_pos(&cam));
	for (int edge = 0; edge < 5; edge++) {
		TEST_ASSERT_EQUAL_INT(4, take_edge(1));
	}
	TEST_ASSERT_EQUAL_INT64(4 * (int64_t)INT32_MAX, lw_cam_pos(&cam));
	TEST_ASSERT_EQUAL_INT32(INT32_MAX, cam.piece.cycles);
}

/** Wherever the master goes, and whenever pieces are prepared, they are what is evaluated. */
static void test_prepared_pieces_are_what_is_evaluated(void)
{
	static const struct lw_cam_row rows[] = {{0, -7},    {9, 1},    {12, 1},
						 {400, -20}, {500, 40}, {611, 5}};
	struct lw_cam_ring none = {0};
	struct lw_cam_table next;
	uint64_t seed = 3;

	for (unsigned int i = 0; i < 4; i++) {
		struct lw_cam evaluated;
		unsigned int prepared = 0;

		table.interpolation = i % 2;
		table.advance = 12;
		set_rows(rows, sizeof(rows) / sizeof(rows[0]));
		scale = i < 2 ? lw_cam_scale(1, 1, 1, 1, 10) : lw_cam_scale(3, 7, 9, 5, 16);
		accepted();
		next = table;
		next.rows[3].slave = -29;
		start(-777);
		evaluated = cam;
		for (int run = 0; run < 500; run++) {
			const int dd = next_random(&seed) % 3 ? 1 : -1;
			/* Now and then another table waits. */
			const struct lw_cam_table *other = next_random(&seed) % 8      ? NULL
							   : evaluated.table == &table ? &next
										       : &table;

			for (uint32_t count = next_random(&seed) % 300 + 1; count > 0; count--) {
				const uint32_t serial = cam.serial + (uint32_t)dd;

				if (next_random(&seed) % 64 == 0) {
					lw_cam_ring_fill(&ring, &cam);
				}
				prepared += serial - ring.begin < ring.count &&
					    cam.point.left == (dd > 0 ? 0 : cam.piece.edges);
				TEST_ASSERT_EQUAL_INT(lw_cam_edge(&evaluated, dd, other, &none),
						      lw_cam_edge(&cam, dd, other, &ring));
				TEST_ASSERT_EQUAL_PTR(evaluated.table, cam.table);
				TEST_ASSERT_EQUAL_MEMORY(&evaluated.point, &cam.point,
							 sizeof(cam.point));
				TEST_ASSERT_EQUAL_MEMORY(&evaluated.piece, &cam.piece,
							 sizeof(cam.piece));
			}
		}
		TEST_ASSERT_GREATER_THAN_UINT(100, prepared);
	}
}

/** Half of what there is room for lies on either side, after a look and after many edges. */
static void test_pieces_are_prepared_on_both_sides(void)
{
	table.interpolation = LW_CAM_INTERPOLATION_TRAPEZOID;
	start(150);
	for (int i = 0; i < 600; i++) {
		const uint32_t behind = cam.serial - ring.begin;

		TEST_ASSERT_EQUAL_UINT32(LW_CAM_RING_SLOTS, ring.count);
		TEST_ASSERT_TRUE(behind >= LW_CAM_RING_SLOTS / 2 - 1 &&
				 behind <= LW_CAM_RING_SLOTS / 2);
		(void)lw_cam_edge(&cam, i < 400 ? 1 : -1, NULL, &ring);
		lw_cam_ring_fill(&ring, &cam);
	}
}

/** Numerators have 32 bit up to the longest row that lets them, and 64 from there on. */
static void test_numerators_are_as_wide_as_a_row_needs(void)
{
	/* Linear: 2 * 7 * length * 10, or a tenth where the length is round. */
	scale = lw_cam_scale(1, 1, 1, 7, 10);
	SET_ROWS({0, 0}, {7669583, 3}, {15339170, 9}, {23008760, 0});
	accepted();
	start(0);
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_STRAIGHT, cam.piece.kind);
	start(7669583);
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_WIDE, cam.piece.kind);
	start(15339170);
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_STRAIGHT, cam.piece.kind);
	scale = lw_cam_scale(1, 1, 1, 1, 10);
	/* A ramp of a trapezoid: 2 * 9 * length^2, or a hundredth where the length is round. */
	table.interpolation = LW_CAM_INTERPOLATION_TRAPEZOID;
	SET_ROWS({0, 0}, {7723, 3}, {7723 + 7727, 6}, {7723 + 7727 + 77230, 0});
	accepted();
	start(0);
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_CURVED, cam.piece.kind);
	start(7723);
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_WIDE, cam.piece.kind);
	start(7723 + 7727 / 2);
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_STRAIGHT, cam.piece.kind);
	start(7723 + 7727);
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_CURVED, cam.piece.kind);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_row_counts);
	RUN_TEST(test_masters_ascend_from_zero);
	RUN_TEST(test_the_wrap_is_as_declared);
	RUN_TEST(test_four_steps_per_edge_and_no_more);
	RUN_TEST(test_steps_per_second);
	RUN_TEST(test_scales_count_in_the_slope);
	RUN_TEST(test_a_row_is_at_least_an_edge);
	RUN_TEST(test_what_does_not_fit_64_bits);
	RUN_TEST(test_the_largest_numerators_do_not_overflow);
	RUN_TEST(test_gearing_runs_past_32_bits);
	RUN_TEST(test_prepared_pieces_are_what_is_evaluated);
	RUN_TEST(test_pieces_are_prepared_on_both_sides);
	RUN_TEST(test_numerators_are_as_wide_as_a_row_needs);
	return UNITY_END();
}
