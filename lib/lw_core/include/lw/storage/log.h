/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The event log: the last LW_LOG_RECORDS events, each with when, where and what. Not for interrupt
 * context.
 *
 * A record stands at the index `sequence % LW_LOG_RECORDS` as long as it is kept. So a reader can
 * fetch the log in several requests while it grows: every record is whole, and its sequence number
 * says where it belongs.
 */
#ifndef LW_LOG_H
#define LW_LOG_H

#include <stddef.h>
#include <stdint.h>

/** Events that are kept. */
#define LW_LOG_RECORDS 64

/** Bytes of a record on the line and in the storage: LW_LOG_RECORD_WORDS registers. */
#define LW_LOG_RECORD_WORDS 16
#define LW_LOG_RECORD_SIZE  (2 * LW_LOG_RECORD_WORDS)

/** Numbers that a power-up leaves out: more events than can come between two writes. A multiple of
 *  the records that are kept, so that the oldest one still gives way. */
#define LW_LOG_SKIP (64u * LW_LOG_RECORDS)

/** One event. */
struct lw_log_record {
	uint32_t sequence;   /**< rises over power-ups, from 1, with gaps; 0: empty record */
	uint32_t boot;       /**< power-up number, from 1 */
	uint32_t time_ms;    /**< since that power-up */
	uint16_t event;      /**< enum lw_event */
	uint16_t state;      /**< enum lw_state afterwards */
	int32_t detail;      /**< what it means depends on the event */
	int32_t position_um; /**< carriage */
	int64_t net_edges;   /**< odometer since that power-up */
};

/** The ring. All zero: empty. */
struct lw_log {
	struct lw_log_record records[LW_LOG_RECORDS];
	uint32_t newest; /**< its sequence number, 0: none */
};

/** Append an event; the oldest one gives way. `record->sequence` is set here. */
void lw_log_add(struct lw_log *log, struct lw_log_record record);

/**
 * Leave out the numbers of events that may have been added after the log was stored, and are lost.
 */
void lw_log_skip(struct lw_log *log);

/** Records that are not empty, 0 to LW_LOG_RECORDS. */
uint16_t lw_log_count(const struct lw_log *log);

/**
 * Copy one record.
 *
 * @param index 0 to LW_LOG_RECORDS - 1
 * @param record receives it; sequence 0 if there is none yet
 * @retval 0 done
 * @retval -ENXIO no such index; `record` is unchanged
 */
int lw_log_read(const struct lw_log *log, uint16_t index, struct lw_log_record *record);

/** The record as registers, big-endian, high word first, in the order of the struct's members. */
void lw_log_encode(const struct lw_log_record *record, uint8_t bytes[LW_LOG_RECORD_SIZE]);

/** The record from what lw_log_encode() has made. */
struct lw_log_record lw_log_decode(const uint8_t bytes[LW_LOG_RECORD_SIZE]);

#endif /* LW_LOG_H */
