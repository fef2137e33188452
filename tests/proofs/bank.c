/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Reading the register bank: whatever a request asks for, nothing is accessed outside of the
 * answer, of the tables and of the memory that they describe. The tables are any that keep
 * `bank_ok`; test_device.c tries it on those that the device has.
 */
#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/*
 * Between types, WP follows memory only so far: what C demands of memcpy() and memset(), for the
 * types that the bank uses them with.
 */
/*@
  requires count == 4 && \valid(to) && \valid_read(from + (0 .. 3));
  assigns *to;
*/
void copy_narrow(int32_t *to, const char *from, size_t count);

/*@
  requires count == 8 && \valid(to) && \valid_read(from + (0 .. 7));
  assigns *to;
*/
void copy_wide(int64_t *to, const char *from, size_t count);

/*@
  requires \valid(to + (0 .. count - 1));
  assigns to[0 .. count - 1];
*/
void fill_bytes(uint8_t *to, int value, size_t count);

#define memcpy(to, from, count)                                                                    \
	(sizeof(*(to)) == 8 ? copy_wide((int64_t *)(to), from, count)                              \
			    : copy_narrow((int32_t *)(to), from, count))
#define memset fill_bytes

#include "lw/bytes/big_endian.h"
#include "lw/modbus/bank.h"

/*@
  requires \valid(at + (0 .. 1));
  assigns at[0 .. 1];
*/
static inline uint8_t *lw_put16(uint8_t *at, uint16_t value);

/** What the callback changes. It is neither the bank nor its tables nor the request. */
int owner;

/*@
  // Bytes that the owner has behind its context.
  axiomatic images {
    logic integer image_size(void *context);
  }
*/

/*
 * What the callback of every section keeps to.
 */
/*@
  assigns owner;
  ensures \valid_read((char *)\result + (0 .. image_size(context) - 1));
*/
const void *owner_image(void *context);

