"""The document of proposals -> a table for the terminal: one proposal a line, its surest reason under it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import MODEL
from rosprivacy.analysis.text import counted, printable
from rosprivacy.analysis.written_names import did_you_mean, nearest

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator, Sequence

    from rosprivacy.report.schemas.suggested import NoticeEntry, ProposalEntry, RobotEntry, SuggestionsDocument

NOTHING = "nothing to suggest: no rule speaks of what nobody has labelled"
BY_HAND = ", and it would close a finding: only by hand"
OF_ROBOTS = "Write what you accept into the label files of the robot, or of its model."
WIDEST = 50  # signs of a column
ALL_NAMES = "rosprivacy suggest without --why names all"
SHOWN = 3  # places of code in a line


def suggestion_lines(document: SuggestionsDocument) -> Iterator[str]:
    """Yield open elements first, then sources and leaks, then the others; at last how many, and what to do."""
    rows = document["suggestions"]
    yield from notice_lines(document["notices"])
    if not rows:
        yield NOTHING
        yield from _not_looked_at(document)
        return
    first = [row for row in rows if row["open"]]
    rest = [row for row in rows if not row["open"]]
    ends = [row for row in rest if row["role"] in ("source", "leak")]
    others = [row for row in rest if row["role"] not in ("source", "leak")]
    for title, group in (
        ("Open elements, in review order:", first),
        ("Sources and leaks that no label names:", ends),
        ("Other elements:", others),
    ):
        if group:
            yield title
            yield from _table(group)
            yield ""
    yield from _not_looked_at(document)
    yield from _robots(document["robots"], {row["robot"] for row in rows})
    times = Counter(row["confidence"] for row in rows)
    counts = ", ".join(f"{times[sure]} {sure}" for sure in Confidence if times[sure])
    yield f"{counted(len(rows), 'suggestion')} ({counts}): questions, no facts; nothing is applied that nobody accepts."
    if alone := sum(all(reason["ground"] == MODEL for reason in row["evidence"]) for row in rows):
        yield f"{counted(alone, 'suggestion')} of a language model alone: how good they are was not measured."
    if any(row["robot"] for row in rows):
        yield OF_ROBOTS
    else:
        yield "Answer them by single keys with --into labels.yaml --ask --by 'YOUR NAME'"
        accept = f"rosprivacy labels --accept {_accept_arguments(rows)}"
        yield f"Or write them into a label file with --into labels.yaml, then: {accept}"


def why_lines(rows: Sequence[ProposalEntry]) -> Iterator[str]:
    """Yield proposals of one element with all their reasons."""
    yield from _table(rows, whole=True)


def of_element(document: SuggestionsDocument, name: str) -> list[ProposalEntry]:
    """Return the proposals of an element, by its name; of a fleet also by ``robot:name``.

    Raises
    ------
    InputError
        If nothing is suggested of it.
    """
    rows = [row for row in document["suggestions"] if name in (row["name"], f"{row['robot']}:{row['name']}")]
    if not rows:
        names = nearest(name, sorted({row["name"] for row in document["suggestions"]}), bound=2)
        raise InputError("--why", 0, f"nothing is suggested of {shown(name)}", did_you_mean(names, ALL_NAMES))
    return rows


def _not_looked_at(document: SuggestionsDocument) -> Iterator[str]:
    """Source code that suggests nothing, and why."""
    unread = [f"{shown(one['file'])}:{one['line']}: {shown(one['problem'])}" for one in document["unread"]]
    unplaced = [f"{shown(one['uses'])} ({shown(one['file'])}:{one['line']})" for one in document["unplaced"]]
    if document["of_others"]:
        what = counted(len(document["of_others"]), "folder")
        told = _first_few([shown(one) for one in document["of_others"]])
        yield f"{what} with code of others that is not looked at (name it with --source to have it read): {told}"
    if unread:
        yield f"{counted(len(unread), 'problem')} of source code that could not be read: {_first_few(unread)}"
    if unplaced:
        what = counted(len(unplaced), "use")
        yield f"{what} of libraries in code that belongs to no node that is known here: {_first_few(unplaced)}"


def _first_few(texts: Sequence[str]) -> str:
    more = f" and {len(texts) - SHOWN} more (--format json has all)" if len(texts) > SHOWN else ""
    return ", ".join(texts[:SHOWN]) + more


def _accept_arguments(rows: Sequence[ProposalEntry]) -> str:
    """What can be accepted, in the words of the command line: what is sure together, else an element by its name."""
    sure = any(row["confidence"] != Confidence.MAY and not row["hides"] for row in rows)
    return f"{Confidence.LIKELY if sure else 'NAME'} --by 'YOUR NAME' -l labels.yaml"


def _table(rows: Sequence[ProposalEntry], *, whole: bool = False) -> Iterator[str]:
    cells = [(_full_name(row), said_of(row), row["confidence"]) for row in rows]
    widths = [min(WIDEST, max(len(row[at]) for row in cells)) for at in (0, 1)]
    for row, (name, said, sure) in zip(rows, cells, strict=True):
        kind = row["section"].removesuffix("s")
        yield f"  {kind:7} {name:{widths[0]}}  {said:{widths[1]}}  {sure}{BY_HAND if row['by_hand'] else ''}"
        reasons = list(_reasons(row))
        yield from (f"            {shown(reason)}" for reason in (reasons if whole else reasons[:1]))
        if len(reasons) > 1 and not whole:
            yield f"            {counted(len(reasons) - 1, 'more reason')}: --why {_full_name(row)}"


def _full_name(row: ProposalEntry) -> str:
    return shown(f"{row['robot']}:{row['name']}" if row["robot"] else row["name"])


def notice_lines(notices: Iterable[NoticeEntry]) -> Iterator[str]:
    """Yield a line for each notice."""
    for one in notices:
        yield f"notice: {shown(one['file'])}:{one['line']}: {printable(one['message'])}"


def _robots(robots: Iterable[RobotEntry], names: Container[str]) -> Iterator[str]:
    """What robots that are asked about stand for, where that is more than themselves."""
    for one in robots:
        if one["robot"] in names:
            model = f" of model {shown(one['model'])}" if one["model"] else ""
            alike = f", which stands for {len(one['alike'])} that are alike" if len(one["alike"]) > 1 else ""
            if model or alike:
                yield f"{shown(one['robot'])} is a robot{model}{alike}."


def said_of(row: ProposalEntry) -> str:
    """What a proposal says, in a few words.

    >>> said_of({"role": "sanitizer", "label": {"sanitizer": {"Video": "drop"}}, "kind": "Video"})
    'sanitizer of Video (drop)'
    """
    if row["role"] == "derivation":
        (made,) = row["label"]["derives"]
        return f"derives {made['to']} from {made['from']}"
    if row["role"] == "sanitizer":
        ((kind, method),) = row["label"]["sanitizer"].items()
        return f"sanitizer of {kind} ({method})"
    ((word, kinds),) = row["label"].items()
    return f"{word} {', '.join(kinds)}"


def _reasons(row: ProposalEntry) -> Iterable[str]:
    return dict.fromkeys(reason["reason"] for reason in row["evidence"])
