"""Why something is a finding, in words: the reason of a document in the reader's language.

In: a finding of a document or a ``Reason``, and what kinds of data are called. Out: part of a sentence.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import printable

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rosprivacy.analysis.model import Reason
    from rosprivacy.report.words.words import Words


def reason_told(finding: Mapping[str, Any], words: Words, title: Callable[[str], str]) -> str:
    """Return the reason of a finding; empty for a disclosure. Documents of earlier versions have it in English only.

    Parameters
    ----------
    title
        Category -> what it is called.
    """
    because = finding.get("because")
    return _told(because["key"], because["values"], words, title) if because else printable(finding.get("reason", ""))


def why_told(why: Reason, words: Words, title: Callable[[str], str]) -> str:
    """Return a reason in words."""
    return _told(why.key, dict(why.values), words, title)


def _told(key: str, values: Mapping[str, str], words: Words, title: Callable[[str], str]) -> str:
    told = {
        "kept": words.duration,
        "backups": words.duration,
        "limit": words.duration,
        "until": words.date,
        "since": words.date,
        "ended": words.date,
        "category": title,
    }
    said = {place: told.get(place, str)(printable(value)) for place, value in values.items()}
    if "recipients" in said:  # whom a decision covers: what the list of countries says, in English
        otherwise = words.known("adequacy.other", said["recipients"])
        said["recipients"] = words.known(f"adequacy.{said['country']}", otherwise)
    return words(f"reason.{key}", **said)
