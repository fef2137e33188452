/* SPDX-License-Identifier: Apache-2.0 */
/* The control law: properties P1 to P8 of doc/control-law.md, and the dwell. */
#include <unity.h>

#include "cases.h"
#include "law_check.h"

/** Sets of Ka, Nr, L+ and L-: the example, the extremes of the slope, the smallest sweep. */
static const struct {
	int32_t ka;
	int32_t nr;
	int32_t plus_usteps;
	int32_t minus_usteps;
} sets[] = {
	{23, 1187, 8000, -8000},  {65535, 1, 50, -50},     {1, 26000, 5000, -5000},
	{1, 60000, 2000, -2000},  {1, 1, 1, -1},           {27301, 1, 1, -1},
	{65535, 1, 1, -1},        {23, 1187, 1, -1},       {300, 200, 30000, 29000},
	{17, 3855, -9000, -9500}, {4369, 15, 7800, -8123},
};

#define SET_COUNT (sizeof(sets) / sizeof(sets[0]))

static struct lw_law_window window;
static struct lw_law law;

static void use_set(size_t i)
{
	window = law_window(sets[i].ka, sets[i].nr, sets[i].plus_usteps, sets[i].minus_usteps);
	law = lw_law_at(&window, window.sweep_begin + (window.sweep_end - window.sweep_begin) / 2,
			window.ks);
}

/** The law in the same place, with a dwell at either side. */
static void use_dwell(uint32_t plus_edges, uint32_t minus_edges)
{
	window.dwell_plus_edges = plus_edges;
	window.dwell_minus_edges = minus_edges;
	lw_law_use(&law, &window);
}

/** And a dwell that grows and shrinks by cycle. */
static void use_breaker(uint32_t edges, uint32_t cycles)
{
	window.breaker_edges = edges;
	window.breaker_cycles = cycles;
	lw_law_use(&law, &window);
}

/** One edge, with the properties that hold on every edge. */
static void edge(int dd)
{
	const int32_t before_usteps = lw_law_pos_usteps(lw_law_m(&law));
	const int step = lw_law_edge(&law, dd);

	TEST_ASSERT_EQUAL_INT(lw_law_pos_usteps(lw_law_m(&law)) - before_usteps, step);
	TEST_ASSERT_TRUE_MESSAGE(-1 <= step && step <= 1, "P6: at most one step per edge");
	TEST_ASSERT_TRUE_MESSAGE(law_on_orbit(&law, &window), "the state left the orbit");
}

/** Forward edges until the state is back; so every state that the pattern has is passed. */
static uint32_t period_edges(void)
{
	const struct lw_law start = law;
	uint32_t edges = 0;

	do {
		edge(1);
		edges++;
		TEST_ASSERT_TRUE(edges < 4000000);
	} while (!law_same(&law, &start));
	return edges;
}

void setUp(void)
{
}

void tearDown(void)
{
	cases_end();
}

/** The paper's block diagram as it is drawn, for any dd; comparators, multiplexers, integrators. */
struct diagram {
	int64_t m;
	int64_t velocity;
	int dd_before;
};

static void diagram_edge(struct diagram *diagram, int dd, int32_t ka, int32_t ks, int32_t plus,
			 int32_t minus)
{
	const int64_t pos = diagram->m >> 16;
	const bool in_plus = pos >= plus;
	const bool in_minus = pos <= minus;
	const int upper_mux = in_plus ? -1 : 1;
	const int differentiator = dd - diagram->dd_before;
	const int64_t increment =
		in_plus || in_minus ? (int64_t)dd * upper_mux * ka : (int64_t)differentiator * ks;

	diagram->velocity += increment;
	diagram->m += diagram->velocity;
	diagram->dd_before = dd;
}

static void test_p1_forward_it_equals_the_block_diagram(void)
{
	for (size_t i = 0; i < SET_COUNT; i++) {
		use_set(i);

		struct diagram diagram = {.m = lw_law_m(&law), .velocity = law.u, .dd_before = 1};

		for (uint32_t edges = 4 * period_edges(); edges > 0; edges--) {
			lw_law_edge(&law, 1);
			diagram_edge(&diagram, 1, sets[i].ka, window.ks, sets[i].plus_usteps,
				     sets[i].minus_usteps);
			TEST_ASSERT_EQUAL_INT64(diagram.m, lw_law_m(&law));
			TEST_ASSERT_EQUAL_INT64(diagram.velocity, law.u);
		}
	}
}

