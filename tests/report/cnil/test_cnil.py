"""The file for the CNIL's PIA tool: what the tool does with it when it imports, shows, sorts and checks it."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import datetime, timezone
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.durations import parse
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.model import Bound, Category, Element, Flow, FlowGraph, NonRosFacts, Place, Statement
from rosprivacy.analysis.non_ros import EVERY
from rosprivacy.documents import document_of
from rosprivacy.ingest.neo4j_graph.loading import load as load_robots
from rosprivacy.ontology.vocabulary import Vocabulary, load
from rosprivacy.private_neo4j import connection
from rosprivacy.report.catalogs.words import Words, plain, reason_text
from rosprivacy.report.cnil import told
from rosprivacy.report.cnil.pia import cnil_pia
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.additions import ADD_STORAGE
from tests.helpers.answers import accepting, answer_of, as_json
from tests.helpers.fleet_files import policy
from tests.helpers.languages import OTHERS, SYSTEMS, english_in, names_in, users_texts
from tests.helpers.paths import ROOT
from tests.helpers.pia_tool import CREATED, ITEMS, Page, Tool, imported, seen
from tests.helpers.sarif import HOSTILE, analyze, checked, log_of, physical, small_system, way
from tests.helpers.systems import HIERARCHY, PARENTS, System, analysed, systems

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.private_neo4j.connection import Connection
    from tests.helpers.command import Cli

CARE_HOME = (["care-home/care-home.policy.xml"], ["care-home/care-home.labels.yaml"])
VOCABULARY = Vocabulary.of(Category(n, f"urn:{n}", n, n, n, up) for n, up in PARENTS.items())
FILLED = [121, 122, 123, 213, 215, 227, 322, 324]


def file_of(policies: list[str], labels: list[str], **options: Any) -> dict[str, Any]:
    result = analyze(policies, labels, **options)
    return cnil_pia(document_of(result), CREATED)


@pytest.fixture(scope="module")
def care_home() -> Tool:
    return imported(file_of(*CARE_HOME))


# ---------------------------------------------------------------- what is filled


def test_the_questions_of_the_graph_are_answered_and_no_other(care_home: Tool) -> None:
    """An empty answer would count as work begun, and move the tool's progress bar."""
    assert sorted(care_home.answers) == FILLED
    assert all(care_home.valid(question) for question in FILLED)
    began = {item: care_home.status(item) for item in (*ITEMS, "3.1")}
    assert began == {"1.1": 0, "1.2": 2, "2.1": 1, "2.2": 1, "3.1": 2, "3.2": 1, "3.3": 0, "3.4": 0}


def test_nothing_that_is_a_persons_to_say_is_filled(care_home: Tool) -> None:
    assert care_home.pia["status"] == 0
    assert care_home.evaluations == []
    assert not any(care_home.answers[q]["gauge"] for q in FILLED)
    said = {value for key, value in care_home.pia.items() if key not in ("name", "status", "created_at", "updated_at")}
    assert said == {None, ""}


def test_a_cleaner_is_named_only_for_what_gets_to_it(care_home: Tool) -> None:
    """/uplink is labelled to drop Location, which never gets there."""
    assert "/uplink: drop" not in seen(care_home, 122)
    contents = {m["title"]: Page(m["content"]).seen for m in care_home.measures.values()}
    assert set(contents) >= {"Connections denied by policy"}
    assert "/face_recognizer" not in "".join(
        m for title, m in contents.items() if title != "Connections denied by policy"
    )
    assert "Location" not in "".join(contents.values())
    assert contents["Connections denied by policy"].startswith("/face_recognizer/faces to /uplink")


def test_without_a_source_nothing_is_claimed(tmp_path: Path) -> None:
    result = small_system(tmp_path, {"/a": "conduit"}, last="conduit: [Video]")
    tool = imported(as_json(result, "cnil-pia"))
    assert seen(tool, 121).startswith("No label names a source of personal data, so nothing was followed")
    assert 322 not in tool.answers
    assert "none" not in seen(tool, 121)


