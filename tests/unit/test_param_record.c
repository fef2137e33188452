/* SPDX-License-Identifier: Apache-2.0 */
/* The stored form of a parameter set, and older forms of it. */
#include <errno.h>
#include <string.h>

#include <unity.h>

#include "law_check.h"
#include "lw/bytes/crc32.h"
#include "lw/storage/param_record.h"
#include "record_schema_1.h"

/* Room for one entry more. */
static uint8_t bytes[LW_PARAM_RECORD_SIZE + 6];
static struct lw_params params;
static struct lw_params untouched;
static struct lw_record record;

void setUp(void)
{
	memset(bytes, 0, sizeof(bytes));
	(void)lw_param_record_encode(&lw_params_default, 5, bytes);
	memset(&untouched, 0x55, sizeof(untouched));
	params = untouched;
}

void tearDown(void)
{
}

static int decode(void)
{
	return lw_param_record_decode(bytes, sizeof(bytes), &params, &record);
}

static void assert_refused(int expected)
{
	TEST_ASSERT_EQUAL_INT(expected, decode());
	TEST_ASSERT_EQUAL_MEMORY(&untouched, &params, sizeof(params));
}

static uint8_t *entry(size_t i)
{
	return bytes + LW_RECORD_HEAD_SIZE + 6 * i;
}

static void put(uint8_t *at, uint16_t address, int64_t value)
{
	const uint8_t fresh[6] = {
		(uint8_t)(address >> 8),          (uint8_t)address,
		(uint8_t)((uint64_t)value >> 24), (uint8_t)((uint64_t)value >> 16),
		(uint8_t)((uint64_t)value >> 8),  (uint8_t)value};

	memcpy(at, fresh, sizeof(fresh));
}

/** Seal `bytes` anew, with this many entries. */
static void seal(size_t entries, uint16_t schema)
{
	(void)lw_record_seal(bytes, "LWPR", schema, 5, 6 * entries);
}

static void test_round_trip_of_random_sets(void)
{
	uint64_t seed = 1;
	struct lw_params set;

	for (uint32_t round = 0; round < 1000; round++) {
		for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
			const struct lw_point *point = &lw_map_params[i];
			const uint32_t range = (uint32_t)point->max - (uint32_t)point->min + 1;
			const uint32_t random = next_random(&seed);
			const int32_t value =
				point->allowed != NULL
					? point->allowed[random % point->allowed_count]
				: round == 0 ? point->min
				: round == 1 ? point->max
					     : (int32_t)((uint32_t)point->min + random % range);

			memcpy((char *)&set + point->offset, &value, sizeof(value));
		}
		TEST_ASSERT_EQUAL_UINT(LW_PARAM_RECORD_SIZE,
				       lw_param_record_encode(&set, round, bytes));
		TEST_ASSERT_EQUAL_INT(0, decode());
		TEST_ASSERT_EQUAL_MEMORY(&set, &params, sizeof(params));
		TEST_ASSERT_EQUAL_UINT16(LW_PARAM_RECORD_SCHEMA, record.schema);
		TEST_ASSERT_EQUAL_UINT32(round, record.sequence);
	}
}

static void test_the_layout_is_what_the_header_says(void)
{
	static const uint8_t head[] = {'L', 'W', 'P', 'R', 0, 2};
	static const uint8_t rest[] = {0, 0, 0, 5, 0, 100, 0, 0, 1, 0x68, 0, 101, 0, 0, 0, 2};

	TEST_ASSERT_EQUAL_HEX8_ARRAY(head, bytes, sizeof(head));
	TEST_ASSERT_EQUAL_UINT(6 * LW_MAP_PARAMS_COUNT, bytes[6] << 8 | bytes[7]);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(rest, bytes + 8, sizeof(rest));
}

static void test_every_cut_and_every_single_bit_flip_is_found(void)
{
	for (size_t size = 1; size < LW_PARAM_RECORD_SIZE; size++) {
		TEST_ASSERT_EQUAL_INT(-EBADMSG,
				      lw_param_record_decode(bytes, size, &params, &record));
	}
	for (size_t bit = 0; bit < 8 * LW_PARAM_RECORD_SIZE; bit++) {
		bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
		assert_refused(-EBADMSG);
		bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
	}
	TEST_ASSERT_EQUAL_INT(-ENODATA, lw_param_record_decode(bytes, 0, &params, &record));
	TEST_ASSERT_EQUAL_INT(0, decode());
}

static void test_a_parameter_that_the_record_lacks_gets_its_factory_value(void)
{
	for (size_t missing = 0; missing < LW_MAP_PARAMS_COUNT; missing++) {
		struct lw_params expected = lw_params_default;
		const size_t count = LW_MAP_PARAMS_COUNT - 1;

		expected.pitch_um = missing == 11 ? 12000 : 11000;
		(void)lw_param_record_encode(&expected, 5, bytes);
		TEST_ASSERT_EQUAL_UINT16(LW_ADDRESS_PITCH_UM, lw_map_params[11].address);
		memmove(entry(missing), entry(missing + 1), 6 * (count - missing));
		seal(count, LW_PARAM_RECORD_SCHEMA);
		TEST_ASSERT_EQUAL_INT(0, decode());
		TEST_ASSERT_EQUAL_MEMORY(&expected, &params, sizeof(params));
	}
}

