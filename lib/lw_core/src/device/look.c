/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What needs a look at the rope survives a power cut: losses of synchronization until an indexing,
 * rope laid while the carriage stood until somebody acknowledges it. So does the rope on the drum,
 * and where it goes on, written whenever the drum has come to rest.
 */
#include "device_internal.h"

#include "lw/bytes/numbers.h"
#include "lw/bytes/same.h"

/** Ten writes may come at once, and ten more that add a cause: to forget one is worse. */
#define WRITES_AT_ONCE        10u
#define WRITES_AT_ONCE_URGENT 20u

/** The LOS record that a cause stands for. */
static struct lw_los_record *los_of(struct lw_controller *controller, enum lw_look_cause cause)
{
	switch (cause) {
	case LW_LOOK_LOS1_PLUS:
		return &controller->los.los1[LW_PLUS];
	case LW_LOOK_LOS1_MINUS:
		return &controller->los.los1[LW_MINUS];
	case LW_LOOK_LOS2_PLUS:
		return &controller->los.los2[LW_PLUS];
	case LW_LOOK_LOS2_MINUS:
		return &controller->los.los2[LW_MINUS];
	case LW_LOOK_ENCODER:
		return &controller->los.encoder;
	case LW_LOOK_REACQUIRED:
		return &controller->los.reacquired;
	default:
		return NULL;
	}
}

/** Take one cause into a look, if it is set. */
static void add(struct lw_look *look, const struct lw_device *device, enum lw_look_cause cause,
		bool set, int32_t position_q16, uint32_t time_ms)
{
	if (set) {
		look->causes |= 1u << cause;
		look->marks[cause].position_um = lw_params_q16_to_um(&device->active, position_q16);
		look->marks[cause].time_ms = time_ms;
	}
}

/** The rope on the drum now. What is not told is zero. */
static void add_rope(struct lw_look *look, const struct lw_device *device)
{
	const struct lw_rope_length *rope = &device->controller.rope_length;
	const uint64_t turns_q16 = (uint64_t)lw_rope_length_since_q16(
		rope, lw_motion_read(&device->controller.motion).net_edges);

	if (rope->told) {
		look->rope_told = 1;
		look->rope_told_mm = rope->told_mm;
		look->rope_turns_high = (uint32_t)(turns_q16 >> 32);
		look->rope_turns_low = (uint32_t)turns_q16;
	}
}

/** Where the rope goes on. What is not known is zero. */
static void add_resume(struct lw_look *look, const struct lw_device *device)
{
	const struct lw_resume *resume = &device->controller.resume;

	if (resume->known) {
		look->resume_flags =
			LW_LOOK_RESUME_KNOWN | (resume->doubtful ? LW_LOOK_RESUME_DOUBTFUL : 0u);
		look->resume_pattern = resume->pattern;
		look->resume_m = resume->m;
		look->resume_u = resume->u;
		look->resume_dwell_edges = resume->dwell_edges;
		look->resume_cycle_plus = resume->cycle_plus;
		look->resume_cycle_minus = resume->cycle_minus;
		look->resume_stand_usteps = resume->stand_usteps;
	}
}

/** What needs a look now. */
static struct lw_look look_now(struct lw_device *device)
{
	const struct lw_rope_watch *rope = &device->controller.rope;
	struct lw_look look = {0};

	for (int cause = 0; cause < LW_LOOK_CAUSES; cause++) {
		const struct lw_los_record *los =
			los_of(&device->controller, (enum lw_look_cause)cause);

		if (los != NULL) {
			add(&look, device, (enum lw_look_cause)cause, los->set, los->position_q16,
			    los->time_ms);
		}
	}
	add(&look, device, LW_LOOK_ROPE_STANDING, rope->set, rope->position_q16, rope->time_ms);
	if (rope->set) {
		look.standing_millirev =
			lw_rope_watch_millirev(rope, device->derived.edges_per_1000_drum_revs);
		look.standing_place_known = rope->place_known;
	}
	add_rope(&look, device);
	add_resume(&look, device);
	return look;
}

