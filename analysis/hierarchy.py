"""Which category is a kind of which (rule S7): ``skos:broader`` closed transitively, with distances.

In: categories with their direct broader ones. Out: for each category the broader ones, nearest first, and those that it
overlaps: with which it has a kind in common.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.model import Category


class Hierarchy(NamedTuple):
    """The closure of ``skos:broader``.

    Attributes
    ----------
    ancestors
        Name -> names of itself (distance 0) and all broader categories, with the least number of steps up.
    overlaps
        Name -> names of all categories with a common same-or-narrower one: broader, narrower and overlapping ones, with
        the least number of steps up to the first from a common one.
    """

    ancestors: Mapping[str, Mapping[str, int]]
    overlaps: Mapping[str, Mapping[str, int]]

    @classmethod
    def of(cls, categories: Iterable[Category]) -> Hierarchy:
        """Close the hierarchy of some categories; parents that are not among them are left out.

        A cycle does no harm here (every member is broader than every other); the ontology's rules refuse it.

        >>> from rosprivacy.analysis.model import Category
        >>> hierarchy = Hierarchy.of([Category("Video", "", "", "", "", ("Image",)), Category("Image", "", "", "", "")])
        >>> hierarchy.distance("Video", "Image"), hierarchy.broader("Video"), hierarchy.narrowest(["Image", "Video"])
        (1, ['Image'], ('Video',))
        """
        parents = {category.name: category.broader for category in categories}
        ancestors = {name: _climb(name, parents) for name in parents}
        return cls(ancestors, _meet(ancestors))

    def distance(self, category: str, broader: str) -> int | None:
        """Steps from a category up to a same or broader one; None if it is not broader."""
        return self.ancestors[category].get(broader)

    def overlap(self, category: str, other: str) -> int | None:
        """Steps up to a category from the nearest kind that is of both; None if nothing can be of both (rule S7)."""
        return self.overlaps[category].get(other)

    def broader(self, category: str) -> list[str]:
        """All strictly broader categories, nearest first."""
        above = self.ancestors[category]
        return sorted((name for name in above if name != category), key=lambda name: (above[name], name))

    def narrowest(self, categories: Iterable[str]) -> tuple[str, ...]:
        """Of some categories those that have no narrower one among them, sorted."""
        names = set(categories)
        covered = {above for name in names for above in self.ancestors[name] if above != name}
        return tuple(sorted(names - covered))


def _climb(start: str, parents: Mapping[str, tuple[str, ...]]) -> dict[str, int]:
    steps = {start: 0}
    level = [start]
    while level:
        level = [up for name in level for up in parents[name] if up in parents]
        level = [up for up in dict.fromkeys(level) if up not in steps]
        distance = max(steps.values()) + 1
        steps.update(dict.fromkeys(level, distance))
    return steps


def _meet(ancestors: Mapping[str, Mapping[str, int]]) -> dict[str, dict[str, int]]:
    overlaps: dict[str, dict[str, int]] = {name: {} for name in ancestors}
    for above in ancestors.values():
        for name, steps in above.items():
            for other in above:
                overlaps[name][other] = min(steps, overlaps[name].get(other, steps))
    return overlaps
