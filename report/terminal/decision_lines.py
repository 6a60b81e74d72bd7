"""What was decided about a finding, in the report for the terminal.

In: a finding of a document. Out: lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words


def decision_lines(finding: Mapping[str, Any], words: Words) -> Iterator[tuple[str, str]]:
    """Yield (text, style) of the decision about a finding, if there is one."""
    decision = finding.get("decision")
    if not decision:
        return
    from rosprivacy.analysis.decisions import Choice, State  # noqa: PLC0415 - light start

    choice, place = words(f"tty.done.{decision['choice']}"), f"{shown(decision['file'])}:{decision['line']}"
    expires = words.date(decision["expires"]) if decision["expires"] else ""
    if decision["state"] == State.EXPIRED:
        yield f"   {words('tty.undecided', choice=choice, date=expires, place=place)}", "yellow"
        return
    owner = words("tty.owner", owner=shown(decision["owner"])) if decision["owner"] else ""
    until = words("tty.until", date=expires) if expires else ""
    basis = f", {', '.join(map(words.basis, decision['legal_basis']))}" if decision["legal_basis"] else ""
    style = "green" if decision["choice"] == Choice.ACCEPT else "yellow"
    yield f"   {choice}{owner}{until}{basis}  ({place})", style
    if decision["reason"]:
        yield f"      {shown(decision['reason'])}", style
    for change in decision.get("changed", ()):
        what = words.known(f"tty.changed.{change['what']}", change["what"].replace("_", " "))
        before, now = shown(change["before"]), shown(change["now"])
        yield f"      {words('tty.changed', what=what, before=before, now=now)}", "yellow"
