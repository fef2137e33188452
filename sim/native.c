/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What Python calls by ctypes: the compiled law over runs of edges, the derivation of a parameter
 * set, and a whole world for tests. This is host code: it may use the heap.
 */
#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "lw/bytes/layout.h"
#include "lw/motion/law.h"
#include "lw/control/params.h"
#include "lw/plant_figures.h"
#include "machine.h"
#include "world.h"

/** A law to replay. Positions and slopes Q16.16 where not in microsteps. */
struct lw_native_replay_setup {
	int32_t ka;
	int32_t nr;
	int32_t lplus_usteps;
	int32_t lminus_usteps;
	int32_t m;
	int32_t u;
	int32_t dwell_plus_edges;
	int32_t dwell_minus_edges;
	int32_t breaker_edges;
	int32_t breaker_cycles;
};

/** What a replay ended with. */
struct lw_native_replay_result {
	int32_t m;
	int32_t u;
	int32_t dwell;
	int32_t cycle_plus;
	int32_t cycle_minus;
	int32_t min_pos;
	int32_t max_pos;
	int64_t steps;  /**< net */
	int64_t pulses; /**< all */
	int64_t edges;
	uint64_t trace_count;
};

/**
 * Run the law over runs of edges, as the encoder interrupt does.
 *
 * @param runs edges of each run, positive forward, negative backward
 * @param trace_pos receives the position before every trace_stride-th edge, or NULL
 * @retval 0 done
 * @retval -EINVAL parameters that could overflow, or a start that is not on the orbit's slope
 * @retval -ERANGE a step larger than one, or a position beyond the range (a start off the orbit)
 */
int lw_native_replay(const struct lw_native_replay_setup *setup, const int32_t *runs,
		     size_t run_count, struct lw_native_replay_result *result, int32_t *trace_pos,
		     size_t trace_stride, size_t trace_capacity)
{
	const int64_t ks = (int64_t)setup->ka * setup->nr;
	const int64_t overshoot_usteps = ks * (setup->nr - 1) / 2 / LW_USTEP + 2;
	const int64_t reach_min = setup->lminus_usteps - overshoot_usteps;
	const int64_t reach_max = setup->lplus_usteps + overshoot_usteps;

	if (setup->ka < 1 || setup->nr < 1 || ks >= LW_USTEP ||
	    setup->lplus_usteps - (int64_t)setup->lminus_usteps < 2 || reach_max > INT16_MAX ||
	    reach_min < INT16_MIN || setup->u > ks || setup->u < -ks || setup->u % setup->ka != 0 ||
	    setup->dwell_plus_edges < 0 || setup->dwell_minus_edges < 0 ||
	    setup->breaker_edges < 0 || setup->breaker_edges > (int32_t)LW_LAW_BREAKER_EDGES_MAX ||
	    setup->breaker_cycles < 0 ||
	    setup->breaker_cycles > (int32_t)LW_LAW_BREAKER_CYCLES_MAX ||
	    lw_law_pos_usteps(setup->m) < reach_min || lw_law_pos_usteps(setup->m) > reach_max) {
		return -EINVAL;
	}

	const struct lw_law_window window = {
		.ka = setup->ka,
		.ks = (int32_t)ks,
		.sweep_begin = (setup->lminus_usteps + 1) * LW_USTEP,
		.sweep_end = setup->lplus_usteps * LW_USTEP,
		.dwell_plus_edges = (uint32_t)setup->dwell_plus_edges,
		.dwell_minus_edges = (uint32_t)setup->dwell_minus_edges,
		.breaker_edges = (uint32_t)setup->breaker_edges,
		.breaker_cycles = (uint32_t)setup->breaker_cycles,
	};
	struct lw_law law = lw_law_at(&window, setup->m, setup->u);
	const int32_t pos_start = lw_law_pos_usteps(setup->m);

	*result = (struct lw_native_replay_result){.min_pos = pos_start, .max_pos = pos_start};
	for (size_t run = 0; run < run_count; run++) {
		const int dd = runs[run] < 0 ? -1 : 1;
		const int64_t edges = runs[run] < 0 ? -(int64_t)runs[run] : runs[run];

		for (int64_t i = 0; i < edges; i++) {
			const int32_t pos = lw_law_pos_usteps(lw_law_m(&law));

			if (trace_pos != NULL && result->edges % (int64_t)trace_stride == 0 &&
			    result->trace_count < trace_capacity) {
				trace_pos[result->trace_count++] = pos;
			}

			const int step = lw_law_edge(&law, dd);
			const int32_t pos_after = lw_law_pos_usteps(lw_law_m(&law));

			/* A start off the orbit runs away; end before it overflows. */
			if (step > 1 || step < -1 || pos_after > INT16_MAX - 1 ||
			    pos_after < INT16_MIN + 1) {
				return -ERANGE;
			}
			result->edges++;
			result->steps += step;
			result->pulses += step != 0;
			if (pos_after < result->min_pos) {
				result->min_pos = pos_after;
			}
			if (pos_after > result->max_pos) {
				result->max_pos = pos_after;
			}
		}
	}
	result->m = lw_law_m(&law);
	result->u = law.u;
	result->dwell = (int32_t)law.dwell_edges;
	result->cycle_plus = (int32_t)law.cycle_plus;
	result->cycle_minus = (int32_t)law.cycle_minus;
	return 0;
}