static void assert_undone(void)
{
	const struct lw_law state = law;
	struct lw_law copy = law;

	lw_law_edge(&copy, 1);
	lw_law_edge(&copy, -1);
	TEST_ASSERT_TRUE_MESSAGE(law_same(&state, &copy), "forward, backward");
	lw_law_edge(&copy, -1);
	lw_law_edge(&copy, 1);
	TEST_ASSERT_TRUE_MESSAGE(law_same(&state, &copy), "backward, forward");
}

static void test_p2_every_state_of_the_pattern_is_undone(void)
{
	for (size_t i = 0; i < SET_COUNT; i++) {
		for (uint32_t dwell_edges = 0; dwell_edges < 3; dwell_edges++) {
			use_set(i);
			use_dwell(dwell_edges, 2 * dwell_edges);
			/* Also of one with a breaker, whose period is so many times as long. */
			if (i >= 3 && dwell_edges < 2) {
				use_breaker(5, 3 + dwell_edges);
			}
			for (uint32_t edges = period_edges(); edges > 0; edges--) {
				assert_undone();
				edge(1);
			}
		}
	}
}

static void test_p2_states_off_the_pattern_are_undone_too(void)
{
	for (size_t i = 0; i < SET_COUNT; i++) {
		use_set(i);

		const int32_t places[] = {window.sweep_begin, window.sweep_end, 0, lw_law_m(&law)};

		for (size_t place = 0; place < 4; place++) {
			for (int32_t offset = -70000; offset <= 70000; offset += 997) {
				for (int32_t u = -window.ks; u <= window.ks;
				     u += window.ks / 7 + 1) {
					law = lw_law_at(&window, places[place] + offset, u);
					assert_undone();
				}
			}
		}
	}
}

static void test_p3_the_sweep_slope_is_exactly_ks_for_ever(void)
{
	for (size_t i = 0; i < SET_COUNT; i++) {
		use_set(i);
		for (uint32_t edges = 4 * period_edges(); edges > 0; edges--) {
			const bool was_in_sweep = lw_law_region(&window, lw_law_m(&law)) == 0;

			edge(1);
			TEST_ASSERT_TRUE(-window.ks <= law.u && law.u <= window.ks);
			if (was_in_sweep) {
				TEST_ASSERT_EQUAL_INT32(window.ks, law.u < 0 ? -law.u : law.u);
			}
		}
	}
}

/** From the sweep into the reversal toward `direction`, through it and out; P4 and P5. */
static void check_reversal(int direction, int32_t nr, uint32_t dwell_edges)
{
	uint32_t edges = 0;
	int64_t farthest = 0;

	while (lw_law_region(&window, lw_law_m(&law)) != -direction) {
		edge(1);
	}

	const int32_t entry = lw_law_m(&law);

	TEST_ASSERT_EQUAL_INT32(direction * window.ks, law.u);
	do {
		edge(1);
		edges++;
		if (direction * ((int64_t)lw_law_m(&law) - entry) > farthest) {
			farthest = direction * ((int64_t)lw_law_m(&law) - entry);
		}
	} while (law.u != -direction * window.ks);

	TEST_ASSERT_EQUAL_UINT32(2 * (uint32_t)nr + dwell_edges, edges);
	TEST_ASSERT_EQUAL_INT64((int64_t)window.ks * (nr - 1) / 2, farthest);
	TEST_ASSERT_EQUAL_INT32(entry - direction * window.ks, lw_law_m(&law));
	TEST_ASSERT_EQUAL_INT(0, lw_law_region(&window, lw_law_m(&law)));
}

static void test_p4_p5_reversals_at_both_sides(void)
{
	for (size_t i = 0; i < SET_COUNT; i++) {
		use_set(i);

		const int32_t reach = (int32_t)((int64_t)window.ks * (sets[i].nr - 1) / 2 >> 16);

		for (int period = 0; period < 4; period++) {
			check_reversal(1, sets[i].nr, 0);
			check_reversal(-1, sets[i].nr, 0);
		}
		for (uint32_t edges = period_edges(); edges > 0; edges--) {
			edge(1);
			TEST_ASSERT_TRUE(lw_law_pos_usteps(lw_law_m(&law)) <=
					 sets[i].plus_usteps + reach + 1);
			TEST_ASSERT_TRUE(lw_law_pos_usteps(lw_law_m(&law)) >=
					 sets[i].minus_usteps - reach - 1);
		}
	}
}

