/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What Unicorn's Cortex-M4 lacks: exception entry and return, the NVIC, the system control block
 * and SysTick. By the ARMv7-M Architecture Reference Manual (DDI 0403): B1.5 exceptions, B3.2
 * system control, B3.3 SysTick, B3.4 NVIC; numbers of interrupts and priority bits: RM0390, 10.1.
 *
 * Time is counted block by block, so an interrupt comes at the end of the block that it falls into,
 * 3.7 instructions on average. An access to a peripheral knows its own instruction.
 */
#include "parts.h"

#include <stdlib.h>

/** Cycles of an entry, of a return, and of one after the other without unstacking. */
#define ENTRY_CYCLES      12u
#define RETURN_CYCLES     10u
#define TAIL_CHAIN_CYCLES 6u

#define PRIORITY_BITS_MASK 0xF0u
#define NO_PRIORITY        256

#define EXC_RETURN_HANDLER    0xFFFFFFF1u
#define EXC_RETURN_THREAD_MSP 0xFFFFFFF9u
#define EXC_RETURN_THREAD_PSP 0xFFFFFFFDu
#define EXC_RETURN_MIN        0xFFFFFFE0u
#define EXC_RETURN_PSP        4u

#define XPSR_IPSR     0x1FFu
#define XPSR_ALIGN    (1u << 9)
#define XPSR_THUMB    (1u << 24)
#define XPSR_FLAGS    0xF80F0000u /* N, Z, C, V, Q, GE */
#define CONTROL_SPSEL 2u

#define CCR_BFHFNMIGN     (1u << 8)
#define CCR_STKALIGN      (1u << 9)
#define AIRCR_KEY         0x05FA0000u
#define AIRCR_SYSRESETREQ 4u
#define SHCSR_MEMFAULTENA (1u << 16)
#define SHCSR_BUSFAULTENA (1u << 17)
#define SHCSR_USGFAULTENA (1u << 18)
#define CFSR_IBUSERR      (1u << 8)
#define CFSR_PRECISERR    (1u << 9)
#define CFSR_BFARVALID    (1u << 15)
#define CFSR_UNDEFINSTR   (1u << 16)
#define HFSR_FORCED       (1u << 30)
#define HFSR_DEBUGEVT     (1u << 31)

#define SYSTICK_ENABLE    1u
#define SYSTICK_TICKINT   2u
#define SYSTICK_CLKSOURCE 4u
#define SYSTICK_COUNTFLAG (1u << 16)

/* ---- registers ------------------------------------------------------------------------------- */

static uint32_t get(const struct board *board, int which)
{
	uint32_t value = 0;

	(void)uc_reg_read(board->uc, which, &value);
	return value;
}

static void set(struct board *board, int which, uint32_t value)
{
	(void)uc_reg_write(board->uc, which, &value);
}

static void look_at_masks(struct board *board)
{
	struct core *core = &board->core;
	const bool masked =
		(get(board, UC_ARM_REG_PRIMASK) & 1u) != 0 || get(board, UC_ARM_REG_BASEPRI) != 0;

	if (masked && !core->masked) {
		core->masked_since = core->instructions;
	} else if (!masked && core->masked) {
		const uint64_t instructions = core->instructions - core->masked_since;

		if (instructions > board->pins.seen.masked_max_instructions) {
			board->pins.seen.masked_max_instructions = instructions;
		}
	}
	core->masked = masked;
}

/* ---- blocks ---------------------------------------------------------------------------------- */

/** What a block of instructions may do that has to be looked at behind it. */
#define BLOCK_MASKS 1u /* changes PRIMASK, BASEPRI or FAULTMASK */
#define BLOCK_WFI   2u

/** The image does not change, so its blocks are measured once. */
#define BLOCKS ((STORAGE_BASE - FLASH_BASE) / 2)

static bool is_wide(uint16_t halfword)
{
	return (halfword >> 11) >= 0x1D;
}

static const uint8_t *code_at(const struct board *board, uint32_t address)
{
	if (address - FLASH_BASE < LW_BOARD_FLASH_SIZE) {
		return board->memory + (address - FLASH_BASE);
	}
	if (address - RAM_BASE < RAM_SIZE) {
		return board->ram + (address - RAM_BASE);
	}
	return NULL;
}

static uint16_t halfword_at(const uint8_t *code)
{
	return (uint16_t)(code[0] | code[1] << 8);
}

static struct block measure(const struct board *board, uint32_t address, uint32_t size)
{
	const uint8_t *code = code_at(board, address);
	struct block block = {.size = (uint16_t)size};

	for (uint32_t at = 0; code != NULL && at < size; block.instructions++) {
		const uint16_t first = halfword_at(code + at);

		if ((first & 0xFFE0) == 0xB660 || (first & 0xFFF0) == 0xF380) {
			block.flags |= BLOCK_MASKS; /* CPS; MSR */
		} else if (first == 0xBF30) {
			block.flags |= BLOCK_WFI;
		}
		at += is_wide(first) ? 4 : 2;
	}
	return block;
}

