"""What a person does next: unreviewed elements, doubts, and the one step that the verdict waits for (rule S11).

In: a JSON document of the contract. Out: lines. What can wait, and what a file of the program proposes to take as
mundane, is one line.
"""

from __future__ import annotations

import re
from itertools import groupby
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import GOES_NOWHERE, NO_LEAK_NAMED
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words
from rosprivacy.report.naming import (
    all_kinds,
    count_rows,
    joined_by_and,
    key,
    kind_in,
    label_name,
    legs,
    names_shown,
    shown_name,
)
from rosprivacy.report.review_groups import SHOWN, next_round, review_groups, sources_of
from rosprivacy.report.text.line_parts import place
from rosprivacy.report.verdict import doubts_of, lacking, restriction, subject

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence

    from rosprivacy.report.review_groups import ReviewGroup
    from rosprivacy.report.text.line_parts import Line

SENSORS = (  # what is in the name of a node that brings personal data in, more often than not; the surest first
    "camera", "video", "image", "kinect", "realsense", "depth", "thermal", "microphone", "audio", "voice", "speech",
    "laser", "lidar", "scan", "radar", "gnss", "face", "person", "people", "teleop", "amcl", "slam", "localiz",
)  # fmt: skip
SHORT = ("cam", "rgb", "zed", "mic", "asr", "gps", "joy", "user")  # of these only whole words
MANY, MOST_OTHERS = 4, 2  # kinds that are said together, and without which
EXAMPLE = "nodes: {/camera: {source: [Video]}}"


def review_lines(report: Mapping[str, Any], words: Words, *, verbose: bool) -> Iterator[Line]:
    """Return open elements: nodes on the frontier, then channels, then what lies behind."""
    brings = sources_of(report)
    everywhere = () if verbose else [category["name"] for category in report["categories"]]
    for group in review_groups(report):
        if not group.questions:
            continue
        yield "", ""
        count = count_rows(group.questions)
        title = words(f"terminal.review.{group.key}")
        yield words.pair(title, f"{count.elements}{legs(count, words)}"), "bold"
        for question in group.questions if verbose else group.now[:SHOWN]:
            steps = words("terminal.from.source", steps=words.count(question["distance"], "step"))
            what = "; ".join(
                (kind_in(question["element"], words), steps, review_text(question, brings, words, everywhere))
            )
            yield f"   {label_name(question)}  ({what})", ""
        if not verbose:
            yield from _additional(group, words)


def review_text(
    question: Mapping[str, Any],
    brings: Mapping[Any, Sequence[str]],
    words: Words = IN_ENGLISH,
    everywhere: Collection[str] = (),
) -> str:
    """Return which data is at an open element, through which element it comes, and what a label there can close.

    Parameters
    ----------
    everywhere
        All kinds of data that there are: many that are all of these, or nearly so, are said as such.
    """
    kinds = ", ".join(question["categories"])
    told = _together(question["categories"], everywhere, words)
    own = brings.get(key(question["element"]), ())
    through = question.get("through")
    parts = [words("terminal.comes.through", kinds=told, element=shown_name(through)) if through else told]
    parts += [words(f"terminal.missing.{what}") for what in question.get("missing", ())]
    parts += [words("terminal.brings", own=", ".join(own), kinds=kinds)] if own else []
    behind = [words.count(question["closes"], "open_element")] if question.get("closes") else []
    behind += [words.count(question["leaks"], "exit")] if question.get("leaks") else []
    return "; ".join([*parts, *([words("terminal.only.past", behind=joined_by_and(behind, words))] if behind else [])])


def _together(kinds: Sequence[str], everywhere: Collection[str], words: Words) -> str:
    """Kinds by name; of many all, or all but a few.

    >>> every = ["Gait", "Gesture", "LaserScan", "Video", "Voice"]
    >>> [_together(every[:n], every, IN_ENGLISH) for n in (5, 4, 3)]
    ['all 5 kinds of data', 'all 5 kinds of data but Voice', 'Gait, Gesture, LaserScan']
    """
    others = [kind for kind in everywhere if kind not in kinds]
    if len(kinds) < MANY or not everywhere or len(others) > MOST_OTHERS:
        return ", ".join(kinds)
    every = all_kinds(everywhere, everywhere, words)
    return words("terminal.kinds.but", all=every, others=", ".join(others)) if others else every


