/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A restart on native_sim: what the runner (restart_native_bottom.c), which is a program of the
 * host, does for the firmware.
 */
#ifndef RESTART_NATIVE_H
#define RESTART_NATIVE_H

/** Start this program anew with the same arguments. Does not return. */
void restart_native_bottom(char **arguments, unsigned int note);

/** The note of the program that started this one anew; 0 if it was started otherwise. */
unsigned int restart_native_note(void);

#endif /* RESTART_NATIVE_H */
