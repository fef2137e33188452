/* SPDX-License-Identifier: Apache-2.0 */
/* Metres of rope: the formula in integers, what is told, and when it is doubtful. */
#include <errno.h>
#include <math.h>
#include <string.h>

#include <unity.h>

#include "law_check.h"
#include "storage_rig.h"

#define PI       3.14159265358979323846
#define CORE_UM  380000u
#define ROPE_UM  5000
#define PERMILLE 750

static const int32_t width_um = 164941; /* between the far points of the factory set */

static struct lw_rope_geometry geometry;

static void describe(struct lw_params *params)
{
	params->rope_diameter_um = ROPE_UM;
	params->drum_core_diameter_um = CORE_UM;
	params->rope_packing_permille = PERMILLE;
}

/** A device whose storage has described the drum. */
static void power_up_described(void)
{
	struct lw_params params = lw_params_default;
	uint8_t record[LW_PARAM_RECORD_SIZE];

	describe(&params);
	power_up(record, lw_param_record_encode(&params, 1, record));
}

static void tell(int32_t mm)
{
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_SET_ROPE_MM, mm));
	command(LW_COMMAND_SET_ROPE);
	assert_command(LW_COMMAND_SET_ROPE, LW_RESULT_DONE, LW_REASON_NONE);
	rig_tick();
}

static void wind(int64_t edges)
{
	rig_drive(edges);
	rig_rest();
}

void setUp(void)
{
	rig_prepare(0);
	geometry = lw_rope_geometry(CORE_UM, ROPE_UM, PERMILLE, width_um);
	geometry.edges = 2880;
	geometry.revs = 1;
}

void tearDown(void)
{
}

/** L(N) in real numbers. */
static double real_um(double turns, double core_um, double rope_um, double packing, double width)
{
	const double c = rope_um * rope_um / (4 * packing * width);

	return PI * core_um * turns + PI * PI * c * turns * turns;
}

static void test_the_integers_are_as_near_to_the_formula_as_is_said(void)
{
	static const struct {
		uint32_t core_um;
		int32_t rope_um;
		int32_t permille;
		int32_t width_um;
	} drums[] = {{CORE_UM, ROPE_UM, PERMILLE, 164941},
		     {5000000, 50000, 100, 50000},
		     {1000, 1000, 1000, 600000},
		     {200000, 500, 907, 30000},
		     {1, 1, 100, 1}};
	uint64_t seed = 1;

	for (size_t i = 0; i < sizeof(drums) / sizeof(drums[0]); i++) {
		const struct lw_rope_geometry g = lw_rope_geometry(
			drums[i].core_um, drums[i].rope_um, drums[i].permille, drums[i].width_um);

		for (int n = 0; n < 1000; n++) {
			const int64_t turns_q16 = next_random(&seed) % (3000u * LW_ROPE_TURN);
			const double turns = (double)turns_q16 / LW_ROPE_TURN;
			const double um = real_um(turns, drums[i].core_um, drums[i].rope_um,
						  drums[i].permille / 1000.0, drums[i].width_um);
			const double error = (double)lw_rope_length_um(&g, turns_q16) - um;

			if (um > (double)LW_ROPE_LENGTH_MAX_UM) {
				continue;
			}
			TEST_ASSERT_TRUE(fabs(error) <= um * 2e-7 + turns * turns * 1e-5 +
								PI * drums[i].core_um / 65000 + 1);
		}
	}
}

static void test_a_length_and_back_is_the_same_to_the_millimetre(void)
{
	int64_t before_q16 = -1;

	for (int32_t mm = 0; mm <= 1200000; mm += 997) {
		int64_t turns_q16;

		TEST_ASSERT_EQUAL_INT(0,
				      lw_rope_turns_q16(&geometry, (int64_t)mm * 1000, &turns_q16));
		TEST_ASSERT_TRUE(turns_q16 > before_q16);
		TEST_ASSERT_TRUE(lw_rope_length_um(&geometry, turns_q16) >= (int64_t)mm * 1000);
		TEST_ASSERT_TRUE(turns_q16 == 0 ||
				 lw_rope_length_um(&geometry, turns_q16 - 1) < (int64_t)mm * 1000);
		before_q16 = turns_q16;
	}
}

