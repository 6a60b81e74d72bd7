"""What lies outside ROS: storages, other systems, side channels, and what people state about them (rules S9, S10).

In: a spread and the facts that are stated. Out: where a category is kept too long or leaves the EEA, and why. What
nobody stated about an element is taken by its kind: data passes what only holds it, and leaks at what others see.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from rosprivacy.analysis.model import (
    NOWHERE,
    NonRosFacts,
    Statement,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.durations import Duration
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Element

T = TypeVar("T")
INSIDE, ADEQUATE, PARTLY, THIRD = "eea", "adequate", "partly", "third"  # where a country lies, GDPR chapter V
ADEQUACY = "adequacy"
TRANSFERS = (  # bases of a transfer: GDPR Article 45, 46(2)(a) to (f), 46(3), 49
    ADEQUACY,
    "public-instrument",
    "binding-corporate-rules",
    "standard-clauses",
    "code-of-conduct",
    "certification",
    "authorised-clauses",
    "derogation",
)
RECIPIENTS = ("controller", "joint-controller", "processor", "third-party")
BY_KIND = (-1, 0)  # the rank of what is taken by kind: below every label
TAKEN = {  # what each kind does with every category unless a label says otherwise
    "storage": "conduit",
    "shared-memory": "conduit",
    "side-channel": "conduit",
    "external-system": "leak",
    "display": "leak",
    "person": "leak",
}
PLACED = ("external-system", "storage")  # kinds whose country has to be known; others are where the robot is
EVERY = ""  # in place of a category


def by_kind(element: Element) -> tuple[Statement, ...]:
    """Return what is taken of an element when no label says otherwise.

    >>> from rosprivacy.analysis.model import Element
    >>> [statement.role for statement in by_kind(Element("display", "screen"))]
    ['leak']
    """
    role = TAKEN.get(element.kind)
    return (Statement(role, (), BY_KIND, NOWHERE),) if role else ()


def country_unknown(element: Element, facts: NonRosFacts) -> bool:
    """Return whether nobody can say if data there has left the EEA (rule S11).

    >>> from rosprivacy.analysis.model import Element
    >>> disk = Element("storage", "disk")
    >>> country_unknown(disk, NonRosFacts()), country_unknown(disk, NonRosFacts(country="DE"))
    (True, False)
    """
    return element.kind in PLACED and not facts.country and not facts.transfer


def kept_too_long(facts: NonRosFacts, category: str, hierarchy: Hierarchy) -> str:
    """Return why a storage keeps a category too long; empty if it does not.

    The data may be of any narrower kind (rule S7), so each of these is held against the limit nearest to it.

    >>> from rosprivacy.analysis.durations import parse
    >>> from rosprivacy.analysis.example import factory
    >>> facts = NonRosFacts(retention=((EVERY, parse("P6M")),), limits=(("Video", parse("P1M")),))
    >>> kept_too_long(facts, "Video", factory()[2]), kept_too_long(facts, "FaceTemplate", factory()[2])
    ('kept for P6M, which can be longer than the P1M that Video may be kept', '')
    """
    if facts.backups is True:
        return "it has backups, and nothing says for how long"
    for kind in sorted(hierarchy.ancestors, key=lambda kind: (kind != category, kind)):
        if category not in hierarchy.ancestors[kind]:
            continue
        kept = retention_of(facts, kind, hierarchy)
        if not kept:
            return f"no retention is stated for {kind}" if facts.retention else "no retention is stated"
        for duration in kept:
            whole = duration + facts.backups if facts.backups else duration
            for limit in nearest(facts.limits, kind, hierarchy):
                if whole.can_be_longer(limit):
                    how = f"{duration} and in backups {facts.backups} more" if facts.backups else duration
                    return f"kept for {how}, which can be longer than the {limit} that {kind} may be kept"
    return ""


def limited(facts: NonRosFacts, category: str, hierarchy: Hierarchy) -> bool:
    """Return whether it is stated how long a category may be kept there.

    >>> from rosprivacy.analysis.durations import parse
    >>> from rosprivacy.analysis.example import factory
    >>> facts = NonRosFacts(limits=(("Biometric", parse("P1M")),))
    >>> limited(facts, "FaceTemplate", factory()[2]), limited(facts, "Video", factory()[2])
    (True, False)
    """
    return bool(nearest(facts.limits, category, hierarchy))


def retention_of(facts: NonRosFacts, category: str, hierarchy: Hierarchy) -> list[Duration]:
    """Return how long a category is kept there, as stated of it or of the nearest broader one.

    >>> from rosprivacy.analysis.durations import parse
    >>> from rosprivacy.analysis.example import factory
    >>> facts = NonRosFacts(retention=((EVERY, parse("P6M")), ("Biometric", parse("P1D"))))
    >>> [str(*retention_of(facts, name, factory()[2])) for name in ("FaceTemplate", "Video")]
    ['P1D', 'P6M']
    """
    return nearest(facts.retention, category, hierarchy)


def nearest(stated: Iterable[tuple[str, T]], category: str, hierarchy: Hierarchy) -> list[T]:
    """Return what is stated of a category, or of the nearest broader one, ``EVERY`` above all.

    >>> from rosprivacy.analysis.example import factory
    >>> [nearest([(EVERY, 1), ("Biometric", 2)], name, factory()[2]) for name in ("FaceTemplate", "Video")]
    [[2], [1]]
    """
    above = hierarchy.ancestors[category]
    everything = {**above, EVERY: len(hierarchy.ancestors)}
    known = [(everything[name], value) for name, value in stated if name in everything]
    fewest = min((steps for steps, _ in known), default=0)
    return [value for steps, value in known if steps == fewest]


def on_day(outside: Mapping[int, NonRosFacts], today: str) -> dict[int, NonRosFacts]:
    """Return facts as they are on a day: where an adequacy decision has ended, there is none (rule S10).

    >>> facts = NonRosFacts(country="US", area=PARTLY, until="2026-06-30")
    >>> on_day({0: facts}, "2026-06-30")[0].area, on_day({0: facts}, "2026-07-01")[0].area
    ('partly', 'third')
    """
    return {
        vertex: replace(facts, area=THIRD) if facts.until and today > facts.until else facts
        for vertex, facts in outside.items()
    }


def transferred(facts: NonRosFacts) -> str:
    """Return why data there has left the EEA without a stated basis; empty if it has not.

    >>> transferred(NonRosFacts(country="CN", area=THIRD))
    'in CN, for which no adequacy decision is known; no basis for the transfer is stated'
    >>> transferred(NonRosFacts(country="CN", area=THIRD, transfer="standard-clauses"))
    ''
    """
    if facts.area not in (PARTLY, THIRD) or (facts.transfer and (facts.area, facts.transfer) != (THIRD, ADEQUACY)):
        return ""
    ended = f"the adequacy decision ended on {facts.until}" if facts.until else ""
    if facts.transfer:
        return f"in {facts.country}; the basis stated is adequacy, and {ended or 'no such decision is known'}"
    partly = f"whose adequacy decision covers {facts.adequacy}"
    what = f"for which {ended or 'no adequacy decision is known'}" if facts.area == THIRD else partly
    return f"in {facts.country}, {what}; no basis for the transfer is stated"
