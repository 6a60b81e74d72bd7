"""A leak, hidden in each of many ways: every output shows it or names the doubt, and CI does not pass (S11, S12).

On a robot, on a fleet, and from a database.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.cli.exit_code import FailOn, exit_code
from rosprivacy.report.sarif.rules import rule_of_doubt
from rosprivacy.report.verdict import subject
from tests.helpers.command import cli
from tests.helpers.daily import one_in
from tests.helpers.hidden_leaks import HIDDEN, Hidden, on_a_fleet, write_files

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.private_neo4j.connection import Connection
    from rosprivacy.result import Result
    from tests.helpers.command import Cli

__all__ = ["cli"]
REPORTS = ("html", "markdown", "article30", "works-council", "notice", "cnil-pia", "turtle")


def answer(hidden: Hidden) -> Result:
    """Read it as a user would; an observed robot by what ``observe`` writes."""
    if hidden.fleet:
        return rosprivacy.analyze_fleet(hidden.fleet, **hidden.more)  # type: ignore[arg-type]
    return rosprivacy.analyze(hidden.policies, hidden.labels, **hidden.more)  # type: ignore[arg-type]


def observed(hidden: Hidden, cli: Cli) -> None:
    if "g.txt" in hidden.files:
        done = cli("observe", "--text", "g.txt", "--at", "2026-11-22T10:00:00Z", "-o", "r.policy.xml")
        assert done.returncode == 0, done.stderr


def check(hidden: Hidden, result: Result) -> None:
    document = result.document()
    assert exit_code(result, (FailOn.doubt,)) != 0
    assert not hidden.breaks or exit_code(result, (FailOn.undetermined,)) != 0
    names = shown_by(hidden, document)
    sentence = document["sentence"]
    for name in names:
        assert name in sentence or hidden.shows in ("leak", "open"), sentence
        assert name in result.to("text", quiet=True) or hidden.shows in ("leak", "open")
        assert name in result.to("text")
        assert name in json.dumps(document["diagnostics"]) or hidden.shows in ("leak", "open")
        for form in REPORTS:
            assert name in plain(result.to(form)) or form == "article30" or hidden.shows == "open", form
    text = result.to("text", quiet=True)
    assert text.startswith(document["verdict"])
    assert isinstance(text, str)
    assert sentence in result.to("article30")
    results = json.loads(result.to("sarif"))["runs"][0]["results"]
    rules = {one["ruleId"] for one in results}
    if hidden.shows not in ("leak", "open"):
        assert rule_of_doubt(hidden.shows, breaks=hidden.breaks).id in rules
    assert results


def shown_by(hidden: Hidden, document: dict[str, Any]) -> list[str]:
    """What every output has to name: the place of a finding, or what is in doubt."""
    if hidden.shows == "leak":
        assert document["verdict"] == "leak"
        return [finding["leak"]["name"] for finding in document["findings"]]
    if hidden.shows == "open":
        assert document["verdict"] == "undetermined"
        return []
    doubts = [doubt for doubt in document["doubts"] if doubt["doubt"] == hidden.shows]
    assert doubts, [doubt["doubt"] for doubt in document["doubts"]]
    assert hidden.breaks == (document["verdict"] != "no-leak-found")
    return [subject(doubt) for doubt in doubts[:1] if doubt["element"] or doubt["file"]]


def plain(text: str | bytes) -> str:
    """A report with what its format writes otherwise in place."""
    assert isinstance(text, str)
    return text.replace("\\_", "_").replace("\\*", "*").replace("<wbr>", "").replace("\\u002f", "/")


def see(hidden: Hidden, folder: Path, cli: Cli) -> None:
    """What is hidden is refused, or every output shows it."""
    write_files(hidden, folder)
    observed(hidden, cli)
    if hidden.shows == "error":
        with pytest.raises(RosPrivacyError):
            answer(hidden)
    else:
        check(hidden, answer(hidden))


@pytest.mark.parametrize("name", one_in(5, HIDDEN))
def test_on_a_robot_or_a_fleet(name: str, tmp_path: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    see(HIDDEN[name], tmp_path, cli)


@pytest.mark.parametrize("name", one_in(5, [name for name, hidden in HIDDEN.items() if not hidden.fleet]))
def test_as_the_only_robot_of_a_fleet(name: str, tmp_path: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    see(on_a_fleet(HIDDEN[name]), tmp_path, cli)


@pytest.mark.database
@pytest.mark.slow
@pytest.mark.parametrize("name", list(HIDDEN))
def test_from_a_database(
    name: str, tmp_path: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch, neo4j_server: Connection
) -> None:
    """Whatever a load says, the answer from the database says, and so does the question for verdicts."""
    from rosprivacy.private_neo4j import connection

    monkeypatch.chdir(tmp_path)
    hidden = HIDDEN[name]
    write_files(hidden, tmp_path)
    observed(hidden, cli)
    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
    labels = [word for file in hidden.labels for word in ("-l", file)]
    read = ("--fleet", hidden.fleet) if hidden.fleet else (*hidden.policies, *labels, "--robot", "r1")
    done = cli("load", *read)
    if hidden.shows == "error":
        assert done.returncode == 2
        return
    assert done.returncode == 0, done.stderr
    asked = [word for kind in hidden.more.get("categories", ()) for word in ("-c", kind)]  # type: ignore[attr-defined]
    stored = cli("analyze", "--from-database", *asked, "-f", "json", "--fail-on", "doubt")
    assert stored.returncode != 0
    document = json.loads(stored.stdout)
    names = shown_by(hidden, document)
    verdicts = cli("query", "verdicts", "--format", "json").stdout
    assert document["verdict"] in verdicts or asked  # what is stored is about all kinds
    if hidden.shows not in ("leak", "open", "restricted"):
        assert all(name in verdicts for name in names), verdicts
