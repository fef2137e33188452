# SPDX-License-Identifier: Apache-2.0
"""What bench.py holds the measurements against, and README.md names."""

FASTER_THAN_REAL_TIME_MIN = 1_000
LAUNCHES_PER_S_MIN = 100  # on two processors
ANSWER_PERMILLE_MAX_MS = 5  # 99.9 % of the answers
LAY_SEARCH_MAX_S = 30
LOAD_MAX_PERCENT = 10
EDGE_TO_PULSE_MAX_US = 5
