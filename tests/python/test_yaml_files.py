# SPDX-License-Identifier: Apache-2.0
"""Numbers and names in YAML are what stands there, by the rule of the command line."""

import re
from pathlib import Path

import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from levelwind.errors import ToolError
from levelwind.files import backups, script, yaml_file
from levelwind.line.points import PARAMETERS, parse_assignments
from levelwind.map_table import MAP_VERSION, POINTS
from python.test_script import FakeDevice, load, run

# What YAML 1.2 takes for a number, from its core schema (yaml.org/spec/1.2.2, 10.3.2).
NUMBER_1_2 = re.compile(
    r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|0o[0-7]+|0x[0-9a-fA-F]+"
)


def backup(folder: Path, changes: dict[str, str]) -> Path:
    """A backup with some values written as given."""
    values = {p.name: p.enum(p.default).label if p.enum else str(p.default) for p in PARAMETERS}
    lines = [f"levelwind_backup: {MAP_VERSION}", "firmware: 1.2.3", "parameters:"]
    lines += [f"  {name}: {value}" for name, value in (values | changes).items()]
    path = folder / "backup.yaml"
    path.write_text("\n".join(lines) + "\n")
    return path


def outcome(read, *arguments: object) -> object:
    """What it gives, or that it refuses."""
    try:
        return read(*arguments)
    except ToolError:
        return "refused"


def by_command_line(name: str, text: str) -> int:
    return parse_assignments([f"{name}={text}"])[name]


def by_script(folder: Path, name: str, text: str) -> int:
    device = FakeDevice()
    run(load(folder, f"- set:\n    {name}: {text}\n"), device)
    return device.log[0][name]


def by_condition(folder: Path, name: str, text: str) -> int:
    (step,) = load(folder, f"- expect: {{{name}: {text}}}\n")
    run([step], FakeDevice(**{name: by_command_line(name, text)}))
    return by_command_line(name, text)


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("lock_code", "012345", 12345),
        ("pitch_um", "012000", 12000),
        ("pitch_um", "00_12000", "refused"),
        ("pitch_um", "+12000", 12000),
        ("pitch_um", "0x2EE0", 12000),
        ("pitch_um", "0o27340", "refused"),
        ("pitch_um", "3:20:00", "refused"),
        ("pitch_um", "12000.0", "refused"),
        ("pitch_um", "1.2e4", "refused"),
        ("pitch_um", "12,000", "refused"),
        ("pitch_um", "true", "refused"),
        ("pitch_um", "9" * 5000, "refused"),
        ("reversal_minus_um", "-080000", -80000),
        ("line_format", "8E1", 0),
        ("line_format", "80.0", "refused"),
        ("index_switch", "01", 1),
        ("index_switch", "off", "refused"),
    ],
)
def test_a_number_is_the_same_everywhere(
    tmp_path: Path, name: str, text: str, value: object
) -> None:
    assert outcome(by_command_line, name, text) == value
    for written in (text, f"'{text}'", f'"{text}"', f"!!int {text}"):
        changes = {name: written}
        assert outcome(by_script, tmp_path, name, written) == value
        restored = outcome(backups.read, backup(tmp_path, changes), "1.2.3")
        assert (restored if restored == "refused" else restored[name]) == value
    assert outcome(by_condition, tmp_path, name, text) == value


TEXTS = st.one_of(
    st.integers(-(2**33), 2**33).map(str),
    st.from_regex(r"[-+]?0*[0-9]{1,6}", fullmatch=True),
    st.from_regex(r"[-+]?0[xob][0-9a-fA-F]{1,6}", fullmatch=True),
    st.from_regex(r"[0-9]{1,3}([_:.][0-9]{1,3}){1,2}", fullmatch=True),
    st.from_regex(r"[0-9]{1,3}[eE][-+]?[0-9]", fullmatch=True),
    st.sampled_from(["yes", "no", "on", "off", "true", "~x", ".inf", ".nan", "2026-11-29"]),
)


