/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief The plant's motor and carriage: following, pull-out, stall, slip, triggers, configuration.
 */
#include <errno.h>
#include <string.h>

#include "test_plant_rig.h"

/** Microsteps of one electrical period of the default motor. */
#define PERIOD_USTEPS 40

/** The prototype's reversal. */
#define SWEEP_MM_PER_S                 200.0
#define REVERSAL_MM_PER_S2             8000.0
#define SUDDENLY_MM_PER_S2             1e9
#define GENTLY_MM_PER_S2               4000.0
#define HOLDING_MM_PER_S2              30000
#define HALF_A_SWEEP_NS                (300 * MS)
#define FRICTION_DEFLECTS_BELOW_USTEPS 1.0
#define TWO_PI                         6.283185307179586

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

static void inject(enum lw_plant_fault fault, int32_t argument)
{
	TEST_ASSERT_EQUAL_INT(0, lw_plant_inject(&rig.plant, fault, argument));
}

/** Sweep to and fro; the last reversal ends at rest. */
static void sweep(double speed_mm_per_s, double acceleration_mm_per_s2)
{
	rig_command(&rig, &motion, speed_mm_per_s, acceleration_mm_per_s2, HALF_A_SWEEP_NS);
	for (int i = 0; i < 5; i++) {
		rig_command(&rig, &motion, -speed_mm_per_s, acceleration_mm_per_s2,
			    2 * HALF_A_SWEEP_NS);
		rig_command(&rig, &motion, speed_mm_per_s, acceleration_mm_per_s2,
			    2 * HALF_A_SWEEP_NS);
	}
	rig_command(&rig, &motion, 0.0, acceleration_mm_per_s2, HALF_A_SWEEP_NS);
}

static void assert_in_step(void)
{
	struct lw_plant_truth truth = rig_truth(&rig);

	TEST_ASSERT_TRUE(truth.in_sync);
	TEST_ASSERT_EQUAL_INT64(0, truth.slipped_usteps);
	TEST_ASSERT_EQUAL_UINT64(0, truth.pole_slips);
	TEST_ASSERT_DOUBLE_WITHIN(FRICTION_DEFLECTS_BELOW_USTEPS, 0.0, truth.lag_usteps);
	TEST_ASSERT_EQUAL_INT64(motion.stepped_usteps, truth.commanded_usteps);
}

/** At rest in some electrical period, but not the right one. */
static void assert_fell_back_in_elsewhere(void)
{
	struct lw_plant_truth truth = rig_truth(&rig);

	TEST_ASSERT_FALSE(truth.in_sync);
	TEST_ASSERT_TRUE(truth.slipped_usteps != 0);
	TEST_ASSERT_EQUAL_INT64(0, truth.slipped_usteps % PERIOD_USTEPS);
	TEST_ASSERT_DOUBLE_WITHIN(FRICTION_DEFLECTS_BELOW_USTEPS, (double)truth.slipped_usteps,
				  truth.lag_usteps);
	TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, truth.carriage_um_per_s);
}

static void test_follows_the_sweep(void)
{
	sweep(SWEEP_MM_PER_S, REVERSAL_MM_PER_S2);
	assert_in_step();
	TEST_ASSERT_GREATER_THAN_UINT64(100000, rig_truth(&rig).step_pulses);
}

static void test_follows_the_sweep_with_twice_the_acceleration(void)
{
	sweep(SWEEP_MM_PER_S, 2.0 * REVERSAL_MM_PER_S2);
	assert_in_step();
}

static void test_follows_the_sweep_with_half_the_torque(void)
{
	struct lw_plant_config config;

	lw_plant_config_default(&config);
	config.holding_acceleration_mm_per_s2 /= 2.0;
	rig_init(&rig, &config);
	sweep(SWEEP_MM_PER_S, REVERSAL_MM_PER_S2);
	assert_in_step();
}

