/*
 * What an operator panel begins with: identify the controller, set a parameter, apply and save it,
 * then show the status once a second. Usage: panel PORT [PARITY [PITCH_UM]]; the simulator's
 * pseudo terminal needs parity N.
 */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "levelwind_client.h"

static void require(const struct levelwind_client *client, int error)
{
	if (error != 0) {
		fprintf(stderr, "panel: %s\n", levelwind_last_error_text(client));
		exit(EXIT_FAILURE);
	}
}

int main(int argc, char **argv)
{
	struct levelwind_client client = {0};
	struct levelwind_status status;
	struct levelwind_line line = {0};

	if (argc < 2) {
		fprintf(stderr, "usage: panel PORT [E|O|N [PITCH_UM]]\n");
		return EXIT_FAILURE;
	}
	line.port = argv[1];
	line.parity = argc > 2 ? argv[2][0] : 'E';
	require(&client, levelwind_connect(&client, &line));
	require(&client, levelwind_identify(&client, &status));
	printf("level wind controller %d.%d.%d\n", status.version_major, status.version_minor,
	       status.version_patch);

	if (argc > 3) {
		require(&client, levelwind_set_parameter(&client, "pitch_um",
							 (int32_t)strtol(argv[3], NULL, 10)));
		require(&client, levelwind_command(&client, LEVELWIND_COMMAND_APPLY, 1000, NULL));
		require(&client, levelwind_command(&client, LEVELWIND_COMMAND_SAVE, 5000, NULL));
	}
	for (;;) {
		if (levelwind_read_status(&client, &status) != 0) {
			printf("no status: %s\n", levelwind_last_error_text(&client));
			sleep(1);
			continue;
		}
		printf("%8.1f mm  %6.2f m/s  %s\n", status.position_um / 1e3,
		       status.rope_speed_mm_per_s / 1e3,
		       levelwind_value_text("state", status.state));
		for (int bit = 0; bit < 16; bit++) {
			if (status.launch_inhibit & 1 << bit) {
				printf("  no launch: %s\n",
				       levelwind_value_text("launch_inhibit", bit));
			}
		}
		sleep(1);
	}
}
