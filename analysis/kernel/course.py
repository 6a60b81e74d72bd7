"""How data goes on, as something that several answers share: what was found of it once holds for all of them.

In: what somebody asks to be found, and what that rests on beside the course. Out: what is found. An edit of a label
that moves no data makes a new answer, but no new course.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

Found = TypeVar("Found")


class Course:
    """What was found of one way that data goes; made with each ``Spread``, and shared by those that are alike.

    Whoever asks names in ``under`` all that it rests on beside what ``Spread.otherwise`` compares. That is compared by
    value, so what is kept cannot grow old.

    Examples
    --------
    >>> course = Course()
    >>> [course.kept("length", words, lambda: len(words)) for words in (("a", "b"), ("a", "b"), ("c",))]
    [2, 2, 1]
    """

    def __init__(self) -> None:
        self._kept: dict[str, tuple[object, Any]] = {}

    def kept(self, what: str, under: object, find: Callable[[], Found]) -> Found:
        """Return what is found, or was found before under the same; of each thing the last is kept."""
        known = self._kept.get(what)
        if known is None or known[0] != under:
            known = self._kept[what] = under, find()
        found: Found = known[1]
        return found
