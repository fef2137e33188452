# SPDX-License-Identifier: Apache-2.0
"""Guided commissioning: a dialogue that measures, proposes, explains and signs."""
