"""Law that is pointed at and not followed into paths: the provisions, and the situations that point at them.

In: facts read from the Turtle files. Out: which provisions are to be looked at for some categories and contexts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model import Category, Pointer, Situation

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
    """

    provisions: tuple[Pointer, ...] = ()
    situations: tuple[Situation, ...] = ()
    at_stake: tuple[tuple[str, tuple[str, ...]], ...] = ()

    def of_finding(self, kind: str) -> tuple[Pointer, ...]:
        """Return the provisions that a kind of finding is about, whatever the data."""
        names = dict(self.at_stake).get(kind, ())
        return tuple(one for one in self.provisions if one.name in names)

    def rows(
        self, categories: Iterable[Category], contexts: Iterable[str]
    ) -> list[tuple[Pointer, tuple[str, ...], tuple[str, ...]]]:
        """Return the provisions to look at, each with the categories and the contexts that call for it.

        What every system calls for comes with neither.
        """
        of_kinds = {category.name: category.look_at for category in categories}
        here = {EVERY_SYSTEM, *contexts}
        of_contexts = {one.name: one.look_at for one in self.situations if one.name in here}
        found = []
        for pointer in self.provisions:
            kinds = tuple(name for name, names in sorted(of_kinds.items()) if pointer.name in names)
            where = [name for name, names in sorted(of_contexts.items()) if pointer.name in names]
            if kinds or where:
                found.append((pointer, kinds, tuple(name for name in where if name != EVERY_SYSTEM)))
        return found
