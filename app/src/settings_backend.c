/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Settings in two logs, each one half of the storage partition.
 *
 * A log is a row of entries, one for each save; of a name the last intact entry counts. In force is
 * the log that has the newest entry. When it has no room, the other one is erased, the values are
 * copied there, and behind them goes the value to be saved. Why the power may go at any moment:
 *
 * - An entry that is cut does not have its CRC, and nothing before it is touched. What is not blank
 *   behind the last intact entry closes the log: the next save goes to the other one.
 * - Only the log that is not in force is erased. Whatever an erasure that is cut leaves there, it
 *   is older than the newest entry of the log in force. A copy does not make a log the newest. So
 *   the log in force stays in force until the first entry behind all copies is intact.
 * - A log is erased immediately before it is filled, even if it reads as blank: cells of an erasure
 *   that was cut can read so today and not tomorrow. The same can befall the last word of an entry:
 *   then the value before it counts, which stands in the same log.
 */
#include "settings_backend.h"

#include <errno.h>
#include <string.h>

#include <zephyr/drivers/flash.h>
#include <zephyr/settings/settings.h>
#include <zephyr/storage/flash_map.h>
#include <zephyr/sys/crc.h>

/** What an entry begins with. */
#define SAVED  0x4C577376u
#define COPIED 0xB3A88C89u /**< its complement */

#define BLOCK_SIZE 64

struct head {
	uint32_t kind;
	uint32_t crc;      /**< of all that follows, and of the value; a copy keeps it */
	uint32_t sequence; /**< number of the save */
	uint32_t size;     /**< bytes of the value, which follows; 0: deleted */
	char name[SETTINGS_BACKEND_NAME_SIZE];
};

BUILD_ASSERT(sizeof(struct head) == SETTINGS_BACKEND_ENTRY_SIZE(0), "no room for padding");
BUILD_ASSERT(BLOCK_SIZE % SETTINGS_BACKEND_ALIGN == 0, "an entry is copied in whole units");

struct log {
	off_t start;     /**< in the partition */
	size_t end;      /**< behind the last entry; like all that follows, from the start */
	bool closed;     /**< nothing can be appended */
	uint32_t newest; /**< number of the newest save whose entry is not a copy; 0: none */
	size_t names;
	size_t last[SETTINGS_BACKEND_VALUES_MAX]; /**< where the last entry of each name stands */
};

static const struct flash_area *area;
static struct log in_force;
static uint32_t sequence; /**< of the last save that was tried */
static bool has_erased;

static size_t log_size(void)
{
	return area->fa_size / 2;
}

static int read_log(const struct log *log, size_t at, void *bytes, size_t size)
{
	return flash_area_read(area, log->start + (off_t)at, bytes, size);
}

static int write_log(const struct log *log, size_t at, const void *bytes, size_t size)
{
	return flash_area_write(area, log->start + (off_t)at, bytes, size);
}

static uint32_t head_crc(const struct head *head)
{
	return crc32_ieee((const uint8_t *)&head->sequence,
			  sizeof(*head) - offsetof(struct head, sequence));
}

/**
 * Is there an intact entry?
 *
 * @param head receives its head; otherwise at least the first SETTINGS_BACKEND_ALIGN bytes
 */
static bool intact(const struct log *log, size_t at, struct head *head)
{
	uint8_t block[BLOCK_SIZE];
	uint32_t crc;

	if (read_log(log, at, head, SETTINGS_BACKEND_ALIGN) != 0 ||
	    (head->kind != SAVED && head->kind != COPIED) || log_size() - at < sizeof(*head) ||
	    read_log(log, at, head, sizeof(*head)) != 0 ||
	    head->size > log_size() - at - sizeof(*head) ||
	    head->name[sizeof(head->name) - 1] != '\0') {
		return false;
	}
	crc = head_crc(head);
	at += sizeof(*head);
	for (size_t left = head->size; left > 0;) {
		const size_t count = MIN(left, sizeof(block));

		if (read_log(log, at, block, count) != 0) {
			return false;
		}
		crc = crc32_ieee_update(crc, block, count);
		at += count;
		left -= count;
	}
	return crc == head->crc;
}

