/* SPDX-License-Identifier: Apache-2.0 */
/*
 * UART of the Arm Cortex-M System Design Kit, interrupt-driven. Zephyr's own driver for it
 * (arm,cmsdk-uart) reports interrupts that are not enabled, and never begins to receive if a byte
 * is there already when it is told to; this one can carry Modbus.
 */
#define DT_DRV_COMPAT levelwind_cmsdk_uart

#include <errno.h>

#include <cmsis_core.h>
#include <zephyr/drivers/uart.h>
#include <zephyr/irq.h>
#include <zephyr/sys/util.h>

/** Registers (Arm DDI 0479, 4.3). */
struct cmsdk_uart {
	volatile uint32_t data;
	volatile uint32_t state;
	volatile uint32_t ctrl;
	volatile uint32_t interrupt; /**< read: status; write: clear */
	volatile uint32_t bauddiv;
};

#define STATE_TX_FULL BIT(0)
#define STATE_RX_FULL BIT(1)
#define CTRL_TX       BIT(0)
#define CTRL_RX       BIT(1)
#define CTRL_TX_IRQ   BIT(2)
#define CTRL_RX_IRQ   BIT(3)
#define INTERRUPT_TX  BIT(0)
#define INTERRUPT_RX  BIT(1)
#define BAUDDIV_MIN   16u

struct uart_config_data {
	struct cmsdk_uart *registers;
	uint32_t clock_hz;
	uint32_t baud_rate;
	unsigned int tx_irq;
	unsigned int rx_irq;
	void (*connect)(void);
};

/** Set while the interrupts are disabled. */
struct uart_data {
	uart_irq_callback_user_data_t callback;
	void *user_data;
};

static struct cmsdk_uart *registers_of(const struct device *dev)
{
	return ((const struct uart_config_data *)dev->config)->registers;
}

static int poll_in(const struct device *dev, unsigned char *byte)
{
	struct cmsdk_uart *uart = registers_of(dev);

	if (!(uart->state & STATE_RX_FULL)) {
		return -1;
	}
	*byte = (unsigned char)uart->data;
	return 0;
}

static void poll_out(const struct device *dev, unsigned char byte)
{
	struct cmsdk_uart *uart = registers_of(dev);

	while (uart->state & STATE_TX_FULL) {
	}
	uart->data = byte;
}

static int fifo_fill(const struct device *dev, const uint8_t *bytes, int length)
{
	struct cmsdk_uart *uart = registers_of(dev);
	int count = 0;

	while (count < length && !(uart->state & STATE_TX_FULL)) {
		uart->data = bytes[count++];
	}
	return count;
}

static int fifo_read(const struct device *dev, uint8_t *bytes, const int size)
{
	struct cmsdk_uart *uart = registers_of(dev);
	int count = 0;

	while (count < size && (uart->state & STATE_RX_FULL)) {
		bytes[count++] = (uint8_t)uart->data;
	}
	return count;
}

/*
 * The hardware interrupts when a buffer becomes ready, not while it is: what is ready when an
 * interrupt is enabled has to be told by hand.
 */
static void irq_tx_enable(const struct device *dev)
{
	const struct uart_config_data *config = dev->config;

	config->registers->ctrl |= CTRL_TX_IRQ;
	NVIC_SetPendingIRQ((IRQn_Type)config->tx_irq);
}

static void irq_tx_disable(const struct device *dev)
{
	registers_of(dev)->ctrl &= ~CTRL_TX_IRQ;
}

static void irq_rx_enable(const struct device *dev)
{
	const struct uart_config_data *config = dev->config;

	config->registers->ctrl |= CTRL_RX_IRQ;
	NVIC_SetPendingIRQ((IRQn_Type)config->rx_irq);
}

static void irq_rx_disable(const struct device *dev)
{
	registers_of(dev)->ctrl &= ~CTRL_RX_IRQ;
}

static int irq_tx_ready(const struct device *dev)
{
	struct cmsdk_uart *uart = registers_of(dev);

	return (uart->ctrl & CTRL_TX_IRQ) && !(uart->state & STATE_TX_FULL);
}

