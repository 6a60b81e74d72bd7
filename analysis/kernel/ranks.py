"""Which of several statements about one element hold for a category (rules S7, S13).

In: statements, a category, the hierarchy. Out: ``RankedStatements``.

Of statements that contradict each other the higher rank wins, then the one nearer in the hierarchy. ``mundane``,
``sensitive``, ``only`` and ``never`` are of one kind in this: each lets a category pass or stops it. A source and a
leak are taken away by ``none`` of a higher rank, or with the whole node by ``absent``, and by nothing else. The
standard channels' file is not outdone by a glob of the user's whose last segment is not written out. Equals that
contradict are an error, and so is a sanitizer of what the node itself brings in.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.model import BY_TYPE, CANNOT, GLOB, STANDARD, TYPE_LINE, Method
from rosprivacy.analysis.text import printable

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Statement

MAY = frozenset({"leak", "derivation", "only"})
LETS_THROUGH = frozenset({"conduit", "sensitive", "only"})
FARTHEST = 1_000_000  # the distance of a statement about every category
OF_CHANNELS = frozenset({"mundane", "sensitive", "only", "never", CANNOT, BY_TYPE})
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
NONE_OF = {"source": "no-source", "leak": "no-leak"}  # role -> what takes it back
COEXISTING = frozenset(
    {("conduit", "source"), ("conduit", "leak"), ("sanitizer", "source")}
)  # not taken away by the first

Rank = tuple[int, int, int]


class RankedStatements(NamedTuple):
    """The statements that hold, the highest rank first; and those of sources and leaks that do not, with what won."""

    accepted: tuple[Statement, ...]
    outdone: tuple[tuple[Statement, Statement], ...]


def decided(name: str, statements: Sequence[Statement], category: str, hierarchy: Hierarchy) -> RankedStatements:
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
    >>> none = Statement("no-leak", (), (1, 1), Place("labels.yaml", 7))
    >>> holding = decided("/archive", (leak, none), "Video", factory()[2])
    >>> [statement.role for statement in holding.accepted], [lost.role for lost, _ in holding.outdone]
    (['no-leak'], ['leak'])
    """
    ranked = [
        ((*statement.rank, -distance), statement)
        for statement in statements
        if (distance := _distance(statement, category, hierarchy)) is not None
        and (statement.counts_for(category) or statement.adds or _lets_through(statement, category, hierarchy))
    ]
    if len(ranked) < 2:  # noqa: PLR2004 - nothing to weigh
        return RankedStatements(_observed((statement for _, statement in ranked), category), ())
    ranked.sort(key=lambda pair: (pair[0], str(pair[1].place)), reverse=True)
    accepted: list[Statement] = []
    outdone: list[tuple[Statement, Statement]] = []
    for rank, statement in ranked:
        against = [(r, s) for r, s in ranked if _opposed(s, statement, category, hierarchy)]
        for other_rank, other in against:
            if statement.rank == other.rank and _clash(-rank[2], statement, -other_rank[2], other, category):
                raise _contradiction(name, category, other, statement)
        winners = [s for r, s in against if _outdoes(r, s, rank, statement)]
        if not winners:
            accepted.append(statement)
        elif statement.role in NONE_OF:
            outdone.append((statement, _decisive(statement, winners)))
    _check_sanitizers(name, category, accepted)
    return RankedStatements(_observed(accepted, category), tuple(sorted(outdone, key=lambda pair: by_line(pair[0]))))


def _observed(accepted: Iterable[Statement], category: str) -> tuple[Statement, ...]:
    """What holds, but for what nobody has seen: that reviews nothing, and only let through what lower ranks close.

    What adds data holds all the same, and reviews nothing either.
    """
    seen = ((statement, statement.counts_for(category)) for statement in accepted)
    return tuple(statement.line if counts else statement for statement, counts in seen if counts or statement.adds)


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
    if statement.role == TYPE_LINE:
        return False
    if statement.role in ("only", BY_TYPE) or not statement.categories:
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
    if statement.role in (CANNOT, BY_TYPE):
        return category in statement.categories
    return statement.role in ("mundane", "never") and _distance(statement, category, hierarchy) is not None


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
        kinds = f"{{none: [{', '.join(statement.categories)}]}}" if statement.categories else "none"
        return f"{statement.role.removeprefix('no-')}: {kinds}"
    if statement.role in (BY_TYPE, TYPE_LINE):
        return "only: by-type"
    if statement.role == "sanitizer":
        return "absent" if statement.method is Method.ABSENT else f"sanitizer ({statement.method})"
    if statement.role in ("only", "never", CANNOT):
        return f"{statement.role} [{', '.join(statement.categories)}]"
    if statement.role == "derivation":
        return f"derives {statement.to} from {', '.join(statement.categories)}"
    return f"{statement.role} through {', '.join(statement.through)}" if statement.through else statement.role


