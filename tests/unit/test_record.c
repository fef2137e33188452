/* The stored form of a parameter set. */
#include <errno.h>
#include <string.h>

#include <unity.h>

#include "law_check.h"
#include "lw/record.h"

static uint8_t record[LW_RECORD_SIZE + 1];
static struct lw_params params;
static struct lw_params untouched;

void setUp(void)
{
	lw_record_encode(&lw_params_default, record);
	memset(&untouched, 0x55, sizeof(untouched));
	params = untouched;
}

void tearDown(void)
{
}

static void assert_refused(int expected, size_t length)
{
	TEST_ASSERT_EQUAL_INT(expected, lw_record_decode(record, length, &params));
	TEST_ASSERT_EQUAL_MEMORY(&untouched, &params, sizeof(params));
}

/** CRC-32 by its textbook definition, bit by bit over the message, to forge records. */
static void seal(void)
{
	uint32_t crc = 0xFFFFFFFFu;

	for (size_t bit = 0; bit < 8 * (LW_RECORD_SIZE - 4); bit++) {
		const uint32_t in = (uint32_t)record[bit / 8] >> bit % 8 & 1u;

		crc = (crc ^ in) & 1u ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
	}
	crc = ~crc;
	for (int i = 0; i < 4; i++) {
		record[LW_RECORD_SIZE - 4 + i] = (uint8_t)(crc >> 8 * i);
	}
}

static void test_round_trip_of_random_sets(void)
{
	uint64_t seed = 1;
	struct lw_params set;

	for (int round = 0; round < 1000; round++) {
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
		lw_record_encode(&set, record);
		TEST_ASSERT_EQUAL_INT(0, lw_record_decode(record, LW_RECORD_SIZE, &params));
		TEST_ASSERT_EQUAL_MEMORY(&set, &params, sizeof(params));
	}
}

static void test_the_layout_is_what_the_header_says(void)
{
	static const uint8_t head[] = {
		'L',  'W', 'P', 'S', LW_MAP_VERSION, 0, LW_MAP_PARAMS_COUNT, 0,
		0x68, 1,   0,   0}; /* the first value: 360 */
	uint8_t copy[LW_RECORD_SIZE];

	TEST_ASSERT_EQUAL_HEX8_ARRAY(head, record, sizeof(head));
	memcpy(copy, record, sizeof(copy));
	seal();
	TEST_ASSERT_EQUAL_HEX8_ARRAY(copy, record, sizeof(copy));
}

static void test_every_single_bit_flip_is_refused(void)
{
	for (size_t bit = 0; bit < 8 * LW_RECORD_SIZE; bit++) {
		record[bit / 8] ^= (uint8_t)(1u << bit % 8);
		TEST_ASSERT_NOT_EQUAL(0, lw_record_decode(record, LW_RECORD_SIZE, &params));
		TEST_ASSERT_EQUAL_MEMORY(&untouched, &params, sizeof(params));
		record[bit / 8] ^= (uint8_t)(1u << bit % 8);
	}
	TEST_ASSERT_EQUAL_INT(0, lw_record_decode(record, LW_RECORD_SIZE, &params));
}

static void test_every_other_length_is_refused(void)
{
	for (size_t length = 0; length < LW_RECORD_SIZE; length++) {
		assert_refused(-EBADMSG, length);
	}
	assert_refused(-EBADMSG, LW_RECORD_SIZE + 1);
}

static void test_another_version_is_told_apart(void)
{
	record[4]++;
	seal();
	assert_refused(-ENOTSUP, LW_RECORD_SIZE);
	assert_refused(-ENOTSUP, LW_RECORD_SIZE - 4); /* of another size, too */
}

static void test_another_number_of_values_is_of_another_version(void)
{
	record[6]++;
	seal();
	assert_refused(-ENOTSUP, LW_RECORD_SIZE);
}

static void test_a_value_outside_its_limits_is_refused(void)
{
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		for (int end = 0; end < 2; end++) {
			const int64_t value = end == 0 ? (int64_t)lw_map_params[i].min - 1
						       : (int64_t)lw_map_params[i].max + 1;
			uint8_t *at = record + 8 + 4 * i;
			uint8_t good[4];

			memcpy(good, at, 4);
			for (int byte = 0; byte < 4; byte++) {
				at[byte] = (uint8_t)((uint64_t)value >> 8 * byte);
			}
			seal();
			assert_refused(-EBADMSG, LW_RECORD_SIZE);
			memcpy(at, good, 4);
		}
	}
}

static void test_an_unsigned_value_is_not_taken_as_negative(void)
{
	/* rope_per_drum_rev_um, U32: 0xFFFFFFFF is far above its limit. */
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		if (lw_map_params[i].type == LW_TYPE_U32) {
			uint8_t good[4];

			memcpy(good, record + 8 + 4 * i, 4);
			memset(record + 8 + 4 * i, 0xFF, 4);
			seal();
			assert_refused(-EBADMSG, LW_RECORD_SIZE);
			memcpy(record + 8 + 4 * i, good, 4);
		}
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_round_trip_of_random_sets);
	RUN_TEST(test_the_layout_is_what_the_header_says);
	RUN_TEST(test_every_single_bit_flip_is_refused);
	RUN_TEST(test_every_other_length_is_refused);
	RUN_TEST(test_another_version_is_told_apart);
	RUN_TEST(test_another_number_of_values_is_of_another_version);
	RUN_TEST(test_a_value_outside_its_limits_is_refused);
	RUN_TEST(test_an_unsigned_value_is_not_taken_as_negative);
	return UNITY_END();
}
