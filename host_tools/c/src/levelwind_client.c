/* SPDX-License-Identifier: Apache-2.0 */
#define _POSIX_C_SOURCE 200809L

#include "levelwind_client.h"

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define COMMAND_POLL_MS 20
#define NO_ADDRESS      65535
#define FLAGS_EACH      32 /* in a pair of registers */
/* Without an answer for so long a line is dead: the controller is mute for 1 to 2 s at times. */
#define DEAD_LINE_MS    3000

/* The groups of registers that tell how a command and how a refused request ended. */
#define RESULT_START LEVELWIND_ADDRESS_COMMAND_SEQUENCE
#define RESULT_WORDS (LEVELWIND_ADDRESS_COMMAND_LIMIT + 2 - RESULT_START)
#define ERROR_START  LEVELWIND_ADDRESS_LAST_ERROR_REASON
#define ERROR_WORDS  (LEVELWIND_ADDRESS_LAST_ERROR_LIMIT + 2 - ERROR_START)

__attribute__((format(printf, 3, 4))) static int fail(struct levelwind_client *client, int error,
						      const char *format, ...)
{
	va_list arguments;

	va_start(arguments, format);
	(void)vsnprintf(client->error_text, sizeof(client->error_text), format, arguments);
	va_end(arguments);
	return -error;
}

/* ---- the map -------------------------------------------------------------------------------- */

const struct levelwind_point *levelwind_find_point(const char *name)
{
	for (size_t i = 0; i < LEVELWIND_POINT_COUNT; i++) {
		if (strcmp(levelwind_points[i].name, name) == 0) {
			return &levelwind_points[i];
		}
	}
	return NULL;
}

const char *levelwind_value_text(const char *point_name, int32_t value)
{
	const struct levelwind_point *point = levelwind_find_point(point_name);

	for (size_t i = 0; point != NULL && i < point->value_count; i++) {
		if (point->values[i].value == value) {
			return point->values[i].text;
		}
	}
	return "";
}

bool levelwind_has_flag(const struct levelwind_status *status, enum levelwind_flag flag)
{
	return (flag < FLAGS_EACH ? status->flags >> flag
				  : status->flags_2 >> (flag - FLAGS_EACH)) &
	       1;
}

const char *levelwind_flag_text(enum levelwind_flag flag)
{
	return flag < FLAGS_EACH ? levelwind_value_text("flags", (int32_t)flag)
				 : levelwind_value_text("flags_2", (int32_t)flag - FLAGS_EACH);
}

static int32_t to_i32(const uint16_t *words)
{
	return (int32_t)((uint32_t)words[0] << 16 | words[1]);
}

/* Any value of at most two registers that is not a u32 above INT32_MAX. */
static int32_t to_value(const struct levelwind_point *point, const uint16_t *words)
{
	if (point->words == 2) {
		return to_i32(words);
	}
	return point->type == LEVELWIND_TYPE_I16 ? (int16_t)words[0] : words[0];
}

static void store_status(struct levelwind_status *status, const struct levelwind_point *point,
			 const uint16_t *words)
{
	char *member = (char *)status + point->offset;

	if (point->type == LEVELWIND_TYPE_I64) {
		int64_t value = (int64_t)((uint64_t)(uint32_t)to_i32(words) << 32 |
					  (uint32_t)to_i32(words + 2));
		memcpy(member, &value, sizeof(value));
	} else {
		int32_t value = to_value(point, words); /* a uint32_t has the same bytes */
		memcpy(member, &value, sizeof(value));
	}
}

static int check_value(struct levelwind_client *client, const struct levelwind_point *point,
		       int32_t value)
{
	if (value < point->min || value > point->max) {
		return fail(client, EINVAL, "%s = %d is outside its limits: write %d to %d %s",
			    point->name, value, point->min, point->max, point->unit);
	}
	if (point->allowed == NULL) {
		return 0;
	}

	char list[100] = "";

	for (size_t i = 0; i < point->allowed_count; i++) {
		size_t length = strlen(list);

		if (point->allowed[i] == value) {
			return 0;
		}
		(void)snprintf(list + length, sizeof(list) - length, "%s%d", i == 0 ? "" : ", ",
			       point->allowed[i]);
	}
	return fail(client, EINVAL, "%s = %d is not possible: write one of %s %s", point->name,
		    value, list, point->unit);
}

