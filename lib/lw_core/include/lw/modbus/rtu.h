/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Modbus RTU framing: bytes and time in, frames out. Silence ends a frame. Not for interrupt
 * context.
 */
#ifndef LW_RTU_H
#define LW_RTU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Longest frame: unit id, PDU of 253 bytes, CRC. */
#define LW_RTU_FRAME_MAX 256u

/** Times of the line. */
struct lw_rtu_config {
	/**
	 * Silence that ends a frame, above 0. lw_rtu_silence_us(baud) where every byte carries its
	 * own time; longer where bytes come in lots (UART FIFO, pseudo terminal, emulator).
	 */
	uint32_t silence_us;
	/** A pause inside a frame longer than this spoils it (1.5 characters); 0: not checked. */
	uint32_t character_gap_us;
};

/** State of one receiver. rtu.c writes its fields; the slave reads what has come so far. */
struct lw_rtu {
	struct lw_rtu_config config;
	uint64_t first_byte_us; /**< of what has come since the last silence */
	uint64_t last_byte_us;
	size_t length; /**< bytes received, LW_RTU_FRAME_MAX + 1 stands for more */
	bool gap_seen;
	uint8_t frame[LW_RTU_FRAME_MAX];
};

/**
 * The standard's 3.5 characters of 11 bits, rounded up; 1,750 us above 19,200 baud
 * (MODBUS over Serial Line V1.02, 2.5.1.1).
 *
 * @param baud above 0
 */
uint32_t lw_rtu_silence_us(uint32_t baud);

/**
 * Time of a byte on the line, 11 bits, rounded up.
 *
 * @param baud above 0
 */
uint32_t lw_rtu_byte_us(uint32_t baud);

/** Start with an empty buffer. */
void lw_rtu_init(struct lw_rtu *rtu, const struct lw_rtu_config *config);

/** Take other times; what has been received stays. */
void lw_rtu_reconfigure(struct lw_rtu *rtu, const struct lw_rtu_config *config);

/**
 * Take bytes from the line. The bytes of one call count as having followed each other closely.
 *
 * @param now_us time of their arrival; never goes back
 * @retval 0 taken
 * @retval -EAGAIN they begin a new frame, and the one before has not been fetched: nothing was
 *         taken, call lw_rtu_poll() and then this again
 */
int lw_rtu_receive(struct lw_rtu *rtu, const uint8_t *bytes, size_t count, uint64_t now_us);

/**
 * Fetch a frame that is complete.
 *
 * @param frame set to the frame's first byte if there is one; valid until the next lw_rtu_receive()
 * @retval >0 bytes of the frame, unit id and PDU without the CRC: 2 to 254
 * @retval 0 no frame is complete yet
 * @retval -EBADMSG a frame was dropped: wrong CRC, shorter than 4 bytes, or a pause inside
 * @retval -EMSGSIZE a frame was dropped: longer than LW_RTU_FRAME_MAX
 */
int lw_rtu_poll(struct lw_rtu *rtu, uint64_t now_us, const uint8_t **frame);

/** Forget what has been received since the last frame. */
void lw_rtu_drop(struct lw_rtu *rtu);

/** When lw_rtu_poll() will have something to say; UINT64_MAX while the buffer is empty. */
uint64_t lw_rtu_deadline_us(const struct lw_rtu *rtu);

/**
 * Append the CRC to a frame.
 *
 * @param frame has room for length + 2 bytes
 * @return length + 2
 */
size_t lw_rtu_seal(uint8_t *frame, size_t length);

#endif /* LW_RTU_H */
