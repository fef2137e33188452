/* SPDX-License-Identifier: Apache-2.0 */
/* Loads the native library as Python's ctypes does on Windows, and prints what it says: whether
 * each function of the command line is there, the layout of its structs, figures of its machine. */
#include <stdint.h>
#include <stdio.h>
#include <windows.h>

#include "lw/bytes/layout.h"

int main(int argc, char **argv)
{
	const HMODULE library = argc > 1 ? LoadLibraryA(argv[1]) : NULL;

	if (library == NULL) {
		fprintf(stderr, "error %lu\n", GetLastError());
		return 1;
	}
	for (int i = 2; i < argc; i++) {
		if (GetProcAddress(library, argv[i]) == NULL) {
			printf("lacks %s\n", argv[i]);
		}
	}

	const struct lw_layout *layout =
		(const void *)(uintptr_t)GetProcAddress(library, "lw_layout_native");
	double (*figure)(const char *) = (double (*)(const char *))(void *)GetProcAddress(
		library, "lw_native_machine_default");

	for (; layout->type != NULL; layout++) {
		printf("%s %s %u %u\n", layout->type, layout->name, (unsigned int)layout->offset,
		       (unsigned int)layout->size);
	}
	printf("screw_lead_mm %.3f\n", figure("screw_lead_mm"));
	return 0;
}
