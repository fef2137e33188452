# SPDX-License-Identifier: Apache-2.0
"""The compiled core and an independent model of it."""