/** Address of an instruction of a block, or of the next one that no IT covers; 0: behind it. */
static uint32_t address_of(const struct board *board, uint32_t address, uint32_t count,
			   uint64_t number)
{
	const uint8_t *code = code_at(board, address);
	uint32_t at = 0;
	uint32_t covered = 0;

	for (uint32_t i = 0; i < count; i++) {
		const uint16_t first = halfword_at(code + at);

		if (i >= number && covered == 0) {
			return address + at;
		}
		covered -= covered > 0;
		if ((first & 0xFF00) == 0xBF00 && (first & 0xF) != 0) {
			covered = 4u - (uint32_t)__builtin_ctz(first & 0xFu);
		}
		at += is_wide(first) ? 4 : 2;
	}
	return 0;
}

static void on_block(uc_engine *uc, uint64_t address, uint32_t size, void *user_data)
{
	struct board *board = user_data;
	struct core *core = &board->core;
	struct block block;

	/* The block before this one is done. */
	core->cycles_q16 +=
		(uint64_t)core->block_instructions * board->config.cycles_permille * 65536u / 1000u;
	core->instructions += core->block_instructions;
	core->block_instructions = 0;
	core->access_instructions = 0;
	core->block_accesses = 0;
	if ((core->block_flags & BLOCK_MASKS) != 0) {
		look_at_masks(board);
		core->attention |= core->pending_count != 0;
	}
	if (core->attention || core->cycles_q16 >= core->limit_q16 ||
	    (board->flash.busy_until_ps != 0 && address - FLASH_BASE < LW_BOARD_FLASH_SIZE)) {
		core->block_flags = 0;
		(void)uc_emu_stop(uc);
		return;
	}
	if (address - FLASH_BASE < 2 * BLOCKS) {
		struct block *known = &core->blocks[(address - FLASH_BASE) / 2];

		if (known->size != size) {
			*known = measure(board, (uint32_t)address, size);
		}
		block = *known;
	} else {
		block = measure(board, (uint32_t)address, size);
	}
	if (core->stop_at < core->instructions + block.instructions && core->stop_address == 0) {
		/* Passed already where an IT covered the end of the block before. */
		const uint64_t left =
			core->stop_at > core->instructions ? core->stop_at - core->instructions : 0;

		core->stop_address = address_of(board, (uint32_t)address, block.instructions, left);
		if (core->stop_address != 0) {
			(void)uc_ctl_remove_cache(uc, address, address + size);
			core->block_flags = 0;
			(void)uc_emu_stop(uc);
			return;
		}
	}
	core->block_address = (uint32_t)address;
	core->block_instructions = block.instructions;
	core->block_flags = block.flags;
}

/** May an instruction access a peripheral? All loads and stores but those by PC or SP. */
static bool may_access(const uint8_t *code)
{
	const uint16_t first = halfword_at(code);

	if (!is_wide(first)) {
		return first >> 12 == 5 || first >> 12 == 6 || first >> 12 == 7 ||
		       first >> 12 == 8 || first >> 12 == 0xC;
	}
	return ((first & 0xFE00) == 0xE800 || (first & 0xFE00) == 0xF800) && (first & 15u) < 13;
}

/*
 * The time of an access is that of its instruction: the n-th access of a block is at its n-th load
 * or store, or behind that. A memory hook would tell the place, but leaves Unicorn with an old
 * state of IT (2.1.4): an instruction behind the block is skipped then.
 */
void core_access(struct board *board)
{
	struct core *core = &board->core;
	const uint8_t *code = code_at(board, core->block_address);
	uint32_t at = 0;

	if (!core->running || code == NULL) {
		return;
	}
	core->block_accesses++;
	core->access_instructions = 0;
	for (uint32_t left = core->block_accesses; left > 0 && at < core->block_size;) {
		left -= may_access(code + at);
		at += is_wide(halfword_at(code + at)) ? 4 : 2;
		core->access_instructions++;
	}
}

/* ---- priorities ------------------------------------------------------------------------------ */

static int group_mask(const struct core *core)
{
	const unsigned int group = core->aircr >> 8 & 7u;

	return (int)(0xFFu << (group + 1) & PRIORITY_BITS_MASK);
}

static int priority_of(const struct core *core, unsigned int exception)
{
	switch (exception) {
	case EXCEPTION_NMI:
		return -2;
	case EXCEPTION_HARD:
		return -1;
	default:
		return core->priority[exception] & group_mask(core);
	}
}

static int active_priority(const struct core *core)
{
	int priority = NO_PRIORITY;

	for (unsigned int i = 0; i < core->depth; i++) {
		const int own = priority_of(core, core->active[i].number);

		priority = own < priority ? own : priority;
	}
	return priority;
}

