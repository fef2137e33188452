/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Modbus requests: every function code for bits and registers in its normal form, at each limit and
 * one beyond, and refused; and what holds for all functions.
 */
#include <stdio.h>

#include "pdu_rig.h"

/* A request of function, address, count, byte count and so many zero bytes. */
static size_t make_write(uint8_t *request, uint8_t function, uint16_t address, uint16_t count,
			 uint8_t byte_count)
{
	memset(request, 0, 300);
	request[0] = function;
	request[1] = (uint8_t)(address >> 8);
	request[2] = (uint8_t)address;
	request[3] = (uint8_t)(count >> 8);
	request[4] = (uint8_t)count;
	request[5] = byte_count;
	return 6u + byte_count;
}

/* ---- reading ---- */

static void test_fc01_and_fc02_read_bits(void)
{
	small.coils[0] = 0x000002CD;
	small.discretes[1] = 0x00000001;
	assert_answer(BYTES(1, 0, 0, 0, 10), BYTES(1, 2, 0xCD, 0x02));
	assert_answer(BYTES(1, 0, 2, 0, 1), BYTES(1, 1, 0x01));
	assert_answer(BYTES(2, 0, 31, 0, 2), BYTES(2, 1, 0x02));
	for (uint8_t function = 1; function <= 2; function++) {
		ask(BYTES(function, 0, 0, 0x07, 0xD0)); /* 2000 */
		TEST_ASSERT_EQUAL_UINT(252, response_length);
		TEST_ASSERT_EQUAL_HEX8(250, response[1]);
		assert_refused(BYTES(function, 0, 0, 0x07, 0xD1), 3, LW_REASON_BAD_COUNT);
		assert_error_details(LW_NO_ADDRESS, 2001, 2000);
		assert_refused(BYTES(function, 0, 0, 0, 0), 3, LW_REASON_BAD_COUNT);
		assert_error_details(LW_NO_ADDRESS, 0, 1);
		assert_refused(BYTES(function, 0x07, 0xDF, 0, 2), 2, LW_REASON_UNKNOWN_ADDRESS);
		assert_error_details(2016, 0, 0);
		assert_refused(BYTES(function, 0, 0, 0), 3, LW_REASON_BAD_LENGTH);
		assert_error_details(LW_NO_ADDRESS, 4, 5);
		assert_refused(BYTES(function, 0, 0, 0, 1, 0), 3, LW_REASON_BAD_LENGTH);
		assert_refused(BYTES(function), 3, LW_REASON_BAD_LENGTH);
	}
}

static void test_fc03_and_fc04_read_registers(void)
{
	static const uint8_t first_address[] = {0x00, 0x64, 0x04, 0x4C}; /* 100, 1100 */

	small.values.array[0] = 0x022B;
	small.values.array[1] = 0x0064;
	for (uint8_t function = 3; function <= 4; function++) {
		uint8_t high = first_address[2 * (function - 3)];
		uint8_t low = first_address[2 * (function - 3) + 1];

		assert_answer(BYTES(function, high, low, 0, 2),
			      BYTES(function, 4, 0x02, 0x2B, 0x00, 0x64));
		ask(BYTES(function, high, low, 0, 125));
		TEST_ASSERT_EQUAL_UINT(252, response_length);
		TEST_ASSERT_EQUAL_HEX8(250, response[1]);
		assert_refused(BYTES(function, high, low, 0, 126), 3, LW_REASON_BAD_COUNT);
		assert_error_details(LW_NO_ADDRESS, 126, 125);
		assert_refused(BYTES(function, high, low, 0, 0), 3, LW_REASON_BAD_COUNT);
		assert_refused(BYTES(function, high, low, 1, 1), 3, LW_REASON_BAD_COUNT);
		assert_refused(BYTES(function, 0x13, 0x87, 0, 0x7D), 2, LW_REASON_UNKNOWN_ADDRESS);
		assert_error_details(0x1387, 0, 0);
		assert_refused(BYTES(function, high, low, 0), 3, LW_REASON_BAD_LENGTH);
		assert_refused(BYTES(function, high, low, 0, 1, 0), 3, LW_REASON_BAD_LENGTH);
	}
	assert_refused(BYTES(3, 0xFF, 0xFE, 0, 3), 2, LW_REASON_UNKNOWN_ADDRESS);
}

/* ---- writing ---- */

