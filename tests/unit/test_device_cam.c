/* SPDX-License-Identifier: Apache-2.0 */
/* A device's banks of cam tables: upload, check, putting in force, storage. */
#include "cam_rig.h"

static struct lw_cam_table hill;
static struct lw_cam_table pit;

void setUp(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
	hill = cam_hill();
	pit = cam_pit();
}

void tearDown(void)
{
}

/** A command that ran and said no. */
static void assert_said_no(enum lw_command code, enum lw_reason reason, int row)
{
	command(code);
	assert_command(code, LW_RESULT_REFUSED, reason);
	TEST_ASSERT_EQUAL_INT32(reason, status()->cam_reason);
	TEST_ASSERT_EQUAL_INT32(row, status()->cam_reason_row);
	TEST_ASSERT_EQUAL_INT32(status()->cam_reason_value, status()->command_value);
	TEST_ASSERT_EQUAL_INT32(status()->cam_reason_limit, status()->command_limit);
}

static void follow(struct lw_cam_table table)
{
	put_in_force(table);
	use_cam(LW_CAM_START_ABSOLUTE, LW_CAM_AXIS_CARRIAGE);
	track();
}

static struct lw_cam_motion *running(void)
{
	return &rig.controller->motion.cam;
}

/** Read words of a bank by FC20. */
static void read_words(uint16_t file, unsigned int first, unsigned int count, uint16_t *words)
{
	const uint8_t request[] = {20,
				   7,
				   6,
				   0,
				   (uint8_t)file,
				   (uint8_t)(first >> 8),
				   (uint8_t)first,
				   0,
				   (uint8_t)count};
	uint8_t response[LW_PDU_MAX];

	TEST_ASSERT_EQUAL_UINT(4 + 2 * count, lw_pdu_handle(&rig.device.slave.pdu, request,
							    sizeof(request), response));
	for (unsigned int i = 0; i < count; i++) {
		words[i] = (uint16_t)(response[4 + 2 * i] << 8 | response[5 + 2 * i]);
	}
}

static void assert_bank_reads(uint16_t file, const struct lw_cam_bank *expected)
{
	for (unsigned int at = 0; at < lw_cam_bank_words(expected); at += 4) {
		uint16_t words[4];

		read_words(file, at, 4, words);
		for (unsigned int i = 0; i < 4; i++) {
			TEST_ASSERT_EQUAL_HEX16(lw_cam_bank_get(expected, at + i), words[i]);
		}
	}
}

static void test_upload_check_activate(void)
{
	const struct lw_cam_bank bank = cam_bank(hill);
	const struct lw_log_record *newest;

	assert_banks(LW_CAM_BANK_STATE_EMPTY, LW_CAM_BANK_STATE_EMPTY);
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_rows);
	upload(2, &bank);
	assert_banks(LW_CAM_BANK_STATE_LOADING, LW_CAM_BANK_STATE_EMPTY);
	assert_bank_reads(2, &bank);
	assert_said_no(LW_COMMAND_CAM_ACTIVATE, LW_REASON_CAM_NO_TABLE, 0); /* not checked yet */
	command(LW_COMMAND_CAM_CHECK);
	assert_command(LW_COMMAND_CAM_CHECK, LW_RESULT_DONE, LW_REASON_NONE);
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_EMPTY);
	TEST_ASSERT_EQUAL_INT32(LW_REASON_NONE, status()->cam_reason);
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_rows);
	command(LW_COMMAND_CAM_ACTIVATE);
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_EMPTY);
	TEST_ASSERT_EQUAL_INT32(4, status()->cam_rows);
	TEST_ASSERT_EQUAL_INT64(7, status()->cam_version);
	TEST_ASSERT_EQUAL_INT64(4000, status()->cam_cycle_edges);
	/* The next one goes to the other bank, and the first can be had again. */
	put_in_force(pit);
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_ACTIVE);
	TEST_ASSERT_EQUAL_INT32(3, status()->cam_rows);
	command(LW_COMMAND_CAM_ACTIVATE);
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_READY);
	TEST_ASSERT_EQUAL_INT32(4, status()->cam_rows);
	newest = &rig.store.log.records[rig.store.log.newest % LW_LOG_RECORDS];
	TEST_ASSERT_EQUAL_UINT16(LW_EVENT_CAM_ACTIVATED, newest->event);
	TEST_ASSERT_EQUAL_INT32((int32_t)bank.table.version, newest->detail);
}

