/* SPDX-License-Identifier: Apache-2.0 */
/* From millimetres to the law, and the check of a whole parameter set. */
#include <errno.h>
#include <string.h>

#include <unity.h>

#include "cases.h"
#include "law_check.h"
#include "lw/control/params.h"

static struct lw_params params;
static struct lw_derived derived;
static struct lw_refusal why;

void setUp(void)
{
	params = lw_params_default;
	params.flange_plus_um = 82500; /* close to the overshoot, to come to its rule easily */
	params.flange_minus_um = -82500;
	memset(&derived, 0x55, sizeof(derived));
	memset(&why, 0xAA, sizeof(why));
}

void tearDown(void)
{
	cases_end();
}

static void assert_accepted(void)
{
	TEST_ASSERT_EQUAL_INT_MESSAGE(0, lw_params_derive(&params, &derived, &why),
				      "refused a good set");
}

static void assert_refused(enum lw_reason reason, unsigned int address, int32_t value,
			   int32_t limit)
{
	const struct lw_derived before = derived;

	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_derive(&params, &derived, &why));
	TEST_ASSERT_EQUAL_UINT16(reason, why.reason);
	TEST_ASSERT_EQUAL_UINT16(address, why.address);
	TEST_ASSERT_EQUAL_INT32(value, why.value);
	TEST_ASSERT_EQUAL_INT32(limit, why.limit);
	TEST_ASSERT_EQUAL_MEMORY(&before, &derived, sizeof(derived));
}

/** Take the reported limit, moved by `inside`: the set is accepted; beyond it is not. */
static void assert_limit_is_the_border(int32_t *param, int32_t inside, int32_t outward)
{
	*param = why.limit + inside;
	assert_accepted();
	*param += outward;
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_derive(&params, &derived, &why));
}

static void test_defaults_give_the_example_set(void)
{
	assert_accepted();
	TEST_ASSERT_EQUAL_INT32(23, derived.ka);
	TEST_ASSERT_EQUAL_INT32(1187, derived.nr);
	TEST_ASSERT_EQUAL_INT32(27301, derived.ks);
	TEST_ASSERT_EQUAL_INT32(8000, derived.reversal_plus_usteps);
	TEST_ASSERT_EQUAL_INT32(-8000, derived.reversal_minus_usteps);
	TEST_ASSERT_EQUAL_INT32(27301 * 593, derived.overshoot_q16);
	TEST_ASSERT_EQUAL_INT32(2470, derived.overshoot_um);
	TEST_ASSERT_EQUAL_INT32(2470 - 2500, derived.overshoot_error_um);
	TEST_ASSERT_EQUAL_INT32(-208, derived.slope_error_ppm); /* 27301 / 27306.67 - 1 */
	TEST_ASSERT_EQUAL_UINT32(2880000, derived.edges_per_1000_drum_revs);
	TEST_ASSERT_EQUAL_INT32(7840, derived.switch_usteps[LW_PLUS]);
	TEST_ASSERT_EQUAL_INT32(-7840, derived.switch_usteps[LW_MINUS]);
	TEST_ASSERT_EQUAL_INT32(100, derived.switch_tolerance_usteps);
	TEST_ASSERT_EQUAL_INT32(150, derived.switch_hysteresis_usteps);
	TEST_ASSERT_EQUAL_INT32(100, derived.span_tolerance_usteps);
	TEST_ASSERT_EQUAL_INT32(18000, derived.travel_usteps);
	TEST_ASSERT_EQUAL_INT32(0, derived.park_usteps);
	TEST_ASSERT_EQUAL_INT32(0, derived.centre_usteps);
}

static void test_dwell_is_in_drum_revolutions(void)
{
	params.dwell_plus_millirev = 250;
	params.dwell_minus_millirev = 1;
	params.encoder_ratio_denominator = 3;
	params.pitch_um = 4000;
	assert_accepted();
	TEST_ASSERT_EQUAL_UINT32(960000, derived.edges_per_1000_drum_revs);
	TEST_ASSERT_EQUAL_UINT32(240, derived.dwell_plus_edges);
	TEST_ASSERT_EQUAL_UINT32(1, derived.dwell_minus_edges);

	const struct lw_law_window window = lw_params_window(&params, &derived, 0, 0);

	TEST_ASSERT_EQUAL_UINT32(240, window.dwell_plus_edges);
	TEST_ASSERT_EQUAL_UINT32(1, window.dwell_minus_edges);
}

static void test_the_breaker_is_in_drum_revolutions_and_off_without_either_number(void)
{
	params.breaker_millirev = 200;
	assert_accepted();
	TEST_ASSERT_EQUAL_UINT32(0, derived.breaker_edges);
	TEST_ASSERT_EQUAL_UINT32(0, derived.breaker_cycles);
	params.breaker_cycles = 8;
	assert_accepted();
	TEST_ASSERT_EQUAL_UINT32(576, derived.breaker_edges); /* 2880 * 0.2 */
	TEST_ASSERT_EQUAL_UINT32(8, derived.breaker_cycles);
	params.breaker_millirev = 0;
	assert_accepted();
	TEST_ASSERT_EQUAL_UINT32(0, derived.breaker_edges);
	TEST_ASSERT_EQUAL_UINT32(0, derived.breaker_cycles);
}

static void test_the_drum_is_as_wide_as_from_far_point_to_far_point(void)
{
	assert_accepted();
	/* 16,000 microsteps and twice 27301 * 593 / 65536, 10 um each. */
	TEST_ASSERT_EQUAL_INT32(164941, lw_params_far_points_um(&params, &derived));
}

