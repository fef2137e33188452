#include "device_internal.h"

#include <errno.h>
#include <string.h>

/** FC17: what kind of device this is. */
#define SERVER_ID 'L'

/** Stage the factory values of every parameter, or of those with or without the line's flag. */
static void stage_factory(struct lw_device *device, bool motion, bool line)
{
	for (size_t i = 0; i < LW_MAP_PARAMS_COUNT; i++) {
		const struct lw_point *point = &lw_map_params[i];

		if (point->flags & LW_POINT_SCOPE_LINE ? line : motion) {
			memcpy((char *)&device->staged + point->offset,
			       (const char *)&lw_params_default + point->offset, sizeof(int32_t));
		}
	}
}

/** What decodes the encoder must not change under its interrupt. */
static bool decoding_differs(const struct lw_params *a, const struct lw_params *b)
{
	const struct lw_quadrature_config old = lw_params_quadrature(a);
	const struct lw_quadrature_config fresh = lw_params_quadrature(b);

	return old.edges_per_pulse != fresh.edges_per_pulse || old.invert_a != fresh.invert_a ||
	       old.invert_b != fresh.invert_b || old.invert_direction != fresh.invert_direction;
}

/** What the write lock guards. Commands that only make things safer are never locked. */
static bool is_guarded(enum lw_command command)
{
	switch (command) {
	case LW_COMMAND_APPLY:
	case LW_COMMAND_REVERT:
	case LW_COMMAND_SAVE:
	case LW_COMMAND_FACTORY_MOTION:
	case LW_COMMAND_FACTORY_LINE:
	case LW_COMMAND_FACTORY_ALL:
	case LW_COMMAND_TRY_LINE:
		return true;
	case LW_COMMAND_NONE:
	case LW_COMMAND_INDEX:
	case LW_COMMAND_STOP:
	case LW_COMMAND_CLEAR_FAULT:
		break;
	}
	return false;
}

int lw_device_check_lock(const struct lw_device *device, struct lw_refusal *why)
{
	if (lw_lock_is_closed(&device->lock, device->active.lock_code)) {
		why->reason = LW_REASON_LOCKED;
		return -EBUSY;
	}
	return 0;
}

int lw_device_allow_command(const struct lw_device *device, enum lw_command command,
			    struct lw_refusal *why)
{
	const struct lw_controller *controller = &device->controller;

	if (is_guarded(command) && lw_device_check_lock(device, why)) {
		return -EBUSY;
	}
	switch (command) {
	case LW_COMMAND_INDEX:
		return lw_controller_allow_index(controller, why);
	case LW_COMMAND_CLEAR_FAULT:
		return lw_controller_allow_clear_fault(controller, why);
	case LW_COMMAND_SAVE:
		if (device->save_pending) {
			why->reason = LW_REASON_BUSY_SAVING;
			return -EBUSY;
		}
		return lw_controller_busy(controller, why);
	case LW_COMMAND_APPLY:
		if (!controller->drum_at_rest &&
		    decoding_differs(&device->active, &device->staged)) {
			why->reason = LW_REASON_DRUM_MOVING;
			return -EBUSY;
		}
		return lw_controller_busy(controller, why);
	case LW_COMMAND_REVERT:
	case LW_COMMAND_FACTORY_MOTION:
	case LW_COMMAND_FACTORY_LINE:
	case LW_COMMAND_FACTORY_ALL:
	case LW_COMMAND_TRY_LINE:
		return lw_controller_busy(controller, why);
	case LW_COMMAND_NONE:
	case LW_COMMAND_STOP:
		break;
	}
	return 0;
}

void lw_device_note_command(struct lw_device *device, enum lw_command command,
			    enum lw_result result)
{
	device->command.sequence++;
	device->command.code = (uint8_t)command;
	device->command.result = (uint8_t)result;
	device->command.why = (struct lw_refusal){.address = LW_NO_ADDRESS};
}

static void apply(struct lw_device *device)
{
	struct lw_derived derived;

	if (lw_params_derive(&device->staged, &derived, &device->command.why)) {
		device->command.result = LW_RESULT_REFUSED;
		return;
	}

	const bool need_index = lw_params_need_index(&device->active, &device->staged);

	if (device->staged.lock_code != device->active.lock_code) {
		device->lock.open = false; /* who SAVEs a code has shown to know it */
	}
	/* Nothing moves now: the interrupts only count edges, by the controller's own copies. */
	device->active = device->staged;
	device->derived = derived;
	lw_controller_configure(&device->controller, &device->active, &device->derived, need_index);
}