static void test_fc05_write_single_coil(void)
{
	assert_answer(BYTES(5, 0, 3, 0xFF, 0), BYTES(5, 0, 3, 0xFF, 0));
	TEST_ASSERT_EQUAL_HEX32(8, small.coils[0]);
	assert_answer(BYTES(5, 0, 3, 0, 0), BYTES(5, 0, 3, 0, 0));
	TEST_ASSERT_EQUAL_HEX32(0, small.coils[0]);
	assert_answer(BYTES(5, 0x07, 0xDF, 0xFF, 0), BYTES(5, 0x07, 0xDF, 0xFF, 0)); /* the last */
	assert_refused(BYTES(5, 0, 3, 0xFF, 1), 3, LW_REASON_BAD_COIL_VALUE);
	assert_error_details(3, 0xFF01, 0xFF00);
	assert_refused(BYTES(5, 0, 3, 0, 1), 3, LW_REASON_BAD_COIL_VALUE);
	assert_refused(BYTES(5, 0x08, 0, 0xFF, 0), 2, LW_REASON_UNKNOWN_ADDRESS);
	assert_refused(BYTES(5, 0, 3, 0xFF), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(5, 0, 3, 0xFF, 0, 0), 3, LW_REASON_BAD_LENGTH);
}

static void test_fc06_write_single_register(void)
{
	assert_answer(BYTES(6, 0, 1, 0xFF, 0x9C), BYTES(6, 0, 1, 0xFF, 0x9C));
	TEST_ASSERT_EQUAL_INT32(-100, small.values.level);
	assert_refused(BYTES(6, 0, 1, 0, 101), 3, LW_REASON_OUT_OF_RANGE);
	assert_error_details(1, 101, 100);
	assert_refused(BYTES(6, 0, 2, 0, 20), 2, LW_REASON_HALF_OF_PAIR);
	assert_error_details(2, 0, 0);
	assert_refused(BYTES(6, 0, 9, 0, 0), 2, LW_REASON_NOT_WRITABLE);
	assert_refused(BYTES(6, 0, 11, 0, 0), 2, LW_REASON_UNKNOWN_ADDRESS);
	assert_refused(BYTES(6, 0, 1, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(6, 0, 1, 0, 1, 0), 3, LW_REASON_BAD_LENGTH);
}

static void test_owners_refusals_become_exceptions(void)
{
	static const struct {
		int error;
		uint8_t exception;
	} cases[] = {{-ENXIO, 2}, {-EINVAL, 3}, {-EIO, 4}, {-EBUSY, 6}, {-ENOTSUP, 1}};

	small.refused_point = &small_points[1];
	for (unsigned int i = 0; i < ARRAY_SIZE(cases); i++) {
		small.refused_error = cases[i].error;
		assert_refused(BYTES(6, 0, 1, 0, 42), cases[i].exception, LW_REASON_BUSY_TRACKING);
		assert_error_details(1, 42, 0);
	}
	TEST_ASSERT_EQUAL_UINT32(1, pdu.counters[LW_BUS_BUSY]);
}

static void test_fc15_write_multiple_coils(void)
{
	uint8_t request[300];
	size_t length;

	assert_answer(BYTES(15, 0, 19, 0, 10, 2, 0xCD, 0x01), BYTES(15, 0, 19, 0, 10));
	TEST_ASSERT_EQUAL_HEX32(0x1CDu << 19, small.coils[0]);
	length = make_write(request, 15, 0, 1968, 246);
	ask(request, length);
	TEST_ASSERT_EQUAL_UINT(5, response_length);
	TEST_ASSERT_EQUAL_HEX32(0, small.coils[0]);
	length = make_write(request, 15, 0, 1969, 247);
	assert_refused(request, length, 3, LW_REASON_BAD_COUNT);
	assert_error_details(LW_NO_ADDRESS, 1969, 1968);
	assert_refused(BYTES(15, 0, 19, 0, 0, 0), 3, LW_REASON_BAD_COUNT);
	assert_refused(BYTES(15, 0, 19, 0, 10, 1, 0xCD), 3, LW_REASON_BAD_LENGTH);
	assert_error_details(LW_NO_ADDRESS, 1, 2);
	assert_refused(BYTES(15, 0, 19, 0, 10, 2, 0xCD), 3, LW_REASON_BAD_LENGTH);
	assert_error_details(LW_NO_ADDRESS, 7, 8);
	assert_refused(BYTES(15, 0, 19, 0, 10, 2, 0xCD, 1, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(15, 0, 19, 0, 10), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(15, 0x07, 0xDF, 0, 2, 1, 3), 2, LW_REASON_UNKNOWN_ADDRESS);
	assert_refused(BYTES(15, 0, 0, 0, 2, 1, 3), 3, LW_REASON_SEVERAL_COMMANDS);
}

static void test_fc16_write_multiple_registers(void)
{
	uint8_t request[300];
	size_t length;

	assert_answer(BYTES(16, 0, 2, 0, 4, 8, 0, 0, 0, 99, 0xFF, 0xFF, 0xFF, 0xFE),
		      BYTES(16, 0, 2, 0, 4));
	TEST_ASSERT_EQUAL_UINT32(99, small.values.speed);
	TEST_ASSERT_EQUAL_INT32(-2, small.values.place);
	length = make_write(request, 16, 100, 123, 246);
	ask(request, length);
	TEST_ASSERT_EQUAL_UINT(5, response_length);
	TEST_ASSERT_EQUAL_UINT(2 + 123, small.store_count);
	length = make_write(request, 16, 100, 124, 248);
	assert_refused(request, length, 3, LW_REASON_BAD_LENGTH); /* a PDU of 254 bytes */
	assert_refused(request, length - 1, 3, LW_REASON_BAD_COUNT);
	assert_error_details(LW_NO_ADDRESS, 124, 123);
	assert_refused(BYTES(16, 0, 100, 0, 0, 0), 3, LW_REASON_BAD_COUNT);
	assert_refused(BYTES(16, 0, 100, 0, 1, 3, 0, 0, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(16, 0, 100, 0, 1, 2, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(16, 0, 100, 0, 1, 2, 0, 0, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(16, 0, 100, 0, 1), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(16, 0, 1, 0, 2, 4, 0, 1, 0, 0), 2, LW_REASON_HALF_OF_PAIR);
	/* All or nothing: the last value is bad. */
	assert_refused(BYTES(16, 0, 6, 0, 3, 6, 0, 0, 0x04, 0xB0, 0, 3), 3, LW_REASON_OUT_OF_RANGE);
	assert_error_details(8, 3, 2);
}

static void test_fc22_mask_write_register(void)
{
	small.values.array[4] = 0x12;
	assert_answer(BYTES(22, 0, 104, 0, 0xF2, 0, 0x25), BYTES(22, 0, 104, 0, 0xF2, 0, 0x25));
	TEST_ASSERT_EQUAL_HEX32(0x17, small.values.array[4]); /* the standard's example */
	small.values.array[4] = 0xAAAA;
	assert_answer(BYTES(22, 0, 104, 0, 0, 0xFF, 0), BYTES(22, 0, 104, 0, 0, 0xFF, 0));
	TEST_ASSERT_EQUAL_HEX32(0xFF00, small.values.array[4]);
	assert_answer(BYTES(22, 0, 104, 0xFF, 0xFF, 0xFF, 0xFF),
		      BYTES(22, 0, 104, 0xFF, 0xFF, 0xFF, 0xFF));
	TEST_ASSERT_EQUAL_HEX32(0xFF00, small.values.array[4]);
	assert_answer(BYTES(22, 0x01, 0x2C, 0, 0, 0, 5),
		      BYTES(22, 0x01, 0x2C, 0, 0, 0, 5)); /* none follows it */
	assert_refused(BYTES(22, 0, 8, 0, 0, 0, 3), 3, LW_REASON_OUT_OF_RANGE);
	assert_refused(BYTES(22, 0, 2, 0, 0, 0, 3), 2, LW_REASON_HALF_OF_PAIR);
	assert_refused(BYTES(22, 0, 11, 0, 0, 0, 3), 2, LW_REASON_UNKNOWN_ADDRESS);
	assert_refused(BYTES(22, 0, 8, 0, 0, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(22, 0, 8, 0, 0, 0, 1, 0), 3, LW_REASON_BAD_LENGTH);
}

static void test_fc23_writes_then_reads(void)
{
	small.values.array[0] = 1;
	assert_answer(BYTES(23, 0, 100, 0, 2, 0, 101, 0, 1, 2, 0x12, 0x34),
		      BYTES(23, 4, 0, 1, 0x12, 0x34));
}

static void test_fc23_limits(void)
{
	uint8_t request[300] = {23, 0, 100, 0, 125, 0, 100, 0, 121, 242};

	ask(request, 10 + 242);
	TEST_ASSERT_EQUAL_UINT(252, response_length);
	TEST_ASSERT_EQUAL_UINT(121, small.store_count);
	request[4] = 126;
	assert_refused(request, 10 + 242, 3, LW_REASON_BAD_COUNT);
	assert_error_details(LW_NO_ADDRESS, 126, 125);
	request[4] = 0;
	assert_refused(request, 10 + 242, 3, LW_REASON_BAD_COUNT);
	request[4] = 125;
	request[8] = 122;
	request[9] = 244;
	assert_refused(request, 10 + 244, 3, LW_REASON_BAD_LENGTH); /* a PDU of 254 bytes */
	assert_refused(request, 10 + 243, 3, LW_REASON_BAD_COUNT);
	request[8] = 0;
	request[9] = 0;
	assert_refused(request, 10, 3, LW_REASON_BAD_COUNT);
}

static void test_fc23_refusals_write_nothing(void)
{
	/* unknown read range, unknown write range, bad value, lengths */
	assert_refused(BYTES(23, 0, 11, 0, 1, 0, 101, 0, 1, 2, 0, 1), 2, LW_REASON_UNKNOWN_ADDRESS);
	assert_error_details(11, 0, 0);
	assert_refused(BYTES(23, 0, 1, 0, 1, 0, 12, 0, 1, 2, 0, 1), 2, LW_REASON_UNKNOWN_ADDRESS);
	assert_error_details(12, 0, 0);
	assert_refused(BYTES(23, 0, 1, 0, 1, 0, 8, 0, 1, 2, 0, 3), 3, LW_REASON_OUT_OF_RANGE);
	assert_refused(BYTES(23, 0, 1, 0, 1, 0, 8, 0, 1, 1, 0, 1), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(23, 0, 1, 0, 1, 0, 8, 0, 1, 2, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(23, 0, 1, 0, 1, 0, 8, 0, 1, 2, 0, 1, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(23, 0, 1, 0, 1, 0, 8, 0, 1), 3, LW_REASON_BAD_LENGTH);
}

/* ---- all functions ---- */

static void test_unknown_functions(void)
{
	static const uint8_t known[] = {1, 2, 3, 4, 5, 6, 8, 15, 16, 17, 20, 21, 22, 23, 43};
	unsigned int unknown_count = 0;

	for (unsigned int function = 0; function < 256; function++) {
		if (memchr(known, (int)function, sizeof(known)) == NULL) {
			assert_refused(BYTES((uint8_t)function, 0, 0), 1,
				       LW_REASON_UNKNOWN_FUNCTION);
			assert_error_details(LW_NO_ADDRESS, (int32_t)function, 0);
			unknown_count++;
		}
	}
	TEST_ASSERT_EQUAL_UINT(256 - sizeof(known), unknown_count);
}

static void test_success_does_not_clear_the_last_error(void)
{
	assert_refused(BYTES(6, 0, 1, 0, 101), 3, LW_REASON_OUT_OF_RANGE);
	assert_answer(BYTES(6, 0, 1, 0, 5), BYTES(6, 0, 1, 0, 5));
	assert_error_details(1, 101, 100);
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_OUT_OF_RANGE, pdu.last_error.reason);
}

static void test_only_pure_writes_may_be_broadcast(void)
{
	static const uint8_t writes[] = {5, 6, 15, 16, 21, 22};

	for (unsigned int function = 0; function < 256; function++) {
		TEST_ASSERT_EQUAL(memchr(writes, (int)function, sizeof(writes)) != NULL,
				  lw_pdu_may_broadcast((uint8_t)function));
	}
}

static uint32_t next_random(void)
{
	static uint32_t state = 2463534242u; /* xorshift32, Marsaglia 2003 */

	state ^= state << 13;
	state ^= state >> 17;
	state ^= state << 5;
	return state;
}

/* Requests that are nearly right. What is refused changes nothing; nothing is accessed outside. */
static void test_random_requests(void)
{
	static const uint8_t functions[] = {1,  2,  3,  4,  5,  6,  8,  15,
					    16, 17, 20, 21, 22, 23, 43, 99};
	unsigned int refused = 0;
	unsigned int stored = 0;

	for (unsigned int i = 0; i < 100000; i++) {
		uint8_t request[256];
		size_t length = 1 + next_random() % (next_random() % 4 == 0 ? 256 : 12);
		struct small_bank before = small;

		for (size_t j = 0; j < sizeof(request); j++) {
			request[j] = next_random() % 2 == 0 ? 0 : (uint8_t)next_random();
		}
		request[0] = functions[next_random() % sizeof(functions)];
		if (request[0] >= 15 && next_random() % 2 == 0) {
			request[3] = 0;
			request[4] = (uint8_t)(1 + next_random() % 4);
			request[5] = (uint8_t)(request[0] == 15 ? 1 : 2 * request[4]);
			length = 6u + request[5];
		}
		ask(request, length);
		if (response_length == 2 && response[0] == (request[0] | 0x80)) {
			refused++;
			before.allow_count = small.allow_count;
			before.image_count = small.image_count;
			TEST_ASSERT_EQUAL_MEMORY(&before, &small, sizeof(small));
		}
		stored += small.store_count != before.store_count;
		pdu.listen_only = false;
	}
	/* The requests are of both kinds. */
	TEST_ASSERT_GREATER_THAN(1000, refused);
	TEST_ASSERT_GREATER_THAN(1000, stored);
}

/* What only an answer can look like, and a request of the same function that must not pass for it.
 */
static void test_answers_are_told_from_requests(void)
{
	static const struct {
		uint8_t pdu[16];
		size_t length;
		bool is_response;
	} cases[] = {
		{{0x84, 2}, 2, true},
		{{1, 1, 5}, 3, true},
		{{1, 0}, 2, false},
		{{1, 0, 0, 0, 8}, 5, false},
		{{1, 3, 0, 0, 8}, 5, false},
		{{3, 2, 0, 5}, 4, true},
		{{3, 3, 0, 0, 1}, 5, false},
		{{3, 3, 0, 5, 1}, 5, false},
		{{3, 5, 0, 5, 0, 5, 1}, 7, false},
		{{4, 4, 0, 0, 0, 1}, 6, true},
		{{3}, 1, false},
		{{17}, 1, false},
		{{17, 3, 1, 0xFF, 7}, 5, true},
		{{16, 0, 1, 0, 2}, 5, true},
		{{16, 0, 1, 0, 1, 2, 0, 7}, 8, false},
		{{15, 0, 1, 0, 2}, 5, true},
		{{23, 2, 0, 5}, 4, true},
		{{23, 0, 1, 0, 1, 0, 1, 0, 1, 2, 0, 7}, 12, false},
		{{23, 10, 0, 0, 1, 0, 1, 0, 1, 2, 0, 7}, 12, false}, /* reads from 0x0A00 */
		{{23, 10, 0, 0, 1, 0, 1, 0, 1, 4, 0, 7}, 12, true},
		{{20, 4, 3, 6, 0, 9}, 6, true},
		{{20, 3, 3, 6, 0}, 5, true},
		{{20, 6, 5, 6, 0, 9, 0, 9}, 8, true},
		{{20, 8, 3, 6, 0, 9, 3, 6, 0, 9}, 10, true},
		{{20, 9, 3, 6, 0, 9}, 6, false},
		{{20, 7, 6, 0, 1, 0, 0, 0, 1}, 9, false},
		{{20, 2, 3, 6}, 4, false},
		{{20, 4, 3, 5, 0, 9}, 6, false},
		{{43, 14, 1, 0x81, 0, 0, 1, 0, 0}, 9, true},
		{{43, 14, 1, 0x81, 0, 0, 0}, 7, true},
		{{43, 14, 1, 0x81, 0, 0}, 6, false},
		{{43, 14, 1, 0}, 4, false},
		{{43, 14, 1, 1, 0, 0, 1}, 7, false},
		{{43, 13, 1, 0x81, 0, 0, 1}, 7, false},
		{{6, 0, 1, 0, 2}, 5, false},
		{{99, 1, 2}, 3, false},
	};

	for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
		char which[16];

		(void)snprintf(which, sizeof(which), "case %u", (unsigned int)i);
		TEST_ASSERT_EQUAL_MESSAGE(cases[i].is_response,
					  lw_pdu_is_response(cases[i].pdu, cases[i].length), which);
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_fc01_and_fc02_read_bits);
	RUN_TEST(test_fc03_and_fc04_read_registers);
	RUN_TEST(test_fc05_write_single_coil);
	RUN_TEST(test_fc06_write_single_register);
	RUN_TEST(test_owners_refusals_become_exceptions);
	RUN_TEST(test_fc15_write_multiple_coils);
	RUN_TEST(test_fc16_write_multiple_registers);
	RUN_TEST(test_fc22_mask_write_register);
	RUN_TEST(test_fc23_writes_then_reads);
	RUN_TEST(test_fc23_limits);
	RUN_TEST(test_fc23_refusals_write_nothing);
	RUN_TEST(test_unknown_functions);
	RUN_TEST(test_success_does_not_clear_the_last_error);
	RUN_TEST(test_only_pure_writes_may_be_broadcast);
	RUN_TEST(test_random_requests);
	RUN_TEST(test_answers_are_told_from_requests);
	return UNITY_END();
}