def test_decisions_are_told_with_their_reason() -> None:
    result = analyze(*CARE_HOME)
    first = result.analysis.findings[0].id
    tool = imported(as_json(accepting(result, {first: "staff & family agreed <2030>"}), "cnil-pia"))
    assert tool.answers[322]["list"][0].endswith(f"(path to assess {first}, accepted: staff ＆ family agreed ‹2030›)")
    assert "(accepted: staff & family agreed <2030>)" in seen(tool, 122)


def with_facts(facts: dict[str, NonRosFacts], subjects: tuple[str, ...] = ()) -> Tool:
    """A camera that everything non-ROS gets video from, and what people state of each."""
    kinds = ("external-system" if name.startswith("cloud") else "storage" for name in facts)
    elements = (Element("node", "/camera"), *(Element(kind, name) for kind, name in zip(kinds, facts, strict=True)))
    flows = tuple(Flow(0, vertex, "flow") for vertex in range(1, len(elements)))
    said = {0: (Statement("source", ("Video",), (1, 0), Place("labels.yaml", 1)),)}
    bound = Bound(said, subjects={0: subjects} if subjects else {})
    analysis = analyse(FlowGraph(elements, flows, (), ()), bound, load().hierarchy)
    outside = {element: facts[element.name] for element in elements[1:]}
    return imported(cnil_pia(document_of(answer_of(analysis, load(), {}, bound=bound, outside=outside)), CREATED))


KEPT = NonRosFacts(retention=((EVERY, parse("P30D")),), country="DE", encrypted=True)


@pytest.mark.parametrize(
    ("facts", "question", "told_so"),
    [
        ({"bucket": KEPT, "disk": NonRosFacts()}, 121, "bucket (30 days), storage disk (retention not stated)"),
        ({"bucket": KEPT}, 215, "storage bucket: Video; retention: 30 days"),
        ({"disk": NonRosFacts()}, 215, "storage disk: Video; retention: not stated"),
        (
            {"cloud": NonRosFacts(operator="Speech Inc.", recipient="processor", country="US", area="partly")},
            226,
            "external-system cloud: processor: Speech Inc. (US); contract under Article 28",
        ),
        (
            {"cloud": NonRosFacts(country="US", transfer="standard-clauses")},
            227,
            "external-system cloud: country: US; basis of a transfer: standard contractual clauses",
        ),
        (
            {"cloud": NonRosFacts(country="DE", area="eea")},
            227,
            "country: DE, in the EEA: no transfer to a third country is stated",
        ),
        ({"cloud": NonRosFacts(country="CH", area="adequate")}, 227, "CH: adequacy decision (Article 45)"),
    ],
)
def test_what_people_state_of_storages_and_recipients_is_told(
    facts: dict[str, NonRosFacts], question: int, told_so: str
) -> None:
    """Rule S9; Articles 28, 44 and 45."""
    assert told_so in seen(with_facts(facts), question)


def test_encryption_is_a_measure_and_its_lack_a_threat() -> None:
    encrypted, plain_text = with_facts({"nas": KEPT}), with_facts({"nas": NonRosFacts(encrypted=False)})
    contents = {measure["title"]: Page(measure["content"]).seen for measure in encrypted.measures.values()}
    assert contents["Encryption of storages"].startswith("nas: encrypted at rest, as stated")
    assert "Access control by SROS 2 policies" not in contents  # no profile, so nothing is known of it
    assert "Encryption of storages" not in {measure["title"] for measure in plain_text.measures.values()}
    assert "data at rest not encrypted: storage nas" in plain_text.answers[322]["list"]


def test_without_a_processor_its_question_stays_without_an_answer() -> None:
    assert 226 not in with_facts({"nas": NonRosFacts(operator="us")}).answers


