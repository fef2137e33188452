/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Bits and registers: FC01 to FC06, FC15, FC16, FC22, FC23.
 */
#include "pdu_handlers.h"

#include <errno.h>

#include "lw/bytes/big_endian.h"

/** Limits of MODBUS Application Protocol V1.1b3, section 6. */
enum {
	READ_BITS_MAX = 2000,
	READ_REGISTERS_MAX = 125,
	WRITE_BITS_MAX = 1968,
	WRITE_REGISTERS_MAX = 123,
	READ_WRITE_REGISTERS_MAX = 121, /* the write part of FC23 */
};

#define COIL_OFF 0x0000u
#define COIL_ON  0xFF00u

static int read_bits(struct lw_pdu_exchange *exchange, enum lw_space space)
{
	const uint8_t *request = exchange->request;
	uint16_t count;
	uint8_t byte_count;
	int error = lw_pdu_check_length(exchange, 5);

	if (error != 0) {
		return error;
	}
	count = lw_get16(&request[3]);
	error = lw_pdu_check_count(exchange, count, READ_BITS_MAX);
	if (error == 0) {
		error = lw_bank_read_bits(exchange->pdu->config->bank, space, lw_get16(&request[1]),
					  count, &exchange->response[2], &exchange->why);
	}
	if (error != 0) {
		return error;
	}
	byte_count = (uint8_t)((count + 7) / 8);
	exchange->response[1] = byte_count;
	return 2 + byte_count;
}

static int read_registers(struct lw_pdu_exchange *exchange, enum lw_space space, uint16_t address,
			  uint16_t count)
{
	int error = lw_pdu_check_count(exchange, count, READ_REGISTERS_MAX);

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

static int write_registers(struct lw_pdu_exchange *exchange, uint16_t address, uint16_t count,
			   const uint8_t *values)
{
	return lw_bank_write_registers(exchange->pdu->config->bank, address, count, values,
				       &exchange->why);
}

int lw_pdu_read_coils(struct lw_pdu_exchange *exchange)
{
	return read_bits(exchange, LW_SPACE_COIL);
}

int lw_pdu_read_discrete_inputs(struct lw_pdu_exchange *exchange)
{
	return read_bits(exchange, LW_SPACE_DISCRETE);
}

static int read_simple(struct lw_pdu_exchange *exchange, enum lw_space space)
{
	const uint8_t *request = exchange->request;
	int error = lw_pdu_check_length(exchange, 5);

	if (error != 0) {
		return error;
	}
	return read_registers(exchange, space, lw_get16(&request[1]), lw_get16(&request[3]));
}

int lw_pdu_read_holding_registers(struct lw_pdu_exchange *exchange)
{
	return read_simple(exchange, LW_SPACE_HOLDING);
}

int lw_pdu_read_input_registers(struct lw_pdu_exchange *exchange)
{
	return read_simple(exchange, LW_SPACE_INPUT);
}

int lw_pdu_write_single_coil(struct lw_pdu_exchange *exchange)
{
	const uint8_t *request = exchange->request;
	uint16_t address;
	uint16_t value;
	uint8_t bit;
	int error = lw_pdu_check_length(exchange, 5);

	if (error != 0) {
		return error;
	}
	address = lw_get16(&request[1]);
	value = lw_get16(&request[3]);
	if (value != COIL_OFF && value != COIL_ON) {
		lw_pdu_refuse(exchange, -EINVAL, LW_REASON_BAD_COIL_VALUE, value, COIL_ON);
		exchange->why.address = address;
		return -EINVAL;
	}
	bit = value == COIL_ON;
	error = lw_bank_write_bits(exchange->pdu->config->bank, address, 1, &bit, &exchange->why);
	return error != 0 ? error : lw_pdu_echo(exchange, 5);
}

int lw_pdu_write_single_register(struct lw_pdu_exchange *exchange)
{
	const uint8_t *request = exchange->request;
	int error = lw_pdu_check_length(exchange, 5);

	if (error == 0) {
		error = write_registers(exchange, lw_get16(&request[1]), 1, &request[3]);
	}
	return error != 0 ? error : lw_pdu_echo(exchange, 5);
}

/**
 * Check a write of many: its head, which ends in a count and a byte count, and the values behind
 * it.
 *
 * @param bits of each value
 */
static int check_values(struct lw_pdu_exchange *exchange, size_t head, uint16_t most,
			unsigned int bits)
{
	uint16_t count;
	int error = lw_pdu_check_head(exchange, head);

	if (error != 0) {
		return error;
	}
	count = lw_get16(&exchange->request[head - 3]);
	error = lw_pdu_check_count(exchange, count, most);
	return error != 0 ? error : lw_pdu_check_bytes(exchange, head, (count * bits + 7u) / 8u);
}

int lw_pdu_write_multiple_coils(struct lw_pdu_exchange *exchange)
{
	const uint8_t *request = exchange->request;
	int error = check_values(exchange, 6, WRITE_BITS_MAX, 1);

	if (error == 0) {
		error = lw_bank_write_bits(exchange->pdu->config->bank, lw_get16(&request[1]),
					   lw_get16(&request[3]), &request[6], &exchange->why);
	}
	return error != 0 ? error : lw_pdu_echo(exchange, 5);
}

int lw_pdu_write_multiple_registers(struct lw_pdu_exchange *exchange)
{
	const uint8_t *request = exchange->request;
	int error = check_values(exchange, 6, WRITE_REGISTERS_MAX, 16);

	if (error == 0) {
		error = write_registers(exchange, lw_get16(&request[1]), lw_get16(&request[3]),
					&request[6]);
	}
	return error != 0 ? error : lw_pdu_echo(exchange, 5);
}

int lw_pdu_mask_write_register(struct lw_pdu_exchange *exchange)
{
	const uint8_t *request = exchange->request;
	uint16_t address;
	uint16_t and_mask;
	uint16_t or_mask;
	uint8_t value[2];
	int error = lw_pdu_check_length(exchange, 7);

	if (error != 0) {
		return error;
	}
	address = lw_get16(&request[1]);
	and_mask = lw_get16(&request[3]);
	or_mask = lw_get16(&request[5]);
	error = lw_bank_read_registers(exchange->pdu->config->bank, LW_SPACE_HOLDING, address, 1,
				       value, &exchange->why);
	if (error == 0) {
		(void)lw_put16(value, (uint16_t)((lw_get16(value) & and_mask) |
						 (or_mask & ~(uint32_t)and_mask)));
		error = write_registers(exchange, address, 1, value);
	}
	return error != 0 ? error : lw_pdu_echo(exchange, 7);
}

int lw_pdu_read_write_multiple_registers(struct lw_pdu_exchange *exchange)
{
	const uint8_t *request = exchange->request;
	uint16_t read_address;
	uint16_t read_count;
	int result = check_values(exchange, 10, READ_WRITE_REGISTERS_MAX, 16);

	if (result != 0) {
		return result;
	}
	read_address = lw_get16(&request[1]);
	read_count = lw_get16(&request[3]);
	/* The write comes first, but not if the read would then be refused: so read twice. */
	result = read_registers(exchange, LW_SPACE_HOLDING, read_address, read_count);
	if (result < 0) {
		return result;
	}
	result = write_registers(exchange, lw_get16(&request[5]), lw_get16(&request[7]),
				 &request[10]);
	if (result != 0) {
		return result;
	}
	return read_registers(exchange, LW_SPACE_HOLDING, read_address, read_count);
}
