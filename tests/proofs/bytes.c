/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Foreign bytes: what a storage holds, and what comes from the line. Whatever they are and however
 * many, nothing is accessed outside of them.
 */
#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "lw/bytes/big_endian.h"

/*
 * WP cannot follow uint8_t through the char of Frama-C's C library. What C demands of these two is
 * the same for bytes.
 */
/*@
  requires \valid_read(a + (0 .. count - 1)) && \valid_read(b + (0 .. count - 1));
  assigns \nothing;
*/
int compare_bytes(const uint8_t *a, const char *b, size_t count);

/*@
  requires \valid(to + (0 .. count - 1)) && \valid_read(from + (0 .. count - 1));
  requires \separated(to + (0 .. count - 1), from + (0 .. count - 1));
  assigns to[0 .. count - 1];
*/
void copy_bytes(uint8_t *to, const uint8_t *from, size_t count);

#define memcmp compare_bytes
#define memcpy copy_bytes

/*@
  requires \valid_read(at + (0 .. 1));
  assigns \nothing;
*/
static inline uint16_t lw_get16(const uint8_t *at);

/*@
  requires \valid_read(at + (0 .. 3));
  assigns \nothing;
*/
static inline uint32_t lw_get32(const uint8_t *at);

#include "lw/bytes/crc32.h"
#include "lw/storage/record.h"

/*@
  requires \valid_read(bytes + (0 .. length - 1));
  assigns \nothing;
*/
uint32_t lw_crc32_add(uint32_t crc, const uint8_t *bytes, size_t length);

/*@
  requires \valid_read(bytes + (0 .. length - 1));
  assigns \nothing;
*/
static inline uint32_t lw_crc32(const uint8_t *bytes, size_t length);

#include "../../lib/lw_core/src/bytes/crc32.c"

/*@
  requires \valid_read(bytes + (0 .. size - 1));
  assigns \nothing;
*/
static bool erased(const uint8_t *bytes, size_t size);

/*@
  requires \valid_read(bytes + (0 .. size - 1)) && \valid_read(kind + (0 .. 3));
  requires \valid(record) && \separated(bytes + (0 .. size - 1), record);
  assigns *record;
  ensures \result == 0 || \result == -ENODATA || \result == -EBADMSG;
  ensures \result == 0 ==> record->payload == bytes + LW_RECORD_HEAD_SIZE &&
    record->length <= size - LW_RECORD_OVERHEAD;
*/
int lw_record_open(const uint8_t *bytes, size_t size, const char *kind, struct lw_record *record);

#include "../../lib/lw_core/src/storage/record.c"

#include "lw/modbus/crc16.h"
#include "lw/modbus/rtu.h"

/*@
  requires \valid_read(bytes + (0 .. count - 1));
  assigns \nothing;
*/
uint16_t lw_crc16(const uint8_t *bytes, size_t count);

#include "../../lib/lw_core/src/modbus/crc16.c"

/*@
  requires \valid(rtu) && rtu->length <= LW_RTU_FRAME_MAX + 1;
  requires \valid_read(bytes + (0 .. count - 1)) && \separated(bytes + (0 .. count - 1), rtu);
  assigns *rtu;
  ensures rtu->length <= LW_RTU_FRAME_MAX + 1;
*/
int lw_rtu_receive(struct lw_rtu *rtu, const uint8_t *bytes, size_t count, uint64_t now_us);

/*@
  requires \valid_read(rtu);
  assigns \nothing;
*/
uint64_t lw_rtu_deadline_us(const struct lw_rtu *rtu);

/*@
  requires \valid_read(rtu);
  assigns \nothing;
  ensures \result ==> rtu->length > 0;
*/
static bool is_complete(const struct lw_rtu *rtu, uint64_t now_us);

/*@
  requires \valid(rtu);
  assigns *rtu;
  ensures rtu->length == 0;
*/
void lw_rtu_drop(struct lw_rtu *rtu);

