# SPDX-License-Identifier: Apache-2.0
"""What integrators import says what the map says, and can be read by what it is for."""

import csv
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import jsonschema
import pytest
import yaml

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
HA_HUB |= {"message_wait_milliseconds"}
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


# ---- what polling asks of the line ---------------------------------------------------------------

BITS_OF_A_CHARACTER = 11  # 8E1
SLAVE_S = 0.005  # until it answers
USB_ADAPTER_S = 0.016  # the latency timer of most of them, as they are sold


def transaction_s(function: int, count: int, baud: int) -> float:
    """One read on the wire: request and answer, each ended by 3.5 characters of silence."""
    unit, code, crc = 1, 1, 2
    request = unit + code + 2 + 2 + crc
    answer = unit + code + 1 + (-(-count // 8) if function in (1, 2) else 2 * count) + crc
    return (request + answer + 7) * BITS_OF_A_CHARACTER / baud + SLAVE_S + USB_ADAPTER_S


def test_a_cycle_of_home_assistant_fits_the_line() -> None:
    (hub,) = yaml.safe_load(read("tags_home_assistant.yaml"))["modbus"]
    wait_s = hub.get("message_wait_milliseconds", 30) / 1000  # that is what it takes by itself
    words = {name: count for (count, _), name in HA_TYPES.items()}
    entities = [(2, 1, e["scan_interval"]) for e in hub["binary_sensors"]]
    entities += [(4, words[e["data_type"]], e["scan_interval"]) for e in hub["sensors"]]
    cycle_s = sum(transaction_s(f, n, hub["baudrate"]) + wait_s for f, n, _ in entities)
    assert cycle_s < 0.8 * min(interval_s for *_, interval_s in entities)
    assert max(interval_s for *_, interval_s in entities) <= 15  # and is of use


def test_a_cycle_of_node_red_fits_the_line() -> None:
    nodes = json.loads(read("tags_node_red.json"))
    (client,) = (n for n in nodes if n["type"] == "modbus-client")
    reads = [n for n in nodes if n["type"] == "modbus-read"]
    assert {n["rateUnit"] for n in reads} == {"s"}
    cycle_s = sum(
        transaction_s(
            {"Input": 2, "InputRegister": 4}[n["dataType"]],
            int(n["quantity"]),
            int(client["serialBaudrate"]),
        )
        + int(client["commandDelay"]) / 1000
        for n in reads
    )
    assert cycle_s < 0.8 * min(int(n["rate"]) for n in reads)


def test_node_red_asks_one_unit_of_a_line_at_a_time() -> None:
    for node in json.loads(read("tags_node_red.json")):
        if node["type"] == "modbus-client":
            assert node["clienttype"] == "serial"
            assert node["parallelUnitIdsAllowed"] is False
            assert node["bufferCommands"] is True  # each waits in its queue


# ---- over Modbus TCP -----------------------------------------------------------------------------

TELEGRAF_TYPES = {
    "UINT16": (1, False),
    "INT16": (1, True),
    "UINT32": (2, False),
    "INT32": (2, True),
    "INT64": (4, True),
}
WOT_TYPES = {
    "xsd:unsignedShort": (1, False),
    "xsd:short": (1, True),
    "xsd:unsignedInt": (2, False),
    "xsd:int": (2, True),
    "xsd:long": (4, True),
}
NODE_WOT = "@node-wot/td-tools@0.9.0"


def test_telegraf() -> None:
    tomllib = pytest.importorskip("tomllib", reason="Python 3.11")
    (plugin,) = tomllib.loads(read("tags_telegraf.conf"))["inputs"]["modbus"]
    assert plugin["configuration_type"] == "request"
    assert plugin["controller"].startswith("tcp://")
    discrete, registers = plugin["request"]
    for request in (discrete, registers):
        assert request["byte_order"] == "ABCD"  # high word first, high byte first
        assert request["slave_id"] == 1
    assert {f["name"]: f["address"] for f in discrete["fields"]} == {
        flag.name: flag.value for flag in MAP.flags
    }
    told = {field["name"]: field for field in registers["fields"]}
    assert len(told) == len(registers["fields"])
    assert told.keys() == {p.name for p in STATUS.points if p.address >= 100}
    for name, field in told.items():
        assert field["address"] == POINTS[name][1].address
        assert TELEGRAF_TYPES[field["type"]] == BITS[POINTS[name][1].type]


FUXA_TYPES = {
    "UInt16": (1, False),
    "Int16": (1, True),
    "UInt32": (2, False),
    "Int32": (2, True),
    "Int64": (4, True),
}


def test_fuxa() -> None:
    project = json.loads(read("tags_fuxa.json"))
    (device,) = project["devices"].values()
    assert device["property"]["options"] is True, "holes of the map are not asked for"
    flags = {flag.name: flag.value for flag in MAP.flags}
    told = {tag["name"]: tag for tag in device["tags"].values()}
    assert told.keys() == flags.keys() | {
        p.name for p in STATUS.points if p.address >= 100 or p.name == "map_version"
    }
    for name, tag in told.items():
        if name in flags:
            assert (tag["memaddress"], int(tag["address"]) - 1) == ("100000", flags[name])
        else:
            point = POINTS[name][1]
            assert (tag["memaddress"], int(tag["address"]) - 1) == ("300000", point.address)
            assert FUXA_TYPES[tag["type"]] == BITS[point.type]
            # It asks for what stands together at once, but loses what is beyond a hundred.
            assert point.address // 100 == (point.end - 1) // 100
    (view,) = project["hmi"]["views"]
    for key, item in view["items"].items():
        assert item["property"]["variableId"] in device["tags"], key
        assert f'id="{key}"' in view["svgcontent"]
    drawn = ElementTree.fromstring(view["svgcontent"])
    width, height = int(drawn.get("width")), int(drawn.get("height"))
    for element in drawn.iter():
        x, y = (float(element.get(a, element.get(f"c{a}", 0))) for a in "xy")
        assert 0 <= x <= width and 0 <= y <= height
    shown = {item["name"].partition("_")[2] for item in view["items"].values()}
    assert shown > flags.keys() | {f"launch_inhibit_{bit.value}" for bit in MAP.launch_inhibit}


def test_thing_description() -> None:
    thing = json.loads(read("tags_wot_td.json"))
    flags = {flag.name: flag.value for flag in MAP.flags}
    assert thing["properties"].keys() == flags.keys() | {point.name for point in STATUS.points}
    for name, told in thing["properties"].items():
        (form,) = told["forms"]
        unit, address, count = re.fullmatch(
            r"modbus\+tcp://[\d.]+:\d+/(\d+)/(\d+)\?quantity=(\d+)", form["href"]
        ).groups()
        assert (unit, told["readOnly"], form["op"]) == ("1", True, "readproperty")
        if name in flags:
            assert (int(address), int(count)) == (flags[name], 1)
            assert form["modv:entity"] == "DiscreteInput"
        else:
            point = POINTS[name][1]
            assert (int(address), int(count)) == (point.address, point.words)
            assert form["modv:entity"] == "InputRegister"
            words, signed = WOT_TYPES[form["modv:type"]]
            assert (words, signed) == BITS[point.type]
            size = f"length={2 * words};signed={str(signed).lower()};byteSeq=BIG_ENDIAN"
            assert form["contentType"] == f"application/octet-stream;{size}"
            assert told.get("unit", "") == point.unit
    coils = {coil.name: coil.address for coil in MAP.coils}
    assert {
        name: int(action["forms"][0]["href"].split("/")[-1].partition("?")[0])
        for name, action in thing["actions"].items()
    } == coils


def test_thing_description_by_node_wot() -> None:
    """By the standard's own schema, and by the library that a consumer would use."""
    if not shutil.which("npm"):
        pytest.skip("no npm")
    folder = FOLDER.parent / "build" / "npm"
    if not (folder / "node_modules" / "@node-wot").is_dir():
        folder.mkdir(parents=True, exist_ok=True)
        done = subprocess.run(
            ["npm", "install", "--silent", "--no-audit", "--no-fund", "--prefix", folder, NODE_WOT],
            capture_output=True, timeout=300, check=False,
        )  # fmt: skip
        if done.returncode != 0:
            pytest.skip(f"npm cannot fetch {NODE_WOT}")
    modules = folder / "node_modules"
    schema = modules / "wot-thing-description-types" / "schema" / "td-json-schema-validation.json"
    jsonschema.validate(
        json.loads(read("tags_wot_td.json")), json.loads(schema.read_text(encoding="utf-8"))
    )
    script = """
        const { parseTD } = require("@node-wot/td-tools");
        const thing = parseTD(require("fs").readFileSync(process.argv[1], "utf8"));
        console.log(Object.keys(thing.properties).length, Object.keys(thing.actions).length);
    """
    done = subprocess.run(
        ["node", "-e", script, FOLDER / "tags_wot_td.json"],
        cwd=folder, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [
        str(len(MAP.flags) + len(STATUS.points)),
        str(len(MAP.coils)),
    ]
