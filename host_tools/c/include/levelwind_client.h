/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Modbus RTU client of the level wind controller, for operator panels and Linux PLCs.
 *
 * Blocking calls over libmodbus; one thread at a time for one client. Functions return 0 or a
 * negative errno, and levelwind_last_error_text() then says what went wrong and what to do:
 *
 * - -ETIMEDOUT: no answer in time
 * - -EBUSY: the controller refuses this now (exception 06)
 * - -EINVAL: a value outside its limits; seen here before it is sent, or exception 03
 * - -ENXIO: the controller does not have this register (exceptions 01 and 02)
 * - -EIO: a damaged answer, an adapter that is gone, or exception 04
 * - -ECONNABORTED: something was written and no good answer came: it may have been done. Read it
 *   back, or write it again where that does no harm. Nothing is written twice by the client
 * - -EINPROGRESS, -ECONNRESET, -EPERM, -ECANCELED: see levelwind_poll_command()
 * - what the operating system says about the port
 *
 * After every other error of a call that writes nothing was changed.
 */
#ifndef LEVELWIND_CLIENT_H
#define LEVELWIND_CLIENT_H

#include <stdbool.h>
#include <stdint.h>

#include <modbus.h>

#include "levelwind_map.h"

#ifdef __cplusplus
extern "C" {
#endif

/** How to reach the controller. A member that is 0 takes the controller's factory setting. */
struct levelwind_line {
	const char *port;        /**< serial port, for example "/dev/ttyUSB0" */
	int baud_rate;           /**< 0: 19200 */
	char parity;             /**< 'E', 'O' or 'N'; 0: 'E' */
	int stop_bits;           /**< 1 or 2; 0: 1 */
	int unit_id;             /**< 1 to 247; 0: 1 */
	int response_timeout_ms; /**< until an answer begins; 0: 500 */
};

/** One connection. The members are the client's own business. */
struct levelwind_client {
	modbus_t *modbus;
	struct levelwind_line line;
	char error_text[400];
};

/** The three sets of parameters in the controller. */
enum levelwind_set {
	LEVELWIND_SET_STAGED, /**< being edited */
	LEVELWIND_SET_ACTIVE, /**< in force */
	LEVELWIND_SET_STORED, /**< in non-volatile storage */
};

/** A command that was given: what levelwind_poll_command() needs to know it again. */
struct levelwind_given {
	enum levelwind_command command;
	uint16_t sequence; /**< command_sequence that is its own */
};

/** How a command ended: the registers command_*. */
struct levelwind_command_result {
	uint16_t sequence; /**< counts every command */
	uint16_t code;     /**< enum levelwind_command */
	uint16_t result;   /**< enum levelwind_result */
	uint16_t reason;   /**< enum levelwind_reason */
	uint16_t address;  /**< offending holding register, 65535 if none */
	int32_t value;     /**< offending value */
	int32_t limit;     /**< the limit that it broke */
};

/**
 * Open the port. Nothing is sent; see levelwind_identify().
 *
 * @param client need not be initialised; after an error only its error text is valid
 * @retval 0 done; levelwind_disconnect() is due at the end
 * @retval -EINVAL a member of `line` is impossible
 * @retval -errno of the port
 */
int levelwind_connect(struct levelwind_client *client, const struct levelwind_line *line);

/** Close the port. */
void levelwind_disconnect(struct levelwind_client *client);

/**
 * Check that a level wind controller of this map answers, before anything else is asked.
 *
 * @param status receives self_test, map_version, version_* and host; the rest is untouched
 * @retval 0 it does
 * @retval -EPROTO another device, or another version of the map
 */
int levelwind_identify(struct levelwind_client *client, struct levelwind_status *status);

/**
 * Read the live status: state and all that follows it without a gap in struct levelwind_status,
 * which is all that an operator must see. One request, one snapshot; about 50 ms at 19200 baud. For
 * the loop of a panel, every 100 to 200 ms.
 *
 * @param status the other members are untouched; unspecified after an error
 * @retval 0 done
 */
int levelwind_read_live(struct levelwind_client *client, struct levelwind_status *status);

/**
 * Read the whole status, for a service page: a request for each group of members at adjacent
 * addresses (the live status, each LOS record, the counters, the command result, the last error,
 * the derived values), each a consistent snapshot. Some 350 ms at 19200 baud.
 *
 * @param status unspecified after an error
 * @retval 0 done
 */
int levelwind_read_status(struct levelwind_client *client, struct levelwind_status *status);

/**
 * Read one parameter.
 *
 * @retval 0 done
 * @retval -ENOENT there is no parameter of this name
 */
int levelwind_get_parameter(struct levelwind_client *client, const char *name,
			    enum levelwind_set set, int32_t *value);

/**
 * Stage one parameter. It takes effect with LEVELWIND_COMMAND_APPLY and survives a restart with
 * LEVELWIND_COMMAND_SAVE.
 *
 * @retval 0 done
 * @retval -ENOENT there is no parameter of this name
 * @retval -EINVAL outside its limits; nothing was sent
 * @retval -EBUSY refused now, for example while tracking
 */
int levelwind_set_parameter(struct levelwind_client *client, const char *name, int32_t value);

/**
 * Ask for a mode. It comes into force when the drum is at rest (off: at once); see
 * levelwind_status.active_mode.
 *
 * @retval 0 done
 */
int levelwind_set_mode(struct levelwind_client *client, enum levelwind_mode mode);

/**
 * Jog while held: call again within the parameter jog_hold_ms, or the carriage stops.
 *
 * @param direction -1, 0 (stop) or +1
 * @retval 0 done
 */
int levelwind_jog(struct levelwind_client *client, int direction);

/**
 * Tell whether the winch turns the drum: with the parameter drum_watch_ms a turning drum without
 * edges is an encoder fault. Write 1 when it turns, 0 before it stops.
 *
 * @retval 0 done
 */
int levelwind_set_drum_running(struct levelwind_client *client, int running);

/**
 * Shift the reversal points, in micrometres; both at once or none.
 *
 * @retval 0 done
 */
int levelwind_set_trim(struct levelwind_client *client, int32_t plus_um, int32_t minus_um);

/**
 * Open the write lock for the parameter lock_timeout_s, or close it.
 *
 * @param code the parameter lock_code; 0 closes
 * @retval 0 done
 * @retval -EINVAL a wrong code
 * @retval -EBUSY too soon after a wrong code
 */
int levelwind_unlock(struct levelwind_client *client, int32_t code);

/**
 * Give a command, and do not wait for its end: two requests. Then levelwind_poll_command().
 *
 * When the answer is lost, the controller is asked whether it took the command.
 *
 * @param given receives what levelwind_poll_command() needs; valid after 0 only
 * @retval 0 the controller took it; it may have ended already, also as refused
 * @retval -EBUSY not taken: refused now, nothing changed
 * @retval -ECONNABORTED the answer was lost, and so was the question whether it was taken: it may
 *         have been done. Look at the status before it is given again
 * @retval -errno any other: not taken, nothing changed
 */
int levelwind_start_command(struct levelwind_client *client, enum levelwind_command command,
			    struct levelwind_given *given);

/**
 * Ask how far a command has come: one request. Between two of them the panel can read the live
 * status, and give stop.
 *
 * @param result receives the registers; may be NULL. Unspecified where no answer came
 * @retval 0 done
 * @retval -EINPROGRESS it is still going on
 * @retval -EPERM refused, nothing changed
 * @retval -ECANCELED started, but did not succeed
 * @retval -ECONNRESET it was taken, and how it ended cannot be known any more: the controller
 *         restarted, or another command was given. Look at the status
 * @retval -errno any other: no good answer to this question; the command goes on, ask again
 */
int levelwind_poll_command(struct levelwind_client *client, const struct levelwind_given *given,
			   struct levelwind_command_result *result);

/**
 * Give a command and wait until it has ended. A lost answer alone does not end the waiting.
 *
 * @param timeout_ms how long to wait for the end; indexing takes as long as the carriage travels
 * @param result receives how it ended, or how far it had come; may be NULL. All 0 if the controller
 *        did not take the command, or may not have
 * @retval 0 done
 * @retval -EBUSY not taken: refused now, nothing changed
 * @retval -EPERM refused, nothing changed
 * @retval -ECANCELED started, but did not succeed
 * @retval -EINPROGRESS still going on after timeout_ms
 * @retval -ECONNRESET taken, and lost while it was going on: the line went dead, or see
 *         levelwind_poll_command()
 * @retval -ECONNABORTED it may have been done: see levelwind_start_command()
 * @retval -errno any other: not taken, nothing changed
 */
int levelwind_command(struct levelwind_client *client, enum levelwind_command command,
		      int timeout_ms, struct levelwind_command_result *result);

/** What the last call that failed has to say: one or two sentences; "" before the first failure. */
const char *levelwind_last_error_text(const struct levelwind_client *client);

/** The point of this name, or NULL. */
const struct levelwind_point *levelwind_find_point(const char *name);

/** Is this flag on? The status must come from levelwind_read_live() or levelwind_read_status(). */
bool levelwind_has_flag(const struct levelwind_status *status, enum levelwind_flag flag);

/** One line for a person: what it means that this flag is on. */
const char *levelwind_flag_text(enum levelwind_flag flag);

/**
 * One line for a person: what `value` of the point means, for example of ("state", status.state).
 * For a bit field (launch_inhibit), `value` is a bit number.
 *
 * @return "" if the map has no text for it
 */
const char *levelwind_value_text(const char *point_name, int32_t value);

#ifdef __cplusplus
}
#endif

#endif /* LEVELWIND_CLIENT_H */
