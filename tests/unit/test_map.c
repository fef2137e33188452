/* SPDX-License-Identifier: Apache-2.0 */
/* The generated tables keep the promises that the register bank relies on. */
#include "lw/map.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "unity.h"

struct block {
	const char *name;
	const struct lw_point *points;
	size_t count;
	size_t struct_size;
};

static const struct block blocks[] = {
	{"setpoints", lw_map_setpoints, LW_MAP_SETPOINTS_COUNT, sizeof(struct lw_setpoints)},
	{"params", lw_map_params, LW_MAP_PARAMS_COUNT, sizeof(struct lw_params)},
	{"status", lw_map_status, LW_MAP_STATUS_COUNT, sizeof(struct lw_status)},
	{"bench", lw_map_bench, LW_MAP_BENCH_COUNT, sizeof(struct lw_bench)},
};

#define BLOCK_COUNT (sizeof(blocks) / sizeof(blocks[0]))

void setUp(void)
{
}

void tearDown(void)
{
}

static unsigned int words_of(const struct lw_point *point)
{
	switch (point->type) {
	case LW_TYPE_U16:
	case LW_TYPE_I16:
		return point->count;
	case LW_TYPE_U32:
	case LW_TYPE_I32:
		return 2u * point->count;
	case LW_TYPE_I64:
		return 4u * point->count;
	default:
		TEST_FAIL_MESSAGE("a point of a register block has a type of no register");
		return 0;
	}
}

static size_t memory_of(const struct lw_point *point)
{
	return (point->type == LW_TYPE_I64 ? sizeof(int64_t) : sizeof(int32_t)) * point->count;
}

static const struct lw_point *point_at(const struct lw_point *points, size_t count,
				       uint16_t address)
{
	for (size_t i = 0; i < count; i++) {
		if (points[i].address == address) {
			return &points[i];
		}
	}
	TEST_FAIL_MESSAGE("no point at this address");
	return NULL;
}

static bool overlaps(const struct lw_point *a, unsigned int a_offset, const struct lw_point *b)
{
	return a->address + a_offset < b->address + words_of(b) &&
	       b->address < a->address + a_offset + words_of(a);
}

static void test_points_rise_in_address_and_in_memory_without_overlap(void)
{
	for (const struct block *block = blocks; block < blocks + BLOCK_COUNT; block++) {
		unsigned int next_address = 0;
		size_t next_offset = 0;

		for (size_t i = 0; i < block->count; i++) {
			const struct lw_point *point = &block->points[i];

			TEST_ASSERT_GREATER_OR_EQUAL_UINT32(next_address, point->address);
			TEST_ASSERT_TRUE(point->offset >= next_offset);
			TEST_ASSERT_GREATER_THAN_UINT(0, point->count);
			next_address = point->address + words_of(point);
			next_offset = point->offset + memory_of(point);
		}
		TEST_ASSERT_LESS_OR_EQUAL_UINT(65536, next_address);
		TEST_ASSERT_TRUE(next_offset <= block->struct_size);
	}
}

static void test_mirrors_and_blocks_do_not_overlap(void)
{
	for (size_t p = 0; p < LW_MAP_PARAMS_COUNT; p++) {
		const struct lw_point *point = &lw_map_params[p];

		for (size_t i = 0; i < LW_MAP_STATUS_COUNT; i++) {
			const struct lw_point *other = &lw_map_status[i];

			TEST_ASSERT_FALSE(overlaps(point, LW_MAP_ACTIVE_ADDRESS_OFFSET, other));
			TEST_ASSERT_FALSE(overlaps(point, LW_MAP_STORED_ADDRESS_OFFSET, other));
		}
		for (size_t i = 0; i < LW_MAP_SETPOINTS_COUNT; i++) {
			TEST_ASSERT_FALSE(overlaps(point, 0, &lw_map_setpoints[i]));
		}
	}
	/* The two mirrors lie apart. */
	TEST_ASSERT_GREATER_THAN_UINT(lw_map_params[LW_MAP_PARAMS_COUNT - 1].address,
				      LW_MAP_STORED_ADDRESS_OFFSET - LW_MAP_ACTIVE_ADDRESS_OFFSET);
}

