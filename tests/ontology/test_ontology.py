"""The shipped ontology as data: what it covers, its law, its ties to DPV 2.3, three languages.

Queries run over the graph of the files, not over ``ontology/vocabulary.py``, so that both stand on their own.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

import pytest
from rdflib import OWL, RDF, RDFS, SH, SKOS, Graph, Literal, Namespace, URIRef

from rosprivacy.analysis.model import CLEANS, KINDS
from rosprivacy.ingest.neo4j_graph import schema
from tests.helpers.ontologies import FOLDER, RP, SHIPPED, categories, ontology, provisions, shapes

if TYPE_CHECKING:
    from pathlib import Path

    from rdflib.term import Node

PD = Namespace("https://w3id.org/dpv/pd#")
EU_GDPR = Namespace("https://w3id.org/dpv/legal/eu/gdpr#")
DPV_FILES = ("dpv", "pd", "tech", "risk", "eu-gdpr")
DPV_TERM = "https://w3id.org/dpv"
SPECIAL = URIRef(f"{DPV_TERM}#SpecialCategoryPersonalData")
ARTICLE_9_ITEMS = (
    "ethnic-origin", "political-opinions", "beliefs", "trade-union", "genetic", "biometric", "health", "sex-life",
)  # fmt: skip
# What robots meet, by the names that people look for.
COVERED = (
    "face image", "face template", "video of persons", "voice", "voice print", "speech transcript", "gait pattern",
    "body pose", "eye gaze", "fingerprint", "iris template", "health data", "vital sign", "emotion estimate",
    "person track", "trajectory", "GNSS position", "map of a home", "room number", "licence plate", "device identifier",
    "wireless device identifier", "name of a person", "staff badge", "staff performance", "household object",
    "ethnicity", "religion", "political opinion", "trade union membership", "sex life or sexual orientation",
    "genetic data", "criminal offence", "criminal conviction", "depth image of persons", "thermal image of persons",
    "point cloud of persons", "payment data", "employment data", "conversation with a language model",
    "multimodal embedding", "rehabilitation data", "brain signal", "smart home sensor data", "map with names",
    "access event", "phone identifier", "vehicle data", "record of calls", "image of a document",
    "state of a driver or operator",
)  # fmt: skip


@pytest.fixture(scope="module")
def dpv_terms(dpv: Path) -> Graph:
    graph = Graph()
    for name in DPV_FILES:
        graph.parse(dpv / f"{name}.ttl")
    return graph


def named(node: Node) -> str:
    return str(node).removeprefix(str(RP))


def broader(node: Node) -> set[Node]:
    """Our categories above one."""
    parents = list(ontology().objects(node, SKOS.broader))
    above = {up for parent in parents for up in ontology().transitive_objects(parent, SKOS.broader)}
    return {up for up in above if up is not None} & set(categories())


MATCHES = (SKOS.exactMatch, SKOS.closeMatch)


def verdicts(category: Node, *, specific: bool = False) -> dict[str, str]:
    """Provision -> verdict, as the file states them; all, or those that hold whichever narrower kind it is."""
    graph = ontology()
    links = list(graph.objects(category, RP.fallsUnder))
    if specific:
        links = [link for link in links if graph.value(link, RP.unspecific) is None]
    return {named(graph.value(link, RP.provision) or link): str(graph.value(link, RP.verdict)) for link in links}


def article9(category: Node) -> set[str]:
    return {verdict for provision, verdict in verdicts(category).items() if provision.startswith("GDPR-9-1")}


def borrowed(*files: str) -> set[URIRef]:
    """The DPV terms that some files name."""
    nodes = {node for name in files for triple in Graph().parse(FOLDER / f"{name}.ttl") for node in triple}
    return {node for node in nodes if isinstance(node, URIRef) and node.startswith(DPV_TERM)}


def allowed(shape: Node) -> list[str]:
    """The closed list of a shape; empty if it has none."""
    first = shapes().value(shape, SH["in"])
    return [] if first is None else [str(value) for value in shapes().items(first)]


class TestCategories:
    def test_there_are_many_and_what_robots_meet_is_among_them(self) -> None:
        assert len(categories()) >= 75
        names = {str(name) for c in categories() for name in ontology().objects(c, SKOS.prefLabel)}
        assert set(COVERED) <= names

    def test_no_two_can_be_taken_for_each_other(self) -> None:
        """Also in another language, and in upper or lower case: ``Vocabulary.find`` takes any of these."""
        meant: dict[str, set[str]] = defaultdict(set)
        for category in categories():
            meant[named(category).casefold()].add(named(category))
            for predicate in (SKOS.prefLabel, SKOS.altLabel, RP.label):
                for text in ontology().objects(category, predicate):
                    meant[str(text).casefold()].add(named(category))
        assert {text: found for text, found in meant.items() if len(found) > 1} == {}

    def test_a_label_is_that_of_no_other_thing_in_the_graph(self) -> None:
        labels = {str(label) for category in categories() for label in ontology().objects(category, RP.label)}
        kinds = (schema.ELEMENT, schema.ROBOT, schema.ENCLAVE, schema.CATEGORY, schema.PROVISION, schema.FINDING)
        others = {*schema.KIND_LABELS.values(), schema.LEG, schema.WILDCARD, *(kind.label for kind in kinds)}
        assert others <= set(allowed(RP.ReservedLabel))
        assert not labels & others
        assert not labels & {label + role for label in labels for role in ("Source", "Leak", "Sanitizer")}

    def test_each_is_personal_data_and_no_kind_of_itself(self) -> None:
        for category in categories():
            assert category not in broader(category), named(category)
            assert category == RP.PersonalData or RP.PersonalData in broader(category), named(category)

    def test_broader_stays_within_the_scheme(self) -> None:
        """SKOS: ``skos:broader`` is of one scheme; another's term is a ``skos:broadMatch``."""
        parents = {up for category in categories() for up in ontology().objects(category, SKOS.broader)}
        matches = {up for category in categories() for up in ontology().objects(category, SKOS.broadMatch)}
        assert parents <= set(categories())
        assert matches
        assert all(str(term).startswith(DPV_TERM) for term in matches)

    def test_what_is_always_under_article_9_is_special_for_readers_of_dpv_too(self) -> None:
        """And nothing else is: biometric data are on a condition."""
        typed = set(ontology().subjects(RDF.type, SPECIAL))
        assert {c for c in categories() if "always" in article9(c)} == typed
        assert {RP.Ethnicity, RP.Belief} <= typed  # of which DPV does not say so

    @pytest.mark.parametrize(
        ("kind", "said"), [(RP.DataType, RP.dataType), (RP.IdentityFactor, RP.identityFactor)], ids=named
    )
    def test_data_types_and_identity_factors_are_closed_lists_and_each_is_used(self, kind: Node, said: Node) -> None:
        graph = ontology()
        listed = {str(graph.value(t, SKOS.notation)) for t in graph.subjects(RDF.type, kind)}
        in_shapes = [shape for shape in shapes().subjects(SH.path, said) if allowed(shape)]
        narrow = set(categories()) - {RP.PersonalData}
        assert [set(allowed(shape)) for shape in in_shapes] == [listed]
        assert {str(t) for c in narrow for t in graph.objects(c, said)} == listed
        assert {str(t) for t in graph.objects(RP.PersonalData, said)} == listed  # it may be any of them

    def test_the_identity_factors_are_those_of_article_4(self) -> None:
        """Article 4(1): 'a name, an identification number, location data, an online identifier or … factors'."""
        graph = ontology()
        factors = {str(graph.value(f, SKOS.notation)): f for f in graph.subjects(RDF.type, RP.IdentityFactor)}
        assert set(factors) == {
            "name", "number", "location", "online-identifier",
            "physical", "physiological", "genetic", "mental", "economic", "cultural", "social",
        }  # fmt: skip
        assert {graph.value(factor, RP.provision) for factor in factors.values()} == {RP["GDPR-4-1"]}

    FACTORS = {  # noqa: RUF012 - a table
        "PersonName": {"name"}, "PersonIdentifier": {"number"}, "GnssPosition": {"location"},
        "MacAddress": {"online-identifier"}, "Video": {"physical"}, "VitalSign": {"physiological"},
        "DnaSequence": {"genetic"}, "EmotionEstimate": {"mental"}, "DeliveryOrder": {"economic"},
        "StaffPerformance": {"economic"}, "PaymentData": {"economic", "number"},
        "EmploymentData": {"economic", "social"}, "Religion": {"cultural"}, "CommunicationMetadata": {"social"},
        "HouseholdMembers": {"social"},
    }  # fmt: skip

    def test_identity_factors(self) -> None:
        graph = ontology()
        assert {name: {str(f) for f in graph.objects(RP[name], RP.identityFactor)} for name in self.FACTORS} == (
            self.FACTORS
        )


