"""What a person decides about a finding of a session, into the decisions file that the session was begun with.

In: a finding as it is found now, and an entry. Out: the file with it. What others wrote meanwhile stays: the file is
read anew each time, and one writer works at a time.
"""

from __future__ import annotations

import os
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypedDict

from rosprivacy.analysis.errors import DecisionError, InputErrors, shown
from rosprivacy.analysis.files_read import one_run
from rosprivacy.analysis.remembered import as_written
from rosprivacy.clock import today
from rosprivacy.decided import about_today
from rosprivacy.ingest.decisions.decision_writer import text_in, with_decision
from rosprivacy.ingest.decisions.decisions_file import is_date
from rosprivacy.report.atomic import write_texts
from rosprivacy.report.editing import editing

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Finding
    from rosprivacy.result import Result

LEAST = {"accept": ("reason", "owner")}  # what a person signs


class Ruling(NamedTuple):
    """What is decided about a finding, and on whose word; what is empty is not said.

    Attributes
    ----------
    choice
        ``accept``, ``mitigate``, ``delegate`` or ``avoid``.
    expires
        The last day on which it is valid, ``YYYY-MM-DD``.
    legal_basis
        Articles, such as ``6(1)(f)``.
    """

    choice: str
    reason: str = ""
    owner: str = ""
    expires: str = ""
    ticket: str = ""
    legal_basis: tuple[str, ...] = ()


class How(TypedDict, total=False):
    """The words of a decision, as of ``Ruling``."""

    reason: str
    owner: str
    expires: str
    ticket: str
    legal_basis: tuple[str, ...]


def record(file: str | None, result: Result, finding: str, said: Ruling) -> None:
    """Write a decision about a finding into the decisions file, which is made if it is not there.

    Raises
    ------
    InputErrors
        If there is no file or no such finding, or the decision is none; nothing is written then.
    InputError
        If the file cannot be written; then it is as it was.
    """
    if file is None:
        raise _refused("", "there is no decisions file", "name one when the session begins")
    found = next((one for one in result.analysis.findings if one.id == finding), None)
    if found is None:
        raise _refused(file, f"{shown(finding)!r} is no finding", "take the id of one that is found now")
    _check(file, said)
    entry = {
        **({"id": found.id, "pseudonymised": True} if found.pseudonymised else {"id": found.id}),
        **_entry(said),
        "made_about": as_written(about_today(result.analysis, None)[found.id]),
    }
    path = Path(file)
    with one_run(), editing(path):
        text = with_decision(file, text_in(path), entry, _remark(found), result.vocabulary)
        write_texts([(path, text)], edited=path)


def _check(file: str, said: Ruling) -> None:
    if said.expires and not is_date(said.expires):
        raise _refused(file, f"{shown(said.expires)!r} is not a date", "write YYYY-MM-DD")
    if said.expires and said.expires < today(os.environ):
        raise _refused(file, f"{said.expires} is over: it would decide nothing", "name a day to come")
    for name in LEAST.get(said.choice, ()):
        if not getattr(said, name):
            raise _refused(file, f"an acceptance without {name}", f"say the {name}: it is what a person signs")


def _entry(said: Ruling) -> dict[str, Any]:
    """As the file has it, in its order."""
    entry = {
        "decision": said.choice,
        "reason": said.reason,
        "owner": said.owner,
        "legal_basis": list(said.legal_basis),
        "date": date.fromisoformat(today(os.environ)),
        "expires": date.fromisoformat(said.expires) if said.expires else None,
        "ticket": said.ticket,
    }
    return {key: value for key, value in entry.items() if value}


def _remark(finding: Finding) -> str:
    """What a person reads beside an id."""
    return f"{finding.category}: {finding.source.name} -> {finding.leak.name}"


def _refused(file: str, problem: str, hint: str) -> InputErrors:
    return InputErrors([DecisionError(file or "the session", 0, problem, hint)])
