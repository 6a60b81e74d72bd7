"""What people import: its names, its types, and that a wrong word is an error and never another question."""

from __future__ import annotations

import hashlib
import inspect
import json
import re
import shutil
import subprocess
import sys
from dataclasses import fields, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from typing_extensions import assert_type

import rosprivacy
from rosprivacy import settings
from rosprivacy.analysis import errors
from rosprivacy.analysis.model import Element
from rosprivacy.formats import FORMATS
from rosprivacy.report.document.ledger import why_not_document
from rosprivacy.settings import Settings
from tests.helpers.daily import one_in
from tests.helpers.fleet_files import policy
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

FACTORY = ROOT / "examples" / "factory"
CARE = ROOT / "examples" / "care-home"
POLICY, LABELS = CARE / "care-home.policy.xml", CARE / "care-home.labels.yaml"
FLEET_ONLY = {"hangs_on"}  # of a single robot it is always told
COMMAND_LINE_ONLY = {"project"}  # the file that named the options
ROBOT_ONLY = {"add", "types"}  # a fleet file names what is added; label files state types, robot by robot


# ---------------------------------------------------------------- names, docs, types, light start


def test_what_is_exported_is_there_and_documented() -> None:
    assert rosprivacy.__all__ == sorted(rosprivacy.__all__)
    assert set(rosprivacy.__all__) <= set(dir(rosprivacy))
    for name in set(rosprivacy.__all__) - {"__version__"}:
        found = getattr(rosprivacy, name)
        assert found.__name__ == {"FleetSession": "Session"}.get(name, name)  # one class, and its earlier name
        assert inspect.getdoc(found), name
        for member, value in vars(found).items() if inspect.isclass(found) else ():
            if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                assert inspect.getdoc(value), f"{name}.{member}"
    with pytest.raises(AttributeError, match=r"module 'rosprivacy' has no attribute 'analyse'"):
        rosprivacy.analyse  # noqa: B018  # type: ignore[attr-defined]


