/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief Chance that a seed repeats.
 */
#include "plant_base.h"

/* xorshift64*, after Vigna, "An experimental exploration of Marsaglia's xorshift generators". */
uint32_t lw_plant_chance(uint64_t *random, uint32_t range)
{
	*random ^= *random >> 12;
	*random ^= *random << 25;
	*random ^= *random >> 27;

	uint32_t high = (uint32_t)((*random * 0x2545f4914f6cdd1du) >> 32);

	return (uint32_t)(((uint64_t)high * range) >> 32);
}

uint32_t lw_plant_random(struct lw_plant *plant, uint32_t range)
{
	return lw_plant_chance(&plant->random, range);
}
