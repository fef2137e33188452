/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The layout of structs and the values of enumerations, for a caller in another language: a library
 * exports a table of them, which the caller compares with its own copy when it loads the library.
 */
#ifndef LW_LAYOUT_H
#define LW_LAYOUT_H

#include <stddef.h>
#include <stdint.h>

/** A member of a struct, a whole struct (`name` is empty), or a value of an enumeration. */
struct lw_layout {
	const char *type; /**< "struct lw_x" or "enum lw_x"; NULL ends the table */
	const char *name;
	uint32_t offset; /**< of an enumeration the value */
	uint32_t size;   /**< of an enumeration 0 */
};

#define LW_LAYOUT_STRUCT(type)                                                                     \
	{                                                                                          \
		"struct " #type, "", 0, sizeof(struct type)                                        \
	}
#define LW_LAYOUT_MEMBER(type, member)                                                             \
	{                                                                                          \
		"struct " #type, #member, offsetof(struct type, member),                           \
			sizeof(((struct type *)0)->member)                                         \
	}
#define LW_LAYOUT_VALUE(type, value)                                                               \
	{                                                                                          \
		"enum " #type, #value, (uint32_t)value, 0                                          \
	}

#endif /* LW_LAYOUT_H */
