"""What keeps data from going on, for the terminal: DENY lines, standard channels, message types, labels, globs.

In: a JSON document of the contract; ``WhyNot`` facts. Out: lines of what is assumed and on whose word, and parts of the
report by themselves; with ``-v`` one line for each row (rules S5, S7, S12, S13, S15). Why data does not get from one
element to another is told in the same words.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import CANNOT
from rosprivacy.analysis.whatif.why_not import NO_LEAK, NO_SOURCE, THROUGH
from rosprivacy.report.document.ledger import hanging_labels
from rosprivacy.report.naming import infrastructure_file, joined_by_and, opening_text, shown_name
from rosprivacy.report.text.line_parts import listed, place, titled

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.whatif.why_not import Obstacle, WhyNot
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.text.line_parts import Line

SHIPPED = "rosprivacy:standard"
WORST = 3  # statements on which something hangs
FEW = 3  # findings, questions and elements that are named in a line


def denied_lines(report: Mapping[str, Any], words: Words, *, limit: int | None) -> Iterator[Line]:
    """Return the denied flows; ``limit`` of them, all if None."""
    flows = report["denied"]
    if flows:
        yield from titled(words("terminal.denied", n=len(flows)), (_denied(flow, words) for flow in flows[:limit]))
    if limit is not None and len(flows) > limit:
        yield f"   {words('terminal.rest', n=len(flows) - limit)}", "dim"


def _denied(flow: Mapping[str, Any], words: Words) -> Line:
    allowed, denied = (_places(flow[side], words) for side in ("allowed_by", "denied_by"))
    line = words("terminal.denied.line", ends=_ends(flow), role=flow["role"], allowed=allowed, denied=denied)
    return f"   {line}", ""


def _places(rows: Iterable[Mapping[str, Any]], words: Words) -> str:
    places = list(dict.fromkeys(map(place, rows)))
    return places[0] + words("terminal.more", n=len(places) - 1) if len(places) > 1 else places[0]


def _ends(row: Mapping[str, Any], start: str = "source", end: str = "target") -> str:
    return f"{shown_name(row[start])} -> {shown_name(row[end])}"


def standard_lines(report: Mapping[str, Any], limit: int | None, words: Words) -> Iterator[Line]:
    """Return which standard channels were taken as mundane, on which file's word, and what data stops there."""
    assumptions = report["assumptions"]
    taken = assumptions["standard_channels"]
    if not taken:
        yield f"   {words('terminal.standard.none')}", ""
        return
    proposed = infrastructure_file(assumptions)
    more = words("terminal.standard.proposed", file=proposed) if proposed else ""
    channels = words.count(report["standard_channels"], "terminal.standard")
    by = "terminal.standard.shipped" if taken["file"] == SHIPPED else "terminal.standard.by"
    text = words(by, channels=channels, more=more, file=shown(taken["file"]), sha=taken["sha256"][:12])
    yield f"   {text}", ""
    rows = assumptions.get("standard_channels_reached", ())  # documents of earlier versions do not say
    reached = [f"{shown_name(row['element'])} ({', '.join(row['categories'])})" for row in rows]
    keeping = [_ends(row, "element", "keeps_from") for row in rows if "keeps_from" in row]
    unchanged = [shown_name(element) for element in assumptions.get("standard_channels_unchanged", ())]
    for what, names in (("reached", reached), ("keeps", keeping), ("unchanged", unchanged)):
        if names:
            text = words(f"terminal.standard.{what}", n=len(names), names=listed(names, limit, words))
            yield f"   {text}", "yellow" if what == "unchanged" else ""


def type_lines(report: Mapping[str, Any], limit: int | None, words: Words) -> Iterator[Line]:
    """Return which files of types were read, how many flows types close, and the findings that only these close."""
    assumptions = report["assumptions"]
    for file in assumptions.get("types", ()):
        start, end = (words.moment(shown(file["observed"][at])) for at in ("from", "to"))
        times = words("terminal.types.times", start=start, end=end) if start else ""
        yield f"   {words('terminal.types.file', file=shown(file['file']), sha=file['sha256'][:12], times=times)}", ""
    if "type_limits" not in assumptions:
        return
    limits = assumptions["type_limits"]
    if limits is None:
        yield f"   {words('terminal.types.none')}", ""
        return
    flows = words.count(limits["flows"], "terminal.types.flows")
    yield f"   {words('terminal.types.limits', flows=flows, file=shown(limits['file']), sha=limits['sha256'][:12])}", ""
    closed = [f"{row['category']}: {_ends(row, end='leak')}" for row in assumptions.get("closed_by_types", ())]
    if closed:
        names = listed(closed, limit, words, "; ")
        yield f"   {words.count(len(closed), 'terminal.types.closed')} {names}", "yellow"


def absent_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return the nodes of which labels say that they are not on the robot."""
    for row in report["assumptions"].get("absent", ()):
        yield f"   {words('terminal.absent', element=shown_name(row['element']), why=shown(row['why']))}", ""


def overruled_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return how many sources and leaks labels say that other labels take away."""
    rows = report["assumptions"].get("overruled", ())
    if rows:
        yield f"   {words.count(len(rows), 'terminal.overruled')}", "yellow"


