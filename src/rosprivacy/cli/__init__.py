"""The command line: arguments in, out come a report and an exit code. One module per command, named as the command."""

import gc
import sys

from rosprivacy.version import __version__

__all__ = ["main"]

ENOUGH = 10_000_000  # new objects after which it is worth to look for garbage: far less of it is made than is kept


def main() -> None:
    """Run the command line; ``--version`` alone is answered before anything else is imported."""
    if sys.argv[1:] == ["--version"]:
        print(f"rosprivacy {__version__}")
        return
    gc.set_threshold(ENOUGH)
    from rosprivacy.cli.app import main as run

    try:
        run()
    finally:
        gc.freeze()  # the process ends: nothing in it has to be looked through once more
