/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Reset and clock control: RM0390, 6.2 (clocks), 6.3 (registers), 6.1.1 and 6.3.21 (causes of a
 * reset); over-drive: 5.1.4. The frequencies are those that the firmware's own writes make.
 */
#include "parts.h"

#define HSI_HZ 16000000u

/* Start-up times (data sheet, 6.3.8 to 6.3.11). */
#define HSE_START_PS       (2000ull * PS_PER_US)
#define PLL_LOCK_PS        (200ull * PS_PER_US)
#define LSI_START_PS       (40ull * PS_PER_US)
#define OVERDRIVE_START_PS (45ull * PS_PER_US)

#define CR_HSION       (1u << 0)
#define CR_HSIRDY      (1u << 1)
#define CR_HSEON       (1u << 16)
#define CR_HSERDY      (1u << 17)
#define CR_HSEBYP      (1u << 18)
#define CR_CSSON       (1u << 19)
#define CR_PLLON       (1u << 24)
#define CR_PLLRDY      (1u << 25)
#define CR_WRITABLE    (CR_HSION | 0xF8u | CR_HSEON | CR_HSEBYP | CR_CSSON | CR_PLLON)
#define CIR_CSSF       (1u << 7)
#define CIR_CSSC       (1u << 23)
#define PLLCFGR_HSE    (1u << 22)
#define CFGR_SW        3u
#define CSR_LSION      1u
#define CSR_LSIRDY     2u
#define CSR_RMVF       (1u << 24)
#define CSR_BORRSTF    (1u << 25)
#define CSR_PINRSTF    (1u << 26)
#define CSR_PORRSTF    (1u << 27)
#define CSR_SFTRSTF    (1u << 28)
#define CSR_IWDGRSTF   (1u << 29)
#define DCKCFGR_TIMPRE (1u << 24)
#define PWR_CR_ODEN    (1u << 16)
#define PWR_CR_ODSWEN  (1u << 17)

/** Limits of the buses (data sheet, table 16: over-drive off, on). */
static const uint32_t hclk_max_hz[] = {168000000, 180000000};
static const uint32_t pclk_max_hz[2][2] = {{42000000, 84000000}, {45000000, 90000000}};

static bool hse_is_ready(const struct board *board)
{
	return board->config.hse_hz != 0 && (board->rcc.cr & CR_HSEON) != 0 &&
	       now_ps(board) >= board->rcc.hse_ready_ps;
}

static bool pll_is_ready(const struct board *board)
{
	const struct rcc *rcc = &board->rcc;

	return (rcc->cr & CR_PLLON) != 0 && now_ps(board) >= rcc->pll_ready_ps &&
	       ((rcc->pllcfgr & PLLCFGR_HSE) == 0 || hse_is_ready(board));
}

/** 6.3.2: the VCO makes N / M of its input, SYSCLK is that through P. */
static uint32_t pll_hz(const struct board *board)
{
	const uint32_t pllcfgr = board->rcc.pllcfgr;
	const uint32_t in_hz = pllcfgr & PLLCFGR_HSE ? board->config.hse_hz : HSI_HZ;
	const uint32_t m = pllcfgr & 0x3Fu;
	const uint32_t n = pllcfgr >> 6 & 0x1FFu;
	const uint32_t p = 2 * (pllcfgr >> 16 & 3u) + 2;

	if (m < 2 || n < 50 || n > 432) {
		board_complain((struct board *)(uintptr_t)board, "RCC_PLLCFGR: M %u, N %u", m, n);
		return HSI_HZ;
	}
	return (uint32_t)((uint64_t)in_hz * n / m / p);
}

/** SW is followed as soon as the source is ready (6.2.5). */
static uint32_t chosen(const struct board *board)
{
	switch (board->rcc.cfgr & CFGR_SW) {
	case 1:
		return hse_is_ready(board) ? 1 : 0;
	case 2:
		return pll_is_ready(board) ? 2 : 0;
	default:
		return 0;
	}
}

static uint32_t bus_divider(uint32_t bits)
{
	return bits < 4 ? 1 : 2u << (bits - 4);
}

static void check_limits(struct board *board)
{
	const struct rcc *rcc = &board->rcc;
	const int overdrive = (rcc->pwr_cr & PWR_CR_ODSWEN) != 0;

	if (rcc->hclk_hz > hclk_max_hz[overdrive]) {
		board_complain(board, "HCLK of %u Hz, at most %u", rcc->hclk_hz,
			       hclk_max_hz[overdrive]);
	}
	for (int i = 0; i < 2; i++) {
		if (rcc->pclk_hz[i] > pclk_max_hz[overdrive][i]) {
			board_complain(board, "PCLK%d of %u Hz, at most %u", i + 1, rcc->pclk_hz[i],
				       pclk_max_hz[overdrive][i]);
		}
	}
	flash_check_latency(board);
}

