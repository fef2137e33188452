/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Driver class: the step and direction inputs of a stepper driver.
 */
#ifndef LW_DRIVERS_STEP_DIR_H
#define LW_DRIVERS_STEP_DIR_H

#include <stdbool.h>

#include <zephyr/device.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What a driver of this class offers; see the functions below. */
struct lw_step_dir_api {
	void (*step)(const struct device *dev, int steps);
	void (*prepare)(const struct device *dev, int direction);
	bool (*take_lost)(const struct device *dev);
	int (*enable)(const struct device *dev, bool enabled);
	int (*alarm)(const struct device *dev);
};

/** So many steps may wait for their pulses: more, and no motor follows (lw_step_dir_take_lost()).
 */
#define LW_STEP_DIR_WAITING_MAX 64

/**
 * Give step pulses. Direction set-up and hold time, pulse width and space are kept; a pulse that
 * comes too early for them is given later. Waits at most 1 us for each. Calls must neither
 * interrupt each other, nor be interrupted by the driver's own interrupt: lock it out where it is
 * above.
 *
 * @param steps toward plus; toward minus where negative; not 0
 */
static inline void lw_step_dir_step(const struct device *dev, int steps)
{
	const struct lw_step_dir_api *api = (const struct lw_step_dir_api *)dev->api;

	api->step(dev, steps);
}

/**
 * Give the direction of a step that will come, so that it need not wait for the direction's set-up
 * time. Where steps wait they go first. As lw_step_dir_step().
 *
 * @param direction +1 or -1
 */
static inline void lw_step_dir_prepare(const struct device *dev, int direction)
{
	const struct lw_step_dir_api *api = (const struct lw_step_dir_api *)dev->api;

	api->prepare(dev, direction);
}

/**
 * Have more steps come than pulses can be given, since the last call? Those that waited were
 * dropped then: the carriage is not where the steps say. Interrupt safe.
 */
static inline bool lw_step_dir_take_lost(const struct device *dev)
{
	const struct lw_step_dir_api *api = (const struct lw_step_dir_api *)dev->api;

	return api->take_lost(dev);
}

/**
 * Motor current on or off. It is off at power-up. Does nothing where the enable input is not wired.
 *
 * @retval 0 done
 * @retval <0 errno of the GPIO driver
 */
static inline int lw_step_dir_enable(const struct device *dev, bool enabled)
{
	const struct lw_step_dir_api *api = (const struct lw_step_dir_api *)dev->api;

	return api->enable(dev, enabled);
}

/**
 * Read the alarm of the stepper driver.
 *
 * @retval 0 no alarm
 * @retval 1 alarm
 * @retval -ENOTSUP the alarm output is not wired
 * @retval <0 errno of the GPIO driver
 */
static inline int lw_step_dir_alarm(const struct device *dev)
{
	const struct lw_step_dir_api *api = (const struct lw_step_dir_api *)dev->api;

	return api->alarm(dev);
}

#ifdef __cplusplus
}
#endif

#endif /* LW_DRIVERS_STEP_DIR_H */
