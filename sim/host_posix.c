/* SPDX-License-Identifier: Apache-2.0 */
#define _GNU_SOURCE

#include "host.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

uint64_t lw_host_now_ns(void)
{
	struct timespec now;

	clock_gettime(CLOCK_MONOTONIC, &now);
	return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

int lw_host_open_alone(const char *path)
{
	const int fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644);

	if (fd < 0) {
		return -errno;
	}
	if (flock(fd, LOCK_EX | LOCK_NB)) {
		const int ret = errno == EWOULDBLOCK ? -EBUSY : -errno;

		close(fd);
		return ret;
	}
	return fd;
}

size_t lw_host_read_at(int fd, uint8_t *bytes, size_t size, long offset)
{
	const ssize_t length = pread(fd, bytes, size, offset);

	return length > 0 ? (size_t)length : 0;
}

int lw_host_write_at(int fd, const uint8_t *bytes, size_t length, long offset)
{
	const ssize_t written = pwrite(fd, bytes, length, offset);

	if (written < 0) {
		return -errno;
	}
	return (size_t)written != length ? -EIO : fsync(fd) ? -errno : 0;
}

void lw_host_on_end(void (*handler)(int number))
{
	const struct sigaction action = {.sa_handler = handler};

	sigaction(SIGINT, &action, NULL);
	sigaction(SIGTERM, &action, NULL);
	sigaction(SIGHUP, &action, NULL);
}
