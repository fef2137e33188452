/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Debouncing of one limit switch, with the position of the first contact closure.
 *
 * A change-over switch (NO and NC contacts) is debounced as a set/reset flip-flop: the first
 * closure of NO sets, the first closure of NC resets. Bounce gives one event and no delay. A single
 * contact is debounced by time; its position is still that of the first closure, unless it goes on
 * chattering: then nothing tells which closure was the switch's, the last one counts, and the
 * chatter is a wiring fault.
 */
#ifndef LW_LIMIT_SWITCH_H
#define LW_LIMIT_SWITCH_H

#include <stdbool.h>
#include <stdint.h>

#include "lw/map.h"

/** How a limit switch is wired. */
struct lw_limit_switch_config {
	enum lw_switch_contacts contacts;
	/** Pair: both contacts alike, or single contact: not at rest, for longer is a wiring fault
	 */
	uint32_t transit_us;
	uint32_t debounce_us; /**< single contact: time without change that makes a state valid */
};

/** Position and direction at a contact closure. */
struct lw_limit_switch_trigger {
	int32_t pos_usteps;
	int32_t corrected_usteps; /**< lw_motion's at that moment: what came later is not in it */
	int32_t u;                /**< slope at that moment, Q16.16 */
	int8_t direction;         /**< carriage direction at that moment: +1, 0, -1 */
	int8_t drum_direction;    /**< the drum's over the last ticks: +1, 0, -1 */
};

/**
 * State of one switch. Written by lw_limit_switch_input() and lw_limit_switch_tick(), which must
 * not interrupt each other; read by anyone.
 */
struct lw_limit_switch {
	bool no_closed;
	bool nc_closed;
	bool active;                /**< debounced: the switch is actuated */
	bool wiring_fault;          /**< live: contradicting or restless contacts, for too long */
	bool candidate;             /**< single contact: closure seen, not yet debounced */
	bool triggered;             /**< an event waits for lw_limit_switch_take() */
	uint64_t changed_us;        /**< time of the last contact change */
	uint64_t restless_since_us; /**< of the first change since it last was at rest */
	uint32_t triggers;          /**< events since power-up */
	struct lw_limit_switch_trigger trigger;
};

/** Start from the present contacts, without an event. */
void lw_limit_switch_init(struct lw_limit_switch *limit_switch,
			  const struct lw_limit_switch_config *config, bool no_closed,
			  bool nc_closed, uint64_t now_us);

/**
 * Take the contacts after one of them changed. For the limit-switch interrupt.
 *
 * @param at position and direction of the carriage now, kept if this is a first closure
 */
void lw_limit_switch_input(struct lw_limit_switch *limit_switch,
			   const struct lw_limit_switch_config *config, bool no_closed,
			   bool nc_closed, struct lw_limit_switch_trigger at, uint64_t now_us);

/** Let time pass: wiring faults, single-contact debouncing. Call at least every few ms. */
void lw_limit_switch_tick(struct lw_limit_switch *limit_switch,
			  const struct lw_limit_switch_config *config, uint64_t now_us);

/**
 * Take the waiting event, if any.
 *
 * @retval true `trigger` holds the first closure of this actuation
 * @retval false no event
 */
bool lw_limit_switch_take(struct lw_limit_switch *limit_switch,
			  struct lw_limit_switch_trigger *trigger);

#endif /* LW_LIMIT_SWITCH_H */
