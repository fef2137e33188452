/* SPDX-License-Identifier: Apache-2.0 */
#include "judge.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BROADCAST     0u
#define FRAME_MIN     4u
#define EXCEPTION_BIT 0x80u
#define NS_PER_MS     1000000u

/** Take a field's present value for the one that it must have. */
#define PERMIT(field) memcpy(&judge->device.field, &now->field, sizeof(now->field))

void judge_require(bool right, const char *what, const uint8_t *bytes, size_t count)
{
	if (right) {
		return;
	}
	fprintf(stderr, "judge: %s:", what);
	for (size_t i = 0; i < count; i++) {
		fprintf(stderr, " %02x", bytes[i]);
	}
	fputc('\n', stderr);
	abort();
}

uint16_t judge_crc(const uint8_t *bytes, size_t count)
{
	uint16_t crc = 0xFFFF;

	for (size_t i = 0; i < count; i++) {
		crc ^= bytes[i];
		for (int bit = 0; bit < 8; bit++) {
			crc = (uint16_t)(crc & 1 ? crc >> 1 ^ 0xA001 : crc >> 1);
		}
	}
	return crc;
}

size_t judge_seal(uint8_t *frame, size_t length)
{
	const uint16_t crc = judge_crc(frame, length);

	frame[length] = (uint8_t)crc;
	frame[length + 1] = (uint8_t)(crc >> 8);
	return length + 2;
}

void judge_init(struct judge *judge, uint64_t seed)
{
	const struct lw_world_config config = {.seed = seed};

	judge->line_us = 0;
	judge->answer_length = 0;
	if (lw_world_init(&judge->world, &config, judge->line_us)) {
		abort();
	}
}

void judge_run_ms(struct judge *judge, uint32_t duration_ms)
{
	lw_world_run(&judge->world, judge->world.now_ns + (uint64_t)duration_ms * NS_PER_MS);
}

static void remember(struct judge *judge)
{
	judge->device = judge->world.device;
	judge->store = judge->world.store;
	judge->plant = judge->world.plant;
	judge->power_cut = judge->world.bench.power_cut;
	judge->profile_count = judge->world.bench.profile_count;
}

/* The receiver and the counters change with every byte on the line. */
static void permit_counting(struct judge *judge)
{
	const struct lw_device *now = &judge->world.device;

	PERMIT(slave.rtu);
	PERMIT(slave.pdu.counters);
	PERMIT(slave.echoes);
	PERMIT(slave.foreign_answers);
	PERMIT(slave.babbles);
	PERMIT(slave.babbling);
	PERMIT(slave.repeats_left);
	PERMIT(slave.sent_length);
	PERMIT(slave.sent_us);
	PERMIT(slave.sent);
}

/* What a request to this unit may change without being a write that is done. */
static void permit_request(struct judge *judge)
{
	const struct lw_device *now = &judge->world.device;

	PERMIT(slave.last_request_us);
	PERMIT(slave.own_requests);
	PERMIT(slave.pdu.last_error);
	PERMIT(setpoints_image);
	PERMIT(status_image);
	PERMIT(coils_image);
}

/* What a refusal may leave behind besides: a command that was refused is told of, and so is a wrong
 * code of the write lock.
 */
static void permit_refusal(struct judge *judge)
{
	const struct lw_device *now = &judge->world.device;

	PERMIT(command);
	PERMIT(asked);
	PERMIT(lock);
}

static void require_unchanged(const struct judge *judge, const uint8_t *bytes, size_t count)
{
	const struct lw_world *world = &judge->world;

	judge_require(memcmp(&judge->device, &world->device, sizeof(world->device)) == 0,
		      "the controller has changed", bytes, count);
	judge_require(memcmp(&judge->store, &world->store, sizeof(world->store)) == 0,
		      "the storage has changed", bytes, count);
	judge_require(memcmp(&judge->plant, &world->plant, sizeof(world->plant)) == 0 &&
			      judge->power_cut == world->bench.power_cut &&
			      judge->profile_count == world->bench.profile_count,
		      "the machine has changed", bytes, count);
}

