/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A slave with its whole machine behind it, and a judge who knows what each frame may do to them:
 * an invalid one nothing, a refused one nothing but what is told about it, and after every one a
 * valid request is answered. A verdict is abort(), which every fuzzer and test runner notices.
 */
#ifndef LW_JUDGE_H
#define LW_JUDGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "world.h"

/** What became of a frame. */
enum judge_outcome {
	JUDGE_DROPPED,   /**< no intact frame, or another unit's */
	JUDGE_BROADCAST, /**< executed or not, never answered */
	JUDGE_UNHEARD,   /**< listen only mode */
	JUDGE_ANSWERED,
	JUDGE_REFUSED, /**< by an exception */
	JUDGE_OUTCOME_COUNT,
};

/** State. */
struct judge {
	struct lw_world world;
	uint64_t line_us;                 /**< time of the line, which is not that of the world */
	uint8_t answer[LW_RTU_FRAME_MAX]; /**< the last one */
	size_t answer_length;

	/* What must not have changed. */
	struct lw_device device;
	struct lw_store store;
	struct lw_plant plant;
	bool power_cut;
	size_t profile_count;
};

/** The CRC of Modbus RTU, bit by bit: not the code under test. */
uint16_t judge_crc(const uint8_t *bytes, size_t count);

/** Append the CRC; there must be room. @return length + 2 */
size_t judge_seal(uint8_t *frame, size_t length);

/** A machine that has just been switched on. */
void judge_init(struct judge *judge, uint64_t seed);

/** Let the machine run. */
void judge_run_ms(struct judge *judge, uint32_t duration_ms);

/**
 * Send bytes between two silences, and judge what they do.
 *
 * @param first bytes of them that come in a first lot
 */
enum judge_outcome judge_frame(struct judge *judge, const uint8_t *bytes, size_t count,
			       size_t first);

/** A valid request must be answered, exactly. Ends listen only mode first. */
void judge_alive(struct judge *judge);

/** Every value of a parameter set must be one that its register allows. */
void judge_limits(const struct lw_params *params);

/** Say what is wrong, and abort(), unless it is right. */
void judge_require(bool right, const char *what, const uint8_t *bytes, size_t count);

#endif /* LW_JUDGE_H */
