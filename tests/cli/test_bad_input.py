"""Bad input is refused in one line for each problem; nothing is written."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import XI, Cli, refused, run

if TYPE_CHECKING:
    from collections.abc import Callable
from tests.helpers.policies import ESCAPE, everything, policy

BOMB = "".join(f'<!ENTITY {chr(98 + i)} "{f"&{chr(97 + i)};" * 10}">' for i in range(9))


GOOD = policy('<topics publish="ALLOW"><topic>t</topic></topics>')


LABELS = "labels: 1\nnodes: {/a: conduit}\n"
BAD: dict[str, tuple[str | bytes, str | bytes]] = {  # one of each sort; the tables of the readers have all
    "empty file": ("", LABELS),
    "binary": (b"\x00\x01\x02\xff", LABELS),
    "truncated XML": (GOOD[:-30], LABELS),
    "wrong version": (GOOD.replace("0.2.0", "0.3.0"), LABELS),
    "unknown attribute value": (GOOD.replace("ALLOW", "MAYBE"), LABELS),
    "include outside the root": (policy(f'<xi:include {XI} href="../outside.xml"/>'), LABELS),
    "include loop of two files": (policy(f'<xi:include {XI} href="loop.xml"/>'), LABELS),
    "entity bomb": (f'<!DOCTYPE policy [<!ENTITY a "aaaaaaaaaa">{BOMB}]>{GOOD.replace(">t<", ">&j;<")}', LABELS),
    "unknown label": (GOOD, "labels: 1\nnodes: {/a: safe}"),
    "unknown name": (GOOD, "labels: 1\nnodes: {/b: conduit}"),
    "name in the wrong section": (GOOD, "labels: 1\nnodes: {/t: conduit}"),
    "contradicting labels": (GOOD, "labels: 1\nnodes: {/a: {leak: [Video], conduit: [Video]}}"),
    "labels not YAML": (GOOD, "labels: [\n"),
    "labels not UTF-8": (GOOD, "labels: 1\nnodes: {/caf\xe9: conduit}".encode("latin-1")),
    "labels with aliases": (GOOD, "labels: 1\nnodes: {/a: &a {leak: [Video]}, /t: *a}"),
    "six lists of another system": (GOOD, '{"source": ["/b"], "leak": []}'),
    "both bad": ("<policy>", "labels: 2"),
}


@pytest.mark.parametrize("name", BAD)
@pytest.mark.parametrize(
    "output", [[], ["-o", "r.json", "-f", "json", "--save-graph", "g.json"]], ids=["", "to a file"]
)
def test_bad_input_is_refused_in_one_line_each_and_nothing_is_written(
    cli: Cli, tmp_path: Path, name: str, output: list[str]
) -> None:
    folder = tmp_path / "root"
    folder.mkdir()
    (tmp_path / "outside.xml").write_text("<profile/>")
    (folder / "loop.xml").write_text(f'<profile><xi:include {XI} href="p.xml"/></profile>')
    for file, text in zip(("p.xml", "l.yaml"), BAD[name], strict=True):
        (folder / file).write_bytes(text if isinstance(text, bytes) else text.encode())
    there = everything(tmp_path)
    lines = refused(cli("analyze", "p.xml", "-l", "l.yaml", *output, cwd=folder))
    assert len(lines) == len(set(lines))  # each problem once
    assert everything(tmp_path) == there


@pytest.mark.parametrize("levels", [3_000, 100_000])
def test_a_label_file_that_is_nested_very_deeply_does_not_end_the_process(tmp_path: Path, levels: int) -> None:
    (tmp_path / "p.xml").write_text(GOOD)
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes: " + "[" * levels)
    refused(run("analyze", "p.xml", "-l", "l.yaml", cwd=tmp_path))


@pytest.mark.parametrize(
    ("arguments", "place"),
    [
        (["none.xml"], "none.xml"),
        (["none/"], "none/"),
        (["*.yaml"], "*.yaml"),
        (["empty"], "empty"),  # a directory with no policies
        (["fragments"], "fragments"),
        (["a" * 300], "a" * 20),
        ([""], ""),
        (["p.xml", "-l", "none.yaml"], "none.yaml"),
        (["p.xml", "-l", "empty"], "empty"),
        (["p.xml", "-l", ""], ""),
        (["p.xml", "-l", "rosprivacy:none"], "rosprivacy:none"),
        (["p.xml", "--standard-channels", "none.yaml"], "none.yaml"),
        (["p.xml", "--add", "none.json"], "none.json"),
        (["p.xml", "--categories", "Vidio"], "--categories"),
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
    twice = [f"{name}.xml:1" for name in "abc" for _ in range(2)]
    assert [line.split(": ")[0] for line in lines] == [*twice, "d.xml"]


def test_a_message_cannot_forge_another_line_or_colour(cli: Cli, tmp_path: Path) -> None:
    evil = "x&#10;fake.xml:1: all is well; relax"
    (tmp_path / "p.xml").write_text(GOOD.replace("ALLOW", evil))
    (tmp_path / f"{ESCAPE}[31m\n.xml").write_text("<policy")
    assert len(refused(cli("analyze", "p.xml", cwd=tmp_path))) == 1
    (line,) = refused(cli("analyze", f"{ESCAPE}[31m\n.xml", cwd=tmp_path))
    assert ESCAPE not in line


@pytest.mark.parametrize("written", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_closed_standard_output_does_not_end_in_a_traceback(before: Path, tmp_path: Path, *, written: bool) -> None:
    """As ``rosprivacy … >&-``."""
    shell = '"$0" -m rosprivacy analyze -q "$@" >&-'
    command = ["sh", "-c", shell, sys.executable, str(before), *(["-o", str(tmp_path / "r.txt")] if written else [])]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert "Traceback" not in done.stderr
    assert done.returncode in (2, 4)
