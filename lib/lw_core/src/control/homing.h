/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Indexing: the carriage finds its place by the limit switches (doc/control-law.md section 5).
 */
#ifndef LW_HOMING_H
#define LW_HOMING_H

#include "carriage_acts.h"

/** Forget the index and begin to find it. Ends in READY or FAULT. */
void lw_homing_start(struct lw_controller *controller);

/** Does an indexing go on? */
bool lw_homing_is_under_way(const struct lw_controller *controller);

/** End it before it is done: ramp down, then enter `rest_state`. */
void lw_homing_stop(struct lw_controller *controller, enum lw_state rest_state);

/** Go on. Every tick while it is under way. */
void lw_homing_tick(struct lw_controller *controller, const struct lw_carriage_trigger *triggers);

#endif /* LW_HOMING_H */
