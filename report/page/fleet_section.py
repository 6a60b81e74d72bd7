"""A fleet in a report for people: its robots by model, which stand for which, and those that are not as most.

In: an ``Index`` and the entries of the report. Out: ``FleetSection``, in plain texts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.text import fit
from rosprivacy.report.naming import name

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.report.page.finding_entries import PathEntry
    from rosprivacy.report.page.index import Index


class AlikeRow(NamedTuple):
    """Robots that have the same policies and labels: the first one is shown."""

    model: str
    shown: str
    robots: tuple[str, ...]


class DeviantDifference(NamedTuple):
    """One thing in which robots differ from most of their model.

    Attributes
    ----------
    extra
        Whether they have it and most do not; else the other way round.
    entry
        The finding; None where the difference is an element that nobody has reviewed, or one that is reviewed there.
    ends
        Source and place of the path, whatever the robot.
    text
        In words.
    """

    extra: bool
    entry: PathEntry | None
    ends: tuple[str, str]
    text: str


class DeviantRobot(NamedTuple):
    """Robots that are not as most of their model."""

    robots: tuple[str, ...]
    model: str
    differences: tuple[DeviantDifference, ...]


class FleetSection(NamedTuple):
    """What a report tells of the robots.

    Attributes
    ----------
    models
        (name, number of robots).
    """

    intro: str
    models: tuple[tuple[str, int], ...]
    alike: tuple[AlikeRow, ...]
    deviants: tuple[DeviantRobot, ...]


def fleet_told(index: Index, entries: Iterable[PathEntry]) -> FleetSection | None:
    """Return the fleet of a document; None if it is of a single robot. Complexity: O(robots + differences)."""
    fleet = index.document.get("fleet")
    if not fleet:
        return None
    words = index.words
    by_finding = {entry.id: entry for entry in entries}
    findings = {finding["id"]: finding for finding in index.findings}
    of_pattern = {
        pattern["id"]: (by_finding[pattern["finding"]], _ends(findings[pattern["finding"]], index))
        for pattern in fleet["patterns"]
    }
    alike = tuple(
        AlikeRow(fit(group["model"]) or words("none"), fit(group["robot"]), tuple(map(fit, group["robots"])))
        for group in fleet["alike"]
    )
    return FleetSection(
        words("fleet.intro", robots=words.count(fleet["robots"], "robot"), kinds=words.count(len(alike), "robot_kind")),
        tuple((fit(model) or words("none"), number) for model, number in fleet["models"].items()),
        alike,
        tuple(_deviant(deviant, of_pattern, index) for deviant in fleet["deviants"]),
    )


def _deviant(
    deviant: Mapping[str, Any], of_pattern: Mapping[str, tuple[PathEntry, tuple[str, str]]], index: Index
) -> DeviantRobot:
    shares = [
        DeviantDifference(more, *of_pattern[share["pattern"]], _form(share, index))
        for more, key in ((True, "more"), (False, "fewer"))
        for share in deviant[key]
    ]
    opened = [
        DeviantDifference(
            more, None, ("", ""), index.words(f"fleet.{key}", names=index.words.row(index.names(deviant[key])))
        )
        for more, key in ((True, "more_open"), (False, "fewer_open"))
        if deviant[key]
    ]
    return DeviantRobot(tuple(map(fit, deviant["robots"])), fit(deviant["model"]), (*shares, *opened))


def _ends(finding: Mapping[str, Any], index: Index) -> tuple[str, str]:
    def any_robot(element: Mapping[str, Any]) -> str:
        return fit(element["name"]) if index.alike.get(element["robot"]) else name(element)

    return any_robot(finding["source"]), any_robot(finding["leak"])


def _form(share: Mapping[str, Any], index: Index) -> str:
    """How a robot takes part in a pattern."""
    words = index.words
    said = [words("fleet.ends") if share["ends"] else words("fleet.begins")]
    said += [words("fleet.dismissed")] if share["dismissed"] else []
    said += [words("fleet.accepted")] if share["accepted"] else []
    said += [words("fleet.hidden" if share["pseudonymised"] else "fleet.plain")]
    return words.row(said)
