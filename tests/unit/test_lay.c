/* SPDX-License-Identifier: Apache-2.0 */
/* How rope lies: the height field by hand-made drums, and the law's pattern laid on it. */
#include <errno.h>
#include <math.h>
#include <string.h>

#include <unity.h>

#include "lw_lay.h"

#define ROPE_UM              5000
#define ROPE_MM              5.0
#define COLUMNS              161 /* from -20 mm to 20 mm */
#define CENTRE               80  /* column of position 0 */
#define FACTORY_PERIOD_EDGES 81558

int lw_native_lay(const int32_t *values, uint32_t rope_um, size_t count, double *position_mm,
		  double *centre_mm, float *height_mm, struct lw_lay_evenness *evenness,
		  struct lw_refusal *why);

static struct lw_lay_field field;
static float heights[LW_LAY_ANGLES * COLUMNS];
static float scratch[LW_LAY_ANGLES * COLUMNS];
static struct lw_params params;
static struct lw_lay_pattern pattern;
static struct lw_refusal why;

void setUp(void)
{
	params = lw_params_default;
	TEST_ASSERT_EQUAL_INT(0, lw_lay_bare(&field, heights, -CENTRE, COLUMNS, ROPE_UM));
}

void tearDown(void)
{
}

static double height_at(int angle, int column)
{
	return (double)heights[angle * COLUMNS + column];
}

static void test_rope_on_the_bare_drum_is_round_and_lies_on_its_lowest_point(void)
{
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM / 2, lw_lay_rope(&field, 3, 0.0));
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM, height_at(3, CENTRE));
	/* 1.5 mm beside the middle of a circle of 2.5 mm: 2.0 mm above it. */
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, 4.5, height_at(3, CENTRE + 6));
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, 4.5, height_at(3, CENTRE - 6));
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM / 2, height_at(3, CENTRE + 10));
	TEST_ASSERT_EQUAL_FLOAT(0, heights[3 * COLUMNS + CENTRE + 11]);
	TEST_ASSERT_EQUAL_FLOAT(0, heights[2 * COLUMNS + CENTRE]);
}

static void test_coil_on_coil_is_a_rope_higher(void)
{
	lw_lay_rope(&field, 0, 4.0);
	TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1.5 * ROPE_MM, lw_lay_rope(&field, 0, 4.0));
	TEST_ASSERT_DOUBLE_WITHIN(1e-5, 2.5 * ROPE_MM, lw_lay_rope(&field, 0, 4.0));
}

static void test_coils_side_by_side_lie_on_the_drum(void)
{
	lw_lay_rope(&field, 0, -2.5);
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM / 2, lw_lay_rope(&field, 0, 2.5));
	/* In the groove between: centres a diameter apart, the third over the middle. */
	TEST_ASSERT_DOUBLE_WITHIN(1e-5, ROPE_MM / 2 * (1 + sqrt(3)), lw_lay_rope(&field, 0, 0.0));
}

static void test_rope_at_and_beyond_the_border_of_the_grid(void)
{
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM / 2, lw_lay_rope(&field, 71, -20.0));
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM, height_at(71, 0));
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM / 2, lw_lay_rope(&field, 71, 20.0));
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM, height_at(71, COLUMNS - 1));
	lw_lay_rope(&field, 71, 22.6);
	lw_lay_rope(&field, 71, -1e6);
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM / 2, lw_lay_rope(&field, 71, 1e6));
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM, height_at(71, COLUMNS - 1));
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM, height_at(71, 0));
	TEST_ASSERT_EQUAL_FLOAT(0, heights[70 * COLUMNS]);
}

static void test_a_path_goes_round_the_drum(void)
{
	double position_mm[LW_LAY_ANGLES + 1] = {0};
	double centre_mm[LW_LAY_ANGLES + 1];

	lw_lay_path(&field, position_mm, LW_LAY_ANGLES + 1, centre_mm);
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM / 2, centre_mm[0]);
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, ROPE_MM / 2, centre_mm[LW_LAY_ANGLES - 1]);
	TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1.5 * ROPE_MM, centre_mm[LW_LAY_ANGLES]);
	lw_lay_path(&field, position_mm, 1, NULL);
	TEST_ASSERT_DOUBLE_WITHIN(1e-5, 3 * ROPE_MM, height_at(0, CENTRE));
}

static void test_a_drum_that_cannot_be_is_refused(void)
{
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_lay_bare(&field, NULL, 0, COLUMNS, ROPE_UM));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_lay_bare(&field, heights, 0, 0, ROPE_UM));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_lay_bare(&field, heights, 0, COLUMNS, 0));
	TEST_ASSERT_EQUAL_INT(-EINVAL,
			      lw_lay_bare(&field, heights, 0, COLUMNS, LW_LAY_ROPE_UM_MAX + 1));
	TEST_ASSERT_EQUAL_INT(0, lw_lay_bare(&field, heights, 0, COLUMNS, LW_LAY_ROPE_UM_MAX));
	lw_lay_rope(&field, 0, 20.0);
	TEST_ASSERT_EQUAL_INT(0, lw_lay_bare(&field, heights, 0, COLUMNS, 1));
	TEST_ASSERT_EQUAL_FLOAT(0, heights[CENTRE]);
}

