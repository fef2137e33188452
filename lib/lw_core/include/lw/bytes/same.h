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

/** Bits in which two words of the processor differ. */
static inline size_t lw_word_differences(const char *a, const char *b)
{
	size_t word;
	size_t other;

	memcpy(&word, a, sizeof(word));
	memcpy(&other, b, sizeof(other));
	return word ^ other;
}

/** Interrupt safe. */
static inline bool lw_same(const void *a, const void *b, size_t size)
{
	const char *left = (const char *)a;
	const char *right = (const char *)b;
	const size_t word = sizeof(size_t);
	size_t differences = 0;

	/* Four words at a time: a loop for each would cost twice as much. */
	for (; size >= 4 * word; size -= 4 * word, left += 4 * word, right += 4 * word) {
		differences |= lw_word_differences(left, right) |
			       lw_word_differences(left + word, right + word) |
			       lw_word_differences(left + 2 * word, right + 2 * word) |
			       lw_word_differences(left + 3 * word, right + 3 * word);
	}
	for (; size >= word; size -= word, left += word, right += word) {
		differences |= lw_word_differences(left, right);
	}
	for (; size > 0; size--) {
		differences |= (size_t)(uint8_t)(*left++ ^ *right++);
	}
	return differences == 0;
}

#endif /* LW_SAME_H */
