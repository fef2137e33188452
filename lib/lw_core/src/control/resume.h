/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Where the rope goes on: the state of the pattern in which the drum came to rest, taken up again
 * after an indexing (doc/control-law.md section 5). Not for interrupt context.
 */
#ifndef LW_RESUME_H
#define LW_RESUME_H

#include "carriage_acts.h"

/** Keep the state while the carriage follows, watch the drum while it does not. Every tick. */
void lw_resume_tick(struct lw_controller *controller);

/** An indexing has succeeded: compare where the carriage stood before, and want the state. */
void lw_resume_indexed(struct lw_controller *controller);

/**
 * Before a hand-over, if `resume.wanted`: go to the place; once there, take up slope and dwell.
 *
 * @retval true under way: the hand-over waits for the state READY
 * @retval false taken up: the law is on its orbit, hand over
 */
bool lw_resume_approach(struct lw_controller *controller);

#endif /* LW_RESUME_H */
