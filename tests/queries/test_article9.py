"""Findings and Article 9 GDPR: filters, where data become special; the program and Cypher give the same answer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import ARTICLE_9
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.queries.library import find
from rosprivacy.queries.run import run
from tests.helpers.graphs import care_home, rows_of
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from neo4j import Driver

CARE = ROOT / "examples" / "care-home"
GRANTS = """<policy version="0.2.0"><enclaves><enclave path="/e"><profiles>
<profile ns="/" node="cam"><topics publish="ALLOW"><topic>image</topic></topics></profile>
<profile ns="/" node="net"><topics subscribe="ALLOW"><topic>image</topic></topics></profile>
</profiles></enclave></enclaves></policy>
"""
ODD = """@prefix rp: <urn:x-rosprivacy:> . @prefix skos: <http://www.w3.org/2004/02/skos/core#> .
<urn:example:Odd> a skos:Concept ; rp:label "Odd" ; skos:broader rp:PersonalData ;
    skos:prefLabel "odd data"@en ; skos:definition "Data of which little is said."@en .
"""
Key = tuple[str, str, str, str]  # provision, verdict, category, leak


def document(**settings: Any) -> dict[str, Any]:
    policy, labels = CARE / "care-home.policy.xml", CARE / "care-home.labels.yaml"
    return rosprivacy.analyze([str(policy)], [str(labels)], **settings).document()


def found(shown: dict[str, Any]) -> set[tuple[str, str]]:
    return {(finding["category"], finding["leak"]["name"]) for finding in shown["findings"]}


def under_article_9(shown: dict[str, Any]) -> set[Key]:
    return {
        (legal["provision"], legal["verdict"], finding["category"], finding["leak"]["name"])
        for finding in shown["findings"]
        for legal in finding["law"]
        if legal["provision"].startswith(ARTICLE_9)
    }


class TestDocument:
    def test_each_finding_says_what_a_person_has_to_look_up(self) -> None:
        shown = document()
        by_category = {finding["category"]: finding for finding in shown["findings"]}
        face, video = by_category["FaceTemplate"], by_category["Video"]
        assert (face["article9"], face["special_from"]["name"]) == ("conditional", "/face_recognizer")
        (legal,) = face["law"]
        assert legal["provision"] == "GDPR Art. 9(1) biometric data"
        assert "uniquely" in legal["condition"]
        assert (video["article9"], video["special_from"]) == ("may-reveal", None)
        assert [(legal["provision"], legal["verdict"]) for legal in video["law"]] == [("GDPR Art. 9(1)", "may-reveal")]


FACE, VIDEO, VOICE = ("FaceTemplate", "/uplink"), ("Video", "/recorder"), ("Voice", "/uplink")
FILTERS: list[tuple[dict[str, Any], set[tuple[str, str]], dict[str, Any]]] = [  # asked, findings, assumptions
    ({"article9": True}, {FACE, VIDEO, VOICE}, {"article9_only": True}),
    ({"article9_level": "may-reveal"}, {FACE, VIDEO, VOICE}, {"article9_level": "may-reveal"}),
    ({"article9_level": "conditional"}, {FACE}, {"article9_level": "conditional"}),
    ({"article9_level": "always"}, set(), {}),
    ({"data_types": ("video",)}, {VIDEO}, {"data_types_asked": ["video"]}),
    ({"data_types": ("video", "audio")}, {VIDEO, VOICE}, {}),
    ({"identity_factors": ("physiological",)}, {VOICE}, {}),
    ({"identity_factors": ["physical", "genetic"]}, {FACE, VIDEO}, {}),
    ({"identity_factors": "economic"}, set(), {"identity_factors_asked": ["economic"]}),
    ({"categories": ("Biometrie",)}, {FACE}, {}),  # the German name
    ({"categories": ("PersonalData",), "article9": True, "data_types": ("video",)}, {VIDEO}, {}),
]
UNKNOWN = [
    ({"article9_level": "alwas"}, r"^--article9-level: 'alwas' is none of .*; did you mean always\?"),
    ({"identity_factors": ("economical",)}, r"--identity-factor: unknown identity factor 'economical'; .*social"),
    ({"data_types": ("vidoe",)}, r"--data-type: unknown data type 'vidoe'; it is one of: .*video"),
]


class TestFilters:
    @pytest.mark.parametrize(("asked", "expected", "assumed"), FILTERS)
    def test_only_what_is_asked_for(
        self, asked: dict[str, Any], expected: set[tuple[str, str]], assumed: dict[str, Any]
    ) -> None:
        shown = document(**asked)
        assert found(shown) == expected
        assert shown["assumptions"].items() >= assumed.items()
        assert expected or shown["verdict"] == "undetermined"  # nothing of the kind is brought in

    def test_kinds_that_may_reveal_at_least(self) -> None:
        kinds = {category["name"] for category in document(article9=True)["categories"]}
        assert kinds == {"FaceTemplate", "Location", "PersonTrack", "Video", "Voice"}

    @pytest.mark.parametrize(("asked", "message"), UNKNOWN)
    def test_what_nothing_has_is_an_error(self, asked: dict[str, Any], message: str) -> None:
        with pytest.raises(InputErrors, match=message):
            document(**asked)

    @pytest.mark.slow
    def test_a_kind_of_which_no_factor_is_stated_is_kept(self, tmp_path: Path) -> None:
        """What is not known of a kind may be what is asked for."""
        policy, labels, mine = tmp_path / "p.xml", tmp_path / "l.yaml", tmp_path / "mine.ttl"
        policy.write_text(GRANTS, "utf-8")
        labels.write_text("labels: 1\nnodes: {/cam: {source: [Odd]}, /net: {leak: [PersonalData]}}\n", "utf-8")
        mine.write_text(ODD, "utf-8")

        def asked(ontology: str) -> set[tuple[str, str]]:
            mine.write_text(ontology, "utf-8")
            result = rosprivacy.analyze(policy, labels, ontologies=mine, identity_factors="economic")
            return found(result.document())

        assert asked(ODD) == {("Odd", "/net")}
        assert asked(ODD.replace("@en .\n", '@en ; rp:identityFactor "economic" .\n')) == {("Odd", "/net")}
        assert asked(ODD.replace("@en .\n", '@en ; rp:identityFactor "social" .\n')) == set()


@pytest.mark.slow
@pytest.mark.database
def test_cypher_says_the_same(driver: Driver) -> None:
    result = care_home()
    expected = under_article_9(result.document())
    assert expected
    load(driver, [rows_of("h1", result)], result.vocabulary)
    query = find("findings-under-article")
    rows = run(driver, query.text, query.values({}))
    at = {name: number for number, name in enumerate(rows.columns)}
    pack = {tuple(row[at[name]] for name in ("provision", "verdict", "category", "leak")) for row in rows.rows}
    one_line = (
        "MATCH (f:Finding)-[:OF_CATEGORY]->()-[u:FALLS_UNDER]->(p:LegalProvision) "
        "WHERE p.name STARTS WITH 'GDPR Art. 9(1)' RETURN p.name, u.verdict, f.category, f.leak"
    )
    plain = {tuple(record.values()) for record in driver.execute_query(one_line).records}
    assert pack == expected
    assert plain == expected
