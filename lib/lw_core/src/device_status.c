#include "device_internal.h"

#include <string.h>

static bool same(const struct lw_params *a, const struct lw_params *b)
{
	return memcmp(a, b, sizeof(*a)) == 0; /* 32-bit members only: no padding */
}

static uint32_t flags(const struct lw_device *device, uint16_t launch_inhibit)
{
	const struct lw_controller *controller = &device->controller;
	const bool los[4] = {controller->los1[LW_PLUS].set, controller->los1[LW_MINUS].set,
			     controller->los2[LW_PLUS].set, controller->los2[LW_MINUS].set};
	uint32_t bits = 0;

#define FLAG(name, condition) bits |= (uint32_t)(condition) << LW_FLAG_##name
	FLAG(INDEXED, controller->indexed);
	FLAG(TRACKING, controller->state == LW_STATE_TRACKING);
	FLAG(LAUNCH_PERMIT, launch_inhibit == 0);
	FLAG(MOVING, lw_controller_moving(controller));
	FLAG(DRUM_AT_REST, controller->drum_at_rest);
	FLAG(FAULTED, controller->fault != LW_FAULT_NONE);
	FLAG(LOS, los[0] || los[1] || los[2] || los[3]);
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
#undef FLAG
	return bits;
}

static int32_t clamp32(int64_t value)
{
	return value > INT32_MAX ? INT32_MAX : value < INT32_MIN ? INT32_MIN : (int32_t)value;
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
	return clamp32(edges / edges_per_1000 * per_rev_um +
		       edges % edges_per_1000 * per_rev_um / edges_per_1000);
}

void lw_device_refresh_status(struct lw_device *device)
{
	const struct lw_controller *controller = &device->controller;
	const struct lw_motion *motion = &controller->motion;
	const struct lw_motion_reading reading = lw_motion_read(motion);
	const struct lw_derived *derived = &device->derived;
	const struct lw_last_error *error = &device->slave.pdu.last_error;
	const struct lw_los_record *los1 = controller->los1;
	const struct lw_los_record *los2 = controller->los2;
	const struct lw_store *store = device->config->store;
	const struct lw_store_pair *param_slots = &store->pairs[LW_STORE_PARAMS / 2];
	const struct lw_store_pair *journal_slots = &store->pairs[LW_STORE_JOURNAL / 2];
	const uint16_t launch_inhibit = lw_controller_launch_inhibit(controller);
	const struct lw_law_window track =
		controller->state == LW_STATE_TRACKING
			? *motion->window
			: lw_params_window(&device->active, derived, controller->trim_plus_um,
					   controller->trim_minus_um);
	const struct lw_params *params = &device->active;

	device->status_image = (struct lw_status){
		.self_test = LW_SELF_TEST,
		.map_version = LW_MAP_VERSION,
		.version_major = LW_VERSION_MAJOR,
		.version_minor = LW_VERSION_MINOR,
		.version_patch = LW_VERSION_PATCH,
		.host = (int32_t)device->config->host,

		.state = (int32_t)controller->state,
		.active_mode = (int32_t)controller->mode,
		.fault = (int32_t)controller->fault,
		.flags = flags(device, launch_inhibit),
		.launch_inhibit = launch_inhibit,
		.position_um = lw_params_q16_to_um(params, reading.m),
		.position_usteps = lw_law_pos_usteps(reading.m),
		.m = reading.m,
		.u = reading.u,
		.drum_speed_edges_per_s = controller->drum_speed_edges_per_s,
		.rope_speed_mm_per_s = rope_mm(device, controller->drum_speed_edges_per_s),
		.rope_mm = rope_mm(device, reading.net_edges),
		.net_edges = reading.net_edges,
		.pattern_edges = reading.pattern_edges,
		.uptime_ms = (uint32_t)(device->now_us / 1000),
		.los_recoveries = controller->los_recoveries,
		.span_error_um = lw_params_q16_to_um(
			params, (int64_t)controller->span_error_usteps * LW_USTEP),

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
		.steps = reading.steps,
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

		.encoder_interrupt_max_ns = device->health.encoder_interrupt_max_ns,
		.late_interrupts = controller->quadrature.late_interrupts,
		.encoder_index_pulses = controller->encoder_index.pulses,
		.missed_edges = controller->encoder_index.missed_edges,
		.stack_free_supervisor_bytes = device->health.stack_free_supervisor_bytes,
		.stack_free_limits_bytes = device->health.stack_free_limits_bytes,
		.stack_free_modbus_bytes = device->health.stack_free_modbus_bytes,
		.stack_free_storage_bytes = device->health.stack_free_storage_bytes,
		.stack_free_interrupts_bytes = device->health.stack_free_interrupts_bytes,

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

		.ka = derived->ka,
		.nr = derived->nr,
		.ks = derived->ks,
		.reversal_plus_usteps = lw_law_pos_usteps(track.sweep_end),
		.reversal_minus_usteps = lw_law_pos_usteps(track.sweep_begin) - 1,
		.overshoot_actual_um = derived->overshoot_um,
		.slope_error_ppm = derived->slope_error_ppm,
		.overshoot_error_um = derived->overshoot_error_um,
		.edges_per_1000_drum_revs = derived->edges_per_1000_drum_revs,
		.dwell_plus_edges = derived->dwell_plus_edges,
		.dwell_minus_edges = derived->dwell_minus_edges,
	};
	lw_device_cam_status(device, &device->status_image);
}
