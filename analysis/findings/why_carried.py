"""Why an element carries a kind of data: the shortest path from a source to it, with policy lines (rules S10, S11).

In: an ``Analysis``. Out: a ``Witness`` for any (element, category). It is what a person wants to see of an open element
before judging it. ``why_not.py`` answers the opposite question.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.witness import Witness, witness_of
from rosprivacy.analysis.kernel.search import from_sources, path_to
from rosprivacy.analysis.kernel.vertices import by_shown

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model import Element


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
