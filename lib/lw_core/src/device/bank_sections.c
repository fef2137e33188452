/* SPDX-License-Identifier: Apache-2.0 */
#include "device_internal.h"

#include <errno.h>
#include <string.h>

static void begin_write(void *context)
{
	struct lw_device *device = context;

	device->asked = (struct lw_device_asked){
		.set_rope_mm = device->set_rope_mm,
	};
}

/** Each order may be right by itself, and wrong after the other. */
static int allow_order(struct lw_device *device, enum lw_device_order order, struct lw_refusal *why)
{
	if (device->asked.order != LW_DEVICE_ORDER_NONE && device->asked.order != order) {
		why->reason = LW_REASON_SEVERAL_COMMANDS;
		return -EINVAL;
	}
	device->asked.order = order;
	return 0;
}

static int allow_jog(struct lw_device *device, int32_t direction, struct lw_refusal *why)
{
	const int ret = lw_controller_allow_jog(&device->controller, direction, why);

	if (ret != 0 || direction == 0) {
		return ret;
	}
	return allow_order(
		device, direction > 0 ? LW_DEVICE_ORDER_JOG_PLUS : LW_DEVICE_ORDER_JOG_MINUS, why);
}

static int allow_command(struct lw_device *device, enum lw_command command, struct lw_refusal *why)
{
	const bool steps_trim = command == LW_COMMAND_TRIM_EARLY || command == LW_COMMAND_TRIM_LATE;
	/* A new trim changes what no other command is judged by. */
	const bool beside_trim = device->asked.order == LW_DEVICE_ORDER_TRIM && !steps_trim;

	/* A stop is never in the way. */
	if (command != LW_COMMAND_NONE && command != LW_COMMAND_STOP && !beside_trim) {
		const int ret = allow_order(device, LW_DEVICE_ORDER_COMMAND, why);

		if (ret != 0) {
			return ret;
		}
	}
	return lw_device_allow_command(device, command, why);
}

static int allow_and_note(struct lw_device *device, enum lw_command command, struct lw_refusal *why)
{
	const int ret = allow_command(device, command, why);

	if (ret) {
		lw_device_note_command(device, command, LW_RESULT_REFUSED);
		device->command.why.reason = why->reason;
	}
	return ret;
}

static const void *coils_image(void *context)
{
	struct lw_device *device = context;
	const struct lw_controller *controller = &device->controller;

	device->coils_image = 0;
	for (size_t i = 0; i < LW_MAP_COILS_COUNT; i++) {
		const bool on =
			lw_map_coil_jog[i] != 0
				? controller->state == LW_STATE_JOGGING &&
					  !controller->moving.halting &&
					  controller->jogging.direction == lw_map_coil_jog[i]
				: device->command.code == lw_map_coil_command[i] &&
					  device->command.result == LW_RESULT_IN_PROGRESS;

		device->coils_image |= (uint32_t)on << i;
	}
	return &device->coils_image;
}

static int coils_allow(void *context, const struct lw_point *point, uint16_t element, int32_t value,
		       struct lw_refusal *why)
{
	struct lw_device *device = context;

	(void)element;
	if (value == 0) {
		return 0;
	}
	if (lw_map_coil_jog[point->address] != 0) {
		return allow_jog(device, lw_map_coil_jog[point->address], why);
	}
	return allow_and_note(device, (enum lw_command)lw_map_coil_command[point->address], why);
}

static void coils_store(void *context, const struct lw_point *point, uint16_t element,
			int32_t value)
{
	struct lw_device *device = context;
	struct lw_controller *controller = &device->controller;
	const int8_t jog = lw_map_coil_jog[point->address];

	(void)element;
	if (jog != 0) {
		/* Releasing one jog coil must not end a jog the other way. */
		if (value != 0) {
			lw_controller_jog(controller, jog, device->now_us);
		} else if (controller->jogging.direction == jog) {
			lw_controller_jog(controller, 0, device->now_us);
		}
	} else if (value != 0) {
		lw_device_run_command(device, (enum lw_command)lw_map_coil_command[point->address]);
	}
}

static const void *discretes_image(void *context)
{
	struct lw_device *device = context;

	lw_device_refresh_status(device);
	return &device->status_image.flags;
}

static const void *discretes_2_image(void *context)
{
	struct lw_device *device = context;

	lw_device_refresh_status(device);
	return &device->status_image.flags_2;
}

