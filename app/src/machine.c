#include "machine.h"

#include <errno.h>

#include <zephyr/drivers/counter.h>

#include "app.h"
#include "lw/drivers/encoder.h"
#include "lw/drivers/limit_switch.h"
#include "lw/drivers/step_dir.h"

#define MACHINE_DEVICE(property) DEVICE_DT_GET(DT_PHANDLE(APP_NODE, property))

static const struct device *const encoder = MACHINE_DEVICE(encoder);
static const struct device *const stepper = MACHINE_DEVICE(stepper);
static const struct device *const edge_timer = MACHINE_DEVICE(edge_timer);

/* By side. */
static const struct device *const limits[] = {
	[LW_PLUS] = MACHINE_DEVICE(limit_plus),
	[LW_MINUS] = MACHINE_DEVICE(limit_minus),
};
static const struct device *const overtravels[] = {
	[LW_PLUS] = MACHINE_DEVICE(overtravel_plus),
	[LW_MINUS] = MACHINE_DEVICE(overtravel_minus),
};

/* What the outputs are now. Owned by the supervisor. */
static bool stepper_enabled;
static uint32_t timer_rate_edges_per_s;

static void step(int direction)
{
	if (direction != 0) {
		lw_step_dir_step(stepper,
				 lw_controller_driver_step(&app_device.controller, direction));
	}
}

static void on_encoder(bool a, bool b, void *user_data)
{
	ARG_UNUSED(user_data);
	step(lw_controller_encoder(&app_device.controller, a, b));
}

static void on_edge_timer(const struct device *dev, void *user_data)
{
	ARG_UNUSED(dev);
	ARG_UNUSED(user_data);
	step(lw_controller_timer_edge(&app_device.controller));
}

static void on_overtravel(struct lw_contacts contacts, void *user_data)
{
	const int side = (int)(intptr_t)user_data;

	lw_controller_overtravel(&app_device.controller, side,
				 lw_contacts_actuated(overtravels[side], contacts));
}

int machine_check(void)
{
	const struct device *const devices[] = {encoder,
						stepper,
						edge_timer,
						limits[LW_PLUS],
						limits[LW_MINUS],
						overtravels[LW_PLUS],
						overtravels[LW_MINUS]};

	for (size_t i = 0; i < ARRAY_SIZE(devices); i++) {
		if (!device_is_ready(devices[i])) {
			return -ENODEV;
		}
	}
	return 0;
}

int machine_read(struct lw_inputs *inputs)
{
	struct lw_contacts contacts;
	int ret = lw_encoder_read(encoder, &inputs->encoder_a, &inputs->encoder_b);

	for (int side = 0; side < 2 && ret == 0; side++) {
		ret = lw_contacts_read(limits[side], &contacts);
		if (ret == 0) {
			inputs->limit[side].no_closed = contacts.no_closed;
			inputs->limit[side].nc_closed = contacts.nc_closed;
			ret = lw_contacts_read(overtravels[side], &contacts);
		}
		if (ret == 0) {
			inputs->overtravel[side] =
				lw_contacts_actuated(overtravels[side], contacts);
		}
	}
	return ret;
}

int machine_start(void)
{
	int ret = lw_encoder_start(encoder, on_encoder, NULL);

	for (int side = 0; side < 2 && ret == 0; side++) {
		ret = lw_contacts_start(overtravels[side], on_overtravel, (void *)(intptr_t)side);
	}
	return ret;
}

static int set_timer_rate(uint32_t rate_edges_per_s)
{
	int ret;

	if (rate_edges_per_s == 0) {
		return counter_stop(edge_timer);
	}

	const struct counter_top_cfg top = {
		.ticks = counter_get_frequency(edge_timer) / rate_edges_per_s - 1,
		.callback = on_edge_timer,
	};

	/* In this order: some counters forget the interrupt when they start. */
	ret = counter_start(edge_timer);
	return ret ? ret : counter_set_top_value(edge_timer, &top);
}

int machine_serve_outputs(void)
{
	const struct lw_controller *controller = &app_device.controller;
	const bool enabled = lw_controller_stepper_enabled(controller);
	const uint32_t rate_edges_per_s = lw_controller_timer_rate_edges_per_s(controller);
	int ret = 0;

	if (enabled != stepper_enabled) {
		ret = lw_step_dir_enable(stepper, enabled);
		if (ret) {
			return ret;
		}
		stepper_enabled = enabled;
	}
	if (rate_edges_per_s != timer_rate_edges_per_s) {
		ret = set_timer_rate(rate_edges_per_s);
		if (ret) {
			return ret;
		}
		timer_rate_edges_per_s = rate_edges_per_s;
	}
	return 0;
}
