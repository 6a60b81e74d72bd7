"""What is not known in the report for the terminal: where data's path ends without anybody known (rule S11).

In: a JSON document of the contract. Out: parts of the verdict's line, and lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.report.element_counts import count_rows
from rosprivacy.report.naming import shown_name, whole
from rosprivacy.report.terminal.called_alike import kind_in, legs

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.words.words import Words

Line = tuple[str, str]  # text, style
UNKNOWN = ("reader", "flow")


def ends_at_verdict(report: Mapping[str, Any], words: Words) -> Iterator[str]:
    """Return how many ends are not known, for the line of a verdict that nothing was found; on all robots alike."""
    alike = {row["robot"]: len(row["robots"]) for row in report.get("fleet", {}).get("alike", ())}
    if report["verdict"] == "no-leak-found":
        for what in UNKNOWN:
            ends = {whole(end["element"]) for end in report["unknown_ends"] if end["unknown"] == what}
            count = sum(alike.get(robot, 1) for robot, *_ in ends)
            if count:
                yield words.count(count, f"tty.end.{what}")


def end_lines(report: Mapping[str, Any], most: int | None, words: Words) -> Iterator[Line]:
    """Return the names of the ends that are not known, ``most`` of each kind."""
    for what in UNKNOWN:
        ends = [end for end in report["unknown_ends"] if end["unknown"] == what]
        if not ends:
            continue
        yield "", ""
        count = count_rows(ends)
        title = words(f"tty.title.{what}")
        yield words.pair(title, f"{count.elements}{legs(count, words)}"), "bold"
        for end in ends[:most]:
            element = end["element"]
            kind = kind_in({**element, "pattern": False}, words)
            about = "; ".join(part for part in (kind, ", ".join(end["categories"])) if part)
            yield f"   {shown_name(element)}  ({about})", ""
        if most is not None and len(ends) > most:
            yield f"   {words('tty.rest', n=len(ends) - most)}", "dim"
