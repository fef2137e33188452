/* SPDX-License-Identifier: Apache-2.0 */
/* The register bank: whole requests, all or nothing. */
#include <stdbool.h>
#include <stdio.h>

#include <unity.h>

#include "lw/modbus/bank.h"
#include "small_bank.h"

static struct lw_refusal why;
static uint8_t bytes[512];

void setUp(void)
{
	small_init();
	memset(&why, 0xAA, sizeof(why));
	memset(bytes, 0xAA, sizeof(bytes));
}

void tearDown(void)
{
}

static int write_words(uint16_t address, const uint16_t *words, uint16_t count)
{
	uint8_t in[2 * 200];

	for (uint16_t i = 0; i < count; i++) {
		in[2 * i] = (uint8_t)(words[i] >> 8);
		in[2 * i + 1] = (uint8_t)words[i];
	}
	return lw_bank_write_registers(&small.bank, address, count, in, &why);
}

#define WRITE(address, ...)                                                                        \
	write_words(address, (const uint16_t[]){__VA_ARGS__},                                      \
		    ARRAY_SIZE(((uint16_t[]){__VA_ARGS__})))

static void assert_refused(uint16_t reason, uint16_t address, int32_t value, int32_t limit)
{
	TEST_ASSERT_EQUAL_UINT16(reason, why.reason);
	TEST_ASSERT_EQUAL_UINT16(address, why.address);
	TEST_ASSERT_EQUAL_INT32(value, why.value);
	TEST_ASSERT_EQUAL_INT32(limit, why.limit);
	TEST_ASSERT_EQUAL_UINT(0, small.store_count);
}

static void test_read_is_big_endian_high_word_first(void)
{
	static const uint8_t expected[] = {0,    5,    0xFF, 0xFE, 0x12, 0x34, 0x56, 0x78,
					   0xFF, 0xFF, 0xFF, 0xFD, 0,    1,    0xC2, 0};

	small.values.command = 5;
	small.values.level = -2;
	small.values.speed = 0x12345678;
	small.values.place = -3;
	small.values.baud = 115200;
	TEST_ASSERT_EQUAL_INT(
		0, lw_bank_read_registers(&small.bank, LW_SPACE_HOLDING, 0, 8, bytes, &why));
	TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, sizeof(expected));
	TEST_ASSERT_EQUAL_HEX8(0xAA, bytes[sizeof(expected)]);
	TEST_ASSERT_EQUAL_UINT(1, small.image_count);
}

static void test_read_of_half_a_value_and_of_64_bits(void)
{
	static const uint8_t expected[] = {0x89, 0xAB, 0xCD, 0xEF, 0, 1};

	small.values.count = -0x7654321076543210; /* 0x89ABCDEF89ABCDF0 */
	TEST_ASSERT_EQUAL_INT(
		0, lw_bank_read_registers(&small.bank, LW_SPACE_INPUT, 1030, 2, bytes, &why));
	TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, 4);
	TEST_ASSERT_EQUAL_INT(
		0, lw_bank_read_registers(&small.bank, LW_SPACE_INPUT, 1033, 1, bytes, &why));
	TEST_ASSERT_EQUAL_HEX8(0xCD, bytes[0]);
	TEST_ASSERT_EQUAL_HEX8(0xF0, bytes[1]);
	small.values.wide = 0xFFFF0001;
	TEST_ASSERT_EQUAL_INT(
		0, lw_bank_read_registers(&small.bank, LW_SPACE_HOLDING, 21, 1, bytes, &why));
	TEST_ASSERT_EQUAL_HEX8_ARRAY(&expected[4], bytes, 2);
}

static void test_read_spans_sections_that_join(void)
{
	static const uint8_t expected[] = {0x11, 0x22, 0x33, 0x44};

	small.values.array[199] = 0x1122;
	small.values.next = 0x3344;
	TEST_ASSERT_EQUAL_INT(
		0, lw_bank_read_registers(&small.bank, LW_SPACE_HOLDING, 299, 2, bytes, &why));
	TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, 4);
	TEST_ASSERT_EQUAL_UINT(2, small.image_count);
}

