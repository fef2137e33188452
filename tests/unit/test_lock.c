/* SPDX-License-Identifier: Apache-2.0 */
/* The write lock by itself: codes, times, and how guessing is slowed down. */
#include <errno.h>

#include <unity.h>

#include "lw/device/lock.h"
#include "lw/map.h"

#define CODE 4711u
#define S    1000000u

static struct lw_lock lock;
static struct lw_refusal why;

void setUp(void)
{
	lock = (struct lw_lock){0};
	why = (struct lw_refusal){0};
}

void tearDown(void)
{
}

/* Try a code at a time, and open the lock if it is right. */
static int try_code(uint32_t given, uint64_t now_us)
{
	const int ret = lw_lock_allow(&lock, CODE, given, now_us, &why);

	if (ret == 0) {
		lw_lock_write(&lock, given, 30, now_us);
	}
	return ret;
}

static void test_closed_until_the_code_comes(void)
{
	TEST_ASSERT_TRUE(lw_lock_is_closed(&lock, CODE));
	TEST_ASSERT_EQUAL_INT(0, try_code(CODE, 0));
	TEST_ASSERT_FALSE(lw_lock_is_closed(&lock, CODE));
}

static void test_closes_by_itself_and_by_zero(void)
{
	TEST_ASSERT_EQUAL_INT(0, try_code(CODE, 5 * S));
	lw_lock_tick(&lock, 35 * S - 1);
	TEST_ASSERT_FALSE(lw_lock_is_closed(&lock, CODE));
	lw_lock_tick(&lock, 35 * S);
	TEST_ASSERT_TRUE(lw_lock_is_closed(&lock, CODE));

	TEST_ASSERT_EQUAL_INT(0, try_code(CODE, 40 * S));
	TEST_ASSERT_EQUAL_INT(0, try_code(CODE, 60 * S)); /* again: the time begins anew */
	lw_lock_tick(&lock, 70 * S);
	TEST_ASSERT_FALSE(lw_lock_is_closed(&lock, CODE));
	TEST_ASSERT_EQUAL_INT(0, try_code(0, 71 * S));
	TEST_ASSERT_TRUE(lw_lock_is_closed(&lock, CODE));
}

static void test_without_a_code_there_is_no_lock(void)
{
	TEST_ASSERT_FALSE(lw_lock_is_closed(&lock, 0));
	TEST_ASSERT_EQUAL_INT(0, lw_lock_allow(&lock, 0, 123, 0, &why));
	TEST_ASSERT_EQUAL_INT(0, lw_lock_allow(&lock, 0, 124, 0, &why));
}

static void test_a_wrong_code_is_not_shown(void)
{
	why.value = CODE + 1;
	TEST_ASSERT_EQUAL_INT(-EINVAL, try_code(CODE + 1, 0));
	TEST_ASSERT_EQUAL_UINT16(LW_REASON_WRONG_CODE, why.reason);
	TEST_ASSERT_EQUAL_INT32(0, why.value);
	TEST_ASSERT_TRUE(lw_lock_is_closed(&lock, CODE));
}

static void test_guessing_takes_longer_every_time(void)
{
	static const uint64_t waits_s[] = {1, 2, 4, 8, 16, 32, 64, 64, 64};
	uint64_t now_us = 0;

	for (unsigned int i = 0; i < sizeof(waits_s) / sizeof(waits_s[0]); i++) {
		TEST_ASSERT_EQUAL_INT(-EINVAL, try_code(1, now_us));
		now_us += waits_s[i] * S;
		/* Until then even the right code is not looked at, and a try does not prolong. */
		TEST_ASSERT_EQUAL_INT(-EBUSY, try_code(CODE, now_us - 1));
		TEST_ASSERT_EQUAL_UINT16(LW_REASON_UNLOCK_WAIT, why.reason);
	}
	TEST_ASSERT_EQUAL_INT(0, try_code(0, now_us - 1)); /* closing is always possible */
	TEST_ASSERT_EQUAL_INT(0, try_code(CODE, now_us));
	TEST_ASSERT_EQUAL_INT(-EINVAL, try_code(1, now_us));
	TEST_ASSERT_EQUAL_INT(0, try_code(CODE, now_us + S)); /* the right one began anew */
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_closed_until_the_code_comes);
	RUN_TEST(test_closes_by_itself_and_by_zero);
	RUN_TEST(test_without_a_code_there_is_no_lock);
	RUN_TEST(test_a_wrong_code_is_not_shown);
	RUN_TEST(test_guessing_takes_longer_every_time);
	return UNITY_END();
}
