"""Every command line of the README and of docs/ runs as it stands there; this module has the table of how.

``LINE_BY_LINE`` are pages whose lines run here in their order, in a folder that has what the page names. ``BY_ANOTHER``
names the test of a page that has one of its own, ``BY_CI`` what each run of CI does beside its tests. ``NOT_RUN`` has
the single lines that nothing runs, each with the reason. A page or a line that is in none of these fails.

Servers are real: Neo4j, a cluster of Spark, a router of Zenoh, a DDS domain, the explorer. The only stand-in is the
language model: a server on this machine speaks its protocol and gives a written answer.
"""

from __future__ import annotations

import ast
import re
import shlex
import signal
import socket
import subprocess
from contextlib import contextmanager, nullcontext
from typing import TYPE_CHECKING, NamedTuple
from urllib.request import HTTPCookieProcessor, ProxyHandler, build_opener

import pytest

from tests.helpers import page_folders as folders
from tests.helpers import reference
from tests.helpers.dds_writer import dds_writer
from tests.helpers.docs import blocks, hand_written
from tests.helpers.model_server import ModelServer, answer, elements, said
from tests.helpers.page_folders import environment, shell
from tests.helpers.paths import ROOT
from tests.helpers.spark_cluster import spark_cluster
from tests.helpers.zenoh_tokens import endpoint, node, router, session

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager
    from pathlib import Path

    from rosprivacy.private_neo4j.connection import Connection
    from tests.helpers.model_server import Reply

LayOut = tuple["Callable[[Path], None]", ...]
ANSWERED = (0, 1, 4)  # what an analysis can end with; 2 is an error of what was given, 3 of a server
SECONDS = 120.0  # for a server to start on a loaded machine
IMAGE = "sensor_msgs::msg::dds_::Image_"

LINE_BY_LINE: dict[str, LayOut] = {
    "README": (folders.factory,),
    "annotations": (folders.annotated,),
    "bags": (folders.recorded,),
    "categories": (),
    "changes": (folders.fleet, folders.last_week, folders.checkout),
    "database": (),
    "decisions": (folders.decided,),
    "editors": (folders.project,),
    "edpb": (folders.fleet,),
    "explore": (),
    "first-hour": (folders.begun,),
    "fleets": (folders.fleet,),
    "formats": (),
    "keystores": (folders.deployed,),
    "labels": (folders.checkout,),
    "language-model": (),
    "linked-data": (),
    "lint": (),
    "mitigation": (),
    "observe": (folders.observed,),
    "report": (folders.reported, folders.fleet),
    "scan": (folders.labelled_checkout,),
    "suggestions": (folders.suggested, folders.typed),
    "types": (folders.typed,),
    "views": (folders.factory,),
}
BY_ANOTHER = {
    "case-studies": "tests/test_case_studies.py::test_a_reader_gets_from_nothing_to_the_report",
    "paper": "tests/test_paper.py::test_of_the_factory",
    "what-it-finds": "tests/test_docs.py::test_what_it_finds_is_what_its_commands_print",
}
BY_CI = {  # line -> what .ci/run does of it
    ("README", "make demo"): "make demo",
    ("README", "pip install -e '.[local]'"): "make .venv/installed-dev EXTRAS=dev",
    ("performance", "python benchmarks/all.py --counts"): 'benchmarks/all.py "$form"',
    ("performance", "python benchmarks/all.py --quick"): "form=--quick",
}
OBSERVE_TEXT = "(ros2 node list -a; for n in $(ros2 node list -a); do ros2 node info --include-hidden $n; done)"
HOURS = "takes two hours, and writes over what the checkout keeps"
TIMED = "measures times, which says nothing beside tests; tests/test_benchmarks.py runs the program"
NOT_RUN = {
    ("README", "git clone https://github.com/OWNER/rosprivacy && cd rosprivacy"): "has no address before the release",
    ("observe", f"{OBSERVE_TEXT} > graph.txt 2>&1"): "asks ROS 2 that runs",
    ("performance", "python benchmarks/all.py"): TIMED,
    ("performance", "python benchmarks/all.py turtlebot reading"): TIMED,
    ("security", "make fuzz HOURS=2 FOLDER=~/fuzz"): HOURS,
    ("security", "python -m tests.fuzzing keep --folder ~/fuzz"): HOURS,
    ("security", "cp ~/fuzz/record.json tests/fuzzing/ && python -m tests.test_docs"): HOURS,
}
NOT_HERE = BY_CI.keys() | NOT_RUN.keys()


