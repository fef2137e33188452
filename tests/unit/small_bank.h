/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A small register bank for the tests of the Modbus layers, and an owner that records what is
 * stored.
 */
#ifndef SMALL_BANK_H
#define SMALL_BANK_H

#include <errno.h>
#include <string.h>

#include "lw/modbus/bank.h"
#include "lw/map.h"

#define ARRAY_SIZE(array) ((uint16_t)(sizeof(array) / sizeof((array)[0])))

/** Coils and discrete inputs 0 to 2015, 32 per section. */
#define BIT_SECTIONS 63

/** What the registers live in. */
struct small_values {
	int32_t command;
	int32_t level;
	uint32_t speed;
	int32_t place;
	uint32_t baud;
	int32_t gear;
	int32_t fixed;
	int32_t other_command;
	uint32_t wide;
	int64_t count;
	int32_t array[200];
	int32_t next;
	uint32_t last;
	int32_t secret;
};

static const int32_t small_bauds[] = {1200, 9600, 115200};
static const int32_t small_gears[] = {1, 2, 4};

#define AT(name) .count = 1, .offset = offsetof(struct small_values, name)

/** Holding registers; the same again as input registers from 1000. */
static const struct lw_point small_points[] = {
	{.address = 0,
	 AT(command),
	 .type = LW_TYPE_U16,
	 .flags = LW_POINT_WRITABLE | LW_POINT_COMMAND,
	 .max = 9},
	{.address = 1,
	 AT(level),
	 .type = LW_TYPE_I16,
	 .flags = LW_POINT_WRITABLE,
	 .min = -100,
	 .max = 100},
	{.address = 2,
	 AT(speed),
	 .type = LW_TYPE_U32,
	 .flags = LW_POINT_WRITABLE,
	 .min = 10,
	 .max = 100000},
	{.address = 4,
	 AT(place),
	 .type = LW_TYPE_I32,
	 .flags = LW_POINT_WRITABLE,
	 .min = -500000,
	 .max = 500000},
	{.address = 6,
	 AT(baud),
	 .type = LW_TYPE_U32,
	 .flags = LW_POINT_WRITABLE,
	 .allowed = small_bauds,
	 .allowed_count = 3},
	{.address = 8,
	 AT(gear),
	 .type = LW_TYPE_U16,
	 .flags = LW_POINT_WRITABLE,
	 .allowed = small_gears,
	 .allowed_count = 3},
	{.address = 9, AT(fixed), .type = LW_TYPE_U16},
	{.address = 10,
	 AT(other_command),
	 .type = LW_TYPE_U16,
	 .flags = LW_POINT_WRITABLE | LW_POINT_COMMAND,
	 .max = 9},
	{.address = 20,
	 AT(wide),
	 .type = LW_TYPE_U32,
	 .flags = LW_POINT_WRITABLE,
	 .max = INT32_MAX},
	{.address = 30, AT(count), .type = LW_TYPE_I64},
	{.address = 100,
	 .count = 200,
	 .offset = offsetof(struct small_values, array),
	 .type = LW_TYPE_U16,
	 .flags = LW_POINT_WRITABLE,
	 .max = 65535},
};

/** Joins the array above at 300. */
static const struct lw_point small_next_points[] = {
	{.address = 0, AT(next), .type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .max = 65535},
};

/** A value that is not shown. */
static const struct lw_point small_secret_points[] = {
	{.address = 500,
	 AT(secret),
	 .type = LW_TYPE_U16,
	 .flags = LW_POINT_WRITABLE | LW_POINT_SECRET,
	 .max = 1000},
};

/** The end of the address space. */
static const struct lw_point small_last_points[] = {
	{.address = 65534, AT(last), .type = LW_TYPE_U32, .flags = LW_POINT_WRITABLE, .max = 1000},
};

/** Writable by its table, but its section has nobody who takes the value. */
static const struct lw_point small_read_only_points[] = {
	{.address = 400, AT(fixed), .type = LW_TYPE_U16, .flags = LW_POINT_WRITABLE, .max = 9},
};

/** Coils 0 and 1 run commands. */
static const struct lw_point small_first_coils[] = {
	{.address = 0,
	 .count = 2,
	 .offset = 0,
	 .type = LW_TYPE_BIT,
	 .flags = LW_POINT_WRITABLE | LW_POINT_COMMAND},
	{.address = 2, .count = 30, .offset = 2, .type = LW_TYPE_BIT, .flags = LW_POINT_WRITABLE},
};

