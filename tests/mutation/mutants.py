# SPDX-License-Identifier: Apache-2.0
"""The mutants of C sources: where they are, what they are called, and the text that holds them all.

clang's tree says where expressions and statements are and of which type. The rewritten source
evaluates each operand once, as the original does, and picks a variant by the site's switch
(mutation.h). What stands in macros, in constant expressions and in LW_REQUIRE() is left alone.
"""

import itertools
import re
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from clang.cindex import Cursor, CursorKind, Index, TypeKind

RELATIONS = {
    "<": ["<=", ">="],
    "<=": ["<", ">"],
    ">": [">=", "<="],
    ">=": [">", "<"],
    "==": ["!="],
    "!=": ["=="],
}
ARITHMETIC = {
    "+": ["-"],
    "-": ["+"],
    "*": ["/"],
    "/": ["*"],
    "%": ["/"],
    "<<": [">>"],
    ">>": ["<<"],
    "&": ["|"],
    "|": ["&"],
    "^": ["|"],
}
LOGICAL = {"&&": "||", "||": "&&"}
SITES_OF_FILE_MAX = 512  # numbers of its own for each file: a change rebuilds little else
SITES_MAX = 32768  # of mutation.c
NAME_MAX = 60  # characters of an expression in a mutant's name
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
LITERAL = re.compile(r"(0[xX][0-9a-fA-F]+|[0-9]+)[uUlL]*$")
WRAPPERS = (CursorKind.UNEXPOSED_EXPR, CursorKind.PAREN_EXPR)
EXPRESSION_STATEMENTS = (
    CursorKind.CALL_EXPR,
    CursorKind.BINARY_OPERATOR,
    CursorKind.COMPOUND_ASSIGNMENT_OPERATOR,
    CursorKind.UNARY_OPERATOR,
)


@dataclass
class Site:
    """One place in a source, with its variants."""

    begin: int
    end: int
    operands: list[tuple[int, int]]  # parts of it that are rewritten themselves
    render: Callable[[int, list[str]], str]  # from the site's number and its operands' texts
    variants: list[str]  # what each says in the mutant's name, "a < b => a <= b"
    function: str
    inner: list["Site"] = field(default_factory=list)


@dataclass(frozen=True)
class Mutant:
    """One variant of one site."""

    name: str  # motion/law.c:dwell_of: minus => !minus
    folder: str
    file: Path
    line: int
    switch: str  # "site,variant", as mutation.c knows it


@cache
def compiler_includes() -> list[str]:
    """Where the compiler's own headers are (stddef.h): libclang from PyPI brings none."""
    run = ["clang", "-print-resource-dir"]
    folder = subprocess.run(run, capture_output=True, text=True, check=True).stdout.strip()
    return ["-isystem", f"{folder}/include"]


def short(text: str) -> str:
    """An expression on one line, cut in the middle where it is long."""
    text = " ".join(COMMENT.sub(" ", text).split())
    half = NAME_MAX // 2
    return text if len(text) <= NAME_MAX else f"{text[:half]}...{text[-half:]}"


def strip(cursor: Cursor) -> Cursor:
    """What parentheses and implicit conversions are about."""
    while cursor.kind in WRAPPERS:
        children = list(cursor.get_children())
        if len(children) != 1:
            break
        cursor = children[0]
    return cursor


