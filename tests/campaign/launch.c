/* SPDX-License-Identifier: Apache-2.0 */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */

#include "launch.h"

#include <errno.h>
#include <signal.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lw/bytes/layout.h"
#include "lw/bytes/require.h"
#include "lw/motion/law.h"

#define NS_PER_MS      1000000u
#define NS_PER_US      1000u
#define POLL_PERIOD_MS 100u

/** A contact that bounces longer is broken. */
#define CHATTER_US 10000

/** Of an endless talk with oneself, so many are enough. */
#define ANSWERS_MAX 4u

/** A launch being played. */
struct player {
	struct lw_world world;
	struct lw_judge judge;
	bool polling;
	bool echo;
	uint32_t polled_ms;
	struct lw_trace_sample *trace;
	int32_t trace_size;
	int32_t samples;
	uint32_t stride_ms;
};

static uint32_t now_ms(const struct player *player)
{
	return (uint32_t)(player->world.now_ns / NS_PER_MS);
}

static void sample(struct player *player)
{
	const struct lw_status *status = &player->world.device.status_image;
	struct lw_plant_truth truth;

	if (player->trace == NULL || now_ms(player) % player->stride_ms != 0 ||
	    player->samples == player->trace_size) {
		return;
	}
	lw_plant_read_truth(&player->world.plant, &truth);
	player->trace[player->samples++] = (struct lw_trace_sample){
		.time_ms = now_ms(player),
		.flags = status->flags,
		.state = status->state,
		.following = player->judge.following,
		.carriage_usteps = (float)truth.carriage_usteps,
		.told_usteps = (float)status->m / (float)LW_USTEP,
		.ideal_usteps = (float)player->judge.screw.m / (float)LW_USTEP,
		.drum_edges_per_s = (float)status->drum_speed_edges_per_s,
	};
}

static void observe_edge(void *context, enum lw_edge_source source, int step)
{
	struct player *player = context;

	lw_judge_edge(&player->judge, source, step);
}

static void observe_run(void *context, const struct lw_world_run *run)
{
	struct player *player = context;

	lw_judge_run(&player->judge, run);
}

static void observe(void *context)
{
	struct player *player = context;

	lw_judge_tick(&player->judge);
	sample(player);
}

/** A request over a line that echoes. */
static void request_with_echo(struct player *player, const uint8_t *request, size_t length)
{
	struct lw_slave *slave = &player->world.device.slave;
	uint8_t frame[LW_RTU_FRAME_MAX];
	uint32_t answers = 0;

	frame[0] = slave->config->unit_id;
	memcpy(&frame[1], request, length);
	length = lw_rtu_seal(frame, 1 + length);
	while (length > 0 && answers <= ANSWERS_MAX) {
		lw_slave_receive(slave, frame, length, player->world.now_ns / NS_PER_US);

		const uint64_t deadline_us = lw_slave_deadline_us(slave);

		if (deadline_us == UINT64_MAX) {
			break; /* dropped where it came in */
		}
		if (deadline_us * NS_PER_US > player->world.now_ns) {
			lw_world_run(&player->world, deadline_us * NS_PER_US);
		}
		length = lw_slave_poll(slave, player->world.now_ns / NS_PER_US, frame);
		answers += length > 0;
	}
	lw_judge_answers(&player->judge, answers);
}

static void send(struct player *player, const uint8_t *request, size_t length)
{
	uint8_t response[LW_PDU_MAX];

	if (player->echo) {
		request_with_echo(player, request, length);
	} else {
		(void)lw_world_request(&player->world, request, length, response);
	}
}

/** The master asks for the live status. */
static void poll(struct player *player)
{
	const uint8_t request[] = {4, LW_ADDRESS_STATE >> 8, LW_ADDRESS_STATE & 0xff, 0, 31};

	if (player->polling && now_ms(player) - player->polled_ms >= POLL_PERIOD_MS) {
		player->polled_ms = now_ms(player);
		send(player, request, sizeof(request));
	}
}

static void run_ms(struct player *player, uint32_t duration_ms)
{
	for (uint32_t i = 0; i < duration_ms; i++) {
		poll(player);
		lw_world_run(&player->world, player->world.now_ns + NS_PER_MS);
	}
}

static void wait_for_state(struct player *player, uint32_t states, uint32_t limit_ms)
{
	for (uint32_t i = 0; i < limit_ms; i++) {
		if (states >> player->world.device.status_image.state & 1u) {
			return;
		}
		run_ms(player, 1);
	}
}

static double carriage_um(const struct player *player)
{
	struct lw_plant_truth truth;

	lw_plant_read_truth(&player->world.plant, &truth);
	return truth.carriage_um;
}

