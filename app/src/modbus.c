#include "modbus.h"

#include <errno.h>
#include <string.h>

#include <zephyr/drivers/gpio.h>
#include <zephyr/drivers/uart.h>
#include <zephyr/logging/log.h>

#include "app.h"
#include "watch.h"

LOG_MODULE_DECLARE(levelwind);

static const struct device *const uart = DEVICE_DT_GET(DT_PHANDLE(APP_NODE, modbus_uart));
static const struct gpio_dt_spec driver_enable =
	GPIO_DT_SPEC_GET_OR(APP_NODE, driver_enable_gpios, {0});

static K_THREAD_STACK_DEFINE(stack, 1792);
static struct k_thread thread;

/** What has been received. */
struct reception {
	uint64_t last_byte_us;
	size_t length; /**< one more than a frame can have stands for too much */
	uint8_t bytes[LW_RTU_FRAME_MAX + 1];
};

/* The interrupt fills one, the thread works on the other; it swaps them with interrupts locked. */
static struct reception receptions[2];
static struct reception *rx = &receptions[0];
static K_SEM_DEFINE(rx_begun, 0, 1);

/* What is being sent. The thread's while it holds tx_free, else the interrupt's. */
static struct {
	size_t length;
	size_t sent;
	uint8_t bytes[LW_RTU_FRAME_MAX];
} tx;
static bool sending; /**< likewise */
static K_SEM_DEFINE(tx_free, 1, 1);

/** What the UART is configured to. The thread's, once it runs. */
static struct lw_line configured;

static void receive(void)
{
	uint8_t bytes[32];
	const int count = uart_fifo_read(uart, bytes, sizeof(bytes));

	/* On a two-wire line everything that is sent is heard, too. */
	if (count <= 0 || (driver_enable.port != NULL && sending)) {
		return;
	}

	const size_t room = sizeof(rx->bytes) - rx->length;
	const size_t taken = MIN((size_t)count, room);

	memcpy(&rx->bytes[rx->length], bytes, taken);
	rx->length += taken;
	rx->last_byte_us = app_now_us();
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
		if (driver_enable.port != NULL) {
			(void)gpio_pin_set_dt(&driver_enable, 0);
		}
		sending = false;
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

/**
 * Wait until the line has been silent after some bytes, and take them. One kernel timeout for each
 * silence, not for each byte.
 *
 * @return what has come, valid until the next call; NULL if nothing has for a while
 */
static const struct reception *wait_for_frame(void)
{
	const uint32_t silence_us = app_device.slave_config.rtu.silence_us;
	uint32_t wait_us = silence_us;

	if (k_sem_take(&rx_begun, WATCH_PERIOD) != 0) {
		return NULL;
	}
	for (;;) {
		const struct reception *frame = NULL;

		k_usleep((int32_t)wait_us);

		/* The encoder waits for this, too: no copying here. */
		const unsigned int key = irq_lock();
		const uint64_t silent_us = app_now_us() - rx->last_byte_us;

		if (silent_us >= silence_us) {
			frame = rx;
			rx = rx == &receptions[0] ? &receptions[1] : &receptions[0];
			rx->length = 0;
			k_sem_reset(&rx_begun);
		}
		irq_unlock(key);
		if (frame != NULL) {
			return frame;
		}
		wait_us = (uint32_t)(silence_us - silent_us);
	}
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
}

void modbus_release(void)
{
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

static void run(void *unused1, void *unused2, void *unused3)
{
	ARG_UNUSED(unused1);
	ARG_UNUSED(unused2);
	ARG_UNUSED(unused3);
	for (;;) {
		follow_line_settings();

		const struct reception *frame = wait_for_frame();
		struct lw_slave *slave = &app_device.slave;

		watch_report(WATCH_MODBUS);
		if (frame == NULL) {
			continue;
		}
		wait_until_sent(WATCH_MODBUS);
		k_mutex_lock(&app_lock, K_FOREVER);
		lw_slave_receive(slave, frame->bytes, frame->length, frame->last_byte_us);
		tx.length = lw_slave_poll(slave, app_now_us(), tx.bytes);
		k_mutex_unlock(&app_lock);
		tx.sent = 0;
		if (tx.length == 0) {
			k_sem_give(&tx_free);
			continue;
		}
		sending = true;
		if (driver_enable.port != NULL) {
			(void)gpio_pin_set_dt(&driver_enable, 1);
		}
		uart_irq_tx_enable(uart);
	}
}

int modbus_let_go(void)
{
	if (driver_enable.port == NULL) {
		return 0;
	}
	return gpio_is_ready_dt(&driver_enable)
		       ? gpio_pin_configure_dt(&driver_enable, GPIO_OUTPUT_INACTIVE)
		       : -ENODEV;
}

int modbus_start(void)
{
	int ret;

	if (!device_is_ready(uart)) {
		return -ENODEV;
	}
	ret = modbus_let_go();
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
