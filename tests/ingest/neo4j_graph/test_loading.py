"""Loading: the same twice changes nothing, another policy replaces, others' data stays, no fault leaves half a one."""

from __future__ import annotations

import subprocess
import sys
import threading
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.errors import DatabaseError, InputError, InputErrors
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.model import Bound, Category, Element, Flow, FlowGraph, Place, Statement
from rosprivacy.ingest.neo4j_graph import loading
from rosprivacy.ingest.neo4j_graph.fleet_rows import robot_rows
from rosprivacy.ingest.neo4j_graph.loading import Loaded, Run, check_robot_name, load, unload
from rosprivacy.ingest.neo4j_graph.read_back import read_stored
from rosprivacy.ingest.neo4j_graph.schema import NODES, RELATIONSHIPS
from rosprivacy.ontology.vocabulary import Vocabulary
from rosprivacy.ontology.vocabulary import load as load_vocabulary
from rosprivacy.private_neo4j import connection, server
from tests.helpers.daily import one_in
from tests.helpers.graphs import care_home, dump, factory, rows_of
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from neo4j import Driver

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows
    from rosprivacy.private_neo4j.connection import Connection

VOCABULARY = load_vocabulary()
COUNTS = (
    "MATCH (r:Robot) RETURN r.name AS name, r.elements = COUNT { (r)<-[:OF_ROBOT]-(e WHERE NOT e:Intake) } "
    "AND r.flows = COUNT { (r)<-[:OF_ROBOT]-()-[:FLOWS_TO]->() } AS whole"
)


def ask(driver: Driver, query: str, **values: Any) -> list[Any]:
    return [record[0] for record in driver.execute_query(query, **values).records]


@pytest.mark.slow
@pytest.mark.database
def test_the_graph_has_the_ends_and_keys_that_are_declared(driver: Driver) -> None:
    """Properties and their types are held by ``test_golden_rows.py``."""
    load(driver, [rows_of("a", care_home()), rows_of("b", factory(4))], VOCABULARY)
    for relationship in RELATIONSHIPS:
        query = f"MATCH (a)-[r:{relationship.type}]->(b) RETURN DISTINCT labels(a)[0] + '>' + labels(b)[0]"
        assert set(ask(driver, query)) <= {f"{relationship.source}>{relationship.target}"}
    constraints = driver.execute_query("SHOW CONSTRAINTS YIELD labelsOrTypes AS labels, properties AS keys").records
    assert {(row["labels"][0], row["keys"][0]) for row in constraints} >= {(kind.label, kind.key) for kind in NODES}


CHANGES = (
    "MATCH (c:Change)-[:CAME_WITH]->(l:Load) "
    "RETURN [l.at, c.robot, c.what, c.category, c.source, c.leak, c.dismissed] ORDER BY c.source"
)
MONDAY, TUESDAY = (Run(f"2026-11-2{day}T08:00:00Z", "1.0", str(day)) for day in (3, 4))


@pytest.mark.database
class TestHistory:
    """What a load changed can be asked for; what is gone is found by no question about what is there."""

    def test_of_a_robot_that_was_there_is_said_what_came_and_went(self, driver: Driver) -> None:
        load(driver, [rows_of("r", factory(2)), rows_of("s", factory(2))], VOCABULARY, run_of=MONDAY)
        assert ask(driver, CHANGES) == []
        sources = ask(driver, "MATCH (f:Finding {robot: 'r'}) RETURN f.source ORDER BY f.source")
        assert len(sources) == 2
        load(driver, [rows_of("r", factory(1)), rows_of("s", factory(2)), rows_of("t", factory(2))], VOCABULARY,
             run_of=TUESDAY)  # fmt: skip
        assert ask(driver, CHANGES) == [
            [TUESDAY.at, "r", "gone", "Video", source, "/archive_server", False] for source in sources
        ]
        assert ask(driver, "MATCH (l:Load)-[:WROTE]->(r) RETURN l.at + ' ' + r.name ORDER BY l.at, r.name") == [
            *(f"{MONDAY.at} {name}" for name in "rs"), *(f"{TUESDAY.at} {name}" for name in "rt")
        ]  # fmt: skip
        assert ask(driver, "MATCH (f:Finding {robot: 'r'}) RETURN f.id") == []
        assert ask(driver, "MATCH (:Change)-[r]-(n) WHERE NOT n:Load RETURN type(r)") == []

    def test_a_robot_of_which_others_made_elements_has_not_changed(self, driver: Driver) -> None:
        rows = rows_of("r", factory(2))
        others = replace(rows_of("s", factory(1)), foreign=rows.elements[:3])
        load(driver, [others], VOCABULARY, run_of=MONDAY)
        load(driver, [rows], VOCABULARY, run_of=TUESDAY)
        assert ask(driver, "MATCH (f:Finding {robot: 'r'}) RETURN count(f)") != [0]
        assert ask(driver, CHANGES) == []

    def test_a_finding_that_another_leak_hides_now_is_changed(self, driver: Driver) -> None:
        rows = rows_of("r", factory(2))
        load(driver, [rows], VOCABULARY, run_of=MONDAY)
        hidden = [{**row, "properties": {**row["properties"], "dismissed": True}} for row in rows.findings]
        other = replace(rows, findings=hidden, properties={**rows.properties, "digest": "another"})
        load(driver, [other], VOCABULARY, run_of=TUESDAY)
        assert ask(driver, CHANGES) == [
            [TUESDAY.at, "r", "changed", "Video", finding["properties"]["source"], "/archive_server", True]
            for finding in sorted(hidden, key=lambda row: row["properties"]["source"])
        ]

    def test_a_load_that_was_cut_off_stays_running(self, driver: Driver) -> None:
        def rows() -> Iterator[RobotRows]:
            yield rows_of("r", factory(2))
            yield rows_of("r", factory(1))  # of the same name: the first is written before
            raise InputError("fleet.yaml", 1, "is gone", "")

        with pytest.raises(InputError):
            load(driver, rows(), VOCABULARY, run_of=MONDAY)
        assert ask(driver, "MATCH (l:Load) RETURN [l.state, l.written]") == [["running", 1]]
        load(driver, [rows_of("r", factory(2))], VOCABULARY, run_of=TUESDAY)
        assert ask(driver, "MATCH (l:Load) WHERE l.state = 'whole' RETURN l.at") == [TUESDAY.at]


