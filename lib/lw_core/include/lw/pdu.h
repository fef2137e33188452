/**
 * @file
 * Modbus requests: request PDU in, response PDU or exception out
 * (MODBUS Application Protocol V1.1b3). Not for interrupt context.
 *
 * Function codes 01 to 06, 08, 15, 16, 22, 23 and 43/14.
 */
#ifndef LW_PDU_H
#define LW_PDU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lw/bank.h"

/** Longest request or response: function code and data. */
#define LW_PDU_MAX 253u

/** The counters of FC08; sub-function 11 reads the first, 18 the last. */
enum lw_bus_counter {
	LW_BUS_MESSAGES,        /**< intact frames on the bus, to whichever unit */
	LW_BUS_CRC_ERRORS,      /**< frames dropped: CRC, too short, too long or a pause inside */
	LW_BUS_EXCEPTIONS,      /**< requests refused, refused broadcasts included */
	LW_BUS_SERVER_MESSAGES, /**< requests to this unit, and broadcasts, that were processed */
	LW_BUS_NO_RESPONSES,    /**< requests to this unit, and broadcasts, that got no answer */
	LW_BUS_NAKS,            /**< exception 07, which this slave never gives: 0 */
	LW_BUS_BUSY,            /**< exception 06 */
	LW_BUS_OVERRUNS,        /**< frames dropped because they were too long */
	LW_BUS_COUNTER_COUNT,
};

/** The objects of FC43/14 (device identification), by object id. */
enum lw_device_id {
	LW_DEVICE_ID_VENDOR_NAME,
	LW_DEVICE_ID_PRODUCT_CODE,
	LW_DEVICE_ID_REVISION,
	LW_DEVICE_ID_URL,
	LW_DEVICE_ID_PRODUCT_NAME,
	LW_DEVICE_ID_MODEL_NAME,
	LW_DEVICE_ID_COUNT,
};

/** Longest object of FC43/14 that fits into a response; what is longer is cut. */
#define LW_DEVICE_ID_MAX 244u

/** What a slave offers. Everything pointed to must outlive it. */
struct lw_pdu_config {
	const struct lw_bank *bank;
	const char *device_id[LW_DEVICE_ID_COUNT]; /**< never NULL */
};

/** The last refused request; the registers last_error_*. Neither reading nor success clears it. */
struct lw_last_error {
	uint16_t reason; /**< enum lw_reason */
	uint8_t function;
	uint8_t exception;
	uint16_t address; /**< offending address, LW_NO_ADDRESS if none */
	int32_t value;    /**< offending value, count, length or code */
	int32_t limit;    /**< the limit that it broke */
};

/** State of the slave above framing. The owner may read every field between two calls. */
struct lw_pdu {
	const struct lw_pdu_config *config;
	uint32_t counters[LW_BUS_COUNTER_COUNT]; /**< FC08 reads the low 16 bits */
	struct lw_last_error last_error;
	bool listen_only; /**< set and ended by FC08 */
};

/** Clear the state. `config` must outlive it. */
void lw_pdu_init(struct lw_pdu *pdu, const struct lw_pdu_config *config);

/**
 * Execute one request addressed to this unit, or broadcast.
 *
 * @param length bytes of the request, at least 1
 * @param response receives the response or exception; must not overlap the request
 * @return bytes of the response; 0 in listen-only mode
 */
size_t lw_pdu_handle(struct lw_pdu *pdu, const uint8_t *request, size_t length,
		     uint8_t response[LW_PDU_MAX]);

/** May a request with this function code be broadcast? True for the functions that only write. */
bool lw_pdu_may_broadcast(uint8_t function);

#endif /* LW_PDU_H */
