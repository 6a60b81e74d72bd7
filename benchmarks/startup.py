"""Start-up: ``rosprivacy --version`` against a bare typer program that does the same, fresh processes."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from measure import compared, run, side_by_side

if TYPE_CHECKING:
    from measure import Line

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


def compare(folder: Path, *, quick: bool) -> Line:
    """Time both sides.

    Parameters
    ----------
    folder
        For the bare program.
    """
    bare = folder / "bare.py"
    bare.write_text(BARE, "utf-8")
    seconds = side_by_side(
        7 if quick else 25,
        lambda: run(Path(sys.executable).parent / "rosprivacy", "--version"),
        lambda: run(sys.executable, bare, "--version"),
    )
    return compared("(e) rosprivacy --version / a bare typer program", seconds, bound=0.3, goal=True)