@pytest.mark.database
class TestLoad:
    def test_twice_changes_nothing(self, driver: Driver) -> None:
        rows = [rows_of("care", care_home()), rows_of("factory", factory(2))]
        assert load(driver, rows, VOCABULARY) == Loaded(2, 0)
        before = dump(driver)
        assert load(driver, rows, VOCABULARY) == Loaded(0, 2)
        assert dump(driver) == before

    @pytest.mark.slow
    def test_another_policy_takes_its_place(self, driver: Driver) -> None:
        load(driver, [rows_of("r", factory(5))], VOCABULARY)
        fresh = dump(driver, without=("version",))
        driver.execute_query("MATCH (n) DETACH DELETE n")
        load(driver, [rows_of("r", care_home())], VOCABULARY)
        load(driver, [rows_of("r", factory(5))], VOCABULARY)
        assert dump(driver, without=("version",)) == fresh

    def test_labels_of_data_that_is_gone_go(self, driver: Driver) -> None:
        load(driver, [rows_of("r", factory(2))], VOCABULARY)
        assert ask(driver, "MATCH (n:VideoLeak) RETURN n.name") == ["/archive_server"]
        load(driver, [rows_of("r", factory(1))], VOCABULARY)
        assert ask(driver, "MATCH (n:VideoLeak) RETURN n.name") == []

    def test_what_people_added_and_other_robots_stay(self, driver: Driver) -> None:
        load(driver, [rows_of("other", care_home()), rows_of("r", factory(2))], VOCABULARY)
        driver.execute_query(
            "MATCH (a:RosNode {name: '/archive_server', robot: 'r'}), (c:DataCategory {name: 'Voice'}) "
            "SET a:Checked, a.owner = 'Ada' "
            "CREATE (s:Element:Storage {id: 'tape', name: 'tape'}), (a)-[:FLOWS_TO {by: 'Ada'}]->(s), "
            "(a)-[:LEAKS]->(c), (a)-[:STANDS_IN]->(:Room {name: 'cellar'})"
        )
        others = dump(driver)[0]
        load(driver, [rows_of("r", factory(3))], VOCABULARY)
        assert ask(
            driver,
            "MATCH (a:RosNode:Checked {owner: 'Ada'})-[:FLOWS_TO {by: 'Ada'}]->(:Storage {id: 'tape'}), "
            "(a)-[l:LEAKS]->(:DataCategory {name: 'Voice'}), (a)-[:STANDS_IN]->(:Room) WHERE l.robot IS NULL "
            "RETURN a.name",
        ) == ["/archive_server"]
        kept = {node for node in others if '"robot": "other"' in node or "tape" in node or "cellar" in node}
        assert kept <= dump(driver)[0]

    @pytest.mark.slow
    @pytest.mark.parametrize(
        "damage",
        one_in(
            3,
            [
                "MATCH (n:Topic {name: '/safety_video'}) DETACH DELETE n",
                "MATCH (:RosNode)-[f:FLOWS_TO]->(:Topic {name: '/safety_video'}) DELETE f",
                "MATCH ()-[l:LEAKS]->() DELETE l",
                "MATCH (n:Element) WITH n LIMIT 20 DETACH DELETE n",
                "MATCH (r:Robot) DETACH DELETE r",
            ],
        ),
    )
    def test_what_was_broken_is_repaired(self, driver: Driver, damage: str) -> None:
        rows = [rows_of("r", factory(2))]
        load(driver, rows, VOCABULARY)
        whole = dump(driver, without=("version",))
        driver.execute_query(damage)
        assert load(driver, rows, VOCABULARY) == Loaded(1, 0)
        assert dump(driver, without=("version",)) == whole

    @pytest.mark.slow
    def test_readers_see_the_old_robot_until_the_new_one_is_whole(
        self, driver: Driver, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        load(driver, [rows_of("r", factory(2))], VOCABULARY)
        before, seen = dump(driver), []
        original = loading.run

        def run(*arguments: Any, **values: Any) -> None:
            original(*arguments, **values)
            seen.append(dump(driver))

        monkeypatch.setattr(loading, "run", run)
        load(driver, [rows_of("r", factory(4))], VOCABULARY)
        assert len(seen) > 15
        assert [graph for graph in seen if graph != before] == []
        assert dump(driver) != before

    def test_unload_leaves_the_others(self, driver: Driver) -> None:
        load(driver, [rows_of("other", care_home())], VOCABULARY)
        before = dump(driver)
        load(driver, [rows_of("r", factory(2))], VOCABULARY)
        assert unload(driver, ["r", "nobody"]) == ["r"]
        assert dump(driver) == before
        assert unload(driver, ["r"]) == []

    @pytest.mark.slow
    def test_more_rows_than_a_batch(self, driver: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
        rows = [rows_of(f"r{i}", factory(2)) for i in range(5)]
        load(driver, rows, VOCABULARY)
        before = dump(driver)
        driver.execute_query("MATCH (n) DETACH DELETE n")
        monkeypatch.setattr(loading, "BATCH", 7)
        done: list[int] = []
        load(driver, iter(rows), VOCABULARY, done.append)
        assert dump(driver) == before
        assert done == [r.size for r in rows]

    def test_the_later_of_two_robots_of_one_name_stays(self, driver: Driver) -> None:
        load(driver, [rows_of("r", care_home()), rows_of("r", factory(5))], VOCABULARY)
        assert ask(driver, "MATCH (n:RosNode {name: '/blur'}) RETURN n") == []


@pytest.mark.database
class TestNames:
    """Nothing that stands in a policy, a label file or an ontology is Cypher."""

    HOSTILE = (
        "/a'b\"c`d",
        "/x'}) DETACH DELETE (n) //",
        "/line\nfeed\ttab\\back\u2028slash",
        "/ünïcode/名前/👁/\u202eleft",
        "/" + "x" * 4000,
        "/" + "👁" * 4000,
        "/a|b",
        "/a\\|b",
        "$(row.labels)",
        "/\u0000nul",
    )

    def test_hostile_names_come_back_as_they_were(self, driver: Driver) -> None:
        """A chain of nodes and topics, in which all names are."""
        kinds = [Element(kind, name) for name in self.HOSTILE for kind in ("node", "topic")]
        elements = tuple(sorted(kinds, key=Element.sort_key))
        number = {element: i for i, element in enumerate(elements)}
        flows = [Flow(number[a], number[b], "publish" if a.is_node else "subscribe") for a, b in pairwise(kinds)]
        graph = FlowGraph(elements, tuple(sorted(flows, key=lambda f: (f.source, f.target, f.role))), (), ())
        source = Statement("source", ("Video",), (1, 1), Place("a'b`c.yaml", 1))
        leak = Statement("leak", ("Video",), (1, 1), Place("\n", 2))
        bound = Bound({number[kinds[0]]: (source,), number[kinds[-2]]: (leak,)})
        analysis = analyse(graph, bound, VOCABULARY.hierarchy)
        robot = "r'`\"$x 名"
        load(driver, [robot_rows(robot, analysis, bound, VOCABULARY)], VOCABULARY)
        stored = read_stored(driver, VOCABULARY)
        assert {*stored.graph.elements} == {*elements}
        again = analyse(stored.graph, stored.bound, VOCABULARY.hierarchy)
        assert [f.witness for f in again.findings] == [f.witness for f in analysis.findings]
        assert len(again.findings) == 1
        assert ask(driver, "MATCH (n:Element) RETURN count(DISTINCT n.id)") == [2 * len(self.HOSTILE)]
        assert unload(driver, [robot]) == [robot]
        assert ask(driver, "MATCH (n:Element) RETURN n") == []

    @pytest.mark.parametrize(
        "label",
        one_in(5, ["x`) DETACH DELETE n //", "", "a b", "1st", "Ünicode", "Element", "Robot", "Topic", "VideoLeak"]),
    )
    def test_a_label_that_is_none_or_taken_is_refused(self, driver: Driver, label: str) -> None:
        load(driver, [rows_of("r", factory(2))], VOCABULARY)
        before = dump(driver)
        bad = Vocabulary.of([*VOCABULARY.categories.values(), Category("Bad", "urn:bad", label, "t", "d")])
        with pytest.raises(InputErrors, match="label"):
            load(driver, [], bad)
        assert dump(driver) == before

    def test_a_category_named_like_cypher_is_a_value(self, driver: Driver) -> None:
        name = "Bio'}) DETACH DELETE (n) //`"
        category = Category(name, "urn:x'`:1", "Bio1", "t' ` $x", "d", ("PersonalData",))
        vocabulary = Vocabulary.of([*VOCABULARY.categories.values(), category])
        graph = FlowGraph((Element("node", "/a"), Element("node", "/b")), (Flow(0, 1, "publish"),), (), ())
        said = {
            0: (Statement("source", (name,), (1, 1), Place("f", 1)),),
            1: (Statement("leak", (name,), (1, 1), Place("f", 2)),),
        }
        bound = Bound(said)
        rows = robot_rows("r", analyse(graph, bound, vocabulary.hierarchy), bound, vocabulary)
        load(driver, [rows_of("other", factory(2)), rows], vocabulary)
        assert ask(driver, "MATCH (n:Bio1Source)-[f:FLOWS_TO]->(:Bio1Leak) RETURN f.carries") == [
            [name, "PersonalData"]
        ]
        assert ask(driver, "MATCH (n:Element {robot: 'other'}) RETURN count(*)") == [88]

    @pytest.mark.parametrize("name", ["", "a\nb", "x" * 201, "\u202e"])
    def test_a_robot_needs_a_name_that_can_be_read(self, name: str) -> None:
        with pytest.raises(InputError, match="cannot name a robot"):
            check_robot_name(name)


LOADER = """
import sys
from rosprivacy.private_neo4j import connection as database
from rosprivacy.ingest.neo4j_graph import loading
from rosprivacy.ontology.vocabulary import load as vocabulary
from tests.helpers.graphs import factory, rows_of
loading.BATCH = 1000
result = factory(int(sys.argv[1]))
rows = (rows_of(f"r{i:03}", result) for i in range(int(sys.argv[2])))
with database.open_driver(database.connection(None)) as driver:
    print(loading.load(driver, rows, vocabulary(), lambda _: print("+", flush=True)))
"""


def loader(run: int, robots: int) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", LOADER, str(run), str(robots)]
    return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def all_whole(driver: Driver) -> int:
    found = driver.execute_query(COUNTS).records
    assert [record["name"] for record in found if not record["whole"]] == []
    robots = ask(driver, "MATCH (n:Element) WHERE NOT (n)-[:OF_ROBOT]->() RETURN n.id")
    assert robots == []
    return len(found)


@pytest.mark.slow
@pytest.mark.database
class TestFaults:
    def test_two_loads_at_once(self, driver: Driver) -> None:
        """Of the same robots, with different policies: each robot is one or the other, and whole."""
        with loader(2, 25) as one, loader(4, 25) as other:
            said = [child.communicate(timeout=120) for child in (one, other)]
        assert [child.returncode for child in (one, other)] == [0, 0], said
        assert all_whole(driver) == 25
        digests = {rows_of(f"r{i:03}", factory(run)).digest for i in range(25) for run in (2, 4)}
        assert set(ask(driver, "MATCH (r:Robot) RETURN r.digest")) <= digests

    def test_threads_that_load_in_opposite_orders(self, driver: Driver) -> None:
        rows = [rows_of(f"r{i}", factory(2)) for i in range(8)]
        again = [rows_of(f"r{i}", factory(4)) for i in range(8)]
        problems: list[Exception] = []

        def work(some: list[RobotRows]) -> None:
            try:
                load(driver, some, VOCABULARY)
            except Exception as error:  # noqa: BLE001 - whatever it is, the test fails with it
                problems.append(error)

        threads = [threading.Thread(target=work, args=(some,)) for some in (rows, again[::-1], rows[::-1], again)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert problems == []
        assert all_whole(driver) == 8

    def test_a_server_that_only_reads_refuses_in_one_line(
        self, private_neo4j: Connection, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        assert private_neo4j
        assert connection.stop()
        with monkeypatch.context() as patch:  # over before the fixture starts the server again for others
            only_reads = "server.databases.default_to_read_only=true\n"
            patch.setattr(server, "CONFIGURATION", server.CONFIGURATION + only_reads)
            try:
                with connection.open_driver(connection.start()) as driver, pytest.raises(DatabaseError) as error:
                    load(driver, [rows_of("r", factory(2))], VOCABULARY)
            finally:
                connection.stop()
        assert str(error.value).startswith("the server refuses to write: ")
        assert "\n" not in str(error.value)