def test_every_error_is_exported_and_drawn() -> None:
    def tree(kind: type[BaseException], depth: int = 1) -> list[tuple[int, str]]:
        return [(depth, kind.__name__), *(row for sub in kind.__subclasses__() for row in tree(sub, depth + 1))]

    drawn = re.findall(r"^((?:  )+)  (\w+Errors?)\b", errors.__doc__ or "", re.MULTILINE)
    here = [(depth, name) for depth, name in tree(errors.RosPrivacyError) if hasattr(errors, name)]
    assert sorted((len(indent) // 2, name) for indent, name in drawn) == sorted(here)
    assert {name for _, name in here} <= set(rosprivacy.__all__)


@pytest.mark.parametrize(("function", "group"), [("analyze", "RobotOptions"), ("analyze_fleet", "FleetOptions")])
def test_every_setting_is_an_option_with_a_type_and_a_text(function: str, group: str) -> None:
    named = getattr(settings, group)
    without = FLEET_ONLY if group == "RobotOptions" else ROBOT_ONLY
    assert named.__annotations__.keys() == {field.name for field in fields(Settings)} - without - COMMAND_LINE_ONLY
    documented = f"{inspect.getdoc(settings.Options)}\n{inspect.getdoc(named)}"
    assert all(re.search(rf"^{name}$", documented, re.MULTILINE) for name in named.__annotations__)
    taken = inspect.signature(getattr(rosprivacy, function)).parameters["options"]
    assert taken.annotation == f"Unpack[{group}]"


def test_what_a_fleet_file_names_is_no_option_of_a_fleet() -> None:
    for name in ROBOT_ONLY:
        with pytest.raises(TypeError, match=name):
            rosprivacy.analyze_fleet("fleet.yaml", **{name: "file"})  # type: ignore[arg-type]


def test_type_checkers_see_what_comes_out() -> None:
    result = rosprivacy.analyze(POLICY, LABELS)
    assert_type(result, rosprivacy.Result)
    assert_type(result.analysis.findings[0], rosprivacy.Finding)
    assert_type(rosprivacy.parse_labels("labels: 1"), rosprivacy.Labels)
    with pytest.raises(TypeError, match="label"):
        rosprivacy.analyze(POLICY, label=LABELS)  # type: ignore[call-arg]


def test_importing_it_imports_nothing_heavy() -> None:
    absent = ["lxml", "numpy", "networkx", "rdflib", "yaml", "rich", "typer", "neo4j", "rosprivacy.answering"]
    code = f"import sys, rosprivacy\ndir(rosprivacy)\nprint([m for m in {absent!r} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


# ---------------------------------------------------------------- what is named


def test_one_name_alone_counts_as_a_list_of_one() -> None:
    """It was read letter by letter: 'a: not found; b: not found …'."""
    listed = rosprivacy.analyze([str(POLICY)], [str(LABELS)], categories=["Video"], data_types=["video"])
    alone = rosprivacy.analyze(POLICY, str(LABELS), categories="Video", data_types="video")
    assert alone.document() == listed.document()
    with pytest.raises(rosprivacy.InputErrors) as error:
        rosprivacy.analyze("nowhere.policy.xml", "nowhere.yaml")
    assert all("nowhere" in str(one) for one in error.value.errors)


def test_a_mode_that_is_none_is_an_error_with_the_nearest() -> None:
    """'Declared' ran the enforced view, and called it declared."""
    with pytest.raises(rosprivacy.RosPrivacyError, match="declared"):
        rosprivacy.analyze(POLICY, LABELS, view="Declared")  # type: ignore[arg-type]
    enforced = rosprivacy.analyze(POLICY, LABELS, view=rosprivacy.View.enforced)
    assert enforced.document() == rosprivacy.analyze(POLICY, LABELS, view="enforced").document()


# ---------------------------------------------------------------- labels from memory


@pytest.mark.parametrize("labels", [LABELS, FACTORY / "run5.labels.yaml"], ids=lambda path: path.name)
def test_labels_from_memory_mean_what_they_mean_in_a_file(labels: Path) -> None:
    policy = POLICY if labels == LABELS else FACTORY / "after.policy.xml"
    parsed = rosprivacy.parse_labels(labels.read_text("utf-8"), name=str(labels))
    assert rosprivacy.analyze(policy, parsed).document() == rosprivacy.analyze(policy, labels).document()


def test_labels_may_be_dicts_and_lists() -> None:
    said = {
        "labels": 1,
        "nodes": {"/camera": {"source": ["Video"]}, "/recorder": {"leak": ["Video"]}},
        "channels": {"/camera/*": "sensitive"},
    }
    result = rosprivacy.analyze(POLICY, [rosprivacy.parse_labels(said, name="mine")])
    assert {(f.source.name, f.leak.name) for f in result.analysis.findings} == {("/camera", "/recorder")}
    assert result.assumptions["labels"][0]["file"] == "mine"


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ("labels: 1\nnodes:\n  /a: {leak: [Vidoe]}", "mine:3: unknown category 'Vidoe'; did you mean"),
        ("labels: 1\nnodes: {", "mine:"),
        ("", "mine:1: the file is empty"),
        ({"labels": 1, "nodes": {"/a": {"leek": ["Video"]}}}, "mine:5: unknown key 'leek'; did you mean 'leak'?"),
        ({"labels": 1, "nodes": {"/a": object()}}, "mine: not as in YAML or JSON: "),
        ({"labels": 1, "nodes": {"/\ud800": "\x00"}}, "mine:"),
    ],
)
def test_a_problem_of_labels_from_memory_names_its_line(said: str | dict[str, object], message: str) -> None:
    with pytest.raises(rosprivacy.InputErrors) as error:
        rosprivacy.parse_labels(said, name="mine")
    assert str(error.value).startswith(message)
    assert all(isinstance(one, rosprivacy.LabelError | rosprivacy.OntologyError) for one in error.value.errors)


