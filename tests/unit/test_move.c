/* SPDX-License-Identifier: Apache-2.0 */
/* Moves from rest to rest. */
#include <unity.h>

#include "cases.h"
#include "law_check.h"
#include "lw/motion/move.h"

static const struct {
	int32_t ka;
	int32_t nr;
} slopes[] = {{23, 1187}, {65535, 1}, {1, 26000}, {1, 1}, {4369, 15}, {300, 200}, {30000, 2}};

#define SLOPE_COUNT (sizeof(slopes) / sizeof(slopes[0]))

void setUp(void)
{
}

void tearDown(void)
{
	cases_end();
}

/** Make a planned move; the slope stays within Ks and in its direction; one step per edge. */
static struct lw_law run(const struct lw_law_window *window, int32_t m, int32_t ks, int direction)
{
	struct lw_law law = lw_law_at(window, m, 0);
	uint32_t edges = 0;

	do {
		const int step = lw_law_edge(&law, 1);

		TEST_ASSERT_TRUE(-1 <= step && step <= 1);
		TEST_ASSERT_TRUE(direction * law.u >= 0);
		TEST_ASSERT_TRUE(direction * law.u <= ks);
		TEST_ASSERT_TRUE(edges++ < 400000000u);
	} while (law.u != 0);
	return law;
}

static void check_move(size_t slope, int32_t from_q16, int32_t target_usteps)
{
	const int32_t ka = slopes[slope].ka;
	const int32_t ks = ka * slopes[slope].nr;
	const int64_t way = (int64_t)target_usteps * LW_USTEP - from_q16;
	struct lw_law_window window;
	const bool far = way >= LW_USTEP - 1 || way <= 1 - LW_USTEP;

	TEST_ASSERT_EQUAL(far, lw_move_to(from_q16, &window, ka, slopes[slope].nr, target_usteps));
	if (far) {
		const struct lw_law law = run(&window, from_q16, ks, way > 0 ? 1 : -1);

		TEST_ASSERT_TRUE(window.ks <= ks);
		TEST_ASSERT_TRUE(window.sweep_begin < window.sweep_end);

		const int64_t error = lw_law_m(&law) - (int64_t)target_usteps * LW_USTEP;

		TEST_ASSERT_TRUE(-LW_USTEP < error && error < LW_USTEP);
	}
}

static void test_short_and_long_moves_in_both_directions_end_there(void)
{
	static const int32_t ways_usteps[] = {1, 2, 3, 10, 100, 247, 494, 495, 1000, 5000};
	static const int32_t starts_q16[] = {0, 1, 65535, -1, 100 * LW_USTEP + 12345};

	for (size_t slope = 0; slope < SLOPE_COUNT; slope++) {
		for (size_t way = 0; way < sizeof(ways_usteps) / sizeof(ways_usteps[0]); way++) {
			if (slopes[slope].ka == 1 && slopes[slope].nr == 1 &&
			    ways_usteps[way] > 3) {
				break; /* 65536 edges for each microstep */
			}
			for (size_t start = 0; start < 5; start++) {
				const int32_t from = starts_q16[start];

				check_move(slope, from, (from >> 16) + ways_usteps[way]);
				check_move(slope, from, (from >> 16) - ways_usteps[way]);
			}
		}
	}
}

static void test_moves_over_the_whole_range_of_positions(void)
{
	check_move(0, -32000 * LW_USTEP, 32000);
	check_move(0, 32000 * LW_USTEP, -32000);
	check_move(1, -32000 * LW_USTEP, 32000);
	check_move(2, 32000 * LW_USTEP, -32000);
}

static void test_less_than_a_microstep_away_is_there_already(void)
{
	check_move(0, 0, 0);
	check_move(0, 1, 1);
	check_move(0, 65535, 0);
	check_move(0, -65535, 0);
	check_move(0, 65534, 0);
	check_move(0, -65534, 0);
	check_move(0, 65536, 0);
}

static void test_a_short_way_is_done_at_a_lower_slope(void)
{
	struct lw_law_window window;

	TEST_ASSERT_TRUE(lw_move_to(0, &window, 23, 1187, 10));
	/* Two ramps over n edges cover Ka * n^2: n = 168. */
	TEST_ASSERT_EQUAL_INT32(168 * 23, window.ks);
	TEST_ASSERT_TRUE(lw_move_to(0, &window, 23, 1187, 1000));
	TEST_ASSERT_EQUAL_INT32(1187 * 23, window.ks);
}