static void wait_for_position(struct player *player, double position_um, int direction,
			      uint32_t limit_ms)
{
	double before = carriage_um(player);

	for (uint32_t i = 0; i < limit_ms; i++) {
		run_ms(player, 1);

		const double now = carriage_um(player);

		if ((direction >= 0 && before < position_um && now >= position_um) ||
		    (direction <= 0 && before > position_um && now <= position_um)) {
			return;
		}
		before = now;
	}
}

/** What the judge must know of a fault that the plant has been given. */
static void tell_judge(struct player *player, enum lw_plant_fault fault, int32_t argument)
{
	struct lw_judge *judge = &player->judge;

	switch (fault) {
	case LW_PLANT_FAULT_ENCODER_LOSE_PULSES:
	case LW_PLANT_FAULT_ENCODER_EXTRA_PULSES:
		judge->unknowable |= judge->index_open;
		judge->may_hide_edges += (int64_t)argument * judge->edges_per_pulse;
		break;
	case LW_PLANT_FAULT_ENCODER_ILLEGAL:
		judge->may_hide_edges += 2 * (int64_t)argument; /* transitions in each */
		break;
	case LW_PLANT_FAULT_ENCODER_A:
	case LW_PLANT_FAULT_ENCODER_B:
		judge->channel_fault[fault == LW_PLANT_FAULT_ENCODER_B] = (uint8_t)argument;
		judge->channels_hide |= argument != LW_PLANT_CHANNEL_OK;
		judge->unknowable |=
			judge->index_open && judge->channel_fault[0] && judge->channel_fault[1];
		break;
	case LW_PLANT_FAULT_ENCODER_INDEX:
		judge->index_open = argument == 0;
		break;
	case LW_PLANT_FAULT_BOUNCE:
		/* What is known of the position by a contact that chatters is late. */
		if (argument > CHATTER_US) {
			judge->switch_broken[LW_PLUS] = true;
			judge->switch_broken[LW_MINUS] = true;
		}
		break;
	case LW_PLANT_FAULT_LIMIT_PLUS:
		judge->switch_broken[LW_PLUS] = argument != LW_PLANT_SWITCH_OK;
		break;
	case LW_PLANT_FAULT_LIMIT_MINUS:
		judge->switch_broken[LW_MINUS] = argument != LW_PLANT_SWITCH_OK;
		break;
	case LW_PLANT_FAULT_CARRIAGE_REVERSED:
		judge->motor_reversed = argument != 0;
		break;
	case LW_PLANT_FAULT_STALL:
	case LW_PLANT_FAULT_SLIP:
	case LW_PLANT_FAULT_SIDE_LOAD:
	case LW_PLANT_FAULT_OVERTRAVEL_PLUS:
	case LW_PLANT_FAULT_OVERTRAVEL_MINUS:
	case LW_PLANT_FAULT_ENCODER_DITHER:
	case LW_PLANT_FAULT_PLACE_CARRIAGE:
	case LW_PLANT_FAULT_STEPPER_ALARM:
	case LW_PLANT_FAULT_BLIP_PLUS:
	case LW_PLANT_FAULT_BLIP_MINUS:
	case LW_PLANT_FAULT_TRIM_EARLY:
	case LW_PLANT_FAULT_TRIM_LATE:
	case LW_PLANT_FAULT_SWITCH_LATE:
	case LW_PLANT_FAULT_COUNT:
		break; /* nothing that it does not see */
	}
}

/** Another device that never leaves a silence; after it the line must be as good as before. */
static void babble(struct player *player, uint32_t duration_ms)
{
	static const uint8_t bytes[] = {0x55, 0x55};
	const uint8_t request[] = {4, LW_ADDRESS_STATE >> 8, LW_ADDRESS_STATE & 0xff, 0, 1};
	struct lw_slave *slave = &player->world.device.slave;
	uint8_t answer[LW_RTU_FRAME_MAX];

	for (uint32_t i = 0; i < duration_ms; i++) {
		lw_slave_receive(slave, bytes, sizeof(bytes), player->world.now_ns / NS_PER_US);
		run_ms(player, 1);
		(void)lw_slave_poll(slave, player->world.now_ns / NS_PER_US, answer);
	}
	run_ms(player, 10);
	if (lw_slave_poll(slave, player->world.now_ns / NS_PER_US, answer) > 0) {
		lw_judge_answers(&player->judge, ANSWERS_MAX);
	}
	request_with_echo(player, request, sizeof(request));
}

