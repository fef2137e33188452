/**
 * @file
 * A Modbus RTU slave: framing (lw/rtu.h), unit id and broadcast, requests (lw/pdu.h). The host
 * moves the bytes. Not for interrupt context.
 *
 * The host calls lw_slave_receive() when bytes arrive, and lw_slave_poll() when
 * lw_slave_deadline_us() has come.
 */
#ifndef LW_SLAVE_H
#define LW_SLAVE_H

#include <stddef.h>
#include <stdint.h>

#include "lw/pdu.h"
#include "lw/rtu.h"

/** One slave on one line. */
struct lw_slave_config {
	uint8_t unit_id; /**< 1 to 247 */
	struct lw_rtu_config rtu;
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
};

/** Start with empty buffers and counters. `config` must outlive the slave. */
void lw_slave_init(struct lw_slave *slave, const struct lw_slave_config *config, uint64_t now_us);

/**
 * Take over what has changed in the configuration: unit id and times. May be called while a request
 * is executed, which is still answered by the old unit id.
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
 * Execute a request that is complete.
 *
 * @param tx receives the frame to send
 * @return bytes to send, 0 if none
 */
size_t lw_slave_poll(struct lw_slave *slave, uint64_t now_us, uint8_t tx[LW_RTU_FRAME_MAX]);

/** When lw_slave_poll() wants to be called; UINT64_MAX while no bytes are pending. */
uint64_t lw_slave_deadline_us(const struct lw_slave *slave);

#endif /* LW_SLAVE_H */
