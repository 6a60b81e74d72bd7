"""Policies, label files and observed types -> what a person is asked, in the order in which it is reviewed.

In: names of files. Out: ``Suggested``. What no person has said yet is asked, the surest first; what a person has said
no to, in the label files that an answer rests on, is not suggested again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import LabelError
from rosprivacy.analysis.findings.review_order import Behind
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS
from rosprivacy.analysis.model import Diagnostic, Severity
from rosprivacy.analysis.suggesting.evidence import LEAK, SOURCE, TYPE, written
from rosprivacy.analysis.suggesting.label_questions import narrowed, reached_kinds
from rosprivacy.analysis.suggesting.outdated_reasons import outdated_reasons
from rosprivacy.analysis.suggesting.weighing import SURENESS, closes_finding, proposals, unsaid
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.known_packages.package_folders import replacements
from rosprivacy.ingest.labels.label_file import OURS
from rosprivacy.ingest.reading.bounded_file import read_utf8
from rosprivacy.ingest.reading.path_kinds import is_file
from rosprivacy.ingest.reading.yaml_values import MAX_BYTES
from rosprivacy.ingest.suggestion_rules.comments import refusal_key, refusals_in
from rosprivacy.labelling.knowledge import NO_FILES, Basis, CodeSaid, code_said, evidence, what_is_known
from rosprivacy.ontology.vocabulary import TOP
from rosprivacy.systems.robot_system import answer_robot

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import OpenQuestion
    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.findings.review_order import Shown
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Bound, Category, MessageType, Weight
    from rosprivacy.analysis.suggesting.evidence import Evidence, Identity, LabelProposal, SuggestedLabel
    from rosprivacy.analysis.suggesting.library_rules import LibraryRules, NodeUse
    from rosprivacy.ingest.code.node_uses import Local
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.labelling.knowledge import KnownOfSystem, UserFiles
    from rosprivacy.labelling.model_interview import Interview
    from rosprivacy.report.schemas.suggested import ModelEntry, SuggestionsDocument
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

NOTHING_BEHIND = Behind()  # of what is open by a type only
NOT_OPEN = 2**31  # behind every open element


@dataclass(frozen=True, slots=True, repr=False)
class Suggested:
    """What a person is asked about the elements of an answer; under which rules; and what could not be looked at.

    Attributes
    ----------
    proposals
        In review order: open elements, then sources and leaks, then the others.
    open
        Identities of the elements that are open.
    by_hand
        Labels that would take away data of which a finding is known: they are told, and not written into a label file.
    unplaced
        Uses of libraries in source code that a rule speaks about, and that belong to no node that is known here.
    of_others
        Folders with code of others that were left out.
    """

    proposals: tuple[LabelProposal, ...]
    open: frozenset[Identity]
    by_hand: frozenset[SuggestedLabel]
    result: Result
    rules: tuple[tuple[str, str], ...]
    model: ModelEntry | None = None
    unplaced: tuple[NodeUse, ...] = ()
    unread: tuple[InputError, ...] = ()
    of_others: tuple[str, ...] = ()
    notices: tuple[Diagnostic, ...] = ()

    def __repr__(self) -> str:
        """Tell how much is asked."""
        return f"<Suggested: {counted(len(self.proposals), 'question')}>"

    def document(self) -> SuggestionsDocument:
        """Return the JSON document ``rosprivacy.suggestions/1``."""
        from rosprivacy.report.suggested_labels.suggestion_document import suggestions_document  # noqa: PLC0415 - light start

        return suggestions_document(
            self.proposals,
            self.open,
            self.by_hand,
            str(self.result.analysis.verdict),
            self.result.assumptions,
            self.result.fleet.likeness if self.result.fleet else NO_ROBOTS,
            self.rules,
            self.model,
            self.unplaced,
            self.unread,
            self.of_others,
            self.notices,
        )


def suggest_labels(
    policies: tuple[str, ...],
    labels: tuple[str | Labels, ...],
    settings: Settings,
    files: UserFiles = NO_FILES,
    interview: Interview | None = None,
) -> Suggested:
    """Read a robot's system and say what its elements could be labelled as.

    Parameters
    ----------
    interview
        Of a language model, which is asked too.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    ModelError
        If the language model cannot be asked.
    """
    return suggested(answer_robot(policies, labels, settings), settings, files, interview)


def suggested(
    result: Result, settings: Settings, files: UserFiles = NO_FILES, interview: Interview | None = None
) -> Suggested:
    """Return what could be said of the elements of an answer, of a fleet's or a database's too.

    Of robots that are alike one is asked about. Parameters as of ``suggest_labels``.

    Raises
    ------
    InputErrors
        With every problem of the rules and packages.
    ModelError
        If the language model cannot be asked.
    """
    return suggested_by(what_is_known(result.vocabulary, settings, files), result, files.sources, interview)


def suggested_by(
    knowledge: KnownOfSystem, result: Result, sources: Sequence[str] = (), interview: Interview | None = None
) -> Suggested:
    """Return what could be said of the elements of an answer, by what is known; parameters as of ``suggest_labels``.

    Raises
    ------
    ModelError
        If the language model cannot be asked.
    """
    found = with_findings(result)
    basis = basis_of(result, sources)
    places = basis.places
    said = evidence(result.analysis, basis.bound, knowledge, basis.code.uses)
    listed = _not_by_code_alone(said, result)
    asked = asked_by(chain(listed, interview.evidence(basis) if interview else ()), result, found, refused_in(result))
    by_hand = frozenset(one.label for one in asked if closes_finding(one.label, found))
    return Suggested(
        in_review_order(asked, places, result.vocabulary.categories),
        frozenset(places),
        by_hand,
        result,
        (*knowledge.files, *(interview.rests_on if interview else ())),
        interview.entry() if interview else None,
        tuple(use for use in basis.code.unplaced if knowledge.libraries.speaks(use)),
        basis.code.problems,
        basis.code.of_others,
        (
            *replacements(knowledge.packages),
            *_named_alike(basis.code.local, knowledge.libraries),
            *outdated_reasons(result.analysis.graph, result.bound),
        ),
    )


def asked_by(
    evidence: Iterable[Evidence], result: Result, categories: Collection[str], refused: Refused
) -> tuple[LabelProposal, ...]:
    """Return what a person is asked of what evidence says; of each element it depends on its own evidence alone.

    Parameters
    ----------
    categories
        As ``with_findings`` returns.
    refused
        What a person has said no to.
    """
    made = proposals(evidence, categories)
    if any(refused.of_robots.values()):
        reached = reached_kinds(result.analysis)
        made = tuple(one for one in made if not refused.silences(one.label, reached))
    return unsaid(_one_of_alike(made, result), result.analysis.graph, result.bound, result.vocabulary.hierarchy)


def basis_of(result: Result, sources: Sequence[str] = ()) -> Basis:
    """Return what there is to suggest about: an answer, with what source code says of its channels."""
    places = review_places(result, result.review_order)
    if not sources:
        return Basis(result, result.bound, places, {}, CodeSaid({}, {}))
    from rosprivacy.ingest.code.code_names import code_comments  # noqa: PLC0415 - light start
    from rosprivacy.ingest.code.source_files import read_sources  # noqa: PLC0415

    codes, of_others, _ = read_sources(sources)
    code = code_said(codes, of_others, result.analysis.graph.elements)
    return Basis(result, _with_types(result.bound, code.types), places, code_comments(codes), code)


def in_review_order(
    proposals: Sequence[LabelProposal], places: Mapping[Identity, int], categories: Mapping[str, Category]
) -> tuple[LabelProposal, ...]:
    """Return proposals in the order in which a person reviews them (rule S11).

    Open elements come first; then what brings data in or lets it out. The surest come first, and of these the kinds of
    data that weigh most.
    """

    def place(proposal: LabelProposal) -> tuple[int, bool, int, Weight]:
        label = proposal.label
        at = places.get(label.element.identity, NOT_OPEN)
        weight = categories[label.to or label.kind or TOP].weight
        return at, label.role not in (SOURCE, LEAK), SURENESS[proposal.confidence], weight

    return tuple(sorted(proposals, key=place))  # stable: by element, role and kind within


def _named_alike(local: Iterable[Local], libraries: LibraryRules) -> Iterator[Diagnostic]:
    """A notice for each file that uses what is called as a library of a rule, and stands in the sources itself."""
    spoken = sorted((one for one in local if libraries.speaks(one.use)), key=lambda one: (one.use.place, one.use.name))
    first = {(one.use.place.file, one.of): one for one in reversed(spoken)}
    for one in sorted(first.values(), key=lambda one: one.use.place):
        what = f"{one.use.name} is taken for {one.of} of these sources, so no library of that name suggests anything"
        yield Diagnostic(one.use.place, Severity.NOTICE, f"{what}; label the node by hand if the library is meant")


def _with_types(bound: Bound, types: Mapping[int, tuple[MessageType, ...]]) -> Bound:
    """What is bound to the graph, with the types that source code names for its channels: for suggestions only."""
    return replace(bound, types={at: (*bound.types.get(at, ()), *types.get(at, ())) for at in {*bound.types, *types}})


def _not_by_code_alone(evidence: Iterable[Evidence], result: Result) -> Iterator[Evidence]:
    """Put no channel into a list by types that only code names: it may be a test, and others may write another type."""
    typed = {result.analysis.graph.elements[vertex].identity for vertex in result.bound.types}
    for one in evidence:
        by_code = one.ground == TYPE and one.family and one.label.element.identity not in typed
        yield one._replace(family="") if by_code else one


def _one_of_alike(proposals: tuple[LabelProposal, ...], result: Result) -> Iterable[LabelProposal]:
    """Proposals without those for the second of robots that are alike: the first stands for all (rule S10)."""
    if result.fleet is None:
        return proposals
    second = result.fleet.likeness.second
    return (one for one in proposals if one.label.element.robot not in second)


def with_findings(result: Result) -> frozenset[str]:
    """Return the categories of findings, with all that data of them may be of."""
    hierarchy = result.vocabulary.hierarchy
    return frozenset(kind for one in result.analysis.findings for kind in hierarchy.overlaps[one.category])


def review_places(result: Result, behind: Mapping[Shown, Behind]) -> dict[Identity, int]:
    """Return the place of each open element in the order of review: that of ``review_groups``, what can wait last.

    Parameters
    ----------
    behind
        As ``review_order`` returns.
    """
    categories = result.vocabulary.categories

    def place(question: OpenQuestion) -> tuple[int, bool, int, int, int, Weight]:
        said = behind.get(question.element.shown_as, NOTHING_BEHIND)
        group = 1 if question.element.is_channel else 0 if question.frontier else 2
        heaviest = min(categories[kind].weight for kind in question.categories)
        return group, said.waits, -said.leaks, -said.closes, question.distance, heaviest

    identities = dict.fromkeys(question.element.identity for question in sorted(result.analysis.open, key=place))
    return {identity: number for number, identity in enumerate(identities)}


class Refused(NamedTuple):
    """What was refused.

    Attributes
    ----------
    of_robots
        By robot, as ``refusal_key`` has it; a system that is no fleet is the robot without a name.
    """

    of_robots: Mapping[str, frozenset[str]]
    hierarchy: Hierarchy

    def says(self, label: SuggestedLabel) -> bool:
        """Return whether a label was refused; of a leak, that a broader kind gets out was, too."""
        keys = self.of_robots.get(label.element.robot, self.of_robots.get("", frozenset()))
        kinds = self.hierarchy.ancestors[label.kind] if label.role == LEAK and label.kind else (label.kind,)
        return bool(keys) and any(refusal_key(written(label._replace(kind=kind))) in keys for kind in kinds)

    def silences(self, label: SuggestedLabel, reached: Mapping[Identity, Iterable[str]]) -> bool:
        """Return whether a label need not be suggested: a leak, if all that gets there now was refused.

        Parameters
        ----------
        reached
            Kinds of data that get to elements.
        """
        if self.says(label):
            return True
        there = reached.get(label.element.identity, ()) if label.role == LEAK else ()
        kinds = narrowed(label.kind, there, self.hierarchy)
        return bool(kinds) and all(self.says(label._replace(kind=kind)) for kind in kinds)


def refused_in(result: Result) -> Refused:
    """Return it; of a file that is gone by now, nothing.

    Of robots that are alike, of which one is asked about, only what was refused of each: a no for one robot is none
    for another.

    Raises
    ------
    LabelError
        If a file cannot be read any more.
    """
    own = [one["file"] for one in result.assumptions.get("labels", ())]
    if result.fleet is None:
        return Refused({"": _in_files(own)}, result.vocabulary.hierarchy)
    likeness = result.fleet.likeness
    read = {files: _in_files(files) for files in set(result.label_files.values())}
    of_robots = {
        robot: frozenset.intersection(*(read[result.label_files[one]] for one in likeness.members.get(robot, [robot])))
        for robot in result.label_files
        if robot not in likeness.second
    }
    return Refused(of_robots, result.vocabulary.hierarchy)


def _in_files(files: Iterable[str]) -> frozenset[str]:
    own = [file for file in files if not file.startswith(OURS) and is_file(file)]
    texts = (read_utf8(file, MAX_BYTES, partial(LabelError, file))[0] for file in own)
    return frozenset().union(*map(refusals_in, texts))
