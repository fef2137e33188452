# SPDX-License-Identifier: Apache-2.0
"""A controller at the other end of a serial line."""
