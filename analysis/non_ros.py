"""What lies outside ROS: storages, other systems, side channels, and what people state about them (rules S9, S10).

In: a spread and the facts that are stated. Out: where a category is kept too long or leaves the EEA, and why. What
nobody stated about an element is taken by its kind: data passes what only holds it, and leaks at what others see.
"""

from __future__ import annotations

from datetime import datetime, timezone
from typing import TYPE_CHECKING, TypeVar

from rosprivacy.analysis.model import NOWHERE, NonRosFacts, Reason, Statement
from rosprivacy.analysis.model import reason as why

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.durations import Duration
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Element

T = TypeVar("T")
INSIDE, ADEQUATE, PARTLY, THIRD = "eea", "adequate", "partly", "third"  # where a country lies, GDPR chapter V
ADEQUACY, DEROGATION, OCCASIONAL = "adequacy", "derogation", "occasional-derogation"
TRANSFERS = (  # bases of a transfer: GDPR Article 45, 46(2)(a) to (f), 46(3), 49; with 49, that it is occasional
    ADEQUACY,
    "public-instrument",
    "binding-corporate-rules",
    "standard-clauses",
    "code-of-conduct",
    "certification",
    "authorised-clauses",
    DEROGATION,
    OCCASIONAL,
)
RECIPIENTS = ("controller", "joint-controller", "processor", "third-party")
BY_KIND = (-1, 0)  # the rank of what is taken by kind: below every label
DEFAULT_ROLES = {  # what each kind does with every category unless a label says otherwise
    "storage": "conduit",
    "shared-memory": "conduit",
    "side-channel": "conduit",
    "external-system": "leak",
    "display": "leak",
    "person": "leak",
}
RESTING = ("storage", "external-system", "display", "participant", "person", "device")  # data are there for others
PLACED = ("external-system", "storage")  # kinds whose country has to be known; others are where the robot is
EVERY = ""  # in place of a category


def by_kind(element: Element) -> tuple[Statement, ...]:
    """Return what is taken of an element when no label says otherwise.

    >>> from rosprivacy.analysis.model import Element
    >>> [statement.role for statement in by_kind(Element("display", "screen"))]
    ['leak']
    """
    role = DEFAULT_ROLES.get(element.kind)
    return (Statement(role, (), BY_KIND, NOWHERE),) if role else ()


def unanswered(elements: Sequence[Element], outside: Mapping[int, NonRosFacts]) -> dict[int, tuple[str, ...]]:
    """Return what has to be known of elements outside ROS and nobody states, by vertex (rule S11).

    >>> from rosprivacy.analysis.model import Element
    >>> unanswered([Element("storage", "disk")], {0: NonRosFacts()})
    {0: ('country',)}
    """
    asked = ((vertex, not_stated(elements[vertex], facts)) for vertex, facts in outside.items())
    return {vertex: missing for vertex, missing in asked if missing}


def not_stated(element: Element, facts: NonRosFacts) -> tuple[str, ...]:
    """Return what has to be known of where data there goes and nobody states (rule S11).

    The country where there has to be one and no transfer is stated: nobody can say if data there has left the EEA.
    Of a transfer on a derogation whether it is occasional: Article 49 is for specific situations (recital 111), and
    robots that send all the time are none. ``occasional-derogation`` is a person's word that it is.

    >>> from rosprivacy.analysis.model import Element
    >>> disk = Element("storage", "disk")
    >>> not_stated(disk, NonRosFacts()), not_stated(disk, NonRosFacts(country="DE", area=INSIDE))
    (('country',), ())
    >>> [not_stated(disk, NonRosFacts(country="CN", area=THIRD, transfer=basis)) for basis in (DEROGATION, OCCASIONAL)]
    [('occasional',), ()]
    """
    if facts.transfer == DEROGATION and facts.area not in (INSIDE, ADEQUATE):
        return ("occasional",)
    return ("country",) if element.kind in PLACED and not facts.country and not facts.basis else ()


