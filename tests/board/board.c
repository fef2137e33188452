/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The board as a whole: bus, reset, power.
 */
#include "parts.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lw/bytes/layout.h"

#define PERIPHERALS_BASE 0x40000000u
#define PERIPHERALS_SIZE 0x80000u
#define SYSTEM_BASE      0xE0000000u
#define SYSTEM_SIZE      0x100000u

void lw_board_config_default(struct lw_board_config *config)
{
	*config = (struct lw_board_config){
		.seed = 1,
		.cycles_permille = 1000,
		.hse_hz = 8000000,
		.lsi_hz = 32000,
		.flash_word_ns = 16000,
		.flash_erase_us = 1000000,
		.encoder_pulses_per_rev = 360,
	};
}

uint32_t board_random(struct board *board)
{
	board->random = board->random * 6364136223846793005u + 1442695040888963407u;
	return (uint32_t)(board->random >> 33);
}

void board_complain(struct board *board, const char *format, ...)
{
	const size_t length = strlen(board->complaints);
	char line[160];
	va_list arguments;

	va_start(arguments, format);
	(void)vsnprintf(line, sizeof(line) - 1, format, arguments);
	va_end(arguments);
	strcat(line, "\n");
	if (strstr(board->complaints, line) == NULL &&
	    length + strlen(line) < sizeof(board->complaints)) {
		strcat(board->complaints, line);
	}
}

const char *lw_board_complaints(const struct board *board)
{
	return board->complaints;
}

/* ---- the bus --------------------------------------------------------------------------------- */

static uint32_t no_read(struct board *board, uint32_t offset)
{
	(void)board;
	(void)offset;
	return 0;
}

static void no_write(struct board *board, uint32_t offset, uint32_t value)
{
	(void)board;
	(void)offset;
	(void)value;
}

#define INDEXED(part, index)                                                                       \
	static uint32_t part##_read_##index(struct board *board, uint32_t offset)                  \
	{                                                                                          \
		return part##_read(board, index, offset);                                          \
	}                                                                                          \
	static void part##_write_##index(struct board *board, uint32_t offset, uint32_t value)     \
	{                                                                                          \
		part##_write(board, index, offset, value);                                         \
	}

INDEXED(timer, 0)
INDEXED(timer, 1)
INDEXED(timer, 2)
INDEXED(timer, 3)
INDEXED(usart, 0)
INDEXED(usart, 1)
INDEXED(gpio, 0)
INDEXED(gpio, 1)
INDEXED(gpio, 2)
INDEXED(gpio, 3)
INDEXED(gpio, 4)
INDEXED(gpio, 5)
INDEXED(gpio, 6)
INDEXED(gpio, 7)

/** What stands where (RM0390, 2.2.2), and the bit of RCC that gives it its clock (6.3.10 to 14). */
static const struct peripheral {
	uint32_t base;
	const char *name;
	uint8_t bus; /**< index of rcc.enabled; ALWAYS: needs no clock of its own */
	uint8_t bit;
	uint32_t (*read)(struct board *board, uint32_t offset);
	void (*write)(struct board *board, uint32_t offset, uint32_t value);
} peripherals[] = {
#define ALWAYS 255
#define AHB1   0
#define APB1   3
#define APB2   4
	{0x40000000, "TIM2", APB1, 0, timer_read_0, timer_write_0},
	{0x40000400, "TIM3", APB1, 1, timer_read_1, timer_write_1},
	{0x40000800, "TIM4", APB1, 2, timer_read_2, timer_write_2},
	{0x40000C00, "TIM5", APB1, 3, timer_read_3, timer_write_3},
	{0x40002800, "RTC", ALWAYS, 0, no_read, no_write},
	{0x40003000, "IWDG", ALWAYS, 0, iwdg_read, iwdg_write},
	{0x40004400, "USART2", APB1, 17, usart_read_1, usart_write_1},
	{0x40007000, "PWR", APB1, 28, pwr_read, pwr_write},
	{0x40011000, "USART1", APB2, 4, usart_read_0, usart_write_0},
	{0x40013800, "SYSCFG", APB2, 14, syscfg_read, syscfg_write},
	{0x40013C00, "EXTI", ALWAYS, 0, exti_read, exti_write},
	{0x40020000, "GPIOA", AHB1, 0, gpio_read_0, gpio_write_0},
	{0x40020400, "GPIOB", AHB1, 1, gpio_read_1, gpio_write_1},
	{0x40020800, "GPIOC", AHB1, 2, gpio_read_2, gpio_write_2},
	{0x40020C00, "GPIOD", AHB1, 3, gpio_read_3, gpio_write_3},
	{0x40021000, "GPIOE", AHB1, 4, gpio_read_4, gpio_write_4},
	{0x40021400, "GPIOF", AHB1, 5, gpio_read_5, gpio_write_5},
	{0x40021800, "GPIOG", AHB1, 6, gpio_read_6, gpio_write_6},
	{0x40021C00, "GPIOH", AHB1, 7, gpio_read_7, gpio_write_7},
	{0x40023800, "RCC", ALWAYS, 0, rcc_read, rcc_write},
	{0x40023C00, "FLASH", ALWAYS, 0, flash_read, flash_write},
};

