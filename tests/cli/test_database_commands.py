"""``load``, ``unload``, ``query`` and ``analyze --from-database`` as people and CI call them, with a real server."""

from __future__ import annotations

import csv
import io
import json
import socket
import time
from typing import TYPE_CHECKING

import pytest
from lxml import etree

from rosprivacy.analysis.errors import DatabaseError
from rosprivacy.ingest.neo4j_graph.ids import schema_names
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.private_neo4j import connection
from rosprivacy.queries.library import pack
from rosprivacy.report.pictures import looks
from tests.helpers.command import LINE
from tests.helpers.daily import one_in
from tests.helpers.graphs import care_home, rows_of
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from neo4j import Driver

    from rosprivacy.private_neo4j.connection import Connection
    from tests.helpers.command import Cli, Done

HOME = ROOT / "examples" / "care-home"
POLICY, LABELS = HOME / "care-home.policy.xml", HOME / "care-home.labels.yaml"
LOAD = ("load", POLICY, "--labels", LABELS, "--robot", "h1")
NAIVE = "MATCH p = (:VoiceSource)-[:CARRIES_VOICE*1..]->(:VoiceLeak) RETURN p"
LOOKS = {name: look.words for name, look in {**looks.ROLE_LOOKS, **looks.LINE_LOOKS}.items()}
EMPTY = """<policy version="0.2.0"><enclaves><enclave path="/one">
<profiles><profile ns="/" node="n"/></profiles></enclave></enclaves></policy>"""
GUESS = "bad guess"
LOCKED = 6  # seconds; after three wrong passwords the server lets nobody in for 5


@pytest.fixture(scope="module")
def opened(neo4j_server: Connection) -> Iterator[Driver]:
    with connection.open_driver(neo4j_server) as driver:
        yield driver


@pytest.fixture
def driver(opened: Driver) -> Driver:
    """Of an empty database."""
    opened.execute_query("MATCH (n) DETACH DELETE n")
    return opened


@pytest.fixture(scope="class")
def loaded(opened: Driver) -> Driver:
    """Of a database with the care home as h1; for tests that only read."""
    opened.execute_query("MATCH (n) DETACH DELETE n")
    result = care_home()
    load(opened, [rows_of("h1", result)], result.vocabulary)
    return opened


def count(driver: Driver, text: str) -> int:
    return int(driver.execute_query(f"MATCH {text} RETURN count(*)").records[0][0])


def lines(done: Done) -> list[str]:
    return done.stderr.splitlines()


