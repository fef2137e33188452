/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The simulator: a world on a real or virtual clock, its Modbus slave on a pseudo terminal, a
 * serial port or TCP. One thread. It is not Zephyr; it runs the same core.
 */
#include <errno.h>
#include <getopt.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"
#include "lw/plant_figures.h"
#include "machine.h"
#include "port.h"
#include "tcp.h"
#include "world.h"

/** Virtual time simulated between two looks at the port. */
#define CHUNK_NS 2000000u

/** Real time that the simulator may fall behind before it gives up catching up. */
#define LAG_MAX_NS 200000000u

/**
 * Silence that ends a frame on a pseudo terminal. There are no character times there; a frame
 * comes in one write, or in a few close together.
 */
#define PTY_SILENCE_US 2000u

/** More figures than a machine has would be some twice. */
#define FIGURES_MAX 128u

struct options {
	const char *port; /**< NULL: none */
	const char *tcp;  /**< NULL: none */
	const char *storage;
	const char *trace;
	double speed; /**< 0: as fast as it can */
	uint64_t seed;
	const char *figures[FIGURES_MAX];
	size_t figure_count;
	bool as_parameters;
	uint8_t unit_id;
	uint32_t silence_us; /**< 0: by the port */
};

struct simulator {
	struct options options;
	struct lw_port port;
	struct lw_tcp tcp;
	int storage_fd;
	FILE *trace;
	int64_t traced_edges;
	uint32_t traced_steps;
	int traced_state;
	uint64_t looked_ns; /**< when the port was last looked at, 0: never */
	struct lw_world world;
};

static volatile sig_atomic_t stop_signal;

static void on_signal(int number)
{
	stop_signal = number;
}

static void usage(FILE *stream)
{
	fputs("usage: lw_sim --port PATH | --tcp ADDRESS:PORT [--speed FACTOR|max] [--seed N] \n"
	      "              [--storage FILE] [--trace FILE.csv] [--unit N] [--figure NAME=VALUE "
	      "...]\n"
	      "              [--frame-silence-ms N] [--as-parameters]\n"
	      "\n"
	      "  --port PATH      serial port to answer on, or where to make a link to a pseudo "
	      "terminal\n"
	      "  --tcp ADDRESS:PORT\n"
	      "                   serve Modbus TCP there instead; port 0: any that is free\n"
	      "  --speed FACTOR   virtual seconds per real second (default 1), or max\n"
	      "  --seed N         seed of everything random in the plant (default 1)\n"
	      "  --storage FILE   keeps parameters, event log and counters (default: in memory)\n"
	      "  --trace FILE     write one line per millisecond in which something moves\n"
	      "  --unit N         Modbus unit id (default: the stored one, at first 1)\n"
	      "  --as-parameters  the machine that the stored parameters describe\n"
	      "  --figure NAME=VALUE\n"
	      "                   another figure of the machine, as screw_lead_mm=10 "
	      "(doc/machine.md)\n"
	      "  --frame-silence-ms N\n"
	      "                   silence that ends a frame (default: by the baud rate, 2 on a "
	      "pseudo\n"
	      "                   terminal). At a USB adapter more than its latency timer, 1 to 16 "
	      "ms\n",
	      stream);
}

/** A whole decimal number within limits, or an error message and false. */
static bool parse_number(const char *name, const char *text, long long min, long long max,
			 long long *value)
{
	char *end;

	errno = 0;
	*value = strtoll(text, &end, 10);
	if (errno != 0 || *text == '\0' || *end != '\0' || *value < min || *value > max) {
		fprintf(stderr, "lw_sim: --%s %s: must be a number from %lld to %lld\n", name, text,
			min, max);
		return false;
	}
	return true;
}

static bool parse_speed(const char *text, double *speed)
{
	char *end;

	if (strcmp(text, "max") == 0) {
		*speed = 0;
		return true;
	}
	*speed = strtod(text, &end);
	if (*text == '\0' || *end != '\0' || !(*speed >= 0.01 && *speed <= 1000)) {
		fprintf(stderr, "lw_sim: --speed %s: must be from 0.01 to 1000, or max\n", text);
		return false;
	}
	return true;
}

