/* SPDX-License-Identifier: Apache-2.0 */
/* The cam as the edge interrupt sees it: what comes beside the table (tests/property has that). */
#define _POSIX_C_SOURCE 200809L

#include <signal.h>
#include <stdlib.h>
#include <time.h>

#include <unity.h>

#include "cases.h"
#include "lw/cam/cam_motion.h"

/** The hill rises by 3 microsteps per edge for 100 edges and falls as fast. */
#define SLOPE 3
#define HALF  100
#define CYCLE (2 * HALF)

static struct lw_cam_table hill = {.row_count = 3, .rows = {{0, 0}, {HALF, SLOPE *HALF}, {CYCLE}}};
/** Another cycle, half as long and downward. */
static struct lw_cam_table pit = {.row_count = 3, .rows = {{0, 0}, {50, -50}, {100, 0}}};
static struct lw_cam_scale scale;
static struct lw_cam_motion motion;
static uint32_t odometer;
static uint32_t unfollowed;
static int32_t given; /**< sum of the steps */
static int most;      /**< of one edge */

/** Begin in step, the odometer here. */
static void begin_at(const struct lw_cam_table *table, int32_t edges)
{
	motion = (struct lw_cam_motion){.on = true, .steps_max = 4};
	odometer = (uint32_t)edges;
	unfollowed = 0;
	lw_cam_start(&motion.cam, table, &scale, edges, 0);
	lw_cam_count_from_here(&motion.cam);
	given = (int32_t)motion.cam.point.pos_usteps;
	most = 0;
}

void setUp(void)
{
	scale = lw_cam_scale(1, 1, 1, 1, 10);
	begin_at(&hill, 0);
}

void tearDown(void)
{
	cases_end();
}

static int edge(int dd)
{
	int steps;

	odometer += (uint32_t)dd;
	lw_cam_motion_prepare(&motion);
	steps = lw_cam_motion_edge(&motion, unfollowed, dd);
	given += steps;
	if (abs(steps) > most) {
		most = abs(steps);
	}
	return steps;
}

static void edges(int32_t count)
{
	for (int32_t i = 0; i < abs(count); i++) {
		(void)edge(count > 0 ? 1 : -1);
	}
}

static int32_t hill_at(int32_t master)
{
	const int32_t at = (master % CYCLE + CYCLE) % CYCLE;

	return SLOPE * (at < HALF ? at : CYCLE - at);
}

static int32_t pit_at(int32_t master)
{
	const int32_t at = (master % 100 + 100) % 100;

	return at < 50 ? -at : at - 100;
}

static void test_in_step_both_ways(void)
{
	static const int32_t runs[] = {30, -500, 900, -1, 1, -430};

	for (size_t i = 0; i < sizeof(runs) / sizeof(runs[0]); i++) {
		for (int32_t n = 0; n < abs(runs[i]); n++) {
			(void)edge(runs[i] > 0 ? 1 : -1);
			TEST_ASSERT_EQUAL_INT32(hill_at((int32_t)odometer), given);
		}
	}
	TEST_ASSERT_EQUAL_INT(SLOPE, most);
	TEST_ASSERT_EQUAL_INT32(0, motion.owed_usteps);
	TEST_ASSERT_EQUAL_INT32(0, motion.phase_edges);
}

static void test_owed_steps_are_given_as_there_is_room(void)
{
	FOR_BOTH_WAYS(dd) {
		for (int sign = -1; sign <= 1; sign += 2) {
			const int32_t owed = 37 * sign;
			int32_t before;

			setUp();
			before = given;
			motion.owed_usteps = owed;
			for (int32_t n = 1; n <= HALF; n++) {
				const bool behind = motion.owed_usteps != 0;
				const int steps = edge(dd);

				/* All the room there is while something is owed. */
				TEST_ASSERT_TRUE(!behind || motion.owed_usteps == 0 ||
						 steps == 4 * sign);
				TEST_ASSERT_EQUAL_INT32(before + hill_at(dd * n) + owed,
							given + motion.owed_usteps);
			}
			TEST_ASSERT_EQUAL_INT32(0, motion.owed_usteps);
			TEST_ASSERT_EQUAL_INT32(before + hill_at(dd * HALF) + owed, given);
			TEST_ASSERT_EQUAL_INT(4, most);
		}
	}
}

