/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The C client against a live controller, whose serial port is in the environment variable
 * LEVELWIND_PORT (8N1, unit 1). It may be the simulator or hardware: the carriage moves.
 */
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "faulty_line.h"
#include "levelwind_client.h"
#include "unity.h"

#define COMMAND_MS  5000
#define INDEXING_MS 120000
#define WAIT_READS  2000
#define ANSWER_MS   200  /* time-out where answers are lost */
#define MUTE_MS     2000 /* how long the controller may be mute */

static struct levelwind_client client;
static struct levelwind_status status;
static struct levelwind_command_result result;
static struct faulty_line line;
static bool line_is_open;

/* A call must succeed; if not, the client says why. */
#define TEST_OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(0, (call), levelwind_last_error_text(&client))

static void assert_error_text_has(const char *part)
{
	if (strstr(levelwind_last_error_text(&client), part) == NULL) {
		TEST_ASSERT_EQUAL_STRING(part, levelwind_last_error_text(&client));
	}
}

static int command(enum levelwind_command code)
{
	return levelwind_command(&client, code, COMMAND_MS, &result);
}

static int32_t parameter(const char *name, enum levelwind_set set)
{
	int32_t value = 0;

	TEST_OK(levelwind_get_parameter(&client, name, set, &value));
	return value;
}

static bool has_flag(enum levelwind_flag flag)
{
	return levelwind_has_flag(&status, flag);
}

/* From here on the client's bytes go through `line`. */
static void go_through_the_faulty_line(void)
{
	struct levelwind_line through = client.line;

	levelwind_disconnect(&client);
	faulty_line_open(&line, getenv("LEVELWIND_PORT"));
	line_is_open = true;
	through.port = line.port;
	through.response_timeout_ms = ANSWER_MS;
	TEST_OK(levelwind_connect(&client, &through));
	TEST_OK(levelwind_identify(&client, &status));
}

/* After a restart. */
static void wait_for_answers(void)
{
	int error = -ETIMEDOUT;

	for (int i = 0; error != 0 && i < 50; i++) {
		error = levelwind_identify(&client, &status);
	}
	TEST_OK(error);
}

static uint16_t command_sequence(void)
{
	uint16_t sequence;

	TEST_ASSERT_EQUAL_INT(1, modbus_read_input_registers(client.modbus,
							     LEVELWIND_ADDRESS_COMMAND_SEQUENCE, 1,
							     &sequence));
	return sequence;
}

static void wait_for_state(enum levelwind_state state)
{
	for (int i = 0; i < WAIT_READS && status.state != (int32_t)state; i++) {
		TEST_OK(levelwind_read_live(&client, &status));
	}
	TEST_ASSERT_EQUAL_STRING(levelwind_value_text("state", (int32_t)state),
				 levelwind_value_text("state", status.state));
}

/* Every test begins with factory values, staged and active, and without stepper current. */
void setUp(void)
{
	struct levelwind_line straight = {.port = getenv("LEVELWIND_PORT"), .parity = 'N'};

	TEST_OK(levelwind_connect(&client, &straight));
	TEST_OK(levelwind_identify(&client, &status));
	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_OFF));
	wait_for_answers(); /* the flash may be written after what the test before did */
	TEST_OK(levelwind_read_status(&client, &status));
	wait_for_state(LEVELWIND_STATE_OFF);
	TEST_OK(levelwind_set_trim(&client, 0, 0));
	TEST_OK(command(LEVELWIND_COMMAND_FACTORY_ALL));
	TEST_OK(command(LEVELWIND_COMMAND_APPLY));
}

void tearDown(void)
{
	levelwind_disconnect(&client);
	if (line_is_open) {
		faulty_line_close(&line);
		line_is_open = false;
	}
}

