"""One robot: policies, saved graphs and label files -> ``System``.

In: the names of files. Out: ``System``, whose labels can be replaced.
"""

from __future__ import annotations

import os
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.model import (
    MERGED,
    REFUSED_NAME,
    SEEN_ALTHOUGH_DENIED,
    SHARED_ENCLAVE,
    Diagnostic,
    Place,
    Severity,
)
from rosprivacy.analysis.suggesting.outdated_reasons import outdated_reasons
from rosprivacy.answering import answer
from rosprivacy.assumptions import files_read, remembered, types_read
from rosprivacy.ingest.deployed.exposures import with_exposed
from rosprivacy.ingest.labels.add_non_ros import extend, extended, told_of_bags
from rosprivacy.ingest.labels.binding import GraphNames, bind, join, misnamed, remarks
from rosprivacy.ingest.labels.label_file import LabelErrors, Labels, read_labels, unknown_categories
from rosprivacy.ingest.labels.pins import PIN_OF_NOTHING
from rosprivacy.ingest.labels.stated_facts import in_order
from rosprivacy.ingest.policies.changed_policies import NO_CHANGE, PolicyChange, changed
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.joint_policies import joint_warnings, merging_notices
from rosprivacy.ingest.policies.wildcards import careful_warnings
from rosprivacy.ingest.scan.reviewed_code import with_reviewed_code
from rosprivacy.ingest.types import types_path
from rosprivacy.ingest.types.channel_types import channel_types, matching_nothing
from rosprivacy.question import question_of
from rosprivacy.system import System
from rosprivacy.systems.granted import Read, code_roots, read_granted, scanned_types

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Bound, FlowGraph, Policy
    from rosprivacy.ingest.neo4j_graph.rows import Beyond, RobotRows
    from rosprivacy.ingest.policies.saved_graph import Saved
    from rosprivacy.ingest.types.channel_types import Written
    from rosprivacy.ingest.types.types_file import TypesFile
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

ACROSS = (MERGED, SHARED_ENCLAVE, REFUSED_NAME, SEEN_ALTHOUGH_DENIED)  # what is said of policies together
Types = tuple["TypesFile", ...]


def answer_robot(policies: tuple[str, ...], labels: tuple[str | Labels, ...], settings: Settings) -> Result:
    """Read policies and label files, and analyse them.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    question = question_of(settings)
    return answer(robot_system(policies, labels, question), question)


def robot_system(policies: tuple[str, ...], labels: tuple[str | Labels, ...], question: Question) -> System:
    """Read policies and label files.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    return system_reader(policies, labels, question)(NO_CHANGE)


