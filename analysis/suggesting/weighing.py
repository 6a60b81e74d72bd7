"""What all reasons for a label come to, by one table; and which of these proposals a person is asked about.

A proposal is as sure as its surest evidence of a ground that may stand alone (``WEIGHTS``). Where two grounds that may
agree each say no more than ``may``, both together are ``likely``; agreement never makes anything ``certain``. What
takes data away is ``may`` for a kind of which a finding is known.

A person's word is never proposed away: where a label of a user, by a name or a glob, speaks of an element for a kind,
no proposal does. But a glob that calls nodes conduits has not seen each of them (rule S11): that one lets data out is
proposed all the same. Where proposals for one element go against each other, the one that could hide something is left
out.
"""

from __future__ import annotations

from collections import defaultdict
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import (
    CODE,
    CONDUIT,
    DATA_FLOW,
    DERIVATION,
    GLOBBED,
    GROUNDS,
    LEAK,
    MUNDANE,
    NAMED,
    NEIGHBOUR,
    NEVER,
    PACKAGE,
    ROLES,
    SANITIZER,
    SENSITIVE,
    SOURCE,
    TAKING_AWAY,
    TYPE,
    Evidence,
    LabelProposal,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Bound, FlowGraph, Statement
    from rosprivacy.analysis.suggesting.evidence import Identity, SuggestedLabel


class WeighingRow(NamedTuple):
    """A row of the table of weighing: of these grounds together, where the surest is at least ``floor``, what follows.

    Without ``agreed`` that is what the surest says, and no more than ``ceiling``.
    """

    grounds: frozenset[str]
    floor: Confidence = Confidence.MAY
    ceiling: Confidence = Confidence.CERTAIN
    agreed: Confidence | None = None


def _alone(
    *grounds: str, floor: Confidence = Confidence.MAY, ceiling: Confidence = Confidence.CERTAIN
) -> tuple[WeighingRow, ...]:
    return tuple(WeighingRow(frozenset([ground]), floor, ceiling) for ground in grounds)


def _together(*grounds: str) -> WeighingRow:
    return WeighingRow(frozenset(grounds), agreed=Confidence.LIKELY)


WEIGHING = {  # what is in no row is may
    SOURCE: (
        *_alone(PACKAGE, NAMED),
        *_alone(TYPE, floor=Confidence.CERTAIN),
        _together(TYPE, NAMED),
        _together(TYPE, CODE),
        _together(NAMED, CODE),
    ),
    SENSITIVE: (*_alone(TYPE, NAMED), _together(TYPE, NAMED)),
    LEAK: _alone(PACKAGE, CODE, NAMED),
    DERIVATION: _alone(PACKAGE, CODE, DATA_FLOW),
    **dict.fromkeys(
        (SANITIZER, CONDUIT, MUNDANE, NEVER), _alone(PACKAGE, ceiling=Confidence.LIKELY)
    ),  # could hide a leak
}
SURENESS = {confidence: place for place, confidence in enumerate(Confidence)}  # the surest first
PLACE_OF_ROLE = {role: place for place, role in enumerate(ROLES)}
PLACE_OF_GROUND = {ground: place for place, ground in enumerate(GROUNDS)}


def proposals(evidence: Iterable[Evidence], categories: Collection[str] = ()) -> tuple[LabelProposal, ...]:
    """Join evidence, in any order, into proposals, one for each label, sorted by element, role and kind.

    Parameters
    ----------
    categories
        Categories of which a finding is known, with all that are broader or narrower.

    Examples
    --------
    >>> from rosprivacy.analysis.model import Element, Place
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, SuggestedLabel
    >>> camera = SuggestedLabel(Element("node", "/camera"), "source", "Video")
    >>> rule = Place("names.yaml", 3)
    >>> said = [Evidence(camera, ground, Confidence.MAY, f"its {ground}", rule) for ground in ("name", "type")]
    >>> [(str(one.confidence), [reason.reason for reason in one.evidence]) for one in proposals(said)]
    [('likely', ['its type', 'its name'])]
    """
    of_labels: dict[SuggestedLabel, list[Evidence]] = defaultdict(list)
    for one in evidence:
        of_labels[one.label].append(one)
    groups = ((label, _in_order(of_labels[label])) for label in sorted(of_labels, key=_order))
    return tuple(LabelProposal(label, _weighed(label, reasons, categories), reasons) for label, reasons in groups)


def surer(first: Confidence, second: Confidence) -> bool:
    """Return whether the first is surer than the second.

    >>> surer(Confidence.LIKELY, Confidence.MAY), surer(Confidence.MAY, Confidence.MAY)
    (True, False)
    """
    return SURENESS[first] < SURENESS[second]


def weaker(first: Confidence, second: Confidence) -> Confidence:
    """Return the less sure of two.

    >>> str(weaker(Confidence.LIKELY, Confidence.MAY))
    'may'
    """
    return second if surer(first, second) else first


def closes_finding(label: SuggestedLabel, categories: Collection[str]) -> bool:
    """Return whether a label takes away data of which a finding is known; a conduit takes nothing away.

    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.analysis.suggesting.evidence import SuggestedLabel
    >>> topic = Element("topic", "/t")
    >>> [closes_finding(SuggestedLabel(topic, role, "Video"), {"Video"}) for role in ("never", "sensitive")]
    [True, False]
    """
    return label.role in TAKING_AWAY and bool(categories) and (not label.kind or label.kind in categories)


def _weighed(label: SuggestedLabel, reasons: Sequence[Evidence], categories: Collection[str]) -> Confidence:
    if closes_finding(label, categories):
        return Confidence.MAY
    return _by_table(label.role, tuple([(one.ground, one.confidence, one.alone) for one in reasons]))


@cache  # few reasons differ in this
def _by_table(role: str, reasons: tuple[tuple[str, Confidence, bool], ...]) -> Confidence:
    """What the table says of reasons of these grounds, the surest of each ground first."""
    return min((_row(row, reasons) for row in WEIGHING[role]), key=SURENESS.__getitem__)


def _row(row: WeighingRow, reasons: Iterable[tuple[str, Confidence, bool]]) -> Confidence:
    """What a row of the table says of reasons: may, if not all of its grounds are there."""
    speaking = [
        (ground, confidence)
        for ground, confidence, alone in reasons
        if ground in row.grounds and not (row.agreed and alone)
    ]
    if {ground for ground, _ in speaking} != row.grounds or surer(row.floor, speaking[0][1]):
        return Confidence.MAY
    return row.agreed or weaker(row.ceiling, speaking[0][1])


def _order(label: SuggestedLabel) -> tuple[object, ...]:
    return (label.element.sort_key(), PLACE_OF_ROLE[label.role], label.kind, label.method or "", label.to)


def _in_order(reasons: Sequence[Evidence]) -> tuple[Evidence, ...]:
    return tuple(reasons) if len(reasons) == 1 else tuple(sorted(dict.fromkeys(reasons), key=_place))


def _place(reason: Evidence) -> tuple[object, ...]:
    return (SURENESS[reason.confidence], PLACE_OF_GROUND[reason.ground], reason.reason, reason.place)


def unsaid(
    proposals: Iterable[LabelProposal], graph: FlowGraph, bound: Bound, hierarchy: Hierarchy
) -> tuple[LabelProposal, ...]:
    """Return the proposals that ask something: nobody has spoken of it, and no other one answers the same.

    >>> from rosprivacy.analysis.example import ARCHIVE, FILTERED, VIDEO, factory
    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, SuggestedLabel
    >>> from rosprivacy.analysis.suggesting.weighing import proposals
    >>> graph, bound, hierarchy = factory()
    >>> labels = [SuggestedLabel(graph.elements[ARCHIVE], "leak", "Video")]
    >>> both = ("sensitive", "never")
    >>> labels += [SuggestedLabel(graph.elements[at], role, "Video") for at in (FILTERED, VIDEO) for role in both]
    >>> said = [Evidence(label, "name", Confidence.MAY, "a word", Place("names.yaml", 1)) for label in labels]
    >>> [(one.label.element.name, one.label.role) for one in unsaid(proposals(said), graph, bound, hierarchy)]
    [('/filtered', 'sensitive'), ('/video', 'sensitive')]
    """
    said = said_of(graph, bound)
    by_element: dict[Identity, list[LabelProposal]] = defaultdict(list)
    for one in proposals:
        identity = one.label.element.identity
        if identity not in said or not spoken_of(one.label, said[identity], hierarchy):
            by_element[identity].append(_although(one, said.get(identity, ())))
    return tuple(one for together in by_element.values() for one in together if not _outdone(one, together, hierarchy))


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


def spoken_of(label: SuggestedLabel, statements: Sequence[Statement], hierarchy: Hierarchy) -> bool:
    """Return whether a person has spoken of the element for a kind that it may be about; of a source or leak, of all.

    Who says that a node lets one kind out has not said that it lets out no other.

    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> from rosprivacy.analysis.suggesting.evidence import SuggestedLabel
    >>> graph, bound, hierarchy = factory()
    >>> archive = graph.elements[ARCHIVE]
    >>> said = said_of(graph, bound)[archive.identity]  # leak: [FaceTemplate, Video]
    >>> [spoken_of(SuggestedLabel(archive, "leak", kind), said, hierarchy) for kind in ("Video", "Biometric")]
    [True, False]
    """
    near = hierarchy.distance if label.role in (SOURCE, LEAK) else hierarchy.overlap
    return any(
        not one.categories
        or not label.kind
        or one.role == "only"
        or any(near(label.kind, kind) is not None for kind in one.categories)
        for one in statements
        if not (label.role == LEAK and _only_passes_on(one))
    )


def _only_passes_on(statement: Statement) -> bool:
    """Whether a glob, and no name, says that an element only passes data on."""
    return statement.role == CONDUIT and statement.glob


def _although(proposal: LabelProposal, statements: Iterable[Statement]) -> LabelProposal:
    """The proposal that an element lets data out, with the glob that says otherwise as its first reason."""
    glob = next(filter(_only_passes_on, statements), None) if proposal.label.role == LEAK else None
    if glob is None:
        return proposal
    reason = f"your glob at {glob.place} calls {proposal.label.element.name} a conduit"
    return proposal._replace(
        evidence=(Evidence(proposal.label, GLOBBED, proposal.confidence, reason, glob.place), *proposal.evidence)
    )


def _outdone(proposal: LabelProposal, together: Sequence[LabelProposal], hierarchy: Hierarchy) -> bool:
    """Whether another proposal for the element answers the same question, and hides less."""
    label = proposal.label
    end_or_conduit = label.role == LEAK and or_passes_on(proposal, together)
    if (label.role in (SOURCE, LEAK, DERIVATION) and not end_or_conduit) or len(together) == 1:
        return False
    others = [each for each in together if each is not proposal and _related(label, each.label, hierarchy)]

    def of(*roles: str) -> list[LabelProposal]:
        return [each for each in others if each.label.role in roles]

    leaks = [each for each in of(LEAK) if not or_passes_on(each, together)]
    if label.role == CONDUIT or end_or_conduit:
        same = not end_or_conduit and any(each.label.kind == label.kind for each in of(SOURCE))
        return same or bool(leaks or of(SANITIZER))
    if label.role == SANITIZER:
        return bool(of(SOURCE) or leaks)
    if label.role in (NEVER, MUNDANE):
        return any(map(_of_its_own, of(SENSITIVE)))
    return label.role == SENSITIVE and not _of_its_own(proposal) and bool(of(NEVER, MUNDANE))


def or_passes_on(leak: LabelProposal, together: Iterable[LabelProposal]) -> bool:
    """Return whether a leak is one of two answers: data end there, and nothing of the node itself says which.

    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, SuggestedLabel
    >>> from rosprivacy.analysis.suggesting.weighing import proposals
    >>> archive = factory()[0].elements[ARCHIVE]
    >>> def asked(ground):
    ...     labels = (SuggestedLabel(archive, role, "Video") for role in ("leak", "conduit"))
    ...     why = (ground, Confidence.MAY, "a reason", Place("a.yaml", 1))
    ...     return {one.label.role: one for one in proposals([Evidence(label, *why) for label in labels])}
    >>> [or_passes_on(said["leak"], said.values()) for said in (asked("data-flow"), asked("name"))]
    [True, False]
    """
    by_flows = all(reason.ground == DATA_FLOW for reason in leak.evidence)
    return by_flows and any(one.label.role == CONDUIT and one.label.kind == leak.label.kind for one in together)


def _of_its_own(proposal: LabelProposal) -> bool:
    """Whether anything of the channel itself says it, and not only what is beside it."""
    return any(reason.ground != NEIGHBOUR for reason in proposal.evidence)


def _related(label: SuggestedLabel, other: SuggestedLabel, hierarchy: Hierarchy) -> bool:
    return not label.kind or not other.kind or hierarchy.overlap(label.kind, other.kind) is not None
