"""A session with a fleet: edits mean what editing the label files of models and robots would; no other is touched."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.explorer.edited_file import Conflict, SavedFile
from rosprivacy.explorer.session import Session
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet

if TYPE_CHECKING:
    from rosprivacy.result import Result

POLICY = """<policy version="0.2.0"><enclaves><enclave path="/r"><profiles>
<profile ns="/" node="camera"><topics publish="ALLOW"><topic>/image</topic></topics></profile>
<profile ns="/" node="recorder"><topics subscribe="ALLOW"><topic>/image</topic></topics></profile>
</profiles></enclave></enclaves></policy>
"""
LABELS = "labels: 1\nnodes:\n  /camera: {source: [Video]}  # seen\n"


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """Two models that share a label file, by two names; and two robots whose own files say the same."""
    (tmp_path / "p.xml").write_text(POLICY)
    for name in ("shared", "a", "b"):
        (tmp_path / f"{name}.yaml").write_text(LABELS if name == "shared" else "labels: 1\n")
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "more.yaml").write_text(
        "fleet: 1\nmodels:\n  cart: {policies: [../p.xml], labels: [../shared.yaml]}\n"
        "groups: [{robots: 2, model: cart}]\n"
    )
    file = tmp_path / "fleet.yaml"
    file.write_text(
        "fleet: 1\ninclude: [in/more.yaml]\nmodels:\n  bot: {policies: [p.xml], labels: [shared.yaml]}\n"
        "robots:\n  one: {model: bot, labels: [a.yaml]}\n  two: {model: bot, labels: [b.yaml]}\n"
        "groups: [{robots: 3, model: bot}]\n"
    )
    return file


def fresh(file: Path) -> Result:
    return answer_fleet(str(file), Settings())


def begun(file: Path, **how: Any) -> Session:
    return Session.open_fleet(str(file), **how)


def held(file: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in file.parent.rglob("*") if path.is_file()}


def test_a_session_begins_as_the_analysis(hospital: Path) -> None:
    session = begun(hospital)
    assert session.result.to("json1") == fresh(hospital).to("json1")
    assert session.outliers == {"carrier_lent"}
    assert session.stands_for("carrier_01") == tuple(f"carrier_{n:02}" for n in range(1, 24))
    assert len(session.target("carrier_01").robots) == 24


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_edits_saved_mean_what_the_files_then_mean(hospital: Path, seed: int) -> None:
    session, random = begun(hospital), Random(seed)  # noqa: S311 - no secret
    start, before = session.result.to("json1"), held(hospital)
    nodes = sorted({e.full_name for e in session.result.analysis.graph.elements if e.is_node and e.robot})
    touched = set()
    for _ in range(6):
        label: dict[str, Any] = random.choice(
            [{"conduit": True}, {"leak": "Video"}, {"leak": "Location"}, {"note": "x"}]
        )
        try:
            change = session.label(random.choice(nodes), only_this_robot=random.random() < 0.3, **label)
        except InputErrors:  # a source taken away in silence, or a robot without a file of its own
            continue
        touched.add(Path(change.edit.file).name)
    assert touched
    assert isinstance(session.save(), SavedFile)
    assert session.unsaved == 0
    assert session.result.to("json1") == fresh(hospital).to("json1")
    after = held(hospital)
    assert {name for name in after if after[name] != before[name]} <= touched
    while session.undo():
        pass
    session.save()
    assert held(hospital) == before
    assert session.result.to("json1") == start


def test_an_answer_goes_to_the_model_or_to_one_robot(hospital: Path) -> None:
    session = begun(hospital)
    session.label("carrier_lent:/blur", only_this_robot=True, sanitizer={"Video": "drop"})
    assert Path(session.edits[0].file).name == "carrier_lent.labels.yaml"
    session.label("carrier_lent:/blur", conduit=True)
    assert Path(session.edits[1].file).name == "carrier.labels.yaml"
    with pytest.raises(InputErrors, match=r"no label file of its own: carrier_01"):
        session.label("carrier_01:/blur", only_this_robot=True, conduit=True)
    with pytest.raises(InputErrors, match=r"no label file for it: hospital"):
        session.label("hospital:fleet cloud", kind="external-system", conduit=True)
    with pytest.raises(InputErrors, match="matches no node"):
        session.label("carrier_01:/nope", conduit=True)
    assert len(session.edits) == 2


def test_models_that_share_a_file_are_answered_for_together(small: Path) -> None:
    session = begun(small)
    target = session.target("cart_1")
    assert sorted(target.models) == ["bot", "cart"]
    assert len(target.robots) == 7
    asked = {question.element.robot for question in session.questions() if question.name == "/recorder"}
    assert asked == {"bot_1", "cart_1", "one"}
    session.label("cart_1:/recorder", leak="Video")
    assert not [question for question in session.questions() if question.name == "/recorder"]
    session.save()
    assert session.result.to("json1") == fresh(small).to("json1")
    assert (small.parent / "shared.yaml").read_text() == LABELS + "  /recorder: {leak: [Video]}\n"


def test_robots_are_apart_once_their_own_files_say_different_things(small: Path) -> None:
    session = begun(small)
    assert session.stands_for("one") == ("one", "two")
    session.label("one:/recorder", only_this_robot=True, leak="Video")
    assert session.stands_for("one") == ("one",)
    assert "two" in {question.element.robot for question in session.questions()}
    assert {finding.leak.robot for finding in session.result.analysis.findings} == {"one"}
    session.label("two:/recorder", only_this_robot=True, leak="Video")
    session.save()
    assert session.stands_for("one") == ("one", "two")
    assert session.result.to("json1") == fresh(small).to("json1")


def test_robots_are_alike_after_a_merge_where_what_was_said_of_one_was_taken_back(small: Path) -> None:
    session = begun(small)
    session.label("bot_1:/recorder", conduit=True)
    session.undo()
    session.label("one:/recorder", only_this_robot=True, leak="Video")
    session.undo()
    (small.parent / "shared.yaml").write_text(LABELS + "  /recorder: {leak: [Video]}\n")
    session.merge()
    assert session.stands_for("one") == ("one", "two")
    assert session.result.to("json1") == fresh(small).to("json1")


def test_what_somebody_else_wrote_is_not_written_over(small: Path) -> None:
    session = begun(small)
    session.label("bot_1:/recorder", conduit=True)
    session.label("one:/recorder", only_this_robot=True, leak="Video")
    theirs = LABELS.replace("# seen", "# looked at")
    (small.parent / "shared.yaml").write_text(theirs)
    before = held(small)
    assert isinstance(session.save(), Conflict)
    assert held(small) == before
    session.merge()
    assert isinstance(session.save(), SavedFile)
    assert (small.parent / "shared.yaml").read_text() == theirs + "  /recorder: conduit\n"
    assert session.result.to("json1") == fresh(small).to("json1")


def test_what_was_saved_before_gives_way_to_what_somebody_else_said_later(small: Path) -> None:
    session = begun(small)
    session.label("bot_1:/recorder", conduit=True)
    session.save()
    shared = small.parent / "shared.yaml"
    shared.write_text(shared.read_text().replace("/recorder: conduit", "/recorder: {leak: [Video]}"))
    assert session.merge() == ()
    assert session.unsaved == 0
    assert session.result.to("json1") == fresh(small).to("json1")
    session.label("bot_1:/recorder", conduit=True)
    shared.write_text(shared.read_text().replace("/recorder: {leak: [Video]}", "/recorder: {leak: [Voice]}"))
    assert [edit.value for edit in session.merge()] == [{"leak": ["Voice"]}]


def test_what_was_not_saved_is_offered_for_the_files_of_the_fleet_only(small: Path, tmp_path: Path) -> None:
    session = begun(small, journal=tmp_path / "state")
    session.label("bot_1:/recorder", conduit=True)
    session.label("one:/recorder", only_this_robot=True, leak="Video")
    session.close()
    (journal,) = (tmp_path / "state").glob("*.jsonl")
    other = json.dumps(["nodes", "/recorder", "conduit", str(tmp_path / "elsewhere.yaml")])
    journal.write_text(f"{journal.read_text()}{other}\n")
    again = begun(small, journal=tmp_path / "state")
    offered = again.history.unsaved_from_before
    assert offered is not None
    assert not offered.changed
    assert [error.partition(": ")[2] for error in again.history.resume()] == [
        "is no label file of the fleet; name it in the fleet file"
    ]
    assert again.unsaved == 2
    assert again.result.analysis.findings == session.result.analysis.findings
    again.close()


def test_the_public_function_opens_the_same_session(small: Path) -> None:
    session = rosprivacy.explore(fleet=small)
    assert isinstance(session, rosprivacy.FleetSession)
    assert session.result.to("json1") == fresh(small).to("json1")
    with pytest.raises(InputError, match="other files are named beside it"):
        rosprivacy.explore("p.xml", fleet=small)  # type: ignore[call-overload]


def test_a_fleet_has_no_label_file_to_be_saved_under_a_new_name(small: Path) -> None:
    session = begun(small)
    with pytest.raises(InputError, match="labels of a fleet"):
        session.save_as("new.yaml")


def test_robots_that_somebody_made_alike_meanwhile_stay_apart(tmp_path: Path) -> None:
    """Saving compares robots by what is on the disk; of a file that was not read again, the answer rests on the old."""
    (tmp_path / "p.xml").write_text(POLICY)
    (tmp_path / "model.yaml").write_text("labels: 1\nnodes:\n  /camera: {source: [Video]}\n")
    (tmp_path / "one.yaml").write_text("labels: 1\nnodes: {/recorder: conduit}\n")
    (tmp_path / "two.yaml").write_text("labels: 1\nnodes: {/recorder: {leak: [Video]}}\n")
    file = tmp_path / "fleet.yaml"
    file.write_text(
        "fleet: 1\nmodels:\n  cart: {policies: [p.xml], labels: [model.yaml]}\n"
        "robots:\n  r1: {model: cart, labels: [one.yaml]}\n  r2: {model: cart, labels: [two.yaml]}\n"
    )
    session = Session.open_fleet(str(file))
    (tmp_path / "one.yaml").write_text((tmp_path / "two.yaml").read_text())
    session.label("r1:/camera", source=["Video"], note="seen")
    assert isinstance(session.save(), SavedFile)
    assert [finding.leak.full_name for finding in session.findings] == ["r2:/recorder"]


def test_robots_whose_policies_somebody_made_alike_meanwhile_stay_apart(tmp_path: Path) -> None:
    """As with label files: a policy is read once, and what it lets through now is not what was read."""
    (tmp_path / "one.xml").write_text(POLICY.replace('subscribe="ALLOW"', 'subscribe="DENY"'))
    (tmp_path / "two.xml").write_text(POLICY)
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes: {/camera: {source: [Video]}, /recorder: {leak: [Video]}}\n")
    file = tmp_path / "fleet.yaml"
    file.write_text(
        "fleet: 1\nrobots:\n  r1: {policies: [one.xml], labels: [l.yaml]}\n"
        "  r2: {policies: [two.xml], labels: [l.yaml]}\n"
    )
    session = Session.open_fleet(str(file))
    assert [finding.leak.full_name for finding in session.findings] == ["r2:/recorder"]
    (tmp_path / "one.xml").write_text(POLICY)
    assert session.changed_inputs == (str(tmp_path / "one.xml"),)
    session.label("r2:/camera", source=["Video"], note="seen")
    assert isinstance(session.save(), SavedFile)
    assert [finding.leak.full_name for finding in session.findings] == ["r2:/recorder"]
    assert session.changed_inputs == (str(tmp_path / "one.xml"),)


def test_robots_whose_types_somebody_made_alike_meanwhile_stay_apart(tmp_path: Path) -> None:
    seen = "types: 1\nobserved: {from: 2026-01-01T10:00:00Z, to: 2026-01-02T10:00:00Z}\n"
    (tmp_path / "p.xml").write_text(POLICY)
    (tmp_path / "one.yaml").write_text(f"{seen}topics: {{/image: [{{type: geometry_msgs/msg/Twist}}]}}\n")
    (tmp_path / "two.yaml").write_text(f"{seen}topics: {{/image: [{{type: sensor_msgs/msg/Image}}]}}\n")
    (tmp_path / "l.yaml").write_text(LABELS)
    file = tmp_path / "fleet.yaml"
    file.write_text(
        "fleet: 1\nmodels: {m: {policies: [p.xml], labels: [l.yaml]}}\n"
        "robots:\n  r1: {model: m, types: [one.yaml]}\n  r2: {model: m, types: [two.yaml]}\n"
    )
    session = Session.open_fleet(str(file))
    (tmp_path / "one.yaml").write_text((tmp_path / "two.yaml").read_text())
    session.label("r2:/camera", source=["Video"], note="seen again")
    assert isinstance(session.save(), SavedFile)
    assert session.stands_for("r1") == ("r1",)
    assert session.changed_inputs == (str(tmp_path / "one.yaml"),)