@pytest.mark.parametrize("language", ["en", "de", "fr"])
def test_a_threat_tells_the_whole_reason(tmp_path: Path, language: str) -> None:
    """Of a transfer without a basis the legal sentence stands to its end."""
    long = "a_name_that_is_long_and_says_where_in_the_house_the_thing_stands"
    (tmp_path / "p.xml").write_text(policy("camera>/image", "sender</image"))
    (tmp_path / "l.yaml").write_text(f"""labels: 1
nodes: {{/camera: {{source: [Video]}}, /sender: conduit}}
channels: {{/image: sensitive}}
elements: {{{long}: {{kind: external-system, country: US, recipient: processor, transfer: none}}}}
flows: [{{from: /sender, to: {long}}}]
""")
    document = document_of(rosprivacy.analyze(tmp_path / "p.xml", tmp_path / "l.yaml"))
    words = told.Told(Words(language), document.vocabulary.categories)
    answers = cnil_pia(document, CREATED, language)["answers"]
    threats = "\n".join(next(one for one in answers if one["reference_to"] == 322)["data"]["list"])
    reasons = [finding.why for finding in document.analysis.findings if finding.why]
    assert reasons
    for reason in reasons:
        sentence = plain(reason_text(reason, words.words, words.data))
        assert f"; {' '.join(map(told.harmless, sentence.split(' ')))} (" in threats
    assert all(finding.id in threats for finding in document.analysis.findings)


def test_persons_that_labels_name_are_told() -> None:
    said = seen(with_facts({"nas": NonRosFacts()}, ("residents", "staff")), 121)
    assert "Persons concerned, as labels name them: residents, staff" in said
    assert "Purpose, who has access: to be completed." in said


# ---------------------------------------------------------------- bounds, names, sameness


def test_long_answers_are_bounded_and_say_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    topics = ",".join(f"/t{i:03}" for i in range(50))
    profiles = [profile for i in range(12) for profile in (f"/s{i}>{topics}", f"/l{i}<{topics}")]
    (tmp_path / "p.xml").write_text(policy(*profiles))
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes: {/s*: {source: [Video]}, /l*: {leak: [Video]}}\n")
    result = rosprivacy.analyze([str(tmp_path / "p.xml")], [str(tmp_path / "l.yaml")])
    assert len(result.analysis.findings) == 144
    tool = imported(as_json(result, "cnil-pia"))
    assert len(json.dumps(tool.answers)) < 100_000
    assert tool.answers[322]["list"][100] == "44 more paths to assess"
    assert "and 94 more" in seen(tool, 122)
    assert "and 20 more" in seen(tool, 123)
    monkeypatch.setattr(told, "NAMES", 3)
    assert "/l0, /l1, /l10 and 9 more" in seen(imported(as_json(result, "cnil-pia")), 121)


def test_a_hostile_name_harms_nothing(tmp_path: Path) -> None:
    result = small_system(tmp_path, {"/a": "{source: [Video]}", "/b": "{sanitizer: {Video: pseudonymise}}"})
    known = result.analysis.graph
    elements = tuple(replace(e, name=HOSTILE + e.name, robot=HOSTILE) for e in known.elements)
    analysis = analyse(replace(known, elements=elements), result.bound, result.vocabulary.hierarchy)
    files = {"policies": [{"file": "<img src=x onerror=alert(1)>\u202e.xml", "sha256": "0" * 64}]}
    why = {finding.id: HOSTILE for finding in analysis.findings}
    outside = {e: NonRosFacts(country=HOSTILE, transfer=HOSTILE) for e in elements}
    answer = answer_of(analysis, result.vocabulary, files, outside=outside)
    data = cnil_pia(document_of(accepting(answer, why)), CREATED)
    tool = imported(data)
    assert "<script>alert(1)</script>" in seen(tool, 121)  # seen as text
    assert "‹script›" in tool.answers[322]["list"][0]
    assert len(json.dumps(data)) < 30_000
    assert "\u202e" not in json.dumps(data, ensure_ascii=False)


