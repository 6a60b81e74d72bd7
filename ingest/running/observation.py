"""What was seen running: nodes and what they write and read, when, and what is known to be missing (rule S16).

In: what a door has seen at one time. Out: ``Observation``; several of them added up. Observation only adds: what was
seen once stays, and a gap of one observation is a gap of their sum.

Times are texts such as ``2026-11-22T10:00:00Z``, always in UTC and to the second, so that they sort as times.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from datetime import datetime, timezone
from typing import TYPE_CHECKING

from rosprivacy.ingest.policies.observed_metadata import HIDDEN, NO_NODE, STILL_CHANGING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

ROLES = {
    "publish": "topic",
    "subscribe": "topic",
    "reply": "service",
    "request": "service",
    "execute": "action",
    "call": "action",
}


TYPE = "hri_privacy_msgs/msg/PersonalDataProcessor"
DDS_TYPE = "hri_privacy_msgs::msg::dds_::PersonalDataProcessor_"


def moment(time: datetime) -> str:
    """Return a time as observations hold it.

    >>> moment(datetime(2026, 11, 22, 10, 0, tzinfo=timezone.utc))
    '2026-11-22T10:00:00Z'
    """
    return time.astimezone(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


@dataclass(frozen=True, slots=True)
class Span:
    """When something was seen: the first and the last time."""

    first: str
    last: str

    def with_(self, other: Span) -> Span:
        """Return the span from the earlier first to the later last."""
        return Span(min(self.first, other.first), max(self.last, other.last))

    def meets(self, other: Span) -> bool:
        """Return whether two things may have been there at one time; touching counts."""
        return self.first <= other.last and other.first <= self.last


@dataclass(frozen=True, slots=True, order=True)
class Declared:
    """What a node declares of itself by the one ROS message for that, of hri_privacy_msgs of ROS4HRI.

    Attributes
    ----------
    topic
        On which it came.
    node, called
        From which the data stem, and how people are told of it.
    purpose, path
        What for, and the file in which they are kept; empty if it says none.
    """

    topic: str
    node: str
    label: str
    purpose: str
    path: str


@dataclass(frozen=True, slots=True)
class ObservedNode:
    """A node that was seen.

    Attributes
    ----------
    name
        Fully qualified, as it was seen.
    enclave
        Empty where there is none, or none was told.
    """

    name: str
    span: Span
    enclave: str = ""


@dataclass(frozen=True, slots=True)
class ObservedEndpoint:
    """What writes to a channel or reads from it.

    Attributes
    ----------
    node
        Fully qualified; empty if nobody says which node it is of.
    role
        A key of ``ROLES``: what a policy would have to allow.
    name
        Of the channel, fully qualified; ``x/_action/…`` as it was seen.
    type, hash
        Such as ``sensor_msgs/msg/Image`` and ``RIHS01_…``; empty where they are not known.
    key
        What tells the endpoint from others in its middleware (a gid); empty where nothing does.
    participant
        Of an endpoint of no node: what it is named by.
    doors
        By which it was seen; a door need not say so, since its observation does.
    """

    node: str
    role: str
    name: str
    span: Span
    type: str = ""
    hash: str = ""
    key: str = ""
    participant: str = ""
    doors: tuple[str, ...] = ()

    @property
    def kind(self) -> str:
        """Of the channel: ``topic``, ``service`` or ``action``."""
        return ROLES[self.role]

    @property
    def identity(self) -> tuple[str, ...]:
        """What makes two sightings one endpoint."""
        return (self.node, self.participant, self.role, self.name, self.type, self.hash)


@dataclass(frozen=True, slots=True)
class Folded:
    """Names that became one.

    Attributes
    ----------
    name
        What they are called now.
    names
        As they were seen, sorted.
    rule
        Of the generator, for people.
    """

    name: str
    names: tuple[str, ...]
    rule: str


@dataclass(frozen=True, slots=True)
class Observation:
    """What one door has seen, or several together.

    Attributes
    ----------
    doors
        By which it was seen, sorted: ``text``, ``zenoh``, ``dds``.
    span
        From when to when somebody looked.
    nodes, endpoints
        In any order; ``added_up`` sorts them.
    domains
        ROS domain ids, where they are known.
    gaps
        One of ``GAPS`` of ``observed_metadata`` -> how many. ``NO_NODE`` is counted here.
    remarks
        One line each, for people: what was left out, and why. Fit to be shown.
    declared
        What nodes said of themselves.
    folded
        Names that were one already when it was written before.
    """

    doors: tuple[str, ...]
    span: Span
    nodes: tuple[ObservedNode, ...] = ()
    endpoints: tuple[ObservedEndpoint, ...] = ()
    domains: tuple[int, ...] = ()
    gaps: Mapping[str, int] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    declared: tuple[Declared, ...] = ()
    folded: tuple[Folded, ...] = ()

    def __bool__(self) -> bool:
        """Whether there is anything in it that a policy can say."""
        return bool(self.nodes or self.endpoints)

    @property
    def all_gaps(self) -> dict[str, int]:
        """Every gap that is one, with the endpoints of no node, sorted."""
        strangers = len({(one.participant, one.role, one.name) for one in self.endpoints if not one.node})
        gaps = {**self.gaps, NO_NODE: max(strangers, self.gaps.get(NO_NODE, 0))}
        return {gap: gaps[gap] for gap in sorted(gaps) if gaps[gap]}


def continued(before: Observation, now: Observation) -> Observation:
    """Return what a door has seen so far, with what it sees now: only the end says what still changes or is hidden.

    A participant that was hidden when it left is counted by the door to the end.
    """
    settled = replace(before, gaps={gap: n for gap, n in before.gaps.items() if gap not in (STILL_CHANGING, HIDDEN)})
    return added_up((settled, now))


def added_up(observations: Iterable[Observation]) -> Observation:
    """Return several observations as one; the same whatever their order; ``ValueError`` if there is none."""
    several = tuple(observations)
    if not several:
        raise ValueError("no observation")
    seen = several[0].span
    gaps: dict[str, int] = {}
    for one in several:
        seen = seen.with_(one.span)
        for gap, number in one.gaps.items():
            gaps[gap] = max(number, gaps.get(gap, 0))
    return Observation(
        tuple(sorted({door for one in several for door in one.doors})),
        seen,
        tuple(_nodes(node for one in several for node in one.nodes)),
        tuple(_endpoints((endpoint, one.doors) for one in several for endpoint in one.endpoints)),
        tuple(sorted({domain for one in several for domain in one.domains})),
        gaps,
        tuple(dict.fromkeys(remark for one in several for remark in one.remarks)),
        tuple(sorted({declared for one in several for declared in one.declared})),
        folded_together(folded for one in several for folded in one.folded),
    )


def folded_together(several: Iterable[Folded]) -> tuple[Folded, ...]:
    """Return what was folded, each name once with all that it was."""
    names: dict[tuple[str, str], set[str]] = {}
    for one in several:
        names.setdefault((one.name, one.rule), set()).update(one.names)
    return tuple(Folded(name, tuple(sorted(some)), rule) for (name, rule), some in sorted(names.items()))


def _nodes(nodes: Iterable[ObservedNode]) -> Iterator[ObservedNode]:
    """Each node once in each of its enclaves; where one door tells the enclave and another does not, it is the one."""
    found: dict[tuple[str, str], Span] = {}
    for node in nodes:
        key = node.name, node.enclave
        found[key] = found[key].with_(node.span) if key in found else node.span
    told = {name for name, enclave in found if enclave}
    for name, enclave in sorted(found):
        if enclave and (name, "") in found and len([one for one, e in found if one == name and e]) == 1:
            yield ObservedNode(name, found[name, enclave].with_(found[name, ""]), enclave)
        elif enclave or name not in told:
            yield ObservedNode(name, found[name, enclave], enclave)


def _endpoints(endpoints: Iterable[tuple[ObservedEndpoint, tuple[str, ...]]]) -> Iterator[ObservedEndpoint]:
    """Each endpoint once; one whose node was told later or by another is of no stranger any more."""
    several = tuple(endpoints)
    owned = {endpoint.key for endpoint, _ in several if endpoint.node and endpoint.key}
    found: dict[tuple[str, ...], ObservedEndpoint] = {}
    for endpoint, doors in several:
        if not endpoint.node and endpoint.key in owned:
            continue
        known = found.setdefault(endpoint.identity, endpoint)
        by = {*known.doors, *(endpoint.doors or doors)}
        found[endpoint.identity] = replace(known, span=known.span.with_(endpoint.span), doors=tuple(sorted(by)))
    yield from (found[identity] for identity in sorted(found))
