#include "lw/record.h"

#include <errno.h>
#include <string.h>

#include "lw/bank.h"

static const uint8_t magic[4] = {'L', 'W', 'P', 'S'};

/** CRC-32 as in Ethernet and zip (reflected polynomial 0xEDB88320). */
static uint32_t crc32(const uint8_t *bytes, size_t length)
{
	uint32_t crc = 0xFFFFFFFFu;

	for (size_t i = 0; i < length; i++) {
		crc ^= bytes[i];
		for (int bit = 0; bit < 8; bit++) {
			crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
		}
	}
	return ~crc;
}

static uint8_t *put16(uint8_t *at, uint16_t value)
{
	at[0] = (uint8_t)value;
	at[1] = (uint8_t)(value >> 8);
	return at + 2;
}

static uint8_t *put32(uint8_t *at, uint32_t value)
{
	return put16(put16(at, (uint16_t)value), (uint16_t)(value >> 16));
}

static uint16_t get16(const uint8_t *at)
{
	return (uint16_t)(at[0] | at[1] << 8);
}

static uint32_t get32(const uint8_t *at)
{
	return get16(at) | (uint32_t)get16(at + 2) << 16;
}

void lw_record_encode(const struct lw_params *params, uint8_t record[LW_RECORD_SIZE])
{
	uint8_t *at = record;

	memcpy(at, magic, sizeof(magic));
	at = put16(at + sizeof(magic), LW_MAP_VERSION);
	at = put16(at, LW_MAP_PARAMS_COUNT);
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		uint32_t value;

		/* All members are 32 bit wide, signed or not. */
		memcpy(&value, (const char *)params + lw_map_params[i].offset, sizeof(value));
		at = put32(at, value);
	}
	put32(at, crc32(record, LW_RECORD_SIZE - 4));
}

int lw_record_decode(const uint8_t *record, size_t length, struct lw_params *params)
{
	struct lw_params result;
	int32_t limit;

	if (length < sizeof(magic) + 4 || memcmp(record, magic, sizeof(magic)) != 0) {
		return -EBADMSG;
	}
	if (length != LW_RECORD_SIZE ||
	    crc32(record, LW_RECORD_SIZE - 4) != get32(record + LW_RECORD_SIZE - 4)) {
		return get16(record + 4) == LW_MAP_VERSION ? -EBADMSG : -ENOTSUP;
	}
	if (get16(record + 4) != LW_MAP_VERSION || get16(record + 6) != LW_MAP_PARAMS_COUNT) {
		return -ENOTSUP;
	}
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		const uint32_t value = get32(record + 8 + 4 * i);

		if (!lw_point_allows(&lw_map_params[i],
				     lw_map_params[i].type == LW_TYPE_U32 ? (int64_t)value
									  : (int32_t)value,
				     &limit)) {
			return -EBADMSG;
		}
		memcpy((char *)&result + lw_map_params[i].offset, &value, sizeof(value));
	}
	*params = result;
	return 0;
}
