"""Linked data without names (law.md 4, no. 9): nothing of the system's names is left, and it is linked data still."""

from __future__ import annotations

import json
import re
from functools import cache
from typing import TYPE_CHECKING, Any

import pyoxigraph
import pytest
from rdflib import Graph, Literal, URIRef

import rosprivacy
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.formats import Style, written
from rosprivacy.report.rdf.terms import RP
from rosprivacy.report.redact import LEFT_OUT, redacted
from tests.helpers.answers import accepting
from tests.helpers.daily import one_in
from tests.helpers.graphs import care_home, hospital
from tests.helpers.linked_data import problems
from tests.helpers.paths import ROOT
from tests.helpers.reports import HOSTILE, hostile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from rosprivacy.result import Result
    from tests.helpers.command import Cli

FORMS = ("turtle", "json-ld")
SYSTEM = ("examples/care-home/care-home.policy.xml", "-l", "examples/care-home/care-home.labels.yaml")
SYSTEMS: dict[str, Callable[[], Result]] = {"care-home": care_home, "fleet": hospital}


@cache
def graph(system: str, *, redact: bool = True, base: str | None = None) -> Graph:
    with chdir(ROOT):
        made = written(SYSTEMS[system](), "turtle", Style(redact=redact, base=base))
    return Graph().parse(data=made, format="turtle")


def names(value: Any, key: str = "") -> Iterator[str]:
    """Names and free texts of a document: those of elements, robots, files, enclaves, profiles, who and what for."""
    if isinstance(value, dict):
        if {"robot", "kind", "name"} <= set(value):
            yield from (value["robot"], value["name"])
        if key == "models":
            yield from value
        for inner, one in value.items():
            yield from names(one, key if key == "purposes" else inner)
    elif isinstance(value, list):
        for one in value:
            yield from names(one, key)
    elif isinstance(value, str) and key in OF_SOMEBODY and not value.startswith("rosprivacy:"):
        yield value


OF_SOMEBODY = {
    "robot", "robots", "model", "file", "enclave", "operator", "controller", "controllers", "dpo", "officers",
    "profile", "nodes", "subjects", "owner", "reason", "contract", "purpose", "purposes", "message", "author", "note",
}  # fmt: skip


def of_ours(name: str, text: str) -> bool:
    """Whether a name stands in a text as a word of its own."""
    return re.search(rf"(?<![\w/]){re.escape(name)}(?![\w])", text) is not None


def told(made: Graph) -> str:
    """All that the graph says of the system: not what the ontology says of kinds of data and provisions."""
    ours = {s for s in made.subjects() if str(s).startswith("urn:uuid:")}
    said = [(s, p, o) for s, p, o in made if s in ours or not isinstance(s, URIRef)]
    return "\n".join(sorted({str(term) for s, _, o in said for term in (s, o)}))


@pytest.mark.parametrize("system", one_in(2, SYSTEMS, in_ci=1))
def test_no_name_is_left(system: str) -> None:
    known = {name for name in names(SYSTEMS[system]().document()) if len(name) > 1}
    whole, copy = (told(graph(system, redact=redact)) for redact in (False, True))
    before = {name for name in known if of_ours(name, whole)}
    assert len(before) > 20
    assert sorted(name for name in known if of_ours(name, copy)) == []
    for part in ("care-home", "care_planner", "uplink", "examples", "carrier", "guide_", "cleaner"):
        assert part not in copy


@pytest.mark.parametrize("system", one_in(2, SYSTEMS, in_ci=1))
def test_a_name_is_replaced_as_in_the_report(system: str) -> None:
    result = SYSTEMS[system]()
    proposals = result.proposals()  # the page tells them too
    copy = redacted([result.document(), *([] if isinstance(proposals, str) else [proposals])])[0]
    made = graph(system)
    for finding in copy["findings"]:
        subject = next(made.subjects(RP.id, Literal(finding["id"])))
        for said, role in ((RP.dataSource, "source"), (RP.leak, "leak")):
            element = made.value(subject, said)
            assert str(made.value(element, RP.name)) == finding[role]["name"]
            assert str(made.value(element, RP.robot) or "") == finding[role]["robot"]