static void test_conversions_round_to_nearest(void)
{
	params.screw_lead_um = 5000;
	params.microsteps_per_rev = 1000; /* 5 um per microstep */
	TEST_ASSERT_EQUAL_INT32(2, lw_params_um_to_usteps(&params, 12));
	TEST_ASSERT_EQUAL_INT32(3, lw_params_um_to_usteps(&params, 13));
	TEST_ASSERT_EQUAL_INT32(-2, lw_params_um_to_usteps(&params, -12));
	TEST_ASSERT_EQUAL_INT32(-3, lw_params_um_to_usteps(&params, -13));
	TEST_ASSERT_EQUAL_INT32(3, lw_params_q16_to_um(&params, LW_USTEP / 2));
	TEST_ASSERT_EQUAL_INT32(-3, lw_params_q16_to_um(&params, -LW_USTEP / 2));
	TEST_ASSERT_EQUAL_INT32(-5, lw_params_q16_to_um(&params, -LW_USTEP));
}

static void test_expert_mode_takes_the_raw_values(void)
{
	params.expert_mode = 1;
	params.raw_ka = 100;
	params.raw_nr = 300;
	params.raw_reversal_plus_usteps = 7900;
	params.raw_reversal_minus_usteps = -8010;
	params.pitch_um = 10; /* not looked at */
	params.overshoot_um = 50000;
	assert_accepted();
	TEST_ASSERT_EQUAL_INT32(100, derived.ka);
	TEST_ASSERT_EQUAL_INT32(300, derived.nr);
	TEST_ASSERT_EQUAL_INT32(30000, derived.ks);
	TEST_ASSERT_EQUAL_INT32(7900, derived.reversal_plus_usteps);
	TEST_ASSERT_EQUAL_INT32(-8010, derived.reversal_minus_usteps);
	TEST_ASSERT_EQUAL_INT32(0, derived.slope_error_ppm);
	TEST_ASSERT_EQUAL_INT32(0, derived.overshoot_error_um);

	const struct lw_law_window window = lw_params_window(&params, &derived, 500, -300);

	TEST_ASSERT_EQUAL_INT32(7950 * LW_USTEP, window.sweep_end);
	TEST_ASSERT_EQUAL_INT32((-8040 + 1) * LW_USTEP, window.sweep_begin);
}

static void test_reason_slope_above_one_step(void)
{
	params.pitch_um = 30000;
	assert_refused(LW_REASON_SLOPE_ABOVE_ONE_STEP, LW_ADDRESS_PITCH_UM, 30000, 28799);
	params.overshoot_um = 100;
	assert_limit_is_the_border((int32_t *)&params.pitch_um, 0, 2);
	params.pitch_um = 28805;
	assert_refused(LW_REASON_SLOPE_ABOVE_ONE_STEP, LW_ADDRESS_PITCH_UM, 28805, 28799);

	/* Steeper than any number that the derivation works with. */
	params.pitch_um = 100000;
	params.encoder_pulses_per_rev = 1;
	params.encoder_edges_per_pulse = 1;
	params.encoder_ratio_numerator = 1;
	params.microsteps_per_rev = 51200;
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_derive(&params, &derived, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_SLOPE_ABOVE_ONE_STEP, why.reason);

	setUp();
	params.expert_mode = 1;
	params.raw_nr = 2850;
	assert_refused(LW_REASON_SLOPE_ABOVE_ONE_STEP, LW_ADDRESS_RAW_NR, 2850, 2849);
}

static void test_reason_slope_too_small(void)
{
	params.pitch_um = 10;
	params.encoder_pulses_per_rev = 10000;
	params.encoder_edges_per_pulse = 4;
	params.encoder_ratio_numerator = 100;
	params.screw_lead_um = 100000;
	params.microsteps_per_rev = 200;
	assert_refused(LW_REASON_SLOPE_TOO_SMALL, LW_ADDRESS_PITCH_UM, 10, 15259);
	params.pitch_um = 15259;
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_derive(&params, &derived, &why));
	TEST_ASSERT_NOT_EQUAL(LW_REASON_SLOPE_TOO_SMALL, why.reason);
	params.pitch_um = 15258;
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_derive(&params, &derived, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_SLOPE_TOO_SMALL, why.reason);

	/* At 10 um it is a half less the least that these registers can make. */
	params.pitch_um = 10;
	params.encoder_pulses_per_rev = 1579;
	params.encoder_edges_per_pulse = 1;
	params.encoder_ratio_numerator = 37;
	params.screw_lead_um = 4487;
	assert_refused(LW_REASON_SLOPE_TOO_SMALL, LW_ADDRESS_PITCH_UM, 10, 11);
}

static void test_reason_slope_unreachable(void)
{
	/* An ideal slope of 10.5: 10 or 11, both 5 % off. */
	params.encoder_pulses_per_rev = 10000;
	params.encoder_edges_per_pulse = 4;
	params.encoder_ratio_numerator = 65;
	params.screw_lead_um = 65536;
	params.microsteps_per_rev = 2000;
	params.pitch_um = 13650;
	params.slope_tolerance_ppm = 30000;
	assert_refused(LW_REASON_SLOPE_UNREACHABLE, LW_ADDRESS_SLOPE_TOLERANCE_PPM, 30000,
		       1000000 / 22 + 1 + 1);
	/* 10.5 to 11 is half a unit of 10.5. */
	params.slope_tolerance_ppm = 47619;
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_derive(&params, &derived, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_SLOPE_UNREACHABLE, why.reason);
	params.slope_tolerance_ppm = 47620;
	TEST_ASSERT_TRUE(lw_params_derive(&params, &derived, &why) == 0 ||
			 why.reason != LW_REASON_SLOPE_UNREACHABLE);

	/* What would do is told rounded to nearest, and one more. */
	params.slope_tolerance_ppm = 100;
	params.pitch_um = 83837; /* 64.49 */
	assert_refused(LW_REASON_SLOPE_UNREACHABLE, LW_ADDRESS_SLOPE_TOLERANCE_PPM, 100, 7813 + 1);
	params.pitch_um = 1820; /* 1.4 */
	assert_refused(LW_REASON_SLOPE_UNREACHABLE, LW_ADDRESS_SLOPE_TOLERANCE_PPM, 100,
		       500000 + 1);
}