@given(systems(), st.text(max_size=20))
def test_any_system_with_any_names_is_taken(system: System, suffix: str) -> None:
    known = system.graph()
    graph = replace(known, elements=tuple(replace(e, name=e.name + suffix, robot=suffix) for e in known.elements))
    if analysed(system) is None:
        return
    analysis = analyse(graph, system.bound(), HIERARCHY)
    tool = imported(cnil_pia(document_of(answer_of(analysis, VOCABULARY, {})), CREATED))
    findings = [finding for finding in analysis.findings if not finding.dismissed]
    assert len(tool.answers.get(322, {"list": []})["list"]) == len(findings) + bool(analysis.open)


def test_the_command_dates_it_as_it_is_told(cli: Cli) -> None:
    command = ("analyze", "care-home.policy.xml", "-l", "care-home.labels.yaml", "-f", "cnil-pia")
    folder = ROOT / "examples" / "care-home"
    outputs = [cli(*command, cwd=folder, SOURCE_DATE_EPOCH=epoch) for epoch in ("1767323045", "1767323045", "soon")]
    assert outputs[0].stdout == outputs[1].stdout
    assert {a["created_at"] for a in json.loads(outputs[0].stdout)["answers"]} == {"2026-01-02T03:04:05.000Z"}
    imported(json.loads(outputs[0].stdout))
    assert outputs[2].returncode == 2
    hint = "give whole seconds since 1970, or unset it"
    assert outputs[2].stderr == f"SOURCE_DATE_EPOCH: 'soon' is not a time; {hint}\n"


def test_without_being_told_it_is_dated_now(monkeypatch: pytest.MonkeyPatch) -> None:
    """The tool sorts by date, so there is one."""
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    made = imported(as_json(analyze(*CARE_HOME), "cnil-pia")).pia["created_at"]
    assert abs((made - datetime.now(timezone.utc)).total_seconds()) < 60


@pytest.mark.slow
@pytest.mark.database
def test_what_people_added_in_the_database_is_in_both_formats(neo4j_server: Connection) -> None:
    """A finding whose last step no policy line allows is at the last line before it."""
    vocabulary = load()
    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        load_robots(driver, [robot_of("care", analyze(*CARE_HOME))], vocabulary)
        driver.execute_query(ADD_STORAGE)
        result = answer_stored(driver, Settings())
        driver.execute_query("MATCH (n) DETACH DELETE n")
    run = checked(log_of(result))
    (found,) = [r for r in run["results"] if "storage footage bucket" in r["message"]["text"]]
    assert physical(found["locations"][0]) == ("examples/care-home/care-home.policy.xml", 118)
    last = way(found)[-1]
    assert last["message"]["text"] == "pseudonymised Video goes from /recorder to storage footage bucket."
    tool = imported(as_json(result, "cnil-pia"))
    assert "storage footage bucket: pseudonymised Video; retention: 30 days" in seen(tool, 215)


# ---------------------------------------------------------------- languages


@pytest.mark.parametrize("language", OTHERS)
@pytest.mark.parametrize("system", SYSTEMS)
def test_the_file_is_whole_in_every_language(language: str, system: str) -> None:
    """The users of the tool are French controllers; keys, questions and measures are those in English."""
    result = SYSTEMS[system]()
    english, data = cnil_pia(document_of(result), CREATED), cnil_pia(document_of(result), CREATED, language)
    tool = imported(data)
    assert sorted(tool.answers) == sorted(imported(english).answers)
    assert [len(answer["data"]["list"]) for answer in data["answers"]] == [
        len(answer["data"]["list"]) for answer in english["answers"]
    ]
    assert len(data["measures"]) == len(english["measures"])
    text = "\n".join(Page(part).seen for part in tool.shown_as_html())
    assert english_in(text, language, [*names_in(result), *users_texts(result.document())]) == []
    assert "\\xa0" not in text
    assert "\\u202f" not in text
