/* SPDX-License-Identifier: Apache-2.0 */
/* SHA-256 against the examples of FIPS 180-4, and against `sha256sum` at every length. */
#include <string.h>

#include <unity.h>

#include "lw/bytes/sha256.h"

#define LENGTHS 201u

static char text[2 * LW_SHA256_SIZE + 1];
static uint8_t letters[1000000];

void setUp(void)
{
}

void tearDown(void)
{
}

static const char *digest_of(const void *bytes, size_t length)
{
	static const char digits[] = "0123456789abcdef";
	uint8_t digest[LW_SHA256_SIZE];

	lw_sha256(bytes, length, digest);
	for (size_t i = 0; i < sizeof(digest); i++) {
		text[2 * i] = digits[digest[i] >> 4];
		text[2 * i + 1] = digits[digest[i] & 0xF];
	}
	return text;
}

static void test_the_examples_of_the_standard(void)
{
	static const char two_blocks[] = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";

	TEST_ASSERT_EQUAL_STRING("ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
				 digest_of("abc", 3));
	TEST_ASSERT_EQUAL_STRING("248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1",
				 digest_of(two_blocks, strlen(two_blocks)));
	TEST_ASSERT_EQUAL_STRING("e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855",
				 digest_of(NULL, 0));
	memset(letters, 'a', sizeof(letters));
	TEST_ASSERT_EQUAL_STRING("cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0",
				 digest_of(letters, sizeof(letters)));
}

/* The digest of the digests of the first 0 to 200 bytes of a pattern, as Python's hashlib has it.
 */
static void test_every_length_around_a_block(void)
{
	static uint8_t digests[LENGTHS][LW_SHA256_SIZE];
	uint8_t bytes[LENGTHS];

	for (size_t i = 0; i < sizeof(bytes); i++) {
		bytes[i] = (uint8_t)(i * 37 + 11);
	}
	for (size_t length = 0; length < LENGTHS; length++) {
		lw_sha256(bytes, length, digests[length]);
	}
	TEST_ASSERT_EQUAL_STRING("09bba6f21f157de4b22c6e4e84e0fe17119f27833e9cd1aaaeb82855755a2130",
				 digest_of(digests, sizeof(digests)));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_the_examples_of_the_standard);
	RUN_TEST(test_every_length_around_a_block);
	return UNITY_END();
}
