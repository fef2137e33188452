/* SPDX-License-Identifier: Apache-2.0 */
/*
 * USART1, on the line with the master, and USART2: RM0390, 25.4.2 (transmitter), 25.4.3 (receiver),
 * 25.4.4 (baud rate), 25.4.7 (parity), 25.6 (registers). Byte by byte, each for as long as its bits
 * take at the sender's rate. Not here: the noise flag, break, the idle frame after TE, DMA.
 */
#include "parts.h"

#include <string.h>

#define SR_PE      (1u << 0)
#define SR_FE      (1u << 1)
#define SR_ORE     (1u << 3)
#define SR_IDLE    (1u << 4)
#define SR_RXNE    (1u << 5)
#define SR_TC      (1u << 6)
#define SR_TXE     (1u << 7)
#define SR_BY_DR   (SR_PE | SR_FE | SR_ORE | SR_IDLE)
#define CR1_RE     (1u << 2)
#define CR1_TE     (1u << 3)
#define CR1_IDLEIE (1u << 4)
#define CR1_RXNEIE (1u << 5)
#define CR1_TCIE   (1u << 6)
#define CR1_TXEIE  (1u << 7)
#define CR1_PEIE   (1u << 8)
#define CR1_PS     (1u << 9)
#define CR1_PCE    (1u << 10)
#define CR1_M      (1u << 12)
#define CR1_UE     (1u << 13)
#define CR1_OVER8  (1u << 15)
#define CR3_EIE    1u

/** A rate further off than this, in permille, is read wrong: half a bit in eleven. */
#define RATE_ERROR_MAX_PERMILLE 45

static const uint8_t irqs[2] = {37, 38};

static void update_line(struct board *board, unsigned int index)
{
	const struct usart *usart = &board->usarts[index];
	const uint32_t cr1 = usart->cr[0];
	const uint32_t sr = usart->sr;
	const bool up = ((cr1 & CR1_TXEIE) != 0 && (sr & SR_TXE) != 0) ||
			((cr1 & CR1_TCIE) != 0 && (sr & SR_TC) != 0) ||
			((cr1 & CR1_RXNEIE) != 0 && (sr & (SR_RXNE | SR_ORE)) != 0) ||
			((cr1 & CR1_IDLEIE) != 0 && (sr & SR_IDLE) != 0) ||
			((cr1 & CR1_PEIE) != 0 && (sr & SR_PE) != 0) ||
			((usart->cr[2] & CR3_EIE) != 0 && (sr & (SR_ORE | SR_FE)) != 0);

	core_line(board, irqs[index], up && (cr1 & CR1_UE) != 0);
}

/** 25.4.4: BRR is the divider in 16ths, or with OVER8 in 8ths of half of it. 0: none. */
static uint64_t baud_millihz(const struct board *board, unsigned int index)
{
	const struct usart *usart = &board->usarts[index];
	const uint64_t pclk_hz = board->rcc.pclk_hz[index == 0];
	const uint64_t divider = usart->cr[0] & CR1_OVER8
					 ? (usart->brr & 0xFFF0u) | (usart->brr & 7u) << 1
					 : usart->brr;

	if (divider < 16) {
		return 0;
	}
	return (usart->cr[0] & CR1_OVER8 ? 2 : 1) * pclk_hz * 1000u / divider;
}

/** Data bits, parity and stop bits that it is set to; half stop bits count as whole ones. */
static struct lw_board_byte format(const struct usart *usart)
{
	return (struct lw_board_byte){
		.parity = usart->cr[0] & CR1_PCE ? (usart->cr[0] & CR1_PS ? 1 : 2) : 0,
		.stop_bits = usart->cr[1] >> 12 & 2u ? 2 : 1,
	};
}

static uint64_t frame_ps(uint64_t millihz, unsigned int parity, unsigned int stop_bits)
{
	return ps_for((9u + (parity != 0) + stop_bits) * 1000ull, millihz);
}

