/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief The plant's drum and encoder: quadrature, profiles, encoder faults.
 */
#include <errno.h>
#include <stdlib.h>

#include "test_plant_rig.h"

#define TRANSITIONS_PER_DRUM_REV 5760

static struct rig rig;

void setUp(void)
{
	rig_init_default(&rig);
}

void tearDown(void)
{
}

static void assert_pins(bool a, bool b)
{
	TEST_ASSERT_TRUE(rig_run_to_change(&rig, LW_PLANT_ENCODER, S));
	TEST_ASSERT_EQUAL(a, rig.plant.pins.encoder_a);
	TEST_ASSERT_EQUAL(b, rig.plant.pins.encoder_b);
}

static void test_a_leads_b_when_hauling_in(void)
{
	TEST_ASSERT_FALSE(rig.plant.pins.encoder_a);
	TEST_ASSERT_FALSE(rig.plant.pins.encoder_b);
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 60000));
	assert_pins(true, false);
	assert_pins(true, true);
	assert_pins(false, true);
	assert_pins(false, false);
	TEST_ASSERT_EQUAL_INT64(4, rig_truth(&rig).drum_transitions);
}

static void test_b_leads_a_when_paying_out(void)
{
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, -60000));
	assert_pins(false, true);
	assert_pins(true, true);
	assert_pins(true, false);
	assert_pins(false, false);
	TEST_ASSERT_EQUAL_INT64(-4, rig_truth(&rig).drum_transitions);
}

static void test_index_once_per_encoder_revolution(void)
{
	const int64_t rev = TRANSITIONS_PER_DRUM_REV / 4;

	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 60000));
	for (int i = 0; i < 6; i++) {
		TEST_ASSERT_TRUE(rig_run_to_change(&rig, LW_PLANT_ENCODER_INDEX, S));
		TEST_ASSERT_TRUE(rig.plant.pins.encoder_index);
		TEST_ASSERT_EQUAL_INT64(rev / 2 + i * rev, rig_truth(&rig).drum_transitions);
		TEST_ASSERT_TRUE(rig_run_to_change(&rig, LW_PLANT_ENCODER_INDEX, S));
		TEST_ASSERT_FALSE(rig.plant.pins.encoder_index);
		TEST_ASSERT_EQUAL_INT64(rev / 2 + i * rev + 1, rig_truth(&rig).drum_transitions);
	}
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, -60000));
	for (int i = 5; i >= -5; i--) {
		TEST_ASSERT_TRUE(rig_run_to_change(&rig, LW_PLANT_ENCODER_INDEX, S));
		TEST_ASSERT_TRUE(rig.plant.pins.encoder_index);
		TEST_ASSERT_EQUAL_INT64(rev / 2 + i * rev, rig_truth(&rig).drum_transitions);
		TEST_ASSERT_TRUE(rig_run_to_change(&rig, LW_PLANT_ENCODER_INDEX, S));
		TEST_ASSERT_FALSE(rig.plant.pins.encoder_index);
	}
}

static void test_pins_tell_the_truth_through_drum_reversals(void)
{
	/* Rocking by less than a transition to many revolutions, about ever different positions. */
	for (int i = 0; i < 400; i++) {
		int32_t milli_rpm = (i % 2 == 0 ? 1 : -1) * (1 + i * i * 6);

		TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, milli_rpm));
		rig_run(&rig, (uint64_t)(i % 7 + 1) * 20 * MS);
		TEST_ASSERT_EQUAL_INT64(rig_truth(&rig).drum_transitions, rig.decoded);
	}
	TEST_ASSERT_EQUAL_UINT32(0, rig.illegal);
	TEST_ASSERT_GREATER_THAN_UINT32(10000, rig.encoder_events);
}

