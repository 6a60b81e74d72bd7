"""The ways out that a system has if suggestions are right, those that weigh most first.

In: proposals, and the findings of an analysis in which they count as labels. Out: ``WayOut`` for each place where data
gets out. Ways along channels whose types are made for the data come before others, which are there all the same. No
proposal that closes a way is among them, so a wrong one shows a way too many, and hides none.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import DERIVATION, LEAK, SOURCE, SURE, LabelProposal, whole

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Category, Element, Weight
    from rosprivacy.analysis.suggesting.evidence import Identity

FARTHEST_FIRST = ("network", "domain", "file", "", "device", "loudspeaker", "display")  # '' where it is not known
OUTSIDE = {"external-system": "network", "storage": "file"}  # what the kind of an element says
MAKING = (SOURCE, DERIVATION)  # data that were not there before
LEAST_SURE_FIRST = (Confidence.MAY, Confidence.LIKELY, Confidence.CERTAIN)


class WayOut(NamedTuple):
    """A place where data gets out, and what of it is only suggested.

    Attributes
    ----------
    where
        Where the data goes from there: one of ``WHERE``, or empty.
    findings
        One for each kind of data and source, what weighs most first.
    likely
        How many of these come along channels whose types are made for them; they are the first.
    proposals
        On which the first finding hangs, the least sure first; none if it is stated.
    """

    exit: Element
    where: str
    findings: tuple[Finding, ...]
    likely: int
    proposals: tuple[LabelProposal, ...]

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of data that get out there, what weighs most first; only if there are no others, unlikely ones."""
        return tuple(dict.fromkeys(finding.category for finding in self.findings[: self.likely or None]))

    @property
    def unlikely_kinds(self) -> tuple[str, ...]:
        """Further kinds that get out there only along channels whose types are made for others."""
        kinds = dict.fromkeys(finding.category for finding in self.findings)
        return tuple(kind for kind in kinds if kind not in self.kinds)


def opening(proposals: Sequence[LabelProposal], *, sourced: bool = False) -> tuple[LabelProposal, ...]:
    """Return what may count in a trial: what surely or likely brings data in or makes it, and all that lets it out.

    Where nothing brings data in more surely, what may do so counts, too: without a source there is nothing to follow.

    Parameters
    ----------
    sourced
        Whether labels name a source.

    Examples
    --------
    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.analysis.suggesting.evidence import SuggestedLabel
    >>> rows = [("/cam", "source", "likely"), ("/mic", "source", "may"), ("/up", "leak", "may"), ("/x", "never", "may")]
    >>> proposals = [
    ...     LabelProposal(SuggestedLabel(Element("node", name), role, "Video"), Confidence(sure), ())
    ...     for name, role, sure in rows
    ... ]
    >>> [one.label.element.name for one in opening(proposals)], len(opening(proposals[1:]))
    (['/cam', '/up'], 2)
    """
    sourced = sourced or any(one.label.role == SOURCE and one.confidence in SURE for one in proposals)

    def counts(proposal: LabelProposal) -> bool:
        role = proposal.label.role
        sure = proposal.confidence in SURE
        return role == LEAK or (role in MAKING and sure) or (role == SOURCE and not sourced)

    return tuple(filter(counts, proposals))


def ways_out(
    findings: Iterable[Finding],
    proposals: Iterable[LabelProposal],
    categories: Mapping[str, Category],
    stated: Collection[str] = (),
    likely: Mapping[str, Finding] | None = None,
) -> tuple[WayOut, ...]:
    """Return the places where data gets out.

    The first are those which data gets to along channels that are made for it; of these those from which it goes
    farthest; of these those of the heaviest kind (``Weight``), what is stated before what is suggested, and the surest.

    Parameters
    ----------
    findings
        Of an analysis in which the proposals count as labels. What gets there through another leak counts, too: that
        one may be none.
    stated
        Ids of findings that there are without the proposals.
    likely
        By id, the findings that there are if channels carry what their types are made for; by default all.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CATEGORIES, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> findings = analyse(*factory()).findings
    >>> [(way.exit.name, way.where, way.kinds) for way in ways_out(findings, (), CATEGORIES)]
    [('disk', 'file', ('FaceTemplate', 'Video')), ('/archive', '', ('FaceTemplate', 'Video'))]
    """
    of_element: dict[Identity, list[LabelProposal]] = {}
    for one in proposals:
        of_element.setdefault(one.label.element.identity, []).append(one)
    exits: dict[Element, list[Finding]] = {}
    for finding in findings if likely is None else (likely.get(one.id, one) for one in findings):
        if not finding.accepted and (finding.through or not finding.dismissed):
            exits.setdefault(whole(finding.leak), []).append(finding)
    order = _Order(of_element, categories, stated, likely)
    return tuple(sorted((order.way(element, here) for element, here in exits.items()), key=order.of_way))