static void test_read_of_a_range_with_a_hole_names_the_first_missing_address(void)
{
	static const struct {
		enum lw_space space;
		uint16_t address;
		uint16_t count;
		uint16_t missing;
	} cases[] = {
		{LW_SPACE_HOLDING, 10, 2, 11},       {LW_SPACE_HOLDING, 19, 3, 19},
		{LW_SPACE_HOLDING, 299, 3, 301},     {LW_SPACE_HOLDING, 1000, 1, 1000},
		{LW_SPACE_INPUT, 0, 1, 0},           {LW_SPACE_INPUT, 999, 2, 999},
		{LW_SPACE_HOLDING, 65533, 1, 65533}, {LW_SPACE_HOLDING, 65534, 3, LW_NO_ADDRESS},
		{LW_SPACE_HOLDING, 34, 1, 34},       {LW_SPACE_DISCRETE, 2016, 1, 2016},
	};

	for (unsigned int i = 0; i < ARRAY_SIZE(cases); i++) {
		int error = lw_bank_read_registers(&small.bank, cases[i].space, cases[i].address,
						   cases[i].count, bytes, &why);

		TEST_ASSERT_EQUAL_INT(-ENXIO, error);
		assert_refused(LW_REASON_UNKNOWN_ADDRESS, cases[i].missing, 0, 0);
		TEST_ASSERT_EQUAL_HEX8(0xAA, bytes[0]);
	}
	TEST_ASSERT_EQUAL_UINT(0, small.image_count);
}

static void test_read_up_to_the_last_address(void)
{
	small.values.last = 7;
	TEST_ASSERT_EQUAL_INT(
		0, lw_bank_read_registers(&small.bank, LW_SPACE_HOLDING, 65534, 2, bytes, &why));
	TEST_ASSERT_EQUAL_HEX8(7, bytes[3]);
}

static void test_write_stores_every_type_in_ascending_order_and_commands_last(void)
{
	static const uint16_t order[] = {1, 2, 4, 6, 8, 0};

	TEST_ASSERT_EQUAL_INT(0, WRITE(0, 3, 0xFF9C, 1, 0x86A0, 0xFFF8, 0x5EE0, 1, 0xC200, 4));
	TEST_ASSERT_EQUAL_INT32(3, small.values.command);
	TEST_ASSERT_EQUAL_INT32(-100, small.values.level);
	TEST_ASSERT_EQUAL_UINT32(100000, small.values.speed);
	TEST_ASSERT_EQUAL_INT32(-500000, small.values.place);
	TEST_ASSERT_EQUAL_UINT32(115200, small.values.baud);
	TEST_ASSERT_EQUAL_INT32(4, small.values.gear);
	TEST_ASSERT_EQUAL_UINT(6, small.store_count);
	TEST_ASSERT_EQUAL_UINT16_ARRAY(order, small.stored_addresses, 6);
}

static void test_write_of_an_array_over_two_sections(void)
{
	TEST_ASSERT_EQUAL_INT(0, WRITE(298, 1, 0xFFFF, 3));
	TEST_ASSERT_EQUAL_INT32(1, small.values.array[198]);
	TEST_ASSERT_EQUAL_INT32(65535, small.values.array[199]);
	TEST_ASSERT_EQUAL_INT32(3, small.values.next);
}

static void test_write_refuses_what_is_not_writable(void)
{
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(8, 1, 1, 1));
	assert_refused(LW_REASON_NOT_WRITABLE, 9, 0, 0);
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(400, 1));
	assert_refused(LW_REASON_NOT_WRITABLE, 400, 0, 0);
	small.sections[0].allow = NULL;
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(1, 1));
	assert_refused(LW_REASON_NOT_WRITABLE, 1, 0, 0);
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(30, 0, 0, 0, 0));
	assert_refused(LW_REASON_NOT_WRITABLE, 30, 0, 0);
	small.sections[0].allow = small_allow;
	small.sections[0].store = NULL;
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(1, 1));
	assert_refused(LW_REASON_NOT_WRITABLE, 1, 0, 0);
}

static void test_write_refuses_half_of_a_pair(void)
{
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(2, 1));
	assert_refused(LW_REASON_HALF_OF_PAIR, 2, 0, 0);
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(3, 1));
	assert_refused(LW_REASON_HALF_OF_PAIR, 3, 0, 0);
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(3, 1, 2));
	assert_refused(LW_REASON_HALF_OF_PAIR, 3, 0, 0);
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(1, 1, 0, 10, 0));
	assert_refused(LW_REASON_HALF_OF_PAIR, 4, 0, 0);
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(65535, 1));
	assert_refused(LW_REASON_HALF_OF_PAIR, 65535, 0, 0);
}

