/* The check of the odometer by the encoder's index pulse. */
#include <unity.h>

#include "lw/encoder_index.h"

#define REV 720

/** Edges that the index pulse is wide: it begins that much later when met backward. */
#define WIDTH 2

static struct lw_encoder_index encoder_index;
static uint32_t net_edges;

void setUp(void)
{
	encoder_index = (struct lw_encoder_index){0};
	lw_encoder_index_configure(&encoder_index, REV);
	net_edges = 0;
}

void tearDown(void)
{
}

/** Turn by some edges, and meet the index pulse there. */
static void turn_to_pulse(int32_t edges)
{
	net_edges += (uint32_t)edges;
	lw_encoder_index_pulse(&encoder_index, net_edges);
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
	lw_encoder_index_configure(&encoder_index, 2 * REV);
	turn_to_pulse(500);
	turn_to_pulse(2 * REV);
	turn_to_pulse(2 * REV);
	TEST_ASSERT_EQUAL_UINT32(0, encoder_index.missed_edges);
	turn_to_pulse(2 * REV - 8);
	TEST_ASSERT_EQUAL_UINT32(8, encoder_index.missed_edges);
	TEST_ASSERT_EQUAL_UINT32(6, encoder_index.pulses);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_whole_revolutions_miss_nothing);
	RUN_TEST(test_missing_and_surplus_edges_are_counted_once);
	RUN_TEST(test_backward_too);
	RUN_TEST(test_what_one_way_has_missed_is_not_missed_again_on_the_other);
	RUN_TEST(test_one_edge_is_chance_but_adds_up);
	RUN_TEST(test_the_count_may_wrap_round);
	RUN_TEST(test_other_settings_begin_anew);
	return UNITY_END();
}