static int execution_priority(const struct board *board, bool without_primask)
{
	const int basepri = (int)get(board, UC_ARM_REG_BASEPRI) & group_mask(&board->core);
	int priority = active_priority(&board->core);

	if (basepri != 0 && basepri < priority) {
		priority = basepri;
	}
	if (!without_primask && (get(board, UC_ARM_REG_PRIMASK) & 1u) != 0 && priority > 0) {
		priority = 0;
	}
	if ((get(board, UC_ARM_REG_FAULTMASK) & 1u) != 0 && priority > -1) {
		priority = -1;
	}
	return priority;
}

/** The pending exception that comes first; 0 if there is none. */
static unsigned int first_pending(const struct core *core)
{
	unsigned int first = 0;
	int best = NO_PRIORITY;

	if (core->pending_count == 0) {
		return 0;
	}
	for (unsigned int i = 1; i < LW_BOARD_EXCEPTIONS; i++) {
		/* Of equal groups the subpriority decides, then the number. */
		const int priority = i == EXCEPTION_NMI || i == EXCEPTION_HARD
					     ? priority_of(core, i)
					     : core->priority[i];

		if (core->pending[i] && core->enabled[i] && priority < best) {
			best = priority;
			first = i;
		}
	}
	return first;
}

static void set_pending(struct board *board, unsigned int exception, bool pending)
{
	struct core *core = &board->core;

	if (core->pending[exception] != pending) {
		core->pending[exception] = pending;
		core->pending_count += pending ? 1u : (unsigned int)-1;
	}
	core->attention = true;
}

void core_pend(struct board *board, unsigned int exception)
{
	set_pending(board, exception, true);
}

/** An interrupt's line is a level: it pends when it rises, and again where it is up at the end. */
void core_line(struct board *board, unsigned int irq, bool level)
{
	struct core *core = &board->core;
	const unsigned int exception = EXCEPTION_IRQ0 + irq;

	if (level && !core->line[exception]) {
		set_pending(board, exception, true);
	}
	core->line[exception] = level;
}

/* ---- entry and return ------------------------------------------------------------------------ */

static uint32_t *stacked(struct board *board, uint32_t address)
{
	if (address < RAM_BASE || address > RAM_BASE + RAM_SIZE - 32 || address % 4 != 0) {
		board->core.locked_up = true;
		board_complain(board, "exception with the stack pointer at 0x%08x", address);
		return NULL;
	}
	return (uint32_t *)(void *)(board->ram + (address - RAM_BASE));
}

static void spend(struct board *board, unsigned int cycles)
{
	board->core.cycles_q16 += (uint64_t)cycles << 16;
}

static uint32_t vector(struct board *board, unsigned int exception)
{
	return bus_read(board, board->core.vtor + 4 * exception, 4);
}

/** Instructions since the last look belong to who is active now. */
static void account(struct board *board)
{
	struct core *core = &board->core;

	if (core->depth > 0) {
		core->active[core->depth - 1].own_instructions +=
			core->instructions - core->measured_from;
	}
	core->measured_from = core->instructions;
}

static void begin_handler(struct board *board, unsigned int exception, uint32_t exc_return)
{
	struct core *core = &board->core;
	uint32_t control = get(board, UC_ARM_REG_CONTROL);

	account(board);
	if (exception == core->stop_exception) {
		core->stop_at = 0;
	}
	set_pending(board, exception, false);
	core->is_active[exception] = true;
	core->active[core->depth++] = (struct active){.number = (uint16_t)exception};
	set(board, UC_ARM_REG_LR, exc_return);
	/* Unicorn swaps the stack pointers on either; in this order it loses none. */
	set(board, UC_ARM_REG_CONTROL, control & ~CONTROL_SPSEL);
	set(board, UC_ARM_REG_IPSR, exception);
	/* Clears IT, and would clear the exception's number, too. */
	set(board, UC_ARM_REG_XPSR_NZCVQG,
	    (get(board, UC_ARM_REG_XPSR) & XPSR_FLAGS) | XPSR_THUMB | exception);
	set(board, UC_ARM_REG_PC, vector(board, exception));
}

static void enter(struct board *board, unsigned int exception)
{
	struct core *core = &board->core;
	const bool psp = core->depth == 0 && (get(board, UC_ARM_REG_CONTROL) & CONTROL_SPSEL) != 0;
	const int pointer = psp ? UC_ARM_REG_PSP : UC_ARM_REG_MSP;
	const uint32_t before = get(board, pointer);
	const bool align = (core->ccr & CCR_STKALIGN) != 0 && (before & 4u) != 0;
	const uint32_t sp = before - 32 - (align ? 4 : 0);
	uint32_t *const frame = stacked(board, sp);

	if (frame == NULL || core->depth == sizeof(core->active) / sizeof(core->active[0])) {
		core->locked_up = true;
		return;
	}
	frame[0] = get(board, UC_ARM_REG_R0);
	frame[1] = get(board, UC_ARM_REG_R1);
	frame[2] = get(board, UC_ARM_REG_R2);
	frame[3] = get(board, UC_ARM_REG_R3);
	frame[4] = get(board, UC_ARM_REG_R12);
	frame[5] = get(board, UC_ARM_REG_LR);
	frame[6] = get(board, UC_ARM_REG_PC) & ~1u;
	frame[7] =
		(get(board, UC_ARM_REG_XPSR) & ~XPSR_ALIGN) | XPSR_THUMB | (align ? XPSR_ALIGN : 0);
	set(board, pointer, sp);
	spend(board, ENTRY_CYCLES);
	begin_handler(board, exception,
		      core->depth > 0 ? EXC_RETURN_HANDLER
		      : psp           ? EXC_RETURN_THREAD_PSP
				      : EXC_RETURN_THREAD_MSP);
}

