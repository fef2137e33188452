/* SPDX-License-Identifier: Apache-2.0 */
/* Banks of cam tables: their words, their CRC, and the check under a parameter set. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include <unity.h>

#include "lw/cam/cam_banks.h"
#include "lw/control/cam_check.h"
#include "lw/control/params_units.h"

static struct lw_cam_bank bank;
static struct lw_params params;
static struct lw_cam_statistics statistics;
static struct lw_cam_refusal why;

#define SET_ROWS(...)                                                                              \
	do {                                                                                       \
		const struct lw_cam_row rows_[] = {__VA_ARGS__};                                   \
                                                                                                   \
		memcpy(bank.table.rows, rows_, sizeof(rows_));                                     \
		bank.table.row_count = sizeof(rows_) / sizeof(rows_[0]);                           \
	} while (0)

void setUp(void)
{
	params = lw_params_default;
	bank = (struct lw_cam_bank){.state = LW_CAM_BANK_STATE_LOADING};
	SET_ROWS({0, 0}, {1000, 1500}, {3000, -500}, {4000, 0});
	why = (struct lw_cam_refusal){0};
}

void tearDown(void)
{
}

static void accepted(void)
{
	bank.crc = lw_cam_bank_crc(&bank);
	TEST_ASSERT_EQUAL_INT(0, lw_cam_bank_check(&bank, &params, &statistics, &why));
}

/** Refused, and nothing is told about the table. */
static void assert_refused(enum lw_reason reason, int row, int32_t value, int32_t limit)
{
	const struct lw_cam_statistics before = statistics;

	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_cam_bank_check(&bank, &params, &statistics, &why));
	TEST_ASSERT_EQUAL_INT(reason, why.reason);
	TEST_ASSERT_EQUAL_INT(row, why.row);
	TEST_ASSERT_EQUAL_INT32(value, why.value);
	TEST_ASSERT_EQUAL_INT32(limit, why.limit);
	TEST_ASSERT_EQUAL_MEMORY(&before, &statistics, sizeof(before));
}

static void refused(enum lw_reason reason, int row, int32_t value, int32_t limit)
{
	bank.crc = lw_cam_bank_crc(&bank);
	assert_refused(reason, row, value, limit);
}

/** The words of a table that is written in full below. */
static const uint16_t words[] = {
	0x6869,
	0x6C6C,
	0,
	0,
	0,
	0,
	0,
	0, /* "hill" */
	0x0001,
	0x0002, /* version */
	LW_CAM_INTERPOLATION_TRAPEZOID,
	4, /* rows */
	0xFFFF,
	0xFFF9, /* advance */
	0x1E8D,
	0x73A7, /* CRC, by zlib */
	0,
	0,
	0,
	0, /* rows: master, slave */
	0,
	1000,
	0,
	1500, /* */
	0,
	3000,
	0xFFFF,
	0x10000 - 500, /* */
	0,
	4000,
	0xFFFF,
	0xFFF9,
};

#define WORDS (sizeof(words) / sizeof(words[0]))

static void test_the_words_of_a_table(void)
{
	bank = (struct lw_cam_bank){.state = LW_CAM_BANK_STATE_READY};
	for (unsigned int i = 0; i < WORDS; i++) {
		lw_cam_bank_put(&bank, i, words[i]);
	}
	TEST_ASSERT_EQUAL_INT(LW_CAM_BANK_STATE_LOADING, bank.state);
	TEST_ASSERT_EQUAL_STRING("hill", bank.table.name);
	TEST_ASSERT_EQUAL_UINT32(0x10002, bank.table.version);
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_INTERPOLATION_TRAPEZOID, bank.table.interpolation);
	TEST_ASSERT_EQUAL_UINT16(4, bank.table.row_count);
	TEST_ASSERT_EQUAL_INT32(-7, bank.table.advance);
	TEST_ASSERT_EQUAL_INT32(1000, bank.table.rows[1].master);
	TEST_ASSERT_EQUAL_INT32(1500, bank.table.rows[1].slave);
	TEST_ASSERT_EQUAL_INT32(3000, bank.table.rows[2].master);
	TEST_ASSERT_EQUAL_INT32(-500, bank.table.rows[2].slave);
	TEST_ASSERT_EQUAL_INT32(4000, bank.table.rows[3].master);
	TEST_ASSERT_EQUAL_INT32(-7, bank.table.rows[3].slave);
	TEST_ASSERT_EQUAL_UINT16(WORDS, lw_cam_bank_words(&bank));
	for (unsigned int i = 0; i < WORDS; i++) {
		TEST_ASSERT_EQUAL_HEX16(words[i], lw_cam_bank_get(&bank, i));
	}
	/* The same number as zip's. */
	TEST_ASSERT_EQUAL_HEX32((uint32_t)words[14] << 16 | words[15], lw_cam_bank_crc(&bank));
	TEST_ASSERT_EQUAL_HEX32(bank.crc, lw_cam_bank_crc(&bank));
}

