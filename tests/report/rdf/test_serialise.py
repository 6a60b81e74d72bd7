"""Turtle and JSON-LD: no name breaks out of its place, the same input gives the same bytes (rule S14)."""

from __future__ import annotations

import os
import subprocess
import sys
from datetime import datetime, timezone
from functools import cache
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rdflib import RDF, XSD, Graph, Literal, URIRef
from rdflib.compare import isomorphic

from rosprivacy.analysis.errors import InputError
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.model import (
    Bound,
    Category,
    Diagnostic,
    Element,
    Flow,
    FlowGraph,
    Grant,
    NonRosFacts,
    Place,
    Severity,
)
from rosprivacy.clock import source_date
from rosprivacy.documents import document_of
from rosprivacy.ontology.vocabulary import Vocabulary
from rosprivacy.report.rdf.findings import rdf_graph
from rosprivacy.report.rdf.serialise import SERIALISERS
from rosprivacy.report.rdf.terms import RP, IndividualNames
from tests.helpers.answers import accepting, answer_of
from tests.helpers.daily import one_in
from tests.helpers.linked_data import strict
from tests.helpers.paths import ROOT
from tests.helpers.systems import statement

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.answer import Answer
    from tests.helpers.command import Cli


CARE_HOME = ("examples/care-home/care-home.policy.xml", "-l", "examples/care-home/care-home.labels.yaml")
TURNED = "\u202eevil\u202c\u2066"
HOSTILE = [
    '"', '"""', "\\", '\\"', 'a\nb\\"', '\n"', '\n""', "<", "> . <urn:x> <urn:y> <urn:z> . <", '" . <urn:x> <urn:y> "',
    "\r", "\t", "\x00", "\x7f", "\x85", "\u2028", "\ufeff", TURNED, "ÄÖ 한국 🤖", "x" * 4000, "🤖" * 1000, "{", "}",
    "%3E", "%", "a b", "@en", "^^<urn:x>", "urn:x-rosprivacy:", "rp:Finding", "_:b0", "'''", "</script>", "a.", "-",
]  # fmt: skip
NAMES = IndividualNames("urn:test:")
FORMS = pytest.mark.parametrize("form", SERIALISERS)


def system(name: str, file: str = "") -> Answer:
    """A source and a leak, with the name wherever somebody else may choose one."""
    place = Place(file or name, 3)
    elements = (Element("node", f"/{name}", name), Element("storage", name, name), Element("topic", f"/t{name}"))
    grants = (Grant(True, "publish", "topic", f"/t{name}", f"/{name}", f"/{name}", place),)
    flows = (Flow(0, 1, "flow", grants), Flow(0, 2, "publish", grants))
    vocabulary = Vocabulary.of([Category("Kind", "urn:test:Kind", "Kind", name, name)])
    roles = {0: (statement("source", "Kind"),), 1: (statement("leak", "Kind"),)}
    analysis = analyse(FlowGraph(elements, flows, (), ()), Bound(roles), vocabulary.hierarchy)
    assumptions = {"rosprivacy": "1", "unlabelled_node": name, "policies": [{"file": file or name, "sha256": "0" * 64}]}
    outside = {elements[1]: NonRosFacts(country=name, operator=name)}
    said = [Diagnostic(place, Severity.WARNING, name)]
    answer = answer_of(analysis, vocabulary, assumptions, said, outside)
    return accepting(answer, {answer.analysis.findings[0].id: name})


def text_of(name: str, form: str) -> str:
    return SERIALISERS[form](rdf_graph(document_of(system(name))))


def values(graph: Graph, kind: Any, predicate: Any) -> set[str]:
    return {str(value) for subject in graph.subjects(RDF.type, kind) for value in graph.objects(subject, predicate)}


def uris(graph: Graph) -> set[URIRef]:
    return {node for node in graph.all_nodes() if isinstance(node, URIRef)}


@cache
def triples_of_a_tame_name() -> int:
    return len(strict(text_of("tame", "turtle"), "turtle"))


def holds(graph: Graph, name: str) -> None:
    """The name is in every place where it belongs, and nothing came out of it."""
    assert values(graph, RP.Element, RP.name) == {f"/{name}", name, f"/t{name}"}
    assert values(graph, RP.Element, RP.robot) == {name} - {""}
    assert values(graph, RP.PolicyLine, RP.file) == values(graph, RP.Diagnostic, RP.message) == {name}
    assert values(graph, RP.SourceFile, RP.file) == values(graph, RP.Finding, RP.accepted) == {name}
    assert name in values(graph, RP.Assumption, RP.value)
    assert len(graph) == triples_of_a_tame_name()
    assert all(str(node).startswith(("urn:uuid:", "urn:test:Kind", "http")) for node in uris(graph))


@FORMS
@pytest.mark.parametrize("name", one_in(5, HOSTILE), ids=range(len(HOSTILE)))
def test_a_hostile_name_stays_a_name(name: str, form: str) -> None:
    holds(strict(text_of(name, form), form), name)