static void test_beyond_all_rope_it_stops_at_the_limit(void)
{
	const struct lw_rope_geometry thin = lw_rope_geometry(1, 1, 1000, 600000);
	int64_t turns_q16;

	TEST_ASSERT_EQUAL_INT64(LW_ROPE_LENGTH_MAX_UM,
				lw_rope_length_um(&geometry, (int64_t)2000000 * LW_ROPE_TURN));
	TEST_ASSERT_EQUAL_INT64(-LW_ROPE_LENGTH_MAX_UM,
				lw_rope_length_um(&geometry, (int64_t)-2000000 * LW_ROPE_TURN));
	TEST_ASSERT_EQUAL_INT64(LW_ROPE_LENGTH_MAX_UM,
				lw_rope_length_um(&geometry, (int64_t)1000000 * LW_ROPE_TURN));
	geometry.core_um_q16 *= 100;
	TEST_ASSERT_EQUAL_INT64(-LW_ROPE_LENGTH_MAX_UM,
				lw_rope_length_um(&geometry, (int64_t)-1000000 * LW_ROPE_TURN));
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_rope_turns_q16(&thin, 10000000000, &turns_q16));
	/* And nothing overflows. */
	(void)lw_rope_radius_um(&geometry, INT64_MAX);
	(void)lw_rope_moved_um(&geometry, INT64_MAX, 10000000);
	TEST_ASSERT_EQUAL_INT32(0, lw_rope_layer(&geometry, INT64_MIN));
}

static void test_radius_and_layers_grow_with_the_turns(void)
{
	/* c = 25 / (4 * 0.75 * 164.941) = 0.05052 mm: 31.5 turns make a layer of 5 mm. */
	TEST_ASSERT_EQUAL_INT64(190000, lw_rope_radius_um(&geometry, 0));
	TEST_ASSERT_EQUAL_INT64(190000, lw_rope_radius_um(&geometry, -LW_ROPE_TURN));
	TEST_ASSERT_INT64_WITHIN(1, 205873, lw_rope_radius_um(&geometry, 100 * LW_ROPE_TURN));
	TEST_ASSERT_EQUAL_INT32(0, lw_rope_layer(&geometry, 0));
	TEST_ASSERT_EQUAL_INT32(1, lw_rope_layer(&geometry, 1));
	TEST_ASSERT_EQUAL_INT32(1, lw_rope_layer(&geometry, 31 * LW_ROPE_TURN));
	TEST_ASSERT_EQUAL_INT32(2, lw_rope_layer(&geometry, 32 * LW_ROPE_TURN));
	TEST_ASSERT_EQUAL_INT32(4, lw_rope_layer(&geometry, 100 * LW_ROPE_TURN));
	/* A turn's worth of edges. */
	TEST_ASSERT_INT64_WITHIN(10, 1293538,
				 lw_rope_moved_um(&geometry, 100 * LW_ROPE_TURN, 2880));
	TEST_ASSERT_INT64_WITHIN(10, -1293538,
				 lw_rope_moved_um(&geometry, 100 * LW_ROPE_TURN, -2880));
}

static void test_without_the_parameters_all_is_as_it_was(void)
{
	power_up(NULL, 0);
	assert_command_refused(LW_COMMAND_SET_ROPE, LW_REASON_ROPE_NOT_DESCRIBED);
	wind(28800);
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_DOUBTFUL));
	TEST_ASSERT_EQUAL_INT32(24000, status()->rope_mm);
	TEST_ASSERT_EQUAL_INT32(0, status()->rope_on_drum_mm);
	TEST_ASSERT_EQUAL_INT32(0, status()->rope_layer);
	TEST_ASSERT_EQUAL_UINT32(0, status()->rope_radius_um);
	/* Any of the three that is missing is enough. */
	for (int missing = 0; missing < 3; missing++) {
		describe(&rig.params);
		*(missing == 0   ? &rig.params.rope_diameter_um
		  : missing == 1 ? (int32_t *)&rig.params.drum_core_diameter_um
				 : &rig.params.rope_packing_permille) = 0;
		TEST_ASSERT_EQUAL_INT(0, lw_params_derive(&rig.params, &rig.derived, &why));
		TEST_ASSERT_EQUAL_INT64(0, lw_params_rope(&rig.params, &rig.derived).core_um_q16);
	}
}