static void test_an_empty_bank_cannot_be_checked_or_activated(void)
{
	assert_said_no(LW_COMMAND_CAM_CHECK, LW_REASON_CAM_NO_TABLE, 0);
	assert_said_no(LW_COMMAND_CAM_ACTIVATE, LW_REASON_CAM_NO_TABLE, 0);
	command(LW_COMMAND_CAM_DISCARD);
	assert_command(LW_COMMAND_CAM_DISCARD, LW_RESULT_DONE, LW_REASON_NONE);
	assert_banks(LW_CAM_BANK_STATE_EMPTY, LW_CAM_BANK_STATE_EMPTY);
}

/** Registers first to first + count - 1 of the upload, values from a bank's words. */
static int write_window(uint16_t address, const struct lw_cam_bank *bank, unsigned int word,
			uint16_t count)
{
	uint8_t in[2 * LW_MAP_CAM_UPLOAD_COUNT + 240];

	for (unsigned int i = 0; i < count; i++) {
		const uint16_t value = lw_cam_bank_get(bank, word + i);

		in[2 * i] = (uint8_t)(value >> 8);
		in[2 * i + 1] = (uint8_t)value;
	}
	return lw_bank_write_registers(&rig.device.bank, address, count, in, &why);
}

static void test_upload_by_registers(void)
{
	const struct lw_cam_bank empty = rig.store.cam_banks[1];
	struct lw_cam_bank bank;
	uint8_t out[240];

	for (int32_t i = 0; i < LW_CAM_ROWS_MAX; i++) {
		hill.rows[i] = (struct lw_cam_row){100 * i, -i * (255 - i) / 4};
	}
	hill.row_count = LW_CAM_ROWS_MAX;
	memcpy(hill.name, "a full name, 16!", LW_CAM_NAME_SIZE);
	bank = cam_bank(hill);
	TEST_ASSERT_EQUAL_INT(
		0, write_window(LW_ADDRESS_CAM_UPLOAD_NAME, &bank, 0, LW_CAM_HEAD_WORDS));
	for (int32_t row = 1; row <= LW_CAM_ROWS_MAX; row += 30) {
		/* The last window reaches beyond the table: what is there is left alone. */
		TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_UPLOAD_FIRST_ROW, row));
		TEST_ASSERT_EQUAL_INT(0,
				      write_window(LW_ADDRESS_CAM_UPLOAD_ROWS, &bank,
						   LW_CAM_HEAD_WORDS + 4 * (unsigned int)(row - 1),
						   row == 241 ? 64 : 120));
	}
	memset(out, 0x11, sizeof(out));
	TEST_ASSERT_EQUAL_INT(0, lw_bank_write_registers(&rig.device.bank,
							 LW_ADDRESS_CAM_UPLOAD_ROWS + 64, 56, out,
							 &why));
	TEST_ASSERT_EQUAL_MEMORY(&empty, &rig.store.cam_banks[1], sizeof(empty));
	TEST_ASSERT_EQUAL_INT(0,
			      lw_bank_read_registers(&rig.device.bank, LW_SPACE_HOLDING,
						     LW_ADDRESS_CAM_UPLOAD_ROWS, 120, out, &why));
	for (unsigned int i = 0; i < 120; i++) {
		TEST_ASSERT_EQUAL_HEX16(i < 64 ? lw_cam_bank_get(&bank, LW_CAM_HEAD_WORDS + 960 + i)
					       : 0,
					out[2 * i] << 8 | out[2 * i + 1]);
	}
	TEST_ASSERT_EQUAL_INT32(241,
				read_register(LW_SPACE_HOLDING, LW_ADDRESS_CAM_UPLOAD_FIRST_ROW));
	for (uint16_t i = 0; i < LW_CAM_HEAD_WORDS; i++) {
		TEST_ASSERT_EQUAL_HEX16(
			lw_cam_bank_get(&bank, i),
			read_register(LW_SPACE_HOLDING, LW_ADDRESS_CAM_UPLOAD_NAME + i));
	}
	assert_bank_reads(2, &bank);
	command(LW_COMMAND_CAM_CHECK);
	assert_command(LW_COMMAND_CAM_CHECK, LW_RESULT_DONE, LW_REASON_NONE);
	/* Another word, and it must be checked again. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_UPLOAD_NAME, 0x4142));
	assert_banks(LW_CAM_BANK_STATE_LOADING, LW_CAM_BANK_STATE_EMPTY);
	assert_said_no(LW_COMMAND_CAM_CHECK, LW_REASON_CAM_CRC, 0);
}

static void test_an_upload_word_by_word(void)
{
	const struct lw_cam_bank bank = cam_bank(pit);

	for (unsigned int i = 0; i < lw_cam_bank_words(&bank); i++) {
		TEST_ASSERT_EQUAL_UINT8(0, write_words(2, &bank, i, 1));
	}
	command(LW_COMMAND_CAM_CHECK);
	assert_command(LW_COMMAND_CAM_CHECK, LW_RESULT_DONE, LW_REASON_NONE);
	/* There is no word behind the last row. */
	TEST_ASSERT_EQUAL_UINT8(2, write_words(2, &bank, LW_CAM_WORDS - 1, 2));
	TEST_ASSERT_EQUAL_UINT8(2, write_words(4, &bank, 0, 1));
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_EMPTY);
}

