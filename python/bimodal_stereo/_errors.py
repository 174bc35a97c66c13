"""Errors with a cause that the caller can identify."""

from __future__ import annotations

from typing import Optional


class BimodalError(ValueError):
    """An invalid input, or a failure of the numerics.

    ``code``: stable, for programs: "size", "range", "missing", "empty", "degenerate", "memory", "option", "type", "file",
        "unsupported", "state", "panic" or "poisoned".
    ``field``: the argument at fault as a path, such as "depth.camera.fx" or "stop_degrees", or ``None``.
    ``index``: index of the entry at fault, if it is a single entry of the argument.
    ``value``: the number at fault.
    """

    code: str
    field: Optional[str]
    index: Optional[int]
    value: Optional[float]

    def __init__(
        self,
        code: str,
        message: str,
        field: Optional[str] = None,
        index: Optional[int] = None,
        value: Optional[float] = None,
    ) -> None:
        # All values are the exception's arguments, so that it can be sent between processes.
        super().__init__(code, message, field, index, value)
        self.code, self.field, self.index, self.value = code, field, index, value

    def __str__(self) -> str:
        return str(self.args[1])


class BimodalWarning(UserWarning):
    """What a file reader guessed, or what looks wrong about a file: ``code`` is stable, ``field`` is the file."""

    code: str
    field: Optional[str]

    def __init__(self, code: str, message: str, field: Optional[str] = None) -> None:
        super().__init__(code, message, field)
        self.code, self.field = code, field

    def __str__(self) -> str:
        said = str(self.args[1])
        return said if self.field is None else f"{self.field}: {said}"
