"""For programs of integrators: JSON, Node-RED, Home Assistant, IEC 61131-3. All but the JSON leave
out the bench, which hardware does not have.
"""

import json
import textwrap
from dataclasses import asdict, dataclass

import yaml
from emit_documents import reference
from map_model import Block, Map, Point, Value

SOURCE = "Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py. Do not edit."
READ_MAX = 125
POLL_S = 1
PORT = "/dev/ttyUSB0"


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
        "commandDelay": "10",
        "clientTimeout": "1000",
        "reconnectOnTimeout": True,
        "reconnectTimeout": "2000",
        "parallelUnitIdsAllowed": True,
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
            "rate": str(POLL_S),
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
    return json.dumps(nodes, indent=1) + "\n"


# ---- Home Assistant ------------------------------------------------------------------------------

_HA_TYPES = {"u16": "uint16", "i16": "int16", "u32": "uint32", "i32": "int32", "i64": "int64"}


def _ha_common(name: str, address: int, input_type: str) -> dict:
    return {
        "name": f"levelwind {name.replace('_', ' ')}",
        "unique_id": f"levelwind_{name}",
        "slave": 1,
        "address": address,
        "input_type": input_type,
        "scan_interval": POLL_S,
    }


def _ha_sensor(point: Point) -> dict:
    sensor = _ha_common(point.name, point.address, "input")
    sensor["data_type"] = _HA_TYPES[point.type]
    if point.unit:
        sensor["unit_of_measurement"] = point.unit
    return sensor


def home_assistant_yaml(map_: Map) -> str:
    hub = {
        "name": "levelwind",
        "type": "serial",
        "method": "rtu",
        "port": PORT,
        "baudrate": 19200,
        "bytesize": 8,
        "parity": "E",
        "stopbits": 1,
        "binary_sensors": [
            _ha_common(flag.name, flag.value, "discrete_input") for flag in map_.flags
        ],
        # Not self_test and the like, which never change: the live status and what happened.
        "sensors": [
            _ha_sensor(point) for point in status_block(map_).points if point.address >= 100
        ],
    }
    head = f"# {SOURCE}\n# For configuration.yaml; set port and slave (the unit id).\n"
    return head + yaml.safe_dump({"modbus": [hub]}, sort_keys=False)


# ---- IEC 61131-3 structured text -----------------------------------------------------------------

_ST_TYPES = {"u16": "UINT", "i16": "INT", "u32": "UDINT", "i32": "DINT", "i64": "LINT"}
_ST_FROM = {"u16": "WORD", "i16": "WORD", "u32": "DWORD", "i32": "DWORD", "i64": "LWORD"}


def _camel(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


def _st_comment(text: str) -> str:
    return text.replace("*)", "* )")


def _st_enum(name: str, values: list[Value]) -> str:
    prefix = f"LEVELWIND_{name.upper()}"
    body = ",\n".join(f"    {prefix}_{value.name.upper()} := {value.value}" for value in values)
    return f"TYPE Levelwind{_camel(name)} :\n(\n{body}\n) UINT;\nEND_TYPE\n"


def _st_bits(name: str, values: list[Value]) -> str:
    rows = "".join(
        f"    LEVELWIND_{name.upper()}_{value.name.upper()} : UINT := {value.value};"
        f" (* {_st_comment(value.text)} *)\n"
        for value in values
    )
    return f"VAR_GLOBAL CONSTANT (* bit numbers of {name} *)\n{rows}END_VAR\n"


def _st_struct(run: Run) -> str:
    rows = "".join(
        f"    {point.name} : {_ST_TYPES[point.type]};"
        f" (* {_st_comment(point.text)}{f' [{point.unit}]' if point.unit else ''} *)\n"
        for point in run.points
    )
    return f"TYPE LevelwindInput{run.first} :\nSTRUCT\n{rows}END_STRUCT\nEND_TYPE\n"


def _st_value(point: Point, first: int) -> str:
    """The words of a value put together, high word first."""
    at = point.address - first
    source = _ST_FROM[point.type]
    if point.words == 1:
        joined = f"words[{at}]"
    else:
        parts = []
        for i in range(point.words):
            shift = 16 * (point.words - 1 - i)
            word = f"WORD_TO_{source}(words[{at + i}])"
            parts.append(f"SHL({word}, {shift})" if shift else word)
        joined = " OR ".join(parts)
    return f"{source}_TO_{_ST_TYPES[point.type]}({joined})"


def _st_function(run: Run) -> str:
    name = f"LevelwindInput{run.first}"
    rows = "".join(
        f"{name}FromWords.{point.name} := {_st_value(point, run.first)};\n" for point in run.points
    )
    return (
        f"(* FC04, address {run.first}, count {run.count} *)\n"
        f"FUNCTION {name}FromWords : {name}\n"
        f"VAR_INPUT\n    words : ARRAY[0..{run.count - 1}] OF WORD;\nEND_VAR\n"
        f"{rows}END_FUNCTION\n"
    )


def _st_addresses(map_: Map) -> str:
    rows = ""
    for block in map_.blocks:
        if block.bench:
            continue
        for point in block.points:
            rows += (
                f"    LEVELWIND_ADDRESS_{point.name.upper()} : UINT := {point.address};"
                f" (* {block.space}, {point.type} *)\n"
            )
    for coil in map_.coils:
        rows += f"    LEVELWIND_COIL_{coil.name.upper()} : UINT := {coil.address};\n"
    return f"VAR_GLOBAL CONSTANT (* 0-based protocol addresses *)\n{rows}END_VAR\n"


def structured_text(map_: Map) -> str:
    head = f"""\
{SOURCE} Modbus map of {map_.product["name"]}, version {map_.version}, for CODESYS and other
IEC 61131-3 systems: addresses, enumerations, and for each run of input registers a structure and
the function that fills it from the words as they were read."""
    used = {point.enum for point in status_block(map_).points}
    used |= {point.enum for block in map_.blocks if not block.bench for point in block.points}
    parts = [
        "(*\n" + "\n".join(textwrap.wrap(head, 96)) + "\n*)\n",
        _st_addresses(map_),
        _st_bits("flag", map_.flags),
        _st_bits("launch_inhibit", map_.launch_inhibit),
    ]
    parts += [_st_enum(enum.name, enum.values) for enum in map_.enums.values() if enum.name in used]
    for run in status_runs(map_):
        parts += [_st_struct(run), _st_function(run)]
    return "\n".join(parts)
