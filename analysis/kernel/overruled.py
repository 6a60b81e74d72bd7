"""Sources and leaks that one statement says and another takes away: that is never silent (rule S7).

In: what statements mean for each element. Out: ``Overruled``, for a warning and for what is assumed; and an error where
one of a user's files takes away what another says, and does not say so by name.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.kernel.ranks import NONE_OF, in_words
from rosprivacy.analysis.model import STANDARD, Diagnostic, Method, Severity

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.model import Element, Statement

LISTED = 3  # names in a message
USERS = STANDARD + 1  # the tier of a user's files; what people write into the database is above


class Overruled(NamedTuple):
    """A source or a leak that does not hold at some elements, since another statement outdoes it.

    Attributes
    ----------
    lost, by
        The statement, and the one that takes it away.
    categories, names
        For which, and at which elements, sorted.
    """

    lost: Statement
    by: Statement
    categories: tuple[str, ...]
    names: tuple[str, ...]

    @property
    def role(self) -> str:
        """``source`` or ``leak``."""
        return self.lost.role

    @property
    def message(self) -> str:
        """What it says to a person, in one sentence."""
        more = f" and {len(self.names) - LISTED} more" if len(self.names) > LISTED else ""
        names = f"{', '.join(map(shown, self.names[:LISTED]))}{more}"
        what = f"the {self.role} of {', '.join(self.categories)} at {self.lost.place}"
        return f"{names}: {in_words(self.by)} takes away {what}"

    def diagnostic(self) -> Diagnostic:
        """Return the warning."""
        return Diagnostic(self.by.place, Severity.WARNING, self.message)

    def error(self) -> LabelError | None:
        """Return the error, where one file takes away what another says without a word of it."""
        files = self.lost.place.file != self.by.place.file and self.lost.rank[0] == self.by.rank[0] == USERS
        absent_by_name = self.by.method is Method.ABSENT and self.by.by_name
        says_so = absent_by_name or self.by.role in (self.role, NONE_OF[self.role])
        if not files or self.by.rank == self.lost.rank or says_so:
            return None
        hint = f"if this is meant, write '{self.role}: none' beside it, else correct one of them"
        return LabelError(self.by.place.file, self.by.place.line, self.message, hint)


def overruled(meaning: Mapping[int, Mapping[str, Facts]], elements: tuple[Element, ...]) -> tuple[Overruled, ...]:
    """Return what is taken away, in the order of files and lines.

    What elements outside ROS are taken to be is nobody's word, and an exception for a narrower kind in one file and
    of one name is no surprise: these are not told.

    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> from rosprivacy.analysis.kernel.roles import facts
    >>> from rosprivacy.analysis.model import Place, Statement
    >>> graph, _, hierarchy = factory()
    >>> leak = Statement("leak", ("Video",), (1, 0), Place("site.yaml", 3))
    >>> none = Statement("no-leak", ("Video",), (1, 1), Place("robot.yaml", 7))
    >>> meaning = {ARCHIVE: {"Video": facts("/archive", (leak, none), "Video", hierarchy)}}
    >>> [one.message for one in overruled(meaning, graph.elements)]
    ['/archive: leak: none takes away the leak of Video at site.yaml:3']
    """
    outdone: dict[tuple[Statement, Statement], tuple[set[str], set[str]]] = defaultdict(lambda: (set(), set()))
    for vertex, decided in meaning.items():
        for category, fact in decided.items():
            for lost, by in fact.outdone:
                if _counts(fact, lost, by):
                    categories, names = outdone[lost, by]
                    categories.add(category)
                    names.add(elements[vertex].name)
    together = (Overruled(*pair, tuple(sorted(c)), tuple(sorted(n))) for pair, (c, n) in outdone.items())
    return tuple(sorted(_merged(together), key=_order))


def _counts(fact: Facts, lost: Statement, by: Statement) -> bool:
    if lost.rank[0] <= STANDARD or (lost.rank == by.rank and lost.place.file == by.place.file):
        return False
    if lost.role == "leak":
        return not fact.leaks
    return not fact.emits or bool(fact.through and not set(lost.through or ("",)) <= set(fact.through))


def _merged(rows: Iterable[Overruled]) -> Iterable[Overruled]:
    """One for each two lines: a label that names several categories is several statements."""
    together: dict[tuple[object, ...], list[Overruled]] = defaultdict(list)
    for row in rows:
        together[row.role, row.lost.place, row.by.place, row.by.role].append(row)
    for some in together.values():
        categories = {name for row in some for name in row.categories}
        names = {name for row in some for name in row.names}
        first = min(some, key=lambda row: (row.lost.categories, row.by.categories))
        yield Overruled(first.lost, first.by, tuple(sorted(categories)), tuple(sorted(names)))


def _order(row: Overruled) -> tuple[object, ...]:
    by, lost = row.by.place, row.lost.place
    return (by.file, by.line, lost.file, lost.line, row.role, row.by.role)
