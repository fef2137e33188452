/* SPDX-License-Identifier: Apache-2.0 */
/* Where the rope goes on: kept over a power cut, taken up after an indexing. */
#include <unity.h>

#include "cases.h"
#include "law_check.h"
#include "lw/motion/move.h"
#include "storage_rig.h"

/** A power cut, until the drum counts as resting. */
static void restart(void)
{
	power_cut();
	run(300);
}

static void follow_again(void)
{
	command(LW_COMMAND_INDEX);
	run_to(LW_STATE_TRACKING);
}

/** Wind, and come to rest with the storage up to date. */
static void wind(int edges_per_s, int ms)
{
	rig.drum_edges_per_s = edges_per_s;
	run(ms);
	rig.drum_edges_per_s = 0;
	run(500);
}

/** Stage more with it, then follow the drum with `resume`. */
static void begin(void)
{
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_RESUME, 1));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_INDEX_RATE_EDGES_PER_S, 20000));
	command(LW_COMMAND_APPLY);
	command(LW_COMMAND_SAVE);
	run(10);
	follow_again();
}

void setUp(void)
{
	rig_prepare(0);
	power_up(NULL, 0);
}

void tearDown(void)
{
	cases_end();
}

static void assert_goes_on(const struct lw_law *law)
{
	TEST_ASSERT_TRUE_MESSAGE(law_same(law, &rig.controller->motion.law), "another state");
	TEST_ASSERT_TRUE(law_on_orbit(law, rig.controller->motion.window));
	TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
}

static void test_every_part_of_the_state_is_taken_up(void)
{
	/* Sweep both ways, reversals, far points with a dwell in a ribbon breaker's cycle. */
	int resting = 0;

	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_DWELL_PLUS_MILLIREV, 2000));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_BREAKER_MILLIREV, 2000));
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_BREAKER_CYCLES, 5));
	begin();
	for (int i = 0; i < 40; i++) {
		wind(i % 10 == 9 ? -40000 : 40000, 777);

		const struct lw_law law = rig.controller->motion.law;

		resting += law.dwell_edges > 0;
		TEST_ASSERT_EQUAL_INT32(lw_params_q16_to_um(&rig.device.active, lw_law_m(&law)),
					status()->resume_position_um);
		TEST_ASSERT_EQUAL_INT32(law.u > 0            ? 1
					: law.u < 0          ? -1
					: lw_law_m(&law) > 0 ? -1
							     : 1,
					status()->resume_direction);
		restart();
		TEST_ASSERT_FALSE(flag(LW_FLAG_RESUME_DOUBTFUL));
		follow_again();
		assert_goes_on(&law);
		TEST_ASSERT_EQUAL_UINT16(1, rig.controller->resume.taken_up);
		TEST_ASSERT_TRUE(flag(LW_FLAG_LAUNCH_PERMIT));
	}
	TEST_ASSERT_TRUE(resting > 0);
}

static void test_it_is_in_the_log(void)
{
	const struct lw_log_record *newest;

	begin();
	wind(40000, 1000);
	restart();
	command(LW_COMMAND_INDEX);
	for (int i = 0; i < 60000 && rig.controller->resume.taken_up == 0; i++) {
		run(1);
	}
	for (int back = 0;; back++) {
		TEST_ASSERT_TRUE(back < 3);
		newest =
			&rig.store.log
				 .records[(rig.store.log.newest - (uint32_t)back) % LW_LOG_RECORDS];
		if (newest->event == LW_EVENT_RESUMED) {
			break;
		}
	}
	TEST_ASSERT_EQUAL_INT32(status()->position_um, newest->detail);
}

static void test_without_the_parameter_nothing_is_kept(void)
{
	begin();
	wind(40000, 1000);
	TEST_ASSERT_EQUAL_INT32(1, status()->resume_direction);
	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_RESUME, 0));
	command(LW_COMMAND_APPLY);
	run(10);
	TEST_ASSERT_EQUAL_INT32(0, status()->resume_direction);
	TEST_ASSERT_EQUAL_INT32(0, status()->resume_position_um);
	follow_again();
	TEST_ASSERT_EQUAL_UINT16(0, rig.controller->resume.taken_up);
	/* What is stored belongs to a set that says 0 now. */
	command(LW_COMMAND_STOP);
	command(LW_COMMAND_SAVE);
	run(500);
	restart();
	TEST_ASSERT_EQUAL_INT32(0, status()->resume_direction);
}

