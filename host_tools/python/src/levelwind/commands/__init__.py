# SPDX-License-Identifier: Apache-2.0
"""The commands, by subject. cli.py names them."""