/** The part of struct lw_derived that the tools show. */
struct lw_native_derived {
	int32_t ka;
	int32_t nr;
	int32_t ks;
	int32_t reversal_plus_usteps;
	int32_t reversal_minus_usteps;
	int32_t slope_error_ppm;
	int32_t overshoot_error_um;
	int32_t overshoot_um;
	uint32_t edges_per_1000_drum_revs;
	uint32_t dwell_plus_edges;
	uint32_t dwell_minus_edges;
	uint32_t breaker_edges;
	uint32_t breaker_cycles;
};

/** lw_params_derive() for a set given as its values in the order of the map. */
int lw_native_derive(const int32_t *values, struct lw_native_derived *derived,
		     struct lw_refusal *why)
{
	struct lw_derived full;
	int ret;

	/* All members of struct lw_params are 32 bit wide and stand in the order of the map. */
	ret = lw_params_derive((const struct lw_params *)values, &full, why);
	if (ret == 0) {
		*derived = (struct lw_native_derived){
			.ka = full.ka,
			.nr = full.nr,
			.ks = full.ks,
			.reversal_plus_usteps = full.reversal_plus_usteps,
			.reversal_minus_usteps = full.reversal_minus_usteps,
			.slope_error_ppm = full.slope_error_ppm,
			.overshoot_error_um = full.overshoot_error_um,
			.overshoot_um = full.overshoot_um,
			.edges_per_1000_drum_revs = full.edges_per_1000_drum_revs,
			.dwell_plus_edges = full.dwell_plus_edges,
			.dwell_minus_edges = full.dwell_minus_edges,
			.breaker_edges = full.breaker_edges,
			.breaker_cycles = full.breaker_cycles,
		};
	}
	return ret;
}

/**
 * The default machine with these figures instead.
 *
 * @retval -ENOENT, -ERANGE lw_plant_config_set() refused the figure names[*wrong]
 */
static int machine_of(struct lw_plant_config *machine, const char *const *names,
		      const double *values, size_t count, size_t *wrong)
{
	int ret = 0;

	lw_plant_config_default(machine);
	for (*wrong = 0; *wrong < count && ret == 0; ++*wrong) {
		ret = lw_plant_config_set(machine, names[*wrong], values[*wrong]);
	}
	*wrong -= ret != 0;
	return ret;
}

/**
 * Are these figures a machine, the others being the default's?
 *
 * @param wrong receives the number of the figure that lw_plant_config_set() refuses
 * @param why   receives what lw_plant_config_check() refuses
 * @retval 0 it is one
 * @retval -ENOENT, -ERANGE by lw_plant_config_set()
 * @retval -EINVAL by lw_plant_config_check()
 */
int lw_native_machine_check(const char *const *names, const double *values, size_t count,
			    size_t *wrong, struct lw_plant_misfit *why)
{
	struct lw_plant_config machine;
	const int ret = machine_of(&machine, names, values, count, wrong);

	return ret != 0 ? ret : lw_plant_config_check(&machine, why);
}

/** A figure of the machine that a parameter set describes, given as its values in map order. */
double lw_native_machine_of_params(const int32_t *values, const char *name)
{
	struct lw_plant_config machine;
	double value = 0.0;

	lw_machine_of_params((const struct lw_params *)values, &machine);
	(void)lw_plant_config_get(&machine, name, &value);
	return value;
}

/** A figure of the default machine. */
double lw_native_machine_default(const char *name)
{
	struct lw_plant_config machine;
	double value = 0.0;

	lw_plant_config_default(&machine);
	(void)lw_plant_config_get(&machine, name, &value);
	return value;
}

