/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The firmware's start, and the supervisor that follows it in the main thread.
 */
#include <errno.h>

#include <zephyr/drivers/gpio.h>
#include <zephyr/logging/log.h>

#include "app.h"
#include "clock.h"
#include "image.h"
#include "interrupts.h"
#include "limits.h"
#include "line_driver.h"
#include "machine.h"
#include "modbus.h"
#include "storage.h"
#include "watch.h"
#ifdef CONFIG_LW_SIMULATED_MACHINE
#include "simulated_machine.h"
#endif

LOG_MODULE_REGISTER(levelwind);

struct lw_device app_device;
K_MUTEX_DEFINE(app_lock);

static const struct gpio_dt_spec default_settings =
	GPIO_DT_SPEC_GET_OR(APP_NODE, default_settings_gpios, {0});

static struct lw_store store;

static struct lw_device_config config = {
	.store = &store,
	.host = (enum lw_host)CONFIG_LW_HOST,
	.silence_us = CONFIG_LW_MODBUS_SILENCE_US,
};

static int read_default_settings(bool *wanted)
{
	int ret;

	*wanted = false;
	if (default_settings.port == NULL) {
		return 0;
	}
	if (!gpio_is_ready_dt(&default_settings)) {
		return -ENODEV;
	}
	ret = gpio_pin_configure_dt(&default_settings, GPIO_INPUT);
	if (ret == 0) {
		ret = gpio_pin_get_dt(&default_settings);
	}
	*wanted = ret > 0;
	return MIN(ret, 0);
}

/** Bring the controller up from what is stored, with no interrupt in between. */
static int power_up(void)
{
	struct lw_inputs inputs;
	unsigned int key;
	int ret;

	storage_load(&store);
	key = irq_lock();
	ret = machine_read(&inputs);
	if (ret == 0) {
		lw_device_init(&app_device, &config, &inputs, app_now_us(), app_now_us());
	}
	irq_unlock(key);
	return ret;
}

static int start(void)
{
	int ret = machine_check();

	config.image_hash = image_sha256_head();
	config.watchdog_reset = watch_has_restarted();
	config.clock_fallback = clock_is_fallback();
	config.unstored = watch_unstored_starts();
	config.kept = watch_kept();
	config.edges_are_kept = machine_keeps_edges();
	if (ret == 0) {
		ret = read_default_settings(&config.default_line);
	}
#ifdef CONFIG_LW_SIMULATED_MACHINE
	if (ret == 0) {
		ret = simulated_machine_start();
		config.host_section = simulated_machine_section();
	}
#endif
	if (ret == 0 && storage_start() != 0) {
		LOG_ERR("no storage: factory parameters, and none can be saved");
	}
	if (ret == 0) {
		ret = power_up();
	}
	if (ret == 0) {
		ret = machine_start();
	}
	if (ret == 0) {
		ret = limits_start();
	}
	return ret ? ret : modbus_start();
}

/** Ticks between two looks at a stack. */
#define MEASURE_TICKS 200

/** One tick, and what follows from it outside of the core. */
static int supervise(void)
{
	static uint32_t ticks;
	int ret;

	k_mutex_lock(&app_lock, K_FOREVER);
	ret = machine_poll();
#ifdef CONFIG_LW_SIMULATED_MACHINE
	bool memory_kept;

	if (ret == 0 && simulated_machine_power_cut(&memory_kept)) {
		config.watchdog_reset = memory_kept;
		if (!memory_kept) {
			*config.kept = (struct lw_kept){0};
		}
		ret = power_up();
	}
	simulated_machine_note_indexed(app_device.controller.indexed);
#endif
	/* The time is taken under the lock, so that no contact change is later than the tick. */
	lw_device_tick(&app_device, app_now_us());
	storage_serve();
	if (ret == 0) {
		ret = machine_serve_outputs();
	}
	k_mutex_unlock(&app_lock);
	if (++ticks % MEASURE_TICKS == 0) {
		watch_measure_stacks(&app_device.health);
	}
	return ret;
}

int main(void)
{
	struct k_timer ticks;
	int added;
	int ret;

	interrupts_start();
	k_thread_priority_set(k_current_get(), APP_PRIORITY_SUPERVISOR);
	(void)line_driver_let_go();
	ret = watch_start();
	if (ret == 0) {
		ret = start();
		/* After the loading, which takes its time; also when the start has failed: then
		 * nobody will report. */
		added = watch_add(WATCH_SUPERVISOR);
		ret = ret ? ret : added;
	}
	k_timer_init(&ticks, NULL, NULL);
	k_timer_start(&ticks, K_USEC(LW_CONTROLLER_TICK_US), K_USEC(LW_CONTROLLER_TICK_US));
	while (ret == 0) {
		(void)k_timer_status_sync(&ticks);
		watch_report(WATCH_SUPERVISOR);
		ret = supervise();
	}
	/* A driver has failed. The watchdog restarts what cannot go on. */
	LOG_ERR("stopped: error %d", ret);
	return ret;
}
