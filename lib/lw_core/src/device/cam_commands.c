/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The device's banks of cam tables: upload by file records or registers, check, putting in force.
 */
#include "device_internal.h"

#include <errno.h>
#include <stddef.h>

#include "lw/bytes/big_endian.h"
#include "lw/control/cam_check.h"

static struct lw_cam_bank *banks(const struct lw_device *device)
{
	return device->config->store->cam_banks;
}

/** The bank that an upload goes to, or that holds the next table: the one not in force. */
static struct lw_cam_bank *next_bank(const struct lw_device *device)
{
	return &banks(device)[device->cam_active == 0 ? 1 : 0];
}

/** The bank in force, or NULL. */
static struct lw_cam_bank *active_bank(const struct lw_device *device)
{
	return device->cam_active < 0 ? NULL : &banks(device)[device->cam_active];
}

static int allow_upload(const struct lw_device *device, const struct lw_cam_bank *bank,
			struct lw_refusal *why)
{
	if (bank->state == LW_CAM_BANK_STATE_ACTIVE || bank->state == LW_CAM_BANK_STATE_QUEUED) {
		why->reason = LW_REASON_CAM_BANK_IN_USE;
		return -EBUSY;
	}
	return lw_lock_check(&device->lock, device->active.lock_code, why);
}

/* ---- files ----------------------------------------------------------------------------------- */

static uint16_t file_record_count(void *context)
{
	(void)context;
	return LW_CAM_WORDS;
}

static void file_read(void *context, uint16_t first, uint16_t count, uint8_t *out)
{
	const struct lw_device_cam_file *file = context;

	for (unsigned int i = 0; i < count; i++) {
		out = lw_put16(out, lw_cam_bank_get(file->bank, first + i));
	}
}

static int file_allow(void *context, uint16_t first, uint16_t count, const uint8_t *in,
		      struct lw_refusal *why)
{
	const struct lw_device_cam_file *file = context;

	(void)count;
	(void)in;
	why->address = first;
	return allow_upload(file->device, file->bank, why);
}

static void file_write(void *context, uint16_t first, uint16_t count, const uint8_t *in)
{
	const struct lw_device_cam_file *file = context;

	for (unsigned int i = 0; i < count; i++) {
		lw_cam_bank_put(file->bank, first + i, lw_get16(&in[2 * i]));
	}
}

void lw_device_cam_files(struct lw_device *device, struct lw_pdu_file *files)
{
	for (unsigned int i = 0; i < LW_CAM_BANKS; i++) {
		device->cam_files[i] = (struct lw_device_cam_file){
			.device = device,
			.bank = &banks(device)[i],
		};
		files[i] = (struct lw_pdu_file){
			.number = (uint16_t)(LW_DEVICE_CAM_FILE + i),
			.context = &device->cam_files[i],
			.record_count = file_record_count,
			.read = file_read,
			.allow = file_allow,
			.write = file_write,
		};
	}
}

/* ---- registers of the upload ----------------------------------------------------------------- */

/** The word of a bank that an element of the window of rows begins at; LW_CAM_WORDS: none. */
static unsigned int window_word(const struct lw_device *device, unsigned int element)
{
	const unsigned int word =
		LW_CAM_HEAD_WORDS + (device->cam_first_row - 1u) * LW_CAM_ROW_WORDS + 2 * element;

	return word < LW_CAM_WORDS ? word : LW_CAM_WORDS;
}

static uint32_t get32(const struct lw_cam_bank *bank, unsigned int word)
{
	return (uint32_t)lw_cam_bank_get(bank, word) << 16 | lw_cam_bank_get(bank, word + 1);
}

