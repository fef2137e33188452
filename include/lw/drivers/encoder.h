/**
 * @file
 * Driver class: an incremental encoder that interrupts on every transition of its channels.
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

/** The index pulse has begun. Called in interrupt context. */
typedef void (*lw_encoder_index_callback)(void *user_data);

/** What a driver of this class offers; see the functions below. */
struct lw_encoder_api {
	int (*start)(const struct device *dev, lw_encoder_callback callback, void *user_data);
	int (*start_index)(const struct device *dev, lw_encoder_index_callback callback,
			   void *user_data);
	int (*read)(const struct device *dev, bool *a, bool *b);
};

/**
 * Begin to call back on every transition of A or B. Not for interrupt context.
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
 * Read the levels of both channels. Interrupt safe.
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
