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
	config.encoder_inverted[1] = true;
	rig_init(&rig, &config);
	rig_init(&single, &config);
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&rig.plant, 9000));
	TEST_ASSERT_EQUAL_INT(0, lw_plant_drum_target(&single.plant, 9000));
	while (rig.plant.now_ns < 200 * MS) {
		if (lw_plant_next_is_run(&rig.plant, UINT64_MAX)) {
			struct lw_plant_run run = lw_plant_run_begin(&rig.plant, UINT64_MAX);

			TEST_ASSERT_EQUAL_INT(1, lw_plant_run_direction(&rig.plant));
			do {
				(void)lw_plant_run_next(&run);
			} while (lw_plant_run_goes_on(&run));
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
	return UNITY_END();
}
