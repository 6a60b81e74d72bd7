"""The command line: help, exit codes, reports."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.cli.exit_code import REMOVED_OPTIONS
from tests.helpers.command import XI, Cli, refused, run

if TYPE_CHECKING:
    from collections.abc import Sequence
from tests.helpers.policies import ESCAPE, document, policy


def test_version() -> None:
    done = run("--version")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"rosprivacy {rosprivacy.__version__}\n", "")


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (["rosprivacy", "l"], {"labels", "law", "lint", "load"}),
        (["rosprivacy", "analyze", "--category", "Vid"], {"Video"}),
        *(
            pytest.param(["rosprivacy", "analyze", *words], wanted, marks=pytest.mark.slow)
            for words, wanted in (
                (["--fail"], {"--fail-on"}),
                (["--view", ""], {"declared", "enforced", "both"}),
                (["--format", "j"], {"json", "json1", "json-ld"}),
                (["--categories", "Vo"], {"Voice", "VoiceCommand", "VoicePrint"}),
            )
        ),
    ],
)
def test_the_shell_completes(words: Sequence[str], wanted: set[str]) -> None:
    program = Path(sys.executable).with_name("rosprivacy")
    place = {"COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    environment = os.environ | {"_ROSPRIVACY_COMPLETE": "complete_bash"} | place
    done = subprocess.run([program], capture_output=True, text=True, env=environment, timeout=60, check=False)
    assert done.stderr == ""
    assert set(done.stdout.split()) == wanted


@pytest.mark.parametrize(
    ("policy", "labels", "verdict", "code"),
    [
        ("before", 1, "undetermined", 4),  # S12: no finding, but open elements
        ("before", 2, "leak", 1),
        ("before", 3, "leak", 1),
        ("after", 4, "leak", 1),  # the request to save footage carries it
        ("after", 5, "no-leak-found", 0),
    ],
)
@pytest.mark.parametrize("fail_on", [None, "undetermined", "undecided", "leak", "never"])
def test_the_exit_code_is_the_verdict(
    cli: Cli, before: Path, runs: list[Path], policy: str, labels: int, verdict: str, code: int, fail_on: str | None
) -> None:
    chosen = ["--fail-on", fail_on] if fail_on else []
    done = cli("analyze", before.with_name(f"{policy}.policy.xml"), "-l", runs[labels - 1], "-q", *chosen)
    passes = fail_on == "never" or (
        fail_on == "leak" and verdict == "undetermined"
    )  # a source is named: data was followed
    (line,) = done.stdout.splitlines()
    assert (line.partition(":")[0], done.returncode, done.stderr) == (verdict, 0 if passes else code, "")


NOTHING_SAID = "labels: 1\nnodes:\n  /robot_camera:\nchannels:\n  /robot_video: mundane\n"


@pytest.mark.parametrize("labels", [None, "the template", "labels: 1\n", NOTHING_SAID, "rosprivacy:infrastructure"])
@pytest.mark.parametrize("fail_on", [None, "leak", "undetermined", "undecided"])
def test_where_no_source_is_named_no_build_is_green(
    cli: Cli, before: Path, tmp_path: Path, labels: str | None, fail_on: str | None
) -> None:
    """S11, S12, the table of exit codes: nothing was looked at, whatever the build fails on."""
    file = tmp_path / "l.yaml"
    file.write_text(cli("labels", "--init", before).stdout if labels == "the template" else labels or "", "utf-8")
    named = ["-l", str(labels if labels == "rosprivacy:infrastructure" else file)] if labels else []
    done = cli("analyze", before, *named, *(["--fail-on", fail_on] if fail_on else []))
    assert (done.stdout.partition(":")[0], done.returncode) == ("undetermined", 4)
    step = done.stdout.splitlines()[-1]
    assert step.startswith("Next: name a source in a label file")
    assert "candidates by name: /robot_camera, /safety_camera" in step


def test_where_no_source_of_what_is_asked_is_named_no_build_is_green(cli: Cli, before: Path, runs: list[Path]) -> None:
    assert cli("analyze", before, "-l", runs[0], "-c", "Voice", "--fail-on", "leak").returncode == 4


@pytest.mark.parametrize(
    "arguments",
    [
        ["analyze"],
        ["analyze", "p.xml", "--nope"],
        ["analyze", "p.xml", "--max-paths", "0"],
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


def test_verbose_prints_what_the_report_leaves_out(cli: Cli, tmp_path: Path) -> None:
    old = '<policy version="0.1.0"><profiles><profile ns="/" node="a"/></profiles></policy>'
    (tmp_path / "p.xml").write_text(old)
    assert "notice:" not in cli("analyze", "p.xml", cwd=tmp_path).stdout
    assert "notice: p.xml:1: policy format 0.1.0" in cli("analyze", "p.xml", "-v", cwd=tmp_path).stdout


def test_no_colour_goes_into_a_pipe_or_a_file(cli: Cli, before: Path, runs: list[Path], tmp_path: Path) -> None:
    assert ESCAPE not in cli("analyze", before, "-l", runs[1], TERM="xterm-256color").stdout
    cli("analyze", before, "-l", runs[1], "-o", tmp_path / "r.txt", TERM="xterm-256color", FORCE_COLOR="1")
    assert ESCAPE not in (tmp_path / "r.txt").read_text()


def test_json_is_the_document_of_the_library(cli: Cli, before: Path, runs: list[Path]) -> None:
    done = cli("analyze", before, "-l", runs[1], "--format", "json1")
    assert json.loads(done.stdout) == rosprivacy.analyze([str(before)], [str(runs[1])]).document()
    assert done.returncode == 1


@pytest.mark.slow  # each day test_decisions looks at one form, and golden files are compared in any process
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


def test_standard_channels_can_be_read_replaced_and_switched_off(
    cli: Cli, before: Path, runs: list[Path], tmp_path: Path
) -> None:
    # S13; how many channels were taken so is always reported
    (tmp_path / "mine.yaml").write_text("labels: 1\ntopics: {'*/rosout': mundane}\n")
    taken = [
        document(cli, before, "-l", runs[0], *options)["standard_channels"]
        for options in ([], ["--standard-channels", tmp_path / "mine.yaml"], ["--standard-channels", "none"])
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


def test_the_bytes_of_a_policy_are_bounded(cli: Cli, before: Path) -> None:
    assert "--bound policy_bytes=N" in refused(cli("analyze", before, "--bound", "policy_bytes=100"))[0]


@pytest.mark.parametrize("option", REMOVED_OPTIONS)
def test_an_option_of_earlier_versions_is_refused_with_what_to_write(cli: Cli, before: Path, option: str) -> None:
    done = cli("analyze", before, option)
    instead = REMOVED_OPTIONS[option].removeprefix("write ").replace("=N", "=99999999").split()
    assert (done.returncode, done.stdout) == (2, "")
    assert option in done.stderr
    assert instead[0] in done.stderr
    assert cli("analyze", before, *instead).returncode == 4


def test_a_folder_and_a_glob_are_read(cli: Cli, before: Path) -> None:
    by_folder, by_glob = document(cli, before.parent), document(cli, before.parent / "*.policy.xml")
    assert [Path(file["file"]).name for file in by_folder["assumptions"]["policies"]] == [
        "after.policy.xml",
        before.name,
        "node.xml",
    ]
    assert by_glob["assumptions"]["policies"] == by_folder["assumptions"]["policies"]
    assert any("not read by itself" in d["message"] for d in by_folder["diagnostics"])
