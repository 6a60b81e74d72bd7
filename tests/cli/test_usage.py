"""``rosprivacy diff granted observed --as usage``: policy against reality (rules S5, S6, S16)."""

from __future__ import annotations

import json
import subprocess
from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import Cli, refused
from tests.helpers.observed import AT, node_info

if TYPE_CHECKING:
    from pathlib import Path

GRANTED = """\
<policy version="0.2.0">
  <enclaves>
    <enclave path="/robot">
      <profiles>
        <profile ns="/" node="cam">
          <topics publish="ALLOW">
            <topic>/image</topic>
            <topic>/spare</topic>
            <topic>/shared</topic>
            <topic>/debug/*</topic>
          </topics>
          <actions call="ALLOW">
            <action>/spin</action>
          </actions>
        </profile>
        <profile ns="/" node="up">
          <topics subscribe="ALLOW">
            <topic>/image</topic>
          </topics>
        </profile>
        <profile ns="/" node="sleeper">
          <topics publish="ALLOW">
            <topic>/shared</topic>
          </topics>
        </profile>
      </profiles>
    </enclave>
  </enclaves>
</policy>
"""
RUNS = node_info("/cam", publishers="/image: s/msg/I; /debug/a: s/msg/D", action_clients="/spin: t/action/Spin")
READS = node_info("/up", subscribers="/image: s/msg/I")


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "granted.xml").write_text(GRANTED, "utf-8")
    return tmp_path


def usage(cli: Cli, robot: Path, text: str, *more: str) -> tuple[int, dict[str, object]]:
    (robot / "graph.txt").write_text(text, "utf-8")
    for file in robot.glob("seen.*"):  # of a look before, which nobody writes over
        file.unlink()
    done = cli("observe", "--text", "graph.txt", "--at", AT, "-o", "seen.policy.xml", cwd=robot)
    assert done.returncode == 0, done.stderr
    done = cli("diff", "granted.xml", "seen.policy.xml", "--as", "usage", "-f", "json", *more, cwd=robot)
    return done.returncode, json.loads(done.stdout)


def names(rows: object) -> list[str]:
    assert isinstance(rows, list)
    return [f"{row['node']} {row['role']} {row['name']}" for row in rows]


def test_all_that_runs_is_granted(cli: Cli, robot: Path) -> None:
    code, document = usage(cli, robot, RUNS + READS)
    assert code == 0
    assert document["not_granted"] == []
    assert names(document["unused"]) == ["/cam publish /shared", "/cam publish /spare"]
    assert document["never_seen"] == [{"node": "/sleeper", "grants": 1}]


def test_what_runs_and_is_not_granted_ends_with_1(cli: Cli, robot: Path) -> None:
    more = node_info("/up", subscribers="/image: s/msg/I", publishers="/leak: s/msg/I") + node_info("/new")
    code, document = usage(cli, robot, RUNS + more + node_info("/new", publishers="/image: s/msg/I"))
    assert code == 1
    rows = document["not_granted"]
    assert names(rows) == ["/new publish /image", "/up publish /leak"]
    assert isinstance(rows, list)
    assert [row["why"] for row in rows] == ["no-profile", "not-granted"]
    assert rows[0]["seen"] == {"by": ["text"], "first": AT, "last": AT}


def test_what_is_denied_and_runs_names_the_line(cli: Cli, robot: Path) -> None:
    denied = GRANTED.replace(
        '<topics subscribe="ALLOW">',
        '<topics publish="DENY">\n            <topic>/im*</topic>\n          </topics>\n'
        '          <topics subscribe="ALLOW">',
    )
    (robot / "granted.xml").write_text(denied, "utf-8")
    code, document = usage(cli, robot, RUNS + READS)
    assert code == 1
    rows = document["not_granted"]
    assert isinstance(rows, list)
    assert [(row["name"], row["why"], row["denied_by"]) for row in rows] == [
        ("/image", "denied", [{"file": "granted.xml", "line": 18}])
    ]


def test_only_the_enclave_grants_it(cli: Cli, robot: Path) -> None:
    """Rule S6: DDS holds /up to what any profile of its enclave may."""
    text = RUNS + node_info("/up", publishers="/spare: s/msg/S", subscribers="/image: s/msg/I")
    assert names(usage(cli, robot, text)[1]["not_granted"]) == ["/up publish /spare"]
    assert usage(cli, robot, text, "--view", "enforced")[0] == 0


