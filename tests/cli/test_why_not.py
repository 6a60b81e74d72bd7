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
<topics subscribe="ALLOW"><topic>/clean</topic><topic>/still</topic></topics>
<topics subscribe="DENY"><topic>/still</topic></topics>
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


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(POLICY, "utf-8")
    Path("l.yaml").write_text(LABELS, "utf-8")


def taken(cli: Cli, *more: str) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = json.loads(cli("analyze", "p.xml", "-l", "l.yaml", "-f", "json1", *more).stdout)[
        "taken_away"
    ]
    return rows


def test_the_ledger_names_what_closed_the_path_and_on_whose_word(cli: Cli) -> None:
    rows = {row["by"]: row for row in taken(cli)}
    assert rows["deny"]["places"] == [{"file": "p.xml", "line": 11}]
    assert (rows["deny"]["element"]["name"], rows["deny"]["to"]["name"]) == ("/still", "/uplink")
    assert rows["deny"]["leak"]["name"] == "/uplink"
    assert rows["sanitizer"]["places"] == [{"file": "l.yaml", "line": 4}]
    assert rows["sanitizer"]["leak"]["name"] == "/uplink"


def test_assumed_counts_it_and_v_lists_it(cli: Cli) -> None:
    done = cli("analyze", "p.xml", "-l", "l.yaml")
    assert done.returncode == 0
    assert "taken away on the data's side: 1 flow by a DENY, 1 sanitizer, " in done.stdout
    assert "2 of these closed a path to a leak or an open element (-v lists them)" in done.stdout
    told = cli("analyze", "p.xml", "-l", "l.yaml", "-v").stdout
    assert "Video at /still -> /uplink: denied at p.xml:11; without it data gets to the leak /uplink" in told
    assert "Video at /blur: cleaned at l.yaml:4; without it data gets to the leak /uplink" in told


def test_a_label_that_closes_several_in_a_row_is_opened_as_a_whole(cli: Cli) -> None:
    """Neither of the two alone lets data through; the line that says both does."""
    labels = LABELS.replace("  /video: sensitive\n", "").replace("  /clean: sensitive\n", "")
    Path("l.yaml").write_text(labels.replace("drop", "pseudonymise") + '  "/[vc]*": mundane\n', "utf-8")
    row = next(row for row in taken(cli) if row["by"] == "mundane")
    assert row["glob"]
    assert (row["element"]["name"], row["leak"]["name"]) == ("/video", "/uplink")


def test_what_was_not_asked_about_is_told(cli: Cli) -> None:
    Path("l.yaml").write_text(LABELS.replace("source: [Video]", "source: [Video, Voice]"), "utf-8")
    rows = [row for row in taken(cli, "-c", "Voice") if row["by"] == "restriction"]
    assert [(row["categories"], row["leak"]) for row in rows] == [(["Video"], None)]


def test_why_not_tells_the_path_with_the_fewest_words_in_its_way(cli: Cli) -> None:
    done = cli("why-not", "/camera", "/uplink", "p.xml", "-l", "l.yaml")
    assert done.returncode == 0
    assert done.stdout == (
        "Video from /camera to /uplink: it does not get there; of all paths this one has the fewest obstacles (1)\n"
        "   /camera -> /still -> /uplink\n"
        "   at /still -> /uplink: deny for Video, p.xml:11\n"
        "   as things are, Video gets to 4 elements\n"
    )


def test_why_not_names_the_sanitizer_where_no_line_is_denied(cli: Cli) -> None:
    Path("p.xml").write_text(POLICY.replace("<topic>/still</topic>", ""), "utf-8")
    Path("p.xml").write_text(Path("p.xml").read_text().replace('<topics subscribe="DENY"></topics>', ""), "utf-8")
    Path("l.yaml").write_text(LABELS.replace("  /still: sensitive\n", ""), "utf-8")
    answer = json.loads(cli("why-not", "/camera", "/uplink", "p.xml", "-l", "l.yaml", "-f", "json").stdout)["answers"][
        0
    ]
    assert [(o["by"], o["element"]["name"], o["places"]) for o in answer["obstacles"]] == [
        ("sanitizer", "/blur", [{"file": "l.yaml", "line": 4}])
    ]


def test_why_not_says_where_labels_are_silent(cli: Cli) -> None:
    Path("l.yaml").write_text(LABELS.replace("{leak: [Video]}", "conduit").replace(" drop", " pseudonymise"), "utf-8")
    told = cli("why-not", "/camera", "/uplink", "p.xml", "-l", "l.yaml").stdout
    assert "at /uplink: no label says that it lets Video out" in told
    told = cli("why-not", "/blur", "/uplink", "p.xml", "-l", "l.yaml").stdout
    assert "at /blur: no label says that it brings in Video" in told


def test_why_not_of_what_does_get_there_names_the_finding(cli: Cli) -> None:
    Path("l.yaml").write_text(LABELS.replace("{sanitizer: {Video: drop}}", "conduit"), "utf-8")
    told = cli("why-not", "/camera", "/uplink", "p.xml", "-l", "l.yaml").stdout
    assert told.startswith("Video from /camera to /uplink: it gets there, finding ")


def test_why_not_without_any_chain_of_lines_says_so(cli: Cli) -> None:
    told = cli("why-not", "/uplink", "/camera", "p.xml", "-l", "l.yaml").stdout
    assert told.startswith("Video from /uplink to /camera: no chain of policy lines or stated flows leads there\n")


def test_a_name_that_is_not_there_is_an_error_with_the_nearest(cli: Cli) -> None:
    done = cli("why-not", "/camra", "/uplink", "p.xml", "-l", "l.yaml")
    assert done.returncode == 2
    assert "no element is called '/camra'; did you mean /camera" in done.stderr
    done = cli("why-not", "/camera", "/uplink", "p.xml", "-l", "l.yaml", "-c", "Voice")
    assert done.returncode == 2
    assert "no source or derivation emits 'Voice'; emitted are: Video" in done.stderr


def test_a_deny_that_takes_a_name_out_of_a_wildcard_stands_in_the_ledger(cli: Cli) -> None:
    """Rule S4: the flow from the name to the wildcard is what the DENY takes away."""
    Path("p.xml").write_text(
        POLICY.replace(
            "<topic>/clean</topic><topic>/still</topic></topics>\n<topics subscribe",
            "<topic>/s*</topic></topics>\n<topics subscribe",
        ),
        "utf-8",
    )
    Path("l.yaml").write_text(LABELS, "utf-8")
    row = next(row for row in taken(cli) if row["by"] == "deny")
    assert (row["element"]["name"], row["to"]["name"], row["leak"]["name"]) == ("/still", "/s*", "/uplink")
    assert row["places"] == [{"file": "p.xml", "line": 11}]
    told = cli("why-not", "/camera", "/uplink", "p.xml", "-l", "l.yaml").stdout
    assert "at /still -> /s*: deny for Video, p.xml:11" in told


def test_a_wildcard_that_is_denied_as_a_whole_stands_in_the_ledger(cli: Cli) -> None:
    policy = POLICY.replace(
        "<topic>/clean</topic><topic>/still</topic></topics>\n<topics subscribe",
        "<topic>/s*</topic></topics>\n<topics subscribe",
    )
    Path("p.xml").write_text(policy.replace('DENY"><topic>/still', 'DENY"><topic>/s*'), "utf-8")
    rows = [row for row in taken(cli) if row["by"] == "deny"]
    assert any(row["leak"] and row["leak"]["name"] == "/uplink" for row in rows)
