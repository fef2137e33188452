/* SPDX-License-Identifier: Apache-2.0 */
#include "simulated_machine.h"

#include <zephyr/drivers/gpio.h>
#include <zephyr/drivers/gpio/gpio_emul.h>

#include "app.h"
#include "lw/plant.h"
#include "lw/plant_bench.h"
#include "watch.h"

#define MACHINE_PIN(device, pin) GPIO_DT_SPEC_GET(DT_PHANDLE(APP_NODE, device), pin)

static const struct gpio_dt_spec encoder_a = MACHINE_PIN(encoder, a_gpios);
static const struct gpio_dt_spec encoder_b = MACHINE_PIN(encoder, b_gpios);
static const struct gpio_dt_spec encoder_index = MACHINE_PIN(encoder, index_gpios);
static const struct gpio_dt_spec step = MACHINE_PIN(stepper, step_gpios);
static const struct gpio_dt_spec dir = MACHINE_PIN(stepper, dir_gpios);
static const struct gpio_dt_spec enable = MACHINE_PIN(stepper, enable_gpios);
static const struct gpio_dt_spec alarm = MACHINE_PIN(stepper, alarm_gpios);
static const struct gpio_dt_spec trim_buttons[] = {
	GPIO_DT_SPEC_GET(APP_NODE, trim_early_gpios),
	GPIO_DT_SPEC_GET(APP_NODE, trim_late_gpios),
};
static const struct {
	struct gpio_dt_spec no;
	struct gpio_dt_spec nc;
	struct gpio_dt_spec overtravel_nc;
} sides[] = {
	[LW_PLANT_PLUS] = {MACHINE_PIN(limit_plus, no_gpios), MACHINE_PIN(limit_plus, nc_gpios),
			   MACHINE_PIN(overtravel_plus, nc_gpios)},
	[LW_PLANT_MINUS] = {MACHINE_PIN(limit_minus, no_gpios), MACHINE_PIN(limit_minus, nc_gpios),
			    MACHINE_PIN(overtravel_minus, nc_gpios)},
};

/* Owned by the interrupt; whoever else works on it keeps the interrupt out. */
static struct lw_plant plant;
static struct lw_plant_bench bench;

static struct lw_bank_section bench_section;   /**< of the bench itself */
static struct lw_bank_section guarded_section; /**< the same with the interrupt kept out */
static struct gpio_callback outputs;
static bool step_level;
static bool bringing; /**< events are being brought up to now */
static bool was_indexed;
static bool has_current;
static enum lw_bench_restart restart;

static void set_input(const struct gpio_dt_spec *pin, bool active)
{
	const bool active_low = (pin->dt_flags & GPIO_ACTIVE_LOW) != 0;

	(void)gpio_emul_input_set(pin->port, pin->pin, active != active_low);
}

static bool output(const struct gpio_dt_spec *pin)
{
	const bool active_low = (pin->dt_flags & GPIO_ACTIVE_LOW) != 0;

	return (gpio_emul_output_get(pin->port, pin->pin) > 0) != active_low;
}

static void set_encoder(uint32_t changed)
{
	/* One channel after the other, unless the plant has changed both at once. */
	if ((changed & LW_PLANT_ENCODER) == LW_PLANT_ENCODER) {
		const gpio_port_value_t levels =
			((gpio_port_value_t)plant.pins.encoder_a << encoder_a.pin) |
			((gpio_port_value_t)plant.pins.encoder_b << encoder_b.pin);

		(void)gpio_emul_input_set_masked(encoder_a.port,
						 BIT(encoder_a.pin) | BIT(encoder_b.pin), levels);
	} else if (changed & LW_PLANT_ENCODER_A) {
		set_input(&encoder_a, plant.pins.encoder_a);
	} else if (changed & LW_PLANT_ENCODER_B) {
		set_input(&encoder_b, plant.pins.encoder_b);
	}
	if (changed & LW_PLANT_ENCODER_INDEX) {
		set_input(&encoder_index, plant.pins.encoder_index);
	}
}

static void set_switches(uint32_t changed)
{
	for (int side = 0; side < LW_PLANT_SIDES; side++) {
		const bool plus = side == LW_PLANT_PLUS;

		if (changed & (plus ? LW_PLANT_LIMIT_PLUS : LW_PLANT_LIMIT_MINUS)) {
			set_input(&sides[side].no, plant.pins.limit[side].no_closed);
			set_input(&sides[side].nc, plant.pins.limit[side].nc_closed);
		}
		if (changed & (plus ? LW_PLANT_OVERTRAVEL_PLUS : LW_PLANT_OVERTRAVEL_MINUS)) {
			set_input(&sides[side].overtravel_nc, !plant.pins.overtravel[side]);
		}
	}
}

