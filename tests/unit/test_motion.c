/* The motion as the edge interrupts see it. */
#include <unity.h>

#include "law_check.h"
#include "lw/motion.h"

#define KA 23
#define NR 1187
#define KS (KA * NR)

static struct lw_law_window window;
static struct lw_law_window other;
static struct lw_motion motion;
static int32_t steps_sum; /**< of all steps given */

void setUp(void)
{
	window = law_window(KA, NR, 8000, -8000);
	other = law_window(KA, NR, 7000, -7000);
	lw_motion_init(&motion, &window);
	motion.law.u = KS;
	motion.source = LW_EDGE_SOURCE_ENCODER;
	steps_sum = 0;
}

void tearDown(void)
{
}

static void edges(int dd, int count)
{
	while (count-- > 0) {
		steps_sum += lw_motion_encoder_edge(&motion, dd);
	}
}

/** Forward to the first edge whose position is inside the reversal at a side. */
static void enter_reversal(int region)
{
	while (lw_law_region(motion.window, motion.law.m) != region) {
		edges(1, 1);
	}
}

static void request(uint8_t requests, const struct lw_law_window *to, int32_t correction_usteps)
{
	motion.request_window = to;
	motion.request_correction_usteps = correction_usteps;
	motion.requests = requests;
}

static void test_init_stands_still(void)
{
	lw_motion_init(&motion, &window);
	TEST_ASSERT_EQUAL_PTR(&window, motion.window);
	TEST_ASSERT_EQUAL_UINT8(LW_EDGE_SOURCE_NONE, motion.source);
	TEST_ASSERT_EQUAL_INT(0, lw_motion_direction(&motion));
	TEST_ASSERT_EQUAL_INT32(0, motion.law.m);
}

static void test_the_odometer_counts_whatever_moves_the_carriage(void)
{
	static const uint8_t sources[] = {LW_EDGE_SOURCE_NONE, LW_EDGE_SOURCE_TIMER,
					  LW_EDGE_SOURCE_ENCODER};

	for (int i = 0; i < 3; i++) {
		motion.source = sources[i];
		edges(1, 100);
		edges(-1, 30);
		TEST_ASSERT_EQUAL_INT64(70 * (i + 1), motion.net_edges);
	}
	TEST_ASSERT_EQUAL_INT64(70, motion.pattern_edges);
}

static void test_edges_of_another_source_do_not_move_it(void)
{
	const struct lw_law before = motion.law;

	TEST_ASSERT_EQUAL_INT(0, lw_motion_timer_edge(&motion));
	motion.source = LW_EDGE_SOURCE_NONE;
	TEST_ASSERT_EQUAL_INT(0, lw_motion_timer_edge(&motion));
	edges(1, 10);
	motion.source = LW_EDGE_SOURCE_TIMER;
	edges(1, 10);
	TEST_ASSERT_EQUAL_INT32(0, steps_sum);
	TEST_ASSERT_TRUE(law_same(&before, &motion.law));
	for (int i = 0; i < 10; i++) {
		steps_sum += lw_motion_timer_edge(&motion);
	}
	TEST_ASSERT_EQUAL_INT32(10 * KS / LW_USTEP, steps_sum);
}

static void test_direction_follows_slope_and_drum(void)
{
	edges(1, 1);
	TEST_ASSERT_EQUAL_INT(1, lw_motion_direction(&motion));
	edges(-1, 1);
	TEST_ASSERT_EQUAL_INT(-1, lw_motion_direction(&motion));
	motion.law.u = -KS;
	TEST_ASSERT_EQUAL_INT(1, lw_motion_direction(&motion));
	motion.law.u = 0;
	TEST_ASSERT_EQUAL_INT(0, lw_motion_direction(&motion));
}

static void test_reached_tells_the_side(void)
{
	edges(1, 100);
	TEST_ASSERT_EQUAL_UINT8(0, motion.reached);
	enter_reversal(-1);
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_PLUS, motion.reached);
	motion.reached = 0;
	enter_reversal(0);
	enter_reversal(1);
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_PLUS | LW_MOTION_MINUS, motion.reached);
}

static void test_steps_equal_the_change_of_position_less_corrections(void)
{
	uint64_t seed = 7;
	int32_t corrections = 0;

	for (int run = 0; run < 300; run++) {
		const int dd = next_random(&seed) % 3 ? 1 : -1;

		if (motion.requests == 0) {
			const int32_t correction = (int32_t)(next_random(&seed) % 400) - 200;

			corrections += correction;
			request(LW_MOTION_REQUEST_CORRECTION, NULL, correction);
		}
		edges(dd, (int)(next_random(&seed) % 2000));
		TEST_ASSERT_TRUE(law_on_orbit(&motion.law, &window));
		TEST_ASSERT_EQUAL_INT32(lw_law_pos_usteps(motion.law.m),
					steps_sum + corrections - motion.request_correction_usteps);
	}
}