static void test_drum_returns_over_the_same_transitions(void)
{
	static const struct lw_plant_profile_point there_and_back[] = {
		{0, 0}, {100, 200000}, {200, 0}, {300, -200000}, {400, 0},
	};

	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_play(&rig.plant, there_and_back, 5));
	rig_run_until(&rig, 200 * MS);
	/* 200 rpm at the peak of a triangle of 0.2 s: a third of a revolution. */
	TEST_ASSERT_EQUAL_INT64(TRANSITIONS_PER_DRUM_REV / 3, rig.decoded);
	rig_run_until(&rig, 500 * MS);
	TEST_ASSERT_EQUAL_INT64(0, rig.decoded);
}

static void test_transitions_are_evenly_spaced_at_constant_speed(void)
{
	static const struct lw_plant_profile_point top_speed[] = {{0, 1000000}};
	uint64_t last_ns = 0;

	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_play(&rig.plant, top_speed, 1));
	for (int i = 0; i < 96000; i++) {
		TEST_ASSERT_TRUE(rig_run_to_change(&rig, LW_PLANT_ENCODER, MS));
		if (i > 0) {
			/* 1000 rpm is 96,000 transitions/s: 10,416.67 ns. */
			TEST_ASSERT_UINT64_WITHIN(1, 10417, rig.plant.now_ns - last_ns);
		}
		last_ns = rig.plant.now_ns;
	}
	TEST_ASSERT_UINT64_WITHIN(2, S - 10417 / 2, last_ns);
}

static void test_target_is_approached_at_the_configured_acceleration(void)
{
	/* 500 rpm/s by default: 250 rpm after half a second, 300 rpm for good after 0.6 s. */
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 300000));
	rig_run_until(&rig, 500 * MS - 1);
	TEST_ASSERT_DOUBLE_WITHIN(1.0, 250000.0, rig_truth(&rig).drum_milli_rpm);
	rig_run_until(&rig, 1600 * MS);
	TEST_ASSERT_DOUBLE_WITHIN(0.0, 300000.0, rig_truth(&rig).drum_milli_rpm);
	/* (0.3 s + 1 s) * 5 rev/s */
	TEST_ASSERT_INT64_WITHIN(1, TRANSITIONS_PER_DRUM_REV * 65 / 10, rig.decoded);
	TEST_ASSERT_EQUAL_INT(-ERANGE,
			      lw_plant_drum_target(&rig.plant, LW_PLANT_DRUM_MILLI_RPM_MAX + 1));
	rig_run(&rig, S);
	TEST_ASSERT_DOUBLE_WITHIN(0.0, 300000.0, rig_truth(&rig).drum_milli_rpm);
}

static void test_acceleration_can_be_changed(void)
{
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_acceleration(&rig.plant, 1000.0));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_drum_acceleration(&rig.plant, 0.0));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_drum_acceleration(&rig.plant, NAN));
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, -300000));
	rig_run_until(&rig, 250 * MS - 1);
	TEST_ASSERT_DOUBLE_WITHIN(1.0, -250000.0, rig_truth(&rig).drum_milli_rpm);
}

static void test_profile_plays_linearly_and_keeps_its_last_speed(void)
{
	static const struct lw_plant_profile_point launch[] = {
		{100, 60000}, {1100, 660000}, {1101, 120000}, {2101, 120000}, {3101, -120000},
	};

	rig_run_until(&rig, 50 * MS);
	uint64_t start_ns = rig.plant.substep_ns;

	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_play(&rig.plant, launch, 5));
	TEST_ASSERT_TRUE(lw_plant_drum_playing(&rig.plant));
	rig_run_until(&rig, start_ns + 100 * MS);
	/* The first point's speed holds from the start: 0.1 s at 1 rev/s. */
	TEST_ASSERT_INT64_WITHIN(1, 576, rig.decoded);
	rig_run_until(&rig, start_ns + 1100 * MS);
	/* Then 1 s at 6 rev/s on average. */
	TEST_ASSERT_INT64_WITHIN(1, 576 + 6 * TRANSITIONS_PER_DRUM_REV, rig.decoded);
	rig_run_until(&rig, start_ns + 1101 * MS - 1);
	TEST_ASSERT_DOUBLE_WITHIN(1.0, 120000.0, rig_truth(&rig).drum_milli_rpm);
	TEST_ASSERT_TRUE(lw_plant_drum_playing(&rig.plant));
	rig_run_until(&rig, start_ns + 3102 * MS);
	TEST_ASSERT_FALSE(lw_plant_drum_playing(&rig.plant));

	int64_t ended = rig.decoded;

	rig_run(&rig, S);
	TEST_ASSERT_DOUBLE_WITHIN(0.0, -120000.0, rig_truth(&rig).drum_milli_rpm);
	TEST_ASSERT_INT64_WITHIN(1, ended - 2 * TRANSITIONS_PER_DRUM_REV, rig.decoded);
	TEST_ASSERT_EQUAL_INT64(rig_truth(&rig).drum_transitions, rig.decoded);
}

