/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Following the drum. Whether the switches trigger where they are: los_judge.h.
 */
#ifndef LW_TRACKING_H
#define LW_TRACKING_H

#include "carriage_acts.h"

/** Let the drum move what has been placed, by the law or by a cam. */
void lw_tracking_begin(struct lw_controller *controller);

/** Follow the drum by the law from here. */
void lw_tracking_start(struct lw_controller *controller);

/** Stop following a resting drum. The carriage stands; it can go on as if nothing had been. */
void lw_tracking_leave(struct lw_controller *controller);

#endif /* LW_TRACKING_H */
