/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The journal: what goes into the event log, the hours, and when both are stored.
 */
#include "device_internal.h"

/** From an event to its write: what belongs together is written together. */
#define JOURNAL_SETTLE_US 2000000u

/** Mean time between two writes, at least: the flash lives for a limited number of them. */
#define WRITE_PRICE_US 60000000u

/** So many writes may come at once: what happens before a power cut shall not wait. */
#define JOURNAL_WRITES_AT_ONCE 10u

/** From one write to the next that only keeps the hours. */
#define JOURNAL_HOURS_US 900000000u

/** How long the line's flags tell of what is over: a master could not ask meanwhile. */
#define LINE_TOLD_US 10000000u

static bool all_stored(const struct lw_store *store)
{
	return store->log.newest == store->log_stored;
}

/*
 * What somebody or something outside can repeat without end: a master that falls silent every
 * second, a loose wire, a PLC that gives STOP in every cycle. One of these must neither wear out
 * the flash nor push everything else out of the log. So each has so many events at once, in the
 * long run one in ten minutes.
 */
enum cause {
	CAUSE_NONE, /* bounded by what the machine can do */
	CAUSE_MASTER,
	CAUSE_BABBLE,
	CAUSE_ECHO,
	CAUSE_WIRING,
	CAUSE_LOCK,
	CAUSE_SETTINGS,
	CAUSE_TRIM,
	CAUSE_MEMORY,
	/* Always logged; beyond that rate they do not ask for a write of their own. */
	CAUSE_STOP,
	CAUSE_MODE,
	CAUSE_INDEX,
	CAUSE_FAULT,
	CAUSE_COUNT,
};
_Static_assert(CAUSE_COUNT - 1 == LW_DEVICE_CAUSES, "a place for each");

#define CAUSE_EVENTS_AT_ONCE 10u
#define CAUSE_PRICE_S        600u

static enum cause cause_of(enum lw_event event)
{
	switch (event) {
	case LW_EVENT_MASTER_LOST:
		return CAUSE_MASTER;
	case LW_EVENT_LINE_BABBLE:
		return CAUSE_BABBLE;
	case LW_EVENT_LINE_ECHO:
		return CAUSE_ECHO;
	case LW_EVENT_WIRING_PLUS:
	case LW_EVENT_WIRING_MINUS:
	case LW_EVENT_SWITCH_IMPLAUSIBLE:
		return CAUSE_WIRING;
	case LW_EVENT_LOCK_OPENED:
		return CAUSE_LOCK;
	case LW_EVENT_STOPPED:
		return CAUSE_STOP;
	case LW_EVENT_APPLIED:
	case LW_EVENT_APPLY_REFUSED:
	case LW_EVENT_FACTORY_STAGED:
		return CAUSE_SETTINGS;
	case LW_EVENT_MEMORY_CORRECTED:
		return CAUSE_MEMORY;
	case LW_EVENT_TRIMMED:
	case LW_EVENT_TRIM_REFUSED:
		return CAUSE_TRIM;
	case LW_EVENT_ROPE_SET:
		return CAUSE_SETTINGS;
	case LW_EVENT_MODE_CHANGED:
		return CAUSE_MODE;
	case LW_EVENT_INDEX_STARTED:
	case LW_EVENT_INDEX_DONE:
	case LW_EVENT_INDEX_FAILED:
		return CAUSE_INDEX;
	case LW_EVENT_REACQUIRE_STARTED:
	case LW_EVENT_REACQUIRE_DONE:
		return CAUSE_INDEX;
	case LW_EVENT_FAULT_SET:
	case LW_EVENT_FAULT_CLEARED:
		return CAUSE_FAULT;
	default:
		return CAUSE_NONE;
	}
}

/** Pay for an event of this cause. @return false: it comes too often */
static bool pay(struct lw_device *device, enum cause cause)
{
	const uint32_t now_s = (uint32_t)(device->now_us / 1000000);
	uint32_t *paid_until_s;

	if (cause == CAUSE_NONE) {
		return true;
	}
	paid_until_s = &device->cause_paid_until_s[cause - 1];
	if (*paid_until_s < now_s) {
		*paid_until_s = now_s;
	}
	if (*paid_until_s > now_s + (CAUSE_EVENTS_AT_ONCE - 1) * CAUSE_PRICE_S) {
		return false;
	}
	*paid_until_s += CAUSE_PRICE_S;
	return true;
}

