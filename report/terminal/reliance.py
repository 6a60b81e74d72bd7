"""What the answer hangs on, in the report for the terminal: what there would be if one statement were wrong.

In: a JSON document of the contract. Out: how many statements there are, and the worst; with ``-v`` all of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.called_alike import both
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words

Line = tuple[str, str]  # text, style
WORST = 3
FEW = 3  # findings, questions and elements that are named in a line


def reliance_lines(report: Mapping[str, Any], words: Words, *, verbose: bool) -> Iterator[Line]:
    """Return what the answer hangs on: a part of the report by itself."""
    rows = report.get("hangs_on", ())
    for one in report.get("not_asked", ()):
        yield "", ""
        yield words("tty.hangs.not.asked", option=one["option"]), ""
    if not rows:
        return
    own = sum(not row["shipped"] for row in rows)
    counts = [(own, "tty.hangs.own"), (len(rows) - own, "tty.hangs.shipped")]
    yield "", ""
    yield words("tty.hangs", what=both([words.count(n, key) for n, key in counts if n], words)), "bold"
    worst = [row for row in rows if not row["shipped"] and (row["findings"] or row["perhaps"])]
    told = rows if verbose else worst[:WORST]
    for row in told:
        yield f"   {_row(row, None if verbose else FEW, words)}", "yellow" if row["findings"] else ""
    if len(told) < len(rows):
        yield f"   {words('tty.hangs.wrong')}", "dim"


def _row(row: Mapping[str, Any], most: int | None, words: Words) -> str:
    ends = (_some(map(shown_name, row[end]), FEW, words) for end in ("elements", "to") if row[end])
    return words(
        "tty.hangs.line",
        place=f"{shown(row['file'])}:{row['line']}",
        ends=" -> ".join(ends),
        said=_says(row) + (words("tty.by.glob") if row["glob"] else ""),
        by=words("tty.hangs.by", author=shown(row["author"])) if row["author"] else "",
        why=f" ({shown(row['why'])})" if row["why"] else "",
        opened=_opened(row, most, words),
    )


def _says(row: Mapping[str, Any]) -> str:
    """What the statement says, as a label file writes it."""
    names = ", ".join(row["categories"])
    if row["role"] == "sanitizer":
        return "absent" if row["method"] == "absent" else f"sanitizer: {{{names}: {row['method']}}}"
    said = {"no-leak": "leak: none", "no-source": "source: none"}.get(row["role"], row["role"])
    return f"{said}: [{names}]" if names else said


def _opened(row: Mapping[str, Any], most: int | None, words: Words) -> str:
    if row["refused"]:
        return words("u.refused", why=shown(row["refused"]))
    if row["perhaps"]:
        return words("tty.not.worked.out")
    asked = (f"{shown_name(one['element'])} ({', '.join(one['categories'])})" for one in row["questions"])
    parts = [_some((_finding(opening, words) for opening in row["findings"]), most, words)]
    parts += [words("tty.hangs.asked", elements=_some(asked, most, words))] if row["questions"] else []
    return "; ".join(filter(None, parts))


def _finding(opening: Mapping[str, Any], words: Words) -> str:
    category = opening["category"]
    data = words("tty.hidden", kind=category) if opening["pseudonymised"] else category
    more = [] if opening["kind"] == "disclosure" else [words(f"finding.{opening['kind']}")]
    more += [words("u.dismissed")] if opening["dismissed"] else []
    more += [] if opening["new"] else [words("u.worse")]
    told = words.pair(data, f"{shown_name(opening['source'])} -> {shown_name(opening['leak'])}")
    return f"{told} ({words.row(more)})" if more else told


def _some(texts: Iterable[str], most: int | None, words: Words) -> str:
    """Some of them, each once: the legs of a service have one name."""
    distinct = list(dict.fromkeys(texts))
    left_out = len(distinct) - most if most is not None else 0
    return words.row(distinct[:most]) + (words("tty.more", n=left_out) if left_out > 0 else "")
