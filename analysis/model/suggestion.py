"""What a message type suggests of what is sent in it: a question for a person, with its reason, and never a fact."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.python_311 import StrEnum

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model.diagnostic import Place


class Confidence(StrEnum):
    """How far a suggestion goes, the surest first.

    ``certain``: the type is made to carry the kind. ``likely``: it does on most robots that work among persons.
    ``may``: it depends on what is in it.
    """

    CERTAIN = "certain"
    LIKELY = "likely"
    MAY = "may"


class Suggestion(NamedTuple):
    """One rule of a table of types, at one type.

    Attributes
    ----------
    type
        Name of the type, ``pkg/msg/Name``.
    kinds
        Names of categories.
    why
        The reason, in a few words.
    source
        What the rule was read from.
    place
        The line of the table.
    """

    type: str
    kinds: tuple[str, ...]
    confidence: Confidence
    why: str
    source: str
    place: Place


def by_confidence(rule: Suggestion) -> int:
    """Return a key that sorts the surest first.

    >>> from rosprivacy.analysis.model.diagnostic import Place
    >>> said = ("MAY", "CERTAIN")
    >>> rules = [Suggestion("a/msg/A", ("Video",), Confidence[one], "", "", Place("types.yaml", 1)) for one in said]
    >>> [str(rule.confidence) for rule in sorted(rules, key=by_confidence)]
    ['certain', 'may']
    """
    return tuple(Confidence).index(rule.confidence)


def surest(rules: Iterable[Suggestion]) -> dict[str, Confidence]:
    """Return the kinds that some rules suggest, sorted, each with the surest confidence.

    >>> from rosprivacy.analysis.model.diagnostic import Place
    >>> kinds, place = ("Voice", "Video"), Place("types.yaml", 1)
    >>> rules = [Suggestion("a/msg/A", kinds, one, "", "", place) for one in (Confidence.MAY, Confidence.LIKELY)]
    >>> {kind: str(confidence) for kind, confidence in surest(rules).items()}
    {'Video': 'likely', 'Voice': 'likely'}
    """
    found: dict[str, Confidence] = {}
    for rule in sorted(rules, key=by_confidence):
        for kind in rule.kinds:
            found.setdefault(kind, rule.confidence)
    return dict(sorted(found.items()))


def interface_of(name: str) -> str:
    """Return the type of the service or action that a recorded message belongs to; other types as they are.

    >>> interface_of("nav_msgs/srv/GetMap_Event"), interface_of("nav2_msgs/action/Spin_SendGoal_Event")
    ('nav_msgs/srv/GetMap', 'nav2_msgs/action/Spin')
    >>> interface_of("nav2_msgs/action/Spin_FeedbackMessage"), interface_of("a_b/msg/C_D")
    ('nav2_msgs/action/Spin', 'a_b/msg/C_D')
    """
    package, _, last = name.rpartition("/")
    return f"{package}/{last.partition('_')[0]}" if package.endswith(("/srv", "/action")) else name  # no _ in the last
