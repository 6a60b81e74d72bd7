"""What the answer hangs on: what each statement that takes data or a question away keeps from being found.

In: an ``Analysis`` with its labels. Out: ``Reliance`` rows. A row says which findings, and which open questions, there
would be if that one statement were wrong: if the system were analysed without it. It is a person's word, and this is
what has to be checked first.

The data of all sources is followed once, each source in a lane of its own (``Reach``). Where the system lets more pass
without a statement and nothing less, only what is new is followed on from there; else the whole is followed again.

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
from rosprivacy.analysis.findings.concerns import concerns
from rosprivacy.analysis.findings.open_questions import open_bits
from rosprivacy.analysis.kernel import spreading
from rosprivacy.analysis.model import CANNOT, Bound, Statement
from rosprivacy.analysis.non_ros import unanswered
from rosprivacy.analysis.whatif.reach import PlacesOfFindings, Reach
from rosprivacy.analysis.whatif.spots import Spots, spots

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.case import Case
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.whatif.reach import Key, State

    Pair = tuple[Mapping[Key, State], Mapping[Key, State]]  # findings at an element before and after

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

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> graph, bound, hierarchy = factory()
    >>> rows = reliances(analyse(graph, bound, hierarchy), bound, hierarchy)
    >>> for row in rows:
    ...     leaks = sorted({(opening.category, opening.leak.name) for opening in row.findings})
    ...     print(row.statement.place, leaks, [element.name for element, _ in row.questions])
    labels.yaml:4 [('Video', '/archive'), ('Video', 'disk')] ['/filter']
    labels.yaml:5 [('Video', '/archive'), ('Video', 'disk')] ['/faces']
    standard:1 [] ['/rosout']
    """
    spread, elements = analysis.spread, analysis.graph.elements
    on_that_day = {v: analysis.outside[e] for v, e in enumerate(elements) if e in analysis.outside}
    bound = replace(bound, outside=on_that_day)
    said = spots(spread.graph, bound, elements)
    at = {same: some for same, some in said.items() if some.has_data(spread, bound)}
    asked = sum(map(spread.forms_of, analysis.emitted))
    if not at or not asked:
        return ()
    places = PlacesOfFindings(spread, tuple(concerns(spread, bound, hierarchy)), asked, accepts)
    today = _Today(bound, hierarchy, places, frozenset(unanswered(elements, bound.outside)))
    order = sorted(at, key=lambda same: (line_key(same[0]), same[1]))
    rows = (today.without(same[0], at[same]) for same in order)
    return tuple(row for row in rows if row.hangs)


