/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Bytes on the line of a whole simulated machine. The input is a list of frames: a control byte, a
 * length byte, the bytes.
 */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "judge.h"

/** Control bits. A fuzzer would not find a CRC by itself. */
enum {
	SEAL = 1,          /**< append the CRC */
	OWN_UNIT = 2,      /**< replace the unit id */
	RUN_1_MS = 4,      /**< afterwards */
	RUN_100_MS = 8,    /**< afterwards */
	TWO_LOTS = 16,     /**< the bytes come in two lots */
	LENGTH_TWICE = 32, /**< so that a frame may be longer than 256 bytes */
};

#define FRAME_ROOM 520u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static struct judge judge; /* large: off the stack */

	judge_init(&judge, 1);
	while (size >= 2) {
		const uint8_t control = data[0];
		size_t length = control & LENGTH_TWICE ? 2u * data[1] : data[1];
		uint8_t frame[FRAME_ROOM];

		data += 2;
		size -= 2;
		length = length < size ? length : size;
		memcpy(frame, data, length);
		data += length;
		size -= length;
		if ((control & OWN_UNIT) && length > 0) {
			frame[0] = judge.world.device.slave.config->unit_id;
		}
		if (control & SEAL) {
			length = judge_seal(frame, length);
		}
		judge_frame(&judge, frame, length, control & TWO_LOTS ? length / 2 : 0);
		judge_alive(&judge);
		judge_run_ms(&judge, control & RUN_100_MS ? 100 : control & RUN_1_MS ? 1 : 0);
	}
	return 0;
}