def _additional(group: ReviewGroup, words: Words) -> Iterator[Line]:
    left = len(group.now) - SHOWN
    if left > 0:
        yield f"   {words('terminal.rest', n=left)}", "dim"
    if waiting := count_rows(group.waiting).elements:
        yield f"   {words('terminal.wait', n=waiting)}", "dim"
    if proposed := count_rows(group.proposed).elements:
        yield f"   {words('terminal.infrastructure', n=proposed)}", "dim"


def doubt_lines(report: Mapping[str, Any], limit: int | None, words: Words) -> Iterator[Line]:
    """Return a line for each doubt, ``limit`` of each sort, with what to do about the sort."""
    doubts = report["doubts"]
    if not doubts:
        return
    yield "", ""
    yield words("doubt.list", n=len(doubts)), "bold"
    for name, rows in groupby(doubts, key=lambda doubt: doubt["doubt"]):
        sort = list(rows)
        rank = words(f"doubt.{sort[0]['rank']}")
        remedy = words("doubt.what.to.do", do=words(f"doubt.{name}.do"))
        yield f"   {words(f'doubt.{name}.title')} ({rank}). {remedy}", ""
        yield from ((f"      {_doubt(doubt, words)}", "yellow") for doubt in sort[:limit])
        if limit is not None and len(sort) > limit:
            yield f"      {words('terminal.rest', n=len(sort) - limit)}", "dim"


def _doubt(doubt: Mapping[str, Any], words: Words) -> str:
    at = place(doubt) if doubt["line"] else shown(doubt["file"])
    if doubt.get("element"):
        kind = kind_in({**doubt["element"], "pattern": False}, words)
        about = "; ".join(part for part in (kind, ", ".join(doubt["categories"])) if part)
        text = f"{subject(doubt)} ({about})" + (f", {at}" if at else "")
    else:
        text = ": ".join(part for part in (at, doubt["message"]) if part)
    accepted = doubt["accepted"]
    if accepted:
        who = {"owner": shown(accepted["owner"]), "reason": shown(accepted["reason"])}
        text = f"{text}; {words('doubt.is.accepted', date=words.date(accepted['expires']), **who)}"
    return f"{text}  [{doubt['id']}]"


def next_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return the next step; none where nothing was found and nothing is open."""
    step = _step(report, words)
    if step:
        yield words("terminal.next", step=step), "bold"


def lacking_step(code: str, words: Words = IN_ENGLISH) -> str:
    """Return what to do where an answer lacks grounds, by the code of that; empty for another.

    >>> lacking_step(GOES_NOWHERE)
    'check which node brings the data in (those named send none on): nodes: {/camera: {source: [Video]}}'
    """
    return words(f"terminal.next.{code}", example=EXAMPLE) if code in (GOES_NOWHERE, NO_LEAK_NAMED) else ""


def _step(report: Mapping[str, Any], words: Words) -> str:
    if report["verdict"] == "leak":
        return words("terminal.next.leak")
    if report["verdict"] != "undetermined":
        return ""
    source = words("terminal.next.source", example=EXAMPLE)
    followed = bool(report["carries"])  # a label names a source of what was asked for
    if not followed and (asked := restriction(report, words)):
        return words("terminal.next.all", source=source, restriction=asked)
    if not followed:
        likely = candidates(report)
        names = words("terminal.next.candidates", names=names_shown(likely, words)) if likely else ""
        return words("terminal.next.init", source=source, candidates=names)
    if report["open"]:
        first = next_round(report)[0]["element"]
        others = count_rows(report["open"]).elements - 1
        more = words("terminal.more", n=others) if others else ""
        return words("terminal.next.review", element=shown_name(first), more=more)
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
    return next((rank for rank, sensor in enumerate(SENSORS) if sensor in words), len(SENSORS))
