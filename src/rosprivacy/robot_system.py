"""One robot: policies, saved graphs and label files -> ``System``.

In: the names of files. Out: ``System``, whose labels can be replaced.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.answering import answer
from rosprivacy.assumptions import files_read, remembered
from rosprivacy.ingest.labels.add_non_ros import extend
from rosprivacy.ingest.labels.binding import bind, remarks
from rosprivacy.ingest.labels.label_file import Labels, read_labels, unknown_categories
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.joint_policies import joint_warnings
from rosprivacy.ingest.policies.policy_files import read_policies
from rosprivacy.ingest.policies.saved_graph import read_saved
from rosprivacy.ontology.vocabulary import load
from rosprivacy.question import question_of
from rosprivacy.system import System

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Diagnostic, FlowGraph, Policy
    from rosprivacy.ingest.database.rows import RobotRows
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

Read = tuple[tuple["Policy", ...], tuple["Diagnostic", ...]]


def answer_robot(policies: tuple[str, ...], labels: tuple[str | Labels, ...], settings: Settings) -> Result:
    """Read policies and label files, and analyse them.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    vocabulary = load(ontologies=settings.ontologies)
    question = question_of(settings, vocabulary)
    return answer(robot_system(policies, labels, settings, vocabulary), question)


def robot_system(
    policies: tuple[str, ...], labels: tuple[str | Labels, ...], settings: Settings, vocabulary: Vocabulary
) -> System:
    """Read policies and label files.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    return _under(labels, read=read_system(policies, settings), settings=settings, vocabulary=vocabulary)


def _under(labels: tuple[str | Labels, ...], *, read: Read, settings: Settings, vocabulary: Vocabulary) -> System:
    """Put policies that were read under labels."""
    policies, diagnostics = read
    files = read_label_files(labels, vocabulary, settings)
    graph = extend(build(policies, settings.view), files)
    said = tuple(d for policy in policies for d in policy.diagnostics) + diagnostics
    said += tuple(d for file in files for d in file.diagnostics) + tuple(remarks(graph, files))
    return System(
        graph,
        bind(graph, files),
        vocabulary,
        said,
        files_read(policies, files, settings),
        policies,
        tuple(files),
        under=partial(_under, read=read, settings=settings, vocabulary=vocabulary),
    )


def robot_of(name: str, result: Result) -> RobotRows:
    """Return the rows of a robot for the database; what the answer rests on goes with it."""
    from rosprivacy.ingest.database.rows import robot_rows  # noqa: PLC0415

    more = remembered(result.assumptions, result.diagnostics)
    return robot_rows(name, result.analysis, result.bound, result.vocabulary, more)


def read_system(policies: tuple[str, ...], settings: Settings) -> Read:
    """Read policies and the saved graphs that they add to."""
    graphs = [read_saved(file) for file in settings.add]
    saved = [policy for policies_of, _ in graphs for policy in policies_of]
    read: tuple[Policy, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()
    if policies or not saved:
        read, diagnostics = read_policies(
            policies,
            include_root=settings.include_root,
            max_bytes=settings.max_bytes,
            progress=settings.progress,
        )
    known = {policy.file for policy in read}  # read again is read anew
    sources = {name for policy in read for name, _ in policy.sources}
    diagnostics += tuple(d for _, left in graphs for d in left if d.place.file not in sources and d not in diagnostics)
    system = (*read, *(policy for policy in saved if policy.file not in known))
    return tuple(sorted(system, key=lambda policy: policy.file)), (*diagnostics, *joint_warnings(system))


def standard_channels(graph: FlowGraph, vocabulary: Vocabulary, settings: Settings) -> set[tuple[str, str]]:
    """Return (kind, name) of the channels that the standard file takes as mundane (rule S13)."""
    bound = bind(graph, read_label_files((), vocabulary, settings))
    return {(graph.elements[vertex].kind, graph.elements[vertex].name) for vertex in bound.elements}


def read_label_files(labels: tuple[str | Labels, ...], vocabulary: Vocabulary, settings: Settings) -> list[Labels]:
    """Read the standard channels' file and the user's, if not read before, with the problems of all of them."""
    files: list[Labels] = []
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
            files.append(read_labels(file, vocabulary, category=settings.category, shipped=shipped))
        except InputErrors as error:
            problems += error.errors
    if problems:
        raise InputErrors(problems)
    return files
