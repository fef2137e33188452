/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/modbus/pdu.h"

#include <errno.h>
#include <string.h>

#include "pdu_handlers.h"

#define EXCEPTION_BIT 0x80u

/** Modbus exception codes. */
enum exception {
	EXCEPTION_ILLEGAL_FUNCTION = 1,
	EXCEPTION_ILLEGAL_DATA_ADDRESS = 2,
	EXCEPTION_ILLEGAL_DATA_VALUE = 3,
	EXCEPTION_SERVER_DEVICE_FAILURE = 4,
	EXCEPTION_SERVER_DEVICE_BUSY = 6,
};

/* The one place where an error becomes a Modbus exception. */
static enum exception exception_of(int error)
{
	switch (error) {
	case -ENOTSUP:
		return EXCEPTION_ILLEGAL_FUNCTION;
	case -ENXIO:
		return EXCEPTION_ILLEGAL_DATA_ADDRESS;
	case -EINVAL:
		return EXCEPTION_ILLEGAL_DATA_VALUE;
	case -EBUSY:
		return EXCEPTION_SERVER_DEVICE_BUSY;
	default: /* -EIO */
		return EXCEPTION_SERVER_DEVICE_FAILURE;
	}
}

/** How an answer can be told from a request of the same function. */
enum response_form {
	LIKE_REQUEST,   /**< not at all */
	BYTES,          /**< by a count of all bytes that follow; a request has another length */
	RANGE_WRITTEN,  /**< by its 5 bytes, where a request has data, too */
	READ_WRITTEN,   /**< by that count, where that of a request stands elsewhere */
	RECORDS,        /**< by where the reference type of the first record stands */
	IDENTIFICATION, /**< by its conformity level, and because it is longer */
};

static const struct function {
	uint8_t code;
	bool may_broadcast;
	enum response_form response_form;
	int (*handle)(struct lw_pdu_exchange *exchange);
} functions[] = {
	{1, false, BYTES, lw_pdu_read_coils},
	{2, false, BYTES, lw_pdu_read_discrete_inputs},
	{3, false, BYTES, lw_pdu_read_holding_registers},
	{4, false, BYTES, lw_pdu_read_input_registers},
	{5, true, LIKE_REQUEST, lw_pdu_write_single_coil},
	{6, true, LIKE_REQUEST, lw_pdu_write_single_register},
	{8, false, LIKE_REQUEST, lw_pdu_diagnostics},
	{15, true, RANGE_WRITTEN, lw_pdu_write_multiple_coils},
	{16, true, RANGE_WRITTEN, lw_pdu_write_multiple_registers},
	{17, false, BYTES, lw_pdu_report_server_id},
	{20, false, RECORDS, lw_pdu_read_file_record},
	{21, true, LIKE_REQUEST, lw_pdu_write_file_record},
	{22, true, LIKE_REQUEST, lw_pdu_mask_write_register},
	{23, false, READ_WRITTEN, lw_pdu_read_write_multiple_registers},
	{43, false, IDENTIFICATION, lw_pdu_read_device_identification},
};

static const struct function *find_function(uint8_t code)
{
	for (size_t i = 0; i < sizeof(functions) / sizeof(functions[0]); i++) {
		if (functions[i].code == code) {
			return &functions[i];
		}
	}
	return NULL;
}

static size_t answer_exception(struct lw_pdu_exchange *exchange, int error)
{
	struct lw_pdu *pdu = exchange->pdu;
	const uint8_t exception = (uint8_t)exception_of(error);

	pdu->last_error = (struct lw_last_error){
		.reason = exchange->why.reason,
		.function = exchange->request[0],
		.exception = exception,
		.address = exchange->why.address,
		.value = exchange->why.value,
		.limit = exchange->why.limit,
	};
	pdu->counters[LW_BUS_EXCEPTIONS]++;
	if (exception == EXCEPTION_SERVER_DEVICE_BUSY) {
		pdu->counters[LW_BUS_BUSY]++;
	}
	exchange->response[0] = exchange->request[0] | EXCEPTION_BIT;
	exchange->response[1] = exception;
	return 2;
}

void lw_pdu_init(struct lw_pdu *pdu, const struct lw_pdu_config *config)
{
	*pdu = (struct lw_pdu){.config = config};
}

bool lw_pdu_may_broadcast(uint8_t function)
{
	const struct function *known = find_function(function);

	return known != NULL && known->may_broadcast;
}

/** Does a count stand at `at` of as many bytes as follow it, of whole registers if `of_words`? */
static bool counts_rest(const uint8_t *pdu, size_t length, size_t at, bool of_words)
{
	return length > at + 1 && pdu[at] == length - at - 1 && !(of_words && pdu[at] % 2 != 0);
}

bool lw_pdu_is_response(const uint8_t *pdu, size_t length)
{
	const struct function *function = find_function(pdu[0]);
	const bool of_words = pdu[0] == 3 || pdu[0] == 4;

	if (pdu[0] & EXCEPTION_BIT) {
		return true;
	}
	switch (function != NULL ? function->response_form : LIKE_REQUEST) {
	case BYTES:
		return counts_rest(pdu, length, 1, of_words) && (length != 5 || pdu[0] == 17);
	case RANGE_WRITTEN:
		return length == 5;
	case READ_WRITTEN:
		return counts_rest(pdu, length, 1, true) && !counts_rest(pdu, length, 9, true);
	case RECORDS:
		/* A request's groups begin with the type, 6; an answer's with an odd count. */
		return counts_rest(pdu, length, 1, false) && length > 4 && pdu[2] % 2 == 1 &&
		       pdu[3] == 6;
	case IDENTIFICATION:
		return length > 6 && pdu[1] == 14 && (pdu[3] & 0x80) != 0;
	case LIKE_REQUEST:
		break;
	}
	return false;
}

size_t lw_pdu_handle(struct lw_pdu *pdu, const uint8_t *request, size_t length,
		     uint8_t response[LW_PDU_MAX])
{
	struct lw_pdu_exchange exchange = {
		.pdu = pdu,
		.request = request,
		.length = length,
		.response = response,
	};
	const struct function *function = find_function(request[0]);
	int result;

	if (pdu->listen_only) {
		pdu->counters[LW_BUS_NO_RESPONSES]++;
		lw_pdu_restart_if_asked(pdu, request, length);
		return 0;
	}
	pdu->counters[LW_BUS_SERVER_MESSAGES]++;
	if (function == NULL) {
		result = lw_pdu_refuse(&exchange, -ENOTSUP, LW_REASON_UNKNOWN_FUNCTION, request[0],
				       0);
	} else if (length > LW_PDU_MAX) {
		result =
			lw_pdu_refuse(&exchange, -EINVAL, LW_REASON_BAD_LENGTH, length, LW_PDU_MAX);
	} else {
		response[0] = request[0];
		result = function->handle(&exchange);
	}
	return result < 0 ? answer_exception(&exchange, result) : (size_t)result;
}