/** Every word is one of its own: written in any order, each reads back what it was given. */
static void test_every_word_reads_back(void)
{
	for (unsigned int i = 0; i < LW_CAM_WORDS; i++) {
		const unsigned int index = i * 37 % LW_CAM_WORDS;

		lw_cam_bank_put(&bank, index, (uint16_t)(index * 40503u + 11));
	}
	for (unsigned int index = 0; index < LW_CAM_WORDS; index++) {
		TEST_ASSERT_EQUAL_HEX16((uint16_t)(index * 40503u + 11),
					lw_cam_bank_get(&bank, index));
	}
}

static void test_more_rows_than_fit_are_not_words(void)
{
	bank.table.row_count = LW_CAM_ROWS_MAX;
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_WORDS, lw_cam_bank_words(&bank));
	bank.table.row_count = UINT16_MAX;
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_WORDS, lw_cam_bank_words(&bank));
	bank.table.row_count = 0;
	TEST_ASSERT_EQUAL_UINT16(LW_CAM_HEAD_WORDS, lw_cam_bank_words(&bank));
}

/** Every bit of every word that the row count names counts, and none of the others. */
static void test_the_crc_sees_every_bit(void)
{
	const uint32_t crc = lw_cam_bank_crc(&bank);

	for (unsigned int i = 0; i < LW_CAM_WORDS; i++) {
		const bool counts = i < lw_cam_bank_words(&bank) && i != LW_CAM_CRC_WORD &&
				    i != LW_CAM_CRC_WORD + 1;

		for (int bit = 0; bit < 16; bit++) {
			const uint16_t word = lw_cam_bank_get(&bank, i);

			lw_cam_bank_put(&bank, i, (uint16_t)(word ^ 1u << bit));
			TEST_ASSERT_TRUE((lw_cam_bank_crc(&bank) != crc) == counts);
			lw_cam_bank_put(&bank, i, word);
		}
	}
	TEST_ASSERT_EQUAL_HEX32(crc, lw_cam_bank_crc(&bank));
}

static void test_a_good_table_tells_its_numbers(void)
{
	accepted();
	TEST_ASSERT_EQUAL_UINT32(4000, statistics.cycle_edges);
	TEST_ASSERT_EQUAL_INT32(1500, statistics.max_usteps);
	TEST_ASSERT_EQUAL_INT32(-500, statistics.min_usteps);
	TEST_ASSERT_EQUAL_UINT32(1500, statistics.slope_max_permille);
	params.cam_master_edges = 2;
	params.cam_slave_usteps = 3;
	params.cam_slave_units = 9;
	accepted();
	TEST_ASSERT_EQUAL_UINT32(8000, statistics.cycle_edges);
	TEST_ASSERT_EQUAL_INT32(500, statistics.max_usteps);
	TEST_ASSERT_EQUAL_UINT32(250, statistics.slope_max_permille);
}

static void test_a_wrong_crc(void)
{
	bank.crc = lw_cam_bank_crc(&bank) ^ 0x80000001;
	assert_refused(LW_REASON_CAM_CRC, 0, (int32_t)bank.crc, (int32_t)lw_cam_bank_crc(&bank));
	/* Torn: a row of the old table is left. */
	accepted();
	bank.table.rows[3].slave = 1;
	assert_refused(LW_REASON_CAM_CRC, 0, (int32_t)bank.crc, (int32_t)lw_cam_bank_crc(&bank));
}

static void test_the_rows_are_checked(void)
{
	bank.table.row_count = LW_CAM_ROWS_MAX + 1;
	refused(LW_REASON_CAM_TOO_MANY_ROWS, LW_CAM_ROWS_MAX + 1, LW_CAM_ROWS_MAX + 1,
		LW_CAM_ROWS_MAX);
	bank.crc++; /* there is no CRC of rows that are not there */
	assert_refused(LW_REASON_CAM_TOO_MANY_ROWS, LW_CAM_ROWS_MAX + 1, LW_CAM_ROWS_MAX + 1,
		       LW_CAM_ROWS_MAX);
	bank.table.row_count = 1;
	refused(LW_REASON_CAM_TOO_FEW_ROWS, 1, 1, 2);
	SET_ROWS({0, 0}, {100, 5}, {100, 0});
	refused(LW_REASON_CAM_MASTER_NOT_ASCENDING, 3, 100, 101);
	SET_ROWS({0, 0}, {100, 401}, {300, 0});
	refused(LW_REASON_CAM_SLOPE, 1, 4010, 4000);
	SET_ROWS({0, 0}, {100, 10});
	refused(LW_REASON_CAM_WRAP, 2, 10, 0);
}

static void test_the_limits_are_those_of_the_parameters(void)
{
	const uint32_t rate = 3 * params.overspeed_trip_edges_per_s / 2;

	params.cam_steps_per_s_max = rate;
	accepted();
	params.cam_steps_per_s_max = rate - 1;
	refused(LW_REASON_CAM_STEP_RATE, 1, (int32_t)rate, (int32_t)rate - 1);
	params.overspeed_trip_edges_per_s--;
	accepted();
	/* The ramps too: with 1/2 of the row each, the plateau is twice as steep. */
	params = lw_params_default;
	bank.table.interpolation = LW_CAM_INTERPOLATION_TRAPEZOID;
	params.cam_ramp_divisor = 2;
	params.cam_steps_per_s_max = 4000000;
	accepted();
	TEST_ASSERT_EQUAL_UINT32(3000, statistics.slope_max_permille);
}

