"""What goes wrong for a reason that the caller can name."""

from __future__ import annotations

from typing import Optional


class BimodalError(ValueError):
    """An input that can't be worked on, or a failure of the numerics.

    ``code`` is stable, for programs: "size", "range", "missing", "empty", "degenerate", "memory", "option", "type",
    "unsupported", "state", "panic", "poisoned". ``field`` is the argument at fault as a path, such as "depth.camera.fx" or "stop_degrees",
    or ``None``.
    """

    code: str
    field: Optional[str]

    def __init__(self, code: str, message: str, field: Optional[str] = None) -> None:
        # All three are the exception's arguments, so that it passes between processes.
        super().__init__(code, message, field)
        self.code = code
        self.field = field

    def __str__(self) -> str:
        return str(self.args[1])
