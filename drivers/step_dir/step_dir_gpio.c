/* SPDX-License-Identifier: Apache-2.0 */
#define DT_DRV_COMPAT levelwind_step_dir_gpio

#include <errno.h>

#include <zephyr/drivers/gpio.h>
#include <zephyr/kernel.h>

#include "lw/drivers/step_dir.h"
#include "step_dir_pins.h"

/** Longest time that a step may wait inside of its interrupt. */
#define WAIT_MAX_NS 1000

struct step_dir_config {
	struct gpio_dt_spec step;
	struct step_dir_pins pins;
	uint32_t dir_setup_ns;
	uint32_t step_pulse_ns;
	/** After a pulse: its space, and the hold time of the direction, whichever is longer. */
	uint32_t rest_ns;
};

/** Owned by the interrupt that steps. */
struct step_dir_data {
	int direction; /**< at the output; 0: not known yet */
};

/** Wait at least this long. */
static void wait_ns(uint32_t duration_ns)
{
	if (duration_ns == 0) {
		return;
	}
	if (IS_ENABLED(CONFIG_ARCH_POSIX)) {
		/* No time passes in a loop there. */
		k_busy_wait(DIV_ROUND_UP(duration_ns, NSEC_PER_USEC));
		return;
	}

	/* One more, because the first cycle has begun already. */
	const uint32_t cycles = k_ns_to_cyc_ceil32(duration_ns) + 1;
	const uint32_t start_cycles = k_cycle_get_32();

	while (k_cycle_get_32() - start_cycles < cycles) {
	}
}

static void step_dir_prepare(const struct device *dev, int direction)
{
	const struct step_dir_config *config = dev->config;
	struct step_dir_data *data = dev->data;

	if (direction != data->direction) {
		data->direction = direction;
		(void)gpio_pin_set_dt(&config->pins.dir, direction > 0);
		wait_ns(config->dir_setup_ns);
	}
}

static void give_pulse(const struct step_dir_config *config)
{
	(void)gpio_pin_set_dt(&config->step, 1);
	wait_ns(config->step_pulse_ns);
	(void)gpio_pin_set_dt(&config->step, 0);
	/*
	 * Waited for here and not before the next step: short as it is, it costs less than to
	 * find out when the last pulse ended.
	 */
	wait_ns(config->rest_ns);
}

static void step_dir_step(const struct device *dev, int steps)
{
	step_dir_prepare(dev, steps > 0 ? 1 : -1);
	for (int left = steps > 0 ? steps : -steps; left > 0; left--) {
		give_pulse(dev->config);
	}
}

/** Steps wait in the interrupt. */
static bool step_dir_take_lost(const struct device *dev)
{
	ARG_UNUSED(dev);
	return false;
}

static int step_dir_enable(const struct device *dev, bool enabled)
{
	return step_dir_pins_enable(&((const struct step_dir_config *)dev->config)->pins, enabled);
}

static int step_dir_alarm(const struct device *dev)
{
	return step_dir_pins_alarm(&((const struct step_dir_config *)dev->config)->pins);
}

static int step_dir_init(const struct device *dev)
{
	const struct step_dir_config *config = dev->config;
	const int ret = step_dir_pins_configure(&config->pins);

	return ret ? ret : step_dir_pin_configure(&config->step, GPIO_OUTPUT_INACTIVE);
}

static const struct lw_step_dir_api step_dir_api = {
	.step = step_dir_step,
	.prepare = step_dir_prepare,
	.take_lost = step_dir_take_lost,
	.enable = step_dir_enable,
	.alarm = step_dir_alarm,
};

#define REST_NS(inst) MAX(DT_INST_PROP(inst, step_space_ns), DT_INST_PROP(inst, dir_hold_ns))

#define STEP_DIR_DEFINE(inst)                                                                      \
	BUILD_ASSERT(DT_INST_PROP(inst, step_pulse_ns) + DT_INST_PROP(inst, dir_setup_ns) +        \
				     REST_NS(inst) <=                                              \
			     WAIT_MAX_NS,                                                          \
		     "too slow for levelwind,step-dir-gpio: use a driver with a timer");           \
	static const struct step_dir_config step_dir_config_##inst = {                             \
		.step = GPIO_DT_SPEC_INST_GET(inst, step_gpios),                                   \
		.pins = STEP_DIR_PINS(inst),                                                       \
		.dir_setup_ns = DT_INST_PROP(inst, dir_setup_ns),                                  \
		.step_pulse_ns = DT_INST_PROP(inst, step_pulse_ns),                                \
		.rest_ns = REST_NS(inst),                                                          \
	};                                                                                         \
	static struct step_dir_data step_dir_data_##inst;                                          \
	DEVICE_DT_INST_DEFINE(inst, step_dir_init, NULL, &step_dir_data_##inst,                    \
			      &step_dir_config_##inst, POST_KERNEL,                                \
			      CONFIG_KERNEL_INIT_PRIORITY_DEVICE, &step_dir_api);

DT_INST_FOREACH_STATUS_OKAY(STEP_DIR_DEFINE)
