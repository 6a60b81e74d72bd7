"""Evidence of all providers -> proposals: what several reasons for one label come to.

The rules, in full (docs/suggestions.md):

1. A proposal is as sure as its surest evidence.
2. Where two independent grounds (code, type, name) each say no more than ``may``, both together are ``likely``. Who
   wrote of a package that it ``may`` knew its types. Agreement never makes anything ``certain``: that is for one ground
   to say. Of a leak it is none: a name that says cloud, and code that writes a file, speak of two ways out. Of a
   derivation neither: the name of a package and the library that it stands on say the same thing once.
3. What could hide a leak (sanitizer, conduit, mundane, never) is ``may``, whatever agrees; it is ``likely`` only if the
   catalogue of packages says so.
4. What takes data away (all of these but conduit) is ``may`` also there, for a kind of which a finding is known.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import (
    DERIVATION,
    GROUNDS,
    HIDING,
    INDEPENDENT,
    LEAK,
    PACKAGE,
    ROLES,
    TAKING_AWAY,
    Proposal,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from rosprivacy.analysis.suggesting.evidence import Evidence, Label

SURENESS = {confidence: place for place, confidence in enumerate(Confidence)}  # the surest first
_PLACES = {role: place for place, role in enumerate(ROLES)}
_OF_GROUNDS = {ground: place for place, ground in enumerate(GROUNDS)}


def proposals(evidence: Iterable[Evidence], found: Collection[str] = ()) -> tuple[Proposal, ...]:
    """Join evidence into proposals, one for each label, sorted by element, role and kind.

    Parameters
    ----------
    evidence
        Of all providers, in any order.
    found
        Categories of which a finding is known, with all that are broader or narrower.

    Examples
    --------
    >>> from rosprivacy.analysis.model import Element, Place
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, Label
    >>> camera = Label(Element("node", "/camera"), "source", "Video")
    >>> rule = Place("names.yaml", 3)
    >>> said = [Evidence(camera, ground, Confidence.MAY, f"its {ground}", rule) for ground in ("name", "type")]
    >>> [(str(one.confidence), [reason.reason for reason in one.evidence]) for one in proposals(said)]
    [('likely', ['its type', 'its name'])]
    >>> relay = Label(Element("node", "/relay"), "conduit")
    >>> str(proposals([Evidence(relay, "data-flow", Confidence.LIKELY, "its types", rule)])[0].confidence)
    'may'
    """
    of_labels: dict[Label, list[Evidence]] = defaultdict(list)
    for one in evidence:
        of_labels[one.label].append(one)
    groups = ((label, _in_order(of_labels[label])) for label in sorted(of_labels, key=_order))
    return tuple(Proposal(label, _confidence(label, reasons, found), reasons) for label, reasons in groups)


def surer(one: Confidence, other: Confidence) -> bool:
    """Return whether the first is surer than the second.

    >>> surer(Confidence.LIKELY, Confidence.MAY), surer(Confidence.MAY, Confidence.MAY)
    (True, False)
    """
    return SURENESS[one] < SURENESS[other]


def closes_finding(label: Label, found: Collection[str]) -> bool:
    """Return whether a label takes away data of which a finding is known; a conduit takes nothing away.

    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.analysis.suggesting.evidence import Label
    >>> topic = Element("topic", "/t")
    >>> [closes_finding(Label(topic, role, "Video"), {"Video"}) for role in ("never", "sensitive")]
    [True, False]
    """
    return label.role in TAKING_AWAY and bool(found) and (not label.kind or label.kind in found)


def _confidence(label: Label, reasons: Sequence[Evidence], found: Collection[str]) -> Confidence:
    if label.role in HIDING:
        said = [one.confidence for one in reasons if one.ground == PACKAGE]
        sure = any(surer(one, Confidence.MAY) for one in said) and not closes_finding(label, found)
        return Confidence.LIKELY if sure else Confidence.MAY
    surest = reasons[0].confidence
    if surest is Confidence.MAY and len(reasons) > 1 and label.role not in (LEAK, DERIVATION):
        agreeing = {one.ground for one in reasons if not one.alone} & INDEPENDENT
        return Confidence.LIKELY if len(agreeing) > 1 else surest
    return surest


def _order(label: Label) -> tuple[object, ...]:
    return (label.element.sort_key(), _PLACES[label.role], label.kind, label.method or "", label.to)


def _in_order(reasons: Sequence[Evidence]) -> tuple[Evidence, ...]:
    return tuple(reasons) if len(reasons) == 1 else tuple(sorted(dict.fromkeys(reasons), key=_evidence_order))


def _evidence_order(one: Evidence) -> tuple[object, ...]:
    return (SURENESS[one.confidence], _OF_GROUNDS[one.ground], one.reason, one.place)
