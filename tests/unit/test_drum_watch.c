/* SPDX-License-Identifier: Apache-2.0 */
/* The drum watch, tick by tick: what is doubted, what is a fault, what costs nothing. */
#include <unity.h>

#include "lw/control/drum_watch.h"

#define A LW_QUADRATURE_A
#define B LW_QUADRATURE_B

static struct lw_params params;
static struct lw_quadrature quadrature;
static struct lw_encoder_index encoder_index;
static struct lw_drum_watch watch;
static uint32_t edges;
static uint64_t now_us;
static bool running;

void setUp(void)
{
	const struct lw_quadrature_config config = {.edges_per_pulse = 2};

	params = lw_params_default;
	params.drum_watch_ms = 0;
	lw_quadrature_init(&quadrature, &config, false, false);
	encoder_index = (struct lw_encoder_index){0};
	edges = 0;
	now_us = 5000000;
	running = false;
	lw_drum_watch_init(&watch, &quadrature, now_us);
}

void tearDown(void)
{
}

/** Milliseconds in each of which the encoder tells so much. */
static void ticks(int count, int32_t moved, uint32_t odd_a, uint32_t odd_b)
{
	while (count-- > 0) {
		now_us += 1000;
		edges += (uint32_t)moved;
		quadrature.odd_changes[A] += odd_a;
		quadrature.odd_changes[B] += odd_b;
		lw_drum_watch_tick(&watch, &params, &quadrature, &encoder_index, edges, 100,
				   running, now_us);
	}
}

/** Turn by `count` ms at 20 edges in each: in this decoding B's changes are no edges. */
static void turn(int count, int32_t speed)
{
	for (int32_t left = count; left > 0; left--) {
		ticks(1, speed, 0, (uint32_t)(speed < 0 ? -speed : speed));
	}
}

static void assert_sound(void)
{
	TEST_ASSERT_FALSE(watch.doubtful);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
}

static void test_a_turning_drum_is_sound_at_any_speed_and_in_any_decoding(void)
{
	turn(200, 40);
	turn(200, -40);
	assert_sound();
	params.encoder_edges_per_pulse = 4;
	ticks(200, 80, 0, 0);
	assert_sound();
	params.encoder_edges_per_pulse = 1;
	ticks(200, 20, 20, 40);
	assert_sound();
}

static void test_a_channel_that_stands_is_doubted_then_a_fault(void)
{
	for (int active = 0; active < 2; active++) {
		setUp();
		ticks(30, 0, active == A ? 48 : 0, active == B ? 48 : 0);
		TEST_ASSERT_TRUE(watch.doubtful);
		TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
		ticks(500, 0, active == A ? 48 : 0, active == B ? 48 : 0);
		TEST_ASSERT_EQUAL_INT(active == A ? LW_ENCODER_FAULT_B_STILL
						  : LW_ENCODER_FAULT_A_STILL,
				      watch.fault);
	}
}

static void test_rocking_is_doubted_and_passes(void)
{
	ticks(400, 0, 10, 0);
	TEST_ASSERT_TRUE(watch.doubtful);
	ticks(60, 0, 0, 0);
	assert_sound();
	TEST_ASSERT_EQUAL_UINT16(1, watch.doubts);
	watch.doubts = UINT16_MAX;
	ticks(50, 0, 10, 0);
	TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, watch.doubts);
}

static void test_the_masters_word_makes_a_doubt_a_fault(void)
{
	running = true;
	ticks(10, 0, 0, 48);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_A_STILL, watch.fault);
}

static void test_a_fast_drum_does_not_stop_or_start_at_once(void)
{
	turn(100, 20);
	ticks(3, 0, 0, 20);
	turn(40, 20);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_A_STILL, watch.fault);

	setUp();
	ticks(300, 0, 20, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
	turn(10, 20);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_STILL, watch.fault);

	/* Slow before and after. */
	setUp();
	ticks(300, 0, 20, 0);
	ticks(60, 0, 0, 0);
	turn(100, 1);
	assert_sound();
}

