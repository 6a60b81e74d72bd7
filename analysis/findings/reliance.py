"""What the answer hangs on: what each statement that takes data or a question away keeps from being found.

In: an ``Analysis`` with its labels. Out: ``Reliance`` rows. A row says which findings, and which open questions, there
would be if that one statement were wrong: if the system were analysed without it. It is a person's word, and this is
what has to be checked first.

Source: rules S7, S8, S10 and S11. Sanitizers, reviews (a conduit, ``mundane``, ``sensitive``, ``only``, ``never``),
``absent``, ``none``; of the user's files and of shipped ones, by name or by glob. Sources, leaks and derivations bring
in, and what is taken of an element by its kind is nobody's word.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.closures import line_key
from rosprivacy.analysis.findings.open_questions import open_bits
from rosprivacy.analysis.findings.reach import Places, Reach
from rosprivacy.analysis.kernel import spreading
from rosprivacy.analysis.model import CANNOT, NOWHERE, Bound, Statement
from rosprivacy.analysis.non_ros import unanswered

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.case import Case
    from rosprivacy.analysis.findings.reach import Key, State
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element, NonRosFacts

    Pair = tuple[Mapping[Key, State], Mapping[Key, State]]  # findings at an element before and after
    Shown = tuple[str, str, str, str]
    One = tuple[Statement, tuple[str, ...]]

BRINGS_IN = frozenset({"source", "leak", "derivation"})
TOGETHER = 64  # sources that are followed at once
ROUNDS = 64  # statements for which the whole system is analysed again; of more it is said that it was not worked out


class Opening(NamedTuple):
    """A finding that there would be, or that would be worse.

    Attributes
    ----------
    dismissed, pseudonymised
        How it would be: only through another leak; in pseudonymised form only.
    new
        Whether there is none today; else it is dismissed or pseudonymised today, and would not be.
    """

    kind: str
    category: str
    source: Element
    leak: Element
    dismissed: bool
    pseudonymised: bool
    new: bool


class Reliance(NamedTuple):
    """What hangs on one statement.

    Attributes
    ----------
    statement
        With its line, and the reason that a person gives.
    elements
        Where it is said and data is; of what is said of a flow its start.
    to
        The ends of these flows.
    findings
        That there would be without it, sorted as findings are: those that stand first.
    questions
        (element, categories) that would be open, sorted.
    refused
        Why the system could not be analysed without it: the other labels would contradict each other. Else empty.
    perhaps
        Whether it was not worked out: too many statements need a whole analysis.
    """

    statement: Statement
    elements: tuple[Element, ...]
    to: tuple[Element, ...] = ()
    findings: tuple[Opening, ...] = ()
    questions: tuple[tuple[Element, tuple[str, ...]], ...] = ()
    refused: str = ""
    perhaps: bool = False

    @property
    def hangs(self) -> bool:
        """Whether anything hangs on it, or may."""
        return bool(self.findings or self.questions or self.refused or self.perhaps)


def reliances(
    analysis: Analysis, bound: Bound, hierarchy: Hierarchy, accepts: Callable[[Case], bool] | None = None
) -> tuple[Reliance, ...]:
    """Return what hangs on each statement on which anything does, in the order of files and lines.

    Parameters
    ----------
    accepts
        As of ``Options``.

    Notes
    -----
    The data of all sources is followed once, each source in a lane of its own. For most statements only what is new
    without them is followed on from there; where something would also be lost, the whole is followed again.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> graph, bound, hierarchy = factory()
    >>> rows = reliances(analyse(graph, bound, hierarchy), bound, hierarchy)
    >>> for row in rows:
    ...     found = sorted({(opening.category, opening.leak.name) for opening in row.findings})
    ...     print(row.statement.place, found, [element.name for element, _ in row.questions])
    labels.yaml:4 [('Video', '/archive'), ('Video', 'disk')] ['/filter']
    labels.yaml:5 [('Video', '/archive'), ('Video', 'disk')] ['/faces']
    standard:1 [] ['/rosout']
    """
    bound = replace(bound, outside=_outside(analysis))
    spots = _spots(analysis.spread, bound)
    work = _Work.of(analysis, bound, hierarchy, accepts) if spots else None
    if work is None:
        return ()
    order = sorted(spots, key=lambda key: (line_key(key[0]), key[1]))
    rows = (work.without(key[0], spots[key]) for key in order)
    return tuple(row for row in rows if row.hangs)


def _outside(analysis: Analysis) -> dict[int, NonRosFacts]:
    """What is stated about non-ROS elements on the day of the analysis."""
    return {v: analysis.outside[e] for v, e in enumerate(analysis.graph.elements) if e in analysis.outside}


@dataclass(slots=True, eq=False, repr=False)
class _Spots:
    """Where one statement is said, and whether any data is there."""

    vertices: list[int] = field(default_factory=list)
    flows: list[int] = field(default_factory=list)
    reached: bool = False


def _spots(spread: Spread, bound: Bound) -> dict[One, _Spots]:
    elements, flows = spread.graph.elements, spread.graph.flows
    spots: dict[One, _Spots] = defaultdict(_Spots)
    for vertex, said in bound.elements.items():
        sources = any(statement.role == "source" for statement in said)
        reached = sources or vertex in spread.arrives or vertex in spread.leaves
        for statement in said:
            if _takes(statement):
                one = spots[_one(statement, elements[vertex])]
                one.vertices.append(vertex)
                one.reached |= reached
    for index, said in bound.flows.items():
        source, target = flows[index].source, flows[index].target
        reached = bool(spread.sent.get(source, 0) | spread.flow_emits.get(index, 0))
        for statement in said:
            if _takes(statement):
                one = spots[_one(statement, elements[source], elements[target])]
                one.flows.append(index)
                one.reached |= reached
    return {key: some for key, some in spots.items() if some.reached}


def _one(statement: Statement, *ends: Element) -> One:
    """What is one statement: a glob with all that it is about, a name on all robots; by hand, of one robot."""
    if statement.glob:
        return statement.line, ()
    robots = () if statement.place.line else tuple(end.robot for end in ends)
    return statement, (*(end.name for end in ends), *robots)


def _takes(statement: Statement) -> bool:
    return statement.role not in BRINGS_IN and statement.place != NOWHERE


@dataclass(eq=False, repr=False)
class _Work:
    """The answer as it is, for comparison, and how many analyses of the whole are left."""

    bound: Bound
    hierarchy: Hierarchy
    places: Places
    ends: set[int]
    unknown: set[int]
    left: int
    open: dict[Shown, int] = field(default_factory=lambda: defaultdict(int))  # as shown -> numbers of categories

    @cached_property
    def reaches(self) -> tuple[Reach, ...]:
        """What the sources' data gets to today; not looked for where no statement asks for it."""
        return _reaches(self.places, self.bound)

    @classmethod
    def of(
        cls, analysis: Analysis, bound: Bound, hierarchy: Hierarchy, accepts: Callable[[Case], bool] | None
    ) -> _Work | None:
        spread = analysis.spread
        asked = sum(spread.both(category) for category in analysis.emitted)
        elements = spread.graph.elements
        unknown = set(unanswered(elements, bound.outside))
        if not asked:
            return None
        places = Places.of(spread, bound, hierarchy, asked, accepts)
        work = cls(bound, hierarchy, places, places.vertices(), unknown, ROUNDS)
        for vertex, bits in open_bits(spread, unknown).items():
            work.open[elements[vertex].shown_as] |= spread.bits.merged(bits & asked)
        return work

    def without(self, statement: Statement, spots: _Spots) -> Reliance:
        """What there would be without a statement."""
        graph, spread = self.places.spread.graph, self.places.spread
        there = [v for v in spots.vertices if v in spread.arrives or v in spread.leaves] or spots.vertices
        flows = [graph.flows[index] for index in spots.flows]
        row = Reliance(
            statement,
            _distinct(graph.elements[v] for v in (*there, *(flow.source for flow in flows))),
            _distinct(graph.elements[flow.target] for flow in flows),
        )
        try:
            change = self._change(statement, spots)
            if change is not None:
                return self._told(self._compared(row, *self._further(change, spots)))
            if not self.left:
                return row._replace(perhaps=True)
            self.left -= 1
            return self._told(self._compared(row, *self._anew(_without(self.bound, statement, spots))))
        except InputErrors as error:
            return row._replace(refused=str(error.errors[0]))

    def _told(self, row: Reliance) -> Reliance:
        """A type reviews nothing: what lies behind it is open as it is (rule S15)."""
        return row._replace(questions=()) if row.statement.role == CANNOT else row

    def _change(self, statement: Statement, spots: _Spots) -> Spread | None:
        """What the elements and flows do without it, if that is more and nothing less; else None."""
        spread, graph = self.places.spread, self.places.spread.graph
        flows = {index: _less(self.bound.flows[index], statement) for index in spots.flows}
        elements = {vertex: _less(self.bound.elements[vertex], statement) for vertex in spots.vertices}
        named = {*spots.vertices, *(graph.flows[index].target for index in spots.flows)} & spread.named.keys()
        if named or any(one.through for said in elements.values() for one in said):
            return None
        left_out = spreading.LeftOut(spread, statement)
        now = spreading.meaning(graph, Bound(elements, flows), self.hierarchy, spread.categories, left_out)
        more = all(self._more(now, vertex) for vertex in spots.vertices)
        kept = (not spread.flow_keeps[index] & ~now.flow_keeps[index] for index in spots.flows)
        return now if more and all(kept) else None

    def _more(self, now: Spread, vertex: int) -> bool:
        """Whether an element does nothing less: what it pseudonymised may go on as it is, which is more."""
        spread = self.places.spread
        for name in ("emits", "leaks", "gone"):
            if getattr(now, name).get(vertex, 0) != getattr(spread, name).get(vertex, 0):
                return False
        lost = set(spread.derives[vertex]) - set(now.derives[vertex])
        plain_goes_on = all(
            spread.bits.category(before) == spread.bits.category(after) and now.keeps[vertex] >> before & 1
            for before, after in lost
        )
        same = set(now.derives[vertex]) <= set(spread.derives[vertex]) and plain_goes_on
        return same and not spread.keeps[vertex] & ~now.keeps[vertex] and not (lost and self.places.accepts)

    def _further(self, now: Spread, spots: _Spots) -> tuple[list[Pair], dict[int, int]]:
        """Findings before and after, and what is open, where only more passes."""
        spread, flows = self.places.spread, self.places.spread.graph.flows
        opened = [v for v in spots.vertices if now.keeps[v] & ~spread.keeps[v]]
        along = [
            (index, flows[index].source, flows[index].target)
            for index in spots.flows
            if now.flow_keeps[index] & ~spread.flow_keeps[index]
        ]
        pairs: list[Pair] = []
        new = {v: spread.present(v) for v in spots.vertices}  # of others only what is more
        for reach in self.reaches if opened or along else ():
            more = reach.further(now, [v for v in opened if reach.whole.arrived(v)], along)
            pairs += [(reach.states(v), more.states(v)) for v in more.touched & self.ends]
            for vertex, bits in more.new().items():
                new[vertex] = new.get(vertex, 0) | bits
        covered = {v: now.covered.get(v, 0) if v in now.facts else spread.covered.get(v, 0) for v in new}
        return pairs, {
            v: bits & ~spread.gone.get(v, 0) & ~(0 if v in self.unknown else covered[v]) for v, bits in new.items()
        }

    def _anew(self, less: Bound) -> tuple[list[Pair], dict[int, int]]:
        """The same by an analysis of the whole."""
        spread = spreading.spread(self.places.spread.graph, less, self.hierarchy)
        places = Places.of(spread, less, self.hierarchy, self.places.asked, self.places.accepts)
        reaches = _reaches(places, less)
        ends = sorted(self.ends | places.vertices())
        pairs: list[Pair] = [
            (before.states(v), after.states(v))
            for before, after in zip(self.reaches, reaches, strict=True)
            for v in ends
        ]
        return pairs, open_bits(spread, self.unknown)

    def _compared(self, row: Reliance, pairs: Iterable[Pair], bits: Mapping[int, int]) -> Reliance:
        """Fill in what is new or worse."""
        spread = self.places.spread
        elements = spread.graph.elements
        found = []
        for before, after in pairs:
            for key, (stands, plain) in after.items():
                kind, i, source, leak = key
                stood, was_plain = before.get(key, (False, False))
                if key not in before or (stands and not stood) or (plain and not was_plain):
                    opening = Opening(
                        kind, spread.categories[i], elements[source], elements[leak],
                        dismissed=not stands, pseudonymised=not plain, new=key not in before,
                    )  # fmt: skip
                    found.append(((not stands, i, source, leak, kind), opening))
        asked: dict[Shown, tuple[Element, set[str]]] = {}
        for vertex, some in sorted(bits.items()):
            if not (open_now := spread.bits.merged(some & self.places.asked)):
                continue
            shown = elements[vertex].shown_as
            if new := open_now & ~self.open.get(shown, 0):
                asked.setdefault(shown, (elements[vertex], set()))[1].update(spread.names(new))
        return row._replace(
            findings=tuple(opening for _, opening in sorted(found, key=lambda pair: pair[0])),
            questions=tuple((element, tuple(sorted(names))) for element, names in asked.values()),
        )


def _reaches(places: Places, bound: Bound) -> tuple[Reach, ...]:
    """What the sources' data gets to, some of them at a time; also of those that another label takes away today."""
    sources = [v for v, said in sorted(bound.elements.items()) if any(s.role == "source" for s in said)]
    parts = (sources[begin : begin + TOGETHER] for begin in range(0, len(sources), TOGETHER))
    return tuple(Reach.of(places, part) for part in parts)


def _without(bound: Bound, statement: Statement, spots: _Spots) -> Bound:
    elements = {**bound.elements, **{v: _less(bound.elements[v], statement) for v in spots.vertices}}
    flows = {**bound.flows, **{index: _less(bound.flows[index], statement) for index in spots.flows}}
    return replace(bound, elements=elements, flows=flows)


def _less(said: tuple[Statement, ...], statement: Statement) -> tuple[Statement, ...]:
    return tuple(one for one in said if one.categories != statement.categories or one.line != statement)


def _distinct(elements: Iterable[Element]) -> tuple[Element, ...]:
    """One of each that a reader sees."""
    return tuple({element.shown_as: element for element in elements}.values())
