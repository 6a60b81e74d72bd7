"""What message types cannot carry, they do not (rule S15): on random systems, word for word."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import pytest
from hypothesis import Phase, assume, given, settings

import rosprivacy
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.ingest.policies.saved_graph import as_dict
from rosprivacy.report.json_text import as_text
from tests.helpers.typed_systems import KINDS, MORE, NODES, TYPES, System, cannot, found, systems

if TYPE_CHECKING:
    from rosprivacy.result import Result


def answers(system: System) -> tuple[Result, Result]:
    system.write()
    try:
        under = rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml", type_limits="table.yaml", **MORE)
        return under, rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml", type_limits=None, **MORE)
    except rosprivacy.InputErrors:  # labels that contradict each other
        assume(False)
        raise


@given(systems())
@settings(max_examples=8 * settings().max_examples)
def test_random_systems_follow_the_rule_word_for_word(system: System) -> None:
    with TemporaryDirectory() as folder, chdir(folder):
        under, without = answers(system)
        assert found(without) == system.findings(limits=False)
        assert found(under) == system.findings(limits=True)
        told = {(f.category, f.source.name, f.leak.name) for f in under.analysis.closed.findings} if (
            under.analysis.closed
        ) else set()  # fmt: skip
        assert told == found(without) - found(under)
        assert under.analysis.open == without.analysis.open  # it reviews nothing
        result = rosprivacy.analyze("p.xml", types="t.yaml")
        Path("g.json").write_text(as_text(as_dict(result.policies, result.diagnostics, result.types)), "utf-8")
        saved = rosprivacy.analyze(labels="l.yaml", add="g.json", type_limits="table.yaml", **MORE)
        assert saved.document() == under.document()
        enforced = rosprivacy.analyze(
            "p.xml", "l.yaml", types="t.yaml", type_limits="table.yaml", **MORE, view="enforced"
        )
        assert not enforced.analysis.closed


@pytest.mark.slow
def test_many_of_them_are_limited_and_some_findings_only_so_closed() -> None:
    """Else the tests here would compare answers without limits."""
    counts = {"limited": 0, "closed": 0, "all": 0}

    @settings(max_examples=150, derandomize=True, database=None, phases=[Phase.generate], deadline=None)
    @given(systems())
    def take(system: System) -> None:
        counts["all"] += 1
        counts["limited"] += any(system.limited(c, kind) for c in system.there() for kind in KINDS)
        counts["closed"] += system.findings(limits=True) != system.findings(limits=False)

    take()
    assert counts["limited"] > counts["all"] / 4
    assert counts["closed"] >= counts["all"] / 50


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", TYPES)
def test_each_kind_ends_at_each_type_that_cannot_carry_it(
    name: str, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The smallest system, with an open node in between, for every kind, a user's own too: random ones meet few."""
    monkeypatch.chdir(tmp_path)
    silent = {node: set[str]() for node in NODES}
    system = System(
        {**silent, "/n0": {"/t0"}, "/n1": {"/u3"}}, {**silent, "/n1": {"/t0"}, "/n2": {"/u3"}},
        {"/n0": {kind: []}}, {"/n2": [kind]}, {node: [] for node in NODES}, {}, {"/u3": [name]},
    )  # fmt: skip
    under, without = answers(system)
    assert found(without) == {(kind, "/n0", "/n2")}
    assert bool(found(under)) != cannot(name, kind)
    assert under.analysis.open == without.analysis.open
