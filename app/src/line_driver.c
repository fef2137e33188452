/* SPDX-License-Identifier: Apache-2.0 */
#include "line_driver.h"

#include <errno.h>

#include <zephyr/drivers/gpio.h>

#include "app.h"

static const struct gpio_dt_spec driver_enable =
	GPIO_DT_SPEC_GET_OR(APP_NODE, driver_enable_gpios, {0});

int line_driver_let_go(void)
{
	if (driver_enable.port == NULL) {
		return 0;
	}
	return gpio_is_ready_dt(&driver_enable)
		       ? gpio_pin_configure_dt(&driver_enable, GPIO_OUTPUT_INACTIVE)
		       : -ENODEV;
}

void line_driver_switch(bool on)
{
	if (driver_enable.port != NULL) {
		(void)gpio_pin_set_dt(&driver_enable, on);
	}
}
