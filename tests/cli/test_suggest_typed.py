"""``suggest --ask``: a label that no question offers is typed as a line; it takes nothing away."""

from __future__ import annotations

import os
import pty
import subprocess
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.labelling.asking import contradiction, typed_label, with_label
from rosprivacy.settings import Settings
from tests.helpers.asked_by_keys import COMMAND, by_keys, read_until, robot_of, text_of, wait_for_keys
from tests.helpers.command import cli
from tests.helpers.little_robots import policy_of

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.asked_by_keys import ByKeys
    from tests.helpers.little_robots import Nodes

__all__ = ["by_keys", "cli"]

NODES: Nodes = {"lidar": (["/points"], []), "finder": (["/found"], ["/points"]), "end": ([], ["/found", "/points"])}
HEAD = "labels: 1\nauthor: Ada\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return robot_of(tmp_path, NODES, HEAD)


def test_another_kind_than_the_one_that_is_asked_about(robot: Path, by_keys: ByKeys) -> None:
    """What is still to be asked comes again, and what the new source reaches is asked about."""
    done = by_keys(robot, "/lidar node source Location Voice\nn")
    assert done.returncode == 0
    assert "Which of these bring such data in?\n  A  node /lidar: PersonPointCloud\n" in done.stdout
    assert "Does it bring such data in?\n  node /lidar: PersonPointCloud\n" in done.stdout
    assert "What do these do with Location and Voice?\n  A  node /finder\n" in done.stdout
    assert '  /lidar: {source: [Location, Voice], note: "typed by Ada on 2026-01-01"}\n' in text_of(robot)


def test_what_a_node_lets_out_and_makes(robot: Path, by_keys: ByKeys) -> None:
    lines = ("/lidar node source Video", "/finder node derives Video FaceTemplate", "/end node leak FaceTemplate Video")
    by_keys(robot, "\n".join(lines) + "\n")
    findings = rosprivacy.analyze(str(robot / "p.xml"), str(robot / "l.yaml")).analysis.findings
    ends = {(one.category, one.source.name, one.leak.name) for one in findings}
    assert ends == {("Video", "/lidar", "/end"), ("FaceTemplate", "/lidar", "/end")}


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("/lidra node source Location", "no node is called '/lidra'; did you mean /lidar?"),
        ("/lidar node source Locations", "unknown category 'Locations'; did you mean Location"),
        ("/lidar node source Video {x}", "unknown category '{x}'"),
        ("/lidar node derives Video Vidoe", "unknown category 'Vidoe'; did you mean Video"),
        ("/lidar node derives Video", ""),
        ("/lidar node derives Video Video", ""),
        ("/lidar node derives Video Voice Location", ""),
        ("/lidar node source", ""),
        ("/lidar node conduit Video", ""),
        ("/lidar node sanitizer Video drop", ""),
        ("/points topic never Video", ""),
        ("/points topic source Video", ""),
        ("/", ""),
    ],
)
def test_a_line_that_is_no_label_writes_nothing_and_no_more_keys_are_read(
    robot: Path, by_keys: ByKeys, line: str, why: str
) -> None:
    done = by_keys(robot, f"{line}\ny")
    said = next(told for told in done.stdout.splitlines() if "no answer here" in told)
    assert f"'{line}' is no answer here: {why}" in said
    assert said.endswith("the keys are out of step with the questions, and no more are read")
    assert text_of(robot) == HEAD


@pytest.mark.parametrize(
    ("said", "line", "told"),
    [
        (
            "conduit: [Location]",
            "source Location",
            "/lidar is source for Location here and conduit at l.yaml:4; keep one of them",
        ),
        (
            "sanitizer: {Biometric: drop}",
            "derives PersonalData Biometric",
            "/lidar is derives Biometric from PersonalData for Biometric here and sanitizer (drop) at l.yaml:4",
        ),
    ],
)
def test_what_contradicts_the_file_is_not_written(
    robot: Path, by_keys: ByKeys, said: str, line: str, told: str
) -> None:
    """Else the file would be an error from then on (rule S7)."""
    before = f"{HEAD}nodes:\n  /lidar: {{{said}}}\n  /end: {{source: [FaceTemplate]}}\n"
    (robot / "l.yaml").write_text(before, "utf-8")
    done = by_keys(robot, f"/lidar node {line}\n")
    assert done.returncode == 0
    assert f"is no answer here: this label:1: {told}" in done.stdout
    assert text_of(robot) == before