/** A figure of the machine, NAME=VALUE, or an error message and false. */
static bool parse_figure(const char *text, struct lw_plant_config *machine)
{
	const char *equals = strchr(text, '=');
	char name[64];
	char *end;
	double value;

	if (equals == NULL || equals == text || equals[1] == '\0' ||
	    (size_t)(equals - text) >= sizeof(name)) {
		fprintf(stderr, "lw_sim: --figure %s: must be NAME=VALUE\n", text);
		return false;
	}
	memcpy(name, text, (size_t)(equals - text));
	name[equals - text] = '\0';
	value = strtod(equals + 1, &end);
	if (*end != '\0') {
		fprintf(stderr, "lw_sim: --figure %s: must be a number\n", text);
		return false;
	}
	switch (lw_plant_config_set(machine, name, value)) {
	case 0:
		return true;
	case -ENOENT:
		fprintf(stderr,
			"lw_sim: --figure %s: no machine has a figure %s; doc/machine.md "
			"lists them\n",
			text, name);
		return false;
	default:
		for (const struct lw_plant_figure *figure = lw_plant_figures; figure->name != NULL;
		     figure++) {
			if (strcmp(figure->name, name) == 0) {
				fprintf(stderr,
					"lw_sim: --figure %s: must be a %snumber from %g "
					"to %g\n",
					text, figure->whole ? "whole " : "", figure->min,
					figure->max);
			}
		}
		return false;
	}
}

static bool parse_options(int argc, char **argv, struct options *options)
{
	static const struct option names[] = {
		{"port", required_argument, NULL, 'p'},
		{"tcp", required_argument, NULL, 'n'},
		{"speed", required_argument, NULL, 's'},
		{"seed", required_argument, NULL, 'r'},
		{"storage", required_argument, NULL, 'f'},
		{"trace", required_argument, NULL, 't'},
		{"unit", required_argument, NULL, 'u'},
		{"figure", required_argument, NULL, 'm'},
		{"as-parameters", no_argument, NULL, 'a'},
		{"frame-silence-ms", required_argument, NULL, 'i'},
		{"help", no_argument, NULL, 'h'},
		{NULL, 0, NULL, 0},
	};
	long long number;
	int name;

	*options = (struct options){.speed = 1, .seed = 1};
	while ((name = getopt_long(argc, argv, "h", names, NULL)) != -1) {
		switch (name) {
		case 'p':
			options->port = optarg;
			break;
		case 'n':
			options->tcp = optarg;
			break;
		case 's':
			if (!parse_speed(optarg, &options->speed)) {
				return false;
			}
			break;
		case 'r':
			if (!parse_number("seed", optarg, 0, INT64_MAX, &number)) {
				return false;
			}
			options->seed = (uint64_t)number;
			break;
		case 'f':
			options->storage = optarg;
			break;
		case 't':
			options->trace = optarg;
			break;
		case 'u':
			if (!parse_number("unit", optarg, 1, 247, &number)) {
				return false;
			}
			options->unit_id = (uint8_t)number;
			break;
		case 'm':
			if (options->figure_count == FIGURES_MAX) {
				fprintf(stderr, "lw_sim: --figure: at most %u of them\n",
					FIGURES_MAX);
				return false;
			}
			options->figures[options->figure_count++] = optarg;
			break;
		case 'a':
			options->as_parameters = true;
			break;
		case 'i':
			if (!parse_number("frame-silence-ms", optarg, 1, 1000, &number)) {
				return false;
			}
			options->silence_us = (uint32_t)number * 1000;
			break;
		case 'h':
			usage(stdout);
			exit(EXIT_SUCCESS);
		default:
			usage(stderr);
			return false;
		}
	}
	if ((options->port == NULL) == (options->tcp == NULL) || optind != argc) {
		usage(stderr);
		return false;
	}
	return true;
}