static void test_a_port_that_does_not_exist_is_named(void)
{
	struct levelwind_line other = {.port = "/dev/no-such-port"};

	levelwind_disconnect(&client);
	TEST_ASSERT_EQUAL_INT(-ENOENT, levelwind_connect(&client, &other));
	assert_error_text_has("/dev/no-such-port");
	setUp();
}

static void test_a_silent_unit_times_out_and_is_named(void)
{
	struct levelwind_line other = client.line;

	levelwind_disconnect(&client);
	other.unit_id = 77;
	other.response_timeout_ms = 100;
	TEST_OK(levelwind_connect(&client, &other));
	TEST_ASSERT_EQUAL_INT(-ETIMEDOUT, levelwind_identify(&client, &status));
	assert_error_text_has("unit 77");
	assert_error_text_has("100 ms");
}

static void test_an_impossible_unit_id_is_refused(void)
{
	struct levelwind_line other = client.line;

	levelwind_disconnect(&client);
	other.unit_id = 248;
	TEST_ASSERT_EQUAL_INT(-EINVAL, levelwind_connect(&client, &other));
	assert_error_text_has("248");
	setUp();
}

static void test_identify_reads_the_self_test_and_versions(void)
{
	memset(&status, 0xA5, sizeof(status));
	TEST_OK(levelwind_identify(&client, &status));
	TEST_ASSERT_EQUAL_HEX32(LEVELWIND_SELF_TEST, status.self_test);
	TEST_ASSERT_EQUAL_INT(LEVELWIND_MAP_VERSION, status.map_version);
	TEST_ASSERT_NOT_EQUAL(0, levelwind_value_text("host", status.host)[0]);
}

static void test_the_status_is_whole_and_consistent(void)
{
	struct levelwind_status later;

	memset(&status, 0xA5, sizeof(status));
	TEST_OK(levelwind_read_status(&client, &status));
	TEST_ASSERT_EQUAL_INT(LEVELWIND_STATE_OFF, status.state);
	TEST_ASSERT_EQUAL_INT(LEVELWIND_MODE_OFF, status.active_mode);
	TEST_ASSERT_TRUE(status.launch_inhibit & 1 << LEVELWIND_LAUNCH_INHIBIT_NOT_TRACKING);
	TEST_ASSERT_FALSE(has_flag(LEVELWIND_FLAG_LAUNCH_PERMIT));
	TEST_ASSERT_EQUAL_INT(LEVELWIND_COMMAND_APPLY, status.command_code);
	TEST_ASSERT_EQUAL_INT(LEVELWIND_RESULT_DONE, status.command_result);
	TEST_ASSERT_EQUAL_INT(23, status.ka);
	TEST_ASSERT_EQUAL_INT(1187, status.nr);
	TEST_ASSERT_EQUAL_INT(23 * 1187, status.ks);
	TEST_ASSERT_EQUAL_INT(-8000, status.reversal_minus_usteps);

	TEST_OK(levelwind_read_status(&client, &later));
	TEST_ASSERT_GREATER_THAN_UINT32(status.requests, later.requests);
}

static void test_the_live_status_is_one_request(void)
{
	struct levelwind_status live;
	uint32_t requests;
	uint32_t whole;

	TEST_OK(levelwind_read_status(&client, &status));
	requests = status.requests;
	TEST_OK(levelwind_read_status(&client, &status));
	whole = status.requests - requests;
	memset(&live, 0xA5, sizeof(live));
	TEST_OK(levelwind_read_live(&client, &live));
	TEST_OK(levelwind_read_status(&client, &status));
	TEST_ASSERT_EQUAL_UINT32(requests + 2 * whole + 1, status.requests);

	TEST_ASSERT_EQUAL_INT(LEVELWIND_STATE_OFF, live.state);
	TEST_ASSERT_EQUAL_INT(status.fault, live.fault);
	TEST_ASSERT_EQUAL_HEX32(status.flags, live.flags);
	TEST_ASSERT_EQUAL_HEX32(status.flags_2, live.flags_2);
	TEST_ASSERT_EQUAL_INT(status.launch_inhibit, live.launch_inhibit);
	TEST_ASSERT_EQUAL_INT(status.position_um, live.position_um);
	TEST_ASSERT_EQUAL_INT(status.rope_speed_mm_per_s, live.rope_speed_mm_per_s);
	TEST_ASSERT_EQUAL_INT64(status.net_edges, live.net_edges);
	TEST_ASSERT_EQUAL_INT(status.span_error_um, live.span_error_um);
	TEST_ASSERT_EQUAL_HEX32(0xA5A5A5A5, live.requests); /* untouched */
}