bool lw_device_log(struct lw_device *device, enum lw_event event, int32_t detail)
{
	const enum cause cause = cause_of(event);
	const bool paid = pay(device, cause);
	const struct lw_controller *controller = &device->controller;
	const struct lw_motion_reading reading = lw_motion_read(&controller->motion);
	struct lw_store *store = device->config->store;

	if (!paid && cause < CAUSE_STOP) {
		device->events_skipped++;
		return false;
	}
	if (paid && device->journal_due_us == UINT64_MAX) {
		device->journal_due_us = device->now_us + JOURNAL_SETTLE_US;
	}
	lw_log_add(&store->log,
		   (struct lw_log_record){
			   .boot = store->counters.boots,
			   .time_ms = (uint32_t)(device->now_us / 1000),
			   .event = (uint16_t)event,
			   .state = (uint16_t)controller->state,
			   .detail = detail,
			   .position_um = lw_params_q16_to_um(&device->active, reading.m),
			   .net_edges = reading.net_edges,
		   });
	return true;
}

static void log_slots(struct lw_device *device)
{
	const struct lw_store_pair *pairs = device->config->store->pairs;

	for (int32_t slot = 0; slot < LW_STORE_SLOTS; slot++) {
		switch (pairs[slot / 2].state[slot % 2]) {
		case LW_SLOT_STATE_DAMAGED:
			lw_device_log(device, LW_EVENT_SLOT_DAMAGED, slot);
			break;
		case LW_SLOT_STATE_NEWER:
			lw_device_log(device, LW_EVENT_SLOT_NEWER, slot);
			break;
		case LW_SLOT_STATE_REFUSED:
			lw_device_log(device, LW_EVENT_SLOT_REFUSED, slot);
			break;
		case LW_SLOT_STATE_EMPTY:
		case LW_SLOT_STATE_GOOD:
		case LW_SLOT_STATE_OLDER:
			break;
		}
	}
}

static uint32_t rope_standing_millirev(const struct lw_device *device)
{
	return lw_rope_watch_millirev(&device->controller.rope,
				      device->derived.edges_per_1000_drum_revs);
}

void lw_device_log_power_up(struct lw_device *device)
{
	struct lw_store *store = device->config->store;

	device->seen = (struct lw_device_seen){
		.state = device->controller.state,
		.mode = device->controller.mode,
		.fault = device->controller.fault,
		.rope_laid_standing = device->controller.rope.set,
		.rope_standing_millirev = rope_standing_millirev(device),
	};
	if (store->pairs[LW_STORE_JOURNAL / 2].used) {
		lw_log_skip(&store->log);
		store->log_stored = store->log.newest;
	}
	store->counters.boots += device->config->unstored.boots + 1;
	store->counters.watchdog_resets += device->config->unstored.watchdog_resets;
	lw_device_log(device, LW_EVENT_POWER_UP,
		      LW_VERSION_MAJOR * 10000 + LW_VERSION_MINOR * 100 + LW_VERSION_PATCH);
	if (device->config->watchdog_reset) {
		store->counters.watchdog_resets++;
		lw_device_log(device, LW_EVENT_WATCHDOG_RESET, 0);
	}
	if (device->config->clock_fallback) {
		lw_device_log(device, LW_EVENT_CLOCK_FALLBACK, 0);
	}
	log_slots(device);
	if (!lw_store_has_params(store)) {
		lw_device_log(device, LW_EVENT_DEFAULTS_LOADED, 0);
	}
	if (store->look.causes != 0) {
		lw_device_log(device, LW_EVENT_LOOK_PENDING, (int32_t)store->look.causes);
	}
	/* Until it is stored that these numbers are given, another power cut would give them again.
	 */
	device->journal_due_us = device->now_us;
}

static void log_los(struct lw_device *device)
{
	static const enum lw_event events[] = {LW_EVENT_LOS1_PLUS, LW_EVENT_LOS1_MINUS,
					       LW_EVENT_LOS2_PLUS, LW_EVENT_LOS2_MINUS};
	const struct lw_controller *controller = &device->controller;
	const uint16_t counts[] = {
		controller->los.los1[LW_PLUS].count, controller->los.los1[LW_MINUS].count,
		controller->los.los2[LW_PLUS].count, controller->los.los2[LW_MINUS].count};

	for (size_t i = 0; i < sizeof(counts) / sizeof(counts[0]); i++) {
		if (counts[i] != device->seen.los_count[i]) {
			device->seen.los_count[i] = counts[i];
			lw_device_log(device, events[i], counts[i]);
		}
	}
	if (controller->los.encoder.count != device->seen.encoder_los_count) {
		device->seen.encoder_los_count = controller->los.encoder.count;
		lw_device_log(device, LW_EVENT_ENCODER_FAULT,
			      (int32_t)controller->drum_watch.fault);
	}
}