static void test_a_loose_wire_hides_edges_and_chatter_does_not(void)
{
	turn(100, 20);
	for (int i = 0; i < 60; i++) {
		ticks(1, 10, 0, 20); /* of 20 changes of B 10 have their edge of A */
	}
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_A_FLICKERS, watch.fault);

	setUp();
	turn(100, 20);
	ticks(60, 10, 10, 10);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_FLICKERS, watch.fault);

	setUp();
	turn(100, 20);
	ticks(400, 20, 25, 20);
	turn(60, 20);
	assert_sound();

	setUp();
	turn(100, 20);
	ticks(600, 20, 25, 20);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_FLICKERS, watch.fault);
}

static void test_too_many_illegal_transitions(void)
{
	for (int i = 0; i < 40; i++) {
		quadrature.illegal_transitions++;
		turn(1, 20);
	}
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_ILLEGAL, watch.fault);
	setUp();
	params.encoder_illegal_permille = 1000; /* not watched */
	for (int i = 0; i < 400; i++) {
		quadrature.illegal_transitions += 9;
		turn(1, 20);
	}
	assert_sound();
}

static void test_index_pulses_without_edges(void)
{
	params.encoder_watch_transitions_per_s = 60000; /* too slow to be doubted */
	for (int active = 0; active < 2; active++) {
		setUp();
		params.encoder_watch_transitions_per_s = 60000;
		for (int i = 0; i < 4; i++) {
			ticks(720, 0, active == A, active == B);
			encoder_index.pulses++;
		}
		TEST_ASSERT_EQUAL_INT(active == A ? LW_ENCODER_FAULT_B_STILL
						  : LW_ENCODER_FAULT_A_STILL,
				      watch.fault);
	}
	setUp();
	for (int i = 0; i < 4; i++) {
		turn(36, 20);
		encoder_index.pulses++;
	}
	assert_sound();
}

static void test_index_pulses_that_do_not_fit(void)
{
	for (int sign = -1; sign <= 1; sign += 2) {
		setUp();
		encoder_index.misfit_edges = sign * 120;
		encoder_index.pulses++;
		ticks(1, 0, 0, 0);
		assert_sound(); /* one may be noise */
		encoder_index.misfit_before_edges = sign * 120;
		encoder_index.pulses++;
		ticks(1, 0, 0, 0);
		TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_INDEX_MISFIT, watch.fault);
		/* A later fault does not hide the first. */
		quadrature.illegal_transitions += 100;
		turn(1, 20);
		TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_INDEX_MISFIT, watch.fault);
	}
}

static void test_a_drum_that_is_said_to_turn_and_tells_nothing(void)
{
	params.drum_watch_ms = 1000;
	running = true;
	ticks(999, 0, 0, 0);
	assert_sound();
	turn(2, 3);
	ticks(999, 0, 0, 0);
	assert_sound();
	ticks(2, 0, 0, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NO_EDGES, watch.fault);
}

static void test_an_indexing_takes_back_what_was_before_it(void)
{
	ticks(600, 0, 48, 0);
	TEST_ASSERT_NOT_EQUAL(LW_ENCODER_FAULT_NONE, watch.fault);
	lw_drum_watch_index_begins(&watch);
	TEST_ASSERT_FALSE(lw_drum_watch_indexed(&watch, &encoder_index)); /* in doubt still */
	ticks(100, 0, 0, 0);
	TEST_ASSERT_TRUE(lw_drum_watch_indexed(&watch, &encoder_index));
	assert_sound();
	ticks(600, 0, 48, 0);
	TEST_ASSERT_FALSE(lw_drum_watch_indexed(&watch, &encoder_index)); /* met meanwhile */
}

static void test_a_drum_that_rocks_by_an_edge_does_not_go_on(void)
{
	ticks(1, 1, 0, 0);
	ticks(1, -1, 0, 0);
	TEST_ASSERT_FALSE(watch.turning);
	ticks(1, 6, 0, 0); /* an edge of play, and five */
	TEST_ASSERT_EQUAL_INT32(5, watch.moved[0]);
	ticks(1, -2, 0, 0); /* back through the play */
	TEST_ASSERT_EQUAL_INT32(5, watch.moved[0]);
	ticks(1, -3, 0, 0);
	TEST_ASSERT_EQUAL_INT32(8, watch.moved[0]);
}

