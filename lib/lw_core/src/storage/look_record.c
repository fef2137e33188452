/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/storage/look_record.h"

#include <errno.h>
#include <string.h>

#include "lw/bytes/big_endian.h"

#define KIND        "LWRL"
#define HEAD_SIZE   12
#define MARK_SIZE   8
#define ROPE_AT     (HEAD_SIZE + MARK_SIZE * LW_LOOK_MARKS)
#define ROPE_SIZE   16
#define RESUME_AT   (ROPE_AT + ROPE_SIZE)
#define RESUME_SIZE 32

size_t lw_look_record_encode(const struct lw_look *look, uint32_t sequence,
			     uint8_t bytes[LW_LOOK_RECORD_SIZE])
{
	uint8_t *at = bytes + LW_RECORD_HEAD_SIZE;

	at = lw_put32(at, look->causes);
	at = lw_put32(at, look->standing_millirev);
	at = lw_put32(at, look->standing_place_known);
	for (size_t i = 0; i < LW_LOOK_CAUSES; i++) {
		at = lw_put32(at, (uint32_t)look->marks[i].position_um);
		at = lw_put32(at, look->marks[i].time_ms);
	}
	memset(at, 0, MARK_SIZE * (LW_LOOK_MARKS - LW_LOOK_CAUSES));
	at += MARK_SIZE * (LW_LOOK_MARKS - LW_LOOK_CAUSES);
	at = lw_put32(at, look->rope_told);
	at = lw_put32(at, (uint32_t)look->rope_told_mm);
	at = lw_put32(at, look->rope_turns_high);
	at = lw_put32(at, look->rope_turns_low);
	at = lw_put32(at, look->resume_flags);
	at = lw_put32(at, look->resume_pattern);
	at = lw_put32(at, (uint32_t)look->resume_m);
	at = lw_put32(at, (uint32_t)look->resume_u);
	at = lw_put32(at, look->resume_dwell_edges);
	at = lw_put32(at, look->resume_cycle_plus);
	at = lw_put32(at, look->resume_cycle_minus);
	at = lw_put32(at, (uint32_t)look->resume_stand_usteps);
	return lw_record_seal(bytes, KIND, LW_LOOK_RECORD_SCHEMA, sequence,
			      (size_t)(at - bytes) - LW_RECORD_HEAD_SIZE);
}

int lw_look_record_decode(const uint8_t *bytes, size_t size, struct lw_look *look,
			  struct lw_record *record)
{
	const int ret = lw_record_open(bytes, size, KIND, record);
	struct lw_look result = {0};

	if (ret) {
		return ret;
	}
	if (record->schema != LW_LOOK_RECORD_SCHEMA) {
		return -ENOTSUP;
	}
	if (record->length < HEAD_SIZE || (record->length - HEAD_SIZE) % MARK_SIZE != 0) {
		return -EINVAL;
	}
	result.causes = lw_get32(record->payload) & ((1u << LW_LOOK_CAUSES) - 1);
	result.standing_millirev = lw_get32(record->payload + 4);
	result.standing_place_known = lw_get32(record->payload + 8);
	for (size_t i = 0; i < LW_LOOK_CAUSES && i < (record->length - HEAD_SIZE) / MARK_SIZE;
	     i++) {
		const uint8_t *mark = record->payload + HEAD_SIZE + MARK_SIZE * i;

		result.marks[i].position_um = (int32_t)lw_get32(mark);
		result.marks[i].time_ms = lw_get32(mark + 4);
	}
	if (record->length >= ROPE_AT + ROPE_SIZE) {
		const uint8_t *rope = record->payload + ROPE_AT;

		result.rope_told = lw_get32(rope);
		result.rope_told_mm = (int32_t)lw_get32(rope + 4);
		result.rope_turns_high = lw_get32(rope + 8);
		result.rope_turns_low = lw_get32(rope + 12);
	}
	if (record->length >= RESUME_AT + RESUME_SIZE) {
		const uint8_t *resume = record->payload + RESUME_AT;

		result.resume_flags = lw_get32(resume);
		result.resume_pattern = lw_get32(resume + 4);
		result.resume_m = (int32_t)lw_get32(resume + 8);
		result.resume_u = (int32_t)lw_get32(resume + 12);
		result.resume_dwell_edges = lw_get32(resume + 16);
		result.resume_cycle_plus = lw_get32(resume + 20);
		result.resume_cycle_minus = lw_get32(resume + 24);
		result.resume_stand_usteps = (int32_t)lw_get32(resume + 28);
	}
	*look = result;
	return 0;
}
