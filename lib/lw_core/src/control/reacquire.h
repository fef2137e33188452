/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Taking up a turning drum from rest at an unknown place, after a restart in a launch
 * (doc/control-law.md section 5). Not for interrupt context.
 */
#ifndef LW_REACQUIRE_H
#define LW_REACQUIRE_H

#include "carriage_acts.h"

/** Begin. Only if lw_controller_allow_reacquire() says 0. Ends in TRACKING or FAULT. */
void lw_reacquire_start(struct lw_controller *controller);

/** Go on. Every tick in the state REACQUIRING. */
void lw_reacquire_tick(struct lw_controller *controller,
		       const struct lw_carriage_trigger *triggers);

#endif /* LW_REACQUIRE_H */
