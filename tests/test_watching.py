"""What ``observe --watch`` tells of findings, look by look (rules S15, S16)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.settings import Settings
from rosprivacy.watching import Watch
from tests.helpers.observed import endpoint, saw

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rosprivacy.ingest.running.observation import Observation, ObservedEndpoint

BOOL, IMAGE = "std_msgs/msg/Bool", "sensor_msgs/msg/Image"
LABELS = "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /uplink: {leak: [Video]}\n"
LEAKS = "Video: /camera -> /flag -> /uplink"
KNOWN = (
    endpoint("/camera", "publish", "/flag", BOOL, key="c"),
    endpoint("/uplink", "subscribe", "/flag", BOOL, key="u"),
)


def findings(folder: Path, *looks: Observation, **settings: str | None) -> Iterator[list[str]]:
    """The findings that each look makes new."""
    (folder / "labels.yaml").write_text(LABELS, "utf-8")
    watch, before = Watch((str(folder / "labels.yaml"),), Settings(**settings)), None  # type: ignore[arg-type]
    for now in looks:
        yield [line.partition("]: ")[2] for line in watch.lines(before, now) if "! new finding" in line]
        before = now


def test_what_a_type_cannot_carry_is_no_finding(tmp_path: Path) -> None:
    assert list(findings(tmp_path, saw(*KNOWN))) == [[]]


def test_limits_of_types_can_be_switched_off(tmp_path: Path) -> None:
    assert list(findings(tmp_path, saw(*KNOWN), type_limits=None)) == [[LEAKS]]


@pytest.mark.parametrize(
    "new",
    [
        endpoint("/odd", "publish", "/flag", key="o"),
        endpoint("/odd", "publish", "/flag", IMAGE, key="o"),
        endpoint("", "publish", "/flag", key="p", participant="0a"),
        endpoint("/camera", "publish", "/flag", key="d"),
    ],
    ids=["a node of unknown type", "of another type", "a participant of unknown type", "the same node once more"],
)
def test_a_writer_of_which_the_type_does_not_close_it_opens_it(tmp_path: Path, new: ObservedEndpoint) -> None:
    """S15: what a type cannot carry holds only where the type of every writer is known, and all exclude it."""
    assert list(findings(tmp_path, saw(*KNOWN), saw(*KNOWN, new), saw(*KNOWN))) == [[], [LEAKS], []]


def test_a_new_reader_of_unknown_type_opens_nothing(tmp_path: Path) -> None:
    assert list(findings(tmp_path, saw(*KNOWN), saw(*KNOWN, endpoint("/odd", "subscribe", "/flag", key="o")))) == [
        [],
        [],
    ]
