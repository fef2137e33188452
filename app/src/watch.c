/* SPDX-License-Identifier: Apache-2.0 */
#include "watch.h"

#include <zephyr/drivers/hwinfo.h>
#include <zephyr/fatal.h>
#include <zephyr/sys/reboot.h>
#include <zephyr/task_wdt/task_wdt.h>

#include "app.h"
#include "line_driver.h"
#include "lw/drivers/system_timer.h"
#include "machine.h"
#ifdef CONFIG_LW_SIMULATED_MACHINE
#include "simulated_machine.h"
#endif

/** `watch_note` after a restart by this file; anything else is what the power-up has left. */
#define NOTE_WATCHDOG     0x77617463u
#define NOTE_WITH_CURRENT (NOTE_WATCHDOG + 1) /**< the simulated stepper still had current */

__noinit uint32_t watch_note;

/** What the journal lacks. A power-up leaves anything here, so a pattern says that it is ours. */
static __noinit struct {
	uint32_t pattern;
	struct lw_unstored_starts starts;
} unstored;

/** What the device keeps of a launch; it seals it itself. */
static __noinit struct lw_kept kept;

#define UNSTORED_PATTERN 0x756E7374u

/** Those before this one. */
static struct lw_unstored_starts before;

/** Between two interrupts of the kernel's clock: above any time without a tick, below a second. */
#define STOOD_STILL_MS 100

K_KERNEL_STACK_ARRAY_DECLARE(z_interrupt_stacks, CONFIG_MP_MAX_NUM_CPUS, CONFIG_ISR_STACK_SIZE);

static bool by_watchdog;
static int channels[WATCH_THREADS];
static k_tid_t threads[WATCH_THREADS]; /**< each written by the thread itself, once */

FUNC_NORETURN void watch_restart(void)
{
	(void)irq_lock();
	machine_stop();
	(void)line_driver_let_go();
	watch_note = NOTE_WATCHDOG;
#ifdef CONFIG_LW_SIMULATED_MACHINE
	if (simulated_machine_has_current()) {
		watch_note = NOTE_WITH_CURRENT;
	}
#endif
	sys_reboot(SYS_REBOOT_COLD);
}

/** In the system timer's interrupt. */
static void on_timeout(int channel, void *user_data)
{
	ARG_UNUSED(user_data);
#ifdef CONFIG_LW_STM32_SYSTEM_TIMER
	/* The processor stood still, for its flash was erased: no thread could report. */
	if (lw_system_timer_gap_ms() > STOOD_STILL_MS) {
		(void)task_wdt_feed(channel);
		return;
	}
#else
	ARG_UNUSED(channel);
#endif
	watch_restart();
}

/** In place of the kernel's, which would stand still with the current on. */
void k_sys_fatal_error_handler(unsigned int reason, const struct arch_esf *esf)
{
	ARG_UNUSED(reason);
	ARG_UNUSED(esf);
	watch_restart();
}

int watch_start(void)
{
	const struct device *const watchdog = DEVICE_DT_GET_OR_NULL(DT_PHANDLE(APP_NODE, watchdog));

	by_watchdog = watch_note == NOTE_WATCHDOG || watch_note == NOTE_WITH_CURRENT;
#ifdef CONFIG_LW_SIMULATED_MACHINE
	simulated_machine_note_restart(!by_watchdog ? LW_BENCH_RESTART_NONE
				       : watch_note == NOTE_WITH_CURRENT
					       ? LW_BENCH_RESTART_WITH_CURRENT
					       : LW_BENCH_RESTART_WITHOUT_CURRENT);
#endif
	watch_note = 0;
	if (unstored.pattern != UNSTORED_PATTERN) {
		unstored.starts = (struct lw_unstored_starts){0};
		unstored.pattern = UNSTORED_PATTERN;
	}
#ifdef CONFIG_HWINFO
	uint32_t cause;

	if (hwinfo_get_reset_cause(&cause) == 0) {
		by_watchdog |= (cause & RESET_WATCHDOG) != 0;
		(void)hwinfo_clear_reset_cause();
	}
#endif
	before = unstored.starts;
	unstored.starts.boots++;
	unstored.starts.watchdog_resets += by_watchdog;
	return task_wdt_init(watchdog);
}

struct lw_kept *watch_kept(void)
{
	return &kept;
}

struct lw_unstored_starts watch_unstored_starts(void)
{
	return before;
}

void watch_stored(void)
{
	unstored.starts = (struct lw_unstored_starts){0};
}

bool watch_has_restarted(void)
{
	return by_watchdog;
}

int watch_add(enum watch_thread thread)
{
	channels[thread] =
		task_wdt_add(thread == WATCH_STORAGE ? CONFIG_LW_WATCHDOG_STORAGE_TIMEOUT_MS
						     : CONFIG_LW_WATCHDOG_TIMEOUT_MS,
			     on_timeout, NULL);
	return MIN(channels[thread], 0);
}

void watch_report(enum watch_thread thread)
{
	threads[thread] = k_current_get();
#ifdef CONFIG_LW_SIMULATED_MACHINE
	simulated_machine_hang(thread);
#endif
	(void)task_wdt_feed(channels[thread]);
}

/** The processor begins at the far end: count from the near one. */
static uint16_t interrupt_stack_free_bytes(void)
{
	const uint8_t *stack = K_KERNEL_STACK_BUFFER(z_interrupt_stacks[0]);
	uint16_t free_bytes = 0;

	while (free_bytes < CONFIG_ISR_STACK_SIZE && stack[free_bytes] == 0xAA) {
		free_bytes++;
	}
	return free_bytes;
}

void watch_measure_stacks(struct lw_device_health *health)
{
	static uint8_t next;
	uint16_t *const free_bytes[WATCH_THREADS + 1] = {
		[WATCH_SUPERVISOR] = &health->stack_free_supervisor_bytes,
		[WATCH_LIMITS] = &health->stack_free_limits_bytes,
		[WATCH_MODBUS] = &health->stack_free_modbus_bytes,
		[WATCH_STORAGE] = &health->stack_free_storage_bytes,
		[WATCH_THREADS] = &health->stack_free_interrupts_bytes,
	};
	size_t count = 0;

	if (IS_ENABLED(CONFIG_ARCH_POSIX)) {
		return; /* its threads run on stacks of the host */
	}
	if (next == WATCH_THREADS) {
		count = interrupt_stack_free_bytes();
	} else if (threads[next] != NULL) {
		(void)k_thread_stack_space_get(threads[next], &count);
	}
	*free_bytes[next] = (uint16_t)count;
	next = (uint8_t)((next + 1) % ARRAY_SIZE(free_bytes));
}
