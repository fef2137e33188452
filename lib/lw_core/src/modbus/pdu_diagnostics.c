/* SPDX-License-Identifier: Apache-2.0 */
/*
 * FC08, diagnostics of the serial line.
 *
 * Not there: 3 (the delimiter of ASCII framing) and 19 (reserved); they get exception 01.
 */
#include "pdu_handlers.h"

#include <errno.h>
#include <string.h>

#include "lw/bytes/big_endian.h"

enum {
	RETURN_QUERY_DATA = 0,
	RESTART_COMMUNICATIONS = 1,
	RETURN_DIAGNOSTIC_REGISTER = 2,
	FORCE_LISTEN_ONLY = 4,
	CLEAR_COUNTERS = 10,
	FIRST_COUNTER = 11,
	LAST_COUNTER = FIRST_COUNTER + LW_BUS_COUNTER_COUNT - 1,
	CLEAR_OVERRUN_COUNTER = 20,
};

/** Data of a restart that clears the event log, too; this slave's log is a file, and stays. */
#define RESTART_CLEAR_LOG 0xFF00u

static void clear_counters(struct lw_pdu *pdu)
{
	memset(pdu->counters, 0, sizeof(pdu->counters));
}

static void restart(struct lw_pdu *pdu)
{
	clear_counters(pdu);
	pdu->listen_only = false;
}

static bool is_defined(uint16_t function)
{
	switch (function) {
	case RETURN_QUERY_DATA:
	case RESTART_COMMUNICATIONS:
	case RETURN_DIAGNOSTIC_REGISTER:
	case FORCE_LISTEN_ONLY:
	case CLEAR_COUNTERS:
	case CLEAR_OVERRUN_COUNTER:
		return true;
	default:
		return function >= FIRST_COUNTER && function <= LAST_COUNTER;
	}
}

static bool is_data_good(uint16_t function, uint16_t data)
{
	return data == 0 || (function == RESTART_COMMUNICATIONS && data == RESTART_CLEAR_LOG);
}

void lw_pdu_restart_if_asked(struct lw_pdu *pdu, const uint8_t *request, size_t length)
{
	if (length == 5 && request[0] == 8 && lw_get16(&request[1]) == RESTART_COMMUNICATIONS &&
	    is_data_good(RESTART_COMMUNICATIONS, lw_get16(&request[3]))) {
		restart(pdu);
	}
}

/* The diagnostic register: bit n is set while the counter of sub-function 11 + n is not 0. */
static uint16_t diagnostic_register(const struct lw_pdu *pdu)
{
	uint16_t bits = 0;

	for (unsigned int i = 0; i < LW_BUS_COUNTER_COUNT; i++) {
		bits |= (uint16_t)((pdu->counters[i] != 0) << i);
	}
	return bits;
}

int lw_pdu_diagnostics(struct lw_pdu_exchange *exchange)
{
	struct lw_pdu *pdu = exchange->pdu;
	const uint8_t *request = exchange->request;
	uint16_t function;
	uint16_t data;
	int error = lw_pdu_check_head(exchange, 5);

	if (error != 0) {
		return error;
	}
	function = lw_get16(&request[1]);
	data = lw_get16(&request[3]);
	if (!is_defined(function)) {
		return lw_pdu_refuse(exchange, -ENOTSUP, LW_REASON_UNDEFINED_SUB_FUNCTION, function,
				     CLEAR_OVERRUN_COUNTER);
	}
	if (function == RETURN_QUERY_DATA) {
		/* Any whole number of 16-bit fields: with the function code, an odd length. */
		error = lw_pdu_check_length(exchange, exchange->length | 1u);
		return error != 0 ? error : lw_pdu_echo(exchange, exchange->length);
	}
	error = lw_pdu_check_length(exchange, 5);
	if (error != 0) {
		return error;
	}
	if (!is_data_good(function, data)) {
		return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_OUT_OF_RANGE, data, 0);
	}
	lw_pdu_echo(exchange, 5);
	switch (function) {
	case RESTART_COMMUNICATIONS:
		restart(pdu);
		break;
	case RETURN_DIAGNOSTIC_REGISTER:
		(void)lw_put16(&exchange->response[3], diagnostic_register(pdu));
		break;
	case FORCE_LISTEN_ONLY:
		pdu->listen_only = true;
		pdu->counters[LW_BUS_NO_RESPONSES]++;
		return 0;
	case CLEAR_COUNTERS:
		clear_counters(pdu);
		break;
	case CLEAR_OVERRUN_COUNTER:
		pdu->counters[LW_BUS_OVERRUNS] = 0;
		break;
	default:
		(void)lw_put16(&exchange->response[3],
			       (uint16_t)pdu->counters[function - FIRST_COUNTER]);
		break;
	}
	return 5;
}