/* ---- errors --------------------------------------------------------------------------------- */

/* Reason text and, unless it is only a matter of time, the offending register. */
static int refused(struct levelwind_client *client, int error, const char *what, uint16_t reason,
		   bool is_holding, uint16_t address, int32_t value, int32_t limit)
{
	char place[100] = "";

	if (address != NO_ADDRESS && error != EBUSY) {
		(void)snprintf(place, sizeof(place), " (address %u)", address);
		for (size_t i = 0; is_holding && i < LEVELWIND_POINT_COUNT; i++) {
			const struct levelwind_point *point = &levelwind_points[i];

			if (point->block != LEVELWIND_BLOCK_STATUS && point->address == address) {
				(void)snprintf(place, sizeof(place), " (%s: value %d, limit %d)",
					       point->name, value, limit);
			}
		}
	}
	return fail(client, error, "%s refused: %s%s", what,
		    levelwind_value_text("last_error_reason", reason), place);
}

/* An exception says little; the controller's last_error registers say why. */
static int explain_exception(struct levelwind_client *client, const char *what, int function,
			     int exception)
{
	static const int errors[] = {
		[MODBUS_EXCEPTION_ILLEGAL_FUNCTION] = ENXIO,
		[MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS] = ENXIO,
		[MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE] = EINVAL,
		[MODBUS_EXCEPTION_SLAVE_OR_SERVER_FAILURE] = EIO,
		[MODBUS_EXCEPTION_ACKNOWLEDGE] = EIO,
		[MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY] = EBUSY,
	};
	int error = EIO;
	uint16_t words[ERROR_WORDS];

	if (exception < (int)(sizeof(errors) / sizeof(errors[0]))) {
		error = errors[exception];
	}
	if (modbus_read_input_registers(client->modbus, ERROR_START, ERROR_WORDS, words) ==
		    ERROR_WORDS &&
	    words[LEVELWIND_ADDRESS_LAST_ERROR_FUNCTION - ERROR_START] == function &&
	    words[LEVELWIND_ADDRESS_LAST_ERROR_EXCEPTION - ERROR_START] == exception) {
		return refused(client, error, what, words[0],
			       function != MODBUS_FC_READ_INPUT_REGISTERS,
			       words[LEVELWIND_ADDRESS_LAST_ERROR_ADDRESS - ERROR_START],
			       to_i32(&words[LEVELWIND_ADDRESS_LAST_ERROR_VALUE - ERROR_START]),
			       to_i32(&words[LEVELWIND_ADDRESS_LAST_ERROR_LIMIT - ERROR_START]));
	}
	return fail(client, error, "%s refused: Modbus exception %d", what, exception);
}

static bool is_exception(int error)
{
	return error > MODBUS_ENOBASE && error < MODBUS_ENOBASE + MODBUS_EXCEPTION_MAX;
}

/* A libmodbus call got no good answer and has set errno to `error`, which is no exception. */
static int no_answer(struct levelwind_client *client, int error, const char *what)
{
	if (error == ETIMEDOUT) {
		return fail(client, error,
			    "%s: unit %d on %s does not answer within %d ms. Check its power, the "
			    "wiring, unit id, baud rate and parity",
			    what, client->line.unit_id, client->line.port,
			    client->line.response_timeout_ms);
	}
	if (error == ECONNRESET) {
		return fail(client, EIO, "%s: %s is gone. Check the adapter", what,
			    client->line.port);
	}
	if (error > MODBUS_ENOBASE) {
		return fail(client, EIO,
			    "%s: damaged answer on %s (%s). Check wiring, termination and parity",
			    what, client->line.port, modbus_strerror(error));
	}
	return fail(client, error, "%s: %s: %s", what, client->line.port, modbus_strerror(error));
}

/* A libmodbus call that reads failed and has set errno. */
static int read_failed(struct levelwind_client *client, const char *what, int function)
{
	int error = errno;

	if (is_exception(error)) {
		return explain_exception(client, what, function, error - MODBUS_ENOBASE);
	}
	return no_answer(client, error, what);
}

