/* SPDX-License-Identifier: Apache-2.0 */
#define _GNU_SOURCE

#include "port.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

/** A link to a pseudo terminal, alive or not: what a simulator makes, or has left behind. */
static bool is_pty_link(const char *path)
{
	static const char folder[] = "/dev/pts/";
	char target[sizeof(folder)] = "";

	return readlink(path, target, sizeof(target) - 1) == (ssize_t)sizeof(target) - 1 &&
	       strcmp(target, folder) == 0;
}

static bool links_to(const char *path, const char *expected)
{
	char target[128];
	const ssize_t length = readlink(path, target, sizeof(target) - 1);

	if (length < 0) {
		return false;
	}
	target[length] = '\0';
	return strcmp(target, expected) == 0;
}

bool lw_port_is_serial(const char *path)
{
	struct stat info;

	return !is_pty_link(path) && stat(path, &info) == 0 && S_ISCHR(info.st_mode);
}

static speed_t speed_of(uint32_t baud)
{
	switch (baud) {
	case 1200:
		return B1200;
	case 2400:
		return B2400;
	case 4800:
		return B4800;
	case 9600:
		return B9600;
	case 38400:
		return B38400;
	case 57600:
		return B57600;
	case 115200:
		return B115200;
	default:
		return B19200;
	}
}

static int configure_serial(struct lw_port *port, const struct lw_line *line)
{
	struct termios settings;

	if (tcgetattr(port->fd, &settings)) {
		return -errno;
	}
	cfmakeraw(&settings);
	cfsetspeed(&settings, speed_of(line->baud_rate));
	settings.c_cflag |= CLOCAL | CREAD;
	settings.c_cflag &= ~(tcflag_t)(PARENB | PARODD | CSTOPB);
	if (line->format == LW_LINE_FORMAT_8E1) {
		settings.c_cflag |= PARENB;
	} else if (line->format == LW_LINE_FORMAT_8O1) {
		settings.c_cflag |= PARENB | PARODD;
	} else if (line->format == LW_LINE_FORMAT_8N2) {
		settings.c_cflag |= CSTOPB;
	}
	if (tcsetattr(port->fd, TCSADRAIN, &settings)) {
		return -errno;
	}
	port->line = *line;
	return 0;
}

static int open_serial(struct lw_port *port, const char *path, const struct lw_line *line)
{
	int ret;

	port->fd = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
	if (port->fd < 0) {
		return -errno;
	}
	/* Two programs at one port take each other's bytes. */
	ret = flock(port->fd, LOCK_EX | LOCK_NB) ? -EBUSY : configure_serial(port, line);
	if (ret) {
		close(port->fd);
	}
	return ret;
}

static int make_link(struct lw_port *port, const char *target, const char *path)
{
	struct stat info;

	if (lstat(path, &info) == 0) {
		if (!is_pty_link(path)) {
			return -EEXIST;
		}
		if (stat(path, &info) == 0 && !links_to(path, target)) {
			return -EADDRINUSE;
		}
		(void)unlink(path); /* left behind by a simulator that was killed */
	}
	if ((size_t)snprintf(port->link, sizeof(port->link), "%s", path) >= sizeof(port->link)) {
		return -ENAMETOOLONG;
	}
	if (symlink(target, path)) {
		port->link[0] = '\0';
		return -errno;
	}
	return 0;
}

static int open_pty(struct lw_port *port, const char *path)
{
	struct termios settings;
	char name[128];
	int ret;

	port->fd = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
	if (port->fd < 0) {
		return -errno;
	}
	if (grantpt(port->fd) || unlockpt(port->fd) ||
	    ptsname_r(port->fd, name, sizeof(name)) != 0) {
		ret = -errno;
		goto fail;
	}
	port->client_fd = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
	if (port->client_fd < 0) {
		ret = -errno;
		goto fail;
	}
	if (tcgetattr(port->client_fd, &settings) == 0) {
		cfmakeraw(&settings);
		(void)tcsetattr(port->client_fd, TCSANOW, &settings);
	}
	ret = make_link(port, name, path);
	if (ret == 0) {
		return 0;
	}
	close(port->client_fd);
fail:
	close(port->fd);
	return ret;
}

int lw_port_open(struct lw_port *port, const char *path, const struct lw_line *line)
{
	*port = (struct lw_port){.fd = -1, .client_fd = -1};
	return lw_port_is_serial(path) ? open_serial(port, path, line) : open_pty(port, path);
}

int lw_port_set_line(struct lw_port *port, const struct lw_line *line)
{
	const bool is_pty = port->client_fd >= 0;

	if (is_pty ||
	    (line->baud_rate == port->line.baud_rate && line->format == port->line.format)) {
		return 0;
	}
	return configure_serial(port, line);
}

bool lw_port_echo_changed(struct lw_port *port)
{
	struct termios settings;
	const bool before = port->echoes;

	if (port->client_fd >= 0 && tcgetattr(port->client_fd, &settings) == 0) {
		port->echoes = (settings.c_lflag & ECHO) != 0;
	}
	return port->echoes != before;
}

bool lw_port_drop(struct lw_port *port)
{
	uint8_t bytes[256];

	bool any = false;

	while (lw_port_read(port, bytes, sizeof(bytes)) > 0) {
		any = true;
	}
	return any;
}

void lw_port_close(struct lw_port *port)
{
	char own[128];

	/* Somebody may have put another port in its place. */
	if (port->link[0] != '\0' && ptsname_r(port->fd, own, sizeof(own)) == 0 &&
	    links_to(port->link, own)) {
		(void)unlink(port->link);
	}
	if (port->client_fd >= 0) {
		close(port->client_fd);
	}
	close(port->fd);
}

ssize_t lw_port_read(struct lw_port *port, uint8_t *bytes, size_t size)
{
	const ssize_t count = read(port->fd, bytes, size);

	if (count >= 0) {
		return count == 0 && port->client_fd < 0 ? -EIO : count;
	}
	return errno == EAGAIN || errno == EINTR ? 0 : -errno;
}

void lw_port_write(struct lw_port *port, const uint8_t *bytes, size_t length)
{
	const ssize_t written = write(port->fd, bytes, length);

	(void)written;
}