static void test_it_is_doubtful_until_it_is_told(void)
{
	power_up_described();
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_DOUBTFUL));
	wind(28800);
	TEST_ASSERT_EQUAL_INT32(24000, status()->rope_mm);
	TEST_ASSERT_EQUAL_INT32(0, status()->rope_on_drum_mm);
	assert_command_refused(LW_COMMAND_SET_ROPE, LW_REASON_ROPE_LENGTH_MISSING);
	tell(950000);
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_DOUBTFUL));
	TEST_ASSERT_EQUAL_INT32(950000, status()->rope_on_drum_mm);
	TEST_ASSERT_EQUAL_INT32(0, status()->rope_out_mm);
}

static void test_winding_out_and_in_again_comes_back_exactly(void)
{
	power_up_described();
	tell(950000);

	const int32_t layers = status()->rope_layer;

	wind(-1000000);
	TEST_ASSERT_TRUE(status()->rope_out_mm > 500000);
	TEST_ASSERT_EQUAL_INT32(950000, status()->rope_out_mm + status()->rope_on_drum_mm);
	TEST_ASSERT_TRUE(status()->rope_layer < layers);
	wind(700001);
	wind(300002);
	wind(-3);
	TEST_ASSERT_EQUAL_INT32(0, status()->rope_out_mm);
	TEST_ASSERT_EQUAL_INT32(950000, status()->rope_on_drum_mm);
	TEST_ASSERT_EQUAL_INT32(0, status()->rope_mm);
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_DOUBTFUL));
}

static void test_the_rope_speed_is_that_of_the_radius(void)
{
	power_up_described();
	tell(950000);
	rig.drum_edges_per_s = 28800;
	rig_ticks(200);

	const double mm_per_s = 2 * PI * (double)status()->rope_radius_um / 1000 * 10;

	TEST_ASSERT_INT32_WITHIN(80, (int32_t)mm_per_s, status()->rope_speed_mm_per_s);
	TEST_ASSERT_TRUE(status()->rope_speed_mm_per_s > 14000); /* a bare drum: 11,938 */
	assert_command_refused(LW_COMMAND_SET_ROPE, LW_REASON_DRUM_MOVING);
	rig.controller->drum_watch.doubtful = true;
	assert_command_refused(LW_COMMAND_SET_ROPE, LW_REASON_ENCODER_DOUBTFUL);
}

static void test_more_than_fits_is_refused_whole(void)
{
	struct lw_params params = lw_params_default;
	uint8_t record[LW_PARAM_RECORD_SIZE];

	params.rope_diameter_um = 1;
	params.drum_core_diameter_um = 1;
	params.rope_packing_permille = 1000;
	power_up(record, lw_param_record_encode(&params, 1, record));
	TEST_ASSERT_EQUAL_INT(0, write_pair(LW_ADDRESS_SET_ROPE_MM, 10000000));
	command(LW_COMMAND_SET_ROPE);
	assert_command(LW_COMMAND_SET_ROPE, LW_RESULT_REFUSED, LW_REASON_ROPE_TOO_LONG);
	TEST_ASSERT_EQUAL_INT32(LW_ADDRESS_SET_ROPE_MM, status()->command_address);
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_DOUBTFUL));
}

