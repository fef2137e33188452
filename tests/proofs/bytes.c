/*
 * Foreign bytes: what a storage holds, and what comes from the line. Whatever they are and however
 * many, nothing is accessed outside of them.
 */
#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "../../lib/lw_core/src/big_endian.h"

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

#include "lw/record.h"

/*@
  requires \valid_read(bytes + (0 .. length - 1));
  assigns \nothing;
*/
uint32_t lw_crc32(const uint8_t *bytes, size_t length);

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

#include "../../lib/lw_core/src/record.c"

#include "lw/crc16.h"
#include "lw/rtu.h"

/*@
  requires \valid_read(bytes + (0 .. count - 1));
  assigns \nothing;
*/
uint16_t lw_crc16(const uint8_t *bytes, size_t count);

#include "../../lib/lw_core/src/crc16.c"

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

#include "../../lib/lw_core/src/rtu.c"