static void test_without_a_power_cut_too(void)
{
	begin();
	wind(40000, 1000);

	const struct lw_law law = rig.controller->motion.law;

	follow_again();
	assert_goes_on(&law);

	/* Once: from there it goes on by itself. */
	command(LW_COMMAND_STOP);
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	run_to(LW_STATE_TRACKING);
	TEST_ASSERT_EQUAL_UINT16(1, rig.controller->resume.taken_up);
}

static void test_a_stored_place_of_another_set_is_not_used(void)
{
	begin();
	wind(40000, 1000);
	command(LW_COMMAND_STOP);
	run(500);
	/* The stored set says another pitch, the record is of the one before. */
	rig.store.params.pitch_um = 11000;
	(void)lw_param_record_encode(&rig.store.params, 99, rig.slots[LW_STORE_PARAMS]);
	restart();
	TEST_ASSERT_EQUAL_INT32(11000, rig.device.active.pitch_um);
	TEST_ASSERT_EQUAL_INT32(0, status()->resume_direction);
	TEST_ASSERT_EQUAL_INT32(0, rig.controller->moving.shift_usteps);
}

static void test_what_makes_it_doubtful(void)
{
	for (int cause = 0; cause < 6; cause++) {
		setUp();
		begin();
		wind(40000, 1000);
		restart();
		/* A quarter of a millimetre of carriage. */
		rig_turn(-61);
		run(300);
		TEST_ASSERT_FALSE(flag(LW_FLAG_RESUME_DOUBTFUL));
		rig_turn(122);
		run(300);
		TEST_ASSERT_FALSE(flag(LW_FLAG_RESUME_DOUBTFUL));
		switch (cause) {
		case 0:
			rig_turn(1);
			break;
		case 1:
			rig_turn(-123);
			break;
		case 2:
			rig.controller->odometer_doubtful = true;
			break;
		case 3:
			rig.controller->los.encoder.set = true;
			break;
		case 4:
			rig_place(rig.carriage_usteps - 110); /* by hand, 1.1 mm */
			break;
		default:
			rig_place(rig.carriage_usteps + 110);
			break;
		}
		run(300);
		TEST_ASSERT_EQUAL(cause < 4, flag(LW_FLAG_RESUME_DOUBTFUL));
		command(LW_COMMAND_INDEX);
		run_to(LW_STATE_TRACKING);
		TEST_ASSERT_EQUAL_UINT16(0, rig.controller->resume.taken_up);
		run(10);
		TEST_ASSERT_FALSE(flag(LW_FLAG_RESUME_DOUBTFUL)); /* another place is kept */
	}
}

static void test_a_doubt_outlasts_a_power_cut(void)
{
	begin();
	wind(40000, 1000);
	restart();
	rig_turn(500);
	run(500);
	restart();
	TEST_ASSERT_TRUE(flag(LW_FLAG_RESUME_DOUBTFUL));
	TEST_ASSERT_EQUAL_INT32(1, status()->resume_direction);
}

static void test_what_is_not_at_rest_or_no_screw_is_not_kept(void)
{
	begin();
	wind(40000, 1000);
	rig.drum_edges_per_s = 10000;
	run(300);
	TEST_ASSERT_EQUAL_INT32(0, status()->resume_direction);
	/* A stop at speed loses the place. */
	command(LW_COMMAND_STOP);
	rig.drum_edges_per_s = 0;
	run(500);
	TEST_ASSERT_EQUAL_INT32(0, status()->resume_direction);
	restart();
	TEST_ASSERT_EQUAL_INT32(0, status()->resume_direction);
}