class TestVerdicts:
    """What the law, the guidelines and the judgments say, row by row."""

    @pytest.mark.parametrize(
        ("category", "expected"),
        [
            ("Video", {"GDPR-9-1": "may-reveal"}),  # recital 51; EDPB 3/2019, par. 62 to 65
            ("FaceImage", {"GDPR-9-1": "may-reveal"}),
            ("ThermalImage", {"GDPR-9-1": "may-reveal", "GDPR-9-1-health": "may-reveal"}),
            ("Voice", {"GDPR-9-1": "may-reveal"}),  # EDPB 02/2021: also what is said
            ("VoiceCommand", {"GDPR-9-1": "may-reveal"}),
            ("CommunicationMetadata", {"GDPR-9-1": "may-reveal"}),  # CJEU C-511/18, par. 117
            ("Biometric", {"GDPR-9-1-biometric": "conditional"}),
            ("FaceTemplate", {"GDPR-9-1-biometric": "conditional"}),
            ("VoicePrint", {"GDPR-9-1-biometric": "conditional"}),
            ("GaitPattern", {"GDPR-9-1-biometric": "conditional", "GDPR-9-1-health": "may-reveal"}),
            ("FacialExpression", {"GDPR-9-1-health": "may-reveal"}),  # an expression identifies nobody
            ("EyeGaze", {"GDPR-9-1-health": "may-reveal"}),
            ("WirelessDeviceId", {"GDPR-9-1-health": "may-reveal"}),  # a hearing aid
            ("Accent", {"GDPR-9-1-ethnic-origin": "may-reveal"}),
            ("SkinTone", {"GDPR-9-1-ethnic-origin": "may-reveal"}),
            ("Ethnicity", {"GDPR-9-1-ethnic-origin": "always"}),
            ("RoomNumber", {"GDPR-9-1-health": "may-reveal"}),
            ("MobilityAid", {"GDPR-9-1-health": "may-reveal"}),
            ("VitalSign", {"GDPR-9-1-health": "always"}),
            ("FallEvent", {"GDPR-9-1-health": "conditional"}),  # a passer-by who stumbles
            ("Prescription", {"GDPR-9-1-health": "always"}),
            ("DnaSequence", {"GDPR-9-1-genetic": "always"}),
            ("ReligiousBelief", {"GDPR-9-1-beliefs": "always"}),
            ("PoliticalOpinion", {"GDPR-9-1-political-opinions": "always"}),
            ("TradeUnionMembership", {"GDPR-9-1-trade-union": "always"}),
            ("SexualPreference", {"GDPR-9-1-sex-life": "always"}),
            ("HouseholdMembers", {"GDPR-9-1-sex-life": "may-reveal"}),  # CJEU C-184/20: the name of a partner
            ("CriminalConviction", {"GDPR-10": "always"}),
            # a program's suspicion is no offence
            ("CriminalOffence", {"GDPR-10": "conditional", "GDPR-9-1-health": "may-reveal"}),
            ("WatchListMatch", {"GDPR-10": "conditional", "GDPR-9-1-biometric": "conditional"}),  # by a face
            ("PersonTrack", {"GDPR-9-1": "may-reveal"}),  # CJEU C-511/18, par. 117
            ("GnssPosition", {"GDPR-9-1": "may-reveal"}),
            ("Presence", {"GDPR-9-1": "may-reveal"}),
            ("PaymentData", {"GDPR-9-1": "may-reveal"}),  # to a pharmacy, a church, a party
            ("EmploymentData", {"GDPR-9-1": "may-reveal"}),  # an accident, sick leave
            ("ConversationWithModel", {"GDPR-9-1": "may-reveal"}),
            ("MultimodalEmbedding", {"GDPR-9-1": "may-reveal"}),  # biometric only where a person is recognised by it
            ("RehabilitationData", {"GDPR-9-1-health": "always"}),  # recital 35: physiological state
            ("BrainSignal", {"GDPR-9-1-health": "always"}),
            ("SmartHomeSensorData", {"GDPR-9-1": "may-reveal"}),
            ("AnnotatedMap", {"GDPR-9-1": "may-reveal"}),
            ("AccessEvent", {"GDPR-9-1": "may-reveal"}),
            ("VehicleData", {"GDPR-9-1": "may-reveal"}),
            ("CallLog", {"GDPR-9-1": "may-reveal"}),  # CJEU C-511/18, par. 117
            ("DocumentImage", {"GDPR-9-1": "may-reveal"}),
            ("DriverOrOperatorState", {"GDPR-9-1-health": "conditional"}),  # of a measured state, an illness
            ("WearableTag", {"GDPR-9-1": "may-reveal"}),  # its place, as of Location
            ("WorkLocation", {"GDPR-9-1": "may-reveal"}),  # the door of a works council, as of AccessEvent
            ("IncidentReport", {"GDPR-10": "conditional", "GDPR-9-1-health": "may-reveal"}),
            ("PhoneIdentifier", {}),
            ("HomeLocation", {}),
            ("LicencePlate", {}),
            ("StaffPerformance", {}),
            ("PersonIdentifier", {}),
            ("PersonalData", {"GDPR-9-1": "may-reveal"}),  # the label does not say which kind
        ],
    )
    def test_verdict(self, category: str, expected: dict[str, str]) -> None:
        assert verdicts(RP[category]) == expected

    def test_each_item_of_article_9_has_categories(self) -> None:
        used = {provision for category in categories() for provision in verdicts(category)}
        assert {f"GDPR-9-1-{item}" for item in ARTICLE_9_ITEMS} <= used

    def test_article_10_stands_apart(self) -> None:
        ten = [category for category in categories() if "GDPR-10" in verdicts(category)]
        assert len(ten) >= 3
        for category in ten:
            said_no = (category, RP.article9, Literal("no")) in ontology()
            assert said_no == (not article9(category))
        assert [named(category) for category in ten if article9(category)] == [
            "CriminalData", "CriminalOffence", "IncidentReport", "WatchListMatch",
        ]  # fmt: skip

    def test_no_kind_is_less_than_a_narrower_one(self) -> None:
        """A source may emit any narrower kind than the one it names (rule S7): 'no' would be wrong then."""
        for category in categories():
            for up in broader(category) if verdicts(category) else ():
                assert verdicts(up), f"{named(up)} is 'no', but {named(category)} is under {verdicts(category)}"
                assert article9(up) or not article9(category), (
                    f"{named(up)} is not under Article 9, but {named(category)}"
                )

    def test_no_kind_is_weaker_than_a_broader_one(self) -> None:
        """Who names the narrower kind hears no less; but for what is said only because the kind is not named."""
        strength = ("may-reveal", "conditional", "always")
        compared = 0
        for category in categories():
            for up in broader(category):
                for provision, verdict in verdicts(up, specific=True).items():
                    compared += 1
                    here = [
                        own
                        for item, own in verdicts(category).items()
                        if RP[provision] in ontology().transitive_objects(RP[item], RP.partOf)
                    ]
                    assert here, f"{named(category)} says nothing of {provision}, unlike {named(up)}"
                    assert max(map(strength.index, here)) >= strength.index(verdict), (named(category), named(up))
        assert compared > 40


