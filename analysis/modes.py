"""Modes that people choose between: a word that names none is an error with the nearest, never another mode."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.analysis.written_names import did_you_mean, nearest

if TYPE_CHECKING:
    from typing import NoReturn


_WORD = re.compile(r"(?<=.)(?=[A-Z])")


class Mode(StrEnum):
    """A choice; its members are made of their words.

    >>> View("enforced")
    <View.enforced: 'enforced'>
    """

    @classmethod
    def _missing_(cls, value: object) -> NoReturn:
        known = [str(mode) for mode in cls]
        near = nearest(str(value).casefold(), known, like=0)
        what = f"{shown(str(value))!r} is none of {', '.join(known)}"
        option = _WORD.sub("-", cls.__name__).lower()
        raise InputErrors([InputError(f"--{option}", 0, what, did_you_mean(near))])


class View(Mode):
    """Rule S6: each node does what its own profile says, or what any profile of its enclave says."""

    declared = "declared"
    enforced = "enforced"


class Article9Level(Mode):
    """How far data have to fall under Article 9(1) GDPR to be asked for: each takes in those before it."""

    always = "always"
    conditional = "conditional"
    may_reveal = "may-reveal"


class Paths(Mode):
    """Which paths are listed for a finding: its witness alone, paths that share no flow, or all simple paths."""

    witness = "witness"
    disjoint = "disjoint"
    all = "all"
