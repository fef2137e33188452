# SPDX-License-Identifier: Apache-2.0
"""A document that names what is not there is found, and what is there is left alone."""

import documents
import pytest

FILES = [
    *("dev", "README.md", "lib/lw_core/src/control/params.c", "doc/board.md"),
    *("lib/lw_core/include/lw/motion/law.h", "tests/python/test_cli.py", "profiles/a.yaml"),
]


def said(text: str, document: str = "doc/x.md") -> list[str]:
    tree = documents.Tree(FILES, ["lw_law_edge", "is_guarded", "lw_law"])
    return list(documents.problems(document, text, tree, ["test", "run"]))


@pytest.mark.parametrize(
    "text",
    [
        "`lib/lw_core/src/control/params.c`, `control/params.c`, `params.c`, `control/params`",
        "`lw/motion/law.h` and `motion/law`, a folder `lib/lw_core`, `tests/python/`, `tests/*`",
        "`tests/python/test_{cli}.py`, `pytest tests/python/test_cli.py::test_x`, `test_*.py`",
        "`out/launch.png`, `build/host/lw_sim`, `winch.yaml`, `1/2`, `dP/Ks`, `FILE.md`",
        "[board](board.md#top), [root](../README.md), [web](https://example.org/x.md)",
        "`./dev test tests/python`\n    ./dev run",
        "`lw_law_edge()`, `is_guarded()`, `struct lw_law`, `lw_law`, `law(1)`",
    ],
)
def test_what_is_there_or_no_path_is_left_alone(text: str):
    assert said(text) == []


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("`src/params.c`", "doc/x.md: `src/params.c` is not there"),
        ("`law.c`", "doc/x.md: `law.c` is not there"),
        ("`lib/lw_core/src/motions/`", "doc/x.md: `lib/lw_core/src/motions/` is not there"),
        ("`test_{cli,other}.py`", "doc/x.md: `test_other.py` is not there"),
        ("[b](boards.md)", "doc/x.md: the link to boards.md leads nowhere"),
        ("`lw_law_edges()`", "doc/x.md: `lw_law_edges()` stands in no source"),
        ("`guarded()`", "doc/x.md: `guarded()` stands in no source"),
        ("`lw_laws`", "doc/x.md: `lw_laws` stands in no source"),
        ("    ./dev tests", "doc/x.md: `./dev tests` is no command"),
    ],
)
def test_what_is_not_there_is_named(text: str, problem: str):
    assert said(text) == [problem]


def test_this_repositorys_documents_name_what_is_there():
    assert list(documents.check(documents.ROOT)) == []
