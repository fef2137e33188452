/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A line between the client and the controller's port that loses what a test says: a pseudo
 * terminal for the client, and a thread that copies.
 */
#ifndef FAULTY_LINE_H
#define FAULTY_LINE_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>

/** One line. The test writes the faults at any time, the thread reads them. */
struct faulty_line {
	char port[64];       /**< for the client */
	int client_end;      /**< the far end of it */
	int controller_port; /**< the real one */
	int far_end;         /**< held open, or the pseudo terminal would hang up */
	int stop[2];         /**< a pipe that ends the thread */
	pthread_t thread;
	int64_t dead_since_ms;       /**< the thread's own; 0: not dead */
	atomic_int lose_requests_of; /**< swallow requests of this function code; 0: none */
	atomic_int lose_answers_to;  /**< let one of them pass, and swallow its answer; 0: none */
	atomic_int answers_to_pass;  /**< so many come through before that one */
	atomic_int dead_after;       /**< so many requests pass, then nothing any more; -1: all */
	atomic_int revives_after_ms; /**< so long after the first that did not pass; 0: never */
	atomic_bool cut_power;       /**< restart the controller at the next answer that is lost */
	atomic_int requests;         /**< how many the client has sent */
};

/** Open `controller_port` and begin to copy, without a fault. */
void faulty_line_open(struct faulty_line *line, const char *controller_port);

/** End it, and close the controller's port. */
void faulty_line_close(struct faulty_line *line);

#endif /* FAULTY_LINE_H */
