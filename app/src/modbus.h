/**
 * @file
 * The Modbus line: the UART's interrupt moves bytes, the Modbus thread hands frames to the core's
 * slave.
 */
#ifndef MODBUS_H
#define MODBUS_H

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

#endif /* MODBUS_H */