def _distance(statement: Statement, category: str, hierarchy: Hierarchy) -> int | None:
    """How far the statement's category is; None if it does not apply; negative if it is narrower or overlaps."""
    if statement.role == TYPE_LINE:
        return None
    if statement.role == BY_TYPE:
        return 0 if category in statement.categories else FARTHEST
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
        two = a.role == b.role == "only" and a.rank == b.rank and set(a.categories) != set(b.categories)
        return two or closes(a, category, hierarchy) != closes(b, category, hierarchy)
    if a.role != b.role:
        absent = Method.ABSENT in (a.method, b.method)
        return frozenset((a.role, b.role)) in (OPPOSED | OPPOSED_TO_ABSENT if absent else OPPOSED)
    if a.role == "sanitizer":
        return a.method != b.method
    return a.role == "source" and a.through != b.through


def _outdoes(rank: Rank, statement: Statement, other_rank: Rank, other: Statement) -> bool:
    """Whether the first statement outdoes the other."""
    pair = (statement.role, other.role)
    if pair in COEXISTING and statement.method is not Method.ABSENT and other.rank[0] >= STANDARD:
        return False  # below are leaks that the sort of an element implies: a conduit takes these back
    if statement.role == NONE_OF.get(other.role):
        return statement.rank > other.rank
    if _standard(other) and _open_ended(statement):
        return False
    lets = pair == ("only", "never") and rank == other_rank  # a tie lets through
    return lets or rank > other_rank or (_standard(statement) and _open_ended(other))


def _clash(near: int, a: Statement, opponent: int, b: Statement, category: str) -> bool:
    """Whether two of one rank that are opposed, at these distances, are an error."""
    by_role = {a.role: (a, near), b.role: (b, opponent)}
    if by_role.keys() <= OF_EVERY_KIND:
        return True
    if by_role.keys() == {"only", "never"}:
        return category in by_role["only"][0].categories
    if by_role.keys() == {"leak", "conduit"}:
        return a.categories == b.categories
    for role, none in NONE_OF.items():
        if by_role.keys() == {role, none}:
            return by_role[none][1] <= by_role[role][1]
    return near == opponent


def _decisive(lost: Statement, winners: Sequence[Statement]) -> Statement:
    """Of those that outdo a statement, the one to name: what says so by name, then the highest not beside it."""

    def is_weaker(winner: Statement) -> bool:
        return winner.rank == lost.rank and winner.place.file == lost.place.file

    return min(winners, key=lambda winner: (winner.role != NONE_OF[lost.role], is_weaker(winner)))


def _standard(statement: Statement) -> bool:
    return statement.shipped and statement.rank[0] == STANDARD


def _open_ended(statement: Statement) -> bool:
    """Whether a user says it by a glob whose last segment is not written out (rule S13)."""
    return statement.rank[0] > STANDARD and statement.naming == GLOB


def _check_sanitizers(name: str, category: str, accepted: Sequence[Statement]) -> None:
    """Refuse a node that cleans what it brings in (S10), and one that makes a category again of what it ends (S7)."""
    cleans = [s for s in accepted if s.role == "sanitizer" and s.method not in (None, Method.ABSENT)]
    ends = [s for s in cleans if s.method is not None and s.method.ends]
    for other in accepted if cleans else ():
        if other.role == "source":
            hint = "keep one of them; 'source: none' takes a source back"
            raise _contradiction(name, category, cleans[0], other, hint)
        if other.role == "derivation" and other.to == category and ends:
            raise _contradiction(name, category, ends[0], other)


def _contradiction(
    name: str, category: str, a: Statement, b: Statement, hint: str = "keep one of them, or make one more specific"
) -> LabelError:
    first, second = sorted((a, b), key=lambda s: (s.place.file, s.place.line))
    every = not first.categories and not second.categories
    every = every or {first.role, second.role} <= OF_EVERY_KIND
    about = "every category" if every else category
    what = (
        f"{shown(name)} is {in_words(second)} for {about} here and {in_words(first)} at {printable(str(first.place))}"
    )
    return LabelError(second.place.file, second.place.line, what, hint)
