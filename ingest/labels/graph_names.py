"""The names of a graph, and what a name or glob of a label file matches there; where nothing, the nearest (rule S11).

In: a ``FlowGraph``. Out: vertices, or the error that says so.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.written_names import A_LITTLE, FEW, did_you_mean, literal, meant, nearest
from rosprivacy.ingest.policies.names import covered

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model import FlowGraph
    from rosprivacy.ingest.labels.entries import Entry, FlowEntry

COMPARISONS = 50_000  # of names, in the search for the nearest; a label file of another system is refused soon


class GraphNames:
    """The vertices of a graph by kind and name; what was matched once is known, whatever labels come after."""

    def __init__(self, graph: FlowGraph) -> None:
        self.graph = graph
        self.by_kind: dict[str, dict[str, list[int]]] = {}
        for vertex, element in enumerate(graph.elements):
            self.by_kind.setdefault(element.kind, {}).setdefault(element.name, []).append(vertex)
        self._matched: dict[tuple[str, tuple[str, ...]], tuple[int, ...]] = {}

    def matching(self, name: str, kinds: Iterable[str] | None = None) -> tuple[int, ...]:
        """Return the vertices of some kinds (of all by default) that a name or glob covers wholly, in order.

        >>> from rosprivacy.analysis.example import factory
        >>> GraphNames(factory()[0]).matching("/f*", ("node", "topic"))
        (2, 3, 5, 6)
        """
        asked = name, tuple(self.by_kind if kinds is None else kinds)
        if asked not in self._matched:
            known = [self.by_kind.get(kind, {}) for kind in asked[1]]
            self._matched[asked] = tuple(
                sorted(v for some in known for other in covered(name, some) for v in some[other])
            )
        return self._matched[asked]


class Unmatched:
    """The errors for names that match nothing, as long as looking for the nearest does not take too long."""

    def __init__(self, names: GraphNames) -> None:
        self._names, self._comparisons = names, 0

    def of_entry(self, entry: Entry) -> LabelError:
        """Return the error for a name that matches nothing, with the nearest names."""
        close = self._close(entry.name, entry.kinds)
        what = f"{shown(entry.name)!r} matches no {' or '.join(entry.kinds)} of the policies"
        name = meant(entry.name)
        elsewhere = [
            kind for kind in self._names.by_kind if kind not in entry.kinds and name in self._names.by_kind[kind]
        ]
        if elsewhere:
            hint = f"there is a {elsewhere[0]} of that name: move it to the section for it"
        else:
            hint = did_you_mean(close, "see the names with rosprivacy labels --init")
        return LabelError(entry.place.file, entry.place.line, what, hint)

    def of_flow(self, entry: FlowEntry) -> LabelError:
        """Return the error for a flow that is not there."""
        hints = []
        for end in (entry.source, entry.target):
            close = [] if self._names.matching(end) else self._close(end, self._names.by_kind)
            hints += [f"instead of {shown(end)} {did_you_mean(close)}"] if close else []
        what = f"no flow goes from {shown(entry.source)!r} to {shown(entry.target)!r}"
        hint = " ".join(hints) or "name two elements with a flow between them, in its direction"
        return LabelError(entry.place.file, entry.place.line, what, hint)

    def _close(self, name: str, kinds: Iterable[str]) -> list[str]:
        """The nearest names, as long as looking for them does not take too long."""
        known = [other for kind in kinds for other in self._names.by_kind.get(kind, {})]
        self._comparisons += len(known)
        if self._comparisons > COMPARISONS:
            return []
        return [literal(close) for close in nearest(meant(name), known, FEW, A_LITTLE)]
