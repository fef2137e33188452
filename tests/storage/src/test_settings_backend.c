/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Whatever happens to the power, each value is the one that was saved last; the one that was being
 * saved may be the one before.
 */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include <zephyr/settings/settings.h>
#include <zephyr/ztest.h>

#include "cut_flash.h"
#include "settings_backend.h"

#define TREE       "test"
#define NAMES      6
#define VALUE_SIZE 400 /**< the longest, in bytes */
#define SAVES      45
#define PARTITION  0x1000

struct value {
	size_t size; /**< 0: there is none */
	uint8_t bytes[VALUE_SIZE];
};

struct values {
	struct value of[NAMES];
};

extern bool settings_subsys_initialized;

static struct values loaded;

static const char *name_of(unsigned int number)
{
	static char name[16];

	(void)snprintf(name, sizeof(name), TREE "/%u", number);
	return name;
}

static int load_one(const char *key, size_t size, settings_read_cb read, void *context, void *param)
{
	struct value *value = &loaded.of[key[0] - '0'];

	ARG_UNUSED(param);
	zassert_true(key[0] >= '0' && key[0] < '0' + NAMES && key[1] == '\0', "name %s", key);
	zassert_equal(value->size, 0, "%s is there twice", key);
	zassert_true(size > 0 && size <= sizeof(value->bytes), "%s has %zu bytes", key, size);
	zassert_equal(read(context, value->bytes, sizeof(value->bytes)), (ssize_t)size);
	value->size = size;
	return 0;
}

static void load(void)
{
	memset(&loaded, 0, sizeof(loaded));
	zassert_ok(settings_load_subtree_direct(TREE, load_one, NULL));
}

static void power_up(void)
{
	cut_flash_power_up();
	settings_subsys_initialized = false;
	zassert_ok(settings_subsys_init());
}

static bool equal(const struct value *a, const struct value *b)
{
	return a->size == b->size && memcmp(a->bytes, b->bytes, a->size) == 0;
}

/** All values are what they must be; that of `number` may be another one, which is taken over. */
static void expect(struct values *values, unsigned int number, const struct value *other)
{
	load();
	for (unsigned int i = 0; i < NAMES; i++) {
		if (i == number && other != NULL && equal(&loaded.of[i], other)) {
			values->of[i] = *other;
		}
		zassert_true(equal(&loaded.of[i], &values->of[i]),
			     "value %u has %zu bytes, not %zu", i, loaded.of[i].size,
			     values->of[i].size);
	}
}

static int save(unsigned int number, const struct value *value)
{
	return settings_save_one(name_of(number), value->bytes, value->size);
}

static struct value random_value(void)
{
	struct value value = {.size = 1 + cut_flash_random() % VALUE_SIZE};

	for (size_t i = 0; i < value.size; i++) {
		value.bytes[i] = (uint8_t)cut_flash_random();
	}
	return value;
}

static void save_to(struct values *values, unsigned int number)
{
	const struct value value = random_value();

	zassert_ok(save(number, &value));
	values->of[number] = value;
}

static void save_any(struct values *values)
{
	save_to(values, cut_flash_random() % NAMES);
}

/** The next saves, one of them cut too; and one more that is not. */
static void go_on(struct values values)
{
	const struct value value = random_value();
	const unsigned int number = cut_flash_random() % NAMES;

	/* A save is up to 120 operations, one that changes the log 900. */
	cut_flash_at(cut_flash_random() % (cut_flash_random() % 2 ? 120 : 900),
		     (enum cut)(cut_flash_random() % CUTS),
		     cut_flash_random() % 4 == 0 ? CUT_ERROR : CUT_POWER);
	if (save(number, &value) == 0) {
		values.of[number] = value;
		expect(&values, 0, NULL);
	}
	power_up();
	expect(&values, number, &value);
	save_any(&values);
	zassert_equal(cut_flash_overwrites, 0);
	expect(&values, 0, NULL);
	power_up();
	expect(&values, 0, NULL);
}

static void before(void *fixture)
{
	ARG_UNUSED(fixture);
	memset(cut_flash, 0xFF, sizeof(cut_flash));
	memset(cut_flash, 0xA5, PARTITION);
	power_up();
}

static void after(void *fixture)
{
	ARG_UNUSED(fixture);
	for (size_t i = 0; i < PARTITION; i++) {
		zassert_equal(cut_flash[i], 0xA5, "written outside of the partition");
	}
}

ZTEST_SUITE(settings_backend, NULL, NULL, before, after, NULL);

static void every_operation(enum cut_effect effect)
{
	static uint8_t flash[CUT_FLASH_SIZE];
	struct values values = {0};
	unsigned int cuts = 0;
	unsigned int erasures = 0;

	for (unsigned int i = 0; i < SAVES; i++) {
		const unsigned int number = cut_flash_random() % NAMES;
		const struct value value = random_value();
		unsigned int operations;

		memcpy(flash, cut_flash, sizeof(flash));
		power_up();
		zassert_ok(save(number, &value));
		operations = cut_flash_operations;
		zassert_true(cut_flash_erasures <= 1, "a save may erase once");
		/* The erasure, if there is one, is the first operation. */
		for (unsigned int cut = 0; cut < operations * 3 + CUTS * 10; cut++) {
			const bool at_erasure = cut >= operations * 3;
			struct values then = values;

			memcpy(cut_flash, flash, sizeof(flash));
			power_up();
			cut_flash_at(at_erasure ? 0 : cut / 3,
				     (enum cut)(cut % (at_erasure ? CUTS : 3)), effect);
			if (save(number, &value) == 0) {
				zassert_not_equal(effect, CUT_POWER, "saved without power");
				then.of[number] = value;
			}
			zassert_equal(cut_flash_overwrites, 0);
			if (effect != CUT_POWER) {
				expect(&then, 0, NULL);
			}
			if (effect == CUT_POWER || cut % 2 == 0) {
				power_up();
			}
			expect(&then, number, &value);
			go_on(then);
			cuts++;
		}
		memcpy(cut_flash, flash, sizeof(flash));
		power_up();
		zassert_ok(save(number, &value));
		erasures += cut_flash_erasures;
		values.of[number] = value;
		expect(&values, 0, NULL);
	}
	printk("%u cuts, %u changes of the log\n", cuts, erasures);
	zassert_true(erasures >= 4, "the logs were not filled often enough: %u", erasures);
}

