"""What the enforced view adds, as lines for the terminal (rule S6)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.called_alike import named
from rosprivacy.report.naming import shown_name
from rosprivacy.report.terminal.finding_lines import details

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.terminal.wrapped import Line


def enforced_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Yield what remains if nodes do not keep to their profiles; nothing where nobody asked."""
    if "enforced" not in report:
        return
    added = report["enforced"]["added"]
    yield "", ""
    yield words("tty.enforced", findings=words.count(len(added), "tty.finding")), "bold"
    if elements := [shown_name(element) for element in report["enforced"].get("open", ())]:
        yield words.count(len(elements), "tty.enforced.unreviewed", names=named(elements, words)), ""
    by_id = {entry["finding"]["id"]: entry for entry in added}

    def more(finding: Mapping[str, Any]) -> Iterator[Line]:
        yield from ((f"   {said}", "") for said in _said(report, by_id[finding["id"]], words))

    yield from details(report, [entry["finding"] for entry in added], words, more)


def _said(report: Mapping[str, Any], entry: Mapping[str, Any], words: Words) -> Iterator[str]:
    """Where it is, what makes it possible, what takes it away: splitting first."""
    if entry.get("plain"):
        yield words("tty.enforced.plain")
    if entry.get("beyond") == []:
        yield words("tty.enforced.types")
    if robots := entry.get("robots"):
        everybody = words.count(report["fleet"]["robots"], "ofrobots")
        yield words("tty.enforced.on", n=str(len(robots)), robots=everybody, names=named(robots, words))
    if opened := entry.get("opened_by"):
        yield words("tty.enforced.opened", lines=", ".join(f"{shown(one['file'])}:{one['line']}" for one in opened))
    if not entry["enclaves"]:
        return
    yield words("tty.enforced.by", enclaves=_listed(entry["enclaves"]))
    key = "tty.enforced.split" if entry["split"] else "tty.enforced.no.split"
    yield words(key, enclaves=_listed(entry["split"]))
    if move := entry.get("move"):
        yield words("tty.enforced.move", profile=shown(move["profile"]), enclave=shown(move["enclave"]))
    if entry.get("deny"):
        yield words("tty.enforced.deny", lines="; ".join(_line(line, words) for line in entry["deny"]))
        lost = [f"{shown_name(one['node'])} {one['role']} {shown_name(one['channel'])}" for one in entry["loses"]]
        if lost:
            yield words("tty.enforced.loses", rights="; ".join(lost))


def _line(line: Mapping[str, Any], words: Words) -> str:
    said = {key: shown(line[key]) for key in ("role", "enclave", "file")}
    return words("tty.enforced.line", channel=shown_name(line["channel"]), **said)


def _listed(enclaves: list[str]) -> str:
    return ", ".join(map(shown, enclaves))
