"""Rules S7, S8, S10 and S11 word for word, on sets, with no thought of speed: what the fast version is held against.

A state is (vertex, category, pseudonymised). Statements here all have one name rank, so only nearness decides.
"""

from __future__ import annotations

import re
from collections import deque
from dataclasses import dataclass, field
from datetime import date
from functools import cache
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Place, Statement

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.outside import Outside

Data = tuple[str, bool]  # category, pseudonymised

MAY = {"leak", "derivation", "only"}
PAIRS = [
    {"source", "sanitizer"},
    {"source", "conduit"},
    {"leak", "conduit"},
    {"sanitizer", "conduit"},
    {"mundane", "sensitive"},
    {"mundane", "only"},
    {"sensitive", "only"},
    {"sensitive", "never"},
]
ENDS = {"anonymise", "aggregate", "drop"}
CONDUIT = Statement("conduit", (), (-1, 0), Place("", 0))
LEAK = Statement("leak", (), (-1, 0), Place("", 0))
BY_KIND = {
    "storage": [CONDUIT],
    "shared-memory": [CONDUIT],
    "side-channel": [CONDUIT],
    "external-system": [LEAK],
    "display": [LEAK],
    "person": [LEAK],
}  # S9: what is taken of an element outside ROS, unless a label says otherwise
ABROAD = {"third", "partly"}


@cache
def longer(ours: str, theirs: str) -> bool:
    """Whether a duration is longer than another from the first of some month on (all of 400 years are tried)."""
    return any(_end(day, ours) > _end(day, theirs) for day in _FIRSTS)


_FIRSTS = [date(year, month, 1) for year in range(1600, 2000) for month in range(1, 13)]