/* The flags of one register pair, of which bit 0 is the flag `first`. */
static void assert_flags_of(const char *pair_name, uint32_t *pair, int first)
{
	const struct levelwind_point *point = levelwind_find_point(pair_name);

	TEST_ASSERT_NOT_EQUAL(0, point->value_count);
	for (size_t i = 0; i < point->value_count; i++) {
		enum levelwind_flag flag = (enum levelwind_flag)(first + (int)i);

		memset(&status, 0, sizeof(status));
		TEST_ASSERT_FALSE(has_flag(flag));
		*pair = 1u << i;
		TEST_ASSERT_TRUE(has_flag(flag));
		TEST_ASSERT_EQUAL_STRING(point->values[i].text, levelwind_flag_text(flag));
	}
}

static void test_every_flag_of_both_pairs_has_a_text_and_is_found(void)
{
	assert_flags_of("flags", &status.flags, 0);
	assert_flags_of("flags_2", &status.flags_2, LEVELWIND_FLAG_SET_UNCONFIRMED);
}

static void test_factory_values_are_those_of_the_map(void)
{
	for (size_t i = 0; i < LEVELWIND_POINT_COUNT; i++) {
		const struct levelwind_point *point = &levelwind_points[i];

		if (point->block == LEVELWIND_BLOCK_PARAMETERS) {
			TEST_ASSERT_EQUAL_INT_MESSAGE(point->default_value,
						      parameter(point->name, LEVELWIND_SET_ACTIVE),
						      point->name);
		}
	}
}

static void test_a_parameter_is_staged_applied_and_saved(void)
{
	TEST_OK(command(LEVELWIND_COMMAND_SAVE));
	TEST_OK(levelwind_set_parameter(&client, "rope_per_drum_rev_um", 2345678));
	TEST_OK(levelwind_set_parameter(&client, "centre_position_um", -70001));
	TEST_ASSERT_EQUAL_INT(2345678, parameter("rope_per_drum_rev_um", LEVELWIND_SET_STAGED));
	TEST_ASSERT_EQUAL_INT(-70001, parameter("centre_position_um", LEVELWIND_SET_STAGED));
	TEST_ASSERT_EQUAL_INT(0, parameter("centre_position_um", LEVELWIND_SET_ACTIVE));
	TEST_OK(levelwind_read_status(&client, &status));
	TEST_ASSERT_TRUE(has_flag(LEVELWIND_FLAG_STAGED));
	TEST_ASSERT_FALSE(has_flag(LEVELWIND_FLAG_DIRTY));

	TEST_OK(command(LEVELWIND_COMMAND_APPLY));
	TEST_ASSERT_EQUAL_INT(-70001, parameter("centre_position_um", LEVELWIND_SET_ACTIVE));
	TEST_ASSERT_EQUAL_INT(0, parameter("centre_position_um", LEVELWIND_SET_STORED));
	TEST_OK(levelwind_read_status(&client, &status));
	TEST_ASSERT_FALSE(has_flag(LEVELWIND_FLAG_STAGED));
	TEST_ASSERT_TRUE(has_flag(LEVELWIND_FLAG_DIRTY));

	TEST_OK(command(LEVELWIND_COMMAND_SAVE));
	TEST_ASSERT_EQUAL_INT(-70001, parameter("centre_position_um", LEVELWIND_SET_STORED));
	TEST_ASSERT_EQUAL_INT(2345678, parameter("rope_per_drum_rev_um", LEVELWIND_SET_STORED));
}

