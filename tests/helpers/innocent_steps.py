"""Leaks planted in real policies, and the lines that the program itself offers to a hurried person.

Who is told the truth about a planted leak is ``tests/helpers/brute.py``, not the program.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING, Any

import yaml

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import Place, Statement
from rosprivacy.answering import answer
from rosprivacy.cli.exit_code import FailOn, exit_code
from rosprivacy.ingest.labels.label_file import infrastructure_of, parse_labels
from rosprivacy.ingest.labels.label_template import template
from rosprivacy.question import question_of
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_system, standard_channels
from tests.helpers.brute import Brute

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path
    from random import Random

    from rosprivacy.result import Result
    from rosprivacy.system import System

BAD_INPUT = 2
INFRASTRUCTURE = "rosprivacy:infrastructure"
NODE_WORDS = (  # as the template's header offers them, for a kind of data
    "{{source: [{0}]}}", "{{leak: [{0}]}}", "{{sanitizer: {{{0}: anonymise}}}}",
    "{{derives: [{{from: {0}, to: FaceTemplate}}]}}", "conduit", "{{conduit: [{0}]}}", "{{absent: why}}",
)  # fmt: skip
CHANNEL_WORDS = ("mundane", "sensitive", "{{only: [HomeMap]}}", "{{never: [{0}]}}")
KINDS = ("Video", "Voice", "FaceTemplate", "OperatorInput")  # none of them is a map of a home, nor may be one


@dataclass(frozen=True, slots=True)
class Line:
    """A line that a person accepts: a section, a name, and a word for it; or a file of the program, without a name."""

    section: str
    name: str
    word: str


@dataclass(frozen=True, slots=True)
class Tried:
    """Where a person ends up: the exit code, and the answer, if the input is not refused."""

    code: int
    system: System | None = None
    result: Result | None = None


@dataclass(frozen=True)
class Planted:
    """A policy with what is true of it: data of a kind gets from a source to a leak."""

    file: Path
    system: System
    source: str
    leak: str
    kind: str

    @property
    def truth(self) -> tuple[Line, Line]:
        """What a person who knows the truth says of its two ends."""
        return (
            Line("nodes", self.source, NODE_WORDS[0].format(self.kind)),
            Line("nodes", self.leak, NODE_WORDS[1].format(self.kind)),
        )

    @cached_property
    def template(self) -> dict[str, Any]:
        """What ``labels --init`` writes."""
        settings, graph, vocabulary = QUESTION.settings, self.system.graph, QUESTION.vocabulary
        standard = standard_channels(graph, vocabulary, settings)
        read: dict[str, Any] = yaml.safe_load(template(graph, standard, infrastructure_of(graph.elements, vocabulary)))
        return {section: dict(names or {}) for section, names in read.items() if section != "labels"}

    @cached_property
    def offered(self) -> list[Line]:
        """Each line of the template with each word for it, and what hints propose."""
        lines = [Line("", INFRASTRUCTURE, "")]
        for section, names in self.template.items():
            words = NODE_WORDS if section == "nodes" else CHANNEL_WORDS
            lines += [Line(section, name, word.format(self.kind)) for name in names for word in words]
        return lines

    def after(self, lines: Sequence[Line], *, untouched: bool = False) -> Tried:
        """Return what the program answers to the lines, in an empty file or in the ``untouched`` template."""
        said: dict[str, Any] = {section: dict(names) for section, names in self.template.items() if untouched}
        for line in lines:
            if line.section:
                said.setdefault(line.section, {})[line.name] = yaml.safe_load(line.word)
        proposed = [line.name for line in lines if not line.section]
        assert self.system.under
        try:
            own = parse_labels({"labels": 1, **said}, QUESTION.vocabulary, name="l.yaml")
            system = self.system.under((own, *dict.fromkeys(proposed)))
            result = answer(system, QUESTION)
        except InputErrors:
            return Tried(BAD_INPUT)
        return Tried(exit_code(result, (FailOn.undetermined,)), system, result)

    def steps(self, random: Random, singles: int, pairs: int) -> Iterator[tuple[Line, ...]]:
        """Yield no step, single ones and pairs of them: all, or as many as are given, drawn at random.

        Of pairs more have a source than not: without one nothing is followed.
        """
        yield ()
        some = self.offered if len(self.offered) <= singles else random.sample(self.offered, singles)
        yield from ((line,) for line in some)
        sources = [line for line in self.offered if "source" in line.word]
        all_pairs = list(combinations(self.offered, 2))
        if len(all_pairs) <= pairs:
            yield from all_pairs
            return
        for number in range(pairs):
            first = random.choice(sources if number % 3 else self.offered)
            yield first, random.choice(self.offered)

    def closed_by(self, tried: Tried, lines: Sequence[Line]) -> bool:
        """Whether a person named the source and some leak, and labels by name then close every way to the true leak.

        Then the answer is right by rule S12: it rests on the person's word, line by line.
        """
        assert tried.system
        ends = self.truth[0] in lines and any("leak" in line.word for line in lines)
        names = [element.name for element in tried.system.graph.elements]
        vertex = next(v for v, e in enumerate(tried.system.graph.elements) if e.is_node and e.name == self.source)
        there = brute(tried.system).spread([vertex])
        return ends and (self.leak, self.kind) not in {(names[v], category) for v, (category, _) in there}


QUESTION = question_of(Settings())


def plant(file: Path, random: Random) -> Planted | None:
    """Choose a kind of data, and two nodes that are joined under the standard channels' file; None if no two are."""
    try:
        system = robot_system((str(file),), (), QUESTION)
    except InputErrors:
        return None
    kind = random.choice(KINDS)
    nodes = [v for v, element in enumerate(system.graph.elements) if element.is_node]
    for source in random.sample(nodes, len(nodes)):
        said = Statement("source", (kind,), (1, 0), Place("truth", 1))
        there = brute(system, {source: said}).spread([source])
        leaks = sorted({v for v, _ in there} & set(nodes) - {source})
        if leaks:
            names = [element.name for element in system.graph.elements]
            return Planted(file, system, names[source], names[random.choice(leaks)], kind)
    return None


def brute(system: System, more: Mapping[int, Statement] | None = None) -> Brute:
    """The rules word for word, on a system as it is labelled, and with one more statement about some elements."""
    graph = system.graph
    said = {v: list(statements) for v, statements in system.bound.elements.items()}
    for vertex, statement in (more or {}).items():
        said.setdefault(vertex, []).append(statement)
    return Brute(
        [v for v, element in enumerate(graph.elements) if not element.is_channel],
        sorted({(flow.source, flow.target) for flow in graph.flows}),
        said,
        QUESTION.vocabulary.hierarchy,
        names={v: element.name for v, element in enumerate(graph.elements)},
    )
