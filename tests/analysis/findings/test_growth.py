"""What a finding costs does not grow with the other findings of a system (rule S10)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import rosprivacy
from rosprivacy.analysis.kernel.search import Search, present
from tests.helpers.reports import policy

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

SIDE = 3


def looked_at(islands: int, folder: Path, monkeypatch: pytest.MonkeyPatch) -> float:
    """How often a leak is looked at for each finding, of islands with sources and leaks of their own."""
    profiles: dict[str, tuple[list[str], list[str]]] = {}
    for island in range(islands):
        profiles |= {f"s{island}_{i}": ([f"t{island}"], []) for i in range(SIDE)}
        profiles |= {f"l{island}_{i}": ([], [f"t{island}"]) for i in range(SIDE)}
    (folder / "p.xml").write_text(policy(profiles), "utf-8")
    (folder / "l.yaml").write_text("labels: 1\nnodes:\n  /s*: {source: [Video]}\n  /l*: {leak: [Video]}\n", "utf-8")
    looks = 0

    def counting(reach: Search, vertex: int) -> int:
        nonlocal looks
        looks += 1
        return present(reach, vertex)

    with monkeypatch.context() as patch:
        patch.setattr("rosprivacy.analysis.findings.findings.present", counting)
        found = rosprivacy.analyze(str(folder / "p.xml"), str(folder / "l.yaml")).findings
    assert len(found) == islands * SIDE**2
    return looks / len(found)


def test_a_source_is_not_compared_with_each_leak_of_the_system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """At e6bf35d 10 looks for a finding of 5 islands, 45 of 40 islands."""
    assert looked_at(40, tmp_path, monkeypatch) == looked_at(5, tmp_path, monkeypatch)
