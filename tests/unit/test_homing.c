/* SPDX-License-Identifier: Apache-2.0 */
/* Every motion by simulated edges: indexing, backing off, parking, centring, jogging, halting. */
#include <unity.h>

#include "cases.h"
#include "rig.h"

void setUp(void)
{
	rig_prepare(0);
}

void tearDown(void)
{
	cases_end();
}

/** While the drum turns there is no hand-over: the carriage stays parked. */
static void run_to_ready(void)
{
	rig.drum_edges_per_s = 1000;
	rig_run_to(LW_STATE_READY);
}

/** Index from a place; the carriage is known to a microstep afterwards. */
static void check_index(int32_t from_usteps, enum lw_side index_switch, enum lw_park_at park_at)
{
	rig_prepare(from_usteps);
	rig.params.index_switch = (int32_t)index_switch;
	rig.params.park_at = (int32_t)park_at;
	rig.params.park_position_um = 12340;
	rig_power_up();
	rig_index();
	run_to_ready();
	TEST_ASSERT_TRUE(rig.controller->indexed);
	TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
	TEST_ASSERT_EQUAL_INT32(0, rig.controller->motion.law.u);
	TEST_ASSERT_INT32_WITHIN(1, 0, rig.controller->homing.span_error_usteps);
	if (park_at == LW_PARK_AT_POSITION) {
		TEST_ASSERT_INT32_WITHIN(1, 1234, rig.carriage_usteps);
	} else {
		TEST_ASSERT_INT32_WITHIN(2, (index_switch == LW_SIDE_PLUS ? -1 : 1) * (8000 + 247),
					 rig.carriage_usteps);
	}
}

static void test_index_from_anywhere_on_either_switch_to_either_place(void)
{
	/* The middle; before, on and beyond each switch; just released. */
	static const int32_t places[] = {0,    5000, 7830,  7839,  7840,  7841,  8240,
					 7795, 7700, -5000, -7839, -7840, -8240, -7795};

	for (size_t place = 0; place < sizeof(places) / sizeof(places[0]); place++) {
		FOR_EACH_SIDE(side) {
			for (int park = 0; park < 2; park++) {
				check_index(places[place], (enum lw_side)side,
					    (enum lw_park_at)park);
			}
		}
	}
}

static void test_a_trigger_on_the_last_microstep_of_the_ramp(void)
{
	/* Ka 100, Nr 37: the ramp is little more than one microstep; its only step triggers. */
	FOR_EACH_SIDE(side) {
		const int direction = lw_side_direction(side);

		rig_prepare(direction * 7839);
		rig.params.expert_mode = 1;
		rig.params.raw_ka = 100;
		rig.params.raw_nr = 37;
		rig.params.index_switch = side;
		rig.params.index_rate_edges_per_s = 1000;
		rig_power_up();
		rig_index();
		while (rig.carriage_usteps == direction * 7839) {
			rig_tick();
		}
		rig_ticks(30);
		rig.params.index_rate_edges_per_s = 50000;
		rig_run_to(LW_STATE_SPAN_CHECK);
		TEST_ASSERT_EQUAL_INT32(-direction * rig.derived.ks, rig.controller->motion.law.u);
	}
}

static void test_a_trigger_on_the_first_microstep_after_the_ramp(void)
{
	FOR_EACH_SIDE(side) {
		const int direction = lw_side_direction(side);

		rig_prepare(direction * 7838);
		rig.params.expert_mode = 1;
		rig.params.raw_ka = 100;
		rig.params.raw_nr = 37;
		rig.params.index_switch = side;
		rig_power_up();
		rig_index();
		while (rig.controller->state == LW_STATE_SEEKING) {
			TEST_ASSERT_EQUAL_INT(LW_HOMING_SEEKING, rig.controller->homing.phase);
			rig_tick();
		}
		TEST_ASSERT_EQUAL_INT(LW_STATE_INDEX_REVERSAL, rig.controller->state);
	}
}