/** The byte in the data register goes into the shift register, which is free. */
static void begin_to_send(struct board *board, unsigned int index)
{
	struct usart *usart = &board->usarts[index];
	const uint64_t millihz = baud_millihz(board, index);

	if (millihz == 0) {
		board_complain(board, "USART%u sends with a divider of %u", index + 1, usart->brr);
		return;
	}
	usart->shifting = format(usart);
	if ((usart->shifting.parity != 0) != ((usart->cr[0] & CR1_M) != 0)) {
		board_complain(board, "USART%u: not eight bits of data", index + 1);
	}
	usart->shifting.value = (uint8_t)usart->tdr;
	usart->shifting.baud_millihz = (uint32_t)millihz;
	usart->shifting.start_ns = now_ps(board) / PS_PER_NS;
	usart->shift_end_ps = now_ps(board) +
			      frame_ps(millihz, usart->shifting.parity, usart->shifting.stop_bits);
	usart->shifting.end_ns = usart->shift_end_ps / PS_PER_NS;
	usart->tdr_full = false;
	usart->sr |= SR_TXE;
	if (index == 0) {
		event_at(board, EVENT_USART_TX, usart->shift_end_ps);
	}
}

static void receive(struct board *board, uint8_t value, uint64_t millihz, unsigned int parity);

void usart_tx_event(struct board *board)
{
	struct usart *usart = &board->usarts[0];
	struct line *line = &board->line;
	const struct lw_board_byte done = usart->shifting;

	usart->shifting.end_ns = 0;
	seen_sent(board, done.start_ns * PS_PER_NS, usart->shift_end_ps);
	if (gpio_level(board, PIN_DE) && gpio_is_output(board, PIN_DE)) {
		if (line->heard_count < LINE_SIZE) {
			line->heard[line->heard_count++] = done;
		}
		line->heard_total++;
	} else {
		board->pins.seen.sent_without_driver++;
	}
	if (board->config.line_echo) {
		receive(board, done.value, done.baud_millihz, done.parity);
	}
	if (usart->tdr_full) {
		begin_to_send(board, 0);
	} else {
		usart->sr |= SR_TC;
	}
	update_line(board, 0);
}

static bool parity_bit(uint8_t value, unsigned int parity)
{
	return (bool)__builtin_parity(value) != (parity == 1);
}

/** A byte has arrived; what it is read as. */
static void receive(struct board *board, uint8_t value, uint64_t millihz, unsigned int parity)
{
	struct usart *usart = &board->usarts[0];
	const struct lw_board_byte own = format(usart);
	const uint64_t own_millihz = baud_millihz(board, 0);
	const uint64_t apart =
		millihz > own_millihz ? millihz - own_millihz : own_millihz - millihz;
	uint32_t errors = 0;

	if ((usart->cr[0] & (CR1_UE | CR1_RE)) != (CR1_UE | CR1_RE)) {
		return;
	}
	if (apart * 1000 > own_millihz * RATE_ERROR_MAX_PERMILLE) {
		value = (uint8_t)board_random(board);
		errors |= SR_FE;
	} else if (own.parity != 0) {
		/* Without a parity bit, its place is taken by the stop bit, a 1. */
		const bool bit = parity == 0 || parity_bit(value, parity);

		errors |= bit != parity_bit(value, own.parity) ? SR_PE : 0;
	} else if (parity != 0 && !parity_bit(value, parity)) {
		errors |= SR_FE; /* the parity bit, a 0, where a stop bit is due */
	}
	if (usart->sr & SR_RXNE) {
		usart->sr |= SR_ORE; /* what has come is lost (25.4.3) */
	} else {
		usart->dr = value;
		usart->sr |= SR_RXNE | errors;
	}
	event_at(board, EVENT_USART_IDLE,
		 now_ps(board) +
			 frame_ps(own_millihz ? own_millihz : 1, own.parity, own.stop_bits));
	update_line(board, 0);
}

void usart_idle_event(struct board *board)
{
	board->usarts[0].sr |= SR_IDLE;
	update_line(board, 0);
}

/** What the master's port is set to; with no rate of its own, as the controller is. */
static struct lw_board_byte masters(const struct board *board)
{
	const struct line *line = &board->line;
	struct lw_board_byte settings = format(&board->usarts[0]);
	const uint64_t own_millihz = baud_millihz(board, 0);

	if (line->baud == 0) {
		settings.baud_millihz = own_millihz != 0 ? (uint32_t)own_millihz : 19200000u;
		return settings;
	}
	settings.baud_millihz = line->baud * 1000u;
	settings.parity = line->parity;
	settings.stop_bits = line->stop_bits;
	return settings;
}

