/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The records of LOS. los_judge.c judges the switches, the drum watch the encoder.
 */
#include "lw/control/los_record.h"

void lw_los_note(struct lw_los_record *record, uint64_t now_us, int32_t position_q16)
{
	if (!record->set) {
		record->before_power_up = false;
		record->position_q16 = position_q16;
		record->time_ms = (uint32_t)(now_us / 1000);
	}
	record->set = true;
	if (record->count < UINT16_MAX) {
		record->count++;
	}
}

bool lw_los_any(const struct lw_los *los)
{
	return los->los1[0].set || los->los1[1].set || los->los2[0].set || los->los2[1].set ||
	       los->encoder.set || los->reacquired.set;
}

void lw_los_indexed(struct lw_los *los, bool encoder_is_proved)
{
	for (int side = 0; side < 2; side++) {
		los->los1[side].set = false;
		los->los2[side].set = false;
	}
	los->reacquired.set = false;
	if (encoder_is_proved) {
		los->encoder.set = false;
	}
	los->recoveries = 0;
}
