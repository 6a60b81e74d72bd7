"""Which of several statements about one element hold for a category (rules S7, S13).

In: statements, a category, the hierarchy. Out: ``Decided``.

Of statements that contradict each other the higher rank wins, then the one nearer in the hierarchy. ``mundane``,
``sensitive``, ``only`` and ``never`` are of one kind in this: each lets a category pass or stops it. A leak
is never outdone by a statement about a broader or an overlapping category, and the standard channels' file is not
outdone by a glob of the user's whose last segment is not written out. Equals that contradict are an error.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.model import CANNOT, GLOB, STANDARD, Method
from rosprivacy.analysis.text import printable

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Statement

MAY = frozenset({"leak", "derivation", "only"})
LETS_THROUGH = frozenset({"conduit", "sensitive", "only"})
FARTHEST = 1_000_000  # the distance of a statement about every category
OF_CHANNELS = frozenset({"mundane", "sensitive", "only", "never", CANNOT})
OF_EVERY_KIND = frozenset({"mundane", "sensitive", "only"})  # two of these at one rank contradict for every category
OPPOSED = frozenset(
    frozenset(pair)
    for pair in (
        ("source", "sanitizer"),  # rule S10
        ("source", "conduit"),  # the paper, II-A: a conduit introduces no personal data
        ("leak", "conduit"),  # … and relays none to the outside
        ("sanitizer", "conduit"),
        ("source", "no-source"),
        ("leak", "no-leak"),
    )
)
# What is not on the robot does nothing: a label of higher rank that says it does makes it be there (rule S7).
OPPOSED_TO_ABSENT = frozenset(frozenset(("sanitizer", role)) for role in ("leak", "derivation"))
NONE_OF = {"source": "no-source", "leak": "no-leak"}  # role -> what takes it back by name

Rank = tuple[int, int, int]


class Decided(NamedTuple):
    """The statements that hold, the highest rank first; and those of sources and leaks that do not, with what won."""

    accepted: tuple[Statement, ...]
    outdone: tuple[tuple[Statement, Statement], ...]


def decided(name: str, said: Sequence[Statement], category: str, hierarchy: Hierarchy) -> Decided:
    """Return which statements about an element hold for a category.

    Raises
    ------
    LabelError
        If two statements of equal rank contradict each other; the message names both lines.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.model import Place, Statement
    >>> leak = Statement("leak", ("Video",), (1, 0), Place("labels.yaml", 3), naming=GLOB)
    >>> none = Statement("no-leak", ("Video",), (1, 1), Place("labels.yaml", 7))
    >>> holding = decided("/archive", (leak, none), "Video", factory()[2])
    >>> [statement.role for statement in holding.accepted], [lost.role for lost, _ in holding.outdone]
    (['no-leak'], ['leak'])
    """
    ranked = [
        ((*statement.rank, -distance), statement)
        for statement in said
        if (distance := _distance(statement, category, hierarchy)) is not None
        and (statement.seen(category) or _lets_through(statement, category, hierarchy))
    ]
    if len(ranked) < 2:  # noqa: PLR2004 - nothing to weigh
        return Decided(_seen((statement for _, statement in ranked), category), ())
    ranked.sort(key=lambda pair: (pair[0], str(pair[1].place)), reverse=True)
    accepted: list[Statement] = []
    outdone: list[tuple[Statement, Statement]] = []
    for rank, statement in ranked:
        against = [(r, s) for r, s in ranked if _opposed(s, statement, category, hierarchy)]
        for other_rank, other in against:
            if _clash(rank, statement, other_rank, other, hierarchy):
                raise _contradiction(name, category, other, statement)
        winners = [s for r, s in against if _outdoes(r, s, rank, statement, hierarchy)]
        if not winners:
            accepted.append(statement)
        elif statement.role in NONE_OF:
            outdone.append((statement, _decisive(statement, winners)))
    _check_derivations(name, category, accepted)
    return Decided(_seen(accepted, category), tuple(sorted(outdone, key=lambda pair: by_line(pair[0]))))


def _seen(accepted: Iterable[Statement], category: str) -> tuple[Statement, ...]:
    """What holds, but for what nobody has seen: that reviews nothing, and only let through what lower ranks close."""
    return tuple(statement.line for statement in accepted if statement.seen(category))


def _lets_through(statement: Statement, category: str, hierarchy: Hierarchy) -> bool:
    return statement.role in LETS_THROUGH and not closes(statement, category, hierarchy)


def applies(statement: Statement, category: str, hierarchy: Hierarchy) -> bool:
    """Return whether a statement says anything of a category: what says nothing of it decides nothing for it.

    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> _, bound, hierarchy = factory()
    >>> (source,) = bound.elements[CAMERA]  # source: [Video]
    >>> applies(source, "Video", hierarchy), applies(source, "FaceTemplate", hierarchy)
    (True, False)
    """
    if statement.role in ("source", CANNOT):
        return not statement.categories or category in statement.categories
    if statement.role == "only" or not statement.categories:
        return True
    near = hierarchy.overlaps if statement.role in MAY else hierarchy.ancestors
    return not near[category].keys().isdisjoint(statement.categories)


def closes(statement: Statement, category: str, hierarchy: Hierarchy) -> bool:
    """Return whether a statement about a channel or a flow says that it does not carry a category.

    >>> from rosprivacy.analysis.example import FACES, factory
    >>> _, bound, hierarchy = factory()
    >>> (only,) = bound.elements[FACES]  # only: [FaceTemplate]
    >>> closes(only, "Video", hierarchy), closes(only, "FaceTemplate", hierarchy)
    (True, False)
    """
    if statement.role == "only":
        return _named_distance(statement, category, hierarchy) is None
    if statement.role == CANNOT:
        return category in statement.categories
    return statement.role == "mundane" or (
        statement.role == "never" and _named_distance(statement, category, hierarchy) is not None
    )


def by_line(statement: Statement) -> tuple[str, int, str]:
    """Return the key by which statements stand in the order of files and lines.

    >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, factory
    >>> _, bound, _ = factory()
    >>> said = (*bound.elements[CAMERA], *bound.elements[ARCHIVE])
    >>> [(str(statement.place), statement.role) for statement in sorted(said, key=by_line)]
    [('labels.yaml:1', 'leak'), ('labels.yaml:2', 'source')]
    """
    return (statement.place.file, statement.place.line, statement.role)


def in_words(statement: Statement) -> str:
    """Return what a statement says, in the words of label files.

    >>> from rosprivacy.analysis.example import FACE_ID, FACES, FILTER, factory
    >>> _, bound, _ = factory()
    >>> [in_words(*bound.elements[vertex]) for vertex in (FACE_ID, FILTER, FACES)]
    ['derives FaceTemplate from Video', 'sanitizer (pseudonymise)', 'only [FaceTemplate]']
    """
    if statement.role in NONE_OF.values():
        return f"{statement.role.removeprefix('no-')}: none"
    if statement.role == "sanitizer":
        return "absent" if statement.method is Method.ABSENT else f"sanitizer ({statement.method})"
    if statement.role in ("only", "never", CANNOT):
        return f"{statement.role} [{', '.join(statement.categories)}]"
    if statement.role == "derivation":
        return f"derives {statement.to} from {', '.join(statement.categories)}"
    return f"{statement.role} through {', '.join(statement.through)}" if statement.through else statement.role


def _distance(statement: Statement, category: str, hierarchy: Hierarchy) -> int | None:
    """How far the statement's category is; None if it does not apply; negative if it is narrower or overlaps."""
    if not statement.categories:
        return FARTHEST
    if statement.role in ("source", CANNOT):
        return 0 if category in statement.categories else None
    distance = _named_distance(statement, category, hierarchy)
    return FARTHEST if distance is None and statement.role == "only" else distance


