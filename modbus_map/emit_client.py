# SPDX-License-Identifier: Apache-2.0
"""The map of the C client for panels: host_tools/c/generated. It has nothing of the bench."""

from c_text import (
    allowed_array,
    allowed_fields,
    comment,
    defines,
    enum,
    header_comment,
    initializer,
    string,
    struct,
)
from map_model import Block, Enum, Map, Point, Value

DECLARATIONS = """\
/** One value of an enumeration, or one bit number of a bit field */
struct levelwind_value {
	int32_t value;
	const char *name; /**< its name in the map */
	const char *text; /**< one line for a person in the field */
};

/** Types on the wire; 32 and 64 bit values carry the high word first */
enum levelwind_type {
	LEVELWIND_TYPE_U16, /**< in memory int32_t */
	LEVELWIND_TYPE_I16, /**< in memory int32_t */
	LEVELWIND_TYPE_U32, /**< in memory uint32_t */
	LEVELWIND_TYPE_I32, /**< in memory int32_t */
	LEVELWIND_TYPE_I64, /**< in memory int64_t */
};

/** One value of the map */
struct levelwind_point {
	const char *name;
	const char *unit; /**< "" if it has none */
	const char *text; /**< one line for a person in the field */
	enum levelwind_block block;
	enum levelwind_type type;
	uint16_t address; /**< first 0-based protocol address */
	uint16_t words;   /**< registers */
	size_t offset;    /**< of a status point: its member in struct levelwind_status */
	int32_t min;      /**< smallest value that may be written; not for status points */
	int32_t max;      /**< largest value that may be written */
	int32_t default_value;
	const int32_t *allowed; /**< the only values that may be written, or NULL */
	size_t allowed_count;
	const struct levelwind_value *values; /**< names of the values or bits, or NULL */
	size_t value_count;
};

"""


def _blocks(map_: Map) -> list[Block]:
    return [block for block in map_.blocks if not block.bench]


def _enums(map_: Map) -> list[Enum]:
    used = {point.enum for block in _blocks(map_) for point in block.points}
    return [enum_ for enum_ in map_.enums.values() if enum_.name in used]


def _status(map_: Map) -> Block:
    return next(block for block in map_.blocks if block.space == "input")


def map_h(map_: Map) -> str:
    blocks = _blocks(map_)
    parts = [
        header_comment("The Modbus map of the level wind controller, for its master."),
        "#ifndef LEVELWIND_MAP_H\n#define LEVELWIND_MAP_H\n\n"
        "#include <stddef.h>\n#include <stdint.h>\n\n",
        "/* What this map expects in the registers map_version and self_test. */\n",
        defines(
            [
                ("LEVELWIND_MAP_VERSION", str(map_.version)),
                ("LEVELWIND_SELF_TEST", f"0x{map_.self_test:08X}u"),
            ]
        ),
    ]
    for enum_ in _enums(map_):
        parts += ["\n", enum(f"levelwind_{enum_.name}", enum_.text, enum_.values)]
    flag_text = "Discrete inputs; bit n of levelwind_status.flags is n, of flags_2 32 + n"
    inhibit_text = "Bit numbers of levelwind_status.launch_inhibit"
    block_values = [Value(i, block.name, block.text) for i, block in enumerate(blocks)]
    parts += [
        "\n",
        enum("levelwind_flag", flag_text, map_.flags),
        "\n",
        enum("levelwind_launch_inhibit_bit", inhibit_text, map_.launch_inhibit),
        "\n",
        enum("levelwind_block", "Where a point belongs", block_values),
        "\n/* Protocol addresses of holding and input registers. */\n",
        defines(
            [
                (f"LEVELWIND_ADDRESS_{point.name.upper()}", str(point.address))
                for block in blocks
                for point in block.points
            ]
        ),
        "\n/* Added to the address of a parameter: its read-only copies, input registers. */\n",
        defines(
            [
                (f"LEVELWIND_{mirror.name.upper()}_ADDRESS_OFFSET", str(mirror.address_offset))
                for block in blocks
                for mirror in block.mirrors
            ]
        ),
        "\n",
        struct("levelwind_status", _status(map_).text, _status(map_).points, "levelwind_"),
        "\n",
        DECLARATIONS,
        f"#define LEVELWIND_POINT_COUNT {sum(len(block.points) for block in blocks)}\n\n",
        comment("All points, by block and rising address"),
        "extern const struct levelwind_point levelwind_points[LEVELWIND_POINT_COUNT];\n\n",
        "#endif /* LEVELWIND_MAP_H */\n",
    ]
    return "".join(parts)


def _value_array(name: str, values: list[Value]) -> str:
    rows = "".join(
        initializer([str(value.value), string(value.name), string(value.text)]) for value in values
    )
    return f"\nstatic const struct levelwind_value {name}_values[] = {{\n{rows}}};\n"


def _row(block: Block, point: Point, map_: Map) -> str:
    fields = [
        f".name = {string(point.name)}",
        f".unit = {string(point.unit)}",
        f".text = {string(point.text)}",
        f".block = LEVELWIND_BLOCK_{block.name.upper()}",
        f".type = LEVELWIND_TYPE_{point.type.upper()}",
        f".address = {point.address}",
        f".words = {point.words}",
    ]
    if block is _status(map_):
        fields.append(f".offset = offsetof(struct levelwind_status, {point.name})")
    if point.writable:
        fields += [
            f".min = {point.min}",
            f".max = {point.max}",
            f".default_value = {point.default}",
        ]
    fields += allowed_fields(point)
    values = map_.values(point)
    if values:
        fields += [
            f".values = {point.enum or point.name}_values",
            f".value_count = {len(values)}",
        ]
    return initializer(fields)


def map_c(map_: Map) -> str:
    blocks = _blocks(map_)
    parts = [
        header_comment("The Modbus map of the level wind controller: tables for its master."),
        '#include "levelwind_map.h"\n',
    ]
    parts += [_value_array(enum_.name, enum_.values) for enum_ in _enums(map_)]
    parts += [
        _value_array(point.name, map_.values(point)) for point in _status(map_).points if point.bits
    ]
    parts.append("\n")
    parts += [allowed_array(point) for block in blocks for point in block.points]
    parts.append("\nconst struct levelwind_point levelwind_points[LEVELWIND_POINT_COUNT] = {\n")
    parts += [_row(block, point, map_) for block in blocks for point in block.points]
    parts.append("};\n")
    return "".join(parts)