static void test_single_steps_are_followed_and_settle(void)
{
	for (int i = 1; i <= 100; i++) {
		lw_plant_step(&rig.plant, 1);
		rig_run(&rig, 50 * MS);
		TEST_ASSERT_DOUBLE_WITHIN(0.3, i, rig_truth(&rig).carriage_usteps);
		TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, rig_truth(&rig).carriage_um_per_s);
	}
}

static void test_a_sudden_start_loses_synchronization(void)
{
	rig_command(&rig, &motion, SWEEP_MM_PER_S, SUDDENLY_MM_PER_S2, HALF_A_SWEEP_NS);
	TEST_ASSERT_FALSE(rig_truth(&rig).in_sync);
	rig_command(&rig, &motion, 0.0, SUDDENLY_MM_PER_S2, 200 * MS);
	assert_fell_back_in_elsewhere();
	TEST_ASSERT_GREATER_THAN_INT64(0, rig_truth(&rig).slipped_usteps);
}

static void test_the_motor_never_gives_more_than_its_holding_acceleration(void)
{
	double speed_um_per_s = 0.0;

	/* Damping pulls hardest here: a fast field, a rotor at rest. */
	for (int i = 0; i < 1000; i++) {
		rig_command(&rig, &motion, 1000.0, SUDDENLY_MM_PER_S2, LW_PLANT_SUBSTEP_NS);

		double gained = rig_truth(&rig).carriage_um_per_s - speed_um_per_s;

		/* And friction when slowing down. */
		TEST_ASSERT_DOUBLE_WITHIN((HOLDING_MM_PER_S2 + 501) * 1e-6 * LW_PLANT_SUBSTEP_NS,
					  0.0, gained);
		speed_um_per_s += gained;
	}
}

/**
 * A motor by its equation alone, in steps of a microsecond: does it follow a start at once to a
 * speed? As the plant's default, but for its holding acceleration.
 */
static bool follows_by_the_equation(double holding_mm_per_s2, double speed_mm_per_s)
{
	const double dt_s = 1e-6;
	const double holding = holding_mm_per_s2 * 100.0;
	const double damping_per_s =
		2.0 * 0.2 * sqrt(holding * TWO_PI / PERIOD_USTEPS); /* omega of small swings */
	double commanded = 0.0;
	double x = 0.0;
	double v = 0.0;
	double field = 0.0;

	for (double t_s = 0.0; t_s < 0.1; t_s += dt_s) {
		const double next = floor(speed_mm_per_s * 100.0 * t_s);
		const double angle = TWO_PI * (next - x) / PERIOD_USTEPS;
		double pull;

		field += (next - commanded) / 1e-3 - field * dt_s / 1e-3;
		commanded = next;
		pull = holding * sin(angle) + damping_per_s * cos(angle) * (field - v);
		pull = fmin(fmax(pull, -holding), holding) / (1.0 + fabs(v) / 40000.0);
		v += pull * dt_s;
		v = copysign(fmax(fabs(v) - 50000.0 * dt_s, 0.0), v);
		x += v * dt_s;
		if (fabs(next - x) > PERIOD_USTEPS / 2.0) {
			return false;
		}
	}
	return true;
}

static bool plant_follows(double holding_mm_per_s2, double speed_mm_per_s)
{
	struct lw_plant_config config;

	lw_plant_config_default(&config);
	config.holding_acceleration_mm_per_s2 = holding_mm_per_s2;
	rig_init(&rig, &config);
	motion = (struct rig_motion){0};
	rig_command(&rig, &motion, speed_mm_per_s, SUDDENLY_MM_PER_S2, 100 * MS);
	return rig_truth(&rig).pole_slips == 0;
}

/** Fastest start that is followed. */
static double fastest_start_mm_per_s(bool (*follows)(double, double), double holding_mm_per_s2)
{
	double least = 0.0;
	double most = 400.0;

	while (most - least > 0.2) {
		const double middle = (least + most) / 2.0;

		if (follows(holding_mm_per_s2, middle)) {
			least = middle;
		} else {
			most = middle;
		}
	}
	return least;
}