/** Index of a name in `last`; `names` if it is not there. */
static size_t find(const struct log *log, const char *name)
{
	size_t i = 0;

	for (; i < log->names; i++) {
		char other[SETTINGS_BACKEND_NAME_SIZE];

		if (read_log(log, log->last[i] + offsetof(struct head, name), other,
			     sizeof(other)) == 0 &&
		    strncmp(other, name, sizeof(other)) == 0) {
			break;
		}
	}
	return i;
}

/** An intact entry stands at the end of the log, or as far as it is known. */
static void take(struct log *log, size_t at, const struct head *head)
{
	const size_t i = find(log, head->name);

	if (i < ARRAY_SIZE(log->last)) {
		log->last[i] = at;
		log->names = MAX(log->names, i + 1);
	}
	if (head->kind == SAVED) {
		log->newest = MAX(log->newest, head->sequence);
	}
	log->end = at + SETTINGS_BACKEND_ENTRY_SIZE(head->size);
}

static void scan(struct log *log, off_t start)
{
	const uint32_t blank = flash_area_erased_val(area) * 0x01010101u;
	struct head head;

	*log = (struct log){.start = start};
	for (size_t at = 0; at < log_size();) {
		if (intact(log, at, &head)) {
			take(log, at, &head);
			at = log->end;
		} else {
			log->closed |= head.kind != blank || head.crc != blank;
			at += SETTINGS_BACKEND_ALIGN;
		}
	}
	/* Who knows how it became blank. */
	log->closed |= log->newest == 0;
}

/** Read back what has been written to the end of the log. */
static int check(struct log *log, int result)
{
	const size_t at = log->end;
	struct head head;

	if (result != 0 || !intact(log, at, &head)) {
		log->closed = true;
		return -EIO;
	}
	take(log, at, &head);
	return 0;
}

static int append(struct log *log, const struct head *head, const char *value)
{
	const size_t whole = ROUND_DOWN(head->size, SETTINGS_BACKEND_ALIGN);
	const size_t at = log->end + sizeof(*head);
	uint8_t rest[SETTINGS_BACKEND_ALIGN];
	int ret;

	if (log->closed || SETTINGS_BACKEND_ENTRY_SIZE(head->size) > log_size() - log->end) {
		return -ENOSPC;
	}
	ret = write_log(log, log->end, head, sizeof(*head));
	if (ret == 0 && whole > 0) {
		ret = write_log(log, at, value, whole);
	}
	if (ret == 0 && head->size > whole) {
		memset(rest, flash_area_erased_val(area), sizeof(rest));
		memcpy(rest, value + whole, head->size - whole);
		ret = write_log(log, at + whole, rest, sizeof(rest));
	}
	return check(log, ret);
}

static int copy(struct log *to, size_t from)
{
	uint8_t block[BLOCK_SIZE];
	struct head head;
	size_t size;
	int ret = 0;

	/* What has become unreadable, or is deleted, is left behind. */
	if (!intact(&in_force, from, &head) || head.size == 0) {
		return 0;
	}
	size = SETTINGS_BACKEND_ENTRY_SIZE(head.size);
	if (size > log_size() - to->end) {
		return -ENOSPC;
	}
	for (size_t done = 0; ret == 0 && done < size; done += sizeof(block)) {
		const size_t count = MIN(size - done, sizeof(block));

		ret = read_log(&in_force, from + done, block, count);
		if (done == 0) {
			memcpy(block, &(uint32_t){COPIED}, sizeof(uint32_t));
		}
		if (ret == 0) {
			ret = write_log(to, to->end + done, block, count);
		}
	}
	return check(to, ret);
}

