/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Every thread reports that it gets on with its work. A watchdog restarts the controller when one
 * has not for CONFIG_LW_WATCHDOG_TIMEOUT_MS, the storage queue for
 * CONFIG_LW_WATCHDOG_STORAGE_TIMEOUT_MS, and the kernel's fatal errors do so at once; before that
 * the stepper loses its current and the line its driver.
 */
#ifndef WATCH_H
#define WATCH_H

#include <zephyr/toolchain.h>

#include "lw/device/device.h"

/** The threads that are watched. */
enum watch_thread {
	WATCH_SUPERVISOR,
	WATCH_LIMITS,
	WATCH_MODBUS,
	WATCH_STORAGE,
	WATCH_THREADS,
};

/** Longest time that a thread may wait for work before it reports. */
#define WATCH_PERIOD K_MSEC(CONFIG_LW_WATCHDOG_TIMEOUT_MS / 4)

/**
 * Why the controller was restarted. A restart does not touch it: a processor's keeps its memory,
 * and that of native_sim, which is a new process, is given it (restart_native.c).
 */
extern uint32_t watch_note;

/**
 * Start the watchdog, and find out whether it made the last restart. Call it first, and once. Not
 * for interrupt context.
 *
 * @retval 0 done
 * @retval <0 errno of the hardware watchdog's driver
 */
int watch_start(void);

/** Was the last restart made by the watchdog or a fatal error? */
bool watch_has_restarted(void);

/** Memory that a restart does not touch; after a power-up anything stands there. */
struct lw_kept *watch_kept(void);

/** Starts that the journal does not know of: it is written 2 s after one. */
struct lw_unstored_starts watch_unstored_starts(void);

/** The journal has been stored, this start in it. Not for interrupt context. */
void watch_stored(void);

/**
 * From now on a thread must report. Not for interrupt context.
 *
 * @retval 0 done
 * @retval -ENOMEM no channel of the task watchdog is left
 */
int watch_add(enum watch_thread thread);

/**
 * Restart at once: the stepper loses its current first, and the line its driver. From any context,
 * a processor's fault included.
 */
FUNC_NORETURN void watch_restart(void);

/** The calling thread gets on with its work. */
void watch_report(enum watch_thread thread);

/**
 * Measure how much of a stack has never been used, one stack per call. Called by the supervisor
 * without app_lock: it takes a while.
 */
void watch_measure_stacks(struct lw_device_health *health);

#endif /* WATCH_H */
