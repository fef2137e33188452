# SPDX-License-Identifier: Apache-2.0
"""For programs of integrators: JSON, Node-RED, Home Assistant. All but the JSON leave out the
bench, which hardware does not have.
"""

import json
import math
from dataclasses import asdict, dataclass

import yaml
from emit_documents import reference
from map_model import Block, Map, Point, Value

SOURCE = "Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py. Do not edit."
READ_MAX = 125
PORT = "/dev/ttyUSB0"
BAUD = 19200
CHARACTER_S = 11 / BAUD  # start, 8 data, parity, stop
ANSWER_S = 0.020  # the slave, and the latency timer of a USB adapter
LOAD_MAX = 0.75  # of the line, so that a repeated request does not delay the next cycle


def _read_s(data_bytes: int, pause_ms: int) -> float:
    """How long a read takes the line: request, answer, and the silence after each."""
    request, answer = 8, 5 + data_bytes
    return (request + answer + 7) * CHARACTER_S + ANSWER_S + pause_ms / 1000


def _interval_s(cycle_s: float) -> int:
    """Whole seconds for a cycle of reads."""
    return math.ceil(cycle_s / LOAD_MAX)


@dataclass(frozen=True)
class Run:
    """Input registers without a hole: one request reads them, as one snapshot."""

    first: int
    points: list[Point]

    @property
    def count(self) -> int:
        return self.points[-1].end - self.first


def status_block(map_: Map) -> Block:
    return next(block for block in map_.blocks if block.space == "input" and not block.bench)


def status_runs(map_: Map) -> list[Run]:
    runs: list[Run] = []
    for point in status_block(map_).points:
        last = runs[-1] if runs else None
        joins = last is not None and last.points[-1].end == point.address
        if joins and point.end - last.first <= READ_MAX:
            last.points.append(point)
        else:
            runs.append(Run(point.address, [point]))
    return runs


# ---- JSON ----------------------------------------------------------------------------------------


def _values(values: list[Value]) -> list[dict]:
    return [asdict(value) for value in values]


def _json_point(block: Block, point: Point) -> dict:
    fields = {"address": point.address, "reference": reference(block.space, point.address)}
    fields |= {key: value for key, value in asdict(point).items() if key != "address"}
    fields["words"] = point.words
    if not point.writable:
        for key in ("min", "max", "default", "allowed", "command", "scope", "reindex"):
            fields.pop(key)
    return fields


def map_json(map_: Map) -> str:
    document = {
        "comment": SOURCE,
        "map_version": map_.version,
        "self_test": map_.self_test,
        "product": map_.product,
        "word_order": "high word first",
        "enums": {
            enum.name: {"text": enum.text, "values": _values(enum.values)}
            for enum in map_.enums.values()
        },
        "launch_inhibit": _values(map_.launch_inhibit),
        "coils": [
            {"reference": reference("coil", coil.address), **asdict(coil)} for coil in map_.coils
        ],
        "discrete_inputs": [
            {
                "address": flag.value,
                "reference": reference("discrete", flag.value),
                "name": flag.name,
                "text": flag.text,
            }
            for flag in map_.flags
        ],
        "registers": [
            {
                "block": block.name,
                "space": block.space,
                "text": block.text,
                "bench": block.bench,
                "mirrors": [asdict(mirror) for mirror in block.mirrors],
                "points": [_json_point(block, point) for point in block.points],
            }
            for block in map_.blocks
        ],
    }
    return json.dumps(document, indent=1) + "\n"


# ---- Node-RED, with node-red-contrib-modbus ------------------------------------------------------

_DECODE = """\
// name, first word, words, signed; the high word comes first
const points = {points};
msg.payload = Object.fromEntries(points.map(([name, first, count, signed]) => {{
    const words = msg.payload.slice(first, first + count);
    const value = words.reduce((sum, word) => sum * 65536 + word, 0);
    return [name, signed && words[0] >= 32768 ? value - 65536 ** count : value];
}}));
return msg;
"""
_FLAGS = """\
const names = {names};
msg.payload = Object.fromEntries(names.map((name, bit) => [name, msg.payload[bit]]));
return msg;
"""
_NODE_RED_PAUSE_MS = 10
_TAB, _CLIENT = "levelwind_tab", "levelwind_client"