static void test_reason_reversals_crossed(void)
{
	params.reversal_minus_um = 79990;
	assert_refused(LW_REASON_REVERSALS_CROSSED, LW_ADDRESS_REVERSAL_MINUS_UM, 79990, 79980);
	params.reversal_minus_um = 79980; /* two microsteps, in good order, but no room */
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_derive(&params, &derived, &why));
	TEST_ASSERT_NOT_EQUAL(LW_REASON_REVERSALS_CROSSED, why.reason);
	params.expert_mode = 1;
	params.raw_reversal_minus_usteps = 8001;
	assert_refused(LW_REASON_REVERSALS_CROSSED, LW_ADDRESS_RAW_REVERSAL_MINUS_USTEPS, 8001,
		       7998);
}

static void test_reason_switch_outside(void)
{
	/* "Inside" is less than the limit, by a microstep. */
	params.switch_plus_um = 80000;
	assert_refused(LW_REASON_SWITCH_PLUS_OUTSIDE, LW_ADDRESS_SWITCH_PLUS_UM, 80000, 80000);
	assert_limit_is_the_border(&params.switch_plus_um, -10, 10);

	setUp();
	params.switch_minus_um = -80000;
	assert_refused(LW_REASON_SWITCH_MINUS_OUTSIDE, LW_ADDRESS_SWITCH_MINUS_UM, -80000, -80000);
	assert_limit_is_the_border(&params.switch_minus_um, 10, -10);
}

static void test_reason_switches_crossed(void)
{
	params.overshoot_um = 10;
	params.slope_tolerance_ppm = 50000;
	params.switch_minus_um = 74000;
	params.centre_position_um = 73000;
	assert_refused(LW_REASON_SWITCHES_CROSSED, LW_ADDRESS_SWITCH_MINUS_UM, 74000, 73390);
	params.switch_minus_um = 73400; /* as far apart as both may be off together */
	assert_refused(LW_REASON_SWITCHES_CROSSED, LW_ADDRESS_SWITCH_MINUS_UM, 73400, 73390);
	/* The limit of this rule; the ramps need room as well. */
	params.switch_minus_um = 73390;
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_derive(&params, &derived, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_RAMP_DOES_NOT_FIT, why.reason);
	/* Where not even the steepest fits, that is the limit. */
	params.expert_mode = 1;
	params.raw_reversal_minus_usteps = 7000;
	assert_refused(LW_REASON_RAMP_DOES_NOT_FIT, LW_ADDRESS_RAW_NR, params.raw_nr, 1);
}

static void test_reason_overshoot_beyond_flange(void)
{
	params.flange_plus_um = 82000;
	assert_refused(LW_REASON_OVERSHOOT_BEYOND_FLANGE_PLUS, LW_ADDRESS_FLANGE_PLUS_UM, 82000,
		       82490);
	assert_limit_is_the_border(&params.flange_plus_um, 0, -10);

	setUp();
	params.flange_minus_um = -82000;
	assert_refused(LW_REASON_OVERSHOOT_BEYOND_FLANGE_MINUS, LW_ADDRESS_FLANGE_MINUS_UM, -82000,
		       -82490);
	assert_limit_is_the_border(&params.flange_minus_um, 0, 10);
}

static void test_a_limit_in_micrometres_holds_where_these_are_coarse(void)
{
	/* 10.24 microsteps per micrometre: a limit in microsteps lies between two micrometres. */
	params.screw_lead_um = 5000;
	params.microsteps_per_rev = 51200;
	params.pitch_um = 200;
	params.reversal_plus_um = 1000;
	params.reversal_minus_um = -1000;
	params.switch_plus_um = 900;
	params.switch_minus_um = -900;
	params.switch_tolerance_um = 10;
	params.switch_hysteresis_um = 10;
	params.flange_minus_um = -1050;
	params.travel_um = 2200;
	for (uint32_t um = 1; um <= 30; um++) {
		params.overshoot_um = um;
		params.flange_plus_um = 1000;
		TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_derive(&params, &derived, &why));
		TEST_ASSERT_EQUAL_UINT16(LW_REASON_OVERSHOOT_BEYOND_FLANGE_PLUS, why.reason);
		assert_limit_is_the_border(&params.flange_plus_um, 0, -1);
	}
}

static void test_reason_park_outside(void)
{
	params.park_at = LW_PARK_AT_POSITION;
	params.park_position_um = 78000;
	assert_refused(LW_REASON_PARK_OUTSIDE, LW_ADDRESS_PARK_POSITION_UM, 78000, 75910);
	assert_limit_is_the_border(&params.park_position_um, 0, 10);
	params.park_position_um = -78000;
	assert_refused(LW_REASON_PARK_OUTSIDE, LW_ADDRESS_PARK_POSITION_UM, -78000, -75910);
	assert_limit_is_the_border(&params.park_position_um, 0, -10);
	params.park_at = LW_PARK_AT_FLANGE;
	assert_accepted();
}

static void test_reason_centre_outside(void)
{
	params.centre_position_um = 78400;
	assert_refused(LW_REASON_CENTRE_OUTSIDE, LW_ADDRESS_CENTRE_POSITION_UM, 78400, 78400);
	assert_limit_is_the_border(&params.centre_position_um, -10, 10);
	params.centre_position_um = -90000;
	assert_refused(LW_REASON_CENTRE_OUTSIDE, LW_ADDRESS_CENTRE_POSITION_UM, -90000, -78400);
	assert_limit_is_the_border(&params.centre_position_um, 10, -10);
	params.centre_position_um = -78400;
	assert_refused(LW_REASON_CENTRE_OUTSIDE, LW_ADDRESS_CENTRE_POSITION_UM, -78400, -78400);
}

