/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief The plant's switches: trigger points, contacts and their bounce, switch faults,
 * determinism.
 */
#include <errno.h>
#include <string.h>

#include "test_plant_rig.h"

#define GENTLY_MM_PER_S2      4000.0
#define LIMIT_UM              78400.0
#define HYSTERESIS_UM         800.0
#define SHIFT_UM_PER_MM_PER_S 0.5

static struct rig rig;
static struct rig_motion motion;

void setUp(void)
{
	rig_init_default(&rig);
	motion = (struct rig_motion){0};
}

void tearDown(void)
{
}

/** Start over with the carriage at rest, in step, at a position. */
static void start_at(int32_t position_um)
{
	struct lw_plant_config config;

	lw_plant_config_default(&config);
	config.start_um = position_um;
	rig_init(&rig, &config);
	motion = (struct rig_motion){0};
}

static void inject(enum lw_plant_fault fault, int32_t argument)
{
	TEST_ASSERT_EQUAL_INT(0, lw_plant_inject(&rig.plant, fault, argument));
	rig_run(&rig, 0);
}

static void assert_limit(enum lw_plant_side side, bool no_closed, bool nc_closed)
{
	TEST_ASSERT_EQUAL(no_closed, rig.plant.pins.limit[side].no_closed);
	TEST_ASSERT_EQUAL(nc_closed, rig.plant.pins.limit[side].nc_closed);
}

/** Move until a limit switch's pole leaves its contact. @return real position there, outward */
static double position_at_change(enum lw_plant_side side, double speed_mm_per_s)
{
	int outward = side == LW_PLANT_PLUS ? 1 : -1;
	uint32_t mask = (uint32_t)LW_PLANT_LIMIT_PLUS << side;

	uint64_t begin_ns = rig.plant.now_ns;

	for (uint64_t t = 0; t < 10 * S; t += RIG_TICK_NS) {
		while (lw_plant_next_event_ns(&rig.plant) <= begin_ns + t) {
			if (rig_advance(&rig) & mask) {
				return outward * rig_truth(&rig).carriage_um;
			}
		}

		double next = motion.position_usteps +
			      outward * speed_mm_per_s * 100.0 * 1e-9 * RIG_TICK_NS;
		int64_t step = (int64_t)floor(next) - motion.stepped_usteps;

		motion.position_usteps = next;
		motion.stepped_usteps += step;
		if (step != 0) {
			lw_plant_step(&rig.plant, step > 0 ? 1 : -1);
		}
	}
	TEST_FAIL_MESSAGE("the switch never changed");
	return 0.0;
}

static void test_contacts_open_travel_close_and_bounce(void)
{
	start_at(78390);
	assert_limit(LW_PLANT_PLUS, false, true);
	position_at_change(LW_PLANT_PLUS, 5.0);

	/* Both open for the transit time, then NO bounces and NC stays open. */
	uint64_t opened_ns = rig.plant.now_ns;
	uint32_t closures = 0;
	uint64_t last_ns = 0;

	assert_limit(LW_PLANT_PLUS, false, false);
	while (rig_run_to_change(&rig, LW_PLANT_LIMIT_PLUS, 100 * MS)) {
		last_ns = rig.plant.now_ns;
		closures += rig.plant.pins.limit[LW_PLANT_PLUS].no_closed;
		if (closures == 1 && rig.plant.pins.limit[LW_PLANT_PLUS].no_closed) {
			TEST_ASSERT_EQUAL_UINT64(opened_ns + MS, last_ns);
		}
		TEST_ASSERT_FALSE(rig.plant.pins.limit[LW_PLANT_PLUS].nc_closed);
	}
	assert_limit(LW_PLANT_PLUS, true, false);
	TEST_ASSERT_GREATER_THAN_UINT32(5, closures);
	TEST_ASSERT_GREATER_THAN_UINT64(opened_ns + 3 * MS, last_ns);
	TEST_ASSERT_LESS_OR_EQUAL_UINT64(opened_ns + 4 * MS, last_ns);
	/* NC opened once; NO closed once more than it opened. */
	TEST_ASSERT_EQUAL_UINT32(1 + 2 * closures - 1, rig.limit_plus_events);
}

static void test_contacts_bounce_on_nc_on_the_way_back(void)
{
	start_at(-77610);
	position_at_change(LW_PLANT_MINUS, 5.0);
	rig_run(&rig, 10 * MS);
	assert_limit(LW_PLANT_MINUS, true, false);
	position_at_change(LW_PLANT_MINUS, -5.0);
	assert_limit(LW_PLANT_MINUS, false, false);

	uint32_t closures = 0;

	while (rig_run_to_change(&rig, LW_PLANT_LIMIT_MINUS, 100 * MS)) {
		closures += rig.plant.pins.limit[LW_PLANT_MINUS].nc_closed;
		TEST_ASSERT_FALSE(rig.plant.pins.limit[LW_PLANT_MINUS].no_closed);
	}
	assert_limit(LW_PLANT_MINUS, false, true);
	TEST_ASSERT_GREATER_THAN_UINT32(5, closures);
}

