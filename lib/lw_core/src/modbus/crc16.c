/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/modbus/crc16.h"

uint16_t lw_crc16(const uint8_t *bytes, size_t count)
{
	/* Four bits at a time: the table is the CRC of each value of a nibble. */
	static const uint16_t nibble_crc[16] = {
		0x0000, 0xCC01, 0xD801, 0x1400, 0xF001, 0x3C00, 0x2800, 0xE401,
		0xA001, 0x6C00, 0x7800, 0xB401, 0x5000, 0x9C01, 0x8801, 0x4400,
	};
	uint16_t crc = 0xFFFF;

	/*@
	  loop invariant 0 <= i <= count;
	  loop assigns i, crc;
	  loop variant count - i;
	*/
	for (size_t i = 0; i < count; i++) {
		crc ^= bytes[i];
		crc = (uint16_t)((crc >> 4) ^ nibble_crc[crc & 0xFu]);
		crc = (uint16_t)((crc >> 4) ^ nibble_crc[crc & 0xFu]);
	}
	return crc;
}
