"""Errors that a user can do something about: one or two lines, no traceback."""


class ToolError(Exception):
    """The command could not do what was asked; the text says what to do. Exit status 1."""


class RefusedError(ToolError):
    """The controller answered, and refused; the text says which value broke which limit."""