/* The length of the plant's substep decides nothing: pull-out is that of the equation. */
static void test_starts_up_to_the_speed_that_the_equation_tells(void)
{
	static const double holdings_mm_per_s2[] = {8000.0, 30000.0, 60000.0};

	for (size_t i = 0; i < sizeof(holdings_mm_per_s2) / sizeof(holdings_mm_per_s2[0]); i++) {
		const double should =
			fastest_start_mm_per_s(follows_by_the_equation, holdings_mm_per_s2[i]);

		TEST_ASSERT_DOUBLE_WITHIN(
			0.0125 * should, should,
			fastest_start_mm_per_s(plant_follows, holdings_mm_per_s2[i]));
	}
}

static void test_a_sudden_start_at_low_speed_is_followed(void)
{
	rig_command(&rig, &motion, 20.0, SUDDENLY_MM_PER_S2, HALF_A_SWEEP_NS);
	rig_command(&rig, &motion, 0.0, SUDDENLY_MM_PER_S2, 200 * MS);
	assert_in_step();
}

static void test_a_pulled_out_rotor_slips_until_the_field_is_slow(void)
{
	rig_command(&rig, &motion, SWEEP_MM_PER_S, GENTLY_MM_PER_S2, 100 * MS);
	TEST_ASSERT_TRUE(rig_truth(&rig).in_sync);

	/* A load that the motor could hold at rest, but not at this speed. */
	inject(LW_PLANT_FAULT_SIDE_LOAD, -HOLDING_MM_PER_S2 * 8 / 10);
	rig_command(&rig, &motion, SWEEP_MM_PER_S, GENTLY_MM_PER_S2, 10 * MS);
	inject(LW_PLANT_FAULT_SIDE_LOAD, 0);
	TEST_ASSERT_FALSE(rig_truth(&rig).in_sync);

	/* The load is gone, the field is not: the rotor only shakes. */
	uint64_t pole_slips = rig_truth(&rig).pole_slips;

	rig_command(&rig, &motion, SWEEP_MM_PER_S, GENTLY_MM_PER_S2, 100 * MS);
	TEST_ASSERT_GREATER_THAN_UINT64(pole_slips + 20, rig_truth(&rig).pole_slips);

	/* Through zero, and with the field from there on. */
	rig_command(&rig, &motion, -SWEEP_MM_PER_S, GENTLY_MM_PER_S2, 100 * MS);
	pole_slips = rig_truth(&rig).pole_slips;
	rig_command(&rig, &motion, -SWEEP_MM_PER_S, GENTLY_MM_PER_S2, 100 * MS);
	TEST_ASSERT_EQUAL_UINT64(pole_slips, rig_truth(&rig).pole_slips);
	TEST_ASSERT_DOUBLE_WITHIN(5000.0, -200000.0, rig_truth(&rig).carriage_um_per_s);
	rig_command(&rig, &motion, 0.0, GENTLY_MM_PER_S2, 200 * MS);
	assert_fell_back_in_elsewhere();
}

static void test_the_same_load_at_rest_is_held(void)
{
	inject(LW_PLANT_FAULT_SIDE_LOAD, HOLDING_MM_PER_S2 * 6 / 10);
	rig_run(&rig, S);
	TEST_ASSERT_TRUE(rig_truth(&rig).in_sync);
	/* Static deflection asin(0.6 less friction) of the electrical period. */
	TEST_ASSERT_DOUBLE_WITHIN(0.5, -PERIOD_USTEPS * 0.1024, rig_truth(&rig).lag_usteps);
	inject(LW_PLANT_FAULT_SIDE_LOAD, HOLDING_MM_PER_S2 * 12 / 10);
	rig_run(&rig, S);
	TEST_ASSERT_DOUBLE_WITHIN(0.01, 90000.0, rig_truth(&rig).carriage_um);
}

