"""A path of a search -> what is told of it: elements and steps, each step with the policy lines that allow it (S10).

In: a ``Net`` and a path as ``kernel/search.py`` reads it back. Out: a ``Witness``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.answer import Step

if TYPE_CHECKING:
    from collections.abc import Iterable

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
    >>> told = witness_of(net, path_to(net, reach, FACES, templates))
    >>> [(one.source.name, one.role, one.category) for one in told.steps]
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
