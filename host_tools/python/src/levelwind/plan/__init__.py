# SPDX-License-Identifier: Apache-2.0
"""What follows from a parameter set, without a controller."""