static const struct peripheral *find(struct board *board, uint32_t address)
{
	for (size_t i = 0; i < sizeof(peripherals) / sizeof(peripherals[0]); i++) {
		const struct peripheral *it = &peripherals[i];

		if (it->base != (address & ~0x3FFu)) {
			continue;
		}
		if (it->bus == ALWAYS || (board->rcc.enabled[it->bus] >> it->bit & 1u) != 0) {
			return it;
		}
		board_complain(board, "%s is used without its clock", it->name);
		return NULL;
	}
	board_complain(board, "0x%08x: nothing is modelled there", address & ~0x3FFu);
	return NULL;
}

uint32_t bus_read(struct board *board, uint32_t address, unsigned int size)
{
	uint32_t value = 0;

	if (address >= SYSTEM_BASE) {
		return core_read(board, address - SYSTEM_BASE, size);
	}
	if (address - FLASH_BASE < LW_BOARD_FLASH_SIZE) {
		memcpy(&value, board->memory + (address - FLASH_BASE), size);
		return value;
	}
	if (address - RAM_BASE < RAM_SIZE) {
		memcpy(&value, board->ram + (address - RAM_BASE), size);
		return value;
	}
	const struct peripheral *it = find(board, address);

	if (it == NULL) {
		return 0;
	}
	value = it->read(board, address & 0x3FCu) >> (8 * (address & 3u));
	return size < 4 ? value & ((1u << (8 * size)) - 1) : value;
}

void bus_write(struct board *board, uint32_t address, uint32_t value, unsigned int size)
{
	if (address >= SYSTEM_BASE) {
		core_write(board, address - SYSTEM_BASE, value, size);
	} else if (address - STORAGE_BASE < LW_BOARD_FLASH_SIZE - (STORAGE_BASE - FLASH_BASE)) {
		flash_array_write(board, address - FLASH_BASE, value, size);
	} else if (address - RAM_BASE < RAM_SIZE) {
		memcpy(board->ram + (address - RAM_BASE), &value, size);
	} else {
		const struct peripheral *it = find(board, address);

		if (it != NULL && size < 4) {
			board_complain(board, "%s written by %u bytes", it->name, size);
		}
		if (it != NULL) {
			it->write(board, address & 0x3FCu, value << (8 * (address & 3u)));
		}
	}
}

static uint64_t read_peripheral(uc_engine *uc, uint64_t offset, unsigned int size, void *user_data)
{
	(void)uc;
	core_access(user_data);
	return bus_read(user_data, PERIPHERALS_BASE + (uint32_t)offset, size);
}

static void write_peripheral(uc_engine *uc, uint64_t offset, unsigned int size, uint64_t value,
			     void *user_data)
{
	(void)uc;
	core_access(user_data);
	bus_write(user_data, PERIPHERALS_BASE + (uint32_t)offset, (uint32_t)value, size);
}

static uint64_t read_system(uc_engine *uc, uint64_t offset, unsigned int size, void *user_data)
{
	(void)uc;
	core_access(user_data);
	return core_read(user_data, (uint32_t)offset, size);
}

static void write_system(uc_engine *uc, uint64_t offset, unsigned int size, uint64_t value,
			 void *user_data)
{
	(void)uc;
	core_access(user_data);
	core_write(user_data, (uint32_t)offset, (uint32_t)value, size);
}

