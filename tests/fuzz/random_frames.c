/* SPDX-License-Identifier: Apache-2.0 */
/*
 * random_frames COUNT SEED: that many frames, valid, mutated, truncated, glued and mere noise, into
 * the slave of a whole simulated machine. The judge says after each what it may have done, and a
 * valid request must be answered straight afterwards. The same seed makes the same frames.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "judge.h"

#define FRAME_ROOM         600u
/** Parameters drift far from what a machine has: begin anew from time to time. */
#define FRAMES_PER_MACHINE 20000u
#define FRAMES_PER_MS      16u
/** Of every thousand frames at least so many must end in each outcome, or the mix is no test. */
#define OUTCOME_MIN        1u

static uint64_t random_state;

/* xorshift64* (Vigna 2016) */
static uint32_t random_u32(void)
{
	random_state ^= random_state >> 12;
	random_state ^= random_state << 25;
	random_state ^= random_state >> 27;
	return (uint32_t)((random_state * 0x2545F4914F6CDD1Du) >> 32);
}

static uint32_t below(uint32_t limit)
{
	return random_u32() % limit;
}

static size_t put_u16(uint8_t *at, uint32_t value)
{
	at[0] = (uint8_t)(value >> 8);
	at[1] = (uint8_t)value;
	return 2;
}

/* An address where something is, near it, or anywhere. */
static uint32_t near(const uint16_t *beginnings, uint32_t count)
{
	const uint32_t beginning = beginnings[below(count)];

	return below(16) == 0 ? below(0x10000) : beginning + below(2) * below(8);
}

static uint32_t bit_address(void)
{
	return below(8) == 0 ? below(0x10000) : below(10);
}

static uint32_t input_address(void)
{
	static const uint16_t beginnings[] = {0, 100, 200, 300, 400, 410, 500, 1100, 1170, 2180};

	return near(beginnings, sizeof(beginnings) / sizeof(beginnings[0]));
}

static uint32_t holding_address(void)
{
	/* Parameters one by one: half of a pair cannot be written. */
	static const uint16_t beginnings[] = {0,   1,   2,   3,   4,   100, 101,   102,   103,
					      110, 111, 112, 114, 120, 122, 140,   142,   160,
					      170, 171, 180, 181, 183, 184, 61440, 61443, 61450};

	return near(beginnings, sizeof(beginnings) / sizeof(beginnings[0]));
}

static uint32_t some_count(uint32_t max)
{
	switch (below(8)) {
	case 0:
		return below(0x10000);
	case 1:
		return max + below(2);
	default:
		return 1 + below(4);
	}
}

/* Mostly small, and then what lies at the limits. */
static uint32_t some_value(void)
{
	static const uint16_t special[] = {0x0000, 0x0001, 0x7FFF, 0x8000, 0xFFFF, 0xFF00};

	switch (below(4)) {
	case 0:
		return special[below(sizeof(special) / sizeof(special[0]))];
	case 1:
		return below(0x10000);
	default:
		return below(16);
	}
}

static size_t put_values(uint8_t *at, uint32_t count)
{
	size_t length = 0;

	for (uint32_t i = 0; i < count && length < 246; i++) {
		length += put_u16(at + length, some_value());
	}
	return length;
}

static uint8_t some_unit(uint8_t own)
{
	switch (below(16)) {
	case 0:
		return 0;
	case 1:
		return (uint8_t)below(256);
	default:
		return own;
	}
}