static void test_states_of_an_index_in_order(void)
{
	static const enum lw_state states[] = {LW_STATE_BACKING_OFF,    LW_STATE_SEEKING,
					       LW_STATE_INDEX_REVERSAL, LW_STATE_SPAN_CHECK,
					       LW_STATE_PARKING,        LW_STATE_READY,
					       LW_STATE_TRACKING};

	rig_prepare(7900);
	rig_power_up();
	rig_index();
	for (size_t i = 0; i < sizeof(states) / sizeof(states[0]); i++) {
		rig.drum_edges_per_s = states[i] == LW_STATE_TRACKING ? 0 : 1000;
		rig_run_to(states[i]);
		TEST_ASSERT_EQUAL(i < 5, lw_controller_moving(rig.controller));
		TEST_ASSERT_EQUAL_UINT32(i < 5 ? 10000u : 0u,
					 lw_controller_timer_rate_edges_per_s(rig.controller));
	}
}

static void test_index_clears_los_flags_and_the_fault(void)
{
	rig_power_up();
	rig.controller->los.los1[LW_MINUS].set = true;
	rig.controller->los.los2[LW_PLUS].set = true;
	rig.controller->fault = LW_FAULT_INDEX_SPAN;
	rig_index();
	TEST_ASSERT_EQUAL_INT(LW_FAULT_NONE, rig.controller->fault);
	rig_run_to(LW_STATE_PARKING);
	TEST_ASSERT_TRUE(rig.controller->los.los1[LW_MINUS].set);
	run_to_ready();
	TEST_ASSERT_FALSE(rig.controller->los.los1[LW_MINUS].set);
	TEST_ASSERT_FALSE(rig.controller->los.los2[LW_PLUS].set);
}

/** Nobody would see the switch: a supervisor that has died must not let the carriage run on. */
static void test_without_ticks_the_edge_timer_moves_nothing_after_50_ms(void)
{
	rig_power_up();
	rig_index();
	rig_run_to(LW_STATE_SEEKING);
	rig_ticks(200);

	const int32_t from_usteps = rig.carriage_usteps;
	const uint32_t alone = lw_controller_timer_rate_edges_per_s(rig.controller) / 20 + 1;

	for (uint32_t edge = 0; edge < 10 * alone; edge++) {
		rig_step(lw_controller_timer_edge(rig.controller));
		if (edge + 1 == alone) {
			TEST_ASSERT_GREATER_THAN_INT32(from_usteps, rig.carriage_usteps);
			rig.carriage_usteps = from_usteps;
		}
	}
	TEST_ASSERT_EQUAL_INT32(from_usteps, rig.carriage_usteps);
	rig_ticks(10);
	TEST_ASSERT_GREATER_THAN_INT32(from_usteps, rig.carriage_usteps);
}

static void test_no_switch_within_the_travel(void)
{
	rig.switches[LW_PLUS] = RIG_SWITCH_NEVER;
	rig.params.index_rate_edges_per_s = 2000; /* less than a microstep in a tick */
	rig_power_up();
	rig_index();
	rig_run_to_fault(LW_FAULT_INDEX_NO_SWITCH);
	/* Not farther than the mechanism can be long, and the ramp. */
	TEST_ASSERT_INT32_WITHIN(300, 18000 + 250, rig.carriage_usteps);
	TEST_ASSERT_EQUAL_INT32(18000 + rig.derived.overshoot_q16 / LW_USTEP + 2 + 1,
				lw_law_pos_usteps(lw_motion_m(&rig.controller->motion)));
}

static void test_no_switch_because_nothing_moves(void)
{
	rig_prepare(0);
	rig.params.index_switch = LW_SIDE_MINUS;
	rig_power_up();
	rig.stalled = true;
	rig_index();
	rig_run_to_fault(LW_FAULT_INDEX_NO_SWITCH);
}

static void test_wrong_switch_first(void)
{
	rig_power_up();
	rig_index();
	rig_run_to(LW_STATE_SEEKING);
	rig_ticks(500);
	rig_set_switch(LW_MINUS, RIG_SWITCH_ALWAYS);
	rig_run_to_fault(LW_FAULT_INDEX_WRONG_SWITCH);
}