@settings(max_examples=500, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(TEXTS)
def test_any_number_is_the_same_everywhere(tmp_path: Path, text: str) -> None:
    """And what int() reads of digits without a prefix, it is."""
    for name in ("pitch_um", "reversal_minus_um"):
        there = outcome(by_command_line, name, text)
        assert outcome(by_script, tmp_path, name, text) == there
        if re.fullmatch(r"[-+]?[0-9]+", text):
            point = POINTS[name]
            inside = point.min <= int(text) <= point.max
            assert there == (int(text) if inside else "refused")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("- set:\n    pitch_um: 1000\n    pitch_um: 2000\n", "line 3: pitch_um stands twice"),
        ("- set: {pitch_um: 1000,\n    'pitch_um': 2000}\n", "line 2: pitch_um stands twice"),
        ("- apply\n- set:\n    114: 12000\n", "line 3, step 2: There is no register '114'"),
        ("- set: {114: 12000}\n", "line 1, step 1: There is no register '114'"),
        ("- set: {true: 12000}\n", "There is no register 'true'"),
        ("- set: {1.5: 12000}\n", "There is no register '1.5'"),
        ("- set: {~: 12000}\n", "line 1: a name is missing"),
        ("- set: {[1]: 12000}\n", "line 1: a name must be one word"),
        ("- apply\n- set:\n    pitch_um: 9\n", "line 3, step 2: pitch_um=9 is outside"),
        ("- set:\n    pitch_um: [1]\n", "line 2, step 1: pitch_um="),
        ("- expect:\n    los: 2\n", "line 2, step 1: los: 2 is none of false, true"),
        ("- factory: [all]\n", "line 1, step 1: factory: give"),
        ("- mode: {a: b}\n", "step 1: mode="),
        ("- jog:\n    direction: plus\n    seconds: 1:30\n", "line 3, step 1: jog: seconds"),
        ("- 5\n", "line 1, step 1: unknown step '5'"),
        ("- note: a\x07b\n", "script.yaml: the character 0x07"),
        ("- note: a\0b\n", "line 1: a zero byte"),
        ("- a: b: c\n", "line 1: mapping values"),
        ("- !!set x\n", "line 1: could not determine a constructor"),
        ("- !!map x\n", "line 1: expected a mapping node"),
        ("- !!binary MDEy\n", "line 1: could not determine a constructor"),
        ("- *x\n", "line 1: found undefined alias"),
        ("[" * 20_000, "script.yaml: brackets within brackets"),
    ],
)
def test_a_mistake_is_told_with_its_line(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ToolError) as refused:
        load(tmp_path, text)
    assert said in str(refused.value)
    assert "script.yaml" in str(refused.value)
    assert len(str(refused.value).splitlines()) == 1


def test_a_doubled_parameter_of_a_backup_is_refused_with_its_line(tmp_path: Path) -> None:
    path = backup(tmp_path, {})
    lines = path.read_text().splitlines()
    path.write_text("\n".join([*lines, "  pitch_um: 11000"]) + "\n")
    with pytest.raises(ToolError, match=rf"line {len(lines) + 1}: pitch_um stands twice.*line \d"):
        backups.read(path, "1.2.3")


def test_a_wrong_value_of_a_backup_is_told_with_its_line(tmp_path: Path) -> None:
    path = backup(tmp_path, {"pitch_um": "9"})
    line = next(i for i, t in enumerate(path.read_text().splitlines(), 1) if "pitch_um: 9" in t)
    with pytest.raises(ToolError, match=rf"backup\.yaml, line {line}: pitch_um=9 is outside"):
        backups.read(path, "1.2.3")


class Stored(FakeDevice):
    """Answers with the factory set."""

    def read(self, points):
        return {p.name: p.default for p in points}

    def read_names(self, *names: str) -> dict[str, int]:
        return dict.fromkeys(names, 1)


def test_a_backup_reads_the_same_in_every_version_of_yaml(tmp_path: Path) -> None:
    path = tmp_path / "backup.yaml"
    assert backups.write(Stored(), "staged", path) is None
    text = path.read_text()
    assert "line_format: '8E1'" in text
    for line in text.splitlines():
        value = line.partition(": ")[2]
        if NUMBER_1_2.fullmatch(value):
            assert re.fullmatch(r"-?[0-9]+", value), line
    assert yaml.safe_load(text)["parameters"]["line_format"] == "8E1"
    expected = {p.name: p.default for p in PARAMETERS}
    assert backups.read(path, "1.1.1") == expected
    path.write_text(text.replace("'8E1'", "8E1"))
    assert backups.read(path, "1.1.1") == expected


def test_a_backup_keeps_the_file_that_is_there(tmp_path: Path) -> None:
    path = tmp_path / "backup.yaml"
    path.write_text("old")
    assert backups.write(Stored(), "staged", path) == tmp_path / "backup.yaml.bak"
    assert (tmp_path / "backup.yaml.bak").read_text() == "old"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["backup.yaml", "backup.yaml.bak"]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252", "utf-16"])
def test_notes_in_any_encoding(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "script.yaml"
    path.write_bytes("- note: größer\n".encode(encoding))
    assert [step.text for step in script.load(path)] == ["# größer"]


def test_what_is_dumped_loads() -> None:
    texts = ["off", "8E1", "012", "1:30", "", "~", "[x]", "ü", "2026-11-29 12:00:00", "a: b"]
    assert yaml.safe_load(yaml_file.dump(texts)) == texts
