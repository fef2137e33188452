/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Losses of synchronization (LOS 1 and LOS 2) while the carriage follows the drum: has each switch
 * triggered on the way to its reversal, and where it was calibrated? What is kept of them is in
 * lw/control/los_record.h. Not for interrupt context.
 */
#ifndef LW_LOS_JUDGE_H
#define LW_LOS_JUDGE_H

#include "carriage_acts.h"

/** Following begins: nothing is to be judged of what came before. */
void lw_los_judge_begin(struct lw_controller *controller);

/**
 * Judge the triggers of this tick, and the reversals. LOS 2 asks for a correction, or stops with a
 * fault.
 */
void lw_los_judge_tick(struct lw_controller *controller,
		       const struct lw_carriage_trigger *triggers);

#endif /* LW_LOS_JUDGE_H */
