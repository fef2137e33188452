/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The pins of a stepper driver that every step and direction output has beside the step pin.
 */
#ifndef STEP_DIR_PINS_H
#define STEP_DIR_PINS_H

#include <stdbool.h>

#include <zephyr/drivers/gpio.h>

/** A pin that is not wired has no port. */
struct step_dir_pins {
	struct gpio_dt_spec dir;
	struct gpio_dt_spec enable;
	struct gpio_dt_spec alarm;
};

#define STEP_DIR_PINS(inst)                                                                        \
	{                                                                                          \
		.dir = GPIO_DT_SPEC_INST_GET(inst, dir_gpios),                                     \
		.enable = GPIO_DT_SPEC_INST_GET_OR(inst, enable_gpios, {0}),                       \
		.alarm = GPIO_DT_SPEC_INST_GET_OR(inst, alarm_gpios, {0}),                         \
	}

/**
 * Configure a pin; one that is not wired needs nothing.
 *
 * @retval 0 done
 * @retval -ENODEV its port is not ready
 * @retval <0 errno of the GPIO driver
 */
int step_dir_pin_configure(const struct gpio_dt_spec *pin, gpio_flags_t flags);

/** Configure all three: no current first. As step_dir_pin_configure(). */
int step_dir_pins_configure(const struct step_dir_pins *pins);

/** As lw_step_dir_enable(). */
int step_dir_pins_enable(const struct step_dir_pins *pins, bool enabled);

/** As lw_step_dir_alarm(). */
int step_dir_pins_alarm(const struct step_dir_pins *pins);

#endif /* STEP_DIR_PINS_H */
