/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Numbers to bytes and back, high byte first, as on the Modbus line.
 */
#ifndef LW_BIG_ENDIAN_H
#define LW_BIG_ENDIAN_H

#include <stdint.h>

/** @return where the next value goes */
static inline uint8_t *lw_put16(uint8_t *at, uint16_t value)
{
	at[0] = (uint8_t)(value >> 8);
	at[1] = (uint8_t)value;
	return at + 2;
}

/** @return where the next value goes */
static inline uint8_t *lw_put32(uint8_t *at, uint32_t value)
{
	return lw_put16(lw_put16(at, (uint16_t)(value >> 16)), (uint16_t)value);
}

static inline uint16_t lw_get16(const uint8_t *at)
{
	return (uint16_t)(at[0] << 8 | at[1]);
}

static inline uint32_t lw_get32(const uint8_t *at)
{
	return (uint32_t)lw_get16(at) << 16 | lw_get16(at + 2);
}

#endif /* LW_BIG_ENDIAN_H */