def test_labels_that_were_read_with_another_ontology_are_an_error(tmp_path: Path) -> None:
    """Their kinds would be unknown to the analysis: never silence (rule S11)."""
    mine = tmp_path / "mine.ttl"
    mine.write_text(
        "@prefix : <urn:example:clinic:> . @prefix rp: <urn:x-rosprivacy:> .\n"
        "@prefix skos: <http://www.w3.org/2004/02/skos/core#> .\n"
        ':PulseCurve a skos:Concept ; rp:label "PulseCurve" ; skos:broader rp:Health ; rp:dataType "number" ;\n'
        'skos:prefLabel "pulse curve"@en ; skos:definition "The pulse over time."@en .\n'
    )
    elements = "elements: {disk: {kind: storage, retention: {PulseCurve: P1D}}}\nlimits: {PulseCurve: P1D}\n"
    text = f"labels: 1\nnodes:\n  /camera: {{source: [PulseCurve]}}\n{elements}"
    labels = rosprivacy.parse_labels(text, name="mine", ontologies=mine)
    assert rosprivacy.analyze(POLICY, labels, ontologies=mine).analysis.emitted == ("PulseCurve",)
    with pytest.raises(rosprivacy.InputErrors) as error:
        rosprivacy.analyze(POLICY, labels)
    hint = "unknown category 'PulseCurve'; give parse_labels the ontologies that analyze gets"
    where = ("mine", "mine:3", "mine:4")
    assert str(error.value) == "\n".join(f"{place}: {hint}" for place in where)


# ---------------------------------------------------------------- what a result can do


@pytest.fixture(scope="module")
def care() -> rosprivacy.Result:
    return rosprivacy.analyze(POLICY, LABELS)