static void test_bad_profiles_are_refused_and_change_nothing(void)
{
	static const struct lw_plant_profile_point backwards[] = {{0, 0}, {5, 10}, {5, 20}};
	static const struct lw_plant_profile_point fast[] = {{0, -LW_PLANT_DRUM_MILLI_RPM_MAX - 1}};

	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_drum_play(&rig.plant, backwards, 3));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_drum_play(&rig.plant, backwards, 0));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_drum_play(&rig.plant, backwards,
							  LW_PLANT_PROFILE_POINTS_MAX + 1));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_drum_play(&rig.plant, fast, 1));
	TEST_ASSERT_FALSE(lw_plant_drum_playing(&rig.plant));
}

static void test_lost_pulses_are_missing_and_leave_a_legal_code(void)
{
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 100000));
	rig_run(&rig, 333 * MS);
	TEST_ASSERT_EQUAL_INT(0,
			      lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_LOSE_PULSES, 7));
	rig_run(&rig, S);
	TEST_ASSERT_EQUAL_INT64(rig_truth(&rig).drum_transitions - 4 * 7, rig.decoded);
	/* Hidden, not merely cancelled out by steps back. */
	TEST_ASSERT_EQUAL_INT64(rig.encoder_events, rig.decoded);
	TEST_ASSERT_EQUAL_UINT32(0, rig.illegal);
}

static void test_pulses_lost_in_a_drum_reversal_leave_a_legal_code(void)
{
	/* Sweep the reversal over every phase of the lost pulses. */
	for (int i = 0; i < 40; i++) {
		rig_init_default(&rig);
		TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 20000));
		rig_run(&rig, (200 + (uint64_t)i) * MS);
		TEST_ASSERT_EQUAL_INT(
			0, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_LOSE_PULSES, 20));
		TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, -20000));
		rig_run(&rig, S);
		TEST_ASSERT_EQUAL_UINT32(0, rig.illegal);

		int64_t error = rig.decoded - rig_truth(&rig).drum_transitions;

		TEST_ASSERT_EQUAL_INT64(0, error % 4);
		TEST_ASSERT_TRUE(error != 0);
	}
}

static void test_illegal_fault_changes_both_channels_at_once(void)
{
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 100000));
	rig_run(&rig, 100 * MS);
	TEST_ASSERT_EQUAL_INT(0, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_ILLEGAL, 5));
	rig_run(&rig, S);
	TEST_ASSERT_EQUAL_UINT32(5, rig.illegal);
	TEST_ASSERT_EQUAL_INT64(rig_truth(&rig).drum_transitions - 2 * 5, rig.decoded);
}

static void test_dither_rocks_forth_and_back(void)
{
	TEST_ASSERT_EQUAL_INT(0, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_DITHER, 100));
	for (uint32_t i = 1; i <= 200; i++) {
		TEST_ASSERT_TRUE(rig_run_to_change(&rig, LW_PLANT_ENCODER, MS));
		TEST_ASSERT_EQUAL_INT64(i % 2, rig.decoded);
		TEST_ASSERT_EQUAL_UINT64((i - 1) * 20000ull, rig.plant.now_ns);
	}
	TEST_ASSERT_FALSE(rig_run_to_change(&rig, LW_PLANT_ENCODER, S));
	TEST_ASSERT_EQUAL_INT64(0, rig_truth(&rig).drum_transitions);
}

