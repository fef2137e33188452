/* SPDX-License-Identifier: Apache-2.0 */
/* Modbus RTU framing: CRC, silence, gaps, lengths. */
#include <errno.h>
#include <string.h>

#include <unity.h>

#include "lw/modbus/crc16.h"
#include "lw/modbus/rtu.h"

#define SILENCE_US 1750u
#define GAP_US     750u

static struct lw_rtu rtu;
static const uint8_t *frame;

/* The examples of MODBUS over Serial Line and of many vendors' manuals, low byte of the CRC first.
 */
static const uint8_t read_inputs[] = {0x01, 0x04, 0x00, 0x00, 0x00, 0x01, 0x31, 0xCA};
static const uint8_t read_holding[] = {0x11, 0x03, 0x00, 0x6B, 0x00, 0x03, 0x76, 0x87};

void setUp(void)
{
	lw_rtu_init(&rtu, &(struct lw_rtu_config){.silence_us = SILENCE_US});
	frame = NULL;
}

void tearDown(void)
{
}

#define ASSERT_TAKEN(bytes, count, now_us)                                                         \
	TEST_ASSERT_EQUAL_INT(0, lw_rtu_receive(&rtu, bytes, count, now_us))
#define ASSERT_POLL(expected, now_us)                                                              \
	TEST_ASSERT_EQUAL_INT(expected, lw_rtu_poll(&rtu, now_us, &frame))

static void test_crc_of_known_frames(void)
{
	TEST_ASSERT_EQUAL_HEX16(0xFFFF, lw_crc16(NULL, 0));
	TEST_ASSERT_EQUAL_HEX16(0x4B37, lw_crc16((const uint8_t *)"123456789", 9));
	TEST_ASSERT_EQUAL_HEX16(0x1241, lw_crc16((const uint8_t[]){0x02, 0x07}, 2));
	TEST_ASSERT_EQUAL_HEX16(0xCA31, lw_crc16(read_inputs, 6));
	TEST_ASSERT_EQUAL_HEX16(0x8776, lw_crc16(read_holding, 6));
	TEST_ASSERT_EQUAL_HEX16(0, lw_crc16(read_holding, 8));
}

static void test_crc_finds_every_single_and_double_bit_error(void)
{
	uint8_t bytes[sizeof(read_inputs)];

	for (unsigned int i = 0; i < 8 * sizeof(bytes); i++) {
		for (unsigned int j = i; j < 8 * sizeof(bytes); j++) {
			memcpy(bytes, read_inputs, sizeof(bytes));
			bytes[i / 8] ^= (uint8_t)(1u << (i % 8));
			if (j != i) {
				bytes[j / 8] ^= (uint8_t)(1u << (j % 8));
			}
			TEST_ASSERT_NOT_EQUAL(0, lw_crc16(bytes, sizeof(bytes)));
		}
	}
}

static void test_silence_by_baud_rate(void)
{
	TEST_ASSERT_EQUAL_UINT32(32084, lw_rtu_silence_us(1200));
	TEST_ASSERT_EQUAL_UINT32(4011, lw_rtu_silence_us(9600));
	TEST_ASSERT_EQUAL_UINT32(2006, lw_rtu_silence_us(19200));
	TEST_ASSERT_EQUAL_UINT32(1750, lw_rtu_silence_us(38400));
	TEST_ASSERT_EQUAL_UINT32(1750, lw_rtu_silence_us(115200));
}

static void test_seal_appends_the_crc_low_byte_first(void)
{
	uint8_t bytes[8];

	memcpy(bytes, read_inputs, 6);
	TEST_ASSERT_EQUAL_UINT(8, lw_rtu_seal(bytes, 6));
	TEST_ASSERT_EQUAL_HEX8_ARRAY(read_inputs, bytes, 8);
}

static void test_a_frame_is_complete_after_the_silence(void)
{
	TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, lw_rtu_deadline_us(&rtu));
	ASSERT_POLL(0, 0);
	ASSERT_POLL(0, UINT64_MAX);
	ASSERT_TAKEN(read_inputs, 8, 1000);
	TEST_ASSERT_EQUAL_UINT64(1000 + SILENCE_US, lw_rtu_deadline_us(&rtu));
	ASSERT_POLL(0, 1000 + SILENCE_US - 1);
	ASSERT_POLL(6, 1000 + SILENCE_US);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(read_inputs, frame, 6);
	ASSERT_POLL(0, 1000 + SILENCE_US);
	TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, lw_rtu_deadline_us(&rtu));
}

static void test_bytes_one_by_one_just_inside_the_silence(void)
{
	uint64_t now_us = 0;

	for (unsigned int i = 0; i < sizeof(read_inputs); i++) {
		now_us += SILENCE_US - 1;
		ASSERT_TAKEN(&read_inputs[i], 1, now_us);
	}
	ASSERT_POLL(6, now_us + SILENCE_US);
}

static void test_bytes_after_a_silence_are_a_new_frame(void)
{
	ASSERT_TAKEN(read_inputs, 8, 0);
	TEST_ASSERT_EQUAL_INT(-EAGAIN, lw_rtu_receive(&rtu, read_holding, 8, SILENCE_US));
	ASSERT_POLL(6, SILENCE_US);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(read_inputs, frame, 6);
	ASSERT_TAKEN(read_holding, 8, SILENCE_US);
	ASSERT_POLL(6, 2 * SILENCE_US);
	TEST_ASSERT_EQUAL_HEX8_ARRAY(read_holding, frame, 6);
}

