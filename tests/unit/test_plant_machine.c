/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief Another machine: its figures by name, and how it is wired.
 */
#include <errno.h>
#include <string.h>

#include <lw/plant_figures.h>

#include "test_plant_rig.h"

static struct rig rig;
static struct lw_plant_config config;

void setUp(void)
{
	lw_plant_config_default(&config);
}

void tearDown(void)
{
}

static double figure(const char *name)
{
	double value = NAN;

	TEST_ASSERT_EQUAL_INT_MESSAGE(0, lw_plant_config_get(&config, name, &value), name);
	return value;
}

static void set(const char *name, double value)
{
	TEST_ASSERT_EQUAL_INT_MESSAGE(0, lw_plant_config_set(&config, name, value), name);
}

static void test_every_figure_is_set_and_read_in_its_unit(void)
{
	for (const struct lw_plant_figure *f = lw_plant_figures; f->name != NULL; f++) {
		lw_plant_config_default(&config);
		TEST_ASSERT_TRUE_MESSAGE(figure(f->name) >= f->min && figure(f->name) <= f->max,
					 f->name);
		set(f->name, f->min);
		TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(f->min, figure(f->name), f->name);
		set(f->name, f->max);
		TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(f->max, figure(f->name), f->name);
	}
	lw_plant_config_default(&config);
	set("screw_lead_mm", 12.7);
	TEST_ASSERT_EQUAL_UINT32(12700, config.screw_lead_um);
	set("switch_minus_mm", -70.0014);
	TEST_ASSERT_EQUAL_INT32(-70001, config.limit_um[LW_PLANT_MINUS]);
	set("bounce_ms", 2.5);
	TEST_ASSERT_EQUAL_UINT32(2500, config.bounce_duration_us);
	set("switch_plus_fault", LW_PLANT_SWITCH_SHORTED);
	TEST_ASSERT_EQUAL_UINT8(LW_PLANT_SWITCH_SHORTED, config.limit_fault[LW_PLANT_PLUS]);
}

static void test_every_word_has_its_number(void)
{
	for (const struct lw_plant_figure *f = lw_plant_figures; f->name != NULL; f++) {
		int words = 0;

		while (f->words != NULL && f->words[words] != NULL) {
			words++;
		}
		TEST_ASSERT_TRUE_MESSAGE(f->words == NULL || (words == (int)f->max + 1 && f->whole),
					 f->name);
	}
}

static void test_a_bad_figure_changes_nothing(void)
{
	const struct lw_plant_config before = config;
	double value = 1.0;

	TEST_ASSERT_EQUAL_INT(-ENOENT, lw_plant_config_set(&config, "screw_lead_um", 1.0));
	TEST_ASSERT_EQUAL_INT(-ENOENT, lw_plant_config_get(&config, "screw_lead_um", &value));
	TEST_ASSERT_EQUAL_DOUBLE(1.0, value);
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_config_set(&config, "screw_lead_mm", 0.09));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_config_set(&config, "screw_lead_mm", 1000.1));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_config_set(&config, "screw_lead_mm", NAN));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_config_set(&config, "microsteps_per_rev", 200.5));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_plant_config_set(&config, "motor_reversed", 2));
	TEST_ASSERT_EQUAL_MEMORY(&before, &config, sizeof(before));
}

static void test_a_misfit_names_both_figures(void)
{
	struct lw_plant_misfit why;

	TEST_ASSERT_EQUAL_INT(0, lw_plant_config_check(&config, &why));
	set("overtravel_mm", 78.4);
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_config_check(&config, &why));
	TEST_ASSERT_EQUAL_STRING("switch_plus_mm", why.figure);
	TEST_ASSERT_EQUAL_STRING("less than", why.must_be);
	TEST_ASSERT_EQUAL_STRING("overtravel_mm", why.other);
}

/** Transitions that the pins count while the drum makes so many. */
static int64_t counted(int64_t transitions)
{
	rig_init(&rig, &config);
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, transitions > 0 ? 9000 : -9000));
	while (rig_truth(&rig).drum_transitions != transitions) {
		rig_advance(&rig);
	}
	TEST_ASSERT_EQUAL_UINT32(0, rig.illegal);
	return rig.decoded;
}