static void test_wrong_switch_while_backing_off(void)
{
	rig_prepare(7900);
	rig_power_up();
	rig_index();
	rig_ticks(30);
	rig_set_switch(LW_PLUS, RIG_SWITCH_NEVER);
	rig_set_switch(LW_MINUS, RIG_SWITCH_ALWAYS);
	while (rig.controller->state == LW_STATE_BACKING_OFF) {
		rig_tick();
	}
	TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state); /* at once */
	rig_run_to_fault(LW_FAULT_INDEX_WRONG_SWITCH);
}

static void test_both_switches_active(void)
{
	rig.switches[LW_PLUS] = RIG_SWITCH_ALWAYS;
	rig.switches[LW_MINUS] = RIG_SWITCH_ALWAYS;
	rig_power_up();
	rig_index();
	TEST_ASSERT_EQUAL_INT(LW_FAULT_BOTH_SWITCHES_ACTIVE, rig.controller->fault);
	TEST_ASSERT_EQUAL_UINT32(0, rig.controller->motion.steps);

	rig_prepare(7900);
	rig_power_up();
	rig_index();
	rig_ticks(30);
	rig_set_switch(LW_MINUS, RIG_SWITCH_ALWAYS);
	rig_run_to_fault(LW_FAULT_BOTH_SWITCHES_ACTIVE);
}

static void test_wiring_at_the_start(void)
{
	FOR_EACH_SIDE(side) {
		rig_prepare(0);
		rig.switches[side] = RIG_SWITCH_SHORTED;
		rig_power_up();
		rig_index();
		TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
		TEST_ASSERT_EQUAL_INT(side == LW_PLUS ? LW_FAULT_WIRING_PLUS
						      : LW_FAULT_WIRING_MINUS,
				      rig.controller->fault);
		TEST_ASSERT_EQUAL_UINT32(0, rig.controller->motion.steps);
	}
}

static void test_wiring_while_indexing(void)
{
	/* The NO wire is broken: it shows only when the carriage has come to the switch. */
	FOR_EACH_SIDE(side) {
		rig_prepare(0);
		rig.switches[side] = RIG_SWITCH_NO_OPEN;
		rig_power_up();
		rig_index();
		rig_run_to_fault(side == LW_PLUS ? LW_FAULT_WIRING_PLUS : LW_FAULT_WIRING_MINUS);
		TEST_ASSERT_TRUE(lw_side_direction(side) * rig.carriage_usteps < 8250);
	}
}

static void test_the_switch_does_not_release(void)
{
	rig_prepare(7000);
	rig.switches[LW_PLUS] = RIG_SWITCH_ALWAYS;
	rig.params.index_rate_edges_per_s = 2000; /* less than a microstep in a tick */
	rig_power_up();
	rig_index();
	TEST_ASSERT_EQUAL_INT(LW_STATE_BACKING_OFF, rig.controller->state);
	rig_run_to_fault(LW_FAULT_BACK_OFF_NO_RELEASE);
	TEST_ASSERT_EQUAL_INT32(7000 - 9001, rig.carriage_usteps);
}

/** The other switch is found `shift` microsteps from where it was calibrated. */
static void check_span(enum lw_side index_switch, int32_t shift)
{
	const int other = index_switch == LW_SIDE_PLUS ? LW_MINUS : LW_PLUS;

	rig_prepare(0);
	rig.params.index_switch = (int32_t)index_switch;
	rig.params.span_tolerance_um = 1000;
	rig.switch_at_usteps[other] += shift;
	rig_power_up();
	rig_index();
	if (shift < -100 || shift > 100) {
		rig_run_to_fault(LW_FAULT_INDEX_SPAN);
	} else {
		run_to_ready();
		TEST_ASSERT_INT32_WITHIN(1, shift, rig.controller->homing.span_error_usteps);
	}
}

static void test_span_of_the_switches(void)
{
	static const int32_t shifts[] = {0, 99, -99, 103, -103, 200, -200};

	FOR_EACH_SIDE(side) {
		for (size_t i = 0; i < sizeof(shifts) / sizeof(shifts[0]); i++) {
			check_span((enum lw_side)side, shifts[i]);
		}
		rig_prepare(0);
		rig.params.index_switch = side;
		rig.switches[!side] = RIG_SWITCH_NEVER;
		rig_power_up();
		rig_index();
		rig_run_to_fault(LW_FAULT_INDEX_SPAN);
		/* As far as it looked: the tolerance, and what a tick adds. */
		TEST_ASSERT_INT32_WITHIN(3, -lw_side_direction(side) * 103,
					 rig.controller->homing.span_error_usteps);
	}
}

