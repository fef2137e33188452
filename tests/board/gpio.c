/* SPDX-License-Identifier: Apache-2.0 */
/*
 * General-purpose I/O: RM0390, 7.3 (functions) and 7.4 (registers). A level is what stands on the
 * pin: the output where it drives, else what drives from outside, else the pull resistor.
 */
#include "parts.h"

enum mode {
	MODE_INPUT,
	MODE_OUTPUT,
	MODE_ALTERNATE,
	MODE_ANALOG
};

static enum mode mode_of(const struct port *port, unsigned int pin)
{
	return (enum mode)(port->moder >> (2 * pin) & 3u);
}

static bool outside_level(const struct port *port, unsigned int pin)
{
	if (port->drive[pin] != DRIVE_FLOAT) {
		return port->drive[pin] == DRIVE_HIGH;
	}
	return (port->pupdr >> (2 * pin) & 3u) == 1; /* pull-up; what floats reads 0 */
}

static bool level_of(const struct port *port, unsigned int pin)
{
	bool out;

	switch (mode_of(port, pin)) {
	case MODE_OUTPUT:
		out = port->odr >> pin & 1u;
		break;
	case MODE_ALTERNATE:
		/* The peripherals' inputs are alternate functions, too: from outside. */
		out = port->drive[pin] == DRIVE_FLOAT ? port->peripheral >> pin & 1u
						      : port->drive[pin] == DRIVE_HIGH;
		break;
	case MODE_ANALOG:
		return false;
	default:
		return outside_level(port, pin);
	}
	return out && (port->otyper >> pin & 1u) != 0 ? outside_level(port, pin) : out;
}

static void refresh(struct board *board, unsigned int number)
{
	struct port *port = &board->ports[number];

	for (unsigned int pin = 0; pin < 16; pin++) {
		const bool level = level_of(port, pin);

		if (level == (port->levels >> pin & 1u)) {
			continue;
		}
		port->levels ^= (uint16_t)(1u << pin);
		seen_pin(board, number, pin, level);
		exti_pin(board, number, pin, level);
		timer_pin(board, number, pin, level);
		wiring_output(board, number, pin, level);
	}
}

void gpio_drive(struct board *board, unsigned int port, unsigned int pin, enum drive drive)
{
	board->ports[port].drive[pin] = (uint8_t)drive;
	refresh(board, port);
}

void gpio_peripheral(struct board *board, unsigned int port, unsigned int pin, bool level)
{
	struct port *it = &board->ports[port];

	it->peripheral = (uint16_t)((it->peripheral & ~(1u << pin)) | (uint32_t)level << pin);
	refresh(board, port);
}

bool gpio_level(const struct board *board, unsigned int port, unsigned int pin)
{
	return board->ports[port].levels >> pin & 1u;
}

bool gpio_is(const struct board *board, unsigned int port, unsigned int pin, unsigned int function)
{
	const struct port *it = &board->ports[port];

	return mode_of(it, pin) == MODE_ALTERNATE &&
	       (it->afr[pin / 8] >> (4 * (pin % 8)) & 15u) == function;
}

bool gpio_is_output(const struct board *board, unsigned int port, unsigned int pin)
{
	return mode_of(&board->ports[port], pin) == MODE_OUTPUT;
}

void gpio_reset(struct board *board)
{
	for (unsigned int i = 0; i < PORTS; i++) {
		struct port *port = &board->ports[i];

		/* The debugger's pins (7.4.1, 7.4.3, 7.4.4). */
		port->moder = i == 0 ? 0xA8000000u : i == 1 ? 0x280u : 0;
		port->pupdr = i == 0 ? 0x64000000u : i == 1 ? 0x100u : 0;
		port->ospeedr = i == 0 ? 0x0C000000u : i == 1 ? 0xC0u : 0;
		port->otyper = 0;
		port->odr = 0;
		port->afr[0] = 0;
		port->afr[1] = 0;
		port->peripheral = 0;
		refresh(board, i);
	}
}

uint32_t gpio_read(struct board *board, unsigned int number, uint32_t offset)
{
	const struct port *port = &board->ports[number];

	switch (offset) {
	case 0x00:
		return port->moder;
	case 0x04:
		return port->otyper;
	case 0x08:
		return port->ospeedr;
	case 0x0C:
		return port->pupdr;
	case 0x10:
		return port->levels;
	case 0x14:
		return port->odr;
	case 0x20:
	case 0x24:
		return port->afr[(offset - 0x20) / 4];
	default:
		return 0;
	}
}

void gpio_write(struct board *board, unsigned int number, uint32_t offset, uint32_t value)
{
	struct port *port = &board->ports[number];

	switch (offset) {
	case 0x00:
		port->moder = value;
		break;
	case 0x04:
		port->otyper = value & 0xFFFFu;
		break;
	case 0x08:
		port->ospeedr = value;
		break;
	case 0x0C:
		port->pupdr = value;
		break;
	case 0x14:
		port->odr = value & 0xFFFFu;
		break;
	case 0x18: /* BSRR: where both are written, set wins (7.4.7) */
		port->odr = (port->odr & ~(value >> 16)) | (value & 0xFFFFu);
		break;
	case 0x20:
	case 0x24:
		port->afr[(offset - 0x20) / 4] = value;
		break;
	default:
		return;
	}
	refresh(board, number);
}
