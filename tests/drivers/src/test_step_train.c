/*
 * Steps as runs of a one-pulse timer (drivers/step_dir/step_train.h), on an emulated timer: its
 * counter, its update flag and interrupt, and the two outputs. The registers of a real timer are
 * not exercised here.
 */
#include <errno.h>
#include <string.h>

#include <zephyr/random/random.h>
#include <zephyr/ztest.h>

#include "step_train.h"

#define NEVER INT64_MIN

static const struct step_train_config times = {
	.dir_setup_ticks = 480,
	.dir_hold_ticks = 300,
	.step_pulse_ticks = 240,
	.step_space_ticks = 200,
};

static struct step_train train;

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

static void start_run(void)
{
	struct step_run run;

	if (!step_train_next(&train, &times, &run)) {
		timer.interrupt_enabled = false;
		return;
	}
	if (run.set_direction != 0) {
		zassert_not_equal(run.set_direction, timer.direction);
		zassert_true(timer.fall == NEVER || timer.now - timer.fall >= times.dir_hold_ticks,
			     "hold");
		timer.direction = run.set_direction;
		timer.dir_changed = timer.now;
	}
	zassert_true(run.delay_ticks >= 1, "a pulse that begins at once would have no beginning");
	timer.running = true;
	timer.end = timer.now + run.delay_ticks + run.pulse_ticks;
	timer.interrupt_enabled = train.waiting != 0;
	if (run.pulse_ticks == 0) {
		return;
	}
	timer.rise = timer.now + run.delay_ticks;
	zassert_true(timer.fall == NEVER || timer.rise - timer.fall >= times.step_space_ticks,
		     "space");
	zassert_true(timer.rise - timer.dir_changed >= times.dir_setup_ticks, "set-up");
	timer.fall = timer.end;
	zassert_true(timer.fall - timer.rise >= times.step_pulse_ticks, "pulse");
	timer.position += timer.direction;
	timer.pulses++;
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

static void step(int direction)
{
	step_train_add(&train, direction);
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

ZTEST(step_train, test_a_direction_is_held_and_set_up)
{
	step(1);
	zassert_equal(timer.rise, 480, "the first direction has nothing to hold");
	pass(10000);
	step(-1);
	zassert_equal(timer.direction, 1, "changed before the hold time was over");
	pass(10300);
	zassert_equal(timer.direction, -1);
	zassert_equal(timer.rise, 10300 + 480);
	pass(20000);
	step(-1);
	zassert_equal(timer.rise, 20200);
	pass(30000);
	zassert_equal(timer.position, -1);
	zassert_equal(timer.pulses, 3);
}

ZTEST(step_train, test_a_step_and_its_opposite_that_wait_are_neither_given)
{
	step(1);
	step(1);
	step(-1);
	pass(10000);
	zassert_equal(timer.pulses, 1);
	zassert_equal(timer.position, 1);
	step(-1); /* its hold time begins ... */
	step(1);  /* ... and nothing is left of it */
	pass(20000);
	zassert_equal(timer.pulses, 1);
	zassert_equal(timer.direction, 1);
	step(-1); /* held anew: the last hold time is long past */
	pass(20299);
	zassert_equal(timer.direction, 1);
	pass(30000);
	zassert_equal(timer.position, 0);
}

ZTEST(step_train, test_no_step_is_lost_whatever_comes_when)
{
	int wanted = 0;

	for (int i = 0; i < 200000; i++) {
		/* From far too fast to slow, in runs of one direction and in single steps. */
		const int direction = (int)(sys_rand32_get() % 8) < 1 + i % 7 ? 1 : -1;

		step(direction);
		wanted += direction;
		pass(timer.now + sys_rand32_get() % (100 + i % 3000));
	}
	pass(timer.now + 200000 * 1000LL);
	zassert_false(timer.running);
	zassert_equal(timer.position, wanted);
}

ZTEST(step_train, test_times_are_rounded_up_to_ticks)
{
	struct step_train_config config;

	zassert_ok(step_train_configure(&config, 96000000, 5000, 4999, 2501, 1, 65535));
	zassert_equal(config.dir_setup_ticks, 480);
	zassert_equal(config.dir_hold_ticks, 480);
	zassert_equal(config.step_pulse_ticks, 241);
	zassert_equal(config.step_space_ticks, 1);
	zassert_ok(step_train_configure(&config, 1000000, 0, 0, 0, 3000, 65535));
	zassert_equal(config.dir_setup_ticks, 3, "the space holds before a new direction, too");
	zassert_equal(config.dir_hold_ticks, 0);
	zassert_equal(config.step_pulse_ticks, 1);
}

ZTEST(step_train, test_what_the_timer_cannot_count_is_refused)
{
	struct step_train_config config;

	zassert_ok(step_train_configure(&config, 100000000, 0, 0, 655340, 10, 65535));
	zassert_equal(step_train_configure(&config, 100000000, 0, 0, 655350, 10, 65535), -ERANGE);
	zassert_equal(step_train_configure(&config, 100000000, 0, 655360, 10, 10, 65535), -ERANGE);
	zassert_equal(step_train_configure(&config, UINT32_MAX, UINT32_MAX, 0, 10, 10, 65535),
		      -ERANGE);
}

ZTEST_SUITE(step_train, NULL, NULL, before, NULL, NULL);
