# SPDX-License-Identifier: Apache-2.0
"""Errors that a user can do something about: one or two lines, no traceback."""


class ToolError(Exception):
    """The command could not do what was asked; the text says what to do. Exit status 1."""


class RefusedError(ToolError):
    """The controller answered, and refused; the text says which value broke which limit.

    For a program: `reason` (map_table.Reason), the `register` by name, its `value` and the `limit`
    that it broke. None where it is not known, or no value is to blame.
    """

    def __init__(
        self,
        text: str,
        reason: int | None = None,
        register: str | None = None,
        value: int | None = None,
        limit: int | None = None,
    ) -> None:
        super().__init__(text)
        self.reason, self.register, self.value, self.limit = reason, register, value, limit

    def saying(self, text: str) -> "RefusedError":
        """The same refusal in other words."""
        return RefusedError(text, self.reason, self.register, self.value, self.limit)


class NoAnswerError(ToolError):
    """A reading has not been answered; what was written before it, is."""


class UnknownOutcomeError(ToolError):
    """Something was sent that is no reading, and its answer is lost: it may have been done.

    It is never sent again by itself: it could be done twice.
    """