static void follow(struct board *board)
{
	static const uint16_t hclk_dividers[] = {1, 2, 4, 8, 16, 64, 128, 256, 512};
	struct rcc *rcc = &board->rcc;
	const uint32_t source = chosen(board);
	const uint32_t sysclk_hz = source == 2   ? pll_hz(board)
				   : source == 1 ? board->config.hse_hz
						 : HSI_HZ;
	const uint32_t hpre = rcc->cfgr >> 4 & 15u;
	const uint32_t hclk_hz = sysclk_hz / hclk_dividers[hpre < 8 ? 0 : hpre - 7];
	bool changed = hclk_hz != rcc->hclk_hz;

	if (changed) {
		clock_frequency(board, hclk_hz);
		rcc->hclk_hz = hclk_hz;
	}
	for (int i = 0; i < 2; i++) {
		const uint32_t divider = bus_divider(rcc->cfgr >> (10 + 3 * i) & 7u);
		const uint32_t pclk_hz = hclk_hz / divider;
		/* 6.2: twice the bus where that is divided; with TIMPRE up to four times. */
		const uint32_t factor = (rcc->dckcfgr & DCKCFGR_TIMPRE) != 0
						? (divider <= 4 ? divider : 4)
						: (divider == 1 ? 1 : 2);

		changed |= rcc->timer_hz[i] != pclk_hz * factor;
		rcc->pclk_hz[i] = pclk_hz;
		rcc->timer_hz[i] = pclk_hz * factor;
	}
	if (changed) {
		core_systick_rebase(board);
		timer_rebase(board);
		board->core.attention = true;
	}
	check_limits(board);
}

/** 6.2.7: with the clock security system on, a clock that fails is an NMI, and HSI takes over. */
void lw_board_set_hse(struct board *board, uint32_t hse_hz)
{
	struct rcc *rcc = &board->rcc;
	const bool was_ready = hse_is_ready(board);

	board->config.hse_hz = hse_hz;
	if (!board->powered || !was_ready || hse_hz != 0) {
		return;
	}
	if (rcc->cr & CR_CSSON) {
		rcc->cr &= ~(CR_HSEON | CR_PLLON);
		rcc->cir |= CIR_CSSF;
		core_pend(board, EXCEPTION_NMI);
	}
	follow(board);
}

/** An oscillator has become ready: what has chosen it goes on with it. */
void rcc_event(struct board *board)
{
	follow(board);
}

static void expect(struct board *board, uint64_t ps)
{
	if (ps > now_ps(board) && ps < board->clock.due_ps[EVENT_RCC]) {
		event_at(board, EVENT_RCC, ps);
	}
}

void rcc_reset(struct board *board, enum lw_board_reset why)
{
	static const uint32_t causes[] = {
		[LW_BOARD_RESET_POWER] = CSR_PORRSTF | CSR_BORRSTF | CSR_PINRSTF,
		[LW_BOARD_RESET_SOFTWARE] = CSR_SFTRSTF | CSR_PINRSTF,
		[LW_BOARD_RESET_WATCHDOG] = CSR_IWDGRSTF | CSR_PINRSTF,
	};
	const uint32_t flags = why == LW_BOARD_RESET_POWER ? 0 : board->rcc.csr & 0xFE000000u;

	board->rcc = (struct rcc){
		.cr = CR_HSION | 0x80u,
		.pllcfgr = 0x24003010u,
		.csr = flags | causes[why],
		.pwr_cr = 0xC000u,
	};
	event_at(board, EVENT_RCC, NEVER_PS);
	follow(board);
}

uint32_t rcc_read(struct board *board, uint32_t offset)
{
	const struct rcc *rcc = &board->rcc;

	switch (offset) {
	case 0x00:
		return rcc->cr | (rcc->cr & CR_HSION ? CR_HSIRDY : 0) |
		       (hse_is_ready(board) ? CR_HSERDY : 0) |
		       (pll_is_ready(board) ? CR_PLLRDY : 0);
	case 0x04:
		return rcc->pllcfgr;
	case 0x08:
		return (rcc->cfgr & ~0xCu) | chosen(board) << 2;
	case 0x0C:
		return rcc->cir;
	case 0x10:
	case 0x14:
	case 0x18:
		return rcc->reset[(offset - 0x10) / 4];
	case 0x20:
	case 0x24:
		return rcc->reset[3 + (offset - 0x20) / 4];
	case 0x30:
	case 0x34:
	case 0x38:
		return rcc->enabled[(offset - 0x30) / 4];
	case 0x40:
	case 0x44:
		return rcc->enabled[3 + (offset - 0x40) / 4];
	case 0x70:
		return rcc->bdcr;
	case 0x74:
		return rcc->csr | ((rcc->csr & CSR_LSION) != 0 && now_ps(board) >= rcc->lsi_ready_ps
					   ? CSR_LSIRDY
					   : 0);
	case 0x8C:
		return rcc->dckcfgr;
	default:
		return 0;
	}
}

