/* SPDX-License-Identifier: Apache-2.0 */
#include "world.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define NS_PER_US 1000u
#define TICK_NS   (LW_CONTROLLER_TICK_US * NS_PER_US)

/** The controller's clock: it starts with the power. */
static uint64_t controller_us(const struct lw_world *world)
{
	return (world->now_ns - world->power_up_ns) / NS_PER_US;
}

static void load(struct lw_world *world)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];

	lw_store_init(&world->store);
	for (unsigned int slot = 0; slot < LW_STORE_SLOTS; slot++) {
		if (world->config.read_slot != NULL) {
			const size_t length = world->config.read_slot(world->config.context, slot,
								      bytes, sizeof(bytes));

			lw_store_load(&world->store, slot, bytes, length);
		} else {
			lw_store_load(&world->store, slot, world->memory[slot],
				      sizeof(world->memory[slot]));
		}
	}
}

static void power_up(struct lw_world *world, uint64_t slave_now_us)
{
	const struct lw_plant_pins *pins = &world->plant.pins;
	struct lw_inputs inputs = {.encoder_a = pins->encoder_a,
				   .encoder_b = pins->encoder_b,
				   .stepper_alarm = pins->stepper_alarm};

	for (int side = 0; side < 2; side++) {
		inputs.limit[side].no_closed = pins->limit[side].no_closed;
		inputs.limit[side].nc_closed = pins->limit[side].nc_closed;
		inputs.overtravel[side] = pins->overtravel[side];
	}
	world->power_up_ns = world->now_ns;
	load(world);
	lw_device_init(&world->device, &world->device_config, &inputs, controller_us(world),
		       slave_now_us);
	/* Without a controller there is no current; the first tick switches it on. */
	lw_plant_enable(&world->plant, false);
	world->stepper_enabled = false;
	world->timer_rate_edges_per_s = 0;
	world->timer_ns = UINT64_MAX;
	world->was_indexed = false;
}

int lw_world_init(struct lw_world *world, const struct lw_world_config *config,
		  uint64_t slave_now_us)
{
	struct lw_plant_config machine;
	int ret;

	*world = (struct lw_world){.config = *config, .tick_ns = TICK_NS};
	world->config.machine = NULL;
	if (config->machine != NULL) {
		machine = *config->machine;
	} else {
		lw_plant_config_default(&machine);
	}
	ret = lw_plant_init(&world->plant, &machine, config->seed);
	if (ret) {
		return ret;
	}
	lw_plant_bench_init(&world->bench, &world->plant);
	world->bench_section = lw_plant_bench_section(&world->bench);
	world->device_config = (struct lw_device_config){
		.host = LW_HOST_SIMULATOR,
		.store = &world->store,
		.kept = &world->kept,
		.host_section = &world->bench_section,
		.silence_us = config->silence_us,
		.line_takes_no_time = config->line_takes_no_time,
		.unit_id = config->unit_id,
	};
	power_up(world, slave_now_us);
	return 0;
}

/** Do the write to the storage that is due. */
static void serve_storage(struct lw_world *world)
{
	uint8_t bytes[LW_STORE_SLOT_SIZE];
	unsigned int slot;
	const size_t length = lw_device_begin_write(&world->device, &slot, bytes);
	int ret = 0;

	if (length == 0) {
		return;
	}
	if (world->config.write_slot != NULL) {
		ret = world->config.write_slot(world->config.context, slot, bytes, length);
	} else {
		memcpy(world->memory[slot], bytes, length);
	}
	lw_device_end_write(&world->device, ret);
}

