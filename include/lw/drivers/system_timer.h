/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What the kernel's clock tells beside the time, where it is a timer of ours.
 */
#ifndef LW_DRIVERS_SYSTEM_TIMER_H
#define LW_DRIVERS_SYSTEM_TIMER_H

#include <stdint.h>

#ifdef CONFIG_LW_STM32_SYSTEM_TIMER

#include <soc.h>
#include <zephyr/devicetree.h>
#include <zephyr/drivers/clock_control/stm32_clock_control.h>

#define LW_SYSTEM_TIMER_NODE DT_PARENT(DT_COMPAT_GET_ANY_STATUS_OKAY(levelwind_stm32_system_timer))
#define LW_SYSTEM_TIMER      ((TIM_TypeDef *)DT_REG_ADDR(LW_SYSTEM_TIMER_NODE))

/** Timers run at twice their bus's clock where that is divided (RM0390, 6.2, with TIMPRE off). */
#define LW_SYSTEM_TIMER_HZ                                                                         \
	(CONFIG_SYS_CLOCK_HW_CYCLES_PER_SEC / STM32_AHB_PRESCALER / STM32_APB1_PRESCALER *         \
	 (STM32_APB1_PRESCALER > 1 ? 2 : 1))

/** Cycles of the processor, modulo 2^32, in one read. Interrupt safe. */
static inline uint32_t lw_system_timer_cycles(void)
{
	return LW_SYSTEM_TIMER->CNT * (CONFIG_SYS_CLOCK_HW_CYCLES_PER_SEC / LW_SYSTEM_TIMER_HZ);
}

/**
 * Time between the clock's last two interrupts, in ms. With a tick of the supervisor every
 * millisecond, more than a few means that the processor stood still: no thread could run. For the
 * kernel's time-outs, which run in that interrupt.
 */
uint32_t lw_system_timer_gap_ms(void);

#endif /* CONFIG_LW_STM32_SYSTEM_TIMER */

#endif /* LW_DRIVERS_SYSTEM_TIMER_H */
