"""A policy held against what is deployed, or against what was seen in use: the documents of ``check`` and ``diff``.

In: names of files, keystores and observations. Out: ``rosprivacy.check/1``, what only one of both says; and
``rosprivacy.usage/1``, what runs and is not granted, what is granted and was never seen, with a patch (rules S5, S16).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputErrors, ObservationError
from rosprivacy.analysis.model import ACCESS_GAP, OBSERVATION_GAP, OBSERVED, SCAN_GAP, UNREAD_FILE
from rosprivacy.analysis.model.reason import NOT_ENCRYPTED, STRANGERS
from rosprivacy.ingest.deployed.differences import differences, generator_losses
from rosprivacy.ingest.mitigation.deny_lines import with_denied
from rosprivacy.ingest.mitigation.deny_patch import Patch, patch
from rosprivacy.ingest.running.granted_and_used import usage
from rosprivacy.systems.granted import ZENOH, code_roots, read_granted
from rosprivacy.systems.robot_system import read_graphs, read_system
from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.model import Diagnostic, Grant, Place, Policy
    from rosprivacy.ingest.deployed.differences import GrantDifference, Loss
    from rosprivacy.ingest.running.granted_and_used import Usage, Use
    from rosprivacy.report.schemas.policies import CheckDocument, DifferenceEntry
    from rosprivacy.settings import Settings

CHECK_FORMAT = "rosprivacy.check/1"
USAGE_FORMAT = "rosprivacy.usage/1"
GAPS = "the observation has gaps, so what was not seen may be in use; look again"


def check_document(policy: str, deployed: tuple[str, ...], settings: Settings) -> CheckDocument:
    """Compare a policy with what is deployed.

    A file of Zenoh is the view of one process, and its name that of a node: it is compared with what the policy grants
    to the nodes of that name, and what the known generator loses is told as such. All else is compared by enclave.
    Where both are sources, what descriptions in the first say is compared with what the code in the second does.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    if sides := _described_and_coded(policy, deployed):
        return _checked(differences(sides[:1], sides[1:]), (), sides, (), compared="description")
    stated, said = read_granted([policy], replace(settings, permissions_ca=()))  # what is meant; nobody signs it
    zenoh = [name for name in deployed if name.endswith(ZENOH)]
    others = [name for name in deployed if not name.endswith(ZENOH)]
    found: list[GrantDifference] = []
    losses: tuple[Loss, ...] = ()
    read: list[Policy] = [*stated]
    for names, who in ((others, _enclave), (zenoh, _base_name)):
        if names:
            there, more = read_granted(names, settings)
            new = differences(stated, there, who)
            found += new
            losses = generator_losses(stated, there, new, who) if names is zenoh else losses
            read += there
            said += more
    return _checked(found, losses, read, said)


def _described_and_coded(policy: str, deployed: tuple[str, ...]) -> tuple[Policy, Policy] | None:
    """What descriptions say and what code does, where both are named; else None."""
    code = code_roots([policy, *deployed])
    if policy not in code or len(deployed) != 1 or deployed[0] not in code:
        return None
    from rosprivacy.ingest.scan.described_code import described_and_coded  # noqa: PLC0415 - light start

    return described_and_coded(code[policy], code[deployed[0]])


def _checked(
    differences: Iterable[GrantDifference],
    losses: Iterable[Loss],
    read: Sequence[Policy],
    diagnostics: Iterable[Diagnostic],
    compared: str = "deployment",
) -> CheckDocument:
    told = [*(one for one_read in read for one in one_read.diagnostics), *diagnostics]
    return {
        "format": CHECK_FORMAT,
        "compared": compared,
        "differences": [_entry(difference) for difference in sorted(differences)],
        "losses": [
            {"loss": one.fault, "message": one.message, "file": one.place.file, "line": one.place.line}
            for one in losses
        ],
        "exposed": [
            {"cause": cause, "dds": dds, "file": place.file, "line": place.line}
            for cause, dds, place in sorted({one for policy in read for one in _exposed(policy)})
        ],
        "undetermined": any(one.code in (ACCESS_GAP, SCAN_GAP, UNREAD_FILE) for one in told),
        "diagnostics": list(_diagnostics(told)),
        "policies": [
            {"file": file, "sha256": digest} for file, digest in sorted({one for some in read for one in some.sources})
        ],
        "rosprivacy": __version__,
    }


def _enclave(grant: Grant) -> str:
    return grant.enclave


def _base_name(grant: Grant) -> str:
    return f"/{grant.node.rpartition('/')[2]}"


def _exposed(policy: Policy) -> Iterable[tuple[str, str, Place]]:
    """What a governance leaves in the open: (cause, expression of DDS topics, line)."""
    for protection in policy.protections:
        if protection.strangers:
            yield STRANGERS, "*", protection.strangers
        yield from ((NOT_ENCRYPTED, one.expression, one.place) for one in protection.topics if not one.encrypted)


def _entry(difference: GrantDifference) -> DifferenceEntry:
    return {
        "enclave": difference.enclave,
        "only_in": "policy" if difference.stated else "deployed",
        "right": "write" if difference.writes else "read",
        "kind": difference.kind,
        "name": difference.name,
        "leg": difference.leg,
        "dds": difference.dds,
        "file": difference.place.file,
        "line": difference.place.line,
    }


def _diagnostics(diagnostics: Iterable[Diagnostic]) -> Iterable[dict[str, object]]:
    for one in dict.fromkeys(diagnostics):
        yield {"severity": str(one.severity), "message": one.message, "file": one.place.file, "line": one.place.line}


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
        "format": USAGE_FORMAT,
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


def _patched(before: tuple[Policy, ...], after: tuple[Policy, ...], used: Usage, view: str) -> Patch:
    """The patch, if with it no more is refused of what runs than before."""
    if not used.to_deny:
        return Patch()
    changed = usage(with_denied(before, used.to_deny), after, view)
    if [use.grant for use in changed.not_granted] != [use.grant for use in used.not_granted]:
        return Patch(why_not="the lines could not be denied without taking away what runs")
    return patch(before, used.to_deny)


def _grant(grant: Grant) -> dict[str, Any]:
    place = {"file": grant.place.file, "line": grant.place.line, "enclave": grant.enclave}
    return {"node": grant.node, "role": grant.role, "kind": grant.kind, "name": grant.name, **place}


def _unused(grant: Grant, usage: Usage, patch: Patch) -> dict[str, Any]:
    hidden = {"hidden": True} if grant in usage.hidden else {}
    return {**_grant(grant), "in_patch": bool(patch.diff) and grant in usage.to_deny, **hidden}


def _use(use: Use) -> dict[str, Any]:
    seen = use.grant.observation
    when = {"by": list(seen.by), "first": seen.first, "last": seen.last} if seen else {}
    denied = [{"file": line.place.file, "line": line.place.line} for line in use.lines]
    return {**_grant(use.grant), "why": use.why, "seen": when, **({"denied_by": denied} if denied else {})}
