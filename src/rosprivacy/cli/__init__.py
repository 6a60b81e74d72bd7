"""The command line: arguments in, out come a report and an exit code. One module per command, named as the command."""

import sys

from rosprivacy.version import __version__

__all__ = ["main"]


def main() -> None:
    """Run the command line; ``--version`` alone is answered before anything else is imported."""
    if sys.argv[1:] == ["--version"]:
        print(f"rosprivacy {__version__}")
        return
    from rosprivacy.cli.app import main as run

    run()