/** Once when it is told, and again when the drum has come to rest, if it has become more. */
static void log_rope(struct lw_device *device)
{
	const struct lw_controller *controller = &device->controller;
	struct lw_device_seen *seen = &device->seen;
	const uint32_t millirev = rope_standing_millirev(device);
	const bool came_to_rest = controller->speed.at_rest && !seen->drum_at_rest;

	seen->drum_at_rest = controller->speed.at_rest;
	if (controller->rope.set && (!seen->rope_laid_standing ||
				     (came_to_rest && millirev != seen->rope_standing_millirev))) {
		seen->rope_standing_millirev = millirev;
		lw_device_log(device, LW_EVENT_ROPE_LAID_STANDING, (int32_t)millirev);
	}
	if (!controller->rope.set && seen->rope_laid_standing) {
		lw_device_log(device, LW_EVENT_ROPE_ACKNOWLEDGED,
			      (int32_t)seen->rope_standing_millirev);
	}
	seen->rope_laid_standing = controller->rope.set;
}

static void log_inputs(struct lw_device *device)
{
	const struct lw_controller *controller = &device->controller;
	struct lw_device_seen *seen = &device->seen;

	for (int side = 0; side < 2; side++) {
		if (controller->wiring[side] && !seen->wiring[side]) {
			lw_device_log(
				device,
				side == LW_PLUS ? LW_EVENT_WIRING_PLUS : LW_EVENT_WIRING_MINUS, 0);
		}
		seen->wiring[side] = controller->wiring[side];
		if (controller->switch_check.implausible[side] && !seen->implausible[side]) {
			lw_device_log(device, LW_EVENT_SWITCH_IMPLAUSIBLE, side);
		}
		seen->implausible[side] = controller->switch_check.implausible[side];
	}
	if (controller->speed.at_rest) {
		seen->overspeed = false;
	} else if (!seen->overspeed && lw_device_overspeed(device)) {
		seen->overspeed = true;
		lw_device_log(device, LW_EVENT_OVERSPEED_WARNING, controller->speed.edges_per_s);
	}
	if (controller->odometer_doubtful && !seen->odometer_doubtful) {
		lw_device_log(device, LW_EVENT_ODOMETER_DOUBTFUL, device->odometer_doubtful_edges);
	}
	seen->odometer_doubtful = controller->odometer_doubtful;
	if (device->lock.open != seen->unlocked) {
		seen->unlocked = device->lock.open;
		if (seen->unlocked) {
			seen->unlock_logged = lw_device_log(device, LW_EVENT_LOCK_OPENED, 0);
		} else if (seen->unlock_logged) {
			lw_device_log(device, LW_EVENT_LOCK_CLOSED, 0);
		}
	}
	if (controller->master_lost != seen->master_lost) {
		seen->master_lost = controller->master_lost;
		if (seen->master_lost) {
			seen->master_logged = lw_device_log(device, LW_EVENT_MASTER_LOST, 0);
		} else if (seen->master_logged) {
			lw_device_log(device, LW_EVENT_MASTER_BACK, 0);
		}
	}
}

static void log_line(struct lw_device *device)
{
	const struct lw_slave *slave = &device->slave;
	struct lw_device_seen *seen = &device->seen;

	if (slave->babbles != seen->babbles) {
		seen->babbles = slave->babbles;
		lw_device_log(device, LW_EVENT_LINE_BABBLE, (int32_t)slave->babbles);
	}
	if (slave->babbling) {
		device->babble_told_until_us = device->now_us + LINE_TOLD_US;
	}
	if (slave->echoes != seen->echoes) {
		seen->echoes = slave->echoes;
		if (!lw_device_line_echoes(device)) {
			lw_device_log(device, LW_EVENT_LINE_ECHO, (int32_t)slave->echoes);
		}
		device->echo_told_until_us = device->now_us + LINE_TOLD_US;
	}
}

bool lw_device_line_babbles(const struct lw_device *device)
{
	return device->now_us < device->babble_told_until_us;
}

bool lw_device_line_echoes(const struct lw_device *device)
{
	return device->now_us < device->echo_told_until_us;
}

