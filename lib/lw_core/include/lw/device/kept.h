/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What a host's memory keeps over a restart: that a launch was under way, and in which direction
 * the carriage went. Whatever stands there after a power-up is no launch unless it is sealed. Not
 * for interrupt context.
 */
#ifndef LW_KEPT_H
#define LW_KEPT_H

#include <stdint.h>

/** Written by the device in every tick in which it changes. The host only leaves it alone. */
struct lw_kept {
	uint32_t launch;   /**< 1: the carriage follows a turning drum */
	int32_t direction; /**< of the carriage while the drum hauls in, +1 or -1; 0: not known */
	uint32_t seal;     /**< of the two */
};

#endif /* LW_KEPT_H */
