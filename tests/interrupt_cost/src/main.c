/* SPDX-License-Identifier: Apache-2.0 */
/*
 * How many instructions lie between an encoder interrupt and the step that it gives, the core's and
 * the operating system's apart. Under QEMU's -icount every instruction takes the same virtual time,
 * so a timer counts them. The encoder is a spare interrupt line that software sets pending.
 */
#include <cmsis_core.h>
#include <zephyr/irq.h>
#include <zephyr/ztest.h>

#include "lw/control/controller.h"
#include "lw/control/params.h"

/** An interrupt of the board that nothing drives. */
#define LINE 31

/** What a plain Zephyr interrupt may cost, entry and exit. */
#define SYSTEM_MAX_INSTRUCTIONS 24

/** What the core may take for a transition; at 48,000 edges/s there are 96,000 in a second. */
#define CORE_MAX_INSTRUCTIONS 54

#define EDGES 200000

/** 25 MHz timer 0 of the board, counting down (Arm DDI 0479, 4.1). */
static struct {
	volatile uint32_t ctrl;
	volatile uint32_t value;
	volatile uint32_t reload;
} *const timer = (void *)DT_REG_ADDR(DT_NODELABEL(timer0));

/** A distribution of instruction counts. */
struct cost {
	uint32_t min;
	uint32_t max;
	uint64_t sum;
};

static struct lw_derived derived;
static struct lw_controller controller;
static int phase;
static int position_usteps;
static uint32_t entered;
static uint32_t left;

static void on_edge(const void *unused)
{
	static const bool a[] = {false, true, true, false};
	static const bool b[] = {false, false, true, true};

	ARG_UNUSED(unused);
	entered = timer->value;
	position_usteps += lw_controller_encoder(&controller, a[phase], b[phase]);
	left = timer->value;
}

/** Instructions between two readings of the timer. */
static uint32_t instructions(uint32_t from, uint32_t to)
{
	return ((from - to) * 5 + 4) / 8; /* 1.6 cycles each, to nearest */
}

static void add(struct cost *cost, uint32_t count)
{
	cost->min = MIN(cost->min, count);
	cost->max = MAX(cost->max, count);
	cost->sum += count;
}

static void print(const char *name, const struct cost *cost)
{
	TC_PRINT("%s: min %u, mean %u, max %u instructions\n", name, cost->min,
		 (uint32_t)(cost->sum / EDGES), cost->max);
}

/** Set the line pending, and let its interrupt happen if it is enabled. */
static uint32_t count_interrupt(void)
{
	const uint32_t before = timer->value;

	NVIC_SetPendingIRQ((IRQn_Type)LINE);
	__ISB();
	return instructions(before, timer->value);
}

static void *setup(void)
{
	timer->reload = UINT32_MAX;
	timer->value = UINT32_MAX;
	timer->ctrl = 1;
	return NULL;
}

ZTEST(interrupt_cost, test_an_edge_costs_what_it_may)
{
	const struct lw_inputs inputs = {0};
	struct cost core = {.min = UINT32_MAX};
	struct cost system = {.min = UINT32_MAX};
	struct lw_refusal why;
	uint32_t without;

	zassert_ok(lw_params_derive(&lw_params_default, &derived, &why));
	lw_controller_init(&controller, &lw_params_default, &derived, &inputs, 0);
	lw_motion_set_position(&controller.motion, controller.motion.window, 0, derived.ks);
	lw_motion_set_source(&controller.motion, LW_EDGE_SOURCE_ENCODER);
	controller.state = LW_STATE_TRACKING;
	/* The first edge after a change looks at everything: it is not the one to measure. */
	position_usteps = lw_motion_edge(&controller.motion, 1);

	SysTick->CTRL &= ~SysTick_CTRL_ENABLE_Msk; /* no other interrupt */
	without = count_interrupt();
	NVIC_ClearPendingIRQ((IRQn_Type)LINE);
	IRQ_CONNECT(LINE, 0, on_edge, NULL, 0);
	irq_enable(LINE);
	for (int i = 0; i < EDGES; i++) {
		const int before_usteps = position_usteps;
		uint32_t all;
		uint32_t edge;

		phase = (phase + 1) % 4;
		all = count_interrupt() - without;
		edge = instructions(entered, left);
		add(&core, edge);
		add(&system, all - edge);
		zassert_true(position_usteps - before_usteps <= 1 &&
			     position_usteps - before_usteps >= -1);
	}
	SysTick->CTRL |= SysTick_CTRL_ENABLE_Msk;
	print("core, one transition", &core);
	print("operating system, entry and exit", &system);
	zassert_equal(controller.motion.edges, EDGES / 2);
	zassert_equal(position_usteps, lw_law_pos_usteps(lw_motion_m(&controller.motion)));
	zassert_true(core.max <= CORE_MAX_INSTRUCTIONS);
	zassert_true(system.max <= SYSTEM_MAX_INSTRUCTIONS);
}

ZTEST_SUITE(interrupt_cost, NULL, setup, NULL, NULL, NULL);
