/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Steps as runs of a one-pulse timer (drivers/step_dir/step_train.h), on an emulated timer: its
 * counter, its update flag and interrupt, and the two outputs. The registers of a real timer are
 * not exercised here.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include <zephyr/random/random.h>
#include <zephyr/ztest.h>

#include "step_train.h"

#define NEVER INT64_MIN

static const struct step_train_config usual_times = {
	.dir_setup_ticks = 480,
	.dir_hold_ticks = 100, /* behind the space */
	.step_pulse_ticks = 240,
	.step_space_ticks = 200,
};

#define HOLD_TICKS (usual_times.step_space_ticks + usual_times.dir_hold_ticks)

static struct step_train train;
static struct step_train_config times;
static uint32_t hold_ticks; /**< from the end of a pulse on */

/** The timer and its outputs, at a time in ticks. */
static struct {
	int64_t now;
	bool running;
	bool interrupt_enabled;
	int64_t end;
	int64_t rise;
	int64_t fall; /**< of the last pulse that has begun */
	int64_t dir_changed;
	int direction;
	int position;
	int pulses;
} timer;

static void begin(uint32_t pulse_ticks, uint32_t rest_ticks)
{
	zassert_true(rest_ticks >= 1, "a pulse needs an end");
	zassert_true(pulse_ticks + rest_ticks >= 2, "an auto-reload value of 0 has no end");
	timer.running = true;
	timer.end = timer.now + pulse_ticks + rest_ticks;
	if (pulse_ticks == 0) {
		return;
	}
	timer.rise = timer.now;
	zassert_true(timer.fall == NEVER || timer.rise - timer.fall >= times.step_space_ticks,
		     "space");
	zassert_true(timer.rise - timer.dir_changed >= times.dir_setup_ticks, "set-up");
	timer.fall = timer.now + pulse_ticks;
	zassert_true(timer.fall - timer.rise >= times.step_pulse_ticks, "pulse");
	timer.position += timer.direction;
	timer.pulses++;
}

static void start_run(void)
{
	struct step_run run;

	if (!step_train_next(&train, &times, &run)) {
		timer.interrupt_enabled = false;
		return;
	}
	if (run.set_direction != 0) {
		zassert_not_equal(run.set_direction, timer.direction);
		zassert_true(timer.fall == NEVER || timer.now - timer.fall >= hold_ticks, "hold");
		timer.direction = run.set_direction;
		timer.dir_changed = timer.now;
	}
	begin(run.pulse_ticks, run.rest_ticks);
	timer.interrupt_enabled = step_train_goes_on(&train);
}

/** Let time pass, with the interrupts that fall into it. */
static void pass(int64_t until)
{
	while (timer.running && timer.end <= until) {
		timer.now = timer.end;
		timer.running = false;
		if (timer.interrupt_enabled) {
			start_run();
		}
	}
	timer.now = until;
}

/** As step_dir_stm32.c does it. */
static void steps(int count)
{
	if (!timer.running && step_train_is_next(&train, count)) {
		begin(times.step_pulse_ticks, times.step_space_ticks);
		return;
	}
	step_train_add(&train, count);
	if (timer.running) {
		timer.interrupt_enabled = true;
	} else {
		start_run();
	}
}

static void step(int direction)
{
	steps(direction);
}

static void prepare(int direction)
{
	train.prepared = (int8_t)direction;
	if (timer.running) {
		timer.interrupt_enabled = true;
	} else {
		start_run();
	}
}

static void before(void *fixture)
{
	ARG_UNUSED(fixture);
	memset(&train, 0, sizeof(train));
	memset(&timer, 0, sizeof(timer));
	timer.fall = NEVER;
	times = usual_times;
	hold_ticks = HOLD_TICKS;
}

ZTEST(step_train, test_a_step_that_falls_into_a_pulse_is_given_after_it)
{
	for (int i = 0; i < 50; i++) {
		step(1);
		pass(timer.now + 100); /* a pulse and its space take 440 */
	}
	zassert_true(timer.pulses < 50);
	pass(timer.now + 50 * 440);
	zassert_equal(timer.pulses, 50);
	zassert_equal(timer.position, 50);
	zassert_false(timer.running);
}

ZTEST(step_train, test_a_step_after_a_pause_is_given_at_once)
{
	step(1);
	pass(10000);
	step(1);
	zassert_equal(timer.rise, 10000);
	pass(20000);
	zassert_equal(timer.pulses, 2);
}

ZTEST(step_train, test_several_steps_at_once_are_given_one_after_the_other)
{
	steps(5);
	pass(10000);
	zassert_equal(timer.pulses, 5);
	steps(-3);
	pass(20000);
	zassert_equal(timer.position, 2);
	zassert_equal(timer.pulses, 8);
}

ZTEST(step_train, test_a_direction_is_held_and_set_up)
{
	step(1);
	pass(10000);
	zassert_equal(timer.rise, 480, "the first direction has nothing to hold");
	step(1);
	step(-1);
	step(-1);
	zassert_equal(timer.direction, 1, "changed before the hold time was over");
	pass(10000 + 240 + 299);
	zassert_equal(timer.direction, 1, "changed before the hold time was over");
	pass(20000);
	zassert_equal(timer.direction, -1);
	zassert_equal(timer.dir_changed, 10000 + 240 + 300);
	zassert_equal(timer.rise, 10000 + 240 + 300 + 480 + 440);
	zassert_equal(timer.position, 0);
	zassert_equal(timer.pulses, 4);
}

