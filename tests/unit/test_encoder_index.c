/* SPDX-License-Identifier: Apache-2.0 */
/* The check of the odometer by the encoder's index pulse. */
#include <unity.h>

#include "cases.h"
#include "lw/motion/encoder_index.h"

#define REV 720

/** Edges that the index pulse is wide: it begins that much later when met backward. */
#define WIDTH 2

#define REV_MIN_US 6000

static struct lw_encoder_index encoder_index;
static struct lw_quadrature quadrature;
static uint32_t net_edges;
static int32_t last_way;
static uint32_t now_us;

void setUp(void)
{
	encoder_index = (struct lw_encoder_index){0};
	quadrature = (struct lw_quadrature){0};
	last_way = 1;
	now_us = 0;
	lw_encoder_index_configure(&encoder_index, REV, REV_MIN_US);
	net_edges = 0;
}

void tearDown(void)
{
	cases_end();
}

/** Turn by some edges, and meet the index pulse there. */
static void turn_to_pulse(int32_t edges)
{
	const int32_t way = edges < 0 ? -1 : 1;
	const bool other_side = edges == WIDTH || edges == -WIDTH; /* met from there, going back */

	quadrature.turns += way != last_way || other_side;
	last_way = way;
	net_edges += (uint32_t)edges;
	now_us += 15000;
	lw_encoder_index_pulse(&encoder_index, net_edges, &quadrature, now_us);
}

static void test_whole_revolutions_miss_nothing(void)
{
	turn_to_pulse(123);
	for (int i = 0; i < 10; i++) {
		turn_to_pulse(REV);
	}
	turn_to_pulse(WIDTH); /* turned round inside of the pulse, and met its other side */
	for (int i = 0; i < 20; i++) {
		turn_to_pulse(-REV);
	}
	turn_to_pulse(-WIDTH);
	for (int i = 0; i < 10; i++) {
		turn_to_pulse(REV);
	}
	TEST_ASSERT_EQUAL_UINT32(43, encoder_index.pulses);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
}

static void test_missing_and_surplus_edges_are_counted_once(void)
{
	turn_to_pulse(5);
	turn_to_pulse(REV);
	turn_to_pulse(REV - 6);
	TEST_ASSERT_EQUAL_UINT32(6, encoder_index.missed_edges);
	turn_to_pulse(REV);
	TEST_ASSERT_EQUAL_UINT32(6, encoder_index.missed_edges);
	turn_to_pulse(REV + 2);
	TEST_ASSERT_EQUAL_UINT32(8, encoder_index.missed_edges);
	turn_to_pulse(REV);
	TEST_ASSERT_EQUAL_UINT32(8, encoder_index.missed_edges);
}

static void test_backward_too(void)
{
	turn_to_pulse(0);
	turn_to_pulse(-REV);
	turn_to_pulse(-REV + 4);
	TEST_ASSERT_EQUAL_UINT32(4, encoder_index.missed_edges);
}

static void test_what_one_way_has_missed_is_not_missed_again_on_the_other(void)
{
	turn_to_pulse(0);
	turn_to_pulse(REV);
	turn_to_pulse(REV);
	turn_to_pulse(WIDTH);
	turn_to_pulse(-REV);
	turn_to_pulse(-REV);
	turn_to_pulse(-WIDTH);
	turn_to_pulse(REV - 10);
	TEST_ASSERT_EQUAL_UINT32(10, encoder_index.missed_edges);
	turn_to_pulse(WIDTH);
	turn_to_pulse(-REV);
	TEST_ASSERT_EQUAL_UINT32(10, encoder_index.missed_edges);
}

static void test_one_edge_is_chance_but_adds_up(void)
{
	turn_to_pulse(0);
	turn_to_pulse(REV);
	turn_to_pulse(REV + 1);
	turn_to_pulse(REV - 1);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
	turn_to_pulse(REV - 1);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
	turn_to_pulse(REV - 1);
	TEST_ASSERT_EQUAL_UINT32(2, encoder_index.missed_edges);
}