static void test_stall_holds_the_carriage_for_its_duration(void)
{
	rig_command(&rig, &motion, SWEEP_MM_PER_S, GENTLY_MM_PER_S2, 100 * MS);
	inject(LW_PLANT_FAULT_STALL, 50);

	double held_um = rig_truth(&rig).carriage_um;

	rig_command(&rig, &motion, SWEEP_MM_PER_S, GENTLY_MM_PER_S2, 49 * MS);
	TEST_ASSERT_DOUBLE_WITHIN(0.0, held_um, rig_truth(&rig).carriage_um);
	rig_command(&rig, &motion, 0.0, GENTLY_MM_PER_S2, 300 * MS);
	TEST_ASSERT_TRUE(rig_truth(&rig).carriage_um != held_um);
	assert_fell_back_in_elsewhere();
}

static void test_stall_without_end_holds_until_released(void)
{
	inject(LW_PLANT_FAULT_STALL, -1);
	rig_command(&rig, &motion, 10.0, GENTLY_MM_PER_S2, S);
	TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, rig_truth(&rig).carriage_um);
	inject(LW_PLANT_FAULT_STALL, 0);
	rig_command(&rig, &motion, 10.0, GENTLY_MM_PER_S2, S);
	TEST_ASSERT_DOUBLE_WITHIN(500.0, 10000.0, rig_truth(&rig).carriage_um);
}

static void test_slip_moves_by_whole_electrical_periods(void)
{
	inject(LW_PLANT_FAULT_SLIP, -95);
	TEST_ASSERT_DOUBLE_WITHIN(1e-9, -2 * PERIOD_USTEPS, rig_truth(&rig).carriage_usteps);
	rig_run(&rig, 200 * MS);
	TEST_ASSERT_EQUAL_INT64(2 * PERIOD_USTEPS, rig_truth(&rig).slipped_usteps);
	TEST_ASSERT_DOUBLE_WITHIN(FRICTION_DEFLECTS_BELOW_USTEPS, -2 * PERIOD_USTEPS,
				  rig_truth(&rig).carriage_usteps);
	TEST_ASSERT_FALSE(rig_truth(&rig).in_sync);
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_SLIP, 19));
}

static void test_slip_ends_at_the_end_stop(void)
{
	inject(LW_PLANT_FAULT_SLIP, -10000);
	TEST_ASSERT_DOUBLE_WITHIN(1e-9, -90000.0, rig_truth(&rig).carriage_um);
}

static void test_slip_at_speed_goes_on_at_speed(void)
{
	rig_command(&rig, &motion, SWEEP_MM_PER_S, GENTLY_MM_PER_S2, 100 * MS);
	inject(LW_PLANT_FAULT_SLIP, 3 * PERIOD_USTEPS);
	rig_command(&rig, &motion, 0.0, GENTLY_MM_PER_S2, 200 * MS);
	TEST_ASSERT_EQUAL_INT64(-3 * PERIOD_USTEPS, rig_truth(&rig).slipped_usteps);
	TEST_ASSERT_EQUAL_UINT64(3, rig_truth(&rig).pole_slips);

	double before_um = rig_truth(&rig).carriage_um;

	lw_plant_reference(&rig.plant);
	for (int i = 0; i < 100; i++) {
		rig_run(&rig, MS);
		TEST_ASSERT_DOUBLE_WITHIN(1e-6, before_um, rig_truth(&rig).carriage_um);
	}
	TEST_ASSERT_TRUE(rig_truth(&rig).in_sync);
	TEST_ASSERT_DOUBLE_WITHIN(FRICTION_DEFLECTS_BELOW_USTEPS, 0.0, rig_truth(&rig).lag_usteps);
}

static void test_a_carriage_placed_by_hand_snaps_in_when_enabled(void)
{
	lw_plant_enable(&rig.plant, false);
	inject(LW_PLANT_FAULT_PLACE_CARRIAGE, -10230);
	rig_run(&rig, 100 * MS);
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, -10230.0, rig_truth(&rig).carriage_um);
	lw_plant_enable(&rig.plant, true);
	rig_run(&rig, 300 * MS);
	/* Multiples of 400 um about the commanded position 0. */
	TEST_ASSERT_DOUBLE_WITHIN(10.0, -10400.0, rig_truth(&rig).carriage_um);
	TEST_ASSERT_EQUAL_INT(-ERANGE,
			      lw_plant_inject(&rig.plant, LW_PLANT_FAULT_PLACE_CARRIAGE, 90001));
}