/* Put `text` behind what there is to say. */
static int but(struct levelwind_client *client, int error, const char *text)
{
	size_t length = strlen(client->error_text);

	(void)snprintf(client->error_text + length, sizeof(client->error_text) - length, "%s",
		       text);
	return -error;
}

/* A libmodbus call that writes failed and has set errno. Only an exception says: not done. */
static int write_failed(struct levelwind_client *client, const char *what, int function)
{
	int error = errno;

	if (is_exception(error)) {
		return explain_exception(client, what, function, error - MODBUS_ENOBASE);
	}
	(void)no_answer(client, error, what);
	return but(client, ECONNABORTED, ". It was sent and may have been done");
}

/* ---- requests ------------------------------------------------------------------------------- */

/* Every request flushes first: an RTU answer that came too late would pass for the next one. */

static int read_inputs(struct levelwind_client *client, const char *what, uint16_t address,
		       uint16_t count, uint16_t *words)
{
	(void)modbus_flush(client->modbus);
	if (modbus_read_input_registers(client->modbus, address, count, words) != count) {
		return read_failed(client, what, MODBUS_FC_READ_INPUT_REGISTERS);
	}
	return 0;
}

static int read_holdings(struct levelwind_client *client, const char *what, uint16_t address,
			 uint16_t count, uint16_t *words)
{
	(void)modbus_flush(client->modbus);
	if (modbus_read_registers(client->modbus, address, count, words) != count) {
		return read_failed(client, what, MODBUS_FC_READ_HOLDING_REGISTERS);
	}
	return 0;
}

static int write_holdings(struct levelwind_client *client, const char *what, uint16_t address,
			  uint16_t count, const uint16_t *words)
{
	(void)modbus_flush(client->modbus);
	if (modbus_write_registers(client->modbus, address, count, words) != count) {
		return write_failed(client, what, MODBUS_FC_WRITE_MULTIPLE_REGISTERS);
	}
	return 0;
}

static int write_point(struct levelwind_client *client, const char *what,
		       const struct levelwind_point *point, int32_t value)
{
	uint32_t bits = (uint32_t)value;
	uint16_t words[] = {(uint16_t)(bits >> 16), (uint16_t)bits};
	int error = check_value(client, point, value);

	if (error != 0) {
		return error;
	}
	return write_holdings(client, what, point->address, point->words, &words[2 - point->words]);
}

/* ---- the public functions -------------------------------------------------------------------- */

int levelwind_connect(struct levelwind_client *client, const struct levelwind_line *line)
{
	struct levelwind_line *own = &client->line;
	int error;

	memset(client, 0, sizeof(*client));
	*own = *line;
	own->baud_rate = own->baud_rate != 0 ? own->baud_rate : 19200;
	own->parity = own->parity != 0 ? own->parity : 'E';
	own->stop_bits = own->stop_bits != 0 ? own->stop_bits : 1;
	own->unit_id = own->unit_id != 0 ? own->unit_id : 1;
	own->response_timeout_ms = own->response_timeout_ms != 0 ? own->response_timeout_ms : 500;
	if (own->unit_id < 1 || own->unit_id > 247 || own->response_timeout_ms < 0) {
		return fail(client, EINVAL,
			    "unit id %d and response time-out %d ms: 1 to 247, and more than 0",
			    own->unit_id, own->response_timeout_ms);
	}

	client->modbus = modbus_new_rtu(own->port, own->baud_rate, own->parity, 8, own->stop_bits);
	if (client->modbus == NULL) {
		return fail(client, errno, "%s, %d baud, parity %c: %s", own->port, own->baud_rate,
			    own->parity, modbus_strerror(errno));
	}
	(void)modbus_set_slave(client->modbus, own->unit_id);
	(void)modbus_set_response_timeout(client->modbus, (uint32_t)own->response_timeout_ms / 1000,
					  (uint32_t)own->response_timeout_ms % 1000 * 1000);
	(void)modbus_set_error_recovery(client->modbus, MODBUS_ERROR_RECOVERY_PROTOCOL);
	if (modbus_connect(client->modbus) != 0) {
		error = fail(client, errno, "cannot open %s: %s", own->port,
			     modbus_strerror(errno));
		modbus_free(client->modbus);
		client->modbus = NULL;
		return error;
	}
	return 0;
}