void lw_device_keep_look(struct lw_device *device)
{
	struct lw_store *store = device->config->store;

	/* While the drum turns nothing is written, and the processor has better things to do. */
	if (store->writing || !device->controller.speed.at_rest) {
		return;
	}

	const struct lw_look look = look_now(device);
	const bool urgent = (look.causes & ~store->look.causes) != 0;

	store->look_wanted = false;
	if (!lw_same(&look, &store->look, sizeof(look)) &&
	    lw_budget_left(&device->look_budget, device->now_us,
			   urgent ? WRITES_AT_ONCE_URGENT : WRITES_AT_ONCE)) {
		lw_store_save_look(store, &look);
	}
}

/** A stored place, Q16.16 in the microsteps of the active set, which may be another than then. */
static int32_t position_q16(const struct lw_device *device, int32_t position_um)
{
	const int64_t lead_um = device->active.screw_lead_um;
	const int64_t q16_per_rev = (int64_t)device->active.microsteps_per_rev * LW_USTEP;

	return lw_clamp32(lw_divide_nearest(position_um * q16_per_rev, lead_um));
}

/** Where the rope goes on; not if the pattern is another one now. */
static void restore_resume(struct lw_controller *controller, const struct lw_look *look)
{
	if (!(look->resume_flags & LW_LOOK_RESUME_KNOWN) || !controller->params->resume ||
	    look->resume_pattern != lw_controller_pattern(controller)) {
		return;
	}
	controller->resume = (struct lw_resume){
		.known = true,
		.doubtful = (look->resume_flags & LW_LOOK_RESUME_DOUBTFUL) != 0,
		.m = look->resume_m,
		.u = look->resume_u,
		.dwell_edges = look->resume_dwell_edges,
		.cycle_plus = look->resume_cycle_plus,
		.cycle_minus = look->resume_cycle_minus,
		.pattern = look->resume_pattern,
		.stand_usteps = look->resume_stand_usteps,
	};
	/* It stands there now, and is counted from 0. */
	controller->moving.shift_usteps = -look->resume_stand_usteps;
}

void lw_device_restore_look(struct lw_device *device)
{
	struct lw_controller *controller = &device->controller;
	struct lw_rope_watch *rope = &controller->rope;
	const struct lw_look *look = &device->config->store->look;

	for (int cause = 0; cause < LW_LOOK_CAUSES; cause++) {
		struct lw_los_record *los = los_of(controller, (enum lw_look_cause)cause);

		if (los != NULL && look->causes >> cause & 1) {
			los->set = true;
			los->before_power_up = true;
			los->position_q16 = position_q16(device, look->marks[cause].position_um);
			los->time_ms = look->marks[cause].time_ms;
		}
	}
	if (look->causes >> LW_LOOK_ROPE_STANDING & 1) {
		const struct lw_look_mark *mark = &look->marks[LW_LOOK_ROPE_STANDING];

		rope->set = true;
		rope->before_power_up = true;
		rope->place_known = look->standing_place_known != 0;
		rope->position_q16 = position_q16(device, mark->position_um);
		rope->time_ms = mark->time_ms;
		rope->laid_millirev = look->standing_millirev;
	}
	if (look->rope_told != 0 && look->rope_told_mm >= 0) {
		lw_rope_length_restore(
			&controller->rope_length, look->rope_told_mm,
			(int64_t)((uint64_t)look->rope_turns_high << 32 | look->rope_turns_low));
	}
	restore_resume(controller, look);
}

uint16_t lw_device_look_before_power_up(struct lw_device *device)
{
	struct lw_controller *controller = &device->controller;
	unsigned int bits = (unsigned int)(controller->rope.set && controller->rope.before_power_up)
			    << LW_LOOK_ROPE_STANDING;

	for (int cause = 0; cause < LW_LOOK_CAUSES; cause++) {
		const struct lw_los_record *los = los_of(controller, (enum lw_look_cause)cause);

		bits |= (unsigned int)(los != NULL && los->set && los->before_power_up) << cause;
	}
	return (uint16_t)bits;
}
