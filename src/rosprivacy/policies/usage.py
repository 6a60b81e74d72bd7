"""Policy against reality: what is granted and what was seen -> what to tell, and a patch (rules S5, S16).

In: names of policies, and of policies that were made of observations. Out: a document ``rosprivacy.usage/1``.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputErrors, ObservationError
from rosprivacy.analysis.model import OBSERVATION_GAP, OBSERVED
from rosprivacy.ingest.mitigation.deny_lines import with_denied
from rosprivacy.ingest.mitigation.deny_patch import Patch, patch
from rosprivacy.ingest.observe.granted_and_used import usage
from rosprivacy.reading.robot_system import read_graphs, read_system

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Grant, Policy
    from rosprivacy.ingest.observe.granted_and_used import Usage, Use
    from rosprivacy.settings import Settings

FORMAT = "rosprivacy.usage/1"
GAPS = "the observation has gaps, so what was not seen may be in use; look again"


def usage_document(granted: str, observed: str, settings: Settings, *, saved: tuple[bool, bool]) -> dict[str, Any]:
    """Return the comparison of policies with what was seen.

    Parameters
    ----------
    saved
        Whether each of the two is a saved graph.

    Raises
    ------
    InputErrors
        With every problem of the policies; if the second is not made of an observation.
    """
    before, after = (_read(name, settings, graph) for name, graph in zip((granted, observed), saved, strict=True))
    said = [one for policy in after for one in policy.diagnostics]
    if not any(one.code == OBSERVED for one in said):
        hint = "name the policies first, then what `rosprivacy observe` wrote"
        raise InputErrors([ObservationError(observed, 0, "was not made of an observation", hint)])
    found = usage(before, after, settings.view)
    gaps = sorted({one.message for one in said if one.code == OBSERVATION_GAP})
    made = Patch(why_not=GAPS) if gaps else _patched(before, after, found, settings.view)
    return {
        "format": FORMAT,
        "view": settings.view,
        "observed": sorted({one.message for one in said if one.code == OBSERVED}),
        "gaps": gaps,
        "not_granted": [_use(use) for use in found.not_granted],
        "unused": [_unused(grant, found, made) for grant in found.unused],
        "never_seen": [{"node": node, "grants": count} for node, count in found.never_seen.items()],
        "patch": made.diff,
        "why_no_patch": made.why_not,
    }


def _read(name: str, settings: Settings, graph: bool) -> tuple[Policy, ...]:  # noqa: FBT001 - one of two kinds of file
    settings = replace(settings, add=(name,) if graph else ())
    return read_system(() if graph else (name,), settings, read_graphs(settings))[0]


def _patched(before: tuple[Policy, ...], after: tuple[Policy, ...], found: Usage, view: str) -> Patch:
    """The patch, if with it no more is refused of what runs than before."""
    if not found.to_deny:
        return Patch()
    changed = usage(with_denied(before, found.to_deny), after, view)
    if [use.grant for use in changed.not_granted] != [use.grant for use in found.not_granted]:
        return Patch(why_not="the lines could not be denied without taking away what runs")
    return patch(before, found.to_deny)


def _grant(grant: Grant) -> dict[str, Any]:
    place = {"file": grant.place.file, "line": grant.place.line, "enclave": grant.enclave}
    return {"node": grant.node, "role": grant.role, "kind": grant.kind, "name": grant.name, **place}


def _unused(grant: Grant, found: Usage, made: Patch) -> dict[str, Any]:
    hidden = {"hidden": True} if grant in found.hidden else {}
    return {**_grant(grant), "in_patch": bool(made.diff) and grant in found.to_deny, **hidden}


def _use(use: Use) -> dict[str, Any]:
    seen = use.grant.seen
    when = {"by": list(seen.by), "first": seen.first, "last": seen.last} if seen else {}
    denied = [{"file": line.place.file, "line": line.place.line} for line in use.lines]
    return {**_grant(use.grant), "why": use.why, "seen": when, **({"denied_by": denied} if denied else {})}
