"""``only: by-type`` (rules S7, S11, S15): on random systems, word for word."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
import yaml
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.model import BY_TYPE_CLOSES
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.labelling.by_type_lines import with_lines_by_type
from rosprivacy.report.json_text import as_text
from rosprivacy.settings import Settings
from tests.helpers.typed_systems import CHANNELS, KINDS, MORE, NODES, WILD, System, found, overlap, some, systems

MADE_FOR: dict[str, set[str]] = {"a/msg/A": set(), "a/msg/B": {"FaceImage"}}  # a/msg/C is in no table


@dataclass
class Lines(System):
    """A random system with lines at some of its channels, of which the type may be known."""

    lines: set[str] = field(default_factory=set)

    def write(self) -> None:
        super().write()
        labels = yaml.safe_load(Path("l.yaml").read_text("utf-8"))
        for channel in self.held():
            labels["channels"].setdefault(channel, {})["only"] = "by-type"
        Path("l.yaml").write_text(as_text(labels), "utf-8")
        entry = "  - {{types: [{}], kinds: [{}], {}why: a test, source: this file}}\n"
        rows = (entry.format(k, ", ".join(v), "confidence: may, " if v else "") for k, v in MADE_FOR.items())
        Path("table.yaml").write_text("type_table: 1\nsuggests:\n" + "".join(rows), "utf-8")

    def held(self) -> set[str]:
        """Channels with a line: ``only`` of kinds stands in its place."""
        return {c for c in self.lines & self.there() if self.said.get(c, ("", []))[0] != "only"}

    def readers(self, channel: str) -> list[str]:
        return [n for n in NODES if channel in self.reads[n] or self.wild(n, channel)]

    def certain(self, channel: str) -> bool:
        """Whether the type of all that comes to a channel is known, and the table says what it is made for."""
        types = [*self.stated.get(channel, []), *(name for name, _ in self.seen.get(channel, []))]
        if not types or not all(name in MADE_FOR for name in types):
            return False
        if self.stated.get(channel):
            return True
        return all(
            by_name and not (WILD in self.writes[writer] and channel.startswith("/t"))
            and any(writer in by for _, by in self.seen.get(channel, []))
            for writer, by_name in self.writers(channel).items()
        )  # fmt: skip

    def limited(self, channel: str, kind: str) -> bool:
        """Whether the line alone closes a kind."""
        if channel not in self.held() or not self.certain(channel) or self.named(channel, kind):
            return False
        types = {*self.stated.get(channel, []), *(name for name, _ in self.seen.get(channel, []))}
        return not any(overlap(one, kind) for name in types for one in MADE_FOR[name])

    def named(self, channel: str, kind: str) -> bool:
        """Whether a person names the kind at the channel, or at a node that writes or reads it."""
        for writer in self.writers(channel):
            through = self.sources.get(writer, {}).get(kind)
            if through is not None and (not through or channel in through):
                return True
            if kind in {to for _, to in self.derives[writer]}:
                return True
        for reader in self.readers(channel):
            of = [*self.leaks.get(reader, []), *(a for a, _ in self.derives[reader])]
            if any(overlap(one, kind) for one in of):
                return True
        return self.said.get(channel, ("", []))[0] == "sensitive"


@st.composite
def chains(draw: st.DrawFn) -> System:
    """A source and a leak with two nodes between them, of which nobody says a kind: only lines can close the way."""
    silent = {node: set[str]() for node in NODES}
    kind, names = draw(st.sampled_from(KINDS)), draw(st.permutations(CHANNELS))[:3]
    return System(
        {**silent, **{node: {name} for node, name in zip(NODES, names, strict=False)}},
        {**silent, **{node: {name} for node, name in zip(NODES[1:], names, strict=True)}},
        {NODES[0]: {kind: []}}, {NODES[-1]: [kind]}, {node: [] for node in NODES}, {},
        {name: draw(some((*MADE_FOR, "a/msg/C"), 2, 1)) for name in names},
    )  # fmt: skip


@st.composite
def lined(draw: st.DrawFn) -> Lines:
    system = draw(st.one_of(systems(), chains()))
    if draw(st.integers(0, 3)):  # most types are in the table
        system.stated = {c: [one for one in names if one in MADE_FOR] for c, names in system.stated.items()}
        system.seen = {c: [one for one in seen if one[0] in MADE_FOR] for c, seen in system.seen.items()}
    return Lines(**vars(system), lines=set(draw(some(CHANNELS, 3, 1))))


def answer(system: System, **more: Any) -> Any:
    system.write()
    try:
        return rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml", type_limits="table.yaml", **MORE, **more)
    except rosprivacy.InputErrors:  # labels that contradict each other
        assume(False)


@given(lined())
@settings(max_examples=3 * settings().max_examples)
def test_random_systems_follow_the_rule_word_for_word(system: Lines) -> None:
    with TemporaryDirectory() as folder, chdir(folder):
        result = answer(system)
        assert found(result) == system.findings(limits=True)
        doubted = {one.element.name for one in result.doubts if one.name == BY_TYPE_CLOSES}
        assert doubted <= {channel for channel in system.held() if system.certain(channel)}
        if system.findings(limits=False) != system.findings(limits=True):
            assert doubted  # a way that only such lines close is never silent
        open_channels = {question.element.name for question in result.analysis.open}
        assert not open_channels & {channel for channel in system.held() if system.certain(channel)}


@given(lined())
def test_what_the_lines_say_of_uncertain_types_is_what_no_line_says(system: Lines) -> None:
    """Each line that does not hold is told, and its channel is as open as without it."""
    with TemporaryDirectory() as folder, chdir(folder):
        system.lines = {channel for channel in system.held() if not system.certain(channel)}
        result = answer(system)
        lines = len(system.held())
        assert sum(one.name == "by-type-open" for one in result.doubts) == lines
        system.lines = set()
        without = answer(system)
        assert (found(result), result.analysis.open) == (found(without), without.analysis.open)


@given(lined())
def test_lines_that_are_accepted_together_close_no_finding_and_no_doubt_of_a_leak(system: Lines) -> None:
    """The one key for all such leaves out what would close a way."""
    with TemporaryDirectory() as folder, chdir(folder):
        system.lines = set()
        before = answer(system)
        asked = Settings(types=("t.yaml",), type_limits="table.yaml", ontologies=("own.ttl",))
        Path("l.yaml").write_text(with_lines_by_type(("p.xml",), ("l.yaml",), "Ada", asked).text, "utf-8")
        after = rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml", type_limits="table.yaml", **MORE)
        assert found(after) == found(before)
        assert not {one.name for one in after.doubts} & {"by-type-open", "by-type-lapsed", "by-type-unpinned"}


@pytest.mark.slow
def test_many_lines_close_something_and_some_findings_only_they() -> None:
    """Else the tests here would compare answers without lines that hold."""
    counts = {"holds": 0, "closes": 0, "all": 0}

    @settings(max_examples=150, derandomize=True, database=None, phases=[Phase.generate], deadline=None)
    @given(lined())
    def take(system: Lines) -> None:
        counts["all"] += 1
        counts["holds"] += any(map(system.certain, system.held()))
        counts["closes"] += system.findings(limits=True) != system.findings(limits=False)

    take()
    assert counts["holds"] > counts["all"] / 4
    assert counts["closes"] > 0


def test_two_lines_in_a_row_are_both_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each alone would still be closed by the other: all lines are opened together."""
    monkeypatch.chdir(tmp_path)
    silent = {node: set[str]() for node in NODES}
    system = Lines(
        {**silent, "/n0": {"/u3"}, "/n1": {"/t0"}, "/n2": {"/t1"}},
        {**silent, "/n1": {"/u3"}, "/n2": {"/t0"}, "/n3": {"/t1"}},
        {"/n0": {"Video": ["/u3"]}}, {}, {node: [] for node in NODES},
        {}, {"/t0": ["a/msg/A"], "/t1": ["a/msg/A"]}, lines={"/t0", "/t1"},
    )  # fmt: skip
    result = answer(system)
    assert [one.element.name for one in result.doubts if one.name == BY_TYPE_CLOSES] == ["/t0", "/t1"]
