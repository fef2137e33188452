/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The storage: the slots of the core (lw/storage/store.h) in Zephyr's settings, one value each.
 * They are written by a work queue of their own, the least urgent thread.
 */
#ifndef STORAGE_H
#define STORAGE_H

#include "lw/storage/store.h"

/**
 * Start the storage. Not for interrupt context.
 *
 * @retval 0 done
 * @retval <0 errno of the settings: nothing can be loaded, and every save will fail
 */
int storage_start(void);

/** Fill the store with what the slots hold. Not for interrupt context. */
void storage_load(struct lw_store *store);

/**
 * Do the write that app_device has due, if any, in the background. Called by the supervisor with
 * app_lock held.
 */
void storage_serve(void);

#endif /* STORAGE_H */
