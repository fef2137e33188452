#include "lw/pdu.h"

#include <errno.h>
#include <string.h>

#include "lw/map.h"

/** Limits of MODBUS Application Protocol V1.1b3, section 6. */
enum {
	READ_BITS_MAX = 2000,
	READ_REGISTERS_MAX = 125,
	WRITE_BITS_MAX = 1968,
	WRITE_REGISTERS_MAX = 123,
	READ_WRITE_REGISTERS_MAX = 121, /* the write part of FC23 */
};

#define COIL_OFF      0x0000u
#define COIL_ON       0xFF00u
#define EXCEPTION_BIT 0x80u

#define MEI_DEVICE_ID        0x0Eu
#define DEVICE_ID_BASIC      1u
#define DEVICE_ID_EXTENDED   3u
#define DEVICE_ID_INDIVIDUAL 4u
/** Basic and regular objects, by stream and one by one. */
#define DEVICE_ID_CONFORMITY 0x82u

/** Modbus exception codes. */
enum exception {
	EXCEPTION_ILLEGAL_FUNCTION = 1,
	EXCEPTION_ILLEGAL_DATA_ADDRESS = 2,
	EXCEPTION_ILLEGAL_DATA_VALUE = 3,
	EXCEPTION_SERVER_DEVICE_FAILURE = 4,
	EXCEPTION_SERVER_DEVICE_BUSY = 6,
};

/** One request while it is handled. */
struct exchange {
	struct lw_pdu *pdu;
	const uint8_t *request;
	size_t length;
	uint8_t *response;
	struct lw_refusal why;
};

/* A handler returns the bytes of its response, 0 for no answer, or a negative errno. */
typedef int (*handler)(struct exchange *exchange);

static uint16_t get_u16(const uint8_t *at)
{
	return (uint16_t)(at[0] << 8 | at[1]);
}

static void put_u16(uint8_t *at, uint16_t value)
{
	at[0] = (uint8_t)(value >> 8);
	at[1] = (uint8_t)value;
}

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