static void log_state(struct lw_device *device)
{
	const struct lw_controller *controller = &device->controller;
	const struct lw_device_seen before = device->seen;

	device->seen.state = controller->state;
	device->seen.mode = controller->mode;
	device->seen.fault = controller->fault;
	if (controller->mode != before.mode) {
		lw_device_log(device, LW_EVENT_MODE_CHANGED, (int32_t)controller->mode);
	}
	if (before.fault != LW_FAULT_NONE && controller->fault != before.fault) {
		lw_device_log(device, LW_EVENT_FAULT_CLEARED, (int32_t)before.fault);
	}
	if (controller->fault != LW_FAULT_NONE && controller->fault != before.fault) {
		lw_device_log(device, LW_EVENT_FAULT_SET, (int32_t)controller->fault);
	}
	if (before.indexing && controller->indexed) {
		device->seen.indexing = false;
		lw_device_log(device, LW_EVENT_INDEX_DONE,
			      lw_params_q16_to_um(&device->active,
						  (int64_t)controller->homing.span_error_usteps *
							  LW_USTEP));
	} else if (before.indexing && !lw_controller_moving(controller)) {
		device->seen.indexing = false;
		lw_device_log(device, LW_EVENT_INDEX_FAILED, (int32_t)controller->fault);
	}
	if (controller->reacquire.begun != before.reacquires_begun) {
		device->seen.reacquires_begun = controller->reacquire.begun;
		lw_device_log(device, LW_EVENT_REACQUIRE_STARTED,
			      lw_side_direction(controller->reacquire.side));
	}
	if (controller->reacquire.done != before.reacquires_done) {
		device->seen.reacquires_done = controller->reacquire.done;
		lw_device_log(device, LW_EVENT_REACQUIRE_DONE,
			      lw_params_q16_to_um(&device->active,
						  (int64_t)controller->reacquire.shift_usteps *
							  LW_USTEP));
	}
	if (controller->resume.taken_up != before.resumed) {
		device->seen.resumed = controller->resume.taken_up;
		lw_device_log(device, LW_EVENT_RESUMED,
			      lw_params_q16_to_um(&device->active, controller->resume.m));
	}
	if (controller->state == before.state) {
		return;
	}
	if (before.state == LW_STATE_TRACKING) {
		lw_device_log(device, LW_EVENT_TRACKING_ENDED, (int32_t)controller->state);
	} else if (controller->state == LW_STATE_TRACKING) {
		lw_device_log(device, LW_EVENT_TRACKING_STARTED, 0);
	}
}

void lw_device_log_changes(struct lw_device *device)
{
	log_los(device);
	log_rope(device);
	log_inputs(device);
	log_line(device);
	log_state(device);
}

/** Count whole seconds. @return how many have become full */
static uint32_t count_us(uint32_t *part_us, uint64_t elapsed_us)
{
	const uint64_t sum_us = *part_us + elapsed_us;

	*part_us = (uint32_t)(sum_us % 1000000);
	return (uint32_t)(sum_us / 1000000);
}

void lw_budget_pay(struct lw_write_budget *budget, uint64_t now_us)
{
	if (budget->paid_until_us < now_us) {
		budget->paid_until_us = now_us;
	}
	budget->paid_until_us += WRITE_PRICE_US;
}

bool lw_budget_left(const struct lw_write_budget *budget, uint64_t now_us,
		    unsigned int writes_at_once)
{
	return now_us + (uint64_t)(writes_at_once - 1) * WRITE_PRICE_US >= budget->paid_until_us;
}

void lw_device_note_journal(struct lw_device *device)
{
	device->journal_written_us = device->now_us;
	if (all_stored(device->config->store)) {
		device->journal_due_us = UINT64_MAX;
	}
	lw_budget_pay(&device->journal_budget, device->now_us);
}

void lw_device_keep_journal(struct lw_device *device, uint64_t elapsed_us)
{
	const uint64_t now_us = device->now_us;
	struct lw_store *store = device->config->store;
	bool due;

	store->counters.powered_s += count_us(&device->powered_us, elapsed_us);
	if (device->controller.state == LW_STATE_TRACKING) {
		store->counters.tracking_s += count_us(&device->tracking_us, elapsed_us);
	}
	due = now_us >= device->journal_due_us ||
	      now_us >= device->journal_written_us + JOURNAL_HOURS_US;
	store->journal_wanted =
		due && !store->writing &&
		lw_budget_left(&device->journal_budget, now_us, JOURNAL_WRITES_AT_ONCE);
}

bool lw_device_overspeed(const struct lw_device *device)
{
	const int32_t speed = device->controller.speed.edges_per_s;

	return (uint32_t)(speed < 0 ? -speed : speed) >
	       device->active.overspeed_warning_edges_per_s;
}

static uint16_t file_record_count(void *context)
{
	(void)context;
	return LW_LOG_RECORDS * LW_LOG_RECORD_WORDS;
}

static void file_read(void *context, uint16_t first, uint16_t count, uint8_t *out)
{
	const struct lw_device *device = context;
	const struct lw_log *log = &device->config->store->log;
	uint8_t bytes[LW_LOG_RECORD_SIZE];

	for (uint16_t i = 0; i < count; i++) {
		const uint16_t word = (uint16_t)(first + i) % LW_LOG_RECORD_WORDS;

		if (i == 0 || word == 0) {
			lw_log_encode(&log->records[(first + i) / LW_LOG_RECORD_WORDS], bytes);
		}
		out[2 * i] = bytes[2 * word];
		out[2 * i + 1] = bytes[2 * word + 1];
	}
}

struct lw_pdu_file lw_device_log_file(struct lw_device *device)
{
	return (struct lw_pdu_file){
		.number = LW_DEVICE_LOG_FILE,
		.context = device,
		.record_count = file_record_count,
		.read = file_read,
	};
}