/** Turn on as before, and meet the index pulse after so many edges that were seen. */
static void turn_on_to_pulse(int32_t edges, uint32_t after_us)
{
	net_edges += (uint32_t)edges;
	now_us += after_us;
	lw_encoder_index_pulse(&encoder_index, net_edges, &quadrature, now_us);
}

static void test_whole_revolutions_without_edges_are_missed(void)
{
	turn_to_pulse(0);
	turn_to_pulse(-REV);
	turn_to_pulse(-REV);
	turn_on_to_pulse(0, 15000);
	turn_on_to_pulse(0, 15000);
	turn_on_to_pulse(-100, 15000);
	TEST_ASSERT_EQUAL_UINT32(3 * REV - 100, encoder_index.missed_edges);
	TEST_ASSERT_EQUAL_INT32(3 * REV - 100, encoder_index.misfit_edges);
	TEST_ASSERT_EQUAL_INT32(2 * REV, encoder_index.misfit_before_edges);
	turn_on_to_pulse(-REV, 15000);
	TEST_ASSERT_EQUAL_UINT32(3 * REV - 100, encoder_index.missed_edges);
}

static void test_an_index_that_chatters_or_is_rocked_about_misses_nothing(void)
{
	turn_to_pulse(0);
	turn_to_pulse(REV);
	turn_on_to_pulse(0, 1000);                    /* sooner than a revolution can be */
	quadrature.odd_changes[LW_QUADRATURE_B] += 2; /* rocked by what is no edge */
	turn_on_to_pulse(0, 15000);
	quadrature.turns += 2;
	turn_on_to_pulse(5, 15000);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
}

static void test_a_revolution_of_few_edges_is_one(void)
{
	turn_to_pulse(0);
	turn_to_pulse(REV);
	turn_to_pulse(REV);
	turn_on_to_pulse(0, 15000);
	TEST_ASSERT_EQUAL_INT32(-REV, encoder_index.misfit_edges);
	quadrature.odd_changes[LW_QUADRATURE_A] += 300;
	turn_on_to_pulse(5, 15000);
	TEST_ASSERT_EQUAL_INT32(-2 * REV + 5, encoder_index.misfit_edges);

	setUp();
	turn_to_pulse(0);
	turn_to_pulse(-REV);
	turn_to_pulse(-REV);
	quadrature.odd_changes[LW_QUADRATURE_B] += 300;
	turn_on_to_pulse(-5, 15000);
	TEST_ASSERT_EQUAL_INT32(REV - 5, encoder_index.misfit_edges);

	/* The first one the other way is nothing to compare with. */
	turn_on_to_pulse(100, 15000);
	TEST_ASSERT_EQUAL_INT32(REV - 5, encoder_index.misfit_edges);
}

static void test_rocking_is_seen_in_any_of_the_counts(void)
{
	turn_to_pulse(0);
	turn_to_pulse(REV);
	turn_to_pulse(REV);
	quadrature.odd_changes[LW_QUADRATURE_A] += 2;
	quadrature.odd_changes[LW_QUADRATURE_B] += 2;
	turn_on_to_pulse(0, 15000);
	quadrature.odd_changes[LW_QUADRATURE_A] += 4;
	quadrature.illegal_transitions += 4;
	turn_on_to_pulse(1, 15000);
	quadrature.odd_changes[LW_QUADRATURE_A] += 8;
	quadrature.late_interrupts += 8;
	turn_on_to_pulse(-1, 15000);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
	turn_on_to_pulse(0, 15000); /* and now none of them has counted */
	TEST_ASSERT_EQUAL_UINT32(REV, encoder_index.missed_edges);
	TEST_ASSERT_EQUAL_INT32(-REV, encoder_index.misfit_edges);
}

static void test_after_a_late_interrupt_no_pulse_is_known(void)
{
	turn_to_pulse(0);
	turn_to_pulse(REV);
	lw_encoder_index_pulse_late(&encoder_index);
	turn_on_to_pulse(300, 15000);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
}