def _named_distance(statement: Statement, category: str, hierarchy: Hierarchy) -> int | None:
    above, near = hierarchy.ancestors[category], hierarchy.overlaps[category]
    broader = [above[named] for named in statement.categories if named in above]
    if broader or statement.role not in MAY:
        return min(broader, default=None)
    common = [near[named] for named in statement.categories if named in near]
    return -min(common) if common else None


def _opposed(a: Statement, b: Statement, category: str, hierarchy: Hierarchy) -> bool:
    """Whether two statements cannot both hold for a category."""
    if a.role in OF_CHANNELS:
        whole = {a.role, b.role} <= OF_EVERY_KIND and a.rank == b.rank
        differ = a.role != b.role or set(a.categories) != set(b.categories)
        return closes(a, category, hierarchy) != closes(b, category, hierarchy) or (whole and differ)
    if a.role != b.role:
        absent = Method.ABSENT in (a.method, b.method)
        return frozenset((a.role, b.role)) in (OPPOSED | OPPOSED_TO_ABSENT if absent else OPPOSED)
    if a.role == "sanitizer":
        return a.method != b.method
    return a.role == "source" and a.through != b.through


def _outdoes(rank: Rank, statement: Statement, other_rank: Rank, other: Statement, hierarchy: Hierarchy) -> bool:
    """Whether the first statement outdoes the other."""
    if _too_broad(statement, other, hierarchy) or (_standard(other) and _open_ended(statement)):
        return False
    return (_standard(statement) and _open_ended(other)) or rank > other_rank


