/* SPDX-License-Identifier: Apache-2.0 */
#include "machine.h"

#include <errno.h>

#include <zephyr/drivers/counter.h>
#include <zephyr/drivers/gpio.h>
#include <zephyr/drivers/timer/system_timer.h>

#include "app.h"
#include "lw/drivers/encoder.h"
#include "lw/drivers/limit_switch.h"
#include "lw/drivers/step_dir.h"
#ifdef CONFIG_LW_STM32_SYSTEM_TIMER
#include "lw/drivers/system_timer.h"
#endif

#define MACHINE_DEVICE(property) DEVICE_DT_GET(DT_PHANDLE(APP_NODE, property))

static const struct device *const encoder = MACHINE_DEVICE(encoder);
static const struct device *const stepper = MACHINE_DEVICE(stepper);
static const struct device *const edge_timer = MACHINE_DEVICE(edge_timer);

/* Early, late; not wired where the devicetree has none. */
static const struct gpio_dt_spec trim_buttons[] = {
	GPIO_DT_SPEC_GET_OR(APP_NODE, trim_early_gpios, {0}),
	GPIO_DT_SPEC_GET_OR(APP_NODE, trim_late_gpios, {0}),
};

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

/** Direction of the last step, or of the next one where that is prepared. Of who steps. */
static int direction;

static void prepare(int next)
{
	if (next != 0 && next != direction) {
		direction = next;
		lw_step_dir_prepare(stepper,
				    lw_controller_driver_step(&app_device.controller, next));
	}
}

/** The driver spaces them. Only a cam, or an interrupt that comes late, gives more than one. */
static void give_steps(int steps)
{
	if (steps != 0) {
		direction = steps > 0 ? 1 : -1;
		lw_step_dir_step(stepper, lw_controller_driver_step(&app_device.controller, steps));
	}
}

/* Written by the encoder interrupt. */
static uint32_t encoder_interrupt_max_cycles;

/**
 * Cycles of the processor, counted down. The system timer tells them in one read, and runs round
 * only once in many interrupts' time.
 */
static inline uint32_t cycles_left(void)
{
#ifdef CONFIG_CORTEX_M_SYSTICK
	return SysTick->VAL;
#elif defined(CONFIG_LW_STM32_SYSTEM_TIMER)
	return 0u - lw_system_timer_cycles();
#else
	return 0; /* no time passes on native_sim */
#endif
}

static inline uint32_t cycles_between(uint32_t before, uint32_t after)
{
#ifdef CONFIG_CORTEX_M_SYSTICK
	return before >= after ? before - after : before + SysTick->LOAD + 1 - after;
#else
	return before - after;
#endif
}

static void note_time(uint32_t before)
{
	const uint32_t taken = cycles_between(before, cycles_left());

	if (taken > encoder_interrupt_max_cycles) {
		encoder_interrupt_max_cycles = taken;
	}
}

static void on_encoder(bool a, bool b, void *user_data)
{
	const uint32_t before = cycles_left();

	ARG_UNUSED(user_data);
	give_steps(lw_controller_encoder(&app_device.controller, a, b));
	note_time(before);
}

static uint32_t on_encoder_count(int32_t transitions, void *user_data)
{
	const uint32_t before = cycles_left();
	uint32_t due;

	ARG_UNUSED(user_data);
	give_steps(lw_controller_encoder_count(&app_device.controller, transitions));
	prepare(lw_controller_turns_to(&app_device.controller, transitions));
	due = lw_controller_encoder_reach(&app_device.controller, transitions);
	note_time(before);
	return due;
}

static void on_encoder_index(bool late, void *user_data)
{
	ARG_UNUSED(user_data);
	if (late) {
		lw_controller_encoder_index_late(&app_device.controller);
	} else {
		lw_controller_encoder_index(&app_device.controller);
	}
}

static void on_edge_timer(const struct device *dev, void *user_data)
{
	/* The step driver's interrupt is above this one. */
	const unsigned int key = irq_lock();

	ARG_UNUSED(dev);
	ARG_UNUSED(user_data);
	give_steps(lw_controller_timer_edge(&app_device.controller));
	irq_unlock(key);
}

