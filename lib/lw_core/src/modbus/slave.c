/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/modbus/slave.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

#define BROADCAST 0u

/** Bytes that an echo may be behind, from a transceiver that hears itself. */
#define ECHO_BYTES 2u

/** What an adapter may keep an echo back: USB's hand bytes on every 16 ms. */
#define ECHO_LATE_US 20000u

/** Then a line that did not echo may have begun to. */
#define REPEATS_MAX 100u

void lw_slave_init(struct lw_slave *slave, const struct lw_slave_config *config, uint64_t now_us)
{
	*slave = (struct lw_slave){
		.config = config,
		.last_request_us = now_us,
	};
	lw_rtu_init(&slave->rtu, &config->rtu);
	lw_pdu_init(&slave->pdu, &config->pdu);
}

void lw_slave_reconfigure(struct lw_slave *slave)
{
	lw_rtu_reconfigure(&slave->rtu, &slave->config->rtu);
	slave->repeats_left = 0;
	slave->sent_length = 0;
}

uint64_t lw_slave_deadline_us(const struct lw_slave *slave)
{
	return lw_rtu_deadline_us(&slave->rtu);
}

void lw_slave_lose(struct lw_slave *slave)
{
	slave->late_requests++;
	lw_rtu_drop(&slave->rtu);
}

/* No master begins so early: it waits for the end of the answer, and for a silence. */
static uint64_t echo_sure_until_us(const struct lw_slave *slave)
{
	return slave->sent_us + (slave->sent_length + ECHO_BYTES) * slave->config->byte_us;
}

static uint64_t echo_until_us(const struct lw_slave *slave)
{
	return echo_sure_until_us(slave) + slave->config->rtu.silence_us +
	       (slave->config->byte_us > 0 ? ECHO_LATE_US : 0);
}

/* Something that is no echo came first, or nothing at all. */
static void forget_sent(struct lw_slave *slave)
{
	if (slave->sent_length > 0) {
		slave->repeats_left = REPEATS_MAX;
		slave->sent_length = 0;
	}
}

/* Drop what has been received if it is the echo of the last answer. */
static void drop_echo(struct lw_slave *slave)
{
	const struct lw_rtu *rtu = &slave->rtu;

	if (slave->sent_length == 0 || rtu->length != slave->sent_length ||
	    memcmp(rtu->frame, slave->sent, slave->sent_length) != 0) {
		return;
	}
	if (slave->repeats_left > 0 && rtu->first_byte_us >= echo_sure_until_us(slave) &&
	    !lw_pdu_is_response(&slave->sent[1], slave->sent_length - 3)) {
		slave->repeats_left--;
	} else {
		lw_rtu_drop(&slave->rtu);
		slave->repeats_left = 0;
		slave->echoes++;
	}
	slave->sent_length = 0;
}

/* An intact frame, without its CRC. */
static size_t handle_frame(struct lw_slave *slave, uint64_t now_us, const uint8_t *frame,
			   size_t length, bool late, uint8_t *tx)
{
	struct lw_pdu *pdu = &slave->pdu;
	uint8_t unit_id = frame[0];
	const uint8_t *request = &frame[1];
	bool was_listening_only = pdu->listen_only;
	size_t response_length;

	pdu->counters[LW_BUS_MESSAGES]++;
	if (unit_id != BROADCAST && unit_id != slave->config->unit_id) {
		return 0;
	}
	if (lw_pdu_is_response(request, length - 1)) {
		slave->foreign_answers++;
		return 0;
	}
	slave->late_requests += late;
	if (late || (unit_id == BROADCAST && !lw_pdu_may_broadcast(request[0]))) {
		pdu->counters[LW_BUS_NO_RESPONSES]++;
		return 0;
	}
	slave->own_requests += unit_id != BROADCAST;
	response_length = lw_pdu_handle(pdu, request, length - 1, &tx[1]);
	if (!was_listening_only || !pdu->listen_only) {
		slave->last_request_us = now_us;
	}
	if (response_length == 0) {
		return 0; /* lw_pdu_handle() has counted it */
	}
	if (unit_id == BROADCAST) {
		pdu->counters[LW_BUS_NO_RESPONSES]++;
		return 0;
	}
	tx[0] = unit_id;
	return lw_rtu_seal(tx, 1 + response_length);
}

/* Handle a frame that is complete. @return bytes of the answer */
static size_t take_frame(struct lw_slave *slave, uint64_t now_us, uint8_t *tx)
{
	const uint64_t complete_us = lw_rtu_deadline_us(&slave->rtu);
	const uint8_t *frame;
	int length = lw_rtu_poll(&slave->rtu, now_us, &frame);

	slave->babbling &= length == 0;
	if (length > 0) {
		forget_sent(slave);
		return handle_frame(slave, now_us, frame, (size_t)length,
				    now_us - complete_us > LW_SLAVE_WAIT_MAX_US, tx);
	}
	if (length < 0) {
		slave->pdu.counters[LW_BUS_CRC_ERRORS]++;
	}
	if (length == -EMSGSIZE) {
		slave->pdu.counters[LW_BUS_OVERRUNS]++;
	}
	return 0;
}

size_t lw_slave_poll(struct lw_slave *slave, uint64_t now_us, uint8_t tx[LW_RTU_FRAME_MAX])
{
	const size_t length = take_frame(slave, now_us, tx);

	if (length > 0) {
		memcpy(slave->sent, tx, length);
		slave->sent_length = length;
		slave->sent_us = now_us;
	}
	return length;
}

static void watch_babble(struct lw_slave *slave, uint64_t now_us)
{
	const struct lw_rtu *rtu = &slave->rtu;

	if (!slave->babbling && rtu->length > LW_RTU_FRAME_MAX &&
	    now_us - rtu->first_byte_us >= LW_SLAVE_BABBLE_US) {
		slave->babbling = true;
		slave->babbles++;
	}
}

/* Bytes to take at once: an echo may end in the midst of a lot, and what follows is a new frame. */
static size_t lot(const struct lw_slave *slave, size_t count)
{
	const size_t received = slave->rtu.length;

	return received < slave->sent_length && count > slave->sent_length - received
		       ? slave->sent_length - received
		       : count;
}

void lw_slave_receive(struct lw_slave *slave, const uint8_t *bytes, size_t count, uint64_t now_us)
{
	uint8_t unsent[LW_RTU_FRAME_MAX];

	while (count > 0) {
		const size_t taken = lot(slave, count);

		if (slave->rtu.length == 0 && now_us >= echo_until_us(slave)) {
			forget_sent(slave);
		}
		if (lw_rtu_receive(&slave->rtu, bytes, taken, now_us) == 0) {
			drop_echo(slave);
			watch_babble(slave, now_us);
			bytes += taken;
			count -= taken;
		} else if (take_frame(slave, now_us, unsent) > 0) {
			slave->pdu.counters[LW_BUS_NO_RESPONSES]++;
		}
	}
}