/** What is refused, beside hill that runs. */
struct bad {
	enum lw_reason reason;
	int row;
	int32_t value;
	int32_t limit;
	int32_t advance;
	uint16_t count;
	struct lw_cam_row rows[3];
};

static const struct bad bad_tables[] = {
	{LW_REASON_CAM_TOO_FEW_ROWS, 1, 1, 2, 0, 1, {{0, 0}}},
	{LW_REASON_CAM_TOO_MANY_ROWS, 257, 257, 256, 0, 257, {{0, 0}}},
	{LW_REASON_CAM_FIRST_MASTER, 1, 5, 0, 0, 3, {{5, 0}, {100, 5}, {200, 0}}},
	{LW_REASON_CAM_MASTER_NOT_ASCENDING, 3, 100, 101, 0, 3, {{0, 0}, {100, 5}, {100, 0}}},
	{LW_REASON_CAM_SLOPE, 1, 4010, 4000, 0, 3, {{0, 0}, {100, 401}, {300, 0}}},
	{LW_REASON_CAM_STEP_RATE, 2, 200400, 200000, 0, 3, {{0, 0}, {200, 334}, {300, 0}}},
	{LW_REASON_CAM_WRAP, 2, 10, 0, 0, 2, {{0, 0}, {1000, 10}}},
	{LW_REASON_CAM_WRAP, 2, 10, -10, -10, 2, {{0, 0}, {1000, 10}}}, /* the wrong direction */
	{LW_REASON_CAM_ADVANCES, 2, 10, 0, 10, 2, {{0, 0}, {1000, 10}}},
	{LW_REASON_CAM_BEYOND_FLANGE, 2, -8301, -8300, 0, 3, {{0, 0}, {9000, -8301}, {20000, 0}}},
};

static void assert_hill_runs(void)
{
	for (int i = 0; i < 5; i++) {
		int32_t at;

		rig_drive(1000);
		at = (int32_t)(lw_motion_read(&rig.controller->motion).net_edges % 4000);
		TEST_ASSERT_EQUAL_INT32(at < 1000   ? (3 * at + 1) / 2
					: at < 3000 ? 2500 - at
						    : -500 + (at - 2999) / 2,
					status()->position_usteps);
	}
	TEST_ASSERT_EQUAL_INT32(LW_STATE_TRACKING, status()->state);
	TEST_ASSERT_EQUAL_INT64(7, status()->cam_version);
}

