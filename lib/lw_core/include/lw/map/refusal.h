/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Why something was refused, in the terms of the Modbus map: from the rule that says no to the
 * registers last_error_* and command_*, and from there to one sentence in the laptop tool.
 */
#ifndef LW_REFUSAL_H
#define LW_REFUSAL_H

#include <stdint.h>

#include "lw/bytes/numbers.h"
#include "lw/map.h"

/** Why a request was refused; becomes the registers last_error_* and command_*. */
struct lw_refusal {
	uint16_t reason;  /**< enum lw_reason */
	uint16_t address; /**< offending address, LW_NO_ADDRESS if none */
	int32_t value;    /**< offending value */
	int32_t limit;    /**< the limit that it broke, of allowed values the nearest */
};

/** lw_refusal.address when no address is to blame. */
#define LW_NO_ADDRESS 0xFFFFu

/**
 * Note a refusal. Value and limit are cut to 32 bit.
 *
 * @return `error`, a negative errno
 */
static inline int lw_refuse(struct lw_refusal *why, int error, enum lw_reason reason,
			    uint32_t address, int64_t value, int64_t limit)
{
	*why = (struct lw_refusal){
		.reason = (uint16_t)reason,
		.address = (uint16_t)address,
		.value = lw_clamp32(value),
		.limit = lw_clamp32(limit),
	};
	return error;
}

#endif /* LW_REFUSAL_H */
