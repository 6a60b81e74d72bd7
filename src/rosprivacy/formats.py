"""A ``Result`` -> the formats of other people's tools: SARIF, and the file that the CNIL's PIA tool imports.

What the reports may not ask for themselves is found here: the root of the repository, the date.
"""

from __future__ import annotations

import os
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from rosprivacy.clock import source_date

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.assembly import Result


def sarif_log(result: Result, accepted: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Return the SARIF log of an analysis.

    Parameters
    ----------
    accepted
        Id of a finding -> why a person accepted it. Only decisions that hold now.
    """
    from rosprivacy.report.artifacts import repository_root  # noqa: PLC0415 - light start
    from rosprivacy.report.sarif import sarif  # noqa: PLC0415

    assumptions = result.assumptions
    named = [entry["file"] for kind in ("policies", "labels") for entry in assumptions.get(kind) or ()]
    vocabulary = result.vocabulary
    return sarif(
        result.analysis,
        result.bound,
        vocabulary.categories,
        vocabulary.hierarchy,
        result.diagnostics,
        assumptions,
        repository_root(named),
        accepted or {},
    )


def pia_file(
    result: Result,
    accepted: Mapping[str, str] | None = None,
    stated: Mapping[tuple[str, str, str], Mapping[str, str]] | None = None,
) -> dict[str, Any]:
    """Return what the CNIL's PIA tool imports.

    Parameters
    ----------
    accepted
        Id of a finding -> why a person accepted it.
    stated
        (robot, kind, name) of a storage or recipient -> what people stated of it.

    Raises
    ------
    InputError
        If ``SOURCE_DATE_EPOCH`` is no time; without it the file is dated now, since the tool wants a date (rule S14).
    """
    from rosprivacy.report.cnil import cnil_pia  # noqa: PLC0415 - light start

    vocabulary = result.vocabulary
    created = (source_date(os.environ) or datetime.now(UTC)).isoformat(timespec="milliseconds").replace("+00:00", "Z")
    return cnil_pia(
        result.analysis,
        result.bound,
        vocabulary.categories,
        vocabulary.hierarchy,
        result.assumptions,
        created,
        accepted or {},
        stated or {},
    )
