/*
 * Step and direction outputs with the pulse made by a timer of an STM32 in one-pulse mode: no
 * waiting in the interrupt that steps. PWM mode 2: the output is inactive below the compare value,
 * active from there to the end of the period, where the counter stops.
 */
#define DT_DRV_COMPAT levelwind_step_dir_stm32

#include <errno.h>

#include <soc.h>
#include <stm32_ll_rcc.h>
#include <stm32_ll_tim.h>
#include <zephyr/drivers/clock_control/stm32_clock_control.h>
#include <zephyr/drivers/pinctrl.h>
#include <zephyr/drivers/reset.h>
#include <zephyr/irq.h>
#include <zephyr/logging/log.h>

#include "lw/drivers/step_dir.h"
#include "step_dir_pins.h"
#include "step_train.h"

LOG_MODULE_REGISTER(step_dir_stm32);

/** Longest run, and the compare value that no run reaches: the timer may have 16 bits. */
#define TICKS_MAX UINT16_MAX
#define NO_PULSE  UINT16_MAX

struct step_dir_config {
	TIM_TypeDef *timer;
	struct stm32_pclken clock;
	struct reset_dt_spec reset;
	const struct pinctrl_dev_config *pinctrl;
	uint32_t prescaler;
	uint32_t channel; /**< LL_TIM_CHANNEL_CH1.. */
	volatile uint32_t *compare;
	bool step_inverted;
	struct step_dir_pins pins;
	uint32_t dir_setup_ns;
	uint32_t dir_hold_ns;
	uint32_t step_pulse_ns;
	uint32_t step_space_ns;
	void (*connect)(void);
};

/** Owned by whoever keeps the timer's interrupt out. */
struct step_dir_data {
	struct step_train_config train_config;
	struct step_train train;
};

/** Start the next run of the timer, which stands. */
static void start_run(const struct device *dev)
{
	const struct step_dir_config *config = dev->config;
	struct step_dir_data *data = dev->data;
	struct step_run run;

	if (!step_train_next(&data->train, &data->train_config, &run)) {
		LL_TIM_DisableIT_UPDATE(config->timer);
		return;
	}
	if (run.set_direction != 0) {
		(void)gpio_pin_set_dt(&config->pins.dir, run.set_direction > 0);
	}
	*config->compare = run.pulse_ticks > 0 ? run.delay_ticks : NO_PULSE;
	LL_TIM_SetAutoReload(config->timer, run.delay_ticks + run.pulse_ticks - 1);
	LL_TIM_ClearFlag_UPDATE(config->timer);
	/* The end of the run matters to steps that wait for it. */
	if (data->train.waiting != 0) {
		LL_TIM_EnableIT_UPDATE(config->timer);
	} else {
		LL_TIM_DisableIT_UPDATE(config->timer);
	}
	LL_TIM_EnableCounter(config->timer);
}

static void step_dir_step(const struct device *dev, int direction)
{
	const struct step_dir_config *config = dev->config;
	struct step_dir_data *data = dev->data;
	/* The interrupt that steps may be of a lower priority than the timer's. */
	const unsigned int key = irq_lock();

	step_train_add(&data->train, direction);
	if (LL_TIM_IsEnabledCounter(config->timer)) {
		/* If the run ends just now its flag is set, and this interrupts at once. */
		LL_TIM_EnableIT_UPDATE(config->timer);
	} else {
		start_run(dev);
	}
	irq_unlock(key);
}

static void on_end_of_run(const struct device *dev)
{
	const struct step_dir_config *config = dev->config;

	/* A step may have come first, and started the next run. */
	if (LL_TIM_IsActiveFlag_UPDATE(config->timer)) {
		LL_TIM_ClearFlag_UPDATE(config->timer);
		start_run(dev);
	}
}

static int step_dir_enable(const struct device *dev, bool enabled)
{
	return step_dir_pins_enable(&((const struct step_dir_config *)dev->config)->pins, enabled);
}

static int step_dir_alarm(const struct device *dev)
{
	return step_dir_pins_alarm(&((const struct step_dir_config *)dev->config)->pins);
}

/** Timers run at twice their bus's clock where that is divided (RM0390, 6.2, with TIMPRE off). */
static int timer_clock_hz(const struct stm32_pclken *clock, uint32_t *hz)
{
	const uint32_t divider =
		clock->bus == STM32_CLOCK_BUS_APB1 ? STM32_APB1_PRESCALER : STM32_APB2_PRESCALER;
	const int ret = clock_control_get_rate(DEVICE_DT_GET(STM32_CLOCK_CONTROL_NODE),
					       (clock_control_subsys_t)clock, hz);

	if (ret == 0 && divider > 1) {
		*hz *= 2;
	}
	return ret;
}