static void set_trim_buttons(void)
{
	for (size_t i = 0; i < ARRAY_SIZE(trim_buttons); i++) {
		set_input(&trim_buttons[i], plant.pins.trim_buttons[i]);
	}
}

/**
 * Bring every event up to now, each with the controller's answer to it. The interrupt is kept out,
 * or is the caller.
 */
static void bring_events(void)
{
	const uint64_t now_ns = app_now_us() * NSEC_PER_USEC;

	if (bringing) {
		return; /* called by the answer to an event: the plant is at its time already */
	}
	bringing = true;
	while (lw_plant_next_event_ns(&plant) <= now_ns) {
		const uint32_t changed = lw_plant_advance(&plant);

		set_encoder(changed);
		set_switches(changed);
		if (changed & LW_PLANT_STEPPER_ALARM) {
			set_input(&alarm, plant.pins.stepper_alarm);
		}
		if (changed & LW_PLANT_TRIM_BUTTONS) {
			set_trim_buttons();
		}
	}
	bringing = false;
}

/** An output has been written. Called from whatever context has written it. */
static void on_output(const struct device *port, struct gpio_callback *callback,
		      gpio_port_pins_t pins)
{
	const unsigned int key = irq_lock();

	ARG_UNUSED(port);
	ARG_UNUSED(callback);
	bring_events();
	if (pins & BIT(step.pin)) {
		const bool level = output(&step);

		if (level && !step_level) {
			lw_plant_step(&plant, output(&dir) ? 1 : -1);
		}
		step_level = level;
	}
	if (pins & BIT(enable.pin)) {
		has_current = output(&enable);
		lw_plant_enable(&plant, has_current);
	}
	irq_unlock(key);
}

static void on_timer(struct k_timer *timer)
{
	ARG_UNUSED(timer);
	bring_events();
}

static K_TIMER_DEFINE(timer, on_timer, NULL);

static const void *image(void *context)
{
	const unsigned int key = irq_lock();
	const void *registers = bench_section.image(context);

	irq_unlock(key);
	return registers;
}

static void store(void *context, const struct lw_point *point, uint16_t element, int32_t value)
{
	const unsigned int key = irq_lock();

	bench_section.store(context, point, element, value);
	irq_unlock(key);
}

int simulated_machine_start(void)
{
	struct lw_plant_config config;
	int ret;

	lw_plant_config_default(&config);
	ret = lw_plant_init(&plant, &config, 1);
	if (ret) {
		return ret;
	}
	lw_plant_bench_init(&bench, &plant);
	bench.threads = true;
	bench.registers.bench_restart = restart;
	bench_section = lw_plant_bench_section(&bench);
	guarded_section = bench_section;
	guarded_section.image = image;
	guarded_section.store = store;

	set_encoder(LW_PLANT_ENCODER | LW_PLANT_ENCODER_INDEX);
	set_input(&alarm, plant.pins.stepper_alarm);
	set_trim_buttons();
	set_switches(UINT32_MAX);
	gpio_init_callback(&outputs, on_output, BIT(step.pin) | BIT(enable.pin));
	ret = gpio_add_callback(step.port, &outputs);
	if (ret == 0) {
		k_timer_start(&timer, K_USEC(CONFIG_LW_SIMULATED_MACHINE_PERIOD_US),
			      K_USEC(CONFIG_LW_SIMULATED_MACHINE_PERIOD_US));
	}
	return ret;
}

const struct lw_bank_section *simulated_machine_section(void)
{
	return &guarded_section;
}

void simulated_machine_note_indexed(bool indexed)
{
	if (indexed && !was_indexed) {
		const unsigned int key = irq_lock();

		lw_plant_reference(&plant);
		irq_unlock(key);
	}
	was_indexed = indexed;
}

bool simulated_machine_has_current(void)
{
	return has_current;
}

void simulated_machine_note_restart(enum lw_bench_restart noted)
{
	restart = noted;
}

/** Does not return. A fault of native_sim would be one of the host's program. */
static void fault(void)
{
#ifdef CONFIG_ARCH_POSIX
	k_panic();
#else
	__builtin_trap();
#endif
}

void simulated_machine_hang(int thread)
{
	if (bench.hang == LW_BENCH_THREAD_FAULT && thread == WATCH_MODBUS) {
		fault();
	}
	/* The bench counts threads from 1. Waiting busily, because else no time passes on
	 * native_sim. */
	while ((int)bench.hang == thread + 1) {
		k_busy_wait(USEC_PER_MSEC);
	}
}

bool simulated_machine_power_cut(bool *memory_kept)
{
	const bool power_cut = bench.power_cut;

	bench.power_cut = false;
	*memory_kept = bench.memory_kept;
	return power_cut;
}
