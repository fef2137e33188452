/* SPDX-License-Identifier: Apache-2.0 */
#include "device_internal.h"

#include "lw/bytes/numbers.h"
#include "lw/bytes/same.h"

static bool same(const struct lw_params *a, const struct lw_params *b)
{
	return lw_same(a, b, sizeof(*a)); /* 32-bit members only: no padding */
}

bool lw_device_set_unconfirmed(const struct lw_device *device)
{
	return device->config->host == LW_HOST_HARDWARE &&
	       !lw_store_has_params(device->config->store);
}

uint16_t lw_device_launch_inhibit(const struct lw_device *device)
{
	unsigned int inhibit = lw_controller_launch_inhibit(&device->controller);

	inhibit |= (unsigned int)lw_device_set_unconfirmed(device)
		   << LW_LAUNCH_INHIBIT_SET_UNCONFIRMED;
	return (uint16_t)inhibit;
}

static uint64_t flags(const struct lw_device *device, uint16_t launch_inhibit)
{
	const struct lw_controller *controller = &device->controller;
	const bool los[4] = {controller->los.los1[LW_PLUS].set, controller->los.los1[LW_MINUS].set,
			     controller->los.los2[LW_PLUS].set, controller->los.los2[LW_MINUS].set};
	uint64_t bits = 0;

#define FLAG(name, condition) bits |= (uint64_t)(condition) << LW_FLAG_##name
	FLAG(INDEXED, controller->indexed);
	FLAG(TRACKING, controller->state == LW_STATE_TRACKING);
	FLAG(LAUNCH_PERMIT, launch_inhibit == 0);
	FLAG(MOVING, lw_controller_moving(controller));
	FLAG(DRUM_AT_REST, controller->speed.at_rest);
	FLAG(FAULTED, controller->fault != LW_FAULT_NONE);
	FLAG(LOS, lw_los_any(&controller->los));
	FLAG(LOS1_PLUS, los[0]);
	FLAG(LOS1_MINUS, los[1]);
	FLAG(LOS2_PLUS, los[2]);
	FLAG(LOS2_MINUS, los[3]);
	FLAG(SWITCH_PLUS, controller->limit[LW_PLUS].active);
	FLAG(SWITCH_MINUS, controller->limit[LW_MINUS].active);
	FLAG(WIRING_PLUS, controller->wiring[LW_PLUS]);
	FLAG(WIRING_MINUS, controller->wiring[LW_MINUS]);
	FLAG(OVERTRAVEL_PLUS, controller->overtravel[LW_PLUS]);
	FLAG(OVERTRAVEL_MINUS, controller->overtravel[LW_MINUS]);
	FLAG(OVERSPEED_WARNING, lw_device_overspeed(device));
	FLAG(OVERSPEED_TRIP, controller->overspeed_trip);
	FLAG(MASTER_LOST, controller->master_lost);
	FLAG(STAGED, !same(&device->staged, &device->active));
	FLAG(DIRTY, !same(&device->active, &device->config->store->params));
	FLAG(DEFAULTS_LOADED, !lw_store_has_params(device->config->store));
	FLAG(TRIM_PENDING, controller->state != LW_STATE_PARKING &&
				   controller->motion.requests & LW_MOTION_REQUEST_WINDOW);
	FLAG(CORRECTION_PENDING, (controller->motion.requests & LW_MOTION_REQUEST_CORRECTION) != 0);
	FLAG(STEPPER_ENABLED, lw_controller_stepper_enabled(controller));
	FLAG(HELD, controller->held);
	FLAG(RESTART_NEEDED, lw_device_line_differs(device));
	FLAG(LOCKED, lw_lock_is_closed(&device->lock, device->active.lock_code));
	FLAG(LINE_TRIAL, lw_device_line_on_trial(device));
	FLAG(WATCHDOG_RESET, device->config->watchdog_reset);
	FLAG(CAM_QUEUED, lw_device_cam_queued(device));
	FLAG(SWITCH_IMPLAUSIBLE, controller->switch_check.implausible[LW_PLUS] ||
					 controller->switch_check.implausible[LW_MINUS]);
	FLAG(SET_UNCONFIRMED, lw_device_set_unconfirmed(device));
	FLAG(ROPE_LAID_STANDING, controller->rope.set);
	FLAG(ODOMETER_DOUBTFUL, controller->odometer_doubtful);
	FLAG(ENCODER_DOUBTFUL, controller->drum_watch.doubtful);
	FLAG(ENCODER_FAULT, controller->los.encoder.set);
	FLAG(CLOCK_FALLBACK, device->config->clock_fallback);
	FLAG(LINE_BABBLE, lw_device_line_babbles(device));
	FLAG(LINE_ECHO, lw_device_line_echoes(device));
	FLAG(REACQUIRED, controller->los.reacquired.set);
	FLAG(RESUME_DOUBTFUL, controller->resume.known && controller->resume.doubtful);
	FLAG(NOT_ACCEPTED, device->active.accepted_crc != device->active_crc);
	FLAG(ROPE_DOUBTFUL, lw_rope_length_doubtful(&controller->rope_length));
#undef FLAG
	return bits;
}

