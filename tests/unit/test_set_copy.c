/* SPDX-License-Identifier: Apache-2.0 */
/* The second copy of the active parameters: which bit ever flips, the set is right again. */
#include <string.h>

#include <unity.h>

#include "device_rig.h"

static struct lw_params params;
static struct lw_derived derived;
static struct lw_set_copy copy;

void setUp(void)
{
	struct lw_refusal refusal;

	memset(&copy, 0, sizeof(copy));
	params = lw_params_default;
	TEST_ASSERT_EQUAL_INT(0, lw_params_derive(&params, &derived, &refusal));
	lw_set_copy_keep(&copy, &params, &derived);
}

void tearDown(void)
{
}

static void flip(void *bytes, size_t bit)
{
	((uint8_t *)bytes)[bit / 8] ^= (uint8_t)(1u << bit % 8);
}

static void test_equal_copies_cost_nothing(void)
{
	TEST_ASSERT_FALSE(lw_set_copy_check(&copy, &params, &derived));
	TEST_ASSERT_EQUAL_UINT16(0, copy.corrections);
}

static void test_any_bit_of_the_set_is_set_right(void)
{
	const struct lw_params params_before = params;
	const struct lw_derived derived_before = derived;

	for (size_t bit = 0; bit < 8 * sizeof(params); bit++) {
		flip(&params, bit);
		TEST_ASSERT_TRUE(lw_set_copy_check(&copy, &params, &derived));
		TEST_ASSERT_EQUAL_MEMORY(&params_before, &params, sizeof(params));
	}
	for (size_t bit = 0; bit < 8 * sizeof(derived); bit++) {
		flip(&derived, bit);
		TEST_ASSERT_TRUE(lw_set_copy_check(&copy, &params, &derived));
		TEST_ASSERT_EQUAL_MEMORY(&derived_before, &derived, sizeof(derived));
	}
	TEST_ASSERT_EQUAL_UINT16(8 * (sizeof(params) + sizeof(derived)), copy.corrections);
}

static void test_any_bit_of_the_copy_is_set_right(void)
{
	const struct lw_set_copy copy_before = copy;
	const struct lw_params params_before = params;

	for (size_t bit = 0; bit < 8 * (sizeof(copy.params) + sizeof(copy.derived)); bit++) {
		flip(&copy, bit);
		TEST_ASSERT_TRUE(lw_set_copy_check(&copy, &params, &derived));
		copy.corrections = 0;
		TEST_ASSERT_EQUAL_MEMORY(&copy_before, &copy, sizeof(copy));
	}
	TEST_ASSERT_EQUAL_MEMORY(&params_before, &params, sizeof(params));
}

static void test_after_a_flip_of_the_crc_the_copy_decides_and_is_believed_again(void)
{
	const struct lw_params before = params;

	flip(&copy.crc, 7);
	flip(&params, 33);
	TEST_ASSERT_TRUE(lw_set_copy_check(&copy, &params, &derived));
	TEST_ASSERT_EQUAL_MEMORY(&before, &params, sizeof(params));
	flip(&copy.params, 12);
	TEST_ASSERT_TRUE(lw_set_copy_check(&copy, &params, &derived));
	TEST_ASSERT_EQUAL_MEMORY(&before, &params, sizeof(params));
}

static void test_the_count_stays_at_its_end(void)
{
	copy.corrections = UINT16_MAX;
	flip(&params, 0);
	TEST_ASSERT_TRUE(lw_set_copy_check(&copy, &params, &derived));
	TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, copy.corrections);
}

/** Within 8 ms, logged and counted; a bit that does not keep still does not fill the log. */
static void test_a_device_mends_its_set_and_tells(void)
{
	rig_prepare(0);
	power_up(NULL, 0);

	const int32_t right_um = rig.device.active.reversal_plus_um;
	const uint32_t events = rig.store.log.newest;

	rig.device.active.reversal_plus_um ^= 1 << 14;
	rig_ticks(LW_SET_COPY_TICKS);
	TEST_ASSERT_EQUAL_INT32(right_um, rig.device.active.reversal_plus_um);
	TEST_ASSERT_EQUAL_INT32(1, read_register(LW_SPACE_INPUT, LW_ADDRESS_MEMORY_CORRECTIONS));
	TEST_ASSERT_EQUAL_UINT32(events + 1, rig.store.log.newest);
	for (int i = 0; i < 100; i++) {
		rig.device.active.reversal_plus_um ^= 1 << 14;
		rig_ticks(LW_SET_COPY_TICKS);
	}
	TEST_ASSERT_EQUAL_INT32(101, read_register(LW_SPACE_INPUT, LW_ADDRESS_MEMORY_CORRECTIONS));
	TEST_ASSERT_EQUAL_UINT32(events + 10, rig.store.log.newest);
}

/** APPLY is no flip. */
static void test_a_set_that_comes_into_force_is_kept(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
	rig.device.staged.los_recoveries_max = 7;
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_COMMAND, LW_COMMAND_APPLY));
	rig_ticks(LW_SET_COPY_TICKS);
	TEST_ASSERT_EQUAL_INT32(7, rig.device.active.los_recoveries_max);
	TEST_ASSERT_EQUAL_INT32(0, read_register(LW_SPACE_INPUT, LW_ADDRESS_MEMORY_CORRECTIONS));
}

