/* SPDX-License-Identifier: Apache-2.0 */
/*
 * On native_sim a restart is a new process. It keeps what survives a restart of a real processor:
 * the flash, a file, and the watchdog's note.
 */
#include <cmdline.h>
#include <zephyr/init.h>

#include "restart_native.h"
#include "watch.h"

void sys_arch_reboot(int type)
{
	int count;
	char **arguments;

	ARG_UNUSED(type);
	native_get_cmd_line_args(&count, &arguments);
	restart_native_bottom(arguments, watch_note);
}

static int take_note(void)
{
	watch_note = restart_native_note();
	return 0;
}

SYS_INIT(take_note, APPLICATION, 0);
