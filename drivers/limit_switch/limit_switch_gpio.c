/* SPDX-License-Identifier: Apache-2.0 */
#define DT_DRV_COMPAT levelwind_limit_switch

#include <errno.h>

#include <zephyr/drivers/gpio.h>

#include "lw/drivers/limit_switch.h"

enum {
	NO,
	NC,
	CONTACTS,
};

struct limit_switch_config {
	struct gpio_dt_spec pins[CONTACTS]; /**< port is NULL where a contact is not wired */
};

/** Written before the interrupts are enabled, then only read. */
struct limit_switch_data {
	const struct device *dev;
	lw_contacts_callback callback;
	void *user_data;
	struct gpio_callback no_gpio;
	struct gpio_callback nc_gpio;
};

static int limit_switch_read(const struct device *dev, struct lw_contacts *contacts)
{
	const struct limit_switch_config *config = dev->config;
	int closed[CONTACTS] = {0};

	for (size_t i = 0; i < CONTACTS; i++) {
		if (config->pins[i].port == NULL) {
			continue;
		}
		closed[i] = gpio_pin_get_dt(&config->pins[i]);
		if (closed[i] < 0) {
			return closed[i];
		}
	}
	*contacts = (struct lw_contacts){.no_closed = closed[NO] > 0, .nc_closed = closed[NC] > 0};
	return 0;
}

static bool limit_switch_actuated(const struct device *dev, struct lw_contacts contacts)
{
	const struct limit_switch_config *config = dev->config;

	return config->pins[NC].port != NULL ? !contacts.nc_closed : contacts.no_closed;
}

static void call_back(const struct limit_switch_data *data)
{
	struct lw_contacts contacts;

	if (limit_switch_read(data->dev, &contacts) == 0) {
		data->callback(contacts, data->user_data);
	}
}

static void on_no(const struct device *port, struct gpio_callback *gpio, gpio_port_pins_t pins)
{
	ARG_UNUSED(port);
	ARG_UNUSED(pins);
	call_back(CONTAINER_OF(gpio, struct limit_switch_data, no_gpio));
}

static void on_nc(const struct device *port, struct gpio_callback *gpio, gpio_port_pins_t pins)
{
	ARG_UNUSED(port);
	ARG_UNUSED(pins);
	call_back(CONTAINER_OF(gpio, struct limit_switch_data, nc_gpio));
}

static int limit_switch_start(const struct device *dev, lw_contacts_callback callback,
			      void *user_data)
{
	const struct limit_switch_config *config = dev->config;
	struct limit_switch_data *data = dev->data;
	struct gpio_callback *gpios[CONTACTS] = {&data->no_gpio, &data->nc_gpio};
	const gpio_callback_handler_t handlers[CONTACTS] = {on_no, on_nc};

	data->callback = callback;
	data->user_data = user_data;
	for (size_t i = 0; i < CONTACTS; i++) {
		const struct gpio_dt_spec *pin = &config->pins[i];
		int ret;

		if (pin->port == NULL) {
			continue;
		}
		gpio_init_callback(gpios[i], handlers[i], BIT(pin->pin));
		ret = gpio_add_callback_dt(pin, gpios[i]);
		if (ret == 0) {
			ret = gpio_pin_interrupt_configure_dt(pin, GPIO_INT_EDGE_BOTH);
		}
		if (ret) {
			return ret;
		}
	}
	return 0;
}

static int limit_switch_init(const struct device *dev)
{
	const struct limit_switch_config *config = dev->config;
	struct limit_switch_data *data = dev->data;

	data->dev = dev;
	for (size_t i = 0; i < CONTACTS; i++) {
		int ret;

		if (config->pins[i].port == NULL) {
			continue;
		}
		if (!gpio_is_ready_dt(&config->pins[i])) {
			return -ENODEV;
		}
		ret = gpio_pin_configure_dt(&config->pins[i], GPIO_INPUT);
		if (ret) {
			return ret;
		}
	}
	return 0;
}

static const struct lw_contacts_api limit_switch_api = {
	.start = limit_switch_start,
	.read = limit_switch_read,
	.actuated = limit_switch_actuated,
};

#define LIMIT_SWITCH_DEFINE(inst)                                                                  \
	BUILD_ASSERT(DT_INST_NODE_HAS_PROP(inst, no_gpios) ||                                      \
			     DT_INST_NODE_HAS_PROP(inst, nc_gpios),                                \
		     "a limit switch needs no-gpios, nc-gpios or both");                           \
	static const struct limit_switch_config limit_switch_config_##inst = {                     \
		.pins = {GPIO_DT_SPEC_INST_GET_OR(inst, no_gpios, {0}),                            \
			 GPIO_DT_SPEC_INST_GET_OR(inst, nc_gpios, {0})},                           \
	};                                                                                         \
	static struct limit_switch_data limit_switch_data_##inst;                                  \
	DEVICE_DT_INST_DEFINE(inst, limit_switch_init, NULL, &limit_switch_data_##inst,            \
			      &limit_switch_config_##inst, POST_KERNEL,                            \
			      CONFIG_KERNEL_INIT_PRIORITY_DEVICE, &limit_switch_api);

DT_INST_FOREACH_STATUS_OKAY(LIMIT_SWITCH_DEFINE)
