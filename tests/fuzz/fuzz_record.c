/*
 * What a storage may hold, at power-up: only what the controller itself could have written is used.
 * The first byte of the input says what follows: 0 the record itself, 1 changes of a good one.
 */
#include <errno.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "judge.h"
#include "lw/record.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void decode(const uint8_t *record, size_t size)
{
	uint8_t again[LW_RECORD_SIZE];
	struct lw_params params;
	struct lw_params untouched;
	int ret;

	memset(&params, 0x5A, sizeof(params));
	untouched = params;
	ret = lw_record_decode(record, size, &params);
	if (ret == 0) {
		judge_limits(&params);
		lw_record_encode(&params, again);
		judge_require(size == LW_RECORD_SIZE && memcmp(again, record, size) == 0,
			      "a record that nobody has written is taken", record, size);
	} else {
		judge_require(ret == -EBADMSG || ret == -ENOTSUP, "error of a record", record,
			      size);
		judge_require(memcmp(&params, &untouched, sizeof(params)) == 0,
			      "a refused record leaves something", record, size);
	}
}

static void power_up(const uint8_t *record, size_t size)
{
	static struct judge judge;
	const struct lw_world_config config = {.seed = 1, .record = record, .record_length = size};
	const struct lw_device *device = &judge.world.device;
	struct lw_derived derived;
	struct lw_refusal why;

	judge.line_us = 0;
	judge_require(lw_world_init(&judge.world, &config, 0) == 0, "no power-up", record, size);
	judge_require(lw_params_derive(&device->active, &derived, &why) == 0,
		      "a set that does not hold is active", record, size);
	judge_require(!device->defaults_loaded || memcmp(&device->active, &lw_params_default,
							 sizeof(lw_params_default)) == 0,
		      "neither the record nor the defaults", record, size);
	judge_require(!device->controller.indexed, "indexed at power-up", record, size);
	judge_run_ms(&judge, 2);
	judge_alive(&judge);
}

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

/* The record of the factory set, cut short and with bytes changed as the input says: a number of
 * bytes to cut off, then offset (two bytes) and value. With the CRC that it then should have, which
 * a fuzzer would not find, and with the one that it had.
 */
static void changed_record(const uint8_t *data, size_t size)
{
	uint8_t record[LW_RECORD_SIZE];
	size_t length = sizeof(record);
	uint32_t crc;

	lw_record_encode(&lw_params_default, record);
	if (size > 0) {
		length -= data[0] % (sizeof(record) - 4);
		data++;
		size--;
	}
	for (; size >= 3; data += 3, size -= 3) {
		record[((size_t)data[0] << 8 | data[1]) % sizeof(record)] = data[2];
	}
	decode(record, length);
	power_up(record, length);
	crc = crc32(record, length - 4);
	for (size_t i = 0; i < 4; i++) {
		record[length - 4 + i] = (uint8_t)(crc >> (8 * i));
	}
	decode(record, length);
	power_up(record, length);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	if (size > 0 && data[0] == 1) {
		changed_record(data + 1, size - 1);
	} else if (size > 0) {
		decode(data + 1, size - 1);
		power_up(data + 1, size - 1);
	}
	return 0;
}
