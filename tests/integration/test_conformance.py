# SPDX-License-Identifier: Apache-2.0
"""The running slave through the conformance suite: nothing but passes."""

from levelwind.conformance import framing, others, reads, writes  # noqa: F401 - they hold the cases
from levelwind.conformance.line import SerialLine
from levelwind.conformance.slave import Slave as AnySlave
from levelwind.conformance.suite import Verdict, all_cases, run
from levelwind.conformance.survey import survey
from levelwind.line.port import Line
from levelwind.map_table import POINTS
from slave import UNIT, Slave

TIMEOUT_S = 2.0


def test_conformance(slave: Slave, port: str) -> None:
    slave.close()
    line = SerialLine(Line(port))
    try:
        any_slave = AnySlave(line, UNIT, TIMEOUT_S)
        scratch = POINTS["encoder_pulses_per_rev"].address
        outcomes = run(any_slave, survey(any_slave, {}, scratch=scratch), all_cases())
    finally:
        line.close()
    bad = [o for o in outcomes if o.verdict in (Verdict.DEVIATION, Verdict.FAIL)]
    assert not bad, "\n".join(f"{o.name}: {o.verdict.value}: {o.detail}" for o in bad)
    assert sum(o.verdict == Verdict.PASS for o in outcomes) > 100
