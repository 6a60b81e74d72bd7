"""Pins into label files: for each element that globs decided, the kinds that reached it while a person looks (S11).

In: what a command reads, a robot or a fleet. Out: the new texts of its label files. What is pinned is what globs decide
without any pins, so that nothing of the answer changes under the new ones; a file that several robots read has what
reached any of them.
"""

from __future__ import annotations

import hashlib
import os
from collections import defaultdict
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.analysis.kernel.by_type import taken_today
from rosprivacy.analysis.model import TYPE_LINE, Place
from rosprivacy.analysis.whatif.answered_by_globs import answered_by_globs
from rosprivacy.analysis.written_names import bare_name
from rosprivacy.answering import answer
from rosprivacy.ingest.fleet.dds_domains import called_in_fleet
from rosprivacy.ingest.labels.edited_entries import SaidOfElement
from rosprivacy.ingest.labels.label_file import OURS, Labels, parse_labels
from rosprivacy.ingest.labels.label_writer import with_entries, without_places
from rosprivacy.ingest.labels.pins import (
    CODE,
    LINES,
    PINS,
    CodePin,
    Pin,
    TypePin,
    as_section,
    code_section,
    spot,
    types_section,
)
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import read_utf8
from rosprivacy.labelling.label_lines import LabelLines, own_file
from rosprivacy.question import question_of
from rosprivacy.systems.fleet_system import read_once
from rosprivacy.systems.robot_reader import files_of
from rosprivacy.systems.robot_system import answer_robot, read_label_files

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import ByGlobs
    from rosprivacy.ingest.labels.pins import Spot
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings
    from rosprivacy.systems.fleet_system import FleetSystem

    Ends = tuple[Spot, ...]
    Arrivals = Mapping[str, Mapping[Ends, set[str]]]  # file -> element or flow -> kinds


def pinned(policies: tuple[str, ...], labels: tuple[str, ...], settings: Settings) -> Iterator[LabelLines]:
    """Yield the label files of a robot that have globs, or pins, with the pins that they need now.

    Raises
    ------
    InputErrors
        With every problem of the input.
    LabelError
        If a file has no place for them.
    """
    own_file(labels)
    vocabulary = question_of(settings).vocabulary
    files = read_label_files(labels, vocabulary, settings)
    result = answer_robot(policies, tuple(_bare(file) for file in files), settings)
    arrivals: dict[str, dict[Ends, set[str]]] = defaultdict(lambda: defaultdict(set))
    today = _types_today(result)
    for row in _rows(result):
        ends = tuple(spot(element) for element in (row.element, row.to) if element)
        for place in row.places:
            arrivals[place.file][ends].update(row.categories)
    yield from _written({file.file: file for file in files if not file.shipped}, arrivals, vocabulary, today)


def pinned_in_fleet(fleet: str, settings: Settings) -> Iterator[LabelLines]:
    """Yield the same of the label files that a fleet file leads to; see ``pinned``."""
    question = question_of(settings)
    read = read_once(fleet, question)
    read.system()  # reads the label files
    files = {key: labels for key, labels in read.reader.labels.items() if not key[0].startswith(OURS)}
    _refuse_lines(files.values())
    system = read.under({key: _bare(labels) for key, labels in files.items()}, ())
    arrivals: dict[str, dict[Ends, set[str]]] = defaultdict(lambda: defaultdict(set))
    called, copies = _spots_of(system), _copies(system)
    for row in _rows(answer(system, question, count_paths=False)):
        sides = [called[element.identity] for element in (row.element, row.to) if element]
        for member in set(sides[0]).intersection(*sides[1:]):
            ends = tuple(side[member] for side in sides)
            for file in {name for place in row.places for name in copies.get((member, place.file), ())}:
                arrivals[file][ends].update(row.categories)
    first = {name: labels for (name, _), labels in files.items()}
    every = {name: first[file] for (_, file), names in copies.items() for name in names if file in first}
    yield from _written(every, arrivals, question.vocabulary)


def _bare(labels: Labels) -> Labels:
    return replace(labels, pins=None, type_pins=None, code_pins=())


def _refuse_lines(files: Iterable[Labels]) -> None:
    """Refuse lines ``only: by-type`` without a pin: of a fleet, none is made."""
    for file in files:
        pinned = {name for pin in file.type_pins or () for _, name in pin.ends}
        for entry in file.entries:
            lines = [said for said in entry.statements if said.role == TYPE_LINE]
            if lines and bare_name(entry.name) not in pinned:
                what = f"only: by-type of {shown(entry.name)}, which a fleet does not pin"
                hint = f"name the policies of one robot: rosprivacy labels --pin POLICY -l {file.file}"
                raise LabelError(file.file, lines[0].place.line, what, hint)


def _types_today(result: Result) -> dict[str, dict[Ends, set[str]]]:
    """File -> channel with a line ``only: by-type`` whose type is known -> with which types and writers it is so."""
    graph, bound = result.analysis.graph, result.bound
    taken: dict[str, dict[Ends, set[str]]] = defaultdict(lambda: defaultdict(set))
    for vertex, texts in taken_today(graph, bound).items():
        for line in bound.elements[vertex] if bound.types.get(vertex) else ():
            if line.role == TYPE_LINE:
                taken[line.place.file][(spot(graph.elements[vertex]),)].update(texts)
    return taken


def _rows(result: Result) -> tuple[ByGlobs, ...]:
    return answered_by_globs(result.analysis.spread, result.bound, result.vocabulary.hierarchy)