static void test_address_errors_come_before_value_errors(void)
{
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(8, 99, 0));
	assert_refused(LW_REASON_NOT_WRITABLE, 9, 0, 0);
	TEST_ASSERT_EQUAL_INT(-ENXIO, WRITE(10, 99, 0));
	assert_refused(LW_REASON_UNKNOWN_ADDRESS, 11, 0, 0);
}

static void test_values_are_checked_at_each_limit(void)
{
	static const struct {
		uint16_t address;
		uint16_t words[2];
		uint16_t count;
		bool is_good;
		int32_t value;
		int32_t limit;
	} cases[] = {
		{1, {100}, 1, true, 0, 0},
		{1, {101}, 1, false, 101, 100},
		{1, {0xFF9C}, 1, true, 0, 0},
		{1, {0xFF9B}, 1, false, -101, -100},
		{2, {0, 10}, 2, true, 0, 0},
		{2, {0, 9}, 2, false, 9, 10},
		{2, {1, 0x86A0}, 2, true, 0, 0},
		{2, {1, 0x86A1}, 2, false, 100001, 100000},
		{2, {0xFFFF, 0xFFF0}, 2, false, -16, 100000},
		{4, {7, 0xA120}, 2, true, 0, 0},
		{4, {7, 0xA121}, 2, false, 500001, 500000},
		{4, {0xFFF8, 0x5EE0}, 2, true, 0, 0},
		{4, {0xFFF8, 0x5EDF}, 2, false, -500001, -500000},
		{4, {0x8000, 0}, 2, false, INT32_MIN, -500000},
		{6, {0, 1200}, 2, true, 0, 0},
		{6, {0, 0}, 2, false, 0, 1200},
		{6, {0, 5400}, 2, false, 5400, 1200},
		{6, {0, 5401}, 2, false, 5401, 9600},
		{6, {0xFFFF, 0xFFFF}, 2, false, -1, 115200},
		{8, {4}, 1, true, 0, 0},
		{8, {3}, 1, false, 3, 2},
		{8, {65535}, 1, false, 65535, 4},
		{20, {0x7FFF, 0xFFFF}, 2, true, 0, 0},
		{20, {0x8000, 0}, 2, false, INT32_MIN, INT32_MAX},
		{100, {65535}, 1, true, 0, 0},
	};

	for (unsigned int i = 0; i < ARRAY_SIZE(cases); i++) {
		char message[16];
		int error;

		small_init();
		snprintf(message, sizeof(message), "case %u", i);
		error = write_words(cases[i].address, cases[i].words, cases[i].count);
		TEST_ASSERT_EQUAL_INT_MESSAGE(cases[i].is_good ? 0 : -EINVAL, error, message);
		if (cases[i].is_good) {
			TEST_ASSERT_EQUAL_UINT(1, small.store_count);
		} else {
			assert_refused(LW_REASON_OUT_OF_RANGE, cases[i].address, cases[i].value,
				       cases[i].limit);
			TEST_ASSERT_EQUAL_UINT(0, small.allow_count);
		}
	}
}

static void test_one_bad_value_stores_nothing(void)
{
	TEST_ASSERT_EQUAL_INT(-EINVAL, WRITE(0, 1, 50, 0, 20, 0, 0, 0, 9600, 3));
	assert_refused(LW_REASON_OUT_OF_RANGE, 8, 3, 2);
}

static void test_one_refusal_of_the_owner_stores_nothing(void)
{
	small.refused_point = &small_points[3];
	small.refused_error = -EBUSY;
	TEST_ASSERT_EQUAL_INT(-EBUSY, WRITE(1, 50, 0, 20, 0xFFFF, 0xFFFF));
	assert_refused(LW_REASON_BUSY_TRACKING, 4, -1, 0);
	TEST_ASSERT_EQUAL_UINT(3, small.allow_count);
	TEST_ASSERT_EQUAL_INT(0, WRITE(1, 50, 0, 20));
}

static void test_a_secret_is_not_shown(void)
{
	static const uint16_t writes[] = {1, 999, 1000, 0};
	static const int32_t kept[] = {1, 999, 999, 0};
	static const uint16_t read[] = {1000, 1000, 1000, 0};

	for (unsigned int i = 0; i < ARRAY_SIZE(writes); i++) {
		TEST_ASSERT_EQUAL_INT(0, WRITE(500, writes[i]));
		TEST_ASSERT_EQUAL_INT32(kept[i], small.values.secret);
		TEST_ASSERT_EQUAL_INT(0, lw_bank_read_registers(&small.bank, LW_SPACE_HOLDING, 500,
								1, bytes, &why));
		TEST_ASSERT_EQUAL_UINT16(read[i], bytes[0] << 8 | bytes[1]);
	}
	TEST_ASSERT_EQUAL_UINT(ARRAY_SIZE(writes), small.allow_count);
	TEST_ASSERT_EQUAL_UINT(ARRAY_SIZE(writes) - 1, small.store_count);
}

