# SPDX-License-Identifier: Apache-2.0
"""What belongs to the repository is seen, what is made from it is not; git has no say in it."""

from pathlib import Path

import pytest
from tree import files_of


def test_what_is_made_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    (tmp_path / ".gitignore").write_text("/build/\n__pycache__/\n*.egg-info/\n")
    for name in ("dev", "src/a.c", ".ci/run", "build/a.o", "src/__pycache__/a.pyc", "x.egg-info/y",
                 ".git/config"):  # fmt: skip
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    assert list(files_of(tmp_path)) == [".gitignore", "dev", ".ci/run", "src/a.c"]