static void test_so_many_changes_in_a_block_are_a_doubt(void)
{
	ticks(1, 0, 39, 0); /* of 40 in 20 ms */
	TEST_ASSERT_FALSE(watch.doubtful);
	ticks(1, 0, 1, 0);
	TEST_ASSERT_TRUE(watch.doubtful);

	setUp();
	params.encoder_watch_transitions_per_s = 1; /* never less than two */
	ticks(1, 0, 1, 0);
	TEST_ASSERT_FALSE(watch.doubtful);
	ticks(1, 0, 1, 0);
	TEST_ASSERT_TRUE(watch.doubtful);

	/* Chatter on top of what a turning drum gives in this decoding. */
	setUp();
	params.encoder_edges_per_pulse = 1;
	ticks(5, 20, 20, 40 + 10);
	TEST_ASSERT_TRUE(watch.doubtful);
}

static void test_a_channel_flickers_where_the_drum_turns_or_both_change(void)
{
	running = true;
	params.encoder_edges_per_pulse = 4;
	ticks(5, 20, 10, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_FLICKERS, watch.fault);

	setUp();
	running = true;
	ticks(5, 0, 10, 1);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_FLICKERS, watch.fault);
}

static void test_a_doubt_is_a_fault_after_its_time_and_not_before(void)
{
	params.encoder_watch_ms = 2000;
	ticks(1999, 0, 48, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
	ticks(1, 0, 48, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_STILL, watch.fault);
}

static void test_a_doubt_is_held_for_its_time(void)
{
	ticks(1, 0, 48, 0);
	ticks(LW_DRUM_WATCH_HOLD_US / 1000, 0, 0, 0);
	TEST_ASSERT_TRUE(watch.doubtful);
	ticks(1, 0, 0, 0);
	TEST_ASSERT_FALSE(watch.doubtful);
}

/* At the speed of overspeed_trip a block of 20 ms has 40 edges. */
static void test_a_drum_that_was_fast_and_stands_has_a_dead_channel(void)
{
	ticks(1, 41, 0, 0);
	ticks(1, 0, 40, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_STILL, watch.fault);

	setUp(); /* fast a block ago */
	ticks(1, 41, 0, 0);
	ticks(19, 0, 0, 0);
	ticks(1, 0, 40, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_STILL, watch.fault);

	setUp(); /* not fast */
	ticks(1, 40, 0, 0);
	ticks(1, 0, 40, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
}

static void test_a_drum_that_stood_and_is_fast_has_a_dead_channel(void)
{
	ticks(1, 20, 0, 0);
	ticks(1, 0, 39, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.still);
	ticks(1, 0, 1, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_STILL, watch.still);
	ticks(1, 39, 0, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
	ticks(1, 1, 0, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_STILL, watch.fault);

	setUp(); /* what it went on counts from the last stand */
	ticks(1, 0, 40, 0);
	ticks(1, 31, 0, 0);
	ticks(1, 0, 40, 0);
	ticks(1, 30, 0, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);

	setUp(); /* the last moment in which it is at once */
	ticks(1, 0, 40, 0);
	ticks(1, 2, 0, 2);
	ticks(18, 0, 0, 0);
	ticks(1, 39, 0, 39);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_STILL, watch.fault);

	setUp(); /* later it may have gathered speed */
	ticks(1, 0, 40, 0);
	ticks(1, 2, 0, 2);
	ticks(19, 0, 0, 0);
	ticks(1, 100, 0, 100);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
}

/** A block of 20 ms with so many edges, and so many changes of A that they do not explain. */
static void block(int32_t moved, uint32_t lone)
{
	ticks(1, moved, lone, (uint32_t)moved);
	ticks(19, 0, 0, 0);
}

/** What is found where, after 400 edges in a block, `missing` are missing in the next. */
static enum lw_encoder_fault fault_with(int32_t missing, uint32_t lone)
{
	setUp();
	block(401, 0);
	block(400 - missing, lone);
	return watch.fault;
}

static void test_edges_are_missing_where_changes_explain_them(void)
{
	/* From three to five quarters of the changes, and enough of these. */
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, fault_with(29, 40));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_FLICKERS, fault_with(30, 40));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_FLICKERS, fault_with(50, 40));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, fault_with(51, 40));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, fault_with(39, 39));
}

static void test_edges_that_a_brake_explains_are_not_missing(void)
{
	for (int32_t missing = 59; missing <= 60; missing++) {
		setUp();
		block(401, 0);
		block(370, 30);
		block(400 - (missing - 30), 30);
		/* A drum brakes by 20 edges from block to block at most: 20 + 40 in two. */
		TEST_ASSERT_EQUAL_INT(missing < 60 ? LW_ENCODER_FAULT_NONE
						   : LW_ENCODER_FAULT_B_FLICKERS,
				      watch.fault);
	}
}

