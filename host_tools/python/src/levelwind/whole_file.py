# SPDX-License-Identifier: Apache-2.0
"""Files that are written whole, or not at all."""

import contextlib
import os
from pathlib import Path

from levelwind.errors import ToolError


def _private(path: str, flags: int) -> int:
    return os.open(path, flags, 0o600)


def make_folder(folder: Path) -> None:
    """A folder for such files, if it is not there; ToolError says why it cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ToolError(f"{folder} cannot be made: {error.strerror}.") from error


def write(path: Path, content: bytes | str, private: bool = False) -> None:
    """Write a file, text as UTF-8. On a full disk what was there stays; ToolError says why.

    A private one is for its user only, from its first byte on.
    """
    data = content.encode() if isinstance(content, str) else content
    in_place = path.is_symlink() or (path.exists() and not path.is_file())
    new = path if in_place else path.with_name(f"{path.name}.new")
    try:
        with open(new, "wb", opener=_private if private else None) as file:
            file.write(data)
        new.replace(path)
    except OSError as error:
        if not in_place:
            with contextlib.suppress(OSError):
                new.unlink()
        raise ToolError(f"{path} cannot be written: {error.strerror}.") from error
