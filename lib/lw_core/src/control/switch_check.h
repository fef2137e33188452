/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Switches against the position: an indexed controller knows where a switch must and cannot be
 * actuated. A broken wire or a stuck switch shows so while nothing moves yet, not in the launch.
 */
#ifndef LW_SWITCH_CHECK_H
#define LW_SWITCH_CHECK_H

#include "lw/control/carriage.h"

/** Is the carriage so far inward that the switch of a side cannot be actuated any more? */
bool lw_switch_check_surely_inward(const struct lw_controller *controller, int side);

/** Compare what the switches say with the known position. Every tick. */
void lw_switch_check_tick(struct lw_controller *controller);

#endif /* LW_SWITCH_CHECK_H */