static int32_t clamp16(uint32_t value)
{
	return value > UINT16_MAX ? UINT16_MAX : (int32_t)value;
}

/** Rope length of a number of edges, in millimetres per `per` edges; 64 bit throughout. */
static int32_t rope_mm(const struct lw_device *device, int64_t edges)
{
	const int64_t per_rev_um = (int64_t)device->active.rope_per_drum_rev_um;
	const int64_t edges_per_1000 = (int64_t)device->derived.edges_per_1000_drum_revs;

	/* um per rev * 1000 revs / 1000 um per mm: the thousands cancel. */
	return lw_clamp32(edges / edges_per_1000 * per_rev_um +
			  edges % edges_per_1000 * per_rev_um / edges_per_1000);
}

/** Metres by the layers that grow, where the rope on the drum is known. */
static void rope_by_layers(const struct lw_rope_length *rope,
			   const struct lw_motion_reading *reading, int32_t edges_per_s,
			   struct lw_status *status)
{
	const struct lw_rope_geometry *geometry = &rope->geometry;
	int64_t turns_q16;
	int64_t um;

	if (!lw_rope_length_known(rope)) {
		return;
	}
	turns_q16 = lw_rope_length_now_q16(rope, reading->net_edges);
	um = lw_rope_length_um(geometry, turns_q16);
	status->rope_on_drum_mm = lw_clamp32(lw_divide_nearest(um, 1000));
	status->rope_out_mm = lw_clamp32((int64_t)rope->told_mm - status->rope_on_drum_mm);
	status->rope_layer = lw_rope_layer(geometry, turns_q16);
	status->rope_radius_um = (uint32_t)lw_clamp32(lw_rope_radius_um(geometry, turns_q16));
	status->rope_speed_mm_per_s = lw_clamp32(
		lw_divide_nearest(lw_rope_moved_um(geometry, turns_q16, edges_per_s), 1000));
	um -= lw_rope_length_um(geometry, lw_rope_length_now_q16(rope, 0));
	status->rope_mm = lw_clamp32(lw_divide_nearest(um, 1000));
}

/** Fill what changes as the machine moves, and what the law works with. @return what it was read
 * from */
static struct lw_motion_reading read_live(const struct lw_device *device, struct lw_status *status)
{
	const struct lw_controller *controller = &device->controller;
	const struct lw_motion *motion = &controller->motion;
	const struct lw_derived *derived = &device->derived;
	const struct lw_params *params = &device->active;
	const struct lw_law_window *in_force;
	struct lw_motion_reading reading;
	uint16_t launch_inhibit;
	uint8_t requests;
	uint64_t bits;

	/* What an edge has taken is told as taken where its position is told, and not before. */
	do {
		requests = motion->requests;
		reading = lw_motion_read(motion);
		launch_inhibit = lw_device_launch_inhibit(device);
		bits = flags(device, launch_inhibit);
		in_force = motion->window;
	} while (requests != motion->requests);

	const struct lw_law_window track =
		controller->state == LW_STATE_TRACKING
			? *in_force
			: lw_params_window(params, derived, controller->trim.plus_um,
					   controller->trim.minus_um);

