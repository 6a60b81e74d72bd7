"""Why something is a finding, in words: the reason of a document in the reader's language.

In: a finding of a document, and what its kinds of data are called. Out: part of a sentence.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import printable

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rosprivacy.report.words.words import Words


def reason_told(finding: Mapping[str, Any], words: Words, title: Callable[[str], str]) -> str:
    """Return the reason; empty for a disclosure. Documents of earlier versions have it in English only.

    Parameters
    ----------
    title
        Category -> what it is called.
    """
    why = finding.get("because")
    if not why:
        return printable(finding.get("reason", ""))
    told = {
        "kept": words.duration,
        "backups": words.duration,
        "limit": words.duration,
        "until": words.date,
        "category": title,
    }
    values = {place: told.get(place, str)(printable(value)) for place, value in why["values"].items()}
    if "recipients" in values:  # whom a decision covers: what the list of countries says, in English
        otherwise = words.known("adequacy.other", values["recipients"])
        values["recipients"] = words.known(f"adequacy.{values['country']}", otherwise)
    return words(f"reason.{why['key']}", **values)
