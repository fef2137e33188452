/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Where a precondition ends the program: host code, beside the core and not in it.
 */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "lw/bytes/require.h"

bool lw_requirements_bind = true;

void lw_require_failed(const char *condition, const char *function, const char *file, int line)
{
	if (!lw_requirements_bind) {
		return;
	}
	fprintf(stderr, "%s:%d: %s() requires %s\n", file, line, function, condition);
	abort();
}
