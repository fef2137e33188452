/* SPDX-License-Identifier: Apache-2.0 */
/* The frame of everything that is stored. */
#include <errno.h>
#include <string.h>

#include <unity.h>

#include "lw/bytes/crc32.h"
#include "lw/storage/record.h"

static const uint8_t golden[] = {'T',  'E', 'S', 'T', 0x12, 0x34, 0,    5,    0x01, 0x02, 0x03,
				 0x04, 'h', 'e', 'l', 'l',  'o',  0x2F, 0xDC, 0x04, 0x5A};
static uint8_t bytes[64];
static struct lw_record record;

void setUp(void)
{
	memset(bytes, 0xA5, sizeof(bytes));
	memcpy(bytes, golden, sizeof(golden));
	record = (struct lw_record){.schema = 77};
}

void tearDown(void)
{
}

static void assert_refused(int expected, size_t size)
{
	TEST_ASSERT_EQUAL_INT(expected, lw_record_open(bytes, size, "TEST", &record));
	TEST_ASSERT_EQUAL_UINT16(77, record.schema);
	TEST_ASSERT_NULL(record.payload);
}

static void test_the_crc_is_that_of_ethernet(void)
{
	TEST_ASSERT_EQUAL_HEX32(0xCBF43926u, lw_crc32((const uint8_t *)"123456789", 9));
	TEST_ASSERT_EQUAL_HEX32(0, lw_crc32(NULL, 0));
}

static void test_a_record_is_sealed_as_the_header_says(void)
{
	memset(bytes, 0xA5, sizeof(bytes));
	memcpy(bytes + LW_RECORD_HEAD_SIZE, "hello", 5);
	TEST_ASSERT_EQUAL_UINT(sizeof(golden),
			       lw_record_seal(bytes, "TEST", 0x1234, 0x01020304, 5));
	TEST_ASSERT_EQUAL_HEX8_ARRAY(golden, bytes, sizeof(golden));
	TEST_ASSERT_EQUAL_HEX8(0xA5, bytes[sizeof(golden)]);
}

static void test_a_record_is_opened_whatever_follows(void)
{
	for (size_t size = sizeof(golden); size <= sizeof(bytes); size++) {
		record = (struct lw_record){0};
		TEST_ASSERT_EQUAL_INT(0, lw_record_open(bytes, size, "TEST", &record));
		TEST_ASSERT_EQUAL_HEX16(0x1234, record.schema);
		TEST_ASSERT_EQUAL_HEX32(0x01020304, record.sequence);
		TEST_ASSERT_EQUAL_UINT(5, record.length);
		TEST_ASSERT_EQUAL_PTR(bytes + LW_RECORD_HEAD_SIZE, record.payload);
	}
}

static void test_an_empty_payload_is_a_record_too(void)
{
	const size_t size = lw_record_seal(bytes, "TEST", 1, 1, 0);

	TEST_ASSERT_EQUAL_UINT(LW_RECORD_OVERHEAD, size);
	TEST_ASSERT_EQUAL_INT(0, lw_record_open(bytes, size, "TEST", &record));
	TEST_ASSERT_EQUAL_UINT(0, record.length);
}

static void test_what_was_never_written_is_told_apart(void)
{
	assert_refused(-ENODATA, 0);
	memset(bytes, 0, sizeof(bytes));
	assert_refused(-ENODATA, sizeof(bytes));
	memset(bytes, 0xFF, sizeof(bytes));
	assert_refused(-ENODATA, sizeof(bytes));
	memset(bytes, 0x55, sizeof(bytes));
	assert_refused(-EBADMSG, sizeof(bytes));
}

static void test_every_cut_and_every_single_bit_flip_is_found(void)
{
	for (size_t size = 1; size < sizeof(golden); size++) {
		assert_refused(-EBADMSG, size);
	}
	for (size_t bit = 0; bit < 8 * sizeof(golden); bit++) {
		bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
		assert_refused(-EBADMSG, sizeof(bytes));
		bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
	}
}

static void test_a_length_beyond_the_slot_is_refused(void)
{
	bytes[6] = 0xFF;
	bytes[7] = 0xFF;
	assert_refused(-EBADMSG, sizeof(bytes));
}

static void test_another_kind_is_no_record(void)
{
	TEST_ASSERT_EQUAL_INT(-EBADMSG, lw_record_open(bytes, sizeof(bytes), "TESS", &record));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_the_crc_is_that_of_ethernet);
	RUN_TEST(test_a_record_is_sealed_as_the_header_says);
	RUN_TEST(test_a_record_is_opened_whatever_follows);
	RUN_TEST(test_an_empty_payload_is_a_record_too);
	RUN_TEST(test_what_was_never_written_is_told_apart);
	RUN_TEST(test_every_cut_and_every_single_bit_flip_is_found);
	RUN_TEST(test_a_length_beyond_the_slot_is_refused);
	RUN_TEST(test_another_kind_is_no_record);
	return UNITY_END();
}
