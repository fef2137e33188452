# SPDX-License-Identifier: Apache-2.0
"""The simulated machine, its launches and their pictures."""