static const void *upload_image(void *context)
{
	struct lw_device *device = context;
	struct lw_cam_upload *image = &device->cam_upload_image;
	const struct lw_cam_bank *bank = next_bank(device);

	for (unsigned int i = 0; i < LW_CAM_NAME_SIZE / 2; i++) {
		image->cam_upload_name[i] = lw_cam_bank_get(bank, i);
	}
	image->cam_upload_version = bank->table.version;
	image->cam_upload_interpolation = bank->table.interpolation;
	image->cam_upload_row_count = bank->table.row_count;
	image->cam_upload_advance = bank->table.advance;
	for (unsigned int i = 0; i < 2; i++) {
		image->cam_upload_crc[i] = lw_cam_bank_get(bank, LW_CAM_CRC_WORD + i);
	}
	image->cam_upload_first_row = device->cam_first_row;
	for (unsigned int i = 0;
	     i < sizeof(image->cam_upload_rows) / sizeof(image->cam_upload_rows[0]); i++) {
		const unsigned int word = window_word(device, i);

		image->cam_upload_rows[i] = word < LW_CAM_WORDS ? (int32_t)get32(bank, word) : 0;
	}
	return image;
}

static int upload_allow(void *context, const struct lw_point *point, uint16_t element,
			int32_t value, struct lw_refusal *why)
{
	struct lw_device *device = context;

	(void)element;
	(void)value;
	return point->address == LW_ADDRESS_CAM_UPLOAD_FIRST_ROW
		       ? 0
		       : allow_upload(device, next_bank(device), why);
}

static void upload_store(void *context, const struct lw_point *point, uint16_t element,
			 int32_t value)
{
	struct lw_device *device = context;
	struct lw_cam_bank *bank = next_bank(device);
	const unsigned int word =
		point->address == LW_ADDRESS_CAM_UPLOAD_ROWS
			? window_word(device, element)
			: point->address - (unsigned int)LW_ADDRESS_CAM_UPLOAD_NAME + element;

	if (point->address == LW_ADDRESS_CAM_UPLOAD_FIRST_ROW) {
		device->cam_first_row = (uint16_t)value;
	} else if (word == LW_CAM_WORDS) {
		return; /* rows past the last one that a table can have */
	} else if (point->type == LW_TYPE_U32 || point->type == LW_TYPE_I32) {
		lw_cam_bank_put(bank, word, (uint16_t)((uint32_t)value >> 16));
		lw_cam_bank_put(bank, word + 1, (uint16_t)value);
	} else {
		lw_cam_bank_put(bank, word, (uint16_t)value);
	}
}

struct lw_bank_section lw_device_cam_section(struct lw_device *device)
{
	return (struct lw_bank_section){
		.space = LW_SPACE_HOLDING,
		.points = lw_map_cam_upload,
		.point_count = LW_MAP_CAM_UPLOAD_COUNT,
		.context = device,
		.image = upload_image,
		.allow = upload_allow,
		.store = upload_store,
	};
}

/* ---- commands -------------------------------------------------------------------------------- */

static void refuse_command(struct lw_device *device, const struct lw_cam_refusal *why)
{
	device->cam_why = *why;
	device->command.result = LW_RESULT_REFUSED;
	device->command.why.reason = why->reason;
	device->command.why.value = why->value;
	device->command.why.limit = why->limit;
}

static void refuse_state(struct lw_device *device, enum lw_reason reason)
{
	refuse_command(device, &(struct lw_cam_refusal){.reason = (uint16_t)reason});
}

static void check(struct lw_device *device)
{
	struct lw_cam_bank *bank = next_bank(device);
	struct lw_cam_refusal why;

	if (bank->state == LW_CAM_BANK_STATE_QUEUED) {
		refuse_state(device, LW_REASON_CAM_QUEUED);
	} else if (bank->state == LW_CAM_BANK_STATE_EMPTY) {
		refuse_state(device, LW_REASON_CAM_NO_TABLE);
	} else if (lw_cam_bank_check(bank, &device->active, &bank->statistics, &why)) {
		refuse_command(device, &why);
	} else {
		bank->state = LW_CAM_BANK_STATE_READY;
		device->cam_why = (struct lw_cam_refusal){0};
	}
}

static void put_in_force(struct lw_device *device)
{
	struct lw_cam_bank *former = active_bank(device);
	struct lw_cam_bank *bank = next_bank(device);

	if (former != NULL) {
		former->state = LW_CAM_BANK_STATE_READY;
	}
	bank->state = LW_CAM_BANK_STATE_ACTIVE;
	device->cam_active = (int8_t)(bank - banks(device));
	device->controller.cam_bank = bank;
	device->controller.cam_refusal = (struct lw_cam_refusal){0};
	device->cam_stored = false;
	lw_store_save_cam(device->config->store, bank);
	lw_device_log(device, LW_EVENT_CAM_ACTIVATED, (int32_t)bank->table.version);
}

