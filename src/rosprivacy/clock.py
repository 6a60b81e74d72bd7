"""The one time that a report may tell, ``SOURCE_DATE_EPOCH``: the same input gives the same bytes (rule S14)."""

from __future__ import annotations

from datetime import datetime, timezone
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, shown

if TYPE_CHECKING:
    from collections.abc import Mapping

VARIABLE = "SOURCE_DATE_EPOCH"


def source_date(environment: Mapping[str, str]) -> datetime | None:
    """Return the time that the environment names, in UTC; None if it names none.

    Raises
    ------
    InputError
        If it is no number of seconds since 1970.

    >>> source_date({"SOURCE_DATE_EPOCH": "1767225600"})
    datetime.datetime(2026, 1, 1, 0, 0, tzinfo=datetime.timezone.utc)
    """
    given = environment.get(VARIABLE, "")
    if not given:
        return None
    try:
        return datetime.fromtimestamp(int(given), timezone.utc)
    except (ValueError, OverflowError, OSError):
        hint = "give whole seconds since 1970, or unset it"
        raise InputError(VARIABLE, 0, f"{shown(given)!r} is not a time", hint) from None


def judged_on(environment: Mapping[str, str]) -> str:
    """Return the later of the environment's date and that of now: what has ended by either has ended.

    >>> judged_on({"SOURCE_DATE_EPOCH": "0"}) > "2026-01-01", judged_on({"SOURCE_DATE_EPOCH": "253370764800"})
    (True, '9999-01-01')
    """
    return max(today(environment), today({}))


def today(environment: Mapping[str, str]) -> str:
    """Return the date, in UTC, as ``YYYY-MM-DD``: that of the environment, else that of now (rule S14).

    >>> today({"SOURCE_DATE_EPOCH": "1767225600"})
    '2026-01-01'
    """
    return (source_date(environment) or datetime.now(timezone.utc)).date().isoformat()


def now(environment: Mapping[str, str]) -> str:
    """Return the time, in UTC, as ``YYYY-MM-DDThh:mm:ssZ``: that of the environment, else that of now (rule S14).

    >>> now({"SOURCE_DATE_EPOCH": "1767225600"})
    '2026-01-01T00:00:00Z'
    """
    return (source_date(environment) or datetime.now(timezone.utc)).strftime("%Y-%m-%dT%H:%M:%SZ")
