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
	void (*step)(const struct device *dev, int direction);
	int (*enable)(const struct device *dev, bool enabled);
	int (*alarm)(const struct device *dev);
};

/**
 * Give one step pulse. Direction set-up and hold time, pulse width and space are kept; a pulse that
 * comes too early for them is given later, never lost. Waits at most 1 us. For one interrupt
 * priority only: calls must not interrupt each other.
 *
 * @param direction +1 or -1
 */
static inline void lw_step_dir_step(const struct device *dev, int direction)
{
	const struct lw_step_dir_api *api = (const struct lw_step_dir_api *)dev->api;

	api->step(dev, direction);
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