/** Can the running cam go over to another bank at the end of its cycle? */
static int check_joint(const struct lw_device *device, const struct lw_cam_bank *bank,
		       struct lw_cam_refusal *why)
{
	const struct lw_motion *motion = &device->controller.motion;
	const struct lw_cam_scale scale = lw_cam_params_scale(&device->active);
	const int32_t begin = motion->cam.cam.table->rows[0].slave;
	/* Earlier joints are in the offset, which stays as nothing is queued. */
	const int64_t slaves = lw_cam_offset(&motion->cam.cam) + begin - bank->table.rows[0].slave;
	int64_t shift_usteps;

	if (device->active.cam_start != LW_CAM_START_RELATIVE &&
	    bank->table.rows[0].slave != begin) {
		*why = (struct lw_cam_refusal){
			.reason = LW_REASON_CAM_DOES_NOT_JOIN,
			.row = 1,
			.value = bank->table.rows[0].slave,
			.limit = begin,
		};
		return -EINVAL;
	}
	/* Where the carriage is less where the table says, and what the joint adds. */
	shift_usteps = lw_cam_shift_usteps(&device->controller) +
		       slaves * scale.usteps / scale.slave_units;
	return lw_cam_bank_check_flanges(bank, &bank->statistics, &device->active, shift_usteps,
					 why);
}

static void activate(struct lw_device *device)
{
	struct lw_motion *motion = &device->controller.motion;
	struct lw_cam_bank *bank = next_bank(device);
	struct lw_cam_refusal why;

	if (bank->state == LW_CAM_BANK_STATE_QUEUED) {
		refuse_state(device, LW_REASON_CAM_QUEUED);
	} else if (bank->state != LW_CAM_BANK_STATE_READY) {
		refuse_state(device, LW_REASON_CAM_NO_TABLE);
	} else if (!motion->cam.on) {
		put_in_force(device);
	} else if (check_joint(device, bank, &why)) {
		refuse_command(device, &why);
	} else {
		lw_cam_queue(&device->controller, bank);
		bank->state = LW_CAM_BANK_STATE_QUEUED;
	}
}

static void discard(struct lw_device *device)
{
	struct lw_cam_bank *bank = next_bank(device);

	if (bank->state == LW_CAM_BANK_STATE_QUEUED) {
		if (atomic_exchange(&device->controller.motion.cam.next, NULL) != NULL) {
			bank->state = LW_CAM_BANK_STATE_READY;
		} else {
			/* The edge interrupt has taken it: the next tick will see that. */
			refuse_state(device, LW_REASON_CAM_BANK_IN_USE);
		}
	} else {
		*bank = (struct lw_cam_bank){.state = LW_CAM_BANK_STATE_EMPTY};
	}
}

void lw_device_cam_run(struct lw_device *device, enum lw_command command)
{
	if (command == LW_COMMAND_CAM_CHECK) {
		check(device);
	} else if (command == LW_COMMAND_CAM_ACTIVATE) {
		activate(device);
	} else {
		discard(device);
	}
}

/* ---- life ------------------------------------------------------------------------------------ */

void lw_device_cam_init(struct lw_device *device)
{
	device->cam_active = (int8_t)lw_store_cam_bank(device->config->store);
	device->cam_first_row = 1;
	device->cam_stored = device->cam_active >= 0;
	if (device->cam_stored) {
		active_bank(device)->state = LW_CAM_BANK_STATE_ACTIVE;
	}
	lw_device_cam_configure(device);
}

int lw_device_cam_check(struct lw_device *device, const struct lw_params *params,
			struct lw_refusal *why)
{
	const struct lw_cam_bank *bank = active_bank(device);
	struct lw_cam_refusal cam_why = {.reason = LW_REASON_CAM_NO_TABLE};
	struct lw_cam_statistics statistics;

