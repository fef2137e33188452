# SPDX-License-Identifier: Apache-2.0
"""A fresh clone has the bytes of the repository, also where git is told to write CR LF."""

import shutil
import subprocess
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def git(*arguments: object, folder: Path = ROOT, given: bytes = b"") -> bytes:
    return subprocess.run(
        ["git", *map(str, arguments)], cwd=folder, input=given, capture_output=True, check=True
    ).stdout


def blobs(clone: Path, names: list[str]) -> Iterator[bytes]:
    """What the repository holds under these names."""
    asked = "".join(f"HEAD:{name}\n" for name in names).encode()
    told = BytesIO(git("cat-file", "--batch", folder=clone, given=asked))
    for _ in names:
        _, kind, size = told.readline().split()
        assert kind == b"blob"
        yield told.read(int(size))
        assert told.read(1) == b"\n"


@pytest.mark.skipif(
    not (ROOT / ".git").exists() or shutil.which("git") is None, reason="no clone, or no git"
)
@pytest.mark.parametrize("autocrlf", ["true", "input", "false"])
def test_no_line_of_a_clone_ends_otherwise_than_in_the_repository(
    tmp_path: Path, autocrlf: str
) -> None:
    clone = tmp_path / "clone"
    git("clone", "--quiet", "--no-hardlinks", "-c", f"core.autocrlf={autocrlf}", ROOT, clone)
    assert git("status", "--porcelain", folder=clone) == b""
    names = git("ls-files", "-z", folder=clone).decode().split("\0")[:-1]
    assert "dev" in names
    for name, held in zip(names, blobs(clone, names), strict=True):
        path = clone / name
        if not path.is_symlink():
            assert path.read_bytes() == held, name
    said = subprocess.run([clone / "dev", "help"], capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stderr
