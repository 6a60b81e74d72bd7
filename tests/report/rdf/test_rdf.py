"""Findings as RDF: they say what the JSON document says, in words that exist, in bytes that no name can change."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from rdflib import DCTERMS, RDF, RDFS, SKOS, XSD, Graph, Literal, Namespace, URIRef
from rdflib.collection import Collection
from rdflib.namespace import PROV

import rosprivacy
from rosprivacy.analysis.durations import parse
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.model import Bound, Category, Element, Flow, FlowGraph, Legal, Method, NonRosFacts
from rosprivacy.analysis.non_ros import EVERY
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.documents import document_of
from rosprivacy.formats import written
from rosprivacy.ontology.iris import as_published
from rosprivacy.ontology.vocabulary import Vocabulary
from rosprivacy.report.rdf.findings import rdf_graph
from rosprivacy.report.rdf.process import legal_of
from rosprivacy.report.rdf.serialise import as_turtle
from rosprivacy.report.rdf.terms import (
    BASES,
    DPV,
    DPV_CLASSES,
    DPV_PROPERTIES,
    EU_GDPR,
    RISK,
    RISKS,
    RP,
    TOOLS,
    TRANSFERS,
    IndividualNames,
)
from tests.helpers.answers import accepting, answer_of
from tests.helpers.cases import CASES
from tests.helpers.daily import one_in
from tests.helpers.linked_data import problems, strict
from tests.helpers.ontologies import ontology
from tests.helpers.paths import ROOT
from tests.helpers.systems import PARENTS, System, analysed, statement, systems

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from rdflib.term import Node

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.durations import Duration
    from rosprivacy.result import Result

CARE_HOME = ("examples/care-home/care-home.policy.xml", "-l", "examples/care-home/care-home.labels.yaml")
VOCABULARY = Vocabulary.of(Category(n, f"urn:test:{n}", n, n, f"{n}.", up) for n, up in PARENTS.items())
REST: dict[str, Any] = {"rosprivacy": "1.2.3"}
BASE = "urn:test:"
DPV_KIND = Namespace("https://w3id.org/dpv#")
NAMES = IndividualNames(BASE)


def result_of(case: Path, **options: Any) -> Result:
    given_ = json.loads((case / "case.json").read_text())
    with chdir(ROOT / "examples"):
        return rosprivacy.analyze(given_["policies"], given_["labels"], **given_.get("options", {}), **options)


def graph_of_analysis(analysis: Analysis, outside: Mapping[Element, NonRosFacts] | None = None) -> Graph:
    return rdf_graph(document_of(answer_of(analysis, VOCABULARY, REST, outside=outside)), base=BASE)


@pytest.fixture(scope="module")
def care_home() -> Result:
    with chdir(ROOT):
        return rosprivacy.analyze([CARE_HOME[0]], [CARE_HOME[2]], paths="all")


@pytest.fixture(scope="module")
def graph(care_home: Result) -> Graph:
    return rdf_graph(document_of(care_home))


@pytest.fixture(scope="module")
def dpv(corpus: Path) -> Graph:
    graph = Graph()
    for name in ("dpv", "pd", "risk", "eu-gdpr"):
        graph.parse(corpus.parent / "dpv" / f"{name}.ttl")
    return graph


@pytest.mark.slow
class TestTerms:
    """Every word of DPV is one of DPV 2.3; its files stay where they are."""

    @pytest.mark.parametrize(
        ("namespace", "names", "kind"),
        [
            (DPV, DPV_CLASSES, RDFS.Class),
            (DPV, DPV_PROPERTIES, RDF.Property),
            (EU_GDPR, BASES, RDFS.Class),
            (EU_GDPR, TRANSFERS.values(), DPV_KIND["LegalBasis"]),
            (EU_GDPR, TOOLS, DPV_KIND["OrganisationalMeasure"]),
            (RISK, RISKS, URIRef("https://w3id.org/dpv/risk#PotentialRisk")),
            (
                DPV,
                ("Disclose", "Store", "Transfer", "CrossBorderTransfer", "Derive", "Collect"),
                DPV_KIND["Processing"],
            ),
            (DPV, ("Pseudonymisation", "Anonymisation"), DPV_KIND["TechnicalMeasure"]),
        ],
        ids=["classes", "properties", "legal bases", "transfers", "tools", "risks", "processing", "measures"],
    )
    def test_a_term_is_of_its_kind(self, dpv: Graph, namespace: Any, names: Iterable[str], kind: URIRef) -> None:
        for name in names:
            assert (namespace[name], RDF.type, kind) in dpv, name

    def test_legal_bases_have_labels_and_a_time_of_storage_is_a_condition(self, dpv: Graph) -> None:
        assert all((EU_GDPR[name], SKOS.prefLabel, None) in dpv for name in BASES)
        assert (DPV.StorageDuration, SKOS.broader, URIRef("https://w3id.org/dpv#StorageCondition")) in dpv

    @pytest.mark.parametrize("case", CASES, ids=lambda path: str(path.name))
    def test_no_other_word_of_it_is_written(self, dpv: Graph, case: Path) -> None:
        words = {
            node for triple in rdf_graph(document_of(result_of(case))) for node in triple if "w3id.org/dpv" in str(node)
        }
        assert words
        assert all((word, RDF.type, None) in dpv for word in words), words

    def test_a_word_that_is_not_listed_cannot_be_written(self) -> None:
        with pytest.raises(AttributeError):
            DPV.hasJurisdiction  # noqa: B018


def value(graph: Graph, node: Node | None, *way: Node) -> Any:
    """The one value at the end of a way, as Python has it; None if there is none."""
    for step in way:
        values: list[Node | None] = [*graph.objects(node, step)]
        (node,) = values or [None]
    return node.toPython() if isinstance(node, Literal) else None if node is None else str(node)


def element_told(graph: Graph, iri: Node) -> dict[str, Any]:
    told = {key: value(graph, iri, RP[key]) for key in ("robot", "kind", "name", "leg", "pattern")}
    return {
        "robot": told["robot"] or "",
        "kind": told["kind"],
        "name": told["name"],
        **({"leg": told["leg"]} if told["leg"] else {}),
        **({"pattern": True} if told["pattern"] else {}),
    }


def finding_told(graph: Graph, iri: Node, names: dict[str, str]) -> dict[str, Any]:
    """The finding as the JSON document has it, put together from RDF alone."""
    hops = list(Collection(graph, graph.value(iri, RP.witness)))  # type: ignore[arg-type]
    assert [value(graph, hop, RP.position) for hop in hops] == list(range(1, len(hops) + 1))
    paths = sorted(graph.objects(iri, RP.path), key=lambda path: int(value(graph, path, RP.position)))
    ways = [list(Collection(graph, graph.value(path, RP.elements))) for path in paths]  # type: ignore[arg-type]
    told = {
        **{key: value(graph, iri, RP[key]) for key in ("id", "kind", "pseudonymised", "dismissed")},
        "category": names[value(graph, iri, RP.category)],
        "source": element_told(graph, graph.value(iri, RP.dataSource)),  # type: ignore[arg-type]
        "leak": element_told(graph, graph.value(iri, RP.leak)),  # type: ignore[arg-type]
        "disjoint_paths": value(graph, iri, RP.disjointPaths),
        "through": [element_told(graph, element) for element in graph.objects(iri, RP.through)],
        "witness": [element_told(graph, graph.value(hop, RP.element)) for hop in hops],  # type: ignore[arg-type]
        "steps": [step_told(graph, hop, names) for hop in hops[1:]],
    }
    if ways:
        told["paths"] = [[element_told(graph, element) for element in way] for way in ways]
        told["paths_bounded"] = value(graph, iri, RP.pathsBounded)
    return told


def step_told(graph: Graph, hop: Node, names: dict[str, str]) -> dict[str, Any]:
    lines = [
        {key: value(graph, line, RP[key]) for key in ("file", "line", "enclave", "profile")}
        for line in graph.objects(hop, RP.allowedBy)
    ]
    return {
        "role": value(graph, hop, RP.by),
        "category": names[value(graph, hop, RP.arrivesAs)],
        "pseudonymised": value(graph, hop, RP.arrivesPseudonymised),
        "policy": sorted(lines, key=lambda line: json.dumps(line, sort_keys=True)),
    }


def comparable(finding: dict[str, Any]) -> dict[str, Any]:
    """Grants and elements passed through are a set in RDF."""
    some = {key: finding[key] for key in finding if key not in ("through", "steps")}
    some["through"] = sorted(json.dumps(element, sort_keys=True) for element in finding["through"])
    some["steps"] = [
        {**step, "policy": sorted({json.dumps(line, sort_keys=True) for line in step["policy"]})}
        for step in finding["steps"]
    ]
    return some


@pytest.mark.parametrize("form", ["turtle", pytest.param("json-ld", marks=pytest.mark.slow)])
@pytest.mark.parametrize("case", one_in(3, CASES, in_ci=1), ids=lambda path: str(path.name))
class TestAgainstTheDocument:
    """What a reader of RDF is told is what a reader of JSON is told."""

    def test_findings(self, case: Path, form: str) -> None:
        result = result_of(case, paths="all", max_paths=3)
        graph, document = strict(written(result, form), form), result.document()
        names = {as_published(c.iri): name for name, c in result.vocabulary.categories.items()}
        told = {value(graph, iri, RP.id): iri for iri in graph.subjects(RDF.type, RP.Finding)}
        assert sorted(told) == sorted(finding["id"] for finding in document["findings"])
        for finding in document["findings"]:
            known = finding_told(graph, told[finding["id"]], names)
            assert comparable(known) == comparable({key: finding[key] for key in known})

    def test_the_answer_what_is_open_and_what_was_assumed(self, case: Path, form: str) -> None:
        result = result_of(case)
        graph, document = strict(written(result, form), form), result.document()
        (answer,) = graph.subjects(RDF.type, RP.Analysis)
        assert value(graph, answer, RP.outcome) == document["verdict"]
        assert value(graph, answer, RP.view) == document["view"]
        names = {as_published(c.iri): name for name, c in result.vocabulary.categories.items()}
        followed = {names[str(iri)] for iri in graph.objects(answer, RP.followed)}
        assert followed == {category["name"] for category in document["categories"]}
        asked = sorted(graph.objects(answer, RP.open), key=lambda q: int(value(graph, q, RP.position)))
        told = ("element", "categories", "distance", "frontier")  # the rest says how to label it
        assert [
            {
                "element": element_told(graph, graph.value(q, RP.element)),  # type: ignore[arg-type]
                "categories": sorted(names[str(iri)] for iri in graph.objects(q, RP.openFor)),
                "distance": value(graph, q, RP.distance),
                "frontier": value(graph, q, RP.frontier),
            }
            for q in asked
        ] == [{key: row[key] for key in told} for row in document["open"]]
        elements = {tuple(row["element"][part] for part in ("robot", "kind", "name")) for row in document["open"]}
        assert value(graph, answer, RP.openElements) == len(elements)
        said = {value(graph, iri, RP.name): value(graph, iri, RP.value) for iri in graph.objects(answer, RP.assumes)}
        files = {"policies", "labels"}
        assert set(said) == {name for name in document["assumptions"] if name not in files}
        for name, text in said.items():
            assumed = document["assumptions"][name]
            assert (text if isinstance(assumed, str) else json.loads(text)) == assumed
        assert {value(graph, iri, RP.message) for iri in graph.objects(answer, RP.diagnostic)} == {
            diagnostic["message"] for diagnostic in document["diagnostics"]
        }

    def test_the_files_that_were_read(self, case: Path, form: str) -> None:
        result = result_of(case)
        graph, assumed = strict(written(result, form), form), result.assumptions
        (run,) = graph.subjects(RDF.type, PROV.Activity)
        used = {
            (value(graph, file, RP.readAs), value(graph, file, RP.file), value(graph, file, RP.sha256))
            for file in graph.objects(run, PROV.used)
        }
        assert used == {
            (kind, file["file"], file["sha256"])
            for kind in ("policies", "labels", "standard_channels")
            for file in (assumed[kind] if isinstance(assumed[kind], list) else [assumed[kind]])
        }
        assert value(graph, run, PROV.wasAssociatedWith, RP.version) == rosprivacy.__version__
        for line in graph.subjects(RDF.type, RP.PolicyLine):
            assert value(graph, line, RP.inFile, RP.file) == value(graph, line, RP.file)

    @pytest.mark.slow
    def test_it_keeps_to_its_shapes(self, case: Path, form: str) -> None:
        assert problems(strict(written(result_of(case, paths="all"), form), form)) == ""


class TestInTheWordsOfDpv:
    def finding(self, graph: Graph, category: str) -> Node:
        (found,) = {*graph.subjects(RP.category, RP[category])} & {*graph.subjects(RDF.type, RP.Finding)}
        return found

    def process(self, graph: Graph, category: str) -> Node:
        (found,) = graph.objects(self.finding(graph, category), RP.concerns)
        return found

    def data(self, graph: Graph, category: str) -> set[Node]:
        """What the data are, all of one thing."""
        (data,) = graph.objects(self.process(graph, category), DPV.hasPersonalData)
        return set(graph.objects(data, RDF.type)) - {DPV.PersonalData}

    def test_a_finding_is_about_a_process_of_which_nobody_says_that_it_takes_place(self, graph: Graph) -> None:
        """A record of processing that the file is put beside does not record what never happens."""
        findings, processes, rows = (
            set(graph.subjects(RDF.type, kind)) for kind in (RP.Finding, DPV.Process, RP.RegisterRow)
        )
        assert findings <= set(graph.subjects(RDF.type, PROV.Entity)) - processes
        assert {graph.value(finding, RP.concerns) for finding in findings} == processes - rows
        assert {graph.value(process, DPV.hasActivityStatus) for process in processes} == {RP.PossibleActivity}
        assert (RP.PossibleActivity, RDF.type, DPV.ActivityStatus) in ontology()

    def test_a_finding_is_derived_from_the_lines_that_allow_its_way(self, graph: Graph) -> None:
        for finding in graph.subjects(RDF.type, RP.Finding):
            hops = Collection(graph, graph.value(finding, RP.witness))  # type: ignore[arg-type]
            lines = {line for hop in hops for line in graph.objects(hop, RP.allowedBy)}
            assert set(graph.objects(finding, PROV.wasDerivedFrom)) == lines
            assert lines <= set(graph.subjects(RDF.type, PROV.Entity))

    def test_the_data_is_our_category_and_its_terms_in_dpv(self, graph: Graph) -> None:
        assert self.data(graph, "FaceTemplate") == {RP.FaceTemplate, URIRef("https://w3id.org/dpv/pd#FacialPrint")}

    def test_a_category_without_terms_takes_those_of_its_nearest_broader_one(self, care_home: Result) -> None:
        findings = [f for f in care_home.analysis.findings if f.category == "FaceTemplate"]
        changed = replace(care_home.analysis, findings=tuple(replace(f, category="VoicePrint") for f in findings))
        graph = rdf_graph(document_of(replace(care_home, analysis=changed)))
        assert self.data(graph, "VoicePrint") == {RP.VoicePrint, URIRef("https://w3id.org/dpv/pd#Biometric")}

    def test_what_is_always_special_is_so_for_a_reader_of_dpv(self, care_home: Result) -> None:
        findings = [f for f in care_home.analysis.findings if f.category == "FaceTemplate"]
        for name, special in (("Ethnicity", True), ("Belief", True), ("FaceTemplate", False)):
            changed = replace(care_home.analysis, findings=tuple(replace(f, category=name) for f in findings))
            graph = rdf_graph(document_of(replace(care_home, analysis=changed)))
            assert (DPV.SpecialCategoryPersonalData in self.data(graph, name)) is special
            assert ((RP[name], RDF.type, DPV.SpecialCategoryPersonalData) in graph) is special
            assert problems(graph) == ""

    def test_a_derivation_on_the_way(self, graph: Graph) -> None:
        derived, process = self.finding(graph, "FaceTemplate"), self.process(graph, "FaceTemplate")
        assert set(graph.objects(process, DPV.hasProcessing)) == {DPV.Disclose, DPV.Derive}
        assert value(graph, derived, RP.derivedAt, RP.name) == "/face_recognizer"
        assert set(graph.objects(self.process(graph, "Voice"), DPV.hasProcessing)) == {DPV.Disclose}

    def test_pseudonymised_data_is_personal_data_still(self, graph: Graph) -> None:
        """Recital 26: it goes on, marked, with the measure and with the risk that is left."""
        video = self.process(graph, "Video")
        picture = URIRef("https://w3id.org/dpv/pd#Picture")
        assert self.data(graph, "Video") == {RP.Video, picture, DPV.PseudonymisedData}  # a pseudonymised picture
        assert set(graph.objects(video, DPV.hasRisk)) == {RISK.UnwantedDisclosureData, RISK.Reidentification}
        (measure,) = graph.objects(video, DPV.hasTechnicalMeasure)
        assert value(graph, measure, RP.at, RP.name) == "/blur"
        assert value(graph, measure, RP.stated) is True
        others = {self.process(graph, name) for name in ("FaceTemplate", "Voice")}
        assert not any(list(graph.objects(other, DPV.hasTechnicalMeasure)) for other in others)

    def test_source_and_recipient(self, graph: Graph) -> None:
        voice = self.process(graph, "Voice")
        assert value(graph, voice, DPV.hasDataSource, RP.name) == "/microphone"
        assert value(graph, voice, DPV.hasRecipient, RP.at, RP.name) == "/uplink"
        (recipient,) = graph.objects(voice, DPV.hasRecipient)
        assert (recipient, RDF.type, RP.Element) not in graph  # software is no recipient

    def test_law_with_verdict_and_condition_and_no_legal_basis(self, graph: Graph) -> None:
        (law,) = graph.objects(self.finding(graph, "FaceTemplate"), RP.fallsUnder)
        assert value(graph, law, RP.verdict) == "conditional"
        conditions = {value.language: str(value) for value in graph.objects(law, RP.condition)}  # type: ignore[attr-defined]
        assert set(conditions) == {"en", "de", "fr"}
        assert "uniquely" in conditions["en"]
        assert value(graph, law, RP.provision, RP.asOf).isoformat() == "2026-11-21"
        (revealed,) = graph.objects(self.finding(graph, "Video"), RP.fallsUnder)
        assert value(graph, revealed, RP.verdict) == "may-reveal"
        assert "LegalBasis" not in as_turtle(graph)

    def test_provisions_lead_up_to_the_act_and_to_eur_lex(self, graph: Graph) -> None:
        """Law review, section 4, no. 6: what law.ttl knows is not dropped."""
        (law,) = graph.objects(self.finding(graph, "FaceTemplate"), RP.fallsUnder)
        provision = graph.value(law, RP.provision)
        assert provision is not None
        above = set(graph.transitive_objects(provision, DCTERMS.isPartOf))
        assert {RP["GDPR-9-1"], RP["GDPR-9"], RP.GDPR} <= above == set(graph.transitive_objects(provision, RP.partOf))
        assert value(graph, provision, RDFS.seeAlso) == "https://eur-lex.europa.eu/eli/reg/2016/679/art_9/par_1/oj"

    def test_names_and_meanings_stand_in_three_languages(self, graph: Graph) -> None:
        for kind, name in ((SKOS.Concept, SKOS.prefLabel), (RP.LegalProvision, DCTERMS.title)):
            for node in graph.subjects(RDF.type, kind):
                for predicate in (name, SKOS.definition):
                    languages = {text.language for text in graph.objects(node, predicate)}  # type: ignore[attr-defined]
                    assert languages == {"en", "de", "fr"}, (node, predicate)

    def test_what_labels_say_on_the_way(self, graph: Graph) -> None:
        (recognizer,) = [
            hop
            for hop in {*graph.subjects(RP.leavesAs, RP.FaceTemplate)} & {*graph.subjects(RDF.type, RP.Hop)}
            if value(graph, hop, RP.element, RP.name) == "/face_recognizer"
        ]
        assert (recognizer, RP.derivationOf, RP.Video) in graph
        assert (recognizer, RP.sanitizerOf, RP.Video) in graph


def test_law_is_that_of_the_nearest_broader_category() -> None:
    def law(name: str) -> tuple[Legal, ...]:
        return (Legal(f"urn:{name}", name, name, "2026-01-01", "always"),)

    rows = {"Top": (), "Mid": ("Top",), "Low": ("Mid",), "Side": ("Top",), "Both": ("Mid", "Side"), "Bare": ()}
    stated = {"Top": law("t"), "Mid": law("m"), "Side": law("s")}
    vocabulary = Vocabulary.of(Category(n, n, n, n, n, up, law=stated.get(n, ())) for n, up in rows.items())
    finding = rosprivacy.analyze([str(ROOT / CARE_HOME[0])], [str(ROOT / CARE_HOME[2])]).analysis.findings[0]
    for category, names in {
        "Top": ["m", "s", "t"],
        "Mid": ["m", "s"],
        "Low": ["m"],
        "Both": ["m", "s"],
        "Bare": [],
    }.items():
        assert [legal.name for legal, _ in legal_of(replace(finding, category=category), vocabulary)] == names


def without_policy(analysis: Analysis) -> Analysis:
    """Random systems have no policies: their flows are a person's."""
    stated = [
        replace(finding, steps=tuple(step._replace(role="flow") for step in finding.steps))
        for finding in analysis.findings
    ]
    return replace(analysis, findings=tuple(stated))