/** Where a slot stands in the storage file. */
static long slot_offset(unsigned int slot)
{
	/* In whole pages, so that longer records do not move the others. */
	_Static_assert(LW_STORE_SLOT_SIZE <= 4096, "a slot does not fit");
	return (long)slot * 4096;
}

/** Write one slot in place: a power cut may leave it torn, as in a flash. */
static int write_slot(void *context, unsigned int slot, const uint8_t *bytes, size_t length)
{
	const struct simulator *simulator = context;

	return lw_host_write_at(simulator->storage_fd, bytes, length, slot_offset(slot));
}

static size_t read_slot(void *context, unsigned int slot, uint8_t *bytes, size_t size)
{
	const struct simulator *simulator = context;

	return lw_host_read_at(simulator->storage_fd, bytes, size, slot_offset(slot));
}

/** The default machine, or the one that the stored set describes, and the figures that differ. */
static bool make_machine(struct simulator *simulator, struct lw_plant_config *machine)
{
	const struct options *options = &simulator->options;
	struct lw_store *store = &simulator->world.store; /* powering up loads it again */
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	struct lw_plant_misfit why;

	lw_plant_config_default(machine);
	if (options->as_parameters) {
		lw_store_init(store);
		for (unsigned int slot = 0; options->storage != NULL && slot < LW_STORE_SLOTS;
		     slot++) {
			const size_t length = read_slot(simulator, slot, bytes, sizeof(bytes));

			lw_store_load(store, slot, bytes, length);
		}
		lw_machine_of_params(&store->params, machine);
	}
	for (size_t i = 0; i < options->figure_count; i++) {
		if (!parse_figure(options->figures[i], machine)) {
			return false;
		}
	}
	if (lw_plant_config_check(machine, &why)) {
		fprintf(stderr, "lw_sim: --figure %s: must be %s %s\n", why.figure, why.must_be,
			why.other);
		return false;
	}
	return true;
}

/**
 * Open the storage for this simulator alone: two would write over each other's records.
 *
 * @return its descriptor, or negative after an error message
 */
static int open_storage(const char *path)
{
	const int fd = lw_host_open_alone(path);

	if (fd < 0) {
		fprintf(stderr, "lw_sim: --storage %s: %s\n", path,
			fd == -EBUSY ? "another simulator keeps its parameters there; end it, or "
				       "name another file"
				     : strerror(-fd));
	}
	return fd;
}

/** Begin the trace file. @return false after an error message */
static bool open_trace(struct simulator *simulator)
{
	simulator->trace = fopen(simulator->options.trace, "w");
	if (simulator->trace == NULL) {
		fprintf(stderr, "lw_sim: %s: %s\n", simulator->options.trace, strerror(errno));
		return false;
	}
	fputs("time_ms,state,net_edges,pattern_edges,m,u,steps,carriage_um,drum_millirpm,flags\n",
	      simulator->trace);
	return true;
}

static void trace(void *context)
{
	struct simulator *simulator = context;
	struct lw_world *world = &simulator->world;
	const struct lw_motion_reading motion = lw_motion_read(&world->device.controller.motion);
	const int state = (int)world->device.controller.state;
	struct lw_plant_truth truth;

	if (simulator->trace == NULL ||
	    (motion.net_edges == simulator->traced_edges &&
	     motion.steps == simulator->traced_steps && state == simulator->traced_state)) {
		return;
	}
	simulator->traced_edges = motion.net_edges;
	simulator->traced_steps = motion.steps;
	simulator->traced_state = state;
	lw_plant_read_truth(&world->plant, &truth);
	lw_device_refresh_status(&world->device);
	fprintf(simulator->trace, "%llu,%d,%lld,%lld,%d,%d,%u,%.1f,%.0f,%u\n",
		(unsigned long long)(world->now_ns / 1000000), state, (long long)motion.net_edges,
		(long long)motion.pattern_edges, motion.m, motion.u, motion.steps,
		truth.carriage_um, truth.drum_milli_rpm, world->device.status_image.flags);
}