static void test_wires_of_the_encoder_decide_which_way_it_counts(void)
{
	for (int wiring = 0; wiring < 8; wiring++) {
		config.encoder_swapped = (wiring & 1) != 0;
		config.encoder_inverted[0] = (wiring & 2) != 0;
		config.encoder_inverted[1] = (wiring & 4) != 0;

		const int sign = (config.encoder_swapped ^ config.encoder_inverted[0] ^
				  config.encoder_inverted[1])
					 ? -1
					 : 1;

		TEST_ASSERT_EQUAL_INT64(sign * 1001, counted(1001));
		TEST_ASSERT_EQUAL_INT64(sign * -1001, counted(-1001));
	}
}

/** Level of a channel at the power-up, and behind it as the plain channel goes. */
static void test_an_inverted_channel_is_the_other_level(void)
{
	static struct rig plain;

	for (int channel = 0; channel < 2; channel++) {
		lw_plant_config_default(&config);
		rig_init(&plain, &config);
		config.encoder_inverted[channel] = true;
		rig_init(&rig, &config);
		TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&plain.plant, 9000));
		TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 9000));
		for (int ms = 0; ms < 50; ms++) {
			const struct lw_plant_pins *is = &rig.plant.pins;
			const struct lw_plant_pins *was = &plain.plant.pins;

			TEST_ASSERT_EQUAL(was->encoder_a ^ (channel == 0), is->encoder_a);
			TEST_ASSERT_EQUAL(was->encoder_b ^ (channel == 1), is->encoder_b);
			rig_run(&plain, MS);
			rig_run(&rig, MS);
		}
	}
}

static void test_swapped_channels_are_each_others(void)
{
	static struct rig plain;

	rig_init(&plain, &config);
	config.encoder_swapped = true;
	rig_init(&rig, &config);
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&plain.plant, 9000));
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 9000));
	for (int ms = 0; ms < 50; ms++) {
		TEST_ASSERT_EQUAL(plain.plant.pins.encoder_a, rig.plant.pins.encoder_b);
		TEST_ASSERT_EQUAL(plain.plant.pins.encoder_b, rig.plant.pins.encoder_a);
		rig_run(&plain, MS);
		rig_run(&rig, MS);
	}
}

/** A run is what one transition after the other would be, whatever the wires. */
static void test_a_run_shows_what_the_wires_do(void)
{
	static struct rig single;

	config.encoder_swapped = true;
	rig_init(&rig, &config);
	rig_init(&single, &config);
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 9000));
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&single.plant, 9000));
	while (rig.plant.now_ns < 200 * MS) {
		if (lw_plant_next_is_run(&rig.plant, UINT64_MAX)) {
			const struct lw_plant_run run =
				lw_plant_run_begin(&rig.plant, UINT64_MAX, UINT32_MAX);

			TEST_ASSERT_EQUAL_INT(-1, lw_plant_run_direction(&rig.plant));
			lw_plant_run_end(&rig.plant, &run);
		} else {
			(void)lw_plant_advance(&rig.plant);
		}
		rig_run_until(&single, rig.plant.now_ns);
		TEST_ASSERT_EQUAL(single.plant.pins.encoder_a, rig.plant.pins.encoder_a);
		TEST_ASSERT_EQUAL(single.plant.pins.encoder_b, rig.plant.pins.encoder_b);
	}
	TEST_ASSERT_GREATER_THAN_INT64(100, rig_truth(&rig).drum_transitions);
}

static void test_a_channel_is_broken_from_the_beginning(void)
{
	config.encoder_fault[0] = LW_PLANT_CHANNEL_STUCK_HIGH;
	config.encoder_fault[1] = LW_PLANT_CHANNEL_STUCK_LOW;
	config.encoder_index_open = true;
	rig_init(&rig, &config);
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 90000));
	while (rig_truth(&rig).drum_transitions < 6000) {
		(void)lw_plant_advance(&rig.plant);
		TEST_ASSERT_TRUE(rig.plant.pins.encoder_a);
		TEST_ASSERT_FALSE(rig.plant.pins.encoder_b);
		TEST_ASSERT_FALSE(rig.plant.pins.encoder_index);
	}
}

