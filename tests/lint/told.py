# SPDX-License-Identifier: Apache-2.0
"""How a check of this folder ends."""

import sys
from collections.abc import Iterable


def tell(problems: Iterable[str]) -> int:
    """Print what is wrong, a line each. Returns the exit status: 1 if anything is."""
    status = 0
    for problem in problems:
        print(problem, file=sys.stderr)
        status = 1
    return status