/** Move bytes between the port and the slave. @return false if the port is gone. */
static bool serve_port(struct simulator *simulator)
{
	if (simulator->options.tcp != NULL) {
		lw_tcp_serve(&simulator->tcp, &simulator->world, lw_host_now_ns() / 1000);
		return true;
	}

	struct lw_slave *slave = &simulator->world.device.slave;
	uint8_t bytes[LW_RTU_FRAME_MAX];
	const uint64_t away_ns = lw_host_now_ns() - simulator->looked_ns;

	/* After a stop of the program, or a laptop's sleep, nobody knows when it came. */
	if (simulator->looked_ns != 0 && away_ns / 1000 > LW_SLAVE_WAIT_MAX_US &&
	    (lw_port_drop(&simulator->port) || lw_slave_deadline_us(slave) != UINT64_MAX)) {
		lw_slave_lose(slave);
	}
	simulator->looked_ns = lw_host_now_ns();

	const ssize_t count = lw_port_read(&simulator->port, bytes, sizeof(bytes));

	if (count < 0) {
		fprintf(stderr, "lw_sim: %s: the port is gone: %s\n", simulator->options.port,
			strerror((int)-count));
		return false;
	}
	if (count > 0) {
		if (lw_port_echo_changed(&simulator->port)) {
			lw_slave_reconfigure(slave);
		}
		(void)lw_plant_disturb(&simulator->world.plant, bytes, (size_t)count);
		lw_slave_receive(slave, bytes, (size_t)count, lw_host_now_ns() / 1000);
	}

	const size_t length = lw_slave_poll(slave, lw_host_now_ns() / 1000, bytes);

	if (length > 0) {
		(void)lw_plant_disturb(&simulator->world.plant, bytes, length);
		lw_port_write(&simulator->port, bytes, length);
	}

	const int ret = lw_port_set_line(&simulator->port, &simulator->world.device.line);

	if (ret) {
		fprintf(stderr, "lw_sim: %s: line settings: %s\n", simulator->options.port,
			strerror(-ret));
	}
	return ret == 0;
}

/** Wait for bytes, the end of a frame, or the next chunk. */
static void wait_until(struct simulator *simulator, uint64_t wake_ns)
{
	const uint64_t deadline_us = lw_slave_deadline_us(&simulator->world.device.slave);
	const uint64_t now_ns = lw_host_now_ns();

	if (deadline_us < wake_ns / 1000) {
		wake_ns = deadline_us * 1000;
	}
	lw_tcp_wait(&simulator->tcp, simulator->port.fd, wake_ns > now_ns ? wake_ns - now_ns : 0);
}

static int run(struct simulator *simulator)
{
	struct lw_world *world = &simulator->world;
	const double speed = simulator->options.speed;
	uint64_t start_real_ns = lw_host_now_ns();
	uint64_t start_virtual_ns = world->now_ns;

	while (!stop_signal) {
		if (speed > 0) {
			const uint64_t chunk_real_ns = (uint64_t)(CHUNK_NS / speed);
			uint64_t elapsed_ns = lw_host_now_ns() - start_real_ns;
			uint64_t target_ns =
				start_virtual_ns + (uint64_t)((double)elapsed_ns * speed);

			if (target_ns > world->now_ns + (uint64_t)(LAG_MAX_NS * speed)) {
				/* Hopelessly behind (a sleeping laptop): go on from here. */
				start_real_ns = lw_host_now_ns();
				start_virtual_ns = world->now_ns;
				target_ns = world->now_ns;
			}
			while (world->now_ns < target_ns && !stop_signal) {
				const uint64_t chunk_ns = world->now_ns + CHUNK_NS;

				lw_world_run(world, chunk_ns < target_ns ? chunk_ns : target_ns);
				if (!serve_port(simulator)) {
					return EXIT_FAILURE;
				}
			}
			wait_until(simulator,
				   lw_host_now_ns() +
					   (chunk_real_ns < 1000000 ? chunk_real_ns : 1000000));
		} else {
			lw_world_run(world, world->now_ns + CHUNK_NS);
		}
		if (!serve_port(simulator)) {
			return EXIT_FAILURE;
		}
	}
	return EXIT_SUCCESS;
}

