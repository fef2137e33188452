/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The CRC of Modbus RTU (MODBUS over Serial Line V1.02, 6.2.2): polynomial 0x8005 reflected,
 * start 0xFFFF.
 */
#ifndef LW_CRC16_H
#define LW_CRC16_H

#include <stddef.h>
#include <stdint.h>

/**
 * CRC of `count` bytes. A frame carries it low byte first. May be called from an interrupt.
 *
 * @return 0 over a frame that ends with its correct CRC
 */
uint16_t lw_crc16(const uint8_t *bytes, size_t count);

#endif /* LW_CRC16_H */