static void test_span_trigger_just_beyond_the_tolerance_in_one_tick(void)
{
	/* Early: triggered, and judged by its place. */
	rig.switch_at_usteps[LW_MINUS] = -7840 + 150;
	rig_power_up();
	rig_index();
	rig_run_to_fault(LW_FAULT_INDEX_SPAN);
	TEST_ASSERT_INT32_WITHIN(1, 150, rig.controller->homing.span_error_usteps);
}

static void test_late_switches_are_where_they_were_reached(void)
{
	/* 6 ms at 10,000 edges/s are 25 microsteps. The other one tells past its tolerance. */
	FOR_EACH_SIDE(side) {
		const int direction = lw_side_direction(side);

		for (int off_usteps = 0; off_usteps <= 90; off_usteps += 90) {
			rig_prepare(0);
			rig.params.index_switch = side;
			rig.params.switch_delay_us = 6000;
			rig.switch_at_usteps[side] += direction * 25;
			rig.switch_at_usteps[!side] -= direction * (25 + off_usteps);
			rig_power_up();
			rig_index();
			run_to_ready();
			TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
			TEST_ASSERT_INT32_WITHIN(1, -direction * off_usteps,
						 rig.controller->homing.span_error_usteps);
		}
	}
}

static void test_back_off_from_an_overtravel_switch(void)
{
	FOR_EACH_SIDE(side) {
		const int outward = lw_side_direction(side);

		rig_prepare(outward * 8240);
		/* The limit switch is broken: the overtravel switch alone says where it is. */
		rig.switches[side] = RIG_SWITCH_NEVER;
		rig_power_up();
		lw_controller_overtravel(rig.controller, side, true);
		rig_ticks(2);
		TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
		rig_index();
		TEST_ASSERT_EQUAL_INT(LW_STATE_BACKING_OFF, rig.controller->state);
		TEST_ASSERT_TRUE(lw_controller_stepper_enabled(rig.controller));
		while (outward * rig.carriage_usteps > 8200) {
			rig_tick();
		}
		lw_controller_overtravel(rig.controller, side, false);
		rig_set_switch(side, RIG_SWITCH_WORKS);
		run_to_ready();
	}
}

static void test_backing_off_leaves_room_for_the_ramp_and_no_more(void)
{
	rig_prepare(7900);
	rig_power_up();
	rig_index();
	while (rig.controller->limit[LW_PLUS].active) {
		rig_tick();
	}

	const int32_t released_usteps = rig.carriage_usteps;

	while (rig.controller->state == LW_STATE_BACKING_OFF) {
		rig_tick();
	}
	/* The hysteresis, and two ramps of 247 microsteps. */
	TEST_ASSERT_INT32_WITHIN(6, 150 + 2 * 249, released_usteps - rig.carriage_usteps);
}

static void test_both_overtravel_switches_are_no_place_to_start(void)
{
	rig_power_up();
	lw_controller_overtravel(rig.controller, LW_PLUS, true);
	lw_controller_overtravel(rig.controller, LW_MINUS, true);
	rig_index();
	TEST_ASSERT_EQUAL_INT(LW_FAULT_BOTH_SWITCHES_ACTIVE, rig.controller->fault);
}

/** A broken wire of an overtravel switch, the carriage on the other limit switch. */
static void test_the_overtravel_switch_is_named_when_the_carriage_is_at_the_other_end(void)
{
	FOR_EACH_SIDE(side) {
		rig_prepare(-lw_side_direction(side) * 7900);
		rig_power_up();
		lw_controller_overtravel(rig.controller, side, true);
		rig_index();
		TEST_ASSERT_EQUAL_INT(side == LW_PLUS ? LW_FAULT_OVERTRAVEL_PLUS
						      : LW_FAULT_OVERTRAVEL_MINUS,
				      rig.controller->fault);

		/* It comes there while it backs off, or not so far. */
		for (int near = 0; near < 2; near++) {
			rig_prepare(near ? 0 : -lw_side_direction(side) * 6000);
			rig_power_up();
			lw_controller_overtravel(rig.controller, side, true);
			rig_index();
			rig_run_to_fault(side == LW_PLUS ? LW_FAULT_OVERTRAVEL_PLUS
							 : LW_FAULT_OVERTRAVEL_MINUS);
		}
	}
}

