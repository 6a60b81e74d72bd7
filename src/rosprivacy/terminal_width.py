"""How wide the terminal is that standard output is, if it is one."""

from __future__ import annotations

import os
import sys

SAY_SO = ("FORCE_COLOR", "TTY_COMPATIBLE")  # variables by which a user says that it is one


def terminal_width() -> int | None:
    """Return the width; None where standard output is no terminal.

    Rich decides what is one. It is not imported where nothing could make it say so, as in a pipe.
    """
    if not _perhaps():
        return None
    from rich.console import Console  # noqa: PLC0415 - only for a terminal

    console = Console()
    return console.width if console.is_terminal else None


def _perhaps() -> bool:
    if any(name in os.environ for name in SAY_SO):
        return True
    return sys.stdout is not None and not sys.stdout.closed and sys.stdout.isatty()
