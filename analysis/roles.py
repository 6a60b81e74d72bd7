"""Statements -> what one element does with one category (rules S7, S8).

In: the statements about an element, an emitted category, the hierarchy. Out: ``Facts``.

A source names what it emits. A leak, a derivation and ``only`` apply if they name the same, a broader or a narrower
category (*may*: what is emitted may be any narrower kind); a sanitizer, a conduit, ``mundane``, ``sensitive`` and
``never`` if they name the same or a broader one (*must*). Of statements that contradict each other the higher rank
wins, then the one nearer in the hierarchy; a leak of a narrower kind is never outdone by a statement about a broader
one. Equals that contradict are an error.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.model import Method

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Statement

MAY = frozenset({"leak", "derivation", "only"})
ADDS = frozenset({"source", "leak"})  # what they say takes nothing away
FARTHEST = 1_000_000  # the distance of a statement about every category, and so of every ``only``

CONTRADICTIONS = frozenset(
    frozenset(pair)
    for pair in (
        ("source", "sanitizer"),  # rule S10
        ("source", "conduit"),  # the paper, II-A: a conduit introduces no personal data
        ("leak", "conduit"),  # … and relays none to the outside
        ("sanitizer", "conduit"),
        ("mundane", "sensitive"),
        ("mundane", "only"),
        ("sensitive", "only"),
        ("sensitive", "never"),
    )
)

Rank = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class Facts:
    """What an element or a flow does with one category.

    Attributes
    ----------
    emits
        Whether it is a source; ``through`` are then name expressions of the channels, empty for all.
    leaks
        Whether it lets the category out.
    passes
        Whether data of the category that comes in goes out again as it is.
    pseudonymises
        Whether what comes in goes out pseudonymised.
    derives
        Categories that it makes of this one, sorted.
    covered
        Whether a label covers the category here (rule S11).
    method
        Of a sanitizer, as in ``Method``; empty for others.
    closers
        The statements that keep the category from going on as it is, in the order of files and lines.
    outdone
        (A source or leak statement, the one that outdid it): what was said and does not hold.
    reviewers
        The other statements that answer for the category here: without them it is open, if nothing else covers it.
    unstated
        Whether it is a sanitizer whose method is taken, not stated.
    standard
        Whether only a shipped file says that it carries nothing.
    roles
        Names of the roles that hold, sorted.
    """

    emits: bool = False
    through: tuple[str, ...] = ()
    leaks: bool = False
    passes: bool = True
    pseudonymises: bool = False
    derives: tuple[str, ...] = ()
    covered: bool = False
    unstated: bool = False
    standard: bool = False
    roles: tuple[str, ...] = ()
    method: str = ""
    closers: tuple[Statement, ...] = ()
    outdone: tuple[tuple[Statement, Statement], ...] = ()
    reviewers: tuple[Statement, ...] = ()


NOTHING_SAID = Facts()


def facts(name: str, said: Sequence[Statement], category: str, hierarchy: Hierarchy) -> Facts:
    """Decide what holds of an element or flow for one category.

    Parameters
    ----------
    name
        Of the element, for messages.
    said
        All statements about it.

    Raises
    ------
    LabelError
        If two statements of equal rank contradict each other; the message names both lines.
    """
    return _sum_up(*_accepted(name, said, category, hierarchy), category, hierarchy)


def _distance(statement: Statement, category: str, hierarchy: Hierarchy) -> int | None:
    """How far the statement's category is; None if it does not apply; negative if it is narrower."""
    if not statement.categories:
        return FARTHEST
    if statement.role == "source":
        return 0 if category in statement.categories else None
    up = [hierarchy.distance(category, named) for named in statement.categories]
    down = [hierarchy.distance(named, category) for named in statement.categories]
    broader = [d for d in up if d is not None]
    if broader:
        return min(broader)
    narrower = [d for d in down if d is not None]
    return -min(narrower) if narrower and statement.role in MAY else None


