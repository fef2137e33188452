/**
 * @file
 * The bench registers: drum speed, faults and truth of the simulated plant over Modbus.
 */
#ifndef LW_BENCH_H
#define LW_BENCH_H

#include "world.h"

/** The section of the register bank that offers the bench of a world. */
struct lw_bank_section lw_bench_section(struct lw_world *world);

/** Set the bench registers to their defaults. */
void lw_bench_init(struct lw_world *world);

#endif /* LW_BENCH_H */