	if (params->motion_profile != LW_MOTION_PROFILE_CAM ||
	    (bank != NULL && lw_cam_bank_check(bank, params, &statistics, &cam_why) == 0)) {
		return 0;
	}
	device->cam_why = cam_why;
	*why = (struct lw_refusal){
		.reason = cam_why.reason,
		.address = LW_ADDRESS_MOTION_PROFILE,
		.value = cam_why.value,
		.limit = cam_why.limit,
	};
	return -EINVAL;
}

void lw_device_cam_configure(struct lw_device *device)
{
	struct lw_cam_bank *active = active_bank(device);
	struct lw_cam_bank *next = next_bank(device);
	struct lw_cam_refusal why;

	device->controller.cam_bank = NULL;
	if (active != NULL) {
		if (lw_cam_bank_check(active, &device->active, &active->statistics,
				      &device->cam_why) == 0) {
			device->controller.cam_bank = active;
		} else if (device->active.motion_profile == LW_MOTION_PROFILE_CAM) {
			/* Stored under other parameters than these: APPLY would have refused. */
			device->controller.cam_refusal = device->cam_why;
		}
	}
	/* A cam that has just been stopped may have left a queued one. */
	if ((next->state == LW_CAM_BANK_STATE_READY || next->state == LW_CAM_BANK_STATE_QUEUED) &&
	    lw_cam_bank_check(next, &device->active, &next->statistics, &why)) {
		next->state = LW_CAM_BANK_STATE_LOADING;
	}
}

void lw_device_cam_stored(struct lw_device *device, int result)
{
	/* Another table may have come into force since the write began. */
	device->cam_stored = result == 0 && device->config->store->cam_wanted == NULL;
}

void lw_device_cam_tick(struct lw_device *device)
{
	struct lw_cam_motion *cam = &device->controller.motion.cam;
	const struct lw_cam_bank *bank = next_bank(device);

	/* Taken at the end of a cycle; or the cam has stopped, and there is nothing to wait for. */
	if (bank->state == LW_CAM_BANK_STATE_QUEUED &&
	    (!cam->on || cam->cam.table == &bank->table)) {
		cam->next = NULL;
		put_in_force(device);
	}
}

bool lw_device_cam_queued(const struct lw_device *device)
{
	return next_bank(device)->state == LW_CAM_BANK_STATE_QUEUED;
}

void lw_device_cam_status(const struct lw_device *device, struct lw_status *status)
{
	const struct lw_controller *controller = &device->controller;
	const struct lw_cam_motion *cam = &controller->motion.cam;
	const enum lw_slot_state *slots = device->config->store->pairs[LW_STORE_CAM / 2].state;
	const struct lw_cam_refusal *why =
		controller->cam_refusal.reason ? &controller->cam_refusal : &device->cam_why;

	status->cam_bank_0_state = (int32_t)banks(device)[0].state;
	status->cam_bank_1_state = (int32_t)banks(device)[1].state;
	status->cam_reason = why->reason;
	status->cam_reason_row = why->row;
	status->cam_reason_value = why->value;
	status->cam_reason_limit = why->limit;
	status->slot_4 = (int32_t)slots[0];
	status->slot_5 = (int32_t)slots[1];
	if (device->cam_active >= 0) {
		const struct lw_cam_bank *bank = active_bank(device);

		status->cam_stored = device->cam_stored;
		status->cam_version = bank->table.version;
		status->cam_rows = bank->table.row_count;
		status->cam_cycle_edges = bank->statistics.cycle_edges;
		status->cam_min_usteps = bank->statistics.min_usteps;
		status->cam_max_usteps = bank->statistics.max_usteps;
		status->cam_slope_max_permille = (int32_t)bank->statistics.slope_max_permille;
	}
	if (cam->on) {
		const struct lw_cam_reading reading = lw_cam_motion_read(cam);

		status->cam_position_usteps = reading.pos_usteps;
		status->cam_row = reading.row + 1;
		status->cam_cycles = reading.cycles;
		status->cam_phase_in_force_edges = reading.phase_edges;
		status->cam_waiting = reading.waiting;
	}
}