/** A world at virtual time 0, of the default machine but for some figures; or NULL. */
struct lw_world *lw_native_world_create(uint64_t seed, const char *const *names,
					const double *values, size_t count)
{
	struct lw_plant_config machine;
	const struct lw_world_config config = {.seed = seed, .machine = &machine};
	size_t wrong;
	struct lw_world *world = machine_of(&machine, names, values, count, &wrong) == 0
					 ? malloc(sizeof(*world))
					 : NULL;

	if (world != NULL && lw_world_init(world, &config, 0) != 0) {
		free(world);
		world = NULL;
	}
	return world;
}

/** End a world. */
void lw_native_world_destroy(struct lw_world *world)
{
	free(world);
}

/** Let virtual time pass. */
void lw_native_world_run_ns(struct lw_world *world, uint64_t duration_ns)
{
	lw_world_run(world, world->now_ns + duration_ns);
}

/** lw_world_request() */
size_t lw_native_world_request(struct lw_world *world, const uint8_t *request, size_t length,
			       uint8_t response[LW_PDU_MAX])
{
	return lw_world_request(world, request, length, response);
}

/**
 * Bytes on the controller's line, then time.
 *
 * @param count may be 0: time only
 * @param answer receives what the slave sends within that time
 * @return bytes of the answer, 0 if there is none
 */
size_t lw_native_world_line(struct lw_world *world, const uint8_t *bytes, size_t count,
			    uint64_t duration_ns, uint8_t answer[LW_RTU_FRAME_MAX])
{
	struct lw_slave *slave = &world->device.slave;
	const uint64_t end_ns = world->now_ns + duration_ns;
	uint64_t deadline_us;
	size_t length = 0;
	uint8_t heard[LW_RTU_FRAME_MAX];

	do {
		const size_t part = count < sizeof(heard) ? count : sizeof(heard);

		memcpy(heard, bytes, part);
		(void)lw_plant_disturb(&world->plant, heard, part);
		lw_slave_receive(slave, heard, part, world->now_ns / 1000u);
		bytes += part;
		count -= part;
	} while (count > 0);
	deadline_us = lw_slave_deadline_us(slave);
	if (deadline_us <= end_ns / 1000u) {
		lw_world_run(world, deadline_us * 1000u);
		length = lw_slave_poll(slave, deadline_us, answer);
		(void)lw_plant_disturb(&world->plant, answer, length);
	}
	lw_world_run(world, end_ns);
	return length;
}

/** lw_plant_inject() on the world's plant. */
int lw_native_world_inject(struct lw_world *world, int fault, int32_t argument)
{
	return lw_plant_inject(&world->plant, (enum lw_plant_fault)fault, argument);
}

/** lw_plant_read_truth() on the world's plant. */
void lw_native_world_truth(const struct lw_world *world, struct lw_plant_truth *truth)
{
	lw_plant_read_truth(&world->plant, truth);
}

