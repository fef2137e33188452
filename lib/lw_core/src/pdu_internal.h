/**
 * @file
 * What the groups of Modbus functions share: the request at hand, its checks, and the handlers that
 * the table in pdu.c lists.
 */
#ifndef LW_PDU_INTERNAL_H
#define LW_PDU_INTERNAL_H

#include <stdint.h>

#include "lw/map.h"
#include "lw/pdu.h"

/** One request while it is handled. */
struct lw_pdu_exchange {
	struct lw_pdu *pdu;
	const uint8_t *request;
	size_t length; /**< bytes of the request, 1 to LW_PDU_MAX */
	uint8_t *response;
	struct lw_refusal why;
};

static inline uint16_t lw_pdu_get_u16(const uint8_t *at)
{
	return (uint16_t)(at[0] << 8 | at[1]);
}

static inline void lw_pdu_put_u16(uint8_t *at, uint16_t value)
{
	at[0] = (uint8_t)(value >> 8);
	at[1] = (uint8_t)value;
}

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

/*
 * The handlers return the bytes of their response, 0 for no answer, or a negative errno. The
 * response's function code is set already.
 */

/* pdu_data.c */
int lw_pdu_read_coils(struct lw_pdu_exchange *exchange);
int lw_pdu_read_discrete_inputs(struct lw_pdu_exchange *exchange);
int lw_pdu_read_holding_registers(struct lw_pdu_exchange *exchange);
int lw_pdu_read_input_registers(struct lw_pdu_exchange *exchange);
int lw_pdu_write_single_coil(struct lw_pdu_exchange *exchange);
int lw_pdu_write_single_register(struct lw_pdu_exchange *exchange);
int lw_pdu_write_multiple_coils(struct lw_pdu_exchange *exchange);
int lw_pdu_write_multiple_registers(struct lw_pdu_exchange *exchange);
int lw_pdu_mask_write_register(struct lw_pdu_exchange *exchange);
int lw_pdu_read_write_multiple_registers(struct lw_pdu_exchange *exchange);

/* pdu_files.c */
int lw_pdu_read_file_record(struct lw_pdu_exchange *exchange);
int lw_pdu_write_file_record(struct lw_pdu_exchange *exchange);

/* pdu_diagnostics.c */
int lw_pdu_diagnostics(struct lw_pdu_exchange *exchange);
/** In listen-only mode a restart (FC08, sub-function 1) is the one request that is taken. */
void lw_pdu_restart_if_asked(struct lw_pdu *pdu, const uint8_t *request, size_t length);

/* pdu_identity.c */
int lw_pdu_report_server_id(struct lw_pdu_exchange *exchange);
int lw_pdu_read_device_identification(struct lw_pdu_exchange *exchange);

#endif /* LW_PDU_INTERNAL_H */
