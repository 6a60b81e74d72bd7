"""Programs that code starts by a literal command: ``$ espeak``, ``$ ros2 bag record``."""

from __future__ import annotations

import re
from itertools import takewhile
from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.library_rules import PROGRAM

if TYPE_CHECKING:
    from collections.abc import Iterable

BEFORE = ("sudo", "exec", "nohup", "env")  # words before the program itself
WITH_COMMANDS = ("ros2", "rosbag", "git")  # programs of which the next words say what they do
LONGEST = 3  # words that are kept of these: ros2 bag record
WORD = re.compile(r"[A-Za-z_][\w.-]*", re.ASCII)


def program(words: Iterable[str]) -> str:
    """Return what is started by the words of a command; empty if none is a program.

    >>> program(["sudo", "/usr/bin/arecord", "-d", "5"]), program("ros2 bag record -a".split()), program([])
    ('$ arecord', '$ ros2 bag record', '')
    """
    given = [*words][: LONGEST + 1]
    given = given[1:] if given and given[0] in BEFORE else given
    name = given[0].rpartition("/")[2] if given else ""
    if not WORD.fullmatch(name):
        return ""
    more = given[1:LONGEST] if name in WITH_COMMANDS else []
    return PROGRAM + " ".join([name, *takewhile(WORD.fullmatch, more)])