/** Layout of what Python copies, and of the plant's for the tests. */
const struct lw_layout lw_layout_native[] = {
	LW_LAYOUT_STRUCT(lw_native_replay_setup),
	LW_LAYOUT_MEMBER(lw_native_replay_setup, ka),
	LW_LAYOUT_MEMBER(lw_native_replay_setup, nr),
	LW_LAYOUT_MEMBER(lw_native_replay_setup, lplus_usteps),
	LW_LAYOUT_MEMBER(lw_native_replay_setup, lminus_usteps),
	LW_LAYOUT_MEMBER(lw_native_replay_setup, m),
	LW_LAYOUT_MEMBER(lw_native_replay_setup, u),
	LW_LAYOUT_MEMBER(lw_native_replay_setup, dwell_plus_edges),
	LW_LAYOUT_MEMBER(lw_native_replay_setup, dwell_minus_edges),
	LW_LAYOUT_MEMBER(lw_native_replay_setup, breaker_edges),
	LW_LAYOUT_MEMBER(lw_native_replay_setup, breaker_cycles),
	LW_LAYOUT_STRUCT(lw_native_replay_result),
	LW_LAYOUT_MEMBER(lw_native_replay_result, m),
	LW_LAYOUT_MEMBER(lw_native_replay_result, u),
	LW_LAYOUT_MEMBER(lw_native_replay_result, dwell),
	LW_LAYOUT_MEMBER(lw_native_replay_result, cycle_plus),
	LW_LAYOUT_MEMBER(lw_native_replay_result, cycle_minus),
	LW_LAYOUT_MEMBER(lw_native_replay_result, min_pos),
	LW_LAYOUT_MEMBER(lw_native_replay_result, max_pos),
	LW_LAYOUT_MEMBER(lw_native_replay_result, steps),
	LW_LAYOUT_MEMBER(lw_native_replay_result, pulses),
	LW_LAYOUT_MEMBER(lw_native_replay_result, edges),
	LW_LAYOUT_MEMBER(lw_native_replay_result, trace_count),
	LW_LAYOUT_STRUCT(lw_native_derived),
	LW_LAYOUT_MEMBER(lw_native_derived, ka),
	LW_LAYOUT_MEMBER(lw_native_derived, nr),
	LW_LAYOUT_MEMBER(lw_native_derived, ks),
	LW_LAYOUT_MEMBER(lw_native_derived, reversal_plus_usteps),
	LW_LAYOUT_MEMBER(lw_native_derived, reversal_minus_usteps),
	LW_LAYOUT_MEMBER(lw_native_derived, slope_error_ppm),
	LW_LAYOUT_MEMBER(lw_native_derived, overshoot_error_um),
	LW_LAYOUT_MEMBER(lw_native_derived, overshoot_um),
	LW_LAYOUT_MEMBER(lw_native_derived, edges_per_1000_drum_revs),
	LW_LAYOUT_MEMBER(lw_native_derived, dwell_plus_edges),
	LW_LAYOUT_MEMBER(lw_native_derived, dwell_minus_edges),
	LW_LAYOUT_MEMBER(lw_native_derived, breaker_edges),
	LW_LAYOUT_MEMBER(lw_native_derived, breaker_cycles),
	LW_LAYOUT_STRUCT(lw_refusal),
	LW_LAYOUT_MEMBER(lw_refusal, reason),
	LW_LAYOUT_MEMBER(lw_refusal, address),
	LW_LAYOUT_MEMBER(lw_refusal, value),
	LW_LAYOUT_MEMBER(lw_refusal, limit),
	LW_LAYOUT_STRUCT(lw_plant_figure),
	LW_LAYOUT_MEMBER(lw_plant_figure, name),
	LW_LAYOUT_MEMBER(lw_plant_figure, min),
	LW_LAYOUT_MEMBER(lw_plant_figure, max),
	LW_LAYOUT_MEMBER(lw_plant_figure, words),
	LW_LAYOUT_MEMBER(lw_plant_figure, whole),
	LW_LAYOUT_STRUCT(lw_plant_misfit),
	LW_LAYOUT_MEMBER(lw_plant_misfit, figure),
	LW_LAYOUT_MEMBER(lw_plant_misfit, must_be),
	LW_LAYOUT_MEMBER(lw_plant_misfit, other),
	LW_LAYOUT_STRUCT(lw_plant_truth),
	LW_LAYOUT_MEMBER(lw_plant_truth, time_ns),
	LW_LAYOUT_MEMBER(lw_plant_truth, drum_transitions),
	LW_LAYOUT_MEMBER(lw_plant_truth, drum_milli_rpm),
	LW_LAYOUT_MEMBER(lw_plant_truth, carriage_um),
	LW_LAYOUT_MEMBER(lw_plant_truth, carriage_usteps),
	LW_LAYOUT_MEMBER(lw_plant_truth, carriage_um_per_s),
	LW_LAYOUT_MEMBER(lw_plant_truth, commanded_usteps),
	LW_LAYOUT_MEMBER(lw_plant_truth, lag_usteps),
	LW_LAYOUT_MEMBER(lw_plant_truth, step_pulses),
	LW_LAYOUT_MEMBER(lw_plant_truth, slipped_usteps),
	LW_LAYOUT_MEMBER(lw_plant_truth, pole_slips),
	LW_LAYOUT_MEMBER(lw_plant_truth, in_sync),
	LW_LAYOUT_MEMBER(lw_plant_truth, coupling_slip_um),
	LW_LAYOUT_MEMBER(lw_plant_truth, limit_um),
	LW_LAYOUT_MEMBER(lw_plant_truth, rope_um),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_STALL),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_SLIP),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_SIDE_LOAD),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_BOUNCE),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_LIMIT_PLUS),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_LIMIT_MINUS),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_OVERTRAVEL_PLUS),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_OVERTRAVEL_MINUS),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_ENCODER_LOSE_PULSES),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_ENCODER_ILLEGAL),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_ENCODER_DITHER),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_PLACE_CARRIAGE),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_CARRIAGE_REVERSED),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_ENCODER_EXTRA_PULSES),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_STEPPER_ALARM),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_ENCODER_A),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_ENCODER_B),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_ENCODER_INDEX),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_BLIP_PLUS),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_BLIP_MINUS),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_TRIM_EARLY),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_TRIM_LATE),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_SWITCH_LATE),
	LW_LAYOUT_VALUE(lw_plant_fault, LW_PLANT_FAULT_COUNT),
	{0},
};
