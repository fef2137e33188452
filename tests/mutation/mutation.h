/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What mutants.py puts around the core's expressions and statements: one build holds all mutants,
 * and the environment says which one is on. Included ahead of every source of the build `mutate`.
 *
 * A site is one place that is mutated, and has 1 to 3 variants. All operands are evaluated once, as
 * in the original.
 */
#ifndef MUTATION_H
#define MUTATION_H

#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

/** The first failed assertion ends the program: Unity leaves a test by longjmp(). */
#define longjmp(frame, value) (Unity.CurrentTestFailed ? _Exit(1) : (longjmp)(frame, value))

/** Each test of a program can be run alone, and notes for itself. */
#define RUN_TEST(test)                                                                             \
	do {                                                                                       \
		if (lw_mutation_begin_test(#test)) {                                               \
			UnityDefaultTestRun(test, #test, __LINE__);                                \
			lw_mutation_end_test();                                                    \
		}                                                                                  \
	} while (0)

bool lw_mutation_begin_test(const char *name);
void lw_mutation_end_test(void);

/** Of each site: 0, which variant is on, or LW_MUTATION_NOTES. */
extern uint8_t lw_mutation[];

/** What would differ from the original is noted, and the original goes on. */
#define LW_MUTATION_NOTES 255

uint64_t lw_mutation_choose(unsigned int site, uint64_t original, unsigned int count,
			    const uint64_t *variants);
bool lw_mutation_on(unsigned int site);

#define LW_VALUE(site, original, ...)                                                              \
	(__builtin_expect(lw_mutation[site], 0)                                                    \
		 ? (__typeof__(original))lw_mutation_choose(site, (uint64_t)(original),            \
							    sizeof((uint64_t[]){__VA_ARGS__}) /    \
								    sizeof(uint64_t),              \
							    (uint64_t[]){__VA_ARGS__})             \
		 : (original))

/** Is variant 1 of a site on that has no value to compare? */
#define LW_ON(site) (__builtin_expect(lw_mutation[site], 0) && lw_mutation_on(site))

/** An operand that would trap gives 0. */
#define LW_TRAPS(b)       ((b) == 0 || (b) == (__typeof__(b))-1)
#define LW_QUOTIENT(a, b) (LW_TRAPS(b) ? 0 : (a) / (LW_TRAPS(b) ? 1 : (b)))

#endif /* MUTATION_H */
