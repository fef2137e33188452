# SPDX-License-Identifier: Apache-2.0
"""Runs IEC 61131-3 structured text as far as modbus_map/tags_iec61131.st goes: one statement in a
line, no loops. The values of enumerations are names, so that no number is taken for granted.
"""

import re
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

STRING_MAX = 80
TOKEN = re.compile(r"'(?:[^'$]|\$.)*'|\w+#[\w#]+|[A-Za-z_][\w.]*|:=|<>|[<>]=?|\S|\s+")
OPERATORS = {":=": "=", "=": "==", "<>": "!=", "NOT": "not", "TRUE": "True", "FALSE": "False"}
LOGICAL = {"AND": "and", "OR": "or"}
BITWISE = {"AND": "&", "OR": "|"}
SIZES = {"WORD": 16, "UINT": 16, "INT": 16, "DWORD": 32, "UDINT": 32, "DINT": 32}


def without_comments(text: str) -> str:
    return re.sub(r"\(\*.*?\*\)", "", text, flags=re.S)


def _converted(value: int, kind: str) -> int:
    size = SIZES[kind]
    assert 0 <= value < 1 << size
    return value - (1 << size) if kind in ("INT", "DINT") and value >> (size - 1) else value


CONVERSIONS: dict[str, Callable[..., Any]] = {
    f"{source}_TO_{target}": lambda value, target=target: _converted(value, target)
    for source in ("WORD", "DWORD")
    for target in SIZES
}
CONVERSIONS["SHL"] = lambda value, places: value << places & 0xFFFFFFFF


def _token(token: str, bitwise: bool) -> str:
    if token.startswith("'"):
        text = re.sub(r"\$(.)", r"\1", token[1:-1])
        assert len(text) <= STRING_MAX, text
        return repr(text)
    if token.startswith("T#"):
        return str(1000 * int(token[2:].removesuffix("s")))
    if "#" in token:
        _, *base, digits = token.split("#")
        return str(int(digits, int(base[0]) if base else 10))
    return OPERATORS.get(token, (BITWISE if bitwise else LOGICAL).get(token, token))


def _expression(text: str) -> str:
    bitwise = "#16#" in text or "SHL(" in text
    return "".join(_token(token, bitwise) for token in TOKEN.findall(text))


def _statement(text: str) -> str:
    target, assign, value = text.strip().removesuffix(";").partition(" := ")
    if assign and "(" not in target:
        return f"{target} = {_expression(value)}"
    return _expression(text.strip().removesuffix(";"))


def _python(body: list[str]) -> str:
    """Python source of statements. A CASE becomes one if after the other."""
    made: list[str] = []
    blocks: list[
        tuple[str, str]
    ] = []  # what is open: "if", "case" with its selector, "else" of one

    def put(text: str, less: int = 0) -> None:
        depth = sum(kind != "case" for kind, _ in blocks) - less
        made.append("    " * depth + text)

    for raw in body:
        line = raw.strip()
        inside, selector = blocks[-1] if blocks else ("", "")
        if match := re.fullmatch(r"CASE (.*) OF", line):
            blocks.append(("case", _expression(match[1])))
            put("if False: pass")
        elif match := re.fullmatch(r"IF (.*) THEN", line):
            put(f"if {_expression(match[1])}:")
            blocks.append(("if", ""))
        elif match := re.fullmatch(r"ELSIF (.*) THEN", line):
            put(f"elif {_expression(match[1])}:", less=1)
        elif line == "ELSE" and inside == "case":
            put("else:")
            blocks[-1] = ("else", "")
        elif line == "ELSE":
            put("else:", less=1)
        elif line in ("END_IF;", "END_CASE;"):
            blocks.pop()
        elif (match := re.fullmatch(r"([\w.]+): (.*;)", line)) and inside == "case":
            put(f"elif {selector} == {_expression(match[1])}: {_statement(match[2])}")
        else:
            put(_statement(line))
    assert not blocks
    return "\n".join(made) + "\n"


