"""What an answer rests on that was seen and not granted: lines under Assumed, in every language (rule S16).

In: a JSON document of the contract. Out: plain lines; the facts in them (times, doors, names) are as the reader said.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import ASSUMED

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.words.words import Words


def observed_lines(report: Mapping[str, Any], words: Words) -> Iterator[str]:
    """Return from when to when somebody looked, and what was made up or folded in the policies that came of it."""
    for said in report["diagnostics"]:
        if said.get("code") in ASSUMED:
            yield words(f"a.{said['code']}", file=shown(said["file"]), said=said["message"])
