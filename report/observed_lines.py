"""What an answer rests on that was seen and not granted: lines under Assumed, in every language (rule S16).

In: a JSON document of the contract. Out: plain lines; the facts in them (times, doors, names) are as the reader said.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import ASSUMED, ENCLAVES_MADE_UP, FOLDED_NAMES, OBSERVED, RECORDING

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.words.words import Words

WORDS = {
    OBSERVED: "a.observed",
    ENCLAVES_MADE_UP: "a.enclaves-made-up",
    FOLDED_NAMES: "a.folded-names",
    RECORDING: "a.recording",
}


def observed_lines(report: Mapping[str, Any], words: Words) -> Iterator[str]:
    """Return from when to when somebody looked, and what was made up or folded in the policies that came of it."""
    for said in report["diagnostics"]:
        if said.get("code") in ASSUMED:
            yield words(WORDS[said["code"]], file=shown(said["file"]), said=said["message"])
