/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The driver of a two-wire line (RS-485), where the board has one. Below the Modbus line, which
 * switches it, and the watchdog, which lets go of the line before a restart.
 */
#ifndef LINE_DRIVER_H
#define LINE_DRIVER_H

#include <stdbool.h>

/**
 * Let go of the line, whatever is being sent. First of all at power-up, for until then the pin
 * floats, and last of all before a restart. Interrupt safe.
 *
 * @retval 0 done
 * @retval -ENODEV the pin is missing
 * @retval <0 errno of its driver
 */
int line_driver_let_go(void);

/** Drive the line, or let it be driven by others. After line_driver_let_go(). Interrupt safe. */
void line_driver_switch(bool on);

#endif /* LINE_DRIVER_H */
