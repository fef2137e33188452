/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Loops over the cases of a test. A failure names its case, if tearDown() calls cases_end().
 */
#ifndef CASES_H
#define CASES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include <unity.h>

/** For both sides: LW_PLUS, then LW_MINUS. */
#define FOR_EACH_SIDE(side) for (int side = 0; cases_side(side); side++)

/** For both directions: -1, then +1. */
#define FOR_BOTH_WAYS(direction) for (int direction = -1; cases_way(direction); direction += 2)

static inline bool cases_side(int side)
{
	static const char *const names[] = {"plus side", "minus side"};

	Unity.CurrentDetail1 = side < 2 ? names[side] : NULL;
	return side < 2;
}

static inline bool cases_way(int direction)
{
	static const char backward[] = "backward";
	static const char forward[] = "forward";
	const char **const detail = Unity.CurrentDetail1 == NULL ||
						    Unity.CurrentDetail1 == backward ||
						    Unity.CurrentDetail1 == forward
					    ? &Unity.CurrentDetail1
					    : &Unity.CurrentDetail2;

	*detail = direction < 0 ? backward : direction == 1 ? forward : NULL;
	return direction <= 1;
}

/** Behind the message of a failed test: in which case it failed. */
static inline void cases_end(void)
{
	if (Unity.CurrentTestFailed && Unity.CurrentDetail1 != NULL) {
		printf(" (%s%s%s)", Unity.CurrentDetail1, Unity.CurrentDetail2 ? ", " : "",
		       Unity.CurrentDetail2 ? Unity.CurrentDetail2 : "");
	}
}

#endif /* CASES_H */
