"""What integrators import says what the map says, and can be read by what it is for."""

import csv
import json
import re
import sys
from pathlib import Path

import yaml
from blark.parse import parse_source_code

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER))

import map_model  # noqa: E402

MAP = map_model.load()
STATUS = next(b for b in MAP.blocks if b.space == "input" and not b.bench)
POINTS = {point.name: (block, point) for block in MAP.blocks for point in block.points}
BITS = {"u16": (1, False), "i16": (1, True), "u32": (2, False), "i32": (2, True), "i64": (4, True)}


def read(name: str) -> str:
    return (FOLDER / name).read_text(encoding="ascii")


def test_csv_has_both_forms_of_every_address() -> None:
    bases = {"coil": "0", "discrete": "1", "input": "3", "holding": "4"}
    rows = list(csv.DictReader(read("tags.csv").splitlines()))
    for row in rows:
        address = int(row["address0"])
        assert row["reference"][0] == bases[row["space"]]
        assert int(row["reference"][1:]) == address + 1
        assert len(row["reference"]) == (5 if address < 9999 else 6)
    by_name = {row["name"]: row for row in rows}
    for block, point in POINTS.values():
        if not block.bench:
            assert int(by_name[point.name]["address0"]) == point.address
            for mirror in block.mirrors:
                copy = by_name[f"{mirror.name}_{point.name}"]
                assert int(copy["address0"]) == point.address + mirror.address_offset


def test_json_has_the_whole_map() -> None:
    document = json.loads(read("tags.json"))
    assert document["map_version"] == MAP.version
    found = {p["name"]: p for block in document["registers"] for p in block["points"]}
    assert found.keys() == POINTS.keys()
    for name, (_, point) in POINTS.items():
        for key in ("address", "type", "unit", "text", "writable", "count", "words"):
            assert found[name][key] == getattr(point, key)
        if point.writable:
            for key in ("min", "max", "default", "allowed"):
                assert found[name][key] == getattr(point, key)
    assert [c["name"] for c in document["coils"]] == [c.name for c in MAP.coils]
    assert [f["name"] for f in document["discrete_inputs"]] == [f.name for f in MAP.flags]
    assert document["enums"].keys() == MAP.enums.keys()


def input_registers(run: range) -> dict[str, map_model.Point]:
    """The points in a run of input registers, which must have no hole and cut none."""
    inside = {p.name: p for p in STATUS.points if p.address in run}
    assert sum(p.words for p in inside.values()) == len(run)
    return inside


def test_node_red_flow() -> None:
    nodes = json.loads(read("tags_node_red.json"))
    by_id = {node["id"]: node for node in nodes}
    assert len(by_id) == len(nodes)
    assert {n["type"] for n in nodes} == {
        *("tab", "modbus-client", "modbus-read", "function", "debug")
    }
    seen: set[str] = set()
    for node in nodes:
        assert node.get("z", "levelwind_tab") == "levelwind_tab"
        for wire in node.get("wires", []):
            assert set(wire) <= by_id.keys()
        if node["type"] != "modbus-read":
            continue
        assert by_id[node["server"]]["type"] == "modbus-client"
        function = by_id[node["wires"][0][0]]["func"]
        run = range(int(node["adr"]), int(node["adr"]) + int(node["quantity"]))
        table = json.loads(re.search(r"const \w+ = (\[.*\]);$", function, re.M)[1])
        if node["dataType"] == "Input":
            assert table == [flag.name for flag in MAP.flags]
            assert run == range(len(MAP.flags))
            continue
        assert node["dataType"] == "InputRegister"
        assert len(run) <= 125
        inside = input_registers(run)
        assert {entry[0] for entry in table} == inside.keys()
        for name, first, count, signed in table:
            assert run.start + first == inside[name].address
            assert (count, signed) == BITS[inside[name].type]
        seen |= inside.keys()
    assert seen == {p.name for p in STATUS.points}


# https://www.home-assistant.io/integrations/modbus/
HA_HUB = {"name", "type", "method", "port", "baudrate", "bytesize", "parity", "stopbits"}
HA_ENTITY = {"name", "unique_id", "slave", "address", "input_type", "scan_interval"}
HA_TYPES = {(1, False): "uint16", (1, True): "int16", (2, False): "uint32", (2, True): "int32"}
HA_TYPES[4, True] = "int64"