static void test_revert_drops_what_is_staged(void)
{
	TEST_OK(levelwind_set_parameter(&client, "pitch_um", 11000));
	TEST_OK(command(LEVELWIND_COMMAND_REVERT));
	TEST_ASSERT_EQUAL_INT(12000, parameter("pitch_um", LEVELWIND_SET_STAGED));
}

static void test_a_value_outside_its_limits_is_not_sent(void)
{
	TEST_OK(levelwind_read_status(&client, &status));

	uint32_t exceptions = status.exceptions;

	TEST_ASSERT_EQUAL_INT(-EINVAL, levelwind_set_parameter(&client, "pitch_um", 100001));
	assert_error_text_has("pitch_um = 100001");
	assert_error_text_has("10 to 100000 um");
	TEST_ASSERT_EQUAL_INT(-EINVAL, levelwind_set_parameter(&client, "pitch_um", 9));
	TEST_ASSERT_EQUAL_INT(-EINVAL,
			      levelwind_set_parameter(&client, "encoder_edges_per_pulse", 3));
	assert_error_text_has("1, 2, 4");
	TEST_ASSERT_EQUAL_INT(-EINVAL, levelwind_set_trim(&client, 0, -20001));
	assert_error_text_has("trim_minus_um = -20001");
	TEST_ASSERT_EQUAL_INT(-EINVAL, levelwind_jog(&client, 2));
	TEST_ASSERT_EQUAL_INT(-EINVAL, levelwind_set_mode(&client, (enum levelwind_mode)3));
	TEST_ASSERT_EQUAL_INT(-EINVAL, command((enum levelwind_command)99));
	TEST_ASSERT_EQUAL_INT(-EINVAL, command(LEVELWIND_COMMAND_NONE));

	TEST_OK(levelwind_read_status(&client, &status));
	TEST_ASSERT_EQUAL_UINT32(exceptions, status.exceptions);
}

static void test_a_name_that_is_no_parameter_is_refused(void)
{
	int32_t value;

	TEST_ASSERT_EQUAL_INT(-ENOENT, levelwind_set_parameter(&client, "pitch", 1));
	assert_error_text_has("pitch");
	TEST_ASSERT_EQUAL_INT(-ENOENT, levelwind_set_parameter(&client, "position_um", 1));
	TEST_ASSERT_EQUAL_INT(
		-ENOENT, levelwind_get_parameter(&client, "state", LEVELWIND_SET_ACTIVE, &value));
}

static void test_a_set_that_does_not_fit_together_is_refused_and_explained(void)
{
	TEST_OK(levelwind_set_parameter(&client, "park_at", LEVELWIND_PARK_AT_POSITION));
	TEST_OK(levelwind_set_parameter(&client, "park_position_um", 90000));
	TEST_ASSERT_EQUAL_INT(-EPERM, command(LEVELWIND_COMMAND_APPLY));
	TEST_ASSERT_EQUAL_INT(LEVELWIND_RESULT_REFUSED, result.result);
	TEST_ASSERT_EQUAL_INT(LEVELWIND_REASON_PARK_OUTSIDE, result.reason);
	TEST_ASSERT_EQUAL_INT(LEVELWIND_ADDRESS_PARK_POSITION_UM, result.address);
	TEST_ASSERT_EQUAL_INT(90000, result.value);
	assert_error_text_has("apply refused");
	assert_error_text_has(
		levelwind_value_text("command_reason", LEVELWIND_REASON_PARK_OUTSIDE));
	assert_error_text_has("park_position_um: value 90000");
	TEST_ASSERT_EQUAL_INT(0, parameter("park_position_um", LEVELWIND_SET_ACTIVE));
}