static void test_reason_ramp_does_not_fit(void)
{
	params.reversal_minus_um = 70000;
	params.switch_minus_um = 72000;
	params.centre_position_um = 75000;
	params.overshoot_um = 1000;
	/* 640 microsteps between the switches, 500 of them clearance. */
	assert_refused(LW_REASON_RAMP_DOES_NOT_FIT, LW_ADDRESS_OVERSHOOT_UM, 1000, 680);
	params.overshoot_um = 680;
	params.slope_tolerance_ppm = 5000;
	assert_accepted();

	params.expert_mode = 1;
	params.raw_reversal_minus_usteps = 7000;
	assert_refused(LW_REASON_RAMP_DOES_NOT_FIT, LW_ADDRESS_RAW_NR, 1187, 627);
	assert_limit_is_the_border(&params.raw_nr, 0, 1);
}

static void test_reason_position_overflow(void)
{
	/* 10 um per microstep: 327 mm. */
	params.flange_plus_um = 327001;
	assert_refused(LW_REASON_POSITION_OVERFLOW, LW_ADDRESS_FLANGE_PLUS_UM, 327001, 327000);
	params.flange_plus_um = 327000;
	assert_refused(LW_REASON_TRAVEL_TOO_SHORT, LW_ADDRESS_TRAVEL_UM, 180000, 327000 + 82500);
	setUp();
	params.flange_minus_um = -327000;
	assert_refused(LW_REASON_TRAVEL_TOO_SHORT, LW_ADDRESS_TRAVEL_UM, 180000, 327000 + 82500);
	setUp();
	params.park_position_um = -400000;
	assert_refused(LW_REASON_POSITION_OVERFLOW, LW_ADDRESS_PARK_POSITION_UM, -400000, -327000);

	setUp();
	params.reversal_plus_um = 325000;
	assert_refused(LW_REASON_POSITION_OVERFLOW, LW_ADDRESS_REVERSAL_PLUS_UM, 325000, 324510);
	params.reversal_plus_um = 324510;
	assert_refused(LW_REASON_OVERSHOOT_BEYOND_FLANGE_PLUS, LW_ADDRESS_FLANGE_PLUS_UM, 82500,
		       327000);
	params.reversal_plus_um = 325000;
	params.expert_mode = 1;
	params.raw_reversal_plus_usteps = 32000;
	params.raw_nr = 2800;
	assert_refused(LW_REASON_POSITION_OVERFLOW, LW_ADDRESS_RAW_REVERSAL_PLUS_USTEPS, 32000,
		       31323);
	setUp();
	params.reversal_minus_um = -325000;
	assert_refused(LW_REASON_POSITION_OVERFLOW, LW_ADDRESS_REVERSAL_MINUS_UM, -325000, -324510);
	params.reversal_minus_um = -324510;
	assert_refused(LW_REASON_OVERSHOOT_BEYOND_FLANGE_MINUS, LW_ADDRESS_FLANGE_MINUS_UM, -82500,
		       -327000);
	params.reversal_minus_um = -325000;
	params.expert_mode = 1;
	params.raw_reversal_minus_usteps = -32000;
	params.raw_nr = 2800;
	assert_refused(LW_REASON_POSITION_OVERFLOW, LW_ADDRESS_RAW_REVERSAL_MINUS_USTEPS, -32000,
		       -31323);

	setUp();
	params.travel_um = 326000;
	assert_refused(LW_REASON_POSITION_OVERFLOW, LW_ADDRESS_TRAVEL_UM, 326000, 322020);
	assert_limit_is_the_border((int32_t *)&params.travel_um, 0, 10);
}

static void test_reason_travel_too_short(void)
{
	params.travel_um = 164999;
	assert_refused(LW_REASON_TRAVEL_TOO_SHORT, LW_ADDRESS_TRAVEL_UM, 164999, 165000);
	assert_limit_is_the_border((int32_t *)&params.travel_um, 0, -1);
}

static void test_reason_overspeed_limits_crossed(void)
{
	params.overspeed_warning_edges_per_s = 60001;
	assert_refused(LW_REASON_OVERSPEED_LIMITS_CROSSED, LW_ADDRESS_OVERSPEED_WARNING_EDGES_PER_S,
		       60001, 60000);
	assert_limit_is_the_border((int32_t *)&params.overspeed_warning_edges_per_s, 0, 1);
}

static void test_reason_tolerance_beyond_flange(void)
{
	params.switch_tolerance_um = 5000;
	assert_refused(LW_REASON_TOLERANCE_BEYOND_FLANGE, LW_ADDRESS_SWITCH_TOLERANCE_UM, 5000,
		       4100);
	assert_limit_is_the_border(&params.switch_tolerance_um, 0, 1);
	params.flange_plus_um = 90000;
	params.travel_um = 180000;
	assert_refused(LW_REASON_TOLERANCE_BEYOND_FLANGE, LW_ADDRESS_SWITCH_TOLERANCE_UM, 4101,
		       4100);
	assert_limit_is_the_border(&params.switch_tolerance_um, 0, 1);
}

static void test_reason_breaker_one_cycle(void)
{
	params.breaker_cycles = 1;
	assert_refused(LW_REASON_BREAKER_ONE_CYCLE, LW_ADDRESS_BREAKER_CYCLES, 1, 2);
	assert_limit_is_the_border(&params.breaker_cycles, 0, -1);
}

static void test_reason_packing_too_small(void)
{
	params.rope_packing_permille = 99;
	assert_refused(LW_REASON_PACKING_TOO_SMALL, LW_ADDRESS_ROPE_PACKING_PERMILLE, 99, 100);
	assert_limit_is_the_border(&params.rope_packing_permille, 0, -1);
}

static void test_reason_core_thinner_than_rope(void)
{
	params.rope_diameter_um = 5000;
	params.drum_core_diameter_um = 4999;
	assert_refused(LW_REASON_CORE_THINNER_THAN_ROPE, LW_ADDRESS_DRUM_CORE_DIAMETER_UM, 4999,
		       5000);
	assert_limit_is_the_border((int32_t *)&params.drum_core_diameter_um, 0, -1);
}