static void test_without_bounce_each_contact_changes_once(void)
{
	start_at(78390);
	inject(LW_PLANT_FAULT_BOUNCE, 0);
	position_at_change(LW_PLANT_PLUS, 5.0);
	TEST_ASSERT_TRUE(rig_run_to_change(&rig, LW_PLANT_LIMIT_PLUS, 2 * MS));
	assert_limit(LW_PLANT_PLUS, true, false);
	TEST_ASSERT_FALSE(rig_run_to_change(&rig, LW_PLANT_LIMIT_PLUS, S));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_BOUNCE, -1));
}

/** A switch changes where its point, shifted in the direction of motion, says. */
static void assert_shifted(double point_um, double outward_um)
{
	double speed_mm_per_s = fabs(rig_truth(&rig).carriage_um_per_s) / 1000.0;
	double direction = outward_um > point_um ? 1.0 : -1.0;

	TEST_ASSERT_DOUBLE_WITHIN(
		0.05, point_um + direction * SHIFT_UM_PER_MM_PER_S * speed_mm_per_s, outward_um);
}

static void test_slow_approaches_repeat_within_a_third_of_a_microstep(void)
{
	/* From ever different phases of microstep, electrical period and substep. */
	for (int32_t i = 0; i < 50; i++) {
		start_at(78200 + i);
		rig_run(&rig, (uint64_t)i * 13577);

		double um = position_at_change(LW_PLANT_PLUS, 1.0);

		/* Not nil, because the carriage swings at each microstep, and the shift with it. */
		TEST_ASSERT_DOUBLE_WITHIN(10.0 / 6.0, LIMIT_UM + 10.0 / 6.0, um);
		assert_shifted(LIMIT_UM, um);
	}
}

static void test_fast_carriage_triggers_and_releases_later(void)
{
	for (enum lw_plant_side side = LW_PLANT_PLUS; side < LW_PLANT_SIDES; side++) {
		int outward = side == LW_PLANT_PLUS ? 1 : -1;

		start_at(0);
		rig_command(&rig, &motion, 200.0 * outward, GENTLY_MM_PER_S2, 200 * MS);

		double um = position_at_change(side, 200.0);

		TEST_ASSERT_DOUBLE_WITHIN(5.0, LIMIT_UM + 100.0, um);
		assert_shifted(LIMIT_UM, um);

		/* Out and back, still outside of the point of release. */
		rig_command(&rig, &motion, -200.0 * outward, 16000.0, 26 * MS);
		um = position_at_change(side, -200.0);
		/* It still swings, by up to 21 mm/s, and the shift with it. */
		TEST_ASSERT_DOUBLE_WITHIN(10.5, LIMIT_UM - HYSTERESIS_UM - 100.0, um);
		assert_shifted(LIMIT_UM - HYSTERESIS_UM, um);

		/* Later by as much as it is told. */
		start_at(0);
		inject(LW_PLANT_FAULT_SWITCH_LATE, 2000);
		rig_command(&rig, &motion, 200.0 * outward, GENTLY_MM_PER_S2, 200 * MS);
		TEST_ASSERT_DOUBLE_WITHIN(5.0, LIMIT_UM + 400.0, position_at_change(side, 200.0));
	}
}

static void test_actuated_up_to_the_end_stop_and_overtravel_beyond_its_point(void)
{
	start_at(70000);
	inject(LW_PLANT_FAULT_BOUNCE, 0);
	rig_command(&rig, &motion, 20.0, GENTLY_MM_PER_S2, 500 * MS);
	TEST_ASSERT_TRUE(rig.plant.pins.limit[LW_PLANT_PLUS].no_closed);
	TEST_ASSERT_FALSE(rig.plant.pins.overtravel[LW_PLANT_PLUS]);
	while (!rig.plant.pins.overtravel[LW_PLANT_PLUS]) {
		rig_command(&rig, &motion, 20.0, GENTLY_MM_PER_S2, MS);
	}
	TEST_ASSERT_DOUBLE_WITHIN(25.0, 86000.0, rig_truth(&rig).carriage_um);
	rig_command(&rig, &motion, 20.0, GENTLY_MM_PER_S2, S);
	TEST_ASSERT_EQUAL_UINT32(2, rig.limit_plus_events);
	assert_limit(LW_PLANT_PLUS, true, false);
	assert_limit(LW_PLANT_MINUS, false, true);
	TEST_ASSERT_FALSE(rig.plant.pins.overtravel[LW_PLANT_MINUS]);
}