static void test_evenness_is_that_of_the_judged_columns(void)
{
	struct lw_lay_evenness evenness;

	/* Columns 10 to 19 hold 0, 1, 2, ... in an order of no account, all else is far above. */
	for (int i = 0; i < LW_LAY_ANGLES * COLUMNS; i++) {
		heights[i] = 1e6f;
	}
	for (int i = 0; i < 10 * LW_LAY_ANGLES; i++) {
		heights[i / 10 * COLUMNS + 10 + i % 10] = (float)(i * 77 % (10 * LW_LAY_ANGLES));
	}
	TEST_ASSERT_EQUAL_INT(0, lw_lay_judge(&field, -CENTRE + 10, 10, scratch, &evenness));
	TEST_ASSERT_DOUBLE_WITHIN(1e-9, 719, evenness.max_mm);
	TEST_ASSERT_DOUBLE_WITHIN(1e-9, 359.5, evenness.mean_mm);
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, sqrt((720.0 * 720 - 1) / 12), evenness.std_mm);
	TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.05 * 719, evenness.p5_mm);
}

static void test_evenness_of_a_flat_drum(void)
{
	struct lw_lay_evenness evenness;

	TEST_ASSERT_EQUAL_INT(0, lw_lay_judge(&field, -CENTRE, COLUMNS, scratch, &evenness));
	TEST_ASSERT_TRUE(evenness.max_mm == 0 && evenness.mean_mm == 0);
	TEST_ASSERT_TRUE(evenness.std_mm == 0 && evenness.p5_mm == 0);
	TEST_ASSERT_EQUAL_INT(0, lw_lay_judge(&field, CENTRE, 1, scratch, &evenness));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_lay_judge(&field, CENTRE, 2, scratch, &evenness));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_lay_judge(&field, -CENTRE - 1, 2, scratch, &evenness));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_lay_judge(&field, 0, 0, scratch, &evenness));
}

static void test_the_factory_set_repeats_after_as_many_edges_as_the_law_says(void)
{
	uint64_t edges[3];

	TEST_ASSERT_EQUAL_INT(0, lw_lay_prepare(&params, ROPE_UM, &pattern, &why));
	lw_lay_double_traverses(&pattern, edges, 3);
	TEST_ASSERT_EQUAL_UINT64(FACTORY_PERIOD_EDGES, edges[0]);
	TEST_ASSERT_EQUAL_UINT64(FACTORY_PERIOD_EDGES, edges[1]);
	TEST_ASSERT_EQUAL_UINT64(FACTORY_PERIOD_EDGES, edges[2]);
	/* 80 mm and an overshoot of 2.47 mm: columns -330 to 330, and 2.5 mm of rope outside. */
	TEST_ASSERT_EQUAL_INT32(-330, pattern.first_judged);
	TEST_ASSERT_EQUAL_INT32(661, pattern.judged);
	TEST_ASSERT_EQUAL_INT32(-340, pattern.first_column);
	TEST_ASSERT_EQUAL_INT32(681, pattern.columns);
}

static void test_a_dwell_makes_the_double_traverse_longer(void)
{
	uint64_t edges[2];

	params.dwell_plus_millirev = 100;
	params.dwell_minus_millirev = 200;
	TEST_ASSERT_EQUAL_INT(0, lw_lay_prepare(&params, ROPE_UM, &pattern, &why));
	lw_lay_double_traverses(&pattern, edges, 2);
	TEST_ASSERT_EQUAL_UINT64(FACTORY_PERIOD_EDGES + 288 + 576, edges[0]);
	TEST_ASSERT_EQUAL_UINT64(FACTORY_PERIOD_EDGES + 288 + 576, edges[1]);
}

static void test_the_longest_double_traverse_is_counted_whole(void)
{
	uint64_t edges[1];

	/* An edge moves 1/65536 microstep, the travel is as long as positions allow. */
	params.expert_mode = 1;
	params.raw_ka = 1;
	params.raw_nr = 1;
	params.raw_reversal_plus_usteps = 16000;
	params.raw_reversal_minus_usteps = -16000;
	params.flange_plus_um = 163000;
	params.flange_minus_um = -163000;
	params.travel_um = 326000;
	params.encoder_pulses_per_rev = 10000;
	params.encoder_edges_per_pulse = 4;
	params.encoder_ratio_numerator = 100;
	params.dwell_plus_millirev = 1200;
	params.dwell_minus_millirev = 1200;
	params.rope_diameter_um = 0;
	TEST_ASSERT_EQUAL_INT(0, lw_lay_prepare(&params, ROPE_UM, &pattern, &why));
	pattern.window.sweep_begin = -16349 * LW_USTEP;
	pattern.window.sweep_end = 16349 * LW_USTEP;
	lw_lay_double_traverses(&pattern, edges, 1);
	TEST_ASSERT_EQUAL_UINT64(2 * 32698 * (uint64_t)LW_USTEP + 2 * 4800000 + 4, edges[0]);
	TEST_ASSERT_TRUE(edges[0] > UINT32_MAX);
}

