# SPDX-License-Identifier: Apache-2.0
"""The laptop tool of the levelwind controller."""
