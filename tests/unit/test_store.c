/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Two slots for each kind of record: whatever happens to a write or to the memory, power-up finds
 * the old set, the new set, or factory values and says so.
 */
#include <errno.h>
#include <string.h>

#include <unity.h>

#include "lw/storage/store.h"
#include "record_schema_1.h"

/** A memory of slots that a write may be cut in. */
struct memory {
	uint8_t slots[LW_STORE_SLOTS][LW_STORE_SLOT_SIZE];
};

/** What a slot holds behind the place where a write was cut. */
enum rest {
	REST_OLD,    /* a file, written in place */
	REST_ERASED, /* a flash that was erased first */
	REST_ZERO,   /* a file that was cut to length 0 first */
	REST_COUNT,
};

static struct memory memory;
static struct lw_store store;
static struct lw_params set[4]; /* all different in two places far apart */

static void power_up(void)
{
	lw_store_init(&store);
	for (unsigned int slot = 0; slot < LW_STORE_SLOTS; slot++) {
		lw_store_load(&store, slot, memory.slots[slot], sizeof(memory.slots[slot]));
	}
}

void setUp(void)
{
	memset(&memory, 0xFF, sizeof(memory));
	for (size_t i = 0; i < sizeof(set) / sizeof(set[0]); i++) {
		set[i] = lw_params_default;
		set[i].encoder_ratio_numerator = 4 + (int32_t)i;
		set[i].unit_id = 20 + (int32_t)i;
		set[i].jog_hold_ms = 300 + (int32_t)i;
	}
	power_up();
}

void tearDown(void)
{
}

/** Do the write that is due, cut after some bytes. @return false when it was not cut */
static bool write_cut(size_t after, enum rest rest)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;
	const size_t length = lw_store_begin_write(&store, &slot, bytes);
	uint8_t *at = memory.slots[slot];

	TEST_ASSERT_GREATER_THAN_UINT(0, length);
	if (rest != REST_OLD) {
		memset(at, rest == REST_ERASED ? 0xFF : 0x00, sizeof(memory.slots[slot]));
	}
	memcpy(at, bytes, after < length ? after : length);
	return after < length;
}

static void write_whole(void)
{
	TEST_ASSERT_FALSE(write_cut(SIZE_MAX, REST_OLD));
	lw_store_end_write(&store, 0);
}

static void save(const struct lw_params *params)
{
	lw_store_save(&store, params);
	write_whole();
}

static void add_event(uint16_t event)
{
	lw_log_add(&store.log, (struct lw_log_record){.event = event, .detail = -event});
}

static void keep_journal(void)
{
	store.journal_wanted = true;
	write_whole();
}

static enum lw_slot_state state(unsigned int slot)
{
	return store.pairs[slot / 2].state[slot % 2];
}

static void assert_params(const struct lw_params *expected)
{
	TEST_ASSERT_TRUE(lw_store_has_params(&store));
	TEST_ASSERT_EQUAL_MEMORY(expected, &store.params, sizeof(*expected));
}

static void assert_defaults(void)
{
	TEST_ASSERT_FALSE(lw_store_has_params(&store));
	TEST_ASSERT_EQUAL_MEMORY(&lw_params_default, &store.params, sizeof(store.params));
}

static void test_an_empty_storage(void)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;

	assert_defaults();
	for (unsigned int i = 0; i < LW_STORE_SLOTS; i++) {
		TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_EMPTY, state(i));
	}
	TEST_ASSERT_EQUAL_UINT32(0, store.log.newest);
	TEST_ASSERT_EQUAL_UINT(0, lw_store_begin_write(&store, &slot, bytes));
}

static void test_saves_go_to_the_two_slots_in_turn(void)
{
	for (uint32_t i = 0; i < 7; i++) {
		const struct memory before = memory;
		const unsigned int target = i % 2;

		save(&set[i % 4]);
		TEST_ASSERT_EQUAL_MEMORY(before.slots[1 - target], memory.slots[1 - target],
					 LW_STORE_SLOT_SIZE);
		TEST_ASSERT_EQUAL_UINT32(i + 1, store.pairs[0].used_sequence);
		power_up();
		assert_params(&set[i % 4]);
		TEST_ASSERT_EQUAL_UINT32(i + 1, store.pairs[0].used_sequence);
		TEST_ASSERT_EQUAL_UINT16(LW_PARAM_RECORD_SCHEMA, store.pairs[0].used_schema);
	}
}