/* A request of one of the functions, mostly well formed. @return its bytes without the CRC */
static size_t make_request(uint8_t *frame, uint8_t own_unit)
{
	static const uint8_t functions[] = {1, 2, 3, 4, 5, 6, 8, 15, 16, 17, 20, 21, 22, 23, 43};
	const uint8_t function =
		below(16) == 0 ? (uint8_t)below(256) : functions[below(sizeof(functions))];
	uint32_t count;
	size_t length = 0;

	frame[length++] = some_unit(own_unit);
	frame[length++] = function;
	switch (function) {
	case 1:
	case 2:
		length += put_u16(frame + length, bit_address());
		return length + put_u16(frame + length, some_count(2000));
	case 3:
	case 4:
		length += put_u16(frame + length,
				  function == 3 ? holding_address() : input_address());
		return length + put_u16(frame + length, some_count(125));
	case 5:
		length += put_u16(frame + length, below(10));
		return length +
		       put_u16(frame + length, below(4) ? 0xFF00u * below(2) : below(65536));
	case 6:
		length += put_u16(frame + length, holding_address());
		return length + put_u16(frame + length, some_value());
	case 8:
		length += put_u16(frame + length, below(24));
		return length + put_u16(frame + length, below(4) ? 0 : some_value());
	case 15:
		count = below(2) ? 1 + below(8) : some_count(1968);
		length += put_u16(frame + length, bit_address());
		length += put_u16(frame + length, count);
		frame[length++] = (uint8_t)((count + 7) / 8);
		frame[length] = (uint8_t)(1u << below(8));
		return length + 1 + (count > 8 ? below(200) : 0);
	case 16:
		count = below(8) ? 1 + below(4) : some_count(123);
		length += put_u16(frame + length, holding_address());
		length += put_u16(frame + length, count);
		frame[length++] = (uint8_t)(2 * count);
		return length + put_values(frame + length, count);
	case 20:
		frame[length++] = 7;
		frame[length++] = 6;
		return length + put_values(frame + length, 3);
	case 21:
		frame[length++] = 9;
		frame[length++] = 6;
		return length + put_values(frame + length, 4);
	case 22:
		length += put_u16(frame + length, holding_address());
		return length + put_values(frame + length, 2);
	case 23:
		count = 1 + below(4);
		length += put_u16(frame + length, holding_address());
		length += put_u16(frame + length, 1 + below(8));
		length += put_u16(frame + length, holding_address());
		length += put_u16(frame + length, count);
		frame[length++] = (uint8_t)(2 * count);
		return length + put_values(frame + length, count);
	case 43:
		frame[length++] = 14;
		frame[length++] = (uint8_t)below(6);
		frame[length++] = (uint8_t)below(8);
		return length;
	default:
		return length + put_values(frame + length, below(4));
	}
}

static size_t make_noise(uint8_t *frame)
{
	const size_t length = below(4) ? below(20) : below(300);

	for (size_t i = 0; i < length; i++) {
		frame[i] = (uint8_t)random_u32();
	}
	return length;
}

static size_t make_frame(uint8_t frame[FRAME_ROOM], uint8_t own_unit)
{
	size_t length;
	size_t second;

	memset(frame, 0, FRAME_ROOM);
	switch (below(10)) {
	case 0: /* noise, now and then with a right CRC */
		length = make_noise(frame);
		return below(2) ? length : judge_seal(frame, length);
	case 1: /* truncated */
		length = judge_seal(frame, make_request(frame, own_unit));
		return below((uint32_t)length);
	case 2: /* glued */
		length = judge_seal(frame, make_request(frame, own_unit));
		second = make_request(frame + length, own_unit);
		return length + judge_seal(frame + length, second);
	case 3: /* mutated, the CRC as it was */
		length = judge_seal(frame, make_request(frame, own_unit));
		frame[below((uint32_t)length)] ^= (uint8_t)(1u << below(8));
		return length;
	case 4: /* mutated, the CRC right */
		length = make_request(frame, own_unit);
		frame[below((uint32_t)length)] = (uint8_t)random_u32();
		return judge_seal(frame, length - below(2) + below(2));
	default:
		return judge_seal(frame, make_request(frame, own_unit));
	}
}

int main(int argc, char **argv)
{
	static const char *const names[JUDGE_OUTCOME_COUNT] = {"dropped", "broadcast", "unheard",
							       "answered", "refused"};
	static struct judge judge;
	uint32_t outcomes[JUDGE_OUTCOME_COUNT] = {0};
	uint32_t count;

	if (argc != 3) {
		fputs("usage: random_frames COUNT SEED\n", stderr);
		return 2;
	}
	count = (uint32_t)strtoul(argv[1], NULL, 10);
	random_state = strtoull(argv[2], NULL, 10) | 1u;
	for (uint32_t i = 0; i < count; i++) {
		uint8_t frame[FRAME_ROOM];
		size_t length;

		if (i % FRAMES_PER_MACHINE == 0) {
			judge_init(&judge, random_state);
		}
		length = make_frame(frame, judge.world.device.slave.config->unit_id);
		outcomes[judge_frame(&judge, frame, length, below(4) ? 0 : length / 2)]++;
		/* Listen only mode shall be heard of, too, before it is ended. */
		if (!judge.world.device.slave.pdu.listen_only || below(4) == 0) {
			judge_alive(&judge);
		}
		if (i % FRAMES_PER_MS == 0) {
			judge_run_ms(&judge, 1);
		}
	}
	for (int i = 0; i < JUDGE_OUTCOME_COUNT; i++) {
		printf("%s %" PRIu32 "\n", names[i], outcomes[i]);
		if (outcomes[i] < count / 1000 * OUTCOME_MIN) {
			fprintf(stderr, "random_frames: too few are %s\n", names[i]);
			return EXIT_FAILURE;
		}
	}
	return EXIT_SUCCESS;
}
