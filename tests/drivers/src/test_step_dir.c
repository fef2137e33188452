/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The step and direction driver: order and times of the edges at its outputs, polarity, enable,
 * alarm. Emulated pins tell every write, so the times are those of the simulated clock, which
 * passes in whole microseconds.
 */
#include <errno.h>

#include <zephyr/drivers/gpio.h>
#include <zephyr/drivers/gpio/gpio_emul.h>
#include <zephyr/ztest.h>

#include "lw/drivers/step_dir.h"

enum {
	STEP = 4,
	DIR = 5,
	ENABLE = 6,
	ALARM = 7,
	BARE_STEP = 8,
	BARE_DIR = 9,
};

static const struct device *const stepper = DEVICE_DT_GET(DT_NODELABEL(stepper));
static const struct device *const bare_stepper = DEVICE_DT_GET(DT_NODELABEL(bare_stepper));
static const struct device *const pins = DEVICE_DT_GET(DT_NODELABEL(pins));

/** One write that changed an output. */
struct edge {
	uint32_t time_us;
	gpio_pin_t pin;
	bool level;
};

static struct edge edges[64];
static size_t edge_count;
static struct gpio_callback writes;

static void on_write(const struct device *port, struct gpio_callback *callback,
		     gpio_port_pins_t changed)
{
	static bool levels[32];

	ARG_UNUSED(port);
	ARG_UNUSED(callback);
	for (gpio_pin_t pin = STEP; pin <= BARE_DIR; pin++) {
		if (!(changed & BIT(pin)) || pin == ENABLE || pin == ALARM) {
			continue;
		}

		const bool level = gpio_emul_output_get(pins, pin) > 0;

		if (level != levels[pin] && edge_count < ARRAY_SIZE(edges)) {
			edges[edge_count++] =
				(struct edge){k_cyc_to_us_floor32(k_cycle_get_32()), pin, level};
		}
		levels[pin] = level;
	}
}

static void *setup(void)
{
	gpio_init_callback(&writes, on_write,
			   BIT(STEP) | BIT(DIR) | BIT(BARE_STEP) | BIT(BARE_DIR));
	zassert_ok(gpio_add_callback(pins, &writes));
	return NULL;
}

static void before(void *fixture)
{
	ARG_UNUSED(fixture);
	/* From a known direction, with the record empty. */
	lw_step_dir_step(stepper, -1);
	lw_step_dir_step(bare_stepper, -1);
	edge_count = 0;
}

ZTEST(step_dir, test_direction_is_set_up_before_the_pulse)
{
	lw_step_dir_step(stepper, 1);
	zassert_equal(edge_count, 3);
	zassert_true(edges[0].pin == DIR && edges[0].level);
	zassert_true(edges[1].pin == STEP && edges[1].level);
	zassert_true(edges[2].pin == STEP && !edges[2].level);
	/* 400 ns and 200 ns, rounded up */
	zassert_true(edges[1].time_us - edges[0].time_us >= 1);
	zassert_true(edges[2].time_us - edges[1].time_us >= 1);
}

ZTEST(step_dir, test_every_step_is_one_pulse)
{
	for (int i = 0; i < 10; i++) {
		lw_step_dir_step(stepper, -1);
	}
	zassert_equal(edge_count, 20);
	for (size_t i = 0; i < edge_count; i++) {
		zassert_equal(edges[i].pin, STEP);
		zassert_equal(edges[i].level, i % 2 == 0);
		zassert_true(i == 0 || edges[i].time_us - edges[i - 1].time_us >= 1);
	}
}

ZTEST(step_dir, test_several_steps_at_once)
{
	lw_step_dir_step(stepper, 3);
	zassert_equal(edge_count, 1 + 2 * 3);
	zassert_true(edges[0].pin == DIR && edges[0].level);
	zassert_false(lw_step_dir_take_lost(stepper));
}

ZTEST(step_dir, test_a_direction_that_is_prepared)
{
	lw_step_dir_prepare(stepper, -1);
	zassert_equal(edge_count, 0, "it stands there already");
	lw_step_dir_prepare(stepper, 1);
	zassert_equal(edge_count, 1);
	zassert_true(edges[0].pin == DIR && edges[0].level);
	lw_step_dir_step(stepper, 1);
	zassert_equal(edge_count, 3);
	zassert_equal(edges[1].pin, STEP);
}

ZTEST(step_dir, test_direction_is_held_after_the_pulse)
{
	lw_step_dir_step(stepper, 1);
	lw_step_dir_step(stepper, -1);
	zassert_equal(edge_count, 6);
	zassert_true(edges[3].pin == DIR && !edges[3].level);
	zassert_true(edges[3].time_us - edges[2].time_us >= 1);
}

ZTEST(step_dir, test_inverted_outputs_without_times)
{
	lw_step_dir_step(bare_stepper, 1);
	zassert_equal(edge_count, 3);
	zassert_true(edges[0].pin == BARE_DIR && !edges[0].level);
	zassert_true(edges[1].pin == BARE_STEP && !edges[1].level);
	zassert_true(edges[2].pin == BARE_STEP && edges[2].level);
}

ZTEST(step_dir, test_enable_and_alarm)
{
	zassert_equal(gpio_emul_output_get(pins, ENABLE), 1, "current on at power-up");
	zassert_ok(lw_step_dir_enable(stepper, true));
	zassert_equal(gpio_emul_output_get(pins, ENABLE), 0);
	zassert_ok(lw_step_dir_enable(stepper, false));
	zassert_equal(gpio_emul_output_get(pins, ENABLE), 1);
	zassert_ok(gpio_emul_input_set(pins, ALARM, 1));
	zassert_equal(lw_step_dir_alarm(stepper), 0);
	zassert_ok(gpio_emul_input_set(pins, ALARM, 0));
	zassert_equal(lw_step_dir_alarm(stepper), 1);
	zassert_equal(lw_step_dir_alarm(bare_stepper), -ENOTSUP);
	zassert_ok(lw_step_dir_enable(bare_stepper, true));
}

ZTEST_SUITE(step_dir, NULL, setup, before, NULL, NULL);
