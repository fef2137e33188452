# SPDX-License-Identifier: Apache-2.0
"""For FUXA (https://github.com/frangoteam/FUXA), a SCADA in the browser: a project with the tags
of the status and a panel that is ready. It only looks: commands are given where the winch is seen.
"""

import json
from xml.sax.saxutils import escape, quoteattr

from emit_integrations import GATEWAY, SOURCE, status_block
from map_model import Map, Point, Value

_TYPES = {"u16": "UInt16", "i16": "Int16", "u32": "UInt32", "i32": "Int32", "i64": "Int64"}
_DISCRETE, _INPUT = "100000", "300000"
_POLL_MS = 500
_DEVICE, _VIEW = "levelwind", "v_levelwind"
_WIDTH, _ROW, _LEFT, _FLAGS, _TOP = 1240, 25, 20, 660, 100
_GREY, _ABNORMAL, _WARNED, _INK = "#b8b8b8", "#c00000", "#e0a000", "#202020"
# What the panel shows of the registers: name, words, divisor, digits, unit.
_NUMBERS = (
    ("position_um", "carriage", 1000, 1, "mm"),
    ("rope_speed_mm_per_s", "rope speed", 1000, 1, "m/s"),
    ("drum_speed_edges_per_s", "drum speed", 1, 0, "edges/s"),
    ("rope_on_drum_mm", "rope on drum", 1000, 1, "m"),
    ("rope_out_mm", "rope out", 1000, 1, "m"),
    ("rope_layer", "layer of rope", 1, 0, ""),
)


def _tag(
    name: str, text: str, memory: str, address: int, kind: str, divisor: int = 1, digits: int = 0
) -> dict:
    return {
        "id": f"levelwind_{name}",
        "name": name,
        "type": kind,
        "memaddress": memory,
        "address": str(address + 1),  # counted from 1 there
        "divisor": divisor,
        "format": digits,
        "daq": {"enabled": False, "changed": False, "interval": 60, "restored": False},
        "description": text,
    }


def _status_points(map_: Map) -> list[Point]:
    return [p for p in status_block(map_).points if p.address >= 100 or p.name == "map_version"]


def _tags(map_: Map) -> dict[str, dict]:
    shown = {name: (divisor, digits) for name, _, divisor, digits, _ in _NUMBERS}
    tags = [_tag(f.name, f.text, _DISCRETE, f.value, "Bool") for f in map_.flags]
    for point in _status_points(map_):
        told = shown.get(point.name, (1, 0))
        tags.append(_tag(point.name, point.text, _INPUT, point.address, _TYPES[point.type], *told))
    return {tag["id"]: tag for tag in tags}


class _Panel:
    """The drawing and, by the same names, what each of its parts shows."""

    def __init__(self) -> None:
        self.items: dict[str, dict] = {}
        self._drawn: list[str] = []

    def svg(self, height: int) -> str:
        return (
            f'<svg width="{_WIDTH}" height="{height}" xmlns="http://www.w3.org/2000/svg">'
            "<g><title>Layer 1</title>" + "".join(self._drawn) + "</g></svg>"
        )

    def words(self, x: int, y: int, text: str, size: int = 15, tip: str = "") -> None:
        title = f"<title>{escape(tip)}</title>" if tip else ""
        self._drawn.append(
            f'<text x="{x}" y="{y}" font-family="sans-serif" font-size="{size}" '
            f'fill="{_INK}">{title}{escape(text)}</text>'
        )

    def _item(self, key: str, kind: str, name: str, property_: dict) -> None:
        variable = {"variableId": f"levelwind_{name}", "variable": name, "variableSrc": _DEVICE}
        self.items[key] = {
            "id": key,
            "type": kind,
            "name": key,
            "label": "",
            "property": {"events": [], "actions": [], **variable, **property_},
        }

    def choice(
        self, name: str, x: int, y: int, size: int, words: dict[int, tuple], width: int = 570
    ) -> None:
        """A number in words, each with its colour: a list that nobody can open."""
        key = f"HXS_{name}"
        ranges = [
            {"type": "step", "min": value, "max": value, "text": text, "color": fill, "stroke": ink}
            for value, (text, fill, ink) in words.items()
        ]
        self._item(key, "svg-ext-html_select", name, {"readonly": True, "ranges": ranges})
        box = f'x="{x}" y="{y}" width="{width}" height="{size + 16}"'
        style = f"width:100%;height:100%;font-size:{size}px;text-align:left;opacity:1;"
        self._drawn.append(
            f'<g id="{key}" type="svg-ext-html_select" font-size="{size}" fill="{_INK}">'
            f'<rect {box} fill="none" stroke="none"/><foreignObject id="H-{key}" {box}>'
            f'<select xmlns="http://www.w3.org/1999/xhtml" id="S-{key}" style={quoteattr(style)}>'
            "<option></option></select></foreignObject></g>"
        )

    def number(self, name: str, x: int, y: int) -> None:
        key = f"VAL_{name}"
        self._item(key, "svg-ext-value", name, {"ranges": []})
        self._drawn.append(
            f'<g id="{key}" type="svg-ext-value" font-size="22">'
            f'<text x="{x}" y="{y}" font-family="sans-serif" font-size="22" text-anchor="end" '
            f'fill="{_INK}">-</text></g>'
        )

    def lamp(self, name: str, x: int, y: int, colour: str, bit: int | None = None) -> None:
        """Grey while there is nothing to say."""
        key = f"GSE_{name}" if bit is None else f"GSE_{name}_{bit}"
        ranges = [
            {"type": "range", "min": 0, "max": 0, "color": _GREY},
            {"type": "range", "min": 1, "max": 1, "color": colour},
        ]
        mask = {} if bit is None else {"bitmask": 1 << bit}
        self._item(key, "svg-ext-gauge_semaphore", name, {"ranges": ranges, **mask})
        self._drawn.append(
            f'<g id="{key}" type="svg-ext-gauge_semaphore">'
            f'<ellipse id="L-{key}" cx="{x}" cy="{y}" rx="8" ry="8" fill="{_GREY}" '
            f'stroke="{_INK}"/></g>'
        )


