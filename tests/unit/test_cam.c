/* SPDX-License-Identifier: Apache-2.0 */
/* The check of cam tables, and what the property tests do not see of the cam itself. */
#include <unity.h>

#include <string.h>

#include "lw/cam/cam.h"

static struct lw_cam_table table;
static struct lw_cam_scale scale;
static struct lw_cam_limits limits;
static struct lw_cam_statistics statistics;
static struct lw_cam_refusal why;

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
	struct lw_cam cam;
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
	lw_cam_start(&cam, &table, &scale, 0, 0);
	from = cam.pos_usteps;
	for (int32_t edge = 0; edge < 2 * edges; edge++) {
		const int steps = lw_cam_edge(&cam, 1, NULL);

		TEST_ASSERT_TRUE(-4 <= steps && steps <= 4);
	}
	TEST_ASSERT_EQUAL_INT32(2, cam.cycles);
	TEST_ASSERT_INT64_WITHIN(1, from + 2 * (int64_t)way * scale.usteps / scale.slave_units,
				 cam.pos_usteps);
	for (int32_t edge = 0; edge < 3 * edges; edge++) {
		(void)lw_cam_edge(&cam, -1, NULL);
	}
	TEST_ASSERT_EQUAL_INT32(-1, cam.cycles);
	TEST_ASSERT_INT64_WITHIN(1, from - (int64_t)way * scale.usteps / scale.slave_units,
				 cam.pos_usteps);
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
	struct lw_cam cam;

	SET_ROWS({0, 0}, {1, 4});
	table.advance = 4;
	accepted();
	lw_cam_start(&cam, &table, &scale, INT32_MAX - 5, 0);
	TEST_ASSERT_EQUAL_INT64(4 * ((int64_t)INT32_MAX - 5), cam.pos_usteps);
	for (int edge = 0; edge < 5; edge++) {
		TEST_ASSERT_EQUAL_INT(4, lw_cam_edge(&cam, 1, NULL));
	}
	TEST_ASSERT_EQUAL_INT64(4 * (int64_t)INT32_MAX, cam.pos_usteps);
	TEST_ASSERT_EQUAL_INT32(INT32_MAX, cam.cycles);
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
	return UNITY_END();
}