static void test_steps_max_may_be_less(void)
{
	motion.steps_max = 1;
	edges(HALF);
	TEST_ASSERT_EQUAL_INT32(HALF, given);
	TEST_ASSERT_EQUAL_INT32((SLOPE - 1) * HALF, motion.owed_usteps);
	TEST_ASSERT_EQUAL_INT(1, most);
	/* What is owed forward is paid by the way back first. */
	edges(-HALF);
	TEST_ASSERT_EQUAL_INT32(0, given + motion.owed_usteps);
}

static void test_the_phase_shifts_without_a_burst(void)
{
	FOR_BOTH_WAYS(dd) {
		for (int sign = -1; sign <= 1; sign += 2) {
			const int32_t phase = 70 * sign;
			int32_t reached = 0;

			setUp();
			motion.phase_target_edges = phase;
			for (int32_t n = 1; n <= 3 * CYCLE; n++) {
				(void)edge(dd);
				/* One edge of shift per edge, at most. */
				TEST_ASSERT_TRUE(motion.phase_edges == reached ||
						 motion.phase_edges == reached + sign);
				reached = motion.phase_edges;
				TEST_ASSERT_EQUAL_INT32(hill_at(dd * n + reached),
							given + motion.owed_usteps);
			}
			TEST_ASSERT_EQUAL_INT32(phase, reached);
			TEST_ASSERT_EQUAL_INT32(hill_at(dd * 3 * CYCLE + phase), given);
			TEST_ASSERT_LESS_OR_EQUAL_INT(4, most);
			/* And back again. */
			motion.phase_target_edges = 0;
			edges(3 * CYCLE * dd);
			TEST_ASSERT_EQUAL_INT32(0, motion.phase_edges);
			TEST_ASSERT_EQUAL_INT32(hill_at(dd * 6 * CYCLE), given);
			TEST_ASSERT_LESS_OR_EQUAL_INT(4, most);
		}
	}
}

static void test_a_shift_waits_until_nothing_is_owed(void)
{
	motion.owed_usteps = 50;
	motion.phase_target_edges = 5;
	while (motion.owed_usteps != 0) {
		TEST_ASSERT_EQUAL_INT32(0, motion.phase_edges);
		(void)edge(1);
	}
	(void)edge(1);
	TEST_ASSERT_EQUAL_INT32(1, motion.phase_edges);
}

/** As when the drum moved between the preparation and the first edge that is taken. */
static void test_edges_that_were_not_taken_are_caught_up(void)
{
	for (int32_t missed = -60; missed <= 60; missed += 24) {
		setUp();
		odometer += (uint32_t)missed;
		unfollowed += (uint32_t)missed;
		(void)edge(1);
		TEST_ASSERT_EQUAL_INT32(hill_at(missed + 1 + motion.phase_edges),
					given + motion.owed_usteps);
		edges(3 * CYCLE);
		TEST_ASSERT_EQUAL_INT32(0, motion.phase_edges);
		TEST_ASSERT_EQUAL_INT32(hill_at(missed + 1), given);
		TEST_ASSERT_LESS_OR_EQUAL_INT(4, most);
	}
}

static void test_the_count_of_edges_not_taken_may_wrap(void)
{
	unfollowed = motion.unfollowed_edges = (uint32_t)-3;
	edges(10);
	TEST_ASSERT_EQUAL_INT32(0, motion.phase_edges);
	unfollowed += 7;
	(void)edge(1);
	TEST_ASSERT_EQUAL_INT32(-7 + 1, motion.phase_edges);
	edges(CYCLE);
	TEST_ASSERT_EQUAL_INT32(0, motion.phase_edges);
	TEST_ASSERT_EQUAL_INT32(hill_at(7 + 11), given);
}