def _end(start: date, durations: str) -> int:
    """The day on which one or several durations such as ``P10D`` end, added up."""
    parts = [(int(n), unit) for n, unit in re.findall(r"P(\d+)([DMY])", durations)]
    months = start.year * 12 + start.month - 1 + sum({"D": 0, "M": 1, "Y": 12}[unit] * n for n, unit in parts)
    return date(months // 12, months % 12 + 1, 1).toordinal() + sum(n for n, unit in parts if unit == "D")


@dataclass
class Brute:
    """A small system."""

    nodes: Collection[int]
    edges: list[tuple[int, int]]
    said: dict[int, list[Statement]]
    hierarchy: Hierarchy
    never: dict[tuple[int, int], set[str]] = field(default_factory=dict)  # of flows
    outside: dict[int, tuple[str, Outside]] = field(default_factory=dict)  # kind, facts
    along: set[tuple[int, int, Data]] = field(default_factory=set)  # what the last spread sent along flows

    def nearness(self, statement: Statement, category: str) -> int | None:
        """S7: steps up to what is named; negative if it is narrower and the role is one of *may*."""
        if not statement.categories or statement.role == "only":
            return 1_000_000
        if statement.role == "source":
            return 0 if category in statement.categories else None
        up = [d for named in statement.categories if (d := self.hierarchy.distance(category, named)) is not None]
        if up:
            return min(up)
        down = [d for named in statement.categories if (d := self.hierarchy.distance(named, category)) is not None]
        return -min(down) if down and statement.role in MAY else None

    def holding(self, vertex: int, category: str) -> list[Statement]:
        """S7: the statements that apply, but for those that a nearer one contradicts."""
        said = [*self.said.get(vertex, []), *BY_KIND.get(self.outside.get(vertex, ("",))[0], [])]
        applying = [s for s in said if self.nearness(s, category) is not None]

        def weight(s: Statement) -> tuple[int, int]:
            near = self.nearness(s, category)
            assert near is not None
            return (s.rank[0], -near)

        def outdone(s: Statement) -> bool:
            return any(
                ({s.role, t.role} in PAIRS or (s.role == t.role == "sanitizer" and s.method != t.method))
                and weight(t) > weight(s)
                for t in applying
            )

        return [s for s in applying if not outdone(s)]

    def has(self, vertex: int, role: str, category: str) -> bool:
        return any(s.role == role for s in self.holding(vertex, category))

    def kills(self, vertex: int, category: str) -> bool:
        for s in self.holding(vertex, category):
            if s.role in ("sanitizer", "mundane", "never"):
                return True
            if s.role == "only" and not any(
                category in self.hierarchy.ancestors[k] or k in self.hierarchy.ancestors[category] for k in s.categories
            ):
                return True
        return False

    def only_hides(self, vertex: int, category: str) -> bool:
        """Whether all that cleans it pseudonymises: what is pseudonymised already goes on so."""
        sanitizers = [s for s in self.holding(vertex, category) if s.role == "sanitizer"]
        return bool(sanitizers) and all(str(s.method) not in ENDS for s in sanitizers)

    def made(self, vertex: int, data: Data) -> set[Data]:
        """S8: derive, and what is made of that in turn; and pseudonymise."""
        category, hidden = data
        names, before = {category}, set[str]()
        while names != before:
            before = set(names)
            names |= {s.to for c in before for s in self.holding(vertex, c) if s.role == "derivation"}
        result = {(name, hidden) for name in names if name != category}
        sanitizers = [s for s in self.holding(vertex, category) if s.role == "sanitizer"]
        if not hidden and any(str(s.method) not in ENDS for s in sanitizers):
            result.add((category, True))
        return result

    def emitted(self, vertex: int) -> set[Data]:
        """What a source names, and what it makes of its own data."""
        own = {c for s in self.said.get(vertex, []) for c in s.categories if s.role == "source"}
        data = {(c, False) for c in own if self.has(vertex, "source", c)}
        return data | {made for d in data for made in self.made(vertex, d) if not made[1]}

    def spread(
        self, sources: Collection[int], stop: Callable[[int, Data], bool] = lambda _v, _d: False
    ) -> dict[tuple[int, Data], int]:
        """What is where (arrives, starts or is made there) -> least number of flows from a source."""
        present: dict[tuple[int, Data], int] = {}
        leaving: deque[tuple[int, Data, int]] = deque()
        left = set()

        def leave(vertex: int, data: Data, level: int) -> None:
            if (vertex, data) not in left:
                left.add((vertex, data))
                leaving.append((vertex, data, level))

        for source in sorted(sources):
            for data in self.emitted(source):
                present[source, data] = 0
                leave(source, data, 0)
        arrived = set()
        self.along = set()
        while leaving:
            vertex, data, level = leaving.popleft()
            for a, b in self.edges:
                if a != vertex:
                    continue
                if b not in self.nodes and self.kills(b, data[0]):
                    continue
                if any(named in self.hierarchy.ancestors[data[0]] for named in self.never.get((a, b), ())):
                    continue
                self.along.add((a, b, data))
                if (b, data) in arrived:
                    continue
                arrived.add((b, data))
                present.setdefault((b, data), level + 1)
                if stop(b, data):
                    continue
                if not self.kills(b, data[0]) or (data[1] and self.only_hides(b, data[0])):
                    leave(b, data, level + 1)
                for made in self.made(b, data):
                    present.setdefault((b, made), level + 1)
                    if not stop(b, made):
                        leave(b, made, level + 1)
        return present

    def sources(self) -> set[int]:
        return {v for v in self.said if self.emitted(v)}

    def nearest(self, stated: Collection[tuple[str, object]], category: str) -> list[str]:
        """S7: durations stated for the category or the nearest broader one; for every category last."""
        steps = [
            (self.hierarchy.distance(category, name) if name else 1_000_000, str(how_long)) for name, how_long in stated
        ]
        known = [(step, how_long) for step, how_long in steps if step is not None]
        return [how_long for step, how_long in known if step == min(known)[0]]

    def kept_too_long(self, vertex: int, category: str) -> bool:
        """S10: no stated retention, or one longer than allowed; the data may be of any narrower kind."""
        kind, facts = self.outside.get(vertex, ("", None))
        if kind != "storage" or facts is None:
            return False
        kinds = [name for name, above in self.hierarchy.ancestors.items() if category in above]
        more = "" if facts.backups is None else str(facts.backups)
        return facts.backups is True or any(
            not self.nearest(facts.retention, name)
            or any(
                longer(f"{kept} {more}", limit)
                for kept in self.nearest(facts.retention, name)
                for limit in self.nearest(facts.limits, name)
            )
            for name in kinds
        )

    def abroad(self, vertex: int) -> bool:
        """S10: outside the EEA without a stated basis."""
        facts = self.outside[vertex][1] if vertex in self.outside else None
        return facts is not None and facts.area in ABROAD and not facts.transfer

    def findings(
        self, accepted: Callable[[str, int, int, bool], bool] = lambda _c, _s, _l, _h: False
    ) -> dict[tuple[str, str, int, int], tuple[bool, bool, int]]:
        """S10: (kind, category, source, leak) -> (pseudonymised, dismissed, length of the shortest way to show).

        ``accepted`` says of (category, source, leak, pseudonymised) whether that disclosure is.
        """
        found: dict[tuple[str, str, int, int], tuple[bool, bool, int]] = {}
        for source in self.sources():
            whole = self.spread([source])
            for leak, category in {(v, c) for v, (c, _) in whole}:

                def other(v: int, data: Data, source: int = source, leak: int = leak, category: str = category) -> bool:
                    ends = data[0] == category and v != leak and self.has(v, "leak", category)
                    return ends and not accepted(category, source, v, data[1])

                kinds = {
                    "disclosure": self.has(leak, "leak", category),
                    "storage-limitation": self.kept_too_long(leak, category),
                    "third-country-transfer": self.abroad(leak),
                }
                for kind in [kind for kind, holds in kinds.items() if holds]:
                    ways = (
                        [(whole, False)]
                        if kind != "disclosure"
                        else [(self.spread([source], other), False), (whole, True)]
                    )
                    for way, dismissed in ways:
                        for hidden in (False, True):
                            if (leak, (category, hidden)) in way:
                                key = (kind, category, source, leak)
                                found.setdefault(key, (hidden, dismissed, way[leak, (category, hidden)]))
        return found

    def covered(self, vertex: int, category: str) -> bool:
        """S11; who makes a category of another is covered for both; where a country has to be known, it is."""
        kind, facts = self.outside.get(vertex, ("", None))
        if kind in ("storage", "external-system") and facts is not None and not facts.country and not facts.transfer:
            return False
        return bool(self.holding(vertex, category)) or any(
            s.role == "derivation" and s.to == category
            for c in self.hierarchy.ancestors
            for s in self.holding(vertex, c)
        )

    def open(self) -> dict[int, tuple[set[str], int, bool]]:
        """S11: vertex -> (categories, distance, frontier)."""
        whole = self.spread(self.sources())
        questions = {(v, c) for v, (c, _) in whole if not self.covered(v, c)}

        def end(v: int, data: Data) -> bool:
            c = data[0]
            return self.has(v, "leak", c) or (v in self.nodes and (v, c) in questions)

        first = {(v, c) for v, (c, _) in self.spread(self.sources(), end)}
        result = {}
        for vertex in {v for v, _ in questions}:
            categories = {c for v, c in questions if v == vertex}
            distance = min(d for (v, (c, _)), d in whole.items() if v == vertex and c in categories)
            frontier = vertex in self.nodes and any((vertex, c) in first for c in categories)
            result[vertex] = (categories, distance, frontier)
        return result

    def unknown_ends(self) -> dict[int, set[str]]:
        """S11: channels with data that no edge leaves -> categories; elements outside ROS that no edge enters -> none.

        An element outside ROS is no such end where data begins and goes on from.
        """
        at: dict[int, set[str]] = {}
        for vertex, (category, _) in self.spread(self.sources()):
            at.setdefault(vertex, set()).add(category)
        known = {a for a, _ in self.edges}
        ends = {v: at[v] for v in at if v not in self.nodes and v not in known}
        entered = {b for _, b in self.edges}
        for vertex in self.outside:
            names = self.hierarchy.ancestors
            begins = vertex in known and any(self.has(vertex, "source", name) for name in names)
            if vertex not in entered and not begins:
                ends[vertex] = set()
        return ends
