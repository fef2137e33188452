/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The whole level wind controller as one object: control, parameter sets, commands, Modbus slave.
 * A host owns one, feeds it pins, bytes and time, and does what it asks for.
 *
 * Encoder, limit switches, edge timer and tick go to `device.controller` (lw/control/controller.h),
 * bytes to `device.slave` (lw/modbus/slave.h). Functions here are not for interrupt context.
 */
#ifndef LW_DEVICE_H
#define LW_DEVICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lw/modbus/bank.h"
#include "lw/control/controller.h"
#include "lw/device/kept.h"
#include "lw/device/lock.h"
#include "lw/device/set_copy.h"
#include "lw/map.h"
#include "lw/control/params.h"
#include "lw/modbus/slave.h"
#include "lw/storage/store.h"

/** Sections of the bank that a device makes itself, and room for the host's. */
enum {
	LW_DEVICE_SECTIONS = 9,
	LW_DEVICE_HOST_SECTIONS = 1,
};

/** Causes of events that may come and go again and again (journal.c). */
enum {
	LW_DEVICE_CAUSES = 12
};

/** Files of FC20 and FC21. */
enum {
	LW_DEVICE_LOG_FILE = 1, /**< number of the event log: LW_LOG_RECORD_WORDS for each event */
	LW_DEVICE_CAM_FILE = 2, /**< number of the first bank of cam tables (lw/cam/cam_banks.h) */
	LW_DEVICE_FILES = 1 + LW_CAM_BANKS,
};

/** What the host measures of itself; 0 where it cannot. */
struct lw_device_health {
	uint32_t encoder_interrupt_max_ns;
	uint16_t stack_free_supervisor_bytes;
	uint16_t stack_free_limits_bytes;
	uint16_t stack_free_modbus_bytes;
	uint16_t stack_free_storage_bytes;
	uint16_t stack_free_interrupts_bytes;
};

/** Starts since the journal was last stored, which its counters lack. */
struct lw_unstored_starts {
	uint32_t boots;
	uint32_t watchdog_resets;
};

/** What the host is. */
struct lw_device_config {
	enum lw_host host;
	/** The first 8 bytes of the SHA-256 of the image that runs; 0: not known. */
	uint64_t image_hash;
	/** What the storage holds: loaded before lw_device_init(), kept up to date afterwards. */
	struct lw_store *store;
	/** The watchdog has caused this power-up. */
	bool watchdog_reset;
	/** The processor's external clock is missing: it runs by a less exact one. */
	bool clock_fallback;
	/** Starts before this one that were not stored, where the host remembers them. */
	struct lw_unstored_starts unstored;
	/** Memory that outlasts a restart by the watchdog, or a short loss of power; or NULL. */
	struct lw_kept *kept;
	/** The encoder's edges are counted in hardware, also while the storage is written. */
	bool edges_are_kept;
	/** Further registers that the host offers (the bench), or NULL. */
	const struct lw_bank_section *host_section;
	/** Silence that ends a frame; 0: by the baud rate in use (lw_rtu_silence_us()). */
	uint32_t silence_us;
	/** Bytes take no time on this line, whatever its baud rate: a pseudo terminal. */
	bool line_takes_no_time;
	/** Unit id to use instead of the stored one; 0: the stored one. */
	uint8_t unit_id;
	/** Use the factory line settings until the next power-up, whatever is stored. */
	bool default_line;
};

/** The last command, for the registers command_*. */
struct lw_device_command {
	uint16_t sequence;
	uint8_t code;   /**< enum lw_command */
	uint8_t result; /**< enum lw_result */
	struct lw_refusal why;
};

/** What moves the carriage or shifts where it turns: see allow_order() in bank_sections.c. */
enum lw_device_order {
	LW_DEVICE_ORDER_NONE,
	LW_DEVICE_ORDER_JOG_PLUS,
	LW_DEVICE_ORDER_JOG_MINUS,
	LW_DEVICE_ORDER_TRIM,
	LW_DEVICE_ORDER_COMMAND, /**< any command but stop */
};

/** What the write request at hand asks for so far: its values first, then its command. */
struct lw_device_asked {
	enum lw_device_order order;
	int32_t set_rope_mm;
};

/** Settings of the serial line. */
struct lw_line {
	uint8_t unit_id;
	uint32_t baud_rate;
	enum lw_line_format format;
};

/** Line settings on trial: the command try_line. */
struct lw_line_trial {
	bool running;
	struct lw_line before; /**< used again if nothing is heard */
	uint32_t own_requests; /**< lw_slave.own_requests when it began; any more confirm it */
	uint64_t ends_us;
};

/** Writes to the storage, each of which costs a while: the flash lives for a limited number. */
struct lw_write_budget {
	uint64_t paid_until_us;
};

/** Does the drum turn although the storage is being written? */
struct lw_write_watch {
	int64_t begin_edges;     /**< odometer when the write began */
	uint32_t begin_illegal;  /**< illegal transitions likewise */
	uint64_t looks_until_us; /**< one edge came meanwhile: do more follow? 0: no question */
};

/** What the event log compares with, to notice changes. */
struct lw_device_seen {
	enum lw_state state;
	enum lw_mode mode;
	enum lw_fault fault;
	uint16_t los_count[4]; /**< 1+, 1-, 2+, 2- */
	uint16_t encoder_los_count;
	bool wiring[2];
	bool implausible[2];
	bool master_lost;
	bool master_logged; /**< that it was lost */
	bool unlock_logged;
	uint32_t babbles;
	uint32_t echoes;
	bool overspeed; /**< warned of since the drum last rested */
	bool indexing;  /**< an indexing has begun and not ended */
	bool unlocked;  /**< the write lock was open */
	bool drum_at_rest;
	bool odometer_doubtful;
	bool rope_laid_standing;
	uint32_t rope_standing_millirev; /**< as the last event about it says */
	uint16_t reacquires_begun;
	uint16_t reacquires_done;
	uint16_t resumed; /**< how often the place of the rope was taken up */
};