/** Stand at the first slave position, in the middle of a cycle of the master. */
static void wait_at(int32_t at, int32_t begin_usteps)
{
	begin_at(&hill, at);
	motion.waiting = true;
	motion.begin_usteps = begin_usteps;
	given = begin_usteps;
}

static void test_waits_for_the_next_cycle_forward(void)
{
	wait_at(CYCLE - 30, 0);
	edges(20);
	edges(-40);
	edges(49);
	TEST_ASSERT_EQUAL_INT32(0, most);
	TEST_ASSERT_TRUE(motion.waiting);
	for (int32_t n = 0; n < 3 * CYCLE; n++) {
		(void)edge(1);
		TEST_ASSERT_EQUAL_INT32(hill_at(n), given);
		TEST_ASSERT_FALSE(motion.waiting);
		TEST_ASSERT_EQUAL_INT32(n / CYCLE, motion.cam.piece.cycles);
	}
	edges(-3 * CYCLE);
	TEST_ASSERT_EQUAL_INT32(-1, motion.cam.piece.cycles);
	TEST_ASSERT_EQUAL_INT32(hill_at(-1), given);
}

static void test_waits_for_the_next_cycle_backward(void)
{
	wait_at(30, 0);
	motion.phase_target_edges = 0;
	edges(-30); /* the begin itself belongs to the cycle that the master is in */
	TEST_ASSERT_TRUE(motion.waiting);
	for (int32_t n = 1; n < 3 * CYCLE; n++) {
		(void)edge(-1);
		TEST_ASSERT_EQUAL_INT32(hill_at(-n), given);
		TEST_ASSERT_FALSE(motion.waiting);
		TEST_ASSERT_EQUAL_INT32(-1 - (n - 1) / CYCLE, motion.cam.piece.cycles);
	}
}

static void test_the_phase_waits_too(void)
{
	wait_at(CYCLE - 10, 0);
	motion.phase_target_edges = 7;
	edges(9);
	TEST_ASSERT_EQUAL_INT32(0, motion.phase_edges);
	edges(30);
	TEST_ASSERT_EQUAL_INT32(7, motion.phase_edges);
	TEST_ASSERT_EQUAL_INT32(hill_at(29 + 7), given);
}

/** With an advance the cycles count from where the waiting ended, not from the odometer's 0. */
static void test_an_advancing_table_waits_at_its_begin(void)
{
	static const struct lw_cam_table gear = {
		.row_count = 2, .advance = 3, .rows = {{0, 40}, {7, 43}}};

	begin_at(&gear, 700 + 2);
	motion.waiting = true;
	given = motion.begin_usteps = 40;
	edges(5 + 7);
	TEST_ASSERT_EQUAL_INT32(43, given);
	begin_at(&gear, 700 + 2);
	motion.waiting = true;
	given = motion.begin_usteps = 40;
	edges(-2 - 7);
	TEST_ASSERT_EQUAL_INT32(37, given);
}

static void test_goes_over_to_the_next_table_forward(void)
{
	edges(CYCLE + 20);
	motion.next = &pit;
	for (int32_t n = CYCLE + 20; n < 2 * CYCLE; n++) {
		TEST_ASSERT_EQUAL_PTR(&pit, motion.next);
		TEST_ASSERT_EQUAL_INT32(hill_at(n), given);
		(void)edge(1);
	}
	TEST_ASSERT_NULL(motion.next);
	TEST_ASSERT_EQUAL_PTR(&pit, motion.cam.table);
	TEST_ASSERT_EQUAL_INT32(2, motion.cam.piece.cycles);
	for (int32_t n = 0; n < 350; n++) {
		TEST_ASSERT_EQUAL_INT32(pit_at(n), given);
		(void)edge(1);
	}
	/* Back past the joint: the new table stays. */
	for (int32_t n = 350; n > -350; n--) {
		TEST_ASSERT_EQUAL_INT32(pit_at(n), given);
		(void)edge(-1);
	}
}

