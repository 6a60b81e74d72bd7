"""Findings and Article 9 GDPR: filters, where data become special; the program and Cypher give the same answer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import ARTICLE_9
from rosprivacy.ingest.database.loading import load
from rosprivacy.private_neo4j import connection
from rosprivacy.queries.library import find
from rosprivacy.queries.run import run
from tests.helpers.graphs import care_home, rows_of
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.private_neo4j.connection import Connection

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

    def test_the_date_of_the_law_is_an_assumption(self) -> None:  # S12
        assert document()["assumptions"]["law_as_of"] == "2026-11-21"

    def test_what_a_category_is_stands_once_for_all_its_findings(self) -> None:
        categories = {category["name"]: category for category in document()["categories"]}
        assert categories["Video"]["data_types"] == ["video"]
        (legal,) = categories["Video"]["law"]
        assert legal["sources"][0] == "EDPB Guidelines 3/2019 par. 63"
        assert categories["FaceTemplate"]["gdpr"] == "GDPR Art. 4(14) biometric data"


class TestFilters:
    def test_article_9_only(self) -> None:
        kinds = {category["name"] for category in document(article9=True)["categories"]}
        assert kinds == {"FaceTemplate", "Location", "PersonTrack", "Video", "Voice"}  # all may reveal at least
        assert found(document(article9=True)) == found(document())

    def test_up_to_a_level(self) -> None:
        always = document(article9_level="always")
        assert (always["findings"], always["verdict"]) == ([], "undetermined")  # nothing of the kind is brought in
        on_condition = document(article9_level="conditional")
        assert found(on_condition) == {("FaceTemplate", "/uplink")}
        assert on_condition["assumptions"]["article9_level"] == "conditional"
        assert found(document(article9_level="may-reveal")) == found(document(article9=True))

    def test_an_unknown_level_is_an_error(self) -> None:
        with pytest.raises(InputErrors, match=r"^--article9-level: 'alwas' is none of .*; did you mean always\?"):
            document(article9_level="alwas")

    def test_a_data_type_only(self) -> None:
        assert found(document(data_types=("video",))) == {("Video", "/recorder")}
        assert found(document(data_types=("video", "audio"))) == {("Video", "/recorder"), ("Voice", "/uplink")}

    def test_an_identity_factor_only(self) -> None:
        assert found(document(identity_factors=("physiological",))) == {("Voice", "/uplink")}
        assert found(document(identity_factors=["physical", "genetic"])) == {
            ("FaceTemplate", "/uplink"),
            ("Video", "/recorder"),
        }
        nothing = document(identity_factors="economic")
        assert (nothing["findings"], nothing["verdict"]) == ([], "undetermined")  # nothing of the kind is brought in
        assert nothing["assumptions"]["identity_factors_asked"] == ["economic"]

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

    def test_an_unknown_identity_factor_is_an_error(self) -> None:
        said = r"--identity-factor: unknown identity factor 'economical'; it is one of: cultural, economic, .*social"
        with pytest.raises(InputErrors, match=said):
            document(identity_factors=("economical",))

    def test_a_category_with_narrower_ones_only(self) -> None:
        assert found(document(categories=("Biometrie",))) == {("FaceTemplate", "/uplink")}  # the German name

    def test_filters_narrow_together(self) -> None:
        shown = document(categories=("PersonalData",), article9=True, data_types=("video",))
        assert found(shown) == {("Video", "/recorder")}

    def test_what_is_asked_for_stands_in_the_assumptions(self) -> None:
        assumptions = document(article9=True, data_types=("audio",))["assumptions"]
        assert (assumptions["article9_only"], assumptions["data_types_asked"]) == (True, ["audio"])

    def test_an_unknown_data_type_is_an_error(self) -> None:
        with pytest.raises(InputErrors, match=r"--data-type: unknown data type 'vidoe'; it is one of: .*video"):
            document(data_types=("vidoe",))


@pytest.mark.slow
@pytest.mark.database
def test_cypher_says_the_same(neo4j_server: Connection) -> None:
    result = care_home()
    expected = under_article_9(result.document())
    assert expected
    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
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