/** A bank of cam tables as a file. */
struct lw_device_cam_file {
	struct lw_device *device;
	struct lw_cam_bank *bank;
};

/** State. The host reads; everything is written by the functions here and by the slave. */
struct lw_device {
	struct lw_controller controller;
	struct lw_slave slave;

	struct lw_params active;
	struct lw_params staged;
	struct lw_derived derived; /**< of the active set */
	uint32_t active_crc;       /**< of the active set: lw_params_crc() */
	struct lw_set_copy set_copy;
	struct lw_lock lock; /**< of the active set's lock_code */

	/**
	 * Line settings in use. The host makes its port so whenever they have changed, but never
	 * while it sends an answer.
	 */
	struct lw_line line;
	struct lw_line_trial line_trial;

	struct lw_device_command command;
	struct lw_device_asked asked;

	int32_t set_rope_mm; /**< what the command set_rope tells; -1: nothing was written */

	struct lw_device_health health; /**< written by the host */

	struct lw_device_seen seen;
	uint64_t journal_due_us; /**< when events shall be stored; UINT64_MAX: none waits */
	/** By cause, private to journal.c: until when its events are paid for. */
	uint32_t cause_paid_until_s[LW_DEVICE_CAUSES];
	uint32_t events_skipped; /**< whose cause came too often */
	uint64_t babble_told_until_us;
	uint64_t echo_told_until_us;
	uint64_t journal_written_us; /**< end of the last attempt, at first the power-up */
	struct lw_write_budget journal_budget;
	struct lw_write_budget look_budget;
	struct lw_write_watch write_watch;
	int32_t odometer_doubtful_edges; /**< counted during the write that made it so */
	uint32_t powered_us;             /**< of the present second */
	uint32_t tracking_us;            /**< of the present second */

	int8_t cam_active;             /**< index of the store's bank that is in force, -1: none */
	bool cam_stored;               /**< so is the table that the next power-up begins with */
	uint16_t cam_first_row;        /**< where the window of rows begins, from 1 */
	struct lw_cam_refusal cam_why; /**< why the last check of a table refused it */

	uint64_t now_us;           /**< of the last tick */
	uint64_t heard_request_us; /**< slave's time of the last request that was noticed */
	uint64_t heard_us;         /**< when it was noticed, in ticks' time */

	/* Images that a Modbus request reads. */
	struct lw_setpoints setpoints_image;
	union {
		/* No request reads input and holding registers. */
		struct lw_status status_image;
		struct lw_cam_upload cam_upload_image;
	};
	uint32_t coils_image;

	const struct lw_device_config *config;
	struct lw_bank_section sections[LW_DEVICE_SECTIONS + LW_DEVICE_HOST_SECTIONS];
	struct lw_bank bank;
	struct lw_device_cam_file cam_files[LW_CAM_BANKS];
	struct lw_pdu_file files[LW_DEVICE_FILES];
	struct lw_slave_config slave_config;
};

/**
 * Power up.
 *
 * @param config must outlive the device; its store has been loaded
 * @param inputs pins now
 * @param now_us time for the controller
 * @param slave_now_us time for the slave, which may be another clock
 */
void lw_device_init(struct lw_device *device, const struct lw_device_config *config,
		    const struct lw_inputs *inputs, uint64_t now_us, uint64_t slave_now_us);

/**
 * Tell the levels of the buttons for early and late reversal: a press is a trim by trim_step_um at
 * the side that the carriage moves toward. Call it before every tick, where there are such buttons.
 *
 * @param pressed early, late
 */
void lw_device_trim_buttons(struct lw_device *device, const bool pressed[2]);

/** Supervise. Call every LW_CONTROLLER_TICK_US; includes lw_controller_tick(). */
void lw_device_tick(struct lw_device *device, uint64_t now_us);

/**
 * Begin the write to the storage that is due, if any: only while the drum rests and the carriage
 * does not move, because a processor may stand still while its flash is written or erased. Nothing
 * moves by itself until lw_device_end_write(). If the drum turns meanwhile all the same, edges may
 * be missing, and the flag odometer_doubtful says so; not where the host keeps them.
 *
 * @param slot receives the slot to write, 0 to LW_STORE_SLOTS - 1
 * @param bytes receives what to write
 * @return its bytes; 0 if there is nothing to write now
 */
size_t lw_device_begin_write(struct lw_device *device, unsigned int *slot,
			     uint8_t bytes[LW_STORE_SLOT_SIZE]);

/**
 * Report the end of a write.
 *
 * @param result 0, or a negative errno if the storage failed
 */
void lw_device_end_write(struct lw_device *device, int result);

/** Fill `status_image` with one consistent snapshot. */
void lw_device_refresh_status(struct lw_device *device);

/**
 * Fill of `status_image` only what changes as the machine moves, and what the law works with:
 * state, mode, fault, flags, inhibits, position, slope, speed of the drum, edges, steps,
 * recoveries, uptime, ka, nr, ks, reversal points and dwells. For who looks every millisecond.
 */
void lw_device_refresh_live(struct lw_device *device);

#endif /* LW_DEVICE_H */
