/* SPDX-License-Identifier: Apache-2.0 */
/*
 * An incremental encoder counted by a 32-bit timer of an STM32 in encoder mode. The compares of two
 * of its channels stand to either side of the count, so that what is due next interrupts, whichever
 * way the drum goes. An interrupt that comes late, by other interrupts or by a processor that
 * stands while its flash is erased, finds the count, and all transitions up to it are taken then.
 *
 * A drum that goes on interrupts where the callback says that something is due. One that has turned
 * back a moment ago, or has met no compare between two polls, interrupts with every transition: so
 * a channel that changes alone is seen as often as it does.
 */
#define DT_DRV_COMPAT levelwind_encoder_stm32

#include <errno.h>

#include <soc.h>
#include <stm32_ll_tim.h>
#include <zephyr/drivers/gpio.h>
#include <zephyr/drivers/pinctrl.h>
#include <zephyr/irq.h>
#include <zephyr/kernel.h>
#include <zephyr/logging/log.h>

#include "../stm32_timer.h"
#include "encoder_index.h"
#include "lw/drivers/encoder.h"

LOG_MODULE_REGISTER(encoder_stm32);

/** So often are levels and count read until no transition falls in between. */
#define READS_MAX 100

struct encoder_config {
	TIM_TypeDef *timer;
	struct lw_stm32_timer source;
	const struct pinctrl_dev_config *pinctrl;
	struct gpio_dt_spec a; /**< to read the level; the timer has the pin */
	struct gpio_dt_spec b;
	struct gpio_dt_spec index; /**< index.port is NULL where it is not wired */
	uint32_t filter_ns;
	void (*connect)(void);
};

/** Ways of the last calls, a bit each: those of a drum that rocks. */
#define ROCKING 0x55555555u

/** Written before the interrupts are enabled, then by them, or where they are kept out. */
struct encoder_data {
	uint32_t seen;   /**< the count up to which transitions have been told */
	uint32_t polled; /**< `seen` at the last poll */
	uint32_t ways;   /**< of the last calls, 1 while B led A */
	lw_encoder_count_callback callback;
	void *user_data;
	const struct device *dev;
	struct encoder_index index;
	uint32_t settle_us; /**< a level that stands so long has passed the filter */
};

static inline bool goes_on(const struct encoder_data *data)
{
	return data->ways + 1 <= 1;
}

/** Tell all transitions up to now, and let the next one that is due interrupt. */
static inline void catch_up(TIM_TypeDef *timer, struct encoder_data *data)
{
	uint32_t seen = data->seen;
	uint32_t count;

	/* First: a compare that is met from here on sets its flag again. */
	timer->SR = ~(TIM_SR_CC3IF | TIM_SR_CC4IF);
	count = timer->CNT;
	while (count != seen) {
		const int32_t transitions = (int32_t)(count - seen);
		uint32_t due = data->callback(transitions, data->user_data);
		uint32_t above;

		data->ways = data->ways << 1 | (uint32_t)transitions >> 31;
		due = goes_on(data) ? due : 1;
		above = transitions > 0 ? due : 1;
		seen = count;
		timer->CCR3 = seen + above;
		timer->CCR4 = seen + above - (due + 1);
		/* What was passed before the compares were set has met none of them. */
		count = timer->CNT;
		if (seen + above - 1 - count < due) {
			break;
		}
	}
	data->seen = seen;
}

static void encoder_poll(const struct device *dev)
{
	TIM_TypeDef *const timer = ((const struct encoder_config *)dev->config)->timer;
	struct encoder_data *data = dev->data;
	const unsigned int key = irq_lock();

	if (data->seen == data->polled) {
		data->ways = ROCKING;
		timer->CCR3 = data->seen + 1;
		timer->CCR4 = data->seen - 1;
	}
	catch_up(timer, data);
	data->polled = data->seen;
	irq_unlock(key);
}

