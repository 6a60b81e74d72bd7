"""All processing as linked data: a row of the register gives a process that says what the row says, and no more.

The rows are held cell by cell against RDF alone; what the register itself may say is held in
``tests/analysis/findings/test_register.py``, and the other views in ``tests/report/test_views_of_the_register.py``.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rdflib import RDF, RDFS, Graph, Literal, Namespace, URIRef

import rosprivacy
from rosprivacy.analysis.durations import parse
from rosprivacy.analysis.model import NO_BASIS, NonRosFacts
from rosprivacy.analysis.non_ros import EVERY, RECIPIENTS, TRANSFERS
from rosprivacy.documents import document_of
from rosprivacy.formats import Style, written
from rosprivacy.report.document.analysis import json_document
from rosprivacy.report.rdf.findings import rdf_graph
from rosprivacy.report.rdf.terms import DPV, RP
from tests.helpers.answers import answer_of
from tests.helpers.concerned import VOCABULARY, Case, cases
from tests.helpers.fleet_files import policy
from tests.helpers.graphs import hospital
from tests.helpers.linked_data import answered, problems, questions
from tests.helpers.linked_rows import comparable, rows_told
from tests.helpers.systems import analysed

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.report.document.contents import Document

THEIRS = Namespace("https://w3id.org/dpv#")  # all of DPV; ours has the terms that the export itself names
GDPR = Namespace("https://w3id.org/dpv/legal/eu/gdpr#")
REST: dict[str, Any] = {"rosprivacy": "1", "policies": [], "labels": [], "standard_channels": None}
AREAS = {"DE": "eea", "CH": "adequate", "US": "partly", "TN": "third", "": ""}
PERIODS = [parse(one) for one in ("P30D", "P1Y", "P4W")]
EXACT = {  # what a label calls a transfer, or an article that it states -> the term of DPV, where it is one of them
    "adequacy": "A45-3", "45": "A45-3", "46(2)(c)": "A46-2-c", "49(1)(a)": "A49-1-a", "47": "A46-2-b",
    "binding-corporate-rules": "A46-2-b", "certification": "A46-2-f", "derogation": "", "authorised-clauses": "",
}  # fmt: skip
POLICY = """<policy version="0.2.0"><enclaves><enclave path="/"><profiles>
<profile ns="/" node="camera"><topics publish="ALLOW"><topic>image</topic></topics></profile>
<profile ns="/" node="uplink"><topics subscribe="ALLOW"><topic>image</topic></topics></profile>
</profiles></enclave></enclaves></policy>"""
LABELS = """labels: 1
nodes:
  /camera: {{source: [Video], subjects: {subjects}}}
  /uplink: conduit
channels: {{/image: sensitive}}
elements:
  archive: {{kind: storage, {facts}}}