def _client(map_: Map) -> dict:
    return {
        "id": _CLIENT,
        "type": "modbus-client",
        "name": map_.product["name"],
        "clienttype": "serial",
        "bufferCommands": True,
        "stateLogEnabled": False,
        "queueLogEnabled": False,
        "failureLogEnabled": True,
        "tcpHost": "127.0.0.1",
        "tcpPort": "502",
        "tcpType": "DEFAULT",
        "serialPort": PORT,
        "serialType": "RTU-BUFFERD",  # so spelt there
        "serialBaudrate": "19200",
        "serialDatabits": "8",
        "serialStopbits": "1",
        "serialParity": "even",
        "serialConnectionDelay": "100",
        "serialAsciiResponseStartDelimiter": "0x3A",
        "unit_id": "1",
        "commandDelay": str(_NODE_RED_PAUSE_MS),
        "clientTimeout": "1000",
        "reconnectOnTimeout": True,
        "reconnectTimeout": "2000",
        # On one line a request must wait for the answer to the one before, whoever that is to.
        "parallelUnitIdsAllowed": False,
    }


def _poll(name: str, kind: str, address: int, count: int, func: str, y: int) -> list[dict]:
    read, decode, show = (f"levelwind_{step}_{name}" for step in ("read", "decode", "show"))
    return [
        {
            "id": read,
            "type": "modbus-read",
            "z": _TAB,
            "name": name,
            "topic": name,
            "showStatusActivities": False,
            "logIOActivities": False,
            "showErrors": True,
            "unitid": "",
            "dataType": kind,
            "adr": str(address),
            "quantity": str(count),
            "rate": "",  # when all reads are known
            "rateUnit": "s",
            "delayOnStart": False,
            "startDelayTime": "",
            "server": _CLIENT,
            "useIOFile": False,
            "ioFile": "",
            "useIOForPayload": False,
            "emptyMsgOnFail": False,
            "x": 140,
            "y": y,
            "wires": [[decode], []],
        },
        {
            "id": decode,
            "type": "function",
            "z": _TAB,
            "name": "by name",
            "func": func,
            "outputs": 1,
            "x": 340,
            "y": y,
            "wires": [[show]],
        },
        {
            "id": show,
            "type": "debug",
            "z": _TAB,
            "name": name,
            "active": True,
            "tosidebar": True,
            "complete": "payload",
            "targetType": "msg",
            "x": 540,
            "y": y,
            "wires": [],
        },
    ]


def node_red_json(map_: Map) -> str:
    names = json.dumps([flag.name for flag in map_.flags])
    nodes = [
        {"id": _TAB, "type": "tab", "label": map_.product["name"], "info": SOURCE},
        _client(map_),
        *_poll("flags", "Input", 0, len(map_.flags), _FLAGS.format(names=names), 80),
    ]
    for row, run in enumerate(status_runs(map_)):
        points = [
            [point.name, point.address - run.first, point.words, point.type.startswith("i")]
            for point in run.points
        ]
        func = _DECODE.format(points=json.dumps(points))
        nodes += _poll(
            f"input_{run.first}", "InputRegister", run.first, run.count, func, 140 + 60 * row
        )
    cycle_s = _read_s(math.ceil(len(map_.flags) / 8), _NODE_RED_PAUSE_MS)
    cycle_s += sum(_read_s(2 * run.count, _NODE_RED_PAUSE_MS) for run in status_runs(map_))
    for node in nodes:
        if node["type"] == "modbus-read":
            node["rate"] = str(_interval_s(cycle_s))
    return json.dumps(nodes, indent=1) + "\n"


# ---- Home Assistant ------------------------------------------------------------------------------

_HA_PAUSE_MS = 5  # between two requests; a frame ends after 2 ms of silence
_HA_TYPES = {"u16": "uint16", "i16": "int16", "u32": "uint32", "i32": "int32", "i64": "int64"}


def _ha_common(name: str, address: int, input_type: str) -> dict:
    return {
        "name": f"levelwind {name.replace('_', ' ')}",
        "unique_id": f"levelwind_{name}",
        "slave": 1,
        "address": address,
        "input_type": input_type,
    }


def _ha_sensor(point: Point) -> dict:
    sensor = _ha_common(point.name, point.address, "input")
    sensor["data_type"] = _HA_TYPES[point.type]
    if point.unit:
        sensor["unit_of_measurement"] = point.unit
    return sensor


def home_assistant_yaml(map_: Map) -> str:
    # Not self_test and the like, which never change: the live status and what happened.
    points = [point for point in status_block(map_).points if point.address >= 100]
    binary_sensors = [_ha_common(flag.name, flag.value, "discrete_input") for flag in map_.flags]
    sensors = [_ha_sensor(point) for point in points]
    cycle_s = len(binary_sensors) * _read_s(1, _HA_PAUSE_MS)
    cycle_s += sum(_read_s(2 * point.words, _HA_PAUSE_MS) for point in points)
    for entity in (*binary_sensors, *sensors):
        entity["scan_interval"] = _interval_s(cycle_s)
    hub = {
        "name": "levelwind",
        "type": "serial",
        "method": "rtu",
        "port": PORT,
        "baudrate": BAUD,
        "bytesize": 8,
        "parity": "E",
        "stopbits": 1,
        "message_wait_milliseconds": _HA_PAUSE_MS,
        "binary_sensors": binary_sensors,
        "sensors": sensors,
    }
    head = f"""\
# {SOURCE}
# For configuration.yaml; set port and slave (the unit id).
# Home Assistant asks for each entity by itself: these take {cycle_s:.1f} s of the line, at {BAUD}.
# Delete what you do not show before you make scan_interval shorter.
"""
    return head + yaml.safe_dump({"modbus": [hub]}, sort_keys=False)