static uint64_t read_storage(uc_engine *uc, uint64_t offset, unsigned int size, void *user_data)
{
	(void)uc;
	core_access(user_data);
	return flash_array_read(user_data, STORAGE_BASE - FLASH_BASE + (uint32_t)offset, size);
}

static void write_storage(uc_engine *uc, uint64_t offset, unsigned int size, uint64_t value,
			  void *user_data)
{
	(void)uc;
	core_access(user_data);
	flash_array_write(user_data, STORAGE_BASE - FLASH_BASE + (uint32_t)offset, (uint32_t)value,
			  size);
}

static bool map(struct board *board)
{
	const uint32_t code_size = STORAGE_BASE - FLASH_BASE;
	uc_err error = UC_ERR_OK;

	error |= uc_mem_map_ptr(board->uc, FLASH_BASE, code_size, UC_PROT_READ | UC_PROT_EXEC,
				board->memory);
	error |= uc_mem_map_ptr(board->uc, RAM_BASE, RAM_SIZE, UC_PROT_ALL, board->ram);
	error |= uc_mmio_map(board->uc, STORAGE_BASE, LW_BOARD_FLASH_SIZE - code_size, read_storage,
			     board, write_storage, board);
	error |= uc_mmio_map(board->uc, PERIPHERALS_BASE, PERIPHERALS_SIZE, read_peripheral, board,
			     write_peripheral, board);
	error |= uc_mmio_map(board->uc, SYSTEM_BASE, SYSTEM_SIZE, read_system, board, write_system,
			     board);
	return error == UC_ERR_OK;
}

/* ---- life ------------------------------------------------------------------------------------ */

struct board *lw_board_create(const struct lw_board_config *config, uint8_t *flash)
{
	struct board *board = calloc(1, sizeof(*board));

	if (board == NULL) {
		return NULL;
	}
	board->config = *config;
	board->memory = flash;
	board->random = config->seed;
	board->pins.changes = malloc(CHANGES_MAX * sizeof(*board->pins.changes));
	board->line.baud = 19200;
	board->line.stop_bits = 1;
	board->rcc.hclk_hz = 16000000;
	for (int i = 0; i < EVENTS; i++) {
		board->clock.due_ps[i] = NEVER_PS;
	}
	board->clock.next_ps = NEVER_PS;
	for (unsigned int port = 0; port < PORTS; port++) {
		memset(board->ports[port].drive, DRIVE_FLOAT, sizeof(board->ports[port].drive));
	}
	if (board->pins.changes == NULL ||
	    uc_open(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS, &board->uc) != UC_ERR_OK ||
	    uc_ctl_set_cpu_model(board->uc, UC_CPU_ARM_CORTEX_M4) != UC_ERR_OK || !map(board) ||
	    !core_create(board) || !wiring_create(board)) {
		lw_board_destroy(board);
		return NULL;
	}
	clock_frequency(board, board->rcc.hclk_hz);
	seen_clear(board);
	return board;
}

void lw_board_destroy(struct board *board)
{
	if (board->uc != NULL) {
		(void)uc_close(board->uc);
	}
	free(board->core.blocks);
	free(board->pins.changes);
	free(board);
}

/* The board refers to itself, so a state is one of the board that it was taken from. */
struct lw_board_state {
	struct board board;
	uint8_t memory[LW_BOARD_FLASH_SIZE];
	uc_context *registers;
};

struct lw_board_state *lw_board_save(struct board *board)
{
	struct lw_board_state *state = malloc(sizeof(*state));

	if (state == NULL || uc_context_alloc(board->uc, &state->registers) != UC_ERR_OK) {
		free(state);
		return NULL;
	}
	state->board = *board;
	memcpy(state->memory, board->memory, sizeof(state->memory));
	(void)uc_context_save(board->uc, state->registers);
	return state;
}

void lw_board_restore(struct board *board, const struct lw_board_state *state)
{
	*board = state->board;
	memcpy(board->memory, state->memory, sizeof(state->memory));
	(void)uc_context_restore(board->uc, state->registers);
}

void lw_board_forget(struct lw_board_state *state)
{
	(void)uc_context_free(state->registers);
	free(state);
}

void board_reset(struct board *board, enum lw_board_reset why)
{
	board->pins.seen.resets[why]++;
	flash_reset(board);
	for (unsigned int i = 0; i < TIMERS; i++) {
		timer_reset(board, i);
	}
	rcc_reset(board, why);
	core_reset(board);
	exti_reset(board);
	usart_reset(board, 0);
	usart_reset(board, 1);
	iwdg_reset(board);
	gpio_reset(board);
	wiring_show(board);
	lw_plant_enable(&board->wiring.plant, false);
}

