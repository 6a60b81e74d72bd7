"""Two snapshots -> what is new, gone and changed, as JSON ``rosprivacy.diff/1``, as lines or as Markdown.

In: snapshots; a document ``rosprivacy.usage/1`` of what is granted against what was seen in use. Out: a document;
whether anything in it is worse than before; text, of a bounded length as a comment on a pull request. Names come from
anybody's files, so they are made printable, in Markdown shown as code, and can neither link nor mention anybody.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Rank
from rosprivacy.analysis.text import blanked, counted
from rosprivacy.report.compare.changes import scope
from rosprivacy.report.compare.matching import compare

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from rosprivacy.report.compare.matching import ElementChange, StateChanges
    from rosprivacy.report.compare.snapshot import CodeState, Snapshot

FORMAT = "rosprivacy.diff/1"
OF_CODE = ("ways_out", "gaps")
SECTIONS = ("findings", *OF_CODE, "doubts", "robots", "grants", "elements")
BETTER_FIRST = ("no-leak-found", "undetermined", "leak")
SIDES = (("before", "before"), ("now", "after"))
RANKS = (Rank.RIDES, Rank.BREAKS)
NAMES = {
    "findings": ("kind", "category", "source", "leak", "across", "beside"),
    "ways_out": ("sort", "node", "name", "channel"),
    "gaps": ("sort", "file", "about"),
    "doubts": ("doubt", "robot", "kind", "name", "leg", "file", "message"),
    "robots": ("robot",),
    "grants": ("policy", "enclave", "node", "role", "kind", "name"),
    "elements": ("robot", "kind", "name", "leg"),
}
NOT_COMPARED = {
    "ways_out": "one side is no source code",
    "gaps": "one side is no source code",
    "grants": "the policies of one side are not at hand",
    "doubts": "one side was saved by a version that has no list of them",
}
NEVER = {"times": 0}
SIGNS = {"new": "+", "gone": "-", "changed": "~"}  # by key of a section


def difference(before: Snapshot, after: Snapshot) -> dict[str, Any]:
    """Return the document: what differs, by section.

    ``None`` stands for grants if the policies of one are not at hand, and for doubts if one has no list of them.
    """
    found: dict[str, Any] = {"format": FORMAT, "verdict": {"before": before.verdict, "after": after.verdict}}
    found["sentence"] = {"before": before.sentence, "after": after.sentence}
    found |= _code_sections(before.code, after.code)
    for section in (name for name in SECTIONS if name not in OF_CODE):
        ours, theirs = getattr(before, section), getattr(after, section)
        found[section] = None if ours is None or theirs is None else _section(compare(ours, theirs), NAMES[section])
    for row in [*found["findings"]["new"], *found["findings"]["changed"]]:
        row["allowed_at"] = after.lines.get(tuple(row.get(name, "") for name in NAMES["findings"]), "")
    asked = scope(before.assumptions, after.assumptions)
    found["asked_otherwise"] = [{"what": what, "before": old, "after": new} for what, old, new in asked]
    labelled = bool(before.assumptions["labels"] or after.assumptions["labels"])
    found["labelled"], found["followed"] = labelled, {"before": before.followed, "after": after.followed}
    found["worse"] = worse(found) or _doubts_worse(found["doubts"], before)
    return found


def _code_sections(before: CodeState | None, after: CodeState | None) -> dict[str, Any]:
    """What differs in source code, with its lines; no section of one side only, and empty ones of no code."""
    sections: dict[str, Any] = {"source_code": bool(before and after)}
    for section in OF_CODE:
        if not (before and after):
            alike = before is after
            sections[section] = {what: [] for what in SIGNS} if alike else None
            continue
        changes = compare(getattr(before, section), getattr(after, section), made_up=False)
        sections[section] = _section(changes, NAMES[section])
        for what, rows in sections[section].items():
            places = (before if what == "gone" else after).places
            for row in rows:
                row["at"] = places[tuple(row.get(name, "") for name in NAMES[section])]
    return sections


def _section(changes: StateChanges, names: tuple[str, ...]) -> dict[str, Any]:
    def row(change: ElementChange) -> dict[str, Any]:
        key = {name: part for name, part in zip(names, change.key, strict=True) if part}
        return {**key, "before": change.before, "after": change.after}

    by_key = {"new": changes.new, "gone": changes.removed, "changed": changes.changed}
    return {key: [row(change) for change in rows] for key, rows in by_key.items()}


def worse(document: Mapping[str, Any]) -> bool:
    """Return whether the verdict is worse, a finding is new, in a worse form, or on more robots, or code has more.

    More ways out, or more gaps: what code could not be read for may be a way out too (rule S16).

    A finding that is dismissed is none here, since another one stands for it; nor is one that is accepted. Verdicts are
    compared only where data was followed on both sides (rule S12).
    """
    findings, verdict = document["findings"], document["verdict"]
    if all(document["followed"].values()) and _later(BETTER_FIRST, verdict["before"], verdict["after"]):
        return True
    if any(not (row["after"]["dismissed"] or row["after"]["accepted"]) for row in findings["new"]):
        return True
    if any(_increased(row) for section in OF_CODE for rows in (document[section] or {}).values() for row in rows):
        return True
    return any(_worse(row["before"], row["after"]) for row in findings["changed"])


def incomparable(document: Mapping[str, Any]) -> bool:
    """Return whether labels are given and no data was followed on a side: then it is no comparison (rule S12)."""
    return document["labelled"] and not all(document["followed"].values())


def _doubts_worse(doubts: Mapping[str, Any] | None, before: Snapshot) -> bool:
    """Whether a doubt is new, or of a higher rank, on an element that was neither open nor doubted (rule S12)."""
    if doubts is None:
        return False
    known = {key[1:] for key in before.doubts or ()}
    known |= {(*key, "", "") for key, facts in before.elements.items() if facts.get("open")}
    names = NAMES["doubts"][1:]
    new = any(tuple(row.get(name, "") for name in names) not in known for row in doubts["new"])
    return new or any(_later(RANKS, row["before"]["rank"], row["after"]["rank"]) for row in doubts["changed"])


def _later(order: tuple[str, ...], before: str, after: str) -> bool:
    return order.index(after) > order.index(before)


def _increased(row: Mapping[str, Any]) -> bool:
    """Whether a way out or a gap of code is there more often than before."""
    return bool((row["after"] or NEVER)["times"] > (row["before"] or NEVER)["times"])


def _worse(before: Mapping[str, Any], after: Mapping[str, Any]) -> bool:
    if after["dismissed"] or after["accepted"]:
        return False
    if before["dismissed"] or before["accepted"] or (before["pseudonymised"] and not after["pseudonymised"]):
        return True
    if set(after.get("robots", ())) - set(before.get("robots", ())):
        return True
    return any(
        after.get("findings", 1) - after.get(of_them, 0) > before.get("findings", 1) - before.get(of_them, 0)
        for of_them in ("of_them_dismissed", "of_them_accepted", "of_them_pseudonymised")
    )


def differs(document: Mapping[str, Any]) -> bool:
    """Return whether anything differs at all."""
    return any(any(document[section].values()) for section in SECTIONS if document[section] is not None)


def difference_lines(document: Mapping[str, Any]) -> Iterator[str]:
    """Return the document as lines for people."""
    before, after = document["verdict"]["before"], document["verdict"]["after"]
    yield f"verdict: {after}" if before == after else f"verdict: {before} before, {after} now"
    yield from (f"{when}: {document['sentence'][side]}" for when, side in SIDES)
    yield from remarks(document)
    for row in document["asked_otherwise"]:
        yield shown(f"asked otherwise: {row['what']}: {row['before']} before, {row['after']} now")
    for section in SECTIONS:
        changes = document[section]
        if changes is None:
            yield f"{_words(section)}: not compared, {NOT_COMPARED[section]}"
            continue
        if any(changes.values()):
            yield ""
            yield f"{_words(section)}: " + ", ".join(f"{len(rows):,} {what}" for what, rows in changes.items() if rows)
        for what, sign in SIGNS.items():
            for row in changes[what]:
                yield f"  {sign} {shown(title(section, row))}"
                yield from (f"      {shown(line)}" for line in _details(row, what))
    if not differs(document):
        yield "nothing differs"


def remarks(document: Mapping[str, Any]) -> Iterator[str]:
    """Return what has to be known before anything is read out of a comparison (rule S12)."""
    if not document["labelled"]:
        compared = "grants, ways out and gaps" if document["source_code"] else "grants"
        yield f"no label is given, so no data was followed: {compared} are compared, and nothing else"
    elif incomparable(document):
        sides = [when for when, side in SIDES if not document["followed"][side]]
        yield f"no data was followed {' and '.join(sides)}: no label names a source there, so findings are not compared"


def title(section: str, row: Mapping[str, Any]) -> str:
    """Return what a row of a section is about."""
    if section == "findings":
        across = " from one robot to another" if row.get("across") else ""
        kind = "" if row["kind"] == "disclosure" else f"{row['kind']}, "
        return f"{kind}{row['category']}: {row['source']} -> {row['leak']}{across}"
    if section in OF_CODE:
        return _code_title(section, row)
    if section == "doubts":
        robot = f"{row['robot']}:" if row.get("robot") else ""
        about = (
            [f"{robot}{row['name']}"] if row.get("name") else [row[key] for key in ("file", "message") if key in row]
        )
        return ": ".join([row["doubt"], *about])
    if section == "robots":
        return str(row["robot"])
    if section == "grants":
        place = " ".join(row[key] for key in ("policy", "enclave") if row.get(key))
        return f"{row['node']} {row['role']} {row['kind']} {row['name']}  ({place})"
    robot = f"{row['robot']}:" if row.get("robot") else ""
    return " ".join(part for part in (row["kind"], robot + row["name"], row.get("leg", "")) if part)


def _code_title(section: str, row: Mapping[str, Any]) -> str:
    if section == "gaps":
        return f"{row['file']}: {row['sort']}: {row['about']}"
    channel = f", {row['channel']}" if row.get("channel") else ""
    return f"{row.get('node', 'a file')} -> {row['name']} ({row['sort']}){channel}"


def _details(row: Mapping[str, Any], sort: str) -> Iterator[str]:
    """What is said of something new, and what of something that changed is not the same."""
    before, after = row["before"] or {}, row["after"] or {}
    if "at" in row:
        yield f"at {', '.join(row['at'])}"
    if sort == "gone":
        return
    for key in sorted({*before, *after}):
        ours, theirs = before.get(key), after.get(key)
        if sort == "new":
            if theirs and theirs != 1:
                yield f"{key}: {_text(theirs)}"
        elif isinstance(ours, list) and isinstance(theirs, list) and key != "way":
            added, lost = sorted(set(theirs) - set(ours)), sorted(set(ours) - set(theirs))
            signs = [f"+ {', '.join(added)}"] * bool(added) + [f"- {', '.join(lost)}"] * bool(lost)
            if signs:
                yield f"{key}: {'; '.join(signs)}"
        elif ours != theirs:
            yield f"{key}: {_text(ours)} before, {_text(theirs)} now"


def _words(section: str) -> str:
    return section.replace("_", " ")


def _text(value: Any) -> str:
    if isinstance(value, list):
        return " -> ".join(value) if value and str(value[0]).startswith("/") else ", ".join(map(str, value))
    return {True: "yes", False: "no", None: "nothing"}.get(value, str(value))


SHOWN = 20  # of a list; a comment has a limit
SENTENCE = 2_000  # characters of the verdict with its doubts
LONGEST = 120  # characters of a name
LISTS = (("New paths to assess", "new", "after"), ("Gone", "gone", "before"), ("Changed", "changed", "after"))
OF_CODE_LISTS = (
    ("New ways out of the code", "ways_out", "new"),
    ("Ways out at other lines too, or at fewer", "ways_out", "changed"),
    ("Ways out that are gone", "ways_out", "gone"),
    ("Newly not resolved", "gaps", "new"),
    ("Not resolved in another way", "gaps", "changed"),
    ("Resolved, or gone", "gaps", "gone"),
)
COUNTED = (*OF_CODE, "doubts", "robots", "grants", "elements")
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
    for heading, section, what in OF_CODE_LISTS:
        rows = (document[section] or {}).get(what, ())
        yield from _name(heading, [f"{title(section, row)}, at {', '.join(row['at'])}" for row in rows])
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
            yield f"{_words(section).capitalize()} are not compared: {NOT_COMPARED[section]}."
        elif any(rows.values()):
            counts = ", ".join(f"{len(found)} {what}" for what, found in rows.items() if found)
            yield f"{_words(section).capitalize()}: {counts}."


def code(text: str, limit: int = LONGEST) -> str:
    """Return text as code that cannot end early: printable, short, with no backtick in it.

    >>> code("a`b")
    "`a'b`"
    """
    plain = blanked(text, "?").replace("`", "'")
    plain = re.sub(r"\s+", " ", plain).strip() or "?"
    return f"`{plain[:limit]}{'…' if len(plain) > limit else ''}`"


WHY = {
    "no-profile": "the policies do not know the node",
    "not-granted": "no line grants it",
    "denied": "seen although denied",
}


def usage_lines(document: Mapping[str, Any]) -> Iterator[str]:
    """Return the document as lines for people."""
    yield from _usage_lines(document, shown, lambda title: title, "  ")


def usage_markdown(document: Mapping[str, Any]) -> str:
    """Return the document as Markdown."""

    def code(text: str) -> str:
        return f"`` {blanked(shown(text)).replace('`', ' ')} ``"

    return "".join(f"{line}\n" for line in _usage_lines(document, code, lambda title: f"\n**{title}**\n", "- "))


def _usage_lines(
    document: Mapping[str, Any], show: Callable[[str], str], head: Callable[[str], str], mark: str
) -> Iterator[str]:
    running, unused = document["not_granted"], document["unused"]
    yield head(f"what runs and is not granted: {len(running):,}")
    for row in running:
        denied = "".join(f" by {show(_place(line))}" for line in row.get("denied_by", ())[:1])
        yield f"{mark}{show(_grant_text(row))}: {WHY[row['why']]}{denied}; last seen {row['seen']['last']}"
    yield head(f"what is granted to nodes that ran, and was never seen: {len(unused):,}")
    for row in unused:
        yield f"{mark}{show(_grant_text(row))}: {show(_place(row))}{_reason_not_in_patch(row, document)}"
    never = document["never_seen"]
    yield head(f"nodes with a profile that were never seen, of which nothing is proposed: {len(never):,}")
    for row in never:
        yield f"{mark}{show(row['node'])}: {counted(row['grants'], 'line')}"
    yield head("assumed")
    for said in (*document["observed"], *document["gaps"]):
        yield f"{mark}{said}"
    if document["patch"]:
        yield f"{mark}a patch sets what was never seen to DENY: --patch FILE; a robot may need it another day"
    elif document["why_no_patch"]:
        yield f"{mark}no patch: {document['why_no_patch']}"


def _reason_not_in_patch(row: Mapping[str, Any], document: Mapping[str, Any]) -> str:
    """Why a line is not in the patch."""
    if row.get("hidden"):
        return "; a text without `ros2 node info --include-hidden` has no hidden names: it is not in the patch"
    if row["in_patch"] or not document["patch"]:
        return ""
    return "; not in the patch: a DENY of it would meet other lines of its enclave"


def _grant_text(row: Mapping[str, Any]) -> str:
    return f"{row['node']} {row['role']} {row['name']}"


def _place(row: Mapping[str, Any]) -> str:
    return f"{row['file']}:{row['line']}"
