/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/storage/store.h"

#include <errno.h>

#include "lw/bytes/big_endian.h"
#include "lw/control/params.h"

#define JOURNAL_KIND   "LWJL"
#define JOURNAL_SCHEMA 1
#define CAM_KIND       "LWCM"
#define CAM_SCHEMA     1
#define COUNTERS_SIZE  16

/** What a slot holds. */
struct lw_slot_content {
	struct lw_record record;
	union {
		struct lw_params params;
		struct lw_look look;
	};
};

void lw_store_init(struct lw_store *store)
{
	*store = (struct lw_store){.params = lw_params_default};
}

static bool newer(uint32_t sequence, uint32_t than)
{
	return (int32_t)(sequence - than) > 0;
}

static int open_params(const uint8_t *bytes, size_t size, struct lw_params *params,
		       struct lw_record *record)
{
	struct lw_derived derived;
	struct lw_refusal why;
	const int ret = lw_param_record_decode(bytes, size, params, record);

	return ret ? ret : lw_params_derive(params, &derived, &why);
}

static int open_journal(const uint8_t *bytes, size_t size, struct lw_record *record)
{
	const int ret = lw_record_open(bytes, size, JOURNAL_KIND, record);

	if (ret) {
		return ret;
	}
	if (record->schema != JOURNAL_SCHEMA) {
		return -ENOTSUP;
	}
	return record->length >= COUNTERS_SIZE &&
			       (record->length - COUNTERS_SIZE) % LW_LOG_RECORD_SIZE == 0
		       ? 0
		       : -EINVAL;
}

/** Read a table into an empty bank, which stays empty on any error. */
static int open_cam(const uint8_t *bytes, size_t size, struct lw_cam_bank *bank,
		    struct lw_record *record)
{
	const int ret = lw_record_open(bytes, size, CAM_KIND, record);

	if (ret) {
		return ret;
	}
	if (record->schema != CAM_SCHEMA) {
		return -ENOTSUP;
	}
	if (record->length > 2 * LW_CAM_WORDS) {
		return -EINVAL;
	}
	for (size_t i = 0; i < record->length / 2; i++) {
		lw_cam_bank_put(bank, (unsigned int)i, lw_get16(record->payload + 2 * i));
	}
	if (record->length != 2 * (size_t)lw_cam_bank_words(bank) ||
	    lw_cam_bank_crc(bank) != bank->crc) {
		*bank = (struct lw_cam_bank){.state = LW_CAM_BANK_STATE_EMPTY};
		return -EINVAL;
	}
	bank->state = LW_CAM_BANK_STATE_READY;
	return 0;
}

static void take_journal(struct lw_store *store, const struct lw_record *record)
{
	const uint8_t *payload = record->payload;

	store->counters = (struct lw_counters){
		.boots = lw_get32(payload),
		.watchdog_resets = lw_get32(payload + 4),
		.powered_s = lw_get32(payload + 8),
		.tracking_s = lw_get32(payload + 12),
	};
	store->log = (struct lw_log){0};
	for (size_t at = COUNTERS_SIZE; at < record->length; at += LW_LOG_RECORD_SIZE) {
		const struct lw_log_record event = lw_log_decode(payload + at);

		store->log.records[event.sequence % LW_LOG_RECORDS] = event;
		if (event.sequence > store->log.newest) {
			store->log.newest = event.sequence;
		}
	}
	store->log_stored = store->log.newest;
}

static enum lw_slot_state slot_state(int result, bool current)
{
	switch (result) {
	case 0:
		return current ? LW_SLOT_STATE_GOOD : LW_SLOT_STATE_OLDER;
	case -ENODATA:
		return LW_SLOT_STATE_EMPTY;
	case -ENOTSUP:
		return LW_SLOT_STATE_NEWER;
	case -EINVAL:
		return LW_SLOT_STATE_REFUSED;
	default:
		return LW_SLOT_STATE_DAMAGED;
	}
}

/** Read a record of the pair that the slot belongs to; what is newest of it is not decided here. */
static int open_slot(struct lw_store *store, unsigned int slot, const uint8_t *bytes, size_t size,
		     struct lw_slot_content *content)
{
	switch (slot - slot % 2) {
	case LW_STORE_PARAMS:
		return open_params(bytes, size, &content->params, &content->record);
	case LW_STORE_CAM:
		return open_cam(bytes, size, &store->cam_banks[slot - LW_STORE_CAM],
				&content->record);
	case LW_STORE_LOOK:
		return lw_look_record_decode(bytes, size, &content->look, &content->record);
	default:
		return open_journal(bytes, size, &content->record);
	}
}

/** Use a good record, the newest of its pair so far. */
static void use(struct lw_store *store, unsigned int slot, const struct lw_slot_content *content)
{
	switch (slot - slot % 2) {
	case LW_STORE_PARAMS:
		store->params = content->params;
		break;
	case LW_STORE_JOURNAL:
		take_journal(store, &content->record);
		break;
	case LW_STORE_LOOK:
		store->look = content->look;
		break;
	default:
		break; /* a cam table stands in its bank already */
	}
}

void lw_store_load(struct lw_store *store, unsigned int slot, const uint8_t *bytes, size_t size)
{
	struct lw_store_pair *pair = &store->pairs[slot / 2];
	struct lw_slot_content content = {0};
	const struct lw_record *record = &content.record;
	const int ret = open_slot(store, slot, bytes, size, &content);

	pair->state[slot % 2] = slot_state(ret, slot >= LW_STORE_JOURNAL ||
							record->schema == LW_PARAM_RECORD_SCHEMA);
	if (ret == -ENODATA || ret == -EBADMSG) {
		return;
	}
	if (!pair->intact || newer(record->sequence, pair->newest_sequence)) {
		pair->intact = true;
		pair->newest = slot % 2;
		pair->newest_sequence = record->sequence;
	}
	if (ret != 0 || (pair->used && !newer(record->sequence, pair->used_sequence))) {
		return;
	}
	pair->used = true;
	pair->used_schema = record->schema;
	pair->used_sequence = record->sequence;
	use(store, slot, &content);
}

