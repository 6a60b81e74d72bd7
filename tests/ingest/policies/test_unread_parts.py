"""What of a folder was not read, in whole or in part, is never forgotten (rule S11): cases of the second hunt."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import cli

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]

CAMERA = """<policy version="0.2.0"><enclaves><enclave path="/camera"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>/video</topic></topics></profile></profiles></enclave></enclaves></policy>
"""
READS = '<topics subscribe="ALLOW"><topic>/video</topic></topics>'
FRAGMENT = f"<profile>{READS}</profile>"
HALF = f'<profile>{READS}<services reply="ALLOW"><service>/s</service></services></profile>'
PART = """<policy version="0.2.0" xmlns:xi="http://www.w3.org/2001/XInclude"><enclaves><enclave path="/x"><profiles>
<profile ns="/" node="x"><xi:include href="f.xml" xpointer="xpointer(/profile/services)"/>
<topics publish="ALLOW"><topic>/q</topic></topics></profile></profiles></enclave></enclaves></policy>
"""


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d").mkdir()
    Path("d/p.xml").write_text(CAMERA, "utf-8")
    labels = 'labels: 1\nnodes: {/camera: {source: [Video], leak: none}, "/x*": conduit}\nchannels: {"/*": sensitive}\n'
    Path("l.yaml").write_text(labels.replace(', "/x*": conduit', ""), "utf-8")
    Path("x.yaml").write_text(labels.replace('"/x*"', "/x"), "utf-8")


def verdict(cli: Cli, *arguments: str) -> tuple[str, str]:
    document = json.loads(cli("analyze", *arguments, "-f", "json").stdout)
    return document["verdict"], " ".join(d["message"] for d in document["diagnostics"])


def test_a_saved_graph_keeps_what_was_not_read(cli: Cli) -> None:
    """One answer: what is undetermined from the files is so from the graph."""
    Path("d/f.xml").write_text(FRAGMENT, "utf-8")
    assert cli("analyze", "d", "-l", "l.yaml", "--save-graph", "g.json", "-o", "o.txt").returncode == 4
    got, said = verdict(cli, "--add", "g.json", "-l", "l.yaml")
    assert got == "undetermined"
    assert "no policy read here includes it" in said
    assert cli("analyze", "--add", "g.json", "-l", "l.yaml", "--fail-on", "undetermined").returncode == 4


def test_a_saved_graph_forgets_it_once_a_policy_includes_the_file(cli: Cli) -> None:
    Path("d/f.xml").write_text(FRAGMENT, "utf-8")
    cli("analyze", "d", "-l", "l.yaml", "--save-graph", "g.json", "-o", "o.txt")
    Path("d/r.xml").write_text(PART.replace("/profile/services", "/profile/*"), "utf-8")
    got, said = verdict(cli, "d/r.xml", "--add", "g.json", "-l", "x.yaml")
    assert got == "no-leak-found"
    assert "includes it" not in said


def test_a_fragment_of_which_a_policy_takes_a_part_only_is_not_read_whole(cli: Cli) -> None:
    Path("d/f.xml").write_text(HALF, "utf-8")
    Path("d/q.xml").write_text(PART, "utf-8")
    got, said = verdict(cli, "d", "-l", "x.yaml")
    assert got == "undetermined"
    assert "not read whole: of this file no policy read here includes what stands at line 1" in said


def test_an_include_that_selects_nothing_does_not_make_a_file_read(cli: Cli) -> None:
    Path("d/f.xml").write_text(FRAGMENT, "utf-8")
    Path("d/q.xml").write_text(PART, "utf-8")
    assert verdict(cli, "d", "-l", "x.yaml")[0] == "undetermined"


def test_a_fragment_that_a_policy_takes_whole_is_read(cli: Cli) -> None:
    Path("d/f.xml").write_text(HALF, "utf-8")
    Path("d/q.xml").write_text(PART.replace("/profile/services", "/profile/*"), "utf-8")
    assert verdict(cli, "d", "-l", "x.yaml")[0] == "no-leak-found"


@pytest.mark.parametrize(
    "text",
    [
        f"<policies>{CAMERA}</policies>",
        CAMERA.replace("<policy ", "<Policy ").replace("</policy>", "</Policy>"),
        f"<x>{FRAGMENT}</x>",
    ],
)
def test_grants_under_another_root_are_grants_that_were_not_read(cli: Cli, text: str) -> None:
    Path("d/f.xml").write_text(text, "utf-8")
    got, said = verdict(cli, "d", "-l", "l.yaml")
    assert got == "undetermined"
    assert "so what it grants is not known" in said


def test_xml_of_another_kind_is_a_notice(cli: Cli) -> None:
    Path("d/robot.launch.xml").write_text('<launch><include file="x.xml"/><topics><topic>/a</topic></topics></launch>')
    assert verdict(cli, "d", "-l", "l.yaml")[0] == "no-leak-found"