static void test_power_up_outside_of_a_switch_finds_it_actuated_and_quiet(void)
{
	start_at(-88000);
	assert_limit(LW_PLANT_MINUS, true, false);
	assert_limit(LW_PLANT_PLUS, false, true);
	TEST_ASSERT_TRUE(rig.plant.pins.overtravel[LW_PLANT_MINUS]);
	TEST_ASSERT_FALSE(rig_run_to_change(&rig, UINT32_MAX, S));
}

static void test_a_carriage_placed_by_hand_moves_the_switches(void)
{
	lw_plant_enable(&rig.plant, false);
	inject(LW_PLANT_FAULT_PLACE_CARRIAGE, 87000);
	rig_run(&rig, 10 * MS);
	assert_limit(LW_PLANT_PLUS, true, false);
	TEST_ASSERT_TRUE(rig.plant.pins.overtravel[LW_PLANT_PLUS]);
	inject(LW_PLANT_FAULT_PLACE_CARRIAGE, 0);
	rig_run(&rig, 10 * MS);
	assert_limit(LW_PLANT_PLUS, false, true);
	TEST_ASSERT_FALSE(rig.plant.pins.overtravel[LW_PLANT_PLUS]);
}

static void test_a_pole_that_turns_back_in_transit_closes_its_old_contact(void)
{
	struct lw_plant_config config;

	lw_plant_config_default(&config);
	config.start_um = 78390;
	config.contact_transit_us = 500000;
	rig_init(&rig, &config);
	position_at_change(LW_PLANT_PLUS, 5.0);
	inject(LW_PLANT_FAULT_PLACE_CARRIAGE, 70000);
	rig_run(&rig, 499 * MS);
	assert_limit(LW_PLANT_PLUS, false, false);
	rig_run(&rig, 10 * MS);
	assert_limit(LW_PLANT_PLUS, false, true);
}

static void test_stuck_switches_do_not_follow_the_carriage(void)
{
	inject(LW_PLANT_FAULT_LIMIT_PLUS, LW_PLANT_SWITCH_STUCK_ACTUATED);
	inject(LW_PLANT_FAULT_LIMIT_MINUS, LW_PLANT_SWITCH_STUCK_RELEASED);
	inject(LW_PLANT_FAULT_OVERTRAVEL_PLUS, LW_PLANT_SWITCH_STUCK_ACTUATED);
	inject(LW_PLANT_FAULT_OVERTRAVEL_MINUS, LW_PLANT_SWITCH_STUCK_RELEASED);
	inject(LW_PLANT_FAULT_PLACE_CARRIAGE, -88000);
	rig_run(&rig, 10 * MS);
	assert_limit(LW_PLANT_PLUS, true, false);
	assert_limit(LW_PLANT_MINUS, false, true);
	TEST_ASSERT_TRUE(rig.plant.pins.overtravel[LW_PLANT_PLUS]);
	TEST_ASSERT_FALSE(rig.plant.pins.overtravel[LW_PLANT_MINUS]);

	/* Repaired, they tell the truth. */
	for (enum lw_plant_fault fault = LW_PLANT_FAULT_LIMIT_PLUS;
	     fault <= LW_PLANT_FAULT_OVERTRAVEL_MINUS; fault++) {
		inject(fault, LW_PLANT_SWITCH_OK);
	}
	rig_run(&rig, 10 * MS);
	assert_limit(LW_PLANT_PLUS, false, true);
	assert_limit(LW_PLANT_MINUS, true, false);
	TEST_ASSERT_FALSE(rig.plant.pins.overtravel[LW_PLANT_PLUS]);
	TEST_ASSERT_TRUE(rig.plant.pins.overtravel[LW_PLANT_MINUS]);
}

static void test_broken_and_shorted_wires(void)
{
	static const struct {
		enum lw_plant_switch_fault fault;
		bool released_no, released_nc, actuated_no, actuated_nc;
	} cases[] = {
		{LW_PLANT_SWITCH_NO_BROKEN, false, true, false, false},
		{LW_PLANT_SWITCH_NC_BROKEN, false, false, true, false},
		{LW_PLANT_SWITCH_SHORTED, true, true, true, true},
		{LW_PLANT_SWITCH_OK, false, true, true, false},
	};

	for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
		inject(LW_PLANT_FAULT_LIMIT_PLUS, cases[i].fault);
		assert_limit(LW_PLANT_PLUS, cases[i].released_no, cases[i].released_nc);
		inject(LW_PLANT_FAULT_PLACE_CARRIAGE, 80000);
		rig_run(&rig, 10 * MS);
		assert_limit(LW_PLANT_PLUS, cases[i].actuated_no, cases[i].actuated_nc);
		assert_limit(LW_PLANT_MINUS, false, true);
		inject(LW_PLANT_FAULT_PLACE_CARRIAGE, 0);
		rig_run(&rig, 10 * MS);
	}
}