def _spots_of(system: FleetSystem) -> Mapping[tuple[str, str, str], Mapping[str, Spot]]:
    """Identity of an element of the fleet -> robot -> what its label files call it."""
    placed = [replace(system.members[g.robots[0].id], robot=robot) for g in system.groups for robot in g.placed]
    called: dict[tuple[str, str, str], dict[str, Spot]] = defaultdict(dict)
    for member, name in called_in_fleet(placed):
        for element in member.graph.elements:
            called[name(element).identity][member.robot.id] = spot(element)
    return called


def _copies(system: FleetSystem) -> Mapping[tuple[str, str], tuple[str, ...]]:
    """(robot that stands for others, a label file of it) -> that file, with those of the others that hold the same."""
    copies: dict[tuple[str, str], dict[str, None]] = defaultdict(dict)
    for group in system.groups:
        first = files_of(group.robots[0])
        for robot in group.robots:
            for (file, _), (name, _) in zip(first, files_of(robot), strict=True):
                for member in group.placed:
                    copies[member.id, file][name] = None
    return {key: tuple(names) for key, names in copies.items()}


def _written(
    files: Mapping[str, Labels], arrivals: Arrivals, vocabulary: Vocabulary, today: Arrivals | None = None
) -> Iterator[LabelLines]:
    """The texts, each file once, whatever the names that lead to it.

    Parameters
    ----------
    today
        Types and writers of lines ``only: by-type``; None to keep what is pinned of them.
    """
    pins: dict[str, dict[Ends, set[str]]] = defaultdict(lambda: defaultdict(set))
    names: dict[str, str] = {}
    for name in sorted(files):
        at = os.path.realpath(name)
        names.setdefault(at, name)
        for ends, kinds in arrivals.get(name, {}).items():
            pins[at][ends].update(kinds)
    for at, name in names.items():
        labels = files[name]
        says = (*(entry.statements for entry in labels.entries), *(flow.statements for flow in labels.flows))
        by_globs = any(said.to_be_seen for statements in says for said in statements)
        by_types = any(said.role == TYPE_LINE for statements in says for said in statements)
        if by_globs or by_types or labels.pins is not None or labels.type_pins is not None:
            now = [Pin(ends, tuple(sorted(kinds)), Place(name, 0)) for ends, kinds in pins[at].items()]
            types = labels.type_pins
            if today is not None:
                channels = today.get(name, {}).items()
                types = tuple(TypePin(ends, tuple(sorted(texts)), Place(name, 0)) for ends, texts in channels)
            pinned = Pins(tuple(now) if by_globs else None, types if by_types else None, labels.code_pins)
            yield with_pins(labels, name, pinned, vocabulary)


class Pins(NamedTuple):
    """What a label file pins: of globs, and of lines ``only: by-type``, None for nothing; and of code."""

    of_globs: tuple[Pin, ...] | None
    of_types: tuple[TypePin, ...] | None
    of_code: tuple[CodePin, ...]

    @property
    def section(self) -> dict[str, Any] | None:
        """The section that says so; None for none."""
        if self == NO_PINS:
            return None
        others = {} if self.of_types is None else {LINES: types_section(self.of_types)}
        others |= {CODE: code_section(self.of_code)} if self.of_code else {}
        empty: dict[str, Any] = {"nodes": {}} if self.of_globs == () and others else {}  # it pins no glob
        return {**(as_section(self.of_globs or ()) or empty), **others}

    @property
    def facts(self) -> tuple[set[object] | None, ...]:
        """What they say, wherever it stands."""
        return tuple(None if some is None else _facts(some) for some in self)


NO_PINS = Pins(None, None, ())


def pins_of(labels: Labels) -> Pins:
    """Return what a label file pins."""
    return Pins(labels.pins, labels.type_pins, labels.code_pins)


def with_pins(labels: Labels, name: str, pins: Pins, vocabulary: Vocabulary) -> LabelLines:
    """Return the text of a label file with these pins, if it has others."""
    text, data = read_utf8(name, yaml_values.MAX_BYTES, partial(LabelError, name))
    if hashlib.sha256(data).hexdigest() != labels.sha256:
        raise LabelError(name, 0, "was changed while it was read", "run the command again")
    if pins.section is None or pins.facts != pins_of(labels).facts:
        new = with_entries(name, text, [SaidOfElement(PINS, PINS, pins.section)])
        _check(name, text, new.text, pins, vocabulary)
        return LabelLines(name, new.text, new.lines, new.remarks)
    return LabelLines(name, text, 0)


def _check(name: str, text: str, new: str, pins: Pins, vocabulary: Vocabulary) -> None:
    """Hold the new text against what it should mean."""
    before = parse_labels(text, vocabulary, name=name)
    try:
        after = parse_labels(new, vocabulary, name=name)
        there = pins_of(after).facts
        same = all(_facts(old) == _facts(now) for old, now in zip(*map(_parts, (before, after)), strict=True))
    except InputErrors:  # the paper's six lists
        there, same = NO_PINS.facts, False
    if not same or there != pins.facts:
        raise LabelError(name, 0, "has no place for pins", "begin it with 'labels: 1', a line for each section")


def _parts(labels: Labels) -> tuple[Iterable[object], ...]:
    return labels.entries, labels.flows, labels.elements, labels.limits


def _facts(facts: Iterable[object]) -> set[object]:
    return {without_places(fact) for fact in facts}