static const char *port_error(int error)
{
	switch (error) {
	case -EEXIST:
		return "exists and is neither a serial port nor a link of a simulator";
	case -EADDRINUSE:
		return "another simulator has this port; end it, or choose another path. "
		       "(If none is running, remove the link.)";
	case -ENOTSUP:
		return "there are no pseudo terminals here: use --tcp ADDRESS:PORT";
	default:
		return strerror(-error);
	}
}

/** Open the port, or listen. @return false after an error message */
static bool open_line(struct simulator *simulator)
{
	const struct options *options = &simulator->options;
	const char *why;
	int ret;

	simulator->port.fd = -1;
	simulator->tcp.socket = -1;
	if (options->tcp != NULL) {
		if (lw_tcp_open(&simulator->tcp, options->tcp, &why)) {
			fprintf(stderr, "lw_sim: --tcp %s: %s\n", options->tcp, why);
			return false;
		}
		return true;
	}
	ret = lw_port_open(&simulator->port, options->port, &simulator->world.device.line);
	if (ret) {
		fprintf(stderr, "lw_sim: %s: %s\n", options->port, port_error(ret));
	}
	return ret == 0;
}

static void close_line(struct simulator *simulator)
{
	if (simulator->options.tcp != NULL) {
		lw_tcp_close(&simulator->tcp);
	} else {
		lw_port_close(&simulator->port);
	}
}

int main(int argc, char **argv)
{
	static struct simulator simulator; /* large: off the stack */
	struct lw_world_config config;
	struct lw_plant_config machine;
	int ret;

	if (!parse_options(argc, argv, &simulator.options)) {
		return 2;
	}
	if (simulator.options.storage != NULL) {
		simulator.storage_fd = open_storage(simulator.options.storage);
		if (simulator.storage_fd < 0) {
			return EXIT_FAILURE;
		}
	}

	if (!make_machine(&simulator, &machine)) {
		return 2;
	}

	const bool is_serial =
		simulator.options.port != NULL && lw_port_is_serial(simulator.options.port);

	config = (struct lw_world_config){
		.seed = simulator.options.seed,
		.machine = &machine,
		.silence_us = simulator.options.silence_us != 0 ? simulator.options.silence_us
			      : is_serial                       ? 0
								: PTY_SILENCE_US,
		.line_takes_no_time = !is_serial,
		.unit_id = simulator.options.unit_id,
		.context = &simulator,
		.read_slot = simulator.options.storage != NULL ? read_slot : NULL,
		.write_slot = simulator.options.storage != NULL ? write_slot : NULL,
		.observe = trace,
	};
	(void)lw_world_init(&simulator.world, &config, lw_host_now_ns() / 1000); /* checked */
	if (!open_line(&simulator)) {
		return EXIT_FAILURE;
	}
	/* Not before this simulator is known to be the only one at its port and storage. */
	if (simulator.options.trace != NULL && !open_trace(&simulator)) {
		close_line(&simulator);
		return EXIT_FAILURE;
	}
	lw_host_on_end(on_signal);
	printf("ready %s\n",
	       simulator.options.tcp != NULL ? simulator.tcp.shown : simulator.options.port);
	if (fflush(stdout)) {
		fprintf(stderr, "lw_sim: \"ready\" cannot be written: %s\n", strerror(errno));
		close_line(&simulator);
		return EXIT_FAILURE;
	}

	ret = run(&simulator);
	close_line(&simulator);
	if (simulator.trace != NULL && fclose(simulator.trace)) {
		fprintf(stderr, "lw_sim: %s: %s\n", simulator.options.trace, strerror(errno));
		ret = EXIT_FAILURE;
	}
	return ret;
}