static void test_an_endless_run_reaches_ks_at_zero_and_keeps_it(void)
{
	for (size_t slope = 0; slope < SLOPE_COUNT; slope++) {
		const int32_t ka = slopes[slope].ka;
		const int32_t nr = slopes[slope].nr;

		FOR_BOTH_WAYS(direction) {
			struct lw_law_window window;
			const int32_t m = lw_move_run(&window, ka, nr, direction);
			struct lw_law law = lw_law_at(&window, m, 0);

			for (int i = 0; i < nr; i++) {
				lw_law_edge(&law, 1);
			}
			TEST_ASSERT_EQUAL_INT32(0, lw_law_m(&law));
			for (int i = 0; i < 1000; i++) {
				TEST_ASSERT_EQUAL_INT32(direction * ka * nr, law.u);
				lw_law_edge(&law, 1);
			}
		}
	}
}

static void test_halting_from_any_point_of_a_move(void)
{
	FOR_BOTH_WAYS(direction) {
		const int32_t target_usteps = direction * 1200;
		struct lw_law_window window;

		TEST_ASSERT_TRUE(lw_move_to(0, &window, 23, 1187, target_usteps));

		struct lw_law law = lw_law_at(&window, 0, 0);

		for (;;) {
			struct lw_law halting;
			struct lw_law_window halt_window;

			lw_law_edge(&law, 1);
			if (law.u == 0) {
				break;
			}
			lw_move_halt(law.u, &halt_window, 23);
			halting = lw_law_at(&halt_window, lw_law_m(&law), law.u);
			while (halting.u != 0) {
				const int32_t before = halting.u;

				lw_law_edge(&halting, 1);
				TEST_ASSERT_EQUAL_INT32(before - direction * 23, halting.u);
			}
			/* Never farther than the move itself would have gone. */
			TEST_ASSERT_TRUE(direction * lw_law_pos_usteps(lw_law_m(&halting)) <=
					 direction * target_usteps + 1);
		}
	}
}

static void test_halting_goes_by_the_window_that_says_its_slope(void)
{
	static const int32_t slopes_q16[] = {1, -1, 23, -23, 65535, -65535};

	for (size_t i = 0; i < sizeof(slopes_q16) / sizeof(slopes_q16[0]); i++) {
		const int32_t u = slopes_q16[i];
		struct lw_law_window window;
		struct lw_law law;

		lw_move_halt(u, &window, 1);
		TEST_ASSERT_EQUAL_INT32(u < 0 ? -u : u, window.ks);
		TEST_ASSERT_TRUE(INT32_MIN < window.sweep_begin);
		TEST_ASSERT_TRUE(window.sweep_begin < window.sweep_end);
		law = lw_law_at(&window, 0, u);
		for (int32_t edges = window.ks; edges > 0; edges--) {
			TEST_ASSERT_NOT_EQUAL(0, law.u);
			lw_law_edge(&law, 1);
		}
		TEST_ASSERT_EQUAL_INT32(0, law.u);
	}
}

static void test_a_move_into_a_microstep_begins_at_the_far_end_of_its_own(void)
{
	for (int32_t fraction = 0; fraction < LW_USTEP; fraction += 21845) {
		struct lw_law_window window;
		int32_t m = 40 * LW_USTEP + fraction;

		TEST_ASSERT_TRUE(lw_move_into(&m, &window, 23, 1187, 50));
		TEST_ASSERT_EQUAL_INT32(40 * LW_USTEP, m);
		TEST_ASSERT_TRUE(lw_move_into(&m, &window, 23, 1187, 39));
		TEST_ASSERT_EQUAL_INT32(40 * LW_USTEP + LW_USTEP - 1, m);
		TEST_ASSERT_FALSE(lw_move_into(&m, &window, 23, 1187, 40));
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_short_and_long_moves_in_both_directions_end_there);
	RUN_TEST(test_moves_over_the_whole_range_of_positions);
	RUN_TEST(test_less_than_a_microstep_away_is_there_already);
	RUN_TEST(test_a_short_way_is_done_at_a_lower_slope);
	RUN_TEST(test_an_endless_run_reaches_ks_at_zero_and_keeps_it);
	RUN_TEST(test_halting_from_any_point_of_a_move);
	RUN_TEST(test_halting_goes_by_the_window_that_says_its_slope);
	RUN_TEST(test_a_move_into_a_microstep_begins_at_the_far_end_of_its_own);
	return UNITY_END();
}