static void test_positions_are_those_of_the_law(void)
{
	double position_mm[5 * LW_LAY_ANGLES];
	struct lw_law law;

	params.encoder_ratio_denominator = 7; /* 411.43 edges a turn: angles lie between edges */
	params.pitch_um = 2000;
	TEST_ASSERT_EQUAL_INT(0, lw_lay_prepare(&params, ROPE_UM, &pattern, &why));
	law = lw_law_at(&pattern.window, pattern.m, pattern.u);
	lw_lay_positions(&pattern, position_mm, 5 * LW_LAY_ANGLES);
	for (int i = 0, edge = 0; i < 5 * LW_LAY_ANGLES; i++) {
		for (; edge < lrint(i * 2880.0 / 7 / LW_LAY_ANGLES); edge++) {
			lw_law_edge(&law, 1);
		}
		/* One microstep is 10 um. */
		TEST_ASSERT_DOUBLE_WITHIN(1e-9, lw_law_m(&law) / 65536.0 * 0.01, position_mm[i]);
	}
}

static void test_the_law_starts_in_the_middle_of_the_sweep(void)
{
	params.reversal_plus_um = 60000;
	params.switch_plus_um = 58000;
	TEST_ASSERT_EQUAL_INT(0, lw_lay_prepare(&params, ROPE_UM, &pattern, &why));
	TEST_ASSERT_EQUAL_INT32(-1000 * LW_USTEP, pattern.m); /* of 6000 and -8000 */
	TEST_ASSERT_EQUAL_INT32(pattern.window.ks, pattern.u);
}

static void test_a_set_that_the_core_refuses_is_not_laid(void)
{
	params.flange_plus_um = 80000;
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_lay_prepare(&params, ROPE_UM, &pattern, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_OVERSHOOT_BEYOND_FLANGE_PLUS, why.reason);
	params = lw_params_default;
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_lay_prepare(&params, 0, &pattern, &why));
	TEST_ASSERT_EQUAL_INT(-ERANGE,
			      lw_lay_prepare(&params, LW_LAY_ROPE_UM_MAX + 1, &pattern, &why));
}

static void test_a_launch_by_the_factory_set_as_the_design_has_it(void)
{
	struct lw_lay_evenness evenness;

	TEST_ASSERT_EQUAL_INT(0,
			      lw_native_lay((const int32_t *)&params, ROPE_UM, 271 * LW_LAY_ANGLES,
					    NULL, NULL, NULL, &evenness, &why));
	TEST_ASSERT_DOUBLE_WITHIN(0.1, 68.7, evenness.max_mm);
	TEST_ASSERT_DOUBLE_WITHIN(0.1, 58.2, evenness.mean_mm);
	TEST_ASSERT_DOUBLE_WITHIN(0.1, 5.1, evenness.std_mm);
	TEST_ASSERT_DOUBLE_WITHIN(0.1, 49.1, evenness.p5_mm);
	params.flange_plus_um = 80000;
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_native_lay((const int32_t *)&params, ROPE_UM, 1, NULL,
						     NULL, NULL, &evenness, &why));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_rope_on_the_bare_drum_is_round_and_lies_on_its_lowest_point);
	RUN_TEST(test_coil_on_coil_is_a_rope_higher);
	RUN_TEST(test_coils_side_by_side_lie_on_the_drum);
	RUN_TEST(test_rope_at_and_beyond_the_border_of_the_grid);
	RUN_TEST(test_a_path_goes_round_the_drum);
	RUN_TEST(test_a_drum_that_cannot_be_is_refused);
	RUN_TEST(test_evenness_is_that_of_the_judged_columns);
	RUN_TEST(test_evenness_of_a_flat_drum);
	RUN_TEST(test_the_factory_set_repeats_after_as_many_edges_as_the_law_says);
	RUN_TEST(test_a_dwell_makes_the_double_traverse_longer);
	RUN_TEST(test_the_longest_double_traverse_is_counted_whole);
	RUN_TEST(test_positions_are_those_of_the_law);
	RUN_TEST(test_the_law_starts_in_the_middle_of_the_sweep);
	RUN_TEST(test_a_set_that_the_core_refuses_is_not_laid);
	RUN_TEST(test_a_launch_by_the_factory_set_as_the_design_has_it);
	return UNITY_END();
}