static void leave(struct board *board, uint32_t exc_return)
{
	struct core *core = &board->core;
	uint32_t control = get(board, UC_ARM_REG_CONTROL);
	const int pointer = exc_return & EXC_RETURN_PSP ? UC_ARM_REG_PSP : UC_ARM_REG_MSP;
	unsigned int next;
	uint32_t *frame;
	uint32_t xpsr;
	uint32_t sp;

	if (core->depth == 0) {
		core->locked_up = true;
		board_complain(board, "return from an exception outside of any");
		return;
	}
	account(board);
	core->depth--;

	const struct active *done = &core->active[core->depth];

	core->is_active[done->number] = false;
	seen_cost(board, done->number, done->own_instructions);
	if (done->number != EXCEPTION_NMI) {
		set(board, UC_ARM_REG_FAULTMASK, 0);
	}
	if (core->line[done->number]) {
		set_pending(board, done->number, true);
	}
	next = first_pending(core);
	if (next != 0 && priority_of(core, next) < execution_priority(board, false)) {
		spend(board, TAIL_CHAIN_CYCLES);
		begin_handler(board, next, exc_return);
		return;
	}
	sp = get(board, pointer);
	frame = stacked(board, sp);
	if (frame == NULL) {
		return;
	}
	xpsr = frame[7];
	set(board, UC_ARM_REG_R0, frame[0]);
	set(board, UC_ARM_REG_R1, frame[1]);
	set(board, UC_ARM_REG_R2, frame[2]);
	set(board, UC_ARM_REG_R3, frame[3]);
	set(board, UC_ARM_REG_R12, frame[4]);
	set(board, UC_ARM_REG_LR, frame[5]);
	set(board, pointer, sp + 32 + (xpsr & XPSR_ALIGN ? 4 : 0));
	set(board, UC_ARM_REG_IPSR, xpsr & XPSR_IPSR);
	control = exc_return & EXC_RETURN_PSP ? control | CONTROL_SPSEL : control & ~CONTROL_SPSEL;
	set(board, UC_ARM_REG_CONTROL, control);
	set(board, UC_ARM_REG_XPSR_NZCVQG, xpsr);
	set(board, UC_ARM_REG_PC, frame[6] | 1u);
	spend(board, RETURN_CYCLES);
	if ((xpsr & XPSR_IPSR) != (core->depth > 0 ? core->active[core->depth - 1].number : 0u)) {
		core->locked_up = true;
		board_complain(board, "the stack returns to exception %u", xpsr & XPSR_IPSR);
	}
}

/** A load or store that faults is passed over in HardFault and NMI where CCR says so (B3.2.8). */
static bool pass_over(struct board *board, uint32_t fault)
{
	const uint32_t pc = get(board, UC_ARM_REG_PC);
	const uint8_t *code = code_at(board, pc & ~1u);

	if (fault != EXCEPTION_BUS || (board->core.ccr & CCR_BFHFNMIGN) == 0 ||
	    active_priority(&board->core) >= 0 || code == NULL ||
	    board->core.fault_address == (pc & ~1u)) {
		return false;
	}
	set(board, UC_ARM_REG_PC, (pc & ~1u) + (is_wide(halfword_at(code)) ? 4 : 2));
	return true;
}

/** A fault of the instruction at PC; escalates where its handler may not run (B1.5.7). */
static void raise_fault(struct board *board, unsigned int exception)
{
	static const uint32_t enables[] = {
		[EXCEPTION_MEMORY] = SHCSR_MEMFAULTENA,
		[EXCEPTION_BUS] = SHCSR_BUSFAULTENA,
		[EXCEPTION_USAGE] = SHCSR_USGFAULTENA,
	};
	struct core *core = &board->core;
	const int now = execution_priority(board, false);

	if (exception != EXCEPTION_HARD &&
	    ((exception <= EXCEPTION_USAGE && (core->shcsr & enables[exception]) == 0) ||
	     priority_of(core, exception) >= now)) {
		core->hfsr |= HFSR_FORCED;
		exception = EXCEPTION_HARD;
	}
	if (priority_of(core, exception) >= now) {
		core->locked_up = true;
		board_complain(board, "lockup at 0x%08x", get(board, UC_ARM_REG_PC));
		return;
	}
	enter(board, exception);
}