static void test_p7_the_pattern_has_one_period(void)
{
	for (size_t i = 0; i < SET_COUNT; i++) {
		use_set(i);

		/* The state comes back bit for bit, so what holds for these holds for all. */
		const uint32_t edges = period_edges();

		for (int period = 0; period < 10; period++) {
			TEST_ASSERT_EQUAL_UINT32(edges, period_edges());
		}
	}
}

static void test_random_directions_stay_on_the_orbit_and_can_be_retraced(void)
{
	uint64_t seed = 1;

	for (size_t i = 0; i < SET_COUNT; i++) {
		use_set(i);
		use_dwell((uint32_t)i % 3, (uint32_t)i % 4);
		use_breaker((uint32_t)i * 7, (uint32_t)i % 5);

		const struct lw_law start = law;
		struct lw_law straight = law;
		int64_t net_edges = 0;

		/* Runs of some length: mere dither would not come far. */
		for (int run = 0; run < 200; run++) {
			const int dd = next_random(&seed) % 2 ? 1 : -1;

			for (uint32_t edges = next_random(&seed) % 5000; edges > 0; edges--) {
				edge(dd);
				net_edges += dd;
			}
		}
		for (int64_t edges = net_edges; edges != 0; edges += edges > 0 ? -1 : 1) {
			lw_law_edge(&straight, net_edges > 0 ? 1 : -1);
		}
		TEST_ASSERT_TRUE(law_same(&straight, &law));
		for (; net_edges != 0; net_edges += net_edges > 0 ? -1 : 1) {
			edge(net_edges > 0 ? -1 : 1);
		}
		TEST_ASSERT_TRUE(law_same(&start, &law));
	}
}

static void test_p8_the_steepest_and_longest_reversal_fits(void)
{
	/* Ka 1, Nr 65535: its overshoot is 32766 microsteps, all that a position has. */
	window = law_window(1, 65535, 0, -20000);
	law = lw_law_at(&window, 65534, 65535);
	for (int i = 0; i < 2 * 65535; i++) {
		edge(1);
	}
	TEST_ASSERT_EQUAL_INT32(-1, lw_law_m(&law));
	TEST_ASSERT_EQUAL_INT32(-65535, law.u);
	for (int i = 0; i < 2 * 65535; i++) {
		edge(-1);
	}
	TEST_ASSERT_EQUAL_INT32(65534, lw_law_m(&law));
}

static void test_dwell_is_exact_to_one_edge_at_both_sides(void)
{
	for (size_t i = 0; i < SET_COUNT; i++) {
		use_set(i);

		const uint32_t edges = period_edges();

		use_dwell(3, 2880);
		TEST_ASSERT_EQUAL_UINT32(edges + 3 + 2880, period_edges());
		check_reversal(1, sets[i].nr, 3);
		check_reversal(-1, sets[i].nr, 2880);
	}
}

/** At the far point and through it in direction dd: edges at rest, then the first that moves. */
static void check_rest(int dd, uint32_t dwell_edges)
{
	const int32_t m = lw_law_m(&law);

	for (uint32_t i = 0; i < dwell_edges; i++) {
		edge(dd);
		TEST_ASSERT_EQUAL_INT32(m, lw_law_m(&law));
		TEST_ASSERT_EQUAL_INT32(0, law.u);
	}
	edge(dd);
	TEST_ASSERT_NOT_EQUAL(0, law.u);
}

static void test_dwell_rests_as_long_backward_as_forward(void)
{
	FOR_BOTH_WAYS(side) {
		const uint32_t dwell_edges = side > 0 ? 5 : 7;

		use_set(0);
		use_dwell(5, 7);
		while (!(law.u == 0 && lw_law_region(&window, lw_law_m(&law)) == -side)) {
			edge(1);
		}
		check_rest(1, dwell_edges);
		edge(-1);
		TEST_ASSERT_EQUAL_INT32(0, law.u);
		check_rest(-1, dwell_edges);
		edge(1);
		TEST_ASSERT_EQUAL_INT32(0, law.u);

		/* Turning round within the dwell: what was rested is taken back. */
		edge(1);
		edge(1);
		edge(-1);
		edge(-1);
		check_rest(-1, 0);
	}
}

/** To the far point of a side, in direction dd, and edges at rest there. */
static uint32_t rest_at(int side, int dd)
{
	uint32_t edges = 0;

	do {
		edge(dd);
	} while (!(law.u == 0 && lw_law_region(&window, lw_law_m(&law)) == -side));
	do {
		edge(dd);
		edges++;
	} while (law.u == 0);
	return edges - 1;
}

