"""Start-up: ``rosprivacy --version`` against a bare typer program that does the same, fresh processes.

Both are started by ``python``: the script that pip puts on the path imports ``re`` or not, as pip's version has it.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Row, run, timed

if TYPE_CHECKING:
    from collections.abc import Iterator

BARE = """\
from typing import Annotated
import typer

app = typer.Typer()


@app.command()
def main(version: Annotated[bool, typer.Option("--version")] = False) -> None:
    if version:
        print("bare 0.1.0")


app()
"""


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    with TemporaryDirectory() as folder:
        bare = Path(folder) / "bare.py"
        bare.write_text(BARE, "utf-8")
        yield Row(
            "rosprivacy --version",
            "a bare typer program",
            lambda: timed(
                7 if quick else 25,
                lambda: run(sys.executable, "-m", "rosprivacy", "--version"),
                lambda: run(sys.executable, bare, "--version"),
            ),
            bound=0.35 if quick else 0.3,  # few rounds, beside other work
        )
