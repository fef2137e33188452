/*
 * The C client against a live controller, whose serial port is in the environment variable
 * LEVELWIND_PORT (8N1, unit 1). It may be the simulator or hardware: the carriage moves.
 */
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "levelwind_client.h"
#include "unity.h"

#define COMMAND_MS  5000
#define INDEXING_MS 120000
#define WAIT_READS  2000

static struct levelwind_client client;
static struct levelwind_status status;
static struct levelwind_command_result result;

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
	return (status.flags >> flag & 1) != 0;
}

static void wait_for_state(enum levelwind_state state)
{
	for (int i = 0; i < WAIT_READS && status.state != (int32_t)state; i++) {
		TEST_OK(levelwind_read_status(&client, &status));
	}
	TEST_ASSERT_EQUAL_STRING(levelwind_value_text("state", (int32_t)state),
				 levelwind_value_text("state", status.state));
}

/* Every test begins with factory values, staged and active, and without stepper current. */
void setUp(void)
{
	struct levelwind_line line = {.port = getenv("LEVELWIND_PORT"), .parity = 'N'};

	TEST_OK(levelwind_connect(&client, &line));
	TEST_OK(levelwind_identify(&client, &status));
	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_OFF));
	TEST_OK(levelwind_read_status(&client, &status));
	wait_for_state(LEVELWIND_STATE_OFF);
	TEST_OK(levelwind_set_trim(&client, 0, 0));
	TEST_OK(command(LEVELWIND_COMMAND_FACTORY_ALL));
	TEST_OK(command(LEVELWIND_COMMAND_APPLY));
}

void tearDown(void)
{
	levelwind_disconnect(&client);
}

static void test_a_port_that_does_not_exist_is_named(void)
{
	struct levelwind_line line = {.port = "/dev/no-such-port"};

	levelwind_disconnect(&client);
	TEST_ASSERT_EQUAL_INT(-ENOENT, levelwind_connect(&client, &line));
	assert_error_text_has("/dev/no-such-port");
	setUp();
}

static void test_a_silent_unit_times_out_and_is_named(void)
{
	struct levelwind_line line = client.line;

	levelwind_disconnect(&client);
	line.unit_id = 77;
	line.response_timeout_ms = 100;
	TEST_OK(levelwind_connect(&client, &line));
	TEST_ASSERT_EQUAL_INT(-ETIMEDOUT, levelwind_identify(&client, &status));
	assert_error_text_has("unit 77");
	assert_error_text_has("100 ms");
}

static void test_an_impossible_unit_id_is_refused(void)
{
	struct levelwind_line line = client.line;

	levelwind_disconnect(&client);
	line.unit_id = 248;
	TEST_ASSERT_EQUAL_INT(-EINVAL, levelwind_connect(&client, &line));
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

static void test_a_command_that_has_not_ended_times_out_and_goes_on(void)
{
	TEST_OK(levelwind_set_mode(&client, LEVELWIND_MODE_CENTRE));
	TEST_ASSERT_EQUAL_INT(-ETIMEDOUT,
			      levelwind_command(&client, LEVELWIND_COMMAND_INDEX, 0, &result));
	TEST_ASSERT_EQUAL_INT(LEVELWIND_RESULT_IN_PROGRESS, result.result);
	assert_error_text_has("index has not ended");
	TEST_OK(command(LEVELWIND_COMMAND_STOP));
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
	RUN_TEST(test_factory_values_are_those_of_the_map);
	RUN_TEST(test_a_parameter_is_staged_applied_and_saved);
	RUN_TEST(test_revert_drops_what_is_staged);
	RUN_TEST(test_a_value_outside_its_limits_is_not_sent);
	RUN_TEST(test_a_name_that_is_no_parameter_is_refused);
	RUN_TEST(test_a_set_that_does_not_fit_together_is_refused_and_explained);
	RUN_TEST(test_the_write_lock_opens_by_its_code);
	RUN_TEST(test_trims_are_read_back);
	RUN_TEST(test_each_command_counts_once);
	RUN_TEST(test_a_command_refused_now_is_explained);
	RUN_TEST(test_a_command_that_has_not_ended_times_out_and_goes_on);
	RUN_TEST(test_a_parameter_is_refused_and_explained_while_tracking);
	return UNITY_END();
}