static void on_interrupt(uc_engine *uc, uint32_t number, void *user_data)
{
	struct board *board = user_data;
	struct core *core = &board->core;

	switch (number) {
	case 2:
		core->svc = 1;
		break;
	case 8:
		core->exc_return = get(board, UC_ARM_REG_PC) | 1u;
		break;
	case 7:
		core->hfsr |= HFSR_DEBUGEVT;
		core->fault = EXCEPTION_HARD;
		break;
	default:
		core->fault = EXCEPTION_BUS;
		break;
	}
	(void)uc_emu_stop(uc);
}

static bool on_invalid(uc_engine *uc, uc_mem_type type, uint64_t address, int size, int64_t value,
		       void *user_data)
{
	struct board *board = user_data;
	struct core *core = &board->core;

	(void)uc;
	(void)size;
	(void)value;
	if (type == UC_MEM_FETCH_UNMAPPED && address >= (EXC_RETURN_MIN & ~1u)) {
		core->exc_return = (uint32_t)address | 1u;
		return false;
	}
	core->fault = EXCEPTION_BUS;
	core->fault_address = (uint32_t)address;
	core->cfsr |= type == UC_MEM_FETCH_UNMAPPED || type == UC_MEM_FETCH_PROT
			      ? CFSR_IBUSERR
			      : CFSR_PRECISERR | CFSR_BFARVALID;
	core->bfar = (uint32_t)address;
	return false;
}

/* ---- running --------------------------------------------------------------------------------- */

/** Take the first pending exception, if it may come now. */
static bool take(struct board *board)
{
	struct core *core = &board->core;
	const unsigned int next = first_pending(core);

	core->attention = false;
	if (next == 0 || priority_of(core, next) >= execution_priority(board, false)) {
		return false;
	}
	enter(board, next);
	return true;
}

/** Up to the next event, the next exception, or the end of the time. */
static void execute(struct board *board, uint64_t until_ps)
{
	struct core *core = &board->core;
	struct clock *clock = &board->clock;
	uc_err error;

	clock->limit_ps = until_ps < clock->next_ps ? until_ps : clock->next_ps;
	core->limit_q16 = clock_q16_until(board, clock->limit_ps);
	core->block_instructions = 0;
	core->block_flags = 0;
	core->running = true;
	error = uc_emu_start(board->uc, get(board, UC_ARM_REG_PC) | 1u,
			     core->stop_address != 0 ? core->stop_address : 0xFFFFFFFE, 0, 0);
	core->running = false;
	core->access_instructions = 0;
	/* What ended by itself has been done; what the block hook stopped has none of it. */
	core->cycles_q16 +=
		(uint64_t)core->block_instructions * board->config.cycles_permille * 65536u / 1000u;
	core->instructions += core->block_instructions;
	core->block_instructions = 0;
	look_at_masks(board);
	if (core->exc_return != 0) {
		const uint32_t exc_return = core->exc_return;

		core->exc_return = 0;
		leave(board, exc_return);
	} else if (core->svc != 0) {
		core->svc = 0;
		raise_fault(board, EXCEPTION_SVC);
	} else if (core->fault != 0) {
		const uint32_t fault = core->fault;

		core->fault = 0;
		if (!pass_over(board, fault)) {
			raise_fault(board, fault);
		}
	} else if (error == UC_ERR_INSN_INVALID) {
		core->cfsr |= CFSR_UNDEFINSTR;
		raise_fault(board, EXCEPTION_USAGE);
	} else if (error != UC_ERR_OK) {
		core->locked_up = true;
		board_complain(board, "the emulator: %s at 0x%08x", uc_strerror(error),
			       get(board, UC_ARM_REG_PC));
	} else if ((core->block_flags & BLOCK_WFI) != 0) {
		core->sleeping = true;
	}
}

void core_run(struct board *board, uint64_t until_ps)
{
	struct core *core = &board->core;
	struct clock *clock = &board->clock;

	const bool powered = board->powered;

	while (board->powered == powered && now_ps(board) < until_ps &&
	       core->instructions < core->stop_at) {
		clock_run_events(board);
		if (core->reset_requested) {
			core->reset_requested = false;
			board_reset(board, LW_BOARD_RESET_SOFTWARE);
			continue;
		}

		const uint64_t pause_ps = until_ps < clock->next_ps ? until_ps : clock->next_ps;

		/* Code in the flash waits for it. */
		if (board->flash.busy_until_ps != 0 && board->powered &&
		    get(board, UC_ARM_REG_PC) - FLASH_BASE < LW_BOARD_FLASH_SIZE) {
			const uint64_t from_ps = now_ps(board);

			if (pause_ps > from_ps) {
				seen_stall(board, from_ps, pause_ps);
				clock_set(board, pause_ps);
			}
			continue;
		}
		if (core->locked_up || !board->powered) {
			clock_set(board, pause_ps);
			continue;
		}
		if (core->sleeping) {
			const unsigned int next = first_pending(core);

			/* PRIMASK does not keep it asleep (B1.5.19). */
			if (next == 0 ||
			    priority_of(core, next) >= execution_priority(board, true)) {
				if (pause_ps > now_ps(board)) {
					clock_set(board, pause_ps);
				}
				continue;
			}
			core->sleeping = false;
		}
		if (take(board)) {
			continue;
		}
		if (core->hung_depth != 0 && core->hung_depth == core->depth) {
			clock_set(board, pause_ps);
			continue;
		}
		if (pause_ps > now_ps(board)) {
			execute(board, until_ps);
		}
	}
}

