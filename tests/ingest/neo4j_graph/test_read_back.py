"""What is in the database is analysed as what is in files; what people add there in Cypher counts."""

from __future__ import annotations

import itertools
import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import DatabaseError, InputErrors, LabelError
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.kernel.ranks import decided
from rosprivacy.analysis.model import GLOB, NAME, Place, Statement
from rosprivacy.ingest.labels.entries import EXACT
from rosprivacy.ingest.neo4j_graph.fleet_rows import robot_rows, standard_only
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.ingest.neo4j_graph.read_back import read_stored
from rosprivacy.ingest.neo4j_graph.relationship_facts import HAND
from rosprivacy.ingest.neo4j_graph.write_back import write_back
from rosprivacy.ingest.running.node_info import read_node_info
from rosprivacy.ingest.running.observed_files import policy_xml, prepared
from rosprivacy.ontology.vocabulary import load as load_vocabulary
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.additions import ADD_STORAGE
from tests.helpers.cases import CASES
from tests.helpers.daily import one_in
from tests.helpers.fleet_files import policy
from tests.helpers.graphs import care_home, dump, factory, rows_of
from tests.helpers.observed import node_info
from tests.helpers.random_rows import VOCABULARY as SMALL
from tests.helpers.random_rows import random_systems

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from neo4j import Driver


pytestmark = pytest.mark.database
VOCABULARY = load_vocabulary()


def same_from_the_database(driver: Driver, result: Any) -> Any:
    """Load a robot, and check that the database gives the document of its files; return that answer."""
    load(driver, [robot_of("r", result)], VOCABULARY)
    stored = answer_stored(driver, Settings())
    document = stored.document()
    assert document["assumptions"].pop("database") == {"robots": 1}
    assert document == result.document()
    return stored


def answer_of(case: Path) -> Any:
    """The answer in memory of a case; names of files are relative to the examples."""
    stated = json.loads((case / "case.json").read_text("utf-8"))
    return rosprivacy.analyze(stated["policies"], stated["labels"], **stated.get("options", {}))


def ways(result: Any) -> set[tuple[str, ...]]:
    return {(f.category, *(element.name for element in f.witness)) for f in result.analysis.findings}