static void test_what_is_wrong_is_refused_and_the_old_table_runs_on(void)
{
	follow(hill);
	for (size_t i = 0; i < sizeof(bad_tables) / sizeof(bad_tables[0]); i++) {
		const struct bad *bad = &bad_tables[i];
		struct lw_cam_table table = {.row_count = bad->count, .advance = bad->advance};
		struct lw_cam_bank bank;

		memcpy(table.rows, bad->rows, sizeof(bad->rows));
		bank = cam_bank(table);
		upload(3, &bank);
		assert_said_no(LW_COMMAND_CAM_CHECK, bad->reason, bad->row);
		TEST_ASSERT_EQUAL_INT32(bad->value, status()->cam_reason_value);
		TEST_ASSERT_EQUAL_INT32(bad->limit, status()->cam_reason_limit);
		assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_LOADING);
		assert_said_no(LW_COMMAND_CAM_ACTIVATE, LW_REASON_CAM_NO_TABLE, 0);
		assert_hill_runs();
	}
	TEST_ASSERT_TRUE(flag(LW_FLAG_LAUNCH_PERMIT));
}

/** However many words of a new table have come over those of an older one. */
static void test_a_torn_upload_is_refused_and_the_old_table_runs_on(void)
{
	const struct lw_cam_bank older = cam_bank(pit);
	struct lw_cam_bank newer;

	pit.rows[1].slave++;
	pit.version = 9;
	pit.name[0] = 'n';
	newer = cam_bank(pit);
	follow(hill);
	for (unsigned int words = 0; words <= lw_cam_bank_words(&newer); words++) {
		upload(3, &older);
		if (words > 0) {
			TEST_ASSERT_EQUAL_UINT8(0, write_words(3, &newer, 0, words));
		}
		command(LW_COMMAND_CAM_CHECK);
		/* The head differs from its first word on, the rows up to the slave's low half. */
		if (words == 0 || words > LW_CAM_HEAD_WORDS + 7) {
			assert_command(LW_COMMAND_CAM_CHECK, LW_RESULT_DONE, LW_REASON_NONE);
		} else {
			assert_command(LW_COMMAND_CAM_CHECK, LW_RESULT_REFUSED, LW_REASON_CAM_CRC);
		}
	}
	assert_hill_runs();
}

static void test_the_bank_in_force_cannot_be_written(void)
{
	const struct lw_cam_bank bank = cam_bank(pit);
	const struct lw_cam_bank in_force = cam_bank(hill);

	put_in_force(hill);
	TEST_ASSERT_EQUAL_UINT8(6, write_words(2, &bank, 0, 16));
	TEST_ASSERT_EQUAL_INT32(LW_REASON_CAM_BANK_IN_USE, status()->last_error_reason);
	assert_bank_reads(2, &in_force);
	TEST_ASSERT_EQUAL_UINT8(0, write_words(3, &bank, 0, 16));
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_LOADING);
}

static void test_the_lock_guards_tables(void)
{
	static const enum lw_command commands[] = {LW_COMMAND_CAM_CHECK, LW_COMMAND_CAM_ACTIVATE,
						   LW_COMMAND_CAM_DISCARD};
	const struct lw_cam_bank bank = cam_bank(pit);

	check_in(hill);
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_LOCK_CODE, 4711));
	command(LW_COMMAND_APPLY);
	TEST_ASSERT_EQUAL_UINT8(6, write_words(2, &bank, 0, 1));
	TEST_ASSERT_EQUAL_INT32(LW_REASON_LOCKED, status()->last_error_reason);
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_window(LW_ADDRESS_CAM_UPLOAD_NAME, &bank, 0, 2));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_LOCKED, why.reason);
	/* Where to look is no change. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_UPLOAD_FIRST_ROW, 2));
	for (size_t i = 0; i < 3; i++) {
		assert_command_refused(commands[i], LW_REASON_LOCKED);
	}
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_EMPTY);
}

/** Drive on to the next begin of a cycle of hill, less some edges. */
static void drive_to_cycle_less(int32_t edges)
{
	const int64_t net_edges = lw_motion_read(&rig.controller->motion).net_edges;

	rig_drive(4000 - (net_edges % 4000 + 4000) % 4000 - edges);
}

static void queue(struct lw_cam_table table)
{
	put_in_force(table);
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_QUEUED);
	TEST_ASSERT_TRUE(flag(LW_FLAG_CAM_QUEUED));
}

