/*
 * What an operator panel begins with: identify the controller, set a parameter, apply and save it,
 * then show the status once a second, and go on by itself after the line was cut. Usage:
 * panel PORT [PARITY [PITCH_UM]]; the simulator's pseudo terminal needs parity N.
 */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "levelwind_client.h"

static bool is_set(const struct levelwind_status *status, enum levelwind_flag flag)
{
	return status->flags >> flag & 1;
}

/* Open the port and see that the right controller answers. */
static int open_line(struct levelwind_client *client, const struct levelwind_line *line)
{
	struct levelwind_status status;
	int error = levelwind_connect(client, line);

	if (error != 0) {
		return error;
	}
	error = levelwind_identify(client, &status);
	if (error != 0) {
		levelwind_disconnect(client);
		return error;
	}
	printf("level wind controller %d.%d.%d\n", status.version_major, status.version_minor,
	       status.version_patch);
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

/* What the operator must see: permit, loss of synchronization, fault; then where and how fast. */
static void show(const struct levelwind_status *status)
{
	static const enum levelwind_flag los[] = {
		LEVELWIND_FLAG_LOS1_PLUS, LEVELWIND_FLAG_LOS1_MINUS, LEVELWIND_FLAG_LOS2_PLUS,
		LEVELWIND_FLAG_LOS2_MINUS};

	printf("%8.1f mm  %6.2f m/s  %s\n", status->position_um / 1e3,
	       status->rope_speed_mm_per_s / 1e3, levelwind_value_text("state", status->state));
	if (is_set(status, LEVELWIND_FLAG_LAUNCH_PERMIT)) {
		printf("  launch permitted\n");
	}
	for (int bit = 0; bit < 16; bit++) {
		if (status->launch_inhibit & 1 << bit) {
			printf("  no launch: %s\n", levelwind_value_text("launch_inhibit", bit));
		}
	}
	for (size_t i = 0; i < sizeof(los) / sizeof(los[0]); i++) {
		if (is_set(status, los[i])) {
			printf("  THE ROPE MAY BE LAID WRONG: %s\n",
			       levelwind_value_text("flags", (int32_t)los[i]));
		}
	}
	if (is_set(status, LEVELWIND_FLAG_FAULTED)) {
		printf("  FAULT: %s\n", levelwind_value_text("fault", status->fault));
	}
}

int main(int argc, char **argv)
{
	struct levelwind_client client = {0};
	struct levelwind_status status;
	struct levelwind_line line = {0};
	bool is_open = false;

	if (argc < 2) {
		fprintf(stderr, "usage: panel PORT [E|O|N [PITCH_UM]]\n");
		return EXIT_FAILURE;
	}
	(void)setvbuf(stdout, NULL, _IOLBF, 0);
	line.port = argv[1];
	line.parity = argc > 2 ? argv[2][0] : 'E';
	if (argc > 3) {
		if (open_line(&client, &line) != 0 ||
		    set_pitch(&client, (int32_t)strtol(argv[3], NULL, 10)) != 0) {
			fprintf(stderr, "panel: %s\n", levelwind_last_error_text(&client));
			return EXIT_FAILURE;
		}
		is_open = true;
	}
	for (;;) {
		if (!is_open) {
			is_open = open_line(&client, &line) == 0;
		}
		if (is_open && levelwind_read_status(&client, &status) != 0) {
			levelwind_disconnect(&client); /* its error text stays */
			is_open = false;
		}
		if (is_open) {
			show(&status);
		} else {
			/* Old values must not stay on the screen. */
			printf("no data: %s\n", levelwind_last_error_text(&client));
		}
		sleep(1);
	}
}