def glob_warnings(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return what ``Assumed`` says of globs that decide more than a person may see."""
    for row in report["assumptions"].get("globs", ()):
        if row["warning"]:
            why = words(f"terminal.glob.{row['warning']}")
            yield f"   {words('terminal.glob.warning', row=_glob(row, words), why=why)}", "bold yellow"


def glob_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return a line for each glob of the label files: what it decides and closes."""
    rows = report["assumptions"].get("globs", ())
    if rows:
        yield from titled(words("terminal.globs", n=len(rows)), ((f"   {_glob(row, words)}", "") for row in rows))


def _glob(row: Mapping[str, Any], words: Words) -> str:
    flows = row.get("flows", 0)
    decided = [words.count(row["elements"], "element")] if row["elements"] or not flows else []
    decided += [words.count(flows, "flow")] if flows else []
    parts = [words("terminal.glob.decides", what=joined_by_and(decided, words))]
    parts += [words("terminal.glob.closed", n=row["closed"])] if row["closed"] else []
    if row.get("flows_closed"):
        parts.append(words("terminal.glob.along", flows=words.count(row["flows_closed"], "flow")))
    parts += [words("terminal.glob.reviewed", n=row["reviewed"])] if row["reviewed"] else []
    behind = _leak_and_open(row, words)
    lies = words("terminal.glob.behind", places=joined_by_and(behind, words)) if behind else ""
    return words("terminal.glob", place=place(row), says=", ".join(row["says"]), parts=", ".join(parts), behind=lies)


def _leak_and_open(row: Mapping[str, Any], words: Words) -> list[str]:
    """What lies behind: a leak, and an element that nobody has reviewed."""
    places = [words("terminal.the.leak", leak=shown_name(row["leak"]))] if row["leak"] else []
    return places + ([words("terminal.the.open", element=shown_name(row["open"]))] if row["open"] else [])


def taken_away_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return what ``Assumed`` says: how much was taken away, by what, and how much of it closed a path."""
    taken = report["assumptions"]["taken_away_by"]
    if not taken:
        return
    parts = [words.count(number, f"terminal.by.{by}") for by, number in taken.items()]
    yield f"   {words('terminal.taken', what=', '.join(parts))}", ""
    closing = sum(map(_closes, report["taken_away"]))
    if closing:
        yield f"   {words('terminal.closing', n=closing)}", "yellow"


def hanging_lines(report: Mapping[str, Any], limit: int | None, words: Words) -> Iterator[Line]:
    """Return on which labels it hangs that no leak was found: data gets there and ends on their word (rule S12)."""
    labels = [
        f"{at} ({shown_name(row['element'])} {_row_says(row, words)}{_leak_behind(row, words)})"
        for at, row in hanging_labels(report)
    ]
    if labels:
        text = words.count(len(labels), "terminal.hanging", labels=listed(labels, limit, words))
        yield f"   {text}", "bold yellow"


def _row_says(row: Mapping[str, Any], words: Words) -> str:
    return words(f"terminal.says.{row['by']}")


def _leak_behind(row: Mapping[str, Any], words: Words) -> str:
    return words("terminal.leak.behind", leak=shown_name(row["leak"])) if row["leak"] else ""


def ledger_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return a line for each row that closed a path: what, where, on whose word, and what lies behind."""
    rows = [row for row in report["taken_away"] if _closes(row)]
    if rows:
        yield from titled(
            words("terminal.ledger", n=len(rows)), ((f"   {_ledger_row(row, words)}", "") for row in rows)
        )


def _closes(row: Mapping[str, Any]) -> bool:
    return bool(row["leak"] or row["open"] or row["perhaps"])


def _ledger_row(row: Mapping[str, Any], words: Words) -> str:
    ends = " -> ".join(shown_name(row[end]) for end in ("element", "to") if row[end])
    lines = ", ".join(map(place, row["places"]))
    kinds = ", ".join(row["categories"])
    says = _row_says(row, words) + (words("terminal.by.glob") if row["glob"] else "")
    says += f" ({shown(row['note'])})" if row["by"] == "outdone" else ""
    return words(
        "terminal.ledger.line",
        where=words("terminal.ledger.at", kinds=kinds, ends=ends) if ends else kinds,
        said=says,
        lines=words("terminal.ledger.lines", lines=lines) if lines else "",
        behind=_behind(row, words),
    )


def _behind(row: Mapping[str, Any], words: Words) -> str:
    """What data would get to."""
    if row["by"] == "decision":
        return words("terminal.reaches.finding", leak=shown_name(row["leak"]), id=shown(row["note"]))
    if row["by"] == "restriction":
        return words("terminal.reaches", leak=shown_name(row["leak"]))
    places = _leak_and_open(row, words)
    return (
        words("terminal.without", places=joined_by_and(places, words)) if places else words("terminal.not.worked.out")
    )


def reliance_lines(report: Mapping[str, Any], words: Words, *, verbose: bool) -> Iterator[Line]:
    """Return what the answer hangs on: what there would be if one statement were wrong; the worst, or all of them."""
    rows = report.get("hangs_on", ())
    for row in report.get("not_asked", ()):
        yield "", ""
        yield words("terminal.hangs.not.asked", option=row["option"]), ""
    if not rows:
        return
    own = sum(not row["shipped"] for row in rows)
    counts = [(own, "terminal.hangs.own"), (len(rows) - own, "terminal.hangs.shipped")]
    worst = [row for row in rows if not row["shipped"] and (row["findings"] or row["perhaps"])]
    listed_rows, most = (rows, None) if verbose else (worst[:WORST], FEW)
    yield from titled(
        words("terminal.hangs", what=joined_by_and([words.count(n, key) for n, key in counts if n], words)),
        ((f"   {_statement(row, most, words)}", "yellow" if row["findings"] else "") for row in listed_rows),
    )
    if len(listed_rows) < len(rows):
        yield f"   {words('terminal.hangs.wrong')}", "dim"


def _statement(row: Mapping[str, Any], limit: int | None, words: Words) -> str:
    ends = (_distinct(map(shown_name, row[end]), FEW, words) for end in ("elements", "to") if row[end])
    return words(
        "terminal.hangs.line",
        place=place(row),
        ends=" -> ".join(ends),
        said=_as_written(row) + (words("terminal.by.glob") if row["glob"] else ""),
        by=words("terminal.hangs.by", author=shown(row["author"])) if row["author"] else "",
        why=f" ({shown(row['why'])})" if row["why"] else "",
        opened=_opened(row, limit, words),
    )


def _as_written(row: Mapping[str, Any]) -> str:
    """What the statement says, as a label file writes it."""
    names = ", ".join(row["categories"])
    if row["role"] == "sanitizer":
        return "absent" if row["method"] == "absent" else f"sanitizer: {{{names}: {row['method']}}}"
    role = {"no-leak": "leak: none", "no-source": "source: none"}.get(row["role"], row["role"])
    return f"{role}: [{names}]" if names else role


def _opened(row: Mapping[str, Any], limit: int | None, words: Words) -> str:
    if row["refused"]:
        return words("reliance.refused", why=shown(row["refused"]))
    if row["perhaps"]:
        return words("terminal.not.worked.out")
    questions = (f"{shown_name(of['element'])} ({', '.join(of['categories'])})" for of in row["questions"])
    parts = [_distinct((_opening(opening, words) for opening in row["findings"]), limit, words)]
    parts += [words("terminal.hangs.asked", elements=_distinct(questions, limit, words))] if row["questions"] else []
    return "; ".join(filter(None, parts))


def _opening(opening: Mapping[str, Any], words: Words) -> str:
    category = opening["category"]
    data = words("terminal.hidden", kind=category) if opening["pseudonymised"] else category
    return opening_text(opening, words.pair(data, _ends(opening, end="leak")), words)


def _distinct(texts: Iterable[str], limit: int | None, words: Words) -> str:
    """Return the first of some texts, each once: the legs of a service have one name."""
    distinct = list(dict.fromkeys(texts))
    left_out = len(distinct) - limit if limit is not None else 0
    return words.row(distinct[:limit]) + (words("terminal.more", n=left_out) if left_out > 0 else "")


SILENT = {
    NO_SOURCE: "no label says that it brings in {category}",
    NO_LEAK: "no label says that it lets {category} out",
    THROUGH: "its label names other channels for {category}",
}


def lines(answers: Iterable[WhyNot]) -> Iterator[str]:
    """Return the answers in sentences."""
    for answer in answers:
        ends = f"{answer.category} from {shown(answer.source.full_name)} to {shown(answer.leak.full_name)}"
        if answer.finding:
            yield f"{ends}: it gets there, finding {answer.finding.id}"
        elif not answer.path:
            yield f"{ends}: no chain of policy lines or stated flows leads there"
        else:
            fewest = f"of all paths this one has the fewest obstacles ({len(answer.obstacles)})"
            yield f"{ends}: it does not get there; {fewest}"
        if answer.path:
            yield f"   {' -> '.join(shown(element.full_name) for element in answer.path)}"
        for obstacle in answer.obstacles:
            yield f"   {_obstacle(obstacle)}"
        if not answer.finding:
            yield f"   as things are, {answer.category} gets to {answer.reached:,} elements"


def _obstacle(obstacle: Obstacle) -> str:
    ends = " -> ".join(shown(end.full_name) for end in (obstacle.element, obstacle.to) if end)
    if obstacle.by in SILENT:
        return f"at {ends}: {SILENT[obstacle.by].format(category=obstacle.category)}"
    where = ", ".join(f"{shown(place.file)}:{place.line}" for place in obstacle.places)
    says = "its type cannot carry" if obstacle.by == CANNOT else f"{obstacle.by} for"
    return f"at {ends}: {says} {obstacle.category}, {where}"