static void assert_limits_hold(const struct lw_point *point)
{
	TEST_ASSERT_LESS_OR_EQUAL_INT32(point->max, point->min);
	TEST_ASSERT_GREATER_OR_EQUAL_INT32(point->min, point->default_value);
	TEST_ASSERT_LESS_OR_EQUAL_INT32(point->max, point->default_value);
	if (point->type == LW_TYPE_I16) {
		TEST_ASSERT_GREATER_OR_EQUAL_INT32(INT16_MIN, point->min);
		TEST_ASSERT_LESS_OR_EQUAL_INT32(INT16_MAX, point->max);
	} else if (point->type == LW_TYPE_U16) {
		TEST_ASSERT_LESS_OR_EQUAL_INT32(UINT16_MAX, point->max);
	}
	if (point->type == LW_TYPE_U16 || point->type == LW_TYPE_U32) {
		TEST_ASSERT_GREATER_OR_EQUAL_INT32(0, point->min);
	}
	TEST_ASSERT_NOT_EQUAL(LW_TYPE_I64, point->type);

	bool is_default_allowed = point->allowed == NULL;

	for (size_t i = 0; i < point->allowed_count; i++) {
		is_default_allowed |= point->allowed[i] == point->default_value;
		TEST_ASSERT_TRUE(point->allowed[i] >= point->min &&
				 point->allowed[i] <= point->max);
	}
	TEST_ASSERT_TRUE(is_default_allowed);
}

static void test_what_can_be_written_has_limits_that_hold_its_default(void)
{
	for (const struct block *block = blocks; block < blocks + BLOCK_COUNT; block++) {
		for (size_t i = 0; i < block->count; i++) {
			const struct lw_point *point = &block->points[i];

			if (point->flags & LW_POINT_WRITABLE) {
				assert_limits_hold(point);
			} else {
				TEST_ASSERT_EQUAL_HEX8(0, point->flags);
			}
		}
	}
}

static void test_status_is_read_only_and_parameters_are_writable(void)
{
	for (size_t i = 0; i < LW_MAP_STATUS_COUNT; i++) {
		TEST_ASSERT_EQUAL_HEX8(0, lw_map_status[i].flags);
	}
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		TEST_ASSERT_TRUE(lw_map_params[i].flags & LW_POINT_WRITABLE);
	}
	TEST_ASSERT_EQUAL_HEX8(
		0, point_at(lw_map_bench, LW_MAP_BENCH_COUNT, LW_ADDRESS_BENCH_CARRIAGE_UM)->flags);
}

static void test_default_parameters_are_those_of_the_table(void)
{
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		int32_t value;

		memcpy(&value, (const char *)&lw_params_default + lw_map_params[i].offset,
		       sizeof(value));
		TEST_ASSERT_EQUAL_INT32(lw_map_params[i].default_value, value);
	}
}

static void test_coils_run_a_command_or_jog(void)
{
	for (uint16_t i = 0; i < LW_MAP_COILS_COUNT; i++) {
		const struct lw_point *coil = &lw_map_coils[i];
		bool is_command = lw_map_coil_command[i] != 0;

		TEST_ASSERT_EQUAL_UINT16(i, coil->address);
		TEST_ASSERT_EQUAL_UINT16(i, coil->offset);
		TEST_ASSERT_EQUAL_UINT16(1, coil->count);
		TEST_ASSERT_EQUAL_UINT8(LW_TYPE_BIT, coil->type);
		TEST_ASSERT_EQUAL_INT32(1, coil->max);
		TEST_ASSERT_TRUE(coil->flags & LW_POINT_WRITABLE);
		TEST_ASSERT_EQUAL(is_command, (coil->flags & LW_POINT_COMMAND) != 0);
		TEST_ASSERT_EQUAL(is_command, lw_map_coil_jog[i] == 0);
	}
	TEST_ASSERT_EQUAL_UINT8(LW_COMMAND_STOP, lw_map_coil_command[LW_ADDRESS_STOP]);
	TEST_ASSERT_EQUAL_INT8(1, lw_map_coil_jog[LW_ADDRESS_JOG_PLUS]);
	TEST_ASSERT_EQUAL_INT8(-1, lw_map_coil_jog[LW_ADDRESS_JOG_MINUS]);
}