class Source:
    """One file, and its sites."""

    def __init__(self, path: Path, include: list[Path]) -> None:
        self.text = path.read_text()
        if not self.text.isascii():
            raise SystemExit(f"{path}: only ASCII, offsets are in bytes")
        self.sites: list[Site] = []
        self.function = ""
        arguments = ["-x", "c", "-std=c11", "-DLW_CHECK_REQUIREMENTS", *compiler_includes()]
        unit = Index.create().parse(str(path), args=[*arguments, *(f"-I{i}" for i in include)])
        if errors := [str(d) for d in unit.diagnostics if d.severity >= 3]:
            raise SystemExit(f"{path}: clang does not understand it:\n" + "\n".join(errors))
        for cursor in unit.cursor.get_children():
            if (
                cursor.kind == CursorKind.FUNCTION_DECL
                and cursor.is_definition()
                and cursor.location.file.name == str(path)
            ):
                self.function = cursor.spelling
                for child in cursor.get_children():
                    if child.kind == CursorKind.COMPOUND_STMT:
                        self.visit(child, child)

    # ---- finding sites ---------------------------------------------------------------------------

    def range(self, cursor: Cursor) -> tuple[int, int]:
        return cursor.extent.start.offset, cursor.extent.end.offset

    def said(self, cursor: Cursor) -> str:
        begin, end = self.range(cursor)
        return self.text[begin:end]

    def between(self, left: Cursor, right: Cursor) -> str:
        """The operator between two operands; nothing sensible where a macro hides it."""
        return COMMENT.sub("", self.text[self.range(left)[1] : self.range(right)[0]]).strip()

    def add(
        self,
        at: Cursor | tuple[int, int],
        operands: list[Cursor | tuple[int, int]],
        render: Callable[[int, list[str]], str],
        variants: list[str],
    ) -> None:
        begin, end = at if isinstance(at, tuple) else self.range(at)
        ranges = [o if isinstance(o, tuple) else self.range(o) for o in operands]
        self.sites.append(Site(begin, end, ranges, render, variants, self.function))

    def visit(self, cursor: Cursor, parent: Cursor) -> None:
        """Add the sites of a statement or an expression, and of what is in it."""
        kind = cursor.kind
        children = list(cursor.get_children())
        text = self.said(cursor)
        if text.startswith("LW_REQUIRE") or kind in (
            CursorKind.CXX_UNARY_EXPR,  # sizeof
            CursorKind.STATIC_ASSERT,
        ):
            return
        if kind == CursorKind.VAR_DECL:
            equals = self.text.find("=", cursor.location.offset, self.range(cursor)[1])
            static = re.match(r"static\b", self.text[self.range(cursor)[0] :])
            children = [c for c in children if not static and 0 <= equals < self.range(c)[0]]
        elif kind == CursorKind.CASE_STMT:
            children = children[1:]
        self.statements(cursor, children)
        self.expressions(cursor, children, parent)
        around = parent if kind in WRAPPERS else cursor
        for child in children:
            self.visit(child, around)

    def expressions(self, cursor: Cursor, children: list[Cursor], parent: Cursor) -> None:
        """What a cursor itself calculates or decides by."""
        match cursor.kind:
            case CursorKind.BINARY_OPERATOR:
                self.binary(cursor, *children)
            case CursorKind.COMPOUND_ASSIGNMENT_OPERATOR:
                self.compound(cursor, *children)
            case CursorKind.UNARY_OPERATOR:
                self.unary(cursor, children[0])
            case CursorKind.INTEGER_LITERAL:
                self.literal(cursor, parent)
            case CursorKind.IF_STMT | CursorKind.WHILE_STMT | CursorKind.CONDITIONAL_OPERATOR:
                self.condition(children[0])
            case CursorKind.DO_STMT:
                self.condition(children[-1])
            case CursorKind.FOR_STMT:
                self.for_condition(cursor, children)
            case CursorKind.RETURN_STMT if children:
                if strip(children[0]).type.get_canonical().kind == TypeKind.BOOL:
                    self.condition(children[0])

    def statements(self, cursor: Cursor, children: list[Cursor]) -> None:
        """Statements that can be left out."""
        kind = cursor.kind
        if kind not in (CursorKind.COMPOUND_STMT, CursorKind.CASE_STMT, CursorKind.DEFAULT_STMT):
            return
        for child in children:
            is_return = child.kind == CursorKind.RETURN_STMT and not list(child.get_children())
            if (
                is_return
                or child.kind in EXPRESSION_STATEMENTS
                or child.kind in (CursorKind.BREAK_STMT, CursorKind.CONTINUE_STMT)
            ):
                begin, end = self.range(child)
                semicolon = re.compile(r"\s*;").match(self.text, end)
                said = self.text[begin:end]
                if semicolon is None or said.startswith(("LW_REQUIRE", "(void)")):
                    continue
                self.add(
                    (begin, semicolon.end()),
                    [(begin, end)],
                    lambda n, o: f"if (!LW_ON({n})) {{ {o[0]}; }}",
                    [f"{short(said)}; => left out"],
                )

    def for_condition(self, cursor: Cursor, children: list[Cursor]) -> None:
        begin = self.range(cursor)[0]
        for child in children[:-1]:
            if self.text.count(";", begin, self.range(child)[0]) == 1:
                self.condition(child)

    def condition(self, cursor: Cursor) -> None:
        """What a branch depends on, the other way; what is a comparison has its own variants."""
        inner = strip(cursor)
        text = self.said(cursor)
        operands = list(inner.get_children())
        if inner.kind == CursorKind.BINARY_OPERATOR and len(operands) == 2:
            operator = self.between(*operands)
            if operator in RELATIONS or operator in LOGICAL:
                return
        if inner.kind == CursorKind.INTEGER_LITERAL or text.startswith("!"):
            return
        self.add(
            cursor,
            [cursor],
            lambda n, o: f"({{ _Bool lw_a{n} = ({o[0]}); LW_VALUE({n}, lw_a{n}, !lw_a{n}); }})",
            [f"{short(text)} => !"],
        )

    def binary(self, cursor: Cursor, left: Cursor, right: Cursor) -> None:
        operator = self.between(left, right)
        names = (short(self.said(left)), short(self.said(right)))
        if operator in LOGICAL:
            self.condition(left)
            self.condition(right)
            is_or = int(operator == "||")
            self.add(
                cursor,
                [left, right],
                lambda n, o: (
                    f"({{ _Bool lw_a{n} = ({o[0]}), lw_o{n} = {is_or} ^ LW_ON({n});"
                    f" lw_a{n} == lw_o{n} ? lw_o{n} : (_Bool)({o[1]}); }})"
                ),
                [f"{names[0]} {operator} {names[1]} => {LOGICAL[operator]}"],
            )
            return
        others = {**RELATIONS, **ARITHMETIC}.get(operator)
        pointers = TypeKind.POINTER in (left.type.kind, right.type.kind)
        if others is None or (pointers and operator in ARITHMETIC):
            return

        def render(n: int, o: list[str]) -> str:
            variants = [calculate(other, f"lw_a{n}", f"lw_b{n}") for other in others]
            return (
                f"({{ __auto_type lw_a{n} = ({o[0]}); __auto_type lw_b{n} = ({o[1]});"
                f" LW_VALUE({n}, lw_a{n} {operator} lw_b{n}, {', '.join(variants)}); }})"
            )

        names_of = [f"{names[0]} {operator} {names[1]} => {other}" for other in others]
        self.add(cursor, [left, right], render, names_of)

    def compound(self, cursor: Cursor, left: Cursor, right: Cursor) -> None:
        operator = self.between(left, right)
        others = ARITHMETIC.get(operator[:-1])
        if others is None or left.type.kind == TypeKind.POINTER:
            return
        other = others[0]
        self.add(
            cursor,
            [left, right],
            lambda n, o: (
                f"({{ __auto_type lw_a{n} = &({o[0]}); __auto_type lw_b{n} = ({o[1]});"
                f" LW_ON({n}) ? (*lw_a{n} = {calculate(other, f'*lw_a{n}', f'lw_b{n}')})"
                f" : (*lw_a{n} {operator} lw_b{n}); }})"
            ),
            [f"{short(self.said(cursor))} => {other}="],
        )

    def unary(self, cursor: Cursor, operand: Cursor) -> None:
        text = self.said(cursor)
        name = short(text)
        if text.startswith("!"):
            self.condition(operand)
            return
        if (step := text[:2] if text[:2] in ("++", "--") else text[-2:]) in ("++", "--"):
            if operand.type.kind == TypeKind.POINTER:
                return
            other = "--" if step == "++" else "++"
            prefix = text.startswith(step)

            def render(n: int, o: list[str]) -> str:
                ways = [f"{s}(*lw_a{n})" if prefix else f"(*lw_a{n}){s}" for s in (other, step)]
                return (
                    f"({{ __auto_type lw_a{n} = &({o[0]}); LW_ON({n}) ? {ways[0]} : {ways[1]}; }})"
                )

            self.add(cursor, [operand], render, [f"{name} => {other}"])
        elif text.startswith(("-", "~")):
            if strip(operand).kind == CursorKind.INTEGER_LITERAL:
                return  # the literal has its own
            operator = text[0]
            self.add(
                cursor,
                [operand],
                lambda n, o: (
                    f"({{ __auto_type lw_a{n} = ({o[0]});"
                    f" LW_VALUE({n}, {operator}lw_a{n}, lw_a{n}); }})"
                ),
                [f"{name} => without {operator}"],
            )

    def literal(self, cursor: Cursor, parent: Cursor) -> None:
        text = self.said(cursor)
        where = f"{short(self.said(parent))}: {text}"
        if text in ("true", "false"):
            other = "false" if text == "true" else "true"
            self.add(
                cursor, [], lambda n, o: f"LW_VALUE({n}, {text}, {other})", [f"{where} => {other}"]
            )
            return
        if not LITERAL.fullmatch(text):
            return
        value = int(text.rstrip("uUlL"), 0)
        values = [value + 1] if value == 0 else [value - 1, value + 1]
        suffix = text[len(text.rstrip("uUlL")) :]
        said = [f"{v}{suffix}" for v in values]
        self.add(
            cursor,
            [],
            lambda n, o: f"LW_VALUE({n}, {text}, {', '.join(said)})",
            [f"{where} => {s}" for s in said],
        )

    # ---- the text that holds them ----------------------------------------------------------------

    def rewritten(self, numbers: Iterator[int]) -> tuple[str, list[tuple[int, Site]]]:
        """The source with all its sites, and their numbers."""
        numbered: list[tuple[int, Site]] = []
        # What encloses others comes first; of two with one range, the one that was found first.
        ordered = sorted(self.sites, key=lambda site: (site.begin, -site.end))
        top: list[Site] = []
        stack: list[Site] = []
        for site in ordered:
            site.inner = []
            while stack and stack[-1].end <= site.begin:
                stack.pop()
            (stack[-1].inner if stack else top).append(site)
            stack.append(site)

        def text_of(begin: int, end: int, sites: list[Site]) -> str:
            parts = []
            at = begin
            for site in sites:
                if site.begin < begin or site.end > end:
                    continue
                number = next(numbers)
                numbered.append((number, site))
                parts.append(self.text[at : site.begin])
                parts.append(
                    site.render(number, [text_of(b, e, site.inner) for b, e in site.operands])
                )
                at = site.end
            parts.append(self.text[at:end])
            return "".join(parts)

        return text_of(0, len(self.text), top), numbered