static void test_a_window_waits_for_the_sweep_of_both(void)
{
	/* Between the two reversal points: in the sweep of the old one only. */
	motion.law.m = 7500 * LW_USTEP;
	request(LW_MOTION_REQUEST_WINDOW, &other, 0);
	edges(1, 100);
	TEST_ASSERT_EQUAL_PTR(&window, motion.window);
	enter_reversal(-1);
	edges(1, 2 * NR);
	TEST_ASSERT_EQUAL_PTR(&window, motion.window);
	while (motion.law.m >= 7000 * LW_USTEP) {
		TEST_ASSERT_EQUAL_PTR(&window, motion.window);
		edges(1, 1);
	}
	TEST_ASSERT_EQUAL_PTR(&other, motion.window);
	TEST_ASSERT_EQUAL_UINT8(0, motion.requests);
	TEST_ASSERT_TRUE(law_on_orbit(&motion.law, &other));
}

static void test_a_wider_window_waits_for_the_end_of_the_reversal(void)
{
	motion.window = &other;
	enter_reversal(-1);
	request(LW_MOTION_REQUEST_WINDOW, &window, 0);
	for (int i = 1; i < 2 * NR; i++) {
		edges(1, 1);
		TEST_ASSERT_EQUAL_PTR(&other, motion.window);
	}
	edges(1, 1);
	TEST_ASSERT_EQUAL_PTR(&window, motion.window);
	TEST_ASSERT_EQUAL_INT32(-KS, motion.law.u);
}

static void test_a_correction_in_the_sweep_is_made_on_the_next_edge(void)
{
	request(LW_MOTION_REQUEST_CORRECTION, NULL, -123);
	edges(1, 1);
	TEST_ASSERT_EQUAL_INT32(KS - 123 * LW_USTEP, motion.law.m);
	TEST_ASSERT_EQUAL_UINT8(0, motion.requests);
	TEST_ASSERT_EQUAL_INT32(0, motion.request_correction_usteps);
	TEST_ASSERT_EQUAL_INT32(0, steps_sum);
}

/** The carriage is further out than the law knew: the law waits at the border of the sweep. */
static void check_clamp(int side)
{
	const int32_t border = side > 0 ? window.sweep_end : window.sweep_begin;

	setUp();
	motion.law.m = side * 7950 * LW_USTEP;
	motion.law.u = side * KS;
	request(LW_MOTION_REQUEST_CORRECTION, NULL, side * 200);
	edges(1, 1);
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_CORRECTION, motion.requests);
	TEST_ASSERT_EQUAL_INT(0, lw_law_region(&window, motion.law.m));
	TEST_ASSERT_TRUE(side * (border - motion.law.m) <= LW_USTEP);
	TEST_ASSERT_INT32_WITHIN(2, side * 150, motion.request_correction_usteps);

	/* What is kept counts down on the way back, while the law stays at the border. */
	enter_reversal(-side);
	edges(1, 2 * NR);
	while (motion.requests) {
		TEST_ASSERT_TRUE(side * (border - motion.law.m) <= 2 * LW_USTEP);
		TEST_ASSERT_TRUE(law_on_orbit(&motion.law, &window));
		edges(1, 1);
	}
	TEST_ASSERT_EQUAL_INT32(0, motion.request_correction_usteps);
	TEST_ASSERT_EQUAL_INT32(side * 7950 + side * 200,
				lw_law_pos_usteps(motion.law.m) - steps_sum);
}

static void test_a_correction_beyond_the_border_keeps_its_rest(void)
{
	check_clamp(1);
	check_clamp(-1);
}

static void test_rebase_takes_window_and_position_on_the_next_edge(void)
{
	window.sweep_end = INT32_MAX;
	motion.law.m = 20000 * LW_USTEP;
	request(LW_MOTION_REQUEST_REBASE, &other, -14000);
	edges(1, 1);
	TEST_ASSERT_EQUAL_PTR(&other, motion.window);
	TEST_ASSERT_EQUAL_INT32(6000 * LW_USTEP + KS, motion.law.m);
	TEST_ASSERT_EQUAL_UINT8(0, motion.requests);
}

/** A rebase that ends outside of the sweep lies at its border, the rest is a correction. */
static void check_rebase(int32_t m, int32_t correction_usteps)
{
	const int64_t wanted = (int64_t)m + KS + (int64_t)correction_usteps * LW_USTEP;

	setUp();
	window.sweep_begin = INT32_MIN;
	window.sweep_end = INT32_MAX;
	motion.law.m = m;
	request(LW_MOTION_REQUEST_REBASE, &other, correction_usteps);
	edges(1, 1);
	TEST_ASSERT_EQUAL_INT(0, lw_law_region(&other, motion.law.m));
	TEST_ASSERT_EQUAL_INT64(wanted, motion.law.m + (int64_t)motion.request_correction_usteps *
							       LW_USTEP);
	TEST_ASSERT_EQUAL_UINT8(motion.request_correction_usteps ? LW_MOTION_REQUEST_CORRECTION : 0,
				motion.requests);
	/* Not farther from the border than one microstep. */
	if (wanted >= other.sweep_end) {
		TEST_ASSERT_TRUE(motion.law.m >= other.sweep_end - LW_USTEP);
	}
	if (wanted < other.sweep_begin) {
		TEST_ASSERT_TRUE(motion.law.m < other.sweep_begin + LW_USTEP);
	}
}

