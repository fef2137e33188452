/**
 * @file
 * The stored form of a parameter set: bytes with a version and a CRC, the same on every host.
 * Not for interrupt context.
 *
 *     'L' 'W' 'P' 'S', map version (16 bit), number of values (16 bit),
 *     the values in the order of the map (32 bit each), CRC-32 of all before; little-endian
 */
#ifndef LW_RECORD_H
#define LW_RECORD_H

#include <stddef.h>
#include <stdint.h>

#include "lw/map.h"

/** Bytes of a record. */
#define LW_RECORD_SIZE (4 + 2 + 2 + 4 * LW_MAP_PARAMS_COUNT + 4)

/** Write a parameter set as a record. */
void lw_record_encode(const struct lw_params *params, uint8_t record[LW_RECORD_SIZE]);

/**
 * Read a record.
 *
 * @param params receives the set; unchanged on any error
 * @retval 0 done; every value is within the limits of its register
 * @retval -EBADMSG not a record, cut short, damaged, or a value outside its limits
 * @retval -ENOTSUP a record of another map version
 */
int lw_record_decode(const uint8_t *record, size_t length, struct lw_params *params);

#endif /* LW_RECORD_H */
