"""Rules about libraries, as data, and which of them speak about what code uses.

A use is a name as the code's imports resolve it: ``cv2.VideoCapture`` in Python, ``cv::VideoCapture`` in C++. A rule
about a name speaks about all that is below it, too: one about ``whisper`` about ``whisper.load_model``. Of several such
rules the one with the longest name speaks. What stands in brackets behind a name says how it is called: ``open(w)``
opens a file to write; a rule about ``open`` speaks about it, too. A program that code starts is used as ``$ espeak``,
an address that stands in it as ``@ https://api.openai.com/v1``. A rule about addresses names a part of them.
"""

from __future__ import annotations

import re
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import CODE, Evidence
from rosprivacy.analysis.suggesting.weighing import weaker

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Place
    from rosprivacy.analysis.suggesting.evidence import Label

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


class LibraryRule(NamedTuple):
    """What the use of a library suggests of a node.

    Attributes
    ----------
    kinds
        Names of categories: what it brings in, or lets out; of what it makes something.
    to
        The categories that are made; none where it makes nothing.
    where
        Of what lets data out: where they go.
    any_type
        Whether it can have any form, a flag or a velocity, so that no message type speaks against it.
    by_itself
        Of what makes something: whether it reads ROS by itself, as a listener of transforms does.
    alone
        Of what brings something in: whether it agrees with nothing, as a window does that is called so.
    writes
        Of what lets data out: last parts of names by which it does, if it can also be asked only. Where nothing of it
        is used that is called so, it may be.
    """

    kinds: tuple[str, ...]
    confidence: Confidence
    why: str
    place: Place
    to: tuple[str, ...] = ()
    where: str = ""
    any_type: bool = False
    by_itself: bool = False
    alone: bool = False
    writes: tuple[str, ...] = ()

    def of_uses(self, uses: Sequence[NodeUse]) -> tuple[LibraryRule, NodeUse]:
        """Return what the rule says of the uses that it speaks about, and the one that shows it best.

        >>> from rosprivacy.analysis.model import Confidence, Place
        >>> rule = LibraryRule((), Confidence.LIKELY, "a database", Place("libraries.yaml", 1), writes=("commit",))
        >>> uses = [NodeUse(f"sqlite3.connect.{name}", "python", Place("a.py", 1)) for name in ("cursor", "commit")]
        >>> [(str(one.confidence), use.name) for one, use in (rule.of_uses(uses), rule.of_uses(uses[:1]))]
        [('likely', 'sqlite3.connect.commit'), ('may', 'sqlite3.connect.cursor')]
        """
        if not self.writes:
            return self, uses[0]
        writing = next((use for use in uses if use.name.rpartition(".")[2] in self.writes), None)
        return (self, writing) if writing else (self._replace(confidence=Confidence.MAY), uses[0])


class RuleOfUse(NamedTuple):
    """A rule, and the use that it speaks about and that shows it best."""

    rule: LibraryRule
    use: NodeUse

    def evidence(self, label: Label, sure: Confidence, then: str = "") -> Evidence:
        """Return what it says for a label: no surer than the rule."""
        name = self.use.name
        verb = next((verb for sign, verb in _VERBS.items() if name.startswith(sign)), "")
        what = f"{verb} {name[2:]}" if verb else f"uses {name}"
        reason = f"{what} ({self.use.place}): {self.rule.why}{then}"
        return Evidence(label, CODE, weaker(sure, self.rule.confidence), reason, self.use.place, alone=self.rule.alone)


class Names(NamedTuple):
    """Rules by name; by what names begin with (written with ``*`` at its end); by a part of an address.

    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> rule = LibraryRule(("Voice",), Confidence.LIKELY, "a microphone", Place("libraries.yaml", 1))
    >>> names = Names({"sounddevice.InputStream": rule}, {"Pa_Open": rule}, {"api.openai.com": rule})
    >>> asked = ("sounddevice.InputStream.read", "sounddevice.play", "Pa_OpenStream", "@ https://api.openai.com/v1")
    >>> [bool(names.of(name)) for name in asked]
    [True, False, True, True]
    """

    rules: Mapping[str, LibraryRule]
    starred: Mapping[str, LibraryRule]
    addresses: Mapping[str, LibraryRule] = MappingProxyType({})

    def of(self, name: str) -> tuple[str, LibraryRule] | None:
        """Return the longest name that is this one, or above it, with its rule; of an address the longest part."""
        if name.startswith(ADDRESS):
            part = max((one for one in self.addresses if one in name), key=len, default="")
            return (part, self.addresses[part]) if part else None
        for above in _above(name):
            if above in self.rules:
                return above, self.rules[above]
        longest = max((own for own in self.starred if name.startswith(own)), key=len, default="")
        return (longest, self.starred[longest]) if longest else None


class LibraryRules(NamedTuple):
    """The rules of all files, by language: what a node brings in, lets out, or makes of another kind.

    Attributes
    ----------
    silent
        Names that suggest nothing; they speak where no rule has a longer name.
    """

    brings_in: Mapping[str, Names]
    lets_out: Mapping[str, Names]
    makes: Mapping[str, Names]
    silent: Mapping[str, frozenset[str]]

    def spoken(self, section: Mapping[str, Names], use: NodeUse) -> LibraryRule | None:
        """Return the rule of a section that speaks about a use, if there is one."""
        found = section[use.language].of(use.name) if use.language in section else None
        if found is None:
            return None
        name, rule = found
        quiet = self.silent.get(use.language, frozenset())
        return None if any(above in quiet for above in _above(use.name) if len(above) >= len(name)) else rule

    def of_node(self, uses: Sequence[NodeUse]) -> dict[str, list[RuleOfUse]]:
        """Return by section the rules that speak about the uses of a node."""
        found: dict[str, list[RuleOfUse]] = {}
        for name in ("brings_in", "makes", "lets_out"):
            speaking: dict[LibraryRule, list[NodeUse]] = {}
            for use in uses:
                if rule := self.spoken(getattr(self, name), use):
                    speaking.setdefault(rule, []).append(use)
            found[name] = [RuleOfUse(*rule.of_uses(of_rule)) for rule, of_rule in speaking.items()]
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
