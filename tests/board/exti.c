/* SPDX-License-Identifier: Apache-2.0 */
/*
 * External interrupts: RM0390, 10.2.5 (lines), 10.3 (registers); which port a line listens to:
 * SYSCFG_EXTICR, 8.2.3.
 */
#include "parts.h"

#define LINES 23

/** Interrupt of each line of a pin (10.1.3, table 38). */
static unsigned int irq_of(unsigned int line)
{
	return line < 5 ? 6 + line : line < 10 ? 23 : 40;
}

/** Lines 5 to 9, and 10 to 15, share one. */
static void update(struct board *board)
{
	const uint32_t up = board->exti.pr & board->exti.imr;

	for (unsigned int line = 0; line < 5; line++) {
		core_line(board, irq_of(line), up >> line & 1u);
	}
	core_line(board, irq_of(5), (up & 0x03E0u) != 0);
	core_line(board, irq_of(10), (up & 0xFC00u) != 0);
}

void exti_pin(struct board *board, unsigned int port, unsigned int pin, bool level)
{
	struct exti *exti = &board->exti;
	const uint32_t edges = level ? exti->rtsr : exti->ftsr;

	if ((exti->exticr[pin / 4] >> (4 * (pin % 4)) & 15u) == port && (edges >> pin & 1u) != 0) {
		exti->pr |= 1u << pin;
		update(board);
	}
}

void exti_reset(struct board *board)
{
	board->exti = (struct exti){0};
	update(board);
}

uint32_t exti_read(struct board *board, uint32_t offset)
{
	const struct exti *exti = &board->exti;

	switch (offset) {
	case 0x00:
		return exti->imr;
	case 0x04:
		return exti->emr;
	case 0x08:
		return exti->rtsr;
	case 0x0C:
		return exti->ftsr;
	case 0x14:
		return exti->pr;
	default:
		return 0;
	}
}

void exti_write(struct board *board, uint32_t offset, uint32_t value)
{
	struct exti *exti = &board->exti;

	value &= (1u << LINES) - 1;
	switch (offset) {
	case 0x00:
		exti->imr = value;
		break;
	case 0x04:
		exti->emr = value;
		break;
	case 0x08:
		exti->rtsr = value;
		break;
	case 0x0C:
		exti->ftsr = value;
		break;
	case 0x10: /* SWIER: pends where the line is enabled */
		exti->pr |= value & exti->imr;
		break;
	case 0x14: /* cleared by a 1 */
		exti->pr &= ~value;
		break;
	default:
		return;
	}
	update(board);
}

uint32_t syscfg_read(struct board *board, uint32_t offset)
{
	return offset >= 0x08 && offset <= 0x14 ? board->exti.exticr[(offset - 0x08) / 4] : 0;
}

void syscfg_write(struct board *board, uint32_t offset, uint32_t value)
{
	if (offset >= 0x08 && offset <= 0x14) {
		board->exti.exticr[(offset - 0x08) / 4] = value & 0xFFFFu;
	}
}
