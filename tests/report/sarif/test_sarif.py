"""SARIF: valid under the published schema, read by an independent reader, each finding at the line that allows it."""

from __future__ import annotations

import csv
import json
import os
import re
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import pytest
from hypothesis import given
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.model import Category, Place
from rosprivacy.documents import document_of
from rosprivacy.ontology.vocabulary import Vocabulary
from rosprivacy.report.document.contents import POSITIONS
from rosprivacy.report.sarif import locations
from rosprivacy.report.sarif import log as sarif_module
from rosprivacy.report.sarif.log import sarif
from tests.helpers.answers import accepting, answer_of, as_json
from tests.helpers.cases import CASES
from tests.helpers.fleet_files import policy
from tests.helpers.paths import ROOT
from tests.helpers.sarif import EXAMPLES, HOSTILE, analyze, checked, log_of, physical, small_system, way
from tests.helpers.systems import HIERARCHY, PARENTS, System, analysed, systems

if TYPE_CHECKING:
    from pathlib import Path


FINDING_KINDS = ("disclosure", "storage-limitation", "third-country-transfer", "unprotected-channel")
CARE_HOME = (["care-home/care-home.policy.xml"], ["care-home/care-home.labels.yaml"])
VOCABULARY = Vocabulary.of(Category(n, f"urn:{n}", n, n, n, up) for n, up in PARENTS.items())


def in_examples(file: str) -> str:
    return os.path.normpath(f"examples/{file}")


@pytest.mark.parametrize("case", CASES, ids=lambda path: str(path.name))
def test_every_finding_is_at_the_line_that_lets_the_data_into_the_leak_and_its_witness_is_a_code_flow(
    case: Path,
) -> None:
    given_case = json.loads((case / "case.json").read_text())
    result = analyze(given_case["policies"], given_case["labels"], **given_case.get("options", {}))
    run, document = checked(log_of(result)), result.document()
    assert run["properties"]["verdict"] == document["verdict"]
    rules = Counter(r["ruleId"] for r in run["results"] if r["ruleId"] in FINDING_KINDS)
    assert rules == Counter(finding["kind"] for finding in document["findings"])
    results = {r["partialFingerprints"]["rosprivacyFinding/v1"]: r for r in run["results"]}
    for finding in document["findings"]:
        lines = [[(in_examples(p["file"]), p["line"]) for p in step["policy"]] for step in finding["steps"]]
        assert physical(results[finding["id"]]["locations"][0]) == min(lines[-1])
        steps = way(results[finding["id"]])
        assert [step["logicalLocations"][0]["name"] for step in steps] == [e["name"] for e in finding["witness"]]
        for allowed, place in zip(lines, steps[1:], strict=True):
            assert not allowed or physical(place) in allowed
        label = (EXAMPLES.parent / physical(steps[0])[0]).read_text().splitlines()[physical(steps[0])[1] - 1]
        assert finding["source"]["name"] in label  # the way begins where the source is labelled
        assert "source" in label


def test_what_data_may_only_reveal_is_no_more_than_that(tmp_path: Path) -> None:
    result = small_system(tmp_path, {"/a": "{source: [Location]}"}, last="leak: [Location]")
    (found, *_) = checked(log_of(result, at=tmp_path))["results"]
    assert found["properties"]["article9"] == "may-reveal"
    assert len({taxon["id"] for taxon in found["taxa"]}) == len(found["taxa"])


# ---------------------------------------------------------------- stability


def test_fingerprints_are_the_findings_ids_and_outlive_moved_lines(tmp_path: Path) -> None:
    """Rule S10; the first is the one that GitHub matches by, and by itself it would take that of the line."""
    for name in ("before.policy.xml", "node.xml", "run2.labels.yaml"):
        (tmp_path / name).write_text((EXAMPLES / "factory" / name).read_text())
    policy, labels = tmp_path / "before.policy.xml", tmp_path / "run2.labels.yaml"
    runs = []
    for _ in range(2):
        result = rosprivacy.analyze([str(policy)], [str(labels)])
        runs.append(checked(log_of(result, at=tmp_path))["results"])
        head, rest = policy.read_text().split("\n", 1)
        policy.write_text(f"{head}\n\n\n\n{rest}")
    fingerprints = [[r["partialFingerprints"] for r in results] for results in runs]
    assert fingerprints[0] == fingerprints[1]
    hashes = [f["primaryLocationLineHash"] for f in fingerprints[0]]
    assert len(set(hashes)) == len(hashes)
    lines = [[physical(r["locations"][0])[1] for r in results] for results in runs]
    assert lines[1] == [line + 3 for line in lines[0]]
    ids = [finding.id for finding in result.analysis.findings]
    assert [f["rosprivacyFinding/v1"] for f in fingerprints[0]][: len(ids)] == ids