/*@
  // What the tables hold, as plain numbers that no write can change: tables_ok. They have a
  // section i with its points k.
  axiomatic tables {
    logic struct lw_bank_section *sections;
    logic integer section_count;
    logic struct lw_point *points(integer i);
    logic integer point_count(integer i);
    logic integer space(integer i);
    logic integer address_offset(integer i);
    logic void *context(integer i);
    logic integer address(integer i, integer k);
    logic integer count(integer i, integer k);
    logic integer offset(integer i, integer k);
    logic integer type(integer i, integer k);
    logic int32_t *allowed(integer i, integer k);
    logic integer allowed_count(integer i, integer k);
  }

  // The map as a whole: of each address the section and its point; a negative section if there
  // is nothing.
  axiomatic map {
    logic integer section_at(integer space, integer address);
    logic integer point_at(integer space, integer address);
  }

  predicate known(integer space, integer address) = section_at(space, address) >= 0;

  predicate all_known(integer space, integer from, integer to) =
    \forall integer a; from <= a < to ==> known(space, a);

  logic integer width(integer type) =
    type == LW_TYPE_I64 ? 4 : type == LW_TYPE_U32 || type == LW_TYPE_I32 ? 2 : 1;

  logic integer begin(struct lw_bank_section *section, integer k) =
    section->points[k].address + section->address_offset;

  logic integer end(struct lw_bank_section *section, integer k) =
    begin(section, k) + section->points[k].count * width(section->points[k].type);

  predicate points_ok(struct lw_bank_section *section) =
    \valid_read(section->points + (0 .. section->point_count - 1)) &&
    \forall integer j, k; 0 <= j < k < section->point_count ==>
      begin(section, j) < begin(section, k) && end(section, j) <= begin(section, k);

  predicate fits(integer type, integer offset, integer count, integer size) =
    type == LW_TYPE_BIT ? offset + count <= 32 && 4 <= size :
      offset + count * (type == LW_TYPE_I64 ? 8 : 4) <= size;

  // In memory stand the tables.
  predicate point_is(integer i, integer k, struct lw_point *point) =
    point->address == address(i, k) && point->count == count(i, k) &&
    point->offset == offset(i, k) && point->type == type(i, k) &&
    point->allowed == allowed(i, k) && point->allowed_count == allowed_count(i, k);

  predicate section_is(integer i, struct lw_bank_section *section) =
    section->points == points(i) && section->point_count == point_count(i) &&
    section->space == space(i) && section->address_offset == address_offset(i) &&
    section->context == context(i) && section->image == &owner_image;

  predicate tables_ok(struct lw_bank *bank) =
    bank->sections == sections && bank->section_count == section_count &&
    (\forall integer i; 0 <= i < section_count ==> section_is(i, sections + i)) &&
    (\forall integer i, k; 0 <= i < section_count && 0 <= k < point_count(i) ==>
      point_is(i, k, points(i) + k));

  // They can be read, and are about memory that can be.
  predicate memory_ok(struct lw_bank *bank) =
    \valid_read(bank) && \valid_read(sections + (0 .. section_count - 1)) &&
    (\forall integer i; 0 <= i < section_count ==>
      \valid_read(points(i) + (0 .. point_count(i) - 1))) &&
    (\forall integer i, k; 0 <= i < section_count && 0 <= k < point_count(i) ==>
      (allowed(i, k) == \null || \valid_read(allowed(i, k) + (0 .. allowed_count(i, k) - 1))) &&
      (type(i, k) == LW_TYPE_BIT <==>
      space(i) == LW_SPACE_COIL || space(i) == LW_SPACE_DISCRETE) &&
      fits(type(i, k), offset(i, k), count(i, k), image_size(context(i))));

  logic integer first(integer i, integer k) = address(i, k) + address_offset(i);
  logic integer behind(integer i, integer k) = first(i, k) + count(i, k) * width(type(i, k));

  predicate reads_as(integer i, struct lw_bank_section *section) =
    section->points == points(i) && section->point_count == point_count(i) &&
    \forall integer k; 0 <= k < point_count(i) ==>
      begin(section, k) == first(i, k) && end(section, k) == behind(i, k);

  // The points of a section rise.
  predicate order_ok =
    \forall integer i, j, k; 0 <= i < section_count && 0 <= j < k < point_count(i) ==>
      first(i, j) < first(i, k) && behind(i, j) <= first(i, k);

  // The map is that of the tables: no two sections share an address.
  predicate map_ok =
    (\forall integer i, k, a; 0 <= i < section_count && 0 <= k < point_count(i) &&
      first(i, k) <= a < behind(i, k) ==>
      section_at(space(i), a) == i && point_at(space(i), a) == k) &&
    (\forall integer s, a; known(s, a) ==>
      section_at(s, a) < section_count && space(section_at(s, a)) == s &&
      0 <= point_at(s, a) < point_count(section_at(s, a)) &&
      first(section_at(s, a), point_at(s, a)) <= a < behind(section_at(s, a), point_at(s, a)));

  predicate bank_ok(struct lw_bank *bank) =
    tables_ok(bank) && memory_ok(bank) && order_ok && map_ok;

  // The image that a section has given.
  predicate image_ok(struct lw_bank_section *section, void *image) =
    \exists integer i; 0 <= i < section_count && section == sections + i &&
      \valid_read((char *)image + (0 .. image_size(context(i)) - 1));
*/

/* clang-format off */
#define APART(bank, what)                                                                          \
	(\separated(bank, what) && \separated(sections + (0 .. section_count - 1), what) &&        \
	 \forall integer i_; 0 <= i_ < section_count ==>                                           \
	   \separated(points(i_) + (0 .. point_count(i_) - 1), what))
/* clang-format on */

/*@
  // The place of an address.
  predicate found(integer s, integer a, struct lw_bank_section *section, struct lw_point *point,
      integer element) =
    known(s, a) && section == sections + section_at(s, a) &&
    point == points(section_at(s, a)) + point_at(s, a) &&
    element < count(section_at(s, a), point_at(s, a));
*/