@given(systems())
def test_random_systems_keep_to_the_shapes_and_change_data_where_labels_say_so(system: System) -> None:
    """With derivations and pseudonymisation in any order, at sources and at leaks too."""
    analysis = analysed(system)
    if analysis is None or not analysis.findings:
        return
    graph = graph_of_analysis(without_policy(analysis))
    assert problems(graph) == ""
    number = {NAMES.element(element): i for i, element in enumerate(analysis.graph.elements)}
    said = {iri: system.said[i] for iri, i in number.items()}
    for finding in analysis.findings:
        iri, process = NAMES.finding(finding), NAMES.process(finding)
        own = [s for s in said[NAMES.element(finding.source)] if s.role == "source"]
        derived = {(node, to) for node in graph.objects(iri, RP.derivedAt) for to in ["derivation"]}
        if not any(finding.category in s.categories for s in own):
            assert derived
        assert all(any(s.role == to for s in said[node]) for node, to in derived)  # type: ignore[index]
        measures = list(graph.objects(process, DPV.hasTechnicalMeasure))
        assert len(measures) == finding.pseudonymised
        for measure in measures:
            at = graph.value(measure, RP.at)
            assert any(s.method is Method.PSEUDONYMISE for s in said[at])  # type: ignore[index]


class TestShapesCanFail:
    """A shape that accepts everything shows nothing."""

    @pytest.mark.slow
    def test_without_what_is_required(self, graph: Graph) -> None:
        accepted = []
        required = {(s, p) for s, p, _ in graph if isinstance(s, URIRef) and p != RDF.type}
        for predicate in sorted({p for _, p in required}, key=str):
            changed = Graph() + graph
            changed.remove((None, predicate, None))
            if not problems(changed):
                accepted.append(re.split("[:#/]", str(predicate))[-1])
        assert sorted(accepted) == [  # what a finding, a hop, a category can be without
            "adopted", "appliesFrom", "bibliographicCitation", "broadMatch", "broader", "conduitOf", "confirmed",
            "country", "derivationOf", "diagnostic", "exactMatch", "fallsUnder", "followed", "identityFactor",
            "inContext", "inFile", "leakOf", "leg", "lookAt", "path", "sameAs", "sanitizerOf", "seeAlso",
            "sourceOf", "title", "used", "wasDerivedFrom",
        ]  # fmt: skip

    @pytest.mark.parametrize(
        ("predicate", "wrong"),
        one_in(
            4,
            [
                (RP.verdict, Literal("compliant")),
                (RP.outcome, Literal("safe")),
                (RP.pseudonymised, Literal("no")),
                (RP.kind, Literal("violation")),
                (RP.id, Literal("59DC")),
                (DPV.hasProcessing, URIRef("https://w3id.org/dpv#Processing")),
                (DPV.hasRisk, URIRef("https://w3id.org/dpv/risk#IllegalDataProcessing")),
                (DPV.hasPersonalData, Literal("Video")),
                (RP.sha256, Literal("0")),
                (RP.witness, RDF.nil),
                (RP.line, Literal(-1)),
            ],
            in_ci=1,
        ),
    )
    def test_with_a_wrong_value(self, graph: Graph, predicate: URIRef, wrong: Node) -> None:
        changed = Graph() + graph
        subject = min(graph.subjects(predicate, None), key=str)
        changed.set((subject, predicate, wrong))
        assert problems(changed)

    def test_with_a_property_that_is_none(self, graph: Graph) -> None:
        changed = Graph() + graph
        changed.add((min(graph.subjects(RDF.type, RP.Finding), key=str), RP.compliant, Literal(1)))
        assert problems(changed)


