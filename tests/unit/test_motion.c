/* SPDX-License-Identifier: Apache-2.0 */
/* The motion as the edge interrupts see it. */
#include <unity.h>

#include "cases.h"
#include "law_check.h"
#include "lw/motion/motion.h"

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
	lw_motion_set_position(&motion, &window, 0, KS);
	lw_motion_set_source(&motion, LW_EDGE_SOURCE_ENCODER);
	steps_sum = 0;
}

void tearDown(void)
{
	cases_end();
}

/** Elsewhere, between two edges. */
static void place(const struct lw_law_window *to, int32_t m, int32_t u)
{
	const enum lw_edge_source source = motion.source;

	lw_motion_set_source(&motion, LW_EDGE_SOURCE_NONE);
	lw_motion_set_position(&motion, to, m, u);
	lw_motion_set_source(&motion, source);
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
	while (lw_law_region(motion.window, lw_motion_m(&motion)) != region) {
		edges(1, 1);
	}
}

static void request(uint8_t requests, const struct lw_law_window *to, int32_t correction_usteps)
{
	motion.request_window = to;
	motion.request_correction_usteps = correction_usteps;
	lw_motion_request(&motion, requests);
}

static void test_init_stands_still(void)
{
	lw_motion_init(&motion, &window);
	TEST_ASSERT_EQUAL_PTR(&window, motion.window);
	TEST_ASSERT_EQUAL_UINT8(LW_EDGE_SOURCE_NONE, motion.source);
	TEST_ASSERT_EQUAL_INT(0, lw_motion_direction(&motion));
	TEST_ASSERT_EQUAL_INT32(0, lw_motion_m(&motion));
}

static void test_the_odometer_counts_whatever_moves_the_carriage(void)
{
	static const uint8_t sources[] = {LW_EDGE_SOURCE_NONE, LW_EDGE_SOURCE_TIMER,
					  LW_EDGE_SOURCE_ENCODER};

	for (int i = 0; i < 3; i++) {
		lw_motion_set_source(&motion, (enum lw_edge_source)sources[i]);
		edges(1, 100);
		edges(-1, 30);
		TEST_ASSERT_EQUAL_INT64(70 * (i + 1), lw_motion_read(&motion).net_edges);
	}
	TEST_ASSERT_EQUAL_INT64(70, lw_motion_read(&motion).pattern_edges);
}

static void test_edges_of_another_source_do_not_move_it(void)
{
	const struct lw_law before = motion.law;

	TEST_ASSERT_EQUAL_INT(0, lw_motion_timer_edge(&motion));
	lw_motion_set_source(&motion, LW_EDGE_SOURCE_NONE);
	TEST_ASSERT_EQUAL_INT(0, lw_motion_timer_edge(&motion));
	edges(1, 10);
	lw_motion_set_source(&motion, LW_EDGE_SOURCE_TIMER);
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
	/* Three edges give a step at least. */
	edges(1, 3);
	TEST_ASSERT_EQUAL_INT(1, lw_motion_direction(&motion));
	edges(-1, 3);
	TEST_ASSERT_EQUAL_INT(-1, lw_motion_direction(&motion));
	motion.law.u = -KS;
	edges(-1, 3);
	TEST_ASSERT_EQUAL_INT(1, lw_motion_direction(&motion));
	edges(1, 3);
	TEST_ASSERT_EQUAL_INT(-1, lw_motion_direction(&motion));
	motion.law.u = 0;
	TEST_ASSERT_EQUAL_INT(0, lw_motion_direction(&motion));
}

static bool turned(enum lw_motion_side_bit side)
{
	return lw_motion_take_turned(&motion, side);
}