static void test_rebase_outside_of_the_sweep_goes_to_its_border(void)
{
	for (int32_t fraction = 0; fraction < LW_USTEP; fraction += 4369) {
		check_rebase(fraction, 7100);
		check_rebase(fraction, -7100);
		check_rebase(fraction, 6999);
		check_rebase(fraction, 7000);
		check_rebase(fraction, -6999);
		check_rebase(fraction, -7000);
		check_rebase(fraction, 32000);
		check_rebase(fraction, -32000);
		/* The sum does not fit into a position before it is brought to the border. */
		check_rebase(32000 * LW_USTEP + fraction, 32000);
		check_rebase(-32000 * LW_USTEP - fraction, -32000);
	}
}

static void test_swap_takes_the_window_anywhere_and_keeps_a_correction(void)
{
	enter_reversal(-1);
	request(LW_MOTION_REQUEST_SWAP | LW_MOTION_REQUEST_CORRECTION, &other, 5);

	const int32_t m = motion.law.m;

	edges(1, 1);
	TEST_ASSERT_EQUAL_PTR(&other, motion.window);
	TEST_ASSERT_EQUAL_INT32(m + KS - KA, motion.law.m);
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_CORRECTION, motion.requests);
}

static void test_a_blocked_side_gets_no_steps(void)
{
	motion.blocked = LW_MOTION_PLUS;
	edges(1, 1000);
	TEST_ASSERT_EQUAL_INT32(0, steps_sum);
	TEST_ASSERT_EQUAL_UINT32(0, motion.steps);
	edges(-1, 1000);
	TEST_ASSERT_EQUAL_INT32(-(1000 * KS / LW_USTEP), steps_sum);
	motion.blocked = LW_MOTION_MINUS;
	edges(-1, 1000);
	TEST_ASSERT_EQUAL_INT32(-(1000 * KS / LW_USTEP), steps_sum);
	edges(1, 1000);
	TEST_ASSERT_INT32_WITHIN(1, 0, steps_sum);
	TEST_ASSERT_UINT32_WITHIN(1, 2 * (1000 * KS / LW_USTEP), motion.steps);
}

static void test_timer_edges_stop_at_rest_at_the_side_asked_for(void)
{
	for (int side = 0; side < 2; side++) {
		const uint8_t bit = side ? LW_MOTION_MINUS : LW_MOTION_PLUS;

		setUp();
		motion.source = LW_EDGE_SOURCE_TIMER;
		motion.stop_at_rest = bit;
		for (int i = 0; i < 200000 && motion.source == LW_EDGE_SOURCE_TIMER; i++) {
			lw_motion_timer_edge(&motion);
		}
		TEST_ASSERT_EQUAL_UINT8(LW_EDGE_SOURCE_NONE, motion.source);
		TEST_ASSERT_EQUAL_INT32(0, motion.law.u);
		TEST_ASSERT_EQUAL_INT32(side ? -8000 - 247 : 8000 + 247,
					lw_law_pos_usteps(motion.law.m));
	}
}

static void test_drum_edges_do_not_stop_at_rest(void)
{
	motion.stop_at_rest = LW_MOTION_PLUS | LW_MOTION_MINUS;
	edges(1, 200000);
	TEST_ASSERT_EQUAL_UINT8(LW_EDGE_SOURCE_ENCODER, motion.source);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_init_stands_still);
	RUN_TEST(test_the_odometer_counts_whatever_moves_the_carriage);
	RUN_TEST(test_edges_of_another_source_do_not_move_it);
	RUN_TEST(test_direction_follows_slope_and_drum);
	RUN_TEST(test_reached_tells_the_side);
	RUN_TEST(test_steps_equal_the_change_of_position_less_corrections);
	RUN_TEST(test_a_window_waits_for_the_sweep_of_both);
	RUN_TEST(test_a_wider_window_waits_for_the_end_of_the_reversal);
	RUN_TEST(test_a_correction_in_the_sweep_is_made_on_the_next_edge);
	RUN_TEST(test_a_correction_beyond_the_border_keeps_its_rest);
	RUN_TEST(test_rebase_takes_window_and_position_on_the_next_edge);
	RUN_TEST(test_rebase_outside_of_the_sweep_goes_to_its_border);
	RUN_TEST(test_swap_takes_the_window_anywhere_and_keeps_a_correction);
	RUN_TEST(test_a_blocked_side_gets_no_steps);
	RUN_TEST(test_timer_edges_stop_at_rest_at_the_side_asked_for);
	RUN_TEST(test_drum_edges_do_not_stop_at_rest);
	return UNITY_END();
}