bool lw_store_has_params(const struct lw_store *store)
{
	return store->pairs[LW_STORE_PARAMS / 2].used;
}

void lw_store_save(struct lw_store *store, const struct lw_params *params)
{
	store->saving = *params;
	store->params_wanted = true;
}

bool lw_store_saving(const struct lw_store *store)
{
	return store->params_wanted || (store->writing && store->writing_slot < LW_STORE_JOURNAL);
}

int lw_store_cam_bank(const struct lw_store *store)
{
	const struct lw_store_pair *pair = &store->pairs[LW_STORE_CAM / 2];

	if (!pair->used) {
		return -1;
	}
	/* The newest intact one may be of newer firmware; then the other one was used. */
	return pair->state[pair->newest] == LW_SLOT_STATE_GOOD ? pair->newest : 1 - pair->newest;
}

void lw_store_save_cam(struct lw_store *store, const struct lw_cam_bank *bank)
{
	store->cam_wanted = bank;
}

void lw_store_save_look(struct lw_store *store, const struct lw_look *look)
{
	store->look_next = *look;
	store->look_wanted = true;
}

static size_t encode_cam(const struct lw_cam_bank *bank, uint32_t sequence, uint8_t *bytes)
{
	const unsigned int words = lw_cam_bank_words(bank);
	uint8_t *at = bytes + LW_RECORD_HEAD_SIZE;

	for (unsigned int i = 0; i < words; i++) {
		at = lw_put16(at, lw_cam_bank_get(bank, i));
	}
	return lw_record_seal(bytes, CAM_KIND, CAM_SCHEMA, sequence, 2 * words);
}

static size_t encode_journal(struct lw_store *store, uint32_t sequence, uint8_t *bytes)
{
	uint8_t *at = bytes + LW_RECORD_HEAD_SIZE;

	at = lw_put32(at, store->counters.boots);
	at = lw_put32(at, store->counters.watchdog_resets);
	at = lw_put32(at, store->counters.powered_s);
	at = lw_put32(at, store->counters.tracking_s);
	for (size_t i = 0; i < LW_LOG_RECORDS; i++) {
		if (store->log.records[i].sequence != 0) {
			lw_log_encode(&store->log.records[i], at);
			at += LW_LOG_RECORD_SIZE;
		}
	}
	store->log_writing = store->log.newest;
	return lw_record_seal(bytes, JOURNAL_KIND, JOURNAL_SCHEMA, sequence,
			      (size_t)(at - bytes) - LW_RECORD_HEAD_SIZE);
}

/** The sequence number of the next record of a pair. */
static uint32_t next_sequence(const struct lw_store_pair *pair)
{
	return pair->intact ? pair->newest_sequence + 1 : 1;
}

size_t lw_store_begin_write(struct lw_store *store, unsigned int *slot,
			    uint8_t bytes[LW_STORE_SLOT_SIZE])
{
	const struct lw_cam_bank *cam = store->cam_wanted;
	const unsigned int first = store->look_wanted     ? LW_STORE_LOOK
				   : store->params_wanted ? LW_STORE_PARAMS
				   : cam != NULL          ? LW_STORE_CAM
							  : LW_STORE_JOURNAL;
	const struct lw_store_pair *pair = &store->pairs[first / 2];

	if (store->writing || (first == LW_STORE_JOURNAL && !store->journal_wanted)) {
		return 0;
	}
	*slot = first + (pair->intact && pair->newest == 0 ? 1 : 0);
	store->writing = true;
	store->writing_slot = (uint8_t)*slot;
	switch (first) {
	case LW_STORE_LOOK:
		store->look_wanted = false;
		return lw_look_record_encode(&store->look_next, next_sequence(pair), bytes);
	case LW_STORE_PARAMS:
		store->params_wanted = false;
		return lw_param_record_encode(&store->saving, next_sequence(pair), bytes);
	case LW_STORE_CAM:
		store->cam_wanted = NULL;
		return encode_cam(cam, next_sequence(pair), bytes);
	default:
		store->journal_wanted = false;
		return encode_journal(store, next_sequence(pair), bytes);
	}
}

void lw_store_end_write(struct lw_store *store, int result)
{
	static const uint16_t schemas[LW_STORE_SLOTS / 2] = {LW_PARAM_RECORD_SCHEMA, JOURNAL_SCHEMA,
							     CAM_SCHEMA, LW_LOOK_RECORD_SCHEMA};
	struct lw_store_pair *pair = &store->pairs[store->writing_slot / 2];
	const uint8_t side = store->writing_slot % 2;

	if (!store->writing) {
		return;
	}
	store->writing = false;
	if (result) {
		pair->state[side] = LW_SLOT_STATE_DAMAGED;
		return;
	}
	pair->newest_sequence = next_sequence(pair);
	pair->newest = side;
	pair->intact = true;
	pair->state[side] = LW_SLOT_STATE_GOOD;
	pair->used = true;
	pair->used_sequence = pair->newest_sequence;
	pair->used_schema = schemas[store->writing_slot / 2];
	switch (store->writing_slot - side) {
	case LW_STORE_PARAMS:
		store->params = store->saving;
		break;
	case LW_STORE_JOURNAL:
		store->log_stored = store->log_writing;
		break;
	case LW_STORE_LOOK:
		store->look = store->look_next;
		break;
	default:
		break;
	}
}
