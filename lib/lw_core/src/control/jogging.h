/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Moving by hand, for as long as the master says so again and again.
 */
#ifndef LW_JOGGING_H
#define LW_JOGGING_H

#include "lw/control/carriage.h"

/** Jog, or hold on jogging; 0 ends it. Only if lw_controller_allow_jog() says 0. */
void lw_jogging_write(struct lw_controller *controller, int direction, uint64_t now_us);

/** A jog goes on, or ends. Every tick in the state JOGGING. */
void lw_jogging_tick(struct lw_controller *controller);

#endif /* LW_JOGGING_H */
