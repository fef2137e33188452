/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/modbus/rtu.h"

#include <errno.h>
#include <string.h>

#include "lw/modbus/crc16.h"

#define CRC_SIZE  2u
/** Unit id, function code, CRC. */
#define FRAME_MIN 4u

uint32_t lw_rtu_silence_us(uint32_t baud)
{
	/* 3.5 characters * 11 bits * 1e6 us / baud */
	return baud > 19200 ? 1750 : (38500000u + baud - 1) / baud;
}

uint32_t lw_rtu_byte_us(uint32_t baud)
{
	return (11000000u + baud - 1) / baud;
}

void lw_rtu_init(struct lw_rtu *rtu, const struct lw_rtu_config *config)
{
	*rtu = (struct lw_rtu){.config = *config};
}

void lw_rtu_reconfigure(struct lw_rtu *rtu, const struct lw_rtu_config *config)
{
	rtu->config = *config;
}

uint64_t lw_rtu_deadline_us(const struct lw_rtu *rtu)
{
	return rtu->length == 0 ? UINT64_MAX : rtu->last_byte_us + rtu->config.silence_us;
}

static bool is_complete(const struct lw_rtu *rtu, uint64_t now_us)
{
	return rtu->length > 0 && now_us >= lw_rtu_deadline_us(rtu);
}

int lw_rtu_receive(struct lw_rtu *rtu, const uint8_t *bytes, size_t count, uint64_t now_us)
{
	if (count == 0) {
		return 0;
	}
	if (is_complete(rtu, now_us)) {
		return -EAGAIN;
	}
	if (rtu->length == 0) {
		rtu->first_byte_us = now_us;
	} else if (rtu->config.character_gap_us > 0 &&
		   now_us - rtu->last_byte_us > rtu->config.character_gap_us) {
		rtu->gap_seen = true;
	}
	rtu->last_byte_us = now_us;
	if (rtu->length > LW_RTU_FRAME_MAX || count > LW_RTU_FRAME_MAX - rtu->length) {
		rtu->length = LW_RTU_FRAME_MAX + 1;
		return 0;
	}
	memcpy(&rtu->frame[rtu->length], bytes, count);
	rtu->length += count;
	return 0;
}

void lw_rtu_drop(struct lw_rtu *rtu)
{
	rtu->length = 0;
	rtu->gap_seen = false;
}

int lw_rtu_poll(struct lw_rtu *rtu, uint64_t now_us, const uint8_t **frame)
{
	size_t length = rtu->length;
	bool gap_seen = rtu->gap_seen;

	if (!is_complete(rtu, now_us)) {
		return 0;
	}
	lw_rtu_drop(rtu);
	if (length > LW_RTU_FRAME_MAX) {
		return -EMSGSIZE;
	}
	if (length < FRAME_MIN || gap_seen || lw_crc16(rtu->frame, length) != 0) {
		return -EBADMSG;
	}
	*frame = rtu->frame;
	return (int)(length - CRC_SIZE);
}

size_t lw_rtu_seal(uint8_t *frame, size_t length)
{
	uint16_t crc = lw_crc16(frame, length);

	frame[length] = (uint8_t)crc;
	frame[length + 1] = (uint8_t)(crc >> 8);
	return length + CRC_SIZE;
}