def test_files_are_named_relative_to_the_repository_wherever_one_stands(tmp_path: Path) -> None:
    (tmp_path / "repo" / ".git").mkdir(parents=True)
    folder = tmp_path / "repo" / "my roböt#1"
    folder.mkdir()
    for name in ("care-home.policy.xml", "node.xml", "care-home.labels.yaml"):
        (folder / name).write_text((EXAMPLES / "care-home" / name).read_text())
    named = set()
    for at, file in ((folder, "care-home.policy.xml"), (tmp_path / "repo", str(folder / "care-home.policy.xml"))):
        with pytest.MonkeyPatch.context() as patch:
            patch.chdir(at)
            log = as_json(rosprivacy.analyze([file], [str(folder / "care-home.labels.yaml")]), "sarif")
        places = [
            location["physicalLocation"]["artifactLocation"] for location in checked(log)["results"][0]["locations"]
        ]
        named |= {(place["uri"], place["uriBaseId"]) for place in places}
    assert named == {("my%20rob%C3%B6t%231/care-home.policy.xml", "%SRCROOT%")}


def test_a_file_outside_has_a_whole_uri(tmp_path: Path) -> None:
    (tmp_path / "repo" / ".git").mkdir(parents=True)
    result = analyze(*CARE_HOME)
    outside = [str(EXAMPLES / entry["file"]) for entry in result.assumptions["policies"]]
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(EXAMPLES)
        log = sarif(document_of(replace(result, diagnostics=()), (POSITIONS,)), tmp_path / "repo")
    where = checked(log)["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]
    assert "uriBaseId" not in where
    assert unquote(where["uri"]) == f"file://{outside[0]}"


# ---------------------------------------------------------------- decisions


def test_only_what_a_person_accepted_is_suppressed_and_stays_in_the_file() -> None:
    result = analyze(*CARE_HOME)
    first, *others = [finding.id for finding in result.analysis.findings]
    run = checked(log_of(accepting(result, {first: "staff agreed, says A. Person"})))
    suppressed = {r["partialFingerprints"]["rosprivacyFinding/v1"]: r.get("suppressions") for r in run["results"]}
    assert suppressed == {
        first: [{"kind": "external", "status": "accepted", "justification": "staff agreed, says A. Person"}],
        **dict.fromkeys(others),
    }


def test_a_finding_that_another_covers_is_a_note_that_says_so(tmp_path: Path) -> None:
    """Rule S10: dismissed, but not gone."""
    result = small_system(
        tmp_path, {"/a": "{source: [Video], leak: [Voice]}", "/b": "{leak: [Video]}"}, last="leak: [Video]"
    )
    results = checked(log_of(result, at=tmp_path))["results"]
    assert [r["level"] for r in results if r["ruleId"] == "disclosure"] == ["warning", "note"]
    assert results[1]["properties"]["dismissed"]


# ---------------------------------------------------------------- places that are no policy line


def test_a_source_of_a_broader_kind_is_not_the_label_of_a_narrower_one(tmp_path: Path) -> None:
    """Rule S7, decided in roles.py: a source names what it emits. SARIF once counted the label in line 3 for both."""
    labels = {"/a": "{source: [Biometric]}", '"/[a]"': "{source: [FaceTemplate]}"}
    result = small_system(tmp_path, labels, last="leak: [Biometric, FaceTemplate]")
    found = {
        r["properties"]["category"]: r for r in checked(log_of(result, at=tmp_path))["results"] if "codeFlows" in r
    }
    lines = {name: physical(found[name]["relatedLocations"][0])[1] for name in ("Biometric", "FaceTemplate")}
    assert lines == {"Biometric": 3, "FaceTemplate": 4}


def test_a_node_that_is_source_and_leak_is_at_the_line_of_its_label(tmp_path: Path) -> None:
    result = small_system(tmp_path, {"/a": "{source: [Video], leak: [Video]}"}, last="conduit: [Video]")
    (found, *_) = checked(log_of(result, at=tmp_path))["results"]
    assert physical(found["locations"][0]) == ("l.yaml", 3)
    assert [physical(step) for step in way(found)] == [("l.yaml", 3)]


def test_a_finding_that_no_file_speaks_of_is_at_the_first_line_of_what_it_rests_on(tmp_path: Path) -> None:
    """As when people added flows and roles in the database by hand."""
    result = small_system(tmp_path, {"/a": "{source: [Video]}"})
    graph = replace(
        result.analysis.graph, profiles=(), flows=tuple(f._replace(grants=()) for f in result.analysis.graph.flows)
    )
    elements = {
        vertex: tuple(s._replace(place=Place("the database", 0)) for s in said)
        for vertex, said in result.bound.elements.items()
    }
    bound = replace(result.bound, elements=elements)
    vocabulary = result.vocabulary
    analysis = analyse(graph, bound, vocabulary.hierarchy)

    def places(assumptions: dict[str, Any]) -> set[tuple[str, int]]:
        log = sarif(document_of(answer_of(analysis, vocabulary, assumptions), (POSITIONS,)), tmp_path)
        (found,) = [r for r in checked(log)["results"] if r["ruleId"] == "disclosure"]
        return {physical(found["locations"][0]), *(physical(step) for step in way(found))}

    assert places(result.assumptions) == {("l.yaml", 1)}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path)
        assert places({}) == {("the%20database", 1)}


