"""Of all proposals those that a person is asked about: what nobody has said yet, one answer to each question.

A person's word is never proposed away: where a label of a user, by a name or a glob, speaks of an element for a kind,
no proposal does. But a glob that calls nodes conduits has not seen each of them (rule S11): that one lets data out is
proposed all the same. Where proposals for one element go against each other, the one that could hide something is left
out.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.evidence import (
    CONDUIT,
    DATA_FLOW,
    DERIVATION,
    GLOBBED,
    LEAK,
    MUNDANE,
    NEIGHBOUR,
    NEVER,
    SANITIZER,
    SENSITIVE,
    SOURCE,
    Evidence,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Bound, FlowGraph, Statement
    from rosprivacy.analysis.suggesting.evidence import Label, Proposal

Identity = tuple[str, str, str]
NEVER_OUTDONE = (SOURCE, LEAK, DERIVATION)


def unsaid(proposals: Iterable[Proposal], graph: FlowGraph, bound: Bound, hierarchy: Hierarchy) -> tuple[Proposal, ...]:
    """Return the proposals that ask something.

    >>> from rosprivacy.analysis.example import ARCHIVE, FILTERED, VIDEO, factory
    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, Label
    >>> from rosprivacy.analysis.suggesting.weighing import proposals
    >>> graph, bound, hierarchy = factory()
    >>> labels = [Label(graph.elements[ARCHIVE], "leak", "Video")]
    >>> both = ("sensitive", "never")
    >>> labels += [Label(graph.elements[at], role, "Video") for at in (FILTERED, VIDEO) for role in both]
    >>> said = [Evidence(label, "name", Confidence.MAY, "a word", Place("names.yaml", 1)) for label in labels]
    >>> [(one.label.element.name, one.label.role) for one in unsaid(proposals(said), graph, bound, hierarchy)]
    [('/filtered', 'sensitive'), ('/video', 'sensitive')]
    """
    said = said_of(graph, bound)
    by_element: dict[Identity, list[Proposal]] = defaultdict(list)
    for one in proposals:
        identity = one.label.element.identity
        if identity not in said or not _is_spoken_of(one, said[identity], hierarchy):
            by_element[identity].append(_although(one, said.get(identity, ())))
    kept = (one for together in by_element.values() for one in together if not _outdone(one, together, hierarchy))
    return tuple(kept)


def said_of(graph: FlowGraph, bound: Bound) -> dict[Identity, list[Statement]]:
    """Return what users' labels say of each element.

    >>> from rosprivacy.analysis.example import CAMERA, ROSOUT, factory
    >>> graph, bound, _ = factory()
    >>> said = said_of(graph, bound)
    >>> [[str(one.place) for one in said[graph.elements[vertex].identity]] for vertex in (CAMERA, ROSOUT)]
    [['labels.yaml:2'], []]
    """
    said: dict[Identity, list[Statement]] = defaultdict(list)
    for vertex, statements in bound.elements.items():
        said[graph.elements[vertex].identity] += [one for one in statements if not one.shipped and one.rank[0] > 0]
    return said


def spoken_of(label: Label, said: Sequence[Statement], hierarchy: Hierarchy) -> bool:
    """Return whether a person has spoken of the element for a kind that it may be about; of a source or leak, of all.

    Who says that a node lets one kind out has not said that it lets out no other.

    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> from rosprivacy.analysis.suggesting.evidence import Label
    >>> graph, bound, hierarchy = factory()
    >>> archive = graph.elements[ARCHIVE]
    >>> said = said_of(graph, bound)[archive.identity]  # leak: [FaceTemplate, Video]
    >>> [spoken_of(Label(archive, "leak", kind), said, hierarchy) for kind in ("Video", "Biometric")]
    [True, False]
    """
    near = hierarchy.distance if label.role in (SOURCE, LEAK) else hierarchy.overlap
    return any(
        not one.categories
        or not label.kind
        or one.role == "only"
        or any(near(label.kind, kind) is not None for kind in one.categories)
        for one in said
        if not (label.role == LEAK and _only_passes_on(one))
    )


def _only_passes_on(statement: Statement) -> bool:
    """Whether a glob, and no name, says that an element only passes data on."""
    return statement.role == CONDUIT and statement.glob


def _although(one: Proposal, said: Iterable[Statement]) -> Proposal:
    """The proposal that an element lets data out, with the glob that says otherwise as its first reason."""
    glob = next(filter(_only_passes_on, said), None) if one.label.role == LEAK else None
    if glob is None:
        return one
    reason = f"your glob at {glob.place} calls {one.label.element.name} a conduit"
    return one._replace(evidence=(Evidence(one.label, GLOBBED, one.confidence, reason, glob.place), *one.evidence))


def _is_spoken_of(one: Proposal, said: Sequence[Statement], hierarchy: Hierarchy) -> bool:
    """Whether a person has spoken of what is proposed, or of all narrower kinds beside which alone it is proposed."""
    if spoken_of(one.label, said, hierarchy):
        return True
    return all(
        each.beside and spoken_of(one.label._replace(kind=each.beside), said, hierarchy) for each in one.evidence
    )


def _outdone(one: Proposal, together: Sequence[Proposal], hierarchy: Hierarchy) -> bool:
    """Whether another proposal for the element answers the same question, and hides less."""
    label = one.label
    beside = label.role == LEAK and or_passes_on(one, together)
    if (label.role in NEVER_OUTDONE and not beside) or len(together) == 1:
        return False
    others = [each for each in together if each is not one and _related(label, each.label, hierarchy)]
    roles: Mapping[str, list[Proposal]] = defaultdict(list)
    for each in others:
        roles[each.label.role].append(each)
    of_its_own = [each for each in roles[LEAK] if not or_passes_on(each, together)]
    if label.role == CONDUIT or beside:
        same = not beside and any(each.label.kind == label.kind for each in roles[SOURCE])
        return same or bool(of_its_own or roles[SANITIZER])
    if label.role == SANITIZER:
        return bool(roles[SOURCE] or of_its_own)
    if label.role in (NEVER, MUNDANE):
        return any(_of_its_own(each) for each in roles[SENSITIVE])
    if label.role == SENSITIVE and not _of_its_own(one):
        return any(each.label.role in (NEVER, MUNDANE) for each in others)
    return False


def or_passes_on(leak: Proposal, together: Iterable[Proposal]) -> bool:
    """Return whether a leak is one of two answers: data end there, and nothing of the node itself says which.

    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, Label
    >>> from rosprivacy.analysis.suggesting.weighing import proposals
    >>> archive = factory()[0].elements[ARCHIVE]
    >>> def asked(ground):
    ...     labels = (Label(archive, role, "Video") for role in ("leak", "conduit"))
    ...     why = (ground, Confidence.MAY, "a reason", Place("a.yaml", 1))
    ...     return {one.label.role: one for one in proposals([Evidence(label, *why) for label in labels])}
    >>> [or_passes_on(said["leak"], said.values()) for said in (asked("data-flow"), asked("name"))]
    [True, False]
    """
    by_flows = all(reason.ground == DATA_FLOW for reason in leak.evidence)
    return by_flows and any(one.label.role == CONDUIT and one.label.kind == leak.label.kind for one in together)


def _of_its_own(one: Proposal) -> bool:
    """Whether anything of the channel itself says it, and not only what is beside it."""
    return any(reason.ground != NEIGHBOUR for reason in one.evidence)


def _related(label: Label, other: Label, hierarchy: Hierarchy) -> bool:
    return not label.kind or not other.kind or hierarchy.overlap(label.kind, other.kind) is not None