static int refuse(struct exchange *exchange, int error, enum lw_reason reason, size_t value,
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

static int check_length(struct exchange *exchange, size_t length)
{
	if (exchange->length != length) {
		return refuse(exchange, -EINVAL, LW_REASON_BAD_LENGTH, exchange->length, length);
	}
	return 0;
}

static int check_count(struct exchange *exchange, uint16_t count, uint16_t max)
{
	if (count == 0 || count > max) {
		return refuse(exchange, -EINVAL, LW_REASON_BAD_COUNT, count, count == 0 ? 1 : max);
	}
	return 0;
}

/* The head of a write of several values ends with their number of bytes. */
static int check_bytes(struct exchange *exchange, size_t head_size, size_t byte_count)
{
	uint8_t declared = exchange->request[head_size - 1];

	if (declared != byte_count) {
		return refuse(exchange, -EINVAL, LW_REASON_BAD_LENGTH, declared, byte_count);
	}
	return check_length(exchange, head_size + byte_count);
}

/* Long enough for its fixed part? */
static int check_head(struct exchange *exchange, size_t head_size)
{
	if (exchange->length < head_size) {
		return refuse(exchange, -EINVAL, LW_REASON_BAD_LENGTH, exchange->length, head_size);
	}
	return 0;
}

/* The first `length` bytes of the request are the response. */
static int echo(struct exchange *exchange, size_t length)
{
	memcpy(exchange->response, exchange->request, length);
	return (int)length;
}

static int read_bits(struct exchange *exchange, enum lw_space space)
{
	const uint8_t *request = exchange->request;
	uint16_t count;
	uint8_t byte_count;
	int error = check_length(exchange, 5);

	if (error != 0) {
		return error;
	}
	count = get_u16(&request[3]);
	error = check_count(exchange, count, READ_BITS_MAX);
	if (error == 0) {
		error = lw_bank_read_bits(exchange->pdu->config->bank, space, get_u16(&request[1]),
					  count, &exchange->response[2], &exchange->why);
	}
	if (error != 0) {
		return error;
	}
	byte_count = (uint8_t)((count + 7) / 8);
	exchange->response[1] = byte_count;
	return 2 + byte_count;
}

static int read_registers(struct exchange *exchange, enum lw_space space, uint16_t address,
			  uint16_t count)
{
	int error = check_count(exchange, count, READ_REGISTERS_MAX);

	if (error == 0) {
		error = lw_bank_read_registers(exchange->pdu->config->bank, space, address, count,
					       &exchange->response[2], &exchange->why);
	}
	if (error != 0) {
		return error;
	}
	exchange->response[1] = (uint8_t)(2 * count);
	return 2 + 2 * count;
}

static int write_registers(struct exchange *exchange, uint16_t address, uint16_t count,
			   const uint8_t *values)
{
	return lw_bank_write_registers(exchange->pdu->config->bank, address, count, values,
				       &exchange->why);
}

static int read_coils(struct exchange *exchange)
{
	return read_bits(exchange, LW_SPACE_COIL);
}

static int read_discrete_inputs(struct exchange *exchange)
{
	return read_bits(exchange, LW_SPACE_DISCRETE);
}

static int read_simple(struct exchange *exchange, enum lw_space space)
{
	const uint8_t *request = exchange->request;
	int error = check_length(exchange, 5);

	if (error != 0) {
		return error;
	}
	return read_registers(exchange, space, get_u16(&request[1]), get_u16(&request[3]));
}

static int read_holding_registers(struct exchange *exchange)
{
	return read_simple(exchange, LW_SPACE_HOLDING);
}

static int read_input_registers(struct exchange *exchange)
{
	return read_simple(exchange, LW_SPACE_INPUT);
}

static int write_single_coil(struct exchange *exchange)
{
	const uint8_t *request = exchange->request;
	uint16_t address;
	uint16_t value;
	uint8_t bit;
	int error = check_length(exchange, 5);

	if (error != 0) {
		return error;
	}
	address = get_u16(&request[1]);
	value = get_u16(&request[3]);
	if (value != COIL_OFF && value != COIL_ON) {
		refuse(exchange, -EINVAL, LW_REASON_BAD_COIL_VALUE, value, COIL_ON);
		exchange->why.address = address;
		return -EINVAL;
	}
	bit = value == COIL_ON;
	error = lw_bank_write_bits(exchange->pdu->config->bank, address, 1, &bit, &exchange->why);
	return error != 0 ? error : echo(exchange, 5);
}

static int write_single_register(struct exchange *exchange)
{
	const uint8_t *request = exchange->request;
	int error = check_length(exchange, 5);

	if (error == 0) {
		error = write_registers(exchange, get_u16(&request[1]), 1, &request[3]);
	}
	return error != 0 ? error : echo(exchange, 5);
}

static int write_multiple_coils(struct exchange *exchange)
{
	const uint8_t *request = exchange->request;
	uint16_t count;
	int error = check_head(exchange, 6);

	if (error != 0) {
		return error;
	}
	count = get_u16(&request[3]);
	error = check_count(exchange, count, WRITE_BITS_MAX);
	if (error == 0) {
		error = check_bytes(exchange, 6, (count + 7u) / 8u);
	}
	if (error == 0) {
		error = lw_bank_write_bits(exchange->pdu->config->bank, get_u16(&request[1]), count,
					   &request[6], &exchange->why);
	}
	return error != 0 ? error : echo(exchange, 5);
}

static int write_multiple_registers(struct exchange *exchange)
{
	const uint8_t *request = exchange->request;
	uint16_t count;
	int error = check_head(exchange, 6);

	if (error != 0) {
		return error;
	}
	count = get_u16(&request[3]);
	error = check_count(exchange, count, WRITE_REGISTERS_MAX);
	if (error == 0) {
		error = check_bytes(exchange, 6, 2u * count);
	}
	if (error == 0) {
		error = write_registers(exchange, get_u16(&request[1]), count, &request[6]);
	}
	return error != 0 ? error : echo(exchange, 5);
}

static int mask_write_register(struct exchange *exchange)
{
	const uint8_t *request = exchange->request;
	uint16_t address;
	uint16_t and_mask;
	uint16_t or_mask;
	uint8_t value[2];
	int error = check_length(exchange, 7);

	if (error != 0) {
		return error;
	}
	address = get_u16(&request[1]);
	and_mask = get_u16(&request[3]);
	or_mask = get_u16(&request[5]);
	error = lw_bank_read_registers(exchange->pdu->config->bank, LW_SPACE_HOLDING, address, 1,
				       value, &exchange->why);
	if (error == 0) {
		put_u16(value,
			(uint16_t)((get_u16(value) & and_mask) | (or_mask & ~(uint32_t)and_mask)));
		error = write_registers(exchange, address, 1, value);
	}
	return error != 0 ? error : echo(exchange, 7);
}

static int read_write_multiple_registers(struct exchange *exchange)
{
	const uint8_t *request = exchange->request;
	uint16_t read_address;
	uint16_t read_count;
	uint16_t write_count;
	int result = check_head(exchange, 10);

	if (result != 0) {
		return result;
	}
	read_address = get_u16(&request[1]);
	read_count = get_u16(&request[3]);
	write_count = get_u16(&request[7]);
	result = check_count(exchange, write_count, READ_WRITE_REGISTERS_MAX);
	if (result == 0) {
		result = check_bytes(exchange, 10, 2u * write_count);
	}
	if (result != 0) {
		return result;
	}
	/* The write comes first, but not if the read would then be refused: so read twice. */
	result = read_registers(exchange, LW_SPACE_HOLDING, read_address, read_count);
	if (result < 0) {
		return result;
	}
	result = write_registers(exchange, get_u16(&request[5]), write_count, &request[10]);
	if (result != 0) {
		return result;
	}
	return read_registers(exchange, LW_SPACE_HOLDING, read_address, read_count);
}

/* ---- FC08, diagnostics ---- */

static void clear_counters(struct lw_pdu *pdu)
{
	memset(pdu->counters, 0, sizeof(pdu->counters));
}

static void restart(struct lw_pdu *pdu)
{
	clear_counters(pdu);
	pdu->listen_only = false;
}

static bool is_restart(const uint8_t *request, size_t length)
{
	return length == 5 && request[0] == 8 && get_u16(&request[1]) == 1 &&
	       (get_u16(&request[3]) == 0x0000 || get_u16(&request[3]) == 0xFF00);
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

static int diagnostics(struct exchange *exchange)
{
	enum {
		RETURN_QUERY_DATA = 0,
		RESTART_COMMUNICATIONS = 1,
		RETURN_DIAGNOSTIC_REGISTER = 2,
		FORCE_LISTEN_ONLY = 4,
		CLEAR_COUNTERS = 10,
		FIRST_COUNTER = 11,
		LAST_COUNTER = FIRST_COUNTER + LW_BUS_COUNTER_COUNT - 1,
	};
	struct lw_pdu *pdu = exchange->pdu;
	const uint8_t *request = exchange->request;
	uint16_t function;
	uint16_t data;
	int error = check_head(exchange, 5);

	if (error != 0) {
		return error;
	}
	function = get_u16(&request[1]);
	data = get_u16(&request[3]);
	if (function == RETURN_QUERY_DATA) {
		/* Any whole number of 16-bit fields: with the function code, an odd length. */
		error = check_length(exchange, exchange->length | 1u);
		return error != 0 ? error : echo(exchange, exchange->length);
	}
	if (function > LAST_COUNTER || function == 3 ||
	    (function > FORCE_LISTEN_ONLY && function < CLEAR_COUNTERS)) {
		return refuse(exchange, -ENOTSUP, LW_REASON_UNDEFINED_SUB_FUNCTION, function,
			      LAST_COUNTER);
	}
	error = check_length(exchange, 5);
	if (error != 0) {
		return error;
	}
	if (data != 0 && !is_restart(request, exchange->length)) {
		return refuse(exchange, -EINVAL, LW_REASON_OUT_OF_RANGE, data, 0);
	}
	echo(exchange, 5);
	switch (function) {
	case RESTART_COMMUNICATIONS:
		restart(pdu);
		break;
	case RETURN_DIAGNOSTIC_REGISTER:
		put_u16(&exchange->response[3], diagnostic_register(pdu));
		break;
	case FORCE_LISTEN_ONLY:
		pdu->listen_only = true;
		pdu->counters[LW_BUS_NO_RESPONSES]++;
		return 0;
	case CLEAR_COUNTERS:
		clear_counters(pdu);
		break;
	default:
		put_u16(&exchange->response[3], (uint16_t)pdu->counters[function - FIRST_COUNTER]);
		break;
	}
	return 5;
}

/* ---- FC43/14, device identification ---- */

static uint8_t object_length(const char *object)
{
	size_t length = strlen(object);

	return (uint8_t)(length < LW_DEVICE_ID_MAX ? length : LW_DEVICE_ID_MAX);
}

static int read_device_identification(struct exchange *exchange)
{
	const char *const *objects = exchange->pdu->config->device_id;
	const uint8_t *request = exchange->request;
	uint8_t *response = exchange->response;
	size_t length = 7;
	uint8_t code;
	uint8_t id;
	uint8_t end;
	int error = check_head(exchange, 2);

	if (error != 0) {
		return error;
	}
	if (request[1] != MEI_DEVICE_ID) {
		return refuse(exchange, -ENOTSUP, LW_REASON_UNDEFINED_SUB_FUNCTION, request[1],
			      MEI_DEVICE_ID);
	}
	error = check_length(exchange, 4);
	if (error != 0) {
		return error;
	}
	code = request[2];
	id = request[3];
	if (code < DEVICE_ID_BASIC || code > DEVICE_ID_INDIVIDUAL) {
		return refuse(exchange, -EINVAL, LW_REASON_UNDEFINED_SUB_FUNCTION, code,
			      DEVICE_ID_INDIVIDUAL);
	}
	if (code == DEVICE_ID_INDIVIDUAL) {
		if (id >= LW_DEVICE_ID_COUNT) {
			return refuse(exchange, -ENXIO, LW_REASON_UNDEFINED_SUB_FUNCTION, id,
				      LW_DEVICE_ID_COUNT - 1);
		}
		end = (uint8_t)(id + 1);
	} else {
		/* Extended (3) has nothing more than regular (2); an unknown id starts anew. */
		end = code == DEVICE_ID_BASIC ? LW_DEVICE_ID_URL : LW_DEVICE_ID_COUNT;
		id = id < end ? id : 0;
	}

	echo(exchange, 3);
	response[3] = DEVICE_ID_CONFORMITY;
	response[6] = 0;
	for (; id < end; id++) {
		uint8_t size = object_length(objects[id]);

		if (length + 2 + size > LW_PDU_MAX) {
			break;
		}
		response[length] = id;
		response[length + 1] = size;
		memcpy(&response[length + 2], objects[id], size);
		length += 2u + size;
		response[6]++;
	}
	response[4] = id < end ? 0xFF : 0x00; /* more follows, from this object on: */
	response[5] = id < end ? id : 0x00;
	return (int)length;
}

/* ---- all functions ---- */

static const struct function {
	uint8_t code;
	bool may_broadcast;
	handler handle;
} functions[] = {
	{1, false, read_coils},
	{2, false, read_discrete_inputs},
	{3, false, read_holding_registers},
	{4, false, read_input_registers},
	{5, true, write_single_coil},
	{6, true, write_single_register},
	{8, false, diagnostics},
	{15, true, write_multiple_coils},
	{16, true, write_multiple_registers},
	{22, true, mask_write_register},
	{23, false, read_write_multiple_registers},
	{43, false, read_device_identification},
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

static size_t answer_exception(struct exchange *exchange, int error)
{
	struct lw_pdu *pdu = exchange->pdu;
	uint8_t exception = (uint8_t)exception_of(error);

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
	struct exchange exchange = {
		.pdu = pdu,
		.request = request,
		.length = length,
		.response = response,
	};
	const struct function *function = find_function(request[0]);
	int result;

	if (pdu->listen_only) {
		pdu->counters[LW_BUS_NO_RESPONSES]++;
		if (is_restart(request, length)) {
			restart(pdu);
		}
		return 0;
	}
	pdu->counters[LW_BUS_SERVER_MESSAGES]++;
	if (function == NULL) {
		result = refuse(&exchange, -ENOTSUP, LW_REASON_UNKNOWN_FUNCTION, request[0], 0);
	} else if (length > LW_PDU_MAX) {
		result = refuse(&exchange, -EINVAL, LW_REASON_BAD_LENGTH, length, LW_PDU_MAX);
	} else {
		response[0] = request[0];
		result = function->handle(&exchange);
	}
	return result < 0 ? answer_exception(&exchange, result) : (size_t)result;
}
