/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * How anything is stored: bytes with a kind, a schema, a sequence number and a CRC, the same on
 * every host. Not for interrupt context.
 *
 *     kind (4 characters), schema (16 bit), bytes of the payload (16 bit), sequence (32 bit),
 *     payload, CRC-32 of all before; high byte first
 *
 * This frame stays as it is in every schema, so that a record of newer firmware can be told from a
 * damaged one. What follows in a slot behind the CRC does not matter.
 */
#ifndef LW_RECORD_H
#define LW_RECORD_H

#include <stddef.h>
#include <stdint.h>

/** Bytes before the payload. */
#define LW_RECORD_HEAD_SIZE 12

/** Bytes of a record besides its payload. */
#define LW_RECORD_OVERHEAD (LW_RECORD_HEAD_SIZE + 4)

/** A record that has been opened. */
struct lw_record {
	uint16_t schema;
	uint32_t sequence;
	const uint8_t *payload;
	size_t length; /**< bytes of the payload */
};

/**
 * Put head and CRC around a payload that stands at `bytes + LW_RECORD_HEAD_SIZE` already.
 *
 * @param kind 4 characters
 * @param length bytes of the payload, up to 65535
 * @return bytes of the record
 */
size_t lw_record_seal(uint8_t *bytes, const char *kind, uint16_t schema, uint32_t sequence,
		      size_t length);

/**
 * Open a record.
 *
 * @param kind 4 characters
 * @param size bytes that can be read
 * @param record receives head and payload, which points into `bytes`; unchanged on any error
 * @retval 0 intact
 * @retval -ENODATA nothing there: no bytes, all 0x00 or all 0xFF
 * @retval -EBADMSG not a record of this kind, cut short, or damaged
 */
int lw_record_open(const uint8_t *bytes, size_t size, const char *kind, struct lw_record *record);

#endif /* LW_RECORD_H */