static const void *setpoints_image(void *context)
{
	struct lw_device *device = context;
	const struct lw_controller *controller = &device->controller;

	device->setpoints_image = (struct lw_setpoints){
		.command = device->command.code,
		.mode = (int32_t)controller->requested_mode,
		.jog = controller->state == LW_STATE_JOGGING && !controller->moving.halting
			       ? controller->jogging.direction
			       : 0,
		.trim_plus_um = controller->trim.plus_um,
		.trim_minus_um = controller->trim.minus_um,
		.drum_running = controller->drum_watch.running,
		.set_rope_mm = device->set_rope_mm,
		.cam_phase_edges = controller->motion.cam.phase_target_edges,
	};
	return &device->setpoints_image;
}

/** The farthest trim from 0 toward a refused one that passes; 0 always does. */
static int32_t farthest_trim_um(const struct lw_device *device, const struct lw_point *point,
				int32_t refused_um)
{
	const struct lw_controller *controller = &device->controller;
	const bool plus = point->address == LW_ADDRESS_TRIM_PLUS_UM;
	struct lw_refusal why;
	int32_t passes_um = 0;

	while (refused_um - passes_um > 1 || passes_um - refused_um > 1) {
		const int32_t middle_um = passes_um + (refused_um - passes_um) / 2;

		if (lw_params_check_trim(&device->active, &device->derived,
					 plus ? middle_um : controller->trim.plus_um,
					 plus ? controller->trim.minus_um : middle_um, &why)) {
			refused_um = middle_um;
		} else {
			passes_um = middle_um;
		}
	}
	return passes_um;
}

static int allow_trim(struct lw_device *device, int32_t plus_um, int32_t minus_um,
		      const struct lw_point *point, int32_t value, struct lw_refusal *why)
{
	const struct lw_controller *controller = &device->controller;

	/* A master may write all its set-points in every cycle: no change is no trim. */
	if (plus_um == controller->trim.plus_um && minus_um == controller->trim.minus_um) {
		return 0;
	}
	if (lw_controller_moving(controller)) {
		why->reason = LW_REASON_BUSY_MOVING;
		return -EBUSY;
	}

	int ret = allow_order(device, LW_DEVICE_ORDER_TRIM, why);

	if (ret) {
		return ret;
	}
	ret = lw_params_check_trim(&device->active, &device->derived, plus_um, minus_um, why);
	if (ret) {
		/* Blame the register that was written, and name the farthest trim that passes. */
		why->address = point->address;
		why->value = value;
		why->limit = farthest_trim_um(device, point, value);
	}
	return ret;
}

static int setpoints_allow(void *context, const struct lw_point *point, uint16_t element,
			   int32_t value, struct lw_refusal *why)
{
	struct lw_device *device = context;
	const struct lw_controller *controller = &device->controller;

	(void)element;
	switch (point->address) {
	case LW_ADDRESS_COMMAND:
		return allow_and_note(device, (enum lw_command)value, why);
	case LW_ADDRESS_JOG:
		return allow_jog(device, value, why);
	case LW_ADDRESS_MODE:
		/* A master may write all its set-points in every cycle: no change is no order. */
		return value == LW_MODE_CENTRE && controller->requested_mode != LW_MODE_CENTRE
			       ? lw_controller_allow_doubt(controller, why)
			       : 0;
	case LW_ADDRESS_TRIM_PLUS_UM:
		return allow_trim(device, value, controller->trim.minus_um, point, value, why);
	case LW_ADDRESS_TRIM_MINUS_UM:
		return allow_trim(device, controller->trim.plus_um, value, point, value, why);
	case LW_ADDRESS_SET_ROPE_MM:
		device->asked.set_rope_mm = value;
		return 0;
	case LW_ADDRESS_UNLOCK:
		return lw_lock_allow(&device->lock, device->active.lock_code, (uint32_t)value,
				     device->now_us, why);
	default:
		return 0;
	}
}

