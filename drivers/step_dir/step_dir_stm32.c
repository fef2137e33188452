/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Step and direction outputs with the pulse made by a timer of an STM32 in one-pulse mode: no
 * waiting in the interrupt that steps. Which timer, channel and pins: the board's overlay. PWM mode
 * 1 with preload: the output is active below the compare value, which an update by software brings
 * into force, so that the pulse begins at once. By then the preloaded value is 0 again, which comes
 * into force at the end of the period, where the counter stops: a standing timer gives no pulse.
 */
#define DT_DRV_COMPAT levelwind_step_dir_stm32

#include <errno.h>

#include <soc.h>
#include <stm32_ll_tim.h>
#include <zephyr/drivers/pinctrl.h>
#include <zephyr/irq.h>
#include <zephyr/logging/log.h>

#include "../stm32_timer.h"
#include "lw/drivers/step_dir.h"
#include "step_dir_pins.h"
#include "step_train.h"

LOG_MODULE_REGISTER(step_dir_stm32);

/** Longest run: the timer may have 16 bits. */
#define TICKS_MAX UINT16_MAX
#define NO_PULSE  0

struct step_dir_config {
	TIM_TypeDef *timer;
	struct lw_stm32_timer source;
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

/** Owned by whoever keeps the timer's interrupt out, or has its priority. */
struct step_dir_data {
	struct step_train_config train_config;
	struct step_train train;
	uint32_t pulse_reload; /**< auto-reload value of a pulse with its space */
};

static inline void begin(TIM_TypeDef *timer)
{
	timer->SR = ~TIM_SR_UIF;
	LL_TIM_EnableCounter(timer);
}

/** Begin a pulse with its space, of a timer that stands. */
static inline void begin_pulse(const struct step_dir_config *config,
			       const struct step_dir_data *data)
{
	TIM_TypeDef *const timer = config->timer;
	volatile uint32_t *const compare = config->compare;

	timer->ARR = data->pulse_reload;
	*compare = data->train_config.step_pulse_ticks;
	timer->EGR = TIM_EGR_UG;
	*compare = NO_PULSE;
	begin(timer);
}

/** Start the next run of the timer, which stands. */
static void start_run(const struct device *dev)
{
	const struct step_dir_config *config = dev->config;
	struct step_dir_data *data = dev->data;
	struct step_run next;

	if (!step_train_next(&data->train, &data->train_config, &next)) {
		LL_TIM_DisableIT_UPDATE(config->timer);
		return;
	}
	if (next.set_direction != 0) {
		(void)gpio_pin_set_dt(&config->pins.dir, next.set_direction > 0);
	}
	/* The end of the run matters to what waits for it. */
	if (step_train_goes_on(&data->train)) {
		LL_TIM_EnableIT_UPDATE(config->timer);
	} else {
		LL_TIM_DisableIT_UPDATE(config->timer);
	}
	if (next.pulse_ticks > 0) {
		begin_pulse(config, data);
	} else {
		config->timer->ARR = next.rest_ticks - 1;
		begin(config->timer);
	}
}

/** Let what has been asked for begin, or follow the run that is under way. */
static void go_on(const struct device *dev)
{
	const struct step_dir_config *config = dev->config;

	if (LL_TIM_IsEnabledCounter(config->timer)) {
		/* If the run ends just now its flag is set, and this interrupts at once. */
		LL_TIM_EnableIT_UPDATE(config->timer);
	} else {
		start_run(dev);
	}
}

static void step_dir_step(const struct device *dev, int steps)
{
	const struct step_dir_config *config = dev->config;
	struct step_dir_data *data = dev->data;

	if (!LL_TIM_IsEnabledCounter(config->timer) && step_train_is_next(&data->train, steps)) {
		/* As nearly always, and what start_run() would come to. */
		begin_pulse(config, data);
	} else {
		step_train_add(&data->train, steps);
		go_on(dev);
	}
}

static void step_dir_prepare(const struct device *dev, int direction)
{
	struct step_dir_data *data = dev->data;

	data->train.prepared = (int8_t)direction;
	go_on(dev);
}

static bool step_dir_take_lost(const struct device *dev)
{
	struct step_dir_data *data = dev->data;
	const unsigned int key = irq_lock();
	const bool lost = data->train.lost;

	data->train.lost = false;
	irq_unlock(key);
	return lost;
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

static void configure_timer(const struct step_dir_config *config)
{
	TIM_TypeDef *timer = config->timer;

	LL_TIM_SetPrescaler(timer, config->prescaler);
	LL_TIM_SetUpdateSource(timer, LL_TIM_UPDATESOURCE_COUNTER);
	LL_TIM_SetOnePulseMode(timer, LL_TIM_ONEPULSEMODE_SINGLE);
	LL_TIM_DisableARRPreload(timer);
	*config->compare = NO_PULSE;
	LL_TIM_OC_EnablePreload(timer, config->channel);
	LL_TIM_OC_SetMode(timer, config->channel, LL_TIM_OCMODE_PWM1);
	LL_TIM_GenerateEvent_UPDATE(timer); /* prescaler and compare value are in force */
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
		ret = lw_stm32_timer_on(&config->source, &hz);
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
	if (ret) {
		return ret;
	}
	data->pulse_reload =
		data->train_config.step_pulse_ticks + data->train_config.step_space_ticks - 1;
	configure_timer(config);
	config->connect();
	return pinctrl_apply_state(config->pinctrl, PINCTRL_STATE_DEFAULT);
}

static const struct lw_step_dir_api step_dir_api = {
	.step = step_dir_step,
	.prepare = step_dir_prepare,
	.take_lost = step_dir_take_lost,
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
		.source = LW_STM32_TIMER(TIMER(inst)),                                             \
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