/* What no master sends (application protocol V1.1b3, section 6: the responses). */
static bool is_response(const uint8_t *pdu, size_t length)
{
	const bool counted = length > 2 && length == 2u + pdu[1];

	switch (pdu[0]) {
	case 1:
	case 2:
		return counted && length != 5;
	case 3:
	case 4:
		return counted && length != 5 && length % 2 == 0;
	case 15:
	case 16:
		return length == 5;
	case 17:
		return counted;
	case 20:
		return counted && length > 4 && (pdu[2] & 1) && pdu[3] == 6;
	case 23:
		return counted && length % 2 == 0 && !(length > 10 && length == 10u + pdu[9]);
	case 43:
		return length >= 7 && pdu[1] == 14 && pdu[3] >= 0x80;
	default:
		return pdu[0] >= 0x80;
	}
}

static bool only_reads(uint8_t function)
{
	static const uint8_t readers[] = {1, 2, 3, 4, 7, 11, 12, 17, 20, 24, 43};

	return memchr(readers, function, sizeof(readers)) != NULL;
}

static void require_form(const uint8_t *bytes, size_t count, const uint8_t *tx, size_t length)
{
	judge_require(length >= FRAME_MIN && length <= LW_RTU_FRAME_MAX, "length of the answer", tx,
		      length);
	judge_require(judge_crc(tx, length) == 0, "CRC of the answer", tx, length);
	judge_require(tx[0] == bytes[0], "unit id of the answer", tx, length);
	judge_require(tx[1] == bytes[1] || tx[1] == (bytes[1] | EXCEPTION_BIT),
		      "function code of the answer", bytes, count);
	if (tx[1] & EXCEPTION_BIT) {
		judge_require(length == 5 && ((tx[2] >= 1 && tx[2] <= 4) || tx[2] == 6),
			      "form of an exception", tx, length);
	}
}

/* Send bytes and wait for silence. @return bytes of the answer */
static size_t exchange(struct judge *judge, const uint8_t *bytes, size_t count, size_t first,
		       uint8_t tx[LW_RTU_FRAME_MAX])
{
	struct lw_slave *slave = &judge->world.device.slave;
	uint64_t deadline_us;
	size_t length;

	lw_slave_receive(slave, bytes, first, judge->line_us);
	lw_slave_receive(slave, bytes + first, count - first, judge->line_us);
	deadline_us = lw_slave_deadline_us(slave);
	if (deadline_us == UINT64_MAX) {
		return 0;
	}
	judge->line_us = deadline_us;
	length = lw_slave_poll(slave, deadline_us, tx);
	if (length > 0) {
		memcpy(judge->answer, tx, length);
		judge->answer_length = length;
	}
	return length;
}

/* Bytes in which the last answer stands may be its echo, and what follows it another frame. */
static bool may_be_an_echo(const struct judge *judge, const uint8_t *bytes, size_t count)
{
	for (size_t at = 0; at + judge->answer_length <= count; at++) {
		if (judge->answer_length > 0 &&
		    memcmp(bytes + at, judge->answer, judge->answer_length) == 0) {
			return true;
		}
	}
	return false;
}

/* The line gives back what was sent: it is not answered, and nothing happens. */
static void echo(struct judge *judge, const uint8_t *tx, size_t length)
{
	uint8_t second[LW_RTU_FRAME_MAX];

	remember(judge);
	judge_require(exchange(judge, tx, length, length / 2, second) == 0, "an echo is answered",
		      tx, length);
	permit_counting(judge);
	require_unchanged(judge, tx, length);
}

