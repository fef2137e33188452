# SPDX-License-Identifier: Apache-2.0
"""The map as an IEC 61131-3 library: data types, functions and function blocks, of which
emit_plc.py makes structured text and PLCopen XML.

What every compiler takes, matiec (OpenPLC, Beremiz) being the strictest: enumerations without
numbers or a base type, no global variables, no 64-bit types, array types with names, structures and
arrays into and out of function blocks only, plain STRING (80 characters in CODESYS and TwinCAT), no
access to bits.
"""

import textwrap
from dataclasses import dataclass, field

from emit_integrations import Run, status_block, status_runs
from map_model import FLAG, LAUNCH_INHIBIT, Enum, Map, Point, Value

STRING_MAX = 80
TYPES = {"u16": "UINT", "i16": "INT", "u32": "UDINT", "i32": "DINT"}
UNKNOWN = "unknown"  # the name for a code that the map does not have
NAMES = {0: "Identity", 100: "Status", 300: "Counters", 400: "CommandResult", 410: "LastError"}


@dataclass(frozen=True)
class Variable:
    name: str
    type: str
    text: str = ""
    initial: str = ""


@dataclass(frozen=True)
class EnumType:
    name: str
    text: str
    values: list[Value]


@dataclass(frozen=True)
class ArrayType:
    name: str
    text: str
    count: int
    base: str


@dataclass(frozen=True)
class StructType:
    name: str
    text: str
    members: list[Variable]


@dataclass(frozen=True)
class Pou:
    """A function, or a function block if it returns nothing."""

    name: str
    text: str
    returns: str
    inputs: list[Variable]
    body: list[str]
    outputs: list[Variable] = field(default_factory=list)
    local: list[Variable] = field(default_factory=list)


@dataclass(frozen=True)
class Library:
    types: list[EnumType | ArrayType | StructType]
    pous: list[Pou]


