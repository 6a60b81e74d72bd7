"""The command line as people and CI call it: arguments, two streams and an exit code."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from jsonschema import Draft202012Validator

import rosprivacy
from rosprivacy.cli.app import main
from rosprivacy.ingest.labels.label_file import read_labels, shipped_text
from rosprivacy.ingest.policies.policy_files import read_policies
from rosprivacy.ingest.policies.saved_graph import as_dict
from rosprivacy.ontology.vocabulary import load
from tests.helpers.command import XI, Cli, refused, run

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

ESCAPE = "\x1b"


def document(cli: Cli, *arguments: str | Path, cwd: Path | None = None) -> Any:
    return json.loads(cli("analyze", *arguments, "--format", "json", cwd=cwd).stdout)


@pytest.fixture
def before(examples: Path) -> Path:
    return examples / "factory" / "before.policy.xml"


@pytest.fixture
def after(examples: Path) -> Path:
    return examples / "factory" / "after.policy.xml"


@pytest.fixture
def runs(examples: Path) -> list[Path]:
    return sorted((examples / "factory").glob("run*.labels.yaml"))


# ---------------------------------------------------------------- version, help, completion


def test_version() -> None:
    done = run("--version")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"rosprivacy {rosprivacy.__version__}\n", "")


OPTIONS = {
    "analyze": (
        "--labels", "--add", "--save-graph", "--format", "--output", "--categories", "--category", "--view", "--paths",
        "--max-paths", "--standard-channels", "--no-standard-channels", "--fail-on", "--include-root", "--max-bytes",
        "--decisions",
        "--quiet", "--verbose", "--help", "-l", "-f", "-o", "-c", "-q", "-v", "-h",
    ),
    "decide": (
        "--decisions", "--report", "--reason", "--owner", "--legal-basis", "--expires", "--ticket", "--category",
        "--source", "--leak", "--robot", "--ontology", "--help",
    ),
    "mitigate": (
        "--labels", "--add", "--ontology", "--limits", "--by", "--patch", "--format", "--output", "--categories",
        "--category", "--decisions",
        "--view", "--standard-channels", "--no-standard-channels", "--include-root", "--max-bytes", "--help",
    ),
    "labels": (
        "--add", "--ontology", "--view", "--init", "--schema", "--standard", "--infrastructure", "--output",
        "--standard-channels", "--no-standard-channels", "--include-root", "--max-bytes", "--help",
    ),
}  # fmt: skip


@pytest.mark.parametrize("flag", ["--help", "-h"])
def test_help_lists_the_commands(flag: str) -> None:
    done = run(flag)
    assert (done.returncode, done.stderr) == (0, "")
    assert {"analyze", "labels", "--version"} <= set(done.stdout.split())


@pytest.mark.parametrize("command", sorted(OPTIONS))
def test_help_lists_each_option(cli: Cli, command: str) -> None:
    done = cli(command, "--help")
    assert (done.returncode, done.stderr) == (0, "")
    assert set(OPTIONS[command]) <= set(done.stdout.split())
    assert ESCAPE not in done.stdout


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (["rosprivacy", "l"], {"labels", "load"}),
        (["rosprivacy", "analyze", "--fail"], {"--fail-on"}),
        (["rosprivacy", "analyze", "--view", ""], {"declared", "enforced"}),
        (["rosprivacy", "analyze", "--format", "j"], {"json", "json-ld"}),
        (["rosprivacy", "analyze", "--categories", "Vo"], {"Voice", "VoiceCommand", "VoicePrint"}),
        (["rosprivacy", "analyze", "--category", "Vid"], {"Video"}),
    ],
)
def test_the_shell_completes(words: Sequence[str], wanted: set[str]) -> None:
    program = Path(sys.executable).with_name("rosprivacy")
    variables = {
        "_ROSPRIVACY_COMPLETE": "complete_bash",
        "COMP_WORDS": " ".join(words),
        "COMP_CWORD": str(len(words) - 1),
    }
    done = subprocess.run(
        [program], capture_output=True, text=True, env=os.environ | variables, timeout=60, check=False
    )
    assert done.stderr == ""
    assert set(done.stdout.split()) == wanted


# ---------------------------------------------------------------- exit codes


@pytest.mark.parametrize(
    ("policy", "labels", "verdict"),
    [
        ("before", 1, "undetermined"),  # S12: no finding, but open elements
        ("before", 2, "leak"),
        ("before", 3, "leak"),
        ("after", 4, "leak"),  # the request to save footage carries it
        ("after", 5, "no-leak-found"),
    ],
)
@pytest.mark.parametrize(
    ("fail_on", "codes"),
    [
        (None, {"leak": 1, "undetermined": 4, "no-leak-found": 0}),
        ("undetermined", {"leak": 1, "undetermined": 4, "no-leak-found": 0}),
        ("undecided", {"leak": 1, "undetermined": 4, "no-leak-found": 0}),
        ("leak", {"leak": 1, "undetermined": 0, "no-leak-found": 0}),  # a source is named: data was followed
        ("never", {"leak": 0, "undetermined": 0, "no-leak-found": 0}),
    ],
)
def test_the_exit_code_is_the_verdict(
    cli: Cli,
    before: Path,
    after: Path,
    runs: list[Path],
    policy: str,
    labels: int,
    verdict: str,
    fail_on: str | None,
    codes: dict[str, int],
) -> None:
    chosen = ["--fail-on", fail_on] if fail_on else []
    done = cli("analyze", {"before": before, "after": after}[policy], "-l", runs[labels - 1], "-q", *chosen)
    assert (done.stdout.split(":")[0], done.returncode, done.stderr) == (verdict, codes[verdict], "")


NOTHING_SAID = "labels: 1\nnodes:\n  /robot_camera:\nchannels:\n  /robot_video: mundane\n"


@pytest.mark.parametrize("labels", [None, "", "labels: 1\n", NOTHING_SAID, "rosprivacy:infrastructure"])
@pytest.mark.parametrize(("fail_on", "code"), [(None, 4), ("leak", 4), ("undetermined", 4), ("undecided", 4)])
def test_where_no_source_is_named_no_build_is_green(
    cli: Cli, before: Path, tmp_path: Path, labels: str | None, fail_on: str | None, code: int
) -> None:
    """S11, S12, the table of exit codes: nothing was looked at, whatever the build fails on."""
    if labels == "":
        labels = cli("labels", "--init", before).stdout  # the template, untouched
    file = labels if labels is None or labels.startswith("rosprivacy:") else tmp_path / "l.yaml"
    if isinstance(file, Path):
        file.write_text(labels or "", "utf-8")
    done = cli("analyze", before, *(["-l", str(file)] if file else []), *(["--fail-on", fail_on] if fail_on else []))
    assert (done.stdout.partition(":")[0], done.returncode) == ("undetermined", code)
    step = done.stdout.splitlines()[-1]
    assert step.startswith("Next: name a source in a label file, such as nodes: {/camera: {source: [Video]}}; ")
    assert "candidates by name: /robot_camera, /safety_camera" in step


def test_where_no_source_of_what_is_asked_is_named_no_build_is_green(cli: Cli, before: Path, runs: list[Path]) -> None:
    done = cli("analyze", before, "-l", runs[0], "-c", "Voice", "--fail-on", "leak")
    assert done.returncode == 4
    assert done.stdout.splitlines()[-1].endswith("only Voice was asked for")


def test_the_next_step_stands_last(cli: Cli, before: Path, after: Path, runs: list[Path]) -> None:
    last = [cli("analyze", before, "-l", labels).stdout.splitlines()[-1] for labels in runs[:2]]
    assert last[0] == "Next: review /archive_server and 10 more, say it in a label file, repeat"
    assert last[1].startswith("Next: decide about each finding (rosprivacy decide)")
    assert "Next:" not in cli("analyze", after, "-l", runs[4]).stdout


@pytest.mark.parametrize(
    ("word", "instead"),
    [
        ("off", "write never"),
        ("todo", "write leak"),
        ("all", "leave out --decisions"),
        ("Undetermined", "did you mean undetermined"),
        ("nope", "one of undetermined, leak, undecided, never"),
    ],
)
def test_a_word_that_fail_on_does_not_know_is_told_which_to_write(cli: Cli, word: str, instead: str) -> None:
    done = cli("analyze", "p.xml", "--fail-on", word)
    assert (done.returncode, done.stdout) == (2, "")
    assert instead in " ".join(done.stderr.replace("│", "").split())


def test_an_error_of_our_own_is_no_finding(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], before: Path
) -> None:
    """Exit code 1 says 'leak'; a defect of the program is none. A defect is made here, since none is known."""

    def defect(*_: object) -> int:
        raise ZeroDivisionError

    monkeypatch.setattr("rosprivacy.cli.analyze.exit_code", defect)
    monkeypatch.setattr(sys, "argv", ["rosprivacy", "analyze", str(before)])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 70
    assert "ZeroDivisionError" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        ["analyse"],
        ["analyze"],
        ["analyze", "p.xml", "--nope"],
        ["analyze", "p.xml", "--view", "real"],
        ["analyze", "p.xml", "--max-paths", "0"],
        ["analyze", "p.xml", "--max-bytes", "x"],
        ["analyze", "p.xml", "--fail-on", "always"],
        ["labels"],
        ["labels", "p.xml"],
        ["labels", "--init"],
        ["labels", "p.xml", "--init", "--schema"],
    ],
)
def test_wrong_usage_is_2_with_a_word_on_standard_error(cli: Cli, arguments: list[str]) -> None:
    done = cli(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert "Usage:" in done.stderr
    assert "Traceback" not in done.stderr


# ---------------------------------------------------------------- reports


def test_the_text_report_names_verdict_way_and_policy_lines(cli: Cli, before: Path, runs: list[Path]) -> None:
    done = cli("analyze", before, "--labels", runs[1])
    assert done.stdout.startswith("leak: ")
    for said in ("/safety_camera", "/archive_server", "  before.policy.xml:54", "Review next", "Assumed", str(runs[1])):
        assert said in done.stdout
    assert done.stderr == ""


def test_quiet_prints_the_verdict_only(cli: Cli, before: Path, runs: list[Path]) -> None:
    done = cli("analyze", before, "--labels", runs[1], "--quiet")
    assert len(done.stdout.splitlines()) == 1


def test_verbose_prints_what_the_report_leaves_out(cli: Cli, tmp_path: Path) -> None:
    old = '<policy version="0.1.0"><profiles><profile ns="/" node="a"/></profiles></policy>'
    (tmp_path / "p.xml").write_text(old)
    assert "notice:" not in cli("analyze", "p.xml", cwd=tmp_path).stdout
    assert "notice: p.xml:1: policy format 0.1.0" in cli("analyze", "p.xml", "-v", cwd=tmp_path).stdout


def test_no_colour_goes_into_a_pipe_or_a_file(before: Path, runs: list[Path], tmp_path: Path) -> None:
    assert ESCAPE not in run("analyze", before, "-l", runs[1], TERM="xterm-256color").stdout
    run("analyze", before, "-l", runs[1], "-o", tmp_path / "r.txt", TERM="xterm-256color", FORCE_COLOR="1")
    assert ESCAPE not in (tmp_path / "r.txt").read_text()


def test_json_is_the_document_of_the_library(cli: Cli, before: Path, runs: list[Path]) -> None:
    done = cli("analyze", before, "-l", runs[1], "--format", "json")
    assert json.loads(done.stdout) == rosprivacy.analyze([str(before)], [str(runs[1])]).document()
    assert done.returncode == 1


@pytest.mark.parametrize("form", ["text", "json"])
def test_the_same_input_gives_the_same_bytes(before: Path, runs: list[Path], form: str) -> None:  # S14
    outputs = {
        run("analyze", before, "-l", runs[1], "-f", form, PYTHONHASHSEED=seed, TZ=zone).stdout
        for seed, zone in (("0", "UTC"), ("1", "Asia/Tokyo"), ("random", "UTC"))
    }
    assert len(outputs) == 1


def test_an_answer_about_some_categories_leaves_out_the_others(cli: Cli, before: Path, runs: list[Path]) -> None:
    assert document(cli, before, "-l", runs[1], "-c", "Video")["verdict"] == "leak"
    assert document(cli, before, "-l", runs[1], "-c", "Voice", "-c", "Health")["verdict"] == "undetermined"


def test_an_unknown_category_is_refused_with_the_nearest(cli: Cli, before: Path) -> None:
    (line,) = refused(cli("analyze", before, "--categories", "Vidio"))
    assert "unknown category 'Vidio'; did you mean Video" in line


def test_standard_channels_can_be_read_replaced_and_switched_off(
    cli: Cli, before: Path, runs: list[Path], tmp_path: Path
) -> None:
    # S13; how many channels were taken so is always reported
    (tmp_path / "mine.yaml").write_text("labels: 1\ntopics: {'*/rosout': mundane}\n")
    taken = [
        document(cli, before, "-l", runs[0], *options)["standard_channels"]
        for options in ([], ["--standard-channels", tmp_path / "mine.yaml"], ["--no-standard-channels"])
    ]
    assert taken == [39, 1, 0]


def test_six_lists_are_about_the_category_that_is_named(cli: Cli, before: Path, tmp_path: Path) -> None:
    lists = {"source": ["/robot_camera"], "leak": ["/archive_server"]}
    (tmp_path / "l.json").write_text(json.dumps(lists, indent="\t"))
    found = document(cli, before, "-l", tmp_path / "l.json", "--category", "Voice")["findings"]
    assert {finding["category"] for finding in found} == {"Voice"}


def test_an_include_root_can_be_named(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "robot").mkdir()
    (tmp_path / "node.xml").write_text('<topics publish="ALLOW"><topic>x</topic></topics>')
    include = f'<xi:include {XI} href="../node.xml"/>'
    (tmp_path / "robot" / "p.xml").write_text(policy(include))
    (line,) = refused(cli("analyze", "robot/p.xml", cwd=tmp_path))
    assert line.startswith("robot/p.xml:1: include of '../node.xml' leaves the folder")
    assert document(cli, "robot/p.xml", "--include-root", ".", cwd=tmp_path)["elements"] == 2


def test_max_bytes_is_a_bound(cli: Cli, before: Path) -> None:
    assert "more than 100 bytes" in refused(cli("analyze", before, "--max-bytes", "100"))[0]


def test_a_folder_and_a_glob_are_read(cli: Cli, before: Path, after: Path) -> None:
    by_folder, by_glob = document(cli, before.parent), document(cli, before.parent / "*.policy.xml")
    assert [Path(file["file"]).name for file in by_folder["assumptions"]["policies"]] == [
        after.name,
        before.name,
        "node.xml",
    ]
    assert by_glob["assumptions"]["policies"] == by_folder["assumptions"]["policies"]
    assert any("not read by itself" in d["message"] for d in by_folder["diagnostics"])


# ---------------------------------------------------------------- files that are written


def everything(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_output_goes_to_a_file_and_nothing_to_standard_output(
    cli: Cli, before: Path, runs: list[Path], tmp_path: Path
) -> None:
    shown = cli("analyze", before, "-l", runs[1], "-f", "json").stdout
    done = cli("analyze", before, "-l", runs[1], "-f", "json", "--output", tmp_path / "r.json")
    assert (done.returncode, done.stdout, done.stderr) == (1, "", "")
    assert everything(tmp_path) == {"r.json": shown.encode()}  # and no temporary file is left


def test_output_replaces_a_file_and_keeps_its_rights(cli: Cli, before: Path, tmp_path: Path) -> None:
    (tmp_path / "r.txt").write_text("old" * 10_000)
    (tmp_path / "r.txt").chmod(0o640)
    cli("analyze", before, "-q", "-o", tmp_path / "r.txt")
    assert (tmp_path / "r.txt").read_text().startswith("undetermined")
    assert (tmp_path / "r.txt").stat().st_mode & 0o777 == 0o640


def test_output_of_a_refused_run_is_not_written(cli: Cli, before: Path, tmp_path: Path) -> None:
    (tmp_path / "r.txt").write_text("old")
    for options in (["-o", "r.txt"], ["-o", "new.txt"], ["-o", "new.txt", "--save-graph", "g.json"]):
        refused(cli("analyze", before, "-c", "Vidio", *options, cwd=tmp_path))
        refused(cli("analyze", "none.xml", *options, cwd=tmp_path))
    assert everything(tmp_path) == {"r.txt": b"old"}


@pytest.mark.parametrize("output", ["none/r.txt", "folder", "file/r.txt", "a" * 300])
def test_output_to_a_place_that_cannot_be_written_is_refused(
    cli: Cli, before: Path, tmp_path: Path, output: str
) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("")
    (line,) = refused(cli("analyze", before, "-q", "-o", output, cwd=tmp_path))
    assert "cannot be written" in line
    assert everything(tmp_path) == {"file": b""}


def test_a_graph_is_not_saved_if_the_report_cannot_be_written(cli: Cli, before: Path, tmp_path: Path) -> None:
    refused(cli("analyze", before, "-q", "--save-graph", "g.json", "-o", "none/r.txt", cwd=tmp_path))
    assert everything(tmp_path) == {}


def test_output_through_a_link_writes_the_file_behind_it(cli: Cli, before: Path, tmp_path: Path) -> None:
    (tmp_path / "real.txt").write_text("old")
    (tmp_path / "link.txt").symlink_to("real.txt")
    cli("analyze", before, "-q", "-o", tmp_path / "link.txt")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "real.txt").read_text().startswith("undetermined")


def test_output_to_a_pipe_is_written_into_it(cli: Cli, before: Path, tmp_path: Path) -> None:
    # as -o >(gzip …), -o /dev/stdout; and -o /dev/null by root must not replace the device
    os.mkfifo(tmp_path / "pipe")
    reader = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    try:
        done = cli("analyze", before, "-q", "-o", tmp_path / "pipe")
        assert (tmp_path / "pipe").is_fifo()
        assert os.read(reader, 1000).startswith(b"undetermined")
    finally:
        os.close(reader)
    assert done.returncode == 4


def test_a_full_disk_is_an_error_not_a_leak(before: Path) -> None:
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "rosprivacy", "analyze", str(before), "-q"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    assert done.returncode not in (0, 1, 3, 4)
    assert "Traceback" not in done.stderr


def test_a_reader_that_stops_reading_is_no_leak(before: Path) -> None:  # rosprivacy analyze … | head -1
    command = [sys.executable, "-m", "rosprivacy", "analyze", str(before), "-f", "json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        said = process.stderr.read().decode()
        assert process.wait(60) != 1  # 1 says that there is a leak
    assert "Traceback" not in said


@pytest.mark.parametrize(
    "arguments", [["analyze", "p.xml", "-f", "json"], ["analyze", "p.xml"], ["labels", "--init", "p.xml"]]
)
def test_a_terminal_that_knows_ascii_only_does_not_end_the_program(tmp_path: Path, arguments: list[str]) -> None:
    (tmp_path / "p.xml").write_text(policy('<topics publish="ALLOW"><topic>é\U0001f600</topic></topics>'), "utf-8")
    done = run(*arguments, cwd=tmp_path, PYTHONIOENCODING="ascii", PYTHONUTF8="0")
    assert (done.returncode, done.stderr) == (4 if arguments[0] == "analyze" else 0, "")


@pytest.mark.parametrize(
    "options", [["-f", "json"], ["-f", "text"], ["-q", "--save-graph", "g.json"], ["-f", "json", "-o", "r.json"]]
)
def test_a_file_name_that_is_not_utf8_does_not_end_the_program(tmp_path: Path, options: list[str]) -> None:
    name = os.fsdecode(b"caf\xe9.xml")  # Latin-1, as old systems wrote it
    (tmp_path / name).write_text(policy(""))
    command = [sys.executable, "-m", "rosprivacy", "analyze", name, *options]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, timeout=60, check=False)
    assert b"Traceback" not in done.stderr
    assert done.returncode in (2, 4)


# ---------------------------------------------------------------- saved graphs


def without_assumptions(result: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in result.items() if key != "assumptions"}


def test_a_saved_graph_answers_like_the_policies(cli: Cli, before: Path, runs: list[Path], tmp_path: Path) -> None:
    read = document(cli, before, "-l", runs[1], "--save-graph", tmp_path / "g.json")
    added = document(cli, "--add", tmp_path / "g.json", "-l", runs[1])
    assert added == read  # with the hashes of the same files


def test_a_policy_can_be_added_to_a_saved_graph(cli: Cli, before: Path, runs: list[Path], tmp_path: Path) -> None:
    more = '<topics subscribe="ALLOW"><topic>robot_video</topic></topics>'
    (tmp_path / "more.xml").write_text(policy(more).replace('"/e"', '"/more"'))
    together = document(cli, before, tmp_path / "more.xml", "-l", runs[1], "--save-graph", tmp_path / "both.json")
    cli("analyze", before, "-q", "--save-graph", tmp_path / "g.json")
    again = document(
        cli, tmp_path / "more.xml", "--add", tmp_path / "g.json", "-l", runs[1], "--save-graph", tmp_path / "b.json"
    )
    assert again == together
    assert (tmp_path / "b.json").read_bytes() == (tmp_path / "both.json").read_bytes()  # S14


def test_a_policy_read_again_replaces_what_was_saved_of_it(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy('<topics publish="ALLOW"><topic>old</topic></topics>'))
    cli("analyze", "p.xml", "-q", "--save-graph", "g.json", cwd=tmp_path)
    (tmp_path / "p.xml").write_text(policy(""))
    assert document(cli, "--add", "g.json", cwd=tmp_path)["elements"] == 2
    assert document(cli, "p.xml", "--add", "g.json", cwd=tmp_path)["elements"] == 1


def test_a_saved_graph_keeps_what_the_reader_of_a_report_has_to_know(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy("", twice=True))  # one enclave twice: a warning
    read = document(cli, "p.xml", "--save-graph", "g.json", cwd=tmp_path)
    assert any(d["severity"] == "warning" and "again" in d["message"] for d in read["diagnostics"])
    assert document(cli, "--add", "g.json", cwd=tmp_path)["diagnostics"] == read["diagnostics"]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "5",
        "{}",
        '{"format": "rosprivacy.graph/0", "policies": []}',
        '{"format": "rosprivacy.graph/1"}',
        '{"format": "rosprivacy.graph/1", "policies": 5}',
        '{"format": "rosprivacy.graph/1", "policies": {"a": 1}}',
        '{"format": "rosprivacy.graph/1", "policies": ["a"]}',
        '{"format": "rosprivacy.graph/1", "policies": [{}]}',
        '{"format": "rosprivacy.graph/1", "policies": []}',  # nothing to say anything about
        "[" * 100_000,
        "\xff",
    ],
)
def test_what_is_no_saved_graph_is_refused(cli: Cli, tmp_path: Path, text: str) -> None:
    (tmp_path / "g.json").write_bytes(text.encode("latin-1"))
    (line,) = refused(cli("analyze", "--add", "g.json", "-f", "json", cwd=tmp_path))
    assert line.startswith("g.json:")


@pytest.mark.parametrize(
    ("was", "becomes"),
    [
        ('"ALLOW"', '"allow"'),
        ('"publish"', '"shout"'),
        ('"publish"', '["publish"]'),
        ('"publish"', "null"),
        ('"line": 1', '"line": "1"'),
        ('"line": 1', '"lime": 1'),
        ('"profiles": [{"enclave": "/e", "node": "/a"', '"profiles": [{"enclave": "/e", "node": "/b"'),  # whose grants?
        ('"/t"', '["/t"]'),
        ('"/t"', '"/\\ud800"'),  # half a character
        ('"/t"', "[" + '"x", ' * 10_000 + '"x"]'),
    ],
)
def test_a_damaged_graph_is_refused(cli: Cli, tmp_path: Path, was: str, becomes: str) -> None:
    (tmp_path / "p.xml").write_text(policy('<topics publish="ALLOW"><topic>t</topic></topics>'))
    text = json.dumps(as_dict(read_policies([str(tmp_path / "p.xml")])[0]))
    assert was in text
    (tmp_path / "g.json").write_text(text.replace(was, becomes))
    (line,) = refused(cli("analyze", "--add", "g.json", "-f", "json", cwd=tmp_path))
    assert line.startswith("g.json:")
    assert len(line) < 500


def test_a_graph_that_is_no_regular_file_is_refused_and_does_not_wait(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for name in ("none", ".", "pipe"):
        refused(run("analyze", "--add", name, cwd=tmp_path, seconds=20))


# ---------------------------------------------------------------- the labels command

SHIPPED_CHANNELS = set(re.findall(r'"\*/(\w+)"', shipped_text("standard")))


def policy(body: str, ns: str = "/", *, twice: bool = False) -> str:
    enclave = f'<enclave path="/e"><profiles><profile ns="{ns}" node="a">{body}</profile></profiles></enclave>'
    return f'<policy version="0.2.0"><enclaves>{enclave * (1 + twice)}</enclaves></policy>'


def elements(path: Path) -> set[tuple[str, str]]:
    graph = rosprivacy.analyze([str(path)]).analysis.graph
    return {(element.kind, element.name) for element in graph.elements}


def test_a_first_label_file_names_every_element_once_but_those_of_the_shipped_files(
    cli: Cli, before: Path, tmp_path: Path
) -> None:
    done = cli("labels", "--init", before, "-o", tmp_path / "l.yaml")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    text = (tmp_path / "l.yaml").read_text("utf-8")
    read = read_labels(str(tmp_path / "l.yaml"), load()).entries
    named = [(kind, entry.name) for entry in read for kind in entry.kinds]
    shipped = {(kind, name) for kind, name in elements(before) if name.rpartition("/")[2] in SHIPPED_CHANNELS}
    assert sorted(named) == sorted(elements(before) - shipped)
    assert f"# Not listed: {len(shipped)} standard channels" in text
    schema = json.loads((tmp_path / "labels.schema.json").read_text("utf-8"))  # the first line names it
    assert text.startswith("# yaml-language-server: $schema=labels.schema.json\n")
    assert Draft202012Validator(schema).is_valid(yaml.safe_load(text))


def test_a_schema_that_is_there_stays(cli: Cli, before: Path, tmp_path: Path) -> None:
    (tmp_path / "labels.schema.json").write_text("{}")
    assert cli("labels", "--init", before, "-o", tmp_path / "l.yaml").returncode == 0
    assert (tmp_path / "labels.schema.json").read_text() == "{}"


def test_a_first_label_file_is_valid_as_it_is_and_says_nothing(cli: Cli, before: Path, tmp_path: Path) -> None:
    (tmp_path / "l.yaml").write_text(cli("labels", "--init", before).stdout)
    assert all(entry.statements == () for entry in read_labels(str(tmp_path / "l.yaml"), load()).entries)
    with_it, without = document(cli, before, "-l", tmp_path / "l.yaml"), document(cli, before)
    assert without_assumptions(with_it) == without_assumptions(without)


def test_a_first_label_file_lists_standard_channels_where_they_are_not_taken(cli: Cli, before: Path) -> None:
    assert "/rosout:" not in cli("labels", "--init", before).stdout
    assert "  /rosout:" in cli("labels", "--init", before, "--no-standard-channels").stdout


@pytest.mark.parametrize(
    ("name", "ns"),
    [
        ("x", "/"),
        ("a b: #c", "/"),
        ("q\"'\\", "/"),
        ("é", "/"),
        ("\U0001f600", "/"),
        ("a\nb\tc", "/"),
        ("\u2028\x85\ufeff", "/"),
        ("-", "/"),
        ("&a", "/"),
        ("*", "/"),
        ("[a-c]?", "/"),
        ("x" * 1200, "/"),
        ("x", "relative"),  # sros2 does not repair a namespace; the element is called so
        ("x", ""),
        ("", "/"),
    ],
)
def test_a_first_label_file_is_valid_whatever_the_names(cli: Cli, tmp_path: Path, name: str, ns: str) -> None:
    escaped = name.replace("&", "&amp;")
    body = f'<topics publish="ALLOW"><topic>{escaped}</topic></topics>'
    (tmp_path / "p.xml").write_text(policy(body, ns), "utf-8")
    done = cli("labels", "--init", "p.xml", "-o", "l.yaml", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    done = cli("analyze", "p.xml", "-l", "l.yaml", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (4, "")


def test_the_schema_is_a_json_schema(cli: Cli) -> None:
    schema = json.loads(cli("labels", "--schema").stdout)
    Draft202012Validator.check_schema(schema)


@pytest.mark.parametrize("name", ["standard", "infrastructure"])
def test_a_shipped_file_is_printed_as_it_is(cli: Cli, name: str, tmp_path: Path) -> None:
    done = cli("labels", f"--{name}")
    assert (done.returncode, done.stdout) == (0, shipped_text(name))
    cli("labels", f"--{name}", "-o", tmp_path / "s.yaml")
    assert (tmp_path / "s.yaml").read_text("utf-8") == shipped_text(name)


# ---------------------------------------------------------------- bad input


BOMB = "".join(f'<!ENTITY {chr(98 + i)} "{f"&{chr(97 + i)};" * 10}">' for i in range(9))
GOOD = policy('<topics publish="ALLOW"><topic>t</topic></topics>')
LABELS = "labels: 1\nnodes: {/a: conduit}\n"


def broken(name: str, policy_text: str | bytes, label_text: str | bytes = LABELS) -> Any:
    return pytest.param(policy_text, label_text, id=name)


@pytest.mark.parametrize(
    ("policy_text", "label_text"),
    [
        broken("empty file", ""),
        broken("not XML", "labels: 1"),
        broken("JSON", "{}"),
        broken("binary", b"\x00\x01\x02\xff"),
        broken("truncated XML", GOOD[:-30]),
        broken("wrong version", GOOD.replace("0.2.0", "0.3.0")),
        broken("no version", GOOD.replace(' version="0.2.0"', "")),
        broken("another root element", "<launch/>"),
        broken("unknown element", GOOD.replace("topics", "tropics")),
        broken("unknown attribute", GOOD.replace("publish", "shout")),
        broken("unknown attribute value", GOOD.replace("ALLOW", "MAYBE")),
        broken("missing node", GOOD.replace(' node="a"', "")),
        broken("missing ns", GOOD.replace(' ns="/"', "")),
        broken("missing path", GOOD.replace(' path="/e"', "")),
        broken("include outside the root", policy(f'<xi:include {XI} href="../outside.xml"/>')),
        broken("include of an absolute path", policy(f'<xi:include {XI} href="/etc/passwd"/>')),
        broken(
            "include as text", policy(f'<topics><topic><xi:include {XI} href="p.xml" parse="text"/></topic></topics>')
        ),
        broken("include from the network", policy(f'<xi:include {XI} href="http://127.0.0.1:9/x.xml"/>')),
        broken("include that is missing", policy(f'<xi:include {XI} href="none.xml"/>')),
        broken("include with a long name", policy(f'<xi:include {XI} href="{"a" * 300}"/>')),
        broken("include loop", policy(f'<xi:include {XI} href="p.xml"/>')),
        broken("include loop of two files", policy(f'<xi:include {XI} href="loop.xml"/>')),
        broken("entity bomb", f'<!DOCTYPE policy [<!ENTITY a "aaaaaaaaaa">{BOMB}]>{GOOD.replace(">t<", ">&j;<")}'),
        broken(
            "external entity", f'<!DOCTYPE p [<!ENTITY x SYSTEM "file:///etc/passwd">]>{GOOD.replace(">t<", ">&x;<")}'
        ),
        broken("policy not UTF-8", GOOD.replace(">t<", ">caf\xe9<").encode("latin-1")),
        broken("unknown label key", GOOD, "labels: 1\nnode: {/a: conduit}"),
        broken("unknown label key inside", GOOD, "labels: 1\nnodes: {/a: {leeks: [Video]}}"),
        broken("unknown label", GOOD, "labels: 1\nnodes: {/a: safe}"),
        broken("wrong category", GOOD, "labels: 1\nnodes: {/a: {leak: [Vidio]}}"),
        broken("wrong label version", GOOD, "labels: 2\nnodes: {/a: conduit}"),
        broken("no label version", GOOD, "nodes: {/a: conduit}"),
        broken("unknown name", GOOD, "labels: 1\nnodes: {/b: conduit}"),
        broken("name in the wrong section", GOOD, "labels: 1\nnodes: {/t: conduit}"),
        broken("contradicting labels", GOOD, "labels: 1\nnodes: {/a: {leak: [Video], conduit: [Video]}}"),
        broken("duplicate keys", GOOD, "labels: 1\nnodes: {/a: conduit, /a: conduit}"),
        broken("labels empty", GOOD, ""),
        broken("labels not YAML", GOOD, "labels: [\n"),
        broken("labels not UTF-8", GOOD, "labels: 1\nnodes: {/caf\xe9: conduit}".encode("latin-1")),
        broken("labels nested deeply", GOOD, "labels: 1\nnodes: " + "[" * 3000 + "]" * 3000),
        broken("labels with aliases", GOOD, "labels: 1\nnodes: {/a: &a {leak: [Video]}, /t: *a}"),
        broken("six lists of another system", GOOD, '{"source": ["/b"], "leak": []}'),
        broken("both bad", "<policy>", "labels: 2"),
    ],
)
@pytest.mark.parametrize(
    "output", [[], ["-o", "r.json", "-f", "json", "--save-graph", "g.json"]], ids=["", "to a file"]
)
def test_bad_input_is_refused_in_one_line_each_and_nothing_is_written(
    cli: Cli, tmp_path: Path, policy_text: str | bytes, label_text: str | bytes, output: list[str]
) -> None:
    folder = tmp_path / "root"
    folder.mkdir()
    (tmp_path / "outside.xml").write_text("<profile/>")
    (folder / "loop.xml").write_text(f'<profile><xi:include {XI} href="p.xml"/></profile>')
    for name, text in (("p.xml", policy_text), ("l.yaml", label_text)):
        (folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    there = everything(tmp_path)
    lines = refused(cli("analyze", "p.xml", "-l", "l.yaml", *output, cwd=folder))
    assert len(lines) == len(set(lines))  # each problem once
    assert everything(tmp_path) == there


@pytest.mark.parametrize(
    ("arguments", "place"),
    [
        (["none.xml"], "none.xml:0"),
        (["none/"], "none/:0"),
        (["*.yaml"], "*.yaml:0"),
        (["empty"], "empty:0"),  # a directory with no policies
        (["fragments"], "fragments:0"),
        (["a" * 300], "a" * 20),
        ([""], ""),
        (["p.xml", "-l", "none.yaml"], "none.yaml:0"),
        (["p.xml", "-l", "empty"], "empty:0"),
        (["p.xml", "-l", ""], ""),
        (["p.xml", "-l", "rosprivacy:none"], "rosprivacy:none:0"),
        (["p.xml", "--standard-channels", "none.yaml"], "none.yaml:0"),
        (["p.xml", "--add", "none.json"], "none.json:0"),
        (["p.xml", "--categories", "Vidio"], "--categories:0"),
    ],
)
def test_what_is_not_there_is_refused_by_its_name(cli: Cli, tmp_path: Path, arguments: list[str], place: str) -> None:
    (tmp_path / "p.xml").write_text(GOOD)
    (tmp_path / "empty").mkdir()
    (tmp_path / "fragments").mkdir()
    (tmp_path / "fragments" / "node.xml").write_text("<profile/>")
    there = everything(tmp_path)
    (line,) = refused(cli("analyze", *arguments, cwd=tmp_path))
    assert line.startswith(place)
    assert everything(tmp_path) == there


@pytest.mark.parametrize("write", [Path.mkdir, os.mkfifo, lambda path: path.symlink_to("/dev/zero")])
def test_what_is_no_regular_file_is_refused_and_does_not_wait(
    cli: Cli, tmp_path: Path, write: Callable[[Path], None]
) -> None:
    (tmp_path / "good.xml").write_text(GOOD)
    write(tmp_path / "p.xml")
    refused(cli("analyze", "good.xml", "-l", "p.xml", cwd=tmp_path))
    refused(cli("analyze", "p.xml", cwd=tmp_path))


def test_the_problems_of_all_policies_are_reported_at_once(cli: Cli, tmp_path: Path) -> None:
    for name in "abc":
        (tmp_path / f"{name}.xml").write_text(GOOD.replace("ALLOW", "YES").replace(' node="a"', ""))
    lines = refused(cli("analyze", "a.xml", "b.xml", "c.xml", "d.xml", cwd=tmp_path))
    assert [line.split(": ")[0] for line in lines] == [
        "a.xml:1",
        "a.xml:1",
        "b.xml:1",
        "b.xml:1",
        "c.xml:1",
        "c.xml:1",
        "d.xml:0",
    ]


def test_a_message_cannot_forge_another_line_or_colour(cli: Cli, tmp_path: Path) -> None:
    evil = "x&#10;fake.xml:1: all is well; relax"
    (tmp_path / "p.xml").write_text(GOOD.replace("ALLOW", evil))
    (tmp_path / f"{ESCAPE}[31m\n.xml").write_text("<policy")
    assert len(refused(cli("analyze", "p.xml", cwd=tmp_path))) == 1
    (line,) = refused(cli("analyze", f"{ESCAPE}[31m\n.xml", cwd=tmp_path))
    assert ESCAPE not in line


def test_a_label_file_that_is_nested_very_deeply_does_not_end_the_process(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(GOOD)
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes: " + "[" * 100_000)
    refused(run("analyze", "p.xml", "-l", "l.yaml", cwd=tmp_path))


@pytest.mark.parametrize(
    ("policy_text", "label_text"),
    [("<policy", LABELS), (GOOD, "labels: 2"), (GOOD, "labels: 1\nnodes: {/b: conduit}")],
)
def test_bad_input_is_refused_by_the_process_too(tmp_path: Path, policy_text: str, label_text: str) -> None:
    (tmp_path / "p.xml").write_text(policy_text)
    (tmp_path / "l.yaml").write_text(label_text)
    there = everything(tmp_path)
    refused(run("analyze", "p.xml", "-l", "l.yaml", "-o", "r.json", cwd=tmp_path))
    assert everything(tmp_path) == there


def test_closed_standard_output_does_not_end_in_a_traceback(before: Path, tmp_path: Path) -> None:  # rosprivacy … >&-
    shell = '"$0" -m rosprivacy analyze -q "$@" >&-'
    for options in ([], ["-o", str(tmp_path / "r.txt")]):
        command = ["sh", "-c", shell, sys.executable, str(before), *options]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        assert "Traceback" not in done.stderr
        assert done.returncode in (2, 4)


def test_a_first_label_file_does_not_take_the_place_of_one_that_is_there(
    cli: Cli, before: Path, tmp_path: Path
) -> None:
    (tmp_path / "l.yaml").write_text("work")
    (line,) = refused(cli("labels", "--init", before, "-o", "l.yaml", cwd=tmp_path))
    assert "is there already" in line
    assert (tmp_path / "l.yaml").read_text() == "work"