/** A peripheral is held in reset while its bit is 1: it begins anew. */
static void hold_in_reset(struct board *board, unsigned int bus, uint32_t bits)
{
	if (bus == 0) {
		if (bits & 0xFFu) {
			board_complain(board, "RCC_AHB1RSTR: reset of a port is not modelled");
		}
	} else if (bus == 3) {
		for (unsigned int i = 0; i < TIMERS; i++) {
			if (bits >> i & 1u) {
				timer_reset(board, i);
			}
		}
		if (bits >> 17 & 1u) {
			usart_reset(board, 1);
		}
	} else if (bus == 4 && (bits >> 4 & 1u)) {
		usart_reset(board, 0);
	}
}

static void write_cr(struct board *board, uint32_t value)
{
	struct rcc *rcc = &board->rcc;
	const uint32_t on = value & ~rcc->cr;

	rcc->cr = value & CR_WRITABLE;
	if (on & CR_HSEON) {
		rcc->hse_ready_ps = now_ps(board) + HSE_START_PS;
		expect(board, rcc->hse_ready_ps);
	}
	if (on & CR_PLLON) {
		rcc->pll_ready_ps = now_ps(board) + PLL_LOCK_PS;
		expect(board, rcc->pll_ready_ps);
	}
	follow(board);
}

void rcc_write(struct board *board, uint32_t offset, uint32_t value)
{
	struct rcc *rcc = &board->rcc;

	switch (offset) {
	case 0x00:
		write_cr(board, value);
		break;
	case 0x04:
		if (rcc->cr & CR_PLLON) {
			board_complain(board, "RCC_PLLCFGR written while the PLL is on");
		}
		rcc->pllcfgr = value;
		break;
	case 0x08:
		rcc->cfgr = value & ~0xCu;
		follow(board);
		break;
	case 0x0C:
		rcc->cir = (value & 0x7F00u) | (value & CIR_CSSC ? 0 : rcc->cir & CIR_CSSF);
		break;
	case 0x10:
	case 0x14:
	case 0x18:
		rcc->reset[(offset - 0x10) / 4] = value;
		hold_in_reset(board, (offset - 0x10) / 4, value);
		break;
	case 0x20:
	case 0x24:
		rcc->reset[3 + (offset - 0x20) / 4] = value;
		hold_in_reset(board, 3 + (offset - 0x20) / 4, value);
		break;
	case 0x30:
	case 0x34:
	case 0x38:
		rcc->enabled[(offset - 0x30) / 4] = value;
		break;
	case 0x40:
	case 0x44:
		rcc->enabled[3 + (offset - 0x40) / 4] = value;
		break;
	case 0x70:
		rcc->bdcr = value;
		break;
	case 0x74:
		if ((value & ~rcc->csr & CSR_LSION) != 0) {
			rcc->lsi_ready_ps = now_ps(board) + LSI_START_PS;
		}
		rcc->csr = (rcc->csr & ~CSR_LSION) | (value & CSR_LSION);
		if (value & CSR_RMVF) {
			rcc->csr &= ~0xFE000000u;
		}
		break;
	case 0x8C:
		rcc->dckcfgr = value;
		follow(board);
		break;
	default:
		break;
	}
}

uint32_t pwr_read(struct board *board, uint32_t offset)
{
	const struct rcc *rcc = &board->rcc;

	if (offset == 0x00) {
		return rcc->pwr_cr;
	}
	if (offset == 0x04) { /* PWR_CSR: VOSRDY, ODRDY, ODSWRDY */
		const bool ready = now_ps(board) >= rcc->overdrive_ready_ps;

		return 1u << 14 | (rcc->pwr_cr & PWR_CR_ODEN && ready ? 1u << 16 : 0) |
		       (rcc->pwr_cr & PWR_CR_ODSWEN && ready ? 1u << 17 : 0);
	}
	return 0;
}

void pwr_write(struct board *board, uint32_t offset, uint32_t value)
{
	if (offset == 0x00) {
		if (value & ~board->rcc.pwr_cr & (PWR_CR_ODEN | PWR_CR_ODSWEN)) {
			board->rcc.overdrive_ready_ps = now_ps(board) + OVERDRIVE_START_PS;
		}
		board->rcc.pwr_cr = value;
	}
}
