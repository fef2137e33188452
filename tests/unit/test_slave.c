/* SPDX-License-Identifier: Apache-2.0 */
/* The Modbus RTU slave as a whole: frames in, frames out. */
#include <unity.h>

#include "lw/modbus/crc16.h"
#include "lw/modbus/slave.h"
#include "small_bank.h"

#define SILENCE_US 1750u
#define BYTE_US    287u /* 38,400 baud */
#define UNIT_ID    7u

static const struct lw_slave_config config = {
	.unit_id = UNIT_ID,
	.rtu = {.silence_us = SILENCE_US},
	.byte_us = BYTE_US,
	.pdu = {.bank = &small.bank, .device_id = {"vend", "code", "1.2", "url", "name", "model"}},
};

static struct lw_slave slave;
static uint64_t now_us;
static uint8_t tx[LW_RTU_FRAME_MAX];
static size_t tx_length;

void setUp(void)
{
	small_init();
	now_us = 5000;
	lw_slave_init(&slave, &config, now_us);
}

void tearDown(void)
{
}

#define BYTES(...) (const uint8_t[]){__VA_ARGS__}, sizeof((const uint8_t[]){__VA_ARGS__})

/* Put a frame, completed by its CRC, on the line now. */
static void put(const uint8_t *bytes, size_t length)
{
	uint8_t frame[LW_RTU_FRAME_MAX];

	memcpy(frame, bytes, length);
	lw_slave_receive(&slave, frame, lw_rtu_seal(frame, length), now_us);
}

static void let_silence_pass(void)
{
	now_us += SILENCE_US;
	tx_length = lw_slave_poll(&slave, now_us, tx);
}

static void send(const uint8_t *bytes, size_t length)
{
	put(bytes, length);
	let_silence_pass();
}

static void assert_answer(const uint8_t *bytes, size_t length)
{
	uint8_t frame[LW_RTU_FRAME_MAX];

	memcpy(frame, bytes, length);
	TEST_ASSERT_EQUAL_UINT(lw_rtu_seal(frame, length), tx_length);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(frame, tx, tx_length);
}

static void assert_counter(enum lw_bus_counter counter, uint32_t expected)
{
	TEST_ASSERT_EQUAL_UINT32(expected, slave.pdu.counters[counter]);
}