/** Do what the controller asks for outside of its interrupts. */
static void serve_outputs(struct lw_world *world)
{
	const struct lw_controller *controller = &world->device.controller;
	const bool enabled = lw_controller_stepper_enabled(controller);
	const uint32_t rate = lw_controller_timer_rate_edges_per_s(controller);

	if (enabled != world->stepper_enabled) {
		lw_plant_enable(&world->plant, enabled);
		world->stepper_enabled = enabled;
	}
	if (rate != world->timer_rate_edges_per_s) {
		world->timer_rate_edges_per_s = rate;
		world->timer_ns = rate ? world->now_ns + 1000000000u / rate : UINT64_MAX;
	}
	if (controller->indexed && !world->was_indexed) {
		lw_plant_reference(&world->plant); /* from here on a slip is a slip */
	}
	world->was_indexed = controller->indexed;
}

static void tick(struct lw_world *world)
{
	if (world->bench.power_cut) {
		world->bench.power_cut = false;
		if (!world->bench.memory_kept) {
			world->kept = (struct lw_kept){0};
		}
		world->device_config.watchdog_reset = world->bench.memory_kept;
		power_up(world, world->device.slave.last_request_us);
	}
	lw_controller_stepper_alarm(&world->device.controller, world->plant.pins.stepper_alarm);
	lw_device_trim_buttons(&world->device, world->plant.pins.trim_buttons);
	lw_device_tick(&world->device, controller_us(world));
	serve_storage(world);
	serve_outputs(world);
	if (world->config.observe != NULL) {
		world->config.observe(world->config.context);
	}
}

static void edge(struct lw_world *world, enum lw_edge_source source, int steps)
{
	int driver_steps = 0;

	if (steps != 0) {
		driver_steps = lw_controller_driver_step(&world->device.controller, steps);
		lw_plant_step(&world->plant, driver_steps);
	}
	if (world->config.observe_edge != NULL) {
		world->config.observe_edge(world->config.context, source, driver_steps);
	}
}

/** Events of the plant up to the first that changes pins: hand those to the controller's
 * interrupts. */
static void plant_event(struct lw_world *world, uint64_t until_ns)
{
	struct lw_controller *controller = &world->device.controller;
	const struct lw_plant_pins *pins = &world->plant.pins;
	const uint32_t changed = lw_plant_advance_to(&world->plant, until_ns);

	world->now_ns = world->plant.now_ns;
	if (changed & LW_PLANT_ENCODER) {
		edge(world, LW_EDGE_SOURCE_ENCODER,
		     lw_controller_encoder(controller, pins->encoder_a, pins->encoder_b));
	}
	if (!(changed & ~(uint32_t)LW_PLANT_ENCODER)) {
		return;
	}
	if ((changed & LW_PLANT_ENCODER_INDEX) && pins->encoder_index) {
		lw_controller_encoder_index(controller);
	}
	for (int side = 0; side < 2; side++) {
		if (changed & (side == LW_PLUS ? LW_PLANT_LIMIT_PLUS : LW_PLANT_LIMIT_MINUS)) {
			lw_controller_limit(controller, side, pins->limit[side].no_closed,
					    pins->limit[side].nc_closed, controller_us(world));
		}
		if (changed &
		    (side == LW_PLUS ? LW_PLANT_OVERTRAVEL_PLUS : LW_PLANT_OVERTRAVEL_MINUS)) {
			lw_controller_overtravel(controller, side, pins->overtravel[side]);
		}
	}
}

/** Do so many edges of the law give steps one way only? Then their sum tells their number, too. */
static bool steps_one_way(const struct lw_controller *controller, uint32_t edges)
{
	const struct lw_law *law = &controller->motion.law;

	return law->open_span != 0 && (uint64_t)llabs(law->u) > (uint64_t)edges * (uint32_t)law->ka;
}