static void test_reason_drum_narrower_than_rope(void)
{
	params.overshoot_um = 1;
	params.slope_tolerance_ppm = 5000;
	params.switch_hysteresis_um = 100;
	params.switch_tolerance_um = 100;
	params.switch_minus_um = 70000;
	params.reversal_minus_um = 69000;
	params.centre_position_um = 75000;
	params.rope_diameter_um = 11010;
	assert_refused(LW_REASON_DRUM_NARROWER_THAN_ROPE, LW_ADDRESS_ROPE_DIAMETER_UM, 11010,
		       11000);
	assert_limit_is_the_border(&params.rope_diameter_um, 0, 1);
}

static void test_reason_too_few_edges(void)
{
	params.encoder_pulses_per_rev = 1;
	params.encoder_edges_per_pulse = 1;
	params.encoder_ratio_denominator = 5;
	assert_refused(LW_REASON_TOO_FEW_EDGES, LW_ADDRESS_ENCODER_RATIO_DENOMINATOR, 5, 4);
	params.encoder_ratio_denominator = 4;
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_derive(&params, &derived, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_SLOPE_ABOVE_ONE_STEP, why.reason);
}

static void test_reason_debounce_too_long(void)
{
	params.switch_contacts = LW_SWITCH_CONTACTS_SINGLE_NC;
	params.switch_debounce_ms = 100;
	/* 160 microsteps at 52,000 edges/s * 0.4166: 7.4 ms. */
	assert_refused(LW_REASON_DEBOUNCE_TOO_LONG, LW_ADDRESS_SWITCH_DEBOUNCE_MS, 100, 7);
	assert_limit_is_the_border(&params.switch_debounce_ms, 0, 1);

	/* The side with less room counts, whichever it is: 80 microsteps. */
	params.switch_debounce_ms = 100;
	params.switch_minus_um = -79200;
	assert_refused(LW_REASON_DEBOUNCE_TOO_LONG, LW_ADDRESS_SWITCH_DEBOUNCE_MS, 100, 3);
	params.switch_minus_um = -78400;
	params.switch_plus_um = 79200;
	assert_refused(LW_REASON_DEBOUNCE_TOO_LONG, LW_ADDRESS_SWITCH_DEBOUNCE_MS, 100, 3);
	params.switch_plus_um = 78400;

	/* A faster index rate counts too: 38.4 ms at 10,000 edges/s. */
	params.overspeed_warning_edges_per_s = 5000;
	assert_refused(LW_REASON_DEBOUNCE_TOO_LONG, LW_ADDRESS_SWITCH_DEBOUNCE_MS, 100, 38);

	params.switch_contacts = LW_SWITCH_CONTACTS_NO_NC_PAIR;
	assert_accepted();
}

static void test_reason_switch_delay_too_long(void)
{
	/* 160 microsteps at 52,000 edges/s * 0.4166: 7.386 ms, however it is wired. */
	for (int contacts = 0; contacts < 3; contacts++) {
		params.switch_contacts = contacts;
		params.switch_debounce_ms = 1;
		params.switch_delay_us = 20000;
		assert_refused(LW_REASON_SWITCH_DELAY_TOO_LONG, LW_ADDRESS_SWITCH_DELAY_US, 20000,
			       7386);
		params.switch_delay_us = 7386;
		if (contacts == LW_SWITCH_CONTACTS_NO_NC_PAIR) {
			assert_accepted();
		}
	}
	/* A single contact is debounced on top of it. */
	params.switch_delay_us = 3000;
	params.switch_debounce_ms = 5;
	assert_refused(LW_REASON_DEBOUNCE_TOO_LONG, LW_ADDRESS_SWITCH_DEBOUNCE_MS, 5, 4);
	params.switch_debounce_ms = 4;
	assert_accepted();

	/* To the microsecond: 7 ms and 386 us fit, one more does not. */
	params.switch_debounce_ms = 7;
	params.switch_delay_us = 386;
	assert_accepted();
	params.switch_delay_us = 387;
	assert_refused(LW_REASON_DEBOUNCE_TOO_LONG, LW_ADDRESS_SWITCH_DEBOUNCE_MS, 7, 6);
	params.switch_delay_us = 390;
	assert_refused(LW_REASON_DEBOUNCE_TOO_LONG, LW_ADDRESS_SWITCH_DEBOUNCE_MS, 7, 6);
	params.switch_delay_us = 0;
	params.switch_debounce_ms = 8;
	assert_refused(LW_REASON_DEBOUNCE_TOO_LONG, LW_ADDRESS_SWITCH_DEBOUNCE_MS, 8, 7);
	params.switch_delay_us = 386;
	assert_refused(LW_REASON_DEBOUNCE_TOO_LONG, LW_ADDRESS_SWITCH_DEBOUNCE_MS, 8, 7);
}

static void test_trim_is_checked_by_the_same_rules(void)
{
	assert_accepted();
	TEST_ASSERT_EQUAL_INT(0, lw_params_check_trim(&params, &derived, 0, 0, &why));
	TEST_ASSERT_EQUAL_INT(0, lw_params_check_trim(&params, &derived, -1500, 1500, &why));
	TEST_ASSERT_EQUAL_INT(0, lw_params_check_trim(&params, &derived, 10, -10, &why));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_check_trim(&params, &derived, 30, 0, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_OVERSHOOT_BEYOND_FLANGE_PLUS, why.reason);
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_check_trim(&params, &derived, 0, -30, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_OVERSHOOT_BEYOND_FLANGE_MINUS, why.reason);
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_check_trim(&params, &derived, -1600, 0, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_SWITCH_PLUS_OUTSIDE, why.reason);
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_params_check_trim(&params, &derived, 0, 1600, &why));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_SWITCH_MINUS_OUTSIDE, why.reason);
	TEST_ASSERT_EQUAL_INT(-EINVAL,
			      lw_params_check_trim(&params, &derived, -20000, 20000, &why));
}