static void test_a_parameter_that_is_not_known_is_of_newer_firmware(void)
{
	/* Between two, and behind the last. */
	memmove(entry(9), entry(8), 6 * (LW_MAP_PARAMS_COUNT - 8));
	put(entry(8), 108, 1);
	seal(LW_MAP_PARAMS_COUNT + 1, LW_PARAM_RECORD_SCHEMA);
	assert_refused(-ENOTSUP);
	TEST_ASSERT_EQUAL_UINT32(5, record.sequence);

	setUp();
	put(entry(LW_MAP_PARAMS_COUNT), 60000, 1);
	seal(LW_MAP_PARAMS_COUNT + 1, LW_PARAM_RECORD_SCHEMA);
	assert_refused(-ENOTSUP);
}

static void test_a_newer_schema_is_told_apart_from_damage(void)
{
	seal(LW_MAP_PARAMS_COUNT, LW_PARAM_RECORD_SCHEMA + 1);
	assert_refused(-ENOTSUP);
	TEST_ASSERT_EQUAL_UINT16(LW_PARAM_RECORD_SCHEMA + 1, record.schema);
	TEST_ASSERT_EQUAL_UINT32(5, record.sequence);
	seal(0, LW_PARAM_RECORD_SCHEMA + 1);
	assert_refused(-ENOTSUP);
}

static void test_registers_out_of_order_are_refused(void)
{
	put(entry(1), 100, 360); /* twice the same */
	seal(LW_MAP_PARAMS_COUNT, LW_PARAM_RECORD_SCHEMA);
	assert_refused(-EINVAL);
	setUp();
	put(entry(0), 101, 2);
	put(entry(1), 100, 360);
	seal(LW_MAP_PARAMS_COUNT, LW_PARAM_RECORD_SCHEMA);
	assert_refused(-EINVAL);
}

static void test_a_payload_of_broken_entries_is_refused(void)
{
	(void)lw_record_seal(bytes, "LWPR", LW_PARAM_RECORD_SCHEMA, 5, 6 * 3 + 5);
	assert_refused(-EINVAL);
}

static void test_a_value_outside_its_limits_is_refused(void)
{
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		const struct lw_point *point = &lw_map_params[i];

		for (int end = 0; end < 2; end++) {
			setUp();
			put(entry(i), point->address,
			    end == 0 ? (int64_t)point->min - 1 : (int64_t)point->max + 1);
			seal(LW_MAP_PARAMS_COUNT, LW_PARAM_RECORD_SCHEMA);
			assert_refused(-EINVAL);
		}
		if (point->type == LW_TYPE_U32) { /* not taken as -1 */
			setUp();
			put(entry(i), point->address, 0xFFFFFFFF);
			seal(LW_MAP_PARAMS_COUNT, LW_PARAM_RECORD_SCHEMA);
			assert_refused(-EINVAL);
		}
	}
}

static void load_schema_1(void)
{
	memset(bytes, 0, sizeof(bytes)); /* as behind a short file that has grown */
	memcpy(bytes, record_schema_1, sizeof(record_schema_1));
}

static void test_schema_1_is_converted(void)
{
	const struct lw_params expected = record_schema_1_params();

	load_schema_1();
	TEST_ASSERT_EQUAL_INT(
		0, lw_param_record_decode(bytes, sizeof(record_schema_1), &params, &record));
	TEST_ASSERT_EQUAL_MEMORY(&expected, &params, sizeof(params));
	TEST_ASSERT_EQUAL_UINT16(1, record.schema);
	TEST_ASSERT_EQUAL_UINT32(0, record.sequence);
	params = untouched;
	TEST_ASSERT_EQUAL_INT(0, decode());
	TEST_ASSERT_EQUAL_MEMORY(&expected, &params, sizeof(params));
}

static void test_every_cut_and_flip_of_schema_1_is_found(void)
{
	load_schema_1();
	for (size_t size = 1; size < sizeof(record_schema_1); size++) {
		TEST_ASSERT_EQUAL_INT(-EBADMSG,
				      lw_param_record_decode(bytes, size, &params, &record));
	}
	for (size_t bit = 0; bit < 8 * sizeof(record_schema_1); bit++) {
		bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
		assert_refused(-EBADMSG);
		bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
	}
}

static void test_a_value_of_schema_1_outside_its_limits_is_refused(void)
{
	uint32_t crc;

	load_schema_1();
	bytes[8] = 0; /* encoder_pulses_per_rev 360, low byte first */
	bytes[9] = 0;
	crc = lw_crc32(bytes, sizeof(record_schema_1) - 4);
	for (int i = 0; i < 4; i++) {
		bytes[sizeof(record_schema_1) - 4 + (size_t)i] = (uint8_t)(crc >> 8 * i);
	}
	assert_refused(-EINVAL);
	TEST_ASSERT_EQUAL_UINT16(1, record.schema);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_round_trip_of_random_sets);
	RUN_TEST(test_the_layout_is_what_the_header_says);
	RUN_TEST(test_every_cut_and_every_single_bit_flip_is_found);
	RUN_TEST(test_a_parameter_that_the_record_lacks_gets_its_factory_value);
	RUN_TEST(test_a_parameter_that_is_not_known_is_of_newer_firmware);
	RUN_TEST(test_a_newer_schema_is_told_apart_from_damage);
	RUN_TEST(test_registers_out_of_order_are_refused);
	RUN_TEST(test_a_payload_of_broken_entries_is_refused);
	RUN_TEST(test_a_value_outside_its_limits_is_refused);
	RUN_TEST(test_schema_1_is_converted);
	RUN_TEST(test_every_cut_and_flip_of_schema_1_is_found);
	RUN_TEST(test_a_value_of_schema_1_outside_its_limits_is_refused);
	return UNITY_END();
}
