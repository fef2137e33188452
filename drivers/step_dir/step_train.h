/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Steps as runs of a timer that makes one pulse: what step_dir_stm32.c does, without its registers.
 *
 * A run begins with the pulse, if it has one, counts the time that must pass behind it, and stops.
 * So a step that comes after a pause is given at once. Behind a pulse that is the space between two
 * pulses; before a direction changes, what is missing of its hold time; behind the change, its
 * set-up time. A step that comes while a run is under way waits for the end of it, so nothing is
 * lost and nobody waits. A step and its opposite that both wait are neither given: the motor ends
 * where it shall. Of more than LW_STEP_DIR_WAITING_MAX steps none is given, and that is told.
 *
 * Interrupt safe; calls for one train must not interrupt each other.
 */
#ifndef STEP_TRAIN_H
#define STEP_TRAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/drivers/step_dir.h"

/** Times in ticks of the timer. */
struct step_train_config {
	uint32_t dir_setup_ticks;
	uint32_t dir_hold_ticks; /**< beyond the space behind a pulse; 0: none */
	uint32_t step_pulse_ticks;
	uint32_t step_space_ticks;
};

/** State; all zero at the start. */
struct step_train {
	int32_t waiting;  /**< net steps that no run has been made for */
	int8_t direction; /**< at the output; 0: not known yet */
	int8_t prepared;  /**< direction that the output shall have when no step waits; 0: any */
	bool held;        /**< the hold time of `direction` was the last run */
	bool lost;        /**< too many steps waited, and were dropped */
};

/** What the timer shall do next. */
struct step_run {
	int8_t set_direction; /**< +1, -1: put this at the output first; 0: leave it */
	uint32_t pulse_ticks; /**< 0: no pulse in this run */
	uint32_t rest_ticks;  /**< behind the pulse */
};

/**
 * Times to ticks, rounded up; no run is shorter than two, which every timer can count.
 *
 * @param ticks_max longest run that the timer can count
 * @retval 0 done
 * @retval -ERANGE the timer is too fast for these times; `config` is not valid
 */
int step_train_configure(struct step_train_config *config, uint32_t timer_hz, uint32_t dir_setup_ns,
			 uint32_t dir_hold_ns, uint32_t step_pulse_ns, uint32_t step_space_ns,
			 uint32_t ticks_max);

/** Ask for steps, toward plus or minus. */
static inline void step_train_add(struct step_train *train, int steps)
{
	train->waiting += steps;
	train->prepared = 0;
	if (train->waiting > LW_STEP_DIR_WAITING_MAX || train->waiting < -LW_STEP_DIR_WAITING_MAX) {
		train->waiting = 0;
		train->lost = true;
	}
}

/** Is a pulse with its space all that these steps want, of a timer that stands? Then take them. */
static inline bool step_train_is_next(struct step_train *train, int steps)
{
	if (train->waiting != 0 || steps != train->direction) {
		return false;
	}
	train->prepared = 0;
	train->held = false;
	return true;
}

/** Does a run have to follow the one that is under way, or that is being planned? */
static inline bool step_train_goes_on(const struct step_train *train)
{
	return train->waiting != 0 || (train->prepared != 0 && train->prepared != train->direction);
}

/** Plan the next run of a timer that stands. @return false: there is nothing to do */
bool step_train_next(struct step_train *train, const struct step_train_config *config,
		     struct step_run *run);

#endif /* STEP_TRAIN_H */