/** At rest in a sweep, following the drum. */
static void follow(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
	rig.device.staged.dwell_plus_millirev = 100;
	rig.device.staged.dwell_minus_millirev = 50;
	rig.device.staged.breaker_millirev = 30;
	rig.device.staged.breaker_cycles = 4;
	command(LW_COMMAND_APPLY);
	track();
	rig_follow_to(0, 1, 20000);
	rig.drum_edges_per_s = 0;
	rig_ticks(300);
	TEST_ASSERT_TRUE(lw_motion_in_sweep(&rig.controller->motion));
}

static void assert_mended(uint16_t corrections)
{
	rig_ticks(LW_SET_COPY_TICKS);
	TEST_ASSERT_EQUAL_UINT16(corrections, rig.device.set_copy.corrections);
	TEST_ASSERT_TRUE(flag(LW_FLAG_LOS));
	TEST_ASSERT_FALSE(flag(LW_FLAG_LAUNCH_PERMIT));
	TEST_ASSERT_EQUAL_UINT8(LW_STATE_TRACKING, rig.controller->state);
	rig.controller->los = (struct lw_los){0};
}

/** Any bit of what the law works with, but for its place: 64 of them were told by nobody. */
static void test_any_bit_of_the_law_in_force_is_set_right_and_told(void)
{
	struct lw_law *law;
	struct lw_law before;
	uint16_t corrections = 0;

	follow();
	law = &rig.controller->motion.law;
	before = *law;
	void *const members[] = {&law->u,
				 &law->open_span,
				 &law->ka,
				 &law->below_from,
				 &law->span,
				 &law->dwells,
				 &law->dwell_plus_edges,
				 &law->dwell_minus_edges,
				 &law->breaker_edges,
				 &law->breaker_cycles};

	for (size_t i = 0; i < sizeof(members) / sizeof(members[0]); i++) {
		for (size_t bit = 0; bit < 32; bit++) {
			flip(members[i], bit);
			assert_mended(++corrections);
			/* The sign of the slope is not known twice: it is one of the two. */
			law->u = members[i] == &law->u && bit == 31 ? before.u : law->u;
			TEST_ASSERT_EQUAL_MEMORY(&before, law, sizeof(before));
		}
	}
}

static void test_any_bit_of_the_window_in_force_is_set_right_and_told(void)
{
	struct lw_law_window before;
	uint16_t corrections = 0;

	follow();
	before = *rig.controller->motion.window;
	for (size_t bit = 0; bit < 8 * sizeof(before); bit++) {
		flip((void *)(uintptr_t)rig.controller->motion.window, bit);
		assert_mended(++corrections);
		TEST_ASSERT_EQUAL_MEMORY(&before, rig.controller->motion.window, sizeof(before));
	}
}

static void test_pointers_that_have_changed_are_set_right(void)
{
	static const struct lw_law_window elsewhere;
	struct lw_controller *controller;

	follow();
	controller = rig.controller;
	controller->motion.window = &elsewhere;
	assert_mended(1);
	TEST_ASSERT_TRUE(controller->motion.window == &controller->windows[0] ||
			 controller->motion.window == &controller->windows[1]);
	controller->params = &params;
	rig_ticks(LW_SET_COPY_TICKS);
	TEST_ASSERT_EQUAL_PTR(&rig.device.active, controller->params);
	controller->derived = &derived;
	rig_ticks(LW_SET_COPY_TICKS);
	TEST_ASSERT_EQUAL_PTR(&rig.device.derived, controller->derived);
	TEST_ASSERT_EQUAL_UINT16(3, rig.device.set_copy.corrections);
}

/** Both ways, with dwells, a breaker and trims: a sound law is never taken for another. */
static void test_a_sound_law_is_left_alone(void)
{
	static const int32_t speeds[] = {40000, -33000, 700, 25000, -900};

	follow();
	for (size_t i = 0; i < 25; i++) {
		rig.drum_edges_per_s = speeds[i % 5];
		TEST_ASSERT_EQUAL_INT(0,
				      write_pair(LW_ADDRESS_TRIM_PLUS_UM, -100 * (int32_t)(i % 3)));
		rig_ticks(1500);
	}
	TEST_ASSERT_EQUAL_UINT16(0, rig.device.set_copy.corrections);
	TEST_ASSERT_EQUAL_UINT8(LW_STATE_TRACKING, rig.controller->state);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_equal_copies_cost_nothing);
	RUN_TEST(test_any_bit_of_the_set_is_set_right);
	RUN_TEST(test_any_bit_of_the_copy_is_set_right);
	RUN_TEST(test_after_a_flip_of_the_crc_the_copy_decides_and_is_believed_again);
	RUN_TEST(test_the_count_stays_at_its_end);
	RUN_TEST(test_a_device_mends_its_set_and_tells);
	RUN_TEST(test_a_set_that_comes_into_force_is_kept);
	RUN_TEST(test_any_bit_of_the_law_in_force_is_set_right_and_told);
	RUN_TEST(test_any_bit_of_the_window_in_force_is_set_right_and_told);
	RUN_TEST(test_pointers_that_have_changed_are_set_right);
	RUN_TEST(test_a_sound_law_is_left_alone);
	return UNITY_END();
}