static void test_swapped_switches_tell_of_each_other(void)
{
	config.limit_swapped = true;
	config.start_um = 79000;
	rig_init(&rig, &config);
	TEST_ASSERT_TRUE(rig.plant.pins.limit[LW_PLANT_MINUS].no_closed);
	TEST_ASSERT_FALSE(rig.plant.pins.limit[LW_PLANT_MINUS].nc_closed);
	TEST_ASSERT_FALSE(rig.plant.pins.limit[LW_PLANT_PLUS].no_closed);
	TEST_ASSERT_TRUE(rig.plant.pins.limit[LW_PLANT_PLUS].nc_closed);

	config.overtravel_swapped = true;
	config.start_um = -87000;
	rig_init(&rig, &config);
	TEST_ASSERT_TRUE(rig.plant.pins.limit[LW_PLANT_PLUS].no_closed);
	TEST_ASSERT_TRUE(rig.plant.pins.overtravel[LW_PLANT_PLUS]);
	TEST_ASSERT_FALSE(rig.plant.pins.overtravel[LW_PLANT_MINUS]);

	/* What changes is told of the pins, not of the switch. */
	TEST_ASSERT_EQUAL_INT(0, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_PLACE_CARRIAGE, 0));
	TEST_ASSERT_TRUE(
		rig_run_to_change(&rig, LW_PLANT_OVERTRAVEL_PLUS | LW_PLANT_LIMIT_PLUS, 100 * MS));
	TEST_ASSERT_FALSE(rig.plant.pins.overtravel[LW_PLANT_PLUS]);
}

static void test_contacts_exchanged_read_actuated_at_rest(void)
{
	config.limit_contacts_swapped[LW_PLANT_MINUS] = true;
	rig_init(&rig, &config);
	TEST_ASSERT_TRUE(rig.plant.pins.limit[LW_PLANT_MINUS].no_closed);
	TEST_ASSERT_FALSE(rig.plant.pins.limit[LW_PLANT_MINUS].nc_closed);
	TEST_ASSERT_FALSE(rig.plant.pins.limit[LW_PLANT_PLUS].no_closed);
}

static void test_a_switch_is_broken_from_the_beginning(void)
{
	config.limit_fault[LW_PLANT_PLUS] = LW_PLANT_SWITCH_STUCK_ACTUATED;
	config.limit_fault[LW_PLANT_MINUS] = LW_PLANT_SWITCH_NC_BROKEN;
	config.overtravel_fault[LW_PLANT_MINUS] = LW_PLANT_SWITCH_STUCK_ACTUATED;
	rig_init(&rig, &config);
	TEST_ASSERT_TRUE(rig.plant.pins.limit[LW_PLANT_PLUS].no_closed);
	TEST_ASSERT_FALSE(rig.plant.pins.limit[LW_PLANT_MINUS].nc_closed);
	TEST_ASSERT_TRUE(rig.plant.pins.overtravel[LW_PLANT_MINUS]);
	rig_run(&rig, 100 * MS);
	TEST_ASSERT_TRUE(rig.plant.pins.limit[LW_PLANT_PLUS].no_closed);
	TEST_ASSERT_TRUE(rig.plant.pins.overtravel[LW_PLANT_MINUS]);
	TEST_ASSERT_FALSE(rig.plant.pins.overtravel[LW_PLANT_PLUS]);
}

static void test_a_motor_without_torque_above_its_top_speed_slips_there(void)
{
	struct rig_motion motion = {0};

	config.top_speed_mm_per_s = 100.0;
	rig_init(&rig, &config);
	rig_command(&rig, &motion, 80.0, 500.0, 300 * MS);
	TEST_ASSERT_EQUAL_UINT64(0, rig_truth(&rig).pole_slips);
	rig_command(&rig, &motion, 110.0, 500.0, 200 * MS);
	TEST_ASSERT_GREATER_THAN_UINT64(0, rig_truth(&rig).pole_slips);
}

static void test_backlash_is_lost_at_each_change_of_direction(void)
{
	struct rig_motion motion = {0};

	config.backlash_um = 300.0;
	rig_init(&rig, &config);
	rig_command(&rig, &motion, 20.0, 1000.0, S);
	rig_command(&rig, &motion, 0.0, 1000.0, 500 * MS);
	TEST_ASSERT_DOUBLE_WITHIN(20.0, 150.0,
				  10.0 * motion.position_usteps - rig_truth(&rig).carriage_um);
	rig_command(&rig, &motion, -20.0, 1000.0, S);
	rig_command(&rig, &motion, 0.0, 1000.0, 500 * MS);
	TEST_ASSERT_DOUBLE_WITHIN(20.0, -150.0,
				  10.0 * motion.position_usteps - rig_truth(&rig).carriage_um);
	/* The motor has followed all the same. */
	TEST_ASSERT_DOUBLE_WITHIN(2.0, 0.0, rig_truth(&rig).lag_usteps);
}

