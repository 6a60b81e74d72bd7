"""Graphs that are saved, and added to."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import Cli, refused, run
from tests.helpers.policies import document, policy

if TYPE_CHECKING:
    from pathlib import Path


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


@pytest.mark.parametrize("text", ["", "{", "[]", "5", "{}", '{"format": "rosprivacy.graph/1"}', "[" * 100_000, "\xff"])
def test_what_is_no_saved_graph_is_refused(cli: Cli, tmp_path: Path, text: str) -> None:
    """What is damaged in one is in ``test_damaged_input.py``."""
    (tmp_path / "g.json").write_bytes(text.encode("latin-1"))
    (line,) = refused(cli("analyze", "--add", "g.json", "-f", "json", cwd=tmp_path))
    assert line.startswith("g.json:")


def test_a_graph_that_is_no_regular_file_is_refused_and_does_not_wait(cli: Cli, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for name in ("none", "."):
        refused(cli("analyze", "--add", name, cwd=tmp_path))
    refused(run("analyze", "--add", "pipe", cwd=tmp_path, seconds=20))