def system_reader(
    policies: tuple[str, ...], labels: tuple[str | Labels, ...], question: Question
) -> Callable[[PolicyChange], System]:
    """Read policies once; return what makes a system of them with a change (rule S6).

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    settings = question.settings
    graphs = read_graphs(settings)
    (policies_read, remarks), types = read_system(policies, settings, graphs), observed_types(settings, graphs)
    types = (*types, *scanned_types(policies))
    if not types:
        remarks += tuple(_unread_types(policies_read))
    remarks += tuple(_unread_code(policies, policies_read))

    def read(change: PolicyChange) -> System:
        there = changed(policies_read, change)
        graph = build(there, settings.view, settings.bounds)
        read_so = (there, remarks)
        return _under(labels, graph=graph, read=read_so, types=types, settings=settings, vocabulary=question.vocabulary)

    return read


def _unread_types(policies: Iterable[Policy]) -> Iterator[Diagnostic]:
    """Say of which policies message types lie in the same folder: only a user says that they are of this system."""
    for name in dict.fromkeys(policy.file for policy in policies):
        file = types_path(Path(name))
        if file.is_file():
            message = f"message types lie in {file}, and are not read: --types names those that count (rule S15)"
            yield Diagnostic(Place(name, 0), Severity.WARNING, message)


def _unread_code(names: Iterable[str], policies: Iterable[Policy]) -> Iterator[Diagnostic]:
    """Say in which folders source code lies beside policies: these say what is granted, and only they are read."""
    read = {folder for policy in policies if policy.checkout for folder in policy.checkout[0]}
    folders = (name for name in names if name not in read and os.path.isdir(name))  # noqa: PTH112 - by its text
    for name in code_roots(folders, granted=True):
        message = f"source code of ROS 2 lies in {shown(name)}, and is not read: rosprivacy scan reads it"
        yield Diagnostic(Place(name, 0), Severity.WARNING, message)


def _under(
    labels: tuple[str | Labels, ...], *, graph: FlowGraph, read: Read, types: Types, settings: Settings,
    vocabulary: Vocabulary, unlabelled: _Whole | None = None,
) -> System:  # fmt: skip
    """Put policies that were read under labels; their graph is made once, and lasts for all labels."""
    try:
        files = read_label_files(labels, vocabulary, settings)
    except LabelErrors as error:
        raise with_misnamed(error, graph) from None
    unlabelled = unlabelled or _Whole(graph)
    names = unlabelled.names_under(files)
    bound = bind(names.graph, files, settings.bounds, names=names)
    system = _joined(names.graph, bound, read, files, types, settings, vocabulary, names)
    system = replace(system, diagnostics=(*system.diagnostics, *matching_nothing(names.graph, types)))
    again = partial(
        _under, graph=graph, read=read, types=types, settings=settings, vocabulary=vocabulary, unlabelled=unlabelled
    )
    return replace(system, under=again)


def with_misnamed(error: LabelErrors, graph: FlowGraph) -> InputErrors:
    """Return all problems of label files: of how they are written, and names in them that match nothing of a graph."""
    return InputErrors([*error.errors, *misnamed(GraphNames(graph), error.labels)])


class _Whole:
    """A graph with what label files state of elements outside ROS: the same for files that state the same."""

    def __init__(self, graph: FlowGraph) -> None:
        self._graph = graph
        self._last: tuple[object, GraphNames] | None = None

    def names_under(self, files: Sequence[Labels]) -> GraphNames:
        """Return the names of the whole graph, which is beside them."""
        stated = [(file.own, file.elements, file.flows) for file in files]
        if self._last is None or self._last[0] != stated:
            self._last = stated, GraphNames(extend(self._graph, files))
        return self._last[1]


def _joined(
    graph: FlowGraph, bound: Bound, read: Read, files: list[Labels], types: Types, settings: Settings,
    vocabulary: Vocabulary, names: GraphNames | None = None,
) -> System:  # fmt: skip
    policies, diagnostics = read
    said = tuple(d for policy in policies for d in policy.diagnostics) + diagnostics
    said += (
        tuple(d for file in files for d in file.diagnostics)
        + tuple(remarks(graph, files, names))
        + tuple(told_of_bags(graph, (stated for file in files for stated in file.elements)))
    )
    said += careful_warnings(graph.careful)
    rests_on = {**files_read(policies, files, settings), **types_read(types)}
    bound, of_code = with_reviewed_code(graph, bound, files, policies)
    bound = with_exposed(graph, with_types(graph, bound, types), policies)
    said += of_code + tuple(outdated_reasons(graph, bound))
    said = tuple(dict.fromkeys(said))  # several enclaves share what is said of their governance
    return System(graph, bound, vocabulary, said, rests_on, policies, tuple(files), types=types)


def with_types(graph: FlowGraph, bound: Bound, types: Types, written: Written = MappingProxyType({})) -> Bound:
    """Return what is bound to a graph with the observed types of its channels beside those that labels state."""
    seen = channel_types(graph, types, written)
    both = {v: (*bound.types.get(v, ()), *seen.get(v, ())) for v in {*bound.types, *seen}}
    return replace(bound, types=in_order(both))


def answer_each(
    policies: tuple[str, ...], labels: tuple[str | Labels, ...], settings: Settings
) -> tuple[tuple[str, Result], ...]:
    """Read policies and label files, and analyse each policy alone.

    A name of a label has to match in one of the policies at least (rule S11). What of a folder was not read counts
    for each of its policies, since nobody knows which one it belongs to.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    question = question_of(settings)
    vocabulary = question.vocabulary
    graphs = read_graphs(settings)
    read, said = read_system(policies, settings, graphs)
    types = observed_types(settings, graphs)
    files = read_label_files(labels, vocabulary, settings)
    bind(
        extend(build(read, settings.view, settings.bounds), files), files, settings.bounds
    )  # raises what fits none of them
    left = tuple(one for one in said if one.code not in ACROSS)
    results = []
    for policy in read:
        alone = (policy,), (*left, *joint_warnings((policy,)))
        results.append((policy.file, answer(lenient_system(alone, files, question, types)[0], question)))
    return tuple(results)


def lenient_system(
    read: Read, files: list[Labels], question: Question, types: Types = ()
) -> tuple[System, list[InputError]]:
    """Put policies under labels as far as their names go; return also what matches nothing."""
    settings = question.settings
    graph, missing = extended(build(read[0], settings.view, settings.bounds), files)
    bound, more = join(graph, files, settings.bounds)
    system = _joined(graph, bound, read, files, types, settings, question.vocabulary)
    told = tuple(said for said in system.diagnostics if said.code != PIN_OF_NOTHING)  # it may be of another policy
    return replace(system, diagnostics=told), [*missing, *more]


