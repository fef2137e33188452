/* SPDX-License-Identifier: Apache-2.0 */
/*
 * One kind of edge, over and over, for an instruction count: callgrind counts inside of
 * encoder_interrupt() and nowhere else (bench.py).
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lw/control/cam_check.h"
#include "lw/control/controller.h"

#define EDGES           1000
#define EDGES_OF_A_TICK 48 /* of the supervisor, at 48,000 edges/s */

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

/** Follow rows of 3 to 40 edges, up and down as steep as a cam may be. @return 0, or why not */
static int follow_cam(struct lw_controller *controller, struct lw_params *params,
		      enum lw_cam_interpolation interpolation)
{
	static struct lw_cam_bank bank;
	struct lw_cam_motion *cam = &controller->motion.cam;
	struct lw_cam_table *table = &bank.table;
	struct lw_cam_refusal why;
	struct lw_cam_scale scale;

	params->cam_start = LW_CAM_START_RELATIVE;
	params->cam_steps_per_s_max = 4 * params->overspeed_trip_edges_per_s;
	table->interpolation = (uint16_t)interpolation;
	for (int32_t i = 1; i < 32; i++) {
		const struct lw_cam_row *before = &table->rows[i - 1];
		const int32_t length = 3 + i * 17 % 38;
		/* The plateau of a trapezoid is 10/9 as steep as its row. */
		const int32_t way = length * 36 / 10 * (i % 5 - 2) / 2;

		table->rows[i] = (struct lw_cam_row){before->master + length, before->slave + way};
	}
	table->rows[32] = (struct lw_cam_row){table->rows[31].master + 200, 0};
	table->row_count = 33;
	bank.crc = lw_cam_bank_crc(&bank);
	if (lw_cam_bank_check(&bank, params, &bank.statistics, &why)) {
		return why.reason;
	}
	scale = lw_cam_params_scale(params);
	lw_cam_start(&cam->cam, table, &scale, 0, 0);
	cam->steps_max = LW_CAM_STEPS_PER_EDGE_MAX;
	cam->unfollowed_edges = controller->motion.unfollowed_edges;
	cam->on = true;
	return 0;
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
		fputs("usage: lw_law_bench "
		      "sweep|reversal|direction_change|cam_linear|cam_trapezoid\n",
		      stderr);
		return EXIT_FAILURE;
	}
	lw_controller_init(&controller, &params, &derived, &inputs, 0);
	const bool reversal = strcmp(argv[1], "reversal") == 0;
	const bool direction_change = strcmp(argv[1], "direction_change") == 0;

	lw_motion_set_position(&controller.motion, controller.motion.window,
			       reversal ? controller.motion.window->sweep_end : 0, derived.ks);
	lw_motion_set_source(&controller.motion, LW_EDGE_SOURCE_ENCODER);
	if (strncmp(argv[1], "cam_", 4) == 0 &&
	    follow_cam(&controller, &params,
		       strcmp(argv[1], "cam_linear") == 0 ? LW_CAM_INTERPOLATION_LINEAR
							  : LW_CAM_INTERPOLATION_TRAPEZOID)) {
		fputs("lw_law_bench: the cam table is refused\n", stderr);
		return EXIT_FAILURE;
	}
	for (int i = 0; i < EDGES; i++) {
		if (controller.motion.cam.on && i % EDGES_OF_A_TICK == 0) {
			lw_cam_motion_prepare(&controller.motion.cam);
		}
		edge(&controller, &phase, direction_change && i % 2 ? -1 : 1);
	}
	printf("%u steps, at %d\n", controller.motion.steps, lw_motion_m(&controller.motion));
	return EXIT_SUCCESS;
}
