/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What the simulator asks of the operating system beside its ports: time, files, signals.
 */
#ifndef LW_HOST_H
#define LW_HOST_H

#include <stddef.h>
#include <stdint.h>

/** A clock that never goes back, in ns. */
uint64_t lw_host_now_ns(void);

/**
 * Open a file for reading and writing, made if it is not there, for this program alone.
 *
 * @return a descriptor
 * @retval -EBUSY another program has it open
 * @retval <0 another errno
 */
int lw_host_open_alone(const char *path);

/** Bytes of a file from `offset` on. @return bytes read, 0 at its end or after an error */
size_t lw_host_read_at(int fd, uint8_t *bytes, size_t size, long offset);

/**
 * Write bytes into a file, and to the disk.
 *
 * @retval 0 done
 * @retval -EIO not all of it
 * @retval <0 another errno
 */
int lw_host_write_at(int fd, const uint8_t *bytes, size_t length, long offset);

/** Call `handler` when somebody asks this program to end. */
void lw_host_on_end(void (*handler)(int number));

#endif /* LW_HOST_H */