static void test_lost_edges_make_it_doubtful_until_it_is_told_anew(void)
{
	power_up_described();
	tell(950000);
	rig.controller->los.encoder.set = true;
	rig_tick();
	rig.controller->los.encoder.set = false;
	rig_tick();
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_DOUBTFUL));
	tell(950000);
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_DOUBTFUL));
	rig.controller->odometer_doubtful = true;
	rig_tick();
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_DOUBTFUL));
	rig.controller->odometer_doubtful = false;
	tell(1000);
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_DOUBTFUL));
	/* More comes off than there was. */
	wind(-2880);
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_DOUBTFUL));
	wind(-2880);
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_DOUBTFUL));
	TEST_ASSERT_INT32_WITHIN(2, 1000 - 2387, status()->rope_on_drum_mm);
}

/** Do the writes that are due. @return how many */
static int write_all(void)
{
	int writes = 0;

	while (rig_write_slot(0) >= 0) {
		writes++;
		rig_tick();
	}
	return writes;
}

static void restart(void)
{
	power_cut();
	rig_ticks(300);
}

static void test_a_power_cut_keeps_it_and_makes_it_doubtful(void)
{
	power_up_described();
	(void)lw_param_record_encode(&rig.device.active, 1, rig.slots[0]);
	tell(950000);
	wind(-345678);

	const int32_t on_drum_mm = status()->rope_on_drum_mm;

	TEST_ASSERT_TRUE(write_all() > 0);
	restart();
	TEST_ASSERT_EQUAL_INT32(on_drum_mm, status()->rope_on_drum_mm);
	TEST_ASSERT_EQUAL_INT32(950000 - on_drum_mm, status()->rope_out_mm);
	TEST_ASSERT_EQUAL_INT32(0, status()->rope_mm);
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_DOUBTFUL));
	wind(345678);
	TEST_ASSERT_EQUAL_INT32(950000, status()->rope_on_drum_mm);
	/* Once more, and across a set that does not describe the drum. */
	TEST_ASSERT_TRUE(write_all() > 0);
	(void)lw_param_record_encode(&lw_params_default, 1, rig.slots[0]);
	restart();
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_DOUBTFUL));
	TEST_ASSERT_EQUAL_INT32(0, status()->rope_on_drum_mm);
	(void)lw_param_record_encode(&rig.device.active, 1, rig.slots[0]);
	restart();
	(void)write_all();
	TEST_ASSERT_EQUAL_INT32(950000, rig.controller->rope_length.told_mm);
}

static void test_other_parameters_keep_what_was_told_where_it_was_told(void)
{
	power_up_described();
	tell(950000);
	wind(-288000);

	const int32_t before_mm = status()->rope_on_drum_mm;

	/* A looser packing: thicker at 950 m, so 100 turns are more. */
	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_ROPE_PACKING_PERMILLE, 600));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);
	TEST_ASSERT_TRUE(status()->rope_on_drum_mm < before_mm);
	wind(288000);
	TEST_ASSERT_EQUAL_INT32(950000, status()->rope_on_drum_mm);
	TEST_ASSERT_FALSE(flag(LW_FLAG_ROPE_DOUBTFUL));

	/* Another encoder: the turns stay. */
	wind(-288000);
	TEST_ASSERT_EQUAL_INT64(
		-100 * LW_ROPE_TURN,
		lw_rope_length_since_q16(&rig.controller->rope_length, status()->net_edges));

	TEST_ASSERT_EQUAL_INT(0, write_register(LW_ADDRESS_ENCODER_EDGES_PER_PULSE, 4));
	command(LW_COMMAND_APPLY);
	assert_command(LW_COMMAND_APPLY, LW_RESULT_DONE, LW_REASON_NONE);
	TEST_ASSERT_EQUAL_INT64(
		-100 * LW_ROPE_TURN,
		lw_rope_length_since_q16(&rig.controller->rope_length, status()->net_edges));

	/* A drum that never holds so much. */
	struct lw_rope_length *rope = &rig.controller->rope_length;
	struct lw_rope_geometry thin = lw_rope_geometry(1, 1, 1000, 600000);

	thin.edges = 2880;
	thin.revs = 1;
	rope->told_mm = 10000000;
	lw_rope_length_configure(rope, &thin, 0);
	TEST_ASSERT_TRUE(flag(LW_FLAG_ROPE_DOUBTFUL));
}

