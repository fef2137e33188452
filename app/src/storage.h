/**
 * @file
 * The stored parameters: one record of the core (lw/record.h) in Zephyr's settings. NVS writes it
 * as a whole: a power cut leaves the old record or the new one.
 */
#ifndef STORAGE_H
#define STORAGE_H

#include <stddef.h>
#include <stdint.h>

/**
 * Start the storage. Not for interrupt context.
 *
 * @retval 0 done
 * @retval <0 errno of the settings: nothing can be loaded, and every save will fail
 */
int storage_start(void);

/**
 * Load the stored record.
 *
 * @param record receives it
 * @return its bytes; 0 if there is none, or if it is longer than `size`
 */
size_t storage_load(uint8_t *record, size_t size);

/**
 * Write the record that app_device has pending, if any, in the background. Called by the supervisor
 * with app_lock held.
 */
void storage_serve(void);

#endif /* STORAGE_H */