def test_the_patch_denies_what_was_never_seen_and_takes_nothing_else(cli: Cli, robot: Path) -> None:
    """/shared is a line of a node that was not seen: a DENY holds for the enclave, so it stays (rule S5)."""
    code, document = usage(cli, robot, RUNS + READS, "--patch", "least.diff")
    assert code == 0
    rows = document["unused"]
    assert isinstance(rows, list)
    assert {row["name"]: row["in_patch"] for row in rows} == {"/shared": False, "/spare": True}
    subprocess.run(["git", "apply", "least.diff"], cwd=robot, check=True)
    code, again = usage(cli, robot, RUNS + READS)
    assert (code, again["patch"]) == (0, "")
    assert names(again["unused"]) == ["/cam publish /shared"]


def test_a_patch_that_adds_lines_leaves_nothing_to_deny_again(cli: Cli, robot: Path) -> None:
    """S5: an ALLOW that a DENY overrides grants nothing, wherever both stand."""
    two_roles = GRANTED.replace('<topics publish="ALLOW">', '<topics publish="ALLOW" subscribe="ALLOW">', 1)
    (robot / "granted.xml").write_text(two_roles, "utf-8")
    usage(cli, robot, RUNS + READS, "--patch", "least.diff")
    subprocess.run(["git", "apply", "least.diff"], cwd=robot, check=True)
    assert 'publish="DENY"' in (robot / "granted.xml").read_text("utf-8")
    code, again = usage(cli, robot, RUNS + READS)
    assert (code, again["patch"]) == (0, "")
    assert "/cam publish /spare" not in names(again["unused"])


@pytest.mark.parametrize("silent", ["/sleeper", "/up"])
def test_a_gap_leaves_it_undetermined_and_nothing_is_proposed(cli: Cli, robot: Path, silent: str) -> None:
    """S16: what a node reads that did not answer is not known; its lines in a patch would stop the robot."""
    text = RUNS + (READS if silent != "/up" else "")
    code, document = usage(cli, robot, f"{text}{silent}\n", "--patch", "least.diff")
    assert (code, bool(document["gaps"]), document["patch"]) == (4, True, "")
    assert str(document["why_no_patch"]).startswith("the observation has gaps")
    rows = document["unused"]
    assert isinstance(rows, list)
    assert not any(row["in_patch"] for row in rows)
    assert ("/up subscribe /image" in names(rows)) == (silent == "/up")


def test_a_node_of_which_all_is_denied_is_granted_nothing(cli: Cli, robot: Path) -> None:
    denied = GRANTED.replace('node="sleeper">', 'node="sleeper"><topics publish="DENY"><topic>/shared</topic></topics>')
    (robot / "granted.xml").write_text(denied, "utf-8")
    _, document = usage(cli, robot, RUNS + READS)
    assert document["never_seen"] == [{"node": "/sleeper", "grants": 0}]
    assert names(document["unused"]) == ["/cam publish /spare"]


def test_of_hidden_names_a_text_without_them_proves_nothing(cli: Cli, robot: Path) -> None:
    """`ros2 node info` leaves hidden names out unless it is asked for them: they may be in use (rule S16)."""
    hidden = GRANTED.replace("<topic>/spare</topic>", "<topic>/spare</topic>\n            <topic>/cam/_raw</topic>")
    (robot / "granted.xml").write_text(hidden, "utf-8")
    _, document = usage(cli, robot, RUNS + READS)
    rows = {row["name"]: (row["in_patch"], row.get("hidden")) for row in document["unused"]}  # type: ignore[attr-defined]
    assert rows == {"/shared": (False, None), "/spare": (True, None), "/cam/_raw": (False, True)}
    assert "/cam/_raw" not in [line.strip() for line in str(document["patch"]).splitlines() if line.startswith("+")]
    text = cli("diff", "granted.xml", "seen.policy.xml", "--as", "usage", cwd=robot).stdout
    assert "; a text without `ros2 node info --include-hidden` has no hidden names: it is not in the patch" in text
    _, document = usage(cli, robot, RUNS + READS + node_info("/more", publishers="/more/_seen: s/msg/I"))
    rows = {row["name"]: (row["in_patch"], row.get("hidden")) for row in document["unused"]}  # type: ignore[attr-defined]
    assert rows["/cam/_raw"] == (True, None)


def test_the_second_has_to_be_an_observation(cli: Cli, robot: Path) -> None:
    usage(cli, robot, RUNS)
    done = cli("diff", "seen.policy.xml", "granted.xml", "--as", "usage", cwd=robot)
    assert "granted.xml: was not made of an observation; name the policies first" in refused(done)[0]
