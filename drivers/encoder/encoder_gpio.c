/* SPDX-License-Identifier: Apache-2.0 */
#define DT_DRV_COMPAT levelwind_encoder_gpio

#include <errno.h>

#include <zephyr/drivers/gpio.h>

#include "encoder_index.h"
#include "lw/drivers/encoder.h"

struct encoder_config {
	struct gpio_dt_spec a;
	struct gpio_dt_spec b;
	struct gpio_dt_spec index; /**< index.port is NULL where it is not wired */
};

/** Written before the interrupts are enabled, then only read. */
struct encoder_data {
	const struct device *dev;
	lw_encoder_callback callback;
	void *user_data;
	struct gpio_callback a_gpio;
	struct gpio_callback b_gpio; /**< used if B is on another port than A */
	struct encoder_index index;
};

static bool level(const struct gpio_dt_spec *pin, gpio_port_value_t levels)
{
	return ((levels >> pin->pin) & 1u) != ((pin->dt_flags & GPIO_ACTIVE_LOW) != 0);
}

static int encoder_read(const struct device *dev, bool *a, bool *b)
{
	const struct encoder_config *config = dev->config;
	gpio_port_value_t a_levels;
	gpio_port_value_t b_levels;
	int ret;

	ret = gpio_port_get_raw(config->a.port, &a_levels);
	if (ret) {
		return ret;
	}
	b_levels = a_levels;
	if (config->b.port != config->a.port) {
		ret = gpio_port_get_raw(config->b.port, &b_levels);
		if (ret) {
			return ret;
		}
	}
	*a = level(&config->a, a_levels);
	*b = level(&config->b, b_levels);
	return 0;
}

static void call_back(const struct encoder_data *data)
{
	bool a;
	bool b;

	if (encoder_read(data->dev, &a, &b) == 0) {
		data->callback(a, b, data->user_data);
	}
}

static void on_a(const struct device *port, struct gpio_callback *gpio, gpio_port_pins_t pins)
{
	ARG_UNUSED(port);
	ARG_UNUSED(pins);
	call_back(CONTAINER_OF(gpio, struct encoder_data, a_gpio));
}

static void on_b(const struct device *port, struct gpio_callback *gpio, gpio_port_pins_t pins)
{
	ARG_UNUSED(port);
	ARG_UNUSED(pins);
	call_back(CONTAINER_OF(gpio, struct encoder_data, b_gpio));
}

static void on_index(const struct device *port, struct gpio_callback *gpio, gpio_port_pins_t pins)
{
	const struct encoder_data *data = CONTAINER_OF(gpio, struct encoder_data, index.gpio);

	ARG_UNUSED(port);
	ARG_UNUSED(pins);
	data->index.callback(false, data->index.user_data);
}

static int encoder_start(const struct device *dev, lw_encoder_callback callback, void *user_data)
{
	const struct encoder_config *config = dev->config;
	struct encoder_data *data = dev->data;
	gpio_port_pins_t a_pins = BIT(config->a.pin);
	int ret;

	data->callback = callback;
	data->user_data = user_data;
	if (config->b.port == config->a.port) {
		a_pins |= BIT(config->b.pin);
	} else {
		gpio_init_callback(&data->b_gpio, on_b, BIT(config->b.pin));
		ret = gpio_add_callback_dt(&config->b, &data->b_gpio);
		if (ret) {
			return ret;
		}
	}
	gpio_init_callback(&data->a_gpio, on_a, a_pins);
	ret = gpio_add_callback_dt(&config->a, &data->a_gpio);
	if (ret == 0) {
		ret = gpio_pin_interrupt_configure_dt(&config->a, GPIO_INT_EDGE_BOTH);
	}
	if (ret == 0) {
		ret = gpio_pin_interrupt_configure_dt(&config->b, GPIO_INT_EDGE_BOTH);
	}
	return ret;
}

static int encoder_start_index(const struct device *dev, lw_encoder_index_callback callback,
			       void *user_data)
{
	const struct encoder_config *config = dev->config;
	struct encoder_data *data = dev->data;

	return encoder_index_start(&data->index, &config->index, on_index, callback, user_data);
}

static int encoder_init(const struct device *dev)
{
	const struct encoder_config *config = dev->config;
	struct encoder_data *data = dev->data;
	const struct gpio_dt_spec *pins[] = {&config->a, &config->b, &config->index};

	data->dev = dev;
	for (size_t i = 0; i < ARRAY_SIZE(pins); i++) {
		int ret;

		if (pins[i]->port == NULL) {
			continue;
		}
		if (!gpio_is_ready_dt(pins[i])) {
			return -ENODEV;
		}
		ret = gpio_pin_configure_dt(pins[i], GPIO_INPUT);
		if (ret) {
			return ret;
		}
	}
	return 0;
}

static const struct lw_encoder_api encoder_api = {
	.start = encoder_start,
	.start_index = encoder_start_index,
	.read = encoder_read,
};

#define ENCODER_DEFINE(inst)                                                                       \
	static const struct encoder_config encoder_config_##inst = {                               \
		.a = GPIO_DT_SPEC_INST_GET(inst, a_gpios),                                         \
		.b = GPIO_DT_SPEC_INST_GET(inst, b_gpios),                                         \
		.index = GPIO_DT_SPEC_INST_GET_OR(inst, index_gpios, {0}),                         \
	};                                                                                         \
	static struct encoder_data encoder_data_##inst;                                            \
	DEVICE_DT_INST_DEFINE(inst, encoder_init, NULL, &encoder_data_##inst,                      \
			      &encoder_config_##inst, POST_KERNEL,                                 \
			      CONFIG_KERNEL_INIT_PRIORITY_DEVICE, &encoder_api);

DT_INST_FOREACH_STATUS_OKAY(ENCODER_DEFINE)