static void configure_timer(const struct step_dir_config *config)
{
	TIM_TypeDef *timer = config->timer;

	LL_TIM_SetPrescaler(timer, config->prescaler);
	LL_TIM_SetUpdateSource(timer, LL_TIM_UPDATESOURCE_COUNTER);
	LL_TIM_GenerateEvent_UPDATE(timer); /* the prescaler counts from here on */
	LL_TIM_SetOnePulseMode(timer, LL_TIM_ONEPULSEMODE_SINGLE);
	LL_TIM_DisableARRPreload(timer);
	*config->compare = NO_PULSE; /* before the output: 0 would be a pulse without an end */
	LL_TIM_OC_DisablePreload(timer, config->channel);
	LL_TIM_OC_SetMode(timer, config->channel, LL_TIM_OCMODE_PWM2);
	LL_TIM_OC_SetPolarity(timer, config->channel,
			      config->step_inverted ? LL_TIM_OCPOLARITY_LOW
						    : LL_TIM_OCPOLARITY_HIGH);
	LL_TIM_CC_EnableChannel(timer, config->channel);
	if (IS_TIM_BREAK_INSTANCE(timer)) {
		LL_TIM_EnableAllOutputs(timer);
	}
}

static int step_dir_init(const struct device *dev)
{
	const struct step_dir_config *config = dev->config;
	struct step_dir_data *data = dev->data;
	uint32_t hz;
	int ret = step_dir_pins_configure(&config->pins);

	if (ret == 0) {
		ret = clock_control_on(DEVICE_DT_GET(STM32_CLOCK_CONTROL_NODE),
				       (clock_control_subsys_t)&config->clock);
	}
	if (ret == 0) {
		ret = timer_clock_hz(&config->clock, &hz);
	}
	if (ret == 0) {
		ret = step_train_configure(&data->train_config, hz / (config->prescaler + 1),
					   config->dir_setup_ns, config->dir_hold_ns,
					   config->step_pulse_ns, config->step_space_ns, TICKS_MAX);
		if (ret) {
			LOG_ERR("%s: the timer counts to %u only: a larger st,prescaler", dev->name,
				TICKS_MAX);
		}
	}
	if (ret == 0) {
		ret = reset_line_toggle_dt(&config->reset);
	}
	if (ret) {
		return ret;
	}
	configure_timer(config);
	config->connect();
	return pinctrl_apply_state(config->pinctrl, PINCTRL_STATE_DEFAULT);
}

static const struct lw_step_dir_api step_dir_api = {
	.step = step_dir_step,
	.enable = step_dir_enable,
	.alarm = step_dir_alarm,
};

#define TIMER(inst)   DT_INST_PARENT(inst)
#define CHANNEL(inst) DT_INST_PROP(inst, channel)

#define STEP_DIR_DEFINE(inst)                                                                      \
	PINCTRL_DT_INST_DEFINE(inst);                                                              \
	static void connect_##inst(void)                                                           \
	{                                                                                          \
		IRQ_CONNECT(DT_IRQ_BY_NAME(TIMER(inst), global, irq),                              \
			    DT_IRQ_BY_NAME(TIMER(inst), global, priority), on_end_of_run,          \
			    DEVICE_DT_INST_GET(inst), 0);                                          \
		irq_enable(DT_IRQ_BY_NAME(TIMER(inst), global, irq));                              \
	}                                                                                          \
	static const struct step_dir_config step_dir_config_##inst = {                             \
		.timer = (TIM_TypeDef *)DT_REG_ADDR(TIMER(inst)),                                  \
		.clock = {.bus = DT_CLOCKS_CELL(TIMER(inst), bus),                                 \
			  .enr = DT_CLOCKS_CELL(TIMER(inst), bits)},                               \
		.reset = RESET_DT_SPEC_GET(TIMER(inst)),                                           \
		.pinctrl = PINCTRL_DT_INST_DEV_CONFIG_GET(inst),                                   \
		.prescaler = DT_PROP(TIMER(inst), st_prescaler),                                   \
		.channel = CONCAT(LL_TIM_CHANNEL_CH, CHANNEL(inst)),                               \
		.compare = &((TIM_TypeDef *)DT_REG_ADDR(TIMER(inst)))->CONCAT(CCR, CHANNEL(inst)), \
		.step_inverted = DT_INST_PROP(inst, step_inverted),                                \
		.pins = STEP_DIR_PINS(inst),                                                       \
		.dir_setup_ns = DT_INST_PROP(inst, dir_setup_ns),                                  \
		.dir_hold_ns = DT_INST_PROP(inst, dir_hold_ns),                                    \
		.step_pulse_ns = DT_INST_PROP(inst, step_pulse_ns),                                \
		.step_space_ns = DT_INST_PROP(inst, step_space_ns),                                \
		.connect = connect_##inst,                                                         \
	};                                                                                         \
	static struct step_dir_data step_dir_data_##inst;                                          \
	DEVICE_DT_INST_DEFINE(inst, step_dir_init, NULL, &step_dir_data_##inst,                    \
			      &step_dir_config_##inst, POST_KERNEL,                                \
			      CONFIG_KERNEL_INIT_PRIORITY_DEVICE, &step_dir_api);

DT_INST_FOREACH_STATUS_OKAY(STEP_DIR_DEFINE)