	status->state = (int32_t)controller->state;
	status->active_mode = (int32_t)controller->mode;
	status->fault = (int32_t)controller->fault;
	status->flags = (uint32_t)bits;
	status->launch_inhibit = launch_inhibit;
	status->position_um = lw_params_q16_to_um(params, reading.m);
	status->position_usteps = lw_law_pos_usteps(reading.m);
	status->m = reading.m;
	status->u = reading.u;
	status->drum_speed_edges_per_s = controller->speed.edges_per_s;
	status->net_edges = reading.net_edges;
	status->pattern_edges = reading.pattern_edges;
	status->uptime_ms = (uint32_t)(device->now_us / 1000);
	status->los_recoveries = controller->los.recoveries;
	status->flags_2 = (uint32_t)(bits >> 32);
	status->steps = reading.steps;
	status->ka = derived->ka;
	status->nr = derived->nr;
	status->ks = derived->ks;
	status->reversal_plus_usteps = lw_law_pos_usteps(track.sweep_end);
	status->reversal_minus_usteps = lw_law_pos_usteps(track.sweep_begin) - 1;
	status->edges_per_1000_drum_revs = derived->edges_per_1000_drum_revs;
	status->dwell_plus_edges = derived->dwell_plus_edges;
	status->dwell_minus_edges = derived->dwell_minus_edges;
	return reading;
}

void lw_device_refresh_live(struct lw_device *device)
{
	(void)read_live(device, &device->status_image);
}

