/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The external clock (HSE), where it is there. The kernel's driver starts the PLL on the internal
 * oscillator (HSI); were it told of HSE, it would wait for it for ever, before any watchdog runs.
 * So this goes over to HSE afterwards, with a limit, to the same frequency.
 * RM0390, 6.2.1, 6.2.3, 6.2.7.
 */
#include "clock.h"

#include <soc.h>
#include <stm32_ll_pwr.h>
#include <stm32_ll_rcc.h>
#include <zephyr/arch/arm/nmi.h>
#include <zephyr/devicetree.h>
#include <zephyr/drivers/clock_control/stm32_clock_control.h>
#include <zephyr/init.h>
#include <zephyr/kernel.h>
#include <zephyr/sys/util.h>

#include "watch.h"

#define HSE DT_NODELABEL(clk_hse)
#define HSI DT_NODELABEL(clk_hsi)
#define PLL DT_NODELABEL(pll)

/** The PLL gets 1 MHz from either. */
#define HSE_DIVIDER (DT_PROP(HSE, clock_frequency) / 1000000)

BUILD_ASSERT(DT_PROP(HSI, clock_frequency) / DT_PROP(PLL, div_m) ==
		     DT_PROP(HSE, clock_frequency) / HSE_DIVIDER,
	     "the PLL must get the same from the internal oscillator as from the external clock");

/** Looks at a flag; each takes some ten cycles, so all of them about 20 ms. */
#define LOOKS_MAX 300000

static bool fallback;

bool clock_is_fallback(void)
{
	return fallback;
}

/** The chip has gone over to HSI by itself, at a tenth of the speed: start anew. */
static void on_nmi(void)
{
	LL_RCC_ClearFlag_HSECSS();
	watch_restart();
}

static bool comes(uint32_t (*is_ready)(void))
{
	for (uint32_t looks = 0; looks < LOOKS_MAX; looks++) {
		if (is_ready() != 0) {
			return true;
		}
	}
	return false;
}

static void stop_pll(void)
{
	LL_RCC_SetSysClkSource(LL_RCC_SYS_CLKSOURCE_HSI);
	while (LL_RCC_GetSysClkSource() != LL_RCC_SYS_CLKSOURCE_STATUS_HSI) {
	}
	LL_RCC_PLL_Disable();
	while (LL_RCC_PLL_IsReady() != 0) {
	}
}

static bool run_by(uint32_t source, uint32_t divider)
{
	stop_pll();
	MODIFY_REG(RCC->PLLCFGR, RCC_PLLCFGR_PLLSRC | RCC_PLLCFGR_PLLM,
		   source | divider << RCC_PLLCFGR_PLLM_Pos);
	LL_RCC_PLL_Enable();
	if (!comes(LL_RCC_PLL_IsReady)) {
		return false;
	}
	LL_RCC_SetSysClkSource(LL_RCC_SYS_CLKSOURCE_PLL);
	while (LL_RCC_GetSysClkSource() != LL_RCC_SYS_CLKSOURCE_STATUS_PLL) {
	}
	return true;
}

static int use_hse(void)
{
	if (DT_PROP(HSE, hse_bypass)) {
		LL_RCC_HSE_EnableBypass();
	}
	LL_RCC_HSE_Enable();
	if (!comes(LL_RCC_HSE_IsReady)) {
		LL_RCC_HSE_Disable();
		fallback = true;
		return 0;
	}
	if (run_by(LL_RCC_PLLSOURCE_HSE, HSE_DIVIDER)) {
		z_arm_nmi_set_handler(on_nmi);
		LL_RCC_HSE_EnableCSS();
		return 0;
	}
	fallback = true;
	(void)run_by(LL_RCC_PLLSOURCE_HSI, DT_PROP(PLL, div_m));
	return 0;
}

/** Behind the kernel's driver of the clocks, before all that has a clock. */
SYS_INIT(use_hse, PRE_KERNEL_1, UTIL_INC(CONFIG_CLOCK_CONTROL_INIT_PRIORITY));

/** The kernel's driver makes the frequency first, and divides the buses then: too fast for them. */
static int divide_buses(void)
{
	LL_RCC_SetAPB1Prescaler(LL_RCC_APB1_DIV_4);
	LL_RCC_SetAPB2Prescaler(LL_RCC_APB2_DIV_4);
	return 0;
}

BUILD_ASSERT(STM32_APB1_PRESCALER == 4 && STM32_APB2_PRESCALER == 4);

SYS_INIT(divide_buses, EARLY, 0);
