/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Preconditions that a comment states and a caller must keep. Tests, fuzzers, the campaign and the
 * simulator check them and stop; the firmware is built without them, and nothing stands on the edge
 * path. What may come from outside is no precondition: that is refused.
 */
#ifndef LW_REQUIRE_H
#define LW_REQUIRE_H

#ifdef LW_CHECK_REQUIREMENTS
#include <stdbool.h>

/**
 * Say what was not kept, and end the program; nothing where lw_requirements_bind is false. The
 * host's: the core has no console.
 */
void lw_require_failed(const char *condition, const char *function, const char *file, int line);

/** False where memory has been spoilt on purpose, to see what the firmware would do. */
extern bool lw_requirements_bind;

/** The caller has seen to this. */
#define LW_REQUIRE(condition)                                                                      \
	((condition) ? (void)0 : lw_require_failed(#condition, __func__, __FILE__, __LINE__))
#else
/* Compiled, so that it stays right, and never run. */
#define LW_REQUIRE(condition) ((void)sizeof((condition) ? 1 : 0))
#endif

#endif /* LW_REQUIRE_H */
