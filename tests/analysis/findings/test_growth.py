"""What a finding costs does not grow with the other findings of a system (rules S10, S12)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import rosprivacy
from rosprivacy.analysis.decisions import Choice, Decision, Decisions
from rosprivacy.analysis.decisions import decided as join
from rosprivacy.analysis.example import factory
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.kernel.search import Search, present
from rosprivacy.analysis.model import Place
from tests.helpers.reports import policy

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

    from rosprivacy.analysis.case import Case
    from rosprivacy.analysis.hierarchy import Hierarchy

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


def decided(findings: int) -> float:
    """How often an entry is looked at for each finding, where each second finding has an entry by its id."""
    looks = 0

    class Counting(Decision):
        def about(self, case: Case, hierarchy: Hierarchy) -> bool:
            nonlocal looks
            looks += 1
            return super().about(case, hierarchy)

    graph, bound, hierarchy = factory()
    found = [
        replace(finding, id=f"{number:016x}")
        for finding in analyse(graph, bound, hierarchy).findings[:1]
        for number in range(findings)
    ]
    entries = tuple(Counting(Choice.ACCEPT, Place("d.yaml", 2), id=one.id) for one in found[::2])
    joined = join(Decisions("d.yaml", "", "2026-11-22", entries, hierarchy), found, {}, everything=True)
    assert sorted(joined.on) == [one.id for one in found[::2]]
    assert joined.about == tuple((one.id,) for one in found[::2])
    return looks / findings


def test_an_entry_about_one_finding_is_not_compared_with_the_others() -> None:
    """At e6bf35d each was: 4,000 findings with 2,000 entries took 60 times as long as without."""
    assert decided(400) == decided(40)
