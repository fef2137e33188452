/* SPDX-License-Identifier: Apache-2.0 */
/* Where the paper does not hold: one test for each row of the table in doc/control-law.md. */
#include <unity.h>

#include "cases.h"
#include "law_check.h"
#include "lw/motion/motion.h"
#include "lw/motion/move.h"
#include "lw/control/params.h"

#define KA    23
#define NR    1187
#define KS    (KA * NR)
#define PLUS  8000
#define MINUS (-8000)

static struct lw_law_window window;
static struct lw_law law;

/** The paper's law: the velocity, not the slope, is integrated, and dd * mux * Ka changes it. */
struct paper {
	int64_t m;
	int64_t velocity;
	int dd_before;
};

static struct paper paper;

static void paper_edge(int dd)
{
	const int64_t pos = paper.m >> 16;

	if (pos >= PLUS || pos <= MINUS) {
		paper.velocity += dd * (pos >= PLUS ? -KA : KA);
	} else {
		paper.velocity += (int64_t)(dd - paper.dd_before) * KS;
	}
	paper.m += paper.velocity;
	paper.dd_before = dd;
}

static int64_t paper_speed(void)
{
	return paper.velocity < 0 ? -paper.velocity : paper.velocity;
}

static void both_edges(int dd, int32_t count)
{
	while (count-- > 0) {
		paper_edge(dd);
		lw_law_edge(&law, dd);
	}
}

void setUp(void)
{
	window = law_window(KA, NR, PLUS, MINUS);
	law = lw_law_at(&window, 0, KS);
	paper = (struct paper){.m = 0, .velocity = KS, .dd_before = 1};
}

void tearDown(void)
{
	cases_end();
}

static void test_paper_row_drum_backward_runs_away(void)
{
	for (int i = 0; i < 400000; i++) {
		both_edges(-1, 1);
		TEST_ASSERT_TRUE(law_on_orbit(&law, &window));
	}
	TEST_ASSERT_EQUAL_INT64(321, paper_speed() / KS);

	for (int i = 0; i < 400000; i++) {
		lw_law_edge(&law, 1);
	}
	TEST_ASSERT_EQUAL_INT32(0, lw_law_m(&law));
	TEST_ASSERT_EQUAL_INT32(KS, law.u);
}

static void test_paper_row_direction_change_inside_a_reversal(void)
{
	int64_t paper_farthest = 0;
	int32_t farthest = 0;

	while (lw_law_region(&window, lw_law_m(&law)) == 0) {
		both_edges(1, 1);
	}
	both_edges(1, NR / 2);
	for (int i = 0; i < 100; i++) {
		/* The drum turns for a moment, and goes on. */
		both_edges(-1, 20);
		both_edges(1, 20);
	}
	while (law.u != -KS) {
		both_edges(1, 1);
		paper_farthest = paper.m > paper_farthest ? paper.m : paper_farthest;
		farthest = lw_law_m(&law) > farthest ? lw_law_m(&law) : farthest;
	}
	TEST_ASSERT_EQUAL_INT32(PLUS + 247, lw_law_pos_usteps(farthest));
	TEST_ASSERT_NOT_EQUAL(lw_law_pos_usteps(farthest), paper_farthest >> 16);

	both_edges(1, 4000);
	TEST_ASSERT_EQUAL_INT32(-KS, law.u);
	TEST_ASSERT_NOT_EQUAL(KS, paper_speed());
}

static void test_paper_row_ka_and_nr_follow_from_ks_and_overshoot(void)
{
	const int64_t overshoot = (int64_t)KS * (NR - 1) / 2;

	TEST_ASSERT_EQUAL_INT64(overshoot, lw_move_overshoot_q16(KA, NR));
	TEST_ASSERT_EQUAL_INT64(NR, 2 * overshoot / KS + 1);
	TEST_ASSERT_EQUAL_INT64(KA, (int64_t)KS * KS / (2 * overshoot + KS));
	/* The paper's Nr, put into its own formula of the overshoot, is one half slope too far. */
	TEST_ASSERT_EQUAL_INT64(NR + 1, 2 * (overshoot + KS) / KS);

	/* What lw_params_derive() chooses for an overshoot gives this overshoot. */
	struct lw_params params = lw_params_default;
	struct lw_derived derived;
	struct lw_refusal why;

	for (uint32_t um = 100; um <= 2400; um += 100) {
		params.overshoot_um = um;
		params.slope_tolerance_ppm = 20000;
		TEST_ASSERT_EQUAL_INT(0, lw_params_derive(&params, &derived, &why));

		const int64_t asked_q16 = (int64_t)um * LW_USTEP / 10;
		const int64_t error_q16 = derived.overshoot_q16 - asked_q16;

		/* Nr is whole: half a slope of overshoot for each unit, and Ks is within 2 %. */
		TEST_ASSERT_TRUE(error_q16 <= derived.ks + asked_q16 / 50);
		TEST_ASSERT_TRUE(error_q16 >= -derived.ks - asked_q16 / 50);
		TEST_ASSERT_EQUAL_INT64(2 * asked_q16 / 27307 + 1, derived.nr);
		TEST_ASSERT_EQUAL_INT64(2 * (int64_t)derived.overshoot_q16 / derived.ks + 1,
					derived.nr);
	}
}

static void test_paper_row_a_reversal_takes_two_nr_edges(void)
{
	int edges = 0;

	while (lw_law_region(&window, lw_law_m(&law)) == 0) {
		lw_law_edge(&law, 1);
	}
	while (law.u != -KS) {
		lw_law_edge(&law, 1);
		edges++;
	}
	TEST_ASSERT_EQUAL_INT(2 * NR, edges);
	TEST_ASSERT_EQUAL_INT(0, lw_law_region(&window, lw_law_m(&law)));
}

