/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Driver class: an incremental encoder that interrupts on the transitions of its channels. A driver
 * tells their levels, or it counts them in hardware, and then an interrupt that comes late costs
 * time but no transition.
 */
#ifndef LW_DRIVERS_ENCODER_H
#define LW_DRIVERS_ENCODER_H

#include <stdbool.h>
#include <stdint.h>

#include <zephyr/device.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * A channel has changed. Called in interrupt context, with the levels of both channels read
 * together after the interrupt was entered; they are equal to those of the last call if a channel
 * has changed and changed back meanwhile.
 */
typedef void (*lw_encoder_callback)(bool a, bool b, void *user_data);

/**
 * The channels have changed. Called in interrupt context.
 *
 * @param transitions of both channels since the last call, net: positive where A leads B; not 0
 * @return transitions that way after which the next call is due; it comes sooner where the drum
 * rocks, or turns slowly, and with the first one the other way
 */
typedef uint32_t (*lw_encoder_count_callback)(int32_t transitions, void *user_data);

/**
 * The index pulse has begun. Called in interrupt context.
 *
 * @param late it began an unknown number of transitions ago
 */
typedef void (*lw_encoder_index_callback)(bool late, void *user_data);

/** What a driver of this class offers; see the functions below. */
struct lw_encoder_api {
	/** NULL where the driver counts. */
	int (*start)(const struct device *dev, lw_encoder_callback callback, void *user_data);
	/** NULL where the driver tells levels. */
	int (*start_counting)(const struct device *dev, lw_encoder_count_callback callback,
			      void *user_data);
	/** NULL where the driver tells levels. */
	void (*poll)(const struct device *dev);
	int (*start_index)(const struct device *dev, lw_encoder_index_callback callback,
			   void *user_data);
	int (*read)(const struct device *dev, bool *a, bool *b);
};

/** Does the driver count transitions in hardware, so that none is missed by a late interrupt? */
static inline bool lw_encoder_counts(const struct device *dev)
{
	return ((const struct lw_encoder_api *)dev->api)->start_counting != NULL;
}

/**
 * Begin to call back on every transition of A or B, with their levels. For a driver that does not
 * count. Not for interrupt context.
 *
 * @retval 0 done
 * @retval <0 errno of the GPIO driver
 */
static inline int lw_encoder_start(const struct device *dev, lw_encoder_callback callback,
				   void *user_data)
{
	const struct lw_encoder_api *api = (const struct lw_encoder_api *)dev->api;

	return api->start(dev, callback, user_data);
}

/**
 * Begin to call back with the transitions since the last lw_encoder_read(). For a driver that
 * counts. Not for interrupt context.
 *
 * @retval 0 done
 */
static inline int lw_encoder_start_counting(const struct device *dev,
					    lw_encoder_count_callback callback, void *user_data)
{
	const struct lw_encoder_api *api = (const struct lw_encoder_api *)dev->api;

	return api->start_counting(dev, callback, user_data);
}

/**
 * Let a driver that counts call back with the transitions up to now, whatever the last call has
 * said; for others nothing. Call it once in a while, outside of its interrupts: between two calls
 * without an interrupt it takes the drum for one that rocks.
 */
static inline void lw_encoder_poll(const struct device *dev)
{
	const struct lw_encoder_api *api = (const struct lw_encoder_api *)dev->api;

	if (api->poll != NULL) {
		api->poll(dev);
	}
}

/**
 * Begin to call back at the beginning of every index pulse (Z). Not for interrupt context.
 *
 * @retval 0 done
 * @retval -ENOTSUP the encoder's index channel is not wired
 * @retval <0 errno of the GPIO driver
 */
static inline int lw_encoder_start_index(const struct device *dev,
					 lw_encoder_index_callback callback, void *user_data)
{
	const struct lw_encoder_api *api = (const struct lw_encoder_api *)dev->api;

	return api->start_index(dev, callback, user_data);
}

/**
 * Read the levels of both channels, which a driver that counts then counts from. Before it is
 * started.
 *
 * @retval 0 done
 * @retval <0 errno of the GPIO driver
 */
static inline int lw_encoder_read(const struct device *dev, bool *a, bool *b)
{
	const struct lw_encoder_api *api = (const struct lw_encoder_api *)dev->api;

	return api->read(dev, a, b);
}

#ifdef __cplusplus
}
#endif

#endif /* LW_DRIVERS_ENCODER_H */
