"""What a label file lacks: lines for what is new in policies, and for what a person reviews next (rules S11, S13).

In: policies and the label files of one robot. Out: the text of one of them with more lines, and what to tell about it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputError, LabelError, shown
from rosprivacy.analysis.kernel.standard_channels import SAYS_OTHERWISE
from rosprivacy.analysis.model import GLOB
from rosprivacy.analysis.written_names import literal
from rosprivacy.ingest.labels.add_non_ros import extend
from rosprivacy.ingest.labels.binding import join
from rosprivacy.ingest.labels.entries import SECTIONS
from rosprivacy.ingest.labels.label_file import OURS, Labels, infrastructure_of, parse_labels, read_labels
from rosprivacy.ingest.labels.label_template import endpoint_comment, neighbours
from rosprivacy.ingest.labels.label_writer import NEW, NewLine, with_lines
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.names import covered
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.reading.path_kinds import exists
from rosprivacy.ingest.reading.yaml_values import MAX_BYTES
from rosprivacy.ontology.vocabulary import load
from rosprivacy.report.review_groups import next_round, sources_of
from rosprivacy.report.text.review import candidates, lacking_step, review_text
from rosprivacy.report.verdict import lacking
from rosprivacy.systems.robot_system import answer_robot, read_graphs, read_label_files, read_system, standard_channels

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.model import Element
    from rosprivacy.ingest.labels.entries import Entry
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings

Channel = tuple[str, str]  # kind, name; of a node too
NAME_ONE = "say which, such as nodes: {/camera: {source: [Video]}} (rosprivacy labels --init lists all nodes)"


@dataclass(frozen=True, slots=True)
class LabelLines:
    """The new text of a label file, how many lines are new, and what to tell a person."""

    file: str
    text: str
    added: int
    remarks: tuple[str, ...] = ()


def updated(policies: tuple[str, ...], labels: tuple[str, ...], settings: Settings) -> LabelLines:
    """Return a label file with an empty line for every element that no line of the label files speaks of.

    Of a glob that lost its rank over standard channels (rule S13), what it said of them is written out.
    """
    vocabulary = load(ontologies=settings.ontologies)
    own, text = _own(labels, vocabulary, settings)
    read, _ = read_system(policies, settings, read_graphs(settings))
    known = read_label_files(tuple(own if one == own.file else one for one in labels), vocabulary, settings)
    graph = extend(build(read, settings.view, settings.bounds), known)
    _, problems = join(graph, known, settings.bounds)
    standard = standard_channels(graph, vocabulary, settings)
    there = [element for element in graph.elements if element.is_node or element.is_channel]
    left_out = standard | infrastructure_of(there, vocabulary)
    said = {
        channel
        for file in known
        if not file.shipped
        for entry in file.entries
        for channel in _channels_of(there, entry)
    }
    new = sorted({(e.kind, e.name) for e in there} - said - left_out)
    listed = {(e.kind, e.name) for e in there if e.is_channel} - left_out
    restored = _restored(own, standard, said_by_name={(k, e.name) for e in own.entries for k in e.kinds})
    lines = [*restored, *_lines(new, neighbours(graph, listed))]
    remarks = [f"{error.file}:{error.line}: {error.problem}; {error.hint}" for error in problems]
    remarks += [f"{own.file}: {shown(line.name)} is written out: {line.remark}" for line in restored]
    return LabelLines(own.file, with_lines(own.file, text, lines, vocabulary), len(lines), tuple(remarks))


def next_lines(policies: tuple[str, ...], labels: tuple[str, ...], settings: Settings) -> LabelLines:
    """Return a label file with an empty line for each element to review next, which says where data comes from.

    Before any source is named these are the nodes whose names sound like a sensor.
    """
    vocabulary = load(ontologies=settings.ontologies)
    own, text = _own(labels, vocabulary, settings)
    files = tuple(own if one == own.file else one for one in labels)
    report: Mapping[str, Any] = answer_robot(policies, files, settings).document()
    written = {(kind, entry.name): entry.place for entry in own.entries for kind in entry.kinds}
    emits = sources_of(report)
    lines: dict[tuple[str, str], NewLine] = {}
    remarks = []
    for question in next_round(report):
        at, why = question["label"], review_text(question, emits)
        place = written.get((question["element"]["kind"], at["name"]))
        if place:
            remarks.append(f"{place}: {shown(at['name'])} is not reviewed: {why}")
        elif at["section"] in SECTIONS:
            lines.setdefault((at["section"], at["name"]), NewLine(at["section"], at["name"], why))
        else:  # seen, and of no node (rule S16)
            hint = f"say what it is, such as elements: {{{shown(at['name'])}: {{kind: external-system}}}}"
            remarks.append(f"{own.file}: {shown(at['name'])} is not reviewed: {why}; {hint}")
    likely = candidates(report) if not report["carries"] else []
    for name in likely:
        if ("node", name) not in written:
            lines["nodes", name] = NewLine("nodes", name, "does it bring personal data in? {source: [Video]}")
    if not report["carries"] and not lines:
        guess = f"candidates by name: {', '.join(likely)}" if likely else "no node sounds like a sensor"
        remarks.append(f"{own.file}: no source is named; {guess}; {NAME_ONE}")
    if code := lacking(report):
        remarks.append(f"{own.file}: nothing is left to review, but {lacking_step(code)}")
    text = with_lines(own.file, text, list(lines.values()), vocabulary)
    return LabelLines(own.file, text, len(lines), tuple(remarks))


def own_file(labels: tuple[str, ...]) -> str:
    """Return the label file that is written: the first of a person's.

    Raises
    ------
    InputError
        If there is none.
    """
    for file in labels:
        if not file.startswith(OURS):
            return file
    raise InputError("--labels", 0, "names no file to write into", "add -l labels.yaml; it is made if it is not there")


def _own(labels: tuple[str, ...], vocabulary: Vocabulary, settings: Settings) -> tuple[Labels, str]:
    """The label file that is written, with its text; one that is not there is begun."""
    file = own_file(labels)
    if not exists(file):
        return parse_labels(NEW, vocabulary, name=file), NEW
    data = read_regular(file, MAX_BYTES, partial(LabelError, file))
    root = settings.include_root
    read = read_labels(file, vocabulary, category=settings.category, bounds=settings.bounds, include_root=root)
    return read, data.decode("utf-8-sig")


def _channels_of(elements: Iterable[Element], entry: Entry) -> Iterator[Channel]:
    """(kind, name) of what an entry speaks of."""
    for kind in entry.kinds:
        yield from ((kind, name) for name in covered(entry.name, {e.name for e in elements if e.kind == kind}))


def _restored(own: Labels, standard: Iterable[Channel], said_by_name: Collection[Channel]) -> list[NewLine]:
    """What globs with an open end say of standard channels, by name: there they count no longer (rule S13)."""
    lines = {}
    for entry in own.entries:
        loosening = [s for s in entry.statements if s.naming == GLOB and s.role in SAYS_OTHERWISE]
        for kind, name in sorted(standard) if loosening else ():
            at = f"{kind}s"
            if kind in entry.kinds and covered(entry.name, [name]) and (kind, literal(name)) not in said_by_name:
                role, kinds = loosening[0].role, list(loosening[0].categories)
                remark = f"as {shown(entry.name)} said before standard channels outranked such globs (S13)"
                lines[at, name] = NewLine(at, literal(name), remark, {role: kinds} if kinds else role)
    return list(lines.values())


def _lines(
    new: Iterable[Channel], around: tuple[Mapping[str, set[Channel]], Mapping[str, set[Channel]]]
) -> Iterator[NewLine]:
    writes, reads = around
    for kind, name in new:
        remark = endpoint_comment(writes.get(name, ()), reads.get(name, ())) if kind == "node" else ""
        yield NewLine(f"{kind}s", literal(name), remark.removeprefix("  # "))
