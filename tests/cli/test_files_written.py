"""No output over an input: whatever a run has read, by whatever name, is there afterwards byte for byte."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import unicodedata
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING

import pytest
import yaml

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.files_read import noted, one_run, read_as
from rosprivacy.ingest.labels.label_file import shipped_text
from rosprivacy.private_neo4j.state import write_private
from rosprivacy.report.atomic import check_outputs, write_texts
from tests.helpers.command import XI, Cli, refused, run
from tests.helpers.docs import CATEGORIES, blocks
from tests.helpers.factory import BEFORE, RUN3
from tests.helpers.policies import everything

if TYPE_CHECKING:
    from collections.abc import Callable

POLICY = f"""\
<policy version="0.2.0" {XI}><enclaves><enclave path="/e"><profiles>
  <profile ns="/" node="camera"><topics publish="ALLOW"><topic>video</topic></topics></profile>
  <profile ns="/" node="cloud"><topics subscribe="ALLOW"><topic>video</topic></topics></profile>
  <xi:include href="sub/part.xml"/>
</profiles></enclave></enclaves></policy>
"""
PART = '<profile ns="/" node="map"><topics publish="ALLOW"><topic>map</topic></topics></profile>\n'
FRAGMENT = '<package format="3"><name>not a policy, but read to tell so</name></package>\n'
LABELS = "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /cloud: {leak: [Video]}\n"
SIX = {"source": ["/camera"], "leak": ["/cloud"], "conduit": ["/map"], "sanitizer": [], "sensitive": [], "mundane": []}
DECISIONS = "decisions: 1\nfindings: []\n"
FLEET = "fleet: 1\nname: f\ninclude: [more.yaml]\nrobots:\n  a: {policies: [p.xml], labels: [l.yaml]}\n"
MORE = "fleet: 1\nrobots:\n  b: {policies: [q.xml], labels: [own.yaml]}\n"

OF_THE_FLEET = "f.yaml more.yaml p.xml q.xml l.yaml own.yaml"
RUNS = {  # a command, its options of outputs, what it reads
    "analyze": (
        "analyze p.xml -l l.yaml --decisions d.yaml --standard-channels s.yaml --add g.json", "-o --save-graph",
        "p.xml sub/part.xml l.yaml d.yaml s.yaml g.json",
    ),
    "analyze a folder": (
        "analyze . -l l.yaml -f sarif", "-o", "p.xml q.xml sub/part.xml package.xml l.yaml",
    ),
    "analyze six lists": ("analyze p.xml -l six.json", "-o", "p.xml sub/part.xml six.json"),
    "analyze a fleet": ("analyze --fleet f.yaml -f json", "-o", f"sub/part.xml {OF_THE_FLEET}"),
    "report": (
        "report p.xml -l l.yaml --since old.json -f markdown", "-o", "p.xml sub/part.xml l.yaml old.json",
    ),
    "report on a fleet": (
        "report --fleet f.yaml --decisions d.yaml -f article30", "-o", f"sub/part.xml d.yaml {OF_THE_FLEET}",
    ),
    "graph": ("graph p.xml -l l.yaml -f dot", "-o", "p.xml sub/part.xml l.yaml"),
    "mitigate": (
        "mitigate p.xml -l l.yaml --limits limits.yaml --by deny", "-o --patch",
        "p.xml sub/part.xml l.yaml limits.yaml",
    ),
    "diff a policy and a graph": (
        "diff g.json p.xml -l l.yaml --old-labels own.yaml", "-o", "p.xml sub/part.xml g.json l.yaml own.yaml",
    ),
    "diff an analysis and a fleet": ("diff old.json f.yaml", "-o", f"old.json sub/part.xml {OF_THE_FLEET}"),
    "fleet": ("fleet f.yaml", "-o", OF_THE_FLEET),
    "labels": ("labels --init p.xml --standard-channels s.yaml", "-o", "p.xml sub/part.xml s.yaml"),
}  # fmt: skip
# Looked at for what they are, and passed over: no input, so that a second run may write over the first one's output.
PASSED_OVER = {
    "analyze a folder": {"d.yaml", "f.yaml", "g.json", "limits.yaml", "more.yaml", "old.json"}
    | {"own.yaml", "s.yaml", "six.json"},
}
EVERYDAY = ("analyze", "report on a fleet")
OPENED = """
import os, sys
seen, folder = set(), os.getcwd() + os.sep
def hook(event, arguments):
    if event == "open" and isinstance(arguments[0], (str, bytes)):
        seen.add(os.path.realpath(os.fsdecode(arguments[0])))
sys.addaudithook(hook)
sys.argv[0] = "rosprivacy"
from rosprivacy.cli.app import main
try:
    main()