static void test_a_place_outside_of_the_trimmed_sweep(void)
{
	/* A trim of then is no trim of now: at either end, in either direction. */
	FOR_EACH_SIDE(side) {
		for (int inward = 0; inward < 2; inward++) {
			const int toward = lw_side_direction(side);

			setUp();
			begin();
			(void)write_register(side == LW_PLUS ? LW_ADDRESS_TRIM_PLUS_UM
							     : LW_ADDRESS_TRIM_MINUS_UM,
					     -toward * 1400);
			rig_follow_to(0, toward, 40000);
			rig_follow_to(toward * 7900, inward ? -toward : toward, 20000);
			rig.drum_edges_per_s = 0;
			run(500);

			const struct lw_law law = rig.controller->motion.law;

			TEST_ASSERT_TRUE(law.u != 0);
			restart();
			follow_again();
			TEST_ASSERT_EQUAL_UINT16(1, rig.controller->resume.taken_up);
			TEST_ASSERT_TRUE(law_on_orbit(&rig.controller->motion.law,
						      rig.controller->motion.window));
			TEST_ASSERT_TRUE((rig.controller->motion.law.u > 0) == (law.u > 0));
			TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());

			/* And the other way round: the reversals come earlier now. */
			(void)write_register(side == LW_PLUS ? LW_ADDRESS_TRIM_PLUS_UM
							     : LW_ADDRESS_TRIM_MINUS_UM,
					     0);
			rig_follow_to(0, toward, 40000);
			rig_follow_to(toward * 7990, inward ? -toward : toward, 20000);
			rig.drum_edges_per_s = 0;
			run(500);
			restart();
			(void)write_register(side == LW_PLUS ? LW_ADDRESS_TRIM_PLUS_UM
							     : LW_ADDRESS_TRIM_MINUS_UM,
					     -toward * 1400);
			follow_again();
			TEST_ASSERT_EQUAL_UINT16(1, rig.controller->resume.taken_up);
			TEST_ASSERT_TRUE(law_on_orbit(&rig.controller->motion.law,
						      rig.controller->motion.window));
			TEST_ASSERT_INT32_WITHIN(1, 0, rig_error_usteps());
		}
	}
}

static void test_it_does_not_wear_the_flash_out(void)
{
	int writes = 0;

	/* A drum that creeps below its rest: another place with every tick. */
	begin();
	rig.drum_edges_per_s = 40;
	for (int i = 0; i < 240000; i++) {
		rig_tick();
		writes += rig_write_slot(0) >= LW_STORE_LOOK;
	}
	TEST_ASSERT_INT_WITHIN(1, 13, writes); /* in four minutes */
}

static void test_a_move_into_a_microstep_ends_in_it(void)
{
	static const int32_t kas[] = {1, 23, 1000, 65535};
	static const int32_t ways[] = {1, 2, 3, 10, 1000, 15000};
	uint64_t seed = 1;

	for (size_t k = 0; k < sizeof(kas) / sizeof(kas[0]); k++) {
		for (size_t i = 0; i < 2 * sizeof(ways) / sizeof(ways[0]); i++) {
			const int32_t nr = kas[k] == 23 ? 1187 : LW_USTEP / kas[k] / 2 + 1;
			const int32_t way = i % 2 ? -ways[i / 2] : ways[i / 2];
			const int32_t begin_usteps = (int32_t)(next_random(&seed) % 1000);
			int32_t m =
				begin_usteps * LW_USTEP + (int32_t)(next_random(&seed) % LW_USTEP);
			struct lw_law_window window;
			struct lw_law law;

			TEST_ASSERT_FALSE(lw_move_into(&m, &window, kas[k], nr, begin_usteps));
			TEST_ASSERT_TRUE(lw_move_into(&m, &window, kas[k], nr, begin_usteps + way));
			TEST_ASSERT_EQUAL_INT32(begin_usteps, lw_law_pos_usteps(m));
			law = lw_law_at(&window, m, 0);
			do {
				(void)lw_law_edge(&law, 1);
			} while (law.u != 0);
			TEST_ASSERT_EQUAL_INT32(begin_usteps + way,
						lw_law_pos_usteps(lw_law_m(&law)));
		}
	}
}

/** Take up a place and slope that were kept. @return the law that follows the drum again */
static struct lw_law take_up(int32_t m, int32_t u)
{
	struct lw_resume *resume = &rig.controller->resume;