void lw_device_run_command(struct lw_device *device, enum lw_command command)
{
	lw_device_note_command(device, command, LW_RESULT_DONE);
	switch (command) {
	case LW_COMMAND_INDEX:
		device->command.result = LW_RESULT_IN_PROGRESS;
		lw_controller_index(&device->controller);
		break;
	case LW_COMMAND_STOP:
		lw_controller_stop(&device->controller);
		break;
	case LW_COMMAND_CLEAR_FAULT:
		lw_controller_clear_fault(&device->controller);
		break;
	case LW_COMMAND_APPLY:
		apply(device);
		break;
	case LW_COMMAND_REVERT:
		device->staged = device->active;
		break;
	case LW_COMMAND_SAVE:
		device->command.result = LW_RESULT_IN_PROGRESS;
		device->saving = device->active;
		lw_record_encode(&device->saving, device->record);
		device->save_pending = true;
		break;
	case LW_COMMAND_FACTORY_MOTION:
		stage_factory(device, true, false);
		break;
	case LW_COMMAND_FACTORY_LINE:
		stage_factory(device, false, true);
		break;
	case LW_COMMAND_FACTORY_ALL:
		stage_factory(device, true, true);
		break;
	case LW_COMMAND_TRY_LINE:
		device->command.result = LW_RESULT_IN_PROGRESS;
		lw_device_line_try(device);
		break;
	case LW_COMMAND_NONE:
		break;
	}
}

/** Has a command that takes its time come to an end? */
static void watch_command(struct lw_device *device)
{
	const struct lw_controller *controller = &device->controller;

	if (device->command.code != LW_COMMAND_INDEX ||
	    device->command.result != LW_RESULT_IN_PROGRESS) {
		return;
	}
	if (controller->indexed) {
		device->command.result = LW_RESULT_DONE;
	} else if (!lw_controller_moving(controller)) {
		device->command.result = LW_RESULT_FAILED;
		device->command.why.reason =
			controller->state == LW_STATE_FAULT ? LW_REASON_FAULTED : LW_REASON_STOPPED;
	}
}

const uint8_t *lw_device_pending_record(const struct lw_device *device)
{
	return device->save_pending ? device->record : NULL;
}

void lw_device_record_written(struct lw_device *device, int result)
{
	const bool told = device->command.code == LW_COMMAND_SAVE &&
			  device->command.result == LW_RESULT_IN_PROGRESS;

	device->save_pending = false;
	if (result == 0) {
		device->stored = device->saving;
		device->defaults_loaded = false;
	}
	if (told) {
		device->command.result = result == 0 ? LW_RESULT_DONE : LW_RESULT_FAILED;
		device->command.why.reason =
			result == 0 ? LW_REASON_NONE : LW_REASON_STORAGE_FAILED;
	}
}

/** The run indicator of FC17: the carriage follows the drum. */
static bool is_running(const void *context)
{
	return ((const struct lw_device *)context)->controller.state == LW_STATE_TRACKING;
}

void lw_device_init(struct lw_device *device, const struct lw_device_config *config,
		    const uint8_t *record, size_t length, const struct lw_inputs *inputs,
		    uint64_t now_us, uint64_t slave_now_us)
{
	struct lw_refusal why;

	*device = (struct lw_device){
		.active = lw_params_default,
		.command.why.address = LW_NO_ADDRESS,
		.now_us = now_us,
		.heard_us = now_us,
		.heard_request_us = slave_now_us,
		.config = config,
	};
	device->defaults_loaded = record == NULL ||
				  lw_record_decode(record, length, &device->active) != 0 ||
				  lw_params_derive(&device->active, &device->derived, &why) != 0;
	if (device->defaults_loaded) {
		device->active = lw_params_default;
		(void)lw_params_derive(&device->active, &device->derived, &why);
	}
	device->staged = device->active;
	device->stored = device->active;

	lw_controller_init(&device->controller, &device->active, &device->derived, inputs, now_us);
	lw_device_make_bank(device);
	device->slave_config = (struct lw_slave_config){
		.pdu.bank = &device->bank,
		.pdu.device_id = {LW_PRODUCT_VENDOR, LW_PRODUCT_CODE, LW_VERSION_STRING,
				  LW_PRODUCT_URL, LW_PRODUCT_NAME, LW_PRODUCT_CODE},
		.pdu.server_id = SERVER_ID,
		.pdu.is_running = is_running,
		.pdu.context = device,
	};
	lw_device_line_init(device);
	lw_slave_init(&device->slave, &device->slave_config, slave_now_us);
}

void lw_device_tick(struct lw_device *device, uint64_t now_us)
{
	const uint64_t timeout_us = (uint64_t)device->active.master_timeout_ms * 1000;

	device->now_us = now_us;
	if (device->slave.last_request_us != device->heard_request_us) {
		device->heard_request_us = device->slave.last_request_us;
		device->heard_us = now_us;
	}
	device->controller.master_lost = timeout_us > 0 && now_us - device->heard_us > timeout_us;
	lw_controller_tick(&device->controller, now_us);
	watch_command(device);
	lw_lock_tick(&device->lock, now_us);
	lw_device_line_tick(device);
}