static void test_without_current_only_friction_holds(void)
{
	lw_plant_enable(&rig.plant, false);
	for (int i = 0; i < 10; i++) {
		lw_plant_step(&rig.plant, 1);
	}
	inject(LW_PLANT_FAULT_SIDE_LOAD, 499);
	rig_run(&rig, S);
	TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, rig_truth(&rig).carriage_um);
	inject(LW_PLANT_FAULT_SIDE_LOAD, -600);
	rig_run(&rig, S / 2);
	/* Friction takes 500 of the 600 mm/s^2: 12.5 mm in half a second. */
	TEST_ASSERT_DOUBLE_WITHIN(20.0, -12500.0, rig_truth(&rig).carriage_um);
}

static void test_the_end_stop_is_never_passed(void)
{
	double most_um = 0.0;

	/* 10 s at 20 mm/s: twice as far as there is room. */
	for (int i = 0; i < 1000; i++) {
		rig_command(&rig, &motion, 20.0, GENTLY_MM_PER_S2, 10 * MS);
		most_um = fmax(most_um, rig_truth(&rig).carriage_um);
	}
	TEST_ASSERT_DOUBLE_WITHIN(1e-6, 90000.0, most_um);
	TEST_ASSERT_GREATER_THAN_INT64(10000, rig_truth(&rig).slipped_usteps);
}

static void test_reversed_wiring_turns_the_other_way(void)
{
	inject(LW_PLANT_FAULT_CARRIAGE_REVERSED, 1);
	rig_command(&rig, &motion, 20.0, GENTLY_MM_PER_S2, S);
	TEST_ASSERT_DOUBLE_WITHIN(500.0, -20000.0, rig_truth(&rig).carriage_um);
	TEST_ASSERT_EQUAL_INT64(-motion.stepped_usteps, rig_truth(&rig).commanded_usteps);
	inject(LW_PLANT_FAULT_CARRIAGE_REVERSED, 0);
	rig_command(&rig, &motion, 0.0, GENTLY_MM_PER_S2, 100 * MS);
	rig_command(&rig, &motion, 20.0, GENTLY_MM_PER_S2, S);
	TEST_ASSERT_DOUBLE_WITHIN(500.0, 0.0, rig_truth(&rig).carriage_um);
	TEST_ASSERT_EQUAL_INT(-EINVAL,
			      lw_plant_inject(&rig.plant, LW_PLANT_FAULT_CARRIAGE_REVERSED, 2));
}

static void test_trigger_fires_at_its_position_in_its_direction(void)
{
	/* The way out passes 12,345 um in the wrong direction. */
	TEST_ASSERT_EQUAL_INT(0, lw_plant_arm(&rig.plant, 12345, -1, LW_PLANT_FAULT_STALL, -1));
	rig_command(&rig, &motion, 100.0, GENTLY_MM_PER_S2, 300 * MS);
	TEST_ASSERT_TRUE(lw_plant_armed(&rig.plant));
	TEST_ASSERT_DOUBLE_WITHIN(1500.0, 29000.0, rig_truth(&rig).carriage_um);
	rig_command(&rig, &motion, -100.0, GENTLY_MM_PER_S2, 400 * MS);
	TEST_ASSERT_FALSE(lw_plant_armed(&rig.plant));
	TEST_ASSERT_DOUBLE_WITHIN(0.001, 12345.0, rig_truth(&rig).carriage_um);
}

static void test_trigger_of_either_direction_never_misses(void)
{
	for (int32_t i = 0; i < 300; i++) {
		int direction = i % 2 == 0 ? 1 : -1;
		int32_t um = i / 2 * 7 * direction;

		setUp();
		TEST_ASSERT_EQUAL_INT(0, lw_plant_arm(&rig.plant, um, 0, LW_PLANT_FAULT_STALL, -1));
		rig_command(&rig, &motion, 100.0 * direction, GENTLY_MM_PER_S2, 30 * MS);
		TEST_ASSERT_FALSE(lw_plant_armed(&rig.plant));
		TEST_ASSERT_DOUBLE_WITHIN(0.001, um, rig_truth(&rig).carriage_um);
	}
}