static void send_next(struct board *board)
{
	struct line *line = &board->line;
	const struct lw_board_byte settings = masters(board);

	line->sending = line->send_from != line->send_to;
	if (!line->sending) {
		return;
	}
	line->byte = line->to_send[line->send_from];
	line->send_from = (line->send_from + 1) % LINE_SIZE;
	event_at(board, EVENT_USART_RX,
		 now_ps(board) +
			 frame_ps(settings.baud_millihz, settings.parity, settings.stop_bits));
}

/** A byte of the master is out. The transceiver hears it unless it sends itself. */
void usart_rx_event(struct board *board)
{
	const struct lw_board_byte settings = masters(board);

	if (!(gpio_level(board, PIN_DE) && gpio_is_output(board, PIN_DE)) &&
	    gpio_is(board, PORT_A, 10, 7)) {
		receive(board, board->line.byte, settings.baud_millihz, settings.parity);
	}
	send_next(board);
}

void lw_board_line_settings(struct board *board, uint32_t baud, unsigned int parity,
			    unsigned int stop_bits)
{
	board->line.baud = baud;
	board->line.parity = (uint8_t)parity;
	board->line.stop_bits = (uint8_t)stop_bits;
}

void lw_board_line_send(struct board *board, const uint8_t *bytes, size_t count)
{
	struct line *line = &board->line;

	for (size_t i = 0; i < count; i++) {
		line->to_send[line->send_to] = bytes[i];
		line->send_to = (line->send_to + 1) % LINE_SIZE;
	}
	if (!line->sending) {
		send_next(board);
	}
}

size_t lw_board_line_read(struct board *board, struct lw_board_byte *bytes, size_t size)
{
	struct line *line = &board->line;
	const size_t count = line->heard_count < size ? line->heard_count : size;

	memcpy(bytes, line->heard, count * sizeof(*bytes));
	memmove(line->heard, line->heard + count, (line->heard_count - count) * sizeof(*bytes));
	line->heard_count -= count;
	return count;
}

bool lw_board_line_idle(const struct board *board)
{
	return !board->line.sending && board->usarts[0].shifting.end_ns == 0;
}

void usart_reset(struct board *board, unsigned int index)
{
	board->usarts[index] = (struct usart){.sr = SR_TC | SR_TXE};
	if (index == 0) {
		event_at(board, EVENT_USART_TX, NEVER_PS);
		event_at(board, EVENT_USART_IDLE, NEVER_PS);
	}
	update_line(board, index);
}

uint32_t usart_read(struct board *board, unsigned int index, uint32_t offset)
{
	struct usart *usart = &board->usarts[index];

	if (index == 0) {
		event_catch_up(board, EVENT_USART_RX);
		event_catch_up(board, EVENT_USART_TX);
	}
	switch (offset) {
	case 0x00:
		usart->sr_read = true;
		return usart->sr;
	case 0x04:
		usart->sr &= ~SR_RXNE;
		if (usart->sr_read) {
			usart->sr &= ~SR_BY_DR;
		}
		usart->sr_read = false;
		update_line(board, index);
		return usart->dr;
	case 0x08:
		return usart->brr;
	case 0x0C:
	case 0x10:
	case 0x14:
		return usart->cr[(offset - 0x0C) / 4];
	default:
		return 0;
	}
}

void usart_write(struct board *board, unsigned int index, uint32_t offset, uint32_t value)
{
	struct usart *usart = &board->usarts[index];

	if (index == 0) {
		event_catch_up(board, EVENT_USART_TX);
	}
	switch (offset) {
	case 0x00: /* cleared by a 0: RXNE and TC */
		usart->sr &= value | ~(SR_RXNE | SR_TC);
		break;
	case 0x04:
		if (usart->sr_read) {
			usart->sr &= ~SR_TC;
		}
		usart->sr_read = false;
		if ((usart->cr[0] & (CR1_UE | CR1_TE)) != (CR1_UE | CR1_TE)) {
			break;
		}
		usart->tdr = value & 0x1FFu;
		usart->tdr_full = true;
		usart->sr &= ~(SR_TXE | SR_TC);
		if (usart->shifting.end_ns == 0) {
			begin_to_send(board, index);
		}
		break;
	case 0x08: /* 16 bits (25.6.3): what does not fit is lost */
		usart->brr = value & 0xFFFFu;
		break;
	case 0x0C:
	case 0x10:
	case 0x14:
		usart->cr[(offset - 0x0C) / 4] = value;
		break;
	default:
		return;
	}
	update_line(board, index);
}
