"""What differs between two states, as Markdown: a comment on a pull request.

In: a document ``rosprivacy.diff/1``. Out: text of a bounded length. Names come from anybody's files, so they are shown
as code, and can neither link nor mention anybody.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import blanked
from rosprivacy.report.compare.difference import NOT_COMPARED, SIDES, remarks, title

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

SHOWN = 20  # of a list; a comment has a limit
SENTENCE = 2_000  # characters of the verdict with its doubts
LONGEST = 120  # characters of a name
LISTS = (("New paths to assess", "new", "after"), ("Gone", "gone", "before"), ("Changed", "changed", "after"))
COUNTED = ("doubts", "robots", "grants", "elements")
KINDS = {
    "storage-limitation": "kept too long: ", "third-country-transfer": "leaves the EEA: ",
    "unprotected-channel": "can be read on the network: ",
}  # fmt: skip
FORMS = (("dismissed", "only through another recipient"), ("accepted", "accepted"), ("pseudonymised", "pseudonymised"))


def difference_markdown(document: Mapping[str, Any]) -> str:
    """Return the text."""
    return "\n".join([*_lines(document), ""])


def _lines(document: Mapping[str, Any]) -> Iterator[str]:
    yield "### Where personal data can go"
    yield ""
    before, after = document["verdict"]["before"], document["verdict"]["after"]
    yield f"Verdict: {code(after)}." if before == after else f"Verdict: {code(before)} before, {code(after)} now."
    yield from (f"\n{when.capitalize()}: {code(document['sentence'][side], SENTENCE)}" for when, side in SIDES)
    yield from (f"\n**{remark[:1].upper()}{remark[1:]}.**" for remark in remarks(document))
    for row in document["asked_otherwise"]:
        yield f"\nAsked otherwise: {code(row['what'])} was {code(row['before'])}, is {code(row['after'])}."
    findings = document["findings"]
    for heading, what, state in LISTS:
        rows = findings[what] if what == "changed" else [row for row in findings[what] if not row[state]["dismissed"]]
        yield from _listed(heading, rows, state)
    if not any(findings.values()):
        yield "\nNo path to assess is new, gone or changed."
    yield from _name("Newly in doubt", [title("doubts", row) for row in (document["doubts"] or {}).get("new", ())])
    yield from _name("Newly not reviewed", [title("elements", row) for row in _opened(document)])
    yield ""
    yield " ".join(_counted(document))
    yield ""
    yield "Labels are a person's word; this is no legal verdict."


def _listed(title: str, rows: Sequence[Mapping[str, Any]], state: str) -> Iterator[str]:
    if not rows:
        return
    yield f"\n**{title}: {len(rows)}**\n"
    for row in rows[:SHOWN]:
        kind = KINDS.get(row["kind"], "")
        across = ", from one robot to another" if row.get("across") else ""
        at = f", allowed at {code(row['allowed_at'])}" if row.get("allowed_at") else ""
        what = f"{kind}{code(row['category'])}: {code(row['source'])} → {code(row['leak'])}"
        yield f"- {what}{across}{_form(row, state)}{at}"
    if len(rows) > SHOWN:
        yield f"- and {len(rows) - SHOWN} more"


def _name(title: str, names: Sequence[str]) -> Iterator[str]:
    if names:
        yield f"\n**{title}: {len(names)}**\n"
        yield from (f"- {code(name)}" for name in names[:SHOWN])
        if len(names) > SHOWN:
            yield f"- and {len(names) - SHOWN} more"


def _opened(document: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """The elements that are open now and were not."""
    rows = [*document["elements"]["new"], *document["elements"]["changed"]]
    return [row for row in rows if row["after"].get("open") and not (row["before"] or {}).get("open")]


def _form(row: Mapping[str, Any], state: str) -> str:
    forms = [said for key, said in FORMS if row[state][key]]
    robots = row[state].get("robots")
    return "".join(f", {said}" for said in [*forms, *([f"on {len(robots)} robots"] if robots else [])])


def _counted(document: Mapping[str, Any]) -> Iterator[str]:
    """How much else differs."""
    for section in COUNTED:
        rows = document[section]
        if rows is None:
            yield f"{section.capitalize()} are not compared: {NOT_COMPARED[section]}."
        elif any(rows.values()):
            counts = ", ".join(f"{len(found)} {what}" for what, found in rows.items() if found)
            yield f"{section.capitalize()}: {counts}."


def code(text: str, limit: int = LONGEST) -> str:
    """Return text as code that cannot end early: printable, short, with no backtick in it.

    >>> code("a`b")
    "`a'b`"
    """
    plain = blanked(text, "?").replace("`", "'")
    plain = re.sub(r"\s+", " ", plain).strip() or "?"
    return f"`{plain[:limit]}{'…' if len(plain) > limit else ''}`"