# ---------------------------------------------------------------- what is not known


def test_nodes_to_review_next_are_results_at_their_profiles() -> None:
    result = analyze(["factory/before.policy.xml"], ["factory/run1.labels.yaml"])
    run = checked(log_of(result))
    reviews = [r for r in run["results"] if r["ruleId"] == "unreviewed-element"]
    frontier = [question.element.name for question in result.analysis.open if question.frontier]
    assert [r["locations"][0]["logicalLocations"][0]["name"] for r in reviews] == frontier
    assert {(r["kind"], r["level"]) for r in reviews} == {("review", "none")}
    policy = (EXAMPLES / "factory" / "before.policy.xml").read_text().splitlines()
    for review, name in zip(reviews, frontier, strict=True):
        assert f'node="{name[1:]}"' in policy[physical(review["locations"][0])[1] - 1]


def test_undetermined_is_never_an_empty_list(tmp_path: Path) -> None:
    """Rule S12: where only channels are open, and where nothing was followed."""
    channels = small_system(tmp_path, {"/a": "{source: [Video]}", "/b": "conduit"}, last="conduit: [Video]")
    assert str(channels.analysis.verdict) == "undetermined"
    assert not any(question.frontier for question in channels.analysis.open)
    results = checked(log_of(channels, at=tmp_path))["results"]
    assert [r["locations"][0]["logicalLocations"][0]["name"] for r in results] == ["/t1", "/t2"]
    lines = (tmp_path / "p.policy.xml").read_text().splitlines()
    assert [
        "/t1" in lines[physical(results[0]["locations"][0])[1] - 1],
        "/t2" in lines[physical(results[1]["locations"][0])[1] - 1],
    ] == [True, True]

    nothing = small_system(tmp_path, {"/a": "conduit"}, last="conduit: [Video]")
    run = checked(log_of(nothing, at=tmp_path))
    assert [(r["ruleId"], r["level"]) for r in run["results"]] == [("no-data-followed", "warning")]


# ---------------------------------------------------------------- bounds


