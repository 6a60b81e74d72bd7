"""What can be tried at an element: filters beside it, policy lines there, a storage behind it, a doubt of its cleaning.

In: a session as it stands and an element. Out: ``Offers``, whose values a form hands back. A flow is named by the ids
of its ends and a policy line by an id of its own: nothing that a browser sends is the name of a file.
"""

from __future__ import annotations

from hashlib import sha256
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.kernel.vertices import by_identity
from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.text import fit
from rosprivacy.explorer.element_ids import DIGITS, element_id
from rosprivacy.explorer.web.titles import title_of
from rosprivacy.explorer.web.whose import MODEL, ROBOT, robots_told

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.model import Element, Flow, Place
    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.report.catalogs.words import Words

MOST = 60  # of one list; a line or a flow further away has an element nearer to it


class Offer(NamedTuple):
    """A value of a form, and what a person reads."""

    value: str
    told: str


class Offers(NamedTuple):
    """What can be tried.

    Attributes
    ----------
    flows, lines
        Along which data goes at the element, and by which lines.
    kinds
        Of data that is there.
    cleans
        Whether labels say that the element cleans something.
    whose
        Of a fleet: the robots on which it can be tried.
    shared
        Whether the element belongs to no robot of a fleet: what is on no robot is changed in the fleet file.
    """

    element: str
    flows: tuple[Offer, ...]
    lines: tuple[Offer, ...]
    kinds: tuple[Offer, ...]
    cleans: bool
    whose: tuple[Offer, ...]
    shared: bool


def flow_id(source: Element, target: Element) -> str:
    """Return what names the flows between two elements.

    >>> from rosprivacy.analysis.model import Element
    >>> flow_id(Element("node", "/camera"), Element("topic", "/video"))
    'e367b8bde1c84db46.ee42e87f26bf77176'
    """
    return f"{element_id(source.identity)}.{element_id(target.identity)}"


def line_id(place: Place) -> str:
    """Return what names a line of a policy; it is no name of a file."""
    return f"l{sha256(f'{place.file}{chr(0)}{place.line}'.encode('utf-8', 'surrogatepass')).hexdigest()[:DIGITS]}"


def offers_at(standing: Standing, element: Element, words: Words) -> Offers:
    """Return what can be tried at an element."""
    at = element_id(element.identity)
    ends = ((flow, _id(flow.source, standing), _id(flow.target, standing)) for flow in _flows(standing, element))
    flows = [flow for flow, source, target in ends if {source, target} <= standing.carried.keys()]
    kinds = standing.carried.get(at, ())
    whose = tuple(_whose(standing.session, element, words))
    shared = not (standing.session.of_one_robot or whose)
    places = dict.fromkeys(grant.place for flow in flows for grant in flow.grants)
    if standing.result.fleet:  # a line of the fleet file is none of a policy
        places = {place: None for place in places if line_id(place) in lines_of(standing)}
    return Offers(
        element=at,
        flows=tuple(_told(flows, standing))[:MOST],
        lines=() if shared else tuple(Offer(line_id(place), fit(str(place))) for place in places)[:MOST],
        kinds=tuple(Offer(kind, title_of(kind, standing.vocabulary, words)) for kind in kinds),
        cleans=cleans(standing, at) and not shared,
        whose=whose,
        shared=shared,
    )


def _whose(session: Session, element: Element, words: Words) -> Iterator[Offer]:
    """All robots of the model, and this one only; once where these are the same."""
    model, alone = (session.robots_like(element.robot, only_this_robot=one) for one in (False, True))
    if model != alone:
        yield Offer(MODEL, robots_told(session, model, words))
    if alone:
        yield Offer(ROBOT, robots_told(session, alone, words))


def cleans(standing: Standing, at: str) -> bool:
    """Whether labels say that an element ends some kind of data."""
    return any("sanitizer" in roles for roles in standing.roles.get(at, {}).values())


def lines_of(standing: Standing) -> Mapping[str, Place]:
    """Return the lines that allow something, by their ids."""
    grants = (grant for policy in standing.result.policies for grant in policy.grants if grant.allow)
    return {line_id(place): place for place in dict.fromkeys(grant.place for grant in grants)}


def between(standing: Standing, flow: str) -> tuple[tuple[Element, Element], ...]:
    """Return the ends of the flows that an id names: the legs of services are flows of their own."""
    first, _, second = flow.partition(".")
    elements = standing.elements
    if first not in elements or second not in elements:
        return ()
    wanted = elements[first].identity, elements[second].identity
    graph = standing.analysis.graph
    ends = ((graph.elements[one.source], graph.elements[one.target]) for one in _flows(standing, elements[first]))
    return tuple(dict.fromkeys((a, b) for a, b in ends if (a.identity, b.identity) == wanted))


def _flows(standing: Standing, element: Element) -> Iterator[Flow]:
    """The flows of an element from and to others; of meetings those only that it takes part in."""
    graph = standing.analysis.graph
    here = set(by_identity(standing.analysis.spread)[element.identity])
    stored, meetings = parted(graph.flows)
    yield from (flow for _, flow in stored if (flow.source in here) != (flow.target in here))
    for meeting in meetings:
        yield from (meeting.flow(a, b) for a in meeting.written if a in here for b in meeting.read if b not in here)
        yield from (meeting.flow(a, b) for b in meeting.read if b in here for a in meeting.written if a not in here)


def _id(vertex: int, standing: Standing) -> str:
    return element_id(standing.analysis.graph.elements[vertex].identity)


def _told(flows: Iterable[Flow], standing: Standing) -> Iterator[Offer]:
    elements = standing.analysis.graph.elements
    seen: set[str] = set()
    for flow in flows:
        source, target = elements[flow.source], elements[flow.target]
        value = flow_id(source, target)
        if value not in seen:
            seen.add(value)
            yield Offer(value, f"{shown(source.full_name)} → {shown(target.full_name)}")
