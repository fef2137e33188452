# SPDX-License-Identifier: Apache-2.0
"""The core's tables: lib/lw_core/generated."""

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
from map_model import FLAGS_EACH, Block, Map, Point

FLAG_TEXT = "Discrete inputs; bit n of lw_status.flags is n, of lw_status.flags_2 32 + n"
STRUCT_NOTE = "One member for each point, in the memory type of lw/map/point.h."


def _address_defines(map_: Map) -> str:
    parts = [
        "/* Protocol addresses. Discrete inputs: enum lw_flag is the address. */\n\n/* Coils. */\n",
        defines([(f"LW_ADDRESS_{coil.name.upper()}", str(coil.address)) for coil in map_.coils]),
    ]
    for block in map_.blocks:
        parts.append(f"\n/* Block {block.name}: {block.space} registers. */\n")
        parts.append(
            defines([(f"LW_ADDRESS_{p.name.upper()}", str(p.address)) for p in block.points])
        )
        for mirror in block.mirrors:
            parts.append(
                f"\n/* Added to an address of block {block.name}: {mirror.text}, "
                "as input registers. */\n"
                f"#define LW_MAP_{mirror.name.upper()}_ADDRESS_OFFSET {mirror.address_offset}\n"
            )
    return "".join(parts)


def _table_declaration(name: str, count: int, text: str) -> str:
    return (
        f"#define LW_MAP_{name.upper()}_COUNT {count}\n\n"
        f"{comment(text)}"
        f"extern const struct lw_point lw_map_{name}[LW_MAP_{name.upper()}_COUNT];\n"
    )


def map_h(map_: Map) -> str:
    version = map_.product["version"]
    product = [
        *(
            (f"LW_PRODUCT_{key.upper()}", string(map_.product[key]))
            for key in ("vendor", "code", "name", "url")
        ),
        *((f"LW_VERSION_{key.upper()}", str(version[key])) for key in version),
        ("LW_VERSION_STRING", string(map_.product_version)),
        ("LW_MAP_VERSION", str(map_.version)),
        ("LW_SELF_TEST", f"0x{map_.self_test:08X}u"),
    ]
    parts = [
        header_comment("The Modbus map: enumerations, structs, addresses, limits and defaults."),
        "#ifndef LW_MAP_H\n#define LW_MAP_H\n\n",
        '#include <stdint.h>\n\n#include "lw/map/point.h"\n\n',
        "/* Product identification, and what the register self_test reads. */\n",
        defines(product),
    ]
    for e in map_.enums.values():
        parts += ["\n", enum(f"lw_{e.name}", e.text, e.values)]
    parts += [
        "\n",
        enum("lw_flag", FLAG_TEXT, map_.flags),
        "\n",
        enum(
            "lw_launch_inhibit_bit",
            "Bit numbers of lw_status.launch_inhibit",
            map_.launch_inhibit,
        ),
        "\n",
        _address_defines(map_),
    ]
    for block in map_.blocks:
        parts += ["\n", struct(block.struct, f"{block.text}. {STRUCT_NOTE}", block.points, "lw_")]
    parts.append("\n")
    for block in map_.blocks:
        text = f"{block.text}: {block.space} registers, offsets in struct {block.struct}"
        parts += [_table_declaration(block.short_name, len(block.points), text), "\n"]
    parts += [
        _table_declaration("coils", len(map_.coils), "Coils, indexed by address"),
        "\n",
        _table_declaration("discretes", len(map_.flags), "Discrete inputs, indexed by address"),
        "\n",
        comment("enum lw_command that a coil runs, indexed by address; 0: the coil jogs"),
        "extern const uint8_t lw_map_coil_command[LW_MAP_COILS_COUNT];\n\n",
        comment("Direction in which a coil jogs, indexed by address; 0: it runs a command"),
        "extern const int8_t lw_map_coil_jog[LW_MAP_COILS_COUNT];\n\n",
        comment("The factory values of all parameters"),
        "extern const struct lw_params lw_params_default;\n\n",
        "#endif /* LW_MAP_H */\n",
    ]
    return "".join(parts)


def _point_flags(point: Point) -> str:
    flags = [
        name
        for name, is_set in (
            ("WRITABLE", point.writable),
            ("SCOPE_LINE", point.scope == "line"),
            ("REINDEX", point.reindex),
            ("COMMAND", point.command),
            ("SECRET", point.secret),
        )
        if is_set
    ]
    return " | ".join(f"LW_POINT_{flag}" for flag in flags) or "0"


def _row(block: Block, point: Point) -> str:
    fields = [
        f".address = {point.address}",
        f".count = {point.count}",
        f".offset = offsetof(struct {block.struct}, {point.name})",
        f".type = LW_TYPE_{point.type.upper()}",
    ]
    if point.writable:
        fields += [
            f".flags = {_point_flags(point)}",
            f".min = {point.min}",
            f".max = {point.max}",
            f".default_value = {point.default}",
        ]
    return initializer(fields + allowed_fields(point))


def _bit_row(address: int, flags: str) -> str:
    fields = [
        f".address = {address}",
        ".count = 1",
        f".offset = {address % FLAGS_EACH}",
        ".type = LW_TYPE_BIT",
    ]
    return initializer(fields + ([f".flags = {flags}", ".max = 1"] if flags else []))


def map_c(map_: Map) -> str:
    parts = [
        header_comment("The Modbus map: tables."),
        '#include "lw/map.h"\n\n#include <stddef.h>\n',
    ]
    for block in map_.blocks:
        parts.append("\n")
        parts += [allowed_array(point) for point in block.points]
        count = f"LW_MAP_{block.short_name.upper()}_COUNT"
        parts.append(f"const struct lw_point lw_map_{block.short_name}[{count}] = {{\n")
        parts += [_row(block, point) for point in block.points]
        parts.append("};\n")
    parts.append("\nconst struct lw_point lw_map_coils[LW_MAP_COILS_COUNT] = {\n")
    for coil in map_.coils:
        command = " | LW_POINT_COMMAND" if coil.command else ""
        parts.append(_bit_row(coil.address, f"LW_POINT_WRITABLE{command}"))
    parts.append("};\n\nconst struct lw_point lw_map_discretes[LW_MAP_DISCRETES_COUNT] = {\n")
    parts += [_bit_row(flag.value, "") for flag in map_.flags]
    parts.append("};\n\nconst uint8_t lw_map_coil_command[LW_MAP_COILS_COUNT] = {\n")
    for coil in map_.coils:
        code = f"LW_COMMAND_{coil.command.upper()}" if coil.command else "0"
        parts.append(f"\t[LW_ADDRESS_{coil.name.upper()}] = {code},\n")
    parts.append("};\n\nconst int8_t lw_map_coil_jog[LW_MAP_COILS_COUNT] = {\n")
    parts += [
        f"\t[LW_ADDRESS_{coil.name.upper()}] = {coil.jog},\n" for coil in map_.coils if coil.jog
    ]
    parts.append("};\n\nconst struct lw_params lw_params_default = {\n")
    parameters = next(block for block in map_.blocks if block.struct == "lw_params")
    parts += [f"\t.{point.name} = {point.default},\n" for point in parameters.points]
    parts.append("};\n")
    return "".join(parts)
