/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/storage/record.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

#include "lw/bytes/big_endian.h"
#include "lw/bytes/crc32.h"
#include "lw/bytes/require.h"

#define KIND_SIZE 4

size_t lw_record_seal(uint8_t *bytes, const char *kind, uint16_t schema, uint32_t sequence,
		      size_t length)
{
	LW_REQUIRE(length <= UINT16_MAX);
	uint8_t *at = bytes;

	memcpy(at, kind, KIND_SIZE);
	at = lw_put16(at + KIND_SIZE, schema);
	at = lw_put16(at, (uint16_t)length);
	(void)lw_put32(at, sequence);
	(void)lw_put32(bytes + LW_RECORD_HEAD_SIZE + length,
		       lw_crc32(bytes, LW_RECORD_HEAD_SIZE + length));
	return length + LW_RECORD_OVERHEAD;
}

static bool erased(const uint8_t *bytes, size_t size)
{
	/*@
	  loop invariant 0 <= i <= size;
	  loop assigns i;
	  loop variant size - i;
	*/
	for (size_t i = 0; i < size; i++) {
		if (bytes[i] != bytes[0]) {
			return false;
		}
	}
	return size == 0 || bytes[0] == 0x00 || bytes[0] == 0xFF;
}

int lw_record_open(const uint8_t *bytes, size_t size, const char *kind, struct lw_record *record)
{
	size_t length;

	if (erased(bytes, size)) {
		return -ENODATA;
	}
	if (size < LW_RECORD_OVERHEAD || memcmp(bytes, kind, KIND_SIZE) != 0) {
		return -EBADMSG;
	}
	length = lw_get16(bytes + KIND_SIZE + 2);
	if (length > size - LW_RECORD_OVERHEAD ||
	    lw_crc32(bytes, LW_RECORD_HEAD_SIZE + length) !=
		    lw_get32(bytes + LW_RECORD_HEAD_SIZE + length)) {
		return -EBADMSG;
	}
	*record = (struct lw_record){
		.schema = lw_get16(bytes + KIND_SIZE),
		.sequence = lw_get32(bytes + KIND_SIZE + 4),
		.payload = bytes + LW_RECORD_HEAD_SIZE,
		.length = length,
	};
	return 0;
}