static void test_slots_may_be_loaded_in_any_order(void)
{
	save(&set[0]);
	save(&set[1]);
	lw_store_init(&store);
	for (unsigned int slot = LW_STORE_SLOTS; slot-- > 0;) {
		lw_store_load(&store, slot, memory.slots[slot], sizeof(memory.slots[slot]));
	}
	assert_params(&set[1]);
	save(&set[2]);
	power_up();
	assert_params(&set[2]);
}

static void test_the_sequence_number_may_wrap(void)
{
	(void)lw_param_record_encode(&set[0], UINT32_MAX - 1, memory.slots[1]);
	power_up();
	for (int i = 1; i < 4; i++) {
		save(&set[i]);
		power_up();
		assert_params(&set[i]);
	}
	TEST_ASSERT_EQUAL_UINT32(1, store.pairs[0].used_sequence);
}

/** Every save of a life, cut after every number of bytes: the old or the new set. */
static void test_a_save_cut_at_any_byte_leaves_the_old_or_the_new_set(void)
{
	for (int saved = 0; saved < 3; saved++) {
		const struct memory start = memory;

		for (int rest = 0; rest < REST_COUNT; rest++) {
			for (size_t after = 0;; after++) {
				bool cut;

				memory = start;
				power_up();
				lw_store_save(&store, &set[saved]);
				cut = write_cut(after, (enum rest)rest);
				power_up();
				if (!cut) {
					assert_params(&set[saved]);
					break;
				}
				if (saved == 0) {
					assert_defaults();
				} else {
					assert_params(&set[saved - 1]);
				}
				/* And the next save is good. */
				save(&set[3]);
				power_up();
				assert_params(&set[3]);
			}
		}
		memory = start;
		power_up();
		save(&set[saved]);
	}
}

static void test_a_journal_cut_at_any_byte_leaves_the_old_or_the_new_one(void)
{
	struct memory start;

	for (uint16_t event = 1; event <= 3; event++) {
		add_event(event);
		store.counters.boots = event;
		keep_journal();
	}
	start = memory;
	for (int rest = 0; rest < REST_COUNT; rest++) {
		for (size_t after = 0;; after++) {
			bool cut;

			memory = start;
			power_up();
			add_event(4);
			store.counters.boots = 4;
			store.journal_wanted = true;
			cut = write_cut(after, (enum rest)rest);
			power_up();
			TEST_ASSERT_EQUAL_UINT32(cut ? 3 : 4, store.log.newest);
			TEST_ASSERT_EQUAL_UINT32(cut ? 3 : 4, store.counters.boots);
			TEST_ASSERT_EQUAL_UINT16(cut ? 3 : 4, lw_log_count(&store.log));
			if (!cut) {
				break;
			}
		}
	}
}

static struct lw_look look_with(uint32_t causes)
{
	struct lw_look look = {.causes = causes, .standing_millirev = 1003 * causes};

	look.marks[LW_LOOK_ROPE_STANDING] = (struct lw_look_mark){-(int32_t)causes, causes};
	return look;
}

static void test_a_look_cut_at_any_byte_leaves_the_old_or_the_new_one(void)
{
	const struct lw_look looks[] = {look_with(0), look_with(9), look_with(17), look_with(0)};

	for (size_t i = 1; i < sizeof(looks) / sizeof(looks[0]); i++) {
		const struct memory start = memory;

		for (int rest = 0; rest < REST_COUNT; rest++) {
			bool cut = true;

			for (size_t after = 0; cut; after++) {
				memory = start;
				power_up();
				TEST_ASSERT_EQUAL_MEMORY(&looks[i - 1], &store.look,
							 sizeof(store.look));
				lw_store_save_look(&store, &looks[i]);
				cut = write_cut(after, (enum rest)rest);
				power_up();
				TEST_ASSERT_EQUAL_MEMORY(&looks[cut ? i - 1 : i], &store.look,
							 sizeof(store.look));
			}
		}
		memory = start;
		power_up();
		lw_store_save_look(&store, &looks[i]);
		write_whole();
		TEST_ASSERT_EQUAL_MEMORY(&looks[i], &store.look, sizeof(store.look));
	}
}