bool settings_backend_has_erased(void)
{
	const bool had = has_erased;

	has_erased = false;
	return had;
}

/** Erase a log, and look whether it is blank: not every driver knows that its erasure failed. */
static int erase(const struct log *log)
{
	const uint8_t blank = flash_area_erased_val(area);
	uint8_t block[BLOCK_SIZE];
	int ret = flash_area_flatten(area, log->start, log_size());

	has_erased = true;

	for (size_t at = 0; ret == 0 && at < log_size(); at += sizeof(block)) {
		ret = read_log(log, at, block, sizeof(block));
		for (size_t i = 0; i < sizeof(block); i++) {
			ret = block[i] == blank ? ret : -EIO;
		}
	}
	return ret;
}

/** Begin the other log with copies of all values. It is not in force yet. */
static int begin_other(struct log *other)
{
	int ret;

	*other = (struct log){.start = (off_t)log_size() - in_force.start};
	ret = erase(other);
	for (size_t i = 0; ret == 0 && i < in_force.names; i++) {
		ret = copy(other, in_force.last[i]);
	}
	return ret;
}

static int save(struct settings_store *store, const char *name, const char *value, size_t size)
{
	struct head head = {.kind = SAVED, .size = size};
	struct log other;
	int ret;

	ARG_UNUSED(store);
	if (strlen(name) >= sizeof(head.name)) {
		return -ENAMETOOLONG;
	}
	if (size > log_size() || find(&in_force, name) == ARRAY_SIZE(in_force.last)) {
		return -ENOSPC;
	}
	strcpy(head.name, name);
	head.sequence = ++sequence;
	head.crc = crc32_ieee_update(head_crc(&head), (const uint8_t *)value, size);
	ret = append(&in_force, &head, value);
	if (ret == 0) {
		return 0;
	}
	ret = begin_other(&other);
	if (ret == 0) {
		ret = append(&other, &head, value);
	}
	if (ret == 0) {
		in_force = other;
	}
	return ret;
}

struct value {
	size_t at;
	size_t size;
};

static ssize_t read_value(void *context, void *bytes, size_t size)
{
	const struct value *value = context;
	const size_t count = MIN(size, value->size);
	const int ret = read_log(&in_force, value->at, bytes, count);

	return ret ? ret : (ssize_t)count;
}

static int load(struct settings_store *store, const struct settings_load_arg *arg)
{
	ARG_UNUSED(store);
	for (size_t i = 0; i < in_force.names; i++) {
		struct head head;
		struct value value;

		if (read_log(&in_force, in_force.last[i], &head, sizeof(head)) != 0 ||
		    head.size == 0) {
			continue;
		}
		value = (struct value){in_force.last[i] + sizeof(head), head.size};
		(void)settings_call_set_handler(head.name, value.size, read_value, &value, arg);
	}
	return 0;
}

/** Called by settings_subsys_init(). */
int settings_backend_init(void)
{
	static const struct settings_store_itf interface = {.csi_load = load, .csi_save = save};
	static struct settings_store store = {.cs_itf = &interface};
	struct flash_pages_info page;
	struct log second;
	int ret = flash_area_open(FIXED_PARTITION_ID(storage_partition), &area);

	if (ret == 0) {
		ret = flash_get_page_info_by_offs(flash_area_get_device(area),
						  area->fa_off + (off_t)log_size(), &page);
	}
	if (ret != 0) {
		return ret;
	}
	if (page.start_offset != area->fa_off + (off_t)log_size() || log_size() % BLOCK_SIZE != 0 ||
	    SETTINGS_BACKEND_ALIGN % flash_area_align(area) != 0) {
		return -ENOTSUP;
	}
	scan(&in_force, 0);
	scan(&second, (off_t)log_size());
	if (second.newest > in_force.newest) {
		in_force = second;
	}
	sequence = in_force.newest;
	settings_src_register(&store);
	settings_dst_register(&store);
	return 0;
}
