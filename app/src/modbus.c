/* SPDX-License-Identifier: Apache-2.0 */
#include "modbus.h"

#include <errno.h>

#ifdef CONFIG_UART_STM32
#include <zephyr/drivers/clock_control/stm32_clock_control.h>
#endif
#include <zephyr/drivers/uart.h>
#include <zephyr/logging/log.h>

#include "app.h"
#include "line_driver.h"
#include "watch.h"

LOG_MODULE_DECLARE(levelwind);

static const struct device *const uart = DEVICE_DT_GET(DT_PHANDLE(APP_NODE, modbus_uart));

static K_THREAD_STACK_DEFINE(stack, 1600);
static struct k_thread thread;

/*
 * What has come, each byte with its time: so the first one after a silence begins a new frame,
 * however late the thread looks. The interrupt fills, the thread takes, after every silence: it has
 * to be room for what comes meanwhile, a whole frame where bytes come in lots.
 */
#define RX_SIZE (CONFIG_LW_MODBUS_SILENCE_US > 0 ? 512u : 128u)
static uint8_t rx_bytes[RX_SIZE];
static uint16_t rx_ticks[RX_SIZE]; /**< low bits of the kernel's; the thread looks soon enough */
static volatile uint32_t rx_end;   /**< written by the interrupt; counts on */
static volatile uint32_t rx_taken; /**< written by the thread, or under its hold */
static K_SEM_DEFINE(rx_begun, 0, 1);

/* What is being sent. The thread's while it holds tx_free, else the interrupt's. */
static struct {
	size_t length;
	size_t sent;
	uint8_t bytes[LW_RTU_FRAME_MAX];
} tx;
static K_SEM_DEFINE(tx_free, 1, 1);

/* Written by who holds tx_free for longer; the thread is above, so it cannot come in between. */
static bool held;

#ifdef CONFIG_UART_STM32
/* Its driver puts the low 16 bits of a divider into the register, and says that all is well. */
#define UART_CLOCKS DT_CLOCKS_CELL(DT_PHANDLE(APP_NODE, modbus_uart), bus)
#define UART_PRESCALER                                                                             \
	(UART_CLOCKS == STM32_CLOCK_BUS_APB1 ? STM32_APB1_PRESCALER : STM32_APB2_PRESCALER)
#define LOWEST_BAUD_RATE 1200
BUILD_ASSERT(DT_PROP(DT_NODELABEL(rcc), clock_frequency) / UART_PRESCALER / LOWEST_BAUD_RATE <=
		     UINT16_MAX,
	     "the UART's clock is too fast for 1200 baud: a larger prescaler of its bus");
#endif

/** What the UART is configured to. The thread's, once it runs. */
static struct lw_line configured;

static void receive(void)
{
	const uint16_t ticks = (uint16_t)k_uptime_ticks();
	uint8_t bytes[32];
	const int count = uart_fifo_read(uart, bytes, sizeof(bytes));

	for (int i = 0; i < count && rx_end - rx_taken < RX_SIZE; i++) {
		rx_bytes[rx_end % RX_SIZE] = bytes[i];
		rx_ticks[rx_end % RX_SIZE] = ticks;
		rx_end++;
	}
	k_sem_give(&rx_begun);
}

static void send(void)
{
	if (tx.sent < tx.length) {
		const int count =
			uart_fifo_fill(uart, &tx.bytes[tx.sent], (int)(tx.length - tx.sent));

		tx.sent += count > 0 ? (size_t)count : 0;
	} else if (uart_irq_tx_complete(uart)) {
		uart_irq_tx_disable(uart);
		line_driver_switch(false);
		k_sem_give(&tx_free);
	}
}

static void on_uart(const struct device *dev, void *user_data)
{
	ARG_UNUSED(user_data);
	while (uart_irq_update(dev) && uart_irq_is_pending(dev)) {
		if (uart_irq_rx_ready(dev)) {
			receive();
		}
		if (uart_irq_tx_ready(dev)) {
			send();
		}
	}
}

/** Hand over what has come, each byte at its time. */
static void hear(struct lw_slave *slave)
{
	while (rx_taken != rx_end) {
		const uint32_t at = rx_taken % RX_SIZE;
		const uint64_t now_ticks = (uint64_t)k_uptime_ticks();
		const uint16_t age_ticks = (uint16_t)((uint16_t)now_ticks - rx_ticks[at]);
		const uint8_t byte = rx_bytes[at];

		rx_taken++;
		lw_slave_receive(slave, &byte, 1, k_ticks_to_us_floor64(now_ticks - age_ticks));
	}
}

/** Drop what has come. */
static void lose(struct lw_slave *slave)
{
	if (rx_taken != rx_end || lw_slave_deadline_us(slave) != UINT64_MAX) {
		lw_slave_lose(slave);
	}
	rx_taken = rx_end;
}