static const struct lw_point small_coils[] = {
	{.address = 0, .count = 32, .type = LW_TYPE_BIT, .flags = LW_POINT_WRITABLE},
};

static const struct lw_point small_discretes[] = {
	{.address = 0, .count = 32, .type = LW_TYPE_BIT},
};

#undef AT

/** The owner of all sections. */
struct small_bank {
	struct small_values values;
	uint32_t coils[BIT_SECTIONS];
	uint32_t discretes[BIT_SECTIONS];
	struct lw_bank_section sections[6 + 2 * BIT_SECTIONS];
	struct lw_bank bank;

	const struct lw_point *refused_point; /**< allow() refuses this one */
	int refused_error;
	unsigned int allow_count;
	unsigned int store_count;
	unsigned int image_count;
	uint16_t stored_addresses[256]; /**< of the points stored, in order */
};

static struct small_bank small;

static inline const void *small_image(void *context)
{
	small.image_count++;
	return context;
}

static inline int small_allow(void *context, const struct lw_point *point, uint16_t element,
			      int32_t value, struct lw_refusal *why)
{
	(void)context;
	(void)element;
	(void)value;
	small.allow_count++;
	if (point == small.refused_point) {
		why->reason = LW_REASON_BUSY_TRACKING;
		return small.refused_error;
	}
	return 0;
}

static inline void small_store(void *context, const struct lw_point *point, uint16_t element,
			       int32_t value)
{
	uint32_t *at = (uint32_t *)((uint8_t *)context + point->offset) + element;

	small.stored_addresses[small.store_count++ % 256] = (uint16_t)(point->address + element);
	*at = (uint32_t)value;
}

static inline void small_store_bit(void *context, const struct lw_point *point, uint16_t element,
				   int32_t value)
{
	uint32_t *bits = context;
	uint32_t mask = 1u << (point->offset + element);

	small.store_count++;
	*bits = value != 0 ? *bits | mask : *bits & ~mask;
}

/** A section that can be written, at the given offset. */
static inline struct lw_bank_section small_section(enum lw_space space,
						   const struct lw_point *points, uint16_t count,
						   uint16_t address_offset, void *context)
{
	return (struct lw_bank_section){
		.space = space,
		.points = points,
		.point_count = count,
		.address_offset = address_offset,
		.context = context,
		.image = small_image,
		.allow = small_allow,
		.store = space == LW_SPACE_COIL ? small_store_bit : small_store,
	};
}

#define SMALL_SECTION(space, points, address_offset, context)                                      \
	small_section(space, points, ARRAY_SIZE(points), address_offset, context)

static inline void small_init(void)
{
	struct lw_bank_section *section = small.sections;

	memset(&small, 0, sizeof(small));
	*section++ = SMALL_SECTION(LW_SPACE_HOLDING, small_points, 0, &small.values);
	*section++ = SMALL_SECTION(LW_SPACE_INPUT, small_points, 1000, &small.values);
	*section++ = SMALL_SECTION(LW_SPACE_HOLDING, small_next_points, 300, &small.values);
	*section++ = SMALL_SECTION(LW_SPACE_HOLDING, small_last_points, 0, &small.values);
	*section++ = SMALL_SECTION(LW_SPACE_HOLDING, small_secret_points, 0, &small.values);
	*section = SMALL_SECTION(LW_SPACE_HOLDING, small_read_only_points, 0, &small.values);
	section->allow = NULL;
	section->store = NULL;
	section++;
	*section++ = SMALL_SECTION(LW_SPACE_COIL, small_first_coils, 0, &small.coils[0]);
	for (uint16_t i = 1; i < BIT_SECTIONS; i++) {
		*section++ = SMALL_SECTION(LW_SPACE_COIL, small_coils, (uint16_t)(32 * i),
					   &small.coils[i]);
	}
	for (uint16_t i = 0; i < BIT_SECTIONS; i++) {
		*section++ = SMALL_SECTION(LW_SPACE_DISCRETE, small_discretes, (uint16_t)(32 * i),
					   &small.discretes[i]);
	}
	small.bank = (struct lw_bank){.sections = small.sections,
				      .section_count = ARRAY_SIZE(small.sections)};
	small.values.speed = 10;
	small.values.baud = 9600;
	small.values.gear = 1;
}

#endif /* SMALL_BANK_H */
