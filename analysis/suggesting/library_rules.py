"""Rules about libraries, as data, and which of them speak about what code uses.

A use is a name as the code's imports resolve it: ``cv2.VideoCapture`` in Python, ``cv::VideoCapture`` in C++. A rule
about a name speaks about all that is below it, too: one about ``whisper`` about ``whisper.load_model``. Of several such
rules the one with the longest name speaks. What stands in brackets behind a name says how it is called: ``open(w)``
opens a file to write; a rule about ``open`` speaks about it, too. A program that code starts is used as ``$ espeak``,
an address that stands in it as ``@ https://api.openai.com/v1``. A rule about addresses names a part of them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.suggesting.evidence import CODE, Evidence
from rosprivacy.analysis.suggesting.weighing import weaker

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Confidence, Place
    from rosprivacy.analysis.suggesting.evidence import SuggestedLabel
    from rosprivacy.analysis.suggesting.name_rules import NameRule

PYTHON, CPP = "python", "c++"
PROGRAM = "$ "  # before the name of a program that code starts
ADDRESS = "@ "  # before an address that stands in code
_VERBS = {PROGRAM: "starts", ADDRESS: "names"}  # what code does with a thing of such a name
_END = re.compile(r"(?:\.|::|[(]| )[^.:( ]*$")  # of a name: its last part, with the sign before it


class NodeUse(NamedTuple):
    """One thing that the code of a node uses, named as the imports of its file resolve it; ``python`` or ``c++``."""

    name: str
    language: str
    place: Place


class RuleOfUse(NamedTuple):
    """A rule, and the first use that it speaks about."""

    rule: NameRule
    use: NodeUse

    def evidence(self, label: SuggestedLabel, sure: Confidence, consequence: str = "") -> Evidence:
        """Return what it says for a label: no surer than the rule."""
        name = self.use.name
        verb = next((verb for sign, verb in _VERBS.items() if name.startswith(sign)), "")
        what = f"{verb} {name[2:]}" if verb else f"uses {name}"
        reason = f"{what} ({self.use.place}): {self.rule.why}{consequence}"
        sure = weaker(sure, self.rule.confidence)
        return Evidence(label, CODE, sure, reason, self.use.place, alone=self.rule.alone, where=self.rule.where)


@dataclass(frozen=True)
class RulesByName:
    """Rules by name, by what names begin with (written with ``*`` at its end), and by a part of an address.

    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.name_rules import NameRule
    >>> rule = NameRule(("Voice",), Confidence.LIKELY, "a microphone", Place("libraries.yaml", 1))
    >>> names = RulesByName(dict.fromkeys(["sounddevice.InputStream", "Pa_Open*", "@ api.openai.com"], rule))
    >>> asked = ("sounddevice.InputStream.read", "sounddevice.play", "Pa_OpenStream", "@ https://api.openai.com/v1")
    >>> [bool(names.of(name)) for name in asked]
    [True, False, True, True]
    """

    rules: Mapping[str, NameRule]

    @cached_property
    def _starred(self) -> tuple[str, ...]:
        return tuple(sorted((name[:-1] for name in self.rules if name.endswith("*")), key=len, reverse=True))

    @cached_property
    def _parts(self) -> list[str]:
        parts = (name.removeprefix(ADDRESS) for name in self.rules if name.startswith(ADDRESS))
        return sorted(parts, key=len, reverse=True)

    @cached_property
    def _matches(self) -> dict[str, tuple[str, NameRule] | None]:
        return {}  # code uses the same names again and again

    def of(self, name: str) -> tuple[str, NameRule] | None:
        """Return the longest name that is this one, or above it, with its rule; of an address the longest part."""
        if name not in self._matches:
            self._matches[name] = self._longest(name)
        return self._matches[name]

    def _longest(self, name: str) -> tuple[str, NameRule] | None:
        if name.startswith(ADDRESS):
            part = next((one for one in self._parts if one in name), None)
            return (part, self.rules[ADDRESS + part]) if part else None
        for above in _above(name):
            if above in self.rules:
                return above, self.rules[above]
        if not name.startswith(self._starred):  # of most; asked for all at once
            return None
        start = next(one for one in self._starred if name.startswith(one))
        return start, self.rules[f"{start}*"]


class LibraryRules(NamedTuple):
    """The rules of all files, by language: what a node brings in, lets out, or makes of another kind.

    Attributes
    ----------
    silent
        Names that suggest nothing; they speak where no rule has a longer name.
    """

    brings_in: Mapping[str, RulesByName]
    lets_out: Mapping[str, RulesByName]
    makes: Mapping[str, RulesByName]
    silent: Mapping[str, frozenset[str]]

    def spoken(self, section: Mapping[str, RulesByName], use: NodeUse) -> NameRule | None:
        """Return the rule of a section that speaks about a use, if there is one."""
        found = section[use.language].of(use.name) if use.language in section else None
        if found is None:
            return None
        name, rule = found
        quiet = self.silent.get(use.language, frozenset())
        return None if any(above in quiet for above in _above(use.name) if len(above) >= len(name)) else rule

    def of_node(self, uses: Sequence[NodeUse]) -> dict[str, list[RuleOfUse]]:
        """Return by section the rules that speak about the uses of a node."""
        found: dict[str, list[RuleOfUse]] = {"brings_in": [], "makes": [], "lets_out": []}
        for name in found if uses else ():
            speaking: dict[NameRule, NodeUse] = {}
            for use in uses:
                if rule := self.spoken(getattr(self, name), use):
                    speaking.setdefault(rule, use)
            found[name] = [RuleOfUse(rule, use) for rule, use in speaking.items()]
        return found

    def speaks(self, use: NodeUse) -> bool:
        """Return whether any rule speaks about a use."""
        return any(self.spoken(section, use) for section in (self.brings_in, self.lets_out, self.makes))


def _above(name: str) -> Iterator[str]:
    """A name and those above it, the longest first.

    >>> list(_above("a.b.open(w)")), list(_above("$ ros2 bag"))
    (['a.b.open(w)', 'a.b.open', 'a.b', 'a'], ['$ ros2 bag', '$ ros2'])
    """
    while name and name != PROGRAM.strip():
        yield name
        found = _END.search(name)
        name = name[: found.start()] if found else ""
