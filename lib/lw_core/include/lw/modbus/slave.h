/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A Modbus RTU slave: framing (lw/modbus/rtu.h), unit id and broadcast, requests (lw/modbus/pdu.h).
 * The host moves the bytes. Not for interrupt context.
 *
 * The host calls lw_slave_receive() when bytes arrive, and lw_slave_poll() when
 * lw_slave_deadline_us() has come.
 *
 * What it sends may come back: from a transceiver that hears itself, or an adapter that echoes.
 * The answers of some functions equal their requests, so they would be done again and again. An
 * echo is known by its bytes: the whole of the last answer, once, while it is being sent or soon
 * after. Soon after it, not while, the same bytes may also be a master that repeats itself; they
 * are taken for that on a line that was seen not to echo, and not for ever.
 */
#ifndef LW_SLAVE_H
#define LW_SLAVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lw/modbus/pdu.h"
#include "lw/modbus/rtu.h"

/** Longest time that a complete frame may wait for lw_slave_poll(); later it is dropped. */
#define LW_SLAVE_WAIT_MAX_US 500000u

/**
 * Bytes without a silence for so long, and more than a frame has, are babble: a broken transceiver,
 * a line without its resistors.
 */
#define LW_SLAVE_BABBLE_US 1000000u

/** One slave on one line. */
struct lw_slave_config {
	uint8_t unit_id; /**< 1 to 247 */
	struct lw_rtu_config rtu;
	uint32_t byte_us; /**< time of a byte on the line; 0 where it takes none */
	struct lw_pdu_config pdu;
};

/** State of the slave. The owner may read `pdu` and `last_request_us` between two calls. */
struct lw_slave {
	const struct lw_slave_config *config;
	struct lw_rtu rtu;
	struct lw_pdu pdu;
	/**
	 * Time of the last request that was executed or refused; at first the time of
	 * lw_slave_init(). For watching the master. What listen-only mode ignores does not count.
	 */
	uint64_t last_request_us;
	/** Intact frames to this unit so far; broadcasts do not count. Nothing sets it back. */
	uint32_t own_requests;
	uint32_t echoes;          /**< of own answers, dropped */
	uint32_t foreign_answers; /**< to or as this unit, dropped: another device has its id */
	uint32_t babbles;         /**< times that the line was not silent for LW_SLAVE_BABBLE_US */
	uint32_t late_requests;   /**< that have waited too long, dropped */

	bool babbling; /**< bytes come without a silence: nobody can be heard */

	/* The answer whose echo may come. Private to slave.c. */
	uint8_t repeats_left; /**< so many times in a row it may be the master that repeats itself
			       */
	size_t sent_length;   /**< 0: none */
	uint64_t sent_us;
	uint8_t sent[LW_RTU_FRAME_MAX];
};

/** Start with empty buffers and counters. `config` must outlive the slave. */
void lw_slave_init(struct lw_slave *slave, const struct lw_slave_config *config, uint64_t now_us);

/**
 * Take over what has changed in the configuration, unit id and times, or at the line itself:
 * whether it echoes is unknown again. May be called while a request is executed, which is still
 * answered by the old unit id.
 */
void lw_slave_reconfigure(struct lw_slave *slave);

/**
 * Take bytes from the line. If they begin a new frame and the one before was never polled, that one
 * is executed first, unanswered: its answer would be taken for the answer to the new request.
 *
 * @param now_us time of their arrival; never goes back
 */
void lw_slave_receive(struct lw_slave *slave, const uint8_t *bytes, size_t count, uint64_t now_us);

/**
 * Execute a request that is complete. The answer counts as sent from now on.
 *
 * @param tx receives the frame to send
 * @return bytes to send, 0 if none
 */
size_t lw_slave_poll(struct lw_slave *slave, uint64_t now_us, uint8_t tx[LW_RTU_FRAME_MAX]);

/** Drop what has been received and not executed: nobody knows how long ago it came. */
void lw_slave_lose(struct lw_slave *slave);

/** When lw_slave_poll() wants to be called; UINT64_MAX while no bytes are pending. */
uint64_t lw_slave_deadline_us(const struct lw_slave *slave);

#endif /* LW_SLAVE_H */