#ifdef CONFIG_UART_USE_RUNTIME_CONFIGURE
static int configure_line(const struct lw_line *line)
{
	struct uart_config config = {
		.baudrate = line->baud_rate,
		.data_bits = UART_CFG_DATA_BITS_8,
		.parity = UART_CFG_PARITY_NONE,
		.stop_bits = UART_CFG_STOP_BITS_1,
		.flow_ctrl = UART_CFG_FLOW_CTRL_NONE,
	};

	switch (line->format) {
	case LW_LINE_FORMAT_8E1:
		config.parity = UART_CFG_PARITY_EVEN;
		break;
	case LW_LINE_FORMAT_8O1:
		config.parity = UART_CFG_PARITY_ODD;
		break;
	case LW_LINE_FORMAT_8N2:
		config.stop_bits = UART_CFG_STOP_BITS_2;
		break;
	case LW_LINE_FORMAT_8N1:
		break;
	}
	return uart_configure(uart, &config);
}
#else
/** The line of this board has no baud rate and no parity. */
static int configure_line(const struct lw_line *line)
{
	ARG_UNUSED(line);
	return 0;
}
#endif

/** Take tx_free. The longest answer takes more than two seconds at 1,200 baud. */
static void wait_until_sent(enum watch_thread caller)
{
	while (k_sem_take(&tx_free, WATCH_PERIOD) != 0) {
		watch_report(caller);
	}
}

void modbus_hold(enum watch_thread caller)
{
	wait_until_sent(caller);
	held = true;
}

void modbus_release(bool has_stood_still)
{
	if (has_stood_still) {
		k_mutex_lock(&app_lock, K_FOREVER);
		lose(&app_device.slave);
		k_mutex_unlock(&app_lock);
	}
	held = false;
	k_sem_give(&tx_free);
}

/** Make the UART as the device wants it, once nothing is being sent. */
static void follow_line_settings(void)
{
	struct lw_line line;

	k_mutex_lock(&app_lock, K_FOREVER);
	line = app_device.line;
	k_mutex_unlock(&app_lock);
	if (line.baud_rate == configured.baud_rate && line.format == configured.format) {
		return;
	}
	wait_until_sent(WATCH_MODBUS);
	if (configure_line(&line) != 0) {
		LOG_ERR("the UART refuses %u baud, format %d", line.baud_rate, (int)line.format);
	}
	k_sem_give(&tx_free);
	configured = line;
}

/**
 * Take what has come, and begin to answer a request that is complete.
 *
 * @return when to look again; UINT64_MAX: when something comes
 */
static uint64_t answer(void)
{
	struct lw_slave *slave = &app_device.slave;
	const bool may_send = k_sem_take(&tx_free, K_NO_WAIT) == 0;
	uint64_t deadline_us = app_now_us() + slave->config->rtu.silence_us;
	size_t length = 0;

	k_sem_reset(&rx_begun);
	k_mutex_lock(&app_lock, K_FOREVER);
	if (!held) {
		hear(slave);
	}
	if (may_send) {
		length = lw_slave_poll(slave, app_now_us(), tx.bytes);
		deadline_us = lw_slave_deadline_us(slave);
	}
	k_mutex_unlock(&app_lock);
	if (length > 0) {
		tx.length = length;
		tx.sent = 0;
		line_driver_switch(true);
		uart_irq_tx_enable(uart);
	} else if (may_send) {
		k_sem_give(&tx_free);
	}
	return deadline_us;
}

/** One kernel timeout for each silence, not for each byte. */
static void run(void *unused1, void *unused2, void *unused3)
{
	uint64_t deadline_us = UINT64_MAX;

	ARG_UNUSED(unused1);
	ARG_UNUSED(unused2);
	ARG_UNUSED(unused3);
	for (;;) {
		uint64_t now_us;

		follow_line_settings();
		if (deadline_us == UINT64_MAX) {
			const int begun = k_sem_take(&rx_begun, WATCH_PERIOD);

			watch_report(WATCH_MODBUS);
			if (begun != 0) {
				continue;
			}
			deadline_us = app_now_us() + app_device.slave_config.rtu.silence_us;
		}
		now_us = app_now_us();
		if (now_us < deadline_us) {
			k_usleep((int32_t)(deadline_us - now_us));
		}
		/* Also while the line is never silent. */
		watch_report(WATCH_MODBUS);
		deadline_us = answer();
	}
}

int modbus_start(void)
{
	int ret;

	if (!device_is_ready(uart)) {
		return -ENODEV;
	}
	ret = line_driver_let_go();
	if (ret == 0) {
		configured = app_device.line;
		ret = configure_line(&configured);
	}
	if (ret == 0) {
		ret = uart_irq_callback_user_data_set(uart, on_uart, NULL);
	}
	if (ret == 0) {
		ret = watch_add(WATCH_MODBUS);
	}
	if (ret) {
		return ret;
	}
	k_thread_create(&thread, stack, K_THREAD_STACK_SIZEOF(stack), run, NULL, NULL, NULL,
			APP_PRIORITY_MODBUS, 0, K_NO_WAIT);
	k_thread_name_set(&thread, "modbus");
	uart_irq_rx_enable(uart);
	return 0;
}
