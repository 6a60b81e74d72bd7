"""The tables of an answer say what its JSON says, row by row; and no table without rows stands for the answer."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.report.document.tables import TABLES
from tests.helpers.command import cli, refused
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]

EXAMPLES = ROOT / "examples"


def answer_of(name: str) -> Any:
    if name == "fleet":
        return rosprivacy.analyze_fleet(str(EXAMPLES / "fleet" / "fleet.yaml"))
    policy, labels = {
        "factory": ("factory/before.policy.xml", ("factory/run2.labels.yaml",)),
        "care-home": ("care-home/care-home.policy.xml", ("care-home/care-home.labels.yaml",)),
        "unlabelled": ("care-home/care-home.policy.xml", ()),
    }[name]
    return rosprivacy.analyze(str(EXAMPLES / policy), *(str(EXAMPLES / file) for file in labels))


@pytest.mark.parametrize("name", ["factory", "care-home", "unlabelled", "fleet"])
def test_they_say_what_the_document_says(name: str) -> None:
    result = answer_of(name)
    tables, document = result.tables(), result.document()
    (answer,) = tables["answer"]
    assert answer["verdict"] == document["verdict"]
    assert [row["id"] for row in tables["findings"]] == [one["id"] for one in document["findings"]]
    assert answer["findings"] == sum(not (one["dismissed"] or one["accepted"]) for one in document["findings"])
    hops = {(row["finding"], row["step"]) for row in tables["steps"]}
    assert len(hops) == sum(len(one["steps"]) for one in document["findings"])
    lines = {(row["file"], row["line"]) for row in tables["steps"] if row["line"]}
    assert lines == {
        (grant["file"], grant["line"])
        for one in document["findings"] for step in one["steps"] for grant in step["policy"]
    }  # fmt: skip
    assert len(tables["open"]) == sum(len(one["categories"]) for one in document["open"])
    assert [row["name"] for row in tables["doubts"]] == [one["doubt"] for one in document["doubts"]]
    assert len(tables["carries"]) == sum(
        len(one["categories"]) + len(one["pseudonymised"]) for one in document["carries"]
    )
    for table, rows in tables.items():
        assert all([*row] == [*TABLES[table]] for row in rows), table
        assert all(type(cell) in (str, int, bool) for row in rows for cell in row.values()), table


def test_where_nothing_was_followed_the_answer_says_so() -> None:
    tables = answer_of("unlabelled").tables()
    assert not tables["findings"]
    assert tables["answer"][0]["verdict"] == "undetermined"
    assert "no data was followed" in str(tables["answer"][0]["sentence"])


def test_the_command_writes_them_beside_the_answer(cli: Cli, tmp_path: Path) -> None:
    words = (EXAMPLES / "factory" / "before.policy.xml", "-l", EXAMPLES / "factory" / "run2.labels.yaml")
    plain = cli("analyze", *words)
    for _ in range(2):  # the same again, over what is there
        done = cli("analyze", *words, "--tables", tmp_path / "made" / "tables")
        assert (done.stdout, done.returncode) == (plain.stdout, 1)
        made = {file.stem: file for file in (tmp_path / "made" / "tables").iterdir()}
        assert made.keys() == TABLES.keys()
        for name, file in made.items():
            head, *rows = csv.reader(file.read_text("utf-8").splitlines())
            assert head == [*TABLES[name]]
            assert len(rows) == len(answer_of("factory").tables()[name])
    (tmp_path / "file").write_text("")
    refused(cli("analyze", *words, "--tables", tmp_path / "file"))
    assert cli("analyze", *words, "--per-policy", "--tables", tmp_path / "other").returncode == 2
