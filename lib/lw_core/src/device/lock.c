/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/device/lock.h"

#include <errno.h>

#include "lw/map.h"

#define US_PER_S 1000000u

/** The wait after a wrong code is 1 s << (wrong codes in a row - 1), up to 64 s. */
#define WRONG_CODES_MAX 7u

int lw_lock_check(const struct lw_lock *lock, uint32_t code, struct lw_refusal *why)
{
	if (lw_lock_is_closed(lock, code)) {
		why->reason = LW_REASON_LOCKED;
		return -EBUSY;
	}
	return 0;
}

int lw_lock_allow(struct lw_lock *lock, uint32_t code, uint32_t given, uint64_t now_us,
		  struct lw_refusal *why)
{
	if (given == 0 || code == 0) {
		return 0;
	}
	why->value = 0; /* nearly the right code, perhaps: not for everybody's eyes */
	if (now_us < lock->next_try_us) {
		why->reason = LW_REASON_UNLOCK_WAIT;
		return -EBUSY;
	}
	if (given != code) {
		if (lock->wrong_codes < WRONG_CODES_MAX) {
			lock->wrong_codes++;
		}
		lock->next_try_us = now_us + ((uint64_t)US_PER_S << (lock->wrong_codes - 1));
		why->reason = LW_REASON_WRONG_CODE;
		return -EINVAL;
	}
	return 0;
}

void lw_lock_write(struct lw_lock *lock, uint32_t given, uint32_t timeout_s, uint64_t now_us)
{
	lock->open = given != 0;
	lock->closes_us = now_us + (uint64_t)timeout_s * US_PER_S;
	if (lock->open) {
		lock->wrong_codes = 0;
	}
}

void lw_lock_tick(struct lw_lock *lock, uint64_t now_us)
{
	if (now_us >= lock->closes_us) {
		lock->open = false;
	}
}
