/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Which mutant is on, told by the environment:
 *
 * LW_MUTATION=SITE,VARIANT  that one
 * LW_MUTATION=FILE          none; write which would differ to a file, a line for each test
 * LW_MUTATION_SITES=N,N...  of these sites
 * LW_MUTATION_TEST=NAME     run this test alone
 * LW_MUTATION_LIMIT_MS=MS   end after so much of the program's own time
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <time.h>

#include "mutation.h"

#define SITES_MAX    32768u
#define VARIANTS_MAX 4u

uint8_t lw_mutation[SITES_MAX];
static uint8_t differs[SITES_MAX][VARIANTS_MAX];
static FILE *notes;
static const char *only;
static int64_t begun_us;

uint64_t lw_mutation_choose(unsigned int site, uint64_t original, unsigned int count,
			    const uint64_t *variants)
{
	if (lw_mutation[site] != LW_MUTATION_NOTES) {
		return variants[lw_mutation[site] - 1];
	}
	for (unsigned int i = 0; i < count; i++) {
		differs[site][i] |= variants[i] != original;
	}
	return original;
}

bool lw_mutation_on(unsigned int site)
{
	if (lw_mutation[site] != LW_MUTATION_NOTES) {
		return true;
	}
	differs[site][0] = 1;
	return false;
}

static int64_t cpu_us(void)
{
	struct timespec at;

	clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &at);
	return at.tv_sec * INT64_C(1000000) + at.tv_nsec / 1000;
}

bool lw_mutation_begin_test(const char *name)
{
	if (only != NULL && strcmp(only, name) != 0) {
		return false;
	}
	if (notes != NULL) {
		memset(differs, 0, sizeof(differs));
		fprintf(notes, "%s", name);
		begun_us = cpu_us();
	}
	return true;
}

void lw_mutation_end_test(void)
{
	if (notes == NULL) {
		return;
	}
	fprintf(notes, " %" PRId64, cpu_us() - begun_us);
	for (unsigned int site = 0; site < SITES_MAX; site++) {
		for (unsigned int i = 0; i < VARIANTS_MAX; i++) {
			if (differs[site][i]) {
				fprintf(notes, " %u,%u", site, i + 1);
			}
		}
	}
	fputc('\n', notes);
}

/** A mutant that never ends is killed by its own time, however busy the machine is. */
static void limit_time(const char *limit_ms)
{
	const long ms = limit_ms == NULL ? 0 : atol(limit_ms);
	const struct itimerval timer = {.it_value = {ms / 1000, ms % 1000 * 1000}};
	const struct rlimit no_core = {0};

	setitimer(ITIMER_VIRTUAL, &timer, NULL);
	setrlimit(RLIMIT_CORE, &no_core);
}

__attribute__((constructor)) static void begin(void)
{
	const char *what = getenv("LW_MUTATION");
	unsigned int site;
	unsigned int variant;

	limit_time(getenv("LW_MUTATION_LIMIT_MS"));
	only = getenv("LW_MUTATION_TEST");
	if (what == NULL) {
		return;
	}
	if (sscanf(what, "%u,%u", &site, &variant) == 2) {
		if (site >= SITES_MAX || variant < 1 || variant > VARIANTS_MAX) {
			_Exit(2);
		}
		lw_mutation[site] = (uint8_t)variant;
		return;
	}
	notes = fopen(what, "w");
	if (notes == NULL) {
		_Exit(2);
	}
	for (const char *at = getenv("LW_MUTATION_SITES"); at != NULL; at = strchr(at + 1, ',')) {
		site = (unsigned int)atoi(*at == ',' ? at + 1 : at);
		if (site >= SITES_MAX) {
			_Exit(2);
		}
		lw_mutation[site] = LW_MUTATION_NOTES;
	}
}