class PageLine(NamedTuple):
    """A command line of a page, without the comment behind it."""

    page: str
    text: str


def page_file(page: str) -> Path:
    return ROOT / f"{page}.md" if page == "README" else ROOT / "docs" / f"{page}.md"


def lines(page: str) -> list[PageLine]:
    """The command lines of a page: those of its blocks, then those in its text that are whole."""
    shown = [line for block in blocks(page_file(page), "console") for line in block.replace("\\\n", " ").splitlines()]
    text = re.sub(r"```.*?```", "", hand_written(page_file(page).read_text("utf-8")), flags=re.DOTALL)
    whole = [line for line in re.findall(r"`(rosprivacy [^`]+)`", text) if is_whole(line)]
    return [PageLine(page, re.sub(r"\s+# .*", "", line)) for line in [*shown, *whole]]


def is_whole(text: str) -> bool:
    """Whether a command in a text is one to type: it has more than its name, and nothing is left to fill in.

    >>> is_whole("rosprivacy law --check"), is_whole("rosprivacy law"), is_whole("rosprivacy show ID")
    (True, False, False)
    """
    words, inner = shlex.split(text)[1:], reference.command_group()
    while words and words[0] in inner:
        command, *words = inner[words[0]], *words[1:]
        inner = getattr(command, "commands", {})
    return bool(words) and not any(re.search(r"…|^[A-Z]{2,}$|=value", word) for word in words)


PAGES = ["README", *sorted(page.stem for page in (ROOT / "docs").glob("*.md"))]
STORED = re.compile(r"^rosprivacy (load|unload|query|db)\b|--load\b|--from-database\b")
IN_NEO4J = [page for page in LINE_BY_LINE if any(STORED.search(line.text) for line in lines(page))]


def model(body: bytes) -> Reply:
    """What the stand-in of a language model says of any request: the first element lets video out."""
    first = elements(body)[0]
    return said(answer(first["id"], "leak", "Video", first["name"]))


@contextmanager
def running_robots(folder: Path) -> Iterator[None]:
    """A router where rmw_zenoh has it, and behind it a camera in domain 3; a writer in DDS domain 0. Both are seen."""
    with router(where="tcp/127.0.0.1:7447") as where, session(where) as one, dds_writer(0, "rt/speech"):
        tokens = [node(3, "camera"), endpoint(3, "MP", "camera", "/image", IMAGE)]
        kept = [one.liveliness().declare_token(token) for token in tokens]
        yield
        assert kept
    for policy, topic in (("monday", "image"), ("week", "speech")):
        assert f"<topic>/{topic}</topic>" in (folder / f"{policy}.policy.xml").read_text("utf-8")


def beside(page: str, folder: Path) -> AbstractContextManager[object]:
    """What runs while the lines of a page do, at the addresses that the page names."""
    if page == "language-model":
        return ModelServer(model, port=free(11434))
    if page == "observe":
        pytest.importorskip("cyclonedds", reason="there is none for this Python or this machine")
        free(7447)
        return running_robots(folder)
    if page == "explore":
        free(8700)
    if page == "fleets":
        pytest.importorskip("pyspark", reason="without the [spark] extra")
        (folder / "spark").mkdir()
        return spark_cluster(folder / "spark", "localhost", free(7077))
    return nullcontext()


def free(port: int) -> int:
    """A port that a page names; the test of that page cannot run where another program listens there."""
    with socket.socket() as tried:
        if tried.connect_ex(("127.0.0.1", port)) == 0:
            pytest.skip(f"PORT {port} IS TAKEN: the page that names it did not run")
    return port


