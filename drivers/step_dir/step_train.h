/**
 * @file
 * Steps as runs of a timer that makes one pulse: what step_dir_stm32.c does, without its registers.
 *
 * A run counts the delay, then the pulse, and stops. The space between two pulses is the delay of
 * the second, and so is the set-up time of a direction. Before a direction changes, its hold time
 * is a run without a pulse. A step that comes while a run is under way waits for the end of it, so
 * nothing is lost and nobody waits. A step and its opposite that both wait are neither given: the
 * motor ends where it shall.
 *
 * Interrupt safe; calls for one train must not interrupt each other.
 */
#ifndef STEP_TRAIN_H
#define STEP_TRAIN_H

#include <stdbool.h>
#include <stdint.h>

/** Times in ticks of the timer. */
struct step_train_config {
	uint32_t dir_setup_ticks;
	uint32_t dir_hold_ticks;
	uint32_t step_pulse_ticks;
	uint32_t step_space_ticks;
};

/** State; all zero at the start. */
struct step_train {
	int8_t direction; /**< at the output; 0: not known yet */
	bool held;        /**< the hold time of `direction` was the last run */
	int32_t waiting;  /**< net steps that no run has been made for */
};

/** What the timer shall do next. */
struct step_run {
	int8_t set_direction; /**< +1, -1: put this at the output first; 0: leave it */
	uint32_t delay_ticks; /**< at least 1 */
	uint32_t pulse_ticks; /**< 0: no pulse in this run */
};

/**
 * Times to ticks, rounded up.
 *
 * @param ticks_max longest run that the timer can count
 * @retval 0 done
 * @retval -ERANGE the timer is too fast for these times; `config` is not valid
 */
int step_train_configure(struct step_train_config *config, uint32_t timer_hz, uint32_t dir_setup_ns,
			 uint32_t dir_hold_ns, uint32_t step_pulse_ns, uint32_t step_space_ns,
			 uint32_t ticks_max);

/** Ask for a step, +1 or -1. */
static inline void step_train_add(struct step_train *train, int direction)
{
	train->waiting += direction;
}

/** Plan the next run of a timer that stands. @return false: there is nothing to do */
bool step_train_next(struct step_train *train, const struct step_train_config *config,
		     struct step_run *run);

#endif /* STEP_TRAIN_H */
