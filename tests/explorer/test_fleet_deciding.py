"""Decisions from a session with a fleet: about exactly the robots that are told, whoever joins later (rule S10)."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.explorer.session import Session
from rosprivacy.settings import Settings
from tests.helpers.fleet_files import MODELS, policy, write

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.explorer.deciding import How, Scope
    from rosprivacy.result import Result

SIGNED: How = {"reason": "agreed", "owner": "A. Lee", "legal_basis": ("6(1)(f)",)}
ACROSS = (
    "elements: {base: {kind: external-system, country: DE}}\n"
    "flows: [{from: '*:/uplink', to: base}, {from: base, to: '*:/uplink'}]\n"
)


@pytest.fixture
def small(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Five robots that are alike, and send each other what they see."""
    monkeypatch.chdir(tmp_path)
    write("eye.xml", policy("/camera>/image", "/uplink</image"))
    write("eye.yaml", "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /uplink: {leak: [Video]}\n")
    write("wall.xml", policy("/receiver>/picture"))
    write("wall.yaml", "labels: 1\n")
    write("fleet.yaml", "fleet: 1\n" + MODELS + "groups: [{robots: 5, model: eye}]\n" + ACROSS)
    return tmp_path / "fleet.yaml"


def begun(fleet: Path) -> Session:
    return rosprivacy.explore(fleet=fleet, settings=Settings(decisions=str(decisions(fleet))))


def decisions(fleet: Path) -> Path:
    return fleet.with_name("decisions.yaml")


def fresh(fleet: Path) -> Result:
    return rosprivacy.analyze_fleet(fleet, decisions=decisions(fleet))


def pattern(session: Session, *, across: bool) -> Finding:
    """The one finding of the small fleet within a robot, or from one to another."""
    on_robots = [one for one in session.findings if one.leak.name == "/uplink"]
    return next(one for one in on_robots if (one.source.robot != one.leak.robot) == across)


def accepted(result: Result) -> set[tuple[str, str, str, str]]:
    """Of every robot: what is accepted, from where to where."""
    assert result.fleet
    likeness, found = result.fleet.likeness, set()
    for one in result.analysis.findings:
        if one.accepted:
            begins, ends = (likeness.placed(end.robot) or ("",) for end in (one.source, one.leak))
            apart, inside = likeness.across(one), begins != ("",) and ends != ("",) and not likeness.across(one)
            for source in begins:
                for leak in [source] if inside else ends:
                    if not (apart and source == leak):
                        found.add((one.kind + one.category, one.source.name + one.leak.name, source, leak))
    return found


def meant(scope: Scope, likeness: Likeness) -> set[tuple[str, str, str, str]]:
    """What a decision is told to be about; the robot of its finding stands for its robots, and need not be one."""
    one = scope.finding
    what = (one.kind + one.category, one.source.name + one.leak.name)
    if scope.to_robots:
        return {(*what, a, b) for a in scope.robots for b in scope.to_robots if a != b}
    begins, ends = (likeness.is_robot(end.robot) for end in (one.source, one.leak))
    return {(*what, robot if begins else "", robot if ends else "") for robot in scope.robots or ("",)}


def test_a_session_that_can_decide_begins_as_the_analysis(hospital: Path) -> None:
    assert begun(hospital).result.to("json1") == rosprivacy.analyze_fleet(hospital).to("json1")


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_what_is_decided_is_exactly_what_was_told_and_what_the_file_means(hospital: Path, seed: int) -> None:
    session, random = begun(hospital), Random(seed)  # noqa: S311 - no secret
    assert session.result.fleet
    told: set[tuple[str, str, str, str]] = set()
    for _ in range(4):
        finding = random.choice([one for one in session.findings if one.stands])
        scope = random.choice(session.scopes(finding))
        if random.random() < 0.5:
            scope = scope.alone
        some = random.sample(scope.robots, random.randint(1, len(scope.robots))) if scope.robots else None
        scope = scope.narrowed(some, scope.to_robots or None) or scope
        choice = random.choice(["accept", "accept", "delegate"])
        decided = meant(scope, session.result.fleet.likeness)
        session.decide(
            finding.id, choice, robots=scope.robots or None, to_robots=scope.to_robots or None, **SIGNED
        )  # fmt: skip
        told = told | decided if choice == "accept" else told - decided
        assert accepted(session.result) == told
        whole = fresh(hospital)
        assert whole.to("json1") == session.result.to("json1")
        assert not any("changed since" in one.message for one in whole.diagnostics)


