/* SPDX-License-Identifier: Apache-2.0 */
/* Rope laid while the carriage stands: what counts, and what does not. */
#include <unity.h>

#include "lw/control/rope_watch.h"

#define EDGES_PER_TURN 2880

static struct lw_rope_watch watch;
static struct lw_rope_watch_inputs inputs;

void setUp(void)
{
	watch = (struct lw_rope_watch){0};
	inputs = (struct lw_rope_watch_inputs){
		.threshold_edges = EDGES_PER_TURN / 4,
		.edges_per_1000_drum_revs = 1000 * EDGES_PER_TURN,
		.known = true,
	};
}

void tearDown(void)
{
}

/** Turn by so many thousandths of a turn, in ticks of at most 9 edges. */
static void turn(int32_t permille)
{
	int64_t edges = (int64_t)permille * EDGES_PER_TURN / 1000;

	while (edges != 0) {
		const int64_t now = edges > 9 ? 9 : edges < -9 ? -9 : edges;

		inputs.net_edges += now;
		inputs.now_us += 1000;
		lw_rope_watch_tick(&watch, &inputs);
		edges -= now;
	}
}

static void follow(bool following)
{
	inputs.following = following;
	lw_rope_watch_tick(&watch, &inputs); /* what came until now was still followed */
	lw_rope_watch_tick(&watch, &inputs);
}

static void assert_millirev(uint32_t expected)
{
	TEST_ASSERT_UINT32_WITHIN(1, expected,
				  lw_rope_watch_millirev(&watch, inputs.edges_per_1000_drum_revs));
	TEST_ASSERT_EQUAL(expected != 0, watch.set);
}

static void test_a_quarter_turn_is_told_and_not_less(void)
{
	turn(249);
	assert_millirev(0);
	turn(2);
	assert_millirev(251);
	turn(2000);
	assert_millirev(2251);
}

static void test_rocking_at_rest_does_not_count_up(void)
{
	for (int i = 0; i < 1000; i++) {
		turn(100);
		turn(-100);
		turn(-100);
		turn(100);
	}
	assert_millirev(0);
}

static void test_rope_that_is_paid_out_again_does_not_count(void)
{
	turn(200);
	turn(-200);
	turn(200);
	assert_millirev(0);
	turn(3000);
	turn(-3200);
	turn(3000);
	assert_millirev(3200); /* what was there once has been there */
	turn(500);
	assert_millirev(3500);
}

static void test_hauling_in_what_was_paid_out_counts(void)
{
	turn(-50000);
	assert_millirev(0);
	turn(2000);
	assert_millirev(2000);
}

static void test_nothing_counts_while_the_carriage_follows_or_the_mode_means_it(void)
{
	follow(true);
	turn(9000);
	assert_millirev(0);
	follow(false);
	inputs.intended = true;
	turn(9000);
	assert_millirev(0);
	inputs.intended = false;
	inputs.threshold_edges = 0; /* not watched */
	turn(9000);
	assert_millirev(0);
}

static void test_each_stand_counts_for_itself_and_those_that_are_told_add_up(void)
{
	for (int i = 0; i < 10; i++) {
		turn(200);
		follow(true);
		turn(5000);
		follow(false);
	}
	assert_millirev(0);
	turn(1000);
	follow(true);
	turn(5000);
	follow(false);
	turn(200);
	assert_millirev(1000);
	turn(300);
	assert_millirev(1500);
}

static void test_the_place_is_that_of_the_first_turn_if_it_was_known(void)
{
	inputs.position_q16 = 77 << 16;
	follow(true);
	inputs.known = false; /* as a fault leaves it */
	inputs.position_q16 = 5 << 16;
	follow(false);
	inputs.now_us = 4000000;
	turn(1000);
	TEST_ASSERT_TRUE(watch.place_known);
	TEST_ASSERT_EQUAL_INT32(77 << 16, watch.position_q16);
	TEST_ASSERT_UINT32_WITHIN(100, 4050, watch.time_ms);

	/* Moved by hand, or by itself, without an index. */
	lw_rope_watch_acknowledge(&watch);
	inputs.moved = true;
	lw_rope_watch_tick(&watch, &inputs);
	inputs.moved = false;
	turn(1000);
	TEST_ASSERT_TRUE(watch.set);
	TEST_ASSERT_FALSE(watch.place_known);
}

