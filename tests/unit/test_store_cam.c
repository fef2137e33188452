/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Two slots for cam tables: whatever happens to a write or to the memory, power-up finds the old
 * table, the new one, or none and says so.
 */
#include <errno.h>
#include <string.h>

#include <unity.h>

#include "lw/storage/store.h"

#define ROWS 3

static uint8_t memory[LW_STORE_SLOTS][LW_STORE_SLOT_SIZE];
static struct lw_store store;
static struct lw_cam_bank bank[4]; /* all different, at their ends too */

static void power_up(void)
{
	lw_store_init(&store);
	for (unsigned int slot = 0; slot < LW_STORE_SLOTS; slot++) {
		lw_store_load(&store, slot, memory[slot], sizeof(memory[slot]));
	}
}

void setUp(void)
{
	memset(memory, 0xFF, sizeof(memory));
	for (int i = 0; i < 4; i++) {
		bank[i] = (struct lw_cam_bank){
			.state = LW_CAM_BANK_STATE_ACTIVE,
			.table = {.name = {(char)('a' + i)},
				  .version = 1,
				  .row_count = ROWS,
				  .rows = {{0, i}, {100, 50}, {200, i}}},
		};
		bank[i].crc = lw_cam_bank_crc(&bank[i]);
	}
	power_up();
}

void tearDown(void)
{
}

/** Do the write that is due, cut after some bytes. @return false when it was not cut */
static bool write_cut(size_t after, bool erased_first)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;
	const size_t length = lw_store_begin_write(&store, &slot, bytes);

	TEST_ASSERT_GREATER_THAN_UINT(0, length);
	TEST_ASSERT_GREATER_OR_EQUAL_UINT(LW_STORE_CAM, slot);
	if (erased_first) {
		memset(memory[slot], 0xFF, sizeof(memory[slot]));
	}
	memcpy(memory[slot], bytes, after < length ? after : length);
	return after < length;
}

static void save(const struct lw_cam_bank *what)
{
	lw_store_save_cam(&store, what);
	TEST_ASSERT_FALSE(write_cut(SIZE_MAX, false));
	lw_store_end_write(&store, 0);
}

static enum lw_slot_state state(unsigned int slot)
{
	return store.pairs[slot / 2].state[slot % 2];
}

/** Power-up has this table to begin with. */
static void assert_table(const struct lw_cam_bank *expected)
{
	const int found = lw_store_cam_bank(&store);

	TEST_ASSERT_TRUE(found == 0 || found == 1);
	TEST_ASSERT_EQUAL_INT(LW_CAM_BANK_STATE_READY, store.cam_banks[found].state);
	TEST_ASSERT_EQUAL_MEMORY(&expected->table, &store.cam_banks[found].table,
				 sizeof(expected->table));
	TEST_ASSERT_EQUAL_HEX32(expected->crc, store.cam_banks[found].crc);
}

static void assert_none(void)
{
	TEST_ASSERT_EQUAL_INT(-1, lw_store_cam_bank(&store));
	for (int i = 0; i < LW_CAM_BANKS; i++) {
		TEST_ASSERT_EQUAL_INT(LW_CAM_BANK_STATE_EMPTY, store.cam_banks[i].state);
	}
}

static void test_an_empty_storage(void)
{
	assert_none();
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_EMPTY, state(LW_STORE_CAM));
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_EMPTY, state(LW_STORE_CAM + 1));
}

static void test_tables_go_to_the_two_slots_in_turn(void)
{
	for (unsigned int i = 0; i < 7; i++) {
		uint8_t before[LW_STORE_SLOT_SIZE];
		const unsigned int other = LW_STORE_CAM + (i + 1) % 2;

		memcpy(before, memory[other], sizeof(before));
		save(&bank[i % 4]);
		TEST_ASSERT_EQUAL_MEMORY(before, memory[other], sizeof(before));
		TEST_ASSERT_EQUAL_UINT32(i + 1, store.pairs[LW_STORE_CAM / 2].used_sequence);
		TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_GOOD, state(LW_STORE_CAM + i % 2));
		power_up();
		assert_table(&bank[i % 4]);
		if (i > 0) { /* and the one before it */
			TEST_ASSERT_EQUAL_MEMORY(
				&bank[(i - 1) % 4].table,
				&store.cam_banks[1 - lw_store_cam_bank(&store)].table,
				sizeof(bank[0].table));
		}
	}
}

