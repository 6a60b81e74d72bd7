"""What ``ros2`` calls: it hands over to the program ``rosprivacy`` on the path.

The program is not imported: ``ros2`` runs on the Python of its distribution (3.8 in Foxy), rosprivacy needs 3.10 and
stands in an environment of its own. So this file keeps to Python 3.8 and to the standard library.
"""

import argparse
import os
import shutil
import subprocess
import sys

from ros2cli.command import CommandExtension

MISSING = (
    "ros2 privacy: the program rosprivacy is not on the path; install it as its README says (with pipx it stands on "
    "the path of your user), and open a new terminal"
)
USAGE = 2
"""The exit code of rosprivacy for bad usage."""


class PrivacyCommand(CommandExtension):
    """Show where personal data can go in a ROS 2 system."""

    def add_arguments(self, parser, cli_name, *, argv=None):
        """Take every word that follows as it is, ``--help`` too: rosprivacy answers it."""
        parser.add_argument("words", nargs=argparse.REMAINDER, help="as `rosprivacy --help` says")
        # A word is an option if it begins with one of these signs; no word can hold this one.
        parser.prefix_chars = "\0"

    def main(self, *, parser, args):
        """Become rosprivacy, so that its exit code, its signals and its terminal are its own."""
        program = shutil.which("rosprivacy")
        if program is None:
            print(MISSING, file=sys.stderr)
            return USAGE
        command = [program, *args.words]
        if os.name == "nt":  # there a process cannot become another one
            return subprocess.call(command)  # noqa: S603  the words of whoever typed them
        sys.stdout.flush()
        return os.execv(program, command)  # noqa: S606  no shell is wanted
