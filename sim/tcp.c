/* SPDX-License-Identifier: Apache-2.0 */
#ifdef _WIN32
#include <winsock2.h>
#include <ws2tcpip.h>
#else
#define _GNU_SOURCE
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <unistd.h>
#endif

#include "tcp.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define UNIT_AT   (LW_TCP_HEAD - 1u)
#define BROADCAST 0u

/** Gateway target did not respond: there is nobody else behind this one. */
#define TARGET_SILENT 0x0Bu

/* The sockets of the two systems differ in type and in a few names. */
#ifdef _WIN32
typedef SOCKET os_socket;
typedef int os_size;

static void close_socket(intptr_t socket)
{
	closesocket((SOCKET)socket);
}

static bool set_nonblocking(intptr_t socket)
{
	u_long on = 1;

	return ioctlsocket((SOCKET)socket, (long)FIONBIO, &on) == 0;
}

static bool would_block(void)
{
	return WSAGetLastError() == WSAEWOULDBLOCK;
}

static bool start_sockets(void)
{
	WSADATA data;

	return WSAStartup(MAKEWORD(2, 2), &data) == 0;
}

/* Without it a second simulator could listen at the same port. */
#define OWN_ADDRESS SO_EXCLUSIVEADDRUSE
#define SEND_FLAGS  0
#else
typedef int os_socket;
typedef size_t os_size;

static void close_socket(intptr_t socket)
{
	close((int)socket);
}

static bool set_nonblocking(intptr_t socket)
{
	return fcntl((int)socket, F_SETFL, O_NONBLOCK) == 0 &&
	       fcntl((int)socket, F_SETFD, FD_CLOEXEC) == 0;
}

static bool would_block(void)
{
	return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

static bool start_sockets(void)
{
	return true;
}

#define OWN_ADDRESS SO_REUSEADDR
#define SEND_FLAGS  MSG_NOSIGNAL
#endif

/** Split HOST:PORT. @return false if it is none */
static bool split(const char *address, char *host, size_t size, const char **port)
{
	const char *colon = strrchr(address, ':');
	size_t length;

	if (colon == NULL || colon == address || colon[1] == '\0' ||
	    strspn(colon + 1, "0123456789") != strlen(colon + 1) ||
	    strtoul(colon + 1, NULL, 10) > UINT16_MAX) { /* getaddrinfo() takes it modulo 65536 */
		return false;
	}
	*port = colon + 1;
	length = (size_t)(colon - address);
	if (address[0] == '[' && colon[-1] == ']') {
		address++;
		length -= 2;
	}
	if (length == 0 || length >= size) {
		return false;
	}
	memcpy(host, address, length);
	host[length] = '\0';
	return true;
}

static void show(struct lw_tcp *tcp, const char *host)
{
	struct sockaddr_storage bound = {0};
	socklen_t size = sizeof(bound);
	unsigned int port = 0;

	if (getsockname((os_socket)tcp->socket, (struct sockaddr *)&bound, &size) == 0) {
		port = bound.ss_family == AF_INET6
			       ? ntohs(((const struct sockaddr_in6 *)&bound)->sin6_port)
			       : ntohs(((const struct sockaddr_in *)&bound)->sin_port);
	}
	snprintf(tcp->shown, sizeof(tcp->shown),
		 strchr(host, ':') != NULL ? "tcp://[%s]:%u" : "tcp://%s:%u", host, port);
}

int lw_tcp_open(struct lw_tcp *tcp, const char *address, const char **why)
{
	const struct addrinfo wanted = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE};
	struct addrinfo *found = NULL;
	const char *port;
	const int on = 1;
	char host[64];

	tcp->socket = -1;
	for (size_t i = 0; i < LW_TCP_CLIENTS_MAX; i++) {
		tcp->clients[i] = (struct lw_tcp_client){.socket = -1};
	}
	*why = "give ADDRESS:PORT, for example 127.0.0.1:1502";
	if (!split(address, host, sizeof(host), &port) || strlen(port) > 5) {
		return -EINVAL;
	}
	if (!start_sockets() || getaddrinfo(host, port, &wanted, &found) != 0) {
		*why = "there is no such address";
		return -EINVAL;
	}
	*why = "it is in use, or not an address of this machine, or needs more rights";
	tcp->socket = (intptr_t)socket(found->ai_family, found->ai_socktype, found->ai_protocol);

	const bool ok =
		tcp->socket >= 0 && set_nonblocking(tcp->socket) &&
		setsockopt((os_socket)tcp->socket, SOL_SOCKET, OWN_ADDRESS, (const char *)&on,
			   sizeof(on)) == 0 &&
		bind((os_socket)tcp->socket, found->ai_addr, (socklen_t)found->ai_addrlen) == 0 &&
		listen((os_socket)tcp->socket, LW_TCP_CLIENTS_MAX) == 0;

	freeaddrinfo(found);
	if (!ok) {
		if (tcp->socket >= 0) {
			close_socket(tcp->socket);
			tcp->socket = -1;
		}
		return -EIO;
	}
	show(tcp, host);
	return 0;
}

static void hang_up(struct lw_tcp_client *client)
{
	close_socket(client->socket);
	*client = (struct lw_tcp_client){.socket = -1};
}

