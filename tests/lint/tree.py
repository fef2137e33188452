# SPDX-License-Identifier: Apache-2.0
"""The files of this repository, as its checks see them: also in an archive of it, without git."""

import os
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path


def files_of(root: Path) -> Iterator[str]:
    """Their paths from the root, but for folders that .gitignore names: what is made or kept."""
    lines = (root / ".gitignore").read_text(encoding="utf-8").splitlines()
    kept_out = [".git", *(line.strip("/") for line in lines if line.endswith("/"))]
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(f for f in folders if not any(fnmatch(f, name) for name in kept_out))
        for name in sorted(set(names) - {".git"}):  # a file in a work tree of git's
            yield (Path(folder) / name).relative_to(root).as_posix()
