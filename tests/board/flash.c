/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Embedded flash: RM0390, 3.4.1 (wait states), 3.5 (unlocking, erasing, programming), 3.8
 * (registers). One bank: while it erases or programs, whatever reads it waits; the processor does,
 * when it fetches. Programming makes zeros of ones only.
 */
#include "parts.h"

#include <string.h>

#define SR_EOP    (1u << 0)
#define SR_OPERR  (1u << 1)
#define SR_PGAERR (1u << 5)
#define SR_PGPERR (1u << 6)
#define SR_PGSERR (1u << 7)
#define SR_BSY    (1u << 16)
#define SR_ERRORS 0x1F2u
#define CR_PG     (1u << 0)
#define CR_SER    (1u << 1)
#define CR_MER    (1u << 2)
#define CR_STRT   (1u << 16)
#define CR_EOPIE  (1u << 24)
#define CR_ERRIE  (1u << 25)
#define CR_LOCK   (1u << 31)
#define KEY1      0x45670123u
#define KEY2      0xCDEF89ABu
#define IRQ_FLASH 4

/** HCLK that a number of wait states allows from 2.7 V up, and latencies (3.4.1, table 6). */
#define HZ_PER_WAIT_STATE 30000000u

void flash_check_latency(struct board *board)
{
	const uint32_t latency = board->flash.acr & 15u;

	if (board->rcc.hclk_hz > (latency + 1) * HZ_PER_WAIT_STATE) {
		board_complain(board, "HCLK of %u Hz with %u wait states of the flash",
			       board->rcc.hclk_hz, latency);
	}
}

static void sector(uint32_t number, uint32_t *start, uint32_t *size)
{
	static const uint32_t starts[] = {0,       0x4000,  0x8000,  0xC000, 0x10000,
					  0x20000, 0x40000, 0x60000, 0x80000};

	*start = starts[number];
	*size = starts[number + 1] - starts[number];
}

/** What an operation leaves that the power has cut: any of its bits done or not. */
static void do_half(struct board *board)
{
	struct flash *flash = &board->flash;
	uint32_t start;
	uint32_t size;

	if (!flash->erasing) {
		for (unsigned int i = 0; i < flash->size; i++) {
			board->memory[flash->target + i] &=
				(uint8_t)(flash->value >> (8 * i) | board_random(board));
		}
		return;
	}
	sector(flash->target, &start, &size);
	for (uint32_t i = 0; i < size; i++) {
		board->memory[start + i] |= (uint8_t)board_random(board);
	}
}

static void do_whole(struct board *board)
{
	struct flash *flash = &board->flash;
	uint32_t start;
	uint32_t size;

	if (!flash->erasing) {
		for (unsigned int i = 0; i < flash->size; i++) {
			board->memory[flash->target + i] &= (uint8_t)(flash->value >> (8 * i));
		}
		return;
	}
	sector(flash->target, &start, &size);
	memset(board->memory + start, 0xFF, size);
}

static bool cut(struct board *board, enum lw_board_cut when)
{
	const struct flash *flash = &board->flash;

	if (flash->cut != when || flash->operations != flash->cut_operation) {
		return false;
	}
	board_lose_power(board);
	return true;
}

static void begin(struct board *board, uint64_t duration_ps)
{
	struct flash *flash = &board->flash;

	flash->operations++;
	if (cut(board, LW_BOARD_CUT_BEFORE)) {
		return;
	}
	flash->busy_until_ps = now_ps(board) + duration_ps;
	event_at(board, EVENT_FLASH,
		 flash->cut == LW_BOARD_CUT_IN && flash->operations == flash->cut_operation
			 ? now_ps(board) + duration_ps / 2
			 : flash->busy_until_ps);
	board->core.attention = true;
}

static void update_line(struct board *board)
{
	const struct flash *flash = &board->flash;

	core_line(board, IRQ_FLASH,
		  ((flash->cr & CR_EOPIE) != 0 && (flash->sr & SR_EOP) != 0) ||
			  ((flash->cr & CR_ERRIE) != 0 && (flash->sr & SR_OPERR) != 0));
}

void flash_event(struct board *board)
{
	struct flash *flash = &board->flash;

	if (flash->cut == LW_BOARD_CUT_IN && flash->operations == flash->cut_operation) {
		do_half(board);
		board_lose_power(board);
		return;
	}
	do_whole(board);
	flash->busy_until_ps = 0;
	flash->cr &= ~CR_STRT;
	if (flash->cr & CR_EOPIE) {
		flash->sr |= SR_EOP;
	}
	update_line(board);
	(void)cut(board, LW_BOARD_CUT_AFTER);
}

