"""How much of what two readers found a scan finds, and how much of what it finds is true (protocol.md).

In: the facts of a scan and the truth of the same system. Out: ``Counts``, which add up. What the readers dispute is
neither found nor wrong. An end that is missed is *named* if a gap stands at its very line, and *lost* otherwise.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.ingest.policies.names import resolve
from rosprivacy.ingest.scan.scan_facts import BASES, GUESSED, PACKAGE
from tests.scanned.truth import End, Outside, Start, channels

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.python_311 import Self
    from rosprivacy.ingest.scan.checkout import Checkout
    from rosprivacy.ingest.scan.scan_facts import CodeFacts, CodeNode, Gap, LaunchedSystem, Name
    from tests.scanned.truth import Truth

WEAK = (PACKAGE, GUESSED)  # ways of knowing that the goals do not count
OPEN = ""


@dataclass
class Counts:
    """Sums over systems, by what is counted: ``python``, ``c++``, ``started``, ``remaps``, ``outside``, ``channels``.

    Attributes
    ----------
    true, found
        Of the truth; and of these what the scan found.
    wrong
        What the scan says and no reader does.
    named, lost
        Of what was missed: with a gap at that line, and without a word.
    known
        By how a found end is known.
    missed, wrongs
        One line each, for people.
    """

    true: Counter[str] = field(default_factory=Counter)
    found: Counter[str] = field(default_factory=Counter)
    wrong: Counter[str] = field(default_factory=Counter)
    named: Counter[str] = field(default_factory=Counter)
    lost: Counter[str] = field(default_factory=Counter)
    known: Counter[str] = field(default_factory=Counter)
    missed: list[str] = field(default_factory=list)
    wrongs: list[str] = field(default_factory=list)

    def __iadd__(self, other: Counts) -> Self:
        """Add what was counted in another system."""
        for name in ("true", "found", "wrong", "named", "lost", "known"):
            getattr(self, name).update(getattr(other, name))
        self.missed += other.missed
        self.wrongs += other.wrongs
        return self

    def recall(self, sort: str) -> float:
        """Return the share of the truth that was found; 1.0 where there is none."""
        return self.found[sort] / self.true[sort] if self.true[sort] else 1.0

    def precision(self, sort: str) -> float:
        """Return the share of what is said that is true; 1.0 where nothing is said."""
        every = self.found[sort] + self.wrong[sort]
        return self.found[sort] / every if every else 1.0


def scanned_ends(facts: CodeFacts) -> Mapping[End, str]:
    """Return the ends of channels that a scan finds, each with how it is known, as they are without a launch file."""
    ends: dict[End, str] = {}
    for node in facts.nodes:
        for endpoint in node.endpoints:
            for name in endpoint.names:
                for whole, known in _whole(name, node):
                    end = End(endpoint.place.file, endpoint.place.line, endpoint.role, whole)
                    ends[end] = min(known, ends.get(end, known), key=BASES.index)
    return ends


def _whole(name: Name, node: CodeNode) -> Iterator[tuple[str, str]]:
    """The absolute names that a written name can be, and how each is known: as its weakest piece is."""
    written, known = _text(name)
    if written is None:
        return
    for own in node.names or ((),):
        called, how = _text(own)
        if called is None and written.startswith("~"):
            continue
        weakest = max(known, how, key=BASES.index) if written.startswith("~") else known
        for space in node.namespaces or ((),):
            prefix, sure = _text(space)
            if prefix is None:
                continue
            at = "/" + prefix.strip("/")
            relative = not written.startswith("/") and prefix.strip("/")
            yield resolve(written, at, called or ""), max(weakest, sure, key=BASES.index) if relative else weakest


def _text(name: Name) -> tuple[str | None, str]:
    """The text of a name, None with an open piece; and how it is known."""
    texts = [piece.text for piece in name]
    known = max((piece.basis for piece in name), key=BASES.index, default=BASES[0])
    return (None if None in texts else "".join(text or "" for text in texts)), known


def measured(system: str, checkout: Checkout, truth: Truth) -> Counts:
    """Return what a scan found of a system, against the truth."""
    counts = Counts()
    facts = checkout.facts
    gaps = {(gap.place.file, gap.place.line) for gap in facts.gaps} | set(open_ends(facts))
    disputed = {(one[0], one[1]) for one in truth.disputed if len(one) > 1}
    ends = {end: known for end, known in scanned_ends(facts).items() if known not in WEAK}
    for end in sorted(truth.ends):
        language = "python" if end.file.endswith(".py") else "c++"
        _count(counts, language, end in ends, (end.file, end.line) in gaps, f"{system}: {end}")
        counts.known[ends.get(end, OPEN)] += end in ends
    right = truth.ends | {end for end in ends if (end.file, end.line) in disputed}
    at_runtime = truth.runtime
    for end in sorted(ends.keys() - right):
        language = "python" if end.file.endswith(".py") else "c++"
        if (end.file, end.line, end.role) in at_runtime:
            counts.wrongs.append(f"{system}: a name is said that the sources do not fix: {end}")
        else:
            counts.wrongs.append(f"{system}: {end}")
        counts.wrong[language] += 1
    for file, line, role in sorted(at_runtime):
        said = any((end.file, end.line, end.role) == (file, line, role) for end in ends)
        _count(counts, "runtime", (file, line) in gaps and not said, said, f"{system}: {file}:{line} {role}")
    for channel, (first, second) in sorted(channels(truth.ends).items()):
        if first and second:
            both = any(end in ends for end in first) and any(end in ends for end in second)
            _count(counts, "channels", both, False, f"{system}: {channel}")
    _started(counts, system, checkout.launches, truth, disputed)
    _outside(counts, system, checkout, truth)
    return counts


def open_ends(facts: CodeFacts) -> Iterator[tuple[str, int]]:
    """Return the lines of ends of which a name has an open piece: that is a gap, too."""
    for node in facts.nodes:
        for endpoint in node.endpoints:
            if any(piece.text is None for name in endpoint.names for piece in name):
                yield endpoint.place


def _count(counts: Counts, sort: str, found: bool, named: bool, text: str) -> None:  # noqa: FBT001 - two outcomes
    counts.true[sort] += 1
    if found:
        counts.found[sort] += 1
    else:
        (counts.named if named else counts.lost)[sort] += 1
        counts.missed.append(f"{'named' if named else 'lost'} {sort}: {text}")


def _started(
    counts: Counts, system: str, launched: Iterable[LaunchedSystem], truth: Truth, disputed: set[tuple[str, int]]
) -> None:
    """Nodes of launch files by name and namespace; remaps of those that are found."""
    launched = tuple(launched)
    said = {
        Start(
            node.place.file, node.place.line, node.package, node.executable,
            (node.name or "").rpartition("/")[2], (node.namespace or "").strip("/"), tuple(sorted(node.remaps)),
        )
        for one in launched for node in one.started
    }  # fmt: skip
    gaps: set[tuple[str, int]] = {(gap.place.file, gap.place.line) for one in launched for gap in _launch_gaps(one)}
    without = {start._replace(remaps=()) for start in said}
    for start in sorted(truth.started):
        is_found = start._replace(remaps=()) in without
        _count(counts, "started", is_found, (start.file, start.line) in gaps, f"{system}: {start}")
        if start.remaps and is_found:
            mine = [one.remaps for one in said if one._replace(remaps=()) == start._replace(remaps=())]
            _count(counts, "remaps", any(set(start.remaps) <= set(one) for one in mine), False, f"{system}: {start}")
    lines = {(start.file, start.line) for start in truth.started} | disputed
    for start in sorted(without):
        if (start.file, start.line) not in lines:
            counts.wrong["started"] += 1
            counts.wrongs.append(f"{system}: {start}")


def _launch_gaps(one: LaunchedSystem) -> Iterable[Gap]:
    return one.gaps


def _outside(counts: Counts, system: str, checkout: Checkout, truth: Truth) -> None:
    used = (one for node in checkout.facts.nodes for one in node.externals)
    said = {Outside(one.place.file, one.sort) for one in (*used, *checkout.stated)}
    for outside in sorted(truth.outside):
        _count(counts, "outside", outside in said, False, f"{system}: {outside}")
    for outside in sorted(said - truth.outside - truth.disputed):
        counts.wrong["outside"] += 1
        counts.wrongs.append(f"{system}: {outside}")
