"""About which robots of a fleet a person can decide: a finding in, out come the robots to choose from, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.explorer.web.whose import robots_told

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.explorer.decision_scope import Scope
    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.forms import Form
    from rosprivacy.report.catalogs.words import Words

NAMED = 100  # robots whose names are told
OFFERED = 40  # choices on a page
ONE = ":one"  # behind the id of a finding: of its robot only


class Choice(NamedTuple):
    """Robots that can be chosen.

    Attributes
    ----------
    value
        As a form says it.
    told
        How many they are, of which model, what is decided already, and in what their path is not the one shown.
    names
        Which they are; empty for one.
    chosen
        Whether they are, as long as a person says nothing else.
    """

    value: str
    told: str
    names: str
    chosen: bool


class Choices(NamedTuple):
    """Those that a page offers; none where a finding is on no robot of a fleet.

    Attributes
    ----------
    more
        How many are not offered.
    """

    offered: tuple[Choice, ...] = ()
    more: int = 0


def choices(session: Session, finding: Finding, words: Words) -> Choices:
    """Return what can be chosen, what is not decided yet first."""
    there = list(_values(session, finding).items())
    there.sort(key=lambda one: _decided(session, one[1], words) != "")
    offered = tuple(
        Choice(
            value,
            " – ".join([scope_told(session, scope, words), *_beside(session, finding, scope, words)]),
            _names(scope, words),
            number == 0,
        )
        for number, (value, scope) in enumerate(there[:OFFERED])
    )
    return Choices(offered, len(there) - len(offered))


def chosen_in(form: Form, session: Session, finding: Finding) -> Scope:
    """Return the robots that a form names; where there are some, it has to name them.

    Raises
    ------
    FormError
        If it names others.
    """
    there = _values(session, finding)
    return there[form.choice("whose", there)] if there else session.scopes(finding)[0]


def scope_told(session: Session, scope: Scope, words: Words) -> str:
    """Return in words about which robots something is decided; empty for none."""
    if scope.to_robots:
        begins, ends = (_end(session, robots, words) for robots in (scope.robots, scope.to_robots))
        return words("x.decide.across", source=begins, leak=ends)
    return robots_told(session, scope.robots, words) if scope.robots else ""


def _end(session: Session, robots: Sequence[str], words: Words) -> str:
    if len(robots) == 1:
        return shown(robots[0])
    model = session.model_of(robots[0])
    return words("x.whose.robots", n=len(robots)) + (f" ({shown(model)})" if model else "")


def _values(session: Session, finding: Finding) -> Mapping[str, Scope]:
    """What a form can say."""
    found: dict[str, Scope] = {}
    for scope in session.scopes(finding):
        if scope.robots:
            found[scope.finding.id] = scope
            if scope.alone != scope:
                found[scope.finding.id + ONE] = scope.alone
    return found


def _decided(session: Session, scope: Scope, words: Words) -> str:
    decided = session.uncounted.decided
    valid = decided.valid(scope.finding) if decided else None
    return words(f"d.{valid.choice}") if valid else ""


def _beside(session: Session, finding: Finding, scope: Scope, words: Words) -> Iterator[str]:
    """What a person has to know of the robots of a choice, besides how many they are."""
    if decided := _decided(session, scope, words):
        yield decided
    other = scope.finding
    if other.pseudonymised != finding.pseudonymised:
        yield words(f"x.finding.form.{'reduced' if other.pseudonymised else 'plain'}")
    path = [element.name for element in other.witness]
    if path != [element.name for element in finding.witness]:
        yield words("x.decide.other", path=" → ".join(map(shown, path)))


def _names(scope: Scope, words: Words) -> str:
    return "; ".join(words.row(_first(some, words)) for some in (scope.robots, scope.to_robots) if len(some) > 1)


def _first(robots: Sequence[str], words: Words) -> Sequence[str]:
    return words.first([shown(robot) for robot in robots], NAMED)
