"""What the type and the name of a channel suggest of what goes through it, and how both go together.

1. A type that the table knows says which kinds, with its confidence. Of several types of a channel each says its own.
2. The name of a topic says no more than ``may`` by itself. It is not asked about services and actions, whose names are
   verbs, nor of a kind that the types cannot carry, nor where the types are known and suggest nothing, unless what the
   name says can have any type.
3. Where the name says a narrower kind of what the type says, the type says that, too: both agree.
4. Where the name says that it is something else (a depth image), what the type says of that (video) is ``may``. If
   the type itself leaves open which of both it is (a place of a person or of the robot), the name says it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence, interface_of
from rosprivacy.analysis.suggesting.evidence import NAMED, TYPE
from rosprivacy.analysis.suggesting.name_rules import of_topic

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.type_limits import TypeLimit
    from rosprivacy.analysis.model import Bound, Element, FlowGraph, Place, Suggestion
    from rosprivacy.analysis.suggesting.name_rules import NameRules, Spoken

    Key = tuple[str, str]  # name of a type, leg
ANYTHING = "PersonalData"  # the broadest category: a type that can carry it can carry anything


class Rules(NamedTuple):
    """What is known of types and names, and of kinds.

    Attributes
    ----------
    suggestions
        By type and leg; none for a type that was looked at and suggests no kind.
    limits
        What types cannot carry.
    """

    suggestions: Mapping[Key, tuple[Suggestion, ...]]
    limits: Mapping[Key, TypeLimit]
    names: NameRules
    hierarchy: Hierarchy

    def related_to_one(self, kind: str, others: Iterable[str]) -> bool:
        """Return whether data of one kind can be of one of the others."""
        return not self.hierarchy.overlaps[kind].keys().isdisjoint(others)


class Clue(NamedTuple):
    """One reason to think that a channel carries a kind."""

    kind: str
    ground: str
    confidence: Confidence
    reason: str
    place: Place


def carried_kinds(graph: FlowGraph, bound: Bound, rules: Rules) -> dict[int, tuple[Clue, ...]]:
    """Return what is suggested of each channel of a graph, by vertex; what suggests nothing is left out.

    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import VIDEO, factory
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> graph, bound, hierarchy = factory()
    >>> clues = carried_kinds(graph, bound, Rules({}, {}, NAMES, hierarchy))
    >>> [(graph.elements[vertex].name, one.kind, one.reason) for vertex, said in clues.items() for one in said]
    [('/faces', 'FaceTemplate', "'faces' in the name /faces"), ('/video', 'Video', "'video' in the name /video")]
    """
    found = {}
    for vertex, element in enumerate(graph.elements):
        if element.is_channel:
            clues = _clues(element, {one.name: one.place for one in reversed(bound.types.get(vertex, ()))}, rules)
            if clues:
                found[vertex] = clues
    return found


def cannot_carry(kind: str, element: Element, types: Sequence[str], rules: Rules) -> bool:
    """Return whether a channel is not made for a kind, by all of its types: they exclude it, or suggest other kinds.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> rules = Rules({("a/msg/Ids", ""): ()}, {}, NAMES, factory()[2])
    >>> topic = Element("topic", "/ids")
    >>> [cannot_carry("Video", topic, types, rules) for types in (["a/msg/Ids"], ["a/msg/Other"], [])]
    [True, False, False]
    """
    return bool(types) and all(_excludes(kind, (interface_of(name), element.leg), rules) for name in types)


def no_leg_carries(kind: str, type_: str, legs: Iterable[str], rules: Rules) -> bool:
    """Return whether a type is not made for a kind, in none of its legs.

    It excludes the kind, or suggests other kinds. Where the table limits one leg and not another, the other has a text
    or a field that can carry anything.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> rules = Rules({("a/msg/Ids", ""): ()}, {}, NAMES, factory()[2])
    >>> [no_leg_carries("Video", name, [""], rules) for name in ("a/msg/Ids", "a/msg/Other")]
    [True, False]
    """
    name = interface_of(type_)
    keys = [(name, leg) for leg in legs]
    limited = [key in rules.limits and kind in rules.limits[key].kinds for key in keys]
    return all(_excludes(kind, key, rules) for key in keys) and (all(limited) or not any(limited))


def suggests_nothing(kind: str, type_: str, legs: Iterable[str], rules: Rules) -> bool:
    """Return whether the table says of a type, in all legs, that it suggests no kind at all, or cannot carry this one.

    A type that suggests another kind is not enough: in a map there is what a scanner saw.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> rules = Rules({("a/msg/Ids", ""): ()}, {}, NAMES, factory()[2])
    >>> [suggests_nothing("Video", name, [""], rules) for name in ("a/msg/Ids", "a/msg/Other")]
    [True, False]
    """
    keys = [(interface_of(type_), leg) for leg in legs]
    return all(
        rules.suggestions.get(key) == () or (key in rules.limits and kind in rules.limits[key].kinds) for key in keys
    )


def _excludes(kind: str, key: Key, rules: Rules) -> bool:
    limit = rules.limits.get(key)
    if limit and kind in limit.kinds:
        return True
    said = rules.suggestions.get(key)
    return said is not None and not any(rules.related_to_one(kind, rule.kinds) for rule in said)


def _clues(element: Element, types: Mapping[str, Place], rules: Rules) -> tuple[Clue, ...]:
    spoken = of_topic(element.name, rules.names) if element.kind == "topic" else None
    if not types:
        return tuple(dict.fromkeys(_by_name(spoken, element))) if spoken else ()
    by_type = [clue for name, place in sorted(types.items()) for clue in _by_type(name, place, element, rules)]
    nothing = not by_type and all((interface_of(n), "") in rules.suggestions for n in types)
    if spoken is None or (nothing and not spoken.rule.any_type):
        return tuple(dict.fromkeys(by_type))
    by_name = [clue for clue in _by_name(spoken, element) if not _limited(clue.kind, types, rules)]
    kinds = {clue.kind for clue in by_name}
    if any(clue.kind in kinds for clue in by_type):
        others = spoken.rule.instead_of
        by_type = [one for one in by_type if one.kind not in others or one.confidence is not Confidence.MAY]
    joined = [one for clue in by_type for one in _beside(clue, kinds, spoken if kinds else None, rules)]
    return tuple(dict.fromkeys([*joined, *by_name]))


def _by_type(name: str, place: Place, element: Element, rules: Rules) -> Iterator[Clue]:
    for rule in rules.suggestions.get((interface_of(name), element.leg), ()):
        for kind in rule.kinds:
            yield Clue(kind, TYPE, rule.confidence, f"type {name} of {element.name} ({place}): {rule.why}", rule.place)


def _by_name(spoken: Spoken, element: Element) -> Iterator[Clue]:
    rule, quoted = spoken.rule, "_".join(spoken.words)
    for kind in rule.kinds:
        yield Clue(kind, NAMED, rule.confidence, f"'{quoted}' in the name {element.name}", rule.place)


def _limited(kind: str, types: Iterable[str], rules: Rules) -> bool:
    limits = [rules.limits.get((interface_of(name), "")) for name in types]
    return bool(limits) and all(limit and kind in limit.kinds for limit in limits)


def _beside(clue: Clue, named: set[str], spoken: Spoken | None, rules: Rules) -> Iterator[Clue]:
    """What a type says, where the name says some kinds as well."""
    narrower = [kind for kind in sorted(named) if kind != clue.kind and clue.kind in rules.hierarchy.ancestors[kind]]
    if narrower:
        if clue.kind != ANYTHING:
            yield from (clue._replace(kind=kind, confidence=Confidence.MAY) for kind in narrower)
    elif spoken and clue.kind in spoken.rule.instead_of:
        yield clue._replace(confidence=Confidence.MAY)
    else:
        yield clue
