/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The encoder driver together with the core's decoder: every edge mode, dither, transitions that
 * cannot be, channels on two ports, the index pulse.
 */
#include <errno.h>

#include <zephyr/drivers/gpio.h>
#include <zephyr/drivers/gpio/gpio_emul.h>
#include <zephyr/ztest.h>

#include "lw/drivers/encoder.h"
#include "lw/motion/quadrature.h"

static const struct device *const encoder = DEVICE_DT_GET(DT_NODELABEL(encoder));
static const struct device *const split_encoder = DEVICE_DT_GET(DT_NODELABEL(split_encoder));
static const struct device *const pins = DEVICE_DT_GET(DT_NODELABEL(pins));
static const struct device *const other_pins = DEVICE_DT_GET(DT_NODELABEL(other_pins));

/* (A,B) in the forward direction: A in bit 0 and B in bit 1, as the pins are numbered. */
static const uint8_t forward[] = {0x0, 0x1, 0x3, 0x2};

static struct lw_quadrature_config config;
static struct lw_quadrature quadrature;
static int net_edges;
static int calls;
static int index_pulses;
static bool last_a;
static bool last_b;

static void on_edge(bool a, bool b, void *user_data)
{
	ARG_UNUSED(user_data);
	net_edges += lw_quadrature_update(&quadrature, a, b);
	last_a = a;
	last_b = b;
	calls++;
}

static void on_index(bool late, void *user_data)
{
	zassert_false(late);
	ARG_UNUSED(user_data);
	index_pulses++;
}

static void set_channels(uint8_t levels)
{
	zassert_ok(gpio_emul_input_set_masked(pins, 0x3, levels));
}

static void *setup(void)
{
	zassert_ok(lw_encoder_start(encoder, on_edge, NULL));
	zassert_ok(lw_encoder_start(split_encoder, on_edge, NULL));
	zassert_ok(lw_encoder_start_index(encoder, on_index, NULL));
	return NULL;
}

static void before(void *fixture)
{
	ARG_UNUSED(fixture);
	set_channels(0);
	net_edges = 0;
	calls = 0;
	index_pulses = 0;
}

static void begin(uint8_t edges_per_pulse)
{
	bool a;
	bool b;

	config = (struct lw_quadrature_config){.edges_per_pulse = edges_per_pulse};
	zassert_ok(lw_encoder_read(encoder, &a, &b));
	lw_quadrature_init(&quadrature, &config, a, b);
}

static void turn(int transitions)
{
	static int phase;

	phase = 0;
	for (int i = 0; i < (transitions < 0 ? -transitions : transitions); i++) {
		phase = (phase + (transitions < 0 ? 3 : 1)) % 4;
		set_channels(forward[phase]);
	}
}

ZTEST(encoder, test_every_mode_counts_its_edges_both_ways)
{
	static const uint8_t modes[] = {1, 2, 4};

	for (size_t i = 0; i < ARRAY_SIZE(modes); i++) {
		before(NULL);
		begin(modes[i]);
		turn(4 * 100);
		zassert_equal(net_edges, 100 * modes[i]);
		turn(-4 * 30);
		zassert_equal(net_edges, 70 * modes[i]);
		zassert_equal(quadrature.illegal_transitions, 0);
	}
}

ZTEST(encoder, test_every_transition_interrupts_once)
{
	begin(4);
	turn(8);
	zassert_equal(calls, 8);
	set_channels(0); /* no change */
	zassert_equal(calls, 8);
}

ZTEST(encoder, test_dither_nets_to_zero)
{
	begin(4);
	for (int i = 0; i < 50; i++) {
		set_channels(0x1);
		set_channels(0x0);
	}
	zassert_equal(net_edges, 0);
	zassert_equal(calls, 100);
}

ZTEST(encoder, test_both_channels_at_once_is_counted_and_no_motion)
{
	begin(4);
	set_channels(0x3);
	zassert_equal(net_edges, 0);
	zassert_equal(quadrature.illegal_transitions, 1);
	set_channels(0x2);
	zassert_equal(net_edges, 1);
}

ZTEST(encoder, test_channels_on_two_ports_with_one_inverted)
{
	bool a;
	bool b;

	zassert_ok(gpio_emul_input_set(pins, 3, 0));
	zassert_ok(gpio_emul_input_set(other_pins, 3, 0));
	zassert_ok(lw_encoder_read(split_encoder, &a, &b));
	zassert_true(a && !b);
	calls = 0;
	zassert_ok(gpio_emul_input_set(other_pins, 3, 1));
	zassert_equal(calls, 1);
	zassert_true(last_a && last_b);
	zassert_ok(gpio_emul_input_set(pins, 3, 1));
	zassert_equal(calls, 2);
	zassert_true(!last_a && last_b);
}

ZTEST(encoder, test_index_pulse_is_told_at_its_beginning)
{
	zassert_ok(gpio_emul_input_set(pins, 2, 1));
	zassert_equal(index_pulses, 1);
	zassert_ok(gpio_emul_input_set(pins, 2, 0));
	zassert_equal(index_pulses, 1);
	zassert_equal(lw_encoder_start_index(split_encoder, on_index, NULL), -ENOTSUP);
}

ZTEST_SUITE(encoder, NULL, setup, before, NULL, NULL);
