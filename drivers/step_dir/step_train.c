#include "step_train.h"

#include <errno.h>

#include <zephyr/sys/util.h>

static uint64_t to_ticks(uint32_t time_ns, uint32_t timer_hz)
{
	return DIV_ROUND_UP((uint64_t)time_ns * timer_hz, 1000000000u);
}

int step_train_configure(struct step_train_config *config, uint32_t timer_hz, uint32_t dir_setup_ns,
			 uint32_t dir_hold_ns, uint32_t step_pulse_ns, uint32_t step_space_ns,
			 uint32_t ticks_max)
{
	const uint64_t setup = to_ticks(dir_setup_ns, timer_hz);
	const uint64_t hold = to_ticks(dir_hold_ns, timer_hz);
	const uint64_t space = MAX(to_ticks(step_space_ns, timer_hz), 1u);
	const uint64_t pulse = MAX(to_ticks(step_pulse_ns, timer_hz), 1u);

	if (MAX(MAX(setup, space) + pulse, hold) > ticks_max) {
		return -ERANGE;
	}
	*config = (struct step_train_config){
		.dir_setup_ticks = (uint32_t)MAX(setup, space),
		.dir_hold_ticks = (uint32_t)hold,
		.step_pulse_ticks = (uint32_t)pulse,
		.step_space_ticks = (uint32_t)space,
	};
	return 0;
}

bool step_train_next(struct step_train *train, const struct step_train_config *config,
		     struct step_run *run)
{
	const bool held = train->held;
	const int8_t direction = train->waiting > 0 ? 1 : -1;

	train->held = false;
	if (train->waiting == 0) {
		return false;
	}
	if (direction == train->direction) {
		*run = (struct step_run){.delay_ticks = config->step_space_ticks,
					 .pulse_ticks = config->step_pulse_ticks};
	} else if (train->direction != 0 && config->dir_hold_ticks > 0 && !held) {
		train->held = true;
		*run = (struct step_run){.delay_ticks = config->dir_hold_ticks};
		return true;
	} else {
		train->direction = direction;
		*run = (struct step_run){.set_direction = direction,
					 .delay_ticks = config->dir_setup_ticks,
					 .pulse_ticks = config->step_pulse_ticks};
	}
	train->waiting -= direction;
	return true;
}