def _clash(rank: Rank, statement: Statement, other_rank: Rank, other: Statement, hierarchy: Hierarchy) -> bool:
    """Whether neither of two that are opposed outdoes the other."""
    either = _too_broad(statement, other, hierarchy) or _too_broad(other, statement, hierarchy)
    whole = {statement.role, other.role} <= OF_EVERY_KIND and statement.rank == other.rank
    return whole or (rank == other_rank and not either)


def _too_broad(one: Statement, leak: Statement, hierarchy: Hierarchy) -> bool:
    """Whether a statement is about more than a leak is about: then it never outdoes it, whatever the ranks."""
    named = leak.categories if leak.role == "leak" else ()
    return any(hierarchy.distance(a, name) is None for name in named for a in one.categories)


def _decisive(lost: Statement, winners: Sequence[Statement]) -> Statement:
    """Of those that outdo a statement, the one to name: what says so by name, then the highest not beside it."""

    def beside(winner: Statement) -> bool:
        return winner.rank == lost.rank and winner.place.file == lost.place.file

    return min(winners, key=lambda winner: (winner.role != NONE_OF[lost.role], beside(winner)))


def _standard(statement: Statement) -> bool:
    return statement.shipped and statement.rank[0] == STANDARD


def _open_ended(statement: Statement) -> bool:
    """Whether a user says it by a glob whose last segment is not written out (rule S13)."""
    return statement.rank[0] > STANDARD and statement.naming == GLOB


def _check_derivations(name: str, category: str, accepted: Sequence[Statement]) -> None:
    """Refuse a node that ends a category and makes it again of what it ends (rule S7)."""
    ends = [s for s in accepted if s.role == "sanitizer" and s.method is not None and s.method.ends]
    for made in accepted:
        if made.role == "derivation" and made.to == category and ends:
            raise _contradiction(name, category, ends[0], made)


def _contradiction(name: str, category: str, a: Statement, b: Statement) -> LabelError:
    first, second = sorted((a, b), key=lambda s: (s.place.file, s.place.line))
    every = not first.categories and not second.categories
    every = every or {first.role, second.role} <= OF_EVERY_KIND
    about = "every category" if every else category
    what = (
        f"{shown(name)} is {in_words(second)} for {about} here and {in_words(first)} at {printable(str(first.place))}"
    )
    return LabelError(second.place.file, second.place.line, what, "keep one of them, or make one more specific")