def test_a_result_is_shown_in_one_line_that_begins_with_the_verdict(care: rosprivacy.Result) -> None:
    """It was 392,420 characters for the factory."""
    restricted = rosprivacy.analyze(POLICY, LABELS, categories="Biometric")
    unlabelled = rosprivacy.analyze(POLICY)
    for result in (care, restricted, unlabelled, rosprivacy.analyze_fleet(ROOT / "examples/fleet/fleet.yaml")):
        line = result.to("text", quiet=True).rstrip("\n")
        assert repr(result) == f"<Result: {line}>"
        assert "\n" not in repr(result)
        assert line in repr(result.findings)
    assert repr(restricted).endswith("; only Biometric was asked for>")
    assert repr(unlabelled).startswith("<Result: undetermined: no data was followed")


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", sorted(FORMATS.keys() - {"docx", "edpb-dpia"})
)  # no text: tests/report/page/test_word_document.py
def test_every_format_is_written_by_its_name(
    care: rosprivacy.Result, name: str, cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    for command in ("analyze", "report"):
        done = cli(command, POLICY, "-l", LABELS, "--format", name)
        assert care.to(name).splitlines() == done.stdout.splitlines()  # RFC 4180 ends lines of CSV otherwise than pipes


def test_a_format_that_is_none_is_an_error_with_all_that_are(care: rosprivacy.Result) -> None:
    with pytest.raises(rosprivacy.InputError, match="unknown format 'sariff'; one of text, json, json1, sarif, "):
        care.to("sariff")


def test_findings_are_a_sequence_and_rows_of_plain_values(care: rosprivacy.Result) -> None:
    assert_type(care.findings[0], rosprivacy.Finding)
    assert tuple(care.findings) == care.analysis.findings
    assert tuple(care.findings[1:]) == care.analysis.findings[1:]
    rows = care.findings.to_rows()
    assert json.loads(json.dumps(rows)) == rows
    document = care.document()["findings"]
    assert [(row["id"], row["category"], row["source"], row["leak"]) for row in rows] == [
        (told["id"], told["category"], told["source"]["name"], told["leak"]["name"]) for told in document
    ]
    for row, told in zip(rows, document, strict=True):
        assert row["lines"] == [f"{line['file']}:{line['line']}" for step in told["steps"] for line in step["policy"]]


def test_rows_of_a_fleet_count_the_findings_that_they_stand_for() -> None:
    fleet = rosprivacy.analyze_fleet(ROOT / "examples" / "fleet" / "fleet.yaml")
    told = [(p["finding"], p["findings"], p["robots"]) for p in fleet.document()["fleet"]["patterns"]]
    assert [(row["id"], row["findings"], row["robots"]) for row in fleet.findings.to_rows()] == told


def test_a_notebook_shows_names_escaped_and_the_verdict_first(tmp_path: Path) -> None:
    file = tmp_path / "p.policy.xml"
    file.write_text(policy("/a>/t", "/b</t"))
    hostile = "<img src=x onerror=alert(1)>&"
    labels = {
        "labels": 1,
        "nodes": {"/a": {"source": ["Video"]}},
        "elements": {hostile: {"kind": "display", "leak": ["Video"]}},
        "flows": [{"from": "/b", "to": hostile}],
    }
    result = rosprivacy.analyze(file, rosprivacy.parse_labels(labels))
    shown = result._repr_html_()
    assert shown == result.findings._repr_html_()
    assert "<img" not in shown
    assert "&lt;img src=x onerror=alert(1)&gt;&amp;" in shown
    assert shown.startswith("<table><caption>leak: data can reach a leak</caption>")
    empty = rosprivacy.analyze(file)._repr_html_()
    assert empty.startswith("<table><caption>undetermined: ")


def test_a_finding_is_one_line_whatever_is_in_its_names(care: rosprivacy.Result, tmp_path: Path) -> None:
    shown = [repr(finding) for finding in care.findings]
    assert shown[2] == f"<Finding {care.findings[2].id}: Voice: /microphone -> /uplink>"
    assert "pseudonymised Video: /camera -> /recorder" in shown[1]
    file = tmp_path / "p.policy.xml"
    file.write_text(policy("/a>/t", "/b</t"))
    labels = {
        "labels": 1,
        "nodes": {"/a": {"source": ["Video"]}},
        "elements": {"disk": {"kind": "storage", "country": "DE"}},
        "flows": [{"from": "/b", "to": "disk"}],
    }
    (kept,) = rosprivacy.analyze(file, rosprivacy.parse_labels(labels)).findings
    assert "storage-limitation of Video: /a -> disk" in repr(kept)
    hostile = replace(kept, source=Element("node", "/a\n\u202e" + "b" * 2000), accepted=True)
    assert repr(hostile).isprintable()
    assert repr(hostile).endswith(" -> disk, accepted>")
    assert len(repr(hostile)) < 400


def test_suggestions_rest_on_types_that_are_named_as_for_an_analysis(tmp_path: Path) -> None:
    file, types = tmp_path / "p.policy.xml", tmp_path / "types.yaml"
    file.write_text(policy("/a>/t", "/b</t"))
    types.write_text("types: 1\ntopics:\n  /t: [{type: sensor_msgs/msg/Image}]\n")

    def sources(**options: Any) -> set[str]:
        proposals = rosprivacy.suggest(file, **options).proposals
        return {one.label.kind for one in proposals if one.label.role == "source"}

    assert "Video" not in sources()
    assert "Video" in sources(types=types)
    assert sources(types=types) == sources(settings=Settings(types=(str(types),)))


def test_the_networkx_graph_holds_every_element_and_flow_with_what_they_carry(care: rosprivacy.Result) -> None:
    network, graph = care.to_networkx(), care.analysis.graph
    assert tuple(network) == graph.elements
    ends = [(graph.elements[flow.source], graph.elements[flow.target], flow.role) for flow in graph.flows]
    assert set(network.edges) == set(ends)
    assert network.number_of_edges() == len(ends)
    hierarchy = care.vocabulary.hierarchy
    for one in care.analysis.carried:
        parts = [said for element, said in network.nodes(data=True) if element.shown_as == one.element.shown_as]
        plain, pseudonymised = ({name for part in parts for name in part[key]} for key in ("carries", "pseudonymised"))
        assert hierarchy.narrowest(sorted(plain)) == one.categories
        assert hierarchy.narrowest(sorted(pseudonymised)) == one.pseudonymised
    for finding in care.findings:
        for step in finding.steps:
            along = network.edges[step.source, step.target, step.role]
            assert step.category in along["pseudonymised" if step.pseudonymised else "carries"]


def test_why_not_is_what_the_command_says(care: rosprivacy.Result, cli: Cli) -> None:
    done = cli("why-not", "/lidar", "/uplink", POLICY, "-l", LABELS, "--format", "json")
    assert why_not_document(care.why_not("/lidar", "/uplink")) == json.loads(done.stdout)
    with pytest.raises(rosprivacy.InputError, match="no element is called '/lidr'; did you mean /lidar"):
        care.why_not("/lidr", "/uplink")


# ---------------------------------------------------------------- the same policies under other labels


def test_other_labels_give_the_answer_of_an_analysis_anew_without_the_policies(tmp_path: Path) -> None:
    folder = tmp_path / "factory"
    shutil.copytree(FACTORY, folder)
    policy, (first, second) = folder / "before.policy.xml", [str(folder / f"run{n}.labels.yaml") for n in (1, 2)]
    under_first, anew = rosprivacy.analyze(policy, first), rosprivacy.analyze(policy, second).document()
    for file in folder.glob("*.xml"):
        file.unlink()
    assert under_first.with_labels(second).document() == anew
    assert under_first.with_labels(second).with_labels(first).document() == under_first.document()
    assert under_first.with_labels(*under_first.labels).document() == under_first.document()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("section", "name", "said"),
    one_in(
        4,
        [
            ("nodes", "/blur", {"sanitizer": {"Video": "anonymise"}}),
            ("nodes", "/recorder", "conduit"),
            ("nodes", "/uplink", None),
            ("nodes", "/camera", {"source": ["Location"]}),
            ("channels", "/camera/*", {"never": ["Video"]}),
            ("channels", "/face_recognizer/faces", "mundane"),
            ("channels", "/camera/image", "mundane"),  # of which only a glob spoke
        ],
    ),
)
def test_an_entry_replaced_gives_the_answer_of_the_file_changed_so(
    care: rosprivacy.Result, section: str, name: str, said: object
) -> None:
    labels = yaml.safe_load(LABELS.read_text("utf-8"))
    labels[section][name] = said
    anew = rosprivacy.analyze(POLICY, rosprivacy.parse_labels(labels))
    replaced = care.with_entry(section, name, said)
    assert replaced.analysis.findings == anew.analysis.findings
    assert replaced.analysis.open == anew.analysis.open
    assert replaced.analysis.carried == anew.analysis.carried
    assert replaced.analysis.verdict == anew.analysis.verdict
    named = replaced.assumptions["labels"]
    assert named[-1]["file"] == f"{section} {name}"
    digest = hashlib.sha256(LABELS.read_bytes()).hexdigest()
    assert all((one["sha256"] == digest) == (one["file"] == str(LABELS)) for one in named)  # S12: no hash is another's
    assert all(replaced.to(form) for form in FORMATS)