@dataclass(eq=False, repr=False)
class _Today:
    """The answer as it is, and what there would be without a statement.

    Attributes
    ----------
    unknown
        Vertices of which something has to be known and is not stated.
    rounds_left
        How many analyses of the whole are left.
    """

    bound: Bound
    hierarchy: Hierarchy
    places: PlacesOfFindings
    unknown: Collection[int]
    rounds_left: int = field(default_factory=lambda: ROUNDS)

    @cached_property
    def ends(self) -> set[int]:
        """Where findings can be."""
        return self.places.vertices()

    @cached_property
    def reaches(self) -> tuple[Reach, ...]:
        """What the sources' data gets to; not looked for where no statement asks for it."""
        return _reaches(self.places, self.bound)

    @cached_property
    def open(self) -> Mapping[tuple[str, ...], int]:
        """What a reader sees of an element -> numbers of the categories for which it is open."""
        spread = self.places.spread
        numbers: dict[tuple[str, ...], int] = defaultdict(int)
        for vertex, bits in open_bits(spread, self.unknown).items():
            numbers[spread.graph.elements[vertex].shown_as] |= spread.bits.merged(bits & self.places.question_bits)
        return numbers

    def without(self, statement: Statement, at: Spots) -> Reliance:
        """Return what there would be without a statement about some elements and flows."""
        spread, graph = self.places.spread, self.places.spread.graph
        with_data = at.with_data(spread) or at.vertices
        flows = [graph.flows[index] for index in at.flows]
        row = Reliance(
            statement,
            _distinct(graph.elements[v] for v in (*with_data, *(flow.source for flow in flows))),
            _distinct(graph.elements[flow.target] for flow in flows),
        )
        less = at.without(self.bound, statement)
        try:
            now = self._letting_more_pass(statement, less)
            if now is None and not self.rounds_left:
                return row._replace(perhaps=True)
            pairs, is_open = self._further(now) if now else self._anew(less)
        except InputErrors as error:
            return row._replace(refused=str(error.errors[0]))
        # a type reviews nothing: what lies behind it is open as it is (rule S15)
        questions = () if statement.role == CANNOT else self._new_questions(is_open)
        return row._replace(findings=self._worse(pairs), questions=questions)

    def _letting_more_pass(self, statement: Statement, weaker: Bound) -> Spread | None:
        """What elements and flows do of which less is said, if that is more and nothing less; else None."""
        spread, graph = self.places.spread, self.places.spread.graph
        named = {
            *weaker.elements,
            *(graph.flows[index].target for index in weaker.flows),
        } & spread.channel_sources.keys()
        if named or any(s.through for said in weaker.elements.values() for s in said):
            return None
        left_out = spreading.LeftOut(spread, statement)
        now = spreading.meaning(graph, weaker, self.hierarchy, spread.categories, left_out)
        more = all(self._does_more(now, vertex) for vertex in weaker.elements)
        return now if more and not any(spread.flow_keeps[i] & ~now.flow_keeps[i] for i in weaker.flows) else None

    def _does_more(self, now: Spread, vertex: int) -> bool:
        """Whether an element does nothing less: what it pseudonymised may go on as it is, which is more."""
        spread = self.places.spread
        for name in ("emits", "leaks", "absent_bits"):
            if getattr(now, name).get(vertex, 0) != getattr(spread, name).get(vertex, 0):
                return False
        lost = set(spread.derives[vertex]) - set(now.derives[vertex])
        plain_goes_on = all(
            spread.bits.category(before) == spread.bits.category(after) and now.keeps[vertex] >> before & 1
            for before, after in lost
        )
        same = set(now.derives[vertex]) <= set(spread.derives[vertex]) and plain_goes_on
        return same and not spread.keeps[vertex] & ~now.keeps[vertex] and not (lost and self.places.accepts)

    def _further(self, now: Spread) -> tuple[list[Pair], dict[int, int]]:
        """Findings before and after, and what is open, where only more passes."""
        spread, flows = self.places.spread, self.places.spread.graph.flows
        opened = [v for v, keeps in now.keeps.items() if keeps & ~spread.keeps[v]]
        along = [
            (index, flows[index].source, flows[index].target)
            for index, keeps in now.flow_keeps.items()
            if keeps & ~spread.flow_keeps[index]
        ]
        pairs: list[Pair] = []
        new = {v: spread.present(v) for v in now.facts}  # of others only what is more
        for reach in self.reaches if opened or along else ():
            more = reach.further(now, [v for v in opened if reach.flood.arrived(v)], along)
            pairs += [(reach.states(v), more.states(v)) for v in more.touched & self.ends]
            for vertex, bits in more.new().items():
                new[vertex] = new.get(vertex, 0) | bits
        covered = {v: now.covered.get(v, 0) if v in now.facts else spread.covered.get(v, 0) for v in new}
        return pairs, {
            v: bits & ~spread.absent_bits.get(v, 0) & ~(0 if v in self.unknown else covered[v])
            for v, bits in new.items()
        }

    def _anew(self, weaker: Bound) -> tuple[list[Pair], dict[int, int]]:
        """The same by an analysis of the whole."""
        self.rounds_left -= 1
        elements, flows = {**self.bound.elements, **weaker.elements}, {**self.bound.flows, **weaker.flows}
        bound = replace(self.bound, elements=elements, flows=flows)
        spread = spreading.spread(self.places.spread.graph, bound, self.hierarchy)
        places = self.places._replace(spread=spread, concerns=tuple(concerns(spread, bound, self.hierarchy)))
        reaches = zip(self.reaches, _reaches(places, bound), strict=True)
        ends = sorted(self.ends | places.vertices())
        pairs: list[Pair] = [(before.states(v), after.states(v)) for before, after in reaches for v in ends]
        return pairs, open_bits(spread, self.unknown)

    def _worse(self, pairs: Iterable[Pair]) -> tuple[Opening, ...]:
        """The findings that are new or worse."""
        spread, elements = self.places.spread, self.places.spread.graph.elements
        openings = []
        for before, after in pairs:
            for key, (stands, plain) in after.items():
                kind, i, source, leak = key
                stood, was_plain = before.get(key, (False, False))
                if key not in before or (stands and not stood) or (plain and not was_plain):
                    opening = Opening(
                        kind, spread.categories[i], elements[source], elements[leak],
                        dismissed=not stands, pseudonymised=not plain, new=key not in before,
                    )  # fmt: skip
                    openings.append(((not stands, i, source, leak, kind), opening))
        return tuple(opening for _, opening in sorted(openings, key=lambda pair: pair[0]))

    def _new_questions(self, is_open: Mapping[int, int]) -> tuple[tuple[Element, tuple[str, ...]], ...]:
        """The elements that are open, with the categories for which they were not; the sides of a wildcard as one."""
        spread, elements = self.places.spread, self.places.spread.graph.elements
        asked: dict[tuple[str, ...], tuple[Element, set[str]]] = {}
        for vertex, bits in sorted(is_open.items()):
            numbers = spread.bits.merged(bits & self.places.question_bits)
            if numbers and (new := numbers & ~self.open.get(shown := elements[vertex].shown_as, 0)):
                asked.setdefault(shown, (elements[vertex], set()))[1].update(spread.names(new))
        return tuple((element, tuple(sorted(names))) for element, names in asked.values())


def _distinct(elements: Iterable[Element]) -> tuple[Element, ...]:
    """One of each that a reader sees."""
    return tuple({element.shown_as: element for element in elements}.values())


def _reaches(places: PlacesOfFindings, bound: Bound) -> tuple[Reach, ...]:
    """What the sources' data gets to, some of them at a time; also of those that another label takes away today."""
    sources = [v for v, said in sorted(bound.elements.items()) if any(s.role == "source" for s in said)]
    parts = (sources[begin : begin + TOGETHER] for begin in range(0, len(sources), TOGETHER))
    return tuple(Reach.of(places, part) for part in parts)
