/*
 * One kind of edge, over and over, for an instruction count: callgrind counts inside of
 * encoder_interrupt() and nowhere else (bench.py).
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lw/controller.h"

#define EDGES 1000

int encoder_interrupt(struct lw_controller *controller, bool a, bool b);

/** Not inlined, so that callgrind sees it begin and end. */
__attribute__((noinline)) int encoder_interrupt(struct lw_controller *controller, bool a, bool b)
{
	return lw_controller_encoder(controller, a, b);
}

/** A leads B going forward: 00, 10, 11, 01. */
static void edge(struct lw_controller *controller, unsigned int *phase, int dd)
{
	*phase += (unsigned int)dd;
	(void)encoder_interrupt(controller, ((*phase + 1) & 2) != 0, (*phase & 2) != 0);
}

int main(int argc, char **argv)
{
	static struct lw_controller controller;
	struct lw_params params = lw_params_default;
	const struct lw_inputs inputs = {0};
	struct lw_derived derived;
	struct lw_refusal why;
	unsigned int phase = 0;

	params.encoder_edges_per_pulse = 4; /* every transition is an edge */
	params.expert_mode = 1;
	if (argc != 2 || lw_params_derive(&params, &derived, &why)) {
		fputs("usage: lw_law_bench sweep|reversal|direction_change\n", stderr);
		return EXIT_FAILURE;
	}
	lw_controller_init(&controller, &params, &derived, &inputs, 0);
	const bool reversal = strcmp(argv[1], "reversal") == 0;
	const bool direction_change = strcmp(argv[1], "direction_change") == 0;

	lw_motion_place(&controller.motion, controller.motion.window,
			reversal ? controller.motion.window->sweep_end : 0, derived.ks);
	lw_motion_set_source(&controller.motion, LW_EDGE_SOURCE_ENCODER);
	for (int i = 0; i < EDGES; i++) {
		edge(&controller, &phase, direction_change && i % 2 ? -1 : 1);
	}
	printf("%u steps, at %d\n", controller.motion.steps, lw_motion_m(&controller.motion));
	return EXIT_SUCCESS;
}
