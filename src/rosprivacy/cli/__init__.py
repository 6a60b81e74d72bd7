"""The command line: arguments in, out come a report and an exit code. One module per command, named as the command."""

from rosprivacy.cli.app import main

__all__ = ["main"]
