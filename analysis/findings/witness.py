"""Along which path data gets somewhere, step by step with the policy lines that allow it.

In: a ``Net`` and a path as ``kernel/search.py`` reads it back; or an ``Analysis``, an element and a category, which is
what a person wants to see of an open element before judging it (rules S10, S11). Out: a ``Witness``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.answer import Step
from rosprivacy.analysis.kernel.search import from_sources, path_to
from rosprivacy.analysis.kernel.vertices import by_shown

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.kernel.states import Net
    from rosprivacy.analysis.model import Element


class Witness(NamedTuple):
    """One path that proves that data gets somewhere.

    Attributes
    ----------
    elements
        Source first; one alone where data begins at the place that is asked about.
    steps
        The flows, one fewer than the elements.
    """

    elements: tuple[Element, ...]
    steps: tuple[Step, ...]


def witness_of(net: Net, path: Iterable[tuple[int, int, int]]) -> Witness:
    """Return elements and steps of a path; the two sides of one wildcard are one element to the reader (rule S4).

    Parameters
    ----------
    path
        (flow, vertex, bit with which data is there), as ``path_to`` returns it.

    Examples
    --------
    >>> from rosprivacy.analysis.example import FACES, factory
    >>> from rosprivacy.analysis.kernel.search import from_sources, path_to
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> net, reach = from_sources(spread(*factory()))
    >>> templates = net.spread.bits.plain(net.spread.categories.index("FaceTemplate"))
    >>> witness = witness_of(net, path_to(net, reach, FACES, templates))
    >>> [(step.source.name, step.role, step.category) for step in witness.steps]
    [('/camera', 'publish', 'Video'), ('/video', 'subscribe', 'Video'), ('/face_id', 'publish', 'FaceTemplate')]
    """
    graph, categories, bits = net.spread.graph, net.spread.categories, net.spread.bits
    (_, first, _), *more = path
    elements = [graph.elements[first]]
    steps: list[Step] = []
    for index, vertex, bit in more:
        flow, element = graph.flows[index], graph.elements[vertex]
        if element.shown_as == elements[-1].shown_as:
            continue
        form = categories[bits.category(bit)], bits.is_pseudonymised(bit)
        steps.append(Step(elements[-1], element, flow.role, *form, flow.grants))
        elements.append(element)
    return Witness(tuple(elements), tuple(steps))


class WhyCarried:
    """Shortest paths from the sources to elements; one search serves all that is asked.

    Parameters
    ----------
    analysis
        Its findings may be restricted to some categories; the paths are not.

    Attributes
    ----------
    net
        The flows that data can leave along, for who walks further.

    Notes
    -----
    O(flows · levels at which bits are new to their source) once for an analysis, then O(steps) for each path. Of paths
    of one length the same one is taken as for a finding, so that the same input gives the same path (rule S14).
    """

    def __init__(self, analysis: Analysis) -> None:
        spread = analysis.spread
        self.net, self._search = from_sources(spread)
        self._vertices = by_shown(spread)

    def path(self, element: Element, category: str) -> Witness | None:
        """Return one shortest path from a source to an element, along which a category gets there.

        Parameters
        ----------
        element
            Of the graph; of a service or action one leg; of a wildcard any side stands for both.
        category
            The name of an emitted category. What is made of other data on the path is that other data before.

        Returns
        -------
        Witness or None
            None if data of just this category does not get there, in whichever form. Of data as it is and
            pseudonymised data the nearer one is shown, the former where both are as near.
        """
        spread = self.net.spread
        if category not in spread.categories:
            return None
        forms = spread.bits.forms(spread.categories.index(category))
        ways = [
            (level, bit, vertex)
            for vertex in self._vertices.get(element.shown_as, ())
            for bit in forms
            if spread.present(vertex) >> bit & 1 and (level := self._search.level(vertex, 1 << bit)) is not None
        ]
        if not ways:
            return None
        _, bit, vertex = min(ways)
        return witness_of(self.net, path_to(self.net, self._search, vertex, bit))


def why_carried(analysis: Analysis, element: Element, category: str) -> Witness | None:
    """Return why one element carries a category; for several elements ask one ``WhyCarried``.

    >>> from rosprivacy.analysis.example import DISK, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> analysis = analyse(*factory())
    >>> path = why_carried(analysis, analysis.graph.elements[DISK], "Video")
    >>> [(step.source.name, step.role, *(str(grant.place) for grant in step.grants)) for step in path.steps][:2]
    [('/camera', 'publish', 'policy.xml:2'), ('/video', 'subscribe', 'policy.xml:8')]
    >>> path.elements[-1].name, path.steps[-1].pseudonymised
    ('disk', True)
    """
    return WhyCarried(analysis).path(element, category)
