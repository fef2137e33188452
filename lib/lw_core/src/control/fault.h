/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Faults: the carriage stops by one, and goes on when it has been acknowledged. Their list is the
 * enum `fault` of modbus_map/registers.yaml; who finds one is the file of the motion, or
 * controller.c. Not for interrupt context.
 */
#ifndef LW_FAULT_H
#define LW_FAULT_H

#include "carriage_acts.h"

/** Stop with a named fault; the index is lost. */
void lw_fault_stop(struct lw_controller *controller, enum lw_fault fault);

/**
 * Without a position the switches must tell the truth: stop with a fault if the wiring of one does
 * not.
 *
 * @return it has stopped
 */
bool lw_fault_stop_by_wiring(struct lw_controller *controller);

/** Does the cause of the fault still stand, so that it cannot be acknowledged? */
bool lw_fault_cause_present(const struct lw_controller *controller);

/** Acknowledge the fault. The position is unknown afterwards; LOS flags stay. */
void lw_fault_clear(struct lw_controller *controller);

#endif /* LW_FAULT_H */