static void test_a_record_of_older_firmware_has_no_rope(void)
{
	const struct lw_look look = {.causes = 3, .rope_told = 1, .rope_told_mm = 7};
	struct lw_look read;
	struct lw_record record;
	uint8_t bytes[LW_LOOK_RECORD_SIZE];
	uint8_t older[LW_LOOK_RECORD_SIZE];
	const size_t length = 3 * 4 + 8 * 6;

	TEST_ASSERT_EQUAL_UINT64(LW_LOOK_RECORD_SIZE, lw_look_record_encode(&look, 9, bytes));
	TEST_ASSERT_EQUAL_INT(0, lw_look_record_decode(bytes, sizeof(bytes), &read, &record));
	TEST_ASSERT_EQUAL_MEMORY(&look, &read, sizeof(look));

	/* Six marks, and nothing behind them. */
	memcpy(older + LW_RECORD_HEAD_SIZE, bytes + LW_RECORD_HEAD_SIZE, length);
	(void)lw_record_seal(older, "LWRL", LW_LOOK_RECORD_SCHEMA, 9, length);
	TEST_ASSERT_EQUAL_INT(0, lw_look_record_decode(older, sizeof(older), &read, &record));
	TEST_ASSERT_EQUAL_UINT32(3, read.causes);
	TEST_ASSERT_EQUAL_UINT32(0, read.rope_told);
	TEST_ASSERT_EQUAL_INT32(0, read.rope_told_mm);
}

static void test_a_thin_drum_is_counted_up_to_the_most_turns(void)
{
	const int64_t most = INT64_C(1048576) * LW_ROPE_TURN;
	struct lw_rope_geometry thin = lw_rope_geometry(1000, 1, 1000, 1000000);
	int64_t turns_q16 = 0;

	thin.growth_um_q16 = 0;
	FOR_BOTH_WAYS(way) {
		/* 3.1416 mm a turn: 3.3 km, of 2147 that the numbers hold. */
		TEST_ASSERT_INT64_WITHIN(1000, way * INT64_C(3294195817),
					 lw_rope_length_um(&thin, way * (most - LW_ROPE_TURN)));
		TEST_ASSERT_EQUAL_INT64(way * LW_ROPE_LENGTH_MAX_UM,
					lw_rope_length_um(&thin, way * most));
	}

	const int64_t longest_um = lw_rope_length_um(&thin, most - 1);

	TEST_ASSERT_EQUAL_INT(0, lw_rope_turns_q16(&thin, longest_um, &turns_q16));
	TEST_ASSERT_INT64_WITHIN(LW_ROPE_TURN, most, turns_q16);
	TEST_ASSERT_EQUAL_INT(-ERANGE, lw_rope_turns_q16(&thin, longest_um + 1, &turns_q16));
	TEST_ASSERT_EQUAL_INT64(most - 1, turns_q16);
}

static void test_the_drum_grows_within_a_turn_too(void)
{
	struct lw_rope_geometry thick = geometry;

	thick.growth_um_q16 = 10000 * LW_ROPE_TURN; /* 10 mm of rope a turn, twice that of drum */
	TEST_ASSERT_INT64_WITHIN(1, (380000 * PI + 20000 * 7) / (2 * PI),
				 lw_rope_radius_um(&thick, 7 * LW_ROPE_TURN));
	TEST_ASSERT_INT64_WITHIN(1, (380000 * PI + 20000 * 7.75) / (2 * PI),
				 lw_rope_radius_um(&thick, 31 * LW_ROPE_TURN / 4));
}

static void test_a_geared_encoder_tells_parts_of_turns(void)
{
	struct lw_rope_length rope = {.geometry = geometry};

	rope.geometry.edges = 1000;
	rope.geometry.revs = 3;
	TEST_ASSERT_EQUAL_INT64(3 * LW_ROPE_TURN, lw_rope_length_since_q16(&rope, 1000));
	TEST_ASSERT_EQUAL_INT64(3 * LW_ROPE_TURN / 2, lw_rope_length_since_q16(&rope, 500));
	TEST_ASSERT_EQUAL_INT64(-3 * LW_ROPE_TURN / 2, lw_rope_length_since_q16(&rope, -500));
	TEST_ASSERT_INT64_WITHIN(2, 380000 * PI * 1.5, lw_rope_moved_um(&rope.geometry, 0, 500));
}