static void test_the_longest_table(void)
{
	struct lw_cam_table *table = &bank[0].table;

	table->row_count = LW_CAM_ROWS_MAX;
	for (int32_t i = 0; i < LW_CAM_ROWS_MAX; i++) {
		table->rows[i] = (struct lw_cam_row){i * 70001, -i * 70001};
	}
	memset(table->name, 'n', sizeof(table->name));
	table->interpolation = LW_CAM_INTERPOLATION_TRAPEZOID;
	table->advance = -255 * 70001;
	bank[0].crc = lw_cam_bank_crc(&bank[0]);
	save(&bank[0]);
	power_up();
	assert_table(&bank[0]);
}

static void test_a_write_cut_at_any_byte_leaves_the_old_or_the_new_table(void)
{
	uint8_t start[sizeof(memory)];

	for (int saved = 0; saved < 3; saved++) {
		memcpy(start, memory, sizeof(start));
		for (int erased_first = 0; erased_first < 2; erased_first++) {
			bool cut = true;

			for (size_t after = 0; cut; after++) {
				memcpy(memory, start, sizeof(memory));
				power_up();
				lw_store_save_cam(&store, &bank[saved]);
				cut = write_cut(after, erased_first);
				power_up();
				if (!cut) {
					assert_table(&bank[saved]);
				} else if (saved == 0) {
					assert_none();
				} else {
					assert_table(&bank[saved - 1]);
				}
				/* And the next write is good. */
				save(&bank[3]);
				power_up();
				assert_table(&bank[3]);
			}
		}
		memcpy(memory, start, sizeof(memory));
		power_up();
		save(&bank[saved]);
	}
}

static void test_every_single_bit_flip_leaves_the_other_table(void)
{
	const size_t bits = (size_t)8 * (LW_RECORD_OVERHEAD +
					 2 * (LW_CAM_HEAD_WORDS + ROWS * LW_CAM_ROW_WORDS));

	save(&bank[0]);
	save(&bank[1]);
	for (unsigned int side = 0; side < 2; side++) {
		uint8_t *slot = memory[LW_STORE_CAM + side];

		for (size_t bit = 0; bit < bits; bit++) {
			slot[bit / 8] ^= (uint8_t)(1u << bit % 8);
			power_up();
			assert_table(&bank[1 - side]);
			TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_DAMAGED, state(LW_STORE_CAM + side));
			TEST_ASSERT_EQUAL_INT(LW_CAM_BANK_STATE_EMPTY, store.cam_banks[side].state);
			slot[bit / 8] ^= (uint8_t)(1u << bit % 8);
		}
	}
}

static void test_both_slots_damaged(void)
{
	save(&bank[0]);
	save(&bank[1]);
	memory[LW_STORE_CAM][40] ^= 4;
	memory[LW_STORE_CAM + 1][30] ^= 1;
	power_up();
	assert_none();
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_DAMAGED, state(LW_STORE_CAM));
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_DAMAGED, state(LW_STORE_CAM + 1));
}

/** A sound record around this many bytes of payload, and around the first rows of a bank. */
static void put_record(unsigned int side, uint16_t schema, uint32_t sequence, size_t length)
{
	(void)lw_record_seal(memory[LW_STORE_CAM + side], "LWCM", schema, sequence, length);
}

static void test_a_record_of_newer_firmware_is_kept(void)
{
	uint8_t before[LW_STORE_SLOT_SIZE];

	save(&bank[0]);
	memset(memory[LW_STORE_CAM + 1], 7, 60);
	put_record(1, 2, 2, 40);
	memcpy(before, memory[LW_STORE_CAM + 1], sizeof(before));
	power_up();
	assert_table(&bank[0]);
	TEST_ASSERT_EQUAL_INT(0, lw_store_cam_bank(&store));
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_NEWER, state(LW_STORE_CAM + 1));
	save(&bank[2]); /* over the older one */
	TEST_ASSERT_EQUAL_MEMORY(before, memory[LW_STORE_CAM + 1], sizeof(before));
	power_up();
	assert_table(&bank[2]);
}

