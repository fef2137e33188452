/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/plant_bench.h"

#include <errno.h>
#include <math.h>
#include <string.h>

static void refresh(struct lw_plant_bench *bench)
{
	struct lw_bench *registers = &bench->registers;
	struct lw_plant_truth truth;

	lw_plant_read_truth(bench->plant, &truth);
	registers->bench_carriage_um = (int32_t)truth.carriage_um;
	registers->bench_carriage_mm_per_s = (int32_t)(truth.carriage_um_per_s / 1000);
	registers->bench_commanded_usteps = (int32_t)truth.commanded_usteps;
	registers->bench_slipped_usteps = (int32_t)truth.slipped_usteps;
	registers->bench_transitions = truth.drum_transitions;
	registers->bench_drum_actual_millirpm = (int32_t)truth.drum_milli_rpm;
	registers->bench_profile_points = (int32_t)bench->profile_count;
	registers->bench_profile_running = lw_plant_drum_playing(bench->plant);
	registers->bench_rope_mm = (int32_t)(truth.rope_um / 1000.0);
	registers->bench_time_ms = (uint32_t)(truth.time_ns / 1000000);
	if (!lw_plant_armed(bench->plant)) {
		registers->bench_trigger_fault = LW_TRIGGER_FAULT_NONE;
	}
}

static const void *image(void *context)
{
	struct lw_plant_bench *bench = context;

	refresh(bench);
	return &bench->registers;
}

static int allow(void *context, const struct lw_point *point, uint16_t element, int32_t value,
		 struct lw_refusal *why)
{
	(void)context;
	(void)point;
	(void)element;
	(void)value;
	(void)why;
	return 0;
}

static int append_profile(struct lw_plant_bench *bench)
{
	const int32_t count = bench->registers.bench_argument;
	const int32_t *window = bench->registers.bench_profile;
	const size_t window_points =
		sizeof(bench->registers.bench_profile) / (2 * sizeof(window[0]));

	if (lw_plant_drum_playing(bench->plant)) {
		return -EBUSY; /* the plant reads the points while it plays them */
	}
	if (count < 1 || (size_t)count > window_points) {
		return -EINVAL;
	}
	if (bench->profile_count + (size_t)count > LW_PLANT_PROFILE_POINTS_MAX) {
		return -ENOSPC;
	}
	for (int32_t i = 0; i < count; i++) {
		bench->profile[bench->profile_count++] = (struct lw_plant_profile_point){
			.time_ms = (uint32_t)window[2 * i],
			.drum_milli_rpm = window[2 * i + 1],
		};
	}
	return 0;
}

static int run_command(struct lw_plant_bench *bench, enum lw_bench_command command)
{
	struct lw_plant *plant = bench->plant;
	const int32_t argument = bench->registers.bench_argument;

	switch (command) {
	case LW_BENCH_COMMAND_NONE:
		return 0;
	case LW_BENCH_COMMAND_PROFILE_CLEAR:
		(void)lw_plant_drum_target(plant, bench->registers.bench_drum_speed_millirpm);
		bench->profile_count = 0;
		return 0;
	case LW_BENCH_COMMAND_PROFILE_APPEND:
		return append_profile(bench);
	case LW_BENCH_COMMAND_PROFILE_START:
		return lw_plant_drum_play(plant, bench->profile, bench->profile_count);
	case LW_BENCH_COMMAND_POWER_CUT:
	case LW_BENCH_COMMAND_RESTART:
		bench->power_cut = true;
		bench->memory_kept = command == LW_BENCH_COMMAND_RESTART;
		return 0;
	case LW_BENCH_COMMAND_SLIP:
		return lw_plant_inject(plant, LW_PLANT_FAULT_SLIP, argument);
	case LW_BENCH_COMMAND_LOSE_PULSES:
		return lw_plant_inject(plant, LW_PLANT_FAULT_ENCODER_LOSE_PULSES, argument);
	case LW_BENCH_COMMAND_DITHER:
		return lw_plant_inject(plant, LW_PLANT_FAULT_ENCODER_DITHER, argument);
	case LW_BENCH_COMMAND_ILLEGAL_TRANSITIONS:
		return lw_plant_inject(plant, LW_PLANT_FAULT_ENCODER_ILLEGAL, argument);
	case LW_BENCH_COMMAND_PLACE_CARRIAGE:
		return lw_plant_inject(plant, LW_PLANT_FAULT_PLACE_CARRIAGE, argument);
	}
	return -EINVAL;
}