void levelwind_disconnect(struct levelwind_client *client)
{
	modbus_close(client->modbus);
	modbus_free(client->modbus);
	client->modbus = NULL;
}

/* Read the run of status points without a gap that begins at levelwind_points[*index]. */
static int read_status_run(struct levelwind_client *client, size_t *index,
			   struct levelwind_status *status)
{
	uint16_t words[MODBUS_MAX_READ_REGISTERS];
	uint16_t start = levelwind_points[*index].address;
	uint16_t count = 0;
	size_t end = *index;
	int error;

	while (end < LEVELWIND_POINT_COUNT && levelwind_points[end].address == start + count &&
	       count + levelwind_points[end].words <= MODBUS_MAX_READ_REGISTERS) {
		count = (uint16_t)(count + levelwind_points[end].words);
		end++;
	}
	error = read_inputs(client, "reading the status", start, count, words);
	if (error != 0) {
		return error;
	}
	for (; *index < end; (*index)++) {
		const struct levelwind_point *point = &levelwind_points[*index];

		store_status(status, point, &words[point->address - start]);
	}
	return 0;
}

static size_t index_of(const char *name)
{
	return (size_t)(levelwind_find_point(name) - levelwind_points);
}

int levelwind_identify(struct levelwind_client *client, struct levelwind_status *status)
{
	size_t index = index_of("self_test");
	int error = read_status_run(client, &index, status);

	if (error != 0) {
		return error;
	}
	if (status->self_test != LEVELWIND_SELF_TEST) {
		return fail(client, EPROTO,
			    "unit %d on %s is no level wind controller: self_test reads 0x%08X, "
			    "not 0x%08X. Check the unit id",
			    client->line.unit_id, client->line.port, status->self_test,
			    LEVELWIND_SELF_TEST);
	}
	if (status->map_version != LEVELWIND_MAP_VERSION) {
		return fail(client, EPROTO,
			    "the controller has map version %d, this client %d: use the client "
			    "that came with firmware %d.%d.%d",
			    status->map_version, LEVELWIND_MAP_VERSION, status->version_major,
			    status->version_minor, status->version_patch);
	}
	return 0;
}

int levelwind_read_live(struct levelwind_client *client, struct levelwind_status *status)
{
	size_t index = index_of("state");

	return read_status_run(client, &index, status);
}

int levelwind_read_status(struct levelwind_client *client, struct levelwind_status *status)
{
	size_t index = index_of("self_test");
	int error = 0;

	while (error == 0 && index < LEVELWIND_POINT_COUNT &&
	       levelwind_points[index].block == LEVELWIND_BLOCK_STATUS) {
		error = read_status_run(client, &index, status);
	}
	return error;
}

static const struct levelwind_point *find_parameter(struct levelwind_client *client,
						    const char *name)
{
	const struct levelwind_point *point = levelwind_find_point(name);

	if (point != NULL && point->block == LEVELWIND_BLOCK_PARAMETERS) {
		return point;
	}
	(void)fail(client, ENOENT, "there is no parameter %s: see the register list", name);
	return NULL;
}

int levelwind_get_parameter(struct levelwind_client *client, const char *name,
			    enum levelwind_set set, int32_t *value)
{
	const struct levelwind_point *point = find_parameter(client, name);
	uint16_t words[2];
	int error;

	if (point == NULL) {
		return -ENOENT;
	}
	if (set == LEVELWIND_SET_STAGED) {
		error = read_holdings(client, name, point->address, point->words, words);
	} else {
		int offset = set == LEVELWIND_SET_ACTIVE ? LEVELWIND_ACTIVE_ADDRESS_OFFSET
							 : LEVELWIND_STORED_ADDRESS_OFFSET;

		error = read_inputs(client, name, (uint16_t)(point->address + offset), point->words,
				    words);
	}
	if (error == 0) {
		*value = to_value(point, words);
	}
	return error;
}

int levelwind_set_parameter(struct levelwind_client *client, const char *name, int32_t value)
{
	const struct levelwind_point *point = find_parameter(client, name);

	return point == NULL ? -ENOENT : write_point(client, name, point, value);
}

