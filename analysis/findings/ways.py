"""What lies on all ways of data to some places: sources, who makes one kind of another, who protects (rule S8).

In: a spread, and per vertex the bits that count there. Out: ``Ways``. A record of processing states of a row what lies
on the ways of that row, and of nothing else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.findings.sanitizing import recognised
from rosprivacy.analysis.kernel.backward import Turned
from rosprivacy.analysis.model.register_row import Derivation, Measure

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rosprivacy.analysis.kernel.backward import Backward
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Category


Maker = tuple[int, int, Derivation]  # bit that arrives, bit that leaves for it


class Ways(NamedTuple):
    """What lies on all ways to some places.

    Attributes
    ----------
    sources
        Vertices at which a way begins.
    """

    sources: tuple[int, ...]
    derivations: tuple[Derivation, ...]
    measures: tuple[Measure, ...]


class Rest(NamedTuple):
    """Sources whose data get to no place where they leave or rest: ways end at all nodes that get or make the data.

    Attributes
    ----------
    begun
        Source -> bits that count there; no way ends with them.
    arrives
        Vertex -> what arrives from these sources.
    """

    begun: Mapping[int, int]
    sources: Collection[int]
    arrives: Mapping[int, int]


class WaysOf:
    """Finds what lies on ways; what all questions about one spread need is looked up once.

    Parameters
    ----------
    categories
        With the law of each: who recognises persons or judges them protects nobody.

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, CATEGORIES, NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> of = WaysOf(carried, CATEGORIES)
    >>> video, faces = (of.to({ARCHIVE: carried.forms_of(kind)}) for kind in ("Video", "FaceTemplate"))
    >>> [(measure.element.name, measure.everywhere) for measure in video.measures], video.derivations
    ([('/filter', True)], ())
    >>> [made.element.name for made in faces.derivations], faces.measures, [NAMES[vertex] for vertex in faces.sources]
    (['/face_id'], (), ['/camera'])
    """

    def __init__(self, spread: Spread, categories: Mapping[str, Category]) -> None:
        self._spread = spread
        self._turned = Turned.of(spread)
        self._sources = {vertex for vertex in spread.facts if spread.begins(vertex)}
        self._single: dict[int, list[int]] = {}  # source -> flows along which alone it emits something
        for index in spread.flow_emits:
            self._single.setdefault(spread.graph.flows[index].source, []).append(index)
        self._makers: dict[int, list[Maker]] = {}
        for vertex, pairs in spread.derives.items():
            for before, after in pairs:
                (made_of,), (target,) = spread.names(1 << before), spread.names(1 << after)
                if made_of != target:
                    derivation = Derivation(spread.graph.elements[vertex], made_of, target)
                    self._makers.setdefault(vertex, []).append((before, after, derivation))
        recognising = recognised(spread, categories)
        self._cleaning = {
            vertex: [category for category, facts in sorted(decided.items()) if "sanitizer" in facts.roles]
            for vertex, decided in spread.facts.items()
            if vertex not in recognising
        }

    def sources(self, places: Mapping[int, int]) -> tuple[int, ...]:
        """Return at which sources ways to some places begin; O(flows that lead there)."""
        return self._beginning(self._turned.backward(places), places, self._sources)

    def to(self, places: Mapping[int, int], rest: Rest | None = None) -> Ways:
        """Return what lies on the ways to some places.

        Parameters
        ----------
        places
            Vertex -> bits that are present there and count.
        rest
            Where ways begin that end there; None for all ways to places where data leave or rest.

        Notes
        -----
        O(flows that lead there), and once more for each measure.
        """
        leading = self._turned.backward(places)
        begun, sources, arrives = rest or Rest(places, self._sources, self._spread.arrives)
        question = _Question(places, begun, self._beginning(leading, begun, sources), arrives, ending=rest is not None)
        measures = self._measures(leading, question)
        return Ways(
            question.sources,
            tuple(dict.fromkeys(self._derivations(leading, question))),
            tuple(measures),
        )

    def _measures(self, leading: Backward, question: _Question) -> Iterator[Measure]:
        """The sanitizers that data meet; those that differ only in the robot are one when it is question who passes."""
        spread, elements = self._spread, self._spread.graph.elements
        alike: dict[tuple[str, str, str], list[int]] = {}
        for vertex in sorted(leading.entering.keys() & self._cleaning.keys()):
            met = question.arrives.get(vertex, 0) & leading.entering[vertex]
            for category in self._cleaning[vertex] if question.ending or vertex not in question.places else ():
                if met & spread.forms_of(category):
                    alike.setdefault((elements[vertex].kind, elements[vertex].name, category), []).append(vertex)
        for (_, _, category), vertices in alike.items():
            everywhere = not self._past(vertices, spread.forms_of(category), question)
            for vertex in vertices:
                facts = spread.facts[vertex][category]
                yield Measure(elements[vertex], category, facts.method, not facts.unstated, everywhere)

    def _past(self, vertices: Collection[int], cleaned: int, question: _Question) -> bool:
        """Whether a way leads to the places on which nothing that some sanitizers clean arrives at them."""
        derives, places = self._spread.derives, dict(question.places)
        for vertex in vertices:
            arrives = question.arrives.get(vertex, 0) & ~cleaned
            made = sum({1 << after for before, after in derives.get(vertex, ()) if arrives >> before & 1})
            if made & cleaned & places.get(vertex, 0):
                return True  # it is made there, of what is not cleaned
            if vertex in places:
                places[vertex] &= ~cleaned  # a way that ends with it there has met the sanitizer
        leading = self._turned.backward(places, dict.fromkeys(vertices, cleaned))
        return bool(self._beginning(leading, {} if question.ending else question.begun, set(question.sources)))

    def _beginning(self, leading: Backward, begun: Mapping[int, int], sources: Collection[int]) -> tuple[int, ...]:
        """The sources that emit something that gets to the places, or is there as it begins."""
        spread = self._spread
        return tuple(
            vertex
            for vertex in sorted(leading.leaving.keys() | begun.keys())
            if vertex in sources
            and (
                spread.emits.get(vertex, 0) & leading.leaving.get(vertex, 0)
                or spread.begins(vertex) & begun.get(vertex, 0)
                or any(
                    spread.flow_emits[index]
                    & spread.passing(index)
                    & leading.entering.get(spread.graph.flows[index].target, 0)
                    for index in self._single.get(vertex, ())
                )
            )
        )

    def _derivations(self, leading: Backward, question: _Question) -> Iterator[Derivation]:
        begins, sources = self._spread.begins, set(question.sources)
        for vertex in sorted(leading.leaving.keys() | question.places.keys() | question.begun.keys()):
            there = question.arrives.get(vertex, 0) | (begins(vertex) if vertex in sources else 0)
            onward = leading.leaving.get(vertex, 0) | question.places.get(vertex, 0) | question.begun.get(vertex, 0)
            for before, after, derivation in self._makers.get(vertex, ()):
                if there >> before & 1 and onward >> after & 1:
                    yield derivation


class _Question(NamedTuple):
    """Which ways are asked about.

    Attributes
    ----------
    places
        Vertex -> bits that count there.
    begun
        Vertex -> bits that count where they begin.
    arrives
        Vertex -> what arrives from the sources.
    ending
        Whether they end at the places: then a place that cleans is a measure, too.
    """

    places: Mapping[int, int]
    begun: Mapping[int, int]
    sources: tuple[int, ...]
    arrives: Mapping[int, int]
    ending: bool
