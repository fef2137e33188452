/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What the supervisor changes while edges come. A signal is the encoder interrupt: it comes once
 * in a call, each time at another place in it.
 */
#define _POSIX_C_SOURCE 200809L

#include <signal.h>
#include <stdatomic.h>
#include <time.h>

#include <unity.h>

#include "rig.h"

/** Calls that an edge must have interrupted. */
#define INTERRUPTED_CALLS 5000

/** The state that each call begins with. */
static struct lw_controller before;
static uint32_t quarter;
static int edge; /**< what the drum does: 1 or -1 */

/* The interrupt's; it does nothing outside of a call. */
static volatile sig_atomic_t in_call;
static volatile sig_atomic_t fired;
static volatile sig_atomic_t interrupts;

static timer_t timer;

static void on_interrupt(int number)
{
	(void)number;
	fired = 1;
	if (in_call) {
		interrupts++;
		rig_transition(edge);
		rig_transition(edge);
	}
}

void setUp(void)
{
	const struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = SA_RESTART};
	struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGUSR1};

	TEST_ASSERT_EQUAL_INT(0, sigaction(SIGUSR1, &action, NULL));
	TEST_ASSERT_EQUAL_INT(0, timer_create(CLOCK_MONOTONIC, &event, &timer));
	rig_prepare(0);
}

void tearDown(void)
{
	TEST_ASSERT_EQUAL_INT(0, timer_delete(timer));
}

/** This state is the one that each call begins with. */
static void begin_here(int edge_then)
{
	before = *rig.controller;
	quarter = rig.quarter;
	edge = edge_then;
}

/** Call from the state that each call begins with. */
static void call_once(void (*call)(void))
{
	*rig.controller = before;
	rig.quarter = quarter;
	atomic_signal_fence(memory_order_seq_cst);
	in_call = 1;
	call();
	in_call = 0;
}

/** Call again and again, and check what came of those calls that were interrupted. */
static void interrupt(void (*call)(void), void (*check)(void))
{
	struct itimerspec once = {0};
	long count = 0;

	interrupts = 0;
	while (interrupts < INTERRUPTED_CALLS) {
		const sig_atomic_t interrupts_before = interrupts;

		once.it_value.tv_nsec = 10000 + count++ * 7919 % 10000;
		fired = 0;
		TEST_ASSERT_EQUAL_INT(0, timer_settime(timer, 0, &once, NULL));
		while (!fired) {
			call_once(call);
		}
		if (interrupts != interrupts_before) {
			check();
		}
	}
}

static void stop(void)
{
	lw_controller_stop(rig.controller);
}

static void check_corrected_once(void)
{
	TEST_ASSERT_INT32_WITHIN(1, lw_law_pos_usteps(lw_motion_m(&before.motion)) - 50,
				 lw_law_pos_usteps(lw_motion_m(&rig.controller->motion)));
}

static void test_a_correction_is_made_once_by_an_edge_or_by_a_stop(void)
{
	/* An edge back leads from the reversal to the sweep, where it is made. */
	rig_track();
	rig_follow_to(7900, 1, 8000);
	rig_rest();
	while (lw_motion_in_sweep(&rig.controller->motion)) {
		rig_turn(1);
	}
	rig.controller->motion.request_correction_usteps = -50;
	lw_motion_request(&rig.controller->motion, LW_MOTION_REQUEST_CORRECTION);
	begin_here(-1);
	interrupt(stop, check_corrected_once);
}

static void trim_more(void)
{
	lw_controller_set_trim(rig.controller, -1000, 1000);
}

static void check_the_law_is_of_its_window(void)
{
	const struct lw_motion *motion = &rig.controller->motion;

	TEST_ASSERT_EQUAL_UINT32(
		(uint32_t)(motion->window->sweep_end - motion->window->sweep_begin),
		motion->law.span);
}

static void test_a_window_that_an_edge_takes_is_not_changed_any_more(void)
{
	rig_track();
	rig_follow_to(0, 1, 8000);
	rig_rest();
	lw_controller_set_trim(rig.controller, -500, 500);
	begin_here(1);
	interrupt(trim_more, check_the_law_is_of_its_window);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_a_correction_is_made_once_by_an_edge_or_by_a_stop);
	RUN_TEST(test_a_window_that_an_edge_takes_is_not_changed_any_more);
	return UNITY_END();
}
