/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Losses of synchronization: what is kept of them. los_judge.c judges the switches, the drum watch
 * the encoder, lw_controller_mend_law() the law in memory. Not for interrupt context.
 */
#ifndef LW_LOS_RECORD_H
#define LW_LOS_RECORD_H

#include <stdbool.h>
#include <stdint.h>

/** One kind of LOS on one side. Written by los_record.c, and at power-up by device/look.c. */
struct lw_los_record {
	bool set;             /**< sticky until an indexing has succeeded */
	bool before_power_up; /**< it was so when the controller powered up */
	uint16_t count;       /**< since power-up */
	int32_t position_q16; /**< of the first since the last indexing */
	uint32_t time_ms;     /**< of the first since the last indexing, in its power-up's time */
};

/** All of them. Read by status, journal and device/look.c. */
struct lw_los {
	struct lw_los_record los1[2]; /**< by side: the switch of a reversal did not trigger */
	struct lw_los_record los2[2]; /**< by side: it triggered where it is not, or the
				       *   law had changed by itself on the way to it */
	struct lw_los_record encoder; /**< the drum turned unseen: drum_watch.fault */
	/** The carriage took up a turning drum from rest; written by reacquire.c. */
	struct lw_los_record reacquired;
	uint16_t recoveries; /**< in this launch; written by los_judge.c */
	/* Private to los_judge.c. */
	bool triggered[2]; /**< by side: the switch has, on this way to the reversal */
	bool visiting[2];  /**< by side: inside the reversal, already judged */
};

/** A loss of synchronization, with the position (Q16.16). The first since an indexing is kept. */
void lw_los_note(struct lw_los_record *record, uint64_t now_us, int32_t position_q16);

/** Is any set? */
bool lw_los_any(const struct lw_los *los);

/**
 * An indexing has succeeded: the position is right again.
 *
 * @param encoder_is_proved it has also shown that the encoder tells all edges
 */
void lw_los_indexed(struct lw_los *los, bool encoder_is_proved);

#endif /* LW_LOS_RECORD_H */