static void test_unknown_switch_faults_are_refused(void)
{
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_LIMIT_PLUS,
						       LW_PLANT_SWITCH_FAULT_COUNT));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_LIMIT_MINUS, -1));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_OVERTRAVEL_PLUS,
						       LW_PLANT_SWITCH_NO_BROKEN));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_SWITCH_LATE, -1));
	TEST_ASSERT_EQUAL_INT(-ERANGE,
			      lw_plant_inject(&rig.plant, LW_PLANT_FAULT_SWITCH_LATE, 1000001));
}

static void test_an_injection_changes_pins_in_an_event_only(void)
{
	rig_run_until(&rig, 12345678);

	uint64_t now_ns = rig.plant.now_ns;

	TEST_ASSERT_EQUAL_INT(
		0, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_LIMIT_PLUS, LW_PLANT_SWITCH_SHORTED));
	assert_limit(LW_PLANT_PLUS, false, true);
	TEST_ASSERT_EQUAL_UINT64(now_ns, lw_plant_next_event_ns(&rig.plant));
	TEST_ASSERT_EQUAL_HEX32(LW_PLANT_LIMIT_PLUS, rig_advance(&rig));
	assert_limit(LW_PLANT_PLUS, true, true);
	TEST_ASSERT_EQUAL_UINT64(now_ns, rig.plant.now_ns);
}

/** FNV-1a over times and masks of all changes of a run with every source of chance in it. */
static uint64_t trace(uint64_t seed)
{
	struct lw_plant_config config;
	uint64_t hash = 0xcbf29ce484222325u;

	lw_plant_config_default(&config);
	config.start_um = 78000;
	rig = (struct rig){0};
	TEST_ASSERT_EQUAL_INT(0, lw_plant_init(&rig.plant, &config, seed));
	lw_plant_enable(&rig.plant, true);
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 123456));
	TEST_ASSERT_EQUAL_INT(0,
			      lw_plant_arm(&rig.plant, 78500, 1, LW_PLANT_FAULT_ENCODER_DITHER, 9));
	for (int i = 0; i < 20000; i++) {
		uint32_t changed = rig_advance(&rig);

		hash = (hash ^ changed ^ (rig.plant.now_ns << 8)) * 0x100000001b3u;
		if (changed & LW_PLANT_ENCODER) {
			lw_plant_step(&rig.plant, i % 16 < 8 ? 1 : (i % 16 < 11 ? -1 : 1));
		}
	}
	TEST_ASSERT_GREATER_THAN_UINT32(3, rig.limit_plus_events);
	TEST_ASSERT_FALSE(lw_plant_armed(&rig.plant));
	return hash;
}

static void test_equal_seeds_give_equal_traces(void)
{
	uint64_t first = trace(7);

	TEST_ASSERT_EQUAL_HEX64(first, trace(7));
	TEST_ASSERT_TRUE(first != trace(8));
	TEST_ASSERT_TRUE(first != trace(0));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_contacts_open_travel_close_and_bounce);
	RUN_TEST(test_contacts_bounce_on_nc_on_the_way_back);
	RUN_TEST(test_without_bounce_each_contact_changes_once);
	RUN_TEST(test_slow_approaches_repeat_within_a_third_of_a_microstep);
	RUN_TEST(test_fast_carriage_triggers_and_releases_later);
	RUN_TEST(test_actuated_up_to_the_end_stop_and_overtravel_beyond_its_point);
	RUN_TEST(test_power_up_outside_of_a_switch_finds_it_actuated_and_quiet);
	RUN_TEST(test_a_carriage_placed_by_hand_moves_the_switches);
	RUN_TEST(test_a_pole_that_turns_back_in_transit_closes_its_old_contact);
	RUN_TEST(test_stuck_switches_do_not_follow_the_carriage);
	RUN_TEST(test_broken_and_shorted_wires);
	RUN_TEST(test_unknown_switch_faults_are_refused);
	RUN_TEST(test_an_injection_changes_pins_in_an_event_only);
	RUN_TEST(test_equal_seeds_give_equal_traces);
	return UNITY_END();
}