static int set_rope(struct lw_plant_bench *bench)
{
	const struct lw_bench *registers = &bench->registers;
	const struct lw_plant_rope rope = {
		.layer_um = registers->bench_rope_layer_um,
		.turns_per_layer = registers->bench_rope_layer_milliturns / 1000.0,
		.core_um = registers->bench_rope_core_um,
	};

	return lw_plant_set_rope(bench->plant, &rope);
}

static int arm(struct lw_plant_bench *bench, enum lw_trigger_fault fault)
{
	static const enum lw_plant_fault faults[] = {
		[LW_TRIGGER_FAULT_STALL] = LW_PLANT_FAULT_STALL,
		[LW_TRIGGER_FAULT_SLIP] = LW_PLANT_FAULT_SLIP,
		[LW_TRIGGER_FAULT_LOSE_PULSES] = LW_PLANT_FAULT_ENCODER_LOSE_PULSES,
	};
	const struct lw_bench *registers = &bench->registers;

	if (fault == LW_TRIGGER_FAULT_NONE) {
		return 0;
	}
	return lw_plant_arm(bench->plant, registers->bench_trigger_position_um,
			    registers->bench_trigger_direction, faults[fault],
			    registers->bench_trigger_argument);
}

static void store(void *context, const struct lw_point *point, uint16_t element, int32_t value)
{
	struct lw_plant_bench *bench = context;
	struct lw_plant *plant = bench->plant;
	int ret = 0;

	memcpy((char *)&bench->registers + point->offset + element * sizeof(value), &value,
	       sizeof(value));
	switch (point->address) {
	case LW_ADDRESS_BENCH_COMMAND:
		ret = run_command(bench, (enum lw_bench_command)value);
		break;
	case LW_ADDRESS_BENCH_DRUM_SPEED_MILLIRPM:
		ret = lw_plant_drum_target(plant, value);
		break;
	case LW_ADDRESS_BENCH_DRUM_ACCELERATION_MILLIRPM_PER_S:
		ret = lw_plant_drum_acceleration(plant, value / 1000.0);
		break;
	case LW_ADDRESS_BENCH_SIDE_LOAD_MM_PER_S2:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_SIDE_LOAD, value);
		break;
	case LW_ADDRESS_BENCH_STALL:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_STALL, value ? -1 : 0);
		break;
	case LW_ADDRESS_BENCH_BOUNCE_MS:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_BOUNCE, value * 1000);
		break;
	case LW_ADDRESS_BENCH_SWITCH_PLUS_FAULT:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_LIMIT_PLUS, value);
		break;
	case LW_ADDRESS_BENCH_SWITCH_MINUS_FAULT:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_LIMIT_MINUS, value);
		break;
	case LW_ADDRESS_BENCH_OVERTRAVEL_PLUS:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_OVERTRAVEL_PLUS,
				      value ? LW_PLANT_SWITCH_STUCK_ACTUATED : LW_PLANT_SWITCH_OK);
		break;
	case LW_ADDRESS_BENCH_OVERTRAVEL_MINUS:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_OVERTRAVEL_MINUS,
				      value ? LW_PLANT_SWITCH_STUCK_ACTUATED : LW_PLANT_SWITCH_OK);
		break;
	case LW_ADDRESS_BENCH_DIRECTION_REVERSED:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_CARRIAGE_REVERSED, value);
		break;
	case LW_ADDRESS_BENCH_STEPPER_ALARM:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_STEPPER_ALARM, value);
		break;
	case LW_ADDRESS_BENCH_ENCODER_A_FAULT:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_ENCODER_A, value);
		break;
	case LW_ADDRESS_BENCH_ENCODER_B_FAULT:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_ENCODER_B, value);
		break;
	case LW_ADDRESS_BENCH_INDEX_PULSES:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_ENCODER_INDEX, value);
		break;
	case LW_ADDRESS_BENCH_TRIM_EARLY:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_TRIM_EARLY, value);
		break;
	case LW_ADDRESS_BENCH_TRIM_LATE:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_TRIM_LATE, value);
		break;
	case LW_ADDRESS_BENCH_SWITCH_LATE_US:
		ret = lw_plant_inject(plant, LW_PLANT_FAULT_SWITCH_LATE, value);
		break;
	case LW_ADDRESS_BENCH_ROPE_LAYER_UM:
	case LW_ADDRESS_BENCH_ROPE_LAYER_MILLITURNS:
	case LW_ADDRESS_BENCH_ROPE_CORE_UM:
		ret = set_rope(bench);
		break;
	case LW_ADDRESS_BENCH_HANG:
		ret = bench->threads ? 0 : -ENOTSUP;
		bench->hang = ret == 0 ? (enum lw_bench_thread)value : LW_BENCH_THREAD_NONE;
		break;
	case LW_ADDRESS_BENCH_TRIGGER_FAULT:
		ret = arm(bench, (enum lw_trigger_fault)value);
		break;
	default:
		return; /* an argument, used when a command comes */
	}
	bench->registers.bench_result = -ret;
}