static void on_index(const struct device *port, struct gpio_callback *gpio, gpio_port_pins_t pins)
{
	struct encoder_data *data = CONTAINER_OF(gpio, struct encoder_data, index.gpio);
	const struct encoder_config *config = data->dev->config;
	/* A pulse that is over began an unknown time ago. While it stands, the count is in it. */
	const bool late = gpio_pin_get_dt(&config->index) <= 0;

	ARG_UNUSED(port);
	ARG_UNUSED(pins);
	catch_up(config->timer, data);
	data->index.callback(late, data->index.user_data);
}

static int read_level(const struct gpio_dt_spec *pin, bool *level)
{
	gpio_port_value_t levels;
	const int ret = gpio_port_get_raw(pin->port, &levels);

	*level = (levels >> pin->pin & 1u) != 0;
	return ret;
}

static int read_levels(const struct encoder_config *config, bool *a, bool *b)
{
	const int ret = read_level(&config->a, a);

	return ret ? ret : read_level(&config->b, b);
}

static int encoder_read(const struct device *dev, bool *a, bool *b)
{
	const struct encoder_config *config = dev->config;
	struct encoder_data *data = dev->data;

	/* Levels and count are of one moment where neither changes while the filter settles. */
	for (int i = 0; i < READS_MAX; i++) {
		bool a_before = false;
		bool b_before = false;
		int ret = read_levels(config, &a_before, &b_before);

		data->seen = config->timer->CNT;
		k_busy_wait(data->settle_us);
		if (ret == 0) {
			ret = read_levels(config, a, b);
		}
		if (ret) {
			return ret;
		}
		if (*a == a_before && *b == b_before && config->timer->CNT == data->seen) {
			break;
		}
	}
	return 0;
}

static int encoder_start_counting(const struct device *dev, lw_encoder_count_callback callback,
				  void *user_data)
{
	const struct encoder_config *config = dev->config;
	struct encoder_data *data = dev->data;

	data->callback = callback;
	data->user_data = user_data;
	data->ways = ROCKING;
	data->polled = data->seen;
	config->timer->CCR3 = data->seen + 1;
	config->timer->CCR4 = data->seen - 1;
	LL_TIM_EnableIT_CC3(config->timer);
	LL_TIM_EnableIT_CC4(config->timer);
	/* What has changed since the levels were read. */
	LL_TIM_GenerateEvent_CC3(config->timer);
	config->connect();
	return 0;
}

static int encoder_start_index(const struct device *dev, lw_encoder_index_callback callback,
			       void *user_data)
{
	const struct encoder_config *config = dev->config;
	struct encoder_data *data = dev->data;

	return encoder_index_start(&data->index, &config->index, on_index, callback, user_data);
}

/** The longest filter that takes no longer, by its periods (RM0390, 17.4.7, IC1F; CKD is 0). */
static uint32_t filter_code(uint32_t timer_hz, uint32_t filter_ns, uint32_t *settle_us)
{
	static const uint16_t periods[] = {0,  2,  4,  8,  12,  16,  24,  32,
					   48, 64, 80, 96, 128, 160, 192, 256};
	const uint64_t most = (uint64_t)filter_ns * timer_hz / NSEC_PER_SEC;
	uint32_t code = ARRAY_SIZE(periods) - 1;

	while (periods[code] > most) {
		code--;
	}
	/* Up to one more sample, of 32 periods at most. */
	*settle_us = DIV_ROUND_UP((periods[code] + 32u) * USEC_PER_SEC, timer_hz);
	return code;
}

static void configure_timer(TIM_TypeDef *timer, uint32_t filter)
{
	LL_TIM_SetAutoReload(timer, UINT32_MAX);
	timer->CCMR1 = TIM_CCMR1_CC1S_0 | TIM_CCMR1_CC2S_0 | filter << TIM_CCMR1_IC1F_Pos |
		       filter << TIM_CCMR1_IC2F_Pos;
	LL_TIM_SetEncoderMode(timer, LL_TIM_ENCODERMODE_X4_TI12);
	LL_TIM_EnableCounter(timer);
}

