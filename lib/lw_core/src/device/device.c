/* SPDX-License-Identifier: Apache-2.0 */
#include "device_internal.h"

#include <errno.h>
#include <string.h>

/** FC17: what kind of device this is. */
#define SERVER_ID 'L'

/** After a write: how long a drum that turns may take to show it by a second edge. */
#define WRITE_LOOK_US 100000u

size_t lw_device_begin_write(struct lw_device *device, unsigned int *slot,
			     uint8_t bytes[LW_STORE_SLOT_SIZE])
{
	struct lw_controller *controller = &device->controller;
	struct lw_store *store = device->config->store;
	const struct lw_cam_bank *cam_wanted = store->cam_wanted;
	size_t length;

	if (!controller->speed.at_rest || lw_controller_moving(controller)) {
		controller->storing = store->writing;
		return 0;
	}
	/* The drum may begin to turn: what needs a look and the log do not wait, a table does. */
	if (controller->state == LW_STATE_TRACKING) {
		store->cam_wanted = NULL;
	}
	length = lw_store_begin_write(store, slot, bytes);
	if (controller->state == LW_STATE_TRACKING) {
		store->cam_wanted = cam_wanted;
	}
	if (length > 0) {
		controller->storing = true;
		device->write_watch = (struct lw_write_watch){
			.begin_edges = lw_motion_read(&controller->motion).net_edges,
			.begin_illegal = controller->quadrature.illegal_transitions,
		};
	}
	return length;
}

/**
 * Has the drum turned since the last write began? One edge alone may be the drum rocking about it,
 * or all that was seen of many.
 */
static void watch_write(struct lw_device *device)
{
	struct lw_controller *controller = &device->controller;
	struct lw_write_watch *watch = &device->write_watch;
	const int64_t edges = lw_motion_read(&controller->motion).net_edges - watch->begin_edges;

	if (edges > 1 || edges < -1 ||
	    controller->quadrature.illegal_transitions != watch->begin_illegal) {
		watch->looks_until_us = 0;
		controller->odometer_doubtful = true;
		device->odometer_doubtful_edges = (int32_t)edges;
	} else if (edges == 0) {
		watch->looks_until_us = 0;
	}
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
	} else if (slot < LW_STORE_LOOK) {
		lw_device_cam_stored(device, result);
	} else {
		lw_budget_pay(&device->look_budget, device->now_us);
	}
	device->controller.storing = lw_store_saving(store);
	if (!device->config->edges_are_kept) {
		device->write_watch.looks_until_us = device->now_us + WRITE_LOOK_US;
		watch_write(device);
	}
}

/** The run indicator of FC17: the carriage follows the drum. */
static bool is_running(const void *context)
{
	return lw_controller_follows(&((const struct lw_device *)context)->controller);
}

void lw_device_init(struct lw_device *device, const struct lw_device_config *config,
		    const struct lw_inputs *inputs, uint64_t now_us, uint64_t slave_now_us)
{
	struct lw_refusal why;

	*device = (struct lw_device){
		.active = config->store->params,
		.command.why.address = LW_NO_ADDRESS,
		.set_rope_mm = -1,
		.now_us = now_us,
		.journal_written_us = now_us,
		.journal_due_us = UINT64_MAX,
		.heard_us = now_us,
		.heard_request_us = slave_now_us,
		.config = config,
	};
	/* The store holds no set that is refused. */
	(void)lw_params_derive(&device->active, &device->derived, &why);
	lw_set_copy_keep(&device->set_copy, &device->active, &device->derived);
	device->staged = device->active;
	device->active_crc = lw_params_crc(&device->active);

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
	lw_device_restore_look(device);
	lw_device_restore_launch(device);
	lw_device_log_power_up(device);
}

/** Set right what a flipped bit has changed where nothing else would tell of it. */
static bool mend_memory(struct lw_device *device)
{
	struct lw_controller *controller = &device->controller;
	bool mended = lw_set_copy_check(&device->set_copy, &device->active, &device->derived);

	if (controller->params != &device->active || controller->derived != &device->derived) {
		controller->params = &device->active;
		controller->derived = &device->derived;
		lw_set_copy_count(&device->set_copy);
		mended = true;
	}
	if (lw_controller_mend_law(controller)) {
		lw_set_copy_count(&device->set_copy);
		mended = true;
	}
	return mended;
}

void lw_device_tick(struct lw_device *device, uint64_t now_us)
{
	const uint64_t timeout_us = (uint64_t)device->active.master_timeout_ms * 1000;
	const uint64_t elapsed_us = now_us - device->now_us;
	const bool looks_at_memory = lw_set_copy_due(&device->set_copy);

	device->now_us = now_us;
	if (lw_controller_mend_rest(&device->controller)) {
		lw_set_copy_count(&device->set_copy);
		lw_device_log(device, LW_EVENT_MEMORY_CORRECTED, device->set_copy.corrections);
	}
	if (looks_at_memory && mend_memory(device)) {
		lw_device_log(device, LW_EVENT_MEMORY_CORRECTED, device->set_copy.corrections);
	}
	if (device->slave.last_request_us != device->heard_request_us) {
		device->heard_request_us = device->slave.last_request_us;
		device->heard_us = now_us;
	}
	device->controller.master_lost = timeout_us > 0 && now_us - device->heard_us > timeout_us;
	lw_controller_tick(&device->controller, now_us);
	lw_device_cam_tick(device);
	lw_device_watch_command(device);
	if (now_us < device->write_watch.looks_until_us) {
		watch_write(device);
	}
	lw_lock_tick(&device->lock, now_us);
	lw_device_line_tick(device);
	lw_device_log_changes(device);
	lw_device_keep_journal(device, elapsed_us);
	lw_device_keep_look(device);
	lw_device_keep_launch(device, looks_at_memory);
}