@pytest.mark.parametrize("system", one_in(2, SYSTEMS, in_ci=1))
def test_it_says_as_much_of_as_many_things_under_the_same_ids(system: str) -> None:
    whole, copy = graph(system, redact=False), graph(system)
    assert len(copy) == len(whole)
    assert set(copy.objects(None, RP.id)) == set(whole.objects(None, RP.id)) != set()
    assert {*copy.subjects()} & {*whole.subjects()} >= {*whole.subjects(RP.id, None)}
    for kept in (RP.sha256, RP.line, RP.country, RP.statedLegalBasis, RP.kind, RP.outcome):
        assert sorted(map(str, copy.objects(None, kept))) == sorted(map(str, whole.objects(None, kept)))


@pytest.mark.parametrize(
    ("system", "base"),
    [
        pytest.param("care-home", None, marks=pytest.mark.slow),
        pytest.param("fleet", None, marks=pytest.mark.slow),
        ("care-home", "urn:x-rosprivacy:"),
        ("fleet", "https://w3id.org/rosprivacy#"),
    ],
)
def test_the_shapes_hold(system: str, base: str | None) -> None:
    """Also with a base that terms of others, or ours, begin with."""
    assert problems(graph(system, base=base)) == ""
    assert len(graph(system, base=base)) == len(graph(system))


def test_what_labels_and_decisions_say_in_their_own_words_is_left_out() -> None:
    """Operators, groups of persons, controllers, purposes, contracts, reasons and messages, also in a base of IRIs."""
    labels = (ROOT / "examples" / "fleet" / "fleet.yaml").read_text("utf-8")
    stated = set(re.findall(r"(?:operator|controller|dpo|contract): *\"?([^\"\n,}]+)", labels))
    assert stated
    made = "\n".join(str(term) for triple in graph("fleet", base="https://example.org/r/") for term in triple)
    assert "https://example.org/r/element:" in made
    assert [text for text in stated if text.strip() in made] == []


def test_the_reason_of_a_decision_is_left_out() -> None:
    result = care_home()
    (first, *_) = result.analysis.findings
    accepted = accepting(result, {first.id: "Mrs M. agreed"})
    for form in FORMS:
        assert "Mrs M. agreed" in written(accepted, form)
        copy = written(accepted, form, Style(redact=True))
        assert "Mrs M." not in copy
        assert LEFT_OUT in copy


def test_names_that_mean_harm_are_replaced_too(tmp_path: Path) -> None:
    hostile(tmp_path)  # writes the two files
    result = rosprivacy.analyze([str(tmp_path / "harm.policy.xml")], [str(tmp_path / "harm.labels.json")])
    for form, syntax in (("json-ld", pyoxigraph.RdfFormat.JSON_LD), ("turtle", pyoxigraph.RdfFormat.TURTLE)):
        whole, copy = (str(written(result, form, Style(redact=redact))) for redact in (False, True))
        assert len(list(pyoxigraph.parse(copy, format=syntax))) == len(list(pyoxigraph.parse(whole, format=syntax)))
        assert [name for name in (*HOSTILE, "harm", "xxxx", str(tmp_path), "sha256=") if name in copy] == []
    assert problems(Graph().parse(data=copy, format="turtle")) == ""


@pytest.mark.parametrize("form", one_in(2, FORMS, in_ci=1))
def test_it_is_one_option_and_always_the_same(cli: Cli, form: str) -> None:
    done = [cli("analyze", *SYSTEM, "--redact", "-f", form, cwd=ROOT) for _ in range(2)]
    assert [one.returncode for one in done] == [1, 1]
    assert done[0].stdout == done[1].stdout
    assert "care-home" not in done[0].stdout
    if form == "json-ld":
        assert json.loads(done[0].stdout)["@graph"]


def test_other_formats_say_where_it_is(cli: Cli) -> None:
    done = cli("analyze", *SYSTEM, "--redact", cwd=ROOT)
    assert done.returncode == 2
    assert "--redact is for --format turtle, json-ld, html" in " ".join(done.stderr.replace("│", " ").split())