@FORMS
@given(name=st.text(st.characters(exclude_categories=["Cs"]), min_size=1))
def test_any_name_stays_a_name(form: str, name: str) -> None:
    holds(strict(text_of(name, form), form), name)


@FORMS
@pytest.mark.parametrize("name", ["\ud800", "a\udcff"], ids=["surrogate", "byte"])
def test_what_utf_8_cannot_say_is_escaped(name: str, form: str) -> None:
    """A file's name can be any bytes."""
    graph = strict(SERIALISERS[form](rdf_graph(document_of(system("tame", name)))), form)
    assert values(graph, RP.SourceFile, RP.file) == {name.encode("utf-8", "backslashreplace").decode()}


@pytest.mark.slow
@FORMS
def test_nothing_unprintable_is_written(form: str) -> None:
    for name in HOSTILE:
        assert text_of(name, form).replace("\n", "").isprintable()


@FORMS
@pytest.mark.filterwarnings("ignore:ConjunctiveGraph")  # rdflib's own JSON-LD parser still uses it
def test_rdflib_reads_the_same(form: str) -> None:
    text = text_of(TURNED, form)
    assert isomorphic(Graph().parse(data=text, format=form), strict(text_of(TURNED, "turtle"), "turtle"))


@given(st.text(), st.text(), st.text(), st.text())
def test_different_names_have_different_iris(a: str, b: str, c: str, d: str) -> None:
    assert (NAMES.of("x", a, b) == NAMES.of("x", c, d)) == ((a, b) == (c, d))


def test_a_long_name_has_a_short_iri_that_no_other_name_has() -> None:
    long = NAMES.of("x", "y" * 4000)
    assert len(long) < 600
    assert long != NAMES.of("x", "y" * 4001)
    assert NAMES.of("x", str(long).removeprefix("urn:test:x:")) != long


def test_the_two_sides_of_a_wildcard_are_one_element() -> None:
    assert NAMES.element(Element("topic", "/*", side="read")) == NAMES.element(Element("topic", "/*", side="write"))
    assert NAMES.element(Element("service", "/s", leg="request")) != NAMES.element(
        Element("service", "/s", leg="response")
    )
    assert NAMES.element(Element("node", "/a")) != NAMES.element(Element("topic", "/a"))


@FORMS
def test_no_blank_node_has_a_label_and_no_context_is_elsewhere(form: str) -> None:
    text = text_of("tame", form)
    assert "_:" not in text
    assert '"@context": "' not in text


@FORMS
def test_the_order_of_the_triples_does_not_matter(form: str) -> None:
    graph = rdf_graph(document_of(system("tame")))
    triples = sorted(graph, key=lambda triple: [str(node) for node in triple])
    texts = set()
    for order in (triples, triples[::-1]):
        other = Graph(bind_namespaces="none")
        for prefix, namespace in graph.namespaces():
            other.bind(prefix, namespace)
        for triple in order:
            other.add(triple)
        texts.add(SERIALISERS[form](other))
    assert texts == {SERIALISERS[form](graph)}


def run(*options: str, **environment: str) -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, "-m", "rosprivacy", "analyze", *CARE_HOME, *options]
    return subprocess.run(command, cwd=ROOT, env={**os.environ, **environment}, capture_output=True, check=False)


class TestTime:
    @pytest.mark.slow
    def test_no_time_is_told_but_that_of_the_environment(self) -> None:
        assert b"dateTime" not in run("-f", "turtle", SOURCE_DATE_EPOCH="").stdout
        told = strict(run("-f", "turtle", SOURCE_DATE_EPOCH="1767225600").stdout.decode(), "turtle")
        moments = {o for o in told.objects() if isinstance(o, Literal) and o.datatype == XSD.dateTime}
        assert {moment.toPython() for moment in moments} == {datetime(2026, 1, 1, tzinfo=timezone.utc)}

    @pytest.mark.parametrize("given_", ["x", "1.5", "9" * 30, "\n"])
    def test_what_is_no_time_is_refused(self, given_: str) -> None:
        with pytest.raises(InputError, match=r"^SOURCE_DATE_EPOCH: .* is not a time; give whole seconds"):
            source_date({"SOURCE_DATE_EPOCH": given_})


@pytest.mark.parametrize("form", one_in(2, SERIALISERS))
def test_the_command_writes_utf_8_wherever_it_goes(cli: Cli, form: str, tmp_path: Path) -> None:
    file = tmp_path / "findings"
    assert cli("analyze", *CARE_HOME, "-f", form, "-o", file, cwd=ROOT).returncode == 1
    done = run("-f", form, PYTHONIOENCODING="ascii", PYTHONUTF8="0", LC_ALL="C")
    assert done.stdout == file.read_bytes()
    assert len(strict(done.stdout.decode(), form)) > 100