static void test_a_few_changes_open_the_look_for_missing_edges(void)
{
	block(401, 0);
	block(390, 10); /* a quarter of what is enough */
	block(350, 70);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_FLICKERS, watch.fault);
}

static void test_missing_edges_are_looked_for_in_three_blocks(void)
{
	params.encoder_watch_transitions_per_s = 1;
	params.overspeed_trip_edges_per_s = 1500;
	params.encoder_watch_ms = 10000;
	block(401, 0);
	block(400, 4);
	block(400, 4);
	block(400, 4);
	block(386, 4);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
}

/** 10 illegal transitions, as many as may be of a thousand, and so many others. */
static void ten_illegal_of(uint32_t others)
{
	quadrature.illegal_transitions += 10;
	ticks(1, 331 - (edges > 0), 330, others - 660);
}

static void test_the_share_of_illegal_transitions_is_that_of_a_thousand(void)
{
	ten_illegal_of(990);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
	ten_illegal_of(989); /* of the next thousand */
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
	quadrature.illegal_transitions++; /* and this is one too many */
	ticks(1, 0, 0, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_ILLEGAL, watch.fault);

	setUp();
	params.encoder_illegal_permille = 1000; /* not watched */
	quadrature.illegal_transitions += 1001;
	ticks(1, 0, 0, 0);
	assert_sound();
}

/** An index pulse after so many changes of a channel and so many edges. */
static void pulse_after(int channel, uint32_t lone, int32_t moved)
{
	ticks(1, moved, channel == A ? lone : 0, channel == B ? lone : 0);
	encoder_index.pulses++;
	ticks(20, 0, 0, 0);
}

/** Nothing but pulses is to be watched. */
static void watch_pulses_alone(void)
{
	setUp();
	params.encoder_watch_transitions_per_s = 60000;
	params.encoder_edges_per_pulse = 4;
}

/* Of an encoder of 360 pulses: from three to five of four quarters of the 720 changes. */
static void test_which_changes_between_pulses_are_a_revolution(void)
{
	static const uint32_t lone[4] = {540, 541, 899, 900};

	for (int channel = 0; channel < 2; channel++) {
		for (int i = 0; i < 4; i++) {
			const bool turned = i == 1 || i == 2;

			watch_pulses_alone();
			pulse_after(channel, lone[i], 0);
			TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
			pulse_after(channel, lone[i], 0);
			TEST_ASSERT_EQUAL(turned, watch.fault != LW_ENCODER_FAULT_NONE);
		}
		watch_pulses_alone(); /* each pulse begins anew */
		pulse_after(channel, 541, 0);
		pulse_after(channel, 540, 0);
		TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, watch.fault);
	}
}

static void test_pulses_with_a_quarter_of_the_edges_are_not_without(void)
{
	for (int sign = -1; sign <= 1; sign += 2) {
		for (int32_t moved = 89; moved <= 90; moved++) {
			watch_pulses_alone();
			ticks(1, sign, 0, 0); /* takes up the play */
			pulse_after(A, 720, sign * moved);
			pulse_after(A, 720, sign * moved);
			TEST_ASSERT_EQUAL(moved < 90, watch.fault != LW_ENCODER_FAULT_NONE);
		}
	}
}

static void test_pulses_without_edges_count_in_a_row(void)
{
	watch_pulses_alone();
	pulse_after(A, 720, 0);
	pulse_after(A, 720, 720);
	pulse_after(A, 720, 0);
	assert_sound();
	lw_drum_watch_index_begins(&watch);
	TEST_ASSERT_TRUE(lw_drum_watch_indexed(&watch, &encoder_index));
	pulse_after(A, 720, 0);
	assert_sound(); /* the indexing took back the one before */
	pulse_after(A, 720, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_B_STILL, watch.fault);

	lw_drum_watch_index_begins(&watch);
	pulse_after(A, 720, 0);
	TEST_ASSERT_TRUE(lw_drum_watch_indexed(&watch, &encoder_index)); /* one is none yet */
	pulse_after(A, 720, 0);
	pulse_after(A, 720, 0);
	lw_drum_watch_index_begins(&watch);
	pulse_after(A, 720, 0);
	pulse_after(A, 720, 0);
	TEST_ASSERT_FALSE(lw_drum_watch_indexed(&watch, &encoder_index));
}