static void test_one_command_per_request(void)
{
	TEST_ASSERT_EQUAL_INT(0,
			      lw_bank_write_bits(&small.bank, 0, 3, (const uint8_t[]){0x06}, &why));
	TEST_ASSERT_EQUAL_HEX32(6, small.coils[0]);
	small_init();
	TEST_ASSERT_EQUAL_INT(-EINVAL,
			      lw_bank_write_bits(&small.bank, 0, 3, (const uint8_t[]){0x03}, &why));
	assert_refused(LW_REASON_SEVERAL_COMMANDS, 1, 1, 0);
}

static void test_bits_are_packed_from_the_lowest(void)
{
	small.coils[0] = 0x80000001;
	small.coils[1] = 0x00000005;
	TEST_ASSERT_EQUAL_INT(0, lw_bank_read_bits(&small.bank, LW_SPACE_COIL, 31, 9, bytes, &why));
	TEST_ASSERT_EQUAL_HEX8(0x0B, bytes[0]); /* coils 31, 32 and 34 */
	TEST_ASSERT_EQUAL_HEX8(0x00, bytes[1]); /* unused bits are 0 */
	TEST_ASSERT_EQUAL_HEX8(0xAA, bytes[2]);
	TEST_ASSERT_EQUAL_UINT(2, small.image_count);

	TEST_ASSERT_EQUAL_INT(
		0, lw_bank_write_bits(&small.bank, 30, 5, (const uint8_t[]){0xED}, &why));
	TEST_ASSERT_EQUAL_HEX32(0x40000001, small.coils[0]);
	TEST_ASSERT_EQUAL_HEX32(0x00000003, small.coils[1]);
}

static void test_bits_beyond_the_end_are_unknown(void)
{
	TEST_ASSERT_EQUAL_INT(-ENXIO,
			      lw_bank_read_bits(&small.bank, LW_SPACE_COIL, 2015, 2, bytes, &why));
	assert_refused(LW_REASON_UNKNOWN_ADDRESS, 2016, 0, 0);
	TEST_ASSERT_EQUAL_HEX8(0xAA, bytes[0]);
	TEST_ASSERT_EQUAL_INT(-ENXIO,
			      lw_bank_write_bits(&small.bank, 2015, 2, (const uint8_t[]){3}, &why));
	assert_refused(LW_REASON_UNKNOWN_ADDRESS, 2016, 0, 0);
}

static void test_a_bank_without_sections_knows_no_address(void)
{
	static const struct lw_bank empty;

	TEST_ASSERT_EQUAL_INT(-ENXIO,
			      lw_bank_read_registers(&empty, LW_SPACE_HOLDING, 0, 1, bytes, &why));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_read_is_big_endian_high_word_first);
	RUN_TEST(test_read_of_half_a_value_and_of_64_bits);
	RUN_TEST(test_read_spans_sections_that_join);
	RUN_TEST(test_read_of_a_range_with_a_hole_names_the_first_missing_address);
	RUN_TEST(test_read_up_to_the_last_address);
	RUN_TEST(test_write_stores_every_type_in_ascending_order_and_commands_last);
	RUN_TEST(test_write_of_an_array_over_two_sections);
	RUN_TEST(test_write_refuses_what_is_not_writable);
	RUN_TEST(test_write_refuses_half_of_a_pair);
	RUN_TEST(test_address_errors_come_before_value_errors);
	RUN_TEST(test_values_are_checked_at_each_limit);
	RUN_TEST(test_one_bad_value_stores_nothing);
	RUN_TEST(test_one_refusal_of_the_owner_stores_nothing);
	RUN_TEST(test_a_secret_is_not_shown);
	RUN_TEST(test_one_command_per_request);
	RUN_TEST(test_bits_are_packed_from_the_lowest);
	RUN_TEST(test_bits_beyond_the_end_are_unknown);
	RUN_TEST(test_a_bank_without_sections_knows_no_address);
	return UNITY_END();
}