static void test_the_breaker_goes_up_and_down_by_cycle_at_both_sides(void)
{
	/* What 100 edges over 8 cycles, 7 over 5 and 3 over 2 add to 2 at plus and 9 at minus. */
	static const struct {
		uint32_t edges;
		uint32_t cycles;
		uint32_t adds[8];
	} breakers[] = {{100, 8, {0, 25, 50, 75, 100, 75, 50, 25}},
			{7, 5, {0, 3, 7, 7, 3}},
			{3, 2, {0, 3}}};

	for (size_t b = 0; b < 3; b++) {
		const uint32_t cycles = breakers[b].cycles;

		use_set(4);
		use_dwell(2, 9);
		use_breaker(breakers[b].edges, cycles);

		const struct lw_law start = law;

		for (uint32_t k = 0; k < 3 * cycles; k++) {
			const uint32_t adds = breakers[b].adds[k % cycles];

			TEST_ASSERT_EQUAL_UINT32(2 + adds, rest_at(1, 1));
			TEST_ASSERT_EQUAL_UINT32(9 + adds, rest_at(-1, 1));
		}
		TEST_ASSERT_EQUAL_UINT32(0, law.cycle_plus);
		/* Back on the same path, and beyond where it began. */
		for (uint32_t k = 4 * cycles; k > 0; k--) {
			const uint32_t adds = breakers[b].adds[(k - 1) % cycles];

			TEST_ASSERT_EQUAL_UINT32(9 + adds, rest_at(-1, -1));
			TEST_ASSERT_EQUAL_UINT32(2 + adds, rest_at(1, -1));
		}
		for (uint32_t k = 0; k < cycles; k++) {
			rest_at(1, 1);
			rest_at(-1, 1);
		}
		while (!law_same(&law, &start)) {
			edge(1); /* at most to the next far point, or this never ends */
			TEST_ASSERT_EQUAL_UINT32(0, law.cycle_plus);
		}
	}
}

static void test_a_breaker_of_less_than_two_cycles_adds_nothing(void)
{
	for (uint32_t cycles = 0; cycles < 2; cycles++) {
		use_set(4);
		use_breaker(50, cycles);
		for (int k = 0; k < 3; k++) {
			TEST_ASSERT_EQUAL_UINT32(0, rest_at(1, 1));
			TEST_ASSERT_EQUAL_UINT32(0, rest_at(-1, 1));
		}
		TEST_ASSERT_EQUAL_UINT32(0, rest_at(-1, -1));
		TEST_ASSERT_EQUAL_UINT32(0, law.cycle_plus | law.cycle_minus);
	}
}

static void test_the_largest_breaker_does_not_overflow(void)
{
	use_set(4);
	use_breaker(LW_LAW_BREAKER_EDGES_MAX, LW_LAW_BREAKER_CYCLES_MAX);
	law.cycle_plus = LW_LAW_BREAKER_CYCLES_MAX / 2;
	TEST_ASSERT_EQUAL_UINT32(LW_LAW_BREAKER_EDGES_MAX, rest_at(1, 1));
}

static void test_another_window_keeps_the_cycle_another_breaker_begins_anew(void)
{
	use_set(4);
	use_breaker(20, 4);
	rest_at(1, 1);
	rest_at(-1, 1);
	rest_at(1, 1);
	window.sweep_end += LW_USTEP; /* a trim */
	lw_law_use(&law, &window);
	TEST_ASSERT_EQUAL_UINT32(2, law.cycle_plus);
	TEST_ASSERT_EQUAL_UINT32(1, law.cycle_minus);
	use_breaker(20, 2);
	TEST_ASSERT_EQUAL_UINT32(0, law.cycle_plus);
	TEST_ASSERT_EQUAL_UINT32(0, law.cycle_minus);
}

static void test_the_breaker_begins_anew_when_told(void)
{
	use_set(4);
	use_breaker(20, 4);
	for (int k = 0; k < 2; k++) {
		rest_at(1, 1);
		rest_at(-1, 1);
	}
	lw_law_begin_cycles(&law);
	TEST_ASSERT_EQUAL_UINT32(0, rest_at(1, 1));
	TEST_ASSERT_EQUAL_UINT32(0, rest_at(-1, 1));
	TEST_ASSERT_EQUAL_UINT32(10, rest_at(1, 1));
	TEST_ASSERT_EQUAL_UINT32(10, rest_at(-1, 1));
}