def of(session: Session, robots: Collection[str]) -> set[str]:
    """The robots on which what stays on a robot is accepted, of some."""
    return {source for _, _, source, leak in accepted(session.result) if source == leak and source in robots}


def test_a_robot_that_joins_is_not_accepted(small: Path) -> None:
    session = begun(small)
    for across in (False, True):
        session.decide(pattern(session, across=across).id, "accept", **SIGNED)
    session.decide(next(one for one in session.findings if one.leak.name == "base").id, "accept", **SIGNED)
    assert session.verdict == fresh(small).analysis.verdict == "undetermined"
    assert len(accepted(session.result)) == 5 + 20 + 5
    assert decisions(small).read_text("utf-8").count("decision: accept") == 3
    small.write_text(small.read_text("utf-8").replace("robots: 5", "robots: 6"), "utf-8")
    after = fresh(small)
    assert after.analysis.verdict == "leak"
    assert len(accepted(after)) == 5 + 20 + 5
    assert after.fleet
    assert sorted(one.count - one.accepted for one in after.fleet.patterns) == [1, 1, 10]


def test_robots_that_are_decided_about_together_stay_alike(small: Path) -> None:
    session = begun(small)
    session.decide(pattern(session, across=False).id, "accept", **SIGNED)
    assert len(session.stands_for("eye_1")) == 5


def test_one_robot_is_decided_about_and_then_another_and_the_first_one_anew(small: Path) -> None:
    session = begun(small)
    everyone = {f"eye_{n}" for n in range(1, 6)}
    finding = pattern(session, across=False).id
    session.decide(finding, "accept", robots=["eye_3"], **SIGNED)
    assert of(session, everyone) == {"eye_3"}
    finding = pattern(session, across=False).id
    session.decide(finding, "accept", **SIGNED)  # the others, which are alike
    assert of(session, everyone) == everyone
    session.decide(finding, "avoid", robots=["eye_3"])
    assert of(session, everyone) == everyone - {"eye_3"}
    session.decide(finding, "avoid", robots=["eye_1", "eye_2"])  # of those decided about together
    assert of(session, everyone) == {"eye_4", "eye_5"}
    assert accepted(fresh(small)) == accepted(session.result)
    assert "history" in decisions(small).read_text("utf-8")


def test_what_goes_from_one_robot_to_another_is_decided_by_both_ends(small: Path) -> None:
    session = begun(small)
    finding = pattern(session, across=True).id
    session.decide(finding, "accept", robots=["eye_1"], to_robots=["eye_2"], **SIGNED)
    assert {found[2:] for found in accepted(session.result)} == {("eye_1", "eye_2")}
    assert accepted(fresh(small)) == accepted(session.result)


@pytest.mark.parametrize(
    "named", [[], ["eye_9"], ["eye_1", "eye_9"], ["wall_1"], ["*"], ["eye_*"], [""], ["base"]]
)  # fmt: skip
def test_other_robots_are_refused(small: Path, named: list[str]) -> None:
    session = begun(small)
    for across in (False, True):
        with pytest.raises(RosPrivacyError, match="it is not on"):
            session.decide(pattern(session, across=across).id, "accept", robots=named, **SIGNED)
    assert not decisions(small).exists()
    assert session.version == 0


def test_robots_that_are_not_alike_are_not_decided_about_at_once(hospital: Path) -> None:
    session = begun(hospital)
    for finding in session.findings:
        groups = session.scopes(finding)
        if len(groups) > 1 and not groups[0].to_robots:
            with pytest.raises(RosPrivacyError, match="not alike"):
                session.decide(finding.id, "avoid", robots=[*groups[0].robots, *groups[1].robots])
            return
    pytest.fail("no finding of several kinds of robots")


@pytest.mark.parametrize(
    ("choice", "said"),
    [
        ("accept", {}),
        ("accept", {"reason": "x"}),
        ("accept", {**SIGNED, "expires": "2020-01-01"}),
        ("allow", SIGNED),
        ("accept", {**SIGNED, "legal_basis": ("because",)}),
    ],
)
def test_what_is_no_decision_writes_nothing(small: Path, choice: str, said: How) -> None:
    session = begun(small)
    with pytest.raises(RosPrivacyError):
        session.decide(pattern(session, across=False).id, choice, **said)
    assert not decisions(small).exists()
    assert (session.version, len(session.stands_for("eye_1"))) == (0, 5)