def kept_too_long(facts: NonRosFacts, category: str, hierarchy: Hierarchy) -> Reason | None:
    """Return why a storage keeps a category too long; None if it does not.

    The data may be of any narrower kind (rule S7), so each of these is held against the limit nearest to it. Where
    nothing else is wrong, the age of a recording is held against its retention, on the day that is asked.

    >>> from rosprivacy.analysis.durations import parse
    >>> from rosprivacy.analysis.example import factory
    >>> facts = NonRosFacts(retention=((EVERY, parse("P6M")),), limits=(("Video", parse("P1M")),))
    >>> str(kept_too_long(facts, "Video", factory()[2])), kept_too_long(facts, "FaceTemplate", factory()[2])
    ('kept for P6M, which can be longer than the P1M that Video may be kept', None)
    """
    if facts.backups is True:
        return Reason(why.ENDLESS_BACKUPS)
    past: list[Reason] = []
    for kind in sorted(hierarchy.ancestors, key=lambda kind: (kind != category, kind)):
        if category not in hierarchy.ancestors[kind]:
            continue
        kept = retention_of(facts, kind, hierarchy)
        if not kept:
            return Reason.of(why.NO_RETENTION_FOR, category=kind) if facts.retention else Reason(why.NO_RETENTION)
        for duration in kept:
            whole = duration + facts.backups if facts.backups else duration
            for limit in nearest(facts.limits, kind, hierarchy):
                if whole.can_be_longer(limit):
                    said = {"kept": duration, "limit": limit, "category": kind}
                    if facts.backups:
                        return Reason.of(why.KEPT_LONGER_IN_BACKUPS, **said, backups=facts.backups)
                    return Reason.of(why.KEPT_LONGER, **said)
            past += kept_past(facts, duration)
    return past[0] if past else None


def kept_past(facts: NonRosFacts, retention: Duration) -> list[Reason]:
    """Return that a recording is older than it is kept; nothing where it is not, or where its age is not known.

    >>> from rosprivacy.analysis.durations import parse
    >>> from rosprivacy.analysis.model.recording import Recording
    >>> bag = Recording("run1", 0, 0, oldest=1_700_000_000 * 10**9)
    >>> [len(kept_past(NonRosFacts(recording=bag, day=day), parse("P30D"))) for day in ("2023-12-14", "2023-12-15")]
    [0, 1]
    """
    oldest = facts.recording.oldest if facts.recording else None
    if oldest is None or not facts.day:
        return []
    since = datetime.fromtimestamp(oldest // 10**9, timezone.utc)
    ended = retention.ends(since).date().isoformat()
    if facts.day <= ended:
        return []
    return [Reason.of(why.KEPT_PAST, since=since.date().isoformat(), kept=retention, ended=ended)]


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

    The age of a recording is held against that day.

    >>> facts = NonRosFacts(country="US", area=PARTLY, until="2026-06-30")
    >>> on_day({0: facts}, "2026-06-30")[0].area, on_day({0: facts}, "2026-07-01")[0].area
    ('partly', 'third')
    """
    return {vertex: _on_day(facts, today) for vertex, facts in outside.items()}


def _on_day(facts: NonRosFacts, today: str) -> NonRosFacts:
    ended = facts.until and today > facts.until
    if not (ended or facts.recording):
        return facts
    return facts._replace(area=THIRD if ended else facts.area, day=today if facts.recording else "")


def transferred(facts: NonRosFacts) -> Reason | None:
    """Return why data there has left the EEA without a stated basis; None if it has not.

    >>> str(transferred(NonRosFacts(country="CN", area=THIRD)))
    'in CN, for which no adequacy decision is known; no basis for the transfer is stated'
    >>> transferred(NonRosFacts(country="CN", area=THIRD, transfer="standard-clauses")) is None
    True
    """
    if facts.area not in (PARTLY, THIRD) or (facts.basis and (facts.area, facts.basis) != (THIRD, ADEQUACY)):
        return None
    if facts.area == PARTLY:
        return Reason.of(why.PARTLY_ADEQUATE, country=facts.country, recipients=facts.adequacy)
    ended, never = (
        (why.STATED_NO_LONGER_ADEQUATE, why.STATED_NOT_ADEQUATE)
        if facts.basis
        else (why.NO_LONGER_ADEQUATE, why.NOT_ADEQUATE)
    )
    if facts.until:
        return Reason.of(ended, country=facts.country, until=facts.until)
    return Reason.of(never, country=facts.country)
