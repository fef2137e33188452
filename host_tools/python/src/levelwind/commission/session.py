# SPDX-License-Identifier: Apache-2.0
"""What is kept of a commissioning after every step, so that it can go on after anything."""

import json
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path

from levelwind import whole_file
from levelwind.errors import ToolError

FORM = 1


@dataclass
class Finding:
    """Something that is wrong, or worth knowing."""

    code: str
    """For programs: step and fault, as contacts.swapped."""
    what: str
    remedy: str
    wrong: bool = True


@dataclass
class Result:
    """A step as it went."""

    done: bool = False
    at: str = ""
    told: dict[str, str] = field(default_factory=dict)
    """Answers of the person: question and answer, as they stand in the report."""
    measured: dict[str, object] = field(default_factory=dict)
    proposed: dict[str, int] = field(default_factory=dict)
    series: dict[str, list[float]] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)


@dataclass
class Session:
    """Everything so far. `save()` after every change that must not be lost."""

    path: Path
    machine: dict[str, str] = field(default_factory=dict)
    """Firmware version and image hash, host."""
    values: dict[str, int] = field(default_factory=dict)
    """Parameters that the steps have found so far, by name; the controller has not saved them."""
    active: dict[str, int] = field(default_factory=dict)
    """The whole set in force after the last step."""
    told: dict[str, float] = field(default_factory=dict)
    """What the person has told, and later steps need."""
    results: dict[str, Result] = field(default_factory=dict)
    begun: str = ""
    accepted_by: str = ""
    accepted_at: str = ""
    accepted_crc: int = 0

    def save(self) -> None:
        """Write the file whole, or leave the old one."""
        whole_file.write(self.path, json.dumps(self.document(), indent=1) + "\n")

    def document(self) -> dict[str, object]:
        """As JSON has it."""
        held = asdict(self)
        del held["path"]
        return {"levelwind_commissioning": FORM, **held}


def now() -> str:
    """Date and time for a report."""
    return time.strftime("%Y-%m-%d %H:%M:%S")


def load(path: Path) -> Session:
    """A session that was begun; ToolError where the file is none."""
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise ToolError(f"{path} cannot be read: {error}.") from error
    except json.JSONDecodeError as error:
        raise ToolError(f"{path}: no JSON: {error}.") from error
    if not isinstance(document, dict) or document.get("levelwind_commissioning") != FORM:
        raise ToolError(f"{path} is no commissioning of `levelwind commission`.")
    try:
        del document["levelwind_commissioning"]
        results = {name: _result(held) for name, held in document.pop("results").items()}
        return Session(path=path, results=results, **document)
    except (KeyError, TypeError, AttributeError) as error:
        raise ToolError(f"{path} is incomplete or of another version: {error}.") from None


def _result(held: dict[str, object]) -> Result:
    findings = [Finding(**finding) for finding in held.pop("findings")]  # type: ignore[attr-defined]
    return Result(findings=findings, **held)  # type: ignore[arg-type]