def _camel(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


def type_name(name: str) -> str:
    return f"Levelwind{_camel(name)}"


def member_name(enum: str, value: str) -> str:
    return f"LEVELWIND_{enum.upper()}_{value.upper()}"


def run_name(run: Run) -> str:
    return f"Levelwind{NAMES.get(run.first, f'Input{run.first}')}"


# ---- types ---------------------------------------------------------------------------------------


def _enum_type(enum: Enum) -> EnumType:
    assert UNKNOWN not in {value.name for value in enum.values}
    values = [Value(v.value, member_name(enum.name, v.name), v.text) for v in enum.values]
    values.append(Value(-1, member_name(enum.name, UNKNOWN), "A code that this map does not have"))
    return EnumType(type_name(enum.name), enum.text, values)


def _members(point: Point) -> list[Variable]:
    """One, or two halves of a 64-bit value."""
    text = point.text + (f" [{point.unit}]" if point.unit else "")
    if point.words == 4:
        return [
            Variable(f"{point.name}_high", "DINT", f"{text}: the upper 32 bits"),
            Variable(f"{point.name}_low", "UDINT", f"{text}: the lower 32 bits"),
        ]
    if point.enum:
        kind = type_name(point.enum)
    else:
        kind = {1: "WORD", 2: "DWORD"}[point.words] if point.bits else TYPES[point.type]
    return [Variable(point.name, kind, text)]


def _bools(name: str, text: str, bits: list[Value]) -> StructType:
    return StructType(name, text, [Variable(bit.name, "BOOL", bit.text) for bit in bits])


def _addresses(map_: Map) -> list[StructType]:
    registers = [
        Variable(p.name, "UINT", f"{block.space}, {p.type}", str(p.address))
        for block in map_.blocks
        if not block.bench
        for p in block.points
    ]
    coils = [Variable(coil.name, "UINT", coil.text, str(coil.address)) for coil in map_.coils]
    return [
        StructType("LevelwindAddresses", "0-based protocol addresses of the registers", registers),
        StructType("LevelwindCoils", "0-based protocol addresses of the coils", coils),
    ]


# ---- functions -----------------------------------------------------------------------------------


def _from_code(enum: Enum) -> Pou:
    name = f"{type_name(enum.name)}FromCode"
    body = ["CASE code OF"]
    body += [f"    {v.value}: {name} := {member_name(enum.name, v.name)};" for v in enum.values]
    body += ["ELSE", f"    {name} := {member_name(enum.name, UNKNOWN)};", "END_CASE;"]
    text = f"{enum.text}: what a register says"
    return Pou(name, text, type_name(enum.name), [Variable("code", "UINT")], body)


def _to_code(enum: Enum) -> Pou:
    name = f"{type_name(enum.name)}ToCode"
    body = [f"{name} := 65535;", "CASE value OF"]
    body += [f"    {member_name(enum.name, v.name)}: {name} := {v.value};" for v in enum.values]
    body += ["END_CASE;"]
    text = f"{enum.text}: what to write to a register; 65535 for a value that cannot be written"
    return Pou(name, text, "UINT", [Variable("value", type_name(enum.name))], body)


def _string(text: str) -> str:
    return "'" + text.replace("$", "$$").replace("'", "$'") + "'"


def _text(name: str, what: str, selector: Variable, labels: list[tuple[str, str]]) -> Pou:
    """A text for people, in as many lines as a STRING needs."""
    lines = {label: textwrap.wrap(text, STRING_MAX) for label, text in labels}
    body = [f"{name} := '';"]
    for number in range(max(len(wrapped) for wrapped in lines.values())):
        body += [f"IF line = {number + 1} THEN", f"    CASE {selector.name} OF"]
        body += [
            f"        {label}: {name} := {_string(wrapped[number])};"
            for label, wrapped in lines.items()
            if number < len(wrapped)
        ]
        body += ["    END_CASE;", "END_IF;"]
    line = Variable("line", "UINT", "A text longer than 80 characters goes on in line 2", "1")
    return Pou(name, f"{what}: a text for people", "STRING", [selector, line], body)


def _enum_text(enum: Enum) -> Pou:
    labels = [(member_name(enum.name, v.name), v.text) for v in enum.values]
    selector = Variable("value", type_name(enum.name))
    return _text(f"{type_name(enum.name)}Text", enum.text, selector, labels)


def _bit_text(name: str, what: str, bits: list[Value]) -> Pou:
    labels = [(str(bit.value), bit.text) for bit in bits]
    return _text(name, what, Variable("number", "UINT", "of the bit"), labels)


def _joined(words: list[int], source: str) -> str:
    """Words put together, high word first."""
    if len(words) == 1:
        return f"words[{words[0]}]"
    high, low = (f"WORD_TO_{source}(words[{word}])" for word in words)
    return f"SHL({high}, 16) OR {low}"


def _assignments(run: Run) -> list[str]:
    body = []
    for point in run.points:
        at = point.address - run.first
        members = _members(point)
        each = point.words // len(members)
        for i, member in enumerate(members):
            words = list(range(at + i * each, at + (i + 1) * each))
            source = "WORD" if each == 1 else "DWORD"
            value = _joined(words, source)
            if point.enum:
                value = f"{member.type}FromCode(WORD_TO_UINT({value}))"
            elif member.type != source:
                value = f"{source}_TO_{member.type}({value})"
            body.append(f"values.{member.name} := {value};")
    return body


def _bools_from(output: str, points: list[Point], bits: list[Value]) -> list[str]:
    """Each bit as a BOOL, of the registers that hold them one behind the other."""
    body = []
    for bit in bits:
        size = 16 * points[0].words
        kind = _members(points[0])[0].type
        word = f"values.{points[bit.value // size].name}"
        mask = f"{kind}#16#{1 << bit.value % size:X}"
        body.append(f"{output}.{bit.name} := ({word} AND {mask}) <> {kind}#0;")
    return body


def _from_words(run: Run, map_: Map) -> Pou:
    outputs = [Variable("values", run_name(run))]
    body = _assignments(run)
    for kind, name, bits in (
        (FLAG, "flags", map_.flags),
        (LAUNCH_INHIBIT, "inhibits", map_.launch_inhibit),
    ):
        points = [point for point in run.points if point.bits == kind]
        if points:
            outputs.append(Variable(name, type_name(name), "The same by name"))
            body += _bools_from(name, points, bits)
    words = Variable("words", f"{run_name(run)}Words", "As they were read")
    text = f"Values of FC04, address {run.first}, count {run.count}"
    return Pou(f"{run_name(run)}FromWords", text, "", [words], body, outputs)


# ---- the command function block ------------------------------------------------------------------

_COMMAND_TEXT = """\
Gives a command and follows it to its end. The master reads FC04, address 400, count 9 in every \
cycle and hands it on as `words`; at a rising edge of write_now it writes `code` to holding \
register 0, once. A command of which nothing is heard in time may have been done all the same."""

_COMMAND_BODY = """\
last(words := words);
timer(IN := phase = 1, PT := taken_within);
IF execute AND NOT was_execute AND phase = 0 THEN
    done := FALSE;
    error := NOT line_good;
    uncertain := FALSE;
    result := LEVELWIND_RESULT_NONE;
    reason := LEVELWIND_REASON_NONE;
    IF last.values.command_sequence = 65535 THEN
        own := 0;
    ELSE
        own := last.values.command_sequence + 1;
    END_IF;
    before := last.values.command_sequence;
    given := command;
    code := LevelwindCommandToCode(command);
    write_now := line_good;
    busy := line_good;
    IF line_good THEN
        phase := 1;
    END_IF;
ELSIF phase = 1 AND last.values.command_sequence <> before THEN
    write_now := FALSE;
    phase := 2;
END_IF;
IF phase = 2 AND last.values.command_sequence = own AND last.values.command_code = given THEN
    result := last.values.command_result;
    reason := last.values.command_reason;
    IF result <> LEVELWIND_RESULT_IN_PROGRESS THEN
        done := result = LEVELWIND_RESULT_DONE;
        error := NOT done;
        phase := 3;
    END_IF;
ELSIF phase = 2 OR (phase = 1 AND timer.Q) THEN
    error := TRUE;
    uncertain := TRUE;
    phase := 3;
END_IF;
IF phase > 0 AND phase < 3 AND NOT line_good THEN
    error := TRUE;
    uncertain := TRUE;
    phase := 3;
END_IF;
IF phase = 3 THEN
    write_now := FALSE;
    busy := FALSE;
    phase := 0;
END_IF;
was_execute := execute;"""


def _command_block() -> Pou:
    return Pou(
        "LevelwindGiveCommand",
        _COMMAND_TEXT,
        "",
        [
            Variable("execute", "BOOL", "A rising edge gives the command"),
            Variable("command", "LevelwindCommand"),
            Variable("words", "LevelwindCommandResultWords", "As they were read last"),
            Variable("line_good", "BOOL", "FALSE while no answers come: nothing is given", "TRUE"),
            Variable("taken_within", "TIME", "How long to wait for a sign of it", "T#5s"),
        ],
        _COMMAND_BODY.splitlines(),
        [
            Variable("write_now", "BOOL", "Its rising edge: write `code` to holding register 0"),
            Variable("code", "UINT", "What to write"),
            Variable("busy", "BOOL", "Given, not ended"),
            Variable("done", "BOOL", "Ended with success"),
            Variable("error", "BOOL", "Refused, failed or uncertain"),
            Variable("uncertain", "BOOL", "It may have been done, or be going on: see the status"),
            Variable("result", "LevelwindResult"),
            Variable("reason", "LevelwindReason", "Why it was refused or failed"),
        ],
        [
            Variable("was_execute", "BOOL"),
            Variable("before", "UINT"),
            Variable("own", "UINT", "The sequence number that is its own"),
            Variable("given", "LevelwindCommand"),
            Variable("phase", "UINT", "0 idle, 1 not seen yet, 2 taken, 3 ended"),
            Variable("last", "LevelwindCommandResultFromWords"),
            Variable("timer", "TON"),
        ],
    )


def library(map_: Map) -> Library:
    """Everything, each behind what it uses."""
    status = status_block(map_)
    told = {point.enum for point in status.points}
    blocks = [block for block in map_.blocks if not block.bench]
    written = {p.enum for block in blocks for p in block.points if p.writable}
    enums = [enum for enum in map_.enums.values() if enum.name in told | written]
    runs = status_runs(map_)
    inhibit = next(point for point in status.points if point.bits == LAUNCH_INHIBIT)
    types: list[EnumType | ArrayType | StructType] = [_enum_type(enum) for enum in enums]
    for run in runs:
        what = f"FC04, address {run.first}, count {run.count}"
        types.append(ArrayType(f"{run_name(run)}Words", f"As read: {what}", run.count, "WORD"))
        members = [member for point in run.points for member in _members(point)]
        types.append(StructType(run_name(run), what, members))
    types.append(_bools("LevelwindFlags", "The discrete inputs", map_.flags))
    types.append(_bools("LevelwindInhibits", inhibit.text, map_.launch_inhibit))
    types += _addresses(map_)

    pous = [_from_code(enum) for enum in enums]
    pous += [_to_code(enum) for enum in enums if enum.name in written]
    pous += [_enum_text(enum) for enum in enums if enum.name in told]
    pous.append(_bit_text("LevelwindInhibitText", inhibit.text, map_.launch_inhibit))
    pous.append(_bit_text("LevelwindFlagText", "A discrete input that is on", map_.flags))
    pous += [_from_words(run, map_) for run in runs]
    pous.append(_command_block())
    return Library(types, pous)