static void test_a_look_of_another_firmware(void)
{
	const struct lw_look look = look_with(17);
	uint8_t *at = memory.slots[LW_STORE_LOOK];

	/* A cause more than this one knows: what it knows is there. */
	(void)lw_look_record_encode(&look, 1, at);
	at[LW_RECORD_HEAD_SIZE] |= 0x80;
	memset(at + LW_LOOK_RECORD_SIZE - 4, 7, 8);
	(void)lw_record_seal(at, "LWRL", LW_LOOK_RECORD_SCHEMA, 1,
			     LW_LOOK_RECORD_SIZE - LW_RECORD_OVERHEAD + 8);
	power_up();
	TEST_ASSERT_EQUAL_MEMORY(&look, &store.look, sizeof(look));

	/* Fewer; then another schema, and other shapes. */
	(void)lw_record_seal(at, "LWRL", LW_LOOK_RECORD_SCHEMA, 1, 12 + 8);
	at[LW_RECORD_HEAD_SIZE] = 0;
	(void)lw_record_seal(at, "LWRL", LW_LOOK_RECORD_SCHEMA, 1, 12 + 8);
	power_up();
	TEST_ASSERT_EQUAL_UINT32(17, store.look.causes);
	TEST_ASSERT_EQUAL_INT32(0, store.look.marks[LW_LOOK_ROPE_STANDING].position_um);
	(void)lw_record_seal(at, "LWRL", LW_LOOK_RECORD_SCHEMA + 1, 1, 12 + 8);
	power_up();
	TEST_ASSERT_EQUAL_UINT32(0, store.look.causes);
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_NEWER, state(LW_STORE_LOOK));
	for (size_t length = 0; length < 20; length++) {
		(void)lw_record_seal(at, "LWRL", LW_LOOK_RECORD_SCHEMA, 1, length);
		power_up();
		TEST_ASSERT_EQUAL_INT(length == 12 ? LW_SLOT_STATE_GOOD : LW_SLOT_STATE_REFUSED,
				      state(LW_STORE_LOOK));
	}
}

static void test_what_needs_a_look_goes_before_all_else(void)
{
	const struct lw_look look = look_with(1);

	add_event(1);
	store.journal_wanted = true;
	lw_store_save(&store, &set[0]);
	lw_store_save_look(&store, &look);
	write_whole();
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_GOOD, state(LW_STORE_LOOK));
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_EMPTY, state(LW_STORE_PARAMS));
}

static void test_every_single_bit_flip_of_a_pair_leaves_one_of_the_two_sets(void)
{
	struct memory good;

	save(&set[0]);
	save(&set[1]); /* slot 1, the newer one */
	good = memory;
	for (unsigned int slot = 0; slot < 2; slot++) {
		for (size_t bit = 0; bit < (size_t)8 * LW_PARAM_RECORD_SIZE; bit++) {
			memory = good;
			memory.slots[slot][bit / 8] ^= (uint8_t)(1u << bit % 8);
			power_up();
			assert_params(slot == 0 ? &set[1] : &set[0]);
			TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_DAMAGED, state(slot));
			TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_GOOD, state(1 - slot));
		}
	}
}

static void test_a_flip_in_both_slots_is_noticed(void)
{
	struct memory good;

	save(&set[0]);
	save(&set[1]);
	good = memory;
	for (size_t bit = 0; bit < (size_t)8 * LW_PARAM_RECORD_SIZE; bit++) {
		const size_t other = (bit * 7919 + 13) % ((size_t)8 * LW_PARAM_RECORD_SIZE);

		memory = good;
		memory.slots[0][bit / 8] ^= (uint8_t)(1u << bit % 8);
		memory.slots[1][other / 8] ^= (uint8_t)(1u << other % 8);
		power_up();
		assert_defaults();
		TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_DAMAGED, state(0));
		TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_DAMAGED, state(1));
	}
}

static void test_every_single_bit_flip_of_the_journal_leaves_the_other_one(void)
{
	struct memory good;

	add_event(1);
	keep_journal();
	add_event(2);
	keep_journal();
	good = memory;
	for (size_t bit = 0; bit < 8 * (LW_RECORD_OVERHEAD + 16 + 2 * LW_LOG_RECORD_SIZE); bit++) {
		memory = good;
		memory.slots[LW_STORE_JOURNAL + 1][bit / 8] ^= (uint8_t)(1u << bit % 8);
		power_up();
		TEST_ASSERT_EQUAL_UINT32(1, store.log.newest);
	}
}