static void test_configurations_of_the_layers_below(void)
{
	params.encoder_edges_per_pulse = 4;
	params.encoder_invert_b = 1;
	params.drum_direction_invert = 1;

	const struct lw_quadrature_config quadrature = lw_params_quadrature(&params);

	TEST_ASSERT_EQUAL_UINT8(4, quadrature.edges_per_pulse);
	TEST_ASSERT_FALSE(quadrature.invert_a);
	TEST_ASSERT_TRUE(quadrature.invert_b);
	TEST_ASSERT_TRUE(quadrature.invert_direction);

	const struct lw_limit_switch_config limit = lw_params_limit_switch(&params);

	TEST_ASSERT_EQUAL_INT(LW_SWITCH_CONTACTS_NO_NC_PAIR, limit.contacts);
	TEST_ASSERT_EQUAL_UINT32(20000, limit.transit_us);
	TEST_ASSERT_EQUAL_UINT32(5000, limit.debounce_us);
}

static void test_need_index_by_the_flag_of_each_register(void)
{
	const struct lw_params before = params;

	TEST_ASSERT_FALSE(lw_params_need_index(&before, &params));
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		int32_t *value = (int32_t *)(void *)((char *)&params + lw_map_params[i].offset);

		*value += 1;
		TEST_ASSERT_EQUAL((lw_map_params[i].flags & LW_POINT_REINDEX) != 0,
				  lw_params_need_index(&before, &params));
		*value -= 1;
	}
}

static int32_t random_value(const struct lw_point *point, int32_t value, uint64_t *seed)
{
	const uint32_t random = next_random(seed);
	const uint32_t range = (uint32_t)point->max - (uint32_t)point->min + 1;

	if (point->allowed != NULL) {
		return point->allowed[random % point->allowed_count];
	}
	switch (next_random(seed) % 8) {
	case 0:
		return point->min;
	case 1:
		return point->max;
	case 2:
		return (int32_t)((uint32_t)point->min + random % range);
	default:
		/* Near the good set, or nothing would ever be accepted. */
		value += (int32_t)(random % 41) - 20 + value / 100 * (int32_t)(random % 7 - 3) / 3;
		return value < point->min ? point->min : value > point->max ? point->max : value;
	}
}

/** What the proof of the law takes for granted: accepted() in tests/proofs/orbit.h. */
static void check_proof_applies(const struct lw_law_window *window)
{
	const int64_t run = (int64_t)derived.ka * derived.nr * (derived.nr - 1);

	TEST_ASSERT_TRUE(1 <= derived.ka && 1 <= derived.nr);
	TEST_ASSERT_EQUAL_INT32(derived.ka, window->ka);
	TEST_ASSERT_EQUAL_INT32(derived.ka * derived.nr, window->ks);
	TEST_ASSERT_TRUE(window->ks <= 65535);
	TEST_ASSERT_EQUAL_INT32(0, window->sweep_begin % LW_USTEP);
	TEST_ASSERT_TRUE(window->sweep_end - window->sweep_begin >= LW_USTEP);
	TEST_ASSERT_TRUE(2 * (int64_t)window->sweep_end + run <= 2 * 32699LL * LW_USTEP);
	TEST_ASSERT_TRUE(2 * (int64_t)window->sweep_begin - run >= -2 * 32699LL * LW_USTEP);
	TEST_ASSERT_TRUE(window->dwell_plus_edges <= LW_LAW_DWELL_EDGES_MAX);
	TEST_ASSERT_TRUE(window->dwell_minus_edges <= LW_LAW_DWELL_EDGES_MAX);
	TEST_ASSERT_TRUE(window->breaker_edges <= LW_LAW_BREAKER_EDGES_MAX);
	TEST_ASSERT_TRUE(window->breaker_cycles <= LW_LAW_BREAKER_CYCLES_MAX);
	TEST_ASSERT_NOT_EQUAL(1, window->breaker_cycles);
	TEST_ASSERT_TRUE((window->breaker_edges > 0) == (window->breaker_cycles > 0));
}

/** A trim that is accepted leads to such a window, too. */
static void check_trimmed(uint64_t *seed)
{
	const int32_t trim_plus_um = (int32_t)(next_random(seed) % 4001) - 2000;
	const int32_t trim_minus_um = (int32_t)(next_random(seed) % 4001) - 2000;

	if (lw_params_check_trim(&params, &derived, trim_plus_um, trim_minus_um, &why) == 0) {
		const struct lw_law_window window =
			lw_params_window(&params, &derived, trim_plus_um, trim_minus_um);

		check_proof_applies(&window);
	}
}

/** What every accepted set must keep. */
static void check_accepted(uint64_t *seed)
{
	const struct lw_law_window window = lw_params_window(&params, &derived, 0, 0);
	struct lw_law law;

	check_proof_applies(&window);
	check_trimmed(seed);
	TEST_ASSERT_EQUAL_INT32(derived.ks, window.ks);
	TEST_ASSERT_EQUAL_INT64((int64_t)derived.ks * (derived.nr - 1) / 2, derived.overshoot_q16);

	const int64_t reach_um =
		lw_params_q16_to_um(&params, derived.overshoot_q16 + window.sweep_end) - 1;

	TEST_ASSERT_TRUE(reach_um <= params.flange_plus_um);
	TEST_ASSERT_TRUE(lw_params_q16_to_um(&params, window.sweep_begin - LW_USTEP -
							      derived.overshoot_q16) +
				 1 >=
			 params.flange_minus_um);
	if (!params.expert_mode) {
		TEST_ASSERT_TRUE(derived.slope_error_ppm <= params.slope_tolerance_ppm);
		TEST_ASSERT_TRUE(derived.slope_error_ppm >= -params.slope_tolerance_ppm);
	}

	/* P8: the sanitizers watch both reversals. */
	FOR_BOTH_WAYS(side) {
		law = lw_law_at(&window, side > 0 ? window.sweep_end - 1 : window.sweep_begin,
				side * derived.ks);
		for (int i = 0; i < 50; i++) {
			lw_law_edge(&law, next_random(seed) % 5 ? 1 : -1);
			TEST_ASSERT_TRUE(law_on_orbit(&law, &window));
		}
		law = lw_law_at(&window,
				side > 0 ? window.sweep_end + derived.overshoot_q16 + derived.ks - 1
					 : window.sweep_begin - derived.overshoot_q16 - derived.ks,
				0);
		TEST_ASSERT_TRUE(law_on_orbit(&law, &window));
		lw_law_edge(&law, 1);
	}
}

