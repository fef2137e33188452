#include "launch.h"

#include <errno.h>
#include <stdlib.h>

#include "lw/law.h"

#define NS_PER_MS      1000000u
#define POLL_PERIOD_MS 100u

/** A launch being played. */
struct player {
	struct lw_world world;
	struct lw_judge judge;
	bool polling;
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

static void observe(void *context)
{
	struct player *player = context;

	lw_judge_tick(&player->judge);
	sample(player);
}

/** The master asks for the live status. */
static void poll(struct player *player)
{
	const uint8_t request[] = {4, LW_ADDRESS_STATE >> 8, LW_ADDRESS_STATE & 0xff, 0, 31};
	uint8_t response[LW_PDU_MAX];

	if (player->polling && now_ms(player) - player->polled_ms >= POLL_PERIOD_MS) {
		player->polled_ms = now_ms(player);
		(void)lw_world_request(&player->world, request, sizeof(request), response);
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
		judge->may_hide_edges += (int64_t)argument * judge->edges_per_pulse;
		break;
	case LW_PLANT_FAULT_ENCODER_ILLEGAL:
		judge->may_hide_edges += 2 * (int64_t)argument; /* transitions in each */
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
	default:
		break;
	}
}

static int act(struct player *player, const struct lw_launch *launch,
	       const struct lw_action *action)
{
	struct lw_plant *plant = &player->world.plant;
	uint8_t response[LW_PDU_MAX];

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
		(void)lw_world_request(&player->world, launch->requests + action->a,
				       (size_t)action->b, response);
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
	}
	return -EINVAL;
}

int32_t lw_campaign_play(const struct lw_launch *launch, struct lw_verdict *verdict,
			 struct lw_trace_sample *trace, int32_t trace_size, uint32_t stride_ms)
{
	struct player *player = calloc(1, sizeof(*player));
	int32_t ret = 0;

	if (player == NULL) {
		return -ENOMEM;
	}

	const struct lw_world_config config = {
		.seed = launch->seed,
		.carriage_um = launch->carriage_um,
		.context = player,
		.observe = observe,
		.observe_edge = observe_edge,
	};

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
