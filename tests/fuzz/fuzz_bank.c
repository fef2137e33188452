/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The register bank of a whole device, without the checks that Modbus makes before it. The input is
 * a list of accesses: what, address, count, and for a write the data.
 */
#include <errno.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "judge.h"

enum {
	READ_HOLDING,
	READ_INPUT,
	READ_COILS,
	READ_DISCRETES,
	WRITE_REGISTERS,
	WRITE_COILS,
	ACCESS_COUNT,
};

/** The most that a request can carry. */
#define REGISTERS_MAX 125u
#define BITS_MAX      2000u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static bool is_bits(uint8_t access)
{
	return access == READ_COILS || access == READ_DISCRETES || access == WRITE_COILS;
}

/* Into a buffer of exactly the size that the interface promises: the sanitizer watches its end. */
static int read(const struct lw_bank *bank, uint8_t access, uint16_t address, uint16_t count,
		struct lw_refusal *why)
{
	const size_t size = is_bits(access) ? (count + 7u) / 8u : 2u * count;
	uint8_t *out = malloc(size + 1);
	int ret;

	memset(out, 0xAA, size + 1);
	switch (access) {
	case READ_HOLDING:
		ret = lw_bank_read_registers(bank, LW_SPACE_HOLDING, address, count, out, why);
		break;
	case READ_INPUT:
		ret = lw_bank_read_registers(bank, LW_SPACE_INPUT, address, count, out, why);
		break;
	case READ_COILS:
		ret = lw_bank_read_bits(bank, LW_SPACE_COIL, address, count, out, why);
		break;
	default:
		ret = lw_bank_read_bits(bank, LW_SPACE_DISCRETE, address, count, out, why);
		break;
	}
	judge_require(out[size] == 0xAA, "written behind the buffer", out, size);
	judge_require(ret == 0 || ret == -ENXIO, "error of a reading", NULL, 0);
	free(out);
	return ret;
}

static int write(const struct lw_bank *bank, uint8_t access, uint16_t address, uint16_t count,
		 const uint8_t *data, size_t size, struct lw_refusal *why)
{
	const size_t needed = is_bits(access) ? (count + 7u) / 8u : 2u * count;
	uint8_t *in = calloc(1, needed + 1);
	int ret;

	memcpy(in, data, size < needed ? size : needed);
	ret = access == WRITE_REGISTERS ? lw_bank_write_registers(bank, address, count, in, why)
					: lw_bank_write_bits(bank, address, count, in, why);
	judge_require(ret == 0 || ret == -ENXIO || ret == -EINVAL || ret == -EBUSY,
		      "error of a write", in, needed);
	judge_require(ret == 0 || why->reason != LW_REASON_NONE, "a refusal without a reason", in,
		      needed);
	free(in);
	return ret;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static struct judge judge;
	struct lw_device *device = &judge.world.device;

	judge_init(&judge, 1);
	while (size >= 5) {
		const uint8_t access = data[0] % ACCESS_COUNT;
		const uint16_t address = (uint16_t)(data[1] << 8 | data[2]);
		uint16_t count = (uint16_t)(data[3] << 8 | data[4]);
		struct lw_refusal why = {0};
		int ret;

		data += 5;
		size -= 5;
		count = (uint16_t)(count % (is_bits(access) ? BITS_MAX + 1 : REGISTERS_MAX + 1));
		judge.device = *device;
		judge.plant = judge.world.plant;
		if (access < WRITE_REGISTERS) {
			ret = read(&device->bank, access, address, count, &why);
		} else {
			const size_t given = is_bits(access) ? (count + 7u) / 8u : 2u * count;

			ret = write(&device->bank, access, address, count, data, size, &why);
			data += given < size ? given : size;
			size -= given < size ? given : size;
		}
		if (access < WRITE_REGISTERS || ret != 0) {
			judge_require(memcmp(&judge.device.staged, &device->staged,
					     sizeof(device->staged)) == 0 &&
					      memcmp(&judge.device.active, &device->active,
						     sizeof(device->active)) == 0 &&
					      memcmp(&judge.device.controller, &device->controller,
						     sizeof(device->controller)) == 0 &&
					      memcmp(&judge.plant, &judge.world.plant,
						     sizeof(judge.plant)) == 0,
				      "a reading or a refused write has changed something", NULL,
				      0);
		}
		judge_limits(&device->staged);
		judge_limits(&device->active);
		judge_run_ms(&judge, data[-1] & 1);
	}
	judge_alive(&judge);
	return 0;
}
