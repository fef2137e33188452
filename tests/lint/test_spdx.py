# SPDX-License-Identifier: Apache-2.0
"""A source without its licence is found."""

from pathlib import Path

import pytest
import spdx

C_LINE = "/* SPDX-License-Identifier: Apache-2.0 */"


@pytest.mark.parametrize(
    ("name", "text", "good"),
    [
        ("a.c", f"{C_LINE}\nint a;\n", True),
        ("a.h", "int a;\n", False),
        ("a.h", C_LINE.replace("Apache-2.0", "MIT") + "\n", False),
        ("a.py", f'"""Text."""\n# {spdx.LINE}\n', False),
        ("a.sh", f"#!/usr/bin/env bash\n# {spdx.LINE}\n", True),
        ("dev", "#!/usr/bin/env bash\n", False),
        ("__init__.py", "", True),
    ],
)
def test_the_line_is_asked_for_where_it_belongs(name: str, text: str, good: bool):
    line = spdx.line_of(Path(name))
    assert line is not None
    assert spdx.has_line(text, line) == good


def test_what_is_no_source_needs_no_line():
    assert spdx.line_of(Path("README.md")) is None
    assert spdx.line_of(Path("registers.yaml")) is None


def test_every_source_has_it():
    paths = [path for path, line in spdx.sources(spdx.ROOT)]
    assert len(paths) > 300
    assert spdx.main() == 0
