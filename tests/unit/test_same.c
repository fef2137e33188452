/* SPDX-License-Identifier: Apache-2.0 */
/* Comparing objects by words. */
#include <unity.h>

#include "lw/bytes/same.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_every_bit_of_every_size_and_place_counts(void)
{
	char a[40];
	char b[40];

	for (size_t i = 0; i < sizeof(a); i++) {
		a[i] = (char)(i * 37);
		b[i] = a[i];
	}
	for (size_t begin = 0; begin < 4; begin++) {
		for (size_t size = 0; size <= sizeof(a) - begin; size++) {
			TEST_ASSERT_TRUE(lw_same(a + begin, b + begin, size));
			for (size_t bit = 0; bit < 8 * sizeof(a); bit++) {
				const size_t at = bit / 8;

				b[at] = (char)(b[at] ^ (1 << bit % 8));
				TEST_ASSERT_EQUAL(at < begin || at >= begin + size,
						  lw_same(a + begin, b + begin, size));
				b[at] = a[at];
			}
		}
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_every_bit_of_every_size_and_place_counts);
	return UNITY_END();
}
