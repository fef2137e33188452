/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The machine as the controller sees it: its pins through their drivers, and the timer that makes
 * edges while the carriage moves by itself.
 */
#ifndef MACHINE_H
#define MACHINE_H

#include "lw/control/controller.h"

/**
 * Are all drivers of the machine there? Not for interrupt context.
 *
 * @retval 0 yes; the stepper has no current
 * @retval -ENODEV one is missing
 */
int machine_check(void);

/**
 * Read all input pins. Not for interrupt context.
 *
 * @retval 0 done
 * @retval <0 errno of a driver
 */
int machine_read(struct lw_inputs *inputs);

/**
 * Let encoder and overtravel switches interrupt. app_device must be initialized. Not for interrupt
 * context.
 *
 * @retval 0 done
 * @retval <0 errno of a driver
 */
int machine_start(void);

/**
 * Tell the controller what no interrupt tells: the stepper driver's alarm. Called by the supervisor
 * before every tick, with app_lock held.
 *
 * @retval 0 done
 * @retval <0 errno of a driver
 */
int machine_poll(void);

/** Are the encoder's edges counted in hardware, also while the processor stands? */
bool machine_keeps_edges(void);

/** Take the current from the stepper, whatever the controller wants. Interrupt safe. */
void machine_stop(void);

/**
 * Do what the controller asks for outside of its interrupts: motor current, edge timer. Called by
 * the supervisor after every tick, with app_lock held.
 *
 * @retval 0 done
 * @retval <0 errno of a driver
 */
int machine_serve_outputs(void);

#endif /* MACHINE_H */
