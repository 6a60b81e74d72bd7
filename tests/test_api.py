"""What people import: its names, its types, and that a wrong word is an error and never another question."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from dataclasses import fields
from typing import TYPE_CHECKING, assert_type

import pytest

import rosprivacy
from rosprivacy.analysis import errors
from rosprivacy.settings import Settings
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

FACTORY = ROOT / "examples" / "factory"
CARE = ROOT / "examples" / "care-home"
POLICY, LABELS = CARE / "care-home.policy.xml", CARE / "care-home.labels.yaml"
ROBOT_ONLY = {"add"}  # a fleet file names what is added, robot by robot


# ---------------------------------------------------------------- names, docs, types, light start


def test_what_is_exported_is_there_and_documented() -> None:
    assert rosprivacy.__all__ == sorted(rosprivacy.__all__)
    assert set(rosprivacy.__all__) <= set(dir(rosprivacy))
    for name in set(rosprivacy.__all__) - {"__version__"}:
        found = getattr(rosprivacy, name)
        assert found.__name__ == name
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


@pytest.mark.parametrize(("function", "without"), [("analyze", set()), ("analyze_fleet", ROBOT_ONLY)])
def test_every_setting_is_a_typed_keyword_with_its_default(function: str, without: set[str]) -> None:
    parameters = inspect.signature(getattr(rosprivacy, function)).parameters.values()
    assert not {p.kind for p in parameters} & {inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL}
    assert all(p.annotation is not inspect.Parameter.empty for p in parameters)
    keywords = {p.name: p.default for p in parameters if p.kind is inspect.Parameter.KEYWORD_ONLY}
    assert keywords.keys() == {field.name for field in fields(Settings)} - without
    plain = Settings()
    assert all(getattr(plain, name) == value for name, value in keywords.items() if name != "progress")
    documented = inspect.getdoc(getattr(rosprivacy, function)) or ""
    assert all(re.search(rf"^(\w+, )*{name}\b", documented, re.MULTILINE) for name in keywords)


def test_type_checkers_see_what_comes_out() -> None:
    result = rosprivacy.analyze(POLICY, LABELS)
    assert_type(result, rosprivacy.Result)
    assert_type(result.analysis.findings[0], rosprivacy.Finding)
    assert_type(rosprivacy.parse_labels("labels: 1"), rosprivacy.Labels)
    with pytest.raises(TypeError, match="label"):
        rosprivacy.analyze(POLICY, label=LABELS)  # type: ignore[call-arg]


def test_importing_it_imports_nothing_heavy() -> None:
    absent = ["lxml", "numpy", "networkx", "rdflib", "yaml", "rich", "typer", "neo4j", "rosprivacy.assembly"]
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
        ({"labels": 1, "nodes": {"/a": object()}}, "mine:0: not as in YAML or JSON: "),
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
    assert str(error.value) == "\n".join(f"mine:{line}: {hint}" for line in (0, 3, 4))
