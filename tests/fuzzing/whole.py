"""A result -> every format, and a command in this process with its exit code."""

from __future__ import annotations

import contextlib
import io
import json
import sys
from functools import cache
from typing import TYPE_CHECKING
from unittest.mock import patch

import typer.main

from rosprivacy.cli.app import main
from rosprivacy.cli.exit_code import FailOn, exit_code
from rosprivacy.formats import FORMATS
from tests.fuzzing.mutations import SECRET
from tests.helpers.word import text_of

if TYPE_CHECKING:
    from rosprivacy.result import Result

BUILT = cache(typer.main.get_command)
ANSWERS = {0, 1, 4}  # of a command that could read its input; 2 where it could not
REFUSED = 2


def report_whole(result: Result, *, twice: bool) -> None:
    """Write a result in every format."""
    assert exit_code(result, (FailOn.undetermined,)) in ANSWERS
    for name in FORMATS:
        text = result.to(name)
        assert text, f"nothing in {name}"
        read = text_of(text) if isinstance(text, bytes) else text
        assert SECRET not in read, f"{name} tells what a file of others holds"
        if name in ("json", "sarif", "cnil-pia", "json-ld"):
            json.loads(text)
        if twice and name != "cnil-pia":  # holds the time
            assert result.to(name) == text, f"{name} differs the second time"


def run_command(arguments: tuple[str, ...], *, refused: bool) -> None:
    """Run a command: what its reader refuses ends with 2 and lines, anything else with a code of the table."""
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", write_through=True) for _ in range(2))
    with (
        patch.object(sys, "argv", ["rosprivacy", *arguments]),
        patch.object(typer.main, "get_command", BUILT),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
    ):
        try:
            main()
            code: object = 0
        except SystemExit as ended:
            code = ended.code or 0
    printed, said = (stream.buffer.getvalue().decode() for stream in (out, err))
    assert code in ({REFUSED} if refused else ANSWERS | {REFUSED}), f"exit code {code}: {said[-2000:]}"
    assert "Traceback" not in said, said
    if code == REFUSED:
        assert not printed, "an answer beside a refusal"
        assert said, "a refusal without a word"
