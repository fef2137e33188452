/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Who answers: FC17 (report server id) and FC43/14 (read device identification).
 */
#include "pdu_handlers.h"

#include <errno.h>
#include <string.h>

/* ---- FC17 ---- */

#define RUN_INDICATOR_ON  0xFFu
#define RUN_INDICATOR_OFF 0x00u

/** Function code, number of bytes; then the server id, the run indicator and text. */
#define SERVER_ID_HEAD_SIZE 2u

/* Append a text, and before it a separator, as far as there is room. */
static size_t append_text(uint8_t *response, size_t length, char separator, const char *text)
{
	const size_t size = strlen(text);

	if (length + 1 + size > LW_PDU_MAX) {
		return length;
	}
	response[length] = (uint8_t)separator;
	memcpy(&response[length + 1], text, size);
	return length + 1 + size;
}

int lw_pdu_report_server_id(struct lw_pdu_exchange *exchange)
{
	const struct lw_pdu_config *config = exchange->pdu->config;
	uint8_t *response = exchange->response;
	size_t length = SERVER_ID_HEAD_SIZE;
	int error = lw_pdu_check_length(exchange, 1);

	if (error != 0) {
		return error;
	}
	response[length++] = config->server_id;
	response[length++] =
		config->is_running(config->context) ? RUN_INDICATOR_ON : RUN_INDICATOR_OFF;
	for (int id = LW_DEVICE_ID_VENDOR_NAME; id <= LW_DEVICE_ID_REVISION; id++) {
		length = append_text(response, length, ' ', config->device_id[id]);
	}
	response[1] = (uint8_t)(length - SERVER_ID_HEAD_SIZE);
	return (int)length;
}

/* ---- FC43/14 ---- */

#define MEI_DEVICE_ID        0x0Eu
#define DEVICE_ID_BASIC      1u
#define DEVICE_ID_INDIVIDUAL 4u
/** Basic and regular objects, by stream and one by one. */
#define DEVICE_ID_CONFORMITY 0x82u

static uint8_t object_length(const char *object)
{
	size_t length = strlen(object);

	return (uint8_t)(length < LW_DEVICE_ID_MAX ? length : LW_DEVICE_ID_MAX);
}

int lw_pdu_read_device_identification(struct lw_pdu_exchange *exchange)
{
	const char *const *objects = exchange->pdu->config->device_id;
	const uint8_t *request = exchange->request;
	uint8_t *response = exchange->response;
	size_t length = 7;
	uint8_t code;
	uint8_t id;
	uint8_t end;
	int error = lw_pdu_check_head(exchange, 2);

	if (error != 0) {
		return error;
	}
	if (request[1] != MEI_DEVICE_ID) {
		return lw_pdu_refuse(exchange, -ENOTSUP, LW_REASON_UNDEFINED_SUB_FUNCTION,
				     request[1], MEI_DEVICE_ID);
	}
	error = lw_pdu_check_length(exchange, 4);
	if (error != 0) {
		return error;
	}
	code = request[2];
	id = request[3];
	if (code < DEVICE_ID_BASIC || code > DEVICE_ID_INDIVIDUAL) {
		return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_UNDEFINED_SUB_FUNCTION, code,
				     DEVICE_ID_INDIVIDUAL);
	}
	if (code == DEVICE_ID_INDIVIDUAL) {
		if (id >= LW_DEVICE_ID_COUNT) {
			return lw_pdu_refuse(exchange, -ENXIO, LW_REASON_UNDEFINED_SUB_FUNCTION, id,
					     LW_DEVICE_ID_COUNT - 1);
		}
		end = (uint8_t)(id + 1);
	} else {
		/* Extended (3) has nothing more than regular (2); an unknown id starts anew. */
		end = code == DEVICE_ID_BASIC ? LW_DEVICE_ID_URL : LW_DEVICE_ID_COUNT;
		id = id < end ? id : 0;
	}

	lw_pdu_echo(exchange, 3);
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
		length += 2 + (size_t)size;
		response[6]++;
	}
	response[4] = id < end ? 0xFF : 0x00; /* more follows, from this object on: */
	response[5] = id < end ? id : 0x00;
	return (int)length;
}
