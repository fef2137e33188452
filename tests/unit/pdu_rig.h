/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A slave's Modbus functions over the small bank and two small files. Requests and responses live
 * in buffers of exactly their size, so that the address sanitizer sees every access outside.
 */
#ifndef PDU_RIG_H
#define PDU_RIG_H

#include <stdlib.h>

#include <unity.h>

#include "lw/modbus/pdu.h"
#include "small_bank.h"

/** Files 1 (300 records) and 7 (read only, 4 records). */
static uint8_t file_records[2 * 300];
static bool file_is_busy;
static unsigned int file_writes;
static bool is_running;

static inline uint16_t file_record_count(void *context)
{
	return context == NULL ? 4 : 300;
}

static inline void file_read(void *context, uint16_t first, uint16_t count, uint8_t *out)
{
	(void)context;
	memcpy(out, &file_records[2 * first], 2u * count);
}

/* No record may be 0xBAD0. */
static inline int file_allow(void *context, uint16_t first, uint16_t count, const uint8_t *in,
			     struct lw_refusal *why)
{
	(void)context;
	for (uint16_t i = 0; i < count; i++) {
		if (in[2 * i] == 0xBA && in[2 * i + 1] == 0xD0) {
			*why = (struct lw_refusal){.reason = LW_REASON_OUT_OF_RANGE,
						   .address = (uint16_t)(first + i),
						   .value = 0xBAD0};
			return -EINVAL;
		}
	}
	if (file_is_busy) {
		*why = (struct lw_refusal){.reason = LW_REASON_BUSY_TRACKING, .address = first};
		return -EBUSY;
	}
	return 0;
}

static inline void file_write(void *context, uint16_t first, uint16_t count, const uint8_t *in)
{
	(void)context;
	memcpy(&file_records[2 * first], in, 2u * count);
	file_writes++;
}

static inline bool get_is_running(const void *context)
{
	return *(const bool *)context;
}

static const struct lw_pdu_file files[] = {
	{.number = 1,
	 .context = file_records,
	 .record_count = file_record_count,
	 .read = file_read,
	 .allow = file_allow,
	 .write = file_write},
	{.number = 7, .record_count = file_record_count, .read = file_read},
};

static const struct lw_pdu_config config = {
	.bank = &small.bank,
	.device_id = {"vend", "code", "1.2", "url", "name", "model"},
	.files = files,
	.file_count = ARRAY_SIZE(files),
	.server_id = 0x4C,
	.is_running = get_is_running,
	.context = &is_running,
};

static struct lw_pdu pdu;
static uint8_t response[LW_PDU_MAX];
static size_t response_length;

void setUp(void)
{
	small_init();
	memset(file_records, 0, sizeof(file_records));
	file_is_busy = false;
	file_writes = 0;
	is_running = false;
	lw_pdu_init(&pdu, &config);
}

void tearDown(void)
{
}

static inline void ask(const uint8_t *request, size_t length)
{
	uint8_t *exact_request = malloc(length);
	uint8_t *exact_response = malloc(LW_PDU_MAX);

	memcpy(exact_request, request, length);
	memset(exact_response, 0xA5, LW_PDU_MAX); /* of the answer before */
	response_length = lw_pdu_handle(&pdu, exact_request, length, exact_response);
	TEST_ASSERT_LESS_OR_EQUAL(LW_PDU_MAX, response_length);
	memcpy(response, exact_response, response_length);
	free(exact_response);
	free(exact_request);
}

static inline void assert_answer(const uint8_t *request, size_t length, const uint8_t *answer,
				 size_t answer_length)
{
	ask(request, length);
	TEST_ASSERT_EQUAL_UINT(answer_length, response_length);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(answer, response, answer_length);
}

/* Refused with this exception and reason, and nothing has changed. */
static inline void assert_refused(const uint8_t *request, size_t length, uint8_t exception,
				  enum lw_reason reason)
{
	struct small_bank before = small;
	uint8_t records_before[sizeof(file_records)];
	uint32_t exceptions = pdu.counters[LW_BUS_EXCEPTIONS];

	memcpy(records_before, file_records, sizeof(file_records));
	ask(request, length);
	TEST_ASSERT_EQUAL_UINT(2, response_length);
	TEST_ASSERT_EQUAL_HEX8(request[0] | 0x80, response[0]);
	TEST_ASSERT_EQUAL_HEX8(exception, response[1]);
	TEST_ASSERT_EQUAL_UINT16(reason, pdu.last_error.reason);
	TEST_ASSERT_EQUAL_HEX8(request[0], pdu.last_error.function);
	TEST_ASSERT_EQUAL_HEX8(exception, pdu.last_error.exception);
	TEST_ASSERT_EQUAL_UINT32(exceptions + 1, pdu.counters[LW_BUS_EXCEPTIONS]);
	TEST_ASSERT_EQUAL_MEMORY(&before.values, &small.values, sizeof(small.values));
	TEST_ASSERT_EQUAL_MEMORY(before.coils, small.coils, sizeof(small.coils));
	TEST_ASSERT_EQUAL_UINT(before.store_count, small.store_count);
	TEST_ASSERT_EQUAL_MEMORY(records_before, file_records, sizeof(file_records));
}

static inline void assert_error_details(uint16_t address, int32_t value, int32_t limit)
{
	TEST_ASSERT_EQUAL_UINT16(address, pdu.last_error.address);
	TEST_ASSERT_EQUAL_INT32(value, pdu.last_error.value);
	TEST_ASSERT_EQUAL_INT32(limit, pdu.last_error.limit);
}

#define BYTES(...) (const uint8_t[]){__VA_ARGS__}, sizeof((const uint8_t[]){__VA_ARGS__})

#endif /* PDU_RIG_H */
