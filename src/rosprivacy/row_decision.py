"""A decision about a row of the register, as a log or a decisions file holds it: what it names, what was there then.

In: a document, a row of its register, robots. Out: the keys of the entry. A row of a fleet is named by the kind and the
place without its robot. What was there keeps a decision from findings, forms and robots that come later (rule S10).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import DecisionError, InputErrors, shown
from rosprivacy.analysis.remembered import About, as_written, stated_of

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rosprivacy.analysis.decisions import Decision, Decisions

    Row = Mapping[str, Any]  # of the register
    Document = Mapping[str, Any]

MOST_NAMED = 5


def row_target(document: Document, row: Row, robots: Collection[str] = ()) -> dict[str, Any]:
    """Return what an entry about a row names.

    Parameters
    ----------
    robots
        Of a fleet: some of those of the row; none for all of them.

    Raises
    ------
    InputErrors
        If the row is on other robots, or the report does not tell its robots.
    """
    of_fleet = row.get("fleet")
    if of_fleet is None:
        if robots or "fleet" in document:
            hint = "analyse it in memory, without --engine" if "fleet" in document else "leave --robot away"
            raise _refused("the report names no robots of this row", hint)
        return {"row": row["id"]}
    if others := sorted(set(robots) - set(of_fleet["robots"])):
        hint = f"name some of: {', '.join(map(shown, of_fleet['robots'][:MOST_NAMED]))}"
        raise _refused(f"the row is not on {', '.join(map(shown, others))}", hint)
    named = sorted(set(robots)) if set(robots) != set(of_fleet["robots"]) else []
    if not named and _is_divided(document, row):
        named = of_fleet["robots"]  # what is stated of the place is not the same everywhere
    return {"row": of_fleet["pattern"], **({"robots": list(named)} if named else {})}


def made_about_row(document: Document, row: Row, robots: Collection[str] = ()) -> dict[str, Any]:
    """Return what an entry about a row remembers: a finding, a form or a robot that comes later is not decided."""
    of_fleet = row.get("fleet", {})
    about = About.of_row(
        _findings(document, row), stated_of(row), robots or of_fleet.get("robots", ()), of_fleet.get("from_robots", ())
    )
    return {"made_about": as_written(about)}


def check_foremost(decisions: Decisions, entry: Mapping[str, Any]) -> None:
    """See that no other entry about a row speaks closer of robots that an entry is about.

    Parameters
    ----------
    entry
        About a row, as it is written.

    Raises
    ------
    InputErrors
        If there is one: the entry would decide nothing there.
    """
    named = set(entry.get("robots", ()))
    about = named or set(entry.get("made_about", {}).get("robots", ()))
    for other in decisions.entries:
        if other.row == entry["row"] and not other.id and set(other.robots) != named:
            shorter = not named or len(other.robots) <= len(named)
            if other.robots and shorter and (both := sorted(about.intersection(other.robots))):
                where = f"line {other.place.line} decides about {', '.join(map(shown, both[:MOST_NAMED]))}, too"
                raise _refused(where, _withdrawal(decisions, other))


def _withdrawal(decisions: Decisions, other: Decision) -> str:
    if not decisions.head:
        return "change or remove that entry, and decide anew"
    names = " ".join(f"--robot {shown(robot)}" for robot in other.robots)
    return f"withdraw it with --row {other.row} {names}, and decide anew"


def _is_divided(document: Document, row: Row) -> bool:
    """Whether decisions name another row of the register by the same kind and place."""
    patterns = [one["fleet"]["pattern"] for one in document["register"] if "fleet" in one]
    return patterns.count(row["fleet"]["pattern"]) > 1


def _findings(document: Document, row: Row) -> Iterator[tuple[str, bool]]:
    """The findings of a row by the ids that decisions name them by, each with whether it is pseudonymised."""
    if "fleet" not in document:
        yield from ((one["id"], one["pseudonymised"]) for one in document["findings"] if one["id"] in row["findings"])
        return
    for one in document["fleet"]["patterns"]:
        if one["finding"] in row["findings"]:
            yield one["id"], row["pseudonymised"] or one["pseudonymised"] == one["findings"]


def _refused(problem: str, hint: str) -> InputErrors:
    return InputErrors([DecisionError("--row", 0, problem, hint)])
