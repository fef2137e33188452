/* SPDX-License-Identifier: Apache-2.0 */
/*
 * FC20 and FC21: groups of records of files. A record is 16 bits wide.
 */
#include "pdu_handlers.h"

#include <errno.h>

#include "lw/bytes/big_endian.h"

/** Head of a request: function code, number of bytes. */
#define HEAD_SIZE 2u

/** Head of a group: reference type, file number, first record, number of records. */
#define GROUP_SIZE     7u
#define REFERENCE_TYPE 6u

/** Limits of MODBUS Application Protocol V1.1b3, 6.14 and 6.15, on the number of bytes. */
enum {
	READ_BYTES_MIN = 0x07,
	READ_BYTES_MAX = 0xF5,
	WRITE_BYTES_MIN = 0x09,
	WRITE_BYTES_MAX = 0xFB,
};

/** One group of a request. */
struct group {
	const struct lw_pdu_file *file;
	uint16_t first;
	uint16_t count;
};

static int check_byte_count(struct lw_pdu_exchange *exchange, uint8_t min, uint8_t max)
{
	uint8_t byte_count;
	int error = lw_pdu_check_head(exchange, HEAD_SIZE);

	if (error != 0) {
		return error;
	}
	byte_count = exchange->request[1];
	if (byte_count < min || byte_count > max) {
		return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_BAD_COUNT, byte_count,
				     byte_count < min ? min : max);
	}
	return lw_pdu_check_length(exchange, HEAD_SIZE + byte_count);
}

static const struct lw_pdu_file *find_file(const struct lw_pdu_config *config, uint16_t number)
{
	for (size_t i = 0; i < config->file_count; i++) {
		if (config->files[i].number == number) {
			return &config->files[i];
		}
	}
	return NULL;
}

/* The group whose head is at this place of the request; the head lies inside. */
static int parse_group(struct lw_pdu_exchange *exchange, size_t at, struct group *group)
{
	const uint8_t *head = &exchange->request[at];
	const uint16_t number = lw_get16(&head[1]);
	uint32_t size;

	if (head[0] != REFERENCE_TYPE) {
		return lw_pdu_refuse(exchange, -ENXIO, LW_REASON_BAD_REFERENCE_TYPE, head[0],
				     REFERENCE_TYPE);
	}
	group->file = find_file(exchange->pdu->config, number);
	if (group->file == NULL) {
		return lw_pdu_refuse(exchange, -ENXIO, LW_REASON_UNKNOWN_FILE, number, 0);
	}
	group->first = lw_get16(&head[3]);
	group->count = lw_get16(&head[5]);
	if (group->count == 0) {
		return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_BAD_COUNT, 0, 1);
	}
	size = group->file->record_count(group->file->context);
	if ((uint32_t)group->first + group->count > size) {
		const uint32_t last = (uint32_t)group->first + group->count - 1;

		lw_pdu_refuse(exchange, -ENXIO, LW_REASON_UNKNOWN_RECORD, last, size);
		exchange->why.address = group->first < size ? (uint16_t)size : group->first;
		return -ENXIO;
	}
	return 0;
}

int lw_pdu_read_file_record(struct lw_pdu_exchange *exchange)
{
	uint8_t *response = exchange->response;
	size_t length = HEAD_SIZE;
	struct group group;
	int error = check_byte_count(exchange, READ_BYTES_MIN, READ_BYTES_MAX);

	if (error == 0 && exchange->request[1] % GROUP_SIZE != 0) {
		error = lw_pdu_refuse(exchange, -EINVAL, LW_REASON_BAD_LENGTH, exchange->request[1],
				      exchange->request[1] / GROUP_SIZE * GROUP_SIZE);
	}
	for (size_t at = HEAD_SIZE; error == 0 && at < exchange->length; at += GROUP_SIZE) {
		size_t end;

		error = parse_group(exchange, at, &group);
		if (error != 0) {
			break;
		}
		end = length + 2 + 2 * (size_t)group.count;
		if (end > LW_PDU_MAX) {
			return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_ANSWER_TOO_LONG, end,
					     LW_PDU_MAX);
		}
		response[length] = (uint8_t)(end - length - 1);
		response[length + 1] = REFERENCE_TYPE;
		group.file->read(group.file->context, group.first, group.count,
				 &response[length + 2]);
		length = end;
	}
	if (error != 0) {
		return error;
	}
	response[1] = (uint8_t)(length - HEAD_SIZE);
	return (int)length;
}

typedef int (*write_stage)(struct lw_pdu_exchange *exchange, const struct group *group,
			   const uint8_t *in);

static int allow_group(struct lw_pdu_exchange *exchange, const struct group *group,
		       const uint8_t *in)
{
	const struct lw_pdu_file *file = group->file;

	if (file->allow == NULL) {
		lw_pdu_refuse(exchange, -ENXIO, LW_REASON_NOT_WRITABLE, file->number, 0);
		exchange->why.address = group->first;
		return -ENXIO;
	}
	return file->allow(file->context, group->first, group->count, in, &exchange->why);
}

static int write_group(struct lw_pdu_exchange *exchange, const struct group *group,
		       const uint8_t *in)
{
	(void)exchange;
	group->file->write(group->file->context, group->first, group->count, in);
	return 0;
}

/* Take every group of a write through one stage. */
static int walk_groups(struct lw_pdu_exchange *exchange, write_stage stage)
{
	size_t at = HEAD_SIZE;

	while (at < exchange->length) {
		const size_t left = exchange->length - at;
		struct group group;
		size_t size;
		int error;

		if (left < GROUP_SIZE) {
			return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_BAD_LENGTH, left,
					     GROUP_SIZE);
		}
		error = parse_group(exchange, at, &group);
		if (error != 0) {
			return error;
		}
		size = GROUP_SIZE + 2 * (size_t)group.count;
		if (left < size) {
			return lw_pdu_refuse(exchange, -EINVAL, LW_REASON_BAD_LENGTH, left, size);
		}
		error = stage(exchange, &group, &exchange->request[at + GROUP_SIZE]);
		if (error != 0) {
			return error;
		}
		at += size;
	}
	return 0;
}

int lw_pdu_write_file_record(struct lw_pdu_exchange *exchange)
{
	int error = check_byte_count(exchange, WRITE_BYTES_MIN, WRITE_BYTES_MAX);

	if (error == 0) {
		error = walk_groups(exchange, allow_group);
	}
	if (error == 0) {
		error = walk_groups(exchange, write_group);
	}
	return error != 0 ? error : lw_pdu_echo(exchange, exchange->length);
}
