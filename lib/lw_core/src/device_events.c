/*
 * The journal: what goes into the event log, the hours, and when both are stored.
 */
#include "device_internal.h"

/** From an event to its write: what belongs together is written together. */
#define JOURNAL_SETTLE_US 2000000u

/** Mean time between two writes, at least: the flash lives for a limited number of them. */
#define JOURNAL_PRICE_US 60000000u

/** Ten writes may come at once: what happens before a power cut shall not wait. */
#define JOURNAL_CREDIT_US (9u * JOURNAL_PRICE_US)

/** From one write to the next that only keeps the hours. */
#define JOURNAL_HOURS_US 900000000u

static bool all_stored(const struct lw_store *store)
{
	return store->log.newest == store->log_stored;
}

void lw_device_log(struct lw_device *device, enum lw_event event, int32_t detail)
{
	const struct lw_controller *controller = &device->controller;
	const struct lw_motion_reading reading = lw_motion_read(&controller->motion);
	struct lw_store *store = device->config->store;

	if (all_stored(store)) {
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

void lw_device_log_power_up(struct lw_device *device)
{
	struct lw_store *store = device->config->store;

	device->seen = (struct lw_device_seen){
		.state = device->controller.state,
		.mode = device->controller.mode,
		.fault = device->controller.fault,
	};
	store->counters.boots++;
	lw_device_log(device, LW_EVENT_POWER_UP,
		      LW_VERSION_MAJOR * 10000 + LW_VERSION_MINOR * 100 + LW_VERSION_PATCH);
	if (device->config->watchdog_reset) {
		store->counters.watchdog_resets++;
		lw_device_log(device, LW_EVENT_WATCHDOG_RESET, 0);
	}
	log_slots(device);
	if (!lw_store_has_params(store)) {
		lw_device_log(device, LW_EVENT_DEFAULTS_LOADED, 0);
	}
}

static void log_los(struct lw_device *device)
{
	static const enum lw_event events[] = {LW_EVENT_LOS1_PLUS, LW_EVENT_LOS1_MINUS,
					       LW_EVENT_LOS2_PLUS, LW_EVENT_LOS2_MINUS};
	const struct lw_controller *controller = &device->controller;
	const uint16_t counts[] = {
		controller->los1[LW_PLUS].count, controller->los1[LW_MINUS].count,
		controller->los2[LW_PLUS].count, controller->los2[LW_MINUS].count};

	for (size_t i = 0; i < sizeof(counts) / sizeof(counts[0]); i++) {
		if (counts[i] != device->seen.los_count[i]) {
			device->seen.los_count[i] = counts[i];
			lw_device_log(device, events[i], counts[i]);
		}
	}
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
	}
	if (controller->drum_at_rest) {
		seen->overspeed = false;
	} else if (!seen->overspeed && lw_device_overspeed(device)) {
		seen->overspeed = true;
		lw_device_log(device, LW_EVENT_OVERSPEED_WARNING,
			      controller->drum_speed_edges_per_s);
	}
	if (device->lock.open != seen->unlocked) {
		seen->unlocked = device->lock.open;
		lw_device_log(device, seen->unlocked ? LW_EVENT_LOCK_OPENED : LW_EVENT_LOCK_CLOSED,
			      0);
	}
	if (controller->master_lost != seen->master_lost) {
		seen->master_lost = controller->master_lost;
		lw_device_log(device,
			      seen->master_lost ? LW_EVENT_MASTER_LOST : LW_EVENT_MASTER_BACK, 0);
	}
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
		lw_device_log(
			device, LW_EVENT_INDEX_DONE,
			lw_params_q16_to_um(&device->active,
					    (int64_t)controller->span_error_usteps * LW_USTEP));
	} else if (before.indexing && !lw_controller_moving(controller)) {
		device->seen.indexing = false;
		lw_device_log(device, LW_EVENT_INDEX_FAILED, (int32_t)controller->fault);
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
	log_inputs(device);
	log_state(device);
}

/** Count whole seconds. @return how many have become full */
static uint32_t count_us(uint32_t *part_us, uint64_t elapsed_us)
{
	const uint64_t sum_us = *part_us + elapsed_us;

	*part_us = (uint32_t)(sum_us % 1000000);
	return (uint32_t)(sum_us / 1000000);
}

void lw_device_note_journal(struct lw_device *device)
{
	device->journal_written_us = device->now_us;
	if (device->journal_paid_until_us < device->now_us) {
		device->journal_paid_until_us = device->now_us;
	}
	device->journal_paid_until_us += JOURNAL_PRICE_US;
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
	due = !all_stored(store) && now_us >= device->journal_due_us;
	due = due || now_us >= device->journal_written_us + JOURNAL_HOURS_US;
	store->journal_wanted = due && !store->writing &&
				now_us + JOURNAL_CREDIT_US >= device->journal_paid_until_us;
}

bool lw_device_overspeed(const struct lw_device *device)
{
	const int32_t speed = device->controller.drum_speed_edges_per_s;

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