ZTEST(step_train, test_a_direction_that_is_prepared_costs_no_time)
{
	step(1);
	pass(10000);
	prepare(-1);
	pass(10000 + 100 + 480);
	zassert_false(timer.running);
	step(-1);
	zassert_equal(timer.rise, 10580);
	pass(20000);
	prepare(-1);
	zassert_false(timer.running, "it stands there already");
	/* Prepared while a step waits: the step goes first, and another one takes it back. */
	step(-1);
	step(-1);
	prepare(1);
	pass(30000);
	zassert_equal(timer.position, -2);
	zassert_equal(timer.direction, 1);
	step(-1);
	prepare(1);
	step(-1);
	pass(40000);
	zassert_equal(timer.position, -4);
	zassert_equal(timer.direction, -1);
}

ZTEST(step_train, test_a_step_and_its_opposite_that_wait_are_neither_given)
{
	step(1);
	pass(1000);
	step(1);
	step(1);
	step(-1);
	pass(10000);
	zassert_equal(timer.pulses, 2);
	zassert_equal(timer.position, 2);
	step(-1); /* its hold time begins ... */
	step(1);  /* ... and nothing is left of it */
	pass(20000);
	zassert_equal(timer.pulses, 2);
	zassert_equal(timer.direction, 1);
	step(-1); /* held anew: the last hold time is long past */
	pass(20099);
	zassert_equal(timer.direction, 1);
	pass(30000);
	zassert_equal(timer.position, 1);
}

ZTEST(step_train, test_more_steps_than_a_motor_follows_are_dropped_and_told)
{
	steps(LW_STEP_DIR_WAITING_MAX);
	zassert_false(train.lost);
	steps(LW_STEP_DIR_WAITING_MAX);
	zassert_true(train.lost);
	zassert_equal(train.waiting, 0);
	train.lost = false;
	steps(-LW_STEP_DIR_WAITING_MAX - 1);
	zassert_true(train.lost);
	pass(1000000);
	zassert_false(timer.running);
	zassert_true(timer.pulses <= LW_STEP_DIR_WAITING_MAX);
}

ZTEST(step_train, test_no_step_is_lost_whatever_comes_when)
{
	int wanted = 0;

	for (int i = 0; i < 200000; i++) {
		/* From far too fast to slow, in runs of one direction and in single steps. */
		const int direction = (int)(sys_rand32_get() % 8) < 1 + i % 7 ? 1 : -1;
		const int count = sys_rand32_get() % 16 == 0 ? 3 : 1;

		if (sys_rand32_get() % 8 == 0) {
			prepare(-direction);
		}
		steps(direction * count);
		wanted += direction * count;
		pass(timer.now + sys_rand32_get() % (100 + i % 3000));
		if (abs(train.waiting) > LW_STEP_DIR_WAITING_MAX / 2) {
			pass(timer.now + 30000);
		}
	}
	zassert_false(train.lost);
	pass(timer.now + 200000 * 1000LL);
	zassert_false(timer.running);
	zassert_equal(timer.position, wanted);
}

/* Whatever the timer's clock: what is short of a tick, one tick, and more. */
ZTEST(step_train, test_a_run_of_one_tick_is_none)
{
	static const uint32_t clocks_hz[] = {1000000, 8000000, 48000000, 96000000, 180000000};

	for (size_t i = 0; i < ARRAY_SIZE(clocks_hz); i++) {
		for (uint32_t hold_ns = 0; hold_ns < 3000; hold_ns += 1 + hold_ns / 8) {
			before(NULL);
			zassert_ok(step_train_configure(&times, clocks_hz[i], 0, hold_ns, 0, 0,
							UINT16_MAX));
			hold_ticks = DIV_ROUND_UP((uint64_t)hold_ns * clocks_hz[i], 1000000000);
			step(1);
			pass(1000000);
			step(-1);
			pass(2000000);
			zassert_equal(timer.pulses, 2, "%u ns at %u Hz", hold_ns, clocks_hz[i]);
			zassert_equal(timer.position, 0);
			zassert_false(timer.running);
		}
	}
}

ZTEST(step_train, test_times_are_rounded_up_to_ticks)
{
	struct step_train_config config;

	zassert_ok(step_train_configure(&config, 96000000, 5000, 4999, 2501, 1, 65535));
	zassert_equal(config.dir_setup_ticks, 480);
	zassert_equal(config.dir_hold_ticks, 479, "one tick of it is the space");
	zassert_equal(config.step_pulse_ticks, 241);
	zassert_equal(config.step_space_ticks, 1);
	zassert_ok(step_train_configure(&config, 1000000, 0, 0, 0, 3000, 65535));
	zassert_equal(config.dir_setup_ticks, 2, "the shortest run");
	zassert_equal(config.dir_hold_ticks, 0);
	zassert_equal(config.step_pulse_ticks, 1);
	zassert_ok(step_train_configure(&config, 1000000, 0, 5000, 0, 3000, 65535));
	zassert_equal(config.dir_hold_ticks, 2, "the rest of it");
	zassert_ok(step_train_configure(&config, 1000000, 0, 3000, 0, 3000, 65535));
	zassert_equal(config.dir_hold_ticks, 0);
}

ZTEST(step_train, test_what_the_timer_cannot_count_is_refused)
{
	struct step_train_config config;

	zassert_ok(step_train_configure(&config, 100000000, 0, 0, 655340, 10, 65535));
	zassert_equal(step_train_configure(&config, 100000000, 0, 0, 655350, 10, 65535), -ERANGE);
	zassert_equal(step_train_configure(&config, 100000000, 0, 655380, 10, 10, 65535), -ERANGE);
	zassert_equal(step_train_configure(&config, UINT32_MAX, UINT32_MAX, 0, 10, 10, 65535),
		      -ERANGE);
}

ZTEST_SUITE(step_train, NULL, NULL, before, NULL, NULL);
