"""Law that is pointed at and not followed into paths: the provisions, and who points at them.

In: facts read from the Turtle files. Out: which provisions are to be looked at for some categories, contexts and groups
of persons; which group of the closed list a person's words stand for.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.model import Category, PersonGroup, Pointer, Situation

NOBODY: Mapping[str, Collection[str]] = MappingProxyType({})
EVERY_SYSTEM = ""  # the name of the situation that each system is in


class Pointed(NamedTuple):
    """What is pointed at.

    Attributes
    ----------
    provisions
        By name, sorted.
    situations
        By name, sorted: every system, and each context.
    at_stake
        (kind of finding, names of the provisions that are at stake), sorted.
    groups
        The closed list of groups of persons, by name, sorted.
    """

    provisions: tuple[Pointer, ...] = ()
    situations: tuple[Situation, ...] = ()
    at_stake: tuple[tuple[str, tuple[str, ...]], ...] = ()
    groups: tuple[PersonGroup, ...] = ()

    def of_finding(self, kind: str) -> tuple[Pointer, ...]:
        """Return the provisions that a kind of finding is about, whatever the data."""
        names = dict(self.at_stake).get(kind, ())
        return tuple(one for one in self.provisions if one.name in names)

    def group_of(self, stated: str) -> PersonGroup | None:
        """Return the group of the closed list that a person's words stand for; None where they are no word of it."""
        word = " ".join(stated.split()).casefold()
        return next((group for group in self.groups if word in group.words), None)

    def rows(
        self, categories: Iterable[Category], contexts: Iterable[str], persons: Mapping[str, Collection[str]] = NOBODY
    ) -> list[tuple[Pointer, tuple[str, ...], tuple[str, ...]]]:
        """Return the provisions to look at, each with the categories and the contexts that call for it.

        What every system calls for comes with neither.

        Parameters
        ----------
        persons
            Category -> whom its data are about, as people state it: what such a group calls for, the category does.
        """
        of_kinds = {
            category.name: {*category.look_at, *self._of_persons(persons.get(category.name, ()))}
            for category in categories
        }
        here = {EVERY_SYSTEM, *contexts}
        of_contexts = {one.name: one.look_at for one in self.situations if one.name in here}
        found = []
        for pointer in self.provisions:
            kinds = tuple(name for name, names in sorted(of_kinds.items()) if pointer.name in names)
            where = [name for name, names in sorted(of_contexts.items()) if pointer.name in names]
            if kinds or where:
                found.append((pointer, kinds, tuple(name for name in where if name != EVERY_SYSTEM)))
        return found

    def _of_persons(self, stated: Iterable[str]) -> Iterator[str]:
        """The provisions that groups of the closed list call for."""
        for group in filter(None, map(self.group_of, stated)):
            yield from group.look_at
