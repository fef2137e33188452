/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The bench registers: drum speed, faults and truth of a plant over Modbus. Whoever owns the plant
 * owns its bench; no function may be called from an interrupt.
 */
#ifndef LW_PLANT_BENCH_H
#define LW_PLANT_BENCH_H

#include <stdbool.h>
#include <stddef.h>

#include "lw/modbus/bank.h"
#include "lw/map.h"
#include "lw/plant.h"

/** A bench. It refers to its plant: do not copy or move either. */
struct lw_plant_bench {
	struct lw_plant *plant;
	bool power_cut;   /**< the controller shall be restarted; its host clears it */
	bool memory_kept; /**< and what its memory keeps is kept, as over a watchdog's restart */
	bool threads;     /**< the controller runs in threads that can hang; its host sets it */
	enum lw_bench_thread hang; /**< the thread that shall hang */

	struct lw_bench registers; /**< private: set-points, and image of what can be read */
	struct lw_plant_profile_point profile[LW_PLANT_PROFILE_POINTS_MAX]; /**< private */
	size_t profile_count;                                               /**< private */
};

/** Set the bench registers to their defaults. `plant` must outlive the bench. */
void lw_plant_bench_init(struct lw_plant_bench *bench, struct lw_plant *plant);

/** The section of the register bank that offers a bench. */
struct lw_bank_section lw_plant_bench_section(struct lw_plant_bench *bench);

#endif /* LW_PLANT_BENCH_H */