def calculate(operator: str, a: str, b: str) -> str:
    return f"LW_QUOTIENT({a}, {b})" if operator == "/" else f"({a} {operator} {b})"


def write_mutants(core: Path, copy: Path, folders: list[str]) -> list[Mutant]:
    """Copy the core, with all mutants of some folders in it. Files that do not change are kept."""
    mutants: list[Mutant] = []
    first_site = 0
    wanted = set()
    for path in sorted(p for p in core.rglob("*") if p.is_file()):
        relative = path.relative_to(core)
        folder = relative.parent.name
        text = path.read_text()
        if folder in folders and path.suffix in (".c", ".h"):
            source = Source(path, [core / "include", core / "generated", path.parent])
            text, numbered = source.rewritten(itertools.count(first_site))
            if len(numbered) > SITES_OF_FILE_MAX:
                raise SystemExit(f"{path}: more than {SITES_OF_FILE_MAX} places to mutate")
            first_site += SITES_OF_FILE_MAX if numbered else 0
            if first_site > SITES_MAX:
                raise SystemExit(f"more than {SITES_MAX} places: raise it, also in mutation.c")
            seen: dict[str, int] = {}
            for number, site in numbered:
                for variant, said in enumerate(site.variants, 1):
                    name = f"{folder}/{path.name}:{site.function}: {said}"
                    seen[name] = seen.get(name, 0) + 1
                    if seen[name] > 1:
                        name += f" #{seen[name]}"
                    line = 1 + source.text.count("\n", 0, site.begin)
                    mutants.append(Mutant(name, folder, path, line, f"{number},{variant}"))
        target = copy / relative
        wanted.add(target)
        if not target.exists() or target.read_text() != text:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text)
    for stale in [p for p in copy.rglob("*") if p.is_file() and p not in wanted]:
        stale.unlink()
    return mutants
