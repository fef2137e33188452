/* SPDX-License-Identifier: Apache-2.0 */
#include "step_train.h"

#include <errno.h>

#include <zephyr/sys/util.h>

/** Shortest run that a timer can count. */
#define RUN_TICKS_MIN 2u

static uint64_t to_ticks(uint32_t time_ns, uint32_t timer_hz)
{
	return DIV_ROUND_UP((uint64_t)time_ns * timer_hz, 1000000000u);
}

int step_train_configure(struct step_train_config *config, uint32_t timer_hz, uint32_t dir_setup_ns,
			 uint32_t dir_hold_ns, uint32_t step_pulse_ns, uint32_t step_space_ns,
			 uint32_t ticks_max)
{
	const uint64_t setup = MAX(to_ticks(dir_setup_ns, timer_hz), RUN_TICKS_MIN);
	const uint64_t space = MAX(to_ticks(step_space_ns, timer_hz), 1u);
	const uint64_t pulse = MAX(to_ticks(step_pulse_ns, timer_hz), 1u);
	const uint64_t hold = to_ticks(dir_hold_ns, timer_hz);
	/* A run of one tick would be an auto-reload value of 0, at which a counter never ends. */
	const uint64_t held = hold > space ? MAX(hold - space, RUN_TICKS_MIN) : 0;

	if (MAX(MAX(setup, held), pulse + space) > ticks_max) {
		return -ERANGE;
	}
	*config = (struct step_train_config){
		.dir_setup_ticks = (uint32_t)setup,
		.dir_hold_ticks = (uint32_t)held,
		.step_pulse_ticks = (uint32_t)pulse,
		.step_space_ticks = (uint32_t)space,
	};
	return 0;
}

bool step_train_next(struct step_train *train, const struct step_train_config *config,
		     struct step_run *run)
{
	const bool held = train->held;
	const int8_t wanted = train->waiting == 0 ? train->prepared : train->waiting > 0 ? 1 : -1;

	train->held = false;
	if (!step_train_goes_on(train)) {
		return false;
	}
	if (wanted == train->direction) {
		train->waiting -= wanted;
		*run = (struct step_run){.pulse_ticks = config->step_pulse_ticks,
					 .rest_ticks = config->step_space_ticks};
	} else if (train->direction != 0 && config->dir_hold_ticks > 0 && !held) {
		train->held = true;
		*run = (struct step_run){.rest_ticks = config->dir_hold_ticks};
	} else {
		train->direction = wanted;
		*run = (struct step_run){.set_direction = wanted,
					 .rest_ticks = config->dir_setup_ticks};
	}
	return true;
}
