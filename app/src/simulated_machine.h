/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A simulated machine at the controller's pins: the plant (lw/plant.h) moves the inputs of the
 * emulated GPIO and follows its outputs, so that the drivers above do not know the difference.
 *
 * The plant runs in the system timer's interrupt. It brings its events late, by
 * CONFIG_LW_SIMULATED_MACHINE_PERIOD_US at most, but in order and each with the controller's answer
 * to it; and it catches up before it takes a step. So the machine does not feel the delay.
 */
#ifndef SIMULATED_MACHINE_H
#define SIMULATED_MACHINE_H

#include <stdbool.h>

#include "lw/modbus/bank.h"
#include "lw/map.h"

/**
 * Start the machine: its pins get their levels, and time begins. Not for interrupt context.
 *
 * @retval 0 done
 * @retval <0 errno of the GPIO emulator
 */
int simulated_machine_start(void);

/** The bench registers of the machine. Their functions are for one thread at a time. */
const struct lw_bank_section *simulated_machine_section(void);

/**
 * Tell the machine whether the controller knows its position: from the beginning of that on, a slip
 * of the stepper counts as one.
 */
void simulated_machine_note_indexed(bool indexed);

/** Does the stepper have current, as its driver sees it? Interrupt safe. */
bool simulated_machine_has_current(void);

/** Tell the bench how the last restart was. Before simulated_machine_start(). */
void simulated_machine_note_restart(enum lw_bench_restart restart);

/** Hang for ever, or fail, if the bench wants it of this thread (enum watch_thread). */
void simulated_machine_hang(int thread);

/** Has the bench asked for a restart of the controller? Tells it once. */
bool simulated_machine_power_cut(bool *memory_kept);

#endif /* SIMULATED_MACHINE_H */
