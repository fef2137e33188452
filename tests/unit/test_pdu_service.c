/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Modbus functions beside the registers: diagnostics, identification, file records. In their normal
 * form, at each limit and one beyond, and refused.
 */
#include "pdu_rig.h"

#define LONG_TEXT                                                                                  \
	"0123456789012345678901234567890123456789012345678901234567890123456789"                   \
	"0123456789012345678901234567890123456789012345678901234567890123456789"                   \
	"0123456789012345678901234567890123456789012345678901234567890123456789"                   \
	"0123456789012345678901234567890123456789" /* 250 characters */

/* ---- diagnostics ---- */

static void test_fc08_echo(void)
{
	uint8_t request[LW_PDU_MAX + 2] = {8, 0, 0, 1, 2, 3, 4};

	assert_answer(BYTES(8, 0, 0, 0xA5, 0x37), BYTES(8, 0, 0, 0xA5, 0x37));
	assert_answer(request, LW_PDU_MAX, request, LW_PDU_MAX);
	assert_refused(request, LW_PDU_MAX + 2, 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(8, 0, 0, 1, 2, 3), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(8, 0, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(8), 3, LW_REASON_BAD_LENGTH);
}

static void test_fc08_reads_each_counter(void)
{
	for (uint8_t i = 0; i < LW_BUS_COUNTER_COUNT; i++) {
		pdu.counters[i] = 0x10100u + i;
	}
	pdu.counters[LW_BUS_SERVER_MESSAGES]--; /* the request itself counts */
	for (uint8_t i = 0; i < LW_BUS_COUNTER_COUNT; i++) {
		assert_answer(BYTES(8, 0, (uint8_t)(11 + i), 0, 0),
			      BYTES(8, 0, (uint8_t)(11 + i), 1, i));
		pdu.counters[LW_BUS_SERVER_MESSAGES] = 0x10100u + LW_BUS_SERVER_MESSAGES - 1;
	}
	assert_refused(BYTES(8, 0, 11, 0, 1), 3, LW_REASON_OUT_OF_RANGE);
	assert_error_details(LW_NO_ADDRESS, 1, 0);
	assert_refused(BYTES(8, 0, 11, 0, 0, 0, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(8, 0, 3, 0), 3, LW_REASON_BAD_LENGTH);
}

static void test_fc08_diagnostic_register_and_clear(void)
{
	pdu.counters[LW_BUS_CRC_ERRORS] = 3;
	assert_answer(BYTES(8, 0, 2, 0, 0), BYTES(8, 0, 2, 0, 0x0A)); /* and server messages */
	pdu.counters[LW_BUS_MESSAGES] = 1;
	assert_answer(BYTES(8, 0, 2, 0, 0), BYTES(8, 0, 2, 0, 0x0B));
	assert_answer(BYTES(8, 0, 10, 0, 0), BYTES(8, 0, 10, 0, 0));
	for (unsigned int i = 0; i < LW_BUS_COUNTER_COUNT; i++) {
		TEST_ASSERT_EQUAL_UINT32(0, pdu.counters[i]);
	}
}

static void test_fc08_clear_overrun_counter(void)
{
	pdu.counters[LW_BUS_OVERRUNS] = 3;
	pdu.counters[LW_BUS_CRC_ERRORS] = 4;
	assert_answer(BYTES(8, 0, 20, 0, 0), BYTES(8, 0, 20, 0, 0));
	TEST_ASSERT_EQUAL_UINT32(0, pdu.counters[LW_BUS_OVERRUNS]);
	TEST_ASSERT_EQUAL_UINT32(4, pdu.counters[LW_BUS_CRC_ERRORS]);
	assert_refused(BYTES(8, 0, 20, 0, 1), 3, LW_REASON_OUT_OF_RANGE);
}

static void test_fc08_undefined_sub_functions(void)
{
	static const uint16_t undefined[] = {3, 5, 6, 7, 8, 9, 19, 21, 256, 65535};

	for (unsigned int i = 0; i < ARRAY_SIZE(undefined); i++) {
		assert_refused(BYTES(8, (uint8_t)(undefined[i] >> 8), (uint8_t)undefined[i], 0, 0),
			       1, LW_REASON_UNDEFINED_SUB_FUNCTION);
		assert_error_details(LW_NO_ADDRESS, undefined[i], 20);
	}
}

static void test_fc08_listen_only_until_restart(void)
{
	assert_refused(BYTES(8, 0, 4, 0, 1), 3, LW_REASON_OUT_OF_RANGE);
	ask(BYTES(8, 0, 4, 0, 0));
	TEST_ASSERT_EQUAL_UINT(0, response_length);
	TEST_ASSERT_EQUAL_UINT32(1, pdu.counters[LW_BUS_NO_RESPONSES]);
	TEST_ASSERT_TRUE(pdu.listen_only);

	ask(BYTES(6, 0, 1, 0, 5)); /* not executed */
	TEST_ASSERT_EQUAL_UINT(0, response_length);
	TEST_ASSERT_EQUAL_UINT(0, small.store_count);
	TEST_ASSERT_EQUAL_UINT32(2, pdu.counters[LW_BUS_NO_RESPONSES]);
	ask(BYTES(8, 0, 1, 0, 1)); /* no restart */
	ask(BYTES(8, 0, 1, 0, 0, 0));
	ask(BYTES(8, 0, 10, 0, 0));
	ask(BYTES(6, 0, 1, 0, 0));
	TEST_ASSERT_TRUE(pdu.listen_only);

	ask(BYTES(8, 0, 1, 0, 0));
	TEST_ASSERT_EQUAL_UINT(0, response_length);
	TEST_ASSERT_FALSE(pdu.listen_only);
	TEST_ASSERT_EQUAL_UINT32(0, pdu.counters[LW_BUS_NO_RESPONSES]);
	assert_answer(BYTES(6, 0, 1, 0, 5), BYTES(6, 0, 1, 0, 5));
}

static void test_fc08_restart(void)
{
	pdu.counters[LW_BUS_MESSAGES] = 9;
	assert_answer(BYTES(8, 0, 1, 0xFF, 0), BYTES(8, 0, 1, 0xFF, 0));
	TEST_ASSERT_EQUAL_UINT32(0, pdu.counters[LW_BUS_MESSAGES]);
	assert_answer(BYTES(8, 0, 1, 0, 0), BYTES(8, 0, 1, 0, 0));
	assert_refused(BYTES(8, 0, 1, 0xFF, 1), 3, LW_REASON_OUT_OF_RANGE);
}

/* ---- device identification ---- */

static void test_fc43_streams(void)
{
	static const uint8_t basic[] = {43,  14, 1, 0x82, 0,   0,   3,   0, 4, 'v', 'e', 'n',
					'd', 1,  4, 'c',  'o', 'd', 'e', 2, 3, '1', '.', '2'};
	static const uint8_t from_name[] = {43,  14,  2,   0x82, 0, 0,   2,   4,   4,   'n',
					    'a', 'm', 'e', 5,    5, 'm', 'o', 'd', 'e', 'l'};

	assert_answer(BYTES(43, 14, 1, 0), basic, sizeof(basic));
	assert_answer(BYTES(43, 14, 1, 3), basic, sizeof(basic)); /* not basic: starts anew */
	assert_answer(BYTES(43, 14, 2, 4), from_name, sizeof(from_name));
	ask(BYTES(43, 14, 2, 0x80));
	TEST_ASSERT_EQUAL_HEX8(6, response[6]);
	TEST_ASSERT_EQUAL_HEX8(0, response[7]);
	ask(BYTES(43, 14, 3, 0)); /* extended: as much as there is */
	TEST_ASSERT_EQUAL_HEX8(3, response[2]);
	TEST_ASSERT_EQUAL_HEX8(0x82, response[3]);
	TEST_ASSERT_EQUAL_HEX8(6, response[6]);
}

static void test_fc43_one_object(void)
{
	assert_answer(BYTES(43, 14, 4, 3), BYTES(43, 14, 4, 0x82, 0, 0, 1, 3, 3, 'u', 'r', 'l'));
	assert_refused(BYTES(43, 14, 4, 6), 2, LW_REASON_UNDEFINED_SUB_FUNCTION);
	assert_error_details(LW_NO_ADDRESS, 6, 5);
}

static void test_fc43_more_follows(void)
{
	static const struct lw_pdu_config long_config = {
		.bank = &small.bank,
		.device_id = {"a", LONG_TEXT, "c", "d", "e", "f"},
	};
	static const uint8_t full_head[] = {43, 14, 1, 0x82, 0xFF, 2, 1, 1, LW_DEVICE_ID_MAX};

	pdu.config = &long_config;
	assert_answer(BYTES(43, 14, 1, 0), BYTES(43, 14, 1, 0x82, 0xFF, 1, 1, 0, 1, 'a'));
	ask(BYTES(43, 14, 1, 1)); /* fills the PDU, its text cut to 244 */
	TEST_ASSERT_EQUAL_UINT(LW_PDU_MAX, response_length);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(full_head, response, sizeof(full_head));
	TEST_ASSERT_EQUAL_MEMORY(LONG_TEXT, &response[sizeof(full_head)], LW_DEVICE_ID_MAX);
	assert_answer(BYTES(43, 14, 1, 2), BYTES(43, 14, 1, 0x82, 0, 0, 1, 2, 1, 'c'));
}

/* 241 characters behind an object of one fill the PDU; 242 do not fit beside it. */
static void test_fc43_an_object_fits_to_the_last_byte(void)
{
	struct lw_pdu_config long_config = config;

	long_config.device_id[LW_DEVICE_ID_VENDOR_NAME] = "a";
	long_config.device_id[LW_DEVICE_ID_PRODUCT_CODE] = &LONG_TEXT[250 - 241];
	pdu.config = &long_config;
	ask(BYTES(43, 14, 1, 0));
	TEST_ASSERT_EQUAL_UINT(LW_PDU_MAX, response_length);
	TEST_ASSERT_EQUAL_HEX8(2, response[6]);
	long_config.device_id[LW_DEVICE_ID_PRODUCT_CODE] = &LONG_TEXT[250 - 242];
	assert_answer(BYTES(43, 14, 1, 0), BYTES(43, 14, 1, 0x82, 0xFF, 1, 1, 0, 1, 'a'));
}

static void test_fc43_refusals(void)
{
	assert_refused(BYTES(43, 13, 1, 0), 1, LW_REASON_UNDEFINED_SUB_FUNCTION);
	assert_error_details(LW_NO_ADDRESS, 13, 14);
	assert_refused(BYTES(43, 13), 1, LW_REASON_UNDEFINED_SUB_FUNCTION);
	assert_refused(BYTES(43, 14, 0, 0), 3, LW_REASON_UNDEFINED_SUB_FUNCTION);
	assert_refused(BYTES(43, 14, 5, 0), 3, LW_REASON_UNDEFINED_SUB_FUNCTION);
	assert_refused(BYTES(43, 14, 1), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(43, 14, 1, 0, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(43), 3, LW_REASON_BAD_LENGTH);
}

/* ---- server id ---- */

static void test_fc17_server_id(void)
{
	static const uint8_t stopped[] = {17,  16,  0x4C, 0x00, ' ', 'v', 'e', 'n', 'd',
					  ' ', 'c', 'o',  'd',  'e', ' ', '1', '.', '2'};

	assert_answer(BYTES(17), stopped, sizeof(stopped));
	is_running = true;
	ask(BYTES(17));
	TEST_ASSERT_EQUAL_HEX8(0xFF, response[3]);
	assert_refused(BYTES(17, 0), 3, LW_REASON_BAD_LENGTH);
}

static void test_fc17_leaves_out_a_text_that_does_not_fit(void)
{
	struct lw_pdu_config long_config = config;

	long_config.device_id[LW_DEVICE_ID_PRODUCT_CODE] = LONG_TEXT; /* 250 characters */
	pdu.config = &long_config;
	ask(BYTES(17));
	TEST_ASSERT_EQUAL_UINT(2 + 2 + 5 + 4, response_length);
	TEST_ASSERT_EQUAL_HEX8(2 + 5 + 4, response[1]);
	TEST_ASSERT_EQUAL_MEMORY(" vend 1.2", &response[4], 9);
}

static void test_fc17_a_text_fits_to_the_last_byte(void)
{
	struct lw_pdu_config long_config = config;

	long_config.device_id[LW_DEVICE_ID_PRODUCT_CODE] = &LONG_TEXT[250 - 243];
	pdu.config = &long_config;
	ask(BYTES(17));
	TEST_ASSERT_EQUAL_UINT(LW_PDU_MAX, response_length); /* without the version */
	long_config.device_id[LW_DEVICE_ID_PRODUCT_CODE] = &LONG_TEXT[250 - 244];
	ask(BYTES(17));
	TEST_ASSERT_EQUAL_MEMORY(" vend 1.2", &response[4], 9);
}

/* ---- file records ---- */

static void number_records(void)
{
	for (unsigned int i = 0; i < sizeof(file_records); i++) {
		file_records[i] = (uint8_t)(i % 2 == 0 ? i / 2 >> 8 : i / 2);
	}
}

static void test_fc20_reads_groups(void)
{
	number_records();
	assert_answer(BYTES(20, 7, 6, 0, 1, 1, 0x2B, 0, 1), BYTES(20, 4, 3, 6, 1, 0x2B));
	assert_answer(BYTES(20, 14, 6, 0, 7, 0, 2, 0, 2, 6, 0, 1, 0, 9, 0, 1),
		      BYTES(20, 10, 5, 6, 0, 2, 0, 3, 3, 6, 0, 9));
}

static void test_fc20_limits(void)
{
	/* One group of 124 records fills the answer to 252 bytes; 125 are too many. */
	ask(BYTES(20, 7, 6, 0, 1, 0, 0, 0, 124));
	TEST_ASSERT_EQUAL_UINT(252, response_length);
	TEST_ASSERT_EQUAL_HEX8(250, response[1]);
	TEST_ASSERT_EQUAL_HEX8(249, response[2]);
	assert_refused(BYTES(20, 7, 6, 0, 1, 0, 0, 0, 125), 3, LW_REASON_ANSWER_TOO_LONG);
	assert_error_details(LW_NO_ADDRESS, 254, 253);
	assert_refused(BYTES(20, 14, 6, 0, 1, 0, 0, 0, 100, 6, 0, 1, 0, 0, 0, 100), 3,
		       LW_REASON_ANSWER_TOO_LONG);
	/* Up to 35 groups. */
	uint8_t request[2 + 36 * 7] = {20, 245};

	for (unsigned int i = 0; i < 36; i++) {
		memcpy(&request[2 + 7 * i], (const uint8_t[]){6, 0, 1, 0, 0, 0, 1}, 7);
	}
	ask(request, 2 + 245);
	TEST_ASSERT_EQUAL_UINT(2 + 35 * 4, response_length);
	request[1] = 252;
	assert_refused(request, 2 + 36 * 7 - 1, 3, LW_REASON_BAD_COUNT);
	assert_error_details(LW_NO_ADDRESS, 252, 245);
}

static void test_fc20_refusals(void)
{
	assert_refused(BYTES(20), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(20, 0), 3, LW_REASON_BAD_COUNT);
	assert_error_details(LW_NO_ADDRESS, 0, 7);
	assert_refused(BYTES(20, 6, 6, 0, 1, 0, 0, 0), 3, LW_REASON_BAD_COUNT);
	assert_refused(BYTES(20, 8, 6, 0, 1, 0, 0, 0, 1, 6), 3, LW_REASON_BAD_LENGTH);
	assert_error_details(LW_NO_ADDRESS, 8, 7);
	assert_refused(BYTES(20, 7, 6, 0, 1, 0, 0, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(20, 7, 6, 0, 1, 0, 0, 0, 1, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(20, 7, 5, 0, 1, 0, 0, 0, 1), 2, LW_REASON_BAD_REFERENCE_TYPE);
	assert_error_details(LW_NO_ADDRESS, 5, 6);
	assert_refused(BYTES(20, 7, 6, 0, 0, 0, 0, 0, 1), 2, LW_REASON_UNKNOWN_FILE);
	assert_refused(BYTES(20, 7, 6, 1, 1, 0, 0, 0, 1), 2, LW_REASON_UNKNOWN_FILE);
	assert_error_details(LW_NO_ADDRESS, 0x101, 0);
	assert_refused(BYTES(20, 7, 6, 0, 1, 0, 0, 0, 0), 3, LW_REASON_BAD_COUNT);
	assert_error_details(LW_NO_ADDRESS, 0, 1);
	assert_refused(BYTES(20, 7, 6, 0, 1, 1, 0x2B, 0, 2), 2, LW_REASON_UNKNOWN_RECORD);
	assert_error_details(300, 300, 300);
	assert_refused(BYTES(20, 7, 6, 0, 1, 0xFF, 0xFF, 0xFF, 0xFF), 2, LW_REASON_UNKNOWN_RECORD);
	assert_error_details(0xFFFF, 0x1FFFD, 300);
	/* a bad group behind a good one */
	assert_refused(BYTES(20, 14, 6, 0, 1, 0, 0, 0, 1, 6, 0, 7, 0, 4, 0, 1), 2,
		       LW_REASON_UNKNOWN_RECORD);
}

static void test_fc21_writes_groups(void)
{
	static const uint8_t request[] = {21,   20,   6, 0, 1, 0, 5,    0, 2, 0x12, 0x34,
					  0x56, 0x78, 6, 0, 1, 1, 0x2B, 0, 1, 0x9A, 0xBC};

	assert_answer(request, sizeof(request), request, sizeof(request));
	TEST_ASSERT_EQUAL_UINT(2, file_writes);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(((const uint8_t[]){0x12, 0x34, 0x56, 0x78}), &file_records[10],
				     4);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(((const uint8_t[]){0x9A, 0xBC}), &file_records[598], 2);
}

static void test_fc21_limits(void)
{
	uint8_t request[300] = {21, 251, 6, 0, 1, 0, 0, 0, 122};

	ask(request, 253);
	TEST_ASSERT_EQUAL_UINT(253, response_length);
	TEST_ASSERT_EQUAL_UINT(1, file_writes);
	request[1] = 252;
	assert_refused(request, 253, 3, LW_REASON_BAD_COUNT);
	request[1] = 251;
	request[8] = 123; /* longer than the request says */
	assert_refused(request, 253, 3, LW_REASON_BAD_LENGTH);
	assert_error_details(LW_NO_ADDRESS, 251, 253);
}

static void test_fc21_refusals_write_nothing(void)
{
	assert_refused(BYTES(21), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(21, 8, 6, 0, 1, 0, 0, 0, 1, 0), 3, LW_REASON_BAD_COUNT);
	assert_refused(BYTES(21, 9, 6, 0, 1, 0, 0, 0, 1, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(21, 9, 6, 0, 1, 0, 0, 0, 1, 0, 1, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(21, 9, 6, 0, 1, 0, 0, 0, 0, 0, 1), 3, LW_REASON_BAD_COUNT);
	assert_refused(BYTES(21, 9, 6, 0, 1, 0, 0, 0, 2, 0, 1), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(21, 9, 6, 0, 7, 0, 3, 0, 1, 0, 1), 2, LW_REASON_NOT_WRITABLE);
	assert_error_details(3, 7, 0);
	/* good groups before a bad one: an unknown record, a bad value, a torn head */
	assert_refused(BYTES(21, 18, 6, 0, 1, 0, 0, 0, 1, 0, 1, 6, 0, 1, 1, 0x2C, 0, 1, 0, 1), 2,
		       LW_REASON_UNKNOWN_RECORD);
	assert_refused(BYTES(21, 18, 6, 0, 1, 0, 0, 0, 1, 0, 1, 6, 0, 1, 0, 9, 0, 1, 0xBA, 0xD0), 3,
		       LW_REASON_OUT_OF_RANGE);
	assert_error_details(9, 0xBAD0, 0);
	assert_refused(BYTES(21, 11, 6, 0, 1, 0, 0, 0, 1, 0, 1, 6, 0), 3, LW_REASON_BAD_LENGTH);
	assert_refused(BYTES(21, 16, 6, 0, 1, 0, 0, 0, 1, 0, 1, 6, 0, 1, 0, 0, 0, 1), 3,
		       LW_REASON_BAD_LENGTH);
	assert_error_details(LW_NO_ADDRESS, 7, 9); /* a head, and nothing to write */
	file_is_busy = true;
	assert_refused(BYTES(21, 9, 6, 0, 1, 0, 0, 0, 1, 0, 1), 6, LW_REASON_BUSY_TRACKING);
	TEST_ASSERT_EQUAL_UINT(0, file_writes);
}

static void test_without_files(void)
{
	struct lw_pdu_config no_files = config;

	no_files.files = NULL;
	no_files.file_count = 0;
	pdu.config = &no_files;
	assert_refused(BYTES(20, 7, 6, 0, 1, 0, 0, 0, 1), 2, LW_REASON_UNKNOWN_FILE);
	assert_refused(BYTES(21, 9, 6, 0, 1, 0, 0, 0, 1, 0, 1), 2, LW_REASON_UNKNOWN_FILE);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_fc08_echo);
	RUN_TEST(test_fc08_reads_each_counter);
	RUN_TEST(test_fc08_diagnostic_register_and_clear);
	RUN_TEST(test_fc08_clear_overrun_counter);
	RUN_TEST(test_fc08_undefined_sub_functions);
	RUN_TEST(test_fc08_listen_only_until_restart);
	RUN_TEST(test_fc08_restart);
	RUN_TEST(test_fc43_streams);
	RUN_TEST(test_fc43_one_object);
	RUN_TEST(test_fc43_more_follows);
	RUN_TEST(test_fc43_an_object_fits_to_the_last_byte);
	RUN_TEST(test_fc17_a_text_fits_to_the_last_byte);
	RUN_TEST(test_fc43_refusals);
	RUN_TEST(test_fc17_server_id);
	RUN_TEST(test_fc17_leaves_out_a_text_that_does_not_fit);
	RUN_TEST(test_fc20_reads_groups);
	RUN_TEST(test_fc20_limits);
	RUN_TEST(test_fc20_refusals);
	RUN_TEST(test_fc21_writes_groups);
	RUN_TEST(test_fc21_limits);
	RUN_TEST(test_fc21_refusals_write_nothing);
	RUN_TEST(test_without_files);
	return UNITY_END();
}