class TestLaw:
    def test_what_is_cited_is_there(self) -> None:
        wanted = {
            *(f"GDPR-4-{n}" for n in (1, 5, 13, 14, 15)),
            *(f"GDPR-5-1-{x}" for x in "bcdef"),
            *(f"GDPR-6-1-{x}" for x in "abcdef"),
            *(f"GDPR-9-1-{item}" for item in ARTICLE_9_ITEMS),
            *(f"GDPR-9-2-{x}" for x in "abcdefghij"),
            *(f"GDPR-{n}" for n in (10, 25, 28, 30, 32, 35, "35-3", 44, 45, 46, 47, 48, 49)),
            "GDPR-recital-26", "GDPR-recital-51", "EDPB-3-2019",
        }  # fmt: skip
        assert wanted <= {named(provision) for provision in provisions()}

    def test_every_provision_that_is_pointed_to_is_described(self) -> None:
        graph = ontology()
        pointers = (RP.provision, RP.source, RP.gdprCategory, RP.partOf, RP.lookAt)
        pointed = {target for pointer in pointers for target in graph.objects(None, pointer)}
        assert pointed <= set(provisions())

    @pytest.mark.parametrize("provision", provisions(), ids=named)
    def test_each_says_what_it_means_in_a_sentence_and_as_of_when(self, provision: Node) -> None:
        for meaning in ontology().objects(provision, SKOS.definition):
            assert str(meaning).endswith(".")
            assert ". " not in str(meaning).replace("Version 2.0", "").replace("29. Januar", "").replace("7. Juli", "")
        assert str(ontology().value(provision, RP.asOf)) in {"2026-11-21", "2026-11-22", "2026-11-25", "2026-11-28"}

    @pytest.mark.parametrize(("article", "letters"), [("6-1", "abcdef"), ("9-2", "abcdefghij")])
    def test_legal_bases_are_those_of_dpv(self, article: str, letters: str) -> None:
        for letter in letters:
            provision = RP[f"GDPR-{article}-{letter}"]
            assert (provision, SKOS.closeMatch, EU_GDPR[f"A{article}-{letter}"]) in ontology()
            assert (provision, RP.partOf, RP[f"GDPR-{article}"]) in ontology()

    def test_the_items_of_article_9_are_parts_of_it(self) -> None:
        for item in ARTICLE_9_ITEMS:
            above = set(ontology().transitive_objects(RP[f"GDPR-9-1-{item}"], RP.partOf))
            assert {RP["GDPR-9-1"], RP["GDPR-9"], RP.GDPR} <= above