@pytest.mark.parametrize("case", one_in(4, CASES), ids=lambda path: str(path.name))
def test_the_document_is_that_of_the_files(
    driver: Driver, case: Path, examples: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(examples)
    result = answer_of(case)
    load(driver, [robot_of("r", result)], VOCABULARY)
    before = dump(driver, without=("digest", "version"))
    same_from_the_database(driver, result)
    assert dump(driver, without=("digest", "version")) == before


@pytest.mark.parametrize("case", one_in(4, CASES), ids=lambda path: str(path.name))
def test_without_standard_channels_the_answer_is_the_same(
    driver: Driver, case: Path, examples: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rule S13: nothing goes on from a channel that only the standard file speaks of."""
    monkeypatch.chdir(examples)
    result = answer_of(case)
    rows = robot_of("r", result, without_standard=True)
    hidden = standard_only(result.analysis, result.bound)
    assert len(rows.elements) == len(result.analysis.graph.elements) - len(hidden)
    load(driver, [rows], VOCABULARY)
    document, whole = answer_stored(driver, Settings()).document(), result.document()
    for part in ("verdict", "findings", "open", "doubts", "roles", "outside", "derivations"):
        assert document[part] == whole[part], part
    assert of_people(document["hangs_on"]) == of_people(whole["hangs_on"])
    notice = [said for said in document["diagnostics"] if "--without-standard" in said["message"]]
    assert len(notice) == 1


def of_people(hangs_on: list[Any] | None) -> list[Any]:
    """What an answer hangs on without lines of the standard file."""
    return [row for row in hangs_on or () if not row["file"].startswith("rosprivacy:")]


def test_most_of_the_example_are_standard_channels(driver: Driver) -> None:
    """And what is left is in the database, with every finding, and without a flow that ends nowhere."""
    before = dump_of(driver, without_standard=False)
    after = dump_of(driver, without_standard=True)
    assert len(after["elements"]) < len(before["elements"]) / 2
    assert after["elements"] < before["elements"]
    assert after["findings"] == before["findings"]
    assert {end for flow in after["flows"] for end in flow} <= after["elements"]
    assert after["flows"] == {flow for flow in before["flows"] if set(flow) <= after["elements"]}


def dump_of(driver: Driver, *, without_standard: bool) -> dict[str, set[Any]]:
    """Ids of elements and findings, and ends of flows, of the care home."""
    load(driver, [robot_of("r", care_home(), without_standard=without_standard)], VOCABULARY)
    rows = {
        "elements": "MATCH (e:Element) WHERE NOT e:Intake RETURN e.id",
        "findings": "MATCH (f:Finding) RETURN f.id",
        "flows": "MATCH (a)-[:FLOWS_TO]->(b) RETURN [a.id, b.id]",
    }
    answers = {name: driver.execute_query(query).records for name, query in rows.items()}
    return {
        name: {tuple(value) if isinstance(value, list) else value for (value,) in map(tuple, records)}
        for name, records in answers.items()
    }


@pytest.mark.parametrize(
    "pins", ["{}", "{nodes: {/filter: [Video]}}", "{nodes: {/filter: [Video]}, topics: {/b: [Video]}}"]
)
def test_what_is_pinned_comes_back(driver: Driver, tmp_path: Path, pins: str) -> None:
    """Rule S11: of nodes, channels and flows; and a leak that a glob may take back only where it was seen."""
    (tmp_path / "p.xml").write_text(policy("/camera>/a", "/filter>/b</a", "/out</b"))
    labels = 'labels: 1\nnodes: {/camera: {source: [Video]}, "/f*": {sanitizer: {Video: pseudonymise}}, '
    labels += '"/*": {leak: [Video]}, "/o*": {leak: none}}\ntopics: {/a: sensitive, "/b*": mundane}\n'
    labels += f'flows: [{{from: "/fil*", to: /b, never: [Voice]}}]\npins: {pins}\n'
    (tmp_path / "l.yaml").write_text(labels)
    result = rosprivacy.analyze([str(tmp_path / "p.xml")], [str(tmp_path / "l.yaml")])
    stored = same_from_the_database(driver, result)
    assert {s.pinned for said in stored.bound.elements.values() for s in said} >= {None, ()}
    assert [s.pinned for said in stored.bound.flows.values() for s in said] == [()]


RULES = {  # S7, S13: labels of a system with a wildcard, a log and a channel outside its standard place -> verdict
    "conduit": ("{'/up*': {leak: [Video]}, /uplink: conduit}", "leak"),
    "none": ("{'/up*': {leak: [Video]}, /uplink: {leak: none, conduit: [Video]}}", "undetermined"),
    "none of a kind": ("{'/up*': {leak: [PersonalData]}, /uplink: {leak: {none: [Video]}}}", "undetermined"),
    "source none": (
        "{'/up*': {leak: [Video]}, '/cam*': {source: {none: [Voice]}}, /camera: {source: [Voice]}}",
        "leak",
    ),
    "absent": ("{/uplink: {leak: none}, /spy: {absent: sold}}", "undetermined"),
    "clock": ("{/uplink: conduit, /spy: conduit, /watch: {leak: [Video]}}", "undetermined"),
    "log": ("{/uplink: {leak: [SpeechTranscript]}, /listener: {source: [SpeechTranscript]}}", "leak"),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", RULES)
def test_sharpened_rules_mean_the_same_from_the_database(
    driver: Driver, case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    nodes, verdict = RULES[case]
    profiles = ("/camera>/video,/x/clock", "/uplink</video,/rosout", "/spy</v*", "/watch</x/clock", "/listener>/rosout")
    (tmp_path / "p.xml").write_text(policy(*profiles), "utf-8")
    (tmp_path / "1.yaml").write_text("labels: 1\nnodes: {/camera: {source: [Video]}}\nchannels: {/video: sensitive}")
    (tmp_path / "2.yaml").write_text(f"labels: 1\nnodes: {nodes}\nchannels: {{'/v*': sensitive}}")
    result = rosprivacy.analyze("p.xml", ["1.yaml", "2.yaml"])
    assert str(result.analysis.verdict) == verdict
    same_from_the_database(driver, result)
    assert verdicts(driver) == {"r": verdict}


def verdicts(driver: Driver) -> dict[str, str]:
    return dict(record.values() for record in driver.execute_query("MATCH (r:Robot) RETURN r.name, r.verdict").records)


@pytest.mark.slow
def test_on_random_graphs_nothing_changes(driver: Driver) -> None:
    """60 robots in one analysis find what each finds alone, and nothing differs from what was loaded.

    Only whether anybody speaks of leaks, or data goes anywhere, is asked of all together: a robot that lacks this by
    itself is undetermined alone, and need not be beside others.
    """
    rows, expected, lacking = [], set(), set()
    for number, system in enumerate(random_systems(60)):
        analysis, robot = system.analyse(), f"g{number:02}"
        if analysis.lacking:
            lacking.add(robot)
        rows.append(robot_rows(robot, analysis, system.bound(), SMALL))
        expected |= {
            (robot, f.category, f.pseudonymised, f.dismissed, *(e.name for e in f.witness)) for f in analysis.findings
        }
    load(driver, rows, SMALL)
    # All kinds of data that robots bring in together stand in "stops".
    different = ("digest", "version", "stops", "verdict")
    before, alone = dump(driver, without=different), verdicts(driver)
    stored = read_stored(driver, SMALL)
    analysis = analyse(stored.graph, stored.bound, SMALL.hierarchy)
    assert expected == {
        (f.source.robot, f.category, f.pseudonymised, f.dismissed, *(e.name for e in f.witness))
        for f in analysis.findings
    }
    write_back(driver, stored, analysis, SMALL)
    after = dump(driver, without=different)
    assert [set(x) ^ set(y) for x, y in zip(after, before, strict=True)] == [set(), set()]
    changed = {robot: verdict for robot, verdict in verdicts(driver).items() if verdict != alone[robot]}
    assert changed.keys() <= lacking
    assert {*changed.values()} <= {"no-leak-found"}
    assert write_back(driver, read_stored(driver, SMALL), analysis, SMALL) == 0


TO = "{ from: /camera, to: /camera/image"
TWO_RANKS = {  # what labels of a higher and of a lower rank say of one flow
    "a broader kind may be another narrower one": ("PersonImage", f"{TO}, never: [Video] }}", "only: [Video]"),
    "nearer, but of lower rank": ("HomeMap", f"{TO}, never: [Location] }}", "only: [Household]"),
    "what only names stays": ("Video", f"{TO}, only: [Video] }}", "never: [PersonImage]"),
    "two lists": ("HomeMap", f"{TO}, only: [Location, Video] }}", "only: [Video]"),
}


class TestWhatIsSaidOfAFlow:
    """A statement keeps its rank in the database, so that it decides as in the file (rule S7)."""

    @pytest.mark.parametrize("case", one_in(4, TWO_RANKS))
    def test_it_is_decided_as_in_the_file(self, driver: Driver, case: str, examples: Path, tmp_path: Path) -> None:
        kind, high, low = TWO_RANKS[case]
        file = tmp_path / "flow.labels.yaml"
        low = f"{TO.replace('/camera,', '/cam*,')}, {low} }}"
        nodes = f"{{ /camera: {{ source: [{kind}] }}, /blur: {{ leak: [{kind}] }} }}"
        file.write_text(f"labels: 1\nnodes: {nodes}\nflows:\n  - {high}\n  - {low}\n", "utf-8")
        same_from_the_database(driver, rosprivacy.analyze(examples / "care-home" / "care-home.policy.xml", file))

    def test_every_word_comes_back(self, driver: Driver) -> None:
        """Two statements about each of some flows: every pair of words, ranks and ways of naming that may stand."""
        words = [
            Statement(word, names, (1, rank), Place("x.labels.yaml", rank), naming=GLOB if rank < EXACT else NAME)
            for word in ("only", "never")
            for names in (("Video",), ("PersonImage", "Voice"), ("Household",), ("Location",))
            for rank in (7, EXACT)
        ]
        pairs = [pair for pair in itertools.combinations(words, 2) if _agree(pair)]
        home = care_home()
        count = len(home.analysis.graph.flows)
        for start in range(0, len(pairs), count):
            some = pairs[start : start + count]
            bound = replace(home.bound, flows=dict(enumerate(some)))
            load(driver, [robot_rows("r", home.analysis, bound, VOCABULARY)], VOCABULARY)
            assert read_stored(driver, VOCABULARY).bound.flows == bound.flows

    @pytest.mark.slow
    def test_a_changed_list_is_a_later_word(self, care: Driver) -> None:
        """It outranks what files say by the other word, which stays."""
        file = next(iter(care_home().bound.flows.values()))
        for change, words in (("f.only = ['Voice']", {"only": HAND, "never": 1}), ("f.never = NULL", {"only": HAND})):
            care.execute_query(f"MATCH ()-[f:FLOWS_TO]->() WHERE f.said_at IS NOT NULL SET {change}")
            said = next(iter(read_stored(care, VOCABULARY).bound.flows.values()))
            assert {one.role: one.rank[0] for one in said} == words
            assert all(one in file or one.categories == ("Voice",) for one in said)


def _agree(pair: Sequence[Statement]) -> bool:
    try:
        return all(decided("x", pair, name, VOCABULARY.hierarchy) for name in VOCABULARY.categories)
    except LabelError:
        return False


VIDEO = ["PersonImage", "PersonalData", "Video"]  # with the broader ones


@pytest.fixture
def care(driver: Driver) -> Driver:
    """A database with the care home."""
    load(driver, [rows_of("care", care_home())], VOCABULARY)
    return driver


class TestWhatPeopleAdd:
    @pytest.mark.slow
    def test_a_storage_behind_a_node_is_found(self, care: Driver) -> None:
        """The example of docs/database.md; the recorder is no longer the leak, the bucket is."""
        care.execute_query(ADD_STORAGE)
        care.execute_query("MATCH (:RosNode {name: '/recorder'})-[l:LEAKS]->() DELETE l")
        first = answer_stored(care, Settings())
        found = [f for f in first.analysis.findings if f.leak.kind == "storage"]
        assert [[e.name for e in f.witness][-2:] for f in found] == [["/recorder", "footage bucket"]]
        (row,) = care.execute_query(
            "MATCH (:RosNode {name: '/recorder'})-[f:FLOWS_TO]->(b:Element:VideoLeak:Video) "
            "MATCH (x:Finding)-[:TO]->(b) RETURN b.kind, b.carries, f.carries, x.source"
        ).records
        assert list(row) == ["storage", VIDEO, VIDEO, "/camera"]
        assert not care.execute_query("MATCH (n:VideoLeak:RosNode) RETURN n").records
        assert load(care, [rows_of("care", care_home())], VOCABULARY).written == 1  # after that it is still there
        assert ways(answer_stored(care, Settings())) > ways(first)

    def test_a_storage_of_which_nothing_is_said_keeps_for_ever_and_nobody_knows_where(self, care: Driver) -> None:
        """Rules S10 and S11."""
        care.execute_query(ADD_STORAGE.replace(", retention: 'P30D', country: 'DE'", ""))
        result = answer_stored(care, Settings())
        (finding,) = [f for f in result.analysis.findings if f.kind == "storage-limitation"]
        assert (finding.leak.name, finding.reason) == ("footage bucket", "no retention is stated")
        assert [q.element.name for q in result.analysis.open if q.missing] == ["footage bucket"]
        rows = care.execute_query("MATCH (f:Finding {kind: 'storage-limitation'})-[:TO]->(b) RETURN b.name, f.reason")
        assert [list(record) for record in rows.records] == [["footage bucket", "no retention is stated"]]

    @pytest.mark.parametrize(
        ("change", "gone"),
        one_in(
            3,
            [
                ("MATCH (:Element {name: '/recorder'})-[l:LEAKS]->() DELETE l", "/recorder"),
                ("MATCH (:Element {name: '/camera/image'})-[f:FLOWS_TO]->({name: '/blur'}) DELETE f", "/recorder"),
                ("MATCH ()-[f:FLOWS_TO]->({name: '/blur'}) SET f.never = ['Video']", "/recorder"),
                ("MATCH ()-[s:SANITIZES]->() SET s.method = 'drop', s.stated = true", "/recorder"),
                ("MATCH (n {name: '/audio'}), (c:DataCategory {name: 'Voice'}) CREATE (n)-[:HAS_NOT]->(c)", "/uplink"),
                ("MATCH (n {name: '/audio'}), (c:DataCategory {name: 'Video'}) CREATE (n)-[:HAS_ONLY]->(c)", "/uplink"),
            ],
        ),
    )
    def test_a_changed_label_or_flow_counts(self, care: Driver, change: str, gone: str) -> None:
        before = ways(answer_stored(care, Settings()))
        care.execute_query(change)
        after = ways(answer_stored(care, Settings()))
        assert after < before
        assert {way[-1] for way in before - after} == {gone}

    def test_one_word_by_hand_outranks_the_file(self, care: Driver) -> None:
        """The file says that /display is a conduit for everything."""
        care.execute_query(
            "MATCH (n {name: '/navigator'}), (c:DataCategory {name: 'PersonTrack'}) CREATE (n)-[:LEAKS]->(c)"
        )
        assert ("PersonTrack", "/navigator") in {(way[0], way[-1]) for way in ways(answer_stored(care, Settings()))}

    @pytest.mark.slow
    def test_two_robots_meet_at_a_storage(self, care: Driver) -> None:
        """Data that one writes and the other reads flows on, across robots (rule S9)."""
        load(care, [rows_of("factory", factory(5))], VOCABULARY)

        def on_the_factory() -> list[list[tuple[str, str]]]:
            findings = answer_stored(care, Settings()).analysis.findings
            return [[(e.robot, e.name) for e in f.witness] for f in findings if f.leak.robot == "factory"]

        assert on_the_factory() == []
        care.execute_query(
            "MATCH (a:RosNode {robot: 'care', name: '/camera'}), "
            "(b:RosNode {robot: 'factory', name: '/archive_server'}) "
            "CREATE (a)-[:FLOWS_TO]->(:Storage {name: 'shared'})-[:FLOWS_TO]->(b)"
        )
        assert on_the_factory() == [[("care", "/camera"), ("", "shared"), ("factory", "/archive_server")]]
        assert verdicts(care) == {"care": "leak", "factory": "leak"}

    def test_the_answer_may_be_about_some_categories_but_all_are_written(self, care: Driver) -> None:
        result = answer_stored(care, Settings(categories=("Voice",)))
        assert {f.category for f in result.analysis.findings} == {"Voice"}
        assert care.execute_query("MATCH (f:Finding) RETURN count(f)").records[0][0] == 3


class TestOrigins:
    """What nodes make of which source's data is written where it changed only."""

    READ = (
        "MATCH (a)-[d:DERIVES_FROM]->(b) "
        "RETURN elementId(d) AS key, a.name AS made, b.name AS source, properties(d) AS said ORDER BY made, source"
    )

    def test_what_did_not_change_stays(self, care: Driver) -> None:
        before = [record.data() for record in care.execute_query(self.READ).records]
        assert before
        answer_stored(care, Settings())
        assert [record.data() for record in care.execute_query(self.READ).records] == before

    @pytest.mark.parametrize(
        "change",
        [
            "MATCH ()-[d:DERIVES_FROM]->() WITH d LIMIT 1 DELETE d",
            "MATCH ()-[d:DERIVES_FROM]->() WITH d LIMIT 1 SET d.category = 'Voice'",
            "MATCH (a)-[d:DERIVES_FROM]->(b) WITH * LIMIT 1 CREATE (a)-[e:DERIVES_FROM]->(b) SET e = properties(d)",
        ],
        ids=["gone", "another", "twice"],
    )
    def test_what_changed_is_as_it_was_loaded(self, care: Driver, change: str) -> None:
        def rows() -> list[dict[str, object]]:
            return [{**record.data(), "key": ""} for record in care.execute_query(self.READ).records]

        before = rows()
        care.execute_query(change)
        assert rows() != before
        answer_stored(care, Settings())
        assert rows() == before

    def test_of_a_label_that_is_gone_nothing_is_left(self, care: Driver) -> None:
        care.execute_query("MATCH ()-[d:DERIVES]->() DELETE d")
        answer_stored(care, Settings())
        assert not care.execute_query(self.READ).records


class TestProblems:
    @pytest.mark.parametrize(
        ("damage", "message"),
        one_in(6, [
            ("CREATE (:Storage:Element)", "has no name; SET n.name"),
            ("CREATE (:Element {name: 'x'})", "what is 'x'\\? its labels do not say its kind; give it one of"),
            ("CREATE (:Element:Storage:Device {name: 'x'})", "what is 'x'\\?"),
            ("CREATE (:Element:Storage {name: 'x'}), (:Element:Storage {name: 'x'})", "two elements storage 'x'"),
            (
                "MATCH (n {name: '/blur'}) CREATE (n)-[:LEAKS]->(:DataCategory {name: 'Nonsense', iri: 'x'})",
                "unknown category 'Nonsense'",
            ),
            ("MATCH ()-[f:FLOWS_TO]->({name: '/blur'}) SET f.never = ['Nonsense']", "unknown category 'Nonsense'"),
            ("MATCH ()-[s:SANITIZES]->() SET s.method = 'pray'", "SANITIZES of '/.*' cannot be understood: 'pray'"),
            ("MATCH ()-[s:DERIVES]->() REMOVE s.of", "DERIVES of '/.*' cannot be understood: it does not say of what"),
            ("MATCH ()-[s:LEAKS]->() SET s.tier = 'high'", "LEAKS of '/.*' cannot be understood"),
            ("MATCH ()-[f:FLOWS_TO]->({name: '/blur'}) SET f.line = 'high'", "a flow cannot be understood"),
            ("MATCH ()-[f:FLOWS_TO]->({name: '/blur'}) SET f.further = ['{']", "a flow cannot be understood"),
            ("MATCH ()-[f:FLOWS_TO]->({name: '/blur'}) SET f.never = 7", "a flow cannot be understood"),
            ("MATCH (r:Robot) SET r.assumptions = '{'", "assumptions of robot 'care' cannot be understood; load"),
            ("MATCH (r:Robot) SET r.assumptions = '[]'", "assumptions of robot 'care' cannot be understood"),
            ("MATCH (r:Robot) SET r.diagnostics = '[7]'", "diagnostics of robot 'care' cannot be understood"),
            ("MATCH (r:Robot) SET r.diagnostics = 7", "diagnostics of robot 'care' cannot be understood"),
            (
                "CREATE (:Element:Storage {name: 'x', country: 'UK'})",
                "storage 'x' cannot be understood: country 'UK' is not an ISO 3166-1 code; did you mean GB\\?",
            ),
            (
                "CREATE (:Element:Storage {name: 'x', retention: 'long'})",
                "retention 'long' is not an ISO 8601 duration",
            ),
            ("CREATE (:Element:Storage {name: 'x', limits: ['X: P1D']})", "limits names the unknown category 'X'"),
            ("CREATE (:Element:Storage {name: 'x', backups: 'some'})", "backups 'some' is not an ISO 8601 duration"),
            ("CREATE (:Element:Storage {name: 'x', transfer: 'trust'})", "transfer 'trust' is none of adequacy, "),
            ("CREATE (:Element:Storage {name: 'x', operator: 7})", "operator is not a text"),
            ("CREATE (:Robot {name: 'other', view: 'enforced'})", "in the views declared and enforced"),
            ("MATCH (r:Robot) DELETE r", "there is no robot in it; load one"),
            (
                "MATCH (n {name: '/camera'}), (c:DataCategory {name: 'Video'}) CREATE (n)-[:SANITIZES {tier: 1}]->(c)",
                "/camera is source for Video here and sanitizer|/camera is sanitizer .* for Video here and source",
            ),
        ]),
    )  # fmt: skip
    def test_each_is_a_line_and_nothing_is_written(self, care: Driver, damage: str, message: str) -> None:
        care.execute_query(damage.replace("DELETE r", "DETACH DELETE r"))
        versions = "MATCH (r:Robot) RETURN collect(r.version)"
        before = care.execute_query(versions).records[0][0]
        with pytest.raises(InputErrors, match=message) as error:
            answer_stored(care, Settings())
        assert all(":" in line for line in str(error.value).splitlines())
        assert care.execute_query(versions).records[0][0] == before

    @pytest.mark.slow
    def test_a_robot_that_is_loaded_meanwhile_is_not_written_over(self, driver: Driver) -> None:
        load(driver, [rows_of("r", factory(2))], VOCABULARY)
        stored = read_stored(driver, VOCABULARY)
        analysis = analyse(stored.graph, stored.bound, VOCABULARY.hierarchy)
        load(driver, [rows_of("r", factory(5))], VOCABULARY)
        before = dump(driver)
        with pytest.raises(DatabaseError, match="'r' was loaded meanwhile; analyse the database again"):
            write_back(driver, stored, analysis, VOCABULARY)
        assert dump(driver) == before

    def test_an_empty_database(self, driver: Driver) -> None:
        with pytest.raises(InputErrors, match="there is no robot in it; load one with rosprivacy load"):
            answer_stored(driver, Settings())


TYPED = "types: 1\ntopics: {/video: [{type: sensor_msgs/msg/Image, hash: RIHS01_a, writers: [/camera]}]}\n"


def test_types_come_back_and_a_person_can_state_more_there(driver: Driver, tmp_path: Path) -> None:
    """S15: what was observed is as it was; a type that is only named in the database is stated for all writers."""
    (tmp_path / "p.xml").write_text(policy("/camera>/video", "/wall</video"), "utf-8")
    (tmp_path / "t.yaml").write_text(TYPED, "utf-8")
    (tmp_path / "l.yaml").write_text("labels: 1\nchannels: {/video: {types: [a/msg/B]}}\n", "utf-8")
    files = [str(tmp_path / name) for name in ("p.xml", "l.yaml", "t.yaml")]
    result = rosprivacy.analyze(files[0], files[1], types=files[2])
    load(driver, [robot_of("r", result)], VOCABULARY)
    stored = answer_stored(driver, Settings()).document()
    assert stored["types"] == result.document()["types"]
    assert stored["assumptions"]["types"] == result.document()["assumptions"]["types"]
    driver.execute_query("MATCH (t:Topic {name: '/video'}) SET t.types = t.types + ['std_msgs/msg/Bool']")
    (row,) = answer_stored(driver, Settings()).document()["types"]
    assert [(one["type"], one["stated"]) for one in row["types"]] == [
        ("a/msg/B", True), ("sensor_msgs/msg/Image", False), ("std_msgs/msg/Bool", True),
    ]  # fmt: skip
    driver.execute_query("MATCH (t:Topic {name: '/video'}) SET t.type_facts = ['[]']")
    with pytest.raises(InputErrors, match=r"'/video' cannot be understood: type_facts are not what was loaded"):
        answer_stored(driver, Settings())


def test_what_was_seen_and_its_gaps_come_back(driver: Driver, tmp_path: Path) -> None:
    """Rule S16: times and gaps of an observed policy are facts of the system, whatever it is read from."""
    at = "2026-11-22T10:00:00Z"
    text = (
        node_info("/cam", publishers="/image: s/msg/I") + node_info("/up", subscribers="/image: s/msg/I") + "/ghost\n"
    )
    file, labels = tmp_path / "robot.policy.xml", tmp_path / "labels.yaml"
    file.write_bytes(policy_xml(prepared(read_node_info(text, at))))
    labels.write_text("labels: 1\nnodes:\n  /cam: {source: [Video]}\n  /up: {leak: [Video]}\n", "utf-8")
    result = rosprivacy.analyze(file, labels)
    load(driver, [robot_of("r1", result)], VOCABULARY)
    stored, files = answer_stored(driver, Settings()).document(), result.document()
    seen = {"by": ["text"], "first": at, "last": at}
    for document in (stored, files):
        assert [line["seen"] for step in document["findings"][0]["steps"] for line in step["policy"]] == [seen, seen]
    codes = [{said.get("code") for said in document["diagnostics"]} for document in (stored, files)]
    assert codes[0] == codes[1]
    assert {"observed", "observation-gap", "enclaves-made-up"} <= codes[0]