static void test_stop_in_every_state_of_an_index(void)
{
	for (int state = LW_STATE_BACKING_OFF; state <= LW_STATE_PARKING; state++) {
		rig_prepare(7900);
		rig_power_up();
		rig_index();
		rig_run_to((enum lw_state)state);
		rig_ticks(100);
		lw_controller_stop(rig.controller);
		rig_run_to(LW_STATE_UNINDEXED);
		TEST_ASSERT_FALSE(rig.controller->indexed);
		TEST_ASSERT_EQUAL_INT32(0, rig.controller->motion.law.u);

		const uint32_t steps = rig.controller->motion.steps;

		rig_ticks(1000);
		TEST_ASSERT_EQUAL_UINT32(steps, rig.controller->motion.steps);
		/* And again from here. */
		rig_index();
		run_to_ready();
		rig_rest();
	}
}

static void test_stop_at_any_moment_of_an_index_comes_to_rest(void)
{
	rig_prepare(7900);
	rig_power_up();
	for (int ticks = 0; ticks < 7000; ticks += 61) {
		rig_index();
		for (int i = 0; i < ticks && rig.controller->state != LW_STATE_READY; i++) {
			rig_tick();
		}
		lw_controller_stop(rig.controller);
		rig_ticks(400);
		TEST_ASSERT_FALSE(lw_controller_moving(rig.controller));
		TEST_ASSERT_EQUAL_UINT8(LW_EDGE_SOURCE_NONE, rig.controller->motion.source);
		rig_place(7900);
		rig_ticks(30);
	}
}

/* A switch that triggers while the ramp down of a STOP runs must not complete the index. */
static void test_stop_just_before_the_far_switch_leaves_no_index(void)
{
	for (int32_t usteps = -7400; usteps > -7840; usteps -= 10) {
		rig_prepare(0);
		rig_power_up();
		rig_index();
		rig_run_to(LW_STATE_SPAN_CHECK);
		while (rig.carriage_usteps > usteps) {
			rig_tick();
		}
		lw_controller_stop(rig.controller);
		rig_ticks(400);
		TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
		lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
		rig_ticks(400);
		TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	}
}

static void test_stop_in_a_dwell_stops_at_once(void)
{
	rig.params.dwell_plus_millirev = 10000;
	rig_power_up();
	rig_index();
	rig_run_to(LW_STATE_INDEX_REVERSAL);
	while (rig.controller->motion.law.dwell_edges < 100) {
		rig_tick();
	}

	const int32_t place = rig.carriage_usteps;

	lw_controller_stop(rig.controller);
	rig_ticks(3);
	TEST_ASSERT_EQUAL_INT(LW_STATE_UNINDEXED, rig.controller->state);
	TEST_ASSERT_EQUAL_INT32(place, rig.carriage_usteps);
}

static void test_index_with_a_single_contact(void)
{
	for (int contacts = LW_SWITCH_CONTACTS_SINGLE_NO; contacts <= LW_SWITCH_CONTACTS_SINGLE_NC;
	     contacts++) {
		rig_prepare(0);
		rig.params.switch_contacts = contacts;
		rig_power_up();
		rig_index();
		run_to_ready();
		TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
	}
}

static void test_index_with_a_dwell_parks_at_the_flange_before_it(void)
{
	rig.params.dwell_minus_millirev = 1000;
	rig_power_up();
	rig_index();
	run_to_ready();
	TEST_ASSERT_EQUAL_UINT32(0, rig.controller->motion.law.dwell_edges);

	const int32_t m = lw_motion_m(&rig.controller->motion);

	rig_rest();
	TEST_ASSERT_EQUAL_INT(LW_STATE_TRACKING, rig.controller->state);
	rig_turn(2880);
	TEST_ASSERT_EQUAL_INT32(m, lw_motion_m(&rig.controller->motion));
	rig_turn(1);
	TEST_ASSERT_EQUAL_INT32(m + 23, lw_motion_m(&rig.controller->motion));
}

