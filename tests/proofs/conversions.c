/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What law.c and cam.c take for granted of the compiler, tried on every value: C leaves it to the
 * compiler how a value above INT32_MAX becomes an int32_t, and how a negative one is shifted to the
 * right. Exit status 0: as law.c says.
 */
#include <stdint.h>
#include <stdio.h>

#include "lw/motion/law.h"

/** The lower 32 bit of 64, of numbers all over their range. */
static uint32_t wrong_halves(void)
{
	uint32_t wrong = 0;

	for (uint64_t x = 1; x < (uint64_t)INT64_MAX / 3; x += x / 1000 + 1) {
		wrong |= (uint32_t)x != x % 0x100000000;
		wrong |= (uint32_t)(INT64_MAX - (int64_t)x) != (INT64_MAX - x) % 0x100000000;
	}
	return wrong;
}

int main(void)
{
	uint32_t x = 0;
	uint32_t wrong = wrong_halves();

	do {
		const int64_t low_half = (int64_t)(x & INT32_MAX);
		const int32_t m = (int32_t)x;

		wrong |= (int64_t)m != (x > INT32_MAX ? low_half - 0x80000000LL : low_half);
		wrong |= (int64_t)lw_law_pos_usteps(m) !=
			 (int64_t)((uint64_t)(m + 0x80000000LL) / 65536) - 32768;
	} while (++x != 0);
	if (wrong) {
		puts("this compiler converts or shifts otherwise than tests/proofs/law.c and cam.c "
		     "say");
	}
	return (int)wrong;
}