# ---- Telegraf, its plugin inputs.modbus ----------------------------------------------------------

GATEWAY = "127.0.0.1:1502"  # levelwind serve --modbus-tcp, or levelwind sim --tcp
_TELEGRAF_TYPES = {"u16": "UINT16", "i16": "INT16", "u32": "UINT32", "i32": "INT32", "i64": "INT64"}


def telegraf_conf(map_: Map) -> str:
    points = [point for point in status_block(map_).points if point.address >= 100]
    flags = [f'    {{ address={f.value}, name="{f.name}" }},' for f in map_.flags]
    values = [
        f'    {{ address={p.address}, name="{p.name}", type="{_TELEGRAF_TYPES[p.type]}" }},'
        for p in points
    ]
    return "\n".join(
        [
            f"# {SOURCE}",
            "# Through `levelwind serve --modbus-tcp`, which leaves the line to others, too.",
            "[[inputs.modbus]]",
            '  name = "levelwind"',
            f'  controller = "tcp://{GATEWAY}"',
            '  timeout = "2s"',
            '  configuration_type = "request"',
            *_telegraf_request("discrete", flags),
            *_telegraf_request("input", values),
            "",
        ]
    )


def _telegraf_request(register: str, fields: list[str]) -> list[str]:
    return [
        "  [[inputs.modbus.request]]",
        "  slave_id = 1",
        '  byte_order = "ABCD"',
        f'  register = "{register}"',
        '  measurement = "levelwind"',
        "  fields = [",
        *fields,
        "  ]",
    ]


# ---- W3C Web of Things: a Thing Description with the Modbus binding ------------------------------

# What a consumer is to make of the bytes: the binding's own word for it, and what a decoder of
# application/octet-stream goes by. Without `signed` that takes every number for a signed one.
_WOT_TYPES = {
    "u16": "xsd:unsignedShort",
    "i16": "xsd:short",
    "u32": "xsd:unsignedInt",
    "i32": "xsd:int",
    "i64": "xsd:long",
}


def _wot_form(op: str, entity: str, address: int, words: int = 0, type_: str = "") -> dict:
    """Of a bit, or of so many words. The entity says the function, of whose names there are two."""
    size = f"length={2 * words or 1};signed={str(type_.startswith('i')).lower()}"
    return {
        "op": op,
        "href": f"modbus+tcp://{GATEWAY}/1/{address}?quantity={words or 1}",
        "contentType": f"application/octet-stream;{size};byteSeq=BIG_ENDIAN",
        "modv:entity": entity,
        "modv:type": _WOT_TYPES[type_] if type_ else "xsd:boolean",
        "modv:zeroBasedAddressing": True,
        "modv:mostSignificantByte": True,
        "modv:mostSignificantWord": True,
    }


def wot_td_json(map_: Map) -> str:
    flags = {
        flag.name: {
            "type": "boolean",
            "description": flag.text,
            "readOnly": True,
            "forms": [_wot_form("readproperty", "DiscreteInput", flag.value)],
        }
        for flag in map_.flags
    }
    values = {}
    for point in status_block(map_).points:
        values[point.name] = {
            "type": "integer",
            "description": point.text,
            "readOnly": True,
            **({"unit": point.unit} if point.unit else {}),
            "forms": [
                _wot_form("readproperty", "InputRegister", point.address, point.words, point.type)
            ],
        }
    actions = {
        coil.name: {
            "description": coil.text,
            "input": {"type": "boolean", "const": True},
            "forms": [_wot_form("invokeaction", "Coil", coil.address)],
        }
        for coil in map_.coils
    }
    document = {
        "@context": [
            "https://www.w3.org/2022/wot/td/v1.1",
            {"modv": "https://www.w3.org/2019/wot/modbus#"},
        ],
        "@type": "Thing",
        "id": "urn:levelwind:1",
        "title": map_.product["name"],
        "description": f"{SOURCE} Through `levelwind serve --modbus-tcp`; actions: --write-from.",
        "securityDefinitions": {"nosec": {"scheme": "nosec"}},
        "security": "nosec",
        "properties": {**flags, **values},
        "actions": actions,
    }
    return json.dumps(document, indent=1) + "\n"
