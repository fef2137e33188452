# SPDX-License-Identifier: Apache-2.0
"""The guard sees every kind of wrong arrow, and names the two files and the name."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import rooms

ROOT = Path(__file__).parents[2]

HOUSE = [
    {"room": "low", "files": ["lib/low"], "uses": []},
    {"room": "high", "files": ["lib/high"], "uses": ["low"]},
]


def said(files: dict[str, str], house: list[dict] = HOUSE) -> str:
    return "\n".join(rooms.problems(rooms.Rooms.of(house), files, rooms.c_arrows(files)))


def test_an_arrow_down_is_allowed():
    files = {
        "lib/low/include/lw/low.h": "int lw_low(void);",
        "lib/low/src/low.c": '#include "lw/low.h"\nint lw_low(void)\n{\n}\n',
        "lib/high/src/high.c": '#include "lw/low.h"\nint lw_high(void)\n{\n\treturn lw_low();\n}\n',
    }
    assert said(files) == ""


def test_an_include_of_a_room_above_is_named():
    files = {
        "lib/low/src/low.c": '#include "high.h"\n',
        "lib/high/include/high.h": "",
    }
    assert said(files) == (
        'lib/low/src/low.c -> lib/high/include/high.h (#include "high.h"): low may not use high'
    )


def test_a_call_upward_without_an_include_is_named():
    files = {
        "lib/low/src/low.c": (
            "int lw_high(void);\nint lw_low(void)\n{\n\treturn lw_high();\n}\n"
            "int lw_lower(void)\n{\n\treturn lw_higher();\n}\n"
        ),
        "lib/high/src/high.c": "int lw_high(void)\n{\n}\nint lw_higher(void)\n{\n}\n",
    }
    assert "low.c -> lib/high/src/high.c (lw_higher()): low may not use high" in said(files)


def test_a_circle_within_a_room_is_named_by_its_calls():
    files = {
        "lib/low/src/a.c": "void lw_a(void)\n{\n\tlw_b();\n}\n",
        "lib/low/src/b.c": "static int other(void)\n{\n}\nvoid lw_b(void)\n{\n\tlw_a();\n}\n",
    }
    assert said(files) == (
        "a circle:\n    lib/low/src/a.c -> lib/low/src/b.c (lw_b())"
        "\n    lib/low/src/b.c -> lib/low/src/a.c (lw_a())"
    )


def test_a_circle_over_three_files_is_found():
    files = {
        f"lib/low/src/{name}.c": f"void lw_{name}(void)\n{{\n\tlw_{following}();\n}}\n"
        for name, following in ("ab", "bc", "ca")
    }
    assert said(files).count("->") == 3


@pytest.mark.parametrize(
    "text",
    [
        "/* lw_b() */\n",
        'static const char *text = "lw_b()";\n',
        "struct x {\n\tint y;\n};\nint z = q.lw_b;\nint w = q->lw_b;\n",
        "void lw_b(void);\n",
    ],
)
def test_what_is_no_use_makes_no_arrow(text: str):
    files = {
        "lib/low/src/a.c": "void lw_a(void)\n{\n}\n" + text,
        "lib/low/src/b.c": "void lw_b(void)\n{\n\tlw_a();\n}\n",
    }
    assert said(files) == ""


def test_a_file_without_a_room_is_named():
    assert said({"lib/other/x.c": ""}) == "lib/other/x.c stands in no room of rooms.yaml"


def test_the_list_itself_cannot_allow_a_circle():
    house = [
        {"room": "low", "files": ["lib/low"], "uses": ["high"]},
        {"room": "high", "files": ["lib/high"], "uses": ["low"]},
    ]
    assert said({}, house) == "rooms.yaml: low uses high, which does not stand before it"


def python_said(files: dict[str, str]) -> str:
    house = [
        {"room": "low", "files": ["low", "low.py"], "uses": []},
        {"room": "high", "files": ["high"], "uses": ["low"]},
    ]
    return "\n".join(
        rooms.problems(rooms.Rooms.of(house), files, rooms.python_arrows(files, "package"))
    )


@pytest.mark.parametrize(
    "text",
    [
        "from package.high import x",
        "import package.high.x",
        "from package.high.x import name",
        "from ..high import x",
        "def f():\n    from package.high.x import name",
    ],
)
def test_an_import_from_above_is_named(text: str):
    files = {"low/a.py": text, "high/__init__.py": "", "high/x.py": "", "low/__init__.py": ""}
    assert "low/a.py -> high/x.py" in python_said(files)
    assert "low may not use high" in python_said(files)


def test_imports_down_and_of_others_are_allowed():
    files = {"high/a.py": "import os\nfrom package.low import b", "low/b.py": ""}
    assert python_said(files) == ""


def test_a_circle_of_modules_is_named():
    files = {"low/a.py": "from package.low import b", "low/b.py": "import package.low.a"}
    assert python_said(files).startswith("a circle:\n    low/a.py -> low/b.py")


def copy_of_the_repository(folder: Path) -> Path:
    for name in (*rooms.C_FOLDERS, rooms.PACKAGE, "tests/lint"):
        shutil.copytree(ROOT / name, folder / name, dirs_exist_ok=True)
    return folder


def test_this_repository_keeps_its_rooms_and_a_broken_one_does_not(tmp_path: Path):
    root = copy_of_the_repository(tmp_path)
    assert list(rooms.check(root)) == []

    law = root / "lib/lw_core/src/motion/law.c"
    law.write_text(law.read_text() + '#include "lw/control/controller.h"\n')
    points = root / rooms.PACKAGE / "line/points.py"
    points.write_text(points.read_text() + "from levelwind.show import status\n")
    found = list(rooms.check(root))
    assert any(
        "motion/law.c -> lib/lw_core/include/lw/control/controller.h" in text
        and "core/motion may not use core/control" in text
        for text in found
    )
    assert any(
        text.startswith("line/points.py -> show/status.py") and "line may not use show" in text
        for text in found
    )
    assert any(text.startswith("a circle") and "show/status.py" in text for text in found)
    command = [sys.executable, root / "tests/lint/rooms.py"]
    assert subprocess.run(command, capture_output=True, check=False).returncode == 1