static void test_answers_its_own_unit_id(void)
{
	TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, lw_slave_deadline_us(&slave));
	put(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	TEST_ASSERT_EQUAL_UINT64(now_us + SILENCE_US, lw_slave_deadline_us(&slave));
	TEST_ASSERT_EQUAL_UINT(0, lw_slave_poll(&slave, now_us + SILENCE_US - 1, tx));
	let_silence_pass();
	assert_answer(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	TEST_ASSERT_EQUAL_INT32(42, small.values.level);
	assert_counter(LW_BUS_MESSAGES, 1);
	assert_counter(LW_BUS_SERVER_MESSAGES, 1);
	assert_counter(LW_BUS_NO_RESPONSES, 0);
}

static void test_answers_refusals(void)
{
	send(BYTES(UNIT_ID, 6, 0, 1, 0, 101));
	assert_answer(BYTES(UNIT_ID, 0x86, 3));
	send(BYTES(UNIT_ID, 7));
	assert_answer(BYTES(UNIT_ID, 0x87, 1));
	assert_counter(LW_BUS_EXCEPTIONS, 2);
}

static void test_the_longest_answer_fills_the_frame(void)
{
	uint8_t echo[254] = {UNIT_ID, 8};

	send(echo, sizeof(echo));
	assert_answer(echo, sizeof(echo));
	TEST_ASSERT_EQUAL_UINT(LW_RTU_FRAME_MAX, tx_length);
}

static void test_ignores_other_units(void)
{
	send(BYTES(UNIT_ID + 1, 6, 0, 1, 0, 42));
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	TEST_ASSERT_EQUAL_UINT(0, small.store_count);
	assert_counter(LW_BUS_MESSAGES, 1);
	assert_counter(LW_BUS_SERVER_MESSAGES, 0);
	assert_counter(LW_BUS_NO_RESPONSES, 0);
	TEST_ASSERT_EQUAL_UINT64(5000, slave.last_request_us);
}

static void test_executes_broadcast_writes_without_an_answer(void)
{
	send(BYTES(0, 6, 0, 1, 0, 42));
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	TEST_ASSERT_EQUAL_INT32(42, small.values.level);
	send(BYTES(0, 16, 0, 1, 0, 1, 2, 0, 43));
	TEST_ASSERT_EQUAL_INT32(43, small.values.level);
	send(BYTES(0, 22, 0, 1, 0xFF, 0xF0, 0, 1));
	TEST_ASSERT_EQUAL_INT32(33, small.values.level);
	send(BYTES(0, 5, 0, 2, 0xFF, 0));
	send(BYTES(0, 15, 0, 3, 0, 1, 1, 1));
	TEST_ASSERT_EQUAL_HEX32(0x0C, small.coils[0]);
	assert_counter(LW_BUS_SERVER_MESSAGES, 5);
	assert_counter(LW_BUS_NO_RESPONSES, 5);
	TEST_ASSERT_EQUAL_UINT64(now_us, slave.last_request_us);
}

static void test_refuses_bad_broadcasts_silently(void)
{
	send(BYTES(0, 6, 0, 1, 0, 101));
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	TEST_ASSERT_EQUAL_INT32(101, slave.pdu.last_error.value);
	assert_counter(LW_BUS_EXCEPTIONS, 1);
}

static void test_ignores_broadcasts_that_ask_for_an_answer(void)
{
	send(BYTES(0, 3, 0, 1, 0, 1));
	send(BYTES(0, 23, 0, 1, 0, 1, 0, 1, 0, 1, 2, 0, 42));
	send(BYTES(0, 8, 0, 4, 0, 0));
	send(BYTES(0, 99));
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	TEST_ASSERT_EQUAL_UINT(0, small.store_count);
	TEST_ASSERT_FALSE(slave.pdu.listen_only);
	assert_counter(LW_BUS_MESSAGES, 4);
	assert_counter(LW_BUS_SERVER_MESSAGES, 0);
	assert_counter(LW_BUS_NO_RESPONSES, 4);
	assert_counter(LW_BUS_EXCEPTIONS, 0);
	TEST_ASSERT_EQUAL_UINT64(5000, slave.last_request_us);
}

static void test_listen_only(void)
{
	uint64_t forced_us;

	send(BYTES(UNIT_ID, 8, 0, 4, 0, 0));
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	forced_us = now_us;
	TEST_ASSERT_EQUAL_UINT64(forced_us, slave.last_request_us);
	send(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	send(BYTES(0, 6, 0, 1, 0, 42));
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	TEST_ASSERT_EQUAL_UINT(0, small.store_count);
	TEST_ASSERT_EQUAL_UINT64(forced_us, slave.last_request_us);
	assert_counter(LW_BUS_MESSAGES, 3);
	assert_counter(LW_BUS_NO_RESPONSES, 3);
	send(BYTES(UNIT_ID, 8, 0, 1, 0, 0));
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	TEST_ASSERT_EQUAL_UINT64(now_us, slave.last_request_us);
	assert_counter(LW_BUS_MESSAGES, 0);
	assert_counter(LW_BUS_NO_RESPONSES, 0);
	send(BYTES(UNIT_ID, 8, 0, 11, 0, 0));
	assert_answer(BYTES(UNIT_ID, 8, 0, 11, 0, 1));
}

static void test_counts_frames_that_it_drops(void)
{
	uint8_t bytes[300] = {UNIT_ID};

	lw_slave_receive(&slave, bytes, 8, now_us);
	let_silence_pass();
	lw_slave_receive(&slave, bytes, 1, now_us);
	let_silence_pass();
	lw_slave_receive(&slave, bytes, 300, now_us);
	let_silence_pass();
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	assert_counter(LW_BUS_CRC_ERRORS, 3);
	assert_counter(LW_BUS_OVERRUNS, 1);
	assert_counter(LW_BUS_MESSAGES, 0);
	TEST_ASSERT_EQUAL_UINT64(5000, slave.last_request_us);
}

static void test_answers_after_garbage_and_a_silence(void)
{
	lw_slave_receive(&slave, (const uint8_t[]){0, 0xFF, 0x55}, 3, now_us);
	now_us += SILENCE_US;
	send(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	assert_answer(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	assert_counter(LW_BUS_CRC_ERRORS, 1);
}

static void test_executes_an_unpolled_request_when_the_next_begins(void)
{
	put(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	now_us += SILENCE_US;
	put(BYTES(UNIT_ID, 6, 0, 8, 0, 4));
	TEST_ASSERT_EQUAL_INT32(42, small.values.level);
	assert_counter(LW_BUS_NO_RESPONSES, 1);
	let_silence_pass();
	assert_answer(BYTES(UNIT_ID, 6, 0, 8, 0, 4));
	assert_counter(LW_BUS_SERVER_MESSAGES, 2);
	assert_counter(LW_BUS_NO_RESPONSES, 1);
}

static void assert_nobody_was_heard(void)
{
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	TEST_ASSERT_EQUAL_UINT64(5000, slave.last_request_us);
	TEST_ASSERT_EQUAL_UINT32(0, slave.own_requests);
	TEST_ASSERT_EQUAL_UINT(0, small.store_count);
	TEST_ASSERT_EQUAL_UINT(0, slave.pdu.last_error.reason);
	assert_counter(LW_BUS_SERVER_MESSAGES, 0);
	assert_counter(LW_BUS_NO_RESPONSES, 0);
	assert_counter(LW_BUS_EXCEPTIONS, 0);
}

static void test_an_exception_is_no_request(void)
{
	for (unsigned int function = 0x80; function <= 0xFF; function++) {
		send(BYTES(UNIT_ID, (uint8_t)function, 2));
		assert_nobody_was_heard();
		send(BYTES(0, (uint8_t)function, 2));
		assert_nobody_was_heard();
		send(BYTES(UNIT_ID + 1, (uint8_t)function, 2));
		assert_nobody_was_heard();
	}
	assert_counter(LW_BUS_MESSAGES, 3 * 128);
	TEST_ASSERT_EQUAL_UINT32(2 * 128, slave.foreign_answers);
}

/* Another device has this unit id: what it answers says so. */
static void test_an_answer_in_the_form_of_one_is_no_request(void)
{
	send(BYTES(UNIT_ID, 1, 1, 0xFF));
	assert_nobody_was_heard();
	send(BYTES(UNIT_ID, 2, 2, 0xFF, 0));
	assert_nobody_was_heard();
	send(BYTES(UNIT_ID, 3, 2, 0, 42));
	assert_nobody_was_heard();
	send(BYTES(UNIT_ID, 4, 6, 0x12, 0x34, 0x56, 0x78, 0, 1));
	assert_nobody_was_heard();
	send(BYTES(UNIT_ID, 15, 0, 2, 0, 9));
	assert_nobody_was_heard();
	send(BYTES(UNIT_ID, 16, 0, 1, 0, 2));
	assert_nobody_was_heard();
	send(BYTES(UNIT_ID, 17, 3, 'L', 0, 'x'));
	assert_nobody_was_heard();
	send(BYTES(UNIT_ID, 20, 4, 3, 6, 0, 1));
	assert_nobody_was_heard();
	send(BYTES(UNIT_ID, 23, 4, 0, 42, 0, 43));
	assert_nobody_was_heard();
	send(BYTES(UNIT_ID, 43, 14, 1, 0x82, 0, 0, 1, 0, 1, 'v'));
	assert_nobody_was_heard();
	TEST_ASSERT_EQUAL_UINT32(10, slave.foreign_answers);
}

/* Whatever was answered: it comes back byte by byte while it is being sent. */
static void test_the_echo_of_an_answer_is_dropped(void)
{
	static const uint8_t requests[][6] = {
		{UNIT_ID, 5, 0, 2, 0xFF, 0}, {UNIT_ID, 6, 0, 1, 0, 42},  {UNIT_ID, 8, 0, 0, 1, 2},
		{UNIT_ID, 3, 0, 1, 0, 1},    {UNIT_ID, 6, 0, 1, 0, 101}, {UNIT_ID, 99, 0, 0, 0, 0},
	};
	unsigned int stored;

	for (uint32_t i = 0; i < sizeof(requests) / sizeof(requests[0]); i++) {
		uint8_t answer[LW_RTU_FRAME_MAX];
		size_t length;

		send(requests[i], sizeof(requests[i]));
		length = tx_length;
		TEST_ASSERT_GREATER_THAN_UINT(0, length);
		memcpy(answer, tx, length);
		stored = small.store_count;
		for (size_t j = 0; j < length; j++) {
			now_us += BYTE_US;
			lw_slave_receive(&slave, &answer[j], 1, now_us);
		}
		let_silence_pass();
		TEST_ASSERT_EQUAL_UINT(0, tx_length);
		TEST_ASSERT_EQUAL_UINT(stored, small.store_count);
		TEST_ASSERT_EQUAL_UINT32(i + 1, slave.own_requests);
		TEST_ASSERT_EQUAL_UINT32(i + 1, slave.echoes);
		assert_counter(LW_BUS_CRC_ERRORS, 0);
	}
}

/* An adapter hands over the echo late, and what the master sends next along with it. */
static void test_what_follows_an_echo_in_the_same_lot_is_heard(void)
{
	const uint8_t write[] = {UNIT_ID, 6, 0, 1, 0, 42};
	uint8_t lot[3 * LW_RTU_FRAME_MAX];
	size_t length;

	send(write, sizeof(write));
	memcpy(lot, tx, tx_length);
	length = tx_length;
	memcpy(&lot[length], write, sizeof(write));
	length += lw_rtu_seal(&lot[length], sizeof(write));
	now_us += 16000;
	lw_slave_receive(&slave, lot, length, now_us);
	let_silence_pass();
	assert_answer(write, sizeof(write));
	TEST_ASSERT_EQUAL_UINT32(2, slave.own_requests);
	TEST_ASSERT_EQUAL_UINT32(1, slave.echoes);

	/* The longest answer leaves the buffer no room beside it. */
	uint8_t longest[254] = {UNIT_ID, 8};

	now_us += 1000000;
	send(longest, sizeof(longest));
	memcpy(lot, tx, tx_length);
	length = tx_length;
	memcpy(&lot[length], longest, sizeof(longest));
	length += lw_rtu_seal(&lot[length], sizeof(longest));
	lw_slave_receive(&slave, lot, length, now_us);
	let_silence_pass();
	assert_answer(longest, sizeof(longest));
	TEST_ASSERT_EQUAL_UINT32(2, slave.echoes);
}

static void test_a_master_that_repeats_a_write_is_heard(void)
{
	send(BYTES(UNIT_ID, 3, 0, 1, 0, 1));
	now_us += tx_length * BYTE_US;
	for (unsigned int i = 0; i < 20; i++) {
		now_us += SILENCE_US + BYTE_US; /* as early as the standard lets it */
		send(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
		assert_answer(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
		now_us += tx_length * BYTE_US;
	}
	TEST_ASSERT_EQUAL_UINT(20, small.store_count);
	TEST_ASSERT_EQUAL_UINT32(0, slave.echoes);
}

static void test_a_repeated_write_is_never_dropped_twice_in_a_row(void)
{
	bool was_answered = true;

	for (unsigned int i = 0; i < 400; i++) {
		now_us += 2000;
		send(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
		TEST_ASSERT_TRUE(was_answered || tx_length > 0);
		was_answered = tx_length > 0;
		/* Who is not answered waits. */
		now_us += was_answered ? tx_length * BYTE_US : 300000;
	}
	TEST_ASSERT_GREATER_THAN_UINT(199, small.store_count);
}

/* However late the echo comes: no flood of bus and commands for ever. */
static void test_a_line_with_echo_falls_silent(void)
{
	for (uint32_t delay_us = 0; delay_us < 24000; delay_us += 100) {
		unsigned int answers = 0;

		send(BYTES(UNIT_ID, 3, 0, 1, 0, 1));
		now_us += 1000000;
		send(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
		while (tx_length > 0) {
			uint8_t echo[LW_RTU_FRAME_MAX];
			const size_t length = tx_length;

			answers++;
			TEST_ASSERT_LESS_THAN_UINT(200, answers);
			memcpy(echo, tx, length);
			now_us += delay_us;
			lw_slave_receive(&slave, echo, length, now_us);
			let_silence_pass();
		}
		if (delay_us <= 10 * BYTE_US) {
			TEST_ASSERT_EQUAL_UINT(1, answers);
		}
		now_us += 1000000;
	}
}

static void test_what_has_waited_too_long_is_neither_done_nor_answered(void)
{
	put(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	now_us += SILENCE_US + LW_SLAVE_WAIT_MAX_US;
	tx_length = lw_slave_poll(&slave, now_us, tx);
	assert_answer(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	now_us += 1000000;

	put(BYTES(UNIT_ID, 6, 0, 1, 0, 43));
	now_us += SILENCE_US + LW_SLAVE_WAIT_MAX_US + 1;
	tx_length = lw_slave_poll(&slave, now_us, tx);
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	put(BYTES(0, 6, 0, 1, 0, 44));
	now_us += 10 * LW_SLAVE_WAIT_MAX_US;
	put(BYTES(UNIT_ID, 3, 0, 1, 0, 1));
	let_silence_pass();
	assert_answer(BYTES(UNIT_ID, 3, 2, 0, 42));
	TEST_ASSERT_EQUAL_INT32(42, small.values.level);
	TEST_ASSERT_EQUAL_UINT32(2, slave.late_requests);
	TEST_ASSERT_EQUAL_UINT32(2, slave.own_requests);
	assert_counter(LW_BUS_NO_RESPONSES, 2);
}

static void test_random_bytes_change_nothing(void)
{
	uint32_t random = 2463534242u; /* xorshift32, Marsaglia 2003 */
	struct small_bank before = small;
	unsigned int intact = 0;

	for (unsigned int i = 0; i < 100000; i++) {
		uint8_t bytes[300];
		size_t length = 0;

		do {
			random ^= random << 13;
			random ^= random >> 17;
			random ^= random << 5;
			bytes[length] = (uint8_t)random;
			length++;
		} while (length < sizeof(bytes) && (random >> 8) % 16 != 0);
		bytes[0] = UNIT_ID;
		bytes[1] = 6;
		intact += length >= 4 && lw_crc16(bytes, length) == 0;
		lw_slave_receive(&slave, bytes, length, now_us);
		let_silence_pass();
	}
	before.allow_count = small.allow_count;
	TEST_ASSERT_EQUAL_MEMORY(&before, &small, sizeof(small));
	assert_counter(LW_BUS_MESSAGES, intact);
	assert_counter(LW_BUS_CRC_ERRORS, 100000 - intact);
}

/* What has the form of an answer is no write that a master repeats, however late it comes. */
static void test_a_late_echo_that_can_be_no_request_is_an_echo(void)
{
	uint8_t echo[LW_RTU_FRAME_MAX];
	size_t length;

	send(BYTES(UNIT_ID, 3, 0, 1, 0, 1));
	now_us += 1000000; /* and there was no echo */
	send(BYTES(UNIT_ID, 3, 0, 1, 0, 1));
	length = tx_length;
	memcpy(echo, tx, length);
	now_us += 16000;
	lw_slave_receive(&slave, echo, length, now_us);
	let_silence_pass();
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	TEST_ASSERT_EQUAL_UINT32(1, slave.echoes);
	TEST_ASSERT_EQUAL_UINT32(0, slave.foreign_answers);
}

static void test_without_the_time_of_a_byte_an_echo_comes_within_the_silence(void)
{
	struct lw_slave_config timeless = config;

	timeless.byte_us = 0;
	lw_slave_init(&slave, &timeless, now_us);
	send(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	now_us += SILENCE_US - 1;
	send(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	TEST_ASSERT_EQUAL_UINT(0, tx_length);
	TEST_ASSERT_EQUAL_UINT32(1, slave.echoes);
	send(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	now_us += SILENCE_US;
	send(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	assert_answer(BYTES(UNIT_ID, 6, 0, 1, 0, 42));
	TEST_ASSERT_EQUAL_UINT32(1, slave.echoes);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_answers_its_own_unit_id);
	RUN_TEST(test_answers_refusals);
	RUN_TEST(test_the_longest_answer_fills_the_frame);
	RUN_TEST(test_ignores_other_units);
	RUN_TEST(test_executes_broadcast_writes_without_an_answer);
	RUN_TEST(test_refuses_bad_broadcasts_silently);
	RUN_TEST(test_ignores_broadcasts_that_ask_for_an_answer);
	RUN_TEST(test_listen_only);
	RUN_TEST(test_counts_frames_that_it_drops);
	RUN_TEST(test_answers_after_garbage_and_a_silence);
	RUN_TEST(test_executes_an_unpolled_request_when_the_next_begins);
	RUN_TEST(test_an_exception_is_no_request);
	RUN_TEST(test_an_answer_in_the_form_of_one_is_no_request);
	RUN_TEST(test_the_echo_of_an_answer_is_dropped);
	RUN_TEST(test_what_follows_an_echo_in_the_same_lot_is_heard);
	RUN_TEST(test_a_master_that_repeats_a_write_is_heard);
	RUN_TEST(test_a_repeated_write_is_never_dropped_twice_in_a_row);
	RUN_TEST(test_a_line_with_echo_falls_silent);
	RUN_TEST(test_what_has_waited_too_long_is_neither_done_nor_answered);
	RUN_TEST(test_random_bytes_change_nothing);
	RUN_TEST(test_a_late_echo_that_can_be_no_request_is_an_echo);
	RUN_TEST(test_without_the_time_of_a_byte_an_echo_comes_within_the_silence);
	return UNITY_END();
}