static void test_no_bytes_change_nothing(void)
{
	ASSERT_TAKEN(read_inputs, 8, 0);
	ASSERT_TAKEN(read_inputs, 0, 1000);
	ASSERT_TAKEN(read_inputs, 0, 10 * SILENCE_US);
	TEST_ASSERT_EQUAL_UINT64(SILENCE_US, lw_rtu_deadline_us(&rtu));
	ASSERT_POLL(6, SILENCE_US);
}

static void test_frames_without_a_silence_between_are_dropped(void)
{
	ASSERT_TAKEN(read_inputs, 8, 0);
	ASSERT_TAKEN(read_holding, 8, 100);
	ASSERT_POLL(-EBADMSG, 100 + SILENCE_US);
	ASSERT_TAKEN(read_inputs, 8, 100 + SILENCE_US);
	ASSERT_POLL(6, 100 + 2 * SILENCE_US);
}

static void test_garbage_and_a_silence_do_not_harm_the_next_frame(void)
{
	ASSERT_TAKEN(read_holding, 5, 0);
	ASSERT_POLL(-EBADMSG, SILENCE_US);
	ASSERT_TAKEN(read_inputs, 8, SILENCE_US);
	ASSERT_POLL(6, 2 * SILENCE_US);
}

static void test_short_frames_are_dropped(void)
{
	uint64_t now_us = 0;

	for (size_t length = 1; length < 4; length++) {
		uint8_t bytes[4] = {0x11};

		/* With a correct CRC from 2 bytes on: the length alone is wrong. */
		(void)lw_rtu_seal(bytes, length < 2 ? 0 : length - 2);
		ASSERT_TAKEN(bytes, length, now_us);
		now_us += SILENCE_US;
		ASSERT_POLL(-EBADMSG, now_us);
	}
}

static void test_the_longest_frame_and_one_byte_more(void)
{
	uint8_t bytes[300] = {0x11, 0x10};

	TEST_ASSERT_EQUAL_UINT(LW_RTU_FRAME_MAX, lw_rtu_seal(bytes, 254));
	ASSERT_TAKEN(bytes, 256, 0);
	ASSERT_POLL(254, SILENCE_US);

	TEST_ASSERT_EQUAL_UINT(257, lw_rtu_seal(bytes, 255));
	ASSERT_TAKEN(bytes, 257, SILENCE_US);
	ASSERT_POLL(-EMSGSIZE, 2 * SILENCE_US);

	ASSERT_TAKEN(bytes, 256, 2 * SILENCE_US);
	ASSERT_TAKEN(&bytes[256], 1, 2 * SILENCE_US + 1);
	ASSERT_TAKEN(bytes, 300, 2 * SILENCE_US + 2);
	TEST_ASSERT_EQUAL_UINT64(3 * SILENCE_US + 2, lw_rtu_deadline_us(&rtu));
	ASSERT_POLL(-EMSGSIZE, 3 * SILENCE_US + 2);

	ASSERT_TAKEN(read_inputs, 8, 3 * SILENCE_US + 2);
	ASSERT_POLL(6, 4 * SILENCE_US + 2);
}

static void test_a_pause_inside_a_frame_spoils_it(void)
{
	const struct lw_rtu_config config = {.silence_us = SILENCE_US, .character_gap_us = GAP_US};

	lw_rtu_init(&rtu, &config);
	ASSERT_TAKEN(read_inputs, 3, 10000);
	ASSERT_TAKEN(&read_inputs[3], 5, 10000 + GAP_US);
	ASSERT_POLL(6, 20000);

	ASSERT_TAKEN(read_inputs, 3, 30000);
	ASSERT_TAKEN(&read_inputs[3], 4, 30000 + GAP_US + 1);
	ASSERT_TAKEN(&read_inputs[7], 1, 30000 + GAP_US + 1);
	ASSERT_POLL(-EBADMSG, 40000);

	ASSERT_TAKEN(read_inputs, 8, 50000);
	ASSERT_POLL(6, 60000);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_crc_of_known_frames);
	RUN_TEST(test_crc_finds_every_single_and_double_bit_error);
	RUN_TEST(test_silence_by_baud_rate);
	RUN_TEST(test_seal_appends_the_crc_low_byte_first);
	RUN_TEST(test_a_frame_is_complete_after_the_silence);
	RUN_TEST(test_bytes_one_by_one_just_inside_the_silence);
	RUN_TEST(test_bytes_after_a_silence_are_a_new_frame);
	RUN_TEST(test_no_bytes_change_nothing);
	RUN_TEST(test_frames_without_a_silence_between_are_dropped);
	RUN_TEST(test_garbage_and_a_silence_do_not_harm_the_next_frame);
	RUN_TEST(test_short_frames_are_dropped);
	RUN_TEST(test_the_longest_frame_and_one_byte_more);
	RUN_TEST(test_a_pause_inside_a_frame_spoils_it);
	return UNITY_END();
}