@pytest.mark.database
class TestLoad:
    @pytest.mark.slow
    def test_it_says_what_it_wrote_and_the_same_again_changes_nothing(self, cli: Cli, driver: Driver) -> None:
        first = cli(*LOAD)
        assert (first.returncode, first.stderr) == (0, "")
        assert first.stdout.startswith("robot h1 is written: 98 elements and 219 flows (172 nodes with the legs of ")
        assert "221 FLOWS_TO with denied flows), 3 findings\nleak: " in first.stdout
        assert "is there already, nothing to change" in cli(*LOAD).stdout
        assert count(driver, "(:Finding {robot: 'h1'})") == 3

    def test_a_policy_that_is_refused_writes_nothing(self, cli: Cli, driver: Driver, tmp_path: Path) -> None:
        (tmp_path / "bad.xml").write_text("<policy")
        done = cli("load", POLICY, tmp_path / "bad.xml")
        assert done.returncode == 2
        assert all(LINE.match(line) for line in lines(done))
        assert count(driver, "(n)") == 0

    @pytest.mark.slow
    def test_without_a_name_a_robot_is_called_as_its_policy_file_and_replaces_no_other(
        self, cli: Cli, driver: Driver, tmp_path: Path
    ) -> None:
        mine, other = tmp_path / "care.policy.xml", tmp_path / "other" / "care.policy.xml"
        other.parent.mkdir()
        for file, enclave in ((mine, "/one"), (mine, "/g")):  # with other contents: a new state of the robot
            file.write_text(EMPTY.replace("/one", enclave), "utf-8")
            done = cli("load", file)
            assert done.stdout.startswith("robot care is written: ")
        assert lines(done) == ["robot care has the name of its policy file; --robot NAME says another"]
        other.write_text(EMPTY.replace("/one", "/f"), "utf-8")
        done = cli("load", other)
        assert (done.returncode, done.stdout) == (2, "")
        what = f"{other}: the database has a robot care of other policies ({mine})"
        assert lines(done) == [f"{what}; name this one: --robot NAME; --robot care replaces it"]
        assert count(driver, "(:Enclave {path: '/g'})") == 1
        done = cli("load", other, "--robot", "care")
        assert done.returncode == 0
        assert lines(done) == [f"warning: in place of 1 robot of the same name and other policies: care ({mine})"]
        assert count(driver, "(:Robot)") == count(driver, "(:Enclave {path: '/f'})") == 1

    @pytest.mark.parametrize("names", [["."], ["*.xml"], ["policy.xml"], [POLICY, "policy.xml"], ["nope.xml"]])
    def test_what_names_no_robot_is_refused(
        self, cli: Cli, driver: Driver, tmp_path: Path, names: list[str | Path]
    ) -> None:
        (tmp_path / "policy.xml").write_text(EMPTY, "utf-8")
        done = cli("load", *names, cwd=tmp_path)
        assert (done.returncode, done.stdout) == (2, "")
        problem = "not found" if names == ["nope.xml"] else "nothing says what the robot is called in the database"
        assert done.stderr.startswith(f"{names[0]}: ")
        assert problem in done.stderr
        assert count(driver, "(:Robot)") == 0

    @pytest.mark.slow
    def test_a_fleet_that_takes_the_place_of_other_robots_says_so(
        self, cli: Cli, driver: Driver, tmp_path: Path
    ) -> None:
        for name in "pq":
            (tmp_path / f"{name}.xml").write_text(EMPTY, "utf-8")
            (tmp_path / f"{name}.yaml").write_text(f"fleet: 1\nrobots: {{h1: {{policies: {name}.xml}}}}\n", "utf-8")
            assert lines(cli("load", "--fleet", tmp_path / f"{name}.yaml")) == []  # the second has the same contents
        (tmp_path / "p.xml").write_text(EMPTY.replace("/one", "/f"), "utf-8")
        done = cli("load", "--fleet", tmp_path / "p.yaml")
        was = tmp_path / "q.xml"
        assert lines(done) == [f"warning: in place of 1 robot of the same name and other policies: h1 ({was})"]
        done = cli("load", "--fleet", tmp_path / "p.yaml", "--robot", "h2")
        assert (done.returncode, done.stdout) == (2, "")
        assert "--fleet takes the names of the fleet file: no --robot" in done.stderr
        assert count(driver, "(:Robot {name: 'h1'})") == 1

    @pytest.mark.slow
    def test_of_a_database_the_same_is_suggested_as_of_its_policies_and_nothing_is_written(
        self, cli: Cli, driver: Driver
    ) -> None:
        assert cli(*LOAD).returncode == 0
        written = "MATCH (n) OPTIONAL MATCH (n)-[r]->() RETURN properties(n) AS n, collect(properties(r)) AS r"
        before = sorted(map(str, driver.execute_query(written).records))
        of_policies, of_database = (
            json.loads(cli("suggest", *system, "-f", "json").stdout)["suggestions"]
            for system in ((POLICY, "--labels", LABELS), ("--from-database",))
        )
        assert sorted(map(str, driver.execute_query(written).records)) == before
        assert {suggestion["robot"] for suggestion in of_database} == {""}  # there is only one
        same = ("section", "name", "label", "confidence", "open")
        rows, stored = ([[one[key] for key in same] for one in rows] for rows in (of_policies, of_database))
        assert rows == stored
        done = cli("suggest", "--from-database", "--into", "l.yaml")
        assert done.returncode == 2
        assert "no --from-database" in " ".join(done.stderr.replace("│", " ").split())

    def test_unload(self, cli: Cli, driver: Driver) -> None:
        cli(*LOAD)
        done = cli("unload", "--robot", "h1", "--robot", "nobody")
        assert (done.returncode, done.stdout) == (2, "robot h1 is removed\n")
        assert lines(done) == ["no robot nobody in the database; see rosprivacy query robots"]
        assert count(driver, "(:Element)") == 0


