"""What to do next, in the report for the terminal: one step, the one that the verdict waits for (rules S11, S12).

In: a JSON document of the contract. Out: lines.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import GOES_NOWHERE, NO_LEAK_NAMED
from rosprivacy.report.called_alike import named
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words
from rosprivacy.report.element_counts import count_rows
from rosprivacy.report.naming import shown_name
from rosprivacy.report.review_groups import next_round
from rosprivacy.report.verdict import doubts_of, lacking, restriction, subject

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

Line = tuple[str, str]  # text, style
SENSORS = (  # what is in the name of a node that brings personal data in, more often than not; the surest first
    "camera", "video", "image", "kinect", "realsense", "depth", "thermal", "microphone", "audio", "voice", "speech",
    "laser", "lidar", "scan", "radar", "gnss", "face", "person", "people", "teleop", "amcl", "slam", "localiz",
)  # fmt: skip
SHORT = ("cam", "rgb", "zed", "mic", "asr", "gps", "joy", "user")  # of these only whole words
EXAMPLE = "nodes: {/camera: {source: [Video]}}"


def lacking_step(code: str, words: Words = IN_ENGLISH) -> str:
    """Return what to do where an answer lacks grounds, by the code of that; empty for another.

    >>> lacking_step(GOES_NOWHERE)
    'check which node brings the data in (those named send none on): nodes: {/camera: {source: [Video]}}'
    """
    return words(f"tty.next.{code}", example=EXAMPLE) if code in (GOES_NOWHERE, NO_LEAK_NAMED) else ""


def followed(report: Mapping[str, Any]) -> bool:
    """Whether any data was followed: whether a label names a source of what was asked for."""
    return bool(report["carries"])


def next_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return the next step; none where nothing was found and nothing is open."""
    step = _step(report, words)
    if step:
        yield words("tty.next", step=step), "bold"


def _step(report: Mapping[str, Any], words: Words) -> str:
    if report["verdict"] == "leak":
        return words("tty.next.leak")
    if report["verdict"] != "undetermined":
        return ""
    source = words("tty.next.source", example=EXAMPLE)
    if not followed(report) and (asked := restriction(report, words)):
        return words("tty.next.all", source=source, restriction=asked)
    if not followed(report):
        likely = candidates(report)
        names = words("tty.next.candidates", names=named(likely, words)) if likely else ""
        return words("tty.next.init", source=source, candidates=names)
    if report["open"]:
        first = next_round(report)[0]["element"]
        others = count_rows(report["open"]).elements - 1
        more = words("tty.more", n=others) if others else ""
        return words("tty.next.review", element=shown_name(first), more=more)
    return lacking_step(lacking(report), words) or _doubt_step(report, words)


def _doubt_step(report: Mapping[str, Any], words: Words) -> str:
    """What to do about the first doubt; those that break the verdict stand first."""
    first = next(iter(doubts_of(report)), None)
    return words.pair(subject(first), words(f"doubt.{first['doubt']}.do")) if first else ""


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
