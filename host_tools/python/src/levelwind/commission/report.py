# SPDX-License-Identifier: Apache-2.0
"""The report: what was measured, what was accepted by whom; as JSON, HTML and PDF."""

import base64
import io
import json
from collections.abc import Mapping
from importlib import resources
from pathlib import Path

import jinja2
import matplotlib as mpl
from fpdf import FPDF
from fpdf.fonts import FontFace
from matplotlib.figure import Figure

from levelwind import whole_file
from levelwind.commission.guide import STEPS
from levelwind.commission.session import Result, Session
from levelwind.commission.verify import FORM
from levelwind.line.points import PARAMETERS, format_value
from levelwind.map_table import PRODUCT_VERSION
from levelwind.show.plots import new_figure

FONT = "DejaVu"
PLOT_IN = (7.2, 2.6)
GREY = (235, 238, 240)
LEFT_OUT = (".left_out",)


def write(session: Session, folder: Path) -> list[Path]:
    """report.json, report.html and report.pdf in a folder; ToolError where they cannot be."""
    whole_file.make_folder(folder)
    parameters = {p.name: session.active[p.name] for p in PARAMETERS if not p.secret}
    document = {
        "levelwind_report": FORM,
        "tool": PRODUCT_VERSION,
        "parameters": parameters,
        **session.document(),
    }
    pictures = {name: _picture(figure) for name, held in session.results.items()
                if (figure := _plot(name, held)) is not None}  # fmt: skip
    paths = [folder / f"report.{suffix}" for suffix in ("json", "html", "pdf")]
    whole_file.write(paths[0], json.dumps(document, indent=1) + "\n")
    whole_file.write(paths[1], _html(session, pictures))
    whole_file.write(paths[2], _pdf(session, pictures))
    return paths


# ---- what both show ----------------------------------------------------------------------------


def _verdict(session: Session) -> tuple[bool, str]:
    """Whether it was accepted, in one sentence."""
    left_out = [
        step.title
        for step in STEPS
        if any(f.code.endswith(LEFT_OUT) for f in _held(session, step.name).findings)
    ]
    if not session.accepted_crc:
        return False, "NOT ACCEPTED: this winch must not launch by this report."
    text = f"ACCEPTED by {session.accepted_by}, {session.accepted_at}: it may launch with this set."
    if left_out:
        text += f" NOT MEASURED: {', '.join(left_out)}."
    return True, text


def _held(session: Session, name: str) -> Result:
    return session.results.get(name, Result())


def _facts(session: Session) -> list[tuple[str, str]]:
    """Whose report this is."""
    return [
        ("Firmware", session.machine.get("firmware", "not read")),
        ("Image (SHA-256 begins)", session.machine.get("image", "not read")),
        ("Runs on", session.machine.get("host", "not read")),
        ("Parameter set", f"{session.accepted_crc or 'not accepted'}"),
        ("Begun", session.begun),
        ("Tool", f"levelwind {PRODUCT_VERSION}"),
    ]


def _values(session: Session) -> list[tuple[str, str, str, str]]:
    """The set: name, value, unit, the factory's where it is another."""
    rows = []
    for point in PARAMETERS:
        if point.secret or point.name not in session.active:
            continue
        value = session.active[point.name]
        other = "" if value == point.default else format_value(point, point.default or 0)
        rows.append((point.name, format_value(point, value), point.unit or "", other))
    return rows


def _plot(name: str, held: Result) -> Figure | None:
    """What a step has measured as a picture; None where it has nothing to show."""
    series = held.series
    figure = new_figure(*PLOT_IN)
    if name == "repeat" and "plus_um" in series:
        left, right = figure.subplots(1, 2)
        for side in ("plus", "minus"):
            at = series[f"{side}_um"]
            left.plot(range(1, len(at) + 1), at, marker="o", label=f"{side} switch")
        left.set(xlabel="indexing", ylabel="found at, µm from the first")
        left.legend(fontsize="small")
        right.plot(series["speed_mm_per_s"], series["apart_um"], marker="o")
        right.set(xlabel="carriage, mm/s", ylabel="too far apart, µm")
    elif name == "pull_out" and "tried_edges_per_s" in series:
        axes = figure.subplots()
        tried = sorted(zip(series["tried_edges_per_s"], series["lost_usteps"], strict=True))
        axes.plot([rate / 1000 for rate, _ in tried], [abs(lost) for _, lost in tried], marker="o")
        axes.set_yscale("symlog", linthresh=10)
        for key, text, colour in (
            ("overspeed_trip_edges_per_s", "trip", "tab:red"),
            ("overspeed_warning_edges_per_s", "warning", "tab:orange"),
        ):
            if key in held.proposed:
                axes.axvline(held.proposed[key] / 1000, color=colour, label=f"proposed {text}")
        axes.set(xlabel="drum speed, 1000 edges/s", ylabel="microsteps lost")
        axes.legend(fontsize="small")
    elif name == "line" and "latency_ms" in series:
        axes = figure.subplots()
        axes.hist(series["latency_ms"], bins=60)
        axes.set(xlabel="answer in, ms", ylabel="requests")
    else:
        return None
    return figure


