# SPDX-License-Identifier: Apache-2.0
"""Cam tables."""
