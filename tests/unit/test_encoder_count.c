/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Transitions of the encoder that a counter in hardware has seen, taken together: the judge is the
 * same controller that takes each by the levels of its channels.
 */
#include <string.h>

#include <unity.h>

#include "law_check.h"
#include "lw/control/controller.h"

#define KA 23
#define NR 1187
#define KS (KA * NR)

static const uint8_t edges_per_pulse[] = {1, 2, 4};

static struct lw_law_window window;
static struct lw_law_window other;
static struct lw_controller together;
static struct lw_controller one_by_one;
static uint32_t place; /**< of the drum, in transitions */
static uint64_t seed;

void setUp(void)
{
	window = law_window(KA, NR, 300, -300);
	other = law_window(KA, NR, 250, -320);
	seed = 7;
	place = 0;
}

void tearDown(void)
{
}

/** A in bit 1, B in bit 0. */
static unsigned int levels_at(uint32_t at)
{
	static const uint8_t forward[4] = {0, 2, 3, 1};

	return forward[at & 3u];
}

/** @param inversions of A, B and the direction, by bit */
static void start(int edges, unsigned int inversions, int32_t m, int32_t u)
{
	const struct lw_quadrature_config config = {
		.edges_per_pulse = (uint8_t)edges,
		.invert_a = inversions & 1u,
		.invert_b = inversions & 2u,
		.invert_direction = inversions & 4u,
	};

	memset(&together, 0, sizeof(together));
	lw_quadrature_init(&together.quadrature, &config, levels_at(place) & 2u,
			   levels_at(place) & 1u);
	lw_motion_init(&together.motion, &window);
	lw_motion_set_position(&together.motion, &window, m, u);
	lw_motion_set_source(&together.motion, LW_EDGE_SOURCE_ENCODER);
	memcpy(&one_by_one, &together, sizeof(together));
}

/** One transition, by its levels. */
static int pass(int way)
{
	place += (uint32_t)way;
	return lw_controller_encoder(&one_by_one, levels_at(place) & 2u, levels_at(place) & 1u);
}

static void check_same(void)
{
	TEST_ASSERT_EQUAL_MEMORY(&one_by_one.quadrature, &together.quadrature,
				 sizeof(together.quadrature));
	TEST_ASSERT_EQUAL_MEMORY(&one_by_one.motion, &together.motion, sizeof(together.motion));
}

static void turn(int32_t transitions)
{
	int steps = 0;

	for (int32_t i = 0; i < (transitions < 0 ? -transitions : transitions); i++) {
		steps += pass(transitions < 0 ? -1 : 1);
	}
	TEST_ASSERT_EQUAL_INT(steps, lw_controller_encoder_count(&together, transitions));
	check_same();
}

/** Any run: mostly short, a few long, mostly onward. */
static int32_t any_run(void)
{
	const int32_t length =
		1 + (int32_t)(next_random(&seed) % (next_random(&seed) % 16 == 0 ? 20000 : 12));

	return next_random(&seed) % 8 == 0 ? -length : length;
}

static void test_any_runs_are_what_their_transitions_are(void)
{
	for (size_t mode = 0; mode < sizeof(edges_per_pulse); mode++) {
		for (unsigned int inversions = 0; inversions < 8; inversions++) {
			start(edges_per_pulse[mode], inversions, 0, KS);
			for (int i = 0; i < 1500; i++) {
				turn(any_run());
			}
			TEST_ASSERT_TRUE(together.motion.steps > 10000);
		}
	}
}

static void test_and_back_again_to_the_last_bit(void)
{
	struct lw_law before;
	int32_t runs[100];

	start(2, 0, 0, -KS);
	turn(1);
	before = together.motion.law;
	for (int i = 0; i < 100; i++) {
		runs[i] = any_run();
		turn(runs[i]);
	}
	for (int i = 100; i-- > 0;) {
		turn(-runs[i]);
	}
	TEST_ASSERT_TRUE(law_same(&before, &together.motion.law));
	TEST_ASSERT_EQUAL_UINT32(together.motion.edges, one_by_one.motion.edges);
}

