/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Every address with every count that the map accepts, reading and writing. Only these two decide
 * where the bank goes, so with the sanitizers this is the proof by exhaustion that it stays in its
 * tables, in the values behind them and in the buffers of the request.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include <unity.h>

#include "lw/modbus/bank.h"
#include "lw/map.h"

#define REGISTERS_MAX 125u
#define BITS_MAX      2000u
#define ADDRESSES     65536u

#define SECTION(space_, name, offset_)                                                             \
	{                                                                                          \
		.space = space_, .points = lw_map_##name,                                          \
		.point_count = sizeof(lw_map_##name) / sizeof(lw_map_##name[0]),                   \
		.address_offset = offset_, .image = image,                                         \
	}

static const void *image(void *context)
{
	return context;
}

static struct lw_bank_section sections[] = {
	SECTION(LW_SPACE_COIL, coils, 0),
	SECTION(LW_SPACE_DISCRETE, discretes, 0),
	{.space = LW_SPACE_DISCRETE,
	 .points = &lw_map_discretes[32],
	 .point_count = LW_MAP_DISCRETES_COUNT - 32,
	 .image = image},
	SECTION(LW_SPACE_HOLDING, setpoints, 0),
	SECTION(LW_SPACE_HOLDING, params, 0),
	SECTION(LW_SPACE_HOLDING, bench, 0),
	SECTION(LW_SPACE_HOLDING, cam_upload, 0),
	SECTION(LW_SPACE_INPUT, status, 0),
	SECTION(LW_SPACE_INPUT, params, LW_MAP_ACTIVE_ADDRESS_OFFSET),
	SECTION(LW_SPACE_INPUT, params, LW_MAP_STORED_ADDRESS_OFFSET),
};

#define SECTION_COUNT (sizeof(sections) / sizeof(sections[0]))

static const struct lw_bank bank = {.sections = sections, .section_count = SECTION_COUNT};

/** Bytes behind each section, to the byte: the sanitizer watches their end. */
static const size_t image_sizes[SECTION_COUNT] = {
	sizeof(uint32_t),
	sizeof(uint32_t),
	sizeof(uint32_t),
	sizeof(struct lw_setpoints),
	sizeof(struct lw_params),
	sizeof(struct lw_bench),
	sizeof(struct lw_cam_upload),
	sizeof(struct lw_status),
	sizeof(struct lw_params),
	sizeof(struct lw_params),
};

/** What the tables say of an address, read off them in the plainest way. */
struct entry {
	bool known;
	bool writable;
	uint8_t part;
	uint8_t part_count;
};

static struct entry entries[4][ADDRESSES];

static int allow(void *context, const struct lw_point *point, uint16_t element, int32_t value,
		 struct lw_refusal *why)
{
	(void)context;
	(void)point;
	(void)element;
	(void)value;
	(void)why;
	return 0;
}

static void store(void *context, const struct lw_point *point, uint16_t element, int32_t value)
{
	memcpy((char *)context + point->offset + 4 * element, &value, sizeof(value));
}

static void store_bit(void *context, const struct lw_point *point, uint16_t element, int32_t value)
{
	uint32_t *bits = context;
	const uint32_t mask = 1u << (point->offset + element);

	*bits = value != 0 ? *bits | mask : *bits & ~mask;
}

static uint8_t width(const struct lw_point *point)
{
	return point->type == LW_TYPE_I64                                 ? 4
	       : point->type == LW_TYPE_U32 || point->type == LW_TYPE_I32 ? 2
									  : 1;
}

void setUp(void)
{
	memset(entries, 0, sizeof(entries));
	for (size_t i = 0; i < SECTION_COUNT; i++) {
		struct lw_bank_section *section = &sections[i];
		const bool writable =
			section->space == LW_SPACE_COIL || section->space == LW_SPACE_HOLDING;

		section->context = calloc(1, image_sizes[i]);
		section->allow = writable ? allow : NULL;
		section->store = !writable                         ? NULL
				 : section->space == LW_SPACE_COIL ? store_bit
								   : store;
		for (const struct lw_point *point = section->points;
		     point < section->points + section->point_count; point++) {
			const uint8_t part_count = width(point);
			/* A command is a value that allows 0, and then it does not run. */
			const int32_t value =
				point->flags & LW_POINT_COMMAND ? 0 : point->default_value;

			for (uint32_t j = 0; j < (uint32_t)point->count * part_count; j++) {
				entries[section->space][point->address + section->address_offset +
							j] = (struct entry){
					.known = true,
					.writable = writable && (point->flags & LW_POINT_WRITABLE),
					.part = (uint8_t)(j % part_count),
					.part_count = part_count,
				};
			}
			if (writable && section->space == LW_SPACE_HOLDING &&
			    (point->flags & LW_POINT_WRITABLE)) {
				for (uint16_t j = 0; j < point->count; j++) {
					store(section->context, point, j, value);
				}
			}
		}
	}
}

void tearDown(void)
{
	for (size_t i = 0; i < SECTION_COUNT; i++) {
		free(sections[i].context);
	}
}

static bool is_bits(enum lw_space space)
{
	return space == LW_SPACE_COIL || space == LW_SPACE_DISCRETE;
}

static size_t byte_count(enum lw_space space, uint32_t count)
{
	return is_bits(space) ? (count + 7) / 8 : 2 * (size_t)count;
}

static int read(enum lw_space space, uint32_t address, uint32_t count, uint8_t *out)
{
	struct lw_refusal why;

	return is_bits(space) ? lw_bank_read_bits(&bank, space, (uint16_t)address, (uint16_t)count,
						  out, &why)
			      : lw_bank_read_registers(&bank, space, (uint16_t)address,
						       (uint16_t)count, out, &why);
}

/** Read into a buffer of its size, and write back what was read. */
static void check(enum lw_space space, uint32_t address, uint32_t count, bool known, bool writable)
{
	uint8_t *bytes = malloc(byte_count(space, count));
	const struct entry *first = &entries[space][address];
	const struct entry *last = &entries[space][(address + count - 1) % ADDRESSES];
	struct lw_refusal why;

	TEST_ASSERT_EQUAL_INT(known ? 0 : -ENXIO, read(space, address, count, bytes));
	if (known && (space == LW_SPACE_COIL || space == LW_SPACE_HOLDING)) {
		const bool whole = first->part == 0 && last->part == last->part_count - 1;

		TEST_ASSERT_EQUAL_INT(writable && whole ? 0 : -ENXIO,
				      space == LW_SPACE_COIL
					      ? lw_bank_write_bits(&bank, (uint16_t)address,
								   (uint16_t)count, bytes, &why)
					      : lw_bank_write_registers(&bank, (uint16_t)address,
									(uint16_t)count, bytes,
									&why));
	}
	free(bytes);
}

static void test_every_address_with_every_count(void)
{
	static const enum lw_space spaces[] = {LW_SPACE_COIL, LW_SPACE_DISCRETE, LW_SPACE_HOLDING,
					       LW_SPACE_INPUT};
	unsigned int accepted = 0;

	for (size_t i = 0; i < sizeof(spaces) / sizeof(spaces[0]); i++) {
		const enum lw_space space = spaces[i];
		const uint32_t max = is_bits(space) ? BITS_MAX : REGISTERS_MAX;

		for (uint32_t address = 0; address < ADDRESSES; address++) {
			bool known = true;
			bool writable = true;

			/* Once there is an unknown address inside, more changes nothing. */
			for (uint32_t count = 1; count <= max && known; count++) {
				const uint32_t end = address + count - 1;

				known = end < ADDRESSES && entries[space][end].known;
				writable &= known && entries[space][end].writable;
				check(space, address, count, known, writable);
				accepted += known;
			}
			if (!known) {
				check(space, address, max, false, false);
			}
		}
	}
	TEST_ASSERT_TRUE(accepted > 5000);
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_every_address_with_every_count);
	return UNITY_END();
}
