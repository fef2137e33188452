/* SPDX-License-Identifier: Apache-2.0 */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "restart_native.h"

#define VARIABLE  "LEVELWIND_RESTART_NOTE"
#define FILES_MAX 1024

void restart_native_bottom(char **arguments, unsigned int note)
{
	char text[16];

	(void)snprintf(text, sizeof(text), "%u", note);
	(void)setenv(VARIABLE, text, 1);
	for (int file = STDERR_FILENO + 1; file < FILES_MAX; file++) {
		(void)close(file);
	}
	(void)execv("/proc/self/exe", arguments);
	perror("restart");
	_exit(1);
}

unsigned int restart_native_note(void)
{
	const char *text = getenv(VARIABLE);

	return text == NULL ? 0 : (unsigned int)strtoul(text, NULL, 10);
}
