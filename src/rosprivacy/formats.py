"""A ``Result`` -> the formats of other people's tools: SARIF, and the file that the CNIL's PIA tool imports.

What the reports may not ask for themselves is found here: the root of the repository, the date.
"""

from __future__ import annotations

import os
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from rosprivacy.clock import source_date

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.decisions import Decision
    from rosprivacy.analysis.model import NonRosFacts
    from rosprivacy.assembly import Result

    Stated = Mapping[tuple[str, str, str], Mapping[str, str]]


def sarif_log(result: Result, accepted: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Return the SARIF log of an analysis.

    Parameters
    ----------
    accepted
        Id of a finding -> why a person accepted it; what the decisions of the result say by default.
    """
    from rosprivacy.report.sarif.artifacts import repository_root  # noqa: PLC0415 - light start
    from rosprivacy.report.sarif.log import sarif  # noqa: PLC0415

    assumptions = result.assumptions
    named = [entry["file"] for kind in ("policies", "labels") for entry in assumptions.get(kind) or ()]
    vocabulary = result.vocabulary
    log = sarif(
        result.shown,
        vocabulary.categories,
        result.diagnostics,
        assumptions,
        repository_root(named),
        accepted_of(result) if accepted is None else accepted,
    )
    if not result.fleet:
        return log
    from rosprivacy.report.fleet_formats import with_robots  # noqa: PLC0415

    return with_robots(log, result.analysis, result.fleet)


def pia_file(
    result: Result,
    accepted: Mapping[str, str] | None = None,
    stated: Stated | None = None,
) -> dict[str, Any]:
    """Return what the CNIL's PIA tool imports.

    Parameters
    ----------
    accepted
        Id of a finding -> why a person accepted it; what the decisions of the result say by default.
    stated
        (robot, kind, name) of a storage or recipient -> what people stated of it; what the analysis knows by default.

    Raises
    ------
    InputError
        If ``SOURCE_DATE_EPOCH`` is no time; without it the file is dated now, since the tool wants a date (rule S14).
    """
    from rosprivacy.report.cnil.pia import cnil_pia  # noqa: PLC0415 - light start

    vocabulary, analysis, about = result.vocabulary, result.analysis, ""
    if result.fleet:
        from rosprivacy.report.fleet_formats import note, of_shown_robots  # noqa: PLC0415

        analysis, about = of_shown_robots(analysis, result.fleet), note(result.fleet)
    created = (source_date(os.environ) or datetime.now(UTC)).isoformat(timespec="milliseconds").replace("+00:00", "Z")
    return cnil_pia(
        analysis,
        vocabulary.categories,
        vocabulary.hierarchy,
        result.assumptions,
        created,
        accepted_of(result) if accepted is None else accepted,
        stated_of(analysis) if stated is None else stated,
        about,
    )


def accepted_of(result: Result) -> dict[str, str]:
    """Return the findings that a valid decision accepts: id -> reason, owner, legal basis, until when (rule S10)."""
    if result.decided is None:
        return {}
    held = ((f.id, result.decided.valid(f)) for f in result.analysis.findings if f.accepted)
    return {finding: _why(decision) for finding, decision in held if decision}


def _why(decision: Decision) -> str:
    more = [decision.owner, *decision.legal_basis, f"until {decision.expires}" if decision.expires else ""]
    return f"{decision.reason} ({', '.join(part for part in more if part)})"


def stated_of(analysis: Analysis) -> dict[tuple[str, str, str], dict[str, str]]:
    """Return what people stated of what lies outside ROS, as texts (rule S9)."""
    return {element.identity: dict(_stated(facts)) for element, facts in analysis.outside.items()}


def _stated(facts: NonRosFacts) -> Iterator[tuple[str, str]]:
    kept = ", ".join(f"{category}: {duration}" if category else str(duration) for category, duration in facts.retention)
    backups = "in backups, nobody says for how long" if facts.backups is True else f"in backups {facts.backups} more"
    said = {
        "retention": ", ".join(part for part in (kept, backups if facts.backups else "") if part),
        "country": facts.country,
        "encrypted": "" if facts.encrypted is None else ("yes" if facts.encrypted else "no"),
        "operator": facts.operator,
        "role": facts.recipient,
        "basis": facts.transfer,
    }
    yield from ((what, value) for what, value in said.items() if value)
