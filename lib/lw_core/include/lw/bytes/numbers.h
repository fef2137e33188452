/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Arithmetic that C lacks. Not for interrupt context: 64-bit division.
 */
#ifndef LW_NUMBERS_H
#define LW_NUMBERS_H

#include <stdint.h>

/** The nearest value that fits into 32 bit. */
static inline int32_t lw_clamp32(int64_t value)
{
	return value > INT32_MAX ? INT32_MAX : value < INT32_MIN ? INT32_MIN : (int32_t)value;
}

/** Quotient of two integers, den > 0, rounded to nearest, halves away from zero. */
static inline int64_t lw_divide_nearest(int64_t num, int64_t den)
{
	return (num >= 0 ? num + den / 2 : num - den / 2) / den;
}

/** Largest n with n * n <= value; value from 0 to 2^62 - 1. */
int32_t lw_integer_sqrt(int64_t value);

#endif /* LW_NUMBERS_H */