/*@
  requires \valid(rtu) && \valid(frame) && \separated(rtu, frame);
  requires rtu->length <= LW_RTU_FRAME_MAX + 1;
  assigns *rtu, *frame;
  ensures rtu->length <= LW_RTU_FRAME_MAX + 1;
  ensures \result > 0 ==> *frame == &rtu->frame[0] && 2 <= \result <= LW_RTU_FRAME_MAX - 2;
*/
int lw_rtu_poll(struct lw_rtu *rtu, uint64_t now_us, const uint8_t **frame);

/*@
  requires length <= LW_RTU_FRAME_MAX - 2 && \valid(frame + (0 .. length + 1));
  assigns frame[length .. length + 1];
  ensures \result == length + 2;
*/
size_t lw_rtu_seal(uint8_t *frame, size_t length);

#include "../../lib/lw_core/src/modbus/rtu.c"

/*
 * A parameter set is written by the offsets of its table: here it is its bytes.
 */
#define lw_params         params_with_members
#define lw_params_default params_default_with_members
#include "lw/map.h"
#undef lw_params
#undef lw_params_default

struct lw_params {
	char bytes[sizeof(struct params_with_members)];
};
extern const struct lw_params lw_params_default;

#include "lw/modbus/bank.h"
#include "lw/storage/param_record.h"

/*@
  requires count == 4 && \valid(to + (0 .. 3)) && \valid_read(from);
  assigns to[0 .. 3];
*/
void copy_value(char *to, const uint32_t *from, size_t count);

#undef memcpy
#define memcpy copy_value

/*@
  predicate allowed_ok(struct lw_point *point) =
    point->allowed == \null || \valid_read(point->allowed + (0 .. point->allowed_count - 1));

  // test_map.c tries it.
  predicate table_ok = \forall integer k; 0 <= k < LW_MAP_PARAMS_COUNT ==>
    lw_map_params[k].offset + 4 <= sizeof(struct lw_params) && allowed_ok(&lw_map_params[k]);
*/

/*@
  requires \valid_read(point) && allowed_ok(point) && \valid(limit) && \separated(point, limit);
  requires INT32_MIN <= value <= UINT32_MAX;
  assigns *limit;
*/
bool lw_point_allows(const struct lw_point *point, int64_t value, int32_t *limit);

/*@
  requires \valid(params) && \valid(next) && *next <= LW_MAP_PARAMS_COUNT && table_ok;
  requires \separated(params, next);
  assigns *params, *next;
  ensures *next <= LW_MAP_PARAMS_COUNT;
*/
static int take(struct lw_params *params, size_t *next, uint16_t address, uint32_t value);

/*@
  requires \valid_read(at + (0 .. 3));
  assigns \nothing;
*/
static uint32_t get32_1(const uint8_t *at);

/*@
  requires \valid_read(bytes + (0 .. size - 1));
  assigns \nothing;
  ensures \result ==> size >= 8 + 4 * 51 + 4;
*/
static bool is_schema_1(const uint8_t *bytes, size_t size);

/*@
  requires \valid_read(bytes + (0 .. 8 + 4 * 51 - 1)) && \valid(params) && table_ok;
  assigns *params;
*/
static int decode_1(const uint8_t *bytes, struct lw_params *params);

/*@
  requires \valid_read(record) && \valid_read(record->payload + (0 .. record->length - 1));
  requires \valid(params) && \separated(params, record) && table_ok;
  assigns *params;
*/
static int decode_2(const struct lw_record *record, struct lw_params *params);

/*@
  requires \valid_read(bytes + (0 .. size - 1)) && \valid(params) && \valid(record) && table_ok;
  requires \separated(bytes + (0 .. size - 1), record) && \separated(params, record);
  requires \separated(record, &lw_map_params[0 .. LW_MAP_PARAMS_COUNT - 1]);
  assigns *params, *record;
*/
int lw_param_record_decode(const uint8_t *bytes, size_t size, struct lw_params *params,
			   struct lw_record *record);

#include "../../lib/lw_core/src/storage/param_record.c"