static void test_the_lowest_place_lies_before_the_sweep(void)
{
	use_set(0);
	law = lw_law_at(&window, INT32_MIN, 0);
	use_dwell(0, 1);
	lw_law_edge(&law, 1); /* the dwell of the minus side */
	TEST_ASSERT_EQUAL_INT32(0, law.u);
	TEST_ASSERT_EQUAL_UINT32(1, law.dwell_edges);
	lw_law_edge(&law, 1);
	TEST_ASSERT_EQUAL_INT32(window.ka, law.u);
}

/** The law in the sweep's place `m`, its short way open. */
static void open_at(int32_t m, int32_t u)
{
	law = lw_law_at(&window, m, u);
	law.open_span = law.span;
}

static void test_edges_are_taken_together_up_to_the_first_and_the_last_place_of_the_sweep(void)
{
	int32_t steps;

	use_set(0);
	open_at(window.sweep_begin + window.ks, window.ks);
	TEST_ASSERT_TRUE(lw_law_short_edges(&law, -1, &steps));
	TEST_ASSERT_EQUAL_INT32(window.sweep_begin, lw_law_m(&law));
	open_at(window.sweep_end - 1 - window.ks, window.ks);
	TEST_ASSERT_TRUE(lw_law_short_edges(&law, 1, &steps));
	TEST_ASSERT_EQUAL_INT32(window.sweep_end - 1, lw_law_m(&law));

	/* One further out the slope changes: to there, and from there. */
	open_at(window.sweep_begin + window.ks - 1, window.ks);
	TEST_ASSERT_FALSE(lw_law_short_edges(&law, -1, &steps));
	open_at(window.sweep_end - window.ks, -window.ks);
	TEST_ASSERT_FALSE(lw_law_short_edges(&law, -1, &steps));
	open_at(window.sweep_end, window.ka - window.ks);
	TEST_ASSERT_FALSE(lw_law_short_edges(&law, 1, &steps));
	TEST_ASSERT_EQUAL_INT32(window.sweep_end, lw_law_m(&law));
}

static void test_edges_to_the_next_step_are_exact_at_the_smallest_slope(void)
{
	window = law_window(1, 1, 8, -8);
	for (int32_t fraction = 0; fraction < LW_USTEP; fraction += 21845) {
		open_at(fraction, 1);
		TEST_ASSERT_EQUAL_UINT32(LW_USTEP - fraction, lw_law_edges_to_step(&law, 1));
		TEST_ASSERT_EQUAL_UINT32(fraction + 1, lw_law_edges_to_step(&law, -1));
	}
	open_at(window.sweep_end - 1, 1);
	TEST_ASSERT_EQUAL_UINT32(1, lw_law_edges_to_step(&law, 1));
	TEST_ASSERT_EQUAL_UINT32(LW_USTEP, lw_law_edges_to_step(&law, -1));
	/* Outside of the sweep it does not know. */
	open_at(window.sweep_end, 1);
	TEST_ASSERT_EQUAL_UINT32(1, lw_law_edges_to_step(&law, 1));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_p1_forward_it_equals_the_block_diagram);
	RUN_TEST(test_p2_every_state_of_the_pattern_is_undone);
	RUN_TEST(test_p2_states_off_the_pattern_are_undone_too);
	RUN_TEST(test_p3_the_sweep_slope_is_exactly_ks_for_ever);
	RUN_TEST(test_p4_p5_reversals_at_both_sides);
	RUN_TEST(test_p7_the_pattern_has_one_period);
	RUN_TEST(test_random_directions_stay_on_the_orbit_and_can_be_retraced);
	RUN_TEST(test_p8_the_steepest_and_longest_reversal_fits);
	RUN_TEST(test_dwell_is_exact_to_one_edge_at_both_sides);
	RUN_TEST(test_dwell_rests_as_long_backward_as_forward);
	RUN_TEST(test_the_breaker_goes_up_and_down_by_cycle_at_both_sides);
	RUN_TEST(test_a_breaker_of_less_than_two_cycles_adds_nothing);
	RUN_TEST(test_the_largest_breaker_does_not_overflow);
	RUN_TEST(test_another_window_keeps_the_cycle_another_breaker_begins_anew);
	RUN_TEST(test_the_breaker_begins_anew_when_told);
	RUN_TEST(test_the_lowest_place_lies_before_the_sweep);
	RUN_TEST(test_edges_are_taken_together_up_to_the_first_and_the_last_place_of_the_sweep);
	RUN_TEST(test_edges_to_the_next_step_are_exact_at_the_smallest_slope);
	return UNITY_END();
}
