/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A controller with its pins driven by hand: an ideal carriage that follows every step, change-over
 * limit switches, an encoder, 1 ms ticks. Exact and small; lib/lw_plant is the realistic one.
 */
#ifndef RIG_H
#define RIG_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include <unity.h>

#include "cases.h"
#include "lw/device/device.h"

/** What a limit switch of the rig does. */
enum rig_switch {
	RIG_SWITCH_WORKS,
	RIG_SWITCH_NEVER,   /**< stuck released */
	RIG_SWITCH_ALWAYS,  /**< stuck actuated */
	RIG_SWITCH_NO_OPEN, /**< broken NO wire */
	RIG_SWITCH_SHORTED, /**< both contacts seen closed */
};

/** Places are true carriage places in microsteps; the controller does not know them. */
struct rig {
	struct lw_params params;
	struct lw_derived derived;
	struct lw_controller own;
	struct lw_device device;
	struct lw_store store;                             /**< of the device */
	uint8_t slots[LW_STORE_SLOTS][LW_STORE_SLOT_SIZE]; /**< what its host keeps, written */
	struct lw_controller *controller;                  /**< `own`, or that of `device` */
	bool with_device;

	int32_t carriage_usteps;
	bool stalled; /**< the carriage does not follow its steps */
	int32_t switch_at_usteps[2];
	int32_t hysteresis_usteps;
	bool actuated[2];
	enum rig_switch switches[2];

	uint32_t quarter; /**< encoder transitions, modulo 4 in the pins */
	int32_t drum_edges_per_s;
	int64_t drum_rest;
	int64_t timer_rest;
	uint64_t now_us;
};

static struct rig rig;

static inline bool rig_contact_no(int side)
{
	switch (rig.switches[side]) {
	case RIG_SWITCH_NEVER:
	case RIG_SWITCH_NO_OPEN:
		return false;
	case RIG_SWITCH_ALWAYS:
	case RIG_SWITCH_SHORTED:
		return true;
	default:
		return rig.actuated[side];
	}
}

static inline bool rig_contact_nc(int side)
{
	switch (rig.switches[side]) {
	case RIG_SWITCH_NEVER:
	case RIG_SWITCH_SHORTED:
		return true;
	case RIG_SWITCH_ALWAYS:
		return false;
	default:
		return !rig.actuated[side];
	}
}

static inline void rig_move_switch(int side)
{
	const int direction = lw_side_direction(side);
	const int32_t beyond = direction * (rig.carriage_usteps - rig.switch_at_usteps[side]);

	if (beyond >= 0) {
		rig.actuated[side] = true;
	} else if (beyond < -rig.hysteresis_usteps) {
		rig.actuated[side] = false;
	}
}

/** Tell the controller the contacts of a switch. */
static inline void rig_tell_switch(int side)
{
	lw_controller_limit(rig.controller, side, rig_contact_no(side), rig_contact_nc(side),
			    rig.now_us);
}

static inline void rig_set_switch(int side, enum rig_switch what)
{
	rig.switches[side] = what;
	rig_tell_switch(side);
}

/** Move the carriage by hand, or by slip. */
static inline void rig_place(int32_t usteps)
{
	rig.carriage_usteps = usteps;
	FOR_EACH_SIDE(side) {
		const bool before = rig.actuated[side];

		rig_move_switch(side);
		if (rig.actuated[side] != before) {
			rig_tell_switch(side);
		}
	}
}

static inline void rig_step(int steps)
{
	const int most = rig.controller->motion.cam.on ? LW_CAM_STEPS_PER_EDGE_MAX : 1;

	TEST_ASSERT_TRUE(-most <= steps && steps <= most);
	steps = lw_controller_driver_step(rig.controller, steps);
	if (steps != 0 && !rig.stalled) {
		rig_place(rig.carriage_usteps + steps);
	}
}

/** One transition of the encoder, forward or backward. */
static inline void rig_transition(int dd)
{
	static const uint8_t forward[4] = {0, 2, 3, 1};

	rig.quarter += (uint32_t)dd;

	const uint8_t levels = forward[rig.quarter & 3];

	rig_step(lw_controller_encoder(rig.controller, levels & 2, levels & 1));
}

/** Turn the drum by used edges, within no time. */
static inline void rig_turn(int64_t edges)
{
	const int64_t end = lw_motion_read(&rig.controller->motion).net_edges + edges;

	while (lw_motion_read(&rig.controller->motion).net_edges != end) {
		rig_transition(edges > 0 ? 1 : -1);
	}
}