static void test_a_queued_table_waits_for_the_end_of_the_cycle(void)
{
	const struct lw_cam_bank bank = cam_bank(hill);

	follow(hill);
	rig_drive(1500);
	queue(pit);
	assert_said_no(LW_COMMAND_CAM_CHECK, LW_REASON_CAM_QUEUED, 0);
	assert_said_no(LW_COMMAND_CAM_ACTIVATE, LW_REASON_CAM_QUEUED, 0);
	TEST_ASSERT_EQUAL_UINT8(6, write_words(3, &bank, 0, 16));
	TEST_ASSERT_EQUAL_INT(-EBUSY, write_window(LW_ADDRESS_CAM_UPLOAD_NAME, &bank, 0, 2));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_CAM_BANK_IN_USE, why.reason);
	drive_to_cycle_less(1);
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_QUEUED);
	TEST_ASSERT_EQUAL_INT32(4, status()->cam_rows);
	rig_drive(1);
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_ACTIVE);
	TEST_ASSERT_FALSE(flag(LW_FLAG_CAM_QUEUED));
	TEST_ASSERT_EQUAL_INT32(3, status()->cam_rows);
	TEST_ASSERT_EQUAL_INT32(0, status()->position_usteps);
	rig_drive(500);
	TEST_ASSERT_EQUAL_INT32(-900, status()->position_usteps);
	/* And the former one again, backward. */
	command(LW_COMMAND_CAM_ACTIVATE);
	rig_drive(-500 - 1000);
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_READY);
	TEST_ASSERT_EQUAL_INT32(-500, status()->position_usteps);
}

static void test_a_steeper_queued_table_gets_room_for_its_steps(void)
{
	static const struct lw_cam_row steep[] = {{0, 0}, {1000, 3300}, {2000, 0}};

	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_CAM_STEPS_PER_S_MAX, 210000));
	follow(pit);
	TEST_ASSERT_EQUAL_UINT8(3, running()->steps_max); /* 3.5 by the rate */
	queue(CAM_TABLE(steep));
	TEST_ASSERT_EQUAL_UINT8(4, running()->steps_max);
	/* A flatter one takes none away. */
	command(LW_COMMAND_CAM_DISCARD);
	queue(hill);
	TEST_ASSERT_EQUAL_UINT8(4, running()->steps_max);
}

static void test_discard(void)
{
	check_in(hill);
	command(LW_COMMAND_CAM_DISCARD);
	assert_banks(LW_CAM_BANK_STATE_EMPTY, LW_CAM_BANK_STATE_EMPTY);
	TEST_ASSERT_EQUAL_INT32(0,
				read_register(LW_SPACE_HOLDING, LW_ADDRESS_CAM_UPLOAD_ROW_COUNT));
	follow(hill);
	queue(pit);
	command(LW_COMMAND_CAM_DISCARD);
	assert_command(LW_COMMAND_CAM_DISCARD, LW_RESULT_DONE, LW_REASON_NONE);
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_READY);
	TEST_ASSERT_FALSE(flag(LW_FLAG_CAM_QUEUED));
	assert_hill_runs();
	/* A half upload. */
	upload(3, &(const struct lw_cam_bank){.table = {.row_count = 9}});
	command(LW_COMMAND_CAM_DISCARD);
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_EMPTY);
	assert_hill_runs();
}

static void test_a_discard_that_comes_too_late(void)
{
	follow(hill);
	queue(pit);
	drive_to_cycle_less(1);
	rig_turn(2); /* no tick since */
	assert_said_no(LW_COMMAND_CAM_DISCARD, LW_REASON_CAM_BANK_IN_USE, 0);
	rig_tick();
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_ACTIVE);
}

static void test_a_cam_that_stops_does_not_keep_a_table_waiting(void)
{
	follow(hill);
	rig_drive(1234);
	rig_rest();
	queue(pit);
	command(LW_COMMAND_STOP);
	rig_tick();
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_ACTIVE);
	TEST_ASSERT_NULL(running()->next);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MODE, LW_MODE_TRACK));
	rig_run_to(LW_STATE_TRACKING);
	TEST_ASSERT_EQUAL_PTR(&rig.store.cam_banks[1].table, running()->cam.table);
}