finally:
    print(*sorted(name.removeprefix(folder) for name in seen if name.startswith(folder)), sep="\\n", file=sys.stderr)
"""


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Every kind of input, each small."""
    home = tmp_path_factory.mktemp("inputs") / "home"  # its package.xml is beside no folder of another test
    (home / "sub").mkdir(parents=True)
    texts = {
        "p.xml": POLICY, "q.xml": POLICY.replace("camera", "camera_2"), "sub/part.xml": PART, "package.xml": FRAGMENT,
        "l.yaml": LABELS, "own.yaml": LABELS.replace("camera", "camera_2"), "six.json": json.dumps(SIX),
        "s.yaml": shipped_text("standard"), "d.yaml": DECISIONS, "f.yaml": FLEET, "more.yaml": MORE,
        "limits.yaml": "limits: 1\ntime_critical: [/map]\n",
    }  # fmt: skip
    for name, text in texts.items():
        (home / name).write_text(text)
    done = run("analyze", "q.xml", "-l", "own.yaml", "-f", "json", "-o", "old.json", "--save-graph", "g.json", cwd=home)
    assert (done.returncode, done.stderr) == (1, "")
    return home


@pytest.fixture
def folder(inputs: Path, tmp_path: Path) -> Path:
    return shutil.copytree(inputs, tmp_path / "home")


@pytest.mark.parametrize(
    "name", [name if name in EVERYDAY else pytest.param(name, marks=pytest.mark.slow) for name in RUNS]
)
def test_what_a_command_reads_it_does_not_write(cli: Cli, folder: Path, name: str) -> None:
    """The system says which files are opened; no output goes over one of them, and none is changed."""
    command, options, reads = (text.split() for text in RUNS[name])
    code = [sys.executable, "-c", OPENED, *command]
    done = subprocess.run(code, cwd=folder, capture_output=True, text=True, timeout=60, check=False)
    opened = set(done.stderr.splitlines()) & {str(file.relative_to(folder)) for file in folder.rglob("*.*")}
    assert opened == {*reads, *PASSED_OVER.get(name, ())}, done.stderr
    before = everything(folder)
    for file, option in {*((file, options[0]) for file in reads), *((min(reads), option) for option in options)}:
        (line,) = refused(cli(*command, option, file, cwd=folder))
        assert line.startswith(f"{file}: is {'there already' if name == 'labels' else 'read in this run'}; "), line
        assert everything(folder) == before
    done = cli(*command, *(part for option in options for part in (option, f"new{option}.txt")), cwd=folder)
    assert done.returncode in (0, 1), done.stderr  # and what was not read is written
    assert everything(folder).keys() >= before.keys() | {"new-o.txt"}
    assert cli(*command, "-o", "new-o.txt", cwd=folder).returncode == (2 if name == "labels" else done.returncode)


@pytest.mark.slow
def test_an_ontology_that_is_read_is_not_written(cli: Cli, tmp_path: Path) -> None:
    (text,) = blocks(CATEGORIES, "turtle")
    (tmp_path / "o.ttl").write_text(text)
    for command in (["categories"], ["analyze", BEFORE]):  # the second time it comes from the cache
        (line,) = refused(cli(*command, "--ontology", "o.ttl", "-o", "./o.ttl", cwd=tmp_path))
        assert line.startswith("o.ttl: is read in this run; "), line
    assert (tmp_path / "o.ttl").read_text() == text


OTHER_NAMES: dict[str, Callable[[Path], str | Path]] = {
    "a link": lambda folder: linked(folder, "link", "p.xml"),
    "a link to a link": lambda folder: linked(folder, "second", linked(folder, "link", "p.xml")),
    "in a linked folder": lambda folder: linked(folder, "other", folder) / "p.xml",
    "a hard link": lambda folder: hard_link(folder, "hard"),
    "upper case": lambda folder: hard_link(folder, "P.XML"),  # as where a file system does not tell case apart
    "relative": lambda folder: f"sub/../../{folder.name}/./p.xml",
    "absolute": lambda folder: folder / "p.xml",
}


def linked(folder: Path, name: str, target: str | Path) -> Path:
    (folder / name).symlink_to(target)
    return Path(name)


def hard_link(folder: Path, name: str) -> str:
    (folder / name).hardlink_to(folder / "p.xml")
    return name


@pytest.mark.parametrize("name", OTHER_NAMES)
@pytest.mark.parametrize("read", ["p.xml", "the other name"])
def test_another_name_of_an_input_is_the_input(cli: Cli, folder: Path, name: str, read: str) -> None:
    other = OTHER_NAMES[name](folder)
    (policy, output) = ("p.xml", other) if read == "p.xml" else (other, "p.xml")
    before = everything(folder)
    for option in ("-o", "--save-graph"):
        options = ("--include-root", folder, "-l", "l.yaml", "-q", option, output)
        (line,) = refused(cli("analyze", policy, *options, cwd=folder))
        assert f"is the same file as {policy}, which is read in this run; name another file to write to" in line
    assert everything(folder) == before


