/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Commands: which may run when, and what they do.
 */
#include "device_internal.h"

#include <errno.h>
#include <string.h>

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
	case LW_COMMAND_ACKNOWLEDGE_ROPE:
	case LW_COMMAND_SET_ROPE:
	case LW_COMMAND_TRIM_EARLY:
	case LW_COMMAND_TRIM_LATE:
	case LW_COMMAND_REACQUIRE:
		break;
	}
	return false;
}

int lw_device_allow_command(const struct lw_device *device, enum lw_command command,
			    struct lw_refusal *why)
{
	const struct lw_controller *controller = &device->controller;

	if (is_guarded(command) && lw_lock_check(&device->lock, device->active.lock_code, why)) {
		return -EBUSY;
	}
	switch (command) {
	case LW_COMMAND_INDEX:
		return lw_controller_allow_index(controller, why);
	case LW_COMMAND_REACQUIRE:
		return lw_controller_allow_reacquire(controller, why);
	case LW_COMMAND_CLEAR_FAULT:
		return lw_controller_allow_clear_fault(controller, why);
	case LW_COMMAND_ACKNOWLEDGE_ROPE:
		return lw_controller_allow_acknowledge_rope(controller, why);
	case LW_COMMAND_SET_ROPE:
		return lw_controller_allow_set_rope(controller, device->asked.set_rope_mm, why);
	case LW_COMMAND_TRIM_EARLY:
	case LW_COMMAND_TRIM_LATE:
		return lw_controller_allow_hand_trim(controller, command == LW_COMMAND_TRIM_LATE,
						     why);
	case LW_COMMAND_SAVE:
		if (lw_store_saving(device->config->store)) {
			why->reason = LW_REASON_BUSY_SAVING;
			return -EBUSY;
		}
		return lw_controller_busy(controller, why);
	case LW_COMMAND_APPLY:
		if (!controller->speed.at_rest &&
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
	const bool signs = device->staged.accepted_crc != device->active.accepted_crc;

	if (device->staged.lock_code != device->active.lock_code) {
		device->lock.open = false; /* who SAVEs a code has shown to know it */
	}
	/* What has been counted was counted by the ratio until now. */
	lw_rope_watch_settle(&device->controller.rope, device->derived.edges_per_1000_drum_revs);
	/* Nothing moves now: the interrupts only count edges, by the controller's own copies. */
	device->active = device->staged;
	device->derived = derived;
	device->active_crc = lw_params_crc(&device->active);
	lw_set_copy_keep(&device->set_copy, &device->active, &device->derived);
	lw_controller_configure(&device->controller, &device->active, &device->derived, need_index);
	lw_device_cam_configure(device);
	lw_device_log(device, LW_EVENT_APPLIED, 0);
	if (signs) {
		lw_device_log(device, LW_EVENT_ACCEPTED, (int32_t)device->active.accepted_crc);
	}
}

static void set_rope(struct lw_device *device)
{
	if (lw_controller_set_rope(&device->controller, device->set_rope_mm)) {
		device->command.result = LW_RESULT_REFUSED;
		(void)lw_refuse(&device->command.why, -EINVAL, LW_REASON_ROPE_TOO_LONG,
				LW_ADDRESS_SET_ROPE_MM, device->set_rope_mm, 0);
		return;
	}
	lw_device_log(device, LW_EVENT_ROPE_SET, device->set_rope_mm);
}

void lw_device_trim_buttons(struct lw_device *device, const bool pressed[2])
{
	const unsigned int presses = lw_controller_trim_buttons(&device->controller, pressed);
	struct lw_refusal why;

	/* Not by lw_device_run_command(): a master's command keeps its account. */
	for (int later = 0; later < 2; later++) {
		if (!(presses >> later & 1)) {
			continue;
		}
		if (lw_controller_allow_hand_trim(&device->controller, later != 0, &why)) {
			lw_device_log(device, LW_EVENT_TRIM_REFUSED, why.reason);
		} else {
			lw_device_log(device, LW_EVENT_TRIMMED,
				      lw_controller_hand_trim(&device->controller, later != 0));
		}
	}
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
	case LW_COMMAND_REACQUIRE:
		device->command.result = LW_RESULT_IN_PROGRESS;
		lw_controller_reacquire(&device->controller);
		break;
	case LW_COMMAND_STOP:
		lw_device_log(device, LW_EVENT_STOPPED, 0);
		lw_controller_stop(&device->controller);
		break;
	case LW_COMMAND_CLEAR_FAULT:
		lw_controller_clear_fault(&device->controller);
		break;
	case LW_COMMAND_ACKNOWLEDGE_ROPE:
		lw_controller_acknowledge_rope(&device->controller);
		break;
	case LW_COMMAND_SET_ROPE:
		set_rope(device);
		break;
	case LW_COMMAND_TRIM_EARLY:
	case LW_COMMAND_TRIM_LATE:
		(void)lw_controller_hand_trim(&device->controller, command == LW_COMMAND_TRIM_LATE);
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
		/* No hand-over in between, if it can be written at once. */
		device->controller.storing = device->controller.speed.at_rest;
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

void lw_device_watch_command(struct lw_device *device)
{
	const struct lw_controller *controller = &device->controller;

	if ((device->command.code != LW_COMMAND_INDEX &&
	     device->command.code != LW_COMMAND_REACQUIRE) ||
	    device->command.result != LW_RESULT_IN_PROGRESS) {
		return;
	}
	if (controller->indexed) {
		device->command.result = LW_RESULT_DONE;
	} else if (!lw_controller_moving(controller) && controller->state != LW_STATE_REACQUIRING) {
		device->command.result = LW_RESULT_FAILED;
		device->command.why.reason =
			controller->state == LW_STATE_FAULT ? LW_REASON_FAULTED : LW_REASON_STOPPED;
	}
}