class Block:
    """An instance of a function block, or a function: its variables, and its body as a call."""

    def __init__(self, name: str, variables: dict[str, Any], code: Any) -> None:
        self._name = name
        self._scope = variables
        self._code = code

    def __call__(self, *values: Any, **inputs: Any) -> Any:
        named = dict(zip(self._scope, values, strict=False)) | inputs
        assert named.keys() <= self._scope.keys()
        self._scope.update(named)
        exec(self._code, self._scope)
        return self._scope.get(self._name)

    def __getattr__(self, name: str) -> Any:
        return self._scope[name]


class Timer:
    """TON, by the program's clock."""

    def __init__(self, program: "Program") -> None:
        self._program = program
        self._since_ms: int | None = None
        self.Q = False

    def __call__(self, IN: bool, PT: int) -> None:  # noqa: N803 - as the standard has it
        if not IN:
            self._since_ms = None
        elif self._since_ms is None:
            self._since_ms = self._program.now_ms
        self.Q = self._since_ms is not None and self._program.now_ms - self._since_ms >= PT


class Program:
    """What the text declares. `now_ms` is the time of its timers."""

    def __init__(self, text: str) -> None:
        text = without_comments(text)
        self.now_ms = 0
        self.enums: dict[str, list[str]] = {}
        self.arrays: dict[str, int] = {}
        self.structures: dict[str, list[tuple[str, str, str]]] = {}
        for name, body in re.findall(r"^TYPE\s+(\w+) : (.*?);\s*END_TYPE", text, re.M | re.S):
            if body.startswith("("):
                self.enums[name] = re.findall(r"\w+", body)
            elif match := re.fullmatch(r"ARRAY\[0\.\.(\d+)\] OF WORD", body):
                self.arrays[name] = int(match[1]) + 1
            else:
                self.structures[name] = self._variables(body)
        self._pous = {
            name: (returns, rest)
            for _, name, returns, rest in re.findall(
                r"^(FUNCTION(?:_BLOCK)?) (\w+)(?: : (\w+))?\n(.*?)^END_\1$", text, re.M | re.S
            )
        }
        self._globals: dict[str, Any] = dict(CONVERSIONS)
        self._globals |= {member: member for members in self.enums.values() for member in members}
        for name, (returns, _) in self._pous.items():
            if returns:
                self._globals[name] = self._function(name)

    @staticmethod
    def _variables(text: str) -> list[tuple[str, str, str]]:
        return re.findall(r"^\s+(\w+) : (\w+)(?: := ([^;]+))?;", text, re.M)

    def _initial(self, kind: str, initial: str = "") -> Any:
        if initial:
            return eval(_expression(initial))
        if kind in self.structures:
            members = self.structures[kind]
            return SimpleNamespace(**{name: self._initial(*rest) for name, *rest in members})
        if kind in self._pous:
            return self.instance(kind)
        if kind in self.arrays:
            return [0] * self.arrays[kind]
        plain = {"BOOL": False, "STRING": "", "TON": Timer(self)}
        return self.enums[kind][0] if kind in self.enums else plain.get(kind, 0)

    def instance(self, name: str) -> Block:
        """A function block (or function) of its own, as declared."""
        returns, rest = self._pous[name]
        declarations, _, body = rest.rpartition("END_VAR\n")
        variables = {n: self._initial(*kind) for n, *kind in self._variables(declarations)}
        if returns:
            variables[name] = self._initial(returns)
        source = _python(body.splitlines())
        return Block(name, variables | self._globals, compile(source, name, "exec"))

    def _function(self, name: str) -> Callable[..., Any]:
        def call(*values: Any, **inputs: Any) -> Any:
            return self.instance(name)(*values, **inputs)

        return call

    def __getattr__(self, name: str) -> Callable[..., Any]:
        return self._globals[name]
