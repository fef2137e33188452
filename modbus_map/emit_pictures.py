# SPDX-License-Identifier: Apache-2.0
"""Pictures for the integrator's page, with the names and numbers of the map: doc/*.svg."""

from html import escape

from map_model import Map, MapError, Point

NODE_WIDTH = 124
NODE_HEIGHT = 44
LINE_HEIGHT = 14

STYLE = """<style>
  text { font: 12px sans-serif; fill: #222; }
  .name { font: bold 13px monospace; text-anchor: middle; }
  .number { font: 11px sans-serif; fill: #555; text-anchor: middle; }
  .node { fill: #e8f0fa; stroke: #33557a; stroke-width: 1.5; }
  .good { fill: #ddf3dd; }
  .bad { fill: #fbdede; }
  .group { fill: none; stroke: #33557a; stroke-dasharray: 5 4; }
  .note { fill: #fff8dc; stroke: #b8a45a; }
  .arrow { fill: none; stroke: #222; stroke-width: 1.3; marker-end: url(#head); }
  .life { stroke: #888; stroke-dasharray: 4 4; }
  .middle { text-anchor: middle; }
  .end { text-anchor: end; }
</style>
"""
MARKER = (
    '<defs><marker id="head" viewBox="0 0 10 10" refX="10" refY="5" markerWidth="8" '
    'markerHeight="8" orient="auto"><path d="M0 0 10 5 0 10z" fill="#222"/></marker></defs>\n'
)

# Where the states stand: centre of the node, and how it is coloured.
STATES = {
    "unindexed": (90, 120, ""),
    "backing_off": (350, 120, ""),
    "seeking": (560, 120, ""),
    "index_reversal": (770, 120, ""),
    "span_check": (980, 120, ""),
    "parking": (1190, 120, ""),
    "ready": (1190, 330, "good"),
    "tracking": (1190, 500, "good"),
    "centring": (880, 330, ""),
    "centred": (880, 500, ""),
    "jogging": (560, 410, ""),
    "reacquiring": (620, 660, ""),
    "off": (190, 440, "bad"),
    "fault": (330, 330, "bad"),
}
INDEXING = (264, 56, 1012, 130)  # the group: x, y, width, height

# Path, place of the label, its alignment, its lines.
TRANSITIONS = [
    ("M20 120H28", 0, 0, "", ()),
    ("M152 110H264", 208, 102, "middle", ("index",)),
    ("M264 132H152", 208, 147, "middle", ("stop",)),
    ("M412 112H498", 455, 92, "middle", ("switch", "released")),
    ("M498 130H412", 455, 145, "middle", ("trigger on", "the ramp")),
    ("M622 120H708", 665, 112, "middle", ("trigger",)),
    ("M832 120H918", 875, 98, "middle", ("sweeping", "back")),
    ("M1042 120H1128", 1085, 84, "middle", ("other switch", "in its", "place")),
    ("M1190 142V308", 1198, 240, "", ("indexed,", "at rest")),
    ("M330 186V308", 338, 235, "", ("no switch, wrong", "switch, span")),
    ("M268 330H90V142", 98, 322, "", ("clear_fault",)),
    ("M1205 352V478", 1213, 405, "", ("mode track,", "drum at rest")),
    ("M1175 478V352", 1167, 405, "end", ("stop, drum", "at rest")),
    ("M1128 320H942", 1035, 284, "middle", ("mode centre, or", "resting outside", "of the sweep")),
    ("M942 342H1128", 1035, 357, "middle", ("stop",)),
    ("M1128 490L942 352", 952, 432, "", ("mode centre,", "drum at rest")),
    ("M880 352V478", 872, 410, "end", ("in place",)),
    ("M942 510H1128", 1035, 525, "middle", ("mode track, drum at rest",)),
    ("M1175 522V580H330V352", 720, 573, "middle", ("overspeed, los_limit",)),
    ("M1205 522V610H50V142", 720, 603, "middle", ("stop, drum turning",)),
    ("M36 142V660H558", 300, 652, "middle", ("reacquire, drum turning",)),
    ("M682 660H1235V522", 960, 652, "middle", ("limit switch triggered",)),
]
NOTES = [
    (
        *(560, 448),
        (
            "by jog, from unindexed, ready, tracking at",
            "rest, centred or fault; back to ready",
            "if indexed, else where it came from",
        ),
    ),
    (620, 698, ("no switch, wrong switch, overtravel: fault; stop: unindexed",)),
    (190, 478, ("mode off, from every state;", "another mode: to unindexed", "(or fault)")),
]


def _text(x: int, y: int, lines: tuple[str, ...], css: str) -> str:
    return "".join(
        f'<text x="{x}" y="{y + LINE_HEIGHT * i}" class="{css}">{escape(line)}</text>\n'
        for i, line in enumerate(lines)
    )


