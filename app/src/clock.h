/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Where the processor's clock comes from, on boards that have a choice.
 */
#ifndef CLOCK_H
#define CLOCK_H

#include <stdbool.h>

#ifdef CONFIG_SOC_SERIES_STM32F4X

/** Does it run by its internal oscillator, because the external clock is not there? */
bool clock_is_fallback(void);

#else

static inline bool clock_is_fallback(void)
{
	return false;
}

#endif

#endif /* CLOCK_H */