def _picture(figure: Figure) -> bytes:
    """As PNG, for both."""
    written = io.BytesIO()
    figure.savefig(written, format="png", dpi=150)
    return written.getvalue()


# ---- HTML --------------------------------------------------------------------------------------


def _html(session: Session, pictures: Mapping[str, bytes]) -> str:
    template = resources.files("levelwind.commission").joinpath("report.html.j2").read_text("utf-8")
    accepted, verdict = _verdict(session)
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    return environment.from_string(template).render(
        accepted=accepted,
        verdict=verdict,
        facts=_facts(session),
        steps=[(number, step, _held(session, step.name)) for number, step in enumerate(STEPS, 1)],
        pictures={name: base64.b64encode(picture).decode() for name, picture in pictures.items()},
        values=_values(session),
    )


# ---- PDF ---------------------------------------------------------------------------------------


class _Pdf(FPDF):
    """Pages with a number, in a font that has every letter a name may have."""

    def __init__(self) -> None:
        super().__init__()
        fonts = Path(mpl.get_data_path()) / "fonts" / "ttf"
        self.add_font(FONT, "", fonts / "DejaVuSans.ttf")
        self.add_font(FONT, "B", fonts / "DejaVuSans-Bold.ttf")
        self.set_auto_page_break(True, 18)
        self.add_page()

    def footer(self) -> None:
        """The page's number."""
        self.set_y(-12)
        self.set_font(FONT, size=7)
        self.cell(0, 5, f"levelwind commissioning, page {self.page_no()}", align="C")

    def line_of(self, text: str, size: float = 9, style: str = "", gap: float = 1.0) -> None:
        """A paragraph."""
        self.set_font(FONT, style, size)
        self.multi_cell(0, size * 0.5, text, new_x="LMARGIN", new_y="NEXT")
        self.ln(gap)

    def rows(
        self,
        rows: list[tuple[str, ...]],
        widths: tuple[int, ...],
        size: float = 8,
        *,
        heading: bool = False,
    ) -> None:
        """A table."""
        if not rows:
            return
        self.set_font(FONT, size=size)
        with self.table(
            col_widths=widths,
            text_align="LEFT",
            borders_layout="HORIZONTAL_LINES",
            line_height=size * 0.55,
            first_row_as_headings=heading,
            headings_style=FontFace(emphasis="BOLD", fill_color=GREY),
        ) as table:
            for row in rows:
                table.row(row)
        self.ln(2)


def _pdf(session: Session, pictures: Mapping[str, bytes]) -> bytes:
    pdf = _Pdf()
    accepted, verdict = _verdict(session)
    pdf.line_of("Commissioning of a level wind", 16, "B", 2)
    pdf.set_text_color(*((0, 110, 40) if accepted else (180, 0, 0)))
    pdf.line_of(verdict, 11, "B", 2)
    pdf.set_text_color(0, 0, 0)
    pdf.rows(list(_facts(session)), (45, 145))
    for number, step in enumerate(STEPS, 1):
        held = _held(session, step.name)
        pdf.line_of(f"{number}. {step.title}" + ("" if held.done else "   NOT DONE"), 11, "B")
        pdf.line_of(step.does, 8)
        for word, rows in (("told", held.told), ("measured", held.measured)):
            if rows:
                pdf.rows([(word, ""), *((name, str(value)) for name, value in rows.items())],
                         (100, 90), heading=True)  # fmt: skip
        if step.name in pictures:
            pdf.image(io.BytesIO(pictures[step.name]), w=180)
            pdf.ln(2)
        for finding in held.findings:
            word = "WRONG" if finding.wrong else "Note"
            pdf.line_of(f"{word}: {finding.what} {finding.remedy}", 8, "B" if finding.wrong else "")
    pdf.line_of("The parameter set", 11, "B")
    pdf.rows([("parameter", "value", "unit", "factory value, where another"), *_values(session)],
             (70, 45, 30, 45), 7, heading=True)  # fmt: skip
    return bytes(pdf.output())