static int act(struct player *player, const struct lw_launch *launch,
	       const struct lw_action *action)
{
	struct lw_plant *plant = &player->world.plant;

	switch ((enum lw_action_kind)action->kind) {
	case LW_ACTION_NONE:
		return 0;
	case LW_ACTION_WAIT_STATE:
		wait_for_state(player, (uint32_t)action->a, (uint32_t)action->b);
		return 0;
	case LW_ACTION_WAIT_POSITION:
		wait_for_position(player, action->a, action->b, (uint32_t)action->c);
		return 0;
	case LW_ACTION_REQUEST:
		send(player, launch->requests + action->a, (size_t)action->b);
		return 0;
	case LW_ACTION_ECHO:
		player->echo = action->a != 0;
		return 0;
	case LW_ACTION_BABBLE:
		babble(player, (uint32_t)action->a);
		return 0;
	case LW_ACTION_DRUM:
		(void)lw_plant_drum_acceleration(plant, action->b / 1000.0);
		return lw_plant_drum_target(plant, action->a);
	case LW_ACTION_INJECT:
		tell_judge(player, (enum lw_plant_fault)action->a, action->b);
		return lw_plant_inject(plant, (enum lw_plant_fault)action->a, action->b);
	case LW_ACTION_ARM:
		tell_judge(player, (enum lw_plant_fault)action->c, action->d);
		return lw_plant_arm(plant, action->a, action->b, (enum lw_plant_fault)action->c,
				    action->d);
	case LW_ACTION_MASTER:
		player->polling = action->a != 0;
		return 0;
	case LW_ACTION_FLIP:
		player->judge.upset = true;
#ifdef LW_CHECK_REQUIREMENTS
		lw_requirements_bind = false; /* the firmware has no such checks */
#endif
		((uint8_t *)&player->world.device)[action->a / 8] ^= (uint8_t)(1u << action->a % 8);
		return 0;
	}
	return -EINVAL;
}

uint32_t lw_campaign_bits(void)
{
	return 8 * sizeof(struct lw_device);
}

const char *lw_campaign_part(uint32_t bit)
{
#define PART(member)                                                                               \
	{                                                                                          \
#member, offsetof(struct lw_device, member)                                        \
	}
	/* From the last one to the first. */
	static const struct {
		const char *name;
		size_t begins;
	} parts[] = {
		PART(config),
		PART(coils_image),
		PART(setpoints_image),
		PART(cam_active),
		PART(health),
		PART(command),
		PART(line),
		PART(lock),
		PART(derived),
		PART(staged),
		PART(active),
		PART(slave),
		PART(controller.requested_mode),
		PART(controller.windows),
		PART(controller.state),
		PART(controller.los),
		PART(controller.homing),
		PART(controller.speed),
		PART(controller.drum_watch),
		PART(controller.limit),
		PART(controller.encoder_index),
		PART(controller.motion),
		PART(controller.quadrature),
		PART(controller),
	};
#undef PART
	size_t i = 0;

	while (bit / 8 < parts[i].begins) {
		i++;
	}
	return parts[i].name;
}