/** Stopped and other parameters applied before any tick: they are the queued table's too. */
static void test_parameters_that_a_queued_table_does_not_fit(void)
{
	static const struct lw_cam_row steep[] = {{0, 0}, {100, 160}, {500, 0}};

	follow(hill);
	rig_rest();
	queue(CAM_TABLE(steep));
	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_CAM_STEPS_PER_S_MAX, 93000));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);
	rig_tick();
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_LOADING);
	TEST_ASSERT_EQUAL_INT32(4, status()->cam_rows);
}

static void test_a_table_that_begins_elsewhere_does_not_join(void)
{
	static const struct lw_cam_row elsewhere[] = {{0, 3}, {100, 3}};

	follow(hill);
	check_in(CAM_TABLE(elsewhere));
	assert_said_no(LW_COMMAND_CAM_ACTIVATE, LW_REASON_CAM_DOES_NOT_JOIN, 1);
	TEST_ASSERT_EQUAL_INT32(3, status()->cam_reason_value);
	TEST_ASSERT_EQUAL_INT32(0, status()->cam_reason_limit);
	assert_banks(LW_CAM_BANK_STATE_ACTIVE, LW_CAM_BANK_STATE_READY);
	assert_hill_runs();
}

/** Relative: every table joins that stays between the flanges from where the carriage is. */
static void test_a_relative_joint(void)
{
	static const struct lw_cam_row up[] = {{0, 1000}, {4000, 1900}, {8000, 1000}};
	static const struct lw_cam_row far_up[] = {{0, 1000}, {10000, 18000}, {20000, 1000}};
	static const struct lw_cam_row far_down[] = {{0, 1000}, {10000, -1000}, {20000, 1000}};
	static const struct lw_cam_row base[] = {{0, 0}, {4000, 2000}, {8000, 0}};
	int32_t begin;

	put_in_force(CAM_TABLE(base));
	use_cam(LW_CAM_START_RELATIVE, LW_CAM_AXIS_CARRIAGE);
	track(); /* near the minus flange */
	begin = status()->position_usteps;
	rig_drive(2000);
	check_in(CAM_TABLE(far_up));
	assert_said_no(LW_COMMAND_CAM_ACTIVATE, LW_REASON_CAM_BEYOND_FLANGE, 2);
	check_in(CAM_TABLE(far_down));
	assert_said_no(LW_COMMAND_CAM_ACTIVATE, LW_REASON_CAM_BEYOND_FLANGE, 2);
	TEST_ASSERT_EQUAL_INT32(begin - 2000, status()->cam_reason_value);
	running()->owed_usteps = 9; /* where it will be counts, not where it is */
	command(LW_COMMAND_CAM_ACTIVATE);
	TEST_ASSERT_EQUAL_INT32(begin - 2000 + 9, status()->cam_reason_value);
	running()->owed_usteps = 0;
	check_in(CAM_TABLE(up));
	command(LW_COMMAND_CAM_ACTIVATE);
	assert_command(LW_COMMAND_CAM_ACTIVATE, LW_RESULT_DONE, LW_REASON_NONE);
	rig_drive(6000 + 4000);
	TEST_ASSERT_EQUAL_INT32(begin + 900, status()->position_usteps);
	/* The shift of the joint is in the next one's place. */
	check_in(CAM_TABLE(far_down));
	assert_said_no(LW_COMMAND_CAM_ACTIVATE, LW_REASON_CAM_BEYOND_FLANGE, 2);
	TEST_ASSERT_EQUAL_INT32(begin - 2000, status()->cam_reason_value);
}

/** The same while the cam waits for the begin of a cycle. */
static void test_a_joint_while_it_waits(void)
{
	static const struct lw_cam_row widest[] = {
		{0, 0}, {10000, 8300}, {30000, -8300}, {40000, 0}};

	rig_turn(1000);
	rig_rest();
	put_in_force(hill);
	use_cam(LW_CAM_START_NEXT_CYCLE, LW_CAM_AXIS_CARRIAGE);
	track();
	TEST_ASSERT_EQUAL_INT32(1, status()->cam_waiting);
	queue(CAM_TABLE(widest));
	rig_drive(3000);
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_ACTIVE);
	rig_drive(500);
	TEST_ASSERT_EQUAL_INT32(415, status()->position_usteps);
}