static void test_a_slope_change_tells_its_side_once(void)
{
	for (int long_way = 0; long_way < 2; long_way++) {
		setUp();
		if (long_way) {
			lw_motion_block(&motion, LW_MOTION_PLUS, true);
		}
		enter_reversal(-1);
		TEST_ASSERT_FALSE(turned(LW_MOTION_PLUS) || turned(LW_MOTION_MINUS));
		edges(1, 1);
		TEST_ASSERT_FALSE(turned(LW_MOTION_MINUS));
		TEST_ASSERT_TRUE(turned(LW_MOTION_PLUS));
		TEST_ASSERT_FALSE(turned(LW_MOTION_PLUS));

		/* Taking it back changes the slope, too. */
		edges(-1, 1);
		TEST_ASSERT_TRUE(turned(LW_MOTION_PLUS));
		enter_reversal(-1);
		enter_reversal(0);
		enter_reversal(1);
		TEST_ASSERT_TRUE(turned(LW_MOTION_PLUS));
		edges(1, 1);
		TEST_ASSERT_FALSE(turned(LW_MOTION_PLUS));
		TEST_ASSERT_TRUE(turned(LW_MOTION_MINUS));
	}
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
		TEST_ASSERT_EQUAL_INT32(lw_law_pos_usteps(lw_motion_m(&motion)),
					steps_sum + corrections - motion.request_correction_usteps);
	}
}

static void test_a_window_waits_for_the_sweep_of_both(void)
{
	/* Between the two reversal points: in the sweep of the old one only. */
	place(motion.window, 7500 * LW_USTEP, motion.law.u);
	request(LW_MOTION_REQUEST_WINDOW, &other, 0);
	edges(1, 100);
	TEST_ASSERT_EQUAL_PTR(&window, motion.window);
	enter_reversal(-1);
	edges(1, 2 * NR);
	TEST_ASSERT_EQUAL_PTR(&window, motion.window);
	while (lw_motion_m(&motion) >= 7000 * LW_USTEP) {
		TEST_ASSERT_EQUAL_PTR(&window, motion.window);
		edges(1, 1);
	}
	TEST_ASSERT_EQUAL_PTR(&other, motion.window);
	TEST_ASSERT_EQUAL_UINT8(0, motion.requests);
	TEST_ASSERT_TRUE(law_on_orbit(&motion.law, &other));
}

static void test_a_wider_window_waits_for_the_end_of_the_reversal(void)
{
	place(&other, 0, KS);
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
	TEST_ASSERT_EQUAL_INT32(KS - 123 * LW_USTEP, lw_motion_m(&motion));
	TEST_ASSERT_EQUAL_UINT8(0, motion.requests);
	TEST_ASSERT_EQUAL_INT32(0, motion.request_correction_usteps);
	TEST_ASSERT_EQUAL_INT32(0, steps_sum);
}

/** The carriage is further out than the law knew: the law waits at the border of the sweep. */
static void check_clamp(int side)
{
	const int32_t border = side > 0 ? window.sweep_end : window.sweep_begin;

	setUp();
	place(motion.window, side * 7950 * LW_USTEP, motion.law.u);
	motion.law.u = side * KS;
	request(LW_MOTION_REQUEST_CORRECTION, NULL, side * 200);
	edges(1, 1);
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_CORRECTION, motion.requests);
	TEST_ASSERT_EQUAL_INT(0, lw_law_region(&window, lw_motion_m(&motion)));
	TEST_ASSERT_TRUE(side * (border - lw_motion_m(&motion)) <= LW_USTEP);
	TEST_ASSERT_INT32_WITHIN(2, side * 150, motion.request_correction_usteps);

	/* What is kept counts down on the way back, while the law stays at the border. */
	enter_reversal(-side);
	edges(1, 2 * NR);
	while (motion.requests) {
		TEST_ASSERT_TRUE(side * (border - lw_motion_m(&motion)) <= 2 * LW_USTEP);
		TEST_ASSERT_TRUE(law_on_orbit(&motion.law, &window));
		edges(1, 1);
	}
	TEST_ASSERT_EQUAL_INT32(0, motion.request_correction_usteps);
	TEST_ASSERT_EQUAL_INT32(side * 7950 + side * 200,
				lw_law_pos_usteps(lw_motion_m(&motion)) - steps_sum);
}

static void test_a_correction_beyond_the_border_keeps_its_rest(void)
{
	check_clamp(1);
	check_clamp(-1);
}