@pytest.mark.database
class TestQuery:
    def test_the_list_names_every_question_and_what_can_be_drawn_and_needs_no_server(self, cli: Cli) -> None:
        done = cli("query", NEO4J_URI="bolt://127.0.0.1:1")
        assert done.returncode == 0
        listed = done.stdout.splitlines()
        names = [name.split(" ")[0] for name in listed[::2]]
        assert names == list(pack())
        drawn = {name for name, said in zip(names, listed[1::2], strict=True) if "-f svg" in said}
        assert drawn == {query.name for query in pack().values() if query.drawable} == {"data-graph", "leak-path-graph"}

    @pytest.mark.slow
    @pytest.mark.usefixtures("loaded")
    def test_the_three_formats_say_the_same(self, cli: Cli) -> None:
        rows = json.loads(cli("query", "leak-paths", "--format", "json").stdout)
        leaks = [(row["category"], row["leak"]) for row in rows]
        assert leaks == [("FaceTemplate", "/uplink"), ("Video", "/recorder"), ("Voice", "/uplink")]
        table = list(csv.DictReader(io.StringIO(cli("query", "leak-paths", "--format", "csv").stdout)))
        paths = [" -> ".join(row["path"]) for row in rows]
        assert [row["path"] for row in table] == paths
        shown = cli("query", "leak-paths").stdout
        assert all(path in shown for path in paths)

    @pytest.mark.slow
    def test_parameters_limit_and_an_output_file(self, cli: Cli, loaded: Driver, tmp_path: Path) -> None:
        done = cli("query", "findings", "category=Biometric", "-f", "json")
        assert [row["category"] for row in json.loads(done.stdout)] == ["FaceTemplate"]
        done = cli("query", "findings", "--limit", "2", "-f", "json", "-o", tmp_path / "rows.json")
        assert (done.returncode, done.stdout) == (4, "")  # a program sees that it is cut
        assert lines(done) == ["only the first 2 rows are shown; --limit shows more"]
        assert count(loaded, "(:Finding)") == 3
        assert len(json.loads((tmp_path / "rows.json").read_text())) == 2

    @pytest.mark.usefixtures("loaded")
    def test_cypher_of_your_own(self, cli: Cli, tmp_path: Path) -> None:
        text = "MATCH (n:VoiceLeak {robot: $robot}) RETURN n.name AS name"
        (tmp_path / "mine.cypher").write_text(text)
        for asked in (("--cypher", text), ("--file", tmp_path / "mine.cypher")):
            done = cli("query", *asked, "robot=h1", "-f", "csv")
            assert (done.returncode, done.stdout) == (0, "name\n/uplink\n")
        nobody = "MATCH (n:HealthLeak)-[:CARRIES_HEALTH]->(m) RETURN n.transfer"  # there can be one
        assert cli("query", "--cypher", nobody).stdout == "no rows\n"

    @pytest.mark.usefixtures("loaded")
    def test_names_that_nothing_has_are_errors(self, cli: Cli) -> None:
        """S11: one line for each, with the nearest name."""
        text = "MATCH (n:BiometrcLeak)-[:CARRIES_VIDE0]->(:Storage) RETURN n.nam, n.robot, n.zzzzzz"
        done = cli("query", "--cypher", text)
        assert (done.returncode, done.stdout) == (2, "")
        said = [line.partition(" or ")[0] for line in lines(done)]
        assert said == [
            "nothing has the label 'BiometrcLeak'; did you mean BiometricLeak",
            "nothing has the property 'nam'; did you mean name",
            "nothing has the property 'zzzzzz'; see them with rosprivacy query --schema",
            "nothing has the relationship type 'CARRIES_VIDE0'; did you mean CARRIES_VIDEO",
        ]

    @pytest.mark.parametrize("on_terminal", ["", "1"])
    @pytest.mark.usefixtures("loaded")
    def test_no_path_is_cut(self, cli: Cli, on_terminal: str) -> None:
        """What is too wide for a table is records, wrapped between names."""
        names = [f"/{'namespace/' * 9}node{number}" for number in range(5)]
        text = f"RETURN {names} AS path, 1 AS steps UNION RETURN ['/a'] AS path, 0 AS steps"
        done = cli("query", "--cypher", text, FORCE_COLOR=on_terminal, COLUMNS="60")
        assert done.returncode == 0
        assert " -> ".join(names) in " ".join(done.stdout.split())
        assert "path   /a\n" in done.stdout
        assert "…" not in done.stdout

    @pytest.mark.parametrize("on_terminal", one_in(2, ["", "1"]))
    @pytest.mark.usefixtures("loaded")
    def test_paths_nodes_and_relationships_are_told_in_words(self, cli: Cli, on_terminal: str) -> None:
        """As `analyze` says paths: kinds, verbs, the policy line; an arrow points where the data goes."""
        ends = "({robot: 'h1', name: '/camera'})-[r:FLOWS_TO]->(n:Topic {name: '/camera/image'})"
        text = f"MATCH p = {ends} MATCH back = (n)<-[r]-() RETURN p, back, n, r LIMIT 1"
        done = cli("query", "--cypher", text, FORCE_COLOR=on_terminal, COLUMNS="80")
        said = f"/camera (node) | publishes {POLICY.relative_to(ROOT)}:10 -> /camera/image (topic)"
        back = f"/camera/image (topic) <- publishes {POLICY.relative_to(ROOT)}:10 | /camera (node)"
        assert done.returncode == 0, done.stderr
        words = " ".join(done.stdout.split())
        assert all(cell in words for cell in (said, back, "/camera/image (topic)"))
        row = next(csv.DictReader(io.StringIO(cli("query", "--cypher", text, "-f", "csv").stdout)))
        assert row == {"p": said, "back": back, "n": "/camera/image (topic)", "r": said}
        ((path, node),) = [
            (row["p"], row["n"]) for row in json.loads(cli("query", "--cypher", text, "-f", "json").stdout)
        ]
        assert [path[0]["name"], path[1]["type"], path[1]["role"], path[2]] == ["/camera", "FLOWS_TO", "publish", node]
        assert (node["name"], "Topic" in node["labels"]) == ("/camera/image", True)

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("asked", "title"),
        [
            (("leak-path-graph", "category=Voice"), "leak-path-graph category=Voice"),
            (("--cypher", NAIVE), NAIVE),
            (("--cypher", NAIVE.replace("RETURN p", "RETURN\n nodes(p), [{r: relationships(p)}]")), None),
        ],
        ids=["pack", "cypher", "lists"],
    )
    @pytest.mark.usefixtures("loaded")
    def test_what_a_query_gives_of_the_graph_is_drawn(
        self, cli: Cli, tmp_path: Path, asked: tuple[str, ...], title: str | None
    ) -> None:
        """As `rosprivacy graph` draws: the same looks and legend, the same bytes for the same rows (rule S14)."""
        texts = []
        for file in (tmp_path / "one.svg", tmp_path / "two.svg"):
            done = cli("query", *asked, "-f", "svg", "-o", file)
            assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
            texts.append(file.read_bytes())
        assert texts[0] == texts[1]
        root = etree.fromstring(texts[0])
        drawn = [text for text in root.itertext() if text.strip()]
        words = {"/microphone", "source of Voice", "/audio", "/uplink", "leak of Voice"}
        assert words | {LOOKS["leak"], LOOKS["way"]} <= set(drawn)
        assert not title or title in drawn
        assert f'fill="{looks.RED}"'.encode() in texts[0]

    def test_the_schema_is_told_without_a_database(self, cli: Cli) -> None:
        done = cli("query", "--schema")
        assert done.returncode == 0
        for names in schema_names([]).values():
            assert all(name in done.stdout for name in names)
        assert cli("query", "findings", "--schema").returncode == 2
        assert cli("query", "leak-paths", "--show").stdout == pack()["leak-paths"].text

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (["leak-paths", "-f", "svg"], "leak-paths: gives no node, relationship or path to draw, only robot, cat"),
            (["--cypher", "RETURN 1 AS x, ['a'] AS y", "-f", "svg"], "RETURN path"),
            (
                ["--cypher", "MATCH (n:Element {name: '/nowhere'}) RETURN n", "-f", "svg"],
                "no rows, so nothing ",
            ),
            (["findings", "category=Voice", "category=Video"], "category is given twice"),
            (["findings", "Voice"], "write key=value"),
            (["findings", "category=Vioce"], "no category 'Vioce' is in the database; did you mean Voice"),
            (["leak-paths", "robot=h2"], "no robot 'h2' is in the database; did you mean h1?"),
            (["reach-of-source", "source=/camra"], "no element '/camra' is in the database; did you mean /camera or"),
            (["--file", "not-there.cypher"], "not-there.cypher: cannot be read: No such file or directory"),
            pytest.param(
                ["--cypher", "UNWIND range(1, 1000000000) AS x WITH x WHERE x < 0 RETURN x", "--timeout", "0.2"],
                "0.2 s",
                marks=pytest.mark.slow,
            ),
        ],
        ids=lambda value: " ".join(value[:2]) if isinstance(value, list) else "",
    )
    def test_what_is_wrong_is_2_and_one_line(
        self, cli: Cli, loaded: Driver, tmp_path: Path, arguments: list[str], message: str
    ) -> None:
        done = cli("query", *arguments, "-o", tmp_path / "out")
        assert (done.returncode, done.stdout, len(lines(done))) == (2, "", 1)
        assert message in done.stderr
        assert not (tmp_path / "out").exists()
        assert count(loaded, "(:Finding)") == 3

    @pytest.mark.usefixtures("loaded")
    def test_no_cell_of_csv_is_a_formula(self, cli: Cli, tmp_path: Path) -> None:
        """Names stand in policies of strangers, and people open the rows in a spreadsheet. A number is none."""
        (tmp_path / "mine.cypher").write_text("RETURN '=1+1' AS a, ' @x' AS b, -1 AS c, '-1' AS d, ['+1'] AS `=e`")
        done = cli("query", "--file", tmp_path / "mine.cypher", "-f", "csv")
        assert done.stdout == "a,b,c,d,'=e\n'=1+1,' @x,-1,'-1,'+1\n"