def _accepted(
    name: str, said: Sequence[Statement], category: str, hierarchy: Hierarchy
) -> tuple[list[Statement], list[tuple[Statement, Statement]]]:
    """The statements that apply and are not outdone, and those of sources and leaks that are, with what outdid them."""
    applying: list[tuple[Rank, Statement]] = []
    for statement in said:
        distance = FARTHEST if statement.role == "only" else _distance(statement, category, hierarchy)
        if distance is not None:
            applying.append(((*statement.rank, -distance), statement))
    accepted: list[Statement] = []
    outdone: list[tuple[Statement, Statement]] = []
    for rank, statement in sorted(applying, key=lambda pair: (pair[0], str(pair[1].place)), reverse=True):
        against = [(r, other) for r, other in applying if r >= rank and _contradict(other, statement)]
        for other_rank, other in against:
            if other_rank == rank:
                raise _contradiction(name, category, other, statement)
        if not against:
            accepted.append(statement)
        elif statement.role in ("source", "leak"):
            outdone.append((statement, max(against, key=lambda pair: pair[0])[1]))
    return accepted, outdone


def _by_line(statement: Statement) -> tuple[str, int, str]:
    return (statement.place.file, statement.place.line, statement.role)


def _contradict(a: Statement, b: Statement) -> bool:
    if a.role != b.role:
        return frozenset((a.role, b.role)) in CONTRADICTIONS
    if a.role == "sanitizer":
        return a.method != b.method
    if a.role == "source":
        return a.through != b.through
    return a.role == "only" and set(a.categories) != set(b.categories)


def _contradiction(name: str, category: str, a: Statement, b: Statement) -> LabelError:
    first, second = sorted((a, b), key=lambda s: (s.place.file, s.place.line))
    every = not first.categories and not second.categories
    every = every or {first.role, second.role} <= {"mundane", "sensitive", "only"}
    about = "every category" if every else category
    what = f"{shown(name)} is {_said(second)} for {about} here and {_said(first)} at {first.place}"
    return LabelError(second.place.file, second.place.line, what, "keep one of them, or make one more specific")


def _said(statement: Statement) -> str:
    if statement.role == "sanitizer":
        return f"sanitizer ({statement.method})"
    if statement.role in ("only", "never"):
        return f"{statement.role} [{', '.join(statement.categories)}]"
    return f"{statement.role} through {', '.join(statement.through)}" if statement.through else statement.role


def _sum_up(
    accepted: list[Statement], outdone: list[tuple[Statement, Statement]], category: str, hierarchy: Hierarchy
) -> Facts:
    by_role = {role: [s for s in accepted if s.role == role] for role in {s.role for s in accepted}}
    sanitizers = by_role.get("sanitizer", [])
    mundane = by_role.get("mundane", [])
    closers = [*sanitizers, *mundane, *by_role.get("never", [])]
    closers += [only for only in by_role.get("only", []) if _distance(only, category, hierarchy) is None]
    sources = by_role.get("source", [])
    return Facts(
        emits=bool(sources),
        through=sources[0].through if sources else (),
        leaks="leak" in by_role,
        passes=not closers,
        pseudonymises=any(s.method is Method.PSEUDONYMISE for s in sanitizers),
        derives=tuple(sorted({s.to for s in by_role.get("derivation", [])})),
        covered=bool(accepted),
        unstated=any(not s.stated for s in sanitizers),
        standard=bool(mundane) and all(s.shipped for s in mundane),
        roles=tuple(sorted(by_role)),
        method=str(sanitizers[0].method) if sanitizers else "",
        closers=tuple(sorted(closers, key=_by_line)),
        outdone=tuple(sorted(outdone, key=lambda pair: _by_line(pair[0]))),
        reviewers=tuple(sorted((s for s in accepted if s not in closers and s.role not in ADDS), key=_by_line)),
    )
