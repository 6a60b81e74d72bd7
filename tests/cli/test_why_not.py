"""``why-not`` and the ledger, by the command: where data's way ends, and on whose word (rules S5, S7, S8, S11)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.command import cli

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]

POLICY = """<policy version="0.2.0"><enclaves>
<enclave path="/cam"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>/video</topic><topic>/still</topic></topics>
</profile></profiles></enclave>
<enclave path="/blur"><profiles><profile ns="/" node="blur">
<topics subscribe="ALLOW"><topic>/video</topic></topics>
<topics publish="ALLOW"><topic>/clean</topic></topics>
</profile></profiles></enclave>
<enclave path="/up"><profiles><profile ns="/" node="uplink">
<topics subscribe="ALLOW"><topic>{reads}</topic></topics>
<topics subscribe="DENY"><topic>{denied}</topic></topics>
</profile></profiles></enclave>
</enclaves></policy>
"""
LABELS = """labels: 1
nodes:
  /camera: {source: [Video]}
  /blur: {sanitizer: {Video: drop}}
  /uplink: {leak: [Video]}
channels:
  /video: sensitive
  /still: sensitive
  /clean: sensitive
"""
SYSTEM = ("p.xml", "-l", "l.yaml")
DENY, CLEANED = ("deny", "/still", "p.xml:11"), ("sanitizer", "/blur", "l.yaml:4")


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    written(POLICY, "/clean</topic><topic>/still", "/still", LABELS)


def written(policy: str, reads: str, denied: str, labels: str) -> None:
    Path("p.xml").write_text(policy.format(reads=reads, denied=denied), "utf-8")
    Path("l.yaml").write_text(labels, "utf-8")


def ledger(cli: Cli, *more: str) -> dict[str, dict[str, Any]]:
    """What was taken away, by what took it."""
    document = json.loads(cli("analyze", *SYSTEM, "-f", "json1", *more).stdout)
    return {row["by"]: row for row in document["taken_away"]}


def answer(cli: Cli, *ends: str) -> tuple[bool, list[tuple[str, str, str]]]:
    """Whether there is a finding; and each obstacle: what it is, at which element, by which line."""
    (only,) = json.loads(cli("why-not", *ends, *SYSTEM, "-f", "json").stdout)["answers"]
    return only["finding"] is not None, [
        (row["by"], row["element"]["name"], "".join(f"{place['file']}:{place['line']}" for place in row["places"]))
        for row in only["obstacles"]
    ]


def test_the_ledger_names_what_closed_the_path_and_on_whose_word(cli: Cli) -> None:
    rows = ledger(cli)
    assert rows["deny"]["places"] == [{"file": "p.xml", "line": 11}]
    assert (rows["deny"]["element"]["name"], rows["deny"]["to"]["name"]) == ("/still", "/uplink")
    assert rows["deny"]["leak"]["name"] == "/uplink"
    assert rows["sanitizer"]["places"] == [{"file": "l.yaml", "line": 4}]
    assert rows["sanitizer"]["leak"]["name"] == "/uplink"
    assert "2 of these closed a path to a leak" in cli("analyze", *SYSTEM).stdout


def test_a_label_that_closes_several_in_a_row_is_opened_as_a_whole(cli: Cli) -> None:
    """Neither of the two alone lets data through; the line that says both does."""
    labels = LABELS.replace("  /video: sensitive\n", "").replace("  /clean: sensitive\n", "")
    Path("l.yaml").write_text(labels.replace("drop", "pseudonymise") + '  "/[vc]*": mundane\n', "utf-8")
    row = ledger(cli)["mundane"]
    assert row["glob"]
    assert (row["element"]["name"], row["leak"]["name"]) == ("/video", "/uplink")


def test_what_was_not_asked_about_is_told(cli: Cli) -> None:
    Path("l.yaml").write_text(LABELS.replace("source: [Video]", "source: [Video, Voice]"), "utf-8")
    row = ledger(cli, "-c", "Voice")["restriction"]
    assert (row["categories"], row["leak"]) == (["Video"], None)


@pytest.mark.parametrize("denied", ["/still", "/s*"])
def test_a_deny_within_a_wildcard_or_of_a_whole_one_stands_in_the_ledger(cli: Cli, denied: str) -> None:
    """Rule S4: the flow from the name to the wildcard is what the DENY takes away."""
    written(POLICY, "/s*", denied, LABELS.replace("  /clean: sensitive\n", ""))
    row = ledger(cli)["deny"]
    assert row["leak"]["name"] == "/uplink"
    assert row["places"] == [{"file": "p.xml", "line": 11}]
    if denied == "/still":
        assert (row["element"]["name"], row["to"]["name"]) == ("/still", "/s*")
        assert answer(cli, "/camera", "/uplink") == (False, [DENY])


@pytest.mark.parametrize(
    ("reads", "edits", "ends", "finding", "obstacles"),
    [
        ("/clean</topic><topic>/still", {}, ("/camera", "/uplink"), False, [DENY]),  # the fewest; as many by /blur
        ("/clean", {}, ("/camera", "/uplink"), False, [CLEANED]),
        ("/clean", {"{leak: [Video]}": "conduit", "drop": "pseudonymise"}, ("/camera", "/uplink"), False,
         [CLEANED, ("no-leak", "/uplink", "")]),
        ("/clean", {"{leak: [Video]}": "conduit", "drop": "pseudonymise"}, ("/blur", "/uplink"), False,
         [("no-source", "/blur", ""), ("no-leak", "/uplink", "")]),
        ("/clean", {"{sanitizer: {Video: drop}}": "conduit"}, ("/camera", "/uplink"), True, []),
        ("/clean", {}, ("/uplink", "/camera"), False, []),  # no chain of policy lines leads there
        ("/still", {"source: [Video]": "source: {Video: [/video]}"}, ("/camera", "/uplink"), False,
         [("other-channels", "/camera", "")]),
        ("/still", {"channels:": "flows: [{from: /still, to: /uplink, never: [Video]}]\nchannels:"},
         ("/camera", "/uplink"), False, [("never", "/still", "l.yaml:6")]),
    ],
    ids=["denied", "cleaned", "no leak", "no source", "gets there", "no chain", "other channel", "closed flow"],
)  # fmt: skip
def test_the_path_with_the_fewest_obstacles_is_told(
    cli: Cli,
    reads: str,
    edits: dict[str, str],
    ends: tuple[str, str],
    finding: bool,  # noqa: FBT001 - a column of the table
    obstacles: list[tuple[str, str, str]],
) -> None:
    labels = LABELS
    for old, new in edits.items():
        labels = labels.replace(old, new)
    written(POLICY, reads, "/other", labels)
    if DENY in obstacles:
        written(POLICY, reads, "/still", labels)
    assert answer(cli, *ends) == (finding, obstacles)


def test_a_kind_that_nothing_emits_is_an_error(cli: Cli) -> None:
    """Of a name that is not there ``test_hints.py`` tells."""
    done = cli("why-not", "/camera", "/uplink", *SYSTEM, "-c", "Voice")
    assert done.returncode == 2
    assert "no source or derivation emits 'Voice'; emitted are: Video" in done.stderr