def run(line: PageLine, folder: Path) -> None:
    """Run a line; it ends as an answer does."""
    if line.text.startswith("rosprivacy explore"):
        opened_and_closed(line, folder)
        return
    done = shell(line.text, folder)
    assert done.returncode in ANSWERED, (line, done.stdout[-1000:], done.stderr[-3000:])
    for name in re.findall(r" (?:-o|--output|--tables|--record|--results) (\S+)", line.text):
        assert (folder / name).exists(), (line, done.stderr)


def opened_and_closed(line: PageLine, folder: Path) -> None:
    """Run a line that serves a page: the link that it prints opens it, and Ctrl+C ends the program."""
    with subprocess.Popen(
        ["bash", "-c", f"exec {line.text}"], cwd=folder, env=environment(folder, PYTHONUNBUFFERED="1"),
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    ) as process:  # fmt: skip
        assert process.stdout
        link = re.search(r"(http://127\.0\.0\.1:\d+/)enter\?token=\S+", process.stdout.readline())
        try:
            assert link, line
            browser = build_opener(ProxyHandler({}), HTTPCookieProcessor())
            browser.open(link[0]).close()
            with browser.open(link[1]) as page:
                assert b"</main>" in page.read(), line
        finally:
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=SECONDS)
    assert process.returncode == 0, (line, errors)


def ran(page: str, folder: Path) -> None:
    """Run what a page shows, in a folder that is laid out for it."""
    folders.system(folder)
    for lay_out in LINE_BY_LINE[page]:
        lay_out(folder)
    to_run = [line for line in lines(page) if line not in NOT_HERE]
    assert to_run
    with beside(page, folder):
        for line in to_run:
            run(line, folder)


@pytest.mark.slow
@pytest.mark.parametrize("page", [page for page in LINE_BY_LINE if page not in IN_NEO4J])
def test_a_page_runs(page: str, tmp_path: Path) -> None:
    ran(page, tmp_path)


@pytest.mark.slow
@pytest.mark.database
@pytest.mark.parametrize("page", IN_NEO4J)
def test_a_page_runs_with_a_database(page: str, tmp_path: Path, private_neo4j: Connection) -> None:
    assert private_neo4j
    ran(page, tmp_path)


def test_every_page_with_commands_is_in_the_table() -> None:
    shown = {page for page in PAGES if any(line not in NOT_HERE for line in lines(page))}
    assert shown == LINE_BY_LINE.keys() | BY_ANOTHER.keys()
    assert not LINE_BY_LINE.keys() & BY_ANOTHER.keys()


def test_every_line_that_does_not_run_here_stands_on_its_page() -> None:
    assert {line for page in PAGES for line in lines(page)} >= NOT_HERE


def test_ci_does_what_the_table_says() -> None:
    done = (ROOT / ".ci" / "run").read_text("utf-8")
    assert [line for line, words in BY_CI.items() if words not in done] == []


@pytest.mark.parametrize("page", BY_ANOTHER)
def test_the_test_of_a_page_is_there_and_reads_the_page(page: str) -> None:
    file, _, name = BY_ANOTHER[page].partition("::")
    text = (ROOT / file).read_text("utf-8")
    assert name in {one.name for one in ast.parse(text).body if isinstance(one, ast.FunctionDef)}
    text += (ROOT / "tests" / "helpers" / "typist.py").read_text("utf-8")  # of the case studies
    assert f'"{page}.md"' in text


def test_commands_stand_where_they_are_seen() -> None:
    """In blocks of ``console``, not of a shell or of no language."""
    for page in PAGES:
        found = re.findall(r"^```(\w*)\n(.*?)^```", page_file(page).read_text("utf-8"), re.MULTILINE | re.DOTALL)
        for language, block in found:
            commands = re.search(r"^(\$ )?(rosprivacy|make|pip|python|git|docker) ", block, re.MULTILINE)
            assert language == "console" or not commands, (page, block)
