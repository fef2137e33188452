/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/bytes/sha256.h"

#include <string.h>

#include "lw/bytes/big_endian.h"

#define BLOCK_SIZE 64u
#define ROUNDS     64u
#define WORDS      8u

static inline uint32_t rotate_right(uint32_t word, unsigned int bits)
{
	return word >> bits | word << (32u - bits);
}

/* One block into the state. Of the 64 words of its schedule the last 16 are kept. */
static void take_block(uint32_t state[WORDS], const uint8_t *block)
{
	static const uint32_t constants[ROUNDS] = {
		0x428A2F98u, 0x71374491u, 0xB5C0FBCFu, 0xE9B5DBA5u, 0x3956C25Bu, 0x59F111F1u,
		0x923F82A4u, 0xAB1C5ED5u, 0xD807AA98u, 0x12835B01u, 0x243185BEu, 0x550C7DC3u,
		0x72BE5D74u, 0x80DEB1FEu, 0x9BDC06A7u, 0xC19BF174u, 0xE49B69C1u, 0xEFBE4786u,
		0x0FC19DC6u, 0x240CA1CCu, 0x2DE92C6Fu, 0x4A7484AAu, 0x5CB0A9DCu, 0x76F988DAu,
		0x983E5152u, 0xA831C66Du, 0xB00327C8u, 0xBF597FC7u, 0xC6E00BF3u, 0xD5A79147u,
		0x06CA6351u, 0x14292967u, 0x27B70A85u, 0x2E1B2138u, 0x4D2C6DFCu, 0x53380D13u,
		0x650A7354u, 0x766A0ABBu, 0x81C2C92Eu, 0x92722C85u, 0xA2BFE8A1u, 0xA81A664Bu,
		0xC24B8B70u, 0xC76C51A3u, 0xD192E819u, 0xD6990624u, 0xF40E3585u, 0x106AA070u,
		0x19A4C116u, 0x1E376C08u, 0x2748774Cu, 0x34B0BCB5u, 0x391C0CB3u, 0x4ED8AA4Au,
		0x5B9CCA4Fu, 0x682E6FF3u, 0x748F82EEu, 0x78A5636Fu, 0x84C87814u, 0x8CC70208u,
		0x90BEFFFAu, 0xA4506CEBu, 0xBEF9A3F7u, 0xC67178F2u};
	uint32_t schedule[16];
	uint32_t s[WORDS];

	memcpy(s, state, sizeof(s));
	for (unsigned int round = 0; round < ROUNDS; round++) {
		uint32_t *word = &schedule[round % 16];

		if (round < 16) {
			*word = lw_get32(block + (size_t)4 * round);
		} else {
			const uint32_t w1 = schedule[(round + 1) % 16];
			const uint32_t w14 = schedule[(round + 14) % 16];

			*word += (rotate_right(w1, 7) ^ rotate_right(w1, 18) ^ w1 >> 3) +
				 schedule[(round + 9) % 16] +
				 (rotate_right(w14, 17) ^ rotate_right(w14, 19) ^ w14 >> 10);
		}

		const uint32_t a = s[0];
		const uint32_t e = s[4];
		const uint32_t t1 =
			s[7] + (rotate_right(e, 6) ^ rotate_right(e, 11) ^ rotate_right(e, 25)) +
			((e & s[5]) ^ (~e & s[6])) + constants[round] + *word;
		const uint32_t t2 =
			(rotate_right(a, 2) ^ rotate_right(a, 13) ^ rotate_right(a, 22)) +
			((a & s[1]) ^ (a & s[2]) ^ (s[1] & s[2]));

		memmove(&s[1], &s[0], (WORDS - 1) * sizeof(s[0]));
		s[4] += t1;
		s[0] = t1 + t2;
	}
	for (unsigned int i = 0; i < WORDS; i++) {
		state[i] += s[i];
	}
}

void lw_sha256(const uint8_t *bytes, size_t length, uint8_t digest[LW_SHA256_SIZE])
{
	uint32_t state[WORDS] = {0x6A09E667u, 0xBB67AE85u, 0x3C6EF372u, 0xA54FF53Au,
				 0x510E527Fu, 0x9B05688Cu, 0x1F83D9ABu, 0x5BE0CD19u};
	const size_t whole = length / BLOCK_SIZE;
	const size_t left = length % BLOCK_SIZE;
	uint8_t last[BLOCK_SIZE] = {0};

	for (size_t i = 0; i < whole; i++) {
		take_block(state, bytes + i * BLOCK_SIZE);
	}
	if (left > 0) {
		memcpy(last, bytes + whole * BLOCK_SIZE, left);
	}
	last[left] = 0x80;
	/* One byte, and the length in bits: where they do not fit, they have a block of their own.
	 */
	if (left + 1 + 8 > BLOCK_SIZE) {
		take_block(state, last);
		memset(last, 0, sizeof(last));
	}
	(void)lw_put32(&last[BLOCK_SIZE - 8], (uint32_t)((uint64_t)length >> 29));
	(void)lw_put32(&last[BLOCK_SIZE - 4], (uint32_t)length << 3);
	take_block(state, last);
	for (unsigned int i = 0; i < WORDS; i++) {
		(void)lw_put32(digest + (size_t)4 * i, state[i]);
	}
}
