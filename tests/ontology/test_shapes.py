"""The shapes: ours hold them all, and each refuses what it is there for, with what is wrong and what to do."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyshacl
import pytest
from rdflib import SH, SKOS, Graph

from tests.helpers.daily import one_in
from tests.helpers.ontologies import RP, described, ontology, provisions, shapes

if TYPE_CHECKING:
    from rdflib import URIRef

PREFIXES = """
@prefix rp: <https://w3id.org/rosprivacy#> . @prefix pd: <https://w3id.org/dpv/pd#> . @prefix : <urn:example:> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> . @prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
"""
OWN = """
:Shoe a skos:Concept ; rp:label "Shoe" ; skos:prefLabel "shoe size"@en ; skos:definition "The size of a shoe."@en ;
    skos:broader rp:PhysicalCharacteristic ; rp:dataType "number" .
"""
LAW = 'rp:fallsUnder [ rp:provision rp:GDPR-9-1-health ; rp:verdict "always" ]'


def problems(text: str, *about: str, strict: bool = False) -> set[str]:
    """What the shapes say of a user's ontology, beside some of our categories and all provisions."""
    graph = Graph().parse(data=PREFIXES + text, format="turtle")
    ours = ontology()
    needed = [*provisions(), *(RP[name] for name in (*about, "Categories", "PersonalData", "PhysicalCharacteristic"))]
    for subject in needed:
        graph += described(ours, subject)
    graph += ours.triples((None, RP.inVersion, None))
    return messages(graph, strict=strict)


def messages(graph: Graph, *, strict: bool = False) -> set[str]:
    _, report, _ = pyshacl.validate(graph, shacl_graph=shapes(strict=strict), inplace=True)
    assert isinstance(report, Graph)
    results = report.objects(None, SH.result)  # without their details, which speak of nodes below a subject
    return {str(message) for result in results for message in report.objects(result, SH.resultMessage)}


