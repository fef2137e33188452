/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The register bank: reads and writes whole Modbus requests, all or nothing, by the generated
 * tables.
 *
 * A bank is a list of sections. Each section is one table of points together with the struct in
 * memory that its values live in. A request may cover several sections where their addresses join.
 * Not for interrupt context.
 */
#ifndef LW_BANK_H
#define LW_BANK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lw/map/point.h"
#include "lw/map/refusal.h"

/** One table and the code behind it. */
struct lw_bank_section {
	enum lw_space space;
	const struct lw_point *points; /**< sorted by address */
	uint16_t point_count;
	uint16_t address_offset; /**< added to every point's address (mirrors of a block) */
	void *context;           /**< handed to the functions below */

	/**
	 * The struct (or uint32_t of bits) that the points' offsets refer to; never NULL. Called
	 * once per read and section; what it points to must be one consistent snapshot and stay
	 * unchanged until the request is answered.
	 */
	const void *(*image)(void *context);

	/**
	 * May this value be written now? Called for every value of a request before any is stored,
	 * in ascending address order, but for commands after everything else; the bank has already
	 * checked address, access and limits, and filled in `why` but for the reason. NULL: the
	 * section is read only.
	 * @retval 0 yes
	 * @retval -EBUSY not now; `why->reason` says why (Modbus exception 06)
	 * @retval -EINVAL not this value; `why` says why (Modbus exception 03)
	 */
	int (*allow)(void *context, const struct lw_point *point, uint16_t element, int32_t value,
		     struct lw_refusal *why);

	/**
	 * Take one allowed value. Cannot fail. Not called for the value of a secret that keeps it
	 * (LW_POINT_SECRET). Called in ascending address order, but for commands
	 * after everything else. NULL: read only.
	 */
	void (*store)(void *context, const struct lw_point *point, uint16_t element, int32_t value);
};

/** All that a slave offers. The addresses of sections of one space do not overlap or interleave. */
struct lw_bank {
	const struct lw_bank_section *sections;
	size_t section_count;

	/**
	 * A write is about to be judged: forget what the one before asked for. What one request
	 * asks for together is judged by the sections' `allow`. NULL: every value is judged alone.
	 */
	void (*begin_write)(void *context);
	void *context; /**< handed to begin_write() */
};

/*
 * Of all four: `why` tells the reason of a refusal, and is left undefined by success. Unknown and
 * unwritable addresses anywhere in the range are found before values are looked at.
 */

/**
 * Read registers, big-endian, high word first. Half of a multi-register value may be read.
 *
 * @param out receives 2 * count bytes
 * @retval 0 done
 * @retval -ENXIO an address in the range does not exist; nothing was read
 */
int lw_bank_read_registers(const struct lw_bank *bank, enum lw_space space, uint16_t address,
			   uint16_t count, uint8_t *out, struct lw_refusal *why);

/**
 * Write holding registers, all or nothing. At most one command register of a request may be
 * non-zero.
 *
 * @param in 2 * count bytes, big-endian, high word first
 * @retval 0 done
 * @retval -ENXIO an address in the range does not exist, cannot be written, or only a part of a
 *         multi-register value is covered
 * @retval -EINVAL a value is outside its limits, or more than one command
 * @retval -EBUSY refused now
 */
int lw_bank_write_registers(const struct lw_bank *bank, uint16_t address, uint16_t count,
			    const uint8_t *in, struct lw_refusal *why);

/**
 * Read coils or discrete inputs, packed least significant bit first, unused bits 0.
 *
 * @param out receives (count + 7) / 8 bytes
 * @retval 0 done
 * @retval -ENXIO an address in the range does not exist
 */
int lw_bank_read_bits(const struct lw_bank *bank, enum lw_space space, uint16_t address,
		      uint16_t count, uint8_t *out, struct lw_refusal *why);

/**
 * Write coils, all or nothing. At most one command coil of a request may be 1.
 *
 * @param in (count + 7) / 8 bytes, packed least significant bit first
 * @retval 0 done
 * @retval -ENXIO an address in the range does not exist
 * @retval -EINVAL more than one command
 * @retval -EBUSY refused now
 */
int lw_bank_write_bits(const struct lw_bank *bank, uint16_t address, uint16_t count,
		       const uint8_t *in, struct lw_refusal *why);

/**
 * Is a value within the limits of a register?
 *
 * @param limit receives the limit that it breaks, or the nearest allowed value
 */
bool lw_point_allows(const struct lw_point *point, int64_t value, int32_t *limit);

#endif /* LW_BANK_H */
