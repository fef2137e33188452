/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * One launch of the fault campaign: a machine that has just been switched on, a list of actions
 * played to it in virtual time, and a judge. Python makes the lists (scenario.py).
 */
#ifndef LW_CAMPAIGN_LAUNCH_H
#define LW_CAMPAIGN_LAUNCH_H

#include <stddef.h>
#include <stdint.h>

#include "judge.h"

/** What an action does; the comment names its arguments. */
enum lw_action_kind {
	LW_ACTION_NONE,          /**< let its time pass */
	LW_ACTION_WAIT_STATE,    /**< until the state is in the mask `a`, at most `b` ms */
	LW_ACTION_WAIT_POSITION, /**< until the carriage really passes `a` um in direction `b`
				  *   (0: either), at most `c` ms */
	LW_ACTION_REQUEST,       /**< the `b` bytes at `a` as one Modbus request */
	LW_ACTION_DRUM,          /**< drum to `a` milli rpm at `b` milli rpm per s */
	LW_ACTION_INJECT,        /**< plant fault `a` with argument `b` */
	LW_ACTION_ARM,           /**< plant fault `c` with argument `d` at `a` um, direction `b` */
	LW_ACTION_ECHO,          /**< the line echoes what is sent (`a` = 1), or not (0) */
	LW_ACTION_BABBLE,        /**< bytes that never leave a silence, for `a` ms */
	LW_ACTION_MASTER,        /**< the master polls (`a` = 1), or is silent (0) */
	LW_ACTION_FLIP,          /**< bit `a` of the controller's memory; the judge is told */
};

/** One action. */
struct lw_action {
	uint32_t delay_ms; /**< virtual time before it */
	int32_t kind;      /**< enum lw_action_kind */
	int32_t a;
	int32_t b;
	int32_t c;
	int32_t d;
};

/** A launch. */
struct lw_launch {
	uint64_t seed; /**< of the plant */
	int32_t carriage_um;
	int32_t harmless; /**< 1: nothing in it disturbs the lay */
	const struct lw_action *actions;
	size_t action_count;
	const uint8_t *requests; /**< bytes of all Modbus requests */
};

/** One line of a trace. */
struct lw_trace_sample {
	uint32_t time_ms;
	uint32_t flags; /**< bits of enum lw_flag */
	int32_t state;  /**< enum lw_state */
	int32_t following;
	float carriage_usteps;
	float told_usteps;  /**< position that the controller tells */
	float ideal_usteps; /**< while `following` */
	float drum_edges_per_s;
};

/** How a launch ended that was played apart. */
enum lw_ending {
	LW_ENDING_PLAYED,
	LW_ENDING_CRASHED, /**< a trap: on an MCU the restart by its fault handler */
	LW_ENDING_HUNG,    /**< on an MCU the restart by its watchdog */
};

/** Bits of the controller's memory, for LW_ACTION_FLIP. */
uint32_t lw_campaign_bits(void);

/** The part of the controller that a bit of its memory belongs to, for reports. */
const char *lw_campaign_part(uint32_t bit);

/**
 * Play a launch in a process of its own, in which the controller may do what it wants.
 *
 * @param limit_s of real time, then it hangs
 * @return enum lw_ending; of a launch that has not been played `verdict` is not written
 * @retval -EINVAL as below
 * @retval -EAGAIN no process or no memory for it
 */
int32_t lw_campaign_play_apart(const struct lw_launch *launch, struct lw_verdict *verdict,
			       uint32_t limit_s);

/**
 * Play a launch.
 *
 * @param trace receives a sample every `stride_ms`, or NULL
 * @param trace_size room in `trace`
 * @return samples written
 * @retval -EINVAL an action that there is not, or a plant that refuses it
 */
int32_t lw_campaign_play(const struct lw_launch *launch, struct lw_verdict *verdict,
			 struct lw_trace_sample *trace, int32_t trace_size, uint32_t stride_ms);

#endif /* LW_CAMPAIGN_LAUNCH_H */