/** Sound records whose payload is no bank: too short, too long, torn inside, of odd length. */
static void test_a_record_of_another_shape_is_refused(void)
{
	const size_t length = 2 * (LW_CAM_HEAD_WORDS + ROWS * LW_CAM_ROW_WORDS);
	uint8_t *slot = memory[LW_STORE_CAM];
	uint8_t good[LW_STORE_SLOT_SIZE];

	save(&bank[0]);
	memcpy(good, slot, sizeof(good));
	for (size_t i = 0; i < length + 20; i++) {
		memcpy(slot, good, sizeof(good));
		put_record(0, 1, 1, i);
		power_up();
		if (i == length) {
			assert_table(&bank[0]);
		} else {
			assert_none();
			TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_REFUSED, state(LW_STORE_CAM));
		}
	}
	memset(slot + LW_RECORD_HEAD_SIZE, 0x11, sizeof(memory[0]) - LW_RECORD_HEAD_SIZE);
	put_record(0, 1, 1, 2 * LW_CAM_WORDS);
	power_up();
	assert_none();
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_REFUSED, state(LW_STORE_CAM));
}

/** Longer than a bank can be, in a host's slot that is larger than it must be. */
static void test_a_record_that_is_too_long_is_refused(void)
{
	static uint8_t large[LW_STORE_SLOT_SIZE + 4096];

	memset(large, 0x22, sizeof(large));
	lw_store_init(&store);
	lw_store_load(&store, LW_STORE_CAM, large,
		      lw_record_seal(large, "LWCM", 1, 1, 2 * LW_CAM_WORDS + 4000));
	assert_none();
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_REFUSED, state(LW_STORE_CAM));
}

static void test_a_failed_write_leaves_the_other_slot(void)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;

	save(&bank[0]);
	lw_store_save_cam(&store, &bank[1]);
	TEST_ASSERT_FALSE(lw_store_saving(&store)); /* no SAVE waits for it */
	TEST_ASSERT_NOT_EQUAL(0, lw_store_begin_write(&store, &slot, bytes));
	TEST_ASSERT_FALSE(lw_store_saving(&store));
	lw_store_end_write(&store, -EIO);
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_DAMAGED, state(LW_STORE_CAM + 1));
	TEST_ASSERT_EQUAL_UINT(0, lw_store_begin_write(&store, &slot, bytes));
	power_up();
	assert_table(&bank[0]);
	save(&bank[2]);
	power_up();
	assert_table(&bank[2]);
}

static void test_parameters_then_the_table_then_the_journal(void)
{
	static const unsigned int first[] = {LW_STORE_PARAMS, LW_STORE_CAM, LW_STORE_JOURNAL};
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;

	store.journal_wanted = true;
	lw_store_save_cam(&store, &bank[0]);
	lw_store_save(&store, &lw_params_default);
	for (int i = 0; i < 3; i++) {
		TEST_ASSERT_NOT_EQUAL(0, lw_store_begin_write(&store, &slot, bytes));
		TEST_ASSERT_EQUAL_UINT(first[i], slot);
		lw_store_end_write(&store, 0);
	}
	TEST_ASSERT_EQUAL_UINT(0, lw_store_begin_write(&store, &slot, bytes));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_an_empty_storage);
	RUN_TEST(test_tables_go_to_the_two_slots_in_turn);
	RUN_TEST(test_the_longest_table);
	RUN_TEST(test_a_write_cut_at_any_byte_leaves_the_old_or_the_new_table);
	RUN_TEST(test_every_single_bit_flip_leaves_the_other_table);
	RUN_TEST(test_both_slots_damaged);
	RUN_TEST(test_a_record_of_newer_firmware_is_kept);
	RUN_TEST(test_a_record_of_another_shape_is_refused);
	RUN_TEST(test_a_record_that_is_too_long_is_refused);
	RUN_TEST(test_a_failed_write_leaves_the_other_slot);
	RUN_TEST(test_parameters_then_the_table_then_the_journal);
	return UNITY_END();
}
