/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The world: one controller and one plant on a virtual clock, wired pin to pin. No clock, no file,
 * no thread of its own; the simulator program and the tests drive it.
 *
 * A world refers to itself: do not copy or move it.
 */
#ifndef LW_WORLD_H
#define LW_WORLD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lw/device/device.h"
#include "lw/map.h"
#include "lw/plant.h"
#include "lw/plant_bench.h"

/** Most transitions of a run. */
#define LW_WORLD_RUN_MAX 64

/** Transitions of the encoder one way, of which each changes one channel, and no other event lies
 *  between two of them. */
struct lw_world_run {
	int direction; /**< +1: A leads B; -1 */
	uint32_t count;
	uint32_t step_count;
	/** Transitions that gave steps, in their order. */
	struct {
		uint64_t time_ns;
		uint32_t transition; /**< which one, from 1 on */
		int steps;           /**< as in `observe_edge` */
	} steps[LW_WORLD_RUN_MAX];
};

/** How a world starts. */
struct lw_world_config {
	uint64_t seed;
	/** The machine, read by lw_world_init() only. NULL: lw_plant_config_default(). */
	const struct lw_plant_config *machine;
	uint32_t silence_us;     /**< see struct lw_device_config */
	bool line_takes_no_time; /**< see struct lw_device_config */
	uint8_t unit_id;         /**< see struct lw_device_config */
	void *context;           /**< handed to the functions below */
	/**
	 * Read a slot of the storage: bytes, 0 for none. NULL: the storage is in memory, at first
	 * empty.
	 */
	size_t (*read_slot)(void *context, unsigned int slot, uint8_t *bytes, size_t size);
	/** Write a slot of the storage: 0 or a negative errno. NULL where `read_slot` is. */
	int (*write_slot)(void *context, unsigned int slot, const uint8_t *bytes, size_t length);
	/** Called after every tick, once per millisecond of virtual time. May be NULL. */
	void (*observe)(void *context);
	/** Called after every edge of the edge timer, and every transition of the encoder that is
	 *  in no run, with the step pulse that it gave: +1, 0, -1. May be NULL. */
	void (*observe_edge)(void *context, enum lw_edge_source source, int step);
	/** Called after every run of transitions, whose time is that of its last one. NULL where
	 *  `observe_edge` is. */
	void (*observe_run)(void *context, const struct lw_world_run *run);
};

/** State. Read the parts through their own interfaces. */
struct lw_world {
	struct lw_device device;
	struct lw_plant plant;
	uint64_t now_ns;      /**< virtual time */
	uint64_t power_up_ns; /**< virtual time of the controller's last power-up */

	struct lw_world_config config;
	struct lw_device_config device_config;
	struct lw_bank_section bench_section;
	struct lw_plant_bench bench;
	uint64_t tick_ns;  /**< next tick */
	uint64_t timer_ns; /**< next edge of the edge timer */
	uint32_t timer_rate_edges_per_s;
	bool stepper_enabled;
	bool was_indexed;
	struct lw_world_run run; /**< the last one that was observed */
	struct lw_store store;
	struct lw_kept kept; /**< the controller's memory over a restart */
	uint8_t memory[LW_STORE_SLOTS][LW_STORE_SLOT_SIZE]; /**< the storage if it is in memory */
};

/**
 * Build the machine and power the controller up at virtual time 0.
 *
 * @param slave_now_us time for the Modbus slave, which may be another clock
 * @retval 0 done
 * @retval -EINVAL the configuration is no machine: lw_plant_config_check() says why
 */
int lw_world_init(struct lw_world *world, const struct lw_world_config *config,
		  uint64_t slave_now_us);

/** Let virtual time pass until `until_ns`. */
void lw_world_run(struct lw_world *world, uint64_t until_ns);

/**
 * One Modbus request to the controller, without a line between.
 *
 * @param request function code and data
 * @return length of the response: function code and data
 */
size_t lw_world_request(struct lw_world *world, const uint8_t *request, size_t length,
			uint8_t response[LW_PDU_MAX]);

#endif /* LW_WORLD_H */
