"""Statements -> what one element does with one category (rules S7, S8).

In: the statements about an element, an emitted category, the hierarchy. Out: ``Facts``.

A source names what it emits. A leak, a derivation and ``only`` apply if what they name has a common same-or-narrower
category with what is emitted (*may*: what is emitted may be any narrower kind); a sanitizer, a conduit, ``mundane``,
``sensitive`` and ``never`` if they name the same or a broader one (*must*). Which of them hold is decided in
``ranks.py``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.kernel.ranks import by_line, closes, decided
from rosprivacy.analysis.model import BY_TYPE, CANNOT, Method

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.ranks import RankedStatements
    from rosprivacy.analysis.model import Statement

TAKE_BACK = ("no-source", "no-leak")  # they hold, but review nothing
ADDS = frozenset({"source", "leak", *TAKE_BACK})  # what they say stops no data


class Facts(NamedTuple):
    """What an element or a flow does with one category.

    Attributes
    ----------
    emits
        Whether it is a source; ``through`` are then name expressions of the channels, empty for all. They are empty too
        where the code of a source has changed: it may send the category anywhere now.
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
        Of a sanitizer, as in ``Method``, and of what is absent; empty for others.
    accepted
        The statements that hold, the highest rank first.
    closers
        Those of them that keep the category from going on as it is, in the order of files and lines.
    outdone
        (A source or leak statement, the one that outdid it): what was said and does not hold.
    reviewers
        The other statements that answer for the category here: without them it is open, if nothing else covers it.
    unstated
        Whether it is a sanitizer whose method is taken: the statement that decides does not state it.
    standard
        Whether only a shipped file says that it carries nothing.
    limited
        Whether it does not pass only since its type cannot carry the category: nobody has reviewed it (rule S15).
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
    limited: bool = False
    roles: tuple[str, ...] = ()
    method: str = ""
    accepted: tuple[Statement, ...] = ()
    closers: tuple[Statement, ...] = ()
    outdone: tuple[tuple[Statement, Statement], ...] = ()
    reviewers: tuple[Statement, ...] = ()

    def by_role(self, role: str) -> tuple[Statement, ...]:
        """Return the statements of a role that hold, the highest rank first."""
        return tuple(statement for statement in self.accepted if statement.role == role)


NOTHING_SAID = Facts()


def facts(name: str, statements: Sequence[Statement], category: str, hierarchy: Hierarchy) -> Facts:
    """Decide what holds of an element or flow for one category.

    Parameters
    ----------
    name
        Of the element, for messages.
    statements
        All statements about it.

    Raises
    ------
    LabelError
        If two statements of equal rank contradict each other; the message names both lines.

    Examples
    --------
    >>> from rosprivacy.analysis.example import FILTER, factory
    >>> _, bound, hierarchy = factory()
    >>> cleaning = facts("/filter", bound.elements[FILTER], "Video", hierarchy)
    >>> cleaning.roles, cleaning.passes, cleaning.pseudonymises
    (('sanitizer',), False, True)
    """
    return _sum_up(decided(name, statements, category, hierarchy), category, hierarchy)


def _sum_up(decided: RankedStatements, category: str, hierarchy: Hierarchy) -> Facts:
    accepted = decided.accepted
    by_role = {role: [s for s in accepted if s.role == role] for role in {s.role for s in accepted}}
    sanitizers = by_role.get("sanitizer", [])
    mundane = by_role.get("mundane", [])
    closers = [*sanitizers, *(s for s in accepted if closes(s, category, hierarchy))]
    sources = by_role.get("source", [])
    method = str(sanitizers[0].method) if sanitizers else ""
    counting = [s for s in accepted if s.counts_for(category)]
    none = {*TAKE_BACK, CANNOT, *(["sanitizer"] if method == Method.ABSENT else [])}  # what is not there cleans nothing
    roles = sorted({"only" if role == BY_TYPE else role for role in by_role if role not in none})
    return Facts(
        emits=bool(sources),
        through=sources[0].through if sources and sources[0].counts_for(category) else (),
        leaks="leak" in by_role,
        passes=not closers,
        pseudonymises=any(s.method is Method.PSEUDONYMISE for s in sanitizers),
        derives=tuple(sorted({s.to for s in by_role.get("derivation", [])})),
        covered=bool(sanitizers) or any(s.role not in none for s in counting),
        unstated=bool(sanitizers) and not sanitizers[0].stated,
        standard=bool(mundane) and all(s.shipped for s in mundane),
        limited=bool(closers) and all(s.role == CANNOT for s in closers),
        roles=tuple(roles),
        method=method,
        accepted=accepted,
        closers=tuple(sorted(closers, key=by_line)),
        outdone=decided.outdone,
        reviewers=tuple(sorted((s for s in counting if s not in closers and s.role not in ADDS), key=by_line)),
    )