static void test_a_failed_write_is_tried_again_in_the_same_slot(void)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;

	save(&set[0]);
	lw_store_save(&store, &set[1]);
	TEST_ASSERT_TRUE(lw_store_saving(&store));
	(void)lw_store_begin_write(&store, &slot, bytes);
	TEST_ASSERT_EQUAL_UINT(1, slot);
	TEST_ASSERT_TRUE(lw_store_saving(&store));
	TEST_ASSERT_EQUAL_UINT(0, lw_store_begin_write(&store, &slot, bytes));
	lw_store_end_write(&store, -EIO);
	TEST_ASSERT_FALSE(lw_store_saving(&store));
	assert_params(&set[0]);
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_DAMAGED, state(1));
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_GOOD, state(0));

	save(&set[1]);
	assert_params(&set[1]);
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_GOOD, state(1));
	power_up();
	assert_params(&set[1]);
}

static void test_a_report_without_a_write_changes_nothing(void)
{
	save(&set[0]);
	lw_store_end_write(&store, -EIO);
	assert_params(&set[0]);
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_GOOD, state(0));
	TEST_ASSERT_EQUAL_UINT32(1, store.pairs[0].used_sequence);
}

static void test_parameters_go_before_the_journal(void)
{
	add_event(1);
	store.journal_wanted = true;
	lw_store_save(&store, &set[0]);
	write_whole();
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_GOOD, state(LW_STORE_PARAMS));
	write_whole();
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_GOOD, state(LW_STORE_JOURNAL));
	power_up();
	assert_params(&set[0]);
	TEST_ASSERT_EQUAL_UINT32(1, store.log.newest);
}

static void test_the_first_save_after_schema_1_keeps_it_in_its_slot(void)
{
	const struct lw_params expected = record_schema_1_params();

	memset(&memory, 0, sizeof(memory));
	memcpy(memory.slots[0], record_schema_1, sizeof(record_schema_1));
	power_up();
	assert_params(&expected);
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_OLDER, state(0));
	TEST_ASSERT_EQUAL_UINT16(1, store.pairs[0].used_schema);
	save(&set[1]);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(record_schema_1, memory.slots[0], sizeof(record_schema_1));
	power_up();
	assert_params(&set[1]);
	TEST_ASSERT_EQUAL_UINT16(LW_PARAM_RECORD_SCHEMA, store.pairs[0].used_schema);
	save(&set[2]);
	power_up();
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_GOOD, state(0));
	assert_params(&set[2]);
}

/** What newer firmware has stored in a slot of the parameters. */
static void put_newer(unsigned int slot, uint32_t sequence)
{
	memset(memory.slots[slot] + LW_RECORD_HEAD_SIZE, 0x5A, 40);
	(void)lw_record_seal(memory.slots[slot], "LWPR", LW_PARAM_RECORD_SCHEMA + 1, sequence, 40);
}

static void test_a_record_of_newer_firmware_is_not_used_and_survives_a_save(void)
{
	struct memory before;

	save(&set[0]); /* slot 0, sequence 1 */
	put_newer(1, 2);
	before = memory;
	power_up();
	assert_params(&set[0]);
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_NEWER, state(1));
	save(&set[1]);
	TEST_ASSERT_EQUAL_MEMORY(before.slots[1], memory.slots[1], LW_STORE_SLOT_SIZE);
	power_up();
	assert_params(&set[1]);
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_NEWER, state(1));
	save(&set[2]); /* now the newer one is the older */
	power_up();
	assert_params(&set[2]);
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_GOOD, state(1));
}

static void test_two_records_of_newer_firmware(void)
{
	struct memory before;

	put_newer(0, 8);
	put_newer(1, 7);
	before = memory;
	power_up();
	assert_defaults();
	save(&set[0]);
	TEST_ASSERT_EQUAL_MEMORY(before.slots[0], memory.slots[0], LW_STORE_SLOT_SIZE);
	power_up();
	assert_params(&set[0]);
	TEST_ASSERT_EQUAL_UINT32(9, store.pairs[0].used_sequence);
}

static void test_a_set_that_contradicts_itself_is_not_used(void)
{
	struct lw_params bad = set[1];

	bad.flange_plus_um = 0;
	save(&set[0]);
	(void)lw_param_record_encode(&bad, 2, memory.slots[1]);
	power_up();
	assert_params(&set[0]);
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_REFUSED, state(1));
	memset(memory.slots[0], 0xFF, sizeof(memory.slots[0]));
	power_up();
	assert_defaults();
}

