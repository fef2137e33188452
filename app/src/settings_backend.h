/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Where Zephyr's settings are kept (CONFIG_SETTINGS_CUSTOM): two logs, each one half of the storage
 * partition, of any flash. A cut of the power leaves the value that is being saved as it was or as
 * it is to be, and every other one as it is. settings_backend.c says why.
 */
#ifndef SETTINGS_BACKEND_H
#define SETTINGS_BACKEND_H

#include <stdbool.h>

#include <zephyr/sys/util.h>

/** Values that can be kept; one that was deleted counts until the log is changed. */
#define SETTINGS_BACKEND_VALUES_MAX 8

/** Bytes of a name, with the 0 at its end. */
#define SETTINGS_BACKEND_NAME_SIZE 24

/** Entries begin at multiples of it: the largest unit of writing that a flash may have, in bytes.
 */
#define SETTINGS_BACKEND_ALIGN 8

/**
 * Bytes that a value takes in a log. All values, and the longest once more, must fit into half of
 * the partition.
 */
#define SETTINGS_BACKEND_ENTRY_SIZE(value_size)                                                    \
	ROUND_UP(4 * sizeof(uint32_t) + SETTINGS_BACKEND_NAME_SIZE + (value_size),                 \
		 SETTINGS_BACKEND_ALIGN)

/** Has a log been erased since the last call? Not for interrupt context. */
bool settings_backend_has_erased(void);

#endif /* SETTINGS_BACKEND_H */
