/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What an operator panel begins with: identify the controller, set a parameter, apply and save it,
 * then show the live status, one request five times a second; keys: i index, s stop, r rope
 * looked at, d drum runs or rests; and go on by itself after the line was cut. Usage: panel PORT
 * [PARITY [PITCH_UM]]; the simulator's pseudo terminal needs parity N.
 */
#define _POSIX_C_SOURCE 200809L

#include <errno.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "levelwind_client.h"

#define READ_EVERY_MS 200
#define SHOW_EVERY    5 /* readings, unless something changes */

/* Sticky, and never hidden: what the operator must know, and what to do. */
static const struct {
	enum levelwind_flag flag;
	const char *what;
	const char *what_to_do;
} alarms[] = {
	{LEVELWIND_FLAG_LOS1_PLUS, "THE ROPE MAY BE LAID WRONG", "look at the rope, then index"},
	{LEVELWIND_FLAG_LOS1_MINUS, "THE ROPE MAY BE LAID WRONG", "look at the rope, then index"},
	{LEVELWIND_FLAG_LOS2_PLUS, "THE ROPE MAY BE LAID WRONG", "look at the rope, then index"},
	{LEVELWIND_FLAG_LOS2_MINUS, "THE ROPE MAY BE LAID WRONG", "look at the rope, then index"},
	{LEVELWIND_FLAG_ENCODER_FAULT, "THE ROPE MAY BE LAID WRONG",
	 "look at the rope, check the encoder and its wires, then index"},
	{LEVELWIND_FLAG_ROPE_LAID_STANDING, "THE ROPE IS LAID WRONG",
	 "pull out what lies badly, index, then r: rope looked at"},
};

/* The panel: its line, and the command that is going on. */
struct panel {
	struct levelwind_client client;
	struct levelwind_line line;
	bool is_open;
	bool has_keys;
	bool drum_runs;  /* as the controller was told last */
	bool is_waiting; /* for the end of `given` */
	struct levelwind_given given;
	struct levelwind_status shown;
	bool data_is_shown;
	int readings_until_shown;
};

/* Open the port and see that the right controller answers. */
static int open_line(struct panel *panel)
{
	struct levelwind_status status;
	int error = levelwind_connect(&panel->client, &panel->line);

	if (error != 0) {
		return error;
	}
	error = levelwind_identify(&panel->client, &status);
	if (error != 0) {
		levelwind_disconnect(&panel->client);
		return error;
	}
	printf("level wind controller %d.%d.%d\n", status.version_major, status.version_minor,
	       status.version_patch);
	panel->is_open = true;
	return 0;
}

static int set_pitch(struct levelwind_client *client, int32_t pitch_um)
{
	int error = levelwind_set_parameter(client, "pitch_um", pitch_um);

	if (error == 0) {
		error = levelwind_command(client, LEVELWIND_COMMAND_APPLY, 1000, NULL);
	}
	if (error == 0) {
		error = levelwind_command(client, LEVELWIND_COMMAND_SAVE, 5000, NULL);
	}
	return error;
}

static void red(const char *what, const char *text, const char *what_to_do)
{
	const bool in_colour = isatty(STDOUT_FILENO);

	printf("%s  %s: %s%s%s%s\n", in_colour ? "\033[1;31m" : "", what, text,
	       what_to_do[0] != 0 ? ". To do: " : "", what_to_do, in_colour ? "\033[0m" : "");
}

/* Metres are worth nothing without whether they may be wrong. */
static void show_rope(const struct levelwind_status *status)
{
	const bool doubtful = levelwind_has_flag(status, LEVELWIND_FLAG_ROPE_DOUBTFUL);

	if (status->rope_radius_um == 0) {
		return; /* this winch does not count them, or nobody has told how much there is */
	}
	printf("  rope: %.1f m on the drum, %.1f m out, layer %d%s\n",
	       status->rope_on_drum_mm / 1e3, status->rope_out_mm / 1e3, status->rope_layer,
	       doubtful ? "  DOUBTFUL: tell it anew (set_rope)" : "");
}

/* What the operator must see: permit, alarms, fault; then where and how fast. */
static void show(const struct levelwind_status *status)
{
	printf("%8.1f mm  %6.2f m/s  %s\n", status->position_um / 1e3,
	       status->rope_speed_mm_per_s / 1e3, levelwind_value_text("state", status->state));
	show_rope(status);
	if (levelwind_has_flag(status, LEVELWIND_FLAG_LAUNCH_PERMIT)) {
		printf("  launch permitted\n");
	}
	for (int bit = 0; bit < 16; bit++) {
		if (status->launch_inhibit & 1 << bit) {
			printf("  no launch: %s\n", levelwind_value_text("launch_inhibit", bit));
		}
	}
	for (size_t i = 0; i < sizeof(alarms) / sizeof(alarms[0]); i++) {
		if (levelwind_has_flag(status, alarms[i].flag)) {
			red(alarms[i].what, levelwind_flag_text(alarms[i].flag),
			    alarms[i].what_to_do);
		}
	}
	if (levelwind_has_flag(status, LEVELWIND_FLAG_FAULTED)) {
		red("FAULT", levelwind_value_text("fault", status->fault), "");
	}
}

