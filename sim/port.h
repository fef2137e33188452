/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The byte side of the simulator: a pseudo terminal with a link to it, or a real serial port.
 */
#ifndef LW_PORT_H
#define LW_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#include "lw/device/device.h"

/** An open port. */
struct lw_port {
	int fd;
	int client_fd; /**< pty: our own hold on the client's side, so that clients may come and go
			*/
	bool echoes;   /**< pty: the terminal gives back what is written to it */
	struct lw_line line; /**< of a serial port */
	char link[4096];     /**< pty: the link to remove at the end; empty otherwise */
};

/** True if the path is a serial port, false if a pseudo terminal would be made. */
bool lw_port_is_serial(const char *path);

/**
 * Open a serial port, or make a pseudo terminal and a link to it.
 *
 * @retval 0 done
 * @retval -EEXIST the path is something else than a serial port or a link to a pseudo terminal
 * @retval -EADDRINUSE the path is a link to a pseudo terminal that is in use
 * @retval <0 another errno
 */
int lw_port_open(struct lw_port *port, const char *path, const struct lw_line *line);

/**
 * Give a serial port other line settings, after what has been written is sent. Does nothing to a
 * pseudo terminal, or if the settings are what they were.
 *
 * @retval 0 done
 * @retval <0 errno
 */
int lw_port_set_line(struct lw_port *port, const struct lw_line *line);

/**
 * Has a pseudo terminal begun or ceased to give back what is written to it, since the last call?
 * Who opens it may set it so (stty echo). Of a serial port nobody knows.
 */
bool lw_port_echo_changed(struct lw_port *port);

/** Drop what has come and has not been read. @return there was something */
bool lw_port_drop(struct lw_port *port);

/** Close, and remove the link if it is still ours. */
void lw_port_close(struct lw_port *port);

/** Read what has come without waiting: bytes, 0 if none, negative errno if the port is gone. */
ssize_t lw_port_read(struct lw_port *port, uint8_t *bytes, size_t size);

/** Write without waiting; what a client does not fetch is lost, as on a wire. */
void lw_port_write(struct lw_port *port, const uint8_t *bytes, size_t length);

#endif /* LW_PORT_H */