def test_home_assistant() -> None:
    document = yaml.safe_load(read("tags_home_assistant.yaml"))
    assert document.keys() == {"modbus"}
    (hub,) = document["modbus"]
    assert hub.keys() == HA_HUB | {"sensors", "binary_sensors"}
    entities = hub["sensors"] + hub["binary_sensors"]
    assert len({e["unique_id"] for e in entities}) == len(entities)
    flags = {flag.name: flag.value for flag in MAP.flags}
    for entity in hub["binary_sensors"]:
        assert entity.keys() == HA_ENTITY
        assert entity["input_type"] == "discrete_input"
        assert entity["address"] == flags.pop(entity["unique_id"].removeprefix("levelwind_"))
    assert not flags
    for entity in hub["sensors"]:
        assert HA_ENTITY < entity.keys() <= HA_ENTITY | {"data_type", "unit_of_measurement"}
        block, point = POINTS[entity["unique_id"].removeprefix("levelwind_")]
        assert (block.space, entity["input_type"]) == ("input", "input")
        assert entity["address"] == point.address
        assert entity["data_type"] == HA_TYPES[BITS[point.type]]
        assert entity.get("unit_of_measurement", "") == point.unit


# ---- structured text -----------------------------------------------------------------------------

ST = read("tags_iec61131.st")
NAME = r"[A-Za-z_][A-Za-z0-9_]*"
ST_LINES = (
    r"VAR_GLOBAL CONSTANT \(\* [^*]* \*\)|VAR_INPUT|STRUCT|END_(VAR|STRUCT|TYPE|FUNCTION)",
    rf"TYPE {NAME} :|FUNCTION {NAME} : {NAME}|\(|\) UINT;|\(\* FC04, address \d+, count \d+ \*\)",
    rf"    {NAME} : UINT := \d+;( \(\* .* \*\))?",
    rf"    {NAME} : (UINT|INT|UDINT|DINT|LINT);( \(\* .* \*\))?",
    r"    words : ARRAY\[0\.\.\d+\] OF WORD;",
    rf"    {NAME} := \d+,?",
    rf"{NAME}\.{NAME} := (WORD|DWORD|LWORD)_TO_(UINT|INT|UDINT|DINT|LINT)\(.*\);",
)


def st_code() -> str:
    """Without the comment at the top."""
    return ST.partition("*)\n")[2]


def test_structured_text_has_no_other_lines() -> None:
    for line in st_code().splitlines():
        assert not line or any(re.fullmatch(form, line) for form in ST_LINES), line
        assert line.count("(*") == line.count("*)") <= 1


def test_structured_text_can_be_parsed() -> None:
    """One line of each form in each section: the parser takes a minute for all."""
    sections = st_code().strip().split("\n\n")
    forms: set[str] = set()
    parsed = 0
    for section in sections:
        kept = []
        for line in section.splitlines():
            code = re.sub(r"\(\*.*?\*\)", "", line)
            form = re.sub(r"LEVELWIND_\w+|(?<=\.)\w+|^    \w+", "N", re.sub(r"\d+", "0", code))
            if form not in forms or not line.startswith((" ", "Levelwind")):
                kept.append(line)
            forms.add(form)
        text = "\n".join(kept).replace(",\n)", "\n)")
        if len(kept) > 5 or parsed == 0:
            assert parse_source_code(text).exception is None, text
            parsed += 1
    assert parsed > 3


def test_the_parser_finds_mistakes() -> None:
    wrong = "TYPE A :\nSTRUCT\n    x UINT;\nEND_STRUCT\nEND_TYPE\n"
    assert parse_source_code(wrong).exception is not None


def test_structured_text_fits_the_map() -> None:
    addresses = dict(re.findall(r"LEVELWIND_ADDRESS_(\w+) : UINT := (\d+);", ST))
    expected = {n.upper(): str(p.address) for n, (b, p) in POINTS.items() if not b.bench}
    assert addresses == expected
    coils = dict(re.findall(r"LEVELWIND_COIL_(\w+) : UINT := (\d+);", ST))
    assert coils == {c.name.upper(): str(c.address) for c in MAP.coils}
    seen = set()
    for first, count, body in re.findall(
        r"\(\* FC04, address (\d+), count (\d+) \*\)\n(.*?)END_FUNCTION", ST, re.S
    ):
        run = range(int(first), int(first) + int(count))
        inside = input_registers(run)
        assert f"ARRAY[0..{len(run) - 1}]" in body
        for name, value in re.findall(rf"FromWords\.({NAME}) := (.*);", body):
            point = inside[name]
            words = [int(w) for w in re.findall(r"words\[(\d+)\]", value)]
            shifts = [int(s) for s in re.findall(r", (\d+)\)", value)]
            start = point.address - run.start
            assert words == list(range(start, start + point.words))
            assert shifts == [16 * i for i in range(point.words - 1, 0, -1)]
            target = {"u": "U", "i": ""}[point.type[0]]
            target += {1: "INT", 2: "DINT", 4: "LINT"}[point.words]
            assert re.match(rf"\w+_TO_{target}\(", value)
            assert re.search(rf"^    {name} : {target};", ST, re.M)
            seen.add(name)
    assert seen == {p.name for p in STATUS.points}
    for enum in MAP.enums.values():
        for value in enum.values:
            member = f"    LEVELWIND_{enum.name.upper()}_{value.name.upper()} := "
            if member in ST:
                assert re.search(rf"^{re.escape(member)}{value.value},?$", ST, re.M)
