"""Who, why, on which basis, as label and fleet files state it (GDPR, Articles 5(1)(b), 6, 9(2), 24, 30(1))."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.legal import Lack
from rosprivacy.analysis.model import LEGAL_BASIS
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.result import Result


def analysed(folder: Path, labels: str, *more: str, **options: object) -> Result:
    """A camera and a microphone, and an uplink that reads both."""
    (folder / "p.xml").write_text(policy("cam>/v<", "mic>/a<", "up><v,a"), "utf-8")
    for number, text in enumerate((labels, *more)):
        (folder / f"{number}.yaml").write_text(f"labels: 1\n{text}", "utf-8")
    files = [str(folder / f"{number}.yaml") for number in range(1 + len(more))]
    return rosprivacy.analyze(str(folder / "p.xml"), files, **options)  # type: ignore[arg-type]


def flagged(result: Result) -> list[tuple[int, str]]:
    return [
        (said["line"], said["message"].removeprefix("the legal basis stated here "))
        for said in result.document()["diagnostics"]
        if said.get("code") == LEGAL_BASIS
    ]


def test_a_name_outranks_a_glob_and_one_file_another_only_by_name(tmp_path: Path) -> None:
    """Rule S7: what is said of the one element stands in place of what a glob says of many."""
    labels = (
        "nodes:\n  /*: {purpose: everything, legal_basis: 6(1)(e)}\n"
        "  /cam: {source: [Video], purpose: [b, a]}\n  /mic: {source: [Voice]}\n  /up: {leak: [Video, Voice]}\n"
    )
    rows = {r.element.name: r.purposes for r in analysed(tmp_path, labels).processed if r.element.name != "/up"}
    assert rows == {"/cam": ("a", "b"), "/mic": ("everything",)}


def test_two_files_that_name_two_controllers_contradict_each_other(tmp_path: Path) -> None:
    with pytest.raises(rosprivacy.InputErrors, match=r"1\.yaml:2: controller 'B', and 'A' at .*0\.yaml:2; name one"):
        analysed(tmp_path, "controller: A\n", "controller: B\n")


def test_what_is_nearest_to_the_end_counts_each_article_by_itself(tmp_path: Path) -> None:
    labels = (
        "purpose: running\nlegal_basis: 6(1)(f)\n"
        "nodes:\n  /cam: {source: [Video], legal_basis: 9(2)(h), purpose: care}\n"
        "  /mic: {source: [Voice]}\n  /up: {leak: [Video, Voice], purpose: {Voice: help}}\n"
    )
    rows = {(r.element.name, r.category): (r.purposes, r.bases) for r in analysed(tmp_path, labels).processed}
    assert rows == {
        ("/cam", "Video"): (("care",), ("6(1)(f)", "9(2)(h)")),
        ("/mic", "Voice"): (("running",), ("6(1)(f)",)),
        ("/up", "Video"): (("care",), ("6(1)(f)", "9(2)(h)")),
        ("/up", "Voice"): (("help",), ("6(1)(f)",)),
    }


def test_what_is_made_of_data_has_the_basis_of_the_node_that_makes_it(tmp_path: Path) -> None:
    labels = (
        "nodes:\n  /cam: {source: [Video], derives: [{from: Video, to: FaceTemplate}], purpose: safety}\n"
        "  /mic: conduit\n  /up: {derives: [{from: Video, to: BodyPose}], leak: [BodyPose, FaceTemplate],"
        " purpose: {BodyPose: gait}}\n"
    )
    rows = {(r.element.name, r.category): r.purposes for r in analysed(tmp_path, labels).processed}
    assert rows["/up", "BodyPose"] == ("gait",)
    assert rows["/up", "FaceTemplate"] == ("safety",)


def test_a_stated_basis_that_lacks_something_is_flagged_and_changes_no_finding(tmp_path: Path) -> None:
    """The checks of decisions: Articles 6, 9(2), 9(3), 10 and chapter V; no word of it is an acceptance."""
    nodes = "nodes:\n  /cam: {{source: [Video]{}}}\n  /mic: {{source: [CriminalConviction]{}}}\n  /up: conduit\n"
    cloud = "elements: {{cloud: {{kind: external-system, country: US{}}}}}\nflows: [{{from: /up, to: cloud}}]\n"
    plain = analysed(tmp_path, nodes.format("", "") + cloud.format(""))
    stated = analysed(
        tmp_path,
        nodes.format(", legal_basis: [6(1)(f), 9(2)(h)]", ", legal_basis: 6(1)(f)") + cloud.format(", purpose: x"),
    )
    assert flagged(plain) == []
    assert flagged(stated) == [
        (3, str(Lack.CHAPTER_V)),
        (3, "rests on Article 9(2)(h) and does not state that 9(3) is met, professional secrecy"),
        (4, str(Lack.CHAPTER_V)),
        (4, "names no law that authorises data of Article 10 (10), and CriminalConviction can be such data"),
    ]
    findings = [(f.id, f.accepted, f.dismissed) for f in stated.analysis.findings]
    assert findings == [(f.id, f.accepted, f.dismissed) for f in plain.analysis.findings]
    assert stated.analysis.verdict == plain.analysis.verdict == "leak"


def test_a_basis_of_chapter_v_is_the_transfer_that_it_is(tmp_path: Path) -> None:
    """One fact stands once: 46(2)(c) of a recipient is 'transfer: standard-clauses', and no line denies it."""
    labels = (
        "nodes:\n  /cam: {source: [Video]}\n  /mic: conduit\n  /up: conduit\n"
        "elements: {cloud: {kind: external-system, country: US, legal_basis: [6(1)(b), 9(2)(a), 46(2)(c)]}}\n"
        "flows: [{from: /up, to: cloud}]\n"
    )
    result = analysed(tmp_path, labels)
    assert [f.kind for f in result.analysis.findings] == ["disclosure"]
    assert result.document()["outside"][0]["transfer"] == "standard-clauses"
    assert flagged(result) == []


def test_a_fleet_keeps_what_is_stated_of_robots_and_of_what_is_shared(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy("cam>/v<", "up><v"), "utf-8")
    (tmp_path / "l.yaml").write_text(
        "labels: 1\npurpose: guiding\nnodes:\n  /cam: {source: [Video], subjects: [guests], legal_basis: 9(2)(a)}\n"
        "  /up: conduit\n",
        "utf-8",
    )
    (tmp_path / "f.yaml").write_text(
        "fleet: 1\nname: inn\ncontroller: The Inn\ndpo: Ada\npurpose: running\nlegal_basis: 6(1)(f)\n"
        "robots: {a: {policies: p.xml, labels: l.yaml}, b: {policies: p.xml}}\n"
        "elements:\n  disk: {kind: storage, country: DE, retention: P1D, contract: Article 28}\n"
        "  bell: {kind: device, source: [Voice], subjects: [callers], purpose: ringing}\n"
        'flows: [{from: "*:/up", to: disk}, {from: bell, to: disk}]\n',
        "utf-8",
    )
    document = rosprivacy.analyze_fleet(tmp_path / "f.yaml").document()
    assert {(row["element"]["name"], *row["subjects"]) for row in document["subjects"]} == {
        ("/cam", "guests"),
        ("bell", "callers"),
    }
    of_robots = {row["robot"]: row for row in document["processing"] if "robot" in row}
    assert {robot: (row["controller"], row["purposes"]["every"]) for robot, row in of_robots.items()} == {
        "a": ("The Inn", ["guiding"]),
        "b": ("The Inn", ["running"]),
        "inn": ("The Inn", ["running"]),
    }
    at_disk = {row["category"]: row for row in document["processed_for"] if row["element"]["name"] == "disk"}
    assert at_disk["Video"]["purposes"] == ["guiding"]
    assert at_disk["Video"]["legal_bases"] == ["6(1)(f)", "9(2)(a)"]
    assert at_disk["Voice"]["purposes"] == ["ringing"]
    assert at_disk["Voice"]["controllers"] == ["The Inn"]
    assert next(row for row in document["outside"] if row["element"]["name"] == "disk")["contract"] == "Article 28"


def test_what_robots_share_is_processed_for_what_each_of_them_states(tmp_path: Path) -> None:
    """Findings that differ only in the robot are one pattern; a purpose of the second model is no less stated."""
    (tmp_path / "p.xml").write_text(policy("cam>/v<", "up><v"), "utf-8")
    for model in ("guide", "guard", "other"):
        why = "" if model == "other" else f", purpose: {model}, legal_basis: [6(1)(f), 9(2)(g)]"
        text = f"labels: 1\nnodes:\n  /cam: {{source: [Video]{why}}}\n  /up: conduit\n"
        (tmp_path / f"{model}.yaml").write_text(text, "utf-8")
    text = (
        "fleet: 1\nname: inn\nmodels: {guide: {policies: p.xml, labels: guide.yaml},"
        " guard: {policies: p.xml, labels: guard.yaml}, other: {policies: p.xml, labels: other.yaml}}\n"
        "groups: [{robots: 3, model: guide}, {robots: 2, model: guard}GROUP]\n"
        'elements: {cloud: {kind: external-system}}\nflows: [{from: "*:/up", to: cloud}]\n'
    )
    for group, missing in (("", []), (", {robots: 1, model: other}", ["purpose", "legal_basis"])):
        (tmp_path / "f.yaml").write_text(text.replace("GROUP", group), "utf-8")
        rows = rosprivacy.analyze_fleet(tmp_path / "f.yaml").document()["processed_for"]
        (row,) = (row for row in rows if row["element"]["name"] == "cloud")
        assert (row["purposes"], row["missing"]) == (["guard", "guide"], missing)