/** Turn by so many edges in one tick. */
static void turn_edges(int64_t edges)
{
	inputs.net_edges += edges;
	lw_rope_watch_tick(&watch, &inputs);
}

static void test_the_threshold_is_exact_to_an_edge(void)
{
	inputs.now_us = 5000000;
	turn_edges(EDGES_PER_TURN / 4 - 1);
	TEST_ASSERT_FALSE(watch.set);
	turn_edges(1);
	TEST_ASSERT_TRUE(watch.set);
	TEST_ASSERT_EQUAL_UINT32(5000, watch.time_ms);

	/* Forth and back over what is known is nothing new. */
	watch.indexed_since = true;
	turn_edges(-1);
	turn_edges(1);
	TEST_ASSERT_TRUE(watch.indexed_since);

	watch.before_power_up = true;
	lw_rope_watch_acknowledge(&watch);
	TEST_ASSERT_FALSE(watch.before_power_up);
	TEST_ASSERT_EQUAL_UINT32(0, lw_rope_watch_millirev(&watch, 1000)); /* an edge a turn */
	turn_edges(EDGES_PER_TURN / 4 - 1);
	TEST_ASSERT_FALSE(watch.set);

	/* What is wound off does not count against what comes. */
	turn_edges(-EDGES_PER_TURN);
	turn_edges(EDGES_PER_TURN / 4 - 1);
	TEST_ASSERT_FALSE(watch.set);
	turn_edges(1);
	TEST_ASSERT_TRUE(watch.set);
}

static void test_an_acknowledgement_begins_anew(void)
{
	turn(1000);
	watch.indexed_since = true;
	turn(1);
	TEST_ASSERT_FALSE(watch.indexed_since); /* more has come since the indexing */
	lw_rope_watch_acknowledge(&watch);
	assert_millirev(0);
	turn(240);
	assert_millirev(0);
	turn(20);
	assert_millirev(260);
}

static void test_turns_stay_turns_when_the_encoder_is_configured_anew(void)
{
	turn(2000);
	lw_rope_watch_settle(&watch, inputs.edges_per_1000_drum_revs);
	inputs.edges_per_1000_drum_revs *= 2;
	assert_millirev(2000);
}

static void test_more_turns_than_the_register_holds(void)
{
	watch.laid_millirev = UINT32_MAX - 5;
	turn(1000);
	TEST_ASSERT_EQUAL_UINT32(UINT32_MAX,
				 lw_rope_watch_millirev(&watch, inputs.edges_per_1000_drum_revs));
	inputs.net_edges += INT64_MAX / 2;
	lw_rope_watch_tick(&watch, &inputs);
	watch.laid_millirev = 0;
	TEST_ASSERT_EQUAL_UINT32(UINT32_MAX,
				 lw_rope_watch_millirev(&watch, inputs.edges_per_1000_drum_revs));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_a_quarter_turn_is_told_and_not_less);
	RUN_TEST(test_rocking_at_rest_does_not_count_up);
	RUN_TEST(test_rope_that_is_paid_out_again_does_not_count);
	RUN_TEST(test_hauling_in_what_was_paid_out_counts);
	RUN_TEST(test_nothing_counts_while_the_carriage_follows_or_the_mode_means_it);
	RUN_TEST(test_each_stand_counts_for_itself_and_those_that_are_told_add_up);
	RUN_TEST(test_the_place_is_that_of_the_first_turn_if_it_was_known);
	RUN_TEST(test_the_threshold_is_exact_to_an_edge);
	RUN_TEST(test_an_acknowledgement_begins_anew);
	RUN_TEST(test_turns_stay_turns_when_the_encoder_is_configured_anew);
	RUN_TEST(test_more_turns_than_the_register_holds);
	return UNITY_END();
}
