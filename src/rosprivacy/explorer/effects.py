"""What an edit does: what differs between two answers of a session.

In: two results. Out: ``Difference``; with the edit that is between them ``Change``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.answer import Verdict
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.fleet.patterns import FleetView
    from rosprivacy.explorer.edits import Edit
    from rosprivacy.result import Result

OPENED, CLOSED, PLAINER = "opened", "closed", "plainer"


class Difference(NamedTuple):
    """What is so in one answer and not in another.

    Attributes
    ----------
    before, verdict
        The verdicts.
    opened, closed
        Ids of the findings that stand in the second one only, and in the first one only; of a fleet those that the
        answer shows for robots on which they do.
    newly_open, no_longer_open
        How many elements are open in the second one only, and in the first one only; of a fleet on all robots.
    plainer
        Ids of the findings that stand in both, and are pseudonymised in the first one only.
    robots
        Of a fleet: ``OPENED``, ``CLOSED`` or ``PLAINER`` and the id of a finding -> on which robots it is so: where it
        begins, or where it ends if that is on no robot.
    """

    before: Verdict
    verdict: Verdict
    opened: tuple[str, ...]
    closed: tuple[str, ...]
    newly_open: int
    no_longer_open: int
    plainer: tuple[str, ...] = ()
    robots: Mapping[tuple[str, str], tuple[str, ...]] = {}


class Change(NamedTuple):
    """What an edit did; the rest is as of ``Difference``.

    Attributes
    ----------
    version
        Of the session after it.
    """

    edit: Edit
    version: int
    before: Verdict
    verdict: Verdict
    opened: tuple[str, ...] = ()
    closed: tuple[str, ...] = ()
    newly_open: int = 0
    no_longer_open: int = 0
    plainer: tuple[str, ...] = ()
    robots: Mapping[tuple[str, str], tuple[str, ...]] = {}


def compared(before: Result, after: Result) -> Difference:
    """Return what differs between two answers."""
    if before.fleet and after.fleet:
        return _of_fleets(before, before.fleet, after, after.fleet)
    stood, stands = ([f for f in result.analysis.findings if f.stands] for result in (before, after))
    had, has = {f.id for f in stood}, {f.id for f in stands}
    reduced = {f.id for f in stood if f.pseudonymised}
    was, now = ({q.element.shown_as for q in result.analysis.open} for result in (before, after))
    return Difference(
        before.analysis.verdict,
        after.analysis.verdict,
        tuple(f.id for f in stands if f.id not in had),
        tuple(f.id for f in stood if f.id not in has),
        len(now - was),
        len(was - now),
        tuple(f.id for f in stands if f.id in reduced and not f.pseudonymised),
    )


class _Stands(NamedTuple):
    """On which robots the findings of a pattern stand, and on which of them data is plain; the empty name for none."""

    finding: str
    on: frozenset[str] = frozenset()
    plain: frozenset[str] = frozenset()


def _of_fleets(before: Result, was: FleetView, after: Result, now: FleetView) -> Difference:
    """What differs, robot by robot: which robots are alike may be otherwise, too."""
    stood, stands = _standing(was), _standing(now)
    nothing = _Stands("")
    reduced = {key: one.on - one.plain for key, one in stood.items()}
    moved = {
        CLOSED: {one.finding: one.on - stands.get(key, nothing).on for key, one in stood.items()},
        OPENED: {one.finding: one.on - stood.get(key, nothing).on for key, one in stands.items()},
        PLAINER: {one.finding: one.plain & reduced.get(key, frozenset()) for key, one in stands.items()},
    }  # fmt: skip
    had, has = _open(before, was.likeness), _open(after, now.likeness)
    return Difference(
        before.analysis.verdict,
        after.analysis.verdict,
        tuple(one for one, on in moved[OPENED].items() if on),
        tuple(one for one, on in moved[CLOSED].items() if on),
        sum(len(on - had.get(at, frozenset())) for at, on in has.items()),
        sum(len(on - has.get(at, frozenset())) for at, on in had.items()),
        tuple(one for one, on in moved[PLAINER].items() if on),
        {(what, one): tuple(sorted(on - {""})) for what, some in moved.items() for one, on in some.items() if on},
    )


def _standing(view: FleetView) -> dict[str, _Stands]:
    """Id of a pattern -> how its findings stand."""
    found = {}
    for pattern in view.patterns:
        forms = [(form, robots) for form, robots in pattern.forms if not (form.dismissed or form.accepted)]
        on = frozenset(robot for _, robots in forms for robot in robots)
        plain = frozenset(robot for form, robots in forms if not form.pseudonymised for robot in robots)
        if not on and pattern.finding.stands:  # it is on no robot
            on, plain = frozenset([""]), frozenset([] if pattern.finding.pseudonymised else [""])
        found[pattern.id] = _Stands(pattern.finding.id, on, plain)
    return found


def _open(result: Result, likeness: Likeness) -> dict[object, frozenset[str]]:
    """What is open -> on which robots; the empty name for what belongs to none."""
    found: dict[object, frozenset[str]] = {}
    for question in result.analysis.open:
        element = question.element
        if element.robot not in likeness.second:
            at = likeness.alike(element).shown_as
            found[at] = found.get(at, frozenset()).union(likeness.placed(element.robot) or ("",))
    return found
