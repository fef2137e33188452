/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A timer of an STM32: its clock and its reset.
 */
#ifndef STM32_TIMER_H
#define STM32_TIMER_H

#include <zephyr/drivers/clock_control/stm32_clock_control.h>
#include <zephyr/drivers/reset.h>

struct lw_stm32_timer {
	struct stm32_pclken clock;
	struct reset_dt_spec reset;
};

/** Of the node of the timer. */
#define LW_STM32_TIMER(node)                                                                       \
	{                                                                                          \
		.clock = {.bus = DT_CLOCKS_CELL(node, bus), .enr = DT_CLOCKS_CELL(node, bits)},    \
		.reset = RESET_DT_SPEC_GET(node),                                                  \
	}

/**
 * Give it its clock, and reset it.
 *
 * @param hz receives the frequency that it counts, before its prescaler
 * @retval 0 done
 * @retval <0 errno of the clock's or the reset's driver
 */
static inline int lw_stm32_timer_on(const struct lw_stm32_timer *timer, uint32_t *hz)
{
	const struct device *const clock = DEVICE_DT_GET(STM32_CLOCK_CONTROL_NODE);
	const clock_control_subsys_t subsystem = (clock_control_subsys_t)&timer->clock;
	/* Timers run at twice their bus's clock where that is divided (RM0390, 6.2, TIMPRE off). */
	const uint32_t divider = timer->clock.bus == STM32_CLOCK_BUS_APB1 ? STM32_APB1_PRESCALER
									  : STM32_APB2_PRESCALER;
	int ret = clock_control_on(clock, subsystem);

	if (ret == 0) {
		ret = clock_control_get_rate(clock, subsystem, hz);
	}
	if (ret == 0) {
		*hz *= divider > 1 ? 2 : 1;
		ret = reset_line_toggle_dt(&timer->reset);
	}
	return ret;
}

#endif /* STM32_TIMER_H */