@pytest.mark.slow
class TestDpv:
    def test_every_term_that_is_named_is_in_the_list(self) -> None:
        listed = set(ontology().subjects(RP.inVersion, Literal("2.3")))
        assert borrowed(*(name for name in SHIPPED if name != "dpv")) <= listed

    def test_the_list_is_true(self, dpv_terms: Graph) -> None:
        assert {str(version) for version in dpv_terms.objects(None, OWL.versionInfo)} == {"2.3"}
        assert [term for term in borrowed(*SHIPPED) if (term, RDF.type, None) not in dpv_terms] == []

    def test_it_names_all_kinds_of_personal_data_of_dpv(self, dpv_terms: Graph) -> None:
        theirs = {term for term in dpv_terms.subjects(RDF.type, SKOS.Concept) if str(term).startswith(str(PD))}
        assert theirs <= set(ontology().subjects(RP.inVersion, None))

    def test_twelve_terms_were_respelt(self, dpv_terms: Graph) -> None:
        respelt = {str(old): term for term, old in ontology().subject_objects(RP.formerly)}
        assert len(respelt) == 12
        assert respelt[str(PD.Behavioral)] == PD.Behavioural
        assert not [old for old in respelt if (URIRef(old), RDF.type, None) in dpv_terms]

    def test_each_category_leads_into_dpv(self) -> None:
        ties = (SKOS.broadMatch, SKOS.exactMatch, SKOS.closeMatch, SKOS.relatedMatch)
        for category in categories():
            targets = [target for tie in ties for target in ontology().objects(category, tie)]
            assert any(str(target).startswith(DPV_TERM) for target in targets), named(category)

    def test_the_hierarchy_is_that_of_dpv_where_no_note_says_why_not(self, dpv_terms: Graph) -> None:
        ours = {term: category for category, term in ontology().subject_objects(SKOS.exactMatch)}
        for category in categories():
            ties = {term for tie in (SKOS.exactMatch, SKOS.broadMatch) for term in ontology().objects(category, tie)}
            theirs = {up for term in ties for up in dpv_terms.transitive_objects(term, SKOS.broader)}
            missing = {ours[up] for up in theirs if up in ours} - broader(category) - {category}
            assert not missing or ontology().value(category, SKOS.note), named(category)

    def test_each_special_category_of_dpv_has_one_of_ours_with_a_verdict(self, dpv_terms: Graph) -> None:
        special = set(dpv_terms.subjects(RDF.type, SPECIAL))
        assert len(special) == 32
        for term in special:
            (category,) = (c for match in MATCHES for c in ontology().subjects(match, term))
            assert article9(category), named(category)

    def test_a_note_says_why_a_verdict_is_not_the_typing_of_dpv(self, dpv_terms: Graph) -> None:
        """DPV types a term as special or not; 'may reveal' is not its question."""
        special = set(dpv_terms.subjects(RDF.type, SPECIAL))
        differ = set()
        pairs = (pair for match in MATCHES for pair in ontology().subject_objects(match))
        for category, term in ((category, term) for category, term in pairs if str(term).startswith(str(PD))):
            stated = article9(category)
            if (stated != {"always"}) if term in special else (stated & {"always", "conditional"}):
                differ.add(named(category))
                assert ontology().value(category, SKOS.note), named(category)
        assert differ == {"Biometric", "Ethnicity", "FaceTemplate", "FacialExpression", "Fingerprint", "RetinaPattern"}