static void test_the_write_lock_opens_by_its_code(void)
{
	TEST_OK(levelwind_set_parameter(&client, "lock_code", 4711));
	TEST_OK(levelwind_command(&client, LEVELWIND_COMMAND_APPLY, 1000, NULL));
	TEST_ASSERT_EQUAL_INT(-EBUSY, levelwind_set_parameter(&client, "pitch_um", 11000));
	assert_error_text_has("The write lock is closed");
	TEST_OK(levelwind_unlock(&client, 4711));
	TEST_OK(levelwind_set_parameter(&client, "pitch_um", 11000));
	TEST_OK(levelwind_unlock(&client, 0));
	TEST_ASSERT_EQUAL_INT(-EBUSY, levelwind_set_parameter(&client, "pitch_um", 12000));
	TEST_OK(levelwind_unlock(&client, 4711));
	TEST_OK(levelwind_set_parameter(&client, "lock_code", 0));
	TEST_OK(levelwind_command(&client, LEVELWIND_COMMAND_APPLY, 1000, NULL));
}

static void test_trims_are_read_back(void)
{
	TEST_OK(levelwind_set_trim(&client, -300, 400));

	uint16_t words[2];

	TEST_ASSERT_EQUAL_INT(
		2, modbus_read_registers(client.modbus, LEVELWIND_ADDRESS_TRIM_PLUS_UM, 2, words));
	TEST_ASSERT_EQUAL_INT(-300, (int16_t)words[0]);
	TEST_ASSERT_EQUAL_INT(400, (int16_t)words[1]);
}

static void test_the_drum_is_told_to_run_and_to_rest(void)
{
	uint16_t word;

	TEST_OK(levelwind_set_drum_running(&client, 1));
	TEST_ASSERT_EQUAL_INT(
		1, modbus_read_registers(client.modbus, LEVELWIND_ADDRESS_DRUM_RUNNING, 1, &word));
	TEST_ASSERT_EQUAL_UINT16(1, word);
	TEST_OK(levelwind_set_drum_running(&client, 0));
	TEST_ASSERT_EQUAL_INT(-EINVAL, levelwind_set_drum_running(&client, 2));
}

static void test_each_command_counts_once(void)
{
	TEST_OK(command(LEVELWIND_COMMAND_STOP));

	uint16_t sequence = result.sequence;

	TEST_OK(command(LEVELWIND_COMMAND_STOP));
	TEST_ASSERT_EQUAL_UINT16(sequence + 1, result.sequence);
	TEST_ASSERT_EQUAL_INT(LEVELWIND_COMMAND_STOP, result.code);
}

static void test_a_command_refused_now_is_explained(void)
{
	TEST_ASSERT_EQUAL_INT(-EBUSY, command(LEVELWIND_COMMAND_INDEX));
	assert_error_text_has("index refused");
	assert_error_text_has(levelwind_value_text("command_reason", LEVELWIND_REASON_MODE_OFF));
}

static void test_a_command_that_has_not_ended_is_told_from_a_dead_line(void)
{
	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_CENTRE));
	TEST_ASSERT_EQUAL_INT(-EINPROGRESS,
			      levelwind_command(&client, LEVELWIND_COMMAND_INDEX, 0, &result));
	TEST_ASSERT_EQUAL_INT(LEVELWIND_RESULT_IN_PROGRESS, result.result);
	assert_error_text_has("index has not ended");
	TEST_OK(command(LEVELWIND_COMMAND_STOP));
}

static void test_indexing_is_started_and_polled_without_waiting(void)
{
	struct levelwind_given given;
	int polls = 0;
	int error;

	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_CENTRE));
	TEST_OK(levelwind_start_command(&client, LEVELWIND_COMMAND_INDEX, &given));
	while ((error = levelwind_poll_command(&client, &given, &result)) == -EINPROGRESS) {
		polls++;
		TEST_ASSERT_EQUAL_INT(LEVELWIND_RESULT_IN_PROGRESS, result.result);
		TEST_OK(levelwind_read_live(&client, &status)); /* the panel goes on */
	}
	TEST_OK(error);
	TEST_ASSERT_GREATER_THAN_INT(0, polls);
	TEST_ASSERT_EQUAL_INT(LEVELWIND_COMMAND_INDEX, result.code);
	TEST_OK(levelwind_read_live(&client, &status));
	TEST_ASSERT_TRUE(has_flag(LEVELWIND_FLAG_INDEXED));
}

