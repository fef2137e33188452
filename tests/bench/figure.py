# SPDX-License-Identifier: Apache-2.0
"""One measured figure, what it may be at most or at least, and what it was."""

import statistics
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path

FIGURES = Path(__file__).with_name("figures.json")
DEARER_MAX = 1.10  # than the record
WORDS = {"avg_max": "average", "max_max": "worst", "avg_min": "average"}


@dataclass
class Figure:
    """One line of the table. Name and target together say which one; they stay what they are."""

    name: str
    target: str
    options: str
    min: float
    avg: float
    max: float
    unit: str
    before: float | None = None  # what it was, where that is known
    # What it has to be: avg_max and max_max at most, avg_min at least.
    limits: dict[str, float] = field(default_factory=dict)
    counted: bool = False  # the same in every run, so that it may be compared with the record

    @property
    def key(self) -> tuple[str, str]:
        """Which one it is."""
        return self.name, self.target

    def missed(self) -> list[str]:
        """Limits that it does not keep."""
        result = []
        for limit, value in self.limits.items():
            found = self.max if limit == "max_max" else self.avg
            if found < value if limit == "avg_min" else found > value:
                bound = "at least" if limit == "avg_min" else "at most"
                result.append(
                    f"{self.name} ({self.target}): {WORDS[limit]} {found:.4g} {self.unit}, "
                    f"{bound} {value:g}"
                )
        return result

    def target_text(self) -> str:
        """Its limits, for people."""
        return " / ".join(
            f"{'>=' if limit == 'avg_min' else '<='}{value:g}"
            for limit, value in self.limits.items()
        )


def figure(
    name: str, target: str, options: str, values: list[float], unit: str, **others: object
) -> Figure:
    """Over the values of one measurement."""
    of = (min(values), statistics.fmean(values), max(values))
    return Figure(name, target, options, *of, unit, **others)  # type: ignore[arg-type]


def dearer(figures: Iterable[Figure], record: list[dict[str, object]]) -> list[str]:
    """What is counted, and has become more than a tenth dearer than recorded."""
    before = {(r["name"], r["target"]): r for r in record}
    result = []
    for f in figures:
        old = before.get(f.key)
        if old is None or not f.counted:
            continue
        for of in ("avg", "max"):
            was, now = float(old[of]), float(getattr(f, of))  # type: ignore[arg-type]
            if now > DEARER_MAX * was:
                word = WORDS[of + "_max"]
                result.append(f"{f.name} ({f.target}): {word} {now:.5g} {f.unit} after {was:.5g}")
    return result


def without_name(figures: Iterable[Figure]) -> list[tuple[str, str]]:
    """Names that are not one figure's alone."""
    keys = [f.key for f in figures]
    return sorted({key for key in keys if keys.count(key) > 1})


def table(figures: list[Figure]) -> str:
    """For people."""
    width = max(len(f.name) for f in figures)
    lines = [f"{'':{width}}  {'min':>9} {'avg':>9} {'max':>9}"]
    for f in figures:
        values = " ".join(f"{value:9.2f}" for value in (f.min, f.avg, f.max))
        before = "" if f.before is None else f"; {f.before:g} before"
        target = f"; target {f.target_text()}" if f.limits else ""
        lines.append(
            f"{f.name:{width}}  {values}  {f.unit:12}  {f.target}: {f.options}{target}{before}"
        )
    return "\n".join(lines)


def side_by_side(now: list[Figure], then: list[dict[str, object]], revision: str) -> str:
    """Two runs of the same measurements; what only one of them has is left out."""
    before = {(r["name"], r["target"]): r for r in then}
    rows = [(f, before[f.key]) for f in now if f.key in before]
    width = max(len(f.name) for f, _ in rows)
    lines = [f"{'average, and worst':{width}}  {revision:>19}  {'this tree':>19}  {'average by'}"]
    for f, old in rows:
        was, now_avg = float(old["avg"]), f.avg  # type: ignore[arg-type]
        change = f"{100 * (now_avg / was - 1):+.1f} %" if was else ""
        lines.append(
            f"{f.name:{width}}  {was:9.2f} {float(old['max']):9.2f}  "  # type: ignore[arg-type]
            f"{now_avg:9.2f} {f.max:9.2f}  {change:>9}  {f.unit}, {f.target}"
        )
    return "\n".join(lines)


def document(figures: Iterable[Figure]) -> list[dict[str, object]]:
    """For JSON."""
    return [asdict(f) for f in figures]