def test_without_a_file_nothing_is_decided(small: Path) -> None:
    session = Session.open_fleet(str(small))
    with pytest.raises(RosPrivacyError, match="no decisions file"):
        session.decide(session.findings[0].id, "accept", **SIGNED)


def test_what_an_editor_wrote_meanwhile_stays_and_counts(small: Path) -> None:
    session, file = begun(small), decisions(small)
    inside, across = (pattern(session, across=one).id for one in (False, True))
    session.decide(inside, "delegate")
    file.write_text(file.read_text("utf-8") + "# by hand\n- {category: Voice, decision: avoid}\n", "utf-8")
    session.decide(across, "accept", **SIGNED)
    assert "# by hand\n" in file.read_text("utf-8")
    assert len(accepted(session.result)) == 20
    assert fresh(small).to("json1") == session.result.to("json1")


def test_where_an_entry_speaks_closer_nothing_is_written(small: Path) -> None:
    """Else the file would say something else of a robot than the person was told."""
    session, file = begun(small), decisions(small)
    session.decide(pattern(session, across=False).id, "avoid", robots=["eye_2"])
    entry = file.read_text("utf-8").replace("[eye_2]", "[eye_5]")
    file.write_text(entry, "utf-8")  # by an editor: the session has not seen it
    before = session.result.to("json1")
    others = [one for one in session.scopes(pattern(session, across=False)) if "eye_5" in one.robots]
    with pytest.raises(RosPrivacyError, match="line 4 decides it, too"):
        session.decide(others[0].finding.id, "accept", **SIGNED)
    assert file.read_text("utf-8") == entry
    assert session.result.to("json1") == before


def test_where_the_file_contradicts_itself_nothing_is_written(small: Path) -> None:
    session, file = begun(small), decisions(small)
    session.decide(pattern(session, across=True).id, "avoid")
    entries = "- {category: Video, leak: /up*, decision: avoid}\n- {category: Video, leak: /u*k, decision: mitigate}\n"
    file.write_text(f"decisions: 1\nfindings:\n{entries}", "utf-8")
    before, version = session.result.to("json1"), session.version
    with pytest.raises(RosPrivacyError, match="contradicts"):
        session.decide(pattern(session, across=True).id, "accept", **SIGNED)
    assert file.read_text("utf-8") == f"decisions: 1\nfindings:\n{entries}"
    assert (session.result.to("json1"), session.version) == (before, version)


def test_a_decision_that_is_over_is_made_anew_and_inherits_no_day(small: Path) -> None:
    session, file = begun(small), decisions(small)
    finding = pattern(session, across=False).id
    session.decide(finding, "accept", reason="agreed", owner="A. Lee", expires="2999-12-31")
    over = file.read_text("utf-8").replace("2999-12-31", "2020-01-01")
    file.write_text(over, "utf-8")
    session.decide(finding, "accept", **SIGNED)
    assert session.result.decided
    (entry,) = session.result.decided.decisions.entries
    assert (entry.expires, entry.owner) == (SIGNED.get("expires", ""), SIGNED["owner"])


def test_what_was_refused_before_a_decision_keeps_no_robots_apart(small: Path) -> None:
    for name in ("one", "two"):
        write(f"{name}.yaml", "labels: 1\n")
    own = ", ".join(f"{name}: {{model: eye, labels: [{name}.yaml]}}" for name in ("one", "two"))
    small.write_text(small.read_text("utf-8") + f"robots: {{{own}}}\n", "utf-8")
    session = begun(small)
    with pytest.raises(RosPrivacyError, match="keep one of them"):
        session.label("one:/camera", only_this_robot=True, sanitizer={"Video": "drop"})
    session.decide(pattern(session, across=False).id, "accept", robots=["one", "two"], **SIGNED)
    assert session.stands_for("one") == ("one", "two")
    assert session.result.to("json1") == fresh(small).to("json1")


@pytest.mark.slow
def test_labels_that_are_not_saved_and_decisions_are_in_one_answer(hospital: Path) -> None:
    session = begun(hospital)
    session.label("carrier_lent:/recorder", only_this_robot=True, leak="Video")
    found = next(one for one in session.findings if one.leak.name == "/recorder")
    session.decide(found.id, "accept", **SIGNED)
    assert {leak for _, _, _, leak in accepted(session.result)} == {"carrier_lent"}
    session.save()
    assert accepted(fresh(hospital)) == accepted(session.result)
    session.undo()
    assert not accepted(session.result)