static void test_a_command_that_another_one_followed_has_no_known_end(void)
{
	struct levelwind_given given;

	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_CENTRE));
	TEST_OK(levelwind_start_command(&client, LEVELWIND_COMMAND_INDEX, &given));
	TEST_OK(command(LEVELWIND_COMMAND_STOP));
	TEST_ASSERT_EQUAL_INT(-ECONNRESET, levelwind_poll_command(&client, &given, NULL));
	assert_error_text_has("another command");
}

/* ---- lost answers -----------------------------------------------------------------------------
 */

static void test_a_command_whose_request_is_lost_was_not_taken(void)
{
	go_through_the_faulty_line();

	uint16_t sequence = command_sequence();

	atomic_store(&line.lose_requests_of, MODBUS_FC_WRITE_MULTIPLE_REGISTERS);
	memset(&result, 0xA5, sizeof(result));
	TEST_ASSERT_EQUAL_INT(-ETIMEDOUT, command(LEVELWIND_COMMAND_STOP));
	assert_error_text_has("stop was not taken");
	TEST_ASSERT_EQUAL_INT(LEVELWIND_RESULT_NONE, result.result);
	TEST_ASSERT_EQUAL_UINT16(sequence, command_sequence());
}

static void test_a_command_whose_answer_is_lost_is_found_again(void)
{
	go_through_the_faulty_line();

	uint16_t sequence = command_sequence();

	atomic_store(&line.lose_answers_to, MODBUS_FC_WRITE_MULTIPLE_REGISTERS);
	TEST_OK(command(LEVELWIND_COMMAND_STOP));
	TEST_ASSERT_EQUAL_INT(LEVELWIND_RESULT_DONE, result.result);
	TEST_ASSERT_EQUAL_UINT16(sequence + 1, command_sequence()); /* given once only */
}

static void test_a_command_whose_answer_is_lost_for_good_may_have_been_done(void)
{
	go_through_the_faulty_line();

	uint16_t sequence = command_sequence();

	atomic_store(&line.lose_answers_to, MODBUS_FC_WRITE_MULTIPLE_REGISTERS);
	atomic_store(&line.dead_after, 2); /* the sequence, the command */
	TEST_ASSERT_EQUAL_INT(-ECONNABORTED, command(LEVELWIND_COMMAND_STOP));
	assert_error_text_has("may have been done");
	TEST_ASSERT_EQUAL_INT(LEVELWIND_RESULT_NONE, result.result);
	atomic_store(&line.dead_after, -1);
	TEST_ASSERT_EQUAL_UINT16(sequence + 1, command_sequence());
}

static void test_a_dead_line_took_no_command(void)
{
	go_through_the_faulty_line();
	atomic_store(&line.dead_after, 0);

	int requests = atomic_load(&line.requests);

	TEST_ASSERT_EQUAL_INT(-ETIMEDOUT, command(LEVELWIND_COMMAND_STOP));
	TEST_ASSERT_EQUAL_INT(requests + 1, atomic_load(&line.requests)); /* the question only */
}

static void test_a_restart_after_a_lost_answer_hides_nothing(void)
{
	TEST_OK(command(LEVELWIND_COMMAND_STOP)); /* so that the sequence is not 0 */
	go_through_the_faulty_line();
	atomic_store(&line.cut_power, true);
	atomic_store(&line.lose_answers_to, MODBUS_FC_WRITE_MULTIPLE_REGISTERS);
	TEST_ASSERT_EQUAL_INT(-ECONNABORTED, command(LEVELWIND_COMMAND_REVERT));
	assert_error_text_has("may have been done");
	wait_for_answers();
	TEST_ASSERT_EQUAL_UINT16(0, command_sequence()); /* it did restart */
}

