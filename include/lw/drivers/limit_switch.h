/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Driver class: the contacts of a limit switch. Debouncing is the controller's
 * (lw/control/limit_switch.h); the driver tells every transition at once, so that the position of
 * the first can be kept.
 */
#ifndef LW_DRIVERS_LIMIT_SWITCH_H
#define LW_DRIVERS_LIMIT_SWITCH_H

#include <stdbool.h>

#include <zephyr/device.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The contacts of a switch. A contact that is not wired counts as open. */
struct lw_contacts {
	bool no_closed;
	bool nc_closed;
};

/** A contact has changed. Called in interrupt context. */
typedef void (*lw_contacts_callback)(struct lw_contacts contacts, void *user_data);

/** What a driver of this class offers; see the functions below. */
struct lw_contacts_api {
	int (*start)(const struct device *dev, lw_contacts_callback callback, void *user_data);
	int (*read)(const struct device *dev, struct lw_contacts *contacts);
	bool (*actuated)(const struct device *dev, struct lw_contacts contacts);
};

/**
 * Begin to call back on every transition of a contact. Not for interrupt context.
 *
 * @retval 0 done
 * @retval <0 errno of the GPIO driver
 */
static inline int lw_contacts_start(const struct device *dev, lw_contacts_callback callback,
				    void *user_data)
{
	const struct lw_contacts_api *api = (const struct lw_contacts_api *)dev->api;

	return api->start(dev, callback, user_data);
}

/**
 * Read the contacts. Interrupt safe.
 *
 * @retval 0 done
 * @retval <0 errno of the GPIO driver
 */
static inline int lw_contacts_read(const struct device *dev, struct lw_contacts *contacts)
{
	const struct lw_contacts_api *api = (const struct lw_contacts_api *)dev->api;

	return api->read(dev, contacts);
}

/**
 * Do these contacts say that the switch is actuated? For switches that need no debouncing: an open
 * NC contact decides, or, where there is none, a closed NO contact. Interrupt safe.
 */
static inline bool lw_contacts_actuated(const struct device *dev, struct lw_contacts contacts)
{
	const struct lw_contacts_api *api = (const struct lw_contacts_api *)dev->api;

	return api->actuated(dev, contacts);
}

#ifdef __cplusplus
}
#endif

#endif /* LW_DRIVERS_LIMIT_SWITCH_H */