static void take_clients(struct lw_tcp *tcp)
{
	for (;;) {
		const intptr_t socket = (intptr_t)accept((os_socket)tcp->socket, NULL, NULL);
		struct lw_tcp_client *seat = NULL;
		const int on = 1;

		if (socket < 0) {
			return;
		}
		for (size_t i = 0; i < LW_TCP_CLIENTS_MAX && seat == NULL; i++) {
			seat = tcp->clients[i].socket < 0 ? &tcp->clients[i] : NULL;
		}
		if (seat == NULL || !set_nonblocking(socket)) {
			close_socket(socket);
			continue;
		}
		(void)setsockopt((os_socket)socket, IPPROTO_TCP, TCP_NODELAY, (const char *)&on,
				 sizeof(on));
		*seat = (struct lw_tcp_client){.socket = socket};
	}
}

/** Execute a request, as the slave on a line does. @return bytes of the answer, 0: none */
static size_t execute(struct lw_world *world, uint8_t unit, const uint8_t *request, size_t length,
		      uint8_t response[LW_PDU_MAX], uint64_t now_us)
{
	struct lw_slave *slave = &world->device.slave;
	const bool was_listening_only = slave->pdu.listen_only;
	size_t answer;

	slave->pdu.counters[LW_BUS_MESSAGES]++;
	if (unit != BROADCAST && unit != slave->config->unit_id) {
		response[0] = request[0] | 0x80u;
		response[1] = TARGET_SILENT;
		return 2;
	}
	if (unit == BROADCAST && !lw_pdu_may_broadcast(request[0])) {
		slave->pdu.counters[LW_BUS_NO_RESPONSES]++;
		return 0;
	}
	slave->own_requests += unit != BROADCAST;
	answer = lw_pdu_handle(&slave->pdu, request, length, response);
	if (!was_listening_only || !slave->pdu.listen_only) {
		slave->last_request_us = now_us;
	}
	if (unit == BROADCAST && answer > 0) {
		slave->pdu.counters[LW_BUS_NO_RESPONSES]++;
		return 0;
	}
	return answer;
}

/** Answer the requests that are whole. @return false if what has come is no Modbus TCP */
static bool answer_requests(struct lw_tcp_client *client, struct lw_world *world, uint64_t now_us)
{
	uint8_t answer[LW_TCP_FRAME_MAX];

	while (client->length >= LW_TCP_HEAD) {
		uint8_t *frame = client->bytes;
		const size_t rest = (size_t)frame[4] << 8 | frame[5];
		const size_t size = UNIT_AT + rest;

		if (frame[2] != 0 || frame[3] != 0 || rest < 2 || size > LW_TCP_FRAME_MAX) {
			return false;
		}
		if (client->length < size) {
			return true;
		}

		const size_t length = execute(world, frame[UNIT_AT], &frame[LW_TCP_HEAD],
					      size - LW_TCP_HEAD, &answer[LW_TCP_HEAD], now_us);

		if (length > 0) {
			memcpy(answer, frame, LW_TCP_HEAD);
			answer[4] = (uint8_t)((length + 1) >> 8);
			answer[5] = (uint8_t)(length + 1);

			const long sent =
				(long)send((os_socket)client->socket, (const char *)answer,
					   (os_size)(LW_TCP_HEAD + length), SEND_FLAGS);

			if (sent != (long)(LW_TCP_HEAD + length)) {
				return false; /* it does not fetch its answers */
			}
		}
		client->length -= size;
		memmove(frame, &frame[size], client->length);
	}
	return true;
}

void lw_tcp_serve(struct lw_tcp *tcp, struct lw_world *world, uint64_t now_us)
{
	take_clients(tcp);
	for (size_t i = 0; i < LW_TCP_CLIENTS_MAX; i++) {
		struct lw_tcp_client *client = &tcp->clients[i];
		long count;

		if (client->socket < 0) {
			continue;
		}
		count = (long)recv((os_socket)client->socket,
				   (char *)&client->bytes[client->length],
				   (os_size)(sizeof(client->bytes) - client->length), 0);
		if (count > 0) {
			client->length += (size_t)count;
			if (!answer_requests(client, world, now_us)) {
				hang_up(client);
			}
		} else if (count == 0 || !would_block()) {
			hang_up(client);
		}
	}
}

void lw_tcp_wait(const struct lw_tcp *tcp, int fd, uint64_t timeout_ns)
{
	struct timeval timeout = {.tv_sec = (long)(timeout_ns / 1000000000u),
				  .tv_usec = (long)(timeout_ns / 1000u % 1000000u)};
	intptr_t last = fd;
	fd_set waited;

	FD_ZERO(&waited);
	if (fd >= 0) {
		FD_SET((os_socket)fd, &waited);
	}
	if (tcp->socket >= 0) {
		FD_SET((os_socket)tcp->socket, &waited);
		last = tcp->socket > last ? tcp->socket : last;
		for (size_t i = 0; i < LW_TCP_CLIENTS_MAX; i++) {
			const intptr_t socket = tcp->clients[i].socket;

			if (socket >= 0) {
				FD_SET((os_socket)socket, &waited);
				last = socket > last ? socket : last;
			}
		}
	}
	(void)select((int)last + 1, &waited, NULL, NULL, &timeout);
}

void lw_tcp_close(struct lw_tcp *tcp)
{
	for (size_t i = 0; i < LW_TCP_CLIENTS_MAX; i++) {
		if (tcp->clients[i].socket >= 0) {
			hang_up(&tcp->clients[i]);
		}
	}
	if (tcp->socket >= 0) {
		close_socket(tcp->socket);
		tcp->socket = -1;
	}
}
