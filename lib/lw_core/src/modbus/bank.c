/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/modbus/bank.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

#include "lw/bytes/big_endian.h"
#include "lw/map.h"

/** Where in the bank an address lies. */
struct place {
	const struct lw_bank_section *section;
	const struct lw_point *point;
	uint16_t element;    /**< which one of an array */
	uint16_t part;       /**< which register of the element, 0 the high word */
	uint16_t part_count; /**< registers per element, 1 for bits */
};

static uint16_t registers_of(const struct lw_point *point)
{
	switch ((enum lw_type)point->type) {
	case LW_TYPE_U32:
	case LW_TYPE_I32:
		return 2;
	case LW_TYPE_I64:
		return 4;
	case LW_TYPE_BIT:
	case LW_TYPE_U16:
	case LW_TYPE_I16:
		break;
	}
	return 1;
}

/* The last point that begins at or before the address, NULL if there is none. */
static const struct lw_point *point_before(const struct lw_bank_section *section, uint32_t address)
{
	size_t low = 0;
	size_t high = section->point_count;

	/*@
	  loop invariant 0 <= low <= high <= section->point_count;
	  loop invariant \forall integer k; 0 <= k < low ==> begin(section, k) <= address;
	  loop invariant \forall integer k;
	    high <= k < section->point_count ==> begin(section, k) > address;
	  loop assigns low, high;
	  loop variant high - low;
	*/
	while (low < high) {
		size_t middle = low + (high - low) / 2;

		if ((uint32_t)section->points[middle].address + section->address_offset <=
		    address) {
			low = middle + 1;
		} else {
			high = middle;
		}
	}
	return low == 0 ? NULL : &section->points[low - 1];
}

/* Where an address lies in a section; the point is NULL if it does not. */
static struct place find_in(const struct lw_bank_section *section, uint32_t address)
{
	struct place place = {.section = section, .point = point_before(section, address)};
	uint32_t distance;

	if (place.point != NULL) {
		distance = address - place.point->address - section->address_offset;
		place.part_count = registers_of(place.point);
		//@ assert place.part_count == 1 || place.part_count == 2 || place.part_count == 4;
		place.element = (uint16_t)(distance / place.part_count);
		place.part = (uint16_t)(distance % place.part_count);
		if (distance >= (uint32_t)place.point->count * place.part_count) {
			place.point = NULL;
		}
	}
	return place;
}

/* Where an address lies in the bank; the point is NULL if it does not. */
static struct place find(const struct lw_bank *bank, enum lw_space space, uint32_t address)
{
	struct place place = {0};

	/*@
	  loop invariant 0 <= i <= bank->section_count;
	  loop invariant place.point == \null ==> !(0 <= section_at(space, address) < i);
	  loop invariant place.point != \null ==> found(space, address, place.section,
	    place.point, place.element) && place.part < place.part_count <= 4;
	  loop assigns i, place;
	  loop variant bank->section_count - i;
	*/
	for (size_t i = 0; i < bank->section_count && place.point == NULL; i++) {
		if (bank->sections[i].space == space) {
			//@ assert reads_as(i, &bank->sections[i]);
			place = find_in(&bank->sections[i], address);
		}
	}
	return place;
}

static int check_known(const struct lw_bank *bank, enum lw_space space, uint16_t address,
		       uint16_t count, struct lw_refusal *why)
{
	uint32_t end = (uint32_t)address + count;

	/*@
	  loop invariant address <= i <= end && i <= UINT16_MAX + 1;
	  loop invariant all_known(space, address, i);
	  loop assigns i;
	  loop variant end - i;
	*/
	for (uint32_t i = address; i < end; i++) {
		if (i > UINT16_MAX) {
			return lw_refuse(why, -ENXIO, LW_REASON_UNKNOWN_ADDRESS, LW_NO_ADDRESS, 0,
					 0);
		}
		if (find(bank, space, i).point == NULL) {
			return lw_refuse(why, -ENXIO, LW_REASON_UNKNOWN_ADDRESS, i, 0, 0);
		}
	}
	return 0;
}

/* What a secret reads as, and what leaves it alone when it is written. */
static bool is_secret_mark(const struct lw_point *point, int64_t value)
{
	return (point->flags & LW_POINT_SECRET) && value == point->max;
}