def test_an_input_that_is_replaced_meanwhile_is_one_still(tmp_path: Path) -> None:
    """As editors save: another inode under the name; what was just saved is not lost."""
    file = tmp_path / "p.xml"
    file.write_text("old")
    with one_run():
        with file.open("rb") as opened:
            noted(opened, str(file))
        (tmp_path / "new").write_text("saved meanwhile")
        (tmp_path / "new").replace(file)
        with pytest.raises(InputErrors, match="is read in this run"):
            write_texts([(file, "report")])
    assert file.read_text() == "saved meanwhile"


@pytest.mark.parametrize(
    ("output", "options", "message"),
    [
        ("p.xml", [], "is the same file as p.xml"),  # analyze p.xml >> p.xml
        pytest.param("p.xml", ["-o", "/dev/stdout"], "is the same file as p.xml", marks=pytest.mark.slow),
        pytest.param("p.xml", ["-o", "/proc/self/fd/1"], "is the same file as p.xml", marks=pytest.mark.slow),
        ("new.json", ["--save-graph", "new.json"], "is named for two outputs"),  # --save-graph new.json > new.json
    ],
)
def test_standard_output_is_an_output_too(folder: Path, output: str, options: list[str], message: str) -> None:
    (folder / "new.json").touch()
    before = everything(folder)
    command = [sys.executable, "-m", "rosprivacy", "analyze", "p.xml", "-l", "l.yaml", *options]
    with (folder / output).open("ab") as file:
        done = subprocess.run(command, cwd=folder, stdout=file, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, message in done.stderr) == (2, True), done.stderr
    assert everything(folder) == before


# ---------------------------------------------------------------- two outputs


def test_two_outputs_on_one_file_are_refused(cli: Cli, folder: Path) -> None:
    (folder / "there").write_text("kept")
    (folder / "same").hardlink_to(folder / "there")
    (folder / "nowhere").symlink_to("x.json")
    before = everything(folder)
    pairs: list[tuple[str | Path, str | Path]] = [
        ("x.json", "x.json"), ("x.json", "./x.json"), ("x.json", "sub/../x.json"), ("x.json", folder / "x.json"),
        ("x.json", "nowhere"), ("there", "same"), ("x.json", "X.json"),
        (unicodedata.normalize("NFC", "é.json"), unicodedata.normalize("NFD", "é.json")),
    ]  # fmt: skip
    for first, second in pairs:
        (line,) = refused(cli("analyze", "p.xml", "--save-graph", first, "-o", second, cwd=folder))
        assert "is named for two outputs" in line
    command = ("mitigate", "p.xml", "-l", "l.yaml", "--by", "deny")
    assert "is named for two outputs" in refused(cli(*command, "--patch", "x", "-o", "x", cwd=folder))[0]
    spark = ("analyze", "--fleet", "f.yaml", "--engine", "spark", "--results", "out", "-o", "./out")
    assert "is named for two outputs" in refused(cli(*spark, cwd=folder))[0]
    assert everything(folder) == before
    no_file = ("--save-graph", "/dev/null", "-o", "/dev/null")
    assert cli("analyze", "p.xml", *no_file, cwd=folder).returncode == 4


# ---------------------------------------------------------------- what is meant to be written


def test_with_nothing_to_patch_the_file_is_left_as_it_is(cli: Cli, folder: Path) -> None:
    (folder / "clean.yaml").write_text("labels: 1\nnodes:\n  /camera: {source: [Video]}\n")
    (folder / "fix.diff").write_text("of an earlier run")
    before = everything(folder)
    for name in ("fix.diff", "new.diff"):
        done = cli("mitigate", "p.xml", "-l", "clean.yaml", "--patch", name, cwd=folder)
        assert (done.returncode, done.stderr) == (
            0, f"{name}: left as it is: there is no patch; the answer says why\n",
        )  # fmt: skip
    (line,) = refused(cli("mitigate", "p.xml", "-l", "clean.yaml", "--patch", "p.xml", cwd=folder))
    assert line.startswith("p.xml: is read in this run")
    assert everything(folder) == before