static void test_log_and_counters_survive(void)
{
	const struct lw_counters counters = {
		.boots = 3, .watchdog_resets = 2, .powered_s = 0x12345678, .tracking_s = 99};

	for (uint16_t event = 1; event <= 100; event++) {
		add_event(event);
	}
	store.counters = counters;
	TEST_ASSERT_EQUAL_UINT32(0, store.log_stored);
	keep_journal();
	TEST_ASSERT_EQUAL_UINT32(100, store.log_stored);
	power_up();
	TEST_ASSERT_EQUAL_MEMORY(&counters, &store.counters, sizeof(counters));
	TEST_ASSERT_EQUAL_UINT32(100, store.log.newest);
	TEST_ASSERT_EQUAL_UINT32(100, store.log_stored);
	TEST_ASSERT_EQUAL_UINT16(LW_LOG_RECORDS, lw_log_count(&store.log));
	for (uint32_t sequence = 100 - LW_LOG_RECORDS + 1; sequence <= 100; sequence++) {
		const struct lw_log_record *event = &store.log.records[sequence % LW_LOG_RECORDS];

		TEST_ASSERT_EQUAL_UINT32(sequence, event->sequence);
		TEST_ASSERT_EQUAL_INT32(-(int32_t)sequence, event->detail);
	}
}

static void test_an_event_during_the_write_is_not_taken_for_stored(void)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;

	add_event(1);
	store.journal_wanted = true;
	(void)lw_store_begin_write(&store, &slot, bytes);
	add_event(2);
	lw_store_end_write(&store, 0);
	TEST_ASSERT_EQUAL_UINT32(1, store.log_stored);
	TEST_ASSERT_EQUAL_UINT32(2, store.log.newest);
}

static void test_a_journal_of_another_schema_or_shape_is_kept_out(void)
{
	uint8_t *at = memory.slots[LW_STORE_JOURNAL];

	memset(at + LW_RECORD_HEAD_SIZE, 1, 64);
	(void)lw_record_seal(at, "LWJL", 2, 1, 48);
	power_up();
	TEST_ASSERT_EQUAL_INT(LW_SLOT_STATE_NEWER, state(LW_STORE_JOURNAL));
	for (size_t length = 0; length < 48; length++) {
		(void)lw_record_seal(at, "LWJL", 1, 1, length);
		power_up();
		TEST_ASSERT_EQUAL_INT(length == 16 ? LW_SLOT_STATE_GOOD : LW_SLOT_STATE_REFUSED,
				      state(LW_STORE_JOURNAL));
		TEST_ASSERT_EQUAL_UINT16(0, lw_log_count(&store.log));
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_an_empty_storage);
	RUN_TEST(test_saves_go_to_the_two_slots_in_turn);
	RUN_TEST(test_slots_may_be_loaded_in_any_order);
	RUN_TEST(test_the_sequence_number_may_wrap);
	RUN_TEST(test_a_save_cut_at_any_byte_leaves_the_old_or_the_new_set);
	RUN_TEST(test_a_journal_cut_at_any_byte_leaves_the_old_or_the_new_one);
	RUN_TEST(test_a_look_cut_at_any_byte_leaves_the_old_or_the_new_one);
	RUN_TEST(test_a_look_of_another_firmware);
	RUN_TEST(test_what_needs_a_look_goes_before_all_else);
	RUN_TEST(test_every_single_bit_flip_of_a_pair_leaves_one_of_the_two_sets);
	RUN_TEST(test_a_flip_in_both_slots_is_noticed);
	RUN_TEST(test_every_single_bit_flip_of_the_journal_leaves_the_other_one);
	RUN_TEST(test_a_failed_write_is_tried_again_in_the_same_slot);
	RUN_TEST(test_a_report_without_a_write_changes_nothing);
	RUN_TEST(test_parameters_go_before_the_journal);
	RUN_TEST(test_the_first_save_after_schema_1_keeps_it_in_its_slot);
	RUN_TEST(test_a_record_of_newer_firmware_is_not_used_and_survives_a_save);
	RUN_TEST(test_two_records_of_newer_firmware);
	RUN_TEST(test_a_set_that_contradicts_itself_is_not_used);
	RUN_TEST(test_log_and_counters_survive);
	RUN_TEST(test_an_event_during_the_write_is_not_taken_for_stored);
	RUN_TEST(test_a_journal_of_another_schema_or_shape_is_kept_out);
	return UNITY_END();
}