/* One element from memory, sign-extended. The tables say where it is and how wide. */
static uint64_t load(const void *image, const struct lw_point *point, uint16_t element)
{
	const char *at = image;
	int32_t narrow;
	int64_t wide;

	if (point->type == LW_TYPE_BIT) {
		memcpy(&narrow, at, sizeof(narrow));
		return ((uint32_t)narrow >> (point->offset + element)) & 1u;
	}
	at += point->offset;
	if (point->type == LW_TYPE_I64) {
		memcpy(&wide, at + element * sizeof(wide), sizeof(wide));
	} else {
		memcpy(&narrow, at + element * sizeof(narrow), sizeof(narrow));
		wide = narrow;
	}
	if ((point->flags & LW_POINT_SECRET) && wide != 0) {
		wide = point->max;
	}
	return (uint64_t)wide;
}

int lw_bank_read_registers(const struct lw_bank *bank, enum lw_space space, uint16_t address,
			   uint16_t count, uint8_t *out, struct lw_refusal *why)
{
	const struct lw_bank_section *section = NULL;
	const void *image = NULL;
	struct place place;
	int error = check_known(bank, space, address, count, why);

	/*@
	  loop invariant 0 <= i <= count && (error == 0 ==> tables_ok(bank));
	  loop invariant section == \null || image_ok(section, image);
	  loop assigns i, place, section, image, out[0 .. 2 * count - 1], owner;
	  loop variant count - i;
	*/
	for (uint16_t i = 0; error == 0 && i < count; i++) {
		unsigned int shift;
		uint64_t value;

		place = find(bank, space, (uint32_t)address + i);
		if (place.section != section) {
			section = place.section;
			//@ calls owner_image;
			image = section->image(section->context);
		}
		shift = 16u * (place.part_count - 1u - place.part);
		value = load(image, place.point, place.element) >> shift;
		lw_put16(&out[2 * i], (uint16_t)value);
	}
	return error;
}

int lw_bank_read_bits(const struct lw_bank *bank, enum lw_space space, uint16_t address,
		      uint16_t count, uint8_t *out, struct lw_refusal *why)
{
	const struct lw_bank_section *section = NULL;
	const void *image = NULL;
	struct place place;
	int error = check_known(bank, space, address, count, why);

	if (error != 0) {
		return error;
	}
	memset(out, 0, (count + 7u) / 8u);
	/*@
	  loop invariant 0 <= i <= count && tables_ok(bank);
	  loop invariant section == \null || image_ok(section, image);
	  loop assigns i, place, section, image, out[0 .. (count + 7) / 8 - 1], owner;
	  loop variant count - i;
	*/
	for (uint16_t i = 0; i < count; i++) {
		place = find(bank, space, (uint32_t)address + i);
		if (place.section != section) {
			section = place.section;
			//@ calls owner_image;
			image = section->image(section->context);
		}
		if (load(image, place.point, place.element)) {
			out[i / 8] |= (uint8_t)(1u << (i % 8));
		}
	}
	return 0;
}

/** A write on its way through the stages: nothing is stored before all of it is checked. */
struct request {
	const struct lw_bank *bank;
	enum lw_space space;
	uint32_t address;
	uint32_t count;
	const uint8_t *in;
	struct lw_refusal *why;
	bool has_command;
};

typedef int (*stage_function)(struct request *request, const struct place *place, uint32_t address);

static int walk(struct request *request, stage_function stage)
{
	uint32_t end = request->address + request->count;
	struct place place;
	int error = 0;

	for (uint32_t i = request->address; error == 0 && i < end; i += place.part_count) {
		place = find(request->bank, request->space, i);
		error = stage(request, &place, i);
	}
	return error;
}

/* The value that the request has for an address, as on the wire. */
static uint32_t wire_value(const struct request *request, const struct place *place,
			   uint32_t address)
{
	uint32_t position = address - request->address;
	uint32_t value = 0;

	if (place->point->type == LW_TYPE_BIT) {
		return ((uint32_t)request->in[position / 8] >> (position % 8)) & 1u;
	}
	for (uint32_t i = 0; i < place->part_count; i++) {
		const uint8_t *word = &request->in[2 * (position + i)];

		value = (value << 16) | (uint32_t)(word[0] << 8) | word[1];
	}
	return value;
}

static int32_t signed_value(const struct place *place, uint32_t wire)
{
	return place->point->type == LW_TYPE_I16 ? (int16_t)wire : (int32_t)wire;
}

static int check_writable(struct request *request, const struct place *place, uint32_t address)
{
	const struct lw_bank_section *section = place->section;

	if (!(place->point->flags & LW_POINT_WRITABLE) || section->allow == NULL ||
	    section->store == NULL) {
		return lw_refuse(request->why, -ENXIO, LW_REASON_NOT_WRITABLE, address, 0, 0);
	}
	if (place->part != 0 || address + place->part_count > request->address + request->count) {
		return lw_refuse(request->why, -ENXIO, LW_REASON_HALF_OF_PAIR, address, 0, 0);
	}
	return 0;
}