@pytest.mark.parametrize("name", ["d.yaml", "link.yaml", "./sub/../d.yaml"])
def test_decide_edits_the_decisions_that_it_reads(cli: Cli, folder: Path, name: str) -> None:
    """The one input that is meant to be written; through a link the file behind it."""
    (folder / "link.yaml").symlink_to("d.yaml")
    before = everything(folder)
    (finding,) = json.loads(before["old.json"])["findings"]
    done = cli("decide", "avoid", finding["id"], "--report", "old.json", "--decisions", name, cwd=folder)
    assert done.returncode == 0, done.stderr
    after = everything(folder)
    assert [entry["id"] for entry in yaml.safe_load(after["d.yaml"])["findings"]] == [finding["id"]]
    assert {**after, "d.yaml": b"", "link.yaml": b""} == {**before, "d.yaml": b"", "link.yaml": b""}
    assert (folder / "link.yaml").is_symlink()


@pytest.mark.parametrize("decisions", ["old.json", "hard.json", "l.yaml", "g.json"])
def test_decide_edits_nothing_else(cli: Cli, folder: Path, decisions: str) -> None:
    (folder / "hard.json").hardlink_to(folder / "old.json")
    before = everything(folder)
    for finding in (["0" * 16], ["--category", "Video", "--report", "old.json"]):
        refused(cli("decide", "avoid", *finding, "--decisions", decisions, cwd=folder))
    assert everything(folder) == before


@pytest.mark.parametrize("write", [lambda file: write_texts([(file, "new")]), lambda file: write_private(file, "new")])
def test_a_file_is_on_the_disk_before_it_takes_the_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, write: Callable[[Path], None]
) -> None:
    file = tmp_path / "r.txt"
    file.write_text("old")
    seen, fsync = [], os.fsync

    def watched(handle: int) -> None:
        seen.append((os.fstat(handle).st_ino, file.read_text()))
        fsync(handle)

    monkeypatch.setattr(os, "fsync", watched)
    write(file)
    assert seen == [(file.stat().st_ino, "old"), (tmp_path.stat().st_ino, "new")]


# ---------------------------------------------------------------- how long it is remembered


def test_what_an_earlier_run_has_read_may_be_written(cli: Cli, folder: Path) -> None:
    """Runs in one process: what the first has read, whether it ended well or not, is no input of the second."""
    saved = ("analyze", "p.xml", "-l", "l.yaml", "-f", "json", "-o", "old.json")
    assert cli("diff", "old.json", "p.xml", "-l", "l.yaml", cwd=folder).returncode in (0, 1)
    assert cli(*saved, cwd=folder).returncode == 1
    refused(cli("diff", "old.json", "none.xml", cwd=folder))
    assert cli(*saved, cwd=folder).returncode == 1
    assert cli("analyze", "q.xml", "-o", "p.xml", "-q", cwd=folder).returncode == 4


def test_the_library_keeps_no_notes(folder: Path) -> None:
    """Many analyses in one process; what the program does with its files is its own affair."""
    file = folder / "p.xml"
    for _ in range(2):
        assert rosprivacy.analyze([str(file)], [str(folder / "l.yaml")]).analysis.verdict == "leak"
        assert read_as(str(file), file.stat()) is None
        write_texts([(file, file.read_bytes())])
    rosprivacy.analyze_fleet(str(folder / "f.yaml"))
    write_texts([(file, "mine")])
    assert file.read_text() == "mine"


def test_a_run_in_a_run_and_one_in_a_thread_have_notes_of_their_own(folder: Path) -> None:
    p, q = folder / "p.xml", folder / "q.xml"

    def read(file: Path) -> None:
        rosprivacy.analyze([str(file)])

    def known() -> list[bool]:
        return [read_as(str(file), file.stat()) is not None for file in (p, q)]

    with one_run():
        read(p)
        with one_run():
            read(q)
            assert known() == [False, True]
        assert known() == [True, False]
        others: list[list[bool]] = []

        def elsewhere() -> None:
            read(q)
            others.append(known())

        thread = Thread(target=elsewhere)
        thread.start()
        thread.join()
        assert others == [[False, False]]
        with pytest.raises(InputErrors):
            check_outputs([p])
    assert known() == [False, False]


def test_equal_files_of_robots_are_inputs_in_each_run_anew(cli: Cli, folder: Path) -> None:
    """Of robots that are alike one is read whole; of the other the content is compared, and that is reading too."""
    (folder / "part").mkdir()
    for name in ("same.xml", "copy.xml"):
        shutil.copy(BEFORE, folder / "part" / name)
    shutil.copy(RUN3, folder / "part" / "l.yaml")
    robots = "".join(f"  {n}: {{policies: [{n}.xml], labels: [l.yaml]}}\n" for n in ("same", "copy"))
    (folder / "part" / "f.yaml").write_text(f"fleet: 1\nrobots:\n{robots}")
    before = everything(folder)
    for _ in range(2):
        for name in ("same.xml", "copy.xml"):
            refused(cli("analyze", "--fleet", "part/f.yaml", "-o", f"part/{name}", cwd=folder))
    assert everything(folder) == before
