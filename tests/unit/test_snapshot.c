/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Reads while edges come. A signal is the encoder interrupt: it comes between any two instructions
 * of a request, as it does on the hardware. The law is reversible bit for bit, so that position and
 * slope are known for every number of followed edges; every read must show a pair that belongs
 * together, and no half of a 32-bit or 64-bit value of another moment.
 */
#define _POSIX_C_SOURCE 200809L

#include <signal.h>
#include <string.h>
#include <time.h>

#include "rig.h"

/** The drum is rocked between so many edges before and behind the hand-over: across 0, where every
 *  word of a 64-bit count changes, and on the minus side through a reversal. */
#define REACH_EDGES 12000

/** Reads that an edge must have interrupted: there and back once, and more. */
#define INTERRUPTED_READS 60000

/** Reads of which the mean tells how long one takes. */
#define TIMED_READS 1000

/** First and number of registers of a read: state to span_error_um. */
#define FIRST LW_ADDRESS_STATE
#define COUNT 32

/** What belongs to one number of followed edges. */
struct place {
	int32_t position_um;
	int32_t position_usteps;
	int32_t m;
	int32_t u;
};

static const struct lw_device_config config = {.host = LW_HOST_SIMULATOR, .store = &rig.store};
static struct place places[2 * REACH_EDGES + 1];
static int64_t net_edges_ahead; /**< net_edges - pattern_edges */

/* The interrupt's; the rest of the program reads `interrupts` only. */
static volatile sig_atomic_t interrupts;
static int edges;
static int direction;

void setUp(void)
{
}

void tearDown(void)
{
}

static void turn_one_edge(int dd)
{
	static const uint8_t forward[4] = {0, 2, 3, 1};
	uint8_t levels;

	for (int transition = 0; transition < 2; transition++) {
		rig.quarter += (uint32_t)dd;
		levels = forward[rig.quarter & 3];
		(void)lw_controller_encoder(rig.controller, levels & 2, levels & 1);
	}
	edges += dd;
}

static void on_interrupt(int number)
{
	(void)number;
	interrupts++;
	if (edges >= REACH_EDGES) {
		direction = -1;
	} else if (edges <= -REACH_EDGES) {
		direction = 1;
	}
	turn_one_edge(direction);
}

static int64_t get(const uint8_t *registers, uint16_t address, int words)
{
	uint64_t value = 0;

	for (int i = 0; i < words; i++) {
		const uint8_t *at = &registers[2 * (address - FIRST + i)];

		value = value << 16 | (uint64_t)(at[0] << 8 | at[1]);
	}
	/* Sign-extended. */
	return (int64_t)(value << (64 - 16 * words)) >> (64 - 16 * words);
}

static void read_registers(uint8_t registers[2 * COUNT])
{
	static const uint8_t request[] = {4, 0, FIRST, 0, COUNT};
	uint8_t response[LW_PDU_MAX];

	TEST_ASSERT_EQUAL_UINT(2 + 2 * COUNT, lw_pdu_handle(&rig.device.slave.pdu, request,
							    sizeof(request), response));
	memcpy(registers, &response[2], 2 * COUNT);
}

static struct place place_of(const uint8_t *registers)
{
	return (struct place){
		.position_um = (int32_t)get(registers, LW_ADDRESS_POSITION_UM, 2),
		.position_usteps = (int32_t)get(registers, LW_ADDRESS_POSITION_USTEPS, 1),
		.m = (int32_t)get(registers, LW_ADDRESS_M, 2),
		.u = (int32_t)get(registers, LW_ADDRESS_U, 2),
	};
}

static void note_place(void)
{
	uint8_t registers[2 * COUNT];

	read_registers(registers);
	TEST_ASSERT_EQUAL_INT64(edges, get(registers, LW_ADDRESS_PATTERN_EDGES, 4));
	places[REACH_EDGES + edges] = place_of(registers);
	net_edges_ahead = get(registers, LW_ADDRESS_NET_EDGES, 4) - edges;
}

/* Follow the drum there and back without a race, and learn what belongs together. */
static void learn_places(void)
{
	while (edges < REACH_EDGES) {
		turn_one_edge(1);
		note_place();
	}
	while (edges > -REACH_EDGES) {
		turn_one_edge(-1);
		note_place();
	}
}

static void check(const uint8_t *registers)
{
	const int64_t pattern_edges = get(registers, LW_ADDRESS_PATTERN_EDGES, 4);
	const struct place place = place_of(registers);

	TEST_ASSERT_TRUE(-REACH_EDGES <= pattern_edges && pattern_edges <= REACH_EDGES);
	TEST_ASSERT_EQUAL_MEMORY(&places[REACH_EDGES + pattern_edges], &place, sizeof(place));
	TEST_ASSERT_EQUAL_INT64(pattern_edges + net_edges_ahead,
				get(registers, LW_ADDRESS_NET_EDGES, 4));
}

/* How long a read takes here and now, in ns of this program's own time. */
static long read_takes_ns(void)
{
	struct timespec begin;
	struct timespec end;
	uint8_t registers[2 * COUNT];

	(void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &begin);
	for (int i = 0; i < TIMED_READS; i++) {
		read_registers(registers);
	}
	(void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
	return ((end.tv_sec - begin.tv_sec) * 1000000000L + end.tv_nsec - begin.tv_nsec) /
	       TIMED_READS;
}

static void test_every_read_is_of_one_moment(void)
{
	const struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = SA_RESTART};
	struct itimerspec once = {0};
	struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGUSR1};
	uint8_t registers[2 * COUNT];
	unsigned int interrupted = 0;
	unsigned long reads = 0;
	unsigned long longest_ns;
	timer_t timer;

	rig_prepare(0);

	const struct lw_inputs inputs = rig_inputs();

	lw_device_init(&rig.device, &config, &inputs, rig.now_us, rig.now_us);
	rig.controller = &rig.device.controller;
	rig.with_device = true;
	rig_ticks(300);
	lw_controller_index(rig.controller);
	rig_run_to(LW_STATE_TRACKING);
	learn_places();

	TEST_ASSERT_EQUAL_INT(0, sigaction(SIGUSR1, &action, NULL));
	TEST_ASSERT_EQUAL_INT(0, timer_create(CLOCK_MONOTONIC, &event, &timer));
	longest_ns = 2 * (unsigned long)read_takes_ns();
	while (interrupted < INTERRUPTED_READS) {
		const sig_atomic_t before = interrupts;

		/* One edge for a read, each time at another place in it: edges in a steady period
		 * would leave a busy machine no time for the reads. */
		once.it_value.tv_nsec = 1 + (long)(reads++ * 7919 % longest_ns);
		TEST_ASSERT_EQUAL_INT(0, timer_settime(timer, 0, &once, NULL));
		read_registers(registers);
		interrupted += interrupts != before;
		check(registers);
	}
	TEST_ASSERT_EQUAL_INT(0, timer_delete(timer));
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_every_read_is_of_one_moment);
	return UNITY_END();
}
