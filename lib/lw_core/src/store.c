#include "lw/store.h"

#include <errno.h>

#include "big_endian.h"
#include "lw/params.h"

#define JOURNAL_KIND   "LWJL"
#define JOURNAL_SCHEMA 1
#define CAM_KIND       "LWCM"
#define CAM_SCHEMA     1
#define COUNTERS_SIZE  16

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

void lw_store_load(struct lw_store *store, unsigned int slot, const uint8_t *bytes, size_t size)
{
	struct lw_store_pair *pair = &store->pairs[slot / 2];
	const bool is_params = slot < LW_STORE_JOURNAL;
	const bool is_cam = slot >= LW_STORE_CAM;
	struct lw_params params;
	struct lw_record record = {0};
	const int ret =
		is_params ? open_params(bytes, size, &params, &record)
		: is_cam  ? open_cam(bytes, size, &store->cam_banks[slot - LW_STORE_CAM], &record)
			  : open_journal(bytes, size, &record);

	pair->state[slot % 2] =
		slot_state(ret, !is_params || record.schema == LW_PARAM_RECORD_SCHEMA);
	if (ret == -ENODATA || ret == -EBADMSG) {
		return;
	}
	if (!pair->intact || newer(record.sequence, pair->newest_sequence)) {
		pair->intact = true;
		pair->newest = slot % 2;
		pair->newest_sequence = record.sequence;
	}
	if (ret != 0 || (pair->used && !newer(record.sequence, pair->used_sequence))) {
		return;
	}
	pair->used = true;
	pair->used_schema = record.schema;
	pair->used_sequence = record.sequence;
	if (is_params) {
		store->params = params;
	} else if (!is_cam) {
		take_journal(store, &record);
	}
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
	const bool is_params = store->params_wanted;
	const struct lw_cam_bank *cam = store->cam_wanted;
	const unsigned int first = is_params     ? LW_STORE_PARAMS
				   : cam != NULL ? LW_STORE_CAM
						 : LW_STORE_JOURNAL;
	const struct lw_store_pair *pair = &store->pairs[first / 2];

	if (store->writing || !(is_params || cam != NULL || store->journal_wanted)) {
		return 0;
	}
	*slot = first + (pair->intact && pair->newest == 0 ? 1 : 0);
	store->writing = true;
	store->writing_slot = (uint8_t)*slot;
	if (is_params) {
		store->params_wanted = false;
		return lw_param_record_encode(&store->saving, next_sequence(pair), bytes);
	}
	if (cam != NULL) {
		store->cam_wanted = NULL;
		return encode_cam(cam, next_sequence(pair), bytes);
	}
	store->journal_wanted = false;
	return encode_journal(store, next_sequence(pair), bytes);
}

void lw_store_end_write(struct lw_store *store, int result)
{
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
	if (store->writing_slot < LW_STORE_JOURNAL) {
		pair->used_schema = LW_PARAM_RECORD_SCHEMA;
		store->params = store->saving;
	} else if (store->writing_slot >= LW_STORE_CAM) {
		pair->used_schema = CAM_SCHEMA;
	} else {
		pair->used_schema = JOURNAL_SCHEMA;
		store->log_stored = store->log_writing;
	}
}
