/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What a storage may hold, at power-up: only what the controller itself could have written is used.
 * The first byte of the input says what follows: 0 what a slot of the parameters holds, 1 what a
 * slot of the journal holds, 2 and 3 changes of a good record there.
 */
#include <errno.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "judge.h"
#include "lw/storage/param_record.h"

/** What the storage holds. */
struct content {
	unsigned int slot;
	const uint8_t *bytes;
	size_t size;
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void decode(const uint8_t *bytes, size_t size)
{
	uint8_t again[LW_PARAM_RECORD_SIZE];
	struct lw_record record;
	struct lw_params params;
	struct lw_params untouched;
	struct lw_params back;
	int ret;

	memset(&params, 0x5A, sizeof(params));
	untouched = params;
	ret = lw_param_record_decode(bytes, size, &params, &record);
	if (ret == 0) {
		judge_limits(&params);
		(void)lw_param_record_encode(&params, record.sequence, again);
		judge_require(lw_param_record_decode(again, sizeof(again), &back, &record) == 0 &&
				      memcmp(&params, &back, sizeof(back)) == 0,
			      "a set that cannot be stored again", bytes, size);
	} else {
		judge_require(ret == -ENODATA || ret == -EBADMSG || ret == -ENOTSUP ||
				      ret == -EINVAL,
			      "error of a record", bytes, size);
		judge_require(memcmp(&params, &untouched, sizeof(params)) == 0,
			      "a refused record leaves something", bytes, size);
	}
}

static size_t read_slot(void *context, unsigned int slot, uint8_t *bytes, size_t size)
{
	const struct content *content = context;
	const size_t length = content->size < size ? content->size : size;

	if (slot != content->slot) {
		return 0;
	}
	memcpy(bytes, content->bytes, length);
	return length;
}

static void power_up(struct content content)
{
	static struct judge judge;
	const struct lw_world_config config = {
		.seed = 1, .context = &content, .read_slot = read_slot};
	const struct lw_device *device = &judge.world.device;
	const struct lw_store *store = &judge.world.store;
	struct lw_derived derived;
	struct lw_refusal why;

	judge.line_us = 0;
	judge_require(lw_world_init(&judge.world, &config, 0) == 0, "no power-up", content.bytes,
		      content.size);
	judge_require(lw_params_derive(&device->active, &derived, &why) == 0,
		      "a set that does not hold is active", content.bytes, content.size);
	judge_require(lw_store_has_params(store) || memcmp(&device->active, &lw_params_default,
							   sizeof(lw_params_default)) == 0,
		      "neither the record nor the defaults", content.bytes, content.size);
	judge_require(!device->controller.indexed, "indexed at power-up", content.bytes,
		      content.size);
	for (uint32_t i = 0; i < LW_LOG_RECORDS; i++) {
		judge_require(store->log.records[i].sequence % LW_LOG_RECORDS == i ||
				      store->log.records[i].sequence == 0,
			      "an event out of its place", content.bytes, content.size);
	}
	judge_run_ms(&judge, 2);
	judge_alive(&judge);
}

static void look_at(unsigned int slot, const uint8_t *bytes, size_t size)
{
	if (slot == LW_STORE_PARAMS) {
		decode(bytes, size);
	}
	power_up((struct content){.slot = slot, .bytes = bytes, .size = size});
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

/** A good record. @return its bytes */
static size_t good_record(unsigned int slot, uint8_t bytes[LW_STORE_SLOT_SIZE])
{
	static struct lw_store store;
	unsigned int written;

	lw_store_init(&store);
	if (slot == LW_STORE_PARAMS) {
		lw_store_save(&store, &lw_params_default);
	} else {
		for (uint16_t event = 1; event <= 5; event++) {
			lw_log_add(&store.log, (struct lw_log_record){.event = event});
		}
		store.journal_wanted = true;
	}
	return lw_store_begin_write(&store, &written, bytes);
}

/* A good record, cut short and with bytes changed as the input says: a number of bytes to cut off,
 * then offset (two bytes) and value. With the CRC that it then should have, which a fuzzer would
 * not find, and with the one that it had.
 */
static void changed_record(unsigned int slot, const uint8_t *data, size_t size)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	size_t length = good_record(slot, bytes);
	size_t end;
	uint32_t crc;

	if (size > 0) {
		length -= data[0] % (length - LW_RECORD_OVERHEAD);
		data++;
		size--;
	}
	for (; size >= 3; data += 3, size -= 3) {
		bytes[((size_t)data[0] << 8 | data[1]) % length] = data[2];
	}
	look_at(slot, bytes, length);
	end = LW_RECORD_HEAD_SIZE + ((size_t)bytes[6] << 8 | bytes[7]);
	if (end + 4 > length) {
		/* The length is that of what is left. */
		end = length - 4;
		bytes[6] = (uint8_t)((end - LW_RECORD_HEAD_SIZE) >> 8);
		bytes[7] = (uint8_t)(end - LW_RECORD_HEAD_SIZE);
	}
	crc = crc32(bytes, end);
	for (size_t i = 0; i < 4; i++) {
		bytes[end + i] = (uint8_t)(crc >> (24 - 8 * i));
	}
	look_at(slot, bytes, length);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	unsigned int slot;

	if (size == 0) {
		return 0;
	}
	slot = data[0] & 1 ? LW_STORE_JOURNAL : LW_STORE_PARAMS;
	if (data[0] & 2) {
		changed_record(slot, data + 1, size - 1);
	} else {
		look_at(slot, data + 1, size - 1);
	}
	return 0;
}
