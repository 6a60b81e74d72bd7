"""What an answer rests on that was seen and not granted, or that nobody said: lines under Assumed, in every language.

In: a JSON document of the contract. Out: plain lines; the facts in them (names, numbers) are as the reader said.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import ASSUMED, OWN_DOMAINS, observed_when

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words

SHOWN_AT_MOST = 3  # of files that say the same, and of what files of a fleet say of one thing


def observed_lines(report: Mapping[str, Any], words: Words) -> Iterator[str]:
    """Return from when to when somebody looked, what was made up or folded then, and what else is taken so.

    Of a fleet, files that say the same are one line; the diagnostics have all.
    """
    said: dict[str, dict[str, list[str]]] = {code: defaultdict(list) for code in ASSUMED}
    for one in report["diagnostics"]:
        if one.get("code") in said:
            said[one["code"]][one["message"]].append(shown(one["file"]))
    for code, messages in said.items():
        for number, (message, files) in enumerate(messages.items(), 1):
            if number <= SHOWN_AT_MOST:
                yield words(
                    f"assumption.{code}",
                    file=_names(files),
                    said=_diagnostic_text(code, message, words),
                    n=message.partition(" ")[0],
                )
        if len(messages) > SHOWN_AT_MOST:
            others = [file for files in list(messages.values())[SHOWN_AT_MOST:] for file in files]
            yield words(f"assumption.{code}", file=_names(others), said="…", n="…")


def _diagnostic_text(code: str, message: str, words: Words) -> str:
    """What the reader of an input said; when somebody looked, by which doors, what has no domain, in the language."""
    if code == OWN_DOMAINS:
        names, _, more = message.rpartition(": ")[2].partition(" and ")
        names += f" {words('more', n=more.removesuffix(' more'))}" if more else ""
        return words.count(int(message.partition(" ")[0].replace(",", "")), "assumption.own-domains.said", names=names)
    when = observed_when(message)
    if when is None:
        return message
    start, end, doors = when
    named = words.row(words.of_value(f"door.{door}", shown(door)) for door in doors)
    return words("assumption.observed.when", start=words.moment(start), end=words.moment(end), doors=named)


def _names(files: list[str]) -> str:
    more = [f"… (+{len(files) - SHOWN_AT_MOST:,})"] if len(files) > SHOWN_AT_MOST else []
    return ", ".join([*files[:SHOWN_AT_MOST], *more])
