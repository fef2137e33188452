/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/storage/log.h"

#include <errno.h>

#include "lw/bytes/big_endian.h"

void lw_log_add(struct lw_log *log, struct lw_log_record record)
{
	record.sequence = ++log->newest;
	log->records[record.sequence % LW_LOG_RECORDS] = record;
}

void lw_log_skip(struct lw_log *log)
{
	log->newest += LW_LOG_SKIP;
}

uint16_t lw_log_count(const struct lw_log *log)
{
	unsigned int count = 0;

	for (size_t i = 0; i < LW_LOG_RECORDS; i++) {
		count += log->records[i].sequence != 0 ? 1 : 0;
	}
	return (uint16_t)count;
}

int lw_log_read(const struct lw_log *log, uint16_t index, struct lw_log_record *record)
{
	if (index >= LW_LOG_RECORDS) {
		return -ENXIO;
	}
	*record = log->records[index];
	return 0;
}

void lw_log_encode(const struct lw_log_record *record, uint8_t bytes[LW_LOG_RECORD_SIZE])
{
	uint8_t *at = bytes;

	at = lw_put32(at, record->sequence);
	at = lw_put32(at, record->boot);
	at = lw_put32(at, record->time_ms);
	at = lw_put16(at, record->event);
	at = lw_put16(at, record->state);
	at = lw_put32(at, (uint32_t)record->detail);
	at = lw_put32(at, (uint32_t)record->position_um);
	at = lw_put32(at, (uint32_t)((uint64_t)record->net_edges >> 32));
	(void)lw_put32(at, (uint32_t)record->net_edges);
}

struct lw_log_record lw_log_decode(const uint8_t bytes[LW_LOG_RECORD_SIZE])
{
	return (struct lw_log_record){
		.sequence = lw_get32(bytes),
		.boot = lw_get32(bytes + 4),
		.time_ms = lw_get32(bytes + 8),
		.event = lw_get16(bytes + 12),
		.state = lw_get16(bytes + 14),
		.detail = (int32_t)lw_get32(bytes + 16),
		.position_um = (int32_t)lw_get32(bytes + 20),
		.net_edges = (int64_t)((uint64_t)lw_get32(bytes + 24) << 32 | lw_get32(bytes + 28)),
	};
}
