# SPDX-License-Identifier: Apache-2.0
"""How often was something injected, and the power cut: told at the end of a run."""

from collections import Counter

import pytest

COUNTED = ("injections", "cuts")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """The sums of what the tests have recorded."""
    sums: Counter[str] = Counter()
    for outcome in ("passed", "failed"):
        for report in terminalreporter.getreports(outcome):
            for name, value in report.user_properties:
                if name in COUNTED and report.when == "call":
                    sums[name] += value
    for name, count in sums.items():
        terminalreporter.write_line(f"{name}: {count}")
