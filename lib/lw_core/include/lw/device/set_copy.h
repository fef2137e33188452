/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A second copy of the parameter set in force and of what was derived from it.
 *
 * A bit that flips in them (radiation, a supply that dips, a pointer gone wild) would lay rope
 * wrong without a word: nothing else knows where a reversal belongs. Every eighth tick compares
 * the two copies, and a CRC tells which one is right. Supervisor only.
 */
#ifndef LW_SET_COPY_H
#define LW_SET_COPY_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/control/params.h"

/** Compared in one tick of so many: 8 ms are a millimetre of the fastest carriage. */
#define LW_SET_COPY_TICKS 8

/** Second copy. Private to set_copy.c, but for what is counted. */
struct lw_set_copy {
	struct lw_params params;
	struct lw_derived derived;
	uint32_t crc;
	uint8_t ticks;        /**< since they were compared */
	uint16_t corrections; /**< what was set right since power-up; stays at the most */
};

/** Keep a set that has just come into force. */
void lw_set_copy_keep(struct lw_set_copy *copy, const struct lw_params *params,
		      const struct lw_derived *derived);

/**
 * Compare, and set right what differs: by the copy, unless it is the copy that has changed.
 *
 * @return something differed
 */
bool lw_set_copy_check(struct lw_set_copy *copy, struct lw_params *params,
		       struct lw_derived *derived);

/** Is it time for lw_set_copy_check()? Call every tick. */
bool lw_set_copy_due(struct lw_set_copy *copy);

/** Count what has been set right, here or elsewhere. */
void lw_set_copy_count(struct lw_set_copy *copy);

#endif /* LW_SET_COPY_H */