/** Transitions of a sound encoder with nothing else in between. */
static void run_of_transitions(struct lw_world *world, uint64_t until_ns)
{
	struct lw_controller *controller = &world->device.controller;
	struct lw_plant *plant = &world->plant;
	const struct lw_plant_run run = lw_plant_run_begin(plant, until_ns, UINT32_MAX);
	const int direction = lw_plant_run_direction(plant);
	const uint32_t together = steps_one_way(controller, run.count) ? run.count : 1;

	for (uint32_t left = run.count; left > 0; left -= together) {
		const int steps =
			lw_controller_encoder_count(controller, direction * (int32_t)together);

		lw_plant_step(plant, lw_controller_driver_step(controller, steps));
	}
	lw_plant_run_end(plant, &run);
	world->now_ns = plant->now_ns;
	if (run.index_begins) {
		lw_controller_encoder_index(controller);
	}
}

/** Transitions to the next one that may give a step, as the drum turns now. */
static uint32_t transitions_to_step(const struct lw_controller *controller, int direction)
{
	return lw_quadrature_goes_on(&controller->quadrature, direction > 0 ? 0 : 1)
		       ? lw_controller_encoder_reach(controller, direction)
		       : 1;
}

/** The same for who looks: up to each step by itself, as the steps of each are to be seen. */
static void observed_run(struct lw_world *world, uint64_t until_ns)
{
	struct lw_controller *controller = &world->device.controller;
	struct lw_plant *plant = &world->plant;
	struct lw_world_run *seen = &world->run;
	const struct lw_plant_run run = lw_plant_run_begin(plant, until_ns, LW_WORLD_RUN_MAX);
	const int direction = lw_plant_run_direction(plant);
	uint32_t step_count = 0;
	uint32_t done = 0;

	while (done < run.count) {
		const uint32_t to_step = transitions_to_step(controller, direction);
		const uint32_t count = to_step < run.count - done ? to_step : run.count - done;
		const int edge_steps =
			lw_controller_encoder_count(controller, direction * (int32_t)count);

		done += count;
		if (edge_steps != 0) {
			const int steps = lw_controller_driver_step(controller, edge_steps);

			lw_plant_step(plant, steps);
			seen->steps[step_count].time_ns = lw_plant_run_ns(plant, done);
			seen->steps[step_count].transition = done;
			seen->steps[step_count].steps = steps;
			step_count++;
		}
	}
	seen->direction = plant->drum.direction;
	seen->count = run.count;
	seen->step_count = step_count;
	lw_plant_run_end(plant, &run);
	world->now_ns = plant->now_ns;
	world->config.observe_run(world->config.context, seen);
	if (run.index_begins) {
		lw_controller_encoder_index(controller);
	}
}

/** The plant's events up to a time; between two of its own nothing else happens. */
static void run_plant(struct lw_world *world, uint64_t until_ns)
{
	while (lw_plant_next_event_ns(&world->plant) <= until_ns) {
		if (!lw_plant_next_is_run(&world->plant, until_ns)) {
			plant_event(world, until_ns);
		} else if (world->config.observe_run == NULL) {
			run_of_transitions(world, until_ns);
		} else {
			observed_run(world, until_ns);
		}
	}
}

void lw_world_run(struct lw_world *world, uint64_t until_ns)
{
	for (;;) {
		const uint64_t own_ns =
			world->timer_ns < world->tick_ns ? world->timer_ns : world->tick_ns;

		run_plant(world, own_ns < until_ns ? own_ns : until_ns);
		if (own_ns > until_ns) {
			break;
		}
		world->now_ns = own_ns;
		if (world->timer_ns <= world->tick_ns) {
			world->timer_ns += 1000000000u / world->timer_rate_edges_per_s;
			edge(world, LW_EDGE_SOURCE_TIMER,
			     lw_controller_timer_edge(&world->device.controller));
		} else {
			world->tick_ns += TICK_NS;
			tick(world);
		}
	}
	world->now_ns = until_ns;
}

size_t lw_world_request(struct lw_world *world, const uint8_t *request, size_t length,
			uint8_t response[LW_PDU_MAX])
{
	world->device.slave.last_request_us = world->now_ns / NS_PER_US; /* the master is alive */
	return lw_pdu_handle(&world->device.slave.pdu, request, length, response);
}