ZTEST(settings_backend, test_cut_at_every_operation)
{
	every_operation(CUT_POWER);
}

ZTEST(settings_backend, test_error_of_every_operation)
{
	every_operation(CUT_ERROR);
}

ZTEST(settings_backend, test_silent_failure_of_every_operation)
{
	every_operation(CUT_SILENT);
}

/** The flash fails for a while, the firmware goes on. */
ZTEST(settings_backend, test_flash_that_comes_back)
{
	struct values values = {0};

	for (unsigned int i = 0; i < SAVES; i++) {
		const struct value value = random_value();

		save_any(&values);
		cut_flash_at(cut_flash_random() % 20, CUT_PARTLY, CUT_POWER);
		if (save(0, &value) == 0) {
			values.of[0] = value;
		}
		cut_flash_power_up();
		expect(&values, 0, NULL);
		save_any(&values);
		zassert_equal(cut_flash_overwrites, 0);
		power_up();
		expect(&values, 0, NULL);
	}
}

/** Whatever stands in the flash at first: nothing is found, and the first save is kept. */
ZTEST(settings_backend, test_unknown_contents)
{
	static const int fills[] = {0xFF, 0x00, 0x76, -1};

	for (unsigned int i = 0; i < ARRAY_SIZE(fills) * ARRAY_SIZE(fills); i++) {
		struct values values = {0};

		for (size_t at = PARTITION; at < sizeof(cut_flash); at++) {
			const int fill =
				at < PARTITION + CUT_FLASH_PAGE_SIZE ? fills[i % 4] : fills[i / 4];

			cut_flash[at] = fill < 0 ? (uint8_t)cut_flash_random() : (uint8_t)fill;
		}
		power_up();
		expect(&values, 0, NULL);
		save_any(&values);
		zassert_equal(cut_flash_erasures, 1);
		save_any(&values);
		zassert_equal(cut_flash_erasures, 1);
		power_up();
		expect(&values, 0, NULL);
	}
}

/** A byte that is damaged costs one value at most, and that one becomes an older one of its own. */
ZTEST(settings_backend, test_every_byte_damaged)
{
	static struct values history[SAVES];
	static uint8_t flash[CUT_FLASH_SIZE];
	struct values values = {0};
	unsigned int count = 0;

	while (count < SAVES) {
		if (count < NAMES) {
			save_to(&values, count);
		} else {
			save_any(&values);
		}
		history[count++] = values;
		memcpy(flash, cut_flash, sizeof(flash));
		for (size_t at = PARTITION; at < sizeof(flash);
		     at += 1 + cut_flash_random() % 200) {
			unsigned int others = 0;

			cut_flash[at] ^= (uint8_t)(1u << cut_flash_random() % 8);
			power_up();
			load();
			for (unsigned int i = 0; i < NAMES; i++) {
				bool known = loaded.of[i].size == 0;

				others += !equal(&loaded.of[i], &values.of[i]);
				for (unsigned int j = 0; j < count; j++) {
					known |= equal(&loaded.of[i], &history[j].of[i]);
				}
				zassert_true(known, "value %u was never saved", i);
			}
			zassert_true(others <= 1, "%u values lost by byte %zu", others, at);
			cut_flash[at] = flash[at];
		}
		power_up();
	}
}

ZTEST(settings_backend, test_refuses_what_has_no_room)
{
	static char longest[CUT_FLASH_PAGE_SIZE + 1];
	static const char *const long_name = TREE "/56789012345678901234";

	zassert_equal(strlen(long_name), SETTINGS_BACKEND_NAME_SIZE + 1);
	zassert_equal(settings_save_one(long_name, "a", 1), -ENAMETOOLONG);
	zassert_equal(settings_save_one(long_name + 1, "a", 1), -ENAMETOOLONG);
	zassert_ok(settings_save_one(long_name + 2, "a", 1));
	zassert_equal(settings_save_one(TREE "/0", longest, sizeof(longest)), -ENOSPC);
	for (unsigned int i = 1; i < SETTINGS_BACKEND_VALUES_MAX; i++) {
		zassert_ok(settings_save_one(name_of(i), "b", 1));
	}
	zassert_equal(settings_save_one(TREE "/0", "c", 1), -ENOSPC);
	zassert_ok(settings_save_one(TREE "/1", "d", 1));
}

ZTEST(settings_backend, test_deletes)
{
	struct values values = {0};

	save_to(&values, 0);
	save_to(&values, 1);
	zassert_ok(settings_delete(TREE "/0"));
	values.of[0].size = 0;
	expect(&values, 0, NULL);
	while (cut_flash_erasures < 3) {
		save_to(&values, 1);
		expect(&values, 0, NULL);
	}
	power_up();
	expect(&values, 0, NULL);
}
