/* SPDX-License-Identifier: Apache-2.0 */
/*
 * A second of the whole simulated machine at its fastest, for an instruction count: callgrind
 * counts inside of virtual_second() and nowhere else (bench.py).
 */
#include <stdio.h>
#include <stdlib.h>

#include "world.h"

#define NS_PER_S      1000000000u
#define TOP_MILLI_RPM 1000000 /* 48,000 edges/s */
#define INDEX_S_MAX   60
#define SPEED_UP_S    3
#define RPM_PER_S     1000.0

void virtual_second(struct lw_world *world);

/** Not inlined, so that callgrind sees it begin and end. */
__attribute__((noinline)) void virtual_second(struct lw_world *world)
{
	lw_world_run(world, world->now_ns + NS_PER_S);
}

int main(void)
{
	static struct lw_world world;
	static const uint8_t index[] = {6, LW_ADDRESS_COMMAND >> 8, LW_ADDRESS_COMMAND & 0xff, 0,
					LW_COMMAND_INDEX};
	const struct lw_world_config config = {.seed = 1, .unit_id = 1};
	uint8_t response[LW_PDU_MAX];
	int64_t before;

	if (lw_world_init(&world, &config, 0)) {
		return EXIT_FAILURE;
	}
	lw_world_run(&world, NS_PER_S); /* the drum is known to rest */
	if (lw_world_request(&world, index, sizeof(index), response) == 0 || response[0] != 6) {
		fprintf(stderr, "lw_world_bench: the index is refused: %d\n", response[1]);
		return EXIT_FAILURE;
	}
	for (int s = 0; world.device.controller.state != LW_STATE_TRACKING; s++) {
		if (s == INDEX_S_MAX) {
			fputs("lw_world_bench: it does not index\n", stderr);
			return EXIT_FAILURE;
		}
		lw_world_run(&world, world.now_ns + NS_PER_S);
	}
	(void)lw_plant_drum_acceleration(&world.plant, RPM_PER_S);
	(void)lw_plant_drum_target(&world.plant, TOP_MILLI_RPM);
	lw_world_run(&world, world.now_ns + (uint64_t)SPEED_UP_S * NS_PER_S);
	before = lw_motion_read(&world.device.controller.motion).net_edges;
	virtual_second(&world);
	printf("%lld\n",
	       (long long)(lw_motion_read(&world.device.controller.motion).net_edges - before));
	return world.device.controller.state == LW_STATE_TRACKING ? EXIT_SUCCESS : EXIT_FAILURE;
}
