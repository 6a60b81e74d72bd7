"""What a policy's ``<metadata>`` says of an observation: when and by which door each grant was seen (rule S16).

In: the ``<profiles>`` of a policy that ``rosprivacy observe`` wrote. Out: when each of its grants was seen, and what
the observation says of itself. sros2 passes over metadata. What another program wrote there is left alone; what looks
like ours and cannot be read is told, and counts as a gap, since nobody knows what it said.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import (
    ENCLAVES_MADE_UP,
    FOLDED_NAMES,
    OBSERVATION_GAP,
    OBSERVED,
    WITHOUT_WARNINGS,
    Diagnostic,
    Seen,
    Severity,
    when_observed,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from lxml import etree

    from rosprivacy.analysis.model import Place

TAG, GRANT, FOLDED, OF_NO_NODE = "observed", "grant", "folded", "participant"
WAS = "was"  # in a folded name: one as it was seen
NOBODY = "/_no_node"  # namespace of profiles of endpoints of no node
VERSION = "1"
MADE_UP = "made-up"  # said of an enclave that no door told
_TIME = re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z", re.ASCII)
_GAP = re.compile(r"([a-z][a-z-]{0,40}):([1-9][0-9]{0,8})", re.ASCII)
_PARTICIPANT = re.compile(rf"{NOBODY}/(participant_[A-Za-z0-9_]{{1,64}})", re.ASCII)
_DOOR = re.compile(r"[a-z0-9][a-z0-9-]{0,20}", re.ASCII)

STILL_CHANGING = "still-changing"  # nodes or endpoints had come shortly before the end
NO_NODE = "no-node"  # endpoints of which nobody says which node they are of
HIDDEN = "hidden-endpoints"  # participants of which no endpoint is seen
SAME_NAME = "same-name"  # nodes of one name, of which only one was told
REFUSED = "refused"  # names that no ROS node can have: left out
UNANSWERED = "unanswered"  # nodes of which not all is known
GAPS = {  # what each means, for people
    HIDDEN: "participants of which no endpoint is seen; the domain may be secured: look from inside an enclave",
    NO_NODE: "endpoints of no node: elements outside ROS, one for each participant",
    REFUSED: "names left out, which no ROS node can have",
    SAME_NAME: "nodes of the same name as another, of which nothing is known",
    STILL_CHANGING: "the system was still changing at the end: look longer",
    UNANSWERED: "nodes of which not all is known: look again",
}
UNWARNED = (
    "made without warnings: the text has no line of standard error and no hidden name, so nodes of one name, nodes "
    "that did not answer and all that is hidden can be missing; make it anew with -a, --include-hidden and 2>&1"
)
SHOWN_AT_MOST = 3  # of folded names

Key = tuple[str, str, str, str]  # node, kind, role, name


class ObservedMetadata(NamedTuple):
    """What an observation says of itself, in the policy that was made of it (rule S16).

    Attributes
    ----------
    first, last
        From when to when somebody looked.
    gaps
        (what, how many) that is known to be missing, sorted.
    made_up_enclaves
        How many enclaves nobody told: one per node.
    folded
        (name, rule) of names that were folded into one, sorted.
    """

    by: tuple[str, ...]
    first: str
    last: str
    gaps: tuple[tuple[str, int], ...] = ()
    made_up_enclaves: int = 0
    folded: tuple[tuple[str, str], ...] = ()


def diagnostics_of(observed: ObservedMetadata, place: Place) -> Iterator[Diagnostic]:
    """Return what a reader has to know of a policy that was made of an observation."""
    yield Diagnostic(place, Severity.NOTICE, when_observed(observed.first, observed.last, observed.by), OBSERVED)
    if observed.made_up_enclaves:
        message = f"enclaves are made up: one per node ({observed.made_up_enclaves:,})"
        yield Diagnostic(place, Severity.NOTICE, message, ENCLAVES_MADE_UP)
    if observed.folded:
        named = [f"{shown(name)} by the rule {shown(rule)}" for name, rule in observed.folded[:SHOWN_AT_MOST]]
        more = f", and {len(observed.folded) - SHOWN_AT_MOST:,} more" if len(observed.folded) > SHOWN_AT_MOST else ""
        message = f"names made up at each start are folded: {', '.join(named)}{more}"
        yield Diagnostic(place, Severity.NOTICE, message, FOLDED_NAMES)
    for gap, number in observed.gaps:
        if gap == WITHOUT_WARNINGS:
            yield Diagnostic(place, Severity.WARNING, UNWARNED, WITHOUT_WARNINGS)
            continue
        said = f"the observation has a gap ({number:,}): {GAPS.get(gap, gap)}; the verdict is undetermined at best"
        yield Diagnostic(place, Severity.WARNING, said, OBSERVATION_GAP)


def unreadable(why: str, place: Place) -> Diagnostic:
    """Return what is to be said of metadata that look like ours and cannot be read."""
    message = f"what an observation says here cannot be read: {why}; observe again, or remove it"
    return Diagnostic(place, Severity.WARNING, message, OBSERVATION_GAP)


def observed_in(metadata: etree._Element) -> etree._Element | None:
    """Return what an observation says in a ``<metadata>``, if there is such a thing."""
    return ours_in(metadata, TAG)


def ours_in(metadata: etree._Element, tag: str) -> etree._Element | None:
    """Return the first element of a name in a ``<metadata>`` that says which version of ours it is."""
    return next((child for child in metadata if child.tag == tag and child.get("version") is not None), None)


def attribute(element: etree._Element, name: str) -> str:
    """Return what an attribute says; ``ValueError`` if it is not there."""
    value = element.get(name)
    if value is None:
        raise ValueError(f"<{shown(str(element.tag))}> without {name}")
    return str(value)


def grant_key(grant: etree._Element) -> Key:
    """Return which grant of the policy an element is about; ``ValueError`` if it does not say."""
    return attribute(grant, "node"), attribute(grant, "kind"), attribute(grant, "role"), attribute(grant, "name")


def observed_of(element: etree._Element) -> ObservedMetadata:
    """Return what an observation says of itself.

    Raises
    ------
    ValueError
        If it cannot be read.
    """
    if element.get("version") != VERSION:
        raise ValueError(f"version {shown(repr(element.get('version')))} of an observation is not known")
    folded = [(attribute(child, "name"), attribute(child, "rule")) for child in element if child.tag == FOLDED]
    return ObservedMetadata(
        _doors(element),
        _time(element, "from"),
        _time(element, "to"),
        tuple(_gaps(element)),
        int(element.get("enclave") == MADE_UP),
        tuple(sorted(folded)),
    )


def seen_of(element: etree._Element) -> Mapping[Key, Seen]:
    """Return when each grant of an enclave was seen.

    Raises
    ------
    ValueError
        If it cannot be read.
    """
    return {
        grant_key(grant): Seen(_doors(grant), _time(grant, "first"), _time(grant, "last"))
        for grant in element
        if grant.tag == GRANT
    }


def participants_of(element: etree._Element) -> Mapping[str, str]:
    """Return the profiles that are of no node: as what node they stand in the policy -> name of the element.

    Raises
    ------
    ValueError
        If it cannot be read.
    """
    found = {}
    for child in element:
        if child.tag == OF_NO_NODE:
            match = _PARTICIPANT.fullmatch(attribute(child, "node"))
            if match is None:
                raise ValueError(f"{shown(repr(child.get('node')))} names no participant")
            found[match[0]] = match[1]
    return found


def together(several: list[ObservedMetadata]) -> ObservedMetadata:
    """Return what the enclaves of a policy say, as one.

    >>> one = ObservedMetadata(("text",), "2026-11-22T10:00:00Z", "2026-11-22T10:05:00Z", (("no-node", 2),), 1)
    >>> together([one, one]).made_up_enclaves, together([one, one]).gaps
    (2, (('no-node', 2),))
    """
    gaps: dict[str, int] = {}
    for one in several:
        for gap, number in one.gaps:
            gaps[gap] = max(number, gaps.get(gap, 0))
    return ObservedMetadata(
        tuple(sorted({door for one in several for door in one.by})),
        min(one.first for one in several),
        max(one.last for one in several),
        tuple(sorted(gaps.items())),
        sum(one.made_up_enclaves for one in several),
        tuple(sorted({pair for one in several for pair in one.folded})),
    )


def _time(element: etree._Element, name: str) -> str:
    value = attribute(element, name)
    if not _TIME.fullmatch(value):
        raise ValueError(f"{name}={shown(repr(value))} is no time such as 2026-11-22T10:00:00Z")
    return value


def _doors(element: etree._Element) -> tuple[str, ...]:
    doors = attribute(element, "by").split()
    if not doors or not all(map(_DOOR.fullmatch, doors)):
        raise ValueError(f"by={shown(repr(element.get('by')))} names no door")
    return tuple(sorted(doors))


def _gaps(element: etree._Element) -> Iterator[tuple[str, int]]:
    for text in element.get("gaps", "").split():
        match = _GAP.fullmatch(text)
        if match is None:
            raise ValueError(f"gaps={shown(repr(element.get('gaps')))} is not a list such as no-node:2")
        yield match[1], int(match[2])
