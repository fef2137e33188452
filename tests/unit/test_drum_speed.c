/* SPDX-License-Identifier: Apache-2.0 */
/* How fast the drum turns, and whether it rests. */
#include <unity.h>

#include "lw/control/drum_speed.h"

static struct lw_drum_speed speed;
static struct lw_params params;
static uint32_t edges;
static uint64_t now_us;

void setUp(void)
{
	params = lw_params_default;
	params.rest_edges_per_s = 50;
	params.rest_time_ms = 100;
	edges = 0;
	now_us = 5000000;
	lw_drum_speed_init(&speed, now_us);
}

void tearDown(void)
{
}

/** Milliseconds in each of which the drum turns by so many edges. */
static void ticks(int count, int32_t moved)
{
	while (count-- > 0) {
		now_us += 1000;
		edges += (uint32_t)moved;
		lw_drum_speed_tick(&speed, &params, edges, false, now_us);
	}
}

static void test_the_speed_has_the_sign_of_the_drum(void)
{
	ticks(LW_DRUM_SPEED_TICKS, 7);
	TEST_ASSERT_EQUAL_INT32(7000, speed.edges_per_s);
	ticks(LW_DRUM_SPEED_TICKS, -7);
	TEST_ASSERT_EQUAL_INT32(-7000, speed.edges_per_s);
}

static void test_the_speed_is_of_the_time_that_has_passed(void)
{
	edges += 50;
	now_us += 10000; /* a tick that comes late */
	lw_drum_speed_tick(&speed, &params, edges, false, now_us);
	TEST_ASSERT_EQUAL_INT32(5000, speed.edges_per_s);

	setUp();
	edges += 50; /* no time has passed */
	lw_drum_speed_tick(&speed, &params, edges, false, now_us);
	TEST_ASSERT_EQUAL_INT32(0, speed.edges_per_s);
}

static void test_the_drum_rests_after_its_time(void)
{
	ticks(99, 0);
	TEST_ASSERT_FALSE(speed.at_rest);
	ticks(1, 0);
	TEST_ASSERT_TRUE(speed.at_rest);
	now_us += 1000;
	lw_drum_speed_tick(&speed, &params, edges, true, now_us); /* may turn unseen */
	TEST_ASSERT_FALSE(speed.at_rest);
}

static void test_so_slow_is_rest(void)
{
	for (int way = -1; way <= 1; way += 2) {
		for (int32_t moved = 49; moved <= 50; moved++) {
			setUp();
			ticks(200, 0);
			now_us += 1000000;
			for (int i = 0; i < LW_DRUM_SPEED_TICKS; i++) {
				lw_drum_speed_tick(&speed, &params, edges, false, now_us);
			}
			now_us += 1000000; /* in a second */
			edges += (uint32_t)(way * moved);
			lw_drum_speed_tick(&speed, &params, edges, false, now_us);
			TEST_ASSERT_EQUAL_INT32(way * moved, speed.edges_per_s);
			TEST_ASSERT_EQUAL(moved < 50, speed.at_rest);
		}
	}
}

static void test_a_limit_is_exceeded_beyond_it_either_way(void)
{
	ticks(LW_DRUM_SPEED_TICKS, 7);
	TEST_ASSERT_TRUE(lw_drum_speed_exceeds(&speed, 6999));
	TEST_ASSERT_FALSE(lw_drum_speed_exceeds(&speed, 7000));
	ticks(LW_DRUM_SPEED_TICKS, -7);
	TEST_ASSERT_TRUE(lw_drum_speed_exceeds(&speed, 6999));
	TEST_ASSERT_FALSE(lw_drum_speed_exceeds(&speed, 7000));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_the_speed_has_the_sign_of_the_drum);
	RUN_TEST(test_the_speed_is_of_the_time_that_has_passed);
	RUN_TEST(test_the_drum_rests_after_its_time);
	RUN_TEST(test_so_slow_is_rest);
	RUN_TEST(test_a_limit_is_exceeded_beyond_it_either_way);
	return UNITY_END();
}