static void test_discrete_inputs_fit_into_two_register_pairs_of_flags(void)
{
	TEST_ASSERT_LESS_OR_EQUAL_UINT(64, LW_MAP_DISCRETES_COUNT);
	TEST_ASSERT_EQUAL_INT(32, LW_FLAG_SET_UNCONFIRMED);
	for (uint16_t i = 0; i < LW_MAP_DISCRETES_COUNT; i++) {
		TEST_ASSERT_EQUAL_UINT16(i, lw_map_discretes[i].address);
		TEST_ASSERT_EQUAL_UINT16(i % 32, lw_map_discretes[i].offset);
		TEST_ASSERT_EQUAL_UINT8(LW_TYPE_BIT, lw_map_discretes[i].type);
		TEST_ASSERT_EQUAL_HEX8(0, lw_map_discretes[i].flags);
	}
}

/* One point of each kind, written out: what map version 1 promises to integrators. */
static void test_points_are_what_the_map_says(void)
{
	const struct lw_point *pitch = point_at(lw_map_params, LW_MAP_PARAMS_COUNT, 114);
	const struct lw_point *baud_rate = point_at(lw_map_params, LW_MAP_PARAMS_COUNT, 181);
	const struct lw_point *command = point_at(lw_map_setpoints, LW_MAP_SETPOINTS_COUNT, 0);
	const struct lw_point *mode = point_at(lw_map_setpoints, LW_MAP_SETPOINTS_COUNT, 1);
	const struct lw_point *net_edges = point_at(lw_map_status, LW_MAP_STATUS_COUNT, 119);
	const struct lw_point *profile = point_at(lw_map_bench, LW_MAP_BENCH_COUNT, 61500);

	TEST_ASSERT_EQUAL_UINT16(offsetof(struct lw_params, pitch_um), pitch->offset);
	TEST_ASSERT_EQUAL_UINT8(LW_TYPE_U32, pitch->type);
	TEST_ASSERT_EQUAL_HEX8(LW_POINT_WRITABLE | LW_POINT_REINDEX, pitch->flags);
	TEST_ASSERT_EQUAL_INT32(10, pitch->min);
	TEST_ASSERT_EQUAL_INT32(100000, pitch->max);
	TEST_ASSERT_EQUAL_INT32(12000, lw_params_default.pitch_um);

	TEST_ASSERT_EQUAL_HEX8(LW_POINT_WRITABLE | LW_POINT_SCOPE_LINE, baud_rate->flags);
	TEST_ASSERT_EQUAL_UINT8(8, baud_rate->allowed_count);
	TEST_ASSERT_EQUAL_INT32(1200, baud_rate->allowed[0]);
	TEST_ASSERT_EQUAL_INT32(115200, baud_rate->allowed[7]);

	TEST_ASSERT_EQUAL_HEX8(LW_POINT_WRITABLE | LW_POINT_COMMAND, command->flags);
	TEST_ASSERT_EQUAL_INT32(LW_COMMAND_CAM_DISCARD, command->max);
	TEST_ASSERT_EQUAL_INT32(LW_MODE_CENTRE, mode->max);
	TEST_ASSERT_EQUAL_INT32(LW_MODE_TRACK, mode->default_value);

	TEST_ASSERT_EQUAL_UINT16(offsetof(struct lw_status, net_edges), net_edges->offset);
	TEST_ASSERT_EQUAL_UINT8(LW_TYPE_I64, net_edges->type);
	TEST_ASSERT_EQUAL_UINT16(60, profile->count);
	TEST_ASSERT_EQUAL_HEX32(0x12345678, LW_SELF_TEST);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_points_rise_in_address_and_in_memory_without_overlap);
	RUN_TEST(test_mirrors_and_blocks_do_not_overlap);
	RUN_TEST(test_what_can_be_written_has_limits_that_hold_its_default);
	RUN_TEST(test_status_is_read_only_and_parameters_are_writable);
	RUN_TEST(test_default_parameters_are_those_of_the_table);
	RUN_TEST(test_coils_run_a_command_or_jog);
	RUN_TEST(test_discrete_inputs_fit_into_two_register_pairs_of_flags);
	RUN_TEST(test_points_are_what_the_map_says);
	return UNITY_END();
}