def robot_of(name: str, result: Result, *, without_standard: bool = False) -> RobotRows:
    """Return the rows of a robot for the database; what the answer rests on goes with it.

    Parameters
    ----------
    without_standard
        Whether the channels that only the standard file speaks of are left out.
    """
    from rosprivacy.ingest.neo4j_graph.fleet_rows import robot_rows  # noqa: PLC0415
    from rosprivacy.robot_doubts import doubt_lines  # noqa: PLC0415

    more = remembered(result.assumptions, result.diagnostics, doubt_lines(result.doubts))
    return robot_rows(
        name, result.analysis, result.bound, result.vocabulary, more, beyond_of(result),
        without_standard=without_standard,
    )  # fmt: skip


def beyond_of(result: Result) -> Beyond | None:
    """Return what the enforced view adds to a result, for the database; None where nobody asked for both views."""
    if result.enforced is None:
        return None
    from rosprivacy.analysis.findings.beyond import granted  # noqa: PLC0415
    from rosprivacy.ingest.neo4j_graph.rows import Beyond  # noqa: PLC0415

    return Beyond(result.enforced.added, granted(result.analysis.graph))


def read_graphs(settings: Settings) -> list[Saved]:
    """Read the saved graphs that are added to."""
    if not settings.add:
        return []
    from rosprivacy.ingest.policies.saved_graph import read_saved  # noqa: PLC0415 - light start

    return [read_saved(file) for file in settings.add]


def read_system(policies: tuple[str, ...], settings: Settings, graphs: list[Saved]) -> Read:
    """Read policies, beside the saved graphs that they add to."""
    saved = [policy for graph in graphs for policy in graph.policies]
    read: tuple[Policy, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()
    if policies or not saved:
        read, diagnostics = read_granted(policies, settings)
    known = {policy.file for policy in read}  # read again is read anew
    sources = {name for policy in read for name, _ in policy.sources}
    left = (d for graph in graphs for d in graph.diagnostics)
    diagnostics += tuple(d for d in left if d.place.file not in sources and d not in diagnostics)
    system = (*read, *(policy for policy in saved if policy.file not in known))
    read = tuple(sorted(system, key=lambda policy: policy.file))
    return read, (*diagnostics, *joint_warnings(system), *merging_notices(system))


def observed_types(settings: Settings, graphs: list[Saved]) -> Types:
    """Read the files of observed types, and those that saved graphs keep; one that is named is read anew."""
    files = read_types_files(settings.types, settings)
    saved = {one.file: one for graph in graphs for one in graph.types}
    return tuple(one for _, one in sorted({**saved, **files}.items()))


def read_types_files(names: Iterable[str], settings: Settings) -> dict[str, TypesFile]:
    """Read files of observed types, each once, with the problems of all of them."""
    problems: list[InputError] = []
    files: dict[str, TypesFile] = {}
    for name in dict.fromkeys(names):
        from rosprivacy.ingest.types.types_file import read_types  # noqa: PLC0415 - light start

        try:
            files[name] = read_types(name, settings.bounds)
        except InputErrors as error:
            problems += error.errors
    if problems:
        raise InputErrors(problems)
    return files


def standard_channels(graph: FlowGraph, vocabulary: Vocabulary, settings: Settings) -> set[tuple[str, str]]:
    """Return (kind, name) of the channels that the standard file takes as mundane (rule S13)."""
    bound = bind(graph, read_label_files((), vocabulary, settings))
    return {(graph.elements[vertex].kind, graph.elements[vertex].name) for vertex in bound.elements}


def read_label_files(labels: tuple[str | Labels, ...], vocabulary: Vocabulary, settings: Settings) -> list[Labels]:
    """Read the standard channels' file and the user's, if not read before, with the problems of all of them."""
    files: list[Labels] = []
    unread: list[Labels] = []
    problems: list[InputError] = []
    read = {file.file for file in labels if isinstance(file, Labels)}
    standard = [name for name in (settings.standard_channels,) if name and name not in read]
    for file in dict.fromkeys([*standard, *labels]):
        if isinstance(file, Labels):
            files.append(file)
            problems += unknown_categories(file, vocabulary)
            continue
        try:
            shipped = file in standard and file not in labels  # named by the user, it is the user's own
            files.append(
                read_labels(
                    file,
                    vocabulary,
                    category=settings.category,
                    shipped=shipped,
                    bounds=settings.bounds,
                    include_root=settings.include_root,
                )
            )
        except InputErrors as error:
            problems += error.errors
            unread += error.labels if isinstance(error, LabelErrors) else ()
    if problems:
        raise LabelErrors(problems, tuple(unread))
    return files