class TestElements:
    def of_type(self, kind: str) -> dict[str, Node]:
        graph = ontology()
        return {str(graph.value(item, SKOS.notation)): item for item in graph.subjects(RDF.type, RP[kind])}

    def test_the_kinds_are_those_of_the_model_with_the_labels_of_the_graph(self) -> None:
        kinds = self.of_type("ElementKind")
        assert set(kinds) == set(KINDS)
        assert {n: str(ontology().value(kind, RP.label)) for n, kind in kinds.items()} == schema.KIND_LABELS

    def test_the_methods_are_those_of_label_files(self) -> None:
        ends = {n: str(ontology().value(item, RP.endsCategory)) for n, item in self.of_type("Method").items()}
        assert ends == {method.value: str(method.ends).lower() for method in CLEANS}

    @pytest.mark.parametrize(
        ("kind", "notations"),
        [
            ("Role", {"source", "leak", "sanitizer", "conduit", "derivation"}),
            ("FindingKind", {"disclosure", "storage-limitation", "third-country-transfer", "unprotected-channel"}),
            ("Verdict", {"always", "conditional", "may-reveal", "concerns", "no"}),
        ],
    )
    def test_what_there_is(self, kind: str, notations: set[str]) -> None:
        assert set(self.of_type(kind)) == notations

    @pytest.mark.slow
    def test_processing_is_processing_in_dpv(self, dpv_terms: Graph) -> None:
        for term in ontology().objects(None, RP.processing):
            assert (term, RDF.type, URIRef("https://w3id.org/dpv#Processing")) in dpv_terms
        for term in ontology().objects(None, RP.risk):
            assert (term, RDF.type, URIRef("https://w3id.org/dpv/risk#PotentialRisk")) in dpv_terms

    def test_classes_are_classes(self) -> None:
        for kind in ("Role", "ElementKind", "FindingKind"):
            assert all((item, RDF.type, RDFS.Class) in ontology() for item in self.of_type(kind).values())


def test_no_file_says_anything_twice_or_of_nothing() -> None:
    """Each subject of ours stands in one file, so that there is one place to look."""
    where: dict[Node, set[str]] = defaultdict(set)
    for name in SHIPPED:
        for subject in set(Graph().parse(FOLDER / f"{name}.ttl").subjects()):
            if isinstance(subject, URIRef):
                where[subject].add(name)
    assert {subject: files for subject, files in where.items() if len(files) > 1} == {}
