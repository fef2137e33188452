/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What needs a look at the rope, as it is stored: losses of synchronization that no indexing has
 * cleared, and rope laid while the carriage stood that nobody has acknowledged. And how much rope
 * is on the drum, and where it goes on. Not for interrupt context.
 */
#ifndef LW_LOOK_RECORD_H
#define LW_LOOK_RECORD_H

#include <stddef.h>
#include <stdint.h>

#include "lw/storage/record.h"

/** Causes; bit numbers of lw_look.causes and of the register look_before_power_up. */
enum lw_look_cause {
	LW_LOOK_LOS1_PLUS,
	LW_LOOK_LOS1_MINUS,
	LW_LOOK_LOS2_PLUS,
	LW_LOOK_LOS2_MINUS,
	LW_LOOK_ROPE_STANDING,
	LW_LOOK_ENCODER,
	LW_LOOK_REACQUIRED,
	LW_LOOK_CAUSES,
};

/** Schema of the record. A further cause needs no other one. */
#define LW_LOOK_RECORD_SCHEMA 1

/** Marks that the record has room for, so that what follows them keeps its place. */
#define LW_LOOK_MARKS 14

/**
 * Bytes of the record: causes, turns, whether the place was known, the marks, the rope on the drum
 * and where it goes on. Firmware that does not know the last ones reads the rest.
 */
#define LW_LOOK_RECORD_SIZE (LW_RECORD_OVERHEAD + 3 * 4 + 8 * LW_LOOK_MARKS + 4 * 4 + 8 * 4)

/** Where and when. */
struct lw_look_mark {
	int32_t position_um;
	uint32_t time_ms; /**< since the power-up that it happened in */
};

/** What needs a look. All zero: nothing. 32-bit members only: compare it as bytes. */
struct lw_look {
	uint32_t causes;            /**< 1 << enum lw_look_cause, or-ed */
	uint32_t standing_millirev; /**< drum turns laid while the carriage stood */
	uint32_t standing_place_known;
	struct lw_look_mark marks[LW_LOOK_CAUSES]; /**< zero where the cause is not set */
	/* The rope on the drum, see lw/control/rope_length.h. */
	uint32_t rope_told; /**< 0: nothing was told, and the rest is zero */
	int32_t rope_told_mm;
	uint32_t rope_turns_high; /**< turns since then, Q16 in 64 bit */
	uint32_t rope_turns_low;
	/* Where the rope goes on, see struct lw_resume; all zero: not known. */
	uint32_t resume_flags; /**< 1 known, 2 doubtful */
	uint32_t resume_pattern;
	int32_t resume_m;
	int32_t resume_u;
	uint32_t resume_dwell_edges;
	uint32_t resume_cycle_plus;
	uint32_t resume_cycle_minus;
	int32_t resume_stand_usteps;
};

/** Bits of lw_look.resume_flags. */
enum {
	LW_LOOK_RESUME_KNOWN = 1 << 0,
	LW_LOOK_RESUME_DOUBTFUL = 1 << 1,
};

/** @return bytes of the record */
size_t lw_look_record_encode(const struct lw_look *look, uint32_t sequence,
			     uint8_t bytes[LW_LOOK_RECORD_SIZE]);

/**
 * Open a record. Causes that this firmware does not know are left out.
 *
 * @param look receives the content; unchanged on any error
 * @param record receives the head, as by lw_record_open()
 * @retval 0 done
 * @retval -ENODATA nothing there
 * @retval -EBADMSG damaged, or no record of this kind
 * @retval -ENOTSUP another schema
 * @retval -EINVAL intact, but not of this form
 */
int lw_look_record_decode(const uint8_t *bytes, size_t size, struct lw_look *look,
			  struct lw_record *record);

#endif /* LW_LOOK_RECORD_H */