static void setpoints_store(void *context, const struct lw_point *point, uint16_t element,
			    int32_t value)
{
	struct lw_device *device = context;
	struct lw_controller *controller = &device->controller;

	(void)element;
	switch (point->address) {
	case LW_ADDRESS_COMMAND:
		if (value != LW_COMMAND_NONE) {
			lw_device_run_command(device, (enum lw_command)value);
		}
		break;
	case LW_ADDRESS_MODE:
		lw_controller_set_mode(controller, (enum lw_mode)value);
		break;
	case LW_ADDRESS_JOG:
		lw_controller_jog(controller, value, device->now_us);
		break;
	case LW_ADDRESS_TRIM_PLUS_UM:
		if (value != controller->trim.plus_um) {
			lw_controller_set_trim(controller, value, controller->trim.minus_um);
		}
		break;
	case LW_ADDRESS_TRIM_MINUS_UM:
		if (value != controller->trim.minus_um) {
			lw_controller_set_trim(controller, controller->trim.plus_um, value);
		}
		break;
	case LW_ADDRESS_DRUM_RUNNING:
		controller->drum_watch.running = value != 0;
		break;
	case LW_ADDRESS_SET_ROPE_MM:
		device->set_rope_mm = value;
		break;
	case LW_ADDRESS_UNLOCK:
		lw_lock_write(&device->lock, (uint32_t)value,
			      (uint32_t)device->active.lock_timeout_s, device->now_us);
		break;
	case LW_ADDRESS_CAM_PHASE_EDGES:
		lw_cam_motion_shift(&controller->motion.cam, value);
		break;
	default:
		break;
	}
}

static const void *params_image(void *context)
{
	return context;
}

static const void *staged_image(void *context)
{
	return &((struct lw_device *)context)->staged;
}

static int staged_allow(void *context, const struct lw_point *point, uint16_t element,
			int32_t value, struct lw_refusal *why)
{
	const struct lw_device *device = context;

	(void)point;
	(void)element;
	(void)value;
	if (lw_controller_follows(&device->controller)) {
		why->reason = LW_REASON_BUSY_TRACKING;
		return -EBUSY;
	}
	return lw_lock_check(&device->lock, device->active.lock_code, why);
}

static void staged_store(void *context, const struct lw_point *point, uint16_t element,
			 int32_t value)
{
	struct lw_device *device = context;

	(void)element; /* no parameter is an array */
	memcpy((char *)&device->staged + point->offset, &value, sizeof(value));
}

static const void *status_image(void *context)
{
	struct lw_device *device = context;

	lw_device_refresh_status(device);
	return &device->status_image;
}

void lw_device_make_bank(struct lw_device *device)
{
	const struct lw_bank_section sections[LW_DEVICE_SECTIONS] = {
		{.space = LW_SPACE_COIL,
		 .points = lw_map_coils,
		 .point_count = LW_MAP_COILS_COUNT,
		 .context = device,
		 .image = coils_image,
		 .allow = coils_allow,
		 .store = coils_store},
		{.space = LW_SPACE_DISCRETE,
		 .points = lw_map_discretes,
		 .point_count = 32,
		 .context = device,
		 .image = discretes_image},
		{.space = LW_SPACE_DISCRETE,
		 .points = &lw_map_discretes[32],
		 .point_count = LW_MAP_DISCRETES_COUNT - 32,
		 .context = device,
		 .image = discretes_2_image},
		{.space = LW_SPACE_HOLDING,
		 .points = lw_map_setpoints,
		 .point_count = LW_MAP_SETPOINTS_COUNT,
		 .context = device,
		 .image = setpoints_image,
		 .allow = setpoints_allow,
		 .store = setpoints_store},
		{.space = LW_SPACE_HOLDING,
		 .points = lw_map_params,
		 .point_count = LW_MAP_PARAMS_COUNT,
		 .context = device,
		 .image = staged_image,
		 .allow = staged_allow,
		 .store = staged_store},
		{.space = LW_SPACE_INPUT,
		 .points = lw_map_status,
		 .point_count = LW_MAP_STATUS_COUNT,
		 .context = device,
		 .image = status_image},
		{.space = LW_SPACE_INPUT,
		 .points = lw_map_params,
		 .point_count = LW_MAP_PARAMS_COUNT,
		 .address_offset = LW_MAP_ACTIVE_ADDRESS_OFFSET,
		 .context = &device->active,
		 .image = params_image},
		{.space = LW_SPACE_INPUT,
		 .points = lw_map_params,
		 .point_count = LW_MAP_PARAMS_COUNT,
		 .address_offset = LW_MAP_STORED_ADDRESS_OFFSET,
		 .context = &device->config->store->params,
		 .image = params_image},
		lw_device_cam_section(device),
	};

	memcpy(device->sections, sections, sizeof(sections));
	device->bank = (struct lw_bank){
		.sections = device->sections,
		.section_count = LW_DEVICE_SECTIONS,
		.begin_write = begin_write,
		.context = device,
	};
	if (device->config->host_section != NULL) {
		device->sections[device->bank.section_count++] = *device->config->host_section;
	}
}
