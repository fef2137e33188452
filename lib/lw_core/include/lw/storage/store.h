/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What the non-volatile storage holds, in slots: two for the parameters, two for the journal
 * (event log and counters), two for cam tables and two for what needs a look at the rope. Not for
 * interrupt context.
 *
 * A host only reads and writes whole slots. Here is decided what they mean: of each pair the newest
 * good record is used, and the slot that does not hold the newest intact one is written next. So a
 * write that is cut anywhere leaves the other record as it was.
 *
 * At power-up: lw_store_init(), lw_store_load() for each slot, lw_device_init().
 */
#ifndef LW_STORE_H
#define LW_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lw/cam/cam_banks.h"
#include "lw/storage/log.h"
#include "lw/storage/look_record.h"
#include "lw/map.h"
#include "lw/storage/param_record.h"
#include "lw/storage/record.h"

/** Slots, in pairs. */
enum {
	LW_STORE_PARAMS = 0,  /**< first slot of the parameters */
	LW_STORE_JOURNAL = 2, /**< first slot of the journal */
	LW_STORE_CAM = 4,     /**< first slot of the cam tables that were put in force */
	LW_STORE_LOOK = 6,    /**< first slot of what needs a look at the rope */
	LW_STORE_SLOTS = 8,
};

/** Bytes of the journal's record. */
#define LW_STORE_JOURNAL_SIZE (LW_RECORD_OVERHEAD + 4 * 4 + LW_LOG_RECORDS * LW_LOG_RECORD_SIZE)

/** Bytes of the longest cam table's record: the words of a bank, high byte first. */
#define LW_STORE_CAM_SIZE (LW_RECORD_OVERHEAD + 2 * LW_CAM_WORDS)

/** Bytes that a slot must hold. */
#define LW_STORE_SLOT_SIZE LW_STORE_CAM_SIZE

_Static_assert(LW_STORE_SLOT_SIZE >= LW_PARAM_RECORD_SIZE, "the parameters do not fit");
_Static_assert(LW_STORE_SLOT_SIZE >= LW_STORE_JOURNAL_SIZE, "the journal does not fit");
_Static_assert(LW_STORE_SLOT_SIZE >= LW_LOOK_RECORD_SIZE, "what needs a look does not fit");

/** Counters that survive power-off, as far as they were stored. */
struct lw_counters {
	uint32_t boots;
	uint32_t watchdog_resets;
	uint32_t powered_s;
	uint32_t tracking_s;
};

/** A pair of slots. */
struct lw_store_pair {
	enum lw_slot_state state[2];
	bool intact;              /**< at least one slot holds an intact record */
	uint8_t newest;           /**< which, the newest, of whatever schema */
	uint32_t newest_sequence; /**< its sequence number */
	bool used;                /**< at least one slot holds a good record */
	uint16_t used_schema;     /**< of the newest good one */
	uint32_t used_sequence;   /**< its sequence number */
};

/** State. */
struct lw_store {
	struct lw_store_pair
		pairs[LW_STORE_SLOTS / 2]; /**< parameters, journal, cam tables, look */
	struct lw_params params;           /**< stored set; factory values if there is none */
	struct lw_log log;                 /**< live; stored with the next journal */
	struct lw_counters counters;       /**< live; stored with the next journal */
	/** Live. After lw_store_load() each holds what the slot of the same number has, and is
	 *  empty or ready. */
	struct lw_cam_bank cam_banks[LW_CAM_BANKS];
	uint32_t log_stored; /**< newest event that is stored */
	struct lw_look look; /**< stored: what needs a look at the rope */

	struct lw_params saving; /**< waits to be written, or is being written */
	uint32_t log_writing;    /**< newest event of the journal being written */
	bool params_wanted;
	bool journal_wanted;
	struct lw_look look_next; /**< waits to be written, or is being written */
	bool look_wanted;
	const struct lw_cam_bank
		*cam_wanted; /**< bank to be stored, or NULL; cleared when written */
	bool writing;
	uint8_t writing_slot;
};

/** Empty: factory values, no events. */
void lw_store_init(struct lw_store *store);

/**
 * Look at what a slot holds. Slots may come in any order.
 *
 * @param slot 0 to LW_STORE_SLOTS - 1
 * @param size bytes that can be read; what follows the record does not matter
 */
void lw_store_load(struct lw_store *store, unsigned int slot, const uint8_t *bytes, size_t size);

/** True if a usable parameter set is stored. */
bool lw_store_has_params(const struct lw_store *store);

/** Ask for a parameter set to be stored. Not while lw_store_saving(). */
void lw_store_save(struct lw_store *store, const struct lw_params *params);

/** The bank that holds the newest stored cam table after lw_store_load(), or -1. */
int lw_store_cam_bank(const struct lw_store *store);

/** Ask for a bank to be stored. It is in force: nobody writes to it. */
void lw_store_save_cam(struct lw_store *store, const struct lw_cam_bank *bank);

/** Ask for what needs a look at the rope to be stored. Not while anything is being written. */
void lw_store_save_look(struct lw_store *store, const struct lw_look *look);

/** True while a parameter set waits to be written or is being written. */
bool lw_store_saving(const struct lw_store *store);

/**
 * Begin the write that is due, if any: what needs a look at the rope, parameters, the cam table,
 * then log and counters if `journal_wanted`.
 *
 * @param slot receives the slot to write
 * @param bytes receives what to write
 * @return its bytes; 0 if nothing is due, or another write has not ended yet
 */
size_t lw_store_begin_write(struct lw_store *store, unsigned int *slot,
			    uint8_t bytes[LW_STORE_SLOT_SIZE]);

/**
 * End a write. Without one begun, nothing happens.
 *
 * @param result 0, or a negative errno: what the slot holds is unknown
 */
void lw_store_end_write(struct lw_store *store, int result);

#endif /* LW_STORE_H */
