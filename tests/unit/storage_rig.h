/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A device on the rig's pins with a storage that outlasts a power cut: rig.slots.
 */
#ifndef STORAGE_RIG_H
#define STORAGE_RIG_H

#include "device_rig.h"

/** Ticks with a storage that writes at once what it may. */
static inline void run(int ticks)
{
	while (ticks-- > 0) {
		rig_tick();
		(void)rig_write_slot(0);
	}
}

/** The same until a state is reached, not longer than a minute. */
static inline void run_to(enum lw_state state)
{
	for (int i = 0; i < 60000 && rig.controller->state != state; i++) {
		run(1);
	}
	TEST_ASSERT_EQUAL_INT(state, rig.controller->state);
}

/** The power goes and comes: what has been written is there, and the drum rests. */
static inline void power_cut(void)
{
	const struct lw_inputs inputs = rig_inputs();

	lw_store_init(&rig.store);
	for (unsigned int slot = 0; slot < LW_STORE_SLOTS; slot++) {
		lw_store_load(&rig.store, slot, rig.slots[slot], sizeof(rig.slots[slot]));
	}
	rig.drum_edges_per_s = 0;
	lw_device_init(&rig.device, &config, &inputs, rig.now_us, rig.now_us);
}

#endif /* STORAGE_RIG_H */
