/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What the groups of Modbus functions share: the request at hand, and its checks.
 */
#ifndef LW_PDU_CHECKS_H
#define LW_PDU_CHECKS_H

#include <stddef.h>
#include <stdint.h>

#include "lw/map.h"
#include "lw/map/refusal.h"
#include "lw/modbus/pdu.h"

/** One request while it is handled. */
struct lw_pdu_exchange {
	struct lw_pdu *pdu;
	const uint8_t *request;
	size_t length; /**< bytes of the request, 1 to LW_PDU_MAX */
	uint8_t *response;
	struct lw_refusal why;
};

/** Fill in why the request is refused. @return `error` */
int lw_pdu_refuse(struct lw_pdu_exchange *exchange, int error, enum lw_reason reason, size_t value,
		  size_t limit);

/** Is the request exactly so long? @retval -EINVAL no */
int lw_pdu_check_length(struct lw_pdu_exchange *exchange, size_t length);

/** Is the request long enough for its fixed part? @retval -EINVAL no */
int lw_pdu_check_head(struct lw_pdu_exchange *exchange, size_t head_size);

/** Is a count from 1 to `max`? @retval -EINVAL no */
int lw_pdu_check_count(struct lw_pdu_exchange *exchange, uint16_t count, uint16_t max);

/**
 * The head of a request with data ends with the number of its bytes: is it this one, and is the
 * request so long? @retval -EINVAL no
 */
int lw_pdu_check_bytes(struct lw_pdu_exchange *exchange, size_t head_size, size_t byte_count);

/** The first `length` bytes of the request are the response. @return `length` */
int lw_pdu_echo(struct lw_pdu_exchange *exchange, size_t length);

#endif /* LW_PDU_CHECKS_H */