static void test_apply_is_refused_if_the_table_in_force_does_not_fit(void)
{
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MOTION_PROFILE, LW_MOTION_PROFILE_CAM));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_REFUSED, LW_REASON_CAM_NO_TABLE);
	TEST_ASSERT_EQUAL_INT32(LW_ADDRESS_MOTION_PROFILE, status()->command_address);
	put_in_force(hill);
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);

	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_SLAVE_USTEPS, 10));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_REFUSED, LW_REASON_CAM_SLOPE);
	TEST_ASSERT_EQUAL_INT32(15000, status()->command_value);
	TEST_ASSERT_EQUAL_INT32(4000, status()->command_limit);
	TEST_ASSERT_EQUAL_INT32(1, status()->cam_reason_row);
	TEST_ASSERT_EQUAL_INT32(1, rig.device.active.cam_slave_usteps);
	/* The screw does not ask for the table; going back to the cam does. */
	TEST_ASSERT_EQUAL_INT(0,
			      write_register(LW_ADDRESS_MOTION_PROFILE, LW_MOTION_PROFILE_SCREW));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);
	TEST_ASSERT_EQUAL_INT32(0, status()->launch_inhibit >> LW_LAUNCH_INHIBIT_CAM & 1);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_MOTION_PROFILE, LW_MOTION_PROFILE_CAM));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_REFUSED, LW_REASON_CAM_SLOPE);
}

static void test_a_checked_table_is_checked_again_under_other_parameters(void)
{
	check_in(hill);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_SLAVE_USTEPS, 2));
	command(LW_COMMAND_APPLY);
	assert_banks(LW_CAM_BANK_STATE_READY, LW_CAM_BANK_STATE_EMPTY);
	TEST_ASSERT_EQUAL_UINT32(3000, rig.store.cam_banks[0].statistics.slope_max_permille);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_CAM_SLAVE_USTEPS, 3));
	command(LW_COMMAND_APPLY);
	assert_banks(LW_CAM_BANK_STATE_LOADING, LW_CAM_BANK_STATE_EMPTY);
	assert_said_no(LW_COMMAND_CAM_ACTIVATE, LW_REASON_CAM_NO_TABLE, 0);
}

static void test_where_a_cam_stands_is_not_kept_for_resuming(void)
{
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_RESUME, 1));
	follow(hill);
	rig_turn(700);
	rig_ticks(500);
	TEST_ASSERT_TRUE(running()->on && rig.controller->speed.at_rest);
	TEST_ASSERT_EQUAL_INT32(0, status()->resume_direction);
	TEST_ASSERT_FALSE(rig.controller->resume.known);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_upload_check_activate);
	RUN_TEST(test_an_empty_bank_cannot_be_checked_or_activated);
	RUN_TEST(test_upload_by_registers);
	RUN_TEST(test_an_upload_word_by_word);
	RUN_TEST(test_what_is_wrong_is_refused_and_the_old_table_runs_on);
	RUN_TEST(test_a_torn_upload_is_refused_and_the_old_table_runs_on);
	RUN_TEST(test_the_bank_in_force_cannot_be_written);
	RUN_TEST(test_the_lock_guards_tables);
	RUN_TEST(test_a_queued_table_waits_for_the_end_of_the_cycle);
	RUN_TEST(test_a_steeper_queued_table_gets_room_for_its_steps);
	RUN_TEST(test_discard);
	RUN_TEST(test_a_discard_that_comes_too_late);
	RUN_TEST(test_a_cam_that_stops_does_not_keep_a_table_waiting);
	RUN_TEST(test_parameters_that_a_queued_table_does_not_fit);
	RUN_TEST(test_a_table_that_begins_elsewhere_does_not_join);
	RUN_TEST(test_a_relative_joint);
	RUN_TEST(test_a_joint_while_it_waits);
	RUN_TEST(test_apply_is_refused_if_the_table_in_force_does_not_fit);
	RUN_TEST(test_a_checked_table_is_checked_again_under_other_parameters);
	RUN_TEST(test_where_a_cam_stands_is_not_kept_for_resuming);
	return UNITY_END();
}
