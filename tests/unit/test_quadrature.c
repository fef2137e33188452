/* SPDX-License-Identifier: Apache-2.0 */
/* Decoding of the drum encoder. */
#include <unity.h>

#include "lw/motion/quadrature.h"

/** The levels of A (bit 1) and B (bit 0) in the order of forward motion. */
static const uint8_t forward[4] = {0, 2, 3, 1};

/** Place of the levels in `forward`. */
static const int place[4] = {0, 3, 1, 2};

static struct lw_quadrature quadrature;
static struct lw_quadrature_config config;

void setUp(void)
{
	config = (struct lw_quadrature_config){.edges_per_pulse = 4};
}

void tearDown(void)
{
}

static void start(uint8_t levels)
{
	lw_quadrature_init(&quadrature, &config, levels & 2, levels & 1);
}

static int update(uint8_t levels)
{
	return lw_quadrature_update(&quadrature, levels & 2, levels & 1);
}

/** What a transition between neighbours shall count. */
static int expected(uint8_t from, uint8_t to, int edges_per_pulse)
{
	const int direction = ((place[to] - place[from]) & 3) == 1 ? 1 : -1;
	const bool of_a = (from ^ to) == 2;
	const bool b_low = !(to & 1);

	if (edges_per_pulse == 4 || (of_a && (edges_per_pulse == 2 || b_low))) {
		return direction;
	}
	return 0;
}

static void test_all_transitions_in_all_modes(void)
{
	static const uint8_t modes[] = {1, 2, 4};

	for (int mode = 0; mode < 3; mode++) {
		config.edges_per_pulse = modes[mode];
		for (uint8_t from = 0; from < 4; from++) {
			for (uint8_t to = 0; to < 4; to++) {
				const bool illegal = (from ^ to) == 3;

				start(from);
				TEST_ASSERT_EQUAL_INT(
					from == to || illegal ? 0 : expected(from, to, modes[mode]),
					update(to));
				TEST_ASSERT_EQUAL_UINT32(illegal, quadrature.illegal_transitions);
				TEST_ASSERT_EQUAL_UINT32(from == to, quadrature.late_interrupts);
				TEST_ASSERT_EQUAL_UINT8(to, quadrature.levels);
			}
		}
	}
}

/** Count of pulses * 4 transitions in a direction, from rest at 00. */
static int count(int pulses, int direction)
{
	int sum = 0;

	for (int i = 1; i <= 4 * pulses; i++) {
		sum += update(forward[(direction * i) & 3]);
	}
	return sum;
}

static void test_counts_per_pulse_are_exact(void)
{
	for (int mode = 1; mode <= 4; mode *= 2) {
		config.edges_per_pulse = (uint8_t)mode;
		start(0);
		TEST_ASSERT_EQUAL_INT(mode * 360, count(360, 1));
		TEST_ASSERT_EQUAL_INT(-mode * 360, count(360, -1));
	}
}

static void test_dither_about_any_edge_nets_to_zero(void)
{
	for (int mode = 1; mode <= 4; mode *= 2) {
		config.edges_per_pulse = (uint8_t)mode;
		for (int i = 0; i < 4; i++) {
			int sum = 0;

			start(forward[i]);
			for (int rock = 0; rock < 10; rock++) {
				sum += update(forward[(i + 1) & 3]);
				sum += update(forward[i]);
			}
			TEST_ASSERT_EQUAL_INT(0, sum);
		}
	}
}

static void test_inversions(void)
{
	for (int bits = 0; bits < 8; bits++) {
		config.invert_a = bits & 1;
		config.invert_b = bits & 2;
		config.invert_direction = bits & 4;
		/* Each of the three turns the direction round. */
		const int sign =
			(config.invert_a != config.invert_b) != config.invert_direction ? -1 : 1;

		start(0);
		TEST_ASSERT_EQUAL_INT(sign * 40, count(10, 1));
		TEST_ASSERT_EQUAL_UINT32(0, quadrature.illegal_transitions);
	}
}

static void test_one_edge_per_pulse_counts_while_the_inverted_b_is_low(void)
{
	config.edges_per_pulse = 1;
	config.invert_b = true;
	start(0);
	TEST_ASSERT_EQUAL_INT(0, update(2)); /* A rises, B reads high */
	TEST_ASSERT_EQUAL_INT(0, update(3));
	TEST_ASSERT_EQUAL_INT(-1, update(1)); /* A falls, B reads low */
}

static void test_init_forgets_illegal_transitions(void)
{
	start(0);
	TEST_ASSERT_EQUAL_INT(0, update(3));
	TEST_ASSERT_EQUAL_UINT32(1, quadrature.illegal_transitions);
	start(3);
	TEST_ASSERT_EQUAL_UINT32(0, quadrature.illegal_transitions);
	TEST_ASSERT_EQUAL_INT(0, update(3));
}

static void test_what_is_no_edge_onward_is_counted_as_what_it_is(void)
{
	config.edges_per_pulse = 1; /* from 00 forward: A is an edge, B, A and B are none */
	start(0);
	for (int i = 1; i <= 4; i++) {
		(void)update(forward[i & 3]);
	}
	TEST_ASSERT_EQUAL_UINT32(1, quadrature.odd_changes[LW_QUADRATURE_A]);
	TEST_ASSERT_EQUAL_UINT32(2, quadrature.odd_changes[LW_QUADRATURE_B]);
	(void)update(3);
	TEST_ASSERT_EQUAL_UINT32(1, quadrature.illegal_transitions);
	(void)update(3);
	TEST_ASSERT_EQUAL_UINT32(1, quadrature.late_interrupts);
	TEST_ASSERT_EQUAL_UINT32(1, quadrature.odd_changes[LW_QUADRATURE_A]);
	TEST_ASSERT_EQUAL_UINT32(2, quadrature.odd_changes[LW_QUADRATURE_B]);
	TEST_ASSERT_EQUAL_UINT32(0, quadrature.turns);
}

static void test_an_edge_that_turns_back_is_a_turn(void)
{
	start(0);
	(void)count(3, 1);
	TEST_ASSERT_EQUAL_UINT32(0, quadrature.turns);
	(void)count(3, -1);
	TEST_ASSERT_EQUAL_UINT32(1, quadrature.turns);
	(void)count(3, 1);
	TEST_ASSERT_EQUAL_UINT32(2, quadrature.turns);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_all_transitions_in_all_modes);
	RUN_TEST(test_counts_per_pulse_are_exact);
	RUN_TEST(test_dither_about_any_edge_nets_to_zero);
	RUN_TEST(test_inversions);
	RUN_TEST(test_one_edge_per_pulse_counts_while_the_inverted_b_is_low);
	RUN_TEST(test_init_forgets_illegal_transitions);
	RUN_TEST(test_what_is_no_edge_onward_is_counted_as_what_it_is);
	RUN_TEST(test_an_edge_that_turns_back_is_a_turn);
	return UNITY_END();
}