static void test_rebase_takes_window_and_position_on_the_next_edge(void)
{
	window.sweep_end = INT32_MAX;
	place(&window, 20000 * LW_USTEP, motion.law.u);
	request(LW_MOTION_REQUEST_REBASE, &other, -14000);
	edges(1, 1);
	TEST_ASSERT_EQUAL_PTR(&other, motion.window);
	TEST_ASSERT_EQUAL_INT32(6000 * LW_USTEP + KS, lw_motion_m(&motion));
	TEST_ASSERT_EQUAL_UINT8(0, motion.requests);
}

/** A rebase that ends outside of the sweep lies at its border, the rest is a correction. */
static void check_rebase(int32_t m, int32_t correction_usteps)
{
	const int64_t wanted = (int64_t)m + KS + (int64_t)correction_usteps * LW_USTEP;

	setUp();
	window.sweep_begin = INT32_MIN + LW_USTEP;
	window.sweep_end = INT32_MAX;
	place(motion.window, m, motion.law.u);
	request(LW_MOTION_REQUEST_REBASE, &other, correction_usteps);
	edges(1, 1);
	TEST_ASSERT_EQUAL_INT(0, lw_law_region(&other, lw_motion_m(&motion)));
	TEST_ASSERT_EQUAL_INT64(wanted,
				lw_motion_m(&motion) +
					(int64_t)motion.request_correction_usteps * LW_USTEP);
	TEST_ASSERT_EQUAL_UINT8(motion.request_correction_usteps ? LW_MOTION_REQUEST_CORRECTION : 0,
				motion.requests);
	/* Not farther from the border than one microstep. */
	if (wanted >= other.sweep_end) {
		TEST_ASSERT_TRUE(lw_motion_m(&motion) >= other.sweep_end - LW_USTEP);
	}
	if (wanted < other.sweep_begin) {
		TEST_ASSERT_TRUE(lw_motion_m(&motion) < other.sweep_begin + LW_USTEP);
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

	const int32_t m = lw_motion_m(&motion);

	edges(1, 1);
	TEST_ASSERT_EQUAL_PTR(&other, motion.window);
	TEST_ASSERT_EQUAL_INT32(m + KS - KA, lw_motion_m(&motion));
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
	FOR_EACH_SIDE(side) {
		const uint8_t bit = side ? LW_MOTION_MINUS : LW_MOTION_PLUS;

		setUp();
		lw_motion_set_source(&motion, LW_EDGE_SOURCE_TIMER);
		motion.stop_at_rest = bit;
		for (int i = 0; i < 200000 && motion.source == LW_EDGE_SOURCE_TIMER; i++) {
			lw_motion_timer_edge(&motion);
		}
		TEST_ASSERT_EQUAL_UINT8(LW_EDGE_SOURCE_NONE, motion.source);
		TEST_ASSERT_EQUAL_INT32(0, motion.law.u);
		TEST_ASSERT_EQUAL_INT32(side ? -8000 - 247 : 8000 + 247,
					lw_law_pos_usteps(lw_motion_m(&motion)));
	}
}

static int long_edge(struct lw_motion *of, int dd)
{
	return dd > 0 ? lw_motion_long_forward(of) : lw_motion_long_backward(of);
}

static void test_drum_edges_do_not_stop_at_rest(void)
{
	motion.stop_at_rest = LW_MOTION_PLUS | LW_MOTION_MINUS;
	edges(1, 200000);
	TEST_ASSERT_EQUAL_UINT8(LW_EDGE_SOURCE_ENCODER, motion.source);
}

static void test_the_short_way_does_what_the_long_way_does(void)
{
	static const struct {
		int32_t ka;
		int32_t nr;
		int32_t plus_usteps;
		int32_t minus_usteps;
	} sets[] = {{KA, NR, 300, -300},
		    {65535, 1, 40, -20},
		    {300, 200, 31000, 30900},
		    {23, 1187, -30000, -30100},
		    {4369, 15, 32000, -32000}}; /* the sweep is longer than half of 2^32 */
	uint64_t seed = 5;

	for (size_t i = 0; i < sizeof(sets) / sizeof(sets[0]); i++) {
		const int32_t ks = sets[i].ka * sets[i].nr;
		struct lw_motion long_way;

		window = law_window(sets[i].ka, sets[i].nr, sets[i].plus_usteps,
				    sets[i].minus_usteps);
		/* Near a reversal: the longest sweep is more than a run. */
		place(&window, window.sweep_end - 1, ks);
		lw_motion_set_source(&motion, LW_EDGE_SOURCE_NONE);
		lw_motion_set_source(&motion, LW_EDGE_SOURCE_ENCODER);
		long_way = motion;
		edges(1, 1);
		(void)lw_motion_long_forward(&long_way);
		for (int run = 0; run < 200; run++) {
			const int dd = next_random(&seed) % 8 ? 1 : -1;

			for (uint32_t count = next_random(&seed) % 1024 + 1; count > 0; count--) {
				TEST_ASSERT_EQUAL_UINT32(motion.law.span, motion.law.open_span);
				TEST_ASSERT_EQUAL_INT(long_edge(&long_way, dd),
						      lw_motion_edge(&motion, dd));
				TEST_ASSERT_TRUE(law_same(&long_way.law, &motion.law));
				TEST_ASSERT_TRUE(law_on_orbit(&motion.law, &window));
			}
		}
		TEST_ASSERT_EQUAL_UINT32(long_way.steps, motion.steps);
		TEST_ASSERT_EQUAL_INT32(long_way.last_step, motion.last_step);
		TEST_ASSERT_EQUAL_INT32(long_way.law.turned, motion.law.turned);
	}
}

/** Is the next edge one that looks at everything? And is the one after it again a short one? */
static void check_closed_for_one_edge(void)
{
	TEST_ASSERT_EQUAL_UINT32(0, motion.law.open_span);
	edges(1, 1);
	TEST_ASSERT_EQUAL_UINT32(motion.law.span, motion.law.open_span);
}

static void test_whatever_is_asked_for_closes_the_short_way(void)
{
	check_closed_for_one_edge();
	request(LW_MOTION_REQUEST_CORRECTION, NULL, 3);
	check_closed_for_one_edge();
	request(LW_MOTION_REQUEST_WINDOW, &other, 0);
	check_closed_for_one_edge();
	request(LW_MOTION_REQUEST_SWAP, &window, 0);
	check_closed_for_one_edge();
	request(LW_MOTION_REQUEST_REBASE, &other, 1);
	check_closed_for_one_edge();
	lw_motion_block(&motion, LW_MOTION_MINUS, true);
	edges(1, 2);
	TEST_ASSERT_EQUAL_UINT32(0, motion.law.open_span);
	lw_motion_block(&motion, LW_MOTION_MINUS, false);
	check_closed_for_one_edge();
	lw_motion_set_source(&motion, LW_EDGE_SOURCE_NONE);
	edges(1, 2);
	TEST_ASSERT_EQUAL_UINT32(0, motion.law.open_span);
	window.dwell_plus_edges = 1;
	place(&window, 0, KS);
	lw_motion_set_source(&motion, LW_EDGE_SOURCE_ENCODER);
	edges(1, 2);
	TEST_ASSERT_EQUAL_UINT32(0, motion.law.open_span);
}

static void test_counters_go_on_beyond_32_bits(void)
{
	const uint32_t far = 1u << 30;
	int64_t expected = 0;

	edges(1, 10);
	expected += 10;
	for (int direction = 1; direction >= -1; direction -= 2) {
		for (int i = 0; i < 10; i++) {
			motion.edges += (uint32_t)direction * far;
			expected += direction * (int64_t)far;
			TEST_ASSERT_EQUAL_INT64(expected, lw_motion_read(&motion).net_edges);
			lw_motion_count(&motion);
			TEST_ASSERT_EQUAL_INT64(expected, lw_motion_read(&motion).net_edges);
			TEST_ASSERT_EQUAL_INT64(expected, lw_motion_read(&motion).pattern_edges);
		}
		edges(direction, 7);
		expected += 7 * direction;
	}
	lw_motion_set_source(&motion, LW_EDGE_SOURCE_NONE);
	lw_motion_begin_pattern(&motion);
	edges(1, 5);
	lw_motion_set_source(&motion, LW_EDGE_SOURCE_ENCODER);
	edges(-1, 3);
	TEST_ASSERT_EQUAL_INT64(expected + 2, lw_motion_read(&motion).net_edges);
	TEST_ASSERT_EQUAL_INT64(-3, lw_motion_read(&motion).pattern_edges);
}

/** One edge into the place `m` with slope `u`, of the plus reversal on its way back. */
static void come_back_to(int32_t m, int32_t u)
{
	place(&window, m - u, u + KA);
	edges(1, 1);
	TEST_ASSERT_EQUAL_INT32(m, lw_motion_m(&motion));
	TEST_ASSERT_EQUAL_INT32(u, motion.law.u);
}

static void test_edges_taken_together_step_or_stand_as_one_by_one(void)
{
	int32_t steps = 99;

	edges(1, 1);
	TEST_ASSERT_TRUE(lw_motion_encoder_edges(&motion, 100, &steps));
	TEST_ASSERT_EQUAL_INT32(101 * KS / LW_USTEP, steps);
	come_back_to(window.sweep_end, KA - KS);
	TEST_ASSERT_FALSE(lw_motion_encoder_edges(&motion, 1, &steps));

	lw_motion_set_source(&motion, LW_EDGE_SOURCE_NONE);
	steps = 99;
	TEST_ASSERT_TRUE(lw_motion_encoder_edges(&motion, 7, &steps));
	TEST_ASSERT_EQUAL_INT32(0, steps);
	TEST_ASSERT_EQUAL_UINT32(7, motion.unfollowed_edges);
}

static void test_the_law_is_sound_at_every_place_of_the_pattern(void)
{
	for (int i = 0; i < 200000; i++) {
		edges(1, 1);
		TEST_ASSERT_TRUE(lw_motion_is_sound(&motion));
	}
	/* The reversal begins at the sweep's end: there the slope is another. */
	come_back_to(window.sweep_end, KA - KS);
	TEST_ASSERT_TRUE(lw_motion_is_sound(&motion));
	come_back_to(window.sweep_end - 1, -KS);
	TEST_ASSERT_TRUE(lw_motion_is_sound(&motion));
}

static void test_a_mended_law_follows_the_drum_again(void)
{
	static const int32_t spoilt[] = {1 - KS, KS - 1, -1, 0, 1};
	static const int32_t mended[] = {-KS, KS, -KS, KS, KS};

	for (int i = 0; i < 5; i++) {
		place(&window, 0, spoilt[i]);
		TEST_ASSERT_FALSE(lw_motion_is_sound(&motion));
		lw_motion_mend(&motion, &other);
		TEST_ASSERT_EQUAL_PTR(&other, motion.window);
		TEST_ASSERT_TRUE(lw_motion_is_sound(&motion));
		TEST_ASSERT_EQUAL_INT32(mended[i], motion.law.u);
		steps_sum = 0;
		edges(1, 100);
		TEST_ASSERT_EQUAL_INT32(lw_law_pos_usteps(100 * mended[i]), steps_sum);
	}
}

static void test_the_smallest_slope_change_tells_its_side(void)
{
	window = law_window(1, 3, 10, -10);
	FOR_EACH_SIDE(side) {
		place(&window, side ? window.sweep_begin - 1 : window.sweep_end, side ? -3 : 3);
		edges(1, 1);
		TEST_ASSERT_FALSE(turned(side ? LW_MOTION_PLUS : LW_MOTION_MINUS));
		TEST_ASSERT_TRUE(turned(side ? LW_MOTION_MINUS : LW_MOTION_PLUS));
	}
}

static void test_a_correction_that_just_fits_is_made_whole(void)
{
	FOR_EACH_SIDE(side) {
		const int32_t way_usteps = side ? -3 : 3;
		const int32_t last = side ? window.sweep_begin : window.sweep_end - 1;

		place(&window, last - way_usteps * LW_USTEP - KS, KS);
		request(LW_MOTION_REQUEST_CORRECTION, NULL, way_usteps);
		edges(1, 1);
		TEST_ASSERT_EQUAL_INT32(last, lw_motion_m(&motion));
		TEST_ASSERT_EQUAL_UINT8(0, motion.requests);

		/* One more would leave the sweep. */
		place(&window, last - way_usteps * LW_USTEP - KS, KS);
		request(LW_MOTION_REQUEST_CORRECTION, NULL, side ? -4 : 4);
		edges(1, 1);
		TEST_ASSERT_EQUAL_INT32(last, lw_motion_m(&motion));
		TEST_ASSERT_EQUAL_INT32(side ? -1 : 1, motion.request_correction_usteps);
	}
}

static void test_rebase_to_the_very_border(void)
{
	for (int32_t usteps = -2; usteps <= 2; usteps++) {
		for (int32_t offset = -1; offset <= 1; offset++) {
			const int32_t by = usteps * LW_USTEP + offset - KS;

			check_rebase(other.sweep_end + by, 0);
			check_rebase(other.sweep_begin + by, 0);
		}
	}
}

static void test_swap_leaves_the_place_alone_and_a_correction_to_the_next_edge(void)
{
	request(LW_MOTION_REQUEST_SWAP | LW_MOTION_REQUEST_CORRECTION, &other, 5);
	edges(1, 1);
	TEST_ASSERT_EQUAL_PTR(&other, motion.window);
	TEST_ASSERT_EQUAL_INT32(KS, lw_motion_m(&motion));
	edges(1, 1);
	TEST_ASSERT_EQUAL_INT32(2 * KS + 5 * LW_USTEP, lw_motion_m(&motion));
}

static void test_steps_of_a_cam_are_counted_either_way(void)
{
	const struct lw_cam_scale scale = lw_cam_scale(1, 1, 1, 1, 10);

	for (int32_t slope = 1; slope <= 3; slope += 2) {
		const struct lw_cam_table hill = {.row_count = 3,
						  .rows = {{0, 0}, {100, 100 * slope}, {200}}};

		setUp();
		motion.cam = (struct lw_cam_motion){.on = true, .steps_max = 4};
		lw_cam_start(&motion.cam.cam, &hill, &scale, 0, 0);
		edges(1, 50);
		TEST_ASSERT_EQUAL_INT32(50 * slope, steps_sum);
		TEST_ASSERT_EQUAL_UINT32(50 * slope, lw_motion_read(&motion).steps);
		TEST_ASSERT_EQUAL_INT(1, lw_motion_direction(&motion));
		edges(-1, 20);
		TEST_ASSERT_EQUAL_UINT32(70 * slope, lw_motion_read(&motion).steps);
		TEST_ASSERT_EQUAL_INT(-1, lw_motion_direction(&motion));
	}
}

/** Steep, flat and level rows: straight and curved pieces, with numerators of 32 and of 64 bit. */
static struct lw_cam_table hills = {
	.row_count = 7,
	.advance = -20,
	.rows = {{0, 5}, {3, 9}, {40, -60}, {41, -60}, {600, 700}, {1200, 700}, {211203, -15}},
};

/** Follow the hills from somewhere. */
static void follow_hills(struct lw_motion *of, enum lw_cam_interpolation interpolation)
{
	const struct lw_cam_scale scale = lw_cam_scale(7, 3, 5, 11, 10);

	hills.interpolation = (uint16_t)interpolation;
	of->cam = (struct lw_cam_motion){.on = true, .steps_max = 4};
	lw_cam_start(&of->cam.cam, &hills, &scale, -700, 0);
}

static void assert_same_motion(const struct lw_motion *a, const struct lw_motion *b)
{
	const struct lw_motion_reading reading = lw_motion_read(a);
	const struct lw_motion_reading expected = lw_motion_read(b);
	const struct lw_cam_reading cam = lw_cam_motion_read(&a->cam);
	const struct lw_cam_reading expected_cam = lw_cam_motion_read(&b->cam);

	TEST_ASSERT_EQUAL_MEMORY(&expected_cam, &cam, sizeof(cam));
	TEST_ASSERT_EQUAL_INT32(expected.m, reading.m);
	TEST_ASSERT_EQUAL_INT32(expected.m, lw_motion_m(a));
	TEST_ASSERT_EQUAL_UINT32(expected.steps, reading.steps);
	TEST_ASSERT_EQUAL_INT(lw_motion_direction(b), lw_motion_direction(a));
}

static void test_the_cams_short_way_equals_its_long_way(void)
{
	for (int interpolation = 0; interpolation <= LW_CAM_INTERPOLATION_TRAPEZOID;
	     interpolation++) {
		uint64_t seed = 20;
		int kinds = 0;
		struct lw_motion long_way;

		setUp();
		follow_hills(&motion, (enum lw_cam_interpolation)interpolation);
		long_way = motion;
		for (int run = 0; run < 400; run++) {
			const int dd = next_random(&seed) % 3 ? 1 : -1;

			for (uint32_t count = next_random(&seed) % 700 + 1; count > 0; count--) {
				if (next_random(&seed) % 32 == 0) {
					lw_cam_motion_prepare(&motion.cam);
				}
				lw_cam_motion_close(&long_way.cam);
				TEST_ASSERT_EQUAL_INT(lw_motion_encoder_edge(&long_way, dd),
						      lw_motion_encoder_edge(&motion, dd));
				TEST_ASSERT_EQUAL_INT32(motion.cam.cam.piece.kind * dd,
							motion.cam.open);
				kinds |= 1 << motion.cam.cam.piece.kind;
				assert_same_motion(&motion, &long_way);
			}
		}
		TEST_ASSERT_EQUAL_INT32(interpolation == LW_CAM_INTERPOLATION_TRAPEZOID
						? 1 << LW_CAM_STRAIGHT | 1 << LW_CAM_CURVED |
							  1 << LW_CAM_WIDE
						: 1 << LW_CAM_STRAIGHT,
					kinds);
		/* All is accounted for where no edge moves the carriage any more. */
		lw_motion_set_source(&motion, LW_EDGE_SOURCE_NONE);
		TEST_ASSERT_EQUAL_INT32(0, motion.cam.ahead_usteps);
		TEST_ASSERT_EQUAL_UINT32(long_way.law.rel, motion.law.rel);
		assert_same_motion(&motion, &long_way);
		edges(1, 3);
		TEST_ASSERT_EQUAL_INT32(LW_CAM_CLOSED, motion.cam.open);
		TEST_ASSERT_EQUAL_UINT32(3, motion.unfollowed_edges);
		assert_same_motion(&motion, &long_way);
		/* And what has not been followed is caught up. */
		lw_motion_set_source(&motion, LW_EDGE_SOURCE_ENCODER);
		edges(1, 1);
		TEST_ASSERT_EQUAL_INT32(LW_CAM_CLOSED, motion.cam.open);
		TEST_ASSERT_EQUAL_INT32(-2, motion.cam.phase_edges);
		edges(1, 20);
		TEST_ASSERT_EQUAL_INT32(0, motion.cam.phase_edges);
		TEST_ASSERT_TRUE(motion.cam.open != LW_CAM_CLOSED);
	}
}

static void test_what_is_asked_for_closes_the_cams_short_way(void)
{
	int32_t given;

	follow_hills(&motion, LW_CAM_INTERPOLATION_LINEAR);
	edges(1, 300);
	TEST_ASSERT_EQUAL_INT32(LW_CAM_STRAIGHT, motion.cam.open);
	lw_cam_motion_shift(&motion.cam, 4);
	TEST_ASSERT_EQUAL_INT32(LW_CAM_CLOSED, motion.cam.open);
	edges(1, 3);
	TEST_ASSERT_EQUAL_INT32(3, motion.cam.phase_edges);
	TEST_ASSERT_EQUAL_INT32(LW_CAM_CLOSED, motion.cam.open);
	edges(-1, 1);
	TEST_ASSERT_EQUAL_INT32(4, motion.cam.phase_edges);
	TEST_ASSERT_EQUAL_INT32(-LW_CAM_STRAIGHT, motion.cam.open);

	/* No step toward a blocked side, and they are told. */
	edges(1, 300);
	given = steps_sum;
	lw_motion_block(&motion, LW_MOTION_PLUS, true);
	lw_motion_block(&motion, LW_MOTION_MINUS, true);
	edges(1, 300);
	TEST_ASSERT_EQUAL_INT32(given, steps_sum);
	TEST_ASSERT_EQUAL_INT32(LW_CAM_CLOSED, motion.cam.open);
	TEST_ASSERT_TRUE(lw_motion_take_withheld(&motion) != 0);
	lw_motion_block(&motion, LW_MOTION_PLUS, false);
	lw_motion_block(&motion, LW_MOTION_MINUS, false);
	edges(1, 1);
	TEST_ASSERT_EQUAL_INT32(LW_CAM_STRAIGHT, motion.cam.open);
}

/** A day in one row: the steps that are added up never need more than 32 bit. */
static void test_many_steps_of_a_cam_are_accounted_for_in_time(void)
{
	for (int sign = -1; sign <= 1; sign += 2) {
		int64_t pos;

		setUp();
		follow_hills(&motion, LW_CAM_INTERPOLATION_LINEAR);
		edges(1, 300);
		motion.cam.ahead_usteps = (int32_t)(sign * (int64_t)(INT32_MAX / 2 - 1000));
		lw_cam_motion_prepare(&motion.cam);
		TEST_ASSERT_EQUAL_INT32(LW_CAM_STRAIGHT, motion.cam.open);
		motion.cam.ahead_usteps = (int32_t)(sign * (int64_t)(INT32_MAX / 2 + 1000));
		lw_cam_motion_prepare(&motion.cam);
		TEST_ASSERT_EQUAL_INT32(LW_CAM_CLOSED, motion.cam.open);
		pos = lw_cam_pos(&motion.cam.cam) + motion.cam.ahead_usteps - steps_sum;
		edges(1, 1);
		TEST_ASSERT_EQUAL_INT32(0, motion.cam.ahead_usteps);
		TEST_ASSERT_EQUAL_INT32(LW_CAM_STRAIGHT, motion.cam.open);
		TEST_ASSERT_EQUAL_INT64(pos + steps_sum, motion.cam.cam.was_pos);
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_init_stands_still);
	RUN_TEST(test_the_odometer_counts_whatever_moves_the_carriage);
	RUN_TEST(test_edges_of_another_source_do_not_move_it);
	RUN_TEST(test_direction_follows_slope_and_drum);
	RUN_TEST(test_a_slope_change_tells_its_side_once);
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
	RUN_TEST(test_the_short_way_does_what_the_long_way_does);
	RUN_TEST(test_whatever_is_asked_for_closes_the_short_way);
	RUN_TEST(test_counters_go_on_beyond_32_bits);
	RUN_TEST(test_edges_taken_together_step_or_stand_as_one_by_one);
	RUN_TEST(test_the_law_is_sound_at_every_place_of_the_pattern);
	RUN_TEST(test_a_mended_law_follows_the_drum_again);
	RUN_TEST(test_the_smallest_slope_change_tells_its_side);
	RUN_TEST(test_a_correction_that_just_fits_is_made_whole);
	RUN_TEST(test_rebase_to_the_very_border);
	RUN_TEST(test_swap_leaves_the_place_alone_and_a_correction_to_the_next_edge);
	RUN_TEST(test_steps_of_a_cam_are_counted_either_way);
	RUN_TEST(test_the_cams_short_way_equals_its_long_way);
	RUN_TEST(test_what_is_asked_for_closes_the_cams_short_way);
	RUN_TEST(test_many_steps_of_a_cam_are_accounted_for_in_time);
	return UNITY_END();
}