static void test_a_line_lost_while_a_command_runs_is_told_from_one_that_goes_on(void)
{
	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_CENTRE));
	go_through_the_faulty_line();
	atomic_store(&line.dead_after, 4); /* the sequence, the command, two questions */
	TEST_ASSERT_EQUAL_INT(-ECONNRESET, levelwind_command(&client, LEVELWIND_COMMAND_INDEX,
							     INDEXING_MS, &result));
	assert_error_text_has("was taken, and may be going on");
	TEST_ASSERT_EQUAL_INT(LEVELWIND_RESULT_IN_PROGRESS, result.result);
	atomic_store(&line.dead_after, -1);
	TEST_OK(command(LEVELWIND_COMMAND_STOP));
}

static void test_a_controller_that_is_mute_for_a_while_does_not_end_the_waiting(void)
{
	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_CENTRE));
	go_through_the_faulty_line();
	atomic_store(&line.revives_after_ms, MUTE_MS);
	atomic_store(&line.dead_after, 3); /* the sequence, the command, a question */
	TEST_OK(levelwind_command(&client, LEVELWIND_COMMAND_INDEX, INDEXING_MS, &result));
	TEST_ASSERT_EQUAL_INT(-1, atomic_load(&line.dead_after)); /* it was mute, and is not */
}

static void test_a_command_before_a_mute_while_is_found_again(void)
{
	go_through_the_faulty_line();
	atomic_store(&line.lose_answers_to, MODBUS_FC_WRITE_MULTIPLE_REGISTERS);
	atomic_store(&line.revives_after_ms, MUTE_MS);
	atomic_store(&line.dead_after, 2); /* the sequence, the command */
	TEST_OK(command(LEVELWIND_COMMAND_STOP));
	TEST_ASSERT_EQUAL_INT(-1, atomic_load(&line.dead_after));
}

static void test_one_lost_answer_does_not_end_the_waiting(void)
{
	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_CENTRE));
	go_through_the_faulty_line();
	atomic_store(&line.answers_to_pass, 2); /* the sequence, the first question */
	atomic_store(&line.lose_answers_to, MODBUS_FC_READ_INPUT_REGISTERS);
	TEST_OK(levelwind_command(&client, LEVELWIND_COMMAND_INDEX, INDEXING_MS, &result));
	TEST_ASSERT_EQUAL_INT(0, atomic_load(&line.lose_answers_to)); /* one was lost */
}

static void test_a_restart_while_a_command_runs_is_no_end_of_it(void)
{
	struct levelwind_given given;

	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_CENTRE));
	TEST_OK(levelwind_start_command(&client, LEVELWIND_COMMAND_INDEX, &given));
	go_through_the_faulty_line();
	atomic_store(&line.cut_power, true);
	atomic_store(&line.lose_answers_to, MODBUS_FC_READ_INPUT_REGISTERS);
	TEST_ASSERT_EQUAL_INT(-ETIMEDOUT, levelwind_read_live(&client, &status));
	wait_for_answers();
	TEST_ASSERT_EQUAL_INT(-ECONNRESET, levelwind_poll_command(&client, &given, NULL));
	assert_error_text_has("restarted");
}

static void test_a_write_whose_answer_is_lost_may_have_been_done(void)
{
	go_through_the_faulty_line();
	atomic_store(&line.lose_answers_to, MODBUS_FC_WRITE_MULTIPLE_REGISTERS);
	TEST_ASSERT_EQUAL_INT(-ECONNABORTED, levelwind_set_parameter(&client, "pitch_um", 11111));
	assert_error_text_has("may have been done");
	TEST_ASSERT_EQUAL_INT(11111, parameter("pitch_um", LEVELWIND_SET_STAGED));
}

