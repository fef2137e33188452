/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Modbus requests: request PDU in, response PDU or exception out
 * (MODBUS Application Protocol V1.1b3). Not for interrupt context.
 *
 * Function codes 01 to 06, 08, 15 to 17, 20 to 23 and 43/14.
 */
#ifndef LW_PDU_H
#define LW_PDU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lw/modbus/bank.h"

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

/** Most records that a file may have: they are numbered 0 to 9999. */
#define LW_PDU_FILE_RECORDS_MAX 10000u

/**
 * A file of FC20 and FC21. Its records are 16 bits wide, high byte first. A request is done whole
 * or not at all: every group of it is checked before the first is written.
 */
struct lw_pdu_file {
	uint16_t number; /**< 1 to 65535 */
	void *context;   /**< handed to the functions below */

	/** Records that the file has now, at most LW_PDU_FILE_RECORDS_MAX. */
	uint16_t (*record_count)(void *context);

	/** Read `count` records from `first` on, all of which exist, as 2 * count bytes. */
	void (*read)(void *context, uint16_t first, uint16_t count, uint8_t *out);

	/**
	 * May these records, all of which exist, be written now? NULL: the file is read only.
	 * @param in 2 * count bytes
	 * @param why receives the whole refusal
	 * @retval 0 yes
	 * @retval -EBUSY not now (Modbus exception 06)
	 * @retval -EINVAL not these values (Modbus exception 03)
	 */
	int (*allow)(void *context, uint16_t first, uint16_t count, const uint8_t *in,
		     struct lw_refusal *why);

	/** Take records that were allowed. Cannot fail. NULL: the file is read only. */
	void (*write)(void *context, uint16_t first, uint16_t count, const uint8_t *in);
};

/** What a slave offers. Everything pointed to must outlive it. */
struct lw_pdu_config {
	const struct lw_bank *bank;
	const char *device_id[LW_DEVICE_ID_COUNT]; /**< never NULL */
	const struct lw_pdu_file *files;           /**< NULL if there are none */
	size_t file_count;
	uint8_t server_id; /**< of FC17: what kind of device this is */
	/** The run indicator of FC17. */
	bool (*is_running)(const void *context);
	const void *context; /**< handed to is_running() */
};

/** The last refused request; the registers last_error_*. Neither reading nor success clears it. */
struct lw_last_error {
	uint16_t reason; /**< enum lw_reason */
	uint8_t function;
	uint8_t exception;
	uint16_t address; /**< offending address or record, LW_NO_ADDRESS if none */
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

/**
 * Is this what only a slave sends? A function code of 0x80 and above, or a form that no request of
 * its function has. The answers of functions 05, 06, 08, 21 and 22 look like their requests.
 *
 * @param length bytes, at least 1
 */
bool lw_pdu_is_response(const uint8_t *pdu, size_t length);

#endif /* LW_PDU_H */