static void test_dither_of_a_turning_drum_stays_legal_and_nets_to_zero(void)
{
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, -200000));
	rig_run(&rig, S);

	uint32_t events = rig.encoder_events;
	int64_t transitions = rig.decoded;

	TEST_ASSERT_EQUAL_INT(0, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_DITHER, 1000));
	/* A second one while the first has rocked forth must not leave it there. */
	TEST_ASSERT_TRUE(rig_run_to_change(&rig, LW_PLANT_ENCODER, MS));
	TEST_ASSERT_EQUAL_INT(0, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_DITHER, 1000));
	rig_run(&rig, S);
	TEST_ASSERT_EQUAL_UINT32(0, rig.illegal);
	TEST_ASSERT_EQUAL_INT64(rig_truth(&rig).drum_transitions, rig.decoded);
	TEST_ASSERT_EQUAL_INT64(2 * 1000 + 2 + llabs(rig.decoded - transitions),
				rig.encoder_events - events);
}

static void test_extra_pulses_are_legal_and_stay(void)
{
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, -200000));
	rig_run(&rig, S);
	TEST_ASSERT_EQUAL_INT(0,
			      lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_EXTRA_PULSES, 7));
	TEST_ASSERT_EQUAL_INT(0, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_DITHER, 10));
	rig_run(&rig, S);
	TEST_ASSERT_EQUAL_UINT32(0, rig.illegal);
	TEST_ASSERT_EQUAL_INT64(rig_truth(&rig).drum_transitions + 4 * 7, rig.decoded);
}

static void test_counts_out_of_range_are_refused(void)
{
	TEST_ASSERT_EQUAL_INT(-ERANGE,
			      lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_EXTRA_PULSES, -1));
	TEST_ASSERT_EQUAL_INT(
		-ERANGE,
		lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_EXTRA_PULSES, 100000001));
	TEST_ASSERT_EQUAL_INT(-ERANGE,
			      lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_LOSE_PULSES, -1));
	TEST_ASSERT_EQUAL_INT(-ERANGE,
			      lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_ILLEGAL, -1));
	TEST_ASSERT_EQUAL_INT(-ERANGE,
			      lw_plant_inject(&rig.plant, LW_PLANT_FAULT_ENCODER_DITHER, -1));
}

/** Execute the next event. @return whether an index pulse begins with it */
static bool index_begins(struct lw_plant *plant)
{
	return (lw_plant_advance(plant) & LW_PLANT_ENCODER_INDEX) != 0 && plant->pins.encoder_index;
}

/** Execute all events up to a time, runs of transitions as runs. @return index pulses begun */
static int run_in_runs(struct lw_plant *plant, uint64_t until_ns, uint32_t *transitions)
{
	int indices = 0;

	while (lw_plant_next_event_ns(plant) <= until_ns) {
		if (!lw_plant_next_is_run(plant, until_ns)) {
			indices += index_begins(plant);
			continue;
		}

		/* Whole, or only the beginning of one. */
		const struct lw_plant_run run =
			lw_plant_run_begin(plant, until_ns, *transitions % 3 == 0 ? 2 : UINT32_MAX);

		indices += run.index_begins;
		*transitions += run.count;
		lw_plant_run_end(plant, &run);
	}
	return indices;
}

