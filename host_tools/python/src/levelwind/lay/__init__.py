# SPDX-License-Identifier: Apache-2.0
"""How rope lies on the drum: wind ratio, ribbons, evenness, better settings, metres."""