void lw_device_refresh_status(struct lw_device *device)
{
	const struct lw_controller *controller = &device->controller;
	const struct lw_motion *motion = &controller->motion;
	const struct lw_derived *derived = &device->derived;
	const struct lw_last_error *error = &device->slave.pdu.last_error;
	const struct lw_los_record *los1 = controller->los.los1;
	const struct lw_los_record *los2 = controller->los.los2;
	const struct lw_rope_watch *rope = &controller->rope;
	const struct lw_store *store = device->config->store;
	const struct lw_store_pair *param_slots = &store->pairs[LW_STORE_PARAMS / 2];
	const struct lw_store_pair *journal_slots = &store->pairs[LW_STORE_JOURNAL / 2];
	const struct lw_params *params = &device->active;
	struct lw_motion_reading reading;

	device->status_image = (struct lw_status){
		.self_test = LW_SELF_TEST,
		.map_version = LW_MAP_VERSION,
		.version_major = LW_VERSION_MAJOR,
		.version_minor = LW_VERSION_MINOR,
		.version_patch = LW_VERSION_PATCH,
		.host = (int32_t)device->config->host,
		.image_hash_high = (uint32_t)(device->config->image_hash >> 32),
		.image_hash_low = (uint32_t)device->config->image_hash,

		.rope_speed_mm_per_s = rope_mm(device, controller->speed.edges_per_s),
		.span_error_um = lw_params_q16_to_um(
			params, (int64_t)controller->homing.span_error_usteps * LW_USTEP),
		.resume_position_um = controller->resume.known
					      ? lw_params_q16_to_um(params, controller->resume.m)
					      : 0,
		.resume_direction = lw_controller_resume_direction(controller),

		.los1_plus_count = los1[LW_PLUS].count,
		.los1_plus_position_um = lw_params_q16_to_um(params, los1[LW_PLUS].position_q16),
		.los1_plus_time_ms = los1[LW_PLUS].time_ms,
		.los1_minus_count = los1[LW_MINUS].count,
		.los1_minus_position_um = lw_params_q16_to_um(params, los1[LW_MINUS].position_q16),
		.los1_minus_time_ms = los1[LW_MINUS].time_ms,
		.los2_plus_count = los2[LW_PLUS].count,
		.los2_plus_position_um = lw_params_q16_to_um(params, los2[LW_PLUS].position_q16),
		.los2_plus_time_ms = los2[LW_PLUS].time_ms,
		.los2_minus_count = los2[LW_MINUS].count,
		.los2_minus_position_um = lw_params_q16_to_um(params, los2[LW_MINUS].position_q16),
		.los2_minus_time_ms = los2[LW_MINUS].time_ms,

		.illegal_transitions = controller->quadrature.illegal_transitions,
		.switch_plus_triggers = controller->limit[LW_PLUS].triggers,
		.switch_minus_triggers = controller->limit[LW_MINUS].triggers,
		.requests = device->slave.pdu.counters[LW_BUS_SERVER_MESSAGES],
		.crc_errors = device->slave.pdu.counters[LW_BUS_CRC_ERRORS],
		.exceptions = device->slave.pdu.counters[LW_BUS_EXCEPTIONS],

		.boots = store->counters.boots,
		.watchdog_resets = store->counters.watchdog_resets,
		.powered_s = store->counters.powered_s,
		.tracking_s = store->counters.tracking_s,
		.log_sequence = store->log.newest,
		.log_count = lw_log_count(&store->log),
		.log_unsaved = clamp16(store->log.newest - store->log_stored),
		.record_sequence = param_slots->used_sequence,
		.record_schema = param_slots->used_schema,
		.slot_0 = (int32_t)param_slots->state[0],
		.slot_1 = (int32_t)param_slots->state[1],
		.slot_2 = (int32_t)journal_slots->state[0],
		.slot_3 = (int32_t)journal_slots->state[1],

		.active_crc = device->active_crc,

		.encoder_interrupt_max_ns = device->health.encoder_interrupt_max_ns,
		.late_interrupts = controller->quadrature.late_interrupts,
		.encoder_index_pulses = controller->encoder_index.pulses,
		.missed_edges = controller->encoder_index.missed_edges,
		.stack_free_supervisor_bytes = device->health.stack_free_supervisor_bytes,
		.stack_free_limits_bytes = device->health.stack_free_limits_bytes,
		.stack_free_modbus_bytes = device->health.stack_free_modbus_bytes,
		.stack_free_storage_bytes = device->health.stack_free_storage_bytes,
		.stack_free_interrupts_bytes = device->health.stack_free_interrupts_bytes,

		.encoder_fault_kind = (int32_t)controller->drum_watch.fault,
		.encoder_fault_count = controller->los.encoder.count,
		.encoder_fault_position_um =
			lw_params_q16_to_um(params, controller->los.encoder.position_q16),
		.encoder_fault_time_ms = controller->los.encoder.time_ms,
		.encoder_doubts = controller->drum_watch.doubts,
		.encoder_misfit_edges =
			controller->encoder_index.misfit_edges - controller->drum_watch.misfit_base,
		.rope_standing_millirev =
			lw_rope_watch_millirev(rope, derived->edges_per_1000_drum_revs),
		.rope_standing_position_um = lw_params_q16_to_um(params, rope->position_q16),
		.rope_standing_time_ms = rope->time_ms,
		.rope_standing_place_known = rope->set && rope->place_known,
		.look_before_power_up = lw_device_look_before_power_up(device),

		.line_babbles = device->slave.babbles,
		.line_echoes = device->slave.echoes,
		.late_requests = device->slave.late_requests,
		.foreign_answers = device->slave.foreign_answers,
		.events_skipped = device->events_skipped,
		.memory_corrections = device->set_copy.corrections,

		.command_sequence = device->command.sequence,
		.command_code = device->command.code,
		.command_result = device->command.result,
		.command_reason = device->command.why.reason,
		.command_address = device->command.why.address,
		.command_value = device->command.why.value,
		.command_limit = device->command.why.limit,
		.last_error_reason = error->reason,
		.last_error_function = error->function,
		.last_error_exception = error->exception,
		.last_error_address = error->address,
		.last_error_value = error->value,
		.last_error_limit = error->limit,

		.overshoot_actual_um = derived->overshoot_um,
		.slope_error_ppm = derived->slope_error_ppm,
		.overshoot_error_um = derived->overshoot_error_um,
		.breaker_edges = derived->breaker_edges,
		.breaker_cycle_plus = (int32_t)motion->law.cycle_plus,
		.breaker_cycle_minus = (int32_t)motion->law.cycle_minus,
	};
	reading = read_live(device, &device->status_image);
	device->status_image.rope_mm = rope_mm(device, reading.net_edges);
	device->status_image.slot_6 = (int32_t)store->pairs[LW_STORE_LOOK / 2].state[0];
	device->status_image.slot_7 = (int32_t)store->pairs[LW_STORE_LOOK / 2].state[1];
	rope_by_layers(&controller->rope_length, &reading, controller->speed.edges_per_s,
		       &device->status_image);
	lw_device_cam_status(device, &device->status_image);
}