int32_t lw_campaign_play_apart(const struct lw_launch *launch, struct lw_verdict *verdict,
			       uint32_t limit_s)
{
	struct {
		struct lw_verdict verdict;
		int32_t ret;
	} *shared = mmap(NULL, sizeof(*shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
			 -1, 0);
	int32_t ret = -EAGAIN;
	int status;
	pid_t child;

	if (shared == MAP_FAILED) {
		return -EAGAIN;
	}
	child = fork();
	if (child == 0) {
		static const int traps[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

		for (size_t i = 0; i < sizeof(traps) / sizeof(traps[0]); i++) {
			(void)signal(traps[i], SIG_DFL); /* no report: it is expected */
		}
		alarm(limit_s);
		shared->ret = lw_campaign_play(launch, &shared->verdict, NULL, 0, 1);
		_exit(0);
	}
	if (child > 0 && waitpid(child, &status, 0) == child) {
		if (WIFEXITED(status)) {
			*verdict = shared->verdict;
			ret = shared->ret < 0 ? shared->ret : LW_ENDING_PLAYED;
		} else {
			ret = WTERMSIG(status) == SIGALRM ? LW_ENDING_HUNG : LW_ENDING_CRASHED;
		}
	}
	(void)munmap(shared, sizeof(*shared));
	return ret;
}

int32_t lw_campaign_play(const struct lw_launch *launch, struct lw_verdict *verdict,
			 struct lw_trace_sample *trace, int32_t trace_size, uint32_t stride_ms)
{
	struct player *player = calloc(1, sizeof(*player));
	int32_t ret = 0;

	if (player == NULL) {
		return -ENOMEM;
	}

	struct lw_plant_config machine;
	const struct lw_world_config config = {
		.seed = launch->seed,
		.machine = &machine,
		.context = player,
		.observe = observe,
		.observe_edge = observe_edge,
		.observe_run = observe_run,
	};

	lw_plant_config_default(&machine);
	machine.start_um = launch->carriage_um;
	player->polling = true;
	player->trace = trace;
	player->trace_size = trace_size;
	player->stride_ms = stride_ms;
	ret = lw_world_init(&player->world, &config, 0);
	if (ret == 0) {
		lw_judge_init(&player->judge, &player->world);
		player->judge.harmless = launch->harmless != 0;
		for (size_t i = 0; i < launch->action_count && ret == 0; i++) {
			run_ms(player, launch->actions[i].delay_ms);
			ret = act(player, launch, &launch->actions[i]);
		}
		lw_judge_end(&player->judge);
		*verdict = player->judge.verdict;
	}
	if (ret == 0) {
		ret = player->samples;
	}
	free(player);
	return ret;
}

/** Layout of what Python copies. */
const struct lw_layout lw_layout_campaign[] = {
	LW_LAYOUT_STRUCT(lw_action),
	LW_LAYOUT_MEMBER(lw_action, delay_ms),
	LW_LAYOUT_MEMBER(lw_action, kind),
	LW_LAYOUT_MEMBER(lw_action, a),
	LW_LAYOUT_MEMBER(lw_action, b),
	LW_LAYOUT_MEMBER(lw_action, c),
	LW_LAYOUT_MEMBER(lw_action, d),
	LW_LAYOUT_STRUCT(lw_launch),
	LW_LAYOUT_MEMBER(lw_launch, seed),
	LW_LAYOUT_MEMBER(lw_launch, carriage_um),
	LW_LAYOUT_MEMBER(lw_launch, harmless),
	LW_LAYOUT_MEMBER(lw_launch, actions),
	LW_LAYOUT_MEMBER(lw_launch, action_count),
	LW_LAYOUT_MEMBER(lw_launch, requests),
	LW_LAYOUT_STRUCT(lw_verdict),
	LW_LAYOUT_MEMBER(lw_verdict, broken),
	LW_LAYOUT_MEMBER(lw_verdict, broken_ms),
	LW_LAYOUT_MEMBER(lw_verdict, found),
	LW_LAYOUT_MEMBER(lw_verdict, limit),
	LW_LAYOUT_MEMBER(lw_verdict, duration_ms),
	LW_LAYOUT_MEMBER(lw_verdict, tracking_ms),
	LW_LAYOUT_MEMBER(lw_verdict, permit_ms),
	LW_LAYOUT_MEMBER(lw_verdict, state),
	LW_LAYOUT_MEMBER(lw_verdict, fault),
	LW_LAYOUT_MEMBER(lw_verdict, flags),
	LW_LAYOUT_MEMBER(lw_verdict, los_seen),
	LW_LAYOUT_MEMBER(lw_verdict, recoveries),
	LW_LAYOUT_MEMBER(lw_verdict, pole_slips),
	LW_LAYOUT_MEMBER(lw_verdict, pin_edges),
	LW_LAYOUT_MEMBER(lw_verdict, error_usteps),
	LW_LAYOUT_MEMBER(lw_verdict, silent_edges),
	LW_LAYOUT_MEMBER(lw_verdict, slow_turns),
	LW_LAYOUT_MEMBER(lw_verdict, recovered_edges),
	LW_LAYOUT_MEMBER(lw_verdict, hidden_edges),
	LW_LAYOUT_STRUCT(lw_trace_sample),
	LW_LAYOUT_MEMBER(lw_trace_sample, time_ms),
	LW_LAYOUT_MEMBER(lw_trace_sample, flags),
	LW_LAYOUT_MEMBER(lw_trace_sample, state),
	LW_LAYOUT_MEMBER(lw_trace_sample, following),
	LW_LAYOUT_MEMBER(lw_trace_sample, carriage_usteps),
	LW_LAYOUT_MEMBER(lw_trace_sample, told_usteps),
	LW_LAYOUT_MEMBER(lw_trace_sample, ideal_usteps),
	LW_LAYOUT_MEMBER(lw_trace_sample, drum_edges_per_s),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_NONE),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_WAIT_STATE),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_WAIT_POSITION),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_REQUEST),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_DRUM),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_INJECT),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_ARM),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_ECHO),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_BABBLE),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_MASTER),
	LW_LAYOUT_VALUE(lw_action_kind, LW_ACTION_FLIP),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_FLANGE),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_OVERTRAVEL),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_SILENT),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_PERMIT),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_BURST),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_UNASKED),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_PATTERN),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_ODOMETER),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_RECOVERY),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_FALSE_ALARM),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_STANDING),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_LINE),
	LW_LAYOUT_VALUE(lw_invariant, LW_INVARIANT_COUNT),
	LW_LAYOUT_VALUE(lw_ending, LW_ENDING_PLAYED),
	LW_LAYOUT_VALUE(lw_ending, LW_ENDING_CRASHED),
	LW_LAYOUT_VALUE(lw_ending, LW_ENDING_HUNG),
	{0},
};
