/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Are two objects the same, byte for byte? As memcmp(), which in a small C library goes byte by
 * byte, and that is long for what is done in every tick.
 */
#ifndef LW_SAME_H
#define LW_SAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/** Bits in which two words differ. */
static inline uint32_t lw_word_differences(const char *a, const char *b)
{
	uint32_t word;
	uint32_t other;

	memcpy(&word, a, sizeof(word));
	memcpy(&other, b, sizeof(other));
	return word ^ other;
}

/** Interrupt safe. */
static inline bool lw_same(const void *a, const void *b, size_t size)
{
	const char *left = (const char *)a;
	const char *right = (const char *)b;
	uint32_t differences = 0;

	/* Four words at a time: a loop for each would cost twice as much. */
	for (; size >= 16; size -= 16, left += 16, right += 16) {
		differences |= lw_word_differences(left, right) |
			       lw_word_differences(left + 4, right + 4) |
			       lw_word_differences(left + 8, right + 8) |
			       lw_word_differences(left + 12, right + 12);
	}
	for (; size >= 4; size -= 4, left += 4, right += 4) {
		differences |= lw_word_differences(left, right);
	}
	for (; size > 0; size--) {
		differences |= (uint32_t)(uint8_t)(*left++ ^ *right++);
	}
	return differences == 0;
}

#endif /* LW_SAME_H */