/** One millisecond: edges of timer and drum, then the tick. */
static inline void rig_tick(void)
{
	rig.timer_rest += lw_controller_timer_rate_edges_per_s(rig.controller);
	for (; rig.timer_rest >= 1000; rig.timer_rest -= 1000) {
		rig_step(lw_controller_timer_edge(rig.controller));
	}
	rig.drum_rest += rig.drum_edges_per_s;
	rig_turn(rig.drum_rest / 1000);
	rig.drum_rest %= 1000;
	rig.now_us += LW_CONTROLLER_TICK_US;
	if (rig.with_device) {
		lw_device_tick(&rig.device, rig.now_us);
	} else {
		lw_controller_tick(rig.controller, rig.now_us);
	}
	switch (rig.controller->state) {
	case LW_STATE_READY:
	case LW_STATE_CENTRED:
	case LW_STATE_TRACKING:
		TEST_ASSERT_TRUE_MESSAGE(rig.controller->indexed, "a state that needs an index");
		break;
	default:
		break;
	}
}

static inline void rig_ticks(int count)
{
	while (count-- > 0) {
		rig_tick();
	}
}

/** Turn the drum by used edges at 40,000 edges/s, with ticks. */
static inline void rig_drive(int64_t edges)
{
	while (edges != 0) {
		const int64_t now = edges > 40 ? 40 : edges < -40 ? -40 : edges;

		rig_turn(now);
		rig_tick();
		edges -= now;
	}
}

/** Until a state is reached, not longer than a minute. */
static inline void rig_run_to(enum lw_state state)
{
	for (int i = 0; i < 60000 && rig.controller->state != state; i++) {
		rig_tick();
	}
	TEST_ASSERT_EQUAL_INT(state, rig.controller->state);
}

static inline void rig_run_to_fault(enum lw_fault fault)
{
	rig_run_to(LW_STATE_FAULT);
	TEST_ASSERT_EQUAL_INT(fault, rig.controller->fault);
	TEST_ASSERT_FALSE(rig.controller->indexed);
	TEST_ASSERT_EQUAL_UINT8(LW_EDGE_SOURCE_NONE, rig.controller->motion.source);
}

/** The true place less what the controller believes. */
static inline int32_t rig_error_usteps(void)
{
	return rig.carriage_usteps - lw_law_pos_usteps(lw_motion_m(&rig.controller->motion));
}

/** Pins now, with nothing pressed but what the place of the carriage says. */
static inline struct lw_inputs rig_inputs(void)
{
	struct lw_inputs inputs = {0};

	FOR_EACH_SIDE(side) {
		rig_move_switch(side);
		inputs.limit[side].no_closed = rig_contact_no(side);
		inputs.limit[side].nc_closed = rig_contact_nc(side);
	}
	return inputs;
}

/** A carriage at a place, its switches where the default parameters say. */
static inline void rig_prepare(int32_t carriage_usteps)
{
	rig = (struct rig){
		.params = lw_params_default,
		.carriage_usteps = carriage_usteps,
		.switch_at_usteps = {7840, -7840},
		.hysteresis_usteps = 50,
		.now_us = 5000000,
	};
	memset(rig.slots, 0xFF, sizeof(rig.slots)); /* erased */
	lw_store_init(&rig.store);
}

/** Power up a controller with rig.params; wait until the drum counts as resting. */
static inline void rig_power_up(void)
{
	const struct lw_inputs inputs = rig_inputs();
	struct lw_refusal why;

	TEST_ASSERT_EQUAL_INT(0, lw_params_derive(&rig.params, &rig.derived, &why));
	rig.controller = &rig.own;
	lw_controller_init(rig.controller, &rig.params, &rig.derived, &inputs, rig.now_us);
	rig_ticks(300);
}

static inline void rig_index(void)
{
	struct lw_refusal why;

	TEST_ASSERT_EQUAL_INT(0, lw_controller_allow_index(rig.controller, &why));
	lw_controller_index(rig.controller);
}

/** Power up in the middle, index, follow the drum. */
static inline void rig_track(void)
{
	rig_power_up();
	rig_index();
	rig_run_to(LW_STATE_TRACKING);
}

/** Turn the drum in 1 ms pieces until the carriage passes a place in a direction. */
static inline void rig_follow_to(int32_t usteps, int carriage_direction, int drum_edges_per_s)
{
	rig.drum_edges_per_s = drum_edges_per_s;
	for (int i = 0; i < 100000; i++) {
		const bool before = carriage_direction * (rig.carriage_usteps - usteps) < 0;

		rig_tick();
		if (before && carriage_direction * (rig.carriage_usteps - usteps) >= 0) {
			return;
		}
	}
	TEST_FAIL_MESSAGE("the carriage never came there");
}

/** Do the write to the storage that is due; without an error it is kept in rig.slots.
 *  @return its slot, or -1 if there is none */
static inline int rig_write_slot(int result)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;
	const size_t length = lw_device_begin_write(&rig.device, &slot, bytes);

	if (length == 0) {
		return -1;
	}
	if (result == 0) {
		memcpy(rig.slots[slot], bytes, length);
	}
	lw_device_end_write(&rig.device, result);
	return (int)slot;
}

/** Let the drum come to rest, and be seen so. */
static inline void rig_rest(void)
{
	rig.drum_edges_per_s = 0;
	rig_ticks(300);
	TEST_ASSERT_TRUE(rig.controller->speed.at_rest);
}

#endif /* RIG_H */