struct lw_bank_section lw_plant_bench_section(struct lw_plant_bench *bench)
{
	return (struct lw_bank_section){
		.space = LW_SPACE_HOLDING,
		.points = lw_map_bench,
		.point_count = LW_MAP_BENCH_COUNT,
		.context = bench,
		.image = image,
		.allow = allow,
		.store = store,
	};
}

/** Set-points of what the machine is like from the beginning. */
static void show_machine(struct lw_plant_bench *bench)
{
	const struct lw_plant *plant = bench->plant;
	struct lw_bench *registers = &bench->registers;

	registers->bench_direction_reversed = plant->carriage.reversed;
	registers->bench_bounce_ms = (int32_t)(plant->limit[LW_PLANT_PLUS].bounce_ns / 1000000u);
	registers->bench_switch_late_us =
		(int32_t)lround(plant->limit[LW_PLANT_PLUS].shift_s * 1e6);
	registers->bench_switch_plus_fault = plant->limit[LW_PLANT_PLUS].fault;
	registers->bench_switch_minus_fault = plant->limit[LW_PLANT_MINUS].fault;
	registers->bench_overtravel_plus =
		plant->overtravel[LW_PLANT_PLUS].fault == LW_PLANT_SWITCH_STUCK_ACTUATED;
	registers->bench_overtravel_minus =
		plant->overtravel[LW_PLANT_MINUS].fault == LW_PLANT_SWITCH_STUCK_ACTUATED;
	registers->bench_encoder_a_fault = plant->drum.channel_fault[0];
	registers->bench_encoder_b_fault = plant->drum.channel_fault[1];
	registers->bench_index_pulses = !plant->drum.index_open;
}

void lw_plant_bench_init(struct lw_plant_bench *bench, struct lw_plant *plant)
{
	/* The profile is large, and nobody reads it beyond its count. */
	bench->plant = plant;
	bench->power_cut = false;
	bench->memory_kept = false;
	bench->threads = false;
	bench->hang = LW_BENCH_THREAD_NONE;
	bench->profile_count = 0;
	memset(&bench->registers, 0, sizeof(bench->registers));
	for (size_t i = 0; i < LW_MAP_BENCH_COUNT; i++) {
		const struct lw_point *point = &lw_map_bench[i];

		if (point->flags & LW_POINT_WRITABLE) {
			memcpy((char *)&bench->registers + point->offset, &point->default_value,
			       sizeof(int32_t));
		}
	}
	show_machine(bench);
	(void)set_rope(bench);
	/* The plant's own default is another one. */
	(void)lw_plant_drum_acceleration(
		plant, bench->registers.bench_drum_acceleration_millirpm_per_s / 1000.0);
}
