#include "lw/record.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

#include "big_endian.h"

#define KIND_SIZE 4

uint32_t lw_crc32(const uint8_t *bytes, size_t length)
{
	/* The polynomial times every half byte: a compromise between size and time. */
	static const uint32_t table[16] = {0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu,
					   0x76DC4190u, 0x6B6B51F4u, 0x4DB26158u, 0x5005713Cu,
					   0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u, 0xCB61B38Cu,
					   0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu};
	uint32_t crc = 0xFFFFFFFFu;

	/*@
	  loop invariant 0 <= i <= length;
	  loop assigns i, crc;
	  loop variant length - i;
	*/
	for (size_t i = 0; i < length; i++) {
		crc ^= bytes[i];
		crc = table[crc & 0xFu] ^ crc >> 4;
		crc = table[crc & 0xFu] ^ crc >> 4;
	}
	return ~crc;
}

size_t lw_record_seal(uint8_t *bytes, const char *kind, uint16_t schema, uint32_t sequence,
		      size_t length)
{
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
