"""How commands give their answer: to a file, whole or not at all, or to standard output; and bars on a terminal."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError
from rosprivacy.cli.exit_code import SIGPIPE
from rosprivacy.terminal_width import terminal_width

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
    from pathlib import Path
    from typing import TextIO

    from rich.console import Console

    from rosprivacy.report.atomic import Text


def emit(
    text: Text,
    output: Path | None,
    other_files: Mapping[Path, str | None] | None = None,
    *,
    edited: Path | None = None,
) -> None:
    """Write the text to a file or to standard output, and other files with it; see ``write_texts``.

    Bytes are not put into the terminal's own encoding.
    """
    from rosprivacy.report.atomic import STANDARD_OUTPUT, write_texts

    answer = (output, text) if output else (STANDARD_OUTPUT, None)
    write_texts([*(other_files or {}).items(), answer], edited=edited)
    if not output:
        _print(text)


def _print(text: Text) -> None:
    if sys.stdout is None:  # `>&-`
        raise InputError("standard output", 0, "is closed", "open it, or name a file with --output")
    try:
        sys.stdout.buffer.writelines(_encoded(text))
        sys.stdout.flush()
    except BrokenPipeError:  # `| head`: end as a program does that knows nothing of pipes, not with a verdict
        silence(sys.stdout)
        sys.exit(128 + SIGPIPE)
    except OSError as error:
        silence(sys.stdout)
        hint = "free space, or write elsewhere"
        raise InputError("standard output", 0, f"cannot be written: {error.strerror}", hint) from None


def silence(stream: TextIO) -> None:
    """Let what a stream still holds go nowhere: else Python writes it at its end, and ends with a code of its own."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _encoded(text: Text) -> Iterator[bytes]:
    encoding = ""
    for piece in (text,) if isinstance(text, str | bytes) else text:
        encoding = encoding or (_encoding(piece) if isinstance(piece, str) else "")
        yield piece.encode(encoding, "backslashreplace") if isinstance(piece, str) else piece


def _encoding(text: str) -> str:
    """JSON and Turtle are UTF-8 wherever they go; other text is what the terminal understands."""
    return "utf-8" if text.startswith(("{", "@prefix")) else sys.stdout.encoding


def not_for_a_terminal(form: str, output: Path | None) -> None:
    """Refuse to pour into a terminal what nobody reads there, before anything is computed."""
    if output is None and sys.stdout is not None and sys.stdout.isatty():
        raise InputError("standard output", 0, f"{form} is not for a terminal", "name a file with --output, or pipe it")


def on_console(write: Callable[[Console], None], *, colour: bool) -> str:
    """Return what is written to a rich console, with colours if standard output is a terminal."""
    from io import StringIO

    from rich.console import Console

    text = StringIO()
    write(Console(file=text, force_terminal=colour and terminal_width() is not None, highlight=False, emoji=False))
    return text.getvalue()


def progress_of(files: Sequence[str], inputs: str = "policies") -> Iterable[str]:
    """Show a bar on a terminal when there is much to read."""
    many = 20
    if len(files) < many or not sys.stderr.isatty():
        return files
    from rich.console import Console
    from rich.progress import track

    return track(files, description=f"Reading {inputs}", console=Console(stderr=True), transient=True)