void lw_board_power_on(struct board *board)
{
	for (uint32_t i = 0; i < RAM_SIZE; i++) {
		board->ram[i] = (uint8_t)board_random(board);
	}
	board->powered = true;
	board->flash.cut = LW_BOARD_CUT_NEVER;
	board_reset(board, LW_BOARD_RESET_POWER);
}

void board_lose_power(struct board *board)
{
	board->powered = false;
	board->flash.busy_until_ps = 0;
	board->core.attention = true;
	for (int i = EVENT_RCC; i < EVENTS; i++) {
		if (i != EVENT_USART_RX) {
			event_at(board, i, NEVER_PS);
		}
	}
	gpio_reset(board);
	lw_plant_enable(&board->wiring.plant, false);
}

void lw_board_power_off(struct board *board)
{
	if (board->flash.busy_until_ps != 0) {
		flash_reset(board); /* leaves what was being done half done */
	}
	board_lose_power(board);
}

bool lw_board_powered(const struct board *board)
{
	return board->powered;
}

bool lw_board_run_ns(struct board *board, uint64_t duration_ns)
{
	const bool powered = board->powered;

	core_run(board, now_ps(board) + duration_ns * PS_PER_NS);
	return board->powered == powered;
}

uint64_t lw_board_now_ns(const struct board *board)
{
	return now_ps(board) / PS_PER_NS;
}

size_t lw_board_answer(struct board *board, uint8_t *answer, size_t size, uint64_t silence_ns,
		       uint64_t timeout_ns)
{
	const uint64_t end_ns = lw_board_now_ns(board) + timeout_ns;
	size_t count = 0;
	uint64_t last_ns = 0;

	while (board->powered && lw_board_now_ns(board) < end_ns) {
		struct lw_board_byte byte;

		while (count < size && lw_board_line_read(board, &byte, 1) == 1) {
			answer[count++] = byte.value;
			last_ns = byte.end_ns;
		}
		if (count > 0 && board->usarts[0].shifting.end_ns == 0 &&
		    lw_board_now_ns(board) >= last_ns + silence_ns) {
			break;
		}
		(void)lw_board_run_ns(board, 100000);
	}
	return count;
}

/* ---- a debugger ------------------------------------------------------------------------------ */

uint32_t lw_board_peek(struct board *board, uint32_t address)
{
	return bus_read(board, address, 4);
}

void lw_board_poke(struct board *board, uint32_t address, uint32_t value)
{
	bus_write(board, address, value, 4);
}

void lw_board_read_ram(const struct board *board, uint32_t address, uint8_t *bytes, size_t count)
{
	memcpy(bytes, board->ram + (address - RAM_BASE), count);
}

void lw_board_pass_filters(struct board *board)
{
	timer_pass_filters(board);
}

bool lw_board_asleep(const struct board *board)
{
	return board->core.sleeping;
}

bool lw_board_masked(struct board *board)
{
	uint32_t primask = 0;
	uint32_t basepri = 0;

	(void)uc_reg_read(board->uc, UC_ARM_REG_PRIMASK, &primask);
	(void)uc_reg_read(board->uc, UC_ARM_REG_BASEPRI, &basepri);
	return (primask & 1u) != 0 || basepri != 0;
}

uint32_t lw_board_register(struct board *board, unsigned int number)
{
	uint32_t value = 0;

	(void)uc_reg_read(board->uc,
			  number < 13    ? (int)(UC_ARM_REG_R0 + number)
			  : number == 13 ? UC_ARM_REG_SP
			  : number == 14 ? UC_ARM_REG_LR
					 : UC_ARM_REG_PC,
			  &value);
	return value;
}

void lw_board_set_register(struct board *board, unsigned int number, uint32_t value)
{
	(void)uc_reg_write(board->uc,
			   number < 13    ? (int)(UC_ARM_REG_R0 + number)
			   : number == 13 ? UC_ARM_REG_SP
			   : number == 14 ? UC_ARM_REG_LR
					  : UC_ARM_REG_PC,
			   &value);
}