def test_an_entry_is_replaced_in_the_section_where_it_stands(care: rosprivacy.Result) -> None:
    """A topic and a service of one name are two elements (rule S1)."""
    labels = rosprivacy.parse_labels(
        "labels: 1\nnodes: {/camera: {source: [Video]}}\nchannels: {/audio: sensitive}\n"
        "elements: {disk: {kind: storage, retention: P1D}}\nflows: [{from: /recorder, to: disk}]\n"
    )
    result = care.with_labels(labels)
    with pytest.raises(rosprivacy.InputErrors, match="labels:3: '/audio' is labelled for more than topics; replace it"):
        result.with_entry("topics", "/audio", "mundane")
    again = result.with_entry("channels", "/audio", "mundane")
    assert [entry.name for entry in again.labels[1].entries] == ["/camera", "disk"]
    kept = {"kind": "storage", "retention": "P2D"}
    disk = result.with_entry("elements", "disk", kept)
    assert [str(duration) for facts in disk.analysis.outside.values() for _, duration in facts.retention] == ["P2D"]


def test_what_cannot_be_replaced_is_an_error(care: rosprivacy.Result) -> None:
    with pytest.raises(rosprivacy.InputErrors, match="unknown section 'node'; one of nodes, channels, "):
        care.with_entry("node", "/camera", "conduit")
    with pytest.raises(rosprivacy.InputErrors, match="nodes /camra:4: '/camra' matches no node of the policies"):
        care.with_entry("nodes", "/camra", "conduit")
    fleet = rosprivacy.analyze_fleet(ROOT / "examples" / "fleet" / "fleet.yaml")
    for change in (fleet.with_labels, partial(fleet.with_entry, "nodes", "/camera", "conduit")):
        with pytest.raises(rosprivacy.InputError, match="of a fleet or a database labels are not replaced; change"):
            change()


