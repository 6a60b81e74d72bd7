"""Analysis -> where each kind of data goes, as relationships that a path can follow without a condition (rules S7, S8).

In: an analysis, and which elements are labelled as sources of which kinds. Out: per pair of ends the kinds that go
from one to the other. A path over these from a source to a leak is there if, and only if, the data gets there.

Elements alone cannot hold this: at a node that cleans a kind and makes it anew, or that brings it in through one
channel and passes what others bring, a path could go on along what does not carry its data. There an ``Intake``
stands for the element at the end of what comes to it: what arrives goes on from there, what begins goes on from the
element.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.ingest.neo4j_graph.ids import carries

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.kernel.spread import Spread

INTAKE = True
End = tuple[int, bool]  # a vertex, and whether the end is its Intake


@dataclass(frozen=True, slots=True)
class Moving:
    """Bits that go along a flow, by how they come to be at its start; what is passed may be made or begun there too."""

    passed: int
    begun: int
    derived: int


def moving(analysis: Analysis) -> Iterator[Moving]:
    """Return what goes along each allowed flow, in the order of the graph."""
    found = analysis.spread
    known: dict[int, tuple[int, int]] = {}
    for index, flow in enumerate(analysis.graph.flows):
        if flow.source not in known:
            known[flow.source] = passed_and_made(found, flow.source)
        taken = found.passing(index)
        passed, made = known[flow.source]
        begun = found.emits.get(flow.source, 0) | found.flow_emits.get(index, 0)
        yield Moving(passed & taken, begun & taken, made & taken)


def passed_and_made(spread: Spread, vertex: int) -> tuple[int, int]:
    """Return what comes to an element and goes on, pseudonymised or not; and what it makes of what comes."""
    arrives = spread.arrives.get(vertex, 0)
    passed, made = arrives & spread.keeps.get(vertex, spread.all_bits), 0
    for before, after in spread.derives.get(vertex, ()):
        if arrives >> before & 1:
            same = spread.bits.category(before) == spread.bits.category(after)  # pseudonymised here
            made |= 0 if same else 1 << after
            passed |= 1 << after if same else 0
    return passed, made


class Carrying:
    """Where each kind goes; kinds are sets of numbers, as they are and pseudonymised put together.

    Parameters
    ----------
    labels
        Of each element: its labels.
    stems
        Category -> its label.

    Attributes
    ----------
    intakes
        Vertex -> kinds for which an ``Intake`` stands for it, where there are any.
    """

    def __init__(self, analysis: Analysis, labels: Sequence[Sequence[str]], stems: Mapping[str, str]) -> None:
        self._analysis = analysis
        self._spread = analysis.spread
        self._merged = analysis.spread.bits.merged
        self._sources = {stems[name] + "Source": 1 << i for i, name in enumerate(self._spread.categories)}
        self._types = [carries(stems[name]) for name in self._spread.categories]
        self._stems = [stems[name] for name in self._spread.categories]
        self._lists: dict[int, list[str]] = {}
        self._made_apart: dict[int, int] = {}
        self.intakes: dict[int, int] = {}
        for vertex in sorted(self._spread.arrives):
            self._split(vertex, labels[vertex])

    def _split(self, vertex: int, labels: Sequence[str]) -> None:
        """Set apart the kinds that arrive where the label of their source stands, and go on along other flows.

        A source of a narrower kind has the label, too; there nothing of the kind begins.
        """
        labelled = sum(self._sources.get(label, 0) for label in dict.fromkeys(labels))
        if not labelled:
            return
        found = self._spread
        passed, made = map(self._merged, passed_and_made(found, vertex))
        own, everywhere = self._merged(found.begins(vertex)), self._merged(found.emits.get(vertex, 0))
        differ = (passed & ~(everywhere | made)) | ((own | made) & ~passed)
        apart = made & own & ~everywhere
        if kinds := labelled & self._merged(found.arrives[vertex]) & differ | apart:
            self.intakes[vertex], self._made_apart[vertex] = kinds, apart

    def labels(self, vertex: int) -> list[str]:
        """Return the labels of an ``Intake``: of leaks; of a source where what it makes goes further."""
        leaks = self.intakes[vertex] & self._merged(self._spread.leaks.get(vertex, 0))
        said = (("Source", self._made_apart[vertex]), ("Leak", leaks))
        return [self._stems[i] + suffix for suffix, kinds in said for i in bits_of(kinds)]

    @cached_property
    def steps(self) -> list[tuple[End, End, list[str]]]:
        """(from, to, types of relationships), sorted; one from an element to itself where it is source and leak."""
        steps: dict[tuple[End, End], int] = defaultdict(int)
        for flow, some in zip(self._analysis.graph.flows, moving(self._analysis), strict=True):
            passed, begun, made = self._merged(some.passed), self._merged(some.begun), self._merged(some.derived)
            split, reached = self.intakes.get(flow.source, 0), self.intakes.get(flow.target, 0)
            apart = self._made_apart.get(flow.source, 0)
            for end, kinds in (
                ((flow.source, False), begun | made & ~apart | passed & ~split),
                ((flow.source, INTAKE), made & apart | passed & split),
            ):
                steps[end, (flow.target, False)] |= kinds & ~reached
                steps[end, (flow.target, INTAKE)] |= kinds & reached
        for vertex, bits in self._spread.leaks.items():
            leaks, made = self._merged(bits), self._merged(passed_and_made(self._spread, vertex)[1])
            apart = self._made_apart.get(vertex, 0)
            own = self._merged(self._spread.begins(vertex)) | made & ~apart
            steps[(vertex, False), (vertex, False)] |= own & leaks
            steps[(vertex, INTAKE), (vertex, INTAKE)] |= made & apart & leaks
        return [(*ends, self._names_of(kinds)) for ends, kinds in sorted(steps.items()) if kinds]

    def _names_of(self, kinds: int) -> list[str]:
        if kinds not in self._lists:
            self._lists[kinds] = [self._types[i] for i in bits_of(kinds)]
        return self._lists[kinds]
