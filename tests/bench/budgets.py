# SPDX-License-Identifier: Apache-2.0
"""What bench.py holds the measurements against, and README.md names."""

FASTER_THAN_REAL_TIME_MIN = 100
LAY_SEARCH_MAX_S = 30
LOAD_MAX_PERCENT = 10
EDGE_TO_PULSE_MAX_US = 5
