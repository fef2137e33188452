/* SPDX-License-Identifier: Apache-2.0 */
/* Windows has no pseudo terminals, and serial ports of another kind: there the simulator speaks
 * Modbus TCP only. */
#include "host.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <signal.h>
#include <stdio.h>
#include <sys/stat.h>
#include <windows.h>

#include "port.h"

uint64_t lw_host_now_ns(void)
{
	/* Not clock_gettime(): which library has that depends on the compiler's threads. */
	LARGE_INTEGER ticks, ticks_per_s;

	QueryPerformanceFrequency(&ticks_per_s);
	QueryPerformanceCounter(&ticks);

	const uint64_t s = (uint64_t)(ticks.QuadPart / ticks_per_s.QuadPart);
	const uint64_t rest = (uint64_t)(ticks.QuadPart % ticks_per_s.QuadPart);

	return s * 1000000000u + rest * 1000000000u / (uint64_t)ticks_per_s.QuadPart;
}

int lw_host_open_alone(const char *path)
{
	int fd;
	const int error = _sopen_s(&fd, path, _O_RDWR | _O_CREAT | _O_BINARY | _O_NOINHERIT,
				   _SH_DENYRW, _S_IREAD | _S_IWRITE);

	/* A file that another program has is "access denied", as is one of another user. */
	return error == EACCES ? -EBUSY : error ? -error : fd;
}

size_t lw_host_read_at(int fd, uint8_t *bytes, size_t size, long offset)
{
	const int length =
		_lseek(fd, offset, SEEK_SET) < 0 ? -1 : _read(fd, bytes, (unsigned int)size);

	return length > 0 ? (size_t)length : 0;
}

int lw_host_write_at(int fd, const uint8_t *bytes, size_t length, long offset)
{
	if (_lseek(fd, offset, SEEK_SET) < 0) {
		return -errno;
	}

	const int written = _write(fd, bytes, (unsigned int)length);

	if (written < 0) {
		return -errno;
	}
	return (size_t)written != length ? -EIO : _commit(fd) ? -errno : 0;
}

void lw_host_on_end(void (*handler)(int number))
{
	signal(SIGINT, handler);
	signal(SIGTERM, handler);
	signal(SIGBREAK, handler);
}

bool lw_port_is_serial(const char *path)
{
	(void)path;
	return false;
}

int lw_port_open(struct lw_port *port, const char *path, const struct lw_line *line)
{
	(void)path;
	(void)line;
	*port = (struct lw_port){.fd = -1, .client_fd = -1};
	return -ENOTSUP;
}

int lw_port_set_line(struct lw_port *port, const struct lw_line *line)
{
	(void)port;
	(void)line;
	return 0;
}

bool lw_port_echo_changed(struct lw_port *port)
{
	(void)port;
	return false;
}

bool lw_port_drop(struct lw_port *port)
{
	(void)port;
	return false;
}

void lw_port_close(struct lw_port *port)
{
	(void)port;
}

ssize_t lw_port_read(struct lw_port *port, uint8_t *bytes, size_t size)
{
	(void)port;
	(void)bytes;
	(void)size;
	return 0;
}

void lw_port_write(struct lw_port *port, const uint8_t *bytes, size_t length)
{
	(void)port;
	(void)bytes;
	(void)length;
}