/** The carriage on both switches, of which one is stuck: no overtravel switch stands alone. */
static void test_an_overtravel_switch_beside_its_limit_switch_is_not_named(void)
{
	FOR_EACH_SIDE(side) {
		rig_prepare(lw_side_direction(side) * 8240);
		rig.switches[!side] = RIG_SWITCH_ALWAYS;
		rig_power_up();
		lw_controller_overtravel(rig.controller, side, true);
		rig_index();
		TEST_ASSERT_EQUAL_INT(LW_FAULT_BOTH_SWITCHES_ACTIVE, rig.controller->fault);
	}
}

static void test_a_far_switch_that_is_still_bouncing_at_its_tolerance_is_waited_for(void)
{
	/* 5 ms of debouncing are 21 microsteps, and the tolerance is 100. */
	FOR_EACH_SIDE(side) {
		const int direction = lw_side_direction(side);

		rig_prepare(0);
		rig.params.index_switch = side;
		rig.params.switch_contacts = LW_SWITCH_CONTACTS_SINGLE_NO;
		rig.switch_at_usteps[!side] -= direction * 95;
		rig_power_up();
		rig_index();
		run_to_ready();
		TEST_ASSERT_INT32_WITHIN(1, -direction * 95,
					 rig.controller->homing.span_error_usteps);
	}
}

/** Between two edges the place that a switch has told is not taken yet. */
static void test_an_index_whose_edges_are_slower_than_ticks(void)
{
	rig_prepare(7000);
	rig_power_up();
	rig_index();
	rig_run_to(LW_STATE_SEEKING);
	rig_follow_to(7800, 1, 1000);
	rig.params.index_rate_edges_per_s = 300;
	rig_run_to(LW_STATE_INDEX_REVERSAL);
	rig_ticks(2000);
	TEST_ASSERT_EQUAL_INT(LW_STATE_INDEX_REVERSAL, rig.controller->state);
	rig.params.index_rate_edges_per_s = 10000;
	run_to_ready();
	TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
}

static void test_a_span_at_its_tolerance_is_within_it(void)
{
	FOR_EACH_SIDE(side) {
		for (int way = -1; way <= 1; way += 2) {
			bool met = false;

			for (int32_t shift = 98; shift <= 102; shift++) {
				int32_t error;

				rig_prepare(0);
				rig.params.index_switch = side;
				rig.switch_at_usteps[!side] += way * shift;
				rig_power_up();
				rig_index();
				rig.drum_edges_per_s = 1000;
				rig_run_to(LW_STATE_SPAN_CHECK);
				while (rig.controller->state == LW_STATE_SPAN_CHECK) {
					rig_tick();
				}
				error = way * rig.controller->homing.span_error_usteps;
				met |= error == 100;
				TEST_ASSERT_EQUAL_INT(error <= 100 ? LW_STATE_PARKING
								   : LW_STATE_FAULT,
						      rig.controller->state);
			}
			TEST_ASSERT_TRUE(met);
		}
	}
}

static void test_parking_at_a_position_rests_in_no_reversal_on_the_way(void)
{
	FOR_EACH_SIDE(side) {
		rig_prepare(0);
		rig.params.index_switch = side;
		rig.params.park_at = LW_PARK_AT_POSITION;
		rig.params.dwell_plus_millirev = 3000;
		rig.params.dwell_minus_millirev = 3000;
		rig.params.breaker_millirev = 1000;
		rig.params.breaker_cycles = 4;
		rig_power_up();
		rig_index();
		rig_run_to(LW_STATE_PARKING);
		rig.drum_edges_per_s = 1000;
		while (rig.controller->state == LW_STATE_PARKING) {
			const struct lw_law *law = &rig.controller->motion.law;

			rig_tick();
			TEST_ASSERT_TRUE(law->dwell_edges == 0);
		}
		TEST_ASSERT_EQUAL_UINT32(0, rig.controller->motion.law.dwells);
		TEST_ASSERT_EQUAL_UINT32(0, rig.controller->motion.law.breaker_cycles);
	}
}