void core_reset(struct board *board)
{
	struct core *core = &board->core;
	const uint64_t cycles_q16 = core->cycles_q16;
	const uint64_t instructions = core->instructions;

	*core = (struct core){
		.blocks = core->blocks,
		.cycles_q16 = cycles_q16,
		.instructions = instructions,
		.measured_from = instructions,
		.stop_at = core->stop_at,
		.stop_exception = core->stop_exception,
		.vtor = FLASH_BASE,
		.ccr = CCR_STKALIGN,
		.systick_zero_ps = now_ps(board),
	};
	for (unsigned int i = 0; i < EXCEPTION_IRQ0; i++) {
		core->enabled[i] = true;
	}
	event_at(board, EVENT_SYSTICK, NEVER_PS);
	set(board, UC_ARM_REG_IPSR, 0);
	set(board, UC_ARM_REG_CONTROL, 0);
	set(board, UC_ARM_REG_PRIMASK, 0);
	set(board, UC_ARM_REG_BASEPRI, 0);
	set(board, UC_ARM_REG_FAULTMASK, 0);
	set(board, UC_ARM_REG_LR, 0xFFFFFFFF);
	set(board, UC_ARM_REG_MSP, vector(board, 0) & ~3u);
	set(board, UC_ARM_REG_PC, vector(board, 1));
}

uint64_t lw_board_run_instructions(struct board *board, uint64_t instructions, uint64_t duration_ns)
{
	struct core *core = &board->core;
	const uint64_t from = core->instructions;

	core->stop_at = from + instructions;
	(void)lw_board_run_ns(board, duration_ns);
	core->stop_at = UINT64_MAX;
	core->stop_address = 0;
	return core->instructions - from;
}

bool lw_board_run_to_exception(struct board *board, unsigned int exception, uint64_t duration_ns)
{
	struct core *core = &board->core;
	bool entered;

	core->stop_exception = exception;
	(void)lw_board_run_ns(board, duration_ns);
	entered = core->stop_at == 0;
	core->stop_at = UINT64_MAX;
	core->stop_exception = 0;
	return entered;
}

void lw_board_hang_handler(struct board *board)
{
	board->core.hung_depth = board->core.depth;
}

bool core_create(struct board *board)
{
	uc_hook hook;
	uc_err error = UC_ERR_OK;

	board->core.stop_at = UINT64_MAX;
	board->core.blocks = calloc(BLOCKS, sizeof(struct block));
	error |= uc_hook_add(board->uc, &hook, UC_HOOK_BLOCK, (void *)on_block, board, 1, 0);
	error |= uc_hook_add(board->uc, &hook, UC_HOOK_INTR, (void *)on_interrupt, board, 1, 0);
	error |=
		uc_hook_add(board->uc, &hook, UC_HOOK_MEM_INVALID, (void *)on_invalid, board, 1, 0);
	return error == UC_ERR_OK && board->core.blocks != NULL;
}

/* ---- SysTick --------------------------------------------------------------------------------- */

static uint32_t systick_hz(const struct board *board)
{
	return board->core.systick_ctrl & SYSTICK_CLKSOURCE ? board->rcc.hclk_hz
							    : board->rcc.hclk_hz / 8;
}

/** It goes from 0 to the reload value, and down to 0 again: a count of LOAD + 1. */
static void systick_plan(struct board *board)
{
	const struct core *core = &board->core;

	if ((core->systick_ctrl & SYSTICK_ENABLE) == 0 || core->systick_reload == 0) {
		event_at(board, EVENT_SYSTICK, NEVER_PS);
		return;
	}
	event_at(board, EVENT_SYSTICK,
		 core->systick_zero_ps + ps_for(core->systick_reload + 1u, systick_hz(board)));
}

static uint32_t systick_value(const struct board *board)
{
	const struct core *core = &board->core;
	const uint64_t ticks = ticks_in(now_ps(board) - core->systick_zero_ps, systick_hz(board));

	if ((core->systick_ctrl & SYSTICK_ENABLE) == 0 || core->systick_reload == 0 || ticks == 0 ||
	    ticks > core->systick_reload) {
		return 0;
	}
	return (uint32_t)(core->systick_reload + 1u - ticks);
}

