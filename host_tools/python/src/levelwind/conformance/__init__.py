# SPDX-License-Identifier: Apache-2.0
"""A Modbus RTU slave, whichever it is, against the two standards that it follows.

AP is "MODBUS Application Protocol Specification V1.1b3", SL is "MODBUS over Serial Line
Specification and Implementation Guide V1.02". Nothing here knows the map of a level wind.
"""
