/* SPDX-License-Identifier: Apache-2.0 */
#define _XOPEN_SOURCE 700

#include "faulty_line.h"

#include <fcntl.h>
#include <poll.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "unity.h"

#define FRAME_MAX 256
#define FUNCTION  1 /* place of the function code in a frame */

/* bench_command power_cut to unit 1. */
static const uint8_t power_cut[] = {0x01, 0x06, 0xF0, 0x02, 0x00, 0x04, 0x1A, 0xC9};

static void set_raw(int file)
{
	struct termios settings;

	TEST_ASSERT_EQUAL_INT(0, tcgetattr(file, &settings));
	settings.c_iflag = 0;
	settings.c_oflag = 0;
	settings.c_lflag = 0;
	settings.c_cflag = CS8 | CREAD | CLOCAL;
	settings.c_cc[VMIN] = 1;
	settings.c_cc[VTIME] = 0;
	TEST_ASSERT_EQUAL_INT(0, tcsetattr(file, TCSANOW, &settings));
}

static void pass_on(int file, const uint8_t *bytes, size_t count)
{
	if (write(file, bytes, count) != (ssize_t)count) {
		abort(); /* no pseudo terminal is that full */
	}
}

/* Does the line swallow this request, and everything behind it? */
static bool is_dead(struct faulty_line *line)
{
	const int revives_after_ms = atomic_load(&line->revives_after_ms);
	struct timespec now;
	int64_t now_ms;

	if (atomic_load(&line->dead_after) != 0) {
		return false;
	}
	(void)clock_gettime(CLOCK_MONOTONIC, &now);
	now_ms = (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
	if (line->dead_since_ms == 0) {
		line->dead_since_ms = now_ms;
	}
	if (revives_after_ms == 0 || now_ms - line->dead_since_ms < revives_after_ms) {
		return true;
	}
	atomic_store(&line->dead_after, -1);
	return false;
}

/* One request: a client writes a frame at once, and waits for the answer. */
static void copy_request(struct faulty_line *line, const uint8_t *frame, size_t length,
			 bool *lose_answer)
{
	const int function = length > FUNCTION ? frame[FUNCTION] : 0;

	atomic_fetch_add(&line->requests, 1);
	*lose_answer = false;
	if (is_dead(line)) {
		return;
	}
	if (atomic_load(&line->dead_after) > 0) {
		atomic_fetch_sub(&line->dead_after, 1);
	}
	if (function == atomic_load(&line->lose_requests_of)) {
		return;
	}
	if (function == atomic_load(&line->lose_answers_to) &&
	    atomic_fetch_sub(&line->answers_to_pass, 1) == 0) {
		*lose_answer = true;
		atomic_store(&line->lose_answers_to, 0);
		atomic_store(&line->answers_to_pass, 0);
	}
	pass_on(line->controller_port, frame, length);
}

static void *copy(void *context)
{
	struct faulty_line *line = context;
	struct pollfd files[] = {{.fd = line->client_end, .events = POLLIN},
				 {.fd = line->controller_port, .events = POLLIN},
				 {.fd = line->stop[0], .events = POLLIN}};
	uint8_t bytes[FRAME_MAX];
	bool lose_answer = false;

	while (poll(files, 3, -1) > 0 && files[2].revents == 0) {
		if (files[0].revents != 0) {
			ssize_t count = read(line->client_end, bytes, sizeof(bytes));

			if (count > 0) {
				copy_request(line, bytes, (size_t)count, &lose_answer);
			}
		}
		if (files[1].revents != 0) {
			ssize_t count = read(line->controller_port, bytes, sizeof(bytes));

			if (count <= 0) {
				break; /* the controller's program has ended */
			}
			if (lose_answer) {
				if (atomic_exchange(&line->cut_power, false)) {
					pass_on(line->controller_port, power_cut,
						sizeof(power_cut));
				}
			} else {
				pass_on(line->client_end, bytes, (size_t)count);
			}
		}
	}
	return NULL;
}

void faulty_line_open(struct faulty_line *line, const char *controller_port)
{
	memset(line, 0, sizeof(*line));
	atomic_store(&line->dead_after, -1);
	line->client_end = posix_openpt(O_RDWR | O_NOCTTY);
	TEST_ASSERT_GREATER_OR_EQUAL_INT(0, line->client_end);
	TEST_ASSERT_EQUAL_INT(0, grantpt(line->client_end));
	TEST_ASSERT_EQUAL_INT(0, unlockpt(line->client_end));
	strncpy(line->port, ptsname(line->client_end), sizeof(line->port) - 1);
	line->far_end = open(line->port, O_RDWR | O_NOCTTY);
	TEST_ASSERT_GREATER_OR_EQUAL_INT(0, line->far_end);
	set_raw(line->far_end);
	line->controller_port = open(controller_port, O_RDWR | O_NOCTTY);
	TEST_ASSERT_GREATER_OR_EQUAL_INT(0, line->controller_port);
	set_raw(line->controller_port);
	TEST_ASSERT_EQUAL_INT(0, pipe(line->stop));
	TEST_ASSERT_EQUAL_INT(0, pthread_create(&line->thread, NULL, copy, line));
}

void faulty_line_close(struct faulty_line *line)
{
	pass_on(line->stop[1], (const uint8_t *)"", 1);
	(void)pthread_join(line->thread, NULL);
	(void)close(line->client_end);
	(void)close(line->far_end);
	(void)close(line->controller_port);
	(void)close(line->stop[0]);
	(void)close(line->stop[1]);
}