	command(LW_COMMAND_STOP);
	run(10);
	TEST_ASSERT_EQUAL_INT(LW_STATE_READY, rig.controller->state);
	resume->m = m;
	resume->u = u;
	resume->wanted = true;
	lw_controller_set_mode(rig.controller, LW_MODE_TRACK);
	run_to(LW_STATE_TRACKING);
	return rig.controller->motion.law;
}

static void assert_taken_up(int32_t m, int32_t u, int32_t expected_m, int32_t expected_u)
{
	const uint16_t before = rig.controller->resume.taken_up;
	const struct lw_law law = take_up(m, u);

	TEST_ASSERT_EQUAL_UINT8(0, rig.controller->motion.requests);
	TEST_ASSERT_EQUAL_UINT16(before + 1, rig.controller->resume.taken_up);
	TEST_ASSERT_EQUAL_INT32(expected_m, lw_law_m(&law));
	TEST_ASSERT_EQUAL_INT32(expected_u, law.u);
	TEST_ASSERT_TRUE(law_on_orbit(&law, rig.controller->motion.window));
}

static void test_a_state_is_taken_up_to_the_bit_or_else_the_nearest_of_the_sweep(void)
{
	begin();
	wind(40000, 100);

	const struct lw_law_window window = *rig.controller->motion.window;
	const int32_t ks = window.ks;
	const int32_t ka = window.ka;

	/* In the sweep the slope is that of the sweep. */
	assert_taken_up(1000, ks, 1000, ks);
	assert_taken_up(1000, -ks, 1000, -ks);
	assert_taken_up(1000, ks - ka, 1000, ks);
	assert_taken_up(1000, -ks - ka, 1000, -ks);
	assert_taken_up(1000, ks + ka, 1000, ks);
	assert_taken_up(1000, ks - 1, 1000, ks);
	assert_taken_up(1000, 1, 1000, ks);
	assert_taken_up(1000, -1, 1000, -ks);

	/* Past the border, before the reversal's first edge. */
	assert_taken_up(window.sweep_end, ks, window.sweep_end, ks);
	assert_taken_up(window.sweep_begin - 1, -ks, window.sweep_begin - 1, -ks);

	/* A reversal is entered from the sweep: by less than its slope past the border. */
	for (int32_t j = 1; j < 2 * ks / ka; j += ks / ka / 3) {
		const int32_t way = (int32_t)law_reversal_way(&window, j);
		const int32_t u = ks - j * ka;
		const int32_t inward = u > 0 ? ks : -ks; /* none of them rests */
		const int32_t end = window.sweep_end;
		const int32_t begin = window.sweep_begin;

		assert_taken_up(end + way, u, end + way, u);
		assert_taken_up(end + ks - 1 + way, u, end + ks - 1 + way, u);
		assert_taken_up(end - 1 + way, u, end - LW_USTEP, inward);
		assert_taken_up(end + ks + way, u, end - LW_USTEP, inward);
		assert_taken_up(end + way, u - 1, end - LW_USTEP, u > 1 ? ks : -ks);
		assert_taken_up(begin - 1 - way, -u, begin - 1 - way, -u);
		assert_taken_up(begin - ks - way, -u, begin - ks - way, -u);
		assert_taken_up(begin - way, -u, begin, -inward);
		assert_taken_up(begin - ks - 1 - way, -u, begin, -inward);
	}
}

static void assert_kept_here(void)
{
	const struct lw_resume *resume = &rig.controller->resume;
	const struct lw_law *law = &rig.controller->motion.law;

	TEST_ASSERT_TRUE(resume->known);
	TEST_ASSERT_FALSE(resume->doubtful || resume->wanted);
	TEST_ASSERT_EQUAL_INT32(lw_law_m(law), resume->m);
	TEST_ASSERT_EQUAL_INT32(law->u, resume->u);
	TEST_ASSERT_EQUAL_INT32(lw_law_pos_usteps(lw_law_m(law)), resume->stand_usteps);
}