static void test_only_a_free_axis_advances(void)
{
	SET_ROWS({0, 0}, {1000, 100});
	bank.table.advance = 100;
	refused(LW_REASON_CAM_ADVANCES, 2, 100, 0);
	params.cam_axis = LW_CAM_AXIS_FREE;
	params.cam_start = LW_CAM_START_RELATIVE;
	accepted();
}

/** Flanges of the factory set, in microsteps. */
static int32_t flange_usteps(int32_t um)
{
	return lw_params_um_to_usteps(&params, um);
}

static void test_every_position_lies_between_the_flanges(void)
{
	const int32_t plus = flange_usteps(params.flange_plus_um);
	const int32_t minus = flange_usteps(params.flange_minus_um);

	SET_ROWS({0, 0}, {20000, plus}, {60000, minus}, {80000, 0});
	accepted();
	bank.table.rows[1].slave = plus + 1;
	refused(LW_REASON_CAM_BEYOND_FLANGE, 2, plus + 1, plus);
	bank.table.rows[1].slave = plus;
	bank.table.rows[2].slave = minus - 1;
	refused(LW_REASON_CAM_BEYOND_FLANGE, 3, minus - 1, minus);
	/* The last of the highest, when the first row is the highest itself. */
	SET_ROWS({0, plus + 5}, {20000, 0}, {40000, plus + 5});
	refused(LW_REASON_CAM_BEYOND_FLANGE, 1, plus + 5, plus);
	SET_ROWS({0, minus - 5}, {20000, 0}, {40000, minus - 5});
	bank.table.rows[3].slave = minus - 10; /* of an upload before */
	refused(LW_REASON_CAM_BEYOND_FLANGE, 1, minus - 5, minus);

	/* A relative start is judged when it is made; a free axis has no flanges. */
	params.cam_start = LW_CAM_START_RELATIVE;
	accepted();
	TEST_ASSERT_EQUAL_INT(0, lw_cam_bank_check_flanges(&bank, &statistics, &params, 5, &why));
	TEST_ASSERT_EQUAL_INT(-EINVAL,
			      lw_cam_bank_check_flanges(&bank, &statistics, &params, 4, &why));
	params.cam_axis = LW_CAM_AXIS_FREE;
	TEST_ASSERT_EQUAL_INT(0, lw_cam_bank_check_flanges(&bank, &statistics, &params, 4, &why));
}

/** Flanges further out than positions can be counted. */
static void test_positions_that_cannot_be_counted(void)
{
	params.flange_plus_um = 400000;
	params.flange_minus_um = -400000;
	SET_ROWS({0, 0}, {40000, 32700}, {100000, -32700}, {160000, 0});
	accepted();
	bank.table.rows[1].slave++;
	refused(LW_REASON_CAM_BEYOND_FLANGE, 2, 32701, 32700);
	bank.table.rows[1].slave = 0;
	bank.table.rows[2].slave--;
	refused(LW_REASON_CAM_BEYOND_FLANGE, 3, -32701, -32700);
}

/** Numbers that 32 bits do not hold are not taken for smaller ones, however they are shifted. */
static void test_extremes_beyond_32_bits(void)
{
	params.cam_start = LW_CAM_START_RELATIVE;
	params.cam_slave_usteps = 2;
	SET_ROWS({0, INT32_MAX}, {1000, INT32_MAX});
	accepted();
	TEST_ASSERT_EQUAL_INT32(INT32_MAX, statistics.max_usteps);
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_cam_bank_check_flanges(&bank, &statistics, &params,
								 -(int64_t)INT32_MAX, &why));
	SET_ROWS({0, INT32_MIN}, {1000, INT32_MIN});
	accepted();
	TEST_ASSERT_EQUAL_INT(-EINVAL, lw_cam_bank_check_flanges(&bank, &statistics, &params,
								 -(int64_t)INT32_MIN, &why));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_the_words_of_a_table);
	RUN_TEST(test_every_word_reads_back);
	RUN_TEST(test_more_rows_than_fit_are_not_words);
	RUN_TEST(test_the_crc_sees_every_bit);
	RUN_TEST(test_a_good_table_tells_its_numbers);
	RUN_TEST(test_a_wrong_crc);
	RUN_TEST(test_the_rows_are_checked);
	RUN_TEST(test_the_limits_are_those_of_the_parameters);
	RUN_TEST(test_only_a_free_axis_advances);
	RUN_TEST(test_every_position_lies_between_the_flanges);
	RUN_TEST(test_positions_that_cannot_be_counted);
	RUN_TEST(test_extremes_beyond_32_bits);
	return UNITY_END();
}
