# SPDX-License-Identifier: Apache-2.0
"""Settings of Hypothesis: the same examples in every run, on every machine. And Ctrl-C."""

import signal

from hypothesis import settings

# A shell lets what it starts in the background ignore it, and so would every command under test.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

settings.register_profile("deterministic", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("deterministic")