# ---------------------------------------------------------------- suggestions


def test_what_is_suggested_is_what_the_command_says(cli: Cli) -> None:
    told = rosprivacy.suggest(str(POLICY), str(LABELS)).document()
    assert told["suggestions"]
    assert told == json.loads(cli("suggest", POLICY, "-l", LABELS, "-f", "json").stdout)
    fleet = ROOT / "examples" / "fleet" / "fleet.yaml"
    told = rosprivacy.suggest_fleet(fleet).document()
    assert told == json.loads(cli("suggest", "--fleet", fleet, "-f", "json").stdout)


def test_types_are_named_as_for_an_analysis(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy("/a>/t", "/b</t"))
    types = tmp_path / "t.yaml"
    types.write_text(
        "types: 1\nobserved: {from: 2026-01-01T10:00:00Z, to: 2026-01-02T10:00:00Z, by: [text]}\n"
        "topics: {/t: [{type: sensor_msgs/msg/Image, writers: [/a]}]}\n"
    )
    by_name = rosprivacy.suggest(tmp_path / "p.xml", types=types)
    by_settings = rosprivacy.suggest(tmp_path / "p.xml", settings=Settings(types=(str(types),)))
    assert by_name.document() == by_settings.document()
    assert by_name.proposals != rosprivacy.suggest(tmp_path / "p.xml").proposals


def test_what_labels_from_memory_say_is_not_suggested_again() -> None:
    def asked(labels: rosprivacy.Labels | str) -> set[str]:
        found: rosprivacy.Suggested = rosprivacy.suggest(POLICY, labels)
        return {one.label.kind for one in found.proposals if one.label.element.name == "/camera"}

    assert "Video" not in asked(str(LABELS))
    said = rosprivacy.parse_labels({"labels": 1, "nodes": {"/camera": {"source": ["PersonPointCloud"]}}})
    assert "Video" in asked(said)
    assert "PersonPointCloud" not in asked(said)


def test_rules_that_cannot_be_read_are_errors_of_their_kind(tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text("package: 1\n", "utf-8")
    for problem, named in (("no 'nodes'", {"packages": tmp_path / "own.yaml"}), ("not found", {"rules": "no.yaml"})):
        with pytest.raises(rosprivacy.InputErrors, match=problem):
            rosprivacy.suggest(POLICY, LABELS, **named)