def _document(width: int, height: int, title: str, body: str) -> str:
    return (
        "<!-- Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py "
        "Do not edit. -->\n"
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}">\n'
        f"<title>{escape(title)}</title>\n{STYLE}{MARKER}"
        f'<rect width="{width}" height="{height}" fill="#fff"/>\n{body}</svg>\n'
    )


def states_svg(map_: Map) -> str:
    """The state machine: every state of the map, with its number."""
    values = {value.name: value.value for value in map_.enums["state"].values}
    if values.keys() != STATES.keys():
        odd = ", ".join(sorted(values.keys() ^ STATES.keys()))
        raise MapError(f"the picture of the states (emit_pictures.py) and the map differ: {odd}")
    x, y, width, height = INDEXING
    body = [f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="10" class="group"/>\n']
    body.append(_text(x + 10, y + 18, ("indexing",), ""))
    body.append('<circle cx="14" cy="120" r="6"/>\n')
    for path, label_x, label_y, align, lines in TRANSITIONS:
        body.append(f'<path d="{path}" class="arrow"/>\n')
        body.append(_text(label_x, label_y, lines, align))
    for name, (centre_x, centre_y, css) in STATES.items():
        body.append(
            f'<rect x="{centre_x - NODE_WIDTH // 2}" y="{centre_y - NODE_HEIGHT // 2}" '
            f'width="{NODE_WIDTH}" height="{NODE_HEIGHT}" rx="8" class="node {css}"/>\n'
            f'<text x="{centre_x}" y="{centre_y - 1}" class="name">{name}</text>\n'
            f'<text x="{centre_x}" y="{centre_y + 15}" class="number">{values[name]}</text>\n'
        )
    for note_x, note_y, lines in NOTES:
        body.append(_text(note_x, note_y, lines, "middle"))
    return _document(1340, 710, "States of the controller (input register state)", "".join(body))


def _point(map_: Map, name: str) -> Point:
    return next(p for block in map_.blocks for p in block.points if p.name == name)


def _value(map_: Map, enum: str, name: str) -> int:
    return next(v.value for v in map_.enums[enum].values if v.name == name)


def handshake_svg(map_: Map) -> str:
    """A parameter change: stage, APPLY, SAVE, with the addresses and codes of the map."""
    command = _point(map_, "command").address
    first = _point(map_, "command_sequence").address
    last = _point(map_, "command_limit")
    count = last.end - first
    error = _point(map_, "last_error_reason").address
    error_count = _point(map_, "last_error_limit").end - error
    codes = {name: _value(map_, "command", name) for name in ("apply", "revert", "save")}
    results = {name: _value(map_, "result", name) for name in ("in_progress", "done", "refused")}
    read_result = f"FC04 {first}, {count}: how did it end?"
    steps = [
        (">", "FC16 parameters"),
        ("<", "done: staged, the flag staged is on"),
        (
            "!",
            "exception 03: one value is wrong, nothing is changed. "
            f"FC04 {error}, {error_count} tells which and why",
        ),
        (">", f"FC04 {first}, {count}"),
        ("<", "command_sequence n"),
        (">", f"FC06 holding {command} = {codes['apply']} (APPLY)"),
        ("<", "done: taken"),
        ("!", "exception 06: not now. Tracking or moving: STOP first. Locked: unlock first"),
        (">", read_result),
        ("<", f"sequence n+1, code {codes['apply']}, result {results['done']} (done): active"),
        (
            "!",
            f"result {results['refused']} (refused): reason, address, value and limit tell why. "
            f"Correct it, or REVERT ({codes['revert']})",
        ),
        (">", f"FC06 holding {command} = {codes['save']} (SAVE)"),
        ("<", "done: taken"),
        (">", f"{read_result} Again while the result is {results['in_progress']} (in progress)"),
        (
            "<",
            f"sequence n+2, code {codes['save']}, result {results['done']} (done): "
            "stored, the flag dirty is off",
        ),
    ]
    left, right, y = 60, 640, 70
    body = []
    for kind, text in steps:
        if kind == "!":
            body.append(
                f'<rect x="{left + 20}" y="{y - 12}" width="{right - left - 40}" height="38" '
                'rx="4" class="note"/>\n'
            )
            cut = text.index(". ") + 1
            body.append(_text(left + 30, y + 3, (text[:cut], text[cut + 1 :]), ""))
            y += 52
            continue
        begin, end = (left, right) if kind == ">" else (right, left)
        body.append(f'<path d="M{begin} {y}H{end}" class="arrow"/>\n')
        body.append(_text((left + right) // 2, y - 6, (text,), "middle"))
        y += 32
    heads = "".join(
        f'<line x1="{x}" y1="44" x2="{x}" y2="{y}" class="life"/>\n'
        f'<rect x="{x - 50}" y="14" width="100" height="30" rx="6" class="node"/>\n'
        f'<text x="{x}" y="34" class="name">{name}</text>\n'
        for x, name in ((left, "PLC"), (right, "level wind"))
    )
    return _document(700, y + 16, "A parameter change: stage, APPLY, SAVE", heads + "".join(body))