def _named(values: list[Value], normal: set[int] | None) -> dict[int, tuple]:
    """In words; what is not normal in the colour of what is not."""
    calm, loud = ("#e8e8e8", _INK), (_ABNORMAL, "#ffffff")
    return {
        v.value: (
            v.name.replace("_", " "),
            *(calm if normal is None or v.value in normal else loud),
        )
        for v in values
    }


def _panel(map_: Map) -> tuple[_Panel, int]:
    panel = _Panel()
    panel.words(_LEFT, 40, map_.product["name"], 26)
    panel.words(_LEFT, 62, "Through levelwind serve --modbus-tcp. It looks, and gives no command.")
    # Without an answer every value is 0 there: the permit is none, and this says why.
    panel.choice(
        "map_version", _LEFT + 330, 14, 20,
        {0: ("\u25b2 NO DATA", _ABNORMAL, "#ffffff"), map_.version: ("", "#d0d0d0", _INK)}, 240,
    )  # fmt: skip
    panel.choice(
        "launch_permit", _LEFT, 80, 40,
        {0: ("\u25b2 NO LAUNCH", _ABNORMAL, "#ffffff"), 1: ("LAUNCH PERMITTED", "#e8e8e8", _INK)},
    )  # fmt: skip
    panel.choice(
        "los", _LEFT, 146, 24,
        {0: ("no LOS told", "#e8e8e8", _INK),
         1: ("\u25b2 LOS: the rope may be laid wrong", _ABNORMAL, "#ffffff")},
    )  # fmt: skip
    points = {point.name: point for point in _status_points(map_)}
    y = 206
    for name, normal in (("state", None), ("active_mode", None), ("fault", {0})):
        panel.words(_LEFT, y + 22, name.replace("_", " "))
        panel.choice(
            name, _LEFT + 130, y, 18, _named(map_.enums[points[name].enum].values, normal), 440
        )
        y += 42
    for name, title, _, _, unit in _NUMBERS:
        y += 34
        panel.words(_LEFT, y, f"{title}, {unit}" if unit else title)
        panel.number(name, _LEFT + 330, y)
    y += 46
    panel.words(_LEFT, y, "why there is no launch permit", 18)
    for at, inhibit in enumerate(map_.launch_inhibit):
        x, line = _LEFT + 300 * (at % 2), y + _ROW * (1 + at // 2)
        panel.lamp("launch_inhibit", x + 8, line, _WARNED, inhibit.value)
        panel.words(x + 26, line + 5, inhibit.name.replace("_", " "), tip=inhibit.text)
    left_end = y + _ROW * (2 + len(map_.launch_inhibit) // 2)
    half = (len(map_.flags) + 1) // 2
    panel.words(_FLAGS, 80, "flags: lit where they are on", 18)
    for at, flag in enumerate(map_.flags):
        x, line = _FLAGS + 300 * (at // half), _TOP + 10 + _ROW * (at % half)
        panel.lamp(flag.name, x + 8, line, "#ffffff")
        panel.words(x + 26, line + 5, flag.name.replace("_", " "), tip=flag.text)
    return panel, max(left_end, _TOP + 20 + _ROW * half)


def fuxa_json(map_: Map) -> str:
    panel, height = _panel(map_)
    device = {
        "id": _DEVICE,
        "name": _DEVICE,
        "type": "ModbusTCP",
        "enabled": True,
        "polling": _POLL_MS,
        "property": {
            "address": GATEWAY,
            "slaveid": "1",
            "connectionOption": "TcpPort",
            "options": True,  # asks for what stands together: the map has holes, which are refused
            "delay": 10,
        },
        "tags": _tags(map_),
    }
    view = {
        "id": _VIEW,
        "name": "levelwind",
        "type": "svg",
        "profile": {"width": _WIDTH, "height": height, "bkcolor": "#d0d0d0ff", "margin": 10},
        "items": panel.items,
        "variables": {},
        "svgcontent": panel.svg(height),
    }
    project = {
        "version": "1.01",
        "name": f"levelwind. {SOURCE}",
        "server": {"id": "0", "name": "FUXA Server", "type": "FuxaServer", "property": {}},
        "hmi": {
            "layout": {
                "start": _VIEW,
                "autoresize": True,
                "hidenavigation": True,
                "navigation": {"mode": "void", "type": "block", "items": []},
                "header": {"title": map_.product["name"]},
            },
            "views": [view],
        },
        "devices": {_DEVICE: device},
    }
    return json.dumps(project, indent=1) + "\n"