void lw_board_drive(struct board *board, unsigned int port, unsigned int pin, unsigned int drive)
{
	gpio_drive(board, port, pin, (enum drive)drive);
}

bool lw_board_level(const struct board *board, unsigned int port, unsigned int pin)
{
	return gpio_level(board, port, pin);
}

uint32_t lw_board_clock_hz(const struct board *board, unsigned int which)
{
	return which == 0 ? board->rcc.hclk_hz : board->rcc.pclk_hz[which - 1];
}

/** Layout of what Python copies. */
const struct lw_layout lw_layout_board[] = {
	LW_LAYOUT_STRUCT(lw_board_config),
	LW_LAYOUT_MEMBER(lw_board_config, seed),
	LW_LAYOUT_MEMBER(lw_board_config, carriage_um),
	LW_LAYOUT_MEMBER(lw_board_config, cycles_permille),
	LW_LAYOUT_MEMBER(lw_board_config, hse_hz),
	LW_LAYOUT_MEMBER(lw_board_config, lsi_hz),
	LW_LAYOUT_MEMBER(lw_board_config, flash_word_ns),
	LW_LAYOUT_MEMBER(lw_board_config, flash_erase_us),
	LW_LAYOUT_MEMBER(lw_board_config, phase_error_permille),
	LW_LAYOUT_MEMBER(lw_board_config, encoder_pulses_per_rev),
	LW_LAYOUT_MEMBER(lw_board_config, line_echo),
	LW_LAYOUT_MEMBER(lw_board_config, button),
	LW_LAYOUT_STRUCT(lw_board_seen),
	LW_LAYOUT_MEMBER(lw_board_seen, steps),
	LW_LAYOUT_MEMBER(lw_board_seen, pulses),
	LW_LAYOUT_MEMBER(lw_board_seen, pulse_min_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, pulse_max_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, space_min_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, dir_setup_min_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, dir_hold_min_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, transitions),
	LW_LAYOUT_MEMBER(lw_board_seen, edges),
	LW_LAYOUT_MEMBER(lw_board_seen, transition_spacing_min_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, edge_to_step_max_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, de_before_min_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, de_after_max_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, de_after_min_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, sent_without_driver),
	LW_LAYOUT_MEMBER(lw_board_seen, instructions),
	LW_LAYOUT_MEMBER(lw_board_seen, cycles),
	LW_LAYOUT_MEMBER(lw_board_seen, stalled_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, stall_max_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, elapsed_ns),
	LW_LAYOUT_MEMBER(lw_board_seen, masked_max_instructions),
	LW_LAYOUT_MEMBER(lw_board_seen, flash_operations),
	LW_LAYOUT_MEMBER(lw_board_seen, resets),
	LW_LAYOUT_STRUCT(lw_board_cost),
	LW_LAYOUT_MEMBER(lw_board_cost, count),
	LW_LAYOUT_MEMBER(lw_board_cost, sum_instructions),
	LW_LAYOUT_MEMBER(lw_board_cost, min_instructions),
	LW_LAYOUT_MEMBER(lw_board_cost, max_instructions),
	LW_LAYOUT_STRUCT(lw_board_byte),
	LW_LAYOUT_MEMBER(lw_board_byte, start_ns),
	LW_LAYOUT_MEMBER(lw_board_byte, end_ns),
	LW_LAYOUT_MEMBER(lw_board_byte, baud_millihz),
	LW_LAYOUT_MEMBER(lw_board_byte, value),
	LW_LAYOUT_MEMBER(lw_board_byte, parity),
	LW_LAYOUT_MEMBER(lw_board_byte, stop_bits),
	LW_LAYOUT_STRUCT(lw_board_change),
	LW_LAYOUT_MEMBER(lw_board_change, time_ns),
	LW_LAYOUT_MEMBER(lw_board_change, port),
	LW_LAYOUT_MEMBER(lw_board_change, pin),
	LW_LAYOUT_MEMBER(lw_board_change, level),
	LW_LAYOUT_VALUE(lw_board_cut, LW_BOARD_CUT_NEVER),
	LW_LAYOUT_VALUE(lw_board_cut, LW_BOARD_CUT_BEFORE),
	LW_LAYOUT_VALUE(lw_board_cut, LW_BOARD_CUT_IN),
	LW_LAYOUT_VALUE(lw_board_cut, LW_BOARD_CUT_AFTER),
	{0},
};
