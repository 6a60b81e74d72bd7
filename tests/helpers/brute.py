"""Rules S7 to S11 and S13 word for word, on sets, with no thought of speed: what the fast version is held against.

A state is (vertex, category, pseudonymised).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from datetime import date
from functools import cache
from heapq import heappop, heappush
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Place, Statement

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import NonRosFacts

Data = tuple[str, bool]  # category, pseudonymised

MAY = {"leak", "derivation", "only"}
PAIRS = [
    {"source", "sanitizer"},
    {"source", "conduit"},
    {"leak", "conduit"},
    {"sanitizer", "conduit"},
    {"source", "no-source"},
    {"leak", "no-leak"},
]
OF_CHANNELS = {"mundane", "sensitive", "only", "never"}  # S7: statements of one kind
OF_EVERY_KIND = {"mundane", "sensitive", "only"}
ADDS = {"source", "leak", "derivation"}  # S11: they hold without anybody having seen it, and review nothing then
PASSING = {"conduit", "sensitive", "only"}
KEPT = {("conduit", "source"), ("conduit", "leak"), ("sanitizer", "source")}  # the first takes no second away
ENDS = {"anonymise", "aggregate", "drop"}
ABSENT = "absent"  # the word of a node that is not there: it does nothing, so it is opposed to all that it might do
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
EVERYWHERE = (-1,)  # along all flows


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


def standard(s: Statement) -> bool:
    """Whether a statement is one of the standard channels' file."""
    return s.shipped and s.rank[0] == 0


def open_ended(s: Statement) -> bool:
    """Whether a user says it by a glob whose last name segment is not written out."""
    return s.rank[0] > 0 and s.naming == "glob"


def by_a_users_name(s: Statement) -> bool:
    return s.rank[0] > 0 and s.naming == "name"