static void test_a_turn_off_the_bare_drum_is_not_doubtful_more_is(void)
{
	struct lw_rope_length rope = {.geometry = geometry};

	TEST_ASSERT_EQUAL_INT(0, lw_rope_length_tell(&rope, 0, 0));
	lw_rope_length_tick(&rope, -2880, false);
	TEST_ASSERT_FALSE(lw_rope_length_doubtful(&rope));
	lw_rope_length_tick(&rope, -2881, false);
	TEST_ASSERT_TRUE(lw_rope_length_doubtful(&rope));
}

static void test_growth_is_rounded_to_its_last_bit(void)
{
	static const struct {
		int32_t rope_um;
		int32_t permille;
		int32_t width_um;
	} drums[] = {{5000, 750, 164941},
		     {8000, 700, 123457},
		     {6500, 820, 99991},
		     {12000, 650, 54321},
		     {4300, 610, 87654}};

	for (size_t i = 0; i < sizeof(drums) / sizeof(drums[0]); i++) {
		const double exact = 126025.0 / 12769 * drums[i].rope_um * drums[i].rope_um * 250 *
				     65536 / drums[i].permille / drums[i].width_um;
		const struct lw_rope_geometry drum = lw_rope_geometry(
			CORE_UM, drums[i].rope_um, drums[i].permille, drums[i].width_um);

		TEST_ASSERT_EQUAL_INT64(llround(exact), drum.growth_um_q16);
	}
}

static void test_the_limit_is_all_rope_that_a_turn_more_would_pass(void)
{
	geometry.growth_um_q16 = 0;
	geometry.core_um_q16 = LW_ROPE_LENGTH_MAX_UM / 2 * LW_ROPE_TURN;
	TEST_ASSERT_EQUAL_INT64(LW_ROPE_LENGTH_MAX_UM, lw_rope_length_um(&geometry, LW_ROPE_TURN));
	geometry.core_um_q16 -= LW_ROPE_TURN;
	TEST_ASSERT_EQUAL_INT64(LW_ROPE_LENGTH_MAX_UM / 2 - 1,
				lw_rope_length_um(&geometry, LW_ROPE_TURN));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_the_integers_are_as_near_to_the_formula_as_is_said);
	RUN_TEST(test_a_length_and_back_is_the_same_to_the_millimetre);
	RUN_TEST(test_beyond_all_rope_it_stops_at_the_limit);
	RUN_TEST(test_radius_and_layers_grow_with_the_turns);
	RUN_TEST(test_without_the_parameters_all_is_as_it_was);
	RUN_TEST(test_it_is_doubtful_until_it_is_told);
	RUN_TEST(test_winding_out_and_in_again_comes_back_exactly);
	RUN_TEST(test_the_rope_speed_is_that_of_the_radius);
	RUN_TEST(test_more_than_fits_is_refused_whole);
	RUN_TEST(test_lost_edges_make_it_doubtful_until_it_is_told_anew);
	RUN_TEST(test_a_power_cut_keeps_it_and_makes_it_doubtful);
	RUN_TEST(test_other_parameters_keep_what_was_told_where_it_was_told);
	RUN_TEST(test_a_record_of_older_firmware_has_no_rope);
	RUN_TEST(test_a_thin_drum_is_counted_up_to_the_most_turns);
	RUN_TEST(test_the_drum_grows_within_a_turn_too);
	RUN_TEST(test_a_geared_encoder_tells_parts_of_turns);
	RUN_TEST(test_a_turn_off_the_bare_drum_is_not_doubtful_more_is);
	RUN_TEST(test_growth_is_rounded_to_its_last_bit);
	RUN_TEST(test_the_limit_is_all_rope_that_a_turn_more_would_pass);
	return UNITY_END();
}