@pytest.mark.database
class TestNoServer:
    COMMANDS = (LOAD, ("unload", "--robot", "h1"), ("query", "robots"), ("analyze", "--from-database"))

    @pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command[0])
    def test_a_server_that_is_not_there_is_3_and_one_line(self, cli: Cli, command: tuple[str, ...]) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            uri = f"bolt://127.0.0.1:{free.getsockname()[1]}"
        done = cli(*command, "--neo4j", uri, NEO4J_PASSWORD="x")  # noqa: S106 - of no server
        assert (done.returncode, done.stdout) == (3, "")
        assert len(lines(done)) == 1
        assert f"{uri}: no Neo4j answers there" in done.stderr

    @pytest.mark.slow
    def test_a_wrong_password_is_3_and_says_where_it_came_from(self, cli: Cli, private_neo4j: Connection) -> None:
        """Again and again too: the server then lets nobody in for some seconds, which pass before other tests go on."""
        for _ in range(5):
            done = cli("query", "robots", "--neo4j", private_neo4j.uri, NEO4J_USERNAME="neo4j", NEO4J_PASSWORD=GUESS)
            assert (done.returncode, done.stdout) == (3, "")
            assert len(lines(done)) == 1
            assert "accepted" in done.stderr
            assert "NEO4J_PASSWORD" in done.stderr
            assert GUESS not in done.stderr
        with pytest.raises(DatabaseError, match="lets nobody in for a while"), connection.open_driver(private_neo4j):
            pass
        time.sleep(LOCKED)