static void test_the_count_may_wrap_round(void)
{
	turn_to_pulse(0);
	turn_to_pulse(-REV);
	turn_to_pulse(-REV);
	turn_to_pulse(-WIDTH); /* and for ever on the other way */
	for (uint32_t i = 0; i < UINT32_MAX / REV + 5; i++) {
		turn_to_pulse(REV);
	}
	turn_to_pulse(WIDTH);
	turn_to_pulse(-REV);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
}

static void test_other_settings_begin_anew(void)
{
	turn_to_pulse(0);
	turn_to_pulse(REV);
	lw_encoder_index_configure(&encoder_index, 2 * REV, REV_MIN_US);
	turn_to_pulse(500);
	turn_to_pulse(2 * REV);
	turn_to_pulse(2 * REV);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
	turn_to_pulse(2 * REV - 8);
	TEST_ASSERT_EQUAL_UINT32(8, encoder_index.missed_edges);
	TEST_ASSERT_EQUAL_UINT32(6, encoder_index.pulses);
}

static void test_the_nearest_number_of_revolutions_counts(void)
{
	turn_to_pulse(0);
	turn_to_pulse(REV);
	turn_to_pulse(-(REV * 6 / 10)); /* turned back: one revolution */
	turn_to_pulse(-REV + 10);
	TEST_ASSERT_EQUAL_UINT32(10, encoder_index.missed_edges);

	setUp();
	turn_to_pulse(0);
	turn_to_pulse(REV);
	turn_to_pulse(-(REV * 4 / 10)); /* none: no pulse was met backward before */
	turn_to_pulse(-REV + 10);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
}

static void test_a_pulse_that_does_not_come_misses_no_edges(void)
{
	turn_to_pulse(0);
	turn_to_pulse(REV);
	turn_to_pulse(2 * REV);
	turn_to_pulse(REV);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);

	/* Nor do those of a time in which nobody knows how many came. */
	lw_encoder_index_pulse_late(&encoder_index);
	turn_to_pulse(3 * REV);
	turn_to_pulse(REV);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
	turn_to_pulse(REV - 7);
	TEST_ASSERT_EQUAL_UINT32(7, encoder_index.missed_edges);
}

static void test_a_pulse_after_the_shortest_revolution_is_no_chatter(void)
{
	turn_to_pulse(0);
	turn_to_pulse(REV);
	turn_to_pulse(REV);
	turn_on_to_pulse(0, REV_MIN_US - 1);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
	turn_on_to_pulse(0, REV_MIN_US);
	TEST_ASSERT_EQUAL_UINT32(REV, encoder_index.missed_edges);
}

static void test_the_one_edge_of_a_revolution_tells_its_direction(void)
{
	FOR_BOTH_WAYS(way) {
		setUp();
		turn_to_pulse(0);
		turn_to_pulse(way * REV);
		turn_on_to_pulse(way, 15000);
		TEST_ASSERT_EQUAL_INT32(-way * (REV - 1), encoder_index.misfit_edges);
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_whole_revolutions_miss_nothing);
	RUN_TEST(test_missing_and_surplus_edges_are_counted_once);
	RUN_TEST(test_backward_too);
	RUN_TEST(test_what_one_way_has_missed_is_not_missed_again_on_the_other);
	RUN_TEST(test_one_edge_is_chance_but_adds_up);
	RUN_TEST(test_whole_revolutions_without_edges_are_missed);
	RUN_TEST(test_an_index_that_chatters_or_is_rocked_about_misses_nothing);
	RUN_TEST(test_a_revolution_of_few_edges_is_one);
	RUN_TEST(test_rocking_is_seen_in_any_of_the_counts);
	RUN_TEST(test_after_a_late_interrupt_no_pulse_is_known);
	RUN_TEST(test_the_count_may_wrap_round);
	RUN_TEST(test_other_settings_begin_anew);
	RUN_TEST(test_the_nearest_number_of_revolutions_counts);
	RUN_TEST(test_a_pulse_that_does_not_come_misses_no_edges);
	RUN_TEST(test_a_pulse_after_the_shortest_revolution_is_no_chatter);
	RUN_TEST(test_the_one_edge_of_a_revolution_tells_its_direction);
	return UNITY_END();
}
