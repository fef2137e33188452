/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/device/kept.h"

#include "device_internal.h"
#include "lw/bytes/big_endian.h"
#include "lw/bytes/crc32.h"

/** So that memory full of zeros is not sealed. */
#define SEALED 0x4C57u

static uint32_t seal_of(const struct lw_kept *kept)
{
	uint8_t bytes[12];

	(void)lw_put32(lw_put32(lw_put32(bytes, SEALED), kept->launch), (uint32_t)kept->direction);
	return lw_crc32(bytes, sizeof(bytes));
}

void lw_device_restore_launch(struct lw_device *device)
{
	const struct lw_kept *kept = device->config->kept;
	struct lw_reacquire *reacquire = &device->controller.reacquire;

	reacquire->stands_since_us = device->now_us;
	if (kept == NULL || kept->seal != seal_of(kept) || !kept->launch) {
		return;
	}
	reacquire->kept_direction = (int8_t)kept->direction;
	reacquire->wanted = device->active.reacquire_after_restart != 0;
}

void lw_device_keep_launch(struct lw_device *device, bool looks_at_memory)
{
	const struct lw_controller *controller = &device->controller;
	struct lw_kept *kept = device->config->kept;
	const int32_t u = controller->motion.law.u;
	struct lw_kept now = {0};

	/* Until it is known how the restart ended, the launch goes on. */
	if (kept == NULL || controller->reacquire.wanted) {
		return;
	}
	now.launch = lw_controller_follows(controller) && !controller->speed.at_rest &&
		     !controller->motion.cam.on;
	if (now.launch && u == 0) {
		now.direction = kept->direction;
	} else if (now.launch) {
		now.direction = u > 0 ? 1 : -1;
	}
	if (now.launch != kept->launch || now.direction != kept->direction ||
	    (looks_at_memory && kept->seal != seal_of(kept))) {
		now.seal = seal_of(&now);
		*kept = now;
	}
}
