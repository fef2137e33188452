# SPDX-License-Identifier: Apache-2.0
"""Settings of Hypothesis: the same examples in every run, on every machine."""

from hypothesis import settings

settings.register_profile("deterministic", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("deterministic")
