#include "lw/pdu.h"

#include <errno.h>
#include <string.h>

#include "pdu_internal.h"

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

int lw_pdu_refuse(struct lw_pdu_exchange *exchange, int error, enum lw_reason reason, size_t value,
		  size_t limit)
{
	exchange->why = (struct lw_refusal){
		.reason = (uint16_t)reason,
		.address = LW_NO_ADDRESS,
		.value = (int32_t)value,
		.limit = (int32_t)limit,
	};
	return error;
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

static const struct function {
	uint8_t code;
	bool may_broadcast;
	int (*handle)(struct lw_pdu_exchange *exchange);
} functions[] = {
	{1, false, lw_pdu_read_coils},
	{2, false, lw_pdu_read_discrete_inputs},
	{3, false, lw_pdu_read_holding_registers},
	{4, false, lw_pdu_read_input_registers},
	{5, true, lw_pdu_write_single_coil},
	{6, true, lw_pdu_write_single_register},
	{8, false, lw_pdu_diagnostics},
	{15, true, lw_pdu_write_multiple_coils},
	{16, true, lw_pdu_write_multiple_registers},
	{17, false, lw_pdu_report_server_id},
	{20, false, lw_pdu_read_file_record},
	{21, true, lw_pdu_write_file_record},
	{22, true, lw_pdu_mask_write_register},
	{23, false, lw_pdu_read_write_multiple_registers},
	{43, false, lw_pdu_read_device_identification},
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