def kept_for(stated: Mapping[str, str]) -> tuple[tuple[str, Duration], ...]:
    return tuple((category, parse(written)) for category, written in sorted(stated.items()))


BUCKET, CLOUD = Element("storage", "bucket"), Element("external-system", "cloud", "r1")


class TestOutsideRos:
    """A storage and an external system behind a node, which no policy speaks of (rule S9)."""

    @pytest.fixture
    def analysis(self) -> Analysis:
        elements = (Element("node", "/camera"), CLOUD, BUCKET)
        flows = (Flow(0, 1, "flow"), Flow(0, 2, "flow"))
        said = {0: (statement("source", "Face"),), 1: (statement("leak", "Bio"),), 2: (statement("leak", "Bio"),)}
        return analyse(FlowGraph(elements, flows, (), ()), Bound(said), VOCABULARY.hierarchy)

    def at(self, graph: Graph, element: Element) -> Node:
        """The process that ends there."""
        (found,) = graph.subjects(RP.leak, NAMES.element(element))
        (process,) = graph.objects(found, RP.concerns)
        return process

    def of_kind(self, analysis: Analysis, kind: str) -> Analysis:
        return replace(analysis, findings=tuple(replace(finding, kind=kind) for finding in analysis.findings))

    def test_what_reaches_a_storage_is_stored_and_nobody_said_for_how_long(self, analysis: Analysis) -> None:
        graph = graph_of_analysis(analysis)
        finding = self.at(graph, BUCKET)
        assert set(graph.objects(finding, DPV.hasProcessing)) == {DPV.Disclose, DPV.Store}
        assert value(graph, finding, DPV.hasStorageCondition, RP.stated) is False
        assert (
            value(graph, finding, DPV.hasStorageCondition, RDFS.label)
            == "bucket keeps data; for how long is not stated"
        )
        assert problems(graph) == ""

    def test_what_reaches_an_external_system_is_transferred(self, analysis: Analysis) -> None:
        graph = graph_of_analysis(analysis)
        finding = self.at(graph, CLOUD)
        assert set(graph.objects(finding, DPV.hasProcessing)) == {DPV.Disclose, DPV.Transfer}
        assert not list(graph.objects(finding, DPV.hasStorageCondition))

    def test_what_people_stated_is_told(self, analysis: Analysis) -> None:
        outside = {
            BUCKET: NonRosFacts(retention=kept_for({EVERY: "P30D"}), country="DE", encrypted=True),
            CLOUD: NonRosFacts(operator="Cloud Ltd", recipient="processor", country="US", transfer="standard-clauses"),
        }
        graph = graph_of_analysis(analysis, outside)
        bucket, cloud = self.at(graph, BUCKET), self.at(graph, CLOUD)
        (kept,) = graph.objects(graph.value(bucket, DPV.hasStorageCondition), DPV.hasDuration)
        assert kept == Literal("P30D", datatype=XSD.duration)
        assert value(graph, bucket, DPV.hasStorageCondition, RP.stated) is True
        assert value(graph, cloud, DPV.hasRecipient, RDFS.label) == "Cloud Ltd"
        told = {
            term: value(graph, NAMES.element(CLOUD), RP[term])
            for term in ("operator", "operatorRole", "country", "transferBasis")
        }
        assert told == {
            "operator": "Cloud Ltd", "operatorRole": "processor", "country": "US", "transferBasis": "standard-clauses",
        }  # fmt: skip
        assert problems(graph) == ""

    def test_a_duration_that_xml_schema_lacks_is_told_as_it_was_written(self, analysis: Analysis) -> None:
        graph = graph_of_analysis(analysis, {BUCKET: NonRosFacts(retention=kept_for({EVERY: "P4W"}))})
        assert set(graph.objects(None, DPV.hasDuration)) == {Literal("P4W")}

    @pytest.mark.parametrize(("backups", "more"), [(True, []), (parse("P7D"), [Literal("P7D", datatype=XSD.duration)])])
    def test_backups_are_a_condition_of_their_own(self, analysis: Analysis, backups: Any, more: list[Literal]) -> None:
        """Rule S9: nobody may take the storage's own duration for the whole."""
        facts = NonRosFacts(retention=kept_for({EVERY: "P30D"}), backups=backups)
        graph = graph_of_analysis(analysis, {BUCKET: facts})
        conditions = set(graph.objects(self.at(graph, BUCKET), DPV.hasStorageCondition))
        (then,) = (one for one in conditions if "backups" in str(graph.value(one, RDFS.label)))
        (first,) = conditions - {then}
        assert list(graph.objects(first, DPV.hasDuration)) == [Literal("P30D", datatype=XSD.duration)]
        assert list(graph.objects(then, DPV.hasDuration)) == more
        assert value(graph, then, RP.stated) is bool(more)
        assert problems(graph) == ""

    def test_how_long_one_category_is_kept_says_nothing_of_another(self, analysis: Analysis) -> None:
        """Rules S7 and S9: what is stated of a broader category holds, what is stated of a narrower one does not."""
        told = {}
        for category in ("Bio", "Face", "Voice"):
            graph = graph_of_analysis(analysis, {BUCKET: NonRosFacts(retention=kept_for({category: "P1Y"}))})
            at = self.at(graph, BUCKET)
            told[category] = value(graph, at, DPV.hasStorageCondition, RP.stated)
            assert problems(graph) == ""
        assert told == {"Bio": True, "Face": True, "Voice": False}

    def test_kept_too_long(self, analysis: Analysis) -> None:
        graph = graph_of_analysis(self.of_kind(analysis, "storage-limitation"))
        finding = self.at(graph, BUCKET)
        assert set(graph.objects(finding, DPV.hasProcessing)) == {DPV.Store}
        assert set(graph.objects(finding, DPV.hasRisk)) == {RISK.DataRisk}
        assert not list(graph.objects(finding, DPV.hasRecipient))

    def test_to_a_third_country(self, analysis: Analysis) -> None:
        graph = graph_of_analysis(self.of_kind(analysis, "third-country-transfer"))
        assert set(graph.objects(self.at(graph, CLOUD), DPV.hasProcessing)) == {DPV.CrossBorderTransfer}
        assert problems(graph) == ""

    def test_what_a_person_accepted(self, analysis: Analysis) -> None:
        finding = analysis.findings[0]
        graph = rdf_graph(
            document_of(accepting(answer_of(analysis, VOCABULARY, REST), {finding.id: "a contract"})), base=BASE
        )
        assert set(graph.subject_objects(RP.accepted)) == {(NAMES.finding(finding), Literal("a contract"))}
        assert problems(graph) == ""


def test_a_sanitizer_that_states_no_method_is_a_measure_that_nobody_stated() -> None:
    unstated = statement("sanitizer", "Face", method=Method.PSEUDONYMISE)._replace(stated=False)
    said = {0: (statement("source", "Face"),), 1: (unstated,), 2: (statement("leak", "Face"),)}
    elements = tuple(Element("node", f"/n{i}") for i in range(3))
    flows = (Flow(0, 1, "flow"), Flow(1, 2, "flow"))
    analysis = analyse(FlowGraph(elements, flows, (), ()), Bound(said), VOCABULARY.hierarchy)
    graph = graph_of_analysis(analysis)
    measures = set(graph.objects(None, DPV.hasTechnicalMeasure))
    assert len(measures) == 2  # of the finding, and of the row of the register
    assert {value(graph, measure, RP.stated) for measure in measures} == {False}


def test_rdflib_is_imported_only_where_it_is_used() -> None:
    code = "import sys, rosprivacy.cli.app, rosprivacy.systems.robot_system; print('rdflib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "False\n"
