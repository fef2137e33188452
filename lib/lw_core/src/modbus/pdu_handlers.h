/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The handlers of Modbus functions, group by group, which the table in pdu.c lists.
 */
#ifndef LW_PDU_HANDLERS_H
#define LW_PDU_HANDLERS_H

#include "pdu_checks.h"

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

#endif /* LW_PDU_HANDLERS_H */
