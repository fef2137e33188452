/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * CRC-32 as in Ethernet and zip (reflected polynomial 0xEDB88320). Not for interrupt context.
 */
#ifndef LW_CRC32_H
#define LW_CRC32_H

#include <stddef.h>
#include <stdint.h>

/** Continue a CRC with more bytes. `crc` is that of the bytes before, 0 before the first. */
uint32_t lw_crc32_add(uint32_t crc, const uint8_t *bytes, size_t length);

/** The CRC of so many bytes. */
static inline uint32_t lw_crc32(const uint8_t *bytes, size_t length)
{
	return lw_crc32_add(0, bytes, length);
}

#endif /* LW_CRC32_H */