static void test_a_whole_erasure_at_once(void)
{
	for (int way = -1; way <= 1; way += 2) {
		start(2, 0, 0, KS);
		turn(way);
		turn(way * 400000);
		start(4, 0, 0, KS);
		together.motion.source = LW_EDGE_SOURCE_NONE;
		one_by_one.motion.source = LW_EDGE_SOURCE_NONE;
		turn(way);
		turn(way * 400000);
		TEST_ASSERT_EQUAL_UINT32((uint32_t)(way * 400001),
					 together.motion.unfollowed_edges);
		TEST_ASSERT_EQUAL_UINT32(0, together.motion.steps);
	}
}

/** What is asked for is served by the first of the edges, as always. */
static void test_requests_and_blocks_meanwhile(void)
{
	start(2, 0, 0, KS);
	for (int i = 0; i < 3000; i++) {
		struct lw_controller *both[] = {&together, &one_by_one};
		const uint64_t what = next_random(&seed) % 24;
		const int32_t correction = (int32_t)(next_random(&seed) % 9) - 4;

		for (int j = 0; j < 2; j++) {
			struct lw_motion *motion = &both[j]->motion;

			motion->request_window = i % 2 ? &window : &other;
			if (what == 0) {
				lw_motion_request(motion, LW_MOTION_REQUEST_WINDOW);
			} else if (what == 1) {
				motion->request_correction_usteps = correction;
				lw_motion_request(motion, LW_MOTION_REQUEST_CORRECTION);
			} else if (what < 4) {
				lw_motion_block(motion, LW_MOTION_PLUS, what == 2);
			} else if (what == 4) {
				lw_motion_set_source(motion, LW_EDGE_SOURCE_ENCODER);
			}
		}
		turn(any_run());
	}
}

/** Transitions to the next step, or up to a limit without one. */
static uint32_t to_step(int way, uint32_t limit)
{
	uint32_t count = 0;
	int steps = 0;

	do {
		steps = pass(way);
		count++;
	} while (steps == 0 && count < limit);
	return count;
}

static void test_the_next_step_is_where_the_reach_says(void)
{
	uint32_t exact = 0;

	for (size_t mode = 0; mode < sizeof(edges_per_pulse); mode++) {
		for (unsigned int inversions = 0; inversions < 8; inversions++) {
			start(edges_per_pulse[mode], inversions, 0, KS);
			for (int i = 0; i < 2000; i++) {
				const int32_t run = any_run();
				const int way = run > 0 ? 1 : -1;
				uint32_t reach;
				uint32_t found;

				turn(run);
				reach = lw_controller_encoder_reach(&together, run);
				const struct lw_controller kept = one_by_one;
				const uint32_t kept_place = place;

				found = to_step(way, 4000);
				one_by_one = kept;
				place = kept_place;
				TEST_ASSERT_TRUE(reach >= 1 && reach <= found);
				if (together.motion.law.rel < together.motion.law.open_span) {
					TEST_ASSERT_EQUAL_UINT32(found, reach);
					exact++;
				}
			}
		}
	}
	TEST_ASSERT_TRUE(exact > 10000);
}

static void
test_where_nothing_moves_the_reach_is_long_and_where_something_waits_it_is_one_edge(void)
{
	start(2, 0, 0, KS);
	turn(2);
	lw_motion_set_source(&together.motion, LW_EDGE_SOURCE_NONE);
	TEST_ASSERT_EQUAL_UINT32(2 * LW_MOTION_IDLE_EDGES - 1,
				 lw_controller_encoder_reach(&together, 1));
	lw_motion_set_source(&together.motion, LW_EDGE_SOURCE_ENCODER);
	TEST_ASSERT_EQUAL_UINT32(1, lw_controller_encoder_reach(&together, 1));
	/* A slope of 0 in the sweep would never step. */
	together.motion.law.open_span = together.motion.law.span;
	together.motion.law.u = 0;
	TEST_ASSERT_EQUAL_UINT32(1, lw_controller_encoder_reach(&together, 1));
}

