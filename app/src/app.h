/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What the contexts of the firmware share: the device, its lock and its clock.
 *
 * Each of these may interrupt those below (interrupts.c checks the order of the interrupts):
 *
 * - encoder and step pulse, interrupts: decode, law, step (machine.c)
 * - edge timer, interrupt: law, step (machine.c)
 * - limit and overtravel switches, interrupts: keep the position of a contact change (limits.c),
 *   block steps (machine.c)
 * - UART, interrupt: move bytes (modbus.c)
 * - system timer, interrupt: the kernel's time-outs
 * - limits thread: debounce (limits.c)
 * - supervisor, the main thread: a tick every millisecond, and the outputs (main.c)
 * - Modbus thread: requests (modbus.c)
 * - storage work queue: write the parameters (storage.c)
 */
#ifndef APP_H
#define APP_H

#include <stdint.h>

#include <zephyr/devicetree.h>
#include <zephyr/kernel.h>

#include "lw/device/device.h"

/** The one node that says what the controller is wired to. */
#define APP_NODE DT_COMPAT_GET_ANY_STATUS_OKAY(levelwind_controller)

/** Priorities of the threads; each may interrupt those below. */
enum {
	APP_PRIORITY_LIMITS = K_PRIO_COOP(1),
	APP_PRIORITY_SUPERVISOR = K_PRIO_PREEMPT(1),
	APP_PRIORITY_MODBUS = K_PRIO_PREEMPT(2),
	APP_PRIORITY_STORAGE = K_PRIO_PREEMPT(3),
};

/** The controller. Threads take app_lock for it; the interrupts use what is theirs. */
extern struct lw_device app_device;

/** Held by the one thread that works on app_device. */
extern struct k_mutex app_lock;

/** The clock of the whole firmware: microseconds since power-up. Interrupt safe. */
static inline uint64_t app_now_us(void)
{
	return k_ticks_to_us_floor64((uint64_t)k_uptime_ticks());
}

#endif /* APP_H */
