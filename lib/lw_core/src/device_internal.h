/**
 * @file
 * What device.c (commands, life) and device_bank.c (registers) share.
 */
#ifndef LW_DEVICE_INTERNAL_H
#define LW_DEVICE_INTERNAL_H

#include "lw/device.h"

/**
 * May a command run now?
 *
 * @retval 0 yes
 * @retval -EBUSY not now; `why->reason` says why
 */
int lw_device_allow_command(const struct lw_device *device, enum lw_command command,
			    struct lw_refusal *why);

/** Run an allowed command. */
void lw_device_run_command(struct lw_device *device, enum lw_command command);

/** Begin the account of a command in the registers command_*. */
void lw_device_note_command(struct lw_device *device, enum lw_command command,
			    enum lw_result result);

/** Fill the list of sections. */
void lw_device_make_bank(struct lw_device *device);

#endif /* LW_DEVICE_INTERNAL_H */