enum judge_outcome judge_frame(struct judge *judge, const uint8_t *bytes, size_t count,
			       size_t first)
{
	const struct lw_pdu *pdu = &judge->world.device.slave.pdu;
	const uint8_t unit_id = judge->world.device.slave.config->unit_id;
	const bool intact =
		count >= FRAME_MIN && count <= LW_RTU_FRAME_MAX && judge_crc(bytes, count) == 0;
	const bool was_listening_only = pdu->listen_only;
	const bool echoes = may_be_an_echo(judge, bytes, count);
	enum judge_outcome outcome;
	uint8_t tx[LW_RTU_FRAME_MAX];
	size_t length;

	remember(judge);
	length = exchange(judge, bytes, count, first, tx);
	permit_counting(judge);

	if (echoes && length == 0) {
		return JUDGE_DROPPED;
	}
	if (!intact || (bytes[0] != unit_id && bytes[0] != BROADCAST) ||
	    is_response(&bytes[1], count - 3)) {
		judge_require(length == 0, "an invalid frame or an answer is answered", bytes,
			      count);
		require_unchanged(judge, bytes, count);
		return JUDGE_DROPPED;
	}
	permit_request(judge);
	if (was_listening_only) {
		judge_require(length == 0, "answered in listen only mode", bytes, count);
		judge->device.slave.pdu.listen_only = pdu->listen_only;
		outcome = JUDGE_UNHEARD;
	} else if (bytes[0] == BROADCAST) {
		judge_require(length == 0, "a broadcast is answered", bytes, count);
		if (!lw_pdu_may_broadcast(bytes[1])) {
			require_unchanged(judge, bytes, count);
		}
		return JUDGE_BROADCAST;
	} else if (length == 0) {
		judge_require(pdu->listen_only && bytes[1] == 8, "no answer", bytes, count);
		judge->device.slave.pdu.listen_only = true;
		outcome = JUDGE_UNHEARD;
	} else {
		require_form(bytes, count, tx, length);
		outcome = tx[1] & EXCEPTION_BIT ? JUDGE_REFUSED : JUDGE_ANSWERED;
		if (outcome == JUDGE_REFUSED) {
			permit_refusal(judge);
		}
		if (outcome == JUDGE_REFUSED || only_reads(bytes[1]) || bytes[1] == 8) {
			require_unchanged(judge, bytes, count);
		}
		/* Some lines echo, some do not. */
		if (tx[length - 1] & 1) {
			echo(judge, tx, length);
		}
		return outcome;
	}
	require_unchanged(judge, bytes, count);
	return outcome;
}

void judge_alive(struct judge *judge)
{
	static const uint8_t self_test[] = {4, 4, 0x12, 0x34, 0x56, 0x78};
	const struct lw_slave *slave = &judge->world.device.slave;
	const uint8_t unit_id = slave->config->unit_id;
	uint8_t restart[8] = {unit_id, 8, 0, 1, 0, 0};
	uint8_t request[8] = {unit_id, 4, 0, 0, 0, 2};
	uint8_t tx[LW_RTU_FRAME_MAX];
	size_t length;

	if (slave->pdu.listen_only) {
		length = exchange(judge, restart, judge_seal(restart, 6), 0, tx);
		judge_require(length == 0 && !slave->pdu.listen_only, "no end of listen only mode",
			      restart, sizeof(restart));
	}
	length = exchange(judge, request, judge_seal(request, 6), 0, tx);
	judge_require(length == 9 && tx[0] == unit_id &&
			      memcmp(&tx[1], self_test, sizeof(self_test)) == 0 &&
			      judge_crc(tx, length) == 0,
		      "a valid request is not answered", tx, length);
}

void judge_limits(const struct lw_params *params)
{
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		const struct lw_point *point = &lw_map_params[i];
		int32_t value;
		int32_t limit;

		memcpy(&value, (const char *)params + point->offset, sizeof(value));
		judge_require(lw_point_allows(point,
					      point->type == LW_TYPE_U32 ? (int64_t)(uint32_t)value
									 : value,
					      &limit),
			      "a parameter beyond its limits", (const uint8_t *)&value,
			      sizeof(value));
	}
}