static void test_goes_over_to_the_next_table_backward(void)
{
	edges(20);
	motion.next = &pit;
	edges(-20);
	TEST_ASSERT_EQUAL_PTR(&pit, motion.next);
	TEST_ASSERT_EQUAL_PTR(&hill, motion.cam.table);
	for (int32_t n = 1; n < 350; n++) {
		(void)edge(-1);
		TEST_ASSERT_NULL(motion.next);
		TEST_ASSERT_EQUAL_PTR(&pit, motion.cam.table);
		TEST_ASSERT_EQUAL_INT32(pit_at(-n), given);
	}
	TEST_ASSERT_EQUAL_INT32(-1 - 348 / 100, motion.cam.piece.cycles);
}

/** The master passes the boundary by a shift of its phase, with the drum going the other way. */
static void test_a_shift_of_the_phase_reaches_the_boundary(void)
{
	begin_at(&hill, CYCLE - 5);
	motion.next = &pit;
	motion.phase_target_edges = 10;
	for (int i = 0; i < 20; i++) {
		(void)edge(-1);
		(void)edge(1);
	}
	TEST_ASSERT_NULL(motion.next);
	TEST_ASSERT_EQUAL_INT32(10, motion.phase_edges);
	TEST_ASSERT_EQUAL_INT32(pit_at(5), given);
	TEST_ASSERT_LESS_OR_EQUAL_INT(4, most);
}

static void test_a_queued_table_that_is_withdrawn_is_not_taken(void)
{
	motion.next = &pit;
	edges(CYCLE - 1);
	TEST_ASSERT_EQUAL_PTR(&pit, motion.next);
	motion.next = NULL;
	edges(2);
	TEST_ASSERT_EQUAL_PTR(&hill, motion.cam.table);
	TEST_ASSERT_EQUAL_INT32(hill_at(1), given);
}

static void test_a_reading(void)
{
	struct lw_cam_reading reading;

	wait_at(CYCLE - 1, 9);
	reading = lw_cam_motion_read(&motion);
	TEST_ASSERT_EQUAL_UINT16(1, reading.waiting);
	TEST_ASSERT_EQUAL_INT32(SLOPE, reading.pos_usteps);
	TEST_ASSERT_EQUAL_UINT16(1, reading.row);
	begin_at(&hill, 0);
	motion.phase_target_edges = -20;
	motion.owed_usteps = 2;
	edges(-1);
	motion.owed_usteps = 1;
	reading = lw_cam_motion_read(&motion);
	TEST_ASSERT_EQUAL_UINT16(0, reading.waiting);
	TEST_ASSERT_EQUAL_INT32(-1, reading.cycles);
	TEST_ASSERT_EQUAL_INT32(1, reading.owed_usteps);
	TEST_ASSERT_EQUAL_INT32(motion.phase_edges, reading.phase_edges);
	TEST_ASSERT_EQUAL_INT32(hill_at(-1 + motion.phase_edges), reading.pos_usteps);
}

/* ---- a signal is the edge interrupt ---- */

#define GEAR_EDGES 7
#define GEAR_STEPS 20

static volatile sig_atomic_t interrupts;

/** Whole cycles at once, so that all words of the reading change together. */
static void on_interrupt(int number)
{
	(void)number;
	interrupts++;
	edges(interrupts / 500 % 2 ? -GEAR_EDGES : GEAR_EDGES);
}

static void test_a_reading_is_of_one_moment(void)
{
	static const struct lw_cam_table gear = {
		.row_count = 2, .advance = GEAR_STEPS, .rows = {{0, 0}, {GEAR_EDGES, GEAR_STEPS}}};
	const struct itimerspec period = {{0, 15000}, {0, 15000}};
	const struct sigaction action = {.sa_handler = on_interrupt};
	int interrupted = 0;
	timer_t timer;

	begin_at(&gear, 0);
	interrupts = 0;
	TEST_ASSERT_EQUAL_INT(0, sigaction(SIGALRM, &action, NULL));
	TEST_ASSERT_EQUAL_INT(0, timer_create(CLOCK_MONOTONIC, NULL, &timer));
	TEST_ASSERT_EQUAL_INT(0, timer_settime(timer, 0, &period, NULL));
	while (interrupted < 2000) {
		const int before = interrupts;
		const struct lw_cam_reading reading = lw_cam_motion_read(&motion);

		interrupted += interrupts != before;
		TEST_ASSERT_EQUAL_INT32(GEAR_STEPS * reading.cycles, reading.pos_usteps);
	}
	TEST_ASSERT_EQUAL_INT(0, timer_delete(timer));
}