static void test_bad_triggers_are_refused_and_keep_the_armed_one(void)
{
	enum lw_plant_fault unknown = LW_PLANT_FAULT_COUNT;

	TEST_ASSERT_EQUAL_INT(0, lw_plant_arm(&rig.plant, 1000, 0, LW_PLANT_FAULT_STALL, -1));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_arm(&rig.plant, 0, 2, LW_PLANT_FAULT_STALL, 1));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_arm(&rig.plant, 0, 0, unknown, 0));
	TEST_ASSERT_EQUAL_INT(-ERANGE,
			      lw_plant_arm(&rig.plant, -90001, 0, LW_PLANT_FAULT_STALL, 1));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_arm(&rig.plant, 0, 0, LW_PLANT_FAULT_SLIP, 0));
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_inject(&rig.plant, unknown, 0));
	rig_command(&rig, &motion, 100.0, GENTLY_MM_PER_S2, 50 * MS);
	TEST_ASSERT_DOUBLE_WITHIN(0.001, 1000.0, rig_truth(&rig).carriage_um);
}

static void assert_refused(const struct lw_plant_config *config)
{
	struct lw_plant before = rig.plant;

	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_init(&rig.plant, config, 1));
	TEST_ASSERT_EQUAL_MEMORY(&before, &rig.plant, sizeof(before));
}

static void test_impossible_configurations_are_refused(void)
{
	struct lw_plant_config good;
	struct lw_plant_config bad;

	lw_plant_config_default(&good);
	bad = good;
	bad.encoder_revs_per_drum_rev_den = 0;
	assert_refused(&bad);
	bad = good;
	bad.usteps_per_rev = 2010; /* electrical period of 40.2 microsteps */
	assert_refused(&bad);
	bad = good;
	bad.friction_mm_per_s2 = NAN;
	assert_refused(&bad);
	bad = good;
	bad.limit_um[LW_PLANT_MINUS] = -86000;
	assert_refused(&bad);
	bad = good;
	bad.start_um = 90001;
	assert_refused(&bad);
	bad = good;
	bad.bounce_interval_us = 0;
	assert_refused(&bad);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_follows_the_sweep);
	RUN_TEST(test_follows_the_sweep_with_twice_the_acceleration);
	RUN_TEST(test_follows_the_sweep_with_half_the_torque);
	RUN_TEST(test_single_steps_are_followed_and_settle);
	RUN_TEST(test_a_sudden_start_loses_synchronization);
	RUN_TEST(test_the_motor_never_gives_more_than_its_holding_acceleration);
	RUN_TEST(test_starts_up_to_the_speed_that_the_equation_tells);
	RUN_TEST(test_a_sudden_start_at_low_speed_is_followed);
	RUN_TEST(test_a_pulled_out_rotor_slips_until_the_field_is_slow);
	RUN_TEST(test_the_same_load_at_rest_is_held);
	RUN_TEST(test_stall_holds_the_carriage_for_its_duration);
	RUN_TEST(test_stall_without_end_holds_until_released);
	RUN_TEST(test_slip_moves_by_whole_electrical_periods);
	RUN_TEST(test_slip_ends_at_the_end_stop);
	RUN_TEST(test_slip_at_speed_goes_on_at_speed);
	RUN_TEST(test_a_carriage_placed_by_hand_snaps_in_when_enabled);
	RUN_TEST(test_without_current_only_friction_holds);
	RUN_TEST(test_the_end_stop_is_never_passed);
	RUN_TEST(test_reversed_wiring_turns_the_other_way);
	RUN_TEST(test_trigger_fires_at_its_position_in_its_direction);
	RUN_TEST(test_trigger_of_either_direction_never_misses);
	RUN_TEST(test_bad_triggers_are_refused_and_keep_the_armed_one);
	RUN_TEST(test_impossible_configurations_are_refused);
	return UNITY_END();
}