/** What the coupling has slipped after a ramp to 50 mm/s and a slow one to rest. */
static double slip_um(double acceleration_mm_per_s2)
{
	struct rig_motion motion = {0};

	rig_init(&rig, &config);
	rig_command(&rig, &motion, 50.0, acceleration_mm_per_s2, 400 * MS);
	rig_command(&rig, &motion, 0.0, 200.0, 400 * MS);
	TEST_ASSERT_DOUBLE_WITHIN(10.0,
				  10.0 * motion.position_usteps - rig_truth(&rig).coupling_slip_um,
				  rig_truth(&rig).carriage_um);
	return rig_truth(&rig).coupling_slip_um;
}

static void test_a_loose_coupling_slips_beyond_its_grip(void)
{
	config.coupling_grip_mm_per_s2 = 1500.0;             /* 1000 of them after friction */
	TEST_ASSERT_DOUBLE_WITHIN(5.0, 0.0, slip_um(900.0)); /* the rotor swings in */
	/* The screw takes v / 1000 where the motor takes v / 4000: v^2 / 2 of the difference, less
	 * what the coupling's elasticity takes. */
	TEST_ASSERT_DOUBLE_WITHIN(150.0, 1e3 * 50.0 * 50.0 / 2.0 * (1 / 1000.0 - 1 / 4000.0),
				  slip_um(4000.0));
	config.coupling_grip_mm_per_s2 = 0.0; /* tight */
	TEST_ASSERT_DOUBLE_WITHIN(0.0, 0.0, slip_um(4000.0));
}

static void test_a_coupling_slips_at_the_end_stop(void)
{
	struct rig_motion motion = {0};

	config.coupling_grip_mm_per_s2 = 600.0;
	config.start_um = 70000;
	rig_init(&rig, &config);
	rig_command(&rig, &motion, -50.0, 4000.0, 300 * MS); /* the screw stays behind */
	rig_command(&rig, &motion, 50.0, 100.0, 1200 * MS);
	while (rig_truth(&rig).carriage_um < 89999.0) {
		rig_command(&rig, &motion, 50.0, 100.0, 10 * MS);
	}
	rig_command(&rig, &motion, 50.0, 100.0, 50 * MS);
	TEST_ASSERT_DOUBLE_WITHIN(1.0, 90000.0, rig_truth(&rig).carriage_um);
	TEST_ASSERT_DOUBLE_WITHIN(30.0, 70000.0 + 10.0 * motion.position_usteps - 90000.0,
				  rig_truth(&rig).coupling_slip_um);
}

/** Press the plus switch by hand so often. @return mean and standard deviation of its place, mm */
static double places_mm(int count, double *deviation)
{
	double sum = 0.0;
	double squares = 0.0;

	for (int i = 0; i < count; i++) {
		const double mm = rig_truth(&rig).limit_um[LW_PLANT_PLUS] / 1000.0;

		sum += mm;
		squares += (mm - 78.4) * (mm - 78.4);
		TEST_ASSERT_EQUAL_INT(
			0, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_PLACE_CARRIAGE, 80000));
		rig_run(&rig, MS);
		TEST_ASSERT_EQUAL_INT(
			0, lw_plant_inject(&rig.plant, LW_PLANT_FAULT_PLACE_CARRIAGE, 0));
		rig_run(&rig, MS);
	}
	*deviation = sqrt(squares / count);
	return sum / count;
}

static void test_a_switch_with_scatter_triggers_elsewhere_each_time(void)
{
	double deviation;

	config.limit_scatter_um[LW_PLANT_PLUS] = 200.0;
	rig_init(&rig, &config);
	TEST_ASSERT_DOUBLE_WITHIN(0.03, 78.4, places_mm(400, &deviation));
	TEST_ASSERT_DOUBLE_WITHIN(0.02, 0.2, deviation);
	TEST_ASSERT_DOUBLE_WITHIN(0.01, -78400.0, rig_truth(&rig).limit_um[LW_PLANT_MINUS]);
}

static void test_a_switch_with_drift_goes_outward_with_each_actuation(void)
{
	double deviation;

	config.limit_drift_um[LW_PLANT_PLUS] = 10.0;
	config.limit_drift_um[LW_PLANT_MINUS] = 10.0;
	rig_init(&rig, &config);
	(void)places_mm(20, &deviation);
	TEST_ASSERT_DOUBLE_WITHIN(0.01, 78600.0, rig_truth(&rig).limit_um[LW_PLANT_PLUS]);
	TEST_ASSERT_DOUBLE_WITHIN(0.01, -78400.0, rig_truth(&rig).limit_um[LW_PLANT_MINUS]);
}

