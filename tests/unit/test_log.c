/* SPDX-License-Identifier: Apache-2.0 */
/* The event log. */
#include <errno.h>

#include <unity.h>

#include "lw/storage/log.h"

static struct lw_log event_log;

void setUp(void)
{
	event_log = (struct lw_log){0};
}

void tearDown(void)
{
}

static void add(uint16_t event)
{
	lw_log_add(&event_log, (struct lw_log_record){.event = event});
}

static void test_an_empty_log_has_empty_records(void)
{
	struct lw_log_record record;

	TEST_ASSERT_EQUAL_UINT16(0, lw_log_count(&event_log));
	for (uint16_t i = 0; i < LW_LOG_RECORDS; i++) {
		TEST_ASSERT_EQUAL_INT(0, lw_log_read(&event_log, i, &record));
		TEST_ASSERT_EQUAL_UINT32(0, record.sequence);
	}
}

static void test_the_oldest_record_gives_way(void)
{
	struct lw_log_record record;

	for (uint16_t event = 1; event <= 3 * LW_LOG_RECORDS + 5; event++) {
		add(event);
		TEST_ASSERT_EQUAL_UINT32(event, event_log.newest);
		TEST_ASSERT_EQUAL_UINT16(event < LW_LOG_RECORDS ? event : LW_LOG_RECORDS,
					 lw_log_count(&event_log));
	}
	for (uint32_t kept = 0; kept < LW_LOG_RECORDS; kept++) {
		const uint32_t sequence = event_log.newest - kept;

		TEST_ASSERT_EQUAL_INT(
			0, lw_log_read(&event_log, (uint16_t)(sequence % LW_LOG_RECORDS), &record));
		TEST_ASSERT_EQUAL_UINT32(sequence, record.sequence);
		TEST_ASSERT_EQUAL_UINT16(sequence, record.event);
	}
}

static void test_an_index_beyond_the_end_is_refused(void)
{
	struct lw_log_record record = {.detail = 7};

	TEST_ASSERT_EQUAL_INT(-ENXIO, lw_log_read(&event_log, LW_LOG_RECORDS, &record));
	TEST_ASSERT_EQUAL_INT(-ENXIO, lw_log_read(&event_log, UINT16_MAX, &record));
	TEST_ASSERT_EQUAL_INT32(7, record.detail);
}

static void test_the_bytes_are_registers_high_word_first(void)
{
	static const uint8_t expected[LW_LOG_RECORD_SIZE] = {
		0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08, 0x09, 0x0A, 0x0B,
		0x0C, 0x0D, 0x0E, 0x0F, 0x10, 0xFF, 0xFF, 0xFF, 0xFE, 0xFF, 0xFE,
		0xCB, 0x68, 0xFF, 0xFF, 0xFF, 0xF0, 0x00, 0x00, 0x00, 0x03};
	const struct lw_log_record record = {
		.sequence = 0x01020304,
		.boot = 0x05060708,
		.time_ms = 0x090A0B0C,
		.event = 0x0D0E,
		.state = 0x0F10,
		.detail = -2,
		.position_um = -79000,
		.net_edges = -0xFFFFFFFFDLL,
	};
	uint8_t bytes[LW_LOG_RECORD_SIZE];
	struct lw_log_record back;

	lw_log_encode(&record, bytes);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, sizeof(expected));
	back = lw_log_decode(bytes);
	TEST_ASSERT_EQUAL_MEMORY(&record, &back, sizeof(record));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_an_empty_log_has_empty_records);
	RUN_TEST(test_the_oldest_record_gives_way);
	RUN_TEST(test_an_index_beyond_the_end_is_refused);
	RUN_TEST(test_the_bytes_are_registers_high_word_first);
	return UNITY_END();
}