/** Another index pulse, of a count that is so many edges off, and was with the pulse before. */
static enum lw_encoder_fault fault_of_misfit(int32_t misfit, int32_t before)
{
	encoder_index.misfit_edges = misfit;
	encoder_index.misfit_before_edges = before;
	encoder_index.pulses++;
	ticks(1, 0, 0, 0);
	return watch.fault;
}

static void test_misfits_are_judged_from_the_last_indexing_on(void)
{
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, fault_of_misfit(100, 101));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, fault_of_misfit(101, 100));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, fault_of_misfit(-100, -101));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, fault_of_misfit(-101, -100));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, fault_of_misfit(0, -101));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_INDEX_MISFIT, fault_of_misfit(101, 101));

	lw_drum_watch_index_begins(&watch);
	TEST_ASSERT_TRUE(lw_drum_watch_indexed(&watch, &encoder_index));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, fault_of_misfit(201, 201));
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NONE, fault_of_misfit(1, 1));
	lw_drum_watch_index_begins(&watch);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_INDEX_MISFIT, fault_of_misfit(0, 0));
	TEST_ASSERT_FALSE(watch.doubtful);
	TEST_ASSERT_FALSE(lw_drum_watch_indexed(&watch, &encoder_index)); /* met meanwhile */
}

static void test_a_drum_that_tells_nothing_is_a_fault_after_its_time(void)
{
	running = true;
	params.drum_watch_ms = 1000;
	ticks(999, 0, 0, 0);
	assert_sound();
	ticks(1, 0, 0, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NO_EDGES, watch.fault);

	setUp();
	running = true;
	params.drum_watch_ms = 1;
	ticks(1, 0, 0, 0);
	TEST_ASSERT_EQUAL_INT(LW_ENCODER_FAULT_NO_EDGES, watch.fault);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_a_turning_drum_is_sound_at_any_speed_and_in_any_decoding);
	RUN_TEST(test_a_channel_that_stands_is_doubted_then_a_fault);
	RUN_TEST(test_rocking_is_doubted_and_passes);
	RUN_TEST(test_the_masters_word_makes_a_doubt_a_fault);
	RUN_TEST(test_a_fast_drum_does_not_stop_or_start_at_once);
	RUN_TEST(test_a_loose_wire_hides_edges_and_chatter_does_not);
	RUN_TEST(test_too_many_illegal_transitions);
	RUN_TEST(test_index_pulses_without_edges);
	RUN_TEST(test_index_pulses_that_do_not_fit);
	RUN_TEST(test_a_drum_that_is_said_to_turn_and_tells_nothing);
	RUN_TEST(test_an_indexing_takes_back_what_was_before_it);
	RUN_TEST(test_a_drum_that_rocks_by_an_edge_does_not_go_on);
	RUN_TEST(test_so_many_changes_in_a_block_are_a_doubt);
	RUN_TEST(test_a_channel_flickers_where_the_drum_turns_or_both_change);
	RUN_TEST(test_a_doubt_is_a_fault_after_its_time_and_not_before);
	RUN_TEST(test_a_doubt_is_held_for_its_time);
	RUN_TEST(test_a_drum_that_was_fast_and_stands_has_a_dead_channel);
	RUN_TEST(test_a_drum_that_stood_and_is_fast_has_a_dead_channel);
	RUN_TEST(test_edges_are_missing_where_changes_explain_them);
	RUN_TEST(test_edges_that_a_brake_explains_are_not_missing);
	RUN_TEST(test_a_few_changes_open_the_look_for_missing_edges);
	RUN_TEST(test_missing_edges_are_looked_for_in_three_blocks);
	RUN_TEST(test_the_share_of_illegal_transitions_is_that_of_a_thousand);
	RUN_TEST(test_which_changes_between_pulses_are_a_revolution);
	RUN_TEST(test_pulses_with_a_quarter_of_the_edges_are_not_without);
	RUN_TEST(test_pulses_without_edges_count_in_a_row);
	RUN_TEST(test_misfits_are_judged_from_the_last_indexing_on);
	RUN_TEST(test_a_drum_that_tells_nothing_is_a_fault_after_its_time);
	return UNITY_END();
}