def test_a_limit_on_the_way_is_told(robot: Path, by_keys: ByKeys) -> None:
    (robot / "l.yaml").write_text(f"{HEAD}topics:\n  /points: {{never: [Location]}}\n", "utf-8")
    done = by_keys(robot, "/lidar node source Location\n")
    assert "never of topic /points takes Location away, which is accepted now" in done.stdout


@pytest.mark.slow
def test_at_a_terminal_a_line_is_shown_while_it_is_typed(robot: Path) -> None:
    """A wrong one is told, and asked again."""
    ours, theirs = pty.openpty()
    with subprocess.Popen(COMMAND, cwd=robot, stdin=theirs, stdout=theirs, stderr=theirs) as process:
        screen = read_until(ours, b"> ")
        for line in (b"lidra node source Location\n", b"lidar node source Location\n"):
            wait_for_keys(theirs)
            os.write(ours, b"/")
            wait_for_keys(theirs, whole_lines=True)
            os.write(ours, line)
            screen += read_until(ours, b"q stop") + read_until(ours, b"> ")
        wait_for_keys(theirs)
        os.write(ours, b"q")
        screen += read_until(ours, b"tells all)")
    os.close(theirs)
    os.close(ours)
    assert process.returncode == 0
    assert b"> /lidra node source Location\r\n" in screen
    assert b"'/lidra node source Location' is no answer here: no node is called '/lidra'" in screen
    assert "  /lidar: {source: [Location], note: " in text_of(robot)


LINES = st.builds(
    lambda name, role, kinds: f"{name} node {role} {' '.join(kinds)}",
    st.sampled_from([f"/{one}" for one in NODES]),
    st.sampled_from(["source", "leak", "derives"]),
    st.lists(
        st.sampled_from(["PersonalData", "Biometric", "FaceTemplate", "Video", "Location"]), min_size=2, max_size=2
    ),
)
SAID = st.sampled_from(
    [
        "{}: conduit",
        "{}: {{conduit: [Video]}}",
        "{}: {{leak: [Biometric]}}",
        "{}: {{leak: [PersonalData]}}",
        "{}: {{source: [Video]}}",
        "{}: {{source: [PersonalData]}}",
        "{}: {{sanitizer: {{Biometric: drop}}}}",
        "{}: {{derives: [{{from: Video, to: FaceTemplate}}]}}",
    ]
)
NAMES = st.sampled_from(["/lidar", "/finder", "/end", '"/*"', "/e*"])


@given(st.lists(st.tuples(NAMES, SAID), max_size=5, unique_by=lambda one: one[0]), LINES)
def test_a_typed_label_takes_nothing_away(
    tmp_path_factory: pytest.TempPathFactory, entries: list[tuple[str, str]], line: str
) -> None:
    """No finding goes, nor does an answer become 'nothing found' by it."""
    folder = tmp_path_factory.mktemp("typed")
    policy, file = folder / "p.xml", folder / "l.yaml"
    policy.write_text(policy_of(NODES), "utf-8")
    said = "".join(f"  {one.format(name)}\n" for name, one in entries)
    file.write_text(f"{HEAD}nodes:\n  /lidar: {{source: [Video]}}\n" if not said else f"{HEAD}nodes:\n{said}", "utf-8")
    before = rosprivacy.analyze(str(policy), str(file))
    label = typed_label(line, before.analysis.graph.elements, before.vocabulary)
    if isinstance(label, str) or contradiction(label, before):
        return
    written = with_label(str(file), label, "Ada", "2026-01-01", Settings())
    file.write_text(written.text, "utf-8")
    after = rosprivacy.analyze(str(policy), str(file))
    assert {one.id for one in before.analysis.findings} <= {one.id for one in after.analysis.findings}
    assert before.analysis.verdict == "no-leak-found" or after.analysis.verdict != "no-leak-found"