static void test_an_index_begins_the_ribbon_breaker_anew(void)
{
	rig.params.breaker_millirev = 1000;
	rig.params.breaker_cycles = 5;
	rig_track();
	rig_drive(100000);
	TEST_ASSERT_TRUE(rig.controller->motion.law.cycle_plus > 0 &&
			 rig.controller->motion.law.cycle_minus > 0);
	rig_rest();
	rig_index();
	run_to_ready();
	TEST_ASSERT_EQUAL_UINT32(0, rig.controller->motion.law.cycle_plus);
	TEST_ASSERT_EQUAL_UINT32(0, rig.controller->motion.law.cycle_minus);
}

/** With a wide tolerance the far reversal turns the carriage round before it is too far. */
static void test_no_far_switch_on_the_way_to_the_reversal_and_back(void)
{
	FOR_EACH_SIDE(side) {
		rig_prepare(0);
		rig.params.index_switch = side;
		rig.params.span_tolerance_um = 5000;
		rig.switches[!side] = RIG_SWITCH_NEVER;
		rig_power_up();
		rig_index();
		rig_run_to_fault(LW_FAULT_INDEX_SPAN);
		TEST_ASSERT_INT32_WITHIN(2, -lw_side_direction(side) * (8000 + 247),
					 rig.carriage_usteps);
	}
}

/** What the index has asked of the next edge must not come after the ramp down has begun. */
static void test_stop_before_the_edge_that_a_phase_waits_for(void)
{
	static const enum lw_motion_request requests[] = {
		LW_MOTION_REQUEST_SWAP, LW_MOTION_REQUEST_REBASE, LW_MOTION_REQUEST_WINDOW};

	for (size_t i = 0; i < sizeof(requests) / sizeof(requests[0]); i++) {
		int32_t stopped_usteps;

		rig_prepare(7900);
		rig.params.park_at = LW_PARK_AT_POSITION;
		rig_power_up();
		rig_index();
		while (rig.controller->motion.requests != requests[i]) {
			rig_tick();
		}
		rig.params.index_rate_edges_per_s = 0;
		lw_controller_stop(rig.controller);
		rig_tick();
		TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
		stopped_usteps = rig.carriage_usteps;
		rig.params.index_rate_edges_per_s = 10000;
		rig_run_to(LW_STATE_UNINDEXED);
		TEST_ASSERT_INT32_WITHIN(250, stopped_usteps, rig.carriage_usteps);
	}
}

static void test_a_jog_that_was_let_go_is_over(void)
{
	rig_power_up();
	lw_controller_jog(rig.controller, 1, rig.now_us);
	rig_ticks(100);
	lw_controller_jog(rig.controller, 0, rig.now_us);
	rig_tick();
	TEST_ASSERT_TRUE(rig.controller->moving.halting);
	rig_run_to(LW_STATE_UNINDEXED);
	TEST_ASSERT_FALSE(rig.controller->moving.halting || rig.controller->moving.halt_sent);
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.stop_at_rest);
}

/** Nothing but a fault of the computer can bring it about. */
static void test_a_rest_that_no_phase_has_asked_for_ends_the_index(void)
{
	static const struct {
		enum lw_state state;
		enum lw_fault fault;
	} cases[] = {{LW_STATE_BACKING_OFF, LW_FAULT_BACK_OFF_NO_RELEASE},
		     {LW_STATE_SEEKING, LW_FAULT_INDEX_NO_SWITCH},
		     {LW_STATE_INDEX_REVERSAL, LW_FAULT_INDEX_NO_SWITCH},
		     {LW_STATE_SPAN_CHECK, LW_FAULT_INDEX_NO_SWITCH}};

	for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
		rig_prepare(7900);
		rig_power_up();
		rig_index();
		rig_run_to(cases[i].state);
		lw_motion_set_source(&rig.controller->motion, LW_EDGE_SOURCE_NONE);
		rig_tick();
		TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
		TEST_ASSERT_EQUAL_INT(cases[i].fault, rig.controller->fault);
	}
}

/** Ticks from now to the end of a state. */
static int ticks_left(enum lw_state state)
{
	const struct rig now = rig;
	int ticks = 0;

	while (rig.controller->state == state) {
		rig_tick();
		ticks++;
	}
	rig = now;
	return ticks;
}

