/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The simulator's Modbus TCP server: many clients, whole requests straight to the controller.
 */
#ifndef LW_TCP_H
#define LW_TCP_H

#include <stddef.h>
#include <stdint.h>

#include "world.h"

/** So many at once; who comes later is hung up on. */
#define LW_TCP_CLIENTS_MAX 16

/** Transaction, protocol, length and unit before a PDU. */
#define LW_TCP_HEAD      7u
#define LW_TCP_FRAME_MAX (LW_TCP_HEAD + LW_PDU_MAX)

/** A connection. */
struct lw_tcp_client {
	intptr_t socket; /**< -1: free */
	size_t length;
	uint8_t bytes[LW_TCP_FRAME_MAX]; /**< of a request that is not whole yet */
};

/** A server. */
struct lw_tcp {
	intptr_t socket;
	struct lw_tcp_client clients[LW_TCP_CLIENTS_MAX];
	char shown[80]; /**< tcp://ADDRESS:PORT, with the port that was given for 0 */
};

/**
 * Listen.
 *
 * @param address ADDRESS:PORT, or [ADDRESS]:PORT
 * @param why receives the reason in words
 * @retval 0 done
 * @retval -EINVAL no such address
 * @retval -EIO the system refused
 */
int lw_tcp_open(struct lw_tcp *tcp, const char *address, const char **why);

/** Take new clients, and answer all requests that are whole. Does not wait. */
void lw_tcp_serve(struct lw_tcp *tcp, struct lw_world *world, uint64_t now_us);

/**
 * Wait until something comes.
 *
 * @param fd of a port beside it, -1 for none
 * @param timeout_ns at most so long
 */
void lw_tcp_wait(const struct lw_tcp *tcp, int fd, uint64_t timeout_ns);

/** Hang up on everybody. */
void lw_tcp_close(struct lw_tcp *tcp);

#endif /* LW_TCP_H */
