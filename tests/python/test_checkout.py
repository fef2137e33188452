# SPDX-License-Identifier: Apache-2.0
"""A fresh clone has the bytes of the repository, also where git is told to write CR LF."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def git(*arguments: object, folder: Path = ROOT) -> bytes:
    return subprocess.run(
        ["git", *map(str, arguments)], cwd=folder, capture_output=True, check=True
    ).stdout


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="no clone of the repository")
@pytest.mark.parametrize("autocrlf", ["true", "input", "false"])
def test_no_line_of_a_clone_ends_otherwise_than_in_the_repository(
    tmp_path: Path, autocrlf: str
) -> None:
    clone = tmp_path / "clone"
    git("clone", "--quiet", "--no-hardlinks", "-c", f"core.autocrlf={autocrlf}", ROOT, clone)
    assert git("status", "--porcelain", folder=clone) == b""
    for name in git("ls-files", "-z", folder=clone).decode().split("\0")[:-1]:
        path = clone / name
        if not path.is_symlink():
            assert path.read_bytes() == git("cat-file", "blob", f"HEAD:{name}"), name
    said = subprocess.run([clone / "dev", "help"], capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stderr