static void on_overtravel(struct lw_contacts contacts, void *user_data)
{
	const int side = (int)(intptr_t)user_data;

	lw_controller_overtravel(&app_device.controller, side,
				 lw_contacts_actuated(overtravels[side], contacts));
}

/** What a contact did before its interrupt was enabled, nobody has told. */
static int read_overtravel(int side)
{
	struct lw_contacts contacts;
	const unsigned int key = irq_lock();
	const int ret = lw_contacts_read(overtravels[side], &contacts);

	if (ret == 0) {
		on_overtravel(contacts, (void *)(intptr_t)side);
	}
	irq_unlock(key);
	return ret;
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
	for (size_t i = 0; i < ARRAY_SIZE(trim_buttons); i++) {
		if (trim_buttons[i].port != NULL && !gpio_is_ready_dt(&trim_buttons[i])) {
			return -ENODEV;
		}
	}
	return 0;
}

/** Polls for which lost steps are told as an alarm: more than the controller needs to believe it.
 */
#define LOST_POLLS 10

/** An alarm that is not wired is none. A motor that cannot be given its steps is one. */
static int read_alarm(bool *alarm)
{
	static unsigned int lost_polls;
	const int ret = lw_step_dir_alarm(stepper);

	if (lw_step_dir_take_lost(stepper)) {
		lost_polls = LOST_POLLS;
	}
	*alarm = ret > 0 || lost_polls > 0;
	lost_polls -= lost_polls > 0;
	return ret == -ENOTSUP ? 0 : MIN(ret, 0);
}

int machine_read(struct lw_inputs *inputs)
{
	struct lw_contacts contacts;
	int ret = lw_encoder_read(encoder, &inputs->encoder_a, &inputs->encoder_b);

	if (ret == 0) {
		ret = read_alarm(&inputs->stepper_alarm);
	}

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
	int ret = lw_encoder_counts(encoder)
			  ? lw_encoder_start_counting(encoder, on_encoder_count, NULL)
			  : lw_encoder_start(encoder, on_encoder, NULL);

	for (size_t i = 0; i < ARRAY_SIZE(trim_buttons) && ret == 0; i++) {
		if (trim_buttons[i].port != NULL) {
			ret = gpio_pin_configure_dt(&trim_buttons[i], GPIO_INPUT);
		}
	}

	if (ret == 0) {
		ret = lw_encoder_start_index(encoder, on_encoder_index, NULL);
		ret = ret == -ENOTSUP ? 0 : ret;
	}
	for (int side = 0; side < 2 && ret == 0; side++) {
		ret = lw_contacts_start(overtravels[side], on_overtravel, (void *)(intptr_t)side);
		if (ret == 0) {
			ret = read_overtravel(side);
		}
	}
	return ret;
}

/** Levels of the buttons; one that is not wired is not pressed. */
static int poll_trim_buttons(void)
{
	bool pressed[ARRAY_SIZE(trim_buttons)] = {false};

	for (size_t i = 0; i < ARRAY_SIZE(trim_buttons); i++) {
		const int level =
			trim_buttons[i].port == NULL ? 0 : gpio_pin_get_dt(&trim_buttons[i]);

		if (level < 0) {
			return level;
		}
		pressed[i] = level > 0;
	}
	lw_device_trim_buttons(&app_device, pressed);
	return 0;
}

int machine_poll(void)
{
	bool alarm;
	int ret = read_alarm(&alarm);

	lw_encoder_poll(encoder);

	if (ret == 0) {
		lw_controller_stepper_alarm(&app_device.controller, alarm);
		ret = poll_trim_buttons();
	}
	app_device.health.encoder_interrupt_max_ns =
		k_cyc_to_ns_ceil32(encoder_interrupt_max_cycles);
	return ret;
}

bool machine_keeps_edges(void)
{
	return lw_encoder_counts(encoder);
}

void machine_stop(void)
{
	(void)lw_step_dir_enable(stepper, false);
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
