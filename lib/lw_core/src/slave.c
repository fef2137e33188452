#include "lw/slave.h"

#include <errno.h>
#include <stdbool.h>

#define BROADCAST 0u

void lw_slave_init(struct lw_slave *slave, const struct lw_slave_config *config, uint64_t now_us)
{
	slave->config = config;
	slave->last_request_us = now_us;
	slave->own_requests = 0;
	lw_rtu_init(&slave->rtu, &config->rtu);
	lw_pdu_init(&slave->pdu, &config->pdu);
}

void lw_slave_reconfigure(struct lw_slave *slave)
{
	lw_rtu_reconfigure(&slave->rtu, &slave->config->rtu);
}

uint64_t lw_slave_deadline_us(const struct lw_slave *slave)
{
	return lw_rtu_deadline_us(&slave->rtu);
}

/* An intact frame, without its CRC. */
static size_t handle_frame(struct lw_slave *slave, uint64_t now_us, const uint8_t *frame,
			   size_t length, uint8_t *tx)
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
	if (unit_id == BROADCAST && !lw_pdu_may_broadcast(request[0])) {
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

size_t lw_slave_poll(struct lw_slave *slave, uint64_t now_us, uint8_t tx[LW_RTU_FRAME_MAX])
{
	const uint8_t *frame;
	int length = lw_rtu_poll(&slave->rtu, now_us, &frame);

	if (length > 0) {
		return handle_frame(slave, now_us, frame, (size_t)length, tx);
	}
	if (length < 0) {
		slave->pdu.counters[LW_BUS_CRC_ERRORS]++;
	}
	if (length == -EMSGSIZE) {
		slave->pdu.counters[LW_BUS_OVERRUNS]++;
	}
	return 0;
}

void lw_slave_receive(struct lw_slave *slave, const uint8_t *bytes, size_t count, uint64_t now_us)
{
	uint8_t unsent[LW_RTU_FRAME_MAX];

	if (lw_rtu_receive(&slave->rtu, bytes, count, now_us) == 0) {
		return;
	}
	if (lw_slave_poll(slave, now_us, unsent) > 0) {
		slave->pdu.counters[LW_BUS_NO_RESPONSES]++;
	}
	(void)lw_rtu_receive(&slave->rtu, bytes, count, now_us);
}
