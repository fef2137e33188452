/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The settings of the serial line: those in use, and their change on trial.
 */
#include "device_internal.h"

#include <string.h>

static struct lw_line line_of(const struct lw_params *params)
{
	return (struct lw_line){
		.unit_id = (uint8_t)params->unit_id,
		.baud_rate = params->baud_rate,
		.format = (enum lw_line_format)params->line_format,
	};
}

static bool is_same(const struct lw_line *a, const struct lw_line *b)
{
	return a->unit_id == b->unit_id && a->baud_rate == b->baud_rate && a->format == b->format;
}

/** The slave's part of a change; the host does the port's. */
static void use(struct lw_device *device, const struct lw_line *line)
{
	const struct lw_device_config *config = device->config;

	device->line = *line;
	device->slave_config.unit_id = line->unit_id;
	device->slave_config.rtu.silence_us =
		config->silence_us ? config->silence_us : lw_rtu_silence_us(line->baud_rate);
	device->slave_config.byte_us =
		config->line_takes_no_time ? 0 : lw_rtu_byte_us(line->baud_rate);
}

void lw_device_line_init(struct lw_device *device)
{
	const struct lw_device_config *config = device->config;
	struct lw_line line = line_of(config->default_line ? &lw_params_default : &device->active);

	if (config->unit_id != 0) {
		line.unit_id = config->unit_id;
	}
	use(device, &line);
}

bool lw_device_line_differs(const struct lw_device *device)
{
	const struct lw_line active = line_of(&device->active);

	return !is_same(&active, &device->line);
}

bool lw_device_line_on_trial(const struct lw_device *device)
{
	return device->line_trial.running &&
	       device->slave.own_requests == device->line_trial.own_requests;
}

void lw_device_line_try(struct lw_device *device)
{
	const struct lw_line active = line_of(&device->active);

	device->line_trial = (struct lw_line_trial){
		.running = true,
		.before = device->line,
		/* The request that is being executed came at the old settings. */
		.own_requests = device->slave.own_requests,
		.ends_us = device->now_us + (uint64_t)device->active.line_confirm_s * 1000000u,
	};
	use(device, &active);
	lw_slave_reconfigure(&device->slave);
}

void lw_device_line_tick(struct lw_device *device)
{
	struct lw_line_trial *trial = &device->line_trial;
	const bool told = device->command.code == LW_COMMAND_TRY_LINE &&
			  device->command.result == LW_RESULT_IN_PROGRESS;

	if (!trial->running) {
		return;
	}
	if (!lw_device_line_on_trial(device)) {
		trial->running = false;
		if (told) {
			device->command.result = LW_RESULT_DONE;
		}
		return;
	}
	if (device->now_us < trial->ends_us) {
		return;
	}
	trial->running = false;
	use(device, &trial->before);
	lw_slave_reconfigure(&device->slave);
	/* A SAVE must not store settings at which nobody was heard. */
	device->active.unit_id = trial->before.unit_id;
	device->active.baud_rate = trial->before.baud_rate;
	device->active.line_format = (int32_t)trial->before.format;
	lw_set_copy_keep(&device->set_copy, &device->active, &device->derived);
	if (told) {
		device->command.result = LW_RESULT_FAILED;
		device->command.why.reason = LW_REASON_LINE_NOT_CONFIRMED;
	}
}