static int irq_rx_ready(const struct device *dev)
{
	struct cmsdk_uart *uart = registers_of(dev);

	return (uart->ctrl & CTRL_RX_IRQ) && (uart->state & STATE_RX_FULL);
}

static int irq_tx_complete(const struct device *dev)
{
	return !(registers_of(dev)->state & STATE_TX_FULL);
}

static int irq_is_pending(const struct device *dev)
{
	return irq_tx_ready(dev) || irq_rx_ready(dev);
}

static int irq_update(const struct device *dev)
{
	ARG_UNUSED(dev);
	return 1;
}

static void irq_callback_set(const struct device *dev, uart_irq_callback_user_data_t callback,
			     void *user_data)
{
	struct uart_data *data = dev->data;

	data->callback = callback;
	data->user_data = user_data;
}

static void isr(const struct device *dev)
{
	const struct uart_data *data = dev->data;

	/* Before the callback looks at the buffers: what happens after this interrupts again. */
	registers_of(dev)->interrupt = INTERRUPT_TX | INTERRUPT_RX;
	if (data->callback != NULL) {
		data->callback(dev, data->user_data);
	}
}

static int init(const struct device *dev)
{
	const struct uart_config_data *config = dev->config;

	config->registers->bauddiv = MAX(config->clock_hz / config->baud_rate, BAUDDIV_MIN);
	config->registers->ctrl = CTRL_TX | CTRL_RX;
	config->connect();
	return 0;
}

static const struct uart_driver_api api = {
	.poll_in = poll_in,
	.poll_out = poll_out,
	.fifo_fill = fifo_fill,
	.fifo_read = fifo_read,
	.irq_tx_enable = irq_tx_enable,
	.irq_tx_disable = irq_tx_disable,
	.irq_tx_ready = irq_tx_ready,
	.irq_tx_complete = irq_tx_complete,
	.irq_rx_enable = irq_rx_enable,
	.irq_rx_disable = irq_rx_disable,
	.irq_rx_ready = irq_rx_ready,
	.irq_is_pending = irq_is_pending,
	.irq_update = irq_update,
	.irq_callback_set = irq_callback_set,
};

/* Both lines have one priority, so the handler does not interrupt itself. */
#define UART_DEFINE(inst)                                                                          \
	static void connect_##inst(void)                                                           \
	{                                                                                          \
		IRQ_CONNECT(DT_INST_IRQ_BY_NAME(inst, tx, irq),                                    \
			    DT_INST_IRQ_BY_NAME(inst, rx, priority), isr,                          \
			    DEVICE_DT_INST_GET(inst), 0);                                          \
		IRQ_CONNECT(DT_INST_IRQ_BY_NAME(inst, rx, irq),                                    \
			    DT_INST_IRQ_BY_NAME(inst, rx, priority), isr,                          \
			    DEVICE_DT_INST_GET(inst), 0);                                          \
		irq_enable(DT_INST_IRQ_BY_NAME(inst, tx, irq));                                    \
		irq_enable(DT_INST_IRQ_BY_NAME(inst, rx, irq));                                    \
	}                                                                                          \
	static const struct uart_config_data config_##inst = {                                     \
		.registers = (struct cmsdk_uart *)DT_INST_REG_ADDR(inst),                          \
		.clock_hz = DT_INST_PROP_BY_PHANDLE(inst, clocks, clock_frequency),                \
		.baud_rate = DT_INST_PROP(inst, current_speed),                                    \
		.tx_irq = DT_INST_IRQ_BY_NAME(inst, tx, irq),                                      \
		.rx_irq = DT_INST_IRQ_BY_NAME(inst, rx, irq),                                      \
		.connect = connect_##inst,                                                         \
	};                                                                                         \
	static struct uart_data data_##inst;                                                       \
	DEVICE_DT_INST_DEFINE(inst, init, NULL, &data_##inst, &config_##inst, PRE_KERNEL_1,        \
			      CONFIG_SERIAL_INIT_PRIORITY, &api);

DT_INST_FOREACH_STATUS_OKAY(UART_DEFINE)