static void test_the_switch_triggers_where_its_truth_says(void)
{
	struct rig_motion motion = {0};
	double place_um;

	config.limit_scatter_um[LW_PLANT_PLUS] = 250.0;
	config.limit_shift_um_per_mm_per_s = 0.0;
	config.start_um = 77500;
	for (uint64_t seed = 1; seed < 6; seed++) {
		rig = (struct rig){0};
		TEST_ASSERT_EQUAL_INT(0, lw_plant_init(&rig.plant, &config, seed));
		lw_plant_enable(&rig.plant, true);
		motion = (struct rig_motion){0};
		place_um = rig_truth(&rig).limit_um[LW_PLANT_PLUS];
		while (rig.plant.pins.limit[LW_PLANT_PLUS].nc_closed) {
			rig_command(&rig, &motion, 5.0, 1000.0, MS);
		}
		TEST_ASSERT_DOUBLE_WITHIN(8.0, place_um, rig_truth(&rig).carriage_um);
	}
}

static void test_scatter_beyond_the_hysteresis_is_refused(void)
{
	struct lw_plant_misfit why;

	config.limit_scatter_um[LW_PLANT_MINUS] = 800.0 / 3.0;
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_plant_config_check(&config, &why));
	TEST_ASSERT_EQUAL_STRING("switch_minus_scatter_mm", why.figure);
}

/** Bytes of 100000 that come through wrong. */
static size_t disturbed(void)
{
	uint8_t bytes[100];
	size_t told = 0;
	size_t wrong = 0;

	for (int i = 0; i < 1000; i++) {
		memset(bytes, 0x55, sizeof(bytes));
		told += lw_plant_disturb(&rig.plant, bytes, sizeof(bytes));
		for (size_t at = 0; at < sizeof(bytes); at++) {
			wrong += bytes[at] != 0x55;
		}
	}
	TEST_ASSERT_EQUAL_UINT(told, wrong);
	return wrong;
}

static void test_noise_on_the_line_and_more_while_the_motor_turns(void)
{
	struct rig_motion motion = {0};

	rig_init(&rig, &config);
	TEST_ASSERT_EQUAL_UINT(0, disturbed());
	config.line_errors_ppm = 1000;
	config.line_errors_moving_ppm = 20000;
	rig_init(&rig, &config);
	TEST_ASSERT_INT_WITHIN(40, 100, disturbed());
	rig_command(&rig, &motion, 20.0, 1000.0, 200 * MS);
	TEST_ASSERT_INT_WITHIN(200, 2000, disturbed());
	rig_command(&rig, &motion, 0.0, 1000.0, 200 * MS);
	TEST_ASSERT_INT_WITHIN(40, 100, disturbed());
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_every_figure_is_set_and_read_in_its_unit);
	RUN_TEST(test_every_word_has_its_number);
	RUN_TEST(test_a_bad_figure_changes_nothing);
	RUN_TEST(test_a_misfit_names_both_figures);
	RUN_TEST(test_wires_of_the_encoder_decide_which_way_it_counts);
	RUN_TEST(test_an_inverted_channel_is_the_other_level);
	RUN_TEST(test_swapped_channels_are_each_others);
	RUN_TEST(test_a_run_shows_what_the_wires_do);
	RUN_TEST(test_a_channel_is_broken_from_the_beginning);
	RUN_TEST(test_swapped_switches_tell_of_each_other);
	RUN_TEST(test_contacts_exchanged_read_actuated_at_rest);
	RUN_TEST(test_a_switch_is_broken_from_the_beginning);
	RUN_TEST(test_a_motor_without_torque_above_its_top_speed_slips_there);
	RUN_TEST(test_backlash_is_lost_at_each_change_of_direction);
	RUN_TEST(test_a_loose_coupling_slips_beyond_its_grip);
	RUN_TEST(test_a_coupling_slips_at_the_end_stop);
	RUN_TEST(test_a_switch_with_scatter_triggers_elsewhere_each_time);
	RUN_TEST(test_a_switch_with_drift_goes_outward_with_each_actuation);
	RUN_TEST(test_the_switch_triggers_where_its_truth_says);
	RUN_TEST(test_scatter_beyond_the_hysteresis_is_refused);
	RUN_TEST(test_noise_on_the_line_and_more_while_the_motor_turns);
	return UNITY_END();
}