static bool looks_the_same(const struct levelwind_status *a, const struct levelwind_status *b)
{
	return a->state == b->state && a->fault == b->fault && a->flags == b->flags &&
	       a->flags_2 == b->flags_2 && a->launch_inhibit == b->launch_inhibit;
}

static void read_and_show(struct panel *panel)
{
	struct levelwind_status status = {0};

	if (!panel->is_open) {
		(void)open_line(panel);
	}
	if (panel->is_open && levelwind_read_live(&panel->client, &status) != 0) {
		levelwind_disconnect(&panel->client); /* its error text stays */
		panel->is_open = false;
	}
	panel->readings_until_shown--;
	if (panel->readings_until_shown > 0 && panel->is_open == panel->data_is_shown &&
	    looks_the_same(&status, &panel->shown)) {
		return;
	}
	panel->readings_until_shown = SHOW_EVERY;
	panel->data_is_shown = panel->is_open;
	panel->shown = status;
	if (panel->is_open) {
		show(&status);
	} else {
		/* Old values must not stay on the screen. */
		printf("no data: %s\n", levelwind_last_error_text(&panel->client));
	}
}

/* Ask how the command goes on; the answers that tell nothing yet are asked for again. */
static void follow_command(struct panel *panel)
{
	switch (levelwind_poll_command(&panel->client, &panel->given, NULL)) {
	case 0:
		printf("  %s: done\n", panel->given.command == LEVELWIND_COMMAND_INDEX ? "index"
				       : panel->given.command == LEVELWIND_COMMAND_ACKNOWLEDGE_ROPE
					       ? "rope looked at"
					       : "stop");
		break;
	case -EPERM:
	case -ECANCELED:
	case -ECONNRESET:
		printf("  %s\n", levelwind_last_error_text(&panel->client));
		break;
	default:
		return;
	}
	panel->is_waiting = false;
}

/* What a PLC does when it switches the winch motor on and off. */
static void tell_drum(struct panel *panel)
{
	const bool runs = !panel->drum_runs;

	if (!panel->is_open || levelwind_set_drum_running(&panel->client, runs) != 0) {
		printf("  %s\n", levelwind_last_error_text(&panel->client));
		return;
	}
	panel->drum_runs = runs;
	printf("  told: the drum %s\n", runs ? "runs" : "rests");
}

static void take_key(struct panel *panel)
{
	enum levelwind_command command;
	char key;

	if (read(STDIN_FILENO, &key, 1) != 1) {
		panel->has_keys = false;
		return;
	}
	if (key == 'i') {
		command = LEVELWIND_COMMAND_INDEX;
	} else if (key == 's') {
		command = LEVELWIND_COMMAND_STOP;
	} else if (key == 'r') {
		command = LEVELWIND_COMMAND_ACKNOWLEDGE_ROPE;
	} else if (key == 'd') {
		tell_drum(panel);
		return;
	} else {
		return;
	}
	panel->is_waiting = panel->is_open &&
			    levelwind_start_command(&panel->client, command, &panel->given) == 0;
	if (!panel->is_waiting) {
		printf("  %s\n", levelwind_last_error_text(&panel->client));
	}
}

int main(int argc, char **argv)
{
	struct panel panel = {.has_keys = true};
	struct pollfd keys = {.events = POLLIN};

	if (argc < 2) {
		fprintf(stderr, "usage: panel PORT [E|O|N [PITCH_UM]]\n");
		return EXIT_FAILURE;
	}
	(void)setvbuf(stdout, NULL, _IOLBF, 0);
	panel.line.port = argv[1];
	panel.line.parity = argc > 2 ? argv[2][0] : 'E';
	if (argc > 3 && (open_line(&panel) != 0 ||
			 set_pitch(&panel.client, (int32_t)strtol(argv[3], NULL, 10)) != 0)) {
		fprintf(stderr, "panel: %s\n", levelwind_last_error_text(&panel.client));
		return EXIT_FAILURE;
	}
	printf("keys, each with Enter: i index, s stop, r rope looked at, d drum runs or rests\n");
	for (;;) {
		read_and_show(&panel);
		if (panel.is_open && panel.is_waiting) {
			follow_command(&panel);
		}
		keys.fd = panel.has_keys ? STDIN_FILENO : -1;
		if (poll(&keys, 1, READ_EVERY_MS) > 0) {
			take_key(&panel);
		}
	}
}