static void test_a_wire_that_breaks_in_the_tick_of_a_trigger_is_the_fault(void)
{
	rig_power_up();
	rig_index();
	rig_ticks(ticks_left(LW_STATE_SEEKING) - 1);
	rig.controller->wiring[LW_MINUS] = true;
	rig_tick();
	TEST_ASSERT_EQUAL_INT(LW_STATE_FAULT, rig.controller->state);
	rig_run_to_fault(LW_FAULT_WIRING_MINUS);
}

static void test_an_index_that_is_complete_leaves_nothing_to_be_done(void)
{
	rig.drum_edges_per_s = 0;
	rig_power_up();
	rig_index();
	rig_run_to(LW_STATE_PARKING);
	rig.drum_edges_per_s = 1000;
	rig_ticks(ticks_left(LW_STATE_PARKING) - 1);
	rig.controller->wiring[LW_MINUS] = true; /* which inhibits the launch */
	rig_tick();
	TEST_ASSERT_EQUAL_INT(LW_STATE_READY, rig.controller->state);
	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.stop_at_rest);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_index_from_anywhere_on_either_switch_to_either_place);
	RUN_TEST(test_a_trigger_on_the_last_microstep_of_the_ramp);
	RUN_TEST(test_a_trigger_on_the_first_microstep_after_the_ramp);
	RUN_TEST(test_states_of_an_index_in_order);
	RUN_TEST(test_index_clears_los_flags_and_the_fault);
	RUN_TEST(test_without_ticks_the_edge_timer_moves_nothing_after_50_ms);
	RUN_TEST(test_no_switch_within_the_travel);
	RUN_TEST(test_no_switch_because_nothing_moves);
	RUN_TEST(test_wrong_switch_first);
	RUN_TEST(test_wrong_switch_while_backing_off);
	RUN_TEST(test_both_switches_active);
	RUN_TEST(test_wiring_at_the_start);
	RUN_TEST(test_wiring_while_indexing);
	RUN_TEST(test_the_switch_does_not_release);
	RUN_TEST(test_span_of_the_switches);
	RUN_TEST(test_span_trigger_just_beyond_the_tolerance_in_one_tick);
	RUN_TEST(test_late_switches_are_where_they_were_reached);
	RUN_TEST(test_back_off_from_an_overtravel_switch);
	RUN_TEST(test_backing_off_leaves_room_for_the_ramp_and_no_more);
	RUN_TEST(test_both_overtravel_switches_are_no_place_to_start);
	RUN_TEST(test_the_overtravel_switch_is_named_when_the_carriage_is_at_the_other_end);
	RUN_TEST(test_stop_in_every_state_of_an_index);
	RUN_TEST(test_stop_at_any_moment_of_an_index_comes_to_rest);
	RUN_TEST(test_stop_just_before_the_far_switch_leaves_no_index);
	RUN_TEST(test_stop_in_a_dwell_stops_at_once);
	RUN_TEST(test_index_with_a_single_contact);
	RUN_TEST(test_index_with_a_dwell_parks_at_the_flange_before_it);
	RUN_TEST(test_an_overtravel_switch_beside_its_limit_switch_is_not_named);
	RUN_TEST(test_a_far_switch_that_is_still_bouncing_at_its_tolerance_is_waited_for);
	RUN_TEST(test_an_index_whose_edges_are_slower_than_ticks);
	RUN_TEST(test_a_span_at_its_tolerance_is_within_it);
	RUN_TEST(test_parking_at_a_position_rests_in_no_reversal_on_the_way);
	RUN_TEST(test_an_index_begins_the_ribbon_breaker_anew);
	RUN_TEST(test_no_far_switch_on_the_way_to_the_reversal_and_back);
	RUN_TEST(test_stop_before_the_edge_that_a_phase_waits_for);
	RUN_TEST(test_a_jog_that_was_let_go_is_over);
	RUN_TEST(test_a_rest_that_no_phase_has_asked_for_ends_the_index);
	RUN_TEST(test_a_wire_that_breaks_in_the_tick_of_a_trigger_is_the_fault);
	RUN_TEST(test_an_index_that_is_complete_leaves_nothing_to_be_done);
	return UNITY_END();
}