static void test_random_sets_within_the_limits_of_their_registers(void)
{
	uint64_t seed = 42;
	int accepted = 0;
	bool met[LW_REASON_CAM_ADVANCES + 1] = {false};
	int reasons = 0;

	for (int round = 0; round < 100000; round++) {
		params = lw_params_default;
		for (uint32_t changes = next_random(&seed) % 12; changes > 0; changes--) {
			const struct lw_point *point =
				&lw_map_params[next_random(&seed) % LW_MAP_PARAMS_COUNT];
			int32_t *at = (int32_t *)(void *)((char *)&params + point->offset);

			*at = random_value(point, *at, &seed);
		}
		if (lw_params_derive(&params, &derived, &why) == 0) {
			accepted++;
			check_accepted(&seed);
			continue;
		}
		TEST_ASSERT_TRUE(why.reason >= LW_REASON_SLOPE_ABOVE_ONE_STEP);
		reasons += !met[why.reason];
		met[why.reason] = true;

		/* The register is one of the block, and it is its value. */
		bool found = false;

		for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
			if (lw_map_params[i].address == why.address) {
				int32_t value;

				memcpy(&value, (char *)&params + lw_map_params[i].offset, 4);
				TEST_ASSERT_EQUAL_INT32(value, why.value);
				found = true;
			}
		}
		TEST_ASSERT_TRUE(found);
	}
	TEST_ASSERT_TRUE_MESSAGE(accepted > 10000, "the random sets are not worth much");
	TEST_ASSERT_TRUE_MESSAGE(reasons >= 12, "too few reasons met");
}

/** Sets whose overshoot comes as close to the end of all positions as is accepted. */
static void test_the_proof_applies_to_the_outermost_sets(void)
{
	uint64_t seed = 2020;
	int accepted = 0;

	for (int round = 0; round < 20000; round++) {
		const int side = round % 2 ? 1 : -1;
		const int32_t nr = 1450 + (int32_t)(next_random(&seed) % 800);
		const int32_t ka = 65535 / nr - (int32_t)(next_random(&seed) % 2);
		const int32_t overshoot = (int32_t)((int64_t)ka * nr * (nr - 1) / 2 / LW_USTEP);
		/* A few are refused: they reach up to 3 microsteps too far. */
		const int32_t outer = 32700 - overshoot - 2 + 3 - (int32_t)(next_random(&seed) % 6);
		const int32_t inner = outer - 8000;

		setUp();
		params.expert_mode = 1;
		params.raw_ka = ka;
		params.raw_nr = nr;
		params.raw_reversal_plus_usteps = side > 0 ? outer : -inner;
		params.raw_reversal_minus_usteps = side > 0 ? inner : -outer;
		params.flange_plus_um = side > 0 ? 327000 : -200000;
		params.flange_minus_um = side > 0 ? 200000 : -327000;
		params.switch_plus_um = 10 * (params.raw_reversal_plus_usteps - 300);
		params.switch_minus_um = 10 * (params.raw_reversal_minus_usteps + 300);
		params.centre_position_um = side * 10 * (inner + 4000);
		params.park_position_um = params.centre_position_um;
		if (lw_params_derive(&params, &derived, &why) == 0) {
			const struct lw_law_window window =
				lw_params_window(&params, &derived, 0, 0);

			check_proof_applies(&window);
			accepted++;
		} else {
			TEST_ASSERT_EQUAL_UINT16(LW_REASON_POSITION_OVERFLOW, why.reason);
		}
	}
	TEST_ASSERT_TRUE(accepted > 5000 && accepted < 15000);
}

static void test_wholly_random_sets_do_not_overflow(void)
{
	uint64_t seed = 4711;

	for (int round = 0; round < 20000; round++) {
		for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
			const struct lw_point *point = &lw_map_params[i];
			int32_t *at = (int32_t *)(void *)((char *)&params + point->offset);
			const uint32_t range = (uint32_t)point->max - (uint32_t)point->min + 1;
			const uint32_t random = next_random(&seed);

			*at = point->allowed != NULL ? point->allowed[random % point->allowed_count]
			      : random % 4 == 0      ? point->min
			      : random % 4 == 1      ? point->max
						     : (int32_t)((uint32_t)point->min +
                                                            next_random(&seed) % range);
		}
		/* Mostly refused; the sanitizers watch the arithmetic. */
		if (lw_params_derive(&params, &derived, &why) == 0) {
			check_accepted(&seed);
			(void)lw_params_check_trim(&params, &derived, 20000, -20000, &why);
			(void)lw_params_check_trim(&params, &derived, -20000, 20000, &why);
		}
	}
}

static void test_raw_slopes_up_to_the_last_below_one_step(void)
{
	params.expert_mode = 1;
	params.raw_ka = 2;
	params.raw_nr = 32768;
	assert_refused(LW_REASON_SLOPE_ABOVE_ONE_STEP, LW_ADDRESS_RAW_NR, 32768, 32767);
	params.raw_ka = 5;
	params.raw_nr = 13108;
	assert_refused(LW_REASON_SLOPE_ABOVE_ONE_STEP, LW_ADDRESS_RAW_NR, 13108, 13107);
}

