/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * One entry of the Modbus map. The tables of these are generated from modbus_map/registers.yaml
 * (lw/map.h); lw/modbus/bank.h reads and writes whole requests by them.
 */
#ifndef LW_POINT_H
#define LW_POINT_H

#include <stdint.h>

/** The four Modbus address spaces. */
enum lw_space {
	LW_SPACE_COIL,
	LW_SPACE_DISCRETE,
	LW_SPACE_HOLDING,
	LW_SPACE_INPUT,
};

/** Type on the wire; registers high word first. The type in memory is in parentheses. */
enum lw_type {
	LW_TYPE_BIT, /**< one bit (bit `offset` of a uint32_t) */
	LW_TYPE_U16, /**< one register (int32_t) */
	LW_TYPE_I16, /**< one register, two's complement (int32_t) */
	LW_TYPE_U32, /**< two registers (uint32_t) */
	LW_TYPE_I32, /**< two registers, two's complement (int32_t) */
	LW_TYPE_I64, /**< four registers, two's complement (int64_t), never writable */
};

/** Properties of a point, or-ed in lw_point.flags. */
enum lw_point_flag {
	LW_POINT_WRITABLE = 1 << 0,
	LW_POINT_SCOPE_LINE = 1 << 1, /**< parameter of the serial line, else of the motion */
	LW_POINT_REINDEX = 1 << 2,    /**< parameter whose change makes the index invalid */
	LW_POINT_COMMAND = 1 << 3,    /**< writing a non-zero value runs a command */
	LW_POINT_SECRET = 1 << 4,     /**< reads `max` unless it is 0; writing `max` keeps it */
};

/** One register value, array of values, or bit of the map. */
struct lw_point {
	uint16_t address; /**< first 0-based protocol address */
	uint16_t count;   /**< elements, 1 unless an array */
	uint16_t offset; /**< bytes from the start of the block's struct; for bits the bit number */
	uint8_t type;    /**< enum lw_type */
	uint8_t flags;   /**< enum lw_point_flag */
	int32_t min;     /**< smallest value a write may carry */
	int32_t max;     /**< largest value a write may carry */
	int32_t default_value;
	const int32_t *allowed; /**< the only values a write may carry, or NULL */
	uint8_t allowed_count;
};

#endif /* LW_POINT_H */