void core_systick_event(struct board *board)
{
	struct core *core = &board->core;

	core->systick_zero_ps = now_ps(board);
	core->systick_reload = core->systick_load;
	core->systick_counted = true;
	if (core->systick_ctrl & SYSTICK_TICKINT) {
		core_pend(board, EXCEPTION_SYSTICK);
	}
	systick_plan(board);
}

/** The frequency changes: the count goes on from where it stands. */
void core_systick_rebase(struct board *board)
{
	struct core *core = &board->core;
	const uint64_t now = now_ps(board);

	if ((core->systick_ctrl & SYSTICK_ENABLE) != 0) {
		core->systick_zero_ps = now;
		systick_plan(board);
	}
}

static uint32_t systick_read(struct board *board, uint32_t offset)
{
	struct core *core = &board->core;
	uint32_t value;

	event_catch_up(board, EVENT_SYSTICK);
	switch (offset) {
	case 0x10:
		value = core->systick_ctrl | (core->systick_counted ? SYSTICK_COUNTFLAG : 0);
		core->systick_counted = false;
		return value;
	case 0x14:
		return core->systick_load;
	case 0x18:
		return systick_value(board);
	default:
		return 0; /* CALIB */
	}
}

static void systick_write(struct board *board, uint32_t offset, uint32_t value)
{
	struct core *core = &board->core;

	event_catch_up(board, EVENT_SYSTICK);
	switch (offset) {
	case 0x10:
		if ((value & SYSTICK_ENABLE) != 0 && (core->systick_ctrl & SYSTICK_ENABLE) == 0) {
			core->systick_zero_ps = now_ps(board);
			core->systick_reload = core->systick_load;
		}
		core->systick_ctrl = value & 7u;
		break;
	case 0x14:
		core->systick_load = value & 0xFFFFFFu;
		return; /* counts from the next time that it is 0 */
	case 0x18:
		core->systick_zero_ps = now_ps(board);
		core->systick_reload = core->systick_load;
		core->systick_counted = false;
		break;
	default:
		return;
	}
	systick_plan(board);
}

/* ---- NVIC and system control block ----------------------------------------------------------- */

static uint32_t nvic_bits(const bool *flags, uint32_t word)
{
	uint32_t bits = 0;

	for (unsigned int i = 0; i < 32; i++) {
		const unsigned int exception = EXCEPTION_IRQ0 + 32 * word + i;

		if (exception < LW_BOARD_EXCEPTIONS && flags[exception]) {
			bits |= 1u << i;
		}
	}
	return bits;
}

static void nvic_set(struct board *board, uint32_t word, uint32_t bits, bool pend, bool value)
{
	struct core *core = &board->core;

	for (unsigned int i = 0; i < 32; i++) {
		const unsigned int exception = EXCEPTION_IRQ0 + 32 * word + i;

		if (exception >= LW_BOARD_EXCEPTIONS || (bits >> i & 1u) == 0) {
			continue;
		}
		if (pend) {
			/* A line that is up pends again at once. */
			set_pending(board, exception,
				    value ||
					    (core->line[exception] && !core->is_active[exception]));
		} else {
			core->enabled[exception] = value;
		}
	}
	core->attention = true;
}

static uint32_t bytes_of(const uint8_t *from, unsigned int size)
{
	uint32_t value = 0;

	for (unsigned int i = 0; i < size; i++) {
		value |= (uint32_t)from[i] << (8 * i);
	}
	return value;
}

static uint32_t icsr(const struct core *core)
{
	uint32_t value = core->depth > 0 ? core->active[core->depth - 1].number : 0;

	value |= first_pending(core) << 12;
	value |= core->depth <= 1 ? 1u << 11 : 0;
	value |= core->pending[EXCEPTION_SYSTICK] ? 1u << 26 : 0;
	value |= core->pending[EXCEPTION_PENDSV] ? 1u << 28 : 0;
	return value;
}

static uint32_t *kept(struct core *core, uint32_t offset)
{
	return &core->other[(offset / 4) % (sizeof(core->other) / sizeof(core->other[0]))];
}

