# SPDX-License-Identifier: Apache-2.0
"""A Nucleo-F446RE around an emulated processor, with the simulated winch on its pins."""