flows: [{{from: /uplink, to: archive}}]
"""


@st.composite
def facts(draw: st.DrawFn) -> NonRosFacts:
    country = draw(st.sampled_from(sorted(AREAS)))
    kept = draw(st.sampled_from([(), *(((EVERY, one),) for one in PERIODS)]))
    return NonRosFacts(
        retention=kept,
        backups=draw(st.sampled_from([None, False, True, PERIODS[0]])),
        encrypted=draw(st.sampled_from([None, False, True])),
        country=country,
        area=AREAS[country],
        operator=draw(st.sampled_from(["", "Cloud A"])),
        recipient=draw(st.sampled_from(["", *RECIPIENTS])),
        transfer=draw(st.sampled_from(["", NO_BASIS, *TRANSFERS])),
        contract=draw(st.sampled_from(["", "contract of May"])),
    )


@given(cases(), st.data())
@settings(deadline=None)
def test_each_row_of_a_random_system_is_told_cell_by_cell(case: Case, data: st.DataObject) -> None:
    analysis = analysed(case.system)
    if analysis is not None:
        outside = {element: data.draw(facts()) for element in analysis.graph.elements if not element.is_channel}
        check_rows(document_of(answer_of(analysis, VOCABULARY, REST, outside=outside, bound=case.bound())))


def check_rows(document: Document) -> Graph:
    graph = rdf_graph(document)
    rows = {row["id"]: comparable(row) for row in json_document(document)["register"]}
    told = rows_told(graph)
    assert told.keys() == rows.keys()
    for name, row in rows.items():
        assert told[name] == row
    return graph


@pytest.mark.slow
def test_each_row_of_a_fleet_is_told_cell_by_cell() -> None:
    graph = check_rows(document_of(hospital()))
    assert {str(state) for state in graph.objects(None, RP.state)} >= {"no-finding", "open"}
    assert problems(graph) == ""


def test_places_that_differ_only_in_the_robot_are_all_told(tmp_path: Path) -> None:
    """Two models whose robots have a screen of one name: one row, two places."""
    models = ""
    for model, camera in (("small", "camera"), ("large", "periscope")):
        (tmp_path / f"{model}.xml").write_text(policy(f"{camera}>/image", "screen</image"), "utf-8")
        nodes = f"{{/{camera}: {{source: [Video]}}, /screen: {{leak: [Video]}}}}"
        (tmp_path / f"{model}.yaml").write_text(f"labels: 1\nnodes: {nodes}\n", "utf-8")
        models += f"  {model}: {{policies: {model}.xml, labels: {model}.yaml}}\n"
    robots = "robots: {a: {model: small}, b: {model: large}}\n"
    (tmp_path / "fleet.yaml").write_text(f"fleet: 1\nmodels:\n{models}{robots}", "utf-8")
    graph = check_rows(document_of(rosprivacy.analyze_fleet(tmp_path / "fleet.yaml")))
    assert len({*graph.objects(only_row(graph), RP.place)}) == 2
    assert problems(graph) == ""


def archive(folder: Path, stated: str, subjects: str = "[visitors]") -> rosprivacy.Result:
    (folder / "p.xml").write_text(POLICY, "utf-8")
    (folder / "l.yaml").write_text(LABELS.format(facts=stated, subjects=subjects), "utf-8")
    return rosprivacy.analyze(folder / "p.xml", folder / "l.yaml")


def only_row(graph: Graph) -> URIRef:
    (row,) = graph.subjects(RDF.type, RP.RegisterRow)
    assert isinstance(row, URIRef)
    return row


LAWFUL = (
    "country: US, operator: Cloud A, recipient: processor, contract: contract-1, "
    "transfer: standard-clauses, retention: P1Y"
)


def test_a_lawful_transfer_is_told_with_its_safeguard(tmp_path: Path) -> None:
    """Article 30(1)(e): the register, and so this file, has it although nothing is found."""
    result = archive(tmp_path, f"{LAWFUL}, encrypted: true")
    assert not result.analysis.findings
    graph = check_rows(document_of(result))
    row = only_row(graph)
    assert {*graph.objects(row, DPV.hasProcessing)} == {DPV.Store, DPV.CrossBorderTransfer}
    assert {*graph.objects(row, DPV.hasOrganisationalMeasure)} == {GDPR.StandardContractualClauses}
    assert {*graph.objects(row, RP.state)} == {Literal("no-finding")}
    assert problems(graph) == ""


@pytest.mark.parametrize(
    ("stated", "answers"),
    [
        (
            f"{LAWFUL}, legal_basis: ['46(2)(c)']",
            {("US", "partly", "46(2)(c)", "false"), ("US", "partly", "standard-clauses", "false")},
        ),
        ("country: CH", {("CH", "adequate", "", "false")}),
        ("country: US, transfer: none", {("US", "partly", "none", "true")}),
        ("country: TN, transfer: derogation", {("TN", "third", "derogation", "true")}),
        ("note: nothing is known", {("", "", "", "true")}),
        ("country: FR", set()),
    ],
)
def test_the_question_of_the_page_finds_each_transfer_with_its_safeguard(
    tmp_path: Path, stated: str, answers: set[tuple[str, ...]]
) -> None:
    graph = rdf_graph(document_of(archive(tmp_path, stated)))
    assert {row[2:] for row in answered(graph, questions()[0])} == answers


@pytest.mark.parametrize("stated", EXACT)
def test_a_basis_of_a_transfer_has_the_term_of_its_point_where_it_is_one(tmp_path: Path, stated: str) -> None:
    """``standard-clauses`` are of two points of Article 46(2), a derogation is of seven of Article 49(1)."""
    basis = f"legal_basis: ['{stated}']" if stated[0].isdigit() else f"transfer: {stated}"
    graph = check_rows(document_of(archive(tmp_path, f"country: TN, {basis}")))
    terms = {str(one).removeprefix(str(GDPR)) for one in graph.objects(only_row(graph), DPV.hasLegalBasis)}
    assert terms == ({EXACT[stated]} if EXACT[stated] else set())


def test_bases_of_which_dpv_has_no_term_are_told_as_they_are_stated(tmp_path: Path) -> None:
    graph = check_rows(document_of(archive(tmp_path, "country: DE, legal_basis: ['6(1)(f)', '9(2)(h)', '9(3)', '10']")))
    row = only_row(graph)
    assert {str(one) for one in graph.objects(row, RP.statedLegalBasis)} == {"6(1)(f)", "9(2)(h)", "9(3)", "10"}
    assert {*graph.objects(row, DPV.hasLegalBasis)} == {GDPR["A6-1-f"], GDPR["A9-2-h"]}


def test_a_measure_that_some_ways_lead_past_is_told_as_one(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(
        policy("camera>/image<", "blur>/blurred</image", "uplink></image,/blurred"), "utf-8"
    )
    nodes = "{/camera: {source: [Video]}, /blur: {sanitizer: {Video: pseudonymise}}, /uplink: {leak: [Video]}}"
    (tmp_path / "l.yaml").write_text(f"labels: 1\nnodes: {nodes}\n", "utf-8")
    graph = check_rows(document_of(rosprivacy.analyze(tmp_path / "p.xml", tmp_path / "l.yaml")))
    (measure,) = graph.objects(only_row(graph), DPV.hasTechnicalMeasure)
    assert {*graph.objects(measure, RP.everywhere)} == {Literal(lexical_or_value=False)}
    assert {*graph.objects(measure, RDF.type)} == {DPV.Pseudonymisation}
    assert problems(graph) == ""


def test_what_nobody_states_gives_no_triple_and_is_to_be_completed(tmp_path: Path) -> None:
    graph = check_rows(document_of(archive(tmp_path, "note: nothing is known")))
    row = only_row(graph)
    told = {str(one) for one in graph.objects(row, RP.toComplete)}
    assert told >= {"controllers", "purposes", "bases", "operator", "recipient", "country", "safeguards", "retention"}
    for silent in (
        DPV.hasRecipient, DPV.hasCountry, DPV.hasStorageCondition, DPV.hasLegalBasis, DPV.hasPurpose, RP.area,
        RP.transferBasis, DPV.hasDataController, RP.encrypted, RP.backups, DPV.hasOrganisationalMeasure,
    ):  # fmt: skip
        assert not list(graph.objects(row, silent)), silent
    assert problems(graph) == ""


@pytest.mark.parametrize(
    ("stated", "terms"),
    [
        ("[children]", {"Child"}), ("[Kinder]", {"Child"}), ("[enfants]", {"Child"}), ("[STAFF]", {"Employee"}),
        ("[Beschäftigte]", {"Employee"}), ("[patients]", {"Patient"}), ("[' elderly  people']", {"ElderlyDataSubject"}),
        ("[residents]", set()), ("[children of visitors]", set()), ("[no children]", set()),
    ],
)  # fmt: skip
def test_a_known_word_for_persons_is_a_term_of_dpv_too(tmp_path: Path, stated: str, terms: set[str]) -> None:
    """A text that is not a word of the list stays what it is: nobody guesses from a part of it."""
    graph = check_rows(document_of(archive(tmp_path, LAWFUL, stated)))
    persons = {*graph.objects(only_row(graph), DPV.hasDataSubject)}
    kinds = {kind for one in persons for kind in graph.objects(one, RDF.type)}
    assert kinds == {DPV.DataSubject, *(THEIRS[name] for name in terms)}
    assert {str(name) for one in persons for name in graph.objects(one, RDFS.label)} == {stated.strip("[]' ")}
    called = {str(law) for law in graph.objects(only_row(graph), RP.lookAt)}
    assert (str(RP["GDPR-recital-38"]) in called) == ("Child" in terms)
    assert problems(graph) == ""


def test_a_redacted_row_keeps_what_is_no_name(tmp_path: Path) -> None:
    result = archive(tmp_path, f"{LAWFUL}, legal_basis: ['46(2)(c)']", "[night guards]")
    whole, copy = (
        Graph().parse(data=written(result, "turtle", Style(redact=redact)), format="turtle") for redact in (False, True)
    )
    row = only_row(copy)
    for kept in (RP.id, RP.area, RP.state, RP.toComplete, RP.transferBasis, RP.statedSafeguard, RP.article9):
        assert set(copy.objects(row, kept)) == set(whole.objects(only_row(whole), kept)) != set(), kept
    text = "\n".join(str(term) for triple in copy for term in triple)
    assert [
        name for name in ("archive", "Cloud A", "c1", "night guards", "camera") if re.search(rf"\b{name}\b", text)
    ] == []
    assert problems(copy) == ""
