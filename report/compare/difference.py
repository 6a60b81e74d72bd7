"""Two snapshots -> what is new, gone and changed, as JSON ``rosprivacy.diff/1`` or as lines.

In: snapshots. Out: a document; whether anything in it is worse than before; text.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.compare.changes import scope
from rosprivacy.report.compare.matching import compare

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.compare.matching import Change, Changes
    from rosprivacy.report.compare.snapshot import Snapshot

FORMAT = "rosprivacy.diff/1"
SECTIONS = ("findings", "robots", "grants", "elements")
NAMES = {
    "findings": ("kind", "category", "source", "leak", "across", "beside"),
    "robots": ("robot",),
    "grants": ("policy", "enclave", "node", "role", "kind", "name"),
    "elements": ("robot", "kind", "name", "leg"),
}
SIGNS = {"new": "+", "gone": "-", "changed": "~"}


def difference(before: Snapshot, after: Snapshot) -> dict[str, Any]:
    """Return the document: what differs, by section; ``None`` for grants if the policies of one are not at hand."""
    found: dict[str, Any] = {"format": FORMAT, "verdict": {"before": before.verdict, "after": after.verdict}}
    for section in SECTIONS:
        ours, theirs = getattr(before, section), getattr(after, section)
        found[section] = None if ours is None or theirs is None else _section(compare(ours, theirs), NAMES[section])
    for row in [*found["findings"]["new"], *found["findings"]["changed"]]:
        row["allowed_at"] = after.lines.get(tuple(row.get(name, "") for name in NAMES["findings"]), "")
    asked = scope(before.assumptions, after.assumptions)
    found["asked_otherwise"] = [{"what": what, "before": old, "after": new} for what, old, new in asked]
    found["worse"] = worse(found)
    return found


def _section(changes: Changes, names: tuple[str, ...]) -> dict[str, Any]:
    def row(change: Change) -> dict[str, Any]:
        key = {name: part for name, part in zip(names, change.key, strict=True) if part}
        return {**key, "before": change.before, "after": change.after}

    return {what: [row(change) for change in getattr(changes, what)] for what in SIGNS}


def worse(document: Mapping[str, Any]) -> bool:
    """Return whether there is a finding that was not, or not as it is or not on so many robots.

    A finding that is dismissed is none here, since another one stands for it; nor is one that is accepted.
    """
    findings = document["findings"]
    if any(not (row["after"]["dismissed"] or row["after"]["accepted"]) for row in findings["new"]):
        return True
    return any(_worse(row["before"], row["after"]) for row in findings["changed"])


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
    for row in document["asked_otherwise"]:
        yield shown(f"asked otherwise: {row['what']}: {row['before']} before, {row['after']} now")
    for section in SECTIONS:
        changes = document[section]
        if changes is None:
            yield f"{section}: not compared, the policies of one side are not at hand"
            continue
        if any(changes.values()):
            yield ""
            yield f"{section}: " + ", ".join(f"{len(rows):,} {what}" for what, rows in changes.items() if rows)
        for what, sign in SIGNS.items():
            for row in changes[what]:
                yield f"  {sign} {shown(_title(section, row))}"
                yield from (f"      {shown(line)}" for line in _details(row, what))
    if not differs(document):
        yield "nothing differs"


def _title(section: str, row: Mapping[str, Any]) -> str:
    if section == "findings":
        across = " from one robot to another" if row.get("across") else ""
        kind = "" if row["kind"] == "disclosure" else f"{row['kind']}, "
        return f"{kind}{row['category']}: {row['source']} -> {row['leak']}{across}"
    if section == "robots":
        return str(row["robot"])
    if section == "grants":
        place = " ".join(row[key] for key in ("policy", "enclave") if row.get(key))
        return f"{row['node']} {row['role']} {row['kind']} {row['name']}  ({place})"
    robot = f"{row['robot']}:" if row.get("robot") else ""
    return " ".join(part for part in (row["kind"], robot + row["name"], row.get("leg", "")) if part)


def _details(row: Mapping[str, Any], what: str) -> Iterator[str]:
    """What is said of something new, and what of something that changed is not the same."""
    before, after = row["before"] or {}, row["after"] or {}
    if what == "gone":
        return
    for key in sorted({*before, *after}):
        ours, theirs = before.get(key), after.get(key)
        if what == "new":
            if theirs:
                yield f"{key}: {_text(theirs)}"
        elif isinstance(ours, list) and isinstance(theirs, list) and key != "way":
            added, lost = sorted(set(theirs) - set(ours)), sorted(set(ours) - set(theirs))
            signs = [f"+ {', '.join(added)}"] * bool(added) + [f"- {', '.join(lost)}"] * bool(lost)
            if signs:
                yield f"{key}: {'; '.join(signs)}"
        elif ours != theirs:
            yield f"{key}: {_text(ours)} before, {_text(theirs)} now"


def _text(value: Any) -> str:
    if isinstance(value, list):
        return " -> ".join(value) if value and str(value[0]).startswith("/") else ", ".join(map(str, value))
    return {True: "yes", False: "no", None: "nothing"}.get(value, str(value))
