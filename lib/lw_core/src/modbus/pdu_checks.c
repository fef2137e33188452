/* SPDX-License-Identifier: Apache-2.0 */
#include "pdu_checks.h"

#include <errno.h>
#include <string.h>

int lw_pdu_refuse(struct lw_pdu_exchange *exchange, int error, enum lw_reason reason, size_t value,
		  size_t limit)
{
	return lw_refuse(&exchange->why, error, reason, LW_NO_ADDRESS, (int64_t)value,
			 (int64_t)limit);
}

int lw_pdu_check_length(struct lw_pdu_exchange *exchange, size_t length)
{
	if (exchange->length != length) {
		return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_BAD_LENGTH, exchange->length,
				     length);
	}
	return 0;
}

int lw_pdu_check_head(struct lw_pdu_exchange *exchange, size_t head_size)
{
	if (exchange->length < head_size) {
		return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_BAD_LENGTH, exchange->length,
				     head_size);
	}
	return 0;
}

int lw_pdu_check_count(struct lw_pdu_exchange *exchange, uint16_t count, uint16_t max)
{
	if (count == 0 || count > max) {
		return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_BAD_COUNT, count,
				     count == 0 ? 1 : max);
	}
	return 0;
}

int lw_pdu_check_bytes(struct lw_pdu_exchange *exchange, size_t head_size, size_t byte_count)
{
	const uint8_t declared = exchange->request[head_size - 1];

	if (declared != byte_count) {
		return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_BAD_LENGTH, declared, byte_count);
	}
	return lw_pdu_check_length(exchange, head_size + byte_count);
}

int lw_pdu_echo(struct lw_pdu_exchange *exchange, size_t length)
{
	memcpy(exchange->response, exchange->request, length);
	return (int)length;
}