static void test_what_is_kept_is_where_the_rope_is(void)
{
	begin();
	wind(40000, 1000);
	assert_kept_here();
	rig_turn(2); /* so slowly that it counts as rest */
	run(1);
	assert_kept_here();

	/* Away and back by as many edges. */
	rig_drive(4000);
	rig_drive(-4000);
	TEST_ASSERT_FALSE(rig.controller->resume.known);
	run(500);
	assert_kept_here();

	/* Elsewhere, and the drum has not turned: jogged there. */
	lw_controller_jog(rig.controller, rig.carriage_usteps > 0 ? -1 : 1, rig.now_us);
	run_to(LW_STATE_TRACKING);
	run(1);
	assert_kept_here();
	TEST_ASSERT_EQUAL_UINT16(0, rig.controller->resume.taken_up);
}

static void test_a_carriage_that_was_moved_is_found_once(void)
{
	for (int far = 0; far < 2; far++) {
		setUp();
		begin();
		wind(40000, 1000);
		command(LW_COMMAND_STOP);
		run(10);
		rig_place(rig.carriage_usteps + (far ? 110 : 90));
		follow_again();
		TEST_ASSERT_EQUAL_UINT16(far ? 0 : 1, rig.controller->resume.taken_up);
		run(10);
		/* From where it has been found it is taken up. */
		follow_again();
		TEST_ASSERT_EQUAL_UINT16(far ? 1 : 2, rig.controller->resume.taken_up);
	}
}

static void test_found_as_far_away_as_a_switch_may_be_off_it_is_taken_up(void)
{
	for (int way = -1; way <= 1; way += 2) {
		for (int beyond = 0; beyond <= 1; beyond++) {
			setUp();
			begin();
			wind(40000, 1000);
			command(LW_COMMAND_INDEX);
			run_to(LW_STATE_PARKING);
			rig.controller->moving.shift_usteps =
				way * (rig.controller->derived->switch_tolerance_usteps + beyond);
			run_to(LW_STATE_TRACKING);
			TEST_ASSERT_EQUAL_UINT16(!beyond, rig.controller->resume.taken_up);
			TEST_ASSERT_EQUAL_INT32(0, rig.controller->moving.shift_usteps);
		}
	}
}

static void test_a_trim_that_waits_is_in_the_pattern_that_is_taken_up(void)
{
	begin();
	wind(40000, 100);

	const struct lw_law law = rig.controller->motion.law;

	command(LW_COMMAND_STOP);
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_TRIM_PLUS_UM, -500));
	TEST_ASSERT_EQUAL_UINT8(LW_MOTION_REQUEST_WINDOW, rig.controller->motion.requests);
	assert_taken_up(lw_law_m(&law), law.u, lw_law_m(&law), law.u);
	TEST_ASSERT_EQUAL_INT32(7950, lw_law_pos_usteps(rig.controller->motion.window->sweep_end));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_every_part_of_the_state_is_taken_up);
	RUN_TEST(test_it_is_in_the_log);
	RUN_TEST(test_without_the_parameter_nothing_is_kept);
	RUN_TEST(test_without_a_power_cut_too);
	RUN_TEST(test_a_stored_place_of_another_set_is_not_used);
	RUN_TEST(test_what_makes_it_doubtful);
	RUN_TEST(test_a_doubt_outlasts_a_power_cut);
	RUN_TEST(test_what_is_not_at_rest_or_no_screw_is_not_kept);
	RUN_TEST(test_a_place_outside_of_the_trimmed_sweep);
	RUN_TEST(test_it_does_not_wear_the_flash_out);
	RUN_TEST(test_a_move_into_a_microstep_ends_in_it);
	RUN_TEST(test_a_state_is_taken_up_to_the_bit_or_else_the_nearest_of_the_sweep);
	RUN_TEST(test_what_is_kept_is_where_the_rope_is);
	RUN_TEST(test_a_carriage_that_was_moved_is_found_once);
	RUN_TEST(test_found_as_far_away_as_a_switch_may_be_off_it_is_taken_up);
	RUN_TEST(test_a_trim_that_waits_is_in_the_pattern_that_is_taken_up);
	return UNITY_END();
}