/** The edge interrupt, one edge of it, that finds prepared what the supervisor has got done. */
static void on_edge(int number)
{
	(void)number;
	interrupts++;
	for (int i = 0; i < 3; i++) {
		const int dd = interrupts / 400 % 2 ? -1 : 1;

		odometer += (uint32_t)dd;
		given += lw_cam_motion_edge(&motion, unfollowed, dd);
	}
}

/** Three pieces of a row of 7 edges pass in a moment: many come while others are prepared. */
static void test_preparing_may_be_interrupted(void)
{
	static const struct lw_cam_table waves = {.interpolation = LW_CAM_INTERPOLATION_TRAPEZOID,
						  .row_count = 4,
						  .rows = {{0, 0}, {7, 20}, {14, -1}, {40, 0}}};
	const struct itimerspec period = {{0, 15000}, {0, 15000}};
	const struct sigaction action = {.sa_handler = on_edge};
	struct lw_cam_motion apart;
	timer_t timer;

	scale = lw_cam_scale(1, 1, 1, 1, 4);
	begin_at(&waves, 0);
	apart = motion;
	interrupts = 0;
	TEST_ASSERT_EQUAL_INT(0, sigaction(SIGALRM, &action, NULL));
	TEST_ASSERT_EQUAL_INT(0, timer_create(CLOCK_MONOTONIC, NULL, &timer));
	TEST_ASSERT_EQUAL_INT(0, timer_settime(timer, 0, &period, NULL));
	while (interrupts < 3000) {
		lw_cam_motion_prepare(&motion);
	}
	TEST_ASSERT_EQUAL_INT(0, timer_delete(timer));
	for (int i = 0; i < interrupts; i++) {
		for (int edge = 0; edge < 3; edge++) {
			const int dd = (i + 1) / 400 % 2 ? -1 : 1;

			given -= lw_cam_motion_edge(&apart, 0, dd);
		}
	}
	TEST_ASSERT_EQUAL_INT32(0, given);
	TEST_ASSERT_EQUAL_MEMORY(&apart.cam.point, &motion.cam.point, sizeof(apart.cam.point));
	TEST_ASSERT_EQUAL_MEMORY(&apart.cam.piece, &motion.cam.piece, sizeof(apart.cam.piece));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_in_step_both_ways);
	RUN_TEST(test_owed_steps_are_given_as_there_is_room);
	RUN_TEST(test_steps_max_may_be_less);
	RUN_TEST(test_the_phase_shifts_without_a_burst);
	RUN_TEST(test_a_shift_waits_until_nothing_is_owed);
	RUN_TEST(test_edges_that_were_not_taken_are_caught_up);
	RUN_TEST(test_the_count_of_edges_not_taken_may_wrap);
	RUN_TEST(test_waits_for_the_next_cycle_forward);
	RUN_TEST(test_waits_for_the_next_cycle_backward);
	RUN_TEST(test_the_phase_waits_too);
	RUN_TEST(test_an_advancing_table_waits_at_its_begin);
	RUN_TEST(test_goes_over_to_the_next_table_forward);
	RUN_TEST(test_goes_over_to_the_next_table_backward);
	RUN_TEST(test_a_shift_of_the_phase_reaches_the_boundary);
	RUN_TEST(test_a_queued_table_that_is_withdrawn_is_not_taken);
	RUN_TEST(test_a_reading);
	RUN_TEST(test_a_reading_is_of_one_moment);
	RUN_TEST(test_preparing_may_be_interrupted);
	return UNITY_END();
}
