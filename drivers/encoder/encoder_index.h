/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The index channel of an encoder: a pin that interrupts where the pulse begins. Common to the
 * drivers of this folder.
 */
#ifndef ENCODER_INDEX_H
#define ENCODER_INDEX_H

#include <errno.h>

#include <zephyr/drivers/gpio.h>

#include "lw/drivers/encoder.h"

/** Of one encoder. Written before its interrupt is enabled. */
struct encoder_index {
	lw_encoder_index_callback callback;
	void *user_data;
	struct gpio_callback gpio;
};

/**
 * As lw_encoder_start_index().
 *
 * @param pin its port is NULL where it is not wired
 * @param handler gets `index->gpio`
 */
static inline int encoder_index_start(struct encoder_index *index, const struct gpio_dt_spec *pin,
				      gpio_callback_handler_t handler,
				      lw_encoder_index_callback callback, void *user_data)
{
	int ret;

	if (pin->port == NULL) {
		return -ENOTSUP;
	}
	index->callback = callback;
	index->user_data = user_data;
	gpio_init_callback(&index->gpio, handler, BIT(pin->pin));
	ret = gpio_add_callback_dt(pin, &index->gpio);
	return ret ? ret : gpio_pin_interrupt_configure_dt(pin, GPIO_INT_EDGE_TO_ACTIVE);
}

#endif /* ENCODER_INDEX_H */