def weightiest(
    ways: Sequence[WayOut], ends: Sequence[WayOut], categories: Mapping[str, Category], at_most: int
) -> tuple[WayOut, ...]:
    """Return the places that weigh most: where data gets out, then where it ends.

    Where data ends that weighs more than what the lightest of them lets out, it is in its stead.

    Parameters
    ----------
    ways, ends
        In the order of ``ways_out``.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CATEGORIES, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> ways = ways_out(analyse(*factory()).findings, (), CATEGORIES)
    >>> [way.exit.name for way in weightiest(ways[:1], ways[1:], CATEGORIES, 1)]
    ['disk']
    """

    def weight(way: WayOut) -> Weight:
        return categories[way.kinds[0]].weight

    places = [*ways, *ends][:at_most]
    for end in ends[max(at_most - len(ways), 0) :]:
        lightest = max(places, key=weight)
        if weight(end) < weight(lightest):
            places.remove(lightest)
            places.append(end)
    return tuple(places)


class _Order(NamedTuple):
    """What comes first; the attributes are those of ``ways_out``, with the proposals by the element that they label."""

    of_element: Mapping[Identity, Sequence[LabelProposal]]
    categories: Mapping[str, Category]
    stated: Collection[str]
    likely: Mapping[str, Finding] | None

    def way(self, element: Element, findings: Iterable[Finding]) -> WayOut:
        """Return a place, with its findings in order."""
        here = sorted(findings, key=self.of_finding)
        where = _where(element, self.of_element.get(element.identity, ()))
        proposals = sorted(self._hanging_on(here[0]), key=_least_sure)
        return WayOut(element, where, tuple(here), sum(map(self._is_likely, here)), tuple(proposals))

    def of_way(self, way: WayOut) -> tuple[bool, int, bool, Weight, tuple[int, int], int, int, str]:
        """Return what places are sorted by."""
        unlikely, pseudonymised, heaviest, hops, sureness, _ = self.of_finding(way.findings[0])
        where = FARTHEST_FIRST.index(way.where)
        return unlikely, where, pseudonymised, heaviest, sureness, hops, -len(way.kinds), way.exit.full_name

    def of_finding(self, finding: Finding) -> tuple[bool, bool, Weight, int, tuple[int, int], str]:
        """Return what the findings of a place are sorted by."""
        on = [LEAST_SURE_FIRST.index(one.confidence) for one in self._hanging_on(finding)]
        sureness = (1, -min(on)) if on else (0, 0)
        kind = self.categories[finding.category].weight
        return not self._is_likely(finding), finding.pseudonymised, kind, len(finding.witness), sureness, finding.id

    def _is_likely(self, finding: Finding) -> bool:
        return self.likely is None or finding.id in self.likely

    def _hanging_on(self, finding: Finding) -> list[LabelProposal]:
        return [] if finding.id in self.stated else _proposals_of(finding, self.of_element)


def _proposals_of(finding: Finding, of_element: Mapping[Identity, Iterable[LabelProposal]]) -> list[LabelProposal]:
    """What is only suggested of a finding: that data comes in, is made of others on the way, or gets out.

    Of several suggestions that one node lets data out, the surest is enough.
    """
    on_the_way = {finding.category, *(step.category for step in finding.steps)}
    surest: dict[tuple[Identity, str, str], LabelProposal] = {}
    for element in finding.witness:
        for one in of_element.get(whole(element).identity, ()):
            role, kind = one.label.role, one.label.kind
            comes_in = role == SOURCE and element == finding.source and kind in on_the_way
            gets_out = role == LEAK and element == finding.leak
            makes = role == DERIVATION and one.label.to in on_the_way and kind in on_the_way
            if comes_in or gets_out or makes:
                key = (whole(element).identity, role, "" if gets_out else f"{kind} {one.label.to}")
                best = surest.setdefault(key, one)
                if LEAST_SURE_FIRST.index(one.confidence) > LEAST_SURE_FIRST.index(best.confidence):
                    surest[key] = one
    return list(surest.values())


def _least_sure(proposal: LabelProposal) -> tuple[int, bool]:
    """The order in which to ask; where both ends are as sure, whether data gets out."""
    return LEAST_SURE_FIRST.index(proposal.confidence), proposal.label.role != LEAK


def _where(element: Element, proposals: Iterable[LabelProposal]) -> str:
    """Where data goes from a place: what the surest suggestion says that it lets data out, else what its kind says."""
    leaks = [one for one in proposals if one.label.role == LEAK]
    surest = max(leaks, key=lambda one: LEAST_SURE_FIRST.index(one.confidence), default=None)
    said = (reason.where for reason in surest.evidence) if surest else ()
    return next(filter(None, said), OUTSIDE.get(element.kind, ""))
