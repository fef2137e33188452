/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief Time, chance and constants, which all parts of the plant use.
 */
#ifndef LW_PLANT_BASE_H
#define LW_PLANT_BASE_H

#include <lw/plant.h>

#define NS_PER_US 1000u
#define NS_PER_MS 1000000u
#define S_PER_NS  1e-9

/** The substep in seconds, and how many a second has. */
#define SUBSTEP_S      (LW_PLANT_SUBSTEP_NS * S_PER_NS)
#define SUBSTEPS_PER_S (1e9 / LW_PLANT_SUBSTEP_NS)

/** Time between two changes of a dithering encoder, or of pulses that the drum has not made. */
#define DITHER_INTERVAL_NS 20000u

static inline uint64_t earlier_ns(uint64_t a_ns, uint64_t b_ns)
{
	return a_ns < b_ns ? a_ns : b_ns;
}

/** Beginning of the substep that is under way. */
static inline uint64_t substep_begin_ns(const struct lw_plant *plant)
{
	return plant->substep_ns - LW_PLANT_SUBSTEP_NS;
}

/** Uniformly distributed in [0, range), of a state that is not 0. */
uint32_t lw_plant_chance(uint64_t *random, uint32_t range);

/** The same of the plant's own. */
uint32_t lw_plant_random(struct lw_plant *plant, uint32_t range);

#endif /* LW_PLANT_BASE_H */