int levelwind_set_mode(struct levelwind_client *client, enum levelwind_mode mode)
{
	return write_point(client, "mode", levelwind_find_point("mode"), (int32_t)mode);
}

int levelwind_jog(struct levelwind_client *client, int direction)
{
	return write_point(client, "jog", levelwind_find_point("jog"), direction);
}

int levelwind_set_drum_running(struct levelwind_client *client, int running)
{
	return write_point(client, "drum_running", levelwind_find_point("drum_running"), running);
}

int levelwind_set_trim(struct levelwind_client *client, int32_t plus_um, int32_t minus_um)
{
	const uint16_t words[] = {(uint16_t)plus_um, (uint16_t)minus_um};
	int error = check_value(client, levelwind_find_point("trim_plus_um"), plus_um);

	if (error == 0) {
		error = check_value(client, levelwind_find_point("trim_minus_um"), minus_um);
	}
	if (error != 0) {
		return error;
	}
	return write_holdings(client, "trim", LEVELWIND_ADDRESS_TRIM_PLUS_UM, 2, words);
}

int levelwind_unlock(struct levelwind_client *client, int32_t code)
{
	return write_point(client, "unlock", levelwind_find_point("unlock"), code);
}

static int64_t monotonic_ms(void)
{
	struct timespec now;

	(void)clock_gettime(CLOCK_MONOTONIC, &now);
	return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

static void pause_ms(int duration_ms)
{
	const struct timespec pause = {.tv_sec = duration_ms / 1000,
				       .tv_nsec = duration_ms % 1000 * 1000000L};

	(void)nanosleep(&pause, NULL);
}

static int read_result(struct levelwind_client *client, const char *what,
		       struct levelwind_command_result *result)
{
	uint16_t words[RESULT_WORDS];
	int error = read_inputs(client, what, RESULT_START, RESULT_WORDS, words);

	if (error != 0) {
		return error;
	}
	*result = (struct levelwind_command_result){
		.sequence = words[0],
		.code = words[LEVELWIND_ADDRESS_COMMAND_CODE - RESULT_START],
		.result = words[LEVELWIND_ADDRESS_COMMAND_RESULT - RESULT_START],
		.reason = words[LEVELWIND_ADDRESS_COMMAND_REASON - RESULT_START],
		.address = words[LEVELWIND_ADDRESS_COMMAND_ADDRESS - RESULT_START],
		.value = to_i32(&words[LEVELWIND_ADDRESS_COMMAND_VALUE - RESULT_START]),
		.limit = to_i32(&words[LEVELWIND_ADDRESS_COMMAND_LIMIT - RESULT_START]),
	};
	return 0;
}

static const char *command_name(enum levelwind_command command)
{
	const struct levelwind_point *point = levelwind_find_point("command");

	for (size_t i = 0; i < point->value_count; i++) {
		if (point->values[i].value == (int32_t)command) {
			return point->values[i].name;
		}
	}
	return point->name;
}

/* Has the controller run without a restart since `since_ms`? 0: it has. */
static int read_restarted(struct levelwind_client *client, const char *what, int64_t since_ms,
			  bool *restarted)
{
	uint16_t words[2];
	int error = read_inputs(client, what, LEVELWIND_ADDRESS_UPTIME_MS, 2, words);

	if (error == 0) {
		*restarted = (uint32_t)to_i32(words) < monotonic_ms() - since_ms;
	}
	return error;
}

/*
 * The answer to a command was lost: ask whether it was taken. Requests are done in their order, so
 * whoever answers this one has the command behind it.
 */
static int find_out_whether_taken(struct levelwind_client *client,
				  const struct levelwind_given *given, int64_t since_ms)
{
	const char *what = command_name(given->command);
	const uint16_t before = (uint16_t)(given->sequence - 1);
	const int64_t deadline_ms = monotonic_ms() + DEAD_LINE_MS;
	struct levelwind_command_result now;
	bool restarted = false;
	int error;

	do {
		error = read_result(client, what, &now);
		/* A restart sets the sequence to 0: then 0 again proves nothing. */
		if (error == 0 && before == 0 && now.sequence == 0) {
			error = read_restarted(client, what, since_ms, &restarted);
		}
		if (error != 0) {
			pause_ms(COMMAND_POLL_MS);
		}
	} while (error != 0 && monotonic_ms() < deadline_ms);
	if (error != 0) {
		return but(client, ECONNABORTED,
			   ". The command was sent and may have been done: look at the status");
	}
	if (now.sequence == given->sequence && now.code == (uint16_t)given->command) {
		return 0;
	}
	if (now.sequence == before && !restarted) {
		return fail(client, ETIMEDOUT,
			    "%s was not taken: it did not arrive. Nothing changed, give it again",
			    what);
	}
	return fail(client, ECONNABORTED,
		    "%s may have been done: its answer was lost, and then the controller restarted "
		    "or another command was given. Look at the status",
		    what);
}

int levelwind_start_command(struct levelwind_client *client, enum levelwind_command command,
			    struct levelwind_given *given)
{
	const char *what = command_name(command);
	struct levelwind_command_result before;
	int64_t since_ms;
	int error;

	if (command == LEVELWIND_COMMAND_NONE) {
		return fail(client, EINVAL,
			    "command 0 does nothing: give an enum levelwind_command");
	}
	since_ms = monotonic_ms();
	error = read_result(client, what, &before);
	if (error != 0) {
		return error;
	}
	given->command = command;
	given->sequence = (uint16_t)(before.sequence + 1);
	error = write_point(client, what, levelwind_find_point("command"), (int32_t)command);
	if (error == -ECONNABORTED) {
		return find_out_whether_taken(client, given, since_ms);
	}
	return error;
}

int levelwind_poll_command(struct levelwind_client *client, const struct levelwind_given *given,
			   struct levelwind_command_result *result)
{
	const char *what = command_name(given->command);
	struct levelwind_command_result own;
	int error;

	if (result == NULL) {
		result = &own;
	}
	error = read_result(client, what, result);
	if (error != 0) {
		return error;
	}
	if (result->sequence != given->sequence || result->code != (uint16_t)given->command) {
		return fail(client, ECONNRESET,
			    "%s: how it ended cannot be known, the controller restarted or another "
			    "command was given. Look at the status",
			    what);
	}
	switch (result->result) {
	case LEVELWIND_RESULT_DONE:
		return 0;
	case LEVELWIND_RESULT_IN_PROGRESS:
		return fail(client, EINPROGRESS, "%s is still going on", what);
	case LEVELWIND_RESULT_REFUSED:
		return refused(client, EPERM, what, result->reason, true, result->address,
			       result->value, result->limit);
	default:
		return fail(client, ECANCELED, "%s failed: %s", what,
			    levelwind_value_text("command_reason", result->reason));
	}
}

/* Does this answer of levelwind_poll_command() tell how the command ended? */
static bool has_ended(int error)
{
	return error == 0 || error == -EPERM || error == -ECANCELED || error == -ECONNRESET;
}

int levelwind_command(struct levelwind_client *client, enum levelwind_command command,
		      int timeout_ms, struct levelwind_command_result *result)
{
	struct levelwind_command_result now = {0};
	struct levelwind_given given;
	int64_t deadline_ms;
	int64_t answered_ms;
	int error;

	if (result != NULL) {
		*result = now;
	}
	error = levelwind_start_command(client, command, &given);
	if (error != 0) {
		return error;
	}
	answered_ms = monotonic_ms();
	deadline_ms = answered_ms + timeout_ms;
	for (;;) {
		error = levelwind_poll_command(client, &given, &now);
		if (result != NULL) {
			*result = now;
		}
		if (has_ended(error)) {
			return error;
		}
		if (error == -EINPROGRESS) {
			answered_ms = monotonic_ms();
		} else if (monotonic_ms() - answered_ms >= DEAD_LINE_MS) {
			return but(client, ECONNRESET,
				   ". The command was taken, and may be going on");
		}
		if (error == -EINPROGRESS && answered_ms >= deadline_ms) {
			return fail(client, EINPROGRESS,
				    "%s has not ended after %d ms: wait longer, or give stop",
				    command_name(command), timeout_ms);
		}
		pause_ms(COMMAND_POLL_MS);
	}
}

const char *levelwind_last_error_text(const struct levelwind_client *client)
{
	return client->error_text;
}