@dataclass
class Brute:
    """A small system."""

    nodes: Collection[int]
    edges: list[tuple[int, int]]
    said: dict[int, list[Statement]]
    hierarchy: Hierarchy
    never: dict[tuple[int, int], set[str]] = field(default_factory=dict)  # of flows
    outside: dict[int, tuple[str, NonRosFacts]] = field(default_factory=dict)  # kind, facts
    names: dict[int, str] = field(default_factory=dict)  # of channels
    stated: set[tuple[int, int]] = field(default_factory=set)  # flows that a person states
    sides: dict[int, int] = field(default_factory=dict)  # what is read from a wildcard -> what is written to it
    exposed: Collection[int] = ()  # channels that who is on the network can read
    along: set[tuple[int, int, Data]] = field(default_factory=set)  # what the last spread sent along flows

    def nearness(self, statement: Statement, category: str) -> int | None:
        """S7: steps up to what is named; negative if the two only meet in a narrower kind and the role is of *may*."""
        if not statement.categories or (statement.role == "only" and self.closes(statement, category)):
            return 1_000_000
        if statement.role == "source":
            return 0 if category in statement.categories else None
        up = [d for named in statement.categories if (d := self.hierarchy.distance(category, named)) is not None]
        if up:
            return min(up)
        down = [above[category] for above in self.common(statement, category)]
        return -min(down) if down and statement.role in MAY else None

    def common(self, s: Statement, category: str) -> list[Mapping[str, int]]:
        """S7: of the kinds that data of a category may be, and that a statement is about, what is broader."""
        return [up for up in self.hierarchy.ancestors.values() if category in up and set(s.categories) & set(up)]

    def named(self, vertex: int, category: str) -> list[Statement]:
        """S7: the statements of sources that name a channel for a category, and hold; both legs of it have one name."""
        return [
            s
            for a, b in self.edges
            if b not in self.nodes and a in self.nodes and self.names.get(vertex, "") == self.names.get(b)
            for s in self.holding(a, category)
            if s.role == "source" and self.names[vertex] in s.through
        ]

    def closes(self, s: Statement, category: str) -> bool:
        """Whether a statement about a channel says that it does not carry a category."""
        if s.role == "only":
            return not self.common(s, category)
        return s.role in ("mundane", "never")

    def said_of(self, vertex: int, category: str) -> list[Statement]:
        """What is said of it; what a source names a channel for, only a user's full name can take away."""
        said = [*self.said.get(vertex, []), *BY_KIND.get(self.outside.get(vertex, ("",))[0], [])]
        said = [s for s in said if self.nearness(s, category) is not None]
        # S11: what a glob of a pinned file takes away is not there for what nobody has seen; what lets through is
        lets = [s for s in said if s.role in ADDS or (s.role in PASSING and not self.closes(s, category))]
        said = [s for s in said if s.counts_for(category) or s in lets]
        if vertex not in self.nodes and self.named(vertex, category):
            return [s for s in said if by_a_users_name(s) or not self.closes(s, category)]
        return said

    def opposed(self, s: Statement, t: Statement, category: str) -> bool:
        """Whether two statements cannot both hold for a category."""
        if s.role in OF_CHANNELS:
            two = s.role == t.role == "only" and s.rank == t.rank and set(s.categories) != set(t.categories)
            return two or self.closes(s, category) != self.closes(t, category)
        if s.role == t.role:
            return (s.role == "sanitizer" and s.method != t.method) or (s.role == "source" and s.through != t.through)
        if ABSENT in (str(s.method), str(t.method)):
            return not {s.role, t.role} & {"no-source", "no-leak"}
        return {s.role, t.role} in PAIRS

    def beats(self, t: Statement, s: Statement, category: str) -> bool:
        """S7: the higher rank, then the nearer; S13: a user's glob with an open end does not beat the standard file.

        A source and a leak are taken away by ``none`` of a higher rank, or with the whole node; a leak that the sort of
        an element implies by a conduit too.
        """
        if (t.role, s.role) in KEPT and str(t.method) != ABSENT and s.rank[0] >= 0:
            return False
        if t.role == f"no-{s.role}":
            return t.rank > s.rank
        if standard(s) and open_ended(t):
            return False
        if standard(t) and open_ended(s):
            return True
        near, other = self.nearness(t, category), self.nearness(s, category)
        assert near is not None
        assert other is not None
        lets = (t.role, s.role) == ("only", "never") and near == other  # a tie lets through
        return (*t.rank, -near) > (*s.rank, -other) or (lets and t.rank == s.rank)

    def clash(self, s: Statement, t: Statement, category: str) -> bool:
        """S7: whether two of one rank that cannot both hold are an error."""
        pair, near, other = {s.role, t.role}, self.nearness(s, category), self.nearness(t, category)
        if s.rank != t.rank:
            return False
        if (s.role, t.role) == ("never", "only"):
            return any(never in self.hierarchy.ancestors[only] for never in s.categories for only in t.categories)
        if pair <= OF_EVERY_KIND:
            return True
        if pair == {"leak", "conduit"}:
            return s.categories == t.categories
        if s.role == f"no-{t.role}":
            return (near or 0) <= (other or 0)
        return near == other and pair not in ({"never", "only"}, {"leak", "no-leak"}, {"source", "no-source"})

    def holding(self, vertex: int, category: str) -> list[Statement]:
        """S7: the statements that apply, but for those that a higher or a nearer one contradicts."""
        applying = self.said_of(vertex, category)
        return [
            s
            for s in applying
            if (s.counts_for(category) or s.role in ADDS)  # S11: … and what lets through reviews nothing
            and not any(self.opposed(s, t, category) and self.beats(t, s, category) for t in applying)
        ]

    def kinds_emitted(self) -> set[str]:
        """S7: what some source names or some derivation makes."""
        named = {c for said in self.said.values() for s in said for c in s.categories if s.role == "source"}
        return named | {s.to for said in self.said.values() for s in said if s.role == "derivation"}

    def judged(self) -> Iterator[tuple[int, str]]:
        """Every element with every category that is emitted, or that a label of it names."""
        for vertex, said in self.said.items():
            kinds = self.kinds_emitted() | {c for s in said for c in s.categories}
            yield from ((vertex, category) for category in sorted(kinds or self.hierarchy.ancestors))

    def outdone(self) -> Iterator[tuple[int, str, Statement, Statement]]:
        """S7: (element, category, source or leak that does not hold, what takes it away), where a user says it."""
        for vertex, category in self.judged():
            applying, holding = self.said_of(vertex, category), self.holding(vertex, category)
            for s in applying:
                if s.role not in ("source", "leak") or s in holding or s.rank[0] <= 0:
                    continue
                still = [t for t in holding if t.role == s.role]
                anywhere = still and not (still[0].through and still[0].counts_for(category))
                if still and (s.role == "leak" or anywhere or self.within(s, still[0])):
                    continue
                against = [t for t in applying if self.opposed(s, t, category) and self.beats(t, s, category)]
                away = [t for t in against if t.rank != s.rank or t.place.file != s.place.file]
                if away:
                    by_name = [t for t in away if t.role == f"no-{s.role}"]
                    near = {t: self.nearness(t, category) or 0 for t in away}
                    yield vertex, category, s, max(by_name or away, key=lambda t: (*t.rank, -near[t], str(t.place)))

    def within(self, s: Statement, t: Statement) -> bool:
        """Whether a source names no more channels than another."""
        return bool(s.through) and set(s.through) <= set(t.through)

    def taken_away(self) -> set[tuple[int, str, str]]:
        """S7: what has to be told."""
        return {(vertex, s.role, category) for vertex, category, s, _ in self.outdone()}

    def refused(self) -> bool:
        """S7: whether labels contradict each other."""
        emitted = self.kinds_emitted()
        for vertex, category in self.judged():
            applying = self.said_of(vertex, category)
            if any(self.opposed(s, t, category) and self.clash(s, t, category) for s in applying for t in applying):
                return True
            if self.has(vertex, "source", category) and self.cleans(vertex, category):
                return True
            ends = [s for s in self.holding(vertex, category) if s.role == "sanitizer" and str(s.method) in ENDS]
            if ends and any(s.role == "derivation" and s.to == category for s in self.holding(vertex, category)):
                return True
            if vertex not in self.nodes and category in emitted and self.named(vertex, category):
                if any(self.closes(s, category) for s in self.holding(vertex, category)):
                    return True
                into = [(a, b) for a, b in self.edges if b == vertex]
                if any(
                    name in self.hierarchy.ancestors[category]
                    for a, b in into
                    if any(s.role == "source" and self.names[b] in s.through for s in self.holding(a, category))
                    for name in self.never.get((a, b), ())
                ):
                    return True
        return False

    def has_grounds(self) -> bool:
        """S11, S12: whether data of some source goes anywhere, and whether anybody says what is a leak, or none."""
        storages = any(kind == "storage" for kind, _ in self.outside.values())
        kinds, vertices = self.kinds_emitted(), {*self.said, *self.outside}
        said = (s for vertex in vertices for category in kinds for s in self.said_of(vertex, category))
        onward = {source for source, _ in self.edges} & self.sources()
        return bool(onward) and (storages or any(s.role in ("leak", "no-leak") for s in said))

    def cleans(self, vertex: int, category: str) -> bool:
        """Whether it cleans a category; what is not there cleans nothing."""
        return any(s.role == "sanitizer" and str(s.method) != ABSENT for s in self.holding(vertex, category))

    def has(self, vertex: int, role: str, category: str) -> bool:
        return any(s.role == role for s in self.holding(vertex, category))

    def kills(self, vertex: int, category: str) -> bool:
        return any(s.role == "sanitizer" or self.closes(s, category) for s in self.holding(vertex, category))

    def only_hides(self, vertex: int, category: str) -> bool:
        """Whether all that cleans it pseudonymises: what is pseudonymised already goes on so."""
        sanitizers = [s for s in self.holding(vertex, category) if s.role == "sanitizer"]
        return bool(sanitizers) and all(str(s.method) not in {*ENDS, ABSENT} for s in sanitizers)

    def gone(self, vertex: int, category: str) -> bool:
        """Whether a label says that a node is not on the robot, and no higher one says that it does something.

        What is read from a wildcard is not there if nobody who reads it is.
        """
        readers = {b for a, b in self.edges if a == vertex and vertex in self.sides}
        if readers:
            return all(self.gone(reader, category) for reader in readers)
        return any(str(s.method) == ABSENT for s in self.holding(vertex, category))

    def made(self, vertex: int, data: Data) -> set[Data]:
        """S8: derive, and what is made of that in turn; and pseudonymise."""
        category, hidden = data
        names, before = {category}, set[str]()
        while names != before:
            before = set(names)
            names |= {s.to for c in before for s in self.holding(vertex, c) if s.role == "derivation"}
        result = {(name, hidden) for name in names if name != category}
        sanitizers = [s for s in self.holding(vertex, category) if s.role == "sanitizer"]
        if not hidden and any(str(s.method) not in {*ENDS, ABSENT} for s in sanitizers):
            result.add((category, True))
        return result

    def emitted(self, vertex: int) -> dict[Data, set[int] | None]:
        """What a source names, and what it makes of its own data; None along all flows, else to these (S8)."""
        data: dict[Data, set[int] | None] = {}
        for category in {c for s in self.said.get(vertex, []) for c in s.categories if s.role == "source"}:
            for s in self.holding(vertex, category):
                if s.role == "source":
                    data[category, False] = self.ends(vertex, s) if s.through and s.counts_for(category) else None
        own = list(data)
        return data | {made: None for d in own for made in self.made(vertex, d) if not made[1]}

    def ends(self, vertex: int, s: Statement) -> set[int]:
        """S8: through restricts channels of ROS; along a flow that a person states it sends all."""
        return {b for a, b in self.edges if a == vertex and ((a, b) in self.stated or self.names[b] in s.through)}

    def spread(
        self, sources: Collection[int], stop: Callable[[int, Data], bool] = lambda _v, _d: False
    ) -> dict[tuple[int, Data], int]:
        """What is where (arrives, starts or is made there) -> least number of flows from a source.

        The two sides of a wildcard are one element, so the way from one to the other is no step.
        """
        present: dict[tuple[int, Data], int] = {}
        leaving: list[tuple[int, int, Data, tuple[int, ...]]] = []  # a heap: level, vertex, data, where to
        left = set()
        self.along = set()

        def there(vertex: int, data: Data, level: int) -> None:
            if self.gone(vertex, data[0]):
                return  # what is sent there gets to nobody
            present[vertex, data] = min(level, present.get((vertex, data), level))

        for source in sorted(sources):
            for data, ends in self.emitted(source).items():
                there(source, data, 0)
                heappush(leaving, (0, source, data, EVERYWHERE if ends is None else tuple(sorted(ends))))
        while leaving:
            level, vertex, data, only = heappop(leaving)
            if (vertex, data, only) in left:
                continue
            left.add((vertex, data, only))
            for a, b in self.edges:
                if a != vertex or (only != EVERYWHERE and b not in only):
                    continue
                if b not in self.nodes and self.kills(b, data[0]):
                    continue
                if any(named in self.hierarchy.ancestors[data[0]] for named in self.never.get((a, b), ())):
                    continue
                self.along.add((a, b, data))
                after = level if self.sides.get(b) == a else level + 1
                there(b, data, after)
                if stop(b, data):
                    continue
                if not self.kills(b, data[0]) or (data[1] and self.only_hides(b, data[0])):
                    heappush(leaving, (after, b, data, EVERYWHERE))
                for made in self.made(b, data):
                    there(b, made, after)
                    if not stop(b, made):
                        heappush(leaving, (after, b, made, EVERYWHERE))
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
        return facts is not None and facts.area in ABROAD and facts.transfer in ("", "none")

    def findings(
        self, accepted: Callable[[str, int, int, bool], bool] = lambda _c, _s, _l, _h: False
    ) -> dict[tuple[str, str, int, int, bool], tuple[bool, bool, int]]:
        """S10: (kind, category, source, leak, beside) -> (pseudonymised, dismissed, length of the way to show).

        ``beside`` is plain data that arrives through another leak only, where pseudonymised data arrives without one.
        ``accepted`` says of (category, source, leak, pseudonymised) whether that disclosure is.
        """
        found: dict[tuple[str, str, int, int, bool], tuple[bool, bool, int]] = {}
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
                    "unprotected-channel": leak in self.exposed,
                }
                plain, hidden = (leak, (category, False)), (leak, (category, True))
                for kind in [kind for kind, holds in kinds.items() if holds]:
                    key = (kind, category, source, leak)
                    direct, beside = (*key, False), (*key, True)
                    free = self.spread([source], other) if kind == "disclosure" else whole
                    if plain in free:
                        found[direct] = (False, False, free[plain])
                    elif hidden in free:
                        found[direct] = (True, False, free[hidden])
                        if plain in whole:
                            found[beside] = (False, True, whole[plain])
                    elif plain in whole:
                        found[direct] = (False, True, whole[plain])
                    else:
                        found[direct] = (True, True, whole[hidden])
        return found

    def covered(self, vertex: int, category: str) -> bool:
        """S11; who makes a category of another is covered for both; where a country has to be known, it is;
        where a transfer rests on a derogation, nobody says that it is occasional."""
        kind, facts = self.outside.get(vertex, ("", None))
        if (
            kind in ("storage", "external-system")
            and facts is not None
            and not facts.country
            and facts.transfer in ("", "none")
        ):
            return False
        if facts is not None and facts.transfer == "derogation" and facts.area in ("", *ABROAD):
            return False
        said = [s for s in self.holding(vertex, category) if not s.role.startswith("no-")]
        return any(s.counts_for(category) for s in said) or any(
            s.role == "derivation" and s.to == category and s.counts_for(c)
            for c in self.hierarchy.ancestors
            for s in self.holding(vertex, c)
        )

    def open(self) -> dict[int, tuple[set[str], int, bool]]:
        """S11: vertex -> (categories, distance, frontier).

        A node is on the frontier if some category gets there past no other open node and no leak of that category.
        """
        whole = self.spread(self.sources())
        questions = {(v, c) for v, (c, _) in whole if not self.covered(v, c)}
        first = set()
        for category in {c for _, c in questions}:

            def end(v: int, data: Data, category: str = category) -> bool:
                leak = data[0] == category and self.has(v, "leak", category)
                return leak or (v in self.nodes and (v, data[0]) in questions)

            first |= {(v, c) for v, (c, _) in self.spread(self.sources(), end) if c == category}
        result: dict[int, tuple[set[str], int, bool]] = {}
        for vertex in sorted({v for v, _ in questions}):
            categories = {c for v, c in questions if v == vertex}
            distance = min(d for (v, (c, _)), d in whole.items() if v == vertex and c in categories)
            frontier = vertex in self.nodes and any((vertex, c) in first for c in categories)
            one = self.one(vertex, result)
            known = result.get(one, (set(), distance, False))
            result[one] = (known[0] | categories, min(known[1], distance), frontier)
        return result

    def one(self, vertex: int, known: Collection[int]) -> int:
        """S4: the two sides of a wildcard are one element: what is read is told at what is written, if that is told."""
        other = self.sides.get(vertex)
        return other if other is not None and other in known else vertex

    def unknown_ends(self) -> dict[int, set[str]]:
        """S11: channels with data that no node reads -> categories; elements outside ROS that no edge enters -> none.

        A node that reads a wildcard reads the channels that it matches. An element outside ROS is no such end where
        data begins and goes on from.
        """
        read = {a for a, b in self.edges if b in self.nodes and a not in self.nodes}
        while more := {a for a, b in self.edges if b in read and a not in self.nodes} - read:
            read |= more
        ends: dict[int, set[str]] = {}
        for vertex, (category, _) in sorted(self.spread(self.sources())):
            if vertex not in self.nodes and vertex not in read:
                ends.setdefault(self.one(vertex, ends), set()).add(category)
        entered, left = {b for _, b in self.edges}, {a for a, _ in self.edges}
        for vertex in self.outside:
            begins = vertex in left and any(self.has(vertex, "source", c) for c in self.hierarchy.ancestors)
            if vertex not in entered and not begins:
                ends[vertex] = set()
        return ends
