/* The Modbus RTU slave as a whole: frames in, frames out. */
#include <unity.h>

#include "lw/crc16.h"
#include "lw/slave.h"
#include "small_bank.h"

#define SILENCE_US 1750u
#define UNIT_ID    7u

static const struct lw_slave_config config = {
	.unit_id = UNIT_ID,
	.rtu = {.silence_us = SILENCE_US},
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
	RUN_TEST(test_random_bytes_change_nothing);
	return UNITY_END();
}
