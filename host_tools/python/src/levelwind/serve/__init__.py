# SPDX-License-Identifier: Apache-2.0
"""One owner of the port, and everybody who is served by it."""