static void test_paper_row_indexing_ramp(void)
{
	/* The paper's way, L- = Nr, taken as microsteps, from rest at 0. */
	window = law_window(KA, NR, 30000, NR);
	law = lw_law_at(&window, 0, 0);
	while (lw_law_region(&window, lw_law_m(&law)) != 0) {
		lw_law_edge(&law, 1);
	}
	TEST_ASSERT_EQUAL_INT32(219, 100 * (int64_t)law.u / KS);

	FOR_BOTH_WAYS(direction) {
		law = lw_law_at(&window, lw_move_run(&window, KA, NR, direction), 0);
		TEST_ASSERT_EQUAL_INT32(0, law.u);
		for (int i = 0; i < NR; i++) {
			TEST_ASSERT_EQUAL_INT32(direction * i * KA, law.u);
			lw_law_edge(&law, 1);
		}
		TEST_ASSERT_EQUAL_INT32(0, lw_law_m(&law));
		for (int i = 0; i < 40000; i++) {
			TEST_ASSERT_EQUAL_INT32(direction * KS, law.u);
			lw_law_edge(&law, 1);
		}
	}
}

static void test_paper_row_parking_place(void)
{
	const int32_t park_usteps = -1234;

	/* The last reversal begins one overshoot before the place; it ends in rest there. */
	window.sweep_end = (int32_t)(park_usteps * LW_USTEP - lw_move_overshoot_q16(KA, NR));
	law = lw_law_at(&window, -7000 * LW_USTEP, law.u);
	do {
		lw_law_edge(&law, 1);
	} while (law.u != 0);
	TEST_ASSERT_TRUE(lw_law_m(&law) >= park_usteps * LW_USTEP);
	TEST_ASSERT_TRUE(lw_law_m(&law) < park_usteps * LW_USTEP + KS);

	/* The paper's L- = pos_init + Nr: far from it. */
	window = law_window(KA, NR, PLUS, park_usteps + NR);
	law = lw_law_at(&window, 7000 * LW_USTEP, -KS);
	do {
		lw_law_edge(&law, 1);
	} while (law.u != 0);
	TEST_ASSERT_INT32_WITHIN(2, NR - 247, lw_law_pos_usteps(lw_law_m(&law)) - park_usteps);
}

static void test_paper_row_without_a_hand_over_the_carriage_never_moves_again(void)
{
	/* That hand-over sets the slope: test_controller.c. */
	law = lw_law_at(&window, 100 * LW_USTEP, 0);
	for (int i = 0; i < 100000; i++) {
		TEST_ASSERT_EQUAL_INT(0, lw_law_edge(&law, 1));
	}
}

static void test_paper_row_example_set(void)
{
	struct lw_derived derived;
	struct lw_refusal why;

	TEST_ASSERT_EQUAL_INT(0, lw_params_derive(&lw_params_default, &derived, &why));
	TEST_ASSERT_EQUAL_INT32(23, derived.ka);
	TEST_ASSERT_EQUAL_INT32(1187, derived.nr);
	TEST_ASSERT_EQUAL_INT32(27301, derived.ks);
	/* 5/12, not 5/7; within the tolerance. */
	TEST_ASSERT_EQUAL_INT32(27307, (5 * 65536 + 6) / 12);
	TEST_ASSERT_INT32_WITHIN(500, 0, derived.slope_error_ppm);
}

static void test_paper_row_reindex_inside_a_reversal(void)
{
	struct lw_motion motion;

	/* Overwriting m in a reversal strands a slope that is not Ks in the sweep, for ever. */
	law = lw_law_at(&window, PLUS * LW_USTEP, KS);
	for (int i = 0; i < NR / 2; i++) {
		lw_law_edge(&law, 1);
	}
	law.rel -= 300u * LW_USTEP;
	while (lw_law_region(&window, lw_law_m(&law)) == 0 && law.u > 0) {
		TEST_ASSERT_NOT_EQUAL(KS, law.u);
		lw_law_edge(&law, 1);
	}

	/* Held, and applied on the edge that leaves the reversal. */
	lw_motion_init(&motion, &window);
	lw_motion_set_position(&motion, &window, PLUS * LW_USTEP, KS);
	lw_motion_set_source(&motion, LW_EDGE_SOURCE_ENCODER);
	law = motion.law;
	motion.request_correction_usteps = -300;
	lw_motion_request(&motion, LW_MOTION_REQUEST_CORRECTION);
	for (int i = 1; i < 2 * NR; i++) {
		lw_motion_encoder_edge(&motion, 1);
		lw_law_edge(&law, 1);
		TEST_ASSERT_TRUE(law_same(&law, &motion.law));
	}
	lw_motion_encoder_edge(&motion, 1);
	lw_law_edge(&law, 1);
	TEST_ASSERT_EQUAL_INT32(-KS, motion.law.u);
	TEST_ASSERT_EQUAL_INT32(lw_law_m(&law) - 300 * LW_USTEP, lw_motion_m(&motion));
	TEST_ASSERT_EQUAL_UINT8(0, motion.requests);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_paper_row_drum_backward_runs_away);
	RUN_TEST(test_paper_row_direction_change_inside_a_reversal);
	RUN_TEST(test_paper_row_ka_and_nr_follow_from_ks_and_overshoot);
	RUN_TEST(test_paper_row_a_reversal_takes_two_nr_edges);
	RUN_TEST(test_paper_row_indexing_ramp);
	RUN_TEST(test_paper_row_parking_place);
	RUN_TEST(test_paper_row_without_a_hand_over_the_carriage_never_moves_again);
	RUN_TEST(test_paper_row_example_set);
	RUN_TEST(test_paper_row_reindex_inside_a_reversal);
	return UNITY_END();
}
