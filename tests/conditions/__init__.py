# SPDX-License-Identifier: Apache-2.0
"""Coverage of branches and conditions of the core."""
