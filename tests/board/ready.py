# SPDX-License-Identifier: Apache-2.0
"""Boards that are set up and indexed, made once: indexing takes seconds."""

import functools

from levelwind.map_table import Command, Result, State

from board.machine import Board

BAUD = 19_200


@functools.cache
def _indexed(config: tuple[tuple[str, int], ...]) -> tuple[Board, int]:
    wanted = dict(config)
    baud = wanted.pop("baud", BAUD)
    board = Board(**wanted)
    pulses = board.config.encoder_pulses_per_rev
    board.apply(baud_rate=baud, encoder_pulses_per_rev=pulses)
    assert board.command(Command.SAVE) == Result.DONE
    board.line_settings(baud, "E")
    board.power_cycle(0.6)
    board.index()
    board.run_until(lambda: board.state == State.TRACKING, step_s=0.05)
    board.clear_seen()
    return board, board.save()


def indexed(**config: int) -> Board:
    """A Nucleo that is set up, indexed, and follows the drum, at rest."""
    board, state = _indexed(tuple(sorted(config.items())))
    board.restore(state)
    board.line_settings(config.get("baud", BAUD), "E")
    return board
