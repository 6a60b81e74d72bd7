"""Rules S7, S8, S10 and S11 word for word, on sets, with no thought of speed: what the fast version is held against.

A state is (vertex, category, pseudonymised). Statements here all have one name rank, so only nearness decides.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Statement

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


@dataclass
class Brute:
    """A small system."""

    nodes: Collection[int]
    edges: list[tuple[int, int]]
    said: dict[int, list[Statement]]
    hierarchy: Hierarchy
    never: dict[tuple[int, int], set[str]] = field(default_factory=dict)  # of flows
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
        applying = [s for s in self.said.get(vertex, []) if self.nearness(s, category) is not None]

        def outdone(s: Statement) -> bool:
            mine = self.nearness(s, category)
            assert mine is not None
            return any(
                ({s.role, t.role} in PAIRS or (s.role == t.role == "sanitizer" and s.method != t.method))
                and (other := self.nearness(t, category)) is not None
                and other < mine
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

    def findings(
        self, accepted: Callable[[str, int, int, bool], bool] = lambda _c, _s, _l, _h: False
    ) -> dict[tuple[str, int, int], tuple[bool, bool, int]]:
        """S10: (category, source, leak) -> (pseudonymised, dismissed, length of the shortest way to show).

        ``accepted`` says the same of (category, source, leak, pseudonymised).
        """
        found: dict[tuple[str, int, int], tuple[bool, bool, int]] = {}
        for source in self.sources():
            whole = self.spread([source])
            for leak in self.said:
                for category in {c for v, (c, _) in whole if v == leak}:
                    if not self.has(leak, "leak", category):
                        continue

                    def other(
                        v: int, data: Data, source: int = source, leak: int = leak, category: str = category
                    ) -> bool:
                        ends = data[0] == category and v != leak and self.has(v, "leak", category)
                        return ends and not accepted(category, source, v, data[1])

                    free = self.spread([source], other)
                    for way, dismissed in ((free, False), (whole, True)):
                        for hidden in (False, True):
                            if (leak, (category, hidden)) in way:
                                key = (category, source, leak)
                                found.setdefault(key, (hidden, dismissed, way[leak, (category, hidden)]))
        return found

    def covered(self, vertex: int, category: str) -> bool:
        """S11; who makes a category of another is covered for both."""
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
