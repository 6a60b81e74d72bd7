"""Sources and leaks that one statement says and another takes away: that is never silent (rule S7).

In: what statements mean for each element. Out: ``Overruled``, for a warning and for what is assumed; and a warning
where a conduit stands beside one: it takes nothing away, and the warning says what to write if that is meant.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.kernel.ranks import NONE_OF, in_words
from rosprivacy.analysis.model import STANDARD, Diagnostic, Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.model import Element, Statement

LISTED = 3  # names in a message


class Overruled(NamedTuple):
    """A source or a leak that does not hold at some elements, since another statement outdoes it.

    Attributes
    ----------
    lost, by
        The statement, and the one that takes it away; of ``untouched`` a conduit, which does not.
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
        return self._sentence("takes away")

    def diagnostic(self) -> Diagnostic:
        """Return the warning."""
        return Diagnostic(self.by.place, Severity.WARNING, self.message)

    def _sentence(self, does: str) -> str:
        more = f" and {len(self.names) - LISTED} more" if len(self.names) > LISTED else ""
        names = f"{', '.join(map(shown, self.names[:LISTED]))}{more}"
        what = f"the {self.role} of {', '.join(self.categories)} at {self.lost.place}"
        return f"{names}: {in_words(self.by)} {does} {what}"

    def stays(self) -> Diagnostic:
        """Return the warning that a conduit takes nothing away, with what would."""
        above = self.by.rank > self.lost.rank
        write = f"write '{self.role}: none'" if above else f"name under {self.role} the other kinds only"
        message = f"{self._sentence('does not take away')}; if that is meant, {write}"
        return Diagnostic(self.by.place, Severity.WARNING, message)


def overruled(meaning: Mapping[int, Mapping[str, Facts]], elements: tuple[Element, ...]) -> tuple[Overruled, ...]:
    """Return what is taken away, in the order of files and lines.

    What elements outside ROS are taken to be is nobody's word, and an exception for a narrower kind in one file and
    of one name is no surprise: these are not told.

    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> from rosprivacy.analysis.kernel.roles import facts
    >>> from rosprivacy.analysis.model import Place, Statement
    >>> graph, _, hierarchy = factory()
    >>> leak = Statement("leak", ("Video",), (1, 0), Place("site.yaml", 3))
    >>> none = Statement("no-leak", (), (1, 1), Place("robot.yaml", 7))
    >>> meaning = {ARCHIVE: {"Video": facts("/archive", (leak, none), "Video", hierarchy)}}
    >>> [one.message for one in overruled(meaning, graph.elements)]
    ['/archive: leak: none takes away the leak of Video at site.yaml:3']
    """
    return _rows(meaning, elements, lambda fact: (pair for pair in fact.outdone if _counts(fact, *pair)))


def untouched(
    meaning: Mapping[int, Mapping[str, Facts]], elements: tuple[Element, ...], emitted: Iterable[str]
) -> Iterable[Diagnostic]:
    """Return a warning for each source and leak of what is emitted beside which a higher or nearer conduit stands.

    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> from rosprivacy.analysis.kernel.roles import facts
    >>> from rosprivacy.analysis.model import Place, Statement
    >>> graph, _, hierarchy = factory()
    >>> leak = Statement("leak", ("Video",), (1, 0), Place("site.yaml", 3))
    >>> conduit = Statement("conduit", (), (1, 1), Place("robot.yaml", 7))
    >>> meaning = {ARCHIVE: {"Video": facts("/archive", (leak, conduit), "Video", hierarchy)}}
    >>> for warning in untouched(meaning, graph.elements, ["Video"]):
    ...     print(warning.message)
    /archive: conduit does not take away the leak of Video at site.yaml:3; if that is meant, write 'leak: none'
    """
    kinds = set(emitted)
    of_these = {v: {kind: decided[kind] for kind in kinds & decided.keys()} for v, decided in meaning.items()}
    return (row.stays() for row in _rows(of_these, elements, _beside_conduits))


def _beside_conduits(fact: Facts) -> Iterable[tuple[Statement, Statement]]:
    conduits = fact.by_role("conduit")[:1]
    stand = [one for role in NONE_OF for one in fact.by_role(role) if one.rank[0] > STANDARD] if conduits else ()
    return ((one, conduit) for one in stand for conduit in conduits)


def _rows(
    meaning: Mapping[int, Mapping[str, Facts]], elements: tuple[Element, ...],
    pairs: Callable[[Facts], Iterable[tuple[Statement, Statement]]],
) -> tuple[Overruled, ...]:  # fmt: skip
    """One for each two lines, in the order of files and lines."""
    by_pair: dict[tuple[Statement, Statement], tuple[set[str], set[str]]] = defaultdict(lambda: (set(), set()))
    for vertex, decided in meaning.items():
        for category, fact in decided.items():
            for pair in pairs(fact):
                categories, names = by_pair[pair]
                categories.add(category)
                names.add(elements[vertex].name)
    together = (Overruled(*pair, tuple(sorted(c)), tuple(sorted(n))) for pair, (c, n) in by_pair.items())
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