/*@
  requires bank_ok(bank) && (space == LW_SPACE_HOLDING || space == LW_SPACE_INPUT);
  requires \valid(why) && \valid(out + (0 .. 2 * count - 1));
  requires APART(bank, why) && APART(bank, out + (0 .. 2 * count - 1));
  assigns out[0 .. 2 * count - 1], *why, owner;
*/
int lw_bank_read_registers(const struct lw_bank *bank, enum lw_space space, uint16_t address,
			   uint16_t count, uint8_t *out, struct lw_refusal *why);

/*@
  requires bank_ok(bank) && (space == LW_SPACE_COIL || space == LW_SPACE_DISCRETE) && \valid(why);
  requires \valid(out + (0 .. (count + 7) / 8 - 1));
  requires APART(bank, why) && APART(bank, out + (0 .. (count + 7) / 8 - 1));
  assigns out[0 .. (count + 7) / 8 - 1], *why, owner;
*/
int lw_bank_read_bits(const struct lw_bank *bank, enum lw_space space, uint16_t address,
		      uint16_t count, uint8_t *out, struct lw_refusal *why);

/*@
  requires \valid_read(point) && \valid(limit) && \separated(point, limit);
  requires point->allowed == \null ||
    \valid_read(point->allowed + (0 .. point->allowed_count - 1));
  requires INT32_MIN <= value <= UINT32_MAX;
  assigns *limit;
*/
bool lw_point_allows(const struct lw_point *point, int64_t value, int32_t *limit);

#include "../../lib/lw_core/src/modbus/bank.c"

/*@
  requires \valid_read(point);
  assigns \nothing;
  ensures \result == width(point->type);
*/
static uint16_t registers_of(const struct lw_point *point);

/*@
  requires \valid_read(section) && points_ok(section);
  assigns \nothing;
  ensures \result == \null ==>
    \forall integer k; 0 <= k < section->point_count ==> begin(section, k) > address;
  ensures \result != \null ==>
    \exists integer j; 0 <= j < section->point_count && \result == &section->points[j] &&
      begin(section, j) <= address &&
      \forall integer k; j < k < section->point_count ==> begin(section, k) > address;
*/
static const struct lw_point *point_before(const struct lw_bank_section *section, uint32_t address);

/*@
  requires \valid_read(section) && points_ok(section);
  assigns \nothing;
  ensures \result.section == section;
  ensures \result.point == \null ==>
    \forall integer k; 0 <= k < section->point_count ==>
      !(begin(section, k) <= address < end(section, k));
  ensures \result.point != \null ==>
    \exists integer k; 0 <= k < section->point_count &&
      begin(section, k) <= address < end(section, k) && \result.point == &section->points[k];
  ensures \result.point != \null ==>
    \result.part < \result.part_count <= 4 && \result.element < \result.point->count;
*/
static struct place find_in(const struct lw_bank_section *section, uint32_t address);

/*@
  requires bank_ok(bank);
  assigns \nothing;
  ensures \result.point != \null <==> known(space, address);
  ensures \result.point != \null ==>
    found(space, address, \result.section, \result.point, \result.element) &&
    \result.part < \result.part_count <= 4;
*/
static struct place find(const struct lw_bank *bank, enum lw_space space, uint32_t address);

/*@
  assigns \nothing;
*/
static inline int32_t lw_clamp32(int64_t value);

/*@
  requires \valid(why);
  assigns *why;
  ensures \result == error;
*/
static inline int lw_refuse(struct lw_refusal *why, int error, enum lw_reason reason,
			    uint32_t address, int64_t value, int64_t limit);

/*@
  requires bank_ok(bank) && \valid(why) && APART(bank, why);
  assigns *why;
  ensures \result == 0 ==> bank_ok(bank) && all_known(space, address, address + count);
  ensures \result == 0 ==> address + count <= 65536;
*/
static int check_known(const struct lw_bank *bank, enum lw_space space, uint16_t address,
		       uint16_t count, struct lw_refusal *why);

/*@
  requires \valid_read(point) && element < point->count;
  requires \exists integer size; \valid_read((char *)image + (0 .. size - 1)) &&
    fits(point->type, point->offset, point->count, size);
  assigns \nothing;
*/
static uint64_t load(const void *image, const struct lw_point *point, uint16_t element);
