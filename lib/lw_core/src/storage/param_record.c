/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/storage/param_record.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

#include "lw/bytes/big_endian.h"
#include "lw/bytes/crc32.h"
#include "lw/modbus/bank.h"

#define ENTRY_SIZE 6

static const char kind[] = "LWPR";

/* Schema 1. */
static const char kind_1[] = "LWPS";
static const uint16_t addresses_1[] = {
	100, 101, 102, 103, 104, 105, 106, 107, 110, 112, 113, 114, 116, 118, 120, 122, 124,
	126, 128, 130, 132, 133, 134, 135, 136, 137, 140, 141, 142, 143, 145, 146, 147, 148,
	149, 151, 152, 160, 161, 163, 165, 166, 167, 170, 171, 172, 173, 174, 180, 181, 183};

enum {
	COUNT_1 = sizeof(addresses_1) / sizeof(addresses_1[0]),
	SIZE_1 = 8 + 4 * COUNT_1 + 4,
};

size_t lw_param_record_encode(const struct lw_params *params, uint32_t sequence,
			      uint8_t bytes[LW_PARAM_RECORD_SIZE])
{
	uint8_t *at = bytes + LW_RECORD_HEAD_SIZE;

	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		uint32_t value;

		/* All members are 32 bit wide, signed or not. */
		memcpy(&value, (const char *)params + lw_map_params[i].offset, sizeof(value));
		at = lw_put32(lw_put16(at, lw_map_params[i].address), value);
	}
	return lw_record_seal(bytes, kind, LW_PARAM_RECORD_SCHEMA, sequence,
			      ENTRY_SIZE * LW_MAP_PARAMS_COUNT);
}

/**
 * Take one value of a record into a set.
 *
 * @param next index of the first parameter that may follow; addresses must rise
 */
static int take(struct lw_params *params, size_t *next, uint16_t address, uint32_t value)
{
	const struct lw_point *point;
	int32_t limit;

	/*@
	  loop invariant *next <= LW_MAP_PARAMS_COUNT;
	  loop assigns *next;
	  loop variant LW_MAP_PARAMS_COUNT - *next;
	*/
	while (*next < LW_MAP_PARAMS_COUNT && lw_map_params[*next].address < address) {
		(*next)++;
	}
	if (*next == LW_MAP_PARAMS_COUNT || lw_map_params[*next].address != address) {
		return -ENOTSUP;
	}
	point = &lw_map_params[(*next)++];
	if (!lw_point_allows(point, point->type == LW_TYPE_U32 ? (int64_t)value : (int32_t)value,
			     &limit)) {
		return -EINVAL;
	}
	memcpy((char *)params + point->offset, &value, sizeof(value));
	return 0;
}

static uint32_t get32_1(const uint8_t *at)
{
	return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static bool is_schema_1(const uint8_t *bytes, size_t size)
{
	static const char head[] = {1, 0, COUNT_1, 0};

	return size >= SIZE_1 && memcmp(bytes, kind_1, 4) == 0 &&
	       memcmp(bytes + 4, head, sizeof(head)) == 0 &&
	       lw_crc32(bytes, SIZE_1 - 4) == get32_1(bytes + SIZE_1 - 4);
}

static int decode_1(const uint8_t *bytes, struct lw_params *params)
{
	size_t next = 0;
	int ret = 0;

	/*@
	  loop invariant 0 <= i <= COUNT_1 && next <= LW_MAP_PARAMS_COUNT;
	  loop assigns i, ret, next, *params;
	  loop variant COUNT_1 - i;
	*/
	for (size_t i = 0; i < COUNT_1 && ret == 0; i++) {
		ret = take(params, &next, addresses_1[i], get32_1(bytes + 8 + 4 * i));
	}
	return ret;
}

static int decode_2(const struct lw_record *record, struct lw_params *params)
{
	uint16_t last = 0;
	size_t next = 0;
	int ret = record->length % ENTRY_SIZE == 0 ? 0 : -EINVAL;

	/*@
	  loop invariant 0 <= at && next <= LW_MAP_PARAMS_COUNT;
	  loop invariant ret == 0 ==> at <= record->length;
	  loop invariant ret == 0 ==> (record->length - at) % ENTRY_SIZE == 0;
	  loop assigns at, ret, next, last, *params;
	  loop variant record->length - at;
	*/
	for (size_t at = 0; at < record->length && ret == 0; at += ENTRY_SIZE) {
		const uint16_t address = lw_get16(record->payload + at);

		ret = address <= last
			      ? -EINVAL
			      : take(params, &next, address, lw_get32(record->payload + at + 2));
		last = address;
	}
	return ret;
}

int lw_param_record_decode(const uint8_t *bytes, size_t size, struct lw_params *params,
			   struct lw_record *record)
{
	struct lw_params result = lw_params_default;
	int ret;

	if (is_schema_1(bytes, size)) {
		*record = (struct lw_record){.schema = 1};
		ret = decode_1(bytes, &result);
	} else {
		ret = lw_record_open(bytes, size, kind, record);
		if (ret == 0) {
			ret = record->schema == LW_PARAM_RECORD_SCHEMA ? decode_2(record, &result)
								       : -ENOTSUP;
		}
	}
	if (ret == 0) {
		*params = result;
	}
	return ret;
}