static int encoder_init(const struct device *dev)
{
	const struct encoder_config *config = dev->config;
	struct encoder_data *data = dev->data;
	uint32_t hz;
	int ret = lw_stm32_timer_on(&config->source, &hz);

	data->dev = dev;
	if (ret == 0) {
		ret = pinctrl_apply_state(config->pinctrl, PINCTRL_STATE_DEFAULT);
	}
	if (ret == 0 && config->index.port != NULL) {
		ret = gpio_is_ready_dt(&config->index)
			      ? gpio_pin_configure_dt(&config->index, GPIO_INPUT)
			      : -ENODEV;
	}
	if (ret) {
		return ret;
	}
	configure_timer(config->timer, filter_code(hz, config->filter_ns, &data->settle_us));
	return 0;
}

static const struct lw_encoder_api encoder_api = {
	.start_counting = encoder_start_counting,
	.poll = encoder_poll,
	.start_index = encoder_start_index,
	.read = encoder_read,
};

#define TIMER(inst) DT_INST_PARENT(inst)

/*
 * A direct interrupt: the kernel has nothing to do with it, so it goes by neither the table of
 * handlers nor the exit that looks for another thread. ISR_DIRECT_DECLARE() would align the stack
 * once more, which the processor has done (ARMv7-M, B1.5.7): five instructions.
 */
#define ENCODER_DEFINE(inst)                                                                       \
	BUILD_ASSERT(DT_REG_ADDR(TIMER(inst)) == TIM2_BASE ||                                      \
			     DT_REG_ADDR(TIMER(inst)) == TIM5_BASE,                                \
		     "levelwind,encoder-stm32: the timer must have 32 bits");                      \
	PINCTRL_DT_INST_DEFINE(inst);                                                              \
	static struct encoder_data encoder_data_##inst;                                            \
	static void on_compare_##inst(void)                                                        \
	{                                                                                          \
		catch_up((TIM_TypeDef *)DT_REG_ADDR(TIMER(inst)), &encoder_data_##inst);           \
	}                                                                                          \
	static void connect_##inst(void)                                                           \
	{                                                                                          \
		IRQ_DIRECT_CONNECT(DT_IRQ_BY_NAME(TIMER(inst), global, irq),                       \
				   DT_IRQ_BY_NAME(TIMER(inst), global, priority),                  \
				   on_compare_##inst, 0);                                          \
		irq_enable(DT_IRQ_BY_NAME(TIMER(inst), global, irq));                              \
	}                                                                                          \
	static const struct encoder_config encoder_config_##inst = {                               \
		.timer = (TIM_TypeDef *)DT_REG_ADDR(TIMER(inst)),                                  \
		.source = LW_STM32_TIMER(TIMER(inst)),                                             \
		.pinctrl = PINCTRL_DT_INST_DEV_CONFIG_GET(inst),                                   \
		.a = GPIO_DT_SPEC_INST_GET(inst, a_gpios),                                         \
		.b = GPIO_DT_SPEC_INST_GET(inst, b_gpios),                                         \
		.index = GPIO_DT_SPEC_INST_GET_OR(inst, index_gpios, {0}),                         \
		.filter_ns = DT_INST_PROP(inst, filter_ns),                                        \
		.connect = connect_##inst,                                                         \
	};                                                                                         \
	DEVICE_DT_INST_DEFINE(inst, encoder_init, NULL, &encoder_data_##inst,                      \
			      &encoder_config_##inst, POST_KERNEL,                                 \
			      CONFIG_KERNEL_INIT_PRIORITY_DEVICE, &encoder_api);

DT_INST_FOREACH_STATUS_OKAY(ENCODER_DEFINE)
