#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Write a firmware's bill of materials beside it, in SPDX 2.3: build/BOARD/spdx.

Zephyr's own generator does it, that of `west spdx`; this also runs where the Zephyr tree is in no
west workspace and in no git checkout. The build must have been configured with an empty file
.cmake/api/v1/query/codemodel-v2 in its folder. The documents' namespace has the image's SHA-256.
"""

import argparse
import contextlib
import hashlib
import io
import re
import shutil
import subprocess
import sys
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parent.parent
NAMESPACE = "https://github.com/levelwind/levelwind/spdx"
ZEPHYR_REMOTE = "https://github.com/zephyrproject-rtos/zephyr"


def revision(folder: Path) -> str | None:
    """The commit of a checkout, if the folder is one and git is at hand."""
    command = ["git", "-C", folder, "rev-parse", "HEAD"]
    if shutil.which("git") is None:
        return None
    run = subprocess.run(command, check=False, capture_output=True, text=True)
    return run.stdout.strip() if run.returncode == 0 else None


def zephyr_version(base: Path) -> str:
    """As its tag is called."""
    found = dict(re.findall(r"^(\w+) = (\d+)$", (base / "VERSION").read_text(), re.M))
    return "v{VERSION_MAJOR}.{VERSION_MINOR}.{PATCHLEVEL}".format(**found)


def described(base: Path, modules: list[Path]) -> dict[str, object]:
    """What the image is made of, as zephyr.meta has it."""
    return {
        "zephyr": {
            "path": str(base),
            "revision": revision(base) or zephyr_version(base),
            "remote": ZEPHYR_REMOTE,
            "tags": [zephyr_version(base)],
        },
        "modules": [
            {"name": module.name, "path": str(module), "revision": revision(module)}
            if module != ROOT
            else {"name": "levelwind", "path": str(module), "revision": revision(module)}
            for module in modules
        ],
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=Path, help="build/BOARD")
    build = parser.parse_args().build.resolve()
    cache = (build / "CMakeCache.txt").read_text()
    base, modules = (
        re.search(rf"^{name}:\w+=(.+)$", cache, re.M) for name in ("ZEPHYR_BASE", "ZEPHYR_MODULES")
    )
    if base is None or modules is None:
        sys.exit(f"sbom: {build} is no build of a Zephyr application with modules")
    sys.path.insert(0, f"{base[1]}/scripts/west_commands")
    from zspdx import sbom, walker  # noqa: PLC0415 (it is in the Zephyr tree)

    folders = [Path(module) for module in modules[1].split(";")]
    with (build / "zephyr/zephyr.meta").open("w") as file:
        yaml.safe_dump(described(Path(base[1]), folders), file)
    # It asks only to shorten the names of files.
    walker.west_topdir = lambda _: str(Path(base[1]).parent)
    config = sbom.SBOMConfig()
    digest = hashlib.sha256((build / "zephyr/zephyr.bin").read_bytes()).hexdigest()
    config.namespacePrefix = f"{NAMESPACE}/{digest}"
    config.buildDir = str(build)
    config.spdxDir = str(build / "spdx")
    Path(config.spdxDir).mkdir(exist_ok=True)
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        done = sbom.makeSPDX(config)
    if not done:
        print(said.getvalue(), file=sys.stderr)
        return 1
    print(build.relative_to(ROOT) / "spdx")
    return 0


if __name__ == "__main__":
    sys.exit(main())