void lw_board_cut_power(struct board *board, uint64_t operation, enum lw_board_cut when)
{
	board->flash.cut_operation = board->flash.operations + operation;
	board->flash.cut = when;
}

void flash_reset(struct board *board)
{
	struct flash *flash = &board->flash;

	/* A reset ends an operation half-way (3.5.2). */
	if (flash->busy_until_ps != 0 && board->powered) {
		do_half(board);
	}
	*flash = (struct flash){
		.cr = CR_LOCK,
		.optcr = 0x0FFFAAEDu,
		.operations = flash->operations,
		.cut_operation = flash->cut_operation,
		.cut = flash->cut,
	};
	event_at(board, EVENT_FLASH, NEVER_PS);
	update_line(board);
}

static void fail(struct board *board, uint32_t error)
{
	board->flash.sr |= error | (board->flash.cr & CR_ERRIE ? SR_OPERR : 0);
	board_complain(board, "flash: a program or erase sequence fails, FLASH_SR 0x%x", error);
	update_line(board);
}

uint32_t flash_array_read(struct board *board, uint32_t offset, unsigned int size)
{
	uint32_t value = 0;

	if (board->flash.busy_until_ps != 0) {
		board_complain(board,
			       "flash read while it is busy: the wait is not modelled there");
	}
	memcpy(&value, board->memory + offset, size);
	return value;
}

void flash_array_write(struct board *board, uint32_t offset, uint32_t value, unsigned int size)
{
	struct flash *flash = &board->flash;

	if ((flash->cr & CR_LOCK) != 0 || (flash->cr & CR_PG) == 0 || flash->busy_until_ps != 0) {
		fail(board, SR_PGSERR);
	} else if ((flash->cr >> 8 & 3u) != (size == 1 ? 0u : size == 2 ? 1u : 2u)) {
		fail(board, SR_PGPERR);
	} else if (offset % size != 0) {
		fail(board, SR_PGAERR);
	} else {
		flash->erasing = false;
		flash->target = offset;
		flash->value = value;
		flash->size = size;
		begin(board, (uint64_t)board->config.flash_word_ns * PS_PER_NS);
	}
}

uint32_t flash_read(struct board *board, uint32_t offset)
{
	const struct flash *flash = &board->flash;

	switch (offset) {
	case 0x00:
		return flash->acr;
	case 0x0C:
		return flash->sr | (flash->busy_until_ps > now_ps(board) ? SR_BSY : 0);
	case 0x10:
		return flash->cr;
	case 0x14:
		return flash->optcr;
	default:
		return 0;
	}
}

static void write_cr(struct board *board, uint32_t value)
{
	struct flash *flash = &board->flash;

	if ((flash->cr & CR_LOCK) != 0) {
		if (value != flash->cr) {
			board_complain(board, "FLASH_CR written while it is locked");
		}
		return;
	}
	flash->cr = value;
	if ((value & CR_STRT) == 0) {
		return;
	}
	if ((value & CR_SER) == 0 || (value & CR_MER) != 0 || (value >> 3 & 15u) > 7) {
		board_complain(board, "flash: only the erasure of one sector is modelled");
		flash->cr &= ~CR_STRT;
		return;
	}
	flash->erasing = true;
	flash->target = value >> 3 & 15u;
	begin(board, (uint64_t)board->config.flash_erase_us * PS_PER_US);
}

void flash_write(struct board *board, uint32_t offset, uint32_t value)
{
	struct flash *flash = &board->flash;

	switch (offset) {
	case 0x00:
		flash->acr = value & 0x1F0Fu;
		flash_check_latency(board);
		break;
	case 0x04: /* the wrong key locks it until the next reset (3.5.1) */
		if (!flash->key_refused && flash->key == 0 && value == KEY1) {
			flash->key = KEY1;
		} else if (!flash->key_refused && flash->key == KEY1 && value == KEY2) {
			flash->key = 0;
			flash->cr &= ~CR_LOCK;
		} else {
			flash->key_refused = true;
			board_complain(board, "FLASH_KEYR: wrong key");
		}
		break;
	case 0x0C: /* cleared by a 1 */
		flash->sr &= ~(value & (SR_ERRORS | SR_EOP));
		break;
	case 0x10:
		write_cr(board, value);
		break;
	default:
		break;
	}
	update_line(board);
}
