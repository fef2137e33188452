/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The Modbus line: the UART's interrupt moves bytes, the Modbus thread hands frames to the core's
 * slave.
 */
#ifndef MODBUS_H
#define MODBUS_H

#include <stdbool.h>

#include "watch.h"

/**
 * Configure the line by the stored parameters and begin to answer. app_device must be initialized.
 * Not for interrupt context.
 *
 * @retval 0 done
 * @retval -ENODEV the UART or a pin is missing
 * @retval -ENOMEM no watchdog channel is left
 * @retval <0 errno of a driver
 */
int modbus_start(void);

/**
 * Wait until nothing is being sent, and let nothing be sent until modbus_release(). For a thread
 * that makes the processor stand still: an answer that stands still keeps the line from all others.
 * Not for interrupt context.
 *
 * @param caller the thread, which reports while it waits
 */
void modbus_hold(enum watch_thread caller);

/**
 * Let answers be sent again. By the thread that called modbus_hold().
 *
 * @param has_stood_still the processor and its clock have stood still meanwhile: nobody knows how
 *        long ago came what has come, so it is dropped
 */
void modbus_release(bool has_stood_still);

#endif /* MODBUS_H */
