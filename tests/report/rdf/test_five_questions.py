"""What a data-protection officer asks of the export (GDPR, Article 30(1)), in SPARQL, and what the files state."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.documents import document_of
from rosprivacy.report.rdf.findings import rdf_graph
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from rdflib import Graph

    from rosprivacy.result import Result

PREFIXES = """
PREFIX dpv: <https://w3id.org/dpv#> PREFIX rdfs: <http://www.w3.org/2000/01/rdf-schema#>
PREFIX rp: <https://w3id.org/rosprivacy#> PREFIX skos: <http://www.w3.org/2004/02/skos/core#>
"""
KIND = "?f a rp:Finding ; rp:category/skos:prefLabel ?kind ; rp:concerns ?p . FILTER (LANG(?kind) = 'en')"
RECEIVES = "?r a dpv:Recipient ; rdfs:label ?who . ?p dpv:hasRecipient ?r ."


@pytest.fixture(scope="module")
def fleet() -> Graph:
    result: Result = rosprivacy.analyze_fleet(ROOT / "examples" / "fleet" / "fleet.yaml")
    return rdf_graph(document_of(result))


def asked(graph: Graph, select: str, where: str) -> set[tuple[str, ...]]:
    rows = graph.query(f"{PREFIXES} SELECT DISTINCT {select} {{ {KIND} {where} }}")
    return {tuple("" if value is None else str(value) for value in row) for row in rows}  # type: ignore[union-attr]


def test_who_receives_which_kind_and_as_what(fleet: Graph) -> None:
    """Article 30(1)(d), 28: a recipient is a party, not a node."""
    where = f"{RECEIVES} OPTIONAL {{ ?r a dpv:DataProcessor . BIND('processor' AS ?role) }}"
    assert asked(fleet, "?kind ?who ?role", where) == {
        ("location", "Example Robotics Inc.", "processor"),
        ("location", "St. Example Hospital", ""),
        ("video of persons", "Example Vision GmbH", "processor"),
    }


def test_which_transfers_leave_the_eea_and_on_what(fleet: Graph) -> None:
    """Article 30(1)(e): where the file states no safeguard, none is told."""
    where = f"""{RECEIVES} ?r dpv:hasCountry ?c . ?c a dpv:ThirdCountry ; rp:country ?country .
        OPTIONAL {{ ?r rp:at/rp:transferBasis ?basis }}"""
    assert asked(fleet, "?kind ?who ?country ?basis", where) == {("location", "Example Robotics Inc.", "US", "")}


def test_how_long_it_is_kept_where(fleet: Graph) -> None:
    """Article 30(1)(f): the storage's time, and that of its backups after it."""
    where = "?p dpv:hasStorageCondition ?s . ?s rp:at/rp:name ?at ; dpv:hasDuration ?time ."
    assert asked(fleet, "?kind ?at ?time (DATATYPE(?time) AS ?type)", where) == {
        ("video of persons", "footage bucket", time, "http://www.w3.org/2001/XMLSchema#duration")
        for time in ("P30D", "P7D")
    }


def test_whose_data_they_are(fleet: Graph) -> None:
    """Article 30(1)(c): as the labels of the sources name them."""
    told = asked(fleet, "?kind ?persons", "?f rp:concerns/dpv:hasDataSubject/rdfs:label ?persons .")
    assert told >= {("video of persons", persons) for persons in ("patients", "staff", "visitors")}
    assert {persons for kind, persons in told if kind == "location"} == {"staff", "visitors"}


def test_who_is_responsible_what_for_and_on_which_basis(fleet: Graph) -> None:
    """Article 30(1)(a) and (b): of the recipient itself where it is stated, else of the sources, else of the fleet."""
    where = """?f rp:concerns ?p . ?f rp:leak/rp:name ?at . ?p dpv:hasDataController/rdfs:label ?who ;
        dpv:hasPurpose/rdfs:label ?why ; dpv:hasLegalBasis ?term ; rp:statedLegalBasis ?basis ."""
    told = asked(fleet, "?kind ?at ?who ?why ?basis", where)
    assert {who for *_, who, _, _ in told} == {"St. Example Hospital"}
    bucket = {(why, basis) for kind, at, _, why, basis in told if (kind, at) == ("video of persons", "footage bucket")}
    assert bucket == {("proof of accidents", basis) for basis in ("6(1)(f)", "9(2)(f)")}
    screen = {why for _, at, _, why, _ in told if at == "screen"}
    assert screen == {"showing the way"}
    cloud = {why for _, at, _, why, _ in told if at == "fleet cloud"}
    assert cloud == {"delivery of meals and medicines", "guidance of visitors", "cleaning of rooms"}


def test_what_can_fall_under_article_9_or_10_and_how_far(fleet: Graph) -> None:
    where = "?f rp:fallsUnder ?l . ?l rp:verdict ?verdict ; rp:provision/rp:identifier ?provision ."
    assert asked(fleet, "?kind ?provision ?verdict", where) == {
        ("location", "GDPR Art. 9(1)", "may-reveal"),
        ("video of persons", "GDPR Art. 9(1)", "may-reveal"),
    }
