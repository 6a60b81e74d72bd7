"""Policies, label files and observed types -> proposals of labels, in the order in which a person reviews them.

In: names of files. Out: ``Suggested``. Every provider of evidence is asked here; none of them labels anything.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.review_order import Behind, review_order
from rosprivacy.analysis.model import MessageType
from rosprivacy.analysis.suggesting.by_package import package_evidence
from rosprivacy.analysis.suggesting.carried_kinds import Rules, carried_kinds
from rosprivacy.analysis.suggesting.evidence import LEAK, SOURCE
from rosprivacy.analysis.suggesting.nodes import of_nodes
from rosprivacy.analysis.suggesting.open_elements import of_channels, of_open
from rosprivacy.analysis.suggesting.traffic import traffic
from rosprivacy.analysis.suggesting.unsaid import unsaid
from rosprivacy.analysis.suggesting.weighing import closes_finding, proposals
from rosprivacy.ingest.packages.package_folders import read_packages, rests_on
from rosprivacy.ingest.suggestions.name_file import read_name_rules
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import read_table
from rosprivacy.robot_system import answer_robot

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, OpenQuestion
    from rosprivacy.analysis.model import Bound
    from rosprivacy.analysis.suggesting.evidence import Evidence, Label, Proposal
    from rosprivacy.analysis.suggesting.ros_package import Package
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

Place = tuple[str, str, str]  # identity of an element
NOTHING_BEHIND = Behind()  # of what is open by a type only
NOT_OPEN = 2**31  # behind every open element


@dataclass(frozen=True, slots=True)
class Suggested:
    """What a person is asked.

    Attributes
    ----------
    proposals
        In review order: open elements, then sources and leaks, then the others.
    open
        Identities of the elements that are open.
    by_hand
        Labels that would take away data of which a finding is known: they are told, and not written into a label file.
    result
        The answer that they belong to.
    rules
        (file, SHA-256) of the rules.
    """

    proposals: tuple[Proposal, ...]
    open: frozenset[Place]
    by_hand: frozenset[Label]
    result: Result
    rules: tuple[tuple[str, str], ...]


def suggest_labels(
    policies: tuple[str, ...],
    labels: tuple[str, ...],
    settings: Settings,
    rules: Sequence[str] = (),
    packages: Sequence[str] = (),
    sources: Sequence[str] = (),
) -> Suggested:
    """Read a robot's system and say what its elements could be labelled as.

    Parameters
    ----------
    rules
        A user's files of rules about names.
    packages
        A user's files of packages, folders of them, or ``ament``.
    sources
        Source code of nodes: files, folders or globs, whose literal names and types are evidence.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    return suggested(answer_robot(policies, labels, settings), settings, rules, packages, sources)


def suggested(
    result: Result,
    settings: Settings,
    rules: Sequence[str] = (),
    packages: Sequence[str] = (),
    sources: Sequence[str] = (),
) -> Suggested:
    """Return what could be said of the elements of an answer; parameters as of ``suggest_labels``.

    Raises
    ------
    InputErrors
        With every problem of the rules and packages.
    """
    known, files = _rules(result.vocabulary, settings, rules)
    catalogue = read_packages(packages, result.vocabulary, settings.bounds)
    found = _with_findings(result)
    bound = _with_code(result, sources) if sources else result.bound
    made = proposals(evidence(result.analysis, bound, known, catalogue), found)
    asked = unsaid(made, result.analysis.graph, result.bound, result.vocabulary.hierarchy)
    places = _review_places(result.analysis)
    by_hand = frozenset(one.label for one in asked if closes_finding(one.label, found))
    return Suggested(in_review_order(asked, places), frozenset(places), by_hand, result, (*files, *rests_on(catalogue)))


def evidence(analysis: Analysis, bound: Bound, rules: Rules, packages: Sequence[Package]) -> Iterator[Evidence]:
    """Yield what every provider finds; the order does not matter."""
    graph = analysis.graph
    told, clues = traffic(graph, bound), carried_kinds(graph, bound, rules)
    yield from of_nodes(graph, bound, told, clues, rules)
    yield from of_channels(graph, clues)
    yield from of_open(analysis.open, graph, bound, told, rules)
    yield from package_evidence(graph, bound.types, packages)


def in_review_order(asked: Sequence[Proposal], places: Mapping[Place, int]) -> tuple[Proposal, ...]:
    """Return proposals in the order in which a person reviews them (rule S11)."""

    def place(one: Proposal) -> tuple[int, int]:
        at = places.get(one.label.element.identity, NOT_OPEN)
        return at, 0 if one.label.role in (SOURCE, LEAK) else 1

    return tuple(sorted(asked, key=place))  # stable: by element, role and kind within


def _rules(
    vocabulary: Vocabulary, settings: Settings, files: Sequence[str]
) -> tuple[Rules, tuple[tuple[str, str], ...]]:
    table = read_table(settings.type_limits or TABLE, vocabulary, settings.bounds)
    names, read = read_name_rules(files, vocabulary, settings.bounds)
    rules = Rules(table.suggestions, table.limits.of, names, vocabulary.hierarchy)
    return rules, ((table.limits.file, table.limits.sha256), *read)


def _with_code(result: Result, sources: Sequence[str]) -> Bound:
    """What is bound to the graph, with the types that source code names for its channels: for suggestions only."""
    from rosprivacy.ingest.annotations.code_evidence import code_evidence  # noqa: PLC0415 - light start
    from rosprivacy.ingest.annotations.source_files import read_sources  # noqa: PLC0415

    said: dict[tuple[str, str], list[MessageType]] = defaultdict(list)
    for one in code_evidence(read_sources(sources)):
        if one.name and one.type:
            said[one.kind, one.name].append(MessageType(one.type, one.place))
    elements, types = result.analysis.graph.elements, result.bound.types
    more = {at: said[e.kind, e.name] for at, e in enumerate(elements) if e.is_channel and (e.kind, e.name) in said}
    return replace(result.bound, types={at: (*types.get(at, ()), *more.get(at, ())) for at in {*types, *more}})


def _with_findings(result: Result) -> frozenset[str]:
    """The categories of findings, with all that data of them may be of."""
    hierarchy = result.vocabulary.hierarchy
    return frozenset(kind for one in result.analysis.findings for kind in hierarchy.overlaps[one.category])


def _review_places(analysis: Analysis) -> dict[Place, int]:
    """The place of each open element in the order of review: that of ``review_groups``, what can wait last."""
    behind = review_order(analysis)

    def place(question: OpenQuestion) -> tuple[int, bool, int, int, int]:
        said = behind.get(question.element.shown_as, NOTHING_BEHIND)
        group = 1 if question.element.is_channel else 0 if question.frontier else 2
        return group, said.waits, -said.leaks, -said.closes, question.distance

    identities = dict.fromkeys(question.element.identity for question in sorted(analysis.open, key=place))
    return {identity: number for number, identity in enumerate(identities)}