bool lw_point_allows(const struct lw_point *point, int64_t value, int32_t *limit)
{
	int64_t smallest = INT64_MAX;

	if (point->allowed == NULL) {
		*limit = value < point->min ? point->min : point->max;
		return value >= point->min && value <= point->max;
	}
	/*@
	  loop invariant 0 <= i <= point->allowed_count && smallest >= 0;
	  loop assigns i, smallest, *limit;
	  loop variant point->allowed_count - i;
	*/
	for (uint8_t i = 0; i < point->allowed_count; i++) {
		int64_t difference = value - point->allowed[i];
		int64_t distance = difference < 0 ? -difference : difference;

		if (distance < smallest) {
			smallest = distance;
			*limit = point->allowed[i];
		}
	}
	return smallest == 0;
}

static int check_value(struct request *request, const struct place *place, uint32_t address)
{
	const struct lw_point *point = place->point;
	uint32_t wire = wire_value(request, place, address);
	int32_t value = signed_value(place, wire);
	int32_t limit = 0;

	if (point->type != LW_TYPE_BIT &&
	    !lw_point_allows(point, point->type == LW_TYPE_U32 ? (int64_t)wire : value, &limit)) {
		return lw_refuse(request->why, -EINVAL, LW_REASON_OUT_OF_RANGE, address, value,
				 limit);
	}
	if (value != 0 && (point->flags & LW_POINT_COMMAND)) {
		if (request->has_command) {
			return lw_refuse(request->why, -EINVAL, LW_REASON_SEVERAL_COMMANDS, address,
					 value, 0);
		}
		request->has_command = true;
	}
	return 0;
}

static bool is_command(const struct place *place)
{
	return (place->point->flags & LW_POINT_COMMAND) != 0;
}

static int ask_owner(struct request *request, const struct place *place, uint32_t address)
{
	const struct lw_bank_section *section = place->section;
	int32_t value = signed_value(place, wire_value(request, place, address));

	(void)lw_refuse(request->why, -EINVAL, LW_REASON_NONE, address, value, 0);
	return section->allow(section->context, place->point, place->element, value, request->why);
}

/* What a command works on may stand in the same request, before or behind it. */
static int ask_for_values(struct request *request, const struct place *place, uint32_t address)
{
	return is_command(place) ? 0 : ask_owner(request, place, address);
}

static int ask_for_commands(struct request *request, const struct place *place, uint32_t address)
{
	return is_command(place) ? ask_owner(request, place, address) : 0;
}

static void store(struct request *request, const struct place *place, uint32_t address)
{
	const struct lw_bank_section *section = place->section;
	int32_t value = signed_value(place, wire_value(request, place, address));

	if (!is_secret_mark(place->point, value)) {
		section->store(section->context, place->point, place->element, value);
	}
}

static int store_values(struct request *request, const struct place *place, uint32_t address)
{
	if (!is_command(place)) {
		store(request, place, address);
	}
	return 0;
}

static int store_commands(struct request *request, const struct place *place, uint32_t address)
{
	if (is_command(place)) {
		store(request, place, address);
	}
	return 0;
}

static int write_all(const struct lw_bank *bank, enum lw_space space, uint16_t address,
		     uint16_t count, const uint8_t *in, struct lw_refusal *why)
{
	static const stage_function stages[] = {check_writable,   check_value,  ask_for_values,
						ask_for_commands, store_values, store_commands};
	struct request request = {
		.bank = bank,
		.space = space,
		.address = address,
		.count = count,
		.in = in,
		.why = why,
	};
	int error = check_known(bank, space, address, count, why);

	if (error == 0 && bank->begin_write != NULL) {
		bank->begin_write(bank->context);
	}
	for (size_t i = 0; error == 0 && i < sizeof(stages) / sizeof(stages[0]); i++) {
		error = walk(&request, stages[i]);
	}
	return error;
}

int lw_bank_write_registers(const struct lw_bank *bank, uint16_t address, uint16_t count,
			    const uint8_t *in, struct lw_refusal *why)
{
	return write_all(bank, LW_SPACE_HOLDING, address, count, in, why);
}

int lw_bank_write_bits(const struct lw_bank *bank, uint16_t address, uint16_t count,
		       const uint8_t *in, struct lw_refusal *why)
{
	return write_all(bank, LW_SPACE_COIL, address, count, in, why);
}
