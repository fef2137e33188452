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
	case LW_COMMAND_CAM_CHECK:
	case LW_COMMAND_CAM_ACTIVATE:
	case LW_COMMAND_CAM_DISCARD:
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
		if (lw_store_saving(device->config->store)) {
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
	case LW_COMMAND_CAM_CHECK:
	case LW_COMMAND_CAM_ACTIVATE:
	case LW_COMMAND_CAM_DISCARD:
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

	if (lw_params_derive(&device->staged, &derived, &device->command.why) ||
	    lw_device_cam_check(device, &device->staged, &device->command.why)) {
		device->command.result = LW_RESULT_REFUSED;
		lw_device_log(device, LW_EVENT_APPLY_REFUSED, device->command.why.reason);
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
	lw_device_cam_configure(device);
	lw_device_log(device, LW_EVENT_APPLIED, 0);
}

void lw_device_run_command(struct lw_device *device, enum lw_command command)
{
	lw_device_note_command(device, command, LW_RESULT_DONE);
	switch (command) {
	case LW_COMMAND_INDEX:
		device->command.result = LW_RESULT_IN_PROGRESS;
		lw_controller_index(&device->controller);
		device->seen.indexing = true;
		lw_device_log(device, LW_EVENT_INDEX_STARTED, 0);
		break;
	case LW_COMMAND_STOP:
		lw_device_log(device, LW_EVENT_STOPPED, 0);
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
		lw_store_save(device->config->store, &device->active);
		/* No hand-over in between: it is written at once. */
		device->controller.storing = true;
		break;
	case LW_COMMAND_FACTORY_MOTION:
	case LW_COMMAND_FACTORY_LINE:
	case LW_COMMAND_FACTORY_ALL:
		stage_factory(device, command != LW_COMMAND_FACTORY_LINE,
			      command != LW_COMMAND_FACTORY_MOTION);
		lw_device_log(device, LW_EVENT_FACTORY_STAGED, (int32_t)command);
		break;
	case LW_COMMAND_TRY_LINE:
		device->command.result = LW_RESULT_IN_PROGRESS;
		lw_device_line_try(device);
		break;
	case LW_COMMAND_CAM_CHECK:
	case LW_COMMAND_CAM_ACTIVATE:
	case LW_COMMAND_CAM_DISCARD:
		lw_device_cam_run(device, command);
		break;
	case LW_COMMAND_NONE:
		break;
	}
	lw_device_log_changes(device);
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

size_t lw_device_begin_write(struct lw_device *device, unsigned int *slot,
			     uint8_t bytes[LW_STORE_SLOT_SIZE])
{
	struct lw_controller *controller = &device->controller;
	size_t length;

	if (controller->state == LW_STATE_TRACKING || lw_controller_moving(controller)) {
		return 0;
	}
	length = lw_store_begin_write(device->config->store, slot, bytes);
	if (length > 0) {
		controller->storing = true;
	}
	return length;
}

static void note_saved(struct lw_device *device, int result)
{
	const struct lw_store_pair *pair = &device->config->store->pairs[LW_STORE_PARAMS / 2];

	lw_device_log(device, result ? LW_EVENT_SAVE_FAILED : LW_EVENT_SAVED,
		      result ? result : (int32_t)pair->used_sequence);
	if (device->command.code == LW_COMMAND_SAVE &&
	    device->command.result == LW_RESULT_IN_PROGRESS) {
		device->command.result = result == 0 ? LW_RESULT_DONE : LW_RESULT_FAILED;
		device->command.why.reason =
			result == 0 ? LW_REASON_NONE : LW_REASON_STORAGE_FAILED;
	}
}

void lw_device_end_write(struct lw_device *device, int result)
{
	struct lw_store *store = device->config->store;
	const unsigned int slot = store->writing_slot;

	if (!store->writing) {
		return;
	}
	lw_store_end_write(store, result);
	if (slot < LW_STORE_JOURNAL) {
		note_saved(device, result);
	} else if (slot < LW_STORE_CAM) {
		lw_device_note_journal(device);
	} else {
		lw_device_cam_stored(device, result);
	}
	device->controller.storing = lw_store_saving(store);
}

/** The run indicator of FC17: the carriage follows the drum. */
static bool is_running(const void *context)
{
	return ((const struct lw_device *)context)->controller.state == LW_STATE_TRACKING;
}

void lw_device_init(struct lw_device *device, const struct lw_device_config *config,
		    const struct lw_inputs *inputs, uint64_t now_us, uint64_t slave_now_us)
{
	struct lw_refusal why;

	*device = (struct lw_device){
		.active = config->store->params,
		.command.why.address = LW_NO_ADDRESS,
		.now_us = now_us,
		.journal_written_us = now_us,
		.journal_paid_until_us = now_us,
		.heard_us = now_us,
		.heard_request_us = slave_now_us,
		.config = config,
	};
	/* The store holds no set that is refused. */
	(void)lw_params_derive(&device->active, &device->derived, &why);
	device->staged = device->active;

	lw_controller_init(&device->controller, &device->active, &device->derived, inputs, now_us);
	lw_device_cam_init(device);
	lw_device_make_bank(device);
	device->files[0] = lw_device_log_file(device);
	lw_device_cam_files(device, &device->files[1]);
	device->slave_config = (struct lw_slave_config){
		.pdu.bank = &device->bank,
		.pdu.files = device->files,
		.pdu.file_count = LW_DEVICE_FILES,
		.pdu.device_id = {LW_PRODUCT_VENDOR, LW_PRODUCT_CODE, LW_VERSION_STRING,
				  LW_PRODUCT_URL, LW_PRODUCT_NAME, LW_PRODUCT_CODE},
		.pdu.server_id = SERVER_ID,
		.pdu.is_running = is_running,
		.pdu.context = device,
	};
	lw_device_line_init(device);
	lw_slave_init(&device->slave, &device->slave_config, slave_now_us);
	lw_device_log_power_up(device);
}

void lw_device_tick(struct lw_device *device, uint64_t now_us)
{
	const uint64_t timeout_us = (uint64_t)device->active.master_timeout_ms * 1000;
	const uint64_t elapsed_us = now_us - device->now_us;

	device->now_us = now_us;
	if (device->slave.last_request_us != device->heard_request_us) {
		device->heard_request_us = device->slave.last_request_us;
		device->heard_us = now_us;
	}
	device->controller.master_lost = timeout_us > 0 && now_us - device->heard_us > timeout_us;
	lw_controller_tick(&device->controller, now_us);
	lw_device_cam_tick(device);
	watch_command(device);
	lw_lock_tick(&device->lock, now_us);
	lw_device_line_tick(device);
	lw_device_log_changes(device);
	lw_device_keep_journal(device, elapsed_us);
}
