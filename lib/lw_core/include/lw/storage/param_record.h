/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The stored form of a parameter set, and how older forms are read. Not for interrupt context.
 *
 * - Schema 2 (lw/storage/record.h, kind "LWPR"): for each parameter its holding register (16 bit)
 * and its value (32 bit), in ascending order. A parameter that the record does not have gets its
 * factory value: adding a parameter needs no new schema. Removing one, or changing what one means,
 * does.
 * - Schema 1, read only: 'L' 'W' 'P' 'S', 1 (16 bit), 51 (16 bit), the values of the 51 registers
 *   of that time (32 bit each), CRC-32 of all before; low byte first, no sequence number.
 */
#ifndef LW_PARAM_RECORD_H
#define LW_PARAM_RECORD_H

#include <stddef.h>
#include <stdint.h>

#include "lw/map.h"
#include "lw/storage/record.h"

/** The schema that is written. */
#define LW_PARAM_RECORD_SCHEMA 2

/** Bytes of a record that is written. */
#define LW_PARAM_RECORD_SIZE (LW_RECORD_OVERHEAD + 6 * LW_MAP_PARAMS_COUNT)

/** Write a parameter set as a record. @return LW_PARAM_RECORD_SIZE */
size_t lw_param_record_encode(const struct lw_params *params, uint32_t sequence,
			      uint8_t bytes[LW_PARAM_RECORD_SIZE]);

/**
 * Read a record of any schema up to LW_PARAM_RECORD_SCHEMA.
 *
 * @param size bytes that can be read
 * @param params receives the set; unchanged on any error
 * @param record receives schema and sequence number unless -ENODATA or -EBADMSG is returned
 * @retval 0 done; every value is within the limits of its register
 * @retval -ENODATA nothing there
 * @retval -EBADMSG not a record, cut short, or damaged
 * @retval -ENOTSUP intact, but of a newer schema, or with a parameter that this firmware lacks
 * @retval -EINVAL intact, but a value is outside the limits of its register, or registers are not
 *         in order
 */
int lw_param_record_decode(const uint8_t *bytes, size_t size, struct lw_params *params,
			   struct lw_record *record);

#endif /* LW_PARAM_RECORD_H */
