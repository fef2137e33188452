/* SPDX-License-Identifier: Apache-2.0 */
#include "step_dir_pins.h"

#include <errno.h>

int step_dir_pin_configure(const struct gpio_dt_spec *pin, gpio_flags_t flags)
{
	if (pin->port == NULL) {
		return 0;
	}
	return gpio_is_ready_dt(pin) ? gpio_pin_configure_dt(pin, flags) : -ENODEV;
}

int step_dir_pins_configure(const struct step_dir_pins *pins)
{
	int ret = step_dir_pin_configure(&pins->enable, GPIO_OUTPUT_INACTIVE);

	if (ret == 0) {
		ret = step_dir_pin_configure(&pins->dir, GPIO_OUTPUT_INACTIVE);
	}
	return ret ? ret : step_dir_pin_configure(&pins->alarm, GPIO_INPUT);
}

int step_dir_pins_enable(const struct step_dir_pins *pins, bool enabled)
{
	return pins->enable.port == NULL ? 0 : gpio_pin_set_dt(&pins->enable, enabled);
}

int step_dir_pins_alarm(const struct step_dir_pins *pins)
{
	return pins->alarm.port == NULL ? -ENOTSUP : gpio_pin_get_dt(&pins->alarm);
}