/* A run is what its events are, one by one: the same plant to the last bit, whatever happens. */
static void test_a_run_is_its_transitions_one_by_one(void)
{
	static const struct {
		int32_t drum_milli_rpm;
		enum lw_plant_fault fault;
		int32_t argument;
	} parts[] = {
		{2500000, LW_PLANT_FAULT_COUNT, 0},
		{-1000000, LW_PLANT_FAULT_ENCODER_DITHER, 3},
		{-1000000, LW_PLANT_FAULT_ENCODER_EXTRA_PULSES, 1},
		{300000, LW_PLANT_FAULT_ENCODER_LOSE_PULSES, 5},
		{300000, LW_PLANT_FAULT_ENCODER_A, LW_PLANT_CHANNEL_FLICKER},
		{500000, LW_PLANT_FAULT_ENCODER_A, LW_PLANT_CHANNEL_OK},
		{500000, LW_PLANT_FAULT_ENCODER_INDEX, 0},
		{500000, LW_PLANT_FAULT_PLACE_CARRIAGE, 80000},
		{900000, LW_PLANT_FAULT_PLACE_CARRIAGE, -80000},
		{0, LW_PLANT_FAULT_ENCODER_INDEX, 1},
	};
	struct lw_plant_config config;
	static struct lw_plant in_runs;

	lw_plant_config_default(&config);
	config.drum_acceleration_rpm_per_s = 50000;
	for (uint32_t pulses = 1; pulses <= 360; pulses += 359) {
		uint32_t transitions = 0;
		uint64_t until_ns = 0;
		int indices = 0;

		config.encoder_pulses_per_rev = pulses;
		config.encoder_revs_per_drum_rev_num = 1440 / pulses;
		rig_init(&rig, &config);
		in_runs = rig.plant;
		for (size_t i = 0; i < sizeof(parts) / sizeof(parts[0]); i++) {
			struct lw_plant *const plants[] = {&rig.plant, &in_runs};

			for (size_t j = 0; j < 2; j++) {
				TEST_ASSERT_EQUAL_INT(
					0,
					lw_plant_drum_target(plants[j], parts[i].drum_milli_rpm));
				TEST_ASSERT_EQUAL_INT(
					parts[i].fault == LW_PLANT_FAULT_COUNT ? -EINVAL : 0,
					lw_plant_inject(plants[j], parts[i].fault,
							parts[i].argument));
			}
			/* Also in the midst of a substep. */
			for (int j = 0; j < 9000; j++) {
				until_ns += 33333;
				while (lw_plant_next_event_ns(&rig.plant) <= until_ns) {
					indices += index_begins(&rig.plant);
				}
				indices -= run_in_runs(&in_runs, until_ns, &transitions);
				TEST_ASSERT_EQUAL_MEMORY(&rig.plant, &in_runs, sizeof(in_runs));
			}
		}
		TEST_ASSERT_GREATER_THAN_UINT32(20000, transitions);
		TEST_ASSERT_EQUAL_INT(0, indices);
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_a_leads_b_when_hauling_in);
	RUN_TEST(test_b_leads_a_when_paying_out);
	RUN_TEST(test_index_once_per_encoder_revolution);
	RUN_TEST(test_pins_tell_the_truth_through_drum_reversals);
	RUN_TEST(test_drum_returns_over_the_same_transitions);
	RUN_TEST(test_transitions_are_evenly_spaced_at_constant_speed);
	RUN_TEST(test_target_is_approached_at_the_configured_acceleration);
	RUN_TEST(test_acceleration_can_be_changed);
	RUN_TEST(test_profile_plays_linearly_and_keeps_its_last_speed);
	RUN_TEST(test_bad_profiles_are_refused_and_change_nothing);
	RUN_TEST(test_lost_pulses_are_missing_and_leave_a_legal_code);
	RUN_TEST(test_pulses_lost_in_a_drum_reversal_leave_a_legal_code);
	RUN_TEST(test_illegal_fault_changes_both_channels_at_once);
	RUN_TEST(test_dither_rocks_forth_and_back);
	RUN_TEST(test_dither_of_a_turning_drum_stays_legal_and_nets_to_zero);
	RUN_TEST(test_extra_pulses_are_legal_and_stay);
	RUN_TEST(test_counts_out_of_range_are_refused);
	RUN_TEST(test_a_run_is_its_transitions_one_by_one);
	return UNITY_END();
}
