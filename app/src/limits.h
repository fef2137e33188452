/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The limit switches: an interrupt keeps where the carriage was at every contact change, the
 * limits thread debounces.
 */
#ifndef LIMITS_H
#define LIMITS_H

/**
 * Let the limit switches interrupt, and start the limits thread. app_device must be initialized.
 * Not for interrupt context.
 *
 * @retval 0 done
 * @retval <0 errno of a driver, or -ENOMEM: no watchdog channel is left
 */
int limits_start(void);

#endif /* LIMITS_H */