def test_what_is_over_a_viewers_bound_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sarif_module, "MAX_RESULTS", 2)
    run = checked(log_of(analyze(["factory/before.policy.xml"], ["factory/run2.labels.yaml"])))
    assert [r["ruleId"] for r in run["results"]] == ["disclosure", "disclosure"]  # findings before questions
    texts = [notice["message"]["text"] for notice in run["invocations"][0]["toolExecutionNotifications"]]
    assert "1 results are left out: a viewer takes 2 at most." in texts


def test_further_ways_are_further_code_flows_up_to_a_bound(tmp_path: Path) -> None:
    """GitHub takes 10,000 locations of a result; the witness is the first, for viewers that show one only."""
    topics = "".join(f"<topic>/t{i:02}</topic>\n" for i in range(13))
    profiles = f'<profile ns="/" node="a">\n<topics publish="ALLOW">{topics}</topics></profile>\n'
    profiles += f'<profile ns="/" node="b">\n<topics subscribe="ALLOW">{topics}</topics></profile>\n'
    enclave = f'<enclave path="/"><profiles>{profiles}</profiles></enclave>'
    (tmp_path / "p.xml").write_text(f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>')
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes: {/a: {source: [Video]}, /b: {leak: [Video]}}\n")
    result = rosprivacy.analyze([str(tmp_path / "p.xml")], [str(tmp_path / "l.yaml")], paths="all", max_paths=12)
    run = checked(log_of(result, at=tmp_path))
    (found, *_) = [r for r in run["results"] if r["ruleId"] == "disclosure"]
    ways = [[physical(step) for step in way(found, number)] for number in range(len(found["codeFlows"]))]
    assert len(ways) == locations.MAX_FLOWS == 10
    assert len({tuple(places) for places in ways}) == 10  # each at its own lines
    names = [way(found, number)[1]["logicalLocations"][0]["name"] for number in range(10)]
    assert names[0] == result.analysis.findings[0].witness[1].name
    lines = (tmp_path / "p.xml").read_text().splitlines()
    for name, places in zip(names, ways, strict=True):
        assert all(name in lines[line - 1] for _, line in places[1:])
    texts = [notice["message"]["text"] for notice in run["invocations"][0]["toolExecutionNotifications"]]
    left_out = (
        len([path for path in result.analysis.findings[0].paths if path != result.analysis.findings[0].witness]) - 9
    )
    assert f"{left_out} paths of findings are left out; --format json lists them." in texts
    assert "1 findings have more paths than were looked for (--max-paths)." in texts


def test_a_file_with_too_many_ways_keeps_every_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first of the care home's three ways has 7 elements, the others 6 and 3."""
    monkeypatch.setattr(sarif_module, "MAX_LOCATIONS", 10)
    run = checked(log_of(analyze(*CARE_HOME)))
    assert [len(way(r)) if "codeFlows" in r else 0 for r in run["results"]] == [7, 0, 0]
    texts = [notice["message"]["text"] for notice in run["invocations"][0]["toolExecutionNotifications"]]
    assert "2 paths of findings are left out; --format json lists them." in texts


@pytest.mark.slow
def test_a_very_long_way_keeps_its_ends(tmp_path: Path) -> None:
    count = 700  # 1,401 elements
    ends = [f"/t{i}" if 0 <= i < count else "" for i in range(-1, count + 1)]
    (tmp_path / "p.xml").write_text(policy(*(f"/n{i}>{ends[i + 1]}<{ends[i]}" for i in range(count + 1))))
    (tmp_path / "l.yaml").write_text(f"labels: 1\nnodes: {{/n0: {{source: [Video]}}, /n{count}: {{leak: [Video]}}}}\n")
    result = rosprivacy.analyze([str(tmp_path / "p.xml")], [str(tmp_path / "l.yaml")])
    (found, *_) = checked(log_of(result, at=tmp_path))["results"]
    names = [step["logicalLocations"][0]["name"] for step in way(found)]
    assert len(names) == 1000
    assert (names[0], names[-1]) == ("/n0", f"/n{count}")
    assert any(step["message"]["text"].startswith("401 steps are left out") for step in way(found))


# ---------------------------------------------------------------- hostile names


def strings(value: Any) -> list[str]:
    if isinstance(value, dict):
        return [text for part in value.values() for text in strings(part)]
    if isinstance(value, list):
        return [text for part in value for text in strings(part)]
    return [value] if isinstance(value, str) else []


def log_of_system(system: System, suffix: str) -> dict[str, Any] | None:
    """A random system whose names all end in something."""
    known = system.graph()
    graph = replace(known, elements=tuple(replace(e, name=e.name + suffix, robot=suffix) for e in known.elements))
    if analysed(system) is None:
        return None
    analysis = analyse(graph, system.bound(), HIERARCHY)
    return sarif(document_of(answer_of(analysis, VOCABULARY, {}), (POSITIONS,)), ROOT)


@given(systems(), st.text(max_size=20))
def test_any_system_with_any_names_is_valid_and_nothing_is_left_out(system: System, suffix: str) -> None:
    log = log_of_system(system, suffix)
    if log is None:
        return
    run = checked(json.loads(json.dumps(log)))
    analysis = analysed(system)
    assert analysis is not None
    kinds = [r["ruleId"] for r in run["results"]]
    assert sum(map(kinds.count, FINDING_KINDS)) == len(analysis.findings)
    assert kinds or str(analysis.verdict) == "no-leak-found"
    assert all(text.isprintable() for text in strings(run["results"]))


def test_a_hostile_name_harms_nothing(tmp_path: Path) -> None:
    result = small_system(tmp_path, {"/a": "{source: [Video]}"})
    analysis = result.analysis
    names = {element.name: element.name + HOSTILE for element in analysis.graph.elements}
    graph = replace(analysis.graph, elements=tuple(replace(e, name=names[e.name]) for e in analysis.graph.elements))
    vocabulary = result.vocabulary
    spread_anew = analyse(graph, result.bound, vocabulary.hierarchy)
    log = sarif(document_of(answer_of(spread_anew, vocabulary, {}), (POSITIONS,)), tmp_path)
    run = checked(json.loads(json.dumps(log)))
    assert all(text.isprintable() and len(text) < 1500 for text in strings(run["results"]))
    texts = [r["message"]["text"] for r in run["results"]]
    texts += [step["message"]["text"] for r in run["results"] if "codeFlows" in r for step in way(r)]
    assert all("<script>" in text for text in texts)  # shown, for a viewer that takes it as text
    assert not any(re.search(r"\]\(|(?<!\{)\{0\}", text) for text in texts)  # no link, no placeholder


def test_a_file_name_that_is_no_text_is_a_uri_all_the_same(tmp_path: Path) -> None:
    result = small_system(tmp_path, {"/a": "{source: [Video]}"})
    odd = "p\udcff[x].policy.xml"
    assumptions = {**result.assumptions, "policies": [{"file": odd, "sha256": "0" * 64}]}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path)
        log = sarif(document_of(replace(result, diagnostics=(), assumptions=assumptions), (POSITIONS,)), tmp_path)
    run = checked(json.loads(json.dumps(log)))
    assert run["artifacts"][0]["location"]["uri"] == "p%FF%5Bx%5D.policy.xml"
    json.dumps(log, ensure_ascii=False).encode()


# ---------------------------------------------------------------- an independent reader


@pytest.mark.slow
def test_an_independent_reader_opens_it(tmp_path: Path) -> None:
    """sarif-tools, as a user calls it."""
    log = log_of(analyze(["factory/before.policy.xml"], ["factory/run2.labels.yaml"]))
    file, table = tmp_path / "found.sarif", tmp_path / "found.csv"
    file.write_text(json.dumps(log))
    command = [sys.executable, "-m", "sarif", "csv", "--output", str(table), str(file)]
    subprocess.run(command, check=True, capture_output=True)
    with table.open(encoding="utf-8-sig", newline="") as opened:
        rows = [(r["Tool"], r["Code"], r["Severity"], r["Location"], r["Line"]) for r in csv.DictReader(opened)]
    policy = "examples/factory/before.policy.xml"
    assert sorted(rows) == [
        ("rosprivacy", "disclosure", "warning", policy, "13"),
        ("rosprivacy", "disclosure", "warning", policy, "14"),
        ("rosprivacy", "unreviewed-element", "none", policy, "36"),
    ]
