/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The kernel's clock by a 32-bit timer of an STM32 that nothing ever stops or sets back: no cycle
 * is lost when a time-out is set, and none while the processor stands still, as it does for up to
 * 2 s while its flash is erased. SysTick has 24 bits, is set back at each time-out, and tells of
 * one run-over only.
 */
#define DT_DRV_COMPAT levelwind_stm32_system_timer

#include <soc.h>
#include <stm32_ll_bus.h>
#include <stm32_ll_tim.h>
#include <zephyr/drivers/clock_control/stm32_clock_control.h>
#include <zephyr/drivers/timer/system_timer.h>
#include <zephyr/init.h>
#include <zephyr/irq.h>
#include <zephyr/spinlock.h>
#include <zephyr/sys_clock.h>

#include "lw/drivers/system_timer.h"

#define NODE  LW_SYSTEM_TIMER_NODE
#define TIMER LW_SYSTEM_TIMER

#define TIMER_HZ         LW_SYSTEM_TIMER_HZ
#define CYCLES_PER_COUNT (CONFIG_SYS_CLOCK_HW_CYCLES_PER_SEC / TIMER_HZ)
#define COUNTS_PER_TICK  (TIMER_HZ / CONFIG_SYS_CLOCK_TICKS_PER_SEC)

BUILD_ASSERT(DT_CLOCKS_CELL(NODE, bus) == STM32_CLOCK_BUS_APB1, "a timer on APB1");
BUILD_ASSERT(CYCLES_PER_COUNT *TIMER_HZ == CONFIG_SYS_CLOCK_HW_CYCLES_PER_SEC &&
		     COUNTS_PER_TICK * CONFIG_SYS_CLOCK_TICKS_PER_SEC == TIMER_HZ,
	     "cycles, counts and ticks must divide each other");

/** Far from half of the counter's range, which tells before from after. */
#define TICKS_MAX (INT32_MAX / COUNTS_PER_TICK / 2)

/** A compare value closer than this may have passed before it is written. */
#define MARGIN_COUNTS 64u

static struct k_spinlock lock;
static uint32_t announced; /**< count at the last tick that the kernel knows of */
static uint32_t served;    /**< count at the last interrupt */
static uint32_t still_counts;

static uint32_t count(void)
{
	return TIMER->CNT;
}

/** An interrupt at a count, or soon if that has passed. */
static void interrupt_at(uint32_t target)
{
	TIMER->CCR1 = target;
	while ((int32_t)(target - count()) < (int32_t)MARGIN_COUNTS &&
	       LL_TIM_IsActiveFlag_CC1(TIMER) == 0) {
		target = count() + 2 * MARGIN_COUNTS;
		TIMER->CCR1 = target;
	}
}

static void on_compare(const void *unused)
{
	const k_spinlock_key_t key = k_spin_lock(&lock);
	uint32_t now;
	uint32_t ticks;

	ARG_UNUSED(unused);
	LL_TIM_ClearFlag_CC1(TIMER);
	now = count();
	ticks = (now - announced) / COUNTS_PER_TICK;
	announced += ticks * COUNTS_PER_TICK;
	still_counts = now - served;
	served = now;
	k_spin_unlock(&lock, key);
	sys_clock_announce((int32_t)ticks);
}

uint32_t lw_system_timer_gap_ms(void)
{
	return still_counts / (TIMER_HZ / 1000);
}

void sys_clock_set_timeout(int32_t ticks, bool idle)
{
	k_spinlock_key_t key;
	uint32_t ahead;

	ARG_UNUSED(idle);
	if (ticks == K_TICKS_FOREVER) {
		ticks = TICKS_MAX;
	}
	ticks = CLAMP(ticks - 1, 0, TICKS_MAX);
	key = k_spin_lock(&lock);
	ahead = count() - announced + (uint32_t)ticks * COUNTS_PER_TICK;
	ahead = DIV_ROUND_UP(ahead, COUNTS_PER_TICK) * COUNTS_PER_TICK;
	interrupt_at(announced + ahead);
	k_spin_unlock(&lock, key);
}

uint32_t sys_clock_elapsed(void)
{
	const k_spinlock_key_t key = k_spin_lock(&lock);
	const uint32_t ticks = (count() - announced) / COUNTS_PER_TICK;

	k_spin_unlock(&lock, key);
	return ticks;
}

uint32_t sys_clock_cycle_get_32(void)
{
	return lw_system_timer_cycles();
}

static int start(void)
{
	LL_APB1_GRP1_EnableClock(DT_CLOCKS_CELL(NODE, bits));
	LL_TIM_SetAutoReload(TIMER, UINT32_MAX);
	LL_TIM_SetUpdateSource(TIMER, LL_TIM_UPDATESOURCE_COUNTER);
	LL_TIM_GenerateEvent_UPDATE(TIMER);
	TIMER->CCR1 = COUNTS_PER_TICK;
	LL_TIM_EnableIT_CC1(TIMER);
	IRQ_CONNECT(DT_IRQN(NODE), DT_IRQ(NODE, priority), on_compare, NULL, 0);
	irq_enable(DT_IRQN(NODE));
	LL_TIM_EnableCounter(TIMER);
	return 0;
}

SYS_INIT(start, PRE_KERNEL_2, CONFIG_SYSTEM_CLOCK_INIT_PRIORITY);
