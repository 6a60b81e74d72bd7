"""Decisions about rows from a session with a fleet: on exactly the robots that are named, as the file then means."""

from __future__ import annotations

from contextlib import suppress
from random import Random
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.explorer.deciding import How
    from rosprivacy.explorer.session import Session

SIGNED: How = {"reason": "agreed", "owner": "A. Lee", "legal_basis": ("6(1)(f)",)}
ANSWERED: How = {**SIGNED, "answers": {"processor": "DMS 12"}}


def begun(fleet: Path) -> Session:
    return rosprivacy.explore(fleet=fleet, settings=Settings(decisions=str(fleet.with_name("decisions.jsonl"))))


def rows(session: Session) -> list[dict[str, Any]]:
    return [row for row in session.result.document()["register"] if row["findings"]]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_rows_are_decided_on_the_robots_that_are_named(hospital: Path, seed: int) -> None:
    session, random = begun(hospital), Random(seed)  # noqa: S311 - no secret
    open_robots = {(row["fleet"]["pattern"], robot) for row in rows(session) for robot in row["fleet"]["robots"]}
    written = 0
    for _ in range(3):
        row = random.choice([row for row in rows(session) if row["state"] == "open" and row["fleet"]["robots"]])
        robots = row["fleet"]["robots"]
        some = random.sample(robots, random.randint(1, len(robots)))
        with suppress(RosPrivacyError):  # where an entry about fewer robots speaks closer
            session.decide_row(row["id"], "accept", robots=some, **SIGNED)
            written += 1
            for other in rows(session):
                if other["fleet"]["pattern"] == row["fleet"]["pattern"] and {*other["fleet"]["robots"]} <= {*some}:
                    assert other["state"] in ("accepted", "dismissed")
        open_robots -= {(row["fleet"]["pattern"], robot) for robot in some}
        fresh = rosprivacy.analyze_fleet(hospital, decisions=hospital.with_name("decisions.jsonl"))
        assert fresh.to("json1") == session.result.to("json1")
        assert not any("changed since" in one.message for one in fresh.diagnostics)
        for other in rows(session):
            still = {(other["fleet"]["pattern"], robot) for robot in other["fleet"]["robots"]} & open_robots
            assert other["state"] != "accepted" or not still
    assert written


def test_a_row_is_decided_once_with_all_that_ends_there(hospital: Path) -> None:
    session = begun(hospital)
    row = next(row for row in rows(session) if len(row["fleet"]["robots"]) > 1)
    session.decide_row(row["id"], "accept", **ANSWERED)
    after = [one for one in rows(session) if one["fleet"]["pattern"] == row["fleet"]["pattern"]]
    assert {one["state"] for one in after if {*one["fleet"]["robots"]} <= {*row["fleet"]["robots"]}} == {"accepted"}
    assert session.result.decided
    (entry,) = session.result.decided.decisions.entries
    assert (entry.row, entry.answers) == (row["fleet"]["pattern"], (("processor", "DMS 12"),))


def test_robots_of_another_row_are_refused(hospital: Path) -> None:
    session = begun(hospital)
    row = rows(session)[0]
    with pytest.raises(RosPrivacyError, match="not on"):
        session.decide_row(row["id"], "accept", robots=["nobody"], **SIGNED)
    assert not hospital.with_name("decisions.jsonl").exists()