class TestShapes:
    @pytest.mark.slow
    def test_ours_hold_all_of_them(self) -> None:
        assert messages(ontology(), strict=True) == set()

    @pytest.mark.parametrize(
        ("old", "new"),
        one_in(
            4,
            [
                ("@en", ""),
                ("", ""),
                ("rp:PhysicalCharacteristic", "pd:PhysicalCharacteristic"),
                ("rp:dataType", f"{LAW} ; rp:dataType"),
            ],
        ),
    )
    def test_a_users_category_needs_english_only_and_may_leave_the_law_unsaid(self, old: str, new: str) -> None:
        assert problems(OWN.replace(old, new)) == set()

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("old", "new", "problem"),
        [
            ('rp:label "Shoe" ;', "", "has no label"),
            ('"Shoe"', '"Shoe" , "Shoes"', "has more than one label"),
            ('"Shoe"', '"shoe size"', "has a label that is no identifier"),
            ('"Shoe"', '"Shoe"@en', "has a label that is no identifier"),
            ('"Shoe"', '"VideoLeak"', "has a label that ends like that of a role"),
            ('"Shoe"', '"Topic"', "has a label that means something else in the graph"),
            ('skos:prefLabel "shoe size"@en ;', "", "has no English name"),
            ('"shoe size"@en', '"Schuhgröße"@de', "has no English name"),
            ('"shoe size"@en', '"shoe size"@en , "size of shoe"@en', "has two names in one language"),
            ('"shoe size"@en', '"shoe size"@en , <urn:name>', "has a name that is not a text"),
            ('rp:label "Shoe"', 'rp:label "Shoe" ; skos:altLabel ""', "has a synonym that is not a text"),
            ('skos:definition "The size of a shoe."@en ;', "", "has no English definition"),
            ('"The size of a shoe."@en', '""@en', "has no English definition"),
            ('"The size of a shoe."@en', '"A."@en , "B."@en', "has two definitions in one language"),
            ("rp:PhysicalCharacteristic", '"PhysicalCharacteristic"', "has a parent that is no IRI"),
            ('"number"', '"integer"', "has an unknown data type"),
            ("rp:dataType", 'rp:identityFactor "economical" ; rp:dataType', "has an unknown identity factor"),
            ("rp:dataType", "rp:gdprCategory rp:GDPR-99 ; rp:dataType", "has a GDPR category that is no provision"),
            ("rp:dataType", f"{LAW.replace('-health', '-wealth')} ; rp:dataType", "a provision that is not known"),
            ("rp:dataType", 'rp:fallsUnder [ rp:verdict "always" ] ; rp:dataType', "a provision that is not known"),
            ("rp:dataType", f"{LAW.replace('always', 'maybe')} ; rp:dataType", "without a known verdict"),
            ("rp:dataType", f"{LAW.replace('always', 'may-reveal')} ; rp:dataType", "does not say when"),
            ("rp:dataType", f"{LAW[:-1]} ; rp:source rp:Nowhere ] ; rp:dataType", "names a source that is not known"),
            ("rp:dataType", 'rp:article9 "yes" ; rp:reason "so" ; rp:dataType', "has an rp:article9 that is not"),
            ("rp:dataType", 'rp:article9 "no" ; rp:dataType', "without saying why"),
            ("rp:dataType", 'rp:reason "so" ; rp:dataType', "gives a reason for what it does not state"),
            ("rp:dataType", f'{LAW} ; rp:article9 "no" ; rp:reason "so" ; rp:dataType', "to fall under it"),
            (":Shoe a", "[] a", "has no IRI of its own"),
            # all together
            ("rp:PhysicalCharacteristic", ":Shoe , rp:PhysicalCharacteristic", "is broader than itself"),
            ("rp:PhysicalCharacteristic", "rp:Physical", "has the unknown parent <https://w3id.org/rosprivacy#P"),
            ("rp:PhysicalCharacteristic", "pd:Behavioral", "has the unknown parent <https://w3id.org/dpv/pd#B"),
            ("skos:broader rp:PhysicalCharacteristic ;", "", "leads to none of the shipped categories"),
            ("rp:PhysicalCharacteristic", "pd:Salary", "leads to none of the shipped categories"),
            ('"Shoe"', '"PersonalData"', "have one label"),
            ('"shoe size"@en', '"personal data"@en', "have one English name"),
            ('"shoe size"@en', '"personal data"', "have one English name"),
        ],
    )
    def test_what_is_wrong_is_said_with_what_to_do(self, old: str, new: str, problem: str) -> None:
        assert old in OWN
        found = problems(OWN.replace(old, new))
        assert any(problem in message for message in found), found
        assert all(message.count("; ") == 1 for message in found), found
        assert len(found) <= 2

    def test_a_circle_of_several_is_found(self) -> None:
        other = OWN.replace("Shoe", "Sock").replace("shoe", "sock").replace("rp:PhysicalCharacteristic", ":Shoe")
        circle = OWN.replace("rp:PhysicalCharacteristic", "rp:PhysicalCharacteristic , :Sock") + other
        assert {m.split(" ")[0] for m in problems(circle) if "broader than itself" in m} == {
            "<urn:example:Shoe>",
            "<urn:example:Sock>",
        }

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("predicate", "problem"),
        [
            (SKOS.inScheme, "is in no scheme"),
            (SKOS.prefLabel, "has not one name each"),
            (SKOS.definition, "has not one sentence each"),
            (RP.dataType, "has no data type"),
            (RP.identityFactor, "has no identity factor"),
            (RP.gdprCategory, "has no GDPR category"),
            (RP.fallsUnder, "does not say whether it is under Article 9"),
            (RP.source, "without saying by which source"),
            (RP.condition, "has not its condition in English, German and French"),
        ],
    )
    def test_ours_may_leave_nothing_out(self, predicate: URIRef, problem: str) -> None:
        graph = Graph()
        for subject in (RP.VoicePrint, RP.Biometric, RP.PersonalData, *provisions()):
            graph += described(ontology(), subject)
        graph += ontology().triples((None, RP.inVersion, None))
        assert messages(graph, strict=True) == set()
        for subject in (RP.VoicePrint, *list(graph.objects(RP.VoicePrint, RP.fallsUnder))):
            graph.remove((subject, predicate, None))
        assert any(problem in message for message in messages(graph, strict=True))

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("turtle", "problem"),
        [
            ('rp:X a rp:LegalProvision ; skos:definition "A."@en ; rp:asOf "2026-01-01"^^xsd:date .', "no identifier"),
            ('rp:X a rp:LegalProvision ; rp:identifier "X" ; rp:asOf "2026-01-01"^^xsd:date .', "no meaning"),
            ('rp:X a rp:LegalProvision ; rp:identifier "X" ; skos:definition "A."@en .', "as of which date"),
            ('rp:X a rp:LegalProvision ; rp:identifier "X" ; rp:partOf rp:Video .', "part of something"),
            ('rp:X a rp:LegalProvision ; rp:identifier "GDPR" .', "have one identifier"),
            ('rp:X a rp:LegalProvision ; rp:identifier "X" ; rp:partOf rp:X .', "is a part of itself"),
            ('rp:X a rp:Method ; skos:notation "x" .', "has not one name each"),
            ('rp:X a rp:Method ; skos:notation "x" .', "has not one definition each"),
            ('rp:X a rp:Method ; skos:notation "x" .', "does not say whether it ends the category"),
            ("rp:X a rp:Role .", "has no notation"),
            ('rp:X a rp:Role ; skos:notation "x" . rp:Y a rp:Role ; skos:notation "x" .', "have one notation"),
            ("rp:X a rp:Role ; rp:provision rp:GDPR-99 .", "names a provision that is not known"),
            ('rp:X a rp:Role ; rp:processing "Store" .', "has more than one processing, or none by IRI"),
            ('rp:X a rp:ElementKind ; skos:notation "x" .', "is no kind of element"),
            ('rp:X a rp:ElementKind ; skos:notation "x" .', "has no label that is an identifier"),
        ],
    )
    def test_provisions_and_elements_too(self, turtle: str, problem: str) -> None:
        assert any(problem in message for message in problems(turtle))