static void test_a_parameter_is_refused_and_explained_while_tracking(void)
{
	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_TRACK));
	TEST_OK(levelwind_command(&client, LEVELWIND_COMMAND_INDEX, INDEXING_MS, &result));
	wait_for_state(LEVELWIND_STATE_TRACKING);
	TEST_ASSERT_TRUE(has_flag(LEVELWIND_FLAG_LAUNCH_PERMIT));
	TEST_ASSERT_EQUAL_INT(0, status.launch_inhibit);
	TEST_ASSERT_EQUAL_INT(status.m >> 16, status.position_usteps);

	TEST_ASSERT_EQUAL_INT(-EBUSY, levelwind_set_parameter(&client, "pitch_um", 11000));
	assert_error_text_has("pitch_um refused");
	assert_error_text_has(
		levelwind_value_text("command_reason", LEVELWIND_REASON_BUSY_TRACKING));
	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_OFF));
}

int main(void)
{
	if (getenv("LEVELWIND_PORT") == NULL) {
		fputs("test_client: set LEVELWIND_PORT to the port of a controller\n", stderr);
		return EXIT_FAILURE;
	}
	UNITY_BEGIN();
	RUN_TEST(test_a_port_that_does_not_exist_is_named);
	RUN_TEST(test_a_silent_unit_times_out_and_is_named);
	RUN_TEST(test_an_impossible_unit_id_is_refused);
	RUN_TEST(test_identify_reads_the_self_test_and_versions);
	RUN_TEST(test_the_status_is_whole_and_consistent);
	RUN_TEST(test_the_live_status_is_one_request);
	RUN_TEST(test_every_flag_of_both_pairs_has_a_text_and_is_found);
	RUN_TEST(test_factory_values_are_those_of_the_map);
	RUN_TEST(test_a_parameter_is_staged_applied_and_saved);
	RUN_TEST(test_revert_drops_what_is_staged);
	RUN_TEST(test_a_value_outside_its_limits_is_not_sent);
	RUN_TEST(test_a_name_that_is_no_parameter_is_refused);
	RUN_TEST(test_a_set_that_does_not_fit_together_is_refused_and_explained);
	RUN_TEST(test_the_write_lock_opens_by_its_code);
	RUN_TEST(test_trims_are_read_back);
	RUN_TEST(test_the_drum_is_told_to_run_and_to_rest);
	RUN_TEST(test_each_command_counts_once);
	RUN_TEST(test_a_command_refused_now_is_explained);
	RUN_TEST(test_a_command_that_has_not_ended_is_told_from_a_dead_line);
	RUN_TEST(test_indexing_is_started_and_polled_without_waiting);
	RUN_TEST(test_a_command_that_another_one_followed_has_no_known_end);
	RUN_TEST(test_a_command_whose_request_is_lost_was_not_taken);
	RUN_TEST(test_a_command_whose_answer_is_lost_is_found_again);
	RUN_TEST(test_a_command_whose_answer_is_lost_for_good_may_have_been_done);
	RUN_TEST(test_a_dead_line_took_no_command);
	RUN_TEST(test_a_restart_after_a_lost_answer_hides_nothing);
	RUN_TEST(test_a_line_lost_while_a_command_runs_is_told_from_one_that_goes_on);
	RUN_TEST(test_a_controller_that_is_mute_for_a_while_does_not_end_the_waiting);
	RUN_TEST(test_a_command_before_a_mute_while_is_found_again);
	RUN_TEST(test_one_lost_answer_does_not_end_the_waiting);
	RUN_TEST(test_a_restart_while_a_command_runs_is_no_end_of_it);
	RUN_TEST(test_a_write_whose_answer_is_lost_may_have_been_done);
	RUN_TEST(test_a_parameter_is_refused_and_explained_while_tracking);
	return UNITY_END();
}
