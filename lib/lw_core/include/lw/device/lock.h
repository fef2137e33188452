/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The write lock: a code opens it for a time. It keeps parameters from being changed by mistake or
 * by somebody who shall not; it is no protection against who can open the housing.
 *
 * Not for interrupt context.
 */
#ifndef LW_LOCK_H
#define LW_LOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/map/refusal.h"

/** State. All zero: closed. The lock is of use only while there is a code that is not 0. */
struct lw_lock {
	bool open;
	uint64_t closes_us;
	uint8_t wrong_codes;  /**< in a row, at most as many as still make the wait longer */
	uint64_t next_try_us; /**< no code is looked at before */
};

/** Is the lock closed? `code` is the one that opens it, 0: there is no lock. */
static inline bool lw_lock_is_closed(const struct lw_lock *lock, uint32_t code)
{
	return code != 0 && !lock->open;
}

/**
 * May what the lock guards be changed?
 *
 * @retval 0 yes
 * @retval -EBUSY it is closed; `why->reason` says so
 */
int lw_lock_check(const struct lw_lock *lock, uint32_t code, struct lw_refusal *why);

/**
 * May this be written to the register unlock? Counts a wrong code: after the first, codes are not
 * looked at for one second, and after each further one for twice as long, at most 64 s.
 *
 * @param given what is written; 0 closes the lock and is always allowed
 * @retval 0 yes
 * @retval -EINVAL a wrong code
 * @retval -EBUSY too soon after a wrong code
 */
int lw_lock_allow(struct lw_lock *lock, uint32_t code, uint32_t given, uint64_t now_us,
		  struct lw_refusal *why);

/** Take what lw_lock_allow() has allowed: open for so long, or close. */
void lw_lock_write(struct lw_lock *lock, uint32_t given, uint32_t timeout_s, uint64_t now_us);

/** Close when the time is up. */
void lw_lock_tick(struct lw_lock *lock, uint64_t now_us);

#endif /* LW_LOCK_H */
