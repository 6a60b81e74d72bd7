"""What to do next, in the report for the terminal: one step, the one that the verdict waits for (rules S11, S12).

In: a JSON document of the contract. Out: lines.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import UNREAD_FILE
from rosprivacy.report.element_counts import count_rows
from rosprivacy.report.naming import shown_name
from rosprivacy.report.review_groups import next_round
from rosprivacy.report.terminal.restriction import asked_at_verdict

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

Line = tuple[str, str]  # text, style
NAMED = 5  # candidates
SENSORS = (  # what is in the name of a node that brings personal data in, more often than not; the surest first
    "camera", "video", "image", "kinect", "realsense", "depth", "thermal", "microphone", "audio", "voice", "speech",
    "laser", "lidar", "scan", "radar", "gnss", "face", "person", "people", "teleop", "amcl", "slam", "localiz",
)  # fmt: skip
SHORT = ("cam", "rgb", "zed", "mic", "asr", "gps", "joy", "user")  # of these only whole words
SOURCE = "name a source in a label file, such as nodes: {/camera: {source: [Video]}}"


def followed(report: Mapping[str, Any]) -> bool:
    """Whether any data was followed: whether a label names a source of what was asked for."""
    return bool(report["carries"])


def next_lines(report: Mapping[str, Any]) -> Iterator[Line]:
    """Return the next step; none where nothing was found and nothing is open."""
    step = _step(report)
    if step:
        yield f"Next: {step}", "bold"


def _step(report: Mapping[str, Any]) -> str:
    if report["verdict"] == "leak":
        return "decide about each finding (rosprivacy decide), or see what would remove it (rosprivacy mitigate)"
    if report["verdict"] != "undetermined":
        return ""
    if not followed(report) and (restriction := asked_at_verdict(report)):
        return f"ask about all kinds, or {SOURCE}{restriction}"
    if not followed(report):
        named = candidates(report)
        rest = f" and {len(named) - NAMED} more" if len(named) > NAMED else ""
        more = f"; candidates by name: {', '.join(named[:NAMED])}{rest}" if named else ""
        return f"{SOURCE}{more} (rosprivacy labels --init lists all nodes)"
    if report["open"]:
        first = next_round(report)[0]["element"]
        others = count_rows(report["open"]).elements - 1
        more = f" and {others:,} more" if others else ""
        return f"review {shown_name(first)}{more}, say it in a label file (rosprivacy labels --next), repeat"
    unread = sorted({shown(said["file"]) for said in report["diagnostics"] if said.get("code") == UNREAD_FILE})
    return f"name the policy that includes {unread[0]}, or remove it" if unread else ""


def candidates(report: Mapping[str, Any]) -> list[str]:
    """Return the nodes whose names say that they bring data in, the surest first: a guess, for a person to judge."""
    nodes = [element for element in report["unreached"] if element["kind"] == "node"]
    likely = [(_likely(node["name"]), shown_name(node)) for node in nodes]
    return [name for rank, name in sorted(likely) if rank < len(SENSORS)]


def _likely(name: str) -> int:
    """Return how surely a name is that of a sensor: the place of its word in the list; its length if it is none."""
    words = re.sub("([a-z])([A-Z])", r"\1_\2", name).casefold()
    if not set(re.split("[^a-z]+", words)).isdisjoint(SHORT):
        return 0
    return next((place for place, sensor in enumerate(SENSORS) if sensor in words), len(SENSORS))