static void test_a_gear_of_two_to_two_is_none(void)
{
	struct lw_derived ungeared;

	assert_accepted();
	ungeared = derived;
	params.encoder_ratio_numerator *= 2;
	params.encoder_ratio_denominator *= 2;
	assert_accepted();
	TEST_ASSERT_EQUAL_MEMORY(&ungeared, &derived, sizeof(derived));
}

static void test_the_smallest_pitch_is_told_exactly(void)
{
	for (int32_t gear = 1; gear <= 2; gear++) {
		setUp();
		params.pitch_um = 10;
		params.encoder_pulses_per_rev = 8192;
		params.encoder_edges_per_pulse = 4;
		params.encoder_ratio_numerator = 100 * gear;
		params.encoder_ratio_denominator = gear;
		params.screw_lead_um = 100000;
		params.microsteps_per_rev = 200;
		/* 100000 * 3276800 / (2 * 65536 * 200) */
		assert_refused(LW_REASON_SLOPE_TOO_SMALL, LW_ADDRESS_PITCH_UM, 10, 12500);
	}
}

/* Of the defaults, as set_crc() of the laptop tool works it out (tests/python/test_points.py). */
#define CRC_OF_DEFAULTS 860867484u

static void test_the_crc_names_what_moves_the_carriage(void)
{
	params = lw_params_default;
	TEST_ASSERT_EQUAL_UINT32(CRC_OF_DEFAULTS, lw_params_crc(&params));
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		const struct lw_point *point = &lw_map_params[i];
		const bool counts = point->address != LW_ADDRESS_ACCEPTED_CRC &&
				    !(point->flags & (LW_POINT_SCOPE_LINE | LW_POINT_SECRET));
		uint32_t crc;

		params = lw_params_default;
		*(int32_t *)((char *)&params + point->offset) += 1;
		crc = lw_params_crc(&params);
		TEST_ASSERT_TRUE(crc >= 1 && crc <= LW_PARAMS_CRC_MAX);
		TEST_ASSERT_TRUE((crc != CRC_OF_DEFAULTS) == counts);
	}
}

static void test_rope_is_described_by_all_that_it_takes_or_not_at_all(void)
{
	struct lw_rope_geometry geometry;

	params.rope_diameter_um = 5000;
	params.drum_core_diameter_um = 300000;
	params.rope_packing_permille = 1;
	TEST_ASSERT_EQUAL_INT(0, lw_params_derive(&lw_params_default, &derived, &why));
	geometry = lw_params_rope(&params, &derived);
	TEST_ASSERT_TRUE(geometry.core_um_q16 > 0 && geometry.growth_um_q16 > 0);
	params.drum_core_diameter_um = 0;
	geometry = lw_params_rope(&params, &derived);
	TEST_ASSERT_TRUE(geometry.core_um_q16 == 0 && geometry.growth_um_q16 == 0);
}

static void test_the_steepest_slope_is_less_than_a_step(void)
{
	/* 65535.09 of 65536: in two edges it would be a whole step. */
	params.encoder_pulses_per_rev *= 10;
	params.pitch_um = 287996;
	params.overshoot_um = 5;
	assert_accepted();
	TEST_ASSERT_EQUAL_INT32(65535, derived.ks);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_defaults_give_the_example_set);
	RUN_TEST(test_dwell_is_in_drum_revolutions);
	RUN_TEST(test_the_breaker_is_in_drum_revolutions_and_off_without_either_number);
	RUN_TEST(test_the_drum_is_as_wide_as_from_far_point_to_far_point);
	RUN_TEST(test_conversions_round_to_nearest);
	RUN_TEST(test_expert_mode_takes_the_raw_values);
	RUN_TEST(test_reason_slope_above_one_step);
	RUN_TEST(test_reason_slope_too_small);
	RUN_TEST(test_reason_slope_unreachable);
	RUN_TEST(test_reason_reversals_crossed);
	RUN_TEST(test_reason_switch_outside);
	RUN_TEST(test_reason_switches_crossed);
	RUN_TEST(test_reason_overshoot_beyond_flange);
	RUN_TEST(test_a_limit_in_micrometres_holds_where_these_are_coarse);
	RUN_TEST(test_reason_park_outside);
	RUN_TEST(test_reason_centre_outside);
	RUN_TEST(test_reason_ramp_does_not_fit);
	RUN_TEST(test_reason_position_overflow);
	RUN_TEST(test_reason_travel_too_short);
	RUN_TEST(test_reason_overspeed_limits_crossed);
	RUN_TEST(test_reason_tolerance_beyond_flange);
	RUN_TEST(test_reason_breaker_one_cycle);
	RUN_TEST(test_reason_packing_too_small);
	RUN_TEST(test_reason_core_thinner_than_rope);
	RUN_TEST(test_reason_drum_narrower_than_rope);
	RUN_TEST(test_reason_too_few_edges);
	RUN_TEST(test_reason_debounce_too_long);
	RUN_TEST(test_reason_switch_delay_too_long);
	RUN_TEST(test_trim_is_checked_by_the_same_rules);
	RUN_TEST(test_configurations_of_the_layers_below);
	RUN_TEST(test_need_index_by_the_flag_of_each_register);
	RUN_TEST(test_random_sets_within_the_limits_of_their_registers);
	RUN_TEST(test_the_proof_applies_to_the_outermost_sets);
	RUN_TEST(test_wholly_random_sets_do_not_overflow);
	RUN_TEST(test_raw_slopes_up_to_the_last_below_one_step);
	RUN_TEST(test_a_gear_of_two_to_two_is_none);
	RUN_TEST(test_the_smallest_pitch_is_told_exactly);
	RUN_TEST(test_the_crc_names_what_moves_the_carriage);
	RUN_TEST(test_rope_is_described_by_all_that_it_takes_or_not_at_all);
	RUN_TEST(test_the_steepest_slope_is_less_than_a_step);
	return UNITY_END();
}
