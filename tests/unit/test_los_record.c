/* SPDX-License-Identifier: Apache-2.0 */
/* The records of loss of synchronization: what counts as one, and what an indexing clears. */
#include <unity.h>

#include "lw/control/los_record.h"

static struct lw_los los;

void setUp(void)
{
	los = (struct lw_los){0};
}

void tearDown(void)
{
}

static void test_each_kind_alone_is_a_loss(void)
{
	struct lw_los_record *const records[] = {&los.los1[0], &los.los1[1], &los.los2[0],
						 &los.los2[1], &los.encoder};

	TEST_ASSERT_FALSE(lw_los_any(&los));
	for (size_t i = 0; i < sizeof(records) / sizeof(records[0]); i++) {
		lw_los_note(records[i], 5000000, 77);
		TEST_ASSERT_TRUE(lw_los_any(&los));
		records[i]->set = false;
		TEST_ASSERT_FALSE(lw_los_any(&los));
	}
}

static void test_a_record_says_when_and_where_the_first_was_and_how_many(void)
{
	los.los2[1].before_power_up = true;
	lw_los_note(&los.los2[1], 5000999, 77);
	TEST_ASSERT_FALSE(los.los2[1].before_power_up);
	lw_los_note(&los.los2[1], 6000000, 99);
	TEST_ASSERT_EQUAL_UINT16(2, los.los2[1].count);
	TEST_ASSERT_EQUAL_INT32(77, los.los2[1].position_q16);
	TEST_ASSERT_EQUAL_UINT32(5000, los.los2[1].time_ms);
	los.los2[1].count = UINT16_MAX;
	lw_los_note(&los.los2[1], 7000000, 99);
	TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, los.los2[1].count);
}

static void test_an_indexing_clears_all_but_an_encoder_that_is_not_proved(void)
{
	lw_los_note(&los.los1[0], 5000000, 77);
	lw_los_note(&los.los1[1], 5000000, 77);
	lw_los_note(&los.los2[0], 5000000, 77);
	lw_los_note(&los.los2[1], 5000000, 77);
	lw_los_note(&los.encoder, 5000000, 77);
	los.recoveries = 3;
	lw_los_indexed(&los, false);
	TEST_ASSERT_EQUAL_UINT16(0, los.recoveries);
	TEST_ASSERT_FALSE(los.los1[0].set || los.los1[1].set || los.los2[0].set || los.los2[1].set);
	TEST_ASSERT_TRUE(los.encoder.set);
	lw_los_indexed(&los, true);
	TEST_ASSERT_FALSE(lw_los_any(&los));
	TEST_ASSERT_EQUAL_UINT16(1, los.encoder.count); /* how many there were stays */
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_each_kind_alone_is_a_loss);
	RUN_TEST(test_a_record_says_when_and_where_the_first_was_and_how_many);
	RUN_TEST(test_an_indexing_clears_all_but_an_encoder_that_is_not_proved);
	return UNITY_END();
}
