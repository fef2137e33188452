/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The parts of a device, and what each does for those above it.
 */
#ifndef LW_DEVICE_INTERNAL_H
#define LW_DEVICE_INTERNAL_H

#include "lw/device/device.h"

/* commands.c */

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

/** Has a command that takes its time come to an end? */
void lw_device_watch_command(struct lw_device *device);

/** Begin the account of a command in the registers command_*. */
void lw_device_note_command(struct lw_device *device, enum lw_command command,
			    enum lw_result result);

/* line_trial.c */

/** Put the line settings of power-up in use; before lw_slave_init(). */
void lw_device_line_init(struct lw_device *device);

/** Do the active line settings differ from those in use? */
bool lw_device_line_differs(const struct lw_device *device);

/** Do line settings wait for a valid request? */
bool lw_device_line_on_trial(const struct lw_device *device);

/** Use the active line settings on trial. */
void lw_device_line_try(struct lw_device *device);

/** End a trial that is confirmed, or whose time is up. */
void lw_device_line_tick(struct lw_device *device);

/* journal.c */

/**
 * Append an event to the log: now, here. An event whose cause comes and goes too often is skipped,
 * or waits for another's write.
 *
 * @return it is in the log
 */
bool lw_device_log(struct lw_device *device, enum lw_event event, int32_t detail);

/** Log the power-up: what was found in the storage, and why there was one. */
void lw_device_log_power_up(struct lw_device *device);

/** Log what has changed since the last call. After every tick and every command. */
void lw_device_log_changes(struct lw_device *device);

/** One write more: it costs a minute. */
void lw_budget_pay(struct lw_write_budget *budget, uint64_t now_us);

/** May there be a write now, if so many may come at once? */
bool lw_budget_left(const struct lw_write_budget *budget, uint64_t now_us,
		    unsigned int writes_at_once);

/** The journal has been written, or could not be: that has its price. */
void lw_device_note_journal(struct lw_device *device);

/** Count the hours, and ask for the journal to be written when it is time. */
void lw_device_keep_journal(struct lw_device *device, uint64_t elapsed_us);

/** Has the line not been silent for a second, within the last 10 s? */
bool lw_device_line_babbles(const struct lw_device *device);

/** Has the line given back an answer, within the last 10 s? */
bool lw_device_line_echoes(const struct lw_device *device);

/** True if the drum is faster than the parameters allow. */
bool lw_device_overspeed(const struct lw_device *device);

/** The event log as a file. */
struct lw_pdu_file lw_device_log_file(struct lw_device *device);

/* status.c */

/** Is this a real machine on which nobody has ever saved a set? The factory's is another's. */
bool lw_device_set_unconfirmed(const struct lw_device *device);

/** Bits of enum lw_launch_inhibit_bit: the controller's and the device's own. */
uint16_t lw_device_launch_inhibit(const struct lw_device *device);

/* look.c */

/** Power up: what needed a look at the rope still does. */
void lw_device_restore_look(struct lw_device *device);

/* kept.c */

/** Power up: was this a restart in a launch? */
void lw_device_restore_launch(struct lw_device *device);

/** Keep whether a launch is under way, and in which direction the carriage goes. Every tick.
 *  @param looks_at_memory seal it anew, too, if something has disturbed it */
void lw_device_keep_launch(struct lw_device *device, bool looks_at_memory);

/* look.c */

/** Ask for what needs a look to be stored, if it has changed. After every tick. */
void lw_device_keep_look(struct lw_device *device);

/** What needs a look since before the power-up: 1 << enum lw_look_cause, or-ed. */
uint16_t lw_device_look_before_power_up(struct lw_device *device);

/* cam_commands.c */

/** Power up: the newest stored table is in force. */
void lw_device_cam_init(struct lw_device *device);

/** Files of the banks, one for each. */
void lw_device_cam_files(struct lw_device *device, struct lw_pdu_file *files);

/** Registers of the upload. */
struct lw_bank_section lw_device_cam_section(struct lw_device *device);

/** Run CAM_CHECK, CAM_ACTIVATE or CAM_DISCARD. */
void lw_device_cam_run(struct lw_device *device, enum lw_command command);

/**
 * May this set be made active with the table that is in force?
 *
 * @retval 0 yes
 * @retval -EINVAL it is to be followed and cannot be; `why` says why
 */
int lw_device_cam_check(struct lw_device *device, const struct lw_params *params,
			struct lw_refusal *why);

/** Check the tables again under the active set. While nothing moves. */
void lw_device_cam_configure(struct lw_device *device);

/** The table in force has been stored, or could not be: then it is tried again at a change. */
void lw_device_cam_stored(struct lw_device *device, int result);

/** Notice that a queued table has come into force. */
void lw_device_cam_tick(struct lw_device *device);

/** Does a table wait for the end of the cycle? */
bool lw_device_cam_queued(const struct lw_device *device);

/** Fill the registers cam_* of the status. */
void lw_device_cam_status(const struct lw_device *device, struct lw_status *status);

/* bank_sections.c */

/** Fill the list of sections. */
void lw_device_make_bank(struct lw_device *device);

#endif /* LW_DEVICE_INTERNAL_H */