static uint32_t scs_read(struct board *board, uint32_t offset, unsigned int size)
{
	struct core *core = &board->core;

	if (offset >= 0x10 && offset < 0x20) {
		return systick_read(board, offset);
	}
	if (offset >= 0x100 && offset < 0x300) {
		const uint32_t word = offset / 4 % 32;

		return nvic_bits(offset < 0x200 ? core->enabled : core->pending, word % 8);
	}
	if (offset >= 0x300 && offset < 0x320) {
		return nvic_bits(core->is_active, (offset - 0x300) / 4);
	}
	if (offset >= 0x400 && offset + size <= 0x400 + LW_BOARD_EXCEPTIONS - EXCEPTION_IRQ0) {
		return bytes_of(&core->priority[EXCEPTION_IRQ0 + offset - 0x400], size);
	}
	if (offset >= 0xD18 && offset < 0xD24) {
		return bytes_of(&core->priority[4 + offset - 0xD18], size);
	}
	switch (offset) {
	case 0x004:
		return 3; /* ICTR: 97 lines */
	case 0xD00:
		return 0x410FC241; /* Cortex-M4 r0p1 */
	case 0xD04:
		return icsr(core);
	case 0xD08:
		return core->vtor;
	case 0xD0C:
		return 0xFA050000u | (core->aircr & 0x700u);
	case 0xD10:
		return core->scr;
	case 0xD14:
		return core->ccr;
	case 0xD24:
		return core->shcsr;
	case 0xD28:
		return core->cfsr;
	case 0xD2C:
		return core->hfsr;
	case 0xD38:
		return core->bfar;
	case 0xD90:
		return 8u << 8; /* MPU_TYPE: eight regions, none enforced */
	case 0xDFC:
		return core->demcr;
	default:
		return *kept(core, offset);
	}
}

static void scs_write(struct board *board, uint32_t offset, uint32_t value, unsigned int size)
{
	struct core *core = &board->core;

	core->attention = true;
	if (offset >= 0x10 && offset < 0x20) {
		systick_write(board, offset, value);
		return;
	}
	if (offset >= 0x100 && offset < 0x300) {
		nvic_set(board, offset / 4 % 8, value, offset >= 0x200, offset % 0x100 < 0x80);
		return;
	}
	if (offset >= 0x400 && offset + size <= 0x400 + LW_BOARD_EXCEPTIONS - EXCEPTION_IRQ0) {
		for (unsigned int i = 0; i < size; i++) {
			core->priority[EXCEPTION_IRQ0 + offset - 0x400 + i] =
				(uint8_t)(value >> (8 * i)) & PRIORITY_BITS_MASK;
		}
		return;
	}
	if (offset >= 0xD18 && offset < 0xD24) {
		for (unsigned int i = 0; i < size; i++) {
			core->priority[4 + offset - 0xD18 + i] =
				(uint8_t)(value >> (8 * i)) & PRIORITY_BITS_MASK;
		}
		return;
	}
	switch (offset) {
	case 0xD04:
		if (value & 1u << 31) {
			core_pend(board, EXCEPTION_NMI);
		}
		if (value & (1u << 28 | 1u << 27)) {
			set_pending(board, EXCEPTION_PENDSV, (value & 1u << 28) != 0);
		}
		if (value & (1u << 26 | 1u << 25)) {
			set_pending(board, EXCEPTION_SYSTICK, (value & 1u << 26) != 0);
		}
		break;
	case 0xD08:
		core->vtor = value & ~0x1FFu;
		break;
	case 0xD0C:
		if ((value & 0xFFFF0000u) == AIRCR_KEY) {
			core->aircr = value & 0x700u;
			core->reset_requested = (value & AIRCR_SYSRESETREQ) != 0;
		}
		break;
	case 0xD10:
		core->scr = value;
		break;
	case 0xD14:
		core->ccr = value;
		break;
	case 0xD24:
		core->shcsr = value & 0x70000u;
		break;
	case 0xD28:
		core->cfsr &= ~value;
		break;
	case 0xD2C:
		core->hfsr &= ~value;
		break;
	case 0xDFC:
		core->demcr = value;
		break;
	case 0xF00:
		core_pend(board, EXCEPTION_IRQ0 + (value & 0x7Fu));
		break;
	default:
		*kept(core, offset) = value;
		break;
	}
}

/** DWT_CYCCNT counts where DEMCR lets it (C1.8). */
static uint32_t dwt_cycles(const struct board *board)
{
	const struct core *core = &board->core;

	if ((core->demcr & 1u << 24) == 0 || (core->dwt_ctrl & 1u) == 0) {
		return 0;
	}
	return (uint32_t)ticks_in(now_ps(board) - core->dwt_base_ps, board->rcc.hclk_hz);
}

uint32_t core_read(struct board *board, uint32_t offset, unsigned int size)
{
	switch (offset) {
	case 0x1000:
		return board->core.dwt_ctrl;
	case 0x1004:
		return dwt_cycles(board);
	case 0x42000:
		return 0x421; /* DBGMCU_IDCODE: STM32F446 (RM0390, 33.6.1) */
	default:
		return offset >= 0xE000 && offset < 0xF000 ? scs_read(board, offset - 0xE000, size)
							   : 0;
	}
}

void core_write(struct board *board, uint32_t offset, uint32_t value, unsigned int size)
{
	switch (offset) {
	case 0x1000:
		board->core.dwt_ctrl = value;
		break;
	case 0x1004:
		board->core.dwt_base_ps = now_ps(board) - ps_for(value, board->rcc.hclk_hz);
		break;
	default:
		if (offset >= 0xE000 && offset < 0xF000) {
			scs_write(board, offset - 0xE000, value, size);
		}
		break;
	}
}
