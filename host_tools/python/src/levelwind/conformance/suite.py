# SPDX-License-Identifier: Apache-2.0
"""The list of cases, and how one is run."""

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import partial

from levelwind.conformance.slave import Answer, Slave, word
from levelwind.conformance.survey import Found
from levelwind.errors import ToolError

RECOVERY_ATTEMPTS = 5
SETTLE_S = 0.2


class Verdict(Enum):
    """How a case ended; the worst finding counts."""

    PASS = "pass"
    NOT_APPLICABLE = "not applicable"
    DEVIATION = "deviation"
    """Not what the standard says; a master can live with it."""
    FAIL = "fail"
    """A master is misled, something is changed that must not be, or a request is lost."""


@dataclass(frozen=True)
class Finding:
    """Something that is not as the standard says."""

    verdict: Verdict
    text: str


def deviation(text: str) -> Finding:
    """A master can live with it."""
    return Finding(Verdict.DEVIATION, text)


def fail(text: str) -> Finding:
    """A master cannot."""
    return Finding(Verdict.FAIL, text)


class NotApplicableError(Exception):
    """The slave has not what the case is about; the text says what."""


CaseFunction = Callable[..., Iterator[Finding]]


@dataclass(frozen=True)
class Case:
    """One thing that the standards ask for."""

    name: str
    section: str
    run: Callable[[Slave, Found], Iterator[Finding]]


@dataclass(frozen=True)
class Outcome:
    """A case that was run."""

    name: str
    section: str
    verdict: Verdict
    detail: str


_cases: list[Case] = []


def all_cases() -> list[Case]:
    """Frames first, then by function code."""
    return sorted(_cases, key=lambda item: (item.name.startswith("FC"), item.name))


def case(name: str, section: str, **arguments: object) -> Callable[[CaseFunction], CaseFunction]:
    """Put a generator of findings on the list, with these arguments."""

    def register(function: CaseFunction) -> CaseFunction:
        _cases.append(Case(name, section, partial(function, **arguments)))
        return function

    return register


def each(
    functions: Iterable[int], name: str, section: str = ""
) -> Callable[[CaseFunction], CaseFunction]:
    """The same case for several functions."""

    def register(generator: CaseFunction) -> CaseFunction:
        for function in functions:
            place = section or f"AP 6.{function}"
            case(f"FC{function:02d}: {name}", place, function=function)(generator)
        return generator

    return register


def run(
    slave: Slave,
    found: Found,
    cases: Sequence[Case],
    progress: Callable[[Outcome], None] = lambda outcome: None,
) -> list[Outcome]:
    """Run cases one after another; after each the slave must answer straight away."""
    outcomes = []
    for item in cases:
        outcomes.append(_run_one(item, slave, found))
        progress(outcomes[-1])
    return outcomes


def _run_one(item: Case, slave: Slave, found: Found) -> Outcome:
    try:
        findings = list(item.run(slave, found))
        if not slave.alive():
            findings.append(fail("the next valid request was not answered"))
            if not slave.come_back(RECOVERY_ATTEMPTS):
                raise ToolError(f"No answer any more since the case {item.name!r}.")
    except NotApplicableError as reason:
        return Outcome(item.name, item.section, Verdict.NOT_APPLICABLE, str(reason))
    except KeyboardInterrupt:
        time.sleep(SETTLE_S)  # the answer under way goes by
        raise
    finally:
        _put_back_scratch(slave, found)
    order = list(Verdict)
    worst = max((f.verdict for f in findings), key=order.index, default=Verdict.PASS)
    return Outcome(item.name, item.section, worst, "; ".join(f.text for f in findings))


def _put_back_scratch(slave: Slave, found: Found) -> None:
    """The scratch register as it was found, however a case has ended."""
    if found.scratch is None:
        return
    read = b"\x03" + word(found.scratch, 1)
    for _ in range(RECOVERY_ATTEMPTS):
        value = slave.request(read).pdu[2:]
        if value == found.scratch_value:
            return
        if value:
            head = b"\x06" + word(found.scratch)
            if 6 not in found.functions:
                head = b"\x10" + word(found.scratch, 1) + b"\x02"
            slave.request(head + found.scratch_value)


# ---- what most cases need ------------------------------------------------------------------------


def need_function(found: Found, *functions: int) -> None:
    """The case is about functions that the slave has."""
    for function in functions:
        if function not in found.functions:
            raise NotApplicableError(
                f"FC{function:02d}: no answer"
                if function in found.silent_functions
                else f"FC{function:02d} is not supported"
            )


def need_unknown(found: Found, function: int) -> int:
    """An address that this reading function does not reach."""
    if function not in found.unknown:
        raise NotApplicableError("every address that was tried exists")
    return found.unknown[function]


def need_scratch(found: Found) -> int:
    """The holding register that may be changed."""
    if found.scratch is None:
        raise NotApplicableError("needs --scratch-register")
    return found.scratch


def expect_exception(answer: Answer, code: int, what: str = "") -> Iterator[Finding]:
    """This exception and no other."""
    if answer.exception == code:
        return
    text = f"{what}: {answer}, not exception {code:02d}" if what else f"{answer}, not {code:02d}"
    yield fail(text) if answer.malformed else deviation(text)


def expect_refusal(answer: Answer, code: int, what: str = "") -> Iterator[Finding]:
    """This exception; to execute the request would be worse than another one."""
    if answer.pdu:
        yield fail(f"{what}: {answer}, exception {code:02d} expected".removeprefix(": "))
    else:
        yield from expect_exception(answer, code, what)


def expect_answer(answer: Answer, pdu: bytes, what: str = "") -> Iterator[Finding]:
    """Exactly this answer."""
    if answer.pdu != pdu:
        shown = pdu[:12].hex(" ")
        yield fail(f"{what}: {answer}, not {shown}".removeprefix(": "))


def expect_silence(frame: bytes, what: str) -> Iterator[Finding]:
    """No answer to what must not be answered."""
    if frame:
        yield fail(f"{what}: answered {frame[:16].hex(' ')}")
