"""Our terms have two names, and both mean the same: what people wrote with the old one says what it said."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest
from rdflib import OWL, SKOS, Graph, URIRef

import rosprivacy
from rosprivacy.ontology.iris import PUBLISHED, STORED, as_published, as_stored
from rosprivacy.ontology.vocabulary import load
from tests.helpers.daily import one_in
from tests.helpers.ontologies import SHIPPED
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ontology.vocabulary import Vocabulary
    from tests.helpers.command import Cli

CARE = ("examples/care-home/care-home.policy.xml", "examples/care-home/care-home.labels.yaml")
MINE = """@prefix :     <urn:example:clinic:> .
@prefix rp:   <{0}> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
:PulseCurve a skos:Concept ; rp:label "PulseCurve" ; skos:broader {1} ; rp:dataType "number" ;
    skos:prefLabel "pulse curve"@en ; skos:definition "The pulse of a patient over time."@en ;
    rp:fallsUnder [ rp:provision rp:GDPR-9-1-health ; rp:verdict "always" ] .
"""


def read(folder: Path, text: str) -> Vocabulary:
    file = folder / "mine.ttl"
    file.write_text(text, "utf-8")
    return load(folder / "cache", [str(file)])._replace(sources=())  # the file's hash differs


@pytest.fixture(scope="module")
def old(tmp_path_factory: pytest.TempPathFactory) -> Vocabulary:
    return read(tmp_path_factory.mktemp("old"), MINE.format(STORED, "rp:Health"))


@pytest.mark.slow
@pytest.mark.parametrize(
    "parent",
    one_in(
        2,
        [
            "rp:Health", f"<{STORED}Health>", f"<{PUBLISHED}Health>",
            "<https://w3id.org/\\u0072osprivacy#Health>",  # an escape of Turtle
        ],
    ),
)  # fmt: skip
@pytest.mark.parametrize("namespace", [STORED, PUBLISHED])
def test_an_ontology_of_users_says_the_same_with_either(
    old: Vocabulary, tmp_path: Path, namespace: str, parent: str
) -> None:
    assert old.categories["PulseCurve"].article9 == "always"
    assert old.categories["PulseCurve"].broader == ("Health",)
    assert read(tmp_path, MINE.format(namespace, parent)) == old


def test_relative_to_a_base_too(tmp_path: Path) -> None:
    text = MINE.format(PUBLISHED, "<#Health>").replace("@prefix :", "@base <https://w3id.org/rosprivacy> .\n@prefix :")
    assert read(tmp_path, text).categories["PulseCurve"].broader == ("Health",)


@pytest.mark.slow
def test_a_name_that_is_taken_is_taken_in_both(tmp_path: Path, cli: Cli) -> None:
    for namespace in (STORED, PUBLISHED):
        taken = MINE.format(PUBLISHED, "rp:Health").replace(
            "skos:pref", f'skos:altLabel "{namespace}voice" ; skos:pref'
        )
        (tmp_path / "mine.ttl").write_text(taken, "utf-8")
        done = cli("categories", "--ontology", "mine.ttl", cwd=tmp_path)
        assert done.returncode == 2
        assert f"and so has <{PUBLISHED}Voice>" in done.stderr


def test_what_is_published_has_the_published_name_only() -> None:
    files = [*(ROOT / "ontology" / f"{name}.ttl" for name in (*SHIPPED, "shapes"))]
    for file in (*files, ROOT / "report" / "rdf" / "findings.shapes.ttl"):
        text = file.read_text("utf-8").replace(f'"^{STORED}"', "")  # a pattern of the shapes
        assert STORED not in text, file.name
        assert f"<{PUBLISHED}>" in text


def test_documents_keep_the_name_under_which_they_have_always_told_it() -> None:
    """What people saved, and look for in Neo4j, is found as before (the contracts of DESIGN.md)."""
    earlier = json.loads((ROOT / "tests/cases/earlier/care-home/analysis.json").read_text("utf-8"))
    result = rosprivacy.analyze([str(ROOT / CARE[0])], [str(ROOT / CARE[1])])
    told = {category["name"]: category["iri"] for category in result.document()["categories"]}
    assert {category["name"]: category["iri"] for category in earlier["categories"]} == told
    assert [f["id"] for f in earlier["findings"]] == [f.id for f in result.shown.findings]
    assert PUBLISHED not in result.to("json1") + result.to("sarif")


def test_linked_data_says_that_both_are_the_same() -> None:
    result = rosprivacy.analyze([str(ROOT / CARE[0])], [str(ROOT / CARE[1])])
    graph = Graph().parse(data=result.to("turtle"), format="turtle")
    named = {term for triple in graph for term in triple if isinstance(term, URIRef) and term.startswith(STORED)}
    assert named == set(graph.objects(None, OWL.sameAs))
    for category in result.document()["categories"]:
        concept = URIRef(as_published(category["iri"]))
        assert graph.value(concept, SKOS.prefLabel)
        assert graph.value(concept, OWL.sameAs) == URIRef(category["iri"])
        assert as_stored(str(concept)) == category["iri"]