static void test_a_turn_of_the_slope_tells_the_next_direction(void)
{
	int told = 0;

	for (unsigned int inversions = 0; inversions < 8; inversions += 4) {
		start(2, inversions, 0, KS);
		for (int i = 0; i < 40000; i++) {
			const int way = next_random(&seed) % 4000 == 0 ? -1 : 1;
			int direction;
			int steps = 0;

			turn(way);
			direction = lw_controller_turns_to(&together, way);
			if (direction == 0) {
				continue;
			}
			const struct lw_controller kept = one_by_one;
			const uint32_t kept_place = place;

			for (int j = 0; steps == 0 && j < 4 * NR; j++) {
				const int32_t slope = one_by_one.motion.law.u;

				steps = pass(way);
				if ((slope > 0) != (kept.motion.law.u > 0)) {
					break; /* it has turned before a step came */
				}
			}
			if (steps != 0 &&
			    (one_by_one.motion.law.u > 0) == (kept.motion.law.u > 0)) {
				TEST_ASSERT_EQUAL_INT(steps, direction);
				told++;
			}
			one_by_one = kept;
			place = kept_place;
		}
	}
	TEST_ASSERT_TRUE(told > 10000);
	/* In the sweep it is that of the steps before; and nobody knows while the way is closed. */
	start(2, 0, 0, KS);
	turn(2);
	TEST_ASSERT_EQUAL_INT(0, lw_controller_turns_to(&together, 1));
	/* From the border on, while there is any slope. */
	together.motion.law.rel = together.motion.law.span;
	for (int u = -1; u <= 1; u++) {
		together.motion.law.u = u;
		TEST_ASSERT_EQUAL_INT((u > 0) - (u < 0), lw_controller_turns_to(&together, 1));
		TEST_ASSERT_EQUAL_INT((u < 0) - (u > 0), lw_controller_turns_to(&together, -1));
	}
	together.motion.law.u = KS;
	together.motion.law.open_span = 0;
	TEST_ASSERT_EQUAL_INT(0, lw_controller_turns_to(&together, 1));
}

static void test_an_index_that_is_late_is_counted_only(void)
{
	lw_encoder_index_configure(&together.encoder_index, 720, 1000);
	together.motion.edges = 100;
	together.now_us = 100000;
	lw_controller_encoder_index(&together);
	together.motion.edges = 450; /* the pulse was at 820 */
	together.now_us = 200000;
	lw_controller_encoder_index_late(&together);
	TEST_ASSERT_EQUAL_UINT32(2, together.encoder_index.pulses);
	together.motion.edges = 100 + 2 * 720;
	together.now_us = 300000;
	lw_controller_encoder_index(&together);
	together.motion.edges = 100 + 3 * 720;
	together.now_us = 400000;
	lw_controller_encoder_index(&together);
	TEST_ASSERT_EQUAL_UINT32(0, together.encoder_index.missed_edges);
	together.motion.edges = 100 + 4 * 720 - 9;
	together.now_us = 500000;
	lw_controller_encoder_index(&together);
	TEST_ASSERT_EQUAL_UINT32(9, together.encoder_index.missed_edges);
	TEST_ASSERT_EQUAL_UINT32(5, together.encoder_index.pulses);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_any_runs_are_what_their_transitions_are);
	RUN_TEST(test_and_back_again_to_the_last_bit);
	RUN_TEST(test_a_whole_erasure_at_once);
	RUN_TEST(test_requests_and_blocks_meanwhile);
	RUN_TEST(test_the_next_step_is_where_the_reach_says);
	RUN_TEST(
		test_where_nothing_moves_the_reach_is_long_and_where_something_waits_it_is_one_edge);
	RUN_TEST(test_a_turn_of_the_slope_tells_the_next_direction);
	RUN_TEST(test_an_index_that_is_late_is_counted_only);
	return UNITY_END();
}
